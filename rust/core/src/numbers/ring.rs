//! Sums of roots of unity, exact: Σ wₖ ζᵏ with whole w and ζ = e^{2πi/N}.
//!
//! Such a sum is the value at ζ of a polynomial P with integer coefficients, and is zero if and
//! only if the cyclotomic polynomial `Φ_N`, the smallest of which ζ is a root, divides P. Nothing
//! here is a floating-point number.
//!
//! A [`RootSum`] lists its terms, for few terms of any N up to 10¹¹. A `Ring` holds
//! the powers of ζ modulo `Φ_N` and compares many sums of one small N, given by all their N weights.

mod sum;

pub use sum::RootSum;

use crate::numbers::error::{Error, Result};

/// Largest N for which a sum is tested for zero: its primes are found by trial, in
/// half a millisecond at worst.
pub const LARGEST_PERIOD: i128 = 100_000_000_000;
/// Largest N for which `Φ_N` is written out.
pub const LARGEST_REDUCED: i128 = 40_000;

fn overflow() -> Error {
    let hint = "exact sums need weights whose integer multiples stay below 2^127";
    Error::value("weights", "too many digits", hint)
}

fn checked<T>(value: Option<T>) -> Result<T> {
    value.ok_or_else(overflow)
}

/// Sums Σ cₖζᵏ of one N, each given by its weights c₀ … c_{N−1}.
#[derive(Debug, Clone)]
pub(crate) struct Ring {
    period: usize,
    /// `ζᵏ` modulo `Φ_N`, for k = 0 … N − 1.
    powers: Vec<Vec<i64>>,
}

impl Ring {
    pub(crate) fn new(period: u32) -> Result<Self> {
        let minimal: Vec<i64> =
            cyclotomic(period.into())?.into_iter().map(|coefficient| coefficient as i64).collect();
        let period = period as usize;
        let degree = minimal.len() - 1;
        let mut powers: Vec<Vec<i64>> = Vec::with_capacity(period);
        let mut power = vec![0; degree];
        power[0] = 1;
        if degree == 1 {
            // ζ is 1 or −1.
            let zeta = -minimal[0];
            powers.extend((0..period).map(|k| vec![if k % 2 == 1 { zeta } else { 1 }]));
            return Ok(Self { period, powers });
        }
        for _ in 0..period {
            powers.push(power.clone());
            // Times ζ: shift, and take the leading term off with `Φ_N`, which is monic.
            let leading = power.pop().unwrap_or(0);
            power.insert(0, 0);
            for (term, coefficient) in power.iter_mut().zip(&minimal) {
                *term -= leading * coefficient;
            }
        }
        Ok(Self { period, powers })
    }

    /// Coefficients of 1, ζ, ζ² … below the degree of `Φ_N`: equal for equal sums.
    pub(crate) fn remainder(&self, combination: &[i64]) -> Vec<i64> {
        let mut remainder = vec![0; self.powers[0].len()];
        self.reduce(combination, &mut remainder);
        remainder
    }

    fn reduce(&self, combination: &[i64], remainder: &mut [i64]) {
        for (&coefficient, power) in combination.iter().zip(&self.powers) {
            if coefficient != 0 {
                for (term, &unit) in remainder.iter_mut().zip(power) {
                    *term += coefficient * unit;
                }
            }
        }
    }

    /// Whether a sum is zero; `remainder` is a buffer.
    pub(crate) fn vanishes(&self, combination: &[i64], remainder: &mut Vec<i64>) -> bool {
        remainder.clear();
        remainder.resize(self.powers[0].len(), 0);
        self.reduce(combination, remainder);
        remainder.iter().all(|&term| term == 0)
    }

    /// Product of a sum and the conjugate of another.
    pub(crate) fn times_conjugate(&self, a: &[i64], b: &[i64], product: &mut Vec<i64>) {
        product.clear();
        product.resize(self.period, 0);
        for (j, &y) in b.iter().enumerate().filter(|(_, y)| **y != 0) {
            // ζⁱ⁻ʲ: rotated left by j.
            let (before, after) = a.split_at(j);
            let (start, end) = product.split_at_mut(after.len());
            for (term, x) in start.iter_mut().zip(after) {
                *term += x * y;
            }
            for (term, x) in end.iter_mut().zip(before) {
                *term += x * y;
            }
        }
    }
}

/// The primes that divide n, rising.
fn primes(mut n: u64) -> Vec<u64> {
    let mut found = Vec::new();
    let mut p = 2;
    while p * p <= n {
        if n.is_multiple_of(p) {
            found.push(p);
            while n.is_multiple_of(p) {
                n /= p;
            }
        }
        p += if p == 2 { 1 } else { 2 };
    }
    if n > 1 {
        found.push(n);
    }
    found
}

/// A period for which coefficients are written out.
fn checked_period(n: i128) -> Result<usize> {
    if (1..=LARGEST_REDUCED).contains(&n) {
        return Ok(n as usize);
    }
    let hint = format!("angles must be parts of a turn of common denominator {LARGEST_REDUCED}");
    Err(Error::value("common denominator of the angles", n, hint + " at most"))
}

/// Coefficients of `Φ_n` from the constant up.
pub fn cyclotomic(n: i128) -> Result<Vec<i128>> {
    checked_period(n)?;
    if n == 1 {
        return Ok(vec![-1, 1]);
    }
    let primes: Vec<i128> = primes(n as u64).into_iter().map(i128::from).collect();
    let radical: i128 = primes.iter().product();
    let degree = primes.iter().map(|p| p - 1).product::<i128>() as usize;
    // Φ = Π (1 − x^{r/d})^{μ(d)} over the divisors d of r, the product of the primes, as a power
    // series cut off behind its degree. With all factors of the numerator in first, what is there
    // is always Φ times some of those of the denominator: coefficients stay small.
    let mut series = vec![0_i128; degree + 1];
    series[0] = 1;
    for denominator in [false, true] {
        for subset in 0..1_usize << primes.len() {
            if (subset.count_ones() % 2 == 1) != denominator {
                continue;
            }
            let divisor: i128 =
                (0..primes.len()).filter(|k| subset >> k & 1 == 1).map(|k| primes[k]).product();
            let step = (radical / divisor) as usize;
            if denominator {
                for k in step..=degree {
                    series[k] = checked(series[k].checked_add(series[k - step]))?;
                }
            } else {
                for k in (step..=degree).rev() {
                    series[k] = checked(series[k].checked_sub(series[k - step]))?;
                }
            }
        }
    }
    // Φ_n(x) = Φ_r(x^{n/r}).
    let stride = (n / radical) as usize;
    let mut spread = vec![0; degree * stride + 1];
    for (k, &coefficient) in series.iter().enumerate() {
        spread[k * stride] = coefficient;
    }
    Ok(spread)
}

#[cfg(test)]
mod tests;
