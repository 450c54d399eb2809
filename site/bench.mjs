// The engine that turns in the workbench: the parts of the whole page, in another arrangement.

import { show } from "./dom.mjs";
import { Full } from "./full.mjs";
import { region } from "./panels.mjs";
import { ownSettings } from "./places.mjs";
import { STRINGS } from "./strings.mjs";
import { WORDS } from "./words.mjs";

/** Entries of the state that the reader chose outlast another engine. */
const KEPT = ["angle_deg", "playing", "reverse", "pace", "step", "side", "space", "exaggeration", "still"];

export class Bench extends Full {
  /** `kept` is what the reader chose of an engine before this one, `stage` what hears keys. */
  constructor(figures, stage, kept = {}) {
    super(figures, { keysOn: stage });
    this.set(Object.fromEntries(Object.entries(kept).filter(([, value]) => value !== undefined)));
    /** @type {Record<string, any>} */
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
    const [phasors, timeline] = [this.phasors.element, this.timelineBox].map((each) => each.closest("section"));
    /** What panes show of it. */
    this.parts = {
      dials: element.querySelector(".dials"), phasors, timeline, sound: this.sound?.element ?? "",
    };
    const pace = this.transport.element.querySelector(".pace");
    settings.element.replaceChildren(pace, settings.rpm.element, settings.exaggeration.element, settings.orders);
    this.element = region(title, "turning", element.querySelector(".views"));
  }

  crankSpeed(span) {
    const history = super.crankSpeed(span);
    return this.figures.flywheel ? history : { ...history, missing: WORDS.noInertia };
  }

  /** Show another engine with as many parts of each kind as this one, in the same picture; false of any other. */
  follows(figures) {
    if (structure(figures) !== structure(this.figures)) return false;
    this.figures = figures;
    Object.assign(this.state, ownSettings(figures), this.kept.exaggeration === undefined ? { exaggeration: null } : {});
    const name = this.header.element.querySelector("[data-name=engine-name]");
    show(name, figures.name, figures.name || STRINGS.unnamed);
    this.element.setAttribute("aria-label", figures.name || STRINGS.unnamed);
    this.configure();
    this.pose();
    return true;
  }
}

/** What a picture is made of once: another engine that has the same only moves it. */
function structure({ terms: { loads: { torque, speeds } }, flywheel, cylinders, counterweights, shafts, firing_deg: fires, gas, loads, strokes, bank_angle_deg: angle, units }) {
  return JSON.stringify([
    cylinders.map(({ bank, crank, cycle }) => [bank, crank, cycle]), new Set(cylinders.map(({ z }) => z)).size,
    counterweights.length, shafts.map(({ unbalances }) => unbalances.length), Boolean(fires), Boolean(gas), loads, strokes,
    angle === null, units, torque.length > 0, torque.length > 0 && flywheel === null, speeds,
  ]);
}
