//! Least weights in given planes that exert, or come nearest to, a force and a moment.
//!
//! The weight of a plane is a complex number u; its mass·radius is |u| or, where a plane has a list of
//! angles, the sum of the amounts at them. Wanted are weights with rows·u nearest to a target and, of
//! those, the least: by the sum of the squares of the planes' mass·radius, or by the largest of them.
//!
//! All of these are convex problems with at most two complex equations, and whether a solution is the
//! minimum is checked on the result, by duality: a direction r of the residual bounds what any
//! weights can reach along it, multipliers λ bound the sum of squares of any weights that do the same.

use nalgebra::{DMatrix, DVector};

use super::least_squares::{RANK_TOLERANCE, least_squares};
use super::nonnegative::{minimum, stack};
use super::{NEGLIGIBLE, TurningPart, without_rounding};
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};

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

/// Part of the target that solvers may miss, to be made up by weights with room for it; part of a
/// minimum that may be missing.
const REACHED: f64 = 1e-9;
/// Room of such weights, relative to the target and to their bounds.
const ROOM: f64 = 1e-6;
/// What solvers may leave of their equations, in figures of order 1.
const ROUNDING: f64 = 1e-12;
/// Targets below this are none.
const NOTHING: f64 = 1e-200;
/// Bounds above this multiple of the target bind nowhere; those below its inverse leave nothing.
const UNBOUNDED: f64 = 1e9;

/// The least of the weights that come nearest to the target.
pub fn least(request: &WeightRequest, cancel: &Cancel) -> Result<FittedWeights> {
    let moment = request.moment.map(|moment| -Complex64::i() * moment / request.length);
    let target: Vec<Complex64> = [request.force, moment].into_iter().flatten().collect();
    let scale = target.iter().map(|part| part.norm()).fold(0.0, f64::max);
    let room = |plane: &usize| request.bounds[*plane] > scale / UNBOUNDED;
    let kept: Vec<usize> = (0..request.z.len()).filter(room).collect();
    if scale <= NOTHING || kept.is_empty() {
        let reached = scale <= NOTHING;
        let missing = if reached { 0.0 } else { 1.0 };
        return Ok(FittedWeights { list: Vec::new(), reached, missing });
    }
    let rows = DMatrix::from_fn(target.len(), kept.len(), |row, k| {
        let is_force = row == 0 && request.force.is_some();
        if is_force { 1.0 } else { (request.z[kept[k]] - request.reference) / request.length }
    });
    let bound = |&plane: &usize| Some(request.bounds[plane] / scale).filter(|&b| b < UNBOUNDED);
    let problem = Problem {
        rows,
        target: target.iter().map(|&part| part / scale).collect(),
        bounds: kept.iter().map(|plane| bound(plane).unwrap_or(f64::INFINITY)).collect(),
        directions: request.angles.map(|angles| {
            let unit = |&angle: &f64| Complex64::from_polar(1.0, angle);
            kept.iter().map(|&plane| angles[plane].iter().map(unit).collect()).collect()
        }),
        cancel,
    };
    let mut amounts = problem.least(request.minimise)?;
    let reached = problem.made_up(&mut amounts);
    let missing = problem.missing(&amounts).iter().map(|part| part.norm()).fold(0.0, f64::max);
    let largest = amounts.iter().map(|weight| weight.vector.norm()).fold(0.0, f64::max);
    let list = amounts
        .into_iter()
        .filter(|weight| weight.vector.norm() > 10.0 * NEGLIGIBLE * largest)
        .map(|weight| PlacedWeight {
            plane: kept[weight.plane],
            vector: weight.vector * scale,
            ..weight
        })
        .collect();
    Ok(FittedWeights { list, reached, missing })
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
    let rows =
        DMatrix::from_fn(
            2,
            z.len(),
            |row, plane| {
                if row == 0 { 1.0 } else { (z[plane] - reference) / length }
            },
        );
    let moment = -Complex64::i() * wanted.moment / length;
    let (mut found, rank) = free_weights(&rows, &[wanted.force, moment]);
    without_rounding(&mut found);
    (found, rank)
}

/// Weights in any direction with the least residual, the least sum of squares; rank of the rows.
fn free_weights(rows: &DMatrix<f64>, target: &[Complex64]) -> (Vec<Complex64>, usize) {
    let parts = |k: usize, j: usize| if j == 0 { target[k].re } else { target[k].im };
    let targets = DMatrix::from_fn(target.len(), 2, parts);
    let found = least_squares(rows, &targets, target.len());
    let x = found.solution;
    ((0..x.nrows()).map(|k| Complex64::new(x[(k, 0)], x[(k, 1)])).collect(), found.rank)
}

/// A problem in figures of order 1: moments over the length, and over i.
struct Problem<'a> {
    /// (`n_targets`, `n_planes`).
    rows: DMatrix<f64>,
    target: Vec<Complex64>,
    bounds: Vec<f64>,
    /// Unit vectors allowed in each plane; None for all.
    directions: Option<Vec<Vec<Complex64>>>,
    cancel: &'a Cancel,
}

impl Problem<'_> {
    fn least(&self, minimise: Minimise) -> Result<Vec<PlacedWeight>> {
        if self.directions.is_none() && minimise == Minimise::Squares {
            let (found, _) = free_weights(&self.rows, &self.target);
            if found.iter().zip(&self.bounds).all(|(u, bound)| u.norm() <= *bound) {
                return Ok(each(found));
            }
        }
        let mut found = self.nearest(&self.bounds)?;
        let mut bounds = self.bounds.clone();
        if minimise == Minimise::Largest {
            bounds = self.least_bounds(&self.made(&self.resultants(&found)))?;
        }
        if self.directions.is_some() {
            if minimise == Minimise::Largest {
                found = self.nearest(&bounds)?;
            }
            found = self.least_squares(&bounds, found)?;
        } else if minimise == Minimise::Largest {
            found = self.nearest(&bounds)?;
        }
        Ok(found)
    }

    /// Force and moment that weights exert.
    fn made(&self, weights: &[Complex64]) -> Vec<Complex64> {
        let row = |k: usize| weights.iter().zip(self.rows.row(k).iter()).map(|(u, m)| u * m).sum();
        (0..self.target.len()).map(row).collect()
    }

    /// Sum of the weights in each plane.
    fn resultants(&self, weights: &[PlacedWeight]) -> Vec<Complex64> {
        let mut sums = vec![Complex64::default(); self.bounds.len()];
        for weight in weights {
            sums[weight.plane] += weight.vector;
        }
        sums
    }

    /// What a vector of two equations is worth in each plane: rowsᵀ·r.
    fn seen(&self, residual: &[Complex64]) -> Vec<Complex64> {
        let of = |p: usize| (0..residual.len()).map(|k| residual[k] * self.rows[(k, p)]).sum();
        (0..self.bounds.len()).map(of).collect()
    }

    /// Largest projection of a unit weight of each plane onto a vector: |c|, or along its angles.
    fn support(&self, residual: &[Complex64]) -> Vec<f64> {
        let along = |(p, c): (usize, Complex64)| match &self.directions {
            None => c.norm(),
            Some(units) => units[p].iter().map(|unit| dot(*unit, c)).fold(0.0, f64::max),
        };
        self.seen(residual).into_iter().enumerate().map(along).collect()
    }

    /// Weights within bounds that come nearest to the target; at any angle, the least of them.
    fn nearest(&self, bounds: &[f64]) -> Result<Vec<PlacedWeight>> {
        let found = if self.directions.is_none() {
            each(self.within_discs(bounds)?)
        } else {
            let columns = self.columns(bounds);
            let goal = real(&self.target);
            let room = DVector::from_vec(finite(bounds).map(|p| bounds[p]).collect());
            let mut start = DVector::zeros(columns.count());
            start.rows_mut(columns.places.len(), room.len()).copy_from(&room);
            let rows = [&columns.made, &columns.filled];
            let found = minimum(rows, [&goal, &room], start, self.cancel)?;
            if found.missing > ROUNDING {
                return Err(self.not_found("nearest"));
            }
            columns.weights(&found.x)
        };
        // Weights that came nearer would go further along the residual.
        let made = self.made(&self.resultants(&found));
        let residual: Vec<_> = self.target.iter().zip(&made).map(|(t, m)| t - m).collect();
        let size = norm(&residual);
        let further = self.support(&residual).into_iter().zip(bounds).map(|(support, bound)| {
            let is_rounding = bound.is_infinite() && support <= REACHED;
            if is_rounding { 0.0 } else { support * bound }
        });
        let gained: f64 = made.iter().zip(&residual).map(|(m, r)| dot(*m, *r)).sum();
        let is_nearest = further.sum::<f64>() - gained <= REACHED;
        if size <= REACHED || is_nearest { Ok(found) } else { Err(self.not_found("nearest")) }
    }

    fn not_found(&self, which: &str) -> Error {
        let hint = format!("the {which} weights were not found to nine digits; give fewer planes");
        Error::value("planes", format!("{} places", self.bounds.len()), hint)
    }

    /// The least bounds, equal for all planes but those with smaller ones, within which weights exert
    /// what is given.
    ///
    /// Every direction r limits them: Σ boundₚ·supportₚ(r) is at least what r sees of the target. The
    /// limit along the residual of the bounds so far is the next, up to the one without residual.
    fn least_bounds(&self, made: &[Complex64]) -> Result<Vec<f64>> {
        const MOST: usize = 200;
        let within = |cap: f64| self.bounds.iter().map(|b| b.min(cap)).collect::<Vec<f64>>();
        let there = Problem {
            rows: self.rows.clone(),
            target: made.to_vec(),
            bounds: self.bounds.clone(),
            directions: self.directions.clone(),
            cancel: self.cancel,
        };
        let mut cap = 0.0;
        for _ in 0..MOST {
            let bounds = within(cap);
            let found = there.made(&there.resultants(&there.nearest(&bounds)?));
            let residual: Vec<_> = made.iter().zip(&found).map(|(t, m)| t - m).collect();
            let size = norm(&residual);
            if size <= 1e-3 * REACHED {
                return Ok(bounds);
            }
            let wanted: f64 = made.iter().zip(&residual).map(|(m, r)| dot(*m, *r)).sum();
            let next = self.cap(&there.support(&residual), wanted);
            if next <= cap {
                // No more digits.
                return if size <= REACHED { Ok(bounds) } else { Err(self.not_found("least")) };
            }
            cap = next;
        }
        Err(self.not_found("least"))
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
        let mut sums = vec![0.0; self.bounds.len()];
        let mut counts = vec![0.0; self.bounds.len()];
        for weight in &*weights {
            sums[weight.plane] += weight.vector.norm();
            counts[weight.plane] += 1.0;
        }
        for weight in &mut *weights {
            let (sum, bound) = (sums[weight.plane], self.bounds[weight.plane]);
            if sum > bound {
                weight.vector *= bound / sum;
            }
        }
        let missing = self.missing(weights);
        if norm(&missing) > REACHED {
            return false;
        }
        let room = |weight: &PlacedWeight| {
            let left = (self.bounds[weight.plane] - sums[weight.plane]) / counts[weight.plane];
            if self.directions.is_some() { left.min(weight.vector.norm()) } else { left }
        };
        let free: Vec<usize> = (0..weights.len()).filter(|&k| room(&weights[k]) > ROOM).collect();
        let planes: Vec<usize> = free.iter().map(|&k| weights[k].plane).collect();
        let (change, rank, whole): (Vec<Complex64>, usize, usize);
        let all = least_squares(&self.rows, &DMatrix::zeros(self.target.len(), 1), 2).rank;
        if self.directions.is_none() {
            (change, rank) = free_weights(&self.rows.select_columns(&planes), &missing);
            whole = all;
        } else {
            let unit = |&k: &usize| weights[k].vector / weights[k].vector.norm();
            let units: Vec<Complex64> = free.iter().map(unit).collect();
            let rows = DMatrix::from_fn(2 * missing.len(), free.len(), |k, j| {
                part(units[j] * self.rows[(k / 2, planes[j])], k)
            });
            let found = least_squares(&rows, &DMatrix::from_columns(&[real(&missing)]), 4);
            change = units.iter().zip(found.solution.iter()).map(|(unit, x)| unit * x).collect();
            (rank, whole) = (found.rank, 2 * all);
        }
        if free.iter().zip(&change).any(|(&k, change)| change.norm() > room(&weights[k])) {
            return false;
        }
        for (k, change) in free.into_iter().zip(change) {
            weights[k].vector += change;
        }
        rank == whole
    }

    fn missing(&self, weights: &[PlacedWeight]) -> Vec<Complex64> {
        let made = self.made(&self.resultants(weights));
        self.target.iter().zip(made).map(|(wanted, made)| wanted - made).collect()
    }

    // --- any angle ------------------------------------------------------------------------------

    /// Weights |u| ≤ bound nearest to the target and, of those, with the least sum of squares.
    ///
    /// They are u = λᵀ·rows, cut to their bounds, with multipliers λ that maximise a concave function
    /// of at most four real variables. A target beyond reach leaves a residual r, and λ grows along it:
    /// all planes are at their bounds then, but those that cannot see r, which are at one place.
    fn within_discs(&self, bounds: &[f64]) -> Result<Vec<Complex64>> {
        // Equations that depend on each other become one: multipliers are then bounded.
        let svd = self.rows.clone().svd(true, false);
        let (Some(u), values) = (svd.u, svd.singular_values) else {
            return Err(self.not_found("nearest"));
        };
        let significant = |k: &usize| values[*k] > RANK_TOLERANCE * values.max();
        let basis = u.select_columns(&(0..values.len()).filter(significant).collect::<Vec<_>>());
        let turned = DMatrix::from_fn(self.target.len(), 2, |k, j| part(self.target[k], j));
        let turned = basis.tr_mul(&turned);
        let target = DVector::from_fn(2 * turned.nrows(), |k, _| turned[(k / 2, k % 2)]);
        let discs = Discs { rows: basis.tr_mul(&self.rows), target, bounds };
        if let Some(found) = discs.but_one_place() {
            return Ok(found);
        }
        let mut multipliers = DVector::zeros(discs.target.len());
        // Squares weigh less and less beside what is missing: at last no more than its rounding.
        for power in 0..=15 {
            self.cancel.check()?;
            multipliers = discs.maximum(multipliers, 10.0_f64.powi(-power));
            let left = discs.rest(&multipliers).norm();
            let found = discs.weights(&multipliers);
            let full = |(u, bound): (&Complex64, &f64)| u.norm() >= bound * (1.0 - 1e-14);
            if left <= 1e-15 || left > REACHED && found.iter().zip(bounds).all(full) {
                break;
            }
        }
        Ok(discs.weights(&multipliers))
    }

    // --- lists of angles ------------------------------------------------------------------------

    /// Of weights that come as near as those given, within bounds, those with the least sum of squares.
    ///
    /// A residual has planes that see it at their bounds: only the others have a choice.
    fn least_squares(&self, bounds: &[f64], found: Vec<PlacedWeight>) -> Result<Vec<PlacedWeight>> {
        let residual = self.missing(&found);
        let Some(directions) = self.directions.as_ref().filter(|_| norm(&residual) > REACHED)
        else {
            return self.squares(bounds, &found);
        };
        let blind: Vec<usize> = self
            .support(&residual)
            .iter()
            .enumerate()
            .filter(|(_, support)| **support <= 10.0 * REACHED)
            .map(|(plane, _)| plane)
            .collect();
        let (moved, mut kept): (Vec<PlacedWeight>, Vec<PlacedWeight>) =
            found.into_iter().partition(|weight| blind.contains(&weight.plane));
        if moved.is_empty() {
            return Ok(kept);
        }
        let index = |plane: usize| blind.iter().position(|&p| p == plane).unwrap_or_default();
        let inside: Vec<PlacedWeight> = moved
            .iter()
            .map(|weight| PlacedWeight { plane: index(weight.plane), ..*weight })
            .collect();
        let some = Problem {
            rows: self.rows.select_columns(&blind),
            target: self.made(&self.resultants(&moved)),
            bounds: blind.iter().map(|&p| bounds[p]).collect(),
            directions: Some(blind.iter().map(|&p| directions[p].clone()).collect()),
            cancel: self.cancel,
        };
        let least = some.squares(&some.bounds, &inside)?;
        kept.extend(
            least.into_iter().map(|each| PlacedWeight { plane: blind[each.plane], ..each }),
        );
        kept.sort_by_key(|weight| (weight.plane, weight.angle));
        Ok(kept)
    }

    /// Of weights that do the same as those given, within bounds, those with the least sum of squares.
    fn squares(&self, bounds: &[f64], found: &[PlacedWeight]) -> Result<Vec<PlacedWeight>> {
        let columns = self.columns(bounds);
        let planes = bounds.len();
        let mut sums = DMatrix::zeros(planes, columns.count());
        for (j, &(plane, _)) in columns.places.iter().enumerate() {
            sums[(plane, j)] = 1.0;
        }
        let start = columns.variables(found, bounds);
        let held = stack(&columns.made, &columns.filled);
        let value = &held * &start;
        let none = DVector::zeros(planes);
        let best = minimum([&sums, &held], [&none, &value], start, self.cancel)?;
        // No weights that do the same have less than what the multipliers promise.
        let given = real(&self.made(&self.resultants(found)));
        let count = given.len();
        let lambda: Vec<Complex64> = (0..count / 2)
            .map(|k| Complex64::new(best.multipliers[2 * k], best.multipliers[2 * k + 1]))
            .collect();
        let promised = best.multipliers.rows(0, count).dot(&given)
            - self.support(&lambda).iter().zip(bounds).map(|(h, b)| energy(*h, *b)).sum::<f64>();
        let squares = (&sums * &best.x).norm_squared() / 2.0;
        let is_least = squares - promised <= REACHED * squares.max(1.0);
        if is_least && best.missing <= ROUNDING {
            Ok(columns.weights(&best.x))
        } else {
            Err(self.not_found("least"))
        }
    }

    fn columns(&self, bounds: &[f64]) -> AngleColumns {
        let units = self.directions.as_deref().unwrap_or_default();
        let places: Vec<(usize, usize)> = units
            .iter()
            .enumerate()
            .flat_map(|(p, of)| (0..of.len()).map(move |k| (p, k)))
            .collect();
        let bounded: Vec<usize> = finite(bounds).collect();
        let count = places.len() + bounded.len();
        let mut made = DMatrix::zeros(2 * self.target.len(), count);
        let mut filled = DMatrix::zeros(bounded.len(), count);
        for (j, &(plane, k)) in places.iter().enumerate() {
            for row in 0..made.nrows() {
                made[(row, j)] = part(units[plane][k] * self.rows[(row / 2, plane)], row);
            }
            if let Some(row) = bounded.iter().position(|&p| p == plane) {
                filled[(row, j)] = 1.0;
            }
        }
        for row in 0..bounded.len() {
            filled[(row, places.len() + row)] = 1.0;
        }
        let directions = places.iter().map(|&(plane, k)| units[plane][k]).collect();
        AngleColumns { places, directions, made, filled }
    }
}

/// Variables of planes with lists of angles: amounts, then the room that each bound leaves.
struct AngleColumns {
    /// Plane and angle of each amount.
    places: Vec<(usize, usize)>,
    directions: Vec<Complex64>,
    /// What the variables exert, real and imaginary parts.
    made: DMatrix<f64>,
    /// Amounts and room of each plane with a bound.
    filled: DMatrix<f64>,
}

impl AngleColumns {
    fn count(&self) -> usize {
        self.made.ncols()
    }

    fn weights(&self, x: &DVector<f64>) -> Vec<PlacedWeight> {
        let each = self.places.iter().zip(&self.directions).zip(x.iter());
        each.filter(|(_, amount)| **amount > 0.0)
            .map(|((&(plane, angle), unit), amount)| PlacedWeight {
                plane,
                angle,
                vector: unit * amount,
            })
            .collect()
    }

    fn variables(&self, weights: &[PlacedWeight], bounds: &[f64]) -> DVector<f64> {
        let mut x = DVector::zeros(self.count());
        for weight in weights {
            let here = |place: &(usize, usize)| *place == (weight.plane, weight.angle);
            if let Some(j) = self.places.iter().position(here) {
                x[j] += weight.vector.norm();
            }
        }
        let used = &self.filled * &x;
        for (row, p) in finite(bounds).enumerate() {
            x[self.places.len() + row] = (bounds[p] - used[row]).max(0.0);
        }
        x
    }
}

/// Planes with bounds and any angle.
struct Discs<'a> {
    rows: DMatrix<f64>,
    target: DVector<f64>,
    bounds: &'a [f64],
}

impl Discs<'_> {
    fn planes(&self) -> impl Iterator<Item = (usize, f64)> {
        self.bounds.iter().copied().enumerate()
    }

    fn seen(&self, multipliers: &DVector<f64>, plane: usize) -> Complex64 {
        let parts = (0..self.rows.nrows()).map(|k| {
            Complex64::new(multipliers[2 * k], multipliers[2 * k + 1]) * self.rows[(k, plane)]
        });
        parts.sum()
    }

    fn weights(&self, multipliers: &DVector<f64>) -> Vec<Complex64> {
        let cut = |(p, bound): (usize, f64)| {
            let seen = self.seen(multipliers, p);
            if seen.norm() <= bound { seen } else { seen * (bound / seen.norm()) }
        };
        self.planes().map(cut).collect()
    }

    fn rest(&self, multipliers: &DVector<f64>) -> DVector<f64> {
        let weights = self.weights(multipliers);
        DVector::from_fn(self.target.len(), |k, _| {
            let row = self.rows.row(k / 2);
            self.target[k]
                - weights.iter().zip(row.iter()).map(|(u, m)| part(u * m, k)).sum::<f64>()
        })
    }

    /// Weights that leave a residual which planes at one place cannot see; None if there are none.
    fn but_one_place(&self) -> Option<Vec<Complex64>> {
        if self.rows.nrows() < 2 {
            return None;
        }
        let target = |k: usize| Complex64::new(self.target[2 * k], self.target[2 * k + 1]);
        let row = |p: usize| [self.rows[(0, p)], self.rows[(1, p)]];
        (0..self.bounds.len()).find_map(|place| {
            let [a, b] = row(place);
            let size = a.hypot(b);
            let along = |p: usize| (row(p)[0] * a + row(p)[1] * b) / size;
            let across = |p: usize| (row(p)[1] * a - row(p)[0] * b) / size;
            let (there, others): (Vec<usize>, Vec<usize>) =
                (0..self.bounds.len()).partition(|&p| across(p).abs() <= RANK_TOLERANCE * size);
            let wanted = (target(1) * a - target(0) * b) / size;
            let reach: f64 = others.iter().map(|&p| self.bounds[p] * across(p).abs()).sum();
            if wanted.norm() <= reach {
                return None;
            }
            let unit = wanted / wanted.norm();
            let mut found = vec![Complex64::default(); self.bounds.len()];
            let mut rest = (target(0) * a + target(1) * b) / size;
            for &p in &others {
                found[p] = unit * (self.bounds[p] * across(p).signum());
                rest -= found[p] * along(p);
            }
            // Planes at one place share what is left of the other component.
            let mut shared: Vec<usize> = there;
            shared.sort_by(|&p, &q| self.bounds[p].total_cmp(&self.bounds[q]));
            let (mut amount, count) = (rest.norm() / size, shared.len());
            for (k, &p) in shared.iter().enumerate() {
                let here = self.bounds[p].min(amount / (count - k) as f64);
                let sign = along(p).signum();
                found[p] = if amount > 0.0 { rest / rest.norm() * (here * sign) } else { found[p] };
                amount -= here;
            }
            (amount <= ROUNDING).then_some(found)
        })
    }

    /// Multipliers at which λ·target − ½·squares·|λ|² − Σ energies is the largest, by Newton's method:
    /// it is piecewise smooth and strictly concave, and a step beyond its maximum is halved.
    fn maximum(&self, mut multipliers: DVector<f64>, squares: f64) -> DVector<f64> {
        const STEPS: usize = 40;
        const SHORTEST: f64 = 1e-9;
        let count = multipliers.len();
        let gradient = |at: &DVector<f64>| self.rest(at) - at * squares;
        for _ in 0..STEPS {
            let slope = gradient(&multipliers);
            let mut curvature = DMatrix::identity(count, count) * squares;
            for (p, bound) in self.planes() {
                let seen = self.seen(&multipliers, p);
                let size = seen.norm();
                // Beyond the bound a weight only turns.
                let (ratio, unit) = if size <= bound {
                    (1.0, Complex64::default())
                } else {
                    (bound / size, seen / size)
                };
                for j in 0..count {
                    for k in 0..count {
                        let turns = f64::from(j % 2 == k % 2) - part(unit, j) * part(unit, k);
                        let rows = self.rows[(j / 2, p)] * self.rows[(k / 2, p)];
                        curvature[(j, k)] += rows * ratio * turns;
                    }
                }
            }
            let Some(factors) = curvature.cholesky() else { break };
            let step = factors.solve(&slope);
            let gain = step.dot(&slope);
            let mut part = 1.0;
            while part > SHORTEST
                && step.dot(&gradient(&(&multipliers + &step * part))) < -0.5 * gain
            {
                part /= 2.0;
            }
            multipliers += &step * part;
            if (step * part).amax() <= 1e-15 * multipliers.amax() {
                break;
            }
        }
        multipliers
    }
}

/// Conjugate of ½s² for 0 ≤ s ≤ bound.
fn energy(support: f64, bound: f64) -> f64 {
    let s = support.min(bound);
    s * (support - 0.5 * s)
}

fn finite(bounds: &[f64]) -> impl Iterator<Item = usize> {
    (0..bounds.len()).filter(|&p| bounds[p].is_finite())
}

fn each(found: Vec<Complex64>) -> Vec<PlacedWeight> {
    let weight = |(plane, vector)| PlacedWeight { plane, angle: 0, vector };
    found.into_iter().enumerate().map(weight).collect()
}

fn real(values: &[Complex64]) -> DVector<f64> {
    DVector::from_iterator(2 * values.len(), values.iter().flat_map(|value| [value.re, value.im]))
}

/// Real part for even k, imaginary part for odd k.
fn part(value: Complex64, k: usize) -> f64 {
    if k.is_multiple_of(2) { value.re } else { value.im }
}

fn dot(a: Complex64, b: Complex64) -> f64 {
    a.re * b.re + a.im * b.im
}

fn norm(values: &[Complex64]) -> f64 {
    values.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt()
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
}
