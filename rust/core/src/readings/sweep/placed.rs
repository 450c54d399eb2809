//! Exact kinematics of an engine at one bank angle: what does not depend on the rod is evaluated once
//! for many points.

use std::ops::Range;

use super::{Quantity, Sweep};
use crate::gear::GearKind;
use crate::gear::rod::Swing;
use crate::gear::slider_crank::{CrankPosition, Cylinder, Proportions};
use crate::load::Loads;
use crate::numbers::angle::Angle;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::error::Result;
use crate::readings::balance::TorquePart;
use crate::readings::kinematics::{AngleColumn, BLOCK, Kinematics, Pistons, Units};

/// An engine at one bank angle.
pub(super) struct Placed {
    pub kinematics: Kinematics,
    pub points: Vec<PlacedPoint>,
}

/// A point of rod ratio and offset.
pub(super) struct PlacedPoint {
    /// Slider-cranks of the pistons.
    pub pistons: Vec<Proportions>,
    /// Those of the pistons under pressure.
    pub pressures: Vec<Proportions>,
}

impl Sweep {
    /// An engine with one of the swept bank angles.
    pub(super) fn placed(&self, engine: usize, angle: usize) -> Result<Placed> {
        let reference = self.references[engine];
        let engine = &self.engines[engine];
        let loads = match &self.axes.bank_angle {
            Some((angles, hold)) => {
                let turned = engine.with_bank_angle(Angle::from_degrees(angles[angle])?, *hold)?;
                Loads::new(&turned, reference)
            }
            None => Loads::new(engine, reference),
        };
        Ok(Placed { kinematics: Kinematics::new(&loads), points: Vec::new() })
    }

    /// A point of rod ratio and pin offset.
    pub(super) fn placed_point(
        &self,
        kinematics: &Kinematics,
        point: usize,
    ) -> Result<PlacedPoint> {
        let (ratio, offset) = self.at(point);
        let at = |cylinder: &Cylinder| cylinder.proportions_with(ratio, offset);
        let pistons = kinematics.pistons.iter().map(|pistons| at(&pistons.cylinder));
        let pressures = kinematics.pressures.iter().map(|pressures| match &pressures.gear.kind {
            GearKind::SliderCrank { cylinder, .. } => at(cylinder),
            GearKind::Given(_) => Ok(pressures.proportions),
        });
        Ok(PlacedPoint {
            pistons: pistons.collect::<Result<_>>()?,
            pressures: pressures.collect::<Result<_>>()?,
        })
    }
}

impl Placed {
    /// Writes the values of every row, times a factor, at some crank angles, at most [`BLOCK`]; of
    /// torque that of inertia or that of pressure, which takes none.
    #[inline(always)]
    pub fn write<'o>(
        &self,
        quantity: Quantity,
        factor: f64,
        angles: &CrankAngles,
        range: Range<usize>,
        outs: &mut impl Iterator<Item = &'o mut [f64]>,
    ) {
        if quantity.part() == Some(TorquePart::Gas) {
            return self.gas(matches!(quantity, Quantity::Torque(_)), angles, range, outs);
        }
        let cranks = |p: &Pistons| Cranks::new(p, &Units::at_speed(angles, range.clone(), p.ratio));
        let cranks: Vec<Cranks> = self.kinematics.pistons.iter().map(cranks).collect();
        let [mut x, mut y] = [AngleColumn::ZERO, AngleColumn::ZERO];
        for unbalances in &self.kinematics.unbalances {
            let units = Units::at_speed(angles, range.clone(), unbalances.ratio);
            let at_start = match quantity {
                Quantity::Force => unbalances.planar[0],
                Quantity::Moment => unbalances.planar[1],
                Quantity::Torque(_) => unbalances.roll,
                Quantity::CrankTorque(_) => continue,
            };
            units.add_turning(at_start, unbalances.ratio, [&mut x[..], &mut y[..]]);
        }
        match quantity {
            Quantity::Force => self.planar(0, factor, &cranks, &[x, y], outs),
            Quantity::Moment => self.planar(1, factor, &cranks, &[x, y], outs),
            Quantity::Torque(_) => self.torque::<true>(factor, &cranks, &y, outs),
            Quantity::CrankTorque(_) => {
                self.torque::<false>(factor, &cranks, &AngleColumn::ZERO, outs);
            }
        }
    }

    /// Torque of pressure.
    fn gas<'o>(
        &self,
        on_block: bool,
        angles: &CrankAngles,
        range: Range<usize>,
        outs: &mut impl Iterator<Item = &'o mut [f64]>,
    ) {
        for (point, out) in self.points.iter().zip(outs) {
            out.fill(0.0);
            for (pressures, proportions) in self.kinematics.pressures.iter().zip(&point.pressures) {
                let mut torque = AngleColumn::ZERO;
                pressures.add(proportions, angles, range.clone(), &mut torque[..]);
                let [block, crank] = pressures.gear.senses();
                let sense = if on_block { -block } else { crank };
                out.iter_mut().zip(&torque[..]).for_each(|(out, torque)| *out += sense * torque);
            }
        }
    }

    /// Force (0) or moment (1).
    #[inline(always)]
    fn planar<'o>(
        &self,
        which: usize,
        factor: f64,
        cranks: &[Cranks],
        unbalances: &[AngleColumn; 2],
        outs: &mut impl Iterator<Item = &'o mut [f64]>,
    ) {
        let pistons = &self.kinematics.pistons;
        for (PlacedPoint { pistons: proportions, .. }, out) in self.points.iter().zip(outs) {
            let [mut x, mut y] = unbalances.clone();
            for ((pistons, cranks), proportions) in pistons.iter().zip(cranks).zip(proportions) {
                let along = pistons.planar[which];
                for i in 0..BLOCK {
                    let acceleration = proportions.motion_at(&cranks.at(i)).acceleration;
                    x[i] = along.re.mul_add(acceleration, x[i]);
                    y[i] = along.im.mul_add(acceleration, y[i]);
                }
            }
            let (pairs, _) = out.as_chunks_mut::<2>();
            for (pair, (x, y)) in pairs.iter_mut().zip(x.iter().zip(&y[..])) {
                *pair = [factor * x, factor * y];
            }
        }
    }

    /// Roll torque on the block, or torque on the crank.
    #[inline(always)]
    fn torque<'o, const ROLL: bool>(
        &self,
        factor: f64,
        cranks: &[Cranks],
        unbalances: &AngleColumn,
        outs: &mut impl Iterator<Item = &'o mut [f64]>,
    ) {
        let pistons = &self.kinematics.pistons;
        for (PlacedPoint { pistons: proportions, .. }, out) in self.points.iter().zip(outs) {
            let mut sum = unbalances.clone();
            for ((pistons, cranks), proportions) in pistons.iter().zip(cranks).zip(proportions) {
                let [on_block, on_crank] = pistons.senses();
                let sense = if ROLL { on_block } else { on_crank };
                let (masses, shift) =
                    (sense * pistons.second_moment, if ROLL { pistons.arm } else { 0.0 });
                for (i, sum) in sum.iter_mut().enumerate() {
                    let motion = proportions.motion_at(&cranks.at(i));
                    let arm =
                        if ROLL { motion.velocity + proportions.offset } else { -motion.velocity };
                    *sum = motion.acceleration.mul_add(masses.mul_add(arm, shift), *sum);
                }
                if pistons.rod_inertia != 0.0 {
                    for (i, sum) in sum.iter_mut().enumerate() {
                        let swing = Swing::new(proportions, &cranks.at(i));
                        let torque = if ROLL { swing.roll() } else { swing.crank() };
                        *sum = (sense * pistons.rod_inertia).mul_add(torque, *sum);
                    }
                }
            }
            out.iter_mut().zip(&sum[..]).for_each(|(out, sum)| *out = factor * sum);
        }
    }
}

/// Positions of the cranks of pistons that move together.
struct Cranks {
    sin: AngleColumn,
    cos: AngleColumn,
    squared: AngleColumn,
    to_above: AngleColumn,
    to_below: AngleColumn,
}

impl Cranks {
    #[inline(always)]
    fn new(pistons: &Pistons, units: &Units) -> Self {
        let mut cranks = Self {
            sin: AngleColumn::ZERO,
            cos: AngleColumn::ZERO,
            squared: AngleColumn::ZERO,
            to_above: AngleColumn::ZERO,
            to_below: AngleColumn::ZERO,
        };
        for i in 0..BLOCK {
            let crank = units.crank(pistons.phase, i);
            cranks.sin[i] = crank.sin;
            cranks.cos[i] = crank.cos;
            cranks.squared[i] = crank.squared;
            cranks.to_above[i] = crank.to_above;
            cranks.to_below[i] = crank.to_below;
        }
        cranks
    }

    #[inline(always)]
    fn at(&self, i: usize) -> CrankPosition {
        CrankPosition {
            sin: self.sin[i],
            cos: self.cos[i],
            squared: self.squared[i],
            to_above: self.to_above[i],
            to_below: self.to_below[i],
        }
    }
}
