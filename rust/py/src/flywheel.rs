//! Speed of a crank over a cycle.

use crate::array::frozen;
use crankpin_core::flywheel::areas::EnergyLevels;
use crankpin_core::flywheel::rim::{Rim, RimDiameter, RimSection};
use crankpin_core::flywheel::{self, CrankDrive, FlywheelTarget};
use crankpin_macros::guarded;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::convert::{OrRaise, orders_of_halves};
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

/// Energy where torque crosses its mean: the levels, and the indices of the highest and the lowest.
#[guarded]
#[pyfunction]
pub fn energy_levels(areas: Vec<f64>, spread: bool) -> PyResult<(Vec<f64>, usize, usize)> {
    let EnergyLevels { levels, highest, lowest } =
        EnergyLevels::of_areas(&areas, spread).or_raise()?;
    Ok((levels, highest, lowest))
}

/// Moment of inertia times irregularity of a fluctuation of energy.
#[guarded]
#[pyfunction]
pub fn inertia_by_irregularity(energy: f64, rpm: f64) -> PyResult<f64> {
    flywheel::areas::inertia_by_irregularity(energy, rpm).or_raise()
}

/// Mass, mean diameter, area, width and thickness of a rim, by one of three figures of its diameter and at most
/// one of its section.
#[guarded]
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the wrapper in Python names them")]
pub fn rim(
    inertia: f64,
    density: f64,
    rpm: f64,
    mean_diameter: Option<f64>,
    rim_speed: Option<f64>,
    hoop_stress: Option<f64>,
    width_ratio: Option<f64>,
    width: Option<f64>,
    thickness: Option<f64>,
) -> PyResult<(f64, f64, f64, Option<[f64; 2]>)> {
    let diameter = match (mean_diameter, rim_speed) {
        (Some(diameter), _) => RimDiameter::Mean(diameter),
        (None, Some(speed)) => RimDiameter::Speed(speed, rpm),
        _ => RimDiameter::Stress(hoop_stress.unwrap_or_default(), rpm),
    };
    let section = match (width_ratio, width, thickness) {
        (Some(ratio), ..) => RimSection::WidthOverThickness(ratio),
        (_, Some(width), _) => RimSection::Width(width),
        (.., Some(thickness)) => RimSection::Thickness(thickness),
        _ => RimSection::Thin,
    };
    let rim = Rim::new(inertia, density, diameter, section).or_raise()?;
    Ok((rim.mass, rim.mean_diameter, rim.area, rim.section))
}

/// Thickness and diameter of a disc by one of them.
#[guarded]
#[pyfunction]
pub fn disc(
    inertia: f64,
    density: f64,
    diameter: Option<f64>,
    thickness: Option<f64>,
) -> PyResult<[f64; 2]> {
    flywheel::rim::disc(inertia, density, diameter, thickness).or_raise()
}

/// Largest less smallest speed of each order alone, over the mean speed.
#[guarded]
#[pyfunction]
pub fn irregularity_by_order<'py>(
    py: Python<'py>,
    theta_deg: PyReadonlyArray1<'_, f64>,
    speed: PyReadonlyArray1<'_, f64>,
    mean_speed: f64,
    halves: Vec<u32>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (theta_deg, speed) = (theta_deg.as_slice()?, speed.as_slice()?);
    let orders = orders_of_halves(halves)?;
    let found = interrupt::run(py, |cancel| {
        flywheel::irregularity_by_order(theta_deg, speed, mean_speed, &orders, cancel)
    })?;
    frozen(py, found.into())
}

/// Largest less smallest angle by which a crank leads one that turns evenly, degrees.
#[guarded]
#[pyfunction]
pub fn swing_deg(
    theta_deg: PyReadonlyArray1<'_, f64>,
    speed: PyReadonlyArray1<'_, f64>,
) -> PyResult<f64> {
    Ok(flywheel::swing_deg(theta_deg.as_slice()?, speed.as_slice()?))
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

    /// Mean over the period of a function from its values at the points inside the cells.
    fn mean(&self, values: PyReadonlyArray1<'_, f64>) -> PyResult<f64> {
        Ok(self.0.mean(values.as_slice()?))
    }

    /// Speed over the cycle, from torques at the nodes and a moment of inertia or an irregularity.
    #[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
    fn speed<'py>(
        &self,
        py: Python<'py>,
        torque: PyReadonlyArray1<'py, f64>,
        load: PyReadonlyArray1<'py, f64>,
        engines: Vec<Bound<'py, Engine>>,
        rpm: f64,
        inertia: Option<f64>,
        irregularity: f64,
    ) -> PyResult<Fluctuation<'py>> {
        let evenness =
            inertia.map_or(FlywheelTarget::Irregularity(irregularity), FlywheelTarget::Inertia);
        let engines: Vec<_> = engines.iter().map(|engine| &*engine.get().0).collect();
        let (torque, load) = (torque.as_slice()?, load.as_slice()?);
        let found = interrupt::run(py, |cancel| {
            let drive = CrankDrive { grid: &self.0, torque, load, engines: &engines, rpm };
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
