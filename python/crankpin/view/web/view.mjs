// The state of a page, from which every picture and every number follows; `Full` and `Compact` draw it.

import { reduced } from "./complex.mjs";
import { Numbers } from "./numbers.mjs";
import { MOST_ORDERS, shown } from "./orders.mjs";
import { configure, ownSettings, placesAt, strokesAt } from "./places.mjs";
import { Readouts } from "./readouts.mjs";
import { Settings } from "./settings.mjs";
import { between, extremeValues } from "./speed.mjs";
import { peaks, turn } from "./turn.mjs";
import { Turning } from "./turning.mjs";
import { STRINGS } from "./strings.mjs";

/** The state's entries that change the engine. */
const SETTINGS = ["rpm", "bank_angle_deg", "rod_ratio", "hold"];

/** Those that change what it looks like. */
const GEOMETRY = ["bank_angle_deg", "rod_ratio", "hold", "side", "space"];

/**
 * An engine that turns.
 *
 * What it looks like is a subclass's: `build` makes `element` and the parts, the cross-section first of
 * `scenes`; `layout` follows new settings, `changed` other entries of the state, and `draw` a pose.
 */
export class View extends Turning {
  /** Entries of the state that a widget's traits share, by name. */
  static SHARED = ["angle_deg", "rpm", "bank_angle_deg", "rod_ratio", "hold"];

  constructor(figures, options) {
    super(figures, options, ownSettings(figures));
  }

  /** Make the parts that both pages have; a subclass makes `element` of them. */
  build() {
    /** Units by quantity: a name, which takes a prefix, or a name and the factor from SI. */
    this.units = { ...STRINGS.units, ...this.figures.units };
    this.readouts = new Readouts(this.units);
    this.settings = new Settings(this);
  }

  check({ rod_ratio: ratio, rpm }) {
    const { terms: { loads }, rod_ratios: ratios } = this.figures;
    const [least, most] = ratios ?? [];
    if (ratio < least || ratio > most) {
      throw new RangeError(`rod_ratio = ${ratio}: ${STRINGS.give} ${least}–${most}`);
    }
    const [low, high] = loads.speeds ?? [];
    if (rpm < low || rpm > high) throw new RangeError(`rpm = ${rpm}: ${STRINGS.give} ${low}–${high}`);
  }

  follow(changed) {
    this.changed(changed);
    const geometry = changed.some((key) => GEOMETRY.includes(key));
    if (geometry || changed.includes("rpm")) this.configure(!geometry);
  }

  /** Follow new settings; the engine looks the same where nothing but its speed changes. */
  configure(looksTheSame = false) {
    const { state } = this;
    this.engine = configure(this.figures, state);
    this.numbers = new Numbers(this.figures, state);
    const core = this.core && SETTINGS.every((key) => this.core.settings[key] === state[key])
      ? this.core : null;
    this.orders = core ? core.orders : this.numbers.orders;
    this.curve = core ? core.curve : turn(this.numbers, this.figures, state.rpm);
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
    /** @type {any} */
    const pose = { ...placesAt(engine, angle), ...numbers.at(angle) };
    const within = reduced(angle, engine.period);
    if (speed) pose.speed = between(speed, numbers.span, reduced(angle, numbers.span));
    this.last = pose;
    this.draw(pose, strokesAt(engine, angle));
    this.handle.pose(pose);
    this.transport.show(state, within);
    this.readouts.pose(pose);
  }
}
