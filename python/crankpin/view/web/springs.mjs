// Mounts in a picture of the engine: springs at their places, which the reader can move, and the body's box.

import { centre, dragged, numbered, path, place, pointerIn, show, svg, translate } from "./dom.mjs";
import { fieldUnit } from "./format.mjs";
import { MOUNT_STRINGS } from "./mount_strings.mjs";

/** Length of a spring, over the largest extent of the body's box. */
export const SPRING = 0.16;

const COILS = 5;
const COIL = 4; // half of a coil's width, pixels
const SHORT = 7; // pixels below which a spring is seen from its end
const FOOT = 6; // half of the line that a spring stands on, pixels
const WIDTHS = [1, 2.6]; // of the softest and the stiffest spring, pixels
const NAME = 14; // pixels from a mount to its name

/** Pixels within which names of mounts would overlap, and a line of them. */
const NEAR = 40;
const LINE_OF_NAME = 12;

/** A step by a key, m; with shift ten times as far. */
const STEP_BY_KEY = 0.001;

/** Edges of a box whose corners are numbered in binary. */
const EDGES = [0, 1, 2].flatMap((axis) => Array.from({ length: 8 }, (_, k) => k)
  .filter((k) => !(k & (1 << axis))).map((k) => [k, k | (1 << axis)]));

const KEYS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Springs {
  scene;
  figures;
  move;
  inUnit;

  /** `move` takes a mount's number, its new place in metres and whether it is still held; `choose` takes a number. */
  constructor(scene, figures, { choose, move }, length) {
    Object.assign(this, { scene, figures, move, inUnit: fieldUnit(length, STEP_BY_KEY) });
    const extent = [0, 1, 2].map((axis) => {
      const along = figures.box.map((corner) => corner[axis]);
      return Math.max(...along) - Math.min(...along);
    });
    this.length = SPRING * Math.max(...extent);
    this.still = svg("path", { class: "box still" });
    this.moved = svg("path", { class: "box" });
    this.centre = svg("g", { class: "centre" }, svg("circle", { r: 5 }), svg("path", { d: "M0-5A5 5 0 0 1 5 0H-5A5 5 0 0 0 0 5Z" }));
    scene.element.insertBefore(this.still, scene.engineLayer);
    scene.element.insertBefore(this.moved, scene.engineLayer);
    this.mounts = figures.mounts.map(({ name }, k) => this.mount(name, k, choose));
    // The nearest to the reader last.
    const depth = ({ number }) => scene.projection.depth(figures.mounts[number].at);
    const nearest = this.mounts.map(({ element }, number) => ({ element, number })).sort((a, b) => depth(a) - depth(b));
    scene.overlay.append(this.centre, ...nearest.map(({ element }) => element));
  }

  mount(name, k, choose) {
    const springs = [0, 1, 2].map(() => svg("path", { class: "spring" }));
    const ends = svg("path", { class: "feet" });
    const knob = svg("circle", { class: "knob", r: 6 });
    const label = numbered(svg, "text", "mount-name", { class: "mount-name" });
    show(label, name, name);
    const element = svg("g", { class: "mount", ...(this.move ? { tabindex: 0, role: "slider" } : { role: "img" }), "aria-label": `${MOUNT_STRINGS.mount} ${name}` },
      ends, ...springs, knob, label);
    if (!this.move) return { element, springs, ends, knob, label };
    element.addEventListener("focus", () => choose(k));
    element.addEventListener("keydown", (event) => {
      const by = KEYS[event.key];
      if (!by || event.ctrlKey || event.metaKey || event.altKey) return;
      // Lengths along the crank may be drawn longer: what counts is the direction.
      const step = STEP_BY_KEY * (event.shiftKey ? 10 : 1);
      this.move(k, shifted(this.places[k], this.scene.projection.moved(by).map((part) => Math.sign(part) * step)), false);
      event.preventDefault();
      event.stopPropagation();
    });
    this.drag(element, k);
    return { element, springs, ends, knob, label };
  }

  drag(element, k) {
    let start;
    const moved = (event) => {
      const { x, y } = pointerIn(this.scene.element, event);
      return shifted(start.place, this.scene.projection.moved([x - start.x, y - start.y]));
    };
    dragged(element, (event, begins) => {
      if (!begins) {
        start.moves = true;
        this.move(k, moved(event), true);
        return;
      }
      const { x, y } = pointerIn(this.scene.element, event);
      start = { x, y, place: this.places[k], moves: false };
      element.focus({ preventScroll: true });
      event.preventDefault();
    }, (event) => start.moves && this.move(k, moved(event), false));
  }

  /** Points that the picture must contain. */
  points(mounts) {
    const { box, mounts: figures } = this.figures;
    return [...box, ...mounts.flatMap(({ at }, k) => figures[k].axes.map((axis) => this.foot(at, axis)))];
  }

  /** Where the spring along an axis stands: away from the body's centre. */
  foot(at, axis) {
    const { cg } = this.figures;
    const outward = axis.reduce((sum, part, k) => sum + part * (at[k] - cg[k]), 0);
    const sense = outward < -1e-9 ? -1 : 1;
    return at.map((part, k) => part + sense * this.length * axis[k]);
  }

  /** Follow places and stiffnesses; `chosen` is the number of a mount. */
  layout(mounts, chosen) {
    this.places = mounts.map(({ at }) => at);
    const largest = Math.max(...mounts.flatMap(({ stiffness }) => stiffness ?? [0]));
    this.feet = mounts.map(({ at }, k) => this.figures.mounts[k].axes.map((axis) => this.foot(at, axis)));
    const names = [];
    this.mounts.forEach(({ element, springs, label }, k) => {
      element.classList.toggle("chosen", k === chosen);
      const places = this.places[k].map(this.inUnit.text);
      element.setAttribute("aria-valuetext", MOUNT_STRINGS.placeText(places, this.inUnit.name));
      element.setAttribute("aria-valuenow", this.inUnit.shown(this.places[k][0]));
      const { stiffness } = mounts[k];
      springs.forEach((spring, axis) => {
        const share = stiffness && largest ? stiffness[axis] / largest : 1;
        spring.setAttribute("stroke-width", (WIDTHS[0] + (WIDTHS[1] - WIDTHS[0]) * Math.sqrt(share)).toFixed(2));
        spring.toggleAttribute("hidden", share === 0);
      });
      const [px, py] = this.scene.projection.point(this.places[k]);
      const right = px < this.scene.size[0] / 2;
      label.setAttribute("text-anchor", right ? "start" : "end");
      const at = [px + (right ? NAME : -NAME), py - 8];
      while (names.some(([x, y]) => Math.abs(x - at[0]) < NEAR && Math.abs(y - at[1]) < LINE_OF_NAME)) at[1] -= LINE_OF_NAME;
      names.push(at);
      place(label, at);
    });
    this.still.setAttribute("d", this.box((point) => point));
  }

  box(moved) {
    const corners = this.figures.box.map((point) => this.scene.projection.point(moved(point)));
    return EDGES.map(([a, b]) => path([corners[a], corners[b]])).join("");
  }

  pose(motion) {
    const { projection } = this.scene;
    const displaced = (point) => {
      const by = motion.at(point);
      return point.map((part, k) => part + by[k]);
    };
    this.moved.setAttribute("d", this.box(displaced));
    translate(this.centre, projection.point(displaced(this.figures.cg)));
    this.mounts.forEach(({ springs, ends, knob }, k) => {
      const at = projection.point(displaced(this.places[k]));
      centre(knob, at);
      let grounds = "";
      springs.forEach((spring, axis) => {
        const foot = projection.point(this.feet[k][axis]);
        const { drawn, ground } = coiled(foot, at);
        spring.setAttribute("d", drawn);
        if (!spring.hasAttribute("hidden")) grounds += ground;
      });
      ends.setAttribute("d", grounds);
    });
  }
}

/** A place moved by metres, in whole millimetres where it moves. */
function shifted(from, by) {
  return from.map((part, axis) => (by[axis] ? Math.round((part + by[axis]) * 1000) / 1000 : part));
}

/** A spring from its foot to a point, and the line that it stands on; nothing of one seen from its end. */
function coiled([x0, y0], [x1, y1]) {
  const [dx, dy] = [x1 - x0, y1 - y0];
  const length = Math.hypot(dx, dy);
  if (length < SHORT) return { drawn: "", ground: "" };
  const [ux, uy] = [dx / length, dy / length];
  const points = [[x0, y0]];
  for (let k = 0; k < 2 * COILS; k++) {
    const along = 0.12 + (0.76 * (k + 0.5)) / (2 * COILS);
    const side = k % 2 ? COIL : -COIL;
    points.push([x0 + along * dx - side * uy, y0 + along * dy + side * ux]);
  }
  points.push([x1, y1]);
  return {
    drawn: path(points),
    ground: path([[x0 - FOOT * uy, y0 + FOOT * ux], [x0 + FOOT * uy, y0 - FOOT * ux]]),
  };
}
