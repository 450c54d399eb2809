//! How an engine shakes, as findings and in sentences: residual, cancelled orders with the reason, and hints.
//!
//! Imports run downwards: [`finding`] is data, `sums` has the findings on force and moment, `words`
//! are small texts, `sentences` a sentence for each kind of finding.

pub mod finding;
mod sentences;
mod sums;
pub mod words;

use std::sync::Arc;

pub use self::finding::{Finding, LargestOrder, Row};
pub use self::sentences::Wording;
use self::sums::VectorSums;
use crate::engine::{CrankIndex, Engine, Unbalance};
use crate::firing::Firing;
use crate::load::Scene;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::figure::rounded;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::readings::balance::{
    Balance, Orders, Request, UNIT_RPM, Vector, angular_speed, balance,
};
use crate::readings::exact::vanishing::{ProofQuantity, Verdict, ZeroProofs, vanishing_of};
use crate::readings::quantity;
use crate::readings::terms::terms;
use crate::readings::turning::{RollOfAxes, roll_of_axes};
use crate::wrench::Wrench;

/// Highest order whose cancelling is explained.
const HIGHEST_EXPLAINED: u32 = 12;
/// Orders are mentioned from this part of one piston's first-order force, at the longest lever.
const SMALLEST_MENTIONED: f64 = 0.01;
/// Orders of gas torque that are mentioned.
const GAS_ORDERS: usize = 2;
/// Tolerance by which the orders of a balance are chosen.
const RTOL: f64 = 1e-9;

/// What to explain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// Force and moment.
    Vectors,
    /// Torque and firing too.
    Everything,
}

/// How an engine shakes, what matters most first.
///
/// ```
/// # let four = crankpin_core::engine::file::from_toml(
/// #     "schema = 1
/// #     cylinder = { crank_radius = 0.043, rod_length = 0.145, reciprocating_mass = 0.66 }
/// #     placements = [
/// #         { tdc_deg = 0, bank_deg = 90, z = 0 }, { tdc_deg = 180, bank_deg = 90, z = 0.1 },
/// #         { tdc_deg = 180, bank_deg = 90, z = 0.2 }, { tdc_deg = 0, bank_deg = 90, z = 0.3 },
/// #     ]",
/// # )?;
/// use std::sync::Arc;
///
/// use crankpin_core::Cancel;
/// use crankpin_core::explain::{Subject, Wording, explain};
///
/// let four = Arc::new(four);
/// let found = explain(&four, Some(6000.0), Subject::Everything, &Cancel::new())?;
/// assert_eq!(
///     found.sentences(&found.findings, &Wording::of(&four))[0],
///     "Order 2 leaves a shaking force of 13.6 kN, up and down: all four pistons pull together."
/// );
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    engine: Arc<Engine>,
    /// Crank speed; none for figures relative to one piston's first-order force.
    pub rpm: Option<f64>,
    /// First-order force of the strongest piston, or of a throw; 0 without both. Without a speed over ω².
    pub unit: f64,
    /// The part that makes it: a throw where pistons are not worth mention beside it.
    pub part: ReferencePart,
    /// Longest lever of a cylinder or an unbalance about the reference plane, m.
    pub lever: f64,
    /// What matters most first.
    pub findings: Vec<Finding>,
}

/// Part whose first-order force others are relative to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReferencePart {
    /// A piston.
    Piston,
    /// A throw with what rotates at it.
    Throw,
}

impl ReferencePart {
    /// In a word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Piston => "piston",
            Self::Throw => "throw",
        }
    }
}

/// Explain how an engine shakes.
pub fn explain(
    engine: &Arc<Engine>,
    rpm: Option<f64>,
    subject: Subject,
    cancel: &Cancel,
) -> Result<Explanation> {
    let speed = rpm.unwrap_or(UNIT_RPM);
    let omega = angular_speed(speed)?;
    // Further loads are findings of their own, beside those of what moves.
    let whole = Arc::clone(engine);
    let engine = &if engine.loads().is_empty() {
        Arc::clone(engine)
    } else {
        Arc::new(engine.with_loads(vec![])?)
    };
    let (over_square, part) = strongest(engine, cancel)?;
    let (unit, lever) = (omega * omega * over_square, longest_lever(engine)?);
    let mut findings = of_vectors(engine, speed, [unit, unit * lever], cancel)?;
    if subject == Subject::Everything {
        findings.extend(torques(engine, speed, cancel)?);
        findings.extend(firing(engine, cancel)?);
        findings.extend(shared_pins(engine));
        findings.extend(given_loads(&whole, rpm, cancel)?);
    }
    Ok(Explanation { engine: whole, rpm, unit, part, lever, findings })
}

// --- what figures are relative to ---

/// First-order force over ω² of the strongest piston, or of a throw: the order of its own crank.
fn strongest(engine: &Engine, cancel: &Cancel) -> Result<(f64, ReferencePart)> {
    let loads = Scene::of(engine, None)?;
    let mut pistons: f64 = 0.0;
    let mut throws: f64 = 0.0;
    for load in &loads.list {
        if load.place.origin.cylinder().is_none() {
            continue;
        }
        let first = load.place.ratio.order()?;
        let force = loads.source(load).force(&[first], cancel)?[0].norm();
        let size = force * load.weight.abs() * load.place.speed_squared();
        let largest = if load.is_turning() { &mut throws } else { &mut pistons };
        *largest = largest.max(size);
    }
    Ok(if pistons > SMALLEST_MENTIONED * throws {
        (pistons, ReferencePart::Piston)
    } else {
        (throws, ReferencePart::Throw)
    })
}

fn longest_lever(engine: &Engine) -> Result<f64> {
    let on_shafts = engine.shafts().iter().flat_map(|shaft| &shaft.unbalances);
    let unbalances = engine.counterweights().iter().chain(on_shafts);
    engine.longest_lever(unbalances.map(|unbalance: &Unbalance| unbalance.z))
}

// --- force and moment ---

/// Findings on force and moment, of which an order in these units matters.
fn of_vectors(engine: &Engine, rpm: f64, units: [f64; 2], cancel: &Cancel) -> Result<Vec<Finding>> {
    let request = Request { rpm, reference_z: None, torque: false };
    let chosen = balance(engine, &request, &Orders::Auto { rtol: RTOL }, cancel)?;
    let mut orders =
        [chosen.orders, (1..=HIGHEST_EXPLAINED).map(Order::whole).collect::<Result<_>>()?].concat();
    orders.sort_unstable();
    orders.dedup();
    let whole = balance(engine, &request, &Orders::Given(orders.clone()), cancel)?;
    let parts = terms(engine, &request, [0.0; 2], &orders, cancel)?;
    let reference = engine.reference(None)?;
    let levers: Vec<f64> = engine.stations().iter().map(|place| place.z - reference).collect();
    let proofs = ZeroProofs::new(engine, cancel)?;
    let sums = |vector: Vector, unit: f64| {
        VectorSums::new((engine, &proofs), &levers, (vector, unit), &whole, &parts)
    };
    let both = [sums(Vector::Force, units[0]), sums(Vector::Moment, units[1])];

    let mut found = [both[0].of_hardware()?, both[1].of_hardware()?].concat();
    let mut shaking: Vec<(&VectorSums, usize)> =
        both.iter().flat_map(|sums| sums.shaking().map(move |k| (sums, k))).collect();
    // Of equals forces first, and lower orders.
    let share = |(sums, k): &(&VectorSums, usize)| rounded(sums.share(*k), 6);
    shaking.sort_by(|a, b| share(b).total_cmp(&share(a)));
    let mut weights = bob_weights(engine);
    for (sums, k) in &shaking {
        found.push(sums.left(*k));
        let remedy = sums.remedy(*k);
        let by_weights = matches!(remedy, Some(Finding::Remedy { weights, .. }) if weights != finding::Weights::No);
        found.extend(remedy);
        found.extend(weights.take_if(|_| by_weights));
    }
    found.extend(roll_beside(engine, rpm, units[0], cancel)?);
    let made: Vec<bool> = (0..orders.len()).map(|k| both[0].is_made(k)).collect();
    let banks = engine.cylinders_of_banks();
    for sums in &both {
        found.extend(sums.cancelling(&made, &banks)?);
    }
    let [force, moment, _] = chosen.error_bound.values();
    found.push(Finding::Rest {
        mentioned: shaking.iter().map(|&(_, k)| orders[k]).collect(),
        bounds: [both[0].rest() + force, both[1].rest() + moment],
    });
    Ok(found)
}

/// The roll torque that cranks on several axes make at order 1, in a unit of force that matters.
fn roll_beside(engine: &Engine, rpm: f64, unit: f64, cancel: &Cancel) -> Result<Option<Finding>> {
    let axes = engine.cranks().iter().map(|crank| crank.axis[0].hypot(crank.axis[1]));
    let furthest = axes.fold(0.0, f64::max);
    if furthest == 0.0 || engine.spectrum().is_some() {
        return Ok(None);
    }
    let square = angular_speed(rpm)?.powi(2);
    let RollOfAxes { whole, beside, kept } = roll_of_axes(engine, cancel)?;
    let [whole, beside, kept] = [whole, beside, kept].map(|torque| torque * square);
    let matters = whole.min(beside) > SMALLEST_MENTIONED * unit * furthest;
    Ok(matters.then_some(Finding::Roll { peak: whole, kept }))
}

/// The bob weight that removes what turns with a crank: half of the pistons'.
fn bob_weights(engine: &Engine) -> Option<Finding> {
    let is_of_crank_alone = |i: usize| !engine.mechanism(i).exact_force(1).rest.exists();
    let is_of_crank = |ratio: SpeedRatio| engine.cranks().iter().any(|crank| crank.ratio == ratio);
    // Other cranks have their first order elsewhere.
    let fast = engine.cranks().iter().any(|crank| !crank.ratio.is_crank_speed());
    if !(0..engine.stations().len()).all(is_of_crank_alone)
        || fast
        || engine.shafts().iter().any(|shaft| is_of_crank(shaft.ratio))
    {
        return None;
    }
    Some(Finding::BobWeights { one_sense: !is_of_crank(SpeedRatio::whole(-1)) })
}

// --- torque and firing ---

/// The largest orders of roll torque: of inertia, and of gas if it counts.
fn torques(engine: &Engine, rpm: f64, cancel: &Cancel) -> Result<Vec<Finding>> {
    let request = Request { rpm, reference_z: None, torque: true };
    let found = balance(engine, &request, &Orders::Auto { rtol: RTOL }, cancel)?;
    let by_size = |peak: &dyn Fn(&Balance, usize) -> f64| {
        let peaks = found.orders.iter().enumerate().map(|(k, &order)| (order, peak(&found, k)));
        let mut peaks: Vec<(Order, f64)> = peaks.filter(|(_, peak)| *peak > 0.0).collect();
        peaks.sort_by(|a, b| b.1.total_cmp(&a.1));
        peaks
    };
    let inertia = by_size(&|found, k| found.torque(quantity::Part::INERTIA, k).roll.norm());
    let mut findings = Vec::new();
    if let Some(&(order, peak)) = inertia.first() {
        findings.push(Finding::InertiaTorque { order, peak });
    }
    let mut largest = by_size(&|found, k| found.torque(quantity::Part::GAS, k).crank.norm());
    if !largest.is_empty() {
        largest.truncate(GAS_ORDERS);
        let [_, mean] = found.mean(quantity::Part::GAS);
        findings.push(Finding::GasTorque { mean, largest });
    }
    Ok(findings)
}

/// How the engine fires, and the orders of gas torque that this leaves.
fn firing(engine: &Arc<Engine>, cancel: &Cancel) -> Result<Vec<Finding>> {
    if engine.firing_order().is_empty() || !engine.fires_in_main_cycles() {
        return Ok(Vec::new());
    }
    let fires = Firing::own(engine, cancel)?;
    let (even, order) = (fires.evenly_at_a_time(), fires.fired().to_vec());
    let intervals_deg = fires.intervals().iter().map(|interval| interval.degrees()).collect();
    let mut found = vec![Finding::Fires { order: order.clone(), intervals_deg, even }];
    if engine.cranks().iter().any(|crank| !crank.ratio.is_forward()) {
        return Ok(found); // what cancels on the block is not what cancels on the crank
    }
    let in_two_turns = 4 * order.len() as u32 / engine.strokes().number();
    let orders = (1..=in_two_turns).map(Order::from_halves).collect::<Result<Vec<_>>>()?;
    let gas = ProofQuantity::GasTorque;
    let proofs = vanishing_of(&[gas], engine, &orders, None, Some(&fires), cancel)?.verdicts;
    let gas = proofs.iter().map(|verdicts| verdicts[gas]);
    if gas.clone().any(|verdict| verdict == Verdict::Undecided) {
        return Ok(found);
    }
    let remaining = orders.iter().zip(gas).filter(|(_, verdict)| *verdict == Verdict::Remains);
    let orders: Vec<Order> = remaining.map(|(order, _)| *order).collect();
    if !orders.is_empty() {
        found.push(Finding::GasOrders { orders, firing: order, even });
    }
    Ok(found)
}

/// What further loads add, by name.
fn given_loads(engine: &Engine, rpm: Option<f64>, cancel: &Cancel) -> Result<Vec<Finding>> {
    let mut names: Vec<&str> = Vec::new();
    for load in engine.loads() {
        if !names.contains(&&*load.name) {
            names.push(&load.name);
        }
    }
    let Some(rpm) = rpm.filter(|_| !names.is_empty()) else {
        let unknown = |name: &str| Finding::GivenLoad { name: name.to_owned(), largest: None };
        return Ok(names.into_iter().map(unknown).collect());
    };
    let request = Request { rpm, reference_z: None, torque: true };
    let all = balance(engine, &request, &Orders::Auto { rtol: RTOL }, cancel)?;
    let of_name = |name: &str| {
        let own = all.of_part(quantity::Part::Of(name));
        let others = all.names().iter().filter(|other| &***other != name);
        let others: Vec<Balance> =
            others.map(|other| all.of_part(quantity::Part::Of(other))).collect();
        let largest = |size: &dyn Fn(&Wrench) -> f64| {
            let sizes = own.wrenches.iter().map(size).enumerate();
            let (k, peak) =
                sizes.filter(|(_, size)| *size > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))?;
            let dominates = others.iter().all(|other| size(&other.wrenches[k]) < peak);
            Some(LargestOrder { order: own.orders[k], peak, dominates })
        };
        let both =
            [largest(&|wrench| wrench.force.peak()), largest(&|wrench| wrench.torque.peak())];
        Finding::GivenLoad { name: name.to_owned(), largest: Some(both) }
    };
    Ok(names.into_iter().map(of_name).collect())
}

/// The rows of a radial whose rods are all on the crankpin; none where some are link rods.
fn shared_pins(engine: &Engine) -> Option<Finding> {
    /// Parts of a degree that pins at one place differ by less than.
    const SAME_PIN: f64 = 1e6;
    if engine.has_link_rods() {
        return None;
    }
    let mut pins: Vec<((f64, f64, CrankIndex), Vec<usize>)> = Vec::new();
    for (i, station) in engine.stations().iter().enumerate() {
        let pin = (engine.pin(i).degrees() * SAME_PIN).round_ties_even();
        let place = (station.z, pin, engine.crank_of(i));
        match pins.iter_mut().find(|(other, _)| *other == place) {
            Some((_, row)) => row.push(i),
            None => pins.push((place, vec![i])),
        }
    }
    let rows: Vec<Vec<usize>> =
        pins.into_iter().map(|(_, row)| row).filter(|row| row.len() > 2).collect();
    (!rows.is_empty()).then_some(Finding::Articulated { rows })
}

#[cfg(test)]
mod tests;
