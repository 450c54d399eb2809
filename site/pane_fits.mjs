// What makes the engine smooth: counterweights and balance shafts that fit, and what they leave.

import { html } from "./dom.mjs";
import { paneFields } from "./pane_controls.mjs";
import { tableOf } from "./table.mjs";
import { WORDS } from "./words.mjs";

/** Orders whose residuals are listed. */
const RESIDUAL_ORDERS = [1, 2];

const RESIDUAL_COLUMNS = [
  { label: "order" }, { label: "force before", unit: "N" }, { label: "force after", unit: "N", key: "force-after" },
  { label: "moment before", unit: "N·m" }, { label: "moment after", unit: "N·m", key: "moment-after" },
];

/** What an engine fitted with something leaves, beside what it was. */
export function residual({ core, units }, { engine, design }, fitted) {
  const [before, after] = [engine.json, fitted.json].map((each) =>
    core.call("balance", { engine: each, rpm: design.rpm, orders: RESIDUAL_ORDERS, torque: false }).orders);
  const rows = before.map(({ order, force, moment }, k) =>
    [order, force.peak, after[k].force.peak, moment.peak, after[k].moment.peak]);
  return tableOf({ title: WORDS.residual, columns: RESIDUAL_COLUMNS, rows, units, name: engine.summary.name });
}

/** Buttons that fit hardware to the engine of the form, or take it off. */
export function fitButtons(slot, fitted) {
  const { counterweights = [], shafts = [] } = JSON.parse(fitted.json);
  const nothing = !counterweights.length && shafts.every(({ unbalances }) => !unbalances.length);
  const fit = html("button", { type: "button", disabled: nothing }, WORDS.fit);
  fit.addEventListener("click", () => slot.fit({ counterweights, shafts }));
  const off = html("button", { type: "button", disabled: !slot.design.extra }, WORDS.unfit);
  off.addEventListener("click", () => slot.fit(null));
  return html("p", { class: "buttons" }, fit, off);
}

/** What fits as a table, or that nothing does. */
const tableOfFit = (given) => (given.rows.length ? tableOf(given) : html("p", { class: "hint" }, WORDS.nothingToFit));

const MASS_COLUMNS = [
  { label: "no." }, { label: "place z", unit: "m" }, { label: "unbalance", unit: "kg·m", key: "unbalance" }, { label: "angle °" },
];

const weightRows = (list) => list.map(({ z, amount, angle_deg: angle, crank }, k) =>
  [crank ? `${k + 1}, crank ${crank}` : `${k + 1}`, z, amount, Number(angle)]);

export const counterweightsPane = {
  key: "counterweights",
  title: "Counterweights",
  make: async (slot, tools) => {
    const fitted = await tools.ask("counterweights", { engine: slot.bare().json });
    const { counterweights = [] } = JSON.parse(fitted.json);
    return [
      html("p", { class: "hint" }, WORDS.counterweightsSaid),
      tableOfFit({ title: WORDS.counterweights, columns: MASS_COLUMNS, rows: weightRows(counterweights), units: tools.units, name: slot.engine.summary.name }),
      residual(tools, slot, fitted), fitButtons(slot, fitted),
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
    const fitted = await tools.ask("balance_shafts", {
      engine: slot.engine.json, rpm: slot.design.rpm, ratios: speeds, x: speeds.map((_, k) => (k ? -x : x)), y: speeds.map(() => y),
    });
    const rows = (JSON.parse(fitted.json).shafts ?? []).flatMap(({ ratio, x: at, y: height, unbalances }, k) =>
      unbalances.map(({ z, amount, angle_deg: angle }) => [`${k + 1}`, ratio, at, height, z, amount, Number(angle)]));
    const columns = [{ label: "shaft" }, { label: "ratio" }, { label: "x", unit: "m" }, { label: "y", unit: "m" }, ...MASS_COLUMNS.slice(1)];
    return [
      tableOfFit({ title: WORDS.shafts, columns, rows, units: tools.units, name: slot.engine.summary.name }),
      residual(tools, slot, fitted), fitButtons(slot, fitted),
    ];
  },
};
