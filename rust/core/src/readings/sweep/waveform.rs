//! Waveforms of every point of a sweep: sums of orders, or exact kinematics.

use std::ops::Range;

use rayon::prelude::*;

use super::placed::{Placed, PlacedPoint};
use super::tiles::{OrderWave, TILE, Tiles};
use super::{Figure, Quantity, Sweep};
use crate::Complex64;
use crate::gear::GearKind;
use crate::gear::slider_crank::Cylinder;
use crate::load::{Alike, Loads};
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::{CrankAngles, parts};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::pool;
use crate::numbers::simd::vectorised;
use crate::readings::kinematics::{BLOCK, Kinematics};

/// Points, each at a speed, that share a tile of cosines and sines.
const ROWS: usize = 128;
/// Crank angles of a task: a stretch of memory long enough that the processor foresees it.
const SPAN: usize = 4 * TILE;

impl Sweep {
    /// Lengths of the axes of [`Self::waveforms`], if there is room for so much.
    pub fn waveform_shape(&self, quantity: Quantity, angles: usize) -> Result<Vec<usize>> {
        let shape = [&self.shape()[..], &[angles], quantity.shape()].concat();
        let hint = "sweep one axis in parts, or split theta_deg";
        limits::result_size("sweep", &shape, size_of::<f64>(), hint)?;
        Ok(shape)
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
        self.check_known(quantity)?;
        let rows = Rows { angles, components: quantity.components(), cancel };
        if exact {
            return self.by_kinematics(quantity, &rows, out);
        }
        if self.orders.is_empty() {
            out.fill(0.0);
        } else {
            self.sum_orders(quantity, &rows, out)?;
        }
        if self.has_mean(quantity) {
            let mut means: Vec<f64> = memory::zeros(shape[..5].iter().product())?;
            self.write_peaks(quantity, Figure::Mean, &mut means, cancel)?;
            for (mean, row) in means.iter().zip(out.chunks_mut(angles.len().max(1))) {
                cancel.check()?;
                for torque in row {
                    *torque += mean;
                }
            }
        }
        Ok(())
    }

    fn sum_orders(&self, quantity: Quantity, rows: &Rows, out: &mut [f64]) -> Result<()> {
        self.check_size(quantity, Figure::Amplitude, size_of::<Complex64>())?;
        let phasors = self.result_shape(quantity, Figure::Amplitude).iter().product();
        let mut phasors: Vec<Complex64> = memory::zeros(phasors)?;
        self.write_phasors(quantity, Figure::Amplitude, &mut phasors, rows.cancel)?;
        self.by_orders(&phasors, rows, out)
    }

    fn by_orders(&self, phasors: &[Complex64], rows: &Rows, out: &mut [f64]) -> Result<()> {
        let (orders, components) = (self.orders.len(), rows.components);
        let width = orders * components;
        let tiles = |range: &Range<usize>, terms: &[OrderWave]| {
            Tiles::new(rows.angles, range, &self.orders, terms)
        };
        // Of fewer rows than share a tile each is used once, and not worth keeping.
        let shared = (phasors.chunks_exact(width).len() > ROWS)
            .then(|| tiles(&(0..rows.angles.len()), &OrderWave::of(phasors, orders, components)));
        rows.fill(
            out,
            |rows_of| {
                let phasors = &phasors[rows_of.start * width..rows_of.end * width];
                Ok((phasors, OrderWave::of(phasors, orders, components)))
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
        if self.engines.iter().any(|engine| engine.spectrum().is_some()) {
            let hint = "exact kinematics needs the slider-crank; sum orders";
            return Err(Error::value("spectrum", "given", hint));
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
                        let at = |cylinder: &Cylinder| cylinder.proportions_with(ratio, offset);
                        let pistons = here.kinematics.pistons.iter().map(|p| at(&p.cylinder));
                        let pressures = here.kinematics.pressures.iter();
                        let pressures = pressures.map(|pressures| match &pressures.gear.kind {
                            GearKind::SliderCrank { cylinder, .. } => at(cylinder),
                            GearKind::Given(_) => Ok(pressures.proportions),
                        });
                        here.points.push(PlacedPoint {
                            pistons: pistons.collect::<Result<_>>()?,
                            pressures: pressures.collect::<Result<_>>()?,
                            squares: Vec::new(),
                        });
                    }
                    let Some(rows) = here.points.last_mut() else { continue };
                    rows.squares.push(self.squares[speed]);
                    last = Some((place, point));
                }
                Ok(placed)
            },
            |placed, range, mut outs| {
                vectorised(
                    #[inline(always)]
                    || {
                        for (k, part) in parts(range, BLOCK).enumerate() {
                            let size = BLOCK * rows.components;
                            let mut outs =
                                outs.iter_mut().filter_map(|out| out.chunks_mut(size).nth(k));
                            for here in placed {
                                here.write(quantity, rows.angles, part.clone(), &mut outs);
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
        let loads = match &self.axes.bank_angle {
            Some((angles, hold)) => {
                let turned = engine.with_bank_angle(Angle::from_degrees(angles[angle])?, *hold)?;
                Loads::new(&turned, reference, Alike::Dimensions)
            }
            None => Loads::new(engine, reference, Alike::Dimensions),
        };
        Ok(Placed { kinematics: Kinematics::new(&loads), points: Vec::new() })
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
    /// Prepares some rows, then evaluates spans of their angles; in parallel where there is enough.
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
        let large = pool::worth(out.len());
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
            let groups = out.par_chunks_mut(ROWS * row).enumerate();
            return pool::run(self.cancel, || groups.try_for_each(group));
        }
        out.chunks_mut(ROWS * row).enumerate().try_for_each(group)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn cancellation_stops_at_the_next_step() {
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
}
