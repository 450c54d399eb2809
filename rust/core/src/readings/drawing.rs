//! Data for drawings of an engine: the places and sizes of its parts, when it fires, and pressures.

use std::sync::Arc;

use serde::Serialize;
use serde_json::{Value, json};

use super::flywheel::SLOWEST;
use super::page::{self, MotionRows, PageTerms};
use super::rows::RodRatios;
use crate::engine::layout::Strokes;
use crate::engine::{Engine, FacePressure, Unbalance};
use crate::firing::Firing;
use crate::load::Scene;
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::figure;
use crate::numbers::index::ListIndex;
use crate::numbers::ratio::SpeedRatio;
use crate::pressure::Cycle;
use crate::source::resolved;

/// Mass of the block, which is not known, over that of the pistons: 90 kg for two litres.
const BLOCK_MASS_RATIO: f64 = 50.0;
/// Significant digits of a cycle's largest pressure to which all of its coefficients are.
const PRESSURE_DIGITS: i32 = 13;

/// An engine at rest, its angles in degrees.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Drawing {
    /// Name as it is shown.
    pub name: String,
    /// 4 or 2.
    pub strokes: u32,
    /// Turns of the main crank after which all of it repeats.
    pub turns: u32,
    /// Plane about which moments are taken, m.
    pub reference_z: f64,
    /// Angle between the two banks where it can change.
    pub bank_angle_deg: Option<f64>,
    /// Cranks, the main one first.
    pub cranks: Vec<DrawnCrank>,
    /// Cylinders by number.
    pub cylinders: Vec<DrawnCylinder>,
    /// Counterweights and other unbalances of the cranks.
    pub counterweights: Vec<DrawnUnbalance>,
    /// Balance shafts.
    pub shafts: Vec<DrawnShaft>,
    /// Crank angle at which each cylinder fires, none of dummy pistons; none without a firing order.
    pub firing_deg: Option<Vec<Option<f64>>>,
    /// Angle before the lowest place of a piston at which exhausts open: an ordinary one.
    pub exhaust_opens_deg: f64,
    /// The engine's own rod ratio where its rows are of others too; none where cylinders differ.
    pub rod_ratio: Option<f64>,
    /// Rod ratios that rows are of: the least, the largest, and that below which the crank turns.
    pub rod_ratios: Option<RodRatios>,
    /// How pistons move, of those that differ.
    pub motions: Vec<MotionRows>,
}

/// Axis of a crank, m, and its speed over that of the main one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DrawnCrank {
    x: f64,
    y: f64,
    ratio: SpeedRatio,
}

/// A shaft: as a crank, with what turns on it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnShaft {
    x: f64,
    y: f64,
    ratio: SpeedRatio,
    unbalances: Vec<DrawnUnbalance>,
}

/// An unbalance, kg·m, at an angle ahead of its crank or shaft, or of a crankpin by the index of a cylinder.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DrawnUnbalance {
    amount: f64,
    angle_deg: f64,
    z: f64,
    pin: Option<usize>,
    crank: usize,
}

/// A cylinder; lengths in m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DrawnCylinder {
    number: usize,
    /// Number under which its chamber fires.
    fires_as: usize,
    /// From 0: of two the right one.
    bank: usize,
    crank: usize,
    crank_radius: f64,
    rod_length: f64,
    /// Whether the rod is the bar of a Scotch yoke.
    yoke: bool,
    pin_offset: f64,
    tdc_deg: f64,
    bank_deg: f64,
    z: f64,
    /// Where its rod hangs, if it is a link rod.
    #[serde(skip_serializing_if = "Option::is_none")]
    link: Option<DrawnLink>,
    /// Place of its piston's motion among those that differ.
    motion: usize,
    /// Place of its cycle among those that differ.
    cycle: Option<usize>,
    #[serde(flatten)]
    pressure: Option<DrawnPressure>,
    /// Whether side rods drive the piston from beyond its chamber.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    side_rods: bool,
    /// At the other end of a double-acting piston, the crank end or, of one on side rods, the head end.
    #[serde(skip_serializing_if = "Option::is_none")]
    crank_end: Option<DrawnCrankEnd>,
}

/// Pressure at a crank end, in place of that of its cylinder.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DrawnCrankEnd {
    /// Place of its cycle among those that differ.
    cycle: usize,
    #[serde(flatten)]
    pressure: DrawnPressure,
}

/// A link rod's place on a master rod.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DrawnLink {
    /// Index of the master's cylinder.
    master: usize,
    /// m.
    radius: f64,
    angle_deg: f64,
}

/// How pressure acts in a cylinder.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DrawnPressure {
    /// Crank angle at which its cycle begins.
    pressure_deg: f64,
    /// Volume that the piston sweeps over a crank radius, below zero at its inner face, m³.
    swept: f64,
    /// Sense of its crank: on one that turns the other way the torque on the block is the mirror's.
    roll: i32,
}

/// Pressure in the cylinders of an engine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnGas {
    /// Absolute pressure in the crankcase, Pa.
    crankcase: f64,
    /// Those of the cycles that differ.
    cycles: Vec<DrawnCycle>,
}

/// Absolute pressure over a period, Pa: polynomials between edges, degrees after the firing top dead centre.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnCycle {
    edges_deg: Vec<f64>,
    /// Coefficients of Chebyshev's polynomials, in a list for each panel between two edges.
    coefficients: Vec<Vec<f64>>,
}

/// A bar that stands for the block.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DrawnBlock {
    /// kg.
    pub mass: f64,
    /// Moment of inertia about an axis across the crank, kg·m².
    pub inertia: f64,
}

impl Drawing {
    /// That of an engine, at these rod ratios or its own alone.
    pub fn new(engine: &Arc<Engine>, ratios: Option<RodRatios>, cancel: &Cancel) -> Result<Self> {
        let (motions, motion_of) = page::motions(engine, ratios.as_ref(), cancel)?;
        let cranks = engine.cranks().iter().map(|crank| {
            let [x, y] = crank.axis;
            DrawnCrank { x, y, ratio: crank.ratio }
        });
        let shafts = engine.shafts().iter().map(|shaft| {
            let [x, y] = shaft.axis;
            DrawnShaft { x, y, ratio: shaft.ratio, unbalances: unbalances(&shaft.unbalances) }
        });
        Ok(Self {
            name: engine.shown_name(),
            strokes: engine.strokes().number(),
            turns: turns(engine, cancel)?,
            reference_z: engine.reference(None)?,
            bank_angle_deg: engine.changeable_bank_angle(),
            cranks: cranks.collect(),
            cylinders: cylinders(engine, &motion_of),
            counterweights: unbalances(engine.counterweights()),
            shafts: shafts.collect(),
            firing_deg: firing(engine, cancel)?,
            exhaust_opens_deg: exhaust_opens_deg(engine.strokes()),
            rod_ratio: ratios.and_then(|ratios| ratios.common),
            rod_ratios: ratios,
            motions,
        })
    }
}

/// An engine that turns, as JSON: its drawing, and what its forces, moments and torques are sums of; at these rod
/// ratios or its own alone. Tables of loads must have the speed, rpm.
pub fn turning(
    engine: &Arc<Engine>,
    ratios: Option<RodRatios>,
    rpm: f64,
    cancel: &Cancel,
) -> Result<Value> {
    let mut drawn = json!(Drawing::new(engine, ratios, cancel)?);
    drawn["terms"] = json!(PageTerms::new(engine, ratios.as_ref(), rpm, cancel)?);
    drawn["block"] = json!(block(engine));
    drawn["gas"] = json!(gas(engine));
    // Lowest square of the crank's speed, over that of its mean, at which the engine runs.
    drawn["slowest"] = json!(SLOWEST);
    Ok(drawn)
}

fn unbalances(list: &[Unbalance]) -> Vec<DrawnUnbalance> {
    let drawn = |&Unbalance { amount, angle, z, pin, crank }: &Unbalance| DrawnUnbalance {
        amount,
        angle_deg: angle.degrees(),
        z,
        pin,
        crank: crank.position(),
    };
    list.iter().map(drawn).collect()
}

fn firing(engine: &Arc<Engine>, cancel: &Cancel) -> Result<Option<Vec<Option<f64>>>> {
    if engine.firing_order().is_empty() || !engine.fires_in_main_cycles() {
        return Ok(None);
    }
    let angles = Firing::own(engine, cancel)?.angles().into_iter().map(Angle::degrees);
    let fired = angles.zip(engine.details());
    Ok(Some(fired.map(|(angle, of)| (!of.dummy).then_some(angle)).collect()))
}

fn cylinders(engine: &Engine, motion_of: &[usize]) -> Vec<DrawnCylinder> {
    let cycles = cycles(engine);
    // Of two banks the right one comes first, whichever has the first index.
    let swapped = engine.banks().is_ok_and(|banks| banks.right == 1);
    let drawn = |i: usize| {
        let (station, crank) = (&engine.stations()[i], engine.crank_of(i));
        let (parts, bank) = (&station.cylinder, engine.bank_of(i));
        let ratio = engine.cranks()[crank].ratio;
        let drawn_pressure = |pressure: &FacePressure| DrawnPressure {
            pressure_deg: pressure.phase.degrees(),
            swept: pressure.area * parts.crank_radius(),
            roll: ratio.sense(),
        };
        let pressures = engine.pressures(i);
        let own = engine.cycle_of(i).and(pressures.first());
        let crank_end = pressures.get(usize::from(own.is_some()));
        let place = |pressure: &FacePressure| cycles.iter().position(|c| *c == pressure.cycle);
        let crank_end = crank_end.and_then(|end| {
            Some(DrawnCrankEnd { cycle: place(end)?, pressure: drawn_pressure(end) })
        });
        DrawnCylinder {
            number: i + 1,
            fires_as: engine.fires_as(i) + 1,
            bank: if swapped { 1 - bank } else { bank },
            crank: crank.position(),
            crank_radius: parts.crank_radius(),
            rod_length: drawn_rod(parts),
            yoke: parts.has_infinite_rod(),
            pin_offset: parts.pin_offset(),
            tdc_deg: station.tdc.degrees(),
            bank_deg: station.bank.degrees(),
            z: station.z,
            link: engine.link_rods()[i].map(|link| DrawnLink {
                master: link.master,
                radius: link.radius,
                angle_deg: link.angle.degrees(),
            }),
            motion: motion_of[i],
            side_rods: engine.details()[i].side_rods,
            pressure: own.map(drawn_pressure),
            cycle: own.and_then(place),
            crank_end,
        }
    };
    (0..engine.stations().len()).map(drawn).collect()
}

/// Turns of the main crank after which all of an engine repeats: its strokes, what turns with cranks and
/// shafts, and its further loads.
fn turns(engine: &Engine, cancel: &Cancel) -> Result<u32> {
    let cranks = engine.cranks().iter().map(|crank| crank.ratio);
    let shafts = engine.shafts().iter().map(|shaft| shaft.ratio);
    let is_half = |ratio: SpeedRatio| ratio.halves() % 2 != 0;
    if engine.strokes() == Strokes::Four || cranks.chain(shafts).any(is_half) {
        return Ok(2);
    }
    let loads = Scene::of(engine, None)?;
    for (_, load) in loads.further() {
        let orders = resolved(loads.source(load), cancel)?;
        if orders.iter().any(|order| order.as_whole().is_none()) {
            return Ok(2);
        }
    }
    Ok(1)
}

/// Cycles that differ, in the order in which cylinders have them.
fn cycles(engine: &Engine) -> Vec<Arc<Cycle>> {
    let mut cycles = Vec::new();
    for pressure in (0..engine.stations().len()).flat_map(|i| engine.pressures(i)) {
        if !cycles.contains(&pressure.cycle) {
            cycles.push(pressure.cycle);
        }
    }
    cycles
}

/// Pressure in the cylinders of an engine, if it counts.
fn gas(engine: &Engine) -> Option<DrawnGas> {
    let crankcase =
        (0..engine.stations().len()).find_map(|i| Some(engine.pressures(i).first()?.crankcase))?;
    Some(DrawnGas { crankcase, cycles: cycles(engine).iter().map(|c| drawn_cycle(c)).collect() })
}

fn drawn_cycle(cycle: &Cycle) -> DrawnCycle {
    let decimals = PRESSURE_DIGITS - cycle.largest().max(1.0).log10().ceil() as i32;
    let rounded = |&value: &f64| figure::rounded(value, decimals.max(0) as usize);
    let panel = |panel: &[f64]| {
        let last = panel.iter().rposition(|&value| rounded(&value) != 0.0).map_or(0, |k| k + 1);
        panel[..last].iter().map(rounded).collect()
    };
    let coefficients = cycle.polynomials().map(panel).collect();
    DrawnCycle { edges_deg: cycle.edges_deg().to_vec(), coefficients }
}

/// Length of a rod in pictures, m: an infinite one is the bar of a Scotch yoke, four crank radii long.
#[must_use]
pub fn drawn_rod(cylinder: &Cylinder) -> f64 {
    if cylinder.has_infinite_rod() {
        return 4.0 * cylinder.crank_radius();
    }
    cylinder.rod_length()
}

/// A bar that stands for the block: as tall as a crank with its rod, and half of that longer than the
/// cylinders at either end; none where the pistons have no mass.
fn block(engine: &Engine) -> Option<DrawnBlock> {
    let cylinders = || engine.stations().iter().map(|station| station.cylinder);
    let mass =
        BLOCK_MASS_RATIO * cylinders().map(|c: Cylinder| c.reciprocating_mass()).sum::<f64>();
    let height = cylinders().map(|c| 2.0 * c.crank_radius() + drawn_rod(&c)).fold(0.0, f64::max);
    let length = engine.length() + height;
    let inertia = mass * (length * length + height * height) / 12.0;
    (mass > 0.0).then_some(DrawnBlock { mass, inertia })
}

/// Angle before the lowest place of a piston at which exhausts open, degrees: an ordinary one.
#[must_use]
pub const fn exhaust_opens_deg(strokes: Strokes) -> f64 {
    match strokes {
        Strokes::Four => 50.0,
        Strokes::Two => 85.0,
    }
}
