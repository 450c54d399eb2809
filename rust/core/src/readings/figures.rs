//! Data for pictures of a turning engine: terms of each order over ω², summed over the parts
//! that move together, and what the cylinders make one by one.

use std::collections::BTreeSet;

use serde::Serialize;

use super::balance::{Balance, Request, Vector};
use super::flywheel::mean_inertias;
use super::quantity::Part;
use super::terms::{LoadSums, terms};
use crate::Complex64;
use crate::engine::Engine;
use crate::load::{Load, Scene};
use crate::mechanism::spectrum::Spectrum;
use crate::numbers::UNIT_RPM;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::source::{Scaling, resolved};

/// Highest order of the pistons whose phasors are listed.
pub const HIGHEST_LISTED: u32 = 24;
/// Orders that are enough, but for rods hardly longer than their crank; at most twice as many.
const MOST_ORDERS: u32 = 384;
/// Orders of which a cylinder's terms are below this part of its largest are left out.
const REST: f64 = 1e-12;
/// Sums below this part of what was added are rounding.
const FIGURE_ROUNDING: f64 = 1e-13;
/// Groups of parts: the right bank, the left one, and what stands still as the bank angle changes.
pub(super) const GROUPS: usize = 3;

/// Terms of an order over ω², of each group.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct GroupTerms {
    /// Forward and backward parts of the force, then of the moment.
    pub planar: [Complex64; 4],
    /// Roll torque of inertia.
    pub roll: Complex64,
    /// Moment of inertia of pistons and rods as seen from the crank, kg·m²: the torque on it is −½ of its
    /// slope.
    pub inertia: Complex64,
}

impl GroupTerms {
    fn of(part: &Balance, k: usize) -> Self {
        let [force, moment] = [Vector::Force, Vector::Moment].map(|vector| part.planar(vector, k));
        let torque = part.torque(Part::INERTIA, k);
        Self {
            planar: [force.forward, force.backward(), moment.forward, moment.backward()],
            roll: torque.roll,
            inertia: Complex64::new(0.0, 2.0) * torque.crank / part.orders[k].number(),
        }
    }

    fn values(&mut self) -> impl Iterator<Item = &mut Complex64> {
        let Self { planar, roll, inertia } = self;
        planar.iter_mut().chain([roll, inertia])
    }
}

/// Speeds at which cranks turn, over that of the main one.
pub(super) fn speeds(engine: &Engine) -> Result<BTreeSet<Order>> {
    engine.cranks().iter().map(|crank| crank.ratio.order()).collect()
}

fn request(torque: bool) -> Request {
    Request { rpm: UNIT_RPM, reference_z: None, torque }
}

/// Whole orders up to one, those of shafts, and others.
fn with_shafts(highest: u32, engine: &Engine, others: BTreeSet<Order>) -> Result<Vec<Order>> {
    let shafts = engine.shafts().iter().map(|shaft| shaft.ratio.order());
    let all = (1..=highest).map(Order::whole).chain(shafts).chain(others.into_iter().map(Ok));
    Ok(all.collect::<Result<BTreeSet<_>>>()?.into_iter().collect())
}

/// Orders of the main crank that a spectrum has.
fn spectrum_orders(engine: &Engine) -> Result<BTreeSet<Order>> {
    let speeds = speeds(engine)?;
    let harmonics = engine.spectrum().map(Spectrum::orders).unwrap_or_default();
    let orders = harmonics.iter().flat_map(|n| speeds.iter().map(move |speed| n * speed.halves()));
    orders.map(Order::from_halves).collect()
}

/// Orders whose phasors are listed: of pistons, of shafts and of further loads.
pub fn listed_orders(engine: &Engine) -> Result<Vec<Order>> {
    let of_loads = load_orders(engine)?.into_iter();
    let mut listed: BTreeSet<_> =
        of_loads.filter(|order| order.halves() <= 2 * HIGHEST_LISTED).collect();
    listed.extend(spectrum_orders(engine)?);
    with_shafts(HIGHEST_LISTED, engine, listed)
}

/// Orders of the cylinders that are more than a rest, of their cranks, and of shafts.
pub(super) fn orders(engine: &Engine, cancel: &Cancel) -> Result<Vec<Order>> {
    if engine.spectrum().is_some() {
        let mut others = spectrum_orders(engine)?;
        others.extend(speeds(engine)?);
        return with_shafts(0, engine, others);
    }
    let bare = engine.bare();
    let mut count = HIGHEST_LISTED;
    let last = loop {
        let tried = (1..=2 * count).map(Order::whole).collect::<Result<Vec<_>>>()?;
        let parts = terms(&bare, &request(true), [0.0; 2], &tried, cancel)?;
        let last = parts.iter().filter_map(|(origin, part)| {
            let sizes = |k: usize| {
                [part.planar(Vector::Force, k).peak(), part.torque(Part::INERTIA, k).roll.norm()]
            };
            let sizes: Vec<_> = (0..tried.len()).map(sizes).collect();
            let largest =
                [0, 1].map(|q| REST * sizes.iter().map(|size| size[q]).fold(0.0, f64::max));
            let kept = |size: &[f64; 2]| (0..2).any(|q| size[q] > largest[q]);
            origin.cylinder().and_then(|_| sizes.iter().rposition(kept))
        });
        let last = last.max().map_or(1, |index| index as u32 + 1);
        if last <= count || count >= MOST_ORDERS {
            break last.max(HIGHEST_LISTED);
        }
        count *= 2;
    };
    with_shafts(last, engine, speeds(engine)?)
}

/// Terms over ω² of an engine's cylinders, or else of counterweights and shafts, which no rod moves, by order
/// and summed over groups; what cancels within a group is zero.
///
/// Cylinders of the right bank are group 0 and of the left 1 where a change of bank angle moves them
/// apart, and the rest is 2; all are group 0 of other engines.
pub(super) fn group_terms(
    engine: &Engine,
    of_cylinders: bool,
    orders: &[Order],
    torque: bool,
    cancel: &Cancel,
) -> Result<Vec<[GroupTerms; GROUPS]>> {
    let group_of = grouping(engine);
    let all = terms(&engine.bare(), &request(torque), [0.0; 2], orders, cancel)?;
    let own = all.into_iter().filter(|(origin, _)| origin.cylinder().is_some() == of_cylinders);
    let own: Vec<(usize, Balance)> =
        own.map(|(origin, part)| (group_of(engine.bank_with(origin)), part)).collect();
    let summed = |k: usize| {
        let mut sums = [GroupTerms::default(); GROUPS];
        let mut sizes = [[0.0; 6]; GROUPS];
        for (group, part) in &own {
            let mut term = GroupTerms::of(part, k);
            for (j, (sum, value)) in sums[*group].values().zip(term.values()).enumerate() {
                *sum += *value;
                sizes[*group][j] += value.norm();
            }
        }
        for (group, sizes) in sums.iter_mut().zip(&sizes) {
            for (sum, size) in group.values().zip(sizes) {
                if sum.norm() <= FIGURE_ROUNDING * size {
                    *sum = Complex64::default();
                }
            }
        }
        sums
    };
    Ok((0..orders.len()).map(summed).collect())
}

/// Group of what turns with a bank as the bank angle changes, or with none.
fn grouping(engine: &Engine) -> impl Fn(Option<usize>) -> usize {
    let right = engine.check_bank_angle_can_change().ok().map(|banks| banks.right);
    move |bank| match (right, bank) {
        (None, _) => 0,
        (Some(right), Some(bank)) => usize::from(bank != right),
        (Some(_), None) => 2,
    }
}

/// Terms of periodic loads, in rows: order, power and polynomial of the rod ratio, values of groups, factor
/// at the engine's own rod ratio, factor over speed.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct LoadRows {
    /// Forward and backward parts of force, N, then of moment, N·m.
    planar: Vec<LoadRow>,
    /// Torques on the block and on the main crank, N·m; order 0 is their mean.
    torque: Vec<LoadRow>,
    /// Lowest and highest speed of tables, rpm, where there are some.
    speeds: Option<[f64; 2]>,
}

type LoadRow = (f64, u8, [u8; 1], Vec<Vec<f64>>, u8, SpeedFactor);

/// Factor of amplitudes at a speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
enum SpeedFactor {
    /// Power of the angular speed, rad/s.
    Power(u8),
    /// Height of a line that rises from 0 at the first of three crank speeds to 1 at the second, and falls
    /// to 0 at the third, rpm.
    Line([f64; 3]),
}

/// Orders of periodic loads, ascending.
fn load_orders(engine: &Engine) -> Result<Vec<Order>> {
    if engine.loads().is_empty() {
        return Ok(Vec::new());
    }
    let loads = Scene::of(engine, None)?;
    let mut own = BTreeSet::new();
    for (_, load) in loads.further() {
        own.extend(resolved(loads.source(load), &Cancel::new())?);
    }
    Ok(own.into_iter().collect())
}

/// Terms of an engine's periodic loads, each at all speeds; a speed, rpm, that tables do not have is an
/// error.
pub fn load_rows(engine: &Engine, rpm: f64, torque: bool, cancel: &Cancel) -> Result<LoadRows> {
    engine.check_speeds(&[rpm])?;
    let mut rows = LoadRows { speeds: engine.speeds_of_tables(), ..LoadRows::default() };
    let orders = load_orders(engine)?;
    if engine.loads().is_empty() {
        return Ok(rows);
    }
    let engine = engine.without_gas();
    let sums = LoadSums::new(&engine, None, torque, &orders, cancel)?;
    let given = || sums.loads.further().map(|(_, load)| load);
    let mut scalings: Vec<Scaling> = Vec::new();
    for load in given() {
        if !scalings.contains(&load.parts.scaling) {
            scalings.push(load.parts.scaling);
        }
    }
    let group_of = grouping(&engine);
    for scaling in scalings {
        let (over, omega) = match scaling {
            Scaling::SpeedSquared => (SpeedFactor::Power(2), 1.0),
            Scaling::Independent => (SpeedFactor::Power(0), 1.0),
            Scaling::Row(line) => (SpeedFactor::Line(line), line[1] / UNIT_RPM),
        };
        let sum = |group: usize| {
            let is_own =
                |load: &&Load| load.parts.scaling == scaling && group_of(load.place.bank) == group;
            let own: Vec<Load> = given().filter(is_own).copied().collect();
            sums.of(&own, omega, cancel)
        };
        let groups: Vec<Balance> = (0..GROUPS).map(sum).collect::<Result<_>>()?;
        let push = |rows: &mut Vec<LoadRow>, order: f64, values: &dyn Fn(&Balance) -> Vec<f64>| {
            let of_groups = groups.iter().map(values).enumerate();
            let listed: Vec<Vec<f64>> = of_groups
                .filter(|(_, values)| values.iter().any(|value| *value != 0.0))
                .map(|(group, values)| [group as f64].into_iter().chain(values).collect())
                .collect();
            if !listed.is_empty() {
                rows.push((order, 0, [1], listed, 1, over));
            }
        };
        if torque {
            push(&mut rows.torque, 0.0, &|sum| {
                let [roll, crank] = sum.mean(Part::Whole);
                vec![roll, 0.0, crank, 0.0]
            });
        }
        for (k, order) in orders.iter().enumerate() {
            push(&mut rows.planar, order.number(), &|sum| {
                let GroupTerms { planar, .. } = GroupTerms::of(sum, k);
                planar.iter().flat_map(|part| [part.re, part.im]).collect()
            });
            if torque {
                push(&mut rows.torque, order.number(), &|sum| {
                    let torque = sum.torque(Part::Whole, k);
                    [torque.roll, torque.crank].iter().flat_map(|part| [part.re, part.im]).collect()
                });
            }
        }
    }
    Ok(rows)
}

/// Mean moment of inertia of pistons and rods as seen from the crank, kg·m².
pub(super) fn mean_inertia(engine: &Engine, cancel: &Cancel) -> Result<f64> {
    Ok(mean_inertias(engine, cancel)?.iter().sum())
}

/// What the cylinders make one by one, at order 1 of their crank.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Sizes {
    /// Of force, over ω², kg·m.
    pub force: f64,
    /// Of moment, over ω², kg·m².
    pub moment: f64,
    /// Of torque of inertia, over ω², kg·m².
    pub torque: f64,
    /// Of torque of gas, N·m.
    pub gas: f64,
}

/// What the cylinders make one by one.
pub(super) fn sizes(engine: &Engine, cancel: &Cancel) -> Result<Sizes> {
    let speeds: Vec<Order> = speeds(engine)?.into_iter().collect();
    let parts = terms(&engine.bare(), &request(false), [0.0; 2], &speeds, cancel)?;
    let reference = engine.reference(None)?.abs();
    let mut found = Sizes::default();
    for (origin, part) in &parts {
        let Some(i) = origin.cylinder() else { continue };
        let (station, crank) = (&engine.stations()[i], &engine.cranks()[engine.crank_of(i)]);
        let own = part.order(crank.ratio.order()?);
        let force = own.map_or(0.0, |wrench| wrench.force.peak());
        let [x, y] = crank.axis;
        found.force += force;
        found.moment += force * (station.z.abs() + reference);
        found.torque += force * (station.cylinder.crank_radius() + x.hypot(y));
        let radius = station.cylinder.crank_radius();
        for pressure in engine.pressures(i) {
            let largest = pressure.cycle.given().pressure.iter().copied().fold(0.0, f64::max);
            found.gas += largest * pressure.area.abs() * radius;
        }
    }
    Ok(found)
}
