//! Data for drawings of an engine, and for pictures of it turning.

use crankpin_core::Complex64;
use crankpin_core::drawing::{self, Drawing};
use crankpin_core::figures;
use crankpin_core::rows::RodRatios;
use crankpin_macros::guarded;
use pyo3::prelude::*;
use serde_json::json;

use crate::convert::{OrRaise, OrderNumber, Parts, cylinder, numbers};
use crate::engine::Engine;
use crate::interrupt;

/// Rod ratios that a page reaches, the least and the largest, if it does others than the engine's own, of all
/// cylinders.
#[guarded]
#[pyfunction]
pub fn rod_ratios(engine: &Engine) -> (Option<(f64, f64)>, Option<f64>) {
    let reached = RodRatios::reached(&engine.0).map(|ratios| (ratios.least, ratios.most));
    (reached, RodRatios::of(&engine.0).common)
}

/// Length of a rod in pictures, m.
#[guarded]
#[pyfunction]
pub fn drawn_rod(parts: Parts) -> PyResult<f64> {
    Ok(drawing::drawn_rod(&cylinder(parts)?))
}

/// What an engine is drawn from, as JSON.
#[guarded]
#[pyfunction]
pub fn drawn(engine: &Bound<'_, Engine>) -> PyResult<String> {
    let core = &engine.get().0;
    let ratios = RodRatios::reached(core);
    let drawn = interrupt::run(engine.py(), |cancel| Drawing::new(core, ratios, cancel))?;
    Ok(json!(drawn).to_string())
}

/// What an engine is drawn from that turns, with a force given for every cylinder or its own, as JSON; tables of its
/// loads must have the crank speed.
#[guarded]
#[pyfunction]
pub fn drawn_turning(
    engine: &Bound<'_, Engine>,
    spectrum: Option<Vec<(u32, Complex64)>>,
    rpm: f64,
) -> PyResult<String> {
    let core = engine.get().with_spectrum(spectrum)?;
    let ratios = RodRatios::reached(&core);
    let drawn = interrupt::run(engine.py(), |cancel| drawing::turning(&core, ratios, rpm, cancel))?;
    Ok(drawn.to_string())
}

/// Terms of an engine's periodic loads, with torques or without; at a crank speed that they must have.
#[guarded]
#[pyfunction]
pub fn load_rows(engine: &Bound<'_, Engine>, rpm: f64, torque: bool) -> PyResult<String> {
    let core = &engine.get().0;
    let rows = interrupt::run(engine.py(), |cancel| figures::load_rows(core, rpm, torque, cancel))?;
    Ok(json!(rows).to_string())
}

/// Orders whose phasors are listed: of pistons, or of a force given for every cylinder, and of shafts.
#[guarded]
#[pyfunction]
pub fn listed_orders(
    engine: &Engine,
    spectrum: Option<Vec<(u32, Complex64)>>,
) -> PyResult<Vec<OrderNumber>> {
    Ok(numbers(&figures::listed_orders(&*engine.with_spectrum(spectrum)?).or_raise()?))
}
