// Numbers as people type them: with a unit, or in that of the setting. The units are the library's table.

import { UNITS } from "./tables.mjs";

const WRITTEN = /^([-+−]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*(\D.*)?$/iu;

/** A fraction, or a whole number and one, as rules in inches have them. */
const FRACTION = /^([-+−]?)(?:(\d+)(?:\s+|\s*-\s*))?(\d+)\/(\d*[1-9]\d*)(?:\s*([^\d\s/].*))?$/u;

/** Decimals of a fraction that is none of ten: more than a double has. */
const DECIMALS = 40n;

/** A comma that stands for the decimal point, behind a whole number and before digits and a unit alone. */
const DECIMAL_COMMA = /^([-+−]?\d+),(\d+)(?!.*\d)/u;

/** What is wrong with something typed: the library's errors have the same parts. */
export class TypingError extends Error {
  constructor(argument, value, hint) {
    super(`${argument} = "${value}": ${hint}`);
    Object.assign(this, { argument, value, hint });
  }
}

/** A decimal number as a whole one and a power of ten: exact, as Python's. */
function decimal(text) {
  const [mantissa, exponent = "0"] = text.toLowerCase().replace("−", "-").split("e");
  const [whole, part = ""] = mantissa.split(".");
  return { digits: BigInt(`${whole}${part}`.replace("+", "")), power: Number(exponent) - part.length };
}

/** What was typed as a decimal number and the word behind it; null of no number. */
function parsed(text) {
  // ½ is 1⁄2, and 3½ has a whole number before it.
  const spelt = text.replace(/[¼-¾⅐-⅞]/gu, (sign) => ` ${sign.normalize("NFKC")}`).replace("⁄", "/").trim();
  const [, sign, whole = "0", above, below, behind] = FRACTION.exec(spelt) ?? [];
  if (above) {
    const [a, b] = [BigInt(above), BigInt(below)];
    const digits = ((BigInt(whole) * b + a) * 10n ** DECIMALS) / b;
    return { digits: /[-−]/u.test(sign) ? -digits : digits, power: -Number(DECIMALS), word: behind?.trim() };
  }
  const parts = WRITTEN.exec(text.replace(DECIMAL_COMMA, "$1.$2"));
  return parts && { ...decimal(parts[1]), word: parts[2]?.trim() };
}

/** The factor of a unit to that of the library, as a decimal text; undefined for one of another kind. */
export function factorOf(word, unit) {
  const known = UNITS.typed[unit] ?? {};
  if (Object.hasOwn(known, word)) return known[word];
  const lower = word.toLowerCase();
  return Object.hasOwn(known, lower) ? known[lower] : undefined;
}

/**
 * The number of a text in the library's unit: "3.5 in" is 0.0889 m. `plain` is the unit of a number without one.
 *
 * The product of decimals is exact before it becomes a double, so that it is the very one that the library reads.
 */
export function quantity(text, unit, plain, argument = "value") {
  const number = parsed(text.trim());
  const wrong = (hint) => new TypingError(argument, text.trim(), hint);
  const units = UNITS.hints[unit];
  if (!number) throw wrong(units ? `give a number, such as 12 or with a unit (${units})` : "give a number");
  const word = number.word || plain;
  const factor = word ? factorOf(word, unit) : "1";
  if (factor === undefined) {
    throw wrong(units ? `give a number with a unit of this kind (${units})` : "give a number without a unit");
  }
  const { digits, power } = decimal(factor);
  const value = Number(`${number.digits * digits}e${number.power + power}`);
  if (!Number.isFinite(value)) throw wrong("give a finite number");
  return value;
}

/** What was typed with its unit: what a plain number means does not change with the setting. */
export function withUnit(text, unit, plain) {
  const typed = text.trim();
  return plain && parsed(typed)?.word === undefined && parsed(typed) ? `${typed} ${plain}` : typed;
}
