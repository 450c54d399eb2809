//! Counterweights and balance shafts.

use crankpin_core::balancing;
use crankpin_core::balancing::shafts::{self, Remove};
use crankpin_core::balancing::weights::{self, Minimise};
use crankpin_core::{Complex64, Order};
use crankpin_macros::guarded;
use pyo3::prelude::*;

use crate::convert::OrRaise;
use crate::engine::{Engine, Weight, choice, weight};
use crate::interrupt;

/// Plane, place among its angles, and weight.
type PlacedWeight = (usize, usize, Weight);
/// Force and moment over ω².
type Pair = (Complex64, Complex64);
/// x and y of an axis, None where free.
type FreeAxis = (Option<f64>, Option<f64>);
/// Ratio, axis, places of the unbalances, and what to remove.
type WantedShaft = (i32, FreeAxis, Option<Vec<f64>>, String);
/// Axis, unbalances, force and moment.
type FittedShaft = ((f64, f64), Vec<Weight>, Pair);

/// Part of force and moment that turns with a shaft of this ratio, over ω².
#[guarded]
#[pyfunction]
pub fn turning(engine: &Bound<'_, Engine>, ratio: i32) -> PyResult<Pair> {
    let core = &engine.get().0;
    let work = |cancel: &_| balancing::turning(core, ratio, cancel);
    let found = interrupt::run(engine.py(), work)?;
    Ok((found.force, found.moment))
}

/// Roll torque of an order over ω², with that of gas pressure at a speed.
#[guarded]
#[pyfunction]
pub fn roll_torque(
    engine: &Bound<'_, Engine>,
    order: u32,
    rpm: Option<f64>,
) -> PyResult<Complex64> {
    let (core, order) = (&engine.get().0, Order::whole(order).or_raise()?);
    interrupt::run(engine.py(), |cancel| balancing::roll_torque(core, order, rpm, cancel))
}

/// Plane, place among its angles and weight of each, whether they are proved to exert what was wanted,
/// and the part of it that is missing.
#[guarded]
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
pub fn least_weights(
    py: Python<'_>,
    z: Vec<f64>,
    reference: f64,
    length: f64,
    force: Option<Complex64>,
    moment: Option<Complex64>,
    bounds: Vec<f64>,
    angles: Option<Vec<Vec<f64>>>,
    minimise: &str,
) -> PyResult<(Vec<PlacedWeight>, bool, f64)> {
    let words = [("squares", Minimise::Squares), ("largest", Minimise::Largest)];
    let minimise = choice("minimise", minimise, &words)?;
    let found = interrupt::run(py, |cancel| {
        let angles = angles.as_deref();
        let (z, bounds) = (z.as_slice(), bounds.as_slice());
        let request = weights::WeightRequest {
            z,
            reference,
            length,
            force,
            moment,
            bounds,
            angles,
            minimise,
        };
        weights::least(&request, cancel)
    })?;
    let each = found.list.iter().map(|one| {
        let unbalance = shafts::unbalance(one.vector, z[one.plane]).or_raise()?;
        Ok((one.plane, one.angle, weight(&unbalance)))
    });
    Ok((each.collect::<PyResult<_>>()?, found.reached, found.missing))
}

/// Shafts that remove their parts of orders, and the distance of places beyond reach, m.
#[guarded]
#[pyfunction]
pub fn fit_shafts(
    engine: &Bound<'_, Engine>,
    wanted: Vec<WantedShaft>,
    rpm: Option<f64>,
) -> PyResult<(Vec<FittedShaft>, Option<f64>)> {
    let words = [("both", Remove::Both), ("force", Remove::Force), ("moment", Remove::Moment)];
    let request = |(ratio, (x, y), planes, remove): WantedShaft| {
        let remove = choice("remove", &remove, &words)?;
        Ok(shafts::ShaftRequest { ratio, axis: [x, y], planes, remove })
    };
    let wanted = wanted.into_iter().map(request).collect::<PyResult<Vec<_>>>()?;
    let core = &engine.get().0;
    let (found, beyond) =
        interrupt::run(engine.py(), |cancel| shafts::fit(core, &wanted, rpm, cancel))?;
    let each = found.iter().map(|each| {
        let unbalances = each.shaft.unbalances.iter().map(weight).collect();
        (each.shaft.axis.into(), unbalances, (each.exerts.force, each.exerts.moment))
    });
    Ok((each.collect(), beyond))
}

/// Difference and sum of the places of a pair that cancels a roll torque, m, and its line, radians.
#[guarded]
#[pyfunction]
pub fn pair_heights(forward: Complex64, backward: Complex64, torque: Complex64) -> [f64; 3] {
    shafts::pair_heights(forward, backward, torque)
}

/// Forces at places as taken by two planes, by the lever rule.
#[guarded]
#[pyfunction]
pub fn shared(forces: Vec<(Complex64, f64)>, front: f64, rear: f64) -> [Complex64; 2] {
    balancing::shared(&forces, front, rear)
}
