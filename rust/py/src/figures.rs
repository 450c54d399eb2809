//! Data for drawings of an engine, and for pictures of it turning.

use crankpin_core::Complex64;
use crankpin_core::drawing::{self, Drawing};
use crankpin_core::figures::{self, GROUPS};
use crankpin_macros::guarded;
use ndarray::Array3;
use numpy::PyArray3;
use pyo3::prelude::*;
use serde_json::json;

use crate::array::writeable;
use crate::convert::{OrRaise, OrderNumber, Parts, cylinder, numbers, orders};
use crate::engine::Engine;
use crate::interrupt;

type Table<'py> = Bound<'py, PyArray3<Complex64>>;

/// Terms over ω² by order, group and component: forward and backward parts of force and moment, then roll
/// torque and moment of inertia; of the cylinders, or of what no rod moves.
#[guarded]
#[pyfunction]
pub fn group_terms<'py>(
    engine: &Bound<'py, Engine>,
    cylinders: bool,
    numbers: Vec<OrderNumber>,
    spectrum: Option<Vec<(u32, Complex64)>>,
) -> PyResult<(Table<'py>, Table<'py>)> {
    let py = engine.py();
    let orders = orders(&numbers)?;
    let torque = spectrum.is_none();
    let engine = engine.get().with_spectrum(spectrum)?;
    let found = interrupt::run(py, |cancel| {
        figures::group_terms(&engine, cylinders, &orders, torque, cancel)
    })?;
    let planar =
        Array3::from_shape_fn((found.len(), GROUPS, 4), |(k, group, j)| found[k][group].planar[j]);
    let torques = Array3::from_shape_fn((found.len(), GROUPS, 2), |(k, group, j)| {
        let terms = &found[k][group];
        if j == 0 { terms.roll } else { terms.inertia }
    });
    Ok((writeable(py, planar)?, writeable(py, torques)?))
}

/// Orders of the cylinders that are more than a rest, of their cranks, and of shafts.
#[guarded]
#[pyfunction]
pub fn orders_that_count(engine: &Bound<'_, Engine>) -> PyResult<Vec<OrderNumber>> {
    let core = &engine.get().0;
    let found = interrupt::run(engine.py(), |cancel| figures::orders(core, cancel))?;
    Ok(numbers(&found))
}

/// Volume that a cylinder's piston adds per radian past its top dead centre, m³: phasors of orders.
#[guarded]
#[pyfunction]
pub fn swept(
    engine: &Bound<'_, Engine>,
    cylinder: usize,
    orders: Vec<u32>,
) -> PyResult<Vec<Complex64>> {
    let core = &engine.get().0;
    interrupt::run(engine.py(), |cancel| figures::swept(core, cylinder, &orders, cancel))
}

/// Length of a rod in pictures, m.
#[guarded]
#[pyfunction]
pub fn drawn_rod(parts: Parts) -> PyResult<f64> {
    Ok(drawing::drawn_rod(&cylinder(parts)?))
}

/// What the cylinders make one by one: force, moment, torque of inertia and of gas.
#[guarded]
#[pyfunction]
pub fn sizes(engine: &Bound<'_, Engine>) -> PyResult<[f64; 4]> {
    let core = &engine.get().0;
    let found = interrupt::run(engine.py(), |cancel| figures::sizes(core, cancel))?;
    Ok([found.force, found.moment, found.torque, found.gas])
}

/// What an engine is drawn from, as JSON.
#[guarded]
#[pyfunction]
pub fn drawn(engine: &Bound<'_, Engine>) -> PyResult<String> {
    let core = &engine.get().0;
    let drawn = interrupt::run(engine.py(), |cancel| Drawing::new(core, cancel))?;
    Ok(json!(drawn).to_string())
}

/// Terms of an engine's periodic loads, with torques or without; at a crank speed that they must have.
#[guarded]
#[pyfunction]
pub fn load_rows(engine: &Bound<'_, Engine>, rpm: f64, torque: bool) -> PyResult<String> {
    let core = &engine.get().0;
    let rows = interrupt::run(engine.py(), |cancel| figures::load_rows(core, rpm, torque, cancel))?;
    Ok(json!(rows).to_string())
}

/// A bar that stands for its block, and the pressure in its cylinders: as JSON, null where there is none.
#[guarded]
#[pyfunction]
pub fn drawn_loads(engine: &Engine) -> [String; 2] {
    [json!(drawing::block(&engine.0)), json!(drawing::gas(&engine.0))].map(|part| part.to_string())
}

/// Cylinders that differ among those with pressure, each by the index of its first cylinder.
#[guarded]
#[pyfunction]
pub fn fired_kinds(engine: &Engine) -> Vec<usize> {
    drawing::fired_kinds(&engine.0)
}

/// Orders whose phasors are listed: of pistons and of shafts.
#[guarded]
#[pyfunction]
pub fn listed_orders(engine: &Engine) -> PyResult<Vec<OrderNumber>> {
    Ok(numbers(&figures::listed_orders(&engine.0).or_raise()?))
}
