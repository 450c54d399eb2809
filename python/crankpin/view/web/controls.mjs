// The reader's controls: the crank angle and how it plays, and what settings are made of.

import { button, fixed, html, numbered, select, show, svg } from "./dom.mjs";
import { STRINGS } from "./strings.mjs";

/** Exaggerations of the rocking; the first is none. */
const FACTORS = [0, ...[1, 10, 100, 1e3, 1e4].flatMap((ten) => [1, 2, 5].map((n) => n * ten))];

/** Highest engine speed that can be typed. */
export const FASTEST = 1e6;

/** Degrees of a single step. */
const STEPS = [0.1, 1, 5, 10, 90];

const ICONS = {
  play: "M4 2.5v11l9-5.5z",
  stop: "M3.5 3.5h9v9h-9z",
  stepBack: "M11.5 3v10L5 8zM3.5 3v10",
  stepForward: "M4.5 3v10L11 8zM12.5 3v10",
  reverse: "M13 8A5 5 0 1 1 8 3M8 .8v4.4L4.8 3z",
};

/** The bar with the crank angle. */
export class Transport {
  constructor(view) {
    this.view = view;
    const command = (name, act) => button([
      svg("svg", { viewBox: "0 0 16 16", "aria-hidden": "true" }, svg("path", { d: ICONS[name] })),
      html("span", {}, STRINGS[name])], act);
    this.play = command("play", () => view.set({ playing: !view.state.playing }));
    this.stop = command("stop", () => view.set({ playing: false }));
    this.reverse = command("reverse", () => view.set({ reverse: !view.state.reverse }));
    this.angle = html("input", {
      type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false",
    });
    this.slider = slider(STRINGS.turn, 0, 720, 1, (value) => {
      const { angle_deg: angle } = view.state;
      const { period } = view.engine;
      view.set({ angle_deg: Math.floor(angle / period) * period + value, playing: false });
    });
    this.step = html("select", { "aria-label": STRINGS.step },
      ...STEPS.map((size) => fixed(html, "option", "step", size, `${size}°`, { value: size })));
    this.step.addEventListener("change", () => view.set({ step: Number(this.step.value) }));
    this.pace = slider(STRINGS.pace, 1, 120, 1, (pace) => view.set({ pace }));
    this.paceShown = numbered(html, "output", "pace");
    typed(this.angle, (value) => view.set({ angle_deg: value, playing: false }), () => view.pose());
    this.element = html("div", { class: "transport" },
      html("div", { class: "buttons" }, this.play, this.stop,
        command("stepBack", () => view.step(-1)), command("stepForward", () => view.step(1)),
        this.step, this.reverse),
      html("div", { class: "pace" }, html("span", {}, STRINGS.paceShort), this.pace, this.paceShown),
      html("div", { class: "angle" },
        html("label", {}, html("span", {}, STRINGS.angle), this.angle),
        html("i", {}, STRINGS.degrees)),
      this.slider,
    );
  }

  layout({ period }) {
    this.slider.max = period;
  }

  /** Show the state; the field is left alone while the reader types in it. */
  show(state, within) {
    const { angle_deg: angle } = state;
    write(this.angle, angle);
    this.slider.value = within;
    this.slider.setAttribute("aria-valuetext", `${Math.round(within)}${STRINGS.degrees}`);
  }

  /** Show what changes seldom. */
  showSettings({ playing, reverse, pace, step }) {
    this.play.setAttribute("aria-pressed", playing);
    this.reverse.setAttribute("aria-pressed", reverse);
    this.pace.value = pace;
    this.step.value = step;
    show(this.paceShown, pace, `${pace} ${STRINGS.rpm}`);
  }
}

/** A box with the controls that a page has, in their order, of elements by the names of controls. */
export function chosen({ controls }, elements) {
  const box = html("div", { class: "settings" }, ...controls.flatMap((name) => elements[name] ?? []));
  box.hidden = !box.childNodes.length;
  return box;
}

/** By how much motion is drawn larger than it is. */
export class Exaggeration {
  constructor(label, view) {
    this.factor = slider(STRINGS.exaggeration, 0, FACTORS.length - 1, 1,
      (k) => view.set({ exaggeration: FACTORS[k] }));
    this.shown = numbered(html, "output", "exaggeration");
    this.element = html("div", { class: "setting" }, html("span", {}, label), this.factor, this.shown);
  }

  show(factor) {
    this.factor.value = Math.max(0, FACTORS.findLastIndex((each) => each <= factor));
    show(this.shown, factor, factor ? `× ${factor}` : STRINGS.off);
  }
}

/** A unit that is the value's own: how it is shown, and how what is typed is taken. */
const PLAIN = { shown: (value) => value, taken: (value) => value };

/** A slider and a field for the same number, within `limits` in the field, in a unit of both. */
export function pair(label, described, name, least, most, step, unit, act, settle, limits = [least, most],
  inUnit = PLAIN) {
  const bound = (value) => fixed(html, "span", "bound", value, `${value}`);
  const said = html("span", { class: "limits", role: "status", hidden: true },
    `${STRINGS.give} `, bound(limits[0]), "–", bound(limits[1]));
  const changed = (value) => {
    said.hidden = true;
    act(inUnit.taken(value));
  };
  const range = slider(label, least, most, step, changed);
  const field = html("input", {
    type: "text", inputmode: "decimal", autocomplete: "off", "aria-label": described,
    "data-name": name, "data-value": "",
  });
  const left = (refused) => {
    said.hidden = !refused;
    settle();
  };
  typed(field, changed, left, (value) => value >= limits[0] && value <= limits[1]);
  return {
    element: html("div", { class: "setting" }, html("span", {}, label), range,
      html("span", { class: "field" }, field, html("i", {}, unit)), said),
    show(value) {
      if (value === null) return;
      range.value = inUnit.shown(value);
      field.setAttribute("data-value", value);
      write(field, inUnit.shown(value));
    },
  };
}

/** A choice of one entry of the view's state; of a disabled one the present name is a text. */
export function choice(key, names, view, disabled = false) {
  const element = select(names, (value) => view.set({ [key]: value }), { "aria-label": STRINGS.choices[key], disabled });
  element.value = view.state[key];
  return element;
}

export function slider(label, min, max, step, act) {
  const element = html("input", { type: "range", "aria-label": label, min, max, step });
  element.addEventListener("input", () => act(Number(element.value)));
  return element;
}

/** Up to six decimals; `data-value` has all digits. What the reader is typing is left alone. */
function write(field, value) {
  if (field.hasAttribute("aria-invalid")) return;
  if (document.activeElement === field && Number(field.value) === value) return;
  field.value = String(Number(value.toFixed(6)));
}

/**
 * Act on every number that is typed; mark others until the field is left, and tell `settle` of one.
 *
 * @param {(value: number) => boolean} allowed
 */
function typed(field, act, settle, allowed = () => true) {
  field.addEventListener("input", () => {
    const text = field.value.trim().replace("−", "-").replace(",", ".");
    const value = Number(text);
    if (text !== "" && Number.isFinite(value) && allowed(value)) {
      field.removeAttribute("aria-invalid");
      act(value);
    } else {
      field.setAttribute("aria-invalid", "true");
    }
  });
  field.addEventListener("change", () => {
    const refused = field.hasAttribute("aria-invalid");
    field.removeAttribute("aria-invalid");
    settle(refused);
  });
}
