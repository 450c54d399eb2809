//! Speed of a crank over a cycle.

use crate::array::frozen;
use crankpin_core::flywheel::{self, CrankDrive, FlywheelTarget};
use crankpin_macros::guarded;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::engine::Engine;
use crate::interrupt;

/// Crank angles of one period at which torque is evaluated.
#[pyclass(frozen, module = "crankpin._core")]
pub struct CycleGrid(flywheel::CycleGrid);

/// Speed over a cycle, rad/s; arrays over the edges.
#[derive(IntoPyObject)]
struct Fluctuation<'py> {
    speed: Bound<'py, PyArray1<f64>>,
    moving_inertia: Bound<'py, PyArray1<f64>>,
    inertia_torque: Bound<'py, PyArray1<f64>>,
    inertia: f64,
    irregularity: f64,
    energy: f64,
    mean_torque: f64,
    acceleration: f64,
    extremes: [f64; 2],
    approximations: (f64, f64),
}

/// Mean moment of inertia over a turn of each cylinder's piston and rod as seen from the main crank, kg·m².
#[guarded]
#[pyfunction]
pub fn mean_inertias<'py>(
    py: Python<'py>,
    engine: &Bound<'py, Engine>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let engine = &*engine.get().0;
    let found = interrupt::run(py, |cancel| flywheel::mean_inertias(engine, cancel))?;
    frozen(py, found.into())
}

#[guarded]
#[pymethods]
impl CycleGrid {
    /// Edges at these knots besides the grid's own.
    #[new]
    fn new(py: Python<'_>, period_deg: f64, knots: PyReadonlyArray1<'_, f64>) -> PyResult<Self> {
        let knots = knots.as_slice()?;
        interrupt::run(py, |cancel| flywheel::CycleGrid::new(period_deg, knots, cancel)).map(Self)
    }

    /// Edges of the cells, degrees.
    #[getter]
    fn edges_deg<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        frozen(py, self.0.edges_deg.clone().into())
    }

    /// Points inside the cells, degrees.
    #[getter]
    fn nodes_deg<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        frozen(py, self.0.nodes_deg.clone().into())
    }

    /// Speed over the cycle, from torques at the nodes and a moment of inertia or an irregularity.
    #[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
    fn speed<'py>(
        &self,
        py: Python<'py>,
        torque: PyReadonlyArray1<'py, f64>,
        load: PyReadonlyArray1<'py, f64>,
        engine: Option<&Bound<'py, Engine>>,
        rpm: f64,
        inertia: Option<f64>,
        irregularity: f64,
    ) -> PyResult<Fluctuation<'py>> {
        let evenness =
            inertia.map_or(FlywheelTarget::Irregularity(irregularity), FlywheelTarget::Inertia);
        let engine = engine.map(|engine| &*engine.get().0);
        let (torque, load) = (torque.as_slice()?, load.as_slice()?);
        let found = interrupt::run(py, |cancel| {
            let drive = CrankDrive { grid: &self.0, torque, load, engine, rpm };
            drive.speed(evenness, cancel)
        })?;
        Ok(Fluctuation {
            speed: frozen(py, found.speed.into())?,
            moving_inertia: frozen(py, found.moving_inertia.into())?,
            inertia_torque: frozen(py, found.inertia_torque.into())?,
            inertia: found.inertia,
            irregularity: found.irregularity,
            energy: found.energy,
            mean_torque: found.mean_torque,
            acceleration: found.acceleration,
            extremes: found.extremes,
            approximations: found.approximations.into(),
        })
    }
}
