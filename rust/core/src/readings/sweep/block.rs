//! Rows of a sweep evaluated side by side: functions of the bank angle times constants, and what
//! becomes of the sums.

use std::ops::Range;

use super::factors::{CONSTANTS, Constants, FUNCTIONS, Turning};
use crate::Complex64;
use crate::wrench::snapped;

/// Rows evaluated side by side.
pub(super) const BLOCK: usize = 128;

/// One value for each row of a block.
type Column = [f64; BLOCK];

/// Sums of every order at up to [`BLOCK`] rows.
pub(super) struct Block {
    functions: [Column; FUNCTIONS],
    constants: [Column; CONSTANTS],
    orders: Vec<Sums>,
}

/// Forward part and conjugate of the backward part (or torque and nothing) of one order.
#[derive(Clone)]
struct Sums {
    forward: [Column; 2],
    backward_conj: [Column; 2],
    bound: Column,
}

impl Sums {
    /// Functions times constants at `count` rows, of which all may share a bank angle or a point.
    #[inline(always)]
    fn combine<const ONE_ANGLE: bool, const ONE_POINT: bool>(
        &mut self,
        functions: [&[f64]; FUNCTIONS],
        constants: [&[f64]; CONSTANTS],
        count: usize,
    ) {
        let count = count.min(BLOCK);
        let f = functions.map(|column| &column[..if ONE_ANGLE { 1 } else { count }]);
        let c = constants.map(|column| &column[..if ONE_POINT { 1 } else { count }]);
        for part in 0..2 {
            for (i, out) in self.forward[part][..count].iter_mut().enumerate() {
                let (angle, point) = (if ONE_ANGLE { 0 } else { i }, if ONE_POINT { 0 } else { i });
                let rest = f[1][angle].mul_add(c[4 + part][point], c[8 + part][point]);
                *out = f[0][angle].mul_add(c[part][point], rest);
            }
            for (i, out) in self.backward_conj[part][..count].iter_mut().enumerate() {
                let (angle, point) = (if ONE_ANGLE { 0 } else { i }, if ONE_POINT { 0 } else { i });
                let rest = f[3][angle].mul_add(c[6 + part][point], c[10 + part][point]);
                *out = f[2][angle].mul_add(c[2 + part][point], rest);
            }
        }
        for (i, out) in self.bound[..count].iter_mut().enumerate() {
            *out = c[CONSTANTS - 1][if ONE_POINT { 0 } else { i }];
        }
    }
}

impl Block {
    pub fn new(orders: usize) -> Self {
        let (none, pair) = ([0.0; BLOCK], [[0.0; BLOCK]; 2]);
        let sums = Sums { forward: pair, backward_conj: pair, bound: none };
        Self {
            functions: [none; FUNCTIONS],
            constants: [none; CONSTANTS],
            orders: vec![sums; orders],
        }
    }

    /// Sums at some rows, bank angle by bank angle and point by point.
    #[inline(always)]
    pub fn evaluate(&mut self, turning: &Turning, constants: &Constants, rows: Range<usize>) {
        let Self { functions: f, constants: c, orders } = self;
        let points = constants.points;
        let columns = turning.0.iter().zip(&constants.by_order);
        for (sums, (functions, values)) in orders.iter_mut().zip(columns) {
            let functions: [&[f64]; FUNCTIONS] = columns_of(functions);
            let values: [&[f64]; CONSTANTS] = columns_of(values);
            if points == 1 {
                let functions = functions.map(|column| &column[rows.clone()]);
                let values = values.map(|column| &column[..1]);
                sums.combine::<false, true>(functions, values, rows.len());
                continue;
            }
            let (angle, point) = (rows.start / points, rows.start % points);
            if point + rows.len() <= points {
                let functions = functions.map(|column| &column[angle..=angle]);
                let here = point..point + rows.len();
                let values = values.map(|column| &column[here.clone()]);
                sums.combine::<true, false>(functions, values, rows.len());
                continue;
            }
            let mut row = rows.start;
            while row < rows.end {
                let (angle, point) = (row / points, row % points);
                let run = (points - point).min(rows.end - row);
                let here = row - rows.start..row - rows.start + run;
                for (column, function) in f.iter_mut().zip(functions) {
                    column[here.clone()].fill(function[angle]);
                }
                for (column, value) in c.iter_mut().zip(values) {
                    column[here.clone()].copy_from_slice(&value[point..point + run]);
                }
                row += run;
            }
            let functions = f.each_ref().map(|column| &column[..rows.len()]);
            let values = c.each_ref().map(|column| &column[..rows.len()]);
            sums.combine::<false, false>(functions, values, rows.len());
        }
    }

    /// Number of orders.
    pub fn orders(&self) -> usize {
        self.orders.len()
    }

    /// Bound of the rounding error.
    pub fn bound(&self, order: usize, i: usize) -> f64 {
        self.orders[order].bound[i]
    }

    /// Forward part and conjugate of the backward part, zero where rounding is all there is.
    #[inline(always)]
    pub fn turning(&self, order: usize, i: usize) -> [Complex64; 2] {
        let sums = &self.orders[order];
        let phasor = |column: &[Column; 2]| Complex64::new(column[0][i], column[1][i]);
        [&sums.forward, &sums.backward_conj].map(|column| snapped(phasor(column), sums.bound[i]))
    }

    /// Phasors along (about) x and y; of torque the first is it.
    #[inline(always)]
    pub fn phasors(&self, order: usize, i: usize) -> [Complex64; 2] {
        let Sums { forward, backward_conj, bound } = &self.orders[order];
        let forward = Complex64::new(forward[0][i], forward[1][i]);
        let backward_conj = Complex64::new(backward_conj[0][i], backward_conj[1][i]);
        let (sum, difference) = (forward + backward_conj, forward - backward_conj);
        // −i times the difference.
        let components = [sum, Complex64::new(difference.im, -difference.re)];
        components.map(|phasor| snapped(phasor, bound[i]))
    }

    /// Phasors of all orders of one row, component by component.
    pub fn by_component(&self, i: usize) -> [Vec<Complex64>; 2] {
        let phasors: Vec<_> = (0..self.orders.len()).map(|order| self.phasors(order, i)).collect();
        [0, 1].map(|component| phasors.iter().map(|both| both[component]).collect())
    }

    /// Magnitudes of the phasors of every row and order times a factor, x and y side by side.
    #[inline(always)]
    pub fn magnitudes(&self, components: usize, factor: f64, out: &mut [f64]) {
        let width = self.orders.len() * components;
        let mut pairs = [[0.0; 2]; BLOCK];
        for (order, sums) in self.orders.iter().enumerate() {
            sums.magnitudes(factor, &mut pairs[..(out.len() / width).min(BLOCK)]);
            if components == 2 {
                let (rows, _) = out.as_chunks_mut::<2>();
                let rows = rows[order..].iter_mut().step_by(self.orders.len());
                rows.zip(&pairs).for_each(|(out, pair)| *out = *pair);
            } else {
                let rows = out[order..].iter_mut().step_by(width);
                rows.zip(&pairs).for_each(|(out, [along, _])| *out = *along);
            }
        }
    }
}

impl Sums {
    /// Magnitudes along (about) x and y at the first rows.
    #[inline(always)]
    fn magnitudes(&self, factor: f64, pairs: &mut [[f64; 2]]) {
        let Self { forward: [f, g], backward_conj: [u, v], bound } = self;
        for (i, pair) in pairs.iter_mut().enumerate().take(BLOCK) {
            let square = bound[i] * bound[i];
            let along = magnitude(f[i] + u[i], g[i] + v[i], square);
            *pair = [factor * along, factor * magnitude(f[i] - u[i], g[i] - v[i], square)];
        }
    }
}

/// Columns that stand one after the other.
#[inline(always)]
fn columns_of<const N: usize>(values: &[f64]) -> [&[f64]; N] {
    let length = values.len() / N;
    std::array::from_fn(|k| &values[k * length..(k + 1) * length])
}

/// Length of a phasor, 0 where its square is within a bound's.
#[inline(always)]
fn magnitude(re: f64, im: f64, bound: f64) -> f64 {
    let square = re.mul_add(re, im * im);
    if square > bound { square.sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests;
