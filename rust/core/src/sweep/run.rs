//! One pass over all points of a sweep, block by block, in parallel.

use rayon::prelude::*;

use super::block::{BLOCK, Block};
use super::plan::{Plan, Terms};
use crate::cancel::Cancel;
use crate::error::Result;
use crate::simd::vectorised;

/// Points of the other axes between two looks at cancellation.
const POINTS: usize = 1024;
/// A result of fewer numbers is not worth waking another thread for (some 30 µs).
const WORTH_A_THREAD: usize = 1 << 16;

/// One pass over all points.
pub(super) struct Run<'a> {
    plan: &'a Plan<'a>,
    /// ω² of each speed, less `folded`.
    squares: &'a [f64],
    /// ω² of a single speed: it goes into the constants, before magnitudes are taken.
    folded: f64,
    /// Points of rod ratio and pin offset.
    points: usize,
    /// Numbers to a point and speed.
    width: usize,
    cancel: &'a Cancel,
}

impl<'a> Run<'a> {
    pub fn new(
        plan: &'a Plan<'a>,
        squares: &'a [f64],
        points: usize,
        width: usize,
        cancel: &'a Cancel,
    ) -> Self {
        let (squares, folded) = match squares {
            [square] => (&[1.0][..], *square),
            _ => (squares, 1.0),
        };
        Self { plan, squares, folded, points, width, cancel }
    }

    /// Blocks of bank angles, each for all engines, in parallel.
    pub fn over_bank_angles<T>(
        &self,
        bank_angles: &[f64],
        values: &mut [T],
        finish: &(impl Fn(&mut Block, &mut [T]) + Sync),
    ) -> Result<()>
    where
        T: Copy + Default + Send + Sync + std::ops::Mul<f64, Output = T>,
    {
        let row = self.points * self.squares.len() * self.width;
        let large = values.len() >= WORTH_A_THREAD;
        let mut by_engine: Vec<_> = values
            .chunks_mut(bank_angles.len() * row)
            .map(|engine| engine.chunks_mut(BLOCK * row))
            .collect();
        let tasks: Vec<(&[f64], Vec<&mut [T]>)> = bank_angles
            .chunks(BLOCK)
            .map(|angles| (angles, by_engine.iter_mut().filter_map(Iterator::next).collect()))
            .collect();
        // With one point to an engine its constants serve every block.
        let engines = 0..self.plan.engines.len();
        let single: Vec<Terms> = if self.points == 1 {
            engines.map(|engine| self.plan.combined(engine, 0)).collect()
        } else {
            Vec::new()
        };
        let work = |block: &mut Block, (angles, outs): (&[f64], Vec<&mut [T]>)| -> Result<()> {
            vectorised(
                #[inline(always)]
                || {
                    block.set_angles(self.plan, angles);
                    for (engine, out) in outs.into_iter().enumerate() {
                        self.cancel.check()?;
                        if let (Some(terms), 1) = (single.get(engine), self.squares.len()) {
                            block.set_terms(terms, self.folded);
                            finish(block, out);
                        } else {
                            self.engine_block(engine, block, out, finish)?;
                        }
                    }
                    Ok(())
                },
            )
        };
        self.run(tasks, large, work)
    }

    /// Work through tasks, in parallel where there is enough of it.
    fn run<K: Send>(
        &self,
        tasks: Vec<K>,
        large: bool,
        work: impl Fn(&mut Block, K) -> Result<()> + Sync + Send,
    ) -> Result<()> {
        if large {
            return tasks.into_par_iter().try_for_each_init(|| Block::new(self.plan), work);
        }
        let mut block = Block::new(self.plan);
        tasks.into_iter().try_for_each(|task| work(&mut block, task))
    }

    /// One engine at the block's bank angles: every point of the other axes.
    #[inline(always)]
    fn engine_block<T>(
        &self,
        engine: usize,
        block: &mut Block,
        out: &mut [T],
        finish: &(impl Fn(&mut Block, &mut [T]) + Sync),
    ) -> Result<()>
    where
        T: Copy + Default + std::ops::Mul<f64, Output = T>,
    {
        let (speeds, width) = (self.squares.len(), self.width);
        let mut unscaled = vec![T::default(); block.count * width];
        for point in 0..self.points {
            self.cancel.check()?;
            block.set_terms(&self.plan.combined(engine, point), self.folded);
            finish(block, &mut unscaled);
            for (i, values) in unscaled.chunks_exact(width).enumerate() {
                let start = (i * self.points + point) * speeds * width;
                scale(values, self.squares, &mut out[start..start + speeds * width]);
            }
        }
        Ok(())
    }

    /// Few bank angles or none: runs of the other points, in parallel.
    pub fn over_other_axes<T>(
        &self,
        bank_angles: &[f64],
        values: &mut [T],
        finish: &(impl Fn(&mut Block, &mut [T]) + Sync),
    ) -> Result<()>
    where
        T: Copy + Default + Send + Sync + std::ops::Mul<f64, Output = T>,
    {
        let (speeds, width) = (self.squares.len(), self.width);
        let large = values.len() >= WORTH_A_THREAD;
        let tasks: Vec<(usize, usize, &mut [T])> = values
            .chunks_mut(self.points * speeds * width)
            .enumerate()
            .flat_map(|(engine, out)| {
                let parts = out.chunks_mut(POINTS * width).enumerate();
                parts.map(move |(part, out)| (engine, part * POINTS, out))
            })
            .collect();
        let work =
            |block: &mut Block, (engine, first, out): (usize, usize, &mut [T])| -> Result<()> {
                self.cancel.check()?;
                block.set_angles(self.plan, bank_angles);
                let mut unscaled = vec![T::default(); width];
                let (mut at, mut rest) = (first, out);
                while !rest.is_empty() {
                    self.cancel.check()?;
                    let (point, speed) = (at / speeds, at % speeds);
                    let here = (speeds - speed).min(rest.len() / width);
                    block.set_terms(&self.plan.combined(engine, point), self.folded);
                    finish(block, &mut unscaled);
                    let (rows, after) = rest.split_at_mut(here * width);
                    scale(&unscaled, &self.squares[speed..speed + here], rows);
                    (at, rest) = (at + here, after);
                }
                Ok(())
            };
        self.run(tasks, large, work)
    }
}

/// The values of one point at every speed.
#[inline(always)]
fn scale<T: Copy + std::ops::Mul<f64, Output = T>>(values: &[T], squares: &[f64], rows: &mut [T]) {
    for (&square, row) in squares.iter().zip(rows.chunks_exact_mut(values.len())) {
        for (out, &value) in row.iter_mut().zip(values) {
            *out = value * square;
        }
    }
}
