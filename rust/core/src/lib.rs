//! Shaking forces, rocking moments and torque of reciprocating engines, and searches for engines without them.
//!
//! A file is one idea, and a module imports only those above it:
//! - [`numbers`]: errors, limits, cancellation, threads, memory; angles, orders, fractions, sums of
//!   roots of unity; indices;
//! - [`wrench`]: force, moment and torque of one order;
//! - [`mechanism`]: one cylinder's running gear and its harmonics;
//! - [`pressure`]: cylinder pressure over a cycle, and the torque of it;
//! - [`mounts`]: a rigid body on elastic mounts, without an engine;
//! - [`matching`]: parts of different masses assigned to cylinders;
//! - [`source`]: what acts at a place of an engine: its own loads, and those of other crates;
//! - [`engine`]: running gears, banks, cranks and shafts in their places, layouts, files;
//! - [`firing`]: firing orders, their intervals, gas exchange;
//! - `load`: every load of an engine in one list, superposed order by order;
//! - [`readings`] of that list: balances, waveforms and their peaks, bearing loads, sweeps, tolerances,
//!   exact answers, explanations in words;
//! - [`balancing`]: counterweights and balance shafts fitted to an engine, and forces of actuators;
//! - [`design`]: objectives of angles that vary, and their derivatives;
//! - [`search`]: crank arrangements;
//! - `checking`: sources run through every reading.
//!
//! Conventions: SI units; x to the right, y up and z from the front to the flywheel, seen from the
//! flywheel, where the crank turns counter-clockwise; a quantity of order n is `Re(P·e^{inθ})`
//! with `P` its peak phasor. Indices, of cylinders from 0 and of orders in their lists, are those of slices,
//! and of other lists of an engine types of their own ([`index`]): one that is out of range panics.

#![forbid(unsafe_code)]

pub mod balancing;
mod checking;
pub mod design;
pub mod engine;
pub mod firing;
mod load;
pub mod matching;
pub mod mechanism;
pub mod mounts;
pub mod numbers;
pub mod pressure;
pub mod readings;
pub mod search;
pub mod source;
pub mod wrench;

pub use checking::Measured;
pub use checking::check_source;
pub use engine::{Crank, Engine, Hold, Shaft, Station, Unbalance, layout};
pub use firing::Firing;
pub use mechanism::cylinder::Cylinder;
pub use mechanism::spectrum::Spectrum;
pub use mechanism::{Mechanism, harmonics, motion, rod, slider_crank, spectrum};
pub use numbers::angle::Angle;
pub use numbers::cancel::Cancel;
pub use numbers::crank_angles::CrankAngles;
pub use numbers::error::{Error, Result, Warning};
pub use numbers::order::Order;
pub use numbers::ratio::SpeedRatio;
pub use numbers::{
    angle, crank_angles, double, error, index, limits, memory, order, pool, rational, ring,
};
pub use pressure::{Cycle, GasTorque};
pub use readings::balance::{Balance, Orders, Request};
pub use readings::sweep::Sweep;
pub use readings::waveform::Waveform;
pub use readings::{
    balance, bearing_loads, drawing, exact, explain, figures, flywheel, measured_parts,
    mount_designs, mount_objectives, mounted, page, peaks, quantity, rows, sweep, terms,
    tolerances, waveform,
};

/// Complex numbers as ndarray and `NumPy` share them.
pub type Complex64 = num_complex::Complex64;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
