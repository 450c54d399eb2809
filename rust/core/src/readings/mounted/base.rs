//! The same powertrain on a base that moves: a floor, a foundation, the hull of a ship, a vehicle.
//!
//! A rigid base whose motion at the CG would be g moves the end of each spring, and loads the body by Kg, the sum of
//! the springs' forces: (K − ω²·M)·q = f + K·g, whatever is known of the engine's own loads f. Under a subframe the
//! base moves the ends of the subframe's springs.

use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::Vector3;

use super::{Derivative, EngineLoads, Response};
use crate::Complex64;
use crate::engine::Engine;
use crate::mounts::{ComplexVector6, Powertrain, Support, motion_of_point};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::readings::balance::Orders;

/// Motion of a rigid base by order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseMotion<'a> {
    /// Point of the base that moves so, m.
    pub about: [f64; 3],
    /// Whether phasors are displacements and rotations, or derivatives of these.
    pub derivative: Derivative,
    /// Peak phasors along x, y and z and about these at each order: one for all speeds, or one for each.
    pub phasors: &'a [(Order, Vec<[Complex64; 6]>)],
    /// Whether the engine's loads act too; if not, orders of speeds are frequencies alone.
    pub engine_runs: bool,
}

/// Displacement of a point of a rigid base, of its motion at another point from which it is as far as the arm.
pub(super) fn displaced(base: &ComplexVector6, arm: &Vector3<f64>) -> Vector3<Complex64> {
    motion_of_point(arm).map(Complex64::from) * base
}

/// Motion of a rigid base at a point from which the point that moves so is as far as the arm.
fn moved(base: &ComplexVector6, arm: &Vector3<f64>) -> ComplexVector6 {
    let mut motion = *base;
    motion.fixed_rows_mut::<3>(0).copy_from(&displaced(base, arm));
    motion
}

impl BaseMotion<'_> {
    fn check(&self, powertrain: &Powertrain, speeds: usize) -> Result<()> {
        if matches!(powertrain.support(), Some(Support::Receptance(_))) {
            let hint = "is known under forces, not on a base that moves: give a subframe, or leave out the support";
            return Err(Error::value("support", "a receptance", hint));
        }
        for (k, along) in self.about.into_iter().enumerate() {
            limits::finite(&format!("about[{k}]"), along)?;
        }
        for (order, rows) in self.phasors {
            if rows.len() != 1 {
                let name = format!("motion of order {order}");
                limits::same_length(&name, rows.len(), "rpm", speeds, "speed")?;
            }
            let is_wrong = |part: &&Complex64| {
                !(part.re.abs() <= limits::LARGEST && part.im.abs() <= limits::LARGEST)
            };
            if let Some(wrong) = rows.iter().flatten().find(is_wrong) {
                return Err(Error::value("motion", wrong, "give finite numbers"));
            }
        }
        Ok(())
    }

    /// Motion at a point of a row of phasors at an angular speed.
    fn at(
        &self,
        phasors: &[Complex64; 6],
        arm: &Vector3<f64>,
        omega: f64,
    ) -> Result<ComplexVector6> {
        let own = ComplexVector6::from(*phasors);
        if own == ComplexVector6::zeros() {
            return Ok(own);
        }
        let factor = self.derivative.factor(omega);
        if factor == Complex64::ZERO {
            let hint = "at rest a base has a displacement alone: give that, or speeds above zero";
            return Err(Error::figure("rpm", 0.0, hint));
        }
        Ok(moved(&(own / factor), arm))
    }
}

impl Response {
    /// Motion at each speed, rpm, in each order of the engine's balance and of a base that moves.
    pub fn on_base<'a>(
        engine: impl Into<Option<&'a Engine>>,
        powertrain: Arc<Powertrain>,
        rpm: &[f64],
        orders: &Orders,
        base: &BaseMotion,
        cancel: &Cancel,
    ) -> Result<Self> {
        base.check(&powertrain, rpm.len())?;
        let own: Vec<Order> = base.phasors.iter().map(|(order, _)| *order).collect();
        let loads = if base.engine_runs {
            EngineLoads::beside(engine.into(), &powertrain, rpm, orders, &own, cancel)?
        } else {
            EngineLoads { orders: own, ..EngineLoads::at_speeds(rpm)? }
        };
        let mut response = Self::under(loads, powertrain)?;
        response.stands = !base.engine_runs;
        let arm = response.powertrain.body().cg() - Vector3::from(base.about);
        let points = response.loads.len();
        let mut motions = memory::with_capacity(points)?;
        for point in 0..points {
            let (row, order) = response.place(point);
            let of_order = base.phasors.iter().find(|(own, _)| *own == order);
            let motion = of_order.map_or(Ok(ComplexVector6::zeros()), |(_, rows)| {
                let phasors = &rows[if rows.len() == 1 { 0 } else { row }];
                base.at(phasors, &arm, response.omega_of(point))
            });
            motions.push(motion?);
        }
        response.base = motions;
        response.solve(rpm, cancel)?;
        Ok(response)
    }

    /// Loads at each point on the powertrain, and on a subframe about its own CG, of the engine and of the base.
    pub(super) fn driving(&self, rpm: &[f64]) -> Result<[Cow<'_, [ComplexVector6]>; 2]> {
        if self.base.is_empty() {
            return Ok([Cow::Borrowed(&self.loads), Cow::Borrowed(&[])]);
        }
        let subframe = match self.powertrain.support() {
            Some(Support::Subframe(subframe)) => Some(&**subframe),
            _ => None,
        };
        let on_base = subframe.unwrap_or(&self.powertrain);
        let arm = self.powertrain.arm(&on_base.body().cg());
        let zeros =
            || memory::collected(std::iter::repeat_n(ComplexVector6::zeros(), self.base.len()));
        let (mut above, mut below) = (memory::collected(self.loads.iter().copied())?, zeros()?);
        for (point, base) in self.base.iter().enumerate() {
            if *base == ComplexVector6::zeros() {
                continue;
            }
            let words = || self.words(point, rpm[self.place(point).0]);
            let stiffnesses = on_base.stiffnesses(self.omega_of(point), words)?;
            let load = on_base.assembled(&stiffnesses) * moved(base, &arm);
            let of_body = if subframe.is_some() { &mut below } else { &mut above };
            of_body[point] += load;
        }
        Ok([Cow::Owned(above), Cow::Owned(below)])
    }

    /// Displacement of a base that moves at the CG of the powertrain, m, and its rotation, rad, at each speed and order.
    pub fn base_motions(&self) -> Result<&[ComplexVector6]> {
        if self.base.is_empty() {
            let hint = "give its motion";
            return Err(Error::value("base", "a base that does not move", hint));
        }
        Ok(&self.base)
    }

    /// Motion of a point of a base that moves along x, y and z at each speed and order.
    pub fn base_at(&self, point: [f64; 3], derivative: Derivative) -> Result<Vec<[Complex64; 3]>> {
        for (k, place) in point.into_iter().enumerate() {
            limits::finite(&format!("point[{k}]"), place)?;
        }
        let arm = self.powertrain.arm(&point.into());
        let motions = self.base_motions()?.iter().enumerate();
        let at = |(k, base)| derivative.of(displaced(base, &arm).into(), self.omega_of(k));
        memory::collected(motions.map(at))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mounts::tests::random;
    use crate::numbers::draws;

    const RPM: [f64; 2] = [300.0, 2400.0];

    fn on_base(
        powertrain: &Arc<Powertrain>,
        row: [Complex64; 6],
        derivative: Derivative,
    ) -> Response {
        let phasors = [(Order::FIRST, vec![row])];
        let base = BaseMotion {
            about: [0.1, -0.2, 0.3],
            derivative,
            phasors: &phasors,
            engine_runs: false,
        };
        let orders = Orders::whole(&[1]).unwrap();
        let cancel = Cancel::new();
        Response::on_base(None, Arc::clone(powertrain), &RPM, &orders, &base, &cancel).unwrap()
    }

    /// Seen from the base the body is loaded by its own inertia; what the base puts in the mounts dissipate.
    #[test]
    fn inertia_and_power_balance() {
        let mut number = draws(11);
        for turn in 0..8 {
            let mut powertrain = random(&mut number, true);
            if turn % 2 == 1 {
                let subframe = Support::Subframe(Box::new(random(&mut number, true)));
                powertrain = powertrain.on(subframe).unwrap();
            }
            let powertrain = Arc::new(powertrain);
            let row = [0; 6].map(|_| Complex64::new(number(), number()) * 1e-3);
            let found = on_base(&powertrain, row, Derivative::Displacement);
            let cancel = Cancel::new();
            let (sums, power) =
                (found.support_loads(&cancel).unwrap(), found.power(&cancel).unwrap());
            let mass = powertrain.body().mass_matrix().map(Complex64::from);
            for (k, motion) in found.motions().iter().enumerate() {
                let omega = found.omega_of(k);
                let inertia = mass * motion * Complex64::from(omega * omega);
                // Some thousand roundings of a well-conditioned solution.
                assert!((sums[k] - inertia).norm() <= 1e-9 * (inertia.norm() + sums[k].norm()));
                let lost: f64 = power[k][2..].iter().sum();
                assert_eq!(power[k][0], 0.0);
                let reactive = omega * inertia.norm() * motion.norm();
                assert!((power[k][1] + lost).abs() <= 1e-9 * reactive && lost > 0.0);
            }
            // Velocities and accelerations are displacements.
            for derivative in [Derivative::Velocity, Derivative::Acceleration] {
                let omega = found.omega_of(1);
                let faster = row.map(|part| part * derivative.factor(omega));
                let other = on_base(&powertrain, faster, derivative);
                let apart = (other.motions()[1] - found.motions()[1]).norm();
                assert!(apart <= 1e-13 * found.motions()[1].norm());
                let at = other.base_at([0.1, -0.2, 0.3], derivative).unwrap()[1];
                for (found, expected) in at.iter().zip(faster) {
                    assert!((found - expected).norm() <= 1e-12 * Vector3::from(at).norm());
                }
            }
        }
    }

    #[test]
    fn figures_that_no_base_has_are_named() {
        let powertrain = Arc::new(random(&mut draws(3), true));
        let error = |rpm: &[f64], rows: Vec<[Complex64; 6]>, derivative, about| {
            let phasors = [(Order::FIRST, rows)];
            let base = BaseMotion { about, derivative, phasors: &phasors, engine_runs: false };
            let orders = Orders::whole(&[1]).unwrap();
            let found = Response::on_base(
                None,
                Arc::clone(&powertrain),
                rpm,
                &orders,
                &base,
                &Cancel::new(),
            );
            found.unwrap_err().to_string()
        };
        let (one, still) = ([Complex64::ONE; 6], Derivative::Displacement);
        assert!(error(&RPM, vec![one; 3], still, [0.0; 3]).starts_with("motion of order 1"));
        let wrong = vec![[Complex64::new(0.0, f64::NAN); 6]];
        assert!(error(&RPM, wrong, still, [0.0; 3]).starts_with("motion = "));
        assert!(error(&RPM, vec![one], still, [0.0, f64::NAN, 0.0]).starts_with("about[1] = NaN"));
        let said = error(&[0.0], vec![one], Derivative::Velocity, [0.0; 3]);
        assert!(said.starts_with("rpm = 0.0: at rest a base has a displacement alone"), "{said}");
        let fixed = Response::on_base(
            None,
            Arc::clone(&powertrain),
            &RPM,
            &Orders::whole(&[1]).unwrap(),
            &BaseMotion { about: [0.0; 3], derivative: still, phasors: &[], engine_runs: false },
            &Cancel::new(),
        );
        assert!(fixed.unwrap().base_motions().is_err());
    }
}
