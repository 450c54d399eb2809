//! Harmonics of the torques that one cylinder's inertia force makes, in closed form.

use super::force;
use super::fractions::Fractions;
use super::roots::{Root, Sides};
use crate::Complex64;
use crate::mechanism::cylinder::Cylinder;
use crate::mechanism::slider_crank::Proportions;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::order::Order;

pub use super::rod::TorqueHarmonics;

/// Harmonics of the torques of the inertia force over m·r²·ω², in closed form.
///
/// `x'' x'` is half the derivative of `x'²`. With `x' = h' − sin θ`, `x'² = sin²θ − 2 sin θ h' + h'²`,
/// where the middle term shifts the orders of h by one and `h'²` is rational (`fractions`).
pub fn torque(
    proportions: &Proportions,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<TorqueHarmonics> {
    orders.iter().try_for_each(|&n| Order::whole(n).map(drop))?;
    // Orders n − 1, n and n + 1 of the force, side by side.
    let around: Vec<u32> = orders.iter().flat_map(|&n| [n - 1, n, n + 1]).collect();
    let forces = once_each(&around.iter().map(|&n| n.max(1)).collect::<Vec<_>>(), |orders| {
        force::unchecked(proportions, orders, cancel)
    })?;
    // Order n of h' from order n of the acceleration: h'ₙ = i n hₙ and aₙ = n² hₙ.
    let slope = |index: usize| -> Complex64 {
        let n = around[index];
        if n == 0 {
            return Complex64::default();
        }
        let of_crank = if n == 1 { 1.0 } else { 0.0 };
        Complex64::i() * (forces[index] - of_crank) / f64::from(n)
    };
    let fractions = Fractions::new(proportions);
    let (mut roll, mut crank) = (Vec::new(), Vec::new());
    for (k, &n) in orders.iter().enumerate() {
        cancel.check()?;
        let shifted = Complex64::i() * (slope(3 * k) - slope(3 * k + 2));
        // sin²θ − cos²θ = −cos 2θ
        let of_crank = if n == 2 { -1.0 } else { 0.0 };
        let velocity_squared = shifted + (fractions.harmonic(n) + of_crank);
        let half_derivative = Complex64::i() * velocity_squared * (0.5 * f64::from(n));
        crank.push(-half_derivative);
        // x'' = −Σ aₙ e^{inθ}
        roll.push(half_derivative - forces[3 * k + 1] * proportions.offset);
    }
    Ok(TorqueHarmonics { roll, crank })
}

/// Evaluates a function of orders once for each distinct order.
fn once_each(
    orders: &[u32],
    of: impl Fn(&[u32]) -> Result<Vec<Complex64>>,
) -> Result<Vec<Complex64>> {
    /// Up to this many orders a repetition costs less than finding it.
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

/// Both torques of a cylinder over m·r²·ω², rod inertia included.
pub fn over_second_moment(
    cylinder: &Cylinder,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<TorqueHarmonics> {
    let (mechanism, masses) = (cylinder.mechanism(), cylinder.mass_radius_squared());
    let mut sum = mechanism.torque(orders, cancel)?;
    if !cylinder.has_rod_inertia() {
        return Ok(sum);
    }
    if masses == 0.0 {
        let hint = "torques of rod inertia are over m·r² of a mass above zero";
        return Err(Error::figure("reciprocating_mass", 0.0, hint));
    }
    let (of_rod, inertia) =
        (mechanism.swing_torque(orders, cancel)?, cylinder.rod_inertia_excess());
    for (sum, of_rod) in [(&mut sum.roll, of_rod.roll), (&mut sum.crank, of_rod.crank)] {
        for (value, of_rod) in sum.iter_mut().zip(of_rod) {
            *value = (*value * masses + of_rod * inertia) / masses;
        }
    }
    Ok(sum)
}

/// Bound of what orders above `highest` can add to either torque over m·r²·ω².
///
/// Order n is `i n/2 (i(h'ₙ₋₁ − h'ₙ₊₁) + Cₙ) − e aₙ` with |h'ₖ| = |aₖ|/k, and the rational part
/// |Cₙ| ≤ l p₂ⁿ⁻¹: the forces' tail, once for each neighbour, and a geometric sum.
#[must_use]
pub fn tail_bound(proportions: &Proportions, highest: u32) -> Option<f64> {
    let force = force::tail_bound(proportions, highest.saturating_sub(1))?;
    let Root { p, .. } = Root::new(Sides::new(proportions).below);
    let first = f64::from(highest + 1);
    let gap = 1.0 - p;
    // Σ_{n ≥ N} n pⁿ⁻¹ = p^{N−1}(N/g + p/g²)
    let rational = p.powf(first - 1.0) * (first / gap + p / (gap * gap));
    let bound = (1.5 + proportions.offset.abs()) * force + 0.5 * proportions.rod * rational;
    bound.is_finite().then_some(bound)
}
