//! The boundary to Python: whatever goes wrong in a call is raised as an exception that
//! `except Exception` catches.
//!
//! `#[guarded]` stands above everything that Python calls. `PyO3` panics where Python has no memory for
//! an object, such as a text or a list of a result; that is a [`PyMemoryError`]. Any other panic is a
//! mistake of this program: an [`InputError`] that asks to report it.

use std::any::Any;
use std::panic::{self, AssertUnwindSafe};

use crankpin_core::memory;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyMemoryError;
use pyo3::ffi;
use pyo3::prelude::*;

use crate::convert::InputError;
use crate::reserve;

/// What `PyO3` panics with where Python has not made an object.
const NULL: &str = "PyObject pointer is null";

/// Result of a call; its conversion to a Python object is guarded too.
pub struct Returned<T>(PyResult<T>);

impl<'py, T: IntoPyObject<'py>> IntoPyObject<'py> for Returned<T> {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        let value = self.0?;
        unpanicked(|| value.into_bound_py_any(py))
    }
}

/// Do some work, the result of which goes to Python.
pub fn returned<T>(work: impl FnOnce() -> PyResult<T>) -> Returned<T> {
    Returned(caught(work))
}

/// [`returned`], of work that has no error of its own.
pub fn returned_value<T>(work: impl FnOnce() -> T) -> Returned<T> {
    Returned(caught_value(work))
}

/// Do some work, unless there is no memory for it.
pub fn caught<T>(work: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    unpanicked(|| {
        reserve::ensure()?;
        work()
    })
}

/// [`caught`], of work that has no error of its own.
pub fn caught_value<T>(work: impl FnOnce() -> T) -> PyResult<T> {
    caught(|| Ok(work()))
}

/// Do some work; a panic is an error, and errors can be raised without further memory.
pub fn unpanicked<T>(work: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    result.unwrap_or_else(|payload| Err(error_of(&*payload))).map_err(made)
}

/// The error with the exception that Python raises made already: where there is no memory for it, `PyO3`
/// would end the process when it raises the error.
pub fn made(error: PyErr) -> PyErr {
    let make = || Python::attach(|py| drop(error.value(py).clone()));
    // Python keeps an exception of the second kind.
    panic::catch_unwind(AssertUnwindSafe(make))
        .map_or_else(|_| PyMemoryError::new_err(()), |()| error)
}

/// What a panic says about the call.
fn error_of(payload: &(dyn Any + Send)) -> PyErr {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let text = text.unwrap_or("panic");
    if text == NULL || memory::check().is_err() {
        return PyMemoryError::new_err("out of memory");
    }
    InputError::new_err(format!(
        "{text}: a mistake of crankpin, for which these inputs have no result; please report the call"
    ))
}

/// Text of any length for Python.
pub fn text<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    // SAFETY: the text is UTF-8 of this length, and an object that is null is an error.
    unsafe {
        let object = ffi::PyUnicode_FromStringAndSize(text.as_ptr().cast(), text.len() as isize);
        Bound::from_owned_ptr_or_err(py, object)
    }
}

/// Print nothing of a panic that only says that there is no memory.
pub fn quiet() {
    let print = panic::take_hook();
    panic::set_hook(Box::new(move |panic| {
        if panic.payload().downcast_ref::<&str>() != Some(&NULL) {
            print(panic);
        }
    }));
}
