//! Shafts at a fixed ratio to the crankshaft, and the unbalances that they carry.

use serde::{Deserialize, Serialize};

use super::CrankIndex;
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::{ListIndex, number_from_one};
use crate::numbers::is_default;
use crate::numbers::limits;
use crate::numbers::ratio::SpeedRatio;

/// Mass times eccentricity on a shaft (unbalance, ISO 21940).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Unbalance {
    /// Mass × distance from the axis, kg·m.
    pub amount: f64,
    /// Direction at θ = 0: from +x, or with `pin` from the direction of that crankpin, in the
    /// direction in which the crank turns.
    #[serde(rename = "angle_deg")]
    pub angle: Angle,
    /// Place along the crank, from the front, m.
    pub z: f64,
    /// Index of the cylinder whose crankpin it follows where pins move (a bob weight on a pin); in files its
    /// number, from 1.
    #[serde(default, skip_serializing_if = "is_default", with = "number_from_one")]
    pub pin: Option<usize>,
    /// Index of the crank that carries it, 0 for the main one; 0 with `pin`, whose crank it is on, and on
    /// balance shafts.
    #[serde(default, skip_serializing_if = "is_default")]
    pub crank: CrankIndex,
}

/// Part of an engine to which a load belongs, by index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// A cylinder: piston, rod, rotating mass and gas.
    Cylinder(usize),
    /// An unbalance of a crank besides rotating masses.
    Counterweight(usize),
    /// A balance shaft with all that it carries.
    Shaft(usize),
    /// A periodic load besides.
    Load(usize),
}

impl Origin {
    /// The cylinder whose figures act on its loads and whose piston moves; none of other parts.
    #[must_use]
    pub fn cylinder(self) -> Option<usize> {
        if let Self::Cylinder(i) = self { Some(i) } else { None }
    }

    /// What it is, in a word, and its index among those.
    #[must_use]
    pub fn named(self) -> (&'static str, usize) {
        match self {
            Self::Cylinder(i) => ("cylinder", i),
            Self::Counterweight(k) => ("counterweight", k),
            Self::Shaft(k) => ("shaft", k),
            Self::Load(k) => ("load", k),
        }
    }
}

/// A balance shaft: it turns at a fixed ratio to the crankshaft about an axis parallel to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaft {
    /// Name, may be empty.
    pub name: String,
    /// Speed over crank speed; negative where it turns against the crank.
    pub ratio: SpeedRatio,
    /// Place of its axis in the cross-section, x and y from the crank axis, m.
    pub axis: [f64; 2],
    /// What it carries; angles from +x, none at a pin.
    pub unbalances: Vec<Unbalance>,
}

/// A crankshaft. Every crank turns evenly: each has a flywheel of its own, and gears between cranks
/// transmit nothing that varies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crank {
    /// Place of its axis in the cross-section, x and y from the main crank's, m.
    pub axis: [f64; 2],
    /// Speed over that of the main crank; negative where it turns the other way.
    pub ratio: SpeedRatio,
}

/// Highest speed of a shaft over crank speed.
const FASTEST: f64 = 20.0;

impl Crank {
    /// The main crank, to which crank angles and ratios refer.
    pub const MAIN: Self = Self { axis: [0.0; 2], ratio: SpeedRatio::ONE };

    /// Direction of a crankpin, from +x, at θ = 0: it points along its bore at top dead centre, a crank
    /// angle of the main crank.
    #[must_use]
    pub fn pin(&self, bank: Angle, tdc: Angle) -> Angle {
        (bank - self.ratio.turned(tdc)).reduced()
    }

    /// First crank angle of the main crank, from 0°, at which a crankpin of this direction at θ = 0 points
    /// along its bore.
    #[must_use]
    pub fn tdc(&self, bank: Angle, pin: Angle) -> Angle {
        let ahead = if self.ratio.is_forward() { bank - pin } else { pin - bank };
        ahead.reduced().times(2).over(self.ratio.halves().abs())
    }
}

/// Rejects a ratio and an axis that no shaft or crank has; `place` is its name in errors,
/// and a point.
pub(super) fn check_rotation(place: &str, ratio: SpeedRatio, axis: [f64; 2]) -> Result<()> {
    if ratio.halves() == 0 || ratio.size() > FASTEST {
        let hint = format!(
            "give a multiple of 1/2 from -{FASTEST} to {FASTEST} except 0; 1 turns with the crank, \
             -2 against it at twice its speed"
        );
        return Err(Error::value(format!("{place}ratio"), ratio, hint));
    }
    for (axis, name) in axis.iter().zip(["x", "y"]) {
        limits::finite(&format!("{place}{name}"), *axis)?;
    }
    Ok(())
}

impl Unbalance {
    /// Checked, its angle reduced to one turn; `place` is its name in errors.
    pub(super) fn checked(mut self, place: &str, cylinders: usize, cranks: usize) -> Result<Self> {
        limits::not_negative(&format!("{place}.amount"), self.amount)?;
        limits::finite(&format!("{place}.z"), self.z)?;
        if self.crank.position() >= cranks {
            let hint = format!("give the number of a crank, below {cranks}");
            return Err(Error::value(format!("{place}.crank"), self.crank.position(), hint));
        }
        if self.pin.is_some() && self.crank != CrankIndex::MAIN {
            let hint = "leave it out: a weight at a crankpin is on the crank of that";
            return Err(Error::value(format!("{place}.crank"), self.crank.position(), hint));
        }
        if let Some(pin) = self.pin
            && pin >= cylinders
        {
            let hint = format!("give a cylinder's number, 1 to {cylinders}");
            return Err(Error::value(format!("{place}.pin"), pin.wrapping_add(1), hint));
        }
        self.angle = self.angle.reduced();
        Ok(self)
    }
}

impl Shaft {
    /// Checked; `place` is its name in errors.
    pub(super) fn checked(mut self, place: &str) -> Result<Self> {
        check_rotation(&format!("{place}."), self.ratio, self.axis)?;
        limits::name(&format!("{place}.name"), &self.name)?;
        check_count(&format!("{place}.unbalances"), self.unbalances.len())?;
        for (i, unbalance) in self.unbalances.iter_mut().enumerate() {
            let place = format!("{place}.unbalances[{i}]");
            if let Some(pin) = unbalance.pin {
                let hint = "leave it out: only the crankshaft has crankpins";
                return Err(Error::value(format!("{place}.pin"), pin.wrapping_add(1), hint));
            }
            if unbalance.crank != CrankIndex::MAIN {
                let hint = "leave it out: the shaft carries it";
                let crank = unbalance.crank.position();
                return Err(Error::value(format!("{place}.crank"), crank, hint));
            }
            *unbalance = unbalance.checked(&place, 0, 1)?;
        }
        Ok(self)
    }
}

/// Rejects lists longer than any engine has.
pub(super) fn check_count(argument: &str, count: usize) -> Result<()> {
    if count <= limits::MOST_UNBALANCES {
        return Ok(());
    }
    let hint = format!("give at most {}", limits::MOST_UNBALANCES);
    Err(Error::value(argument, format!("{count} entries"), hint))
}
