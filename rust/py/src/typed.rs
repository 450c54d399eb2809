//! Numbers and units as people type them.

use crankpin_core::engine::Amplitudes;
use crankpin_core::numbers::decimal::{self, Exact};
use crankpin_core::numbers::typed::{Field, Form};
use crankpin_core::numbers::units::{self, Dimension};
use crankpin_macros::guarded;
use pyo3::prelude::*;

use crate::convert::OrRaise;

type Read = (Vec<f64>, Option<String>, bool, Option<String>);
/// Number, power of ten and denominator.
type Parts = (i128, i32, i128);

/// Numbers of a text, the first unit in it, whether it is a list, and the text with a point for its comma.
#[guarded]
#[pyfunction]
#[pyo3(signature = (argument, text, unit, *, form, plain = "", what = "a number", infinite = false))]
pub fn read_numbers(
    argument: &str,
    text: &str,
    unit: &str,
    form: &str,
    plain: &str,
    what: &str,
    infinite: bool,
) -> PyResult<Read> {
    let field = Field { argument, unit, plain, what, infinite };
    let read = field.read(text, Form::named(form).or_raise()?).or_raise()?;
    Ok((read.values, read.unit, read.is_listed, read.point))
}

/// Rows of amplitudes by order, as they are typed: an order, then real and imaginary parts.
#[guarded]
#[pyfunction]
pub fn read_amplitudes(
    argument: &str,
    text: &str,
    unit: &str,
    plain: &str,
) -> PyResult<Vec<Vec<f64>>> {
    let field = Field { argument, unit, plain, what: "an amplitude", infinite: false };
    Ok(Amplitudes::typed(text, &field).or_raise()?.into())
}

/// The product of two numbers as they are meant, rounded once: 3 · 0.1 is 0.3.
#[guarded]
#[pyfunction]
pub fn product(x: f64, y: f64) -> f64 {
    decimal::product(x, y)
}

type Symbols = Vec<(&'static str, usize, Parts)>;
type Aliases = Vec<(&'static str, &'static str)>;

/// Symbols of units with their kinds and factors, and other spellings with the symbols they stand for.
#[guarded]
#[pyfunction]
pub fn unit_symbols() -> (Symbols, Aliases) {
    let symbols = units::SYMBOLS.iter();
    let symbols = symbols.map(|symbol| (symbol.name, symbol.kind, parts(symbol.factor))).collect();
    (symbols, units::ALIASES.to_vec())
}

/// The symbol that a word stands for, whatever its case.
#[guarded]
#[pyfunction]
pub fn unit_symbol(word: &str) -> Option<&'static str> {
    units::symbol(word).map(|symbol| symbol.name)
}

/// Symbols of a unit with their exponents.
#[guarded]
#[pyfunction]
pub fn unit_terms(unit: &str) -> Option<Vec<(&'static str, i32)>> {
    units::terms(unit)
}

/// What a unit stands for in SI units, of a dimension, or whatever it is of.
#[guarded]
#[pyfunction]
#[pyo3(signature = (unit, dimension = None))]
pub fn unit_factor(unit: &str, dimension: Option<Dimension>) -> Option<Parts> {
    let factor = match dimension {
        Some(dimension) => units::factor_of(unit, dimension),
        None => units::factor(unit).map(|(_, factor)| factor),
    };
    factor.map(parts)
}

fn parts(Exact { number, power, below }: Exact) -> Parts {
    (number, power, below)
}
