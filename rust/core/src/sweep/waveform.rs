//! Waveforms of every point of a sweep: sums of orders, or exact kinematics.

use std::ops::Range;

use rayon::prelude::*;

use super::harmonics::proportions;
use super::placed::Placed;
use super::run::Cost;
use super::tiles::{TILE, Term, Tiles};
use super::{Figure, Quantity, Sweep};
use crate::Complex64;
use crate::angle::Angle;
use crate::cancel::Cancel;
use crate::crank_angles::{CrankAngles, parts};
use crate::error::{Error, Result};
use crate::kinematics::{BLOCK, Kinematics, Units};
use crate::limits;
use crate::simd::vectorised;

/// Points, each at a speed, that share a tile of cosines and sines.
const ROWS: usize = 128;
/// Crank angles of a task: a stretch of memory long enough that the processor foresees it.
const SPAN: usize = 4 * TILE;
/// A result of fewer numbers is not worth waking another thread for (some 30 µs).
const WORTH_A_THREAD: usize = 1 << 15;

/// What cylinders that move alike and an order of a sum take, in nanoseconds for an angle of a
/// point: slopes from 1 to 8 groups and from 1 to 16 orders, 300 points of 720 angles on one core
/// (AMD EPYC, AVX-512).
const COST: [f64; 2] = [1.0, 0.35];
/// What a rod's inertia adds to the first, of force, moment and torque on average: it is in torque.
const COST_OF_ROD: f64 = 0.3;

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
        let of_rod = if self.torque { COST_OF_ROD } else { 0.0 };
        let cost = |engine: &crate::Engine| {
            Kinematics::new(engine.placements(), 0.0).cost(COST[0], of_rod)
        };
        let kinematics: f64 = self.engines.iter().map(|engine| cost(engine)).sum();
        let orders = self.engines.len() * self.orders.len();
        self.spectrum.is_none() && kinematics <= COST[1] * orders as f64
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
        if self.orders.is_empty() {
            out.fill(0.0);
            return Ok(());
        }
        self.check_size(quantity, Figure::Amplitude, size_of::<Complex64>())?;
        let phasors = self.result_shape(quantity, Figure::Amplitude).iter().product();
        let mut phasors = vec![Complex64::default(); phasors];
        let cost = if out.len() < WORTH_A_THREAD { Cost::Small } else { Cost::Awake };
        self.write_phasors_of(quantity, cost, &mut phasors, cancel)?;
        self.by_orders(&phasors, &rows, out)
    }

    fn by_orders(&self, phasors: &[Complex64], rows: &Rows, out: &mut [f64]) -> Result<()> {
        let (orders, components) = (self.orders.len(), rows.components);
        let width = orders * components;
        let tiles = |range: &Range<usize>, terms: &[Term]| {
            Tiles::new(rows.angles, range, &self.orders, terms)
        };
        // Of fewer rows than share a tile each is used once, and not worth keeping.
        let shared = (phasors.chunks_exact(width).len() > ROWS)
            .then(|| tiles(&(0..rows.angles.len()), &Term::of(phasors, orders, components)));
        rows.fill(
            out,
            |rows_of| {
                let phasors = &phasors[rows_of.start * width..rows_of.end * width];
                Ok((phasors, Term::of(phasors, orders, components)))
            },
            |(phasors, terms), range, outs| {
                let own = shared.is_none().then(|| tiles(&range, terms));
                let (tiles, first) = match &shared {
                    Some(tiles) => (Some(tiles), range.start / TILE),
                    None => (own.as_ref(), 0),
                };
                let Some(tiles) = tiles else { return };
                vectorised(
                    #[inline(always)]
                    || {
                        for (row, out) in phasors.chunks_exact(width).zip(outs) {
                            if components == 2 {
                                tiles.sum::<2>(terms, row, first, out);
                            } else {
                                tiles.sum::<1>(terms, row, first, out);
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
                                    Quantity::Torque => here.torque(false, &units, &mut outs),
                                    Quantity::CrankTorque => here.torque(true, &units, &mut outs),
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
        if out.is_empty() {
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::kinematics::tests::unlike;
    use crate::sweep::Axes;

    #[test]
    fn whoever_stops_waiting_at_any_step_is_told_at_once() {
        // Three groups of rows of two spans each.
        let angles = CrankAngles::new(&[0.0; SPAN + 1]).unwrap();
        let mut out = vec![0.0; 3 * ROWS * angles.len()];
        let mut run = |last: usize| {
            let (cancel, steps) = (Cancel::new(), AtomicUsize::new(0));
            let rows = Rows { angles: &angles, components: 1, cancel: &cancel };
            let work = |(): &(), _: Range<usize>, _: Vec<&mut [f64]>| {
                if steps.fetch_add(1, Ordering::Relaxed) + 1 == last {
                    cancel.raise();
                }
            };
            let result = rows.fill(&mut out, |_| Ok(()), work);
            (result, steps.into_inner(), cancel.progress().1)
        };
        assert_eq!(run(0), (Ok(()), 6, 6));
        for last in 1..=6 {
            let (result, steps, _) = run(last);
            assert_eq!(result, Err(Error::Cancelled));
            // Threads that were at work finish their step.
            assert!((last..=last + rayon::current_num_threads()).contains(&steps));
        }
    }

    #[test]
    fn a_group_is_worth_as_many_orders_as_it_costs() {
        let axes = Axes { rpm: vec![3000.0], ..Axes::default() };
        let engine = |groups| Arc::new(unlike(groups));
        for groups in 1..8 {
            let worth = (f64::from(groups) * COST[0] / COST[1]).ceil() as u32;
            for (orders, expected) in [(worth, true), (worth - 1, false)] {
                if orders == 0 {
                    continue;
                }
                // Three engines are as one.
                for count in [1, 3] {
                    let engines = (0..count).map(|_| engine(groups)).collect();
                    let orders: Vec<u32> = (1..=orders).collect();
                    let cancel = Cancel::new();
                    let sweep = Sweep::new(engines, axes.clone(), orders, None, None, &cancel);
                    assert_eq!(sweep.unwrap().kinematics_cost_less(), expected, "{groups}");
                }
            }
        }
    }
}
