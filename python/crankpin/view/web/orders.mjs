// Force and moment order by order: forward and backward phasors, from the closed form.

import { add, conjugate, magnitude, multiply, scale, unit } from "./complex.mjs";
import { harmonics } from "./harmonics.mjs";
import { angularSpeed } from "./pose.mjs";

/** Sums below this part of the sum of their terms' magnitudes are rounding, and zero. */
const ROUNDING = 1e-13;

/** Orders whose peaks are all below this part of the largest are not shown: as in the library. */
const NEGLIGIBLE = 1e-6;

/** Phasors of all orders, the pistons' up to the highest: x + iy = forward·e^{inθ} + backward·e^{−inθ}; N and N·m. */
export function phasors(engine, highest) {
  const square = angularSpeed(engine.settings.rpm) ** 2;
  const found = new Map();
  const at = (order) => {
    if (!found.has(order)) found.set(order, { order, force: newSum(), moment: newSum() });
    return found.get(order);
  };
  for (const load of pistons(engine, highest)) {
    for (const [order, amplitude] of load.amplitudes) {
      const half = scale(amplitude, 0.5 * square * load.ratio ** 2);
      // Forward ½·A·e^{i(β − n·tdc)}, backward ½·conj(A)·e^{i(β + n·tdc)}.
      const lag = unit(order * load.tdc_deg);
      const forward = multiply(multiply(half, load.direction), conjugate(lag));
      const backward = multiply(multiply(conjugate(half), load.direction), lag);
      addLoad(at(order), forward, backward, load.z - engine.reference);
    }
  }
  for (const { ratio, amount, start, z } of engine.unbalances) {
    const force = scale(start, amount * ratio * ratio * square);
    const parts = ratio > 0 ? [force, [0, 0]] : [[0, 0], force];
    addLoad(at(Math.abs(ratio)), ...parts, z - engine.reference);
  }
  const ascending = [...found.values()].sort((a, b) => a.order - b.order);
  return ascending.map(({ order, force, moment }) => ({
    order,
    force: withoutRounding(force),
    moment: withoutRounding(moment),
  }));
}

/** The orders that matter: the largest `most` above the negligible ones, ascending. */
export function shown(all, most) {
  const largest = { force: 0, moment: 0 };
  for (const quantity of ["force", "moment"]) {
    largest[quantity] = Math.max(0, ...all.map((each) => longest(each[quantity])));
  }
  const share = (each) => Math.max(
    ...["force", "moment"].map((q) => (largest[q] ? longest(each[q]) / largest[q] : 0)),
  );
  return all
    .filter((each) => share(each) > NEGLIGIBLE)
    .sort((a, b) => share(b) - share(a))
    .slice(0, most)
    .sort((a, b) => a.order - b.order);
}

/** Longest vector of an order. */
export const longest = ({ forward, backward }) => magnitude(forward) + magnitude(backward);

/**
 * Amplitudes of each cylinder over the square of its crank's speed, kg·m, by order of the main crank's:
 * m·r·aₙ, or the spectrum that replaces them.
 */
function pistons({ cylinders, spectrum }, highest) {
  const known = new Map();
  return cylinders.map((each) => {
    const speed = Math.abs(each.ratio);
    if (spectrum) return { ...each, amplitudes: spectrum.map(([n, a]) => [n * speed, a]) };
    const { rod, offset } = each.proportions;
    const key = `${rod} ${offset}`;
    if (!known.has(key)) known.set(key, harmonics(each.proportions, highest));
    const size = each.reciprocating_mass * each.crank_radius;
    const amplitudes = known.get(key).map((a, k) => [(k + 1) * speed, scale(a, size)]);
    return { ...each, amplitudes: amplitudes.filter(([order]) => order <= highest) };
  });
}

const newSum = () => ({ forward: [0, 0], backward: [0, 0], size: 0 });

function addLoad({ force, moment }, forward, backward, lever) {
  const size = magnitude(forward) + magnitude(backward);
  force.forward = add(force.forward, forward);
  force.backward = add(force.backward, backward);
  force.size += size;
  // A moment is i·(z − z₀) times its force.
  moment.forward = add(moment.forward, multiply([0, lever], forward));
  moment.backward = add(moment.backward, multiply([0, lever], backward));
  moment.size += Math.abs(lever) * size;
}

function withoutRounding({ forward, backward, size }) {
  const kept = (part) => (magnitude(part) > ROUNDING * size ? part : [0, 0]);
  return { forward: kept(forward), backward: kept(backward) };
}
