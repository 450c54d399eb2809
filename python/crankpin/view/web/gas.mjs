// Gas pressure in the cylinders, and the torque that it makes on the block.

import { reduced } from "./complex.mjs";

/**
 * The gas load of a cylinder whose top dead centre was moved to `tdcDeg`; null without pressure.
 *
 * `gas` of the figures has absolute pressures in Pa over a cycle from the firing top dead centre on
 * (the crankpin in line with the bore, wherever the piston is highest), at equal angles, the first repeated at the end.
 */
export function gasLoad({ gas, strokes }, given, tdcDeg) {
  if (!gas || given.cycle === null) return null;
  const moved = tdcDeg - given.tdc_deg;
  return {
    samples: gas.cycles[given.cycle],
    crankcase: gas.crankcase,
    area: 0.25 * Math.PI * given.bore ** 2,
    span: strokes === 2 ? 360 : 720,
    fires: given.pressure_deg + moved - 360 * Math.round(moved / 360),
  };
}

/** Absolute pressure at a crank angle, Pa; between two samples it changes evenly. */
export function pressureAt({ samples, span, fires }, thetaDeg) {
  const at = (reduced(thetaDeg - fires, span) * (samples.length - 1)) / span;
  const before = Math.min(Math.floor(at), samples.length - 2);
  return samples[before] + (at - before) * (samples[before + 1] - samples[before]);
}

/** Torque on the block: the reaction of gauge pressure times the change of volume. */
export function gasTorque({ area, crankcase }, crankRadius, pressure, velocity) {
  return (pressure - crankcase) * area * crankRadius * velocity;
}
