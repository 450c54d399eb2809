//! When cylinders fire, and the pins that a firing order needs.

use std::sync::Arc;

use crankpin_core as core;
use crankpin_core::firing::{self, NamedOrder, Period, PortTiming, ValveTiming};
use crankpin_core::layout::Strokes;
use crankpin_core::memory;
use ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::convert::{Angle, OrRaise, frozen};
use crate::engine::{Engine, VeeLayout, firing_rule};
use crate::interrupt;

/// A way to fire, of the core.
#[pyclass(frozen, eq, module = "crankpin._core")]
#[derive(PartialEq)]
pub struct Firing(core::Firing);

/// Opening and closing angles: before top, after bottom, before bottom, after top dead centre.
type Timing = (Angle, Angle, Angle, Angle);

/// Opening angles of transfer and exhaust ports before bottom dead centre.
type PortOpenings = (Angle, Angle);

/// Groups of cylinders by number.
type Groups = Option<Vec<Vec<usize>>>;

/// Two arrays.
type Two<'py, A> = (Bound<'py, A>, Bound<'py, A>);

/// Cylinders by number, crank angle between them and of both together.
type Overlap = (usize, usize, f64, f64);

fn timing(
    (intake_opens, intake_closes, exhaust_opens, exhaust_closes): Timing,
) -> PyResult<ValveTiming> {
    ValveTiming::new(intake_opens.0, intake_closes.0, exhaust_opens.0, exhaust_closes.0).or_raise()
}

fn ports((transfer_opens, exhaust_opens): PortOpenings) -> PyResult<PortTiming> {
    PortTiming::new(transfer_opens.0, exhaust_opens.0).or_raise()
}

fn column(
    py: Python<'_>,
    angles: impl IntoIterator<Item = core::Angle>,
) -> Bound<'_, PyArray1<f64>> {
    frozen(py, angles.into_iter().map(core::Angle::degrees).collect::<Array1<f64>>())
}

fn periods<'py>(py: Python<'py>, periods: &[Period]) -> Bound<'py, PyArray2<f64>> {
    frozen(py, Array2::from_shape_fn((periods.len(), 2), |(i, k)| periods[i][k].degrees()))
}

#[pymethods]
impl Firing {
    /// The most even of [`Self::all_named`].
    #[staticmethod]
    fn named(py: Python<'_>, engine: &Engine, firing_order: &str, strokes: u32) -> PyResult<Self> {
        let strokes = Strokes::from_number(strokes).or_raise()?;
        let order: NamedOrder = firing_order.parse().or_raise()?;
        let engine = Arc::clone(&engine.0);
        interrupt::run(py, |cancel| core::Firing::named(&engine, &order, strokes, cancel)).map(Self)
    }

    /// The most even way to fire, if no other order is as even.
    #[staticmethod]
    fn most_even(py: Python<'_>, engine: &Engine, strokes: u32) -> PyResult<Self> {
        let strokes = Strokes::from_number(strokes).or_raise()?;
        let engine = Arc::clone(&engine.0);
        interrupt::run(py, |cancel| core::Firing::most_even(&engine, strokes, cancel)).map(Self)
    }

    #[staticmethod]
    fn all_named(engine: &Engine, firing_order: &str, strokes: u32) -> PyResult<Vec<Self>> {
        let strokes = Strokes::from_number(strokes).or_raise()?;
        let order: NamedOrder = firing_order.parse().or_raise()?;
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

    #[getter]
    fn order(&self) -> Vec<usize> {
        self.0.order().iter().map(|i| i + 1).collect()
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
    fn angles_deg<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        column(py, self.0.angles())
    }

    #[getter]
    fn intervals_deg<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
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
        self.0.banks().iter().map(|bank| bank.iter().map(|i| i + 1).collect()).collect()
    }

    fn gaps(&self, groups: Groups) -> PyResult<Vec<Vec<(usize, usize, f64)>>> {
        let groups = self.0.groups(groups.as_deref()).or_raise()?;
        let figures = |gap: &firing::Gap| (gap.before + 1, gap.after + 1, gap.gap.degrees());
        let found = self.0.gaps(&groups);
        Ok(found.iter().map(|gaps| gaps.iter().map(figures).collect()).collect())
    }

    fn stroke_periods<'py>(
        &self,
        py: Python<'py>,
    ) -> Vec<(&'static str, Bound<'py, PyArray2<f64>>)> {
        let found = self.0.stroke_periods();
        found.into_iter().map(|(name, each)| (name, periods(py, &each))).collect()
    }

    fn valves<'py>(&self, py: Python<'py>, given: Timing) -> PyResult<Two<'py, PyArray2<f64>>> {
        let valves = self.0.valves(&timing(given)?).or_raise()?;
        Ok((periods(py, &valves.intake), periods(py, &valves.exhaust)))
    }

    fn ports<'py>(
        &self,
        py: Python<'py>,
        given: PortOpenings,
    ) -> PyResult<Two<'py, PyArray2<f64>>> {
        let found = self.0.ports(&ports(given)?).or_raise()?;
        Ok((periods(py, &found.transfer), periods(py, &found.exhaust)))
    }

    fn valve_overlaps(&self, groups: Groups, given: Timing) -> PyResult<Vec<Vec<Overlap>>> {
        let valves = self.0.valves(&timing(given)?).or_raise()?;
        self.overlaps(groups, &valves.exhaust)
    }

    fn port_overlaps(&self, groups: Groups, given: PortOpenings) -> PyResult<Vec<Vec<Overlap>>> {
        let ports = self.0.ports(&ports(given)?).or_raise()?;
        self.overlaps(groups, &ports.exhaust)
    }
}

impl Firing {
    fn overlaps(&self, groups: Groups, open: &[Period]) -> PyResult<Vec<Vec<Overlap>>> {
        let groups = self.0.groups(groups.as_deref()).or_raise()?;
        let found = self.0.overlaps(&groups, open);
        let figures = |each: &firing::Overlap| {
            (each.before + 1, each.after + 1, each.gap.degrees(), each.overlap.degrees())
        };
        Ok(found.iter().map(|overlaps| overlaps.iter().map(figures).collect()).collect())
    }
}

/// Raise if valves cannot open and close so.
#[pyfunction]
pub fn valve_timing(given: Timing) -> PyResult<()> {
    timing(given).map(drop)
}

/// Raise if ports cannot open and close so.
#[pyfunction]
pub fn port_timing(given: PortOpenings) -> PyResult<()> {
    ports(given).map(drop)
}

/// Crankpins that a firing order needs, and no pin splits.
#[pyfunction]
pub fn inline_throws<'py>(
    py: Python<'py>,
    firing_order: &str,
    intervals: Option<Vec<Angle>>,
    strokes: u32,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let rule = firing_rule("even", intervals, strokes)?;
    let order = firing_order.parse().or_raise()?;
    Ok(column(py, firing::inline_throws(&order, &rule).or_raise()?))
}

/// Right crankpins that a firing order needs, and left minus right.
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
    let found = firing::vee_throws(&order, &rule, &layout.vee()?).or_raise()?;
    Ok((column(py, found.throws), column(py, found.pin_splits)))
}
