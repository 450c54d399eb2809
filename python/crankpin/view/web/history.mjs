// One history of the timeline: the curves of a quantity over a period, with a dot on each at the cursor.

import { numbered, path, place, show, svg } from "./dom.mjs";

export const HEIGHT = 76; // pixels

export class History {
  /** `curves` are names of its curves, with the labels beside them if there are several. */
  constructor({ title, curves, detail = "" }) {
    this.line = svg("path", { class: "zero-line" });
    this.frame = svg("path", { class: "frame" });
    this.title = svg("text", { class: "title" }, title, detail);
    this.note = svg("text", { class: "note" });
    this.ends = [1, -1].map(() => numbered(svg, "text", "tick", { class: "tick" }));
    this.unit = svg("text", { class: "tick" });
    this.curves = curves.map(({ name, label }) => ({
      line: svg("path", { class: `curve ${name}` }),
      label: svg("text", { class: `curve-name ${name}` }, label ?? ""),
      dot: svg("circle", { class: `dot ${name}`, r: 3.2 }),
    }));
    const parts = (key) => this.curves.map((each) => each[key]);
    this.known = svg("g", {}, ...this.ends, this.unit, ...parts("line"), ...parts("label"), ...parts("dot"));
    this.element = svg("g", {}, this.line, this.frame, this.title);
  }

  /** Go to a height in the timeline, whose ends are at `left` and `right`. */
  place(top, left, right) {
    const middle = top + HEIGHT / 2;
    this.middle = middle;
    this.line.setAttribute("d", `M${left} ${middle}H${right}`);
    this.frame.setAttribute("d", `M${left} ${top}V${top + HEIGHT}`);
    place(this.title, [left, top - 6]);
    place(this.note, [left + 8, middle - 5]);
    place(this.ends[0], [left - 5, top + 7]);
    place(this.ends[1], [left - 5, top + HEIGHT + 1]);
    place(this.unit, [left - 5, middle + 4]);
    this.curves.forEach(({ label }, k) => place(label, [right + 8, middle + 5 + 18 * (k - (this.curves.length - 1) / 2)]));
  }

  /** Draw what is known; `missing` says why there is nothing. `x` is the place of an angle. */
  layout({ range: [low, high], scale, curves, missing }, period, x) {
    if (this.note.textContent !== missing) this.note.textContent = missing;
    const [shown, hidden] = missing ? [this.note, this.known] : [this.known, this.note];
    if (shown.parentNode !== this.element) {
      hidden.remove();
      this.element.append(shown);
    }
    this.values = missing ? [] : curves.map(({ value }) => value);
    if (missing) return;
    this.y = (value) => this.middle + (HEIGHT - 6) * (0.5 - (value - low) / (high - low));
    [high, low].forEach((value, k) => show(this.ends[k], value, scale.text(value)));
    if (this.unit.textContent !== scale.unit) this.unit.textContent = scale.unit;
    curves.forEach(({ samples, span = 360 }, k) => {
      const turn = samples.length - 1;
      const points = Array.from({ length: (turn * period) / span + 1 }, (_, i) =>
        [x((span * i) / turn), this.y(samples[i % turn])]);
      this.curves[k].line.setAttribute("d", path(points));
    });
  }

  /** Move the dots to a pose, at the cursor's place. */
  pose(pose, x) {
    this.values.forEach((value, k) => {
      const { dot } = this.curves[k];
      dot.setAttribute("cx", x);
      dot.setAttribute("cy", this.y(value(pose)).toFixed(2));
    });
  }
}
