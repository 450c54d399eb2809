// The bob weights with which the crankshaft is balanced, and what each balance factor leaves.

import { explained, html } from "./dom.mjs";
import { short } from "./format.mjs";
import { paneFields } from "./pane_controls.mjs";
import { fitOf } from "./fits.mjs";
import { fitButtons } from "./pane_fits.mjs";
import { WORDS } from "./words.mjs";

/** Factors that are compared at most. */
const MOST_FACTORS = 4;

const percent = (factor) => `${short(100 * factor, 3)} %`;

/** What is to be known of a vector's factors: the least, and those that leave a straight line. */
function lines(name, { exists, least, straight }) {
  if (!exists) return [];
  return [
    ...(least === null ? [] : [WORDS.leastAt(name, percent(least))]),
    ...straight.map(([factor, direction]) => WORDS.straightAt(name, percent(factor), short(direction, 1))),
  ];
}

export const bobPane = {
  key: "bob",
  title: "Bob weight",
  controls: (slot, tools) => paneFields(slot, "bob", [
    { name: "factors", label: WORDS.factors, unit: "", listed: true, text: "50 %, 52 %" },
  ], tools),
  make: async (slot, { ask, core, table }) => {
    const { design: { rpm }, settings } = slot;
    const factors = settings.bob.factors.slice(0, MOST_FACTORS);
    const found = [];
    const before = slot.fitted({ bob: null });
    for (const factor of factors) found.push(await ask("bob_weights", { engine: before.json, factor }));
    if (!found.length) return [];
    const fits = found.map((each) => fitOf("bob", before, each));
    const left = fits.map((bob, k) => {
      const [{ force, moment }] = core.call("balance", { engine: slot.fitted({ bob }).json, rpm, orders: [1], torque: false }).orders;
      return [percent(factors[k]), force.peak, ...force.peak_xy, moment.peak, ...moment.peak_xy];
    });
    const [{ pins, order_1: first }] = found;
    const isBeside = found.some((each) => each.pins.some(({ across }) => across));
    return [
      table({
        title: WORDS.bobWeights,
        columns: [{ label: "cylinders" }, { label: "rotating", unit: "kg" }, { label: "reciprocating", unit: "kg" },
          ...factors.flatMap((factor) => [
            { label: `bob weight at ${percent(factor)}`, unit: "kg", key: "bob-weight" },
            ...(isBeside ? [{ label: "across", unit: "kg" }] : [])])],
        rows: pins.map(({ cylinders, rotating, reciprocating }, k) => [cylinders.join(", "), rotating, reciprocating,
          ...found.flatMap(({ pins: { [k]: pin } }) => [pin.bob_weight, ...(isBeside ? [pin.across] : [])])]),
      }),
      ...(isBeside ? [explained(WORDS.acrossPins)] : []),
      ...(pins.every(({ rotating }) => rotating > 0) ? [] : [explained(WORDS.noRotatingMass)]),
      table({
        title: WORDS.bobLeaves(short(rpm, 3)),
        columns: [{ label: "balance factor" }, { label: "longest force", unit: "N" }, { label: "force x", unit: "N" }, { label: "force y", unit: "N" },
          { label: "longest moment", unit: "N·m" }, { label: "moment about x", unit: "N·m" }, { label: "moment about y", unit: "N·m" }],
        rows: left,
      }),
      html("ul", { class: "explained" }, ...[...lines(WORDS.vectors.force, first.force), ...lines(WORDS.vectors.moment, first.moment)]
        .map((text) => html("li", {}, text))),
      explained(WORDS.bobSaid), fitButtons(slot, "bob", fits[0]),
    ];
  },
};
