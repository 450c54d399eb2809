//! One pass over all points of a sweep.
//!
//! Rows are the combinations of engine, bank angle, rod ratio and offset, in the order of the result;
//! each is worked out once and then stands at every speed. A unit is a run of rows that lies in one
//! piece in the result, so that threads write (and the system hands out) memory in order. Each number
//! is worked out by itself: units may be of any size and in any thread.

use std::ops::{Mul, Range};

use rayon::prelude::*;

use super::block::{BLOCK, Block, Functions};
use super::plan::Plan;
use crate::Complex64;
use crate::cancel::Cancel;
use crate::error::Result;
use crate::simd::vectorised;

/// Most points of rod ratio and offset in a unit.
const POINTS: usize = 1024;
/// A result of fewer numbers is not worth waking another thread for (some 30 µs).
const WORTH_A_THREAD: usize = 1 << 16;
/// Numbers before speed that are worked out at a time: they stay in the cache.
const SLAB: usize = 1 << 18;
/// Numbers at all speeds that are written in one piece.
const PIECE: usize = 1 << 16;
/// Bytes of functions of the bank angle that several engines share.
const MOST_SHARED: usize = 1 << 24;

/// What a result holds.
pub(super) trait Number: Copy + Default + Send + Sync + Mul<f64, Output = Self> {}
impl Number for f64 {}
impl Number for Complex64 {}

/// What a row costs beside its phasors.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Cost {
    /// Next to nothing.
    Small,
    /// Next to nothing, and threads are awake for what is made of the phasors.
    Awake,
    /// A search for an extremum, some hundred times as much.
    Large,
}

/// The rows of a sweep, and how they are divided into units.
pub(super) struct Run<'a> {
    bank_angles: &'a [f64],
    engines: usize,
    /// Points of rod ratio and pin offset.
    points: usize,
    /// ω² of each speed.
    squares: &'a [f64],
    /// Numbers to a row and speed.
    width: usize,
    cost: Cost,
    cancel: &'a Cancel,
}

/// Rows of one engine in one piece: all points at some bank angles, or some points at one.
struct Unit {
    engine: usize,
    angles: Range<usize>,
    points: Range<usize>,
}

impl Unit {
    fn rows(&self) -> usize {
        self.angles.len() * self.points.len()
    }
}

impl<'a> Run<'a> {
    pub fn new(
        [engines, points, width]: [usize; 3],
        bank_angles: &'a [f64],
        squares: &'a [f64],
        cost: Cost,
        cancel: &'a Cancel,
    ) -> Self {
        Self { bank_angles, engines, points, squares, width, cost, cancel }
    }

    /// Whether bank angles go side by side, or points: whichever leaves fewer places empty.
    fn angles_abreast(&self) -> bool {
        let (angles, points) = (self.bank_angles.len(), self.points);
        let blocks = |rows: usize| rows.div_ceil(BLOCK);
        points < BLOCK && blocks(angles) * points <= angles * blocks(points)
    }

    /// Most bank angles or points in a unit.
    fn abreast(&self) -> usize {
        match (self.cost, self.angles_abreast()) {
            (Cost::Large, _) => 8,
            (_, true) | (Cost::Awake, false) => BLOCK,
            (Cost::Small, false) => POINTS,
        }
    }

    /// How often each point is passed over.
    pub fn passes(&self) -> usize {
        let angles = self.bank_angles.len();
        if self.angles_abreast() { angles.div_ceil(self.abreast()) } else { angles }
    }

    fn units(&self) -> usize {
        let runs = if self.angles_abreast() {
            self.bank_angles.len().div_ceil(self.abreast())
        } else {
            self.bank_angles.len() * self.points.div_ceil(self.abreast())
        };
        self.engines * runs
    }

    /// Units in the order of their rows.
    fn unit(&self, index: usize) -> Unit {
        let (angles, abreast) = (self.bank_angles.len(), self.abreast());
        let part =
            |index: usize, length: usize| index * abreast..((index + 1) * abreast).min(length);
        if self.angles_abreast() {
            let runs = angles.div_ceil(abreast);
            let (engine, run) = (index / runs, index % runs);
            return Unit { engine, angles: part(run, angles), points: 0..self.points };
        }
        let runs = self.points.div_ceil(abreast);
        let (row, run) = (index / runs, index % runs);
        let (engine, angle) = (row / angles, row % angles);
        Unit { engine, angles: angle..angle + 1, points: part(run, self.points) }
    }

    /// Work out every row, slab by slab, and write it at every speed.
    pub fn fill<T: Number>(
        &self,
        plan: &Plan,
        values: &mut [T],
        finish: &(impl Fn(&mut Block, f64, &mut [T]) -> Result<()> + Sync),
    ) -> Result<()> {
        let (units, together) = (self.units(), self.units_in_a_slab());
        let speeds = self.squares.len();
        self.cancel.expect(units);
        let shared = self.shared(plan);
        let mut before_speed = Vec::new();
        let mut rest = values;
        for first in (0..units).step_by(together) {
            let slab: Vec<Unit> =
                (first..units.min(first + together)).map(|k| self.unit(k)).collect();
            let rows: usize = slab.iter().map(Unit::rows).sum();
            let (out, after) = rest.split_at_mut(rows * speeds * self.width);
            rest = after;
            if speeds == 1 {
                self.rows(plan, &shared, slab, out, finish)?;
                continue;
            }
            before_speed.resize(rows * self.width, T::default());
            self.rows(plan, &shared, slab, &mut before_speed, finish)?;
            self.at_every_speed(&before_speed, out)?;
        }
        Ok(())
    }

    /// Units that are worked out at a time.
    fn units_in_a_slab(&self) -> usize {
        let largest =
            if self.angles_abreast() { self.abreast() * self.points } else { self.abreast() };
        (SLAB / (largest * self.width)).max(1)
    }

    /// Functions of the bank angle by run of angles, where several engines have use for them.
    fn shared(&self, plan: &Plan) -> Vec<Functions> {
        let wanted = self.angles_abreast() && self.worth_sharing(plan.orders.len());
        if !wanted {
            return Vec::new();
        }
        let runs = self.bank_angles.chunks(self.abreast());
        let mut shared = vec![Functions::new(plan); runs.len()];
        vectorised(
            #[inline(always)]
            || {
                for (functions, angles) in shared.iter_mut().zip(runs) {
                    functions.set(plan, angles);
                }
            },
        );
        shared
    }

    /// Whether functions of so many orders are: in threads each would work them out anew.
    fn worth_sharing(&self, orders: usize) -> bool {
        let angles = self.bank_angles.len();
        let bytes = angles.div_ceil(self.abreast()) * orders * size_of::<[[f64; BLOCK]; 4]>();
        self.engines > 1
            && bytes <= MOST_SHARED
            && self.is_large(self.engines * angles * self.points * self.width)
    }

    /// Rows of some units, before speed or at the only one.
    fn rows<T: Number>(
        &self,
        plan: &Plan,
        shared: &[Functions],
        units: Vec<Unit>,
        mut out: &mut [T],
        finish: &(impl Fn(&mut Block, f64, &mut [T]) -> Result<()> + Sync),
    ) -> Result<()> {
        let large = self.is_large(out.len());
        let mut tasks = Vec::with_capacity(units.len());
        for unit in units {
            let (rows, after) = out.split_at_mut(unit.rows() * self.width);
            tasks.push((unit, rows));
            out = after;
        }
        let work = |block: &mut _, (unit, out): (Unit, &mut [T])| {
            self.cancel.step()?;
            self.unit_rows(plan, shared, block, &unit, out, finish)
        };
        if large {
            return tasks.into_par_iter().try_for_each_init(|| Block::new(plan), work);
        }
        // Engines at the same bank angles follow each other, for their functions are the same.
        tasks.sort_by_key(|(unit, _)| unit.angles.start);
        let mut block = Block::new(plan);
        tasks.into_iter().try_for_each(|task| work(&mut block, task))
    }

    /// Whether so many numbers before speed are worth another thread.
    fn is_large(&self, numbers: usize) -> bool {
        let weight = match self.cost {
            Cost::Small => 1,
            Cost::Awake => 16,
            Cost::Large => 256,
        };
        numbers * weight >= WORTH_A_THREAD
    }

    fn unit_rows<'s, T: Number>(
        &self,
        plan: &Plan,
        shared: &'s [Functions],
        block: &mut Block<'s>,
        unit: &Unit,
        out: &mut [T],
        finish: &(impl Fn(&mut Block, f64, &mut [T]) -> Result<()> + Sync),
    ) -> Result<()> {
        let engine = &plan.engines[unit.engine];
        let harmonics = |points| engine.harmonics(plan.sweep, points, self.cancel);
        let angles = &self.bank_angles[unit.angles.clone()];
        let width = self.width;
        // ω² is never a factor of anything but the result, so that a value at the only speed has the
        // same bits as at one of many.
        let factor = if let [square] = self.squares { *square } else { 1.0 };
        vectorised(
            #[inline(always)]
            || {
                match shared.get(unit.angles.start / self.abreast()) {
                    Some(functions) => block.share(functions),
                    None => block.set_angles(plan, angles, unit.angles.start),
                }
                if !self.angles_abreast() {
                    let harmonics = harmonics(&unit.points)?;
                    let firsts = unit.points.clone().step_by(BLOCK);
                    for (first, out) in firsts.zip(out.chunks_mut(BLOCK * width)) {
                        self.cancel.check()?;
                        block.set_points(engine, &harmonics, first, out.len() / width);
                        finish(block, factor, out)?;
                    }
                    return Ok(());
                }
                if self.points == 1 {
                    block.set_point(engine.at_only_point.iter().copied());
                    return finish(block, factor, out);
                }
                let harmonics = harmonics(&unit.points)?;
                let mut at_point = vec![T::default(); angles.len() * width];
                for point in unit.points.clone() {
                    self.cancel.check()?;
                    block.set_point(engine.at(&harmonics, point));
                    finish(block, factor, &mut at_point)?;
                    let rows = out.chunks_exact_mut(width).skip(point).step_by(self.points);
                    rows.zip(at_point.chunks_exact(width))
                        .for_each(|(out, row)| out.copy_from_slice(row));
                }
                Ok(())
            },
        )
    }

    /// Rows at a speed that are written in one piece.
    fn piece(&self) -> usize {
        (PIECE / self.width).max(1)
    }

    /// Every row at every speed.
    fn at_every_speed<T: Number>(&self, rows: &[T], out: &mut [T]) -> Result<()> {
        let (speeds, width) = (self.squares.len(), self.width);
        let piece = self.piece();
        let write = |(part, mut out): (usize, &mut [T])| -> Result<()> {
            self.cancel.step()?;
            let mut at = part * piece;
            while !out.is_empty() {
                let (row, speed) = (at / speeds, at % speeds);
                let here = (speeds - speed).min(out.len() / width);
                let (values, after) = out.split_at_mut(here * width);
                let squares = &self.squares[speed..speed + here];
                scale(&rows[row * width..(row + 1) * width], squares, values);
                (at, out) = (at + here, after);
            }
            Ok(())
        };
        self.cancel.expect(out.len().div_ceil(piece * width));
        if out.len() >= WORTH_A_THREAD {
            return out.par_chunks_mut(piece * width).enumerate().try_for_each(write);
        }
        out.chunks_mut(piece * width).enumerate().try_for_each(write)
    }
}

/// A row's values at some speeds.
fn scale<T: Number>(values: &[T], squares: &[f64], out: &mut [T]) {
    vectorised(
        #[inline(always)]
        || {
            for (&square, out) in squares.iter().zip(out.chunks_exact_mut(values.len())) {
                for (out, &value) in out.iter_mut().zip(values) {
                    *out = value * square;
                }
            }
        },
    );
}
