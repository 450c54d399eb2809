//! Sets of parts whose masses, or sums of two kinds of them, are most alike.

use super::{PartKind, Partition};

/// Sets of parts.
pub(crate) enum SpreadSets {
    /// Those that are proved to have the least sum of spreads.
    Least(Partition),
    /// Sequences of all parts of each kind, of which the first has its sets in front.
    Starts(Vec<Partition>),
}

/// Sets of parts of one or two kinds, by the first figure of each.
///
/// Sorted against each other, both kinds of one set without spare ones have the least largest and the largest
/// least sum: exchanging any two of another order makes the larger sum larger or none smaller.
pub(crate) fn sets(kinds: &[PartKind], size: usize, sets: usize) -> SpreadSets {
    let masses = &kinds[0].deviations[0];
    let of_first = windows(masses, size, sets);
    let Some(ends) = kinds.get(1).map(|kind| &kind.deviations[0]) else {
        return SpreadSets::Least(vec![of_first.concat()]);
    };
    let rising = sorted(masses.len(), |k| masses[k]);
    let falling = sorted(ends.len(), |k| -ends[k]);
    if masses.len() == size && ends.len() == size {
        return SpreadSets::Least(vec![rising, falling]);
    }
    // The lightest of the first kind with the heaviest of the second.
    let mut of_second = windows(ends, size, sets);
    of_second.reverse();
    for set in &mut of_second {
        set.reverse();
    }
    let mut starts =
        vec![vec![sequence(&of_first, masses.len()), sequence(&of_second, ends.len())]];
    if masses.len() == ends.len() {
        // Or pairs of these that are alike.
        let sums: Vec<f64> =
            rising.iter().zip(&falling).map(|(&a, &b)| masses[a] + ends[b]).collect();
        let pairs = windows(&sums, size, sets);
        let of = |list: &[usize]| {
            let sets = pairs.iter().map(|set| set.iter().map(|&k| list[k]).collect());
            sequence(&sets.collect::<Vec<Vec<usize>>>(), list.len())
        };
        starts.push(vec![of(&rising), of(&falling)]);
    }
    SpreadSets::Starts(starts)
}

/// Numbers below a count in the order of their values.
pub(super) fn sorted(count: usize, value: impl Fn(usize) -> f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| value(a).total_cmp(&value(b)));
    order
}

/// The parts of all sets, then those that are left.
fn sequence(sets: &[Vec<usize>], parts: usize) -> Vec<usize> {
    let mut all = sets.concat();
    let mut is_used = vec![false; parts];
    for &part in &all {
        is_used[part] = true;
    }
    all.extend((0..parts).filter(|&part| !is_used[part]));
    all
}

/// Sets of equally many parts whose ranges have the least sum; the rest stays unused.
///
/// Exact. Of sorted parts that are all used, a gap between neighbours with m parts below it, m no multiple of
/// the size, is straddled by at least one set, because no sets consist of m parts; sorted sets straddle each
/// of these gaps once and no other. The sum of ranges is the sum of the gaps straddled. An unused part within
/// the range of a set may replace one of its ends without widening it. So the sets are windows of neighbours,
/// and dynamic programming finds the best.
///
/// Where all parts are used, sorted sets have the least largest range too: the first (t − 1)·size + 1 parts
/// lie in at least t sets, which reach the (t·size)-th part; so that one of them has at least the range of
/// the t-th sorted set.
fn windows(masses: &[f64], size: usize, sets: usize) -> Vec<Vec<usize>> {
    let order = sorted(masses.len(), |k| masses[k]);
    // least[m]: least sum of some sets of the first m parts.
    let mut least = vec![0.0; masses.len() + 1];
    // Whether the last of the first m parts is used, by set.
    let mut is_taken = vec![vec![false; masses.len() + 1]; sets];
    for taken in &mut is_taken {
        let before = std::mem::replace(&mut least, vec![f64::INFINITY; masses.len() + 1]);
        for m in size..=masses.len() {
            let with_last = before[m - size] + (masses[order[m - 1]] - masses[order[m - size]]);
            taken[m] = with_last < least[m - 1];
            least[m] = with_last.min(least[m - 1]);
        }
    }
    let mut m = masses.len();
    let mut windows: Vec<Vec<usize>> = Vec::new();
    for taken in is_taken.iter().rev() {
        while !taken[m] {
            m -= 1;
        }
        windows.push(order[m - size..m].to_vec());
        m -= size;
    }
    windows.reverse();
    windows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::draws;

    /// The least sum of the ranges of sets with parts of a list, by brute force.
    fn least(parts: &[f64], size: usize, sets: usize) -> f64 {
        if sets == 0 {
            return 0.0;
        }
        let mut best = f64::INFINITY;
        for mask in (0..1usize << parts.len()).filter(|mask| mask.count_ones() as usize == size) {
            let is_in = |k: usize| mask >> k & 1 == 1;
            let of = |wanted: bool| -> Vec<f64> {
                (0..parts.len()).filter(|&k| is_in(k) == wanted).map(|k| parts[k]).collect()
            };
            best = best.min(range(&of(true)) + least(&of(false), size, sets - 1));
        }
        best
    }

    fn range(of: &[f64]) -> f64 {
        of.iter().fold(f64::NEG_INFINITY, |most, x| most.max(*x))
            - of.iter().fold(f64::INFINITY, |few, x| few.min(*x))
    }

    #[test]
    fn sets_have_the_least_sum_of_ranges() {
        let mut number = draws(11);
        for case in 0..200 {
            let (size, sets, count) = (2 + case % 2, 1 + case % 3 / 2, 6 + case % 2);
            // Every other time of few values, so that parts are equal.
            let mass = |x: f64| if case % 4 < 2 { x } else { (3.0 * x).floor() };
            let masses: Vec<f64> = (0..count).map(|_| mass(number())).collect();
            let chosen = windows(&masses, size, sets);
            assert!(chosen.len() == sets && chosen.iter().all(|set| set.len() == size));
            let ranges = chosen
                .iter()
                .map(|set| range(&set.iter().map(|&k| masses[k]).collect::<Vec<f64>>()));
            let found: f64 = ranges.sum();
            // Two sums of figures below 3.
            assert!((found - least(&masses, size, sets)).abs() < 1e-14, "{masses:?}");
            let all = sequence(&chosen, count);
            assert_eq!(sorted(count, |k| all[k] as f64).len(), count);
        }
    }
}
