//! What exact sums know of a motion.

use crate::numbers::rational::Ratio;

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
