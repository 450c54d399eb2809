// What the cross-section has besides the engine: numbers of pins and bores, and the crank as a handle.

import { DEGREE, add, reduced, scale } from "./complex.mjs";
import { centre, dragged, fixed, place, pointerIn, svg, translate } from "./dom.mjs";
import { boreEnds, pinOf } from "./scene.mjs";

const PIN_NUMBER = 13; // pixels beyond the pin's circle
const BORE_NUMBER = 8; // pixels beyond the head
const LINE = 12; // pixels
const CLOSE = 24; // degrees between pins whose numbers would overlap
const MOST_IN_LINE = 4;
const DIGIT = 6.5; // pixels, and those between two numbers
const SPACE = 3.5;
const SENSE = 17; // degrees of half an arrow

export class Handle {
  /** A drag begins at `angle()` and tells `turnTo` where it has come, in tenths of a degree. */
  constructor(scene, angle, turnTo) {
    this.scene = scene;
    this.hit = svg("circle", { class: "handle" });
    this.senses = svg("g");
    this.numbers = svg("g");
    scene.overlay.append(this.senses, this.numbers, this.hit);
    this.drag(angle, turnTo);
  }

  layout(engine) {
    const { projection, dimensions } = this.scene;
    const [cx, cy] = projection.point([0, 0, 0]);
    const reach = dimensions.radius * projection.scale;
    this.centre = [cx, cy];
    centre(this.hit, [cx, cy]);
    this.hit.setAttribute("r", 1.7 * reach);
    this.pins = pinNumbers(engine);
    const outside = PIN_NUMBER + LINE * (1.5 + Math.max(0, ...this.pins.map(({ level }) => level)));
    this.senses.replaceChildren(...engine.cranks.flatMap((crank, k) => {
      const [px, py] = projection.point([crank.x, crank.y, 0]);
      return [svg("circle", { class: "pin-circle", cx: px, cy: py, r: reach }),
        svg("path", { class: "sense", d: senseArrow(px, py, reach + outside, free(engine, k), Math.sign(crank.ratio)) })];
    }));
    this.axes = engine.cylinders.map(({ axis }) => axis);
    const bores = boreGroups(engine).map((group) => this.boreNumbers(group, engine));
    this.numbers.replaceChildren(...bores, ...this.pins.map(({ text }) => text));
  }

  /** Numbers of the cylinders of a bore beyond its head, or beside it where two pistons face each other. */
  boreNumbers(group, { cranks, cylinders }) {
    const { projection, size: [width] } = this.scene;
    const [{ direction, side_rods: hangs }] = group;
    const { axis, low, top, other: opposed, half } = boreEnds(group[0], cylinders);
    const along = opposed ? low + (hangs ? 0.75 : 0.25) * (top - low)
      : Math.max(...group.map((each) => boreEnds(each, cylinders).end));
    // Beside the bore away from the cranks, or to the left.
    const left = scale([-direction[1], direction[0]], direction[1] > 0 ? 1 : -1);
    const [x0, y0] = cranks.reduce((sum, each) => add(sum, scale([each.x, each.y], 1 / cranks.length)), [0, 0]);
    const away = (axis[0] - x0) * left[0] + (axis[1] - y0) * left[1];
    const towards = opposed ? scale(left, away < -1e-6 * half ? -1 : 1) : direction;
    const from = add(axis, add(scale(direction, along), scale(towards, opposed ? half : 0)));
    const [px, py] = projection.point([...from, 0]);
    const [dx, dy] = towards;
    const anchor = Math.abs(dx) < 0.05 ? "middle" : dx > 0 ? "start" : "end";
    const text = svg("text", { class: "bore-numbers", "text-anchor": anchor });
    const [x, y] = [px + BORE_NUMBER * dx, py - BORE_NUMBER * dy + 4];
    const room = anchor === "middle" ? Infinity : dx > 0 ? width - x : x;
    const digits = Math.max(...group.map(({ number }) => `${number}`.length));
    const inLine = Math.min(MOST_IN_LINE, Math.max(1, Math.floor((room + SPACE) / (DIGIT * digits + SPACE))));
    const lines = Math.ceil(group.length / inLine);
    for (let k = 0; k < lines; k++) {
      const line = svg("tspan", {}, ...listed(group.slice(k * inLine, (k + 1) * inLine)));
      // Above the head, below that of a hanging bore, and beside one that lies.
      place(line, [x, y + (k - 0.5 * (lines - 1) * (1 + dy)) * LINE]);
      text.append(line);
    }
    return text;
  }

  pose({ cylinders }) {
    for (const { first, text, level } of this.pins) {
      const { projection } = this.scene;
      const [a, b] = this.axes[first];
      const [cx, cy] = projection.point([a, b, 0]);
      const [x, y] = [cylinders[first].crankpin[0] - a, cylinders[first].crankpin[1] - b];
      const length = Math.hypot(x, y);
      const reach = length * projection.scale + PIN_NUMBER + level * LINE;
      translate(text, [cx + (reach * x) / length, cy - (reach * y) / length + 4]);
    }
  }

  drag(angle, turnTo) {
    let last;
    let reached;
    const turnedTo = (event) => {
      const { x, y } = pointerIn(this.scene.element, event);
      return Math.atan2(this.centre[1] - y, x - this.centre[0]) / DEGREE;
    };
    dragged(this.hit, (event, begins) => {
      const now = turnedTo(event);
      if (begins) {
        reached = angle();
        event.preventDefault();
      } else {
        const turned = now - last;
        reached += turned - 360 * Math.round(turned / 360);
        turnTo(Number(reached.toFixed(1)));
      }
      last = now;
    });
  }
}

/** Numbers of the cylinders at each crankpin, further out beside a close one; none for one pin. */
function pinNumbers({ cylinders }) {
  const groups = grouped(cylinders, pinOf);
  if (groups.length === 1) return [];
  const around = ([{ crank, pin_deg: angle }]) => 1e3 * crank + reduced(angle);
  groups.sort((a, b) => around(a) - around(b));
  let level = 0;
  return groups.map((group, k) => {
    level = k && around(group) - around(groups[k - 1]) < CLOSE ? (level + 1) % 3 : 0;
    return { first: group[0].number - 1, level, text: svg("text", { class: "pin-numbers" }, ...listed(group)) };
  });
}

/** Cylinders whose bores have one direction and one offset. */
function boreGroups({ cylinders }) {
  return grouped(cylinders, ({ bank, crank, direction, pin_offset: e, side_rods: hangs }) =>
    [bank, crank, hangs, ...direction.map((part) => part.toFixed(9)), e].join(" "));
}

function grouped(cylinders, keyOf) {
  const groups = {};
  for (const each of cylinders) (groups[keyOf(each)] ??= []).push(each);
  return Object.values(groups);
}

function listed(group) {
  return group.flatMap(({ number }, k) => [
    ...(k ? [" "] : []), fixed(svg, "tspan", "cylinder", number, `${number}`),
  ]);
}

/** Degrees at which there is room beside a crank: away from its bores, on the side that has no other crank. */
function free({ cranks, cylinders }, crank) {
  const [x, y] = cylinders.filter((each) => each.crank === crank).reduce((sum, { direction }) => add(sum, direction), [0, 0]);
  const away = Math.hypot(x, y) < 1e-6 ? -90 : Math.atan2(-y, -x) / DEGREE;
  const middle = cranks.reduce((sum, each) => sum + each.x / cranks.length, 0);
  const side = cranks[crank].x < middle ? -1 : 1;
  return [away + 45, away - 45].sort((a, b) => side * (Math.cos(b * DEGREE) - Math.cos(a * DEGREE)))[0];
}

/** An arc about degrees with a head, counter-clockwise with a sense of 1. */
function senseArrow(cx, cy, r, degrees, sense) {
  const at = (by, out = 0) => {
    const angle = (degrees + sense * by) * DEGREE;
    return [cx + (r + out) * Math.cos(angle), cy - (r + out) * Math.sin(angle)]
      .map((part) => part.toFixed(2)).join(" ");
  };
  return `M${at(-SENSE)}A${r} ${r} 0 0 ${sense > 0 ? 0 : 1} ${at(SENSE)}`
    + `M${at(SENSE - 10, -5)}L${at(SENSE)}L${at(SENSE - 9, 5)}`;
}
