//! Counterweights and balance shafts that fit an engine.

use crankpin_core::balancing::counterweights::{Fit, Plane, Target, bays, fit_counterweights};
use crankpin_core::balancing::shafts::{Remove, ShaftRequest, fit};
use crankpin_core::balancing::weights::Minimise;
use crankpin_core::engine::CrankIndex;
use crankpin_core::engine::crankpins::Bay;
use crankpin_core::{Cancel, Result, SpeedRatio};
use serde_json::{Value, json};

use crate::answer::Columns;
use crate::arguments::Arguments;
use crate::engine::written;

/// The engine with the counterweights that remove the most of what turns with its crank at order 1.
pub fn counterweights(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let (engine, powertrain) = arguments.mounted()?;
    let words = [("squares", Minimise::Squares), ("largest", Minimise::Largest)];
    let minimise = arguments.word("minimise", &words)?;
    let on_main: Option<Vec<f64>> = arguments.optional("planes")?;
    let webs = |bay: &Bay| bay.webs().into_iter().map(|z| Plane { z, crank: bay.crank }).collect();
    let planes: Vec<Plane> = match &on_main {
        Some(places) => places.iter().map(|&z| Plane { z, crank: CrankIndex::MAIN }).collect(),
        None => bays(&engine).iter().flat_map::<Vec<Plane>, _>(webs).collect(),
    };
    let fit = Fit {
        planes: &planes,
        bounds: &vec![f64::INFINITY; planes.len()],
        angles: None,
        force: Target::All,
        moment: Target::All,
        length: None,
        minimise,
    };
    let fitted = fit_counterweights(&engine, &fit, &Cancel::new())?;
    let weights = fitted.list.iter().map(|one| one.unbalance);
    let all = engine.counterweights().iter().copied().chain(weights).collect();
    let mut answer = written(&engine.with_counterweights(all)?, powertrain.as_ref())?;
    answer["fit"] = json!({ "planes": planes.iter().map(|plane| plane.z).collect::<Vec<_>>(), "reached": fitted.exact, "missing": fitted.missing });
    Ok(answer)
}

/// The engine with balance shafts that remove their parts of orders.
pub fn balance_shafts(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let (engine, powertrain) = arguments.mounted()?;
    let words = [("both", Remove::Both), ("force", Remove::Force), ("moment", Remove::Moment)];
    let remove = arguments.word("remove", &words)?;
    let ratios: Vec<SpeedRatio> = arguments.required("ratios")?;
    let axes: [Vec<Option<f64>>; 2] =
        [arguments.or("x", Vec::new())?, arguments.or("y", Vec::new())?];
    let planes: Option<Vec<f64>> = arguments.optional("planes")?;
    let request = |(k, ratio): (usize, SpeedRatio)| {
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
