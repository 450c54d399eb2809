//! The same powertrain at the same speeds and orders under other loads: those of actuators too.

use crate::mounts::ComplexVector6;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};

use super::{Response, TAU};

impl Response {
    /// Response to loads about the CG, force and moment, at each speed and order, in place of the engine's.
    pub fn under(&self, loads: Vec<ComplexVector6>, cancel: &Cancel) -> Result<Self> {
        if loads.len() != self.loads.len() {
            let hint = format!("give one for each speed and order: {}", self.loads.len());
            return Err(Error::value("loads", format!("{} loads", loads.len()), hint));
        }
        if let Some(wrong) = loads.iter().flatten().find(|part| !part.is_finite()) {
            return Err(Error::value("loads", wrong.to_string(), "give finite numbers"));
        }
        let rpm: Vec<f64> = self.omega.iter().map(|omega| omega * 60.0 / TAU).collect();
        let mut driven = Self { loads, ..self.clone() };
        driven.solve(&rpm, cancel)?;
        Ok(driven)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::Complex64;
    use crate::engine::{Engine, Station};
    use crate::mechanism::slider_crank::Cylinder;
    use crate::mounts::tests::random;
    use crate::numbers::angle::Angle;
    use crate::numbers::draws;
    use crate::readings::balance::Orders;

    #[test]
    fn motions_are_superposed() {
        let (mut number, cancel) = (draws(5), Cancel::new());
        let [tdc, bank] = [0.0, 90.0].map(|degrees| Angle::from_degrees(degrees).unwrap());
        let cylinder = Cylinder::new(0.05, 0.15, 0.6, 0.01).unwrap();
        let single = Station { cylinder, tdc, bank, z: 0.1, rotating_mass: 0.3 };
        let engine = Engine::new("", "", vec![single]).unwrap();
        let orders = Orders::whole(&[1, 2]).unwrap();
        for _ in 0..10 {
            let on_mounts = Arc::new(random(&mut number, true));
            let own =
                Response::new(&engine, on_mounts, &[900.0, 3000.0], &orders, &cancel).unwrap();
            let more: Vec<ComplexVector6> = (0..4)
                .map(|_| ComplexVector6::from_fn(|_, _| Complex64::new(number(), number()) * 1e3))
                .collect();
            let alone = own.under(more.clone(), &cancel).unwrap();
            let both = own.loads().iter().zip(&more).map(|(a, b)| a + b).collect();
            let both = own.under(both, &cancel).unwrap();
            for k in 0..4 {
                let sum = own.motions()[k] + alone.motions()[k];
                // Some ten roundings of a well-conditioned solution.
                assert!((both.motions()[k] - sum).norm() <= 1e-12 * sum.norm());
            }
            assert!(own.under(more[1..].to_vec(), &cancel).is_err());
            let mut wrong = more;
            wrong[2][3].im = f64::NAN;
            let error = own.under(wrong, &cancel).unwrap_err().to_string();
            assert!(error.starts_with("loads = "), "{error}");
        }
    }
}
