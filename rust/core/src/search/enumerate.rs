//! All arrangements of a bank up to turning the crank, with the exact keys of their |Z|².

use rayon::prelude::*;

use super::images::{Images, Packed};
use super::magnitude::Magnitude;
use super::throws::Bank;
use crate::cancel::Cancel;
use crate::error::{Error, Result};

/// Most memory that the keys of a search may take, bytes.
pub const LARGEST_SEARCH: u128 = 8 << 30;

/// The key of an arrangement, and the arrangement with the number of its images in the lowest bits.
pub(super) type Entry = (u64, Packed);

/// The first of each set of images.
pub(super) fn entries(
    bank: &Bank,
    magnitude: &Magnitude,
    images: &Images,
    cancel: &Cancel,
) -> Result<Vec<Entry>> {
    let bytes = bank.count() / u128::from(bank.turns()) / 2 * size_of::<Entry>() as u128;
    if bytes > LARGEST_SEARCH {
        return Err(Error::TooLarge {
            argument: "cylinders".into(),
            bytes,
            limit: LARGEST_SEARCH,
            cure: "ask for fewer cylinders",
        });
    }
    let left: Vec<u8> = images
        .distinct
        .iter()
        .map(|phase| bank.phases.iter().filter(|other| *other == phase).count() as u8)
        .collect();
    let walk = Walk { bank, magnitude, images, weights: bank.weights() };
    // One task for each choice of the first two throws.
    let mut starts = Vec::new();
    for first in bank.first_phases() {
        let mut start = Partial { left: left.clone(), phases: Vec::new(), packed: 0, key: 0 };
        let Ok(index) = walk.images.distinct.binary_search(&first) else { continue };
        walk.place(&mut start, index);
        for second in 0..walk.images.distinct.len() {
            if start.left[second] > 0 {
                let mut start = start.clone();
                walk.place(&mut start, second);
                starts.push(start);
            }
        }
    }
    let parts = starts.into_par_iter().map(|mut start| {
        let mut out = Vec::new();
        walk.extend(&mut start, &mut out, cancel).map(|()| out)
    });
    Ok(parts.collect::<Result<Vec<_>>>()?.concat())
}

#[derive(Clone)]
struct Partial {
    /// How many throws each distinct phase still takes.
    left: Vec<u8>,
    phases: Vec<u32>,
    packed: Packed,
    key: u64,
}

struct Walk<'a> {
    bank: &'a Bank,
    magnitude: &'a Magnitude,
    images: &'a Images,
    weights: Vec<i64>,
}

impl Walk<'_> {
    /// The next throw takes a phase.
    fn place(&self, partial: &mut Partial, index: usize) {
        let throw = partial.phases.len();
        let (phase, weight) = (self.images.distinct[index], self.weights[throw]);
        let mut sum = 0_u64;
        for (&other, &of_other) in partial.phases.iter().zip(&self.weights) {
            sum = sum.wrapping_add(self.magnitude.pair(phase, other).wrapping_mul(of_other as u64));
        }
        partial.key = partial
            .key
            .wrapping_add(sum.wrapping_mul(weight as u64))
            .wrapping_add(self.magnitude.alone(weight));
        partial.left[index] -= 1;
        partial.phases.push(phase);
        partial.packed |= (index as u64) << (4 * (throw + 1));
    }

    fn extend(&self, partial: &mut Partial, out: &mut Vec<Entry>, cancel: &Cancel) -> Result<()> {
        let throw = partial.phases.len();
        if throw == self.weights.len() {
            if let Some(images) = self.images.count_of_first(partial.packed)
                && (!self.bank.alternating || self.bank.alternates(&partial.phases))
            {
                out.push((partial.key, partial.packed | images));
            }
            return Ok(());
        }
        if self.weights.len() - throw == 6 {
            cancel.check()?;
        }
        for index in 0..self.images.distinct.len() {
            if partial.left[index] == 0 {
                continue;
            }
            let (key, packed) = (partial.key, partial.packed);
            self.place(partial, index);
            self.extend(partial, out, cancel)?;
            (partial.key, partial.packed) = (key, packed);
            partial.phases.pop();
            partial.left[index] += 1;
        }
        Ok(())
    }
}
