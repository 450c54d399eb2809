//! Crank angles, and cosine and sine of their multiples, a column of them at a time.

use std::ops::Range;

use crate::numbers::angle::LARGEST_ANGLE;
use crate::numbers::cancel::Cancel;
use crate::numbers::double::fused;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::order::Order;
use crate::numbers::simd::{MultiplyAdd, ROUND, sin_cos_degrees, vectorised};

/// Fewest points of a table over crank angle that is known to be one of a whole cycle.
pub const FEWEST_POINTS: usize = 8;
/// Angles whose cosines and sines are computed side by side.
const SIDE_BY_SIDE: usize = 64;
/// Difference from a whole period, as a part of it, up to which a grid is closed: angles may have been
/// printed with few digits.
const CLOSED: f64 = 2e-6;

/// Crank angles modulo two turns, in which half orders come round.
#[derive(Debug, Clone, PartialEq)]
pub struct CrankAngles {
    /// Degrees, in [−360, 360].
    reduced: Vec<f64>,
}

impl CrankAngles {
    /// From degrees.
    pub fn new(theta_deg: &[f64]) -> Result<Self> {
        check(theta_deg, &Cancel::new())?;
        Ok(Self::of_checked(theta_deg))
    }

    /// From degrees that are known to be angles.
    pub(crate) fn of_checked(theta_deg: &[f64]) -> Self {
        // Both terms are multiples of θ's last place, and the difference is less than θ or 360:
        // nothing is rounded.
        let reduced = theta_deg.iter().map(|θ| θ - 720.0 * ((θ * (1.0 / 720.0) + ROUND) - ROUND));
        Self { reduced: reduced.collect() }
    }

    /// Degrees, reduced to [−360, 360].
    pub(crate) fn degrees(&self) -> &[f64] {
        &self.reduced
    }

    /// Number of angles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.reduced.len()
    }

    /// True if there are no angles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.reduced.is_empty()
    }

    /// Cosine and sine of nθ for some of the angles, each to a unit in the last place at any order.
    pub(crate) fn multiples(
        &self,
        order: Order,
        range: Range<usize>,
        cos: &mut [f64],
        sin: &mut [f64],
    ) {
        let n = order.number();
        let reduced = self.reduced.get(range).unwrap_or_default();
        let parts = reduced.chunks(SIDE_BY_SIDE).zip(cos.chunks_mut(SIDE_BY_SIDE));
        let parts = parts.zip(sin.chunks_mut(SIDE_BY_SIDE));
        vectorised(
            #[inline(always)]
            || {
                // Of a fixed length, so that loops are vectors where code is made for size too.
                let [mut θ, mut product, mut x, mut y] = [[0.0; SIDE_BY_SIDE]; 4];
                for ((reduced, cos), sin) in parts {
                    let count = reduced.len();
                    θ[..count].copy_from_slice(reduced);
                    for i in 0..SIDE_BY_SIDE {
                        product[i] = n * θ[i];
                    }
                    sin_cos_degrees(&product, &mut y, &mut x);
                    // nθ is the product and what its rounding took, at most 2.4e-10 degrees: 4e-12
                    // rad, whose square is nothing.
                    for i in 0..SIDE_BY_SIDE {
                        let rest = fused(n, θ[i], -product[i]).to_radians();
                        (x[i], y[i]) =
                            (rest.multiply_add(-y[i], x[i]), rest.multiply_add(x[i], y[i]));
                    }
                    cos[..count].copy_from_slice(&x[..count]);
                    sin[..count].copy_from_slice(&y[..count]);
                }
            },
        );
    }
}

/// Rejects crank angles that are not finite, or so large that doubles no longer resolve a turn.
pub fn check(theta_deg: &[f64], cancel: &Cancel) -> Result<()> {
    /// Angles between two checks for cancellation.
    const ANGLES_PER_CHECK: usize = 1 << 16;
    let taken = |θ: f64| θ.is_finite() && θ.abs() <= LARGEST_ANGLE;
    for piece in theta_deg.chunks(ANGLES_PER_CHECK) {
        cancel.check()?;
        if let Some(&θ) = piece.iter().find(|&&θ| !taken(θ)) {
            let hint = format!("give finite degrees of magnitude {LARGEST_ANGLE:e} at most");
            return Err(Error::figure("theta_deg", θ, hint));
        }
    }
    Ok(())
}

/// Rejects a grid whose crank angles do not ascend. An angle that is there twice is one at which the
/// function jumps.
pub fn check_grid(argument: &str, theta_deg: &[f64]) -> Result<()> {
    for (k, &angle) in theta_deg.iter().enumerate() {
        limits::finite(&format!("{argument}[{k}]"), angle)?;
        if k > 0 && angle < theta_deg[k - 1] {
            let mut hint = format!("give ascending angles: it follows {:?}", theta_deg[k - 1]);
            if k >= FEWEST_POINTS && angle <= theta_deg[0] + (theta_deg[1] - theta_deg[0]) {
                hint += "; of several cycles below each other, give one or their mean";
            }
            return Err(Error::figure(format!("{argument}[{k}]"), angle, hint));
        }
        if k > 1 && angle == theta_deg[k - 2] {
            let hint = "is given three times; give an angle once, or twice where the curve jumps";
            return Err(Error::figure(format!("{argument}[{k}]"), angle, hint));
        }
    }
    Ok(())
}

/// Whether the last of ascending angles over a period repeats the first, a period later; none if they
/// do not cover the period.
#[must_use]
pub fn repeats_first(theta_deg: &[f64], period_deg: f64) -> Option<bool> {
    let span = theta_deg.last()? - theta_deg.first()?;
    let tolerance = CLOSED * period_deg;
    if (span - period_deg).abs() <= tolerance {
        return Some(true);
    }
    // The gap between the last point and the first of the next period is one of the grid's.
    let widest = theta_deg.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    (span < period_deg && period_deg - span <= widest + tolerance).then_some(false)
}

/// A range in parts of a largest length.
pub(crate) fn parts(
    range: Range<usize>,
    length: usize,
) -> impl ExactSizeIterator<Item = Range<usize>> {
    let (start, end) = (range.start, range.end);
    (0..range.len().div_ceil(length))
        .map(move |k| start + k * length..(start + (k + 1) * length).min(end))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn multiples(degrees: &[f64], halves: u32) -> (Vec<f64>, Vec<f64>) {
        let order = Order::from_halves(halves).unwrap();
        let angles = CrankAngles::new(degrees).unwrap();
        let (mut cos, mut sin) = (vec![0.0; degrees.len()], vec![0.0; degrees.len()]);
        angles.multiples(order, 0..degrees.len(), &mut cos, &mut sin);
        (cos, sin)
    }

    proptest! {
        #[test]
        fn multiples_are_those_of_the_exact_angle(
            degrees in prop_oneof![-720.0..720.0, -1e12..1e12, Just(1e-300)],
            order in 1_u32..10_000,
        ) {
            let (cos, sin) = multiples(&[degrees; 65], 2 * order);
            let exact = crate::numbers::angle::cis_multiple(degrees, i64::from(order));
            // two units in the last place of numbers below 1: one of each way
            prop_assert!((cos[64] - exact.re).abs() <= 4.5e-16, "{} {}", cos[64], exact.re);
            prop_assert!((sin[64] - exact.im).abs() <= 4.5e-16, "{} {}", sin[64], exact.im);
        }
    }

    #[test]
    fn quarter_turns_are_exact() {
        let (cos, sin) = multiples(&[0.0, 90.0, 180.0, 270.0, 360.0, -90.0, 1e12 - 280.0], 2);
        assert_eq!(cos, [1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 1.0].map(|x| x));
        assert_eq!(sin, [0.0, 1.0, 0.0, -1.0, 0.0, -1.0, 0.0].map(|x| x));
    }

    #[test]
    fn half_orders_come_round_in_two_turns() {
        let (cos, sin) = multiples(&[0.0, 180.0, 360.0, 540.0, 720.0, -360.0, 1080.0], 1);
        assert_eq!(cos, [1.0, 0.0, -1.0, 0.0, 1.0, -1.0, -1.0]);
        assert_eq!(sin, [0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn angles_are_as_many_as_were_given() {
        for count in [0, 1, 7] {
            let angles = CrankAngles::new(&vec![10.0; count]).unwrap();
            assert_eq!((angles.len(), angles.is_empty()), (count, count == 0));
        }
    }

    #[test]
    fn parts_follow_each_other_to_the_end() {
        for (range, length) in [(0..10, 3), (5..17, 4), (5..18, 4), (7..7, 4), (2..5, 100)] {
            let found: Vec<_> = parts(range.clone(), length).collect();
            assert!(found.iter().rev().skip(1).all(|part| part.len() == length));
            assert!(found.iter().all(|part| (1..=length).contains(&part.len())));
            assert_eq!(found.into_iter().flatten().collect::<Vec<_>>(), range.collect::<Vec<_>>());
        }
    }

    #[test]
    fn many_angles_are_looked_at_to_the_last() {
        let mut degrees = vec![0.0; 200_000];
        degrees[199_999] = f64::NAN;
        assert!(CrankAngles::new(&degrees).is_err());
    }

    #[test]
    fn no_angle_that_is_none() {
        for bad in [f64::NAN, f64::INFINITY, 2e12] {
            assert!(CrankAngles::new(&[0.0, bad]).is_err());
        }
    }
}
