//! Harmonics of the torques of a rod's own moment of inertia, in closed form.
//!
//! The rod swings by φ, sin φ = (sin θ − e/r)/(l/r), with φ' = cos θ/h. Two series make its torques.
//! 1/h is `2√(p₁p₂)·G(w)·G(1/w)` with G = `((1 + p₁w)(1 − p₂w))^{−1/2}` = Σ gₖwᵏ, and cos θ shifts its
//! orders by one: order n of φ' is `2√(p₁p₂) i^{n−1} Σⱼ gⱼ(g_{j+n−1} − g_{j+n+1})`. And φ'² =
//! cos²θ/h² is rational (`fractions`).

use super::fractions::Fractions;
use super::near_one;
use super::roots::{Root, Roots, Sides, series_length};
use crate::Complex64;
use crate::mechanism::slider_crank::Proportions;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;

/// Harmonics of the torques of one cylinder, as peak phasors; the function that makes them gives the unit.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TorqueHarmonics {
    /// Roll torque on the block about +z; of masses `x''·(x' + e)` in crank radii.
    pub roll: Vec<Complex64>,
    /// Inertia torque on the crank; of masses `−x''·x'`.
    pub crank: Vec<Complex64>,
}

/// Harmonics of the torques of a rod's moment of inertia beyond that of its two masses, over it and
/// ω², as peak phasors: roll `φ''(1 + φ')`, crank `−φ''φ'`.
pub fn torque(
    proportions: &Proportions,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<TorqueHarmonics> {
    orders.iter().try_for_each(|&n| Order::whole(n).map(drop))?;
    let swing = SwingHarmonics::new(proportions);
    let velocities = swing.velocities(orders, cancel)?;
    let fractions = Fractions::new(proportions);
    let rod_squared = proportions.rod * proportions.rod;
    let (mut roll, mut crank) = (Vec::new(), Vec::new());
    for (&n, velocity) in orders.iter().zip(velocities) {
        cancel.check()?;
        let square = fractions.harmonic(n) / rod_squared;
        let half_derivative = Complex64::new(0.0, 0.5 * f64::from(n)) * square;
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
    let Root { p, .. } = Root::new(Sides::new(proportions).below);
    let (first, gap) = (f64::from(highest + 1), 1.0 - p);
    // Σ_{n ≥ N} n pⁿ⁻¹ = p^{N−1}(N/g + p/g²)
    let sum = p.powf(first - 1.0) * (first / gap + p / (gap * gap));
    let bound = (2.0 * p / (gap * (1.0 + p)) + 0.5 / proportions.rod) * sum;
    bound.is_finite().then_some(bound)
}

/// Angular velocity φ' of a rod.
struct SwingHarmonics {
    sides: Sides,
    roots: Roots,
}

impl SwingHarmonics {
    fn new(proportions: &Proportions) -> Self {
        let sides = Sides::new(proportions);
        let roots = Roots::new(&sides);
        Self { sides, roots }
    }

    /// Peak phasors of φ'.
    fn velocities(&self, orders: &[u32], cancel: &Cancel) -> Result<Vec<Complex64>> {
        let terms = self.roots.terms();
        let length = series_length(0, terms);
        let summed = orders.iter().copied().filter(|&n| !near_one::is_by_quadrature(n, terms));
        let highest = summed.max();
        let series = highest.map(|highest| self.series(series_length(highest, terms)));
        let series = series.unwrap_or_default();
        let mut values = Vec::with_capacity(orders.len());
        for &n in orders {
            cancel.check()?;
            let magnitude = if near_one::is_by_quadrature(n, terms) {
                near_one::swing(&self.sides, n)
            } else {
                // From the smallest term up.
                let shifted = &series[n as usize - 1..][..length];
                let products = series[..length].iter().zip(shifted);
                let sum: f64 = products.rev().map(|((g, _), (_, step))| g * step).sum();
                2.0 * self.roots.product.sqrt() * sum
            };
            values.push(self.turned(n, magnitude));
        }
        Ok(values)
    }

    /// gₖ and gₖ − gₖ₊₂, k < count.
    fn series(&self, count: usize) -> Vec<(f64, f64)> {
        let Roots { first, second, product, difference } = &self.roots;
        let slope = difference.abs();
        // 1 − p = p·(reach + √(a² − 1)), which a subtraction would lose next to 1.
        let gap = |root: &Root, reach: f64| root.p * (reach + root.height);
        let gap_of_product =
            gap(first, self.sides.above.high) + first.p * gap(second, self.sides.below.high);
        let (mut g, mut next) = (1.0, 0.5 * slope);
        let mut series = Vec::with_capacity(count);
        for k in 0..count {
            let k = k as f64;
            let step =
                (g * (1.0 + (k + 1.0) * gap_of_product) - slope * (k + 1.5) * next) / (k + 2.0);
            series.push((g, step));
            (g, next) = (next, (slope * (k + 1.5) * next + product * (k + 1.0) * g) / (k + 2.0));
        }
        series
    }

    /// iⁿ⁻¹ times a real magnitude; of a negative offset, φ'(−θ) of the positive one.
    fn turned(&self, n: u32, magnitude: f64) -> Complex64 {
        let imaginary = if self.sides.mirrored { -magnitude } else { magnitude };
        match n % 4 {
            0 => Complex64::new(0.0, -imaginary),
            1 => Complex64::new(magnitude, 0.0),
            2 => Complex64::new(0.0, imaginary),
            _ => Complex64::new(-magnitude, 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sweeps bound every order by that of the largest rod ratio, up to 0.9.
    #[test]
    fn orders_without_offset_grow_with_the_rod_ratio() {
        let orders: Vec<u32> = (1..=16).collect();
        let sizes = |ratio: f64| {
            let proportions = Proportions::new(ratio, 0.0).unwrap();
            let TorqueHarmonics { roll, crank } =
                torque(&proportions, &orders, &Cancel::new()).unwrap();
            [roll, crank].concat().into_iter().map(Complex64::norm).collect::<Vec<_>>()
        };
        let mut last = sizes(0.01);
        for percent in 2..=90 {
            let next = sizes(f64::from(percent) / 100.0);
            for (next, last) in next.iter().zip(&last) {
                assert!(next >= last, "{percent} {last} {next}");
            }
            last = next;
        }
        // Order 2 is largest at λ = 0.910: q = √2 − 1.
        assert!(sizes(0.92)[1] > sizes(0.95)[1]);
    }

    #[test]
    fn series_and_quadrature_meet() {
        // Where the series has 1900 terms.
        for share in [0.0, 1e-6, 0.5, -0.9] {
            let rod_ratio = 1.0 / (1.0 + 5e-5 / (1.0 - f64::abs(share)));
            let reach = Proportions::new(rod_ratio, 0.0).unwrap().above.high;
            let proportions = Proportions::new(rod_ratio, share * reach).unwrap();
            let orders: Vec<u32> = (1..40).collect();
            let swing = SwingHarmonics::new(&proportions);
            for (&n, by_series) in
                orders.iter().zip(swing.velocities(&orders, &Cancel::new()).unwrap())
            {
                let by_panels = near_one::swing(&swing.sides, n);
                let by_panels = swing.turned(n, by_panels);
                // A few units of order 1, which is 4/π.
                let apart = (by_series - by_panels).norm();
                assert!(apart < 1e-15, "{share} {n}: {by_series} {by_panels}");
            }
        }
    }
}
