//! Equilibrium of bodies on springs and snubbers, which act beyond a gap.
//!
//! With d the deflections, the potential ½dᵀkd + Σ ½s·max(d − gap, 0)² − qᵀf is convex, has a continuous gradient, and
//! is one of finitely many quadratic functions wherever the snubbers that act stay the same. Newton's step of such a
//! piece leads to its own minimum; an exact search along the step makes the potential fall whatever other pieces it
//! crosses. The matrices of the pieces are finitely many, so the falls tend to zero only towards the minimum; all
//! pieces next to that have it as theirs, so that the first step from there ends at it. Where springs and snubbers that
//! act leave a motion free, the step goes along it, until a snubber stops it or nothing does.

use nalgebra::{SVector, Vector3};

use super::ROUNDINGS;
use super::bodies::Bodies;
use super::modes::{NaturalModes, natural};
use crate::numbers::error::{Error, Result};

/// Steps of the search; a dozen suffice.
const LONGEST_SEARCH: usize = 1000;
/// Part of what a step could move a snubber by, below which it does not along a free motion.
const SLIDING: f64 = 1e-12;

/// A snubber: adds stiffness to an axis of a mount, in one sense, beyond a gap.
struct Snubber<const N: usize> {
    spring: usize,
    axis: usize,
    /// 1 if it acts along the axis, −1 against it.
    sense: f64,
    gap: f64,
    stiffness: f64,
    /// Approach, of the motion.
    row: SVector<f64, N>,
}

/// Bodies on springs and snubbers.
pub(crate) struct Snubbed<'a, const N: usize> {
    pub bodies: &'a Bodies<'a, N>,
    snubbers: Vec<Snubber<N>>,
    /// Of the springs alone.
    stiffnesses: Vec<[f64; 3]>,
}

/// Bodies in equilibrium with a load.
pub(crate) struct Equilibrium<const N: usize> {
    /// Motion from where no spring is deflected.
    pub motion: SVector<f64, N>,
    /// Bound of its rounding.
    pub rounding: SVector<f64, N>,
    /// The piece of the potential.
    pub piece: Piece<N>,
}

/// Where the same snubbers act.
#[derive(Clone)]
pub(crate) struct Piece<const N: usize> {
    /// Whether each does.
    acting: Vec<bool>,
    /// Stiffness of each spring with those of its snubbers that act.
    pub tangent: Vec<[f64; 3]>,
    pub modes: NaturalModes<N>,
}

impl<'a, const N: usize> Snubbed<'a, N> {
    pub fn new(bodies: &'a Bodies<'a, N>) -> Self {
        let mut snubbers = Vec::new();
        for (k, spring) in bodies.powertrain.all_springs().enumerate() {
            let figures = spring.mount.figures();
            if spring.is_rotation || !spring.mount.is_snubbed() {
                continue;
            }
            for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
                let stiffness = figures.snubber_stiffness[axis][side];
                if stiffness > 0.0 {
                    let sense = if side == 0 { -1.0 } else { 1.0 };
                    let row = bodies.deflections[k].row(axis).transpose() * sense;
                    let gap = figures.gap[axis][side];
                    snubbers.push(Snubber { spring: k, axis, sense, gap, stiffness, row });
                }
            }
        }
        Self { bodies, snubbers, stiffnesses: bodies.static_stiffnesses() }
    }

    /// Which snubbers act, of how far each is beyond its gap; of two of an axis without play the stiffer one.
    fn acting(&self, beyond: impl Fn(&Snubber<N>) -> bool) -> Vec<bool> {
        let mut acting: Vec<bool> = self.snubbers.iter().map(beyond).collect();
        for k in 1..acting.len() {
            let [one, other] = [&self.snubbers[k - 1], &self.snubbers[k]];
            let is_one_axis = (one.spring, one.axis) == (other.spring, other.axis);
            if is_one_axis && acting[k - 1] && acting[k] {
                let softer = if one.stiffness < other.stiffness { k - 1 } else { k };
                acting[softer] = false;
            }
        }
        acting
    }

    /// The piece of the potential around a motion.
    fn piece(&self, acting: Vec<bool>) -> Piece<N> {
        let mut tangent = self.stiffnesses.clone();
        for (snubber, _) in self.snubbers.iter().zip(&acting).filter(|(_, acts)| **acts) {
            tangent[snubber.spring][snubber.axis] += snubber.stiffness;
        }
        let modes = natural(self.bodies, &tangent);
        Piece { acting, tangent, modes }
    }

    /// The piece where nothing is loaded.
    pub fn unloaded(&self) -> Equilibrium<N> {
        let piece = self.piece(self.acting(|snubber| snubber.gap == 0.0));
        Equilibrium { motion: SVector::zeros(), rounding: SVector::zeros(), piece }
    }

    /// Equilibrium with a load, of another one; an error where a motion is free.
    pub fn under(&self, load: &SVector<f64, N>, from: &Equilibrium<N>) -> Result<Equilibrium<N>> {
        let (mut at, mut piece) = (from.motion, from.piece.clone());
        for _ in 0..LONGEST_SEARCH {
            let residual = load - self.reaction(&at);
            let (step, is_free);
            if piece.modes.free == 0 {
                let from_gaps = self
                    .of_acting(&piece.acting)
                    .map(|snubber| snubber.row * (snubber.stiffness * snubber.gap));
                let balanced = from_gaps.fold(*load, |sum, part| sum + part);
                let (motion, rounding) = piece.modes.flexed(self.bodies, &balanced);
                (step, is_free) = (motion - at, false);
                // Whatever is within rounding of its gap may count as acting, or not.
                let agrees = |(snubber, acts): (&Snubber<N>, &bool)| {
                    let bound = snubber.bound(&motion, &rounding);
                    let beyond = snubber.row.dot(&motion) - snubber.gap;
                    if *acts { beyond >= -bound } else { beyond <= bound }
                };
                let ends = self.snubbers.iter().zip(&piece.acting).all(agrees)
                    || step.dot(&residual) <= 0.0;
                if ends {
                    let acting = self.acting(|snubber| {
                        let bound = snubber.bound(&motion, &rounding);
                        snubber.row.dot(&motion) - snubber.gap >= -bound
                    });
                    let piece = if acting == piece.acting { piece } else { self.piece(acting) };
                    return Ok(Equilibrium { motion, rounding, piece });
                }
            } else {
                (step, is_free) = piece.modes.falling(self.bodies, load, &residual);
            }
            let Some(length) = self.fall(&at, &step, &residual, is_free) else {
                break;
            };
            at += step * length;
            let acting = self.acting(|snubber| snubber.row.dot(&at) >= snubber.gap);
            if acting != piece.acting {
                piece = self.piece(acting);
            }
        }
        self.bodies.require_support(&piece.modes)?;
        let hint = "rest nowhere within the steps allowed; please report the figures";
        Err(Error::value("mounts", self.bodies.powertrain.all_names().join(", "), hint))
    }

    fn of_acting<'b>(&'b self, acting: &'b [bool]) -> impl Iterator<Item = &'b Snubber<N>> {
        self.snubbers.iter().zip(acting).filter(|(_, acts)| **acts).map(|(snubber, _)| snubber)
    }

    /// Force on the bodies' coordinates that springs and snubbers resist a motion with.
    fn reaction(&self, motion: &SVector<f64, N>) -> SVector<f64, N> {
        let mut sum = SVector::zeros();
        for (rows, along) in self.bodies.deflections.iter().zip(&self.stiffnesses) {
            let deflection = rows * motion;
            for (axis, stiffness) in along.iter().enumerate() {
                sum += rows.row(axis).transpose() * (deflection[axis] * stiffness);
            }
        }
        for snubber in &self.snubbers {
            sum += snubber.row * snubber.force(motion);
        }
        sum
    }

    /// Length of a step at which the potential is least along it; none where it falls for ever.
    fn fall(
        &self,
        at: &SVector<f64, N>,
        step: &SVector<f64, N>,
        residual: &SVector<f64, N>,
        is_free: bool,
    ) -> Option<f64> {
        let mut slope = -step.dot(residual);
        let mut curvature = 0.0;
        if !is_free {
            for (rows, along) in self.bodies.deflections.iter().zip(&self.stiffnesses) {
                let moved = rows * step;
                curvature +=
                    moved.iter().zip(along).map(|(moved, k)| k * moved * moved).sum::<f64>();
            }
        }
        let mut crossings = Vec::new();
        for snubber in &self.snubbers {
            let (beyond, rate) = (snubber.row.dot(at) - snubber.gap, snubber.row.dot(step));
            let most = snubber.row.abs().dot(&step.abs());
            if is_free && rate.abs() <= SLIDING * most {
                continue;
            }
            let stiffness = snubber.stiffness * rate * rate;
            let acts = beyond > 0.0 || (beyond == 0.0 && rate > 0.0);
            if acts {
                curvature += stiffness;
            }
            let crossing = -beyond / rate;
            if crossing > 0.0 {
                crossings.push((crossing, if acts { -stiffness } else { stiffness }));
            }
        }
        crossings.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let mut length = 0.0;
        for (crossing, change) in crossings {
            let then = slope + curvature * (crossing - length);
            if then >= 0.0 {
                break;
            }
            (slope, length, curvature) = (then, crossing, curvature + change);
        }
        let least = length - slope / curvature;
        (curvature > 0.0 && least.is_finite()).then_some(least)
    }

    /// Force of each spring along its axes, with that of its snubbers, and a bound of its rounding.
    pub fn forces(&self, of: &Equilibrium<N>) -> Vec<[Vector3<f64>; 2]> {
        let moved = of.rounding + of.motion.abs() * (N as f64 * f64::EPSILON);
        let springs = self.bodies.deflections.iter().zip(&of.piece.tangent);
        let mut forces: Vec<[Vector3<f64>; 2]> = springs
            .zip(&self.stiffnesses)
            .map(|((rows, tangent), along)| {
                let (deflection, bound) = (rows * of.motion, rows.abs() * moved);
                let [along, tangent] = [along, tangent].map(|of| Vector3::from(*of));
                [deflection.component_mul(&along), bound.component_mul(&tangent)]
            })
            .collect();
        for snubber in &self.snubbers {
            forces[snubber.spring][0][snubber.axis] += snubber.sense * snubber.force(&of.motion);
        }
        forces
    }

    /// Force of the snubbers of each spring along its axes; zero of those that rounding alone parts from their gap.
    pub fn snubber_forces(&self, of: &Equilibrium<N>) -> Vec<[f64; 3]> {
        let mut forces = vec![[0.0; 3]; self.stiffnesses.len()]; // bounded: 1000 mounts
        for snubber in &self.snubbers {
            let bound = snubber.stiffness * snubber.bound(&of.motion, &of.rounding);
            let force = snubber.force(&of.motion);
            if force > bound {
                forces[snubber.spring][snubber.axis] += snubber.sense * force;
            }
        }
        forces
    }

    /// Stiffness that snubbers against and along each axis of each spring add where they act.
    pub fn contacts(&self, of: &Equilibrium<N>) -> Vec<[[f64; 2]; 3]> {
        let mut contacts = vec![[[0.0; 2]; 3]; self.stiffnesses.len()]; // bounded: 1000 mounts
        for snubber in self.of_acting(&of.piece.acting) {
            let side = usize::from(snubber.sense > 0.0);
            contacts[snubber.spring][snubber.axis][side] = snubber.stiffness;
        }
        contacts
    }
}

impl<const N: usize> Piece<N> {
    /// Whether the same snubbers act.
    pub fn is(&self, other: &Self) -> bool {
        self.acting == other.acting
    }
}

impl<const N: usize> Snubber<N> {
    /// Force against the motion.
    fn force(&self, motion: &SVector<f64, N>) -> f64 {
        self.stiffness * (self.row.dot(motion) - self.gap).max(0.0)
    }

    /// What rounding makes of how far it is beyond its gap.
    fn bound(&self, motion: &SVector<f64, N>, rounding: &SVector<f64, N>) -> f64 {
        let moved = rounding + motion.abs() * (N as f64 * f64::EPSILON);
        self.row.abs().dot(&moved) + f64::EPSILON * self.gap
    }
}

impl<const N: usize> NaturalModes<N> {
    /// A step along which the potential falls: along what is free as far as forces push it, which is true then, else
    /// to where the others are in equilibrium.
    fn falling(
        &self,
        bodies: &Bodies<N>,
        load: &SVector<f64, N>,
        residual: &SVector<f64, N>,
    ) -> (SVector<f64, N>, bool) {
        let along = self.shapes.tr_mul(residual);
        let sizes = [load, residual].map(|of| self.shapes.abs().tr_mul(&of.abs()).norm());
        let roundings = ROUNDINGS * bodies.deflections.len() as f64 * f64::EPSILON;
        let is_pushed = along.rows(0, self.free).norm() > roundings * sizes[0].max(sizes[1]);
        let part = SVector::from_fn(|k, _| match (k < self.free, is_pushed) {
            (true, true) => along[k],
            (false, false) => along[k] / (self.omega[k] * self.omega[k]),
            _ => 0.0,
        });
        (self.shapes * part, is_pushed)
    }
}
