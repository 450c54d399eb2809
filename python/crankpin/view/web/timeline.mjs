// Histories of force, moment and torque over a period, above the strokes of each cylinder: one cursor.

import { reduced } from "./complex.mjs";
import { dragged, fixed, shareAt, svg } from "./dom.mjs";
import { HEIGHT, History } from "./history.mjs";
import { STRINGS } from "./strings.mjs";
import { ROW, Strokes } from "./strokes.mjs";

const GAP = 24; // between histories, pixels
const AXIS = 22;
const NARROW = 560;

export class Timeline {
  width;
  period;

  /** `turnTo` is told of the angle within the period that the reader points at; pistons' heights are in `unit`. */
  constructor(turnTo, unit) {
    this.unit = unit;
    this.element = svg("svg", {
      class: "timeline", role: "img", "aria-label": STRINGS.timelineDescribed,
    });
    this.cursor = svg("path", { class: "cursor" });
    this.axis = svg("g");
    dragged(this.element, (event) =>
      turnTo(Math.round(shareAt(this.element, event, this.left, this.right) * this.period)));
  }

  /** Draw everything for a width in pixels; `histories` are the rows of curves, from the top. */
  layout({ cycle, period, cylinders }, histories, width) {
    if (!this.histories) {
      this.histories = histories.map((each) => new History(each));
      this.strokes = new Strokes(cylinders, this.unit);
      this.element.append(this.axis, ...this.histories.map((each) => each.element),
        this.strokes.element, this.cursor);
    }
    if (width !== this.width || period !== this.period) this.place(width, period, cylinders.length);
    const x = (angle) => this.x(angle);
    histories.forEach((each, k) => this.histories[k].layout(each, period, x));
    this.strokes.layout(cylinders, cycle, period, x);
  }

  /** Give everything its place: that depends on the width alone. */
  place(width, period, count) {
    Object.assign(this, { width, period });
    const narrow = width < NARROW;
    this.element.classList.toggle("narrow", narrow);
    this.left = narrow ? 48 : 64;
    this.right = width - (narrow ? 80 : 84);
    const top = (k) => 20 + k * (HEIGHT + GAP);
    this.histories.forEach((each, k) => each.place(top(k), this.left, this.right));
    const strokes = top(this.histories.length);
    this.strokes.place(strokes, this.left, this.right);
    this.bottom = strokes + count * ROW;
    this.element.setAttribute("viewBox", `0 0 ${width} ${this.bottom + AXIS}`);
    this.element.setAttribute("height", this.bottom + AXIS);
    this.axis.replaceChildren(...this.ticks(this.bottom, narrow ? 180 : 90));
  }

  /** Move the cursor and the dots on the curves, and write the pistons' heights. */
  pose(pose) {
    const x = this.x(reduced(pose.thetaDeg, this.period)).toFixed(2);
    this.cursor.setAttribute("d", `M${x} 4V${this.bottom}`);
    for (const each of this.histories) each.pose(pose, x);
    this.strokes.pose(pose);
  }

  x(angle) {
    return this.left + ((this.right - this.left) * angle) / this.period;
  }

  ticks(top, step) {
    return Array.from({ length: this.period / step + 1 }, (_, k) => k * step).flatMap((angle) => {
      const x = this.x(angle);
      return [
        svg("path", { class: "grid", d: `M${x} 4V${top + 3}` }),
        fixed(svg, "text", "tick", angle, `${angle}°`, { class: "degrees", x, y: top + 16 }),
      ];
    });
  }
}
