//! Rows of a sweep at its speeds and loads.
//!
//! A row without either is evaluated once for each group of loads; at a speed these are multiplied by what the group
//! scales with, such as ω², and added, as those of a balance are. Rows of what does not scale, one for each cycle
//! of a map, are interpolated as the cycles are, linearly over speed and then over load.

use std::sync::Arc;

use super::axes::SweepAxes;
use super::kernel::ROWS_PER_TASK;
use super::{Selection, Sweep};
use crate::load::{Group, GroupIndex, SourceIndex};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::index::List;
use crate::numbers::memory;
use crate::numbers::pool;
use crate::numbers::simd::vectorised;
use crate::pressure::map::{Between, between};
use crate::readings::quantity::{Kind, Quantity};
use crate::source::{INERTIA, Source, at_point};

/// Numbers written between two checks for cancellation, of rows that are long.
const NUMBERS_PER_TASK: usize = 1 << 16;

/// Places of a sweep's speeds and loads in its map of cycles; without one a single cycle of weight 1.
#[derive(Debug)]
pub(super) struct Nodes {
    loads_of_map: usize,
    speeds_of_map: usize,
    /// One for each speed, or none.
    speeds: Vec<Between>,
    loads: Vec<Between>,
}

impl Nodes {
    pub fn new(axes: &SweepAxes, cancel: &Cancel) -> Result<Self> {
        let Some(map) = &axes.map else {
            return Ok(Self {
                loads_of_map: 1,
                speeds_of_map: 1,
                speeds: vec![],
                loads: vec![Between::default()],
            });
        };
        Ok(Self {
            loads_of_map: map.loads.len(),
            speeds_of_map: map.rpm.len(),
            speeds: between("rpm", &map.rpm, &axes.rpm, cancel)?,
            loads: between("load", &map.loads, &map.load, cancel)?,
        })
    }

    /// Number of cycles.
    pub fn count(&self) -> usize {
        self.speeds_of_map * self.loads_of_map
    }

    /// Number of loads swept.
    pub fn loads(&self) -> usize {
        self.loads.len()
    }

    /// Speeds of the map and their weights at a speed.
    fn speed_weights(&self, speed: usize) -> [(usize, f64); 2] {
        self.speeds.get(speed).copied().unwrap_or_default().weights()
    }
}

/// Rows of each group, and what they become at each speed and load.
pub(super) struct RowsAtSpeeds<'a> {
    sweep: &'a Sweep,
    scaled: Vec<ScaledRows>,
    width: usize,
}

/// Rows by engine, bank angle and point, over what they scale with.
struct ScaledRows {
    rows: Vec<f64>,
    /// By speed.
    factors: Vec<f64>,
    /// Whether there is one for each cycle of a map.
    by_cycle: bool,
}

/// Room for a row, and for what those at one speed share.
struct Room {
    row: Vec<f64>,
    at_speed: AtSpeed,
}

/// Rows interpolated over speed, one for each load of a map.
#[derive(Default)]
struct AtSpeed {
    rows: Vec<f64>,
    /// Of which row, at which speed.
    place: Option<(usize, usize)>,
}

/// A row at a speed and a load.
#[derive(Clone, Copy)]
struct GridPoint {
    row: usize,
    speed: usize,
    load: usize,
}

impl Sweep {
    /// Writes rows at every speed and load; `evaluate` writes those of a quantity over what it scales with, times a
    /// factor.
    pub(super) fn at_each_speed(
        &self,
        quantity: Quantity,
        width: usize,
        out: &mut [f64],
        cancel: &Cancel,
        evaluate: impl Fn(Selection, &mut [f64], f64) -> Result<()>,
    ) -> Result<()> {
        match self.only_factor(quantity) {
            _ if out.is_empty() => Ok(()),
            Some(factor) => evaluate(Selection { quantity, group: None }, out, factor),
            None => self.operating(quantity, width, evaluate)?.write(out, cancel),
        }
    }

    /// What all that makes a quantity is multiplied by, at the only speed and load.
    pub(super) fn only_factor(&self, quantity: Quantity) -> Option<f64> {
        let [omega] = self.omegas[..] else { return None };
        (self.nodes.loads() == 1 && self.is_of_one_square(quantity)).then_some(omega * omega)
    }

    /// Rows of a quantity before they are written at every speed and load.
    pub(super) fn operating(
        &self,
        quantity: Quantity,
        width: usize,
        evaluate: impl Fn(Selection, &mut [f64], f64) -> Result<()>,
    ) -> Result<RowsAtSpeeds<'_>> {
        let scaled = |group: &Group| {
            let selection = Selection { quantity, group: Some(group) };
            let mut rows = memory::zeros(self.rows_of(selection) * width)?;
            evaluate(selection, &mut rows, 1.0)?;
            let mut factors = memory::with_capacity(self.omegas.len())?;
            factors.extend(self.omegas.iter().map(|&omega| group.scaling.factor(omega)));
            Ok(ScaledRows { rows, factors, by_cycle: self.cycles_of(selection) > 1 })
        };
        let scaled = self.groups_of(quantity).map(scaled).collect::<Result<_>>()?;
        Ok(RowsAtSpeeds { sweep: self, scaled, width })
    }

    /// Number of rows of a selection without speed and load.
    pub(super) fn rows_of(&self, selection: Selection) -> usize {
        self.engines.len() * self.bank_angles().len() * self.points_of(selection)
    }

    /// Mean torques of every row, times a factor.
    pub(super) fn mean_rows(
        &self,
        selection: Selection,
        out: &mut [f64],
        factor: f64,
        cancel: &Cancel,
    ) -> Result<()> {
        out.fill(0.0);
        let quantity = selection.quantity;
        if quantity.is_planar() {
            return Ok(());
        }
        let on_crank = usize::from(quantity.kind == Kind::CrankTorque);
        let (angles, points) = (self.bank_angles().len(), self.points_of(selection));
        for (loads, out) in self.loads.iter().zip(out.chunks_mut(angles * points)) {
            let has_mean = |group: &Group| selection.has(group) && *group.name != *INERTIA;
            let mut means = memory::with_capacity(points)?;
            for point in 0..points {
                let at = self.at(selection, point);
                let own = |(source, group): (&Arc<dyn Source>, &GroupIndex)| {
                    if !source.parts().roll || !has_mean(&loads.groups[*group]) {
                        return Ok(0.0);
                    }
                    Ok(at_point(source, &at)?.torque(&self.orders, cancel)?.mean[on_crank])
                };
                let own: List<SourceIndex, f64> =
                    loads.sources.iter().zip(&loads.group_of).map(own).collect::<Result<_>>()?;
                let all = loads.list.iter().map(|load| load.roll * own[load.source]);
                let mean = all.fold(0.0, |sum, own| sum + own);
                means.push(factor * mean);
            }
            for out in out.chunks_mut(points) {
                cancel.check()?;
                out.copy_from_slice(&means);
            }
        }
        Ok(())
    }
}

impl RowsAtSpeeds<'_> {
    /// Writes every row at every speed and load.
    pub fn write(&self, out: &mut [f64], cancel: &Cancel) -> Result<()> {
        self.each(
            out,
            self.width,
            1,
            cancel,
            #[inline(always)]
            |place, room, out| self.row(place, &mut room.at_speed, out),
        )
    }

    /// Writes one row at a speed and a load.
    #[inline(always)]
    fn row(&self, place: GridPoint, at_speed: &mut AtSpeed, out: &mut [f64]) -> Result<()> {
        let (nodes, width) = (&self.sweep.nodes, self.width);
        let mut is_first = true;
        for scaled in &self.scaled {
            if scaled.by_cycle {
                if is_first {
                    out.fill(0.0);
                }
                if at_speed.place != Some((place.row, place.speed)) {
                    self.interpolate(scaled, place, at_speed)?;
                }
                for (load, weight) in nodes.loads[place.load].weights() {
                    if weight != 0.0 {
                        add_scaled(out, &at_speed.rows[load * width..][..width], weight);
                    }
                }
            } else {
                let (factor, row) =
                    (scaled.factors[place.speed], &scaled.rows[place.row * width..]);
                if is_first {
                    // Adding zero makes −0 0.
                    let values = out.iter_mut().zip(row);
                    values.for_each(|(out, &value)| *out = value * factor + 0.0);
                } else {
                    add_scaled(out, &row[..width], factor);
                }
            }
            is_first = false;
        }
        if is_first {
            out.fill(0.0);
        }
        Ok(())
    }

    /// Interpolates a row over speed.
    #[inline(always)]
    fn interpolate(
        &self,
        scaled: &ScaledRows,
        place: GridPoint,
        at_speed: &mut AtSpeed,
    ) -> Result<()> {
        let (nodes, width) = (&self.sweep.nodes, self.width);
        if at_speed.rows.is_empty() {
            at_speed.rows = memory::zeros(nodes.loads_of_map * width)?;
        }
        at_speed.rows.fill(0.0);
        for (speed, weight) in nodes.speed_weights(place.speed) {
            if weight == 0.0 {
                continue;
            }
            for (load, out) in at_speed.rows.chunks_exact_mut(width.max(1)).enumerate() {
                let row = place.row * nodes.count() + speed * nodes.loads_of_map + load;
                add_scaled(out, &scaled.rows[row * width..][..width], weight);
            }
        }
        at_speed.place = Some((place.row, place.speed));
        Ok(())
    }

    /// Hands every row at every speed and load, its mean, and the place of its result, of `width` numbers, to a
    /// function; a number of the result takes some `cost` times as long as a product.
    pub fn finish<O: Send>(
        &self,
        means: Option<&Self>,
        (out, width, cost): (&mut [O], usize, usize),
        cancel: &Cancel,
        finish: impl Fn(&[f64], f64, &mut [O]) -> Result<()> + Sync,
    ) -> Result<()> {
        self.each(
            out,
            width,
            cost,
            cancel,
            #[inline(always)]
            |place, room, out| {
                self.row(place, &mut room.at_speed, &mut room.row)?;
                let mut mean = [0.0];
                if let Some(means) = means {
                    means.row(place, &mut AtSpeed::default(), &mut mean)?;
                }
                finish(&room.row, mean[0], out)
            },
        )
    }

    /// Hands every row at every speed and load, room for one, and the place of its result to a function;
    /// a number of the result takes some `cost` times as long as a product.
    fn each<O: Send>(
        &self,
        out: &mut [O],
        width: usize,
        cost: usize,
        cancel: &Cancel,
        work: impl Fn(GridPoint, &mut Room, &mut [O]) -> Result<()> + Sync,
    ) -> Result<()> {
        let (speeds, loads) = (self.sweep.omegas.len(), self.sweep.nodes.loads());
        let rows =
            (NUMBERS_PER_TASK / (self.width.max(width) * cost).max(1)).clamp(1, ROWS_PER_TASK);
        let numbers = out.len() * cost;
        let pieces = memory::collected(out.chunks_mut((rows * width).max(1)).enumerate())?;
        cancel.expect(pieces.len());
        let piece = |(k, out): (usize, &mut [O])| {
            let row = memory::zeros(self.width)?;
            let mut room = Room { row, at_speed: AtSpeed::default() };
            let at = k * rows;
            let mut place = GridPoint {
                row: at / loads / speeds,
                speed: at / loads % speeds,
                load: at % loads,
            };
            vectorised(
                #[inline(always)]
                || {
                    for out in out.chunks_exact_mut(width) {
                        work(place, &mut room, out)?;
                        place.load += 1;
                        if place.load == loads {
                            (place.load, place.speed) = (0, place.speed + 1);
                            if place.speed == speeds {
                                (place.speed, place.row) = (0, place.row + 1);
                            }
                        }
                    }
                    Ok(())
                },
            )?;
            cancel.step()
        };
        pool::each(cancel, pieces, numbers, piece)
    }
}

/// Adds a row times a weight.
#[inline(always)]
fn add_scaled(out: &mut [f64], row: &[f64], weight: f64) {
    out.iter_mut().zip(row).for_each(|(out, &value)| *out += value * weight);
}
