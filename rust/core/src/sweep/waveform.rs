//! Waveforms of every point of a sweep: sums of orders, or exact kinematics.
//!
//! A sum of orders at given angles is a matrix product: phasors, a row for each point, times cosines
//! and sines, a column for each angle. Tiles of the second stay in the cache while rows go past. Of
//! the kinematics, all that does not depend on the rod is worked out once for many points.

use std::ops::Range;

use rayon::prelude::*;

use super::harmonics::proportions;
use super::{Quantity, Sweep, Values};
use crate::Complex64;
use crate::angle::Angle;
use crate::cancel::Cancel;
use crate::crank_angles::{CrankAngles, parts};
use crate::error::{Error, Result};
use crate::kinematics::{Alike, BLOCK, Column, Kinematics, Units};
use crate::limits;
use crate::simd::vectorised;
use crate::slider_crank::{Crank, Proportions};

/// Points, each at a speed, that share a tile of cosines and sines.
const ROWS: usize = 128;
/// Crank angles of a task: a stretch of memory long enough that the processor foresees it.
const SPAN: usize = 4 * BLOCK;
/// A result of fewer numbers is not worth waking another thread for (some 30 µs).
const WORTH_A_THREAD: usize = 1 << 15;

/// What cylinders that move alike and an order of a sum take, in nanoseconds for an angle of a
/// point: slopes from 1 to 8 groups and from 1 to 16 orders, 300 points of 720 angles on one core
/// (AMD EPYC, AVX-512).
const COST: [f64; 2] = [1.0, 0.5];

impl Sweep {
    /// Lengths of the axes of [`Self::waveforms`], if there is room for so much.
    pub fn waveform_shape(&self, quantity: Quantity, angles: usize) -> Result<Vec<usize>> {
        let shape = [&self.shape()[..], &[angles], quantity.shape()].concat();
        let cure = "sweep one axis in parts, or split theta_deg";
        limits::result_size("sweep", &shape, size_of::<f64>(), cure)?;
        Ok(shape)
    }

    /// Whether exact kinematics take less time than the sum of the orders.
    #[must_use]
    pub fn kinematics_cost_less(&self) -> bool {
        let groups =
            |engine: &crate::Engine| Kinematics::new(engine.placements(), 0.0).groups.len();
        let groups: usize = self.engines.iter().map(|engine| groups(engine)).sum();
        let orders = self.engines.len() * self.orders.len();
        self.spectrum.is_none() && COST[0] * groups as f64 <= COST[1] * orders as f64
    }

    /// Values over crank angle, as a sum of orders or by exact kinematics: (…, `n_theta`, and 2 but
    /// for torque), row by row.
    pub fn waveforms(
        &self,
        quantity: Quantity,
        angles: &CrankAngles,
        exact: bool,
        out: &mut [f64],
        cancel: &Cancel,
    ) -> Result<()> {
        let shape = self.waveform_shape(quantity, angles.len())?;
        if out.len() != shape.iter().product::<usize>() {
            return Err(Error::value(
                "out",
                out.len(),
                format!("give an array of shape {shape:?}"),
            ));
        }
        self.check_asked(quantity)?;
        let rows = Rows { angles, components: quantity.components(), cancel };
        if exact {
            return self.by_kinematics(quantity, &rows, out);
        }
        let phasors = self.phasors(quantity, cancel)?;
        self.by_orders(&phasors, &rows, out)
    }

    fn by_orders(&self, phasors: &Values<Complex64>, rows: &Rows, out: &mut [f64]) -> Result<()> {
        let components = rows.components;
        let width = self.orders.len() * components;
        let phasors = phasors.as_slice().unwrap_or_default();
        // What a layout cancels is not summed, nor a part that is less than rounding in every row.
        let terms = |phasors: &[Complex64]| -> Vec<Term> {
            let all = (0..width).flat_map(|column| [false, true].map(|sine| Term { column, sine }));
            let adds = |term: &Term| phasors.chunks_exact(width).any(|row| term.adds(row));
            all.filter(adds).collect()
        };
        let fill_tiles = |tiles: &mut Vec<Tile>, term: &Term, range: Range<usize>| {
            if tiles.is_empty() {
                let order = self.orders[term.column / components];
                let parts = parts(range, BLOCK).map(|part| Tile::new(rows.angles, part, order));
                tiles.extend(parts);
            }
        };
        // Of fewer rows than share a tile each is used once, and not worth keeping.
        let mut shared: Vec<Vec<Tile>> = Vec::new();
        if phasors.len() > ROWS * width {
            shared.resize_with(self.orders.len(), Vec::new);
            for term in terms(phasors) {
                let tiles = &mut shared[term.column / components];
                fill_tiles(tiles, &term, 0..rows.angles.len());
            }
        }
        rows.fill(
            out,
            |rows_of| {
                let phasors = &phasors[rows_of.start * width..rows_of.end * width];
                Ok((phasors, terms(phasors)))
            },
            |(phasors, terms), range, outs| {
                let mut own: Vec<Vec<Tile>> = Vec::new();
                if shared.is_empty() {
                    own.resize_with(self.orders.len(), Vec::new);
                    for term in terms {
                        fill_tiles(&mut own[term.column / components], term, range.clone());
                    }
                }
                let (tiles, first) =
                    if own.is_empty() { (&shared, range.start / BLOCK) } else { (&own, 0) };
                // Terms of x and y (of torque and nothing), block by block.
                let along = |block: usize, component: usize| -> Vec<(&Term, &Column)> {
                    let along = terms.iter().filter(|term| term.column % components == component);
                    let column = |term: &Term| {
                        let tile = tiles[term.column / components].get(first + block)?;
                        Some(if term.sine { &tile.sin } else { &tile.cos })
                    };
                    along.filter_map(|term| Some((term, column(term)?))).collect()
                };
                let blocks = 0..range.len().div_ceil(BLOCK);
                let blocks: Vec<_> = blocks.map(|block| [0, 1].map(|k| along(block, k))).collect();
                vectorised(
                    #[inline(always)]
                    || {
                        for (phasors, out) in phasors.chunks_exact(width).zip(outs) {
                            let parts = out.chunks_mut(BLOCK * components);
                            for ([x, y], out) in blocks.iter().zip(parts) {
                                if components == 2 {
                                    write_pairs(1.0, &sum(x, phasors), &sum(y, phasors), out);
                                } else {
                                    out.copy_from_slice(&sum(x, phasors)[..out.len()]);
                                }
                            }
                        }
                    },
                );
            },
        )
    }

    fn by_kinematics(&self, quantity: Quantity, rows: &Rows, out: &mut [f64]) -> Result<()> {
        if self.spectrum.is_some() {
            let cure = "exact kinematics needs the slider-crank; sum orders";
            return Err(Error::value("spectrum", "given", cure));
        }
        let [_, angles, ratios, offsets, speeds] = self.shape();
        let list = |values: &Option<Vec<f64>>, k: usize| values.as_ref().map(|values| values[k]);
        rows.fill(
            out,
            |rows_of| {
                let mut placed: Vec<Placed> = Vec::new();
                let mut last = None;
                for row in rows_of {
                    let (point, speed) = (row / speeds, row % speeds);
                    let (place, point) = (point / (ratios * offsets), point % (ratios * offsets));
                    if last.is_none_or(|(before, _)| before != place) {
                        placed.push(self.placed(place / angles, place % angles)?);
                    }
                    let Some(here) = placed.last_mut() else { continue };
                    if last != Some((place, point)) {
                        let ratio = list(&self.axes.rod_ratio, point / offsets);
                        let offset = list(&self.axes.pin_offset, point % offsets);
                        let groups = here.kinematics.groups.iter();
                        let cranks =
                            groups.map(|alike| proportions(&alike.cylinder, ratio, offset));
                        here.points.push((cranks.collect::<Result<_>>()?, Vec::new()));
                    }
                    let Some((_, squares)) = here.points.last_mut() else { continue };
                    squares.push(self.squares[speed]);
                    last = Some((place, point));
                }
                Ok(placed)
            },
            |placed, range, mut outs| {
                vectorised(
                    #[inline(always)]
                    || {
                        let mut units = Units::START;
                        for (k, part) in parts(range, BLOCK).enumerate() {
                            rows.angles.multiples(1, part, &mut units.cos[..], &mut units.sin[..]);
                            let size = BLOCK * rows.components;
                            let mut outs =
                                outs.iter_mut().filter_map(|out| out.chunks_mut(size).nth(k));
                            for here in placed {
                                match quantity {
                                    Quantity::Torque => here.torque(&units, &mut outs),
                                    Quantity::Force => here.planar(0, &units, &mut outs),
                                    Quantity::Moment => here.planar(1, &units, &mut outs),
                                }
                            }
                        }
                    },
                );
            },
        )
    }

    /// An engine with one of the swept bank angles.
    fn placed(&self, engine: usize, angle: usize) -> Result<Placed> {
        let reference = self.references[engine];
        let engine = &self.engines[engine];
        let kinematics = match &self.axes.bank_angle {
            Some((angles, hold)) => {
                let turned = engine.with_bank_angle(Angle::from_degrees(angles[angle])?, *hold)?;
                Kinematics::new(turned.placements(), reference)
            }
            None => Kinematics::new(engine.placements(), reference),
        };
        Ok(Placed { kinematics, points: Vec::new() })
    }
}

/// Rows of a result: one for each point at a speed, over crank angle.
struct Rows<'a> {
    angles: &'a CrankAngles,
    /// Numbers to an angle.
    components: usize,
    cancel: &'a Cancel,
}

impl Rows<'_> {
    /// Prepare some rows, then work out spans of their angles; in parallel where there is enough.
    ///
    /// No value depends on how the work is split.
    fn fill<P: Sync>(
        &self,
        out: &mut [f64],
        prepare: impl Fn(Range<usize>) -> Result<P> + Sync,
        work: impl Fn(&P, Range<usize>, Vec<&mut [f64]>) + Sync,
    ) -> Result<()> {
        let row = self.angles.len() * self.components;
        if row == 0 || out.is_empty() {
            return Ok(());
        }
        let large = out.len() >= WORTH_A_THREAD;
        let parts: Vec<Range<usize>> = parts(0..self.angles.len(), SPAN).collect();
        self.cancel.expect((out.len() / row).div_ceil(ROWS) * parts.len());
        let part = |prepared: &P, part: usize, outs: Vec<&mut [f64]>| -> Result<()> {
            work(prepared, parts[part].clone(), outs);
            self.cancel.step()
        };
        let group = |(k, out): (usize, &mut [f64])| -> Result<()> {
            self.cancel.check()?;
            let prepared = prepare(k * ROWS..k * ROWS + out.len() / row)?;
            let mut by_part: Vec<Vec<&mut [f64]>> = parts.iter().map(|_| Vec::new()).collect();
            for out in out.chunks_mut(row) {
                let blocks = out.chunks_mut(SPAN * self.components);
                by_part.iter_mut().zip(blocks).for_each(|(outs, block)| outs.push(block));
            }
            if large {
                let tasks = by_part.into_par_iter().enumerate();
                return tasks.try_for_each(|(k, outs)| part(&prepared, k, outs));
            }
            by_part.into_iter().enumerate().try_for_each(|(k, outs)| part(&prepared, k, outs))
        };
        if large {
            return out.par_chunks_mut(ROWS * row).enumerate().try_for_each(group);
        }
        out.chunks_mut(ROWS * row).enumerate().try_for_each(group)
    }
}

// --- sums of orders -----------------------------------------------------------------------------

/// A part of a sum: real or imaginary part of the phasor in this column of a row.
struct Term {
    column: usize,
    sine: bool,
}

impl Term {
    /// Whether it is more than half a unit in the last place of the whole phasor.
    fn adds(&self, row: &[Complex64]) -> bool {
        self.weight(row).abs() > 0.5 * f64::EPSILON * row[self.column].norm()
    }

    /// By what cosine or sine is multiplied.
    #[inline(always)]
    fn weight(&self, row: &[Complex64]) -> f64 {
        let phasor = row[self.column];
        if self.sine { -phasor.im } else { phasor.re }
    }
}

/// Cosine and sine of nθ.
struct Tile {
    cos: Column,
    sin: Column,
}

impl Tile {
    fn new(angles: &CrankAngles, range: Range<usize>, order: u32) -> Self {
        let mut tile = Self { cos: Column::ZERO, sin: Column::ZERO };
        vectorised(
            #[inline(always)]
            || angles.multiples(order, range, &mut tile.cos[..], &mut tile.sin[..]),
        );
        tile
    }
}

/// Σ Re P·cos nθ − Im P·sin nθ of one row, four terms at a time.
#[inline(always)]
fn sum(terms: &[(&Term, &Column)], row: &[Complex64]) -> Column {
    let mut sum = Column::ZERO;
    let mut fours = terms.chunks_exact(4);
    for four in &mut fours {
        let [(a, p), (b, q), (c, r), (d, s)] = four else { continue };
        let [a, b, c, d] = [a, b, c, d].map(|term| term.weight(row));
        for i in 0..BLOCK {
            let ab = b.mul_add(q[i], a.mul_add(p[i], sum[i]));
            sum[i] = d.mul_add(s[i], c.mul_add(r[i], ab));
        }
    }
    for (term, column) in fours.remainder() {
        let weight = term.weight(row);
        for i in 0..BLOCK {
            sum[i] = weight.mul_add(column[i], sum[i]);
        }
    }
    sum
}

/// x and y, times a factor, in turns.
#[inline(always)]
fn write_pairs(factor: f64, x: &Column, y: &Column, out: &mut [f64]) {
    let (pairs, _) = out.as_chunks_mut::<2>();
    for (pair, (x, y)) in pairs.iter_mut().zip(x.iter().zip(&y[..])) {
        *pair = [factor * x, factor * y];
    }
}

// --- exact kinematics ---------------------------------------------------------------------------

/// An engine at one bank angle.
struct Placed {
    kinematics: Kinematics,
    /// Slider-cranks of its groups at a point of rod ratio and offset, and ω² of its rows.
    points: Vec<(Vec<Proportions>, Vec<f64>)>,
}

impl Placed {
    /// Force (0) or moment (1).
    #[inline(always)]
    fn planar<'o>(
        &self,
        which: usize,
        units: &Units,
        outs: &mut impl Iterator<Item = &'o mut [f64]>,
    ) {
        let cranks: Vec<Cranks> =
            self.kinematics.groups.iter().map(|alike| Cranks::new(alike, units)).collect();
        let (mut turning_x, mut turning_y) = (Column::ZERO, Column::ZERO);
        units.add_turning(self.kinematics.rotating[which], [&mut turning_x, &mut turning_y]);
        for (proportions, squares) in &self.points {
            let (mut x, mut y) = (turning_x.clone(), turning_y.clone());
            for ((alike, cranks), proportions) in
                self.kinematics.groups.iter().zip(&cranks).zip(proportions)
            {
                let along = alike.along[which];
                for i in 0..BLOCK {
                    let acceleration = proportions.motion_at(&cranks.at(i)).acceleration;
                    x[i] = along.re.mul_add(acceleration, x[i]);
                    y[i] = along.im.mul_add(acceleration, y[i]);
                }
            }
            for (&square, out) in squares.iter().zip(&mut *outs) {
                write_pairs(square, &x, &y, out);
            }
        }
    }

    /// Roll torque on the block.
    #[inline(always)]
    fn torque<'o>(&self, units: &Units, outs: &mut impl Iterator<Item = &'o mut [f64]>) {
        let cranks: Vec<Cranks> =
            self.kinematics.groups.iter().map(|alike| Cranks::new(alike, units)).collect();
        for (proportions, squares) in &self.points {
            let mut roll = Column::ZERO;
            for ((alike, cranks), proportions) in
                self.kinematics.groups.iter().zip(&cranks).zip(proportions)
            {
                for (i, roll) in roll.iter_mut().enumerate() {
                    let motion = proportions.motion_at(&cranks.at(i));
                    let torque = alike.torque * motion.acceleration;
                    *roll = torque.mul_add(motion.velocity + proportions.offset, *roll);
                }
            }
            for (&square, out) in squares.iter().zip(&mut *outs) {
                for (out, roll) in out.iter_mut().zip(&roll[..]) {
                    *out = square * roll;
                }
            }
        }
    }
}

/// Where the cranks of cylinders that move alike stand.
struct Cranks {
    sin: Column,
    cos: Column,
    squared: Column,
    to_above: Column,
    to_below: Column,
}

impl Cranks {
    #[inline(always)]
    fn new(alike: &Alike, units: &Units) -> Self {
        let mut cranks = Self {
            sin: Column::ZERO,
            cos: Column::ZERO,
            squared: Column::ZERO,
            to_above: Column::ZERO,
            to_below: Column::ZERO,
        };
        for i in 0..BLOCK {
            let crank = units.crank(alike.phase, i);
            cranks.sin[i] = crank.sin;
            cranks.cos[i] = crank.cos;
            cranks.squared[i] = crank.squared;
            cranks.to_above[i] = crank.to_above;
            cranks.to_below[i] = crank.to_below;
        }
        cranks
    }

    #[inline(always)]
    fn at(&self, i: usize) -> Crank {
        Crank {
            sin: self.sin[i],
            cos: self.cos[i],
            squared: self.squared[i],
            to_above: self.to_above[i],
            to_below: self.to_below[i],
        }
    }
}
