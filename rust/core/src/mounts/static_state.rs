//! At rest: sag and preload under gravity, wind-up under a mean torque, and displacement by a thrust.

use nalgebra::{SVector, Vector3, Vector6};

use super::bodies::{Bodies, load_above};
use super::modes::{NaturalModes, natural};
use super::{Powertrain, ROUNDINGS, motion_of_point, support_polygon};
use crate::numbers::error::Result;
use crate::numbers::limits;

/// Largest bound of rounding, over the largest value, that distinguishes zeros from others.
const MEANINGFUL: f64 = 1e-6;

/// A body at rest on its mounts.
#[derive(Debug, Clone, PartialEq)]
pub struct Static {
    /// Displacement of the CG, m, and rotation, rad, under weight, torque and thrust.
    pub displacement: [[f64; 6]; 3],
    /// Force of each mount on what carries it, N, of weight, torque and thrust; of a subframe's mounts after the
    /// others.
    pub force: [Vec<[f64; 3]>; 3],
    /// Distance of the CG, seen along gravity, from the edge of the mounts' polygon, m: above zero within.
    pub support_margin: f64,
    /// Indices of the mounts at the corners of that polygon, in order.
    pub support_corners: Vec<usize>,
}

/// The body under gravity, m/s², which acts on a subframe too, under a torque on it about z, N·m, and under a thrust,
/// N, at a place, m, with the mounts' static stiffness.
pub fn at_rest(
    powertrain: &Powertrain,
    gravity: [f64; 3],
    torque: f64,
    thrust: [[f64; 3]; 2],
) -> Result<Static> {
    for (name, vector) in [("gravity", gravity), ("thrust", thrust[0]), ("thrust_at", thrust[1])] {
        for (k, part) in vector.into_iter().enumerate() {
            limits::finite(&format!("{name}[{k}]"), part)?;
        }
    }
    limits::finite("torque", torque)?;
    match powertrain.subframe()? {
        None => bodies_at_rest(&powertrain.alone()?, gravity, torque, thrust),
        Some(_) => bodies_at_rest(&powertrain.with_subframe()?, gravity, torque, thrust),
    }
}

fn bodies_at_rest<const N: usize>(
    bodies: &Bodies<N>,
    gravity: [f64; 3],
    torque: f64,
    [thrust, thrust_at]: [[f64; 3]; 2],
) -> Result<Static> {
    let powertrain = bodies.powertrain;
    let stiffnesses = bodies.static_stiffnesses();
    let modes = natural(bodies, &stiffnesses);
    bodies.require_support(&modes)?;
    let falling = SVector::from_fn(|k, _| if k % 6 < 3 { gravity[k % 6] } else { 0.0 });
    let push = motion_of_point(&(Vector3::from(thrust_at) - bodies.centre())).transpose()
        * Vector3::from(thrust);
    let loads = [
        bodies.mass * falling,
        load_above(&Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, torque)),
        load_above(&push),
    ];
    let mut displacement = [[0.0; 6]; 3];
    let mut force = [Vec::new(), Vec::new(), Vec::new()];
    for (cause, load) in loads.iter().enumerate() {
        let (motion, rounding) = modes.flexed(bodies, load);
        let moved = nonzero(&motion, &rounding, motion.amax());
        displacement[cause] = std::array::from_fn(|k| moved[k]);
        let springs = powertrain.all_springs().enumerate().zip(&stiffnesses);
        let mounts = springs.filter(|((_, spring), _)| !spring.is_rotation);
        let pairs: Vec<_> = mounts
            .map(|((k, spring), along)| {
                bodies.force((k, spring.mount), along, [&motion, &rounding])
            })
            .collect();
        let largest = pairs.iter().map(|[force, _]| force.amax()).fold(0.0, f64::max);
        let forces = pairs.iter().map(|[force, bound]| nonzero(force, bound, largest).into());
        force[cause] = forces.collect();
    }
    let places: Vec<_> = powertrain.mounts().iter().map(super::Mount::at).collect();
    let (support_corners, support_margin) =
        support_polygon(&places, powertrain.body().cg(), gravity.into());
    Ok(Static { displacement, force, support_margin, support_corners })
}

/// Zero in place of what is within its bound of rounding, where that says something: of bodies and stiffnesses many
/// powers of ten apart it is beyond what there is.
fn nonzero<const N: usize>(
    values: &SVector<f64, N>,
    rounding: &SVector<f64, N>,
    largest: f64,
) -> SVector<f64, N> {
    values.zip_map(rounding, |value, bound| {
        if value.abs() <= bound && bound <= MEANINGFUL * largest { 0.0 } else { value }
    })
}

impl<const N: usize> NaturalModes<N> {
    /// Motion under a load at rest, K⁻¹f, of modes none of which is free, and a bound of what rounding makes of each
    /// part: in coordinates of unit mass, of `K = AᵀA` with `A` known to some roundings of its norm.
    pub fn flexed(
        &self,
        bodies: &Bodies<N>,
        load: &SVector<f64, N>,
    ) -> (SVector<f64, N>, SVector<f64, N>) {
        let (least, most) = (self.omega[0], self.omega[N - 1]);
        let along = self.shapes.tr_mul(load);
        let weighted =
            |power: i32| SVector::<f64, N>::from_fn(|k, _| along[k] / self.omega[k].powi(power));
        let [moved, strained] = [weighted(2).norm(), weighted(1).norm()];
        let roundings = ROUNDINGS * bodies.deflections.len() as f64 * f64::EPSILON;
        let bound = roundings * (most / least) * (moved + strained / least);
        let rounding = SVector::from_fn(|row, _| bodies.unit.row(row).norm() * bound);
        (self.shapes * weighted(2), rounding)
    }
}
