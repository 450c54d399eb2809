//! How a reciprocating engine shakes, and which engine does not.
//!
//! A file is one idea, and imports run one way:
//! [`error`], [`limits`], [`cancel`], [`memory`], [`pool`], [`double`], [`angle`], [`crank_angles`], [`rational`],
//! [`cyclotomic`] → [`slider_crank`], [`rod`], [`harmonics`] (one cylinder) → [`engine`] (where the
//! cylinders sit), [`layout`] (engines from a few figures), [`engine_file`] (TOML and JSON) → [`firing`], and
//! [`balance`] (phasor sums), [`waveform`], [`sweep`]; [`extrema`] finds the peak of a sum of orders
//! for these three; [`search`] goes through every arrangement; [`vanishing`] proves which orders are
//! zero, [`closed_form`] writes out the others.
//!
//! Conventions: SI units; x to the right, y up and z from the front to the flywheel, seen from the
//! flywheel, where the crank turns counter-clockwise; a quantity of order n is `Re(P·e^{inθ})`
//! with `P` its peak phasor.

#![forbid(unsafe_code)]

pub mod angle;
pub mod balance;
pub mod cancel;
pub mod closed_form;
pub mod crank_angles;
pub mod cyclotomic;
pub mod double;
pub mod engine;
pub mod engine_file;
pub mod error;
pub mod extrema;
pub mod firing;
pub mod harmonics;
mod kinematics;
pub mod layout;
pub mod limits;
pub mod memory;
pub mod pool;
pub mod rational;
pub mod rod;
pub mod search;
mod simd;
pub mod slider_crank;
pub mod spectrum;
pub mod sweep;
pub mod vanishing;
pub mod waveform;

pub use angle::Angle;
pub use balance::{Asked, Balance, Orders};
pub use cancel::Cancel;
pub use crank_angles::CrankAngles;
pub use engine::{Engine, Hold, Placement};
pub use error::{Error, Result};
pub use firing::Firing;
pub use slider_crank::Cylinder;
pub use spectrum::Spectrum;
pub use sweep::Sweep;
pub use waveform::Waveform;

/// Complex numbers as nalgebra, ndarray and `NumPy` share them.
pub type Complex64 = nalgebra::Complex<f64>;
