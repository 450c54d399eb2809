// What the cross-section has besides the engine: numbers of pins and bores, and the crank as a handle.

import { DEGREE, reduced } from "./complex.mjs";
import { centre, dragged, fixed, place, svg, translate } from "./dom.mjs";
import { boreEnds, pinOf } from "./scene.mjs";

const PIN_NUMBER = 13; // pixels beyond the pin's circle
const BORE_NUMBER = 9; // pixels beyond the head
const LINE = 12; // pixels
const CLOSE = 24; // degrees between pins whose numbers would overlap
const MOST_IN_LINE = 4;

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
    this.senses.replaceChildren(...engine.cranks.flatMap(({ x, y, ratio }) => {
      const [px, py] = projection.point([x, y, 0]);
      return [svg("circle", { class: "pin-circle", cx: px, cy: py, r: reach }),
        svg("path", { class: "sense", d: senseArrow(px, py, reach + outside, Math.sign(ratio)) })];
    }));
    this.axes = engine.cylinders.map(({ axis }) => axis);
    const bores = boreGroups(engine).map((group) => {
      const [dx, dy] = group[0].direction;
      const { axis } = boreEnds(group[0]);
      const top = Math.max(...group.map((each) => boreEnds(each).top));
      const [headX, headY] = projection.point([axis[0] + top * dx, axis[1] + top * dy, 0]);
      const anchor = Math.abs(dx) < 0.05 ? "middle" : dx > 0 ? "start" : "end";
      const text = svg("text", { class: "bore-numbers", "text-anchor": anchor });
      const [x, y] = [headX + BORE_NUMBER * dx, headY - BORE_NUMBER * dy + 4];
      const lines = Math.ceil(group.length / MOST_IN_LINE);
      for (let k = 0; k < lines; k++) {
        const part = group.slice(k * MOST_IN_LINE, (k + 1) * MOST_IN_LINE);
        const line = svg("tspan", {}, ...listed(part));
        place(line, [x, y - (lines - 1 - k) * LINE]);
        text.append(line);
      }
      return text;
    });
    this.numbers.replaceChildren(...bores, ...this.pins.map(({ text }) => text));
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
    const pointed = (event) => {
      // The picture may be scaled: back from the screen to its own pixels.
      const at = new DOMPoint(event.clientX, event.clientY)
        .matrixTransform(this.scene.element.getScreenCTM().inverse());
      return Math.atan2(this.centre[1] - at.y, at.x - this.centre[0]) / DEGREE;
    };
    dragged(this.hit, (event, begins) => {
      const now = pointed(event);
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
  return grouped(cylinders, ({ bank, crank, direction, pin_offset: e }) =>
    [bank, crank, ...direction.map((part) => part.toFixed(9)), e].join(" "));
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

/** An arc with a head, counter-clockwise; clockwise, its image in the mirror, with a sense of −1. */
function senseArrow(cx, cy, r, sense) {
  const at = (degrees, by = 0) => {
    const angle = degrees * DEGREE;
    return [cx + sense * (r + by) * Math.cos(angle), cy - (r + by) * Math.sin(angle)]
      .map((part) => part.toFixed(2)).join(" ");
  };
  return `M${at(-62)}A${r} ${r} 0 0 ${sense > 0 ? 0 : 1} ${at(-28)}M${at(-38, -5)}L${at(-28)}L${at(-37, 5)}`;
}
