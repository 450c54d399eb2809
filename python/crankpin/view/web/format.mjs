// Readable numbers: units that fit a quantity's largest value, and digits that do not jump.

/** Significant digits of the largest value. */
const DIGITS = 4;

/** @type {[number, string][]} */
const PREFIXES = [[1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];

/** A way of writing values up to `largest`: text without the unit, and the unit, prefixed if it has no factor. */
export function scaleFor(largest, unit) {
  const [name, own] = [unit].flat();
  // Thousands from ten thousand on: 9999 N reads better than 9.999 kN.
  const [factor, prefix] = own ? [1 / own, ""] : largest > 0
    ? PREFIXES.find(([size]) => largest >= (size > 1 ? 10 * size : size)) ?? PREFIXES.at(-1)
    : [1, ""];
  const places = largest > 0 ? DIGITS - 1 - Math.floor(Math.log10(largest / factor)) : 0;
  const decimals = Math.min(Math.max(places, 0), 9);
  return { unit: `${prefix}${name}`, text: (value) => signed((value / factor).toFixed(decimals)) };
}

/** A way of writing values from `low` to `high` in a unit, with three digits of what they differ by. */
export function betweenScale(low, high, unit) {
  const decimals = high > low ? Math.min(Math.max(2 - Math.floor(Math.log10(high - low)), 0), 9) : 0;
  return { unit, text: (value) => value.toFixed(decimals) };
}

/** A number with this many decimals at most. */
export function short(value, decimals) {
  return signed(String(Number(value.toFixed(decimals))));
}

/** A unit with a factor from SI, of fields and of texts that show `least`, in SI: what is shown, and what is typed. */
export function fieldUnit([name, factor], least) {
  const decimals = Math.max(0, Math.ceil(-Math.log10(least * factor)));
  const shown = (value) => Number((value * factor).toPrecision(7)); // as a field has room
  return {
    name, shown, whole: (value) => Math.round(shown(value)), step: roundBelow(15 * least * factor), text: (value) => short(shown(value), decimals),
    // Without the digits that rounding adds.
    taken: (typed) => Number((typed / factor).toPrecision(12)),
  };
}

/** A true minus sign, and none before a zero. */
export function signed(text) {
  return text.replace(/^-(?=[0.]*$)/, "").replace("-", "−");
}

/** The largest of 1, 2 and 5 times a power of ten that is not above a value. */
export function roundBelow(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].find((step) => step * power <= value * (1 + 1e-12)) * power;
}
