//! The same powertrain at the same speeds and orders under forces of actuators too.

use std::sync::Arc;

use crate::Complex64;
use crate::engine::Engine;
use crate::mounts::{ComplexVector6, Powertrain, motion_of_point};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::readings::balance::Orders;

use super::Response;

/// Forces of actuators on a powertrain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActuatorForces<'a> {
    /// Place, m, and direction of each.
    pub actuators: &'a [[[f64; 3]; 2]],
    /// Their peak phasors, N, at each speed and order: a row each.
    pub forces: &'a [Complex64],
    /// Whether the engine's loads act too.
    pub engine_runs: bool,
}

impl Response {
    /// Motion at each speed, rpm, in each order of the engine's balance, under forces of actuators too.
    pub fn driven<'a>(
        engine: impl Into<Option<&'a Engine>>,
        powertrain: Arc<Powertrain>,
        rpm: &[f64],
        orders: &Orders,
        drive: &ActuatorForces,
        cancel: &Cancel,
    ) -> Result<Self> {
        let mut response = Self::at_rest(engine.into(), powertrain, rpm, orders, cancel)?;
        let (points, count) = (response.loads.len(), drive.actuators.len());
        let found = drive.forces.len();
        limits::same_length("forces", found, "the actuators", points * count, "speed and order")?;
        if let Some(wrong) = drive.forces.iter().find(|force| !force.is_finite()) {
            return Err(Error::value("forces", wrong.to_string(), "give finite numbers"));
        }
        let cg = response.powertrain.body().cg();
        let unit = |[at, direction]: &[[f64; 3]; 2]| -> ComplexVector6 {
            let moved = motion_of_point(&(nalgebra::Vector3::from(*at) - cg));
            // The power of a force is that of its load.
            (moved.transpose() * nalgebra::Vector3::from(*direction)).map(Complex64::from)
        };
        let units: Vec<ComplexVector6> = drive.actuators.iter().map(unit).collect();
        for (point, load) in response.loads.iter_mut().enumerate() {
            if !drive.engine_runs {
                *load = ComplexVector6::zeros();
            }
            for (unit, &force) in units.iter().zip(&drive.forces[point * count..]) {
                *load += unit * force;
            }
        }
        response.solve(rpm, cancel)?;
        Ok(response)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Station;
    use crate::mechanism::cylinder::Cylinder;
    use crate::mounts::tests::random;
    use crate::numbers::angle::Angle;
    use crate::numbers::draws;

    #[test]
    fn motions_are_superposed() {
        let (mut number, cancel) = (draws(5), Cancel::new());
        let [tdc, bank] = [0.0, 90.0].map(|degrees| Angle::from_degrees(degrees).unwrap());
        let cylinder = Cylinder::new(0.05, 0.15, 0.6, 0.01).unwrap();
        let single = Station { cylinder, tdc, bank, z: 0.1, rotating_mass: 0.3 };
        let engine = Engine::new("", "", vec![single]).unwrap();
        let orders = Orders::whole(&[1, 2]).unwrap();
        let rpm = [900.0, 3000.0];
        for _ in 0..10 {
            let on_mounts = Arc::new(random(&mut number, true));
            let own =
                Response::new(&engine, Arc::clone(&on_mounts), &rpm, &orders, &cancel).unwrap();
            let mut place = || [0; 3].map(|_| number());
            let actuators = [[place(), place()], [place(), place()]];
            let forces: Vec<Complex64> =
                (0..8).map(|_| Complex64::new(number(), number()) * 1e3).collect();
            let driven = |forces: &[Complex64], engine_runs| {
                let drive = ActuatorForces { actuators: &actuators, forces, engine_runs };
                let on_mounts = Arc::clone(&on_mounts);
                Response::driven(&engine, on_mounts, &rpm, &orders, &drive, &cancel)
            };
            let [alone, both] = [false, true].map(|runs| driven(&forces, runs).unwrap());
            let speeds = own.omega.iter().flat_map(|omega| [*omega, 2.0 * omega]);
            for (k, omega) in speeds.enumerate() {
                let sum = own.motions()[k] + alone.motions()[k];
                // Some ten roundings of a well-conditioned solution.
                assert!((both.motions()[k] - sum).norm() <= 1e-12 * sum.norm());
                // What the actuators put in is what the load about the CG does.
                let velocity = alone.motions()[k] * Complex64::new(0.0, omega);
                let mut power = Complex64::ZERO;
                for ([at, direction], force) in actuators.iter().zip(&forces[2 * k..]) {
                    let moved = on_mounts.motion_of(*at, &velocity);
                    let along: Complex64 = moved.iter().zip(direction).map(|(v, d)| v * d).sum();
                    power += force * along.conj();
                }
                let of_load = velocity.dotc(&alone.loads()[k]);
                assert!((power - of_load).norm() <= 1e-12 * power.norm(), "{power} {of_load}");
            }
            assert!(driven(&forces[1..], true).is_err());
            let mut wrong = forces.clone();
            wrong[2].im = f64::NAN;
            let error = driven(&wrong, true).unwrap_err().to_string();
            assert!(error.starts_with("forces = "), "{error}");
        }
    }
}
