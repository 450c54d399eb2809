//! Rigid bodies on mounts, and engines on them.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::array::frozen;
use crankpin_core as core;
use crankpin_core::balancing::adaptive;
use crankpin_core::balancing::phasors::{self, PhasorRequest};
use crankpin_core::engine::file;
use crankpin_core::mount_designs::{DesignRequest, MountFigure, Variation, design_responses};
use crankpin_core::mount_objectives::{self, MountObjective, MountVariable};
use crankpin_core::mounted::{ActuatorForces, BaseMotion, Derivative};
use crankpin_core::mounts::{
    self, Base, ForceTable, InertiaTrack, Mount, MountFigures, Products, Receiver, Receptance,
    RigidBody, Soil, Table,
};
use crankpin_core::peaks::largest_vectors;
use crankpin_core::{Complex64, memory};
use crankpin_macros::guarded;
use ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2, PyArrayDyn, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;

use crate::balance;
use crate::boundary;
use crate::convert::{self, OrRaise, OrderNumber, numbers};
use crate::engine::{Engine, choice};
use crate::interrupt;

/// Mass, centre of gravity, tensor of inertia.
pub type Body = (f64, [f64; 3], [[f64; 3]; 3]);
/// Frequencies, and complex stiffnesses along the three axes at them.
pub type StiffnessTable = (Vec<f64>, Vec<[Complex64; 3]>);
/// Name, place, orientation, static and dynamic stiffness, loss factor, damping, track, table; about the axes
/// stiffness, loss factor and damping; gap and stiffness of the snubbers against and along each.
pub type Figures = (
    String,
    [f64; 3],
    Orientation,
    [f64; 3],
    Option<[f64; 3]>,
    [f64; 3],
    [f64; 3],
    Option<(f64, f64, f64)>,
    Option<StiffnessTable>,
    [[f64; 3]; 3],
    [[[f64; 2]; 3]; 2],
);
/// Gravity, acceleration of the vehicle, thrust and its place; torque that leaves the unit.
type Case = ([[f64; 3]; 4], f64);
/// Name, and at each frequency the displacement over the force at each coordinate.
type Transfer = (String, Vec<Vec<[Complex64; 3]>>);
/// Displacements by weight, torque and thrust, forces of all mounts by each, their deflection and forces of snubbers
/// along their own axes, deflection along x, y and z, the margin of support, and the mounts at the corners of its
/// polygon.
type Static<'py> = (
    [[f64; 6]; 3],
    [Bound<'py, PyArray2<f64>>; 3],
    [Bound<'py, PyArray2<f64>>; 3],
    f64,
    Vec<usize>,
);
/// Frequencies, shapes, energy and strain energy, then purity, loss factor and damped frequency, groups, and
/// free motions in words.
type Modes<'py> = (
    Bound<'py, PyArray1<f64>>,
    [Bound<'py, PyArray2<f64>>; 3],
    [Bound<'py, PyArray1<f64>>; 3],
    Vec<usize>,
    Vec<String>,
);
/// Direction and foot of an elastic axis, and from the CG to that; its angles to the crank and the torque roll axis,
/// degrees, the distance from that, pitch, and compliance; the elastic centre, if there is one.
type ElasticAxis = ([[f64; 3]; 3], [f64; 5], Option<[f64; 3]>);
/// Direction of the torque roll axis and its angle to the crank, distances of the mounts, and elastic axes with static
/// and dynamic stiffness.
type RollAxes<'py> = ([f64; 3], f64, Bound<'py, PyArray1<f64>>, [ElasticAxis; 2]);

/// Frequencies, purity and least purity; least and largest frequencies by stiffness, mass and place of the
/// CG; derivatives by that; factors of the stiffness of the mounts where purity is least.
type Robustness<'py> = (
    Bound<'py, PyArray2<f64>>,
    [Bound<'py, PyArray2<f64>>; 3],
    Bound<'py, PyArray2<f64>>,
    Vec<Vec<[f64; 3]>>,
);
/// Place and direction of actuators, their forces, and whether the engine's loads act.
type PyDrive<'py> = (Vec<[[f64; 3]; 2]>, PyReadonlyArray2<'py, Complex64>, bool);
/// Point of a base that moves, what its phasors are of, those at orders, one for all speeds or one for each, and whether
/// the engine's loads act.
type PyBase<'py> = ([f64; 3], String, Vec<(OrderNumber, PyReadonlyArray2<'py, Complex64>)>, bool);
/// Orders, omitted ones, bounds; frequencies, largest peaks, rms.
type DesignResponses<'py> = (
    (Vec<OrderNumber>, Vec<OrderNumber>, [f64; 3]),
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArrayDyn<f64>>,
    Bound<'py, PyArrayDyn<f64>>,
);

/// Degrees about z, or directions of the axes.
#[derive(FromPyObject, IntoPyObject)]
pub enum Orientation {
    /// Degrees.
    Tilt(f64),
    /// A row for each axis.
    Axes([[f64; 3]; 3]),
}

/// What carries mounts.
#[derive(FromPyObject, IntoPyObject)]
pub enum Support {
    /// A rigid body on mounts of its own.
    Subframe(Body, Vec<Figures>),
    /// Coordinates, frequencies, a matrix at each of them, row by row, and receivers.
    Receptance(Vec<(String, usize)>, Vec<f64>, Vec<Vec<Complex64>>, Vec<Transfer>),
}

impl Support {
    fn core(self) -> core::Result<mounts::Support> {
        match self {
            Self::Subframe(body, figures) => {
                let figures = figures.into_iter().map(mount).collect::<core::Result<_>>()?;
                let subframe = mounts::Powertrain::new(self::body(body)?, figures)?;
                Ok(mounts::Support::Subframe(Box::new(subframe)))
            }
            Self::Receptance(coordinates, frequency, values, receivers) => {
                let receiver = |(name, transfer)| Receiver { name, transfer };
                let receivers = receivers.into_iter().map(receiver).collect();
                let found = Receptance { coordinates, frequency, values, receivers };
                found.checked().map(mounts::Support::Receptance)
            }
        }
    }

    fn of(support: &mounts::Support) -> Self {
        match support {
            mounts::Support::Subframe(subframe) => {
                Self::Subframe(body_figures(subframe.body()), mount_figures(subframe))
            }
            mounts::Support::Receptance(found) => {
                let found = found.clone();
                let receiver = |each: Receiver| (each.name, each.transfer);
                let receivers = found.receivers.into_iter().map(receiver).collect();
                Self::Receptance(found.coordinates, found.frequency, found.values, receivers)
            }
        }
    }
}

/// Rejects what cannot carry mounts.
#[guarded]
#[pyfunction]
pub fn check_support(support: Support) -> PyResult<()> {
    support.core().or_raise().map(drop)
}

fn body_figures(body: &RigidBody) -> Body {
    let tensor = body.inertia();
    let rows = [0, 1, 2].map(|row| [0, 1, 2].map(|column| tensor[(row, column)]));
    (body.mass(), body.cg().into(), rows)
}

fn mount_figures(powertrain: &mounts::Powertrain) -> Vec<Figures> {
    powertrain.mounts().iter().map(|mount| figures(mount.figures().clone())).collect()
}

fn figures(of: MountFigures) -> Figures {
    let orientation = of.axes.map_or(Orientation::Tilt(of.tilt_deg), Orientation::Axes);
    let track = of.track.map(|t| (t.stiffness, t.frequency, t.damping_ratio));
    (
        of.name,
        of.at,
        orientation,
        of.stiffness,
        of.dynamic_stiffness,
        of.loss_factor,
        of.damping,
        track,
        of.table.map(|table| (table.frequency, table.stiffness)),
        [of.rotational_stiffness, of.rotational_loss_factor, of.rotational_damping],
        [of.gap, of.snubber_stiffness],
    )
}

/// A place, m, or the name of a receiver.
#[derive(FromPyObject)]
pub enum MotionPoint {
    /// x, y, z.
    Place([f64; 3]),
    /// Name.
    Receiver(String),
}

/// Body of a tensor that was checked.
pub fn body((mass, cg, inertia): Body) -> core::Result<RigidBody> {
    RigidBody::new(mass, cg, inertia, Some(Products::Tensor))
}

pub fn mount(figures: Figures) -> core::Result<Mount> {
    let (name, at, orientation, stiffness, dynamic_stiffness, loss_factor, damping, track, ..) =
        figures;
    let (.., table, about, [gap, snubber_stiffness]) = figures;
    let [rotational_stiffness, rotational_loss_factor, rotational_damping] = about;
    let track = track.map(|(stiffness, frequency, damping_ratio)| InertiaTrack {
        stiffness,
        frequency,
        damping_ratio,
    });
    let (tilt_deg, axes) = match orientation {
        Orientation::Tilt(degrees) => (degrees, None),
        Orientation::Axes(axes) => (0.0, Some(axes)),
    };
    Mount::new(MountFigures {
        name,
        at,
        tilt_deg,
        axes,
        stiffness,
        dynamic_stiffness,
        loss_factor,
        damping,
        track,
        table: table.map(|(frequency, stiffness)| Table { frequency, stiffness }),
        rotational_stiffness,
        rotational_loss_factor,
        rotational_damping,
        gap,
        snubber_stiffness,
    })
}

fn load_case((vectors, torque): Case) -> mounts::LoadCase {
    let [gravity, acceleration, thrust, thrust_at] = vectors;
    mounts::LoadCase { gravity, acceleration, torque, thrust, thrust_at }
}

/// The tensor of a body's inertia and its principal moments.
#[guarded]
#[pyfunction]
pub fn rigid_body(
    mass: f64,
    cg: [f64; 3],
    inertia: [[f64; 3]; 3],
    products: Option<&str>,
) -> PyResult<([[f64; 3]; 3], [f64; 3])> {
    let products = products.map(Products::named).transpose().or_raise()?;
    let body = RigidBody::new(mass, cg, inertia, products).or_raise()?;
    let tensor = body.inertia();
    let rows = [0, 1, 2].map(|row| [0, 1, 2].map(|column| tensor[(row, column)]));
    Ok((rows, body.principal_moments()))
}

/// A cuboid of one density about its centre, and several bodies as one.
#[guarded]
#[pyfunction]
pub fn block(sides: [f64; 3], centre: [f64; 3], density: f64) -> PyResult<Body> {
    RigidBody::block(sides, centre, density).or_raise().map(|body| body_figures(&body))
}

/// Several bodies as one.
#[guarded]
#[pyfunction]
pub fn combined(bodies: Vec<Body>) -> PyResult<Body> {
    let bodies = bodies.into_iter().map(body).collect::<core::Result<Vec<_>>>().or_raise()?;
    RigidBody::combined(&bodies).or_raise().map(|body| body_figures(&body))
}

/// Shear modulus, Poisson's ratio, density and damping ratio.
type SoilFigures = (f64, f64, f64, f64);

fn soil((shear_modulus, poisson, density, damping_ratio): SoilFigures) -> Soil {
    Soil { shear_modulus, poisson, density, damping_ratio }
}

/// Rejects what no soil has.
#[guarded]
#[pyfunction]
pub fn check_soil(figures: SoilFigures) -> PyResult<()> {
    soil(figures).check().or_raise()
}

/// The soil under a base of a radius, or of sides along x and z, as a mount: name, place, depth and body.
#[guarded]
#[pyfunction]
pub fn soil_mount(
    figures: SoilFigures,
    base: Vec<f64>,
    name: String,
    at: [f64; 3],
    depth: f64,
    on: Body,
) -> PyResult<Figures> {
    let base = match base[..] {
        [width, length] => Base::Rectangle([width, length]),
        _ => Base::Circle(base.first().copied().unwrap_or(f64::NAN)),
    };
    let on = body(on).or_raise()?;
    soil(figures).mount(name, base, at, depth, &on).or_raise().map(self::figures)
}

/// Checks the figures of a mount.
#[guarded]
#[pyfunction]
pub fn check_mount(figures: Figures) -> PyResult<()> {
    mount(figures).or_raise().map(drop)
}

/// Complex stiffness of a mount along its axes at a frequency, Hz.
#[guarded]
#[pyfunction]
pub fn mount_stiffness(
    py: Python<'_>,
    figures: Figures,
    frequency: f64,
) -> PyResult<Bound<'_, PyArray1<Complex64>>> {
    let frequency = core::limits::distance("frequency", frequency).or_raise()?;
    let mount = mount(figures).or_raise()?;
    let along = mount.stiffness_at(frequency * TAU, || "the frequency given".into()).or_raise()?;
    frozen(py, along.to_vec().into())
}

/// Rows of one length as an array.
fn rows<'py>(py: Python<'py>, rows: &[Vec<f64>]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let shape = (rows.len(), rows.first().map_or(0, Vec::len));
    frozen(py, Array2::from_shape_fn(shape, |(row, column)| rows[row][column]))
}

/// The engine of a powertrain that has one.
fn core_of<'a>(engine: Option<&'a Bound<'_, Engine>>) -> Option<&'a core::Engine> {
    engine.map(|engine| &*engine.get().0)
}

fn unreadable(error: serde_json::Error) -> PyErr {
    convert::python_error(core::Error::value("forces", error, "give crankpin.ForceTable"))
}

/// Tables of forces of JSON.
fn tables(text: &str) -> PyResult<Vec<ForceTable>> {
    serde_json::from_str(text).map_err(unreadable)
}

/// Checks a table of forces, as JSON.
#[guarded]
#[pyfunction]
pub fn check_forces(text: &str) -> PyResult<()> {
    for table in tables(text)? {
        table.checked("").or_raise()?;
    }
    Ok(())
}

/// Forces and moments of an engine about a point at a speed, a table as JSON.
#[guarded]
#[pyfunction]
pub fn force_table<'py>(
    py: Python<'py>,
    engine: &Bound<'_, Engine>,
    rpm: f64,
    orders: Option<Vec<OrderNumber>>,
    about: [f64; 3],
) -> PyResult<Bound<'py, PyAny>> {
    let (engine, orders) = (&engine.get().0, balance::orders(orders, 1e-9)?);
    let found = interrupt::run(py, |cancel| {
        core::mounted::force_table(engine, rpm, &orders, about, cancel)
    })?;
    boundary::text(py, &serde_json::to_string(&found).map_err(unreadable)?)
}

/// A body on mounts.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Powertrain(Arc<mounts::Powertrain>);

#[guarded]
#[pymethods]
impl Powertrain {
    #[new]
    #[pyo3(signature = (body, mounts, support, forces=None, rest=None))]
    fn new(
        body: Body,
        mounts: Vec<Figures>,
        support: Option<Support>,
        forces: Option<&str>,
        rest: Option<Case>,
    ) -> PyResult<Self> {
        let mounts = mounts.into_iter().map(mount).collect::<core::Result<_>>().or_raise()?;
        let (body, rest) = (self::body(body).or_raise()?, rest.map(load_case).unwrap_or_default());
        let mut powertrain = mounts::Powertrain::resting(body, mounts, rest).or_raise()?;
        if let Some(support) = support {
            powertrain = support.core().and_then(|core| powertrain.on(core)).or_raise()?;
        }
        if let Some(text) = forces {
            powertrain = powertrain.with_forces(tables(text)?).or_raise()?;
        }
        Ok(Self(Arc::new(powertrain)))
    }

    /// Tables of forces that shake the body besides an engine, as JSON.
    #[getter]
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        boundary::text(py, &serde_json::to_string(self.0.forces()).map_err(unreadable)?)
    }

    /// Engine and body on mounts of a file, or one of them.
    #[staticmethod]
    fn from_text(text: &str, toml: bool) -> PyResult<(Option<Engine>, Option<Self>)> {
        let read = if toml { file::mounted_from_toml } else { file::mounted_from_json };
        let (engine, powertrain) = read(text).or_raise()?;
        Ok((engine.map(Engine::from), powertrain.map(|powertrain| Self(Arc::new(powertrain)))))
    }

    /// Text of a file of an engine and this.
    fn to_text<'py>(
        &self,
        py: Python<'py>,
        engine: Option<&Bound<'_, Engine>>,
        toml: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let write = if toml { file::mounted_to_toml } else { file::mounted_to_json };
        boundary::text(py, &write(core_of(engine), Some(&self.0)).or_raise()?)
    }

    #[getter]
    fn body(&self) -> Body {
        body_figures(self.0.body())
    }

    #[getter]
    fn mounts(&self) -> Vec<Figures> {
        mount_figures(&self.0)
    }

    #[getter]
    fn support(&self) -> Option<Support> {
        self.0.support().map(Support::of)
    }

    /// Names of the mounts, and of a subframe's.
    #[getter]
    fn all_names(&self) -> Vec<String> {
        self.0.all_names()
    }

    /// Rejects what gives way under the mounts.
    fn require_ground(&self) -> PyResult<()> {
        self.0.require_ground().or_raise()
    }

    /// Mass matrix and complex stiffness at a frequency, Hz, of the coordinates of one body or two.
    fn matrices<'py>(
        &self,
        py: Python<'py>,
        frequency: Option<f64>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<Complex64>>)> {
        let (mass, stiffness) = mounts::matrices(&self.0, frequency).or_raise()?;
        let mass = Array2::from_shape_fn(mass.shape(), |place| mass[place]);
        let stiffness = Array2::from_shape_fn(stiffness.shape(), |place| stiffness[place]);
        Ok((frozen(py, mass)?, frozen(py, stiffness)?))
    }

    /// At rest under a case.
    #[pyo3(name = "static")]
    fn at_rest<'py>(&self, py: Python<'py>, case: Case) -> PyResult<Static<'py>> {
        let found = mounts::at_rest(&self.0, &load_case(case)).or_raise()?;
        let array = |rows: Vec<[f64; 3]>| frozen(py, Array2::from(rows));
        let [weight, torque, thrust] = found.force.map(array);
        let forces = [weight?, torque?, thrust?];
        let own = [array(found.deflection)?, array(found.snubber_force)?, array(found.travel)?];
        Ok((found.displacement, forces, own, found.support_margin, found.support_corners))
    }

    /// The case at whose state of rest snubbers are taken for what moves.
    #[getter]
    fn rest(&self) -> Case {
        let mounts::LoadCase { gravity, acceleration, torque, thrust, thrust_at } = *self.0.rest();
        ([gravity, acceleration, thrust, thrust_at], torque)
    }

    /// Whether a mount, or one of a subframe, has snubbers.
    #[getter]
    fn is_snubbed(&self) -> bool {
        self.0.is_snubbed()
    }

    /// Stiffness of the snubbers against and along the axes of all mounts that act at rest, N/m.
    #[getter]
    fn contacts(&self) -> Vec<[[f64; 2]; 3]> {
        self.0.all_mounts().map(Mount::contact).collect()
    }

    /// Deflection of each mount along its axes, of displacement of the CG and rotation: (`n_mounts`, 3, 6).
    fn deflections<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let count = self.0.mounts().len();
        let rows = self.0.deflections()[..count].iter().flat_map(|each| each.transpose().data.0);
        let numbers = rows.flatten().collect();
        let shape = [count, 3, 6];
        frozen(py, memory::array("deflections", shape.to_vec(), numbers).or_raise()?)
    }

    /// Coordinates of unit mass: columns, of displacement of the CG and rotation.
    fn unit_mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let unit = self.0.unit_mass().or_raise()?;
        frozen(py, Array2::from_shape_fn((6, 6), |place| unit[place]))
    }

    /// Part of the reaction to a roll about the torque roll axis that is no torque of the crank, and the frequency
    /// of that roll, Hz.
    fn roll(&self) -> PyResult<(f64, f64)> {
        let reaction = self.0.roll_reaction().or_raise()?;
        Ok((reaction.across().norm(), reaction.frequency()))
    }

    /// Largest share of one mode in the effect of a torque of the crank, %.
    fn torque_in_one_mode(&self, frequency: Option<f64>) -> PyResult<f64> {
        self.0.torque_in_one_mode(frequency).or_raise()
    }

    /// Velocity at the place of an actuator, of 1 N of its motor, at frequencies, Hz.
    fn mobility<'py>(
        &self,
        py: Python<'py>,
        actuator: Inertial,
        frequency: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        let (actuator, frequency) =
            (mounts::InertialActuator::from(actuator), frequency.as_slice()?);
        let found = interrupt::run(py, |cancel| actuator.mobility(&self.0, frequency, cancel))?;
        frozen(py, found.into())
    }

    /// The least gain at which roots reach the imaginary axis, and their frequency, Hz, of mobilities on a grid.
    fn feedback_margin(
        &self,
        py: Python<'_>,
        actuator: Inertial,
        frequency: PyReadonlyArray1<'_, f64>,
        mobility: PyReadonlyArray1<'_, Complex64>,
    ) -> PyResult<(f64, Option<f64>)> {
        let actuator = mounts::InertialActuator::from(actuator);
        let grid = (frequency.as_slice()?, mobility.as_slice()?);
        interrupt::run(py, |cancel| actuator.margin(&self.0, grid, cancel))
    }

    /// Frequency of the lowest mode that nothing damps and the motor drives, Hz, with stiffness at a frequency.
    fn undamped(&self, actuator: Inertial, frequency: f64) -> PyResult<Option<f64>> {
        mounts::InertialActuator::from(actuator).undamped(&self.0, frequency).or_raise()
    }

    fn modes<'py>(&self, py: Python<'py>, frequency: Option<f64>) -> PyResult<Modes<'py>> {
        let found = mounts::modes(&self.0, frequency).or_raise()?;
        let square = |matrix: &nalgebra::DMatrix<f64>| {
            frozen(py, Array2::from_shape_fn(matrix.shape(), |place| matrix[place]))
        };
        let row = |values: Vec<f64>| frozen(py, Array1::from(values));
        Ok((
            row(found.frequency)?,
            [square(&found.shapes)?, square(&found.energy)?, rows(py, &found.strain)?],
            [row(found.purity)?, row(found.loss_factor)?, row(found.damped_frequency)?],
            found.group,
            found.free.iter().map(mounts::FreeMotion::in_words).collect(),
        ))
    }

    fn free_motions(&self, frequency: Option<f64>) -> PyResult<Vec<String>> {
        let motions = mounts::free_motions(&self.0, frequency).or_raise()?;
        Ok(motions.iter().map(mounts::FreeMotion::in_words).collect())
    }

    fn axes<'py>(&self, py: Python<'py>, frequency: Option<f64>) -> PyResult<RollAxes<'py>> {
        let found = mounts::axes(&self.0, frequency).or_raise()?;
        let elastic = [found.elastic, found.dynamic].map(|one| {
            let angles = [one.angle_deg, one.to_torque_roll_deg];
            let figures = [angles[0], angles[1], one.distance, one.pitch, one.compliance];
            ([one.direction, one.foot, one.from_cg], figures, one.centre)
        });
        let distances = frozen(py, Array1::from(found.mount_distances))?;
        Ok((found.torque_roll, found.torque_roll_deg, distances, elastic))
    }

    fn robustness<'py>(
        &self,
        py: Python<'py>,
        tolerances: (Vec<f64>, f64, f64, f64, bool),
        frequency: Option<f64>,
    ) -> PyResult<Robustness<'py>> {
        let (stiffness, mass, inertia, cg, by_axis) = tolerances;
        let tolerances = mounts::MountTolerances { stiffness, mass, inertia, cg, by_axis };
        let found = interrupt::run(py, |cancel| {
            mounts::robustness(&self.0, &tolerances, frequency, cancel)
        })?;
        Ok((
            rows(py, &[found.frequency, found.purity, found.least_purity])?,
            [rows(py, &found.by_stiffness)?, rows(py, &found.by_mass)?, rows(py, &found.by_cg)?],
            rows(py, &found.cg_slope)?,
            found.least_pure,
        ))
    }

    /// Figures of designs: orders, those omitted, bounds of these, natural frequencies, (`n_designs`, 6),
    /// largest peaks, (`n_designs`, `n_quantities`, `n_orders`, 3), and rms, (`n_designs`, `n_quantities`, 3).
    #[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
    fn designs<'py>(
        &self,
        py: Python<'py>,
        engine: Option<&Bound<'_, Engine>>,
        vary: Vec<(usize, String, PyReadonlyArray2<'_, f64>)>,
        rpm: PyReadonlyArray1<'_, f64>,
        orders: (Option<Vec<OrderNumber>>, f64),
        quantities: (bool, Vec<[f64; 3]>),
        frequency: Option<f64>,
    ) -> PyResult<DesignResponses<'py>> {
        let figures = [
            ("at", MountFigure::At),
            ("tilt_deg", MountFigure::Tilt),
            ("stiffness", MountFigure::Stiffness),
            ("dynamic_stiffness", MountFigure::DynamicStiffness),
            ("loss_factor", MountFigure::LossFactor),
            ("damping", MountFigure::Damping),
        ];
        let mut variations = Vec::new();
        for (mount, name, values) in vary {
            let figure = choice("vary", &name, &figures)?;
            let (rows, _) = values.as_slice()?.as_chunks::<3>();
            let values = memory::collected(rows.iter().copied()).or_raise()?;
            variations.push(Variation { mount, figure, values });
        }
        let (orders, rpm) = (balance::orders(orders.0, orders.1)?, rpm.as_slice()?);
        let (mount_forces, points) = quantities;
        let request =
            DesignRequest { rpm, orders: &orders, mount_forces, points: &points, frequency };
        let engine = core_of(engine);
        let found = interrupt::run(py, |cancel| {
            design_responses(engine, &self.0, &variations, &request, cancel)
        })?;
        let (count, orders) = (found.frequency.len(), found.orders.len());
        let of_largest = [count, found.quantities, orders, 3];
        let of_rms = [count, found.quantities, 3];
        let largest = found.largest.into_flattened();
        let rms = found.rms.into_flattened();
        let largest = memory::array("designs", of_largest.as_slice(), largest).or_raise()?;
        let rms = memory::array("designs", of_rms.as_slice(), rms).or_raise()?;
        Ok((
            (numbers(&found.orders), numbers(&found.omitted), found.error_bound.values()),
            frozen(py, Array2::from(found.frequency))?,
            frozen(py, largest)?,
            frozen(py, rms)?,
        ))
    }

    /// Response to the engine, and with a drive to actuators: place and direction of each, peak phasors of their
    /// forces, (`n_points`, `n_actuators`), and whether the engine's loads act; or on a base that moves.
    #[pyo3(signature = (engine, rpm, orders, rtol, drive=None, base=None))]
    #[expect(clippy::too_many_arguments)]
    fn response(
        &self,
        py: Python<'_>,
        engine: Option<&Bound<'_, Engine>>,
        rpm: PyReadonlyArray1<'_, f64>,
        orders: Option<Vec<OrderNumber>>,
        rtol: f64,
        drive: Option<PyDrive<'_>>,
        base: Option<PyBase<'_>>,
    ) -> PyResult<Response> {
        let (orders, rpm) = (balance::orders(orders, rtol)?, rpm.as_slice()?);
        let (engine, powertrain) = (core_of(engine), Arc::clone(&self.0));
        let found = if let Some((about, derivative, by_order, engine_runs)) = &base {
            let derivative = choice("derivative", derivative, &DERIVATIVES)?;
            let rows = |(order, rows): &(OrderNumber, PyReadonlyArray2<'_, Complex64>)| {
                let order = convert::orders(&[*order])?[0];
                Ok((order, rows.as_slice()?.as_chunks::<6>().0.to_vec())) // bounded: as it was given
            };
            let phasors = by_order.iter().map(rows).collect::<PyResult<Vec<_>>>()?;
            let base = BaseMotion {
                about: *about,
                derivative,
                phasors: &phasors,
                engine_runs: *engine_runs,
            };
            interrupt::run(py, |cancel| {
                core::mounted::Response::on_base(engine, powertrain, rpm, &orders, &base, cancel)
            })?
        } else if let Some((actuators, forces, engine_runs)) = &drive {
            let (forces, engine_runs) = (forces.as_slice()?, *engine_runs);
            let drive = ActuatorForces { actuators, forces, engine_runs };
            interrupt::run(py, |cancel| {
                core::mounted::Response::driven(engine, powertrain, rpm, &orders, &drive, cancel)
            })?
        } else {
            interrupt::run(py, |cancel| {
                core::mounted::Response::new(engine, powertrain, rpm, &orders, cancel)
            })?
        };
        Ok(Response { core: found, speeds: rpm.len(), mounts: self.0.mounts().len() })
    }
}

/// Names of what the motion of a point is.
const DERIVATIVES: [(&str, Derivative); 3] = [
    ("displacement", Derivative::Displacement),
    ("velocity", Derivative::Velocity),
    ("acceleration", Derivative::Acceleration),
];

/// An engine on its mounts at some speeds.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Response {
    core: core::mounted::Response,
    speeds: usize,
    mounts: usize,
}

impl Response {
    /// Rows of a width as an array over speeds, orders, and what the rows are of.
    fn shaped<'py, T: numpy::Element + 'static>(
        &self,
        py: Python<'py>,
        values: Vec<T>,
        rest: &[usize],
    ) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
        let shape = [&[self.speeds, self.core.orders().len()], rest].concat();
        frozen(py, memory::array("response", shape, values).or_raise()?)
    }

    /// Loads about the CG, with moments about a point if one is given.
    fn loads_about<'py>(
        &self,
        py: Python<'py>,
        about: Option<[f64; 3]>,
        loads: &[nalgebra::SVector<Complex64, 6>],
    ) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        let moved = about.map(|point| self.core.about(point, loads));
        self.shaped(py, side_by_side(moved.as_deref().unwrap_or(loads)), &[6])
    }
}

/// Numbers of vectors side by side.
fn side_by_side<const N: usize>(rows: &[nalgebra::SVector<Complex64, N>]) -> Vec<Complex64> {
    rows.iter().flat_map(|row| row.iter().copied()).collect()
}

#[guarded]
#[pymethods]
impl Response {
    #[getter]
    fn orders(&self) -> Vec<OrderNumber> {
        numbers(self.core.orders())
    }

    #[getter]
    fn omitted(&self) -> Vec<OrderNumber> {
        numbers(self.core.omitted())
    }

    /// Of force, moment and torque of the engine.
    #[getter]
    fn error_bound(&self) -> [f64; 3] {
        self.core.error_bound().values()
    }

    /// The engine's load about the CG, or a point: (`n_rpm`, `n_orders`, 6).
    fn loads<'py>(
        &self,
        py: Python<'py>,
        about: Option<[f64; 3]>,
    ) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        self.loads_about(py, about, self.core.loads())
    }

    /// Displacement of the CG and rotation: (`n_rpm`, `n_orders`, 6).
    fn motions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        self.shaped(py, side_by_side(self.core.motions()), &[6])
    }

    /// Force of each mount on what carries it: (`n_rpm`, `n_orders`, `n_mounts`, 3).
    fn mount_forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        let forces = interrupt::run(py, |cancel| self.core.mount_forces(cancel))?;
        self.shaped(py, forces.into_flattened(), &[self.mounts, 3])
    }

    /// Their sum, and that of their moments about the CG, or a point: (`n_rpm`, `n_orders`, 6).
    fn support_loads<'py>(
        &self,
        py: Python<'py>,
        about: Option<[f64; 3]>,
    ) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        let sums = interrupt::run(py, |cancel| self.core.support_loads(cancel))?;
        self.loads_about(py, about, &sums)
    }

    /// Motion of a subframe's CG and rotation: (`n_rpm`, `n_orders`, 6).
    fn subframe_motions<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        self.shaped(py, side_by_side(self.core.subframe_motions().or_raise()?), &[6])
    }

    /// Force of each mount of a subframe on what carries it: (`n_rpm`, `n_orders`, `n_mounts`, 3).
    fn ground_forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        let forces = interrupt::run(py, |cancel| self.core.ground_forces(cancel))?;
        let points = self.speeds * self.core.orders().len();
        let count = forces.len() / points.max(1);
        self.shaped(py, forces.into_flattened(), &[count, 3])
    }

    /// Motion of a point of the powertrain or of its subframe, or of a receiver: (`n_rpm`, `n_orders`, 3).
    fn at<'py>(
        &self,
        py: Python<'py>,
        point: MotionPoint,
        derivative: &str,
        of_subframe: bool,
    ) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        let derivative = choice("derivative", derivative, &DERIVATIVES)?;
        let moved = interrupt::run(py, |cancel| match &point {
            MotionPoint::Place(place) => self.core.at(*place, derivative, of_subframe, cancel),
            MotionPoint::Receiver(name) => self.core.at_receiver(name, derivative, cancel),
        })?;
        self.shaped(py, moved.into_flattened(), &[3])
    }

    /// Motion of a base at the CG, and rotation: (`n_rpm`, `n_orders`, 6).
    fn base_motions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        self.shaped(py, side_by_side(self.core.base_motions().or_raise()?), &[6])
    }

    /// Motion of a point of a base: (`n_rpm`, `n_orders`, 3).
    fn base_at<'py>(
        &self,
        py: Python<'py>,
        point: [f64; 3],
        derivative: &str,
    ) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        let derivative = choice("derivative", derivative, &DERIVATIVES)?;
        let moved = self.core.base_at(point, derivative).or_raise()?;
        self.shaped(py, moved.into_flattened(), &[3])
    }

    /// Severity grade of a point at each speed.
    fn grades<'py>(
        &self,
        py: Python<'py>,
        point: MotionPoint,
        of_subframe: bool,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let grades = interrupt::run(py, |cancel| match &point {
            MotionPoint::Place(place) => self.core.grades(*place, of_subframe, cancel),
            MotionPoint::Receiver(name) => self.core.grades_at_receiver(name, cancel),
        })?;
        frozen(py, grades.into())
    }

    /// Power put in, taken by what carries the mounts, and dissipated by each: (`n_rpm`, `n_orders`,
    /// 2 + `n_mounts`).
    fn power<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let rows = interrupt::run(py, |cancel| self.core.power(cancel))?;
        self.shaped(py, rows.concat(), &[2 + self.mounts])
    }
}

/// Force of an actuator's motor over that on the powertrain, at frequencies, Hz.
#[guarded]
#[pyfunction]
pub fn motor_shares<'py>(
    py: Python<'py>,
    resonance: f64,
    damping_ratio: f64,
    frequency: PyReadonlyArray1<'_, f64>,
) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
    let share = |&frequency: &f64| mounts::motor_share(resonance, damping_ratio, frequency);
    frozen(py, frequency.as_slice()?.iter().map(share).collect::<Vec<_>>().into())
}

/// An actuator whose motor pushes against a mass on a spring, as Python's record has it.
#[derive(FromPyObject)]
pub struct Inertial {
    at: [f64; 3],
    direction: [f64; 3],
    mass: f64,
    resonance: f64,
    damping_ratio: f64,
}

impl From<Inertial> for mounts::InertialActuator {
    fn from(actuator: Inertial) -> Self {
        let Inertial { at, direction, mass, resonance, damping_ratio } = actuator;
        Self { at, direction, mass, resonance, damping_ratio }
    }
}

/// Phasors of actuators within bounds that leave the least at receivers, (`n_points`, `n_actuators`), of
/// what is there without them, (`n_points`, `n_rows`), and of a unit of each, (`n_points`, `n_rows`, `n_actuators`).
#[guarded]
#[pyfunction]
pub fn actuator_phasors<'py>(
    py: Python<'py>,
    target: PyReadonlyArray2<'_, Complex64>,
    effect: PyReadonlyArray3<'_, Complex64>,
    bounds: PyReadonlyArray2<'_, f64>,
    effort: f64,
    widths: Option<Vec<usize>>,
) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
    let (target, effect, shape) = (target.as_slice()?, effect.as_slice()?, bounds.as_array().dim());
    let (bounds, widths) = (bounds.as_slice()?, widths.as_deref());
    let request = PhasorRequest { target, effect, bounds, actuators: shape.1, effort, widths };
    let found = interrupt::run(py, |cancel| phasors::least(&request, cancel))?;
    frozen(py, memory::array("actuators", shape, found).or_raise()?)
}

/// Share, from 0 to 1, of a change of phasors that leaves the least: the least largest length of groups of rows, or the
/// least sum of squares; None where the change is nothing.
#[guarded]
#[pyfunction]
pub fn least_share(
    py: Python<'_>,
    start: PyReadonlyArray1<'_, Complex64>,
    change: PyReadonlyArray1<'_, Complex64>,
    widths: Option<Vec<usize>>,
) -> PyResult<Option<f64>> {
    let (start, change) = (start.as_slice()?, change.as_slice()?);
    interrupt::run(py, |cancel| phasors::least_share(start, change, widths.as_deref(), cancel))
}

/// A law that adapts actuators' phasors to what receivers measure, at some points.
#[pyclass(frozen, module = "crankpin._core")]
pub struct AdaptiveLaw {
    core: adaptive::AdaptiveLaw,
    largest_steps: Vec<f64>,
}

#[guarded]
#[pymethods]
impl AdaptiveLaw {
    /// Of what a unit of each actuator does, (`n_points`, `n_rows`, `n_actuators`), and errors of the model's phase.
    #[new]
    fn new(
        py: Python<'_>,
        effect: PyReadonlyArray3<'_, Complex64>,
        error_deg: PyReadonlyArray1<'_, f64>,
        step: f64,
        update_delay: usize,
    ) -> PyResult<Self> {
        let (.., actuators) = effect.as_array().dim();
        let (effect, errors) = (effect.as_slice()?, error_deg.as_slice()?);
        let largest_steps =
            errors.iter().map(|&error| adaptive::largest_step(error, update_delay)).collect();
        let core = interrupt::run(py, |cancel| {
            adaptive::AdaptiveLaw::new(effect, actuators, errors, step, update_delay, cancel)
        })?;
        Ok(Self { core, largest_steps })
    }

    /// Step from which on it diverges at each point.
    fn largest_steps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        frozen(py, self.largest_steps.clone().into())
    }

    /// Attenuation of the slowest part at each point, dB per update.
    fn rates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        frozen(py, interrupt::run(py, |cancel| self.core.rates(cancel))?.into())
    }

    /// What is left after each update, over what there was: (`n_points`, `updates` + 1).
    fn residuals<'py>(
        &self,
        py: Python<'py>,
        target: PyReadonlyArray2<'_, Complex64>,
        updates: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (target, shape) = (target.as_slice()?, (self.largest_steps.len(), updates + 1));
        interrupt::written(py, shape, None, |out, cancel| {
            self.core.write_residuals(target, out, cancel)
        })
    }
}

/// Objectives of an engine on mounts that vary.
#[pyclass(frozen, module = "crankpin._core")]
pub struct MountObjectives(mount_objectives::MountObjectives);

#[guarded]
#[pymethods]
impl MountObjectives {
    /// Variables are mounts and what varies of them; roll the square of its angular speed, and whether it is required.
    #[new]
    fn new(
        powertrain: &Bound<'_, Powertrain>,
        engine: Option<&Bound<'_, Engine>>,
        variables: Vec<(usize, String)>,
        objectives: Vec<(String, Option<OrderNumber>)>,
        rpm: Vec<f64>,
        frequency: Option<f64>,
        roll: (f64, bool),
    ) -> PyResult<Self> {
        let kinds = [
            ("stiffness", MountVariable::Stiffness),
            ("tilt_deg", MountVariable::Tilt),
            ("x", MountVariable::Along(0)),
            ("y", MountVariable::Along(1)),
            ("z", MountVariable::Along(2)),
        ];
        let variables = variables
            .into_iter()
            .map(|(mount, kind)| Ok((mount, choice("vary", &kind, &kinds)?)))
            .collect::<PyResult<_>>()?;
        let objective = |(name, order): (String, Option<OrderNumber>)| {
            let order = order.map(|order| convert::orders(&[order])).transpose()?;
            Ok(match (&*name, order.as_deref()) {
                ("body_force", Some(&[order])) => MountObjective::BodyForce(order),
                ("mount_force", Some(&[order])) => MountObjective::MountForce(order),
                ("purity", _) => MountObjective::Purity,
                _ => MountObjective::Decoupling,
            })
        };
        let objectives = objectives.into_iter().map(objective).collect::<PyResult<_>>()?;
        let (engine, base) = (core_of(engine).cloned(), powertrain.get().0.as_ref().clone());
        Ok(Self(mount_objectives::MountObjectives {
            engine,
            base,
            variables,
            objectives,
            rpm,
            frequency,
            roll,
        }))
    }

    /// The objectives, with norms in place of maxima.
    fn values(&self, py: Python<'_>, values: Vec<f64>) -> PyResult<Vec<f64>> {
        interrupt::run(py, |cancel| self.0.values(&values, cancel))
    }

    /// Natural frequencies, Hz.
    fn frequencies(&self, values: Vec<f64>) -> PyResult<Vec<f64>> {
        self.0.frequencies(&values).or_raise()
    }

    /// Linear equations of decoupling: a row for each stiffness that varies, and the right side.
    fn equations<'py>(
        &self,
        py: Python<'py>,
        values: Vec<f64>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, [f64; 6])> {
        let (columns, right) = self.0.equations(&values).or_raise()?;
        let columns: Vec<[f64; 6]> = columns.into_iter().map(Into::into).collect();
        Ok((frozen(py, Array2::from(columns))?, right.into()))
    }

    /// The mounts with these values.
    fn mounts(&self, values: Vec<f64>) -> PyResult<Vec<Figures>> {
        Ok(mount_figures(&self.0.design(&values).or_raise()?))
    }
}

/// Largest magnitude along x, y and z, and largest length, of each row of vectors, one of each order.
#[guarded]
#[pyfunction]
pub fn peaks_of_vectors<'py>(
    py: Python<'py>,
    orders: Vec<OrderNumber>,
    phasors: PyReadonlyArray2<'_, Complex64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let orders = convert::orders(&orders)?;
    let (vectors, _) = phasors.as_slice()?.as_chunks::<3>();
    let peaks = interrupt::run(py, |cancel| largest_vectors(&orders, vectors, cancel))?;
    frozen(py, Array2::from(peaks))
}
