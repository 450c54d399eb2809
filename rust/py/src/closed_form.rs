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

/// Of a piston the sense of rotation is 0; direction and phase are parts of a turn.
#[derive(IntoPyObject)]
struct Load {
    weight: Fraction,
    lever: Fraction,
    sense: i8,
    direction: Fraction,
    phase: Fraction,
}

/// Coefficients of the real part, of the imaginary one and of the square of the size.
#[derive(IntoPyObject)]
struct Coefficients {
    real: Vec<i128>,
    imaginary: Vec<i128>,
    square: Vec<i128>,
}

/// Unit is the index of a cylinder, loads are those of periodic loads.
#[derive(IntoPyObject)]
pub struct Form {
    unit: usize,
    spacing: f64,
    no_harmonic: bool,
    parts: Vec<Load>,
    period: i128,
    denominator: i128,
    phasors: Vec<Coefficients>,
    loads: Vec<usize>,
}

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
    let load = |part: LoadPart| Load {
        weight: ratio(part.weight),
        lever: ratio(part.lever),
        sense: sense(part.motion),
        direction: turns(part.direction),
        phase: turns(part.phase),
    };
    let coefficients =
        |Phasor { real, imaginary, square }: Phasor| Coefficients { real, imaginary, square };
    let parts = parts.into_iter().map(load).collect();
    let phasors = phasors.into_iter().map(coefficients).collect();
    Ok(Form { unit, spacing, no_harmonic, parts, period, denominator, phasors, loads })
}
