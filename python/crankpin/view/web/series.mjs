// Sums of what the library computed: polynomials, and orders over the crank angle.

import { add, magnitude, multiply, unit } from "./complex.mjs";

/** Sums below this part of the sum of their terms' magnitudes are rounding, and zero. */
const ROUNDING = 1e-11;

/** Σ cₖ·Tₖ(x) of Chebyshev's polynomials, by Clenshaw's recurrence. */
export function chebyshev(coefficients, x) {
  let [next, after] = [0, 0];
  for (let k = coefficients.length - 1; k > 0; k--) {
    [next, after] = [coefficients[k] + 2 * x * next - after, next];
  }
  return (coefficients[0] ?? 0) + x * next - after;
}

/** Factors of rows at a rod ratio; without one, at the engine's own. */
export function factorsAt(ratios, ratio) {
  if (ratio === null) return ([, , , , own]) => own;
  const [least, most, turning] = ratios;
  // The variable of the polynomials, in which a few terms are enough.
  const [low, high, q] = [least, most, ratio].map((each) => Math.tan(0.5 * Math.asin(each / turning)));
  const x = (2 * q - low - high) / (high - low);
  return ([, power, polynomial]) => q ** power * chebyshev(polynomial, x);
}

/**
 * Sums of rows by order, a complex number for each pair of their values.
 *
 * `turn` gives of a group and an order how values, numbered, are turned.
 */
export function summed(rows, factor, turn) {
  const found = new Map();
  for (const row of rows) {
    const [order, , , groups] = row;
    const by = factor(row);
    for (const [group, ...values] of groups) {
      const turned = turn(group, order);
      if (!found.has(order)) found.set(order, []);
      const sums = found.get(order);
      for (let k = 0; 2 * k < values.length; k++) {
        const term = turned([by * values[2 * k], by * values[2 * k + 1]], k);
        const { sum, size } = sums[k] ?? { sum: [0, 0], size: 0 };
        sums[k] = { sum: add(sum, term), size: size + magnitude(term) };
      }
    }
  }
  const kept = ({ sum, size }) => (magnitude(sum) > ROUNDING * size ? sum : [0, 0]);
  return new Map([...found].map(([order, sums]) => [order, sums.map(kept)]));
}

/** The numbered value of each order, ascending. */
export const column = (sums, k) => new Map([...sums].sort(([a], [b]) => a - b).map(([order, values]) => [order, values[k]]));

/** Values of a group that nothing turns. */
export const unturned = () => (value) => value;

/** A crank angle: e^{iθ}, and behind it e^{iθ/2}, which turns by half orders are of. */
export const crankAt = (thetaDeg) => [...unit(thetaDeg), ...unit(0.5 * thetaDeg)];

/**
 * e^{inθ} of a crank angle, or of e^{iθ} alone for a whole n.
 *
 * @param {number[]} crank
 * @param {number} n
 */
export function turnedBy([cos, sin, ...half], n) {
  let [x, y] = Number.isInteger(n) ? [1, 0] : half;
  for (let k = 1; k <= Math.abs(n); k++) [x, y] = [x * cos - y * sin, x * sin + y * cos];
  return n < 0 ? [x, -y] : [x, y];
}

/** Real part of Σ phasor·e^{inθ}, of phasors by order, at a crank angle. */
export function realSum(phasors, crank) {
  let [sum, reached, power] = [0, 0, [1, 0]];
  for (const [order, [re, im]] of phasors) {
    power = multiply(power, turnedBy(crank, order - reached));
    reached = order;
    sum += re * power[0] - im * power[1];
  }
  return sum;
}

/** Force and moment of orders: Σ forward·e^{inθ} + backward·e^{−inθ}, at a crank angle. */
export function orderSum(orders, crank) {
  const sums = { force: [0, 0], moment: [0, 0] };
  let [reached, power] = [0, [1, 0]];
  for (const each of orders) {
    power = multiply(power, turnedBy(crank, each.order - reached));
    reached = each.order;
    const [cos, sin] = power;
    for (const quantity of ["force", "moment"]) {
      const { forward: [a, b], backward: [c, d] } = each[quantity];
      const sum = sums[quantity];
      sum[0] += (a + c) * cos + (d - b) * sin;
      sum[1] += (b + d) * cos + (a - c) * sin;
    }
  }
  return sums;
}
