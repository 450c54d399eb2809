//! Readings of the list of loads: balances, waveforms, sweeps, tolerances and exact answers.

pub(crate) mod amplitude;
pub mod balance;
mod choice;
pub mod exact;
mod kinematics;
pub mod peaks;
pub mod sweep;
pub mod tolerances;
pub mod waveform;
