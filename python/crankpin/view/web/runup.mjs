// Force or motion over engine speed, on axes of decades, with the modes that an order crosses.

import { dragged, fixed, numbered, path, place, shareAt, show, svg } from "./dom.mjs";
import { scaleFor } from "./format.mjs";
import { MOUNT_STRINGS } from "./mount_strings.mjs";
import { STRINGS } from "./strings.mjs";

const HIGH = 250; // pixels
const MARGIN = { left: 58, right: 12, top: 34, bottom: 24 };

/** Decades that are drawn at most. */
const DECADES = 4;

/** Lengths so many times the middle one are those of an order that meets a mode without damping: rounding alone bounds them. */
const BOUNDLESS = 1e5;

/** Lines on which numbers of modes stand. */
const LEVELS = 2;

export class RunUp {
  range;
  right;

  /** `choose` takes the speed that the reader points at, if he may. */
  constructor(choose) {
    this.frame = svg("path", { class: "frame" });
    this.grid = svg("g");
    this.marks = svg("g");
    this.lines = ["x", "y", "z", "length"].map((name) => svg("path", { class: `curve ${name}` }));
    this.cursor = svg("path", { class: "cursor" });
    this.note = svg("text", { class: "note" });
    this.element = svg("svg", { class: "run-up", role: "img", "aria-label": MOUNT_STRINGS.runUpDescribed, height: HIGH },
      this.grid, this.frame, this.marks, ...this.lines, this.cursor, this.note);
    if (choose) dragged(this.element, (event) => {
      const [low, high] = this.range;
      choose(Math.round(low * (high / low) ** shareAt(this.element, event, MARGIN.left, this.right)));
    });
  }

  /**
   * Draw curves along x, y and z and of the length: `values` has an array for each of `speeds`, or null where there is
   * no answer, in SI; `unit` is a name, or a name and the factor from SI. `crossings` are speeds at which modes, by number, are met.
   */
  layout({ speeds, values, crossings, unit, range, width }) {
    Object.assign(this, { range, right: width - MARGIN.right });
    const bottom = HIGH - MARGIN.bottom;
    this.element.setAttribute("viewBox", `0 0 ${width} ${HIGH}`);
    const [low, high] = range;
    this.x = (rpm) => MARGIN.left + (this.right - MARGIN.left) * (Math.log(rpm / low) / Math.log(high / low));
    const [name, factor = 1] = unit;
    const shown = values.map((each) => each?.map((value) => value * factor));
    const lengths = shown.map((each) => each && Math.hypot(...each));
    const some = lengths.filter((each) => each > 0 && Number.isFinite(each)).sort((a, b) => a - b);
    const known = some.filter((each) => each < BOUNDLESS * some[some.length >> 1]);
    show(this.note, "", known.length ? "" : MOUNT_STRINGS.nothingMoves);
    place(this.note, [MARGIN.left + 8, (MARGIN.top + bottom) / 2]);
    this.frame.setAttribute("d", `M${MARGIN.left} ${MARGIN.top}V${bottom}H${this.right}`);
    const top = known.length ? Math.ceil(Math.log10(Math.max(...known))) : 0;
    const least = known.length ? Math.max(Math.floor(Math.log10(Math.min(...known))), top - DECADES) : -1;
    const floor = Math.min(least, top - 1);
    const y = (value) => bottom - (bottom - MARGIN.top) * ((Math.log10(value) - floor) / (top - floor));
    this.lines.forEach((line, k) => {
      let d = "";
      let run = [];
      const flush = () => { d += run.length > 1 ? path(run) : ""; run = []; };
      speeds.forEach((rpm, at) => {
        const value = shown[at] && (k < 3 ? shown[at][k] : lengths[at]);
        if (value >= 10 ** floor && value <= 10 ** top) run.push([this.x(rpm), y(value)]);
        else flush();
      });
      flush();
      line.setAttribute("d", d);
    });
    this.grid.replaceChildren(...this.ticks(low, high, bottom), ...known.length ? decades(floor, top).map((power) => {
      const { unit: prefixed, text } = scaleFor(10 ** power, unit[1] ? [name, 1] : name);
      return [10 ** power, `${Number(text(10 ** power))} ${prefixed}`];
    }).flatMap(([value, text]) => [
      svg("path", { class: "grid", d: `M${MARGIN.left} ${y(value).toFixed(2)}H${this.right}` }),
      fixed(svg, "text", "tick", value, text, { class: "tick", x: MARGIN.left - 5, y: y(value) + 4 }),
    ]) : []);
    this.marks.replaceChildren(...crossings.filter(({ rpm }) => rpm > low && rpm < high).flatMap(({ rpm, mode }, k) => {
      const x = this.x(rpm).toFixed(2);
      const number = numbered(svg, "text", `crossing-${mode}`, { class: "crossing", x, y: MARGIN.top - 6 - 12 * (k % LEVELS) });
      show(number, rpm, `${mode}`);
      return [svg("path", { class: "resonance", d: `M${x} ${MARGIN.top}V${bottom}` }), number];
    }));
  }

  ticks(low, high, bottom) {
    const steps = [1, 2, 5].flatMap((step) => decades(-1, 7).map((power) => step * 10 ** power));
    const shown = steps.filter((rpm) => rpm >= low && rpm <= high);
    const largest = Math.max(...shown);
    return shown.flatMap((rpm) => {
      const x = this.x(rpm).toFixed(2);
      return [
        svg("path", { class: "grid", d: `M${x} ${MARGIN.top}V${bottom}` }),
        fixed(svg, "text", "tick", rpm, rpm === largest ? `${rpm} ${STRINGS.rpm}` : `${rpm}`, { class: "degrees", x, y: bottom + 16 }),
      ];
    });
  }

  /** Put the cursor at a speed. */
  at(rpm) {
    const x = this.x(Math.min(Math.max(rpm, this.range[0]), this.range[1])).toFixed(2);
    this.cursor.setAttribute("d", `M${x} ${MARGIN.top}V${HIGH - MARGIN.bottom}`);
  }
}

/** Whole numbers from one to another. */
const decades = (from, to) => Array.from({ length: to - from + 1 }, (_, k) => from + k);
