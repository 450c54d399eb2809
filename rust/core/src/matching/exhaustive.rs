//! Exhaustive matching: all arrangements of one set of parts, all partitions into sets.
//!
//! Arrangements of one half of the places are compared with those of the other, sorted by their first
//! component; partitions are a dynamic programme over the parts that are left. Of equals, such as an
//! arrangement and its mirror image, the first in the order of the lists counts, not the last bit.

use std::collections::HashMap;
use std::ops::Range;

use super::{KINDS_OF_PARTS, Matching, Partition};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::{memory, pool};

/// Half arrangements of one exhaustive comparison; up to ten seconds on one core.
const MOST_ARRANGEMENTS: f64 = 1e7;
/// Comparisons of an exhaustive search for the best partition into sets; a second.
const MOST_SETS: usize = 10_000_000;
/// Parts of a kind that fit a bit mask.
const MOST_MASKED: usize = 28;

impl Matching {
    /// Number of arrangements of halves of the places that [`Matching::arranged`] visits, by the number
    /// of available parts of each kind.
    fn half_arrangements(&self, available: &[usize]) -> f64 {
        let (first, second) = (self.places / 2, self.places - self.places / 2);
        let orders = |count: usize| -> f64 { (1..=count).map(|k| k as f64).product() };
        let kinds = self.kinds.len() as i32;
        let of_parts = available.iter().map(|&parts| {
            number_of_choices(parts, first) * number_of_choices(parts - first, second)
        });
        of_parts.product::<f64>() * (orders(first).powi(kinds) + orders(second).powi(kinds))
    }

    /// The best of all matchings of a single set, or the one that is known; None where there are too
    /// many to compare.
    pub(super) fn of_all(
        &self,
        known: &(f64, Partition),
        cancel: &Cancel,
    ) -> Result<Option<Partition>> {
        let available: Vec<usize> = self.kinds.iter().map(|kind| kind.parts).collect();
        if self.half_arrangements(&available) > MOST_ARRANGEMENTS {
            return Ok(None);
        }
        let available: Vec<Vec<usize>> =
            available.iter().map(|&parts| (0..parts).collect()).collect();
        let halves = choices(&available, self.places / 2);
        cancel.expect(halves.len());
        // The one that is known is among all, and its equals before it count.
        let known_too = known.0 + 2.0 * self.tied;
        let found = pool::map(cancel, halves, |ours| {
            let best = self.completed(&available, &ours, known_too, cancel)?;
            cancel.step()?;
            Ok(best)
        })?;
        let better = |best: (f64, Partition), other: (f64, Partition)| {
            if other.0 < best.0 - self.tied { other } else { best }
        };
        let best = found.into_iter().flatten().reduce(better);
        Ok(Some(best.map_or_else(|| known.1.clone(), |(_, chosen)| chosen)))
    }

    /// The best arrangement of one set of these parts, and the length of its remainder.
    fn arranged(&self, available: &[Vec<usize>], cancel: &Cancel) -> Result<(f64, Partition)> {
        let mut best = (f64::INFINITY, Partition::new());
        for ours in choices(available, self.places / 2) {
            if let Some(better) = self.completed(available, &ours, best.0, cancel)? {
                best = better;
            }
        }
        Ok(best)
    }

    /// The best arrangement with these parts in the first half of the places, and the length of its
    /// remainder, if that is less than `known` by more than rounding.
    ///
    /// For every choice of the parts of the second half, the arrangement that makes up for one of the
    /// first is looked for among those of the second, sorted by their first component.
    fn completed(
        &self,
        available: &[Vec<usize>],
        ours: &[Vec<usize>],
        known: f64,
        cancel: &Cancel,
    ) -> Result<Option<(f64, Partition)>> {
        let half = self.places / 2;
        let pairs = available.iter().zip(ours);
        let left: Vec<Vec<usize>> = pairs
            .map(|(all, taken)| all.iter().copied().filter(|part| !taken.contains(part)).collect())
            .collect();
        let first = self.arrangements(0..half, ours, &self.start)?;
        let zero = vec![0.0; self.start.len()];
        let mut best: Option<(f64, Partition)> = None;
        for theirs in choices(&left, self.places - half) {
            cancel.check()?;
            let second = self.arrangements(half..self.places, &theirs, &zero)?;
            let least = best.as_ref().map_or(known, |(value, _)| *value);
            if let Some((value, a, b)) = first.closest(&second, least, self.tied) {
                let joined = (0..self.kinds.len())
                    .map(|kind| [first.parts(a, kind), second.parts(b, kind)].concat());
                best = Some((value, joined.collect()));
            }
        }
        Ok(best)
    }

    /// All arrangements of these parts of each kind in some places, added to `start`.
    fn arrangements(
        &self,
        places: Range<usize>,
        parts: &[Vec<usize>],
        start: &[f64],
    ) -> Result<Arrangements> {
        let count: usize = parts.iter().map(|each| (1..=each.len()).product::<usize>()).product();
        let mut found = Arrangements {
            places: places.len(),
            kinds: parts.len(),
            dimensions: start.len(),
            sums: memory::with_capacity(count * start.len())?,
            parts: memory::with_capacity(count * parts.len() * places.len())?,
        };
        self.fill(&mut found, &places, parts, &mut Vec::new(), start.to_vec());
        Ok(found)
    }

    fn fill(
        &self,
        to: &mut Arrangements,
        places: &Range<usize>,
        parts: &[Vec<usize>],
        chosen: &mut Vec<usize>,
        sum: Vec<f64>,
    ) {
        let kind = chosen.len().checked_div(places.len()).unwrap_or(parts.len());
        if kind == parts.len() {
            to.sums.extend(sum);
            to.parts.extend_from_slice(chosen);
            return;
        }
        let place = places.start + chosen.len() % places.len();
        for &part in &parts[kind] {
            if !chosen[kind * places.len()..].contains(&part) {
                let mut sum = sum.clone();
                self.add(&mut sum, 1.0, kind, [place, part]);
                chosen.push(part);
                self.fill(to, places, parts, chosen, sum);
                chosen.pop();
            }
        }
    }

    /// The best partition of the parts into sets, or the one that is known; None where there are too
    /// many to compare.
    pub(super) fn partitioned(
        &self,
        known: &(f64, Partition),
        cancel: &Cancel,
    ) -> Result<Option<Partition>> {
        let sizes = self.kinds.iter().map(|kind| number_of_choices(kind.parts, self.places));
        let one = vec![self.places; self.kinds.len()];
        if self.kinds.iter().any(|kind| kind.parts > MOST_MASKED)
            || sizes.product::<f64>() * self.half_arrangements(&one) > MOST_ARRANGEMENTS
        {
            return Ok(None);
        }
        let mut unused = [0; KINDS_OF_PARTS];
        for (mask, kind) in unused.iter_mut().zip(&self.kinds) {
            *mask = (1 << kind.parts) - 1;
        }
        let mut search = Partitions {
            problem: self,
            cancel,
            best: HashMap::new(),
            values: HashMap::new(),
            compared: 0,
        };
        let Some(least) = search.least(unused, self.sets)? else { return Ok(None) };
        if least > known.0 + self.tied {
            return Ok(Some(known.1.clone()));
        }
        let mut chosen = vec![Vec::new(); self.kinds.len()];
        for sets in (1..=self.sets).rev() {
            let (_, taken, rest) = search.best[&(unused, sets)];
            let (_, of_set) = self.arranged(&self.listed(taken), cancel)?;
            chosen.iter_mut().zip(of_set).for_each(|(all, parts)| all.extend(parts));
            unused = rest;
        }
        Ok(Some(chosen))
    }

    /// Numbers of the parts of each kind.
    fn listed(&self, masks: Masks) -> Vec<Vec<usize>> {
        masks.into_iter().take(self.kinds.len()).map(|mask| bits_of(mask).collect()).collect()
    }
}

/// Arrangements of some parts in some places.
struct Arrangements {
    places: usize,
    kinds: usize,
    dimensions: usize,
    /// What each adds: (arrangements, dimensions).
    sums: Vec<f64>,
    /// Its parts: (arrangements, kinds, places).
    parts: Vec<usize>,
}

impl Arrangements {
    /// Number of each arrangement, and what it adds.
    fn numbered(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.sums.chunks_exact(self.dimensions).enumerate()
    }

    fn parts(&self, k: usize, kind: usize) -> &[usize] {
        &self.parts[(k * self.kinds + kind) * self.places..][..self.places]
    }

    /// The pair with the shortest sum, if it is shorter than `known` by more than `tied`: its length, and
    /// the two; of those as short but for that the first.
    fn closest(&self, other: &Self, known: f64, tied: f64) -> Option<(f64, usize, usize)> {
        let mut least = known;
        let mut found: Option<(f64, usize, usize)> = None;
        let mut sorted: Vec<(usize, &[f64])> = other.numbered().collect();
        sorted.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]));
        for (i, ours) in self.numbered() {
            let reach = least + tied;
            let begin = sorted.partition_point(|(_, theirs)| theirs[0] < -ours[0] - reach);
            for &(j, theirs) in &sorted[begin..] {
                if ours[0] + theirs[0] > reach {
                    break;
                }
                let square: f64 = ours.iter().zip(theirs).map(|(a, b)| (a + b).powi(2)).sum();
                if square >= (least + tied) * (least + tied) {
                    continue;
                }
                let sum = square.sqrt();
                let is_before = found.is_some_and(|(_, one, other)| one == i && j < other);
                if sum < least - tied || is_before {
                    least = least.min(sum);
                    found = Some((least, i, j));
                }
            }
        }
        found
    }
}

/// Parts of each kind as bits.
type Masks = [u32; KINDS_OF_PARTS];

/// Partitions of parts into sets, by dynamic programming over the parts that are left.
struct Partitions<'a> {
    problem: &'a Matching,
    cancel: &'a Cancel,
    /// Parts left and sets to fill → least sum, parts of the next set, parts left after it.
    best: HashMap<(Masks, usize), (f64, Masks, Masks)>,
    /// Parts of a set → length of its best arrangement.
    values: HashMap<Masks, f64>,
    compared: usize,
}

impl Partitions<'_> {
    /// Least sum of `sets` sets of the parts that are left; None after too many comparisons.
    fn least(&mut self, left: Masks, sets: usize) -> Result<Option<f64>> {
        if sets == 0 {
            return Ok(Some(0.0));
        }
        if let Some((value, ..)) = self.best.get(&(left, sets)) {
            return Ok(Some(*value));
        }
        let (places, lowest) = (self.problem.places, left[0] & left[0].wrapping_neg());
        let mut best = (f64::INFINITY, Masks::default(), Masks::default());
        // The first part of the first kind is left over, or belongs to the next set.
        if left[0].count_ones() as usize > sets * places {
            let without = [left[0] & !lowest, left[1]];
            if self.least(without, sets)?.is_none() {
                return Ok(None);
            }
            best = self.best[&(without, sets)];
        }
        let other = subsets(left[1], if self.problem.kinds.len() > 1 { places } else { 0 });
        let others: Vec<u32> = other.collect();
        for first in subsets(left[0] & !lowest, places - 1) {
            for &other in &others {
                self.cancel.check()?;
                self.compared += 1;
                if self.compared > MOST_SETS {
                    return Ok(None);
                }
                let taken = [lowest | first, other];
                let value = self.value(taken)?;
                if value >= best.0 {
                    continue;
                }
                let rest = [left[0] & !taken[0], left[1] & !taken[1]];
                let Some(of_rest) = self.least(rest, sets - 1)? else { return Ok(None) };
                if value + of_rest < best.0 - self.problem.tied {
                    best = (value + of_rest, taken, rest);
                }
            }
        }
        self.best.insert((left, sets), best);
        Ok(Some(best.0))
    }

    fn value(&mut self, taken: Masks) -> Result<f64> {
        if let Some(value) = self.values.get(&taken) {
            return Ok(*value);
        }
        let (value, _) = self.problem.arranged(&self.problem.listed(taken), self.cancel)?;
        self.values.insert(taken, value);
        Ok(value)
    }
}

/// All subsets of `count` bits.
fn subsets(bits: u32, count: usize) -> impl Iterator<Item = u32> {
    let places: Vec<usize> = bits_of(bits).collect();
    let end = 1u64 << places.len();
    // The next larger number with as many ones (Gosper).
    let next = |&of: &u64| {
        let (lowest, above) = (of & of.wrapping_neg(), of + (of & of.wrapping_neg()));
        (of > 0).then(|| above | ((of ^ above) / lowest) >> 2)
    };
    let chosen = std::iter::successors(Some((1u64 << count) - 1), next);
    chosen.take_while(move |&of| of < end).map(move |of| {
        let places = places.iter().enumerate().filter(|(k, _)| of >> k & 1 == 1);
        places.fold(0, |mask, (_, place)| mask | 1 << place)
    })
}

/// Places of the bits that are set.
fn bits_of(mask: u32) -> impl Iterator<Item = usize> {
    (0..u32::BITS as usize).filter(move |place| mask >> place & 1 == 1)
}

fn number_of_choices(of: usize, count: usize) -> f64 {
    (0..count).map(|k| (of - k) as f64 / (k + 1) as f64).product()
}

/// All choices of `count` parts of every kind.
fn choices(available: &[Vec<usize>], count: usize) -> Vec<Vec<Vec<usize>>> {
    let mut found = vec![Vec::new()];
    for parts in available {
        let of_kind = combinations(parts, count);
        found = found
            .iter()
            .flat_map(|before| {
                of_kind.iter().map(|each| [&before[..], std::slice::from_ref(each)].concat())
            })
            .collect();
    }
    found
}

fn combinations(parts: &[usize], count: usize) -> Vec<Vec<usize>> {
    if count == 0 {
        return vec![Vec::new()];
    }
    let firsts = 0..(parts.len() + 1).saturating_sub(count);
    firsts
        .flat_map(|k| {
            combinations(&parts[k + 1..], count - 1)
                .into_iter()
                .map(move |rest| [&[parts[k]][..], &rest].concat())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::problem;
    use super::super::{Measure, PartKind};
    use super::*;
    use crate::numbers::draws;

    #[test]
    fn too_many_matchings_are_not_compared() {
        let none = (f64::INFINITY, Partition::new());
        let of = |sizes, parts| problem(sizes, parts, 1.0, draws(5));
        // Choices of three pistons of six, and the orders of either half.
        assert_eq!(of([1, 6, 1], &[6]).half_arrangements(&[6]), 20.0 * (6.0 + 6.0));
        // Two and three of six and five: (6·5/2)(4) pistons, (5·4/2)(1) rods.
        let both = of([1, 5, 1], &[6, 5]).half_arrangements(&[6, 5]);
        assert_eq!(both, 15.0 * 4.0 * 10.0 * (2.0 * 2.0 + 6.0 * 6.0));
        // Every two of four, with the only two of two.
        assert_eq!(choices(&[vec![0, 1, 2, 3], vec![0, 1]], 2).len(), 6);
        // 3.5e7 half arrangements.
        assert_eq!(of([1, 14, 1], &[14]).of_all(&none, &Cancel::new()), Ok(None));
        // 134 596 possible sets of six, each of 240 half arrangements; and more bits than a mask has.
        assert_eq!(of([4, 6, 1], &[24]).partitioned(&none, &Cancel::new()), Ok(None));
        assert_eq!(of([2, 1, 1], &[33]).partitioned(&none, &Cancel::new()), Ok(None));
    }

    #[test]
    fn partitions_are_given_up_after_so_many_comparisons() {
        let kind = PartKind::new(vec![vec![1.0, 2.0, 4.0]], vec![vec![vec![1.0]]]).unwrap();
        let problem = Matching::new(Measure::Length, vec![-2.0], vec![kind], 3).unwrap();
        let cancel = Cancel::new();
        let least = |compared: usize| {
            let (best, values) = (HashMap::new(), HashMap::new());
            let mut search =
                Partitions { problem: &problem, cancel: &cancel, best, values, compared };
            search.least([0b111, 0], 3)
        };
        // One part for each of three sets: three comparisons.
        assert_eq!(least(MOST_SETS - 3), Ok(Some(1.0 + 0.0 + 2.0)));
        assert_eq!([least(MOST_SETS - 2), least(MOST_SETS)], [Ok(None), Ok(None)]);
    }
}
