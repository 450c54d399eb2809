//! Loads of piston rods at their crosshead pins, or of pistons at their wrist pins, as rods of compressors are rated.

use ndarray::Array2;

pub use super::extremes::Peak;
use super::extremes::{below_zero, peaks};
use super::rod::DrivenRod;
use super::{BearingLoadsModel, check_angles, scalars};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::pool;
use crate::source::over_angle::BLOCK;

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
            let of = |theta, beside| parts(rod, theta, beside);
            let [combined, gas, inertia] = peaks(rod, of, cycle, cancel)?;
            let along = |theta, beside| parts(rod, theta, beside)[0];
            let tension_deg = below_zero(rod, along, cycle, cancel)?;
            Ok(RodLoads { combined, gas, inertia, tension_deg })
        })
    }

    /// Loads along the bore at the pin of each piston, of gas and inertia, of gas, and of inertia, at crank angles in
    /// degrees: (`n_cylinders`, `n_theta`), N.
    pub fn rod_load_curves(&self, theta_deg: &[f64], cancel: &Cancel) -> Result<[Array2<f64>; 3]> {
        let (rods, count) = (self.rods.len(), theta_deg.len());
        check_angles(theta_deg, 3 * rods, cancel)?;
        let [mut combined, mut gas, mut inertia] =
            [scalars(rods, count)?, scalars(rods, count)?, scalars(rods, count)?];
        for (i, rod) in self.rods.iter().enumerate() {
            for (k, &theta) in theta_deg.iter().enumerate() {
                if k % BLOCK == 0 {
                    cancel.check()?;
                }
                let at = [i, k];
                // Adding zero makes −0 0.
                [combined[at], gas[at], inertia[at]] =
                    parts(rod, theta, theta).map(|load| load + 0.0);
            }
        }
        Ok([combined, gas, inertia])
    }
}

/// Load along the bore at the pin of a piston, and its parts of gas and inertia, N.
fn parts(rod: &DrivenRod, theta_deg: f64, beside: f64) -> [f64; 3] {
    let forces = rod.forces_beside(theta_deg, beside);
    let [combined, _] = forces.wrist_pin;
    [combined, forces.gas, combined - forces.gas]
}
