//! Phasors of actuators, each within a bound, that leave the least at receivers, point by point.
//!
//! With d at the receivers and S what actuators do there, the length of d + S·c is minimised, or the largest length
//! of a receiver's part of it. Without bounds that are met the first is least squares; else min t with every length
//! below t and |cⱼ| below its bound follows the central path of the barriers −log(t² − |e|²) and −log(1 − |c|²),
//! whose steps by Newton's method cannot fail (Nesterov and Nemirovskii).

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::least_squares::stack;
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::singular_values::SingularValues;
use crate::numbers::{limits, memory, pool};

/// Singular value over the largest below which actuators do the same as others.
const SAME_EFFECT: f64 = 1e-12;
/// Regularisation of scaled equations, which may be singular.
const REGULARISATION: f64 = 1e-14;
/// Factor of the barriers' weight from one centre to the next.
const NARROWER: f64 = 0.1;
/// Newton decrement at which a centre is near.
const CENTRED: f64 = 0.25;
/// Distance from the least length, over it and over the target, at the end.
const GAP: f64 = 1e-12;
/// Steps of Newton's method; up to some hundred are needed.
const MOST_STEPS: usize = 400;

/// Actuators and receivers at some points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhasorRequest<'a> {
    /// Phasors at the receivers without actuators, a row for each point.
    pub target: &'a [Complex64],
    /// What a unit of each actuator does at each receiver, row by row.
    pub effect: &'a [Complex64],
    /// Largest magnitude of each actuator at each point; infinite for none.
    pub bounds: &'a [f64],
    /// Number of actuators.
    pub actuators: usize,
    /// Weight of the actuators' squares beside those of the receivers, over the largest singular value squared.
    pub effort: f64,
    /// Numbers of rows of the receivers, of which the largest counts; None for all together.
    pub widths: Option<&'a [usize]>,
}

/// The phasors of each actuator at each point.
pub fn least(request: &PhasorRequest, cancel: &Cancel) -> Result<Vec<Complex64>> {
    let PhasorRequest { target, effect, bounds, actuators, .. } = *request;
    let points = bounds.len() / actuators.max(1);
    let receivers = target.len() / points.max(1);
    let found = [bounds.len(), target.len() * actuators];
    let wanted = [points * actuators, effect.len()];
    limits::same_length("effect", found[1], "the points", wanted[1], "phasor")?;
    limits::same_length("bounds", found[0], "the points", wanted[0], "bound")?;
    if actuators * receivers == 0 {
        return Ok(Vec::new());
    }
    let rows = target.chunks(receivers).zip(effect.chunks(receivers * actuators));
    let tasks = memory::collected(rows.zip(bounds.chunks(actuators)))?;
    let of_point = |((target, effect), bounds): ((&[Complex64], &[Complex64]), &[f64])| {
        cancel.check()?;
        let (effect, target) = (real_matrix(effect, actuators), real_column(target));
        Ok(PhasorsAtPoint { effect, target, bounds }.least(request))
    };
    Ok(pool::map(cancel, tasks, of_point)?.concat())
}

/// Share, from 0 to 1, of a change of phasors at receivers that minimises `start + share·change`: the largest length of
/// its groups of rows, of these widths, or without widths the sum of squares of all.
///
/// None where the change is nothing.
pub fn least_share(
    start: &[Complex64],
    change: &[Complex64],
    widths: Option<&[usize]>,
    cancel: &Cancel,
) -> Result<Option<f64>> {
    limits::same_length("change", change.len(), "start", start.len(), "phasor")?;
    let rows = widths.map_or(start.len(), |widths| widths.iter().sum());
    limits::same_length("widths", rows, "start", start.len(), "phasor")?;
    cancel.check()?;
    let (start, mut change) = (real_column(start), real_matrix(change, 1));
    let unit = change.column(0).amax();
    if unit == 0.0 {
        return Ok(None);
    }
    // Squares of what is small would underflow.
    let (start, along) = (start / unit, change.column(0) / unit);
    let of_squares = (-along.dot(&start) / along.norm_squared()).clamp(0.0, 1.0);
    let Some(widths) = widths else { return Ok(Some(of_squares)) };
    let groups = groups_of(widths);
    let largest = |share: f64| largest_length(&(&along * share + &start), &groups);
    // A share is a phasor without imaginary part, of a magnitude of at most ½ about the middle.
    change.set_column(0, &(&along * 0.5));
    change.column_mut(1).fill(0.0);
    let middle = &along * 0.5 + &start;
    if middle.amax() == 0.0 {
        return Ok(Some(0.5));
    }
    let guess = DVector::from_column_slice(&[0.9 * (2.0 * of_squares - 1.0), 0.0]);
    let found = bounded(&change, &middle, &groups, &[1.0], &guess)[0];
    let least = f64::midpoint(1.0, found).clamp(0.0, 1.0);
    let shares = [least, of_squares, 0.0, 1.0].into_iter();
    Ok(shares.min_by(|&one, &other| largest(one).total_cmp(&largest(other))))
}

/// Rows of real numbers of groups of phasors, of these widths.
fn groups_of(widths: &[usize]) -> Vec<Range<usize>> {
    let ends = widths.iter().scan(0, |end, width| {
        let first = *end;
        *end += 2 * width;
        Some(first..*end)
    });
    ends.collect()
}

/// Largest length of groups of rows.
fn largest_length(rows: &DVector<f64>, groups: &[Range<usize>]) -> f64 {
    groups.iter().map(|of| rows.rows_range(of.clone()).norm()).fold(0.0, f64::max)
}

/// One point in real numbers, real and imaginary part of each phasor side by side.
struct PhasorsAtPoint<'a> {
    effect: DMatrix<f64>,
    target: DVector<f64>,
    bounds: &'a [f64],
}

/// What units of actuators do at receivers, row by row, as a matrix of real numbers.
pub(super) fn real_matrix(effect: &[Complex64], actuators: usize) -> DMatrix<f64> {
    let number = |row: usize, column: usize| {
        let value = effect[row / 2 * actuators + column / 2];
        match (row % 2, column % 2) {
            (0, 0) | (1, 1) => value.re,
            (0, _) => -value.im,
            _ => value.im,
        }
    };
    DMatrix::from_fn(2 * effect.len() / actuators, 2 * actuators, number)
}

/// Phasors as a column of real numbers.
pub(super) fn real_column(phasors: &[Complex64]) -> DVector<f64> {
    let parts = phasors.iter().flat_map(|phasor| [phasor.re, phasor.im]);
    DVector::from_iterator(2 * phasors.len(), parts)
}

impl PhasorsAtPoint<'_> {
    fn least(&self, request: &PhasorRequest) -> Vec<Complex64> {
        let mut values = SingularValues::of(&self.effect);
        let Some(&largest) = values.values.first().filter(|_| self.target.amax() > 0.0) else {
            return vec![Complex64::ZERO; self.bounds.len()];
        };
        let (effect, target) = self.with_effort(request.effort.sqrt() * largest);
        if request.effort != 0.0 {
            values = SingularValues::of(&effect);
        }
        let all = 0..target.len();
        let mut found = values.solve(&DMatrix::from_columns(&[-&target]), values.rank(SAME_EFFECT));
        let mut found: DVector<f64> = found.column_mut(0).into_owned();
        let is_over = |(k, bound): (usize, &f64)| found.fixed_rows::<2>(2 * k).norm() > *bound;
        if self.bounds.iter().enumerate().any(is_over) {
            found = bounded(&effect, &target, &[all], self.bounds, &DVector::zeros(found.len()));
        }
        if let Some(widths) = request.widths {
            let groups = groups_of(widths);
            let other = bounded(&effect, &target, &groups, self.bounds, &(&found * 0.9));
            let largest = |of: &DVector<f64>| largest_length(&(&effect * of + &target), &groups);
            if largest(&other) < largest(&found) {
                found = other;
            }
        }
        found.as_slice().chunks(2).map(|pair| Complex64::new(pair[0], pair[1])).collect()
    }

    /// The equations, and those of the actuators' own squares where they have a weight.
    fn with_effort(&self, weight: f64) -> (DMatrix<f64>, DVector<f64>) {
        let (effect, target) = (&self.effect, &self.target);
        if weight == 0.0 {
            return (effect.clone(), target.clone());
        }
        let count = effect.ncols();
        let own = DMatrix::identity(count, count) * weight;
        (stack(effect, &own), target.clone().resize_vertically(target.len() + count, 0.0))
    }
}

/// The phasors within bounds of the least largest length of groups of rows, from some within.
fn bounded(
    effect: &DMatrix<f64>,
    target: &DVector<f64>,
    groups: &[Range<usize>],
    bounds: &[f64],
    start: &DVector<f64>,
) -> DVector<f64> {
    let (size, count) = (target.amax(), start.len());
    // In units of the bounds, or of what an actuator alone needs: targets are 1.
    let unit = |k: usize| {
        let column = effect.column(2 * k).norm();
        if bounds[k].is_finite() {
            bounds[k]
        } else if column > 0.0 {
            size / column
        } else {
            0.0
        }
    };
    let units = DVector::from_fn(count, |k, _| unit(k / 2));
    let rows = DMatrix::from_fn(target.len(), count, |i, k| effect[(i, k)] * units[k] / size);
    let mut x = start.zip_map(&units, |x, unit| if unit > 0.0 { x / unit } else { 0.0 });
    let target = target / size;
    let limited: Vec<usize> = (0..bounds.len()).filter(|&k| bounds[k].is_finite()).collect();
    let parts: Vec<_> = groups.iter().map(|of| rows.rows_range(of.clone())).collect();
    let grams: Vec<DMatrix<f64>> = parts.iter().map(|part| part.tr_mul(part)).collect();
    let lengths = |left: &DVector<f64>| -> Vec<f64> {
        groups.iter().map(|of| left.rows_range(of.clone()).norm()).collect()
    };
    let barriers = 2.0 * (groups.len() + limited.len()) as f64;
    let mut t = 2.0 * lengths(&(&rows * &x + &target)).into_iter().fold(0.0, f64::max);
    let mut weight = t;
    for _ in 0..MOST_STEPS {
        let left = &rows * &x + &target;
        let mut slope = DVector::zeros(count + 1);
        slope[count] = 1.0 / weight;
        let mut curvature = DMatrix::zeros(count + 1, count + 1);
        for ((part, gram), (of, length)) in
            parts.iter().zip(&grams).zip(groups.iter().zip(lengths(&left)))
        {
            let room = (t - length) * (t + length);
            let own = part.tr_mul(&left.rows_range(of.clone())) * (2.0 / room);
            let along = own.push(-2.0 * t / room);
            let mut view = curvature.view_mut((0, 0), (count, count));
            view += gram * (2.0 / room);
            curvature[(count, count)] -= 2.0 / room;
            curvature.ger(1.0, &along, &along, 1.0);
            slope += along;
        }
        for &k in &limited {
            let pair = x.fixed_rows::<2>(2 * k).into_owned();
            let room = 1.0 - pair.norm_squared();
            let along = pair * (2.0 / room);
            let mut view = curvature.fixed_view_mut::<2, 2>(2 * k, 2 * k);
            view +=
                nalgebra::Matrix2::from_diagonal_element(2.0 / room) + along * along.transpose();
            let mut view = slope.fixed_rows_mut::<2>(2 * k);
            view += along;
        }
        let scale = curvature.diagonal().map(|x| if x > 0.0 { x.sqrt().recip() } else { 1.0 });
        let scaled = DMatrix::from_fn(count + 1, count + 1, |i, k| {
            let regular = if i == k { REGULARISATION } else { 0.0 };
            curvature[(i, k)] * scale[i] * scale[k] + regular
        });
        let Some(factors) = scaled.cholesky() else { break };
        let mut step = factors.solve(&-slope.component_mul(&scale)).component_mul(&scale);
        let decrement = (-slope.dot(&step)).max(0.0).sqrt();
        if decrement > CENTRED {
            step /= 1.0 + decrement;
        } else if barriers * weight <= GAP * t.max(GAP) {
            // No further than two of each barrier above the least.
            break;
        } else {
            weight *= NARROWER;
        }
        x += step.rows(0, count);
        t += step[count];
    }
    let mut found = x.component_mul(&units);
    for (k, &bound) in bounds.iter().enumerate() {
        let mut pair = found.fixed_rows_mut::<2>(2 * k);
        let size = pair.norm();
        if size > bound {
            pair *= bound / size;
        }
    }
    found
}
