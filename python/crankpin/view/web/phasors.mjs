// Phasors of each order, turning: the forward part with the crank, the backward part against it.

import { add, magnitude, multiply, unit } from "./complex.mjs";
import { fixed, html, numbered, show } from "./dom.mjs";
import { scaleFor } from "./format.mjs";
import { longest } from "./orders.mjs";
import { STRINGS } from "./strings.mjs";
import { Dial } from "./vectors.mjs";

const QUANTITIES = ["force", "moment"];
const PARTS = ["forward", "backward"];

export class Phasors {
  constructor(units = STRINGS.units) {
    this.units = units;
    this.element = html("div", { class: "phasors" });
    this.cards = [];
  }

  /** Draw the orders given; `whole` is what the cylinders make one by one. */
  layout(orders, whole) {
    // Cards stay while the orders do: the reader may be looking at one.
    const same = orders.length === this.cards.length
      && orders.every(({ order }, k) => order === this.cards[k].order);
    if (!same) {
      this.cards = orders.map(({ order }) => new Card(order, this.units));
      const none = html("p", {}, STRINGS.noOrders);
      this.element.replaceChildren(...(orders.length ? this.cards.map((c) => c.element) : [none]));
    }
    orders.forEach((each, k) => this.cards[k].layout(each, whole));
  }

  pose(thetaDeg) {
    for (const card of this.cards) card.pose(thetaDeg);
  }
}

class Card {
  constructor(order, units) {
    this.order = order;
    this.pictures = QUANTITIES.map((quantity) => new Picture(order, quantity, units[quantity]));
    this.element = html("div", { class: "card" },
      html("h3", {}, `${STRINGS.order} `, fixed(html, "span", "order", order, `${order}`)),
      html("div", { class: "pictures" }, ...this.pictures.map((each) => each.element)));
  }

  layout(parts, whole) {
    for (const each of this.pictures) each.layout(parts[each.quantity], whole[each.quantity]);
  }

  pose(thetaDeg) {
    const turned = [unit(this.order * thetaDeg), unit(-this.order * thetaDeg)];
    for (const each of this.pictures) each.pose(turned);
  }
}

class Picture {
  constructor(order, quantity, unit) {
    this.unit = unit;
    this.quantity = quantity;
    const label = `${STRINGS[quantity]}, ${STRINGS.order} ${order}`;
    this.dial = new Dial(label, { size: 100, radius: 44, axes: false });
    this.ellipse = this.dial.add("path", { class: `trace ${quantity}` });
    this.arrows = PARTS.map((part) => this.dial.add("path", { class: `arrow ${part}` }));
    this.values = PARTS.map((part) =>
      numbered(html, "span", `${quantity}-${part}-${order}`, { class: part }));
    this.element = html("div", { class: "phasor" },
      html("span", { class: "of" }, STRINGS[quantity]), this.dial.element, ...this.values);
  }

  layout({ forward, backward }, whole) {
    this.parts = [forward, backward];
    const reach = longest({ forward, backward });
    const scale = scaleFor(reach, this.unit);
    this.dial.reach(reach, whole);
    const points = Array.from({ length: 73 }, (_, k) => {
      const [cos, sin] = [Math.cos((k * Math.PI) / 36), Math.sin((k * Math.PI) / 36)];
      return add(multiply(forward, [cos, sin]), multiply(backward, [cos, -sin]));
    });
    this.ellipse.setAttribute("d", this.dial.curve(points));
    this.element.hidden = !reach;
    this.values.forEach((element, k) => {
      const size = magnitude(this.parts[k]);
      show(element, size, size ? `${scale.text(size)} ${scale.unit}` : "0");
    });
  }

  pose(turned) {
    const [forward, backward] = this.parts.map((part, k) => multiply(part, turned[k]));
    this.arrows[0].setAttribute("d", this.dial.arrow([0, 0], forward));
    this.arrows[1].setAttribute("d", this.dial.arrow(forward, add(forward, backward)));
  }
}
