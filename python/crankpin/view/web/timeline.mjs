// Histories of force, moment and torque over a cycle, above the strokes of each cylinder: one cursor.

import { reduced } from "./complex.mjs";
import { fixed, numbered, path, show, svg } from "./dom.mjs";
import { STRINGS } from "./strings.mjs";

const CURVE = 76; // height of a history, pixels
const GAP = 24;
const ROW = 17;
const AXIS = 22;
const NARROW = 560;

export class Timeline {
  /** `turnTo` is told of the angle within the cycle that the reader points at. */
  constructor(turnTo) {
    this.element = svg("svg", {
      class: "timeline", role: "img", "aria-label": STRINGS.timelineDescribed,
    });
    this.cursor = svg("path", { class: "cursor" });
    [this.axis, this.curves, this.rows] = [svg("g"), svg("g"), svg("g")];
    this.element.append(this.axis, this.curves, this.rows, this.cursor);
    this.scrub(turnTo);
  }

  /** Draw everything for a width in pixels; `histories` are the rows of curves, from the top. */
  layout(engine, histories, width) {
    const narrow = width < NARROW;
    this.cycle = engine.cycle;
    this.left = narrow ? 48 : 64;
    this.right = width - (narrow ? 80 : 84);
    this.dots = [];
    const top = 20 + histories.length * (CURVE + GAP);
    this.bottom = top + engine.cylinders.length * ROW;
    this.curves.replaceChildren(
      ...histories.flatMap((each, k) => this.history(each, 20 + k * (CURVE + GAP))));
    this.curves.append(...this.dots.map(({ dot }) => dot));
    // Rows change seldom: with the bank angle, or with the width.
    const rows = JSON.stringify([width, engine.cylinders.map((each) => [each.tdc_deg, each.strokes])]);
    if (rows === this.rowsShown) return;
    this.rowsShown = rows;
    this.element.setAttribute("viewBox", `0 0 ${width} ${this.bottom + AXIS}`);
    this.element.setAttribute("height", this.bottom + AXIS);
    this.axis.replaceChildren(...this.ticks(this.bottom, narrow ? 180 : 90));
    this.heights = [];
    this.rows.replaceChildren(
      ...engine.cylinders.flatMap((cylinder, k) => this.row(cylinder, top + k * ROW)));
  }

  /** Move the cursor, the dots on the curves and the pistons' heights. */
  pose(pose) {
    const x = this.x(reduced(pose.thetaDeg, this.cycle)).toFixed(2);
    this.cursor.setAttribute("d", `M${x} 4V${this.bottom}`);
    for (const { dot, value, y } of this.dots) {
      dot.setAttribute("cx", x);
      dot.setAttribute("cy", y(value(pose)).toFixed(2));
    }
    this.heights.forEach((element, k) => {
      const { height } = pose.cylinders[k];
      show(element, height, `${(height * 1e3).toFixed(2)} ${STRINGS.millimetres}`);
    });
  }

  x(angle) {
    return this.left + ((this.right - this.left) * angle) / this.cycle;
  }

  history({ title, largest, scale, curves, missing }, top) {
    const middle = top + CURVE / 2;
    const y = (value) => middle - (value / largest) * (CURVE / 2 - 3);
    const parts = [
      svg("path", { class: "zero-line", d: `M${this.left} ${middle}H${this.right}` }),
      svg("path", { class: "frame", d: `M${this.left} ${top}V${top + CURVE}` }),
      svg("text", { class: "title", x: this.left, y: top - 6 }, title),
    ];
    if (missing) {
      return [...parts, svg("text", { class: "note", x: this.left + 8, y: middle - 5 }, missing)];
    }
    for (const [value, at] of [[largest, top + 7], [-largest, top + CURVE + 1]]) {
      parts.push(fixed(svg, "text", "tick", value, scale.text(value), {
        class: "tick", x: this.left - 5, y: at,
      }));
    }
    parts.push(svg("text", { class: "tick", x: this.left - 5, y: middle + 4 }, scale.unit));
    for (const { name, label, samples, value } of curves) {
      const turn = samples.length - 1;
      const points = Array.from({ length: (turn * this.cycle) / 360 + 1 }, (_, k) =>
        [this.x((360 * k) / turn), y(samples[k % turn])]);
      parts.push(svg("path", { class: `curve ${name}`, d: path(points) }));
      this.dots.push({ dot: svg("circle", { class: `dot ${name}`, r: 3.2 }), value, y });
      if (label) {
        parts.push(svg("text", {
          class: `curve-name ${name}`, x: this.right + 8, y: middle + (name === "x" ? -4 : 14),
        }, label));
      }
    }
    return parts;
  }

  row(cylinder, top) {
    const { number, tdc_deg: tdc, strokes } = cylinder;
    const middle = top + ROW / 2;
    const parts = [
      fixed(svg, "text", "cylinder", number, `${number}`, {
        class: "tick", x: this.left - 8, y: middle + 4,
      }),
      svg("path", { class: "zero-line", d: `M${this.left} ${middle}H${this.right}` }),
    ];
    for (const [name, begin, end] of strokes ?? []) {
      for (const [from, to] of wrapped(begin, end, this.cycle)) {
        parts.push(svg("rect", {
          class: `stroke ${name}`, x: this.x(from), y: top + 2,
          width: this.x(to) - this.x(from), height: ROW - 4,
        }));
      }
    }
    for (let angle = reduced(tdc); angle < this.cycle; angle += 360) {
      parts.push(svg("path", { class: "tdc", d: `M${this.x(angle)} ${top + 1}v${ROW - 2}` }));
    }
    if (strokes) {
      const at = this.x(reduced(strokes[0][1], this.cycle));
      parts.push(svg("path", { class: "fires", d: `M${at} ${middle - 5}l4.5 5l-4.5 5l-4.5-5z` }));
    }
    const height = numbered(svg, "text", `piston-${number}`, {
      class: "height", x: this.right + 8, y: middle + 4,
    });
    this.heights.push(height);
    return [...parts, height];
  }

  ticks(top, step) {
    return Array.from({ length: this.cycle / step + 1 }, (_, k) => k * step).flatMap((angle) => {
      const x = this.x(angle);
      return [
        svg("path", { class: "grid", d: `M${x} 4V${top + 3}` }),
        fixed(svg, "text", "tick", angle, `${angle}°`, { class: "degrees", x, y: top + 16 }),
      ];
    });
  }

  scrub(turnTo) {
    const point = (event) => {
      const box = this.element.getBoundingClientRect();
      const share = (event.clientX - box.left - this.left) / (this.right - this.left);
      turnTo(Math.round(Math.min(Math.max(share, 0), 1) * this.cycle));
    };
    let held = false;
    this.element.addEventListener("pointerdown", (event) => {
      held = true;
      this.element.setPointerCapture(event.pointerId);
      point(event);
    });
    this.element.addEventListener("pointermove", (event) => held && point(event));
    for (const end of ["pointerup", "pointercancel"]) {
      this.element.addEventListener(end, () => { held = false; });
    }
  }
}

/** A period within a cycle, in one or two pieces. */
function wrapped(begin, end, cycle) {
  const from = reduced(begin, cycle);
  const to = from + end - begin;
  return to <= cycle ? [[from, to]] : [[from, cycle], [0, to - cycle]];
}
