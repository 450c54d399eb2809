//! Pressure on a piston: the forces on head, wall and bearings cancel, and a torque remains.

use std::sync::Arc;

use crate::engine::FacePressure;
use crate::engine::layout::Strokes;
use crate::mechanism::DrivenMechanism;
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::mechanism::motion::{CrankPosition, MotionColumns};
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::pressure::{Cycle, GasTorque};
use crate::source::over_angle::{AngleBlock, Columns, LoadSum, Quantities};
use crate::source::{
    ExactFactor, GAS, Parts, Point, Repeats, Scale, Scaling, Series, Source, Tail,
    TorqueAmplitudes, UpTo, is_equal,
};

/// Torque over piston area and crank radius, Pa, of a cycle of pressure above an even one, on the outer face of a
/// piston; on the inner one the area is below zero.
#[derive(Debug, Clone)]
pub(super) struct GasPressure {
    /// On a crank as fast as the main one, whose cycles these are.
    pub driven: DrivenMechanism,
    pub cycle: Arc<Cycle>,
    /// Its place among the cycles of the engine: those of a map may be equal at some speed and load alone.
    pub place: usize,
    /// How much later than those the piston meets them.
    pub delay: Angle,
    /// Absolute pressure in the crankcase, Pa.
    pub crankcase: f64,
}

/// Part of the largest torque that orders may leave out, at least: they decline slowly.
const LEAST_LEFT_OUT: f64 = 1e-3;
/// Numbers of halves up to which a torque is integrated to see how far it matters; that of a cycle in which
/// pressure jumps declines like 1/n.
const INTEGRATED: [u32; 2] = [2 * 48, 2 * 192];

impl GasPressure {
    /// Pressure on a face of a piston.
    pub fn new(driven: DrivenMechanism, pressure: &FacePressure) -> Self {
        let &FacePressure { ref cycle, index, crankcase, delay, .. } = pressure;
        Self { driven, cycle: cycle.delayed(delay), place: index, delay, crankcase }
    }

    /// Torques on the block and on the main crank.
    fn amplitudes(&self, GasTorque { mean, phasors }: GasTorque) -> TorqueAmplitudes {
        let [on_block, _] = self.driven.senses();
        let roll = phasors.iter().map(|phasor| phasor * -on_block).collect();
        let harmonics = TorqueHarmonics { roll, crank: phasors };
        TorqueAmplitudes { harmonics, mean: [-on_block * mean, mean] }
    }

    /// Largest torque among those at whole degrees.
    fn largest_torque(&self) -> f64 {
        let torque = |degrees: u32| {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let pressure = self.cycle.pressure_deg(f64::from(degrees)) - self.crankcase;
            (pressure * self.driven.mechanism.motion(&CrankPosition::new(sin, cos)).velocity).abs()
        };
        (0..720).map(torque).fold(0.0, f64::max)
    }
}

impl PartialEq for GasPressure {
    fn eq(&self, other: &Self) -> bool {
        let Self { driven, cycle, place, delay, crankcase } = self;
        (driven, place, delay, crankcase)
            == (&other.driven, &other.place, &other.delay, &other.crankcase)
            // Mostly it is one table, whose numbers need not be compared.
            && (Arc::ptr_eq(cycle, &other.cycle) || *cycle == other.cycle)
    }
}

impl Source for GasPressure {
    fn name(&self) -> &'static str {
        GAS
    }

    fn parts(&self) -> Parts {
        let repeats = match self.cycle.strokes() {
            Strokes::Two => Repeats::EveryTurn,
            Strokes::Four => Repeats::EveryTwoTurns,
        };
        Parts { force: None, roll: true, scaling: Scaling::Independent, repeats }
    }

    fn equals(&self, other: &dyn Source) -> bool {
        is_equal(self, other)
    }

    fn mechanism(&self) -> Option<&DrivenMechanism> {
        Some(&self.driven)
    }

    /// No bound of the rest is known before the orders below it are integrated.
    fn series(&self, up_to: UpTo, cancel: &Cancel) -> Result<Series> {
        let Self { driven, cycle, crankcase, .. } = self;
        let integrate = |halves: u32| {
            cycle.torque_up_to(&driven.mechanism, *crankcase, Order::from_halves(halves)?, cancel)
        };
        let step = if self.parts().repeats == Repeats::EveryTurn { 2 } else { 1 };
        let ((torque, tails), highest) = match up_to {
            UpTo::Halves(halves) => (integrate(halves.max(1))?, halves),
            UpTo::Enough(is_enough) => {
                let is_enough = |torque: &f64| is_enough(Tail { force: 0.0, torque: *torque });
                let [first, last] = INTEGRATED;
                let mut found = integrate(first)?;
                let mut place = found.1.iter().position(is_enough);
                if place.is_none() {
                    found = integrate(last)?;
                    place = found.1.iter().position(is_enough);
                }
                (found, place.map_or(last, |place| place as u32 + 1))
            }
        };
        let halves = (step..=highest).step_by(step as usize);
        let orders = halves.map(Order::from_halves).collect::<Result<Vec<_>>>()?;
        let rest = match highest {
            0 => tails[0] + torque.phasors[0].norm(),
            _ => tails[highest as usize - 1],
        };
        Ok(Series {
            torque: self.amplitudes(torque.at(&orders)),
            orders,
            rest: Tail { force: 0.0, torque: rest },
            ..Series::default()
        })
    }

    fn is_integrated(&self, orders: &[Order]) -> bool {
        let Self { driven, cycle, crankcase, .. } = self;
        !cycle.keeps_torque_of(&driven.mechanism, *crankcase, orders)
    }

    /// The forces are internal, so that either torque balances the other.
    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        let Self { driven, cycle, crankcase, .. } = self;
        let torque = cycle.torque_of(&driven.mechanism, *crankcase, orders, cancel)?;
        Ok(self.amplitudes(torque))
    }

    fn scale(&self) -> Scale {
        Scale { force: 0.0, torque: Some(self.largest_torque()), least: LEAST_LEFT_OUT }
    }

    fn at_point(&self, point: &Point) -> Result<Option<Arc<dyn Source>>> {
        let driven = self.driven.replaced(point.rod_ratio, point.pin_offset)?;
        let met = |cycles: &[Arc<Cycle>]| cycles[self.place].delayed(self.delay);
        let cycle = point.cycles.map_or_else(|| Arc::clone(&self.cycle), met);
        Ok(Some(Arc::new(Self { driven, cycle, ..*self })))
    }

    fn exact(&self) -> ExactFactor {
        ExactFactor::Cycle
    }

    fn over_angle(
        &self,
        sum: &LoadSum,
        block: &AngleBlock,
        wanted: Quantities,
        _: f64,
        columns: &mut Columns,
    ) -> Result<()> {
        if !wanted.torque {
            return Ok(());
        }
        let [on_block, on_crank] = self.driven.senses();
        let mut scratch = block.scratch();
        let [velocity, acceleration] = &mut *scratch;
        let motion = MotionColumns::of_both([velocity, acceleration]);
        let mechanism = &self.driven.mechanism;
        block.with_cranks(SpeedRatio::ONE, sum.turned, |cranks| mechanism.motions(cranks, motion));
        for (i, (θ, velocity)) in block.degrees().iter().zip(&velocity[..]).enumerate() {
            let gauge = self.cycle.pressure_deg(θ - sum.phase_deg) - self.crankcase;
            // The piston's way down is minus its distance from the crank.
            let torque = -gauge * velocity * sum.roll;
            for (column, sense) in columns.torque.iter_mut().zip([-on_block, on_crank]) {
                column[i] += sense * torque;
            }
        }
        Ok(())
    }
}
