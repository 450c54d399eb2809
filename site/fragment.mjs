// An engine in the page's address, behind the #, which no browser sends: a preset or a kind, and what was typed.

import { Design } from "./design.mjs";
import { KINDS, LOAD_FIELDS } from "./fields.mjs";
import { checkedFits } from "./fits.mjs";
import { TypingError } from "./quantity.mjs";
import { UNITS } from "./tables.mjs";

/** Longest text that a packed file may have, bytes: as the library's. */
const MOST_BYTES = 1 << 24;

/**
 * The fragment of designs: of the first one, and the others behind it.
 *
 * @param {Design[]} designs
 * @param {string} units
 * @returns {Promise<string>}
 */
export async function fragmentOf([design, ...others], units) {
  const found = new URLSearchParams();
  if (design.preset) found.set("preset", design.preset);
  else found.set("kind", design.kind);
  if (design.file && !design.preset) found.set("file", await packed(JSON.stringify(design.file)));
  const names = design.preset || design.file?.placements ? design.changed : design.names;
  for (const name of names) found.set(name, design.fields[name] ?? "");
  if (design.loads.length) found.set("loads", await packed(JSON.stringify(design.loads)));
  if (design.extra) found.set("extra", await packed(JSON.stringify(design.extra)));
  found.set("rpm", `${design.rpm}`);
  if (units !== UNITS.settings[0]) found.set("units", units);
  if (others.length) found.set("with", (await fragmentOf(others, units)).slice(1));
  return `#${found}`;
}

/** The designs and the units of a fragment; null of none. */
export async function designsOf(fragment, most = 2) {
  const given = new URLSearchParams(fragment.replace(/^#/, ""));
  const units = UNITS.settings.find((each) => each === given.get("units")) ?? UNITS.settings[0];
  const preset = given.get("preset");
  const kind = given.get("kind");
  if (!preset && !kind) return null;
  if (!preset && !Object.hasOwn(KINDS, kind)) throw new TypingError("kind", kind, `give ${Object.keys(KINDS).join(", ")}`);
  const file = given.has("file") ? JSON.parse(await unpacked(given.get("file"))) : null;
  const design = preset ? Design.preset(preset) : new Design({ kind, file });
  for (const name of design.names) {
    if (given.has(name)) design.fields[name] = given.get(name);
  }
  if (given.has("loads")) design.loads = checkedLoads(JSON.parse(await unpacked(given.get("loads"))));
  if (given.has("extra")) design.extra = checkedFits(JSON.parse(await unpacked(given.get("extra"))));
  const rpm = Number(given.get("rpm"));
  if (given.has("rpm") && rpm >= 0 && rpm <= 1e6) design.rpm = rpm;
  const others = most > 1 && given.has("with") ? await designsOf(given.get("with"), most - 1) : null;
  return { designs: [design, ...(others?.designs ?? [])], units };
}

/** Loads of a link: texts of fields. */
function checkedLoads(list) {
  const known = [...Object.keys(LOAD_FIELDS), "crank"];
  return list.map((each) => Object.fromEntries(known.map((name) => [name, `${each[name] ?? ""}`])));
}

async function packed(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let binary = "";
  for (const byte of bytes) binary += String.fromCharCode(byte);
  return btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

async function unpacked(text) {
  const binary = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = Uint8Array.from(binary, (each) => each.charCodeAt(0));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader();
  const chunks = [];
  let length = 0;
  for (let read = await reader.read(); !read.done; read = await reader.read()) {
    length += read.value.length;
    // A few bytes can stand for gigabytes.
    if (length > MOST_BYTES) throw new TypingError("file", "too long", `an engine’s file has at most ${MOST_BYTES} bytes`);
    chunks.push(read.value);
  }
  return new Blob(chunks).text();
}
