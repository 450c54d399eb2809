// Modes and response of a powertrain whose mounts stand where the reader puts them.
//
// Everything that is mechanics is the library's: of each mount the matrix of its deflections, which is linear in its
// place, and its stiffness; the body's coordinates of unit mass; the loads of each order. Here they are evaluated,
// added up, and handed to linear algebra.

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
    // What is the same at all frequencies, and what goes with the angular speed.
    this.constant = new Terms();
    this.viscous = new Terms();
    for (const { given, stiffness, deflection, unit } of this.mounts) {
      if (given.table) continue;
      stiffness.forEach((value, axis) => {
        this.constant.add(deflection[axis], unit[axis], scale(given.unit[axis], value));
        this.viscous.add(deflection[axis], unit[axis], given.viscous[axis]);
      });
    }
    const inUnits = (loads) => loads.map((load) =>
      [0, 1].map((part) => applied(columns, load.map((value) => value[part]))));
    this.inertia = inUnits(figures.inertia);
    this.gas = inUnits(figures.gas);
  }

  /** Stiffnesses along the axes of each mount at a frequency in Hz, without their losses. */
  stiffnesses(hertz) {
    return this.mounts.map(({ given, stiffness }) => {
      if (given.table) return tabled(given.table, hertz).map(([re]) => re);
      const along = stiffness.map((value, axis) => value * given.unit[axis][0]);
      if (given.track) along[0] += fluid(given.track, hertz / given.track.frequency)[0];
      return along;
    });
  }

  /** Modes, ascending: frequency in Hz, shape, shares of energy in % and the largest; null where there are none. */
  modes() {
    const along = this.stiffnesses(this.figures.frequency ?? 0);
    if (along.flat().some((value) => value < 0)) return null;
    const rows = this.mounts.flatMap(({ unit }, k) =>
      unit.map((row, axis) => row.map((value) => value * Math.sqrt(along[k][axis]))));
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

  /** Terms of stiffness at a frequency in Hz, of which the real parts of the matrix lack the mass; null outside a table. */
  terms(hertz) {
    const sum = new Terms();
    const omega = 2 * Math.PI * hertz;
    for (const key of ["re", "im", "forceRe", "forceIm"]) {
      const [constant, viscous, to] = [this.constant[key], this.viscous[key], sum[key]];
      for (let k = 0; k < to.length; k++) to[k] = constant[k] + omega * viscous[k];
    }
    for (const { given, deflection, unit } of this.mounts) {
      if (given.track) sum.add(deflection[0], unit[0], fluid(given.track, hertz / given.track.frequency));
      if (!given.table) continue;
      const along = tabled(given.table, hertz);
      if (!along) return null;
      along.forEach((value, axis) => sum.add(deflection[axis], unit[axis], value));
    }
    return sum;
  }

  /** Motion of the CG and rotation and force on the body of an order, phasors; null where there is no answer. */
  at(index, rpm) {
    const { orders, unit } = this.figures;
    const terms = this.terms((orders[index] * rpm) / 60);
    if (!terms) return null;
    const square = angularSpeed(rpm) ** 2;
    const [x, y] = [0, 1].map((part) =>
      Float64Array.from(this.inertia[index][part], (value, k) => square * value + this.gas[index][part][k]));
    for (let i = 0; i < SIX; i++) terms.re[i * SIX + i] -= orders[index] ** 2 * square;
    if (!solveComplex(terms.re, terms.im, x, y)) return null;
    const motion = unit.map((row) => {
      let [re, im] = [0, 0];
      for (let k = 0; k < SIX; k++) {
        re += row[k] * x[k];
        im += row[k] * y[k];
      }
      return [re, im];
    });
    return { order: orders[index], motion, force: terms.force(x, y) };
  }
}

/** Sums over the directions of mounts: of the equations' matrix, and of the forces on what carries the mounts. */
class Terms {
  constructor() {
    this.re = new Float64Array(SIX * SIX);
    this.im = new Float64Array(SIX * SIX);
    this.forceRe = new Float64Array(3 * SIX);
    this.forceIm = new Float64Array(3 * SIX);
  }

  /**
   * Add a direction of a complex stiffness: its deflection by the motion, and by coordinates of unit mass.
   *
   * @param {number[]} deflection
   * @param {number[]} unit
   * @param {number[]} stiffness
   */
  add(deflection, unit, [k, loss]) {
    for (let j = 0; j < SIX; j++) {
      const [stiff, lossy] = [k * unit[j], loss * unit[j]];
      for (let i = 0; i < SIX; i++) {
        this.re[i * SIX + j] += unit[i] * stiff;
        this.im[i * SIX + j] += unit[i] * lossy;
      }
      for (let i = 0; i < 3; i++) {
        this.forceRe[i * SIX + j] += deflection[i] * stiff;
        this.forceIm[i * SIX + j] += deflection[i] * lossy;
      }
    }
  }

  /** The force of a motion in coordinates of unit mass, along x, y and z. */
  force(x, y) {
    return [0, 1, 2].map((axis) => {
      let [re, im] = [0, 0];
      for (let k = 0; k < SIX; k++) {
        const [stiff, lossy] = [this.forceRe[axis * SIX + k], this.forceIm[axis * SIX + k]];
        re += stiff * x[k] - lossy * y[k];
        im += stiff * y[k] + lossy * x[k];
      }
      return [re, im];
    });
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
