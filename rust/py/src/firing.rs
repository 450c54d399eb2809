//! When cylinders fire, and the pins that a firing order needs.

use std::sync::Arc;

use crate::array::frozen;
use crankpin_core as core;
use crankpin_core::firing::{self, Period, Timing};
use crankpin_core::layout::{FiringOrder, Strokes};
use crankpin_core::memory;
use crankpin_macros::guarded;
use ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::convert::{self, Angle, OrRaise, angles};
use crate::engine::{Engine, VeeLayout, firing_rule, numbers};
use crate::interrupt;

/// A way to fire, of the core.
#[pyclass(frozen, eq, module = "crankpin._core")]
#[derive(PartialEq)]
pub struct Firing(pub core::Firing);

/// Groups of cylinders by number.
type Groups = Option<Vec<Vec<usize>>>;

/// Two arrays.
type Two<'py, A> = (Bound<'py, A>, Bound<'py, A>);

/// Numbers of two cylinders, and degrees between them or of both together.
type Pair = ((usize, usize), f64);

/// Opening and closing angles of valves or ports.
fn timing(angles: Vec<Angle>) -> PyResult<Timing> {
    Timing::new(&convert::angles(angles)).or_raise()
}

fn column(
    py: Python<'_>,
    angles: impl IntoIterator<Item = core::Angle>,
) -> PyResult<Bound<'_, PyArray1<f64>>> {
    frozen(py, angles.into_iter().map(core::Angle::degrees).collect::<Array1<f64>>())
}

fn periods<'py>(py: Python<'py>, periods: &[Period]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    frozen(py, Array2::from_shape_fn((periods.len(), 2), |(i, k)| periods[i][k].degrees()))
}

#[guarded]
#[pymethods]
impl Firing {
    /// The most even of [`Self::all_named`].
    #[staticmethod]
    fn named(py: Python<'_>, engine: &Engine, firing_order: &str, strokes: u32) -> PyResult<Self> {
        let strokes = Strokes::from_number(strokes).or_raise()?;
        let order: FiringOrder = firing_order.parse().or_raise()?;
        let engine = Arc::clone(&engine.0);
        interrupt::run(py, |cancel| core::Firing::named(&engine, &order, strokes, cancel)).map(Self)
    }

    /// That by which an engine fires.
    #[staticmethod]
    fn own(engine: &Bound<'_, Engine>) -> PyResult<Self> {
        let core = &engine.get().0;
        interrupt::run(engine.py(), |cancel| core::Firing::own(core, cancel)).map(Self)
    }

    /// The schedule at intervals from each cylinder of an order to the next.
    #[staticmethod]
    fn at_intervals(
        engine: &Bound<'_, Engine>,
        firing_order: &str,
        strokes: u32,
        intervals: Vec<Angle>,
    ) -> PyResult<Self> {
        let strokes = Strokes::from_number(strokes).or_raise()?;
        let order: FiringOrder = firing_order.parse().or_raise()?;
        let (core, intervals) = (&engine.get().0, angles(intervals));
        let found = interrupt::run(engine.py(), |cancel| {
            core::Firing::at_intervals(core, &order, strokes, &intervals, cancel)
        });
        found.map(Self)
    }

    /// The engine that fires so, and keeps the turns in which its cylinders do.
    fn kept(&self, py: Python<'_>) -> PyResult<Engine> {
        interrupt::run(py, |cancel| self.0.kept(cancel)).map(Engine::from)
    }

    #[staticmethod]
    fn all_named(engine: &Engine, firing_order: &str, strokes: u32) -> PyResult<Vec<Self>> {
        let strokes = Strokes::from_number(strokes).or_raise()?;
        let order: FiringOrder = firing_order.parse().or_raise()?;
        let found = core::Firing::all_named(&engine.0, &order, strokes).or_raise()?;
        Ok(found.into_iter().map(Self).collect())
    }

    #[staticmethod]
    fn all(py: Python<'_>, engine: &Engine, strokes: u32) -> PyResult<Vec<Self>> {
        let strokes = Strokes::from_number(strokes).or_raise()?;
        let engine = Arc::clone(&engine.0);
        let found = interrupt::run(py, |cancel| core::Firing::all(&engine, strokes, cancel))?;
        memory::collected(found.into_iter().map(Self)).or_raise()
    }

    #[staticmethod]
    fn with_later(engine: &Engine, strokes: u32, later: Vec<bool>) -> PyResult<Self> {
        let strokes = Strokes::from_number(strokes).or_raise()?;
        core::Firing::with_later(&engine.0, strokes, &later).or_raise().map(Self)
    }

    #[getter]
    fn strokes(&self) -> u32 {
        self.0.strokes().number()
    }

    /// Numbers of the cylinders that fire.
    #[getter]
    fn order(&self) -> Vec<usize> {
        numbers(self.0.fired())
    }

    #[getter]
    fn text(&self) -> String {
        self.0.to_string()
    }

    #[getter]
    fn later(&self) -> Vec<bool> {
        self.0.later()
    }

    #[getter]
    fn angles_deg<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        column(py, self.0.angles())
    }

    #[getter]
    fn intervals_deg<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        column(py, self.0.intervals().iter().copied())
    }

    #[getter]
    fn even(&self) -> bool {
        self.0.even()
    }

    #[getter]
    fn unevenness_deg(&self) -> f64 {
        self.0.unevenness()
    }

    #[getter]
    fn banks(&self) -> Vec<Vec<usize>> {
        self.0.banks().iter().map(|bank| numbers(bank)).collect()
    }

    fn gaps(&self, groups: Groups) -> PyResult<Vec<Vec<Pair>>> {
        let groups = self.0.groups(groups.as_deref()).or_raise()?;
        let figures = |gap: &firing::Gap| ((gap.before + 1, gap.after + 1), gap.gap.degrees());
        let found = self.0.gaps(&groups);
        Ok(found.iter().map(|gaps| gaps.iter().map(figures).collect()).collect())
    }

    fn stroke_periods<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Vec<(&'static str, Bound<'py, PyArray2<f64>>)>> {
        let found = self.0.stroke_periods();
        found.into_iter().map(|(name, each)| Ok((name, periods(py, &each)?))).collect()
    }

    /// When intake valves or transfer ports, and exhausts are open.
    fn open<'py>(&self, py: Python<'py>, given: Vec<Angle>) -> PyResult<Two<'py, PyArray2<f64>>> {
        let [intake, exhaust] = self.0.open(&timing(given)?).or_raise()?;
        Ok((periods(py, &intake)?, periods(py, &exhaust)?))
    }

    fn overlaps(&self, groups: Groups, given: Vec<Angle>) -> PyResult<Vec<Vec<Pair>>> {
        let [_, exhaust] = self.0.open(&timing(given)?).or_raise()?;
        let groups = self.0.groups(groups.as_deref()).or_raise()?;
        let found = self.0.overlaps(&groups, &exhaust);
        let figures =
            |both: &firing::Overlap| ((both.before + 1, both.after + 1), both.overlap.degrees());
        Ok(found.iter().map(|overlaps| overlaps.iter().map(figures).collect()).collect())
    }
}

/// Raise if valves or ports cannot open and close so.
#[guarded]
#[pyfunction]
pub fn check_timing(given: Vec<Angle>) -> PyResult<()> {
    timing(given).map(drop)
}

/// Crankpins that a firing order needs, and no pin splits.
#[guarded]
#[pyfunction]
pub fn inline_throws<'py>(
    py: Python<'py>,
    firing_order: &str,
    intervals: Option<Vec<Angle>>,
    strokes: u32,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let rule = firing_rule("even", intervals, strokes)?;
    let order = firing_order.parse().or_raise()?;
    column(py, firing::inline_throws(&order, &rule).or_raise()?)
}

/// Right crankpins that a firing order needs, and left minus right.
#[guarded]
#[pyfunction]
pub fn vee_throws<'py>(
    py: Python<'py>,
    firing_order: &str,
    intervals: Option<Vec<Angle>>,
    strokes: u32,
    layout: VeeLayout,
) -> PyResult<Two<'py, PyArray1<f64>>> {
    let rule = firing_rule("even", intervals, strokes)?;
    let order = firing_order.parse().or_raise()?;
    let found = firing::vee_throws(&order, &rule, &layout.0).or_raise()?;
    Ok((column(py, found.throws)?, column(py, found.pin_splits)?))
}
