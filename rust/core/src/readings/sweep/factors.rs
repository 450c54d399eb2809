//! The two factors of a sweep's sums: functions of the bank angle, and constants of an engine at
//! points of rod ratio and pin offset.

use std::ops::Range;

use super::harmonics::PointHarmonics;
use super::layout::Layout;
use super::{Quantity, Sweep};
use crate::Complex64;
use crate::gear::Gear;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::simd::{sin_cos_degrees, vectorised};

/// Functions of γ: cosine and sine for the forward part (or torque) and for the backward part.
pub(super) const FUNCTIONS: usize = 4;
/// Real and imaginary parts of A, B and K, forward and backward, and the bound of rounding errors.
pub(super) const CONSTANTS: usize = 13;

/// Functions of half the bank angle, by order, at some bank angles.
///
/// Columns one after the other.
pub(super) struct Turning(pub Vec<Vec<f64>>);

impl Turning {
    pub fn new(sweep: &Sweep, quantity: Quantity, angles: Range<usize>) -> Result<Self> {
        let count = angles.len();
        let Some((bank_angles, hold)) = &sweep.axes.bank_angle else {
            // No bank turns: cosines of zero.
            let ones = [1.0, 0.0, 1.0, 0.0].map(|value| std::iter::repeat_n(value, count));
            let none: Vec<f64> = ones.into_iter().flatten().collect();
            return Ok(Self(vec![none; sweep.orders.len()])); // bounded: one bank angle, 10 000 orders
        };
        let of_order = |&order: &crate::Order| {
            let multiples = quantity.turn(order, *hold);
            let mut functions: Vec<f64> = memory::zeros(FUNCTIONS * count)?;
            let mut degrees: Vec<f64> = memory::zeros(count)?;
            for (multiple, pair) in multiples.into_iter().zip(functions.chunks_mut(2 * count)) {
                let (cos, sin) = pair.split_at_mut(count);
                let half = 0.5 * multiple as f64;
                for (out, angle) in degrees.iter_mut().zip(&bank_angles[angles.clone()]) {
                    *out = half * angle;
                }
                vectorised(
                    #[inline(always)]
                    || sin_cos_degrees(&degrees, sin, cos),
                );
            }
            Ok(functions)
        };
        Ok(Self(sweep.orders.iter().map(of_order).collect::<Result<_>>()?))
    }
}

/// A, B, K and the bound of rounding errors, by order, of one engine at some points.
pub(super) struct Constants {
    /// Columns one after the other.
    pub by_order: Vec<Vec<f64>>,
    pub points: usize,
}

impl Constants {
    pub fn new(
        sweep: &Sweep,
        quantity: Quantity,
        (gears, layout): (&[Gear], &Layout),
        points: Range<usize>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let count = points.len();
        let harmonics = PointHarmonics::new(sweep, (gears, layout), quantity, points, cancel)?;
        let mut by_order = memory::room(layout.len())?;
        for (k, sums) in layout.iter().enumerate() {
            let mut columns: Vec<f64> = memory::zeros(CONSTANTS * count)?;
            for sum in sums {
                let Some([re, im]) = harmonics.of(sum.harmonic, k) else { continue };
                let (constants, bounds) = columns.split_at_mut((CONSTANTS - 1) * count);
                for (constant, pair) in sum.constants.iter().zip(constants.chunks_mut(2 * count)) {
                    let (out_re, out_im) = pair.split_at_mut(count);
                    if *constant == Complex64::default() {
                        continue;
                    }
                    for i in 0..count {
                        out_re[i] += constant.re * re[i] - constant.im * im[i];
                        out_im[i] += constant.re * im[i] + constant.im * re[i];
                    }
                }
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
