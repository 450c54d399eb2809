// Everything at one crank angle: where the parts stand, and the force, moment and torque they make.

import { add, multiply, scale, unit } from "./complex.mjs";
import { gasTorque, pressureAt } from "./gas.mjs";
import { motion, swing } from "./motion.mjs";

export const angularSpeed = (rpm) => (rpm * 2 * Math.PI) / 60;

/**
 * Places in metres, force in N, moment and torque in N·m, at a crank angle in degrees.
 *
 * Exact kinematics; an engine with a given spectrum sums `orders`, and its torque is null. Of the
 * torque on the block `gas` and `inertia` are the parts; `driving` is that of the gas on the main crank,
 * and `moving` the moment of inertia of pistons and rods as seen from it.
 */
export function poseAt(engine, orders, thetaDeg) {
  const crank = unit(thetaDeg);
  const cylinders = engine.cylinders.map((each) => cylinderPose(each, crank, thetaDeg));
  const weights = engine.unbalances.map((each) => multiply(each.start, turnedBy(crank, each.ratio)));
  const square = angularSpeed(engine.settings.rpm) ** 2;
  const loads = engine.spectrum
    ? ordersAt(orders, crank)
    : exactLoads(engine, cylinders, weights, square);
  return { thetaDeg, crank, cylinders, weights, ...loads };
}

/** e^{inθ} of e^{iθ} for a whole n. */
export function turnedBy(crank, n) {
  let power = [1, 0];
  for (let k = 0; k < Math.abs(n); k++) power = multiply(power, crank);
  return n < 0 ? [power[0], -power[1]] : power;
}

function cylinderPose(cylinder, crank, thetaDeg) {
  const { ratio, axis } = cylinder;
  const past = multiply(crank, [cylinder.tdc[0], -cylinder.tdc[1]]);
  // Offsets are on the side to which the crankpin swings, so that either sense moves the piston alike.
  const [cos, sin] = turnedBy(past, Math.abs(ratio));
  const moved = motion(cylinder.proportions, cos, sin);
  const [dx, dy] = cylinder.direction;
  const height = cylinder.crank_radius * moved.position;
  const throwTo = scale(multiply(turnedBy(crank, ratio), cylinder.pin), cylinder.crank_radius);
  return {
    cos,
    sin,
    moved,
    height,
    pressure: cylinder.gas && pressureAt(cylinder.gas, thetaDeg),
    crankpin: add(axis, throwTo),
    // The path of the piston pin lies left of the bore's direction by the offset, on a crank that turns as
    // the main one does.
    wrist: add(axis, [height * dx - cylinder.shift * dy, height * dy + cylinder.shift * dx]),
  };
}

function exactLoads(engine, cylinders, weights, square) {
  const force = [0, 0];
  const moment = [0, 0];
  let inertia = 0;
  let gas = 0;
  let driving = 0;
  let moving = 0;
  const apply = (fx, fy, z, axis) => {
    const lever = z - engine.reference;
    force[0] += fx;
    force[1] += fy;
    moment[0] -= lever * fy;
    moment[1] += lever * fx;
    inertia += axis[0] * fy - axis[1] * fx;
  };
  engine.cylinders.forEach((cylinder, k) => {
    const { cos, sin, moved, pressure } = cylinders[k];
    const { crank_radius: r, reciprocating_mass: m, rod_inertia_excess: excess, ratio } = cylinder;
    const own = square * ratio * ratio;
    // Turning the other way mirrors the torque on the block; power on the crank is torque times speed.
    const sense = Math.sign(ratio);
    const along = -m * r * own * moved.acceleration;
    apply(along * cylinder.direction[0], along * cylinder.direction[1], cylinder.z, cylinder.axis);
    inertia -= sense * along * r * (moved.velocity + cylinder.proportions.offset);
    moving += m * (ratio * r * moved.velocity) ** 2;
    if (pressure !== null) {
      const onBlock = gasTorque(cylinder.gas, r, pressure, moved.velocity);
      gas += sense * onBlock;
      driving -= onBlock;
    }
    if (excess) {
      const { velocity, acceleration } = swing(cylinder.proportions, cos, sin);
      inertia += sense * excess * own * acceleration * (1 + velocity);
      moving += excess * (ratio * velocity) ** 2;
    }
  });
  engine.unbalances.forEach(({ ratio, axis, amount, z }, k) => {
    const size = amount * ratio * ratio * square;
    const [fx, fy] = [size * weights[k][0], size * weights[k][1]];
    apply(fx, fy, z, axis);
  });
  return { force, moment, torque: inertia + gas, inertia, gas, driving, moving };
}

/** Sum of orders: x + iy = Σ forward·e^{inθ} + backward·e^{−inθ}. */
export function ordersAt(orders, crank) {
  const sums = { force: [0, 0], moment: [0, 0], torque: null };
  for (const { order, force, moment } of orders) {
    const [forward, backward] = [turnedBy(crank, order), turnedBy(crank, -order)];
    for (const [sum, parts] of [[sums.force, force], [sums.moment, moment]]) {
      const [a, b] = [multiply(parts.forward, forward), multiply(parts.backward, backward)];
      sum[0] += a[0] + b[0];
      sum[1] += a[1] + b[1];
    }
  }
  return sums;
}
