//! The two roots p₁ and p₂ from which all series of harmonics are made.

use crate::mechanism::slider_crank::Proportions;
use crate::numbers::double::Double;

/// Terms left out are below e to the power of minus this, relative to the sum: under half a unit in
/// the last place.
pub(super) const NEGLIGIBLE_LOG: f64 = 38.0;

/// p = a − √(a² − 1) for a = 1 + reach.
#[derive(Clone, Copy)]
pub(super) struct Root {
    /// p, rounded to within a few units in the last place.
    pub p: f64,
    /// Error of `p`, relative to it: p·(1 + correction) is exact to nearly twice the digits.
    pub correction: f64,
    /// √(a² − 1).
    pub height: f64,
}

impl Root {
    pub fn new(reach: Double) -> Self {
        let g = reach.high;
        let root = (g * (2.0 + g)).sqrt();
        let p = 1.0 / (1.0 + g + root);
        // Residual of p² − 2(1 + g)p + 1 to twice the digits, and a step of Newton's method.
        let (cross, square) = (Double::product(-2.0 * g, p), Double::product(p, p));
        let residual = Double::sum(1.0, cross.high)
            .plus(-2.0 * p)
            .plus(square.high)
            .plus(cross.low + square.low - 2.0 * reach.low * p);
        Self { p, correction: residual.high / (2.0 * root * p), height: root }
    }

    /// pⁿ: the library's power is right to half a unit, the rounding of p is taken out.
    pub fn power(&self, n: u32) -> f64 {
        self.p.powf(f64::from(n)) * (1.0 + f64::from(n) * self.correction)
    }
}

/// Offset and reaches of a slider-crank, mirrored so that `above` ≥ `below`: a negative offset
/// mirrors the motion in time.
pub(super) struct Sides {
    /// |e|/r.
    pub offset: f64,
    pub mirrored: bool,
    pub above: Double,
    pub below: Double,
}

impl Sides {
    pub fn new(proportions: &Proportions) -> Self {
        let Proportions { offset, above, below, .. } = *proportions;
        let mirrored = offset < 0.0;
        let (above, below) = if mirrored { (below, above) } else { (above, below) };
        Self { offset: offset.abs(), mirrored, above, below }
    }
}

/// p₁ ≤ p₂ and what the recurrences need of them.
pub(super) struct Roots {
    /// p₁, of the side above.
    pub first: Root,
    /// p₂, of the side below.
    pub second: Root,
    /// p₁p₂.
    pub product: f64,
    /// p₁ − p₂, which for small offsets a subtraction would lose.
    pub difference: f64,
}

impl Roots {
    pub fn new(sides: &Sides) -> Self {
        let (first, second) = (Root::new(sides.above), Root::new(sides.below));
        let rounded = Double::product(first.p, second.p);
        let correction = rounded.low + rounded.high * (first.correction + second.correction);
        let product = rounded.high + correction;
        // 2e/r = A − B = (p₁ − p₂)(1 − 1/p₁p₂)/2; near 1 this loses the difference, not the roots.
        let difference = if product < 0.5 {
            -4.0 * sides.offset * product / (1.0 - product)
        } else {
            -2.0 * sides.offset * (first.p + second.p) / (first.height + second.height)
        };
        Self { first, second, product, difference }
    }

    /// Number of terms of a series in p₂² that are not negligible.
    pub fn terms(&self) -> f64 {
        NEGLIGIBLE_LOG / (-2.0 * self.second.p.ln())
    }
}

/// Number of coefficients of a series whose products, n apart, give `terms` terms of each order.
pub(super) fn series_length(highest: u32, terms: f64) -> usize {
    highest as usize + terms.ceil() as usize + 1
}
