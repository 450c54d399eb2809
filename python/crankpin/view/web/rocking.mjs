// Motion of the engine as a free rigid body, order by order.

import { add, magnitude, multiply, scale, unit } from "./complex.mjs";
import { angularSpeed } from "./numbers.mjs";

/** Displacement phasors of the crank axis, of the orders given; `block` is a body that moves against its loads. */
export function rocking({ block, reference_z: reference }, { rpm }, orders) {
  const square = angularSpeed(rpm) ** 2;
  if (!square || !block) return { parts: [], reference };
  const parts = orders.map(({ order, force, moment }) => {
    // Accelerations integrated twice over time.
    const twice = 1 / (order ** 2 * square);
    const both = (key) => ({
      shift: scale(force[key], -twice / block.mass),
      // A tilt φ moves a place z by −i·(z − z₀)·φ.
      tilt: multiply([0, 1], scale(moment[key], twice / block.inertia)),
    });
    return { order, forward: both("forward"), backward: both("backward") };
  });
  return { parts, reference };
}

/** Displacement x + iy of the crank axis at a crank angle, m: a function of z. */
export function displacement({ parts, reference }, thetaDeg) {
  let [shift, tilt] = [[0, 0], [0, 0]];
  for (const { order, forward, backward } of parts) {
    for (const [part, n] of [[forward, order], [backward, -order]]) {
      const turned = unit(n * thetaDeg);
      shift = add(shift, multiply(part.shift, turned));
      tilt = add(tilt, multiply(part.tilt, turned));
    }
  }
  return (z) => [shift[0] + (z - reference) * tilt[0], shift[1] + (z - reference) * tilt[1]];
}

/** Bound of the displacement at z, m. */
export function largestDisplacement({ parts, reference }, z) {
  let sum = 0;
  for (const { forward, backward } of parts) {
    for (const { shift, tilt } of [forward, backward]) {
      sum += magnitude(add(shift, scale(tilt, z - reference)));
    }
  }
  return sum;
}
