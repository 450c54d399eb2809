// Speed of a fired engine's crank over a cycle, with a flywheel.

import { reduced } from "./complex.mjs";
import { angularSpeed } from "./numbers.mjs";

/** Steps of Newton's method, which doubles the digits with each. */
const ITERATIONS = 50;

/**
 * Speeds in rpm at equal angles of a cycle, the first repeated at the end; null if the crank would stop.
 *
 * The first integral ½·J(θ)·ω² = E + ∫(T − mean)dθ, where T is the torque of gas and loads on the crank, J has
 * pistons and rods, and E makes the mean speed that of turns over time.
 */
export function speeds({ driving, moving }, { flywheel, slowest }, { rpm, cycle, bends }) {
  const mean = angularSpeed(rpm);
  if (flywheel === null || mean === 0) return null;
  const count = driving.length - 1;
  const step = (cycle * Math.PI) / 180 / count;
  const at = (k) => driving[(k + count) % count];
  // The integral of the cubic through four samples, between the middle two.
  const cubic = (value, k) => (13 * (value(k) + value(k + 1)) - value(k - 1) - value(k + 2)) / 24;
  const torques = driving.slice(1).map((_, k) => cubic(at, k));
  // Where torque jumps or bends: what the cubics beside miss.
  for (const [angle, jump, slope] of bends) {
    const place = reduced(angle, cycle) * (count / cycle);
    const first = Math.floor(place);
    const past = (x) => Math.max(x - (place - first), 0);
    const bend = slope * (cycle / count);
    const missed = (x) => (x >= place - first ? jump + bend * past(x) : 0);
    const integral = (x) => (jump + 0.5 * bend * past(x)) * past(x);
    for (const k of [-1, 0, 1]) torques[(first + k + count) % count] += integral(k + 1) - integral(k) - cubic(missed, k);
  }
  const average = torques.reduce((sum, torque) => sum + torque, 0) / count;
  const work = [0];
  for (let k = 0; k < count; k++) work.push(work[k] + step * (torques[k] - average));
  const inertia = moving.map((own) => flywheel + own);
  // Newton's method for E; time falls with E and is convex, so that from below it does not overshoot.
  const least = 0.5 * slowest * mean ** 2;
  let energy = Math.max(...work.map((done, k) => least * inertia[k] - done));
  for (let k = 0; k < ITERATIONS; k++) {
    let [turns, slope] = [0, 0];
    for (let i = 0; i < count; i++) {
      const twice = 2 * (energy + work[i]);
      const slowness = Math.sqrt(inertia[i] / twice);
      turns += slowness;
      slope -= slowness / twice;
    }
    const more = (count / mean - turns) / slope;
    if (more < 0 && k === 0) return null;
    energy += more;
    if (Math.abs(more) <= 1e-14 * inertia[0] * mean ** 2) break;
  }
  return work.map((done, k) => (Math.sqrt((2 * (energy + done)) / inertia[k]) * rpm) / mean);
}

/** The value at an angle between samples over a cycle, by the cubic through the four about it. */
export function between(samples, cycle, angle) {
  const count = samples.length - 1;
  const place = (angle / cycle) * count;
  const k = Math.floor(place);
  const t = place - k;
  const [a, b, c, d] = [-1, 0, 1, 2].map((by) => samples[(((k + by) % count) + count) % count]);
  return (-t * (t - 1) * (t - 2) * a + 3 * (t + 1) * (t - 1) * (t - 2) * b
    - 3 * (t + 1) * t * (t - 2) * c + (t + 1) * t * (t - 1) * d) / 6;
}

/** Least and largest value, by the parabolas through three samples. */
export function extremeValues(samples) {
  const count = samples.length - 1;
  const [first, last] = [1, -1].map((sign) => {
    let k = 0;
    for (let i = 1; i < count; i++) if (sign * samples[i] < sign * samples[k]) k = i;
    const [a, b, c] = [k + count - 1, k, k + 1].map((i) => samples[i % count]);
    const bend = a - 2 * b + c;
    return bend === 0 ? b : b - (a - c) ** 2 / (8 * bend);
  });
  return [first, last];
}
