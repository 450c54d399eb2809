//! What a picture of a turning engine is computed of: terms of each order over ω², summed over the parts
//! that move together, and what the cylinders make one by one.

use std::collections::BTreeSet;

use super::balance::{Balance, Request, Vector};
use super::flywheel::mean_inertias;
use super::quantity::Part;
use super::terms::terms;
use crate::Complex64;
use crate::engine::{Engine, Origin};
use crate::mechanism::harmonics;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;

/// Highest order of the pistons whose phasors are listed.
pub const HIGHEST_LISTED: u32 = 24;
/// Orders that are enough, but for rods hardly longer than their crank; at most twice as many.
const MOST_ORDERS: u32 = 384;
/// Orders of which a cylinder's terms are below this part of its largest are left out.
const REST: f64 = 1e-12;
/// Sums below this part of what was added are rounding.
const ROUNDING: f64 = 1e-13;
/// Speed, rpm, at which loads of inertia are those over ω².
const ONE_RADIAN_PER_SECOND: f64 = 60.0 / std::f64::consts::TAU;
/// Groups of parts: the right bank, the left one, and what stands still as the bank angle changes.
pub const GROUPS: usize = 3;

/// Parts whose terms are summed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parts {
    /// Cylinders.
    Moving,
    /// Counterweights and shafts, which no rod moves.
    Standing,
}

/// Terms of an order over ω², of each group.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GroupTerms {
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
fn speeds(engine: &Engine) -> Result<BTreeSet<Order>> {
    engine.cranks().iter().map(|crank| crank.ratio.order()).collect()
}

fn request(torque: bool) -> Request {
    Request { rpm: ONE_RADIAN_PER_SECOND, reference_z: None, torque }
}

/// Whole orders up to one, those of shafts, and others.
fn with_shafts(highest: u32, engine: &Engine, others: BTreeSet<Order>) -> Result<Vec<Order>> {
    let shafts = engine.shafts().iter().map(|shaft| shaft.ratio.order());
    let all = (1..=highest).map(Order::whole).chain(shafts).chain(others.into_iter().map(Ok));
    Ok(all.collect::<Result<BTreeSet<_>>>()?.into_iter().collect())
}

/// Orders whose phasors are listed: of pistons and of shafts.
pub fn listed_orders(engine: &Engine) -> Result<Vec<Order>> {
    with_shafts(HIGHEST_LISTED, engine, BTreeSet::new())
}

/// Orders of the cylinders that are more than a rest, of their cranks, and of shafts.
pub fn orders(engine: &Engine, cancel: &Cancel) -> Result<Vec<Order>> {
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
            matches!(origin, Origin::Cylinder(_)).then(|| sizes.iter().rposition(kept)).flatten()
        });
        let last = last.max().map_or(1, |index| index as u32 + 1);
        if last <= count || count >= MOST_ORDERS {
            break last.max(HIGHEST_LISTED);
        }
        count *= 2;
    };
    with_shafts(last, engine, speeds(engine)?)
}

/// Terms of an engine's parts over ω², by order and summed over groups; what cancels within a group is
/// zero.
///
/// Cylinders of the right bank are group 0 and of the left 1 where a change of bank angle moves them
/// apart, and the rest is 2; all are group 0 of other engines.
pub fn group_terms(
    engine: &Engine,
    parts: Parts,
    orders: &[Order],
    torque: bool,
    cancel: &Cancel,
) -> Result<Vec<[GroupTerms; GROUPS]>> {
    let banks = engine.check_bank_angle_can_change().ok();
    let bank = |cylinder: usize| {
        banks.map_or(0, |banks| usize::from(engine.bank_of(cylinder) != banks.right))
    };
    let still = if banks.is_some() { 2 } else { 0 };
    let group = |origin: Origin| match origin {
        Origin::Cylinder(index) => (Parts::Moving, bank(index)),
        Origin::Counterweight(index) => {
            (Parts::Standing, engine.counterweights()[index].pin.map_or(still, bank))
        }
        Origin::Shaft(_) | Origin::Load(_) => (Parts::Standing, still),
    };
    let all = terms(&engine.bare(), &request(torque), [0.0; 2], orders, cancel)?;
    let own = |(origin, part): &(Origin, Balance)| {
        let (kind, group) = group(*origin);
        (kind == parts).then(|| (group, part.clone()))
    };
    let own: Vec<(usize, Balance)> = all.iter().filter_map(own).collect();
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
                if sum.norm() <= ROUNDING * size {
                    *sum = Complex64::default();
                }
            }
        }
        sums
    };
    Ok((0..orders.len()).map(summed).collect())
}

/// Volume that a cylinder's piston adds per radian past its top dead centre, m³: phasors of orders.
pub fn swept(
    engine: &Engine,
    cylinder: usize,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<Vec<Complex64>> {
    let area_by_radius = engine.swept_by_radius(cylinder).unwrap_or(0.0);
    let proportions = engine.stations()[cylinder].cylinder.proportions();
    let harmonics = harmonics::coefficients(&proportions, orders, cancel)?;
    // The volume added per radian is the integral of the piston's acceleration.
    let each = orders.iter().zip(harmonics);
    Ok(each.map(|(&n, a)| Complex64::i() * a * area_by_radius / f64::from(n)).collect())
}

/// Mean moment of inertia of pistons and rods as seen from the crank, kg·m².
pub fn mean_inertia(engine: &Engine, cancel: &Cancel) -> Result<f64> {
    Ok(mean_inertias(engine, cancel)?.iter().sum())
}

/// What the cylinders make one by one, at order 1 of their crank.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
pub fn sizes(engine: &Engine, cancel: &Cancel) -> Result<Sizes> {
    let speeds: Vec<Order> = speeds(engine)?.into_iter().collect();
    let parts = terms(&engine.bare(), &request(false), [0.0; 2], &speeds, cancel)?;
    let reference = engine.reference(None)?.abs();
    let mut found = Sizes::default();
    for (origin, part) in &parts {
        let Origin::Cylinder(i) = *origin else { continue };
        let (station, crank) = (&engine.stations()[i], &engine.cranks()[engine.crank_of(i)]);
        let speed = speeds.iter().position(|&speed| crank.ratio.order() == Ok(speed));
        let force = speed.map_or(0.0, |k| part.planar(Vector::Force, k).peak());
        let [x, y] = crank.axis;
        found.force += force;
        found.moment += force * (station.z.abs() + reference);
        found.torque += force * (station.cylinder.crank_radius() + x.hypot(y));
        if let (Some((cycle, _)), Some(swept)) = (engine.pressure_of(i), engine.swept_by_radius(i))
        {
            found.gas += cycle.given().pressure.iter().copied().fold(0.0, f64::max) * swept;
        }
    }
    Ok(found)
}
