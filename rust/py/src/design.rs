//! Objectives of engines whose angles vary.

use crate::array::frozen;
use crankpin_core as core;
use crankpin_core::design::{Objective, ObjectiveFigure, ObjectiveQuantity, Variable};
use crankpin_core::{Order, memory};
use crankpin_macros::guarded;
use numpy::{PyArray2, PyArray3, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::convert::{OrRaise, RatioNumber, ratio};
use crate::engine::{Engine, choice};
use crate::interrupt;

/// Objectives over the largest values that they could have, the later ones with small weights.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Objectives(core::design::Objectives);

/// Objectives (points, objectives), and their derivatives (points, objectives, variables).
type Evaluated<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray3<f64>>);

#[guarded]
#[pymethods]
impl Objectives {
    /// Variables are turns of the bores and of the crankpins, by cylinder; objectives a quantity, a
    /// reading and an order, None for the total of `orders`.
    #[new]
    fn new(
        py: Python<'_>,
        engine: &Bound<'_, Engine>,
        variables: Vec<(Vec<f64>, Vec<f64>)>,
        objectives: Vec<(String, String, Option<u32>)>,
        orders: Vec<u32>,
        removed: Vec<RatioNumber>,
    ) -> PyResult<Self> {
        let variables: Vec<Variable> =
            variables.into_iter().map(|(bores, pins)| Variable { bores, pins }).collect();
        let objectives = objectives
            .iter()
            .map(|(quantity, reading, order)| {
                let quantities = [
                    ("force", ObjectiveQuantity::Force),
                    ("moment", ObjectiveQuantity::Moment),
                    ("torque", ObjectiveQuantity::Roll),
                    ("crank_torque", ObjectiveQuantity::Crank),
                ];
                let readings = [
                    ("peak", ObjectiveFigure::Peak),
                    ("peak_xy", ObjectiveFigure::PeakXy),
                    ("forward", ObjectiveFigure::Forward),
                    ("backward", ObjectiveFigure::Backward),
                ];
                Ok(Objective {
                    quantity: choice("quantity", quantity, &quantities)?,
                    reading: choice("reading", reading, &readings)?,
                    order: order.map(Order::whole).transpose().or_raise()?,
                })
            })
            .collect::<PyResult<Vec<_>>>()?;
        let orders = Order::all_whole(&orders).or_raise()?;
        let removed = removed.into_iter().map(ratio).collect::<PyResult<Vec<_>>>()?;
        let engine = &engine.get().0;
        let merit = interrupt::run(py, |cancel| {
            core::design::Objectives::new(
                engine,
                &variables,
                &objectives,
                &orders,
                &removed,
                cancel,
            )
        })?;
        Ok(Self(merit))
    }

    /// Weight of each objective.
    #[getter]
    fn weights(&self) -> Vec<f64> {
        self.0.weights()
    }

    /// Largest value that each objective could have, over ω².
    #[getter]
    fn scales(&self) -> Vec<f64> {
        self.0.scales()
    }

    /// Upper bound on the change of the weighted sum per radian of a variable.
    #[getter]
    fn steepest(&self) -> f64 {
        self.0.steepest()
    }

    /// Objectives and their derivatives at points (points, variables), radians.
    fn evaluated<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Evaluated<'py>> {
        let points: Vec<Vec<f64>> =
            points.as_array().rows().into_iter().map(|row| row.to_vec()).collect();
        let variables = points.first().map_or(0, Vec::len);
        let found = interrupt::run(py, |cancel| self.0.evaluated(&points, cancel))?;
        let (count, functions) = (found.len(), self.0.scales().len());
        let (values, slopes): (Vec<f64>, Vec<Vec<f64>>) = found.into_iter().flatten().unzip();
        let values = memory::array("points", (count, functions), values).or_raise()?;
        let slopes = memory::array("points", (count, functions, variables), slopes.concat());
        let slopes = slopes.or_raise()?;
        Ok((frozen(py, values)?, frozen(py, slopes)?))
    }

    /// The smoothed weighted sum of the first few objectives, and its derivatives.
    fn smoothed(&self, x: Vec<f64>, mu: f64, objectives: usize) -> (f64, Vec<f64>) {
        self.0.smoothed(&x, mu, objectives)
    }
}
