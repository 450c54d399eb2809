//! At rest: sag and preload under gravity, wind-up under a mean torque, and what a thrust does.

use nalgebra::{SVector, Vector3, Vector6};

use super::modes::{NaturalModes, natural};
use super::{Powertrain, ROUNDINGS, motion_of_point, support_polygon};
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
    let mut displacement = [[0.0; 6]; 3];
    let mut force = [Vec::new(), Vec::new(), Vec::new()];
    for (cause, load) in loads.iter().enumerate() {
        let (motion, rounding) = (modes.flexed(load), modes.flexed_rounding(powertrain, load)?);
        displacement[cause] = nonzero(&motion, &rounding).into();
        force[cause] = stiffnesses
            .iter()
            .enumerate()
            .map(|(k, along)| forces(powertrain, k, along, &motion, &rounding))
            .collect();
    }
    let places: Vec<_> = powertrain.mounts().iter().map(super::Mount::at).collect();
    let (support_corners, support_margin) =
        support_polygon(&places, powertrain.body().cg(), gravity.into());
    Ok(Static { displacement, force, support_margin, support_corners })
}

/// Zero in place of what is within its bound of rounding.
fn nonzero<const N: usize>(
    values: &SVector<f64, N>,
    rounding: &SVector<f64, N>,
) -> SVector<f64, N> {
    values.zip_map(rounding, |value, bound| if value.abs() <= bound { 0.0 } else { value })
}

/// Force of a mount on what carries it, along x, y and z, of a motion and the bound of its rounding.
fn forces(
    powertrain: &Powertrain,
    mount: usize,
    along: &[f64; 3],
    motion: &Vector6<f64>,
    rounding: &Vector6<f64>,
) -> [f64; 3] {
    let complex = motion.map(Complex64::from);
    let deflection = powertrain.deflection(mount, &complex, None);
    let force =
        powertrain.force_on_support(mount, &along.map(Complex64::from), &deflection).map(|f| f.re);
    let of_motion = rounding + motion.abs() * (6.0 * f64::EPSILON);
    let of_deflection = powertrain.deflections()[mount].abs() * of_motion;
    let bound = powertrain.mounts()[mount].axes().transpose().abs()
        * of_deflection.component_mul(&Vector3::from(*along));
    nonzero(&force.into(), &bound).into()
}

impl NaturalModes {
    /// Motion under a load at rest, K⁻¹f, of modes none of which is free.
    pub fn flexed(&self, load: &Vector6<f64>) -> Vector6<f64> {
        let along = self.shapes.tr_mul(load);
        self.shapes * Vector6::from_fn(|mode, _| along[mode] / self.omega[mode].powi(2))
    }
    /// Bound of what rounding makes of each part of K⁻¹f: in coordinates of unit mass, of `K = AᵀA` with `A` known to
    /// some roundings of its norm.
    pub fn flexed_rounding(
        &self,
        powertrain: &Powertrain,
        load: &Vector6<f64>,
    ) -> Result<Vector6<f64>> {
        let (least, most) = (self.omega[0], self.omega[5]);
        let along = self.shapes.tr_mul(load);
        let weighted = |power: i32| Vector6::from_fn(|k, _| along[k] / self.omega[k].powi(power));
        let [moved, strained] = [weighted(2).norm(), weighted(1).norm()];
        let roundings = ROUNDINGS * powertrain.mounts().len() as f64 * f64::EPSILON;
        let bound = roundings * (most / least) * (moved + strained / least);
        let unit = powertrain.unit_mass()?;
        Ok(Vector6::from_fn(|row, _| unit.row(row).norm() * bound))
    }
}
