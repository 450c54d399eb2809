//! Samples of an engine whose figures deviate.

use crate::array::frozen;
use crankpin_core as core;
use crankpin_core::peaks::largest_sums;
use crankpin_core::tolerances::{Deviations, Distribution, FIGURES};
use crankpin_core::{Complex64, Request, memory};
use crankpin_macros::guarded;
use ndarray::Array3;
use numpy::{PyArray1, PyArray2, PyArray3, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::convert::{self, OrRaise, OrderNumber, numbers};
use crate::engine::{Engine, choice};
use crate::interrupt;

/// An engine, the spreads of its figures, and the request for its samples.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Tolerances {
    plan: core::tolerances::Tolerances,
    orders: usize,
    torque: bool,
}

/// Force and moment (samples, orders, x y forward backward), torques (samples, orders, block crank),
/// peaks of all orders together (samples, force moment block crank).
type Samples<'py> = (
    Bound<'py, PyArray3<Complex64>>,
    Bound<'py, PyArray3<Complex64>>,
    Bound<'py, PyArray3<Complex64>>,
    Bound<'py, PyArray2<f64>>,
);

#[guarded]
#[pymethods]
impl Tolerances {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
    fn new(
        py: Python<'_>,
        engine: &Bound<'_, Engine>,
        rpm: f64,
        orders: Vec<OrderNumber>,
        reference_z: Option<f64>,
        torque: bool,
        spreads: [Vec<f64>; FIGURES],
        distribution: &str,
        pins: Vec<usize>,
        samples: usize,
    ) -> PyResult<Self> {
        let distributions = [("normal", Distribution::Normal), ("uniform", Distribution::Uniform)];
        let distribution = choice("distribution", distribution, &distributions)?;
        let request = Request { rpm, reference_z, torque };
        let engine = &engine.get().0;
        let orders = convert::orders(&orders)?;
        let plan = interrupt::run(py, |cancel| {
            core::tolerances::Tolerances::new(
                engine,
                &request,
                &orders,
                (&spreads, distribution),
                &pins,
                cancel,
            )
        })?;
        plan.check_size(samples).or_raise()?;
        Ok(Self { plan, orders: orders.len(), torque })
    }

    /// Samples of which each figure deviates so from its value: (samples, cylinders or pins), or empty.
    fn sample<'py>(
        &self,
        py: Python<'py>,
        count: usize,
        deviations: [PyReadonlyArray2<'py, f64>; FIGURES],
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Samples<'py>> {
        let mut slices: Deviations = [&[]; FIGURES];
        for (slice, array) in slices.iter_mut().zip(&deviations) {
            *slice = array.as_slice()?;
        }
        let found = interrupt::watched(py, progress.as_ref(), |cancel| {
            self.plan.sample(count, &slices, cancel)
        })?;
        let planar = |pairs: Vec<[Complex64; 4]>| -> PyResult<Array3<Complex64>> {
            memory::array("samples", (count, self.orders, 4), pairs.into_flattened()).or_raise()
        };
        let with_torque = if self.torque { count } else { 0 };
        let torque =
            memory::array("samples", (with_torque, self.orders, 2), found.torque.into_flattened())
                .or_raise()?;
        Ok((
            frozen(py, planar(found.force)?)?,
            frozen(py, planar(found.moment)?)?,
            frozen(py, torque)?,
            frozen(
                py,
                memory::array("samples", (count, 4), found.peaks.into_flattened()).or_raise()?,
            )?,
        ))
    }
}

/// Orders of samples that leave out at most a part of each cylinder, and bounds of force, moment and torque
/// on what others add to the nominal engine.
#[guarded]
#[pyfunction]
pub fn orders_of_samples(
    py: Python<'_>,
    engine: &Bound<'_, Engine>,
    rpm: f64,
    rtol: f64,
    torque: bool,
) -> PyResult<(Vec<OrderNumber>, (f64, f64, f64))> {
    let (engine, request) = (&engine.get().0, Request { rpm, reference_z: None, torque });
    let work = |cancel: &_| core::tolerances::orders(engine, &request, rtol, cancel);
    let (orders, bounds) = interrupt::run(py, work)?;
    Ok((numbers(&orders), bounds.values().into()))
}

/// Largest magnitude over the turn of each row of peak phasors, one of each order, beside its mean.
#[guarded]
#[pyfunction]
pub fn peaks_of_sums<'py>(
    py: Python<'py>,
    orders: Vec<OrderNumber>,
    phasors: PyReadonlyArray2<'_, Complex64>,
    means: PyReadonlyArray1<'_, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let orders = convert::orders(&orders)?;
    let (phasors, means) = (phasors.as_slice()?, means.as_slice()?);
    let peaks = interrupt::run(py, |cancel| largest_sums(&orders, phasors, means, cancel))?;
    frozen(py, peaks.into())
}
