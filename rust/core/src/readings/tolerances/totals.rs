//! Peaks of all orders together, of samples and of any rows of phasors.

use super::CHUNK;
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::{self, Order};
use crate::numbers::pool;
use crate::readings::peaks::PeakFinder;

/// Largest magnitude over the turn of each sum of a mean and orders: rows of peak phasors, one of each
/// order, and means of the rows, if any.
pub fn largest_sums(
    orders: &[Order],
    phasors: &[Complex64],
    means: &[f64],
    cancel: &Cancel,
) -> Result<Vec<f64>> {
    order::check_list(orders)?;
    let finder = PeakFinder::about_mean(orders)?;
    let means = means.iter().copied().chain(std::iter::repeat(0.0));
    let rows: Vec<_> = phasors.chunks_exact(orders.len()).zip(means).collect();
    let chunks = pool::map(cancel, rows.chunks(CHUNK).collect(), |rows| {
        cancel.check()?;
        rows.iter()
            .map(|(row, mean)| finder.beside_mean(*mean, row, cancel))
            .collect::<Result<Vec<_>>>()
    })?;
    Ok(chunks.concat())
}

/// Longest force and moment, largest torques on block and crank, of phasors of one sample: of force and
/// moment along (about) x and y, of both torques, order by order.
pub(super) fn peaks(
    finder: &PeakFinder,
    phasors: &[Complex64],
    cancel: &Cancel,
) -> Result<[f64; 4]> {
    let orders = phasors.len() / 6;
    let of = |component: usize| &phasors[component * orders..][..orders];
    let vector = |k: usize| finder.of_vector(of(2 * k), of(2 * k + 1), cancel);
    let (roll, crank) = (of(4), of(5));
    let on_block = finder.along_axis(roll, cancel)?;
    // Without pin offset, rod inertia and shafts beside the crank one is minus the other.
    let opposite = roll.iter().zip(crank).all(|(roll, crank)| *roll == -crank);
    let on_crank = if opposite { on_block } else { finder.along_axis(crank, cancel)? };
    Ok([vector(0)?, vector(1)?, on_block, on_crank])
}
