//! Natural modes: frequencies, shapes, and where their energy is.
//!
//! `K = AᵀA`, with a row of A for each axis of each mount: the singular values of `A·L⁻ᵀ`, with `L·Lᵀ` the mass
//! matrix, are the angular frequencies. Eigenvalues of K would lose half of the digits of low ones.

use std::f64::consts::TAU;

use nalgebra::{Matrix3x6, Matrix6, SMatrix, Schur, Vector3, Vector6};

use super::{ComplexMatrix6, Powertrain, real};
use crate::Complex64;
use crate::numbers::error::{Error, Result};
use crate::numbers::singular_values::{right_vectors, scale_of};

/// Relative difference of two frequencies within which rounding of the figures decides which shapes of
/// their common plane are modes.
const EQUAL_FREQUENCIES: f64 = 1e-9;
/// Singular value over the largest, for each row and column, that rounding makes of zero.
const RANK_ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Mounts whose rows are reduced at once.
const AT_ONCE: usize = 4;
/// Steps of the complex eigenvalues' iteration; a dozen suffice.
const MOST_STEPS: usize = 500;

/// Modes of a body on mounts without damping.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NaturalModes {
    /// rad/s, ascending; exactly 0 for motions that no mount resists.
    pub omega: [f64; 6],
    /// Columns φ with φᵀMφ = 1.
    pub shapes: Matrix6<f64>,
    /// Number of motions that no mount resists.
    pub free: usize,
}

/// A motion that no mount resists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeMotion {
    /// Direction of the axis of rotation, or of the translation.
    pub direction: [f64; 3],
    /// Point of the axis next to the CG, m; none of a translation.
    pub foot: Option<[f64; 3]>,
}

/// Modes, and where their energy is.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// Hz, ascending; exactly 0 for motions that no mount resists.
    pub frequency: [f64; 6],
    /// Columns (displacement of the CG, rotation), φᵀMφ = 1.
    pub shapes: Matrix6<f64>,
    /// Share of each coordinate in the kinetic energy of each mode, %: 100·φₖ(Mφ)ₖ. Columns sum to 100,
    /// and entries can be below zero where the tensor has products. Of modes of one frequency the mean.
    pub energy: Matrix6<f64>,
    /// Share of each mount in the elastic energy of each mode, %, a row each.
    pub strain: Vec<[f64; 6]>,
    /// Largest share of a coordinate, of modes of one frequency the mean of as many largest ones, %.
    pub purity: [f64; 6],
    /// Imaginary over real part of the complex eigenvalue.
    pub loss_factor: [f64; 6],
    /// Root of the real part of the complex eigenvalue, Hz.
    pub damped_frequency: [f64; 6],
    /// Index of the first mode of the same frequency.
    pub group: [usize; 6],
    /// Motions that no mount resists.
    pub free: Vec<FreeMotion>,
}

/// Natural modes with these stiffnesses along the mounts' axes, none below zero.
pub(crate) fn natural(powertrain: &Powertrain, stiffnesses: &[[f64; 3]]) -> Result<NaturalModes> {
    let unit = powertrain.unit_mass()?;
    let turned = |mount: usize| {
        let mut rows = powertrain.deflections()[mount] * unit;
        for (mut row, stiffness) in rows.row_iter_mut().zip(stiffnesses[mount]) {
            row *= stiffness.sqrt();
        }
        rows
    };
    let size = (3 * stiffnesses.len() * 6) as f64;
    let (values, vectors) = right_vectors(&triangle(stiffnesses.len(), turned));
    let rank = values.iter().take_while(|&&v| v > RANK_ROUNDING * size * values[0]).count();
    let free = 6 - rank;
    let mut omega = [0.0; 6];
    let mut turns = Matrix6::zeros();
    for k in 0..rank {
        omega[5 - k] = values[k];
        turns.set_column(5 - k, &vectors.column(k));
    }
    if free > 0 {
        let known: Vec<Vector6<f64>> = (0..rank).map(|k| vectors.column(k).into()).collect();
        for (column, direction) in complement(&known).into_iter().enumerate() {
            turns.set_column(column, &direction);
        }
    }
    let mut shapes = unit * turns;
    for mut shape in shapes.column_iter_mut() {
        // The coordinate with the largest part in the energy is above zero.
        let weights = powertrain.body().mass_matrix().diagonal().map(f64::sqrt);
        if shape[shape.component_mul(&weights).iamax()] < 0.0 {
            shape.neg_mut();
        }
    }
    Ok(NaturalModes { omega, shapes, free })
}

/// Triangular factor of the rows of all mounts, by reflections.
fn triangle(mounts: usize, rows: impl Fn(usize) -> Matrix3x6<f64>) -> Matrix6<f64> {
    let scale = scale_of((0..mounts).map(|mount| rows(mount).amax()).fold(0.0, f64::max));
    let mut triangle = Matrix6::zeros();
    for first in (0..mounts).step_by(AT_ONCE) {
        let mut stacked = SMatrix::<f64, { 6 + 3 * AT_ONCE }, 6>::zeros();
        stacked.fixed_view_mut::<6, 6>(0, 0).copy_from(&triangle);
        for (k, mount) in (first..mounts.min(first + AT_ONCE)).enumerate() {
            stacked.fixed_view_mut::<3, 6>(6 + 3 * k, 0).copy_from(&(rows(mount) / scale));
        }
        triangle = stacked.qr().r();
    }
    triangle * scale
}

/// Natural modes with the stiffness at a frequency, Hz; none where it depends on that and none is given.
pub(crate) fn natural_at(
    powertrain: &Powertrain,
    frequency: Option<f64>,
) -> Result<Option<NaturalModes>> {
    if frequency.is_none() && powertrain.mounts().iter().any(|mount| mount.dynamic().varies()) {
        return Ok(None);
    }
    let (_, stiffnesses) = dynamic(powertrain, frequency)?;
    natural(powertrain, &real(&stiffnesses)).map(Some)
}

/// Directions at right angles to some orthonormal ones, and to each other.
fn complement(known: &[Vector6<f64>]) -> Vec<Vector6<f64>> {
    let mut all = known.to_vec();
    while all.len() < 6 {
        let rest = |k: usize| {
            let mut axis = Vector6::zeros();
            axis[k] = 1.0;
            // Twice: the second time removes what rounding of the first left.
            for direction in all.iter().chain(&all) {
                axis -= direction * direction.dot(&axis);
            }
            axis
        };
        let longest = (0..6).map(rest).max_by(|a, b| a.norm().total_cmp(&b.norm()));
        all.extend(longest.map(|axis| axis.normalize()));
    }
    all.split_off(known.len())
}

impl NaturalModes {
    /// Hz, ascending.
    pub fn frequency(&self) -> [f64; 6] {
        self.omega.map(|omega| omega / TAU)
    }

    /// Complex stiffness in coordinates of these modes, which diagonalise its real part.
    pub fn diagonalised(
        &self,
        powertrain: &Powertrain,
        stiffnesses: &[[Complex64; 3]],
    ) -> ComplexMatrix6 {
        let mut damping = Matrix6::zeros();
        for (deflection, along) in powertrain.deflections().iter().zip(stiffnesses) {
            let turned = deflection * self.shapes;
            for (row, stiffness) in turned.row_iter().zip(along) {
                damping.syger(stiffness.im, &row.transpose(), &row.transpose(), 1.0);
            }
        }
        damping.fill_upper_triangle_with_lower_triangle();
        let mut matrix = damping.map(|im| Complex64::new(0.0, im));
        for mode in 0..6 {
            matrix[(mode, mode)].re = self.omega[mode].powi(2);
        }
        matrix
    }

    /// Index of the first mode of the same frequency, within rounding.
    pub fn groups(&self) -> [usize; 6] {
        let mut group = [0; 6];
        for mode in 1..6 {
            let [below, here] = [self.omega[mode - 1], self.omega[mode]];
            let is_equal = here - below <= EQUAL_FREQUENCIES * here;
            group[mode] = if is_equal { group[mode - 1] } else { mode };
        }
        group
    }

    /// Motions that no mount resists, in words of geometry.
    pub fn free_motions(&self, powertrain: &Powertrain) -> Vec<FreeMotion> {
        let inertia = powertrain.body().inertia();
        let motion = |column: usize| {
            let shape = self.shapes.column(column);
            let (shift, turn): (Vector3<f64>, Vector3<f64>) =
                (shape.fixed_rows::<3>(0).into(), shape.fixed_rows::<3>(3).into());
            // Of unit energy: a rotation has more than rounding.
            if turn.dot(&(inertia * turn)) < 1e-12 {
                return FreeMotion { direction: shift.normalize().into(), foot: None };
            }
            let foot = powertrain.body().cg() + turn.cross(&shift) / turn.norm_squared();
            FreeMotion { direction: turn.normalize().into(), foot: Some(foot.into()) }
        };
        (0..self.free).map(motion).collect()
    }

    /// An error where some motion is free.
    pub fn require_support(&self, powertrain: &Powertrain) -> Result<()> {
        let motions = self.free_motions(powertrain);
        let Some(first) = motions.first() else { return Ok(()) };
        let names: Vec<&str> = powertrain.mounts().iter().map(super::Mount::name).collect();
        let hint =
            format!("{} is free: add a mount that resists it, or stiffness", first.in_words());
        Err(Error::value("mounts", names.join(", "), hint))
    }
}

impl FreeMotion {
    /// What is free: a rotation about a line, or a translation.
    #[must_use]
    pub fn in_words(&self) -> String {
        let listed = |values: [f64; 3]| {
            // Digits that rounding makes are no more than a thousandth of a millimetre.
            let rounded = values.map(|value| format!("{}", (value * 1e6).round() / 1e6 + 0.0));
            format!("({})", rounded.join(", "))
        };
        let direction = listed(self.direction);
        self.foot.map_or_else(
            || format!("translation along {direction}"),
            |foot| format!("rotation about the line through {} m along {direction}", listed(foot)),
        )
    }
}

/// Modes with the real stiffness and the damping at a frequency, Hz. Without one the stiffness must not
/// depend on it, and the damping of each mode is that at its own.
pub fn modes(powertrain: &Powertrain, frequency: Option<f64>) -> Result<Modes> {
    let (omega, stiffnesses) = dynamic(powertrain, frequency)?;
    let along = real(&stiffnesses);
    let natural = natural(powertrain, &along)?;
    let mass = powertrain.body().mass_matrix();
    let group = natural.groups();
    let mut energy = natural.shapes.component_mul(&(mass * natural.shapes)) * 100.0;
    let purity = averaged(&mut energy, &group);
    let mut strain: Vec<[f64; 6]> = powertrain
        .deflections()
        .iter()
        .zip(&along)
        .map(|(deflection, along)| {
            let squares = (deflection * natural.shapes).map(|part| part * part);
            [0, 1, 2, 3, 4, 5].map(|mode| (0..3).map(|k| along[k] * squares[(k, mode)]).sum())
        })
        .collect();
    for mode in 0..6 {
        let sum: f64 = strain.iter().map(|row| row[mode]).sum();
        // No mount is deflected in a free motion.
        let factor = if mode < natural.free || sum == 0.0 { 0.0 } else { 100.0 / sum };
        for row in &mut strain {
            row[mode] *= factor;
        }
    }
    for first in (0..6).filter(|&mode| group[mode] == mode) {
        let members: Vec<usize> = (0..6).filter(|&mode| group[mode] == first).collect();
        let count = members.len() as f64;
        for row in &mut strain {
            let mean = members.iter().map(|&mode| row[mode]).sum::<f64>() / count;
            for &mode in &members {
                row[mode] = mean;
            }
        }
    }
    let (loss_factor, damped_frequency) = damped(powertrain, &natural, omega, &stiffnesses)?;
    Ok(Modes {
        frequency: natural.frequency(),
        free: natural.free_motions(powertrain),
        shapes: natural.shapes,
        energy,
        strain,
        purity,
        loss_factor,
        damped_frequency,
        group,
    })
}

/// Replaces energies of modes of one frequency by their mean; the purity of each mode.
fn averaged(energy: &mut Matrix6<f64>, group: &[usize; 6]) -> [f64; 6] {
    let mut purity = [0.0; 6];
    for first in (0..6).filter(|&mode| group[mode] == mode) {
        let last = (first..6).take_while(|&mode| group[mode] == first).count() + first;
        let count = last - first;
        let sum = (first..last).fold(Vector6::zeros(), |sum, mode| sum + energy.column(mode));
        let mean = sum / count as f64;
        let mut shares: [f64; 6] = mean.into();
        shares.sort_by(|a, b| b.total_cmp(a));
        for (mode, purity) in purity.iter_mut().enumerate().take(last).skip(first) {
            energy.set_column(mode, &mean);
            *purity = shares[..count].iter().sum();
        }
    }
    purity
}

/// Largest share of a coordinate in the kinetic energy of each mode, %.
pub(crate) fn purities(powertrain: &Powertrain, natural: &NaturalModes) -> [f64; 6] {
    let moved = powertrain.body().mass_matrix() * natural.shapes;
    averaged(&mut (natural.shapes.component_mul(&moved) * 100.0), &natural.groups())
}

/// Complex stiffnesses at a frequency, Hz, and its angular speed, none below zero in its real part.
pub(crate) fn dynamic(
    powertrain: &Powertrain,
    frequency: Option<f64>,
) -> Result<(Option<f64>, Vec<[Complex64; 3]>)> {
    let varying = powertrain.mounts().iter().find(|mount| mount.dynamic().varies());
    if let (None, Some(mount)) = (frequency, varying) {
        let hint = format!(
            "the stiffness of mount {:?} depends on frequency: give the one at which it is taken, Hz",
            mount.name()
        );
        return Err(Error::value("frequency", "None", hint));
    }
    if let Some(frequency) = frequency {
        crate::numbers::limits::distance("frequency", frequency)?;
    }
    let omega = frequency.map(|frequency| frequency * TAU);
    let stiffnesses =
        powertrain.stiffnesses(omega.unwrap_or(0.0), || "the frequency given".into())?;
    for (mount, along) in powertrain.mounts().iter().zip(&stiffnesses) {
        if let Some(negative) = along.iter().find(|k| k.re < 0.0) {
            let argument = format!("stiffness of mount {:?}", mount.name());
            let hint = "is below zero at this frequency: modes are those of another one";
            return Err(Error::figure(argument, negative.re, hint));
        }
    }
    Ok((omega, stiffnesses))
}

/// Loss factor and frequency, Hz, of the complex eigenvalues of each mode.
fn damped(
    powertrain: &Powertrain,
    natural: &NaturalModes,
    omega: Option<f64>,
    stiffnesses: &[[Complex64; 3]],
) -> Result<([f64; 6], [f64; 6])> {
    let at_own =
        omega.is_none() && powertrain.mounts().iter().any(|m| m.dynamic().damping_varies());
    let any = natural.omega[5];
    let mut pencil = Vec::new();
    let (mut loss, mut frequency) = ([0.0; 6], [0.0; 6]);
    for mode in natural.free..6 {
        if at_own || pencil.is_empty() {
            // Damping at a frequency above zero, where hysteretic damping counts.
            let own = if at_own { natural.omega[mode] } else { omega.unwrap_or(any) };
            let own = if omega.is_some() {
                stiffnesses.to_vec()
            } else {
                powertrain.stiffnesses(own, || "a mode".into())?
            };
            pencil = eigenvalues(powertrain, natural, &own)?;
        }
        let value = pencil[mode];
        loss[mode] = if value.im == 0.0 { 0.0 } else { value.im / value.re };
        frequency[mode] = value.re.max(0.0).sqrt() / TAU;
    }
    Ok((loss, frequency))
}

/// Eigenvalues of `ΦᵀKΦ`, with Φ of unit mass, ascending by their real parts.
fn eigenvalues(
    powertrain: &Powertrain,
    natural: &NaturalModes,
    stiffnesses: &[[Complex64; 3]],
) -> Result<Vec<Complex64>> {
    let matrix = natural.diagonalised(powertrain, stiffnesses);
    let scale = natural.omega[5].powi(2);
    let schur: Schur<Complex64, _> =
        Schur::try_new(matrix / Complex64::from(scale), f64::EPSILON, MOST_STEPS).ok_or_else(
            || {
                let hint = "has no eigenvalues within the steps allowed; please report the figures";
                Error::value("loss_factor", "given", hint)
            },
        )?;
    let (_, triangle): (_, SMatrix<Complex64, 6, 6>) = schur.unpack();
    let mut values: Vec<Complex64> =
        triangle.diagonal().iter().map(|value| value * scale).collect();
    values.sort_by(|a, b| a.re.total_cmp(&b.re));
    Ok(values)
}
