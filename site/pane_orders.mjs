// How the engine shakes, order by order: sentences, a table, and a spectrum.

import { bars } from "./chart.mjs";
import { html } from "./dom.mjs";
import { shownIn } from "./table.mjs";
import { UNITS } from "./tables.mjs";
import { WORDS } from "./words.mjs";

/** Orders that are shown at most; those above are in the library. */
const MOST_LISTED_ORDERS = 8;

/** Orders whose peaks are all below this part of the largest are not shown: as in the library. */
const SMALLEST_SHARE = 1e-6;

/** Sentences that are shown before the reader asks for the others. */
const FIRST_SENTENCES = 3;

const COLUMNS = [
  { label: "order", key: "order" },
  { label: "force x", unit: "N", key: "force-x" }, { label: "force y", unit: "N", key: "force-y" },
  { label: "longest force", unit: "N", key: "force-peak" },
  { label: "moment about x", unit: "N·m", key: "moment-x" }, { label: "moment about y", unit: "N·m", key: "moment-y" },
  { label: "longest moment", unit: "N·m", key: "moment-peak" },
  { label: "roll torque", unit: "N·m", key: "roll" },
];

const row = ({ order, force, moment, torque }) => [order, ...force.peak_xy, force.peak,
  ...moment.peak_xy, moment.peak, torque ? Math.hypot(...torque.roll) : null];

/** Rows of the orders that matter, the largest of each quantity in mind. */
function mattering(rows) {
  const largest = rows[0]?.map((_, k) => Math.max(...rows.map((each) => each[k] ?? 0))) ?? [];
  const share = (each) => Math.max(0, ...[3, 6, 7].map((k) => (largest[k] ? (each[k] ?? 0) / largest[k] : 0)));
  return rows.filter((each) => share(each) > SMALLEST_SHARE).slice(0, MOST_LISTED_ORDERS);
}

/** How the engine shakes, in sentences: those of its picture, which was made at this speed or at another. */
function sentencesOf(core, { engine, design: { rpm }, bench: { figures } }, shown) {
  const sentences = figures.rpm === rpm ? figures.sentences
    : core.call("explain", { engine: engine.json, shown, ...(rpm > 0 ? { rpm } : {}) });
  const list = (few) => html("ul", { class: "explained" }, ...few.map((text) => html("li", {}, text)));
  const rest = sentences.slice(FIRST_SENTENCES);
  return html("div", {}, list(sentences.slice(0, FIRST_SENTENCES)),
    rest.length ? html("details", {}, html("summary", {}, WORDS.more), list(rest)) : "");
}

export const orders = {
  key: "orders",
  title: "Orders",
  make: async (slot, { core, units, slots, table }) => {
    const { engine, design } = slot;
    const found = core.call("balance", { engine: engine.json, rpm: design.rpm });
    const rows = found.orders.map(row);
    // Engines side by side have one scale.
    const others = slots.filter((each) => each.engine !== engine)
      .flatMap((each) => core.call("balance", { engine: each.engine.json, rpm: each.design.rpm }).orders.map(row));
    const shown = mattering(rows);
    const { force, moment, torque } = found.total;
    const whole = ["all", ...force.peak_xy, force.peak, ...moment.peak_xy, moment.peak, torque?.roll.peak ?? null];
    const named = (k, name, label) => {
      const [unit, factor] = shownIn(units, COLUMNS[k].unit);
      return { title: label, across: "order", up: unit, names: shown.map(([order]) => `${order}`),
        top: factor * Math.max(0, ...[...shown, ...others].map((each) => each[k] ?? 0)), series: [{ name, label, values: shown.map((each) => (each[k] ?? 0) * factor) }] };
    };
    return [
      sentencesOf(core, slot, UNITS.said[units]), table({ title: WORDS.peaksAt(design.rpm), columns: COLUMNS, rows: [...shown, whole], total: true }),
      ...(shown.length ? [html("div", { class: "charts" }, bars(named(3, "force", "Shaking force, longest")), bars(named(6, "moment", "Rocking moment, longest")),
        ...(torque ? [bars(named(7, "torque", "Roll torque"))] : []))] : []),
    ];
  },
};
