// Torque of the crank over a cycle: with the gas pressure of the engine, or of an example.

import { anglesTicks, curves } from "./chart.mjs";
import { paneFields } from "./pane_controls.mjs";
import { shownIn } from "./table.mjs";
import { GASES } from "./fields.mjs";
import { WORDS } from "./words.mjs";

/** Degrees between samples. */
const SAMPLE = 1;

const MOST_TORQUE_ORDERS = 8;

export const torquePane = {
  key: "torque",
  title: "Torque",
  when: ({ summary }) => summary.firing,
  controls: (slot, tools) => paneFields(slot, "torque", [
    { name: "gas", label: WORDS.cycle, choices: { own: WORDS.ownCycle, ...GASES }, text: "petrol 1" },
  ], tools),
  make: async (slot, { ask, units, slots, table }) => {
    const { engine, design: { rpm } } = slot;
    const { gas } = slot.settings.torque;
    const [kind, load] = gas.split(" ");
    const fired = load ? await ask("with_cycle", { engine: engine.json, kind, load: Number(load) }) : engine;
    const count = (engine.summary.strokes === 2 ? 360 : 720) / SAMPLE;
    const theta = Array.from({ length: count + 1 }, (_, k) => k * SAMPLE);
    const found = await ask("waveform", { engine: fired.json, rpm, theta_deg: theta });
    const { orders, total } = await ask("balance", { engine: fired.json, rpm });
    const [unit, factor] = shownIn(units, "N·m");
    const scaled = (values) => Array.from(values, (value) => value * factor);
    const lines = [{ name: "first", label: WORDS.torques.whole, values: scaled(found.crank_torque) }];
    if (found["crank_torque.gas"]) lines.push({ name: "second", label: WORDS.torques.gas, values: scaled(found["crank_torque.gas"]) });
    const { roll, crank } = total.torque;
    const rows = orders.map(({ order, torque }) => [order, Math.hypot(...torque.crank), Math.hypot(...torque.roll)]);
    const largest = Math.max(...rows.map(([, value]) => value));
    return [
      curves({
        title: WORDS.torqueOver, x: theta, lines, across: WORDS.crankAngle, up: unit, about: true, wide: slots.length === 1,
        ticks: anglesTicks(0, theta.at(-1)),
      }),
      table({
        title: WORDS.torqueByOrder, total: true,
        columns: [{ label: "order" }, { label: "on the crank", unit: "N·m" }, { label: "roll torque on the block", unit: "N·m" }],
        rows: [["mean", crank.mean, roll.mean], ...rows.filter(([, value]) => value > 1e-6 * largest).slice(0, MOST_TORQUE_ORDERS),
          ["largest", crank.peak, roll.peak]],
      }),
    ];
  },
};
