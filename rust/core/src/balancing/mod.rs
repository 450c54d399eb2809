//! Hardware fitted to an engine: counterweights and balance shafts, and what they remove.
//!
//! A weight u (kg·m, x + iy at θ = 0) at z exerts the force u·ω² and the moment i(z − z₀)·u·ω². Both
//! scale with ω², so that one fit serves every speed. Forces are in kg·m here, moments and torques in
//! kg·m²: over ω².

mod angle_lists;
pub mod bob_weight;
pub mod card;
mod discs;
mod least_squares;
pub mod shafts;
pub mod weights;

use crate::Complex64;
use crate::engine::Engine;
use crate::load::LoadList;
use crate::load::source::Scaling;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits::SMALLEST;
use crate::numbers::order::Order;
use crate::readings::amplitude::wrenches;
use crate::readings::balance::angular_speed;
use crate::wrench::Wrench;

/// Force and moment that turn with a shaft, x + iy at θ = 0, over ω².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TurningPart {
    /// Force, kg·m.
    pub force: Complex64,
    /// Moment about the reference plane, kg·m².
    pub moment: Complex64,
}

impl TurningPart {
    /// Part of an order's wrench that turns with a shaft of this ratio.
    fn of(wrench: &Wrench, ratio: i32) -> Self {
        let [force, moment] = [wrench.force, wrench.moment]
            .map(|vector| if ratio > 0 { vector.forward } else { vector.backward() });
        Self { force, moment }
    }
}

/// Part of an engine's force and moment that turns with a shaft of this ratio, over ω².
pub fn turning(engine: &Engine, ratio: i32, cancel: &Cancel) -> Result<TurningPart> {
    let order = Order::whole(ratio.unsigned_abs())?;
    Ok(TurningPart::of(&over_square(engine, order, false, None, cancel)?, ratio))
}

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

/// The wrench of an order over ω², at a speed where some of it does not scale so.
fn over_square(
    engine: &Engine,
    order: Order,
    torque: bool,
    rpm: Option<f64>,
    cancel: &Cancel,
) -> Result<Wrench> {
    let omega = rpm.map(angular_speed).transpose()?;
    if let Some(rpm) = rpm.filter(|_| omega == Some(0.0)) {
        let hint = "shafts make no force at rest; give a speed above 0";
        return Err(Error::figure("rpm", rpm, hint));
    }
    engine.check_speeds(rpm.as_slice())?;
    let loads = LoadList::new(engine, engine.reference(None)?);
    let torque = torque && engine.spectrum().is_none();
    let (by_group, _) = wrenches(&loads, &loads.sources, torque, &[order], cancel)?;
    let mut sum = Wrench::default();
    for (group, wrench) in loads.groups.iter().zip(&by_group) {
        let factor = match (group.scaling, omega) {
            (Scaling::SpeedSquared, _) => 1.0,
            (scaling, Some(omega)) => scaling.factor(omega) / (omega * omega),
            _ if wrench.is_zero() => continue,
            (_, None) => {
                let what = if wrench.torque.peak() > 0.0 { "torque" } else { "force" };
                let hint = format!(
                    "the {what} of {} does not scale with speed as that of shafts does; give the crank \
                     speed, above 0, at which they cancel it",
                    group.name
                );
                return Err(Error::value("rpm", "None", hint));
            }
        };
        sum = sum.plus(&wrench.scaled(factor));
    }
    Ok(sum)
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
    let [first, last] = engine.ends();
    let half = (last - first) / 2.0;
    if half >= SMALLEST { half } else { engine.largest_crank_radius() }
}

/// Part of the largest of several values below which another is rounding: some hundred units in the last
/// place, as sums of the terms of an engine leave them.
const NEGLIGIBLE: f64 = 1e-13;

/// Zero for values that are rounding beside the largest of them.
fn without_rounding(values: &mut [Complex64]) {
    let largest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
    for value in values {
        if value.norm() <= NEGLIGIBLE * largest {
            *value = Complex64::default();
        }
    }
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
