//! One cylinder: its moving parts, their motion, and the harmonics of the forces and torques of
//! their inertia.
//!
//! Imports run downwards: [`slider_crank`] → [`rod`] → [`harmonics`], [`spectrum`] → `Mechanism`.

pub mod harmonics;
pub mod rod;
pub mod slider_crank;
pub mod spectrum;

use self::slider_crank::{Cylinder, Proportions};
use crate::Complex64;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;

/// How a piston moves: a slider-crank whose crank turns at some speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mechanism {
    /// Its lengths; what moves has no mass here.
    cylinder: Cylinder,
    /// Proportions of its motion: its own, or those of a point of a sweep.
    pub proportions: Proportions,
    /// Speed of its crank.
    pub ratio: SpeedRatio,
}

impl Mechanism {
    /// Of a cylinder on a crank of this speed.
    pub(crate) fn new(cylinder: &Cylinder, ratio: SpeedRatio) -> Self {
        let cylinder = cylinder.without_masses();
        Self { cylinder, proportions: cylinder.proportions(), ratio }
    }

    /// Its lengths.
    pub(crate) fn cylinder(&self) -> &Cylinder {
        &self.cylinder
    }

    /// Whether it has no pin offset.
    pub(crate) fn is_centred(&self) -> bool {
        self.proportions.offset == 0.0
    }

    /// With rod ratio and pin offset (m) replaced.
    pub(crate) fn replaced(&self, rod_ratio: Option<f64>, pin_offset: Option<f64>) -> Result<Self> {
        Ok(Self { proportions: self.cylinder.proportions_with(rod_ratio, pin_offset)?, ..*self })
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
