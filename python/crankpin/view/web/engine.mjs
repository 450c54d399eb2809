// The engine at chosen settings: bank angle and what it holds, rod ratio.

import { DEGREE, reduced, unit } from "./complex.mjs";
import { gasLoad } from "./gas.mjs";
import { proportions } from "./motion.mjs";

/** Largest rod ratio of the slider; nearer to 1 the harmonics take too many terms. */
const LARGEST_ROD_RATIO = 0.99;

/** Settings that leave the engine as it was given. */
export function ownSettings(figures) {
  return {
    rpm: figures.rpm,
    bank_angle_deg: figures.bank_angle_deg,
    rod_ratio: commonRodRatio(figures),
    hold: "pins",
  };
}

/** The rod ratio of all cylinders, or null if they differ. */
function commonRodRatio({ cylinders }) {
  const ratios = cylinders.map((each) => each.crank_radius / each.rod_length);
  return ratios.every((ratio) => ratio === ratios[0]) ? ratios[0] : null;
}

/** Rod ratios between which every crank can turn. */
export function rodRatioLimits({ cylinders }) {
  const reach = cylinders.map(
    ({ crank_radius: r, pin_offset: e }) => 0.999 * (r / (r + Math.abs(e))),
  );
  return [0.05, Math.floor(1000 * Math.min(LARGEST_ROD_RATIO, ...reach)) / 1000];
}

/**
 * The engine that an angle is applied to: cylinders and unbalances with directions as unit vectors.
 *
 * `figures` is what Python wrote of the engine; lengths in metres, masses in kilograms, degrees.
 */
export function configure(figures, settings) {
  const cylinders = figures.cylinders.map((given) => cylinderAt(figures, settings, given));
  return {
    cylinders,
    unbalances: unbalances(figures, cylinders),
    shafts: figures.shafts,
    spectrum: figures.spectrum,
    reference: figures.reference_z,
    cycle: figures.strokes === 2 ? 360 : 720,
    gas: Boolean(figures.gas),
    flywheel: figures.flywheel,
    firing: figures.firing_deg && cylinders.map((each) => each.strokes),
    settings,
  };
}

function cylinderAt(figures, settings, given) {
  const { crank_radius: r, pin_offset: e, bank } = given;
  const { x, y, ratio } = figures.cranks[given.crank];
  const l = settings.rod_ratio === null || settings.rod_ratio === r / given.rod_length
    ? given.rod_length
    : r / settings.rod_ratio;
  let [bankDeg, tdcDeg] = [given.bank_deg, given.tdc_deg];
  const { bank_angle_deg: bankAngle } = settings;
  if (bankAngle !== null && bankAngle !== figures.bank_angle_deg) {
    const half = 0.5 * bankAngle;
    bankDeg = figures.bisector_deg + (bank === 0 ? -half : half);
    // Of one crank alone, which has a bank angle.
    if (settings.hold === "pins") tdcDeg = reduced(bankDeg - (given.bank_deg - given.tdc_deg));
  }
  const pinDeg = bankDeg - ratio * tdcDeg;
  return {
    ...given,
    rod_length: l,
    proportions: proportions(r, l, e),
    tdc_deg: tdcDeg,
    bank_deg: bankDeg,
    pin_deg: pinDeg,
    ratio,
    axis: [x, y],
    // To which side the path of the piston pin is moved: that to which the crankpin swings.
    shift: Math.sign(ratio) * e,
    direction: unit(bankDeg),
    pin: unit(pinDeg),
    tdc: unit(tdcDeg),
    strokes: strokes(figures, given, tdcDeg, l),
    gas: gasLoad(figures, given, tdcDeg),
  };
}

/**
 * Crank angles at which the strokes of a cylinder begin, the power stroke first; null if the firing
 * order is not known. Strokes go from one turning point of the piston to the next.
 */
function strokes({ firing_deg: firing, strokes: count }, given, tdcDeg, rodLength) {
  if (!firing) return null;
  const [highest, lowest] = turningPoints(given.crank_radius, rodLength, given.pin_offset);
  const [before] = turningPoints(given.crank_radius, given.rod_length, given.pin_offset);
  // As many degrees later as its piston is highest later.
  const moved = tdcDeg - given.tdc_deg;
  const later = moved - 360 * Math.round(moved / 360) + highest - before;
  const cycle = count === 2 ? 360 : 720;
  const fires = reduced(firing[given.number - 1] + later, cycle);
  const down = lowest - highest;
  return count === 2
    ? [["power", fires, fires + down], ["compression", fires + down, fires + 360]]
    : [
        ["power", fires, fires + down],
        ["exhaust", fires + down, fires + 360],
        ["intake", fires + 360, fires + 360 + down],
        ["compression", fires + 360 + down, fires + 720],
      ];
}

/** Degrees after TDC at which the piston is highest and lowest: crank and rod are in line. */
function turningPoints(r, l, e) {
  return [Math.asin(e / (l + r)) / DEGREE, 180 + Math.asin(e / (l - r)) / DEGREE];
}

/** Everything that rotates: rotating masses and counterweights on their cranks, and balance shafts. */
function unbalances(figures, cylinders) {
  const found = [];
  for (const { rotating_mass: mass, crank_radius: r, pin, ratio, axis, z } of cylinders) {
    if (mass) found.push({ kind: "pin", ratio, axis, amount: mass * r, start: pin, z });
  }
  const main = { pin_deg: 0, ratio: 1, axis: [0, 0] };
  for (const { amount, angle_deg: angle, pin, z } of figures.counterweights) {
    const { pin_deg: from, ratio, axis } = pin === null ? main : cylinders[pin];
    // Ahead of the pin in the sense in which its crank turns.
    const start = unit(from + Math.sign(ratio) * angle);
    found.push({ kind: "counterweight", ratio, axis, amount, start, z });
  }
  for (const { ratio, x, y, unbalances: carried } of figures.shafts) {
    for (const { amount, angle_deg: angle, z } of carried) {
      found.push({ kind: "shaft", ratio, axis: [x, y], amount, start: unit(angle), z });
    }
  }
  return found;
}

/** The stroke that each cylinder is in at a crank angle; null where the firing is not known. */
export function strokesAt({ cylinders, cycle }, thetaDeg) {
  return cylinders.map(({ strokes: periods }) => {
    if (!periods) return null;
    const after = reduced(thetaDeg - periods[0][1], cycle) + periods[0][1];
    // Whatever rounding did: the first has begun.
    return periods.findLast(([, begin]) => after >= begin)[0];
  });
}
