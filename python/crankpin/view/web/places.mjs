// Places of an engine's parts, to draw them: as it is built at settings, and at a crank angle.

import { add, multiply, reduced, scale, unit } from "./complex.mjs";
import { shiftOf } from "./numbers.mjs";
import { column, crankAt, factorsAt, realSum, summed, turnedBy, unturned } from "./series.mjs";

/** Settings that leave the engine as it was given. */
export function ownSettings({ rpm, bank_angle_deg, rod_ratio }) {
  return { rpm, bank_angle_deg, rod_ratio, hold: "pins" };
}

/**
 * The engine that an angle is applied to: cylinders and weights with directions as unit vectors.
 *
 * `figures` is what Python wrote of the engine; lengths in metres, degrees.
 */
export function configure(figures, settings) {
  const [before, motions] = [figures, settings].map(({ rod_ratio: ratio }) => motionsAt(figures, ratio));
  const cylinders = figures.cylinders.map((given) =>
    cylinderAt(figures, settings, given, before[given.motion], motions[given.motion]));
  return {
    cylinders,
    cranks: figures.cranks,
    weights: weights(figures, cylinders),
    shafts: figures.shafts,
    cycle: figures.strokes === 2 ? 360 : 720,
    // After which all that is drawn repeats.
    period: 360 * figures.turns,
    firing: figures.firing_deg && cylinders.map((each) => each.strokes),
    settings,
  };
}

/**
 * How pistons move at a rod ratio, in crank radii above the end of a rod that stands along the bore: phasors of
 * heights, degrees after TDC at which they are highest and lowest, and heights there.
 */
function motionsAt({ motions, rod_ratios: ratios }, ratio) {
  const factor = factorsAt(ratios, ratio);
  return motions.map(({ height, turning }) => {
    const ends = summed(turning, factor, unturned);
    const [angles, heights] = [0, 1].map((place) => ends.get(place)[0]);
    return { height: column(summed(height, factor, unturned), 0), angles, heights };
  });
}

function cylinderAt(figures, settings, given, before, motion) {
  const { crank_radius: r, pin_offset: e } = given;
  const { x, y, ratio } = figures.cranks[given.crank];
  const own = settings.rod_ratio === figures.rod_ratio;
  const l = own ? given.rod_length : r / settings.rod_ratio;
  // An infinite rod is drawn as the bar of a Scotch yoke, which stays on the bore's axis.
  const yoke = own && given.yoke;
  const { turned, delay } = shiftOf(figures, settings, given.bank);
  const bankDeg = given.bank_deg + turned;
  const tdcDeg = given.tdc_deg + delay;
  const pinDeg = bankDeg - ratio * tdcDeg;
  return {
    ...given,
    rod_length: l,
    height: motion.height,
    /** Heights of the piston pin where the piston is highest and lowest. */
    extremes: motion.heights.map((height) => l + r * height),
    yoke,
    tdc_deg: tdcDeg,
    pin_deg: pinDeg,
    ratio,
    axis: [x, y],
    // To which side the path of the piston pin is moved: that to which the crankpin swings.
    shift: Math.sign(ratio) * e,
    direction: unit(bankDeg),
    pin: unit(pinDeg),
    tdc: unit(tdcDeg),
    strokes: strokes(figures, given, delay, before.angles, motion.angles),
    endStrokes: given.crank_end ? endStrokes(figures, given, delay, motion.angles) : null,
  };
}

/**
 * Crank angles at which the strokes of a cylinder begin, the power stroke first; null if the firing
 * order is not known. Strokes go from one turning point of the piston to the next.
 */
function strokes({ firing_deg: firing, strokes: count }, given, delay, [before], [highest, lowest]) {
  if (!firing || firing[given.number - 1] === null) return null;
  const cycle = count === 2 ? 360 : 720;
  // As many degrees later as its piston is highest later.
  const fires = reduced(firing[given.number - 1] + delay + highest - before, cycle);
  return periods(count, fires, lowest - highest);
}

/** The same of the chamber at a crank end, which grows as the piston rises; at a head end beyond side rods as it falls. */
function endStrokes({ strokes: count }, { side_rods: hangs, crank_end: end }, delay, [highest, lowest]) {
  const falls = lowest - highest;
  return hangs
    ? periods(count, end.pressure_deg + highest + delay, falls)
    : periods(count, end.pressure_deg + delay, 360 - falls);
}

/** Strokes of a chamber that begins to grow at an angle, for so many degrees. */
function periods(count, begins, grows) {
  return count === 2
    ? [["power", begins, begins + grows], ["compression", begins + grows, begins + 360]]
    : [
        ["power", begins, begins + grows],
        ["exhaust", begins + grows, begins + 360],
        ["intake", begins + 360, begins + 360 + grows],
        ["compression", begins + 360 + grows, begins + 720],
      ];
}

/** Counterweights on their cranks, and those of balance shafts. */
function weights(figures, cylinders) {
  const counterweights = figures.counterweights.map(({ amount, angle_deg: angle, pin, z, crank }) => {
    if (pin === null) {
      const { x, y, ratio } = figures.cranks[crank];
      return { kind: "counterweight", ratio, axis: [x, y], amount, start: unit(angle), z };
    }
    const { pin_deg: from, ratio, axis } = cylinders[pin];
    // Ahead of the pin in the sense in which its crank turns.
    const start = unit(from + Math.sign(ratio) * angle);
    return { kind: "counterweight", ratio, axis, amount, start, z };
  });
  const onShafts = figures.shafts.flatMap(({ ratio, x, y, unbalances }) =>
    unbalances.map(({ amount, angle_deg: angle, z }) =>
      ({ kind: "shaft", ratio, axis: [x, y], amount, start: unit(angle), z })));
  return [...counterweights, ...onShafts];
}

/** The stroke that each cylinder is in at a crank angle; null where the firing is not known. */
export function strokesAt({ cylinders, cycle }, thetaDeg) {
  return cylinders.map(({ strokes: own }) => strokeAt(own, cycle, thetaDeg));
}

function strokeAt(strokes, cycle, thetaDeg) {
  if (!strokes) return null;
  const after = reduced(thetaDeg - strokes[0][1], cycle) + strokes[0][1];
  // Whatever rounding did: the first has begun.
  return strokes.findLast(([, begin]) => after >= begin)[0];
}

/** Places in metres at a crank angle in degrees, and directions of weights. */
export function placesAt({ cylinders, weights: all, cycle }, thetaDeg) {
  const crank = crankAt(thetaDeg);
  return {
    thetaDeg,
    crank,
    cylinders: hung(cylinders, cylinders.map((each) => cylinderPlaces(each, crank))),
    crankEnds: cylinders.map(({ endStrokes: ends }) => strokeAt(ends, cycle, thetaDeg)),
    weights: all.map((each) => multiply(each.start, turnedBy(crank, each.ratio))),
  };
}

/** The same places, with the feet of link rods at their knuckles, which turn with the master rods. */
function hung(cylinders, places) {
  return places.map((place, k) => {
    const { link } = cylinders[k];
    if (!link) return place;
    const { crankpin, wrist } = places[link.master];
    const [x, y] = [wrist[0] - crankpin[0], wrist[1] - crankpin[1]];
    const shank = scale([x, y], link.radius / Math.hypot(x, y));
    return { ...place, foot: add(crankpin, multiply(shank, unit(link.angle_deg))) };
  });
}

function cylinderPlaces(cylinder, crank) {
  const { ratio, axis, crank_radius: r, rod_length: l } = cylinder;
  const past = multiply(crank, [cylinder.tdc[0], -cylinder.tdc[1]]);
  // Offsets are on the side to which the crankpin swings, so that either sense moves the piston alike.
  const height = l + r * realSum(cylinder.height, turnedBy(past, Math.abs(ratio)));
  const [dx, dy] = cylinder.direction;
  const crankpin = add(axis, scale(multiply(turnedBy(crank, ratio), cylinder.pin), r));
  // The path of the piston pin lies left of the bore's direction by the offset, on a crank that turns as
  // the main one does.
  const wrist = add(axis, [height * dx - cylinder.shift * dy, height * dy + cylinder.shift * dx]);
  const foot = cylinder.yoke
    ? add(axis, scale(cylinder.direction, height - l)) : crankpin;
  return { height, crankpin, foot, wrist };
}
