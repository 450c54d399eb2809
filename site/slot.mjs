// One engine of the workbench: its form, its picture, and the core's answers about it.

import { Bench } from "./bench.mjs";
import { Form } from "./form.mjs";
import { html } from "./dom.mjs";
import { Design } from "./design.mjs";
import { withFits } from "./fits.mjs";
import { UNITS } from "./tables.mjs";
import { WORDS } from "./words.mjs";

let slots = 0;

/** Controls of the turning page that a bench has; the form has those of the engine. */
const CONTROLS = ["crank_angle", "rpm", "rocking", "sound", "view"];

/** Cylinders of an engine that is drawn, at most: the library takes more. */
const MOST_DRAWN = 64;

/** Controls of a page that is saved, which has no form: those of the library's. */
const savedControls = ({ bank_angle_deg: angle, rod_ratios: ratios }) => [
  "crank_angle", "rpm", ...(ratios ? ["rod_ratio"] : []), ...(angle === null ? [] : ["bank_angle"]),
  ...CONTROLS.slice(2)];

export class Slot {
  core;
  design;
  units;
  changed;
  speed;
  turned;

  /** `core` answers at once; `changed` is told when another engine is shown, `speed` of a speed, `turned` of a turn. */
  constructor(core, design, { units, changed, speed, turned }) {
    Object.assign(this, { core, design, units, changed, speed, turned });
    this.id = ++slots;
    /** The engine that is shown, the one that is typed without what was fitted to it, and whether they are one. */
    this.engine = null;
    this.base = null;
    this.faults = [];
    /** What the reader set in panes: controls by pane, and their values. */
    this.controls = {};
    this.settings = {};
    this.form = new Form(core, {
      changed: () => this.later(),
      chosen: (name) => this.take(Object.assign(Design.preset(name), { rpm: this.design.rpm })),
      kindChosen: (kind) => this.take(kind === "lists" && this.base
        ? this.design.unrolled(this.base.json, this.base.summary.name) : this.design.as(kind)),
    });
    this.stage = html("div", { class: "stage" });
    this.name = WORDS.engine;
    this.form.show(design, units);
    this.follow();
  }

  /** Take another design. */
  take(design) {
    this.design = design;
    this.form.show(design, this.units);
    this.follow();
  }

  /** Type a text into a field in place of the reader. */
  type(name, text) {
    this.design.fields[name] = text;
    this.form.show(this.design, this.units);
    this.follow();
  }

  /** Follow what is typed, once a frame. */
  later() {
    this.frame ??= requestAnimationFrame(() => this.follow());
  }

  /** The engine of what is typed at this moment; null where that is none. */
  get typed() {
    if (this.frame) this.follow();
    return this.faults.length ? null : this.engine;
  }

  /** Build the engine of what is typed and show it; errors stand beside their fields. */
  follow() {
    cancelAnimationFrame(this.frame);
    this.frame = null;
    const { engine, base } = this;
    try {
      this.base = this.built();
      this.engine = this.fitted();
      const { cylinders } = this.engine.summary;
      if (cylinders > MOST_DRAWN) throw Object.assign(new Error(WORDS.tooMany(cylinders, MOST_DRAWN)), { isLimit: true });
      this.show();
      this.faults = [];
      this.warn();
      this.form.named(this.engine.summary.name);
    } catch (error) {
      Object.assign(this, { engine, base, faults: error.faults ?? [error] });
      this.form.faults(this.faults);
    }
    this.stage.classList.toggle("stale", this.faults.length > 0);
    this.changed(this);
  }

  /** The engine that is typed, without what was fitted to it: its files, and what the core says that it is. */
  built() {
    const { core, design } = this;
    const { call, file, gas, loads, inertia, angles } = design.request(core, this.units);
    this.inertia = inertia;
    this.angles = angles;
    this.notes = [];
    const read = (json, more) => core.call("read", { engine: JSON.stringify({ ...JSON.parse(json), ...more }) });
    const made = (more) => (file ? read(file, more) : core.call("build", { ...call, ...more }));
    let found;
    try {
      found = made({});
    } catch (error) {
      // An order that the reader did not type is no slip: an engine of other throws goes without it.
      if (error.argument !== "firing_order" || design.changed.includes("firing_order")) throw error;
      found = made({ firing_order: "" });
      this.notes = [Object.assign(error, { hint: WORDS.leftOut(error.hint), isNote: true })];
    }
    if (call && design.file) found = read(found.json, design.file);
    if (loads.length) found = read(found.json, { loads });
    if (!gas) return found;
    const [kind, load] = gas.split(" ");
    return core.call("with_cycle", { engine: found.json, kind, load: Number(load) });
  }

  /** The engine with what was fitted to it; `changed` are fits in place of those that it has, by pane. */
  fitted(changed = {}) {
    const { core, base, design } = this;
    const fits = { ...design.extra, ...changed };
    if (Object.values(fits).every((list) => !list)) return base;
    return core.call("read", { engine: JSON.stringify(withFits(JSON.parse(base.json), fits)) });
  }

  /** Say beside the fields what the library would warn of, and what was left out. */
  warn() {
    const { core, engine, inertia, angles, design: { rpm } } = this;
    const { pin_split_deg: [split] = [] } = angles;
    const warnings = core.call("warnings", { engine: engine.json, rpm, inertia, angles, pin_split_deg: split });
    this.form.faults([...this.notes, ...warnings.map((each) => ({ ...each, isNote: true }))]);
  }

  /** Fit what a pane has to the engine; null takes that off. */
  fit(pane, list) {
    this.design.fit(pane, list);
    this.follow();
  }

  /** What a page draws the engine from: of its own rod ratios, or of all that a page reaches. */
  figures(more = {}) {
    const { core, engine, design: { rpm }, inertia, units } = this;
    const figures = core.call("figures", { engine: engine.json, rpm, inertia, shown: UNITS.said[units], ...more });
    return { ...figures, controls: more.rod_ratios ? savedControls(figures) : CONTROLS, units: UNITS.drawn[units] };
  }

  show() {
    const { bench } = this;
    const figures = this.figures();
    if (bench?.follows(figures)) return;
    this.bench = new Bench(figures, this.stage, bench?.kept);
    bench?.destroy();
    this.bench.listeners.add((changed) => {
      this.turned(this, changed);
      if (!changed.includes("rpm")) return;
      this.design.rpm = this.bench.state.rpm;
      if (!this.faults.length) this.warn();
      this.speed(this);
    });
  }

  /** Turn with another engine, whose crank drives this one's. */
  turnWith({ bench: { state: { angle_deg: angle, playing } } }) {
    if (playing) this.bench?.set({ playing: false });
    this.bench?.set({ angle_deg: angle });
  }

  /** Run at another speed. */
  turnAt(rpm) {
    this.design.rpm = rpm;
    this.bench?.set({ rpm });
  }

  setUnits(units) {
    this.units = units;
    this.form.show(this.design, units);
    this.follow();
  }

  destroy() {
    cancelAnimationFrame(this.frame);
    this.bench?.destroy();
    this.form.element.remove();
    this.stage.remove();
  }
}
