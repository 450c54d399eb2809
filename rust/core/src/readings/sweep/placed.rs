//! Exact kinematics of an engine at one bank angle: what does not depend on the rod is evaluated once
//! for many points.

use super::{Quantity, Sweep};
use crate::gear::GearKind;
use crate::gear::slider_crank::{Cylinder, Proportions};
use crate::load::Loads;
use crate::numbers::angle::Angle;
use crate::numbers::error::Result;
use crate::readings::balance::TorquePart;
use crate::readings::kinematics::{AngleBlock, Kinematics};
use crate::readings::waveform::WaveformRows;

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
    /// Writes the values of every row, times a factor, at a block of crank angles; of torque that of
    /// inertia or that of pressure, which takes none.
    #[inline(always)]
    pub fn write<'o>(
        &self,
        quantity: Quantity,
        factor: f64,
        block: &AngleBlock,
        outs: &mut impl Iterator<Item = &'o mut [f64]>,
    ) {
        let of_gas = quantity.part() == Some(TorquePart::Gas);
        let torque = !quantity.is_planar();
        let mut unbalances = WaveformRows::ZERO;
        if !of_gas {
            unbalances.add_unbalances(&self.kinematics, block, torque, 1.0);
        }
        let (mut rows, used) = (WaveformRows::ZERO, if torque { 4..6 } else { 0..4 });
        for (point, out) in self.points.iter().zip(outs) {
            rows.columns[used.clone()].clone_from_slice(&unbalances.columns[used.clone()]);
            if of_gas {
                for (pressures, of) in self.kinematics.pressures.iter().zip(&point.pressures) {
                    rows.add_pressure(pressures, of, block);
                }
            } else {
                for (pistons, of) in self.kinematics.pistons.iter().zip(&point.pistons) {
                    if torque {
                        rows.add_pistons(pistons, of, block, [false, true], 1.0);
                    } else {
                        rows.add_pistons(pistons, of, block, [true, false], 1.0);
                    }
                }
            }
            let [force_x, force_y, moment_x, moment_y, roll, crank, ..] = &rows.columns;
            let [of_force, of_moment] = self.kinematics.zero_bounds;
            let (x, y, bound) = match quantity {
                Quantity::Force => (force_x, force_y, of_force),
                Quantity::Moment => (moment_x, moment_y, of_moment),
                Quantity::Torque(_) => (roll, roll, 0.0),
                Quantity::CrankTorque(_) => (crank, crank, 0.0),
            };
            // Last, as where rows are multiplied for several speeds: a row has the same bits in any sweep.
            if torque {
                out.iter_mut().zip(&x[..]).for_each(|(out, x)| *out = factor * x);
                continue;
            }
            let snapped = |value: f64| if value.abs() <= bound { 0.0 } else { value };
            for (pair, (x, y)) in out.as_chunks_mut().0.iter_mut().zip(x.iter().zip(&y[..])) {
                *pair = [factor * snapped(*x), factor * snapped(*y)];
            }
        }
    }
}
