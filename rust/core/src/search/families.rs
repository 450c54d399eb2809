//! Bank angles at which only forward first-order moment is left, compared exactly.
//!
//! With every top dead centre held the angle is arg(−Z₂/Z₁). Turning one bank's crank turns it by a
//! part of a turn; so within a class of equal |Z| it is enough to look at one arrangement for each
//! crank, and to fold the angle into half such a part.

use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::enumerate::{Entry, classes, packed, refuse_too_large};
use super::family::{Families, Family, Same};
use super::images::Image;
use super::moments::{NEAR, fold, near};
use super::window::WindowTarget;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::pool;

/// |2Z| below which rounding asks for more than [`NEAREST_FOLDED`].
const SMALL: f64 = 0.1;
/// How near folded angles may be by rounding alone, unless |Z| is small.
const NEAREST_FOLDED: f64 = NEAR / SMALL;
/// Families in one range of folded angles, about, and most ranges.
const RANGE: usize = 4096;
const MOST_RANGES: usize = 512;

/// Families ascending by their folded angles, each angle once; and those whose angle is one of these,
/// [`NEAREST_FOLDED`] to it.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Distinct {
    pub families: Vec<Family>,
    pub others: Vec<Family>,
}

/// An arrangement of a class.
#[derive(Clone, Copy)]
pub(super) struct Member {
    pub place: usize,
    /// Of Z.
    pub argument: f64,
    /// What turns and images leave of it.
    folded: f64,
}

impl Families<'_> {
    /// Those whose folded angle is wanted.
    pub(super) fn all(self, wanted: &WindowTarget, cancel: &Cancel) -> Result<Distinct> {
        let entries = self.entries.all.len();
        refuse_too_many(least(entries, self.moments.images.mirror.is_some(), wanted), entries)?;
        let ranges = (entries / RANGE).clamp(1, MOST_RANGES);
        let per_radian = ranges as f64 / (0.5 * self.moments.turn);
        self.in_ranges(ranges, per_radian, wanted, cancel)
    }

    /// The same, divided among ranges of folded angles.
    fn in_ranges(
        self,
        ranges: usize,
        per_radian: f64,
        wanted: &WindowTarget,
        cancel: &Cancel,
    ) -> Result<Distinct> {
        cancel.expect(self.entries.ranges().len() + ranges);
        let count = AtomicUsize::new(0);
        let mut found = pool::map(cancel, self.entries.ranges(), |(start, range)| {
            let mut families = Vec::new();
            let mut stored = Ok(());
            let mut members = Vec::new();
            let mut place = start;
            for class in classes(range) {
                self.sorted_out(place, class, &mut members, |_, _| ());
                self.class(&members, |family| {
                    if wanted.has(family.folded()) && stored.is_ok() {
                        stored = memory::push(&mut families, family);
                    }
                });
                place += class.len();
            }
            stored?;
            count.fetch_add(families.len(), Ordering::Relaxed);
            refuse_too_many(count.load(Ordering::Relaxed), self.entries.all.len())?;
            cancel.step()?;
            Sorted::new(&families, ranges, per_radian)
        })?;
        let common = self.common().into_iter().filter(|family| wanted.has(family.folded()));
        found.push(Sorted::new(&common.collect::<Vec<_>>(), ranges, per_radian)?);
        let parts = pool::map(cancel, (0..ranges).collect(), |range| {
            let mut families = memory::room(found.iter().map(|f| f.range(range).len()).sum())?;
            for sorted in &found {
                families.extend_from_slice(sorted.range(range));
            }
            families.sort_unstable();
            cancel.step()?;
            let mut small = Vec::new();
            families.retain(|family| {
                if family.is_small() {
                    small.push(*family); // bounded: few families have a small |Z|
                }
                !family.is_small()
            });
            let room = memory::room(families.len())?;
            let mut distinct = Distinct { families: room, others: Vec::new() };
            distinct.join(&families, &mut Same::new(self))?;
            Ok((distinct, small))
        })?;
        let count = |of: fn(&Distinct) -> usize| parts.iter().map(|(part, _)| of(part)).sum();
        let mut all = Distinct {
            families: memory::room(count(|part| part.families.len()))?,
            others: memory::room(count(|part| part.others.len()))?,
        };
        let mut small = Vec::new();
        let mut same = Same::new(self);
        for (part, of_small) in parts {
            // Only what is close to the joint can be there already.
            let close = |family: &Family| {
                let last = all.families.last();
                last.is_some_and(|last| family.folded() - last.folded() <= NEAREST_FOLDED)
            };
            let (joint, rest) = part.families.split_at(part.families.partition_point(close));
            all.join(joint, &mut same)?;
            all.families.extend(rest);
            memory::extend(&mut all.others, part.others.into_iter())?;
            small.extend(of_small); // bounded: few families have a small |Z|
        }
        self.insert(&mut all, &small, &mut same)?;
        all.others.sort_unstable();
        Ok(all)
    }

    /// Insert families of small |Z|, of which there are few: rounding may have put them anywhere near.
    fn insert(self, to: &mut Distinct, families: &[Family], same: &mut Same<'_>) -> Result<()> {
        let mut new: Vec<Family> = Vec::new();
        for &family in families {
            let size = self.moments.twice(packed(self.entries.all[family.first()])).norm();
            let (low, high) = (family.folded() - near(size), family.folded() + near(size));
            let start = to.families.partition_point(|other| other.folded() < low);
            let close = to.families[start..].iter().take_while(|other| other.folded() <= high);
            match close.chain(&new).find(|&&other| same.angle(family, other)) {
                Some(&other) => memory::push(&mut to.others, family.at(other))?,
                None => new.push(family),
            }
        }
        if !new.is_empty() {
            memory::extend(&mut to.families, new.into_iter())?;
            to.families.sort_unstable();
        }
        Ok(())
    }

    /// One arrangement for each Z of a class, where turned, reversed and mirrored ones count once;
    /// none of the class of Z = 0. `each` gets all of the class after the one that counts for them.
    pub(super) fn sorted_out(
        self,
        start: usize,
        class: &[Entry],
        members: &mut Vec<Member>,
        mut each: impl FnMut(Member, Member),
    ) {
        members.clear();
        // Rows of a remainder that is zero are zero: the key is 0, and the class is the first.
        if start == 0 && self.moments.vanishes(packed(class[0])) {
            return;
        }
        for (i, &entry) in class.iter().enumerate() {
            let argument = self.moments.twice(packed(entry)).arg();
            members.push(Member { place: start + i, argument, folded: 0.0 });
        }
        if let &mut [only] = members.as_mut_slice() {
            each(only, only);
            return;
        }
        for member in &mut *members {
            member.folded = self.moments.folded(member.argument);
        }
        members.sort_unstable_by(|a, b| a.folded.total_cmp(&b.folded).then(a.place.cmp(&b.place)));
        let near = near(self.moments.twice(packed(class[0])).norm());
        let known = |member: &Member| (packed(class[member.place - start]), member.argument);
        let mut distinct = 0;
        for i in 0..members.len() {
            let member = members[i];
            let close = members[..distinct].iter().rev();
            let same = close
                .take_while(|other| member.folded - other.folded <= near)
                .find(|other| self.moments.same(known(&member), known(other), near));
            if let Some(&same) = same {
                each(same, member);
            } else {
                each(member, member);
                members[distinct] = member;
                distinct += 1;
            }
        }
        members.truncate(distinct);
    }

    /// The families of one class: all pairs of its members, the second as all its images.
    ///
    /// An arrangement with itself, or reversed, has the same angles in every class: they are left to
    /// [`Self::common`].
    #[inline]
    fn class(self, members: &[Member], mut found: impl FnMut(Family)) {
        let Some(first) = members.first() else { return };
        let size = self.moments.twice(packed(self.entries.all[first.place])).norm();
        for (a, first) in members.iter().enumerate() {
            for (b, second) in members[a..].iter().enumerate() {
                for image in self.moments.images.all() {
                    if b == 0 && !image.mirrored {
                        continue;
                    }
                    let angle = PI + self.moments.seen(second.argument, image) - first.argument;
                    let folded = fold(angle, self.moments.turn);
                    found(Family::new(folded, first.place, second.place, image, size < SMALL));
                }
            }
        }
    }

    /// Those with the angle of a family among others, and itself.
    pub(super) fn alike(self, family: Family, others: &[Family]) -> Result<Vec<Family>> {
        let folded = family.folded();
        let start = others.partition_point(|other| other.folded() < folded - NEAREST_FOLDED);
        let close =
            others[start..].iter().take_while(|other| other.folded() <= folded + NEAREST_FOLDED);
        let mut same = Same::new(self);
        let mut alike = memory::collected([family].into_iter())?;
        for &other in close {
            if same.angle(family, other) {
                memory::push(&mut alike, other)?;
            }
        }
        // One sequence, whichever of them is listed.
        let rank = |family: &Family| {
            let (second, image) = family.second();
            (family.first(), second, image.bits())
        };
        alike.sort_unstable_by_key(rank);
        Ok(alike)
    }

    /// What every class has: a bank with itself, at half a circle, and with itself reversed, at 0.
    fn common(self) -> Vec<Family> {
        let entries = self.entries.all.iter();
        let place = entries.enumerate().find(|(_, e)| !self.moments.vanishes(packed(**e)));
        let family = |place: usize, angle: f64, image: Image| {
            Family::new(fold(angle, self.moments.turn), place, place, image, false)
        };
        place.map_or_else(Vec::new, |(place, _)| {
            vec![family(place, PI, Image::ITSELF), family(place, 0.0, Image::OTHERS[0])]
        })
    }
}

impl Distinct {
    /// Append ascending families.
    fn join(&mut self, families: &[Family], same: &mut Same<'_>) -> Result<()> {
        for &family in families {
            let last = self.families.iter().rev();
            let mut close =
                last.take_while(|other| family.folded() - other.folded() <= NEAREST_FOLDED);
            if close.any(|&other| same.angle(family, other)) {
                memory::push(&mut self.others, family)?;
            } else {
                self.families.push(family);
            }
        }
        Ok(())
    }
}

/// Families grouped by ranges of their folded angles.
struct Sorted {
    families: Vec<Family>,
    /// Where each range starts, and the end.
    starts: Vec<usize>,
}

impl Sorted {
    fn new(families: &[Family], ranges: usize, per_radian: f64) -> Result<Self> {
        let range = |family: &Family| ((family.folded() * per_radian) as usize).min(ranges - 1);
        let mut starts = vec![0; ranges + 1];
        for family in families {
            starts[range(family) + 1] += 1;
        }
        for i in 0..ranges {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut sorted = memory::collected(families.iter().copied())?;
        for family in families {
            let place = &mut next[range(family)];
            sorted[*place] = *family;
            *place += 1;
        }
        Ok(Self { families: sorted, starts })
    }

    fn range(&self, range: usize) -> &[Family] {
        &self.families[self.starts[range]..self.starts[range + 1]]
    }
}

/// How many families are sure to come: half of what is to be expected where each arrangement and its
/// mirror image make two.
fn least(entries: usize, mirrored: bool, wanted: &WindowTarget) -> usize {
    if mirrored { (entries as f64 * wanted.share()) as usize } else { 0 }
}

/// Families and entries are of one size; families are grouped, gathered, sorted and joined.
fn refuse_too_many(families: usize, entries: usize) -> Result<()> {
    let bytes = (4 * families as u128 + entries as u128) * size_of::<Family>() as u128;
    let hint = "ask for those within a narrower window, or for the counts alone";
    refuse_too_large("bank angles", bytes, hint)
}

#[cfg(test)]
mod tests {
    use super::super::enumerate::{Entries, LARGEST_SEARCH};
    use super::super::magnitude::Magnitude;
    use super::super::moments::Moments;
    use super::super::throws::Bank;
    use std::f64::consts::TAU;

    use super::*;
    use crate::engine::Hold;
    use crate::numbers::angle::Angle;

    fn with_entries(bank: Bank, look: impl Fn(&Moments, &Entries)) {
        let moments = Moments::new(bank).unwrap();
        let magnitude = Magnitude::new(&moments.bank, &moments.ring).unwrap();
        let entries =
            Entries::new(&moments.bank, &magnitude, &moments.images, &Cancel::new()).unwrap();
        look(&moments, &entries);
    }

    fn banks() -> Vec<Bank> {
        let given = |degrees: &[f64]| {
            let phases: Vec<Angle> =
                degrees.iter().map(|&d| Angle::from_degrees(d).unwrap()).collect();
            Bank::with_phases(&phases).unwrap()
        };
        let mut banks: Vec<Bank> = (3..=6).map(|n| Bank::even_firing(n, false).unwrap()).collect();
        banks.extend([
            given(&[0.0, 90.0, 180.0, 270.0]),
            given(&[0.0, 30.0, 90.0, 210.0]),
            given(&[10.0, 50.0, 190.0, 230.0]),
        ]);
        banks
    }

    /// Small banks have no different angles nearer than this, and rounding none as far apart.
    const APART: f64 = 1e-9;

    #[test]
    fn families_are_the_same_where_their_folded_angles_are() {
        for bank in banks() {
            with_entries(bank, |moments, entries| {
                let families = Families { moments, entries };
                let mut all: Vec<Family> = Vec::new();
                for class in classes(&entries.all) {
                    let start = entries.all.iter().position(|e| e == &class[0]).unwrap();
                    let mut members = Vec::new();
                    families.sorted_out(start, class, &mut members, |_, _| ());
                    families.class(&members, |family| all.push(family));
                }
                all.extend(families.common());
                let mut same = Same::new(families);
                for (i, &a) in all.iter().enumerate().take(60) {
                    for &b in &all[i..] {
                        let near = (a.folded() - b.folded()).abs() < APART;
                        assert_eq!(same.angle(a, b), near, "{} {}", a.folded(), b.folded());
                    }
                }
            });
        }
    }

    #[test]
    fn arrangements_are_the_same_where_a_turn_and_an_image_make_them_so() {
        for bank in banks() {
            with_entries(bank, |moments, entries| {
                let of = |entry: &Entry| {
                    let z = moments.twice(packed(*entry));
                    (packed(*entry), z.norm(), z.arg())
                };
                let all: Vec<_> = entries.all.iter().map(of).filter(|a| a.1 > APART).collect();
                for &(a, size_a, arg_a) in &all {
                    for &(b, size_b, arg_b) in &all {
                        let mut images = moments.images.all();
                        let expected = (size_a - size_b).abs() < APART
                            && images.any(|image| {
                                fold(arg_a - moments.seen(arg_b, image), moments.turn) < APART
                            });
                        // Whatever is near, Z is compared exactly.
                        for near in [APART, 10.0] {
                            assert_eq!(moments.same((a, arg_a), (b, arg_b), near), expected);
                        }
                        assert!(!moments.same((a, arg_a), (b, arg_b + 0.3 * moments.turn), 0.0));
                    }
                    assert!(moments.same((a, arg_a), (a, arg_a), 0.0));
                }
            });
        }
    }

    #[test]
    fn turns_and_images_fold_to_one_argument() {
        for bank in banks() {
            let moments = Moments::new(bank).unwrap();
            let images = || moments.images.all();
            let middle = moments
                .images
                .mirror
                .map_or(0.0, |sum| PI * f64::from(sum) / f64::from(moments.bank.parts));
            for k in 0..50 {
                let argument = 0.123 * f64::from(k) - 3.0;
                let folded = moments.folded(argument);
                for image in images() {
                    let seen = moments.seen(argument, image) + f64::from(k % 3) * moments.turn;
                    assert!((moments.folded(seen) - folded).abs() < APART);
                }
                // ... which is that of one of them.
                assert!(images().any(|image| {
                    fold(moments.seen(middle + folded, image) - argument, moments.turn) < APART
                }));
            }
        }
    }

    #[test]
    fn what_does_not_fit_into_memory_is_refused() {
        let most = (LARGEST_SEARCH / 16) as usize;
        for (families, entries) in [(0, most), (most / 4, 0), (most / 4 - 1, 4)] {
            assert!(refuse_too_many(families, entries).is_ok());
            assert!(refuse_too_many(families, entries + 1).is_err());
        }
        let quarter = WindowTarget::new([0.0, 45.0], Hold::Firing, TAU);
        assert_eq!((least(1000, true, &quarter), least(1000, false, &quarter)), (250, 0));
    }

    #[test]
    fn what_is_not_small_is_close_wherever_rounding_put_it() {
        assert_eq!(near(SMALL), NEAREST_FOLDED);
    }

    /// |Z| nearly vanishes in some classes.
    fn small_banks() -> Vec<Bank> {
        let of = |parts: i64, phases: &[i64]| {
            let phases: Vec<Angle> =
                phases.iter().map(|&k| Angle::from_turns(k, parts).unwrap()).collect();
            Bank::with_phases(&phases).unwrap()
        };
        vec![
            of(15, &[0, 1, 2, 14]),
            of(21, &[0, 3, 9, 11, 17, 20]),
            of(16, &[0, 2, 7, 9, 12, 13]),
            of(28, &[0, 2, 13, 14, 16, 17]),
            of(30, &[0, 5, 6, 10, 19, 20]),
        ]
    }

    fn of_class(families: Families<'_>, class: &[Entry]) -> (usize, Vec<Family>) {
        let start = families.entries.all.iter().position(|e| e == &class[0]).unwrap();
        let (mut members, mut found) = (Vec::new(), Vec::new());
        families.sorted_out(start, class, &mut members, |_, _| ());
        families.class(&members, |family| found.push(family));
        (members.len(), found)
    }

    #[test]
    fn a_class_has_each_z_once_and_each_pair_as_all_images() {
        for bank in banks().into_iter().chain(small_banks()) {
            with_entries(bank, |moments, entries| {
                for class in classes(&entries.all) {
                    let z = |entry: &Entry| moments.twice(packed(*entry));
                    let size = z(&class[0]).norm();
                    let mut folded: Vec<f64> =
                        class.iter().map(|entry| moments.folded(z(entry).arg())).collect();
                    folded.sort_by(f64::total_cmp);
                    // With a mirror 0 and the end of a range are turning points, without they are one.
                    folded.dedup_by(|a, b| (*a - *b).abs() < APART);
                    let count = if size < APART { 0 } else { folded.len() };
                    let images = moments.images.count() as usize;
                    let (members, found) = of_class(Families { moments, entries }, class);
                    assert_eq!(members, count);
                    let pairs = count * count.saturating_sub(1) / 2 * images;
                    // Itself and itself reversed are common to all.
                    assert_eq!(found.len(), pairs + count * (images - 2));
                    assert!(found.iter().all(|family| family.is_small() == (size < SMALL)));
                }
            });
        }
    }

    #[test]
    fn what_is_joined_is_there_once() {
        for bank in banks().into_iter().take(3).chain(small_banks()) {
            with_entries(bank, |moments, entries| {
                let families = Families { moments, entries };
                let mut found: Vec<Family> = classes(&entries.all)
                    .flat_map(|class| of_class(families, class).1)
                    .filter(|family| !family.is_small())
                    .take(200)
                    .collect();
                found.sort();
                let mut joined = Distinct::default();
                joined.join(&found, &mut Same::new(families)).unwrap();
                let mut both = [joined.families.clone(), joined.others].concat();
                both.sort();
                assert_eq!(both, found);
                found.dedup_by(|a, b| a.folded() - b.folded() < APART);
                assert_eq!(joined.families, found);
            });
        }
    }

    #[test]
    fn small_ones_are_inserted_once_wherever_rounding_put_them() {
        for bank in small_banks() {
            with_entries(bank, |moments, entries| {
                let families = Families { moments, entries };
                let small: Vec<Family> = classes(&entries.all)
                    .flat_map(|class| of_class(families, class).1)
                    .filter(|family| family.is_small())
                    .collect();
                assert!(!small.is_empty());
                let inserted = |to: &[Family], new: &[Family]| {
                    let mut to = Distinct { families: to.to_vec(), others: Vec::new() };
                    let count = to.families.len() + new.len();
                    families.insert(&mut to, new, &mut Same::new(families)).unwrap();
                    assert_eq!(to.families.len() + to.others.len(), count);
                    // Beside the one whose angle they have, wherever rounding put them.
                    for other in &to.others {
                        let same = |family: &&Family| family.folded() == other.folded();
                        let family = *to.families.iter().find(same).unwrap();
                        assert!(families.alike(family, &[*other]).unwrap().contains(other));
                    }
                    to.families
                };
                let all = inserted(&[], &small);
                assert!(all.windows(2).all(|pair| pair[1].folded() - pair[0].folded() > APART));
                let known =
                    |a: &Family| all.iter().any(|b| (a.folded() - b.folded()).abs() < APART);
                assert!(small.iter().all(known));
                for (k, family) in all.iter().enumerate() {
                    let others = [&all[..k], &all[k + 1..]].concat();
                    assert_eq!(inserted(&others, &[*family]), all);
                    let size = moments.twice(packed(entries.all[family.first()])).norm();
                    for by in [-0.9, -0.1, 0.1, 0.9] {
                        let (second, image) = family.second();
                        let folded = family.folded() + by * NEAR / size;
                        if folded >= 0.0 {
                            let moved = Family::new(folded, family.first(), second, image, true);
                            assert_eq!(inserted(&all, &[moved]), all);
                            assert_eq!(inserted(&all, &[moved, *family, moved]), all);
                            assert_eq!(inserted(&[], &[moved, *family]), [moved]);
                        }
                    }
                }
            });
        }
    }

    #[test]
    fn however_they_are_shared_out_they_are_the_same() {
        for bank in banks().into_iter().chain(small_banks()) {
            with_entries(bank, |moments, entries| {
                let families = Families { moments, entries };
                let wanted = WindowTarget::new([0.0, 180.0], Hold::Firing, moments.turn);
                let all = families.all(&wanted, &Cancel::new()).unwrap();
                let check = |ranges: usize, per_radian: f64| {
                    let cancel = Cancel::new();
                    let found = families.in_ranges(ranges, per_radian, &wanted, &cancel);
                    assert_eq!(found.unwrap(), all, "{ranges} {per_radian}");
                    let (done, total) = cancel.progress();
                    assert_eq!(done, total);
                };
                for ranges in 1..10 {
                    check(ranges, ranges as f64 / (0.5 * moments.turn));
                }
                // Also where a range ends between angles that only rounding parts.
                let mut found: Vec<f64> = classes(&entries.all)
                    .flat_map(|class| of_class(families, class).1)
                    .map(Family::folded)
                    .collect();
                found.sort_by(f64::total_cmp);
                let parted = |pair: &&[f64]| {
                    let apart = pair[1] - pair[0];
                    apart < APART && apart > 4.0 * f64::EPSILON * pair[1]
                };
                for pair in found.windows(2).filter(parted).take(20) {
                    let per_radian = 1.0 / f64::midpoint(pair[0], pair[1]);
                    assert!(pair[0] * per_radian < 1.0 && pair[1] * per_radian >= 1.0);
                    check(2, per_radian);
                }
            });
        }
    }
}
