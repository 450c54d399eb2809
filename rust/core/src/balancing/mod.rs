//! Hardware fitted to an engine: counterweights and balance shafts, and what they remove.
//!
//! A weight u (kg·m, x + iy at θ = 0) at z exerts the force u·ω² and the moment i(z − z₀)·u·ω². Both
//! scale with ω², so that one fit serves every speed. Forces are in kg·m here, moments and torques in
//! kg·m²: over ω².

pub mod adaptive;
mod angle_lists;
pub mod bob_weight;
pub mod card;
pub mod counterweights;
mod discs;
mod least_squares;
pub mod phasors;
pub mod shafts;
pub mod weights;

use std::collections::BTreeSet;

use crate::Complex64;
use crate::engine::Engine;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::limits::SMALLEST;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::readings::turning::over_square;
pub use crate::readings::turning::{TurningPart, turning};

/// Phasor of an order of the roll torque on the block, over ω²; with what does not scale so, as that of gas
/// pressure, at a speed.
pub fn roll_torque(
    engine: &Engine,
    order: Order,
    rpm: Option<f64>,
    cancel: &Cancel,
) -> Result<Complex64> {
    Ok(over_square(engine, order, true, rpm, cancel)?.torque.roll)
}

/// Forces at places along a shaft as taken by two planes, front and rear, by the lever rule.
#[must_use]
pub fn shared(forces: &[(Complex64, f64)], front: f64, rear: f64) -> [Complex64; 2] {
    let mut taken = [Complex64::default(); 2];
    for &(force, z) in forces {
        let on_rear = (z - front) / (rear - front);
        taken[0] += force * (1.0 - on_rear);
        taken[1] += force * on_rear;
    }
    taken
}

/// Length over which a moment counts as much as a force, m: half the distance between the first and
/// the last cylinder, or the crank radius where they are at one place, or so near that levers over the
/// distance between them would be no numbers.
fn half_length(engine: &Engine) -> f64 {
    let half = engine.length() / 2.0;
    if half >= SMALLEST { half } else { engine.largest_crank_radius() }
}

/// Part of the largest of several values below which another is rounding: some hundred units in the last
/// place, as sums of the terms of an engine leave them.
const VALUE_ROUNDING: f64 = 1e-13;

/// Zero for values that are rounding beside the largest of them.
fn without_rounding(values: &mut [Complex64]) {
    let largest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
    for value in values {
        if value.norm() <= VALUE_ROUNDING * largest {
            *value = Complex64::default();
        }
    }
}

/// Times the rounding error of a sum, which is more than the errors of a fit leave: about a millionth of its terms.
const NOTICEABLE: f64 = 1e8;

/// What hardware brings about at an order that the engine does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Appearing {
    /// A force.
    Force,
    /// A moment about the reference plane.
    Moment,
    /// A roll torque of inertia.
    Roll,
}

/// Forces, moments and roll torques that vanish in an engine and not in the same with other hardware, at
/// the orders of its cranks and shafts.
pub fn appearing(
    before: &Engine,
    after: &Engine,
    cancel: &Cancel,
) -> Result<Vec<(Order, Appearing)>> {
    let cranks = after.cranks().iter().map(|crank| crank.ratio);
    let ratios = cranks.chain(after.shafts().iter().map(|shaft| shaft.ratio));
    let orders = ratios.map(SpeedRatio::order).collect::<Result<BTreeSet<_>>>()?;
    let mut found = Vec::new();
    for order in orders {
        // Hardware changes what scales as it does alone.
        let [was, is] = [before, after].map(|engine| {
            let wrench = over_square(&engine.of_speed_squared(), order, true, None, cancel)?;
            let (force, moment, torque) = (wrench.force, wrench.moment, wrench.torque);
            Ok([
                (force.peak(), force.bound),
                (moment.peak(), moment.bound),
                (torque.roll.norm(), torque.bounds[0]),
            ])
        });
        let kinds = [Appearing::Force, Appearing::Moment, Appearing::Roll];
        for ((kind, (was, _)), (is, bound)) in kinds.into_iter().zip(was?).zip(is?) {
            if was == 0.0 && is > NOTICEABLE * bound {
                found.push((order, kind));
            }
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_planes_take_the_force_and_the_moment() {
        let [a, b] = [Complex64::new(1.0, -2.0), Complex64::new(0.5, 4.0)];
        let [front, rear] = shared(&[(a, 0.1), (b, -0.3)], 0.2, 0.7);
        // Sums of terms below 10, each with a few roundings.
        assert!((front + rear - a - b).norm() < 1e-14);
        assert!((front * 0.2 + rear * 0.7 - a * 0.1 + b * 0.3).norm() < 1e-14);
    }
}
