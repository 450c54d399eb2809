//! Axes: about which a free body turns under a torque of the crank, and about which it turns at rest.

use nalgebra::{Vector3, Vector6};

use super::modes::{dynamic, natural};
use super::{Powertrain, real};
use crate::numbers::error::{Error, Result};

/// Torque roll axis, elastic roll axis, and where they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Axes {
    /// Direction of the axis about which the free body turns under an oscillating torque about z: through
    /// the CG, towards the flywheel.
    pub torque_roll: [f64; 3],
    /// Its angle to the crank's axis, degrees.
    pub torque_roll_deg: f64,
    /// Distance of each mount from it, m.
    pub mount_distances: Vec<f64>,
    /// About which the body on its mounts turns under a torque about z at rest.
    pub elastic: ElasticAxis,
    /// Angle between both, degrees.
    pub angle_deg: f64,
    /// Shortest distance between both lines, m.
    pub distance: f64,
}

/// Axis of a screw: a rotation about it and a shift along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticAxis {
    /// Direction, towards the flywheel.
    pub direction: [f64; 3],
    /// Point of it next to the CG, m.
    pub foot: [f64; 3],
    /// Shift along it over the rotation, m/rad; 0 of a plain axis.
    pub pitch: f64,
    /// Its angle to the crank's axis, degrees.
    pub angle_deg: f64,
    /// Rotation about z over the torque, rad/(N·m).
    pub compliance: f64,
}

/// Axes with the mounts' dynamic stiffness at a frequency, Hz, which may be left out where the stiffness
/// does not depend on it.
pub fn axes(powertrain: &Powertrain, frequency: Option<f64>) -> Result<Axes> {
    let crank = Vector3::z();
    let body = powertrain.body();
    let torque_roll =
        body.inertia().cholesky().map(|factors| factors.solve(&crank).normalize()).ok_or_else(
            || Error::value("inertia", "not positive definite", "give a tensor that is"),
        )?;
    let (_, stiffnesses) = dynamic(powertrain, frequency)?;
    let modes = natural(powertrain, &real(&stiffnesses))?;
    modes.require_support(powertrain)?;
    let motion = modes.flexed(&Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0));
    let shift: Vector3<f64> = motion.fixed_rows::<3>(0).into();
    let turn: Vector3<f64> = motion.fixed_rows::<3>(3).into();
    let from_cg = turn.cross(&shift) / turn.norm_squared();
    let direction = turn.normalize();
    let normal = torque_roll.cross(&direction);
    // Lines that are parallel to rounding have the distance of any of their points.
    let distance = if normal.norm() > 1e-9 {
        from_cg.dot(&normal).abs() / normal.norm()
    } else {
        from_cg.norm()
    };
    let from_axis = |mount: &super::Mount| (mount.at() - body.cg()).cross(&torque_roll).norm();
    Ok(Axes {
        torque_roll: torque_roll.into(),
        torque_roll_deg: angle(&torque_roll, &crank),
        mount_distances: powertrain.mounts().iter().map(from_axis).collect(),
        elastic: ElasticAxis {
            direction: direction.into(),
            foot: (body.cg() + from_cg).into(),
            pitch: turn.dot(&shift) / turn.norm_squared(),
            angle_deg: angle(&direction, &crank),
            compliance: turn.z,
        },
        angle_deg: angle(&torque_roll, &direction),
        distance,
    })
}

/// Angle between two directions, degrees; of small angles too every digit is right.
fn angle(one: &Vector3<f64>, other: &Vector3<f64>) -> f64 {
    one.cross(other).norm().atan2(one.dot(other)).to_degrees()
}
