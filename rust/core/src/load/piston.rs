//! Inertia of a piston and of what moves with it: a force along its bore, and the torque of it.

use std::sync::Arc;

use crate::Complex64;
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::mechanism::slider_crank::Proportions;
use crate::mechanism::{Mechanism, at_own_orders, harmonics};
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::numbers::simd::vectorised;
use crate::source::over_angle::{AngleBlock, BLOCK, Columns, LoadSum, Quantities, add_inertia};
use crate::source::{
    Column, ExactFactor, ForcePart, INERTIA, Parts, Point, Scale, Source, Tail, TorqueAmplitudes,
    is_equal,
};

/// Force over m·r·ω², torque over m·r²·ω².
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PistonInertia(pub Mechanism);

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

    fn mechanism(&self) -> Option<&Mechanism> {
        Some(&self.0)
    }

    fn force(&self, orders: &[Order], cancel: &Cancel) -> Result<Vec<Complex64>> {
        at_own_orders(self.0.ratio, orders, |own| {
            harmonics::coefficients(&self.0.proportions, own, cancel)
        })
    }

    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        torque_by(&self.0, orders, |own| {
            harmonics::torque::torque(&self.0.proportions, own, cancel)
        })
    }

    fn orders(&self, highest: Order) -> Vec<Order> {
        multiples(&self.0, highest)
    }

    fn beyond(&self, halves: u32, torque: bool) -> Tail {
        let (own, proportions) = (self.0.own_highest(halves), &self.0.proportions);
        Tail {
            force: harmonics::tail_bound(proportions, own).unwrap_or(f64::INFINITY),
            torque: torque_beyond(&self.0, torque, harmonics::torque::tail_bound, own),
        }
    }

    fn scale(&self) -> Scale {
        Scale { force: 1.0, torque: Some(1.0) }
    }

    /// Without offset √(1 − λ² sin²θ) is a power series in λ² whose terms give each order one sign. Of the
    /// torque order 4 falls from λ = 0.96 on: see the sweep's choice of orders.
    fn grows_up_to(&self, column: Column) -> f64 {
        match column {
            Column::Force => 1.0,
            Column::Roll => 0.95,
        }
    }

    fn at_point(&self, point: &Point) -> Result<Option<Arc<dyn Source>>> {
        Ok(Some(Arc::new(Self(self.0.replaced(point.rod_ratio, point.pin_offset)?))))
    }

    fn exact(&self) -> ExactFactor {
        ExactFactor::Piston
    }

    fn over_angle(
        &self,
        sum: &LoadSum,
        block: &AngleBlock,
        wanted: Quantities,
        square: f64,
        columns: &mut Columns,
    ) -> Result<()> {
        let yoke = self.0.proportions.has_infinite_rod();
        let (mechanism, columns) = (&self.0, columns);
        vectorised(
            #[inline(always)]
            || match (wanted.planar, wanted.torque, yoke) {
                (true, true, false) => {
                    add::<true, true, false>(mechanism, sum, block, square, columns);
                }
                (true, true, true) => {
                    add::<true, true, true>(mechanism, sum, block, square, columns);
                }
                (true, false, false) => {
                    add::<true, false, false>(mechanism, sum, block, square, columns);
                }
                (true, false, true) => {
                    add::<true, false, true>(mechanism, sum, block, square, columns);
                }
                (false, _, false) => {
                    add::<false, true, false>(mechanism, sum, block, square, columns);
                }
                (false, _, true) => {
                    add::<false, true, true>(mechanism, sum, block, square, columns);
                }
            },
        );
        Ok(())
    }

    fn add_inertia(&self, sum: &LoadSum, angles: &CrankAngles, into: [&mut [f64]; 2]) {
        add_inertia(&self.0, sum, angles, into, |crank| {
            let motion = self.0.proportions.motion_at(crank);
            [motion.velocity, motion.acceleration]
        });
    }
}

#[inline(always)]
fn add<const PLANAR: bool, const TORQUE: bool, const YOKE: bool>(
    mechanism: &Mechanism,
    sum: &LoadSum,
    block: &AngleBlock,
    square: f64,
    columns: &mut Columns,
) {
    let (units, proportions) = (&*block.units(sum.ratio), &mechanism.proportions);
    let Columns { force: [force_x, force_y], moment: [moment_x, moment_y], .. } = columns;
    let [roll, crank] = &mut columns.torque;
    // The force is against the acceleration of the piston away from the crank.
    let [force, moment, arm] = [sum.force, sum.moment, sum.arm].map(|sum| sum * -square);
    let [on_block, on_crank] = mechanism.senses().map(|sense| sense * square * sum.roll);
    for i in 0..BLOCK {
        let motion = proportions.motion_of::<YOKE>(&units.crank(sum.turned, i));
        if PLANAR {
            force_x[i] += force.re * motion.acceleration;
            force_y[i] += force.im * motion.acceleration;
            moment_x[i] += moment.re * motion.acceleration;
            moment_y[i] += moment.im * motion.acceleration;
        }
        if TORQUE {
            let along = motion.velocity + proportions.offset;
            roll[i] += (on_block * along + arm.im) * motion.acceleration;
            crank[i] -= on_crank * motion.velocity * motion.acceleration;
        }
    }
}

/// Multiples of the speed of a mechanism's crank up to an order of the main one.
pub(super) fn multiples(mechanism: &Mechanism, highest: Order) -> Vec<Order> {
    let halves = mechanism.ratio.halves_of_speed();
    let own = 1..=mechanism.own_highest(highest.halves());
    own.filter_map(|own| Order::from_halves(own * halves).ok()).collect()
}

/// Bound of what own orders above one add to either torque on the main crank and the block, if wanted.
pub(super) fn torque_beyond(
    mechanism: &Mechanism,
    wanted: bool,
    bound: fn(&Proportions, u32) -> Option<f64>,
    own: u32,
) -> f64 {
    if !wanted {
        return 0.0;
    }
    let bound = bound(&mechanism.proportions, own).unwrap_or(f64::INFINITY);
    bound * mechanism.ratio.size()
}

/// Torques of a mechanism on the block and on the main crank from those on its own crank.
pub(super) fn torque_by(
    mechanism: &Mechanism,
    orders: &[Order],
    of: impl FnOnce(&[u32]) -> Result<TorqueHarmonics>,
) -> Result<TorqueAmplitudes> {
    let mut crank = Vec::new();
    let mut roll = at_own_orders(mechanism.ratio, orders, |own| {
        let torque = of(own)?;
        crank = torque.crank;
        Ok(torque.roll)
    })?;
    let mut crank = at_own_orders(mechanism.ratio, orders, |_| Ok(crank))?;
    if mechanism.ratio != SpeedRatio::ONE {
        let [on_block, on_crank] = mechanism.senses();
        for (roll, crank) in roll.iter_mut().zip(&mut crank) {
            *roll *= on_block;
            *crank *= on_crank;
        }
    }
    Ok(TorqueAmplitudes { harmonics: TorqueHarmonics { roll, crank }, mean: [0.0; 2] })
}
