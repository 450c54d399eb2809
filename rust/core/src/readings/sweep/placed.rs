//! Exact kinematics of an engine at one bank angle: what does not depend on the rod is evaluated once
//! for many points.

use std::sync::Arc;

use super::{Selection, Sweep};
use crate::load::kinematics::{Kinematics, SourceSum};
use crate::load::{Group, GroupIndex, Scene};
use crate::numbers::angle::Angle;
use crate::numbers::error::Result;
use crate::numbers::index::List;
use crate::readings::quantity::Kind;
use crate::source::over_angle::{AngleBlock, Columns, Quantities};
use crate::source::{Source, at_point};

/// An engine at one bank angle.
pub(super) struct EngineAtBankAngle {
    pub kinematics: Kinematics,
    /// Groups of its sums.
    groups: List<GroupIndex, Group>,
    /// Sources of the sums at points.
    pub points: Vec<Vec<Arc<dyn Source>>>,
}

impl Sweep {
    /// An engine with one of the swept bank angles.
    pub(super) fn placed(&self, engine: usize, angle: usize) -> Result<EngineAtBankAngle> {
        let loads: &Scene = match &self.axes.bank_angle {
            Some((angles, hold)) => {
                let angle = Angle::from_degrees(angles[angle])?;
                let turned = self.engines[engine].with_bank_angle(angle, *hold)?;
                &*Scene::of(&turned, Some(self.loads[engine].reference))?
            }
            None => &self.loads[engine],
        };
        let (kinematics, groups) = (Kinematics::new(loads), loads.groups.clone());
        Ok(EngineAtBankAngle { kinematics, groups, points: Vec::new() })
    }

    /// Sources of the sums at a point of a quantity.
    pub(super) fn placed_point(
        &self,
        kinematics: &Kinematics,
        selection: Selection,
        point: usize,
    ) -> Result<Vec<Arc<dyn Source>>> {
        let point = self.at(selection, point);
        let mut sources: Vec<Arc<dyn Source>> = Vec::new();
        for (k, sum) in kinematics.sums.iter().enumerate() {
            // One of several phases is one, as before.
            let same = (0..k).find(|&of| Arc::ptr_eq(&kinematics.sums[of].source, &sum.source));
            let own = same
                .map_or_else(|| at_point(&sum.source, &point), |of| Ok(Arc::clone(&sources[of])));
            sources.push(own?);
        }
        Ok(sources)
    }
}

impl EngineAtBankAngle {
    /// Writes the values of every row, times a factor, at a block of crank angles.
    #[inline(always)]
    pub fn write<'o>(
        &self,
        selection: Selection,
        factor: f64,
        block: &AngleBlock,
        outs: &mut impl Iterator<Item = &'o mut [f64]>,
    ) -> Result<()> {
        let quantity = selection.quantity;
        let torque = !quantity.is_planar();
        let [force, moment] = [Kind::Force, Kind::Moment].map(|kind| quantity.kind == kind);
        let wanted = Quantities { force, moment, torque };
        let counts = |sum: &SourceSum| selection.has(&self.groups[sum.group]);
        let is_fixed = |k: usize, sum: &SourceSum| {
            self.points.iter().all(|of| Arc::ptr_eq(&of[k], &sum.source))
        };
        let factors = self.groups.map_to(|group| f64::from(u8::from(selection.has(group))));
        let [of_force, of_moment] = self.kinematics.zero_bounds(&factors);
        let mut fixed = Columns::ZERO;
        let (standing, moving): (Vec<_>, Vec<_>) = (self.kinematics.sums.iter().enumerate())
            .filter(|(_, sum)| counts(sum))
            .partition(|(k, sum)| is_fixed(*k, sum));
        for (_, sum) in standing {
            sum.source.over_angle(&sum.loads, block, wanted, 1.0, &mut fixed)?;
        }
        let mut columns = Columns::ZERO;
        for (point, out) in self.points.iter().zip(outs) {
            columns.copy(&fixed, wanted);
            for (k, sum) in &moving {
                point[*k].over_angle(&sum.loads, block, wanted, 1.0, &mut columns)?;
            }
            let Columns { force, moment, torque: [roll, crank], .. } = &columns;
            let ([x, y], bound) = match quantity.kind {
                Kind::Force => (force.each_ref(), of_force),
                Kind::Moment => (moment.each_ref(), of_moment),
                Kind::Torque => ([roll; 2], 0.0),
                Kind::CrankTorque => ([crank; 2], 0.0),
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
        Ok(())
    }
}
