//! Axes: about which a free body turns under a torque of the crank, and about which it turns at rest.

use nalgebra::{Matrix3, Vector3, Vector6};

use super::bodies::{Bodies, load_above};
use super::modes::{NaturalModes, dynamic, natural};
use super::{Powertrain, ROUNDINGS, real};
use crate::numbers::error::{Error, Result};

/// Part of the reach of the mounts within which a place is the CG, or a coupling none: rounding of a few compliances.
const CENTRE_ROUNDING: f64 = 1e-10;

/// Torque roll axis, elastic roll axis, and where they are.
#[derive(Debug, Clone, PartialEq)]
pub struct RollAxes {
    /// Direction of the axis about which the free body turns under an oscillating torque about z: through
    /// the CG, towards the flywheel.
    pub torque_roll: [f64; 3],
    /// Its angle to the crank's axis, degrees.
    pub torque_roll_deg: f64,
    /// Distance of each mount from it, m.
    pub mount_distances: Vec<f64>,
    /// About which the body on its mounts turns under a torque about z at rest: with their static stiffness.
    pub elastic: ElasticAxis,
    /// About which it turns under one that oscillates slowly: with their dynamic stiffness.
    pub dynamic: ElasticAxis,
}

/// Axis of a screw: a rotation about it and a shift along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticAxis {
    /// Direction, towards the flywheel.
    pub direction: [f64; 3],
    /// Point of it next to the CG, m.
    pub foot: [f64; 3],
    /// From the CG to that point, m: across the axis.
    pub from_cg: [f64; 3],
    /// Elastic centre, m: a force through it causes no rotation; none where no point is such.
    pub centre: Option<[f64; 3]>,
    /// Shift along it over the rotation, m/rad; 0 of a plain axis.
    pub pitch: f64,
    /// Its angle to the crank's axis, degrees.
    pub angle_deg: f64,
    /// Rotation about z over the torque, rad/(N·m).
    pub compliance: f64,
    /// Its angle to the torque roll axis, degrees.
    pub to_torque_roll_deg: f64,
    /// Shortest distance between both lines, m.
    pub distance: f64,
}

/// Axes with the mounts' static stiffness, and with the dynamic one at a frequency, Hz, which may be left out where
/// the stiffness does not depend on it.
pub fn axes(powertrain: &Powertrain, frequency: Option<f64>) -> Result<RollAxes> {
    match powertrain.subframe()? {
        None => axes_of(&powertrain.alone()?, frequency),
        Some(_) => axes_of(&powertrain.with_subframe()?, frequency),
    }
}

fn axes_of<const N: usize>(bodies: &Bodies<N>, frequency: Option<f64>) -> Result<RollAxes> {
    let crank = Vector3::z();
    let (powertrain, body) = (bodies.powertrain, bodies.powertrain.body());
    let factors = body
        .inertia()
        .cholesky()
        .ok_or_else(|| Error::value("inertia", "not positive definite", "give a tensor that is"))?;
    let [least, _, most] = body.principal_moments();
    let free = factors.solve(&crank).normalize();
    let free = Bounded::new(free, Vector3::repeat(ROUNDINGS * f64::EPSILON * most / least));
    let torque_roll = free.value.normalize();
    let from_axis = |mount: &super::Mount| (mount.at() - body.cg()).cross(&torque_roll).norm();
    let (_, dynamic) = dynamic(powertrain, frequency)?;
    Ok(RollAxes {
        torque_roll: torque_roll.into(),
        torque_roll_deg: angle(&torque_roll, &crank),
        mount_distances: powertrain.mounts().iter().map(from_axis).collect(),
        elastic: elastic(bodies, &bodies.tangents(), &free)?,
        dynamic: elastic(bodies, &real(&dynamic), &free)?,
    })
}

/// Axis of the screw that the powertrain makes under a torque about z, with stiffnesses along the axes of all mounts.
fn elastic<const N: usize>(
    bodies: &Bodies<N>,
    stiffnesses: &[[f64; 3]],
    free: &Bounded,
) -> Result<ElasticAxis> {
    let modes = natural(bodies, stiffnesses);
    bodies.require_support(&modes)?;
    let torque = load_above(&Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0));
    let (motion, rounding) = modes.flexed(bodies, &torque);
    let part = |from: usize| {
        let [value, bound] =
            [&motion, &rounding].map(|of| Vector3::new(of[from], of[from + 1], of[from + 2]));
        Bounded::new(value, bound)
    };
    let (shift, turn) = (part(0), part(3));
    let (square, cg) = (turn.value.norm_squared(), bodies.centre());
    let from_cg = turn.cross(&shift).over(square);
    let foot = Bounded::new(
        cg + from_cg.value,
        from_cg.rounding + (cg.abs() + from_cg.value.abs()) * f64::EPSILON,
    );
    let unit = turn.over(turn.value.norm());
    let direction = unit.value.normalize();
    let normal = free.cross(&unit);
    // Lines that are parallel to rounding have the distance of any of their points.
    let distance = if normal.value.norm() > 1e-9 {
        from_cg.dot(&normal).abs() / normal.value.norm()
    } else {
        from_cg.value.norm()
    };
    Ok(ElasticAxis {
        direction: direction.into(),
        foot: foot.value.into(),
        from_cg: from_cg.value.into(),
        centre: centre(bodies, &modes),
        pitch: turn.dot(&shift) / square,
        angle_deg: angle(&direction, &Vector3::z()),
        compliance: turn.value.z,
        to_torque_roll_deg: angle(&free.value.normalize(), &direction),
        distance,
    })
}

/// Elastic centre: a force F at a distance d from the CG turns by C·F + T·(d × F), with C and T the rotations under
/// forces through the CG and under moments, none of any F where the matrix −T⁻¹·C is that of d ×, skew.
fn centre<const N: usize>(bodies: &Bodies<N>, modes: &NaturalModes<N>) -> Option<[f64; 3]> {
    let turned = |k: usize| {
        let unit = Vector6::from_fn(|row, _| f64::from(u8::from(row == k)));
        let (motion, _) = modes.flexed(bodies, &load_above(&unit));
        Vector3::new(motion[3], motion[4], motion[5])
    };
    let by_force = Matrix3::from_columns(&[turned(0), turned(1), turned(2)]);
    let by_moment = Matrix3::from_columns(&[turned(3), turned(4), turned(5)]);
    let across = -by_moment.try_inverse()? * by_force;
    let coupled = (across + across.transpose()).amax();
    let mounts = bodies.powertrain.mounts().iter();
    let reach = mounts.map(|mount| (mount.at() - bodies.centre()).norm()).fold(0.0, f64::max);
    let rounding = CENTRE_ROUNDING * reach;
    let [x, y, z] = [(2, 1), (0, 2), (1, 0)]
        .map(|(row, column)| 0.5 * (across[(row, column)] - across[(column, row)]));
    let snapped = |part: f64| if part.abs() <= rounding { 0.0 } else { part };
    let place = bodies.centre() + Vector3::new(x, y, z).map(snapped);
    (coupled <= rounding).then(|| place.map(snapped).into())
}

/// A vector of which no component is within its bound of rounding, but zero.
struct Bounded {
    value: Vector3<f64>,
    rounding: Vector3<f64>,
}

impl Bounded {
    fn new(value: Vector3<f64>, rounding: Vector3<f64>) -> Self {
        let value = value.zip_map(&rounding, |part, bound| {
            // Adding zero makes −0 0.
            if part.abs() <= bound { 0.0 } else { part + 0.0 }
        });
        Self { value, rounding }
    }

    fn over(&self, divisor: f64) -> Self {
        Self::new(self.value / divisor, self.rounding / divisor)
    }

    fn cross(&self, other: &Self) -> Self {
        let (a, b) = (&self.value, &other.value);
        let bound = |j: usize, k: usize| {
            let [aj, ak, bj, bk] = [a[j], a[k], b[j], b[k]].map(f64::abs);
            let products = aj * bk + ak * bj;
            let of_errors = self.rounding[j] * bk
                + self.rounding[k] * bj
                + other.rounding[j] * ak
                + other.rounding[k] * aj;
            of_errors + f64::EPSILON * products
        };
        Self::new(a.cross(b), Vector3::new(bound(1, 2), bound(2, 0), bound(0, 1)))
    }

    /// Scalar product, zero within its bound of rounding.
    fn dot(&self, other: &Self) -> f64 {
        let (a, b) = (self.value.abs(), other.value.abs());
        let of_errors = self.rounding.dot(&b) + other.rounding.dot(&a);
        let value = self.value.dot(&other.value);
        if value.abs() <= of_errors + 3.0 * f64::EPSILON * a.dot(&b) { 0.0 } else { value }
    }
}

/// Angle between two directions, degrees; of small angles too every digit is right.
fn angle(one: &Vector3<f64>, other: &Vector3<f64>) -> f64 {
    one.cross(other).norm().atan2(one.dot(other)).to_degrees()
}
