//! Harmonics of the torques that a rod's own moment of inertia makes, in closed form.
//!
//! The rod swings by φ, sin φ = (sin θ − e/r)/(l/r), with φ' = cos θ/h. Two series make its torques.
//! 1/h is `2√(p₁p₂)·G(w)·G(1/w)` with G = `((1 + p₁w)(1 − p₂w))^{−1/2}` = Σ gₖwᵏ, and cos θ shifts its
//! orders by one: order n of φ' is `2√(p₁p₂) i^{n−1} Σⱼ gⱼ(g_{j+n−1} − g_{j+n+1})`. And φ'² =
//! cos²θ/h² is rational: its partial fractions in sin θ have geometric series.

use std::f64::consts::FRAC_2_PI;

use super::spike::graded_panels;
use super::torque::{RationalPart, TorqueHarmonics};
use super::{Offset, Root, Roots, each, is_by_quadrature, series_length};
use crate::Complex64;
use crate::cancel::Cancel;
use crate::error::Result;
use crate::slider_crank::Proportions;

/// Harmonics of the torques of a rod's moment of inertia beyond that of its two masses, over it and
/// ω², as peak phasors: roll `φ''(1 + φ')`, crank `−φ''φ'`.
pub fn torque(
    proportions: &Proportions,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<TorqueHarmonics> {
    let swing = Swing::new(proportions);
    let velocities = swing.velocities(orders, cancel)?;
    let half_derivatives =
        orders.iter().map(|&n| Complex64::new(0.0, 0.5 * f64::from(n)) * swing.square(n));
    let (mut roll, mut crank) = (Vec::new(), Vec::new());
    for ((&n, velocity), half_derivative) in orders.iter().zip(velocities).zip(half_derivatives) {
        roll.push(Complex64::new(0.0, f64::from(n)) * velocity + half_derivative);
        crank.push(-half_derivative);
    }
    Ok(TorqueHarmonics { roll, crank })
}

/// Bound of what orders above `highest` can add to either torque over inertia and ω².
///
/// The binomial coefficients of (1 − x)^{−1/2} convolve to 1, so that 0 ≤ gₖ ≤ p₂ᵏ, and order n of φ'
/// is at most `2p₂ⁿ/(1 − p₂²)`; that of φ'² at most `p₂ⁿ⁻¹ r/l`. Each counts n times, the square half.
#[must_use]
pub fn tail_bound(proportions: &Proportions, highest: u32) -> Option<f64> {
    let Swing { second: Root { p, .. }, rod, .. } = Swing::new(proportions);
    let (first, gap) = (f64::from(highest + 1), 1.0 - p);
    // Σ_{n ≥ N} n pⁿ⁻¹ = p^{N−1}(N/g + p/g²)
    let sum = p.powf(first - 1.0) * (first / gap + p / (gap * gap));
    let bound = (2.0 * p / (gap * (1.0 + p)) + 0.5 / rod) * sum;
    bound.is_finite().then_some(bound)
}

/// How a rod swings: φ' and its square.
struct Swing<'a> {
    proportions: &'a Proportions,
    /// Offset over r and reaches, mirrored where the offset is negative.
    offset: Offset,
    first: Root,
    second: Root,
    rod: f64,
}

impl<'a> Swing<'a> {
    fn new(proportions: &'a Proportions) -> Self {
        let offset = Offset::new(proportions);
        let (first, second) = (Root::new(offset.above), Root::new(offset.below));
        Self { proportions, offset, first, second, rod: proportions.rod }
    }

    /// Peak phasors of φ'.
    fn velocities(&self, orders: &[u32], cancel: &Cancel) -> Result<Vec<Complex64>> {
        let Offset { size, above, below, .. } = self.offset;
        let roots = Roots::new(size, above, below);
        let count = roots.terms();
        let highest = orders.iter().copied().filter(|&n| !is_by_quadrature(n, count)).max();
        let series = highest
            .map(|highest| self.series(&roots, series_length(highest, count)))
            .unwrap_or_default();
        let magnitude = |n: u32| {
            if is_by_quadrature(n, count) {
                return self.integral(n);
            }
            // From the smallest term up.
            let terms = series.iter().zip(series.get(n as usize - 1..).unwrap_or_default());
            let sum: f64 = terms.rev().map(|((g, _), (_, step))| g * step).sum();
            2.0 * roots.product.sqrt() * sum
        };
        each(orders, cancel, |n| self.turned(n, magnitude(n)))
    }

    /// gₖ and gₖ − gₖ₊₂, k < count.
    fn series(&self, roots: &Roots, count: usize) -> Vec<(f64, f64)> {
        let (slope, product) = (roots.difference.abs(), roots.product);
        // 1 − p = p·(reach + √(a² − 1)), which the difference would lose next to 1.
        let gap = |root: &Root, reach: f64| root.p * (reach + root.height);
        let first = gap(&self.first, self.offset.above.high);
        let gap = first + self.first.p * gap(&self.second, self.offset.below.high);
        let (mut g, mut next) = (1.0, 0.5 * slope);
        let mut series = Vec::with_capacity(count);
        for k in 0..count {
            let k = k as f64;
            let step = (g * (1.0 + (k + 1.0) * gap) - slope * (k + 1.5) * next) / (k + 2.0);
            series.push((g, step));
            (g, next) = (next, (slope * (k + 1.5) * next + product * (k + 1.0) * g) / (k + 2.0));
        }
        series
    }

    /// Next to the crank that cannot turn: `(2/π)∫ sin ψ sin nψ/h dψ` over the angle from sin θ = 1,
    /// both ends in one integrand. For even n they are apart by `1/h(ψ) − 1/h(π − ψ)` =
    /// `−4e cos ψ/(h(ψ) h(π − ψ) (h(ψ) + h(π − ψ)))`, of which the sign is that of (−i)ⁿ⁻¹ to iⁿ⁻¹.
    fn integral(&self, n: u32) -> f64 {
        let Offset { size, above, below, .. } = self.offset;
        let degree = f64::from(n);
        let integral = graded_panels((2.0 * below.high).sqrt(), degree, |ψ| {
            let (half_sin, half_cos) = (0.5 * ψ).sin_cos();
            let (rise, rest) = (2.0 * half_sin * half_sin, 2.0 * half_cos * half_cos);
            let height = |near: f64, far: f64| ((near + rise) * (far + rest)).sqrt();
            let here = height(above.high, below.high);
            let there = height(below.high, above.high);
            let inverse = if n % 2 == 1 {
                1.0 / here + 1.0 / there
            } else {
                4.0 * size * ψ.cos() / (here * there * (here + there))
            };
            ψ.sin() * (degree * ψ).sin() * inverse
        });
        FRAC_2_PI * integral
    }

    /// iⁿ⁻¹ times a real magnitude; of a negative offset, φ'(−θ) of the positive one.
    fn turned(&self, n: u32, magnitude: f64) -> Complex64 {
        let imaginary = if self.offset.mirrored { -magnitude } else { magnitude };
        match n % 4 {
            0 => Complex64::new(0.0, -imaginary),
            1 => Complex64::new(magnitude, 0.0),
            2 => Complex64::new(0.0, imaginary),
            _ => Complex64::new(-magnitude, 0.0),
        }
    }

    /// Peak phasor of φ'² = (h'² + cos²θ)(r/l)², n ≥ 1: of even order
    /// `−iⁿ(√(A² − 1) p₁ⁿ + √(B² − 1) p₂ⁿ) r/l`.
    fn square(&self, n: u32) -> Complex64 {
        if n % 2 == 1 {
            return RationalPart::new(self.proportions).harmonic(n) / (self.rod * self.rod);
        }
        let part = |root: &Root| root.height * root.power(n);
        let magnitude = (part(&self.first) + part(&self.second)) / self.rod;
        Complex64::new(if n.is_multiple_of(4) { -magnitude } else { magnitude }, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_and_quadrature_meet() {
        // Where the series has 1900 terms.
        for share in [0.0, 1e-6, 0.5, -0.9] {
            let rod_ratio = 1.0 / (1.0 + 5e-5 / (1.0 - f64::abs(share)));
            let reach = Proportions::new(rod_ratio, 0.0).unwrap().above.high;
            let proportions = Proportions::new(rod_ratio, share * reach).unwrap();
            let orders: Vec<u32> = (1..40).collect();
            let swing = Swing::new(&proportions);
            for (&n, by_series) in
                orders.iter().zip(swing.velocities(&orders, &Cancel::new()).unwrap())
            {
                let by_panels = swing.turned(n, swing.integral(n));
                // A few units of order 1, which is 4/π.
                let apart = (by_series - by_panels).norm();
                assert!(apart < 1e-15, "{share} {n}: {by_series} {by_panels}");
            }
        }
    }
}
