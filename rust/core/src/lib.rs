//! How a reciprocating engine shakes, and which engine does not.
//!
//! A file is one idea, and imports run one way:
//! - numbers: [`error`], [`limits`], [`cancel`], [`memory`],
//!   [`pool`], [`double`], [`angle`], [`order`], [`crank_angles`],
//!   [`rational`], [`ring`] (sums of roots of unity);
//! - [`cylinder`]: one cylinder's running gear and its harmonics;
//! - [`engine`]: running gears, banks and shafts in their places, layouts, files;
//! - [`wrench`] and `load`: every load of an engine in one list, superposed order by order;
//! - readings of that list: [`balance`] (few or given orders), [`waveform`], [`sweep`],
//!   [`tolerances`] (of samples of an engine), and [`exact`] (which orders vanish, closed forms);
//!   [`extrema`] finds peaks of sums of orders;
//! - [`firing`] and [`search`].
//!
//! Conventions: SI units; x to the right, y up and z from the front to the flywheel, seen from the
//! flywheel, where the crank turns counter-clockwise; a quantity of order n is `Re(P·e^{inθ})`
//! with `P` its peak phasor.

#![forbid(unsafe_code)]

mod amplitude;
pub mod angle;
pub mod balance;
pub mod cancel;
mod choice;
pub mod crank_angles;
pub mod cylinder;
pub mod double;
pub mod engine;
pub mod error;
pub mod exact;
pub mod extrema;
pub mod firing;
mod kinematics;
pub mod limits;
mod load;
pub mod memory;
pub mod order;
pub mod pool;
pub mod rational;
pub mod ring;
pub mod search;
mod simd;
pub mod sweep;
pub mod tolerances;
pub mod waveform;
pub mod wrench;

pub use angle::Angle;
pub use balance::{Balance, Orders, Request};
pub use cancel::Cancel;
pub use crank_angles::CrankAngles;
pub use cylinder::{harmonics, rod, slider_crank, spectrum};
pub use engine::{Engine, Hold, Placement, Shaft, Unbalance, layout};
pub use error::{Error, Result};
pub use firing::Firing;
pub use order::Order;
pub use slider_crank::Cylinder;
pub use spectrum::Spectrum;
pub use sweep::Sweep;
pub use waveform::Waveform;

/// Complex numbers as ndarray and `NumPy` share them.
pub type Complex64 = num_complex::Complex64;
