//! Decoupling of roll: the mounts' reaction to a roll about the torque roll axis.
//!
//! A torque of the crank excites one mode alone iff K(0, t) ∥ (0, `e_z`) with t = `I⁻¹e_z` (Jeong and Singh, J. Sound
//! Vib. 235 (2000)): in coordinates of unit mass, with u the direction of the torque, K̃u = ω²u. These equations are
//! linear in the stiffnesses.

use std::f64::consts::TAU;

use nalgebra::Vector6;

use super::{Powertrain, Spring, modes};
use crate::numbers::error::Result;

/// Reaction of mounts to a roll about the torque roll axis, in coordinates of unit mass.
#[derive(Debug, Clone, PartialEq)]
pub struct RollReaction {
    /// Direction u of a torque of the crank.
    pub torque: Vector6<f64>,
    /// What a stiffness of 1 N/m of each axis of each mount, and of 1 N·m/rad about them, adds to K̃u.
    pub of_axes: Vec<[Vector6<f64>; 3]>,
    /// K̃u with the mounts' dynamic stiffness, without loss.
    pub sum: Vector6<f64>,
}

impl Powertrain {
    /// The mounts' reaction to a roll about the torque roll axis.
    pub fn roll_reaction(&self) -> Result<RollReaction> {
        let unit = self.unit_mass()?;
        let torque: Vector6<f64> = unit.row(5).transpose().normalize();
        let mut sum = Vector6::zeros();
        let of_spring = |(spring, deflection): (Spring<'_>, &nalgebra::Matrix3x6<f64>)| {
            let (rows, stiffness) = (deflection * unit, spring.in_motion());
            [0, 1, 2].map(|axis| {
                let row: Vector6<f64> = rows.row(axis).transpose();
                let reaction = row * row.dot(&torque);
                sum += reaction * stiffness[axis];
                reaction
            })
        };
        let of_axes = self.springs().zip(&self.deflections).map(of_spring).collect();
        Ok(RollReaction { torque, of_axes, sum })
    }

    /// Largest share of a mode, or of modes of one frequency, in the effect of a torque of the crank, %.
    pub fn torque_in_one_mode(&self, frequency: Option<f64>) -> Result<f64> {
        let modes = modes(self, frequency)?;
        let mut shares = vec![0.0; modes.group.len()];
        for (&group, turn) in modes.group.iter().zip(&modes.shapes.row(5)) {
            shares[group] += turn * turn;
        }
        let largest = shares.iter().copied().fold(0.0, f64::max);
        Ok(100.0 * largest / shares.iter().sum::<f64>())
    }
}

impl RollReaction {
    /// The part of the reaction that is no torque of the crank, over its length.
    #[must_use]
    pub fn across(&self) -> Vector6<f64> {
        let across = self.sum - self.torque * self.torque.dot(&self.sum);
        let length = self.sum.norm();
        if length > 0.0 { across / length } else { across }
    }

    /// Frequency of a roll about the torque roll axis, Hz.
    #[must_use]
    pub fn frequency(&self) -> f64 {
        self.torque.dot(&self.sum).max(0.0).sqrt() / TAU
    }
}
