//! One cylinder: its moving parts, their motion, and the harmonics of the forces and torques of
//! their inertia.
//!
//! Imports run downwards: [`slider_crank`] → [`rod`] → [`harmonics`], [`spectrum`] → `Gear`.

pub mod harmonics;
pub mod rod;
pub mod slider_crank;
pub mod spectrum;

use std::sync::Arc;

use self::harmonics::rod::TorqueHarmonics;
use self::slider_crank::{Cylinder, Proportions};
use self::spectrum::Spectrum;
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::pressure::{Cycle, GasTorque};

/// Source of the amplitudes of a cylinder's loads.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Gear {
    pub kind: GearKind,
    /// Speed of its crank over that of the main one, negative where it turns the other way.
    pub ratio: i32,
    /// Pressure in the cylinder, where it counts.
    pub pressure: Option<Pressure>,
}

/// Pressure above and below a piston.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pressure {
    pub cycle: Arc<Cycle>,
    /// Absolute pressure in the crankcase, Pa.
    pub crankcase: f64,
}

/// Kind of a gear.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum GearKind {
    /// Crank, rod and piston: the force is over m·r·ω², torques over m·r²·ω² or rod inertia and ω².
    SliderCrank {
        /// Its figures; the first of those that share the proportions.
        cylinder: Cylinder,
        /// Proportions of its motion: its own, or those of a point of a sweep.
        proportions: Proportions,
    },
    /// A force given in kg·m, over ω²; it does not determine a torque.
    Given(Spectrum),
}

impl Gear {
    /// The slider-crank of a cylinder on a crank of this speed.
    pub fn of(cylinder: Cylinder, ratio: i32) -> Self {
        let proportions = cylinder.proportions();
        Self { kind: GearKind::SliderCrank { cylinder, proportions }, ratio, pressure: None }
    }

    /// Harmonics of the force; zero at orders that it does not have.
    pub fn force(&self, orders: &[Order], cancel: &Cancel) -> Result<Vec<Complex64>> {
        self.spread(orders, |own| match &self.kind {
            GearKind::SliderCrank { proportions, .. } => {
                harmonics::coefficients(proportions, own, cancel)
            }
            GearKind::Given(spectrum) => Ok(own.iter().map(|&n| spectrum.amplitude(n)).collect()),
        })
    }

    /// Harmonics of the torque of the masses on the block and on the main crank.
    pub fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueHarmonics> {
        self.torque_by(orders, |own, proportions| {
            harmonics::torque::torque(proportions, own, cancel)
        })
    }

    /// The same of the rod's inertia beyond that of its two masses.
    pub fn rod_torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueHarmonics> {
        self.torque_by(orders, |own, proportions| harmonics::rod::torque(proportions, own, cancel))
    }

    /// Factors of the torques on the block and on the main crank: turning the other way mirrors the
    /// torque on the block, and power is torque times speed.
    pub fn senses(&self) -> [f64; 2] {
        [f64::from(self.ratio.signum()), f64::from(self.ratio.abs())]
    }

    /// Torque of the pressure over piston area and crank radius, Pa, on the block and on the main
    /// crank: harmonics and mean, from those of [`Self::gas_up_to`] if they are known. The forces are
    /// internal, so that either balances the other.
    pub fn gas(
        &self,
        orders: &[Order],
        known: Option<&GasTorque>,
        cancel: &Cancel,
    ) -> Result<(TorqueHarmonics, [f64; 2])> {
        let Some((Pressure { cycle, crankcase }, proportions)) = self.driven() else {
            let zero = vec![Complex64::default(); orders.len()];
            return Ok((TorqueHarmonics { roll: zero.clone(), crank: zero }, [0.0; 2]));
        };
        // Pressure counts on cranks that turn as fast as the main one.
        let [on_block, _] = self.senses();
        let GasTorque { mean, phasors } = match known.and_then(|known| known.at(orders)) {
            Some(found) => found,
            None => cycle.torque_of(proportions, *crankcase, orders, cancel)?,
        };
        let roll = phasors.iter().map(|phasor| phasor * -on_block).collect();
        Ok((TorqueHarmonics { roll, crank: phasors }, [-on_block * mean, mean]))
    }

    /// Harmonics ½, 1, 1½ … of the torque of the pressure on a crank, and bounds of the sum of all above
    /// each, up to an order; none without pressure.
    pub fn gas_up_to(
        &self,
        highest: Order,
        cancel: &Cancel,
    ) -> Result<Option<(GasTorque, Vec<f64>)>> {
        let Some((Pressure { cycle, crankcase }, proportions)) = self.driven() else {
            return Ok(None);
        };
        cycle.torque_up_to(proportions, *crankcase, highest, cancel).map(Some)
    }

    /// Largest torque of the pressure over piston area and crank radius, Pa, among those at whole
    /// degrees.
    pub fn largest_gas(&self) -> Option<f64> {
        let (Pressure { cycle, crankcase }, proportions) = self.driven()?;
        let torque = |degrees: u32| {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let pressure = cycle.pressure_deg(f64::from(degrees)) - crankcase;
            (pressure * proportions.motion(sin, cos).velocity).abs()
        };
        Some((0..720).map(torque).fold(0.0, f64::max))
    }

    /// Pressure, and the proportions of the motion against which it acts.
    fn driven(&self) -> Option<(&Pressure, &Proportions)> {
        match &self.kind {
            GearKind::SliderCrank { proportions, .. } => {
                Some((self.pressure.as_ref()?, proportions))
            }
            GearKind::Given(_) => None,
        }
    }

    /// Whether it is a slider-crank whose piston has no offset.
    pub fn is_centred(&self) -> bool {
        matches!(&self.kind, GearKind::SliderCrank { proportions, .. } if proportions.offset == 0.0)
    }

    /// Bounds of what orders above a multiple of the speed of the main crank add to the force, to the
    /// torque of the masses and to that of the rod; infinite where none is known.
    pub fn tail(&self, highest: u32, torque: bool) -> [f64; 3] {
        let GearKind::SliderCrank { proportions, .. } = &self.kind else { return [0.0; 3] };
        let own = highest / self.ratio.unsigned_abs();
        let known = |bound: Option<f64>| bound.unwrap_or(f64::INFINITY);
        let of_torque = |bound: fn(&Proportions, u32) -> Option<f64>| {
            if torque { known(bound(proportions, own)) } else { 0.0 }
        };
        [
            known(harmonics::tail_bound(proportions, own)),
            of_torque(harmonics::torque::tail_bound),
            of_torque(harmonics::rod::tail_bound),
        ]
    }

    /// The gear with rod ratio and pin offset (m) replaced.
    pub fn replaced(&self, rod_ratio: Option<f64>, pin_offset: Option<f64>) -> Result<Self> {
        let GearKind::SliderCrank { cylinder, .. } = self.kind else { return Ok(self.clone()) };
        let proportions = cylinder.proportions_with(rod_ratio, pin_offset)?;
        Ok(Self { kind: GearKind::SliderCrank { cylinder, proportions }, ..self.clone() })
    }

    fn torque_by(
        &self,
        orders: &[Order],
        of: impl FnOnce(&[u32], &Proportions) -> Result<TorqueHarmonics>,
    ) -> Result<TorqueHarmonics> {
        let mut crank = Vec::new();
        let mut roll = self.spread(orders, |own| {
            let GearKind::SliderCrank { proportions, .. } = &self.kind else {
                crank = vec![Complex64::default(); own.len()];
                return Ok(crank.clone());
            };
            let found = of(own, proportions)?;
            crank = found.crank;
            Ok(found.roll)
        })?;
        let mut crank = self.spread(orders, |_| Ok(crank))?;
        if self.ratio != 1 {
            let [on_block, on_crank] = self.senses();
            for (roll, crank) in roll.iter_mut().zip(&mut crank) {
                *roll *= on_block;
                *crank *= on_crank;
            }
        }
        Ok(TorqueHarmonics { roll, crank })
    }

    /// Values at its own harmonics among some orders of the main crank, zero at the others.
    fn spread(
        &self,
        orders: &[Order],
        of: impl FnOnce(&[u32]) -> Result<Vec<Complex64>>,
    ) -> Result<Vec<Complex64>> {
        let ratio = self.ratio.unsigned_abs();
        let own = |order: &Order| order.as_whole().filter(|n| n % ratio == 0).map(|n| n / ratio);
        let whole: Vec<u32> = orders.iter().filter_map(own).collect();
        let mut found = of(&whole)?.into_iter();
        let value = |order: &Order| own(order).and_then(|_| found.next()).unwrap_or_default();
        Ok(orders.iter().map(value).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pressure::Given;

    #[test]
    fn the_tail_bounds_what_is_above_an_order_of_the_main_crank() {
        let cylinder = Cylinder::new(0.05, 0.12, 0.5, 0.01).unwrap();
        let orders: Vec<Order> = (1..100).map(|n| Order::whole(n).unwrap()).collect();
        for ratio in [1, -1, 2, -3] {
            let gear = Gear::of(cylinder, ratio);
            let sizes = gear.force(&orders, &Cancel::new()).unwrap();
            for highest in 1..20_usize {
                let above: f64 = sizes[highest..].iter().map(|size| size.norm()).sum();
                assert!(above <= gear.tail(highest as u32, false)[0], "{ratio} {highest}");
            }
        }
    }

    #[test]
    fn the_largest_torque_of_pressure_on_a_long_rod_is_at_a_quarter_turn() {
        let theta_deg: Vec<f64> = (0..720).map(f64::from).collect();
        let pressure = vec![3e5; 720];
        let given = Given { name: String::new(), strokes: 4, theta_deg, pressure, degree: None };
        let cycle = Arc::new(Cycle::new(given).unwrap());
        let mut gear = Gear::of(Cylinder::new(0.05, 5e3, 0.5, 0.0).unwrap(), 1);
        assert_eq!(gear.largest_gas(), None);
        gear.pressure = Some(Pressure { cycle, crankcase: 1e5 });
        // There the piston moves by a crank radius, whatever the rod; a degree away by 1.5e-4 less.
        let largest = gear.largest_gas().unwrap();
        assert!((largest / 2e5 - 1.0).abs() < 1e-12, "{largest}");
    }
}
