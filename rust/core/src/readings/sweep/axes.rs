//! What a sweep varies, and the checks of its values.

use std::sync::Arc;

use crate::engine::{Engine, Hold, bank_angle_in_range};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::readings::balance::angular_speed;

/// What is swept; `None` keeps the values of each engine.
#[derive(Debug, Clone, Default)]
pub struct Axes {
    /// Degrees between the banks, and what is held as they change.
    pub bank_angle: Option<(Vec<f64>, Hold)>,
    /// λ; the crank radius stays and the rod changes.
    pub rod_ratio: Option<Vec<f64>>,
    /// Pin offset of every cylinder, m.
    pub pin_offset: Option<Vec<f64>>,
    /// Speeds.
    pub rpm: Vec<f64>,
}

impl Axes {
    /// ω² of each speed.
    pub(super) fn squares(&self, cancel: &Cancel) -> Result<Vec<f64>> {
        /// Speeds between two checks for cancellation.
        const PIECE: usize = 1 << 14;
        length("rpm", self.rpm.len())?;
        let mut squares = memory::room(self.rpm.len())?;
        for piece in self.rpm.chunks(PIECE) {
            cancel.check()?;
            for &rpm in piece {
                squares.push(angular_speed(rpm).map(|omega| omega * omega)?);
            }
        }
        Ok(squares)
    }

    /// Rejects values out of range, and axes that engines or their spectra do not allow.
    pub(super) fn check(&self, engines: &[Arc<Engine>]) -> Result<()> {
        if let Some((angles, _)) = &self.bank_angle {
            length("bank_angle_deg", angles.len())?;
            angles.iter().try_for_each(|&angle| bank_angle_in_range(angle).map(drop))?;
            engines.iter().try_for_each(|engine| engine.banks().map(drop))?;
        }
        for (name, values) in [("rod_ratio", &self.rod_ratio), ("pin_offset", &self.pin_offset)] {
            let Some(values) = values else { continue };
            length(name, values.len())?;
            if engines.iter().any(|engine| engine.spectrum().is_some()) {
                let cure = "a spectrum replaces the slider-crank: leave out one of the two";
                return Err(Error::value(name, "swept together with a spectrum", cure));
            }
        }
        Ok(())
    }

    /// Checks that every slider-crank can turn, which all can if the extreme ones can; returns the
    /// largest rod ratio and the offset of largest magnitude, where they are swept.
    pub(super) fn check_geometry(&self, engines: &[Arc<Engine>]) -> Result<[Option<f64>; 2]> {
        let (ratios, offsets) = (self.rod_ratio.as_deref(), self.pin_offset.as_deref());
        if ratios.is_none() && offsets.is_none() {
            return Ok([None; 2]);
        }
        let (extreme_ratios, extreme_offsets) = (ends(ratios), ends(offsets));
        for cylinder in engines.iter().flat_map(|engine| engine.gears()) {
            let each = |ratio, offset| cylinder.proportions_with(ratio, offset).map(drop);
            let extremes = extreme_ratios.iter().try_for_each(|&ratio| {
                extreme_offsets.iter().try_for_each(|&offset| each(ratio, offset))
            });
            let Err(error) = extremes else { continue };
            // Report the first offending value.
            let some = |values: Option<&[f64]>, k: usize| values.map(|values| values[k]);
            for k in 0..ratios.map_or(1, <[f64]>::len) {
                extreme_offsets.iter().try_for_each(|&offset| each(some(ratios, k), offset))?;
            }
            for k in 0..offsets.map_or(1, <[f64]>::len) {
                each(some(ratios, 0), some(offsets, k))?;
            }
            return Err(error);
        }
        let [least, most] = extreme_offsets;
        let farthest = least.zip(most).map(|(a, b)| if -a > b { a } else { b });
        Ok([extreme_ratios[1], farthest])
    }
}

/// The least and the largest value of an axis, or twice a value that is no number; nothing where it
/// is not swept.
fn ends(values: Option<&[f64]>) -> [Option<f64>; 2] {
    let Some(values) = values else { return [None; 2] };
    if values.iter().any(|value| value.is_nan()) {
        return [Some(f64::NAN); 2];
    }
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    [Some(least), Some(values.iter().copied().fold(f64::NEG_INFINITY, f64::max))]
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
