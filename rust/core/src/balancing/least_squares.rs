//! Least squares by singular values.

use nalgebra::{DMatrix, SVD};

/// Singular values below this part of the largest count as zero: the columns that they tell apart
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
    let mut solution = DMatrix::zeros(rows.ncols(), targets.ncols());
    if rows.is_empty() {
        return LeastSquares { solution, rank: 0 };
    }
    let SVD { u, v_t, singular_values } = rows.clone().svd(true, true);
    let (Some(u), Some(v_t)) = (u, v_t) else { return LeastSquares { solution, rank: 0 } };
    let largest = singular_values.max();
    let significant = |k: &usize| singular_values[*k] > RANK_TOLERANCE * largest;
    let kept: Vec<usize> = (0..singular_values.len()).filter(significant).take(most).collect();
    for &k in &kept {
        let along = u.column(k).transpose() * targets / singular_values[k];
        solution += v_t.row(k).transpose() * along;
    }
    LeastSquares { solution, rank: kept.len() }
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
