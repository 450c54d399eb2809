//! Singular values of small matrices, by Hestenes' one-sided Jacobi method.
//!
//! It recomposes nearly singular matrices to rounding, which the SVD of `nalgebra` 0.35 does not: it
//! misses some 2×2 matrices with dependent columns by 10 % and more.

use nalgebra::{DMatrix, DVector, SMatrix};

/// `A = Σₖ valueₖ · leftₖ · rightₖ`, without the terms whose value is zero.
pub(crate) struct SingularValues {
    /// From the largest down, above zero.
    pub values: Vec<f64>,
    /// Orthonormal columns.
    pub left: DMatrix<f64>,
    /// Orthonormal rows.
    pub right: DMatrix<f64>,
}

impl SingularValues {
    /// Decompose a matrix of finite numbers.
    ///
    /// Rows, or columns where there are fewer, are turned in pairs until all are at right angles: their
    /// lengths are then the singular values.
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        let is_wide = matrix.nrows() <= matrix.ncols();
        let scale = scale_of(matrix.amax());
        let mut turned = if is_wide { matrix.transpose() } else { matrix.clone() } / scale;
        let (rows, count) = turned.shape();
        let mut turns = DMatrix::identity(count, count);
        turn_to_right_angles(turned.as_mut_slice(), rows, turns.as_mut_slice(), count);
        let lengths: Vec<f64> = turned.column_iter().map(|column| column.norm()).collect();
        let mut order: Vec<usize> = (0..count).filter(|&k| lengths[k] > 0.0).collect();
        order.sort_by(|&j, &k| lengths[k].total_cmp(&lengths[j]));
        let turns = turns.select_columns(&order);
        let mut units = turned.select_columns(&order);
        for (mut unit, &k) in units.column_iter_mut().zip(&order) {
            unit /= lengths[k];
        }
        let values = order.iter().map(|&k| lengths[k] * scale).collect();
        let (left, right) = if is_wide { (turns, units) } else { (units, turns) };
        Self { values, left, right: right.transpose() }
    }

    /// Number of values above a part of the largest.
    pub fn rank(&self, tolerance: f64) -> usize {
        let largest = self.values.first().copied().unwrap_or_default();
        self.values.iter().take_while(|&&value| value > tolerance * largest).count()
    }

    /// Solution of `A·X ≈ targets` with the least norm, by the first `rank` values.
    pub fn solve(&self, targets: &DMatrix<f64>, rank: usize) -> DMatrix<f64> {
        let values = DVector::from_column_slice(&self.values[..rank]);
        let mut along = self.left.columns(0, rank).tr_mul(targets);
        for mut column in along.column_iter_mut() {
            column.component_div_assign(&values);
        }
        self.right.rows(0, rank).tr_mul(&along)
    }
}

/// Rounds through all pairs. Each about squares what is missing from right angles; six to ten suffice.
const SWEEPS: usize = 60;

/// Singular values of a square matrix, from the largest down, zeros too, and their right-hand vectors, a column each.
pub(crate) fn right_vectors<const N: usize>(
    matrix: &SMatrix<f64, N, N>,
) -> ([f64; N], SMatrix<f64, N, N>) {
    let scale = scale_of(matrix.amax());
    let (mut turned, mut turns) = (matrix / scale, SMatrix::<f64, N, N>::identity());
    turn_to_right_angles(turned.as_mut_slice(), N, turns.as_mut_slice(), N);
    let lengths: [f64; N] = std::array::from_fn(|k| turned.column(k).norm());
    let mut order: [usize; N] = std::array::from_fn(|k| k);
    order.sort_by(|&j, &k| lengths[k].total_cmp(&lengths[j]));
    let sorted = SMatrix::from_fn(|row, column| turns[(row, order[column])]);
    (order.map(|k| lengths[k] * scale), sorted)
}

/// Power of two over which figures are of order 1, whose squares neither overflow nor vanish. It rounds nothing, and
/// one below 2¹⁰²³ has an inverse.
pub(crate) fn scale_of(largest: f64) -> f64 {
    largest.log2().floor().clamp(-1022.0, 1022.0).exp2()
}

/// Turns columns in pairs until all are at right angles, and those of a second matrix, of as many rows, with them.
///
/// Inlined, so that lengths that are known become those of the loops.
#[inline(always)]
fn turn_to_right_angles(columns: &mut [f64], rows: usize, turns: &mut [f64], count: usize) {
    for _ in 0..SWEEPS {
        let mut is_done = true;
        for k in 0..count {
            for j in 0..k {
                let (first, second) = pair(columns, rows, j, k);
                if let Some(turn) = right_angle(first, second) {
                    is_done = false;
                    turn_pair(first, second, turn);
                    let (first, second) = pair(turns, count, j, k);
                    turn_pair(first, second, turn);
                }
            }
        }
        if is_done {
            return;
        }
    }
}

/// Columns j < k.
#[inline(always)]
fn pair(columns: &mut [f64], rows: usize, j: usize, k: usize) -> (&mut [f64], &mut [f64]) {
    let (before, after) = columns.split_at_mut(k * rows);
    (&mut before[j * rows..(j + 1) * rows], &mut after[..rows])
}

/// Cosine and sine of the turn that brings two columns to right angles; None where they are, to rounding.
#[inline(always)]
fn right_angle(first: &[f64], second: &[f64]) -> Option<[f64; 2]> {
    let (mut one, mut other, mut product) = (0.0, 0.0, 0.0);
    for (a, b) in first.iter().zip(second) {
        one += a * a;
        other += b * b;
        product += a * b;
    }
    let [one, other] = [one.sqrt(), other.sqrt()];
    // The sum of products rounds by half a unit in the last place each.
    let rounding = f64::EPSILON * (first.len() as f64).sqrt();
    if product.abs() <= rounding * one * other {
        return None;
    }
    let cotangent = (other - one) * (other + one) / (2.0 * product);
    let tangent = cotangent.signum() / (cotangent.abs() + cotangent.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    Some([cosine, cosine * tangent])
}

#[inline(always)]
fn turn_pair(first: &mut [f64], second: &mut [f64], [cosine, sine]: [f64; 2]) {
    for (one, other) in first.iter_mut().zip(second) {
        (*one, *other) = (cosine * *one - sine * *other, sine * *one + cosine * *other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::draws;

    /// Worst errors, relative to the largest value, of a recomposition, and of right angles.
    fn check(matrix: &DMatrix<f64>) {
        let found = SingularValues::of(matrix);
        let SingularValues { values, left, right } = &found;
        let size = (matrix.nrows() * matrix.ncols()).max(1) as f64;
        // Some ten turns of each pair, with a few roundings each.
        let rounding = 16.0 * f64::EPSILON * size.sqrt();
        let largest = values.first().copied().unwrap_or_default();
        assert!(values.windows(2).all(|pair| pair[0] >= pair[1]) && !values.contains(&0.0));
        let mut scaled = left.clone();
        for (mut column, value) in scaled.column_iter_mut().zip(values) {
            column *= value / largest;
        }
        let missing = (scaled * right - matrix / largest.max(f64::MIN_POSITIVE)).amax();
        assert!(missing <= rounding || matrix.amax() == 0.0, "{matrix} {values:?} {missing}");
        let one = DMatrix::identity(values.len(), values.len());
        for product in [left.tr_mul(left), right * right.transpose()] {
            assert!((product - &one).amax() <= rounding, "{matrix} {values:?}");
        }
    }

    /// A matrix of half of the full rank, and a small one added.
    fn nearly_singular(
        shape: [usize; 2],
        small: f64,
        mut number: impl FnMut() -> f64,
    ) -> DMatrix<f64> {
        let [rows, columns] = shape;
        let rank = rows.min(columns).div_ceil(2);
        let mut some = |rows, columns| DMatrix::from_fn(rows, columns, |_, _| number());
        let within = some(rows, rank) * some(rank, columns);
        within + some(rows, columns) * small
    }

    #[test]
    fn matrices_are_recomposed_whatever_their_rank() {
        let mut number = draws(11);
        for shape in [[1, 1], [1, 3], [2, 2], [2, 1], [2, 5], [4, 2], [4, 4], [4, 9], [7, 3]] {
            for small in [0.0, 1e-300, 1e-17, 1e-16, 3e-15, 1e-12, 1e-8, 1e-3, 1.0] {
                for scale in [1.0, 1e-300, 1e-160, 1e150, 1e300] {
                    for _ in 0..20 {
                        check(&(nearly_singular(shape, small, &mut number) * scale));
                    }
                }
            }
        }
        check(&DMatrix::zeros(2, 3));
        check(&DMatrix::zeros(0, 3));
        // Rounded to a multiple of the smallest number.
        assert_eq!(SingularValues::of(&DMatrix::from_element(2, 2, 5e-324)).values, [1e-323]);
        check(&DMatrix::from_element(2, 2, f64::MAX / 4.0));
        check(&DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 1e-200]));
    }

    #[test]
    fn columns_that_differ_by_rounding_are_recomposed() {
        // nalgebra misses these by 13 %, and most alike.
        let [a, b] = [3.453_051_849_220_227_5e-4, 1.993_620_414_673_037_9e-4];
        check(&DMatrix::from_row_slice(2, 2, &[a, -3.453_051_849_220_236e-4, b, -b]));
        let mut number = draws(3);
        for _ in 0..10_000 {
            let [a, b] = [number(), number()];
            let mut almost = |x: f64| x * (1.0 + f64::EPSILON * (4.0 * number()).round());
            check(&DMatrix::from_row_slice(2, 2, &[a, almost(-a), b, almost(-b)]));
            check(&DMatrix::from_row_slice(2, 2, &[a, b, almost(a), almost(b)]));
        }
    }

    #[test]
    fn the_rank_is_the_number_of_values_above_the_tolerance() {
        let mut number = draws(5);
        for _ in 0..1000 {
            let [angle, other] = [number(), number()].map(|x| 4.0 * x);
            let turn = |angle: f64| {
                let (sine, cosine) = angle.sin_cos();
                DMatrix::from_row_slice(2, 2, &[cosine, -sine, sine, cosine])
            };
            let with = |small: f64| {
                let values = DMatrix::from_row_slice(2, 2, &[2.0, 0.0, 0.0, 2.0 * small]);
                SingularValues::of(&(turn(angle) * values * turn(other)))
            };
            assert_eq!(with(1.1e-9).rank(1e-9), 2);
            assert_eq!(with(0.9e-9).rank(1e-9), 1);
            // To rounding of the largest.
            assert!((with(1e-9).values[1] - 2e-9).abs() < 1e-14);
            assert!(with(0.0).values.get(1).is_none_or(|&value| value < 1e-14));
        }
        assert_eq!(SingularValues::of(&DMatrix::zeros(2, 2)).rank(1e-9), 0);
    }
}
