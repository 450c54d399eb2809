//! Between Python's values and the core's: angles, cylinders, spectra, arrays, errors.

use crankpin_core as core;
use crankpin_macros::guarded;
use pyo3::exceptions::{PyKeyboardInterrupt, PyMemoryError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyFloat;

use crate::{boundary, reserve};

pyo3::create_exception!(
    crankpin,
    InputError,
    PyValueError,
    "An input that makes no engine, or a request that cannot be met.\n\n\
     The message is \"argument = value: hint\", or \"argument has 3 entries: hint\" and the like; its \
     parts are attributes, None where it has no such part. Pickled errors keep them.\n\n\
     Attributes\n----------\n\
     argument : str or None\n    Name of what was rejected: \"stroke\", \"mounts[2].at\".\n\
     value : str or None\n    The value that was rejected, as text.\n\
     hint : str or None\n    What would be right.\n"
);

/// The core's error as Python's.
pub fn python_error(error: core::Error) -> PyErr {
    // Made here, since arguments are read outside of what `#[guarded]` guards.
    boundary::made(match error {
        core::Error::Cancelled => PyKeyboardInterrupt::new_err(()),
        error @ core::Error::OutOfMemory { .. } => PyMemoryError::new_err(error.to_string()),
        other => input_error(&other),
    })
}

/// A piece of a hint: words, or, with a value that may be empty, the name of an argument or a method.
pub type Piece = (String, Option<String>);

/// What hints of the core call by Rust's names, and how Python says it, with names in backticks.
const NAMES: [(&str, &str); 13] = [
    ("`Engine::new`", "`Engine.from_lists`"),
    ("`Engine::without_gas`", "engine.with_cycle(None)"),
    ("`Powertrain::on`", "p.on(…)"),
    ("`Timing::Ports`", "Firing.ports, PortTiming"),
    ("`Timing::Valves`", "Firing.valves, ValveTiming"),
    ("a `Vee` with", "`Engine.vee` with `throws_deg=…`,"),
    ("a `Vee` of 180°", "`Engine.flat`"),
    ("`by_axis: false`", "`corners=\"mounts\"`"),
    ("`torque: false`", "`torque=False`"),
    ("at which it has that centre", "at which it has that centre: `tdc_deg=…`"),
    ("give orders and speeds within", "give `orders=…` and speeds within"),
    ("needs the bore of each cylinder", "needs the bore; give `bore=…` to each Cylinder"),
    ("sweep one axis in parts", "sweep one axis in parts, or use to_dask"),
];

/// A hint of the core in Python's names: those of [`NAMES`], and `` `name: value` ``, a keyword.
pub fn python_pieces(text: &str) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = vec![(text.to_owned(), None)];
    for (rust, python) in NAMES {
        pieces = pieces.into_iter().flat_map(|piece| split(piece, rust, python)).collect();
    }
    pieces.into_iter().flat_map(keywords).filter(|(text, _)| !text.is_empty()).collect()
}

/// A piece with another text, in which names are in backticks, in place of some words.
fn split((text, value): Piece, rust: &str, python: &str) -> Vec<Piece> {
    if value.is_some() || !text.contains(rust) {
        return vec![(text, value)];
    }
    let piece = |(k, words): (usize, &str)| match words.split_once('=') {
        _ if k % 2 == 0 => (words.to_owned(), None),
        Some((name, value)) => (name.to_owned(), Some(value.to_owned())),
        None => (words.to_owned(), Some(String::new())),
    };
    let between: Vec<Piece> = python.split('`').enumerate().map(piece).collect();
    let words = text.split(rust).map(|words| vec![(words.to_owned(), None)]);
    words.collect::<Vec<_>>().join(&between[..])
}

/// A piece with its `` `name: value` `` as keywords.
fn keywords((text, value): Piece) -> Vec<Piece> {
    if value.is_some() {
        return vec![(text, value)];
    }
    let is_name = |name: &str| name.bytes().all(|byte| byte == b'_' || byte.is_ascii_lowercase());
    let marks = text.matches('`').count();
    let of = |(k, words): (usize, &str)| match words.split_once(": ") {
        // Of a text that was cut.
        _ if k == marks && k % 2 == 1 => (format!("`{words}"), None),
        Some((name, value)) if k % 2 == 1 && is_name(name) => {
            (name.to_owned(), Some(value.to_owned()))
        }
        _ if k % 2 == 1 => (format!("`{words}`"), None),
        _ => (words.to_owned(), None),
    };
    text.split('`').enumerate().map(of).collect()
}

/// The text of pieces.
fn joined(pieces: &[Piece]) -> String {
    let text = |(name, value): &Piece| match value.as_deref() {
        Some(value) if !value.is_empty() => format!("{name}={value}"),
        _ => name.clone(),
    };
    pieces.iter().map(text).collect()
}

fn input_error(error: &core::Error) -> PyErr {
    let message = error.to_string();
    let Some((argument, value, hint)) = error.fields() else { return InputError::new_err(message) };
    let pieces = python_pieces(&hint);
    let spoken = joined(&pieces);
    // Messages end with the hint.
    let rest = message.strip_suffix(&*hint).unwrap_or(&message);
    let raised = InputError::new_err(format!("{rest}{spoken}"));
    let set = |py: Python<'_>| {
        let exception = raised.value(py);
        exception.setattr("argument", argument)?;
        exception.setattr("value", value)?;
        exception.setattr("hint", &spoken)?;
        exception.setattr("_pieces", pieces)
    };
    boundary::unpanicked(|| Python::attach(set)).map_or_else(|failed| failed, |()| raised)
}

/// Result of the core as a Python result.
pub trait OrRaise<T> {
    /// Map the error; an error too if the reserve of memory is used up.
    fn or_raise(self) -> PyResult<T>;
}

impl<T> OrRaise<T> for core::Result<T> {
    fn or_raise(self) -> PyResult<T> {
        reserve::ensure()?;
        self.map_err(python_error)
    }
}

/// Degrees as text, a number or a fraction: what [`exact_angle`] gives.
#[derive(Clone, Copy)]
pub struct Angle(pub core::Angle);

impl<'py> FromPyObject<'_, 'py> for Angle {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        value.extract::<&str>()?.parse().or_raise().map(Self)
    }
}

/// Text that reads back as exactly this angle; `argument` is what errors call it.
#[guarded]
#[pyfunction]
pub fn exact_angle(argument: &str, degrees: Degrees) -> PyResult<String> {
    let angle = match degrees {
        Degrees::Number(degrees) => core::Angle::from_degrees(degrees),
        Degrees::Text(text) => text.parse(),
    };
    angle.map(|angle| angle.to_string()).map_err(|error| error.named(argument)).or_raise()
}

/// Degrees as people give them.
#[derive(FromPyObject)]
pub enum Degrees {
    /// A number.
    Number(f64),
    /// Decimals or a fraction.
    Text(String),
}

/// The core's angles.
pub fn angles(angles: Vec<Angle>) -> Vec<core::Angle> {
    angles.into_iter().map(|angle| angle.0).collect()
}

/// Crank radius, rod length, reciprocating mass, pin offset, excess of rod inertia.
pub type Parts = (f64, f64, f64, f64, f64);

/// The core's cylinder.
pub fn cylinder((radius, rod, mass, offset, rod_inertia): Parts) -> PyResult<core::Cylinder> {
    core::Cylinder::new(radius, rod, mass, offset)
        .and_then(|cylinder| cylinder.with_rod_inertia_excess(rod_inertia))
        .or_raise()
}

/// An order as Python has it: a whole number, or a half as a float.
#[derive(IntoPyObject, Clone, Copy)]
pub enum OrderNumber {
    /// Whole.
    Whole(u32),
    /// A half.
    Half(f64),
}

impl<'py> FromPyObject<'_, 'py> for OrderNumber {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        // A failed attempt at a whole number takes longer than all else.
        if value.is_exact_instance_of::<PyFloat>() {
            return value.extract().map(Self::Half);
        }
        value.extract().map(Self::Whole).or_else(|_| value.extract().map(Self::Half))
    }
}

/// A speed ratio as Python has it: a whole number, or a half as a float.
#[derive(FromPyObject, IntoPyObject, Clone, Copy)]
pub enum RatioNumber {
    /// Whole.
    Whole(i32),
    /// A half.
    Half(f64),
}

impl From<core::SpeedRatio> for RatioNumber {
    fn from(ratio: core::SpeedRatio) -> Self {
        ratio.as_whole().map_or_else(|| Self::Half(ratio.number()), Self::Whole)
    }
}

/// The core's speed ratio.
pub fn ratio(number: RatioNumber) -> PyResult<core::SpeedRatio> {
    match number {
        RatioNumber::Whole(ratio) => Ok(core::SpeedRatio::whole(ratio)),
        RatioNumber::Half(ratio) => core::SpeedRatio::from_number(ratio).or_raise(),
    }
}

/// The core's orders.
pub fn orders(orders: &[OrderNumber]) -> PyResult<Vec<core::Order>> {
    let order = |number: &OrderNumber| match *number {
        OrderNumber::Whole(order) => core::Order::whole(order),
        OrderNumber::Half(order) => core::Order::from_number(order),
    };
    orders.iter().map(order).collect::<core::Result<_>>().or_raise()
}

/// The core's orders of these numbers of halves.
pub fn orders_of_halves(halves: Vec<u32>) -> PyResult<Vec<core::Order>> {
    halves.into_iter().map(core::Order::from_halves).collect::<core::Result<_>>().or_raise()
}

/// An order for Python.
pub fn number(order: core::Order) -> OrderNumber {
    order.as_whole().map_or_else(|| OrderNumber::Half(order.number()), OrderNumber::Whole)
}

/// Orders for Python.
pub fn numbers(orders: &[core::Order]) -> Vec<OrderNumber> {
    orders.iter().copied().map(number).collect()
}
