//! Warnings of implausible figures: in other units, or to the wrong side.

use crankpin_core::engine::warnings::{
    flywheel, near_miss, of_engine, of_gas, pin_split, piston_speed, radians,
};
use crankpin_core::mounts::warnings::of_powertrain;
use crankpin_core::pressure::warnings::of_cycle;
use crankpin_core::{Cancel, Result};
use serde_json::{Map, Value, json};

use crate::answer::Columns;
use crate::arguments::Arguments;

/// Warnings of an engine and of its body on mounts, at a speed and with a flywheel, and of angles as they were
/// typed.
pub fn warnings(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let (engine, powertrain) = arguments.mounted()?;
    let mut found = of_engine(&engine);
    if let Some(gas) = engine.gas() {
        found.extend(gas.cycles.iter().flat_map(|cycle| of_cycle(cycle)));
    }
    found.extend(of_gas(&engine, &Cancel::new())?);
    found.extend(powertrain.iter().flat_map(of_powertrain));
    if let Some(rpm) = arguments.optional("rpm")? {
        found.extend(piston_speed(engine.mean_piston_speed(rpm)));
    }
    if let Some(inertia) = arguments.optional("inertia")? {
        found.extend(flywheel(&engine, inertia));
    }
    if let Some(split) = arguments.angle("pin_split_deg")? {
        found.extend(pin_split(&engine, split));
    }
    let typed: Map<String, Value> = arguments.or("angles", Map::new())?;
    let listed = found.into_iter().map(|warning| (warning.argument.clone(), warning.text()));
    let listed = listed.chain(typed.iter().flat_map(|(name, texts)| of_angles(name, texts)));
    Ok(listed.map(|(argument, text)| json!({ "argument": argument, "message": text })).collect())
}

/// Of the texts of angles, in which decimals are numbers and fractions are meant.
fn of_angles(name: &str, texts: &Value) -> Vec<(String, String)> {
    let texts: Vec<&str> =
        texts.as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let mut decimals = texts.iter().filter(|text| text.contains('.') && !text.contains('/'));
    let numbers: Vec<f64> = decimals.clone().filter_map(|text| text.parse().ok()).collect();
    let question =
        |degrees| format!("{name}: was it given in radians? Angles are degrees here: {degrees}");
    let near = decimals.find_map(|text| near_miss(text));
    let found = radians(&numbers).map(question).into_iter().chain(near);
    found.map(|text| (name.to_owned(), text)).collect()
}
