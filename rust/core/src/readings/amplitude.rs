//! Wrenches of an engine's loads: their sums times the amplitudes of every source.

use std::sync::Arc;

use crate::Complex64;
use crate::load::source::{Column, Scaling, Source, TorqueAmplitudes};
use crate::load::{
    Harmonic, Load, LoadList, Phasors, SourceIndex, Sources, Wanted, count, superpose,
};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::index::List;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::wrench::{Planar, Wrench, rounding, snapped};

/// Wrenches of the given orders, in their order, those of inertia over ω²; what vanishes to within
/// rounding is zero.
///
/// Torque is zero where it is not wanted; a spectrum of forces does not determine it. The means are
/// those of the torques of pressure on the block and on the crank. `sources` are those of the loads.
pub(crate) fn wrenches(
    loads: &LoadList,
    sources: &Sources,
    torque: bool,
    orders: &[Order],
    cancel: &Cancel,
) -> Result<(Vec<Wrench>, [f64; 2])> {
    let amplitudes = Amplitudes::new(sources, torque, orders, cancel)?;
    let wrenches = amplitudes.wrenches(&loads.list, loads.reference, torque, orders, cancel)?;
    Ok((wrenches, amplitudes.mean(&loads.list)))
}

/// Amplitudes of some sources at some orders.
pub(crate) struct Amplitudes {
    /// Empty of those without a force.
    force: List<SourceIndex, Vec<Complex64>>,
    /// None without a torque, or where none is wanted.
    torque: List<SourceIndex, Option<TorqueAmplitudes>>,
}

/// Factors of a sum.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Amplitude {
    /// Of force and moment.
    pub force: Complex64,
    /// Of the torque on the block.
    pub roll: Complex64,
    /// Of the torque on the main crank.
    pub crank: Complex64,
}

impl Amplitudes {
    pub fn new(sources: &Sources, torque: bool, orders: &[Order], cancel: &Cancel) -> Result<Self> {
        let force = |source: &Arc<dyn Source>| {
            if source.parts().force.is_some() { source.force(orders, cancel) } else { Ok(vec![]) }
        };
        let torques = |source: &Arc<dyn Source>| {
            (torque && source.parts().roll).then(|| source.torque(orders, cancel)).transpose()
        };
        Ok(Self {
            force: sources.iter().map(force).collect::<Result<_>>()?,
            torque: sources.iter().map(torques).collect::<Result<_>>()?,
        })
    }

    /// Wrenches of some of the loads at the orders of these amplitudes, about a plane; as [`wrenches`].
    pub fn wrenches(
        &self,
        loads: &[Load],
        reference: f64,
        torque: bool,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Vec<Wrench>> {
        let counts = [false, true].map(|torque| count(loads, torque));
        let wrench = |(k, &order): (usize, &Order)| {
            cancel.check()?;
            let mut wrench = Wrench::default();
            // Odd orders above 1 of pistons without offset are exactly zero.
            let planar =
                self.force.iter().any(|force| force.get(k).is_some_and(|&a| a != Complex64::ZERO));
            let wanted = Wanted { planar, roll: torque, by_bank: false };
            for term in superpose(&Phasors { reference }, loads, order, wanted) {
                let amplitude = self.of(term.harmonic, k);
                let [force, moment] = term.planar();
                wrench.force.add_scaled(&force, amplitude.force);
                wrench.moment.add_scaled(&moment, amplitude.force);
                let torque = match term.scaling {
                    Scaling::Given => &mut wrench.gas,
                    Scaling::SpeedSquared => &mut wrench.inertia,
                };
                torque.roll += term.roll.value * amplitude.roll;
                torque.crank += term.roll.value * amplitude.crank;
                for (size, of) in torque.sizes.iter_mut().zip([amplitude.roll, amplitude.crank]) {
                    *size += term.roll.size * of.norm();
                }
            }
            let [of_force, of_torque] = counts.map(|count| rounding(count, order.number()));
            let snap = |vector: &Planar| vector.snapped(vector.size * of_force);
            (wrench.force, wrench.moment) = (snap(&wrench.force), snap(&wrench.moment));
            for torque in [&mut wrench.inertia, &mut wrench.gas] {
                for (phasor, size) in
                    [&mut torque.roll, &mut torque.crank].into_iter().zip(torque.sizes)
                {
                    *phasor = snapped(*phasor, size * of_torque);
                }
            }
            Ok(wrench)
        };
        let mut wrenches = memory::with_capacity(orders.len())?;
        for each in orders.iter().enumerate() {
            wrenches.push(wrench(each)?);
        }
        Ok(wrenches)
    }

    /// Mean torques on the block and on the crank, of some of the loads.
    pub fn mean(&self, loads: &[Load]) -> [f64; 2] {
        loads.iter().fold([0.0; 2], |[roll, crank], load| match &self.torque[load.source] {
            Some(torque) => [roll + load.roll * torque.mean[0], crank + load.roll * torque.mean[1]],
            None => [roll, crank],
        })
    }

    /// Factors of the sums of a harmonic at the order of an index.
    pub fn of(&self, Harmonic { source, column }: Harmonic, k: usize) -> Amplitude {
        match column {
            // A shaft that turns evenly takes no torque of the crank, nor does a force on an arm.
            Column::Force => {
                let force = self.force[source].get(k).copied().unwrap_or_default();
                Amplitude { force, roll: force, crank: Complex64::ZERO }
            }
            Column::Roll => {
                self.torque[source].as_ref().map_or_else(Amplitude::default, |torque| {
                    let harmonics = &torque.harmonics;
                    Amplitude {
                        force: Complex64::ZERO,
                        roll: harmonics.roll[k],
                        crank: harmonics.crank[k],
                    }
                })
            }
        }
    }
}
