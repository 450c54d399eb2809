// Exact motion of a slider-crank and of its rod, in crank radii and radians of crank angle.
//
// As in the library: the piston stands at cos θ + √(λ⁻² − (sin θ − ε)²), θ counted from the crank
// angle at which the crankpin points along the bore, λ = r/l and ε = e/r.

/** Proportions of a slider-crank from lengths in metres. */
export function proportions(crankRadius, rodLength, pinOffset) {
  const reach = rodLength - crankRadius;
  return {
    rod: rodLength / crankRadius,
    offset: pinOffset / crankRadius,
    // (l ± e − r)/r, kept because 1 − sin θ is small where the rod is barely long enough.
    above: (reach + pinOffset) / crankRadius,
    below: (reach - pinOffset) / crankRadius,
  };
}

/** Position, velocity over ω and acceleration over ω² of the piston along its bore. */
export function motion({ rod, offset, above, below }, cos, sin) {
  const height = rodHeight(above, below, cos, sin);
  const lateral = sin - offset;
  const steepness = rod / height;
  return {
    position: cos + height,
    velocity: -(lateral * cos) / height - sin,
    acceleration: (lateral * sin - steepness * steepness * cos * cos) / height - cos,
  };
}

/** First and second derivative of the rod's angle by crank angle. */
export function swing({ above, below }, cos, sin) {
  const height = rodHeight(above, below, cos, sin);
  const [toAbove, toBelow] = gaps(cos, sin);
  const bend = 0.5 * (below * toAbove * toAbove - above * toBelow * toBelow) - above * below * sin;
  return { velocity: cos / height, acceleration: bend / (height * height * height) };
}

/** Height of the rod along the bore: (λ⁻² − (sin θ − ε)²)^½ from its two factors. */
function rodHeight(above, below, cos, sin) {
  const [toAbove, toBelow] = gaps(cos, sin);
  return Math.sqrt((above + toAbove) * (below + toBelow));
}

/** 1 − sin θ and 1 + sin θ, the smaller one from cos² θ. */
function gaps(cos, sin) {
  return sin > 0
    ? [(cos * cos) / (1 + sin), 1 + sin]
    : [1 - sin, (cos * cos) / (1 - sin)];
}
