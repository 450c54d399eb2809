// What can be typed of an engine: the arguments of the library's builders, by their names.

/** Example cycles: their kinds and loads. */
export const GASES = {
  "petrol 1": "example: petrol, full load", "petrol 0.3": "example: petrol, part load", "diesel 1": "example: diesel, full load",
};

/** Of each field its label, the library's unit, and what it means; `choices` of those that are chosen. */
export const FIELDS = {
  name: { label: "Name", text: true, optional: true },
  bore: { label: "Bore", unit: "m", optional: true, said: "drawn only; gas pressure acts on it" },
  stroke: { label: "Stroke", unit: "m", said: "twice the crank radius" },
  rod_length: { label: "Rod length", unit: "m", said: "between centres" },
  reciprocating_mass: {
    label: "Reciprocating mass", unit: "kg", said: "piston, pin, rings, clips and the rod’s small end, of one cylinder",
  },
  rotating_mass: {
    label: "Rotating mass", unit: "kg", optional: true, said: "big end and bearing, of one cylinder; and its share of the crankpin",
  },
  pin_offset: {
    label: "Pin offset", unit: "m", optional: true, said: "of the piston pin, towards the side to which the crankpin swings",
  },
  throws_deg: {
    label: "Throws", unit: "°", listed: true, said: "crankpin angles in the direction of rotation, front to flywheel",
  },
  bank_angle_deg: { label: "Bank angle", unit: "°", range: [0, 180, 0.5], said: "between the banks" },
  pin_split_deg: {
    label: "Pin split", unit: "°", optional: true, range: [-180, 180, 0.5],
    said: "left pin minus right pin; even firing needs bank angle − firing interval",
  },
  spacing: { label: "Spacing", unit: "m", several: true, said: "between neighbouring throws, or of each throw from the one before it" },
  bank_stagger: { label: "Bank stagger", unit: "m", optional: true, said: "how far each bank stands behind the one before it, the left one behind the right" },
  absent: { label: "Absent cylinders", whole: true, listed: true, optional: true, said: "numbers in the whole V of those that are not there: 6 makes a V5 of three throws" },
  odd_bank: { label: "Cylinder 1 is in", choices: { right: "the right bank", left: "the left bank" } },
  numbering: { label: "Numbering", choices: { alternating: "from bank to bank", "by-bank": "bank by bank" } },
  cylinders: { label: "Cylinders", whole: true, said: "of all rows" },
  rows: { label: "Rows", whole: true, optional: true },
  bank_deg: { label: "Bores", unit: "°", listed: true, said: "directions from the right, counter-clockwise; 90 is upright, 30, 90, 150 a W" },
  tdc_deg: { label: "Top dead centres", unit: "°", listed: true, said: "crank angle of each cylinder" },
  z: { label: "Places along the crank", unit: "m", listed: true, said: "from the front to the flywheel" },
  firing_order: { label: "Firing order", text: true, optional: true, said: "such as 1-3-4-2" },
  gas: { label: "Gas pressure", choices: { "": "not counted", ...GASES } },
  inertia: {
    label: "Flywheel inertia", unit: "kg·m²", optional: true, said: "moment of inertia that turns with the crank; for its speed over a cycle",
  },
  strokes: { label: "Cycle", choices: { 4: "four-stroke", 2: "two-stroke" } },
};

const BY_ORDER = "order: size, size@phase° or complex, such as 2: 8, 4: 1.5@-30, 6: 4-1j; order 0 is the mean";

/** What can be typed of a periodic load, as of an engine; `seldom` of those that are behind a summary. */
export const LOAD_FIELDS = {
  name: { label: "Name", text: true, said: "under which results count it" },
  on: {
    label: "Acts on", choices: { shaft: "its shaft, from outside", block: "the block, from outside", both: "its shaft, against the block" },
    said: "a propeller or belt on its shaft; pumps and valve trains against the block, which turn it back and leave no net force",
  },
  force: { label: "Force by order", unit: "N", amplitudes: true, optional: true, said: BY_ORDER },
  torque: { label: "Torque by order", unit: "N·m", amplitudes: true, optional: true, said: BY_ORDER },
  rpm: {
    label: "Reference speed", unit: "rpm", speeds: true, optional: true,
    said: "at which the load has these sizes: it scales with the square of the speed; 1000/2000 with sizes 8/9 is a table; empty: the same at any speed",
  },
  ratio: { label: "Speed of its shaft", ratio: true, optional: true, said: "over the crank’s, in halves: 1/2 of a camshaft; empty: on the crank’s" },
  z: { label: "Place along the crank", unit: "m", optional: true, said: "from the front to the flywheel" },
  x: { label: "Axis, x", unit: "m", optional: true, seldom: true, said: "of a shaft of its own, to the right of the crank’s" },
  y: { label: "Axis, y", unit: "m", optional: true, seldom: true, said: "above the crank’s" },
  direction_deg: { label: "Direction of the force", unit: "°", optional: true, seldom: true, said: "from the right, counter-clockwise" },
  turning: { label: "The force", choices: { "": "keeps its direction", yes: "turns with its shaft" }, seldom: true },
  phase_deg: { label: "Phase", unit: "°", optional: true, seldom: true, said: "crank angle at which its own is 0" },
  cylinder: { label: "Turns with the bank of cylinder", whole: true, optional: true, seldom: true, said: "as the bank angle changes" },
};

/** What a load has until something is typed. */
export const NEW_LOAD = { name: "load", on: "shaft", torque: "2: 10" };

const OF_A_CYLINDER = ["bore", "stroke", "rod_length", "reciprocating_mass", "rotating_mass", "pin_offset"];
const FIRING = ["firing_order", "strokes", "gas", "inertia"];
const BANKS = ["spacing", "bank_stagger", "odd_bank", "numbering"];

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
  lists: { label: "Cylinder by cylinder", fields: ["bank_deg", "tdc_deg", "z", ...FIRING] },
};

/** Names of the fields of a kind, in groups with their headings. */
export const groupsOf = (kind) => [
  ["Engine", ["name"]], ["Cylinder", OF_A_CYLINDER], ["Layout", KINDS[kind].fields],
];

/** What a field has until something is typed. */
export const DEFAULTS = {
  name: "", bore: "86 mm", stroke: "86 mm", rod_length: "145 mm", reciprocating_mass: "450 g", spacing: "100 mm",
  throws_deg: "0", bank_angle_deg: "90", cylinders: "7", bank_deg: "90", tdc_deg: "0", z: "0 mm",
  odd_bank: "right", numbering: "alternating", strokes: "4", gas: "", inertia: "",
};
