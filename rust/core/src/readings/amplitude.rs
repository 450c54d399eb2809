//! Amplitudes of an engine's loads: the harmonics of every motion, and the wrench of each order.

use crate::Complex64;
use crate::gear::harmonics::{self, torque::TorqueHarmonics};
use crate::gear::spectrum::Spectrum;
use crate::load::{Channel, Loads, Source};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::wrench::{Planar, Wrench, rounding, snapped};

/// Wrenches over ω² of the given orders, in their order; what vanishes to within rounding is zero.
///
/// Torque is zero where it is not wanted; a spectrum of forces does not determine it.
pub(crate) fn wrenches(
    loads: &Loads,
    spectrum: Option<&Spectrum>,
    torque: bool,
    orders: &[Order],
    cancel: &Cancel,
) -> Result<Vec<Wrench>> {
    // Pistons and shafts at whole ratios have whole orders only.
    let whole: Vec<u32> = orders.iter().filter_map(|order| order.as_whole()).collect();
    let amplitudes = Amplitudes::new(loads, spectrum, torque, &whole, cancel)?;
    let unbalanced = loads.unbalance_orders();
    let mut wrenches = vec![Wrench::default(); orders.len()];
    let found = wrenches.iter_mut().zip(orders).filter(|(_, order)| order.as_whole().is_some());
    for (k, (wrench, order)) in found.enumerate() {
        cancel.check()?;
        // Odd orders above 1 of pistons without offset are exactly zero.
        let planar = amplitudes.has_force(k) || unbalanced.contains(&whole[k]);
        let (planar, roll) = loads.sums(whole[k], false, [planar, torque]);
        for sum in planar {
            let amplitude = amplitudes.of_force(sum.channel, k);
            wrench.force.add_scaled(&sum.force, amplitude);
            wrench.moment.add_scaled(&sum.moment, amplitude);
        }
        let torque = &mut wrench.torque;
        for sum in roll {
            let [roll, crank] = amplitudes.of_torque(sum.channel, k);
            torque.roll += sum.sum * roll;
            torque.crank += sum.sum * crank;
            torque.size += sum.size * roll.norm().max(crank.norm());
        }
        let factor = rounding(loads.list.len(), order.number());
        let snap = |vector: &Planar| vector.snapped(vector.size * factor);
        (wrench.force, wrench.moment) = (snap(&wrench.force), snap(&wrench.moment));
        let bound = wrench.torque.size * factor;
        for phasor in [&mut wrench.torque.roll, &mut wrench.torque.crank] {
            *phasor = snapped(*phasor, bound);
        }
    }
    Ok(wrenches)
}

/// Harmonics of every motion at some orders.
struct Amplitudes {
    force: Vec<Vec<Complex64>>,
    /// Torques of the masses, and of rods that have inertia.
    torque: Vec<(TorqueHarmonics, Option<TorqueHarmonics>)>,
}

impl Amplitudes {
    fn new(
        loads: &Loads,
        spectrum: Option<&Spectrum>,
        torque: bool,
        orders: &[u32],
        cancel: &Cancel,
    ) -> Result<Self> {
        let (mut force, mut torques) = (Vec::new(), Vec::new());
        for (k, motion) in loads.motions.iter().enumerate() {
            let motion = motion.proportions();
            force.push(match spectrum {
                Some(spectrum) => orders.iter().map(|&n| spectrum.amplitude(n)).collect(),
                None => harmonics::coefficients(&motion, orders, cancel)?,
            });
            if torque {
                let rod = || harmonics::rod::torque(&motion, orders, cancel);
                let rod = loads.has_rod_inertia(k).then(rod).transpose()?;
                torques.push((harmonics::torque::torque(&motion, orders, cancel)?, rod));
            }
        }
        Ok(Self { force, torque: torques })
    }

    fn has_force(&self, k: usize) -> bool {
        self.force.iter().any(|of_motion| of_motion[k] != Complex64::default())
    }

    fn of_force(&self, channel: Channel, k: usize) -> Complex64 {
        match channel {
            Channel::Masses(motion) => self.force[motion][k],
            Channel::Unit | Channel::Rod(_) => Complex64::new(1.0, 0.0),
        }
    }

    /// On the block and on the crank.
    fn of_torque(&self, channel: Channel, k: usize) -> [Complex64; 2] {
        let of = |torque: &TorqueHarmonics| [torque.roll[k], torque.crank[k]];
        match channel {
            // A shaft that turns evenly takes no torque of the crank.
            Channel::Unit => [Complex64::new(1.0, 0.0), Complex64::default()],
            Channel::Masses(motion) => of(&self.torque[motion].0),
            Channel::Rod(motion) => {
                self.torque[motion].1.as_ref().map_or_else(Default::default, of)
            }
        }
    }
}

impl Loads {
    /// Whether a rod of this motion has inertia beyond that of its two masses.
    pub fn has_rod_inertia(&self, of_motion: usize) -> bool {
        self.list.iter().any(|load| {
            matches!(load.source, Source::Piston { motion, rod_inertia, .. }
                if motion == of_motion && rod_inertia != 0.0)
        })
    }
}
