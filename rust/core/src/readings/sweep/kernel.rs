//! The superposition of an engine's loads at every point of a sweep.
//!
//! With the two banks at `bisector ∓ γ`, γ half the bank angle, a sum of one order is
//! A·cos mγ + B·sin mγ + K: A and B from the loads of the right and the left bank, turned to the
//! bisector, K from loads that belong to none. [`Waves`] holds the functions of γ, [`Coefficients`]
//! the sums times harmonics at points of rod ratio and pin offset; a row of the result is a
//! combination of the two. Every number is evaluated by itself, whatever else is swept.

use std::ops::Mul;

use bytemuck::Zeroable;
use rayon::prelude::*;

use super::block::{Block, LANES};
use super::factors::{Coefficients, Waves};
use super::harmonics::Points;
use super::layout::Layout;
use super::{Quantity, Sweep};
use crate::Complex64;
use crate::load::Loads;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::pool;
use crate::numbers::simd::vectorised;

/// Numbers of waves and of coefficients held at a time.
const SLAB: usize = 1 << 19;
/// Most rows of a task.
const PIECE: usize = 1024;
/// Rows between two checks for cancellation.
const STRETCH: usize = 128;

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
    /// ω² of each speed, where a row is one of a point at a speed.
    pub within: Option<&'a [f64]>,
    /// Factors of each row, otherwise.
    pub after: &'a [f64],
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
        let speeds = self.after;
        if let [square] = *speeds {
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
        if pool::worth(out.len()) {
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
        let angles = sweep.bank_angles().len();
        let points = sweep.points() * self.within.map_or(1, <[f64]>::len);
        let piece = if self.slow { 8 } else { PIECE };
        let slab = (SLAB / sweep.orders.len().max(1)).clamp(STRETCH, 1 << 14);
        let slabs = |length: usize| (0..length).step_by(slab).map(move |k| k..length.min(k + slab));
        let large = pool::worth(out.len() * if self.slow { 256 } else { 1 });
        let layout = |k: usize| {
            self.cancel.check()?;
            let loads = sweep.loads(k);
            let layouts = sweep.layouts(&sweep.engines[k], &loads, &[self.quantity])?;
            Ok((loads, layouts.into_iter().next().unwrap_or_default()))
        };
        let layouts: Vec<(Loads, Layout)> =
            self.each((0..sweep.engines.len()).collect(), large, layout)?;
        self.cancel.expect(sweep.engines.len() * angles * points);
        for angle_slab in slabs(angles) {
            let waves = Waves::new(sweep, self.quantity, angle_slab.clone(), self.cancel)?;
            for point_slab in slabs(points) {
                let coefficients = |(loads, layout): &(Loads, Layout)| {
                    let points = Points { range: point_slab.clone(), squares: self.within };
                    Coefficients::new(sweep, self.quantity, (loads, layout), &points, self.cancel)
                };
                let coefficients = self.each(layouts.iter().collect(), large, coefficients)?;
                let mut tasks = Vec::new();
                for (out, coefficients) in
                    out.chunks_mut(angles * points * width).zip(&coefficients)
                {
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
                        tasks.extend(rows.map(|(k, rows)| (coefficients, first(k), rows)));
                    }
                }
                let work =
                    |block: &mut Block, (coefficients, first, out): (&Coefficients, usize, &mut [T])| {
                        for (k, out) in out.chunks_mut(STRETCH * width).enumerate() {
                            self.cancel.check()?;
                            vectorised(
                                #[inline(always)]
                                || {
                                    for (j, out) in out.chunks_mut(LANES * width).enumerate() {
                                        let row = first + k * STRETCH + j * LANES;
                                        block.evaluate(&waves, coefficients, row);
                                        (self.finish)(block, factor, out)?;
                                    }
                                    Ok(())
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
pub(super) mod tests;
