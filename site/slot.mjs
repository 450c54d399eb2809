// One engine of the workbench: its form, its picture, and the core's answers about it.

import { Bench } from "./bench.mjs";
import { Form } from "./form.mjs";
import { html } from "./dom.mjs";
import { Design } from "./design.mjs";
import { WORDS } from "./words.mjs";

export class Slot {
  /** `core` answers at once; `changed` is told when another engine is shown, `speed` of a speed. */
  constructor(core, design, { units, changed, speed }) {
    Object.assign(this, { core, design, units, changed, speed });
    this.engine = null;
    this.form = new Form({
      changed: () => this.later(),
      chosen: (name) => this.take(Object.assign(Design.preset(name), { rpm: this.design.rpm })),
      kindChosen: (kind) => this.take(this.design.as(kind)),
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
      this.engine = this.built();
      this.show();
      this.form.faults([]);
      this.form.named(this.engine.summary.name);
    } catch (error) {
      this.form.faults(error.faults ?? [error]);
    }
    this.changed(this);
  }

  /** The engine: its files, and what the core says that it is. */
  built() {
    const { core, design } = this;
    const { call, file } = design.request(this.units);
    const found = call ? core.call("build", call) : core.call("read", { engine: file });
    if (!design.extra) return found;
    return core.call("read", { engine: JSON.stringify({ ...JSON.parse(found.json), ...design.extra }) });
  }

  show() {
    const { core, design, engine, bench } = this;
    const figures = core.call("figures", { engine: engine.json, rpm: design.rpm });
    this.bench = new Bench(figures, this.stage, bench?.kept);
    bench?.destroy();
    this.bench.listeners.add((changed) => {
      if (!changed.includes("rpm")) return;
      design.rpm = this.bench.state.rpm;
      this.speed(this);
    });
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
