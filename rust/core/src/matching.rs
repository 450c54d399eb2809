//! Matching of measured parts to places: which piston and which rod goes into which cylinder.
//!
//! A set of parts fills all places of one engine. With part p of each kind in place j the remainder of
//! an engine is `start + Σⱼ added(j, p)`; the sum of the lengths of the remainders over all sets is
//! minimised. Few parts are compared exhaustively: the arrangements of one half of the places against
//! those of the other, and all partitions into sets. Of many, two are exchanged as long as that helps.

use std::collections::HashMap;
use std::mem;
use std::ops::Range;

use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::{memory, pool};

/// Half arrangements of one exhaustive comparison; up to ten seconds on one core.
const MOST_ARRANGEMENTS: f64 = 1e7;
/// Comparisons of an exhaustive search for the best partition into sets; a second.
const MOST_SETS: usize = 10_000_000;
/// Exchanges that are tried before no further start is made; some two seconds.
const MOST_EXCHANGES: usize = 100_000_000;
/// Kinds of parts: pistons and rods.
const KINDS: usize = 2;
/// Parts of a kind that fit a bit mask.
const MOST_MASKED: usize = 28;
/// An exchange counts as better if it shortens the remainders by more than this part of them.
const BETTER: f64 = 1e-12;

/// Parts of one kind, such as pistons or rods, and their effects.
#[derive(Debug, Clone)]
pub struct PartKind {
    /// Number of parts.
    parts: usize,
    /// Deviations of each part, by figure: (figures, parts).
    deviations: Vec<Vec<f64>>,
    /// Effect of a unit of each figure in each place: (figures, places, dimensions).
    influences: Vec<Vec<Vec<f64>>>,
    /// Effect of each part in each place: (places, parts, dimensions).
    added: Vec<f64>,
}

/// A chosen part of each place of each set, by kind: set after set.
pub type Partition = Vec<Vec<usize>>;

/// Parts to match, and what they are matched to.
#[derive(Debug, Clone)]
pub struct Matching {
    start: Vec<f64>,
    kinds: Vec<PartKind>,
    places: usize,
    sets: usize,
}

/// A matching.
#[derive(Debug, Clone, PartialEq)]
pub struct Match {
    /// The part in each place.
    pub chosen: Partition,
    /// Sum of the lengths of the remainders.
    pub value: f64,
    /// A sum below which no matching comes.
    pub bound: f64,
    /// Whether all matchings were compared.
    pub exact: bool,
}

impl PartKind {
    /// Parts from their deviations (figures, parts) and the effects of a unit of each figure
    /// (figures, places, dimensions).
    pub fn new(deviations: Vec<Vec<f64>>, influences: Vec<Vec<Vec<f64>>>) -> Result<Self> {
        let parts = deviations.first().map_or(0, Vec::len);
        let (places, dimensions) = shape(&influences);
        let alike = deviations.iter().all(|of| of.len() == parts)
            && influences.iter().all(|of| shape(std::slice::from_ref(of)) == (places, dimensions))
            && influences.iter().flatten().all(|of| of.len() == dimensions);
        if parts == 0 || places == 0 || deviations.len() != influences.len() || !alike {
            let found = format!("{} figures of {parts} parts", deviations.len());
            let hint =
                "give each figure a deviation of every part, and its influence in every place";
            return Err(Error::value("parts", found, hint));
        }
        let mut added = memory::room(places * parts * dimensions)?;
        for place in 0..places {
            for part in 0..parts {
                added.extend((0..dimensions).map(|k| {
                    let figures = deviations.iter().zip(&influences);
                    figures.map(|(of, unit)| of[part] * unit[place][k]).sum::<f64>()
                }));
            }
        }
        Ok(Self { parts, deviations, influences, added })
    }
}

/// Places and dimensions of influences.
fn shape(influences: &[Vec<Vec<f64>>]) -> (usize, usize) {
    let places = influences.first().map_or(&[][..], Vec::as_slice);
    (places.len(), places.first().map_or(0, Vec::len))
}

fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn add(to: &mut [f64], sign: f64, vector: &[f64]) {
    to.iter_mut().zip(vector).for_each(|(sum, x)| *sum += sign * x);
}

impl Matching {
    /// So many sets of parts of each kind.
    pub fn new(start: Vec<f64>, kinds: Vec<PartKind>, sets: usize) -> Result<Self> {
        let places = kinds.first().map_or(0, |kind| shape(&kind.influences).0);
        let fits = |kind: &PartKind| {
            let enough = sets.checked_mul(places).is_some_and(|used| used <= kind.parts);
            shape(&kind.influences) == (places, start.len()) && enough
        };
        if sets == 0 || kinds.is_empty() || kinds.len() > KINDS || !kinds.iter().all(fits) {
            let found = format!("{} kinds for {sets} sets of {places}", kinds.len());
            let hint = "give one or two kinds, with parts for every place of all sets";
            return Err(Error::value("parts", found, hint));
        }
        Ok(Self { start, kinds, places, sets })
    }

    /// Whether these are sequences of all parts, one for each kind.
    fn has(&self, sequences: &[Vec<usize>]) -> bool {
        let each = sequences.iter().zip(&self.kinds);
        sequences.len() == self.kinds.len()
            && each.into_iter().all(|(sequence, kind)| {
                let mut parts = sequence.clone();
                parts.sort_unstable();
                parts.into_iter().eq(0..kind.parts)
            })
    }

    /// The best matching that is found: of all, or by exchanges from the given sequences of parts,
    /// one for each start and kind, with the number of steps as the progress.
    pub fn solve(&self, starts: &[Vec<Vec<usize>>], cancel: &Cancel) -> Result<Match> {
        if starts.is_empty() || !starts.iter().all(|sequences| self.has(sequences)) {
            let hint = "give at least one, with every part of each kind once";
            return Err(Error::value("starts", format!("{} sequences", starts.len()), hint));
        }
        cancel.expect(starts.len());
        let mut best = (f64::INFINITY, Partition::new());
        let mut compared = 0;
        for sequences in starts {
            if compared < MOST_EXCHANGES {
                let chosen = self.exchanged(sequences.clone(), &mut compared, cancel)?;
                let value = self.value(&chosen);
                if value < best.0 {
                    best = (value, chosen);
                }
            }
            cancel.step()?;
        }
        let found = if self.sets == 1 {
            self.of_all(&best, cancel)?
        } else {
            self.partitioned(&best, cancel)?
        };
        let exact = found.is_some();
        let chosen = found.unwrap_or(best.1);
        let value = self.value(&chosen);
        let bound = if exact { value } else { self.bound().min(value) };
        Ok(Match { chosen, value, bound, exact })
    }

    fn added(&self, kind: usize, place: usize, part: usize) -> &[f64] {
        let (kind, dimensions) = (&self.kinds[kind], self.start.len());
        let begin = (place * kind.parts + part) * dimensions;
        &kind.added[begin..begin + dimensions]
    }

    /// Remainder of each set.
    fn remainders(&self, chosen: &[Vec<usize>]) -> Vec<Vec<f64>> {
        let mut found = vec![self.start.clone(); self.sets];
        for (kind, parts) in chosen.iter().enumerate() {
            for (slot, &part) in parts.iter().take(self.sets * self.places).enumerate() {
                let place = slot % self.places;
                add(&mut found[slot / self.places], 1.0, self.added(kind, place, part));
            }
        }
        found
    }

    /// Sum of the lengths of the remainders.
    #[must_use]
    pub fn value(&self, chosen: &[Vec<usize>]) -> f64 {
        self.remainders(chosen).iter().map(|each| length(each)).sum()
    }

    /// A sum of lengths below which no matching comes.
    ///
    /// The lengths add up to at least the length of the sum of the remainders. Along each dimension
    /// that lies between two numbers: of each figure by itself the largest influences take the
    /// smallest or the largest deviations (rearrangement inequality).
    #[must_use]
    pub fn bound(&self) -> f64 {
        let beyond = (0..self.start.len()).map(|k| {
            let mut low = self.sets as f64 * self.start[k];
            let mut high = low;
            for kind in &self.kinds {
                for (deviations, influences) in kind.deviations.iter().zip(&kind.influences) {
                    let mut rising = deviations.clone();
                    rising.sort_by(f64::total_cmp);
                    let mut falling: Vec<f64> = influences
                        .iter()
                        .flat_map(|place| std::iter::repeat_n(place[k], self.sets))
                        .collect();
                    // Parts that are not used have no influence.
                    falling.resize(rising.len(), 0.0);
                    falling.sort_by(|a, b| b.total_cmp(a));
                    for (influence, (few, many)) in
                        falling.iter().zip(rising.iter().zip(rising.iter().rev()))
                    {
                        low += influence * few;
                        high += influence * many;
                    }
                }
            }
            low.max(-high).max(0.0)
        });
        length(&beyond.collect::<Vec<f64>>())
    }

    // --- exchanges ------------------------------------------------------------------------------

    /// Exchange two parts of a kind, within a set, between sets or with an unused one, while that is
    /// better; the parts that are used.
    fn exchanged(
        &self,
        mut sequences: Vec<Vec<usize>>,
        compared: &mut usize,
        cancel: &Cancel,
    ) -> Result<Partition> {
        let used = self.sets * self.places;
        let mut trials = [Vec::new(), Vec::new()];
        loop {
            let mut better = false;
            // Anew in each round: rounding of sums that are updated grows.
            let mut remainders = self.remainders(&sequences);
            for (kind, parts) in sequences.iter_mut().enumerate() {
                for i in 0..used {
                    cancel.check()?;
                    for j in i + 1..parts.len() {
                        let (slots, moved) = ([i, j], [parts[i], parts[j]]);
                        let sets = slots.map(|slot| slot / self.places);
                        let changed = if j < used && sets[0] != sets[1] { 2 } else { 1 };
                        let mut before = 0.0;
                        for (trial, &set) in trials.iter_mut().zip(&sets[..changed]) {
                            trial.clone_from(&remainders[set]);
                            before += length(trial);
                        }
                        for k in (0..2).filter(|&k| slots[k] < used) {
                            let (trial, place) =
                                (&mut trials[k.min(changed - 1)], slots[k] % self.places);
                            add(trial, -1.0, self.added(kind, place, moved[k]));
                            add(trial, 1.0, self.added(kind, place, moved[1 - k]));
                        }
                        let after: f64 = trials[..changed].iter().map(|each| length(each)).sum();
                        if after < before * (1.0 - BETTER) {
                            parts.swap(i, j);
                            for (trial, set) in trials.iter_mut().zip(sets).take(changed) {
                                mem::swap(&mut remainders[set], trial);
                            }
                            better = true;
                        }
                    }
                    *compared += parts.len() - i - 1;
                }
            }
            if !better {
                for parts in &mut sequences {
                    parts.truncate(used);
                }
                return Ok(sequences);
            }
        }
    }

    // --- all arrangements of one set ------------------------------------------------------------

    /// Number of arrangements of halves of the places that [`Matching::arranged`] visits where so many
    /// parts of each kind are available.
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
    fn of_all(&self, known: &(f64, Partition), cancel: &Cancel) -> Result<Option<Partition>> {
        let available: Vec<usize> = self.kinds.iter().map(|kind| kind.parts).collect();
        if self.half_arrangements(&available) > MOST_ARRANGEMENTS {
            return Ok(None);
        }
        let available: Vec<Vec<usize>> =
            available.iter().map(|&parts| (0..parts).collect()).collect();
        let halves = choices(&available, self.places / 2);
        cancel.expect(halves.len());
        let found = pool::map(cancel, halves, |ours| {
            let best = self.completed(&available, &ours, known.0, cancel)?;
            cancel.step()?;
            Ok(best)
        })?;
        let best = found.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0));
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
    /// remainder, if that is less than `known`.
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
            if let Some((value, a, b)) = first.closest(&second, least, cancel)? {
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
            sums: memory::room(count * start.len())?,
            parts: memory::room(count * parts.len() * places.len())?,
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
                add(&mut sum, 1.0, self.added(kind, place, part));
                chosen.push(part);
                self.fill(to, places, parts, chosen, sum);
                chosen.pop();
            }
        }
    }

    // --- all partitions into sets ---------------------------------------------------------------

    /// The best partition of the parts into sets, or the one that is known; None where there are too
    /// many to compare.
    fn partitioned(&self, known: &(f64, Partition), cancel: &Cancel) -> Result<Option<Partition>> {
        let sizes = self.kinds.iter().map(|kind| number_of_choices(kind.parts, self.places));
        let one = vec![self.places; self.kinds.len()];
        if self.kinds.iter().any(|kind| kind.parts > MOST_MASKED)
            || sizes.product::<f64>() * self.half_arrangements(&one) > MOST_ARRANGEMENTS
        {
            return Ok(None);
        }
        let mut unused = [0; KINDS];
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
        if least >= known.0 {
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
        let kinds = self.kinds.iter().zip(masks);
        kinds
            .map(|(kind, mask)| (0..kind.parts).filter(|part| mask >> part & 1 == 1).collect())
            .collect()
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
    fn len(&self) -> usize {
        self.sums.len().checked_div(self.dimensions).unwrap_or(1)
    }

    fn sum(&self, k: usize) -> &[f64] {
        &self.sums[k * self.dimensions..(k + 1) * self.dimensions]
    }

    fn parts(&self, k: usize, kind: usize) -> &[usize] {
        &self.parts[(k * self.kinds + kind) * self.places..][..self.places]
    }

    /// The pair with the shortest sum, if it is shorter than `known`: its length, and the two.
    fn closest(
        &self,
        other: &Self,
        known: f64,
        cancel: &Cancel,
    ) -> Result<Option<(f64, usize, usize)>> {
        if self.dimensions == 0 {
            return Ok((known > 0.0).then_some((0.0, 0, 0)));
        }
        // Least square of the components but the first.
        let rest: f64 = (1..self.dimensions)
            .map(|k| {
                let ([low, high], [from, to]) = (self.range(k), other.range(k));
                (low + from).max(-high - to).max(0.0).powi(2)
            })
            .sum();
        let mut square = known * known;
        let mut found = None;
        let mut sorted: Vec<usize> = (0..other.len()).collect();
        sorted.sort_by(|&i, &j| other.sum(i)[0].total_cmp(&other.sum(j)[0]));
        for i in 0..self.len() {
            if i % 256 == 0 {
                cancel.check()?;
            }
            if square <= rest {
                break;
            }
            let ours = self.sum(i);
            let reach = (square - rest).sqrt();
            let begin = sorted.partition_point(|&j| other.sum(j)[0] < -ours[0] - reach);
            for &j in &sorted[begin..] {
                let theirs = other.sum(j);
                if ours[0] + theirs[0] > reach {
                    break;
                }
                let sum: f64 = ours.iter().zip(theirs).map(|(a, b)| (a + b).powi(2)).sum();
                if sum < square {
                    square = sum;
                    found = Some((sum.sqrt(), i, j));
                }
            }
        }
        Ok(found)
    }

    fn range(&self, component: usize) -> [f64; 2] {
        let of_all = (0..self.len()).map(|k| self.sum(k)[component]);
        of_all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }
}

/// Parts of each kind as bits.
type Masks = [u32; KINDS];

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
    /// Least sum of so many sets of the parts that are left; None after too many comparisons.
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
        for first in subsets(left[0] & !lowest, places - 1) {
            for other in subsets(left[1], if self.problem.kinds.len() > 1 { places } else { 0 }) {
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
                if value + of_rest < best.0 {
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

/// All subsets of so many bits.
fn subsets(bits: u32, count: usize) -> impl Iterator<Item = u32> {
    let places: Vec<u32> = (0..u32::BITS).filter(|place| bits >> place & 1 == 1).collect();
    let end = 1u64 << places.len();
    // The next larger number with as many ones (Gosper).
    let next = |&of: &u64| {
        let (lowest, above) = (of & of.wrapping_neg(), of + (of & of.wrapping_neg()));
        (of > 0).then(|| above | ((of ^ above) / lowest) >> 2)
    };
    std::iter::successors(Some((1u64 << count) - 1), next).take_while(move |&of| of < end).map(
        move |of| {
            places
                .iter()
                .enumerate()
                .filter(|(k, _)| of >> k & 1 == 1)
                .fold(0, |m, (_, p)| m | 1 << p)
        },
    )
}

fn number_of_choices(of: usize, count: usize) -> f64 {
    (0..count).map(|k| (of - k) as f64 / (k + 1) as f64).product()
}

/// All choices of so many parts of every kind.
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
    use super::*;

    /// Numbers between -1 and 1 that repeat after 2^31 (a linear congruential generator).
    fn numbers(mut seed: u64) -> impl FnMut() -> f64 {
        move || {
            seed = (seed * 1_103_515_245 + 12_345) % (1 << 31);
            seed as f64 / f64::from(1 << 30) - 1.0
        }
    }

    fn sequences(parts: usize) -> Vec<Vec<usize>> {
        let Some(last) = parts.checked_sub(1) else { return vec![Vec::new()] };
        let shorter = sequences(last).into_iter();
        let inserted = |each: Vec<usize>| {
            (0..=each.len()).map(move |k| [&each[..k], &[last], &each[k..]].concat())
        };
        shorter.flat_map(inserted).collect()
    }

    #[test]
    fn the_best_of_all_matchings_is_found_and_none_is_below_the_bound() {
        let mut number = numbers(7);
        for (sets, places, parts, dimensions) in [
            (1, 3, &[4][..], 2),
            (1, 1, &[3], 1),
            (1, 2, &[3, 2], 2),
            (2, 2, &[5], 2),
            (2, 2, &[4, 5], 1),
            (3, 2, &[7], 3),
            (2, 1, &[2, 2], 2),
            (2, 3, &[6], 0),
        ] {
            for distance in [0.0, 0.5, 20.0] {
                let mut some =
                    |count: usize| -> Vec<f64> { (0..count).map(|_| number()).collect() };
                let kinds: Vec<PartKind> = parts
                    .iter()
                    .enumerate()
                    .map(|(figures, &parts)| {
                        let deviations = (0..=figures).map(|_| some(parts)).collect();
                        let places = |_| (0..places).map(|_| some(dimensions)).collect();
                        PartKind::new(deviations, (0..=figures).map(places).collect()).unwrap()
                    })
                    .collect();
                let start = some(dimensions).iter().map(|x| x * distance).collect();
                let problem = Matching::new(start, kinds, sets).unwrap();
                let all: Vec<Vec<Vec<usize>>> =
                    parts.iter().map(|&parts| sequences(parts)).collect();
                let both: Vec<Partition> = match &all[..] {
                    [one] => one.iter().map(|each| vec![each.clone()]).collect(),
                    [one, other] => one
                        .iter()
                        .flat_map(|a| other.iter().map(|b| vec![a.clone(), b.clone()]))
                        .collect(),
                    _ => unreachable!("one or two kinds"),
                };
                let least =
                    both.iter().map(|each| problem.value(each)).fold(f64::INFINITY, f64::min);
                let rounding = 1e-12 * (1.0 + distance);
                let found = problem.solve(&both[..1], &Cancel::new()).unwrap();
                assert!(found.exact && found.bound <= found.value);
                assert!((found.value - least).abs() <= rounding, "{found:?} for {least}");
                assert!(problem.bound() <= least + rounding);
                let exchanged = problem.exchanged(both[0].clone(), &mut 0, &Cancel::new()).unwrap();
                assert!(problem.value(&exchanged) >= least - rounding);
                assert!(problem.value(&exchanged) <= problem.value(&both[0]) + rounding);
            }
        }
    }

    #[test]
    fn many_parts_are_exchanged_and_a_cancelled_search_stops() {
        let mut number = numbers(3);
        let deviations = vec![(0..40).map(|_| number()).collect()];
        let influences = vec![(0..6).map(|_| vec![number(), number()]).collect()];
        let kind = PartKind::new(deviations, influences).unwrap();
        let problem = Matching::new(vec![0.0; 2], vec![kind], 6).unwrap();
        let start = vec![vec![(0..40).collect::<Vec<usize>>()]];
        let found = problem.solve(&start, &Cancel::new()).unwrap();
        assert!(!found.exact && found.value < 0.1 * problem.value(&start[0]));
        let cancel = Cancel::new();
        cancel.raise();
        assert_eq!(problem.solve(&start, &cancel), Err(crate::Error::Cancelled));
    }

    #[test]
    fn lists_of_wrong_lengths_are_errors() {
        let kind = |parts: usize| PartKind::new(vec![vec![1.0; parts]], vec![vec![vec![1.0]; 2]]);
        let error = |found: Result<PartKind>| found.unwrap_err().to_string();
        assert!(error(PartKind::new(vec![], vec![])).starts_with("parts = 0 figures"));
        assert!(error(kind(0)).starts_with("parts = 1 figures of 0 parts"));
        let uneven = vec![vec![vec![1.0], vec![1.0, 2.0]]];
        assert!(error(PartKind::new(vec![vec![1.0]], uneven)).starts_with("parts"));
        let many = |start: usize, kinds: Vec<PartKind>, sets: usize| {
            Matching::new(vec![0.0; start], kinds, sets)
        };
        let two = || kind(2).unwrap();
        for (start, kinds, sets) in [
            (1, vec![], 1),
            (1, vec![two()], 0),
            (1, vec![two()], 2),
            (2, vec![two()], 1),
            (1, vec![two(), two(), two()], 1),
        ] {
            let error = many(start, kinds, sets).unwrap_err().to_string();
            assert!(error.contains("give one or two kinds"), "{error}");
        }
        let one = many(1, vec![two()], 1).unwrap();
        for starts in [vec![], vec![vec![]], vec![vec![vec![0]]], vec![vec![vec![0, 2]]]] {
            assert!(one.solve(&starts, &Cancel::new()).is_err());
        }
        assert!(one.solve(&[vec![vec![1, 0]]], &Cancel::new()).is_ok());
    }
}
