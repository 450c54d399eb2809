//! The lowest order above which the remaining orders stay below a tolerance.

use super::{force, rod, torque};
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
