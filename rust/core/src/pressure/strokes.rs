//! Strokes of a cycle.

use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};

/// Number of strokes that make a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strokes {
    /// A cycle in each turn of the crank.
    Two,
    /// A cycle in two turns.
    Four,
}

impl Strokes {
    /// 2 or 4.
    pub fn from_number(strokes: u32) -> Result<Self> {
        match strokes {
            2 => Ok(Self::Two),
            4 => Ok(Self::Four),
            _ => Err(Error::value(
                "strokes",
                strokes,
                "give 4 for a four-stroke or 2 for a two-stroke",
            )),
        }
    }

    /// 2 or 4.
    #[must_use]
    pub fn number(self) -> u32 {
        match self {
            Self::Two => 2,
            Self::Four => 4,
        }
    }

    /// Turns of the crank in a cycle.
    #[must_use]
    pub fn turns(self) -> i64 {
        i64::from(self.number() / 2)
    }

    /// Crank angle of a cycle.
    #[must_use]
    pub fn cycle(self) -> Angle {
        Angle::whole_turns(self.turns() as i32)
    }
}
