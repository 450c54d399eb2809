//! What a typed number stands for.
//!
//! 0.3 is typed, 0.299999999999999989 is what a double of it holds, and 3·0.1 is one unit in its last
//! place off. There is one reading of both, for angles, masses and lengths: a number of up to
//! `MOST_DIGITS` significant digits is exactly that decimal, a double within [`WITHIN_ULP`] units
//! in the last place of one stands for it, and any other double is itself. Text is exact with more
//! digits too, up to `MOST_DECIMALS` behind the point, unless it is written as doubles are, with an
//! exponent.

use crate::numbers::rational::nearest;

/// Every double keeps 15 digits; three of them leave room for the rounding of products and sums.
const MOST_DIGITS: usize = 12;
/// Most digits behind the point of longer text: as many as doubles from 64 to 1000 print.
const MOST_DECIMALS: usize = 14;
/// Most digits before or behind the point.
const MOST_PLACES: u32 = 18;
/// Units in its last place within which a double is right.
pub const WITHIN_ULP: f64 = 4.0;

/// The decimal that a double stands for, if there is one: numerator and denominator.
pub(crate) fn meant(x: f64) -> Option<(i128, i128)> {
    let (numerator, denominator) = parse(&format!("{x:.*e}", MOST_DIGITS - 1))?;
    let off = (nearest(numerator, denominator) - x).abs();
    (off <= WITHIN_ULP * ulp(x)).then_some((numerator, denominator))
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
