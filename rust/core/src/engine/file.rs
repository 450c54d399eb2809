//! Engines as TOML and JSON, with a schema version; what is written reads back as the same engine.

use std::mem;
use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::layout::Strokes;
use super::{
    Crank, CrankEnd, Details, Engine, Gas, LinkRod, PeriodicLoad, RodFigures, Shaft, Station,
    Unbalance,
};
use crate::mechanism::cylinder::Cylinder;
use crate::mounts::Powertrain;
use crate::mounts::file::PowertrainEntry;
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result, shorten};
use crate::numbers::index::ListIndex;
use crate::numbers::is_default;
use crate::numbers::ratio::SpeedRatio;
use crate::pressure::example::{ExampleKind, full_load};
use crate::pressure::{ATMOSPHERE, Cycle, Given};

/// Version of the schema that this file reads and writes.
pub const SCHEMA: u32 = 1;
/// Longest text that is read, bytes: the most cylinders and unbalances there may be take half of it.
pub const LONGEST_TEXT: usize = 1 << 24;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct EngineFile {
    schema: u32,
    #[serde(default, skip_serializing_if = "is_default")]
    name: String,
    #[serde(default, skip_serializing_if = "is_default")]
    source: String,
    #[serde(default, skip_serializing_if = "is_default")]
    firing_order: String,
    #[serde(default = "four", skip_serializing_if = "is_four")]
    strokes: u32,
    /// Reference plane of moments, where it is not the middle.
    #[serde(default, skip_serializing_if = "is_default")]
    reference_z: Option<f64>,
    /// Places of the main bearings.
    #[serde(default, skip_serializing_if = "is_default")]
    mains: Vec<f64>,
    /// Running gear of every station that has none of its own.
    #[serde(default, skip_serializing_if = "is_default")]
    cylinder: Option<PartsEntry>,
    /// Left out of a file of a body without an engine.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    placements: Vec<StationEntry>,
    /// On the crankshaft, besides the rotating masses.
    #[serde(default, skip_serializing_if = "is_default")]
    counterweights: Vec<Unbalance>,
    #[serde(default, skip_serializing_if = "is_default")]
    shafts: Vec<BalanceShaft>,
    /// Periodic loads besides.
    #[serde(default, skip_serializing_if = "is_default")]
    loads: Vec<PeriodicLoad>,
    /// Cranks besides the main one.
    #[serde(default, skip_serializing_if = "is_default")]
    cranks: Vec<OtherCrank>,
    /// Absolute pressure in the crankcase, Pa, of an engine with cycles.
    #[serde(default, skip_serializing_if = "is_default")]
    crankcase: Option<f64>,
    /// Pressure in cylinders over a cycle.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    cycles: Vec<CycleEntry>,
    /// The engine's body and its mounts, which an engine alone does not have.
    #[serde(default, skip_serializing_if = "is_default")]
    powertrain: Option<PowertrainEntry>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct OtherCrank {
    x: f64,
    y: f64,
    ratio: SpeedRatio,
}

#[derive(Serialize, Deserialize, Clone, Copy, PartialEq)]
#[serde(deny_unknown_fields)]
struct PartsEntry {
    crank_radius: f64,
    /// Null in JSON, which has no infinite numbers, is an infinite rod.
    #[serde(deserialize_with = "number_or_infinite")]
    rod_length: f64,
    reciprocating_mass: f64,
    #[serde(default)]
    pin_offset: f64,
    #[serde(default, skip_serializing_if = "is_default")]
    rod_inertia_excess: f64,
    #[serde(default, skip_serializing_if = "is_default")]
    bore: Option<f64>,
    #[serde(default, skip_serializing_if = "is_default")]
    piston_mass: Option<f64>,
    #[serde(default, skip_serializing_if = "is_default")]
    rod: Option<RodFigures>,
    /// Whether the piston balances and never has gas.
    #[serde(default, skip_serializing_if = "is_default")]
    dummy: bool,
    /// Whether side rods drive the piston from the far side of its chamber.
    #[serde(default, skip_serializing_if = "is_default")]
    side_rods: bool,
}

/// A number, as which null is infinite.
fn number_or_infinite<'de, D: Deserializer<'de>>(text: D) -> std::result::Result<f64, D::Error> {
    Ok(Option::deserialize(text)?.unwrap_or(f64::INFINITY))
}

fn four() -> u32 {
    4
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_four(strokes: &u32) -> bool {
    *strokes == 4
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StationEntry {
    tdc_deg: Degrees,
    bank_deg: Degrees,
    z: f64,
    /// Absent: the big end of the cylinder's rod, as in engines that are built.
    #[serde(default)]
    rotating_mass: Option<f64>,
    /// Number of the bank, where directions alone leave open which is which.
    #[serde(default, skip_serializing_if = "is_default")]
    bank: Option<usize>,
    /// Number of the crank: 0 is the main one, from 1 those of the list.
    #[serde(default, skip_serializing_if = "is_default")]
    crank: usize,
    /// Number of the cycle, from 1.
    #[serde(default, skip_serializing_if = "is_default")]
    cycle: Option<usize>,
    /// Number of the cycle at the crank end of a double-acting piston, from 1.
    #[serde(default, skip_serializing_if = "is_default")]
    crank_end: Option<usize>,
    /// Diameter of its piston rod.
    #[serde(default, skip_serializing_if = "is_default")]
    rod_diameter: f64,
    /// Whether it fires at the top dead centre of the second turn.
    #[serde(default, skip_serializing_if = "is_default")]
    second_turn: Option<bool>,
    #[serde(default, skip_serializing_if = "is_default")]
    cylinder: Option<PartsEntry>,
    /// Where its rod hangs, if it is a link rod.
    #[serde(default, skip_serializing_if = "is_default")]
    link: Option<LinkEntry>,
}

/// A link rod: its place on the master rod.
#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct LinkEntry {
    /// Number of the cylinder of the master rod.
    master: usize,
    radius: f64,
    /// Absent: that between the bores.
    #[serde(default)]
    angle_deg: Option<Degrees>,
    /// Absent: the big end of the cylinder's rod.
    #[serde(default)]
    big_end_mass: Option<f64>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct BalanceShaft {
    #[serde(default, skip_serializing_if = "is_default")]
    name: String,
    ratio: SpeedRatio,
    #[serde(default)]
    x: f64,
    #[serde(default)]
    y: f64,
    unbalances: Vec<Unbalance>,
}

/// A cycle, by the name of an example or by its points.
#[derive(Serialize, Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct CycleEntry {
    /// `petrol` or `diesel`: that example at full load, in place of points.
    #[serde(default, skip_serializing_if = "is_default")]
    example: Option<String>,
    #[serde(default, skip_serializing_if = "is_default")]
    name: String,
    /// Absent: 4, of an example.
    #[serde(default, skip_serializing_if = "is_default")]
    strokes: Option<u32>,
    #[serde(default, skip_serializing_if = "is_default")]
    theta_deg: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "is_default")]
    pressure: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "is_default")]
    degree: Option<usize>,
}

impl CycleEntry {
    fn of_points(cycle: &Cycle) -> Self {
        let Given { name, strokes, theta_deg, pressure, degree } = cycle.given().clone();
        let (theta_deg, pressure) = (Some(theta_deg), Some(pressure));
        Self { example: None, name, strokes: Some(strokes), theta_deg, pressure, degree }
    }

    /// By name, of an example at full load.
    fn of_example(cycle: &Cycle) -> Result<Option<Self>> {
        for kind in ExampleKind::ALL {
            let has_name = cycle.given().name == kind.name_at_full_load();
            if has_name && *full_load(kind, cycle.strokes())? == *cycle {
                let strokes = Some(cycle.strokes().number()).filter(|&strokes| strokes != 4);
                let example = Some(kind.name().to_owned());
                return Ok(Some(Self { example, strokes, ..Self::default() }));
            }
        }
        Ok(None)
    }

    fn cycle(self) -> Result<Arc<Cycle>> {
        let Self { example, name, strokes, theta_deg, pressure, degree } = self;
        let Some(example) = example else {
            let missing = |entry: &str| {
                Error::value(entry, "None", "give strokes, theta_deg and pressure, or example")
            };
            let strokes = strokes.ok_or_else(|| missing("strokes"))?;
            let theta_deg = theta_deg.ok_or_else(|| missing("theta_deg"))?;
            let pressure = pressure.ok_or_else(|| missing("pressure"))?;
            return Cycle::new(Given { name, strokes, theta_deg, pressure, degree }).map(Arc::new);
        };
        let kind = ExampleKind::ALL.into_iter().find(|kind| kind.name() == example);
        let kind = kind.ok_or_else(|| {
            let hint =
                format!("give one of {}", ExampleKind::ALL.map(ExampleKind::name).join(", "));
            Error::value("example", shorten(&example), hint)
        })?;
        for (name, beside) in [
            ("name", !name.is_empty()),
            ("theta_deg", theta_deg.is_some()),
            ("pressure", pressure.is_some()),
            ("degree", degree.is_some()),
        ] {
            if beside {
                let hint = "is given beside example, which has its own; leave one of the two out";
                return Err(Error::value(name, "given", hint));
            }
        }
        full_load(kind, Strokes::from_number(strokes.unwrap_or(4))?)
    }
}

impl From<&Shaft> for BalanceShaft {
    fn from(Shaft { name, ratio, axis: [x, y], unbalances }: &Shaft) -> Self {
        let (name, unbalances) = (name.clone(), unbalances.clone());
        Self { name, ratio: *ratio, x: *x, y: *y, unbalances }
    }
}

impl From<BalanceShaft> for Shaft {
    fn from(BalanceShaft { name, ratio, x, y, unbalances }: BalanceShaft) -> Self {
        Self { name, ratio, axis: [x, y], unbalances }
    }
}

/// Degrees as a number, or as a fraction in a string where no double is exact.
#[derive(Serialize, Deserialize, PartialEq)]
#[serde(untagged, expecting = "expected degrees, a number or a text such as \"360/7\"")]
enum Degrees {
    Number(f64),
    Text(String),
}

impl Degrees {
    fn of(angle: Angle) -> Self {
        let degrees = angle.degrees();
        if Angle::from_degrees(degrees) == Ok(angle) {
            Self::Number(degrees)
        } else {
            Self::Text(angle.to_string())
        }
    }

    fn angle(&self, argument: &str) -> Result<Angle> {
        let angle = match self {
            Self::Number(degrees) => Angle::from_degrees(*degrees),
            Self::Text(text) => text.parse(),
        };
        angle.map_err(|error| error.named(argument))
    }
}

impl Serialize for Angle {
    fn serialize<S: Serializer>(&self, text: S) -> std::result::Result<S::Ok, S::Error> {
        Degrees::of(*self).serialize(text)
    }
}

impl<'de> Deserialize<'de> for Angle {
    fn deserialize<D: Deserializer<'de>>(text: D) -> std::result::Result<Self, D::Error> {
        Degrees::deserialize(text)?.angle("angle").map_err(serde::de::Error::custom)
    }
}

impl PartsEntry {
    fn of(cylinder: &Cylinder, details: &Details) -> Self {
        Self {
            crank_radius: cylinder.crank_radius(),
            rod_length: cylinder.rod_length(),
            reciprocating_mass: cylinder.reciprocating_mass(),
            pin_offset: cylinder.pin_offset(),
            rod_inertia_excess: cylinder.rod_inertia_excess(),
            bore: details.bore,
            piston_mass: details.piston_mass,
            rod: details.rod,
            dummy: details.dummy,
            side_rods: details.side_rods,
        }
    }

    fn cylinder(&self) -> Result<Cylinder> {
        Cylinder::new(self.crank_radius, self.rod_length, self.reciprocating_mass, self.pin_offset)?
            .with_rod_inertia_excess(self.rod_inertia_excess)
    }

    fn details(&self) -> Details {
        let Self { bore, piston_mass, rod, dummy, side_rods, .. } = *self;
        Details { bore, piston_mass, rod, dummy, side_rods }
    }
}

impl EngineFile {
    fn of(engine: &Engine) -> Result<Self> {
        let hint = "is not part of an engine file; write the engine without it";
        if let Some(load) = engine.loads().iter().find(|load| load.source.is_some()) {
            return Err(Error::value("loads", format!("source {:?}", load.name), hint));
        }
        if engine.spectrum().is_some() {
            return Err(Error::value("spectrum", "given", hint));
        }
        let places = engine.stations().iter().zip(engine.details());
        let parts: Vec<PartsEntry> =
            places.map(|(p, details)| PartsEntry::of(&p.cylinder, details)).collect();
        let shared = parts.iter().all(|entry| *entry == parts[0]);
        let numbered = !engine.has_banks_of_directions();
        let number =
            |bank: usize| engine.right.map_or(bank, |right| usize::from(bank != right)) + 1;
        let place = |(i, p): (usize, &Station)| StationEntry {
            tdc_deg: Degrees::of(p.tdc),
            bank_deg: Degrees::of(p.bank),
            z: p.z,
            rotating_mass: Some(p.rotating_mass),
            bank: numbered.then(|| number(engine.bank_of(i))),
            crank: engine.crank_of(i).position(),
            cycle: engine.gas().and_then(|gas| gas.cycle_of[i]).map(|cycle| cycle + 1),
            crank_end: engine.gas().and_then(|gas| gas.crank_end(i)).map(|end| end.cycle + 1),
            rod_diameter: engine
                .gas()
                .and_then(|gas| gas.crank_end(i))
                .map_or(0.0, |end| end.rod_diameter),
            // Of an engine with pressure false is left out; without, that all are given says which.
            second_turn: engine
                .turns()
                .map(|turns| turns[i])
                .filter(|second| *second || engine.gas().is_none()),
            cylinder: (!shared).then_some(parts[i]),
            link: engine.link_rods()[i].map(|link| LinkEntry {
                master: link.master + 1,
                radius: link.radius,
                angle_deg: Some(Degrees::of(link.angle)),
                big_end_mass: Some(link.big_end_mass),
            }),
        };
        Ok(Self {
            schema: SCHEMA,
            name: engine.name().to_owned(),
            source: engine.source().to_owned(),
            firing_order: engine.firing_order().to_owned(),
            strokes: engine.strokes().number(),
            reference_z: engine.reference_z(),
            mains: engine.mains().to_vec(),
            cylinder: shared.then_some(parts[0]),
            placements: engine.stations().iter().enumerate().map(place).collect(),
            counterweights: engine.counterweights().to_vec(),
            shafts: engine.shafts().iter().map(BalanceShaft::from).collect(),
            loads: engine.loads().to_vec(),
            cranks: engine
                .cranks()
                .iter()
                .skip(1)
                .map(|&Crank { axis: [x, y], ratio }| OtherCrank { x, y, ratio })
                .collect(),
            crankcase: engine.gas().map(|gas| gas.crankcase),
            cycles: engine.gas().map_or_else(Vec::new, |gas| {
                gas.cycles.iter().map(|cycle| CycleEntry::of_points(cycle)).collect()
            }),
            powertrain: None,
        })
    }

    /// The engine, if there is one, and its body on mounts, if there is one: not neither.
    fn mounted(mut self) -> Result<(Option<Engine>, Option<Powertrain>)> {
        let powertrain = self.powertrain.take();
        let powertrain = powertrain.map(|entry| entry.powertrain("powertrain.")).transpose()?;
        let has_engine = !self.placements.is_empty() || self.cylinder.is_some();
        if powertrain.is_some() && !has_engine {
            self.check_schema()?;
            return Ok((None, powertrain));
        }
        Ok((Some(self.engine()?), powertrain))
    }

    fn check_schema(&self) -> Result<()> {
        if self.schema == SCHEMA {
            return Ok(());
        }
        let hint = format!("this version reads schema = {SCHEMA}");
        Err(Error::value("schema", self.schema, hint))
    }

    /// What is written of an engine for people, and its body on mounts: examples by name.
    fn mounted_of(engine: Option<&Engine>, powertrain: Option<&Powertrain>) -> Result<Self> {
        let Some(engine) = engine else {
            let empty = format!(r#"{{"schema": {SCHEMA}}}"#);
            let powertrain = powertrain.map(PowertrainEntry::of);
            return Ok(Self { powertrain, ..of_json(&empty)? });
        };
        let mut file = Self::of(engine)?;
        let cycles = engine.gas().into_iter().flat_map(|gas| &gas.cycles);
        for (entry, cycle) in file.cycles.iter_mut().zip(cycles) {
            if let Some(example) = CycleEntry::of_example(cycle)? {
                *entry = example;
            }
        }
        file.powertrain = powertrain.map(PowertrainEntry::of);
        Ok(file)
    }

    /// Pressure in the cylinders.
    fn gas(&mut self) -> Result<Option<Gas>> {
        if self.cycles.is_empty() {
            let numbered = (0..).zip(&self.placements).find_map(|(i, place): (usize, _)| {
                let named = [("cycle", place.cycle), ("crank_end", place.crank_end)];
                let (name, _) = named.into_iter().find(|(_, number)| number.is_some())?;
                Some(format!("placements[{i}].{name}"))
            });
            return match (numbered, self.crankcase) {
                (Some(argument), _) => {
                    let hint = "is the number of one of the cycles, of which there are none";
                    Err(Error::value(argument, "given", hint))
                }
                (None, Some(pressure)) => {
                    let hint = "is of an engine with cycles; leave it out";
                    Err(Error::figure("crankcase", pressure, hint))
                }
                (None, None) => Ok(None),
            };
        }
        let index = |i: usize, name: &str, number: Option<usize>| {
            let hint = "give the number of a cycle, from 1";
            let index = number.map(|number| number.checked_sub(1).ok_or(number)).transpose();
            index.map_err(|number| Error::value(format!("placements[{i}].{name}"), number, hint))
        };
        let places = || self.placements.iter().enumerate();
        let cycle_of = places().map(|(i, place)| index(i, "cycle", place.cycle));
        let cycle_of: Vec<Option<usize>> = cycle_of.collect::<Result<_>>()?;
        let crank_end = |(i, place): (usize, &StationEntry)| {
            let rod_diameter = place.rod_diameter;
            let cycle = index(i, "crank_end", place.crank_end)?;
            if cycle.is_none() && rod_diameter != 0.0 {
                let hint = "is of a piston with a cycle at its crank end; leave it out";
                let argument = format!("placements[{i}].rod_diameter");
                return Err(Error::figure(argument, rod_diameter, hint));
            }
            Ok(cycle.map(|cycle| CrankEnd { cycle, rod_diameter }))
        };
        let mut crank_ends: Vec<_> = places().map(crank_end).collect::<Result<_>>()?;
        if crank_ends.iter().all(Option::is_none) {
            crank_ends.clear();
        }
        let cycles = mem::take(&mut self.cycles).into_iter().enumerate().map(|(k, entry)| {
            entry.cycle().map_err(|error| error.within(&format!("cycles[{k}].")))
        });
        Ok(Some(Gas {
            cycles: cycles.collect::<Result<_>>()?,
            cycle_of,
            crank_ends,
            crankcase: self.crankcase.unwrap_or(ATMOSPHERE),
            later: self.placements.iter().map(|place| place.second_turn.unwrap_or(false)).collect(),
        }))
    }

    /// Stations of the cylinders, and details of each.
    fn stations(&self) -> Result<(Vec<Station>, Vec<Details>)> {
        let shared = self.cylinder.map(|parts| parts.cylinder()).transpose();
        let shared = shared.map_err(|error| error.within("cylinder."))?;
        let all = self.placements.iter().enumerate().map(|(i, place)| {
            let at = format!("placements[{i}].");
            let own = place.cylinder.map(|parts| parts.cylinder()).transpose();
            let own = own.map_err(|error| error.within(&format!("{at}cylinder.")))?;
            let cylinder = own.or(shared).ok_or_else(|| {
                let hint = "give the engine a [cylinder], or each placement one of its own";
                Error::value(format!("{at}cylinder"), "none", hint)
            })?;
            let parts = place.cylinder.or(self.cylinder);
            let details = parts.map_or_else(Details::default, |parts| parts.details());
            let big_end = || details.big_end(cylinder.rod_length());
            // The big end of a link rod is at its knuckle.
            let is_link = place.link.is_some();
            let big_end = || if is_link { Ok(0.0) } else { big_end() };
            let rotating_mass = place.rotating_mass.map_or_else(big_end, Ok);
            let station = Station {
                cylinder,
                tdc: place.tdc_deg.angle(&format!("{at}tdc_deg"))?,
                bank: place.bank_deg.angle(&format!("{at}bank_deg"))?,
                z: place.z,
                rotating_mass: rotating_mass
                    .map_err(|error| error.within(&format!("{at}cylinder.rod.")))?,
            };
            Ok((station, details))
        });
        let all: Vec<(Station, Details)> = all.collect::<Result<_>>()?;
        Ok(all.into_iter().unzip())
    }

    /// Link rods of cylinders that stand there.
    fn link_rods(&self, stations: &[Station], details: &[Details]) -> Result<Vec<Option<LinkRod>>> {
        let link = |(i, place): (usize, &StationEntry)| {
            let Some(LinkEntry { master, radius, angle_deg, big_end_mass }) = &place.link else {
                return Ok(None);
            };
            let at = format!("placements[{i}].link.");
            let index = master.checked_sub(1).filter(|&index| index < stations.len());
            let Some(master) = index else {
                let hint = format!("give the number of a cylinder, 1 to {}", stations.len());
                return Err(Error::value(format!("{at}master"), master, hint));
            };
            let angle = match angle_deg {
                Some(angle) => angle.angle(&format!("{at}angle_deg"))?,
                None => (stations[i].bank - stations[master].bank).reduced(),
            };
            let own = || details[i].big_end(stations[i].cylinder.rod_length());
            let big_end_mass = big_end_mass.map_or_else(own, Ok)?;
            Ok(Some(LinkRod { master, radius: *radius, angle, big_end_mass }))
        };
        self.placements.iter().enumerate().map(link).collect()
    }

    /// The bank of each cylinder, where banks are numbered.
    fn bank_numbers(&self, stations: &[Station]) -> Result<Option<Vec<usize>>> {
        if self.placements.iter().all(|place| place.bank.is_none()) {
            return Ok(None);
        }
        let numbers = self.placements.iter().enumerate().map(|(i, place)| {
            let hint = "give each placement the number of its bank, or none";
            place.bank.ok_or_else(|| Error::value(format!("placements[{i}].bank"), "none", hint))
        });
        let numbers: Vec<usize> = numbers.collect::<Result<_>>()?;
        same_directions(stations, &numbers)?;
        Ok(Some(numbers))
    }

    fn engine(mut self) -> Result<Engine> {
        self.check_schema()?;
        if self.placements.is_empty() {
            let hint = "give a cylinder or more: a file without them has a [powertrain] alone, which \
                        Powertrain reads";
            return Err(Error::value("placements", "none", hint));
        }
        let (stations, details) = self.stations()?;
        let link_rods = self.link_rods(&stations, &details)?;
        let (strokes, gas) = (Strokes::from_number(self.strokes)?, self.gas()?);
        let (name, source) = (mem::take(&mut self.name), mem::take(&mut self.source));
        let engine = match self.bank_numbers(&stations)? {
            Some(numbers) => Engine::in_banks(name, source, stations, &numbers)?,
            None => Engine::new(name, source, stations)?,
        };
        let others = self.cranks.iter().map(|c| Crank { axis: [c.x, c.y], ratio: c.ratio });
        let cranks = std::iter::once(Crank::MAIN).chain(others).collect();
        let crank_of = self.placements.iter().map(|place| place.crank).collect();
        let turns = self.placements.iter().map(|place| place.second_turn);
        let turns =
            turns.clone().any(|turn| turn.is_some()).then(|| turns.map(Option::unwrap_or_default));
        engine
            .firing_as(self.firing_order, strokes)?
            .with_turns(turns.filter(|_| gas.is_none()).map(Iterator::collect))?
            .with_details(details)?
            .with_cranks(cranks, crank_of)?
            .with_link_rods(link_rods)?
            .with_mains(self.mains)?
            .with_reference(self.reference_z)?
            .with_counterweights(self.counterweights)?
            .with_shafts(self.shafts.into_iter().map(Shaft::from).collect())?
            .with_loads(self.loads)
            .and_then(|engine| gas.map_or(Ok(engine.clone()), |gas| engine.with_gas(gas)))
    }
}

/// Rejects a bank whose cylinders point in several directions.
fn same_directions(stations: &[Station], numbers: &[usize]) -> Result<()> {
    for (i, (station, number)) in stations.iter().zip(numbers).enumerate() {
        let mut others = stations.iter().zip(numbers);
        let first = others.find(|(_, other)| *other == number).map_or(station, |(p, _)| p);
        if first.bank.reduced() != station.bank.reduced() {
            let hint = format!("make it {}°, the direction of bank {number}", first.bank);
            return Err(Error::value(format!("placements[{i}].bank_deg"), station.bank, hint));
        }
    }
    Ok(())
}

/// Text as TOML.
pub fn to_toml(engine: &Engine) -> Result<String> {
    mounted_to_toml(engine, None)
}

/// Text as JSON.
pub fn to_json(engine: &Engine) -> Result<String> {
    mounted_to_json(engine, None)
}

/// An engine, and its body on mounts, as TOML.
pub fn mounted_to_toml<'a>(
    engine: impl Into<Option<&'a Engine>>,
    powertrain: Option<&Powertrain>,
) -> Result<String> {
    let file = EngineFile::mounted_of(engine.into(), powertrain)?;
    toml::to_string(&file).map_err(|e| unreadable("TOML", &e))
}

/// An engine, and its body on mounts, as JSON.
pub fn mounted_to_json<'a>(
    engine: impl Into<Option<&'a Engine>>,
    powertrain: Option<&Powertrain>,
) -> Result<String> {
    let file = EngineFile::mounted_of(engine.into(), powertrain)?;
    serde_json::to_string_pretty(&file).map_err(|e| unreadable("JSON", &e))
}

/// The engine as data, of any size, for copies that no person reads.
pub fn to_json_text(engine: &Engine) -> Result<String> {
    serde_json::to_string(&EngineFile::of(engine)?).map_err(|e| unreadable("JSON", &e))
}

/// The engine that [`to_json_text`] wrote.
pub fn from_json_text(text: &str) -> Result<Engine> {
    of_json(text)?.engine()
}

fn of_json(text: &str) -> Result<EngineFile> {
    serde_json::from_str(text).map_err(|e| unreadable("JSON", &e))
}

/// Engine from TOML, whether or not the file has a body on mounts too.
pub fn from_toml(text: &str) -> Result<Engine> {
    of_toml(text)?.engine()
}

/// Engine from TOML, and its body on mounts, if there is one; no engine where that is alone.
pub fn mounted_from_toml(text: &str) -> Result<(Option<Engine>, Option<Powertrain>)> {
    of_toml(text)?.mounted()
}

fn of_toml(text: &str) -> Result<EngineFile> {
    let text = readable("TOML", text)?;
    toml::from_str(text).map_err(|error| {
        let end = error.span().map_or(0, |span| span.start.min(text.len()));
        let index = text.get(..end).map_or(0, |before| before.matches('\n').count());
        // The parser's own display quotes the whole line, however long.
        let entry = text.lines().nth(index).and_then(|line| line.split_once('='));
        let (key, value) = entry.map_or(("", ""), |(key, value)| (key.trim(), value.trim()));
        let key = if key.is_empty() { String::new() } else { format!(", {}", shorten(key)) };
        let (hint, reason) = (hint(value), plain(error.message()));
        Error::File { format: "TOML", reason: format!("line {}{key}: {reason}{hint}", index + 1) }
    })
}

/// Engine from JSON, whether or not the file has a body on mounts too.
pub fn from_json(text: &str) -> Result<Engine> {
    of_checked_json(text)?.engine()
}

/// Engine from JSON, and its body on mounts, if there is one; no engine where that is alone.
pub fn mounted_from_json(text: &str) -> Result<(Option<Engine>, Option<Powertrain>)> {
    of_checked_json(text)?.mounted()
}

/// A file whose tables are objects.
fn of_checked_json(text: &str) -> Result<EngineFile> {
    let text = readable("JSON", text)?;
    let file = of_json(text)?;
    let value = |found: serde_json::Result<_>| found.map_err(|e| unreadable("JSON", &e));
    check_tables(
        &value(serde_json::from_str(text))?,
        &value(serde_json::to_value(&file))?,
        "the file",
    )?;
    Ok(file)
}

/// A message of serde's with JSON's words for types, and not too long.
fn plain(message: &str) -> String {
    const TYPE_WORDS: [(&str, &str); 7] = [
        ("expected f64", "expected a number"),
        ("expected i32", "expected a whole number"),
        ("expected u32", "expected a whole number"),
        ("expected usize", "expected a whole number"),
        ("a sequence", "a list"),
        ("type: sequence", "type: list"),
        ("type: map", "type: table"),
    ];
    let all = |text: String, (from, to): &(&str, &str)| text.replace(from, to);
    let message = match message.split_once("expected struct ") {
        None => message.to_owned(),
        // Names of types are no words of files: "struct EngineFile with 17 elements".
        Some((before, rest)) => {
            let rest = rest.trim_start_matches(char::is_alphabetic);
            let rest = rest.split_once(" elements").map_or(rest, |(_, rest)| rest);
            format!("{before}expected a table{rest}")
        }
    };
    shorten(&TYPE_WORDS.iter().fold(message, all))
}

/// What is wrong with a value that begins as a number does: 0,1485 or 86mm.
fn hint(value: &str) -> &'static str {
    let digits = |text: char| text.is_ascii_digit() || "+-.".contains(text);
    let value = value.trim_start_matches('"');
    let rest = value.trim_start_matches(digits);
    let mut next = rest.chars();
    match (rest.len() < value.len(), next.next(), next.next()) {
        (true, Some(','), Some('0'..='9')) => "; a decimal has a point, not a comma",
        (true, Some(first), _) if first.is_alphabetic() => {
            "; numbers have no units: metres, kilograms and degrees"
        }
        _ => "",
    }
}

/// A text without the byte order mark that some editors put before it; rejects one that is too long.
fn readable<'t>(format: &'static str, text: &'t str) -> Result<&'t str> {
    let text = text.trim_start_matches('\u{feff}');
    if text.len() <= LONGEST_TEXT {
        return Ok(text);
    }
    let reason = format!("{} bytes long; an engine file has at most {LONGEST_TEXT}", text.len());
    Err(Error::File { format, reason })
}

/// Rejects arrays in place of objects, which serde reads by position: what is written again has objects there.
fn check_tables(read: &serde_json::Value, written: &serde_json::Value, place: &str) -> Result<()> {
    use serde_json::Value::{Array, Object};
    match (read, written) {
        (Object(read), Object(written)) => {
            let both = read.iter().filter_map(|(key, value)| Some((key, value, written.get(key)?)));
            both.into_iter().try_for_each(|(key, value, again)| check_tables(value, again, key))
        }
        (Array(read), Array(written)) => {
            let mut items = read.iter().zip(written).enumerate();
            items.try_for_each(|(i, (value, again))| {
                check_tables(value, again, &format!("{place}[{i}]"))
            })
        }
        (Array(_), Object(_)) => {
            let reason = format!("{}: give an object, {{ }}", shorten(place));
            Err(Error::File { format: "JSON", reason })
        }
        _ => Ok(()),
    }
}

fn unreadable(format: &'static str, error: &dyn std::error::Error) -> Error {
    Error::File { format, reason: plain(error.to_string().trim_end()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{CrankIndex, Hold};
    use crate::numbers::limits;
    use proptest::prelude::*;

    fn engines() -> impl Strategy<Value = Engine> {
        let inertia = prop_oneof![Just(0.0), -9.0..9.0];
        let cylinder = (1e-3..1.0, 1.01..9.0, 0.0..1e3, -0.009..0.009, inertia);
        let cylinder = cylinder.prop_map(|(r, l, m, e, j)| {
            Cylinder::new(r, r * l, m, r * e).unwrap().with_rod_inertia_excess(j).unwrap()
        });
        let place = (cylinder, -720.0..720.0, -720_i64..720, 1_i64..40, -9.0..9.0, 0.0..9.0);
        let place = place.prop_map(|(cylinder, tdc, bank, parts, z, rotating_mass)| Station {
            cylinder,
            tdc: Angle::from_degrees(tdc).unwrap(),
            bank: Angle::from_degree_fraction(bank, parts).unwrap(),
            z,
            rotating_mass,
        });
        let weight = (0.0..9.0, -720.0..720.0, -9.0..9.0, proptest::option::of(Just(0)));
        let weight = weight.prop_map(|(amount, angle, z, pin)| Unbalance {
            amount,
            angle: Angle::from_degrees(angle).unwrap(),
            z,
            pin,
            crank: CrankIndex::MAIN,
        });
        let weights = proptest::collection::vec(weight, 0..3);
        let shaft = (prop_oneof![-5..0, 1..5], [-9.0..9.0, -9.0..9.0], weights.clone());
        let shaft = shaft.prop_map(|(ratio, axis, mut unbalances)| {
            for unbalance in &mut unbalances {
                unbalance.pin = None;
            }
            let ratio = SpeedRatio::from_halves(ratio);
            Shaft { name: format!("{ratio}"), ratio, axis, unbalances }
        });
        let shafts = proptest::collection::vec(shaft, 0..3);
        (proptest::collection::vec(place, 1..9), ".*", weights, shafts).prop_map(
            |(stations, name, weights, shafts)| {
                let engine =
                    Engine::new(name, "", stations).unwrap().firing_as("1", Strokes::Two).unwrap();
                let details = |i: usize| Details {
                    side_rods: i % 3 == 1,
                    dummy: i.is_multiple_of(4),
                    bore: i.is_multiple_of(2).then_some(0.08),
                    piston_mass: i.is_multiple_of(3).then_some(0.3),
                    rod: i.is_multiple_of(5).then_some(RodFigures {
                        mass: 0.5,
                        inertia: 1e-3,
                        to_crankpin: 0.04,
                    }),
                };
                let details = (0..engine.stations().len()).map(details).collect();
                let engine = engine.with_details(details).unwrap();
                let engine = engine.with_reference(Some(0.125)).unwrap();
                let other = Crank { axis: [0.25, -0.125], ratio: SpeedRatio::whole(-1) };
                let crank_of = (0..engine.stations().len()).map(|i| i % 2).collect();
                let engine = engine.with_cranks(vec![Crank::MAIN, other], crank_of).unwrap();
                let engine = engine.with_mains(engine.bearings(CrankIndex::MAIN)).unwrap();
                engine.with_counterweights(weights).unwrap().with_shafts(shafts).unwrap()
            },
        )
    }

    proptest! {
        #[test]
        fn engine_files_read_back_as_equal_engines(engine in engines()) {
            prop_assert_eq!(&from_toml(&to_toml(&engine).unwrap()).unwrap(), &engine);
            prop_assert_eq!(&from_json(&to_json(&engine).unwrap()).unwrap(), &engine);
            prop_assert_eq!(&from_json_text(&to_json_text(&engine).unwrap()).unwrap(), &engine);
        }

        #[test]
        fn no_text_makes_it_panic(text in ".{0,300}") {
            let _ = from_toml(&text);
            let _ = from_json(&text);
        }
    }

    #[test]
    fn vees_at_zero_keep_their_banks_in_files() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let place = |z| Station {
            cylinder,
            tdc: Angle::ZERO,
            bank: Angle::from_degrees(90.0).unwrap(),
            z,
            rotating_mass: 0.0,
        };
        for keys in [[0, 1], [1, 0]] {
            let engine = Engine::in_banks("", "", vec![place(0.0), place(0.1)], &keys).unwrap();
            let text = to_toml(&engine).unwrap();
            assert_eq!(text.matches("\nbank = ").count(), 2, "{text}");
            assert_eq!(from_toml(&text).unwrap(), engine);
            let error = from_toml(&text.replacen("90", "80", 1).replace("bank = 2", "bank = 1"));
            assert!(error.unwrap_err().to_string().contains("bank_deg"));
        }
    }

    #[test]
    fn opened_banks_keep_their_index_in_files() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let place = |bank: f64, z| Station {
            cylinder,
            tdc: Angle::ZERO,
            bank: Angle::from_degrees(bank).unwrap(),
            z,
            rotating_mass: 0.0,
        };
        // About a bisector at 40° the right bank of a flat engine is at 310°, not at 130°.
        for [a, b] in [[10.0, 70.0], [70.0, 10.0], [60.0, 120.0], [200.0, 260.0]] {
            let vee = Engine::new("", "", vec![place(a, 0.0), place(b, 0.1)]).unwrap();
            for opened in [0, 180, 90] {
                let angle = Angle::from_degree_fraction(opened, 1).unwrap();
                let engine = vee.with_bank_angle(angle, Hold::Pins).unwrap();
                assert_eq!(from_toml(&to_toml(&engine).unwrap()).unwrap(), engine);
            }
        }
    }

    #[test]
    fn the_largest_engines_fit_a_file() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let place = Station {
            cylinder,
            tdc: Angle::ZERO,
            bank: Angle::QUARTER_TURN,
            z: 0.0,
            rotating_mass: 0.0,
        };
        let angle = Angle::from_degree_fraction(123_456_789, 1_000_000).unwrap();
        let weight = Unbalance {
            amount: 0.1 / 3.0,
            angle,
            z: -0.1 / 7.0,
            pin: None,
            crank: CrankIndex::MAIN,
        };
        let shaft = Shaft {
            name: String::new(),
            ratio: SpeedRatio::whole(-2),
            axis: [0.1, 0.2],
            unbalances: vec![weight; limits::MOST_UNBALANCES],
        };
        let engine = Engine::new("", "", vec![place]).unwrap();
        let most = limits::MOST_UNBALANCES_OF_ALL / limits::MOST_UNBALANCES;
        let engine = engine.with_shafts(vec![shaft.clone(); most]).unwrap();
        assert!(to_toml(&engine).unwrap().len() <= LONGEST_TEXT / 2);
        assert_eq!(from_json(&to_json(&engine).unwrap()).unwrap(), engine);
        assert!(engine.with_shafts(vec![shaft; most + 1]).is_err());
    }

    #[test]
    fn shared_gears_are_written_once_and_zero_inertias_not_at_all() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let other = cylinder.with_rod_inertia_excess(1e-3).unwrap();
        let place = |cylinder| Station {
            cylinder,
            tdc: Angle::ZERO,
            bank: Angle::QUARTER_TURN,
            z: 0.0,
            rotating_mass: 0.0,
        };
        for (cylinders, lengths, inertias) in
            [([cylinder, cylinder], 1, 0), ([cylinder, other], 2, 1)]
        {
            let engine = Engine::new("", "", cylinders.map(place).to_vec()).unwrap();
            for text in [to_toml(&engine).unwrap(), to_json(&engine).unwrap()] {
                assert_eq!(text.matches("rod_length").count(), lengths, "{text}");
                assert_eq!(text.matches("rod_inertia_excess").count(), inertias, "{text}");
            }
        }
    }

    #[test]
    fn bodies_on_mounts_read_back_as_equal_ones() {
        use crate::Complex64;
        use crate::mounts::{
            ForceTable, InertiaTrack, Mount, MountFigures, Products, Receiver, Receptance,
            RigidBody, Support, Table,
        };
        use crate::numbers::amplitudes::Amplitudes;
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let (tdc, bank) = (Angle::ZERO, Angle::QUARTER_TURN);
        let place = Station { cylinder, tdc, bank, z: 0.0, rotating_mass: 0.0 };
        let engine = Engine::new("", "", vec![place]).unwrap();
        let inertia = [[6.0, 0.4, -0.9], [0.4, 8.5, 0.3], [-0.9, 0.3, 3.2]];
        let body = RigidBody::new(150.0, [0.1, 0.2, 0.3], inertia, Some(Products::Tensor)).unwrap();
        let plain =
            MountFigures { name: "a".into(), stiffness: [1e5; 3], ..MountFigures::default() };
        let axes = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let track = Some(InertiaTrack { stiffness: 1e5, frequency: 9.0, damping_ratio: 0.2 });
        let stiffness = vec![[Complex64::new(1.0 / 3.0, 0.1); 3]; 2];
        let mounts = [
            plain.clone(),
            MountFigures {
                name: "b".into(),
                axes: Some(axes),
                dynamic_stiffness: Some([2e5; 3]),
                loss_factor: [0.1, 0.2, 0.3],
                damping: [1.0; 3],
                track,
                ..plain.clone()
            },
            MountFigures {
                name: "c".into(),
                tilt_deg: 45.0,
                table: Some(Table { frequency: vec![0.0, 50.0], stiffness }),
                ..plain
            },
        ];
        let mounts = mounts.into_iter().map(|figures| Mount::new(figures).unwrap()).collect();
        let powertrain = Powertrain::new(body, mounts).unwrap();
        let text = mounted_to_toml(&engine, Some(&powertrain)).unwrap();
        let (both, engine_again) =
            ((Some(engine.clone()), Some(powertrain.clone())), engine.clone());
        assert_eq!(mounted_from_toml(&text).unwrap(), both, "{text}");
        let json = mounted_to_json(&engine, Some(&powertrain)).unwrap();
        assert_eq!(mounted_from_json(&json).unwrap(), both);
        assert_eq!(
            (from_toml(&text).unwrap(), from_json(&json).unwrap()),
            (engine.clone(), engine)
        );
        let row = (1..=7).map(|k| Complex64::new(f64::from(k), 0.1)).collect();
        let forces = ForceTable {
            name: "maker's".into(),
            rpm: 105.0,
            about: [0.0, 0.1, 0.2],
            speed_squared: Amplitudes(vec![(2, row)]),
            independent: Amplitudes::default(),
        };
        let shaken = powertrain.clone().with_forces(vec![forces]).unwrap();
        for engine in [None, Some(&engine_again)] {
            let both = (engine.cloned(), Some(shaken.clone()));
            let toml = mounted_to_toml(engine, Some(&shaken)).unwrap();
            assert_eq!(mounted_from_toml(&toml).unwrap(), both, "{toml}");
            assert_eq!(from_toml(&toml).is_ok(), engine.is_some());
            let json = mounted_to_json(engine, Some(&shaken)).unwrap();
            assert_eq!(mounted_from_json(&json).unwrap(), both);
        }
        let below = Support::Subframe(Box::new(shaken));
        assert!(powertrain.clone().on(below).unwrap_err().to_string().contains("with forces"));
        let error = |from: &str, to: &str| {
            mounted_from_toml(&text.replacen(from, to, 1)).unwrap_err().to_string()
        };
        let said = "powertrain.body.products = None: give";
        assert!(error("products = \"tensor\"", "").starts_with(said));
        let said = "powertrain.mounts[1].loss_factor[0] = -0.1: give zero or more";
        assert!(error("loss_factor = [0.1,", "loss_factor = [-0.1,").starts_with(said));
        let said = "powertrain.mounts[2].tilt_deg = 45.0: is given beside axes";
        let receptance = Receptance {
            coordinates: vec![("a".into(), 1), ("c".into(), 0)],
            frequency: vec![1.0, 2.0],
            values: vec![vec![Complex64::new(1e-6, -1e-7); 4]; 2],
            receivers: vec![Receiver {
                name: "seat rail".into(),
                transfer: vec![vec![[Complex64::new(1e-7, 1.0 / 3e8); 3]; 2]; 2],
            }],
        };
        for support in [
            Support::Subframe(Box::new(powertrain.clone())),
            Support::Receptance(receptance.checked().unwrap()),
        ] {
            let both = (Some(engine_again.clone()), Some(powertrain.clone().on(support).unwrap()));
            let text = mounted_to_toml(&both.0, both.1.as_ref()).unwrap();
            assert_eq!(mounted_from_toml(&text).unwrap(), both, "{text}");
            let json = mounted_to_json(&both.0, both.1.as_ref()).unwrap();
            assert_eq!(mounted_from_json(&json).unwrap(), both);
        }
        let axes = "tilt_deg = 45.0\naxes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]";
        assert!(error("tilt_deg = 45.0", axes).starts_with(said));
    }

    #[test]
    fn examples_at_full_load_are_written_by_name() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let (tdc, bank) = (Angle::ZERO, Angle::QUARTER_TURN);
        let place = Station { cylinder, tdc, bank, z: 0.0, rotating_mass: 0.0 };
        let bore = Details { bore: Some(0.086), ..Details::default() };
        let bare = Engine::new("", "", vec![place]).unwrap().with_details(vec![bore]).unwrap();
        let fired = |cycle: Cycle| {
            let (cycles, cycle_of) = (vec![Arc::new(cycle)], vec![Some(0)]);
            let (crank_ends, later) = (Vec::new(), vec![false]);
            let gas = Gas { cycles, cycle_of, crank_ends, crankcase: ATMOSPHERE, later };
            let strokes = gas.cycles[0].strokes();
            bare.firing_as("", strokes).unwrap().with_gas(gas).unwrap()
        };
        let all = |kind| [Strokes::Four, Strokes::Two].map(|strokes| (kind, strokes));
        for (kind, strokes) in ExampleKind::ALL.into_iter().flat_map(all) {
            let example = Cycle::clone(&full_load(kind, strokes).unwrap());
            let mut points = example.given().clone();
            points.pressure[3] = points.pressure[3].next_up();
            let mut renamed = example.given().clone();
            renamed.name = "mine".to_owned();
            let [points, renamed] = [points, renamed].map(|given| Cycle::new(given).unwrap());
            for (cycle, by_name) in [(example, true), (points, false), (renamed, false)] {
                let engine = fired(cycle);
                for text in [to_toml(&engine).unwrap(), to_json(&engine).unwrap()] {
                    assert_eq!(!text.contains("pressure"), by_name, "{text}");
                }
                assert_eq!(from_toml(&to_toml(&engine).unwrap()).unwrap(), engine);
                assert_eq!(from_json(&to_json(&engine).unwrap()).unwrap(), engine);
                assert_eq!(from_json_text(&to_json_text(&engine).unwrap()).unwrap(), engine);
            }
        }
        let example = Cycle::clone(&full_load(ExampleKind::Diesel, Strokes::Four).unwrap());
        let text = to_toml(&fired(example)).unwrap();
        let error =
            |from: &str, to: &str| from_toml(&text.replacen(from, to, 1)).unwrap_err().to_string();
        let line = "example = \"diesel\"";
        assert!(error(line, "example = \"steam\"").contains("give one of petrol, diesel"));
        assert!(error(line, "").contains("strokes = None: give strokes"));
        for beside in ["name = \"a\"", "theta_deg = [0]", "pressure = []", "degree = 3"] {
            let (name, _) = beside.split_once(' ').unwrap();
            let said = format!("{name} = given: is given beside example");
            let error = error(line, &format!("{line}\n{beside}"));
            assert!(error.contains(&said), "{error}");
        }
    }

    #[test]
    fn an_error_tells_the_line() {
        let error = from_toml("schema = 1\nname = \"a\"\nplacements = 3\n").unwrap_err();
        let said = "line 3, placements: invalid type: integer `3`, expected a list";
        assert!(error.to_string().contains(said), "{error}");
        let error = from_toml("schema = 1\nreference_z = 0,5\n").unwrap_err().to_string();
        assert!(error.contains("line 2, reference_z: "), "{error}");
        assert!(error.ends_with("; a decimal has a point, not a comma"), "{error}");
        for value in ["86mm", "\"86mm\"", "-1.5kg"] {
            assert!(hint(value).starts_with("; numbers have no units"), "{value}");
        }
        assert_eq!(hint("-12,5e3"), hint("0,5"));
        for value in ["[0, 5]", "0, 5", "\"V6\"", "0.5", "0.5 1", "true"] {
            assert_eq!(hint(value), "", "{value}");
        }
    }

    #[test]
    fn texts_have_a_longest() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let (tdc, bank) = (Angle::ZERO, Angle::QUARTER_TURN);
        let place = Station { cylinder, tdc, bank, z: 0.0, rotating_mass: 0.0 };
        let engine = Engine::new("", "", vec![place]).unwrap();
        let padded = |text: String, length| format!("{text}{}", "\n".repeat(length - text.len()));
        for (length, fits) in [(LONGEST_TEXT, true), (LONGEST_TEXT + 1, false)] {
            assert_eq!(from_toml(&padded(to_toml(&engine).unwrap(), length)).is_ok(), fits);
            assert_eq!(from_json(&padded(to_json(&engine).unwrap(), length)).is_ok(), fits);
        }
    }

    #[test]
    fn json_arrays_are_not_taken_for_objects() {
        let place = r#"{"tdc_deg": 0, "bank_deg": 90, "z": 0}"#;
        let parts = r#"{"crank_radius": 0.05, "rod_length": 0.15, "reciprocating_mass": 0.5}"#;
        let file = |cylinder: &str, place: &str| {
            format!(r#"{{"schema": 1, "cylinder": {cylinder}, "placements": [{place}]}}"#)
        };
        assert!(from_json(&file(parts, place)).is_ok());
        for bad in [
            "[1]".to_owned(),
            file("[0.05, 0.15, 0.5]", place),
            file(parts, "[0, 90, 0]"),
            "7".to_owned(),
        ] {
            assert!(matches!(from_json(&bad), Err(Error::File { .. })), "{bad}");
        }
    }

    #[test]
    fn no_table_of_json_is_read_by_position() {
        let weight = r#"{"amount": 0.1, "angle_deg": 0, "z": 0}"#;
        let body = r#"{"mass": 90, "cg": [0, 0, 0], "inertia": [[3, 0, 0], [0, 2, 0], [0, 0, 2]]}"#;
        let mounts = r#"[{"name": "a", "at": [0, 0, 0], "stiffness": [1e5, 1e5, 1e5],
            "track": {"stiffness": 1e5, "frequency": 9, "damping_ratio": 0.2}}, {"name": "b",
            "at": [0, 0, 1], "stiffness": [1e5, 1e5, 1e5], "table": {"frequency": [1, 2],
            "real": [[1, 1, 1], [1, 1, 1]], "imaginary": [[0, 0, 0], [0, 0, 0]]}}]"#;
        let receptance = r#"{"coordinates": [["a", "x"]], "frequency": [1, 2], "real": [[[1]], [[1]]],
            "imaginary": [[[0]], [[0]]], "receivers": [{"name": "seat", "real": [[[1, 0, 0]], [[1, 0, 0]]],
            "imaginary": [[[0, 0, 0]], [[0, 0, 0]]]}]}"#;
        let subframe = format!(r#"{{"body": {body}, "mounts": {mounts}}}"#);
        for (support, of) in [("subframe", subframe.as_str()), ("receptance", receptance)] {
            let text = format!(
                r#"{{"schema": 1, "cylinder": {{"crank_radius": 0.05, "rod_length": 0.15,
                "reciprocating_mass": 0.5, "pin_offset": 0, "bore": 0.08, "piston_mass": 0.3, "rod":
                {{"mass": 0.5, "inertia": 1e-3, "to_crankpin": 0.04}}}}, "placements": [{{"tdc_deg": 0,
                "bank_deg": 90, "z": 0, "cycle": 1}}], "counterweights": [{weight}], "shafts":
                [{{"ratio": -1, "x": 0, "y": 0, "unbalances": [{weight}]}}], "cranks": [{{"x": 0.1, "y": 0,
                "ratio": -1}}], "loads": [{{"name": "pump", "on": "shaft", "torque": [[1, 2, 3]],
                "over_speed": {{"speed_squared": 1000}}}}], "cycles": [{{"example": "petrol"}}],
                "powertrain": {{"body": {body}, "mounts": {mounts}, "{support}": {of}}}}}"#
            );
            mounted_from_json(&text).unwrap();
            let whole: serde_json::Value = serde_json::from_str(&text).unwrap();
            let mut places = vec![String::new()];
            while let Some(place) = places.pop() {
                let mut changed = whole.clone();
                let value = changed.pointer_mut(&place).unwrap();
                let inside = match value {
                    serde_json::Value::Object(table) => table.keys().cloned().collect(),
                    serde_json::Value::Array(list) => {
                        (0..list.len()).map(|k| k.to_string()).collect()
                    }
                    _ => Vec::new(),
                };
                places.extend(inside.iter().map(|key| format!("{place}/{key}")));
                let Some(table) = value.as_object() else { continue };
                *value = table.values().cloned().collect::<Vec<_>>().into();
                let error = mounted_from_json(&changed.to_string());
                assert!(matches!(error, Err(Error::File { .. })), "{place}: {error:?}");
                assert!(!error.unwrap_err().to_string().contains("struct"));
            }
        }
    }

    #[test]
    fn hostile_texts_are_refused() {
        let deep = "[".repeat(100_000);
        assert!(from_json(&deep).is_err());
        assert!(from_toml(&format!("a = {deep}")).is_err());
        assert!(from_json(&" ".repeat(LONGEST_TEXT + 1)).is_err());
        assert!(from_toml("schema = 2\nplacements = []").is_err());
        assert!(from_toml("schema = 1\nplacements = []").is_err());
        assert!(from_toml("schema = 1\nplacements = []\nextra = 1").is_err());
    }
}
