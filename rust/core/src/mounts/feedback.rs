//! Velocity of a powertrain fed back through an inertial actuator: the largest stable gain.
//!
//! A motor between the powertrain and a sprung mass pushes with −g·v on the one and +g·v on the other. With the
//! receptance h at its place, κ the spring and damper of the mass m, the velocity of 1 N of the motor is
//! T = iωh/(1 − κ/(mω²) + κh). Where every mode that the motor drives is damped, all is stable without gain, and roots
//! reach the imaginary axis first at the least g = −1/T where T is real and below zero (Nyquist). Where one is not, it
//! starts on that axis and the limit is no such point.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, SymmetricEigen, Vector3};

use super::{ComplexVector6, Powertrain, matrices, motion_of_point};
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::pool;

/// Halvings of a bracket: to the last digit.
const HALVINGS: usize = 60;
/// Frequencies evaluated in one task.
const POINTS_PER_TASK: usize = 128;
/// Loss factor below which it is rounding, and the mode is undamped.
const UNDAMPED: f64 = 1e-12;
/// Motion of the actuator's place in a mode, over that of the free body, below which it is none.
const UNMOVED: f64 = 1e-9;

/// An actuator whose motor pushes against a mass on a spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InertialActuator {
    /// Place, m.
    pub at: [f64; 3],
    /// Direction, of length 1.
    pub direction: [f64; 3],
    /// Mass that it moves, kg.
    pub mass: f64,
    /// Frequency of the mass on its spring, Hz.
    pub resonance: f64,
    /// Damping of the spring over its critical damping.
    pub damping_ratio: f64,
}

/// Force of an actuator's motor over that on the powertrain, where this does not move: its mass on a spring, of a
/// resonance and damping over critical, takes the rest. At a frequency, Hz.
#[must_use]
pub fn motor_share(resonance: f64, damping_ratio: f64, frequency: f64) -> Complex64 {
    let (share, own) = scaled_share(resonance, damping_ratio, frequency);
    share / (own * own)
}

/// That share over the square of the larger of both frequencies, which may lie far apart, and the frequency over it.
fn scaled_share(resonance: f64, damping_ratio: f64, frequency: f64) -> (Complex64, f64) {
    let larger = frequency.max(resonance);
    let [own, sprung] = [frequency / larger, resonance / larger];
    (Complex64::new(own * own - sprung * sprung, -2.0 * damping_ratio * own * sprung), own)
}

impl InertialActuator {
    /// Load about the CG of a force of 1 N.
    fn load(&self, powertrain: &Powertrain) -> nalgebra::Vector6<f64> {
        let arm = Vector3::from(self.at) - powertrain.body().cg();
        motion_of_point(&arm).transpose() * Vector3::from(self.direction)
    }

    /// Velocity of the powertrain at its place, of 1 N of its motor, at frequencies, Hz.
    pub fn mobility(
        &self,
        powertrain: &Powertrain,
        frequency: &[f64],
        cancel: &Cancel,
    ) -> Result<Vec<Complex64>> {
        let unit: ComplexVector6 = self.load(powertrain).map(Complex64::from);
        let of = |&frequency: &f64| {
            let (omega, words) = (TAU * frequency, || "the frequency given".to_owned());
            let stiffnesses = powertrain.stiffnesses(omega, words)?;
            let state = powertrain.state(&stiffnesses, omega, &unit, words)?.ok_or_else(|| {
                let hint = "is that of a mode without damping, and motion is unbounded; give mounts a \
                            loss_factor or damping";
                Error::figure("frequency", frequency, hint)
            })?;
            let (share, own) = scaled_share(self.resonance, self.damping_ratio, frequency);
            let loss = 2.0 * self.damping_ratio * own;
            let receptance: Complex64 = unit.dot(&state.motion);
            let resonance = TAU * self.resonance * own;
            let spring =
                Complex64::new(resonance * resonance, loss * resonance * omega) * self.mass;
            let velocity = receptance * Complex64::new(0.0, omega * own * own);
            Ok(velocity / (share + spring * receptance))
        };
        let tasks = frequency.chunks(POINTS_PER_TASK).collect();
        let found = pool::map(cancel, tasks, |few: &[f64]| {
            cancel.check()?;
            few.iter().map(of).collect::<Result<Vec<_>>>()
        });
        Ok(found?.concat())
    }

    /// The least gain at which roots reach the imaginary axis, N·s/m, and their frequency, Hz; infinite without one.
    ///
    /// Of mobilities on a grid of frequencies, between which they turn once at most.
    pub fn margin(
        &self,
        powertrain: &Powertrain,
        (frequency, mobility): (&[f64], &[Complex64]),
        cancel: &Cancel,
    ) -> Result<(f64, Option<f64>)> {
        let is_below = |of: &Complex64| of.im.is_sign_negative();
        let mut least = (f64::INFINITY, None);
        for (ends, values) in frequency.windows(2).zip(mobility.windows(2)) {
            if is_below(&values[0]) == is_below(&values[1]) {
                continue;
            }
            let [mut low, mut high] = [ends[0], ends[1]];
            for _ in 0..HALVINGS {
                let middle = (low * high).sqrt();
                let [at] = self.mobility(powertrain, &[middle], cancel)?[..] else { break };
                let end = if is_below(&at) == is_below(&values[0]) { &mut low } else { &mut high };
                *end = middle;
            }
            let real = self.mobility(powertrain, &[low], cancel)?[0].re;
            if real < 0.0 && -1.0 / real < least.0 {
                least = (-1.0 / real, Some(low));
            }
        }
        Ok(least)
    }

    /// Frequency of the lowest mode of powertrain and actuator that nothing damps and the motor drives, Hz, with the
    /// stiffness at a frequency.
    pub fn undamped(&self, powertrain: &Powertrain, frequency: f64) -> Result<Option<f64>> {
        let (mass, stiffness) = matrices(powertrain, Some(frequency))?;
        let (count, omega) = (mass.nrows(), TAU * self.resonance);
        let mut place = DVector::zeros(count + 1);
        place.rows_mut(0, 6).copy_from(&self.load(powertrain));
        let mut stretched = place.clone();
        stretched[count] = -1.0;
        let spring = &stretched * stretched.transpose() * (self.mass * omega * omega);
        let mut damping = &spring * (2.0 * self.damping_ratio * frequency / self.resonance);
        let mut elastic = spring;
        let mut masses = DMatrix::identity(count + 1, count + 1) * self.mass;
        masses.view_mut((0, 0), (count, count)).copy_from(&mass);
        for place in (0..count).flat_map(|i| (0..count).map(move |k| (i, k))) {
            elastic[place] += stiffness[place].re;
            damping[place] += stiffness[place].im;
        }
        let error = || Error::value("inertia", "not positive definite", "give a tensor that is");
        let lower = masses.cholesky().ok_or_else(error)?.l();
        let identity = DMatrix::identity(count + 1, count + 1);
        let unit = lower.solve_lower_triangular(&identity).ok_or_else(error)?.transpose();
        let own = SymmetricEigen::new(unit.tr_mul(&(elastic * &unit)));
        let reach = unit.tr_mul(&place).norm();
        let mut squares: Vec<f64> = own.eigenvalues.iter().copied().collect();
        squares.sort_by(f64::total_cmp);
        let largest = squares[count];
        for square in squares.into_iter().filter(|&square| square > UNDAMPED * largest) {
            // Of modes of one frequency any mixture is a mode.
            let alike = |&k: &usize| (own.eigenvalues[k] - square).abs() <= UNMOVED * square;
            let same: Vec<usize> = (0..=count).filter(alike).collect();
            let shapes = &unit * own.eigenvectors.select_columns(&same);
            let losses = SymmetricEigen::new(shapes.tr_mul(&(&damping * &shapes)));
            let moved = (shapes * losses.eigenvectors).tr_mul(&place);
            let parts = moved.iter().zip(&losses.eigenvalues);
            let free = parts.filter(|(_, loss)| **loss <= UNDAMPED * square);
            if free.map(|(moved, _)| moved.abs()).fold(0.0, f64::max) > UNMOVED * reach {
                return Ok(Some(square.sqrt() / TAU));
            }
        }
        Ok(None)
    }
}
