//! Engines from files, and what they are.

use std::sync::Arc;

use crankpin_core::engine::{CrankIndex, file};
use crankpin_core::exact::vanishing::{ProofQuantity, QUANTITIES, Verdict, vanishing as of};
use crankpin_core::index::ListIndex;
use crankpin_core::mounts::Powertrain;
use crankpin_core::{Angle, Cancel, Engine, Firing, Order, Result, Unbalance};
use serde_json::{Map, Value, json};

use crate::answer::{Columns, degrees, order};
use crate::arguments::Arguments;

/// Highest order of what vanishes, as the library's.
const HIGHEST_VANISHING: u32 = 12;

/// An engine's file as this version writes it, and what the engine is.
pub fn read(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let (engine, powertrain) = arguments.mounted()?;
    written(&engine, powertrain.as_ref())
}

/// Files of an engine, and what it is.
pub fn written(engine: &Engine, powertrain: Option<&Powertrain>) -> Result<Value> {
    Ok(json!({
        "toml": file::mounted_to_toml(engine, powertrain)?,
        "json": file::mounted_to_json(engine, powertrain)?,
        "summary": summary(engine, powertrain)?,
    }))
}

fn summary(engine: &Engine, powertrain: Option<&Powertrain>) -> Result<Value> {
    let stations = engine.stations();
    let count = stations.len();
    let firing = if engine.firing_order().is_empty() { None } else { Some(fired(engine)?) };
    let bank = |i| engine.bank_of(i);
    let cranks =
        engine.cranks().iter().map(|c| json!({ "x": c.axis[0], "y": c.axis[1], "ratio": c.ratio }));
    let weight = |weight: &Unbalance, direction: Angle| json!({ "z": weight.z, "amount": weight.amount, "direction_deg": direction.degrees() });
    let weights = engine.counterweights().iter().map(|each| {
        let mut of_it = weight(each, engine.direction(each));
        of_it["crank"] = json!(engine.crank_carrying(each).position());
        of_it
    });
    let shafts = engine.shafts().iter().enumerate();
    let shaft_weights = shafts.flat_map(|(k, shaft)| {
        let of_shaft = move |each| {
            let mut of_it = weight(each, each.angle);
            let [x, y] = shaft.axis;
            (of_it["shaft"], of_it["ratio"]) = (json!(k), json!(shaft.ratio));
            (of_it["x"], of_it["y"]) = (json!(x), json!(y));
            of_it
        };
        shaft.unbalances.iter().map(of_shaft)
    });
    // Banks that are parallel, or opposite, on cranks of their own are no vee.
    let is_on_one = (0..count).all(|i| engine.crank_of(i) == engine.crank_of(0));
    let is_vee = |angle: &f64| is_on_one || (0.0 < *angle && *angle < 180.0);
    let bank_angle = engine.banks().ok().map(|banks| banks.angle().degrees()).filter(is_vee);
    Ok(json!({
        "name": engine.shown_name(), "source": engine.source(), "cylinders": count,
        "strokes": engine.strokes().number(), "firing_order": engine.firing_order(), "firing": firing,
        "tdc_deg": degrees(stations.iter().map(|p| p.tdc)),
        "bank_deg": degrees(stations.iter().map(|p| p.bank)),
        "pin_deg": degrees((0..count).map(|i| engine.pin(i))),
        "z": stations.iter().map(|p| p.z).collect::<Vec<_>>(),
        "bank": (0..count).map(bank).collect::<Vec<_>>(),
        "bank_angle_deg": bank_angle,
        "cranks": cranks.collect::<Vec<_>>(), "mains": engine.bearings(CrankIndex::MAIN),
        "reference_z": engine.reference(None)?,
        "counterweights": engine.counterweights().len(), "shafts": engine.shafts().len(),
        "weights": weights.collect::<Vec<_>>(), "shaft_weights": shaft_weights.collect::<Vec<_>>(),
        "fired": engine.gas().is_some(), "mounted": powertrain.is_some(),
    }))
}

/// When the cylinders of an engine fire, in its own firing order.
pub fn firing_of(engine: &Engine) -> Result<Firing> {
    Firing::own(&Arc::new(engine.clone()), &Cancel::new())
}

fn fired(engine: &Engine) -> Result<Value> {
    let firing = firing_of(engine)?;
    let order: Vec<usize> = firing.fired().iter().map(|k| k + 1).collect();
    Ok(json!({
        "text": firing.to_string(), "order": order, "angles_deg": degrees(firing.angles()),
        "intervals_deg": degrees(firing.intervals().iter().copied()), "even": firing.even(),
        "unevenness_deg": firing.unevenness(),
    }))
}

/// Which orders of force, moment and torque vanish, with proof.
pub fn vanishing(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let engine = arguments.engine()?;
    let orders = match arguments.orders()? {
        Some(orders) => orders,
        None => (1..=HIGHEST_VANISHING).map(Order::whole).collect::<Result<_>>()?,
    };
    let reference = arguments.optional("reference_z")?;
    let found = of(&engine, &orders, reference, None, &Cancel::new())?;
    let by_order = found.orders.iter().enumerate().map(|(k, &n)| {
        let mut entry = Map::from_iter([("order".to_owned(), order(n))]);
        for quantity in QUANTITIES {
            let (verdict, rounded) =
                (found.verdicts[k][quantity], found.within_rounding[k][quantity]);
            let value = json!({ "verdict": word(verdict), "within_rounding": rounded });
            entry.insert(name(quantity).to_owned(), value);
        }
        Value::Object(entry)
    });
    Ok(json!({ "orders": by_order.collect::<Vec<_>>(), "obstacles": found.obstacles }))
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Vanishes => "vanishes",
        Verdict::Remains => "remains",
        Verdict::Undecided => "undecided",
    }
}

fn name(quantity: ProofQuantity) -> &'static str {
    match quantity {
        ProofQuantity::ForceX => "force.x",
        ProofQuantity::ForceY => "force.y",
        ProofQuantity::ForceForward => "force.forward",
        ProofQuantity::ForceBackward => "force.backward",
        ProofQuantity::MomentX => "moment.x",
        ProofQuantity::MomentY => "moment.y",
        ProofQuantity::MomentForward => "moment.forward",
        ProofQuantity::MomentBackward => "moment.backward",
        ProofQuantity::Torque => "torque",
        ProofQuantity::GasTorque => "torque.gas",
    }
}
