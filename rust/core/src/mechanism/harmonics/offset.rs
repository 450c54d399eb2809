//! Harmonics of the force with an offset: all orders, the odd ones as sines.

use super::near_one;
use super::roots::{Roots, Sides, series_length};
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;

/// `aₙ` of the given orders of a slider-crank with an offset.
pub(super) fn coefficients(
    sides: &Sides,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<Vec<Complex64>> {
    let roots = Roots::new(sides);
    let terms = roots.terms();
    let length = series_length(0, terms);
    let summed = orders.iter().copied().filter(|&n| !near_one::is_by_quadrature(n, terms));
    let highest = summed.max();
    let series = highest.map(|highest| series(&roots, series_length(highest, terms)));
    let series = series.unwrap_or_default();
    let mut values = Vec::with_capacity(orders.len());
    for &n in orders {
        cancel.check()?;
        let magnitude = if near_one::is_by_quadrature(n, terms) {
            near_one::force(sides, n)
        } else {
            // From the smallest term up.
            let tail: f64 = (1..length).rev().map(|j| series[j] * series[j + n as usize]).sum();
            f64::from(n).powi(2) / roots.product.sqrt() * (series[n as usize] + tail)
        };
        values.push(turned(sides, n, magnitude));
    }
    Ok(values)
}

/// iⁿ times a real magnitude, mirrored in time where the offset is negative, plus the crank.
fn turned(sides: &Sides, n: u32, magnitude: f64) -> Complex64 {
    let imaginary = if sides.mirrored { -magnitude } else { magnitude };
    match n % 4 {
        0 => Complex64::new(magnitude, 0.0),
        1 => Complex64::new(if n == 1 { 1.0 } else { 0.0 }, imaginary),
        2 => Complex64::new(-magnitude, 0.0),
        _ => Complex64::new(0.0, -imaginary),
    }
}

/// h₀ … h_{count − 1} of √((1 + p₁w)(1 − p₂w)): all below zero from h₁ on, since p₁ ≤ p₂, so that
/// the recurrence adds terms of one sign.
fn series(roots: &Roots, count: usize) -> Vec<f64> {
    let mut h = Vec::with_capacity(count.max(2));
    h.extend([1.0, 0.5 * roots.difference]);
    for k in 1..count.saturating_sub(1) {
        let x = k as f64;
        let next = roots.difference * (0.5 - x) * h[k] + roots.product * (x - 2.0) * h[k - 1];
        h.push(next / (x + 1.0));
    }
    h
}
