//! |Z|² of an arrangement as a whole number that is the same where |Z|² is, exactly.
//!
//! `|2Z|² = Σ_d c_d ζᵈ` with c the cyclic autocorrelation of the weights over the phases. It is linear
//! in c, and c is a sum over pairs of throws; so a few rows of its remainder modulo `Φ_N`, packed
//! side by side into one integer, are a sum over pairs too.

use super::ring::Ring;
use super::throws::Bank;
use crate::error::{Error, Result};

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
        // Columns: what a unit of weight at each distance adds, as a remainder.
        let columns: Vec<Vec<i128>> = (0..parts)
            .map(|distance| {
                let mut combination = vec![0; parts];
                combination[distance] += 1;
                combination[(parts - distance) % parts] += 1;
                ring.remainder(&combination)
            })
            .collect();
        let largest: i128 = bank.weights().iter().map(|w| i128::from(w * w)).sum();
        // The weights sum to nothing, hence so does the autocorrelation; and where no phase comes
        // twice, what stands at distance 0 is the same for all. Only differences tell.
        let distinct = bank.phases.windows(2).all(|pair| pair[0] != pair[1]);
        let first = usize::from(distinct && parts > 1);
        let differences: Vec<Vec<i128>> = columns[first..]
            .iter()
            .map(|column| column.iter().zip(&columns[first]).map(|(a, b)| a - b).collect())
            .collect();
        let rows = independent_rows(&differences);
        let mut by_distance = vec![0_u64; parts];
        let mut by_itself = 0_u64;
        let mut shift = 0;
        for row in rows {
            // |c_d| is at most c_0 (Cauchy, Schwarz); each column stands for d and −d.
            let bound = largest * columns.iter().map(|column| column[row].abs()).sum::<i128>() / 2;
            let bits = 128 - (2 * bound + 1).leading_zeros();
            for (field, column) in by_distance.iter_mut().zip(&columns) {
                *field = field.wrapping_add((column[row] as u64) << shift);
            }
            by_itself = by_itself.wrapping_add(((columns[0][row] / 2) as u64) << shift);
            shift += bits;
            if shift > 64 {
                let cure =
                    "fewer throws, or phases with fewer parts of a turn, are searched exactly";
                return Err(Error::value("cylinders", 2 * bank.throws(), cure));
            }
        }
        Ok(Self { by_distance, by_itself })
    }

    /// What a throw adds to the key by itself.
    pub(super) fn alone(&self, weight: i64) -> u64 {
        self.by_itself.wrapping_mul((weight * weight) as u64)
    }

    /// What two throws add to the key, per product of their weights.
    #[inline]
    pub(super) fn pair(&self, phase: u32, other: u32) -> u64 {
        self.by_distance[phase.abs_diff(other) as usize]
    }
}

/// Rows from which all other rows follow, by elimination over the rationals.
fn independent_rows(columns: &[Vec<i128>]) -> Vec<usize> {
    let mut basis: Vec<(usize, Vec<f64>)> = Vec::new();
    let mut rows = Vec::new();
    for row in 0..columns[0].len() {
        let mut rest: Vec<f64> = columns.iter().map(|column| column[row] as f64).collect();
        for (pivot, vector) in &basis {
            let factor = rest[*pivot] / vector[*pivot];
            for (term, other) in rest.iter_mut().zip(vector) {
                *term -= factor * other;
            }
        }
        // Entries are small whole numbers: what is left of a dependent row is rounding.
        let largest = (0..rest.len()).max_by(|&a, &b| rest[a].abs().total_cmp(&rest[b].abs()));
        if let Some(pivot) = largest
            && rest[pivot].abs() > 1e-6
        {
            basis.push((pivot, rest));
            rows.push(row);
        }
    }
    rows
}
