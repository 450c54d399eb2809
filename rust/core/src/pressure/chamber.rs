//! The volume over a piston, and cycles that are put together of smooth curves.

use super::Strokes;
use super::{Cycle, Given, MOST_POINTS, period_deg};
use std::sync::Arc;

use crate::mechanism::Mechanism;
use crate::mechanism::cylinder::{Cylinder, piston_area};
use crate::mechanism::motion::CrankPosition;
use crate::numbers::angle::{Angle, cis_degrees};
use crate::numbers::chebyshev::{largest_of_last, points};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// Degree of the polynomials of computed cycles.
pub(super) const DEGREE: usize = 15;
/// Part of the largest value that the last coefficients of a polynomial may have: rounding.
pub(super) const RESOLVED: f64 = 2e-14;
/// Narrowest panel, degrees: a curve that still bends there is followed no closer.
pub(crate) const NARROWEST: f64 = 1e-4;

/// An end of a piston.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Face {
    /// At the head end: pressure pushes towards the crank, and angles are counted from top dead centre.
    Outer,
    /// At the crank end: pressure pushes away from the crank, and angles are counted from where the piston is lowest.
    Inner,
}

impl Face {
    /// Sign of the force towards the crank.
    #[must_use]
    pub const fn sign(self) -> f64 {
        match self {
            Self::Outer => 1.0,
            Self::Inner => -1.0,
        }
    }

    /// Angle from top dead centre to where its chamber is smallest without pin offset.
    pub(crate) const fn dead_centre(self) -> Angle {
        match self {
            Self::Outer => Angle::ZERO,
            Self::Inner => Angle::HALF_TURN,
        }
    }

    /// Place of the piston's turning point where its chamber is smallest, of highest and lowest.
    pub(crate) const fn turning_point(self) -> usize {
        match self {
            Self::Outer => 0,
            Self::Inner => 1,
        }
    }
}

/// How much of its stroke a piston leaves a chamber at one of its ends, as its crank turns.
#[derive(Debug, Clone)]
pub struct Swept {
    mechanism: Arc<dyn Mechanism>,
    /// Angle of the crank past top dead centre at which angles are zero, degrees.
    origin: f64,
    /// Position of the piston where the chamber is smallest, and its travel to the other end, below zero towards the
    /// crank, crank radii.
    smallest: f64,
    travel: f64,
    /// Angles at which the chamber is smallest and largest, degrees.
    pub(super) top: f64,
    pub(super) bottom: f64,
}

impl Swept {
    /// At an end of a cylinder's piston.
    #[must_use]
    pub fn new(cylinder: &Cylinder, face: Face) -> Self {
        let mechanism = cylinder.mechanism();
        let travel = cylinder.travel() / cylinder.crank_radius();
        let [highest, lowest] = cylinder.turning_points_deg();
        let (origin, travel, top, bottom) = match face {
            Face::Outer => (0.0, -travel, highest, lowest),
            Face::Inner => (lowest, travel, 0.0, highest + 360.0 - lowest),
        };
        let smallest = position(&*mechanism, top + origin);
        Self { mechanism, origin, smallest, travel, top, bottom }
    }

    /// Volume that the piston leaves, over that of its stroke, at an angle, degrees.
    #[must_use]
    pub fn at(&self, angle: f64) -> f64 {
        (position(&*self.mechanism, angle + self.origin) - self.smallest) / self.travel
    }

    /// Rounding of what it leaves: a few units of the last place of positions.
    fn rounding(&self) -> f64 {
        16.0 * f64::EPSILON * (self.smallest / self.travel).abs()
    }

    /// Angle at which it leaves a volume: as that grows, or as it shrinks.
    pub(super) fn angle_of(&self, swept: f64, growing: bool) -> f64 {
        let (mut less, mut more) =
            if growing { (self.top, self.bottom) } else { (self.top + 360.0, self.bottom) };
        for _ in 0..100 {
            let middle = 0.5 * (less + more);
            if self.at(middle) < swept { less = middle } else { more = middle }
        }
        0.5 * (less + more)
    }
}

/// Combustion chamber over a piston.
#[derive(Debug, Clone)]
pub struct Chamber {
    swept: Swept,
    /// Travel of the piston, m.
    pub(super) stroke: f64,
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
        let swept = Swept::new(cylinder, Face::Outer);
        let (stroke, top, bottom) = (cylinder.travel(), swept.top, swept.bottom);
        Ok(Self { swept, stroke, bore, compression_ratio, top, bottom, strokes })
    }

    /// Piston area, m².
    pub(super) fn area(&self) -> f64 {
        piston_area(self.bore)
    }

    /// Volume at a crank angle, degrees, over the clearance volume.
    #[must_use]
    pub fn ratio(&self, angle: f64) -> f64 {
        1.0 + (self.compression_ratio - 1.0) * self.swept.at(angle)
    }

    /// Clearance volume, m³.
    pub(super) fn clearance(&self) -> f64 {
        self.area() * self.stroke / (self.compression_ratio - 1.0)
    }

    /// Angle between the piston's highest and lowest point at which the volume is `ratio` clearances.
    pub(super) fn angle_of(&self, ratio: f64) -> f64 {
        self.swept.angle_of((ratio - 1.0) / (self.compression_ratio - 1.0), true)
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
        self.add_within(RESOLVED, from, to, of)
    }

    /// The same to within a part of its largest value.
    fn add_within(
        &mut self,
        tolerance: f64,
        from: f64,
        to: f64,
        of: impl Fn(f64) -> f64,
    ) -> Result<()> {
        let mut parts = vec![(from, to)];
        while let Some((low, high)) = parts.pop() {
            let values: Vec<f64> = points(low, high, DEGREE).map(&of).collect();
            if high - low < NARROWEST || is_resolved_within(tolerance, &values) {
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
    is_resolved_within(RESOLVED, values)
}

fn is_resolved_within(tolerance: f64, values: &[f64]) -> bool {
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    largest_of_last(values) <= tolerance * largest
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

/// A cycle of a compressor with ideal valves, one in each turn: polytropic expansion of what the clearance keeps,
/// suction, polytropic compression, discharge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compressor {
    /// Absolute pressure at which gas enters, Pa.
    pub suction: f64,
    /// Absolute pressure at which it leaves, Pa; none of an end that is unloaded, at suction pressure throughout.
    pub discharge: Option<f64>,
    /// Volume that is left where the chamber is smallest, over that of the stroke.
    pub clearance: f64,
    /// Exponent of compression: p·Vⁿ is constant.
    pub n: f64,
    /// Exponent of expansion.
    pub expansion_n: f64,
}

impl Compressor {
    /// The cycle at an end of a piston; valves open where the pressures are equal, to rounding.
    pub fn cycle(&self, swept: &Swept, name: String) -> Result<Cycle> {
        let suction = absolute("suction", self.suction)?;
        let discharge = self.discharge.map_or(Ok(suction), |p| absolute("discharge", p))?;
        let clearance = within("clearance", self.clearance, 0.0, 10.0)?;
        exponent("n", self.n)?;
        exponent("expansion_n", self.expansion_n)?;
        if discharge < suction {
            let hint = format!("give at least suction, {suction:?}");
            return Err(Error::figure("discharge", discharge, hint));
        }
        let ratio = discharge / suction;
        let [expansion, compression] = [self.expansion_n, self.n];
        // Parts of the stroke at which the suction valve opens, and the discharge valve.
        let enters = clearance * (ratio.powf(1.0 / expansion) - 1.0);
        let leaves = (1.0 + clearance) * ratio.powf(-1.0 / compression) - clearance;
        if enters > 1.0 || leaves < 0.0 {
            let most = |n: f64| 1.0 / (ratio.powf(1.0 / n) - 1.0);
            let hint = format!(
                "the valves never open: at this ratio of pressures give at most {:.6}",
                most(expansion).min(most(compression))
            );
            return Err(Error::figure("clearance", clearance, hint));
        }
        // A volume is the difference of two positions, of which it has the rounding.
        let resolved = |least: f64| RESOLVED.max(swept.rounding() / least);
        let mut curves = Curves::default();
        let (opens, bottom, end) = (swept.angle_of(enters, true), swept.bottom, swept.top + 360.0);
        let closes = if leaves < 1.0 { swept.angle_of(leaves, false) } else { bottom };
        if enters > 0.0 {
            curves.add_within(resolved(clearance), swept.top, opens, |angle| {
                let volume = clearance + swept.at(angle).max(0.0);
                (discharge * (clearance / volume).powf(expansion)).clamp(suction, discharge)
            })?;
        }
        let opens = if enters > 0.0 { opens } else { swept.top };
        if opens < bottom {
            curves.add(opens, bottom, |_| suction)?;
        }
        if closes > bottom {
            curves.add_within(resolved(clearance + leaves), bottom, closes, |angle| {
                let volume = clearance + swept.at(angle);
                let pressure = suction * ((1.0 + clearance) / volume).powf(compression);
                pressure.clamp(suction, discharge)
            })?;
        }
        curves.add(closes, end, |_| discharge)?;
        curves.cycle(name, Strokes::Two)
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
