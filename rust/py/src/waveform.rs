//! Waveforms at given crank angles.

use crate::array::frozen;
use crankpin_core as core;
use crankpin_core::waveform::PartOverAngle;
use crankpin_core::{Complex64, Request};
use crankpin_macros::guarded;
use ndarray::{Array1, Array2};
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

/// Force and moment, then torques on the block and on the crank, where they are known.
type Columns<'py> =
    (Option<[Bound<'py, PyArray2<f64>>; 2]>, Option<[Bound<'py, PyArray1<f64>>; 2]>);

/// What all loads make, what those of each name but `inertia` make, and the balance whose orders were summed.
type Parts<'py> = (Columns<'py>, Vec<(String, Columns<'py>)>, Option<Balance>);

fn columns(
    py: Python<'_>,
    planar: Option<[Array2<f64>; 2]>,
    torque: Option<[Array1<f64>; 2]>,
) -> PyResult<Columns<'_>> {
    let planar =
        planar.map(|[force, moment]| PyResult::Ok([frozen(py, force)?, frozen(py, moment)?]));
    let torque = torque.map(|[roll, crank]| PyResult::Ok([frozen(py, roll)?, frozen(py, crank)?]));
    Ok((planar.transpose()?, torque.transpose()?))
}

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
    let part =
        |part: PartOverAngle| Ok((part.name.to_string(), columns(py, part.planar, part.torque)?));
    let parts = waveform.parts.into_iter().map(part).collect::<PyResult<_>>()?;
    let torque = waveform.torque.zip(waveform.crank_torque).map(<[_; 2]>::from);
    let whole = columns(py, Some([waveform.force, waveform.moment]), torque)?;
    Ok((whole, parts, waveform.balance.map(Balance)))
}
