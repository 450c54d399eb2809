//! Numbers as texts show them: rounded to significant digits or decimals.

/// A number of significant digits, without zeros at the end: of 3 digits `12.5`, `0.00123`, `1.2e+06`.
///
/// As C's `%g` writes it, and so Python's `g`.
///
/// ```
/// use crankpin_core::numbers::figure::significant;
///
/// let written = [13.0, 999.6, 12_345.0, 2e-5].map(|x| significant(x, 3));
/// assert_eq!(written, ["13", "1e+03", "1.23e+04", "2e-05"]);
/// ```
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    let digits = digits.max(1);
    let scientific = format!("{value:.*e}", digits - 1);
    let Some((mantissa, exponent)) = scientific.split_once('e') else {
        return scientific.to_lowercase(); // no finite number
    };
    let exponent: i32 = exponent.parse().unwrap_or_default();
    match usize::try_from(digits as i32 - 1 - exponent) {
        Ok(decimals) if exponent >= -4 => trimmed(&format!("{value:.decimals$}")).to_owned(),
        _ => {
            let sign = if exponent < 0 { '-' } else { '+' };
            format!("{}e{sign}{:02}", trimmed(mantissa), exponent.abs())
        }
    }
}

/// A number rounded to decimals, of two equally near ones to the even one.
#[must_use]
pub fn rounded(value: f64, decimals: usize) -> f64 {
    format!("{value:.decimals$}").parse().unwrap_or(value)
}

/// Decimals without zeros at the end.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Texts of Python's `f"{x:.{digits}g}"`.
    #[test]
    fn figures_are_those_of_g() {
        for (value, digits, text) in [
            (0.0, 3, "0"),
            (-0.0, 3, "-0"),
            (0.000_123_45, 3, "0.000123"),
            (0.000_012_345, 3, "1.23e-05"),
            (999.4, 3, "999"),
            (999.5, 3, "1e+03"), // to even
            (998.5, 3, "998"),
            (-12.0, 6, "-12"),
            (1e21, 6, "1e+21"),
            (1.5e-300, 10, "1.5e-300"),
            (100.0, 1, "1e+02"),
            (123_456_789.0, 10, "123456789"),
            (f64::INFINITY, 3, "inf"),
            (f64::NAN, 3, "nan"),
        ] {
            assert_eq!(significant(value, digits), text, "{value} {digits}");
        }
    }

    #[test]
    fn halves_round_to_even() {
        assert_eq!([0.25, 0.35, 89.95, 2.5].map(|x| rounded(x, 1)), [0.2, 0.3, 90.0, 2.5]);
        assert_eq!(rounded(f64::INFINITY, 6), f64::INFINITY);
    }
}
