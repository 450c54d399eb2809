//! Least squares of variables that are zero or more, under linear equations.

use nalgebra::{DMatrix, DVector};

use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;

/// Weight of the equations beside the squares: each round gains about as many digits.
const PENALTY: f64 = 1e4;
/// What may be missing from an equation; figures are of order 1.
const EXACT: f64 = 1e-13;
const ROUNDS: usize = 60;

/// Variables and the multipliers of the equations.
pub(super) struct Minimum {
    pub x: DVector<f64>,
    pub multipliers: DVector<f64>,
    /// Largest error of an equation.
    pub missing: f64,
}

/// Minimise |rows·x − target|² over x ≥ 0 with held·x = value, from a feasible `start`.
///
/// An augmented Lagrangian: equations weigh so moderately that no digits are lost, and their
/// multipliers make up for the rest.
pub(super) fn minimum(
    [rows, held]: [&DMatrix<f64>; 2],
    [target, value]: [&DVector<f64>; 2],
    start: DVector<f64>,
    cancel: &Cancel,
) -> Result<Minimum> {
    let weight = PENALTY.sqrt();
    let stacked = stack(rows, &(held * weight));
    let mut found = Minimum { x: start, multipliers: DVector::zeros(held.nrows()), missing: 0.0 };
    for _ in 0..ROUNDS {
        let wanted = (value + &found.multipliers / PENALTY) * weight;
        let mut goal = target.clone().resize_vertically(stacked.nrows(), 0.0);
        goal.rows_mut(target.nrows(), held.nrows()).copy_from(&wanted);
        found.x = nonnegative(&stacked, &goal, found.x, cancel)?;
        let missing = value - held * &found.x;
        found.missing = missing.amax();
        if found.missing <= EXACT {
            break;
        }
        found.multipliers += missing * PENALTY;
    }
    Ok(found)
}

/// Lawson and Hanson's active set from a feasible x: minimise |columns·x − target|² over x ≥ 0.
fn nonnegative(
    columns: &DMatrix<f64>,
    target: &DVector<f64>,
    mut x: DVector<f64>,
    cancel: &Cancel,
) -> Result<DVector<f64>> {
    /// Gradients below this part of the figures they are made of are rounding.
    const FLAT: f64 = 1e-14;
    let norms: Vec<f64> = columns.column_iter().map(|column| column.norm()).collect();
    let mut used: Vec<usize> = (0..x.len()).filter(|&k| x[k] > 0.0).collect();
    let mut rejected = vec![false; x.len()];
    let mut entered = None;
    // Each step lowers the sum of squares, but for rounding: what comes of it is checked elsewhere.
    for _ in 0..1000 + 10 * x.len() {
        cancel.check()?;
        let Some(best) = on(columns, &used, target) else {
            // The column entered last depends on the others.
            let Some(last) = entered.take().or_else(|| used.last().copied()) else { return Ok(x) };
            used.retain(|&k| k != last);
            x[last] = 0.0;
            rejected[last] = true;
            continue;
        };
        if let Some(new) = entered.take()
            && used.last() == Some(&new)
            && best[used.len() - 1] <= 0.0
        {
            // A gradient of rounding.
            used.pop();
            rejected[new] = true;
        } else if let Some(part) = (0..used.len())
            .filter(|&i| best[i] <= 0.0)
            .map(|i| x[used[i]] / (x[used[i]] - best[i]))
            .reduce(f64::min)
        {
            for (i, &k) in used.iter().enumerate() {
                let moved = x[k] + part * (best[i] - x[k]);
                let leaves = best[i] <= 0.0 && x[k] / (x[k] - best[i]) <= part;
                x[k] = if leaves { 0.0 } else { moved.max(0.0) };
            }
            used.retain(|&k| x[k] > 0.0);
            rejected.fill(false);
            continue;
        } else {
            let moved = used.iter().enumerate().any(|(i, &k)| x[k] != best[i]);
            for (i, &k) in used.iter().enumerate() {
                x[k] = best[i];
            }
            if moved {
                rejected.fill(false);
            }
        }
        let rest = target - columns * &x;
        let flat = FLAT * target.norm().max(rest.norm());
        let gradient = columns.tr_mul(&rest);
        let steepest = (0..x.len())
            .filter(|&k| !rejected[k] && x[k] == 0.0 && gradient[k] > flat * norms[k])
            .max_by(|&j, &k| (gradient[j] * norms[k]).total_cmp(&(gradient[k] * norms[j])));
        let Some(steepest) = steepest else { return Ok(x) };
        used.retain(|&k| x[k] > 0.0);
        used.push(steepest);
        entered = Some(steepest);
    }
    Ok(x)
}

/// Least squares on some columns; None where they depend on each other.
fn on(columns: &DMatrix<f64>, used: &[usize], target: &DVector<f64>) -> Option<DVector<f64>> {
    if used.is_empty() {
        return Some(DVector::zeros(0));
    }
    if used.len() > columns.nrows() {
        return None;
    }
    let factors = columns.select_columns(used).qr();
    let mut turned = target.clone();
    factors.q_tr_mul(&mut turned);
    let upper = factors.r();
    let diagonal = upper.diagonal().abs();
    if diagonal.min() <= f64::EPSILON * columns.nrows() as f64 * diagonal.max() {
        return None;
    }
    upper.solve_upper_triangular(&turned.rows(0, used.len()).into_owned())
}

/// One matrix below another.
pub(super) fn stack(above: &DMatrix<f64>, below: &DMatrix<f64>) -> DMatrix<f64> {
    let mut both = above.clone().resize_vertically(above.nrows() + below.nrows(), 0.0);
    both.rows_mut(above.nrows(), below.nrows()).copy_from(below);
    both
}
