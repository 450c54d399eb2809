//! Waveforms, sweeps, harmonics, and when an engine fires.

use std::sync::Arc;

use crankpin_core::balance::Request;
use crankpin_core::layout::Strokes;
use crankpin_core::pressure::example::{Example, ExampleKind};
use crankpin_core::quantity::Quantity;
use crankpin_core::sweep::{Statistic, Sweep, SweepAxes};
use crankpin_core::{Cancel, Error, Firing, Orders, Result, memory, waveform as waveforms};
use serde_json::{Map, Value, json};

use crate::answer::{Columns, degrees, orders as numbers};
use crate::arguments::Arguments;
use crate::balance::requested;
use crate::engine::{firing_of, written};

/// Force, moment and torques over crank angle, from exact kinematics or, of orders that are given, as their sum.
pub fn waveform(arguments: &mut Arguments, columns: &mut Columns) -> Result<Value> {
    let none = || Error::value("theta_deg", "none", "is required");
    let theta = arguments.numbers("theta_deg")?.ok_or_else(none)?;
    let summed = arguments.has("orders") || arguments.has("rtol");
    let engine = arguments.engine()?;
    let request = Request {
        rpm: arguments.required("rpm")?,
        reference_z: arguments.optional("reference_z")?,
        torque: arguments.or("torque", true)?,
    };
    let (orders, cancel) = (requested(arguments)?, Cancel::new());
    let found = if summed {
        waveforms::from_orders(&engine, &request, &theta, &orders, &cancel)?
    } else {
        waveforms::exact(&engine, &request, &theta, &cancel)?
    };
    let mut answer = Map::new();
    for (name, values) in [("force", &found.force), ("moment", &found.moment)] {
        let [x, y] = [0, 1].map(|axis| columns.column(values.column(axis).iter().copied()));
        answer.insert(name.into(), json!({ "x": x, "y": y }));
    }
    for (name, values) in [("torque", found.torque), ("crank_torque", found.crank_torque)] {
        if let Some(values) = values {
            answer.insert(name.into(), columns.column(values));
        }
    }
    for part in found.parts {
        if let Some([roll, crank]) = part.torque {
            answer.insert(format!("torque.{}", part.name), columns.column(roll));
            answer.insert(format!("crank_torque.{}", part.name), columns.column(crank));
        }
    }
    Ok(Value::Object(answer))
}

/// Harmonics of a piston's acceleration over m·r·ω², orders 1 to a number of them.
pub fn piston_harmonics(arguments: &mut Arguments, columns: &mut Columns) -> Result<Value> {
    let ratio: f64 = arguments.required("rod_ratio")?;
    // A crank of one metre: its rod is as many as the ratio goes into one.
    let mechanism = crankpin_core::mechanism::with_ratios(ratio, arguments.or("offset", 0.0)?)?;
    let count: u32 = arguments.required("count")?;
    let orders: Vec<u32> = (1..=count).collect();
    let found = mechanism.force(&orders, &Cancel::new())?;
    let (re, im) = (found.iter().map(|a| a.re), found.iter().map(|a| a.im));
    Ok(json!({ "re": columns.column(re), "im": columns.column(im) }))
}

const FIGURES: [(&str, Statistic); 6] = [
    ("length", Statistic::Length),
    ("amplitude", Statistic::Amplitude),
    ("sum", Statistic::Sum),
    ("length of sum", Statistic::LengthOfSum),
    ("zero bound", Statistic::ZeroBound),
    ("mean", Statistic::Mean),
];

fn swept(arguments: &mut Arguments, cancel: &Cancel) -> Result<Sweep> {
    let engine = Arc::new(arguments.engine()?);
    let (angles, hold) = (arguments.numbers("bank_angle_deg")?, arguments.hold()?);
    let none = || Error::value("rpm", "none", "is required");
    let axes = SweepAxes {
        bank_angle: angles.map(|angles| (angles, hold)),
        rod_ratio: arguments.numbers("rod_ratio")?,
        pin_offset: arguments.numbers("pin_offset")?,
        rpm: arguments.numbers("rpm")?.ok_or_else(none)?,
        map: None,
    };
    let reference = arguments.optional("reference_z")?;
    let orders = requested(arguments)?;
    // Of orders that are given torque costs nothing until it is read.
    let torque = matches!(orders, Orders::Given(_)) || arguments.or("torque", false)?;
    Sweep::new(vec![engine], axes, &orders, reference, torque, cancel)
}

fn values(
    sweep: &Sweep,
    quantity: Quantity,
    figure: Statistic,
    cancel: &Cancel,
) -> Result<Vec<f64>> {
    sweep.check_size(quantity, figure, size_of::<f64>())?;
    let mut out = memory::zeros(sweep.result_shape(quantity, figure).into_iter().product())?;
    sweep.write_peaks(quantity, figure, &mut out, cancel)?;
    Ok(out)
}

/// One quantity over bank angle, rod ratio, pin offset and speed.
pub fn sweep(arguments: &mut Arguments, columns: &mut Columns) -> Result<Value> {
    let quantity: String = arguments.or("quantity", "force".to_owned())?;
    let quantity = Quantity::parse(&quantity)?;
    let figure = arguments.word("figure", &FIGURES)?;
    let cancel = Cancel::new();
    let sweep = swept(arguments, &cancel)?;
    let values = values(&sweep, quantity, figure, &cancel)?;
    let bounds = sweep.error_bound().values();
    Ok(json!({
        "shape": sweep.result_shape(quantity, figure), "orders": numbers(sweep.orders()),
        "values": columns.column(values), "omitted": numbers(sweep.omitted()), "error_bound": bounds,
    }))
}

/// Peaks of force and moment over bank angle, a column for each order.
pub fn bank_angles(arguments: &mut Arguments, columns: &mut Columns) -> Result<Value> {
    let cancel = Cancel::new();
    let sweep = swept(arguments, &cancel)?;
    let count = sweep.orders().len();
    let mut answer = Map::new();
    for (name, quantity) in [("force", Quantity::FORCE), ("moment", Quantity::MOMENT)] {
        let values = values(&sweep, quantity, Statistic::Length, &cancel)?;
        let of_order = |k: usize| columns.column(values.iter().skip(k).step_by(count).copied());
        answer.insert(name.into(), (0..count).map(of_order).collect());
    }
    answer.insert("orders".into(), numbers(sweep.orders()).into());
    Ok(Value::Object(answer))
}

/// When the cylinders fire, in the engine's own firing order or another.
pub fn firing(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let engine = arguments.engine()?;
    let strokes = Strokes::from_number(arguments.or("strokes", engine.strokes().number())?)?;
    let firing = match arguments.optional::<String>("firing_order")? {
        Some(order) => Firing::named(&Arc::new(engine), &order.parse()?, strokes, &Cancel::new())?,
        None => firing_of(&engine)?,
    };
    let groups = firing.banks();
    let gaps = |gaps: &Vec<crankpin_core::firing::Gap>| -> Vec<Value> {
        let each = gaps.iter();
        each.map(|gap| json!({ "before": gap.before + 1, "after": gap.after + 1, "gap_deg": gap.gap.degrees() }))
            .collect()
    };
    let periods = firing.stroke_periods().into_iter().map(|(name, periods)| {
        let each: Vec<_> = periods.iter().map(|period| degrees(*period)).collect();
        (name.to_owned(), json!(each))
    });
    Ok(json!({
        "text": firing.to_string(), "order": firing.fired().iter().map(|k| k + 1).collect::<Vec<_>>(),
        "angles_deg": degrees(firing.angles()),
        "intervals_deg": degrees(firing.intervals().iter().copied()), "even": firing.even(),
        "unevenness_deg": firing.unevenness(), "gaps": firing.gaps(&groups).iter().map(gaps).collect::<Vec<_>>(),
        "strokes": periods.collect::<Map<_, _>>(),
    }))
}

/// The engine with an example cycle in all its cylinders, and the cycle's pressure.
pub fn with_cycle(arguments: &mut Arguments, columns: &mut Columns) -> Result<Value> {
    let (engine, powertrain) = arguments.mounted()?;
    let engine = engine.without_gas();
    let kind = arguments
        .word("kind", &[("petrol", ExampleKind::Petrol), ("diesel", ExampleKind::Diesel)])?;
    let (load, cancel) = (arguments.or("load", 1.0)?, Cancel::new());
    let cycle = Arc::new(Example::new(kind, load, engine.strokes(), &cancel)?.cycle(&cancel)?);
    let given = cycle.given();
    let (theta, pressure) = (
        columns.column(given.theta_deg.iter().copied()),
        columns.column(given.pressure.iter().copied()),
    );
    let firing = firing_of(&engine)?;
    let engine = engine.fired_by(cycle, firing.fires_in_second_turn())?;
    let mut answer = written(&engine, powertrain.as_ref())?;
    answer["theta_deg"] = theta;
    answer["pressure"] = pressure;
    Ok(answer)
}
