// The numbers of the engine as a whole, now and over a turn.

import { html, numbered, show, svg } from "./dom.mjs";
import { betweenScale, scaleFor, short } from "./format.mjs";
import { STRINGS } from "./strings.mjs";

const VECTORS = ["force", "moment"];
const AXES = ["x", "y"];

export class Readouts {
  /** @param {Record<string, any>} units */
  constructor(units = STRINGS.units) {
    this.units = units;
    const output = (name) => numbered(html, "output", name, { "aria-live": "off" });
    this.angle = output("crank-angle");
    this.torque = output("torque");
    this.speed = Object.fromEntries(["crank-speed", "irregularity", "inertia"].map((name) =>
      [name, numbered(svg, "tspan", name)]));
    this.speedLine = svg("tspan", { class: "detail" }, ...Object.entries(this.speed)
      .map(([name, element]) => svg("tspan", {}, STRINGS.speeds[name], element)));
    this.vectors = Object.fromEntries(VECTORS.map((quantity) =>
      [quantity, AXES.map((axis) => output(`${quantity}-${axis}`))]));
    this.longest = Object.fromEntries([...VECTORS, "torque", "orbit"].map((quantity) =>
      [quantity, numbered(html, "span", `${quantity}-longest`)]));
  }

  /** A list of the components of a vector and of its length at most. */
  listOf(quantity) {
    return html("dl", {},
      ...AXES.flatMap((axis, k) => [
        html("dt", { class: axis }, STRINGS.components[quantity][k]),
        html("dd", {}, this.vectors[quantity][k]),
      ]),
      ...this.most(STRINGS.longest, quantity));
  }

  listOfTorque() {
    return html("dl", {},
      html("dt", {}, STRINGS.about), html("dd", {}, this.torque),
      ...this.most(STRINGS.largest, "torque"));
  }

  listOfOrbits() {
    return html("dl", {}, ...this.most(STRINGS.farthest, "orbit"));
  }

  most(word, quantity) {
    return [
      html("dt", { class: "longest" }, word),
      html("dd", { class: "longest" }, this.longest[quantity]),
    ];
  }

  /** Choose units and digits for the largest values of a turn, and for speeds in a range. */
  layout(peaks) {
    this.scales = {};
    for (const [quantity, largest] of Object.entries(peaks)) {
      this.choose(quantity, largest);
    }
  }

  /** Choose unit and digits of one quantity. */
  choose(quantity, largest) {
    this.scales[quantity] = scaleFor(largest, this.units[quantity]);
    this.write(this.longest[quantity], quantity, largest);
  }

  /** Follow the range of the crank's speeds about their mean, if there are any, with a moment of inertia. */
  layoutSpeed(speeds, mean, inertia) {
    this.speedLine.toggleAttribute("hidden", !speeds);
    if (!speeds) return;
    const [low, high] = speeds;
    this.scales.speed = betweenScale(low, high, STRINGS.rpm);
    const { speed: elements } = this;
    const share = (high - low) / mean;
    show(elements.irregularity, share, `${Number((100 * share).toPrecision(3))} %`);
    const [unit, factor = 1] = this.units.inertia;
    show(elements.inertia, inertia, `${Number((factor * inertia).toPrecision(3))} ${unit}`);
  }

  pose({ thetaDeg, torque, speed, ...vectors }) {
    show(this.angle, thetaDeg, `${short(thetaDeg, 3)}${STRINGS.degrees}`);
    for (const quantity of VECTORS) {
      vectors[quantity].forEach((value, k) =>
        this.write(this.vectors[quantity][k], quantity, value));
    }
    if (speed) show(this.speed["crank-speed"], speed, `${this.scales.speed.text(speed)} ${STRINGS.rpm}`);
    if (torque === null) show(this.torque, "", STRINGS.noTorque);
    else this.write(this.torque, "torque", torque);
  }

  write(element, quantity, value) {
    const { text, unit } = this.scales[quantity];
    show(element, value, `${text(value)} ${unit}`);
  }
}
