//! One cylinder's inertia force given by the user, order by order, in place of a slider-crank's:
//! one measurement or simulation, many layouts.

use std::collections::BTreeMap;

use crate::Complex64;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::order::Order;

/// Amplitudes in kg·m per order: the force along the bore is `ω² Re Σ Sₙ e^{in(θ − tdc)}`.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum(BTreeMap<u32, Complex64>);

impl Spectrum {
    /// From (multiple of the speed of its crank, amplitude in kg·m) pairs; orders not named are zero.
    pub fn new(terms: impl IntoIterator<Item = (u32, Complex64)>) -> Result<Self> {
        let mut spectrum = BTreeMap::new();
        for (order, amplitude) in terms {
            Order::whole(order)?;
            let argument = format!("spectrum[{order}]");
            limits::finite(&argument, amplitude.re)?;
            limits::finite(&argument, amplitude.im)?;
            spectrum.insert(order, amplitude);
        }
        if spectrum.is_empty() {
            return Err(Error::value(
                "spectrum",
                "{}",
                "give at least one order, such as {1: 9.0}",
            ));
        }
        Ok(Self(spectrum))
    }

    /// Amplitude of an order, kg·m.
    #[must_use]
    pub fn amplitude(&self, order: u32) -> Complex64 {
        self.0.get(&order).copied().unwrap_or_default()
    }

    /// The orders named, ascending.
    #[must_use]
    pub fn orders(&self) -> Vec<u32> {
        self.0.keys().copied().collect()
    }

    /// Largest amplitude of any order, kg·m.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.0.values().map(|amplitude| amplitude.norm()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_amplitude_is_the_longest() {
        let terms = [(1, Complex64::new(3.0, -4.0)), (4, Complex64::new(-4.5, 0.0))];
        assert_eq!(Spectrum::new(terms).unwrap().largest(), 5.0);
    }
}
