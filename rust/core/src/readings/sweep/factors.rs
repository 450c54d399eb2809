//! The two factors of a sweep's sums: waves of half the bank angle, and coefficients of an engine at
//! points of rod ratio and pin offset.

use std::collections::BTreeMap;
use std::ops::Range;

use super::block::ROWS_SIDE_BY_SIDE;
use super::layout::Layout;
use super::{Selection, Sweep};
use crate::Complex64;
use crate::load::{Harmonic, Scene};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::simd::{sin_cos_degrees, vectorised};
use crate::readings::quantity::{Kind, Quantity};
use crate::source::{PointColumns, at_points};

/// Columns of numbers, one after the other, each followed by room that a block may read.
pub(super) struct Padded<const N: usize> {
    pub values: Vec<f64>,
    /// Numbers from the start of a column to that of the next one.
    pub length: usize,
}

impl<const N: usize> Padded<N> {
    pub fn zeros(count: usize) -> Result<Self> {
        let length = count + ROWS_SIDE_BY_SIDE;
        Ok(Self { values: memory::zeros(N * length)?, length })
    }

    pub fn each(&mut self) -> impl Iterator<Item = &mut [f64]> {
        self.values.chunks_exact_mut(self.length)
    }
}

/// Cosines and sines of multiples of a quarter of the bank angle, at some bank angles.
pub(super) struct Waves {
    pub columns: Vec<Padded<2>>,
    /// Places of the waves of the forward part (or torque) and of the backward part, by order.
    pub of_order: Vec<[usize; 2]>,
}

impl Waves {
    pub fn new(
        sweep: &Sweep,
        quantity: Quantity,
        angles: Range<usize>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let (mut columns, mut places) = (Vec::new(), BTreeMap::new());
        let mut of_order = memory::with_capacity(sweep.orders.len())?;
        let bank_angles = &sweep.bank_angles()[angles];
        let mut degrees: Vec<f64> = memory::zeros(bank_angles.len())?;
        for &order in &sweep.orders {
            cancel.check()?;
            // No bank turns by 0 times an angle.
            let bank_angle = sweep.axes.bank_angle.as_ref();
            let multiples = bank_angle.map_or([0; 2], |(_, hold)| quantity.turn(order, *hold));
            let mut place = [0; 2];
            for (place, multiple) in place.iter_mut().zip(multiples.map(i64::unsigned_abs)) {
                *place = *places.entry(multiple).or_insert(columns.len());
                if *place < columns.len() {
                    continue;
                }
                let mut wave = Padded::zeros(degrees.len())?;
                let (cos, sin) = wave.values.split_at_mut(wave.length);
                if multiple == 0 {
                    cos.fill(1.0);
                } else {
                    let quarter = 0.25 * multiple as f64;
                    vectorised(
                        #[inline(always)]
                        || {
                            for (out, angle) in degrees.iter_mut().zip(bank_angles) {
                                *out = quarter * angle;
                            }
                            sin_cos_degrees(&degrees, sin, cos);
                        },
                    );
                }
                memory::push(&mut columns, wave)?;
            }
            of_order.push(place);
        }
        Ok(Self { columns, of_order })
    }
}

/// Layout sums times harmonics, by order, of one engine at some points.
pub(super) struct Coefficients {
    /// Real and imaginary parts of cos, sin and rest of the forward and of the backward part, and the
    /// bound of rounding errors.
    pub by_order: Vec<Padded<13>>,
    /// Number of points.
    pub points: usize,
}

impl Coefficients {
    pub fn new(
        sweep: &Sweep,
        selection: Selection,
        (loads, layout): (&Scene, &Layout),
        points: Range<usize>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let count = points.len();
        let points = memory::collected(points.map(|point| sweep.at(selection, point)))?;
        let mut harmonics: Vec<(Harmonic, PointColumns)> = Vec::new();
        for harmonic in layout.iter().flatten().map(|sum| sum.harmonic) {
            if harmonics.iter().all(|(known, _)| *known != harmonic) {
                let source = &loads.sources[harmonic.source];
                let [roll, crank] =
                    at_points(source, harmonic.column, &points, &sweep.orders, cancel)?;
                let on_crank = selection.quantity.kind == Kind::CrankTorque;
                harmonics.push((harmonic, if on_crank { crank } else { roll }));
            }
        }
        let mut by_order = memory::with_capacity(layout.len())?;
        for (k, sums) in layout.iter().enumerate() {
            cancel.check()?;
            let mut columns = Padded::zeros(count)?;
            for sum in sums {
                let known = harmonics.iter().find(|(known, _)| *known == sum.harmonic);
                let Some([re, im]) = known.and_then(|(_, columns)| columns.get(k)) else {
                    continue;
                };
                let mut each = columns.each();
                for coefficient in sum.parts.iter().flat_map(|part| [part.cos, part.sin, part.rest])
                {
                    let (Some(out_re), Some(out_im)) = (each.next(), each.next()) else { break };
                    if coefficient == Complex64::default() {
                        continue;
                    }
                    for i in 0..count {
                        out_re[i] += coefficient.re * re[i] - coefficient.im * im[i];
                        out_im[i] += coefficient.re * im[i] + coefficient.im * re[i];
                    }
                }
                let bounds = each.next().unwrap_or_default();
                for ((bound, re), im) in bounds.iter_mut().zip(re.iter()).zip(im.iter()) {
                    let length = if *im == 0.0 { re.abs() } else { re.hypot(*im) };
                    *bound += sum.bound * length;
                }
            }
            by_order.push(columns);
        }
        Ok(Self { by_order, points: count })
    }
}
