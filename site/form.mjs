// The engine as a form: presets, kinds, and a field for each figure, with its error beside it.

import { plainUnit } from "./design.mjs";
import { button, html, select } from "./dom.mjs";
import { FIELDS, KINDS, LOAD_FIELDS, NEW_LOAD, groupsOf } from "./fields.mjs";
import { withUnit } from "./quantity.mjs";
import { readable } from "./table.mjs";
import { GROUPS, PRESETS, UNITS } from "./tables.mjs";
import { WORDS } from "./words.mjs";

/** What core errors call figures that have another name here. */
const FIELD_OF = { crank_radius: "stroke", pin_deg: "throws_deg", cylinder: "reciprocating_mass", tdc: "tdc_deg", z: "spacing", rpm: "stroke" };

/** Errors are shown once nobody has typed for so long, milliseconds: half a number is no error yet. */
const PATIENCE = 500;

let forms = 0;

export class Form {
  /** `changed` is told that a field has another text, `chosen` of a preset, `kindChosen` of a kind. */
  constructor(core, { changed, chosen, kindChosen }) {
    this.core = core;
    this.act = { changed, chosen, kindChosen };
    this.id = `form-${++forms}`;
    this.preset = html("select", { id: `${this.id}-preset`, "data-field": "preset" }, html("option", { value: "" }, WORDS.ownEngine),
      ...Object.entries(GROUPS).map(([label, names]) => html("optgroup", { label },
        ...names.map((name) => html("option", { value: name }, PRESETS[name].name)))));
    this.preset.addEventListener("change", () => this.preset.value && chosen(this.preset.value));
    const labels = Object.fromEntries(Object.entries(KINDS).map(([value, { label }]) => [value, label]));
    this.kind = select(labels, kindChosen, { id: `${this.id}-kind`, "data-field": "kind", "aria-describedby": `${this.id}-kind-said` });
    this.said = html("p", { class: "fault whole", role: "alert" });
    this.groups = html("div", {});
    this.helper = html("p", { class: "helper", "aria-hidden": "true" });
    this.element = html("form", { class: "form", "aria-label": WORDS.engine, autocomplete: "off" },
      html("div", { class: "group" },
        html("div", { class: "entry" }, html("label", { for: this.preset.id }, WORDS.preset), this.preset),
        html("div", { class: "entry" }, html("label", { for: this.kind.id }, WORDS.kind), this.kind,
          html("small", { id: `${this.id}-kind-said` }, WORDS.kindSaid)),
        this.said),
      this.groups, this.helper);
    this.element.addEventListener("focusin", ({ target }) => {
      this.helper.textContent = target === this.kind ? WORDS.kindSaid : saidOf(this.entries.get(target.dataset.field)?.field);
    });
    this.element.addEventListener("focusout", () => { this.helper.textContent = ""; });
    this.element.addEventListener("submit", (event) => event.preventDefault());
  }

  /** Show another design: its fields, of its kind. */
  show(design, units) {
    this.design = design;
    this.units = units;
    this.showPreset();
    this.kind.value = design.kind;
    this.entries = new Map();
    this.groups.replaceChildren(...groupsOf(design.kind).map(([title, names]) => html("fieldset", { class: "group" },
      html("legend", {}, title), ...names.map((name) => this.entry(name)))), ...this.loads());
    this.faults([]);
  }

  /** The preset that the engine still is: another figure makes it the reader's own, and the list leads back. */
  showPreset() {
    const { preset, changed, loads } = this.design;
    const listed = [...this.preset.options].some(({ value }) => value === preset);
    this.preset.value = listed && !changed.length && !loads.length ? preset : "";
  }

  /** A group for each periodic load, and buttons that add and remove them. */
  loads() {
    const { loads } = this.design;
    const changes = (text, act) => button(text, () => {
      act();
      this.show(this.design, this.units);
      this.act.changed();
    });
    const groups = loads.map((texts, k) => {
      const of = (isSeldom) => Object.entries(LOAD_FIELDS).filter(([, { seldom = false }]) => seldom === isSeldom)
        .map(([name, field]) => this.entry(`load-${k}-${name}`, field, texts, name));
      return html("fieldset", { class: "group" }, html("legend", {}, `${WORDS.load} ${k + 1}`), ...of(false),
        html("details", {}, html("summary", {}, WORDS.moreOfLoad), ...of(true)),
        changes(WORDS.removeLoad, () => loads.splice(k, 1)));
    });
    return [...groups, html("div", { class: "group" }, changes(WORDS.addLoad, () => loads.push({ ...NEW_LOAD })))];
  }

  /** A field of the engine, or of a load with texts of its own, in which it has another name. */
  entry(name, field = FIELDS[name], texts = this.design.fields, key = name) {
    const { label, unit, choices: all, said, range } = field;
    // A file may have gas pressure of its own.
    const choices = name === "gas" && this.design.file?.cycles ? { ...all, "": WORDS.ownGas } : all;
    const id = `${this.id}-${name}`;
    const control = choices
      ? html("select", { id }, ...Object.entries(choices).map(([value, text]) => html("option", { value }, text)))
      : html("input", { id, type: "text", spellcheck: "false", autocapitalize: "off", inputmode: range ? "decimal" : null, placeholder: " " });
    control.setAttribute("data-field", name);
    control.value = texts[key] ?? "";
    const fault = html("p", { class: "fault", id: `${id}-fault`, hidden: true });
    const hint = said ? html("small", { id: `${id}-said` }, saidOf(field)) : "";
    control.setAttribute("aria-describedby", [said ? `${id}-said` : "", `${id}-fault`].join(" ").trim());
    const typed = () => {
      this.last = name;
      texts[key] = control.value;
      this.showPreset();
      if (slide) slide.value = Number.parseFloat(control.value) || 0;
      this.act.changed(name);
    };
    control.addEventListener(choices ? "change" : "input", typed);
    let slide = null;
    if (range) {
      const [min, max, step] = range;
      slide = html("input", { type: "range", min, max, step, "aria-label": WORDS.slider(label), "data-slider": name });
      slide.value = Number.parseFloat(control.value) || 0;
      slide.addEventListener("input", () => {
        control.value = slide.value;
        typed();
      });
    }
    if (unit && !choices && !field.amplitudes && !field.speeds) {
      control.addEventListener("change", () => {
        const plain = plainUnit(unit, this.units);
        const list = field.listed || control.value.includes(",");
        if (unit === "°" || list || !plain) return;
        control.value = withUnit(this.core, control.value, unit, plain);
        texts[key] = control.value;
      });
    }
    this.entries.set(name, { control, fault, field });
    return html("div", { class: `entry${range ? " ranged" : ""}` }, html("label", { for: id }, label), control, slide ?? "", hint, fault);
  }

  /** Write errors and notes beside their fields; `now`, or where the reader is done typing, else a little later. */
  faults(list, now = false) {
    clearTimeout(this.waiting);
    this.waiting = null;
    this.list = list;
    const typing = this.element.contains(document.activeElement) && document.activeElement.matches("input[type=text]");
    if (now || !list.length || !typing || this.marked) return this.mark(list);
    this.waiting = setTimeout(() => this.faults(list, true), PATIENCE);
  }

  mark(list) {
    this.marked = list.length > 0;
    const rest = [];
    const of = new Map();
    const wrong = new Set();
    for (const { argument, message, hint, value, isNote } of list.map(spoken)) {
      const [bare] = `${argument ?? ""}`.split(/[[. ]/);
      const [, k, part] = `${argument ?? ""}`.match(/^loads\[(\d+)\]\.?(\w*)/) ?? [];
      const own = [argument, `load-${k}-${part}`, `load-${k}-name`, bare].find((each) => this.entries.has(each)) ?? FIELD_OF[bare];
      // An error of several figures stands beside the one that was typed.
      const name = this.entries.has(this.last) && `${value} ${hint}`.includes(this.last) ? this.last : own;
      if (this.entries.has(name)) of.set(name, [of.get(name), inWords(hint ?? message, this.entries.get(name).field.unit, this.units)].filter(Boolean).join("; "));
      else rest.push(inWords(message));
      if (this.entries.has(name) && !isNote) wrong.add(name);
    }
    for (const [name, { control, fault }] of this.entries) {
      const text = of.get(name) ?? "";
      if (fault.textContent !== text) fault.textContent = text;
      fault.hidden = !text;
      const folded = text && control.closest("details");
      if (folded) folded.open = true;
      if (wrong.has(name)) control.setAttribute("aria-invalid", "true");
      else control.removeAttribute("aria-invalid");
    }
    this.said.classList.toggle("note", list.every(({ isNote }) => isNote));
    const whole = rest.join("; ") || (wrong.size ? WORDS.faulty([...wrong].map((name) => this.entries.get(name).field.label)) : "");
    if (this.said.textContent !== whole) this.said.textContent = whole;
  }

  /** What is wrong with the engine as a whole, in a sentence, at once. */
  get whole() {
    if (this.waiting) this.faults(this.list, true);
    return this.said.textContent;
  }

  /** The name that the engine has while none is typed. */
  named(name) {
    this.entries.get("name").control.placeholder = name;
  }
}

/**
 * An error as it is said: one without the library's hint is the page's own mistake.
 *
 * @param {any} error
 */
const spoken = (error) => {
  const { hint, isLimit } = error;
  return error instanceof Error && hint === undefined && !isLimit ? { message: WORDS.mistake(error.message) } : error;
};

/**
 * What a field means.
 *
 * @param {Record<string, any>} field
 */
const saidOf = ({ said, optional, unit } = {}) => (said ? `${said}${optional && unit ? `; ${WORDS.mayBeEmpty}` : ""}` : "");

/** An error in the words of the fields; a length or mass that a hint ends with, which is the library's, as the setting has it. */
export function inWords(hint, unit = "", units = "") {
  let text = hint.replaceAll("crank_radius", WORDS.crankRadius);
  if (UNITS.shown[units]?.[unit]) {
    const [shown, factor] = UNITS.shown[units][unit];
    text = text.replace(/= ([\d.e-]+)$/u, (_, number) => `= ${readable(number * factor)} ${shown}`);
  }
  for (const [name, { label }] of Object.entries(FIELDS)) {
    if (name.includes("_")) text = text.replaceAll(name, label.toLowerCase());
  }
  return text;
}

/** A choice of the units in which plain numbers are read and results are shown. */
export function unitsChoice(units, act) {
  const names = Object.fromEntries(UNITS.settings.map((each) => [each, each]));
  const element = select(names, act, { "aria-label": WORDS.units, "data-field": "units" });
  element.value = units;
  return element;
}
