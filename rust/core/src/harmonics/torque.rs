//! Harmonics of the torques that one cylinder's inertia force makes, in closed form.

use super::{Offset, Roots, coefficients, rod};
use crate::Complex64;
use crate::cancel::Cancel;
use crate::error::{Error, Result};
use crate::slider_crank::{Cylinder, Proportions};

/// Harmonics of the torques that the inertia force makes, over m·r²·ω², as peak phasors.
#[derive(Debug, Clone, PartialEq)]
pub struct TorqueHarmonics {
    /// Roll torque on the block about +z: `x''·(x' + e)` in crank radii.
    pub roll: Vec<Complex64>,
    /// Inertia torque on the crank: `−x''·x'`.
    pub crank: Vec<Complex64>,
}

/// Torque harmonics of the given orders, in closed form.
///
/// `x'' x'` is half the derivative of `x'²`. With `x' = h' − sin θ`, `x'² = sin²θ − 2 sin θ h' + h'²`,
/// where the middle term shifts the orders of h by one and `h'² = u²cos²θ/h²` is rational: its
/// partial fractions in sin θ have the geometric series in p₁ and p₂ as Fourier series.
pub fn torque(
    proportions: &Proportions,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<TorqueHarmonics> {
    // Orders n − 1, n and n + 1 of the force, side by side.
    let around: Vec<u32> = orders.iter().flat_map(|&n| [n - 1, n, n + 1]).collect();
    let force = once_each(&around.iter().map(|&n| n.max(1)).collect::<Vec<_>>(), |orders| {
        coefficients(proportions, orders, cancel)
    })?;
    // Order n of h' from order n of the acceleration: h'ₙ = i n hₙ and aₙ = n² hₙ.
    let slope = |index: usize| -> Complex64 {
        let n = around[index];
        if n == 0 {
            return Complex64::default();
        }
        let of_crank = if n == 1 { 1.0 } else { 0.0 };
        Complex64::i() * (force[index] - of_crank) / f64::from(n)
    };
    let rational = RationalPart::new(proportions);
    let (mut roll, mut crank) = (Vec::new(), Vec::new());
    for (k, &n) in orders.iter().enumerate() {
        cancel.check()?;
        let shifted = Complex64::i() * (slope(3 * k) - slope(3 * k + 2));
        let of_sine = if n == 2 { -0.5 } else { 0.0 };
        let velocity_squared = shifted + rational.harmonic(n) + of_sine;
        let half_derivative = Complex64::i() * velocity_squared * (0.5 * f64::from(n));
        crank.push(-half_derivative);
        // x'' = −Σ aₙ e^{inθ}
        roll.push(half_derivative - force[3 * k + 1] * proportions.offset);
    }
    Ok(TorqueHarmonics { roll, crank })
}

/// A function of orders that takes long for each, asked but once for those that come again.
fn once_each(
    orders: &[u32],
    of: impl Fn(&[u32]) -> Result<Vec<Complex64>>,
) -> Result<Vec<Complex64>> {
    /// Up to so many orders it is asked at once.
    const FEW: usize = 64;
    if orders.len() <= FEW {
        return of(orders);
    }
    let mut distinct = orders.to_vec();
    distinct.sort_unstable();
    distinct.dedup();
    let values = of(&distinct)?;
    Ok(orders.iter().map(|n| values[distinct.partition_point(|other| other < n)]).collect())
}

/// Both torques of a cylinder over ω², rod inertia and all, with proportions of their own.
pub fn of_cylinder(
    cylinder: &Cylinder,
    proportions: &Proportions,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<TorqueHarmonics> {
    let mut sum = torque(proportions, orders, cancel)?;
    let of_rod = rod::torque(proportions, orders, cancel)?;
    let (masses, inertia) = (cylinder.second_moment(), cylinder.rod_inertia_excess());
    for (sum, of_rod) in [(&mut sum.roll, of_rod.roll), (&mut sum.crank, of_rod.crank)] {
        for (value, of_rod) in sum.iter_mut().zip(of_rod) {
            *value = *value * masses + of_rod * inertia;
        }
    }
    Ok(sum)
}

/// Both torques of a cylinder over m·r²·ω², rod inertia and all.
pub fn over_second_moment(
    cylinder: &Cylinder,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<TorqueHarmonics> {
    let (proportions, masses) = (cylinder.proportions(), cylinder.second_moment());
    if !cylinder.has_rod_inertia() {
        return torque(&proportions, orders, cancel);
    }
    if masses == 0.0 {
        let cure = "torques of rod inertia are over m·r² of a mass above zero";
        return Err(Error::figure("reciprocating_mass", 0.0, cure));
    }
    let TorqueHarmonics { roll, crank } = of_cylinder(cylinder, &proportions, orders, cancel)?;
    let over = |values: Vec<Complex64>| values.into_iter().map(|value| value / masses).collect();
    Ok(TorqueHarmonics { roll: over(roll), crank: over(crank) })
}

/// Bound of what orders above `highest` can add to either torque over m·r²·ω².
///
/// Order n is `i n/2 (i(h'ₙ₋₁ − h'ₙ₊₁) + Cₙ) − e aₙ` with |h'ₖ| = |aₖ|/k, and the rational part
/// |Cₙ| ≤ l p₂ⁿ⁻¹: the forces' tail, once for each neighbour, and a geometric sum.
#[must_use]
pub fn tail_bound(proportions: &Proportions, highest: u32) -> Option<f64> {
    let force = super::tail_bound(proportions, highest.saturating_sub(1))?;
    let roots = RationalPart::new(proportions).roots;
    let (p, first) = (roots.p2, f64::from(highest + 1));
    let gap = 1.0 - p;
    // Σ_{n ≥ N} n pⁿ⁻¹ = p^{N−1}(N/g + p/g²)
    let rational = p.powf(first - 1.0) * (first / gap + p / (gap * gap));
    let bound = (1.5 + proportions.offset.abs()) * force + 0.5 * proportions.rod * rational;
    bound.is_finite().then_some(bound)
}

/// `h'² = u²cos²θ/h²` as a Fourier series.
pub(super) struct RationalPart {
    rod: f64,
    offset: f64,
    roots: Roots,
    mirrored: bool,
}

impl RationalPart {
    pub fn new(proportions: &Proportions) -> Self {
        let Offset { size, mirrored, above, below } = Offset::new(proportions);
        Self { rod: proportions.rod, offset: size, roots: Roots::new(size, above, below), mirrored }
    }

    /// Peak phasor of order n ≥ 1.
    ///
    /// h'² = −cos²θ + (l/2r)·(cos²θ/(A − sin θ) + cos²θ/(B + sin θ)), and cos²θ/(A − sin θ) =
    /// sin θ + A − (A² − 1)/(A − sin θ), whose order n ≥ 2 is −(1 − p₁²) p₁ⁿ⁻¹ (−i)ⁿ and whose
    /// order 1 is −i p₁²; the other fraction has p₂ and iⁿ.
    pub fn harmonic(&self, n: u32) -> Complex64 {
        let Roots { p1, p2, difference, .. } = self.roots;
        let power = |p: f64, k: u32| p.powf(f64::from(k));
        if n % 2 == 1 {
            if self.offset == 0.0 {
                return Complex64::default();
            }
            // Powers of p₂ less powers of p₁, with p₂ − p₁ taken out.
            let spread =
                |k: u32| -> f64 { (0..k).map(|i| power(p1, i) * power(p2, k - 1 - i)).sum() };
            let magnitude = if n == 1 {
                -0.5 * self.rod * difference * (p1 + p2)
            } else {
                0.5 * self.rod * difference * (spread(n - 1) - spread(n + 1))
            };
            let magnitude = if self.mirrored { -magnitude } else { magnitude };
            return Complex64::new(0.0, if n % 4 == 1 { magnitude } else { -magnitude });
        }
        let sum = (1.0 - p1 * p1) * power(p1, n - 1) + (1.0 - p2 * p2) * power(p2, n - 1);
        let fraction = 0.5 * self.rod * if n.is_multiple_of(4) { -sum } else { sum };
        Complex64::new(if n == 2 { fraction - 0.5 } else { fraction }, 0.0)
    }
}
