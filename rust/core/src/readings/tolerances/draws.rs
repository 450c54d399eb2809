//! Deviations of an engine's figures from their nominal values, sample by sample.

use super::random::{self, BLOCK, LARGEST_NORMAL};
use super::{Distribution, FIGURES, Figure};
use crate::numbers::simd::vectorised;

/// Samples evaluated side by side.
pub(super) const CHUNK: usize = 128;

/// One value for each sample of a chunk.
pub(super) type Column = [f64; CHUNK];

/// How far figures spread, and the seed of the draws.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Draws {
    /// By figure, of each cylinder or pin; empty where none spreads.
    pub spreads: [Vec<f64>; FIGURES],
    pub distribution: Distribution,
    pub seed: u64,
}

impl Distribution {
    /// Largest magnitude of a draw of spread 1.
    pub(super) fn largest(self) -> f64 {
        match self {
            Self::Normal => LARGEST_NORMAL,
            Self::Uniform => 1.0,
        }
    }
}

impl Draws {
    /// Deviations of a figure in the samples from `first` on, of each cylinder or pin; None where none
    /// spreads.
    ///
    /// A number depends on the seed, the figure, the sample and the cylinder alone.
    pub fn chunk(&self, figure: Figure, first: usize) -> Option<Vec<Column>> {
        let spreads = &self.spreads[figure as usize];
        if spreads.is_empty() {
            return None;
        }
        let mut columns = vec![[0.0; CHUNK]; spreads.len()];
        for sample in 0..CHUNK {
            for (block, columns) in columns.chunks_mut(BLOCK).enumerate() {
                let place = (first + sample) as u64;
                let words = random::words(self.seed, figure as u64, place, block as u64);
                for (column, word) in columns.iter_mut().zip(words) {
                    column[sample] = random::uniform(word);
                }
            }
        }
        vectorised(
            #[inline(always)]
            || {
                for (column, &spread) in columns.iter_mut().zip(spreads) {
                    match self.distribution {
                        Distribution::Normal => random::normals(column),
                        Distribution::Uniform => {
                            for value in column.iter_mut() {
                                *value = 2.0 * *value - 1.0;
                            }
                        }
                    }
                    for value in column.iter_mut() {
                        *value *= spread;
                    }
                }
            },
        );
        Some(columns)
    }
}
