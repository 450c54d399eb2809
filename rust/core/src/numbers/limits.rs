//! Ranges of accepted figures: wide enough for any engine in any unit by mistake, narrow enough that
//! no sum or square of them overflows.

use crate::numbers::error::{Error, Result};

/// Largest magnitude of a length, mass or speed. Its fifth power (m·r²·ω²) and the square of that
/// stay below the largest double.
pub const LARGEST: f64 = 1e30;
/// Smallest crank radius and rod length, and mass or speed above 0: no ratio of two overflows, and
/// no product of five falls below the smallest double of full precision.
pub const SMALLEST: f64 = 1e-30;
/// Most cylinders in an engine.
pub const MOST_CYLINDERS: usize = 1000;
/// Most shafts of an engine, and most unbalances of a shaft.
pub const MOST_UNBALANCES: usize = 1000;
/// Most unbalances of all shafts together: an engine file has room for them.
pub const MOST_UNBALANCES_OF_ALL: usize = 50_000;
/// Longest name and source of an engine, bytes: files and copies go through a text of limited size.
pub const LONGEST_NAME: usize = 10_000;
/// Highest order; above it every coefficient of a slider-crank with λ < 0.99 is below 1e-300.
pub const HIGHEST_ORDER: u32 = 10_000;
/// Maximum length of an axis: a gibibyte of numbers.
pub const LONGEST_AXIS: usize = 1 << 27;
/// Largest result, in bytes, that one call returns; in WebAssembly, whose memory ends at 4 GiB and never
/// shrinks, much less.
pub const LARGEST_RESULT: u128 = if cfg!(target_family = "wasm") { 1 << 28 } else { 1 << 32 };

/// A finite figure of at most [`LARGEST`].
pub fn finite(argument: &str, value: f64) -> Result<f64> {
    if value.is_finite() && value.abs() <= LARGEST {
        return Ok(value);
    }
    Err(Error::figure(
        argument,
        value,
        format!("give a finite number of magnitude {LARGEST:e} at most"),
    ))
}

/// A mass or a speed: zero, or from [`SMALLEST`] to [`LARGEST`].
pub fn not_negative(argument: &str, value: f64) -> Result<f64> {
    if value > 0.0 && value < SMALLEST {
        let hint = format!("give zero, or a number from {SMALLEST:e} to {LARGEST:e}");
        return Err(Error::figure(argument, value, hint));
    }
    distance(argument, value)
}

/// A distance between places: zero or more, however small, since it is added to others.
pub fn distance(argument: &str, value: f64) -> Result<f64> {
    if value >= 0.0 {
        return finite(argument, value);
    }
    Err(Error::figure(argument, value, "give a number that is zero or more"))
}

/// A moment of inertia of either sign: zero, or of the size of a mass times a length squared.
pub fn inertia(argument: &str, value: f64) -> Result<f64> {
    let (least, most) = (SMALLEST.powi(3), LARGEST.powi(3));
    if value == 0.0 || (least..=most).contains(&value.abs()) {
        return Ok(value);
    }
    let hint = format!("give zero, or a number of magnitude {least:.0e} to {most:.0e}");
    Err(Error::figure(argument, value, hint))
}

/// A length that is more than zero.
pub fn length(argument: &str, value: f64) -> Result<f64> {
    if (SMALLEST..=LARGEST).contains(&value) {
        return Ok(value);
    }
    let hint = format!("give metres, between {SMALLEST:e} and {LARGEST:e}");
    Err(Error::figure(argument, value, hint))
}

/// A relative tolerance that can be reached.
pub fn tolerance(rtol: f64) -> Result<f64> {
    if (1e-15..1.0).contains(&rtol) {
        return Ok(rtol);
    }
    Err(Error::figure("rtol", rtol, "give a number from 1e-15 to below 1"))
}

/// A text of at most [`LONGEST_NAME`].
pub fn name(argument: &str, text: &str) -> Result<()> {
    if text.len() <= LONGEST_NAME {
        return Ok(());
    }
    Err(Error::value(argument, text, format!("give at most {LONGEST_NAME} bytes")))
}

/// A list of as many entries as another, one for each `item`.
pub fn same_length(
    argument: &str,
    found: usize,
    reference: &str,
    expected: usize,
    item: &'static str,
) -> Result<()> {
    if found == expected {
        return Ok(());
    }
    let (argument, reference) = (argument.to_owned(), reference.to_owned());
    Err(Error::Length { argument, found, reference, expected, item })
}

/// Two or more frequencies, Hz, in ascending order.
pub fn ascending(argument: &str, frequencies: &[f64]) -> Result<()> {
    if frequencies.len() < 2 {
        let hint = "give two or more frequencies; values between them are interpolated";
        return Err(Error::value(argument, format!("{} frequency", frequencies.len()), hint));
    }
    for (k, &frequency) in frequencies.iter().enumerate() {
        distance(&format!("{argument}[{k}]"), frequency)?;
    }
    if let Some(k) = frequencies.windows(2).position(|pair| pair[0] >= pair[1]) {
        let hint = "give frequencies in ascending order, each once";
        return Err(Error::figure(format!("{argument}[{}]", k + 1), frequencies[k + 1], hint));
    }
    Ok(())
}

/// Indices of the ascending values on both sides of another one, and its share of the way from the first
/// to the second; none outside.
#[must_use]
pub fn between(values: &[f64], value: f64) -> Option<(usize, usize, f64)> {
    let above = values.partition_point(|&point| point < value);
    let high = *values.get(above)?;
    if high == value {
        return Some((above, above, 0.0));
    }
    let below = above.checked_sub(1)?;
    Some((below, above, (value - values[below]) / (high - values[below])))
}

/// A result of this many elements of `size` bytes fits.
pub fn result_size(
    argument: &str,
    lengths: &[usize],
    size: usize,
    hint: &'static str,
) -> Result<()> {
    let bytes =
        lengths.iter().fold(size as u128, |bytes, &length| bytes.saturating_mul(length as u128));
    if bytes <= LARGEST_RESULT {
        return Ok(());
    }
    Err(Error::TooLarge { argument: argument.to_owned(), bytes, limit: LARGEST_RESULT, hint })
}

/// An axis of at most [`LONGEST_AXIS`] values.
pub fn axis_length(argument: &'static str, length: usize) -> Result<()> {
    if length <= LONGEST_AXIS {
        return Ok(());
    }
    let hint = format!("give at most {LONGEST_AXIS}; sweep it in parts");
    Err(Error::value(argument, format!("{length} values"), hint))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_within() {
        for value in [0.0, -LARGEST, LARGEST] {
            assert_eq!(finite("", value), Ok(value));
        }
        for value in [f64::NAN, f64::INFINITY, LARGEST.next_up(), -LARGEST.next_up()] {
            assert!(finite("", value).is_err() && not_negative("", value).is_err());
            assert!(length("", value).is_err());
        }
        for value in [0.0, SMALLEST, 1.0, LARGEST] {
            assert_eq!(not_negative("", value), Ok(value));
            assert_eq!(length("", value).is_ok(), value > 0.0);
        }
        for value in [SMALLEST.next_down(), -SMALLEST, -1.0] {
            assert!(not_negative("", value).is_err() && length("", value).is_err());
        }
        let (least, most) = (SMALLEST.powi(3), LARGEST.powi(3));
        for value in [0.0, least, -least, -2.5, most, -most] {
            assert_eq!(inertia("", value), Ok(value));
        }
        for value in [least.next_down(), -most.next_up(), f64::NAN] {
            assert!(inertia("", value).is_err());
        }
    }

    #[test]
    fn results_have_a_largest_size() {
        let most = (LARGEST_RESULT / 16) as usize;
        assert!(result_size("", &[most / 2, 2], 16, "").is_ok());
        assert!(result_size("", &[most + 1], 16, "").is_err());
        assert!(result_size("", &[usize::MAX; 9], 16, "").is_err());
    }
}
