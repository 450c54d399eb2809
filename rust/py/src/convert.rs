//! Between Python's values and the core's: angles, cylinders, spectra, arrays, errors.

use crankpin_core as core;
use crankpin_core::Complex64;
use ndarray::Dimension;
use numpy::{Element, PyArray, PyArrayMethods};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;

pyo3::create_exception!(
    crankpin,
    InputError,
    PyValueError,
    "An input that makes no engine, or a request that cannot be met; the message names the argument, \
     its value and what would be right."
);

/// The core's error as Python's.
pub fn python_error(error: core::Error) -> PyErr {
    match error {
        core::Error::Cancelled => PyKeyboardInterrupt::new_err(()),
        other => InputError::new_err(other.to_string()),
    }
}

/// Result of the core as a Python result.
pub trait OrRaise<T> {
    /// Map the error.
    fn or_raise(self) -> PyResult<T>;
}

impl<T> OrRaise<T> for core::Result<T> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(python_error)
    }
}

/// Degrees as a number, a `Fraction` or a string such as `"360/7"`.
#[derive(Clone, Copy)]
pub struct Angle(pub core::Angle);

impl<'py> FromPyObject<'_, 'py> for Angle {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(text) = value.cast::<PyString>() {
            return text.to_str()?.parse().or_raise().map(Self);
        }
        // Whole numbers and fractions have both; a denominator of 1 is taken with the floats.
        if let Ok(denominator) = value.getattr("denominator")
            && let (Ok(numerator), Ok(denominator)) =
                (value.getattr("numerator")?.extract(), denominator.extract::<i64>())
            && denominator != 1
        {
            return core::Angle::from_degree_fraction(numerator, denominator).or_raise().map(Self);
        }
        let degrees = value.extract::<f64>().map_err(|_| {
            let message =
                format!("angle = {value:?}: give degrees as a number, Fraction or string");
            InputError::new_err(message)
        })?;
        core::Angle::from_degrees(degrees).or_raise().map(Self)
    }
}

/// The core's angles.
pub fn angles(angles: Vec<Angle>) -> Vec<core::Angle> {
    angles.into_iter().map(|angle| angle.0).collect()
}

/// Crank radius, rod length, reciprocating mass, pin offset.
pub type Parts = (f64, f64, f64, f64);

/// The core's cylinder.
pub fn cylinder((radius, rod, mass, offset): Parts) -> PyResult<core::Cylinder> {
    core::Cylinder::new(radius, rod, mass, offset).or_raise()
}

/// The core's spectrum from (order, amplitude) pairs.
pub fn spectrum(terms: Option<Vec<(u32, Complex64)>>) -> PyResult<Option<core::Spectrum>> {
    terms.map(core::Spectrum::new).transpose().or_raise()
}

/// A `NumPy` array that owns the values and cannot be written to.
pub fn frozen<T: Element, D: Dimension>(
    py: Python<'_>,
    values: ndarray::Array<T, D>,
) -> Bound<'_, PyArray<T, D>> {
    let array = PyArray::from_owned_array(py, values);
    array.readwrite().make_nonwriteable();
    array
}
