//! The most parts of several sums that can be left out, each sum losing no more than it may.
//!
//! Leaving out the smallest first is best for one sum. Orders are shared by force, moment and torque
//! of perhaps several engines, and what is small in one may be large in another: then it is a
//! knapsack of several dimensions, solved by branch and bound.

/// Sizes looked at before the best set found so far is taken: some ten milliseconds, and three times
/// what any preset takes at any rod ratio up to 0.99.
const MOST_WORK: usize = 1 << 20;

/// Parts whose sizes, each over what its sum may lose, add up to 1 at most in every sum, on top of
/// what is `lost` already: as many as there can be, by index, ascending.
///
/// `sizes[part][sum]`; the answer is the most unless more than [`MOST_WORK`] sizes were looked at.
pub(crate) fn most_left_out(sizes: &[Vec<f64>], lost: &[f64]) -> Vec<usize> {
    let largest = |part: usize| sizes[part].iter().copied().fold(0.0, f64::max);
    let mut open: Vec<usize> = (0..sizes.len()).collect();
    open.sort_by(|&a, &b| largest(a).total_cmp(&largest(b)));
    let root = Node { out: Vec::new(), lost: lost.to_vec(), open }.pruned(sizes);
    let mut best = root.greedy(sizes);
    let (mut nodes, mut work) = (vec![root], 0);
    while let Some(node) = nodes.pop() {
        work += node.open.len() * lost.len();
        if work > MOST_WORK {
            break;
        }
        if node.most(sizes) <= best.len() {
            continue;
        }
        let Some((&next, rest)) = node.open.split_first() else {
            continue;
        };
        // Where a part is kept, any that is as large in every sum may be kept as well: if one of
        // those were left out, the first could be in its place.
        let as_large = |part: usize| sizes[part].iter().zip(&sizes[next]).all(|(a, b)| a >= b);
        let smaller = rest.iter().copied().filter(|&part| !as_large(part)).collect();
        let with = node.leaving_out(next, rest, sizes);
        if with.out.len() > best.len() {
            best.clone_from(&with.out);
        }
        nodes.push(Node { open: smaller, ..node });
        nodes.push(with);
    }
    best.sort_unstable();
    best
}

/// Some parts decided.
struct Node {
    /// Left out.
    out: Vec<usize>,
    /// What each sum has lost.
    lost: Vec<f64>,
    /// Parts not decided, the least important first.
    open: Vec<usize>,
}

impl Node {
    fn fits(&self, size: &[f64]) -> bool {
        self.lost.iter().zip(size).all(|(lost, size)| lost + size <= 1.0)
    }

    fn lose(&mut self, size: &[f64]) {
        self.lost.iter_mut().zip(size).for_each(|(lost, size)| *lost += size);
    }

    /// Without parts that no longer fit.
    fn pruned(mut self, sizes: &[Vec<f64>]) -> Self {
        let mut open = std::mem::take(&mut self.open);
        open.retain(|&part| self.fits(&sizes[part]));
        Self { open, ..self }
    }

    fn leaving_out(&self, part: usize, rest: &[usize], sizes: &[Vec<f64>]) -> Self {
        let mut node = Self { out: self.out.clone(), lost: self.lost.clone(), open: rest.to_vec() };
        node.out.push(part);
        node.lose(&sizes[part]);
        node.pruned(sizes)
    }

    /// Every part that fits, one after the other.
    fn greedy(&self, sizes: &[Vec<f64>]) -> Vec<usize> {
        let mut node = Self { out: self.out.clone(), lost: self.lost.clone(), open: Vec::new() };
        for &part in &self.open {
            if node.fits(&sizes[part]) {
                node.out.push(part);
                node.lose(&sizes[part]);
            }
        }
        node.out
    }

    /// No set that contains these is larger: as many as the tightest of the sums could lose if it
    /// were alone.
    fn most(&self, sizes: &[Vec<f64>]) -> usize {
        let alone = |sum: usize| {
            let mut parts: Vec<f64> = self.open.iter().map(|&part| sizes[part][sum]).collect();
            parts.sort_unstable_by(f64::total_cmp);
            // Any order of adding may round; one more part is not ruled out by that.
            let mut lost = self.lost[sum];
            let fit = |size: &&f64| {
                lost += **size;
                lost <= 1.0 + 1e-12
            };
            parts.iter().take_while(fit).count()
        };
        self.out.len() + (0..self.lost.len()).map(alone).min().unwrap_or(self.open.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fit(sizes: &[Vec<f64>], lost: &[f64], set: u32) -> bool {
        (0..lost.len()).all(|sum| {
            let parts = (0..sizes.len()).filter(|part| set >> part & 1 == 1);
            lost[sum] + parts.map(|part| sizes[part][sum]).sum::<f64>() <= 1.0
        })
    }

    fn brute(sizes: &[Vec<f64>], lost: &[f64]) -> u32 {
        let sets = (0..1_u32 << sizes.len()).filter(|&set| fit(sizes, lost, set));
        sets.map(u32::count_ones).max().unwrap_or(0)
    }

    /// Sizes in 64ths, so that sums are exact in whatever order they are added.
    fn parts() -> impl Strategy<Value = Vec<Vec<f64>>> {
        (1_usize..4).prop_flat_map(|sums| {
            let size = (0_u32..50).prop_map(|k| f64::from(k) / 64.0);
            proptest::collection::vec(proptest::collection::vec(size, sums), 0..13)
        })
    }

    proptest! {
        #[test]
        fn no_set_is_larger(sizes in parts(), tail in 0_u32..16) {
            let lost = vec![f64::from(tail) / 64.0; sizes.first().map_or(1, Vec::len)];
            let found = most_left_out(&sizes, &lost);
            let set = found.iter().fold(0, |set, part| set | 1 << part);
            prop_assert!(fit(&sizes, &lost, set));
            prop_assert_eq!(set.count_ones(), brute(&sizes, &lost));
        }
    }

    /// The most parts of three sums that may lose so much each, by dynamic programming.
    fn most_of_three(sizes: &[[usize; 3]], largest: usize) -> usize {
        let side = largest + 1;
        let place = |i: usize, j: usize, k: usize| (i * side + j) * side + k;
        let mut most = vec![0; side.pow(3)];
        for &[a, b, c] in sizes {
            for i in (a..side).rev() {
                for j in (b..side).rev() {
                    for k in (c..side).rev() {
                        let with = most[place(i - a, j - b, k - c)] + 1;
                        let best = &mut most[place(i, j, k)];
                        *best = with.max(*best);
                    }
                }
            }
        }
        most[place(largest, largest, largest)]
    }

    #[test]
    fn fifty_parts_are_solved_within_the_work_allowed() {
        // Of many such parts those that ask for most work: half of what is allowed, and more than all
        // of it where the search is cut in one way alone.
        let mut state = 12_u64;
        let mut size = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            1 + (state >> 33) as usize % 8
        };
        let parts: Vec<[usize; 3]> = (0..50).map(|_| std::array::from_fn(|_| size())).collect();
        let sizes: Vec<Vec<f64>> =
            parts.iter().map(|part| part.map(|size| size as f64 / 96.0).to_vec()).collect();
        assert_eq!(most_left_out(&sizes, &[0.0; 3]).len(), most_of_three(&parts, 96));
    }

    #[test]
    fn the_smallest_first_is_not_always_best() {
        // The first is small in both, the others large in one each; any two of the others fit.
        let sizes = [vec![0.5, 0.5], vec![0.7, 0.0], vec![0.0, 0.7]].to_vec();
        assert_eq!(most_left_out(&sizes, &[0.0, 0.0]), [1, 2]);
    }

    #[test]
    fn hard_cases_end() {
        // Subset sums: complements in the second sum, so that hardly any bound is tight.
        let sizes: Vec<Vec<f64>> = (0..3000_u32)
            .map(|k| {
                let a = f64::from(k.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24);
                vec![a / 700.0, (1.0 - a) / 700.0]
            })
            .collect();
        assert!(most_left_out(&sizes, &[0.0, 0.0]).len() > 1000);
    }
}
