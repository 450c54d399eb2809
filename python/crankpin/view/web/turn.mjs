// One turn of the crank: the curves that are drawn, and how far they reach.

import { angularSpeed, poseAt } from "./pose.mjs";

/** Peaks below this part of what all cylinders make one by one are rounding, and zero. */
const NOISE = 1e-11;

/** One turn in steps of a degree: 361 forces, moments and torques. */
export function turn(engine, orders) {
  const curve = { force: [], moment: [], torque: [] };
  for (let theta = 0; theta <= 360; theta++) {
    const { force, moment, torque } = poseAt(engine, orders, theta);
    curve.force.push(force);
    curve.moment.push(moment);
    curve.torque.push(torque);
  }
  return curve;
}

/** Largest force, moment and torque of a turn; zero if they are rounding. */
export function peaks({ cylinders, reference, settings }, { force, moment, torque }) {
  const square = angularSpeed(settings.rpm) ** 2;
  const size = (lever) => cylinders.reduce((sum, each) => sum + square * lever(each)
    * (each.reciprocating_mass + each.rotating_mass) * each.crank_radius, 0);
  const longest = (vectors) => Math.max(...vectors.map(([x, y]) => Math.hypot(x, y)));
  const above = (value, whole) => (value > NOISE * whole ? value : 0);
  return {
    force: above(longest(force), size(() => 1)),
    moment: above(longest(moment), size(({ z }) => Math.abs(z) + Math.abs(reference))),
    torque: above(Math.max(...torque.map(Math.abs)), size((each) => each.crank_radius)),
  };
}
