//! Which orders vanish, and phase vectors of a firing order.

use crate::array::frozen;
use crankpin_core as core;
use crankpin_core::exact::star::Stars;
use crankpin_core::exact::vanishing::{ProofQuantity, QUANTITIES, Vanishing, Verdict};
use crankpin_core::{Complex64, Order};
use crankpin_macros::guarded;
use ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::convert::orders_of_halves;
use crate::engine::Engine;
use crate::firing::Firing;
use crate::interrupt;

type Table<'py> = Bound<'py, PyArray2<bool>>;
type Column<'py> = Bound<'py, PyArray1<bool>>;

/// Each (`n_orders`, 10); undecided is what neither vanishes nor remains.
#[derive(IntoPyObject)]
pub struct Proofs<'py> {
    vanishes: Table<'py>,
    remains: Table<'py>,
    within_rounding: Table<'py>,
    obstacles: Vec<String>,
}

/// Vectors by order and cylinder, and by order their sums and what is proved of them.
#[derive(IntoPyObject)]
pub struct Star<'py> {
    vectors: Bound<'py, PyArray2<Complex64>>,
    sums: Bound<'py, PyArray1<Complex64>>,
    vanishes: Column<'py>,
    remains: Column<'py>,
    is_major: Column<'py>,
}

/// What is proved of orders of an engine.
#[guarded]
#[pyfunction]
pub fn vanishing<'py>(
    engine: &Bound<'py, Engine>,
    halves: Vec<u32>,
    reference_z: Option<f64>,
    firing: Option<&Firing>,
) -> PyResult<Proofs<'py>> {
    let py = engine.py();
    let (engine, orders) = (&engine.get().0, orders_of_halves(halves)?);
    let firing = firing.map(|firing| &firing.0);
    let Vanishing { verdicts, within_rounding, obstacles, .. } = interrupt::run(py, |cancel| {
        core::exact::vanishing::vanishing(engine, &orders, reference_z, firing, cancel)
    })?;
    let table = |value: &dyn Fn(usize, ProofQuantity) -> bool| {
        let shape = (verdicts.len(), QUANTITIES.len());
        frozen(py, Array2::from_shape_fn(shape, |(k, place)| value(k, QUANTITIES[place])))
    };
    Ok(Proofs {
        vanishes: table(&|k, quantity| verdicts[k][quantity] == Verdict::Vanishes)?,
        remains: table(&|k, quantity| verdicts[k][quantity] == Verdict::Remains)?,
        within_rounding: table(&|k, quantity| within_rounding[k][quantity])?,
        obstacles,
    })
}

/// Phase vectors of cylinders of these weights, order by order.
#[guarded]
#[pyfunction]
pub fn star<'py>(
    py: Python<'py>,
    firing: &Firing,
    halves: Vec<u32>,
    weights: Vec<f64>,
) -> PyResult<Star<'py>> {
    let (firing, orders, count) = (&firing.0, orders_of_halves(halves)?, weights.len());
    let stars = interrupt::run(py, |cancel| {
        let stars = Stars::of_firing(firing, weights, cancel)?;
        let at = |&order: &Order| {
            cancel.check()?;
            stars.at(order)
        };
        orders.iter().map(at).collect::<core::Result<Vec<_>>>()
    })?;
    let column = |value: &dyn Fn(&core::exact::star::Star) -> bool| {
        frozen(py, stars.iter().map(value).collect::<Array1<bool>>())
    };
    let vectors = Array2::from_shape_fn((stars.len(), count), |(k, i)| stars[k].vectors[i]);
    Ok(Star {
        vectors: frozen(py, vectors)?,
        sums: frozen(py, stars.iter().map(|star| star.sum).collect::<Array1<Complex64>>())?,
        vanishes: column(&|star| star.verdict == Verdict::Vanishes)?,
        remains: column(&|star| star.verdict == Verdict::Remains)?,
        is_major: column(&|star| star.is_major)?,
    })
}
