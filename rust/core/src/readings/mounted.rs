//! An engine on its mounts: motion, forces on what carries it, and power, order by order.
//!
//! (K(nω) − (nω)²·M)·q = f, with f the engine's own wrench of order n about the CG: of inertia times ω², of
//! gas as it is.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::Complex64;
use crate::engine::Engine;
use crate::mounts::{ComplexVector6, Levels, Powertrain, grade};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::pool;
use crate::readings::balance::{ErrorBounds, Orders, Request, angular_speed, balance};
use crate::wrench::Wrench;

/// Points solved between two checks for cancellation.
const POINTS_PER_TASK: usize = 256;

/// An engine, a body and its mounts at some speeds.
#[derive(Debug, Clone)]
pub struct Response {
    powertrain: Arc<Powertrain>,
    orders: Vec<Order>,
    omitted: Vec<Order>,
    error_bound: ErrorBounds,
    /// Angular speed of the crank at each speed.
    omega: Vec<f64>,
    loads: Vec<ComplexVector6>,
    motions: Vec<ComplexVector6>,
}

/// What the motion of a point is: displacement, or its first or second derivative by time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// m.
    Displacement,
    /// m/s.
    Velocity,
    /// m/s².
    Acceleration,
}

/// Load of a wrench about the CG: three forces, three moments.
fn load(wrench: &Wrench) -> ComplexVector6 {
    let ([force_x, force_y], [pitch, yaw]) = (wrench.force.xy(0.0), wrench.moment.xy(0.0));
    ComplexVector6::new(force_x, force_y, Complex64::ZERO, pitch, yaw, wrench.torque().roll)
}

impl Response {
    /// Motion at each speed, rpm, in each order of the engine's balance.
    pub fn new(
        engine: &Engine,
        powertrain: Arc<Powertrain>,
        rpm: &[f64],
        orders: &Orders,
        cancel: &Cancel,
    ) -> Result<Self> {
        limits::axis_length("rpm", rpm.len())?;
        if rpm.is_empty() {
            return Err(Error::value("rpm", "[]", "give at least one speed"));
        }
        let mut omega = memory::room(rpm.len())?;
        for &rpm in rpm {
            omega.push(angular_speed(rpm)?);
        }
        let cg = powertrain.body().cg();
        let at = |rpm: f64| {
            let request = Request { rpm, reference_z: Some(cg.z), torque: true };
            balance(engine, &request, orders, cancel)
        };
        // At 1 rad/s, where parts by inertia are over ω².
        let unit = at(60.0 / TAU)?;
        let fastest = rpm.iter().copied().fold(0.0, f64::max);
        let error_bound = match orders {
            Orders::Auto { .. } => at(fastest)?.error_bound,
            Orders::Given(_) => ErrorBounds::default(),
        };
        let about_cg: Vec<Wrench> =
            unit.wrenches.iter().map(|wrench| wrench.moved([cg.x, cg.y, 0.0])).collect();
        let count = unit.orders.len();
        let hint = "give fewer speeds or orders";
        limits::result_size("response", &[rpm.len(), count, 6], size_of::<Complex64>(), hint)?;
        let mut loads = memory::room(rpm.len() * count)?;
        for omega in &omega {
            loads.extend(about_cg.iter().map(|wrench| load(&wrench.at_speed(omega * omega))));
        }
        let roll = cg.x.hypot(cg.y) * error_bound.force;
        let mut response = Self {
            powertrain,
            orders: unit.orders,
            omitted: unit.omitted,
            error_bound: ErrorBounds { torque: error_bound.torque + roll, ..error_bound },
            omega,
            loads,
            motions: Vec::new(),
        };
        response.motions = response.solved(rpm, cancel)?;
        Ok(response)
    }

    fn solved(&self, rpm: &[f64], cancel: &Cancel) -> Result<Vec<ComplexVector6>> {
        let mut motions =
            memory::collected(std::iter::repeat_n(ComplexVector6::zeros(), self.loads.len()))?;
        let pieces = memory::collected(motions.chunks_mut(POINTS_PER_TASK).enumerate())?;
        // A factorisation takes some two hundred times as long as a product.
        pool::each(cancel, pieces, 256 * self.loads.len(), |(piece, motions)| {
            cancel.check()?;
            for (k, motion) in motions.iter_mut().enumerate() {
                let point = piece * POINTS_PER_TASK + k;
                let (row, order) = self.place(point);
                let omega = self.omega_of(point);
                if self.loads[point] == ComplexVector6::zeros() {
                    continue;
                }
                let stiffnesses = self.stiffnesses(point, rpm[row])?;
                *motion = self
                    .powertrain
                    .motion(&stiffnesses, omega, &self.loads[point])
                    .ok_or_else(|| {
                        let hint = format!(
                            "order {order} is at {:.6} Hz, where the powertrain has a mode without \
                             damping and its motion is unbounded; give mounts a loss_factor or damping, \
                             or another speed",
                            omega / TAU
                        );
                        Error::figure("rpm", rpm[row], hint)
                    })?;
            }
            Ok(())
        })?;
        Ok(motions)
    }

    /// Index of the speed, and the order, of a point.
    fn place(&self, point: usize) -> (usize, Order) {
        (point / self.orders.len(), self.orders[point % self.orders.len()])
    }

    /// nω of a point.
    fn omega_of(&self, point: usize) -> f64 {
        let (row, order) = self.place(point);
        self.omega[row] * order.number()
    }

    fn stiffnesses(&self, point: usize, rpm: f64) -> Result<Vec<[Complex64; 3]>> {
        let (_, order) = self.place(point);
        let words = || format!("order {order} at {rpm} rpm");
        self.powertrain.stiffnesses(self.omega_of(point), words)
    }

    /// Multiples of crank speed.
    #[must_use]
    pub fn orders(&self) -> &[Order] {
        &self.orders
    }

    /// Orders of the engine evaluated and left out, of those that are not zero.
    #[must_use]
    pub fn omitted(&self) -> &[Order] {
        &self.omitted
    }

    /// Bounds of what the orders left out add to the engine's own force, moment and torque about the CG, at
    /// the highest speed.
    #[must_use]
    pub fn error_bound(&self) -> ErrorBounds {
        self.error_bound
    }

    /// The engine's load about the CG, force and moment, at each speed and order.
    #[must_use]
    pub fn loads(&self) -> &[ComplexVector6] {
        &self.loads
    }

    /// Displacement of the CG, m, and rotation, rad, at each speed and order.
    #[must_use]
    pub fn motions(&self) -> &[ComplexVector6] {
        &self.motions
    }

    /// Calls a function for each speed and order with the mounts' stiffnesses, nω and the motion.
    fn for_each(
        &self,
        cancel: &Cancel,
        mut work: impl FnMut(&[[Complex64; 3]], f64, &ComplexVector6) -> Result<()>,
    ) -> Result<()> {
        for (point, motion) in self.motions.iter().enumerate() {
            if point.is_multiple_of(POINTS_PER_TASK) {
                cancel.check()?;
            }
            // Within tables: they were read for the motion. At rest of a load that is zero nothing moves.
            let stiffnesses = if *motion == ComplexVector6::zeros() {
                vec![[Complex64::ZERO; 3]; self.powertrain.mounts().len()]
            } else {
                self.stiffnesses(point, f64::NAN)?
            };
            work(&stiffnesses, self.omega_of(point), motion)?;
        }
        Ok(())
    }

    /// Force of each mount on what carries it along x, y and z, N, at each speed and order.
    pub fn mount_forces(&self, cancel: &Cancel) -> Result<Vec<[Complex64; 3]>> {
        let count = self.powertrain.mounts().len();
        let lengths = [self.motions.len(), count, 3];
        limits::result_size("response", &lengths, size_of::<Complex64>(), "give fewer speeds")?;
        let mut forces = memory::room(self.motions.len() * count)?;
        self.for_each(cancel, |stiffnesses, _, motion| {
            let force = |k| self.powertrain.force_on_support(k, &stiffnesses[k], motion);
            forces.extend((0..count).map(force));
            Ok(())
        })?;
        Ok(forces)
    }

    /// Sum of the mounts' forces on what carries them, N, and of their moments about the CG, N·m, at each
    /// speed and order.
    pub fn support_loads(&self, cancel: &Cancel) -> Result<Vec<ComplexVector6>> {
        let mut sums = memory::room(self.motions.len())?;
        self.for_each(cancel, |stiffnesses, _, motion| {
            sums.push(self.powertrain.assembled(stiffnesses) * motion);
            Ok(())
        })?;
        Ok(sums)
    }

    /// Motion of a point along x, y and z at each speed and order.
    pub fn at(
        &self,
        point: [f64; 3],
        derivative: Derivative,
        cancel: &Cancel,
    ) -> Result<Vec<[Complex64; 3]>> {
        for (k, place) in point.into_iter().enumerate() {
            limits::finite(&format!("point[{k}]"), place)?;
        }
        let mut values = memory::room(self.motions.len())?;
        for (k, motion) in self.motions.iter().enumerate() {
            if k.is_multiple_of(POINTS_PER_TASK) {
                cancel.check()?;
            }
            let rate = Complex64::new(0.0, self.omega_of(k));
            let factor = match derivative {
                Derivative::Displacement => Complex64::ONE,
                Derivative::Velocity => rate,
                Derivative::Acceleration => rate * rate,
            };
            let moved = self.powertrain.motion_of(point, motion);
            // Adding zero makes −0 0.
            values.push(moved.map(|phasor| phasor * factor + Complex64::ZERO));
        }
        Ok(values)
    }

    /// Severity grade (ISO 10816-6) of a point at each speed: the worst of its three directions.
    pub fn grades(&self, point: [f64; 3], cancel: &Cancel) -> Result<Vec<f64>> {
        let count = self.orders.len();
        let moved = self.at(point, Derivative::Displacement, cancel)?;
        let of_speed = |(row, moved): (usize, &[[Complex64; 3]])| {
            let along = |axis: usize| {
                let peaks = moved.iter().enumerate();
                let peaks = peaks.map(|(k, at)| (at[axis].norm(), self.omega_of(row * count + k)));
                grade(&Levels::of(peaks))
            };
            [0, 1, 2].map(along).into_iter().fold(0.0, f64::max)
        };
        Ok(moved.chunks(count).enumerate().map(of_speed).collect())
    }

    /// Mean power at each speed and order: what the engine puts in, then what each mount dissipates, W.
    pub fn power(&self, cancel: &Cancel) -> Result<Vec<Vec<f64>>> {
        let mut rows = memory::room(self.motions.len())?;
        let mut loads = self.loads.iter();
        self.for_each(cancel, |stiffnesses, omega, motion| {
            let load = loads.next().copied().unwrap_or_default();
            let velocity = motion * Complex64::new(0.0, omega);
            let mut row = memory::room(1 + stiffnesses.len())?;
            row.push(0.5 * load.dotc(&velocity).re);
            for (deflection, along) in self.powertrain.deflections().iter().zip(stiffnesses) {
                let moved = deflection.map(Complex64::from) * motion;
                let parts = moved.iter().zip(along);
                let lost: f64 = parts.map(|(part, k)| k.im * part.norm_sqr()).sum();
                row.push(0.5 * omega * lost);
            }
            rows.push(row);
            Ok(())
        })?;
        Ok(rows)
    }
}

mod driven;
#[cfg(test)]
mod tests;
