//! Angles, exact where they are a rational part of a turn.
//!
//! Sums that should vanish do so because angles are k/N of a turn; as doubles in radians they are
//! not. An [`Angle`] is kept as a fraction of a turn wherever it is one, so that `n·θ` is reduced in
//! integers and its phasor is good to the last bit at every order. Other angles stay in degrees,
//! where reduction by whole turns is exact too.

use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, Neg, Sub};
use std::str::FromStr;

use crate::Complex64;
use crate::error::{Error, Result};
use crate::rational;

/// A float is taken for k/N of a turn up to this N.
const MOST_PARTS: i128 = 1000;
/// ... when it is within so many units in the last place of it.
const WITHIN_ULP: f64 = 4.0;
/// Fractions with a larger denominator are kept as floats: sums of them would overflow.
const LARGEST_DENOMINATOR: i64 = 1_000_000_000;
/// Largest angle, degrees; beyond it a double no longer resolves a thousandth of a degree.
pub const LARGEST_ANGLE: f64 = 1e12;

/// An angle: a reduced fraction of a turn, or degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Angle {
    /// `numerator / denominator` turns, reduced, denominator > 0.
    Turns(i64, i64),
    /// Degrees that are no small fraction of a turn.
    Degrees(f64),
}

impl Angle {
    /// No angle.
    pub const ZERO: Self = Self::Turns(0, 1);

    /// From degrees; taken for k/N of a turn (N ≤ 1000) when within 4 units in the last place.
    pub fn from_degrees(degrees: f64) -> Result<Self> {
        if !degrees.is_finite() || degrees.abs() > LARGEST_ANGLE {
            let cure = format!("give finite degrees of magnitude {LARGEST_ANGLE:e} at most");
            return Err(Error::figure("angle", degrees, cure));
        }
        Ok(recognise(degrees, few_ulp(degrees)).unwrap_or(Self::Degrees(degrees)))
    }

    /// From `numerator / denominator` degrees.
    pub fn from_degree_fraction(numerator: i64, denominator: i64) -> Result<Self> {
        let (above, below) = (i128::from(numerator), i128::from(denominator));
        let exact = match denominator.signum() {
            0 => {
                let value = format!("{numerator}/0");
                return Err(Error::value("angle", value, "the denominator must not be 0"));
            }
            -1 => turns(-above, -below * 360),
            _ => turns(above, below * 360),
        };
        match exact {
            Some(angle) if angle.degrees().abs() <= LARGEST_ANGLE => Ok(angle),
            _ => Self::from_degrees(numerator as f64 / denominator as f64),
        }
    }

    /// In degrees, the nearest double.
    #[must_use]
    pub fn degrees(self) -> f64 {
        match self {
            Self::Turns(numerator, denominator) => {
                (i128::from(numerator) * 360) as f64 / denominator as f64
            }
            Self::Degrees(degrees) => degrees,
        }
    }

    /// Less whole turns: in [0°, 360°).
    #[must_use]
    pub fn reduced(self) -> Self {
        self.reduced_to(1)
    }

    /// Less whole cycles of so many turns.
    #[must_use]
    pub fn reduced_to(self, turns: i64) -> Self {
        match self {
            Self::Turns(numerator, denominator) => {
                Self::Turns(numerator.rem_euclid(turns * denominator), denominator)
            }
            Self::Degrees(degrees) => {
                let cycle = 360.0 * turns as f64;
                let rest = degrees.rem_euclid(cycle);
                // Less whole turns it may be a part of one after all; -1e-20 rounds up to one.
                recognise(rest, few_ulp(rest))
                    .map_or(Self::Degrees(rest), |part| part.reduced_to(turns))
            }
        }
    }

    /// The part of a turn (N ≤ 1000) within so many degrees, if there is one: for angles that
    /// rounding may have moved by more than units in the last place.
    #[must_use]
    pub fn nearby_part(self, within: f64) -> Self {
        match self {
            Self::Turns(..) => self,
            Self::Degrees(degrees) => recognise(degrees, within).unwrap_or(self),
        }
    }

    /// Half the angle.
    #[must_use]
    pub fn half(self) -> Self {
        match self {
            Self::Turns(numerator, denominator) => {
                turns(i128::from(numerator), i128::from(denominator) * 2)
                    .unwrap_or(Self::Degrees(self.degrees() / 2.0))
            }
            Self::Degrees(degrees) => Self::Degrees(degrees / 2.0),
        }
    }

    /// The unit phasor `e^{i·n·angle}`.
    #[must_use]
    pub fn cis(self, n: i64) -> Complex64 {
        match self {
            Self::Turns(numerator, denominator) => {
                let multiple = match numerator.checked_mul(n) {
                    Some(product) => product.rem_euclid(denominator),
                    None => (i128::from(numerator) * i128::from(n))
                        .rem_euclid(i128::from(denominator)) as i64,
                };
                cis_turns(multiple, denominator)
            }
            Self::Degrees(degrees) => {
                // n·degrees as an exact sum of two doubles, each reduced by itself.
                let product = degrees * n as f64;
                let rest = degrees.mul_add(n as f64, -product);
                let base = cis_degrees(product);
                if rest == 0.0 { base } else { base * cis_degrees(rest) }
            }
        }
    }
}

/// `e^{i·degrees}`: quadrants are taken off exactly, so that multiples of 90° give exact zeros.
#[must_use]
pub fn cis_degrees(degrees: f64) -> Complex64 {
    let degrees = degrees % 360.0;
    let quarter = (degrees / 90.0).round();
    let rest = (degrees - 90.0 * quarter).to_radians();
    rotate(rest, quarter as i64)
}

/// For a numerator in [0, denominator); denominators are small enough for the products.
fn cis_turns(numerator: i64, denominator: i64) -> Complex64 {
    // Nearest quarter, and what is left in [-1/8, 1/8] turn, both in integers.
    let quarter = (8 * numerator + denominator) / (2 * denominator);
    let rest = 4 * numerator - quarter * denominator;
    let radians = std::f64::consts::FRAC_PI_2 * (rest as f64 / denominator as f64);
    rotate(radians, quarter)
}

fn rotate(radians: f64, quarters: i64) -> Complex64 {
    let (sin, cos) = radians.sin_cos();
    match quarters.rem_euclid(4) {
        0 => Complex64::new(cos, sin),
        1 => Complex64::new(-sin, cos),
        2 => Complex64::new(-cos, -sin),
        _ => Complex64::new(sin, -cos),
    }
}

/// The reduced fraction of a turn, where its denominator, given above 0, is small enough to be added
/// to others.
fn turns(numerator: i128, denominator: i128) -> Option<Angle> {
    // Nearly always both fit in 64 bits, where division is many times faster.
    let divisor = match (u64::try_from(numerator.unsigned_abs()), u64::try_from(denominator)) {
        (Ok(a), Ok(b)) => rational::divisor(a, b).into(),
        _ => rational::divisor(numerator.unsigned_abs(), denominator.unsigned_abs()),
    };
    let divisor = i128::try_from(divisor).ok()?;
    let numerator = i64::try_from(numerator / divisor).ok()?;
    let denominator = i64::try_from(denominator / divisor).ok()?;
    (denominator <= LARGEST_DENOMINATOR).then_some(Angle::Turns(numerator, denominator))
}

fn few_ulp(degrees: f64) -> f64 {
    WITHIN_ULP * ulp(degrees)
}

/// Continued fraction of the angle in turns, up to [`MOST_PARTS`], within a tolerance in degrees.
fn recognise(degrees: f64, tolerance: f64) -> Option<Angle> {
    for (p, q) in rational::convergents(degrees / 360.0, MOST_PARTS) {
        let candidate = turns(p, q)?;
        if (candidate.degrees() - degrees).abs() <= tolerance {
            return Some(candidate);
        }
    }
    None
}

fn ulp(x: f64) -> f64 {
    let x = x.abs();
    f64::from_bits(x.to_bits() + 1) - x
}

impl Add for Angle {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if let (Self::Turns(a, b), Self::Turns(c, d)) = (self, other) {
            let sum = if b == d {
                turns(i128::from(a) + i128::from(c), b.into())
            } else {
                let (a, b, c, d) = (i128::from(a), i128::from(b), i128::from(c), i128::from(d));
                turns(a * d + c * b, b * d)
            };
            if let Some(sum) = sum {
                return sum;
            }
        }
        let sum = self.degrees() + other.degrees();
        recognise(sum, few_ulp(sum)).unwrap_or(Self::Degrees(sum))
    }
}

impl PartialOrd for Angle {
    /// Fractions of a turn are compared in integers.
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        if let (Self::Turns(a, b), Self::Turns(c, d)) = (*self, *other) {
            let (a, b, c, d) = (i128::from(a), i128::from(b), i128::from(c), i128::from(d));
            return Some((a * d).cmp(&(c * b)));
        }
        match self.degrees().partial_cmp(&other.degrees()) {
            // As `==` has it, an angle in degrees is no fraction of a turn.
            Some(Ordering::Equal) if self != other => None,
            found => found,
        }
    }
}

impl Neg for Angle {
    type Output = Self;

    fn neg(self) -> Self {
        match self {
            Self::Turns(numerator, denominator) => Self::Turns(-numerator, denominator),
            Self::Degrees(degrees) => Self::Degrees(-degrees),
        }
    }
}

impl Sub for Angle {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl FromStr for Angle {
    type Err = Error;

    /// Degrees as a decimal number (`"51.4"`) or a fraction (`"360/7"`).
    fn from_str(text: &str) -> Result<Self> {
        let wrong = || Error::value("angle", text, "give degrees, such as 90, 51.4 or \"360/7\"");
        if let Some((numerator, denominator)) = text.split_once('/') {
            let numerator = numerator.trim().parse().map_err(|_| wrong())?;
            let denominator = denominator.trim().parse().map_err(|_| wrong())?;
            return Self::from_degree_fraction(numerator, denominator);
        }
        Self::from_degrees(text.trim().parse().map_err(|_| wrong())?)
    }
}

impl fmt::Display for Angle {
    /// The shortest degrees that read back as the same angle: a number, or a fraction.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let degrees = self.degrees();
        if let Self::Turns(numerator, denominator) = *self
            && Self::from_degrees(degrees).ok() != Some(*self)
        {
            let numerator = i128::from(numerator) * 360;
            let denominator = i128::from(denominator);
            let divisor = rational::divisor(numerator.unsigned_abs(), denominator.unsigned_abs())
                .cast_signed();
            return write!(f, "{}/{}", numerator / divisor, denominator / divisor);
        }
        write!(f, "{degrees}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn small_fractions_of_a_turn_are_recognised() {
        assert_eq!(Angle::from_degrees(360.0 / 7.0), Ok(Angle::Turns(1, 7)));
        assert_eq!(Angle::from_degrees(-120.0), Ok(Angle::Turns(-1, 3)));
        assert_eq!("360/7".parse(), Ok(Angle::Turns(1, 7)));
        assert_eq!(Angle::from_degrees(0.0), Ok(Angle::ZERO));
        assert_eq!(Angle::from_degrees(49.54).unwrap(), Angle::Degrees(49.54));
        assert_eq!(Angle::from_degrees(1e-300).unwrap(), Angle::Degrees(1e-300));
    }

    #[test]
    fn a_float_is_a_fraction_within_four_units_in_the_last_place() {
        for (parts, part) in [(7, 360.0 / 7.0), (-7, -360.0 / 7.0), (997, 360.0 / 997.0)] {
            let exact = Angle::Turns(i64::from(parts).signum(), i64::from(parts).abs());
            let moved = |step: fn(f64) -> f64, times: u32| (0..times).fold(part, |x, _| step(x));
            for step in [f64::next_up, f64::next_down] {
                assert_eq!(Angle::from_degrees(moved(step, 4)), Ok(exact));
                let beyond = moved(step, 5);
                assert_eq!(Angle::from_degrees(beyond), Ok(Angle::Degrees(beyond)));
            }
        }
        // Given as a fraction it is one, of more parts too.
        assert_eq!(Angle::from_degree_fraction(1, 7), Ok(Angle::Turns(1, 2520)));
        assert_eq!(Angle::from_degree_fraction(1, -7), Ok(Angle::Turns(-1, 2520)));
    }

    #[test]
    fn quarter_turns_have_exact_phasors() {
        let quarter = Angle::from_degrees(90.0).unwrap();
        assert_eq!(quarter.cis(1), Complex64::new(0.0, 1.0));
        assert_eq!(quarter.cis(-1), Complex64::new(0.0, -1.0));
        assert_eq!(quarter.cis(10_002), Complex64::new(-1.0, 0.0));
    }

    #[test]
    fn no_angle_that_is_none() {
        for bad in [f64::NAN, f64::INFINITY, 1e300] {
            assert!(Angle::from_degrees(bad).is_err());
        }
        for bad in ["", "x", "1/0", "1/x", "nan", "1e400", "99999999999999999999/7"] {
            assert!(bad.parse::<Angle>().is_err(), "{bad}");
        }
        let error = Angle::from_degree_fraction(1, 0).unwrap_err().to_string();
        assert!(error.contains("1/0: the denominator"), "{error}");
    }

    #[test]
    fn angles_have_a_largest() {
        let largest = LARGEST_ANGLE as i64;
        assert_eq!(Angle::from_degrees(LARGEST_ANGLE).unwrap().degrees(), LARGEST_ANGLE);
        assert!(Angle::from_degrees(LARGEST_ANGLE.next_up()).is_err());
        assert_eq!(Angle::from_degree_fraction(largest, 1).unwrap().degrees(), LARGEST_ANGLE);
        assert!(Angle::from_degree_fraction(largest + 1, 1).is_err());
        assert!(Angle::from_degree_fraction(-largest - 1, 1).is_err());
    }

    #[test]
    fn fractions_of_large_denominator_are_degrees() {
        let denominator = 7_000_000_001;
        let angle = Angle::from_degree_fraction(1_000_000_000_001, denominator).unwrap();
        assert_eq!(angle, Angle::Degrees(1_000_000_000_001.0 / denominator as f64));
        let small = Angle::Turns(1, LARGEST_DENOMINATOR - 1);
        let half = 180.0 / (LARGEST_DENOMINATOR - 1) as f64;
        assert_eq!(small.half(), Angle::Degrees(half));
        assert_eq!(Angle::Turns(2, 7).half(), Angle::Turns(1, 7));
        assert_eq!(Angle::Turns(1, 7).half(), Angle::Turns(1, 14));
        assert_eq!(Angle::from_degree_fraction(90, -1), Ok(Angle::Turns(-1, 4)));
        assert_eq!(Angle::from_degree_fraction(-90, -2), Ok(Angle::Turns(1, 8)));
        assert_eq!(Angle::from_degree_fraction(0, -5), Ok(Angle::ZERO));
    }

    /// n·angle reduced to a turn exactly, in integers: a double of degrees is whole over 2^40 here.
    #[test]
    fn high_orders_of_any_angle_keep_their_phase() {
        let scale = 1_i128 << 40;
        for k in 1..50_i64 {
            let degrees = 123.0 + (7919 * k) as f64 / scale as f64 * 1e6;
            let degrees = (degrees * scale as f64).round() / scale as f64;
            let whole = (degrees * scale as f64) as i128;
            for n in [1, 3, 9_999, -10_000, 123_456_789] {
                let rest = (whole * n).rem_euclid(360 * scale) as f64 / scale as f64;
                let exact = Complex64::cis(rest.to_radians());
                // Both argument and unit are rounded: 2π·1.1e-16, and some units of the sine.
                assert!((Angle::Degrees(degrees).cis(n as i64) - exact).norm() < 3e-15);
            }
        }
        // Where the product overflows 64 bits as where it does not.
        let large = Angle::Turns(i64::MAX / 5, 7);
        let small = Angle::Turns((i64::MAX / 5) % 7, 7);
        assert_eq!(large.cis(10_000), small.cis(10_000));
        assert_eq!(large.cis(-10_001), small.cis(-10_001));
    }

    #[test]
    fn angles_are_in_order_only_with_their_like_or_where_they_differ() {
        let part = Angle::Turns(1, 4);
        assert_eq!(
            Angle::Degrees(49.54).partial_cmp(&Angle::Degrees(49.54)),
            Some(Ordering::Equal)
        );
        // `==` has a quarter turn differ from 90°, which arithmetic never leaves as degrees.
        assert_eq!(part.partial_cmp(&Angle::Degrees(90.0)), None);
        assert_eq!(part.partial_cmp(&Angle::Degrees(89.9)), Some(Ordering::Greater));
    }

    proptest! {
        #[test]
        fn text_reads_back(numerator in -10_000_i64..10_000, denominator in 1_i64..5_000) {
            let angle = Angle::from_degree_fraction(numerator, denominator).unwrap();
            prop_assert_eq!(angle.to_string().parse::<Angle>(), Ok(angle));
        }

        #[test]
        fn floats_read_back(degrees in -720.0..720.0) {
            let angle = Angle::from_degrees(degrees).unwrap();
            prop_assert_eq!(angle.to_string().parse::<Angle>(), Ok(angle));
            // recognition moves a float by 4 units in the last place at most
            prop_assert!((angle.degrees() - degrees).abs() <= 4.0 * ulp(degrees));
        }

        #[test]
        fn phasors_multiply(a in -400.0..400.0, b in -400.0..400.0, n in -50_i64..50) {
            let (a, b) = (Angle::from_degrees(a).unwrap(), Angle::from_degrees(b).unwrap());
            let difference = (a + b).cis(n) - a.cis(n) * b.cis(n);
            // the sum is rounded to half a unit of 1024° (1.1e-13°), turned n ≤ 50 times: 1e-13 rad
            prop_assert!(difference.norm() < 2e-13);
        }

        #[test]
        fn fractions_are_compared_as_they_are(a in -720_i64..720, b in -720_i64..720, n in 1_i64..9) {
            let turns = |k: i64| Angle::from_degree_fraction(k, n).unwrap();
            prop_assert_eq!(turns(a).partial_cmp(&turns(b)), a.partial_cmp(&b));
            let floats = (a as f64 + 0.123_456, b as f64 + 0.123_456);
            let degrees = |x| Angle::from_degrees(x).unwrap();
            prop_assert_eq!(degrees(floats.0).partial_cmp(&degrees(floats.1)), a.partial_cmp(&b));
        }

        #[test]
        fn reduction_stays_in_a_cycle(degrees in -1e6..1e6, turns in 1_i64..4) {
            let angle = Angle::from_degrees(degrees).unwrap();
            let rest = angle.reduced_to(turns);
            prop_assert!((0.0..360.0 * turns as f64).contains(&rest.degrees()));
            // both are rounded to half a unit of 1024°
            let apart = (rest.reduced() - angle.reduced()).degrees().abs();
            prop_assert!(apart.min(360.0 - apart) < 3e-13);
        }

        #[test]
        fn reduction_stays_in_one_turn(degrees in -1e6..1e6) {
            let angle = Angle::from_degrees(degrees).unwrap().reduced().degrees();
            prop_assert!((0.0..360.0).contains(&angle));
        }
    }
}
