//! The search of arrangements.

use std::sync::OnceLock;

use crankpin_core as core;
use crankpin_core::Error;
use crankpin_core::search::{self, Angles};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::convert::{Angle, OrRaise, Parts, angles, cylinder, frozen, python_error};
use crate::engine::{Engine, hold};
use crate::interrupt;

/// All arrangements of one bank, grouped by |Z|.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Search {
    search: search::Search,
    angles: OnceLock<Angles>,
}

/// Bank angle, phases of both banks in degrees, counterweight, second-order moments.
type Solution = (f64, Vec<f64>, Vec<f64>, f64, (f64, f64));

impl Search {
    fn angles(&self, py: Python<'_>) -> PyResult<&Angles> {
        if let Some(angles) = self.angles.get() {
            return Ok(angles);
        }
        let steps = self.search.steps();
        let found = interrupt::run(py, steps, |cancel| self.search.angles(cancel))?;
        Ok(self.angles.get_or_init(|| found))
    }

    fn found(&self, py: Python<'_>, k: usize) -> PyResult<search::Solution> {
        self.search.solution(self.angles(py)?, k).ok_or_else(|| {
            python_error(Error::value("index", k, "there are fewer bank angles than that"))
        })
    }
}

#[pymethods]
impl Search {
    #[new]
    fn new(
        py: Python<'_>,
        cylinders: usize,
        alternating: bool,
        phases: Option<Vec<Angle>>,
        held: &str,
    ) -> PyResult<Self> {
        let (phases, hold) = (phases.map(angles), hold(held)?);
        let bank = search::bank(cylinders, alternating, phases.as_deref()).or_raise()?;
        let steps = usize::try_from(bank.count()).unwrap_or(usize::MAX);
        let search = interrupt::run(py, steps, |cancel| search::Search::new(bank, hold, cancel))?;
        Ok(Self { search, angles: OnceLock::new() })
    }

    #[getter]
    fn candidates(&self) -> u128 {
        self.search.candidates()
    }

    #[getter]
    fn qualifying(&self) -> u128 {
        self.search.qualifying()
    }

    #[getter]
    fn balanced(&self) -> u128 {
        self.search.balanced()
    }

    fn bank_angles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(frozen(py, self.angles(py)?.degrees().into()))
    }

    fn solution(&self, py: Python<'_>, k: usize) -> PyResult<Solution> {
        let found = self.found(py, k)?;
        let degrees = |phases: &[u32]| -> Vec<f64> {
            let turns = |&p: &u32| core::Angle::Turns(i64::from(p), i64::from(found.parts));
            phases.iter().map(|phase| turns(phase).degrees()).collect()
        };
        let [first, second] = [&found.banks[0], &found.banks[1]].map(|phases| degrees(phases));
        let [about_x, about_y] = found.second_order;
        Ok((found.bank_angle, first, second, found.counterweight, (about_x, about_y)))
    }

    fn engine(&self, py: Python<'_>, k: usize, parts: Parts, spacing: f64) -> PyResult<Engine> {
        self.found(py, k)?.engine(cylinder(parts)?, spacing).or_raise().map(Engine::from)
    }
}
