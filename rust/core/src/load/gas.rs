//! Pressure on a piston: the forces on head, wall and bearings cancel, and a torque remains.

use std::sync::Arc;

use crate::engine::layout::Strokes;
use crate::mechanism::DrivenMechanism;
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::mechanism::motion::{CrankPosition, MotionColumns};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::pressure::{Cycle, GasTorque};
use crate::source::over_angle::{AngleBlock, Columns, LoadSum, Quantities};
use crate::source::{
    ExactFactor, GAS, Parts, Point, Repeats, Scale, Scaling, Source, SourceUpTo, Tail,
    TorqueAmplitudes, is_equal,
};

/// Torque over piston area and crank radius, Pa, of a cycle of pressure above the piston and an even one
/// below.
#[derive(Debug, Clone)]
pub(super) struct GasPressure {
    /// On a crank as fast as the main one, whose cycles these are.
    pub mechanism: DrivenMechanism,
    pub cycle: Arc<Cycle>,
    /// Its place among the cycles of the engine: those of a map may be equal at some speed and load alone.
    pub place: usize,
    /// Absolute pressure in the crankcase, Pa.
    pub crankcase: f64,
    /// Harmonics ½, 1, 1½ … as far as they are known.
    pub known: Option<GasTorque>,
}

impl PartialEq for GasPressure {
    fn eq(&self, other: &Self) -> bool {
        let Self { mechanism, cycle, place, crankcase, known } = self;
        (mechanism, place, crankcase, known)
            == (&other.mechanism, &other.place, &other.crankcase, &other.known)
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
        Some(&self.mechanism)
    }

    fn is_integrated(&self, orders: &[Order]) -> bool {
        let Self { mechanism, cycle, crankcase, known, .. } = self;
        known.as_ref().and_then(|known| known.at(orders)).is_none()
            && !cycle.keeps_torque_of(&mechanism.mechanism, *crankcase, orders)
    }

    /// The forces are internal, so that either torque balances the other.
    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        let [on_block, _] = self.mechanism.senses();
        let known = self.known.as_ref().and_then(|known| known.at(orders));
        let evaluate = || {
            let Self { mechanism, cycle, crankcase, .. } = self;
            cycle.torque_of(&mechanism.mechanism, *crankcase, orders, cancel)
        };
        let GasTorque { mean, phasors } = known.map_or_else(evaluate, Ok)?;
        let roll = phasors.iter().map(|phasor| phasor * -on_block).collect();
        let harmonics = TorqueHarmonics { roll, crank: phasors };
        Ok(TorqueAmplitudes { harmonics, mean: [-on_block * mean, mean] })
    }

    fn orders(&self, highest: Order) -> Vec<Order> {
        let step = if self.parts().repeats == Repeats::EveryTurn { 2 } else { 1 };
        let halves = (step..=highest.halves()).step_by(step as usize);
        halves.filter_map(|halves| Order::from_halves(halves).ok()).collect()
    }

    /// Of tables no bound is known before they are integrated: see [`Source::up_to`].
    fn beyond(&self, _: u32, torque: bool) -> Tail {
        Tail { force: 0.0, torque: if torque { f64::INFINITY } else { 0.0 } }
    }

    fn has_open_tail(&self) -> bool {
        true
    }

    fn up_to(&self, highest: Order, cancel: &Cancel) -> Result<Option<SourceUpTo>> {
        let Self { mechanism, cycle, crankcase, .. } = self;
        let (known, tails) =
            cycle.torque_up_to(&mechanism.mechanism, *crankcase, highest, cancel)?;
        Ok(Some((Arc::new(Self { known: Some(known), ..self.clone() }), tails)))
    }

    fn largest_torque(&self) -> f64 {
        let torque = |degrees: u32| {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let pressure = self.cycle.pressure_deg(f64::from(degrees)) - self.crankcase;
            (pressure * self.mechanism.mechanism.motion(&CrankPosition::new(sin, cos)).velocity)
                .abs()
        };
        (0..720).map(torque).fold(0.0, f64::max)
    }

    fn scale(&self) -> Scale {
        Scale { force: 0.0, torque: Some(0.0) }
    }

    fn at_point(&self, point: &Point) -> Result<Option<Arc<dyn Source>>> {
        let mechanism = self.mechanism.replaced(point.rod_ratio, point.pin_offset)?;
        let cycle = point.cycles.map_or(&self.cycle, |cycles| &cycles[self.place]);
        let (cycle, known) = (Arc::clone(cycle), None);
        Ok(Some(Arc::new(Self { mechanism, cycle, known, ..*self })))
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
        let [on_block, on_crank] = self.mechanism.senses();
        let mut scratch = block.scratch();
        let [velocity, acceleration] = &mut *scratch;
        let motion = MotionColumns::of_both([velocity, acceleration]);
        let mechanism = &self.mechanism.mechanism;
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
