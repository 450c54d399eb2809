//! Which orders vanish.

use crankpin_core as core;
use crankpin_core::exact::vanishing::{QUANTITIES, Vanishing, Verdict};
use ndarray::Array2;
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::convert::frozen;
use crate::engine::Engine;
use crate::interrupt;

type Table<'py> = Bound<'py, PyArray2<bool>>;

/// Proved to vanish, proved to remain, zero within rounding, each (`n_orders`, 9), and obstacles.
#[pyfunction]
pub fn vanishing<'py>(
    engine: &Bound<'py, Engine>,
    orders: Vec<u32>,
    reference_z: Option<f64>,
) -> PyResult<(Table<'py>, Table<'py>, Table<'py>, Vec<String>)> {
    let py = engine.py();
    let engine = engine.get().0.clone();
    let Vanishing { verdicts, within_rounding, obstacles, .. } = interrupt::run(py, |cancel| {
        core::exact::vanishing::vanishing(&engine, &orders, reference_z, cancel)
    })?;
    let table = |value: &dyn Fn(usize, usize) -> bool| {
        let shape = (verdicts.len(), QUANTITIES.len());
        frozen(py, Array2::from_shape_fn(shape, |(k, quantity)| value(k, quantity)))
    };
    Ok((
        table(&|k, quantity| verdicts[k][quantity] == Verdict::Vanishes),
        table(&|k, quantity| verdicts[k][quantity] == Verdict::Remains),
        table(&|k, quantity| within_rounding[k][quantity]),
        obstacles,
    ))
}
