// What makes the engine smooth: counterweights and balance shafts that fit, and what they leave.

import { fitOf } from "./fits.mjs";
import { button, explained, html } from "./dom.mjs";
import { paneFields } from "./pane_controls.mjs";
import { WORDS } from "./words.mjs";

/** Orders whose residuals are listed. */
const RESIDUAL_ORDERS = [1, 2];

const RESIDUAL_COLUMNS = [
  { label: "order" }, { label: "force before", unit: "N", key: "force-before" }, { label: "force after", unit: "N", key: "force-after" },
  { label: "moment before", unit: "N·m", key: "moment-before" }, { label: "moment after", unit: "N·m", key: "moment-after" },
];

/** What an engine fitted with something leaves, beside what it is without that. */
function residual({ core, table }, { design }, ends) {
  const [before, after] = ends.map(({ json }) =>
    core.call("balance", { engine: json, rpm: design.rpm, orders: RESIDUAL_ORDERS, torque: false }).orders);
  const rows = before.map(({ order, force, moment }, k) =>
    [order, force.peak, after[k].force.peak, moment.peak, after[k].moment.peak]);
  return table({ title: WORDS.residual, columns: RESIDUAL_COLUMNS, rows });
}

/** Buttons that fit what a pane has to the engine of the form, or take that off. */
export function fitButtons(slot, pane, list) {
  const has = slot.design.extra?.[pane];
  const fit = button(WORDS.fit, () => slot.fit(pane, list), { disabled: !list.length });
  const off = button(WORDS.unfit, () => slot.fit(pane, null), { disabled: !has });
  const another = has && JSON.stringify(has) !== JSON.stringify(list);
  return html("div", {}, another ? explained(WORDS.fitOfAnother) : "", html("p", { class: "buttons" }, fit, off));
}

const MASS_COLUMNS = [
  { label: "no." }, { label: "place z", unit: "m" }, { label: "unbalance", unit: "kg·m", key: "unbalance" }, { label: "angle °", key: "angle" },
];

export const counterweightsPane = {
  key: "counterweights",
  title: "Counterweights",
  make: async (slot, tools) => {
    const before = slot.fitted({ counterweights: null });
    const after = await tools.ask("counterweights", { engine: before.json });
    const list = fitOf("counterweights", before, after);
    const { bob, fit, own } = WORDS.origins;
    const first = slot.design.extra?.bob ? bob : own;
    const rows = after.summary.weights.map(({ z, amount, direction_deg: angle, crank }, k, all) =>
      [crank ? `${k + 1}, crank ${crank}` : `${k + 1}`, z, amount, angle, k < all.length - list.length ? first : fit]);
    return [
      explained(WORDS.counterweightsSaid),
      list.length ? "" : explained(WORDS.nothingToFit),
      rows.length ? tools.table({ title: WORDS.counterweights, columns: [...MASS_COLUMNS, { label: "of", key: "of" }], rows }) : "",
      residual(tools, slot, [before, after]), fitButtons(slot, "counterweights", list),
    ];
  },
};

/** Arrangements of shafts: their ratios. */
const SHAFTS = {
  "-1": "one against the crank", "1, -1": "a pair at crank speed", "2, -2": "a pair at twice crank speed (Lanchester)",
  "-1, -1": "two against the crank, one on each side",
};

export const shaftsPane = {
  key: "shafts",
  title: "Balance shafts",
  controls: (slot, tools) => paneFields(slot, "shafts", [
    { name: "ratios", label: "Shafts", choices: SHAFTS, text: "-1" },
    { name: "x", label: "Distance to the side", unit: "m", text: "80 mm" },
    { name: "y", label: "Height above the crank", unit: "m", text: "0 mm" },
  ], tools),
  make: async (slot, tools) => {
    const { ratios, x, y } = slot.settings.shafts;
    const speeds = ratios.split(",").map(Number);
    const before = slot.fitted({ shafts: null });
    const after = await tools.ask("balance_shafts", {
      engine: before.json, rpm: slot.design.rpm, ratios: speeds, x: speeds.map((_, k) => (k && x !== null ? -x : x)), y: speeds.map(() => y),
    });
    const list = fitOf("shafts", before, after);
    const { fit, own } = WORDS.origins;
    const rows = after.summary.shaft_weights.map(({ shaft, ratio, x: at, y: height, z, amount, direction_deg: angle }) =>
      [`${shaft + 1}`, ratio, at, height, z, amount, angle, shaft < before.summary.shafts ? own : fit]);
    const columns = [{ label: "shaft" }, { label: "ratio" }, { label: "x", unit: "m" }, { label: "y", unit: "m" }, ...MASS_COLUMNS.slice(1), { label: "of", key: "of" }];
    return [
      list.length ? "" : explained(WORDS.nothingToFit),
      rows.length ? tools.table({ title: WORDS.shafts, columns, rows }) : "",
      residual(tools, slot, [before, after]), fitButtons(slot, "shafts", list),
    ];
  },
};
