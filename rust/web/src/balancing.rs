//! Counterweights and balance shafts that fit an engine.

use crankpin_core::balance::Vector;
use crankpin_core::balancing::bob_weight::FirstOrder;
use crankpin_core::balancing::card::{Correction, CorrectionRequest, corrections, pins};
use crankpin_core::balancing::shafts::{Remove, ShaftRequest, fit};
use crankpin_core::balancing::weights::{Fit, Minimise, Target, external};
use crankpin_core::engine::crankpins::Bay;
use crankpin_core::{Cancel, Result};
use serde_json::{Map, Value, json};

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

/// The card of a balancing shop: bob weights of the crankpins, what order 1 keeps by factor, and corrections
/// in planes.
pub fn card(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let (engine, cancel) = (arguments.mounted()?.0, Cancel::new());
    let factors: Vec<f64> = arguments.or("factors", vec![0.5])?;
    let (oil, rpm): (f64, f64) = (arguments.or("oil", 0.0)?, arguments.or("rpm", 3000.0)?);
    let sides: [String; 2] = arguments.or("sides", ["right", "left"].map(str::to_owned))?;
    let [right, left] = &sides;
    let planes: Vec<f64> = arguments.or("planes", Vec::new())?;
    let radii: Option<Vec<f64>> = arguments.optional("radii")?;
    let balanced_to: Option<Vec<f64>> = arguments.optional("balanced_to")?;
    let first = FirstOrder::new(&engine, &cancel)?;
    let pins = pins(&engine).into_iter().map(|on| {
        let cylinders: Vec<usize> = on.pin.cylinders.iter().map(|k| k + 1).collect();
        let weights: Vec<f64> = factors.iter().map(|&factor| on.bob_weight(factor, oil)).collect();
        json!({
            "cylinders": cylinders, "pin_deg": on.pin.pin.degrees(), "z": on.pin.z,
            "rotating": on.rotating, "reciprocating": on.reciprocating, "bob_weight": weights,
        })
    });
    let pins: Vec<Value> = pins.collect();
    let mut residuals = Map::new();
    for (name, vector) in [("force", Vector::Force), ("moment", Vector::Moment)] {
        let by_factor = factors.iter().map(|&factor| {
            let [longest, shortest] = first.half_axes_at(vector, factor, rpm)?;
            let direction = first.direction(vector, factor, [right, left]);
            Ok(json!({ "longest": longest, "shortest": shortest, "direction": direction }))
        });
        residuals.insert(
            name.into(),
            json!({
                "exists": first.exists(vector), "least": first.least(vector),
                "straight": first.straight(vector),
                "by_factor": by_factor.collect::<Result<Vec<_>>>()?,
            }),
        );
    }
    let (radii, balanced_to) = (radii.as_deref(), balanced_to.as_deref());
    let request = CorrectionRequest { planes: &planes, radii, oil, balanced_to };
    let of_factor = |&factor: &f64| -> Result<Vec<Value>> {
        let found = corrections(&engine, factor, &request, &cancel)?;
        let row = |each: &Correction| {
            json!({
                "plane": each.plane, "amount": each.unbalance.amount,
                "add_at_deg": each.unbalance.angle.degrees(), "drill_at_deg": each.drilled_at.degrees(),
                "mass": each.mass, "heavy_metal": each.heavy_metal,
            })
        };
        Ok(found.iter().map(row).collect())
    };
    let corrections: Vec<Vec<Value>> = factors.iter().map(of_factor).collect::<Result<_>>()?;
    Ok(json!({
        "factors": factors, "pins": pins, "residuals": residuals, "corrections": corrections,
    }))
}
