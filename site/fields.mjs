// What can be typed of an engine: the arguments of the library's builders, by their names.

import { DECLARED, OF_LOADS } from "./tables.mjs";

/** Example cycles: their kinds and loads. */
export const GASES = {
  "petrol 1": "example: petrol, full load", "petrol 0.3": "example: petrol, part load", "diesel 1": "example: diesel, full load",
};

/** What the function that takes an argument declares of it, and how it is typed. */
const declared = (name, field, declarations = DECLARED) => {
  const { unit, said } = declarations[name];
  return { ...(unit && { unit }), said, ...field };
};
const ofLoads = (name, field) => declared(name, field, OF_LOADS);

/** Of each field its label, the library's unit, and what it means; `choices` of those that are chosen. */
export const FIELDS = {
  name: { label: "Name", text: true, optional: true },
  bore: declared("bore", { label: "Bore", optional: true, said: "drawn only; gas pressure acts on it" }),
  stroke: declared("stroke", { label: "Stroke" }),
  rod_length: declared("rod_length", { label: "Rod length" }),
  reciprocating_mass: declared("reciprocating_mass", { label: "Reciprocating mass" }),
  rotating_mass: declared("rotating_mass", {
    label: "Rotating mass", optional: true, said: "big end and bearing, of one cylinder; and its share of the crankpin",
  }),
  pin_offset: declared("pin_offset", { label: "Pin offset", optional: true }),
  throws_deg: declared("throws_deg", { label: "Throws", listed: true }),
  bank_angle_deg: declared("bank_angle_deg", { label: "Bank angle", range: [0, 180, 0.5] }),
  pin_split_deg: declared("pin_split_deg", { label: "Pin split", optional: true, range: [-180, 180, 0.5] }),
  spacing: declared("spacing", { label: "Spacing", several: true }),
  bank_stagger: declared("bank_stagger", {
    label: "Bank stagger", optional: true, said: "how far each bank stands behind the one before it, the left one behind the right",
  }),
  absent: declared("absent", { label: "Absent cylinders", whole: true, listed: true, optional: true }),
  odd_bank: { label: "Cylinder 1 is in", choices: { right: "the right bank", left: "the left bank" } },
  numbering: { label: "Numbering", choices: { alternating: "from bank to bank", "by-bank": "bank by bank" } },
  cylinders: declared("cylinders", { label: "Cylinders", whole: true }),
  rows: declared("rows", { label: "Rows", whole: true, optional: true }),
  distance: declared("distance", { label: "Distance of the cranks", said: "of the second crank to the right of the main one, or above it" }),
  lead_deg: declared("lead_deg", { label: "Lead of the upper crank", optional: true, range: [-180, 180, 0.5] }),
  phase_deg: declared("phase_deg", { label: "Phase of the second engine", optional: true, range: [-360, 360, 0.5] }),
  ratio: declared("ratio", { label: "The second crank turns", whole: true, choices: { 1: "with the main one", "-1": "against it" } }),
  bank_deg: declared("bank_deg", { label: "Bores", listed: true }),
  tdc_deg: declared("tdc_deg", { label: "Top dead centres", listed: true }),
  z: declared("z", { label: "Places along the crank", listed: true }),
  firing_order: declared("firing_order", { label: "Firing order", text: true, optional: true, said: "such as 1-3-4-2" }),
  gas: { label: "Gas pressure", choices: { "": "not counted", ...GASES } },
  inertia: declared("inertia", { label: "Flywheel inertia", optional: true }),
  strokes: { label: "Cycle", whole: true, choices: { 4: "four-stroke", 2: "two-stroke" } },
};

const BY_ORDER = "order: size, size@phase° or complex, such as 2: 8, 4: 1.5@-30, 6: 4-1j; order 0 is the mean";

/** What can be typed of a periodic load, as of an engine; `seldom` of those that are behind a summary. */
export const LOAD_FIELDS = {
  name: { label: "Name", text: true, said: "under which results count it" },
  on: ofLoads("on", {
    label: "Acts on", choices: { shaft: "its shaft, from outside", block: "the block, from outside", both: "its shaft, against the block" },
    said: "a propeller or belt on its shaft; pumps and valve trains against the block, which turn it back and leave no net force",
  }),
  force: ofLoads("force", { label: "Force by order", amplitudes: true, optional: true, said: BY_ORDER }),
  torque: ofLoads("torque", { label: "Torque by order", amplitudes: true, optional: true, said: BY_ORDER }),
  rpm: {
    label: "Reference speed", unit: "rpm", speeds: true, optional: true,
    said: "at which the load has these sizes: it scales with the square of the speed; 1000/2000 with sizes 8/9 is a table; empty: the same at any speed",
  },
  ratio: ofLoads("ratio", { label: "Speed of its shaft", ratio: true, optional: true }),
  z: ofLoads("z", { label: "Place along the crank", optional: true }),
  x: ofLoads("x", { label: "Axis, x", optional: true, seldom: true }),
  y: ofLoads("y", { label: "Axis, y", optional: true, seldom: true }),
  direction_deg: ofLoads("direction_deg", { label: "Direction of the force", optional: true, seldom: true }),
  turning: { label: "The force", choices: { "": "keeps its direction", yes: "turns with its shaft" }, seldom: true },
  phase_deg: ofLoads("phase_deg", { label: "Phase", optional: true, seldom: true }),
  cylinder: ofLoads("cylinder", { label: "Turns with the bank of cylinder", whole: true, optional: true, seldom: true }),
};

/** What a load has until something is typed. */
export const NEW_LOAD = { name: "load", on: "shaft", torque: "2: 10" };

const OF_A_CYLINDER = ["bore", "stroke", "rod_length", "reciprocating_mass", "rotating_mass", "pin_offset"];
const FIRING = ["firing_order", "strokes", "gas", "inertia"];
const BANKS = ["spacing", "bank_stagger", "odd_bank", "numbering"];
const SECOND_CRANK = ["spacing", "distance", "ratio"];

/** Kinds of engines: builders of the library, what they take besides the parts of a cylinder, and what of it `begins` otherwise. */
export const KINDS = {
  inline: { label: "Inline, or a single", fields: ["throws_deg", "spacing", ...FIRING] },
  vee: { label: "V", fields: ["bank_angle_deg", "throws_deg", "pin_split_deg", "absent", ...BANKS, ...FIRING] },
  flat: { label: "Flat, shared crankpins", fields: ["throws_deg", ...BANKS, ...FIRING] },
  boxer: { label: "Boxer", fields: ["throws_deg", ...BANKS, ...FIRING] },
  fan: {
    label: "W, X and others", fields: ["bank_deg", "throws_deg", "spacing", "bank_stagger", ...FIRING],
    begins: { bank_deg: "30, 90, 150" },
  },
  radial: { label: "Radial", fields: ["cylinders", "rows", "spacing", ...FIRING] },
  opposed_pistons: {
    label: "Opposed pistons, two cranks", fields: ["throws_deg", ...SECOND_CRANK, "lead_deg", ...FIRING],
    begins: { distance: "500 mm", ratio: "1", strokes: "2" },
  },
  u: { label: "U, two cranks side by side", fields: ["throws_deg", ...SECOND_CRANK, "phase_deg", ...FIRING] },
  square_four: { label: "Square four", fields: [...SECOND_CRANK, ...FIRING] },
  h: { label: "H, two flat engines", fields: ["throws_deg", ...SECOND_CRANK, "phase_deg", ...FIRING], begins: { distance: "220 mm" } },
  lists: { label: "Cylinder by cylinder", fields: ["bank_deg", "tdc_deg", "z", ...FIRING] },
};

/** Names of the fields of a kind, in groups with their headings. */
export const groupsOf = (kind) => [
  ["Engine", ["name"]], ["Cylinder", OF_A_CYLINDER], ["Layout", KINDS[kind].fields],
];

/** What a field has until something is typed. */
export const DEFAULTS = {
  name: "", bore: "86 mm", stroke: "86 mm", rod_length: "145 mm", reciprocating_mass: "450 g", spacing: "100 mm",
  throws_deg: "0", distance: "120 mm", ratio: "-1", bank_angle_deg: "90", cylinders: "7", bank_deg: "90", tdc_deg: "0", z: "0 mm",
  odd_bank: "right", numbering: "alternating", strokes: "4", gas: "", inertia: "",
};
