//! Wrenches of an engine's loads: their sums times the harmonics of every gear.

use crate::Complex64;
use crate::gear::harmonics::rod::TorqueHarmonics;
use crate::load::{Harmonic, Load, Loads, Phasors, Source, Wanted, superpose};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::pressure::GasTorque;
use crate::wrench::{Planar, Wrench, rounding, snapped};

/// Wrenches of the given orders, in their order, those of inertia over ω²; what vanishes to within
/// rounding is zero.
///
/// Torque is zero where it is not wanted; a spectrum of forces does not determine it. The means are
/// those of the torques of pressure on the block and on the crank; `gas` are the harmonics of these, by
/// gear, where they are known.
pub(crate) fn wrenches(
    loads: &Loads,
    torque: bool,
    orders: &[Order],
    gas: &[Option<GasTorque>],
    cancel: &Cancel,
) -> Result<(Vec<Wrench>, [f64; 2])> {
    let gears = GearHarmonics::new(loads, torque, orders, gas, cancel)?;
    let wrenches = gears.wrenches(&loads.list, loads.reference, torque, orders, cancel)?;
    Ok((wrenches, gears.mean(&loads.list)))
}

/// Harmonics of every gear at some orders.
pub(crate) struct GearHarmonics {
    force: Vec<Vec<Complex64>>,
    /// Torques of the masses, and of rods that have inertia.
    torque: Vec<(TorqueHarmonics, Option<TorqueHarmonics>)>,
    /// Torques of pressure, and their means, of gears that have any.
    gas: Vec<Option<(TorqueHarmonics, [f64; 2])>>,
}

impl GearHarmonics {
    pub fn new(
        loads: &Loads,
        torque: bool,
        orders: &[Order],
        known: &[Option<GasTorque>],
        cancel: &Cancel,
    ) -> Result<Self> {
        let (mut force, mut torques, mut gas) = (Vec::new(), Vec::new(), Vec::new());
        for (k, gear) in loads.gears.iter().enumerate() {
            force.push(gear.force(orders, cancel)?);
            if torque {
                let has_rod = loads.largest_rod_inertia(k) > 0.0;
                let rod = has_rod.then(|| gear.rod_torque(orders, cancel));
                torques.push((gear.torque(orders, cancel)?, rod.transpose()?));
                let known = known.get(k).and_then(Option::as_ref);
                let fired = gear.pressure.is_some().then(|| gear.gas(orders, known, cancel));
                gas.push(fired.transpose()?);
            }
        }
        Ok(Self { force, torque: torques, gas })
    }

    /// Wrenches of some of the loads at the orders of these harmonics, about a plane; as [`wrenches`].
    pub fn wrenches(
        &self,
        loads: &[Load],
        reference: f64,
        torque: bool,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Vec<Wrench>> {
        let wrench = |(k, &order): (usize, &Order)| {
            cancel.check()?;
            let mut wrench = Wrench::default();
            // Odd orders above 1 of pistons without offset are exactly zero.
            let is_unbalanced = |load: &Load| load.unbalance_order() == Some(order);
            let planar = self.have_force(k) || loads.iter().any(is_unbalanced);
            let wanted = Wanted { planar, roll: torque, by_bank: false };
            for term in superpose(&Phasors { reference }, loads, order, wanted) {
                let [on_force, roll, crank] = self.of(term.harmonic, k);
                let [force, moment] = term.planar();
                wrench.force.add_scaled(&force, on_force);
                wrench.moment.add_scaled(&moment, on_force);
                let torque = match term.harmonic {
                    Harmonic::Gas(_) => &mut wrench.gas,
                    _ => &mut wrench.inertia,
                };
                torque.roll += term.roll.value * roll;
                torque.crank += term.roll.value * crank;
                torque.size += term.roll.size * roll.norm().max(crank.norm());
            }
            let factor = rounding(loads.len(), order.number());
            let snap = |vector: &Planar| vector.snapped(vector.size * factor);
            (wrench.force, wrench.moment) = (snap(&wrench.force), snap(&wrench.moment));
            for torque in [&mut wrench.inertia, &mut wrench.gas] {
                let bound = torque.size * factor;
                for phasor in [&mut torque.roll, &mut torque.crank] {
                    *phasor = snapped(*phasor, bound);
                }
            }
            Ok(wrench)
        };
        let mut wrenches = memory::room(orders.len())?;
        for each in orders.iter().enumerate() {
            wrenches.push(wrench(each)?);
        }
        Ok(wrenches)
    }

    /// Mean torques of pressure on the block and on the crank, of some of the loads.
    pub fn mean(&self, loads: &[Load]) -> [f64; 2] {
        let mut mean = [0.0; 2];
        for load in loads {
            let Source::Pressure { gear } = load.source else { continue };
            let Some(Some((_, of_gear))) = self.gas.get(gear) else { continue };
            mean = [0, 1].map(|k| mean[k] + load.weight * of_gear[k]);
        }
        mean
    }

    fn have_force(&self, k: usize) -> bool {
        self.force.iter().any(|of_gear| of_gear[k] != Complex64::default())
    }

    /// Factors of the sums of force and moment, of roll torque and of torque on the crank.
    pub fn of(&self, harmonic: Harmonic, k: usize) -> [Complex64; 3] {
        let zero = Complex64::default();
        let of_torque = |torque: &TorqueHarmonics| [zero, torque.roll[k], torque.crank[k]];
        match harmonic {
            // A shaft that turns evenly takes no torque of the crank, nor does a force on an arm.
            Harmonic::One => [Complex64::new(1.0, 0.0), Complex64::new(1.0, 0.0), zero],
            Harmonic::Force(gear) => [self.force[gear][k], self.force[gear][k], zero],
            Harmonic::Torque(gear) => of_torque(&self.torque[gear].0),
            Harmonic::Gas(gear) => {
                self.gas[gear].as_ref().map_or([zero; 3], |(torque, _)| of_torque(torque))
            }
            Harmonic::Rod(gear) => self.torque[gear].1.as_ref().map_or([zero; 3], of_torque),
        }
    }
}
