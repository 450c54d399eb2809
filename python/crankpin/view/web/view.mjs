// The state of a page, from which every picture and every number follows; `Full` and `Compact` draw it.

import { reduced } from "./complex.mjs";
import { Settings, Transport } from "./controls.mjs";
import { Handle } from "./handle.mjs";
import { Header } from "./header.mjs";
import { Numbers } from "./numbers.mjs";
import { shown } from "./orders.mjs";
import { configure, ownSettings, placesAt, strokesAt } from "./places.mjs";
import { Player } from "./player.mjs";
import { Readouts } from "./readouts.mjs";
import { between, extremeValues } from "./speed.mjs";
import { peaks, turn } from "./turn.mjs";
import { STRINGS } from "./strings.mjs";

/** Orders that are shown at most. */
const MOST_ORDERS = 6;

/** The state's entries that change the engine. */
const SETTINGS = ["rpm", "bank_angle_deg", "rod_ratio", "hold"];

/** Those that change what it looks like. */
const GEOMETRY = ["bank_angle_deg", "rod_ratio", "hold", "side", "space"];

/**
 * An engine that turns. `figures` are what Python writes of the engine.
 *
 * What it looks like is a subclass's: `build` makes `element` and the parts, the cross-section first of
 * `scenes`; `layout` follows new settings, `changed` other entries of the state, and `draw` a pose.
 */
export class View {
  constructor(figures, { keysOn } = {}) {
    this.figures = figures;
    this.listeners = new Set();
    this.state = { angle_deg: 0, playing: false, reverse: false, pace: 20, step: 1, ...ownSettings(figures) };
    this.core = null;
    const title = figures.name || STRINGS.unnamed;
    this.readouts = new Readouts();
    this.transport = new Transport(this);
    this.settings = new Settings(this);
    this.header = new Header(title, figures);
    this.build(title);
    this.handle = new Handle(this.scenes[0], () => this.state.angle_deg,
      (angle) => this.set({ angle_deg: angle, playing: false }));
    this.player = new Player(this.element, (seconds) => this.advance(seconds));
    this.keysOn = keysOn ?? this.element;
    this.onKey = (event) => this.key(event);
    this.keysOn.addEventListener("keydown", this.onKey);
    this.element.addEventListener("click", (event) => {
      // After a click keys are the view's, but for controls that use them themselves.
      if (!event.detail || event.target.closest?.("input:not([type=checkbox]), select, a")) return;
      this.element.focus({ preventScroll: true });
    });
    this.configure();
    this.pose();
  }

  /** Change entries of the state; everything that is shown follows before this returns. */
  set(changes) {
    const [least, most] = this.figures.terms.rod_ratios;
    if (changes.rod_ratio < least || changes.rod_ratio > most) {
      throw new RangeError(`rod_ratio = ${changes.rod_ratio}: ${STRINGS.give} ${least}–${most}`);
    }
    const changed = Object.keys(changes).filter((key) => changes[key] !== this.state[key]);
    if (!changed.length) return;
    Object.assign(this.state, changes);
    this.changed(changed);
    const geometry = changed.some((key) => GEOMETRY.includes(key));
    if (geometry || changed.includes("rpm")) this.configure(!geometry);
    if (changed.includes("playing")) this.player.set(this.state.playing);
    if (changed.some((key) => key !== "angle_deg")) this.transport.showSettings(this.state);
    this.pose();
    for (const listener of this.listeners) listener(changed);
  }

  /** Take orders and curves from the library in place of the page's own, for these settings. */
  useCore(core) {
    this.core = core;
    this.configure(true);
    this.pose();
  }

  step(sense, times = 1) {
    const { angle_deg: angle, step } = this.state;
    // In decimals, so that ten steps of 0.1 are 1.
    const stepped = Number((angle + sense * times * step).toFixed(9));
    this.set({ angle_deg: stepped, playing: false });
  }

  advance(seconds) {
    const { angle_deg: angle, pace, reverse } = this.state;
    const turned = seconds * pace * 6 * (reverse ? -1 : 1);
    this.set({ angle_deg: Number((angle + turned).toFixed(3)) });
  }

  destroy() {
    this.player.destroy();
    this.keysOn.removeEventListener("keydown", this.onKey);
    this.listeners.clear();
    this.element.remove();
  }

  /** Follow new settings; the engine looks the same where nothing but its speed changes. */
  configure(looksTheSame = false) {
    const { state } = this;
    this.engine = configure(this.figures, state);
    this.numbers = new Numbers(this.figures, state);
    const core = this.core && SETTINGS.every((key) => this.core.settings[key] === state[key])
      ? this.core : null;
    this.orders = core ? core.orders : this.numbers.orders;
    this.curve = core ? core.curve : turn(this.numbers, this.figures.flywheel, state.rpm);
    this.peaks = peaks(this.numbers, this.curve);
    this.readouts.layout(this.peaks);
    const { speed } = this.curve;
    this.speeds = speed && extremeValues(speed);
    this.readouts.layoutSpeed(this.speeds, state.rpm, this.figures.flywheel);
    this.shown = shown(this.orders, MOST_ORDERS);
    if (!looksTheSame) {
      this.scenes.forEach((scene) => scene.layout(this.engine));
      this.handle.layout(this.engine);
    }
    this.transport.layout(this.engine);
    this.header.layout(this.engine, ownSettings(this.figures));
    this.layout(this.numbers.whole);
    this.transport.showSettings(state);
  }

  pose() {
    const { curve: { speed }, engine, numbers, state } = this;
    const { angle_deg: angle } = state;
    const pose = { ...placesAt(engine, angle), ...numbers.at(angle) };
    const within = reduced(angle, engine.cycle);
    if (speed) pose.speed = between(speed, engine.cycle, within);
    this.last = pose;
    this.draw(pose, strokesAt(engine, angle));
    this.handle.pose(pose);
    this.transport.show(state, within);
    this.readouts.pose(pose);
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || keeps(event)) return;
    const times = event.shiftKey ? 10 : 1;
    const actions = {
      " ": () => this.set({ playing: !this.state.playing }),
      ArrowRight: () => this.step(1, times),
      ArrowLeft: () => this.step(-1, times),
      r: () => this.set({ reverse: !this.state.reverse }),
      Home: () => this.set({ angle_deg: 0, playing: false }),
    };
    const act = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }
}

/** Keys that a control uses itself, by its type; a field and a choice use all. */
const OWN_KEYS = { button: [" "], checkbox: [" "], summary: [" "], range: ["ArrowLeft", "ArrowRight", "Home"] };

/** True if a key is the business of the control it is pressed in. */
function keeps({ target, key }) {
  const control = target.closest?.("button, input, select, summary, textarea");
  return Boolean(control) && (OWN_KEYS[control.type ?? control.localName]?.includes(key) ?? true);
}
