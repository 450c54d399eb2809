//! Long calls: the interpreter is released, Ctrl-C answered, and progress reported.

use std::sync::{Arc, Mutex, PoisonError};

use crankpin_core::{Cancel, Result};
use ndarray::Dimension;
use numpy::{Element, PyArray, PyArrayMethods};
use pyo3::prelude::*;

use crate::array;
use crate::convert::OrRaise;

/// Do `work` without the interpreter; stop it when a signal handler raises.
///
/// The work runs in the calling thread, and its parallel parts in a pool that the calling thread waits
/// for; [`Cancel::check`] calls the signal handlers from there.
pub fn run<T: Send>(py: Python<'_>, work: impl FnOnce(&Cancel) -> Result<T> + Send) -> PyResult<T> {
    watched(py, None, work)
}

/// [`run`], with a Python function that is called with the steps done and the steps in all.
pub fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Cancel) -> Result<T> + Send,
) -> PyResult<T> {
    let raised = Arc::new(Mutex::new(None));
    let error = Arc::clone(&raised);
    let function = progress.map(|function| function.clone_ref(py));
    let cancel = Cancel::polling(move |progress| {
        let result = Python::attach(|py| {
            py.check_signals()?;
            function.as_ref().map_or(Ok(()), |function| function.call1(py, progress).map(drop))
        });
        let stop = result.is_err();
        *error.lock().unwrap_or_else(PoisonError::into_inner) = result.err();
        stop
    });
    let result = py.detach(|| work(&cancel));
    if let Some(error) = raised.lock().unwrap_or_else(PoisonError::into_inner).take() {
        return Err(error);
    }
    let result = result.or_raise()?;
    if let Some(function) = progress {
        function.call1(py, cancel.progress())?;
    }
    Ok(result)
}

/// [`watched`] work that writes every number of a new array.
pub fn written<'py, T: Element + Send, D: Dimension>(
    py: Python<'py>,
    shape: impl IntoPyObject<'py>,
    progress: Option<&Py<PyAny>>,
    write: impl FnOnce(&mut [T], &Cancel) -> Result<()> + Send,
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    let array = array::empty::<T, D>(py, shape)?;
    let mut writable = array.try_readwrite()?;
    let out = writable.as_slice_mut()?;
    watched(py, progress, |cancel| write(out, cancel))?;
    drop(writable);
    Ok(array)
}
