//! Common layouts of engines from a few figures, by their kind.

use std::sync::Arc;

use crankpin_core::engine::radial::Radial;
use crankpin_core::engine::{Crank, Details, EngineOnCrank, Hold};
use crankpin_core::layout::{
    FiringOrder, FiringRule, Inline, MultiBankLayout, Numbering, Side, Spacing, Strokes, Vee,
};
use crankpin_core::numbers::limits;
use crankpin_core::{Angle, Cancel, Cylinder, Engine, Error, Firing, Result, SpeedRatio};
use serde_json::Value;

use crate::answer::Columns;
use crate::arguments::Arguments;
use crate::engine::written;

#[derive(Clone, Copy)]
enum Kind {
    Inline,
    Vee,
    Flat,
    Boxer,
    MultiBankLayout,
    Radial,
    OpposedPistons,
    U,
    SquareFour,
    H,
    FiringOrder,
}

const KINDS: [(&str, Kind); 11] = [
    ("inline", Kind::Inline),
    ("vee", Kind::Vee),
    ("flat", Kind::Flat),
    ("boxer", Kind::Boxer),
    ("fan", Kind::MultiBankLayout),
    ("radial", Kind::Radial),
    ("opposed_pistons", Kind::OpposedPistons),
    ("u", Kind::U),
    ("square_four", Kind::SquareFour),
    ("h", Kind::H),
    ("firing_order", Kind::FiringOrder),
];

/// An engine of a kind, as the library's builders make it.
pub fn build(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let kind = arguments.word("kind", &KINDS)?;
    let (cylinder, details) = cylinder(arguments)?;
    let usual = if matches!(kind, Kind::OpposedPistons) { 2 } else { 4 };
    let strokes = Strokes::from_number(arguments.or("strokes", usual)?)?;
    let order: Option<String> = arguments.optional("firing_order")?;
    let mut intervals = None;
    let (engine, order) = match kind {
        Kind::Inline => (inline(arguments)?.engine(cylinder)?, order.unwrap_or_default()),
        Kind::Vee | Kind::Flat | Kind::Boxer => {
            (vee(arguments, kind)?.engine(cylinder)?, order.unwrap_or_default())
        }
        Kind::MultiBankLayout => (fan(arguments)?.engine(cylinder)?, order.unwrap_or_default()),
        Kind::Radial => {
            let radial = radial(arguments)?;
            let even = || radial.firing_order(strokes);
            (radial.engine(cylinder)?, order.unwrap_or_else(even))
        }
        Kind::OpposedPistons | Kind::U | Kind::SquareFour | Kind::H => {
            (doubled(arguments, kind, cylinder)?, order.unwrap_or_default())
        }
        Kind::FiringOrder => {
            let order = order.ok_or_else(|| Error::value("firing_order", "none", "is required"))?;
            intervals = arguments.angles("intervals_deg")?;
            (fired_so(arguments, cylinder, &order.parse()?, strokes, intervals.as_deref())?, order)
        }
    };
    let count = engine.stations().len();
    let engine = engine.with_details(vec![details; count])?;
    let name: String = arguments.or("name", String::new())?;
    let engine = engine.named(name, arguments.or("source", String::new())?)?;
    let fired = fired_as(engine, &order, strokes)?;
    let Some(intervals) = intervals else { return written(&fired, None) };
    // As they were typed, whatever turns would be more even.
    let (fired, cancel) = (Arc::new(fired), Cancel::new());
    let firing = Firing::at_intervals(&fired, &order.parse()?, strokes, &intervals, &cancel)?;
    written(&firing.kept(&cancel)?, None)
}

/// The engine with a firing order that its crank allows.
fn fired_as(engine: Engine, order: &str, strokes: Strokes) -> Result<Engine> {
    if order.is_empty() {
        return engine.firing_as("", strokes);
    }
    let engine = Arc::new(engine);
    let firing = Firing::named(&engine, &order.parse()?, strokes, &Cancel::new())?;
    engine.firing_as(firing.to_string(), strokes)
}

fn cylinder(arguments: &mut Arguments) -> Result<(Cylinder, Details)> {
    let stroke: f64 = arguments.required("stroke")?;
    let cylinder = Cylinder::from_stroke(
        stroke,
        arguments.required("rod_length")?,
        arguments.required("reciprocating_mass")?,
        arguments.or("pin_offset", 0.0)?,
    )?;
    Ok((cylinder, Details { bore: arguments.optional("bore")?, ..Details::default() }))
}

fn masses(arguments: &mut Arguments) -> Result<Vec<f64>> {
    Ok(arguments.numbers("rotating_mass")?.unwrap_or_default())
}

/// Distances of throws, one or a list.
fn spacing(arguments: &mut Arguments) -> Result<Option<Spacing>> {
    if arguments.by_name.get("spacing").is_some_and(Value::is_array) {
        return Ok(arguments.optional("spacing")?.map(Spacing::Each));
    }
    Ok(arguments.optional("spacing")?.map(Spacing::Even))
}

fn inline(arguments: &mut Arguments) -> Result<Inline> {
    Ok(Inline {
        throws: arguments.angles("throws_deg")?.unwrap_or_default(),
        spacing: spacing(arguments)?.unwrap_or(Spacing::Even(0.0)),
        rotating_mass: masses(arguments)?,
        first_tdc: arguments.angle("first_tdc_deg")?.unwrap_or(Angle::ZERO),
    })
}

fn vee(arguments: &mut Arguments, kind: Kind) -> Result<Vee> {
    let Inline { throws, spacing, rotating_mass, first_tdc } = inline(arguments)?;
    let (bank_angle, pin_split) = match kind {
        Kind::Flat => (Angle::HALF_TURN, Angle::ZERO),
        Kind::Boxer => (Angle::HALF_TURN, Angle::HALF_TURN),
        _ => {
            let angle = arguments.angle("bank_angle_deg")?;
            let none = || Error::value("bank_angle_deg", "none", "is required");
            (angle.ok_or_else(none)?, arguments.angle("pin_split_deg")?.unwrap_or(Angle::ZERO))
        }
    };
    Ok(Vee {
        bank_angle,
        throws,
        spacing,
        pin_split,
        bank_stagger: arguments.or("bank_stagger", 0.0)?,
        rotating_mass,
        numbering: arguments.word(
            "numbering",
            &[("alternating", Numbering::Alternating), ("by-bank", Numbering::ByBank)],
        )?,
        absent: arguments.or("absent", Vec::new())?,
        first_bank: arguments.word("odd_bank", &[("right", Side::Right), ("left", Side::Left)])?,
        first_tdc,
    })
}

fn fan(arguments: &mut Arguments) -> Result<MultiBankLayout> {
    Ok(MultiBankLayout {
        banks: arguments.angles("bank_deg")?.unwrap_or_default(),
        bank_stagger: arguments.or("bank_stagger", 0.0)?,
        along: inline(arguments)?,
    })
}

fn radial(arguments: &mut Arguments) -> Result<Radial> {
    Ok(Radial {
        cylinders: arguments.or("cylinders", 7)?,
        rows: arguments.or("rows", 1)?,
        spacing: spacing(arguments)?,
        rotating_mass: masses(arguments)?,
        first_tdc: arguments.angle("first_tdc_deg")?.unwrap_or(Angle::ZERO),
    })
}

/// An engine and one like it on a second crank as fast, whose firing is held.
fn doubled(arguments: &mut Arguments, kind: Kind, cylinder: Cylinder) -> Result<Engine> {
    let one = match kind {
        Kind::H => vee(arguments, Kind::Flat)?.engine(cylinder)?,
        Kind::SquareFour => {
            let throws = vec![Angle::ZERO, Angle::HALF_TURN];
            Inline { throws, ..inline(arguments)? }.engine(cylinder)?
        }
        _ => inline(arguments)?.engine(cylinder)?,
    };
    let distance = limits::length("distance", arguments.required("distance")?)?;
    let is_opposed = matches!(kind, Kind::OpposedPistons);
    let ratio = arguments.or("ratio", if is_opposed { 1 } else { -1 })?;
    if ![1, -1].contains(&ratio) {
        return Err(Error::value("ratio", ratio, "give 1, or -1 against the main crank"));
    }
    let is_aside = matches!(kind, Kind::U | Kind::SquareFour);
    let delay = match kind {
        Kind::OpposedPistons => -arguments.angle("lead_deg")?.unwrap_or(Angle::ZERO),
        Kind::SquareFour => Angle::HALF_TURN,
        _ => arguments.angle("phase_deg")?.unwrap_or(Angle::ZERO),
    };
    let on = |crank, delay, tilt| EngineOnCrank { engine: &one, crank, delay, tilt, z: 0.0 };
    let axis = if is_aside { [distance, 0.0] } else { [0.0, distance] };
    let second = Crank { axis, ratio: SpeedRatio::whole(ratio) };
    let tilt = if is_opposed { Angle::HALF_TURN } else { Angle::ZERO };
    let parts = [on(Crank::MAIN, Angle::ZERO, Angle::ZERO), on(second, delay, tilt)];
    Engine::on_cranks(&parts, Hold::Firing)
}

/// The engine that fires in an order: a vee with a bank angle, an inline engine without.
fn fired_so(
    arguments: &mut Arguments,
    cylinder: Cylinder,
    order: &FiringOrder,
    strokes: Strokes,
    intervals: Option<&[Angle]>,
) -> Result<Engine> {
    let rule = match intervals {
        Some(intervals) => FiringRule::Intervals(strokes, intervals.to_vec()),
        None => FiringRule::Even(strokes),
    };
    if arguments.has("bank_angle_deg") {
        order.vee(cylinder, &rule, &vee(arguments, Kind::FiringOrder)?)
    } else {
        order.inline(cylinder, &rule, &inline(arguments)?)
    }
}
