//! Harmonics of one slider-crank: every order exact, for any rod ratio below 1 and any offset.
//!
//! The inertia force of a piston is `m r ω² Re Σ aₙ e^{in(θ − tdc)}`; this module computes `aₙ` and
//! the harmonics of the torques. With A = (l + e)/r and B = (l − e)/r the height of the rod,
//! √((A − sin θ)(B + sin θ)), factors into
//! `√((1 + p₁w)(1 − p₂w)) · √((1 + p₁/w)(1 − p₂/w)) / (2√(p₁p₂))` with w = i e^{iθ},
//! p₁ = A − √(A² − 1) and p₂ = B − √(B² − 1). The first root is a power series Σ hₖwᵏ with a
//! two-term recurrence, and the coefficient of e^{inθ} is `iⁿ Σⱼ h_{j+n} hⱼ / (2√(p₁p₂))`: sums of
//! terms of one sign after the first, so that every order keeps its *relative* accuracy, where a
//! transform of samples loses high orders to the rounding of the low ones. Near λ = 1 the series
//! grows too long; what replaces it, and from where, is in `near_one`.
//!
//! Imports run downwards: `roots` → `near_one` → `centred`, `offset` → [`force`] → `fractions`,
//! [`rod`], [`torque`] → [`table`].

mod centred;
pub mod force;
mod fractions;
mod near_one;
mod offset;
pub mod rod;
mod roots;
pub mod table;
pub mod torque;

pub use force::{coefficients, tail_bound};
