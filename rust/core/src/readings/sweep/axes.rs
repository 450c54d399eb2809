//! Axes of a sweep, and the checks of their values.

use std::sync::Arc;

use crate::engine::{Engine, Hold, bank_angle_in_range};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::pressure::Cycle;
use crate::readings::balance::angular_speed;

/// What is swept; `None` keeps the values of each engine.
#[derive(Debug, Clone, Default)]
pub struct SweepAxes {
    /// Degrees between the banks, and what is held as they change.
    pub bank_angle: Option<(Vec<f64>, Hold)>,
    /// λ; the crank radius stays and the rod changes.
    pub rod_ratio: Option<Vec<f64>>,
    /// Pin offset of every cylinder, m.
    pub pin_offset: Option<Vec<f64>>,
    /// Speeds.
    pub rpm: Vec<f64>,
    /// Loads, of engines with the cycles of a map.
    pub map: Option<MapAxes>,
}

/// Speeds and loads at which a map has cycles, the cycles, and the loads swept.
#[derive(Debug, Clone)]
pub struct MapAxes {
    /// Speeds of the cycles, ascending.
    pub rpm: Vec<f64>,
    /// Loads of the cycles, ascending.
    pub loads: Vec<f64>,
    /// At each speed and load, load by load of one speed after the other: one in place of each of the
    /// cycles of an engine ([`crate::engine::Gas::cycles`]).
    pub cycles: Vec<Vec<Arc<Cycle>>>,
    /// Loads.
    pub load: Vec<f64>,
}

impl SweepAxes {
    /// Angular speeds, rad/s.
    pub(super) fn omegas(&self, cancel: &Cancel) -> Result<Vec<f64>> {
        length("rpm", self.rpm.len())?;
        if let Some(map) = &self.map {
            length("load", map.load.len())?;
        }
        let mut omegas = memory::with_capacity(self.rpm.len())?;
        each(&self.rpm, cancel, |rpm| angular_speed(rpm).map(|omega| omegas.push(omega)))?;
        Ok(omegas)
    }

    /// Rejects values out of range, and axes that engines or their spectra do not allow.
    pub(super) fn check(&self, engines: &[Arc<Engine>], cancel: &Cancel) -> Result<()> {
        if let Some(map) = &self.map {
            let nodes = map.rpm.len() * map.loads.len();
            if map.cycles.len() != nodes {
                let hint = format!("give cycles for each speed and load: {nodes}");
                return Err(Error::value("cycles", map.cycles.len(), hint));
            }
            for engine in engines {
                map.cycles.iter().try_for_each(|cycles| engine.check_cycles(cycles))?;
            }
        }
        if let Some((angles, _)) = &self.bank_angle {
            length("bank_angle_deg", angles.len())?;
            each(angles, cancel, |angle| bank_angle_in_range(angle).map(drop))?;
            for engine in engines {
                engine.check_bank_angle_can_change()?;
            }
        }
        for (name, values) in [("rod_ratio", &self.rod_ratio), ("pin_offset", &self.pin_offset)] {
            let Some(values) = values else { continue };
            length(name, values.len())?;
            if engines.iter().any(|engine| engine.spectrum().is_some()) {
                let hint = "a spectrum replaces the slider-crank: leave out one of the two";
                return Err(Error::value(name, "swept together with a spectrum", hint));
            }
            for engine in engines {
                engine.check_no_link_rods(name)?;
                engine.check_chambers_keep(name)?;
            }
        }
        Ok(())
    }

    /// Checks that every slider-crank can turn, which all can if the extreme ones can; returns the
    /// largest rod ratio and the offset of largest magnitude, where they are swept.
    pub(super) fn check_geometry(
        &self,
        engines: &[Arc<Engine>],
        cancel: &Cancel,
    ) -> Result<[Option<f64>; 2]> {
        let (ratios, offsets) = (self.rod_ratio.as_deref(), self.pin_offset.as_deref());
        let (extreme_ratios, extreme_offsets) = (ends(ratios, cancel)?, ends(offsets, cancel)?);
        for cylinder in engines.iter().flat_map(|engine| engine.distinct_cylinders()) {
            let at = |ratio, offset| cylinder.mechanism_with(ratio, offset).map(drop);
            let at_extreme_offsets =
                |ratio| extreme_offsets.iter().try_for_each(|&offset| at(ratio, offset));
            let Err(error) = extreme_ratios.into_iter().try_for_each(at_extreme_offsets) else {
                continue;
            };
            // Report the first offending value.
            each(ratios.unwrap_or_default(), cancel, |ratio| at_extreme_offsets(Some(ratio)))?;
            let ratio = ratios.map(|ratios| ratios[0]);
            each(offsets.unwrap_or_default(), cancel, |offset| at(ratio, Some(offset)))?;
            return Err(error);
        }
        let [least, most] = extreme_offsets;
        let farthest = least.zip(most).map(|(a, b)| if -a > b { a } else { b });
        Ok([extreme_ratios[1], farthest])
    }
}

/// Least and largest value of an axis, NaN twice if it has one; `None` where it is not swept.
fn ends(values: Option<&[f64]>, cancel: &Cancel) -> Result<[Option<f64>; 2]> {
    let Some(values) = values else { return Ok([None; 2]) };
    let (mut least, mut most, mut is_nan) = (f64::INFINITY, f64::NEG_INFINITY, false);
    each(values, cancel, |value| {
        (least, most, is_nan) = (least.min(value), most.max(value), is_nan || value.is_nan());
        Ok(())
    })?;
    Ok(if is_nan { [Some(f64::NAN); 2] } else { [Some(least), Some(most)] })
}

/// Applies a check to each value, looking at `cancel` between pieces.
fn each(values: &[f64], cancel: &Cancel, mut check: impl FnMut(f64) -> Result<()>) -> Result<()> {
    /// Values between two checks for cancellation.
    const VALUES_PER_CHECK: usize = 1 << 14;
    for piece in values.chunks(VALUES_PER_CHECK) {
        cancel.check()?;
        piece.iter().try_for_each(|&value| check(value))?;
    }
    Ok(())
}

/// Rejects an empty axis and one of too many values.
fn length(argument: &'static str, count: usize) -> Result<()> {
    not_empty(argument, count)?;
    limits::axis_length(argument, count)
}

pub(super) fn not_empty(argument: &str, count: usize) -> Result<()> {
    if count > 0 {
        return Ok(());
    }
    Err(Error::value(argument, "[]", "give at least one value"))
}
