//! Least squares: by singular values, and of variables that are zero or more under linear equations.

use nalgebra::{DMatrix, DVector};

use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::singular_values::SingularValues;

/// Singular values below this part of the largest count as zero: the columns that they distinguish
/// differ by no more than the rounding of ill-conditioned fits before (planes a millionth of the
/// engine's length apart leave 1e-10), and a solution would magnify that difference 1e9-fold.
pub(super) const RANK_TOLERANCE: f64 = 1e-9;

/// Solution of `rows · x ≈ targets` with the least residual and, of those, the least norm.
pub(super) struct LeastSquares {
    pub solution: DMatrix<f64>,
    /// Number of independent equations.
    pub rank: usize,
}

/// Solve by the `most` largest singular values at most, one column of `targets` at a time.
pub(super) fn least_squares(
    rows: &DMatrix<f64>,
    targets: &DMatrix<f64>,
    most: usize,
) -> LeastSquares {
    let values = SingularValues::of(rows);
    let rank = values.rank(RANK_TOLERANCE).min(most);
    LeastSquares { solution: values.solve(targets, rank), rank }
}

/// Weights of the equations beside the squares, one after another until the minimum is good enough.
/// Each round gains about as many digits, unless the variables that are left barely distinguish the
/// equations; a great weight finds their multipliers then, and costs digits of the squares.
pub(super) const PENALTIES: [f64; 5] = [1e4, 1e6, 1e8, 1e6, 1e4];
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

impl Minimum {
    /// Feasible variables to start from, and no multipliers.
    pub fn start(x: DVector<f64>, equations: usize) -> Self {
        Self { x, multipliers: DVector::zeros(equations), missing: 0.0 }
    }
}

/// Minimise |rows·x − target|² over x ≥ 0 with held·x = value, from feasible variables.
///
/// An augmented Lagrangian: equations weigh so moderately that no digits are lost, and their
/// multipliers make up for the rest.
pub(super) fn minimum(
    [rows, held]: [&DMatrix<f64>; 2],
    [target, value]: [&DVector<f64>; 2],
    mut found: Minimum,
    penalty: f64,
    cancel: &Cancel,
) -> Result<Minimum> {
    let weight = penalty.sqrt();
    let stacked = stack(rows, &(held * weight));
    for _ in 0..ROUNDS {
        let wanted = (value + &found.multipliers / penalty) * weight;
        let mut goal = target.clone().resize_vertically(stacked.nrows(), 0.0);
        goal.rows_mut(target.nrows(), held.nrows()).copy_from(&wanted);
        found.x = nonnegative(&stacked, &goal, found.x, cancel)?;
        let missing = value - held * &found.x;
        found.missing = missing.amax();
        if found.missing <= EXACT {
            break;
        }
        found.multipliers += missing * penalty;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependent_columns_share_the_solution() {
        // The second column differs from the first by rounding, the third is independent.
        let rows = DMatrix::from_row_slice(2, 3, &[1.0, 1.0 + 1e-13, 0.0, 1.0, 1.0, 2.0]);
        let found = least_squares(&rows, &DMatrix::from_row_slice(2, 1, &[4.0, 4.0]), 2);
        assert_eq!(found.rank, 2);
        // x₁ = x₂ = 2 but for the rounding of the columns
        for (x, expected) in found.solution.iter().zip([2.0, 2.0, 0.0]) {
            assert!((x - expected).abs() < 1e-12, "{x}");
        }
        let alone = least_squares(&rows.columns(0, 2).into_owned(), &DMatrix::zeros(2, 1), 2);
        assert_eq!(alone.rank, 1);
        assert_eq!(least_squares(&DMatrix::zeros(2, 2), &DMatrix::zeros(2, 1), 2).rank, 0);
    }
}
