// The strokes of each cylinder over a period, a row each, with its firing, its dead centres and its height.

import { reduced } from "./complex.mjs";
import { fixed, numbered, place, show, svg } from "./dom.mjs";
import { STRINGS } from "./strings.mjs";

export const ROW = 17; // pixels

export const STROKES = ["power", "exhaust", "intake", "compression"];

/** Marks of one kind are one path for all cylinders: hundreds of elements would take their time. */
export class Strokes {
  /**
   * @param {any[]} cylinders
   * @param {any[]} unit
   */
  constructor(cylinders, unit = STRINGS.units.length) {
    this.unit = unit;
    this.paths = Object.fromEntries(["zero-line", ...STROKES, "tdc", "fires"].map((name) =>
      [name, svg("path", { class: STROKES.includes(name) ? `stroke ${name}` : name })]));
    this.numbers = cylinders.map(({ number }) =>
      fixed(svg, "text", "cylinder", number, `${number}`, { class: "tick" }));
    this.heights = cylinders.map(({ number }) =>
      numbered(svg, "text", `piston-${number}`, { class: "height" }));
    this.element = svg("g", {}, ...Object.values(this.paths), ...this.numbers, ...this.heights);
  }

  /** Go to a height in the timeline, whose ends are at `left` and `right`. */
  place(top, left, right) {
    this.top = top;
    this.numbers.forEach((number, k) => {
      const y = top + k * ROW + ROW / 2 + 4;
      place(number, [left - 8, y]);
      place(this.heights[k], [right + 8, y]);
    });
    const line = (_, k) => `M${left} ${top + k * ROW + ROW / 2}H${right}`;
    this.paths["zero-line"].setAttribute("d", this.numbers.map(line).join(""));
  }

  /** Draw the marks; `x` is the place of an angle. */
  layout(cylinders, cycle, period, x) {
    const drawn = Object.fromEntries([...STROKES, "tdc", "fires"].map((name) => [name, ""]));
    cylinders.forEach(({ tdc_deg: tdc, strokes }, k) => {
      const top = this.top + k * ROW;
      for (const [name, begin, end] of strokes ?? []) {
        for (const [from, to] of repeated(begin, end, cycle, period)) {
          drawn[name] += `M${at(x(from))} ${top + 2}H${at(x(to))}v${ROW - 4}H${at(x(from))}Z`;
        }
      }
      for (let angle = reduced(tdc); angle < period; angle += 360) {
        drawn.tdc += `M${at(x(angle))} ${top + 1}v${ROW - 2}`;
      }
      if (strokes) {
        for (let fires = reduced(strokes[0][1], cycle); fires < period; fires += cycle) {
          drawn.fires += `M${at(x(fires))} ${top + ROW / 2 - 5}l4.5 5l-4.5 5l-4.5-5z`;
        }
      }
    });
    for (const [name, d] of Object.entries(drawn)) {
      if (this.paths[name].getAttribute("d") !== d) this.paths[name].setAttribute("d", d);
    }
  }

  /** Write the pistons' heights. */
  pose({ cylinders }) {
    const [name, factor] = this.unit;
    // To a hundredth of a millimetre, or finer.
    const decimals = Math.max(0, Math.ceil(5 - Math.log10(factor)));
    this.heights.forEach((element, k) => {
      const { height } = cylinders[k];
      show(element, height, `${(height * factor).toFixed(decimals)} ${name}`);
    });
  }
}

const at = (x) => x.toFixed(2);

/** The pieces of a stroke of each cycle within a period. */
function repeated(begin, end, cycle, period) {
  const pieces = [];
  for (let from = reduced(begin, cycle) - cycle; from < period; from += cycle) {
    const [start, stop] = [Math.max(from, 0), Math.min(from + end - begin, period)];
    if (start < stop) pieces.push([start, stop]);
  }
  return pieces;
}
