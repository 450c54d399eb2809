//! Waveforms of every point of a sweep: sums of orders, or exact kinematics.

use std::ops::Range;

use super::placed::EngineAtBankAngle;
use super::tiles::{OrderWave, TILE, Tiles};
use super::{Selection, Statistic, Sweep};
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::{CrankAngles, parts};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::pool;
use crate::numbers::simd::vectorised;
use crate::readings::quantity::Quantity;
use crate::source::over_angle::{AngleBlock, BLOCK};

/// Points that share a tile of cosines and sines.
const ROWS: usize = 128;
/// Crank angles of a task: a stretch of memory long enough that the processor foresees it.
const SPAN: usize = 4 * TILE;

impl Sweep {
    /// Lengths of the axes of [`Self::waveforms`], if there is room for so much.
    pub fn waveform_shape(&self, quantity: Quantity, angles: usize) -> Result<Vec<usize>> {
        let shape = [&self.shape()[..], &[angles], quantity.shape()].concat();
        let hint = "split theta_deg, or give an axis of the sweep in parts";
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
        let rows = RowsOverAngle { angles, components: quantity.components(), cancel };
        self.at_each_speed(
            quantity,
            angles.len() * rows.components,
            out,
            cancel,
            |selection, out, factor| {
                if exact {
                    self.by_kinematics(selection, &rows, factor, out)
                } else {
                    self.by_orders(selection, &rows, factor, out)
                }
            },
        )
    }

    /// Rows times a factor, of which what scales otherwise has none.
    fn by_orders(
        &self,
        selection: Selection,
        rows: &RowsOverAngle,
        factor: f64,
        out: &mut [f64],
    ) -> Result<()> {
        let (orders, components) = (self.orders.len(), rows.components);
        let width = orders * components;
        let mut means: Vec<f64> = memory::zeros(self.rows_of(selection))?;
        self.mean_rows(selection, &mut means, factor, rows.cancel)?;
        if width == 0 {
            out.fill(0.0); // a buffer that was given, or never written to
            return rows.add(&means, out);
        }
        let mut phasors: Vec<Complex64> = memory::zeros(self.rows_of(selection) * width)?;
        self.phasor_rows((selection, Statistic::Amplitude), &mut phasors, factor, rows.cancel)?;
        let phasors = &phasors[..];
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
                let Some(tiles) = tiles else { return Ok(()) };
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
                Ok(())
            },
        )?;
        rows.add(&means, out)
    }

    fn by_kinematics(
        &self,
        selection: Selection,
        rows: &RowsOverAngle,
        factor: f64,
        out: &mut [f64],
    ) -> Result<()> {
        if self.engines.iter().any(|engine| engine.spectrum().is_some()) {
            let hint = "exact kinematics needs the slider-crank; sum orders";
            return Err(Error::value("spectrum", "given", hint));
        }
        let (angles, points) = (self.bank_angles().len(), self.points_of(selection));
        rows.fill(
            out,
            |rows_of| {
                let mut placed: Vec<EngineAtBankAngle> = Vec::new();
                let mut last = None;
                for row in rows_of {
                    let (place, point) = (row / points, row % points);
                    if last != Some(place) {
                        placed.push(self.placed(place / angles, place % angles)?);
                        last = Some(place);
                    }
                    let Some(here) = placed.last_mut() else { continue };
                    let sources = self.placed_point(&here.kinematics, selection, point)?;
                    here.points.push(sources);
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
                            let block = AngleBlock::new(rows.angles, part).shared();
                            for here in placed {
                                here.write(selection, factor, &block, &mut outs)?;
                            }
                        }
                        Ok(())
                    },
                )
            },
        )
    }
}

/// Rows over crank angle: one for each engine, bank angle and point.
struct RowsOverAngle<'a> {
    angles: &'a CrankAngles,
    /// Numbers to an angle.
    components: usize,
    cancel: &'a Cancel,
}

impl RowsOverAngle<'_> {
    /// Adds the mean of each row, if it has any.
    fn add(&self, means: &[f64], out: &mut [f64]) -> Result<()> {
        let rows = out.chunks_mut(self.angles.len().max(1));
        for (&mean, row) in means.iter().zip(rows).filter(|(mean, _)| **mean != 0.0) {
            self.cancel.check()?;
            for torque in row {
                *torque += mean;
            }
        }
        Ok(())
    }

    /// Prepares some rows, then evaluates spans of their angles; in parallel where there is enough.
    ///
    /// No value depends on how the work is split.
    fn fill<P: Sync>(
        &self,
        out: &mut [f64],
        prepare: impl Fn(Range<usize>) -> Result<P> + Sync,
        work: impl Fn(&P, Range<usize>, Vec<&mut [f64]>) -> Result<()> + Sync,
    ) -> Result<()> {
        let row = self.angles.len() * self.components;
        if out.is_empty() {
            return Ok(());
        }
        let numbers = out.len();
        let parts: Vec<Range<usize>> = parts(0..self.angles.len(), SPAN).collect();
        let groups = memory::collected(out.chunks_mut(ROWS * row).enumerate())?;
        self.cancel.expect(groups.len() * parts.len());
        let group = |(k, out): (usize, &mut [f64])| -> Result<()> {
            self.cancel.check()?;
            let prepared = prepare(k * ROWS..k * ROWS + out.len() / row)?;
            let mut by_part: Vec<Vec<&mut [f64]>> = parts.iter().map(|_| Vec::new()).collect();
            for out in out.chunks_mut(row) {
                let blocks = out.chunks_mut(SPAN * self.components);
                by_part.iter_mut().zip(blocks).for_each(|(outs, block)| outs.push(block));
            }
            let tasks = parts.iter().zip(by_part).collect();
            pool::each(self.cancel, tasks, numbers, |(part, outs)| {
                work(&prepared, part.clone(), outs)?;
                self.cancel.step()
            })
        };
        pool::each(self.cancel, groups, numbers, group)
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
            let rows = RowsOverAngle { angles: &angles, components: 1, cancel: &cancel };
            let work = |(): &(), _: Range<usize>, _: Vec<&mut [f64]>| {
                if steps.fetch_add(1, Ordering::Relaxed) + 1 == last {
                    cancel.raise();
                }
                Ok(())
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
