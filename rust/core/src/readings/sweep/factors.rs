//! The two factors of a sweep's sums: functions of the bank angle, and constants of an engine at
//! points of rod ratio and pin offset.

use std::ops::Range;

use super::harmonics::PointHarmonics;
use super::layout::Layout;
use super::{Quantity, Sweep};
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
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
    pub fn new(sweep: &Sweep, quantity: Quantity, angles: Range<usize>) -> Self {
        let count = angles.len();
        let Some((bank_angles, hold)) = &sweep.axes.bank_angle else {
            // No bank turns: cosines of zero.
            let none = [vec![1.0; count], vec![0.0; count]].concat().repeat(2);
            return Self(vec![none; sweep.orders.len()]);
        };
        let of_order = |&order: &crate::Order| {
            let multiples = quantity.turn(order, *hold);
            let mut functions = vec![0.0; FUNCTIONS * count];
            for (multiple, pair) in multiples.into_iter().zip(functions.chunks_mut(2 * count)) {
                let (cos, sin) = pair.split_at_mut(count);
                let half = 0.5 * multiple as f64;
                let degrees: Vec<f64> =
                    bank_angles[angles.clone()].iter().map(|angle| half * angle).collect();
                vectorised(
                    #[inline(always)]
                    || sin_cos_degrees(&degrees, sin, cos),
                );
            }
            functions
        };
        Self(sweep.orders.iter().map(of_order).collect())
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
        layout: &Layout,
        points: Range<usize>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let count = points.len();
        let harmonics = PointHarmonics::new(sweep, layout, quantity, points, cancel)?;
        let mut by_order = Vec::with_capacity(layout.by_order.len());
        for (k, sums) in layout.by_order.iter().enumerate() {
            let mut columns = vec![0.0; CONSTANTS * count];
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
