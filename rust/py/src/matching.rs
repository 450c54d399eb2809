//! Matching of measured parts.

use crankpin_core::matching::{Matching, Measure, PartKind};
use crankpin_macros::guarded;
use pyo3::prelude::*;

use crate::convert::OrRaise;
use crate::interrupt;

/// Chosen parts by kind, sum of the remainders, a bound on it, and whether all were compared.
type Found = (Vec<Vec<usize>>, f64, f64, bool);

/// Deviations and influences of a kind.
type Parts = (Vec<Vec<f64>>, Vec<Vec<Vec<f64>>>);

/// The best matching of kinds of parts, each with its deviations (figures, parts) and influences
/// (figures, places, dimensions), from the sequences of parts of each start; remainders count by their
/// spread over the dimensions, or by their length.
#[guarded]
#[pyfunction]
pub fn matched(
    py: Python<'_>,
    spread: bool,
    start: Vec<f64>,
    kinds: Vec<Parts>,
    sets: usize,
    starts: Vec<Vec<Vec<usize>>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Found> {
    let kinds: crankpin_core::Result<Vec<PartKind>> = kinds
        .into_iter()
        .map(|(deviations, influences)| PartKind::new(deviations, influences))
        .collect();
    let measure = if spread { Measure::Spread } else { Measure::Length };
    let problem = Matching::new(measure, start, kinds.or_raise()?, sets).or_raise()?;
    let found = interrupt::watched(py, progress.as_ref(), |cancel| problem.solve(&starts, cancel))?;
    Ok((found.chosen, found.value, found.bound, found.exact))
}
