//! Harmonics of the force without offset: a power series in p⁴.

use super::near_one;
use super::roots::{NEGLIGIBLE_LOG, Root, Sides};
use crate::mechanism::slider_crank::Proportions;
use crate::numbers::double::Double;

/// The tolerance that leaves out nothing but what is lost to rounding anyway.
pub(super) const ALL_DIGITS: f64 = 0.0;

/// Ratio of term j + 1 to term j.
#[inline(always)]
pub(super) fn next_term(j: f64, m: f64) -> f64 {
    ((j - 0.5) * (j + m - 0.5)) / ((j + 1.0) * (j + m + 1.0))
}

/// Part of `1 − Σⱼ |b_j| b_{j+m}/b_m p^{4j}` that may be left out within a relative tolerance.
///
/// That difference falls with p; at p = 1, where the height of the rod is |cos φ|, it is
/// `(4/π)/((4m² − 1)|b_m|)`, and √m times that rises from 0.849 at m = 1.
pub(super) fn may_be_missing(n: u32, rtol: f64) -> f64 {
    0.8 * rtol / (0.5 * f64::from(n)).sqrt()
}

/// `(−1)^{m+1} n² |b_m|`, n = 2m.
pub(super) fn leading(n: u32) -> f64 {
    let m = n / 2;
    let mut b = 0.5;
    for k in 1..m {
        b *= (f64::from(k) - 0.5) / f64::from(k + 1);
    }
    let sign = if m % 2 == 1 { 1.0 } else { -1.0 };
    sign * f64::from(n).powi(2) * b
}

/// A slider-crank without offset: p₁ = p₂ = p, odd orders vanish, even ones are
/// `±n²|b_m| p^{n−1} (1 − Σⱼ |b_j| b_{j+m}/b_m p^{4j})`.
pub(super) struct Centred {
    root: Root,
    sides: Sides,
    /// p⁴.
    fourth: Double,
}

impl Centred {
    pub fn new(proportions: &Proportions) -> Self {
        let root = Root::new(proportions.above);
        let square = Double::product(root.p, root.p);
        let fourth = Double::product(square.high, square.high);
        let rest = 2.0 * square.high * square.low + 4.0 * root.correction * fourth.high;
        let fourth = Double::sum(fourth.high, fourth.low + rest);
        Self { root, sides: Sides::new(proportions), fourth }
    }

    /// Order n within a relative tolerance, or to all digits.
    pub fn coefficient(&self, n: u32, rtol: f64) -> f64 {
        if n % 2 == 1 {
            return if n == 1 { 1.0 } else { 0.0 };
        }
        // The terms fall faster than p⁴ⁱ, so that the sum of those after one is below it over 1 − p⁴.
        let last = may_be_missing(n, rtol) * (1.0 - self.fourth.high);
        let digits = NEGLIGIBLE_LOG.min(-last.ln());
        let terms = (digits / -self.fourth.high.ln()).ceil();
        if near_one::is_by_quadrature(n, terms) {
            let magnitude = near_one::force(&self.sides, n);
            return if n.is_multiple_of(4) { magnitude } else { -magnitude };
        }
        let rest = near_one::long_series(self.fourth, n, terms, last)
            .unwrap_or_else(|| self.series(n, last));
        leading(n) * self.root.power(n - 1) * rest
    }

    /// `1 − Σⱼ |b_j| b_{j+m}/b_m p^{4j}` of the terms above `last`.
    fn series(&self, n: u32, last: f64) -> f64 {
        let m = f64::from(n / 2);
        let mut term = 0.5 * (m - 0.5) / (m + 1.0) * self.fourth.high;
        let mut sum = 0.0;
        let mut j = 1.0;
        while term > last.max(sum * f64::EPSILON / 16.0) {
            sum += term;
            term *= next_term(j, m) * self.fourth.high;
            j += 1.0;
        }
        1.0 - sum
    }
}
