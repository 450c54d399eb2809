//! Cylinder pressure over a cycle, and the torque that it exerts on a crank.
//!
//! Imports run downwards: [`Cycle`] keeps the points it was given and the piecewise polynomial through
//! them (`interpolant`); `harmonics` integrates that over a piston's motion; `chamber` and `burn` compute
//! cycles of a cylinder; `preparation` corrects measured ones, whose crank angle `encoder` reads from pulses.

pub mod burn;
pub mod chamber;
pub mod encoder;
pub mod example;
mod harmonics;
mod interpolant;
pub mod map;
pub mod preparation;
mod strokes;
pub mod warnings;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

pub use self::harmonics::GasTorque;
use self::harmonics::LastTorques;
use self::interpolant::Panels;
pub use self::strokes::Strokes;
use crate::numbers::angle::Angle;
use crate::numbers::crank_angles::{FEWEST_POINTS, check_grid, repeats_first};
use crate::numbers::error::{Error, Result};
use crate::numbers::kept::Kept;
use crate::numbers::limits;

/// Most points of a cycle: 720° in steps of 0.01° are 72 000.
pub const MOST_POINTS: usize = 100_000;
/// Atmospheric pressure, Pa: the crankcase's unless another is given.
pub const ATMOSPHERE: f64 = 101_325.0;

/// Absolute pressure in a cylinder over one cycle, Pa, by crank angle after the firing top dead centre.
///
/// Either a table, interpolated by cubics, or polynomials between edges at which pressure may jump or
/// bend: the values at their Chebyshev points. Both are kept as they were given.
///
/// ```
/// use crankpin_core::Cycle;
/// use crankpin_core::pressure::Given;
///
/// let cycle = Cycle::new(Given {
///     name: "two levels".into(),
///     strokes: 4,
///     theta_deg: (0..12).map(|k| 60.0 * f64::from(k)).collect(),
///     pressure: (0..12).map(|k| if k < 3 { 2e6 } else { 1e5 }).collect(),
///     degree: None,
/// })?;
/// assert_eq!(cycle.pressure_deg(60.0), 2e6);
/// assert_eq!(cycle.pressure_deg(60.0 + 720.0), 2e6);
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Given", into = "Given")]
pub struct Cycle {
    given: Given,
    strokes: Strokes,
    panels: Panels,
    last_torques: LastTorques,
    /// The same, delayed.
    kept: Kept,
}

/// A cycle by some degrees later.
struct Delayed {
    degrees: f64,
    cycle: Arc<Cycle>,
}

/// What a cycle is made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Given {
    /// Name, or origin; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// 2 or 4.
    pub strokes: u32,
    /// Crank angles of the points after the firing top dead centre, ascending, degrees. An angle that is
    /// there twice is one at which pressure jumps.
    pub theta_deg: Vec<f64>,
    /// Absolute pressure there, Pa.
    pub pressure: Vec<f64>,
    /// Degree of the polynomials, each through this number of Chebyshev points and one; none for a table.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub degree: Option<usize>,
}

impl TryFrom<Given> for Cycle {
    type Error = Error;

    fn try_from(given: Given) -> Result<Self> {
        Self::new(given)
    }
}

impl From<Cycle> for Given {
    fn from(cycle: Cycle) -> Self {
        cycle.given
    }
}

impl Cycle {
    /// Check the points and interpolate between them.
    pub fn new(given: Given) -> Result<Self> {
        let strokes = Strokes::from_number(given.strokes)?;
        let (angles, values) = (&given.theta_deg, &given.pressure);
        limits::same_length("pressure", values.len(), "theta_deg", angles.len(), "crank angle")?;
        let fewest = if given.degree.is_some() { 2 } else { FEWEST_POINTS };
        if !(fewest..=MOST_POINTS).contains(&angles.len()) {
            let hint = format!("give from {fewest} to {MOST_POINTS} points");
            return Err(Error::value("theta_deg", format!("{} points", angles.len()), hint));
        }
        limits::name("name", &given.name)?;
        check_grid("theta_deg", angles)?;
        for (k, &value) in values.iter().enumerate() {
            let argument = format!("pressure[{k}]");
            limits::finite(&argument, value)?;
            // Noise and an offset of the sensor reach below zero, and torque is linear in pressure.
            if value < -ATMOSPHERE {
                let hint = "give absolute pressure in Pa: gauge pressure is none below -101325";
                return Err(Error::figure(argument, value, hint));
            }
        }
        let period = period_deg(strokes);
        let panels = match given.degree {
            None => {
                let closed = repeats_first(angles, period).ok_or_else(|| no_period(angles, period));
                Panels::of_table(angles, values, period, closed?)?
            }
            Some(degree) => Panels::of_chebyshev(angles, values, period, degree)?,
        };
        let (last_torques, kept) = (LastTorques::default(), Kept::default());
        Ok(Self { given, strokes, panels, last_torques, kept })
    }

    /// What it was made of.
    #[must_use]
    pub fn given(&self) -> &Given {
        &self.given
    }

    /// Whether its period is two turns or one.
    #[must_use]
    pub fn strokes(&self) -> Strokes {
        self.strokes
    }

    /// The same cycle by an angle later.
    #[must_use]
    pub fn delayed(self: &Arc<Self>, by: Angle) -> Arc<Self> {
        let degrees = by.degrees();
        if degrees == 0.0 {
            return Arc::clone(self);
        }
        let new = || {
            let mut later = Self::clone(self);
            let angles = later.given.theta_deg.iter_mut().chain(&mut later.panels.edges);
            angles.for_each(|angle| *angle += degrees);
            Ok(Delayed { degrees, cycle: Arc::new(later) })
        };
        let delayed = self.kept.get(|one: &Delayed| one.degrees == degrees, new);
        delayed.map_or_else(|_| Arc::clone(self), |one| Arc::clone(&one.cycle))
    }

    /// Whether the last point of a table repeats the first, a period later.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.given.degree.is_none()
            && repeats_first(&self.given.theta_deg, period_deg(self.strokes)) == Some(true)
    }

    /// Absolute pressure, Pa, at a crank angle in radians after the firing top dead centre.
    #[must_use]
    pub fn pressure(&self, theta: f64) -> f64 {
        self.pressure_deg(theta.to_degrees())
    }

    /// Absolute pressure, Pa, at a crank angle in degrees; the value after it where pressure jumps.
    #[must_use]
    pub fn pressure_deg(&self, theta_deg: f64) -> f64 {
        self.panels.value(theta_deg)
    }

    /// Absolute pressure, Pa, at a crank angle in degrees of the polynomial that counts at another one.
    pub(crate) fn pressure_beside(&self, theta_deg: f64, at: f64) -> f64 {
        self.panels.beside(theta_deg, at)
    }

    /// Crank angles at which pressure may jump or bend, degrees: the edges of the polynomials.
    pub(crate) fn edges_deg(&self) -> &[f64] {
        &self.panels.edges
    }

    /// Chebyshev coefficients of the polynomials between those edges.
    pub(crate) fn polynomials(&self) -> impl Iterator<Item = &[f64]> {
        (0..self.panels.edges.len() - 1).map(|k| self.panels.panel(k))
    }

    /// Largest pressure at its points, either way, Pa.
    pub(crate) fn largest(&self) -> f64 {
        self.given.pressure.iter().fold(0.0, |largest, value| f64::max(largest, value.abs()))
    }

    /// The weighted sum of cycles of one period: polynomials between all of their edges.
    pub fn blend(parts: &[(f64, &Self)], name: String) -> Result<Self> {
        let Some(&(_, first)) = parts.first() else {
            return Err(Error::value("cycles", "[]", "give at least one"));
        };
        if parts.iter().any(|(_, cycle)| cycle.strokes != first.strokes) {
            return Err(Error::value("cycles", "of 2 and 4 strokes", "give cycles of one period"));
        }
        let panels: Vec<_> = parts.iter().map(|&(weight, cycle)| (weight, &cycle.panels)).collect();
        let (theta_deg, pressure, degree) = interpolant::blend(&panels);
        let strokes = first.given.strokes;
        Self::new(Given { name, strokes, theta_deg, pressure, degree: Some(degree) })
    }

    /// The table with every other point alone, from the first or the second on; none for polynomials
    /// and tables too short for it.
    #[must_use]
    pub fn thinned(&self, from_second: bool) -> Option<Self> {
        if self.given.degree.is_some() {
            return None;
        }
        let (angles, values) = (&self.given.theta_deg, &self.given.pressure);
        let count = angles.len() - usize::from(self.is_closed());
        let mut places: Vec<usize> = (usize::from(from_second)..count).step_by(2).collect();
        if from_second && count % 2 == 1 {
            // Neighbours, or the step to the next period would be of three.
            places.push(count - 1);
        }
        let first = *places.first()?;
        let pick = |list: &[f64]| places.iter().map(|&k| list[k]).collect();
        let (mut theta_deg, mut pressure): (Vec<f64>, Vec<f64>) = (pick(angles), pick(values));
        // Closed: of uneven steps, that to the next period may be the widest.
        theta_deg.push(angles[first] + period_deg(self.strokes));
        pressure.push(values[first]);
        let few = theta_deg.len() <= FEWEST_POINTS;
        let given = Given { theta_deg, pressure, ..self.given.clone() };
        if few { None } else { Self::new(given).ok() }
    }
}

fn period_deg(strokes: Strokes) -> f64 {
    180.0 * f64::from(strokes.number())
}

/// The error of a grid that does not cover a period.
fn no_period(angles: &[f64], period: f64) -> Error {
    let span = angles[angles.len() - 1] - angles[0];
    let strokes = period / 180.0;
    let radians = period.to_radians();
    let mut hint = format!("give one period, {period}° (strokes = {strokes})");
    if (span - radians).abs() <= 0.05 * radians {
        hint += "; was it given in radians?";
    } else if period == 720.0 && repeats_first(angles, 360.0).is_some() {
        hint += "; give strokes = 2 if this is a whole cycle";
    } else if span > period {
        hint += "; of several cycles, give one or their mean";
    }
    Error::value("theta_deg", format!("{span}° in all"), hint)
}

#[cfg(test)]
mod tests;
