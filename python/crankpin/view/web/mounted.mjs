// The page of an engine on its mounts: it moves as one block, at an order and a speed or in one of its modes.

import { magnitude, reduced, unit } from "./complex.mjs";
import { Exaggeration, FASTEST, choice, chosen, pair } from "./controls.mjs";
import { explained, fixed, html, numbered, show } from "./dom.mjs";
import { Editor } from "./editor.mjs";
import { roundBelow, scaleFor, short } from "./format.mjs";
import { Modes } from "./modes.mjs";
import { MOUNT_STRINGS } from "./mount_strings.mjs";
import { legend, panel, region, section } from "./panels.mjs";
import { configure, ownSettings, placesAt, strokesAt } from "./places.mjs";
import { RunUp } from "./runup.mjs";
import { STILL, Scene } from "./scene.mjs";
import { Springs } from "./springs.mjs";
import { STRINGS } from "./strings.mjs";
import { Suspension, effective, rigid } from "./suspension.mjs";
import { Turning } from "./turning.mjs";

/** Speeds of the chart. */
const SPEEDS = 120;

/** Speeds beside a resonance, over its own. */
const BESIDE = [0.9, 0.96, 0.98, 0.99, 0.995, 1, 1.005, 1.01, 1.02, 1.04, 1.1];

/** At first the farthest corner of the body's box moves by this part of the box's largest extent. */
const MOVES = 0.08;

/** Rotations are smaller than that, radians: they are drawn as small ones. */
const MOST_TURN = 0.35;

const ALL = "all";

export class Mounted extends Turning {
  /** Entries of the state that a widget's traits share, by name. */
  static SHARED = ["angle_deg", "rpm", "order", "mode", "mounts"];

  constructor(figures, options) {
    const { mounts, order } = figures.mounted;
    super(figures, options, {
      rpm: figures.rpm,
      order,
      mode: null,
      quantity: "force",
      exaggeration: null,
      mount: 0,
      mounts: mounts.map(({ at, stiffness }) => ({ at, stiffness })),
    });
  }

  build(title) {
    const { figures, figures: { controls, mounted }, state } = this;
    const has = (name) => controls.includes(name);
    /** Units by quantity: a name, which takes a prefix, or a name and the factor from SI. */
    this.units = { ...MOUNT_STRINGS.units, ...figures.units };
    this.own = state.mounts;
    this.held = false;
    this.width = 560;
    // From far below the speed at first, where most engines are among their modes, to what cars' engines reach.
    this.range = [Math.min(figures.rpm / 8, 100), Math.max(1.5 * figures.rpm, Math.min(8 * figures.rpm, 8000))];
    this.scenes = [
      new Scene("cross", [390, 350], [34, 26]),
      new Scene("left", [480, 345], [34, 26]),
      new Scene("above", [480, 345], [34, 26]),
    ];
    const acts = {
      choose: (mount) => this.set({ mount }),
      move: has("mounts") && ((k, at, held) => { this.held = held; this.change(k, { at }); }),
    };
    this.springs = this.scenes.map((scene) => new Springs(scene, mounted, acts, this.units.length));
    const step = figures.rpm < 100 ? 0.1 : 1;
    this.rpm = pair(STRINGS.speed, STRINGS.speedField, "rpm", Math.ceil(this.range[0] / step) * step, this.range[1], step,
      STRINGS.rpm, (rpm) => this.set({ rpm }), () => this.rpm.show(this.state.rpm), [step, FASTEST]);
    this.order = html("select", { "aria-label": MOUNT_STRINGS.shownOrder },
      html("option", { value: ALL }, MOUNT_STRINGS.allOrders),
      ...mounted.orders.map((order) => fixed(html, "option", "order", order, `${STRINGS.order} ${order}`, { value: order })));
    this.order.addEventListener("change", () =>
      this.set({ order: this.order.value === ALL ? ALL : Number(this.order.value), mode: null, exaggeration: null }));
    this.exaggeration = new Exaggeration(MOUNT_STRINGS.magnified, this);
    this.drawn = {
      order: numbered(html, "span", "drawn-order"), rpm: numbered(html, "span", "drawn-rpm"),
      mode: numbered(html, "span", "drawn-mode"), factor: numbered(html, "span", "drawn-factor"),
    };
    this.drawnLine = html("p", { class: "hint drawn" });
    this.stretched = numbered(html, "span", "stretch");
    this.stretchedLine = explained(`${STRINGS.stretched} `, this.stretched);
    this.trouble = html("p", { class: "hint trouble", role: "status" }, MOUNT_STRINGS.resonance);
    this.modesTable = new Modes(has("mode") && ((mode) => this.set({ mode, exaggeration: null })));
    this.runUp = new RunUp(has("rpm") && ((rpm) => this.set({ rpm, mode: null })));
    this.quantity = choice("quantity", MOUNT_STRINGS.quantity, this, !has("view"));
    this.ofOrder = numbered(html, "span", "run-up-order");
    this.runUpHint = explained();
    this.runUpBox = html("div", { class: "run-up-box" }, this.runUp.element);
    this.editor = new Editor(mounted, this.units, {
      ...acts, change: (k, changes) => this.change(k, changes), reset: () => this.set({ mounts: this.own }),
    });
    this.values = Object.fromEntries(["force", "displacement", "rotation"].map((name) =>
      [name, ["x", "y", "z", "length"].map((part) => numbered(html, "output", `${name}-${part}`))]));
    const listed = mounted.orders.map((order, k) => [k ? ", " : " ", fixed(html, "span", "order", order, `${order}`)]).flat();
    const at = mounted.frequency === null ? [] : [`, ${MOUNT_STRINGS.at_frequency} `,
      fixed(html, "span", "modes-at", mounted.frequency, `${short(mounted.frequency, 3)} Hz`)];
    this.element = region(title, "mounted",
      this.header.element,
      html("div", { class: "views" },
        panel(STRINGS.crossSection, this.scenes[0].element),
        panel(STRINGS.side.left, this.scenes[1].element),
        panel(STRINGS.side.above, this.scenes[2].element)),
      this.drawnLine, this.stretchedLine, this.trouble,
      has("crank_angle") ? this.transport.element : "",
      chosen(figures, {
        rpm: [this.rpm.element], rocking: [this.exaggeration.element],
        order: [html("div", { class: "setting" }, html("span", {}, STRINGS.order), this.order)],
      }),
      html("div", { class: "halves" },
        section(html("span", {}, MOUNT_STRINGS.modesOf, ...at), this.modesTable.element),
        section(html("span", {}, this.quantity, ", rms, ", this.ofOrder),
          legend(["x", "y", "z", "length"], MOUNT_STRINGS.lines), this.runUpBox, this.runUpHint)),
      html("div", { class: "dials values" }, ...Object.keys(this.values).map((name) =>
        panel(MOUNT_STRINGS.effectiveValues[name], this.listOf(name)))),
      has("mounts") ? section(MOUNT_STRINGS.mountsTitle, this.editor.element) : "",
      explained(`${MOUNT_STRINGS.counted}`, ...listed, `, ${MOUNT_STRINGS.countedRest}`),
      explained(STRINGS.keys));
    this.resized = new ResizeObserver(([entry]) => {
      this.width = entry.contentRect.width;
      this.layoutRunUp();
    });
    this.resized.observe(this.runUpBox);
  }

  listOf(name) {
    const heads = name === "rotation" ? MOUNT_STRINGS.about3 : ["x", "y", "z"];
    return html("dl", {}, ...this.values[name].flatMap((output, k) => [
      html("dt", { class: k < 3 ? "xyz"[k] : "" }, heads[k] ?? MOUNT_STRINGS.lines.length), html("dd", {}, output)]));
  }

  destroy() {
    this.resized.disconnect();
    super.destroy();
  }

  check({ rpm, order, mode, mounts }) {
    const { orders } = this.figures.mounted;
    const wrong = (name, value, hint) => { throw new RangeError(`${name} = ${JSON.stringify(value)}: ${STRINGS.give} ${hint}`); };
    if (rpm !== undefined && !(rpm > 0 && rpm <= FASTEST)) wrong("rpm", rpm, `0–${FASTEST}`);
    if (order !== undefined && order !== ALL && !orders.includes(order)) wrong("order", order, `${ALL}, ${orders.join(", ")}`);
    if (mode !== undefined && mode !== null && ![0, 1, 2, 3, 4, 5].includes(mode)) wrong("mode", mode, "0–5");
    mounts?.forEach(({ at, stiffness }, k) => {
      if (!at.every(Number.isFinite)) wrong("at", at, "three numbers");
      const fixedOne = this.own[k].stiffness === null;
      if (fixedOne ? stiffness !== null : !stiffness.every((value) => value >= 0 && Number.isFinite(value))) {
        wrong("stiffness", stiffness, "three numbers of zero or more");
      }
    });
  }

  /** Give a mount another place or stiffness. */
  change(k, changes) {
    this.set({ mounts: this.state.mounts.map((mount, at) => (at === k ? { ...mount, ...changes } : mount)) });
  }

  follow(changed) {
    if (changed.every((key) => ["angle_deg", "playing", "reverse", "pace", "step"].includes(key))) return;
    this.configure(!changed.includes("mounts"));
  }

  /** Follow the state; mounts are where they were if so said. */
  configure(sameMounts = false) {
    const { state, figures, figures: { mounted } } = this;
    if (!this.engine) {
      this.engine = configure(figures, ownSettings(figures));
      this.transport.layout(this.engine);
      this.header.layout(this.engine, ownSettings(figures));
    }
    if (!sameMounts || !this.suspension) {
      this.suspension = new Suspension(mounted, state.mounts);
      this.ownModes = this.suspension.modes();
      // While the reader holds a mount pictures stay as large as they are.
      if (!this.held || !this.scenes[0].items) this.layoutScenes();
      this.swept = null;
    }
    const core = this.ofCore();
    this.modes = core ? core.modes : this.ownModes;
    const indices = state.order === ALL ? mounted.orders.map((_, k) => k) : [mounted.orders.indexOf(state.order)];
    const parts = core ? core.parts : indices.map((k) => this.suspension.at(k, state.rpm));
    this.parts = parts.includes(null) ? null : parts;
    this.springs.forEach((each) => each.layout(state.mounts, state.mount));
    this.modesTable.layout(this.modes, state.mode);
    this.editor.layout(state.mounts, state.mount, !sameAs(state.mounts, this.own));
    this.layoutRunUp(indices);
    this.layoutMotion();
    this.rpm.show(state.rpm);
    this.order.value = state.order;
    this.quantity.value = state.quantity;
    this.transport.showSettings(state);
  }

  /** The library's numbers, if they are of the present state. */
  ofCore() {
    const { core, state } = this;
    const fits = core && ["rpm", "order"].every((key) => core.settings[key] === state[key])
      && sameAs(core.settings.mounts, state.mounts);
    return fits ? core : null;
  }

  layoutScenes() {
    this.scenes.forEach((scene, k) => {
      scene.around = this.springs[k].points(this.state.mounts);
      scene.layout(this.engine);
    });
    this.handle?.layout(this.engine);
    const { stretch } = this.scenes[0].dimensions;
    show(this.stretched, stretch, short(stretch, 1));
    this.stretchedLine.hidden = stretch === 1;
  }

  /** Values over speed: of the order chosen, or of all. */
  layoutRunUp(indices = this.indices) {
    const { state } = this;
    this.indices = indices;
    const one = state.order === ALL ? null : state.order;
    const key = state.quantity === "force" ? "force" : "motion";
    if (!this.swept || this.swept.order !== state.order) {
      const [low, high] = this.range;
      const crossings = one === null || !this.modes ? [] : this.modes.map(({ frequency }, k) =>
        ({ mode: k + 1, rpm: (60 * frequency) / one }));
      const even = Array.from({ length: SPEEDS }, (_, k) => low * (high / low) ** (k / (SPEEDS - 1)));
      const beside = crossings.flatMap(({ rpm }) => BESIDE.map((share) => share * rpm));
      const speeds = [...even, ...beside].filter((rpm) => rpm >= low && rpm <= high).sort((a, b) => a - b);
      const parts = speeds.map((rpm) => {
        const found = indices.map((k) => this.suspension.at(k, rpm));
        return found.includes(null) ? null : found;
      });
      this.swept = { order: state.order, speeds, parts, crossings };
    }
    const { speeds, parts, crossings } = this.swept;
    const values = parts.map((each) => each && effective(each, key));
    this.curves = { speeds, values };
    this.runUp.layout({ speeds, values, crossings, unit: this.units[key], range: this.range, width: Math.max(this.width, 260) });
    this.runUp.at(state.rpm);
    show(this.ofOrder, one ?? "", `${MOUNT_STRINGS.ofOrder(one)}${one ?? ""}`);
    this.runUpHint.textContent = one === null ? MOUNT_STRINGS.chooseOrder : MOUNT_STRINGS.perSpeed;
  }

  /** The motion that is drawn, and how much it is magnified. */
  layoutMotion() {
    const { state, parts, figures: { mounted } } = this;
    const mode = state.mode === null ? null : this.modes?.[state.mode];
    const { box, cg } = mounted;
    const extent = Math.max(...[0, 1, 2].map((axis) =>
      Math.max(...box.map((corner) => corner[axis])) - Math.min(...box.map((corner) => corner[axis]))));
    const reach = (motion) => Math.max(...box.map((corner) => Math.hypot(...rigid(motion, cg).at(corner))),
      Math.hypot(...motion.slice(3)) * (MOVES * extent) / MOST_TURN);
    this.shape = mode ? mode.shape.map((part) => part * ((1.5 * MOVES * extent) / reach(mode.shape))) : null;
    const largest = parts ? parts.reduce((sum, { motion }) => sum + reach(motion.map(magnitude)), 0) : 0;
    if (state.exaggeration === null) {
      state.exaggeration = largest > 0 ? Math.min(roundBelow((MOVES * extent) / largest), 5e4) : 1;
    }
    this.exaggeration.show(state.exaggeration);
    this.trouble.hidden = parts !== null;
    const one = state.order === ALL ? null : state.order;
    const { drawn } = this;
    show(drawn.order, one ?? "", `${MOUNT_STRINGS.drawnOrder(one)}${one ?? ""}`);
    show(drawn.rpm, state.rpm, `${short(state.rpm, 3)} ${STRINGS.rpm}`);
    show(drawn.factor, state.exaggeration, `${state.exaggeration}`);
    show(drawn.mode, mode ? state.mode + 1 : "", mode ? `${state.mode + 1}, ${mode.frequency.toFixed(2)} Hz,` : "");
    this.drawnLine.replaceChildren(...(mode ? [MOUNT_STRINGS.drawnMode, drawn.mode, MOUNT_STRINGS.drawnShape]
      : [drawn.order, MOUNT_STRINGS.drawnAt, drawn.rpm, MOUNT_STRINGS.drawnTimes, drawn.factor]));
    this.write("force", parts && effective(parts, "force"), this.units.force);
    this.write("displacement", parts && effective(parts, "motion"), this.units.motion);
    this.write("rotation", parts && effective(parts.map(({ motion }) => ({ motion: motion.slice(3) })), "motion"), "rad");
  }

  write(name, along, unitName) {
    const values = along && [...along, Math.hypot(...along)];
    const { unit: prefixed, text } = scaleFor(values ? values[3] : 0, unitName);
    this.values[name].forEach((output, k) =>
      show(output, values ? values[k] : "", values ? `${text(values[k])} ${prefixed}` : MOUNT_STRINGS.noAnswer));
  }

  pose() {
    const { engine, state } = this;
    const { angle_deg: angle } = state;
    const pose = placesAt(engine, angle);
    const motion = this.motionAt(angle);
    const strokes = strokesAt(engine, angle);
    this.scenes.forEach((scene, k) => {
      scene.pose(pose, strokes, motion);
      this.springs[k].pose(motion);
    });
    this.handle.pose(pose);
    this.transport.show(state, reduced(angle, engine.period));
  }

  /** The motion that is drawn at a crank angle. */
  motionAt(angle) {
    const { shape, parts, state, figures: { mounted: { cg } } } = this;
    if (shape) {
      const [swing] = unit(angle);
      return rigid(shape.map((part) => part * swing), cg);
    }
    if (!parts) return STILL;
    const sum = [0, 0, 0, 0, 0, 0];
    for (const { order, motion } of parts) {
      const [cos, sin] = unit(order * angle);
      motion.forEach(([re, im], k) => { sum[k] += state.exaggeration * (re * cos - im * sin); });
    }
    return rigid(sum, cg);
  }
}

const sameAs = (some, others) => JSON.stringify(some) === JSON.stringify(others);
