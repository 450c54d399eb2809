//! Weights of planes with bounds, at any angle, that come nearest to a target.

use nalgebra::{DMatrix, DVector};

use super::least_squares::RANK_TOLERANCE;
use super::weights::{SOLVED, SOLVER_ROUNDING, Vectors};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::singular_values::SingularValues;

/// Weights |u| ≤ bound nearest to the target and, of those, with the least sum of squares.
///
/// They are u = λᵀ·rows, cut to their bounds, with multipliers λ that maximise a concave function
/// of at most four real variables. A target beyond reach leaves a residual r, and λ grows along it:
/// all planes are at their bounds then, but those that cannot see r, which are at one place.
pub(super) fn nearest(
    rows: &DMatrix<f64>,
    target: &Vectors,
    bounds: &[f64],
    cancel: &Cancel,
) -> Result<Option<Vectors>> {
    // Equations that depend on each other become one: multipliers are then bounded.
    let values = SingularValues::of(rows);
    let basis = values.left.columns(0, values.rank(RANK_TOLERANCE));
    let discs = Discs { rows: basis.tr_mul(rows), target: basis.tr_mul(target), bounds };
    if let Some(found) = discs.but_one_place() {
        return Ok(Some(found));
    }
    let mut multipliers = Vectors::zeros(discs.target.nrows(), 2);
    // Squares weigh less and less beside what is missing: at last no more than its rounding.
    for power in 0..=15 {
        cancel.check()?;
        multipliers = discs.maximum(multipliers, 10.0_f64.powi(-power));
        let left = discs.rest(&multipliers).norm();
        let found = discs.weights(&multipliers);
        let mut sizes = found.row_iter().map(|weight| weight.norm()).zip(bounds);
        let full = |(size, bound): (f64, &f64)| size >= bound * (1.0 - 1e-14);
        if left <= 1e-15 || left > SOLVED && sizes.all(full) {
            break;
        }
    }
    Ok(Some(discs.weights(&multipliers)))
}

struct Discs<'a> {
    /// Independent equations.
    rows: DMatrix<f64>,
    target: Vectors,
    bounds: &'a [f64],
}

impl Discs<'_> {
    fn weights(&self, multipliers: &Vectors) -> Vectors {
        let mut found = self.rows.tr_mul(multipliers);
        for (mut weight, &bound) in found.row_iter_mut().zip(self.bounds) {
            let size = weight.norm();
            if size > bound {
                weight *= bound / size;
            }
        }
        found
    }

    fn rest(&self, multipliers: &Vectors) -> Vectors {
        &self.target - &self.rows * self.weights(multipliers)
    }

    /// Weights that leave a residual which planes at one place cannot see; None if there are none.
    fn but_one_place(&self) -> Option<Vectors> {
        if self.rows.nrows() < 2 {
            return None;
        }
        let planes = self.bounds.len();
        (0..planes).find_map(|place| {
            let [a, b] = [self.rows[(0, place)], self.rows[(1, place)]];
            let size = a.hypot(b);
            // Equations along what the place exerts, and across it.
            let turn = DMatrix::from_row_slice(2, 2, &[a, b, b, -a]) / size;
            let (rows, target) = (&turn * &self.rows, &turn * &self.target);
            let (mut there, others): (Vec<usize>, Vec<usize>) =
                (0..planes).partition(|&p| rows[(1, p)].abs() <= RANK_TOLERANCE * size);
            let wanted = target.row(1).norm();
            let reach: f64 = others.iter().map(|&p| self.bounds[p] * rows[(1, p)].abs()).sum();
            if wanted <= reach {
                return None;
            }
            let mut found = Vectors::zeros(planes, 2);
            for &p in &others {
                let size = self.bounds[p] * rows[(1, p)].signum() / wanted;
                found.set_row(p, &(target.row(1) * size));
            }
            let rest = target.row(0) - rows.row(0) * &found;
            // Planes at one place share what is left of the other component.
            there.sort_by(|&p, &q| self.bounds[p].total_cmp(&self.bounds[q]));
            let (length, count) = (rest.norm(), there.len());
            let mut amount = length / size;
            for (k, &p) in there.iter().enumerate().filter(|_| length > 0.0) {
                let here = self.bounds[p].min(amount / (count - k) as f64);
                found.set_row(p, &(&rest * (here * rows[(0, p)].signum() / length)));
                amount -= here;
            }
            (amount <= SOLVER_ROUNDING).then_some(found)
        })
    }

    /// Multipliers at which λ·target − ½·squares·|λ|² − Σ energies is the largest, by Newton's method:
    /// it is piecewise smooth and strictly concave, and a step beyond its maximum is halved.
    fn maximum(&self, mut multipliers: Vectors, squares: f64) -> Vectors {
        const STEPS: usize = 40;
        const SHORTEST: f64 = 1e-9;
        let count = multipliers.len();
        let gradient = |at: &Vectors| self.rest(at) - at * squares;
        for _ in 0..STEPS {
            let slope = gradient(&multipliers);
            let mut curvature = DMatrix::identity(count, count) * squares;
            let seen = self.rows.tr_mul(&multipliers);
            for ((seen, rows), &bound) in
                seen.row_iter().zip(self.rows.column_iter()).zip(self.bounds)
            {
                let size = seen.norm();
                let mut turns = DMatrix::identity(2, 2);
                if size > bound {
                    // Beyond the bound a weight only turns.
                    turns = (turns - seen.tr_mul(&seen) / (size * size)) * (bound / size);
                }
                curvature += turns.kronecker(&(rows * rows.transpose()));
            }
            let Some(factors) = curvature.cholesky() else { break };
            let solved = factors.solve(&DVector::from_column_slice(slope.as_slice()));
            let step = Vectors::from_column_slice(slope.nrows(), 2, solved.as_slice());
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
