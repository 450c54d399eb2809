// One turn of the crank: the curves that are drawn, and how far they reach.

import { speeds } from "./speed.mjs";

/** Degrees between the samples of a curve. */
const STEP = 2;

/** Peaks below this part of what all cylinders make one by one are rounding, and zero. */
const NOISE = 1e-11;

/** The highest order that matters loses less than this part of its peak between two samples. */
const BETWEEN = 0.03;

/** Forces, moments, torques and speeds of a turn, its last sample that of the first; with gas of a cycle. */
export function turn(numbers, figures, rpm) {
  const samples = Array.from({ length: numbers.span / STEP + 1 }, (_, k) => numbers.at(k * STEP));
  /** @type {any} */
  const curve = Object.fromEntries(["force", "moment", "torque", "inertia", "gas", "loads", "driving", "moving"]
    .map((name) => [name, samples.map((each) => each[name])]));
  for (const name of ["force", "moment"]) curve[name].length = numbers.turn / STEP + 1;
  return { ...curve, speed: speeds(curve, figures, { rpm, cycle: numbers.span, bends: numbers.bends() }) };
}

/** Longest force and moment and largest torque of a turn; zero if they are rounding. */
export function peaks(numbers, { force, moment, torque }) {
  const length = ([x, y]) => Math.hypot(x, y);
  const at = (value) => (theta) => value(numbers.at(theta));
  const above = (quantity, value) => (value > NOISE * numbers.whole[quantity] ? value : 0);
  return {
    force: above("force", peak(force.map(length), at((loads) => length(loads.force)))),
    moment: above("moment", peak(moment.map(length), at((loads) => length(loads.moment)))),
    torque: above("torque", peak(torque.map(Math.abs), at((loads) => Math.abs(loads.torque)))),
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
