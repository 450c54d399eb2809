//! What a picture of the turning engine is made of, as `save_html` of the library writes it.

use std::sync::Arc;

use crankpin_core::drawing::turning;
use crankpin_core::rows::RodRatios;
use crankpin_core::{Cancel, Result};
use serde_json::{Value, json};

use crate::answer::Columns;
use crate::arguments::Arguments;
use crate::words::{sentences_of, shown};

/// An engine's figures, what its reader may set, and the terms of each order: of the engine's own rod ratios, or of
/// all that a page reaches.
pub fn figures(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let engine = arguments.mounted()?.0;
    let rpm: f64 = arguments.required("rpm")?;
    crankpin_core::balance::angular_speed(rpm)?;
    let inertia: Option<f64> = arguments.optional("inertia")?;
    let ratios = arguments.or("rod_ratios", false)?.then(|| RodRatios::reached(&engine)).flatten();
    let loads = engine.loads_counted();
    let loads: String =
        loads.chars().take(1).flat_map(char::to_uppercase).chain(loads.chars().skip(1)).collect();
    let sentences = sentences_of(&engine, (rpm > 0.0).then_some(rpm), false, &shown(arguments)?)?;
    let cancel = Cancel::new();
    let engine = Arc::new(engine);
    let mut figures = turning(&engine, ratios, rpm, &cancel)?;
    let own = json!({
        "rpm": rpm, "loads": loads, "flywheel": inertia, "compact": false, "sentences": sentences,
    });
    if let (Value::Object(figures), Value::Object(own)) = (&mut figures, own) {
        figures.extend(own);
    }
    Ok(figures)
}
