// How an engine of two banks would shake at other bank angles: a curve for each order that matters.

import { anglesTicks, charted, curves } from "./chart.mjs";
import { explained, html } from "./dom.mjs";
import { paneFields } from "./pane_controls.mjs";
import { shownIn } from "./table.mjs";
import { WORDS } from "./words.mjs";

/** Half degrees from 0 to 180. */
const ANGLES = Array.from({ length: 361 }, (_, k) => k / 2);

const LINES = ["first", "second", "third", "fourth"];
const ANGLE_ORDERS = [1, 2, 4];
/** Forces, N, and moments below this are rounding. */
const NONE_AT_ALL = 1e-9;
const UNITS_OF = { force: "N", moment: "N·m" };

export const anglesPane = {
  key: "angles",
  title: "Bank angle",
  when: ({ summary }) => summary.bank_angle_deg !== null && summary.cranks.length === 1,
  controls: (slot, tools) => paneFields(slot, "angles", [
    { name: "hold", label: WORDS.held, choices: WORDS.holds, text: "pins" },
  ], tools),
  make: async (slot, { ask, units }) => {
    const { engine, design } = slot;
    const found = await ask("bank_angles", {
      engine: engine.json, rpm: design.rpm, bank_angle_deg: ANGLES, hold: slot.settings.angles.hold, orders: ANGLE_ORDERS,
    });
    const own = engine.summary.bank_angle_deg;
    const choose = design.names.includes("bank_angle_deg") ? (angle) => slot.type("bank_angle_deg", `${Math.round(2 * angle) / 2}`) : null;
    const pictures = ["force", "moment"].map((quantity) => {
      const [unit, factor] = shownIn(units, UNITS_OF[quantity]);
      const lines = ANGLE_ORDERS.map((order, k) => ({
        name: LINES[k], label: `${WORDS.order} ${order}`, values: found[quantity][k].map((value) => value * factor),
      }));
      const none = lines.every(({ values }) => values.every((value) => value < NONE_AT_ALL));
      return none ? charted(WORDS.over[quantity], html("p", {}, WORDS.zeroEverywhere)) : curves({
        title: WORDS.over[quantity], x: ANGLES, lines, across: WORDS.bankAngle, up: unit, choose,
        ticks: anglesTicks(0, 180), marks: [{ at: own, text: WORDS.own(own) }],
      });
    });
    return [html("div", { class: "charts" }, ...pictures), choose ? explained(WORDS.chooseAngle) : ""];
  },
};
