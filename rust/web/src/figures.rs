//! What a picture of the turning engine is made of, as `save_html` of the library writes it.

use std::sync::Arc;

use crankpin_core::drawing::{Drawing, block, fired_kinds, gas};
use crankpin_core::figures::{
    GROUPS, GroupTerms, Sizes, group_terms, listed_orders, load_rows, mean_inertia, orders, sizes,
    swept,
};
use crankpin_core::{Cancel, Complex64, Engine, Order, Result};
use serde_json::{Value, json};

use crate::answer::{self, Columns, orders as numbers};
use crate::arguments::Arguments;
use crate::words::{sentences_of, shown};

/// An engine's figures, what its reader may set, and the terms of each order; the rod ratio is its own.
pub fn figures(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let engine = arguments.mounted()?.0;
    let rpm: f64 = arguments.required("rpm")?;
    crankpin_core::balance::angular_speed(rpm)?;
    let inertia: Option<f64> = arguments.optional("inertia")?;
    let loads = engine.loads_counted();
    let loads: String =
        loads.chars().take(1).flat_map(char::to_uppercase).chain(loads.chars().skip(1)).collect();
    let sentences = sentences_of(&engine, (rpm > 0.0).then_some(rpm), false, &shown(arguments)?)?;
    let cancel = Cancel::new();
    let engine = Arc::new(engine);
    let mut figures = json!(Drawing::new(&engine, &cancel)?);
    let own = json!({
        "rpm": rpm, "rod_ratio": null, "terms": terms(&engine, rpm, &cancel)?, "block": block(&engine),
        "gas": gas(&engine), "loads": loads, "flywheel": inertia, "compact": false,
        "sentences": sentences,
    });
    if let (Value::Object(figures), Value::Object(own)) = (&mut figures, own) {
        figures.extend(own);
    }
    Ok(figures)
}

/// Rows as those of the library: order, power and polynomial of the rod ratio, values of groups, and the
/// factor at the engine's own.
fn terms(engine: &Engine, rpm: f64, cancel: &Cancel) -> Result<Value> {
    let all = orders(engine, cancel)?;
    let tables =
        [true, false].map(|of_cylinders| group_terms(engine, of_cylinders, &all, true, cancel));
    let [moving, standing] = tables;
    let tables = [moving?, standing?];
    let driven = engine.gas().is_some() || !engine.loads().is_empty();
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
        if driven { vec![terms.roll, terms.inertia] } else { vec![terms.roll] }
    });
    let mut volumes = Vec::new();
    if driven {
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
        "loads": load_rows(engine, rpm, true, cancel)?, "orders": numbers(&listed_orders(engine)?),
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
struct RowOrder(Value);

impl From<u32> for RowOrder {
    fn from(order: u32) -> Self {
        Self(order.into())
    }
}

impl From<Order> for RowOrder {
    fn from(order: Order) -> Self {
        Self(answer::order(order))
    }
}
