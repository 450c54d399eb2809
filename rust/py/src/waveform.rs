//! Waveforms at given crank angles.

use crate::array::frozen;
use crankpin_core as core;
use crankpin_core::{Complex64, Request};
use crankpin_macros::guarded;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::balance::{self, Balance};
use crate::convert::{OrRaise, OrderNumber};
use crate::engine::Engine;
use crate::interrupt;

/// Crank angles, checked.
#[pyclass(frozen, module = "crankpin._core")]
pub struct CrankAngles(pub core::CrankAngles);

#[guarded]
#[pymethods]
impl CrankAngles {
    #[new]
    fn new(theta_deg: PyReadonlyArray1<'_, f64>) -> PyResult<Self> {
        core::CrankAngles::new(theta_deg.as_slice()?).or_raise().map(Self)
    }
}

/// Force, moment, roll torque, crank torque, what gas pressure adds to the torques, and the balance
/// whose orders were summed.
type Parts<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Option<[Bound<'py, PyArray1<f64>>; 2]>,
    Option<Balance>,
);

/// From exact kinematics, or (`summed`) as a sum of orders.
#[guarded]
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
pub fn waveform<'py>(
    py: Python<'py>,
    engine: &Bound<'py, Engine>,
    rpm: f64,
    theta_deg: PyReadonlyArray1<'py, f64>,
    summed: bool,
    orders: Option<Vec<OrderNumber>>,
    rtol: f64,
    reference_z: Option<f64>,
    spectrum: Option<Vec<(u32, Complex64)>>,
    torque: bool,
) -> PyResult<Parts<'py>> {
    let engine = engine.get().with_spectrum(spectrum)?;
    let thetas = theta_deg.as_slice()?;
    let orders = balance::orders(orders, rtol)?;
    let waveform = interrupt::run(py, |cancel| {
        let request = Request { rpm, reference_z, torque };
        if !summed {
            return core::waveform::exact(&engine, &request, thetas, cancel);
        }
        core::waveform::from_orders(&engine, &request, thetas, &orders, cancel)
    })?;
    Ok((
        frozen(py, waveform.force)?,
        frozen(py, waveform.moment)?,
        waveform.torque.map(|values| frozen(py, values)).transpose()?,
        waveform.crank_torque.map(|values| frozen(py, values)).transpose()?,
        waveform
            .gas
            .map(|[roll, crank]| PyResult::Ok([frozen(py, roll)?, frozen(py, crank)?]))
            .transpose()?,
        waveform.balance.map(Balance),
    ))
}
