//! The volume over a piston, and cycles that are put together of smooth curves.

use super::Strokes;
use super::{Cycle, Given, MOST_POINTS, period_deg};
use std::sync::Arc;

use crate::mechanism::Mechanism;
use crate::mechanism::cylinder::{Cylinder, piston_area};
use crate::mechanism::motion::CrankPosition;
use crate::numbers::angle::cis_degrees;
use crate::numbers::chebyshev::{largest_of_last, points};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// Degree of the polynomials of computed cycles.
pub(super) const DEGREE: usize = 15;
/// Part of the largest value that the last coefficients of a polynomial may have: rounding.
pub(super) const RESOLVED: f64 = 2e-14;
/// Narrowest panel, degrees: a curve that still bends there is followed no closer.
pub(crate) const NARROWEST: f64 = 1e-4;

/// Combustion chamber over a piston.
#[derive(Debug, Clone)]
pub struct Chamber {
    mechanism: Arc<dyn Mechanism>,
    /// Travel of the piston, m.
    pub(super) stroke: f64,
    /// The same, and the position of the piston at its highest point, crank radii.
    travel: f64,
    highest: f64,
    /// m.
    pub(super) bore: f64,
    /// Ratio of largest to smallest volume.
    pub(super) compression_ratio: f64,
    /// Crank angles of the piston's highest and lowest point, degrees.
    pub(super) top: f64,
    pub(super) bottom: f64,
    pub(super) strokes: Strokes,
}

impl Chamber {
    /// Chamber of a cylinder of this bore, m, at this ratio of largest to smallest volume.
    pub fn new(
        cylinder: &Cylinder,
        bore: f64,
        compression_ratio: f64,
        strokes: Strokes,
    ) -> Result<Self> {
        limits::length("bore", bore)?;
        within("compression_ratio", compression_ratio, 1.001, 1000.0)?;
        let (mechanism, stroke) = (cylinder.mechanism(), cylinder.travel());
        let [top, bottom] = cylinder.turning_points_deg();
        Ok(Self {
            stroke,
            travel: stroke / cylinder.crank_radius(),
            highest: position(&*mechanism, top),
            mechanism,
            bore,
            compression_ratio,
            top,
            bottom,
            strokes,
        })
    }

    /// Piston area, m².
    pub(super) fn area(&self) -> f64 {
        piston_area(self.bore)
    }

    /// Volume at a crank angle, degrees, over the clearance volume.
    #[must_use]
    pub fn ratio(&self, angle: f64) -> f64 {
        let down = self.highest - position(&*self.mechanism, angle);
        1.0 + (self.compression_ratio - 1.0) * down / self.travel
    }

    /// Clearance volume, m³.
    pub(super) fn clearance(&self) -> f64 {
        self.area() * self.stroke / (self.compression_ratio - 1.0)
    }

    /// Angle between the piston's highest and lowest point at which the volume is `ratio` clearances.
    pub(super) fn angle_of(&self, ratio: f64) -> f64 {
        let (mut low, mut high) = (self.top, self.bottom);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if self.ratio(middle) < ratio { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }
}

/// Position of a piston at a crank angle, crank radii.
fn position(mechanism: &dyn Mechanism, angle: f64) -> f64 {
    let unit = cis_degrees(angle);
    mechanism.motion(&CrankPosition::new(unit.im, unit.re)).position
}

/// Points of a cycle as they are put together, panel by panel.
#[derive(Debug, Default)]
pub(super) struct Curves {
    theta_deg: Vec<f64>,
    pressure: Vec<f64>,
}

impl Curves {
    /// Append a smooth curve, its panels halved until its polynomials are exact to rounding.
    pub fn add(&mut self, from: f64, to: f64, of: impl Fn(f64) -> f64) -> Result<()> {
        let mut parts = vec![(from, to)];
        while let Some((low, high)) = parts.pop() {
            let values: Vec<f64> = points(low, high, DEGREE).map(&of).collect();
            if high - low < NARROWEST || is_resolved(&values) {
                self.panel(low, high, &values)?;
            } else {
                let middle = 0.5 * (low + high);
                parts.extend([(middle, high), (low, middle)]);
            }
        }
        Ok(())
    }

    /// Append a panel by its values at the Chebyshev points; an empty one is left out.
    pub fn panel(&mut self, low: f64, high: f64, values: &[f64]) -> Result<()> {
        if high <= low {
            return Ok(());
        }
        if self.theta_deg.len() + values.len() > MOST_POINTS {
            let hint = "pressure changes too fast; give a longer burn, or a smaller m";
            return Err(Error::value("points", format!("more than {MOST_POINTS}"), hint));
        }
        self.theta_deg.extend(points(low, high, DEGREE));
        self.pressure.extend(values);
        Ok(())
    }

    /// The cycle of these panels.
    pub fn cycle(self, name: String, strokes: Strokes) -> Result<Cycle> {
        let Self { theta_deg, pressure } = self;
        let strokes = strokes.number();
        Cycle::new(Given { name, strokes, theta_deg, pressure, degree: Some(DEGREE) })
    }
}

/// Whether the polynomial through values at Chebyshev points has converged.
pub(super) fn is_resolved(values: &[f64]) -> bool {
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    largest_of_last(values) <= RESOLVED * largest
}

/// Polytropic compression and expansion with ideal combustion at constant volume and pressure.
#[derive(Debug, Clone)]
pub struct Ideal {
    /// Pressure after over before the combustion at constant volume; 1 for none.
    pub pressure_ratio: f64,
    /// Volume after over before the combustion at constant pressure; 1 for none.
    pub cutoff_ratio: f64,
    /// Exponent of compression.
    pub compression_exponent: f64,
    /// Exponent of expansion.
    pub expansion_exponent: f64,
    /// Absolute pressure before compression, and in a four-stroke's intake stroke, Pa.
    pub intake_pressure: f64,
    /// Absolute pressure in a four-stroke's exhaust stroke, Pa.
    pub exhaust_pressure: f64,
}

impl Ideal {
    /// The cycle; combustion and exchange of gas are where the piston stands still.
    pub fn cycle(&self, chamber: &Chamber, name: String) -> Result<Cycle> {
        let ratio = chamber.compression_ratio;
        within("pressure_ratio", self.pressure_ratio, 1.0, 1000.0)?;
        within("cutoff_ratio", self.cutoff_ratio, 1.0, ratio)?;
        exponent("compression_exponent", self.compression_exponent)?;
        exponent("expansion_exponent", self.expansion_exponent)?;
        let intake = absolute("intake_pressure", self.intake_pressure)?;
        let exhaust = absolute("exhaust_pressure", self.exhaust_pressure)?;
        let compressed =
            |angle: f64| intake * (ratio / chamber.ratio(angle)).powf(self.compression_exponent);
        let highest = self.pressure_ratio * compressed(chamber.top);
        let cutoff = match self.cutoff_ratio {
            1.0 => chamber.top,
            clearances => chamber.angle_of(clearances),
        };
        let expanded = |angle: f64| {
            highest * (self.cutoff_ratio / chamber.ratio(angle)).powf(self.expansion_exponent)
        };
        let mut curves = Curves::default();
        let (top, bottom) = (chamber.top, chamber.bottom);
        if cutoff > top {
            curves.add(top, cutoff, |_| highest)?;
        }
        curves.add(cutoff, bottom, expanded)?;
        let period = period_deg(chamber.strokes);
        if chamber.strokes == Strokes::Four {
            curves.add(bottom, top + 360.0, |_| exhaust)?;
            curves.add(top + 360.0, bottom + 360.0, |_| intake)?;
        }
        curves.add(bottom + (period - 360.0), top + period, compressed)?;
        curves.cycle(name, chamber.strokes)
    }
}

/// A figure within a range.
pub(super) fn within(argument: &str, value: f64, least: f64, most: f64) -> Result<f64> {
    if (least..=most).contains(&value) {
        return Ok(value);
    }
    Err(Error::figure(argument, value, format!("give a number from {least} to {most}")))
}

/// A polytropic exponent, or a ratio of heat capacities.
pub(super) fn exponent(argument: &str, value: f64) -> Result<f64> {
    within(argument, value, 1.0, 2.0)
}

/// An absolute pressure above zero, Pa.
pub(super) fn absolute(argument: &str, value: f64) -> Result<f64> {
    if (1.0..=1e10).contains(&value) {
        return Ok(value);
    }
    Err(Error::figure(argument, value, "give absolute pressure in Pa, 1 to 1e10"))
}
