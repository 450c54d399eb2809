//! The superposition of an engine's loads at every point of a sweep.
//!
//! With the two banks at `bisector ∓ γ`, γ half the bank angle, a sum of one order is
//! A·cos mγ + B·sin mγ + K: A and B from the loads of the right and the left bank, turned to the
//! bisector, K from loads that belong to none. [`Turning`] holds the functions of γ, [`Constants`]
//! the sums times harmonics at points of rod ratio and pin offset; a row of the result is a
//! combination of the two. Every number is evaluated by itself, whatever else is swept.

use std::ops::{Mul, Range};

use bytemuck::Zeroable;
use rayon::prelude::*;

use super::harmonics::Amplitudes;
use super::layout::Layout;
use super::{Quantity, Sweep};
use crate::Complex64;
use crate::cancel::Cancel;
use crate::error::Result;
use crate::memory;
use crate::pool;
use crate::simd::{sin_cos_degrees, vectorised};
use crate::wrench::snapped;

/// Rows evaluated side by side.
pub(super) const BLOCK: usize = 128;
/// Numbers of functions and of constants held at a time.
const SLAB: usize = 1 << 19;
/// Most rows of a task.
const PIECE: usize = 1024;
/// A result of fewer numbers is not worth waking another thread for (some 30 µs).
const WORTH_A_THREAD: usize = 1 << 16;

/// One value for each row of a block.
type Column = [f64; BLOCK];

/// Functions of γ: cosine and sine for the forward part (or torque) and for the backward part.
const FUNCTIONS: usize = 4;
/// Real and imaginary parts of A, B and K, forward and backward, and the bound of rounding errors.
const CONSTANTS: usize = 13;

/// What a result holds.
pub(super) trait Number:
    Copy + Default + Zeroable + Send + Sync + Mul<f64, Output = Self>
{
}
impl Number for f64 {}
impl Number for Complex64 {}

/// What is evaluated, and how a row becomes numbers of the result.
pub(super) struct Job<'a, F> {
    pub sweep: &'a Sweep,
    pub quantity: Quantity,
    /// Numbers to a row and speed.
    pub width: usize,
    /// Whether a row takes some hundred times as long as its sums: a search for an extremum.
    pub slow: bool,
    pub cancel: &'a Cancel,
    /// Writes the rows of a block, times a factor.
    pub finish: F,
}

impl<F: Sync> Job<'_, F> {
    /// Evaluates every row, and writes it at every speed.
    pub fn run<T: Number>(&self, out: &mut [T]) -> Result<()>
    where
        F: Fn(&Block, f64, &mut [T]) -> Result<()> + Sync,
    {
        let speeds = &self.sweep.squares;
        if let [square] = speeds[..] {
            return self.rows(out, square);
        }
        let mut rows = memory::zeros(out.len() / speeds.len())?;
        self.cancel.expect(out.len().div_ceil(PIECE * self.width));
        self.rows(&mut rows, 1.0)?;
        let write = |(piece, out): (usize, &mut [T])| {
            scale(&rows, speeds, self.width, piece * PIECE, out);
            self.cancel.step()
        };
        let pieces = PIECE * self.width;
        if out.len() >= WORTH_A_THREAD {
            let pieces = out.par_chunks_mut(pieces).enumerate();
            return pool::run(self.cancel, || pieces.try_for_each(write));
        }
        out.chunks_mut(pieces).enumerate().try_for_each(write)
    }

    /// Evaluates every row, times a factor.
    fn rows<T: Number>(&self, out: &mut [T], factor: f64) -> Result<()>
    where
        F: Fn(&Block, f64, &mut [T]) -> Result<()> + Sync,
    {
        let (sweep, width) = (self.sweep, self.width);
        let (angles, points) = (sweep.bank_angles().len(), sweep.points());
        let piece = if self.slow { 8 } else { PIECE };
        let slab = (SLAB / sweep.orders.len()).clamp(BLOCK, 1 << 14);
        let slabs = |length: usize| (0..length).step_by(slab).map(move |k| k..length.min(k + slab));
        let large = out.len() * if self.slow { 256 } else { 1 } >= WORTH_A_THREAD;
        let layout = |k: usize| Layout::new(sweep, k, self.quantity);
        let layouts: Vec<Layout> = self.each((0..sweep.engines.len()).collect(), large, layout)?;
        self.cancel.expect(sweep.engines.len() * angles * points);
        for angle_slab in slabs(angles) {
            let turning = Turning::new(sweep, self.quantity, angle_slab.clone());
            for point_slab in slabs(points) {
                let constants = |layout| Constants::new(self, layout, point_slab.clone());
                let constants = self.each(layouts.iter().collect(), large, constants)?;
                let mut tasks = Vec::new();
                for (out, constants) in out.chunks_mut(angles * points * width).zip(&constants) {
                    let span = angle_slab.start * points..angle_slab.end * points;
                    let out = &mut out[span.start * width..span.end * width];
                    // Rows are contiguous over several bank angles where the slab has all points.
                    let (per_run, part) = if point_slab.len() == points {
                        (out.len(), 0..out.len())
                    } else {
                        (points * width, point_slab.start * width..point_slab.end * width)
                    };
                    for (run, out) in out.chunks_mut(per_run.max(1)).enumerate() {
                        let rows = out[part.clone()].chunks_mut(piece * width).enumerate();
                        let first = |k| run * point_slab.len() + k * piece;
                        tasks.extend(rows.map(|(k, rows)| (constants, first(k), rows)));
                    }
                }
                let work =
                    |block: &mut Block, (constants, first, out): (&Constants, usize, &mut [T])| {
                        for (k, out) in out.chunks_mut(BLOCK * width).enumerate() {
                            self.cancel.check()?;
                            let first = first + k * BLOCK;
                            vectorised(
                                #[inline(always)]
                                || {
                                    block.evaluate(
                                        &turning,
                                        constants,
                                        first..first + out.len() / width,
                                    );
                                    (self.finish)(block, factor, out)
                                },
                            )?;
                        }
                        self.cancel.advance(out.len() / width);
                        Ok(())
                    };
                let block = || Block::new(sweep.orders.len());
                if large {
                    let tasks = tasks.into_par_iter();
                    pool::run(self.cancel, || tasks.try_for_each_init(block, work))?;
                } else {
                    let mut block = block();
                    tasks.into_iter().try_for_each(|task| work(&mut block, task))?;
                }
            }
        }
        Ok(())
    }
}

impl<F> Job<'_, F> {
    /// A function of each item, in parallel if the job is large.
    fn each<I: Send, T: Send>(
        &self,
        items: Vec<I>,
        large: bool,
        function: impl Fn(I) -> Result<T> + Send + Sync,
    ) -> Result<Vec<T>> {
        if large {
            return pool::map(self.cancel, items, function);
        }
        items.into_iter().map(function).collect()
    }
}

/// Functions of half the bank angle, by order, at some bank angles.
///
/// Columns one after the other.
struct Turning(Vec<Vec<f64>>);

impl Turning {
    fn new(sweep: &Sweep, quantity: Quantity, angles: Range<usize>) -> Self {
        let count = angles.len();
        let Some((bank_angles, hold)) = &sweep.axes.bank_angle else {
            // No bank turns: cosines of zero.
            let none = [vec![1.0; count], vec![0.0; count]].concat().repeat(2);
            return Self(vec![none; sweep.orders.len()]);
        };
        let of_order = |&order: &crate::Order| {
            let multiples = quantity.turn(order, *hold);
            let mut functions = vec![0.0; FUNCTIONS * count];
            for (multiple, pair) in multiples.into_iter().zip(functions.chunks_mut(2 * count)) {
                let (cos, sin) = pair.split_at_mut(count);
                let half = 0.5 * multiple as f64;
                let degrees: Vec<f64> =
                    bank_angles[angles.clone()].iter().map(|angle| half * angle).collect();
                vectorised(
                    #[inline(always)]
                    || sin_cos_degrees(&degrees, sin, cos),
                );
            }
            functions
        };
        Self(sweep.orders.iter().map(of_order).collect())
    }
}

/// A, B, K and the bound of rounding errors, by order, of one engine at some points.
struct Constants {
    /// Columns one after the other.
    by_order: Vec<Vec<f64>>,
    points: usize,
}

impl Constants {
    fn new<F>(job: &Job<F>, layout: &Layout, points: Range<usize>) -> Result<Self> {
        let count = points.len();
        let amplitudes = Amplitudes::new(job.sweep, layout, job.quantity, points, job.cancel)?;
        let mut by_order = Vec::with_capacity(layout.by_order.len());
        for (k, sums) in layout.by_order.iter().enumerate() {
            let mut columns = vec![0.0; CONSTANTS * count];
            for sum in sums {
                let [re, im] = amplitudes.of(sum.channel, k, count);
                let (constants, bounds) = columns.split_at_mut((CONSTANTS - 1) * count);
                for (constant, pair) in sum.constants.iter().zip(constants.chunks_mut(2 * count)) {
                    let (out_re, out_im) = pair.split_at_mut(count);
                    if *constant == Complex64::default() {
                        continue;
                    }
                    for i in 0..count {
                        out_re[i] += constant.re * re[i] - constant.im * im[i];
                        out_im[i] += constant.re * im[i] + constant.im * re[i];
                    }
                }
                for ((bound, re), im) in bounds.iter_mut().zip(re.iter()).zip(im.iter()) {
                    let length = if *im == 0.0 { re.abs() } else { re.hypot(*im) };
                    *bound += sum.bound * length;
                }
            }
            by_order.push(columns);
        }
        Ok(Self { by_order, points: count })
    }
}

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
    fn new(orders: usize) -> Self {
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
    fn evaluate(&mut self, turning: &Turning, constants: &Constants, rows: Range<usize>) {
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
        let rows = out.len() / width;
        // Two orders at a time, so that a row is written four numbers at once.
        for (pair, orders) in self.orders.chunks(2).enumerate() {
            let mut columns = [[0.0; BLOCK]; 4];
            for (sums, columns) in orders.iter().zip(columns.chunks_exact_mut(2)) {
                if let [along, across] = columns {
                    sums.magnitudes(factor, along, across, rows);
                }
            }
            let [a, b, c, d] = &columns;
            match (orders.len(), components) {
                (2, 2) => write_rows(&[a, b, c, d], width, 4 * pair, out),
                (1, 2) => write_rows(&[a, b], width, 4 * pair, out),
                (2, _) => write_rows(&[a, c], width, 2 * pair, out),
                _ => write_rows(&[a], width, 2 * pair, out),
            }
        }
    }
}

impl Sums {
    /// Magnitudes along (about) x and y at `count` rows.
    #[inline(always)]
    fn magnitudes(&self, factor: f64, along: &mut Column, across: &mut Column, count: usize) {
        let Self { forward: [f, g], backward_conj: [u, v], bound } = self;
        for i in 0..count.min(BLOCK) {
            let square = bound[i] * bound[i];
            along[i] = factor * magnitude(f[i] + u[i], g[i] + v[i], square);
            across[i] = factor * magnitude(f[i] - u[i], g[i] - v[i], square);
        }
    }
}

/// Columns that stand one after the other.
#[inline(always)]
fn columns_of<const N: usize>(values: &[f64]) -> [&[f64]; N] {
    let length = values.len() / N;
    std::array::from_fn(|k| &values[k * length..(k + 1) * length])
}

/// Writes columns to neighbouring places of rows of some width.
#[inline(always)]
fn write_rows<const N: usize>(columns: &[&Column; N], width: usize, first: usize, out: &mut [f64]) {
    if width == N {
        let (rows, _) = out.as_chunks_mut::<N>();
        for (i, row) in rows.iter_mut().enumerate().take(BLOCK) {
            *row = columns.map(|column| column[i]);
        }
        return;
    }
    for (i, row) in out.chunks_exact_mut(width).enumerate().take(BLOCK) {
        row[first..first + N].copy_from_slice(&columns.map(|column| column[i]));
    }
}

/// Length of a phasor, 0 where its square is within a bound's.
#[inline(always)]
fn magnitude(re: f64, im: f64, bound: f64) -> f64 {
    let square = re.mul_add(re, im * im);
    if square > bound { square.sqrt() } else { 0.0 }
}

/// Rows times ω² of each speed, from the row and speed with this index on.
fn scale<T: Number>(rows: &[T], speeds: &[f64], width: usize, first: usize, mut out: &mut [T]) {
    let mut at = first;
    while !out.is_empty() {
        let (row, speed) = (at / speeds.len(), at % speeds.len());
        let here = (speeds.len() - speed).min(out.len() / width);
        let (values, after) = out.split_at_mut(here * width);
        let row = &rows[row * width..(row + 1) * width];
        vectorised(
            #[inline(always)]
            || {
                for (&square, out) in speeds[speed..].iter().zip(values.chunks_exact_mut(width)) {
                    for (out, &value) in out.iter_mut().zip(row) {
                        *out = value * square;
                    }
                }
            },
        );
        (at, out) = (at + here, after);
    }
}

#[cfg(test)]
mod tests;
