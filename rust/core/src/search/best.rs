//! The pair listed for a bank angle: the one with the smallest moments.
//!
//! At a bank angle α the counterweight's moment is |Z| sin α, the same for a class. Second-order moments
//! follow from z = Σ s e^{2i·phase} of both banks. If the parts of a turn are odd in number, squaring
//! is an automorphism of their roots of unity, so that banks of equal Z have equal z; otherwise all those
//! of equal Z are compared.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::Search;
use super::angles::{AngleSource, Angles};
use super::enumerate::{classes, refuse_too_large};
use super::families::ClassMember;
use super::family::{Families, Family};
use super::images::Image;
use super::moments::{Moments, NEAR, near};
use crate::Complex64;
use crate::engine::Hold;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::{memory, pool};

/// Second-order moments, doubled, that are closer count as one.
const EQUAL_MOMENTS: f64 = 1e-9;
/// Makes them positive, in these units.
const POSITIVE_SHIFT: f64 = 1e12;

/// Place of the arrangement that counts for those of its Z, and a second-order moment in units.
type Key = (u32, [u64; 2]);

/// By what pairs are compared; those alike in it are by the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Criterion {
    /// The larger of the second-order moments about x and y.
    SecondOrder,
    /// The first-order moment, which a counterweight takes away.
    Counterweight,
}

/// A bank: an image of an arrangement, turned.
#[derive(Debug, Clone, Copy)]
pub(super) struct TurnedBank {
    place: u32,
    image: Image,
    /// Parts of a turn.
    turned: u32,
    /// Place of the arrangement that counts for those of its Z.
    of: u32,
    /// Twice its second-order moment.
    second: Complex64,
}

impl TurnedBank {
    fn new(families: Families<'_>, place: u32) -> Self {
        let second = families.moments.twice_second(families.packed(place));
        Self { place, image: Image::ITSELF, turned: 0, of: place, second }
    }

    /// An image of the bank, turned.
    fn seen(self, moments: &Moments, image: Image, turned: u32) -> Self {
        let parts = moments.bank.parts;
        let own = if image.mirrored { parts - self.turned } else { self.turned };
        Self {
            image: self.image.then(image),
            turned: (own + turned) % parts,
            second: moments.second_seen(self.second, image, turned),
            ..self
        }
    }

    /// Phases of its throws, front to flywheel.
    pub(super) fn phases(self, families: Families<'_>) -> Vec<u32> {
        let moments = families.moments;
        let phases = moments.images.phases(families.packed(self.place), self.image);
        phases.map(|phase| (phase + self.turned) % moments.bank.parts).collect()
    }
}

/// The best pair so far, of one bank angle.
#[derive(Clone, Copy)]
struct Best {
    by: Criterion,
    /// Twice the second-order moment, and |2Z| sin α.
    second: f64,
    first: f64,
    pair: Option<[TurnedBank; 2]>,
}

impl Best {
    /// Whether a pair with these moments is better by more than rounding.
    #[inline]
    fn exceeds(&self, second: f64, first: f64) -> bool {
        let (found, least) = match self.by {
            Criterion::SecondOrder => ([second, first], [self.second, self.first]),
            Criterion::Counterweight => ([first, second], [self.first, self.second]),
        };
        found[0] < least[0] - NEAR || (found[0] <= least[0] + NEAR && found[1] < least[1] - NEAR)
    }
}

/// Pairs of banks at one bank angle, the second as an image and turned.
#[derive(Clone, Copy)]
struct Pairs<'a> {
    families: Families<'a>,
    image: Image,
    turned: u32,
    /// Of half the bank angle.
    cos: f64,
    sin: f64,
    /// Turns the second bank's second-order moment against the first's.
    turn: Complex64,
}

impl Pairs<'_> {
    /// The larger of the second-order moments about x and y.
    #[inline]
    fn larger(&self, first: Complex64, second: Complex64) -> f64 {
        let second = if self.image.mirrored { second.conj() } else { second } * self.turn;
        let about_x = (first + second).norm_sqr() * self.cos * self.cos;
        let about_y = (first - second).norm_sqr() * self.sin * self.sin;
        about_x.max(about_y).sqrt()
    }

    /// What the larger cannot be below: the squares of sum and difference are twice the squares together.
    #[inline]
    fn bound(&self, first: Complex64, second: Complex64) -> f64 {
        let squares = first.norm_sqr() + second.norm_sqr();
        self.cos * self.sin * (2.0 * squares).sqrt()
    }

    /// Banks of one |Z|, in ascending order of their second-order moments.
    fn compare(&self, best: &mut Best, size: f64, firsts: &[TurnedBank], seconds: &[TurnedBank]) {
        for &first in firsts {
            for (k, &second) in seconds.iter().enumerate() {
                if !best.exceeds(self.bound(first.second, second.second), size) {
                    if k == 0 {
                        return;
                    }
                    break;
                }
                let moment = self.larger(first.second, second.second);
                if best.exceeds(moment, size) {
                    self.take(best, moment, size, [first, second]);
                }
            }
        }
    }

    fn take(&self, best: &mut Best, second: f64, first: f64, [one, other]: [TurnedBank; 2]) {
        let other = other.seen(self.families.moments, self.image, self.turned);
        *best = Best { second, first, pair: Some([one, other]), ..*best };
    }
}

/// Banks of equal Z, where second-order moments do not follow from it: one of each moment, in ascending
/// order of these.
#[derive(Debug)]
pub(super) struct EqualBanks(Vec<TurnedBank>);

impl EqualBanks {
    fn new(families: Families<'_>, cancel: &Cancel) -> Result<Self> {
        let count = AtomicUsize::new(0);
        let found = pool::map(cancel, families.entries.ranges(), |(start, range)| {
            let (mut place, mut members) = (start, Vec::new());
            let (mut banks, mut all) = (Vec::new(), Vec::new());
            for class in classes(range) {
                cancel.check()?;
                families.sorted_out(place, class, &mut members, |of, member| {
                    Self::add(families, of, member, &mut banks)
                })?;
                banks.sort_unstable_by_key(|(key, bank)| (*key, bank.place, bank.image));
                banks.dedup_by_key(|(key, _)| *key);
                let size = |bank: &TurnedBank| bank.second.norm_sqr();
                banks.sort_by(|(_, a), (_, b)| a.of.cmp(&b.of).then(size(a).total_cmp(&size(b))));
                refuse_too_many(count.fetch_add(banks.len(), Ordering::Relaxed) + banks.len())?;
                memory::extend(&mut all, banks.drain(..).map(|(_, bank)| bank))?;
                place += class.len();
            }
            Ok(all)
        })?;
        let mut all = memory::with_capacity(found.iter().map(Vec::len).sum())?;
        all.extend(found.into_iter().flatten());
        Ok(Self(all))
    }

    /// The images of an arrangement that have the Z of another one, turned.
    fn add(
        families: Families<'_>,
        of: ClassMember,
        member: ClassMember,
        to: &mut Vec<(Key, TurnedBank)>,
    ) -> Result<()> {
        let moments = families.moments;
        let known = |member: ClassMember| (families.packed(member.place), member.argument);
        let near = near(moments.twice(known(of).0).norm());
        for image in moments.images.all() {
            if let Some(turned) = moments.turned_to(known(of), known(member), image, near) {
                let bank = TurnedBank::new(families, member.place).seen(moments, image, turned);
                let rounded = [bank.second.re, bank.second.im]
                    .map(|part| (part / EQUAL_MOMENTS + POSITIVE_SHIFT + 0.5) as u64);
                memory::push(to, ((of.place, rounded), TurnedBank { of: of.place, ..bank }))?;
            }
        }
        Ok(())
    }

    /// Those with the Z of the arrangement at a place, the first in its class that has it.
    fn of(&self, place: u32) -> &[TurnedBank] {
        let rest = &self.0[self.0.partition_point(|bank| bank.of < place)..];
        &rest[..rest.partition_point(|bank| bank.of == place)]
    }
}

/// They are found range by range, and gathered.
fn refuse_too_many(banks: usize) -> Result<()> {
    let bytes = 2 * banks as u128 * size_of::<TurnedBank>() as u128;
    refuse_too_large("arrangements", bytes, "ask for the bank angles alone")
}

impl Search {
    /// The best of the pairs with a bank angle, degrees; either bank may be the right one.
    pub(super) fn best_pair(
        &self,
        angles: &Angles,
        origin: AngleSource,
        bank_angle: f64,
        by: Criterion,
        cancel: &Cancel,
    ) -> Result<Option<[TurnedBank; 2]>> {
        let families = self.families();
        let radians = bank_angle.to_radians();
        let (sin, cos) = (0.5 * radians).sin_cos();
        let size = |place: u32| self.moments.twice(families.packed(place)).norm() * radians.sin();
        let mut best = Best { by, second: f64::INFINITY, first: f64::INFINITY, pair: None };
        for family in angles.of_equal_angle(origin, families)? {
            let Family { first, second, image, .. } = family;
            let (turned, exchanged) = self.ahead(origin, family);
            // With the pins held, phases turn with the bores.
            let bores = match self.hold {
                Hold::Firing => 0.0,
                Hold::Pins if exchanged => 2.0 * radians,
                Hold::Pins => -2.0 * radians,
            };
            let own = self.moments.second_seen(Complex64::new(1.0, 0.0), image, turned);
            let turn = own * Complex64::cis(bores);
            let pairs = Pairs { families, image, turned, cos, sin, turn };
            match (self.equals(cancel)?, family.is_common()) {
                (None, true) => best = self.best_of_all(best, pairs, radians.sin(), cancel)?,
                (None, false) => {
                    let [one, other] = [first, second].map(|p| TurnedBank::new(families, p));
                    pairs.compare(&mut best, size(one.place), &[one], &[other]);
                }
                (Some(equals), true) => {
                    for banks in equals.0.chunk_by(|a, b| a.of == b.of) {
                        cancel.check()?;
                        pairs.compare(&mut best, size(banks[0].of), banks, banks);
                    }
                }
                (Some(equals), false) => {
                    let [one, other] = [first, second].map(|place| equals.of(place));
                    pairs.compare(&mut best, size(first), one, other);
                }
            }
        }
        Ok(best.pair)
    }

    /// The best pair of an arrangement and itself, as an image and turned.
    fn best_of_all(
        &self,
        best: Best,
        pairs: Pairs<'_>,
        sine: f64,
        cancel: &Cancel,
    ) -> Result<Best> {
        let one = Complex64::new(1.0, 0.0);
        let factor = pairs.larger(one, one);
        let balanced = self.zero_class().len();
        let found = pool::map(cancel, self.entries.ranges(), |(start, range)| {
            cancel.check()?;
            let mut best = best;
            for (k, entry) in range.iter().enumerate().skip(balanced.saturating_sub(start)) {
                let size = self.moments.twice(entry.packed).norm() * sine;
                let second = self.moments.twice_second(entry.packed).norm() * factor;
                if best.exceeds(second, size) {
                    let bank = TurnedBank::new(pairs.families, (start + k) as u32);
                    pairs.take(&mut best, second, size, [bank; 2]);
                }
            }
            Ok(best)
        })?;
        let better = |a: Best, b: Best| if a.exceeds(b.second, b.first) { b } else { a };
        Ok(found.into_iter().fold(best, better))
    }

    /// Banks of equal Z, unless second-order moments follow from that; found once.
    fn equals(&self, cancel: &Cancel) -> Result<Option<&EqualBanks>> {
        if self.bank().parts % 2 == 1 {
            return Ok(None);
        }
        if self.equals.get().is_none() {
            // Another thread may have set the same.
            drop(self.equals.set(EqualBanks::new(self.families(), cancel)?));
        }
        Ok(self.equals.get())
    }

    /// How many parts of a turn the second bank of a family is turned for an angle, and whether it is
    /// the right one then.
    ///
    /// Families at 0 or half a turn have two such numbers, and the second adds nothing: at 0 the banks
    /// have equal Z, and exchanging them is the second. At half a turn between different Z, turns are
    /// even in number, and moments of second order are turned by an odd number of double turns against
    /// the first: a whole circle for two turns, half of one for four, which reversing makes up for; with
    /// six or more, and up to 12 throws, there is no such pair.
    fn ahead(&self, origin: AngleSource, family: Family) -> (u32, bool) {
        let Moments { bank, turn, .. } = &self.moments;
        // The family's own angle is σ·f + j·turn; α = ε|α| with ε = σ·sign has the same f.
        let angle = self.families().angle(family);
        let sigma = if angle.rem_euclid(*turn) <= 0.5 * turn { 1 } else { -1 };
        let own = ((angle - sigma as f64 * family.folded()) / turn).round() as i64;
        let direction = sigma * origin.sign;
        let ahead = (direction * origin.middle - own).rem_euclid(i64::from(bank.turns)) as u32;
        (ahead * (bank.parts / bank.turns), (direction < 0) != origin.beyond)
    }
}

#[cfg(test)]
mod tests {
    use super::super::enumerate::LARGEST_SEARCH;
    use super::*;

    #[test]
    fn banks_that_do_not_fit_into_memory_are_refused() {
        let most = (LARGEST_SEARCH / 2) as usize / size_of::<TurnedBank>();
        assert!(refuse_too_many(most).is_ok());
        assert!(refuse_too_many(most + 1).is_err());
    }
}
