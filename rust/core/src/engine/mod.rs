//! An engine: cylinders that differ, and banks, the places of the cylinders that have them, and shafts.
//!
//! Cylinders refer to their running gear and their bank by index, so that being alike is no matter
//! of comparing numbers and a vee at 0° stays a vee.

mod banks;
pub mod chambers;
pub mod crankpins;
pub mod faces;
pub mod file;
mod firing_order;
mod gas;
pub mod layout;
pub mod links;
pub mod loads;
mod name;
pub mod periodic;
pub mod radial;
pub mod several_cranks;
mod shaft;
pub mod warnings;

use serde::{Deserialize, Serialize};

pub use self::banks::{Banks, Hold, bank_angle_in_range};
use self::banks::{banks_of_directions, right_bank};
pub use self::chambers::SharedChamber;
pub use self::faces::{CrankEnd, Face, FacePressure};
pub use self::gas::Gas;
use self::layout::Strokes;
pub use self::links::{DeadCentres, EqualTravel, LinkRod, LinkRods};
pub use self::periodic::{ActsOn, OverSpeed, PeriodicLoad};
pub use self::several_cranks::EngineOnCrank;
pub use self::shaft::{Crank, Origin, Shaft, Unbalance};
use crate::mechanism::cylinder::Cylinder;
use crate::mechanism::rod::Rod;
use crate::mechanism::spectrum::Spectrum;
pub use crate::numbers::amplitudes::Amplitudes;
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::{List, ListIndex, distinct, list_index};
use crate::numbers::kept::Kept;
use crate::numbers::limits;

list_index! {
    /// Index of a crank, the main one first.
    #[derive(Serialize, Deserialize)]
    pub CrankIndex
}

list_index! {
    /// Index of a running gear, among those of an engine that differ.
    pub DistinctCylinderIndex
}

impl CrankIndex {
    /// That of the main crank.
    pub const MAIN: Self = Self(0);
}

/// One cylinder in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Running gear.
    pub cylinder: Cylinder,
    /// Crank angle at which the crankpin points along the bore.
    pub tdc: Angle,
    /// Direction of the bore, from +x.
    pub bank: Angle,
    /// Place along the crank, from the front, m.
    pub z: f64,
    /// Mass that turns at crank radius with the crankpin, kg.
    pub rotating_mass: f64,
}

/// Figures of a cylinder that its forces do not depend on; the engine keeps them for its user.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Details {
    /// Diameter of the bore, m.
    pub bore: Option<f64>,
    /// Mass of piston, pin and rings, kg; with `rod`, the rest of the reciprocating mass is the rod's.
    pub piston_mass: Option<f64>,
    /// The rod as a body.
    pub rod: Option<RodFigures>,
    /// Whether the piston is a dummy, which balances and never has gas.
    pub dummy: bool,
    /// Whether side rods drive the piston from the far side of its chamber, which then is at its inner face.
    pub side_rods: bool,
}

/// A rod of known inertia; its length is that of the cylinder's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RodFigures {
    /// kg.
    pub mass: f64,
    /// Moment of inertia about the centre of mass, kg·m².
    pub inertia: f64,
    /// Distance of the centre of mass from the crankpin towards the piston pin, m.
    pub to_crankpin: f64,
}

impl Details {
    /// Mass of the rod that turns with the crankpin, kg, by the rod's length; zero without a rod.
    pub fn big_end(&self, rod_length: f64) -> Result<f64> {
        self.rod.map_or(Ok(0.0), |RodFigures { mass, inertia, to_crankpin }| {
            Ok(Rod::new(mass, inertia, rod_length, to_crankpin)?.rotating_mass())
        })
    }
}

/// Cylinders, in the order of their numbers, on one crankshaft, and the shafts that it drives.
///
/// ```
/// use crankpin_core::layout::{Inline, Spacing};
/// use crankpin_core::{Angle, Cylinder};
///
/// let [up, down] = [0.0, 180.0].map(Angle::from_degrees);
/// let (up, down) = (up?, down?);
/// let four = Inline {
///     throws: vec![up, down, down, up],
///     spacing: Spacing::Even(0.096),
///     rotating_mass: vec![],
///     first_tdc: Angle::ZERO,
/// }
/// .engine(Cylinder::new(0.043, 0.145, 0.66, 0.0)?)?;
/// assert_eq!((four.stations().len(), four.banks().is_ok()), (4, false));
/// assert_eq!(four.throws().len(), 4); // a crankpin each
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Engine {
    name: String,
    source: String,
    firing_order: String,
    strokes: Strokes,
    stations: Vec<Station>,
    /// Cylinders that differ, in the order in which cylinders have them.
    distinct_cylinders: List<DistinctCylinderIndex, Cylinder>,
    /// Index of each cylinder's running gear.
    distinct_cylinder_of: Vec<DistinctCylinderIndex>,
    /// Force of every cylinder, masses and radius in it, in place of that of its slider-crank.
    spectrum: Option<Spectrum>,
    /// Index of each cylinder's bank, in the order in which cylinders have them.
    bank_of: Vec<usize>,
    /// The right one of two banks.
    right: Option<usize>,
    /// The main crank, then others.
    cranks: List<CrankIndex, Crank>,
    /// Index of each cylinder's crank.
    crank_of: Vec<CrankIndex>,
    counterweights: Vec<Unbalance>,
    shafts: Vec<Shaft>,
    /// Periodic loads besides.
    loads: Vec<PeriodicLoad>,
    /// Pressure in the cylinders, where it counts.
    gas: Option<Gas>,
    /// Whether each cylinder fires in the second turn of the cycle, where that was chosen.
    turns: Option<Vec<bool>>,
    /// Of each cylinder.
    details: Vec<Details>,
    /// Where the rod of each cylinder hangs, if it is a link rod.
    link_rods: Vec<Option<LinkRod>>,
    /// Places of the main bearings along the crank, ascending, m; empty where they are not known.
    mains: Vec<f64>,
    /// Reference plane of moments, where it is not the middle, m.
    reference_z: Option<f64>,
    /// Its loads, and what was read of them.
    kept: Kept,
}

impl Engine {
    /// From one station for each cylinder; cylinders whose bores point the same way form a bank.
    ///
    /// Angles are reduced to one turn.
    pub fn new(
        name: impl Into<String>,
        source: impl Into<String>,
        stations: Vec<Station>,
    ) -> Result<Self> {
        let banks = banks_of_directions(&stations);
        Self::in_banks(name, source, stations, &banks)
    }

    /// From stations whose banks are given: cylinders with equal keys form one bank.
    ///
    /// Of two banks in one direction or in opposite ones, as of a vee at 0° or 180°, the one with
    /// the smaller key is the right.
    pub fn in_banks(
        name: impl Into<String>,
        source: impl Into<String>,
        mut stations: Vec<Station>,
        bank_keys: &[usize],
    ) -> Result<Self> {
        let count = stations.len();
        check_number(count)?;
        check_each_cylinder("bank", bank_keys.len(), count)?;
        for (i, station) in stations.iter_mut().enumerate() {
            limits::finite(&format!("z[{i}]"), station.z)?;
            limits::not_negative(&format!("rotating_mass[{i}]"), station.rotating_mass)?;
            (station.tdc, station.bank) = (station.tdc.reduced(), station.bank.reduced());
        }
        let (distinct_cylinders, distinct_cylinder_of) =
            distinct(stations.iter().map(|station| station.cylinder));
        let engine = Self {
            name: String::new(),
            source: String::new(),
            firing_order: String::new(),
            strokes: Strokes::Four,
            right: right_bank(&stations, bank_keys),
            stations,
            distinct_cylinders,
            distinct_cylinder_of,
            spectrum: None,
            bank_of: distinct::<usize, _>(bank_keys.iter()).1,
            cranks: List::new(vec![Crank::MAIN]),
            crank_of: vec![CrankIndex::MAIN; count],
            counterweights: Vec::new(),
            shafts: Vec::new(),
            loads: Vec::new(),
            gas: None,
            turns: None,
            details: vec![Details::default(); count],
            link_rods: vec![None; count],
            mains: Vec::new(),
            reference_z: None,
            kept: Kept::default(),
        };
        engine.named(name, source)
    }

    /// What was read of it last.
    pub(crate) fn kept(&self) -> &Kept {
        &self.kept
    }

    /// Name, may be empty.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Origin of the layout, may be empty.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Firing order such as `1-3-4-2`, empty where it is not known.
    #[must_use]
    pub fn firing_order(&self) -> &str {
        &self.firing_order
    }

    /// Strokes of a cycle.
    #[must_use]
    pub fn strokes(&self) -> Strokes {
        self.strokes
    }

    /// The cylinders, by number.
    #[must_use]
    pub fn stations(&self) -> &[Station] {
        &self.stations
    }

    /// Cylinders that differ; cylinders refer to them by index.
    #[must_use]
    pub fn distinct_cylinders(&self) -> &List<DistinctCylinderIndex, Cylinder> {
        &self.distinct_cylinders
    }

    /// Index of a cylinder's running gear.
    #[must_use]
    pub fn distinct_cylinder_of(&self, cylinder: usize) -> DistinctCylinderIndex {
        self.distinct_cylinder_of[cylinder]
    }

    /// Force given for every cylinder in place of that of its slider-crank.
    #[must_use]
    pub fn spectrum(&self) -> Option<&Spectrum> {
        self.spectrum.as_ref()
    }

    /// The same engine with this force of every cylinder, over ω², in place of its slider-crank's; it
    /// does not determine a torque.
    #[must_use]
    pub fn with_spectrum(&self, spectrum: Spectrum) -> Self {
        Self { spectrum: Some(spectrum), ..self.clone() }
    }

    /// Directions of the banks; cylinders refer to them by index.
    #[must_use]
    pub fn bank_directions(&self) -> Vec<Angle> {
        let mut banks = Vec::new();
        for (station, &bank) in self.stations.iter().zip(&self.bank_of) {
            if bank == banks.len() {
                banks.push(station.bank);
            }
        }
        banks
    }

    /// Index of a cylinder's bank.
    #[must_use]
    pub fn bank_of(&self, cylinder: usize) -> usize {
        self.bank_of[cylinder]
    }

    /// The main crank, then others.
    #[must_use]
    pub fn cranks(&self) -> &List<CrankIndex, Crank> {
        &self.cranks
    }

    /// Index of a cylinder's crank.
    #[must_use]
    pub fn crank_of(&self, cylinder: usize) -> CrankIndex {
        self.crank_of[cylinder]
    }

    /// Index of the crank that carries an unbalance: that of its pin, where it has one.
    #[must_use]
    pub fn crank_carrying(&self, unbalance: &Unbalance) -> CrankIndex {
        unbalance.pin.map_or(unbalance.crank, |cylinder| self.crank_of[cylinder])
    }

    /// All parts to which loads belong: cylinders, counterweights, shafts, further loads.
    pub(crate) fn parts(&self) -> Vec<Origin> {
        let count = |part: fn(usize) -> Origin, count: usize| (0..count).map(part);
        count(Origin::Cylinder, self.stations.len())
            .chain(count(Origin::Counterweight, self.counterweights.len()))
            .chain(count(Origin::Shaft, self.shafts.len()))
            .chain(count(Origin::Load, self.loads.len()))
            .collect()
    }

    /// Index of a part in that list.
    pub(crate) fn position_of(&self, part: Origin) -> usize {
        let lists = [self.stations.len(), self.counterweights.len(), self.shafts.len()];
        let (before, index) = match part {
            Origin::Cylinder(i) => (0, i),
            Origin::Counterweight(k) => (1, k),
            Origin::Shaft(k) => (2, k),
            Origin::Load(k) => (3, k),
        };
        lists[..before].iter().sum::<usize>() + index
    }

    /// Index of the bank with whose bores or crankpins a part turns.
    pub(crate) fn bank_with(&self, part: Origin) -> Option<usize> {
        self.cylinder_with(part).map(|cylinder| self.bank_of[cylinder])
    }

    /// Index of the crank that carries a part; none of shafts and further loads.
    pub(crate) fn crank_with(&self, origin: Origin) -> Option<CrankIndex> {
        match origin {
            Origin::Cylinder(i) => Some(self.crank_of[i]),
            Origin::Counterweight(k) => Some(self.crank_carrying(&self.counterweights[k])),
            Origin::Shaft(_) | Origin::Load(_) => None,
        }
    }

    /// Index of the cylinder with whose bore or crankpin a part turns.
    pub(crate) fn cylinder_with(&self, origin: Origin) -> Option<usize> {
        match origin {
            Origin::Cylinder(i) => Some(i),
            Origin::Counterweight(k) => self.counterweights[k].pin,
            Origin::Shaft(_) => None,
            Origin::Load(k) => self.loads[k].cylinder,
        }
    }

    /// Direction of a cylinder's crankpin, from +x, at θ = 0.
    #[must_use]
    pub fn pin(&self, cylinder: usize) -> Angle {
        let Station { bank, tdc, .. } = self.stations[cylinder];
        self.cranks[self.crank_of[cylinder]].pin(bank, tdc)
    }

    /// Direction of an unbalance of a crank, from +x, at θ = 0: ahead of its crankpin in the sense in which
    /// that turns, where it has one.
    #[must_use]
    pub fn direction(&self, unbalance: &Unbalance) -> Angle {
        let Some(i) = unbalance.pin else { return unbalance.angle.reduced() };
        let is_forward = self.cranks[self.crank_of[i]].ratio.is_forward();
        let ahead = if is_forward { unbalance.angle } else { -unbalance.angle };
        (self.pin(i) + ahead).reduced()
    }

    /// The same engine with its crankpins in these directions, from +x, at θ = 0, one for each cylinder.
    pub fn with_pins(&self, pins: &[Angle]) -> Result<Self> {
        check_each_cylinder("pins", pins.len(), self.stations.len())?;
        let mut turned = self.clone();
        for (i, (station, &pin)) in turned.stations.iter_mut().zip(pins).enumerate() {
            station.tdc = self.cranks[self.crank_of[i]].tdc(station.bank, pin);
        }
        turned.check_link_rods()?;
        Ok(turned)
    }

    /// Rejects several cranks, where a quantity is defined for one alone.
    pub fn check_one_crank(&self, argument: &'static str) -> Result<()> {
        if self.cranks.len() == 1 {
            return Ok(());
        }
        let reason = format!("it has {} cranks; one is needed", self.cranks.len());
        Err(Error::Undefined { argument, reason })
    }

    /// Unbalances that the cranks carry besides the rotating masses of the cylinders.
    #[must_use]
    pub fn counterweights(&self) -> &[Unbalance] {
        &self.counterweights
    }

    /// Balance shafts.
    #[must_use]
    pub fn shafts(&self) -> &[Shaft] {
        &self.shafts
    }

    /// All that rotates with a crankshaft: the cylinders' rotating masses at their pins, and the
    /// counterweights.
    pub fn crank_unbalances(&self) -> impl Iterator<Item = (Origin, Unbalance)> {
        let mass = |(i, place): (usize, &Station)| {
            let amount = place.rotating_mass * place.cylinder.crank_radius();
            let unbalance = Unbalance {
                amount,
                angle: Angle::ZERO,
                z: place.z,
                pin: Some(i),
                crank: CrankIndex::MAIN,
            };
            (Origin::Cylinder(i), unbalance)
        };
        let masses = self.stations.iter().enumerate().map(mass);
        let weights = self.counterweights.iter().enumerate();
        let weights = weights.map(|(k, &weight)| (Origin::Counterweight(k), weight));
        masses.filter(|(_, mass)| mass.amount > 0.0).chain(weights)
    }

    /// z midway between the first and the last cylinder: the default reference plane.
    #[must_use]
    pub fn middle(&self) -> f64 {
        let [first, last] = self.ends();
        f64::midpoint(first, last)
    }

    /// Places of the first and the last cylinder, m.
    pub(crate) fn ends(&self) -> [f64; 2] {
        let z = || self.stations.iter().map(|place| place.z);
        [z().fold(f64::INFINITY, f64::min), z().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Distance between the first and the last cylinder, m.
    pub(crate) fn length(&self) -> f64 {
        let [first, last] = self.ends();
        last - first
    }

    /// Largest distance of a cylinder or another place from the reference plane, m.
    pub(crate) fn longest_lever(&self, others: impl Iterator<Item = f64>) -> Result<f64> {
        let (reference, ends) = (self.reference(None)?, self.ends());
        Ok(others.chain(ends).map(|z| (z - reference).abs()).fold(0.0, f64::max))
    }

    /// Reference plane of moments, where it is not the middle, m.
    #[must_use]
    pub fn reference_z(&self) -> Option<f64> {
        self.reference_z
    }

    /// The reference plane given, or the engine's own.
    pub fn reference(&self, z: Option<f64>) -> Result<f64> {
        match z.or(self.reference_z) {
            Some(z) => limits::finite("reference_z", z),
            None => Ok(self.middle()),
        }
    }

    /// Figures of each cylinder that its forces do not depend on.
    #[must_use]
    pub fn details(&self) -> &[Details] {
        &self.details
    }

    /// Places of the main bearings that were given, ascending, m; see [`Self::bearings`].
    #[must_use]
    pub fn mains(&self) -> &[f64] {
        &self.mains
    }

    /// Largest mean piston speed of any cylinder at a speed of the main crank, m/s: two travels of its
    /// piston in a turn of its own crank.
    #[must_use]
    pub fn mean_piston_speed(&self, rpm: f64) -> f64 {
        self.mean_piston_speed_of(rpm, |i| self.travel(i))
    }

    /// The same with the travel of each cylinder's piston, m.
    pub(crate) fn mean_piston_speed_of(&self, rpm: f64, travel: impl Fn(usize) -> f64) -> f64 {
        let per_turn = |i: usize| {
            let ratio = self.cranks[self.crank_of[i]].ratio;
            2.0 * travel(i) * ratio.size()
        };
        (0..self.stations.len()).map(per_turn).fold(0.0, f64::max) * rpm / 60.0
    }

    /// Largest crank radius of any cylinder, m.
    #[must_use]
    pub fn largest_crank_radius(&self) -> f64 {
        self.distinct_cylinders.iter().map(Cylinder::crank_radius).fold(0.0, f64::max)
    }

    /// The same engine with this rod ratio of all cylinders.
    pub fn at_rod_ratio(&self, ratio: f64) -> Result<Self> {
        self.check_no_link_rods("rod_ratio")?;
        let mut engine = self.clone();
        for Station { cylinder, .. } in &mut engine.stations {
            *cylinder = cylinder.at_rod_ratio(ratio)?;
        }
        engine.number_cylinders();
        Ok(engine)
    }

    /// Numbers its running gears that differ anew.
    fn number_cylinders(&mut self) {
        (self.distinct_cylinders, self.distinct_cylinder_of) =
            distinct(self.stations.iter().map(|station| station.cylinder));
    }

    /// The same engine with its whole crank turned so that the first cylinder is at top dead
    /// centre at this crank angle.
    #[must_use]
    pub fn with_first_tdc(&self, tdc: Angle) -> Self {
        let turn = tdc - self.stations[0].tdc;
        let mut turned = self.clone();
        (0..self.stations.len()).for_each(|i| turned.delay(i, turn));
        turned.delay_loads(turn);
        // What is fixed to a shaft starts from where it was so much earlier.
        for weight in turned.counterweights.iter_mut().filter(|weight| weight.pin.is_none()) {
            let ratio = self.cranks[weight.crank].ratio;
            weight.angle = (weight.angle - ratio.turned(turn)).reduced();
        }
        for shaft in &mut turned.shafts {
            for unbalance in &mut shaft.unbalances {
                unbalance.angle = (unbalance.angle - shaft.ratio.turned(turn)).reduced();
            }
        }
        turned
    }

    /// The same engine with these cranks, the main one first, and of each cylinder the index of its
    /// crank. Tops remain angles of the main crank; what follows a crankpin moves to its crank.
    pub fn with_cranks(&self, cranks: Vec<Crank>, crank_of: Vec<usize>) -> Result<Self> {
        if cranks.first() != Some(&Crank::MAIN) {
            let hint = "make the first crank the main one, at x = y = 0 with ratio 1";
            return Err(Error::value("cranks[0]", format!("{:?}", cranks.first()), hint));
        }
        for (k, crank) in cranks.iter().enumerate() {
            shaft::check_rotation(&format!("cranks[{k}]."), crank.ratio, crank.axis)?;
        }
        check_each_cylinder("crank_of", crank_of.len(), self.stations.len())?;
        if let Some(k) = crank_of.iter().position(|&crank| crank >= cranks.len()) {
            let hint = format!("give the number of a crank, below {}", cranks.len());
            return Err(Error::value(format!("crank_of[{k}]"), crank_of[k], hint));
        }
        if let Some(&k) = crank_of.iter().find(|&&k| cranks[k].ratio.as_whole().is_none()) {
            let hint = "cylinders need a crank at a whole multiple of the speed of the main one: on \
                        others they come to top dead centre elsewhere in every second turn";
            return Err(Error::value(format!("cranks[{k}].ratio"), cranks[k].ratio, hint));
        }
        let crank_of = crank_of.into_iter().map(CrankIndex::new).collect();
        let engine = Self { cranks: List::new(cranks), crank_of, ..self.clone() };
        engine.check_throws_between(&engine.mains)?;
        engine.check_link_rods()?;
        engine
            .with_counterweights(engine.counterweights.clone())?
            .with_loads(engine.loads.clone())?
            .with_known_torque()
    }

    /// The same engine with these masses at its crankpins, one for each cylinder, kg.
    pub fn with_rotating_masses(&self, masses: &[f64]) -> Result<Self> {
        check_each_cylinder("rotating_mass", masses.len(), self.stations.len())?;
        let mut engine = self.clone();
        for (i, (station, &mass)) in engine.stations.iter_mut().zip(masses).enumerate() {
            station.rotating_mass = limits::not_negative(&format!("rotating_mass[{i}]"), mass)?;
        }
        Ok(engine)
    }

    /// The same engine with these counterweights on its cranks instead of those it has.
    pub fn with_counterweights(&self, counterweights: Vec<Unbalance>) -> Result<Self> {
        shaft::check_count("counterweights", counterweights.len())?;
        let checked = counterweights.into_iter().enumerate();
        let (cylinders, cranks) = (self.stations.len(), self.cranks.len());
        let checked =
            checked.map(|(i, u)| u.checked(&format!("counterweights[{i}]"), cylinders, cranks));
        Ok(Self { counterweights: checked.collect::<Result<_>>()?, ..self.clone() })
    }

    /// The same engine with these balance shafts instead of those it has.
    pub fn with_shafts(&self, shafts: Vec<Shaft>) -> Result<Self> {
        shaft::check_count("shafts", shafts.len())?;
        let carried: usize = shafts.iter().map(|shaft| shaft.unbalances.len()).sum();
        if carried > limits::MOST_UNBALANCES_OF_ALL {
            let hint = format!("give at most {}", limits::MOST_UNBALANCES_OF_ALL);
            return Err(Error::value("unbalances of all shafts", carried, hint));
        }
        let checked = shafts.into_iter().enumerate();
        let checked = checked.map(|(i, shaft)| shaft.checked(&format!("shafts[{i}]")));
        Ok(Self { shafts: checked.collect::<Result<_>>()?, ..self.clone() })
    }

    /// The same engine with these figures of its cylinders.
    pub fn with_details(&self, details: Vec<Details>) -> Result<Self> {
        check_each_cylinder("details", details.len(), self.stations.len())?;
        for Details { bore, piston_mass, rod, .. } in &details {
            bore.map(|bore| limits::length("bore", bore)).transpose()?;
            piston_mass.map(|mass| limits::not_negative("piston_mass", mass)).transpose()?;
            if let Some(RodFigures { mass, inertia, to_crankpin }) = *rod {
                limits::not_negative("rod.mass", mass)?;
                limits::inertia("rod.inertia", inertia)?;
                limits::finite("rod.to_crankpin", to_crankpin)?;
            }
        }
        Self { details, ..self.clone() }.with_known_torque()
    }

    /// The same engine with main bearings at these places; none for those of [`Self::bearings`].
    pub fn with_mains(&self, mains: Vec<f64>) -> Result<Self> {
        for (i, &z) in mains.iter().enumerate() {
            limits::finite(&format!("mains[{i}]"), z)?;
        }
        let ascending = mains.is_sorted_by(|before, after| before < after);
        if mains.len() == 1 || !ascending || mains.len() > 2 * limits::MOST_CYLINDERS {
            let hint = "give two or more places in m, ascending, from the front to the flywheel";
            return Err(Error::value("mains", format!("{mains:?}"), hint));
        }
        self.check_throws_between(&mains)?;
        Ok(Self { mains, ..self.clone() })
    }

    /// The same engine with moments about this plane; `None` for the middle.
    pub fn with_reference(&self, reference_z: Option<f64>) -> Result<Self> {
        reference_z.map(|z| limits::finite("reference_z", z)).transpose()?;
        Ok(Self { reference_z, ..self.clone() })
    }

    /// The same engine with a firing order, such as `1-3-4-2`; empty where it is not known. Which turns
    /// its cylinders fire in is open then.
    pub fn firing_as(&self, firing_order: impl Into<String>, strokes: Strokes) -> Result<Self> {
        let firing_order = firing_order.into();
        limits::name("firing_order", &firing_order)?;
        Self { firing_order, strokes, turns: None, ..self.clone() }.with_known_torque()
    }

    /// The same engine under another name.
    pub fn named(&self, name: impl Into<String>, source: impl Into<String>) -> Result<Self> {
        let (name, source) = (name.into(), source.into());
        limits::name("name", &name)?;
        limits::name("source", &source)?;
        Ok(Self { name, source, ..self.clone() })
    }
}

/// Rejects a number of cylinders that no engine has.
fn check_number(cylinders: usize) -> Result<()> {
    if (1..=limits::MOST_CYLINDERS).contains(&cylinders) {
        return Ok(());
    }
    let hint = format!("an engine has 1 to {} cylinders", limits::MOST_CYLINDERS);
    Err(Error::value("number of cylinders", cylinders, hint))
}

/// Rejects a list that has not one entry for each cylinder.
fn check_each_cylinder(argument: &str, found: usize, expected: usize) -> Result<()> {
    limits::same_length(argument, found, "the engine", expected, "cylinder")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::ratio::SpeedRatio;

    fn degrees(degrees: f64) -> Angle {
        Angle::from_degrees(degrees).unwrap()
    }

    fn vee(right: f64, left: f64) -> Engine {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let place = |bank: f64, tdc: f64, z| Station {
            cylinder,
            tdc: degrees(tdc),
            bank: degrees(bank),
            z,
            rotating_mass: 0.0,
        };
        Engine::new("", "", vec![place(left, 30.0, 0.0), place(right, 0.0, 0.1)]).unwrap()
    }

    #[test]
    fn banks_are_distinguished_in_any_order() {
        let directions = |right, left| vee(right, left).banks().unwrap().directions;
        assert_eq!(directions(60.0, 120.0), [degrees(60.0), degrees(120.0)]);
        assert_eq!(vee(60.0, 120.0).banks().unwrap().bisector(), degrees(90.0));
        assert_eq!(directions(0.0, 180.0)[0], degrees(0.0));
        assert_eq!(directions(180.0, 0.0)[0], degrees(0.0));
        assert_eq!(vee(350.0, 10.0).banks().unwrap().bisector(), degrees(0.0));
        // Opposite bores, whichever comes first; and two that only add up to half a turn more.
        for (a, b) in [(90.0, 270.0), (270.0, 90.0)] {
            assert_eq!(directions(a, b), [degrees(90.0), degrees(270.0)]);
        }
        assert_eq!(directions(200.0, 340.0), [degrees(200.0), degrees(340.0)]);
        let error = vee(90.0, 90.0).banks().unwrap_err().to_string();
        assert_eq!(
            error,
            "bank_angle_deg is undefined for this engine: it has one bank (90°); exactly two are needed"
        );
    }

    #[test]
    fn bank_angle_of_zero_keeps_both_banks() {
        let engine = vee(60.0, 120.0);
        for hold in [Hold::Pins, Hold::Firing] {
            let closed = engine.with_bank_angle(Angle::ZERO, hold).unwrap();
            assert_eq!(closed.bank_directions(), [degrees(90.0); 2]);
            assert_eq!(closed.banks().unwrap().angle(), Angle::ZERO);
            assert_eq!(closed.with_bank_angle(degrees(60.0), hold).unwrap(), engine);
        }
    }

    #[test]
    fn opposite_banks_keep_their_index() {
        // The bisector of 10° and 70° is at 40°: opened to 180°, the right bank is at 310°.
        let engine = vee(10.0, 70.0);
        let flat = engine.with_bank_angle(degrees(180.0), Hold::Pins).unwrap();
        assert_eq!(flat.banks().unwrap().directions, [degrees(310.0), degrees(130.0)]);
        let keys: Vec<usize> = [0, 1].map(|i| usize::from(flat.bank_of(i) != 1)).to_vec();
        let again = Engine::in_banks("", "", flat.stations().to_vec(), &keys).unwrap();
        assert_eq!(again.with_bank_angle(degrees(60.0), Hold::Pins).unwrap(), engine);
    }

    #[test]
    fn bank_angle_changes_keep_pins_or_firing() {
        let engine = vee(60.0, 120.0);
        let by_pins = engine.with_bank_angle(degrees(90.0), Hold::Pins).unwrap();
        let by_firing = engine.with_bank_angle(degrees(90.0), Hold::Firing).unwrap();
        assert!((0..2).all(|i| engine.pin(i) == by_pins.pin(i)));
        for (before, after) in engine.stations().iter().zip(by_firing.stations()) {
            assert_eq!(before.tdc, after.tdc);
        }
        assert_eq!(by_pins.banks().unwrap().angle(), degrees(90.0));
        // Each cylinder stays on its side.
        let bores: Vec<f64> = by_pins.stations().iter().map(|p| p.bank.degrees()).collect();
        assert_eq!(bores, [135.0, 45.0]);
    }

    #[test]
    fn engine_reports_what_it_was_made_of() {
        let engine = vee(60.0, 120.0).named("V2", "a drawing").unwrap();
        assert_eq!((engine.name(), engine.source()), ("V2", "a drawing"));
        assert_eq!((engine.middle(), engine.largest_crank_radius()), (0.05, 0.05));
        assert_eq!((engine.stations().len(), engine.distinct_cylinders().len()), (2, 1));
        assert_eq!([0, 1].map(|i| engine.bank_of(i)), [0, 1]);
        assert_eq!(engine.firing_as("1-2", Strokes::Four).unwrap().firing_order(), "1-2");
        let both = engine.stations().to_vec();
        assert!(matches!(Engine::in_banks("", "", both, &[0]), Err(Error::Length { .. })));
        for angle in [0.0, 45.0, 180.0] {
            assert_eq!(bank_angle_in_range(angle), Ok(angle));
        }
        for angle in [-1e-9, 180.1, f64::NAN] {
            assert!(bank_angle_in_range(angle).is_err());
        }
    }

    #[test]
    fn what_the_engine_keeps_is_checked() {
        let engine = vee(60.0, 120.0);
        let about = engine.with_reference(Some(0.3)).unwrap();
        assert_eq!((engine.reference(None), about.reference(None)), (Ok(0.05), Ok(0.3)));
        assert_eq!(about.reference(Some(0.2)), Ok(0.2));
        assert!(engine.with_reference(Some(f64::NAN)).is_err());
        for mains in [vec![0.1], vec![0.1, 0.1], vec![0.2, 0.1], vec![0.0, f64::INFINITY]] {
            assert!(engine.with_mains(mains).unwrap_err().to_string().starts_with("mains"));
        }
        let bored = Details { bore: Some(0.08), ..Details::default() };
        assert!(engine.with_details(vec![bored]).is_err());
        for count in [0, 1, 3] {
            assert!(matches!(
                engine.with_pins(&vec![Angle::ZERO; count]),
                Err(Error::Length { .. })
            ));
        }
        assert_eq!(engine.with_details(vec![bored; 2]).unwrap().details(), [bored; 2]);
        let rod = RodFigures { mass: -1.0, inertia: 0.0, to_crankpin: 0.0 };
        let negative = Details { rod: Some(rod), ..bored };
        assert!(engine.with_details(vec![negative; 2]).is_err());
    }

    #[test]
    fn loads_keep_the_crank_that_they_sit_on() {
        let load = PeriodicLoad {
            crank: Some(1),
            torque: Amplitudes(vec![(2, vec![crate::Complex64::ONE])]),
            ..PeriodicLoad::new("pump", ActsOn::Both)
        };
        let engine = vee(60.0, 120.0);
        let other = Crank { axis: [0.3, 0.0], ratio: SpeedRatio::whole(-1) };
        let count = engine.stations().len();
        let two = engine.with_cranks(vec![Crank::MAIN, other], vec![0; count]).unwrap();
        let loaded = two.with_loads(vec![load]).unwrap();
        assert!(loaded.with_cranks(vec![Crank::MAIN, other], vec![1; count]).is_ok());
        assert!(loaded.with_cranks(vec![Crank::MAIN], vec![0; count]).is_err());
    }

    fn weight(angle: f64, pin: Option<usize>) -> Unbalance {
        Unbalance { amount: 0.01, angle: degrees(angle), z: 0.2, pin, crank: CrankIndex::MAIN }
    }

    #[test]
    fn turning_the_crank_back_restores_the_engine() {
        let unbalances = vec![weight(10.0, None)];
        let shaft = Shaft {
            name: "left".into(),
            ratio: SpeedRatio::whole(-2),
            axis: [0.1, 0.2],
            unbalances,
        };
        let engine = vee(60.0, 120.0)
            .with_counterweights(vec![weight(180.0, Some(1)), weight(30.0, None)])
            .and_then(|engine| engine.with_shafts(vec![shaft]))
            .unwrap();
        let turned = engine.with_first_tdc(degrees(17.5));
        assert_eq!(turned.stations()[0].tdc, degrees(17.5));
        assert_eq!(turned.stations()[1].tdc, degrees(17.5 - 30.0).reduced());
        // Turned back by 12.5°, the shaft twice as far the other way; a weight at a pin follows it.
        let angles = [0, 1].map(|k| turned.counterweights()[k].angle.degrees());
        assert_eq!(angles, [180.0, 42.5]);
        assert_eq!(turned.shafts()[0].unbalances[0].angle.degrees(), 345.0);
        assert_eq!(turned.with_first_tdc(degrees(30.0)), engine);
    }

    #[test]
    fn rotating_masses_are_unbalances_at_their_pins() {
        let mut stations: Vec<Station> = vee(60.0, 120.0).stations().to_vec();
        stations[1].rotating_mass = 0.4;
        let engine = Engine::new("", "", stations).unwrap();
        let engine = engine.with_counterweights(vec![weight(30.0, None)]).unwrap();
        let found: Vec<(Origin, Unbalance)> = engine.crank_unbalances().collect();
        let mass = Unbalance {
            amount: 0.4 * 0.05,
            angle: Angle::ZERO,
            z: 0.1,
            pin: Some(1),
            crank: CrankIndex::MAIN,
        };
        let expected =
            [(Origin::Cylinder(1), mass), (Origin::Counterweight(0), weight(30.0, None))];
        assert_eq!(found, expected);
    }

    #[test]
    fn impossible_shafts_are_rejected_by_name() {
        let engine = vee(60.0, 120.0);
        let error = |shaft: Shaft| engine.with_shafts(vec![shaft]).unwrap_err().to_string();
        let shaft = Shaft {
            name: String::new(),
            ratio: SpeedRatio::whole(0),
            axis: [0.0; 2],
            unbalances: Vec::new(),
        };
        assert!(error(shaft.clone()).contains("shafts[0].ratio = 0"));
        assert!(
            error(Shaft { ratio: SpeedRatio::whole(21), ..shaft.clone() }).contains("ratio = 21")
        );
        let axis = [0.0, f64::NAN];
        assert!(
            error(Shaft { ratio: SpeedRatio::whole(1), axis, ..shaft.clone() })
                .contains("shafts[0].y = NaN")
        );
        let unbalances = vec![weight(0.0, Some(0))];
        let pinned = Shaft { ratio: SpeedRatio::whole(1), unbalances, ..shaft };
        assert!(error(pinned).contains("shafts[0].unbalances[0].pin"));
        let error = engine.with_counterweights(vec![weight(0.0, Some(2))]).unwrap_err().to_string();
        assert!(error.contains("counterweights[0].pin = 3"), "{error}");
        let negative = Unbalance { amount: -1.0, ..weight(0.0, None) };
        assert!(engine.with_counterweights(vec![negative]).is_err());
    }
}
