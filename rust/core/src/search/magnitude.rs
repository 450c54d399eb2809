//! |Z|² of an arrangement as a whole number that is the same where |Z|² is, exactly.
//!
//! `|2Z|² = Σ_d c_d ζᵈ` with c the cyclic autocorrelation of the weights over the phases. It is linear
//! in c, and c is a sum over pairs of throws; so its remainder modulo `Φ_N`, packed into one integer,
//! is a sum over pairs too.

use super::packing::Packing;
use super::throws::Bank;
use crate::error::{Error, Result};
use crate::ring::Ring;

/// An odd factor keeps equal keys equal and different ones different, and spreads them evenly.
const SPREAD: u64 = 0x9E37_79B9_7F4A_7C15;

/// Key of |Z|², a sum over pairs of throws.
#[derive(Debug, Clone)]
pub(super) struct Magnitude {
    /// Added for each pair of throws, by the distance of their phases, times both weights.
    by_distance: Vec<u64>,
    /// Added for each throw, times the square of its weight.
    by_itself: u64,
}

impl Magnitude {
    pub(super) fn new(bank: &Bank, ring: &Ring) -> Result<Self> {
        let parts = bank.parts as usize;
        // What a unit of weight at each distance adds, as a remainder.
        let columns: Vec<Vec<i64>> = (0..parts)
            .map(|distance| {
                let mut combination = vec![0; parts];
                combination[distance] += 1;
                combination[(parts - distance) % parts] += 1;
                ring.remainder(&combination)
            })
            .collect();
        // The weights sum to nothing, hence so does the autocorrelation; and where no phase comes
        // twice, what stands at distance 0 is the same for all. Only differences tell.
        let distinct = bank.phases.windows(2).all(|pair| pair[0] != pair[1]);
        let first = usize::from(distinct && parts > 1);
        let differences: Vec<Vec<i64>> = columns[first..]
            .iter()
            .map(|column| column.iter().zip(&columns[first]).map(|(a, b)| a - b).collect())
            .collect();
        // |c_d| is at most c_0 (Cauchy, Schwarz); each column stands for d and −d.
        let largest: i64 = bank.weights().iter().map(|w| w * w).sum();
        let packing = Packing::new(&columns, &differences, |row| {
            largest * columns.iter().map(|column| column[row].abs()).sum::<i64>() / 2
        });
        if packing.bits > 64 {
            return Err(too_rich(bank));
        }
        let spread = |packed: u128| (packed as u64).wrapping_mul(SPREAD);
        // The column of distance 0 counts a throw twice.
        let half: Vec<i64> = columns[0].iter().map(|entry| entry / 2).collect();
        Ok(Self {
            by_distance: packing.columns.iter().map(|&column| spread(column)).collect(),
            by_itself: spread(packing.pack(&half)),
        })
    }

    /// What a throw adds to the key by itself.
    pub(super) fn alone(&self, weight: i64) -> u64 {
        self.by_itself.wrapping_mul((weight * weight) as u64)
    }

    /// What two throws add to the key, per product of their weights.
    pub(super) fn pair(&self, phase: u32, other: u32) -> u64 {
        self.by_distance[phase.abs_diff(other) as usize]
    }
}

/// Keys that do not fit.
pub(super) fn too_rich(bank: &Bank) -> Error {
    let cure = "fewer throws, or phases with fewer parts of a turn, are searched exactly";
    Error::value("cylinders", 2 * bank.throws(), cure)
}
