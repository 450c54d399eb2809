//! One cylinder: its moving parts, their motion, and the harmonics of the forces and torques of
//! their inertia.
//!
//! Imports run downwards: [`slider_crank`] → [`rod`] → [`harmonics`]; [`spectrum`] is independent.

pub mod harmonics;
pub mod rod;
pub mod slider_crank;
pub mod spectrum;
