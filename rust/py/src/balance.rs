//! Phasors per order.

use crankpin_core as core;
use crankpin_core::balance::{Ellipse, Orders, Shake};
use crankpin_core::extrema::PeakFinder;
use crankpin_core::{Asked, Complex64, Error};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::convert::{OrRaise, frozen, python_error, spectrum};
use crate::engine::Engine;
use crate::interrupt;

/// Which orders: a list, or a tolerance to choose them by.
pub fn orders(orders: Option<Vec<u32>>, rtol: f64) -> Orders {
    orders.map_or(Orders::Auto { rtol }, Orders::Given)
}

/// How an engine shakes at one speed.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Balance(pub core::Balance);

/// Work out the balance.
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
    let orders = self::orders(orders, rtol);
    let spectrum = self::spectrum(spectrum)?;
    let asked = Asked { rpm, reference_z, spectrum: spectrum.as_ref(), torque };
    let engine = &engine.get().0;
    let balance = interrupt::run(py, orders.steps(engine), |cancel| {
        core::balance::of(engine, &asked, &orders, cancel)
    });
    balance.map(Balance)
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

impl Balance {
    fn shake(&self, quantity: &str) -> PyResult<&Shake> {
        match quantity {
            "force" => Ok(&self.0.force),
            "moment" => Ok(&self.0.moment),
            other => {
                let cure = "give \"force\" or \"moment\"";
                Err(python_error(Error::value("quantity", other, cure)))
            }
        }
    }

    fn finder(&self) -> PeakFinder {
        PeakFinder::new(&self.0.orders)
    }

    fn torque(&self) -> PyResult<&core::balance::Torque> {
        self.0.torque.as_ref().ok_or_else(|| {
            // The wrapper in Python says why.
            python_error(Error::value("torque", "not known", "ask for force and moment"))
        })
    }
}

#[pymethods]
impl Balance {
    #[getter]
    fn orders(&self) -> Vec<u32> {
        self.0.orders.clone()
    }

    #[getter]
    fn omitted(&self) -> Vec<u32> {
        self.0.omitted.clone()
    }

    fn xy<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
        Ok(frozen(py, self.shake(quantity)?.xy.clone()))
    }

    fn forward<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        Ok(frozen(py, self.shake(quantity)?.forward.clone()))
    }

    fn backward<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        Ok(frozen(py, self.shake(quantity)?.backward.clone()))
    }

    fn zero_bound<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        if quantity == "torque" {
            return Ok(frozen(py, self.torque()?.zero_bound.clone()));
        }
        Ok(frozen(py, self.shake(quantity)?.zero_bound.clone()))
    }

    fn error_bound(&self, quantity: &str) -> PyResult<f64> {
        if quantity == "torque" {
            return Ok(self.torque()?.error_bound);
        }
        Ok(self.shake(quantity)?.error_bound)
    }

    fn sum_peak_xy<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let peaks = self.shake(quantity)?.peak_xy(&self.finder());
        Ok(frozen(py, peaks.to_vec().into()))
    }

    fn sum_peak_vector(&self, quantity: &str) -> PyResult<f64> {
        Ok(self.shake(quantity)?.peak_vector(&self.finder()))
    }

    fn roll_torque<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        Ok(frozen(py, self.torque()?.roll.clone()))
    }

    fn crank_torque<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        Ok(frozen(py, self.torque()?.crank.clone()))
    }

    /// Largest torque of all orders together, on the block or on the crank.
    fn torque_sum_peak(&self, on_crank: bool) -> PyResult<f64> {
        let torque = self.torque()?;
        let phasors = if on_crank { &torque.crank } else { &torque.roll };
        Ok(self.finder().along_axis(phasors.as_slice().unwrap_or_default()))
    }
}
