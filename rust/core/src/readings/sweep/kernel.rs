//! The superposition of an engine's loads at every point of a sweep.
//!
//! With the two banks at `bisector ∓ γ`, γ half the bank angle, a sum of one order is
//! A·cos mγ + B·sin mγ + K: A and B from the loads of the right and the left bank, turned to the
//! bisector, K from loads that belong to none. [`Waves`] holds the functions of γ, [`Coefficients`]
//! the sums times harmonics at points of rod ratio and pin offset; a row of the result is a
//! combination of the two. Every number is evaluated by itself, whatever else is swept.

use std::ops::{Add, Mul, Range};

use bytemuck::Zeroable;

use super::block::{Block, ROWS_SIDE_BY_SIDE};
use super::factors::{Coefficients, Waves};
use super::layout::Layout;
use super::{Selection, Sweep};
use crate::Complex64;
use crate::load::LoadList;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::parts;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::pool;
use crate::numbers::simd::vectorised;

/// Numbers of waves and of coefficients held at a time.
const SLAB: usize = 1 << 19;
/// Most points of rod ratio and pin offset whose coefficients one thread computes.
const PART: usize = 1 << 11;
/// Most rows of a task.
pub(super) const ROWS_PER_TASK: usize = 1024;
/// Rows between two checks for cancellation.
const ROWS_PER_CHECK: usize = 128;

/// What a result holds.
pub(super) trait Number:
    Copy + Default + Zeroable + Send + Sync + Add<Output = Self> + Mul<f64, Output = Self>
{
}
impl Number for f64 {}
impl Number for Complex64 {}

/// Rows to evaluate.
pub(super) struct Job<'a> {
    pub sweep: &'a Sweep,
    pub selection: Selection<'a>,
    /// Numbers of a row.
    pub width: usize,
    /// Whether a row takes some hundred times as long as its sums: a search for an extremum.
    pub slow: bool,
    pub cancel: &'a Cancel,
}

impl Job<'_> {
    /// Layout sums of each engine.
    fn layouts(&self) -> Result<Vec<Layout>> {
        let mut layouts: Vec<Layout> = memory::with_capacity(self.sweep.engines.len())?;
        for (engine, loads) in self.sweep.engines.iter().zip(&self.sweep.loads) {
            self.cancel.check()?;
            let sums = self.sweep.layouts(engine, loads, &[self.selection])?;
            layouts.push(sums.into_iter().next().unwrap_or_default());
        }
        Ok(layouts)
    }

    /// Evaluates every row; `finish` writes those of a block, times a factor.
    pub fn rows<T: Number>(
        &self,
        out: &mut [T],
        factor: f64,
        finish: impl Fn(&Block, f64, &mut [T]) -> Result<()> + Sync,
    ) -> Result<()> {
        let (sweep, width) = (self.sweep, self.width);
        let angles = sweep.bank_angles().len();
        let points = sweep.points_of(self.selection);
        let piece = if self.slow { 8 } else { ROWS_PER_TASK };
        let slab = (SLAB / sweep.orders.len().max(1)).clamp(ROWS_PER_CHECK, 1 << 14);
        let slabs = |length: usize| (0..length).step_by(slab).map(move |k| k..length.min(k + slab));
        let numbers = out.len() * if self.slow { 256 } else { 1 };
        let many = pool::is_worth_parallel(numbers);
        let layouts = self.layouts()?;
        self.cancel.expect(layouts.len() * angles * points);
        for angle_slab in slabs(angles) {
            let waves =
                Waves::new(sweep, self.selection.quantity, angle_slab.clone(), self.cancel)?;
            for point_slab in slabs(points) {
                let parts: Vec<Range<usize>> = parts(point_slab.clone(), PART).collect();
                let loads = sweep.loads.iter().map(AsRef::as_ref);
                let each_part = loads.zip(&layouts).flat_map(|of_engine| {
                    parts.iter().map(move |points| (of_engine, points.clone()))
                });
                let coefficients = |(of_engine, points): ((&LoadList, &Layout), Range<usize>)| {
                    Coefficients::new(sweep, self.selection, of_engine, points, self.cancel)
                };
                let coefficients =
                    pool::map_if(many, self.cancel, each_part.collect(), coefficients)?;
                let mut tasks = Vec::new();
                for (out, coefficients) in
                    out.chunks_mut(angles * points * width).zip(coefficients.chunks(parts.len()))
                {
                    let span = angle_slab.start * points..angle_slab.end * points;
                    let out = &mut out[span.start * width..span.end * width];
                    // Rows are contiguous over several bank angles where a part has all points.
                    let whole = parts[0].len() == points;
                    let per_run = if whole { out.len() } else { points * width };
                    for (run, out) in out.chunks_mut(per_run.max(1)).enumerate() {
                        let mut rest = if whole {
                            out
                        } else {
                            &mut out[point_slab.start * width..point_slab.end * width]
                        };
                        for coefficients in coefficients {
                            let length =
                                if whole { rest.len() } else { coefficients.points * width };
                            let (own, others) = rest.split_at_mut(length);
                            rest = others;
                            let rows = own.chunks_mut(piece * width).enumerate();
                            let first = |k| run * coefficients.points + k * piece;
                            tasks.extend(rows.map(|(k, rows)| (coefficients, first(k), rows)));
                        }
                    }
                }
                let work = |(coefficients, first, out): (&Coefficients, usize, &mut [T])| {
                    let mut block = Block::new(sweep.orders.len());
                    for (k, out) in out.chunks_mut(ROWS_PER_CHECK * width).enumerate() {
                        self.cancel.check()?;
                        vectorised(
                            #[inline(always)]
                            || {
                                for (j, out) in
                                    out.chunks_mut(ROWS_SIDE_BY_SIDE * width).enumerate()
                                {
                                    let row = first + k * ROWS_PER_CHECK + j * ROWS_SIDE_BY_SIDE;
                                    block.evaluate(&waves, coefficients, row);
                                    finish(&block, factor, out)?;
                                }
                                Ok(())
                            },
                        )?;
                    }
                    self.cancel.advance(out.len() / width);
                    Ok(())
                };
                pool::each(self.cancel, tasks, numbers, work)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
pub(super) mod tests;
