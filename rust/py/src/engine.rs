//! Engines: lists, builders, files.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use crate::array::frozen;
use crankpin_core as core;
use crankpin_core::engine::crankpins::Crankpin;
use crankpin_core::engine::radial::Radial;
use crankpin_core::engine::{
    Crank, CrankEnd, CrankIndex, Details, EngineOnCrank, EqualTravel, Gas, Hold, LinkRod, LinkRods,
    PeriodicLoad, RodFigures, Shaft, Station, Unbalance, file,
};
use crankpin_core::index::ListIndex;
use crankpin_core::layout::{
    FiringOrder, FiringRule, Inline, MultiBankLayout, Numbering, Side, Spacing, Strokes, Vee,
};
use crankpin_core::{Complex64, Error, limits};
use crankpin_macros::guarded;
use ndarray::Array1;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use crate::boundary;
use crate::convert::{Angle, OrRaise, Parts, RatioNumber, angles, cylinder, python_error, ratio};
use crate::interrupt;
use crate::pressure::Cycle;

/// An engine of the core.
#[pyclass(frozen, eq, module = "crankpin._core", from_py_object)]
#[derive(Clone, PartialEq)]
pub struct Engine(pub Arc<core::Engine>);

impl From<core::Engine> for Engine {
    fn from(engine: core::Engine) -> Self {
        Self(Arc::new(engine))
    }
}

/// One of a few words.
pub fn choice<T>(argument: &str, value: &str, choices: &[(&str, T)]) -> PyResult<T>
where
    T: Copy,
{
    if let Some((_, chosen)) = choices.iter().find(|(name, _)| *name == value) {
        return Ok(*chosen);
    }
    let names: Vec<String> = choices.iter().map(|(name, _)| format!("\"{name}\"")).collect();
    let hint = format!("give {}", names.join(" or "));
    Err(python_error(Error::value(argument, format!("\"{value}\""), hint)))
}

/// Amount in kg·m, degrees as text that reads back exactly, z in m, index of the pin's cylinder, index of
/// the crank.
pub type Weight = (f64, String, f64, Option<usize>, usize);
/// The same, its angle read.
type GivenWeight = (f64, Angle, f64, Option<usize>, usize);
/// A bay: numbers of its cylinders, places, m, and index of its crank.
#[derive(IntoPyObject)]
struct Bay<'py> {
    cylinders: Bound<'py, PyTuple>,
    throws: Bound<'py, PyTuple>,
    bearings: (f64, f64),
    crank: usize,
}

/// Bore, piston mass, the rod's mass, inertia and place of its centre, and whether it is a dummy, or driven by side
/// rods.
type Kept = (Option<f64>, Option<f64>, Option<(f64, f64, f64)>, bool, bool);

/// Index of the master's cylinder, radius of the knuckle, m, its angle as text that reads back exactly, mass, kg.
type Link = (usize, f64, String, f64);
/// The same, its angle read.
type GivenLink = (usize, f64, Angle, f64);
/// Angles of highest and lowest point, degrees, height and stroke, m, and compression ratio.
type Ends = (f64, f64, f64, f64, Option<f64>);

/// A crankpin: numbers of its cylinders, its place, m, and index of its crank.
#[derive(IntoPyObject)]
struct PinFigures<'py> {
    cylinders: Bound<'py, PyTuple>,
    pin_deg: f64,
    z: f64,
    crank: usize,
}

impl<'py> PinFigures<'py> {
    fn new(py: Python<'py>, pin: &Crankpin) -> PyResult<Self> {
        let cylinders = PyTuple::new(py, numbers(&pin.cylinders))?;
        let (pin_deg, crank) = (pin.pin.degrees(), pin.crank.position());
        Ok(Self { cylinders, pin_deg, z: pin.z, crank })
    }
}

/// Axis and speed ratio of each crankshaft, the main one first, and of each cylinder the index of its own.
type Cranks = (Vec<(f64, f64, RatioNumber)>, Vec<usize>);

/// Cylinders by number.
pub fn numbers(cylinders: &[usize]) -> Vec<usize> {
    cylinders.iter().map(|k| k + 1).collect()
}

/// An unbalance for Python.
pub fn weight(unbalance: &Unbalance) -> Weight {
    let Unbalance { amount, angle, z, pin, crank } = *unbalance;
    (amount, angle.to_string(), z, pin, crank.position())
}

fn unbalance((amount, angle, z, pin, crank): GivenWeight) -> Unbalance {
    Unbalance { amount, angle: angle.0, z, pin, crank: CrankIndex::new(crank) }
}

/// What a change of bank angle holds.
pub fn hold(value: &str) -> PyResult<Hold> {
    choice("hold", value, &[("pins", Hold::Pins), ("firing", Hold::Firing)])
}

/// How a firing order fixes the crank.
pub fn firing_rule(
    rule: &str,
    intervals: Option<Vec<Angle>>,
    strokes: u32,
) -> PyResult<FiringRule> {
    let ijesc = choice("rule", rule, &[("even", false), ("ijesc", true)])?;
    let strokes = Strokes::from_number(strokes).or_raise()?;
    let unsuited = |argument: &str, value: String, hint: &str| {
        Err(python_error(Error::value(argument, value, hint)))
    };
    match (ijesc, intervals, strokes) {
        (false, None, _) => Ok(FiringRule::Even(strokes)),
        (false, Some(intervals), _) => Ok(FiringRule::Intervals(strokes, angles(intervals))),
        (true, Some(intervals), _) => {
            let hint = "the rule \"ijesc\" sets the intervals itself; leave them out";
            unsuited("intervals_deg", format!("{} given", intervals.len()), hint)
        }
        (true, None, Strokes::Two) => {
            unsuited("strokes", "2".into(), "the rule \"ijesc\" is that of a four-stroke; give 4")
        }
        (true, None, Strokes::Four) => Ok(FiringRule::Ijesc),
    }
}

fn same_length(argument: &str, found: usize, expected: usize) -> PyResult<()> {
    limits::same_length(argument, found, "bank_deg", expected, "cylinder").or_raise()
}

impl Engine {
    /// The engine with a force given for every cylinder, order by order, if there is one.
    pub fn with_spectrum(
        &self,
        spectrum: Option<Vec<(u32, Complex64)>>,
    ) -> PyResult<Arc<core::Engine>> {
        let Some(terms) = spectrum else { return Ok(Arc::clone(&self.0)) };
        let spectrum = core::Spectrum::new(terms).or_raise()?;
        Ok(Arc::new(self.0.with_spectrum(spectrum)))
    }

    fn column<'py>(
        &self,
        py: Python<'py>,
        value: impl Fn(&Station) -> f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        frozen(py, self.0.stations().iter().map(value).collect::<Array1<f64>>())
    }
}

/// An entry of a layout, with the error that its own conversion raises.
pub fn entry<T>(layout: &Bound<'_, PyAny>, name: &str) -> PyResult<T>
where
    T: for<'a, 'py> FromPyObject<'a, 'py, Error = PyErr>,
{
    layout.get_item(name)?.extract()
}

/// Distances of throws, one or a list.
fn spacing(layout: &Bound<'_, PyAny>) -> PyResult<Option<Spacing>> {
    let given = layout.get_item("spacing")?;
    if given.is_none() {
        return Ok(None);
    }
    if given.is_instance_of::<PyList>() {
        return Ok(Some(Spacing::Each(given.extract()?)));
    }
    Ok(Some(Spacing::Even(given.extract()?)))
}

/// Where the cylinders of a vee sit and how they are numbered.
pub struct VeeLayout(pub Vee);

impl<'py> FromPyObject<'_, 'py> for VeeLayout {
    type Error = PyErr;

    fn extract(layout: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let angle = |name: &str| entry::<Angle>(&layout, name).map(|angle| angle.0);
        let InlineLayout(Inline { throws, spacing, rotating_mass, first_tdc }) =
            layout.extract()?;
        let numberings = [("alternating", Numbering::Alternating), ("by-bank", Numbering::ByBank)];
        let sides = [("right", Side::Right), ("left", Side::Left)];
        Ok(Self(Vee {
            bank_angle: angle("bank_angle")?,
            throws,
            spacing,
            pin_split: angle("pin_split")?,
            bank_stagger: entry(&layout, "bank_stagger")?,
            rotating_mass,
            absent: entry(&layout, "absent")?,
            numbering: choice("numbering", &entry::<String>(&layout, "numbering")?, &numberings)?,
            first_bank: choice("odd_bank", &entry::<String>(&layout, "odd_bank")?, &sides)?,
            first_tdc,
        }))
    }
}

/// Where the cylinders of an engine with several banks sit.
struct FanLayout(MultiBankLayout);

impl<'py> FromPyObject<'_, 'py> for FanLayout {
    type Error = PyErr;

    fn extract(layout: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(MultiBankLayout {
            banks: angles(entry(&layout, "banks")?),
            bank_stagger: entry(&layout, "bank_stagger")?,
            along: layout.extract::<InlineLayout>()?.0,
        }))
    }
}

/// Where the cylinders of an inline engine sit.
struct InlineLayout(Inline);

impl<'py> FromPyObject<'_, 'py> for InlineLayout {
    type Error = PyErr;

    fn extract(layout: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(Inline {
            throws: angles(entry(&layout, "throws")?),
            spacing: spacing(&layout)?.unwrap_or(Spacing::Even(0.0)),
            rotating_mass: entry(&layout, "rotating_mass")?,
            first_tdc: entry::<Angle>(&layout, "first_tdc")?.0,
        }))
    }
}

/// Where the cylinders of a radial stand.
struct RadialLayout(Radial);

impl<'py> FromPyObject<'_, 'py> for RadialLayout {
    type Error = PyErr;

    fn extract(layout: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let count = |name: &str| -> PyResult<usize> {
            let value = layout.get_item(name)?;
            let hint = "give a whole number from 1 on, of few digits";
            value.extract().or_else(|_: PyErr| Err(Error::value(name, &value, hint)).or_raise())
        };
        Ok(Self(Radial {
            cylinders: count("cylinders")?,
            rows: count("rows")?,
            spacing: spacing(&layout)?,
            rotating_mass: entry(&layout, "rotating_mass")?,
            first_tdc: entry::<Angle>(&layout, "first_tdc")?.0,
        }))
    }
}

#[guarded]
#[pymethods]
impl Engine {
    #[staticmethod]
    #[expect(clippy::too_many_arguments, reason = "an engine is this many lists")]
    fn from_lists(
        cylinders: Vec<Parts>,
        tdc_deg: Option<Vec<Angle>>,
        pin_deg: Option<Vec<Angle>>,
        bank_deg: Vec<Angle>,
        bank: Option<Vec<usize>>,
        z: Vec<f64>,
        rotating_mass: Vec<f64>,
        cranks: Option<Cranks>,
    ) -> PyResult<Self> {
        let count = bank_deg.len();
        same_length("cylinder", cylinders.len(), count)?;
        same_length("z", z.len(), count)?;
        same_length("rotating_mass", rotating_mass.len(), count)?;
        let banks = angles(bank_deg);
        let given = |argument: &str, list: Option<Vec<Angle>>| -> PyResult<_> {
            list.map(|list| same_length(argument, list.len(), count).map(|()| angles(list)))
                .transpose()
        };
        let (tdcs, pins) = match (given("tdc_deg", tdc_deg)?, given("pin_deg", pin_deg)?) {
            (Some(tdcs), None) => (tdcs, None),
            (None, Some(pins)) => (vec![core::Angle::ZERO; count], Some(pins)),
            (tdcs, _) => {
                let given = if tdcs.is_some() { "both given" } else { "neither given" };
                let hint = "give either the crank angles of top dead centre or the pins' angles";
                return Err(python_error(Error::value("tdc_deg and pin_deg", given, hint)));
            }
        };
        let mut stations = Vec::with_capacity(count);
        for (i, parts) in cylinders.into_iter().enumerate() {
            stations.push(Station {
                cylinder: cylinder(parts)?,
                tdc: tdcs[i],
                bank: banks[i],
                z: z[i],
                rotating_mass: rotating_mass[i],
            });
        }
        let further = |(cranks, of): Cranks| -> PyResult<_> {
            let crank = |(x, y, speed)| Ok(Crank { axis: [x, y], ratio: ratio(speed)? });
            Ok((cranks.into_iter().map(crank).collect::<PyResult<_>>()?, of))
        };
        let cranks = cranks.map(further).transpose()?;
        let engine = match bank {
            Some(bank) => {
                same_length("bank", bank.len(), count)?;
                core::Engine::in_banks("", "", stations, &bank)
            }
            None => core::Engine::new("", "", stations),
        };
        let engine = engine.and_then(|engine| match cranks {
            Some((cranks, crank_of)) => engine.with_cranks(cranks, crank_of),
            None => Ok(engine),
        });
        let engine = engine.and_then(|engine| match pins {
            Some(pins) => engine.with_pins(&pins),
            None => Ok(engine),
        });
        Ok(engine.or_raise()?.into())
    }

    /// One engine of several, the first on the main crank; of the others the crank, phase, tilt and place.
    #[staticmethod]
    fn on_cranks(
        engines: Vec<PyRef<'_, Self>>,
        cranks: Vec<(f64, f64, RatioNumber)>,
        phase_deg: Vec<Angle>,
        tilt_deg: Vec<Angle>,
        z: Vec<f64>,
        held: &str,
    ) -> PyResult<Self> {
        let mut parts = Vec::with_capacity(engines.len());
        for (k, engine) in engines.iter().enumerate() {
            let mut part = EngineOnCrank {
                engine: &engine.0,
                crank: Crank::MAIN,
                delay: core::Angle::ZERO,
                tilt: core::Angle::ZERO,
                z: 0.0,
            };
            if let Some(k) = k.checked_sub(1) {
                let (x, y, speed) = cranks[k];
                part.crank = Crank { axis: [x, y], ratio: ratio(speed)? };
                (part.delay, part.tilt, part.z) = (phase_deg[k].0, tilt_deg[k].0, z[k]);
            }
            parts.push(part);
        }
        core::Engine::on_cranks(&parts, hold(held)?).or_raise().map(Self::from)
    }

    #[staticmethod]
    fn inline(parts: Parts, layout: InlineLayout) -> PyResult<Self> {
        layout.0.engine(cylinder(parts)?).or_raise().map(Self::from)
    }

    #[staticmethod]
    fn vee(parts: Parts, layout: VeeLayout) -> PyResult<Self> {
        layout.0.engine(cylinder(parts)?).or_raise().map(Self::from)
    }

    #[staticmethod]
    fn fan(parts: Parts, layout: FanLayout) -> PyResult<Self> {
        layout.0.engine(cylinder(parts)?).or_raise().map(Self::from)
    }

    #[staticmethod]
    fn radial(parts: Parts, layout: RadialLayout) -> PyResult<Self> {
        layout.0.engine(cylinder(parts)?).or_raise().map(Self::from)
    }

    /// The even firing order of a radial; empty if there is none.
    #[staticmethod]
    fn radial_firing_order(layout: RadialLayout, strokes: u32) -> PyResult<String> {
        Ok(layout.0.firing_order(Strokes::from_number(strokes).or_raise()?))
    }

    #[staticmethod]
    fn inline_from_firing_order(
        parts: Parts,
        firing_order: &str,
        rule: &str,
        intervals: Option<Vec<Angle>>,
        strokes: u32,
        layout: InlineLayout,
    ) -> PyResult<Self> {
        let rule = firing_rule(rule, intervals, strokes)?;
        let order: FiringOrder = firing_order.parse().or_raise()?;
        order.inline(cylinder(parts)?, &rule, &layout.0).or_raise().map(Self::from)
    }

    #[staticmethod]
    fn vee_from_firing_order(
        parts: Parts,
        firing_order: &str,
        rule: &str,
        intervals: Option<Vec<Angle>>,
        strokes: u32,
        layout: VeeLayout,
    ) -> PyResult<Self> {
        let order: FiringOrder = firing_order.parse().or_raise()?;
        let rule = firing_rule(rule, intervals, strokes)?;
        order.vee(cylinder(parts)?, &rule, &layout.0).or_raise().map(Self::from)
    }

    #[staticmethod]
    fn from_toml(text: &str) -> PyResult<Self> {
        file::from_toml(text).or_raise().map(Self::from)
    }

    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        file::from_json(text).or_raise().map(Self::from)
    }

    #[staticmethod]
    fn from_json_text(text: &str) -> PyResult<Self> {
        file::from_json_text(text).or_raise().map(Self::from)
    }

    fn to_toml<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        boundary::text(py, &file::to_toml(&self.0).or_raise()?)
    }

    fn to_json<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        boundary::text(py, &file::to_json(&self.0).or_raise()?)
    }

    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// Numbers of the cylinders of each chamber that can fire.
    #[getter]
    fn chambers(&self) -> Vec<Vec<usize>> {
        self.0.chambers().iter().map(|chamber| numbers(chamber)).collect()
    }

    /// A text with its placeholders filled in.
    fn filled(&self, pattern: &str) -> String {
        self.0.filled(pattern)
    }

    #[getter]
    fn source(&self) -> &str {
        self.0.source()
    }

    #[getter]
    fn cylinders(&self) -> Vec<Parts> {
        let parts = |c: core::Cylinder| {
            let rod_inertia = c.rod_inertia_excess();
            (c.crank_radius(), c.rod_length(), c.reciprocating_mass(), c.pin_offset(), rod_inertia)
        };
        self.0.stations().iter().map(|p| parts(p.cylinder)).collect()
    }

    #[getter]
    fn tdc_deg<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.column(py, |p| p.tdc.degrees())
    }

    #[getter]
    fn bank_deg<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.column(py, |p| p.bank.degrees())
    }

    #[getter]
    fn pin_deg<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let pins = (0..self.0.stations().len()).map(|i| self.0.pin(i).degrees());
        frozen(py, pins.collect())
    }

    #[getter]
    fn z<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.column(py, |p| p.z)
    }

    #[getter]
    fn rotating_mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.column(py, |p| p.rotating_mass)
    }

    /// Angles as text that reads back exactly.
    #[getter]
    fn exact_angles(&self) -> (Vec<String>, Vec<String>) {
        let text = |angle: fn(&Station) -> core::Angle| {
            self.0.stations().iter().map(|p| angle(p).to_string()).collect()
        };
        (text(|p| p.tdc), text(|p| p.bank))
    }

    #[getter]
    fn bank_angle_deg(&self) -> PyResult<f64> {
        Ok(self.0.banks().or_raise()?.angle().degrees())
    }

    #[getter]
    fn largest_crank_radius(&self) -> f64 {
        self.0.largest_crank_radius()
    }

    /// Largest mean piston speed of any cylinder at a crank speed, m/s.
    fn mean_piston_speed(&self, rpm: f64) -> f64 {
        self.0.mean_piston_speed(rpm)
    }

    #[getter]
    fn middle(&self) -> f64 {
        self.0.middle()
    }

    /// Reference plane of moments that was given.
    #[getter]
    fn reference_z(&self) -> Option<f64> {
        self.0.reference_z()
    }

    /// Places of main bearings that were given.
    #[getter]
    fn mains(&self) -> Vec<f64> {
        self.0.mains().to_vec()
    }

    /// Places of main bearings, given or by default.
    #[getter]
    fn bearings(&self) -> Vec<f64> {
        self.0.bearings(CrankIndex::MAIN)
    }

    /// Crankpins from front to flywheel, those of one throw a list.
    fn throws<'py>(&self, py: Python<'py>) -> PyResult<Vec<Vec<PinFigures<'py>>>> {
        let throw =
            |throw: Vec<Crankpin>| throw.iter().map(|pin| PinFigures::new(py, pin)).collect();
        self.0.throws().into_iter().map(throw).collect()
    }

    /// Whether the crankpins of some cylinders, by number, point the same way but for rounding.
    fn pins_agree(&self, cylinders: Vec<usize>) -> bool {
        let mut pins = cylinders.iter().map(|number| self.0.pin(number - 1));
        pins.next().is_some_and(|first| pins.all(|pin| pin.is_direction_of(first)))
    }

    /// The crankpins from front to flywheel.
    fn crankpins<'py>(&self, py: Python<'py>) -> PyResult<Vec<PinFigures<'py>>> {
        self.0.crankpins().iter().map(|pin| PinFigures::new(py, pin)).collect()
    }

    /// The bays of all cranks.
    fn bays<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bay<'py>>> {
        let bay = |bay: core::engine::crankpins::Bay| {
            let cylinders = PyTuple::new(py, numbers(&bay.cylinders))?;
            let (throws, crank) = (PyTuple::new(py, bay.throws)?, bay.crank.position());
            Ok(Bay { cylinders, throws, bearings: bay.bearings.into(), crank })
        };
        self.0.bays().into_iter().map(bay).collect()
    }

    #[getter]
    fn cranks(&self) -> Cranks {
        let crank = |&Crank { axis: [x, y], ratio }: &Crank| (x, y, ratio.into());
        let of = (0..self.0.stations().len()).map(|i| self.0.crank_of(i).position());
        (self.0.cranks().iter().map(crank).collect(), of.collect())
    }

    #[getter]
    fn details(&self) -> Vec<Kept> {
        self.0
            .details()
            .iter()
            .map(|d| {
                let rod = d.rod.map(|r| (r.mass, r.inertia, r.to_crankpin));
                (d.bore, d.piston_mass, rod, d.dummy, d.side_rods)
            })
            .collect()
    }

    /// The same engine with what it keeps and does not compute with.
    fn keeping(
        &self,
        details: Vec<Kept>,
        mains: Vec<f64>,
        reference_z: Option<f64>,
    ) -> PyResult<Self> {
        let details = details.into_iter();
        let details = details.map(|(bore, piston_mass, rod, dummy, side_rods)| Details {
            bore,
            piston_mass,
            dummy,
            side_rods,
            rod: rod.map(|(mass, inertia, to_crankpin)| RodFigures { mass, inertia, to_crankpin }),
        });
        let engine = self.0.with_details(details.collect()).and_then(|e| e.with_mains(mains));
        engine.and_then(|e| e.with_reference(reference_z)).or_raise().map(Self::from)
    }

    /// Link rods of the cylinders that have one.
    #[getter]
    fn link_rods(&self) -> Vec<Option<Link>> {
        let link = |l: &LinkRod| (l.master, l.radius, l.angle.to_string(), l.big_end_mass);
        self.0.link_rods().iter().map(|own| own.as_ref().map(link)).collect()
    }

    fn with_link_rods(&self, link_rods: Vec<Option<GivenLink>>) -> PyResult<Self> {
        let link = |(master, radius, angle, big_end_mass): GivenLink| LinkRod {
            master,
            radius,
            angle: angle.0,
            big_end_mass,
        };
        let link_rods = link_rods.into_iter().map(|own| own.map(link)).collect();
        self.0.with_link_rods(link_rods).or_raise().map(Self::from)
    }

    /// With master rods in some cylinders, and link rods in those beside them.
    fn with_master_rods(
        &self,
        radius: Option<f64>,
        length: Option<f64>,
        angles_deg: Option<Vec<Angle>>,
        big_end_mass: Option<f64>,
        equal: Option<&str>,
        masters: Option<Vec<usize>>,
    ) -> PyResult<Self> {
        let (angles, equal) = (angles_deg.map(angles), equal.and_then(EqualTravel::named));
        let rods = LinkRods { radius, length, angles, big_end_mass, equal };
        self.0.with_master_rods(&rods, masters.as_deref()).or_raise().map(Self::from)
    }

    /// Angles of the highest and the lowest point, degrees, height and stroke, m, and compression ratio of each
    /// cylinder.
    fn dead_centres(&self, compression_ratio: Option<f64>) -> PyResult<Vec<Ends>> {
        let found = self.0.dead_centres(compression_ratio).or_raise()?;
        let ends = |e: core::engine::DeadCentres| {
            let [highest, lowest] = e.angles_deg;
            (highest, lowest, e.height, e.stroke, e.compression_ratio)
        };
        Ok(found.into_iter().map(ends).collect())
    }

    /// Ends of each rod at a crank angle, m: at its crankpin or knuckle, and at its piston.
    fn rod_ends(&self, theta_deg: f64) -> Vec<(Complex64, Complex64)> {
        self.0.rod_ends(theta_deg).into_iter().map(|[low, high]| (low, high)).collect()
    }

    fn with_bank_angle(&self, bank_angle: Angle, held: &str) -> PyResult<Self> {
        self.0.with_bank_angle(bank_angle.0, hold(held)?).or_raise().map(Self::from)
    }

    fn with_first_tdc(&self, tdc: Angle) -> Self {
        self.0.with_first_tdc(tdc.0).into()
    }

    /// Index of each cylinder's bank; of two banks 0 is the right one.
    #[getter]
    fn bank(&self) -> Vec<usize> {
        let right = self.0.banks().map_or(0, |banks| banks.right);
        let count = self.0.stations().len();
        (0..count).map(|i| self.0.bank_of(i)).map(|k| if right == 1 { 1 - k } else { k }).collect()
    }

    /// The engine with cycles, the index of that of each cylinder, or none, and a crankcase pressure,
    /// firing in its own firing order; of crank ends the index of the cycle and the rod's diameter.
    fn with_cycles(
        &self,
        py: Python<'_>,
        cycles: Vec<PyRef<'_, Cycle>>,
        cycle_of: Vec<Option<usize>>,
        crankcase: f64,
        crank_ends: Vec<Option<(usize, f64)>>,
    ) -> PyResult<Self> {
        let later = if self.0.strokes() == Strokes::Two && self.0.firing_order().is_empty() {
            // In every turn, in whatever order.
            vec![false; self.0.stations().len()]
        } else {
            // The camshaft is that of the whole engine, also where some cylinders do not fire.
            let whole = Arc::new(self.0.without_gas());
            interrupt::run(py, |cancel| core::Firing::own(&whole, cancel))?.fires_in_second_turn()
        };
        let cycles = cycles.iter().map(|cycle| Arc::clone(&cycle.0)).collect();
        let crank_ends = crank_ends
            .into_iter()
            .map(|end| end.map(|(cycle, rod_diameter)| CrankEnd { cycle, rod_diameter }))
            .collect();
        let gas = Gas { cycles, cycle_of, crank_ends, crankcase, later };
        self.0.with_gas(gas).or_raise().map(Self::from)
    }

    /// The engine with what another has of pressure in some of its cylinders, by index, above that
    /// of its crankcase or another.
    #[pyo3(signature = (other, cylinders, crankcase=None))]
    fn fired_as(
        &self,
        other: &Self,
        cylinders: Vec<usize>,
        crankcase: Option<f64>,
    ) -> PyResult<Self> {
        let (Some(gas), strokes) = (other.0.gas(), other.0.strokes()) else {
            return Ok(self.clone());
        };
        let gas = Gas {
            cycle_of: cylinders.iter().map(|&i| gas.cycle_of[i]).collect(),
            crank_ends: cylinders.iter().map(|&i| gas.crank_end(i)).collect(),
            later: cylinders.iter().map(|&i| gas.later[i]).collect(),
            crankcase: crankcase.unwrap_or(gas.crankcase),
            ..gas.clone()
        };
        let engine = self.0.firing_as("", strokes).and_then(|engine| engine.with_gas(gas));
        engine.or_raise().map(Self::from)
    }

    /// Whether each cylinder fires in the second turn, where another schedule than the most even was chosen.
    #[getter]
    fn chosen_turns(&self) -> Option<Vec<bool>> {
        self.0.chosen_turns().map(<[bool]>::to_vec)
    }

    /// The engine with these turns, in its firing order.
    fn with_turns(&self, turns: Option<Vec<bool>>) -> PyResult<Self> {
        self.0.with_turns(turns).or_raise().map(Self::from)
    }

    /// The engine without pressure in its cylinders.
    fn without_cycles(&self) -> Self {
        self.0.without_gas().into()
    }

    /// The cycle of each cylinder, or none.
    #[getter]
    fn cycles(&self) -> Option<Vec<Option<Cycle>>> {
        let gas = self.0.gas()?;
        let cycle = |index: &Option<usize>| index.map(|k| Cycle(Arc::clone(&gas.cycles[k])));
        Some(gas.cycle_of.iter().map(cycle).collect())
    }

    /// The cycle at the crank end of each cylinder and the rod's diameter, m, or none; None without any.
    #[getter]
    fn crank_ends(&self) -> Option<Vec<Option<(Cycle, f64)>>> {
        let gas = self.0.gas().filter(|gas| !gas.crank_ends.is_empty())?;
        let end = |end: CrankEnd| (Cycle(Arc::clone(&gas.cycles[end.cycle])), end.rod_diameter);
        Some((0..self.0.stations().len()).map(|i| gas.crank_end(i).map(end)).collect())
    }

    /// Cycles and the crank angles at which they begin, degrees, of all faces on which pressure acts.
    #[getter]
    fn face_cycles(&self) -> Vec<(f64, Cycle)> {
        let pressures = (0..self.0.stations().len()).flat_map(|i| self.0.pressures(i));
        pressures.map(|face| (face.phase.degrees(), Cycle(face.cycle))).collect()
    }

    /// Mean torque of pressure on each piston on the main crank, N·m.
    fn mean_gas_torques(&self, py: Python<'_>) -> PyResult<Vec<f64>> {
        interrupt::run(py, |cancel| self.0.mean_gas_torques(cancel))
    }

    /// Absolute pressure in the crankcase, Pa.
    #[getter]
    fn crankcase(&self) -> Option<f64> {
        self.0.gas().map(|gas| gas.crankcase)
    }

    /// Crank angles at which the cylinders fire, within a cycle, degrees.
    #[getter]
    fn firing_deg(&self) -> Option<Vec<f64>> {
        self.0.gas()?;
        let count = self.0.stations().len();
        Some((0..count).map(|i| self.0.firing_phase(i).degrees()).collect())
    }

    #[getter]
    fn firing_order(&self) -> &str {
        self.0.firing_order()
    }

    #[getter]
    fn strokes(&self) -> u32 {
        self.0.strokes().number()
    }

    fn firing_as(&self, firing_order: String, strokes: u32) -> PyResult<Self> {
        let strokes = Strokes::from_number(strokes).or_raise()?;
        self.0.firing_as(firing_order, strokes).or_raise().map(Self::from)
    }

    #[getter]
    fn counterweights(&self) -> Vec<Weight> {
        self.0.counterweights().iter().map(weight).collect()
    }

    fn with_counterweights(&self, counterweights: Vec<GivenWeight>) -> PyResult<Self> {
        let counterweights = counterweights.into_iter().map(unbalance).collect();
        self.0.with_counterweights(counterweights).or_raise().map(Self::from)
    }

    #[getter]
    fn shafts(&self) -> Vec<(String, RatioNumber, f64, f64, Vec<Weight>)> {
        let shaft = |shaft: &Shaft| {
            let [x, y] = shaft.axis;
            (
                shaft.name.clone(),
                shaft.ratio.into(),
                x,
                y,
                shaft.unbalances.iter().map(weight).collect(),
            )
        };
        self.0.shafts().iter().map(shaft).collect()
    }

    fn with_shafts(
        &self,
        shafts: Vec<(String, RatioNumber, f64, f64, Vec<GivenWeight>)>,
    ) -> PyResult<Self> {
        let shaft =
            |(name, speed, x, y, weights): (String, RatioNumber, f64, f64, Vec<GivenWeight>)| {
                let unbalances = weights.into_iter().map(unbalance).collect();
                Ok(Shaft { name, ratio: ratio(speed)?, axis: [x, y], unbalances })
            };
        let shafts = shafts.into_iter().map(shaft).collect::<PyResult<_>>()?;
        self.0.with_shafts(shafts).or_raise().map(Self::from)
    }

    /// Loads besides those of moving parts, in words.
    #[getter]
    fn loads_counted(&self) -> String {
        self.0.loads_counted()
    }

    /// The gas pressure alone, in words.
    #[getter]
    fn gas_counted(&self) -> String {
        self.0.gas_counted()
    }

    /// The further loads alone, in words.
    #[getter]
    fn further_loads(&self) -> String {
        self.0.further_loads()
    }

    /// Periodic loads, as JSON.
    #[getter]
    fn loads(&self) -> PyResult<String> {
        serde_json::to_string(self.0.loads()).map_err(|error| unreadable(&error))
    }

    /// The engine with periodic loads that are given as JSON.
    fn with_loads(&self, loads: &str) -> PyResult<Self> {
        let loads: Vec<PeriodicLoad> =
            serde_json::from_str(loads).map_err(|error| unreadable(&error))?;
        self.0.with_loads(loads).or_raise().map(Self::from)
    }

    fn named(&self, name: String, source: String) -> PyResult<Self> {
        self.0.named(name, source).or_raise().map(Self::from)
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        for p in self.0.stations() {
            // Adding 0.0 makes −0.0, which equals 0.0, hash like it.
            let figures = [p.tdc.degrees(), p.bank.degrees(), p.z, p.cylinder.crank_radius()];
            figures.map(|x| (x + 0.0).to_bits()).hash(&mut hasher);
        }
        hasher.finish()
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let state = boundary::text(slf.py(), &file::to_json_text(&slf.get().0).or_raise()?)?;
        Ok((slf.get_type().getattr("from_json_text")?, PyTuple::new(slf.py(), [state])?))
    }
}

pub fn unreadable(error: &serde_json::Error) -> PyErr {
    python_error(Error::value("loads", error, "give a list of crankpin.PeriodicLoad"))
}

/// Reject a load, as JSON, that no engine can have.
#[guarded]
#[pyfunction]
pub fn check_load(load: &str) -> PyResult<()> {
    let load: PeriodicLoad = serde_json::from_str(load).map_err(|error| unreadable(&error))?;
    load.checked("").map(drop).or_raise()
}
