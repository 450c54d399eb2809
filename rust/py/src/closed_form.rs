//! Force and moment in closed form.

use crankpin_core as core;
use crankpin_core::closed_form::{ClosedForm, Part, Phasor};
use crankpin_core::rational::{Ratio, common_multiple};
use pyo3::prelude::*;

use crate::engine::Engine;
use crate::interrupt;

type Fraction = (i128, i128);
/// Weight, lever, rotating weight, bank and top dead centre (parts of a turn).
type Cylinder = (Fraction, Fraction, Fraction, Fraction, Fraction);
/// Coefficients of the real part, of the imaginary one and of the square of the size.
type Coefficients = (Vec<i128>, Vec<i128>, Vec<i128>);
/// Unit cylinder, spacing, whether aₙ is zero, cylinders, period, denominator, phasors.
type Form = (usize, f64, bool, Vec<Cylinder>, i128, i128, Vec<Coefficients>);

/// Force or moment of one order.
#[pyfunction]
pub fn closed_form(
    py: Python<'_>,
    engine: &Bound<'_, Engine>,
    order: u32,
    moment: bool,
    reference_z: Option<f64>,
) -> PyResult<Form> {
    let engine = engine.get().0.clone();
    // Sums of N-th roots take at most some N² steps to reduce.
    let angles = engine.placements().iter().flat_map(|p| [p.tdc, p.bank]);
    let period = angles
        .filter_map(core::Angle::turns)
        .try_fold(4, |period, (_, parts)| common_multiple(period, parts.into()));
    let steps = period.and_then(|n| usize::try_from(n.checked_mul(n)?).ok());
    let found = interrupt::run(py, steps.unwrap_or(usize::MAX), |cancel| {
        core::closed_form::closed_form(&engine, order, moment, reference_z, cancel)
    })?;
    let ClosedForm { unit, spacing, no_harmonic, parts, period, denominator, phasors } = found;
    let ratio = |r: Ratio| r.into_raw();
    let turns = |(numerator, denominator): (i64, i64)| (numerator.into(), denominator.into());
    let cylinder =
        |p: Part| (ratio(p.weight), ratio(p.lever), ratio(p.rotating), turns(p.bank), turns(p.tdc));
    let coefficients = |p: Phasor| (p.real, p.imaginary, p.square);
    Ok((
        unit,
        spacing,
        no_harmonic,
        parts.into_iter().map(cylinder).collect(),
        period,
        denominator,
        phasors.into_iter().map(coefficients).collect(),
    ))
}
