// The mounts as numbers: a table of all, and controls for the one that is chosen.

import { pair } from "./controls.mjs";
import { button, explained, html, numbered, show } from "./dom.mjs";
import { fieldUnit } from "./format.mjs";
import { MOUNT_STRINGS } from "./mount_strings.mjs";

/** Places that can be typed, m, how far sliders reach, and the least that is shown. */
const FARTHEST = 5;
const REACH = 0.4;
const LEAST_LENGTH = 1e-4;

/** Stiffness that can be typed, N/m, and the least that is shown; sliders reach to the multiple of the mount's largest. */
const STIFFEST = 1e9;
const LEAST_STIFFNESS = 100;
const MULTIPLE = 3;

export class Editor {
  /** `change` takes the number of a mount and its new place or stiffness, `choose` a number, `reset` nothing. */
  constructor({ mounts }, units, { change, choose, reset }) {
    this.figures = mounts;
    this.length = fieldUnit(units.length, LEAST_LENGTH);
    this.stiffness = fieldUnit(units.stiffness, LEAST_STIFFNESS);
    this.change = change;
    this.rows = mounts.map(({ name }, k) => {
      const label = numbered(html, "span", "mount-name");
      show(label, name, name);
      const chooses = button(label, () => choose(k));
      const numbers = ["x", "y", "z", "k1", "k2", "k3"].map((part) =>
        numbered(html, "td", `mount-${k + 1}-${part}`));
      return { chooses, numbers, element: html("tr", {}, html("th", { scope: "row" }, chooses), ...numbers) };
    });
    this.reset = button(MOUNT_STRINGS.asBefore, reset);
    this.controls = html("div", { class: "settings" });
    this.code = numbered(html, "code", "python");
    this.element = html("div", {},
      html("div", { class: "scrolls" }, html("table", { class: "mounts" },
        html("thead", {}, html("tr", {},
          ...MOUNT_STRINGS.mountHeads(this.length.name, this.stiffness.name).map((text) => html("th", { scope: "col" }, text)))),
        html("tbody", {}, ...this.rows.map(({ element }) => element)))),
      this.controls, this.reset,
      html("details", {}, html("summary", {}, MOUNT_STRINGS.asPython), html("pre", {}, this.code)));
  }

  /** Follow the mounts; `chosen` is the number of one, `changed` whether they are others than at first. */
  layout(mounts, chosen, changed) {
    this.reset.disabled = !changed;
    if (chosen !== this.chosen) this.choose(mounts, chosen);
    mounts.forEach(({ at, stiffness }, k) => {
      const { chooses, numbers, element } = this.rows[k];
      element.classList.toggle("chosen", k === chosen);
      chooses.setAttribute("aria-pressed", k === chosen);
      at.forEach((value, axis) => show(numbers[axis], value, this.length.text(value)));
      [0, 1, 2].forEach((axis) => (stiffness
        ? show(numbers[3 + axis], stiffness[axis], this.stiffness.text(stiffness[axis]))
        : show(numbers[3 + axis], "", MOUNT_STRINGS.ofTable)));
    });
    this.settle(mounts);
    show(this.code, JSON.stringify(mounts), this.python(mounts));
  }

  /** What makes a powertrain with these mounts of the one that the page was made of. */
  python(mounts) {
    const lines = mounts.map(({ at, stiffness }, k) => {
      const own = this.figures[k];
      const figures = [["at", at, own.at], ["dynamic_stiffness", stiffness, own.stiffness]]
        .filter(([, now, before]) => now && now.some((value, axis) => value !== before[axis]))
        .map(([name, now]) => `${name}=(${now.join(", ")})`);
      return `    powertrain.mounts[${k}]${figures.length ? `.replace(${figures.join(", ")})` : ""},`;
    });
    return ["powertrain.replace(mounts=[", ...lines, "])"].join("\n");
  }

  /** Make the controls of a mount. */
  choose(mounts, chosen) {
    this.chosen = chosen;
    const { length, stiffness: rate } = this;
    const { name } = this.figures[chosen];
    const { at, stiffness } = mounts[chosen];
    const settle = () => this.settle(this.mounts);
    const along = (values, axis) => (value) => values().map((each, k) => (k === axis ? value : each));
    this.places = at.map((_, axis) => {
      const act = along(() => this.mounts[chosen].at, axis);
      const own = this.figures[chosen].at[axis];
      return pair("xyz"[axis], `${name}: ${"xyz"[axis]}, ${length.name}`, `mount-${"xyz"[axis]}`,
        Math.floor(length.shown(own - REACH)), Math.ceil(length.shown(own + REACH)), length.step, length.name,
        (typed) => this.change(chosen, { at: act(typed) }), settle, [-FARTHEST, FARTHEST].map(length.whole), length);
    });
    const largest = Math.max(...(this.figures[chosen].stiffness ?? [0])) || 1e5;
    const most = Math.ceil(rate.shown(MULTIPLE * largest));
    this.stiffnesses = (stiffness ?? []).map((_, axis) => {
      const act = along(() => this.mounts[chosen].stiffness, axis);
      return pair(MOUNT_STRINGS.axes[axis], `${name}: ${MOUNT_STRINGS.axes[axis]}, ${rate.name}`, `mount-k${axis + 1}`, 0, most,
        rate.step, rate.name, (typed) => this.change(chosen, { stiffness: act(typed) }), settle, [0, rate.whole(STIFFEST)], rate);
    });
    const title = numbered(html, "b", "mount-name");
    show(title, name, name);
    this.controls.replaceChildren(title, ...[...this.places, ...this.stiffnesses].map(({ element }) => element),
      ...(stiffness ? [] : [explained(MOUNT_STRINGS.tableIsFixed)]));
  }

  settle(mounts) {
    this.mounts = mounts;
    const { at, stiffness } = mounts[this.chosen];
    at.forEach((value, axis) => this.places[axis].show(value));
    stiffness?.forEach((value, axis) => this.stiffnesses[axis].show(value));
  }
}
