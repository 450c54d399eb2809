// Harmonics aₙ of a slider-crank's inertia force in closed form.
//
// √((l² − (r sin θ − e)²)/r²) = h(w)·h(1/w)/(2√(p₁p₂)) with h = √((1 + p₁w)(1 − p₂w)) and w = i·e^{iθ}: one
// real recurrence has the coefficients of h, and order n is a sum of products n apart. It serves any
// offset and any rod ratio that leaves p₂ below 1 (134 terms at λ = 0.99).

/** Terms left out are below e to the power of minus this, relative to the sum. */
const NEGLIGIBLE_LOG = 38;

/** a₁ … a_highest as complex pairs: force along the bore over m·r·ω², as peak phasors. */
export function harmonics({ offset, above, below }, highest) {
  // A negative offset is the positive one mirrored in time.
  const [larger, smaller] = offset < 0 ? [below, above] : [above, below];
  const [p1, root1] = rootOf(larger);
  const [p2, root2] = rootOf(smaller);
  const product = p1 * p2;
  const slope = (-2 * Math.abs(offset) * (p1 + p2)) / (root1 + root2);
  const terms = Math.ceil(NEGLIGIBLE_LOG / (-2 * Math.log(p2))) + 1;
  const h = coefficients(slope, product, highest + terms);
  const values = [];
  for (let n = 1; n <= highest; n++) {
    let sum = 0;
    for (let j = terms - 1; j > 0; j--) sum += h[j] * h[j + n];
    values.push(turned(n, ((n * n) / Math.sqrt(product)) * (h[n] + sum), offset < 0));
  }
  return values;
}

/** p = a − √(a² − 1) and √(a² − 1) for a = 1 + reach. */
function rootOf(reach) {
  const root = Math.sqrt(reach * (2 + reach));
  return [1 / (1 + reach + root), root];
}

/** h₀ … h_{count − 1} of √((1 + p₁w)(1 − p₂w)). */
function coefficients(slope, product, count) {
  const h = [1, 0.5 * slope];
  for (let k = 1; k < count - 1; k++) {
    h.push((slope * (0.5 - k) * h[k] + product * (k - 2) * h[k - 1]) / (k + 1));
  }
  return h;
}

/** iⁿ times a real magnitude, plus the crank's own part at order 1. */
function turned(n, size, mirrored) {
  const odd = mirrored ? -size : size;
  switch (n % 4) {
    case 0: return [size, 0];
    case 1: return [n === 1 ? 1 : 0, odd];
    case 2: return [-size, 0];
    default: return [0, -odd];
  }
}
