//! Stability and convergence of a law that adapts actuators' phasors to what receivers measure.
//!
//! w ← w − μ·Ŝᴴe with e = d + S·w. In the singular vectors of S its parts are each by itself: with an error φ of the
//! model's phase, and D updates until one is measured, xₙ₊₁ = xₙ − a·e^{iφ}·xₙ₋D. Roots of z^D(z − 1) + a·e^{iφ} leave
//! the unit circle at a = 2 sin((π/2 − |φ|)/(2D + 1)).

use nalgebra::{DMatrix, Schur};

use super::phasors::{real_column, real_matrix};
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::singular_values::SingularValues;
use crate::numbers::{memory, pool};

/// Square of a singular value over the largest that rounding makes of zero.
const SQUARE_ROUNDING: f64 = 1e-24;
/// Updates between two checks for cancellation.
const UPDATES_AT_ONCE: usize = 1024;

/// A law that adapts at some points.
#[derive(Debug, Clone, PartialEq)]
pub struct AdaptiveLaw {
    /// Of each point the step of each part, a·e^{iφ}, and the parts at the receivers, in real numbers: a column each,
    /// two of each complex part.
    points: Vec<(Vec<Complex64>, DMatrix<f64>)>,
    update_delay: usize,
}

/// Step from which on a law diverges, 0 where any does, of an error of the model's phase, degrees.
#[must_use]
pub fn largest_step(error_deg: f64, update_delay: usize) -> f64 {
    let left = (90.0 - error_deg.abs()).max(0.0).to_radians();
    2.0 * (left / (2 * update_delay + 1) as f64).sin()
}

impl AdaptiveLaw {
    /// What a unit of each of some actuators does at the receivers, row by row, point by point; the error of the model's
    /// phase at each point, degrees; and the step over the largest singular value squared.
    pub fn new(
        effect: &[Complex64],
        actuators: usize,
        error_deg: &[f64],
        step: f64,
        update_delay: usize,
        cancel: &Cancel,
    ) -> Result<Self> {
        let width = (effect.len() / error_deg.len().max(1)).max(1);
        let tasks = memory::collected(effect.chunks(width).zip(error_deg))?;
        let points = pool::map(cancel, tasks, |(effect, error_deg)| {
            cancel.check()?;
            let SingularValues { values, left, .. } =
                SingularValues::of(&real_matrix(effect, actuators));
            let squares = values.iter().map(|value| (value / values[0]).powi(2));
            let turn = Complex64::cis(error_deg.to_radians());
            let steps = squares.take_while(|square| *square > SQUARE_ROUNDING);
            Ok((steps.map(|square| turn * (step * square)).collect(), left))
        })?;
        Ok(Self { points, update_delay })
    }

    /// Attenuation of the slowest part at each point, dB per update, below zero of growth.
    pub fn rates(&self, cancel: &Cancel) -> Result<Vec<f64>> {
        pool::map(cancel, self.points.iter().collect(), |(steps, _)| {
            let mut slowest = f64::INFINITY;
            for &step in steps.iter().step_by(2) {
                cancel.check()?;
                slowest = slowest.min(-20.0 * largest_root(step, self.update_delay)?.log10());
            }
            Ok(slowest)
        })
    }

    /// Writes what is left at the receivers after each update, over what there was, a row for each point; NaN where
    /// there was nothing.
    pub fn write_residuals(
        &self,
        target: &[Complex64],
        out: &mut [f64],
        cancel: &Cancel,
    ) -> Result<()> {
        let points = self.points.len().max(1);
        let (width, updates) = (target.len() / points, out.len() / points);
        let rows = target.chunks(width.max(1)).zip(out.chunks_mut(updates.max(1)));
        let tasks = memory::collected(self.points.iter().zip(rows))?;
        pool::map(cancel, tasks, |((steps, left), (target, row))| {
            let target = real_column(target);
            let whole = target.norm_squared();
            let parts = left.tr_mul(&target).map(|part| part * part);
            let beyond = (whole - parts.rows(0, steps.len()).sum()).max(0.0);
            // What is left of each part now, and after the updates that are not measured yet.
            let late = self.update_delay + 1;
            let mut history = vec![vec![Complex64::ONE; late]; steps.len()];
            for (update, out) in row.iter_mut().enumerate() {
                if update.is_multiple_of(UPDATES_AT_ONCE) {
                    cancel.check()?;
                }
                let mut rest = beyond;
                for ((part, step), history) in parts.iter().zip(steps).zip(&mut history) {
                    let last = history[(update + late - 1) % late];
                    rest += part * last.norm_sqr();
                    history[update % late] = last - step * history[update % late];
                }
                *out = if whole > 0.0 { (rest / whole).sqrt() } else { f64::NAN };
            }
            Ok(())
        })?;
        Ok(())
    }
}

/// Largest magnitude of the roots of z^D(z − 1) + a.
fn largest_root(step: Complex64, delay: usize) -> Result<f64> {
    let mut companion = DMatrix::zeros(delay + 1, delay + 1);
    companion[(0, 0)] = Complex64::ONE;
    companion[(0, delay)] -= step;
    for k in 1..=delay {
        companion[(k, k - 1)] = Complex64::ONE;
    }
    let steps = 100 * (delay + 1);
    let schur = Schur::try_new(companion, f64::EPSILON, steps).ok_or_else(|| {
        Error::value(
            "update_delay",
            delay,
            "has no roots within the steps allowed; give a smaller one",
        )
    })?;
    let (_, triangle) = schur.unpack();
    Ok(triangle.diagonal().iter().map(|root| root.norm()).fold(0.0, f64::max))
}
