//! Turning-moment diagrams by the areas that torque encloses with its mean.

use crate::numbers::error::{Error, Result};
use crate::numbers::{limits, memory};
use crate::readings::balance::angular_speed;

/// Part of the sum of the sizes of areas up to which their sum is rounding of figures that were typed.
const CLOSED: f64 = 1e-9;

/// Energy of a crank where torque crosses its mean.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyLevels {
    /// Work done since the first crossing, in the unit of the areas: one for each, and the first again.
    pub levels: Vec<f64>,
    /// Index of the highest level, at which the crank is fastest.
    pub highest: usize,
    /// Index of the lowest level, at which the crank is slowest.
    pub lowest: usize,
}

impl EnergyLevels {
    /// From areas in the order in which they follow each other, those above the mean positive. They add to
    /// zero, or are made to: then each changes by the same part of its size.
    pub fn of_areas(areas: &[f64], spread: bool) -> Result<Self> {
        if areas.len() < 2 {
            let hint = "give at least two, one above the mean torque and one below";
            return Err(Error::value("areas", shortened(areas), hint));
        }
        for (k, &area) in areas.iter().enumerate() {
            limits::finite(&format!("areas[{k}]"), area)?;
        }
        let (sum, size) =
            areas.iter().fold((0.0, 0.0), |(sum, size), area| (sum + area, size + area.abs()));
        if !(size > 0.0 && f64::is_finite(size)) {
            let hint = "give areas of which some are not zero";
            return Err(Error::value("areas", shortened(areas), hint));
        }
        if sum.abs() > CLOSED * size && !spread {
            let hint = format!(
                "areas of a whole cycle about its mean torque add to zero, these to {sum:.6}; correct the one \
                 that is wrong, or, where they were measured, let spread change each by {:.3} % of its size",
                100.0 * sum.abs() / size
            );
            return Err(Error::value("areas", shortened(areas), hint));
        }
        let mut levels = memory::zeros(areas.len() + 1)?;
        for (k, &area) in areas.iter().enumerate() {
            levels[k + 1] = levels[k] + area - sum * (area.abs() / size);
        }
        levels[areas.len()] = 0.0;
        let of = |wanted: fn(f64, f64) -> bool| {
            (1..areas.len())
                .fold(0, |best, k| if wanted(levels[k], levels[best]) { k } else { best })
        };
        let [highest, lowest] = [of(|one, best| one > best), of(|one, best| one < best)];
        Ok(Self { levels, highest, lowest })
    }

    /// Largest less smallest, in the unit of the areas.
    #[must_use]
    pub fn fluctuation(&self) -> f64 {
        self.levels[self.highest] - self.levels[self.lowest]
    }
}

/// The first areas, as a message shows them.
fn shortened(areas: &[f64]) -> String {
    const SHOWN: usize = 12;
    let more = if areas.len() > SHOWN { ", …" } else { "" };
    let first: Vec<String> = areas.iter().take(SHOWN).map(|area| format!("{area:?}")).collect();
    format!("[{}{more}]", first.join(", "))
}

/// Moment of inertia times irregularity, kg·m², of a fluctuation of energy, J, at a speed midway between the
/// extremes, rpm: ½·J·(ω₁² − ω₂²) = J·ω·(ω₁ − ω₂).
pub fn inertia_by_irregularity(energy: f64, rpm: f64) -> Result<f64> {
    limits::not_negative("energy", energy)?;
    let omega = angular_speed(rpm)?;
    if omega == 0.0 {
        return Err(Error::figure("rpm", rpm, "give a speed above 0"));
    }
    Ok(energy / (omega * omega))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_sums_of_areas() {
        let levels =
            EnergyLevels::of_areas(&[52.0, -124.0, 92.0, -140.0, 85.0, -72.0, 107.0], false)
                .unwrap();
        assert_eq!(levels.levels, [0.0, 52.0, -72.0, 20.0, -120.0, -35.0, -107.0, 0.0]);
        assert_eq!((levels.highest, levels.lowest, levels.fluctuation()), (1, 4, 172.0));
        // Where a cycle begins does not matter.
        let turned =
            EnergyLevels::of_areas(&[85.0, -72.0, 107.0, 52.0, -124.0, 92.0, -140.0], false)
                .unwrap();
        assert_eq!((turned.highest, turned.lowest, turned.fluctuation()), (4, 0, 172.0));
    }

    #[test]
    fn areas_that_do_not_close_are_rejected_or_spread() {
        assert!(EnergyLevels::of_areas(&[100.0, -90.0], false).is_err());
        let spread = EnergyLevels::of_areas(&[100.0, -90.0], true).unwrap();
        assert!((spread.fluctuation() - (100.0 - 10.0 * 100.0 / 190.0)).abs() < 1e-12);
        assert!(EnergyLevels::of_areas(&[0.0, 0.0], true).is_err());
        assert!(EnergyLevels::of_areas(&[f64::MAX, f64::MAX], true).is_err());
        assert!(EnergyLevels::of_areas(&[1.0], true).is_err());
    }
}
