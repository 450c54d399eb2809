//! How far natural frequencies and the purity of modes go within tolerances.
//!
//! K grows by a positive semidefinite matrix with each stiffness, and M with mass and inertia, so that by
//! Courant and Fischer's theorem every frequency is monotone in each of them: its bounds are at the two ends,
//! with no corner between. Purity is not monotone; there every corner counts.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::modes::{NaturalModes, dynamic, natural, purities};
use super::{Powertrain, real};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::pool;

/// Figures at two ends each of which corners are taken: a quarter of a million.
const MOST_PARAMETERS: usize = 18;
/// Corners computed between two checks for cancellation.
const CORNERS_PER_TASK: usize = 256;

/// Tolerances of a powertrain.
#[derive(Debug, Clone, PartialEq)]
pub struct MountTolerances {
    /// Of the stiffness of each mount, over it.
    pub stiffness: Vec<f64>,
    /// Of the mass, over it.
    pub mass: f64,
    /// Of the tensor of inertia, over it.
    pub inertia: f64,
    /// Of the centre of gravity along x, y and z, m.
    pub cg: f64,
    /// Whether the axes of a mount are stiff or soft each by itself in corners.
    pub by_axis: bool,
}

/// What tolerances do.
#[derive(Debug, Clone, PartialEq)]
pub struct Robustness {
    /// Hz, without tolerances.
    pub frequency: [f64; 6],
    /// Least and largest frequencies within the tolerance of stiffness.
    pub by_stiffness: [[f64; 6]; 2],
    /// Within that of mass and inertia.
    pub by_mass: [[f64; 6]; 2],
    /// Of the eight corners of the centre of gravity, and its own place.
    pub by_cg: [[f64; 6]; 2],
    /// Derivatives by the place of the centre of gravity along x, y, z, Hz/m; of modes of one frequency the
    /// mean.
    pub cg_slope: [[f64; 6]; 3],
    /// %, without tolerances.
    pub purity: [f64; 6],
    /// Least at the corners of stiffness.
    pub least_purity: [f64; 6],
    /// The corner at which it is: whether each axis of each mount is at the upper end.
    pub corner: [Vec<[bool; 3]>; 6],
}

/// Evaluate tolerances with the stiffness at a frequency, Hz.
pub fn robustness(
    powertrain: &Powertrain,
    tolerances: &MountTolerances,
    frequency: Option<f64>,
    cancel: &Cancel,
) -> Result<Robustness> {
    let count = powertrain.mounts().len();
    limits::same_length("stiffness", tolerances.stiffness.len(), "mounts", count, "mount")?;
    let shares = [("mass", tolerances.mass), ("inertia", tolerances.inertia)];
    let of_mounts = tolerances.stiffness.iter().map(|&share| ("stiffness", share));
    for (name, share) in shares.into_iter().chain(of_mounts) {
        if !(0.0..1.0).contains(&share) {
            let hint = "give a tolerance over the figure itself: 0.1 for ±10 %, less than 1";
            return Err(Error::figure(name, share, hint));
        }
    }
    limits::distance("cg", tolerances.cg)?;
    let (_, stiffnesses) = dynamic(powertrain, frequency)?;
    let along = real(&stiffnesses);
    let nominal = natural(powertrain, &along)?;
    let scaled = |sign: f64| -> Vec<[f64; 3]> {
        let each = along.iter().zip(&tolerances.stiffness);
        each.map(|(along, share)| along.map(|k| k * (1.0 + sign * share))).collect()
    };
    let frequencies = |modes: &NaturalModes| modes.omega.map(|omega| omega / TAU);
    let [low, high] = [-1.0, 1.0].map(|sign| natural(powertrain, &scaled(sign)));
    let body = powertrain.body();
    let heavier = |sign: f64| {
        let body = body.scaled(1.0 + sign * tolerances.mass, 1.0 + sign * tolerances.inertia);
        let other = Powertrain::new(body, powertrain.mounts().to_vec())?;
        natural(&other, &along).map(|modes| frequencies(&modes))
    };
    let mut by_cg = [frequencies(&nominal); 2];
    for corner in 0..8_u32 {
        let sign = |axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
        let shift = Vector3::new(sign(0), sign(1), sign(2)) * tolerances.cg;
        let other = Powertrain::new(body.at(body.cg() + shift), powertrain.mounts().to_vec())?;
        let found = frequencies(&natural(&other, &along)?);
        for mode in 0..6 {
            by_cg[0][mode] = by_cg[0][mode].min(found[mode]);
            by_cg[1][mode] = by_cg[1][mode].max(found[mode]);
        }
    }
    let (least_purity, corner) = corners(powertrain, tolerances, &along, cancel)?;
    Ok(Robustness {
        frequency: frequencies(&nominal),
        by_stiffness: [frequencies(&low?), frequencies(&high?)],
        by_mass: [heavier(1.0)?, heavier(-1.0)?],
        by_cg,
        cg_slope: slopes(powertrain, &nominal),
        purity: purities(powertrain, &nominal),
        least_purity,
        corner,
    })
}

/// Derivatives of the frequencies by the place of the CG: −f m u·(φ × e) of a mode of unit mass.
fn slopes(powertrain: &Powertrain, modes: &NaturalModes) -> [[f64; 6]; 3] {
    let mass = powertrain.body().mass();
    let group = modes.groups();
    [0, 1, 2].map(|axis| {
        let unit = Vector3::ith(axis, 1.0);
        let each = [0, 1, 2, 3, 4, 5].map(|mode| {
            let shape = modes.shapes.column(mode);
            let shift: Vector3<f64> = shape.fixed_rows::<3>(0).into();
            let turn: Vector3<f64> = shape.fixed_rows::<3>(3).into();
            -modes.omega[mode] / TAU * mass * shift.dot(&turn.cross(&unit)) + 0.0
        });
        [0, 1, 2, 3, 4, 5].map(|mode| {
            let members = (0..6).filter(|&other| group[other] == group[mode]);
            let (sum, count) = members.fold((0.0, 0.0), |(s, n), k| (s + each[k], n + 1.0));
            sum / count
        })
    })
}

/// Whether the stiffness of each mount along each axis is at its upper end.
type Corner = Vec<[bool; 3]>;

/// Least purity of each mode at the corners of stiffness, and the corner.
fn corners(
    powertrain: &Powertrain,
    tolerances: &MountTolerances,
    along: &[[f64; 3]],
    cancel: &Cancel,
) -> Result<([f64; 6], [Corner; 6])> {
    // Directions that are at one end together.
    let mut parameters: Vec<Vec<(usize, usize)>> = Vec::new();
    for (mount, _) in tolerances.stiffness.iter().enumerate().filter(|(_, share)| **share > 0.0) {
        let axes = (0..3).filter(|&axis| along[mount][axis] > 0.0).map(|axis| (mount, axis));
        if tolerances.by_axis {
            parameters.extend(axes.map(|place| vec![place]));
        } else {
            parameters.push(axes.collect());
        }
    }
    let count = parameters.len();
    if count > MOST_PARAMETERS {
        let (argument, hint) = if tolerances.by_axis {
            ("corners", "give corners=\"mounts\", where the axes of a mount go together")
        } else {
            ("stiffness", "give tolerances of fewer mounts")
        };
        let value = format!("2 to the power of {count} corners");
        return Err(Error::value(argument, value, format!("are too many: {hint}")));
    }
    let at = |corner: usize| -> (Vec<[f64; 3]>, Vec<[bool; 3]>) {
        let (mut along, mut upper) = (along.to_vec(), vec![[false; 3]; along.len()]);
        for (bit, places) in parameters.iter().enumerate() {
            let is_upper = corner >> bit & 1 == 1;
            for &(mount, axis) in places {
                let share = tolerances.stiffness[mount];
                along[mount][axis] *= if is_upper { 1.0 + share } else { 1.0 - share };
                upper[mount][axis] = is_upper;
            }
        }
        (along, upper)
    };
    let all = 1_usize << count;
    let tasks: Vec<usize> = (0..all.div_ceil(CORNERS_PER_TASK)).collect();
    let found = pool::map(cancel, tasks, |task| {
        let first = task * CORNERS_PER_TASK;
        let mut least = [(f64::INFINITY, 0); 6];
        for corner in first..(first + CORNERS_PER_TASK).min(all) {
            if corner.is_multiple_of(16) {
                cancel.check()?;
            }
            let purity = purities(powertrain, &natural(powertrain, &at(corner).0)?);
            for (least, purity) in least.iter_mut().zip(purity) {
                if purity < least.0 {
                    *least = (purity, corner);
                }
            }
        }
        Ok(least)
    })?;
    let of_mode = |mode: usize| {
        let first = (f64::INFINITY, 0);
        found
            .iter()
            .fold(first, |least, task| if task[mode].0 < least.0 { task[mode] } else { least })
    };
    let least = [0, 1, 2, 3, 4, 5].map(of_mode);
    Ok((least.map(|(purity, _)| purity), least.map(|(_, corner)| at(corner).1)))
}
