//! Numbers, and what every computation with them needs: errors, limits, cancellation, threads, memory.

pub mod angle;
pub mod cancel;
pub mod crank_angles;
pub mod decimal;
pub mod double;
pub mod error;
pub mod limits;
pub mod memory;
pub mod order;
pub mod pool;
pub mod quadrature;
pub mod rational;
pub mod ring;
pub(crate) mod simd;
