//! The list of bank angles: families unfolded.

use std::ops::Range;

use rayon::prelude::*;

use super::families::Family;
use crate::engine::Hold;
use crate::error::Result;
use crate::limits;

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
    /// Which of all these angles are in the window asked for.
    within: Range<usize>,
}

/// Where an angle comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Origin {
    pub family: Family,
    /// |arg(−Z₂/Z₁)| = middle·turn ± folded.
    pub middle: i64,
    pub sign: i64,
    /// With the pins held: what half of it is short of half a circle, rather than half of it.
    pub beyond: bool,
}

impl Angles {
    /// Of families that have at least the angles in the window, degrees.
    pub(super) fn new(
        families: Vec<Family>,
        turns: u32,
        turn: f64,
        hold: Hold,
        window: [f64; 2],
    ) -> Result<Self> {
        let near = 1e-9 * turn;
        let at_zero = usize::from(families.first().is_some_and(|first| first.folded() < near));
        let at_half = families.last().is_some_and(|last| last.folded() > 0.5 * turn - near);
        let at_half = usize::from(at_half);
        let mut angles = Self { families, turns, turn, at_zero, at_half, hold, within: 0..0 };
        let beginning = |wanted: &dyn Fn(f64) -> bool| {
            let (mut low, mut high) = (0, angles.all());
            while low < high {
                let middle = low.midpoint(high);
                if wanted(angles.at(middle)) { high = middle } else { low = middle + 1 }
            }
            low
        };
        let start = beginning(&|degrees| degrees >= window[0]);
        angles.within = start..beginning(&|degrees| degrees > window[1]).max(start);
        let cure = "ask for those within a narrower window, or for the counts alone";
        limits::result_size("bank angles", &[angles.count()], size_of::<f64>(), cure)?;
        Ok(angles)
    }

    /// How many.
    #[must_use]
    pub fn count(&self) -> usize {
        self.within.len()
    }

    /// Degrees, ascending.
    #[must_use]
    pub fn degrees(&self) -> Vec<f64> {
        self.within.clone().into_par_iter().with_min_len(4096).map(|k| self.at(k)).collect()
    }

    /// Where the k-th angle comes from.
    pub(super) fn get(&self, k: usize) -> Option<Origin> {
        (k < self.count()).then(|| self.origin(self.within.start + k))
    }

    /// How many angles all families have.
    fn all(&self) -> usize {
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

    /// The k-th of all angles, degrees.
    fn at(&self, k: usize) -> f64 {
        let Origin { family, middle, sign, beyond } = self.origin(k);
        let angle = middle as f64 * self.turn + sign as f64 * family.folded();
        let condition = angle.to_degrees().min(180.0);
        match self.hold {
            Hold::Firing => condition,
            Hold::Pins if beyond => 180.0 - 0.5 * condition,
            Hold::Pins => 0.5 * condition,
        }
    }

    fn origin(&self, k: usize) -> Origin {
        let beyond = k >= self.conditions();
        let k = if beyond { self.all() - 1 - k } else { k };
        let couple = self.families.len() + self.between();
        let (couples, rest) = ((k / couple) as i64, k % couple);
        if let Some(&family) = self.families.get(rest) {
            return Origin { family, middle: couples, sign: 1, beyond };
        }
        let from_end = rest - self.families.len() + self.at_half + 1;
        let family = self.families[self.families.len() - from_end];
        Origin { family, middle: couples + 1, sign: -1, beyond }
    }
}
