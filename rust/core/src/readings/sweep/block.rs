//! Rows of a sweep evaluated side by side: waves of the bank angle times coefficients.

use std::array::from_fn;

use super::factors::{Coefficients, Padded, Waves};
use crate::Complex64;
use crate::numbers::simd::MultiplyAdd;
use crate::wrench::Planar;

/// Rows evaluated side by side.
pub(super) const ROWS_SIDE_BY_SIDE: usize = 16;

/// One value for each row of a block.
type SideBySide = [f64; ROWS_SIDE_BY_SIDE];

/// Sums of every order at up to [`ROWS_SIDE_BY_SIDE`] rows.
pub(super) struct Block {
    orders: Vec<Sums>,
}

/// Real and imaginary parts of an order's forward part and of the conjugate of its backward part (or
/// of torque and nothing).
#[derive(Clone, Default)]
struct Sums {
    forward: [SideBySide; 2],
    backward_conj: [SideBySide; 2],
    bound: SideBySide,
}

/// Places of a block's rows in a column.
trait Places {
    /// Numbers of a column at these places.
    fn of<const N: usize>(&self, columns: &Padded<N>, column: usize) -> SideBySide;
}

/// One place for all rows.
struct OnePlace(usize);

/// This place and those after it.
struct PlacesFrom(usize);

/// A place for each row.
struct EachPlace([usize; ROWS_SIDE_BY_SIDE]);

impl Places for OnePlace {
    #[inline(always)]
    fn of<const N: usize>(&self, columns: &Padded<N>, column: usize) -> SideBySide {
        [columns.values[column * columns.length + self.0]; ROWS_SIDE_BY_SIDE]
    }
}

impl Places for PlacesFrom {
    #[inline(always)]
    fn of<const N: usize>(&self, columns: &Padded<N>, column: usize) -> SideBySide {
        let values = &columns.values[column * columns.length + self.0..][..ROWS_SIDE_BY_SIDE];
        let mut lanes = [0.0; ROWS_SIDE_BY_SIDE];
        lanes.copy_from_slice(values);
        lanes
    }
}

impl Places for EachPlace {
    #[inline(always)]
    fn of<const N: usize>(&self, columns: &Padded<N>, column: usize) -> SideBySide {
        let mut lanes = [0.0; ROWS_SIDE_BY_SIDE];
        for (lane, place) in lanes.iter_mut().zip(&self.0) {
            *lane = columns.values[column * columns.length + place];
        }
        lanes
    }
}

impl Block {
    pub fn new(orders: usize) -> Self {
        Self { orders: vec![Sums::default(); orders] }
    }

    /// Sums at the rows from this one on, bank angle by bank angle and point by point.
    #[inline(always)]
    pub fn evaluate(&mut self, waves: &Waves, coefficients: &Coefficients, row: usize) {
        let points = coefficients.points;
        if points == 1 {
            return self.combine(waves, coefficients, &PlacesFrom(row), &OnePlace(0));
        }
        let (angle, point) = (row / points, row % points);
        if point + ROWS_SIDE_BY_SIDE <= points {
            return self.combine(waves, coefficients, &OnePlace(angle), &PlacesFrom(point));
        }
        let angles = from_fn(|i| (row + i) / points);
        let places = from_fn(|i| (row + i) % points);
        self.combine(waves, coefficients, &EachPlace(angles), &EachPlace(places));
    }

    #[inline(always)]
    fn combine(
        &mut self,
        waves: &Waves,
        coefficients: &Coefficients,
        angle: &impl Places,
        point: &impl Places,
    ) {
        let orders = waves.of_order.iter().zip(&coefficients.by_order);
        for (sums, (waves_of_order, coefficients)) in self.orders.iter_mut().zip(orders) {
            let parts = [&mut sums.forward, &mut sums.backward_conj];
            for (side, out) in parts.into_iter().enumerate() {
                let wave = &waves.columns[waves_of_order[side]];
                let (cos, sin) = (angle.of(wave, 0), angle.of(wave, 1));
                for (part, out) in out.iter_mut().enumerate() {
                    let first = 6 * side + part;
                    let of_cos = point.of(coefficients, first);
                    let of_sin = point.of(coefficients, first + 2);
                    let rest = point.of(coefficients, first + 4);
                    for i in 0..ROWS_SIDE_BY_SIDE {
                        out[i] =
                            cos[i].multiply_add(of_cos[i], sin[i].multiply_add(of_sin[i], rest[i]));
                    }
                }
            }
            sums.bound = point.of(coefficients, 12);
        }
    }

    /// Sum of an order at a row, also where it is rounding; of torque the forward part is it.
    #[inline(always)]
    pub fn planar(&self, order: usize, i: usize) -> Planar {
        let Sums { forward: [f, g], backward_conj: [u, v], bound } = &self.orders[order];
        let (forward, backward_conj) = (Complex64::new(f[i], g[i]), Complex64::new(u[i], v[i]));
        Planar { forward, backward_conj, bound: bound[i] }
    }

    /// Phasors along (about) x and y of all orders of one row, component by component.
    pub fn by_component(&self, i: usize) -> [Vec<Complex64>; 2] {
        components((0..self.orders.len()).map(|order| self.planar(order, i)))
    }

    /// Magnitudes of the phasors of every row and order times a factor, x and y side by side.
    #[inline(always)]
    pub fn magnitudes<const COMPONENTS: usize>(&self, factor: f64, out: &mut [f64]) {
        let (out, _) = out.as_chunks_mut::<COMPONENTS>();
        for (order, sums) in self.orders.iter().enumerate() {
            let Sums { forward: [f, g], backward_conj: [u, v], bound } = sums;
            let mut values = [[0.0; COMPONENTS]; ROWS_SIDE_BY_SIDE];
            for (i, values) in values.iter_mut().enumerate() {
                for (value, sign) in values.iter_mut().zip([1.0, -1.0]) {
                    let (re, im) = (f[i] + sign * u[i], g[i] + sign * v[i]);
                    *value = factor * magnitude(re, im, bound[i]);
                }
            }
            for (row, value) in out.chunks_exact_mut(self.orders.len()).zip(&values) {
                row[order] = *value;
            }
        }
    }

    /// Longest vectors of every row and order times a factor.
    #[inline(always)]
    pub fn lengths(&self, factor: f64, out: &mut [f64]) {
        for (order, sums) in self.orders.iter().enumerate() {
            let Sums { forward: [f, g], backward_conj: [u, v], bound } = sums;
            let mut values = [0.0; ROWS_SIDE_BY_SIDE];
            for (i, value) in values.iter_mut().enumerate() {
                let backward = magnitude(u[i], v[i], bound[i]);
                *value = factor * (magnitude(f[i], g[i], bound[i]) + backward);
            }
            for (row, value) in out.chunks_exact_mut(self.orders.len()).zip(&values) {
                row[order] = *value;
            }
        }
    }
}

/// Phasors along (about) x and y of sums, component by component; of torques the first are they.
pub(super) fn components(sums: impl Iterator<Item = Planar>) -> [Vec<Complex64>; 2] {
    let phasors: Vec<_> = sums.map(|sum| sum.xy(sum.bound)).collect();
    [0, 1].map(|component| phasors.iter().map(|both| both[component]).collect())
}

/// Length of a phasor, 0 where it is within a bound.
#[inline(always)]
pub(super) fn magnitude(re: f64, im: f64, bound: f64) -> f64 {
    let square = re.multiply_add(re, im * im);
    if square > bound * bound { square.sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests;
