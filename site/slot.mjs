// One engine of the workbench: its form, its picture, and the core's answers about it.

import { Bench } from "./bench.mjs";
import { Form } from "./form.mjs";
import { html } from "./dom.mjs";
import { Design } from "./design.mjs";
import { UNITS } from "./tables.mjs";
import { WORDS } from "./words.mjs";

let slots = 0;

/** Controls of the turning page that a bench has; the form has those of the engine. */
const CONTROLS = ["crank_angle", "rpm", "rocking", "sound", "view"];

/** Cylinders of an engine that is drawn, at most: the library takes more. */
const MOST_DRAWN = 64;

export class Slot {
  /** `core` answers at once; `changed` is told when another engine is shown, `speed` of a speed, `turned` of a turn. */
  constructor(core, design, { units, changed, speed, turned }) {
    Object.assign(this, { core, design, units, changed, speed, turned });
    this.id = ++slots;
    this.engine = null;
    /** What the reader set in panes: controls by pane, and their values. */
    this.controls = {};
    this.settings = {};
    this.form = new Form(core, {
      changed: () => this.later(),
      chosen: (name) => this.take(Object.assign(Design.preset(name), { rpm: this.design.rpm })),
      kindChosen: (kind) => this.take(kind === "lists" && this.engine
        ? Object.assign(Design.unrolled(this.engine.json, this.engine.summary.name), { rpm: this.design.rpm }) : this.design.as(kind)),
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
    this.frame ??= requestAnimationFrame(() => {
      this.frame = null;
      this.follow();
    });
  }

  /** Build the engine of what is typed and show it; errors stand beside their fields. */
  follow() {
    try {
      const built = this.built();
      if (built.summary.cylinders > MOST_DRAWN) throw new Error(WORDS.tooMany(built.summary.cylinders, MOST_DRAWN));
      this.engine = built;
      this.show();
      this.form.faults(this.notes);
      this.form.named(this.engine.summary.name);
    } catch (error) {
      this.form.faults(error.faults ?? [error]);
    }
    this.changed(this);
  }

  /** The engine: its files, and what the core says that it is. */
  built() {
    const { core, design } = this;
    const { call, file, gas, inertia } = design.request(core, this.units);
    this.inertia = inertia;
    this.notes = [];
    const made = (more) => (call ? core.call("build", { ...call, ...more })
      : core.call("read", { engine: JSON.stringify({ ...JSON.parse(file), ...more }) }));
    let found;
    try {
      found = made({});
    } catch (error) {
      // An order that the reader did not type is no slip: an engine of other throws goes without it.
      if (error.argument !== "firing_order" || design.changed.includes("firing_order")) throw error;
      found = made({ firing_order: "" });
      this.notes = [Object.assign(error, { hint: WORDS.leftOut(error.hint), isNote: true })];
    }
    if (design.extra) found = core.call("read", { engine: JSON.stringify({ ...JSON.parse(found.json), ...design.extra }) });
    if (!gas) return found;
    const [kind, load] = gas.split(" ");
    return core.call("with_cycle", { engine: found.json, kind, load: Number(load) });
  }

  /** The engine of the form, without what was fitted to it. */
  bare() {
    const { core, design } = this;
    if (!design.extra) return this.engine;
    const { counterweights, shafts, ...rest } = JSON.parse(this.engine.json);
    return core.call("read", { engine: JSON.stringify(rest) });
  }

  /** Fit counterweights and shafts to the engine, or take them off. */
  fit(hardware) {
    this.design.extra = hardware;
    this.follow();
  }

  show() {
    const { core, design, engine, bench } = this;
    const figures = {
      ...core.call("figures", { engine: engine.json, rpm: design.rpm, inertia: this.inertia, shown: UNITS.said[this.units] }),
      controls: CONTROLS, units: UNITS.drawn[this.units],
    };
    if (bench?.follows(figures)) return;
    this.bench = new Bench(figures, this.stage, bench?.kept);
    bench?.destroy();
    this.bench.listeners.add((changed) => {
      this.turned(this, changed);
      if (!changed.includes("rpm")) return;
      design.rpm = this.bench.state.rpm;
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
