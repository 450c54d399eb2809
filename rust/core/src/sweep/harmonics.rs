//! What a sweep's rod ratios and offsets change: the harmonics of its cylinders.

use std::borrow::Cow;
use std::ops::Range;

use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView1, Axis};

use super::{Quantity, Sweep};
use crate::Complex64;
use crate::cancel::Cancel;
use crate::error::{Error, Result};
use crate::harmonics::{self, table, torque};
use crate::slider_crank::{Cylinder, Proportions};

/// Points whose harmonics are worked out in one piece.
const CHUNK: usize = 1024;
/// Bytes of harmonics that are kept.
const LARGEST_TABLE: usize = 1 << 28;

/// A cylinder's proportions with rod ratio and pin offset replaced.
pub(super) fn proportions(
    cylinder: &Cylinder,
    rod_ratio: Option<f64>,
    pin_offset: Option<f64>,
) -> Result<Proportions> {
    let offset = pin_offset.unwrap_or(cylinder.pin_offset());
    let radius = cylinder.crank_radius();
    match rod_ratio {
        Some(ratio) => Proportions::new(ratio, offset / radius),
        None => Cylinder::new(radius, cylinder.rod_length(), 0.0, offset).map(|c| c.proportions()),
    }
}

/// Harmonics of one cylinder at the points of a sweep.
pub(super) enum Harmonics {
    /// All of them, or the one row that serves every point.
    Table(Array2<Complex64>),
    /// Worked out where they are wanted.
    Later(Cylinder, Quantity),
}

/// Harmonics at some points: rows of (point, order).
pub(super) struct Rows<'a> {
    table: Cow<'a, Array2<Complex64>>,
    /// The point of the first row.
    first: usize,
}

impl Rows<'_> {
    #[inline(always)]
    pub fn at(&self, point: usize, order: usize) -> Complex64 {
        self.table[[point - self.first, order]]
    }
}

impl Harmonics {
    /// A table where the points are passed over more than once and it is of moderate size.
    pub fn new(
        sweep: &Sweep,
        cylinder: Cylinder,
        quantity: Quantity,
        passes: usize,
        cancel: &Cancel,
    ) -> Result<Self> {
        let (points, orders) = (sweep.points(), sweep.orders.len());
        if points == 1 {
            return sweep.harmonics(&cylinder, quantity, &(0..1), cancel).map(Self::Table);
        }
        if passes == 1 || points * orders * size_of::<Complex64>() > LARGEST_TABLE {
            return Ok(Self::Later(cylinder, quantity));
        }
        let mut table = Array2::default((points, orders));
        cancel.expect(points.div_ceil(CHUNK));
        table.axis_chunks_iter_mut(Axis(0), CHUNK).into_par_iter().enumerate().try_for_each(
            |(chunk, mut rows)| {
                cancel.step()?;
                let first = chunk * CHUNK;
                let points = first..first + rows.nrows();
                rows.assign(&sweep.harmonics(&cylinder, quantity, &points, cancel)?);
                Result::Ok(())
            },
        )?;
        Ok(Self::Table(table))
    }

    /// Those at a range of points.
    pub fn rows(&self, sweep: &Sweep, points: &Range<usize>, cancel: &Cancel) -> Result<Rows<'_>> {
        Ok(match self {
            Self::Table(table) => Rows { table: Cow::Borrowed(table), first: 0 },
            Self::Later(cylinder, quantity) => {
                let table = sweep.harmonics(cylinder, *quantity, points, cancel)?;
                Rows { table: Cow::Owned(table), first: points.start }
            }
        })
    }
}

impl Sweep {
    /// Harmonics of a cylinder at points of rod ratio and offset: (points, `n_orders`).
    fn harmonics(
        &self,
        cylinder: &Cylinder,
        quantity: Quantity,
        points: &Range<usize>,
        cancel: &Cancel,
    ) -> Result<Array2<Complex64>> {
        if let Some(spectrum) = &self.spectrum {
            if quantity.is_torque() {
                let cure = "a spectrum of forces tells nothing of torque; leave it out";
                return Err(Error::value("spectrum", "given", cure));
            }
            let row: Vec<_> = self.orders.iter().map(|&n| spectrum.amplitude(n)).collect();
            return Ok(Array2::from_shape_fn((1, row.len()), |(_, order)| row[order]));
        }
        let centred = cylinder.pin_offset() == 0.0 && self.axes.pin_offset.is_none();
        if let (Some(ratios), true, true) = (&self.axes.rod_ratio, centred, !quantity.is_torque()) {
            let table = table::centred_table(&ratios[points.clone()], &self.orders, cancel)?;
            return Ok(table.mapv(Complex64::from));
        }
        let offsets = self.axes.pin_offset.as_deref();
        let in_a_row = offsets.map_or(1, <[f64]>::len);
        let mut table = Array2::default((points.len(), self.orders.len()));
        for (mut row, point) in table.rows_mut().into_iter().zip(points.clone()) {
            let ratio = self.axes.rod_ratio.as_ref().map(|ratios| ratios[point / in_a_row]);
            let offset = offsets.map(|offsets| offsets[point % in_a_row]);
            let proportions = proportions(cylinder, ratio, offset)?;
            let torques = || {
                if cylinder.has_rod_inertia() {
                    return torque::of_cylinder(cylinder, &proportions, &self.orders, cancel);
                }
                torque::torque(&proportions, &self.orders, cancel)
            };
            let values = match quantity {
                Quantity::Torque => torques()?.roll,
                Quantity::CrankTorque => torques()?.crank,
                _ => harmonics::coefficients(&proportions, &self.orders, cancel)?,
            };
            row.assign(&ArrayView1::from(&values));
        }
        Ok(table)
    }
}
