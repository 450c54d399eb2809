//! Sentences about an engine.

use std::sync::Arc;

use crankpin_core::balance::Vector;
use crankpin_core::balancing::bob_weight::{FirstOrder, with_bob_weights};
use crankpin_core::balancing::card::pins;
use crankpin_core::explain::{Subject, Wording, explain as of};
use crankpin_core::{Cancel, Engine, Result};
use serde_json::{Map, Value, json};

use crate::answer::Columns;
use crate::arguments::Arguments;
use crate::engine::written;

/// How an engine shakes, what matters most first; at a speed, or relative to one piston.
pub fn explain(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let engine = arguments.mounted()?.0;
    let (rpm, vectors) = (arguments.optional("rpm")?, arguments.or("vectors", false)?);
    Ok(json!(sentences_of(&engine, rpm, vectors, &shown(arguments)?)?))
}

/// Units shown in place of others, and the factors of their numbers.
pub type Shown = Map<String, Value>;

pub fn shown(arguments: &mut Arguments) -> Result<Shown> {
    arguments.or("shown", Shown::new())
}

/// Sentences on an engine, or on its force and moment alone.
pub fn sentences_of(
    engine: &Engine,
    rpm: Option<f64>,
    vectors: bool,
    shown: &Shown,
) -> Result<Vec<String>> {
    let subject = if vectors { Subject::Vectors } else { Subject::Everything };
    let found = of(&Arc::new(engine.clone()), rpm, subject, &Cancel::new())?;
    let convert = |unit: &str| {
        let [to, factor] = shown.get(unit)?.as_array()?.as_slice() else { return None };
        let to = to.as_str().filter(|to| *to != unit)?;
        Some((to.to_owned(), factor.as_f64()?))
    };
    Ok(found.sentences(&found.findings, &Wording { convert: &convert, ..Wording::of(engine) }))
}

/// Masses on each crankpin, what order 1 keeps by balance factor, and the engine with counterweights opposite
/// its crankpins.
pub fn bob_weights(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let (engine, powertrain) = arguments.mounted()?;
    let factor = arguments.or("factor", 0.5)?;
    let first = FirstOrder::new(&engine, &Cancel::new())?;
    let pins = pins(&engine).into_iter().map(|on| {
        let cylinders: Vec<usize> = on.pin.cylinders.iter().map(|k| k + 1).collect();
        json!({
            "cylinders": cylinders, "z": on.pin.z, "rotating": on.rotating,
            "reciprocating": on.reciprocating, "bob_weight": on.bob_weight(factor, 0.0), "across": on.across(factor),
        })
    });
    let vectors = [("force", Vector::Force), ("moment", Vector::Moment)].map(|(name, vector)| {
        let entry = json!({
            "exists": first.exists(vector), "half_axes": first.half_axes(vector, factor),
            "least": first.least(vector), "straight": first.straight(vector),
            "direction_deg": first.direction_deg(vector, factor),
        });
        (name.to_owned(), entry)
    });
    let mut answer = written(&with_bob_weights(&engine, factor)?, powertrain.as_ref())?;
    answer["pins"] = pins.collect();
    answer["order_1"] = Value::Object(Map::from_iter(vectors));
    Ok(answer)
}
