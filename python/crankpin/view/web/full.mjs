// The whole page: three pictures of the engine, dials, phasors and curves over a cycle.

import { scale } from "./complex.mjs";
import { choice } from "./controls.mjs";
import { explained, html, numbered, show } from "./dom.mjs";
import { ENDS, Ends } from "./ends.mjs";
import { roundBelow, scaleFor, short } from "./format.mjs";
import { frames } from "./frames.mjs";
import { legend, panel, region, section } from "./panels.mjs";
import { Phasors } from "./phasors.mjs";
import { ownSettings } from "./places.mjs";
import { displacement, largestDisplacement, rocking } from "./rocking.mjs";
import { STILL, Scene } from "./scene.mjs";
import { Sentences } from "./sentences.mjs";
import { Sound } from "./sound.mjs";
import { STRINGS } from "./strings.mjs";
import { STROKES } from "./strokes.mjs";
import { Timeline } from "./timeline.mjs";
import { Arrow, Orbits, Twist } from "./vectors.mjs";
import { View } from "./view.mjs";

export class Full extends View {
  build(title) {
    super.build();
    const { figures } = this;
    this.width = 900;
    Object.assign(this.state, { exaggeration: null, still: new Set(), ...frames(figures) });
    const { side, space } = this.state;
    this.scenes = [
      new Scene("cross", [390, 350], [40, 26]),
      new Scene(side, [480, 345], [14, 20]),
      new Scene(space, [480, 345], [14, 22]),
    ];
    const fixed = !figures.controls.includes("view");
    this.frames = ["side", "space"].map((key) => choice(key, STRINGS[key], this, fixed));
    this.ends = new Ends(this.scenes[2]);
    this.force = new Arrow(STRINGS.force, "force");
    this.moment = new Arrow(STRINGS.moment, "moment");
    this.orbits = new Orbits(STRINGS.crankEnds, ENDS);
    this.twist = new Twist(STRINGS.torque);
    this.phasors = new Phasors(this.units);
    this.timeline = new Timeline((within) => {
      const { angle_deg: angle } = this.state;
      const { period } = this.engine;
      this.set({ angle_deg: Math.floor(angle / period) * period + within, playing: false });
    }, this.units.length);
    this.timelineBox = html("div", { class: "timeline-box" }, this.timeline.element);
    this.stretched = numbered(html, "span", "stretch");
    this.stretchedLine = explained(`${STRINGS.stretched} `, this.stretched);
    this.sentences = new Sentences(figures);
    this.sound = figures.controls.includes("sound") ? new Sound(figures.exhaust_opens_deg) : null;
    this.element = region(title, "",
      this.header.element,
      html("div", { class: "views" },
        panel(STRINGS.crossSection, this.readouts.angle, this.scenes[0].element),
        panel(this.frames[0], this.scenes[1].element),
        panel(this.frames[1], this.scenes[2].element, legend(ENDS, STRINGS.ends))),
      this.stretchedLine,
      figures.controls.includes("crank_angle") ? this.transport.element : "", this.settings.element,
      this.sound ? this.sound.element : "",
      this.sentences.element,
      html("div", { class: "dials" }, ...this.dials()),
      section(STRINGS.timeline,
        figures.firing_deg ? legend(STROKES
          .filter((name) => figures.strokes === 4 || name === "power" || name === "compression"),
        STRINGS.strokes) : "",
        legend(figures.firing_deg ? ["fires", "tdc"] : ["tdc"], STRINGS.marks),
        this.timelineBox),
      // The last, as its height changes with the orders that matter.
      section(STRINGS.orders, legend(["forward", "backward"], STRINGS.legend), this.phasors.element),
      explained(`${STRINGS.block} ${STRINGS.ownScales}`),
      explained(STRINGS.keys),
    );
    this.resized = new ResizeObserver(([entry]) => {
      this.width = entry.contentRect.width;
      this.layoutTimeline();
      this.timeline.pose(this.last);
    });
    this.resized.observe(this.timelineBox);
  }

  dials() {
    const { readouts } = this;
    return [
      panel(STRINGS.force, this.force.element, readouts.listOf("force")),
      panel(STRINGS.moment, this.moment.element, readouts.listOf("moment")),
      panel(STRINGS.crankEnds, this.orbits.element, legend(ENDS, STRINGS.ends),
        readouts.listOfOrbits()),
      panel(STRINGS.torque, this.twist.element, readouts.listOfTorque()),
    ];
  }

  destroy() {
    this.resized.disconnect();
    this.sound?.destroy();
    super.destroy();
  }

  changed(keys) {
    ["side", "space"].forEach((key, k) => {
      if (!keys.includes(key)) return;
      this.frames[k].value = this.state[key];
      this.scenes[k + 1].look(this.state[key]);
    });
    if (keys.some((key) => ["exaggeration", "still"].includes(key))) this.layoutRocking();
  }

  layout(whole) {
    const { stretch } = this.scenes[0].dimensions;
    show(this.stretched, stretch, short(stretch, 1));
    this.stretchedLine.hidden = stretch === 1;
    this.settings.layout(this.shown);
    this.sound?.layout(this.engine);
    this.sentences.layout(this.state, ownSettings(this.figures));
    this.phasors.layout(this.shown, whole);
    this.force.layout(this.curve.force, this.peaks.force, whole.force);
    this.moment.layout(this.curve.moment, this.peaks.moment, whole.moment);
    this.twist.layout(this.peaks.torque);
    this.layoutRocking();
    this.layoutTimeline();
  }

  layoutRocking() {
    const { figures, state, scenes } = this;
    const chosen = this.shown.filter(({ order }) => !state.still.has(order));
    this.rocking = rocking(figures, state, chosen);
    const { ends, radius } = scenes[2].dimensions;
    const largest = Math.max(...ends.map((z) => largestDisplacement(this.rocking, z)));
    if (state.exaggeration === null) {
      // At first the engine rocks by up to a third of the crank radius.
      state.exaggeration = largest > 0 ? Math.min(roundBelow((radius / 3) / largest), 5e4) : 1;
    }
    const angles = Array.from({ length: this.numbers.turn / 4 + 1 }, (_, k) => 4 * k);
    const moved = angles.map((angle) => displacement(this.rocking, angle));
    const traced = ends.map((z) => moved.map((at) => at(z)));
    this.ends.trace(traced.map((orbit) => orbit.map((at) => scale(at, state.exaggeration))));
    const reach = Math.max(...traced.flat().map(([x, y]) => Math.hypot(x, y)));
    this.orbits.layout(traced, reach);
    this.readouts.choose("orbit", reach);
    this.settings.show(state);
  }

  layoutTimeline() {
    const about = (most) => [-most, most];
    const { curve, numbers, peaks: largest, readouts: { scales } } = this;
    const { span, turn } = numbers;
    const component = (quantity, k) => ({
      name: "xy"[k], span: turn, label: STRINGS.components[quantity][k],
      samples: curve[quantity].map((each) => each[k]), value: (pose) => pose[quantity][k],
    });
    /** @type {any[]} */
    const histories = ["force", "moment"].map((quantity) => ({
      title: STRINGS[quantity], range: about(largest[quantity]), scale: scales[quantity],
      curves: [component(quantity, 0), component(quantity, 1)],
      missing: largest[quantity] ? "" : STRINGS.balanced,
    }));
    const known = curve.torque[0] !== null;
    const fired = this.figures.gas && known;
    const others = [...(fired ? ["gas"] : []), ...(numbers.loads.size ? ["loads"] : [])];
    const torques = known && others.length ? [...others, "inertia", "torque"] : ["torque"];
    histories.push({
      title: STRINGS.torque, scale: scales.torque,
      range: about(torques.length > 1
        ? Math.max(...torques.flatMap((name) => curve[name].map(Math.abs))) : largest.torque),
      curves: torques.map((name) => ({
        name, span, label: torques.length > 1 ? STRINGS.torques[name] : "",
        samples: curve[name], value: (pose) => pose[name],
      })),
      missing: known ? (largest.torque ? "" : STRINGS.balanced) : STRINGS.noTorque,
    });
    if (fired) histories.push(this.pressures(span));
    if (fired || (torques.length > 1 && this.figures.flywheel !== null)) histories.push(this.crankSpeed(span));
    this.timeline.layout(this.engine, histories, Math.max(this.width, 300));
  }

  /** The history of the pressures in all cylinders. */
  pressures(span) {
    const { numbers } = this;
    const fired = numbers.gas.flatMap((cylinder, k) => (cylinder ? [k] : []));
    const angles = Array.from({ length: span / 2 + 1 }, (_, k) => 2 * k);
    const curves = fired.map((k) => angles.map((angle) => numbers.pressureAt(numbers.gas[k], angle)));
    const largest = Math.max(...curves.flat());
    return {
      title: STRINGS.pressure, range: [0, largest], missing: "",
      scale: scaleFor(largest, this.units.pressure),
      curves: fired.map((k, curve) => ({ name: "pressure", span, value: (pose) => pose.pressures[k], samples: curves[curve] })),
    };
  }

  /** The history of the crank's speed. */
  crankSpeed(span) {
    const { curve: { speed }, readouts, speeds } = this;
    const [low, high] = speeds ?? [0, 0];
    return {
      title: STRINGS.crankSpeed, detail: readouts.speedLine, range: [low, high], scale: readouts.scales.speed,
      missing: high > low ? "" : speed ? STRINGS.balanced : STRINGS.stalls,
      curves: [{ name: "speed", span, samples: speed, value: (pose) => pose.speed }],
    };
  }

  draw(pose, strokes) {
    const moved = displacement(this.rocking, pose.thetaDeg);
    const rocks = { ...STILL, at: ([, , z]) => [...scale(moved(z), this.state.exaggeration), 0] };
    this.scenes.forEach((scene, k) => scene.pose(pose, strokes, k ? rocks : STILL));
    this.ends.pose(rocks);
    this.force.pose(pose.force);
    this.moment.pose(pose.moment);
    this.twist.pose(pose.torque);
    this.orbits.pose(this.scenes[2].dimensions.ends.map(moved));
    this.phasors.pose(pose.thetaDeg);
    this.timeline.pose(pose);
  }
}
