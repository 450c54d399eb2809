// The engine drawn in a projection, from its geometry: bores, pistons, rods, crank, weights, shafts.

import { add, multiply, scale, unit } from "./complex.mjs";
import { fixed, path, place, svg, translate } from "./dom.mjs";
import { Projection, hull } from "./projection.mjs";
import { STRINGS } from "./strings.mjs";

// What inertia does not depend on, in crank radii: chosen to look like an engine.
export const BORE = 1.7;
const CROWN = 0.8; // above the piston pin
const SKIRT = 0.6; // below it
const BAND = 0.28; // of the crown, coloured by the stroke
const HEAD = 0.1; // between the highest crown and the head
const SLIPPER = 0.25; // half the length of a crosshead
const SIDE_RODS = 1.1; // from the axis of the bore
const WEIGHT = 1.3; // radius of the largest counterweight
const SHAFT_WEIGHT = 0.55;

/** What is drawn over what at the same depth. */
const RANKS = {
  end: ["shaft", "bore", "journal", "weight", "piston", "rod", "throw"],
  other: ["shaft", "bore", "journal", "weight", "throw", "rod", "piston"],
};

/** Part of a crank radius within which places along the crank are one. */
const ONE_PLACE = 1e-6;

/** How much lengths along the crank are stretched where cylinders stand closer than bores allow. */
export function stretchAlong({ cylinders }) {
  let least = Infinity;
  for (const a of cylinders) {
    for (const b of cylinders) {
      const apart = Math.abs(a.z - b.z);
      if (a !== b && a.bank === b.bank && apart > ONE_PLACE * a.crank_radius) {
        least = Math.min(least, apart / (BORE * Math.max(a.crank_radius, b.crank_radius)));
      }
    }
  }
  return Math.max(1, 1.1 / least);
}

/** The motion of a body that stands still: displacement of a point, and a small rotation, about x, y and z. */
export const STILL = { at: () => [0, 0, 0], turn: [0, 0, 0] };

export class Scene {
  /** `frame` names a projection; the picture is `size` pixels before it is scaled. */
  constructor(frame, size, margin = [14, 14]) {
    this.size = size;
    this.margin = margin;
    this.engineLayer = svg("g");
    this.overlay = svg("g");
    /** Points that the picture contains besides the engine. */
    this.around = [];
    this.element = svg("svg", { viewBox: `0 0 ${size.join(" ")}`, role: "img" },
      this.engineLayer, this.overlay);
    this.items = null;
    this.look(frame);
  }

  /** Look at the engine in another projection, once it is laid out anew. */
  look(frame) {
    this.projection = new Projection(frame);
    this.element.setAttribute("class", `scene ${frame}`);
    this.element.setAttribute("aria-label", STRINGS.described[frame]);
  }

  /** Draw an engine, to be posed next; the same one as before at any settings. */
  layout(engine) {
    const { projection } = this;
    this.dimensions = dimensions(engine);
    projection.fit([...extremes(engine, this.dimensions), ...this.around], this.size, this.margin,
      this.dimensions.stretch);
    this.items ??= this.parts(engine);
    this.shapes = new Map();
    const ranks = projection.name === "cross" ? RANKS.end : RANKS.other;
    for (const item of this.items) item.depth = item.layout(engine);
    const order = [...this.items].sort(
      (a, b) => a.depth - b.depth || ranks.indexOf(a.kind) - ranks.indexOf(b.kind));
    // Moving elements about takes longer than drawing them.
    if (order.some(({ element }, k) => this.engineLayer.childNodes[k] !== element)) {
      this.engineLayer.replaceChildren(...order.map(({ element }) => element));
    }
  }

  /** Move everything to a pose, displaced by a motion, such as `STILL`. */
  pose(pose, strokes, motion) {
    for (const item of this.items) item.pose(pose, strokes, motion);
  }

  /** A place in metres, displaced with the engine. */
  at([x, y], z, motion) {
    const [dx, dy, dz] = motion.at([x, y, z]);
    return this.projection.point([x + dx, y + dy, z + dz]);
  }

  /** Put an element that is drawn about a place there, turned with the engine. */
  put(element, place, z, motion) {
    translate(element, this.at(place, z, motion), this.projection.about(motion.turn));
  }

  // Each part is an element, how it is laid out (which returns its depth), and how it is posed.

  parts({ cylinders, shafts, weights }) {
    const { places } = this.dimensions;
    return [
      ...cylinders.flatMap((each, k) => [this.bore(k), this.throw(k), this.rod(k),
        ...(boreEnds(each, cylinders).rod ? [this.crosshead(k)] : []), this.piston(k)]),
      ...places.flatMap((of, crank) => [...of, 0].map((_, k) => this.journal(crank, k))),
      ...shafts.map((_, k) => this.shaft(k)),
      ...weights.map((_, k) => this.weight(k)),
    ];
  }

  bore(k) {
    const element = svg("path", { class: "bore" });
    let ends;
    let z;
    return {
      kind: "bore",
      element,
      layout: ({ cylinders }) => {
        const { direction } = cylinders[k];
        z = cylinders[k].z;
        ends = boreEnds(cylinders[k], cylinders);
        // Pistons that face each other have one bore.
        element.toggleAttribute("hidden", ends.other?.number < cylinders[k].number);
        const places = this.projection.tube(direction, ends.low, ends.top, (BORE / 2) * ends.size);
        element.setAttribute("d", path(places, true));
        return this.projection.depth([...add(cylinders[k].axis, scale(direction, ends.low)), z]);
      },
      pose: (_pose, _strokes, motion) => this.put(element, ends.axis, z, motion),
    };
  }

  piston(k) {
    const [body, band, top, foot] = ["body", "band", "crown", "band"].map((name) => svg("path", { class: name }));
    const crankEnd = svg("g", {}, foot);
    const element = svg("g", { class: "piston" }, body, band, top);
    let number = null;
    let [stroke, endStroke] = [null, null];
    let z;
    let rod;
    return {
      kind: "piston",
      element,
      layout: ({ cylinders }) => {
        const { projection } = this;
        const { direction, rod_length: l, number: name, side_rods: hangs, crank_end: end } = cylinders[k];
        const ends = boreEnds(cylinders[k], cylinders);
        const r = ends.size;
        // The crown of a piston with side rods is towards the crank.
        const shape = this.pistonShape(hangs ? scale(direction, -1) : direction, r);
        z = cylinders[k].z;
        rod = scale(direction, ends.rod);
        if (end) {
          foot.setAttribute("d", shape.foot);
          body.after(crankEnd);
        }
        body.setAttribute("d", shape.body);
        band.setAttribute("d", shape.band);
        top.setAttribute("d", shape.crown);
        if (projection.name !== "cross") {
          if (!number) {
            number = fixed(svg, "text", "cylinder", name, `${name}`, { class: "on-piston" });
            element.append(number);
          }
          place(number, shape.middle);
          number.setAttribute("font-size", Math.min(Math.max(0.8 * r * projection.scale, 7), 15));
        }
        return projection.depth([...add(cylinders[k].axis, scale(direction, l)), z]);
      },
      pose: (pose, strokes, motion) => {
        this.put(element, add(pose.cylinders[k].wrist, rod), z, motion);
        if (pose.crankEnds[k] !== endStroke) {
          endStroke = pose.crankEnds[k];
          crankEnd.setAttribute("class", endStroke ?? "");
        }
        if (strokes[k] !== stroke) {
          stroke = strokes[k];
          element.setAttribute("class", `piston ${stroke ?? ""}`);
        }
      },
    };
  }

  /** Outlines of a piston about its pin, and where its number stands: once for all that are alike. */
  pistonShape(direction, r) {
    const key = `${direction} ${r}`;
    if (!this.shapes.has(key)) {
      const { projection } = this;
      const radius = (BORE / 2) * r;
      const outline = (from, to) => path(projection.tube(direction, from * r, to * r, radius), true);
      const [cx, cy] = projection.vector([...direction.map((part) => part * CROWN * r), 0]);
      const depth = projection.depth([...direction, 0]);
      const facing = depth > 0;
      const crown = projection.ellipse(direction, radius).arc(0, 2 * Math.PI, 28);
      this.shapes.set(key, {
        body: outline(-SKIRT, CROWN),
        band: outline(CROWN - BAND, CROWN),
        foot: outline(-SKIRT, BAND - SKIRT),
        crown: facing ? path(crown.map(([x, y]) => [x + cx, y + cy]), true) : "",
        // Of pistons seen from below the rod covers the pin.
        middle: facing ? [cx, cy] : depth > -ONE_PLACE ? [0, 0] : [0.5 * cx, 0.5 * cy],
      });
    }
    return this.shapes.get(key);
  }

  rod(k) {
    const bar = new Bar("rod");
    let z;
    return {
      kind: "rod",
      element: bar.element,
      layout: ({ cylinders }) => {
        const { direction, rod_length: length, crank_radius: r } = cylinders[k];
        z = cylinders[k].z;
        bar.width = 0.3 * r * this.projection.scale;
        return this.projection.depth([...add(cylinders[k].axis, scale(direction, 0.5 * length)), z]);
      },
      pose: ({ cylinders }, _strokes, motion) => {
        const { foot, wrist } = cylinders[k];
        bar.draw([this.at(foot, z, motion), this.at(wrist, z, motion)]);
      },
    };
  }

  /** A crosshead outside the cylinder, and its piston rod; or side rods and the beam above the cylinder. */
  crosshead(k) {
    const bars = [new Bar("rod"), new Bar("rod")];
    let ends;
    let direction;
    let z;
    return {
      kind: "rod",
      element: svg("g", { class: "crosshead" }, ...bars.map(({ element }) => element)),
      layout: ({ cylinders }) => {
        ({ direction, z } = cylinders[k]);
        ends = boreEnds(cylinders[k], cylinders);
        const wide = ends.beam ? [0.16, 0.12] : [0.9, 0.22];
        bars.forEach((bar, place) => { bar.width = wide[place] * ends.size * this.projection.scale; });
        return this.projection.depth([...add(cylinders[k].axis, scale(direction, cylinders[k].rod_length)), z]);
      },
      pose: ({ cylinders }, _strokes, motion) => {
        const { size, rod, beam } = ends;
        const at = (along, across = 0) => {
          const [x, y] = add(cylinders[k].wrist, multiply(direction, [along, across * size]));
          return this.at([x, y], z, motion);
        };
        const [yoke, stem] = bars;
        yoke.draw(beam
          ? [at(0), at(0, SIDE_RODS), at(beam, SIDE_RODS), at(beam, -SIDE_RODS), at(0, -SIDE_RODS), at(0)]
          : [at(-SLIPPER * size), at(SLIPPER * size)]);
        stem.draw([at(beam), at(rod)]);
      },
    };
  }

  throw(k) {
    const bar = new Bar("throw");
    let axis;
    let drawn;
    let z;
    return {
      kind: "throw",
      element: bar.element,
      layout: ({ cylinders }) => {
        ({ axis, z } = cylinders[k]);
        // Those that share a crankpin have one throw.
        drawn = cylinders.findIndex((each) => each.z === z && pinOf(each) === pinOf(cylinders[k])) === k;
        bar.element.toggleAttribute("hidden", !drawn);
        bar.width = 0.46 * cylinders[k].crank_radius * this.projection.scale;
        return this.projection.depth([...axis, z]);
      },
      pose: ({ cylinders }, _strokes, motion) => {
        if (!drawn) return;
        const { crankpin } = cylinders[k];
        const half = this.dimensions.halfThrow;
        bar.draw([
          this.at(axis, z - half, motion), this.at(crankpin, z - half, motion),
          this.at(crankpin, z + half, motion), this.at(axis, z + half, motion),
        ]);
      },
    };
  }

  /** A crank's axis between two throws, or beyond the first and the last. */
  journal(crank, k) {
    const bar = new Bar("journal");
    let axis;
    let start;
    let stop;
    return {
      kind: "journal",
      element: bar.element,
      layout: ({ cranks }) => {
        const { halfThrow, ends, radius } = this.dimensions;
        const places = this.dimensions.places[crank];
        axis = [cranks[crank].x, cranks[crank].y];
        start = k ? places[k - 1] + halfThrow : ends[0];
        stop = k < places.length ? places[k] - halfThrow : ends[1];
        bar.width = 0.52 * radius * this.projection.scale;
        return this.projection.depth([...axis, 0.5 * (start + stop)]);
      },
      pose: (_pose, _strokes, motion) =>
        bar.draw([this.at(axis, start, motion), this.at(axis, stop, motion)]),
    };
  }

  shaft(k) {
    const bar = new Bar("shaft");
    let axis;
    return {
      kind: "shaft",
      element: bar.element,
      layout: ({ shafts }) => {
        axis = [shafts[k].x, shafts[k].y];
        bar.width = 0.22 * this.dimensions.radius * this.projection.scale;
        return this.projection.depth([...axis, this.dimensions.ends[0]]);
      },
      pose: (_pose, _strokes, motion) =>
        bar.draw(this.dimensions.ends.map((z) => this.at(axis, z, motion))),
    };
  }

  weight(k) {
    const element = svg("path");
    const rim = [-60, -40, -20, 0, 20, 40, 60].map((angle) => unit(angle));
    let axis;
    let reach;
    let z;
    return {
      kind: "weight",
      element,
      layout: ({ weights }) => {
        const { kind, amount } = weights[k];
        const { radius, largestWeight } = this.dimensions;
        ({ axis, z } = weights[k]);
        const size = (kind === "shaft" ? SHAFT_WEIGHT : WEIGHT) * radius;
        // The area of the picture goes with the unbalance.
        reach = size * Math.sqrt(amount / largestWeight[kind] || 0);
        element.setAttribute("class", `weight ${kind}`);
        return this.projection.depth([...axis, z]);
      },
      pose: ({ weights }, _strokes, motion) => {
        const points = [axis, ...rim.map((by) => add(axis, scale(multiply(weights[k], by), reach)))];
        const thick = 0.4 * this.dimensions.halfThrow;
        const faces = [z - thick, z + thick].flatMap((at) => points.map((point) => this.at(point, at, motion)));
        element.setAttribute("d", path(hull(faces), true));
      },
    };
  }
}

/** A round bar along points, outlined. Points are no properties of style, as paths are: none is found anew in each frame. */
class Bar {
  constructor(name) {
    this.lines = ["casing", "core"].map((line) => svg("polyline", { class: line }));
    this.element = svg("g", { class: name }, ...this.lines);
  }

  set width(pixels) {
    const width = Math.max(pixels, 2);
    this.lines.forEach((line, k) => line.setAttribute("stroke-width", (width + 2 - 2 * k).toFixed(2)));
  }

  draw(points) {
    const drawn = points.flat().map((part) => part.toFixed(2)).join(" ");
    if (drawn === this.drawn) return;
    this.drawn = drawn;
    for (const line of this.lines) line.setAttribute("points", drawn);
  }
}

/** What cylinders have in common whose crankpins look like one from the front. */
export const pinOf = ({ pin, crank, crank_radius: r }) => [crank, ...pin.map((part) => (part * r).toFixed(9))].join(" ");

function dimensions(engine) {
  const { cranks, cylinders, weights } = engine;
  const radius = Math.max(...cylinders.map((each) => each.crank_radius));
  const distinct = (some) => [...new Set(some.map((each) => each.z))].sort((a, b) => a - b);
  const all = distinct([...cylinders, ...weights]);
  /** Where the throws of each crank stand. */
  const places = cranks.map((_, k) => distinct(cylinders.filter(({ crank }) => crank === k)));
  const stretch = stretchAlong(engine);
  const gaps = places.flatMap((of) => of.slice(1).map((z, k) => z - of[k])).filter((gap) => gap > ONE_PLACE * radius);
  const halfThrow = 0.3 * Math.min(BORE * radius / stretch, ...gaps);
  const overhang = (0.75 * BORE * radius) / stretch;
  const largestWeight = {};
  for (const { kind, amount } of weights) {
    largestWeight[kind] = Math.max(largestWeight[kind] ?? 0, amount);
  }
  const ends = [all[0] - overhang, all.at(-1) + overhang];
  return { radius, places, stretch, halfThrow, ends, largestWeight };
}

/**
 * Lower end and head of a bore and where its axis passes its crank's; the `other` piston that faces this one in it,
 * the crank radius to whose scale it is drawn, and where it and what is beside it end. Crossheads stay outside: `rod`
 * is the length from the piston's to the piston, `beam` that to the beam above the cylinder that side rods carry.
 */
export function boreEnds(cylinder, cylinders) {
  const { crank_radius: r, crank_end: crankEnd, number, fires_as: chamber, extremes: [highest, lowest] } = cylinder;
  const other = cylinders.find((each) => each.fires_as === chamber && each.number !== number);
  const axis = pathOf(cylinder);
  const pair = other ? [cylinder, other] : [cylinder];
  const hanging = pair.find((each) => each.side_rods);
  const ends = (size, parts) => ({ axis, other, size, rod: 0, beam: 0, half: (BORE / 2) * size, end: parts.top, ...parts });
  if (!hanging && (other || !crankEnd)) {
    const plain = ({ crank_radius: size, extremes }) => Math.max(extremes[1] - SKIRT * size, 1.1 * size);
    const apart = other ? Math.hypot(...add(axis, scale(pathOf(other), -1))) - plain(other) : 0;
    return ends(r, { low: plain(cylinder), top: apart || highest + (CROWN + HEAD) * r });
  }
  const size = Math.max(...pair.map((each) => each.crank_radius));
  const low = Math.max(...pair.map((each) => each.extremes[0])) + (SLIPPER + HEAD) * size;
  const lower = pair.find((each) => each !== hanging);
  const rod = lower ? low + (SKIRT + HEAD) * size - lower.extremes[1] : 0;
  // The head, or where two pistons meet.
  const meet = lower ? lower.extremes[0] + rod + (CROWN + HEAD) * size : low;
  if (!hanging) return ends(size, { low, top: meet, rod });
  const upper = meet + (CROWN + HEAD) * size - hanging.extremes[1];
  const top = hanging.extremes[0] + upper + (SKIRT + HEAD) * size;
  const half = (SIDE_RODS + HEAD) * size;
  if (cylinder !== hanging) return ends(size, { low, top, rod, half });
  const beam = top + 2 * HEAD * size - lowest;
  return ends(size, { low, top, rod: upper, beam, half, end: highest + beam + 2 * HEAD * size });
}

/** Where the path of a piston passes its crank's axis. */
function pathOf({ axis, shift, direction: [dx, dy] }) {
  return add(axis, [-shift * dy, shift * dx]);
}

/** Points that a picture of the engine must contain. */
function extremes(engine, { radius, ends, stretch }) {
  const around = (x, y, z, reach) => [[x - reach, y - reach, z], [x + reach, y + reach, z],
    [x - reach, y + reach, z], [x + reach, y - reach, z]];
  const points = ends.flatMap((z) => around(0, 0, z, WEIGHT * radius));
  for (const { axis: [x, y] } of engine.cylinders) {
    points.push(...ends.flatMap((z) => around(x, y, z, WEIGHT * radius)));
  }
  for (const { x, y } of engine.shafts) {
    points.push(...ends.flatMap((z) => around(x, y, z, SHAFT_WEIGHT * radius)));
  }
  for (const cylinder of engine.cylinders) {
    const { direction: [dx, dy], z } = cylinder;
    const { end: top, axis, half } = boreEnds(cylinder, engine.cylinders);
    for (const side of [-half, half]) {
      for (const along of [z - half / stretch, z + half / stretch]) {
        points.push([axis[0] + top * dx - side * dy, axis[1] + top * dy + side * dx, along]);
      }
    }
  }
  return points;
}
