//! Terms of an engine's orders and motions of its pistons, as pictures of it turning have them.

use serde::Serialize;

use super::figures::{
    GROUPS, GroupTerms, HIGHEST_LISTED, LoadRows, Sizes, group_terms, listed_orders, load_rows,
    mean_inertia, orders, sizes, speeds,
};
use super::rows::{
    FEWEST_ROD_RATIOS, OrderTable, PageRow, ROW_ROUNDING, RodRatios, Short, rows_of,
};
use crate::Complex64;
use crate::engine::Engine;
use crate::mechanism::articulated::RunningGear;
use crate::motion::CrankPosition;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::index::distinct;
use crate::numbers::order::Order;

/// Part of the largest that is rounding in pistons' motions, which are drawn; gas torque, a product with them, has nine digits.
const MOTION_ROUNDING: f64 = 1e-11;
/// Harmonics of a piston's velocity below this part of the largest are left out.
const LEAST_VELOCITY: f64 = MOTION_ROUNDING;
/// Harmonics of a piston's motion that are enough, but for rods hardly longer than their crank; at most so often
/// twice as many.
const MOTION_ORDERS: u32 = 48;
const MOST_MOTION_ORDERS: u32 = 768;

/// Power of q with which a harmonic of a piston begins.
fn power_of(harmonic: u32) -> u32 {
    harmonic.min(HIGHEST_LISTED).saturating_sub(1)
}

/// Terms of an engine's orders over the square of the crank's speed, as a page has them. Complex values are pairs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageTerms {
    /// Forward and backward parts of force and moment.
    planar: Vec<PageRow>,
    /// Roll torque, and with gas pressure or loads the moment of inertia of pistons and rods as seen from the crank;
    /// none of a spectrum.
    torque: Option<Vec<PageRow>>,
    /// What the cylinders make one by one.
    sizes: Sizes,
    /// Terms of periodic loads, which other factors of the speed multiply.
    loads: LoadRows,
    /// Orders whose phasors are listed.
    orders: Vec<Short>,
}

impl PageTerms {
    /// Those of an engine at its own settings, at all rod ratios that a page reaches or at its own alone; tables of
    /// loads must have the speed.
    pub fn new(
        engine: &Engine,
        ratios: Option<&RodRatios>,
        rpm: f64,
        cancel: &Cancel,
    ) -> Result<Self> {
        let is_given = engine.spectrum().is_some();
        let widest = ratios.map(|ratios| engine.at_rod_ratio(ratios.most)).transpose()?;
        let orders = orders(widest.as_ref().unwrap_or(engine), cancel)?;
        let is_driven = (has_pressure(engine) || !engine.loads().is_empty()) && !is_given;
        let sample = |engine: &Engine| {
            let tables = tables(engine, true, &orders, is_driven, cancel);
            let mut tables = tables?;
            if is_driven {
                let mut mean = [0.0; 4 * GROUPS].to_vec();
                mean[2] = mean_inertia(engine, cancel)?;
                tables[1].orders.insert(0, (0.0, 0, mean));
            }
            Ok(tables)
        };
        let fewest = if is_given { 1 } else { FEWEST_ROD_RATIOS };
        let mut rows = rows_of(engine, ratios, fewest, &sample)?.into_iter();
        let mut standing = tables(engine, false, &orders, is_driven, cancel)?.into_iter();
        let mut table = || -> Option<Vec<PageRow>> {
            let mut rows = rows.next()?;
            rows.extend(standing.next()?.still());
            Some(rows)
        };
        Ok(Self {
            planar: table().unwrap_or_default(),
            torque: table(),
            sizes: sizes(engine, cancel)?,
            loads: load_rows(engine, rpm, !is_given, cancel)?,
            orders: listed_orders(engine)?.iter().map(|order| Short(order.number())).collect(),
        })
    }
}

fn has_pressure(engine: &Engine) -> bool {
    (0..engine.stations().len()).any(|i| engine.has_pressure(i))
}

/// Terms of the cylinders, or of what no rod moves: of force and moment, and of torque unless a spectrum is given.
fn tables(
    engine: &Engine,
    of_cylinders: bool,
    orders: &[Order],
    is_driven: bool,
    cancel: &Cancel,
) -> Result<Vec<OrderTable>> {
    let is_given = engine.spectrum().is_some();
    let speeds = speeds(engine)?;
    // Harmonics of the fastest crank that has an order begin with the lowest power.
    let power = |order: &Order| {
        let harmonics = speeds.iter().filter(|speed| order.halves().is_multiple_of(speed.halves()));
        let least = harmonics.map(|speed| order.halves() / speed.halves()).min();
        if is_given { 0 } else { power_of(least.unwrap_or(order.halves() / 2)) }
    };
    let terms = group_terms(engine, of_cylinders, orders, !is_given, cancel)?;
    let table = |width: usize, less: u32, values: &dyn Fn(&GroupTerms) -> Vec<f64>| {
        let rows = orders.iter().zip(&terms).map(|(order, groups)| {
            let values = groups.iter().flat_map(values).collect();
            (order.number(), power(order).saturating_sub(less), values)
        });
        OrderTable { orders: rows.collect(), width, rounding: ROW_ROUNDING, relative: less == 0 }
    };
    let mut tables = vec![table(8, 0, &|terms| {
        terms.planar.iter().flat_map(|part| [part.re, part.im]).collect()
    })];
    if !is_given {
        let width = if is_driven { 4 } else { 2 };
        tables.push(table(width, 1, &|terms| {
            let parts = [terms.roll, terms.inertia];
            parts[..width / 2].iter().flat_map(|part| [part.re, part.im]).collect()
        }));
    }
    Ok(tables)
}

/// Motion of a piston over the angle past its top dead centre, in crank radii above the end of a rod that
/// stands along the bore.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionRows {
    /// Phasors of the height by order, of which 0 is the mean; with pressure also of the velocity, per radian.
    height: Vec<PageRow>,
    /// In place of order 0 the degrees at which the piston is highest and lowest, of order 1 its heights there.
    turning: Vec<PageRow>,
}

/// Lengths of a cylinder and what its rod hangs on, and whether pressure acts on its piston.
fn kind(engine: &Engine, cylinder: usize) -> (RunningGear, bool) {
    let gear = engine.running_gear(cylinder);
    let lengths = RunningGear { cylinder: gear.cylinder.without_masses(), ..gear };
    (lengths, engine.has_pressure(cylinder))
}

/// Cylinders whose pistons move in ways that differ, each by the index of its first cylinder, and of each cylinder
/// its place among them.
fn kinds(engine: &Engine) -> (Vec<usize>, Vec<usize>) {
    let kinds: Vec<_> = (0..engine.stations().len()).map(|i| kind(engine, i)).collect();
    let (_, kind_of) = distinct::<usize, _>(kinds.iter());
    let count = kind_of.iter().max().map_or(0, |last| last + 1);
    let first = |kind: usize| kind_of.iter().position(|&own| own == kind);
    ((0..count).filter_map(first).collect(), kind_of)
}

/// Motions of the pistons that differ, and of each cylinder the place of its own.
pub fn motions(
    engine: &Engine,
    ratios: Option<&RodRatios>,
    cancel: &Cancel,
) -> Result<(Vec<MotionRows>, Vec<usize>)> {
    let (kinds, kind_of) = kinds(engine);
    let widest = ratios.map(|ratios| engine.at_rod_ratio(ratios.most)).transpose()?;
    let motion = |cylinder: usize| {
        let of =
            widest.iter().chain([engine]).map(|engine| last_harmonic(engine, cylinder, cancel));
        let last = of.collect::<Result<Vec<_>>>()?.into_iter().max().unwrap_or(1);
        let orders: Vec<u32> = (1..=last).collect();
        let sample = |engine: &Engine| motion_tables(engine, cylinder, &orders, cancel);
        let mut rows = rows_of(engine, ratios, FEWEST_ROD_RATIOS, &sample)?.into_iter();
        let mut table = || rows.next().unwrap_or_default();
        Ok(MotionRows { height: table(), turning: table() })
    };
    Ok((kinds.into_iter().map(motion).collect::<Result<_>>()?, kind_of))
}

/// The last harmonic that a piston's velocity has.
fn last_harmonic(engine: &Engine, cylinder: usize, cancel: &Cancel) -> Result<u32> {
    let mut count = MOTION_ORDERS;
    loop {
        let orders: Vec<u32> = (1..=count).collect();
        let force = engine.mechanism(cylinder).force(&orders, cancel)?;
        let velocity = force.iter().zip(&orders).map(|(a, &n)| a.norm() / f64::from(n));
        let velocity: Vec<f64> = velocity.collect();
        let least = LEAST_VELOCITY * velocity.iter().copied().fold(0.0, f64::max);
        let last = velocity.iter().rposition(|&size| size > least).map_or(1, |k| k as u32 + 1);
        if 2 * last <= count || count == MOST_MOTION_ORDERS {
            return Ok(last);
        }
        count *= 2;
    }
}

fn motion_tables(
    engine: &Engine,
    cylinder: usize,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<Vec<OrderTable>> {
    let (mechanism, lengths) = (engine.mechanism(cylinder), engine.stations()[cylinder].cylinder);
    // The position of an infinite rod is that over the middle of the stroke.
    let rod = if lengths.has_infinite_rod() {
        0.0
    } else {
        lengths.rod_length() / lengths.crank_radius()
    };
    let height = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        mechanism.motion(&CrankPosition::new(sin, cos)).position - rod
    };
    let force = mechanism.force(orders, cancel)?;
    let width = if engine.has_pressure(cylinder) { 4 } else { 2 };
    let mut mean = height(0.0);
    let mut rows = Vec::new();
    for (&n, amplitude) in orders.iter().zip(force) {
        // The acceleration, of the other sign, integrated once and twice.
        let velocity = Complex64::i() * amplitude / f64::from(n);
        let height = amplitude / f64::from(n).powi(2);
        mean -= height.re;
        let values = [height.re, height.im, velocity.re, velocity.im];
        rows.push((f64::from(n), power_of(n), values[..width].to_vec()));
    }
    rows.insert(0, (0.0, 0, [mean, 0.0, 0.0, 0.0][..width].to_vec()));
    let turning = mechanism.turning_points_deg();
    let ends = [turning.to_vec(), turning.map(height).to_vec()].into_iter().zip([0.0, 1.0]);
    let ends = ends.map(|(values, place)| (place, 0, values)).collect();
    Ok(vec![
        OrderTable { orders: rows, width, rounding: MOTION_ROUNDING, relative: false },
        OrderTable { orders: ends, width: 2, rounding: ROW_ROUNDING, relative: true },
    ])
}
