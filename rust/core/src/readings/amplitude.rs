//! Wrenches of an engine's loads: their sums times the amplitudes of every source.

use std::sync::Arc;

use crate::Complex64;
use crate::load::{
    GroupIndex, Harmonic, KnownSeries, Load, Phasors, Scene, SourceIndex, Sources, Wanted, count,
    superpose,
};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::index::{List, ListIndex};
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::source::{Column, Source, TorqueAmplitudes};
use crate::wrench::{Wrench, rounding};

/// Mean torques of each group on the block and on the main crank.
pub(crate) type Means = List<GroupIndex, [f64; 2]>;

/// Amplitudes of some sources at some orders.
pub(crate) struct SourceAmplitudes {
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

impl SourceAmplitudes {
    /// Torque is zero where it is not wanted; a spectrum of forces does not determine it.
    pub fn new(sources: &Sources, torque: bool, orders: &[Order], cancel: &Cancel) -> Result<Self> {
        Self::of_known((sources, &KnownSeries::default()), torque, orders, cancel)
    }

    /// All 1: sums are those of weights.
    pub fn ones(sources: &Sources, orders: &[Order]) -> Self {
        let ones = || vec![Complex64::ONE; orders.len()]; // bounded: by HIGHEST_ORDER
        let torque = |_: &_| Some(TorqueAmplitudes::shared(&ones(), 0.0, [1.0; 2]));
        Self { force: sources.map_to(|_| ones()), torque: sources.map_to(torque) }
    }

    /// Of sources whose series are known, as far as they are.
    pub fn of_known(
        (sources, known): (&Sources, &KnownSeries),
        torque: bool,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Self> {
        let force = |source: &Arc<dyn Source>| {
            if source.parts().force.is_some() { source.force(orders, cancel) } else { Ok(vec![]) }
        };
        let torques = |(k, source): (SourceIndex, &Arc<dyn Source>)| {
            if !torque || !source.parts().roll {
                return Ok(None);
            }
            let known = known.get(k.position());
            let known = known.filter(|series| series.knows_torque_up_to(orders.last()));
            match known {
                Some(series) => Ok(Some(series.torque_at(orders))),
                None => source.torque(orders, cancel).map(Some),
            }
        };
        Ok(Self {
            force: sources.iter().map(force).collect::<Result<_>>()?,
            torque: sources.indices().zip(sources).map(torques).collect::<Result<_>>()?,
        })
    }

    /// Wrenches of some of an engine's loads at the orders of these amplitudes, in their order and of each group,
    /// over what the group scales with; what vanishes to within rounding is zero.
    pub fn wrenches(
        &self,
        loads: &Scene,
        some: &[Load],
        torque: bool,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Vec<Wrench>> {
        let (counts, groups) =
            ([false, true].map(|torque| count(some, torque)), loads.groups.len());
        let phasors = Phasors { reference: loads.reference };
        let mut wrenches: Vec<Wrench> = memory::with_capacity(orders.len() * groups)?;
        for (k, &order) in orders.iter().enumerate() {
            cancel.check()?;
            // Odd orders above 1 of pistons without offset are exactly zero.
            let planar =
                self.force.iter().any(|force| force.get(k).is_some_and(|&a| a != Complex64::ZERO));
            let wanted = Wanted { planar, roll: torque, by_bank: false };
            let rounding = counts.map(|count| rounding(count, order.number()));
            let first = wrenches.len();
            wrenches.resize(first + groups, Wrench::default());
            let of_order = &mut wrenches[first..];
            for term in superpose(&phasors, some, order, wanted) {
                let amplitude = self.of(term.harmonic, k);
                let [force, moment] = term.planar(rounding[0]);
                let wrench = &mut of_order[loads.group_of[term.harmonic.source].position()];
                wrench.force.add_scaled(&force, amplitude.force);
                wrench.moment.add_scaled(&moment, amplitude.force);
                let torque = &mut wrench.torque;
                torque.roll += term.roll.value * amplitude.roll;
                torque.crank += term.roll.value * amplitude.crank;
                let size = term.roll.size * rounding[1];
                for (bound, of) in torque.bounds.iter_mut().zip([amplitude.roll, amplitude.crank]) {
                    *bound += size * of.norm();
                }
            }
            for wrench in of_order {
                *wrench = wrench.snapped();
            }
        }
        Ok(wrenches)
    }

    /// Mean torques on the block and on the crank, of some of an engine's loads, by group.
    pub fn means(&self, loads: &Scene, some: &[Load]) -> Means {
        let mut means = loads.groups.map_to(|_| [0.0; 2]);
        for load in some {
            let Some(torque) = &self.torque[load.source] else { continue };
            let of_group = &mut means[loads.group_of[load.source]];
            for (mean, own) in of_group.iter_mut().zip(torque.mean) {
                *mean += load.roll * own;
            }
        }
        means
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
