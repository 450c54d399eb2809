// Motion of the engine as a free rigid body, order by order.
//
// A body of mass M moves against a force of order n by −F/(M·n²ω²), and tilts against a moment by
// −M/(J·n²ω²). Neither mass nor inertia of the block is known: it is taken as a uniform bar of 50
// times the reciprocating masses (90 kg for an inline-4 of two litres), which reaches half a height
// beyond the outer cylinders.

import { add, magnitude, multiply, scale } from "./complex.mjs";
import { angularSpeed, turnedBy } from "./pose.mjs";

const MASS_RATIO = 50;

/** Displacement phasors of the crank axis, of the orders given. */
export function rocking({ cylinders, reference, settings }, orders) {
  const square = angularSpeed(settings.rpm) ** 2;
  const mass = MASS_RATIO * cylinders.reduce((sum, each) => sum + each.reciprocating_mass, 0);
  if (!square || !mass) return { parts: [], reference };
  const places = cylinders.map((each) => each.z);
  const height = Math.max(...cylinders.map((each) => 2 * each.crank_radius + each.rod_length));
  const length = Math.max(...places) - Math.min(...places) + height;
  const inertia = (mass * (length ** 2 + height ** 2)) / 12;
  const parts = orders.map(({ order, force, moment }) => {
    const both = (key) => ({
      shift: scale(force[key], -1 / (mass * order ** 2 * square)),
      // A tilt φ moves a place z by −i·(z − z₀)·φ.
      tilt: multiply([0, 1], scale(moment[key], 1 / (inertia * order ** 2 * square))),
    });
    return { order, forward: both("forward"), backward: both("backward") };
  });
  return { parts, reference };
}

/** Displacement x + iy of the crank axis for e^{iθ}, m: a function of z. */
export function displacement({ parts, reference }, crank) {
  let [shift, tilt] = [[0, 0], [0, 0]];
  for (const { order, forward, backward } of parts) {
    for (const [part, n] of [[forward, order], [backward, -order]]) {
      const turned = turnedBy(crank, n);
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
