// The settings of an engine: speed, bank angle, rod ratio, and the rocking.

import { Exaggeration, FASTEST, choice, chosen, pair } from "./controls.mjs";
import { html, numbered, show } from "./dom.mjs";
import { MOST_ORDERS } from "./orders.mjs";
import { STRINGS } from "./strings.mjs";

export class Settings {
  constructor(view) {
    this.view = view;
    const { figures } = view;
    const [least, most] = figures.rod_ratios ?? [0, 1];
    // Cars' engines reach 8000 rpm, slow ones half as much again as they are shown at first.
    const slow = figures.rpm > 0 && figures.rpm < 1000;
    const fastest = slow ? 1.5 * figures.rpm : Math.max(1.5 * figures.rpm, 8000);
    // Tables of loads have some speeds.
    const [lowest, highest] = figures.terms.loads.speeds ?? [0, FASTEST];
    const settle = () => this.show(view.state);
    this.rpm = pair(STRINGS.speed, STRINGS.speedField, "rpm", lowest, Math.min(fastest, highest), slow ? 0.1 : 10, STRINGS.rpm,
      (rpm) => view.set({ rpm }), settle, [lowest, highest]);
    this.bank = pair(STRINGS.bankAngle, STRINGS.bankAngleField, "bank-angle", 0, 180, 0.5,
      STRINGS.degrees, (bank_angle_deg) => view.set({ bank_angle_deg }), settle);
    this.rod = pair(STRINGS.rodRatio, STRINGS.rodRatioField, "rod-ratio", least, most, 0.001, "",
      (rod_ratio) => view.set({ rod_ratio }), settle);
    this.hold = choice("hold", STRINGS.holds, view);
    const held = html("div", { class: "hold" }, html("span", {}, STRINGS.choices.hold), this.hold);
    this.exaggeration = new Exaggeration(STRINGS.rocking, view);
    this.orders = html("span", {
      class: "rocking-orders", role: "group", "aria-label": STRINGS.rockingOrders,
    });
    this.element = chosen(figures, {
      rpm: [this.rpm.element], rod_ratio: [this.rod.element], bank_angle: [this.bank.element, held],
      rocking: [this.exaggeration.element, this.orders],
    });
  }

  /** Offer the orders that rock the engine. */
  layout(orders) {
    const listed = orders.map(({ order }) => order).join();
    if (listed === this.listed) return;
    this.listed = listed;
    this.boxes = orders.map(({ order }) => {
      const box = html("input", { type: "checkbox", name: "rocking-order", value: order });
      box.addEventListener("change", () => {
        const left = new Set(this.view.state.still);
        if (box.checked) left.delete(order);
        else left.add(order);
        this.view.set({ still: left });
      });
      const number = numbered(html, "span", "order");
      show(number, order, `${order}`);
      return [box, html("label", {}, box, `${STRINGS.order} `, number)];
    });
    // As many places at any settings, so that nothing jumps.
    const empty = Array.from({ length: MOST_ORDERS - orders.length }, () => html("label", {}));
    this.orders.replaceChildren(...this.boxes.map(([, label]) => label), ...empty);
  }

  show(state) {
    this.rpm.show(state.rpm);
    this.rod.show(state.rod_ratio);
    this.bank.show(state.bank_angle_deg);
    this.hold.value = state.hold;
    this.exaggeration.show(state.exaggeration);
    for (const [box] of this.boxes ?? []) box.checked = !state.still.has(Number(box.value));
  }
}
