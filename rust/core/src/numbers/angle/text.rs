//! Angles as text.

use std::fmt;
use std::str::FromStr;

use super::{Angle, Degrees, Turns, turns_of_degrees};
use crate::numbers::error::{Error, Result};
use crate::numbers::rational;

/// Decimal text with more significant digits is that of a double: every double has 15, its shortest
/// form up to 17.
const MOST_EXACT_DIGITS: usize = 15;

impl FromStr for Angle {
    type Err = Error;

    /// Degrees, exact: a fraction (`"360/7"`) or a decimal number of up to 15 significant digits
    /// (`"51.4"`). A longer one stands for what its nearest double stands for.
    fn from_str(text: &str) -> Result<Self> {
        let wrong = || Error::value("angle", text, "give degrees, such as 90, 51.4 or \"360/7\"");
        if let Some((numerator, denominator)) = text.split_once('/') {
            let numerator = numerator.trim().parse().map_err(|_| wrong())?;
            let denominator = denominator.trim().parse().map_err(|_| wrong())?;
            return Self::of_fraction(numerator, denominator);
        }
        let text = text.trim();
        let double = Self::from_degrees(text.parse().map_err(|_| wrong())?)?;
        let exact = decimal(text)
            .filter(|&(_, _, digits)| digits <= MOST_EXACT_DIGITS)
            .and_then(|(numerator, denominator, _)| turns_of_degrees(numerator, denominator));
        Ok(exact.unwrap_or(double))
    }
}

impl fmt::Display for Angle {
    /// Degrees that read back as the same angle: the shortest decimal, else a fraction or, for a
    /// double whose shortest decimal is another angle, 18 digits.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let degrees = self.degrees();
        let shortest = degrees.to_string();
        if shortest.parse() == Ok(*self) {
            return f.write_str(&shortest);
        }
        match self.0 {
            Turns(numerator, denominator) => {
                let (above, below) = (i128::from(numerator) * 360, i128::from(denominator));
                let divisor = rational::common_divisor(above, below);
                write!(f, "{}/{}", above / divisor, below / divisor)
            }
            Degrees(degrees) => {
                let places = 17 - degrees.abs().log10().floor() as i32;
                write!(f, "{degrees:.*}", usize::try_from(places).unwrap_or(0))
            }
        }
    }
}

/// The shortest decimal that reads back as this double: numerator and denominator.
pub(super) fn shortest_decimal(degrees: f64) -> Option<(i128, i128)> {
    decimal(&format!("{degrees:e}")).map(|(numerator, denominator, _)| (numerator, denominator))
}

/// Numerator, denominator and number of significant digits of a decimal number; None if they do not
/// fit.
fn decimal(text: &str) -> Option<(i128, i128, usize)> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{decimals}");
    let significant = digits.trim_start_matches(['+', '-', '0']).len();
    let numerator: i128 = digits.parse().ok()?;
    let scale = i32::try_from(decimals.len()).ok()?.checked_sub(exponent)?;
    let power = 10_i128.checked_pow(scale.unsigned_abs())?;
    if scale < 0 {
        Some((numerator.checked_mul(power)?, 1, significant))
    } else {
        Some((numerator, power, significant))
    }
}
