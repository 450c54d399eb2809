//! Phasors per order.

use crate::array::frozen;
use crankpin_core as core;
use crankpin_core::balance::{ErrorBounds, Orders, Request, TorquePart, Vector};
use crankpin_core::engine::Origin;
use crankpin_core::{Complex64, Error};
use crankpin_macros::guarded;
use ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use crate::convert::{self, OrRaise, OrderNumber, numbers};
use crate::engine::{Engine, choice};
use crate::interrupt;

/// Which orders: a list, or a tolerance to choose them by.
pub fn orders(orders: Option<Vec<OrderNumber>>, rtol: f64) -> PyResult<Orders> {
    orders.map_or(Ok(Orders::Auto { rtol }), |given| convert::orders(&given).map(Orders::Given))
}

/// How an engine shakes at one speed.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Balance(pub core::Balance);

/// Bounds on force, moment and torque about a point this far away along x, y and z, m.
#[guarded]
#[pyfunction]
pub fn bounds_about(of: [f64; 3], arm: [f64; 3]) -> [f64; 3] {
    let [force, moment, torque] = of;
    ErrorBounds { force, moment, torque }.moved(arm).values()
}

/// The balance of an engine.
#[guarded]
#[pyfunction]
#[pyo3(name = "balance")]
#[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
pub fn balance(
    py: Python<'_>,
    engine: &Bound<'_, Engine>,
    rpm: f64,
    orders: Option<Vec<OrderNumber>>,
    rtol: f64,
    reference_z: Option<f64>,
    spectrum: Option<Vec<(u32, Complex64)>>,
    torque: bool,
) -> PyResult<Balance> {
    let orders = self::orders(orders, rtol)?;
    let request = Request { rpm, reference_z, torque };
    let engine = engine.get().with_spectrum(spectrum)?;
    interrupt::run(py, |cancel| core::balance::balance(&engine, &request, &orders, cancel))
        .map(Balance)
}

/// What each part of an engine adds to a balance of these orders: its kind, index and balance.
#[guarded]
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
pub fn terms(
    py: Python<'_>,
    engine: &Bound<'_, Engine>,
    rpm: f64,
    orders: Vec<OrderNumber>,
    reference_z: Option<f64>,
    spectrum: Option<Vec<(u32, Complex64)>>,
    torque: bool,
    aside: [f64; 2],
) -> PyResult<Vec<(&'static str, usize, Balance)>> {
    let orders = convert::orders(&orders)?;
    let request = Request { rpm, reference_z, torque };
    let engine = engine.get().with_spectrum(spectrum)?;
    let terms =
        interrupt::run(py, |cancel| core::terms::terms(&engine, &request, aside, &orders, cancel))?;
    let named = |(origin, balance)| {
        let (kind, index) = match origin {
            Origin::Cylinder(index) => ("cylinder", index),
            Origin::Counterweight(index) => ("counterweight", index),
            Origin::Shaft(index) => ("shaft", index),
        };
        (kind, index, Balance(balance))
    };
    Ok(terms.into_iter().map(named).collect())
}

/// ω in rad/s.
#[guarded]
#[pyfunction]
pub fn angular_speed(rpm: f64) -> PyResult<f64> {
    core::balance::angular_speed(rpm).or_raise()
}

/// Which part of a torque a quantity is.
fn part(quantity: &str) -> Option<TorquePart> {
    match quantity.split_once('.').unwrap_or((quantity, "")) {
        ("torque" | "crank_torque", "") => Some(TorquePart::Whole),
        ("torque" | "crank_torque", "inertia") => Some(TorquePart::Inertia),
        ("torque" | "crank_torque", "gas") => Some(TorquePart::Gas),
        _ => None,
    }
}

/// Part of a torque, and whether it is that on the crank.
pub fn torque(quantity: &str) -> PyResult<(TorquePart, bool)> {
    let hint = "give \"force\", \"moment\", \"torque\" or \"crank_torque\", or a part of a torque such as \
                \"torque.gas\"";
    let part = part(quantity).ok_or_else(|| Error::value("quantity", quantity, hint));
    Ok((part.or_raise()?, quantity.starts_with("crank")))
}

/// Force or moment by its name.
pub fn vector(quantity: &str) -> PyResult<Vector> {
    choice("quantity", quantity, &[("force", Vector::Force), ("moment", Vector::Moment)])
}

#[guarded]
#[pymethods]
impl Balance {
    #[getter]
    fn orders(&self) -> Vec<OrderNumber> {
        numbers(&self.0.orders)
    }

    #[getter]
    fn omitted(&self) -> Vec<OrderNumber> {
        numbers(&self.0.omitted)
    }

    /// Of force, moment and torque.
    #[getter]
    fn error_bound(&self) -> [f64; 3] {
        self.0.error_bound.values()
    }

    /// That of one order alone, if it was evaluated here.
    fn alone(&self, order: OrderNumber) -> PyResult<Option<Self>> {
        let [order] = convert::orders(&[order])?[..] else { return Ok(None) };
        Ok(self.0.alone(order).map(Self))
    }

    /// As those of a sweep: along (about) x and y or, of force and moment, forward and backward parts.
    fn phasors<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        turning: bool,
    ) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        let orders = 0..self.0.orders.len();
        if part(name).is_some() {
            let (part, on_crank) = torque(name)?;
            let torques = orders.map(|k| {
                let torque = self.0.torque(part, k);
                if on_crank { torque.crank } else { torque.roll }
            });
            return frozen(py, torques.collect::<Array1<_>>().into_dyn());
        }
        let vector = vector(name)?;
        let pairs = orders.map(|k| {
            let planar = self.0.planar(vector, k);
            if turning { [planar.forward, planar.backward()] } else { self.0.xy(vector, k) }
        });
        frozen(py, Array2::from(pairs.collect::<Vec<_>>()).into_dyn())
    }

    fn zero_bound<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let orders = 0..self.0.orders.len();
        let bounds: Array1<f64> = if part(name).is_some() {
            let (part, on_crank) = torque(name)?;
            orders.map(|k| self.0.torque_zero_bounds(part, k)[usize::from(on_crank)]).collect()
        } else {
            let vector = vector(name)?;
            orders.map(|k| self.0.zero_bound(vector, k)).collect()
        };
        frozen(py, bounds)
    }

    fn total_peak_xy<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let vector = vector(name)?;
        let peaks = interrupt::run(py, |cancel| self.0.peak_xy(vector, cancel))?;
        frozen(py, peaks.to_vec().into())
    }

    /// The longest vector, or the largest torque, of all orders together.
    fn total_peak(&self, py: Python<'_>, name: &str) -> PyResult<f64> {
        if part(name).is_some() {
            let (part, on_crank) = torque(name)?;
            return interrupt::run(py, |cancel| self.0.torque_peak(part, on_crank, cancel));
        }
        let vector = vector(name)?;
        interrupt::run(py, |cancel| self.0.peak(vector, cancel))
    }

    /// Mean torque.
    fn mean(&self, name: &str) -> PyResult<f64> {
        let (part, on_crank) = torque(name)?;
        Ok(self.0.mean(part)[usize::from(on_crank)])
    }
}
