//! Inertia of a connecting rod beyond that of its two masses: a torque alone.

use std::sync::Arc;

use super::piston::{multiples, sizes_up_to_own, torque_beyond, torque_by};
use crate::mechanism::exact::TorqueKey;
use crate::mechanism::motion::Swing;
use crate::mechanism::{DrivenMechanism, HarmonicsOf};
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::simd::vectorised;
use crate::source::over_angle::{AngleBlock, BLOCK, Columns, LoadSum, Quantities, add_inertia};
use crate::source::{
    Column, ExactFactor, INERTIA, Parts, Point, Scale, Series, Source, Tail, TorqueAmplitudes,
    UpTo, is_equal,
};

/// Torque over the rod's inertia and ω².
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RodInertia(pub DrivenMechanism);

impl RodInertia {
    /// What orders above a number of halves add.
    fn rest(&self, halves: u32) -> Tail {
        let bound = self.0.mechanism.swing_torque_beyond(self.0.own_highest(halves));
        Tail { force: 0.0, torque: torque_beyond(&self.0, bound) }
    }
}

impl Source for RodInertia {
    fn name(&self) -> &'static str {
        INERTIA
    }

    fn parts(&self) -> Parts {
        Parts::inertia(None, true)
    }

    fn equals(&self, other: &dyn Source) -> bool {
        is_equal(self, other)
    }

    fn mechanism(&self) -> Option<&DrivenMechanism> {
        Some(&self.0)
    }

    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        torque_by(&self.0, orders, |own| self.0.mechanism.swing_torque(own, cancel))
    }

    fn series(&self, up_to: UpTo, _: &Cancel) -> Result<Series> {
        Ok(multiples(&self.0, up_to, |halves| self.rest(halves)))
    }

    /// Of order 1 it makes about J·r/l.
    fn scale(&self) -> Scale {
        Scale { torque: Some(self.0.mechanism.rod_ratio()), ..Scale::default() }
    }

    fn sizes_up_to_own(
        &self,
        column: Column,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Option<[Vec<f64>; 2]>> {
        let (of, rest) = (HarmonicsOf::SwingTorque, |halves| self.rest(halves));
        sizes_up_to_own(self, &self.0, (of, column), orders, rest, cancel).map(Some)
    }

    fn at_point(&self, point: &Point) -> Result<Option<Arc<dyn Source>>> {
        Ok(Some(Arc::new(Self(self.0.replaced(point.rod_ratio, point.pin_offset)?))))
    }

    fn exact(&self) -> ExactFactor {
        ExactFactor::Motion(TorqueKey::Swing)
    }

    fn over_angle(
        &self,
        sum: &LoadSum,
        block: &AngleBlock,
        wanted: Quantities,
        square: f64,
        columns: &mut Columns,
    ) -> Result<()> {
        if !wanted.torque {
            return Ok(());
        }
        let mut scratch = block.scratch();
        let [velocity, acceleration] = &mut *scratch;
        block.with_cranks(sum.ratio, sum.turned, |cranks| {
            self.0.mechanism.swings(cranks, [&mut velocity[..], &mut acceleration[..]]);
        });
        let [on_block, on_crank] = self.0.senses().map(|sense| sense * square * sum.roll);
        let [roll, crank] = &mut columns.torque;
        vectorised(
            #[inline(always)]
            || {
                for i in 0..BLOCK {
                    let swing = Swing { velocity: velocity[i], acceleration: acceleration[i] };
                    roll[i] += on_block * swing.roll();
                    crank[i] += on_crank * swing.crank();
                }
            },
        );
        Ok(())
    }

    fn add_inertia(&self, sum: &LoadSum, angles: &CrankAngles, into: [&mut [f64]; 2]) {
        add_inertia(&self.0, sum, angles, into, |cranks, swing| {
            self.0.mechanism.swings(cranks, swing);
        });
    }
}
