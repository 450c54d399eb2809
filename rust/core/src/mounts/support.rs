//! Elastic supports of the mounts: a second rigid body on mounts of its own, or a measured
//! receptance.
//!
//! With w the displacement of what carries the mounts, their force on it is F = Z(Bq − w). A body on mounts
//! is solved with the first one, so that its own resonances are no poles; of a receptance, w = HF, the
//! stiffness of the motion is K − Wᵀ H (1 + Z H)⁻¹ W, with W = ZB at the measured coordinates.

use nalgebra::{DMatrix, DVector, Matrix3x6, SMatrix, Vector3};

use super::{
    ComplexVector6, LEAST_PIVOT, Powertrain, assembled, complex, motion_of_point, rotation_of,
};
use crate::Complex64;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// Imaginary over absolute part of a receptance where force acts, which is below zero but for noise.
const PHASE_BY_NOISE: f64 = 0.05;
/// Names of the directions of a coordinate.
pub const DIRECTIONS: [&str; 3] = ["x", "y", "z"];

/// What carries the mounts.
#[derive(Debug, Clone, PartialEq)]
pub enum Support {
    /// A rigid body on mounts of its own.
    Subframe(Box<Powertrain>),
    /// Measured.
    Receptance(Receptance),
}

/// Place and direction at a mount: its name, and 0, 1, 2 for x, y, z.
pub type Coordinate = (String, usize);

/// Displacement over force, complex, over frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Receptance {
    /// Where forces and displacements are.
    pub coordinates: Vec<Coordinate>,
    /// Hz, ascending.
    pub frequency: Vec<f64>,
    /// At each frequency a symmetric matrix, row by row, m/N.
    pub values: Vec<Vec<Complex64>>,
    /// Points that move with it.
    pub receivers: Vec<Receiver>,
}

/// A point of what carries the mounts, such as a seat rail.
#[derive(Debug, Clone, PartialEq)]
pub struct Receiver {
    /// Name.
    pub name: String,
    /// At each frequency the displacement along x, y and z over the force at each coordinate, m/N.
    pub transfer: Vec<Vec<[Complex64; 3]>>,
}

/// A powertrain in motion.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Displacement of the CG, and rotation.
    pub motion: ComplexVector6,
    /// Displacement of what carries each mount; empty where it does not move.
    pub carrier: Vec<Vector3<Complex64>>,
    /// Motion of the CG of a subframe, zero without one.
    pub subframe: ComplexVector6,
}

impl Receptance {
    /// Rejects what no structure has; entries across the diagonal that differ become their mean.
    pub fn checked(mut self) -> Result<Self> {
        let count = self.coordinates.len();
        if count == 0 {
            let hint = "give one or more pairs of the name of a mount and \"x\", \"y\" or \"z\"";
            return Err(Error::value("coordinates", "[]", hint));
        }
        for (k, coordinate) in self.coordinates.iter().enumerate() {
            if coordinate.1 > 2 {
                let hint = "give 0, 1 or 2 for x, y or z";
                return Err(Error::value(format!("coordinates[{k}]"), coordinate.1, hint));
            }
            if self.coordinates[..k].contains(coordinate) {
                let (name, axis) = (&coordinate.0, DIRECTIONS[coordinate.1]);
                let hint = "is there twice: give each coordinate once";
                return Err(Error::value(
                    format!("coordinates[{k}]"),
                    format!("{name} {axis}"),
                    hint,
                ));
            }
        }
        limits::ascending("table: frequency", &self.frequency)?;
        limits::same_length(
            "table: receptance",
            self.values.len(),
            "its frequency",
            self.frequency.len(),
            "frequency",
        )?;
        for (k, matrix) in self.values.iter_mut().enumerate() {
            let argument = format!("table: receptance[{k}]");
            let of = "a square of the coordinates";
            limits::same_length(&argument, matrix.len(), of, count * count, "pair of coordinates")?;
            for row in 0..count {
                for column in 0..=row {
                    let mean = (matrix[row * count + column] + matrix[column * count + row]) * 0.5;
                    let argument = || format!("table: receptance[{k}][{row}][{column}]");
                    finite(argument, mean)?;
                    if row == column && mean.im > PHASE_BY_NOISE * mean.norm() {
                        let hint = "it gives power where force acts: data of test benches that write \
                                    e^{-iωt} have the other sign: conjugate them";
                        return Err(Error::value(argument(), mean, hint));
                    }
                    matrix[row * count + column] = mean;
                    matrix[column * count + row] = mean;
                }
            }
        }
        for receiver in &self.receivers {
            limits::name("receivers", &receiver.name)?;
            let argument = format!("receivers[{:?}]", receiver.name);
            limits::same_length(
                &argument,
                receiver.transfer.len(),
                "frequency of the table",
                self.frequency.len(),
                "frequency",
            )?;
            for row in &receiver.transfer {
                limits::same_length(&argument, row.len(), "coordinates", count, "coordinate")?;
                for &value in row.iter().flatten() {
                    finite(|| argument.clone(), value)?;
                }
            }
        }
        Ok(self)
    }

    /// Displacements over forces at an angular speed, between those measured.
    fn at(&self, omega: f64, point: impl FnOnce() -> String) -> Result<DMatrix<Complex64>> {
        let (below, above, share) = self.place(omega, point)?;
        let count = self.coordinates.len();
        let [before, after] = [below, above].map(|k| &self.values[k]);
        Ok(DMatrix::from_fn(count, count, |row, column| {
            let k = row * count + column;
            before[k] * (1.0 - share) + after[k] * share
        }))
    }

    /// Displacement of a receiver under forces at the coordinates.
    pub fn moved(
        &self,
        receiver: &Receiver,
        omega: f64,
        forces: &[Complex64],
    ) -> Result<[Complex64; 3]> {
        let (below, above, share) = self.place(omega, String::new)?;
        let mut sum = [Complex64::ZERO; 3];
        for (column, force) in forces.iter().enumerate() {
            let [before, after] = [below, above].map(|k| &receiver.transfer[k][column]);
            for axis in 0..3 {
                sum[axis] += (before[axis] * (1.0 - share) + after[axis] * share) * force;
            }
        }
        Ok(sum)
    }

    fn place(&self, omega: f64, point: impl FnOnce() -> String) -> Result<(usize, usize, f64)> {
        let frequency = omega / std::f64::consts::TAU;
        limits::between(&self.frequency, frequency).ok_or_else(|| {
            let [low, high] = [self.frequency[0], self.frequency[self.frequency.len() - 1]];
            let hint = format!(
                "{}, is outside: it has {low} to {high} Hz; extend the table, or give orders and speeds within it",
                point()
            );
            Error::value("table of the support", format!("{frequency:.6} Hz"), hint)
        })
    }
}

fn finite(argument: impl FnOnce() -> String, value: Complex64) -> Result<()> {
    if value.re.abs() <= limits::LARGEST && value.im.abs() <= limits::LARGEST {
        return Ok(());
    }
    Err(Error::value(argument(), value, "give finite numbers, m/N"))
}

impl Powertrain {
    /// The same on something that gives way.
    pub fn on(mut self, support: Support) -> Result<Self> {
        self.coordinates.clear();
        self.of_both.clear();
        match &support {
            Support::Subframe(subframe) if subframe.support.is_some() => {
                let hint = "give a subframe whose mounts stand on what does not move";
                return Err(Error::value("support", "a subframe on a support", hint));
            }
            Support::Subframe(subframe) if !subframe.forces.is_empty() => {
                let hint = "give them to the powertrain that it carries";
                return Err(Error::value("support", "a subframe with forces", hint));
            }
            Support::Subframe(subframe) if subframe.rest != super::LoadCase::default() => {
                let hint = "give it to the powertrain that it carries";
                return Err(Error::value("support", "a subframe with a state at rest", hint));
            }
            Support::Subframe(subframe) => {
                let cg = subframe.body.cg();
                let mut both = |above: &Matrix3x6<f64>, below: &Matrix3x6<f64>| {
                    let mut row = SMatrix::<f64, 3, 12>::zeros();
                    row.fixed_view_mut::<3, 6>(0, 0).copy_from(above);
                    row.fixed_view_mut::<3, 6>(0, 6).copy_from(below);
                    self.of_both.push(row);
                };
                let count = self.mounts.len();
                for (k, above) in self.deflections.iter().enumerate() {
                    let below = if let Some(place) = k.checked_sub(count) {
                        rotation_of(&self.mounts[self.rotations[place]])
                    } else {
                        let mount = &self.mounts[k];
                        mount.axes() * motion_of_point(&(mount.at() - cg))
                    };
                    both(above, &-below);
                }
                for below in &subframe.deflections {
                    both(&Matrix3x6::zeros(), below);
                }
            }
            Support::Receptance(_) if !self.rotations.is_empty() => {
                let name = self.mounts[self.rotations[0]].name();
                let hint = "has no rotations, which mounts with rotational_stiffness or rotational_damping resist";
                return Err(Error::value(
                    "support",
                    format!("a receptance under mount {name:?}"),
                    hint,
                ));
            }
            Support::Receptance(receptance) => {
                for (k, (name, axis)) in receptance.coordinates.iter().enumerate() {
                    let place = self.mounts.iter().position(|mount| mount.name() == name);
                    let mount = place.ok_or_else(|| {
                        let names: Vec<&str> = self.mounts.iter().map(super::Mount::name).collect();
                        let hint = format!("is no mount; there are {}", names.join(", "));
                        Error::value(format!("support.coordinates[{k}]"), name, hint)
                    })?;
                    self.coordinates.push(3 * mount + axis);
                }
            }
        }
        self.support = Some(support);
        self.settled()
    }

    /// What carries the mounts, if it gives way.
    #[must_use]
    pub fn support(&self) -> Option<&Support> {
        self.support.as_ref()
    }

    /// Places of the support's coordinates among the directions of all mounts.
    #[must_use]
    pub fn coordinates(&self) -> &[usize] {
        &self.coordinates
    }

    /// State under a load about the CG at an angular speed; none where the matrix has no inverse.
    pub fn state(
        &self,
        stiffnesses: &[[Complex64; 3]],
        omega: f64,
        load: &ComplexVector6,
        point: impl Fn() -> String,
    ) -> Result<Option<State>> {
        self.state_under(stiffnesses, omega, [load, &ComplexVector6::zeros()], point)
    }

    /// The same under a load on a subframe too, about its own CG.
    pub fn state_under(
        &self,
        stiffnesses: &[[Complex64; 3]],
        omega: f64,
        [load, below]: [&ComplexVector6; 2],
        point: impl Fn() -> String,
    ) -> Result<Option<State>> {
        match &self.support {
            None => Ok(self.motion(stiffnesses, omega, load).map(|motion| State {
                motion,
                carrier: Vec::new(),
                subframe: ComplexVector6::zeros(),
            })),
            Some(Support::Subframe(subframe)) => {
                let of_subframe = subframe.stiffnesses(omega, &point)?;
                let all = [stiffnesses, &of_subframe].concat();
                Ok(self.state_on_subframe(subframe, &all, omega, [load, below]))
            }
            Some(Support::Receptance(receptance)) => {
                let receptance = receptance.at(omega, &point)?;
                Ok(self.state_on_receptance(&receptance, stiffnesses, omega, load))
            }
        }
    }

    fn state_on_subframe(
        &self,
        subframe: &Powertrain,
        stiffnesses: &[[Complex64; 3]],
        omega: f64,
        [load, below]: [&ComplexVector6; 2],
    ) -> Option<State> {
        let square = omega * omega;
        let whole = assembled(&self.of_both, stiffnesses);
        let mut matrix = DMatrix::from_fn(12, 12, |i, j| whole[(i, j)]);
        let mut scale = DVector::zeros(12);
        for (first, body) in [(0, &self.body), (6, &subframe.body)] {
            let mass = body.mass_matrix();
            let mut block = matrix.view_mut((first, first), (6, 6));
            block -= mass.map(|m| Complex64::from(m * square));
            let units = mass.diagonal().map(|m| Complex64::from(m.sqrt().recip()));
            scale.rows_mut(first, 6).copy_from(&units);
        }
        let mut right = DVector::zeros(12);
        right.rows_mut(0, 6).copy_from(load);
        right.rows_mut(6, 6).copy_from(below);
        let solved = scaled_solution(&matrix, &scale, &right)?;
        let motion = ComplexVector6::from_fn(|k, _| solved[k]);
        let moved = ComplexVector6::from_fn(|k, _| solved[6 + k]);
        let carrier = self.mounts.iter().map(|mount| {
            let motion = motion_of_point(&(mount.at() - subframe.body.cg()));
            complex(&motion) * moved
        });
        Some(State { motion, carrier: carrier.collect(), subframe: moved })
    }

    fn state_on_receptance(
        &self,
        receptance: &DMatrix<Complex64>,
        stiffnesses: &[[Complex64; 3]],
        omega: f64,
        load: &ComplexVector6,
    ) -> Option<State> {
        let count = self.coordinates.len();
        // Stiffness along x, y and z of each mount, and force along the coordinates by motion.
        let blocks: Vec<_> = (0..self.mounts.len())
            .map(|k| {
                let axes = self.mounts[k].axes().map(Complex64::from);
                let along = nalgebra::Matrix3::from_diagonal(&stiffnesses[k].into());
                axes.transpose() * along * axes
            })
            .collect();
        let along = DMatrix::from_fn(count, count, |i, j| {
            let [row, column] = [self.coordinates[i], self.coordinates[j]];
            let is_same = row / 3 == column / 3;
            if is_same { blocks[row / 3][(row % 3, column % 3)] } else { Complex64::ZERO }
        });
        let mut forces = DMatrix::zeros(count, 6);
        for (i, &place) in self.coordinates.iter().enumerate() {
            let mount = &self.mounts[place / 3];
            let motion: Matrix3x6<f64> = motion_of_point(&(mount.at() - self.body.cg()));
            let row = blocks[place / 3].row(place % 3) * complex(&motion);
            forces.row_mut(i).copy_from(&row);
        }
        let both = DMatrix::identity(count, count) + &along * receptance;
        let carried = both.lu().solve(&forces)?;
        let softer = forces.transpose() * receptance * &carried;
        let mass = self.body.mass_matrix();
        let whole = self.assembled(stiffnesses) - mass.map(|m| Complex64::from(m * omega * omega));
        let matrix = DMatrix::from_fn(6, 6, |i, j| whole[(i, j)] - softer[(i, j)]);
        let units = mass.diagonal().map(|m| Complex64::from(m.sqrt().recip()));
        let scale = DVector::from_fn(6, |k, _| units[k]);
        let right = DVector::from_fn(6, |k, _| load[k]);
        let solved = scaled_solution(&matrix, &scale, &right)?;
        let displaced = receptance * carried * &solved;
        let mut carrier = vec![Vector3::zeros(); self.mounts.len()]; // bounded: 1000 mounts
        for (&place, &value) in self.coordinates.iter().zip(displaced.iter()) {
            carrier[place / 3][place % 3] = value;
        }
        let motion = ComplexVector6::from_fn(|k, _| solved[k]);
        Some(State { motion, carrier, subframe: ComplexVector6::zeros() })
    }
}

/// Solution in units in which all coordinates are of one size; none where there is no inverse.
fn scaled_solution(
    matrix: &DMatrix<Complex64>,
    scale: &DVector<Complex64>,
    load: &DVector<Complex64>,
) -> Option<DVector<Complex64>> {
    let scaled =
        DMatrix::from_fn(scale.len(), scale.len(), |i, j| matrix[(i, j)] * scale[i] * scale[j]);
    let factors = scaled.lu();
    let pivots = factors.u().diagonal().map(Complex64::norm);
    if pivots.min().is_nan() || pivots.min() <= LEAST_PIVOT * pivots.max() {
        return None;
    }
    let solved = factors.solve(&load.component_mul(scale))?;
    Some(solved.component_mul(scale))
}
