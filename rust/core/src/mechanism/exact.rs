//! What exact sums know of a motion.

use num_traits::CheckedDiv;

use super::Mechanism;
use super::harmonics::rod::TorqueHarmonics;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::rational::{Ratio, decimal};

/// Figures on which a motion depends: equal where they are equal as typed, though quotients of doubles differ.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MotionKey {
    /// Without the side of an offset.
    pub(crate) figures: Vec<FigureKey>,
    /// Whether it is that of the same figures seen in a mirror: its offset is on the other side.
    pub(crate) is_mirrored: bool,
}

/// A quotient of lengths.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum FigureKey {
    /// Of decimals.
    Exact(Ratio),
    /// Bits of its double.
    Nearest(u64),
}

impl FigureKey {
    /// Of two lengths as they were typed, else of the double.
    pub(super) fn quotient(length: f64, radius: f64) -> Self {
        let typed = || decimal(length)?.checked_div(&decimal(radius)?);
        typed().map_or(Self::Nearest((length / radius).to_bits()), Self::Exact)
    }
}

/// Which torque of a motion: those of equal motions and keys are multiples of one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum TorqueKey {
    /// Of masses that move with the piston.
    Masses,
    /// Of the rod's moment of inertia beyond that of its two masses.
    Swing,
}

impl TorqueKey {
    /// All of them.
    pub(crate) const ALL: [Self; 2] = [Self::Masses, Self::Swing];

    /// That torque of a motion at some orders, over its weight.
    pub(crate) fn torque(
        self,
        mechanism: &dyn Mechanism,
        orders: &[u32],
        cancel: &Cancel,
    ) -> Result<TorqueHarmonics> {
        match self {
            Self::Masses => mechanism.torque(orders, cancel),
            Self::Swing => mechanism.swing_torque(orders, cancel),
        }
    }

    /// Whether a harmonic of it is known to be other than zero.
    pub(crate) fn is_certain(self, known: ExactHarmonic) -> bool {
        self == Self::Masses && known.is_certain
    }
}

/// Parts of a harmonic, in crank radii.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExactHarmonic {
    /// Whether it has 1, which is the crank's own.
    pub crank: bool,
    /// What else it has.
    pub rest: Rest,
    /// Whether what it has is known to be other than zero.
    pub is_certain: bool,
}

impl ExactHarmonic {
    /// Whether there is any.
    pub(crate) fn exists(self) -> bool {
        self.crank || self.rest.exists()
    }
}

/// How what a harmonic has besides the crank's own changes as the motion is mirrored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rest {
    /// There is none.
    None,
    /// It is the same.
    Even,
    /// Its sign changes.
    Odd,
    /// It has a part of either kind.
    Both,
}

impl Rest {
    /// Whether there is any.
    #[must_use]
    pub fn exists(self) -> bool {
        self != Self::None
    }

    /// Whether it has a part that is the same, and one whose sign changes.
    #[must_use]
    pub fn parts(self) -> [bool; 2] {
        [Self::Even, Self::Odd].map(|part| self == part || self == Self::Both)
    }
}
