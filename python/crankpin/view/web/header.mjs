// What the engine is called, how it fires, and which loads its figures count.

import { reduced } from "./complex.mjs";
import { fixed, html, numbered, show } from "./dom.mjs";
import { short } from "./format.mjs";
import { STRINGS } from "./strings.mjs";

export class Header {
  constructor(title, { firing_deg: fires, loads }) {
    this.order = numbered(html, "span", "firing-order");
    this.intervals = numbered(html, "span", "firing-intervals");
    this.changes = html("span", {});
    this.element = html("header", {},
      html("h1", {}, fixed(html, "span", "engine-name", title, title), this.changes),
      fires ? html("p", {}, `${STRINGS.firingOrder} `, this.order, " ", this.intervals) : "",
      html("p", { class: "loads" }, loads));
  }

  /** The settings that are not the engine's own, and order and intervals of firing from cylinder 1 on. */
  layout({ cylinders, cycle, firing, settings }, own) {
    const changed = [
      ["bank_angle_deg", STRINGS.bankAngle, STRINGS.degrees], ["rod_ratio", STRINGS.rodRatio, ""],
    ].filter(([key]) => settings[key] !== own[key]);
    this.changes.replaceChildren(...changed.flatMap(([key, name, unit], k) => [`${k ? "," : " →"} ${name} `,
      fixed(html, "span", `changed-${key}`, settings[key], `${short(settings[key], 6)}${unit}`)]));
    if (!firing) return;
    const fires = ({ strokes: [[, begin]] }) => begin;
    // Rounding must not put one that fires with cylinder 1 last.
    const after = (each) =>
      Number(reduced(fires(each) - fires(cylinders[0]), cycle).toFixed(9)) % cycle;
    const found = cylinders.map((each) => ({ number: each.number, after: after(each) }));
    found.sort((a, b) => a.after - b.after || a.number - b.number);
    const intervals = found.map((each, k) => (found[k + 1]?.after ?? cycle) - each.after);
    const order = found.map(({ number }, k) =>
      `${k ? (intervals[k - 1] ? "-" : "+") : ""}${number}`).join("");
    const texts = intervals.map((interval) => short(interval, 2));
    const even = texts.every((text) => text === texts[0]);
    show(this.order, order, order);
    show(this.intervals, intervals.join(" "),
      even ? STRINGS.every(texts[0]) : STRINGS.intervals(texts.join("-")));
  }
}
