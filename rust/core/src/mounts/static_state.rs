//! At rest: sag and preload under gravity, wind-up under a mean torque, and displacement by a thrust.

use nalgebra::{SMatrix, SVector, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::bodies::{Bodies, load_above};
use super::equilibrium::Snubbed;
use super::modes::NaturalModes;
use super::{Powertrain, ROUNDINGS, Support, motion_of_point, support_polygon};
use crate::numbers::error::Result;
use crate::numbers::limits;

/// Largest bound of rounding, over the largest value, that distinguishes zeros from others.
const MEANINGFUL: f64 = 1e-6;

/// What a body at rest bears.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LoadCase {
    /// Acceleration of gravity, m/s², which acts on a subframe too.
    pub gravity: [f64; 3],
    /// Acceleration of the vehicle, m/s².
    pub acceleration: [f64; 3],
    /// Mean torque that leaves the unit, N·m, about z: its opposite acts on the body.
    pub torque: f64,
    /// Thrust, N.
    pub thrust: [f64; 3],
    /// Place where it acts, m.
    pub thrust_at: [f64; 3],
}

impl Default for LoadCase {
    fn default() -> Self {
        Self {
            gravity: [0.0, -9.806_65, 0.0],
            acceleration: [0.0; 3],
            torque: 0.0,
            thrust: [0.0; 3],
            thrust_at: [0.0; 3],
        }
    }
}

impl LoadCase {
    /// Rejects numbers that are not finite.
    pub fn check(&self) -> Result<()> {
        let vectors = [
            ("gravity", self.gravity),
            ("acceleration", self.acceleration),
            ("thrust", self.thrust),
            ("thrust_at", self.thrust_at),
        ];
        for (name, vector) in vectors {
            let wrong = (0..3).find(|&k| limits::finite("", vector[k]).is_err());
            if let Some(k) = wrong {
                limits::finite(&format!("{name}[{k}]"), vector[k])?;
            }
        }
        limits::finite("torque", self.torque).map(drop)
    }

    /// Gravity in the vehicle's own motion.
    fn apparent_gravity(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.gravity[k] - self.acceleration[k])
    }
}

/// A body at rest on its mounts.
#[derive(Debug, Clone, PartialEq)]
pub struct Static {
    /// Displacement of the CG, m, and rotation, rad, under weight, torque and thrust, each on those before.
    pub displacement: [[f64; 6]; 3],
    /// Force of each mount on what carries it, N, of weight, torque and thrust; of a subframe's mounts after the
    /// others.
    pub force: [Vec<[f64; 3]>; 3],
    /// Deflection of each mount along its own axes, m, of all of these.
    pub deflection: Vec<[f64; 3]>,
    /// The same along x, y and z.
    pub travel: Vec<[f64; 3]>,
    /// Force of the snubbers of each mount along its own axes on what carries it, N, of all of these.
    pub snubber_force: Vec<[f64; 3]>,
    /// Distance of the CG, seen along gravity less the vehicle's acceleration, from the edge of the mounts' polygon, m: above zero within.
    pub support_margin: f64,
    /// Indices of the mounts at the corners of that polygon, in order.
    pub support_corners: Vec<usize>,
}

/// The body under a case, with the mounts' static stiffness and their snubbers.
pub fn at_rest(powertrain: &Powertrain, case: &LoadCase) -> Result<Static> {
    case.check()?;
    match powertrain.subframe()? {
        None => bodies_at_rest(&powertrain.alone()?, case),
        Some(_) => bodies_at_rest(&powertrain.with_subframe()?, case),
    }
}

/// Stiffness of the snubbers against and along the axes of all mounts that act at rest, N/m.
pub(super) fn contacts(powertrain: &Powertrain) -> Result<Vec<[[f64; 2]; 3]>> {
    fn of<const N: usize>(bodies: &Bodies<N>) -> Result<Vec<[[f64; 2]; 3]>> {
        let snubbed = Snubbed::new(bodies);
        let load = case_loads(bodies, bodies.powertrain.rest()).into_iter().sum();
        let contacts = snubbed.contacts(&snubbed.under(&load, &snubbed.unloaded())?);
        let springs = bodies.powertrain.all_springs().zip(contacts);
        let mounts = springs.filter(|(spring, _)| !spring.is_rotation);
        Ok(mounts.map(|(_, contact)| contact).collect())
    }
    match powertrain.support() {
        Some(Support::Subframe(_)) => of(&powertrain.with_subframe()?),
        _ => of(&powertrain.alone()?),
    }
}

/// Loads on the coordinates by weight, torque and thrust.
fn case_loads<const N: usize>(bodies: &Bodies<N>, case: &LoadCase) -> [SVector<f64, N>; 3] {
    let gravity = case.apparent_gravity();
    let falling = SVector::from_fn(|k, _| if k % 6 < 3 { gravity[k % 6] } else { 0.0 });
    let push = motion_of_point(&(Vector3::from(case.thrust_at) - bodies.centre())).transpose()
        * Vector3::from(case.thrust);
    [
        bodies.mass * falling,
        load_above(&Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, -case.torque)),
        load_above(&push),
    ]
}

fn bodies_at_rest<const N: usize>(bodies: &Bodies<N>, case: &LoadCase) -> Result<Static> {
    let powertrain = bodies.powertrain;
    let snubbed = Snubbed::new(bodies);
    let mut displacement = [[0.0; 6]; 3];
    let mut force = [Vec::new(), Vec::new(), Vec::new()];
    let mut deflection = vec![[Vector3::zeros(); 2]; bodies.deflections.len()]; // bounded: 1000 mounts
    let mut all = SVector::zeros();
    let mut state = snubbed.unloaded();
    for (cause, load) in case_loads(bodies, case).iter().enumerate() {
        all += load;
        let next = snubbed.under(&all, &state)?;
        // Where the same snubbers act the load alone moves the body as springs would let it.
        let is_linear = next.piece.is(&state.piece);
        let (motion, rounding) = if is_linear {
            next.piece.modes.flexed(bodies, load)
        } else {
            (next.motion - state.motion, next.rounding + state.rounding)
        };
        let moved = nonzero(&motion, &rounding, motion.amax());
        displacement[cause] = std::array::from_fn(|k| moved[k]);
        let along_axes: Vec<[Vector3<f64>; 2]> = if is_linear {
            let springs = bodies.deflections.iter().zip(&next.piece.tangent);
            springs.map(|(rows, along)| spring_force(rows, along, [&motion, &rounding])).collect()
        } else {
            let both = snubbed.forces(&next).into_iter().zip(snubbed.forces(&state));
            both.map(|([after, bound], [before, other])| [after - before, bound + other]).collect()
        };
        for (sum, rows) in deflection.iter_mut().zip(bodies.deflections) {
            sum[0] += rows * motion;
            sum[1] += rows.abs() * (rounding + motion.abs() * (N as f64 * f64::EPSILON));
        }
        force[cause] = in_space(powertrain, &along_axes);
        state = next;
    }
    let own = |values: &[[Vector3<f64>; 2]]| -> Vec<[f64; 3]> {
        let largest = largest(values);
        let of_mounts = values.iter().zip(powertrain.all_springs());
        of_mounts
            .filter(|(_, spring)| !spring.is_rotation)
            .map(|([value, bound], _)| nonzero(value, bound, largest).into())
            .collect()
    };
    let snubbers = snubbed.snubber_forces(&state);
    let of_mounts = powertrain.all_springs().zip(snubbers);
    let snubber_force = of_mounts.filter(|(spring, _)| !spring.is_rotation);
    let places: Vec<_> = powertrain.mounts().iter().map(super::Mount::at).collect();
    let (support_corners, support_margin) =
        support_polygon(&places, powertrain.body().cg(), case.apparent_gravity().into());
    Ok(Static {
        displacement,
        force,
        deflection: own(&deflection),
        travel: in_space(powertrain, &deflection),
        snubber_force: snubber_force.map(|(_, force)| force).collect(),
        support_margin,
        support_corners,
    })
}

/// Force of a spring along its axes, of stiffness and a motion, and the bound of its rounding, of that of the motion.
fn spring_force<const N: usize>(
    rows: &SMatrix<f64, 3, N>,
    along: &[f64; 3],
    [motion, rounding]: [&SVector<f64, N>; 2],
) -> [Vector3<f64>; 2] {
    let stiffness = Vector3::from(*along);
    let of_motion = rounding + motion.abs() * (N as f64 * f64::EPSILON);
    let of_deflection = rows.abs() * of_motion;
    [(rows * motion).component_mul(&stiffness), of_deflection.component_mul(&stiffness)]
}

/// Largest component.
fn largest(values: &[[Vector3<f64>; 2]]) -> f64 {
    values.iter().map(|[value, _]| value.amax()).fold(0.0, f64::max)
}

/// Vectors of all springs along their axes, with bounds of their rounding, as those of the mounts along x, y and z.
fn in_space(powertrain: &Powertrain, of_springs: &[[Vector3<f64>; 2]]) -> Vec<[f64; 3]> {
    let springs = powertrain.all_springs().zip(of_springs);
    let turned: Vec<[Vector3<f64>; 2]> = springs
        .filter(|(spring, _)| !spring.is_rotation)
        .map(|(spring, [value, bound])| {
            let axes = spring.mount.axes().transpose();
            [axes * value, axes.abs() * bound]
        })
        .collect();
    let largest = largest(&turned);
    turned.iter().map(|[value, bound]| nonzero(value, bound, largest).into()).collect()
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
