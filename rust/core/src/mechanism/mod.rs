//! One cylinder: its moving parts, their motion, and the harmonics of the forces and torques of
//! their inertia.
//!
//! A piston moves as its [`Mechanism`] says, of which a [`Cylinder`] has one. Imports run downwards: [`motion`],
//! [`cylinder`], [`exact`] → `Mechanism` → [`articulated`], [`slider_crank`] → [`rod`], [`harmonics`], [`spectrum`].

pub mod articulated;
pub mod cylinder;
pub mod exact;
pub mod harmonics;
pub mod motion;
pub mod rod;
mod scotch_yoke;
pub mod slider_crank;
pub mod spectrum;
#[cfg(test)]
mod tests;

use std::any::Any;
use std::fmt::Debug;
use std::ptr;
use std::sync::Arc;

use self::cylinder::{Cylinder, NEVER_LEANS};
use self::exact::{ExactHarmonic, MotionKey};
use self::harmonics::rod::TorqueHarmonics;
use self::harmonics::table;
use self::motion::{CrankPosition, Cranks, Motion, MotionColumns, Swing};
use self::scotch_yoke::ScotchYoke;
use self::slider_crank::SliderCrank;
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;

/// How a piston and its rod move as their crank turns, in crank radii and per crank angle.
///
/// Whatever asks a motion asks this, and none asks which one it is. Orders are multiples of the speed of its own
/// crank, θ is zero where the crankpin points along the bore, and amplitudes are peak phasors.
pub trait Mechanism: Debug + Send + Sync + Any {
    /// Whether another is the same.
    fn equals(&self, other: &dyn Mechanism) -> bool;

    /// Motion of the piston where the crank stands so.
    fn motion(&self, crank: &CrankPosition) -> Motion;

    /// How the rod turns there.
    fn swing(&self, crank: &CrankPosition) -> Swing;

    /// Motion of the piston at some positions.
    fn motions(&self, cranks: &Cranks, into: MotionColumns) {
        into.fill_one_by_one(cranks, &|crank| self.motion(crank));
    }

    /// Whether motion half a turn on costs next to nothing beside that at a position.
    fn has_cheap_opposites(&self) -> bool {
        false
    }

    /// Velocity and acceleration of the rod's angle at some positions.
    fn swings(&self, cranks: &Cranks, into: [&mut [f64]; 2]) {
        let [velocities, accelerations] = into;
        for i in 0..cranks.len() {
            let Swing { velocity, acceleration } = self.swing(&cranks.at(i));
            (velocities[i], accelerations[i]) = (velocity, acceleration);
        }
    }

    /// Distance of a crank angle from the nearest singularity of the motion in the complex plane, radians, or less.
    fn to_singularity(&self, theta: f64) -> f64;

    /// Amplitudes of the force along the bore over m·r·ω².
    fn force(&self, orders: &[u32], cancel: &Cancel) -> Result<Vec<Complex64>>;

    /// Bound of the sum of their sizes at orders above one; none where it overflows.
    fn force_beyond(&self, highest: u32) -> Option<f64>;

    /// Amplitudes of the torques of that force over m·r²·ω².
    fn torque(&self, orders: &[u32], cancel: &Cancel) -> Result<TorqueHarmonics>;

    /// Bound of what either adds above an order.
    fn torque_beyond(&self, highest: u32) -> Option<f64>;

    /// Amplitudes of the torques of a rod's inertia beyond that of two masses, over it and ω².
    fn swing_torque(&self, orders: &[u32], cancel: &Cancel) -> Result<TorqueHarmonics>;

    /// Bound of what either adds above an order.
    fn swing_torque_beyond(&self, highest: u32) -> Option<f64>;

    /// Distance of the piston's line from the axis of the crank, over the crank radius: on the side to which the
    /// crankpin swings after θ = 0.
    fn offset(&self) -> f64 {
        0.0
    }

    /// Crank radius over rod length.
    fn rod_ratio(&self) -> f64;

    /// The lengths that it was made of.
    fn lengths(&self) -> &Cylinder;

    /// Whether rod ratio and pin offset make another of it.
    fn has_proportions(&self) -> bool {
        true
    }

    /// The same with rod ratio, and pin offset (m), replaced.
    fn with_proportions(
        &self,
        rod_ratio: Option<f64>,
        pin_offset: Option<f64>,
    ) -> Result<Arc<dyn Mechanism>> {
        self.lengths().mechanism_with(rod_ratio, pin_offset)
    }

    /// Amplitudes at many rod ratios (rows) and some orders, where they are evaluated side by side: real ones of the
    /// force, or imaginary ones of the torque on the block, of which that on the crank is the negative.
    fn at_rod_ratios(
        &self,
        of: HarmonicsOf,
        rod_ratios: &[f64],
        orders: &[u32],
        cancel: &Cancel,
    ) -> Result<Option<Vec<f64>>> {
        if self.offset() != 0.0 || of == HarmonicsOf::SwingTorque {
            return Ok(None);
        }
        let mut values = memory::zeros(rod_ratios.len() * orders.len())?;
        if of == HarmonicsOf::Force {
            table::write_centred(rod_ratios, orders, None, &mut values, cancel)?;
        } else {
            table::write_centred_roll(rod_ratios, orders, &mut values, cancel)?;
        }
        Ok(Some(values))
    }

    /// Whether every order grows with the rod ratio from 0 to its own.
    fn grows_with_rod_ratio(&self, of: HarmonicsOf) -> bool {
        let _ = of;
        false
    }

    /// Crank angles at which the piston is highest and lowest, degrees.
    fn turning_points_deg(&self) -> [f64; 2] {
        self.lengths().turning_points_deg()
    }

    /// Distance between the ends of the piston's travel, m.
    fn travel(&self) -> f64 {
        self.lengths().travel()
    }

    /// The figures on which it depends.
    fn key(&self) -> MotionKey;

    /// What is known of an order of the force.
    fn exact_force(&self, order: u32) -> ExactHarmonic;

    /// What is known of an order of the torques.
    fn exact_torque(&self, order: u32) -> ExactHarmonic;

    /// The ratio of successive orders, high ones, is at most this.
    fn decay(&self) -> f64;
}

impl PartialEq for dyn Mechanism {
    fn eq(&self, other: &Self) -> bool {
        ptr::addr_eq(self, other) || self.equals(other)
    }
}

/// Whether another mechanism is of the same kind, and equal.
fn is_equal<M: Mechanism + PartialEq>(mechanism: &M, other: &dyn Mechanism) -> bool {
    (other as &dyn Any).downcast_ref::<M>().is_some_and(|other| mechanism == other)
}

/// Amplitudes of a mechanism.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HarmonicsOf {
    /// Those of [`Mechanism::force`].
    Force,
    /// Those of [`Mechanism::torque`].
    Torque,
    /// Those of [`Mechanism::swing_torque`].
    SwingTorque,
}

impl Cylinder {
    /// How its piston moves.
    #[must_use]
    pub fn mechanism(&self) -> Arc<dyn Mechanism> {
        if self.has_infinite_rod() {
            return Arc::new(ScotchYoke::new(self));
        }
        Arc::new(SliderCrank::new(self))
    }

    /// The same with the ratio of crank radius to rod length, and pin offset (m), replaced.
    pub fn mechanism_with(
        &self,
        rod_ratio: Option<f64>,
        pin_offset: Option<f64>,
    ) -> Result<Arc<dyn Mechanism>> {
        let (radius, offset) = (self.crank_radius(), pin_offset.unwrap_or(self.pin_offset()));
        let Some(ratio) = rod_ratio else {
            return Ok(Self::new(radius, self.rod_length(), 0.0, offset)?.mechanism());
        };
        if ratio != 0.0 {
            return Ok(Arc::new(SliderCrank::with_ratios(self, ratio, offset / radius)?));
        }
        if offset != 0.0 {
            return Err(Error::figure("pin_offset_ratio", offset / radius, NEVER_LEANS));
        }
        Ok(Arc::new(ScotchYoke::new(self)))
    }
}

/// How a piston moves whose crank radius is 1, with this ratio of it to the rod's length and this offset.
pub fn with_ratios(rod_ratio: f64, offset: f64) -> Result<Arc<dyn Mechanism>> {
    Cylinder::new(1.0, f64::INFINITY, 0.0, 0.0)?.mechanism_with(Some(rod_ratio), Some(offset))
}

/// A mechanism on a crank of some speed.
#[derive(Debug, Clone)]
pub struct DrivenMechanism {
    /// What moves.
    pub mechanism: Arc<dyn Mechanism>,
    /// Speed of its crank.
    pub ratio: SpeedRatio,
}

impl PartialEq for DrivenMechanism {
    fn eq(&self, other: &Self) -> bool {
        self.ratio == other.ratio && *self.mechanism == *other.mechanism
    }
}

impl DrivenMechanism {
    /// With rod ratio and pin offset (m) replaced.
    pub(crate) fn replaced(&self, rod_ratio: Option<f64>, pin_offset: Option<f64>) -> Result<Self> {
        let mechanism = self.mechanism.with_proportions(rod_ratio, pin_offset)?;
        Ok(Self { mechanism, ratio: self.ratio })
    }

    /// Factors of the torques on the block and on the main crank: turning the other way mirrors the
    /// torque on the block, and power is torque times speed.
    pub(crate) fn senses(&self) -> [f64; 2] {
        [f64::from(self.ratio.sense()), self.ratio.size()]
    }

    /// The highest multiple of the speed of its own crank that is not above a number of halves of the main crank's.
    pub(crate) fn own_highest(&self, halves: u32) -> u32 {
        halves / self.ratio.halves_of_speed()
    }
}

/// Values at the multiples of a crank's own speed among some orders of the main crank, zero at the others.
pub(crate) fn at_own_orders(
    ratio: SpeedRatio,
    orders: &[Order],
    of: impl FnOnce(&[u32]) -> Result<Vec<Complex64>>,
) -> Result<Vec<Complex64>> {
    let speed = ratio.halves_of_speed();
    let own = |order: &Order| Some(order.halves()).filter(|n| n % speed == 0).map(|n| n / speed);
    let whole: Vec<u32> = orders.iter().filter_map(own).collect();
    let mut values = of(&whole)?.into_iter();
    let value = |order: &Order| own(order).and_then(|_| values.next()).unwrap_or_default();
    Ok(orders.iter().map(value).collect())
}
