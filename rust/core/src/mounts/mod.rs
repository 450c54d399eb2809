//! A rigid body on its mounts: stiffness and mass, state at rest, modes, axes.
//!
//! The motion is q = (u, φ): displacement of the centre of gravity and a small rotation. Places are in
//! the engine's axes. What an engine makes of it is a reading of its loads.

mod axes;
mod bodies;
mod body;
pub(crate) mod equations;
mod equilibrium;
mod feedback;
pub(crate) mod file;
mod footprint;
mod forces;
mod modes;
mod mount;
mod robustness;
mod roll;
mod severity;
mod soil;
mod static_state;
mod stiffness;
mod support;
pub mod warnings;

use nalgebra::{Cholesky, Matrix3x6, SMatrix, Vector3};

pub use self::axes::{ElasticAxis, RollAxes, axes};
pub use self::bodies::matrices;
pub use self::body::{Products, RigidBody};
pub use self::feedback::{InertialActuator, motor_share};
pub use self::footprint::support_polygon;
pub(crate) use self::forces::moved;
pub use self::forces::{COMPONENTS, ForceTable};
pub use self::modes::{EQUAL_FREQUENCIES, FreeMotion, Modes, free_motions, modes};
pub(crate) use self::modes::{NaturalModes, frequency_and_purity, natural_at};
pub use self::mount::{Mount, MountFigures, motion_of_point};
pub use self::robustness::{MountTolerances, Robustness, robustness};
pub use self::roll::RollReaction;
pub use self::severity::{GRADES, Levels, grade};
pub use self::soil::{Base, Soil};
pub use self::static_state::{LoadCase, Static, at_rest};
pub use self::stiffness::{Dynamic, InertiaTrack, Table};
pub use self::support::{Coordinate, DIRECTIONS, Receiver, Receptance, State, Support};
use crate::Complex64;
use crate::numbers::error::{Error, Result};

/// Most mounts of a body.
pub const MOST_MOUNTS: usize = 1000;
/// Most tables of forces on a body.
const MOST_TABLES: usize = 256;
/// Least over largest pivot of a matrix that has an inverse.
const LEAST_PIVOT: f64 = 1e-14;
/// Rounding errors that a number gathers in sums of a dozen products and in rotations of Jacobi's method.
const ROUNDINGS: f64 = 16.0;

/// Complex 6 × 6 matrix of the motion.
pub type ComplexMatrix6 = nalgebra::Matrix6<Complex64>;
/// Complex motion, or load, about the CG.
pub type ComplexVector6 = nalgebra::Vector6<Complex64>;

/// A body on its mounts.
///
/// ```
/// use crankpin_core::mounts::{Mount, MountFigures, Powertrain, RigidBody};
///
/// let inertia = [[8.0, 0.0, 0.0], [0.0, 12.0, 0.0], [0.0, 0.0, 6.0]];
/// let body = RigidBody::new(150.0, [0.0, 0.1, 0.2], inertia, None)?;
/// let mount = |name: &str, x, z| {
///     let (at, stiffness) = ([x, 0.0, z], [2e5, 4e5, 2e5]);
///     Mount::new(MountFigures { name: name.into(), at, stiffness, ..MountFigures::default() })
/// };
/// let mounts = vec![mount("left", -0.3, 0.1)?, mount("right", 0.3, 0.1)?, mount("rear", 0.0, 0.6)?];
/// let powertrain = Powertrain::new(body, mounts)?;
/// assert_eq!(powertrain.mounts().len(), 3);
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Powertrain {
    body: RigidBody,
    mounts: Vec<Mount>,
    /// Deflection of each spring, of the motion: of each mount along its axes, then about them of those that resist
    /// rotation.
    deflections: Vec<Matrix3x6<f64>>,
    /// Indices of the mounts that resist rotation.
    rotations: Vec<usize>,
    /// What carries the mounts, if it gives way.
    support: Option<Support>,
    /// Deflection of each spring and each spring of a subframe, of the motions of both bodies; empty without one.
    of_both: Vec<SMatrix<f64, 3, 12>>,
    /// Places of a receptance's coordinates among the directions of all mounts.
    coordinates: Vec<usize>,
    /// What shakes the body besides an engine.
    forces: Vec<ForceTable>,
    /// The case at whose state of rest snubbers are taken for what moves.
    rest: LoadCase,
}

impl Powertrain {
    /// A body on at least one mount, whose names are distinct; snubbers are taken as at rest under standard gravity
    /// along −y.
    pub fn new(body: RigidBody, mounts: Vec<Mount>) -> Result<Self> {
        Self::resting(body, mounts, LoadCase::default())
    }

    /// The same with the case at whose state of rest snubbers are taken for what moves: those that act add their
    /// stiffness.
    pub fn resting(body: RigidBody, mounts: Vec<Mount>, rest: LoadCase) -> Result<Self> {
        if mounts.is_empty() || mounts.len() > MOST_MOUNTS {
            let hint = format!("give 1 to {MOST_MOUNTS} mounts");
            return Err(Error::value("mounts", format!("{} mounts", mounts.len()), hint));
        }
        for (k, mount) in mounts.iter().enumerate() {
            if mounts[..k].iter().any(|other| other.name() == mount.name()) {
                let hint = "is the name of another mount: give each its own";
                return Err(Error::value(format!("mounts[{k}].name"), mount.name(), hint));
            }
        }
        let deflection = |mount: &Mount| mount.axes() * motion_of_point(&(mount.at() - body.cg()));
        let resists = |k: &usize| mounts[*k].rotation().is_some();
        let rotations: Vec<usize> = (0..mounts.len()).filter(resists).collect();
        let turned = rotations.iter().map(|&k| rotation_of(&mounts[k]));
        let deflections = mounts.iter().map(deflection).chain(turned).collect();
        let (of_both, coordinates) = (Vec::new(), Vec::new());
        let forces = Vec::new();
        rest.check()?;
        let powertrain = Self {
            body,
            mounts,
            deflections,
            rotations,
            support: None,
            of_both,
            coordinates,
            forces,
            rest,
        };
        powertrain.settled()
    }

    /// The same with the snubbers that act at rest counted in motion; on a receptance as on what does not move.
    fn settled(mut self) -> Result<Self> {
        if !self.is_snubbed() {
            return Ok(self);
        }
        let contacts = static_state::contacts(&self)?;
        let (own, below) = contacts.split_at(self.mounts.len());
        for (mount, contact) in self.mounts.iter_mut().zip(own) {
            mount.settle(*contact)?;
        }
        if let Some(Support::Subframe(subframe)) = &mut self.support {
            for (mount, contact) in subframe.mounts.iter_mut().zip(below) {
                mount.settle(*contact)?;
            }
        }
        Ok(self)
    }

    /// Whether a mount, or one of a subframe, has snubbers.
    #[must_use]
    pub fn is_snubbed(&self) -> bool {
        self.all_mounts().any(Mount::is_snubbed)
    }

    /// The case at whose state of rest snubbers are taken for what moves.
    #[must_use]
    pub fn rest(&self) -> &LoadCase {
        &self.rest
    }

    /// The same with tables of forces that shake the body besides an engine.
    pub fn with_forces(self, forces: Vec<ForceTable>) -> Result<Self> {
        if forces.len() > MOST_TABLES {
            let hint = format!("give at most {MOST_TABLES}");
            return Err(Error::value("forces", format!("{} tables", forces.len()), hint));
        }
        let checked = forces.into_iter().enumerate();
        let checked = checked.map(|(k, table)| table.checked(&format!("forces[{k}].")));
        Ok(Self { forces: checked.collect::<Result<_>>()?, ..self })
    }

    /// Tables of forces that shake the body besides an engine.
    #[must_use]
    pub fn forces(&self) -> &[ForceTable] {
        &self.forces
    }

    /// The body.
    #[must_use]
    pub fn body(&self) -> &RigidBody {
        &self.body
    }

    /// The mounts.
    #[must_use]
    pub fn mounts(&self) -> &[Mount] {
        &self.mounts
    }

    /// Deflection of each spring, of the motion: of the mounts along their own axes, then about them of those that
    /// resist rotation.
    #[must_use]
    pub fn deflections(&self) -> &[Matrix3x6<f64>] {
        &self.deflections
    }

    /// Stiffness of each spring at an angular speed, N/m and N·m/rad; `point` names the operation.
    pub fn stiffnesses(
        &self,
        omega: f64,
        point: impl Fn() -> String,
    ) -> Result<Vec<[Complex64; 3]>> {
        self.springs().map(|spring| spring.stiffness_at(omega, &point)).collect()
    }

    /// The springs: each mount along its axes, then those that resist rotation about them.
    pub fn springs(&self) -> impl Iterator<Item = Spring<'_>> {
        let along = (0..self.mounts.len()).map(|owner| (owner, false));
        let about = self.rotations.iter().map(|&owner| (owner, true));
        along.chain(about).map(|(owner, is_rotation)| Spring {
            owner,
            mount: &self.mounts[owner],
            is_rotation,
        })
    }

    /// The springs, then those of a subframe, whose owners are counted after the mounts.
    pub fn all_springs(&self) -> impl Iterator<Item = Spring<'_>> {
        let count = self.mounts.len();
        let below = self.support.as_ref().and_then(|support| match support {
            Support::Subframe(subframe) => Some(subframe.springs()),
            Support::Receptance(_) => None,
        });
        let below = below.into_iter().flatten();
        self.springs()
            .chain(below.map(move |spring| Spring { owner: count + spring.owner, ..spring }))
    }

    /// The mounts, then those of a subframe.
    pub fn all_mounts(&self) -> impl Iterator<Item = &Mount> {
        let below = self.support.as_ref().and_then(|support| match support {
            Support::Subframe(subframe) => Some(&subframe.mounts),
            Support::Receptance(_) => None,
        });
        self.mounts.iter().chain(below.into_iter().flatten())
    }

    /// Their names; those of a subframe's say so.
    #[must_use]
    pub fn all_names(&self) -> Vec<String> {
        let of = |(k, mount): (usize, &Mount)| {
            let prefix = if k < self.mounts.len() { "" } else { "subframe: " };
            format!("{prefix}{}", mount.name())
        };
        self.all_mounts().enumerate().map(of).collect()
    }

    /// Sum of springs of these stiffnesses: complex symmetric.
    #[must_use]
    pub fn assembled(&self, stiffnesses: &[[Complex64; 3]]) -> ComplexMatrix6 {
        assembled(&self.deflections, stiffnesses)
    }

    /// The matrix L⁻ᵀ whose columns have unit mass, with L·Lᵀ the mass matrix.
    pub fn unit_mass(&self) -> Result<nalgebra::Matrix6<f64>> {
        let error = || Error::value("inertia", "not positive definite", "give a tensor that is");
        let factors = Cholesky::new(self.body.inertia()).ok_or_else(error)?;
        let one = nalgebra::Matrix3::identity();
        let turn = factors.l().solve_lower_triangular(&one).ok_or_else(error)?.transpose();
        let mut unit = nalgebra::Matrix6::from_diagonal_element(self.body.mass().sqrt().recip());
        unit.fixed_view_mut::<3, 3>(3, 3).copy_from(&turn);
        Ok(unit)
    }

    /// Motion under a load about the CG at an angular speed; none where the matrix has no inverse, as in
    /// undamped resonance.
    #[must_use]
    pub fn motion(
        &self,
        stiffnesses: &[[Complex64; 3]],
        omega: f64,
        load: &ComplexVector6,
    ) -> Option<ComplexVector6> {
        let mass = self.body.mass_matrix();
        let matrix = self.assembled(stiffnesses) - mass.map(|m| Complex64::from(m * omega * omega));
        // In units in which translations and rotations are of one size.
        let scale = mass.diagonal().map(|m| Complex64::from(m.sqrt().recip()));
        let scaled = ComplexMatrix6::from_diagonal(&scale);
        let factors = (scaled * matrix * scaled).lu();
        let pivots = factors.u().diagonal().map(Complex64::norm);
        if pivots.min().is_nan() || pivots.min() <= LEAST_PIVOT * pivots.max() {
            return None;
        }
        Some(scaled * factors.solve(&(scaled * load))?)
    }

    /// Deflection of a spring, of a motion and the displacement of what carries it, or its rotation.
    #[must_use]
    pub fn deflection(
        &self,
        spring: usize,
        motion: &ComplexVector6,
        carrier: Option<&Vector3<Complex64>>,
    ) -> Vector3<Complex64> {
        let along = complex(&self.deflections[spring]) * motion;
        let count = self.mounts.len();
        let owner = if spring < count { spring } else { self.rotations[spring - count] };
        carrier
            .map_or(along, |moved| along - self.mounts[owner].axes().map(Complex64::from) * moved)
    }

    /// Force of a mount on what carries it, along x, y and z, of stiffness and deflection along its axes.
    #[must_use]
    pub fn force_on_support(
        &self,
        mount: usize,
        stiffness: &[Complex64; 3],
        deflection: &Vector3<Complex64>,
    ) -> [Complex64; 3] {
        let forces = Vector3::from_fn(|axis, _| stiffness[axis] * deflection[axis]);
        let axes = self.mounts[mount].axes().transpose().map(Complex64::from);
        (axes * forces).into()
    }

    /// Motion of a point, of a motion.
    #[must_use]
    pub fn motion_of(&self, point: [f64; 3], motion: &ComplexVector6) -> [Complex64; 3] {
        (complex(&motion_of_point(&self.arm(&point.into()))) * motion).into()
    }

    /// How far a point is from the CG, m.
    #[must_use]
    pub fn arm(&self, point: &Vector3<f64>) -> Vector3<f64> {
        point - self.body.cg()
    }
}

/// A mount along its axes, or about them.
#[derive(Debug, Clone, Copy)]
pub struct Spring<'a> {
    /// Index of the mount.
    pub owner: usize,
    /// The mount.
    pub mount: &'a Mount,
    /// Whether it resists rotation.
    pub is_rotation: bool,
}

impl Spring<'_> {
    /// Complex stiffness at an angular speed, N/m or N·m/rad; as [`Mount::stiffness_at`].
    pub fn stiffness_at(
        &self,
        omega: f64,
        point: impl FnOnce() -> String,
    ) -> Result<[Complex64; 3]> {
        match self.mount.rotation().filter(|_| self.is_rotation) {
            Some(about) => Ok(about.at(omega).unwrap_or_default()),
            None => self.mount.stiffness_at(omega, point),
        }
    }

    /// Static stiffness, N/m or N·m/rad.
    #[must_use]
    pub fn static_stiffness(&self) -> [f64; 3] {
        let figures = self.mount.figures();
        if self.is_rotation { figures.rotational_stiffness } else { figures.stiffness }
    }

    /// The same with that of snubbers that act at rest.
    #[must_use]
    pub fn tangent(&self) -> [f64; 3] {
        self.with_contact(self.static_stiffness())
    }

    /// Stiffness in motion without loss, N/m or N·m/rad; of a table the static one.
    #[must_use]
    pub fn in_motion(&self) -> [f64; 3] {
        let figures = self.mount.figures();
        if self.is_rotation {
            return figures.rotational_stiffness;
        }
        self.with_contact(figures.in_motion())
    }

    fn with_contact(&self, mut along: [f64; 3]) -> [f64; 3] {
        if !self.is_rotation {
            for (stiffness, contact) in along.iter_mut().zip(self.mount.contact()) {
                *stiffness += contact.into_iter().sum::<f64>();
            }
        }
        along
    }

    /// How the stiffness depends on frequency.
    #[must_use]
    pub fn dynamic(&self) -> &Dynamic {
        self.mount.rotation().filter(|_| self.is_rotation).unwrap_or(self.mount.dynamic())
    }
}

/// Rotation of a mount about its axes, of the motion.
fn rotation_of(mount: &Mount) -> Matrix3x6<f64> {
    let mut turned = Matrix3x6::zeros();
    turned.fixed_view_mut::<3, 3>(0, 3).copy_from(&mount.axes());
    turned
}

/// Sum of springs of these stiffnesses, of their deflections.
fn assembled<const N: usize>(
    deflections: &[SMatrix<f64, 3, N>],
    stiffnesses: &[[Complex64; 3]],
) -> SMatrix<Complex64, N, N> {
    let mut sum = SMatrix::zeros();
    for (deflection, along) in deflections.iter().zip(stiffnesses) {
        for (axis, &stiffness) in along.iter().enumerate() {
            let row = deflection.row(axis);
            for (j, &right) in row.iter().enumerate() {
                let scaled = stiffness * right;
                for (i, &left) in row.iter().enumerate() {
                    sum[(i, j)] += scaled * left;
                }
            }
        }
    }
    sum
}

fn complex(matrix: &Matrix3x6<f64>) -> Matrix3x6<Complex64> {
    matrix.map(Complex64::from)
}

/// Real part of stiffnesses.
fn real(stiffnesses: &[[Complex64; 3]]) -> Vec<[f64; 3]> {
    stiffnesses.iter().map(|along| along.map(|k| k.re)).collect()
}

#[cfg(test)]
pub(crate) mod tests;
