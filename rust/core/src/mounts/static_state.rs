//! At rest: sag and preload under gravity, wind-up under a mean torque, and what a thrust does.

use nalgebra::{Vector3, Vector6};

use super::modes::{NaturalModes, natural};
use super::{Powertrain, motion_of_point, support_polygon};
use crate::Complex64;
use crate::numbers::error::Result;
use crate::numbers::limits;

/// A body at rest on its mounts.
#[derive(Debug, Clone, PartialEq)]
pub struct Static {
    /// Displacement of the CG, m, and rotation, rad, under weight, torque and thrust.
    pub displacement: [[f64; 6]; 3],
    /// Force of each mount on what carries it, N, of weight, torque and thrust.
    pub force: [Vec<[f64; 3]>; 3],
    /// Distance of the CG, seen along gravity, from the edge of the mounts' polygon, m: above zero within.
    pub support_margin: f64,
    /// Indices of the mounts at the corners of that polygon, in order.
    pub support_corners: Vec<usize>,
}

/// The body under gravity, m/s², under a torque on it about z, N·m, and under a thrust, N, at a place, m, with the
/// mounts' static stiffness.
pub fn at_rest(
    powertrain: &Powertrain,
    gravity: [f64; 3],
    torque: f64,
    [thrust, thrust_at]: [[f64; 3]; 2],
) -> Result<Static> {
    for (name, vector) in [("gravity", gravity), ("thrust", thrust), ("thrust_at", thrust_at)] {
        for (k, part) in vector.into_iter().enumerate() {
            limits::finite(&format!("{name}[{k}]"), part)?;
        }
    }
    limits::finite("torque", torque)?;
    let stiffnesses: Vec<[f64; 3]> =
        powertrain.mounts().iter().map(super::Mount::static_stiffness).collect();
    let modes = natural(powertrain, &stiffnesses)?;
    modes.require_support(powertrain)?;
    let weight = Vector3::from(gravity) * powertrain.body().mass();
    let loads = [
        Vector6::new(weight.x, weight.y, weight.z, 0.0, 0.0, 0.0),
        Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, torque),
        motion_of_point(&(Vector3::from(thrust_at) - powertrain.body().cg())).transpose()
            * Vector3::from(thrust),
    ];
    let displacement = loads.map(|load| modes.flexed(&load));
    let force = displacement.map(|motion| {
        let motion = motion.map(Complex64::from);
        let forces = stiffnesses.iter().enumerate();
        forces
            .map(|(k, along)| {
                let (along, deflection) =
                    (along.map(Complex64::from), powertrain.deflection(k, &motion, None));
                powertrain.force_on_support(k, &along, &deflection).map(|force| force.re + 0.0)
            })
            .collect()
    });
    let places: Vec<_> = powertrain.mounts().iter().map(super::Mount::at).collect();
    let (support_corners, support_margin) =
        support_polygon(&places, powertrain.body().cg(), gravity.into());
    Ok(Static {
        displacement: displacement.map(|motion| motion.map(|part| part + 0.0).into()),
        force,
        support_margin,
        support_corners,
    })
}

impl NaturalModes {
    /// Motion under a load at rest, K⁻¹f, of modes none of which is free.
    pub fn flexed(&self, load: &Vector6<f64>) -> Vector6<f64> {
        let along = self.shapes.tr_mul(load);
        self.shapes * Vector6::from_fn(|mode, _| along[mode] / self.omega[mode].powi(2))
    }
}
