//! Faces of pistons on which pressure acts: which way, on which area, and from which crank angle on.
//!
//! Pressure on the outer face, at the head end, pushes a piston towards its crank; that on the inner face, at the
//! crank end, away from it. A chamber is at one face of a piston, or between faces of two. Its cycle begins where it is
//! smallest: at the outer face alone at top dead centre, as cycles count angles; at the inner one where the piston is
//! lowest; between two pistons where both together make it so ([`super::chambers`]).
//!
//! Both pressures count above that of the crankcase, which acts on what is left: below a piston whose crank end has no
//! cycle, and on the cross-section of a piston rod. So the force towards the crank is the sum of area times gauge
//! pressure over the faces, the inner area below zero, and each face's torque on its own crank is minus that times
//! the piston's velocity: p·dV/dθ.

use std::sync::Arc;

use super::{Engine, Gas};
use crate::mechanism::cylinder::ring_area;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::pressure::Cycle;
pub use crate::pressure::chamber::Face;

/// The other end of a double-acting piston than that of its cylinder's cycle: the crank end, of one that side rods drive
/// the head end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrankEnd {
    /// Index of its cycle.
    pub cycle: usize,
    /// Diameter of the piston rod, on whose cross-section the crankcase's pressure acts, m.
    pub rod_diameter: f64,
}

/// Pressure on a face of a piston.
#[derive(Debug, Clone)]
pub struct FacePressure {
    /// Which face.
    pub face: Face,
    /// Its cycle, from where the chamber is smallest on.
    pub cycle: Arc<Cycle>,
    /// Index of that among the cycles of the engine.
    pub index: usize,
    /// Absolute pressure in the crankcase, Pa.
    pub crankcase: f64,
    /// Force towards the crank over pressure above the crankcase's: the area, below zero of the inner face, m².
    pub area: f64,
    /// Angle of the main crank from top dead centre to where the chamber is smallest.
    pub delay: Angle,
    /// Crank angle at which the cycle begins, within a cycle.
    pub phase: Angle,
}

impl Engine {
    /// The face of a piston on which the cycle of its cylinder acts: the inner one where side rods drive it.
    #[must_use]
    pub fn working_face(&self, cylinder: usize) -> Face {
        if self.details[cylinder].side_rods { Face::Inner } else { Face::Outer }
    }

    /// Pressures on the faces of a piston: of its cylinder's cycle, and of its other end's.
    #[must_use]
    pub fn pressures(&self, cylinder: usize) -> Vec<FacePressure> {
        let (Some(gas), Some(bore)) = (&self.gas, self.details[cylinder].bore) else {
            return Vec::new();
        };
        let on = |face: Face, index: usize, rod_diameter: f64, delay: Angle| FacePressure {
            face,
            cycle: Arc::clone(&gas.cycles[index]),
            index,
            crankcase: gas.crankcase,
            area: face.sign() * ring_area(bore, rod_diameter),
            delay,
            phase: self.phase_after(cylinder, delay),
        };
        let own = gas.cycle_of[cylinder].map(|index| {
            let delay = self.chamber_delay(cylinder).unwrap_or(Angle::ZERO);
            on(self.working_face(cylinder), index, 0.0, delay)
        });
        let crank_end = gas.crank_end(cylinder).map(|CrankEnd { cycle, rod_diameter }| {
            let (face, delay) = match self.working_face(cylinder) {
                Face::Outer => (Face::Inner, self.lowest_after_tdc(cylinder)),
                Face::Inner => (Face::Outer, Angle::ZERO),
            };
            on(face, cycle, rod_diameter, delay)
        });
        own.into_iter().chain(crank_end).collect()
    }

    /// Mean torque of pressure on each piston on the main crank, N·m.
    pub fn mean_gas_torques(&self, cancel: &Cancel) -> Result<Vec<f64>> {
        let of = |i: usize| {
            let (mechanism, mut sum) = (self.mechanism(i), 0.0);
            let radius = self.stations[i].cylinder.crank_radius();
            for FacePressure { cycle, crankcase, area, delay, .. } in self.pressures(i) {
                let torque = cycle.delayed(delay).torque_of(&mechanism, crankcase, &[], cancel)?;
                sum += area * radius * torque.mean;
            }
            Ok(sum)
        };
        (0..self.stations.len()).map(of).collect()
    }

    /// Whether pressure acts on a piston.
    #[must_use]
    pub fn has_pressure(&self, cylinder: usize) -> bool {
        self.gas.as_ref().is_some_and(|gas| {
            gas.cycle_of[cylinder].is_some() || gas.crank_end(cylinder).is_some()
        })
    }

    /// Whether a chamber at the inner face of a piston alone is smallest elsewhere at another pin offset, and at
    /// another rod where there is one.
    pub(super) fn has_inner_chamber(&self, cylinder: usize) -> bool {
        self.details[cylinder].side_rods
            || self.gas.as_ref().is_some_and(|gas| gas.crank_end(cylinder).is_some())
    }

    /// Angle of the main crank from top dead centre to where a piston is lowest.
    pub(super) fn lowest_after_tdc(&self, cylinder: usize) -> Angle {
        let [_, lowest] = self.mechanism(cylinder).turning_points_deg();
        // An angle that is finite.
        Angle::from_degrees(lowest).unwrap_or(Angle::HALF_TURN)
    }
}

impl Gas {
    /// The crank end of a piston, where it has a cycle.
    #[must_use]
    pub fn crank_end(&self, cylinder: usize) -> Option<CrankEnd> {
        self.crank_ends.get(cylinder).copied().flatten()
    }

    /// Indices of the cycles that act somewhere.
    pub(super) fn in_use(&self) -> impl Iterator<Item = usize> + '_ {
        let crank_ends = self.crank_ends.iter().flatten().map(|end| end.cycle);
        self.cycle_of.iter().flatten().copied().chain(crank_ends)
    }

    /// Rejects crank ends that a piston cannot have.
    pub(super) fn check_crank_end(&self, engine: &Engine, cylinder: usize) -> Result<()> {
        let Some(CrankEnd { rod_diameter, .. }) = self.crank_end(cylinder) else { return Ok(()) };
        let bore = engine.details[cylinder].bore.unwrap_or(0.0);
        if (0.0..=bore).contains(&rod_diameter) {
            return Ok(());
        }
        let hint = format!("give metres from 0 to the bore, {bore:?}");
        Err(Error::figure(format!("rod_diameter[{cylinder}]"), rod_diameter, hint))
    }
}
