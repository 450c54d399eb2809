//! Shear and bending of crank and crankcase along z.

use ndarray::{Array3, Axis};

use super::{BearingLoadsModel, Periodic, check_angles, vectors};
use crate::engine::CrankIndex;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::{CrankAngles, parts};
use crate::numbers::error::Result;
use crate::source::over_angle::BLOCK;

/// What is cut at some z.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CutPart {
    /// A crankshaft, which rods and unbalances load and main bearings support.
    Crank(CrankIndex),
    /// The crankcase, which main bearings, walls, heads and balance shafts load.
    Crankcase,
}

/// Shear and bending moment along z, at given crank angles.
#[derive(Debug, Clone, PartialEq)]
pub struct Sections {
    /// Sum of the loads up to each place and at it, along x and y, N: (`n_places`, `n_theta`, 2).
    pub shear: Array3<f64>,
    /// Moment of the loads in front of each place about it, about x and y, N·m: (`n_places`,
    /// `n_theta`, 2).
    pub bending: Array3<f64>,
}

impl BearingLoadsModel {
    /// Shear and bending of a part at [`Self::places`].
    pub fn sections(&self, part: CutPart, theta_deg: &[f64], cancel: &Cancel) -> Result<Sections> {
        let (z, count) = (self.places(), theta_deg.len());
        check_angles(theta_deg, 4 * z.len(), cancel)?;
        let loads = self.loads(theta_deg, cancel)?;
        let (mut shear, mut bending) = (vectors(z.len(), count)?, vectors(z.len(), count)?);
        let at = |place: f64| z.partition_point(|&other| other < place);
        let (sign, turning) = match part {
            CutPart::Crank(crank) => (-1.0, &self.on_cranks[crank]),
            CutPart::Crankcase => (1.0, &self.on_crankcase),
        };
        let is_cut = |crank: CrankIndex| matches!(part, CutPart::Crank(cut) if cut == crank);
        for (main, row) in self.mains.iter().zip(loads.main.outer_iter()) {
            if part == CutPart::Crankcase || is_cut(main.crank) {
                shear.index_axis_mut(Axis(0), at(main.z)).scaled_add(sign, &row);
            }
        }
        for (i, rod) in self.rods.iter().enumerate() {
            cancel.check()?;
            let mut sum = shear.index_axis_mut(Axis(0), at(rod.z));
            if part != CutPart::Crankcase {
                if is_cut(rod.crank) && rod.is_on_crankpin() {
                    sum += &loads.crankpin.index_axis(Axis(0), i);
                }
                continue;
            }
            let (gas, thrust) = (loads.gas.row(i), loads.side_thrust.row(i));
            for ((mut sum, &gas), &thrust) in sum.outer_iter_mut().zip(gas).zip(thrust) {
                let force = rod.vector([gas, -thrust]);
                sum[0] += force.re;
                sum[1] += force.im;
            }
        }
        for load in turning {
            let mut sum = shear.index_axis_mut(Axis(0), at(load.z));
            for range in parts(0..count, BLOCK) {
                cancel.check()?;
                let angles = CrankAngles::of_checked(&theta_deg[range.clone()]);
                let [mut x, mut y] = [[0.0; BLOCK]; 2];
                Periodic::add(&load.waves, &angles, [&mut x, &mut y])?;
                for (at, (x, y)) in range.zip(x.iter().zip(&y[..])) {
                    sum[[at, 0]] += x;
                    sum[[at, 1]] += y;
                }
            }
        }
        for (k, ends) in z.windows(2).enumerate() {
            cancel.check()?;
            let (before, mut after) = shear.view_mut().split_at(Axis(0), k + 1);
            let before = before.index_axis(Axis(0), k);
            after.index_axis_mut(Axis(0), 0).scaled_add(1.0, &before);
            let (front, mut behind) = bending.view_mut().split_at(Axis(0), k + 1);
            let mut moment = behind.index_axis_mut(Axis(0), 0);
            moment.assign(&front.index_axis(Axis(0), k));
            // The loads in front are farther off by so much: r × F with r towards the front.
            let farther = ends[1] - ends[0];
            moment.column_mut(0).scaled_add(farther, &before.column(1));
            moment.column_mut(1).scaled_add(-farther, &before.column(0));
        }
        Ok(Sections { shear, bending })
    }
}
