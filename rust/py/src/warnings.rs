//! Warnings of figures that no engine has.

use crankpin_core as core;
use crankpin_core::Warning;
use crankpin_core::engine::warnings;
use crankpin_core::mounts::warnings as mounts;
use crankpin_core::pressure::warnings as pressure;
use crankpin_macros::guarded;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::convert::{OrRaise, Piece, python_pieces};
use crate::engine::Engine;
use crate::interrupt;
use crate::mounts::{Body, Figures, body, mount};
use crate::pressure::Cycle;

/// What a warning is about, what that is, and the hint in pieces.
pub type Entry = (String, String, Vec<Piece>);

fn entries(found: impl IntoIterator<Item = Warning>) -> Vec<Entry> {
    let entry = |warning: Warning| (warning.about, warning.fault, python_pieces(warning.hint));
    found.into_iter().map(entry).collect()
}

/// Of a cylinder's crank radius, rod length and bore.
#[guarded]
#[pyfunction]
pub fn cylinder_warnings(radius: f64, rod_length: f64, bore: Option<f64>) -> Vec<Entry> {
    let bore = bore.and_then(|diameter| warnings::bore(diameter, 2.0 * radius));
    entries(warnings::cylinder(radius, rod_length).into_iter().chain(bore))
}

/// Of an unbalance, kg·m.
#[guarded]
#[pyfunction]
pub fn unbalance_warnings(amount: f64) -> Vec<Entry> {
    entries(warnings::unbalance(amount))
}

/// Of a mean piston speed, m/s.
#[guarded]
#[pyfunction]
pub fn piston_speed_warnings(speed: f64) -> Vec<Entry> {
    entries(warnings::piston_speed(speed))
}

/// Degrees of angles that are parts of a turn in radians.
#[guarded]
#[pyfunction]
pub fn radians(angles: Vec<f64>) -> Option<String> {
    warnings::radians(&angles)
}

/// Hint for an angle beside a part of a turn that no decimal is: `51.428571 is 4.3e-7° from 360/7`.
#[guarded]
#[pyfunction]
pub fn near_miss(degrees: &str) -> Option<String> {
    warnings::near_miss(degrees)
}

/// Of cylinder pressures, Pa.
#[guarded]
#[pyfunction]
pub fn pressure_warnings(values: PyReadonlyArray1<'_, f64>) -> Vec<Entry> {
    entries(pressure::pressures(&values.as_array().to_vec()))
}

/// Of the pressures of a cycle, and where they peak.
#[guarded]
#[pyfunction]
pub fn cycle_warnings(cycle: &Cycle) -> Vec<Entry> {
    entries(pressure::of_cycle(&cycle.0))
}

/// Crank angle of the peak of pressure if it is far from the firing top dead centre, degrees.
#[guarded]
#[pyfunction]
pub fn far_peak(
    theta_deg: PyReadonlyArray1<'_, f64>,
    values: PyReadonlyArray1<'_, f64>,
    period_deg: f64,
) -> Option<f64> {
    let [theta, values] = [theta_deg, values].map(|given| given.as_array().to_vec());
    pressure::far_peak(&theta, &values, period_deg)
}

/// Of pressure whose peak is far from the firing top dead centre.
#[guarded]
#[pyfunction]
pub fn peak_warnings(
    theta_deg: PyReadonlyArray1<'_, f64>,
    values: PyReadonlyArray1<'_, f64>,
    period_deg: f64,
) -> Vec<Entry> {
    let [theta, values] = [theta_deg, values].map(|given| given.as_array().to_vec());
    entries(pressure::peak(&theta, &values, period_deg))
}

/// Of a cycle whose mean effective pressure, Pa, takes work from the crank.
#[guarded]
#[pyfunction]
pub fn work_warnings(cycle: &Cycle, mean_effective: f64) -> Vec<Entry> {
    entries(pressure::work(&cycle.0, mean_effective))
}

/// Of the pressure in an engine's cylinders, beside its cycles alone.
#[guarded]
#[pyfunction]
pub fn gas_warnings(py: Python<'_>, engine: &Engine) -> PyResult<Vec<Entry>> {
    interrupt::run(py, |cancel| warnings::of_gas(&engine.0, cancel)).map(entries)
}

/// Of a tensor of inertia that no body has.
#[guarded]
#[pyfunction]
pub fn tensor_warnings(figures: Body) -> PyResult<Vec<Entry>> {
    Ok(entries(mounts::tensor(&body(figures).or_raise()?)))
}

/// Of a body.
#[guarded]
#[pyfunction]
pub fn body_warnings(figures: Body) -> PyResult<Vec<Entry>> {
    Ok(entries(mounts::body(&body(figures).or_raise()?)))
}

/// Of a mount.
#[guarded]
#[pyfunction]
pub fn mount_warnings(figures: Figures) -> PyResult<Vec<Entry>> {
    Ok(entries(mounts::mount(mount(figures).or_raise()?.figures())))
}

/// Of stiffness of a mount, N/m, by the name of its argument.
#[guarded]
#[pyfunction]
pub fn stiffness_warnings(argument: &str, mount: &str, values: Vec<f64>) -> Vec<Entry> {
    entries(mounts::stiffness(argument, mount, &values))
}

/// Of a place on a body, m.
#[guarded]
#[pyfunction]
pub fn point_warnings(argument: &str, at: [f64; 3]) -> Vec<Entry> {
    entries(mounts::place(argument, at))
}

/// Of the pressure of a crankcase or intake, Pa.
#[guarded]
#[pyfunction]
pub fn absolute_warnings(argument: &str, value: f64) -> Vec<Entry> {
    entries(pressure::absolute(argument, value))
}

/// Of pins split to the wrong side, in a vee.
#[guarded]
#[pyfunction]
pub fn pin_split_warnings(engine: &Engine, split: &str) -> PyResult<Vec<Entry>> {
    let split: core::Angle = split.parse().or_raise()?;
    Ok(entries(warnings::pin_split(&engine.0, split)))
}

/// Of an engine as a whole: its lengths, masses and what it carries.
#[guarded]
#[pyfunction]
pub fn engine_warnings(engine: &Engine) -> Vec<Entry> {
    entries(warnings::of_engine(&engine.0))
}

/// Of an engine's places and masses; its cylinders are asked alone.
#[guarded]
#[pyfunction]
pub fn unit_warnings(engine: &Engine) -> Vec<Entry> {
    entries(warnings::units(&engine.0))
}

/// Of an engine's counterweights, or of its balance shafts.
#[guarded]
#[pyfunction]
pub fn hardware_warnings(engine: &Engine, of_shafts: bool) -> Vec<Entry> {
    let engine = &engine.0;
    let (weights, shafts) =
        if of_shafts { (&[][..], engine.shafts()) } else { (engine.counterweights(), &[][..]) };
    entries(warnings::hardware(engine, weights, shafts))
}

/// Of a figure beside an engine: an unbalance (`kg·m`), a mass (`kg`), a moment of inertia (`kg·m²`) or a place
/// (`m`) that is beside the middle of the engine, or another one.
#[guarded]
#[pyfunction]
#[pyo3(signature = (engine, unit, argument, value, middle=None))]
pub fn figure_warnings(
    engine: &Engine,
    unit: &str,
    argument: &str,
    value: f64,
    middle: Option<f64>,
) -> Vec<Entry> {
    let engine = &engine.0;
    entries(match unit {
        "kg·m" => warnings::amount(engine, argument, value),
        "kg" => warnings::mass(engine, argument, value),
        "kg·m²" => warnings::flywheel(engine, value),
        _ => warnings::place(engine, argument, value, middle.unwrap_or_else(|| engine.middle())),
    })
}
