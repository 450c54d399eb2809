// Linear algebra of six unknowns: singular values and complex equations, of any matrix.

/** Unknowns. */
export const SIX = 6;

/** Singular value over the largest, for each entry of the matrix, that rounding makes of zero. */
const RANK_ROUNDING = 4 * Number.EPSILON;

/** Cosine of two columns below which they are at right angles. */
const SQUARE = 1e-15;

/** Sweeps over all pairs of columns; a dozen suffice. */
const MOST_SWEEPS = 60;

/** Least over largest pivot of equations that have an answer. */
const LEAST_PIVOT = 1e-14;

/**
 * Singular values, ascending, of a matrix of six columns, and their right vectors, by Jacobi's rotations of its
 * columns: small values have as many digits as large ones. Those of rounding are exactly zero.
 */
export function singular(rows) {
  const columns = Array.from({ length: SIX }, (_, j) => Float64Array.from(rows, (row) => row[j]));
  const turned = Array.from({ length: SIX }, (_, j) => Float64Array.from({ length: SIX }, (_, i) => Number(i === j)));
  const dot = (a, b) => a.reduce((sum, value, k) => sum + value * b[k], 0);
  const rotate = (a, b, cos, sin) => {
    for (let k = 0; k < a.length; k++) [a[k], b[k]] = [cos * a[k] - sin * b[k], sin * a[k] + cos * b[k]];
  };
  let rotated = true;
  for (let sweep = 0; rotated && sweep < MOST_SWEEPS; sweep++) {
    rotated = false;
    for (let i = 0; i < SIX - 1; i++) {
      for (let j = i + 1; j < SIX; j++) {
        const [a, b, between] = [dot(columns[i], columns[i]), dot(columns[j], columns[j]), dot(columns[i], columns[j])];
        if (Math.abs(between) <= SQUARE * Math.sqrt(a) * Math.sqrt(b)) continue;
        rotated = true;
        const zeta = (b - a) / (2 * between);
        const tan = (zeta < 0 ? -1 : 1) / (Math.abs(zeta) + Math.hypot(1, zeta));
        const cos = 1 / Math.hypot(1, tan);
        rotate(columns[i], columns[j], cos, cos * tan);
        rotate(turned[i], turned[j], cos, cos * tan);
      }
    }
  }
  const pairs = columns.map((column, j) => ({ value: Math.sqrt(dot(column, column)), vector: [...turned[j]] }));
  pairs.sort((a, b) => a.value - b.value);
  const least = RANK_ROUNDING * rows.length * SIX * pairs[SIX - 1].value;
  return pairs.map(({ value, vector }) => ({ value: value > least ? value : 0, vector }));
}

/**
 * The answer of six complex equations, re and im of the matrix row by row and of the right side, which it replaces;
 * false where there is none.
 */
export function solveComplex(re, im, x, y) {
  let [most, least] = [0, Infinity];
  for (let k = 0; k < SIX; k++) {
    let pivot = k;
    let square = -1;
    for (let i = k; i < SIX; i++) {
      const here = re[i * SIX + k] ** 2 + im[i * SIX + k] ** 2;
      if (here > square) [pivot, square] = [i, here];
    }
    most = Math.max(most, square);
    least = Math.min(least, square);
    if (!(least > LEAST_PIVOT ** 2 * most)) return false;
    if (pivot !== k) {
      for (let j = k; j < SIX; j++) exchange(re, im, k * SIX + j, pivot * SIX + j);
      exchange(x, y, k, pivot);
    }
    const a = re[k * SIX + k] / square;
    const b = -im[k * SIX + k] / square;
    for (let i = k + 1; i < SIX; i++) {
      const p = re[i * SIX + k];
      const q = im[i * SIX + k];
      const c = p * a - q * b;
      const d = p * b + q * a;
      for (let j = k + 1; j < SIX; j++) {
        const u = re[k * SIX + j];
        const v = im[k * SIX + j];
        re[i * SIX + j] -= c * u - d * v;
        im[i * SIX + j] -= c * v + d * u;
      }
      x[i] -= c * x[k] - d * y[k];
      y[i] -= c * y[k] + d * x[k];
    }
  }
  for (let k = SIX - 1; k >= 0; k--) {
    let sum = x[k];
    let rest = y[k];
    for (let j = k + 1; j < SIX; j++) {
      const u = re[k * SIX + j];
      const v = im[k * SIX + j];
      sum -= u * x[j] - v * y[j];
      rest -= u * y[j] + v * x[j];
    }
    const p = re[k * SIX + k];
    const q = im[k * SIX + k];
    const square = p * p + q * q;
    x[k] = (sum * p + rest * q) / square;
    y[k] = (rest * p - sum * q) / square;
  }
  return true;
}

function exchange(a, b, i, j) {
  const [c, d] = [a[i], b[i]];
  a[i] = a[j];
  b[i] = b[j];
  a[j] = c;
  b[j] = d;
}

/** Product of a matrix, of rows, and a vector. */
export const applied = (matrix, vector) =>
  matrix.map((row) => row.reduce((sum, value, k) => sum + value * vector[k], 0));
