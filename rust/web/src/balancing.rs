//! Counterweights and balance shafts that fit an engine.

use crankpin_core::balancing::shafts::{Remove, ShaftRequest, fit};
use crankpin_core::balancing::weights::{Fit, Minimise, Target, external};
use crankpin_core::engine::crankpins::Bay;
use crankpin_core::{Cancel, Result};
use serde_json::{Value, json};

use crate::answer::Columns;
use crate::arguments::Arguments;
use crate::engine::written;

/// The engine with the counterweights that remove the most of what turns with its crank at order 1.
pub fn counterweights(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let (engine, powertrain) = arguments.mounted()?;
    let words = [("squares", Minimise::Squares), ("largest", Minimise::Largest)];
    let minimise = arguments.word("minimise", &words)?;
    let webs = || engine.bays().iter().flat_map(Bay::webs).collect();
    let planes: Vec<f64> = arguments.optional("planes")?.unwrap_or_else(webs);
    let fit = Fit {
        z: &planes,
        bounds: &vec![f64::INFINITY; planes.len()],
        angles: None,
        force: Target::All,
        moment: Target::All,
        length: None,
        minimise,
    };
    let (weights, fitted) = external(&engine, &fit, &Cancel::new())?;
    let all = engine.counterweights().iter().copied().chain(weights).collect();
    let mut answer = written(&engine.with_counterweights(all)?, powertrain.as_ref())?;
    answer["fit"] =
        json!({ "planes": planes, "reached": fitted.reached, "missing": fitted.missing });
    Ok(answer)
}

/// The engine with balance shafts that remove their parts of orders.
pub fn balance_shafts(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let (engine, powertrain) = arguments.mounted()?;
    let words = [("both", Remove::Both), ("force", Remove::Force), ("moment", Remove::Moment)];
    let remove = arguments.word("remove", &words)?;
    let ratios: Vec<i32> = arguments.required("ratios")?;
    let axes: [Vec<Option<f64>>; 2] =
        [arguments.or("x", Vec::new())?, arguments.or("y", Vec::new())?];
    let planes: Option<Vec<f64>> = arguments.optional("planes")?;
    let request = |(k, ratio): (usize, i32)| {
        let axis = [0, 1].map(|along| axes[along].get(k).copied().flatten());
        ShaftRequest { ratio, axis, planes: planes.clone(), remove }
    };
    let wanted: Vec<ShaftRequest> = ratios.into_iter().enumerate().map(request).collect();
    let rpm = engine.gas().and(arguments.optional("rpm")?);
    let (fitted, beyond) = fit(&engine, &wanted, rpm, &Cancel::new())?;
    let shafts = fitted.into_iter().map(|each| each.shaft);
    let all = engine.shafts().iter().cloned().chain(shafts).collect();
    let mut answer = written(&engine.with_shafts(all)?, powertrain.as_ref())?;
    answer["fit"] = json!({ "beyond": beyond });
    Ok(answer)
}
