// One engine as it is typed: its kind, the texts of its fields, and what a file has besides them.

import { DEFAULTS, FIELDS, KINDS, LOAD_FIELDS, groupsOf } from "./fields.mjs";
import { TypingError, quantity } from "./quantity.mjs";
import { PRESETS, UNITS } from "./tables.mjs";

/** Speed at first, rpm. */
const SPEED = 3000;

/** Most numbers of a list: the library's limit of cylinders is lower, and its error says so. */
const MOST_LISTED = 10000;

/** Parts of a cylinder in a file, by the fields that have them. */
const PART_OF = { bore: "bore", rod_length: "rod_length", reciprocating_mass: "reciprocating_mass", pin_offset: "pin_offset" };

/** What an engine's file has that another kind of engine keeps. */
const BESIDE_CYLINDERS = ["counterweights", "shafts", "powertrain", "reference_z"];

/** What names of presets speak of besides the bank angle, which they have from the engine. */
const NAMED = ["throws_deg", "pin_split_deg", "cylinders", "rows"];

/** Significant digits of places that were added up. */
const PLACE_DIGITS = 12;

/** The unit in which figures of files are written in fields, and its power of ten. */
const WRITTEN_IN = { m: ["mm", 3], kg: ["g", 3] };

export class Design {
  kind;
  file;
  preset;
  extra;
  rpm;

  /**
   * `file` is an engine's file as an object, of other kinds than `lists` what it has besides cylinders; `loads` texts of
   * periodic loads, by default the file's; `extra` what panes fitted to the engine.
   */
  constructor({ kind, fields = {}, file: given = null, loads = null, preset = null, extra = null, rpm = SPEED }) {
    const { loads: own = [], ...rest } = given ?? {};
    const file = given && rest;
    Object.assign(this, { kind, file, preset, extra, rpm });
    /** Texts of the fields of each load. */
    this.loads = (loads ?? own.map(textsOf)).map((each) => ({ ...each }));
    /** Texts of the preset that are no fields. */
    const { title = "", source = "" } = PRESETS[preset] ?? {};
    this.texts = { title, source };
    this.fields = { ...DEFAULTS, ...KINDS[kind].begins, ...(kind === "lists" && file?.placements ? fieldsOf(file) : {}), ...fields };
    this.before = { ...this.fields };
  }

  /** The engine that the library has by this name. */
  static preset(name) {
    if (!Object.hasOwn(PRESETS, name)) throw new TypingError("preset", name, "choose one of the list");
    const { kind, fields, file } = PRESETS[name];
    return new Design({ kind, fields: file ? fields : blank(kind, fields), file, preset: name });
  }

  /** An engine of a file of the library, as it writes it. */
  static file(json) {
    return new Design({ kind: "lists", file: JSON.parse(json) });
  }

  /** The same engine cylinder by cylinder, of its file; places without what adding up left behind their digits. */
  unrolled(json, name) {
    const file = { ...JSON.parse(json), name };
    for (const each of file.placements) each.z = Number(each.z.toPrecision(PLACE_DIGITS));
    const { extra, loads, rpm, fields: { inertia } } = this;
    return new Design({ kind: "lists", file, loads, fields: { inertia }, extra, rpm });
  }

  /** The same design, to be changed by itself. */
  copy() {
    return Object.assign(new Design(this), { before: this.before });
  }

  /** The same figures as another kind of engine. */
  as(kind) {
    const { name: _, ...fields } = this.fields;
    const shared = KINDS[kind].fields;
    const kept = Object.fromEntries(Object.entries(fields).filter(([key]) => this.names.includes(key)
      && (shared.includes(key) ? key !== "firing_order" : groupsOf(kind)[1][1].includes(key))));
    const { file, extra, loads, rpm } = this;
    const rest = file && Object.fromEntries(BESIDE_CYLINDERS.filter((name) => name in file).map((name) => [name, file[name]]));
    return new Design({ kind, fields: { ...kept, name: "" }, file: rest, loads, extra, rpm });
  }

  /** Have a pane's fit, or none of it. */
  fit(pane, list) {
    const { [pane]: _, ...others } = this.extra ?? {};
    const fits = list ? { ...others, [pane]: list } : others;
    this.extra = Object.keys(fits).length ? fits : null;
  }

  /** Names of the fields that it has. */
  get names() {
    return groupsOf(this.kind).flatMap(([, names]) => names);
  }

  /** Names of the fields whose texts are not those of the preset or the file. */
  get changed() {
    return this.names.filter((name) => (this.fields[name] ?? "") !== (this.before[name] ?? ""));
  }

  /** What the core builds: arguments of its call, or an engine's file as text; errors of fields in a list. */
  request(core, units) {
    const faults = [];
    const read = {};
    for (const name of this.names) {
      try {
        const value = valueOf(core, name, this.fields[name] ?? "", units, this.kind);
        if (value !== null) read[name] = value;
      } catch (error) {
        if (!(error instanceof TypingError)) throw error;
        faults.push(error);
      }
    }
    const loads = this.loads.map((texts, k) => loadOf(core, texts, k, units, faults));
    if (faults.length) throw Object.assign(new Error(faults[0].message), { faults });
    const { gas, inertia } = read;
    delete read.gas;
    delete read.inertia;
    const angles = Object.entries(read).filter(([name]) => FIELDS[name].unit === "°");
    const more = { gas, loads, inertia: inertia ?? null, angles: Object.fromEntries(angles.map(([name, typed]) => [name, [typed].flat()])) };
    const { title, source } = this.texts;
    read.name ??= NAMED.some((name) => this.changed.includes(name)) ? "" : title;
    return this.kind === "lists" ? { ...more, file: this.listed(read) } : { ...more, call: { kind: this.kind, source, ...read } };
  }

  /** The file with what was typed in place of its own figures. */
  listed(read) {
    const { file } = this;
    const count = read.bank_deg.length;
    for (const name of ["tdc_deg", "z"]) {
      if (read[name].length !== count) {
        throw fault(name, this.fields[name], `give ${count} numbers, one for each bore`);
      }
    }
    const of = (name, k) => {
      const values = read[name];
      if (values === undefined || values.length === 1) return values?.[0];
      if (values.length !== count) throw fault(name, this.fields[name], `give one number, or ${count}, one for each bore`);
      return values[k];
    };
    const { cylinder, ...rest } = { schema: 1, placements: [], ...file };
    const placements = Array.from({ length: count }, (_, k) => {
      const before = rest.placements[k] ?? rest.placements.at(-1) ?? {};
      const { rod, piston_mass: piston, ...parts } = before.cylinder ?? cylinder ?? {};
      const now = { crank_radius: of("stroke", k) / 2 };
      for (const [name, part] of Object.entries(PART_OF)) now[part] = of(name, k);
      // A rod brings its own length and share of the mass; others that are typed are in its place.
      const same = ["rod_length", "reciprocating_mass"].every((name) => now[name] === parts[name]);
      return {
        ...before, bank_deg: read.bank_deg[k], tdc_deg: read.tdc_deg[k], z: read.z[k], rotating_mass: of("rotating_mass", k),
        cylinder: { ...parts, ...(same && rod ? { rod, piston_mass: piston } : {}), ...now },
      };
    });
    return JSON.stringify({
      ...rest, name: read.name, firing_order: read.firing_order ?? "", strokes: Number(read.strokes), placements,
    });
  }
}

/** A load as files have it, of its texts; errors go to a list. */
function loadOf(core, texts, k, units, faults) {
  const read = {};
  for (const [key, field] of Object.entries(LOAD_FIELDS)) {
    const typed = (texts[key] ?? "").trim();
    if (!typed) continue;
    const name = `load-${k}-${key}`;
    try {
      read[key] = loadValue(core, typed, name, field, units);
    } catch (error) {
      if (!error.hint) throw error;
      faults.push(error);
    }
  }
  const { x = 0, y = 0, rpm, turning, name = "", ...rest } = read;
  const over = rpm && { over_speed: rpm.length > 1 ? { table: rpm } : { speed_squared: rpm[0] } };
  const crank = texts.crank ? { crank: Number(texts.crank) } : {};
  return { name, ...rest, ...over, ...crank, turning: turning === "yes", axis: [x, y] };
}

/**
 * @param {any} core
 * @param {string} typed
 * @param {string} name
 * @param {Record<string, any>} field
 * @param {string} units
 */
function loadValue(core, typed, name, { unit, amplitudes, speeds, ratio, whole }, units) {
  if (amplitudes) return core.call("amplitudes", { text: typed, unit, name });
  if (speeds) return quantity(core, typed.replaceAll("/", "; "), { unit, plain: unit, name, form: "list" }).values;
  if (ratio) {
    const [over, under = "1"] = typed.split("/");
    const value = Number(over) / Number(under);
    if (!Number.isFinite(value)) throw new TypingError(name, typed, "give a multiple of 1/2, such as 1/2, -1 or 2");
    return value;
  }
  if (whole) return quantity(core, typed, { unit: "count", name, what: "a whole number" }).values[0];
  if (unit === "°") {
    const { values: [value], texts: [text] } = quantity(core, typed, { unit, plain: unit, name });
    return degrees(text, value);
  }
  return unit ? quantity(core, typed, { unit, plain: plainUnit(unit, units), name }).values[0] : typed;
}

/** The texts of a load in a file. */
function textsOf(load) {
  const { name, on, over_speed: over = {}, axis: [x, y] = [0, 0], turning, crank, cylinder, ratio, z } = load;
  const sign = (im) => (im < 0 || Object.is(im, -0) ? "" : "+");
  const amplitude = (re, im) => (im ? `${re}${sign(im)}${im}j` : `${re}`);
  const amplitudes = (rows = []) => rows.map(([order, ...parts]) => `${order}: ${
    parts.flatMap((re, k) => (k % 2 ? [] : [amplitude(re, parts[k + 1])])).join("/")}`).join(", ");
  const length = (value) => (value ? written(value, "m") : "");
  return {
    name, on, force: amplitudes(load.force), torque: amplitudes(load.torque), turning: turning ? "yes" : "",
    rpm: over.table ? over.table.join("/") : `${over.speed_squared ?? ""}`,
    ratio: `${ratio ?? ""}`, z: length(z), x: length(x), y: length(y), direction_deg: `${load.direction_deg ?? ""}`,
    phase_deg: `${load.phase_deg ?? ""}`, cylinder: `${cylinder ?? ""}`, crank: `${crank ?? ""}`,
  };
}

/** What is not typed in a preset is nothing, not what other fields begin with. */
function blank(kind, fields) {
  const names = groupsOf(kind).flatMap(([, list]) => list).filter((name) => !FIELDS[name].choices);
  return { ...Object.fromEntries(names.map((name) => [name, ""])), ...fields };
}

/** An error as those of the core, for a list of them. */
function fault(name, value, hint) {
  const error = new TypingError(name, value, hint);
  return Object.assign(error, { faults: [error] });
}

/** The value of a field: a number in the library's unit, a text, a list; null if nothing is typed. */
function valueOf(core, name, text, units, kind) {
  const field = FIELDS[name];
  const typed = text.trim();
  if (!typed && !field.choices) {
    // The core says where a radial engine needs a spacing: with several rows.
    if (field.optional || (kind === "radial" && name === "spacing")) return null;
    throw new TypingError(name, typed, `give the ${field.label.toLowerCase()}`);
  }
  if (field.choices) return field.whole ? Number(typed) : typed;
  if (field.text) return typed;
  const read = (unit, form, what) => quantity(core, typed, { unit, plain: plainUnit(unit, units), name, form, what });
  if (field.whole) {
    const { values } = read("count", field.listed ? "list" : "number", "a whole number");
    if (!values.every(Number.isInteger)) throw new TypingError(name, typed, "give a whole number");
    return field.listed ? values : values[0];
  }
  if (field.unit === "°") {
    const { values, texts } = read("°", field.listed ? "list" : "number", "degrees, such as 90, 22.5 or 360/7");
    const listed = texts.map((text, k) => degrees(text, values[k]));
    return field.listed ? listed : listed[0];
  }
  const form = field.listed || kind === "lists" ? "list" : field.several ? "several" : "number";
  const { values, listed } = read(field.unit, form);
  return form === "list" || listed ? values.slice(0, MOST_LISTED) : values[0];
}

/** Decimals of degrees that are typed; a number of more was computed, and is no exact one. */
const TYPED_DECIMALS = 6;

/** Degrees stay a text: the library reads decimals and fractions exactly. */
function degrees(text, value) {
  return (text.split(".")[1] ?? "").length > TYPED_DECIMALS && !text.includes("/") ? value : text;
}

/** The unit that a number has of which none is typed. */
export function plainUnit(unit, units) {
  return unit in WRITTEN_IN ? UNITS.shown[units][unit][0] : unit;
}

/** The texts of an engine's file. */
function fieldsOf(file) {
  const { placements, cylinder } = file;
  const every = (values) => (values.every((each) => each === values[0]) ? values.slice(0, 1) : values);
  const text = (values, unit) => (values.every((each) => each === undefined || each === null) ? ""
    : every(values.map((each) => written(each ?? 0, unit))).join(", "));
  const of = (part) => placements.map((each) => (each.cylinder ?? cylinder)[part]);
  return {
    name: file.name ?? "", firing_order: file.firing_order ?? "", strokes: `${file.strokes ?? 4}`,
    stroke: text(of("crank_radius").map((radius) => 2 * radius), "m"),
    ...Object.fromEntries(Object.entries(PART_OF).map(([name, part]) => [name, text(of(part), FIELDS[name].unit)])),
    rotating_mass: text(placements.map((each) => each.rotating_mass), "kg"),
    bank_deg: placements.map((each) => `${each.bank_deg}`).join(", "),
    tdc_deg: placements.map((each) => `${each.tdc_deg}`).join(", "),
    z: placements.map(({ z }) => written(z, "m")).join(", "),
  };
}

/** A number of the library as it is typed: the same decimals, the point moved. */
function written(value, unit) {
  const [name, power] = WRITTEN_IN[unit];
  const [mantissa, exponent = "0"] = `${value}`.split("e");
  const [whole, part = ""] = mantissa.split(".");
  const moved = Number(exponent) + power;
  const digits = part.padEnd(Math.max(moved, 0), "0");
  if (moved < 0) return `${mantissa}e${moved} ${name}`;
  const text = `${whole}${digits.slice(0, moved)}.${digits.slice(moved)}`.replace(/\.?0*$/, "").replace(/^(-?)0+(?=\d)/, "$1");
  return `${text} ${name}`;
}
