//! Matching of measured parts.

use crankpin_core::matching::{Match, Measure, Partition};
use crankpin_core::{Order, measured_parts};
use crankpin_macros::guarded;
use pyo3::prelude::*;

use crate::convert::OrRaise;
use crate::engine::{Engine, choice};
use crate::interrupt;

/// Chosen parts by kind, set after set, a bound on the sum of the remainders, and whether none is less.
type Found = (Partition, f64, bool);

/// Measured masses, what they are matched by, and the engine that they are for.
#[pyclass(frozen, module = "crankpin._core")]
pub struct MeasuredParts(measured_parts::MeasuredParts);

#[guarded]
#[pymethods]
impl MeasuredParts {
    /// Matched by "balance" of some orders or by "spread"; ends are the lists of small and big ones.
    #[new]
    fn new(
        py: Python<'_>,
        engine: &Bound<'_, Engine>,
        by: &str,
        orders: Vec<u32>,
        pistons: Vec<f64>,
        ends: Option<[Vec<f64>; 2]>,
    ) -> PyResult<Self> {
        let measures = [("balance", Measure::Length), ("spread", Measure::Spread)];
        let measure = choice("by", by, &measures)?;
        let orders = Order::all_whole(&orders).or_raise()?;
        let engine = &engine.get().0;
        interrupt::run(py, |cancel| {
            let ends = ends.as_ref().map(|[small, big]| [&small[..], &big[..]]);
            measured_parts::MeasuredParts::new(engine, measure, &orders, &pistons, ends, cancel)
        })
        .map(Self)
    }

    /// What remains of an engine with the chosen parts of each kind.
    fn value(&self, chosen: Partition) -> PyResult<f64> {
        self.0.value(&chosen).or_raise()
    }

    /// The best assignment to a number of engines, also from some sequences of the parts of each kind.
    fn matched(
        &self,
        py: Python<'_>,
        sets: usize,
        starts: Vec<Partition>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Found> {
        let matched = |cancel: &_| self.0.matched(sets, &starts, cancel);
        let Match { chosen, bound, exact, .. } =
            interrupt::watched(py, progress.as_ref(), matched)?;
        Ok((chosen, bound, exact))
    }
}
