//! Exact kinematics of an engine at one bank angle: all that does not depend on the rod is worked out
//! once for many points.

use crate::kinematics::{Alike, BLOCK, Column, Kinematics, Units};
use crate::rod::Swing;
use crate::slider_crank::{Crank, Proportions};

/// An engine at one bank angle.
pub(super) struct Placed {
    pub kinematics: Kinematics,
    /// Slider-cranks of its groups at a point of rod ratio and offset, and ω² of its rows.
    pub points: Vec<(Vec<Proportions>, Vec<f64>)>,
}

impl Placed {
    /// Force (0) or moment (1).
    #[inline(always)]
    pub fn planar<'o>(
        &self,
        which: usize,
        units: &Units,
        outs: &mut impl Iterator<Item = &'o mut [f64]>,
    ) {
        let cranks: Vec<Cranks> =
            self.kinematics.groups.iter().map(|alike| Cranks::new(alike, units)).collect();
        let (mut turning_x, mut turning_y) = (Column::ZERO, Column::ZERO);
        units.add_turning(self.kinematics.rotating[which], [&mut turning_x, &mut turning_y]);
        for (proportions, squares) in &self.points {
            let (mut x, mut y) = (turning_x.clone(), turning_y.clone());
            for ((alike, cranks), proportions) in
                self.kinematics.groups.iter().zip(&cranks).zip(proportions)
            {
                let along = alike.along[which];
                for i in 0..BLOCK {
                    let acceleration = proportions.motion_at(&cranks.at(i)).acceleration;
                    x[i] = along.re.mul_add(acceleration, x[i]);
                    y[i] = along.im.mul_add(acceleration, y[i]);
                }
            }
            for (&square, out) in squares.iter().zip(&mut *outs) {
                write_pairs(square, &x, &y, out);
            }
        }
    }

    /// Roll torque on the block, or torque on the crank.
    #[inline(always)]
    pub fn torque<'o>(
        &self,
        on_crank: bool,
        units: &Units,
        outs: &mut impl Iterator<Item = &'o mut [f64]>,
    ) {
        let cranks: Vec<Cranks> =
            self.kinematics.groups.iter().map(|alike| Cranks::new(alike, units)).collect();
        for (proportions, squares) in &self.points {
            let mut sum = Column::ZERO;
            for ((alike, cranks), proportions) in
                self.kinematics.groups.iter().zip(&cranks).zip(proportions)
            {
                let (weight, offset) = if on_crank {
                    (-alike.torque, 0.0)
                } else {
                    (alike.torque, proportions.offset)
                };
                for (i, sum) in sum.iter_mut().enumerate() {
                    let motion = proportions.motion_at(&cranks.at(i));
                    let torque = weight * motion.acceleration;
                    *sum = torque.mul_add(motion.velocity + offset, *sum);
                }
                if alike.rod_inertia != 0.0 {
                    for (i, sum) in sum.iter_mut().enumerate() {
                        let swing = Swing::new(proportions, &cranks.at(i));
                        let torque = if on_crank { swing.crank() } else { swing.roll() };
                        *sum = alike.rod_inertia.mul_add(torque, *sum);
                    }
                }
            }
            for (&square, out) in squares.iter().zip(&mut *outs) {
                for (out, sum) in out.iter_mut().zip(&sum[..]) {
                    *out = square * sum;
                }
            }
        }
    }
}

/// Where the cranks of cylinders that move alike stand.
struct Cranks {
    sin: Column,
    cos: Column,
    squared: Column,
    to_above: Column,
    to_below: Column,
}

impl Cranks {
    #[inline(always)]
    fn new(alike: &Alike, units: &Units) -> Self {
        let mut cranks = Self {
            sin: Column::ZERO,
            cos: Column::ZERO,
            squared: Column::ZERO,
            to_above: Column::ZERO,
            to_below: Column::ZERO,
        };
        for i in 0..BLOCK {
            let crank = units.crank(alike.phase, i);
            cranks.sin[i] = crank.sin;
            cranks.cos[i] = crank.cos;
            cranks.squared[i] = crank.squared;
            cranks.to_above[i] = crank.to_above;
            cranks.to_below[i] = crank.to_below;
        }
        cranks
    }

    #[inline(always)]
    fn at(&self, i: usize) -> Crank {
        Crank {
            sin: self.sin[i],
            cos: self.cos[i],
            squared: self.squared[i],
            to_above: self.to_above[i],
            to_below: self.to_below[i],
        }
    }
}

/// x and y, times a factor, in turns.
#[inline(always)]
fn write_pairs(factor: f64, x: &Column, y: &Column, out: &mut [f64]) {
    let (pairs, _) = out.as_chunks_mut::<2>();
    for (pair, (x, y)) in pairs.iter_mut().zip(x.iter().zip(&y[..])) {
        *pair = [factor * x, factor * y];
    }
}
