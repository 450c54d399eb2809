//! Harmonics near λ = 1, next to the crank that cannot turn, where a plain series is too long.
//!
//! Every threshold for that is here, and nowhere else: callers pass the number of terms that their
//! series would take.
//!
//! With more than a hundred terms a series is summed in numbers of twice the digits. With thousands
//! of terms quadrature replaces it: near the crank that cannot turn the acceleration is a spike as
//! narrow as √(2·reach) at both ends, and the number of panels, which halve towards it, grows only with
//! the logarithm of its width.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};
use std::sync::LazyLock;

use super::roots::Sides;
use crate::numbers::double::Double;
use crate::numbers::quadrature::gauss_legendre;

/// Rod ratios up to here take at most 68 terms, whose roundings are a few units in the last place.
const LARGEST_PLAIN_RATIO: f64 = 0.99;
/// With more terms than this their roundings would exceed a few units in the last place.
const LONGEST_PLAIN_SERIES: f64 = 100.0;
/// A series this long costs as much as the quadrature that replaces it.
const LONGEST_SERIES: f64 = 2000.0;
/// Fewer terms than this times the order are summed all the same: the coefficient has decayed below
/// the rounding of the spike, which limits the quadrature.
const SERIES_TERMS_PER_ORDER: f64 = 4.0;

/// True if a table must compute this rod ratio by itself, not side by side with others.
#[inline(always)]
pub(super) fn is_near(rod_ratio: f64) -> bool {
    rod_ratio > LARGEST_PLAIN_RATIO
}

/// True if order n needs this number of `terms` of a series, so that [`force`] and [`swing`] replace it.
pub(super) fn is_by_quadrature(n: u32, terms: f64) -> bool {
    terms > LONGEST_SERIES && terms > SERIES_TERMS_PER_ORDER * f64::from(n)
}

/// Order n of the force over m·r·ω², less its factor iⁿ, by quadrature.
///
/// Exact relative to the area of the spike. Odd orders are what the spikes at the two ends do not
/// cancel, of the size of n² times the offset: where that is small, both ends are in one integrand.
pub(super) fn force(sides: &Sides, n: u32) -> f64 {
    // The integrals are over the angle from sin θ = 1: (−i)ⁿ for iⁿ.
    if n.is_multiple_of(2) {
        spikes(sides, n)
    } else if f64::from(n).powi(2) * sides.offset < 1.0 {
        -difference_of_spikes(sides, n)
    } else {
        -spikes(sides, n)
    }
}

/// Order n of φ', the swing of the rod, less its factor iⁿ⁻¹, by quadrature.
///
/// `(2/π)∫ sin ψ sin nψ/h dψ` over the angle from sin θ = 1, both ends in one integrand. For even n
/// they differ by `1/h(ψ) − 1/h(π − ψ)` = `−4e cos ψ/(h(ψ) h(π − ψ) (h(ψ) + h(π − ψ)))`, whose sign
/// is that of (−i)ⁿ⁻¹ to iⁿ⁻¹.
pub(super) fn swing(sides: &Sides, n: u32) -> f64 {
    let degree = f64::from(n);
    let integral = graded_panels((2.0 * sides.below.high).sqrt(), degree, |ψ| {
        let (here, there) = heights(sides, ψ);
        let inverse = if n % 2 == 1 {
            1.0 / here + 1.0 / there
        } else {
            4.0 * sides.offset * ψ.cos() / (here * there * (here + there))
        };
        ψ.sin() * (degree * ψ).sin() * inverse
    });
    FRAC_2_PI * integral
}

/// `1 − Σⱼ |b_j| b_{j+m}/b_m p^{4j}` of the terms above `last`, n = 2m, in numbers of twice the
/// digits, if `terms` are enough for the sum to near 1 and their roundings to add up.
pub(super) fn long_series(fourth: Double, n: u32, terms: f64, last: f64) -> Option<f64> {
    if terms <= LONGEST_PLAIN_SERIES {
        return None;
    }
    let m = f64::from(n / 2);
    let first = Double { high: 0.5 * (m - 0.5), low: 0.0 };
    let mut term = first.over(m + 1.0).times(fourth);
    let mut sum = Double { high: 0.0, low: 0.0 };
    let mut j = 1.0;
    while term.high > last.max(sum.high * f64::EPSILON / 16.0) {
        sum = sum.plus(term.high);
        sum.low += term.low;
        // Both products are whole numbers over 4, hence exact.
        let ratio = Double { high: (j - 0.5) * (j + m - 0.5), low: 0.0 };
        term = term.times(ratio.over((j + 1.0) * (j + m + 1.0))).times(fourth);
        j += 1.0;
    }
    Some(Double::sum(1.0, -sum.high).plus(-sum.low).high)
}

/// `(2/π)∫₀^π −h''(φ) cos nφ dφ` with φ the crank angle from sin θ = 1, each end by itself.
fn spikes(sides: &Sides, n: u32) -> f64 {
    let (above, below, offset) = (sides.above.high, sides.below.high, sides.offset);
    let far_sign = if n % 2 == 1 { -1.0 } else { 1.0 };
    let rod = 1.0 + 0.5 * (above + below);
    let half = |near: f64, far: f64, offset: f64| {
        graded_panels((2.0 * near).sqrt(), f64::from(n), |φ| {
            let (sin, cos) = φ.sin_cos();
            let (half_sin, half_cos) = (0.5 * φ).sin_cos();
            let height_squared =
                (near + 2.0 * half_sin * half_sin) * (far + 2.0 * half_cos * half_cos);
            let lateral = cos - offset;
            let curvature = rod * rod * sin * sin / height_squared - lateral * cos;
            curvature / height_squared.sqrt() * (f64::from(n) * φ).cos()
        })
    };
    (half(above, below, offset) + far_sign * half(below, above, -offset)) * 2.0 / PI
}

/// [`spikes`] for odd n by parts, n² `(2/π)∫ h cos nφ`, with both ends in one integrand: h(φ) −
/// h(π − φ) = 4 e cos φ/(h(φ) + h(π − φ)), which has the offset as a factor.
fn difference_of_spikes(sides: &Sides, n: u32) -> f64 {
    let degree = f64::from(n);
    let integral = graded_panels((2.0 * sides.below.high).sqrt(), degree, |φ| {
        let (here, there) = heights(sides, φ);
        φ.cos() * (degree * φ).cos() / (here + there)
    });
    degree * degree * sides.offset * integral * 8.0 / PI
}

/// Height of the rod over r at an angle from sin θ = 1, and as far from sin θ = −1.
fn heights(sides: &Sides, angle: f64) -> (f64, f64) {
    let (half_sin, half_cos) = (0.5 * angle).sin_cos();
    let (rise, rest) = (2.0 * half_sin * half_sin, 2.0 * half_cos * half_cos);
    let height = |near: f64, far: f64| ((near + rise) * (far + rest)).sqrt();
    let (above, below) = (sides.above.high, sides.below.high);
    (height(above, below), height(below, above))
}

/// Integral over [0, π/2] of a function with a spike of this width at 0 and waves of order n.
fn graded_panels(width: f64, n: f64, f: impl Fn(f64) -> f64) -> f64 {
    /// Radians of a wave that one panel of [`GAUSS`] resolves to rounding.
    const WAVE_PER_PANEL: f64 = 4.0;
    let mut edges = vec![FRAC_PI_2];
    while edges[edges.len() - 1] > 0.5 * width {
        edges.push(0.5 * edges[edges.len() - 1]);
    }
    edges.push(0.0);
    let mut sum = 0.0;
    // From the spike outwards.
    for pair in edges.windows(2).rev() {
        let parts = (n * (pair[0] - pair[1]) / WAVE_PER_PANEL).ceil().max(1.0);
        let half = 0.5 * (pair[0] - pair[1]) / parts;
        for part in 0..parts as usize {
            let middle = pair[1] + half * (2 * part + 1) as f64;
            sum += GAUSS.iter().map(|&(x, w)| w * f(half.mul_add(x, middle))).sum::<f64>() * half;
        }
    }
    sum
}

/// The 20-point rule on [−1, 1].
static GAUSS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| gauss_legendre(20));

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ cos nφ/(w² + φ²): between 0 and π/2 by the exponential of a wide range, and its spike.
    #[test]
    fn panels_follow_spike_and_waves_and_no_more() {
        for exponent in 0..30 {
            let width = 0.5_f64.powi(exponent);
            for n in [0.0, 1.0, 30.0, 1000.0] {
                let calls = std::cell::Cell::new(0);
                // w/(w² + φ²) is the slope of arctan(φ/w), n cos nφ that of sin nφ.
                let integral = graded_panels(width, n, |φ| {
                    calls.set(calls.get() + 1);
                    width / (width * width + φ * φ) + n * (n * φ).cos()
                });
                let exact = (FRAC_PI_2 / width).atan() + (n * FRAC_PI_2).sin();
                // Twenty nodes to a panel: 1e-15 of its size, waves of n included.
                assert!(
                    (integral - exact).abs() < 1e-14 * (1.0 + n),
                    "{width} {n}: {integral} {exact}"
                );
                // One panel for each halving, and one for each four radians of waves.
                let halvings = (PI / width).log2().ceil() + 1.0;
                let most = 20.0 * (halvings + n * FRAC_PI_2 / 4.0);
                assert!(
                    f64::from(calls.get()) <= most + 20.0,
                    "{width} {n}: {} {most}",
                    calls.get()
                );
            }
        }
    }
}
