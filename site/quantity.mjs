// Numbers as people type them: with a unit, or in that of the setting. The units are the library's table.

import { UNITS } from "./tables.mjs";

const WRITTEN = /^([-+−]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*(\D.*)?$/iu;

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
  const typed = text.trim().replace(DECIMAL_COMMA, "$1.$2");
  const parts = WRITTEN.exec(typed);
  const wrong = (hint) => new TypingError(argument, text.trim(), hint);
  const units = UNITS.hints[unit];
  if (!parts) throw wrong(units ? `give a number, such as 12 or with a unit (${units})` : "give a number");
  const word = parts[2]?.trim() || plain;
  const factor = word ? factorOf(word, unit) : "1";
  if (factor === undefined) {
    throw wrong(units ? `give a number with a unit of this kind (${units})` : "give a number without a unit");
  }
  const [a, b] = [decimal(parts[1]), decimal(factor)];
  const value = Number(`${a.digits * b.digits}e${a.power + b.power}`);
  if (!Number.isFinite(value)) throw wrong("give a finite number");
  return value;
}

/** What was typed with its unit: what a plain number means does not change with the setting. */
export function withUnit(text, unit, plain) {
  const typed = text.trim();
  return typed && plain && WRITTEN.exec(typed.replace(DECIMAL_COMMA, "$1.$2"))?.[2] === undefined
    && WRITTEN.test(typed.replace(DECIMAL_COMMA, "$1.$2")) ? `${typed} ${plain}` : typed;
}
