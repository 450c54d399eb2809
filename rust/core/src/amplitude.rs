//! Amplitudes of an engine's loads: the harmonics of every motion, and the wrench of each order.

use crate::Complex64;
use crate::cancel::Cancel;
use crate::error::Result;
use crate::harmonics::{self, torque::TorqueHarmonics};
use crate::load::{Channel, Loads, Source};
use crate::order::Order;
use crate::slider_crank::Cylinder;
use crate::spectrum::Spectrum;
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
    let mut found = vec![Wrench::default(); whole.len()];
    add_planar(&mut found, loads, spectrum, &whole, cancel)?;
    if torque {
        add_torque(&mut found, loads, &whole, cancel)?;
    }
    let mut found = found.into_iter();
    let none = Wrench::default();
    Ok(orders.iter().map(|o| o.as_whole().and_then(|_| found.next()).unwrap_or(none)).collect())
}

fn add_planar(
    wrenches: &mut [Wrench],
    loads: &Loads,
    spectrum: Option<&Spectrum>,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<()> {
    let of_motion = |motion: &Cylinder| match spectrum {
        Some(spectrum) => Ok(orders.iter().map(|&n| spectrum.amplitude(n)).collect()),
        None => harmonics::coefficients(&motion.proportions(), orders, cancel),
    };
    let amplitudes: Vec<Vec<Complex64>> =
        loads.motions.iter().map(of_motion).collect::<Result<_>>()?;
    let unbalanced = loads.unbalance_orders();
    for (k, (wrench, &order)) in wrenches.iter_mut().zip(orders).enumerate() {
        cancel.check()?;
        let amplitude = |channel| match channel {
            Channel::Masses(motion) => amplitudes[motion][k],
            _ => Complex64::new(1.0, 0.0),
        };
        // Odd orders above 1 of pistons without offset are exactly zero.
        let zero = amplitudes.iter().all(|of_motion| of_motion[k] == Complex64::default());
        if zero && !unbalanced.contains(&order) {
            continue;
        }
        for sum in loads.planar(order, false) {
            let amplitude = amplitude(sum.channel);
            wrench.force.add_scaled(&sum.force, amplitude);
            wrench.moment.add_scaled(&sum.moment, amplitude);
        }
        let factor = rounding(loads.list.len(), f64::from(order));
        let snap = |vector: &Planar| vector.snapped(vector.size * factor);
        (wrench.force, wrench.moment) = (snap(&wrench.force), snap(&wrench.moment));
    }
    Ok(())
}

fn add_torque(
    wrenches: &mut [Wrench],
    loads: &Loads,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<()> {
    let masses = loads.motions.iter().map(Cylinder::proportions);
    let masses = masses.map(|motion| harmonics::torque::torque(&motion, orders, cancel));
    let masses: Vec<TorqueHarmonics> = masses.collect::<Result<_>>()?;
    let rods = (0..loads.motions.len()).map(|motion| {
        let of = |motion: &Cylinder| harmonics::rod::torque(&motion.proportions(), orders, cancel);
        loads.has_rod_inertia(motion).then(|| of(&loads.motions[motion])).transpose()
    });
    let rods: Vec<Option<TorqueHarmonics>> = rods.collect::<Result<_>>()?;
    for (k, (wrench, &order)) in wrenches.iter_mut().zip(orders).enumerate() {
        let torque = &mut wrench.torque;
        for sum in loads.roll(order, false) {
            let [roll, crank] = match sum.channel {
                // A shaft that turns evenly takes no torque of the crank.
                Channel::Unit => [Complex64::new(1.0, 0.0), Complex64::default()],
                Channel::Masses(motion) => [masses[motion].roll[k], masses[motion].crank[k]],
                Channel::Rod(motion) => rods[motion]
                    .as_ref()
                    .map_or([Complex64::default(); 2], |rod| [rod.roll[k], rod.crank[k]]),
            };
            torque.roll += sum.sum * roll;
            torque.crank += sum.sum * crank;
            torque.size += sum.size * roll.norm().max(crank.norm());
        }
        let bound = torque.size * rounding(loads.list.len(), f64::from(order));
        (torque.roll, torque.crank) = (snapped(torque.roll, bound), snapped(torque.crank, bound));
    }
    Ok(())
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
