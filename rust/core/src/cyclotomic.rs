//! Sums of roots of unity, exact: Σ wₖ ζᵏ with whole w and ζ = e^{2πi/N}.
//!
//! Such a sum is the value at ζ of a polynomial P with integer coefficients, and is zero if and
//! only if the cyclotomic polynomial `Φ_N`, the smallest of which ζ is a root, divides P. Nothing
//! here is a floating-point number.
//!
//! Division by `Φ_N` gives the one form that each value has ([`RootSum::reduced`]). For the question
//! whether it is zero there is a shorter way that serves N up to a thousand million: since xᴺ − 1 is
//! the product of `Φ_d` over the divisors d of N, and Q = Π (1 − x^{N/p}) over the primes p of N is
//! zero at every N-th root of unity but the primitive ones, `Φ_N` divides P if and only if xᴺ − 1
//! divides P·Q: exponents are taken modulo N, and everything must cancel.

use crate::error::{Error, Result};
use crate::rational::{common_divisor, common_multiple};

/// Largest N for which a sum is tested for zero: its primes are found by trial.
pub const LARGEST_PERIOD: i128 = 1_000_000_000;
/// Largest N for which `Φ_N` is written out.
pub const LARGEST_REDUCED: i128 = 40_000;

/// Weight × root of unity, summed: exponents rise from 0 to below the period, no weight is 0.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RootSum {
    period: i128,
    terms: Vec<(i128, i128)>,
}

fn overflow() -> Error {
    let cure = "exact sums need weights whose integer multiples stay below 2^127";
    Error::value("weights", "too many digits", cure)
}

fn checked<T>(value: Option<T>) -> Result<T> {
    value.ok_or_else(overflow)
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
                let cure = format!("give parts of a turn of common denominator {LARGEST_PERIOD}");
                Error::value("angles", value, cure + " at most")
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
        for prime in primes(period) {
            let shift = period / prime;
            let shifted: Vec<(i128, i128)> =
                product.iter().map(|&(e, weight)| ((e + shift) % period, -weight)).collect();
            product.extend(shifted);
            product = collected(product)?;
        }
        Ok(product.is_empty())
    }

    /// Coefficients of 1, ζ, ζ² … below the degree of `Φ_N`: two sums of one period are equal if
    /// and only if these are.
    pub fn reduced(&self) -> Result<Vec<i128>> {
        let modulus = cyclotomic(self.period)?;
        let degree = modulus.len() - 1;
        let mut rest = vec![0; self.period as usize];
        for &(exponent, weight) in &self.terms {
            rest[exponent as usize] = weight;
        }
        // Φ_N has few coefficients other than 0 where N has square factors.
        let below: Vec<(usize, i128)> =
            (0..degree).zip(modulus).filter(|&(_, coefficient)| coefficient != 0).collect();
        for top in (degree..rest.len()).rev() {
            let factor = std::mem::take(&mut rest[top]);
            if factor == 0 {
                continue;
            }
            for &(k, coefficient) in &below {
                let product = checked(coefficient.checked_mul(factor))?;
                let value = &mut rest[top - degree + k];
                *value = checked(value.checked_sub(product))?;
            }
        }
        rest.truncate(degree);
        Ok(rest)
    }

    /// The real part as c₀ + Σ cₖ·2cos(2πk/N), doubled, in the one way that takes k below half the
    /// degree of `Φ_N` (of N ≥ 3; a rational number, k = 0, for N = 1 and 2).
    pub fn twice_real(&self) -> Result<Vec<i128>> {
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
        // Times 2cos(2πs/N) it takes away the highest cosine.
        let half = modulus.len() / 2;
        let nonzero: Vec<(i64, i128)> =
            (-(half as i64)..).zip(modulus).filter(|&(_, coefficient)| coefficient != 0).collect();
        for top in (half..cosines.len()).rev() {
            let factor = std::mem::take(&mut cosines[top]);
            if factor == 0 {
                continue;
            }
            let shift = (top - half) as i64;
            for &(place, coefficient) in &nonzero {
                let product = checked(coefficient.checked_mul(factor))?;
                // ζ^{j ± s}; for s = 0 the two are one.
                let (ahead, behind) = (place + shift, place - shift);
                for k in if shift == 0 { vec![place] } else { vec![ahead, behind] } {
                    // At `top` itself, nothing is looked at any more.
                    if let Ok(k) = usize::try_from(k) {
                        cosines[k] = checked(cosines[k].checked_sub(product))?;
                    }
                }
            }
        }
        cosines.truncate(half);
        Ok(cosines)
    }

    /// The same sum turned by numerator/denominator of a turn, which must be a multiple of 1/N.
    #[must_use]
    pub fn turned(&self, numerator: i128, denominator: i128) -> Self {
        let shift = numerator * self.period / denominator;
        let mut terms: Vec<(i128, i128)> =
            self.terms.iter().map(|&(e, w)| ((e + shift).rem_euclid(self.period), w)).collect();
        terms.sort_unstable_by_key(|&(exponent, _)| exponent);
        Self { period: self.period, terms }
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
        let mut terms: Vec<(i128, i128)> =
            self.terms.iter().map(|&(e, w)| ((-e).rem_euclid(self.period), w)).collect();
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

/// The primes that divide n, rising.
fn primes(mut n: i128) -> Vec<i128> {
    let mut found = Vec::new();
    let mut p = 2;
    while p * p <= n {
        if n % p == 0 {
            found.push(p);
            while n % p == 0 {
                n /= p;
            }
        }
        p += 1;
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
    let cure = format!("angles must be parts of a turn of common denominator {LARGEST_REDUCED}");
    Err(Error::value("common denominator of the angles", n, cure + " at most"))
}

/// Coefficients of `Φ_n` from the constant up.
pub fn cyclotomic(n: i128) -> Result<Vec<i128>> {
    checked_period(n)?;
    if n == 1 {
        return Ok(vec![-1, 1]);
    }
    let primes = primes(n);
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
mod tests {
    use super::*;
    use crate::Complex64;
    use std::f64::consts::TAU;

    /// A generator of the same numbers each time.
    fn numbers(mut state: u64) -> impl FnMut(u64) -> i128 {
        move |below| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            i128::from((state >> 33) % below)
        }
    }

    fn sum(period: i128, terms: &[(i128, i128)]) -> RootSum {
        let listed: Vec<_> = terms.iter().map(|&(e, w)| (e, period, w)).collect();
        RootSum::new(&listed, 1).unwrap()
    }

    #[test]
    fn known_polynomials() {
        assert_eq!(cyclotomic(1).unwrap(), [-1, 1]);
        assert_eq!(cyclotomic(2).unwrap(), [1, 1]);
        assert_eq!(cyclotomic(7).unwrap(), [1; 7]);
        assert_eq!(cyclotomic(12).unwrap(), [1, 0, -1, 0, 1]);
        assert_eq!(cyclotomic(24).unwrap(), [1, 0, 0, 0, -1, 0, 0, 0, 1]);
        // The first with a coefficient other than 0 and ±1, and the first with 3.
        assert_eq!(cyclotomic(105).unwrap()[7], -2);
        assert_eq!(cyclotomic(385).unwrap().iter().map(|c| c.abs()).max(), Some(3));
        assert!(cyclotomic(0).is_err());
        assert!(cyclotomic(LARGEST_REDUCED + 1).is_err());
    }

    #[test]
    fn their_products_over_divisors_are_x_to_the_n_less_one() {
        for n in 1..=120_i128 {
            let mut product = vec![1_i128];
            for d in (1..=n).filter(|d| n % d == 0) {
                let factor = cyclotomic(d).unwrap();
                let mut next = vec![0; product.len() + factor.len() - 1];
                for (i, a) in product.iter().enumerate() {
                    for (j, b) in factor.iter().enumerate() {
                        next[i + j] += a * b;
                    }
                }
                product = next;
            }
            let mut expected = vec![0; n as usize + 1];
            (expected[0], expected[n as usize]) = (-1, 1);
            assert_eq!(product, expected);
        }
    }

    #[test]
    fn all_roots_of_one_period_cancel_and_fewer_do_not() {
        for n in 2..=1000 {
            let all: Vec<_> = (0..n).map(|k| (k, 1)).collect();
            assert!(sum(n, &all).vanishes().unwrap(), "{n}");
            assert!(!sum(n, &all[1..]).vanishes().unwrap(), "{n}");
            assert!(sum(n, &all).reduced().unwrap().iter().all(|&c| c == 0), "{n}");
            assert_eq!(cyclotomic(n).unwrap().iter().sum::<i128>(), at_one(n), "{n}");
        }
    }

    /// `Φ_n(1)`: p for a power of the prime p, else 1.
    fn at_one(n: i128) -> i128 {
        match primes(n)[..] {
            [prime] => prime,
            _ => 1,
        }
    }

    #[test]
    fn both_ways_to_zero_agree_and_with_floating_point() {
        let mut random = numbers(7);
        let mut zeros = 0;
        for n in 2..=1000_i128 {
            let mut terms: Vec<(i128, i128)> = Vec::new();
            // Rotated sets of p-th roots cancel; now and then something is left over.
            let primes = primes(n);
            for _ in 0..3 {
                let (p, start, weight) =
                    (primes[random(primes.len() as u64) as usize], random(n as u64), random(9) - 4);
                terms.extend((0..p).map(|k| ((start + k * (n / p)) % n, weight)));
            }
            if random(2) == 1 {
                terms.push((random(n as u64), random(3) - 1));
            }
            let sum = sum(n, &terms);
            let vanishes = sum.vanishes().unwrap();
            assert_eq!(vanishes, sum.reduced().unwrap().iter().all(|&c| c == 0), "{n}");
            let (mut re, mut im) = (0.0, 0.0);
            for &(e, w) in &terms {
                let (sin, cos) = (TAU * e as f64 / n as f64).sin_cos();
                re += w as f64 * cos;
                im += w as f64 * sin;
            }
            // What is left over is ±1; what cancels leaves 1e-16 of 4 · 3000 terms.
            assert_eq!(vanishes, f64::hypot(re, im) < 1e-9, "{n}: {re} {im}");
            zeros += i32::from(vanishes);
        }
        assert!((400..900).contains(&zeros), "{zeros}");
    }

    #[test]
    fn real_parts_are_what_they_were() {
        let mut random = numbers(3);
        for n in 1..=360_i128 {
            let terms: Vec<_> = (0..5).map(|_| (random(n as u64), random(19) - 9)).collect();
            let found = sum_of_period(n, &terms).twice_real().unwrap();
            let degree = cyclotomic(n).unwrap().len() - 1;
            assert_eq!(found.len(), (degree / 2).max(1));
            let cosine = |k: i128| (TAU * k as f64 / n as f64).cos();
            let expected: f64 = terms.iter().map(|&(e, w)| 2.0 * w as f64 * cosine(e)).sum();
            let value: f64 = found
                .iter()
                .enumerate()
                .map(|(k, &c)| c as f64 * if k == 0 { 1.0 } else { 2.0 * cosine(k as i128) })
                .sum();
            assert!((value - expected).abs() < 1e-10, "{n}: {value} {expected}");
        }
    }

    fn sum_of_period(period: i128, terms: &[(i128, i128)]) -> RootSum {
        let listed: Vec<_> = terms.iter().map(|&(e, w)| (e, period, w)).collect();
        RootSum::new(&listed, period).unwrap()
    }

    #[test]
    fn a_real_part_has_one_form() {
        // The five fifth roots add to nothing: ζ = −(1 + ζ² + ζ³ + ζ⁴).
        let one = sum_of_period(5, &[(1, 1)]).twice_real().unwrap();
        let other = sum_of_period(5, &[(0, -1), (2, -1), (3, -1), (4, -1)]).twice_real().unwrap();
        assert_eq!(one, other);
    }

    #[test]
    fn sums_turn_and_are_mirrored_as_the_numbers_they_are() {
        let value = |sum: &RootSum| -> Complex64 {
            let angle = |e: i128| TAU * e as f64 / sum.period() as f64;
            sum.terms.iter().map(|&(e, w)| Complex64::cis(angle(e)) * w as f64).sum()
        };
        let near = |a: Complex64, b: Complex64| assert!((a - b).norm() < 1e-13, "{a} {b}");
        for period in [1, 2, 12, 15] {
            let sum = sum_of_period(period, &[(0, 3), (1, -2), (4, 5), (7, 1)]);
            assert_eq!(sum.period(), period);
            near(value(&sum.conjugate()), value(&sum).conj());
            for k in -2..=2 * period {
                let turn = Complex64::cis(TAU * k as f64 / period as f64);
                near(value(&sum.turned(k, period)), value(&sum) * turn);
                near(value(&sum.turned(2 * k, 2 * period)), value(&sum) * turn);
            }
        }
    }

    #[test]
    fn squares_of_sizes() {
        // |1 + 3i|² = 10.
        let square = sum_of_period(4, &[(0, 1), (1, 3)]).squared_size().unwrap();
        assert_eq!(square.twice_real().unwrap(), [20]);
        assert_eq!(square.turned(1, 4).twice_real().unwrap(), [0]);
    }

    #[test]
    fn what_is_too_large_is_refused() {
        let huge = i128::MAX;
        assert!(RootSum::new(&[(1, 3, huge), (1, 3, huge)], 1).is_err());
        assert!(sum(6, &[(0, huge), (2, huge), (4, huge)]).squared_size().is_err());
        assert!(RootSum::new(&[(1, 999_999_937, 1), (1, 3, 1)], 1).is_err());
        let largest = sum(999_999_937, &[(1, 1), (5, -1)]);
        assert!(!largest.vanishes().unwrap());
        assert!(largest.reduced().is_err());
    }
}
