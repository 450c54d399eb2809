//! |Z|² of an arrangement as a whole number that is the same where |Z|² is, exactly.
//!
//! `|2Z|² = Σ_d c_d ζᵈ` with c the cyclic autocorrelation of the weights over the phases. It is linear
//! in c, and c is a sum over pairs of throws; so its remainder modulo `Φ_N`, packed into one integer,
//! is a sum over pairs too.

use super::packing::Packing;
use super::throws::Bank;
use crate::numbers::error::{Error, Result};
use crate::numbers::ring::Ring;

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
        let column = |distance: usize| {
            let mut combination = vec![0; parts];
            combination[distance] += 1;
            combination[(parts - distance) % parts] += 1;
            ring.remainder(&combination)
        };
        // Distances that occur between two throws, either way round.
        let shorter = |distance: usize| distance.min(parts - distance);
        let pairs = bank.phases.iter().enumerate();
        let mut distances: Vec<usize> = pairs
            .flat_map(|(k, phase)| bank.phases[k + 1..].iter().map(move |p| (p - phase) as usize))
            .map(shorter)
            .collect();
        distances.sort_unstable();
        distances.dedup();
        // The weights sum to nothing, hence so does the autocorrelation; and where no phase comes
        // twice, what stands at distance 0 is the same for all. Only differences count.
        let same = column(distances.first().copied().unwrap_or(0));
        let less_same = |column: &Vec<i64>| column.iter().zip(&same).map(|(a, b)| a - b).collect();
        let mut columns: Vec<Vec<i64>> = distances.iter().map(|&d| column(d)).collect();
        let differences: Vec<Vec<i64>> = columns.iter().map(less_same).collect();
        columns.push(column(0));
        // A throw has at most two partners at a distance for each throw of one phase, and |v·w| is at
        // most (v² + w²)/2.
        let of_one_phase = bank.phases.chunk_by(|a, b| a == b).map(<[u32]>::len).max().unwrap_or(1);
        let squares: i64 = bank.weights().iter().map(|w| w * w).sum();
        let largest = of_one_phase as i64 * squares;
        let packing = Packing::new(&columns, &differences, |row| {
            largest * columns.iter().map(|column| column[row].abs()).sum::<i64>()
        });
        if packing.bits > 64 {
            let phases: Vec<String> =
                bank.phases.iter().map(|p| format!("{p}/{}", bank.parts)).collect();
            let hint = "sums over these parts of a turn do not fit the integers of the search; \
                        give fewer throws, or phases that are multiples of a larger part of a turn";
            let value = format!("turn × ({})", phases.join(", "));
            return Err(Error::value("phases_deg", value, hint));
        }
        let hashed = |packed: u128| (packed as u64).wrapping_mul(SPREAD);
        // The column of distance 0 counts a throw twice.
        let half: Vec<i64> = column(0).iter().map(|entry| entry / 2).collect();
        let mut by_distance = vec![0; parts];
        for (&distance, &column) in distances.iter().zip(&packing.columns) {
            by_distance[distance] = hashed(column);
            by_distance[(parts - distance) % parts] = hashed(column);
        }
        Ok(Self { by_distance, by_itself: hashed(packing.pack(&half)) })
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

#[cfg(test)]
mod tests {
    use super::super::moments::Moments;
    use super::super::throws::MOST_THROWS;
    use super::*;
    use crate::numbers::angle::Angle;

    #[test]
    fn every_even_firing_bank_has_keys_that_fit() {
        for throws in 2..=MOST_THROWS {
            let moments = Moments::new(Bank::even_firing(throws, false).unwrap()).unwrap();
            assert!(Magnitude::new(&moments.bank, &moments.ring).is_ok(), "{throws}");
        }
    }

    #[test]
    fn banks_of_a_few_throws_have_keys_that_fit_whatever_the_parts_of_a_turn() {
        for parts in 2..=360 {
            for throws in 2..=4 {
                let phases: Vec<Angle> = (0..throws)
                    .map(|k| Angle::from_turns(k * k * k % parts, parts).unwrap().reduced())
                    .collect();
                let moments = Moments::new(Bank::with_phases(&phases).unwrap()).unwrap();
                let found = Magnitude::new(&moments.bank, &moments.ring);
                assert!(found.is_ok(), "{throws} throws, {parts} parts");
            }
        }
    }

    #[test]
    fn phases_whose_keys_do_not_fit_are_named() {
        let phases: Vec<Angle> = (0..12).map(|k| Angle::from_turns(k * k, 359).unwrap()).collect();
        let moments = Moments::new(Bank::with_phases(&phases).unwrap());
        let error = moments
            .and_then(|moments| Magnitude::new(&moments.bank, &moments.ring).map(drop))
            .unwrap_err();
        assert!(error.to_string().starts_with("phases_deg = turn × (0/359, 1/359"), "{error}");
    }
}
