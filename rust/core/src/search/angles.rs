//! Bank angles at which only forward first-order moment is left, told apart exactly.
//!
//! With every top dead centre held the angle is arg(−Z₂/Z₁). Turning one bank's crank turns it by a
//! part of a turn; so within a class of equal |Z| it is enough to look at one arrangement for each
//! crank, fold the angle into half such a part, and list the others from there.

use std::f64::consts::{PI, TAU};

use rayon::slice::ParallelSliceMut;

use super::enumerate::Entry;
use super::images::{Images, Packed, index};
use super::ring::Ring;
use super::throws::Bank;
use crate::Complex64;
use crate::angle::Angle;
use crate::engine::Hold;

/// Relative to 1/|Z|: how near two folded angles may be by rounding alone. Z is a sum of 15 terms of
/// at most 14, good to 1e-13.
const NEAR: f64 = 1e-12;

/// A folded angle and the two arrangements that have it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Family {
    /// In [0, half of the least turn], radians.
    pub folded: f64,
    /// Where the angle is before it is folded.
    pub angle: f64,
    /// Packed arrangements of the first and the second bank.
    pub pair: [Packed; 2],
    /// |2Z|.
    size: f64,
}

/// What angles are worked out from.
pub(super) struct Sums<'a> {
    pub bank: &'a Bank,
    pub ring: &'a Ring,
    pub images: &'a Images,
    /// Twice the weights of the throws.
    weights: Vec<i64>,
    units: Vec<Complex64>,
    /// The least turn that leaves the bank's phases as they are, radians.
    pub turn: f64,
}

impl<'a> Sums<'a> {
    pub(super) fn new(bank: &'a Bank, ring: &'a Ring, images: &'a Images) -> Self {
        let parts = i64::from(bank.parts);
        let units = (0..parts).map(|k| Angle::Turns(1, parts).cis(k)).collect();
        let turn = TAU / f64::from(bank.turns());
        Self { bank, ring, images, weights: bank.weights(), units, turn }
    }

    /// Twice Z = Σ s e^{i·phase}.
    pub(super) fn moment(&self, packed: Packed) -> Complex64 {
        let terms = self.weights.iter().enumerate().map(|(i, &weight)| {
            let phase = self.images.distinct[index(packed, i + 1)];
            self.units[phase as usize] * weight as f64
        });
        terms.sum()
    }

    fn combination(&self, packed: Packed) -> Vec<i128> {
        let mut combination = vec![0; self.bank.parts as usize];
        for (phase, weight) in self.images.phases(packed).into_iter().zip(&self.weights) {
            combination[phase as usize] += i128::from(*weight);
        }
        combination
    }

    /// The families of one class: arrangements of equal |Z|, not zero, one of each set of images.
    ///
    /// An arrangement with itself, or reversed, has the same angles in every class: they are left to
    /// [`Self::common`].
    pub(super) fn families(&self, class: &[Entry], out: &mut Vec<Family>) {
        let distinct = self.distinct_moments(class);
        for (a, &(first, moment)) in distinct.iter().enumerate() {
            for (b, &(second, _)) in distinct[a..].iter().enumerate() {
                for (k, image) in self.images.all(second).into_iter().enumerate() {
                    let other = self.moment(image);
                    if b == 0 && (k == 0 || (other + moment).norm() < 1e-9) {
                        continue;
                    }
                    let angle = (-other / moment).arg();
                    out.push(self.family(angle, [first, image], moment.norm()));
                }
            }
        }
    }

    /// What every class has: a bank with itself, and with itself reversed.
    pub(super) fn common(&self, packed: Packed) -> [Family; 2] {
        let size = self.moment(packed).norm();
        let reversed = self
            .images
            .all(packed)
            .into_iter()
            .find(|&image| (self.moment(image) + self.moment(packed)).norm() < 1e-9);
        let same = self.family(PI, [packed, packed], size);
        [same, reversed.map_or(same, |reversed| self.family(0.0, [packed, reversed], size))]
    }

    fn family(&self, angle: f64, pair: [Packed; 2], size: f64) -> Family {
        Family { folded: fold(angle, self.turn), angle, pair, size }
    }

    /// Sort families by angle from `start` on and leave one of those that are the same.
    pub(super) fn merge(&self, families: &mut Vec<Family>, start: usize) {
        let mut found: Vec<Family> = families.split_off(start);
        found.par_sort_unstable_by(|a, b| a.folded.total_cmp(&b.folded).then(a.pair.cmp(&b.pair)));
        for family in found {
            let tolerance = |other: &Family| NEAR / family.size.min(other.size).min(1.0);
            let same = families[start..]
                .iter()
                .rev()
                .take_while(|other| family.folded - other.folded <= tolerance(other))
                .any(|other| self.same(&family, other));
            if !same {
                families.push(family);
            }
        }
    }

    /// Whether two folded angles are equal: −Z₂Z̄₁/|Z|² up to a turn and conjugation.
    fn same(&self, a: &Family, b: &Family) -> bool {
        let quotient = |family: &Family| {
            let [first, second] = family.pair.map(|packed| self.combination(packed));
            let numerator = self.ring.times_conjugate(&second, &first);
            let size = self.ring.times_conjugate(&first, &first);
            (numerator, size)
        };
        let ((x, of_x), (y, of_y)) = (quotient(a), quotient(b));
        // x/|x|² = y/|y|²: multiplied out, |y|² being its own conjugate.
        let left = self.ring.remainder(&self.ring.times_conjugate(&x, &of_y));
        let right = self.ring.times_conjugate(&y, &of_x);
        let mirrored = self.ring.conjugate(&right);
        // The turn between them is known from the angles; which it is exactly is what is asked.
        [(right, a.angle - b.angle), (mirrored, a.angle + b.angle)].iter().any(|(right, apart)| {
            self.ring.remainder(&self.ring.turned(right, self.turns_in(*apart))) == left
        })
    }

    /// An angle as the nearest number of least turns, in parts.
    fn turns_in(&self, angle: f64) -> usize {
        let turns = i64::from(self.bank.turns());
        let nearest = (angle / self.turn).round() as i64;
        nearest.rem_euclid(turns) as usize * (i64::from(self.bank.parts) / turns) as usize
    }

    /// One arrangement for each Z of a class, where turned, reversed and mirrored ones count once.
    fn distinct_moments(&self, class: &[Entry]) -> Vec<(Packed, Complex64)> {
        let mut found: Vec<(Packed, Complex64)> = Vec::with_capacity(class.len());
        for &(_, packed) in class {
            let packed = packed & !15;
            let moment = self.moment(packed);
            if !found.iter().any(|other| self.same_moment((packed, moment), *other)) {
                found.push((packed, moment));
            }
        }
        found
    }

    fn same_moment(&self, a: (Packed, Complex64), b: (Packed, Complex64)) -> bool {
        let near = NEAR / a.1.norm().min(1.0);
        [1.0, -1.0].iter().any(|sign| {
            [b.1, b.1.conj()].iter().enumerate().any(|(mirrored, other)| {
                if mirrored == 1 && self.bank.mirror().is_none() {
                    return false;
                }
                let apart = (a.1 / (other * *sign)).arg();
                if fold(apart, self.turn) > near {
                    return false;
                }
                let mut combination = self.combination(b.0);
                if mirrored == 1 {
                    combination = self.ring.conjugate(&combination);
                }
                let turned = self.ring.turned(&combination, self.turns_in(apart));
                let scaled: Vec<i128> = turned.iter().map(|&c| c * *sign as i128).collect();
                self.ring.remainder(&scaled) == self.ring.remainder(&self.combination(a.0))
            })
        })
    }
}

/// An angle less turns, and without its sign: in [0, turn/2].
fn fold(angle: f64, turn: f64) -> f64 {
    let rest = angle.rem_euclid(turn);
    rest.min(turn - rest)
}

/// Bank angles in ascending order, each with a pair of arrangements that has it.
///
/// With families ascending by their folded angle f, all angles come in runs that need no sorting:
/// f, turn − f (families backwards), turn + f, 2·turn − f, … up to half a circle.
#[derive(Debug)]
pub struct Angles {
    families: Vec<Family>,
    turns: u32,
    turn: f64,
    /// Families at 0 (the first or none) and at half a turn (the last or none): they stand once where
    /// others stand twice.
    at_zero: usize,
    at_half: usize,
    hold: Hold,
}

impl Angles {
    pub(super) fn new(families: Vec<Family>, turns: u32, turn: f64, hold: Hold) -> Self {
        let near = 1e-9 * turn;
        let at_zero = usize::from(families.first().is_some_and(|first| first.folded < near));
        let at_half = families.last().is_some_and(|last| last.folded > 0.5 * turn - near);
        Self { families, turns, turn, at_zero, at_half: usize::from(at_half), hold }
    }

    /// How many.
    #[must_use]
    pub fn count(&self) -> usize {
        match self.hold {
            Hold::Firing => self.conditions(),
            // Half of each, and what half is short of half a circle; 180° halves to 90° both ways.
            Hold::Pins => 2 * self.conditions() - usize::from(self.reaches_half_a_circle()),
        }
    }

    /// How many values |arg(−Z₂/Z₁)| takes.
    fn conditions(&self) -> usize {
        let turns = self.turns as usize;
        turns.div_ceil(2) * self.families.len()
            + turns / 2 * self.between()
            + if turns.is_multiple_of(2) { self.at_zero } else { 0 }
    }

    fn reaches_half_a_circle(&self) -> bool {
        if self.turns.is_multiple_of(2) { self.at_zero == 1 } else { self.at_half == 1 }
    }

    /// Families neither at 0 nor at half a turn.
    fn between(&self) -> usize {
        self.families.len() - self.at_zero - self.at_half
    }

    /// Degrees, ascending.
    #[must_use]
    pub fn degrees(&self) -> Vec<f64> {
        let mut degrees = self.condition_degrees();
        if self.hold == Hold::Pins {
            let short = usize::from(self.reaches_half_a_circle());
            let rest: Vec<f64> =
                degrees.iter().rev().skip(short).map(|d| 180.0 - 0.5 * d).collect();
            for degree in &mut degrees {
                *degree *= 0.5;
            }
            degrees.extend(rest);
        }
        degrees
    }

    fn condition_degrees(&self) -> Vec<f64> {
        let mut degrees = Vec::with_capacity(self.count());
        for run in 0..=self.turns {
            let middle = f64::from(run.div_ceil(2)) * self.turn;
            let angle = |f: f64| (middle + f).to_degrees().min(180.0);
            if run.is_multiple_of(2) {
                // Past half a circle there is only what stands at it.
                let here = if run < self.turns { self.families.len() } else { self.at_zero };
                let here =
                    if run == self.turns && !self.turns.is_multiple_of(2) { 0 } else { here };
                degrees.extend(self.families[..here].iter().map(|family| angle(family.folded)));
            } else if run < self.turns {
                let end = self.families.len() - self.at_half;
                let here = &self.families[self.at_zero..end];
                degrees.extend(here.iter().rev().map(|family| angle(-family.folded)));
            }
        }
        degrees
    }

    /// The pair of the k-th angle, by how many least turns its second bank is ahead, and whether the
    /// angle is half the condition's or that short of half a circle.
    pub(super) fn pair(&self, k: usize) -> Option<([Packed; 2], u32, bool)> {
        if k >= self.count() {
            return None;
        }
        let beyond = k >= self.conditions();
        let k = if beyond { self.count() - 1 - k } else { k };
        let couple = self.families.len() + self.between();
        let (couples, rest) = (k / couple, k % couple);
        // |α| = middle·turn ± f
        let (family, middle, sign) = if rest < self.families.len() {
            (&self.families[rest], couples, 1)
        } else {
            let from_end = rest - self.families.len() + self.at_half + 1;
            (&self.families[self.families.len() - from_end], couples + 1, -1)
        };
        // The family's own angle is σ·f + j·turn; α = ε|α| with ε = σ·sign has the same f.
        let rest = family.angle.rem_euclid(self.turn);
        let sigma = if rest <= 0.5 * self.turn { 1 } else { -1 };
        let own = (family.angle - f64::from(sigma) * family.folded) / self.turn;
        let ahead = i64::from(sigma * sign) * middle as i64 - own.round() as i64;
        Some((family.pair, ahead.rem_euclid(i64::from(self.turns)) as u32, beyond))
    }
}

impl Sums<'_> {
    /// Whether Z is exactly zero.
    pub(super) fn vanishes(&self, packed: Packed) -> bool {
        self.ring.remainder(&self.combination(packed)).iter().all(|&term| term == 0)
    }
}
