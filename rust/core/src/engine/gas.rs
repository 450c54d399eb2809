//! Gas pressure in the cylinders of an engine: cycles, and the crank angles at which they fire.

use std::sync::Arc;

use super::faces::CrankEnd;
use super::layout::Strokes;
use super::{CrankIndex, Engine, check_each_cylinder};
use crate::mechanism::cylinder::piston_area;
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::ListIndex;
use crate::numbers::limits;
use crate::pressure::{ATMOSPHERE, Cycle};

/// Pressure in the cylinders of an engine.
#[derive(Debug, Clone, PartialEq)]
pub struct Gas {
    /// Cycles that differ; cylinders refer to them by index.
    pub cycles: Vec<Arc<Cycle>>,
    /// Index of each cylinder's cycle; none where pressure never differs from the crankcase's.
    pub cycle_of: Vec<Option<usize>>,
    /// Of each double-acting piston its crank end; none at all where the list is empty.
    pub crank_ends: Vec<Option<CrankEnd>>,
    /// Absolute pressure in the crankcase, Pa.
    pub crankcase: f64,
    /// Whether each cylinder fires at its top dead centre in the second turn of the cycle.
    pub later: Vec<bool>,
}

impl Engine {
    /// Pressure in the cylinders, if it counts.
    #[must_use]
    pub fn gas(&self) -> Option<&Gas> {
        self.gas.as_ref()
    }

    /// The same engine with pressure in its cylinders, or without where no cylinder has a cycle.
    ///
    /// [`crate::Firing::fires_in_second_turn`] is what an engine's firing order says.
    pub fn with_gas(&self, gas: Gas) -> Result<Self> {
        check_each_cylinder("cycle", gas.cycle_of.len(), self.stations.len())?;
        check_each_cylinder("later", gas.later.len(), self.stations.len())?;
        if !gas.crank_ends.is_empty() {
            check_each_cylinder("crank_end", gas.crank_ends.len(), self.stations.len())?;
        }
        limits::not_negative("crankcase", gas.crankcase)?;
        let firing = gas.in_use().next().is_some();
        // One way to say that there is none.
        let has_crank_ends = gas.crank_ends.iter().any(Option::is_some);
        let gas =
            Gas { crank_ends: if has_crank_ends { gas.crank_ends } else { Vec::new() }, ..gas };
        Self { gas: firing.then_some(gas), ..self.clone() }.with_known_torque()
    }

    /// The same engine with one cycle in every cylinder but dummy pistons, those that fire in the second
    /// turn marked.
    pub fn fired_by(&self, cycle: Arc<Cycle>, later: Vec<bool>) -> Result<Self> {
        let cycle_of = self.details.iter().map(|of| (!of.dummy).then_some(0)).collect();
        let (cycles, crank_ends) = (vec![cycle], Vec::new());
        self.with_gas(Gas { cycles, cycle_of, crank_ends, crankcase: ATMOSPHERE, later })
    }

    /// Whether a cylinder fires: of an engine with cycles those that have one, without any all but
    /// dummy pistons.
    #[must_use]
    pub fn fires(&self, cylinder: usize) -> bool {
        let has_cycle = self.gas.as_ref().is_none_or(|gas| gas.cycle_of[cylinder].is_some());
        has_cycle && !self.details[cylinder].dummy
    }

    /// Whether all cylinders but dummy pistons are on cranks as fast as the main one, whose cycles are theirs.
    #[must_use]
    pub fn fires_in_main_cycles(&self) -> bool {
        let is_slow = |(of, &crank): (&super::Details, &CrankIndex)| {
            of.dummy || self.cranks[crank].ratio.is_crank_speed()
        };
        self.details.iter().zip(&self.crank_of).all(is_slow)
    }

    /// Index of a cylinder's cycle, where pressure counts.
    #[must_use]
    pub fn cycle_of(&self, cylinder: usize) -> Option<usize> {
        self.gas.as_ref()?.cycle_of[cylinder]
    }

    /// Whether each cylinder fires at its top dead centre in the second turn of the cycle, where that is
    /// known: of an engine with pressure, and where another schedule than the most even was chosen.
    #[must_use]
    pub fn turns(&self) -> Option<&[bool]> {
        self.gas.as_ref().map(|gas| &gas.later).or(self.turns.as_ref()).map(Vec::as_slice)
    }

    /// The same engine with the turns in which its cylinders fire, in its firing order; none for those of
    /// the most even schedule.
    pub fn with_turns(&self, turns: Option<Vec<bool>>) -> Result<Self> {
        if let Some(turns) = &turns {
            check_each_cylinder("later", turns.len(), self.stations.len())?;
        }
        Ok(Self { turns, ..self.clone() })
    }

    /// Turns that were chosen.
    #[must_use]
    pub fn chosen_turns(&self) -> Option<&[bool]> {
        self.turns.as_deref()
    }

    /// Crank angle at which a cylinder's cycle begins: its firing top dead centre, within a cycle, and so much later
    /// as a chamber is smallest that it shares.
    #[must_use]
    pub fn firing_phase(&self, cylinder: usize) -> Angle {
        let delay = self.chamber_delay(cylinder);
        delay.map_or_else(|| self.firing_tdc(cylinder), |delay| self.phase_after(cylinder, delay))
    }

    /// Crank angle so much after the firing top dead centre, within a cycle.
    pub(super) fn phase_after(&self, cylinder: usize, delay: Angle) -> Angle {
        let tdc = self.firing_tdc(cylinder);
        if delay == Angle::ZERO { tdc } else { (tdc + delay).reduced_to(self.strokes.turns()) }
    }

    /// Crank angle at which a cylinder is at its firing top dead centre, within a cycle.
    pub(crate) fn firing_tdc(&self, cylinder: usize) -> Angle {
        let later = self.gas.as_ref().is_some_and(|gas| gas.later[cylinder]);
        self.stations[cylinder].tdc + Angle::whole_turns(i32::from(later))
    }

    /// Moves the top dead centre of a cylinder on by an angle, and its firing with it.
    pub(super) fn delay(&mut self, cylinder: usize, by: Angle) {
        let tdc = &mut self.stations[cylinder].tdc;
        let moved = *tdc + by;
        *tdc = moved.reduced();
        let crossed = ((moved.degrees() - tdc.degrees()) / 360.0).round();
        if self.strokes == Strokes::Four && crossed % 2.0 != 0.0 {
            let of_gas = self.gas.as_mut().map(|gas| &mut gas.later);
            for later in of_gas.into_iter().chain(&mut self.turns) {
                later[cylinder] = !later[cylinder];
            }
        }
    }

    /// The same engine without pressure in its cylinders.
    #[must_use]
    pub fn without_gas(&self) -> Self {
        Self { gas: None, ..self.clone() }
    }

    /// The engine; rejects cylinders whose pressure has no torque that is known.
    pub(super) fn with_known_torque(self) -> Result<Self> {
        let Some(gas) = &self.gas else { return Ok(self) };
        let crank_ends = (0..self.stations.len()).map(|i| gas.crank_end(i).map(|end| end.cycle));
        for (i, crank_end) in crank_ends.enumerate() {
            let named = [("cycle_of", gas.cycle_of[i]), ("crank_end", crank_end)];
            for (name, index) in named {
                let Some(index) = index else { continue };
                let Some(cycle) = gas.cycles.get(index) else {
                    let hint = format!("give the index of a cycle, below {}", gas.cycles.len());
                    return Err(Error::value(format!("{name}[{i}]"), index, hint));
                };
                self.check_strokes(i, cycle)?;
            }
            if named.iter().all(|(_, index)| index.is_none()) {
                continue;
            }
            if self.details[i].dummy {
                let hint = "a dummy piston has no gas; give None in its place";
                return Err(Error::value(format!("cycle[{i}]"), "a cycle", hint));
            }
            if self.details[i].bore.is_none() {
                let hint = "gas pressure needs the bore of each cylinder, m";
                return Err(Error::value(format!("cylinder[{i}].bore"), "None", hint));
            }
            gas.check_crank_end(&self, i)?;
            self.check_cycle_is_of_main_crank(i, "gas pressure counts")?;
        }
        self.check_shared_pressure(gas)?;
        Ok(self)
    }

    /// Rejects a cylinder whose crank does not turn as fast as the main one: its cycles are other ones.
    pub(crate) fn check_cycle_is_of_main_crank(&self, cylinder: usize, what: &str) -> Result<()> {
        let crank = self.crank_of[cylinder];
        let ratio = self.cranks[crank].ratio;
        if ratio.is_crank_speed() {
            return Ok(());
        }
        let hint = format!("{what} on cranks of ratio 1 or -1, whose cycles are the main crank's");
        Err(Error::value(format!("cranks[{}].ratio", crank.position()), ratio, hint))
    }

    /// Rejects a cycle of other strokes than the engine's, by its place in a list.
    fn check_strokes(&self, place: usize, cycle: &Cycle) -> Result<()> {
        if cycle.strokes() == self.strokes {
            return Ok(());
        }
        let hint = format!(
            "the engine's strokes are {}: give a cycle of as many, or an engine with `strokes: {}`",
            self.strokes.number(),
            cycle.strokes().number()
        );
        Err(Error::value(format!("cycle[{place}].strokes"), cycle.strokes().number(), hint))
    }

    /// Rejects cycles that cannot replace those of the engine.
    pub(crate) fn check_cycles(&self, cycles: &[Arc<Cycle>]) -> Result<()> {
        let own = self.gas.as_ref().map_or(0, |gas| gas.cycles.len());
        if cycles.len() != own {
            let hint = format!("give one in place of each cycle of the engine: {own}");
            return Err(Error::value("cycles", cycles.len(), hint));
        }
        cycles.iter().enumerate().try_for_each(|(k, cycle)| self.check_strokes(k, cycle))
    }

    /// Area of a piston times its crank radius, m³; none where the bore is not known.
    #[must_use]
    pub fn swept_by_radius(&self, cylinder: usize) -> Option<f64> {
        let radius = self.stations[cylinder].cylinder.crank_radius();
        self.details[cylinder].bore.map(|bore| piston_area(bore) * radius)
    }
}
