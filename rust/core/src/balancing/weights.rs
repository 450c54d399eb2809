//! Least weights in given planes that exert, or come nearest to, a force and a moment.
//!
//! The weight of a plane is a complex number u; its mass·radius is |u| or, where a plane has a list of
//! angles, the sum of the amounts at them. Wanted are weights with rows·u nearest to a target and, of
//! those, the least: by the sum of the squares of the planes' mass·radius, or by the largest of them.
//!
//! All of these are convex problems with at most two complex equations, and whether a solution is the
//! minimum is checked on the result, by duality: a direction r of the residual bounds what any
//! weights can reach along it, multipliers λ bound the sum of squares of any weights that do the same.

use nalgebra::{DMatrix, RowVector2};

use super::least_squares::{RANK_TOLERANCE, least_squares};
use super::{TurningPart, VALUE_ROUNDING, angle_lists, discs, without_rounding};
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::singular_values::SingularValues;

/// What is minimised of weights that do the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Minimise {
    /// The sum of squares of the planes' mass·radius.
    Squares,
    /// The largest mass·radius of a plane.
    Largest,
}

/// Weights that are wanted in planes.
#[derive(Debug, Clone)]
pub struct WeightRequest<'a> {
    /// Places of the planes, m.
    pub z: &'a [f64],
    /// Plane about which the moment is taken, m.
    pub reference: f64,
    /// Length over which a moment counts as much as a force, m.
    pub length: f64,
    /// Force that the weights are to exert, kg·m; None if it does not matter.
    pub force: Option<Complex64>,
    /// Moment that they are to exert, kg·m²; None if it does not matter.
    pub moment: Option<Complex64>,
    /// Largest mass·radius of each plane, kg·m; infinite for none.
    pub bounds: &'a [f64],
    /// Angles allowed in each plane, radians; None for any.
    pub angles: Option<&'a [Vec<f64>]>,
    /// What is minimised of weights that do the same.
    pub minimise: Minimise,
}

/// A weight in a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedWeight {
    /// Index of the plane.
    pub plane: usize,
    /// Index among the angles allowed in the plane, 0 where any is.
    pub angle: usize,
    /// Mass·radius and direction, kg·m.
    pub vector: Complex64,
}

/// Weights, and whether they exert what was wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedWeights {
    /// Those that are not zero, by plane and angle.
    pub list: Vec<PlacedWeight>,
    /// Whether weights beside these, by no more than rounding, are proved to exert the target wherever
    /// weights of any size in these planes do.
    pub reached: bool,
    /// Part of the target that they do not exert.
    pub missing: f64,
}

/// Vectors in the cross-section, a row for each plane or for each equation.
pub(super) type Vectors = DMatrix<f64>;

/// Part of the target that the nearest weights may miss; part of a minimum that may be missing.
pub(super) const SOLVED: f64 = 1e-9;
/// Part of the target that is made up by weights with room for it: the least largest weights miss so much
/// where a plane hardly sees what is missing.
const UNREACHED_AT_BOUNDS: f64 = 1e-7;
/// Room of such weights, relative to the target and to their bounds.
const ROOM_FOR_COMPENSATION: f64 = 1e-6;
/// What solvers may leave of their equations, in figures of order 1.
pub(super) const SOLVER_ROUNDING: f64 = 1e-12;
/// Targets below this are none.
const LEAST_TARGET: f64 = 1e-200;
/// Bounds above this multiple of the target bind nowhere; those below its inverse leave nothing.
const UNBOUNDED_FROM: f64 = 1e9;

/// The least weights among those that come nearest to the target.
///
/// ```
/// use crankpin_core::balancing::weights::{Minimise, WeightRequest, least};
/// use crankpin_core::{Cancel, Complex64};
///
/// let request = WeightRequest {
///     z: &[0.0, 0.3],
///     reference: 0.0,
///     length: 0.3,
///     force: Some(Complex64::new(0.02, 0.0)), // kg·m
///     moment: Some(Complex64::default()),
///     bounds: &[f64::INFINITY; 2],
///     angles: None,
///     minimise: Minimise::Squares,
/// };
/// let fitted = least(&request, &Cancel::new())?;
/// assert!(fitted.reached);
/// assert_eq!(fitted.list.len(), 1); // all of it in the plane of reference
/// # Ok::<(), crankpin_core::Error>(())
/// ```
pub fn least(request: &WeightRequest, cancel: &Cancel) -> Result<FittedWeights> {
    let moment = request.moment.map(|moment| -Complex64::i() * moment / request.length);
    let target: Vec<Complex64> = [request.force, moment].into_iter().flatten().collect();
    let scale = target.iter().map(|part| part.norm()).fold(0.0, f64::max);
    let room = |plane: &usize| request.bounds[*plane] > scale / UNBOUNDED_FROM;
    let kept: Vec<usize> = (0..request.z.len()).filter(room).collect();
    if scale <= LEAST_TARGET || kept.is_empty() {
        let reached = scale <= LEAST_TARGET;
        let missing = if reached { 0.0 } else { 1.0 };
        return Ok(FittedWeights { list: Vec::new(), reached, missing });
    }
    let problem = Problem::new(request, &kept, vectors(&target) / scale, scale, cancel);
    let (problem, size) = problem.with_target_of_order_one();
    let mut amounts = problem.least(request.minimise)?;
    let is_proved = problem.made_up(&mut amounts);
    let largest = amounts.iter().map(|weight| weight.vector.norm()).fold(0.0, f64::max);
    amounts.retain(|weight| weight.vector.norm() > 10.0 * VALUE_ROUNDING * largest);
    // Of planes near each other the others make up for what was left out.
    problem.made_up(&mut amounts);
    let reached = is_proved && problem.is_rounding(&amounts);
    let missing = problem.missing(&amounts).row_iter().map(|part| part.norm()).fold(0.0, f64::max);
    let list = amounts.into_iter().map(|weight| PlacedWeight {
        plane: kept[weight.plane],
        vector: weight.vector * size * scale,
        ..weight
    });
    Ok(FittedWeights { list: list.collect(), reached, missing: missing * size })
}

/// Weights in planes, in any direction and of any size: force and moment are met by two planes, and
/// the sum of squares is least from three on; in a single plane the squares of what is missed are.
///
/// Returned with the number of planes that differ, up to two.
pub(super) fn unbounded(
    wanted: &TurningPart,
    z: &[f64],
    reference: f64,
    length: f64,
) -> (Vec<Complex64>, usize) {
    let lever = |row: usize, plane: usize| {
        if row == 0 { 1.0 } else { (z[plane] - reference) / length }
    };
    let moment = -Complex64::i() * wanted.moment / length;
    let target = vectors(&[wanted.force, moment]);
    let found = least_squares(&DMatrix::from_fn(2, z.len(), lever), &target, 2);
    let mut weights = complex(&found.solution);
    without_rounding(&mut weights);
    (weights, found.rank)
}

/// A problem in figures of order 1: moments over the length, and over i.
pub(super) struct Problem<'a> {
    /// (`n_equations`, `n_planes`).
    pub rows: DMatrix<f64>,
    /// What the weights are to exert.
    pub target: Vectors,
    pub bounds: Vec<f64>,
    /// Unit vectors allowed in each plane; None for all.
    pub directions: Option<Vec<Vec<Complex64>>>,
    pub cancel: &'a Cancel,
}

impl<'a> Problem<'a> {
    /// Of some of the planes of a request; target and bounds are over a scale.
    fn new(
        request: &WeightRequest,
        kept: &[usize],
        target: Vectors,
        scale: f64,
        cancel: &'a Cancel,
    ) -> Self {
        let rows = DMatrix::from_fn(target.nrows(), kept.len(), |row, k| {
            let is_force = row == 0 && request.force.is_some();
            if is_force { 1.0 } else { (request.z[kept[k]] - request.reference) / request.length }
        });
        let bound =
            |&plane: &usize| Some(request.bounds[plane] / scale).filter(|&b| b < UNBOUNDED_FROM);
        let bounds = kept.iter().map(|plane| bound(plane).unwrap_or(f64::INFINITY)).collect();
        let unit = |&angle: &f64| Complex64::from_polar(1.0, angle);
        let directions = request.angles.map(|angles| {
            kept.iter().map(|&plane| angles[plane].iter().map(unit).collect()).collect()
        });
        Self { rows, target, bounds, directions, cancel }
    }

    /// The same over a size, so that weights are figures of order 1: planes near each other take weights far
    /// above the target.
    fn with_target_of_order_one(mut self) -> (Self, f64) {
        let free = least_squares(&self.rows, &self.target, self.target.nrows()).solution;
        let largest = complex(&free).into_iter().zip(&self.bounds);
        let size = largest.map(|(u, bound)| u.norm().min(*bound)).fold(1.0, f64::max);
        self.target /= size;
        for bound in &mut self.bounds {
            *bound /= size;
        }
        (self, size)
    }
}

impl Problem<'_> {
    fn least(&self, minimise: Minimise) -> Result<Vec<PlacedWeight>> {
        if self.directions.is_none() && minimise == Minimise::Squares {
            let found = least_squares(&self.rows, &self.target, self.target.nrows()).solution;
            if found.row_iter().zip(&self.bounds).all(|(u, bound)| u.norm() <= *bound) {
                return Ok(each(&found));
            }
        }
        let mut found = self.nearest(&self.target, &self.bounds)?;
        let mut bounds = self.bounds.clone();
        if minimise == Minimise::Largest {
            // At any angle a plane that hardly sees what is missing is known to more digits as it is.
            let same = self.directions.is_some().then(|| self.with_equal_effect(&found));
            let (problem, target) = match &same {
                Some(same) => (same, &same.target),
                None => (self, &self.target),
            };
            let exerted = problem.exerted(&found);
            bounds = problem.least_bounds(&exerted)?;
            found = problem.nearest(target, &bounds)?;
        }
        match &self.directions {
            Some(directions) => {
                match angle_lists::least_squares(self, directions, &bounds, &found)? {
                    Some(least) => Ok(least),
                    // The least largest weights leave hardly a choice: any of them will do.
                    None if minimise == Minimise::Largest => Ok(found),
                    None => Err(self.not_found("least")),
                }
            }
            None => Ok(found),
        }
    }

    /// The problem of weights that exert what these do, which may be written in any equations that say
    /// so: in orthonormal ones, however near to each other the planes are.
    pub fn with_equal_effect(&self, weights: &[PlacedWeight]) -> Self {
        let values = SingularValues::of(&self.rows);
        let rows = values.right.rows(0, values.rank(RANK_TOLERANCE)).into_owned();
        let (bounds, directions) = (self.bounds.clone(), self.directions.clone());
        let mut same = Problem { target: self.target.clone(), rows, bounds, directions, ..*self };
        same.target = same.exerted(weights);
        same
    }

    /// Force and moment that weights exert.
    pub fn exerted(&self, weights: &[PlacedWeight]) -> Vectors {
        let mut sums = Vectors::zeros(self.bounds.len(), 2);
        for weight in weights {
            sums.set_row(weight.plane, &(sums.row(weight.plane) + row(weight.vector)));
        }
        &self.rows * sums
    }

    /// What weights do not exert of the target.
    pub fn missing(&self, weights: &[PlacedWeight]) -> Vectors {
        &self.target - self.exerted(weights)
    }

    /// Largest projection of a unit weight of each plane onto a vector: |c|, or along its angles.
    pub fn support(&self, residual: &Vectors) -> Vec<f64> {
        let seen = self.rows.tr_mul(residual);
        let along = |(plane, seen): (usize, Complex64)| match &self.directions {
            None => seen.norm(),
            Some(units) => {
                units[plane].iter().map(|unit| (unit.conj() * seen).re).fold(0.0, f64::max)
            }
        };
        complex(&seen).into_iter().enumerate().map(along).collect()
    }

    /// Weights within bounds that come nearest to a target; at any angle, the least such weights.
    fn nearest(&self, target: &Vectors, bounds: &[f64]) -> Result<Vec<PlacedWeight>> {
        let found = match &self.directions {
            None => discs::nearest(&self.rows, target, bounds, self.cancel)?.map(|u| each(&u)),
            Some(directions) => angle_lists::nearest(self, directions, target, bounds)?,
        };
        let found = found.filter(|found| self.is_nearest(found, target, bounds));
        found.ok_or_else(|| self.not_found("nearest"))
    }

    /// Whether no weights within bounds come nearer to a target: they would go further along the residual.
    fn is_nearest(&self, weights: &[PlacedWeight], target: &Vectors, bounds: &[f64]) -> bool {
        let exerted = self.exerted(weights);
        let residual = target - &exerted;
        let further = self.support(&residual).into_iter().zip(bounds).map(|(support, bound)| {
            let is_rounding = bound.is_infinite() && support <= SOLVED;
            if is_rounding { 0.0 } else { support * bound }
        });
        residual.norm() <= SOLVED || further.sum::<f64>() - exerted.dot(&residual) <= SOLVED
    }

    pub fn not_found(&self, which: &str) -> Error {
        let hint = format!(
            "the {which} weights were not found to nine digits; give planes farther apart, or fewer \
             planes or angles"
        );
        Error::value("planes", format!("{} places", self.bounds.len()), hint)
    }

    /// The least bounds, equal for all planes but those with smaller ones, within which weights exert
    /// what is given.
    ///
    /// Every direction r limits them: Σ boundₚ·supportₚ(r) is at least what r sees of the target. The
    /// limit along the residual of the bounds so far is the next, up to the one without residual.
    fn least_bounds(&self, wanted: &Vectors) -> Result<Vec<f64>> {
        const MOST: usize = 200;
        let mut cap = 0.0;
        for _ in 0..MOST {
            let bounds = self.capped(cap);
            let residual = wanted - self.exerted(&self.nearest(wanted, &bounds)?);
            let size = residual.norm();
            if size <= 1e-3 * SOLVED {
                return Ok(bounds);
            }
            let next = self.cap(&self.support(&residual), wanted.dot(&residual));
            if next <= cap {
                // No more digits.
                return if size <= SOLVED { Ok(bounds) } else { self.relaxed(wanted, cap, size) };
            }
            cap = next;
        }
        Err(self.not_found("least"))
    }

    fn capped(&self, cap: f64) -> Vec<f64> {
        self.bounds.iter().map(|bound| bound.min(cap)).collect()
    }

    /// Bounds above a cap that is too low by the rounding of a small residual, found by bisection.
    ///
    /// A residual that a plane hardly sees is known to few digits, and with it the next cap. At the
    /// edge of what given bounds reach, no cap makes up for what is missed: those of the cap serve.
    fn relaxed(&self, wanted: &Vectors, cap: f64, missed: f64) -> Result<Vec<f64>> {
        let serves = |cap: f64| -> Result<bool> {
            let found = self.nearest(wanted, &self.capped(cap))?;
            Ok((wanted - self.exerted(&found)).norm() <= 1e-3 * SOLVED)
        };
        let mut low = cap;
        // The cap is proved to be no more than the least: bounds further above it might not be it.
        for part in [SOLVED, 1e-8, UNREACHED_AT_BOUNDS, 1e-6] {
            let mut high = cap * (1.0 + part);
            if serves(high)? {
                while high - low > SOLVED * high {
                    let middle = f64::midpoint(low, high);
                    *(if serves(middle)? { &mut high } else { &mut low }) = middle;
                }
                return Ok(self.capped(high));
            }
            low = high;
        }
        if missed <= UNREACHED_AT_BOUNDS {
            Ok(self.capped(cap))
        } else {
            Err(self.not_found("least"))
        }
    }

    /// Least cap on all bounds with Σ min(boundₚ, cap)·supportₚ = wanted.
    fn cap(&self, support: &[f64], wanted: f64) -> f64 {
        let mut order: Vec<usize> = (0..support.len()).collect();
        order.sort_by(|&a, &b| self.bounds[a].total_cmp(&self.bounds[b]));
        let (mut rest, mut slope) = (wanted, support.iter().sum::<f64>());
        for p in order {
            if slope <= 0.0 || rest <= self.bounds[p] * slope {
                break;
            }
            rest -= self.bounds[p] * support[p];
            slope -= support[p];
        }
        if slope > 0.0 { rest / slope } else { f64::INFINITY }
    }

    /// Makes up what solvers leave of the target, by weights with room for it; returns whether that is
    /// proved.
    ///
    /// The weights with room exert whatever all of them can if their equations have the same rank. The
    /// change then exists, however small what is missing looks; otherwise it is the nearest.
    fn made_up(&self, weights: &mut [PlacedWeight]) -> bool {
        let sums = sums(weights, self.bounds.len());
        let mut counts = vec![0.0; self.bounds.len()];
        for weight in &*weights {
            counts[weight.plane] += 1.0;
        }
        for weight in &mut *weights {
            let (sum, bound) = (sums[weight.plane], self.bounds[weight.plane]);
            if sum > bound {
                weight.vector *= bound / sum;
            }
        }
        let missing = self.missing(weights);
        if missing.norm() > UNREACHED_AT_BOUNDS {
            return false;
        }
        let room = |weight: &PlacedWeight| {
            let left = (self.bounds[weight.plane] - sums[weight.plane]) / counts[weight.plane];
            if self.directions.is_some() { left.min(weight.vector.norm()) } else { left }
        };
        let free: Vec<usize> =
            (0..weights.len()).filter(|&k| room(&weights[k]) > ROOM_FOR_COMPENSATION).collect();
        let free_weights = free.iter().map(|&k| weights[k]);
        let all = least_squares(&self.rows, &Vectors::zeros(self.target.nrows(), 1), 2).rank;
        let (change, is_proved): (Vec<Complex64>, bool) = if self.directions.is_none() {
            let planes: Vec<usize> = free_weights.map(|weight| weight.plane).collect();
            let found = least_squares(&self.rows.select_columns(&planes), &missing, 2);
            (complex(&found.solution), found.rank == all)
        } else {
            let units: Vec<(usize, Complex64)> =
                free_weights.map(|each| (each.plane, each.vector / each.vector.norm())).collect();
            let columns = angle_lists::made_by(&self.rows, &units);
            let flat = missing.reshape_generic(nalgebra::Dyn(columns.nrows()), nalgebra::Dyn(1));
            let found = least_squares(&columns, &flat, 4);
            let change = units.iter().zip(&found.solution).map(|((_, unit), x)| unit * x).collect();
            (change, found.rank == 2 * all)
        };
        if free.iter().zip(&change).any(|(&k, change)| change.norm() > room(&weights[k])) {
            return false;
        }
        for (k, change) in free.into_iter().zip(change) {
            weights[k].vector += change;
        }
        is_proved
    }

    /// Whether what weights do not exert of the target is rounding of the sums that they make.
    fn is_rounding(&self, weights: &[PlacedWeight]) -> bool {
        let missing = self.missing(weights);
        (0..missing.nrows()).all(|k| {
            let terms = weights.iter().map(|each| self.rows[(k, each.plane)] * each.vector.norm());
            let size = terms.map(f64::abs).sum::<f64>() + self.target.row(k).norm();
            missing.row(k).norm() <= VALUE_ROUNDING * size
        })
    }
}

fn row(vector: Complex64) -> RowVector2<f64> {
    RowVector2::new(vector.re, vector.im)
}

pub(super) fn complex(vectors: &Vectors) -> Vec<Complex64> {
    vectors.row_iter().map(|row| Complex64::new(row[0], row[1])).collect()
}

pub(super) fn vectors(rows: &[Complex64]) -> Vectors {
    Vectors::from_fn(rows.len(), 2, |k, j| if j == 0 { rows[k].re } else { rows[k].im })
}

/// Mass·radius of each plane.
pub(super) fn sums(weights: &[PlacedWeight], planes: usize) -> Vec<f64> {
    let mut sums = vec![0.0; planes];
    for weight in weights {
        sums[weight.plane] += weight.vector.norm();
    }
    sums
}

/// A weight in each plane.
fn each(found: &Vectors) -> Vec<PlacedWeight> {
    let weight = |(plane, vector)| PlacedWeight { plane, angle: 0, vector };
    complex(found).into_iter().enumerate().map(weight).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(
        z: &[f64],
        wanted: [Complex64; 2],
        bounds: &[f64],
        angles: Option<&[Vec<f64>]>,
        minimise: Minimise,
    ) -> FittedWeights {
        let [force, moment] = wanted.map(Some);
        let request = WeightRequest {
            z,
            reference: 0.0,
            length: 1.0,
            force,
            moment,
            bounds,
            angles,
            minimise,
        };
        least(&request, &Cancel::new()).unwrap()
    }

    const COUPLE: [Complex64; 2] = [Complex64::new(0.0, 0.0), Complex64::new(0.0, 3.0)];
    /// Solvers promise nine digits, of what is squared.
    const DIGITS: f64 = 1e-9;

    #[test]
    fn weights_share_a_couple_by_their_levers_or_evenly() {
        let z = [-1.0, -0.5, 0.5, 1.0];
        let free = [f64::INFINITY; 4];
        for angles in [None, Some(vec![vec![0.0, std::f64::consts::PI]; 4])] {
            let angles = angles.as_deref();
            let squares = fit(&z, COUPLE, &free, angles, Minimise::Squares);
            let largest = fit(&z, COUPLE, &free, angles, Minimise::Largest);
            // Two angles leave one direction without weights: nothing proves that they reach.
            assert_eq!(squares.reached && largest.reached, angles.is_none());
            assert!(squares.missing.max(largest.missing) < DIGITS);
            for (k, z) in z.iter().enumerate() {
                assert!((squares.list[k].vector - 3.0 * z / 2.5).norm() < DIGITS);
                assert!((largest.list[k].vector - z.signum()).norm() < DIGITS);
            }
        }
    }

    #[test]
    fn bounds_that_are_too_low_leave_the_least() {
        let turns: Vec<f64> = (0..24).map(|k| f64::from(k) * std::f64::consts::PI / 12.0).collect();
        for angles in [None, Some(vec![turns; 3])] {
            // The outer planes at their bounds; the one in the middle makes no moment.
            let found = fit(
                &[-1.0, 0.0, 1.0],
                COUPLE,
                &[0.5, 9.0, 0.7],
                angles.as_deref(),
                Minimise::Squares,
            );
            assert!(!found.reached);
            let sums = |plane: usize| {
                let here = found.list.iter().filter(|weight| weight.plane == plane);
                here.map(|weight| weight.vector).sum::<Complex64>()
            };
            assert!((sums(0) + 0.5).norm() < DIGITS && (sums(2) - 0.7).norm() < DIGITS);
            assert!((sums(1) + 0.2).norm() < DIGITS);
            assert!((found.missing - 1.8 / 3.0).abs() < DIGITS);
        }
    }

    /// Weights of planes that exert a force, with bounds; the angles allowed are quarters of a turn, or any.
    fn force<'a>(
        target: Complex64,
        bounds: &[f64],
        by_quarters: bool,
        cancel: &'a Cancel,
    ) -> Problem<'a> {
        let quarters = (0..4).map(|k| Complex64::i().powu(k)).collect();
        Problem {
            rows: DMatrix::from_element(1, bounds.len(), 1.0),
            target: vectors(&[target]),
            bounds: bounds.to_vec(),
            directions: by_quarters.then(|| vec![quarters; bounds.len()]),
            cancel,
        }
    }

    fn weights(vectors: &[(usize, Complex64)]) -> Vec<PlacedWeight> {
        vectors.iter().map(|&(plane, vector)| PlacedWeight { plane, angle: 0, vector }).collect()
    }

    const ONE: Complex64 = Complex64::ONE;
    const I: Complex64 = Complex64::I;
    const FREE: f64 = f64::INFINITY;

    #[test]
    fn weights_are_nearest_where_no_others_go_further_along_the_residual() {
        let cancel = Cancel::new();
        for (is_nearest, target, bounds, by_quarters, exerted) in [
            (true, 3.0 * ONE, [1.0, 0.5], false, [ONE, 0.5 * ONE]),
            (false, 3.0 * ONE, [1.0, 0.5], false, [ONE, 0.4 * ONE]),
            (false, 3.0 * ONE, [1.0, 0.5], false, [-ONE, -0.5 * ONE]),
            (false, 3.0 * ONE, [1.0, 0.5], false, [I, 0.5 * ONE]),
            (true, 3.0 * ONE, [FREE, 0.5], false, [2.6 * ONE, 0.4 * ONE]),
            (false, 3.0 * ONE, [FREE, 0.5], false, [2.4 * ONE, 0.5 * ONE]),
            (true, 0.2 * I, [1.0, 0.5], true, [0.1 * I, 0.1 * I]),
            // Of quarters of a turn both reach as far towards 45 degrees.
            (true, 3.0 * (ONE + I), [1.0, 1.0], true, [ONE, I]),
            (false, 3.0 * (ONE + I), [1.0, 1.0], true, [ONE, ONE]),
        ] {
            let problem = force(target, &bounds, by_quarters, &cancel);
            let found = weights(&[(0, exerted[0]), (1, exerted[1])]);
            let case = format!("{target} within {bounds:?} by {exerted:?}");
            assert_eq!(problem.is_nearest(&found, &problem.target, &bounds), is_nearest, "{case}");
        }
    }

    #[test]
    fn the_cap_on_all_bounds_is_where_the_sum_is_what_is_wanted() {
        let cancel = Cancel::new();
        for (cap, bounds, wanted) in [
            // 2·min(b₀, cap) + min(b₁, cap) = wanted.
            (1.0, [1.0, FREE], 3.0),
            (3.0, [1.0, FREE], 5.0),
            (3.0, [1.0, 4.0], 5.0),
            (4.0, [1.0, 4.0], 6.0),
            (0.5, [2.0, 1.0], 1.5),
            (1.75, [2.0, 1.0], 4.5),
            (FREE, [1.0, 4.0], 6.5),
        ] {
            let found = force(ONE, &bounds, false, &cancel).cap(&[2.0, 1.0], wanted);
            assert!((found - cap).abs() < 1e-15 || found == cap, "{bounds:?} {wanted}: {found}");
        }
        assert_eq!(force(ONE, &[1.0, 1.0], false, &cancel).cap(&[0.0, 0.0], 1.0), FREE);
    }

    #[test]
    fn what_solvers_leave_is_made_up_by_weights_with_room() {
        let cancel = Cancel::new();
        let rest = 1e-10;
        for (is_proved, is_met, target, bounds, by_quarters, exerted) in [
            (true, true, ONE, [FREE; 2], false, [(0.5 - rest) * ONE, 0.5 * ONE]),
            (true, true, ONE, [FREE; 2], false, [(0.5 + rest) * ONE, 0.5 * ONE]),
            (true, true, ONE, [FREE; 2], false, [0.5 * ONE, 0.5 * ONE + rest * I]),
            // Room in one plane; in none, and more than it allows.
            (true, true, ONE, [0.5, 0.6], false, [0.5 * ONE, (0.5 - rest) * ONE]),
            (true, true, ONE, [0.5, 0.6], false, [(0.5 + rest) * ONE, 0.5 * ONE]),
            (false, false, ONE, [0.5, 0.5], false, [0.5 * ONE, (0.5 - rest) * ONE]),
            (false, true, ONE, [0.5, 0.5], false, [0.5 * ONE, (0.5 + rest) * ONE]),
            // More than solvers leave.
            (false, false, ONE, [FREE; 2], false, [0.5 * ONE, 0.5001 * ONE]),
            // Along two directions; along one, in which weights can make up what is along it alone.
            (true, true, ONE + I, [FREE; 2], true, [(1.0 - rest) * ONE, (1.0 + rest) * I]),
            (false, true, ONE, [FREE; 2], true, [(0.5 - rest) * ONE, 0.5 * ONE]),
            (false, false, ONE, [FREE; 2], true, [0.5 * ONE, 0.5 * ONE + rest * I]),
        ] {
            let problem = force(target, &bounds, by_quarters, &cancel);
            let mut found = weights(&[(0, exerted[0]), (1, exerted[1])]);
            let case = format!("{target} within {bounds:?} by {exerted:?}");
            assert_eq!(problem.made_up(&mut found), is_proved, "{case}");
            // A few roundings.
            assert_eq!(problem.missing(&found).norm() < 1e-15, is_met, "{case}");
            for weight in &found {
                assert!(weight.vector.norm() <= bounds[weight.plane] * (1.0 + 1e-15), "{case}");
            }
        }
    }
}
