//! Phasors per order.

use crankpin_core as core;
use crankpin_core::balance::{Orders, Request, Vector};
use crankpin_core::wrench::Ellipse;
use crankpin_core::{Complex64, Error, Order};
use ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::convert::{OrRaise, frozen, python_error};
use crate::engine::Engine;
use crate::interrupt;

/// Which orders: a list, or a tolerance to choose them by.
pub fn orders(orders: Option<Vec<u32>>, rtol: f64) -> PyResult<Orders> {
    orders.map_or(Ok(Orders::Auto { rtol }), |orders| Orders::whole(&orders)).or_raise()
}

/// Orders as whole numbers: no load has others.
pub fn numbers(orders: &[Order]) -> Vec<u32> {
    orders.iter().filter_map(|order| order.as_whole()).collect()
}

/// How an engine shakes at one speed.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Balance(pub core::Balance);

/// The balance of an engine.
#[pyfunction]
#[pyo3(name = "balance")]
#[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
pub fn balance(
    py: Python<'_>,
    engine: &Bound<'_, Engine>,
    rpm: f64,
    orders: Option<Vec<u32>>,
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

/// ω in rad/s.
#[pyfunction]
pub fn angular_speed(rpm: f64) -> PyResult<f64> {
    core::balance::angular_speed(rpm).or_raise()
}

/// Half axes and tilt (radians) of the ellipses of forward and backward parts.
#[pyfunction]
pub fn ellipse(parts: Vec<(Complex64, Complex64)>) -> Vec<(f64, f64, f64)> {
    let axes = parts.into_iter().map(|(forward, backward)| Ellipse::new(forward, backward));
    axes.map(|e| (e.major, e.minor, e.tilt)).collect()
}

fn vector(quantity: &str) -> PyResult<Vector> {
    match quantity {
        "force" => Ok(Vector::Force),
        "moment" => Ok(Vector::Moment),
        other => {
            let hint = "give \"force\" or \"moment\"";
            Err(python_error(Error::value("quantity", other, hint)))
        }
    }
}

impl Balance {
    fn each<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(usize) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        frozen(py, (0..self.0.orders.len()).map(of).collect::<Array1<T>>())
    }
}

#[pymethods]
impl Balance {
    #[getter]
    fn orders(&self) -> Vec<u32> {
        numbers(&self.0.orders)
    }

    #[getter]
    fn omitted(&self) -> Vec<u32> {
        numbers(&self.0.omitted)
    }

    fn xy<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
        let vector = vector(quantity)?;
        let phasors: Vec<_> = (0..self.0.orders.len()).map(|k| self.0.xy(vector, k)).collect();
        Ok(frozen(py, Array2::from(phasors)))
    }

    fn forward<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        let vector = vector(quantity)?;
        Ok(self.each(py, |k| self.0.planar(vector, k).forward))
    }

    fn backward<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        let vector = vector(quantity)?;
        Ok(self.each(py, |k| self.0.planar(vector, k).backward()))
    }

    fn zero_bound<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        if quantity == "torque" {
            return Ok(self.each(py, |k| self.0.torque_zero_bound(k)));
        }
        let vector = vector(quantity)?;
        Ok(self.each(py, |k| self.0.zero_bound(vector, k)))
    }

    fn error_bound(&self, quantity: &str) -> PyResult<f64> {
        let [force, moment, torque] = self.0.error_bound;
        if quantity == "torque" {
            return Ok(torque);
        }
        Ok(if vector(quantity)? == Vector::Force { force } else { moment })
    }

    fn sum_peak_xy<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let vector = vector(quantity)?;
        let peaks = interrupt::run(py, |cancel| self.0.peak_xy(vector, cancel))?;
        Ok(frozen(py, peaks.to_vec().into()))
    }

    fn sum_peak_vector(&self, py: Python<'_>, quantity: &str) -> PyResult<f64> {
        let vector = vector(quantity)?;
        interrupt::run(py, |cancel| self.0.peak(vector, cancel))
    }

    fn roll_torque<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<Complex64>> {
        self.each(py, |k| self.0.wrenches[k].torque().roll)
    }

    fn crank_torque<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<Complex64>> {
        self.each(py, |k| self.0.wrenches[k].torque().crank)
    }

    /// Largest torque of all orders together, on the block or on the crank.
    fn torque_sum_peak(&self, py: Python<'_>, on_crank: bool) -> PyResult<f64> {
        let peaks = interrupt::run(py, |cancel| self.0.torque_peaks(cancel))?;
        Ok(peaks[usize::from(on_crank)])
    }
}
