//! Harmonics of the inertia force of any slider-crank, and what the orders left out can add.

use super::centred::{ALL_DIGITS, Centred};
use super::offset;
use super::roots::{Roots, Sides};
use crate::Complex64;
use crate::mechanism::slider_crank::Proportions;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;

/// `aₙ` of the given orders: force along the bore over m·r·ω², as peak phasors.
pub fn coefficients(
    proportions: &Proportions,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<Vec<Complex64>> {
    orders.iter().try_for_each(|&n| Order::whole(n).map(drop))?;
    unchecked(proportions, orders, cancel)
}

/// [`coefficients`] of orders from 1 on, those above the highest that a caller may ask for included.
pub(super) fn unchecked(
    proportions: &Proportions,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<Vec<Complex64>> {
    if proportions.offset != 0.0 {
        return offset::coefficients(&Sides::new(proportions), orders, cancel);
    }
    let centred = Centred::new(proportions);
    let mut values = Vec::with_capacity(orders.len());
    for &n in orders {
        cancel.check()?;
        values.push(Complex64::new(centred.coefficient(n, ALL_DIGITS), 0.0));
    }
    Ok(values)
}

/// Bound of `Σ_{n > highest} |aₙ|`, what orders above `highest` can add to a force over m·r·ω².
///
/// |hₖ| ≤ p₂ᵏ: by the generating function (2 − √(1 − x))² the binomial coefficients of the two
/// roots convolve to 1 at most. Hence `|aₙ| ≤ n² p₂ⁿ / (√(p₁p₂) (1 − p₂²))`, summed as the second
/// derivative of a geometric series. `None` where p₂ is so near 1 that it overflows.
#[must_use]
pub fn tail_bound(proportions: &Proportions, highest: u32) -> Option<f64> {
    let Roots { second, product, .. } = Roots::new(&Sides::new(proportions));
    let p = second.p;
    let first = f64::from(highest + 1);
    let gap = 1.0 - p;
    // Σ_{n ≥ N} n² pⁿ = p^N (N²/g + 2Np/g² + p(1 + p)/g³), g = 1 − p.
    let sum = p.powf(first)
        * (first * first / gap + 2.0 * first * p / (gap * gap) + p * (1.0 + p) / gap.powi(3));
    let bound = sum / (product.sqrt() * (1.0 - p * p));
    bound.is_finite().then_some(bound)
}
