//! Speeds of shafts and cranks over that of the main crank, counted in halves.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::Complex64;
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};
use crate::numbers::order::Order;

/// Speed of a shaft or crank over that of the main crank: a multiple of ½, negative where it turns against
/// it. Engines reject 0.
///
/// ```
/// use crankpin_core::SpeedRatio;
///
/// let camshaft: SpeedRatio = "-1/2".parse()?;
/// assert_eq!((camshaft.number(), camshaft.order()?.number()), (-0.5, 0.5));
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SpeedRatio(i32);

impl SpeedRatio {
    /// That of the main crank itself.
    pub const ONE: Self = Self(2);
    /// Largest whole ratio that is counted in halves; engines take far less, and say what.
    pub const LARGEST_COUNTED: i32 = i32::MAX / 2;

    /// A whole ratio.
    #[must_use]
    pub const fn whole(ratio: i32) -> Self {
        Self(ratio.saturating_mul(2))
    }

    /// Twice the ratio.
    #[must_use]
    pub const fn from_halves(halves: i32) -> Self {
        Self(halves)
    }

    /// From a number, whole or half.
    pub fn from_number(ratio: f64) -> Result<Self> {
        let halves = 2.0 * ratio;
        if halves.fract() == 0.0 && halves.abs() <= f64::from(i32::MAX) {
            return Ok(Self(halves as i32));
        }
        Err(Error::figure("ratio", ratio, HINT))
    }

    /// That of what makes an order, with the main crank or against it.
    #[must_use]
    pub fn at(order: Order, forward: bool) -> Self {
        let halves = order.halves() as i32;
        Self(if forward { halves } else { -halves })
    }

    /// Twice the ratio.
    #[must_use]
    pub const fn halves(self) -> i32 {
        self.0
    }

    /// The ratio as a number.
    #[must_use]
    pub fn number(self) -> f64 {
        0.5 * f64::from(self.0)
    }

    /// How fast it is, whichever the sense.
    #[must_use]
    pub fn size(self) -> f64 {
        self.number().abs()
    }

    /// The order of what turns so.
    pub fn order(self) -> Result<Order> {
        Order::from_halves(self.halves_of_speed())
    }

    /// 1 with the main crank, -1 against it.
    #[must_use]
    pub fn sense(self) -> i32 {
        self.0.signum()
    }

    /// Whether it turns with the main crank.
    #[must_use]
    pub fn is_forward(self) -> bool {
        self.0 > 0
    }

    /// The ratio if it is whole.
    #[must_use]
    pub fn as_whole(self) -> Option<i32> {
        (self.0 % 2 == 0).then_some(self.0 / 2)
    }

    /// Whether it is as fast as the main crank.
    #[must_use]
    pub fn is_crank_speed(self) -> bool {
        self.0.abs() == 2
    }

    /// Twice how fast it is.
    #[must_use]
    pub const fn halves_of_speed(self) -> u32 {
        self.0.unsigned_abs()
    }

    /// `e^{±iρφ}` of an angle φ of the main crank, at this ratio ρ.
    #[must_use]
    pub fn cis(self, angle: Angle, sign: i32) -> Complex64 {
        let sign = i64::from(sign);
        match self.as_whole() {
            Some(ratio) => angle.cis(sign * i64::from(ratio)),
            None => angle.half().cis(sign * i64::from(self.0)),
        }
    }

    /// The angle by which it turns while the main crank turns by one.
    #[must_use]
    pub fn turned(self, angle: Angle) -> Angle {
        match self.as_whole() {
            Some(ratio) => angle.times(ratio),
            None => angle.half().times(self.0),
        }
    }
}

impl Default for SpeedRatio {
    /// That of the main crank.
    fn default() -> Self {
        Self::ONE
    }
}

const HINT: &str = "give a multiple of 1/2 but 0, such as \"1/2\", -1 or 2";

impl fmt::Display for SpeedRatio {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.as_whole() {
            Some(ratio) => write!(f, "{ratio}"),
            None => write!(f, "{}/2", self.0),
        }
    }
}

impl FromStr for SpeedRatio {
    type Err = Error;

    /// A number or a fraction.
    fn from_str(text: &str) -> Result<Self> {
        let number = |text: &str| text.trim().parse::<f64>().ok();
        let ratio = match text.split_once('/') {
            Some((above, below)) => number(above).zip(number(below)).map(|(a, b)| a / b),
            None => number(text),
        };
        let wrong = || Error::value("ratio", text, HINT);
        Self::from_number(ratio.ok_or_else(wrong)?).map_err(|_| wrong())
    }
}

impl Serialize for SpeedRatio {
    fn serialize<S: Serializer>(&self, to: S) -> std::result::Result<S::Ok, S::Error> {
        match self.as_whole() {
            Some(ratio) => ratio.serialize(to),
            None => self.number().serialize(to),
        }
    }
}

impl<'de> Deserialize<'de> for SpeedRatio {
    /// A number or a text.
    fn deserialize<D: Deserializer<'de>>(from: D) -> std::result::Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged, expecting = "expected a multiple of 1/2, such as \"1/2\", -1 or 2")]
        enum Typed {
            Number(f64),
            Text(String),
        }
        let ratio = match Typed::deserialize(from)? {
            Typed::Number(ratio) => Self::from_number(ratio),
            Typed::Text(text) => text.parse(),
        };
        ratio.map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_read_as_they_are_written() {
        for (text, halves) in [("1/2", 1), ("-3/2", -3), ("2", 4), ("-1", -2)] {
            let ratio = SpeedRatio::from_halves(halves);
            assert_eq!((text.parse(), ratio.to_string()), (Ok(ratio), text.to_owned()));
            let json = serde_json::to_string(&ratio).unwrap();
            let typed = |text: &str| serde_json::from_str::<SpeedRatio>(text).unwrap();
            assert_eq!([typed(&json), typed(&format!("\"{text}\""))], [ratio; 2]);
            assert_eq!(SpeedRatio::at(ratio.order().unwrap(), halves > 0), ratio);
        }
        for text in ["0.3", "1/3", "1/0", "x", "NaN", "1e300"] {
            let error = text.parse::<SpeedRatio>().unwrap_err().to_string();
            assert!(error.starts_with(&format!("ratio = {text}: ")), "{error}");
        }
        assert!(SpeedRatio::from_number(0.3).is_err());
        assert!(SpeedRatio::whole(0).order().is_err());
    }

    #[test]
    fn a_half_of_a_turn_is_exact() {
        let third: Angle = "120".parse().unwrap();
        let turned = |halves| SpeedRatio::from_halves(halves).turned(third);
        assert_eq!((turned(1), turned(-3)), ("60".parse().unwrap(), "-180".parse().unwrap()));
    }
}
