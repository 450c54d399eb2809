//! Force and moment in closed form.

use crankpin_core::Order;
use crankpin_core::exact::closed_form::{self as core, ClosedForm, LoadMotion, LoadPart, Phasor};
use crankpin_core::rational::Ratio;
use crankpin_macros::guarded;
use pyo3::prelude::*;

use crate::convert::OrRaise;
use crate::engine::Engine;
use crate::interrupt;

type Fraction = (i128, i128);
/// Weight, lever, sense of rotation (0 for a piston), direction and phase (parts of a turn).
type Load = (Fraction, Fraction, i8, Fraction, Fraction);
/// Coefficients of the real part, of the imaginary one and of the square of the size.
type Coefficients = (Vec<i128>, Vec<i128>, Vec<i128>);
/// Unit cylinder, spacing, whether aₙ is zero, loads, period, denominator, phasors, indices of periodic loads.
type Form = (usize, f64, bool, Vec<Load>, i128, i128, Vec<Coefficients>, Vec<usize>);

/// Force or moment of one order.
#[guarded]
#[pyfunction]
pub fn closed_form(
    py: Python<'_>,
    engine: &Bound<'_, Engine>,
    order: u32,
    moment: bool,
    reference_z: Option<f64>,
) -> PyResult<Form> {
    let (engine, order) = (engine.get().0.clone(), Order::whole(order).or_raise()?);
    let found = interrupt::run(py, |cancel| {
        core::closed_form(&engine, order, moment, reference_z, cancel)
    })?;
    let ClosedForm { unit, spacing, no_harmonic, parts, period, denominator, phasors, loads } =
        found;
    let ratio = |r: Ratio| r.into_raw();
    let turns = |(numerator, denominator): (i64, i64)| (numerator.into(), denominator.into());
    let sense = |motion: LoadMotion| match motion {
        LoadMotion::Along => 0,
        LoadMotion::Forward => 1,
        LoadMotion::Backward => -1,
    };
    let load = |p: LoadPart| {
        (ratio(p.weight), ratio(p.lever), sense(p.motion), turns(p.direction), turns(p.phase))
    };
    let coefficients = |p: Phasor| (p.real, p.imaginary, p.square);
    Ok((
        unit,
        spacing,
        no_harmonic,
        parts.into_iter().map(load).collect(),
        period,
        denominator,
        phasors.into_iter().map(coefficients).collect(),
        loads,
    ))
}
