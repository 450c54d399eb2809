//! Rows of a sweep at its speeds and loads.
//!
//! A row without either is evaluated once; at a speed it is multiplied by ω². Torque of pressure does not
//! scale so: rows of it, one for each cycle of a map, are interpolated as the cycles are, linearly over
//! speed and then over load, and added.

use super::axes::SweepAxes;
use super::kernel::{Number, ROWS_PER_TASK};
use super::{Quantity, Sweep};
use crate::Complex64;
use crate::load::source::Scaling;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::pool;
use crate::numbers::simd::{MultiplyAdd, vectorised};
use crate::pressure::map::{Between, between};
use crate::readings::balance::TorquePart;

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

/// Rows of inertia and of pressure, and what they become at each speed and load.
pub(super) struct Operating<'a, T> {
    sweep: &'a Sweep,
    /// Rows over ω², by engine, bank angle and point; none where only pressure counts.
    inertia: Vec<T>,
    /// The same of pressure, one for each cycle; none where inertia alone counts.
    gas: Vec<T>,
    width: usize,
}

/// Room for a row, and for what those at one speed share.
struct Room<T> {
    row: Vec<T>,
    at_speed: AtSpeed<T>,
}

/// Rows of pressure interpolated over speed, one for each load of a map.
#[derive(Default)]
struct AtSpeed<T> {
    rows: Vec<T>,
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
    /// Writes rows at every speed and load; `evaluate` writes those of a quantity over ω², times a factor.
    pub(super) fn at_each_speed<T: Number>(
        &self,
        quantity: Quantity,
        width: usize,
        out: &mut [T],
        cancel: &Cancel,
        evaluate: impl Fn(Quantity, &mut [T], f64) -> Result<()>,
    ) -> Result<()> {
        if out.is_empty() {
            return Ok(());
        }
        if let [square] = self.squares[..]
            && self.nodes.loads() == 1
            && !self.has_gas(quantity)
        {
            return evaluate(quantity, out, square);
        }
        self.operating(quantity, width, evaluate)?.write(out, cancel)
    }

    /// Rows of a quantity before they are written at every speed and load.
    pub(super) fn operating<T: Number>(
        &self,
        quantity: Quantity,
        width: usize,
        evaluate: impl Fn(Quantity, &mut [T], f64) -> Result<()>,
    ) -> Result<Operating<'_, T>> {
        let rows = |quantity: Quantity| {
            let mut rows = memory::zeros(self.rows_of(quantity) * width)?;
            evaluate(quantity, &mut rows, 1.0)?;
            Ok(rows)
        };
        let (inertia, gas) = if self.has_gas(quantity) {
            let whole = quantity.part() == Some(TorquePart::Whole);
            let inertia = whole.then(|| rows(quantity.with_part(TorquePart::Inertia)));
            (inertia.transpose()?, Some(rows(quantity.with_part(TorquePart::Gas))?))
        } else {
            (Some(rows(quantity)?), None)
        };
        let [inertia, gas] = [inertia, gas].map(Option::unwrap_or_default);
        Ok(Operating { sweep: self, inertia, gas, width })
    }

    /// Number of rows of a quantity without speed and load.
    pub(super) fn rows_of(&self, quantity: Quantity) -> usize {
        self.engines.len() * self.bank_angles().len() * self.points_of(quantity)
    }

    /// Means of pressure's torque of every row.
    pub(super) fn mean_rows(
        &self,
        quantity: Quantity,
        out: &mut [f64],
        cancel: &Cancel,
    ) -> Result<()> {
        out.fill(0.0);
        if quantity.part() != Some(TorquePart::Gas) {
            return Ok(());
        }
        let on_crank = matches!(quantity, Quantity::CrankTorque(_));
        let (angles, points) = (self.bank_angles().len(), self.points_of(quantity));
        for (engine, out) in out.chunks_mut(angles * points).enumerate() {
            let loads = self.loads(engine);
            let volumes = loads.volumes();
            let mut means = memory::with_capacity(points)?;
            for point in 0..points {
                let mut mean = 0.0;
                for (source, volume) in
                    loads.at_point(&self.at(quantity, point))?.iter().zip(&volumes)
                {
                    if source.parts().scaling == Scaling::Given {
                        let means = source.torque(&[], cancel)?.mean;
                        mean += volume.value * means[usize::from(on_crank)];
                    }
                }
                means.push(mean);
            }
            for out in out.chunks_mut(points) {
                cancel.check()?;
                out.copy_from_slice(&means);
            }
        }
        Ok(())
    }
}

impl<T: Number> Operating<'_, T> {
    /// Writes every row at every speed and load.
    pub fn write(&self, out: &mut [T], cancel: &Cancel) -> Result<()> {
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
    fn row(&self, place: GridPoint, at_speed: &mut AtSpeed<T>, out: &mut [T]) -> Result<()> {
        let (nodes, width) = (&self.sweep.nodes, self.width);
        if self.inertia.is_empty() {
            out.fill(T::default());
        } else {
            let square = self.sweep.squares[place.speed];
            let row = &self.inertia[place.row * width..][..width];
            // Adding zero makes −0 0.
            out.iter_mut().zip(row).for_each(|(out, &value)| *out = value * square + T::default());
        }
        if self.gas.is_empty() {
            return Ok(());
        }
        if nodes.count() == 1 {
            add_scaled(out, &self.gas[place.row * width..][..width], 1.0);
            return Ok(());
        }
        if at_speed.place != Some((place.row, place.speed)) {
            self.interpolate(place, at_speed)?;
        }
        for (load, weight) in nodes.loads[place.load].weights() {
            if weight != 0.0 {
                add_scaled(out, &at_speed.rows[load * width..][..width], weight);
            }
        }
        Ok(())
    }

    /// Interpolates a row of pressure over speed.
    #[inline(always)]
    fn interpolate(&self, place: GridPoint, at_speed: &mut AtSpeed<T>) -> Result<()> {
        let (nodes, width) = (&self.sweep.nodes, self.width);
        if at_speed.rows.is_empty() {
            at_speed.rows = memory::zeros(nodes.loads_of_map * width)?;
        }
        at_speed.rows.fill(T::default());
        for (speed, weight) in nodes.speed_weights(place.speed) {
            if weight == 0.0 {
                continue;
            }
            for (load, out) in at_speed.rows.chunks_exact_mut(width.max(1)).enumerate() {
                let row = place.row * nodes.count() + speed * nodes.loads_of_map + load;
                add_scaled(out, &self.gas[row * width..][..width], weight);
            }
        }
        at_speed.place = Some((place.row, place.speed));
        Ok(())
    }

    /// Hands every row at every speed and load, room for one, and the place of its result to a function;
    /// a number of the result takes some `cost` times as long as a product.
    fn each<O: Send>(
        &self,
        out: &mut [O],
        width: usize,
        cost: usize,
        cancel: &Cancel,
        work: impl Fn(GridPoint, &mut Room<T>, &mut [O]) -> Result<()> + Sync,
    ) -> Result<()> {
        let (speeds, loads) = (self.sweep.squares.len(), self.sweep.nodes.loads());
        let rows =
            (NUMBERS_PER_TASK / (self.width.max(width) * cost).max(1)).clamp(1, ROWS_PER_TASK);
        let numbers = out.len() * cost;
        let pieces = memory::collected(out.chunks_mut(rows * width).enumerate())?;
        cancel.expect(pieces.len());
        let piece = |(k, out): (usize, &mut [O])| {
            let row: Vec<T> = memory::zeros(self.width)?;
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
fn add_scaled<T: Number>(out: &mut [T], row: &[T], weight: f64) {
    out.iter_mut().zip(row).for_each(|(out, &value)| *out = *out + value * weight);
}

impl Operating<'_, Complex64> {
    /// Writes the magnitudes of every row.
    pub fn magnitudes(&self, out: &mut [f64], cancel: &Cancel) -> Result<()> {
        self.each(
            out,
            self.width,
            1,
            cancel,
            #[inline(always)]
            |place, room, out| {
                self.row(place, &mut room.at_speed, &mut room.row)?;
                for (out, phasor) in out.iter_mut().zip(&room.row) {
                    *out = phasor.re.multiply_add(phasor.re, phasor.im * phasor.im).sqrt();
                }
                Ok(())
            },
        )
    }

    /// Writes a number found from every row of phasors and its mean.
    pub fn beside(
        &self,
        means: &Operating<'_, f64>,
        out: &mut [f64],
        cancel: &Cancel,
        find: impl Fn(&[Complex64], f64) -> Result<f64> + Sync,
    ) -> Result<()> {
        // A search for an extremum takes some hundred times as long.
        self.each(out, 1, 256, cancel, |place, room, out| {
            cancel.check()?;
            self.row(place, &mut room.at_speed, &mut room.row)?;
            let mut mean = [0.0];
            means.row(place, &mut AtSpeed::default(), &mut mean)?;
            out[0] = find(&room.row, mean[0])?;
            Ok(())
        })
    }
}
