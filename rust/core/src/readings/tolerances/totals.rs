//! Peaks of all orders together, of samples and of any rows of phasors.

use super::CHUNK;
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::{self, Order};
use crate::numbers::pool;
use crate::readings::balance::{Balance, TorquePart, Vector};
use crate::readings::peaks::PeakFinder;

/// Largest magnitude over the turn of each sum of a mean and orders: rows of peak phasors, one of each
/// order.
pub fn largest_sums(
    orders: &[Order],
    phasors: &[Complex64],
    mean: f64,
    cancel: &Cancel,
) -> Result<Vec<f64>> {
    order::check_list(orders)?;
    let finder = PeakFinder::about_mean(orders)?;
    let rows: Vec<&[Complex64]> = phasors.chunks_exact(orders.len()).collect();
    let chunks = pool::map(cancel, rows.chunks(CHUNK).collect(), |rows| {
        cancel.check()?;
        rows.iter().map(|row| finder.beside_mean(mean, row, cancel)).collect::<Result<Vec<_>>>()
    })?;
    Ok(chunks.concat())
}

/// Peaks of all orders together of the nominal engine: a sample has them where nothing deviates.
pub(super) struct Totals {
    /// Of force and moment along (about) x and y, of torque on block and crank: by order.
    phasors: Vec<Complex64>,
    peaks: [f64; 4],
}

impl Totals {
    pub fn new(nominal: &Balance, cancel: &Cancel) -> Result<Self> {
        let orders = 0..nominal.orders.len();
        let planar = [Vector::Force, Vector::Moment].map(|vector| {
            [0, 1].map(|axis| orders.clone().map(move |k| nominal.xy(vector, k)[axis]))
        });
        let torque = |k: usize| nominal.wrenches[k].torque();
        let phasors = planar.into_iter().flatten().flatten();
        let phasors = phasors
            .chain(orders.clone().map(|k| torque(k).roll))
            .chain(orders.map(|k| torque(k).crank))
            .collect();
        let [roll, crank] =
            [false, true].map(|c| nominal.torque_peak(TorquePart::Whole, c, cancel));
        let [force, moment] = [Vector::Force, Vector::Moment].map(|v| nominal.peak(v, cancel));
        Ok(Self { phasors, peaks: [force?, moment?, roll?, crank?] })
    }

    /// Longest force and moment, largest torques of phasors in the order of the nominal ones.
    pub fn peaks(
        &self,
        finder: &PeakFinder,
        phasors: &[Complex64],
        cancel: &Cancel,
    ) -> Result<[f64; 4]> {
        let orders = phasors.len() / 6;
        let of = |component: usize, count: usize| {
            let range = component * orders..(component + count) * orders;
            (&phasors[range.clone()], self.phasors[range.clone()] == phasors[range])
        };
        let vector = |k: usize| {
            let (both, same) = of(2 * k, 2);
            let (x, y) = both.split_at(orders);
            if same { Ok(self.peaks[k]) } else { finder.of_vector(x, y, cancel) }
        };
        let ((roll, same_roll), (crank, same_crank)) = (of(4, 1), of(5, 1));
        let on_block = if same_roll { self.peaks[2] } else { finder.along_axis(roll, cancel)? };
        // Without pin offset, rod inertia and shafts beside the crank one is minus the other.
        let opposite = || roll.iter().zip(crank).all(|(roll, crank)| *roll == -crank);
        let on_crank = if same_crank {
            self.peaks[3]
        } else if opposite() {
            on_block
        } else {
            finder.along_axis(crank, cancel)?
        };
        Ok([vector(0)?, vector(1)?, on_block, on_crank])
    }
}
