// Forces, moments and torques of an engine at settings: every picture and readout has them from here.
//
// They are the library's. A setting is what they are multiplied by (the square of the speed), what their
// polynomials are evaluated at (the rod ratio), or by how much a bank's terms are turned (the bank angle).

import { multiply, reduced, scale, unit } from "./complex.mjs";
import { chebyshev, column, crankAt, factorsAt, orderSum, realSum, summed, unturned } from "./series.mjs";

export const angularSpeed = (rpm) => (rpm * 2 * Math.PI) / 60;

const NONE = Array(4).fill([0, 0]);

export class Numbers {
  /** `figures` is what Python wrote of an engine. */
  constructor(figures, settings) {
    const { terms } = figures;
    const { loads } = terms;
    const factor = factorsAt(figures.rod_ratios, settings.rod_ratio);
    const square = angularSpeed(settings.rpm) ** 2;
    const shift = (bank) => shiftOf(figures, settings, bank);
    // Rows of further loads say what they are multiplied by as the speed changes.
    const ofLoad = ([, , , , , over]) => overSpeed(over, settings.rpm);
    const planar = summed([...terms.planar, ...loads.planar], (row) => (row.length > 5 ? ofLoad(row) : square * factor(row)), (bank, n) => {
      const { turned, delay } = shift(bank);
      const [forward, backward] = [unit(turned - n * delay), unit(turned + n * delay)];
      return (value, k) => multiply(value, k % 2 ? backward : forward);
    });
    const at = (order) => {
      const parts = planar.get(order) ?? NONE;
      const [force, moment] = [parts.slice(0, 2), parts.slice(2)]
        .map(([forward, backward]) => ({ forward, backward }));
      return { order, force, moment };
    };
    const lagging = (bank, n) => {
      const lag = unit(-n * shift(bank).delay);
      return (value) => multiply(value, lag);
    };
    const torque = terms.torque && summed(terms.torque, factor, lagging);
    /** Orders that are listed, and all; x + iy = forward·e^{inθ} + backward·e^{−inθ}, N and N·m. */
    this.orders = terms.orders.map(at);
    this.planar = [...planar.keys()].sort((a, b) => a - b).map(at);
    /** Phasors by order: roll torque of inertia, N·m; moment of inertia of pistons and rods, kg·m². */
    this.inertia = torque && new Map([...column(torque, 0)].map(([n, roll]) => [n, scale(roll, square)]));
    /** Roll torque of further loads by order, N·m; order 0 is its mean. */
    const ofLoads = summed(loads.torque, ofLoad, lagging);
    this.loads = column(ofLoads, 0);
    this.loadsOnCrank = column(ofLoads, 1);
    this.moving = torque && new Map([...torque].flatMap(([n, [, moving]]) => (moving ? [[n, moving]] : [])));
    /** Gas pressure on each piston, then at crank ends; null where there is none. */
    const crankEnds = figures.cylinders.flatMap((given) => (given.crank_end ? [{ ...given, ...given.crank_end }] : []));
    this.gas = [...figures.cylinders, ...crankEnds].map((given) => (given.cycle === null ? null : {
      ...given,
      panels: figures.gas.cycles[given.cycle],
      crankcase: figures.gas.crankcase,
      delay: shift(given.bank).delay,
      velocity: column(summed(figures.motions[given.motion].height, factor, unturned), 1),
    }));
    this.cycle = figures.strokes === 2 ? 360 : 720;
    /** Degrees after which forces and moments repeat, and all that is drawn. */
    this.turn = this.planar.some(({ order }) => isHalf(order)) ? 720 : 360;
    this.span = Math.max(this.turn, figures.gas ? this.cycle : 360, [...this.loads.keys()].some(isHalf) ? 720 : 360);
    /** What the cylinders and further loads make one by one. */
    this.whole = { ...terms.sizes };
    for (const name of ["force", "moment", "torque"]) this.whole[name] *= square;
    this.whole.torque += terms.sizes.gas;
    for (const [name, rows, from] of [["force", loads.planar, 1], ["moment", loads.planar, 5], ["torque", loads.torque, 1]]) {
      for (const row of rows) {
        for (const values of row[3]) this.whole[name] += ofLoad(row) * Math.hypot(...values.slice(from, from + 4));
      }
    }
  }

  /**
   * Force in N, moment and torque on the block in N·m, and absolute pressures in Pa, at a crank angle.
   *
   * Torque is null of a given spectrum. `gas`, `inertia` and `loads` are its parts; `driving` is the torque of
   * gas and loads on the main crank, and `moving` the moment of inertia of pistons and rods.
   */
  at(thetaDeg) {
    const crank = crankAt(thetaDeg);
    const { force, moment } = orderSum(this.planar, crank);
    const pressures = this.gas.map((cylinder) => cylinder && this.pressureAt(cylinder, thetaDeg));
    if (!this.inertia) return { force, moment, torque: null, pressures };
    let [gas, driving] = [0, 0];
    this.gas.forEach((cylinder, k) => {
      if (!cylinder) return;
      const { swept, velocity, crankcase, roll, tdc_deg: tdc, delay } = cylinder;
      const work = (pressures[k] - crankcase) * swept * realSum(velocity, unit(thetaDeg - tdc - delay));
      gas += roll * work;
      driving -= work;
    });
    const inertia = realSum(this.inertia, crank);
    const moving = realSum(this.moving, crank);
    const loads = realSum(this.loads, crank);
    driving += realSum(this.loadsOnCrank, crank);
    return { force, moment, torque: inertia + gas + loads, inertia, gas, loads, driving, moving, pressures };
  }

  /** Angles at which pressure jumps or bends: by how much torque on the main crank does, and its slope a degree. */
  bends() {
    return this.gas.filter(Boolean).flatMap(({ panels, pressure_deg: fires, swept, velocity, tdc_deg: tdc, delay }) =>
      bendsOf(panels).map(([edge, jump, slope]) => {
        const theta = edge + fires + delay;
        const at = (by) => -swept * realSum(velocity, unit(theta + by - tdc - delay));
        return [theta, jump * at(0), slope * at(0) + jump * (at(0.5) - at(-0.5))];
      }));
  }

  /** Absolute pressure in a cylinder, Pa: the polynomial of its cycle that counts there. */
  pressureAt({ panels: { edges_deg: edges, coefficients }, pressure_deg: fires, delay }, thetaDeg) {
    const at = edges[0] + reduced(thetaDeg - fires - delay - edges[0], this.cycle);
    let [k, end] = [0, coefficients.length];
    while (end - k > 1) {
      const middle = (k + end) >> 1;
      if (edges[middle] <= at) k = middle;
      else end = middle;
    }
    return chebyshev(coefficients[k], (2 * at - edges[k] - edges[k + 1]) / (edges[k + 1] - edges[k]));
  }
}

/** Edges of a cycle's polynomials, and by how much pressure and its slope a degree jump there. */
function bendsOf({ edges_deg: edges, coefficients }) {
  const beside = (k, end) => {
    const half = 0.5 * (edges[k + 1] - edges[k]);
    // Tₙ(±1) = (±1)ⁿ, and Tₙ'(±1) = (±1)ⁿ⁺¹·n².
    const sum = (/** @type {(n: number) => number} */ of) => coefficients[k].reduce((all, c, n) => all + of(n) * c, 0);
    return [sum((n) => end ** n), sum((n) => end ** (n + 1) * n * n) / half];
  };
  return coefficients.map((_, k) => {
    const [before, after] = [beside(k ? k - 1 : coefficients.length - 1, 1), beside(k, -1)];
    return [edges[k], after[0] - before[0], after[1] - before[1]];
  });
}

const isHalf = (order) => !Number.isInteger(order);

/** Factor of a load at a speed: a power of the angular speed, or the height of a line through three speeds of a table. */
function overSpeed(over, rpm) {
  if (!Array.isArray(over)) return angularSpeed(rpm) ** over;
  const [below, at, above] = over;
  const end = rpm < at ? below : above;
  return rpm === at ? 1 : Math.min(Math.max((rpm - end) / (at - end), 0), 1);
}

/** By how many degrees settings turn a bank, and by how many it follows the crank later. */
export function shiftOf({ bank_angle_deg: own }, { bank_angle_deg: angle, hold }, bank) {
  const turned = angle === null || bank > 1 ? 0 : 0.5 * (angle - own) * (bank ? 1 : -1);
  return { turned, delay: hold === "pins" ? turned : 0 };
}
