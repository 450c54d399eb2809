//! Long calls: the interpreter is released, and Ctrl-C answered.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use crankpin_core::{Cancel, Result};
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
    let cancel = Cancel::new();
    if steps < SHORT {
        return py.detach(|| work(&cancel)).or_raise();
    }
    py.detach(|| {
        std::thread::scope(|scope| {
            let (sender, receiver) = channel();
            let flag = &cancel;
            scope.spawn(move || sender.send(work(flag)));
            let mut signal = None;
            loop {
                match receiver.recv_timeout(PATIENCE) {
                    Ok(result) => return signal.map_or_else(|| result.or_raise(), Err),
                    Err(RecvTimeoutError::Timeout) => {
                        if let Err(raised) = signals() {
                            cancel.raise();
                            signal = Some(raised);
                        }
                    }
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

/// What Python's signal handlers raise, if anything.
#[expect(clippy::redundant_closure_for_method_calls, reason = "the method has one lifetime only")]
fn signals() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}
