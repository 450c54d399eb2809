//! Loads of bearings and walls, and sections of crank and crankcase.

use crate::array::frozen;
use crankpin_core::bearing_loads::{
    self, Bearing, BearingLoads, CutPart, Extremes, Peak, RodLoads, Sections, TurningAxes,
};
use crankpin_core::engine::CrankIndex;
use crankpin_core::index::ListIndex;
use crankpin_macros::guarded;
use numpy::{PyArray2, PyArray3, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::OrRaise;
use crate::engine::{Engine, choice};
use crate::interrupt;

/// Loads at the pin of a piston: least and largest values, N, each with its angle, degrees.
#[derive(IntoPyObject)]
struct RodFigures {
    load: [(f64, f64); 2],
    gas: [(f64, f64); 2],
    inertia: [(f64, f64); 2],
    tension_deg: Vec<(f64, f64)>,
}

/// An engine with main bearings at a speed.
#[pyclass(frozen, module = "crankpin._core")]
pub struct BearingLoadsModel(bearing_loads::BearingLoadsModel);

#[guarded]
#[pymethods]
impl BearingLoadsModel {
    #[new]
    fn new(engine: &Bound<'_, Engine>, rpm: f64) -> PyResult<Self> {
        bearing_loads::BearingLoadsModel::new(&engine.get().0, rpm).or_raise().map(Self)
    }

    /// Places of loads and main bearings along z.
    fn places(&self) -> Vec<f64> {
        self.0.places()
    }

    /// Share of each crankpin's load that each main bearing carries.
    fn shares<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        frozen(py, self.0.shares())
    }

    /// Loads by name; those of bearings along x and y.
    fn loads<'py>(
        &self,
        py: Python<'py>,
        theta_deg: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let thetas = theta_deg.as_slice()?;
        let found = interrupt::run(py, |cancel| self.0.loads(thetas, cancel))?;
        let BearingLoads { crankpin, wrist_pin, main, side_thrust, rod, gas } = found;
        let loads = PyDict::new(py);
        for (name, rows) in [("crankpin", crankpin), ("wrist_pin", wrist_pin), ("main", main)] {
            loads.set_item(name, frozen(py, rows)?)?;
        }
        for (name, rows) in [("side_thrust", side_thrust), ("rod_force", rod), ("gas_force", gas)] {
            loads.set_item(name, frozen(py, rows)?)?;
        }
        Ok(loads)
    }

    /// Loads of the bearings of a name in axes that turn with the crank or the rod.
    fn turned<'py>(
        &self,
        py: Python<'py>,
        bearing: &str,
        axes: &str,
        theta_deg: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let bearings = [
            ("crankpin", Bearing::Crankpin),
            ("wrist_pin", Bearing::WristPin),
            ("main", Bearing::Main),
        ];
        let bearing = choice("bearing", bearing, &bearings)?;
        let axes =
            choice("axes", axes, &[("crank", TurningAxes::Crank), ("rod", TurningAxes::Rod)])?;
        let thetas = theta_deg.as_slice()?;
        let found = interrupt::run(py, |cancel| self.0.turned(bearing, axes, thetas, cancel))?;
        frozen(py, found)
    }

    /// Loads along the bore at the pin of each piston, N, and angles, degrees: least and largest of all, of gas and
    /// of inertia; and the ranges of angles of tension.
    fn rod_loads(&self, py: Python<'_>, cycle_deg: u32) -> PyResult<Vec<RodFigures>> {
        let found = interrupt::run(py, |cancel| self.0.rod_loads(cycle_deg, cancel))?;
        let pair = |ends: [Peak; 2]| ends.map(|peak| (peak.value, peak.theta_deg));
        let figures = |of: RodLoads| RodFigures {
            load: pair(of.combined),
            gas: pair(of.gas),
            inertia: pair(of.inertia),
            tension_deg: of.tension_deg.into_iter().map(|[from, to]| (from, to)).collect(),
        };
        Ok(found.into_iter().map(figures).collect())
    }

    /// The same at crank angles, degrees, by name: rows of cylinders.
    fn rod_load_curves<'py>(
        &self,
        py: Python<'py>,
        theta_deg: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let thetas = theta_deg.as_slice()?;
        let found = interrupt::run(py, |cancel| self.0.rod_load_curves(thetas, cancel))?;
        let loads = PyDict::new(py);
        for (name, rows) in ["rod_load", "gas_load", "inertia_load"].into_iter().zip(found) {
            loads.set_item(name, frozen(py, rows)?)?;
        }
        Ok(loads)
    }

    /// Index of the crank and place of each main bearing.
    fn mains(&self) -> Vec<(usize, f64)> {
        self.0.mains().iter().map(|main| (main.crank.position(), main.z)).collect()
    }

    /// Shear and bending of a crank, by its index, or of the crankcase.
    fn sections<'py>(
        &self,
        py: Python<'py>,
        part: &str,
        crank: usize,
        theta_deg: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<(Bound<'py, PyArray3<f64>>, Bound<'py, PyArray3<f64>>)> {
        let crank = CutPart::Crank(CrankIndex::new(crank));
        let part = choice("part", part, &[("crank", crank), ("crankcase", CutPart::Crankcase)])?;
        let thetas = theta_deg.as_slice()?;
        let found = interrupt::run(py, |cancel| self.0.sections(part, thetas, cancel))?;
        let Sections { shear, bending } = found;
        Ok((frozen(py, shear)?, frozen(py, bending)?))
    }

    /// Least and largest of each row of the same over a cycle, degrees, and of each crankpin with all of its
    /// rods; magnitudes of vectors.
    fn extremes<'py>(&self, py: Python<'py>, cycle_deg: u32) -> PyResult<Bound<'py, PyDict>> {
        let found = interrupt::run(py, |cancel| self.0.extremes(cycle_deg, cancel))?;
        let Extremes { crankpin, wrist_pin, main, side_thrust, rod, gas, whole_crankpin } = found;
        let extremes = PyDict::new(py);
        for (name, rows) in [
            ("crankpin", crankpin),
            ("wrist_pin", wrist_pin),
            ("main", main),
            ("side_thrust", side_thrust),
            ("rod_force", rod),
            ("gas_force", gas),
            ("whole_crankpin", whole_crankpin),
        ] {
            extremes.set_item(name, frozen(py, rows)?)?;
        }
        Ok(extremes)
    }

    /// Ranges of crank angles in which each rod is in tension, degrees of a cycle.
    fn tension(&self, py: Python<'_>, cycle_deg: u32) -> PyResult<Vec<Vec<(f64, f64)>>> {
        let found = interrupt::run(py, |cancel| self.0.tension(cycle_deg, cancel))?;
        Ok(found.into_iter().map(|rod| rod.into_iter().map(<(f64, f64)>::from).collect()).collect())
    }
}
