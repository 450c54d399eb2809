//! Sums of orders at many points: phasors, a row for each point, times cosines and sines of nθ.
//!
//! Tiles of cosines and sines stay in cache while the rows are processed; each row is written straight
//! to its destination.

use std::ops::Range;

use crate::Complex64;
use crate::numbers::crank_angles::{CrankAngles, parts};
use crate::numbers::order::Order;
use crate::numbers::simd::MultiplyAdd;

/// Crank angles of a tile.
pub(super) const TILE: usize = 256;
/// Angles summed side by side, in registers.
const ANGLES_SIDE_BY_SIDE: usize = 16;

/// A part of a sum that is not zero in every row: real or imaginary parts of the phasors of an order.
#[derive(Clone, Copy)]
pub(super) struct OrderWave {
    /// Place of the order.
    order: usize,
    sine: bool,
}

/// Cosines and sines of the multiples of crank angles, tile by tile; none of orders that have no term.
pub(super) struct Tiles(Vec<Vec<Tile>>);

/// Whole lines of the cache.
#[repr(align(64))]
struct Tile {
    cos: [[f64; ANGLES_SIDE_BY_SIDE]; TILE / ANGLES_SIDE_BY_SIDE],
    sin: [[f64; ANGLES_SIDE_BY_SIDE]; TILE / ANGLES_SIDE_BY_SIDE],
}

impl OrderWave {
    /// The terms of some rows of phasors of a number of components.
    ///
    /// What a layout cancels is not summed, nor a part that in every row is less than half a unit in
    /// the last place of the whole phasor.
    pub fn of(phasors: &[Complex64], orders: usize, components: usize) -> Vec<Self> {
        let all = (0..orders).flat_map(|order| [false, true].map(|sine| Self { order, sine }));
        let adds = |term: &Self| {
            let first = term.order * components;
            let rows = phasors.chunks_exact(orders * components);
            let mut of_order = rows.flat_map(|row| &row[first..first + components]);
            of_order.any(|phasor| {
                let larger = phasor.re.abs().max(phasor.im.abs());
                term.weight(*phasor).abs() > 0.5 * f64::EPSILON * larger
            })
        };
        all.filter(adds).collect()
    }

    /// By what cosine or sine is multiplied.
    #[inline(always)]
    fn weight(self, phasor: Complex64) -> f64 {
        if self.sine { -phasor.im } else { phasor.re }
    }
}

impl Tiles {
    /// At a range of the angles, of the orders of these terms.
    pub fn new(
        angles: &CrankAngles,
        range: &Range<usize>,
        orders: &[Order],
        terms: &[OrderWave],
    ) -> Self {
        let tiles = orders.iter().enumerate().map(|(place, &order)| {
            if terms.iter().all(|term| term.order != place) {
                return Vec::new();
            }
            parts(range.clone(), TILE).map(|part| Tile::new(angles, part, order)).collect()
        });
        Self(tiles.collect())
    }

    /// Write the sum of a row's terms, of each component, at the angles of some tiles, the first of
    /// which has this place.
    #[inline(always)]
    pub fn sum<const COMPONENTS: usize>(
        &self,
        terms: &[OrderWave],
        row: &[Complex64],
        first: usize,
        out: &mut [f64],
    ) {
        let (row, _) = row.as_chunks::<COMPONENTS>();
        let (out, _) = out.as_chunks_mut::<COMPONENTS>();
        let mut of_tile = Vec::new();
        for (k, out) in (first..).zip(out.chunks_mut(TILE)) {
            of_tile.clear();
            of_tile.extend(terms.iter().map(|term| {
                let tile = &self.0[term.order][k];
                let numbers = if term.sine { &tile.sin } else { &tile.cos };
                (row[term.order].map(|phasor| term.weight(phasor)), numbers)
            }));
            for (block, out) in out.chunks_mut(ANGLES_SIDE_BY_SIDE).enumerate() {
                let mut sums = [[0.0; COMPONENTS]; ANGLES_SIDE_BY_SIDE];
                for (weights, numbers) in &of_tile {
                    for (sum, number) in sums.iter_mut().zip(&numbers[block]) {
                        for (sum, weight) in sum.iter_mut().zip(weights) {
                            *sum = weight.multiply_add(*number, *sum);
                        }
                    }
                }
                out.copy_from_slice(&sums[..out.len()]);
            }
        }
    }
}

impl Tile {
    fn new(angles: &CrankAngles, range: Range<usize>, order: Order) -> Self {
        let zeros = [[0.0; ANGLES_SIDE_BY_SIDE]; TILE / ANGLES_SIDE_BY_SIDE];
        let mut tile = Self { cos: zeros, sin: zeros };
        let [cos, sin] = [&mut tile.cos, &mut tile.sin].map(|numbers| numbers.as_flattened_mut());
        angles.multiples(order, range, cos, sin);
        tile
    }
}
