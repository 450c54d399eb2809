//! Objectives of an engine on mounts that vary: decoupling of roll, purity of modes, forces.

use std::sync::Arc;

use nalgebra::Vector6;

use super::balance::Orders;
use super::mounted::Response;
use super::peaks::largest_vectors;
use crate::engine::Engine;
use crate::mounts::{Mount, Powertrain, frequency_and_purity};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;

/// Exponent of the norm that stands for a maximum, which has edges.
const SMOOTH_MAXIMUM: f64 = 8.0;

/// What varies of a mount.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MountVariable {
    /// Dynamic stiffness along its axes, N/m: three numbers; the static one changes alike.
    Stiffness,
    /// Degrees.
    Tilt,
    /// Place along x, y or z, m.
    Along(usize),
}

/// Figure to minimise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MountObjective {
    /// What keeps the reaction to a roll from a torque of the crank.
    Decoupling,
    /// What modes lack of purity.
    Purity,
    /// Force of an order on what carries the mounts.
    BodyForce(Order),
    /// That of a mount.
    MountForce(Order),
}

/// Objectives of an engine on mounts that vary.
#[derive(Debug, Clone)]
pub struct MountObjectives {
    /// The engine, if there is one.
    pub engine: Option<Engine>,
    /// The mounts, as far as they do not vary.
    pub base: Powertrain,
    /// Indices of mounts, and what varies of them.
    pub variables: Vec<(usize, MountVariable)>,
    /// What is evaluated.
    pub objectives: Vec<MountObjective>,
    /// Crank speeds of forces.
    pub rpm: Vec<f64>,
    /// Frequency at which modes take the stiffness, Hz.
    pub frequency: Option<f64>,
    /// Square of the angular speed of roll, and whether that is required.
    pub roll: (f64, bool),
}

impl MountObjectives {
    /// The powertrain with these values of the variables.
    pub fn design(&self, values: &[f64]) -> Result<Powertrain> {
        let mut mounts = self.base.mounts().to_vec();
        let mut values = values.iter().copied();
        for &(place, variable) in &self.variables {
            let mut figures = mounts[place].figures().clone();
            let mut next = || values.next().unwrap_or(f64::NAN);
            match variable {
                MountVariable::Tilt => figures.tilt_deg = next(),
                MountVariable::Along(axis) => figures.at[axis] = next(),
                MountVariable::Stiffness => {
                    let (old, new) = (figures.in_motion(), [(); 3].map(|()| next()));
                    for axis in (0..3).filter(|&axis| old[axis] > 0.0) {
                        figures.stiffness[axis] *= new[axis] / old[axis];
                    }
                    if figures.dynamic_stiffness.is_some() || old.contains(&0.0) {
                        figures.dynamic_stiffness = Some(new);
                    }
                }
            }
            mounts[place] = Mount::new(figures)?;
        }
        let powertrain = Powertrain::resting(*self.base.body(), mounts, *self.base.rest())?;
        let powertrain = powertrain.with_forces(self.base.forces().to_vec())?;
        match self.base.support() {
            Some(support) => powertrain.on(support.clone()),
            None => Ok(powertrain),
        }
    }

    /// The objectives, with norms in place of maxima.
    pub fn values(&self, values: &[f64], cancel: &Cancel) -> Result<Vec<f64>> {
        let powertrain = Arc::new(self.design(values)?);
        let value = |objective: &MountObjective| {
            let (order, of_mounts) = match *objective {
                MountObjective::Decoupling => {
                    return Ok(self.coupling(&powertrain)?.norm_squared());
                }
                MountObjective::Purity => {
                    let [_, purity] = frequency_and_purity(&powertrain, self.frequency)?;
                    return Ok(norm(purity.iter().map(|purity| 1.0 - purity / 100.0)));
                }
                MountObjective::BodyForce(order) => (order, false),
                MountObjective::MountForce(order) => (order, true),
            };
            let (orders, moving) = (vec![order], Arc::clone(&powertrain));
            let given = Orders::Given(orders.clone());
            let response = Response::new(self.engine.as_ref(), moving, &self.rpm, &given, cancel)?;
            let forces = if of_mounts {
                response.mount_forces(cancel)?
            } else {
                let sums = response.support_loads(cancel)?;
                sums.iter().map(|sum| [sum[0], sum[1], sum[2]]).collect()
            };
            let peaks = largest_vectors(&orders, &forces, cancel)?;
            let largest = peaks.iter().map(|[.., peak]| *peak).fold(0.0, f64::max);
            let shares = peaks.iter().map(|[.., peak]| peak / largest);
            Ok(if largest > 0.0 { largest * norm(shares) } else { 0.0 })
        };
        self.objectives.iter().map(value).collect()
    }

    /// Natural frequencies with these values, Hz.
    pub fn frequencies(&self, values: &[f64]) -> Result<Vec<f64>> {
        let [frequencies, _] = frequency_and_purity(&self.design(values)?, self.frequency)?;
        Ok(frequencies)
    }

    /// What keeps K̃u from ω²u, over ω² where that is required, else over the length of K̃u.
    fn coupling(&self, powertrain: &Powertrain) -> Result<Vector6<f64>> {
        let (reaction, (square, is_required)) = (powertrain.roll_reaction()?, self.roll);
        Ok(if is_required { reaction.sum / square - reaction.torque } else { reaction.across() })
    }

    /// Linear equations of decoupling in the stiffnesses that vary, with these values of all else: a column for each,
    /// and the right side.
    pub fn equations(&self, values: &[f64]) -> Result<(Vec<Vector6<f64>>, Vector6<f64>)> {
        let powertrain = self.design(values)?;
        let (reaction, square) = (powertrain.roll_reaction()?, self.roll.0);
        let (mut columns, mut right) = (Vec::new(), reaction.torque - reaction.sum / square);
        for &(place, variable) in &self.variables {
            if variable == MountVariable::Stiffness {
                let stiffness = powertrain.mounts()[place].figures().in_motion();
                for (column, stiffness) in reaction.of_axes[place].iter().zip(stiffness) {
                    columns.push(column / square);
                    right += column * (stiffness / square);
                }
            }
        }
        Ok((columns, right))
    }
}

/// Mean of powers, which tends to the maximum of magnitudes.
fn norm(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    let sum: f64 = values.map(|value| value.abs().powf(SMOOTH_MAXIMUM)).sum();
    (sum / count).powf(1.0 / SMOOTH_MAXIMUM)
}
