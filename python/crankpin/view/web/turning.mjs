// A picture that turns with the crank: its state, its keys, and who follows it.

import { Transport } from "./controls.mjs";
import { Handle } from "./handle.mjs";
import { Header } from "./header.mjs";
import { Player } from "./player.mjs";
import { STRINGS } from "./strings.mjs";

/**
 * What turns. `figures` are what Python writes of the engine, `state` what a subclass adds to it.
 *
 * What it looks like is a subclass's: `build` makes `element` and the parts, the cross-section first of
 * `scenes`; `follow` takes new entries of the state, `configure` all of it, and `pose` a crank angle.
 */
export class Turning {
  /**
   * @param {any} figures
   * @param {{keysOn?: HTMLElement}} options
   * @param {any} state
   */
  constructor(figures, { keysOn } = {}, state = {}) {
    this.figures = figures;
    this.listeners = new Set();
    /** @type {any} */
    this.state = { angle_deg: 0, playing: false, reverse: false, pace: 20, step: 1, ...state };
    this.core = null;
    const title = figures.name || STRINGS.unnamed;
    this.transport = new Transport(this);
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
      if (!event.detail || event.target.closest?.("input:not([type=checkbox]), select, a, .mount")) return;
      this.element.focus({ preventScroll: true });
    });
    this.configure();
    this.pose();
  }

  /** Change entries of the state; everything that is shown follows before this returns. */
  set(changes) {
    this.check(changes);
    const changed = Object.keys(changes).filter((key) => changes[key] !== this.state[key]);
    if (!changed.length) return;
    Object.assign(this.state, changes);
    this.follow(changed);
    if (changed.includes("playing")) this.player.set(this.state.playing);
    if (changed.some((key) => key !== "angle_deg")) this.transport.showSettings(this.state);
    this.pose();
    for (const listener of this.listeners) listener(changed);
  }

  /** Take numbers from the library in place of the page's own, for the settings that they are of. */
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
