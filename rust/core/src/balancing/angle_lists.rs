//! Weights of planes with bounds and lists of angles: the nearest to a target and, of these, the least.

use nalgebra::{DMatrix, DVector, RowVector2};

use super::least_squares::{FLAT, Minimum, PENALTIES, across, minimum, on, stack};
use super::weights::{Nearest, PlacedWeight, Problem, REACHED, ROUNDING, Vectors, complex, sums};
use crate::Complex64;
use crate::numbers::error::Result;
use crate::numbers::memory;

/// Unit vectors allowed in each plane.
type Directions = [Vec<Complex64>];

/// Weights within bounds that come nearest to a target, and what they leave.
///
/// Wolfe's nearest point of a polytope: a few of its corners, where every plane with a bound is full at
/// one angle or empty, and of the directions in which it has no end, are mixed; the one furthest along
/// the residual enters the mixture, as long as there is one.
pub(super) fn nearest(
    problem: &Problem,
    directions: &Directions,
    target: &Vectors,
    bounds: &[f64],
) -> Result<Nearest> {
    let goal = flat(target);
    let empty = Corner::new(problem, directions, Vec::new(), false);
    let mut mixed = vec![(empty, 1.0)];
    let mut residual = goal.clone();
    // Each step comes nearer, but for rounding: what comes of it is checked elsewhere.
    for _ in 0..1000 + 10 * bounds.len() {
        problem.cancel.check()?;
        let further = further(problem, directions, bounds, &mixed, &residual);
        let mixture = further.into_iter().find_map(|next| {
            mixed.push((next, 0.0));
            mix(&mut mixed, &goal)
        });
        let Some(left) = mixture else { break };
        residual = left;
    }
    let mut amounts: Vec<Vec<f64>> =
        directions.iter().map(|units| vec![0.0; units.len()]).collect();
    for (corner, share) in &mixed {
        for &(plane, angle, amount) in &corner.parts {
            amounts[plane][angle] += share * amount;
        }
    }
    let places = amounts.iter().enumerate().flat_map(|(plane, of)| {
        of.iter().enumerate().filter(|(_, x)| **x > 0.0).map(move |(angle, x)| PlacedWeight {
            plane,
            angle,
            vector: directions[plane][angle] * x,
        })
    });
    let residual = Vectors::from_row_slice(target.nrows(), 2, residual.as_slice());
    Ok(Nearest { weights: places.collect(), residual })
}

/// Equations one after another, x and y of each.
fn flat(vectors: &Vectors) -> DVector<f64> {
    DVector::from_column_slice(vectors.transpose().as_slice())
}

/// A corner of what weights within bounds can exert, or a direction in which there is no end.
struct Corner {
    /// Plane, angle and amount.
    parts: Vec<(usize, usize, f64)>,
    exerted: DVector<f64>,
    is_endless: bool,
}

impl Corner {
    fn new(
        problem: &Problem,
        directions: &Directions,
        parts: Vec<(usize, usize, f64)>,
        is_endless: bool,
    ) -> Self {
        let mut sums = Vectors::zeros(directions.len(), 2);
        for &(plane, angle, amount) in &parts {
            let vector = directions[plane][angle] * amount;
            sums.set_row(plane, &RowVector2::new(vector.re, vector.im));
        }
        Self { exerted: flat(&(&problem.rows * sums)), parts, is_endless }
    }
}

/// The corner, and before it the directions without end, that go further along a residual than the
/// mixture does, by more than rounding.
fn further(
    problem: &Problem,
    directions: &Directions,
    bounds: &[f64],
    mixed: &[(Corner, f64)],
    residual: &DVector<f64>,
) -> Vec<Corner> {
    let rows = Vectors::from_row_slice(problem.rows.nrows(), 2, residual.as_slice());
    let seen = complex(&problem.rows.tr_mul(&rows));
    let along = |p: usize, unit: &Complex64| (unit.conj() * seen[p]).re;
    let best: Vec<(usize, usize)> = (0..bounds.len())
        .filter_map(|p| {
            let sees = |&k: &usize| along(p, &directions[p][k]);
            let angle = (0..directions[p].len()).max_by(|j, k| sees(j).total_cmp(&sees(k)))?;
            (sees(&angle) > 0.0).then_some((p, angle))
        })
        .collect();
    let size = |of: &DVector<f64>| of.component_mul(residual).abs().sum();
    let is_more = |corner: &Corner, before: &DVector<f64>| {
        let more = corner.exerted.dot(residual) - before.dot(residual);
        more > FLAT * (size(&corner.exerted) + size(before))
    };
    let (full, endless): (Vec<_>, Vec<_>) = best.iter().partition(|(p, _)| bounds[*p].is_finite());
    let none = DVector::zeros(residual.len());
    let endless = endless.into_iter().map(|(p, k)| vec![(p, k, 1.0)]);
    let mut further: Vec<Corner> = endless
        .map(|part| Corner::new(problem, directions, part, true))
        .filter(|corner| is_more(corner, &none))
        .collect();
    let slope = |corner: &Corner| corner.exerted.dot(residual) / corner.exerted.norm();
    further.sort_by(|a, b| slope(b).total_cmp(&slope(a)));
    let full = full.into_iter().map(|(p, k)| (p, k, bounds[p])).collect();
    let corner = Corner::new(problem, directions, full, false);
    let before = mixed.iter().find(|(corner, _)| !corner.is_endless);
    if before.is_some_and(|(before, _)| is_more(&corner, &before.exerted)) {
        further.push(corner);
    }
    further
}

/// Mix corners, of which the last is new, nearest to a goal and leave out those without a share; what
/// is left of the goal. None where rounding keeps the new one out.
fn mix(mixed: &mut Vec<(Corner, f64)>, goal: &DVector<f64>) -> Option<DVector<f64>> {
    let mut is_new = true;
    loop {
        let (shares, residual) = shares(mixed, goal).or_else(|| {
            mixed.pop();
            None
        })?;
        if is_new && shares.last().is_some_and(|share| *share <= 0.0) {
            mixed.pop();
            return None;
        }
        is_new = false;
        let part = |(before, after): (f64, f64)| before / (before - after);
        let pairs = || mixed.iter().map(|(_, share)| *share).zip(shares.iter().copied());
        let limits = pairs().filter(|(_, after)| *after <= 0.0).map(part);
        let Some(least) = limits.reduce(f64::min) else {
            for ((_, share), after) in mixed.iter_mut().zip(shares) {
                *share = after;
            }
            return Some(residual);
        };
        let moved: Vec<f64> = pairs()
            .map(|(before, after)| {
                let leaves = after <= 0.0 && part((before, after)) <= least;
                if leaves { 0.0 } else { (before + least * (after - before)).max(0.0) }
            })
            .collect();
        for ((_, share), moved) in mixed.iter_mut().zip(moved) {
            *share = moved;
        }
        mixed.retain(|(_, share)| *share > 0.0);
    }
}

/// Shares of any sign nearest to a goal, those of corners 1 in all, and what is left of the goal; None
/// where corners depend on each other.
fn shares(mixed: &[(Corner, f64)], goal: &DVector<f64>) -> Option<(Vec<f64>, DVector<f64>)> {
    let corners = (0..mixed.len()).filter(|&k| !mixed[k].0.is_endless);
    let base = corners.max_by(|&j, &k| mixed[j].1.total_cmp(&mixed[k].1))?;
    let others: Vec<usize> = (0..mixed.len()).filter(|&k| k != base).collect();
    let from = &mixed[base].0.exerted;
    let mut left = goal - from;
    let mut shares = vec![0.0; mixed.len()];
    shares[base] = 1.0;
    if others.is_empty() {
        return Some((shares, left));
    }
    let columns: Vec<DVector<f64>> = others
        .iter()
        .map(|&k| {
            if mixed[k].0.is_endless {
                mixed[k].0.exerted.clone()
            } else {
                &mixed[k].0.exerted - from
            }
        })
        .collect();
    let columns = DMatrix::from_columns(&columns);
    let solution = on(&columns, &left)?;
    left = across(&columns, &left);
    for (&k, &share) in others.iter().zip(&solution) {
        shares[k] = share;
        shares[base] -= if mixed[k].0.is_endless { 0.0 } else { share };
    }
    Some((shares, left))
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
    residual: &Vectors,
) -> Result<Option<Vec<PlacedWeight>>> {
    let support = problem.support(residual);
    let seen = complex(&problem.rows.tr_mul(residual));
    let sums = sums(found, bounds.len());
    let is_full: Vec<bool> = (0..bounds.len())
        .map(|p| support[p] > BLIND && sums[p] >= bounds[p] * (1.0 - REACHED))
        .collect();
    let is_full = if residual.norm() > REACHED { is_full } else { vec![false; bounds.len()] };
    let may_change = |p: usize, k: usize| {
        let along = (directions[p][k].conj() * seen[p]).re;
        let is_used = || found.iter().any(|weight| (weight.plane, weight.angle) == (p, k));
        !is_full[p] || along >= support[p] - BLIND || is_used()
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
        ..problem.doing_the_same(found)
    };
    let least = squares(&some, &own, &start.collect::<Vec<_>>(), &is_full)?;
    let back =
        |weight: PlacedWeight| PlacedWeight { angle: kept[weight.plane][weight.angle], ..weight };
    Ok(least.map(|weights| weights.into_iter().map(back).collect()))
}

/// What a unit weight that sees nothing of a residual may see of it, by rounding.
const BLIND: f64 = 10.0 * REACHED;

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
    let mut sums = DMatrix::zeros(bounds.len(), columns.made.ncols());
    for (j, &(plane, _)) in columns.places.iter().enumerate() {
        sums[(plane, j)] = f64::from(u8::from(!is_full[plane]));
    }
    let start = columns.variables(found);
    let held = stack(&columns.made, &columns.filled);
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

/// Variables of planes with lists of angles: amounts, then the room that bounds leave.
struct AngleColumns<'a> {
    bounds: &'a [f64],
    /// Planes with a bound that are not full: their room is a variable.
    roomy: Vec<usize>,
    /// Plane and angle of each amount.
    places: Vec<(usize, usize)>,
    /// Plane and direction of each amount.
    units: Vec<(usize, Complex64)>,
    /// What the variables exert.
    made: DMatrix<f64>,
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
        memory::room::<f64>(4 * rows * all)?;
        let made = made_by(&problem.rows, &units).resize_horizontally(all, 0.0);
        let filled = DMatrix::from_fn(bounded.len(), all, |row, j| {
            let plane = if j < amounts { places[j].0 } else { roomy[j - amounts] };
            f64::from(u8::from(plane == bounded[row]))
        });
        Ok(Self { bounds, roomy, places, units, made, filled })
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
        let mut x = DVector::zeros(self.made.ncols());
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
