//! The bodies that move, on all their mounts: the powertrain alone, or with the subframe that carries it.

use nalgebra::{DMatrix, SMatrix, SVector, Vector3, Vector6};

use super::modes::{NaturalModes, dynamic};
use super::{Powertrain, Support, assembled};
use crate::Complex64;
use crate::numbers::error::{Error, Result};

/// Mass, and deflections of all mounts, of N coordinates: six of each body.
pub(crate) struct Bodies<'a, const N: usize> {
    pub powertrain: &'a Powertrain,
    pub mass: SMatrix<f64, N, N>,
    /// L⁻ᵀ, whose columns have unit mass, with L·Lᵀ the mass matrix.
    pub unit: SMatrix<f64, N, N>,
    /// Deflection of each spring.
    pub deflections: &'a [SMatrix<f64, 3, N>],
}

/// What a reading of N coordinates makes of a powertrain.
pub(crate) type OfPowertrain<const N: usize> = fn(&Powertrain) -> Result<Bodies<'_, N>>;

impl Powertrain {
    /// The subframe that carries the mounts, or none where that does not move; an error of a receptance.
    pub fn subframe(&self) -> Result<Option<&Powertrain>> {
        match self.support() {
            None => Ok(None),
            Some(Support::Subframe(subframe)) => Ok(Some(subframe)),
            Some(Support::Receptance(_)) => {
                let hint = "is known at its coordinates and frequencies alone, and has no modes, axes or state \
                            at rest: give a subframe, or leave out the support";
                Err(Error::value("support", "a receptance", hint))
            }
        }
    }

    /// An error where what carries the mounts gives way.
    pub fn require_ground(&self) -> Result<()> {
        let Some(_) = self.subframe()? else { return Ok(()) };
        let hint = "counts in response, modes, axes, state at rest and tolerances; this is of mounts on what \
                    does not move: leave out the support";
        Err(Error::value("support", "a subframe", hint))
    }

    /// The powertrain's own body.
    pub(crate) fn alone(&self) -> Result<Bodies<'_, 6>> {
        let (mass, unit) = (self.body().mass_matrix(), self.unit_mass()?);
        Ok(Bodies { powertrain: self, mass, unit, deflections: &self.deflections })
    }

    /// Both bodies, of a powertrain on a subframe.
    pub(crate) fn with_subframe(&self) -> Result<Bodies<'_, 12>> {
        let below = self.subframe()?.unwrap_or(self);
        let side_by_side = |[above, below]: [nalgebra::Matrix6<f64>; 2]| {
            let mut both = SMatrix::<f64, 12, 12>::zeros();
            both.fixed_view_mut::<6, 6>(0, 0).copy_from(&above);
            both.fixed_view_mut::<6, 6>(6, 6).copy_from(&below);
            both
        };
        Ok(Bodies {
            powertrain: self,
            mass: side_by_side([self.body().mass_matrix(), below.body().mass_matrix()]),
            unit: side_by_side([self.unit_mass()?, below.unit_mass()?]),
            deflections: &self.of_both,
        })
    }
}

impl<const N: usize> Bodies<'_, N> {
    /// Centre of gravity of the powertrain.
    pub fn centre(&self) -> Vector3<f64> {
        self.powertrain.body().cg()
    }

    /// Centre of gravity of a subframe, or of the powertrain without one.
    pub fn centre_below(&self) -> Vector3<f64> {
        match self.powertrain.support() {
            Some(Support::Subframe(subframe)) => subframe.body().cg(),
            _ => self.centre(),
        }
    }

    /// Static stiffness of all springs.
    pub fn static_stiffnesses(&self) -> Vec<[f64; 3]> {
        self.powertrain.all_springs().map(|spring| spring.static_stiffness()).collect()
    }

    /// The same with that of snubbers that act at rest.
    pub fn tangents(&self) -> Vec<[f64; 3]> {
        self.powertrain.all_springs().map(|spring| spring.tangent()).collect()
    }

    /// An error where some motion is free.
    pub fn require_support(&self, modes: &NaturalModes<N>) -> Result<()> {
        let motions = modes.free_motions(self);
        if motions.is_empty() {
            return Ok(());
        }
        let names = self.powertrain.all_names();
        let words: Vec<String> = motions.iter().map(super::FreeMotion::in_words).collect();
        let (are, them) = if words.len() == 1 { ("is", "it") } else { ("are", "them") };
        let hint = format!(
            "{} {are} free: add a mount that resists {them}, or stiffness",
            words.join("; ")
        );
        Err(Error::value("mounts", names.join(", "), hint))
    }
}

/// A load on the powertrain's body.
pub(crate) fn load_above<const N: usize>(load: &Vector6<f64>) -> SVector<f64, N> {
    SVector::from_fn(|k, _| if k < 6 { load[k] } else { 0.0 })
}

/// Mass matrix and complex stiffness with all mounts' stiffness at a frequency, Hz, of displacement of the CG and
/// rotation, of a subframe's after those.
pub fn matrices(
    powertrain: &Powertrain,
    frequency: Option<f64>,
) -> Result<(DMatrix<f64>, DMatrix<Complex64>)> {
    fn of<const N: usize>(
        bodies: &Bodies<N>,
        stiffnesses: &[[Complex64; 3]],
    ) -> (DMatrix<f64>, DMatrix<Complex64>) {
        let stiffness = assembled(bodies.deflections, stiffnesses);
        (
            DMatrix::from_fn(N, N, |i, j| bodies.mass[(i, j)]),
            DMatrix::from_fn(N, N, |i, j| stiffness[(i, j)]),
        )
    }
    let (_, stiffnesses) = dynamic(powertrain, frequency)?;
    Ok(match powertrain.subframe()? {
        None => of(&powertrain.alone()?, &stiffnesses),
        Some(_) => of(&powertrain.with_subframe()?, &stiffnesses),
    })
}
