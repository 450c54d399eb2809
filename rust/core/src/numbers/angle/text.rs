//! Angles as text.

use std::fmt;
use std::str::FromStr;

use super::{Angle, Turns, turns_of_degrees};
use crate::numbers::decimal;
use crate::numbers::error::{Error, Result};
use crate::numbers::rational;

impl FromStr for Angle {
    type Err = Error;

    /// Degrees, exact: a fraction (`"360/7"`) or a decimal of up to 12 significant digits
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
        let exact = decimal::parse(text)
            .and_then(|(numerator, denominator)| turns_of_degrees(numerator, denominator));
        Ok(exact.unwrap_or(double))
    }
}

impl fmt::Display for Angle {
    /// Degrees that read back as the same angle: the shortest decimal, else a fraction.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shortest = self.degrees().to_string();
        match self.0 {
            Turns(numerator, denominator) if shortest.parse() != Ok(*self) => {
                let (above, below) = (i128::from(numerator) * 360, i128::from(denominator));
                let divisor = rational::common_divisor(above, below);
                write!(f, "{}/{}", above / divisor, below / divisor)
            }
            _ => f.write_str(&shortest),
        }
    }
}
