//! Readings of the list of loads: balances, waveforms, bearing loads, sweeps, tolerances and exact
//! answers.

pub(crate) mod amplitude;
pub mod balance;
pub mod bearing_loads;
mod choice;
pub mod drawing;
pub mod exact;
pub mod explain;
pub mod figures;
pub mod flywheel;
pub mod measured_parts;
pub mod mount_designs;
pub mod mount_objectives;
pub mod mounted;
pub mod page;
pub mod peaks;
pub mod quantity;
pub mod rows;
pub mod sweep;
pub mod terms;
pub mod tolerances;
pub mod turning;
pub mod waveform;
