// Complex numbers as pairs [re, im], and unit vectors of angles in degrees.

export const DEGREE = Math.PI / 180;

/** @type {(a: number[], b: number[]) => number[]} */
export const add = ([a, b], [c, d]) => [a + c, b + d];
/** @type {(a: number[], b: number[]) => number[]} */
export const multiply = ([a, b], [c, d]) => [a * c - b * d, a * d + b * c];
/** @type {(value: number[], factor: number) => number[]} */
export const scale = ([a, b], factor) => [a * factor, b * factor];
/** @type {(value: number[]) => number} */
export const magnitude = ([a, b]) => Math.hypot(a, b);

/** e^{i·angle}, exact at multiples of 90° and as accurate at large angles as at small ones. */
export function unit(degrees) {
  const reduced = degrees % 360;
  const quarters = Math.round(reduced / 90);
  const rest = (reduced - 90 * quarters) * DEGREE;
  const cos = Math.cos(rest);
  const sin = Math.sin(rest);
  switch (((quarters % 4) + 4) % 4) {
    case 0: return [cos, sin];
    case 1: return [-sin, cos];
    case 2: return [-cos, -sin];
    default: return [sin, -cos];
  }
}

/** Degrees reduced to [0, cycle). */
export function reduced(degrees, cycle = 360) {
  const rest = degrees % cycle;
  const found = rest < 0 ? rest + cycle : rest;
  // A cycle less a rounding is a cycle.
  return found < cycle ? found : 0;
}
