// Modes and response of a powertrain whose mounts stand where the reader puts them.
//
// Everything that is mechanics is the library's: of each mount the matrix of its deflections, which is linear in its
// place, and its stiffness; the body's coordinates of unit mass; the loads of each order. Here they are evaluated,
// added up, and handed to linear algebra.

import { add, multiply, scale } from "./complex.mjs";
import { SIX, applied, singular, solveComplex } from "./linear.mjs";
import { angularSpeed } from "./numbers.mjs";

/** Relative difference of two frequencies within which shapes are not distinguished: as in the library. */
const EQUAL_FREQUENCIES = 1e-9;

export class Suspension {
  /** `figures` is what Python wrote of the powertrain; `mounts` places and stiffnesses, in its order. */
  constructor(figures, mounts) {
    this.figures = figures;
    const columns = Array.from({ length: SIX }, (_, j) => figures.unit.map((row) => row[j]));
    this.mounts = figures.mounts.map((given, k) => {
      const { at, stiffness } = mounts[k];
      const moved = at.map((part, axis) => part - given.at[axis]);
      const deflection = given.deflection.map((row, i) => row.map((value, j) =>
        moved.reduce((sum, by, axis) => sum + by * given.slopes[axis][i][j], value)));
      return { given, stiffness, deflection, unit: deflection.map((row) => applied(columns, row)) };
    });
    this.columns = columns;
    this.last = { square: NaN };
  }

  /** Complex stiffnesses along the axes of each mount at a frequency in Hz; null outside of a table. */
  stiffnesses(hertz) {
    const found = this.mounts.map(({ given, stiffness }) => {
      if (given.table) return tabled(given.table, hertz);
      const along = stiffness.map((value, axis) => {
        const [re, im] = scale(given.unit[axis], value);
        // At rest there is no damping.
        return hertz > 0 ? add([re, im], scale(given.viscous[axis], 2 * Math.PI * hertz)) : [re, 0];
      });
      if (given.track) along[0] = add(along[0], fluid(given.track, hertz / given.track.frequency));
      return along;
    });
    return found.includes(null) ? null : found;
  }

  /** Modes, ascending: frequency in Hz, shape, shares of energy in % and the largest; null where there are none. */
  modes() {
    const along = this.stiffnesses(this.figures.frequency ?? 0);
    if (!along || along.flat().some(([re]) => re < 0)) return null;
    const rows = this.mounts.flatMap(({ unit }, k) =>
      unit.map((row, axis) => row.map((value) => value * Math.sqrt(along[k][axis][0]))));
    const { unit, momentum } = this.figures;
    const weights = momentum.map((row) => Math.sqrt(row.reduce((sum, value) => sum + value * value, 0)));
    const modes = singular(rows).map(({ value, vector }) => {
      const shape = applied(unit, vector);
      const sizes = shape.map((part, k) => Math.abs(part) * weights[k]);
      const sign = shape[sizes.indexOf(Math.max(...sizes))] < 0 ? -1 : 1;
      const moved = applied(momentum, vector);
      return {
        omega: value,
        frequency: value / (2 * Math.PI),
        shape: shape.map((part) => sign * part),
        energy: shape.map((part, k) => 100 * part * moved[k]),
      };
    });
    return inGroups(modes);
  }

  /** Motion of the CG and rotation and force on the body of an order, phasors; null where there is no answer. */
  at(index, rpm) {
    const { inertia, gas, orders } = this.figures;
    const speed = angularSpeed(rpm);
    const load = inertia[index].map((part, k) => add(scale(part, speed ** 2), gas[index][k]));
    const square = (orders[index] * speed) ** 2;
    const along = this.stiffnesses((orders[index] * rpm) / 60);
    if (!along) return null;
    const [re, im] = [new Float64Array(SIX * SIX), new Float64Array(SIX * SIX)];
    this.mounts.forEach(({ unit }, m) => unit.forEach((row, axis) => {
      const [k, loss] = along[m][axis];
      for (let i = 0; i < SIX; i++) {
        for (let j = 0; j < SIX; j++) {
          const product = row[i] * row[j];
          re[i * SIX + j] += k * product;
          im[i * SIX + j] += loss * product;
        }
      }
    }));
    for (let i = 0; i < SIX; i++) re[i * SIX + i] -= square;
    const [x, y] = [0, 1].map((part) =>
      Float64Array.from(applied(this.columns, load.map((value) => value[part]))));
    if (!solveComplex(re, im, x, y)) return null;
    const [real, imaginary] = [x, y].map((values) => applied(this.figures.unit, [...values]));
    const motion = real.map((value, k) => [value, imaginary[k]]);
    return { order: orders[index], motion, force: this.force(along, motion) };
  }

  /** Sum of the mounts' forces on what carries them. */
  force(along, motion) {
    const sum = [[0, 0], [0, 0], [0, 0]];
    this.mounts.forEach(({ deflection }, m) => deflection.forEach((row, axis) => {
      const deflected = row.reduce((total, value, k) => add(total, scale(motion[k], value)), [0, 0]);
      const force = multiply(along[m][axis], deflected);
      for (let k = 0; k < 3; k++) sum[k] = add(sum[k], scale(force, row[k]));
    }));
    return sum;
  }
}

/** Rows of a table at a frequency, linear between two of them. */
function tabled({ frequency, stiffness }, hertz) {
  const after = frequency.findIndex((each) => each >= hertz);
  if (after < 0 || hertz < frequency[0]) return null;
  if (after === 0) return stiffness[0];
  const share = (hertz - frequency[after - 1]) / (frequency[after] - frequency[after - 1]);
  return stiffness[after].map((value, axis) =>
    add(scale(stiffness[after - 1][axis], 1 - share), scale(value, share)));
}

/** A quotient of polynomials. */
function fluid({ above, below }, x) {
  const [top, bottom] = [above, below].map(([first, second]) => add(scale(first, x), scale(second, x * x)));
  const [re, im] = add(bottom, [1, 0]);
  return scale(multiply(top, [re, -im]), 1 / (re * re + im * im));
}

/** Modes with the mean energies of those of one frequency, and with their purity. */
function inGroups(modes) {
  const groups = [];
  modes.forEach((mode, k) => {
    const below = modes[k - 1]?.omega;
    if (k && mode.omega - below <= EQUAL_FREQUENCIES * mode.omega) groups.at(-1).push(mode);
    else groups.push([mode]);
  });
  return groups.flatMap((group) => {
    const mean = group[0].energy.map((_, k) => group.reduce((sum, { energy }) => sum + energy[k], 0) / group.length);
    const purity = [...mean].sort((a, b) => b - a).slice(0, group.length).reduce((sum, share) => sum + share, 0);
    return group.map(({ frequency, shape }) => ({ frequency, shape, energy: mean, purity }));
  });
}

/** Root mean square along each axis of phasors by order. */
export const effective = (parts, key) => [0, 1, 2].map((axis) =>
  Math.sqrt(parts.reduce((sum, part) => sum + part[key][axis][0] ** 2 + part[key][axis][1] ** 2, 0) / 2));

/** Displacement of the body's points and its rotation, of a displacement of its CG and a small rotation. */
export function rigid([u, v, w, about, along, turn], [x0, y0, z0]) {
  return {
    at: ([x, y, z]) => {
      const [a, b, c] = [x - x0, y - y0, z - z0];
      return [u + along * c - turn * b, v + turn * a - about * c, w + about * b - along * a];
    },
    turn: [about, along, turn],
  };
}
