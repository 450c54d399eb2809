//! Numbers, and what every computation with them needs: errors, limits, cancellation, threads, memory.

pub mod amplitudes;
pub mod angle;
pub mod cancel;
pub(crate) mod chebyshev;
pub mod crank_angles;
pub mod decimal;
pub mod double;
pub mod error;
pub mod figure;
pub(crate) mod fourier;
pub mod index;
pub(crate) mod kept;
pub mod limits;
pub mod memory;
pub mod order;
pub mod pool;
pub mod quadrature;
pub mod ratio;
pub mod rational;
pub mod ring;
pub(crate) mod simd;
pub(crate) mod singular_values;
pub mod typed;
pub mod units;

/// Crank speed at which ω is 1 rad/s.
pub const UNIT_RPM: f64 = 30.0 / std::f64::consts::PI;

/// True for what a file may leave out.
pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Numbers between -1 and 1 that repeat after 2^31 (a linear congruential generator).
#[cfg(test)]
pub(crate) fn draws(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = (seed * 1_103_515_245 + 12_345) % (1 << 31);
        seed as f64 / f64::from(1 << 30) - 1.0
    }
}
