// What the engine is called, how it fires, and which loads its figures count.

import { reduced } from "./complex.mjs";
import { fixed, html, numbered, show } from "./dom.mjs";
import { short } from "./format.mjs";
import { STRINGS } from "./strings.mjs";

/** Settings that a reader can change: control, entry, name, unit, and one of the longest values. */
const CHANGES = [
  ["bank_angle", "bank_angle_deg", STRINGS.bankAngle, STRINGS.degrees, 108.5],
  ["rod_ratio", "rod_ratio", STRINGS.rodRatio, "", 0.288888],
];
const LONG = 108.5; // degrees of an interval

/** A text with room for a longer one, so that nothing jumps. */
const roomy = (longest, ...parts) => html("p", { class: "roomy", "data-longest": longest }, html("span", {}, ...parts));

/** The text of settings that are not the engine's own, in parts. */
const said = (changes, write) => changes.flatMap(([, key, name, unit, long], k) =>
  [`${k ? "," : " →"} ${name} `, write(key, long, unit)]);

export class Header {
  constructor(title, { controls = [], cylinders, firing_deg: fires, loads }) {
    const changeable = CHANGES.filter(([control]) => controls.includes(control));
    // Rods change the firing where pins are offset.
    const moves = changeable.some(([control]) => control === "bank_angle" || cylinders.some((each) => each.pin_offset));
    const longest = `${STRINGS.firingOrder} ${cylinders.map(({ number }) => number).join("-")} `
      + STRINGS.intervals(cylinders.map(() => LONG).join("-"));
    this.order = numbered(html, "span", "firing-order");
    this.intervals = numbered(html, "span", "firing-intervals");
    this.changes = html("span", {});
    this.element = html("header", {},
      html("h1", {}, fixed(html, "span", "engine-name", title, title)),
      html("p", { class: "loads" }, loads),
      fires ? roomy(moves ? longest : "", `${STRINGS.firingOrder} `, this.order, " ", this.intervals) : "",
      roomy(said(changeable, (_, long, unit) => `${long}${unit}`).join(""), this.changes));
  }

  /** The settings that are not the engine's own, and order and intervals of firing from cylinder 1 on. */
  layout({ cylinders, cycle, firing, settings }, own) {
    this.changes.replaceChildren(...said(CHANGES.filter(([, key]) => settings[key] !== own[key]), (key, _, unit) =>
      fixed(html, "span", `changed-${key}`, settings[key], `${short(settings[key], 6)}${unit}`)));
    if (!firing) return;
    // Dummy pistons have no strokes, and two pistons may share a chamber.
    const fired = cylinders.filter(({ strokes, number, fires_as: as }) => strokes && number === as);
    const fires = ({ strokes: [[, begin]] }) => begin;
    // Rounding must not put one that fires with cylinder 1 last.
    const after = (each) =>
      Number(reduced(fires(each) - fires(fired[0]), cycle).toFixed(9)) % cycle;
    const found = fired.map((each) => ({ number: each.number, after: after(each) }));
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
