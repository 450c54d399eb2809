//! Warnings of implausible figures of engines: wrong units, and pins split to the wrong side.

use std::f64::consts::TAU;

use super::{Engine, FacePressure, Shaft, Unbalance};
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Result, Warning};
use crate::numbers::figure::significant;
use crate::numbers::rational::Ratio;
use crate::pressure::warnings::{absolute, work};

/// Crank radius, m, above which lengths are not in metres.
///
/// The longest stroke built is 3.46 m (MAN G95ME-C), a radius of 1.73 m.
const LARGEST_CRANK_RADIUS: f64 = 5.0;
/// Distance between neighbouring cylinders, in crank radii, above which it is not in metres.
///
/// Cars have 2 to 3, large two-strokes 1.3; a Formula 1 V10 of 40 mm stroke has less than 6.
const LARGEST_SPACING: f64 = 100.0;
/// Mass over the cube of the crank radius, kg/m³, above which masses are not in kilograms.
///
/// Cars have 4e3 to 2e4, large two-strokes 8e3, a Formula 1 V10 of 20 mm crank radius some 5e4. In
/// grams all but the largest engines are above 1e6.
const LARGEST_DENSITY: f64 = 1e6;
/// Unbalance, kg·m, above which it is not in these units, whatever the engine.
///
/// The largest first-order couples, of two-strokes, are 3 MN·m at 80 rpm: 5.3e3 kg·m at weights 8 m
/// apart.
const LARGEST_UNBALANCE: f64 = 7e3;
/// Moment of inertia over the fifth power of the crank radius, kg/m³, above which it is not kg·m².
///
/// Cars have 1e6, large two-strokes 1e5, a slow stationary engine with two flywheels (Lister CS) 1e7.
const LARGEST_FLYWHEEL: f64 = 1e9;
/// Rod length, m, up to which it is in metres: the longest built have 3.5 m.
const LONGEST_ROD: f64 = 5.0;
/// Rod lengths, in crank radii, that are rods of 2.5 to 10 in millimetres; longer ones stand for
/// rods without end.
const RODS_IN_MILLIMETRES: [f64; 2] = [1e3, 2e4];
/// Distance from the engine, in crank radii, beyond which a place is not in metres (car: 13 m).
const FARTHEST_IN_RADII: f64 = 300.0;
/// Bore over stroke, or stroke over bore, above which units differ; engines have 0.25 to 2.5.
const LARGEST_BORE: f64 = 10.0;
/// Mean piston speed, m/s, above which lengths are not in metres: the fastest engines have 30.
const FASTEST_PISTON: f64 = 60.0;
/// Most counterweights and shafts that are named at once.
const MOST_NAMED: usize = 4;
/// Denominators of the parts of a turn for which radians are recognised: angles of 2 to 24 throws
/// and firing intervals.
const PARTS_OF_A_TURN: u32 = 24;
/// Difference, degrees, from a part of a turn up to which radians are recognised: those typed to
/// three decimals are within 0.029°.
const ROUNDED_RADIANS: f64 = 0.03;
/// Fractions of more parts of a turn lie so close together that many angles are next to one.
const MOST_PARTS: i64 = 100;
/// Part of the interval of even firing up to which top dead centres are evenly spaced.
const EVEN: f64 = 5e-7;

const MILLIMETRES: &str = "was it given in millimetres?";
const GRAMS: &str = "was it given in grams?";
const GRAM_LENGTHS: &str = "was it given in g·mm or g·m?";

/// A warning of a value, in a unit, beside an engine's size.
fn beside(argument: &str, value: f64, unit: &str, engine: &Engine, hint: &'static str) -> Warning {
    let radius = figure(engine.largest_crank_radius());
    let value = figure(value);
    Warning::new(argument, format!("= {value} {unit} at a crank radius of {radius} m"), hint)
}

fn figure(value: f64) -> String {
    significant(value, 6)
}

/// Of an engine as a whole: its lengths, masses and what it carries.
#[must_use]
pub fn of_engine(engine: &Engine) -> Vec<Warning> {
    let mut found = Vec::new();
    for (station, details) in engine.stations().iter().zip(engine.details()) {
        let gear = &station.cylinder;
        found.extend(cylinder(gear.crank_radius(), gear.rod_length()));
        found.extend(details.bore.and_then(|diameter| bore(diameter, 2.0 * gear.crank_radius())));
    }
    found.extend(units(engine));
    let carried = engine.shafts().iter().flat_map(|shaft| &shaft.unbalances);
    let carried = engine.counterweights().iter().chain(carried);
    found.extend(carried.filter_map(|each| unbalance(each.amount)));
    found.extend(hardware(engine, engine.counterweights(), engine.shafts()));
    distinct(found)
}

/// Of the pressure in an engine's cylinders, beside its cycles alone: the crankcase's, work taken from the
/// crank, and pistons that share a chamber.
pub fn of_gas(engine: &Engine, cancel: &Cancel) -> Result<Vec<Warning>> {
    let Some(gas) = engine.gas() else { return Ok(Vec::new()) };
    let mut found: Vec<Warning> = absolute("crankcase", gas.crankcase).into_iter().collect();
    let (chambers, mut worked) = (engine.chambers(), Vec::new());
    for i in 0..engine.stations().len() {
        for FacePressure { cycle, face, .. } in engine.pressures(i) {
            let is_working = face == engine.working_face(i);
            let pistons = chambers.iter().find(|chamber| is_working && chamber.contains(&i));
            let acting = |&k: &usize| {
                let face = if is_working { engine.working_face(k) } else { face };
                let pressure = engine.pressures(k).into_iter().find(|on| on.face == face)?;
                let cylinder = &engine.stations()[k].cylinder;
                let FacePressure { index, delay, area, .. } = pressure;
                Some((index, cylinder, face, delay, area.abs() * cylinder.travel()))
            };
            let one: Vec<_> =
                pistons.map_or(&[i][..], Vec::as_slice).iter().filter_map(acting).collect();
            if worked.contains(&one) {
                continue;
            }
            // Of two pistons that lead each other one may take work that the other gives.
            let (mut done, mut swept) = (0.0, 0.0);
            for &(_, cylinder, face, delay, volume) in &one {
                done += volume * face.sign() * cycle.delayed(delay).imep(cylinder, cancel)?;
                swept += volume;
            }
            found.extend(work(&cycle, done / swept));
            worked.push(one);
        }
    }
    Ok(distinct(found))
}

fn distinct(found: Vec<Warning>) -> Vec<Warning> {
    let mut distinct: Vec<Warning> = Vec::new();
    for each in found {
        if !distinct.contains(&each) {
            distinct.push(each);
        }
    }
    distinct
}

/// Of a cylinder's lengths in millimetres.
#[must_use]
pub fn cylinder(radius: f64, rod_length: f64) -> Vec<Warning> {
    let mut found = Vec::new();
    if radius > LARGEST_CRANK_RADIUS {
        found.push(Warning::new("crank_radius", format!("= {} m", figure(radius)), MILLIMETRES));
    }
    let [low, high] = RODS_IN_MILLIMETRES;
    let ratio = rod_length / radius;
    if rod_length > LONGEST_ROD && low < ratio && ratio < high {
        let [rod, radius] = [rod_length, radius].map(figure);
        let fault = format!("= {rod} m at a crank radius of {radius} m");
        found.push(Warning::new("rod_length", fault, MILLIMETRES));
    }
    found
}

/// Of a bore and a stroke that are not in one unit.
#[must_use]
pub fn bore(diameter: f64, stroke: f64) -> Option<Warning> {
    let ratio = diameter / stroke;
    let differ = !(1.0 / LARGEST_BORE < ratio && ratio < LARGEST_BORE);
    let [diameter, stroke] = [diameter, stroke].map(figure);
    let fault = format!("= {diameter} m and stroke = {stroke} m");
    differ.then(|| Warning::new("bore", fault, "are both in metres?"))
}

/// Of places in millimetres and masses in grams.
#[must_use]
pub fn units(engine: &Engine) -> Vec<Warning> {
    let mut places: Vec<f64> = engine.stations().iter().map(|station| station.z).collect();
    places.sort_unstable_by(f64::total_cmp);
    let spacing = places.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let mut found = Vec::new();
    if spacing > LARGEST_SPACING * engine.largest_crank_radius() {
        let name = "z (or spacing, bank_stagger)";
        found.push(beside(name, spacing, "m apart", engine, MILLIMETRES));
    }
    let stations = || engine.stations().iter();
    let reciprocating = stations().map(|each| each.cylinder.reciprocating_mass());
    let rotating = stations().map(|each| each.rotating_mass);
    found.extend(mass(engine, "reciprocating_mass", reciprocating.fold(0.0, f64::max)));
    found.extend(mass(engine, "rotating_mass", rotating.fold(0.0, f64::max)));
    found
}

/// Of the mass of a part of one cylinder in grams, kg.
#[must_use]
pub fn mass(engine: &Engine, argument: &str, mass: f64) -> Option<Warning> {
    let heavy = mass > LARGEST_DENSITY * engine.largest_crank_radius().powi(3);
    heavy.then(|| beside(argument, mass, "kg", engine, GRAMS))
}

/// Of an unbalance that no engine has, kg·m.
#[must_use]
pub fn unbalance(amount: f64) -> Option<Warning> {
    let fault = || format!("= {} kg·m", figure(amount));
    (amount > LARGEST_UNBALANCE).then(|| Warning::new("amount", fault(), GRAM_LENGTHS))
}

/// Of an unbalance that is too large for an engine, kg·m.
#[must_use]
pub fn amount(engine: &Engine, argument: &str, amount: f64) -> Option<Warning> {
    let heavy = amount > LARGEST_DENSITY * engine.largest_crank_radius().powi(4);
    heavy.then(|| beside(argument, amount, "kg·m", engine, GRAM_LENGTHS))
}

/// Of counterweights and balance shafts whose amounts or places are in other units, beside an engine;
/// [`unbalance`] is of those that no engine has.
#[must_use]
pub fn hardware(engine: &Engine, weights: &[Unbalance], shafts: &[Shaft]) -> Vec<Warning> {
    let carried = || weights.iter().chain(shafts.iter().flat_map(|shaft| &shaft.unbalances));
    let largest = carried().map(|each| each.amount).fold(0.0, f64::max);
    let heavy = unbalance(largest).is_none().then(|| amount(engine, "amount", largest));
    let mut found: Vec<Warning> = heavy.flatten().into_iter().collect();
    found.extend(carried().filter_map(|each| place(engine, "z", each.z, engine.middle())));
    for [x, y] in shafts.iter().map(|shaft| shaft.axis) {
        found.extend(
            [("x", x), ("y", y)].into_iter().filter_map(|(name, at)| place(engine, name, at, 0.0)),
        );
    }
    let mut found = distinct(found);
    found.truncate(MOST_NAMED);
    found
}

/// Of a place farther from a middle, along the crank or beside it, than any engine reaches, m.
#[must_use]
pub fn place(engine: &Engine, argument: &str, at: f64, middle: f64) -> Option<Warning> {
    let distance = (at - middle).abs() - engine.length();
    let far =
        FARTHEST_IN_RADII * engine.largest_crank_radius() < distance && distance < f64::INFINITY;
    far.then(|| beside(argument, at, "m", engine, MILLIMETRES))
}

/// Of a piston that would be faster than in any engine, at a speed of the main crank.
#[must_use]
pub fn piston_speed(speed: f64) -> Option<Warning> {
    let is_fast = FASTEST_PISTON < speed && speed < f64::INFINITY;
    let fault = || format!("is {speed:.0} m/s, more than any engine's ({FASTEST_PISTON:.0})");
    let hint = "were lengths given in millimetres? They are metres here, and masses kilograms.";
    is_fast.then(|| Warning::new("rpm", fault(), hint).about("mean piston speed".into()))
}

/// Of a moment of inertia that no flywheel of an engine has, kg·m².
#[must_use]
pub fn flywheel(engine: &Engine, inertia: f64) -> Option<Warning> {
    let heavy = inertia > LARGEST_FLYWHEEL * engine.largest_crank_radius().powi(5);
    let hint = "was it given in kg·cm² or g·m²?";
    heavy.then(|| beside("inertia", inertia, "kg·m²", engine, hint))
}

/// Of pins split to the wrong side, in a vee: even firing needs the opposite sign.
#[must_use]
pub fn pin_split(engine: &Engine, split: Angle) -> Option<Warning> {
    let degrees = split.degrees();
    let tdc: Vec<f64> = engine.stations().iter().map(|station| station.tdc.degrees()).collect();
    if degrees.rem_euclid(180.0) == 0.0 || fires_evenly(&tdc) {
        return None;
    }
    let banks = engine.stations().iter().map(|station| station.bank.degrees());
    let left = banks.clone().fold(f64::NEG_INFINITY, f64::max); // of an upright vee
    // With the opposite split the left pins are 2·split further back, their TDCs as much later.
    let later = |(tdc, bank): (&f64, f64)| if bank == left { tdc + 2.0 * degrees } else { *tdc };
    let other: Vec<f64> = tdc.iter().zip(banks).map(later).collect();
    let fault = || {
        let [split, opposite] = [degrees, -degrees].map(figure);
        format!(
            "= {split}: this engine fires unevenly; with pin_split_deg = {opposite} it would fire evenly"
        )
    };
    let hint = "the split is left pin minus right pin in the direction of rotation, bank angle minus \
                firing interval";
    fires_evenly(&other).then(|| Warning::new("pin_split_deg", fault(), hint))
}

/// Whether an even number of four-stroke cylinders with these TDCs, degrees, can fire evenly.
fn fires_evenly(tdc: &[f64]) -> bool {
    let half = tdc.len() / 2;
    let interval = 360.0 / half as f64;
    let place = |angle: &f64| (angle - tdc[0]).rem_euclid(360.0) / interval;
    let mut count = vec![0; half];
    for place in tdc.iter().map(place) {
        if (place - place.round()).abs() > EVEN || half == 0 {
            return false;
        }
        count[place.round() as usize % half] += 1;
    }
    // Two cylinders, a turn apart, have each of `half` equally spaced top dead centres.
    count.iter().all(|&cylinders| cylinders == 2)
}

/// The degrees, such as `120°, 240°`, of angles that are parts of a turn in radians; none of others.
#[must_use]
pub fn radians(angles: &[f64]) -> Option<String> {
    let turning = || angles.iter().filter(|&&angle| angle != 0.0);
    let all = turning().next().is_some() && turning().all(|&angle| is_radians(angle));
    let degrees = |angle: &f64| format!("{}°", figure(angle.to_degrees()));
    all.then(|| turning().take(MOST_NAMED).map(degrees).collect::<Vec<_>>().join(", "))
}

fn is_radians(angle: f64) -> bool {
    let turns = angle.abs() / TAU;
    let is_part = |count: u32| {
        let parts = turns * f64::from(count);
        let off = (parts - parts.round()).abs() * 360.0;
        off < ROUNDED_RADIANS * f64::from(count) && parts.round() != 0.0
    };
    0.0 < turns && turns <= 1.0 + 1e-9 && (1..=PARTS_OF_A_TURN).any(is_part)
}

/// An angle beside a part of a turn that no decimal is: `51.428571 is 4.3e-7° from 360/7`.
#[must_use]
pub fn near_miss(degrees: &str) -> Option<String> {
    let angle: Angle = degrees.parse().ok()?;
    // A double within rounding of the fraction is taken as it.
    Angle::from_degrees(degrees.parse().ok()?).ok()?.near_miss()?;
    let (simple, distance) = angle.near_miss()?;
    let (turns, parts) = simple.turns().filter(|(_, parts)| *parts <= MOST_PARTS)?;
    // A decimal can be typed as it is: only others are rounded.
    if simple.is_decimal() {
        return None;
    }
    let simple = Ratio::new(360 * i128::from(turns), parts.into());
    Some(format!("{degrees} is {distance:.1e}° from {simple}"))
}
