//! Weights of planes with bounds and lists of angles: the nearest to a target and, of these, the least.

use nalgebra::{DMatrix, DVector};

use super::least_squares::{Minimum, PENALTIES, minimum, stack};
use super::weights::{PlacedWeight, Problem, SOLVED, SOLVER_ROUNDING, Vectors, complex, sums};
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
    let columns = AngleColumns::new(problem, directions, bounds, &vec![false; bounds.len()])?;
    let room = DVector::from_vec(columns.bounded.iter().map(|&p| bounds[p]).collect());
    let start = columns.variables(&[]);
    let goal = DVector::from_column_slice(target.as_slice());
    let rows = [&columns.exerted, &columns.filled];
    let mut found = Minimum::start(start, room.len());
    for penalty in PENALTIES {
        found = minimum(rows, [&goal, &room], found, penalty, problem.cancel)?;
        if found.missing <= SOLVER_ROUNDING {
            return Ok(Some(columns.weights(&found.x)));
        }
    }
    Ok(None)
}

/// Of weights that come as near as those given, within bounds, those with the least sum of squares;
/// none if they are not found to nine digits.
///
/// A residual has planes that see it at their bounds, at the angles that see the most of it: only among
/// these, where several see as much, and of other planes is there a choice.
pub(super) fn least_squares(
    problem: &Problem,
    directions: &Directions,
    bounds: &[f64],
    found: &[PlacedWeight],
) -> Result<Option<Vec<PlacedWeight>>> {
    let residual = problem.missing(found);
    let support = problem.support(&residual);
    let seen = complex(&problem.rows.tr_mul(&residual));
    let sums = sums(found, bounds.len());
    let is_full: Vec<bool> = (0..bounds.len())
        .map(|p| support[p] > UNSEEN_WEIGHT && sums[p] >= bounds[p] * (1.0 - SOLVED))
        .collect();
    let is_full = if residual.norm() > SOLVED { is_full } else { vec![false; bounds.len()] };
    let may_change = |p: usize, k: usize| {
        let along = (directions[p][k].conj() * seen[p]).re;
        let is_used = || found.iter().any(|weight| (weight.plane, weight.angle) == (p, k));
        !is_full[p] || along >= support[p] - UNSEEN_WEIGHT || is_used()
    };
    let kept: Vec<Vec<usize>> = (0..bounds.len())
        .map(|p| (0..directions[p].len()).filter(|&k| may_change(p, k)).collect())
        .collect();
    if kept.iter().zip(&is_full).all(|(angles, full)| *full && angles.len() == 1) {
        return Ok(Some(found.to_vec()));
    }
    let own: Vec<Vec<Complex64>> = kept
        .iter()
        .zip(directions)
        .map(|(angles, units)| angles.iter().map(|&k| units[k]).collect())
        .collect();
    let start = found.iter().map(|weight| {
        let angle = kept[weight.plane].iter().position(|&k| k == weight.angle);
        PlacedWeight { angle: angle.unwrap_or_default(), ..*weight }
    });
    let some = Problem {
        bounds: bounds.to_vec(),
        directions: Some(own.clone()),
        ..problem.with_equal_effect(found)
    };
    let least = squares(&some, &own, &start.collect::<Vec<_>>(), &is_full)?;
    let back =
        |weight: PlacedWeight| PlacedWeight { angle: kept[weight.plane][weight.angle], ..weight };
    Ok(least.map(|weights| weights.into_iter().map(back).collect()))
}

/// What a unit weight that sees nothing of a residual may see of it, by rounding.
const UNSEEN_WEIGHT: f64 = 10.0 * SOLVED;

/// Of weights that do the same as those given, within bounds, those with the least sum of squares; none
/// if they are not found to nine digits. Planes that are full keep the sums of their weights.
fn squares(
    problem: &Problem,
    directions: &Directions,
    found: &[PlacedWeight],
    is_full: &[bool],
) -> Result<Option<Vec<PlacedWeight>>> {
    let (bounds, equations) = (&problem.bounds, problem.target.len());
    let columns = AngleColumns::new(problem, directions, bounds, is_full)?;
    let mut sums = DMatrix::zeros(bounds.len(), columns.exerted.ncols());
    for (j, &(plane, _)) in columns.places.iter().enumerate() {
        sums[(plane, j)] = f64::from(u8::from(!is_full[plane]));
    }
    let start = columns.variables(found);
    let held = stack(&columns.exerted, &columns.filled);
    let value = &held * &start;
    let full = self::sums(found, bounds.len());
    let none = DVector::zeros(bounds.len());
    let mut best = Minimum::start(start, value.len());
    for penalty in PENALTIES {
        best = minimum([&sums, &held], [&none, &value], best, penalty, problem.cancel)?;
        // No weights that do the same have less than what the multipliers promise. Those along the
        // residual may be as great as one likes: they cost full planes nothing at these angles.
        let multipliers = &best.multipliers.as_slice()[..equations];
        let lambda = Vectors::from_column_slice(equations / 2, 2, multipliers);
        let seen = complex(&problem.rows.tr_mul(&lambda));
        let spent = problem.support(&lambda).into_iter().enumerate().map(|(p, support)| {
            if is_full[p] {
                let along = directions[p].iter().map(|unit| (unit.conj() * seen[p]).re);
                full[p] * along.fold(f64::NEG_INFINITY, f64::max)
            } else {
                energy(support, bounds[p])
            }
        });
        let promised = lambda.dot(&problem.target) - spent.sum::<f64>();
        let squares = (&sums * &best.x).norm_squared() / 2.0;
        let is_least = squares - promised <= SOLVED * squares.max(1.0);
        if is_least && best.missing <= SOLVER_ROUNDING {
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

/// Variables of planes with lists of angles: amounts, then the room that bounds leave.
struct AngleColumns<'a> {
    bounds: &'a [f64],
    /// Planes with a bound; of those that are not full the room is a variable.
    bounded: Vec<usize>,
    roomy: Vec<usize>,
    /// Plane and angle of each amount.
    places: Vec<(usize, usize)>,
    /// Plane and direction of each amount.
    units: Vec<(usize, Complex64)>,
    /// What the variables exert.
    exerted: DMatrix<f64>,
    /// Amounts and room of each plane with a bound.
    filled: DMatrix<f64>,
}

impl<'a> AngleColumns<'a> {
    fn new(
        problem: &Problem,
        directions: &Directions,
        bounds: &'a [f64],
        is_full: &[bool],
    ) -> Result<Self> {
        let places: Vec<(usize, usize)> = directions
            .iter()
            .enumerate()
            .flat_map(|(p, of)| (0..of.len()).map(move |k| (p, k)))
            .collect();
        let units: Vec<_> = places.iter().map(|&(p, k)| (p, directions[p][k])).collect();
        let bounded: Vec<usize> = (0..bounds.len()).filter(|&p| bounds[p].is_finite()).collect();
        let roomy: Vec<usize> = bounded.iter().copied().filter(|&p| !is_full[p]).collect();
        let (amounts, all) = (places.len(), places.len() + roomy.len());
        // As much as these matrices, sums by plane and stacks of them take: nalgebra would abort.
        let rows = 2 * problem.rows.nrows() + bounded.len() + bounds.len();
        memory::with_capacity::<f64>(4 * rows * all)?;
        let exerted = made_by(&problem.rows, &units).resize_horizontally(all, 0.0);
        let filled = DMatrix::from_fn(bounded.len(), all, |row, j| {
            let plane = if j < amounts { places[j].0 } else { roomy[j - amounts] };
            f64::from(u8::from(plane == bounded[row]))
        });
        Ok(Self { bounds, bounded, roomy, places, units, exerted, filled })
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

    fn variables(&self, weights: &[PlacedWeight]) -> DVector<f64> {
        let mut x = DVector::zeros(self.exerted.ncols());
        for weight in weights {
            let here = |place: &(usize, usize)| *place == (weight.plane, weight.angle);
            if let Some(j) = self.places.iter().position(here) {
                x[j] += weight.vector.norm();
            }
        }
        let used = sums(weights, self.bounds.len());
        for (k, &p) in self.roomy.iter().enumerate() {
            x[self.places.len() + k] = (self.bounds[p] - used[p]).max(0.0);
        }
        x
    }
}

/// Conjugate of ½s² for 0 ≤ s ≤ bound.
fn energy(support: f64, bound: f64) -> f64 {
    let s = support.min(bound);
    s * (support - 0.5 * s)
}
