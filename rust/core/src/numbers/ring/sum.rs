//! Sums of few roots of unity of any period.

use super::{LARGEST_PERIOD, checked, checked_period, cyclotomic, primes};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::rational::{common_divisor, common_multiple};

/// Weight × root of unity, summed: exponents rise from 0 to below the period, no weight is 0.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RootSum {
    period: i128,
    pub(super) terms: Vec<(i128, i128)>,
}

/// Like exponents added up.
fn collected(mut terms: Vec<(i128, i128)>) -> Result<Vec<(i128, i128)>> {
    terms.sort_unstable_by_key(|&(exponent, _)| exponent);
    let mut sum: Vec<(i128, i128)> = Vec::with_capacity(terms.len());
    for (exponent, weight) in terms {
        match sum.last_mut() {
            Some((last, total)) if *last == exponent => {
                *total = checked(total.checked_add(weight))?;
            }
            _ => sum.push((exponent, weight)),
        }
    }
    sum.retain(|&(_, weight)| weight != 0);
    Ok(sum)
}

impl RootSum {
    /// Σ weight·e^{2πi·numerator/denominator} of (numerator, denominator, weight); the period is
    /// the least common denominator, or the multiple of it that `period` asks for.
    pub fn new(terms: &[(i128, i128, i128)], period: i128) -> Result<Self> {
        let period = terms.iter().try_fold(period.max(1), |period, &(_, denominator, _)| {
            common_multiple(period, denominator).filter(|&n| n <= LARGEST_PERIOD).ok_or_else(|| {
                let value = format!("with denominators {period} and {denominator}");
                let hint = format!("give parts of a turn of common denominator {LARGEST_PERIOD}");
                Error::value("angles", value, hint + " at most")
            })
        })?;
        let exponents = terms.iter().map(|&(numerator, denominator, weight)| {
            let multiple = numerator.rem_euclid(denominator) * (period / denominator);
            (multiple, weight)
        });
        Ok(Self { period, terms: collected(exponents.collect())? })
    }

    /// N.
    #[must_use]
    pub fn period(&self) -> i128 {
        self.period
    }

    /// Whether the sum is zero, proved in integers.
    ///
    /// Since xᴺ − 1 is the product of `Φ_d` over the divisors d of N, and Q = Π (1 − x^{N/p}) over
    /// the primes p of N is zero at every N-th root of unity but the primitive ones, `Φ_N` divides P
    /// if and only if xᴺ − 1 divides P·Q: exponents are taken modulo N, and everything must cancel.
    pub fn vanishes(&self) -> Result<bool> {
        let Some(&(first, _)) = self.terms.first() else {
            return Ok(true);
        };
        // Turned back by its first root, a sum has often fewer roots to be made of.
        let mut product: Vec<(i128, i128)> =
            self.terms.iter().map(|&(e, weight)| (e - first, weight)).collect();
        let step = product.iter().fold(self.period, |step, &(e, _)| common_divisor(step, e));
        let period = self.period / step;
        for (exponent, _) in &mut product {
            *exponent /= step;
        }
        for prime in primes(period.unsigned_abs() as u64) {
            let shift = period / i128::from(prime);
            let shifted: Vec<(i128, i128)> =
                product.iter().map(|&(e, weight)| ((e + shift) % period, -weight)).collect();
            product.extend(shifted);
            product = collected(product)?;
        }
        Ok(product.is_empty())
    }

    /// The real part as c₀ + Σ cₖ·2cos(2πk/N), doubled, in the one way that takes k below half the
    /// degree of `Φ_N` (of N ≥ 3; a rational number, k = 0, for N = 1 and 2).
    pub fn twice_real(&self, cancel: &Cancel) -> Result<Vec<i128>> {
        let modulus = cyclotomic(self.period)?;
        let period = self.period as usize;
        // A root and its conjugate, each with this coefficient; k and N − k have the same cosine.
        let mut cosines = vec![0_i128; period / 2 + 1];
        for &(exponent, weight) in &self.terms {
            let k = exponent as usize;
            let k = k.min(period - k);
            // 2·Re ζᵏ is 2cos(2πk/N), which for k = 0 is 2·1.
            let weight = if k == 0 { checked(weight.checked_mul(2))? } else { weight };
            cosines[k] = checked(cosines[k].checked_add(weight))?;
        }
        if period <= 2 {
            let odd = cosines.get(1).map_or(Some(0), |odd| odd.checked_mul(2));
            return Ok(vec![checked(odd.and_then(|odd| cosines[0].checked_sub(odd)))?]);
        }
        // Φ_N reads the same backwards: ζ^{−φ/2}Φ_N(ζ) = b₀ + Σ bⱼ·2cos(2πj/N) = 0, b_{φ/2} = 1.
        // Multiplied by 2cos(2πs/N) it cancels the highest cosine.
        let half = modulus.len() / 2;
        let nonzero: Vec<(i64, i128)> =
            (-(half as i64)..).zip(modulus).filter(|&(_, coefficient)| coefficient != 0).collect();
        for top in (half..cosines.len()).rev() {
            cancel.check()?;
            let factor = std::mem::take(&mut cosines[top]);
            if factor == 0 {
                continue;
            }
            let shift = (top - half) as i64;
            // ζ^{j ± s}, without their conjugates below 0; for s = 0 the two are one. `top` itself is
            // not read again.
            let from = |least: i64| &nonzero[nonzero.partition_point(|&(j, _)| j < least)..];
            let ahead = from(-shift).iter().map(|&(j, b)| (j + shift, b));
            let behind = from(shift).iter().map(|&(j, b)| (j - shift, b));
            for (k, coefficient) in ahead.chain(behind.filter(|_| shift > 0)) {
                let product = checked(coefficient.checked_mul(factor))?;
                let value = &mut cosines[k as usize];
                *value = checked(value.checked_sub(product))?;
            }
        }
        cosines.truncate(half);
        Ok(cosines)
    }

    /// The same sum turned by numerator/denominator of a turn, which must be a multiple of 1/N.
    #[must_use]
    pub fn turned(&self, numerator: i128, denominator: i128) -> Self {
        let shift = numerator * self.period / denominator;
        self.moved(|exponent| exponent + shift)
    }

    /// This sum plus a multiple of another of the same period.
    pub fn plus(&self, other: &Self, factor: i128) -> Result<Self> {
        debug_assert_eq!(self.period, other.period);
        let mut terms = self.terms.clone();
        for &(exponent, weight) in &other.terms {
            terms.push((exponent, checked(weight.checked_mul(factor))?));
        }
        Ok(Self { period: self.period, terms: collected(terms)? })
    }

    /// The conjugate.
    #[must_use]
    pub fn conjugate(&self) -> Self {
        self.moved(|exponent| -exponent)
    }

    /// Each root to another one.
    fn moved(&self, to: impl Fn(i128) -> i128) -> Self {
        let moved = self.terms.iter().map(|&(e, w)| (to(e).rem_euclid(self.period), w));
        let mut terms: Vec<(i128, i128)> = moved.collect();
        terms.sort_unstable_by_key(|&(exponent, _)| exponent);
        Self { period: self.period, terms }
    }

    /// |sum|², a sum of roots too.
    pub fn squared_size(&self) -> Result<Self> {
        let mut weights = vec![0_i128; checked_period(self.period)?];
        for &(e, w) in &self.terms {
            for &(f, v) in &self.terms {
                let weight = &mut weights[(e - f).rem_euclid(self.period) as usize];
                let product = checked(w.checked_mul(v))?;
                *weight = checked(weight.checked_add(product))?;
            }
        }
        let terms = (0..).zip(weights).filter(|&(_, weight)| weight != 0);
        Ok(Self { period: self.period, terms: terms.collect() })
    }
}
