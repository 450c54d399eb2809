//! Discrete Fourier transforms of any length.

use std::f64::consts::{PI, TAU};

use crate::Complex64;
use crate::numbers::error::Result;
use crate::numbers::memory;

/// Largest prime factor of a length of which the sums are formed one by one; a larger one makes the whole
/// transform a convolution.
const LARGEST_FACTOR: usize = 31;

/// `Σⱼ xⱼ·e^(−2πijk/n)` for each k below n.
pub(crate) struct Transform {
    /// Prime factors of the length, ascending.
    factors: Vec<usize>,
    /// `e^(−2πik/n)`.
    roots: Vec<Complex64>,
    convolution: Option<Box<Convolution>>,
}

/// Bluestein's form of a transform: jk is (j² + k² − (k − j)²)/2, a convolution with a chirp.
struct Convolution {
    /// `e^(−πik²/n)`.
    chirp: Vec<Complex64>,
    /// Transform of the conjugate chirp, to both sides of 0.
    kernel: Vec<Complex64>,
    padded: Transform,
}

impl Transform {
    pub fn of(length: usize) -> Result<Self> {
        let mut factors = Vec::new();
        let mut rest = length;
        let mut factor = 2;
        while rest > 1 && factor <= LARGEST_FACTOR {
            if rest.is_multiple_of(factor) {
                factors.push(factor);
                rest /= factor;
            } else {
                factor += 1;
            }
        }
        let convolution = if rest > 1 { Some(Box::new(Convolution::of(length)?)) } else { None };
        let turn = |k: usize| Complex64::cis(-TAU * (k as f64 / length as f64));
        Ok(Self { factors, roots: memory::collected((0..length).map(turn))?, convolution })
    }

    /// Replace values by their transform.
    pub fn forward(&self, values: &mut [Complex64]) -> Result<()> {
        let length = self.roots.len();
        let Some(convolution) = &self.convolution else {
            let given = memory::collected(values.iter().copied())?;
            self.split(&given, 1, values, &self.factors, 1);
            return Ok(());
        };
        let Convolution { chirp, kernel, padded } = &**convolution;
        let mut long = memory::collected((0..kernel.len()).map(|k| match k {
            k if k < length => values[k] * chirp[k],
            _ => Complex64::ZERO,
        }))?;
        padded.forward(&mut long)?;
        for (value, factor) in long.iter_mut().zip(kernel) {
            *value *= factor;
        }
        padded.inverse(&mut long)?;
        for (value, (sum, turn)) in values.iter_mut().zip(long.iter().zip(chirp)) {
            *value = sum * turn;
        }
        Ok(())
    }

    /// Replace a transform by the values.
    pub fn inverse(&self, values: &mut [Complex64]) -> Result<()> {
        for value in values.iter_mut() {
            *value = value.conj();
        }
        self.forward(values)?;
        let length = self.roots.len() as f64;
        for value in values {
            *value = value.conj() / length;
        }
        Ok(())
    }

    /// Transform every `step`-th value: those of each remainder by the first factor, then their sums.
    fn split(
        &self,
        values: &[Complex64],
        step: usize,
        to: &mut [Complex64],
        factors: &[usize],
        stride: usize,
    ) {
        let [factor, rest @ ..] = factors else {
            to[0] = values[0];
            return;
        };
        let part = to.len() / factor;
        for (k, piece) in to.chunks_exact_mut(part).enumerate() {
            self.split(&values[k * step..], step * factor, piece, rest, stride * factor);
        }
        let mut turned = [Complex64::ZERO; LARGEST_FACTOR];
        for k in 0..part {
            for (j, value) in turned[..*factor].iter_mut().enumerate() {
                *value = to[j * part + k] * self.roots[j * k * stride];
            }
            if *factor == 2 {
                [to[k], to[part + k]] = [turned[0] + turned[1], turned[0] - turned[1]];
                continue;
            }
            for q in 0..*factor {
                let root = |j: usize| self.roots[j * q % factor * part * stride];
                to[q * part + k] = (0..*factor).map(|j| turned[j] * root(j)).sum();
            }
        }
    }
}

impl Convolution {
    fn of(length: usize) -> Result<Self> {
        // Squares as remainders of 2n, so that no digit of an angle is lost.
        let turn = |k: usize| {
            let parts = (k as u128 * k as u128) % (2 * length) as u128;
            Complex64::cis(-PI * (parts as f64 / length as f64))
        };
        let chirp = memory::collected((0..length).map(turn))?;
        let count = (2 * length - 1).next_power_of_two();
        let mut kernel = memory::collected((0..count).map(|k| match k.min(count - k) {
            k if k < length => chirp[k].conj(),
            _ => Complex64::ZERO,
        }))?;
        let padded = Transform::of(count)?;
        padded.forward(&mut kernel)?;
        Ok(Self { chirp, kernel, padded })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::draws;

    #[test]
    fn transforms_are_the_sums_whatever_the_length() {
        let mut number = draws(3);
        for length in [1, 2, 3, 4, 5, 8, 12, 31, 37, 60, 74, 97, 121, 360, 1369] {
            let values: Vec<Complex64> =
                (0..length).map(|_| Complex64::new(number(), number())).collect();
            let transform = Transform::of(length).unwrap();
            let mut found = values.clone();
            transform.forward(&mut found).unwrap();
            let turn =
                |parts: usize| Complex64::cis(-TAU * ((parts % length) as f64 / length as f64));
            // Each sum is of that many terms of order 1.
            let allowed = 1e-15 * length as f64;
            for (k, found) in found.iter().enumerate() {
                let sum: Complex64 =
                    values.iter().enumerate().map(|(j, value)| value * turn(j * k)).sum();
                assert!((found - sum).norm() < allowed, "{length}: {k}");
            }
            transform.inverse(&mut found).unwrap();
            let worst = |(one, other): (&Complex64, &Complex64)| (one - other).norm();
            assert!(values.iter().zip(&found).map(worst).fold(0.0, f64::max) < 1e-14);
        }
    }
}
