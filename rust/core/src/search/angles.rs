//! The list of bank angles: families unfolded.

use std::f64::consts::TAU;
use std::ops::Range;

use super::families::FamiliesByAngle;
use super::family::{Families, Family};
use crate::engine::Hold;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::{limits, memory, pool};

/// Rounding moves no folded angle by more, radians.
const FOLDING_ERROR: f64 = 1e-6;

/// Bank angles in ascending order, each with a pair of arrangements that has it.
///
/// With families ascending by their folded angle f, all angles come in runs that need no sorting:
/// f, turn − f (families backwards), turn + f, 2·turn − f, … up to half a circle.
#[derive(Debug)]
pub struct Angles {
    families: Vec<Family>,
    /// Families whose angle is one of these.
    others: Vec<Family>,
    /// Least turns in a whole one, and parts of it.
    turns: u32,
    parts: u32,
    /// Families whose angle is a rational part of a turn: index, and angle in steps of a turn over
    /// `4·parts`.
    rational: Vec<(usize, i64)>,
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
pub(super) struct AngleSource {
    pub family: Family,
    /// Index of the family.
    index: usize,
    /// |arg(−Z₂/Z₁)| = middle·turn ± folded.
    pub middle: i64,
    pub sign: i64,
    /// With the pins held: what half of it is short of half a circle, rather than half of it.
    pub beyond: bool,
}

impl Angles {
    /// Of families that have at least the angles in the window, degrees.
    pub(super) fn new(
        context: Families<'_>,
        FamiliesByAngle { families, others }: FamiliesByAngle,
        hold: Hold,
        window: [f64; 2],
    ) -> Result<Self> {
        let bank = &context.moments.bank;
        let (turns, parts) = (bank.turns, bank.parts);
        let mut angles = Self {
            families,
            others,
            turns,
            parts,
            rational: Vec::new(),
            at_zero: 0,
            at_half: 0,
            hold,
            within: 0..0,
        };
        angles.find_rational(context);
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
        let hint = "ask for those within a narrower window, or for the counts alone";
        limits::result_size("bank angles", &[angles.count()], size_of::<f64>(), hint)?;
        Ok(angles)
    }

    /// Find the families at rational parts of a turn, and put those at 0 and at half a least turn where
    /// they belong.
    fn find_rational(&mut self, context: Families<'_>) {
        let half = 2 * i64::from(self.parts / self.turns);
        for steps in 0..=half {
            let at = TAU * steps as f64 / f64::from(4 * self.parts);
            let start =
                self.families.partition_point(|family| family.folded() < at - FOLDING_ERROR);
            let close =
                self.families[start..].iter().take_while(|f| f.folded() <= at + FOLDING_ERROR);
            let found = close.clone().position(|&family| context.steps(family) == Some(steps));
            let Some(mut index) = found.map(|k| start + k) else { continue };
            if steps == 0 {
                self.families[..=index].rotate_right(1);
                (self.at_zero, index) = (1, 0);
            } else if steps == half {
                self.families[index..].rotate_left(1);
                (self.at_half, index) = (1, self.families.len() - 1);
            }
            self.rational.push((index, steps));
        }
    }

    /// Number of angles.
    #[must_use]
    pub fn count(&self) -> usize {
        self.within.len()
    }

    /// Degrees, ascending.
    pub fn degrees(&self, cancel: &Cancel) -> Result<Vec<f64>> {
        const ANGLES_PER_TASK: usize = 1 << 14;
        let mut degrees = memory::zeros(self.count())?;
        let chunks = degrees.chunks_mut(ANGLES_PER_TASK).enumerate().collect();
        pool::map(cancel, chunks, |(chunk, out): (usize, &mut [f64])| {
            cancel.check()?;
            for (k, value) in out.iter_mut().enumerate() {
                *value = self.at(self.within.start + chunk * ANGLES_PER_TASK + k);
            }
            Ok(())
        })?;
        Ok(degrees)
    }

    /// Degrees of the k-th angle.
    pub(super) fn degrees_at(&self, k: usize) -> f64 {
        self.at(self.within.start + k)
    }

    /// Where the k-th angle comes from.
    pub(super) fn get(&self, k: usize) -> Option<AngleSource> {
        (k < self.count()).then(|| self.origin(self.within.start + k))
    }

    /// The families that have an angle.
    pub(super) fn of_equal_angle(
        &self,
        origin: AngleSource,
        context: Families<'_>,
    ) -> Result<Vec<Family>> {
        context.of_equal_angle(origin.family, &self.others)
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

    /// The k-th of all angles, degrees; correctly rounded if it is a rational part of a turn.
    fn at(&self, k: usize) -> f64 {
        let AngleSource { family, index, middle, sign, beyond } = self.origin(k);
        if let Ok(found) = self.rational.binary_search_by_key(&index, |&(index, _)| index) {
            let whole = 4 * i64::from(self.parts);
            let steps = middle * (whole / i64::from(self.turns)) + sign * self.rational[found].1;
            let degrees = |steps: i64, of: i64| (360 * steps) as f64 / of as f64;
            return match self.hold {
                Hold::Firing => degrees(steps, whole),
                Hold::Pins if beyond => degrees(whole - steps, 2 * whole),
                Hold::Pins => degrees(steps, 2 * whole),
            };
        }
        let turn = 360.0 / f64::from(self.turns);
        let condition = middle as f64 * turn + sign as f64 * family.folded().to_degrees();
        let condition = condition.min(180.0);
        match self.hold {
            Hold::Firing => condition,
            Hold::Pins if beyond => 180.0 - 0.5 * condition,
            Hold::Pins => 0.5 * condition,
        }
    }

    fn origin(&self, k: usize) -> AngleSource {
        let beyond = k >= self.conditions();
        let k = if beyond { self.all() - 1 - k } else { k };
        let couple = self.families.len() + self.between();
        let (couples, rest) = ((k / couple) as i64, k % couple);
        if let Some(&family) = self.families.get(rest) {
            return AngleSource { family, index: rest, middle: couples, sign: 1, beyond };
        }
        let from_end = rest - self.families.len() + self.at_half + 1;
        let index = self.families.len() - from_end;
        let family = self.families[index];
        AngleSource { family, index, middle: couples + 1, sign: -1, beyond }
    }
}
