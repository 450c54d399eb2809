//! Cylinder pressure over a cycle.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use crate::array::{frozen, writeable};
use crankpin_core as core;
use crankpin_core::layout::Strokes;
use crankpin_core::pressure::Given;
use crankpin_core::pressure::burn::{Heat, WallLoss, Wiebe};
use crankpin_core::pressure::chamber::{Chamber, Compressor, Face, Ideal, Swept};
use crankpin_core::pressure::encoder::{self, Signal, Wheel};
use crankpin_core::pressure::example::{Example, ExampleKind};
use crankpin_core::pressure::map::between;
use crankpin_core::pressure::preparation;
use crankpin_core::{Complex64, memory, order};
use crankpin_macros::guarded;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::convert::{OrRaise, Parts, cylinder, orders_of_halves};
use crate::engine::{choice, entry};
use crate::interrupt;

/// Points of a cycle, checked, and what interpolates between them.
#[pyclass(frozen, eq, hash, module = "crankpin._core")]
#[derive(Clone, PartialEq)]
pub struct Cycle(pub Arc<core::Cycle>);

impl From<core::Cycle> for Cycle {
    fn from(cycle: core::Cycle) -> Self {
        Self(Arc::new(cycle))
    }
}

impl Hash for Cycle {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let given = self.0.given();
        (given.theta_deg.len(), given.strokes, &given.name).hash(state);
        given.pressure.first().map(|value| value.to_bits()).hash(state);
    }
}

/// Crank angle of the largest pressure of a motored cycle, between points, degrees.
#[guarded]
#[pyfunction]
pub fn compression_peak(
    theta_deg: PyReadonlyArray1<'_, f64>,
    pressure: PyReadonlyArray1<'_, f64>,
    period_deg: f64,
) -> PyResult<f64> {
    preparation::compression_peak(theta_deg.as_slice()?, pressure.as_slice()?, period_deg)
        .or_raise()
}

/// Exponent of a polytropic compression at crank angles, degrees, fitted if it is None, and what must be added to
/// the pressure of each cycle, (`n_cycles`, `n_theta`), that it is one.
#[guarded]
#[pyfunction]
pub fn polytropic_offsets<'py>(
    py: Python<'py>,
    figures: (Parts, f64, f64, u32),
    theta_deg: PyReadonlyArray1<'_, f64>,
    pressure: PyReadonlyArray2<'_, f64>,
    exponent: Option<f64>,
) -> PyResult<(f64, Bound<'py, PyArray1<f64>>)> {
    let (parts, bore, compression_ratio, strokes) = figures;
    let chamber = chamber(parts, bore, compression_ratio, strokes)?;
    let (thetas, pressure) = (theta_deg.as_slice()?, pressure.as_array());
    let (exponent, offsets) = interrupt::run(py, |cancel| {
        core::crank_angles::check(thetas, cancel)?;
        preparation::polytropic_offsets(&chamber, thetas, &pressure, exponent, cancel)
    })?;
    Ok((exponent, frozen(py, offsets.into())?))
}

/// Apparent net heat from the first of crank angles to each, J: (`n_cycles`, `n_theta`).
#[guarded]
#[pyfunction]
pub fn heat_release<'py>(
    py: Python<'py>,
    figures: (Parts, f64, f64, u32),
    theta_deg: PyReadonlyArray1<'_, f64>,
    pressure: PyReadonlyArray2<'_, f64>,
    gamma: f64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (parts, bore, compression_ratio, strokes) = figures;
    let chamber = chamber(parts, bore, compression_ratio, strokes)?;
    let (thetas, pressure) = (theta_deg.as_slice()?, pressure.as_array());
    let heats = interrupt::run(py, |cancel| {
        core::crank_angles::check(thetas, cancel)?;
        let heats = preparation::heat_release(&chamber, thetas, &pressure, gamma, cancel)?;
        memory::array("theta_deg", pressure.dim(), heats)
    })?;
    writeable(py, heats)
}

/// Pressure of cycles in a row without what is above an order of crank speed: (`n_cycles`, `n_theta`).
#[guarded]
#[pyfunction]
pub fn low_passed<'py>(
    py: Python<'py>,
    theta_deg: PyReadonlyArray1<'_, f64>,
    pressure: PyReadonlyArray2<'_, f64>,
    period_deg: f64,
    order: f64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (thetas, pressure) = (theta_deg.as_slice()?, pressure.as_array());
    let smooth = interrupt::run(py, |cancel| {
        let smooth = preparation::low_passed(thetas, &pressure, period_deg, order, cancel)?;
        memory::array("pressure", pressure.dim(), smooth)
    })?;
    writeable(py, smooth)
}

type Recorded<'py> = (PyReadonlyArray1<'py, f64>, Option<f64>, bool);
type Clock<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, u32, Vec<(f64, i64)>);

/// Times and crank angles, degrees, of the pulses of an encoder; turns between marks of the index; times of faults,
/// with the number of missing pulses or −1. Signals are values, threshold, and whether pulses are where they fall.
#[guarded]
#[pyfunction]
pub fn crank_clock<'py>(
    py: Python<'py>,
    times: PyReadonlyArray1<'_, f64>,
    encoder: Recorded<'_>,
    pulses: &str,
    index: Option<Recorded<'_>>,
) -> PyResult<Clock<'py>> {
    fn signal<'a>(
        name: &'static str,
        (values, threshold, falls): &'a Recorded<'_>,
    ) -> PyResult<Signal<'a>> {
        Ok(Signal { name, values: values.as_slice()?, threshold: *threshold, falls: *falls })
    }
    let wheel = Wheel::parse(pulses).or_raise()?;
    let (times, of_encoder) = (times.as_slice()?, signal("encoder", &encoder)?);
    let of_index = index.as_ref().map(|index| signal("index", index)).transpose()?;
    let clock = interrupt::run(py, |cancel| {
        encoder::crank_clock(times, &of_encoder, wheel, of_index.as_ref(), cancel)
    })?;
    let faults = clock.faults.iter().map(|fault| (fault.seconds, fault.missing)).collect();
    let angles = frozen(py, clock.angles_deg.into())?;
    Ok((frozen(py, clock.times.into())?, angles, clock.turns_per_mark, faults))
}

/// Values at places of the cubics through the four points about each.
#[guarded]
#[pyfunction]
pub fn cubics<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'_, f64>,
    y: PyReadonlyArray1<'_, f64>,
    at: PyReadonlyArray1<'_, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (x, y, at) = (x.as_slice()?, y.as_slice()?, at.as_slice()?);
    let values = interrupt::run(py, |cancel| encoder::cubics(x, y, at, cancel))?;
    writeable(py, values.into())
}

/// Whether cylinders fire a turn later than at dead centres, by pressure of each over crank angles.
#[guarded]
#[pyfunction]
pub fn fires_a_turn_later(
    py: Python<'_>,
    angles_deg: PyReadonlyArray1<'_, f64>,
    pressure: PyReadonlyArray2<'_, f64>,
    tdc_deg: Vec<f64>,
) -> PyResult<bool> {
    let (angles, pressure) = (angles_deg.as_slice()?, pressure.as_array());
    interrupt::run(py, |cancel| encoder::fires_a_turn_later(angles, &pressure, &tdc_deg, cancel))
}

/// Speed, rpm, at equal steps of cycles that start at crank angles: (`n_cycles`, `n_points`); highest harmonic of the
/// cycle that pulses resolve.
#[guarded]
#[pyfunction]
pub fn speed_within_cycles<'py>(
    py: Python<'py>,
    times: PyReadonlyArray1<'_, f64>,
    angles_deg: PyReadonlyArray1<'_, f64>,
    pulses: &str,
    starts_deg: Vec<f64>,
    period_deg: f64,
    points: usize,
) -> PyResult<(Bound<'py, PyArray2<f64>>, usize)> {
    let clock = (times.as_slice()?, angles_deg.as_slice()?);
    let wheel = Wheel::parse(pulses).or_raise()?;
    let speeds = interrupt::run(py, |cancel| {
        let speeds =
            encoder::speed_within_cycles(clock, wheel, &starts_deg, period_deg, points, cancel)?;
        memory::array("encoder", (starts_deg.len(), points), speeds)
    })?;
    Ok((frozen(py, speeds)?, wheel.harmonics(period_deg)))
}

/// Peak phasors, at orders counted in halves, of curves at equal steps of a period: (`n_curves`, `n_orders`).
#[guarded]
#[pyfunction]
pub fn phasors_of_curves<'py>(
    py: Python<'py>,
    curves: PyReadonlyArray2<'_, f64>,
    period_deg: f64,
    halves: Vec<u32>,
) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
    let (curves, orders) = (curves.as_array(), orders_of_halves(halves)?);
    let phasors = interrupt::run(py, |cancel| {
        let phasors = encoder::phasors(&curves, period_deg, &orders, cancel)?;
        memory::array("orders", (curves.nrows(), orders.len()), phasors)
    })?;
    writeable(py, phasors)
}

type PlacesOnAxis<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<f64>>);

/// Places of values among the speeds or loads of a map: the lower neighbour of each, and the weight of the
/// upper one.
#[guarded]
#[pyfunction]
pub fn places_on_axis<'py>(
    py: Python<'py>,
    name: &str,
    axis: PyReadonlyArray1<'_, f64>,
    values: PyReadonlyArray1<'_, f64>,
) -> PyResult<PlacesOnAxis<'py>> {
    let (axis, values) = (axis.as_slice()?, values.as_slice()?);
    let places = interrupt::run(py, |cancel| between(name, axis, values, cancel))?;
    let lower = places.iter().map(|place| place.lower as i64).collect();
    let shares = places.iter().map(|place| place.share).collect();
    Ok((frozen(py, lower)?, frozen(py, shares)?))
}

/// Whether the last of ascending crank angles repeats the first, a period later; None if they do not
/// cover the period.
#[guarded]
#[pyfunction]
pub fn repeats_first(
    argument: &str,
    theta_deg: PyReadonlyArray1<'_, f64>,
    period_deg: f64,
) -> PyResult<Option<bool>> {
    let theta_deg = theta_deg.as_slice()?;
    core::crank_angles::check_grid(argument, theta_deg).or_raise()?;
    Ok(core::crank_angles::repeats_first(theta_deg, period_deg))
}

/// What a cycle is made of.
#[derive(IntoPyObject)]
struct Points<'py> {
    theta_deg: Bound<'py, PyArray1<f64>>,
    pressure: Bound<'py, PyArray1<f64>>,
    strokes: u32,
    name: String,
    degree: Option<usize>,
}

#[guarded]
#[pymethods]
impl Cycle {
    #[new]
    fn new(
        theta_deg: PyReadonlyArray1<'_, f64>,
        pressure: PyReadonlyArray1<'_, f64>,
        strokes: u32,
        name: String,
        degree: Option<usize>,
    ) -> PyResult<Self> {
        let (theta_deg, pressure) = (theta_deg.as_slice()?, pressure.as_slice()?);
        let longest = core::pressure::MOST_POINTS + 1;
        // One more than may be is enough for the error.
        let few = |values: &[f64]| values[..values.len().min(longest)].to_vec();
        let given =
            Given { name, strokes, theta_deg: few(theta_deg), pressure: few(pressure), degree };
        core::Cycle::new(given).or_raise().map(Self::from)
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Points<'py>> {
        let Given { name, strokes, theta_deg, pressure, degree } = self.0.given().clone();
        let theta_deg = frozen(py, theta_deg.into())?;
        Ok(Points { theta_deg, pressure: frozen(py, pressure.into())?, strokes, name, degree })
    }

    /// Polytropic curves and ideal combustion.
    #[staticmethod]
    fn ideal(
        parts: Parts,
        bore: f64,
        compression_ratio: f64,
        strokes: u32,
        name: String,
        figures: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let chamber = chamber(parts, bore, compression_ratio, strokes)?;
        let ideal = Ideal {
            pressure_ratio: entry(figures, "pressure_ratio")?,
            cutoff_ratio: entry(figures, "cutoff_ratio")?,
            compression_exponent: entry(figures, "compression_exponent")?,
            expansion_exponent: entry(figures, "expansion_exponent")?,
            intake_pressure: entry(figures, "intake_pressure")?,
            exhaust_pressure: entry(figures, "exhaust_pressure")?,
        };
        ideal.cycle(&chamber, name).or_raise().map(Self::from)
    }

    /// A compressor's at an end of a piston: `discharge` is None for an end that is unloaded.
    #[staticmethod]
    fn compressor(
        parts: Parts,
        end: &str,
        name: String,
        figures: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let compressor = Compressor {
            suction: entry(figures, "suction")?,
            discharge: entry(figures, "discharge")?,
            clearance: entry(figures, "clearance")?,
            n: entry(figures, "n")?,
            expansion_n: entry(figures, "expansion_n")?,
        };
        let swept = Swept::new(&cylinder(parts)?, face(end)?);
        compressor.cycle(&swept, name).or_raise().map(Self::from)
    }

    /// One zone with a Wiebe burn: `heat` in J, or None for that of fuel at `excess_air`; a wall
    /// temperature or None.
    #[staticmethod]
    fn wiebe(
        py: Python<'_>,
        parts: Parts,
        bore: f64,
        compression_ratio: f64,
        strokes: u32,
        name: String,
        figures: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let chamber = chamber(parts, bore, compression_ratio, strokes)?;
        let heat = match entry::<Option<f64>>(figures, "heat")? {
            Some(joules) => Heat::Given(joules),
            None => Heat::Fuel {
                excess_air: entry(figures, "excess_air")?,
                stoichiometric_ratio: entry(figures, "stoichiometric_ratio")?,
                heating_value: entry(figures, "heating_value")?,
            },
        };
        let wall = match entry::<Option<f64>>(figures, "wall_temperature")? {
            Some(temperature) => Some(WallLoss { temperature, rpm: entry(figures, "rpm")? }),
            None => None,
        };
        let wiebe = Wiebe {
            heat,
            start_deg: entry(figures, "start_deg")?,
            duration_deg: entry(figures, "duration_deg")?,
            a: entry(figures, "a")?,
            m: entry(figures, "m")?,
            gamma: entry(figures, "gamma")?,
            intake_pressure: entry(figures, "intake_pressure")?,
            exhaust_pressure: entry(figures, "exhaust_pressure")?,
            charge_temperature: entry(figures, "charge_temperature")?,
            intake_closes_deg: entry(figures, "intake_closes_deg")?,
            exhaust_opens_deg: entry(figures, "exhaust_opens_deg")?,
            wall,
        };
        interrupt::run(py, |cancel| wiebe.cycle(&chamber, name, cancel)).map(Self::from)
    }

    /// Figures of a computed cycle to begin with: name, compression ratio, and those of [`Self::wiebe`].
    #[staticmethod]
    fn example(
        py: Python<'_>,
        kind: &str,
        load: f64,
        strokes: u32,
    ) -> PyResult<(String, f64, Vec<(&'static str, f64)>)> {
        let kind = choice(
            "kind",
            kind,
            &[("petrol", ExampleKind::Petrol), ("diesel", ExampleKind::Diesel)],
        )?;
        let strokes = Strokes::from_number(strokes).or_raise()?;
        let found = interrupt::run(py, |cancel| Example::new(kind, load, strokes, cancel))?;
        Ok((found.name, found.compression_ratio, found.wiebe.figures()))
    }

    /// Weighted sum of cycles.
    #[staticmethod]
    fn blend(cycles: Vec<(f64, Bound<'_, Self>)>, name: String) -> PyResult<Self> {
        let parts: Vec<_> =
            cycles.iter().map(|(weight, cycle)| (*weight, &*cycle.get().0)).collect();
        core::Cycle::blend(&parts, name).or_raise().map(Self::from)
    }

    fn __len__(&self) -> usize {
        self.0.given().theta_deg.len()
    }

    #[getter]
    fn is_closed(&self) -> bool {
        self.0.is_closed()
    }

    /// Every other point.
    fn thinned(&self, from_second: bool) -> Option<Self> {
        self.0.thinned(from_second).map(Self::from)
    }

    /// Absolute pressure at crank angles, degrees.
    fn pressure<'py>(
        &self,
        py: Python<'py>,
        theta_deg: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let thetas = theta_deg.as_slice()?;
        interrupt::written(py, [thetas.len()], None, |out, cancel| {
            core::crank_angles::check(thetas, cancel)?;
            for (k, (value, &theta)) in out.iter_mut().zip(thetas).enumerate() {
                if k % 4096 == 0 {
                    cancel.check()?;
                }
                *value = self.0.pressure_deg(theta);
            }
            Ok(())
        })
    }

    /// Indicated mean effective pressure over a cylinder's piston, Pa.
    fn imep(&self, py: Python<'_>, parts: Parts, end: &str) -> PyResult<f64> {
        let (cylinder, face) = (cylinder(parts)?, face(end)?);
        interrupt::run(py, |cancel| self.0.imep_at(face, &cylinder, cancel))
    }

    /// Torque over piston area and crank radius above a crankcase pressure: mean, phasors at orders
    /// given in halves.
    fn torque<'py>(
        &self,
        py: Python<'py>,
        parts: Parts,
        crankcase: f64,
        halves: Vec<u32>,
    ) -> PyResult<(f64, Bound<'py, PyArray1<Complex64>>)> {
        let mechanism = cylinder(parts)?.mechanism();
        let crankcase = core::limits::finite("crankcase", crankcase).or_raise()?;
        let orders = orders_of_halves(halves)?;
        if !orders.is_empty() {
            order::check_list(&orders).or_raise()?;
        }
        let torque =
            interrupt::run(py, |cancel| self.0.torque_of(&mechanism, crankcase, &orders, cancel))?;
        Ok((torque.mean, writeable(py, torque.phasors.into())?))
    }
}

/// The face of a piston at an end of its cylinder.
fn face(end: &str) -> PyResult<Face> {
    choice("end", end, &[("head", Face::Outer), ("crank", Face::Inner)])
}

fn chamber(parts: Parts, bore: f64, compression_ratio: f64, strokes: u32) -> PyResult<Chamber> {
    let strokes = Strokes::from_number(strokes).or_raise()?;
    Chamber::new(&cylinder(parts)?, bore, compression_ratio, strokes).or_raise()
}
