//! Angles, exact where they are a rational part of a turn.
//!
//! Sums that should vanish do so because angles are k/N of a turn; as doubles in radians they do
//! not. An [`Angle`] is a fraction of a turn wherever it can be, so that `n·θ` is reduced in integers
//! and its phasor is good to the last bit at every order. Any other angle is a double of degrees,
//! where reduction by whole turns is exact too.
//!
//! Typed angles are exact: fractions as written ([`Angle`]'s `FromStr`), decimals and doubles as
//! [`crate::numbers::decimal`] reads them ([`Angle::from_degrees`]). Sums, differences and halves of
//! exact angles are exact as long as their denominator fits, so that one angle reached in two ways
//! is one value.

use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, Neg, Sub};
use std::str::FromStr;

use crate::Complex64;
use crate::numbers::decimal::{self, WITHIN_ULP, ulp};
use crate::numbers::double::fused;
use crate::numbers::error::{Error, Result};
use crate::numbers::rational::{self, nearest};

/// A double that is no decimal stands for k/N of a turn up to this N, where it is within
/// [`WITHIN_ULP`] of it.
const MOST_PARTS_RECOGNISED: f64 = 1000.0;
/// Fractions with a larger denominator become doubles. Halves of halves of angles of 14 places need
/// 1.44e17; nine times this limit, which [`cis_turns`] adds up to, is below 2^63.
const LARGEST_DENOMINATOR: i64 = 1_000_000_000_000_000_000;
/// Distance in degrees up to which [`Angle::near_miss`] names a simple fraction of a turn.
const NEAR_MISS: f64 = 1e-5;
/// What rounding may leave of a difference of angles that are no parts of a turn, degrees: up to a
/// thousand additions below 1024°, each rounded to 1.1e-13 at most.
pub const MOST_ROUNDING: f64 = 1e-9;
/// Largest angle, degrees; beyond it a double no longer resolves a thousandth of a degree.
pub const LARGEST_ANGLE: f64 = 1e12;

/// An angle: a reduced fraction of a turn, or a finite double of degrees.
///
/// ```
/// use crankpin_core::Angle;
///
/// let seventh: Angle = "360/7".parse()?;
/// assert_eq!(seventh.times(7), Angle::TURN); // exactly
/// assert_eq!(Angle::from_degrees(51.4)? + Angle::from_degrees(0.6)?, "52".parse()?);
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Angle(AngleForm);

#[derive(Debug, Clone, Copy, PartialEq)]
enum AngleForm {
    /// `numerator / denominator` turns, reduced, 0 < denominator ≤ [`LARGEST_DENOMINATOR`].
    Turns(i64, i64),
    /// Degrees that stand for no fraction: [`Angle::of_double`] gives the same value again.
    Degrees(f64),
}

use AngleForm::{Degrees, Turns};

impl Default for Angle {
    fn default() -> Self {
        Self::ZERO
    }
}

impl Angle {
    /// Zero.
    pub const ZERO: Self = Self::whole_turns(0);
    /// 90°.
    pub const QUARTER_TURN: Self = Self(Turns(1, 4));
    /// 180°.
    pub const HALF_TURN: Self = Self(Turns(1, 2));
    /// 360°.
    pub const TURN: Self = Self::whole_turns(1);

    /// This many turns.
    #[must_use]
    pub const fn whole_turns(turns: i32) -> Self {
        Self(Turns(turns as i64, 1))
    }

    /// From degrees. A double stands for the decimal of at most 12 significant digits within 4 units
    /// in its last place; else for k/N of a turn with N ≤ 1000, as near; else for itself.
    pub fn from_degrees(degrees: f64) -> Result<Self> {
        if !degrees.is_finite() || degrees.abs() > LARGEST_ANGLE {
            let hint = format!("give finite degrees of magnitude {LARGEST_ANGLE:e} at most");
            return Err(Error::figure("angle", degrees, hint));
        }
        Ok(Self::of_double(degrees))
    }

    /// From `numerator / denominator` degrees.
    pub fn from_degree_fraction(numerator: i64, denominator: i64) -> Result<Self> {
        Self::of_fraction(numerator.into(), denominator.into())
    }

    /// From `numerator / denominator` turns.
    pub fn from_turns(numerator: i64, denominator: i64) -> Result<Self> {
        Self::of_fraction(i128::from(numerator) * 360, denominator.into())
    }

    /// Exact where the denominator fits, else the nearest double.
    fn of_fraction(numerator: i128, denominator: i128) -> Result<Self> {
        if denominator == 0 {
            let value = format!("{numerator}/0");
            return Err(Error::value("angle", value, "the denominator must not be 0"));
        }
        match turns_of_degrees((numerator, denominator)) {
            Some(angle) if angle.degrees().abs() <= LARGEST_ANGLE => Ok(angle),
            _ => Self::from_degrees(nearest(numerator, denominator)),
        }
    }

    /// What a finite double of degrees stands for.
    fn of_double(degrees: f64) -> Self {
        decimal::meant(degrees)
            .and_then(turns_of_degrees)
            .or_else(|| recognise(degrees, WITHIN_ULP * ulp(degrees)))
            .unwrap_or(Self(Degrees(degrees)))
    }

    /// Numerator and denominator (> 0, in lowest terms) of the fraction of a turn; None for an angle
    /// that is none.
    #[must_use]
    pub fn turns(self) -> Option<(i64, i64)> {
        match self.0 {
            Turns(numerator, denominator) => Some((numerator, denominator)),
            Degrees(_) => None,
        }
    }

    /// In degrees, the nearest double.
    #[must_use]
    pub fn degrees(self) -> f64 {
        match self.0 {
            Turns(numerator, denominator) => {
                nearest(i128::from(numerator) * 360, denominator.into())
            }
            Degrees(degrees) => degrees,
        }
    }

    /// Whether two directions are one, but for rounding.
    #[must_use]
    pub fn is_direction_of(self, other: Self) -> bool {
        let turned = (self - other).reduced().degrees();
        turned.min(360.0 - turned) <= MOST_ROUNDING
    }

    /// Reduced modulo one turn, to [0°, 360°).
    #[must_use]
    pub fn reduced(self) -> Self {
        self.reduced_to(1)
    }

    /// Reduced modulo a cycle of `turns` turns, at least one.
    #[must_use]
    pub fn reduced_to(self, turns: i64) -> Self {
        let turns = turns.max(1);
        match self.0 {
            Turns(numerator, denominator) => {
                // Above 64 bits the cycle is longer than any angle.
                let rest = turns.checked_mul(denominator).map(|cycle| numerator.rem_euclid(cycle));
                Self(Turns(rest.unwrap_or(numerator), denominator))
            }
            Degrees(degrees) => {
                let rest = Self::of_double(degrees.rem_euclid(360.0 * turns as f64));
                // Without whole turns it may be a fraction after all; -1e-20 is rounded up to one.
                if rest.turns().is_some() { rest.reduced_to(turns) } else { rest }
            }
        }
    }

    /// Snaps to k/N of a turn (N ≤ 1000) if one lies within `within` degrees, for angles with more
    /// than a few ulps of rounding error.
    #[must_use]
    pub fn nearby_part(self, within: f64) -> Self {
        match self.0 {
            Turns(..) => self,
            Degrees(degrees) => recognise(degrees, within).unwrap_or(self),
        }
    }

    /// The simple fraction k/N of a turn (N ≤ 1000) that lies within 1e-5° of this angle without
    /// being it, and the distance in degrees: 51.428571° is 4.3e-7° from 360/7°.
    #[must_use]
    pub fn near_miss(self) -> Option<(Self, f64)> {
        if self.turns().is_some_and(|(_, parts)| parts as f64 <= MOST_PARTS_RECOGNISED) {
            return None;
        }
        let simple = recognise(self.degrees(), NEAR_MISS)?;
        Some((simple, (self - simple).degrees().abs()))
    }

    /// Whether it is a decimal of degrees, which can be typed as it is.
    #[must_use]
    pub fn is_decimal(self) -> bool {
        self.turns().is_some_and(|(numerator, denominator)| {
            let degrees = 360 * i128::from(numerator);
            let below = i128::from(denominator);
            let mut rest = below / rational::common_divisor(degrees, below);
            for factor in [2, 5] {
                while rest % factor == 0 {
                    rest /= factor;
                }
            }
            rest == 1
        })
    }

    /// Half the angle.
    #[must_use]
    pub fn half(self) -> Self {
        self.over(2)
    }

    /// The angle over a whole number that is not zero.
    #[must_use]
    pub fn over(self, parts: i32) -> Self {
        let signed = if parts < 0 { -self } else { self };
        let part = signed.turns().and_then(|(numerator, denominator)| {
            turns(numerator.into(), i128::from(denominator) * i128::from(parts.unsigned_abs()))
        });
        part.unwrap_or_else(|| Self::of_double(self.degrees() / f64::from(parts)))
    }

    /// A whole multiple of the angle.
    #[must_use]
    pub fn times(self, count: i32) -> Self {
        let multiple = self.turns().and_then(|(numerator, denominator)| {
            turns(i128::from(numerator) * i128::from(count), denominator.into())
        });
        multiple.unwrap_or_else(|| Self::of_double(self.degrees() * f64::from(count)))
    }

    /// The unit phasor `e^{i·n·angle}`.
    #[must_use]
    pub fn cis(self, n: i64) -> Complex64 {
        match self.0 {
            Turns(numerator, denominator) => {
                let multiple = match numerator.checked_mul(n) {
                    Some(product) => product.rem_euclid(denominator),
                    None => (i128::from(numerator) * i128::from(n))
                        .rem_euclid(i128::from(denominator)) as i64,
                };
                cis_turns(multiple, denominator)
            }
            Degrees(degrees) => cis_multiple(degrees, n),
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

/// `e^{i·n·degrees}` of exactly this double.
pub(crate) fn cis_multiple(degrees: f64, n: i64) -> Complex64 {
    // n·degrees as an exact sum of two doubles, each reduced by itself.
    let product = degrees * n as f64;
    let rest = fused(degrees, n as f64, -product);
    let base = cis_degrees(product);
    if rest == 0.0 { base } else { base * cis_degrees(rest) }
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

/// The fraction of a turn in lowest terms; None where its denominator, given above 0, is too large.
fn turns(numerator: i128, denominator: i128) -> Option<Angle> {
    // Nearly always both fit in 64 bits, where division is many times faster.
    let divisor = match (u64::try_from(numerator.unsigned_abs()), u64::try_from(denominator)) {
        (Ok(a), Ok(b)) => rational::divisor(a, b).into(),
        _ => rational::divisor(numerator.unsigned_abs(), denominator.unsigned_abs()),
    };
    let divisor = i128::try_from(divisor).ok()?;
    let numerator = i64::try_from(numerator / divisor).ok().filter(|&n| n != i64::MIN)?;
    let denominator = i64::try_from(denominator / divisor).ok()?;
    (denominator <= LARGEST_DENOMINATOR).then_some(Angle(Turns(numerator, denominator)))
}

/// The same of a fraction of degrees, with a denominator of either sign.
fn turns_of_degrees((numerator, denominator): (i128, i128)) -> Option<Angle> {
    let sign = denominator.signum();
    turns(numerator.checked_mul(sign)?, denominator.checked_mul(360 * sign)?)
}

/// Continued fraction of the angle in turns, up to [`MOST_PARTS_RECOGNISED`], within a tolerance in degrees.
fn recognise(degrees: f64, within: f64) -> Option<Angle> {
    for (p, q) in rational::convergents(degrees / 360.0, MOST_PARTS_RECOGNISED) {
        let candidate = turns(p as i128, q as i128)?;
        if (candidate.degrees() - degrees).abs() <= within {
            return Some(candidate);
        }
    }
    None
}

impl Add for Angle {
    type Output = Self;

    /// Exact between fractions as long as the denominator fits, and where one is zero.
    fn add(self, other: Self) -> Self {
        if let Turns(0, _) = other.0 {
            return self;
        }
        if let Turns(0, _) = self.0 {
            return other;
        }
        if let (Turns(a, b), Turns(c, d)) = (self.0, other.0) {
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
        Self::of_double(self.degrees() + other.degrees())
    }
}

impl PartialOrd for Angle {
    /// Fractions of a turn are compared in integers.
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        if let (Turns(a, b), Turns(c, d)) = (self.0, other.0) {
            let (a, b, c, d) = (i128::from(a), i128::from(b), i128::from(c), i128::from(d));
            return Some((a * d).cmp(&(c * b)));
        }
        match self.degrees().partial_cmp(&other.degrees()) {
            // A fraction of a turn and another angle whose nearest doubles are equal still differ.
            Some(Ordering::Equal) if self != other => None,
            found => found,
        }
    }
}

impl Neg for Angle {
    type Output = Self;

    fn neg(self) -> Self {
        Self(match self.0 {
            Turns(numerator, denominator) => Turns(-numerator, denominator),
            Degrees(degrees) => Degrees(-degrees),
        })
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

    /// Degrees, exact: a fraction (`"360/7"`) or a decimal (`"51.4"`). A decimal of more digits than
    /// `numbers::decimal` reads stands for what its nearest double stands for, and one within the
    /// rounding of k/N of a turn, N ≤ 1000, that no decimal is, for that: it was printed of one.
    fn from_str(text: &str) -> Result<Self> {
        let wrong = || Error::value("angle", text, "give degrees, such as 90, 51.4 or \"360/7\"");
        if let Some((numerator, denominator)) = text.split_once('/') {
            let numerator = numerator.trim().parse().map_err(|_| wrong())?;
            let denominator = denominator.trim().parse().map_err(|_| wrong())?;
            return Self::of_fraction(numerator, denominator);
        }
        let text = text.trim();
        let double = Self::from_degrees(text.parse().map_err(|_| wrong())?)?;
        let simple = double.turns().is_some_and(|(_, parts)| parts as f64 <= MOST_PARTS_RECOGNISED);
        if simple && !double.is_decimal() {
            return Ok(double);
        }
        Ok(decimal::parse(text).and_then(turns_of_degrees).unwrap_or(double))
    }
}

impl fmt::Display for Angle {
    /// Degrees that are exactly this angle: the shortest decimal, or a fraction; and with an exponent
    /// a double whose decimal is another angle.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shortest = self.degrees().to_string();
        match self.0 {
            Turns(numerator, denominator)
                if !self.is_decimal() || shortest.parse() != Ok(*self) =>
            {
                let (above, below) = (i128::from(numerator) * 360, i128::from(denominator));
                let divisor = rational::common_divisor(above, below);
                write!(f, "{}/{}", above / divisor, below / divisor)
            }
            Degrees(degrees) if shortest.parse() != Ok(*self) => write!(f, "{degrees:e}"),
            _ => f.write_str(&shortest),
        }
    }
}

#[cfg(test)]
mod tests;
