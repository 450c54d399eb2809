//! Inertia of a piston and of what moves with it: a force along its bore, and the torque of it.

use std::sync::Arc;

use crate::Complex64;
use crate::mechanism::exact::TorqueKey;
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::mechanism::motion::MotionColumns;
use crate::mechanism::{DrivenMechanism, HarmonicsOf, at_own_orders};
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::numbers::simd::vectorised;
use crate::source::over_angle::{AngleBlock, BLOCK, Columns, LoadSum, Quantities, add_inertia};
use crate::source::{
    Column, ExactFactor, ForcePart, INERTIA, Parts, Point, PointColumns, Scale, Series, Source,
    Tail, TorqueAmplitudes, UpTo, amplitudes, is_equal,
};

/// Force over m·r·ω², torque over m·r²·ω².
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PistonInertia(pub DrivenMechanism);

impl PistonInertia {
    /// What orders above a number of halves add.
    fn rest(&self, halves: u32) -> Tail {
        let (own, mechanism) = (self.0.own_highest(halves), &self.0.mechanism);
        Tail {
            force: mechanism.force_beyond(own).unwrap_or(f64::INFINITY),
            torque: torque_beyond(&self.0, mechanism.torque_beyond(own)),
        }
    }
}

impl Source for PistonInertia {
    fn name(&self) -> &'static str {
        INERTIA
    }

    fn parts(&self) -> Parts {
        Parts::inertia(Some(ForcePart::Along), true)
    }

    fn equals(&self, other: &dyn Source) -> bool {
        is_equal(self, other)
    }

    fn mechanism(&self) -> Option<&DrivenMechanism> {
        Some(&self.0)
    }

    fn force(&self, orders: &[Order], cancel: &Cancel) -> Result<Vec<Complex64>> {
        at_own_orders(self.0.ratio, orders, |own| self.0.mechanism.force(own, cancel))
    }

    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        torque_by(&self.0, orders, |own| self.0.mechanism.torque(own, cancel))
    }

    fn series(&self, up_to: UpTo, _: &Cancel) -> Result<Series> {
        Ok(multiples(&self.0, up_to, |halves| self.rest(halves)))
    }

    fn scale(&self) -> Scale {
        Scale { force: 1.0, torque: Some(1.0), least: 0.0 }
    }

    fn sizes_up_to_own(
        &self,
        column: Column,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Option<[Vec<f64>; 2]>> {
        let of = match column {
            Column::Force => HarmonicsOf::Force,
            Column::Roll => HarmonicsOf::Torque,
        };
        let rest = |halves| self.rest(halves);
        sizes_up_to_own(self, &self.0, (of, column), orders, rest, cancel).map(Some)
    }

    fn at_rod_ratios(
        &self,
        column: Column,
        rod_ratios: &[f64],
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Option<[PointColumns; 2]>> {
        let speed = self.0.ratio.halves_of_speed();
        let own = orders.iter().map(|order| order.halves()).filter(|n| n.is_multiple_of(speed));
        let own: Vec<u32> = own.map(|halves| halves / speed).collect();
        let (mechanism, [on_block, on_crank]) = (&self.0.mechanism, self.0.senses());
        let (of, factors) = match column {
            Column::Force => (HarmonicsOf::Force, vec![[1.0, 0.0]]),
            // Imaginary; that on the crank is the negative of that on the block.
            Column::Roll => (HarmonicsOf::Torque, vec![[0.0, on_block], [0.0, -on_crank]]),
        };
        let Some(table) = mechanism.at_rod_ratios(of, rod_ratios, &own, cancel)? else {
            return Ok(None);
        };
        let mut both = [PointColumns::new(), PointColumns::new()];
        for (columns, factors) in both.iter_mut().zip(factors) {
            let mut places = 0..own.len();
            for order in orders {
                let place = order.halves().is_multiple_of(speed).then(|| places.next()).flatten();
                let mut column =
                    [memory::zeros(rod_ratios.len())?, memory::zeros(rod_ratios.len())?];
                for (part, factor) in column.iter_mut().zip(factors).filter(|(_, by)| *by != 0.0) {
                    let Some(k) = place else { continue };
                    let values = table.iter().skip(k).step_by(own.len());
                    part.iter_mut().zip(values).for_each(|(out, value)| *out = factor * value);
                }
                columns.push(column);
            }
        }
        Ok(Some(both))
    }

    fn at_point(&self, point: &Point) -> Result<Option<Arc<dyn Source>>> {
        Ok(Some(Arc::new(Self(self.0.replaced(point.rod_ratio, point.pin_offset)?))))
    }

    fn exact(&self) -> ExactFactor {
        ExactFactor::Motion(TorqueKey::Masses)
    }

    fn over_angle(
        &self,
        sum: &LoadSum,
        block: &AngleBlock,
        wanted: Quantities,
        square: f64,
        columns: &mut Columns,
    ) -> Result<()> {
        let Columns { force: [force_x, force_y], moment: [moment_x, moment_y], .. } = columns;
        let [roll, crank] = &mut columns.torque;
        // The force is against the acceleration of the piston away from the crank.
        let [force, moment, arm] = [sum.force, sum.moment, sum.arm].map(|sum| sum * -square);
        let [on_block, on_crank] = self.0.senses().map(|sense| sense * square * sum.roll);
        let offset = self.0.mechanism.offset();
        block.with_motion(&self.0, sum, wanted.torque, |[velocity, acceleration]| {
            vectorised(
                #[inline(always)]
                || {
                    if wanted.force {
                        for i in 0..BLOCK {
                            force_x[i] += force.re * acceleration[i];
                            force_y[i] += force.im * acceleration[i];
                        }
                    }
                    if wanted.moment {
                        for i in 0..BLOCK {
                            moment_x[i] += moment.re * acceleration[i];
                            moment_y[i] += moment.im * acceleration[i];
                        }
                    }
                    if wanted.torque {
                        for i in 0..BLOCK {
                            let along = velocity[i] + offset;
                            roll[i] += (on_block * along + arm.im) * acceleration[i];
                            crank[i] -= on_crank * velocity[i] * acceleration[i];
                        }
                    }
                },
            );
        });
        Ok(())
    }

    fn add_inertia(&self, sum: &LoadSum, angles: &CrankAngles, into: [&mut [f64]; 2]) {
        add_inertia(&self.0, sum, angles, into, |cranks, both| {
            self.0.mechanism.motions(cranks, MotionColumns::of_both(both));
        });
    }
}

/// Multiples of the speed of a mechanism's crank, with bounds of what those above some halves add.
pub(super) fn multiples(
    driven: &DrivenMechanism,
    up_to: UpTo,
    rest: impl Fn(u32) -> Tail,
) -> Series {
    let (step, highest) = (driven.ratio.halves_of_speed(), up_to.halves(&rest));
    let own = 1..=driven.own_highest(highest);
    let orders = own.filter_map(|own| Order::from_halves(own * step).ok()).collect();
    Series::without_amplitudes(orders, rest(highest))
}

/// Bounds of the sizes of amplitudes at any rod ratio and pin offset up to those of a mechanism: they themselves
/// where all grow with the rod ratio, else that of the orders from each on.
pub(super) fn sizes_up_to_own(
    source: &impl Source,
    driven: &DrivenMechanism,
    (of, column): (HarmonicsOf, Column),
    orders: &[Order],
    rest: impl Fn(u32) -> Tail,
    cancel: &Cancel,
) -> Result<[Vec<f64>; 2]> {
    if driven.mechanism.grows_with_rod_ratio(of) {
        let TorqueHarmonics { roll, crank } = amplitudes(source, column, orders, cancel)?;
        return Ok([roll, crank].map(|values| values.iter().map(|value| value.norm()).collect()));
    }
    let bound = |order: &Order| {
        if order.as_whole().is_none() {
            return 0.0;
        }
        let (own, halves) = (driven.own_highest(order.halves()), order.halves() - 1);
        match column {
            Column::Force => rest(halves).force + f64::from(u8::from(own == 1)),
            Column::Roll if own < 3 => f64::INFINITY,
            Column::Roll => rest(halves).torque,
        }
    };
    let bounds: Vec<f64> = orders.iter().map(bound).collect();
    Ok([bounds.clone(), bounds])
}

/// Bound of what own orders add to either torque on the main crank and the block from that on their own crank.
pub(super) fn torque_beyond(driven: &DrivenMechanism, bound: Option<f64>) -> f64 {
    bound.unwrap_or(f64::INFINITY) * driven.ratio.size()
}

/// Torques of a mechanism on the block and on the main crank from those on its own crank.
pub(super) fn torque_by(
    driven: &DrivenMechanism,
    orders: &[Order],
    of: impl FnOnce(&[u32]) -> Result<TorqueHarmonics>,
) -> Result<TorqueAmplitudes> {
    let mut crank = Vec::new();
    let mut roll = at_own_orders(driven.ratio, orders, |own| {
        let torque = of(own)?;
        crank = torque.crank;
        Ok(torque.roll)
    })?;
    let mut crank = at_own_orders(driven.ratio, orders, |_| Ok(crank))?;
    if driven.ratio != SpeedRatio::ONE {
        let [on_block, on_crank] = driven.senses();
        for (roll, crank) in roll.iter_mut().zip(&mut crank) {
            *roll *= on_block;
            *crank *= on_crank;
        }
    }
    Ok(TorqueAmplitudes { harmonics: TorqueHarmonics { roll, crank }, mean: [0.0; 2] })
}
