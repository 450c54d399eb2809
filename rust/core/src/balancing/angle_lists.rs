//! Weights of planes with bounds and lists of angles: the nearest to a target and, of these, the least.

use nalgebra::{DMatrix, DVector};

use super::least_squares::{Minimum, PENALTIES, minimum, stack};
use super::weights::{PlacedWeight, Problem, REACHED, ROUNDING, Vectors};
use crate::Complex64;
use crate::numbers::error::Result;
use crate::numbers::memory;

/// Unit vectors allowed in each plane.
type Directions = [Vec<Complex64>];

/// Weights within bounds that come nearest to a target; none if equations are missed.
pub(super) fn nearest(
    problem: &Problem,
    directions: &Directions,
    target: &Vectors,
    bounds: &[f64],
) -> Result<Option<Vec<PlacedWeight>>> {
    let columns = AngleColumns::new(problem, directions, bounds)?;
    let room = DVector::from_vec(finite(bounds).map(|p| bounds[p]).collect());
    let start = columns.variables(&[], bounds);
    let goal = DVector::from_column_slice(target.as_slice());
    let rows = [&columns.made, &columns.filled];
    let mut found = Minimum::start(start, room.len());
    for penalty in PENALTIES {
        found = minimum(rows, [&goal, &room], found, penalty, problem.cancel)?;
        if found.missing <= ROUNDING {
            return Ok(Some(columns.weights(&found.x)));
        }
    }
    Ok(None)
}

/// Of weights that come as near as those given, within bounds, those with the least sum of squares;
/// none if they are not found to nine digits.
///
/// A residual has planes that see it at their bounds: only the others have a choice.
pub(super) fn least_squares(
    problem: &Problem,
    directions: &Directions,
    bounds: &[f64],
    found: &[PlacedWeight],
) -> Result<Option<Vec<PlacedWeight>>> {
    let residual = problem.missing(found);
    let mut blind: Vec<usize> = (0..bounds.len()).collect();
    if residual.norm() > REACHED {
        let support = problem.support(&residual);
        blind.retain(|&plane| support[plane] <= 10.0 * REACHED);
    }
    let (mut moved, mut kept): (Vec<PlacedWeight>, Vec<PlacedWeight>) =
        found.iter().partition(|weight| blind.contains(&weight.plane));
    if moved.is_empty() {
        return Ok(Some(kept));
    }
    let target = problem.made(&moved);
    for weight in &mut moved {
        weight.plane = blind.iter().position(|&p| p == weight.plane).unwrap_or_default();
    }
    let own: Vec<Vec<Complex64>> = blind.iter().map(|&p| directions[p].clone()).collect();
    let some = Problem {
        rows: problem.rows.select_columns(&blind),
        target,
        bounds: blind.iter().map(|&p| bounds[p]).collect(),
        directions: Some(own.clone()),
        cancel: problem.cancel,
    };
    let Some(least) = squares(&some, &own, &moved)? else { return Ok(None) };
    kept.extend(least.into_iter().map(|each| PlacedWeight { plane: blind[each.plane], ..each }));
    kept.sort_by_key(|weight| (weight.plane, weight.angle));
    Ok(Some(kept))
}

/// Of weights that do the same as those given, within bounds, those with the least sum of squares;
/// none if they are not found to nine digits.
fn squares(
    problem: &Problem,
    directions: &Directions,
    found: &[PlacedWeight],
) -> Result<Option<Vec<PlacedWeight>>> {
    let (bounds, equations) = (&problem.bounds, problem.target.len());
    let columns = AngleColumns::new(problem, directions, bounds)?;
    let mut sums = DMatrix::zeros(bounds.len(), columns.made.ncols());
    for (j, &(plane, _)) in columns.places.iter().enumerate() {
        sums[(plane, j)] = 1.0;
    }
    let start = columns.variables(found, bounds);
    let held = stack(&columns.made, &columns.filled);
    let value = &held * &start;
    let none = DVector::zeros(bounds.len());
    let mut best = Minimum::start(start, value.len());
    for penalty in PENALTIES {
        best = minimum([&sums, &held], [&none, &value], best, penalty, problem.cancel)?;
        // No weights that do the same have less than what the multipliers promise.
        let multipliers = &best.multipliers.as_slice()[..equations];
        let lambda = Vectors::from_column_slice(equations / 2, 2, multipliers);
        let spent = problem.support(&lambda).into_iter().zip(bounds).map(|(h, b)| energy(h, *b));
        let promised = lambda.dot(&problem.target) - spent.sum::<f64>();
        let squares = (&sums * &best.x).norm_squared() / 2.0;
        let is_least = squares - promised <= REACHED * squares.max(1.0);
        if is_least && best.missing <= ROUNDING {
            return Ok(Some(columns.weights(&best.x)));
        }
    }
    Ok(None)
}

/// What unit weights in planes and directions exert: a column for each, x of the equations and then y.
pub(super) fn made_by(rows: &DMatrix<f64>, units: &[(usize, Complex64)]) -> DMatrix<f64> {
    let count = rows.nrows();
    DMatrix::from_fn(2 * count, units.len(), |k, j| {
        let (plane, unit) = units[j];
        rows[(k % count, plane)] * if k < count { unit.re } else { unit.im }
    })
}

/// Variables of planes with lists of angles: amounts, then the room that each bound leaves.
struct AngleColumns {
    /// Plane and angle of each amount.
    places: Vec<(usize, usize)>,
    /// Plane and direction of each amount.
    units: Vec<(usize, Complex64)>,
    /// What the variables exert.
    made: DMatrix<f64>,
    /// Amounts and room of each plane with a bound.
    filled: DMatrix<f64>,
}

impl AngleColumns {
    fn new(problem: &Problem, directions: &Directions, bounds: &[f64]) -> Result<Self> {
        let places: Vec<(usize, usize)> = directions
            .iter()
            .enumerate()
            .flat_map(|(p, of)| (0..of.len()).map(move |k| (p, k)))
            .collect();
        let units: Vec<_> = places.iter().map(|&(p, k)| (p, directions[p][k])).collect();
        let bounded: Vec<usize> = finite(bounds).collect();
        let (amounts, room) = (places.len(), bounded.len());
        // As much as these matrices, sums by plane and stacks of them take: nalgebra would abort.
        let rows = 2 * problem.rows.nrows() + room + bounds.len();
        memory::room::<f64>(4 * rows * (amounts + room))?;
        let made = made_by(&problem.rows, &units).resize_horizontally(amounts + room, 0.0);
        let filled = DMatrix::from_fn(room, amounts + room, |row, j| {
            let is_own = if j < amounts { places[j].0 == bounded[row] } else { j - amounts == row };
            f64::from(is_own)
        });
        Ok(Self { places, units, made, filled })
    }

    fn weights(&self, x: &DVector<f64>) -> Vec<PlacedWeight> {
        let each = self.places.iter().zip(&self.units).zip(x.iter());
        each.filter(|(_, amount)| **amount > 0.0)
            .map(|((&(plane, angle), (_, unit)), amount)| PlacedWeight {
                plane,
                angle,
                vector: unit * amount,
            })
            .collect()
    }

    fn variables(&self, weights: &[PlacedWeight], bounds: &[f64]) -> DVector<f64> {
        let mut x = DVector::zeros(self.made.ncols());
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

/// Conjugate of ½s² for 0 ≤ s ≤ bound.
fn energy(support: f64, bound: f64) -> f64 {
    let s = support.min(bound);
    s * (support - 0.5 * s)
}

fn finite(bounds: &[f64]) -> impl Iterator<Item = usize> {
    (0..bounds.len()).filter(|&p| bounds[p].is_finite())
}
