//! Natural modes: frequencies, shapes, and shares of energy.
//!
//! `K = AᵀA`, with a row of A for each axis of each mount: the singular values of `A·L⁻ᵀ`, with `L·Lᵀ` the mass
//! matrix, are the angular frequencies. Eigenvalues of K would lose half of the digits of low ones.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, SMatrix, SVector, Schur, Vector3};

use super::bodies::Bodies;
use super::{Powertrain, real};
use crate::Complex64;
use crate::numbers::error::{Error, Result};
use crate::numbers::singular_values::{right_vectors, scale_of};

/// Relative difference of two frequencies within which rounding of the figures decides which shapes of
/// their common plane are modes.
pub const EQUAL_FREQUENCIES: f64 = 1e-9;
/// Singular value over the largest, for each row and column, that rounding makes of zero.
const RANK_ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Rows reduced at once: those of the triangle, and of some mounts.
const ROWS_REDUCED: usize = 18;
/// Steps of the complex eigenvalues' iteration; a dozen suffice.
const MOST_STEPS: usize = 500;

/// Modes of bodies on mounts without damping.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NaturalModes<const N: usize = 6> {
    /// rad/s, ascending; exactly 0 for motions that no mount resists.
    pub omega: [f64; N],
    /// Columns φ with φᵀMφ = 1.
    pub shapes: SMatrix<f64, N, N>,
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
    /// True if the powertrain rests, and the subframe that carries it moves.
    pub of_subframe: bool,
}

/// Modes, and where their energy is: six, or with a subframe twelve.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// Hz, ascending; exactly 0 for motions that no mount resists.
    pub frequency: Vec<f64>,
    /// Columns (displacement of the CG, rotation), of a subframe's below those, φᵀMφ = 1.
    pub shapes: DMatrix<f64>,
    /// Share of each coordinate in the kinetic energy of each mode, %: 100·φₖ(Mφ)ₖ. Columns sum to 100,
    /// and entries can be below zero where the tensor has products. Of modes of one frequency the mean.
    pub energy: DMatrix<f64>,
    /// Share of each mount in the elastic energy of each mode, %, a row each; of a subframe's after the others.
    pub strain: Vec<Vec<f64>>,
    /// Largest share of a coordinate, of modes of one frequency the mean of as many largest ones, %.
    pub purity: Vec<f64>,
    /// Imaginary over real part of the complex eigenvalue.
    pub loss_factor: Vec<f64>,
    /// Root of the real part of the complex eigenvalue, Hz.
    pub damped_frequency: Vec<f64>,
    /// Index of the first mode of the same frequency.
    pub group: Vec<usize>,
    /// Motions that no mount resists.
    pub free: Vec<FreeMotion>,
}

/// Natural modes with these stiffnesses along the mounts' axes, none below zero.
pub(crate) fn natural<const N: usize>(
    bodies: &Bodies<N>,
    stiffnesses: &[[f64; 3]],
) -> NaturalModes<N> {
    let unit = &bodies.unit;
    let turned = |mount: usize| {
        let mut rows = bodies.deflections[mount] * unit;
        for (mut row, stiffness) in rows.row_iter_mut().zip(stiffnesses[mount]) {
            row *= stiffness.sqrt();
        }
        rows
    };
    let size = (3 * stiffnesses.len() * N) as f64;
    let (values, vectors) = right_vectors(&triangle(stiffnesses.len(), turned));
    let rank = values.iter().take_while(|&&v| v > RANK_ROUNDING * size * values[0]).count();
    let free = N - rank;
    let mut omega = [0.0; N];
    let mut turns = SMatrix::<f64, N, N>::zeros();
    for k in 0..rank {
        omega[N - 1 - k] = values[k];
        turns.set_column(N - 1 - k, &vectors.column(k));
    }
    if free > 0 {
        let known: Vec<SVector<f64, N>> = (0..rank).map(|k| vectors.column(k).into()).collect();
        for (column, direction) in complement(&known).into_iter().enumerate() {
            turns.set_column(column, &direction);
        }
    }
    let mut shapes = unit * turns;
    for mut shape in shapes.column_iter_mut() {
        // The coordinate with the largest part in the energy is above zero.
        let weights = bodies.mass.diagonal().map(f64::sqrt);
        if shape[shape.component_mul(&weights).iamax()] < 0.0 {
            shape.neg_mut();
        }
    }
    NaturalModes { omega, shapes, free }
}

/// Triangular factor of the rows of all mounts, by reflections.
fn triangle<const N: usize>(
    mounts: usize,
    rows: impl Fn(usize) -> SMatrix<f64, 3, N>,
) -> SMatrix<f64, N, N> {
    let scale = scale_of((0..mounts).map(|mount| rows(mount).amax()).fold(0.0, f64::max));
    let mut stacked = SMatrix::<f64, ROWS_REDUCED, N>::zeros();
    for first in (0..mounts).step_by((ROWS_REDUCED - N) / 3) {
        for (k, mount) in (first..mounts).take((ROWS_REDUCED - N) / 3).enumerate() {
            stacked.fixed_view_mut::<3, N>(N + 3 * k, 0).copy_from(&(rows(mount) / scale));
        }
        reflect(&mut stacked.data.0);
    }
    SMatrix::from_fn(|row, column| if row <= column { stacked[(row, column)] * scale } else { 0.0 })
}

/// Makes columns those of a triangle, by a reflection for each: what is below the diagonal becomes zero.
fn reflect<const N: usize>(columns: &mut [[f64; ROWS_REDUCED]; N]) {
    for k in 0..N {
        let (own, others) = columns[k..].split_first_mut().expect("one column at least");
        let norm = own[k..].iter().map(|x| x * x).sum::<f64>().sqrt();
        if norm == 0.0 {
            continue;
        }
        let to = -norm.copysign(own[k]);
        let factor = 1.0 / (norm * (norm + own[k].abs()));
        own[k] -= to;
        for other in others {
            let product: f64 = own[k..].iter().zip(&other[k..]).map(|(a, b)| a * b).sum();
            for (b, a) in other[k..].iter_mut().zip(&own[k..]) {
                *b -= product * factor * a;
            }
        }
        own[k..].fill(0.0);
        own[k] = to;
    }
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
    Ok(Some(natural(&powertrain.alone()?, &real(&stiffnesses))))
}

/// Directions at right angles to some orthonormal ones, and to each other.
fn complement<const N: usize>(known: &[SVector<f64, N>]) -> Vec<SVector<f64, N>> {
    let mut all = known.to_vec();
    while all.len() < N {
        let rest = |k: usize| {
            let mut axis = SVector::<f64, N>::zeros();
            axis[k] = 1.0;
            // Twice: the second time removes what rounding of the first left.
            for direction in all.iter().chain(&all) {
                axis -= direction * direction.dot(&axis);
            }
            axis
        };
        let longest = (0..N).map(rest).max_by(|a, b| a.norm().total_cmp(&b.norm()));
        all.extend(longest.map(|axis| axis.normalize()));
    }
    all.split_off(known.len())
}

impl<const N: usize> NaturalModes<N> {
    /// Hz, ascending.
    pub fn frequency(&self) -> [f64; N] {
        self.omega.map(|omega| omega / TAU)
    }

    /// Complex stiffness in coordinates of these modes, which diagonalise its real part, of deflections of the
    /// mounts.
    pub fn diagonalised(
        &self,
        deflections: &[SMatrix<f64, 3, N>],
        stiffnesses: &[[Complex64; 3]],
    ) -> SMatrix<Complex64, N, N> {
        let mut damping = SMatrix::<f64, N, N>::zeros();
        for (deflection, along) in deflections.iter().zip(stiffnesses) {
            let turned = deflection * self.shapes;
            for (row, stiffness) in turned.row_iter().zip(along) {
                damping.syger(stiffness.im, &row.transpose(), &row.transpose(), 1.0);
            }
        }
        damping.fill_upper_triangle_with_lower_triangle();
        let mut matrix = damping.map(|im| Complex64::new(0.0, im));
        for mode in 0..N {
            matrix[(mode, mode)].re = self.omega[mode].powi(2);
        }
        matrix
    }

    /// Index of the first mode of the same frequency, within rounding.
    pub fn groups(&self) -> [usize; N] {
        let mut group = [0; N];
        for mode in 1..N {
            let [below, here] = [self.omega[mode - 1], self.omega[mode]];
            let is_equal = here - below <= EQUAL_FREQUENCIES * here;
            group[mode] = if is_equal { group[mode - 1] } else { mode };
        }
        group
    }

    /// Motions that no mount resists, in words of geometry: of the powertrain, or where it rests of a subframe.
    pub fn free_motions(&self, bodies: &Bodies<N>) -> Vec<FreeMotion> {
        let motion = |column: usize| {
            let shape = self.shapes.column(column);
            // Of unit energy: what moves has more than rounding.
            let energy = |from: usize, count: usize| {
                let part = shape.rows(from, count);
                part.dot(&(bodies.mass.view((from, from), (count, count)) * part))
            };
            let of_subframe = energy(0, 6) < 1e-12;
            let (from, cg) =
                if of_subframe { (6, bodies.centre_below()) } else { (0, bodies.centre()) };
            let part = |first: usize| Vector3::from_fn(|k, _| shape[from + first + k]);
            let (shift, turn) = (part(0), part(3));
            if energy(from + 3, 3) < 1e-12 {
                return FreeMotion { direction: shift.normalize().into(), foot: None, of_subframe };
            }
            let foot = cg + turn.cross(&shift) / turn.norm_squared();
            let (direction, foot) = (turn.normalize().into(), Some(foot.into()));
            FreeMotion { direction, foot, of_subframe }
        };
        (0..self.free).map(motion).collect()
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
        let of = if self.of_subframe { " of the subframe" } else { "" };
        self.foot.map_or_else(
            || format!("translation{of} along {direction}"),
            |foot| {
                format!("rotation{of} about the line through {} m along {direction}", listed(foot))
            },
        )
    }
}

/// Modes with the real stiffness and the damping at a frequency, Hz. Without one the stiffness must not
/// depend on it, and the damping of each mode is that at its own.
pub fn modes(powertrain: &Powertrain, frequency: Option<f64>) -> Result<Modes> {
    match powertrain.subframe()? {
        None => modes_of(&powertrain.alone()?, frequency),
        Some(_) => modes_of(&powertrain.with_subframe()?, frequency),
    }
}

/// Motions that no mount resists, with the stiffness at a frequency, Hz; as of [`modes`].
pub fn free_motions(powertrain: &Powertrain, frequency: Option<f64>) -> Result<Vec<FreeMotion>> {
    fn of<const N: usize>(bodies: &Bodies<N>, frequency: Option<f64>) -> Result<Vec<FreeMotion>> {
        let (_, stiffnesses) = dynamic(bodies.powertrain, frequency)?;
        Ok(natural(bodies, &real(&stiffnesses)).free_motions(bodies))
    }
    match powertrain.subframe()? {
        None => of(&powertrain.alone()?, frequency),
        Some(_) => of(&powertrain.with_subframe()?, frequency),
    }
}

/// Frequencies, Hz, and purities, %, of the [`modes`].
pub(crate) fn frequency_and_purity(
    powertrain: &Powertrain,
    frequency: Option<f64>,
) -> Result<[Vec<f64>; 2]> {
    fn of<const N: usize>(bodies: &Bodies<N>, frequency: Option<f64>) -> Result<[Vec<f64>; 2]> {
        let (_, stiffnesses) = dynamic(bodies.powertrain, frequency)?;
        let natural = natural(bodies, &real(&stiffnesses));
        Ok([natural.frequency().to_vec(), purities(bodies, &natural).to_vec()])
    }
    match powertrain.subframe()? {
        None => of(&powertrain.alone()?, frequency),
        Some(_) => of(&powertrain.with_subframe()?, frequency),
    }
}

fn modes_of<const N: usize>(bodies: &Bodies<N>, frequency: Option<f64>) -> Result<Modes> {
    let (omega, stiffnesses) = dynamic(bodies.powertrain, frequency)?;
    let along = real(&stiffnesses);
    let natural = natural(bodies, &along);
    let group = natural.groups();
    let mut energy = natural.shapes.component_mul(&(bodies.mass * natural.shapes)) * 100.0;
    let purity = averaged(&mut energy, &group);
    let mut strain = vec![vec![0.0; N]; bodies.powertrain.all_mounts().count()];
    let springs = bodies.powertrain.all_springs().zip(bodies.deflections).zip(&along);
    for ((spring, deflection), along) in springs {
        let squares = (deflection * natural.shapes).map(|part| part * part);
        for (mode, sum) in strain[spring.owner].iter_mut().enumerate() {
            *sum += (0..3).map(|k| along[k] * squares[(k, mode)]).sum::<f64>();
        }
    }
    for mode in 0..N {
        let sum: f64 = strain.iter().map(|row| row[mode]).sum();
        // No mount is deflected in a free motion.
        let factor = if mode < natural.free || sum == 0.0 { 0.0 } else { 100.0 / sum };
        for row in &mut strain {
            row[mode] *= factor;
        }
    }
    for first in (0..N).filter(|&mode| group[mode] == mode) {
        let members: Vec<usize> = (0..N).filter(|&mode| group[mode] == first).collect();
        let count = members.len() as f64;
        for row in &mut strain {
            let mean = members.iter().map(|&mode| row[mode]).sum::<f64>() / count;
            for &mode in &members {
                row[mode] = mean;
            }
        }
    }
    let (loss_factor, damped_frequency) = damped(bodies, &natural, omega, &stiffnesses)?;
    let square = |of: &SMatrix<f64, N, N>| DMatrix::from_fn(N, N, |row, column| of[(row, column)]);
    Ok(Modes {
        frequency: natural.frequency().to_vec(),
        free: natural.free_motions(bodies),
        shapes: square(&natural.shapes),
        energy: square(&energy),
        strain,
        purity: purity.to_vec(),
        loss_factor,
        damped_frequency,
        group: group.to_vec(),
    })
}

/// Replaces energies of modes of one frequency by their mean; the purity of each mode.
fn averaged<const N: usize>(energy: &mut SMatrix<f64, N, N>, group: &[usize; N]) -> [f64; N] {
    let mut purity = [0.0; N];
    for first in (0..N).filter(|&mode| group[mode] == mode) {
        let last = (first..N).take_while(|&mode| group[mode] == first).count() + first;
        let count = last - first;
        let sum =
            (first..last).fold(SVector::<f64, N>::zeros(), |sum, mode| sum + energy.column(mode));
        let mean = sum / count as f64;
        let mut shares: [f64; N] = mean.into();
        shares.sort_by(|a, b| b.total_cmp(a));
        for (mode, purity) in purity.iter_mut().enumerate().take(last).skip(first) {
            energy.set_column(mode, &mean);
            *purity = shares[..count].iter().sum();
        }
    }
    purity
}

/// Largest share of a coordinate in the kinetic energy of each mode, %.
pub(crate) fn purities<const N: usize>(bodies: &Bodies<N>, natural: &NaturalModes<N>) -> [f64; N] {
    let moved = bodies.mass * natural.shapes;
    averaged(&mut (natural.shapes.component_mul(&moved) * 100.0), &natural.groups())
}

/// Complex stiffnesses at a frequency, Hz, and its angular speed, none below zero in its real part.
pub(crate) fn dynamic(
    powertrain: &Powertrain,
    frequency: Option<f64>,
) -> Result<(Option<f64>, Vec<[Complex64; 3]>)> {
    let varying = powertrain.all_mounts().find(|mount| mount.dynamic().varies());
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
    let stiffnesses = stiffnesses(powertrain, omega.unwrap_or(0.0), "the frequency given")?;
    for (spring, along) in powertrain.all_springs().zip(&stiffnesses) {
        if let Some(negative) = along.iter().find(|k| k.re < 0.0) {
            let argument = format!("stiffness of mount {:?}", spring.mount.name());
            let hint = "is below zero at this frequency: modes are those of another one";
            return Err(Error::figure(argument, negative.re, hint));
        }
    }
    Ok((omega, stiffnesses))
}

/// Complex stiffnesses of all springs at an angular speed; of a subframe's after the others.
fn stiffnesses(powertrain: &Powertrain, omega: f64, point: &str) -> Result<Vec<[Complex64; 3]>> {
    powertrain.all_springs().map(|spring| spring.stiffness_at(omega, || point.into())).collect()
}

/// Loss factor and frequency, Hz, of the complex eigenvalues of each mode.
fn damped<const N: usize>(
    bodies: &Bodies<N>,
    natural: &NaturalModes<N>,
    omega: Option<f64>,
    given: &[[Complex64; 3]],
) -> Result<(Vec<f64>, Vec<f64>)> {
    let powertrain = bodies.powertrain;
    let at_own = omega.is_none() && powertrain.all_springs().any(|s| s.dynamic().damping_varies());
    let any = natural.omega[N - 1];
    let mut pencil = Vec::new();
    let (mut loss, mut frequency) = (vec![0.0; N], vec![0.0; N]);
    for mode in natural.free..N {
        if at_own || pencil.is_empty() {
            // Damping at a frequency above zero, where hysteretic damping counts.
            let own = if at_own { natural.omega[mode] } else { omega.unwrap_or(any) };
            let own = if omega.is_some() {
                given.to_vec()
            } else {
                stiffnesses(powertrain, own, "a mode")?
            };
            pencil = eigenvalues(bodies, natural, &own)?;
        }
        let value = pencil[mode];
        loss[mode] = if value.im == 0.0 { 0.0 } else { value.im / value.re };
        frequency[mode] = value.re.max(0.0).sqrt() / TAU;
    }
    Ok((loss, frequency))
}

/// Eigenvalues of `ΦᵀKΦ`, with Φ of unit mass, ascending by their real parts.
fn eigenvalues<const N: usize>(
    bodies: &Bodies<N>,
    natural: &NaturalModes<N>,
    stiffnesses: &[[Complex64; 3]],
) -> Result<Vec<Complex64>> {
    let scale = natural.omega[N - 1].powi(2);
    let matrix = natural.diagonalised(bodies.deflections, stiffnesses) / Complex64::from(scale);
    let matrix = DMatrix::from_fn(N, N, |row, column| matrix[(row, column)]);
    let schur = Schur::try_new(matrix, f64::EPSILON, MOST_STEPS).ok_or_else(|| {
        let hint = "has no eigenvalues within the steps allowed; please report the figures";
        Error::value("loss_factor", "given", hint)
    })?;
    let (_, triangle) = schur.unpack();
    let mut values: Vec<Complex64> =
        triangle.diagonal().iter().map(|value| value * scale).collect();
    values.sort_by(|a, b| a.re.total_cmp(&b.re));
    Ok(values)
}
