//! The superposition of an engine's loads at every point of a sweep.
//!
//! With the two banks at `bisector ∓ γ`, γ half the bank angle, a sum of one order is
//! A·cos mγ + B·sin mγ + K: A and B from the loads of the right and the left bank, turned to the
//! bisector, K from loads that belong to none. [`Waves`] holds the functions of γ, [`Coefficients`]
//! the sums times harmonics at points of rod ratio and pin offset; a row of the result is a
//! combination of the two. Every number is evaluated by itself, whatever else is swept.

use std::ops::Range;

use super::block::{Block, ROWS_SIDE_BY_SIDE};
use super::factors::{Coefficients, Waves};
use super::layout::Layout;
use super::{Selection, Sweep};
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
            layouts.push(self.sweep.layout(engine, loads, self.selection)?);
        }
        Ok(layouts)
    }

    /// Evaluates every row; `finish` writes those of a block, times a factor.
    ///
    /// Rows are those of engine, bank angle and point, in this order; waves and coefficients are held for a slab
    /// of bank angles and a slab of points at a time.
    pub fn rows<T: Send>(
        &self,
        out: &mut [T],
        factor: f64,
        finish: impl Fn(&Block, f64, &mut [T]) -> Result<()> + Sync,
    ) -> Result<()> {
        if out.is_empty() {
            return Ok(());
        }
        let sweep = self.sweep;
        let angles = sweep.bank_angles().len();
        let points = sweep.points_of(self.selection);
        let slab = (SLAB / sweep.orders.len().max(1)).clamp(ROWS_PER_CHECK, 1 << 14);
        let numbers = out.len() * if self.slow { 256 } else { 1 };
        let layouts = self.layouts()?;
        self.cancel.expect(layouts.len() * angles * points);
        for angle_slab in parts(0..angles, slab) {
            let waves =
                Waves::new(sweep, self.selection.quantity, angle_slab.clone(), self.cancel)?;
            for point_slab in parts(0..points, slab) {
                let coefficients = self.coefficients(&layouts, point_slab.clone(), numbers)?;
                let span = Span { angles: angle_slab.clone(), points: point_slab, of: points };
                let per_engine = coefficients.len() / layouts.len().max(1);
                let engines = out.chunks_mut(angles * points * self.width);
                let tasks = engines.zip(coefficients.chunks(per_engine.max(1)));
                let tasks =
                    tasks.flat_map(|(out, coefficients)| self.tasks(&span, coefficients, out));
                pool::each(self.cancel, tasks.collect(), numbers, |task| {
                    self.evaluate(
                        &waves,
                        task,
                        #[inline(always)]
                        |block, out| finish(block, factor, out),
                    )
                })?;
            }
        }
        Ok(())
    }

    /// Coefficients of each engine at some points, part by part.
    fn coefficients(
        &self,
        layouts: &[Layout],
        points: Range<usize>,
        numbers: usize,
    ) -> Result<Vec<Coefficients>> {
        let engines = self.sweep.loads.iter().map(AsRef::as_ref).zip(layouts);
        let of_parts = engines
            .flat_map(|engine| parts(points.clone(), PART).map(move |points| (engine, points)));
        let many = pool::is_worth_parallel(numbers);
        pool::map_if(many, self.cancel, of_parts.collect(), |(of_engine, points)| {
            Coefficients::new(self.sweep, self.selection, of_engine, points, self.cancel)
        })
    }

    /// Tasks that write the rows of a span of one engine, from its coefficients part by part.
    fn tasks<'t, T>(
        &self,
        span: &Span,
        coefficients: &'t [Coefficients],
        out: &'t mut [T],
    ) -> Vec<Task<'t, T>> {
        let row = span.of * self.width;
        let out = &mut out[span.angles.start * row..span.angles.end * row];
        // Rows are contiguous over several bank angles where a part has all points.
        let is_whole = coefficients.first().is_some_and(|part| part.points == span.of);
        let per_run = if is_whole { out.len() } else { row };
        let piece = if self.slow { 8 } else { ROWS_PER_TASK };
        let mut tasks = Vec::new();
        for (run, out) in out.chunks_mut(per_run.max(1)).enumerate() {
            let mut rest = if is_whole {
                out
            } else {
                &mut out[span.points.start * self.width..span.points.end * self.width]
            };
            for coefficients in coefficients {
                let length = if is_whole { rest.len() } else { coefficients.points * self.width };
                let (own, others) = rest.split_at_mut(length);
                rest = others;
                let rows = own.chunks_mut(piece * self.width).enumerate();
                let first = |k| run * coefficients.points + k * piece;
                tasks.extend(rows.map(|(k, out)| Task { coefficients, first: first(k), out }));
            }
        }
        tasks
    }

    /// Evaluates the rows of a task.
    fn evaluate<T>(
        &self,
        waves: &Waves,
        Task { coefficients, first, out }: Task<T>,
        finish: impl Fn(&Block, &mut [T]) -> Result<()>,
    ) -> Result<()> {
        let mut block = Block::new(self.sweep.orders.len());
        let rows = out.len() / self.width;
        for (k, out) in out.chunks_mut(ROWS_PER_CHECK * self.width).enumerate() {
            self.cancel.check()?;
            vectorised(
                #[inline(always)]
                || {
                    for (j, out) in out.chunks_mut(ROWS_SIDE_BY_SIDE * self.width).enumerate() {
                        let row = first + k * ROWS_PER_CHECK + j * ROWS_SIDE_BY_SIDE;
                        block.evaluate(waves, coefficients, row);
                        finish(&block, out)?;
                    }
                    Ok(())
                },
            )?;
        }
        self.cancel.advance(rows);
        Ok(())
    }
}

/// Bank angles and points whose waves and coefficients are held, and the number of all points.
struct Span {
    angles: Range<usize>,
    points: Range<usize>,
    of: usize,
}

/// Rows of one engine, contiguous, from the first that has these coefficients.
struct Task<'a, T> {
    coefficients: &'a Coefficients,
    first: usize,
    out: &'a mut [T],
}

#[cfg(test)]
pub(super) mod tests;
