//! Harmonics of one slider-crank: every order exact, for any rod ratio below 1 and any offset.
//!
//! The inertia force of a piston is `m r ω² Re Σ aₙ e^{in(θ − tdc)}`; this module computes `aₙ` and
//! the harmonics of the torques. With A = (l + e)/r and B = (l − e)/r the height of the rod,
//! √((A − sin θ)(B + sin θ)), factors into
//! `√((1 + p₁w)(1 − p₂w)) · √((1 + p₁/w)(1 − p₂/w)) / (2√(p₁p₂))` with w = i e^{iθ},
//! p₁ = A − √(A² − 1) and p₂ = B − √(B² − 1). The first root is a power series Σ hₖwᵏ with a
//! two-term recurrence, and the coefficient of e^{inθ} is `iⁿ Σⱼ h_{j+n} hⱼ / (2√(p₁p₂))`: sums of
//! terms of one sign after the first, so that every order keeps its *relative* accuracy, where a
//! transform of samples loses high orders to the rounding of the low ones. Near λ = 1 the series
//! grows too long; what replaces it, and from where, is in `near_one`.
//!
//! Imports run downwards: `roots` → `near_one` → `centred`, `offset` → [`force`] → `fractions`,
//! [`rod`], [`torque`] → [`highest_order`], [`table`].

mod centred;
pub mod force;
mod fractions;
mod near_one;
mod offset;
pub mod rod;
mod roots;
pub mod table;
pub mod torque;

pub use force::{coefficients, tail_bound};

use crate::gear::slider_crank::Proportions;
use crate::numbers::limits;

/// Lowest order above which the rest of the force is below `tolerance` times m·r·ω² and, if `torque`
/// is given, that of the torque below `tolerance` times m·r²·ω²; `None` if no order up to
/// [`limits::HIGHEST_ORDER`] is high enough. `torque` is the magnitude of the rod's inertia excess
/// over the same m·r².
#[must_use]
pub fn highest_order(
    proportions: &Proportions,
    tolerance: f64,
    torque: Option<f64>,
) -> Option<u32> {
    let of_torque = |n: u32, rod_inertia: f64| -> Option<f64> {
        let of_masses = torque::tail_bound(proportions, n)?;
        if rod_inertia == 0.0 {
            return Some(of_masses);
        }
        Some(of_masses + rod_inertia * rod::tail_bound(proportions, n)?)
    };
    let enough = |n: u32| {
        let within = |bound: Option<f64>| bound.is_some_and(|bound| bound <= tolerance);
        within(force::tail_bound(proportions, n))
            && torque.is_none_or(|rod_inertia| within(of_torque(n, rod_inertia)))
    };
    if !enough(limits::HIGHEST_ORDER) {
        return None;
    }
    let (mut low, mut high) = (0, limits::HIGHEST_ORDER);
    while low < high {
        let middle = u32::midpoint(low, high);
        if enough(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    Some(high.max(1))
}
