//! How an engine shakes, order by order.

use crankpin_core::balance::{Balance, Orders, Request, Vector, balance as of};
use crankpin_core::quantity::Part;
use crankpin_core::source::{GAS, INERTIA};
use crankpin_core::{Cancel, Result};
use serde_json::{Map, Value, json};

use crate::answer::{Columns, order, orders, pair};
use crate::arguments::Arguments;

/// Relative tolerance by which orders are chosen, as the library's.
pub const RTOL: f64 = 1e-9;

/// Orders that are given, or a tolerance to choose them by.
pub fn requested(arguments: &mut Arguments) -> Result<Orders> {
    let rtol = arguments.or("rtol", RTOL)?;
    Ok(arguments.orders()?.map_or(Orders::Auto { rtol }, Orders::Given))
}

/// Forces, moments and torques of an engine, by order and of all orders together.
pub fn balance(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let engine = arguments.engine()?;
    let request = Request {
        rpm: arguments.required("rpm")?,
        reference_z: arguments.optional("reference_z")?,
        torque: arguments.or("torque", true)?,
    };
    let orders = requested(arguments)?;
    let cancel = Cancel::new();
    in_json(&of(&engine, &request, &orders, &cancel)?, &cancel)
}

const VECTORS: [(&str, Vector); 2] = [("force", Vector::Force), ("moment", Vector::Moment)];
fn in_json(found: &Balance, cancel: &Cancel) -> Result<Value> {
    let mut by_order = Vec::new();
    for k in 0..found.orders.len() {
        let mut entry = Map::new();
        entry.insert("order".into(), order(found.orders[k]));
        for (name, vector) in VECTORS {
            let planar = found.planar(vector, k);
            let [x, y] = found.xy(vector, k);
            let value = json!({
                "forward": pair(planar.forward), "backward": pair(planar.backward()),
                "x": pair(x), "y": pair(y), "peak": planar.peak(),
                "peak_xy": [x.norm(), y.norm()], "zero_bound": found.zero_bound(vector, k),
            });
            entry.insert(name.into(), value);
        }
        for (name, part) in torques(found) {
            let torque = found.torque(part, k);
            let [of_roll, of_crank] = found.torque_zero_bounds(part, k);
            let value = json!({
                "roll": pair(torque.roll), "crank": pair(torque.crank),
                "zero_bound": of_roll, "crank_zero_bound": of_crank,
            });
            entry.insert(name, value);
        }
        by_order.push(Value::Object(entry));
    }
    let mut total = Map::new();
    for (name, vector) in VECTORS {
        let peaks = found.peak_xy(vector, cancel)?;
        total.insert(name.into(), json!({ "peak": found.peak(vector, cancel)?, "peak_xy": peaks }));
    }
    for (name, part) in torques(found) {
        let [roll, crank] = found.mean(part);
        let value = json!({
            "roll": { "mean": roll, "peak": found.torque_peak(part, false, cancel)? },
            "crank": { "mean": crank, "peak": found.torque_peak(part, true, cancel)? },
        });
        total.insert(name, value);
    }
    let [force, moment, torque] = found.error_bound.values();
    Ok(json!({
        "orders": by_order, "omitted": orders(&found.omitted), "total": total,
        "error_bound": { "force": force, "moment": moment, "torque": torque },
    }))
}

/// Torques and their parts, by name.
fn torques(found: &Balance) -> impl Iterator<Item = (String, Part<'_>)> {
    let further =
        found.names().iter().map(|name| &**name).filter(|name| ![INERTIA, GAS].contains(name));
    let names = [INERTIA, GAS].into_iter().chain(further);
    let parts = names.map(|name| (format!("torque.{name}"), Part::Of(name)));
    let whole = std::iter::once(("torque".to_owned(), Part::Whole));
    whole.chain(parts).filter(|_| found.has_torque)
}
