// A vector now, and the curve that its tip traces over a turn.

import { unit } from "./complex.mjs";
import { centre, path, svg } from "./dom.mjs";

const SIZE = 200;
const RADIUS = 84;

/** Least length that fills a dial, over what the cylinders make one by one: less is drawn shorter. */
export const LEAST = 1e-3;

/** A round picture of vectors about its centre. */
export class Dial {
  constructor(label, { size = SIZE, radius = RADIUS, axes = true } = {}) {
    this.radius = radius;
    this.half = size / 2;
    this.element = svg("svg", {
      viewBox: `0 0 ${size} ${size}`, class: "dial", role: "img", "aria-label": label,
    });
    this.element.append(svg("circle", { class: "ring", cx: this.half, cy: this.half, r: radius }));
    if (axes) {
      const [near, far] = [this.half - radius, this.half + radius];
      this.element.append(
        svg("path", { class: "axes", d: `M${near} ${this.half}H${far}M${this.half} ${near}V${far}` }),
      );
    }
    this.scale = 0;
  }

  add(tag, attributes) {
    const element = svg(tag, attributes);
    this.element.append(element);
    return element;
  }

  /** Scale to the longest vector to be drawn, or to a thousandth of `whole`; zero draws none. */
  reach(longest, whole = 0) {
    this.scale = longest > 0 ? this.radius / Math.max(longest, LEAST * whole) : 0;
  }

  at([x, y]) {
    return [this.half + this.scale * x, this.half - this.scale * y];
  }

  curve(points) {
    return this.scale ? path(points.map((point) => this.at(point))) : "";
  }

  /** An arrow from one vector to another; short ones keep a small head. */
  arrow(from, to) {
    if (!this.scale) return "";
    const [[x0, y0], [x1, y1]] = [this.at(from), this.at(to)];
    const length = Math.hypot(x1 - x0, y1 - y0);
    if (length < 0.5) return "";
    const head = Math.min(9, 0.5 * length);
    const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
    const [bx, by] = [x1 - head * ux, y1 - head * uy];
    const [wx, wy] = [0.45 * head * uy, -0.45 * head * ux];
    return path([[x0, y0], [x1, y1]])
      + path([[x1, y1], [bx + wx, by + wy], [bx - wx, by - wy]], true);
  }
}

/** The curve of one vector and its arrow now. */
export class Arrow {
  constructor(label, name) {
    this.dial = new Dial(label);
    this.trace = this.dial.add("path", { class: `trace ${name}` });
    this.arrow = this.dial.add("path", { class: `arrow ${name}` });
    this.element = this.dial.element;
  }

  layout(points, longest, whole) {
    this.dial.reach(longest, whole);
    this.trace.setAttribute("d", this.dial.curve(points));
  }

  pose(vector) {
    this.arrow.setAttribute("d", this.dial.arrow([0, 0], vector));
  }
}

/** Orbits of several points, and where each is now. */
export class Orbits {
  constructor(label, names) {
    this.dial = new Dial(label);
    this.element = this.dial.element;
    this.parts = names.map((name) => ({
      orbit: this.dial.add("path", { class: `orbit ${name}` }),
      dot: this.dial.add("circle", { class: `dot ${name}`, r: 4 }),
    }));
  }

  layout(orbits, longest) {
    this.dial.reach(longest);
    this.parts.forEach(({ orbit }, k) => orbit.setAttribute("d", this.dial.curve(orbits[k])));
  }

  pose(points) {
    this.parts.forEach(({ dot }, k) => centre(dot, this.dial.at(points[k])));
  }
}

/** A torque about the axis towards the reader: an arc whose length is its size. */
export class Twist {
  constructor(label) {
    this.dial = new Dial(label, { axes: false });
    this.element = this.dial.element;
    const { half, radius } = this.dial;
    this.dial.add("path", { class: "axes", d: `M${half} ${half - radius - 6}v12` });
    this.arc = this.dial.add("path", { class: "twist" });
  }

  layout(largest) {
    this.largest = largest;
  }

  pose(torque) {
    const { half, radius } = this.dial;
    const turned = this.largest && torque ? (150 * torque) / this.largest : 0;
    const at = (degrees, by = 0) => {
      const [x, y] = unit(90 + degrees);
      return `${(half + (radius + by) * x).toFixed(2)} ${(half - (radius + by) * y).toFixed(2)}`;
    };
    if (Math.abs(turned) < 1) {
      this.arc.setAttribute("d", "");
      return;
    }
    const sense = turned > 0 ? 0 : 1;
    const neck = turned - Math.sign(turned) * Math.min(9, Math.abs(turned));
    this.arc.setAttribute("d",
      `M${at(0)}A${radius} ${radius} 0 0 ${sense} ${at(turned)}M${at(neck, -8)}L${at(turned)}L${at(neck, 8)}`);
  }
}
