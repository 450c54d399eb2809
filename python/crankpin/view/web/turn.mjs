// One turn of the crank: the curves that are drawn, and how far they reach.

import { angularSpeed, poseAt } from "./pose.mjs";
import { speeds } from "./speed.mjs";

/** Degrees between the samples of a curve. */
const STEP = 2;

/** Peaks below this part of what all cylinders make one by one are rounding, and zero. */
const NOISE = 1e-11;

/** The highest order that matters loses less than this part of its peak between two samples. */
const BETWEEN = 0.03;

/** Forces, moments, torques and speeds of a turn, its last sample that of the first; with gas of a cycle. */
export function turn(engine, orders) {
  const curve = { force: [], moment: [], torque: [], inertia: [], gas: [], driving: [], moving: [] };
  for (let theta = 0; theta <= (engine.gas ? engine.cycle : 360); theta += STEP) {
    const pose = poseAt(engine, orders, theta);
    const { force, moment, torque, inertia, gas, driving, moving } = pose;
    if (theta <= 360) {
      curve.force.push(force);
      curve.moment.push(moment);
    }
    curve.torque.push(torque);
    curve.inertia.push(inertia);
    curve.gas.push(gas);
    curve.driving.push(driving);
    curve.moving.push(moving);
  }
  return { ...curve, speed: speeds(engine, curve) };
}

/** Bounds of what the cylinders make one by one, at order 1. */
export function sizes({ cylinders, reference, settings }) {
  const square = angularSpeed(settings.rpm) ** 2;
  const size = (lever) => cylinders.reduce((sum, each) => sum + square * each.ratio ** 2 * lever(each)
    * (each.reciprocating_mass + each.rotating_mass) * each.crank_radius, 0);
  return {
    force: size(() => 1),
    moment: size(({ z }) => Math.abs(z) + Math.abs(reference)),
    torque: size(({ crank_radius: r, axis }) => r + Math.hypot(...axis)) + cylinders.reduce((sum, { gas, crank_radius: r }) =>
      sum + (gas ? Math.max(...gas.samples) * gas.area * r : 0), 0),
  };
}

/** Longest force and moment and largest torque of a turn; zero if they are rounding. */
export function peaks(engine, orders, { force, moment, torque }) {
  const whole = sizes(engine);
  const length = ([x, y]) => Math.hypot(x, y);
  const at = (value) => (theta) => value(poseAt(engine, orders, theta));
  const above = (quantity, value) => (value > NOISE * whole[quantity] ? value : 0);
  return {
    force: above("force", peak(force.map(length), at((pose) => length(pose.force)))),
    moment: above("moment", peak(moment.map(length), at((pose) => length(pose.moment)))),
    torque: above("torque", peak(torque.map(Math.abs), at((pose) => Math.abs(pose.torque)))),
  };
}

/** Largest value: the samples near the top are followed to the maximum beside them. */
function peak(samples, valueAt) {
  const top = Math.max(...samples);
  const flat = 1e-12 * top;
  let largest = top;
  for (let k = 0; k < samples.length - 1; k++) {
    const before = samples[k ? k - 1 : samples.length - 2];
    const rises = samples[k] > before + flat && samples[k] >= samples[k + 1] - flat;
    if (rises && samples[k] > (1 - BETWEEN) * top) {
      largest = Math.max(largest, followed(k * STEP, valueAt));
    }
  }
  return largest;
}

/** The maximum beside an angle, by parabolas ever closer to it. */
function followed(theta, valueAt) {
  let middle = theta;
  for (const reach of [STEP, STEP / 8, STEP / 64]) {
    const [a, b, c] = [-reach, 0, reach].map((by) => valueAt(middle + by));
    const bend = a - 2 * b + c;
    if (bend < 0) middle += Math.min(Math.max((0.5 * reach * (a - c)) / bend, -reach), reach);
  }
  return valueAt(middle);
}
