//! How an engine shakes, as findings and in sentences.

use crankpin_core::balance::Vector;
use crankpin_core::engine::loads;
use crankpin_core::explain::{self as core, Row, Subject, Wording};
use crankpin_macros::guarded;
use pyo3::prelude::*;

use crate::convert::{OrderNumber, numbers};
use crate::engine::Engine;
use crate::interrupt;

/// Groups are numbers of cylinders.
#[derive(IntoPyObject)]
struct Finding {
    kind: &'static str,
    quantity: &'static str,
    orders: Vec<OrderNumber>,
    values: Vec<f64>,
    reason: &'static str,
    groups: Vec<Vec<usize>>,
    proved: bool,
}

/// An explanation of the core.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Explanation(core::Explanation);

fn finding(Row { kind, vector, orders, values, reason, groups, proved }: Row) -> Finding {
    let quantity = match vector {
        Some(Vector::Force) => "force",
        Some(Vector::Moment) => "moment",
        None => "",
    };
    Finding { kind, quantity, orders: numbers(&orders), values, reason, groups, proved }
}

#[guarded]
#[pymethods]
impl Explanation {
    /// First-order force that others are relative to.
    #[getter]
    fn unit(&self) -> f64 {
        self.0.unit
    }

    /// The part that makes it.
    #[getter]
    fn part(&self) -> &'static str {
        self.0.part.name()
    }

    /// Longest lever about the reference plane, m.
    #[getter]
    fn lever(&self) -> f64 {
        self.0.lever
    }

    #[getter]
    fn findings(&self) -> Vec<Finding> {
        self.0.findings.iter().map(|each| finding(each.row())).collect()
    }

    /// A sentence for each finding, or for the first on force and moment; `units` are those shown in place of
    /// others, with the factors of numbers.
    #[pyo3(signature = (loads, units, count=None))]
    fn sentences(
        &self,
        loads: String,
        units: Vec<(String, String, f64)>,
        count: Option<usize>,
    ) -> Vec<String> {
        let convert = |unit: &str| {
            let (_, shown, factor) = units.iter().find(|(of, ..)| of == unit)?;
            Some((shown.clone(), *factor))
        };
        let wording = Wording { loads, convert: &convert };
        let findings = self.0.findings.iter();
        match count {
            None => self.0.sentences(findings, &wording),
            Some(count) => {
                let on_vectors = findings.filter(|finding| finding.vector().is_some()).take(count);
                self.0.sentences(on_vectors, &wording)
            }
        }
    }
}

/// Explain how an engine shakes, or only its force and moment.
#[guarded]
#[pyfunction]
pub fn explain(
    engine: &Bound<'_, Engine>,
    rpm: Option<f64>,
    vectors: bool,
) -> PyResult<Explanation> {
    let subject = if vectors { Subject::Vectors } else { Subject::Everything };
    let whole = &engine.get().0;
    let work = |cancel: &_| core::explain(whole, rpm, subject, cancel);
    interrupt::run(engine.py(), work).map(Explanation)
}

/// Which gas pressure counts, of the names of the cylinders' cycles and the number of different ones.
#[guarded]
#[pyfunction]
pub fn gas_text(names: Vec<Option<String>>, count: usize) -> String {
    loads::gas_text(&names, count)
}

/// Which cylinders do not fire, of whether each does.
#[guarded]
#[pyfunction]
pub fn dead_text(fires: Vec<bool>) -> String {
    loads::dead_text(fires.into_iter())
}
