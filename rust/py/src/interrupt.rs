//! Long calls: the interpreter is released, Ctrl-C answered, and progress told.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use crankpin_core::{Cancel, Result};
use ndarray::Dimension;
use numpy::{Element, PyArray, PyArrayMethods};
use pyo3::prelude::*;

use crate::convert::OrRaise;

/// Work of fewer steps (some nanoseconds each) is done in the calling thread.
const SHORT: usize = 1 << 20;
/// How often Python is asked whether somebody pressed Ctrl-C.
const PATIENCE: Duration = Duration::from_millis(20);

/// Do `work` of about so many steps without the interpreter; stop it when a signal comes.
pub fn run<T: Send>(
    py: Python<'_>,
    steps: usize,
    work: impl FnOnce(&Cancel) -> Result<T> + Send,
) -> PyResult<T> {
    watched(py, steps, None, work)
}

/// [`run`], with a Python function that is told how many steps of how many are done.
pub fn watched<T: Send>(
    py: Python<'_>,
    steps: usize,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Cancel) -> Result<T> + Send,
) -> PyResult<T> {
    let cancel = Cancel::new();
    let tell = || match progress {
        Some(function) => Python::attach(|py| function.call1(py, cancel.progress()).map(drop)),
        None => Ok(()),
    };
    if steps < SHORT {
        let result = py.detach(|| work(&cancel)).or_raise()?;
        tell()?;
        return Ok(result);
    }
    py.detach(|| {
        std::thread::scope(|scope| {
            let (sender, receiver) = channel();
            let flag = &cancel;
            scope.spawn(move || sender.send(work(flag)));
            let mut raised = None;
            loop {
                match receiver.recv_timeout(PATIENCE) {
                    Ok(result) => {
                        return match raised {
                            Some(raised) => Err(raised),
                            None => result.or_raise().and_then(|result| tell().map(|()| result)),
                        };
                    }
                    Err(RecvTimeoutError::Timeout) if raised.is_none() => {
                        if let Err(error) = signals().and_then(|()| tell()) {
                            cancel.raise();
                            raised = Some(error);
                        }
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => {
                        return Err(pyo3::exceptions::PyRuntimeError::new_err(
                            "worker thread died",
                        ));
                    }
                }
            }
        })
    })
}

/// [`watched`] work that writes every number of a new array, in `NumPy`'s own memory: it asks for
/// large pages, which are several times faster to come by and to give back.
pub fn written<'py, T: Element + Send, D: Dimension>(
    py: Python<'py>,
    shape: impl IntoPyObject<'py>,
    steps: usize,
    progress: Option<&Py<PyAny>>,
    write: impl FnOnce(&mut [T], &Cancel) -> Result<()> + Send,
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    // Not `PyArray::zeros`, which panics where there is no memory, and writes the small ones twice.
    let array = py.import("numpy")?.call_method1("empty", (shape, numpy::dtype::<T>(py)))?;
    let array = array.cast_into::<PyArray<T, D>>()?;
    let mut writable = array.readwrite();
    let out = writable.as_slice_mut()?;
    watched(py, steps, progress, |cancel| write(out, cancel))?;
    drop(writable);
    Ok(array)
}

/// What Python's signal handlers raise, if anything.
#[expect(clippy::redundant_closure_for_method_calls, reason = "the method has one lifetime only")]
fn signals() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}
