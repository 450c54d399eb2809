//! The motion of a piston that a rod joins to its crankpin.
//!
//! The piston stands at `x(θ) = r cos θ + √(l² − (r sin θ − e)²)` along its bore, θ measured from
//! the angle at which the crankpin points along the bore; e > 0 lies on the side to which the
//! crankpin swings after that.

use num_traits::CheckedDiv;

use super::exact::{ExactHarmonic, FigureKey, MotionKey, Rest};
use super::harmonics;
use super::harmonics::rod::TorqueHarmonics;
use super::motion::{CrankPosition, Cranks, Motion, MotionColumns, Swing, fill};
use super::{Cylinder, HarmonicsOf, Mechanism, is_equal};
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::double::Double;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::rational::decimal;
use crate::numbers::simd::vectorised;

/// Lengths of a slider-crank in units of its crank radius.
///
/// The rod's reach beyond the crank on either side is kept by itself: near the crank that cannot
/// turn, everything depends on it, and `l/r ± e/r − 1` would lose it to rounding. It is kept to twice
/// the digits, since order n goes with its n-th power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proportions {
    /// l/r.
    pub rod: f64,
    /// e/r.
    pub offset: f64,
    /// (l + e − r)/r > 0.
    pub above: Double,
    /// (l − e − r)/r > 0.
    pub below: Double,
}

impl Proportions {
    /// Of a cylinder whose rod is finite.
    fn of(cylinder: &Cylinder) -> Self {
        let (r, l, e) = (cylinder.crank_radius(), cylinder.rod_length(), cylinder.pin_offset());
        let reach = Double::sum(l, -r);
        Self {
            rod: l / r,
            offset: e / r,
            above: reach.plus(e).over(r),
            below: reach.plus(-e).over(r),
        }
    }

    /// From λ = r/l > 0 and e/r.
    pub fn new(rod_ratio: f64, offset: f64) -> Result<Self> {
        Self::check_rod_ratio(rod_ratio)?;
        limits::finite("pin_offset_ratio", offset)?;
        if rod_ratio == 0.0 {
            let hint = "an infinite rod has no proportions: it is that of a Scotch yoke";
            return Err(Error::figure("rod_ratio", rod_ratio, hint));
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
    fn motion_at(&self, crank: &CrankPosition) -> Motion {
        let CrankPosition { sin, cos, .. } = *crank;
        let Height { value: height, inverse, secant, rise, bend } = self.height_at(crank);
        let slope = (sin - self.offset) * inverse;
        let [velocity, acceleration] = [rise - sin, bend - cos];
        // h·h‴ = 3 sin θ cos θ + u cos θ − 3h′h″.
        let (rise, bend) = (velocity + sin, acceleration + cos);
        let of_height = cos * (4.0 * sin - self.offset) - 3.0 * rise * bend;
        let jerk = sin + of_height / (self.rod / secant);
        Motion { position: cos + height, velocity, acceleration, jerk, slope, secant }
    }

    #[inline(always)]
    fn height_at(&self, crank: &CrankPosition) -> Height {
        let CrankPosition { sin, cos, squared, to_above, to_below } = *crank;
        let height = ((self.above.high + to_above) * (self.below.high + to_below)).sqrt();
        let lateral = sin - self.offset;
        // h = √(l² − u²) with u = r sin θ − e: h' = −u u'/h, h'' = −(u u'' + l² u'²/h²)/h.
        let inverse = 1.0 / height;
        let secant = self.rod * inverse;
        let rise = -lateral * cos * inverse;
        let bend = (lateral * sin - secant * secant * squared) * inverse;
        Height { value: height, inverse, secant, rise, bend }
    }

    /// Velocity and acceleration at some positions and half a turn on, of a rod without an offset: what it adds
    /// to those of the crankpin is the same, to the last bit, and so are its root and its quotient.
    fn opposite_motions(&self, cranks: &Cranks, here: [&mut [f64]; 2], opposite: [&mut [f64]; 2]) {
        let ([velocity, acceleration], [opposite_velocity, opposite_acceleration]) =
            (here, opposite);
        let columns = [velocity, opposite_velocity, acceleration, opposite_acceleration];
        vectorised(
            #[inline(always)]
            || {
                fill(
                    cranks,
                    columns,
                    #[inline(always)]
                    |crank| {
                        let Height { rise, bend, .. } = self.height_at(crank);
                        [rise - crank.sin, rise + crank.sin, bend - crank.cos, bend + crank.cos]
                    },
                );
            },
        );
    }

    /// How the rod turns, where the crank stands so.
    #[inline(always)]
    fn swing_at(&self, crank: &CrankPosition) -> Swing {
        let (above, below) = (self.above.high, self.below.high);
        let CrankPosition { sin, cos, to_above, to_below, .. } = *crank;
        let height_squared = (above + to_above) * (below + to_below);
        let inverse = 1.0 / height_squared.sqrt();
        // h³φ'' = cos²θ(sin θ − e/r) − h² sin θ, in which 1 cancels out of l/r ± e/r.
        let bend =
            0.5 * (below * to_above * to_above - above * to_below * to_below) - above * below * sin;
        Swing { velocity: cos * inverse, acceleration: bend * inverse * inverse * inverse }
    }
}

/// Height of the wrist pin above the crankpin along the bore, in crank radii.
struct Height {
    value: f64,
    /// 1/`value`.
    inverse: f64,
    /// 1/cos φ.
    secant: f64,
    /// First and second derivative by crank angle.
    rise: f64,
    bend: f64,
}

/// The mechanism of most engines: a rod between crankpin and piston.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SliderCrank {
    /// What it was made of; it has no masses here.
    lengths: Cylinder,
    /// Those of its motion: its own, or those of a point of a sweep.
    proportions: Proportions,
}

impl SliderCrank {
    /// Of a cylinder whose rod is finite.
    pub fn new(cylinder: &Cylinder) -> Self {
        Self { lengths: cylinder.without_masses(), proportions: Proportions::of(cylinder) }
    }

    /// Of a cylinder at a ratio of crank radius to rod length and an offset over the crank radius.
    pub fn with_ratios(cylinder: &Cylinder, rod_ratio: f64, offset: f64) -> Result<Self> {
        let proportions = Proportions::new(rod_ratio, offset)?;
        Ok(Self { lengths: cylinder.without_masses(), proportions })
    }

    fn is_centred(&self) -> bool {
        self.offset() == 0.0
    }
}

impl Mechanism for SliderCrank {
    fn equals(&self, other: &dyn Mechanism) -> bool {
        is_equal(self, other)
    }

    fn motion(&self, crank: &CrankPosition) -> Motion {
        self.proportions.motion_at(crank)
    }

    fn swing(&self, crank: &CrankPosition) -> Swing {
        self.proportions.swing_at(crank)
    }

    fn motions(&self, cranks: &Cranks, into: MotionColumns) {
        let into = match into {
            MotionColumns {
                acceleration,
                velocity: Some(velocity),
                jerk: None,
                lean: None,
                opposite: Some(opposite),
            } if self.is_centred() => {
                return self.proportions.opposite_motions(
                    cranks,
                    [velocity, acceleration],
                    opposite,
                );
            }
            into => into,
        };
        vectorised(
            #[inline(always)]
            || {
                into.fill(
                    cranks,
                    #[inline(always)]
                    |crank| self.proportions.motion_at(crank),
                );
            },
        );
    }

    fn has_cheap_opposites(&self) -> bool {
        self.is_centred()
    }

    fn swings(&self, cranks: &Cranks, into: [&mut [f64]; 2]) {
        vectorised(
            #[inline(always)]
            || {
                fill(
                    cranks,
                    into,
                    #[inline(always)]
                    |crank| {
                        let Swing { velocity, acceleration } = self.proportions.swing_at(crank);
                        [velocity, acceleration]
                    },
                );
            },
        );
    }

    /// The rod would stand across the bore at sin θ = e/r ± l/r, above ±90°.
    fn to_singularity(&self, theta: f64) -> f64 {
        let Proportions { above, below, .. } = self.proportions;
        let quarter = std::f64::consts::FRAC_PI_2;
        let [above, below] = [(quarter, above), (-quarter, below)].map(|(at, beyond)| {
            let turns = (theta - at) / std::f64::consts::TAU;
            // acosh(1 + x) without loss of a small x.
            let beyond = beyond.high;
            let height = (beyond + (beyond * (beyond + 2.0)).sqrt()).ln_1p();
            ((turns - turns.round()) * std::f64::consts::TAU).hypot(height)
        });
        above.min(below)
    }

    fn force(&self, orders: &[u32], cancel: &Cancel) -> Result<Vec<Complex64>> {
        harmonics::coefficients(&self.proportions, orders, cancel)
    }

    fn force_beyond(&self, highest: u32) -> Option<f64> {
        harmonics::tail_bound(&self.proportions, highest)
    }

    fn torque(&self, orders: &[u32], cancel: &Cancel) -> Result<TorqueHarmonics> {
        harmonics::torque::torque(&self.proportions, orders, cancel)
    }

    fn torque_beyond(&self, highest: u32) -> Option<f64> {
        harmonics::torque::tail_bound(&self.proportions, highest)
    }

    fn swing_torque(&self, orders: &[u32], cancel: &Cancel) -> Result<TorqueHarmonics> {
        harmonics::rod::torque(&self.proportions, orders, cancel)
    }

    fn swing_torque_beyond(&self, highest: u32) -> Option<f64> {
        harmonics::rod::tail_bound(&self.proportions, highest)
    }

    fn offset(&self) -> f64 {
        self.proportions.offset
    }

    fn rod_ratio(&self) -> f64 {
        1.0 / self.proportions.rod
    }

    fn lengths(&self) -> &Cylinder {
        &self.lengths
    }

    /// Without offset √(1 − λ² sin²θ) is a power series in λ² whose terms give each order one sign. Of the
    /// torque order 4 falls from λ = 0.96 on, of the rod's order 2 from 0.91.
    fn grows_with_rod_ratio(&self, of: HarmonicsOf) -> bool {
        let up_to = match of {
            HarmonicsOf::Force => 1.0,
            HarmonicsOf::Torque => 0.95,
            HarmonicsOf::SwingTorque => 0.9,
        };
        self.is_centred() && self.rod_ratio() <= up_to
    }

    /// Quotients of lengths as they were typed; those of a point of a sweep are doubles.
    fn key(&self) -> MotionKey {
        let Proportions { rod, offset, .. } = self.proportions;
        let is_mirrored = offset < 0.0;
        let over_radius =
            |length: f64| decimal(length)?.checked_div(&decimal(self.lengths.crank_radius())?);
        let typed = [self.lengths.rod_length(), self.lengths.pin_offset().abs()].map(over_radius);
        let figures = match typed {
            [Some(rod), Some(offset)] if self.proportions == Proportions::of(&self.lengths) => {
                [rod, offset].map(FigureKey::Exact)
            }
            _ => [rod, offset.abs()].map(|figure| FigureKey::Nearest(figure.to_bits())),
        };
        MotionKey { figures: figures.into(), is_mirrored }
    }

    fn exact_force(&self, order: u32) -> ExactHarmonic {
        let (centred, is_odd) = (self.is_centred(), order % 2 == 1);
        let rest = match (is_odd, centred) {
            (false, _) => Rest::Even,
            (true, true) => Rest::None,
            (true, false) => Rest::Odd,
        };
        ExactHarmonic { crank: order == 1, rest, is_certain: centred }
    }

    fn exact_torque(&self, _: u32) -> ExactHarmonic {
        let centred = self.is_centred();
        let rest = if centred { Rest::Even } else { Rest::Both };
        ExactHarmonic { crank: false, rest, is_certain: centred }
    }

    /// p₂ of l/r and e/r.
    fn decay(&self) -> f64 {
        let reach = self.proportions.rod - self.proportions.offset.abs();
        1.0 / (reach + (reach * reach - 1.0).max(0.0).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

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
            let proportions = Proportions::of(&cylinder);
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
                Proportions::of(&cylinder).motion(sin, cos)
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
            let Proportions { above, below, .. } = Proportions::of(&cylinder);
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
        // An infinite rod may be asked for, and has no proportions.
        assert!(Proportions::check_rod_ratio(0.0).is_ok() && Proportions::new(0.0, 0.0).is_err());
    }

    #[test]
    fn a_rod_as_long_as_the_crank_turns_evenly() {
        // Up to the reach: φ = θ between the points where it turns back.
        let swing = |θ: f64| {
            let proportions = Proportions::new(1.0 - 1e-12, 0.0).unwrap();
            proportions.swing_at(&CrankPosition::new(θ.sin(), θ.cos()))
        };
        assert_relative_eq!(swing(0.7).velocity, 1.0, max_relative = 1e-11);
        assert_relative_eq!(swing(4.0).velocity, -1.0, max_relative = 1e-11);
        // −sin θ (l²/r² − 1)/h³ with 2·10⁻¹² of a bracket.
        let expected = -2e-12 * 0.7_f64.tan() / 0.7_f64.cos().powi(2);
        assert_relative_eq!(swing(0.7).acceleration, expected, max_relative = 1e-4);
    }

    #[test]
    fn swing_changes_as_it_moves() {
        let proportions = Proportions::new(0.4, -0.6).unwrap();
        let swing = |θ: f64| proportions.swing_at(&CrankPosition::new(θ.sin(), θ.cos()));
        for k in 0..24 {
            let θ = 0.25 * f64::from(k);
            let slope = (swing(θ + 1e-5).velocity - swing(θ - 1e-5).velocity) / 2e-5;
            // A central difference of step 1e-5.
            assert_relative_eq!(swing(θ).acceleration, slope, epsilon = 1e-9);
        }
    }
}
