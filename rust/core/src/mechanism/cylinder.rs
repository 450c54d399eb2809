//! The moving parts of one cylinder.
//!
//! Its rod may be infinite, as that of a Scotch yoke: λ = r/l is zero.

use super::exact::TorqueKey;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// Why an infinite rod takes neither offset nor inertia.
pub(super) const NEVER_LEANS: &str = "leave it out: an infinite rod never leans";

/// The moving parts of one cylinder. Rotating mass belongs to the throw: see [`crate::engine`].
///
/// ```
/// use crankpin_core::Cylinder;
/// use crankpin_core::mechanism::motion::CrankPosition;
///
/// let (crank_radius, rod_length, reciprocating_mass, pin_offset) = (0.043, 0.145, 0.66, 0.0);
/// let cylinder = Cylinder::new(crank_radius, rod_length, reciprocating_mass, pin_offset)?;
/// assert_eq!(cylinder.rod_ratio(), 0.043 / 0.145);
/// // At the top the piston is a crank and a rod away, and accelerates by 1 + λ of r·ω².
/// let top = cylinder.mechanism().motion(&CrankPosition::new(0.0, 1.0));
/// assert!((top.acceleration + 1.0 + cylinder.rod_ratio()).abs() < 1e-15);
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    crank_radius: f64,
    rod_length: f64,
    reciprocating_mass: f64,
    pin_offset: f64,
    rod_inertia_excess: f64,
}

impl Cylinder {
    /// Crank radius, rod length and pin offset in m, reciprocating mass in kg.
    ///
    /// An infinite rod never leans: it has no pin offset.
    pub fn new(
        crank_radius: f64,
        rod_length: f64,
        reciprocating_mass: f64,
        pin_offset: f64,
    ) -> Result<Self> {
        limits::length("crank_radius", crank_radius)?;
        if rod_length != f64::INFINITY {
            limits::length("rod_length", rod_length)?;
        }
        limits::not_negative("reciprocating_mass", reciprocating_mass)?;
        limits::finite("pin_offset", pin_offset)?;
        let cylinder = Self {
            crank_radius,
            rod_length,
            reciprocating_mass,
            pin_offset,
            rod_inertia_excess: 0.0,
        };
        if cylinder.has_infinite_rod() && pin_offset != 0.0 {
            return Err(Error::figure("pin_offset", pin_offset, NEVER_LEANS));
        }
        let reach = rod_length - pin_offset.abs();
        if crank_radius >= reach {
            let value = format!(
                "{crank_radius:?}, rod_length = {rod_length:?}, pin_offset = {pin_offset:?}"
            );
            let hint = format!(
                "the crank cannot turn; make crank_radius less than rod_length - |pin_offset| = \
                 {reach:?}"
            );
            return Err(Error::value("crank_radius", value, hint));
        }
        Ok(cylinder)
    }

    /// From bore and stroke in place of the crank radius, m. The motion does not depend on the bore,
    /// which is checked and not kept.
    pub fn from_bore_stroke(
        bore: f64,
        stroke: f64,
        rod_length: f64,
        reciprocating_mass: f64,
        pin_offset: f64,
    ) -> Result<Self> {
        limits::length("bore", bore)?;
        Self::from_stroke(stroke, rod_length, reciprocating_mass, pin_offset)
    }

    /// From the stroke in place of the crank radius, m.
    pub fn from_stroke(
        stroke: f64,
        rod_length: f64,
        reciprocating_mass: f64,
        pin_offset: f64,
    ) -> Result<Self> {
        limits::length("stroke", stroke)?;
        Self::new(0.5 * stroke, rod_length, reciprocating_mass, pin_offset)
    }

    /// With a rod whose moment of inertia about its centre of mass, I, is not that of two masses at
    /// its ends: I − m·a·b in kg·m², a and b the distances of the rod's m from them. Mostly below 0.
    pub fn with_rod_inertia_excess(self, excess: f64) -> Result<Self> {
        limits::inertia("rod_inertia_excess", excess)?;
        if self.has_infinite_rod() && excess != 0.0 {
            return Err(Error::figure("rod_inertia_excess", excess, NEVER_LEANS));
        }
        Ok(Self { rod_inertia_excess: excess, ..self })
    }

    /// The same masses with another rod ratio, of which 0 is that of an infinite rod.
    pub(crate) fn at_rod_ratio(self, ratio: f64) -> Result<Self> {
        if ratio == self.rod_ratio() {
            return Ok(self);
        }
        self.with_rod_length(self.crank_radius / ratio)
    }

    /// The same masses with a rod of another length, m.
    pub(crate) fn with_rod_length(self, rod_length: f64) -> Result<Self> {
        Self::new(self.crank_radius, rod_length, self.reciprocating_mass, self.pin_offset)?
            .with_rod_inertia_excess(self.rod_inertia_excess)
    }

    /// The same lengths without masses: the motion depends on no more.
    #[must_use]
    pub(crate) fn without_masses(self) -> Self {
        Self { reciprocating_mass: 0.0, rod_inertia_excess: 0.0, ..self }
    }

    /// The same cylinder on a crank that turns the other way: its offset is on the other side then.
    #[must_use]
    pub(crate) fn mirrored(self) -> Self {
        // Zero stays zero.
        Self { pin_offset: 0.0 - self.pin_offset, ..self }
    }

    /// Crank radius r, half the stroke, m.
    #[must_use]
    pub fn crank_radius(&self) -> f64 {
        self.crank_radius
    }

    /// Rod length l between its centres, m.
    #[must_use]
    pub fn rod_length(&self) -> f64 {
        self.rod_length
    }

    /// Mass that moves with the piston, kg.
    #[must_use]
    pub fn reciprocating_mass(&self) -> f64 {
        self.reciprocating_mass
    }

    /// Pin offset e (désaxé), m.
    #[must_use]
    pub fn pin_offset(&self) -> f64 {
        self.pin_offset
    }

    /// The rod's moment of inertia beyond that of its two masses, kg·m²; torque alone depends on it.
    #[must_use]
    pub fn rod_inertia_excess(&self) -> f64 {
        self.rod_inertia_excess
    }

    /// Whether it is other than zero.
    #[must_use]
    pub fn has_rod_inertia(&self) -> bool {
        self.rod_inertia_excess != 0.0
    }

    /// Whether its rod is infinite, as that of a Scotch yoke.
    #[must_use]
    pub fn has_infinite_rod(&self) -> bool {
        self.rod_length == f64::INFINITY
    }

    /// λ = r/l, zero of an infinite rod.
    #[must_use]
    pub fn rod_ratio(&self) -> f64 {
        self.crank_radius / self.rod_length
    }

    /// Distance of the piston from the crank's axis at its highest, m, without offset; of a Scotch yoke the crank
    /// radius alone.
    pub(crate) fn reach(&self) -> f64 {
        self.crank_radius + if self.has_infinite_rod() { 0.0 } else { self.rod_length }
    }

    /// Crank angles at which the piston is highest and lowest, where rod and crank are in line, degrees.
    #[must_use]
    pub fn turning_points_deg(&self) -> [f64; 2] {
        let past = |length: f64| (self.pin_offset / length).asin().to_degrees();
        [
            past(self.rod_length + self.crank_radius),
            180.0 + past(self.rod_length - self.crank_radius),
        ]
    }

    /// Distance between the ends of the piston's travel, m: twice the crank radius without pin offset.
    #[must_use]
    pub fn travel(&self) -> f64 {
        if self.pin_offset == 0.0 {
            return 2.0 * self.crank_radius;
        }
        let (radius, rod, offset) = (self.crank_radius, self.rod_length, self.pin_offset);
        // √((l + r)² − e²) − √((l − r)² − e²), whose digits would cancel, by the difference of the squares.
        let [highest, lowest] =
            [rod + radius, rod - radius].map(|l| ((l - offset) * (l + offset)).sqrt());
        4.0 * radius * rod / (highest + lowest)
    }

    /// m·r, the size of the first-order force over ω², kg·m.
    #[must_use]
    pub fn mass_radius(&self) -> f64 {
        self.reciprocating_mass * self.crank_radius
    }

    /// m·r², the size of the torques over ω², kg·m².
    #[must_use]
    pub fn mass_radius_squared(&self) -> f64 {
        self.mass_radius() * self.crank_radius
    }

    /// Weights of its torques.
    pub(crate) fn torque_weights(&self) -> [(TorqueKey, f64); 2] {
        [
            (TorqueKey::Masses, self.mass_radius_squared()),
            (TorqueKey::Swing, self.rod_inertia_excess),
        ]
    }
}

/// Area of a piston of this bore, m, in m².
#[must_use]
pub fn piston_area(bore: f64) -> f64 {
    ring_area(bore, 0.0)
}

/// Area between two diameters, m, in m²: however little they differ, to their rounding.
#[must_use]
pub(crate) fn ring_area(outer: f64, inner: f64) -> f64 {
    0.25 * std::f64::consts::PI * (outer - inner) * (outer + inner)
}
