//! Balance shafts: their unbalances, and places where they cancel roll torque.

use std::collections::BTreeSet;

use nalgebra::DMatrix;

use super::least_squares::least_squares;
use super::{TurningPart, VALUE_ROUNDING, half_length, weights};
use crate::Complex64;
use crate::engine::{CrankIndex, Engine, Shaft, Unbalance};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::readings::turning::over_square;

/// What a shaft is to remove of its part of an order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Remove {
    /// Force and moment.
    Both,
    /// The force, without making a moment about the reference plane.
    Force,
    /// The moment, without making a force.
    Moment,
}

/// A shaft that is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct ShaftRequest {
    /// Speed over crank speed.
    pub ratio: SpeedRatio,
    /// Axis, x and y from the crank axis, m; None where free.
    pub axis: [Option<f64>; 2],
    /// Places of its unbalances, m; None where free.
    pub planes: Option<Vec<f64>>,
    /// What it is to remove.
    pub remove: Remove,
}

/// A shaft, and what it exerts.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The shaft.
    pub shaft: Shaft,
    /// Its force and moment, over ω².
    pub exerts: TurningPart,
}

/// Rounding, relative to the engine's length, in the place of a single plane.
const PLACE_ROUNDING: f64 = 1e-12;
/// How far from the crank axis free axes may be placed, in lengths of the engine: whatever is the
/// larger of its length along the crank and that of a crank and a rod.
const FARTHEST_AXIS: f64 = 10.0;
/// Decimals of the angle of an unbalance, degrees: 1e-15 rad, less than its rounding error.
const DECIMALS: f64 = 1e13;

/// Shafts that remove their parts of orders, those of one ratio together with the least squares; free
/// axes where they cancel roll torque, as far as these are within reach of the engine. With the
/// distance, m, of the furthest place beyond that reach that would cancel more roll torque.
///
/// The roll torque of gas pressure is cancelled at a speed, which fired engines need.
pub fn fit(
    engine: &Engine,
    wanted: &[ShaftRequest],
    rpm: Option<f64>,
    cancel: &Cancel,
) -> Result<(Vec<Fitted>, Option<f64>)> {
    let reference = engine.reference(None)?;
    let mut found = vec![None; wanted.len()];
    let mut beyond: Option<f64> = None;
    let orders: BTreeSet<Order> =
        wanted.iter().map(|each| each.ratio.order()).collect::<Result<_>>()?;
    for order in orders {
        let exerted = over_square(engine, order, true, rpm, cancel)?;
        let torque = exerted.torque.roll;
        let mut free = Vec::new();
        for ratio in [true, false].map(|forward| SpeedRatio::at(order, forward)) {
            let same: Vec<usize> =
                (0..wanted.len()).filter(|&k| wanted[k].ratio == ratio).collect();
            let shafts: Vec<&ShaftRequest> = same.iter().map(|&k| &wanted[k]).collect();
            let part = TurningPart::of(&exerted, ratio);
            for (k, unbalances) in
                same.into_iter().zip(unbalances(engine, &part, &shafts, reference)?)
            {
                let each = fitted(ratio, unbalances, reference);
                free.push((k, ratio, each.exerts.force, wanted[k].axis));
                found[k] = Some(each);
            }
        }
        let shafts: Vec<_> =
            free.iter().map(|&(_, ratio, force, axis)| (ratio, force, axis)).collect();
        let (axes, further) = place(engine, torque, &shafts);
        for (&(k, ..), axis) in free.iter().zip(axes) {
            if let Some(each) = &mut found[k] {
                each.shaft.axis = axis;
            }
        }
        beyond = beyond.into_iter().chain(further).reduce(f64::max);
    }
    Ok((found.into_iter().flatten().collect(), beyond))
}

/// Axes of the shafts of an order, free coordinates where they cancel the roll torque that there is
/// without them or come closest to it; of several solutions the nearest to the crank axis, and none
/// beyond the reach of the engine. `shafts` are ratio, force over ω² and axis of each.
fn place(
    engine: &Engine,
    torque: Complex64,
    shafts: &[(SpeedRatio, Complex64, [Option<f64>; 2])],
) -> (Vec<[f64; 2]>, Option<f64>) {
    let mut axes: Vec<_> =
        shafts.iter().map(|(.., axis)| axis.map(Option::unwrap_or_default)).collect();
    let (mut rest, mut free) = (torque, Vec::new());
    for (k, &(ratio, force, axis)) in shafts.iter().enumerate() {
        for (j, per_metre) in roll_per_metre(ratio, force).into_iter().enumerate() {
            match axis[j] {
                Some(given) => rest += per_metre * given,
                None => free.push((k, j, per_metre)),
            }
        }
    }
    let parts = |row: usize, value: Complex64| if row == 0 { value.re } else { value.im };
    let rows = DMatrix::from_fn(2, free.len(), |row, j| parts(row, free[j].2));
    let target = DMatrix::from_fn(2, 1, |row, _| -parts(row, rest));
    let mut beyond: Option<f64> = None;
    for most in (0..=2).rev() {
        let places = least_squares(&rows, &target, most).solution;
        let furthest = places.amax();
        if furthest > FARTHEST_AXIS * size(engine) {
            beyond = beyond.or(Some(furthest));
            continue;
        }
        let rounding = VALUE_ROUNDING * furthest.max(size(engine));
        for (&(k, j, _), &place) in free.iter().zip(&places) {
            axes[k][j] = if place.abs() <= rounding { 0.0 } else { place };
        }
        break;
    }
    (axes, beyond)
}

/// Heights at which a pair of shafts with equal and opposite ratios cancels a roll torque: how much
/// higher the one that turns with the crank is than the other, the sum of the distances to the right
/// of the crank axis, m, and the direction of *up*, the line along which the pair pushes, radians.
#[must_use]
pub fn pair_heights(forward: Complex64, backward: Complex64, torque: Complex64) -> [f64; 3] {
    let up = (f64::midpoint(forward.arg(), backward.arg())).rem_euclid(std::f64::consts::PI);
    // With a = e^{i·up}(h − iw) the pair's torque is i·|F|·e^{iγ}·((h_B − h_A) − i(w_A + w_B)).
    let gamma = forward.arg() - up;
    let needed = -torque / Complex64::from_polar(forward.norm(), gamma);
    let zeroed =
        |value: f64| if value.abs() <= VALUE_ROUNDING * needed.norm() { 0.0 } else { value };
    [zeroed(-needed.im), zeroed(needed.re), up]
}

/// Roll torque's phasor for each metre of a shaft's axis along x and y: `x·F_y − y·F_x`.
fn roll_per_metre(ratio: SpeedRatio, force: Complex64) -> [Complex64; 2] {
    // The force's phasors along x and y.
    let i = Complex64::i();
    let [x, y] =
        if ratio.is_forward() { [force, -i * force] } else { [force.conj(), i * force.conj()] };
    [y, -x]
}

/// Unbalances of each of the shafts of one ratio, which share their task.
fn unbalances(
    engine: &Engine,
    exerted: &TurningPart,
    wanted: &[&ShaftRequest],
    reference: f64,
) -> Result<Vec<Vec<Unbalance>>> {
    let [ShaftRequest { ratio, remove, .. }, ..] = wanted else { return Ok(Vec::new()) };
    let of_shaft = |of_engine: Complex64| -of_engine / (ratio.number() * ratio.number());
    let none = Complex64::default();
    let target = TurningPart {
        force: if *remove == Remove::Moment { none } else { of_shaft(exerted.force) },
        moment: if *remove == Remove::Force { none } else { of_shaft(exerted.moment) },
    };
    let free = free_planes(engine, &target, reference);
    let planes: Vec<&[f64]> =
        wanted.iter().map(|each| each.planes.as_deref().unwrap_or(&free)).collect();
    let every = planes.concat();
    let length = half_length(engine);
    let (mut vectors, different) = weights::unbounded(&target, &every, reference, length);
    if *remove == Remove::Force && different < 2 {
        // From a single plane a force makes the moment that it makes.
        (vectors, _) = weights::unbounded(&target, &every, reference, f64::INFINITY);
    }
    let mut vectors = vectors.into_iter();
    planes
        .into_iter()
        .map(|z| {
            let here = z.iter().zip(vectors.by_ref()).filter(|(_, vector)| *vector != none);
            here.map(|(&z, vector)| unbalance(vector, z)).collect()
        })
        .collect()
}

/// The single plane in which an unbalance makes this force and moment, or the first and last cylinder.
fn free_planes(engine: &Engine, wanted: &TurningPart, reference: f64) -> Vec<f64> {
    let [first, last] = engine.ends();
    if last <= first {
        return vec![first];
    }
    if wanted.force != Complex64::default() {
        let lever = wanted.moment / (Complex64::i() * wanted.force);
        let z = reference + lever.re;
        if lever.im.abs() <= PLACE_ROUNDING * (last - first) && (first..=last).contains(&z) {
            return vec![z];
        }
    }
    vec![first, last]
}

/// A weight as an unbalance.
pub fn unbalance(vector: Complex64, z: f64) -> Result<Unbalance> {
    let degrees = ((vector.arg().to_degrees() * DECIMALS).round() / DECIMALS).rem_euclid(360.0);
    let angle = Angle::from_degrees(degrees)?;
    Ok(Unbalance { amount: vector.norm(), angle, z, pin: None, crank: CrankIndex::MAIN })
}

/// A shaft on the crank axis.
fn fitted(ratio: SpeedRatio, unbalances: Vec<Unbalance>, reference: f64) -> Fitted {
    let square = ratio.number() * ratio.number();
    let terms: Vec<TurningPart> = unbalances
        .iter()
        .map(|each| {
            let force = each.angle.cis(1) * (square * each.amount);
            TurningPart { force, moment: Complex64::i() * force * (each.z - reference) }
        })
        .collect();
    // Two opposite forces leave their rounding errors, not a force.
    let sum = |of: fn(&TurningPart) -> Complex64| {
        let (sum, size) =
            terms.iter().map(of).fold((Complex64::default(), 0.0), |(sum, size), term| {
                (sum + term, size + term.norm())
            });
        if sum.norm() <= VALUE_ROUNDING * size { Complex64::default() } else { sum }
    };
    let exerts = TurningPart { force: sum(|term| term.force), moment: sum(|term| term.moment) };
    let shaft = Shaft { name: String::new(), ratio, axis: [0.0; 2], unbalances };
    Fitted { shaft, exerts }
}

/// Length of an engine, m: along the crank or of a crank and its rod, whichever is the larger; of an
/// infinite rod the crank alone counts.
fn size(engine: &Engine) -> f64 {
    engine.distinct_cylinders().iter().map(Cylinder::reach).fold(engine.length(), f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Station;

    fn single() -> Engine {
        let cylinder = Cylinder::new(0.04, 0.14, 0.5, 0.0).unwrap();
        let bank = Angle::from_degrees(90.0).unwrap();
        let place = Station { cylinder, tdc: Angle::ZERO, bank, z: 0.0, rotating_mass: 0.0 };
        Engine::new("", "", vec![place]).unwrap()
    }

    #[test]
    fn forces_that_differ_by_rounding_place_no_shaft_far_away() {
        let torque = Complex64::new(1e-4, 2e-4);
        let force = Complex64::new(0.0, 3e-3);
        for rounding in [0.0, 1e-15, -1e-13, 1e-11] {
            let [one, other] = [(2, force, 0.08), (-2, force * (1.0 + rounding), -0.06)];
            let shafts = [one, other]
                .map(|(ratio, force, x)| (SpeedRatio::whole(ratio), force, [Some(x), None]));
            let (axes, beyond) = place(&single(), torque, &shafts);
            // Equal and opposite: the difference of heights is what counts.
            assert!((axes[0][1] + axes[1][1]).abs() < 1e-9 && axes[0][1].abs() < 0.05);
            assert!(beyond.is_none());
        }
        let (axes, beyond) =
            place(&single(), torque, &[(SpeedRatio::whole(2), force * 1e-6, [None, None])]);
        assert!(beyond.is_some_and(|distance| distance > 1e3));
        assert_eq!(axes, [[0.0, 0.0]]);
    }
}
