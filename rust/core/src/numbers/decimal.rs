//! The decimal that a typed number stands for.
//!
//! 0.3 is typed, 0.299999999999999989 is what a double of it holds, and 3·0.1 is one unit in its last
//! place off. There is one reading of both, for angles, masses and lengths: a number of up to
//! `MOST_DIGITS` significant digits is exactly that decimal, a double within [`WITHIN_ULP`] units
//! in the last place of one stands for it, and any other double is itself. Text is exact with more
//! digits too, up to `MOST_DECIMALS` behind the point, unless it is written as doubles are, with an
//! exponent.

use crate::numbers::rational::{Ratio, nearest};

/// Every double keeps 15 digits; three of them leave room for the rounding of products and sums.
const MOST_DIGITS: usize = 12;
/// Most digits behind the point of longer text: as many as doubles from 64 to 1000 print.
const MOST_DECIMALS: usize = 14;
/// The least whole number with more than `MOST_DIGITS`.
const MOST_WHOLE: f64 = 1e12;
/// Places behind the point, and 1, that are tried before text is written.
const SHORT_PLACES: usize = 7;
/// Most digits before or behind the point.
const MOST_PLACES: u32 = 18;
/// Units in its last place within which a double is right.
pub const WITHIN_ULP: f64 = 4.0;

/// The decimal that a double stands for, if there is one: numerator and denominator.
pub(crate) fn meant(x: f64) -> Option<(i128, i128)> {
    // Most typed numbers have few places, and digits take longer to write and read.
    short(x).or_else(|| by_text(x))
}

/// The decimal that a double stands for, if it has few places behind the point.
fn short(x: f64) -> Option<(i128, i128)> {
    let mut power = 1.0;
    for _ in 0..SHORT_PLACES {
        let whole = (x * power).round();
        if whole.abs() >= MOST_WHOLE {
            return None;
        }
        // Whole numbers and powers of ten are exact: the quotient is rounded once.
        if (whole != 0.0 || x == 0.0) && (whole / power - x).abs() <= WITHIN_ULP * ulp(x) {
            return Some((whole as i128, power as i128));
        }
        power *= 10.0;
    }
    None
}

/// The same by the digits of the double.
fn by_text(x: f64) -> Option<(i128, i128)> {
    let (numerator, denominator) = parse(&format!("{x:.*e}", MOST_DIGITS - 1))?;
    let off = (nearest(numerator, denominator) - x).abs();
    (off <= WITHIN_ULP * ulp(x)).then_some((numerator, denominator))
}

/// The product of two numbers as they are meant, rounded once: 3 · 0.1 is 0.3.
#[must_use]
pub fn product(x: f64, y: f64) -> f64 {
    let exact = || {
        let [(a, b), (c, d)] = [meant(x)?, meant(y)?];
        let (above, below) = (a.checked_mul(c)?, b.checked_mul(d)?);
        if below < 1 << 72 {
            return Some(nearest(above, below));
        }
        let exact = Ratio::new(above, below);
        Some(nearest(*exact.numer(), *exact.denom()))
    };
    exact().unwrap_or(x * y)
}

/// The sum of two numbers as they are meant, rounded once: 0.1 + 0.2 is 0.3.
pub(crate) fn sum(x: f64, y: f64) -> f64 {
    let exact = || {
        let [(a, b), (c, d)] = [meant(x)?, meant(y)?];
        let below = b.max(d); // Powers of ten: the larger is a multiple of the other.
        let above = a.checked_mul(below / b)?.checked_add(c.checked_mul(below / d)?)?;
        Some(nearest(above, below))
    };
    exact().unwrap_or(x + y)
}

/// Midway between two numbers as they are meant: of 0.1 and 0.2 it is 0.15.
pub(crate) fn midpoint(x: f64, y: f64) -> f64 {
    product(0.5, sum(x, y))
}

/// Decimal text as a fraction: numerator and denominator, a power of ten; None if it has more digits
/// or is no number.
pub(crate) fn parse(text: &str) -> Option<(i128, i128)> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(exponent.parse::<i32>().ok()?)),
        None => (text, None),
    };
    let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let decimals = decimals.trim_end_matches('0');
    let digits = format!("{whole}{decimals}");
    let is_short = digits.trim_start_matches(['+', '-', '0']).len() <= MOST_DIGITS;
    if !is_short && (exponent.is_some() || decimals.len() > MOST_DECIMALS) {
        return None;
    }
    let scale = i32::try_from(decimals.len()).ok()?.checked_sub(exponent.unwrap_or(0))?;
    let power = (scale.unsigned_abs() <= MOST_PLACES).then(|| 10_i128.pow(scale.unsigned_abs()))?;
    let number: i128 = digits.parse().ok()?;
    Some(if scale < 0 { (number * power, 1) } else { (number, power) })
}

/// A number as it is typed, exactly: `number / below · 10^power`; `below` is 1 of decimals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exact {
    /// Whole number above.
    pub number: i128,
    /// Power of ten that it is multiplied by.
    pub power: i32,
    /// Whole number below, > 0.
    pub below: i128,
}

/// Digits of a typed number that are read: more than doubles hold.
const MOST_READ: usize = 21;

impl Exact {
    /// One.
    pub const ONE: Self = Self { number: 1, power: 0, below: 1 };

    /// Of digits with or without a point; None of no digits, or of too large an exponent.
    pub(crate) fn new(digits: &str, exponent: &str) -> Option<Self> {
        let (whole, decimals) = digits.split_once('.').unwrap_or((digits, ""));
        let mut power: i32 = if exponent.is_empty() { 0 } else { exponent.parse().ok()? };
        let all = format!("{whole}{decimals}");
        let significant = all.trim_start_matches('0');
        let read = &significant[..significant.len().min(MOST_READ)];
        power = power.checked_sub(i32::try_from(decimals.len()).ok()?)?;
        power = power.checked_add(i32::try_from(significant.len() - read.len()).ok()?)?;
        let number = if read.is_empty() && !all.is_empty() { 0 } else { read.parse().ok()? };
        Some(Self { number, power, below: 1 })
    }

    /// The number of the other sign.
    pub(crate) fn negative(self) -> Self {
        Self { number: -self.number, ..self }
    }

    /// A product; None where it overflows.
    pub(crate) fn times(self, other: Self) -> Option<Self> {
        Some(Self {
            number: self.number.checked_mul(other.number)?,
            power: self.power.checked_add(other.power)?,
            below: self.below.checked_mul(other.below)?,
        })
    }

    /// One over it; None of zero, or below it.
    pub(crate) fn inverse(self) -> Option<Self> {
        let inverse =
            Self { number: self.below, power: self.power.checked_neg()?, below: self.number };
        (self.number > 0).then_some(inverse)
    }

    /// A sum; None where it overflows.
    pub(crate) fn plus(self, other: Self) -> Option<Self> {
        let power = self.power.min(other.power);
        let whole = |of: Self, below: i128| {
            let shift = 10_i128.checked_pow((of.power - power).unsigned_abs())?;
            of.number.checked_mul(shift)?.checked_mul(below)
        };
        let number = whole(self, other.below)?.checked_add(whole(other, self.below)?)?;
        Some(Self { number, power, below: self.below.checked_mul(other.below)? })
    }

    /// The nearest double; infinite beyond the largest.
    #[must_use]
    pub fn value(self) -> f64 {
        let decimal =
            |number: i128, power: i32| format!("{number}e{power}").parse().unwrap_or(f64::NAN);
        if self.below == 1 {
            return decimal(self.number, self.power);
        }
        // As many digits of the quotient as there is room for, and one for the rest.
        let (mut number, mut power) = (self.number, self.power);
        while number != 0
            && let Some(more) = number.checked_mul(10)
        {
            (number, power) = (more, power - 1);
        }
        let rest = i128::from(number % self.below != 0) * number.signum();
        let quotient = number / self.below;
        quotient.checked_mul(10).map_or_else(
            || decimal(quotient, power),
            |quotient| decimal(quotient + rest, power - 1),
        )
    }
}

/// Distance to the next double away from zero.
pub(crate) fn ulp(x: f64) -> f64 {
    let x = x.abs();
    f64::from_bits(x.to_bits() + 1) - x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_exact_and_sums_of_them_too() {
        let is = |x: f64, numerator, denominator| {
            let (above, below) = meant(x).unwrap();
            assert_eq!(above * denominator, numerator * below, "{x}");
        };
        is(0.31, 31, 100);
        is(-1e14, -100_000_000_000_000, 1);
        is(3.0 * 0.1, 3, 10);
        is(0.1 + 0.2, 3, 10);
        is(-0.0, 0, 1);
        is(123_456.789_012, 123_456_789_012, 1_000_000);
        let beyond = (0..5).fold(0.3_f64, |x, _| x.next_up());
        for none in [1.0 / 3.0, 2.0_f64.sqrt(), 70.243_902_439_024_4, beyond, 1e30, 1e-30] {
            assert_eq!(meant(none), None, "{none}");
        }
    }

    #[test]
    fn products_and_sums_are_those_of_the_decimals() {
        let typed =
            |number: u32, power: i32| -> f64 { format!("{number}e{power}").parse().unwrap() };
        for hundredths in 1..2000 {
            let x = typed(hundredths, -2);
            for count in 0..=10 {
                let [whole, part] = [typed(count, 0), typed(count, -3)];
                assert_eq!(product(whole, x), typed(hundredths * count, -2), "{count} · {x}");
                assert_eq!(product(-x, part), -typed(hundredths * count, -5), "{x} · {part}");
                assert_eq!(sum(x, -part), typed(10 * hundredths - count, -3), "{x} - {part}");
            }
        }
        assert_eq!(midpoint(0.1, 0.2), 0.15);
        let (third, large) = (1.0 / 3.0, 1e25);
        assert_eq!((product(3.0, third), sum(third, 0.1)), (3.0 * third, third + 0.1));
        assert_eq!((product(large, large), sum(large, 1e-12)), (large * large, large));
        assert!(product(2.0, f64::INFINITY).is_infinite() && sum(f64::NAN, 1.0).is_nan());
    }

    #[test]
    fn numbers_of_few_places_mean_the_same_without_text() {
        let mut tried = 0;
        for digits in 0..12 {
            for lead in 1..200_u64 {
                let number = (lead * 6_700_417 + 1) % 10_u64.pow(digits + 1);
                for places in 0..12 {
                    let mut x: f64 = format!("-{number}e-{places}").parse().unwrap();
                    x = (0..lead % 7).fold(x, |x, _| x.next_down());
                    for x in [x, -x] {
                        tried += i32::from(short(x).is_some());
                        assert!(short(x).is_none_or(|it| Some(it) == by_text(x)), "{x}");
                    }
                }
            }
        }
        assert!(tried > 10_000, "{tried}");
        assert_eq!(short(-0.0), by_text(-0.0));
        for x in [5e-324, 1e-30, 1.0 / 3.0, 1e12, 1e300, f64::INFINITY, f64::NAN] {
            assert!(short(x).is_none(), "{x}");
        }
    }

    /// A number has one meaning as text and as a double.
    #[test]
    fn text_and_doubles_agree() {
        for text in ["49.54", "0.000001", "359.999999999", "-1e-6", "4.954e1", "999999.999999"] {
            assert_eq!(parse(text), meant(text.parse().unwrap()), "{text}");
        }
        assert_eq!(parse("+049.54000"), parse("49.54"));
        assert_eq!(parse("-236.37001175040001"), Some((-23_637_001_175_040_001, 10_i128.pow(14))));
        let long = ["7.02439024390244e1", "0.300000000000001", "0.30000000000000004"];
        for none in long.into_iter().chain(["", "x", "1e400", "nan", "1.5.2"]) {
            assert_eq!(parse(none), None, "{none}");
        }
    }
}
