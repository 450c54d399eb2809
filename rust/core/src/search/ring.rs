//! Whole combinations of the N-th roots of unity, compared exactly.
//!
//! Two combinations Σ cₖζᵏ are the same number where their polynomials leave the same remainder
//! modulo the cyclotomic polynomial `Φ_N`, the minimal polynomial of ζ.

use crate::cyclotomic::cyclotomic;
use crate::error::Result;

/// Whole combinations of the powers of `ζ = e^{2πi/N}`.
#[derive(Debug, Clone)]
pub(super) struct Ring {
    parts: usize,
    /// `ζᵏ` modulo `Φ_N`, for k = 0 … N − 1.
    powers: Vec<Vec<i64>>,
}

impl Ring {
    pub(super) fn new(parts: u32) -> Result<Self> {
        let minimal: Vec<i64> =
            cyclotomic(parts.into())?.into_iter().map(|coefficient| coefficient as i64).collect();
        let parts = parts as usize;
        let degree = minimal.len() - 1;
        let mut powers: Vec<Vec<i64>> = Vec::with_capacity(parts);
        let mut power = vec![0; degree];
        power[0] = 1;
        if degree == 1 {
            // ζ is 1 or −1.
            let zeta = -minimal[0];
            powers.extend((0..parts).map(|k| vec![if k % 2 == 1 { zeta } else { 1 }]));
            return Ok(Self { parts, powers });
        }
        for _ in 0..parts {
            powers.push(power.clone());
            // Times ζ: shift, and take the leading term off with `Φ_N`, which is monic.
            let leading = power.pop().unwrap_or(0);
            power.insert(0, 0);
            for (term, coefficient) in power.iter_mut().zip(&minimal) {
                *term -= leading * coefficient;
            }
        }
        Ok(Self { parts, powers })
    }

    /// Remainder of Σ cₖζᵏ: equal for equal numbers.
    pub(super) fn remainder(&self, combination: &[i64]) -> Vec<i64> {
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

    /// Whether a combination is zero.
    pub(super) fn vanishes(&self, combination: &[i64], remainder: &mut Vec<i64>) -> bool {
        remainder.clear();
        remainder.resize(self.powers[0].len(), 0);
        self.reduce(combination, remainder);
        remainder.iter().all(|&term| term == 0)
    }

    /// Product of two combinations, the second conjugated, as a combination.
    pub(super) fn times_conjugate(&self, a: &[i64], b: &[i64], product: &mut Vec<i64>) {
        product.clear();
        product.resize(self.parts, 0);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_roots_sum_to_nothing() {
        for parts in 2..=60 {
            let ring = Ring::new(parts).unwrap();
            assert!(ring.remainder(&vec![1; parts as usize]).iter().all(|&c| c == 0), "{parts}");
            let mut one = vec![0; parts as usize];
            one[parts as usize - 1] = 1;
            // ζ^{N−1}·conj(ζ^{N−1}) = 1
            let mut product = Vec::new();
            ring.times_conjugate(&one, &one, &mut product);
            assert_eq!(ring.remainder(&product), ring.powers[0]);
        }
    }
}
