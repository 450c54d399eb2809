// Modes and response of a powertrain whose mounts stand where the reader puts them.
//
// Everything that is mechanics is the library's: of each mount the matrix of its deflections, which is linear in its
// place, and its stiffness; the body's coordinates of unit mass; the loads of each order. Here they are evaluated,
// added up, and handed to linear algebra. That the page solves them, and the crank's speed over a cycle in `speed.mjs`,
// is a promise of the manual: a saved page has no core, and is exact at any rod ratio, place and stiffness.

import { add, multiply, scale } from "./complex.mjs";
import { SIX, applied, singular, solveComplex } from "./linear.mjs";
import { angularSpeed } from "./numbers.mjs";

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
    const inUnits = (loads) => loads.map((load) =>
      [0, 1].map((part) => applied(columns, load.map((value) => value[part]))));
    this.inertia = inUnits(figures.inertia);
    this.gas = inUnits(figures.gas);
  }

  /**
   * The directions of all mounts at a frequency in Hz: complex stiffness `k`, and deflection by the motion and by
   * coordinates of unit mass; null outside a table.
   */
  directions(hertz) {
    const omega = 2 * Math.PI * hertz;
    const all = [];
    for (const { given, stiffness, deflection, unit } of this.mounts) {
      const along = given.table ? tabled(given.table, hertz)
        : stiffness.map((value, axis) => add(scale(given.unit[axis], value), scale(given.viscous[axis], omega)));
      if (!along) return null;
      if (given.track) along[0] = add(along[0], fluid(given.track, hertz / given.track.frequency));
      along.forEach((k, axis) => all.push({ k, deflection: deflection[axis], unit: unit[axis] }));
    }
    return all;
  }

  /** Modes, ascending: frequency in Hz, shape, shares of energy in % and the largest; null where there are none. */
  modes() {
    const along = this.directions(this.figures.frequency ?? 0);
    if (along.some(({ k: [stiffness] }) => stiffness < 0)) return null;
    const rows = along.map(({ k: [stiffness], unit }) => unit.map((value) => value * Math.sqrt(stiffness)));
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
    return inGroups(modes, this.figures.equal_frequencies);
  }

  /** Motion of the CG and rotation and force on the body of an order, phasors; null where there is no answer. */
  at(index, rpm) {
    const { orders, unit } = this.figures;
    const along = this.directions((orders[index] * rpm) / 60);
    if (!along) return null;
    const square = angularSpeed(rpm) ** 2;
    const [x, y] = [0, 1].map((part) =>
      Float64Array.from(this.inertia[index][part], (value, k) => square * value + this.gas[index][part][k]));
    const [re, im] = [0, 1].map(() => new Float64Array(SIX * SIX));
    for (let i = 0; i < SIX; i++) re[i * SIX + i] = -(orders[index] ** 2) * square;
    for (const { k: [stiff, loss], unit: row } of along) {
      for (let i = 0; i < SIX; i++) {
        for (let j = 0; j < SIX; j++) {
          const product = row[i] * row[j];
          re[i * SIX + j] += stiff * product;
          im[i * SIX + j] += loss * product;
        }
      }
    }
    if (!solveComplex(re, im, x, y)) return null;
    const dot = (row) => [x, y].map((part) => row.reduce((sum, value, k) => sum + value * part[k], 0));
    const force = [[0, 0], [0, 0], [0, 0]];
    for (const { k, deflection, unit: row } of along) {
      const pull = multiply(k, dot(row));
      force.forEach((sum, axis) => { force[axis] = add(sum, scale(pull, deflection[axis])); });
    }
    return { order: orders[index], motion: unit.map(dot), force };
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

/** Modes with the mean energies of those of one frequency, within a part of it, and with their purity. */
function inGroups(modes, within) {
  const groups = [];
  modes.forEach((mode, k) => {
    const below = modes[k - 1]?.omega;
    if (k && mode.omega - below <= within * mode.omega) groups.at(-1).push(mode);
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

/**
 * Displacement of the body's points and its rotation, of a displacement of its CG and a small rotation.
 *
 * @param {number[]} motion
 * @param {number[]} cg
 */
export function rigid([u, v, w, about, along, turn], [x0, y0, z0]) {
  return {
    at: ([x, y, z]) => {
      const [a, b, c] = [x - x0, y - y0, z - z0];
      return [u + along * c - turn * b, v + turn * a - about * c, w + about * b - along * a];
    },
    turn: [about, along, turn],
  };
}
