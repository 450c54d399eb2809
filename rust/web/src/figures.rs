//! What a picture of the turning engine is made of, as `save_html` of the library writes it.

use std::sync::Arc;

use crankpin_core::figures::{
    GROUPS, GroupTerms, Parts, Sizes, block, drawn_rod, exhaust_opens_deg, fired_kinds,
    group_terms, listed_orders, mean_inertia, orders, pressures, sizes, swept,
};
use crankpin_core::{Cancel, Complex64, Engine, Order, Result, Unbalance};
use serde_json::{Value, json};

use crate::answer::{Columns, degrees, orders as numbers};
use crate::arguments::Arguments;
use crate::engine::firing_of;
use crate::words::{sentences_of, shown};

/// An engine's figures, what its reader may set, and the terms of each order; the rod ratio is its own.
pub fn figures(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let engine = arguments.mounted()?.0;
    let rpm: f64 = arguments.required("rpm")?;
    crankpin_core::balance::angular_speed(rpm)?;
    let inertia: Option<f64> = arguments.optional("inertia")?;
    let cancel = Cancel::new();
    let firing = if engine.firing_order().is_empty() {
        None
    } else {
        let angles = degrees(firing_of(&engine)?.angles()).into_iter().zip(engine.details());
        Some(angles.map(|(angle, of)| (!of.dummy).then_some(angle)).collect::<Vec<_>>())
    };
    let cranks = engine.cranks().iter();
    let cranks = cranks.map(|c| json!({ "x": c.axis[0], "y": c.axis[1], "ratio": c.ratio }));
    let shafts = engine.shafts().iter().map(|shaft| {
        let [x, y] = shaft.axis;
        json!({ "ratio": shaft.ratio, "x": x, "y": y, "unbalances": unbalances(&shaft.unbalances) })
    });
    let loads = engine.loads_counted();
    let loads: String =
        loads.chars().take(1).flat_map(char::to_uppercase).chain(loads.chars().skip(1)).collect();
    let sentences = sentences_of(&engine, (rpm > 0.0).then_some(rpm), false, &shown(arguments)?)?;
    let block = block(&engine).map(|bar| json!({ "mass": bar.mass, "inertia": bar.inertia }));
    Ok(json!({
        "name": engine.shown_name(), "strokes": engine.strokes().number(), "rpm": rpm,
        "reference_z": engine.reference(None)?, "bank_angle_deg": engine.changeable_bank_angle(),
        "rod_ratio": null, "cranks": cranks.collect::<Vec<_>>(), "cylinders": cylinders(&engine),
        "counterweights": unbalances(engine.counterweights()), "shafts": shafts.collect::<Vec<_>>(),
        "firing_deg": firing, "exhaust_opens_deg": exhaust_opens_deg(engine.strokes()),
        "terms": terms(&engine, &cancel)?, "block": block, "gas": gas(&engine), "loads": loads,
        "flywheel": inertia, "compact": false, "sentences": sentences,
    }))
}

fn unbalances(list: &[Unbalance]) -> Vec<Value> {
    let each = list.iter();
    each.map(
        |u| json!({ "amount": u.amount, "angle_deg": u.angle.degrees(), "z": u.z, "pin": u.pin }),
    )
    .collect()
}

fn cylinders(engine: &Engine) -> Vec<Value> {
    let kinds = fired_kinds(engine);
    let cycles = cycles(engine);
    let right = engine.banks().map_or(0, |banks| banks.right);
    let entry = |i: usize| {
        let (station, crank) = (&engine.stations()[i], engine.crank_of(i));
        let bank = engine.bank_of(i);
        let mut entry = json!({
            "number": i + 1, "bank": if right == 1 { 1 - bank } else { bank }, "crank": crank,
            "crank_radius": station.cylinder.crank_radius(),
            "rod_length": drawn_rod(&station.cylinder), "yoke": station.cylinder.has_infinite_rod(), "pin_offset": station.cylinder.pin_offset(),
            "tdc_deg": station.tdc.degrees(), "bank_deg": station.bank.degrees(), "z": station.z,
            "cycle": null,
        });
        if let Some((cycle, _)) = engine.pressure_of(i) {
            let is_it = |known: &usize| {
                let (known, of) =
                    (*known, |k: usize| (engine.stations()[k].cylinder, engine.details()[k]));
                of(known) == of(i)
            };
            entry["cycle"] = json!(cycles.iter().position(|known| *known == cycle));
            entry["pressure_deg"] = json!(engine.firing_phase(i).degrees());
            entry["swept"] = json!(kinds.iter().position(is_it));
            // On a crank that turns the other way the torque on the block is the mirror's.
            entry["roll"] = json!(engine.cranks()[crank].ratio.signum());
        }
        entry
    };
    (0..engine.stations().len()).map(entry).collect()
}

/// Cycles that differ, in the order in which cylinders have them.
fn cycles(engine: &Engine) -> Vec<Arc<crankpin_core::Cycle>> {
    let mut cycles = Vec::new();
    for i in 0..engine.stations().len() {
        if let Some((cycle, _)) = engine.pressure_of(i)
            && !cycles.contains(&cycle)
        {
            cycles.push(cycle);
        }
    }
    cycles
}

fn gas(engine: &Engine) -> Option<Value> {
    let crankcase = engine.gas()?.crankcase;
    let cycles: Vec<_> = cycles(engine).iter().map(|cycle| pressures(cycle)).collect();
    Some(json!({ "crankcase": crankcase, "cycles": cycles }))
}

/// Rows as those of the library: order, power and polynomial of the rod ratio, values of groups, and the
/// factor at the engine's own.
fn terms(engine: &Engine, cancel: &Cancel) -> Result<Value> {
    let all = orders(engine, cancel)?;
    let tables = [Parts::Moving, Parts::Standing]
        .map(|parts| group_terms(engine, parts, &all, true, cancel));
    let [moving, standing] = tables;
    let tables = [moving?, standing?];
    let fired = engine.gas().is_some();
    let rows = |values: &dyn Fn(&GroupTerms) -> Vec<Complex64>| {
        let of = |table: &Vec<[GroupTerms; GROUPS]>| -> Vec<Value> {
            all.iter()
                .zip(table)
                .filter_map(|(&n, groups)| row(n, groups.iter().map(values)))
                .collect()
        };
        tables.iter().flat_map(of).collect::<Vec<_>>()
    };
    let planar = rows(&|terms| terms.planar.to_vec());
    let mut torque = rows(&|terms| {
        if fired { vec![terms.roll, terms.inertia] } else { vec![terms.roll] }
    });
    let mut volumes = Vec::new();
    if fired {
        let mean = mean_inertia(engine, cancel)?;
        torque.insert(0, json!([0, 0, [1], [[0, 0, 0, mean, 0]], 1]));
        let last = all.iter().filter_map(|n| n.as_whole()).max().unwrap_or(1);
        let numbers: Vec<u32> = (1..=last).collect();
        for kind in fired_kinds(engine) {
            let values = swept(engine, kind, &numbers, cancel)?;
            let each = numbers.iter().zip(values);
            volumes.push(each.filter_map(|(&n, value)| row(n, [vec![value]])).collect::<Vec<_>>());
        }
    }
    let Sizes { force, moment, torque: of_torque, gas } = sizes(engine, cancel)?;
    Ok(json!({
        // One rod ratio: pages offer no other.
        "rod_ratios": [0, 1, 1], "planar": planar, "torque": torque, "swept": volumes,
        "sizes": { "force": force, "moment": moment, "torque": of_torque, "gas": gas },
        "orders": numbers(&listed_orders(engine)?),
    }))
}

/// A row of the groups that have values.
fn row(
    order: impl Into<RowOrder>,
    groups: impl IntoIterator<Item = Vec<Complex64>>,
) -> Option<Value> {
    let RowOrder(order) = order.into();
    let groups = groups.into_iter().enumerate();
    let groups = groups.filter(|(_, values)| values.iter().any(|value| value.norm() > 0.0));
    let listed = |(group, values): (usize, Vec<Complex64>)| {
        let parts = values.into_iter().flat_map(|value| [value.re, value.im]).map(Value::from);
        Value::Array([Value::from(group)].into_iter().chain(parts).collect())
    };
    let groups: Vec<Value> = groups.map(listed).collect();
    (!groups.is_empty()).then(|| json!([order, 0, [1], groups, 1]))
}

/// Number of a row's order.
struct RowOrder(u32);

impl From<u32> for RowOrder {
    fn from(order: u32) -> Self {
        Self(order)
    }
}

impl From<Order> for RowOrder {
    fn from(order: Order) -> Self {
        Self(order.as_whole().unwrap_or(0))
    }
}
