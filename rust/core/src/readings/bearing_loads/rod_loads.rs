//! Loads of piston rods at their crosshead pins, or of pistons at their wrist pins, as rods of compressors are rated.

use super::BearingLoadsModel;
pub use super::extremes::Peak;
use super::extremes::{below_zero, peaks};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::pool;

/// Loads along the bore at the pin of one piston over a cycle, compression above zero: least and largest, N.
#[derive(Debug, Clone, PartialEq)]
pub struct RodLoads {
    /// Of gas and of the inertia of what is outboard of the pin.
    pub combined: [Peak; 2],
    /// Of gas alone.
    pub gas: [Peak; 2],
    /// Of inertia alone.
    pub inertia: [Peak; 2],
    /// Ranges of crank angles in which the combined load is tension, degrees.
    pub tension_deg: Vec<[f64; 2]>,
}

impl BearingLoadsModel {
    /// Those of each piston, over a cycle in degrees.
    pub fn rod_loads(&self, cycle_deg: u32, cancel: &Cancel) -> Result<Vec<RodLoads>> {
        let cycle = f64::from(cycle_deg);
        pool::map(cancel, self.rods.iter().collect(), |rod| {
            let parts = |theta, beside| {
                let forces = rod.forces_beside(theta, beside);
                let [combined, _] = forces.wrist_pin;
                [combined, forces.gas, combined - forces.gas]
            };
            let [combined, gas, inertia] = peaks(rod, parts, cycle, cancel)?;
            let along = |theta, beside| parts(theta, beside)[0];
            let tension_deg = below_zero(rod, along, cycle, cancel)?;
            Ok(RodLoads { combined, gas, inertia, tension_deg })
        })
    }
}
