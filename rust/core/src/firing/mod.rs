//! When the cylinders of an engine fire, and which pins a firing order needs.
//!
//! A cylinder fires when its piston is highest: at top dead centre, or with a pin offset e where
//! crank and rod are in line, asin(e/(l + r)) later. A crank determines this within a turn; in a
//! four-stroke each cylinder fires in one of two turns, which its camshaft determines. The turns are
//! counted from the first cylinder's firing, so that they do not depend on where θ is zero.
//!
//! Angles that are parts of a turn are exact, and so is what is reported as even or simultaneous;
//! others are distinguished when they differ by more than [`crate::numbers::angle::MOST_ROUNDING`].
//!
//! Imports run downwards: `highest_points` → [`schedule`] → [`choices`], [`intervals`],
//! [`gas_exchange`]; [`pins`] is independent.

pub mod choices;
pub mod gas_exchange;
mod highest_points;
pub mod intervals;
pub mod pins;
pub mod schedule;

#[cfg(test)]
mod tests;

pub use choices::MOST_CYLINDERS_LISTED;
pub use gas_exchange::{Overlap, Period, Periods, Timing};
pub use intervals::Gap;
pub use pins::{Throws, inline_throws, vee_throws};
pub use schedule::Firing;
