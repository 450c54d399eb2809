//! One cylinder's moving parts and their exact motion at any crank angle.
//!
//! The piston stands at `x(θ) = r cos θ + √(l² − (r sin θ − e)²)` along its bore, θ measured from
//! the angle at which the crankpin points along the bore; e > 0 lies on the side to which the
//! crankpin swings after that.
//!
//! A rod may be infinite, as that of a Scotch yoke: λ = r/l is zero, and the piston moves by r cos θ
//! about the middle of its stroke.

use crate::numbers::double::Double;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// Why an infinite rod takes neither offset nor inertia.
const NEVER_LEANS: &str = "leave it out: an infinite rod never leans";

/// The moving parts of one cylinder. Rotating mass belongs to the throw: see [`crate::engine`].
///
/// ```
/// use crankpin_core::Cylinder;
///
/// let (crank_radius, rod_length, reciprocating_mass, pin_offset) = (0.043, 0.145, 0.66, 0.0);
/// let cylinder = Cylinder::new(crank_radius, rod_length, reciprocating_mass, pin_offset)?;
/// assert_eq!(cylinder.rod_ratio(), 0.043 / 0.145);
/// // At the top the piston is a crank and a rod away, and accelerates by 1 + λ of r·ω².
/// let top = cylinder.proportions().motion(0.0, 1.0);
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

    /// The same lengths without masses: the motion depends on no more.
    #[must_use]
    pub(crate) fn without_masses(self) -> Self {
        Self { reciprocating_mass: 0.0, rod_inertia_excess: 0.0, ..self }
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
    pub fn first_order(&self) -> f64 {
        self.reciprocating_mass * self.crank_radius
    }

    /// m·r², the size of the torques over ω², kg·m².
    #[must_use]
    pub fn second_moment(&self) -> f64 {
        self.first_order() * self.crank_radius
    }

    /// The proportions that fix the motion, with rod ratio and pin offset (m) replaced.
    pub fn proportions_with(
        &self,
        rod_ratio: Option<f64>,
        pin_offset: Option<f64>,
    ) -> Result<Proportions> {
        let (radius, offset) = (self.crank_radius, pin_offset.unwrap_or(self.pin_offset));
        match rod_ratio {
            Some(ratio) => Proportions::new(ratio, offset / radius),
            None => Self::new(radius, self.rod_length, 0.0, offset).map(|c| c.proportions()),
        }
    }

    /// The proportions that fix the motion.
    #[must_use]
    pub fn proportions(&self) -> Proportions {
        let Self { crank_radius: r, rod_length: l, pin_offset: e, .. } = *self;
        if self.has_infinite_rod() {
            return Proportions::INFINITE_ROD;
        }
        let reach = Double::sum(l, -r);
        Proportions {
            rod: l / r,
            offset: e / r,
            above: reach.plus(e).over(r),
            below: reach.plus(-e).over(r),
        }
    }
}

/// Area of a piston of this bore, m, in m².
#[must_use]
pub fn piston_area(bore: f64) -> f64 {
    0.25 * std::f64::consts::PI * bore * bore
}

/// A slider-crank in units of its crank radius.
///
/// The rod's reach beyond the crank on either side is kept by itself: near the crank that cannot
/// turn, everything depends on it, and `l/r ± e/r − 1` would lose it to rounding. It is kept to twice
/// the digits, since order n goes with its n-th power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proportions {
    /// l/r, which may be infinite.
    pub rod: f64,
    /// e/r.
    pub offset: f64,
    /// (l + e − r)/r > 0.
    pub above: Double,
    /// (l − e − r)/r > 0.
    pub below: Double,
}

impl Proportions {
    /// Those of a Scotch yoke.
    const INFINITE_ROD: Self = Self {
        rod: f64::INFINITY,
        offset: 0.0,
        above: Double { high: f64::INFINITY, low: 0.0 },
        below: Double { high: f64::INFINITY, low: 0.0 },
    };

    /// From λ = r/l, zero of an infinite rod, and e/r.
    pub fn new(rod_ratio: f64, offset: f64) -> Result<Self> {
        Self::check_rod_ratio(rod_ratio)?;
        limits::finite("pin_offset_ratio", offset)?;
        if rod_ratio == 0.0 {
            return match offset {
                0.0 => Ok(Self::INFINITE_ROD),
                _ => Err(Error::figure("pin_offset_ratio", offset, NEVER_LEANS)),
            };
        }
        let reach = Double::sum(1.0, -rod_ratio);
        let shift = Double::product(offset, rod_ratio);
        let above = reach.plus(shift.high).plus(shift.low).over(rod_ratio);
        let below = reach.plus(-shift.high).plus(-shift.low).over(rod_ratio);
        if above.high.min(below.high) <= 0.0 {
            let hint = format!(
                "the crank cannot turn at rod_ratio = {rod_ratio:?}; make |pin_offset / crank_radius| \
                 less than 1/rod_ratio - 1 = {:?}",
                reach.high / rod_ratio
            );
            return Err(Error::figure("pin_offset_ratio", offset, hint));
        }
        Ok(Self { rod: 1.0 / rod_ratio, offset, above, below })
    }

    /// Whether the rod is infinite, as that of a Scotch yoke.
    #[must_use]
    #[inline(always)]
    pub fn has_infinite_rod(&self) -> bool {
        self.rod == f64::INFINITY
    }

    /// Check that λ = r/l is in range: 0 ≤ λ < 1, zero of an infinite rod.
    // Inlined: tables check every ratio in a loop.
    #[inline]
    pub fn check_rod_ratio(rod_ratio: f64) -> Result<()> {
        if rod_ratio == 0.0 || (limits::SMALLEST..1.0).contains(&rod_ratio) {
            return Ok(());
        }
        Err(Self::rod_ratio_out_of_range(rod_ratio))
    }

    #[cold]
    fn rod_ratio_out_of_range(rod_ratio: f64) -> Error {
        let least = limits::SMALLEST;
        let hint = format!(
            "give crank radius over rod length, at least {least:e} and less than 1, or 0 of an infinite rod"
        );
        Error::figure("rod_ratio", rod_ratio, hint)
    }

    /// Position, velocity per ω and acceleration per ω² of the piston along its bore, in crank
    /// radii, where the crank has the given sine and cosine.
    #[must_use]
    #[inline]
    pub fn motion(&self, sin: f64, cos: f64) -> Motion {
        self.motion_at(&CrankPosition::new(sin, cos))
    }

    /// [`Self::motion`], where the crank stands so.
    #[inline(always)]
    pub(crate) fn motion_at(&self, crank: &CrankPosition) -> Motion {
        if self.has_infinite_rod() {
            self.motion_of::<true>(crank)
        } else {
            self.motion_of::<false>(crank)
        }
    }

    /// [`Self::motion_at`] of a Scotch yoke, or of a finite rod: chosen once, before a loop.
    #[inline(always)]
    pub(crate) fn motion_of<const YOKE: bool>(&self, crank: &CrankPosition) -> Motion {
        let CrankPosition { sin, cos, squared, to_above, to_below } = *crank;
        if YOKE {
            let [position, velocity, acceleration] = [cos, -sin, -cos];
            return Motion { position, velocity, acceleration, slope: 0.0, secant: 1.0 };
        }
        let height_squared = (self.above.high + to_above) * (self.below.high + to_below);
        let height = height_squared.sqrt();
        let lateral = sin - self.offset;
        // h = √(l² − u²) with u = r sin θ − e: h' = −u u'/h, h'' = −(u u'' + l² u'²/h²)/h.
        let inverse = 1.0 / height;
        let steepness = self.rod * inverse;
        let slope = lateral * inverse;
        let velocity = -lateral * cos * inverse;
        let acceleration = (lateral * sin - steepness * steepness * squared) * inverse;
        Motion {
            position: cos + height,
            velocity: velocity - sin,
            acceleration: acceleration - cos,
            slope,
            secant: steepness,
        }
    }
}

/// Where a crank stands, as far as nothing of the rod enters.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CrankPosition {
    pub sin: f64,
    pub cos: f64,
    /// cos²θ.
    pub squared: f64,
    /// 1 − sin θ.
    pub to_above: f64,
    /// 1 + sin θ.
    pub to_below: f64,
}

impl CrankPosition {
    #[inline(always)]
    pub fn new(sin: f64, cos: f64) -> Self {
        // (l + e − r sin θ)(l − e + r sin θ): with 1 ∓ sin θ = cos²θ/(1 ± sin θ) neither factor
        // loses digits where it is small.
        let squared = cos * cos;
        let (near, far) = (squared / (1.0 + sin.abs()), 1.0 + sin.abs());
        let (to_above, to_below) = if sin >= 0.0 { (near, far) } else { (far, near) };
        Self { sin, cos, squared, to_above, to_below }
    }
}

/// Where the piston is and how it moves, in crank radii; derivatives by crank angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// x/r, of an infinite rod from the middle of the stroke.
    pub position: f64,
    /// (dx/dθ)/r.
    pub velocity: f64,
    /// (d²x/dθ²)/r.
    pub acceleration: f64,
    /// tan φ of the rod's angle to the bore: above zero where its crankpin end lies on the side to
    /// which the crankpin swings after top dead centre.
    pub slope: f64,
    /// 1/cos φ.
    pub secant: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_long_rod_moves_its_piston_like_a_scotch_yoke() {
        let proportions = Proportions::new(1e-12, 0.0).unwrap();
        let motion = proportions.motion(0.6, 0.8);
        assert_relative_eq!(motion.velocity, -0.6, max_relative = 1e-11);
        assert_relative_eq!(motion.acceleration, -0.8, max_relative = 1e-11);
    }

    #[test]
    fn an_infinite_rod_moves_its_piston_as_a_scotch_yoke_does() {
        let cylinder = Cylinder::new(0.05, f64::INFINITY, 0.5, 0.0).unwrap();
        assert_eq!((cylinder.rod_ratio(), cylinder.has_infinite_rod()), (0.0, true));
        let proportions = cylinder.proportions();
        assert_eq!(proportions, Proportions::new(0.0, 0.0).unwrap());
        let known =
            Motion { position: 0.8, velocity: -0.6, acceleration: -0.8, slope: 0.0, secant: 1.0 };
        assert_eq!(proportions.motion(0.6, 0.8), known);
        for (cylinder, name) in [
            (Cylinder::new(0.05, f64::INFINITY, 0.5, 0.01), "pin_offset = 0.01"),
            (cylinder.with_rod_inertia_excess(-2e-3), "rod_inertia_excess = -0.002"),
            (Cylinder::new(0.05, f64::NEG_INFINITY, 0.5, 0.0), "rod_length = -inf"),
            (Cylinder::new(f64::INFINITY, f64::INFINITY, 0.5, 0.0), "crank_radius = inf"),
        ] {
            assert!(cylinder.unwrap_err().to_string().starts_with(name), "{name}");
        }
        assert!(Proportions::new(0.0, 0.01).is_err());
    }

    #[test]
    fn stroke_is_twice_the_radius_without_offset() {
        let proportions = Proportions::new(0.3, 0.0).unwrap();
        let top = proportions.motion(0.0, 1.0).position;
        let bottom = proportions.motion(0.0, -1.0).position;
        assert_relative_eq!(top - bottom, 2.0, max_relative = 1e-15);
    }

    /// x = cos θ + √((l/r)² − (sin θ − e/r)²), and its derivatives by central differences.
    #[test]
    fn motion_is_that_of_the_rod() {
        for offset in [0.0, 0.4, -0.4] {
            let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.05 * offset).unwrap();
            let proportions = cylinder.proportions();
            assert_relative_eq!(cylinder.rod_ratio(), 1.0 / 3.0, max_relative = 1e-15);
            let position = |θ: f64| θ.cos() + (9.0 - (θ.sin() - offset).powi(2)).sqrt();
            for k in 0..24 {
                let θ = f64::from(k) * 0.27;
                let (h, sin, cos) = (1e-4, θ.sin(), θ.cos());
                let motion = proportions.motion(sin, cos);
                let (before, here, after) = (position(θ - h), position(θ), position(θ + h));
                assert_relative_eq!(motion.position, here, max_relative = 1e-14);
                // h²/6 and h²/12 of the third and fourth derivatives, 2 at most; 1e-16/h² of rounding.
                assert!((motion.velocity - (after - before) / (2.0 * h)).abs() < 1e-8);
                assert!(
                    (motion.acceleration - (after - 2.0 * here + before) / (h * h)).abs() < 3e-7
                );
            }
        }
    }

    #[test]
    fn ends_of_the_travel_are_where_the_piston_turns() {
        for (rod, offset) in [(0.15, 0.0), (0.15, 0.02), (0.06, -0.004), (0.2, -0.03)] {
            let cylinder = Cylinder::new(0.05, rod, 1.0, offset).unwrap();
            let ends = cylinder.turning_points_deg().map(|angle| {
                let (sin, cos) = angle.to_radians().sin_cos();
                cylinder.proportions().motion(sin, cos)
            });
            // Roundings of some ten operations.
            assert!(ends.iter().all(|end| end.velocity.abs() < 1e-14), "{ends:?}");
            let travel = 0.05 * (ends[0].position - ends[1].position);
            assert_relative_eq!(cylinder.travel(), travel, max_relative = 1e-14);
        }
    }

    #[test]
    fn from_bore_stroke_halves_the_stroke_and_checks_the_bore() {
        let of = |bore, stroke| Cylinder::from_bore_stroke(bore, stroke, 0.15, 0.5, 0.01);
        assert_eq!(of(0.086, 0.1), Cylinder::new(0.05, 0.15, 0.5, 0.01));
        assert!(of(0.0, 0.1).unwrap_err().to_string().starts_with("bore = 0.0: "));
        assert!(of(0.086, -0.1).unwrap_err().to_string().starts_with("stroke = -0.1: "));
        assert!(of(0.086, 0.3).is_err());
    }

    #[test]
    fn the_lesser_reach_is_what_the_rod_has_beyond_crank_and_offset() {
        for (rod, offset) in [(0.15, 0.0), (0.06, 0.004), (0.06, -0.004), (0.051, 1e-4)] {
            let cylinder = Cylinder::new(0.05, rod, 1.0, offset).unwrap();
            let Proportions { above, below, .. } = cylinder.proportions();
            let left = (rod - f64::abs(offset)) / 0.05 - 1.0;
            // a unit in the last place of l/r, thrice
            assert!((left - above.high.min(below.high)).abs() < 2e-15);
        }
    }

    #[test]
    fn rod_inertia_changes_nothing_else() {
        let plain = Cylinder::new(0.05, 0.15, 0.5, 0.01).unwrap();
        let cylinder = plain.with_rod_inertia_excess(-2e-3).unwrap();
        assert_eq!((plain.rod_inertia_excess(), plain.has_rod_inertia()), (0.0, false));
        assert_eq!((cylinder.rod_inertia_excess(), cylinder.has_rod_inertia()), (-2e-3, true));
        assert_eq!(cylinder.with_rod_inertia_excess(0.0).unwrap(), plain);
        assert!(plain.with_rod_inertia_excess(f64::NAN).is_err());
    }

    #[test]
    fn a_crank_that_cannot_turn_is_refused() {
        assert!(Proportions::new(1.0, 0.0).is_err());
        assert!(Proportions::new(0.5, 1.0).is_err());
        assert!(Proportions::new(0.5, 0.999_999).is_ok());
        assert!(Cylinder::new(0.05, 0.15, 0.5, 0.1).is_err());
        assert!(Cylinder::new(0.05, f64::NAN, 0.5, 0.0).is_err());
        assert!(Cylinder::new(0.05, 0.15, -0.5, 0.0).is_err());
        assert!(Cylinder::new(0.05, 0.15, 0.5, 0.099).is_ok());
        for ratio in [1.0, 2.0, 1e-31, -0.3, f64::NAN] {
            assert!(Proportions::check_rod_ratio(ratio).is_err(), "{ratio}");
        }
        assert!(Proportions::check_rod_ratio(0.3).is_ok());
    }
}
