//! The search of arrangements.

use crate::array::frozen;
use crankpin_core as core;
use crankpin_core::search::{self, Angles, Criterion};
use crankpin_core::{Cancel, Error, memory};
use crankpin_macros::guarded;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::convert::{Angle, OrRaise, Parts, angles, cylinder};
use crate::engine::{Engine, choice, hold};
use crate::interrupt;

/// All arrangements of one bank, grouped by |Z|.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Search {
    core: search::Search,
    /// True if both banks share their pins.
    shared: bool,
}

#[guarded]
#[pymethods]
impl Search {
    #[new]
    fn new(
        py: Python<'_>,
        cylinders: usize,
        alternating: bool,
        phases: Option<Vec<Angle>>,
        held: &str,
        shared: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let (phases, hold) = (phases.map(angles), hold(held)?);
        let bank = search::bank(cylinders, alternating, phases.as_deref()).or_raise()?;
        let search = interrupt::watched(py, progress.as_ref(), |cancel| {
            search::Search::new(bank, hold, cancel)
        })?;
        Ok(Self { core: search, shared })
    }

    #[getter]
    fn candidates(&self) -> u128 {
        if self.shared { self.core.shared_candidates() } else { self.core.candidates() }
    }

    #[getter]
    fn qualifying(&self) -> u128 {
        if self.shared { self.core.shared_candidates() } else { self.core.qualifying() }
    }

    #[getter]
    fn balanced(&self) -> u128 {
        if self.shared { self.core.shared_balanced() } else { self.core.balanced() }
    }

    /// Arrangements of one bank, turned, reversed and mirrored ones counted once.
    #[getter]
    fn distinct(&self) -> usize {
        self.core.distinct()
    }
}

/// The bank angles of a search within a window.
#[pyclass(frozen, module = "crankpin._core")]
pub struct BankAngles {
    search: Py<Search>,
    listed: Listed,
}

enum Listed {
    Angles(Angles),
    /// Places of arrangements on shared pins, each at 90°.
    Shared(Vec<usize>),
}

/// An arrangement at a bank angle, of phases in degrees.
#[derive(IntoPyObject)]
struct Solution<'py> {
    bank_angle_deg: f64,
    first_deg: Bound<'py, PyTuple>,
    second_deg: Bound<'py, PyTuple>,
    counterweight: f64,
    second_order: (f64, f64),
}

#[guarded]
#[pymethods]
impl BankAngles {
    #[new]
    fn new(
        py: Python<'_>,
        search: Py<Search>,
        window: [f64; 2],
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let Search { core, shared } = search.get();
        let listed = interrupt::watched(py, progress.as_ref(), |cancel| {
            Ok(match shared {
                false => Listed::Angles(core.angles(window, cancel)?),
                true if (window[0]..=window[1]).contains(&90.0) => {
                    Listed::Shared(core.shared(cancel)?)
                }
                true => Listed::Shared(Vec::new()),
            })
        })?;
        Ok(Self { search, listed })
    }

    fn __len__(&self) -> usize {
        match &self.listed {
            Listed::Angles(angles) => angles.count(),
            Listed::Shared(places) => places.len(),
        }
    }

    fn degrees<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let degrees = interrupt::run(py, |cancel| match &self.listed {
            Listed::Angles(angles) => angles.degrees(cancel),
            Listed::Shared(places) => memory::collected(places.iter().map(|_| 90.0)),
        })?;
        frozen(py, degrees.into())
    }

    fn solution<'py>(&self, py: Python<'py>, k: usize, by: &str) -> PyResult<Solution<'py>> {
        let measures =
            [("second_order", Criterion::SecondOrder), ("counterweight", Criterion::Counterweight)];
        let by = choice("by", by, &measures)?;
        let found = interrupt::run(py, |cancel| self.found(k, by, cancel))?;
        let degrees = |phases: &[u32]| {
            let angle = |&p: &u32| core::Angle::from_turns(p.into(), found.parts.into());
            let angles = phases.iter().map(|phase| angle(phase).map(core::Angle::degrees));
            PyTuple::new(py, angles.collect::<core::Result<Vec<_>>>().or_raise()?)
        };
        let [first, second] = &found.banks;
        Ok(Solution {
            bank_angle_deg: found.bank_angle,
            first_deg: degrees(first)?,
            second_deg: degrees(second)?,
            counterweight: found.counterweight,
            second_order: found.second_order.into(),
        })
    }
}

impl BankAngles {
    fn found(&self, k: usize, by: Criterion, cancel: &Cancel) -> core::Result<search::Solution> {
        let missing = || Error::value("index", k, "there are fewer bank angles than that");
        let core = &self.search.get().core;
        let found = match &self.listed {
            Listed::Angles(angles) => core.solution(angles, k, by, cancel)?,
            Listed::Shared(places) => places.get(k).and_then(|&place| core.shared_solution(place)),
        };
        found.ok_or_else(missing)
    }
}

/// The vee of two banks' phases, the right one first.
#[guarded]
#[pyfunction]
pub fn arrangement(
    held: &str,
    bank_angle: f64,
    first: Vec<Angle>,
    second: Vec<Angle>,
    parts: Parts,
    spacing: f64,
) -> PyResult<Engine> {
    let banks = [angles(first), angles(second)];
    search::vee(hold(held)?, bank_angle, &banks, cylinder(parts)?, spacing)
        .or_raise()
        .map(Engine::from)
}
