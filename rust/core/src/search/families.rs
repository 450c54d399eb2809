//! Bank angles at which only forward first-order moment is left, compared exactly.
//!
//! With every top dead centre held the angle is arg(−Z₂/Z₁). Turning one bank's crank turns it by a
//! part of a turn; so within a class of equal |Z| it is enough to look at one arrangement for each
//! crank, and to fold the angle into half such a part.

use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::enumerate::{KeyedArrangement, classes, refuse_too_large};
use super::family::{ExactComparison, Families, Family};
use super::images::Image;
use super::moments::{NEAR, fold, near};
use super::ranges::{self, Ranges};
use super::window::WindowTarget;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::pool;

/// |2Z| below which rounding asks for more than [`NEAREST_FOLDED`].
const SMALL_MOMENT: f64 = 0.1;
/// How near folded angles may be by rounding alone, unless |Z| is small.
const NEAREST_FOLDED: f64 = NEAR / SMALL_MOMENT;
/// Families between two checks for cancellation: each takes 1 µs, or two.
const FAMILIES_PER_CHECK: usize = 4096;

/// Families ascending by their folded angles, each angle once; and those whose angle is one of these,
/// [`NEAREST_FOLDED`] to it.
#[derive(Debug, Default, PartialEq)]
pub(super) struct FamiliesByAngle {
    pub families: Vec<Family>,
    pub others: Vec<Family>,
}

/// An arrangement of a class.
#[derive(Clone, Copy)]
pub(super) struct ClassMember {
    pub place: u32,
    /// Of Z.
    pub argument: f64,
    /// What turns and images leave of it.
    folded: f64,
}

impl Families<'_> {
    /// Those whose folded angle is wanted.
    pub(super) fn all(self, wanted: &WindowTarget, cancel: &Cancel) -> Result<FamiliesByAngle> {
        let ranges = ranges::count(self.entries.all.len() as u128);
        let per_radian = ranges as f64 / (0.5 * self.moments.turn);
        let range = |family: Family| ((family.folded() * per_radian) as usize).min(ranges - 1);
        cancel.expect(self.entries.ranges().len() + ranges);
        let count = AtomicUsize::new(0);
        let mut gathered = pool::map(cancel, self.entries.ranges(), |(start, entries)| {
            let (mut families, mut members) = (Ranges::new(ranges), Vec::new());
            let (mut place, mut found) = (start, 0);
            for class in classes(entries) {
                self.sorted_out(place, class, &mut members, |_, _| Ok(()))?;
                self.class(&members, |family| {
                    if !wanted.has(family.folded()) {
                        return Ok(());
                    }
                    found += 1;
                    families.push(range(family), family)
                })?;
                place += class.len();
            }
            let found = count.fetch_add(found, Ordering::Relaxed) + found;
            refuse_too_many(found, self.entries.all.len())?;
            cancel.step()?;
            Ok(families)
        })?;
        let mut common = Ranges::new(ranges);
        for family in self.common().into_iter().filter(|family| wanted.has(family.folded())) {
            common.push(range(family), family)?;
        }
        gathered.push(common);
        let (mut families, _) = Ranges::sorted(gathered, cancel)?;
        let mut small = Vec::new();
        families.retain(|family| {
            if family.small {
                small.push(*family); // bounded: few families have a small |Z|
            }
            !family.small
        });
        let mut all = FamiliesByAngle::default();
        let mut same = ExactComparison::new(self);
        all.join(families, &mut same, cancel)?;
        self.insert(&mut all, &small, &mut same)?;
        all.others.sort_unstable();
        Ok(all)
    }

    /// Insert families of small |Z|, of which there are few: rounding may have put them anywhere near.
    fn insert(
        self,
        to: &mut FamiliesByAngle,
        families: &[Family],
        same: &mut ExactComparison<'_>,
    ) -> Result<()> {
        let mut new: Vec<Family> = Vec::new();
        for &family in families {
            let size = self.moments.twice(self.packed(family.first)).norm();
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
        class: &[KeyedArrangement],
        members: &mut Vec<ClassMember>,
        mut each: impl FnMut(ClassMember, ClassMember) -> Result<()>,
    ) -> Result<()> {
        members.clear();
        // Rows of a remainder that is zero are zero: the key is 0, and the class is the first.
        if start == 0 && self.moments.vanishes(class[0].packed) {
            return Ok(());
        }
        for (i, &entry) in class.iter().enumerate() {
            let argument = self.moments.twice(entry.packed).arg();
            members.push(ClassMember { place: (start + i) as u32, argument, folded: 0.0 });
        }
        if let &mut [only] = members.as_mut_slice() {
            return each(only, only);
        }
        for member in &mut *members {
            member.folded = self.moments.folded(member.argument);
        }
        members.sort_unstable_by(|a, b| a.folded.total_cmp(&b.folded).then(a.place.cmp(&b.place)));
        let near = near(self.moments.twice(class[0].packed).norm());
        let known =
            |member: &ClassMember| (class[member.place as usize - start].packed, member.argument);
        let mut distinct = 0;
        for i in 0..members.len() {
            let member = members[i];
            let close = members[..distinct].iter().rev();
            let same = close
                .take_while(|other| member.folded - other.folded <= near)
                .find(|other| self.moments.same(known(&member), known(other), near));
            if let Some(&same) = same {
                each(same, member)?;
            } else {
                each(member, member)?;
                members[distinct] = member;
                distinct += 1;
            }
        }
        members.truncate(distinct);
        Ok(())
    }

    /// The families of one class: all pairs of its members, the second as all its images.
    ///
    /// An arrangement with itself, or reversed, has the same angles in every class: they are left to
    /// [`Self::common`].
    #[inline]
    fn class(
        self,
        members: &[ClassMember],
        mut found: impl FnMut(Family) -> Result<()>,
    ) -> Result<()> {
        let Some(first) = members.first() else { return Ok(()) };
        let size = self.moments.twice(self.packed(first.place)).norm();
        for (a, first) in members.iter().enumerate() {
            for (b, second) in members[a..].iter().enumerate() {
                for image in self.moments.images.all() {
                    if b == 0 && !image.mirrored {
                        continue;
                    }
                    let angle = PI + self.moments.seen(second.argument, image) - first.argument;
                    let folded = fold(angle, self.moments.turn);
                    let small = size < SMALL_MOMENT;
                    found(Family::new(folded, [first.place, second.place], image, small))?;
                }
            }
        }
        Ok(())
    }

    /// Those with the angle of a family among others, and itself.
    pub(super) fn of_equal_angle(self, family: Family, others: &[Family]) -> Result<Vec<Family>> {
        let folded = family.folded();
        let start = others.partition_point(|other| other.folded() < folded - NEAREST_FOLDED);
        let close =
            others[start..].iter().take_while(|other| other.folded() <= folded + NEAREST_FOLDED);
        let mut same = ExactComparison::new(self);
        let mut equal = memory::collected([family].into_iter())?;
        for &other in close {
            if same.angle(family, other) {
                memory::push(&mut equal, other)?;
            }
        }
        // One sequence, whichever of them is listed.
        let rank = |family: &Family| (family.first, family.second, family.image);
        equal.sort_unstable_by_key(rank);
        Ok(equal)
    }

    /// What every class has: a bank with itself, at half a circle, and with itself reversed, at 0.
    fn common(self) -> Vec<Family> {
        let entries = self.entries.all.iter();
        let place = entries.enumerate().find(|(_, e)| !self.moments.vanishes(e.packed));
        let family = |place: u32, angle: f64, image: Image| {
            Family::new(fold(angle, self.moments.turn), [place; 2], image, false)
        };
        place.map_or_else(Vec::new, |(place, _)| {
            let place = place as u32;
            vec![family(place, PI, Image::ITSELF), family(place, 0.0, Image::OTHERS[0])]
        })
    }
}

impl FamiliesByAngle {
    /// Take ascending families.
    fn join(
        &mut self,
        families: Vec<Family>,
        same: &mut ExactComparison<'_>,
        cancel: &Cancel,
    ) -> Result<()> {
        let mut distinct = 0;
        self.families = families;
        for k in 0..self.families.len() {
            if k.is_multiple_of(FAMILIES_PER_CHECK) {
                cancel.check()?;
            }
            let family = self.families[k];
            let last = self.families[..distinct].iter().rev();
            let mut close =
                last.take_while(|other| family.folded() - other.folded() <= NEAREST_FOLDED);
            if close.any(|&other| same.angle(family, other)) {
                memory::push(&mut self.others, family)?;
            } else {
                self.families[distinct] = family;
                distinct += 1;
            }
        }
        self.families.truncate(distinct);
        Ok(())
    }
}

/// Families are gathered, sorted and joined.
fn refuse_too_many(families: usize, entries: usize) -> Result<()> {
    let bytes =
        (3 * families * size_of::<Family>() + entries * size_of::<KeyedArrangement>()) as u128;
    let hint = "ask for those within a narrower window, or for the counts alone";
    refuse_too_large("bank angles", bytes, hint)
}

#[cfg(test)]
mod tests {
    use super::super::enumerate::{Entries, LARGEST_SEARCH};
    use super::super::magnitude::Magnitude;
    use super::super::moments::Moments;
    use super::super::throws::Bank;

    use super::*;
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
                    families.sorted_out(start, class, &mut members, |_, _| Ok(())).unwrap();
                    let push = |family| {
                        all.push(family);
                        Ok(())
                    };
                    families.class(&members, push).unwrap();
                }
                all.extend(families.common());
                let mut same = ExactComparison::new(families);
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
                let of = |entry: &KeyedArrangement| {
                    let z = moments.twice(entry.packed);
                    (entry.packed, z.norm(), z.arg())
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
        let most = LARGEST_SEARCH as usize;
        for (families, entries) in [(0, most / 16), (most / 72, 0)] {
            assert!(refuse_too_many(families, entries).is_ok());
            assert!(refuse_too_many(families, entries + 1).is_err());
            assert!(refuse_too_many(families + 1, entries).is_err());
        }
    }

    #[test]
    fn what_is_not_small_is_close_wherever_rounding_put_it() {
        assert_eq!(near(SMALL_MOMENT), NEAREST_FOLDED);
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

    fn of_class(families: Families<'_>, class: &[KeyedArrangement]) -> (usize, Vec<Family>) {
        let start = families.entries.all.iter().position(|e| e == &class[0]).unwrap();
        let (mut members, mut found) = (Vec::new(), Vec::new());
        families.sorted_out(start, class, &mut members, |_, _| Ok(())).unwrap();
        let push = |family| {
            found.push(family);
            Ok(())
        };
        families.class(&members, push).unwrap();
        (members.len(), found)
    }

    #[test]
    fn a_class_has_each_z_once_and_each_pair_as_all_images() {
        for bank in banks().into_iter().chain(small_banks()) {
            with_entries(bank, |moments, entries| {
                for class in classes(&entries.all) {
                    let z = |entry: &KeyedArrangement| moments.twice(entry.packed);
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
                    assert!(found.iter().all(|family| family.small == (size < SMALL_MOMENT)));
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
                    .filter(|family| !family.small)
                    .take(200)
                    .collect();
                found.sort();
                let mut joined = FamiliesByAngle::default();
                joined
                    .join(found.clone(), &mut ExactComparison::new(families), &Cancel::new())
                    .unwrap();
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
                    .filter(|family| family.small)
                    .collect();
                assert!(!small.is_empty());
                let inserted = |to: &[Family], new: &[Family]| {
                    let mut to = FamiliesByAngle { families: to.to_vec(), others: Vec::new() };
                    let count = to.families.len() + new.len();
                    families.insert(&mut to, new, &mut ExactComparison::new(families)).unwrap();
                    assert_eq!(to.families.len() + to.others.len(), count);
                    // Beside the one whose angle they have, wherever rounding put them.
                    for other in &to.others {
                        let same = |family: &&Family| family.folded() == other.folded();
                        let family = *to.families.iter().find(same).unwrap();
                        assert!(
                            families.of_equal_angle(family, &[*other]).unwrap().contains(other)
                        );
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
                    let size = moments.twice(families.packed(family.first)).norm();
                    for by in [-0.9, -0.1, 0.1, 0.9] {
                        let folded = family.folded() + by * NEAR / size;
                        if folded >= 0.0 {
                            let places = [family.first, family.second];
                            let moved = Family::new(folded, places, family.image, true);
                            assert_eq!(inserted(&all, &[moved]), all);
                            assert_eq!(inserted(&all, &[moved, *family, moved]), all);
                            assert_eq!(inserted(&[], &[moved, *family]), [moved]);
                        }
                    }
                }
            });
        }
    }
}
