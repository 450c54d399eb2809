// The engine that turns in the workbench: the parts of the whole page, in another arrangement.

import { Full } from "./full.mjs";
import { region } from "./panels.mjs";

/** Entries of the state that the reader chose outlast another engine. */
const KEPT = ["angle_deg", "playing", "reverse", "pace", "step", "side", "space", "exaggeration", "still"];

export class Bench extends Full {
  /** `kept` is what the reader chose of an engine before this one, `stage` what hears keys. */
  constructor(figures, stage, kept = {}) {
    super(figures, { keysOn: stage });
    this.set(Object.fromEntries(Object.entries(kept).filter(([, value]) => value !== undefined)));
    this.kept = { ...kept };
    this.listeners.add((changed) => {
      for (const key of KEPT) {
        if (changed.includes(key)) this.kept[key] = this.state[key];
      }
    });
    // The picture stays in sight while its controls may scroll away.
    stage.replaceChildren(this.header.element, this.element, this.stretchedLine, this.transport.element,
      this.settings.element);
  }

  build(title) {
    super.build(title);
    const { element, settings } = this;
    const [phasors, timeline] = element.querySelectorAll("section");
    /** What panes show of it. */
    this.parts = {
      dials: element.querySelector(".dials"), phasors, timeline, sound: this.sound?.element ?? "",
    };
    const pace = this.transport.element.querySelector(".pace");
    settings.element.replaceChildren(pace, settings.rpm.element, settings.exaggeration.element, settings.orders);
    this.element = region(title, "turning", element.querySelector(".views"));
  }
}
