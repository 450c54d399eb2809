//! All arrangements of a bank up to turning the crank and to their images, by the exact key of |Z|².
//!
//! Throws are placed in pairs from the ends inward, so that images can be compared, and cut, as far
//! as the throws stand.

use std::cmp::Ordering;

use super::images::{Image, Images, Packed};
use super::magnitude::Magnitude;
use super::ranges::{self, Ranges};
use super::throws::{Bank, MOST_THROWS, Pool};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::{memory, pool};

/// Most memory that what is listed of a search may take, bytes.
pub const LARGEST_SEARCH: u128 = 8 << 30;

/// Pairs of throws in the largest bank.
const MOST_PAIRS: usize = MOST_THROWS / 2;
/// Tasks that share the walk, at least, where it is long.
const TASKS: usize = 32;
/// Pairs of throws below which cancellation is not checked.
const UNINTERRUPTED: usize = 3;

/// An arrangement and the number of its images, by the key of its |Z|².
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct KeyedArrangement {
    pub key: u64,
    pub packed: Packed,
}

impl KeyedArrangement {
    pub(super) fn image_count(self) -> u64 {
        self.packed & 15
    }
}

/// The first of each set of images, sorted within ranges of keys.
#[derive(Debug)]
pub(super) struct Entries {
    pub all: Vec<KeyedArrangement>,
    /// Where each range starts, and the end.
    starts: Vec<usize>,
}

impl Entries {
    pub(super) fn new(
        bank: &Bank,
        magnitude: &Magnitude,
        images: &Images,
        cancel: &Cancel,
    ) -> Result<Self> {
        let arrangements = bank.count() / u128::from(bank.turns * images.count());
        let ranges = ranges::count(arrangements);
        let walk = Walk::new(bank, magnitude, images);
        let tasks = walk.tasks(if ranges > 1 { TASKS } else { 1 }, bank)?;
        cancel.expect(tasks.len() + ranges);
        let gathered = pool::map(cancel, tasks, |task| {
            cancel.step()?;
            let mut entries = Ranges::new(ranges);
            walk.descend(&task, cancel, &mut |entry| {
                // Keys are spread evenly, and equal ones are in one range.
                let range = (u128::from(entry.key) * ranges as u128) >> 64;
                entries.push(range as usize, entry)
            })?;
            Ok(entries)
        })?;
        let (all, starts) = Ranges::sorted(gathered, cancel)?;
        Ok(Self { all, starts })
    }

    /// Ranges of entries that share no class.
    pub(super) fn ranges(&self) -> Vec<(usize, &[KeyedArrangement])> {
        self.starts.windows(2).map(|ends| (ends[0], &self.all[ends[0]..ends[1]])).collect()
    }
}

/// Refuse what takes more memory than a search may.
pub(super) fn refuse_too_large(argument: &str, bytes: u128, hint: &'static str) -> Result<()> {
    if bytes <= LARGEST_SEARCH {
        return Ok(());
    }
    Err(Error::TooLarge { argument: argument.into(), bytes, limit: LARGEST_SEARCH, hint })
}

/// Arrangements of equal |Z|.
pub(super) fn classes(range: &[KeyedArrangement]) -> impl Iterator<Item = &[KeyedArrangement]> {
    range.chunk_by(|a, b| a.key == b.key)
}

/// Throws placed so far, in pairs from the ends inward.
#[derive(Clone)]
struct Node {
    pool: Pool,
    /// Pairs of throws that stand.
    pairs: usize,
    key: u64,
    packed: Packed,
    /// What a throw of weight 1 with each phase would add to the key by those that stand.
    field: [u64; 16],
    /// Images (by their bits) equal to the arrangement as far as it stands.
    tied: u32,
    /// Index of the front and the last throw.
    ends: [usize; 2],
}

struct Walk<'a> {
    images: &'a Images,
    throws: usize,
    weights: [u64; MOST_PAIRS],
    /// What two throws add to the key, by weight of the one, for weight 1 of the other.
    fields: Box<[[[u64; 16]; 16]; MOST_PAIRS]>,
    /// What a pair of throws of weights w and −w adds by itself.
    alone: Box<[[[u64; 16]; 16]; MOST_PAIRS]>,
}

impl<'a> Walk<'a> {
    fn new(bank: &Bank, magnitude: &Magnitude, images: &'a Images) -> Self {
        let mut walk = Self {
            images,
            throws: bank.throws(),
            weights: [0; MOST_PAIRS],
            fields: Box::new([[[0; 16]; 16]; MOST_PAIRS]),
            alone: Box::new([[[0; 16]; 16]; MOST_PAIRS]),
        };
        for (k, &weight) in bank.weights()[..bank.throws() / 2].iter().enumerate() {
            let w = weight as u64;
            walk.weights[k] = w;
            for (p, &phase) in images.distinct.iter().enumerate() {
                for (q, &other) in images.distinct.iter().enumerate() {
                    let field = magnitude.pair(phase, other).wrapping_mul(w);
                    walk.fields[k][p][q] = field;
                    let alone = magnitude.alone(weight).wrapping_mul(2);
                    walk.alone[k][p][q] = alone.wrapping_sub(field.wrapping_mul(w));
                }
            }
        }
        walk
    }

    /// Nodes from which the whole walk goes on, at least `least` unless it ends there.
    fn tasks(&self, least: usize, bank: &Bank) -> Result<Vec<Node>> {
        let others = self.images.all().skip(1);
        let root = |pool| Node {
            pool,
            pairs: 0,
            key: 0,
            packed: 0,
            field: [0; 16],
            tied: others.clone().map(|image| 1 << image.bits()).sum(),
            ends: [0; 2],
        };
        let mut nodes: Vec<Node> = bank.pools().into_iter().map(root).collect();
        while nodes.len() < least && nodes.iter().any(|node| self.pairs_left(node) > 1) {
            let mut next = Vec::new();
            for node in &nodes {
                self.pairs(node, |pair| memory::push(&mut next, self.child(node, &pair)))?;
            }
            nodes = next;
        }
        Ok(nodes)
    }

    fn pairs_left(&self, node: &Node) -> usize {
        self.throws / 2 - node.pairs
    }

    /// All arrangements that start as the node does, the first of each set of images.
    fn descend(
        &self,
        node: &Node,
        cancel: &Cancel,
        found: &mut impl FnMut(KeyedArrangement) -> Result<()>,
    ) -> Result<()> {
        let left = self.pairs_left(node);
        if left == 1 {
            return self.pairs(node, |pair| found(self.leaf(node, &pair)));
        }
        if left > UNINTERRUPTED {
            cancel.check()?;
        }
        self.pairs(node, |pair| self.descend(&self.child(node, &pair), cancel, found))
    }

    /// Every next pair of throws that no image comes before. Images have the front throw turned back
    /// to a first phase: with another one there, an image comes before.
    #[inline]
    fn pairs(&self, node: &Node, mut found: impl FnMut(Pair) -> Result<()>) -> Result<()> {
        for front in node.pool.open(0) {
            let mut one = node.pool.clone();
            one.take(0, front);
            for rear in one.open(1) {
                if let Some(tied) = self.tied(node, front, rear) {
                    let mut pool = one.clone();
                    pool.take(1, rear);
                    found(Pair { front, rear, tied, pool })?;
                }
            }
        }
        Ok(())
    }

    /// Images that are still equal, if none comes before the arrangement.
    #[inline]
    fn tied(&self, node: &Node, front: usize, rear: usize) -> Option<u32> {
        let mut tied = node.tied;
        if tied == 0 {
            return Some(0);
        }
        let [first, last] = if node.pairs == 0 { [front, rear] } else { node.ends };
        for image in Image::OTHERS {
            if tied & 1 << image.bits() == 0 {
                continue;
            }
            let row = self.images.table(image, first, last);
            let (front, rear) = (front & 15, rear & 15);
            let seen = [usize::from(row[front]), usize::from(row[rear])];
            let seen = if image.reversed { [seen[1], seen[0]] } else { seen };
            match seen.cmp(&[front, rear]) {
                Ordering::Less => return None,
                Ordering::Equal => {}
                Ordering::Greater => tied ^= 1 << image.bits(),
            }
        }
        Some(tied)
    }

    /// The key with one more pair.
    #[inline]
    fn key(&self, node: &Node, pair: &Pair) -> u64 {
        let (front, rear) = (pair.front & 15, pair.rear & 15);
        let moved = node.field[front].wrapping_sub(node.field[rear]);
        node.key
            .wrapping_add(moved.wrapping_mul(self.weights[node.pairs]))
            .wrapping_add(self.alone[node.pairs][front][rear])
    }

    #[inline]
    fn packed(&self, node: &Node, pair: &Pair) -> Packed {
        let rear = self.throws - 1 - node.pairs;
        let place = |throw: usize, phase: usize| (phase as u64) << (4 * throw + 4);
        node.packed | place(node.pairs, pair.front) | place(rear, pair.rear)
    }

    fn child(&self, node: &Node, pair: &Pair) -> Node {
        let fields = &self.fields[node.pairs];
        let (ahead, behind) = (&fields[pair.front & 15], &fields[pair.rear & 15]);
        Node {
            pool: pair.pool.clone(),
            pairs: node.pairs + 1,
            key: self.key(node, pair),
            packed: self.packed(node, pair),
            field: std::array::from_fn(|phase| {
                node.field[phase].wrapping_add(ahead[phase]).wrapping_sub(behind[phase])
            }),
            tied: pair.tied,
            ends: if node.pairs == 0 { [pair.front, pair.rear] } else { node.ends },
        }
    }

    /// A central throw has no weight.
    #[inline]
    fn leaf(&self, node: &Node, pair: &Pair) -> KeyedArrangement {
        let mut packed = self.packed(node, pair);
        if self.throws % 2 == 1 {
            packed |= (pair.pool.centre() as u64) << (4 * (self.throws / 2) + 4);
        }
        let images = self.images.count() / (1 + pair.tied.count_ones());
        KeyedArrangement { key: self.key(node, pair), packed: packed | u64::from(images) }
    }
}

/// A front and a rear throw that may be placed next.
struct Pair {
    front: usize,
    rear: usize,
    /// Images still equal, and what is left, after it.
    tied: u32,
    pool: Pool,
}

#[cfg(test)]
mod tests {
    use crate::numbers::angle::Angle;

    use super::super::moments::Moments;
    use super::super::throws::tests::alternates;
    use super::*;

    #[test]
    fn images_and_turns_of_all_entries_are_all_arrangements() {
        let degrees = [0.0, 30.0, 30.0, 90.0, 120.0, 150.0, 240.0, 240.0].map(Angle::from_degrees);
        let phases: Vec<Angle> = degrees.into_iter().map(Result::unwrap).collect();
        let mut banks: Vec<Bank> =
            (2..=8).map(|n| Bank::with_phases(&phases[..n]).unwrap()).collect();
        for throws in 2..=9 {
            banks.extend([false, true].map(|rule| Bank::even_firing(throws, rule).unwrap()));
        }
        for bank in banks {
            let moments = Moments::new(bank).unwrap();
            let bank = &moments.bank;
            let magnitude = Magnitude::new(bank, &moments.ring).unwrap();
            let entries = Entries::new(bank, &magnitude, &moments.images, &Cancel::new()).unwrap();
            let images: u64 = entries.all.iter().map(|entry| entry.image_count()).sum();
            assert_eq!(u128::from(images) * u128::from(bank.turns), bank.count(), "{bank:?}");
            for &entry in &entries.all {
                for image in moments.images.all() {
                    let phases: Vec<u32> = moments.images.phases(entry.packed, image).collect();
                    let mut ascending = phases.clone();
                    ascending.sort_unstable();
                    assert_eq!(ascending, bank.phases);
                    assert!(!bank.alternating || alternates(&phases), "{phases:?}");
                }
            }
        }
    }
}
