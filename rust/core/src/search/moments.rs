//! Z of an arrangement: in doubles, and exactly.

use std::f64::consts::{PI, TAU};

use super::images::{Image, Images, Packed, index};
use super::throws::Bank;
use crate::Complex64;
use crate::numbers::angle::Angle;
use crate::numbers::error::Result;
use crate::numbers::ring::Ring;

/// How near the arguments of two arrangements may be by rounding alone, times |2Z|: that is a sum of
/// 12 terms of at most 11, good to 1e-13.
pub(super) const NEAR: f64 = 1e-12;

/// The same of arrangements of this |2Z|.
pub(super) fn near(size: f64) -> f64 {
    NEAR / size.min(1.0)
}

/// What Z of a bank's arrangements is computed from.
#[derive(Debug)]
pub(super) struct Moments {
    pub bank: Bank,
    pub ring: Ring,
    pub images: Images,
    /// The least turn that leaves the bank's phases as they are, radians.
    pub turn: f64,
    weights: Vec<i64>,
    /// `e^{i·phase}` of the distinct phases, and its square.
    units: Vec<Complex64>,
    squares: Vec<Complex64>,
    /// One part of a turn.
    pub part: Angle,
}

impl Moments {
    pub(super) fn new(bank: Bank) -> Result<Self> {
        let ring = Ring::new(bank.parts)?;
        let images = Images::new(&bank);
        let parts = i64::from(bank.parts);
        let part = Angle::from_turns(1, parts)?;
        let [units, squares] =
            [1, 2].map(|n| images.distinct.iter().map(|&k| part.cis(n * i64::from(k))).collect());
        let weights = bank.weights();
        let turn = TAU / f64::from(bank.turns);
        Ok(Self { bank, ring, images, turn, weights, units, squares, part })
    }

    /// Twice Z = Σ s e^{i·phase}.
    #[inline]
    pub(super) fn twice(&self, packed: Packed) -> Complex64 {
        self.summed(&self.units, packed)
    }

    /// Twice the second-order moment, Σ s e^{2i·phase}.
    #[inline]
    pub(super) fn twice_second(&self, packed: Packed) -> Complex64 {
        self.summed(&self.squares, packed)
    }

    #[inline]
    fn summed(&self, units: &[Complex64], packed: Packed) -> Complex64 {
        let terms = self.weights.iter().enumerate();
        terms.map(|(throw, &weight)| units[index(packed, throw)] * weight as f64).sum()
    }

    /// Second-order moment of an image, turned by parts of a turn, from the arrangement's own.
    pub(super) fn second_seen(&self, second: Complex64, image: Image, turned: u32) -> Complex64 {
        let second = if image.reversed { -second } else { second };
        match self.images.mirror {
            Some(sum) if image.mirrored => {
                second.conj() * self.part.cis(2 * i64::from(sum + turned))
            }
            _ => second * self.part.cis(2 * i64::from(turned)),
        }
    }

    /// Whether Z is exactly zero.
    pub(super) fn vanishes(&self, packed: Packed) -> bool {
        let mut combination = Vec::new();
        self.combination(packed, Image::ITSELF, &mut combination);
        self.ring.vanishes(&combination, &mut Vec::new())
    }

    /// Argument of an image's Z, from the arrangement's own.
    #[inline]
    pub(super) fn seen(&self, argument: f64, image: Image) -> f64 {
        let reversed = if image.reversed { PI } else { 0.0 };
        match self.images.mirror {
            Some(sum) if image.mirrored => {
                reversed + TAU * f64::from(sum) / f64::from(self.bank.parts) - argument
            }
            _ => reversed + argument,
        }
    }

    /// What turning the crank and taking images leave of an argument.
    pub(super) fn folded(&self, argument: f64) -> f64 {
        // An even number of least turns has half a circle among them, which is what reversing adds.
        let step = if self.bank.turns.is_multiple_of(2) { self.turn } else { 0.5 * self.turn };
        match self.images.mirror {
            Some(sum) => fold(argument - PI * f64::from(sum) / f64::from(self.bank.parts), step),
            None => argument.rem_euclid(step),
        }
    }

    /// Whether Z of two arrangements is the same up to turns and images, where the arguments are
    /// known within `near`.
    pub(super) fn same(&self, a: (Packed, f64), b: (Packed, f64), near: f64) -> bool {
        self.images.all().any(|image| self.turned_to(a, b, image, near).is_some())
    }

    /// By how many parts of a turn the image of b is turned to have the Z of a, if it can be.
    pub(super) fn turned_to(
        &self,
        a: (Packed, f64),
        b: (Packed, f64),
        image: Image,
        near: f64,
    ) -> Option<u32> {
        let apart = a.1 - self.seen(b.1, image);
        if fold(apart, self.turn) > near {
            return None;
        }
        let turned = self.turns_in(apart);
        let parts = self.bank.parts as usize;
        let [mut wanted, mut seen] = [const { Vec::new() }; 2];
        self.combination(a.0, Image::ITSELF, &mut wanted);
        self.combination(b.0, image, &mut seen);
        for (k, term) in seen.iter().enumerate() {
            wanted[(k + turned) % parts] -= term;
        }
        self.ring.vanishes(&wanted, &mut Vec::new()).then_some(turned as u32)
    }

    /// An angle as the nearest number of least turns, in parts of a turn.
    pub(super) fn turns_in(&self, angle: f64) -> usize {
        let turns = i64::from(self.bank.turns);
        let nearest = (angle / self.turn).round() as i64;
        nearest.rem_euclid(turns) as usize * (i64::from(self.bank.parts) / turns) as usize
    }

    /// 2Z of an image as a combination of roots of unity.
    pub(super) fn combination(&self, packed: Packed, image: Image, combination: &mut Vec<i64>) {
        combination.clear();
        combination.resize(self.bank.parts as usize, 0);
        let sign = if image.reversed { -1 } else { 1 };
        for (throw, weight) in self.weights.iter().enumerate() {
            let phase = self.images.seen(self.images.distinct[index(packed, throw)], image);
            combination[phase as usize] += sign * weight;
        }
    }
}

/// An angle less turns, and without its sign: in [0, turn/2].
#[inline]
pub(super) fn fold(angle: f64, turn: f64) -> f64 {
    let rest = angle - turn * (angle / turn).floor();
    rest.min(turn - rest).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_argument_is_as_uncertain_as_z_is_over_its_size() {
        for size in [1e-9, 1e-4, 0.01, 0.3, 1.0, 5.0] {
            let z = Complex64::from_polar(size, 0.7);
            // Across z, where it turns it most.
            let moved = (z + Complex64::from_polar(NEAR, 0.7 + 0.5 * PI)).arg() - z.arg();
            // Arguments are rounded to 1e-16.
            assert!(moved <= near(size) + 1e-15, "{moved}");
            assert!(size > 1.0 || moved >= 0.99 * near(size) - 1e-15, "{moved}");
        }
    }

    #[test]
    fn a_combination_is_what_an_image_sees() {
        let phases = [0, 2, 7, 9, 12, 13].map(|k| Angle::from_turns(k, 16).unwrap());
        for bank in [Bank::with_phases(&phases), Bank::even_firing(7, false)] {
            let moments = Moments::new(bank.unwrap()).unwrap();
            let throws = moments.bank.throws();
            // Phases in some order, by index among the distinct ones.
            let packed =
                (0..throws).fold(0, |packed, i| packed | ((5 * i % throws) as u64) << (4 * i + 4));
            let z = moments.twice(packed);
            let mut combination = Vec::new();
            for image in moments.images.all() {
                moments.combination(packed, image, &mut combination);
                let parts = combination.len() as f64;
                let unit = |k: usize| Complex64::cis(TAU * k as f64 / parts);
                let sum: Complex64 =
                    combination.iter().enumerate().map(|(k, &c)| unit(k) * c as f64).sum();
                // Sums of few terms of at most 7.
                let seen = Complex64::from_polar(z.norm(), moments.seen(z.arg(), image));
                assert!((sum - seen).norm() < 1e-12, "{sum} {seen}");
            }
        }
    }
}
