// The page: one state, from which every picture and every number follows.

import { reduced, scale, unit } from "./complex.mjs";
import { choice, Settings, Transport } from "./controls.mjs";
import { html, numbered, show } from "./dom.mjs";
import { Ends } from "./ends.mjs";
import { configure, ownSettings, strokesAt } from "./engine.mjs";
import { roundBelow, scaleFor, short } from "./format.mjs";
import { frames } from "./frames.mjs";
import { pressureAt } from "./gas.mjs";
import { Handle } from "./handle.mjs";
import { Header } from "./header.mjs";
import { phasors, shown } from "./orders.mjs";
import { legend, panel, section } from "./panels.mjs";
import { Phasors } from "./phasors.mjs";
import { Player } from "./player.mjs";
import { poseAt } from "./pose.mjs";
import { Readouts } from "./readouts.mjs";
import { displacement, largestDisplacement, rocking } from "./rocking.mjs";
import { Scene } from "./scene.mjs";
import { STRINGS } from "./strings.mjs";
import { STROKES } from "./strokes.mjs";
import { Timeline } from "./timeline.mjs";
import { peaks, sizes, turn } from "./turn.mjs";
import { Arrow, Orbits, Twist } from "./vectors.mjs";

/** Orders that are shown at most. */
const MOST_ORDERS = 6;

/** The state's entries that change the engine. */
const SETTINGS = ["rpm", "bank_angle_deg", "rod_ratio", "hold"];

/** Those that change what it looks like. */
const GEOMETRY = ["bank_angle_deg", "rod_ratio", "hold", "side", "space"];

/** An engine that turns. `figures` are what Python writes of the engine. */
export class View {
  constructor(figures, { keysOn } = {}) {
    this.figures = figures;
    this.listeners = new Set();
    this.state = {
      angle_deg: 0, playing: false, reverse: false, pace: 20, step: 1,
      exaggeration: null, still: new Set(), ...frames(figures), ...ownSettings(figures),
    };
    this.core = null;
    this.width = 900;
    this.build();
    this.player = new Player(this.element, (seconds) => this.advance(seconds));
    this.resized = new ResizeObserver(([entry]) => {
      this.width = entry.contentRect.width;
      this.layoutTimeline();
      this.timeline.pose(this.last);
    });
    this.resized.observe(this.timelineBox);
    this.keysOn = keysOn ?? this.element;
    this.onKey = (event) => this.key(event);
    this.keysOn.addEventListener("keydown", this.onKey);
    this.element.addEventListener("click", (event) => {
      // After the mouse pressed a button, keys are the view's again.
      if (!event.detail || !event.target.closest?.("button, input[type=checkbox]")) return;
      this.element.focus({ preventScroll: true });
    });
    this.configure();
    this.pose();
  }

  /** Change entries of the state; everything that is shown follows before this returns. */
  set(changes) {
    const changed = Object.keys(changes).filter((key) => changes[key] !== this.state[key]);
    if (!changed.length) return;
    Object.assign(this.state, changes);
    ["side", "space"].forEach((key, k) => {
      if (!changed.includes(key)) return;
      this.frames[k].value = this.state[key];
      this.scenes[k + 1].look(this.state[key]);
    });
    const geometry = changed.some((key) => GEOMETRY.includes(key));
    if (geometry || changed.includes("rpm")) this.configure(!geometry);
    else if (changed.some((key) => ["exaggeration", "still"].includes(key))) this.layoutRocking();
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
    this.resized.disconnect();
    this.keysOn.removeEventListener("keydown", this.onKey);
    this.listeners.clear();
    this.element.remove();
  }

  // --- what there is ----------------------------------------------------------------------------

  build() {
    const { figures } = this;
    const title = figures.name || STRINGS.unnamed;
    this.transport = new Transport(this);
    this.settings = new Settings(this);
    const { side, space } = this.state;
    this.scenes = [
      new Scene("cross", [390, 350], [40, 26]),
      new Scene(side, [480, 345], [14, 20]),
      new Scene(space, [480, 345], [14, 22]),
    ];
    this.frames = [choice("side", STRINGS.side, this), choice("space", STRINGS.space, this)];
    this.handle = new Handle(this.scenes[0], () => this.state.angle_deg,
      (angle) => this.set({ angle_deg: angle, playing: false }));
    this.ends = new Ends(this.scenes[2]);
    this.force = new Arrow(STRINGS.force, "force");
    this.moment = new Arrow(STRINGS.moment, "moment");
    this.orbits = new Orbits(STRINGS.crankEnds, ["front", "flywheel"]);
    this.twist = new Twist(STRINGS.torque);
    this.phasors = new Phasors();
    this.timeline = new Timeline((within) => {
      const { angle_deg: angle } = this.state;
      const { cycle } = this.engine;
      this.set({ angle_deg: Math.floor(angle / cycle) * cycle + within, playing: false });
    });
    this.timelineBox = html("div", { class: "timeline-box" }, this.timeline.element);
    this.readouts = new Readouts();
    this.header = new Header(title, figures.firing_deg !== null);
    this.stretched = numbered(html, "span", "stretch");
    this.stretchedLine = html("p", { class: "hint" }, `${STRINGS.stretched} `, this.stretched);
    this.element = html("div", { class: "crankpin", tabindex: "0", role: "region", "aria-label": title },
      this.header.element, this.transport.element, this.settings.element,
      html("div", { class: "views" },
        panel(STRINGS.crossSection, this.readouts.angle, this.scenes[0].element),
        panel(this.frames[0], this.scenes[1].element),
        panel(this.frames[1], this.scenes[2].element)),
      this.stretchedLine,
      html("div", { class: "dials" }, ...this.dials()),
      section(STRINGS.orders, legend(["forward", "backward"], STRINGS.legend), this.phasors.element),
      section(STRINGS.timeline,
        figures.firing_deg ? legend(STROKES
          .filter((name) => figures.strokes === 4 || name === "power" || name === "compression"),
        STRINGS.strokes) : "",
        legend(figures.firing_deg ? ["fires", "tdc"] : ["tdc"], STRINGS.marks),
        this.timelineBox),
      html("p", { class: "hint" }, `${STRINGS.block} ${STRINGS.ownScales}`),
      html("p", { class: "hint" }, STRINGS.keys),
    );
  }

  dials() {
    const { readouts } = this;
    return [
      panel(STRINGS.force, this.force.element, readouts.listOf("force")),
      panel(STRINGS.moment, this.moment.element, readouts.listOf("moment")),
      panel(STRINGS.crankEnds, this.orbits.element, legend(["front", "flywheel"], STRINGS.ends),
        readouts.listOfOrbits()),
      panel(STRINGS.torque, this.twist.element, readouts.listOfTorque()),
    ];
  }

  // --- what changes with the settings -----------------------------------------------------------

  /** Follow new settings; the engine looks the same where nothing but its speed changes. */
  configure(looksTheSame = false) {
    const { state } = this;
    this.engine = configure(this.figures, state);
    const core = this.core && SETTINGS.every((key) => this.core.settings[key] === state[key])
      ? this.core : null;
    this.orders = core ? core.orders : phasors(this.engine, this.figures.highest_order);
    this.curve = core ? core.curve : turn(this.engine, this.orders);
    this.peaks = peaks(this.engine, this.orders, this.curve);
    this.readouts.layout(this.peaks);
    this.shown = shown(this.orders, MOST_ORDERS);
    if (!looksTheSame) {
      this.scenes.forEach((scene) => scene.layout(this.engine));
      this.handle.layout(this.engine);
    }
    const { stretch } = this.scenes[0].dimensions;
    show(this.stretched, stretch, short(stretch, 1));
    this.stretchedLine.hidden = stretch === 1;
    this.transport.layout(this.engine);
    this.settings.layout(this.shown);
    const whole = sizes(this.engine);
    this.phasors.layout(this.shown, whole);
    this.force.layout(this.curve.force, this.peaks.force, whole.force);
    this.moment.layout(this.curve.moment, this.peaks.moment, whole.moment);
    this.twist.layout(this.peaks.torque);
    this.layoutRocking();
    this.header.layout(this.engine, ownSettings(this.figures));
    this.layoutTimeline();
    this.transport.showSettings(state);
  }

  layoutRocking() {
    const { state, engine, scenes } = this;
    const chosen = this.shown.filter(({ order }) => !state.still.has(order));
    this.rocking = rocking(engine, chosen);
    const { ends, radius } = scenes[2].dimensions;
    const largest = Math.max(...ends.map((z) => largestDisplacement(this.rocking, z)));
    if (state.exaggeration === null) {
      // At first the engine rocks by up to a third of the crank radius.
      state.exaggeration = largest > 0 ? Math.min(roundBelow((radius / 3) / largest), 5e4) : 1;
    }
    const turned = Array.from({ length: 91 }, (_, k) => unit(4 * k));
    const moved = turned.map((crank) => displacement(this.rocking, crank));
    const traced = ends.map((z) => moved.map((at) => at(z)));
    this.ends.trace(traced.map((orbit) => orbit.map((at) => scale(at, state.exaggeration))));
    const reach = Math.max(...traced.flat().map(([x, y]) => Math.hypot(x, y)));
    this.orbits.layout(traced, reach);
    this.readouts.choose("orbit", reach);
    this.settings.show(state);
  }

  layoutTimeline() {
    const { curve, engine, peaks: largest, readouts: { scales } } = this;
    const component = (quantity, k) => ({
      name: "xy"[k], label: STRINGS.components[quantity][k],
      samples: curve[quantity].map((each) => each[k]), value: (pose) => pose[quantity][k],
    });
    const histories = ["force", "moment"].map((quantity) => ({
      title: STRINGS[quantity], largest: largest[quantity], scale: scales[quantity],
      curves: [component(quantity, 0), component(quantity, 1)],
      missing: largest[quantity] ? "" : STRINGS.balanced,
    }));
    const known = curve.torque[0] !== null;
    const span = engine.gas ? engine.cycle : 360;
    const torques = engine.gas && known ? ["gas", "inertia", "torque"] : ["torque"];
    histories.push({
      title: STRINGS.torque, scale: scales.torque,
      largest: torques.length > 1
        ? Math.max(...torques.flatMap((name) => curve[name].map(Math.abs))) : largest.torque,
      curves: torques.map((name) => ({
        name, span, label: torques.length > 1 ? STRINGS.torques[name] : "",
        samples: curve[name], value: (pose) => pose[name],
      })),
      missing: known ? (largest.torque ? "" : STRINGS.balanced) : STRINGS.noTorque,
    });
    if (engine.gas && known) histories.push(this.pressures(span));
    this.timeline.layout(this.engine, histories, Math.max(this.width, 300));
  }

  /** The history of the pressures in all cylinders. */
  pressures(span) {
    const { cylinders } = this.engine;
    const fired = cylinders.flatMap(({ gas }, k) => (gas ? [k] : []));
    const largest = Math.max(...fired.flatMap((k) => cylinders[k].gas.samples));
    const angles = Array.from({ length: span / 2 + 1 }, (_, k) => 2 * k);
    return {
      title: STRINGS.pressure, positive: true, largest, missing: "",
      scale: scaleFor(largest, STRINGS.units.pressure),
      curves: fired.map((k) => ({
        name: "pressure", span, value: (pose) => pose.cylinders[k].pressure,
        samples: angles.map((angle) => pressureAt(cylinders[k].gas, angle)),
      })),
    };
  }

  // --- what changes with the angle --------------------------------------------------------------

  pose() {
    const { engine, state } = this;
    const { angle_deg: angle, exaggeration } = state;
    const pose = poseAt(engine, this.orders, angle);
    this.last = pose;
    const strokes = strokesAt(engine, angle);
    const still = () => [0, 0];
    const moved = displacement(this.rocking, pose.crank);
    const rocks = (z) => scale(moved(z), exaggeration);
    this.scenes.forEach((scene, k) => scene.pose(pose, strokes, k ? rocks : still));
    this.handle.pose(pose);
    this.ends.pose(rocks);
    this.force.pose(pose.force);
    this.moment.pose(pose.moment);
    this.twist.pose(pose.torque);
    this.orbits.pose(this.scenes[2].dimensions.ends.map(moved));
    this.phasors.pose(pose.crank);
    this.timeline.pose(pose);
    this.transport.show(state, reduced(angle, engine.cycle));
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
const OWN_KEYS = { button: [" "], checkbox: [" "], range: ["ArrowLeft", "ArrowRight", "Home"] };

/** True if a key is the business of the control it is pressed in. */
function keeps({ target, key }) {
  const control = target.closest?.("button, input, select, textarea");
  return Boolean(control) && (OWN_KEYS[control.type]?.includes(key) ?? true);
}
