//! Least and largest loads over a cycle, at any crank angle.
//!
//! Between the angles at which pressure may jump or bend loads are smooth: there they are polynomials,
//! on panels that are halved until these are exact to rounding.

use std::array;

use ndarray::Array2;

use super::rod::DrivenRod;
use super::{BearingLoadsModel, Carried, scalars};
use crate::Complex64;
use crate::numbers::angle::cis_degrees;
use crate::numbers::cancel::Cancel;
use crate::numbers::chebyshev::{coefficient, jet, jets, largest_of_last, node, points};
use crate::numbers::error::Result;
use crate::numbers::{memory, pool};
use crate::pressure::chamber::NARROWEST;

/// Degree of the polynomials.
const LOAD_DEGREE: usize = 10;
/// Widest panel, degrees.
const WIDEST_PANEL: f64 = 10.0;
/// Part of the largest value that the last coefficients of a polynomial may have.
const LOAD_RESOLVED: f64 = 1e-13;
/// Part of its terms up to which a load is rounding: some ten operations, each of half a unit.
const LOAD_ROUNDING: f64 = 16.0 * f64::EPSILON;
/// A polynomial of the degree leaves the middle of its values at the points by no more than this times
/// half their range: 1 + (2/π) ln 11 (the Lebesgue constant), rounded up.
const OVERSHOOT: f64 = 3.0;

/// Values at the Chebyshev points of a panel.
type Values = [f64; LOAD_DEGREE + 1];

/// Least and largest loads over a cycle, N: (n, 2). Of vectors their magnitudes.
#[derive(Debug, Clone, PartialEq)]
pub struct Extremes {
    /// Of each rod on its crankpin.
    pub crankpin: Array2<f64>,
    /// Of each rod on its wrist pin.
    pub wrist_pin: Array2<f64>,
    /// Of the crank on each main bearing.
    pub main: Array2<f64>,
    /// Of all rods on each crankpin, those of [`Engine::crankpins`].
    ///
    /// [`Engine::crankpins`]: crate::Engine::crankpins
    pub whole_crankpin: Array2<f64>,
    /// Of each piston on its wall.
    pub side_thrust: Array2<f64>,
    /// Along each rod, compression above zero.
    pub rod: Array2<f64>,
    /// Of gas on each piston.
    pub gas: Array2<f64>,
}

/// A load, N, and the crank angle at which it is that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// N.
    pub value: f64,
    /// Degrees of a cycle.
    pub theta_deg: f64,
}

impl Peak {
    /// Replace the least and the largest by one that is beyond either, by more than rounding.
    fn meet([least, most]: &mut [Self; 2], one: Self, rounding: f64) {
        if one.value < least.value - rounding {
            *least = one;
        }
        if one.value > most.value + rounding {
            *most = one;
        }
    }
}

/// Part of a cycle on which some loads are polynomials.
struct Panel<const N: usize> {
    low: f64,
    high: f64,
    values: [Values; N],
}

impl<const N: usize> Panel<N> {
    /// Its ends and its middle.
    fn places(&self) -> [f64; 3] {
        [self.low, self.high, f64::midpoint(self.low, self.high)]
    }
}

/// Loads over a cycle, of a crank angle and one that is on the same side of all jumps.
struct LoadCurves<'a, F> {
    edges: &'a [f64],
    of: F,
    cancel: &'a Cancel,
}

impl<const N: usize, F: Fn(f64, f64) -> [f64; N]> LoadCurves<'_, F> {
    fn sample(&self, low: f64, high: f64) -> Panel<N> {
        let mut values = [[0.0; LOAD_DEGREE + 1]; N];
        for (k, theta) in points(low, high, LOAD_DEGREE).enumerate() {
            let of = (self.of)(theta, f64::midpoint(low, high));
            for (values, value) in values.iter_mut().zip(of) {
                values[k] = value;
            }
        }
        Panel { low, high, values }
    }

    /// Least and largest values at the ends and the middle of the widest panels.
    fn sampled(&self) -> Result<[[f64; 2]; N]> {
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; N];
        for pair in self.edges.windows(2) {
            self.cancel.check()?;
            let middle = f64::midpoint(pair[0], pair[1]);
            for theta in [pair[0], middle, pair[1]] {
                for (range, value) in ranges.iter_mut().zip((self.of)(theta, middle)) {
                    *range = widened(*range, &[value]);
                }
            }
        }
        Ok(ranges)
    }

    /// Visit panels, ascending, which are halved until they are narrow or need not be.
    fn visit(&self, mut is_settled: impl FnMut(&Panel<N>, bool) -> Result<bool>) -> Result<()> {
        let mut rest = Vec::new();
        for pair in self.edges.windows(2) {
            rest.push((pair[0], pair[1]));
            while let Some((low, high)) = rest.pop() {
                self.cancel.check()?;
                if !is_settled(&self.sample(low, high), high - low < NARROWEST)? {
                    let middle = f64::midpoint(low, high);
                    rest.extend([(middle, high), (low, middle)]);
                }
            }
        }
        Ok(())
    }

    /// Least and largest values, to within what is given.
    fn extremes(&self, mut ranges: [[f64; 2]; N], tolerances: &[f64; N]) -> Result<[[f64; 2]; N]> {
        self.visit(|panel, is_narrow| {
            let mut is_settled = true;
            for ((range, values), tolerance) in ranges.iter_mut().zip(&panel.values).zip(tolerances)
            {
                *range = widened(*range, values);
                let [low, high] = reach(values);
                if range[0] <= low && high <= range[1] {
                    continue;
                }
                if is_narrow || largest_of_last(values) <= *tolerance {
                    for [_, value] in turning_points(values) {
                        *range = widened(*range, &[value]);
                    }
                } else {
                    is_settled = false;
                }
            }
            Ok(is_settled)
        })?;
        Ok(ranges)
    }
}

fn widened([low, high]: [f64; 2], values: &[f64]) -> [f64; 2] {
    values.iter().fold([low, high], |[low, high], &value| [low.min(value), high.max(value)])
}

/// Least and largest value that a polynomial with these may have.
fn reach(values: &Values) -> [f64; 2] {
    let [low, high] = widened([f64::INFINITY, f64::NEG_INFINITY], values);
    let (middle, beyond) = (f64::midpoint(low, high), OVERSHOOT * 0.5 * (high - low));
    [middle - beyond, middle + beyond]
}

/// Larger magnitude of least and largest values.
fn largest([low, high]: [f64; 2]) -> f64 {
    low.abs().max(high.abs())
}

/// Places in [−1, 1], ascending, and values where a polynomial turns.
fn turning_points(values: &Values) -> impl Iterator<Item = [f64; 2]> {
    let coefficients: Values = array::from_fn(|n| coefficient(values, n));
    let places: Values = array::from_fn(|k| -node(k, LOAD_DEGREE));
    let [_, slopes, _] = jets(&coefficients, &places);
    (0..LOAD_DEGREE).filter(move |&k| slopes[k] * slopes[k + 1] < 0.0).map(move |k| {
        let (mut low, mut high) = (places[k], places[k + 1]);
        // The value has no slope there: 1e-9 off is right to rounding.
        for _ in 0..30 {
            let middle = f64::midpoint(low, high);
            let [_, slope, _] = jet(&coefficients, middle);
            *(if slope * slopes[k] > 0.0 { &mut low } else { &mut high }) = middle;
        }
        [low, jet(&coefficients, low)[0]]
    })
}

/// Loads of a rod: places in [`RodExtremes`].
#[derive(Clone, Copy)]
enum RodLoad {
    Crankpin,
    WristPin,
    SideThrust,
    Compression,
    Gas,
}

/// Values of each [`RodLoad`]: squared magnitudes of vectors.
type RodExtremes = [f64; 5];

fn of_rod(rod: &DrivenRod, theta: f64, beside: f64) -> RodExtremes {
    let forces = rod.forces_beside(theta, beside);
    let square = |[x, y]: [f64; 2]| x * x + y * y;
    let squares = [forces.crankpin, forces.wrist_pin].map(square);
    [squares[0], squares[1], forces.across, forces.compression, forces.gas]
}

/// Edges of panels over a cycle: those of the loads and some between them, degrees.
fn edges(of_loads: impl Iterator<Item = f64>, cycle: f64, cancel: &Cancel) -> Result<Vec<f64>> {
    let mut edges = Vec::new();
    for edge in of_loads {
        cancel.check()?;
        memory::push(&mut edges, edge.rem_euclid(cycle))?;
    }
    let steps = (cycle / WIDEST_PANEL).ceil() as usize;
    edges.extend((0..=steps).map(|k| cycle * (k as f64 / steps as f64)));
    edges.sort_unstable_by(f64::total_cmp);
    // Edges that only rounding parts are one.
    edges.dedup_by(|later, before| *later - *before <= 1e-12 * cycle);
    Ok(edges)
}

impl BearingLoadsModel {
    /// Least and largest loads over a cycle, degrees.
    pub fn extremes(&self, cycle_deg: u32, cancel: &Cancel) -> Result<Extremes> {
        let cycle = f64::from(cycle_deg);
        let rods = pool::map(cancel, self.rods.iter().collect(), |rod| {
            let edges = edges(rod.edges_deg().into_iter(), cycle, cancel)?;
            let of = |theta, beside| of_rod(rod, theta, beside);
            let curves = LoadCurves { edges: &edges, of, cancel };
            let sampled = curves.sampled()?;
            let [pin, wrist, ..] = sampled.map(|range| range[1].sqrt());
            let rounding = LOAD_ROUNDING * rod.terms(pin);
            let factors = [2.0 * pin, 2.0 * wrist, 1.0, 1.0, 1.0];
            let tolerances: RodExtremes = array::from_fn(|n| {
                (LOAD_RESOLVED * largest(sampled[n])).max(rounding * factors[n])
            });
            let mut found = curves.extremes(sampled, &tolerances)?;
            for squares in &mut found[..2] {
                *squares = squares.map(|square| square.max(0.0).sqrt());
            }
            Ok((found, rod.terms(pin)))
        })?;
        let terms: Vec<f64> = rods.iter().map(|(_, terms)| *terms).collect();
        let of_pins = |carried: Vec<Carried>| {
            pool::map(cancel, carried, |carried| {
                self.carried_extremes(&carried, &terms, cycle, cancel)
            })
        };
        let mains = of_pins((0..self.mains.len()).map(|main| self.carried(main)).collect())?;
        let whole = of_pins(self.pins.iter().map(|pin| self.on_pin(pin)).collect())?;
        let of_rods = |of: RodLoad| rows(rods.iter().map(|(ranges, _)| ranges[of as usize]));
        Ok(Extremes {
            crankpin: of_rods(RodLoad::Crankpin)?,
            wrist_pin: of_rods(RodLoad::WristPin)?,
            main: rows(mains.into_iter())?,
            whole_crankpin: rows(whole.into_iter())?,
            side_thrust: of_rods(RodLoad::SideThrust)?,
            rod: of_rods(RodLoad::Compression)?,
            gas: of_rods(RodLoad::Gas)?,
        })
    }

    /// Least and largest force of what is carried, by the size of each rod's terms.
    fn carried_extremes(
        &self,
        carried: &Carried,
        terms: &[f64],
        cycle: f64,
        cancel: &Cancel,
    ) -> Result<[f64; 2]> {
        let of_rods = carried.rods.iter().map(|&(share, i)| (share, &self.rods[i]));
        let of_rods: Vec<_> = of_rods.collect();
        let edges = edges(of_rods.iter().flat_map(|(_, rod)| rod.edges_deg()), cycle, cancel)?;
        let of = |theta: f64, beside: f64| {
            let wave = |(halves, wave): &(i32, Complex64)| {
                wave * cis_degrees(0.5 * f64::from(*halves) * theta)
            };
            let mut sum: Complex64 = carried.waves.iter().map(wave).sum();
            for (share, rod) in &of_rods {
                sum += rod.on_crankpin(&rod.forces_beside(theta, beside)) * *share;
            }
            let [x, y] = [sum.re, sum.im].map(|x| if x.abs() <= carried.bound { 0.0 } else { x });
            [x * x + y * y]
        };
        let curves = LoadCurves { edges: &edges, of, cancel };
        let sampled = curves.sampled()?;
        let force = sampled[0][1].sqrt();
        let terms = carried.rods.iter().map(|&(share, i)| share.abs() * terms[i]);
        let rounding = LOAD_ROUNDING
            * (terms.sum::<f64>() + carried.waves.iter().map(|(_, wave)| wave.norm()).sum::<f64>());
        let tolerance = (LOAD_RESOLVED * force * force).max(2.0 * force * rounding);
        let [squares] = curves.extremes(sampled, &[tolerance])?;
        Ok(squares.map(|square| square.max(0.0).sqrt()))
    }

    /// Ranges of crank angles in which each rod is in tension at its wrist pin, [from, to] in degrees
    /// of a cycle; [0, cycle] where it always is.
    pub fn tension(&self, cycle_deg: u32, cancel: &Cancel) -> Result<Vec<Vec<[f64; 2]>>> {
        pool::map(cancel, self.rods.iter().collect(), |rod| {
            let compression = |theta, beside| rod.forces_beside(theta, beside).compression;
            below_zero(rod, compression, f64::from(cycle_deg), cancel)
        })
    }
}

/// Ranges of crank angles in which a load of a rod is below zero, [from, to] in degrees of a cycle.
pub(super) fn below_zero(
    rod: &DrivenRod,
    of: impl Fn(f64, f64) -> f64,
    cycle: f64,
    cancel: &Cancel,
) -> Result<Vec<[f64; 2]>> {
    let edges = edges(rod.edges_deg().into_iter(), cycle, cancel)?;
    // Less than rounding is none.
    let rounding = rounding_of(rod, &edges, cancel)?;
    let curves = LoadCurves { edges: &edges, of: |theta, beside| [of(theta, beside)], cancel };
    let tolerance = (LOAD_RESOLVED * largest(curves.sampled()?[0])).max(rounding);
    let starts = (curves.of)(0.0, f64::midpoint(edges[0], edges[1]))[0] < -rounding;
    let (mut last, mut changes) = (starts, Vec::new());
    curves.visit(|panel, is_narrow| {
        let [low, high, middle] = panel.places();
        let [values] = &panel.values;
        let [least, most] = reach(values);
        let changes_sign = least < -rounding && most >= -rounding;
        if changes_sign && !is_narrow && largest_of_last(values) > tolerance {
            return Ok(false);
        }
        let turning = changes_sign.then(|| turning_points(values)).into_iter().flatten();
        let turning = turning.map(|[x, value]| (middle + 0.5 * x * (high - low), value));
        let mut all: Vec<_> = points(low, high, LOAD_DEGREE).zip(*values).chain(turning).collect();
        all.sort_unstable_by(|one, other| f64::total_cmp(&one.0, &other.0));
        let mut from = low;
        for (theta, value) in all {
            let here = value < -rounding;
            if here != last {
                let (mut before, mut after) = (from, theta);
                // Halving a panel so often reaches the last place of 720.
                for _ in 0..48 {
                    let between = f64::midpoint(before, after);
                    let same = ((curves.of)(between, middle)[0] < -rounding) == here;
                    *(if same { &mut after } else { &mut before }) = between;
                }
                memory::push(&mut changes, after)?;
            }
            (from, last) = (theta, here);
        }
        Ok(true)
    })?;
    if last != starts {
        changes.push(cycle);
    }
    if starts {
        // The range that is cut by the start of the cycle is counted from where it begins.
        let first = if changes.is_empty() { cycle } else { changes.remove(0) };
        let from = changes.pop().map_or(0.0, |from| from - cycle);
        changes.splice(0..0, [from, first]);
    }
    Ok(changes.chunks_exact(2).map(|ends| [ends[0], ends[1]]).collect())
}

/// Rounding of the loads of a rod, N.
fn rounding_of(rod: &DrivenRod, edges: &[f64], cancel: &Cancel) -> Result<f64> {
    let on_crankpin = |theta, beside| {
        let [x, y] = rod.forces_beside(theta, beside).crankpin;
        [x.hypot(y)]
    };
    let [[_, most]] = LoadCurves { edges, of: on_crankpin, cancel }.sampled()?;
    Ok(LOAD_ROUNDING * rod.terms(most))
}

/// Least and largest loads of a rod over a cycle, degrees, each with the crank angle: the first of equal ones.
pub(super) fn peaks<const N: usize>(
    rod: &DrivenRod,
    of: impl Fn(f64, f64) -> [f64; N],
    cycle: f64,
    cancel: &Cancel,
) -> Result<[[Peak; 2]; N]> {
    let edges = edges(rod.edges_deg().into_iter(), cycle, cancel)?;
    let rounding = rounding_of(rod, &edges, cancel)?;
    let curves = LoadCurves { edges: &edges, of, cancel };
    let tolerances = curves.sampled()?.map(|range| (LOAD_RESOLVED * largest(range)).max(rounding));
    let none = |value| Peak { value, theta_deg: 0.0 };
    let mut peaks = [[none(f64::INFINITY), none(f64::NEG_INFINITY)]; N];
    curves.visit(|panel, is_narrow| {
        let mut is_settled = true;
        let places: Vec<f64> = points(panel.low, panel.high, LOAD_DEGREE).collect();
        for ((peaks, values), tolerance) in peaks.iter_mut().zip(&panel.values).zip(tolerances) {
            for (&theta_deg, &value) in places.iter().zip(values) {
                Peak::meet(peaks, Peak { value, theta_deg }, tolerance);
            }
            let [low, high] = reach(values);
            let [least, most] = &peaks;
            if least.value <= low && high <= most.value {
                continue;
            }
            if is_narrow || largest_of_last(values) <= tolerance {
                for [x, value] in turning_points(values) {
                    let half = 0.5 * (panel.high - panel.low);
                    let theta_deg = f64::midpoint(panel.low, panel.high) + half * x;
                    Peak::meet(peaks, Peak { value, theta_deg }, tolerance);
                }
            } else {
                is_settled = false;
            }
        }
        Ok(is_settled)
    })?;
    Ok(peaks)
}

fn rows(ranges: impl ExactSizeIterator<Item = [f64; 2]>) -> Result<Array2<f64>> {
    let mut table = scalars(ranges.len(), 2)?;
    for (mut row, [low, high]) in table.outer_iter_mut().zip(ranges) {
        (row[0], row[1]) = (low, high);
    }
    Ok(table)
}
