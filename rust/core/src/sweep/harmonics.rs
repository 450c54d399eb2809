//! What a sweep's rod ratios and offsets change: the harmonics of its cylinders.

use ndarray::Array2;
use rayon::prelude::*;

use super::{Quantity, Sweep};
use crate::Complex64;
use crate::cancel::Cancel;
use crate::error::{Error, Result};
use crate::harmonics::{self, table, torque};
use crate::slider_crank::{Cylinder, Proportions};

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

impl Sweep {
    /// Harmonics of a cylinder at every point of rod ratio and offset: (points, `n_orders`).
    pub(super) fn harmonics(
        &self,
        cylinder: &Cylinder,
        quantity: Quantity,
        cancel: &Cancel,
    ) -> Result<Array2<Complex64>> {
        if let Some(spectrum) = &self.spectrum {
            if quantity == Quantity::Torque {
                let cure = "a spectrum of forces tells nothing of torque; leave it out";
                return Err(Error::value("spectrum", "given", cure));
            }
            let row: Vec<_> = self.orders.iter().map(|&n| spectrum.amplitude(n)).collect();
            return Ok(one_row(&row));
        }
        let centred = cylinder.pin_offset() == 0.0 && self.axes.pin_offset.is_none();
        if let (Some(ratios), true, true) =
            (&self.axes.rod_ratio, centred, quantity != Quantity::Torque)
        {
            let table = table::centred_table(ratios, &self.orders, cancel)?;
            return Ok(table.mapv(Complex64::from));
        }
        let one = [f64::NAN];
        let list = |values: &'_ Option<Vec<f64>>| -> Vec<Option<f64>> {
            match values {
                Some(values) => values.iter().copied().map(Some).collect(),
                None => one.iter().map(|_| None).collect(),
            }
        };
        let (ratios, offsets) = (list(&self.axes.rod_ratio), list(&self.axes.pin_offset));
        let points = ratios.len() * offsets.len();
        let row = |point: usize| -> Result<Vec<Complex64>> {
            cancel.check()?;
            let (ratio, offset) = (ratios[point / offsets.len()], offsets[point % offsets.len()]);
            let proportions = proportions(cylinder, ratio, offset)?;
            Ok(match quantity {
                Quantity::Torque if cylinder.has_rod_inertia() => {
                    torque::of_cylinder(cylinder, &proportions, &self.orders).roll
                }
                Quantity::Torque => torque::torque(&proportions, &self.orders).roll,
                _ => harmonics::coefficients(&proportions, &self.orders),
            })
        };
        if points == 1 {
            return row(0).map(|row| one_row(&row));
        }
        let rows: Vec<Vec<Complex64>> =
            (0..points).into_par_iter().map(row).collect::<Result<_>>()?;
        Ok(Array2::from_shape_fn((points, self.orders.len()), |(point, order)| rows[point][order]))
    }
}

fn one_row(row: &[Complex64]) -> Array2<Complex64> {
    Array2::from_shape_fn((1, row.len()), |(_, order)| row[order])
}
