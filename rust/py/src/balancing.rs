//! Counterweights and balance shafts.

use crankpin_core::balancing::counterweights::{self, Keep, Plane, Target};
use crankpin_core::balancing::shafts::{self, Remove};
use crankpin_core::balancing::weights::Minimise;
use crankpin_core::balancing::{self, Appearing, bob_weight, card};
use crankpin_core::engine::CrankIndex;
use crankpin_core::index::ListIndex;
use crankpin_core::{Complex64, Order};
use crankpin_macros::guarded;
use ndarray::Array1;
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::array::frozen;
use crate::balance::vector;
use crate::convert::{OrRaise, OrderNumber, Parts, RatioNumber, cylinder, number, orders, ratio};
use crate::engine::{Engine, Weight, choice, weight};
use crate::interrupt;

/// Plane, place among its angles, and weight.
type PlacedWeight = (usize, usize, Weight);
/// Figures by factor.
type Column<'py> = Bound<'py, PyArray1<f64>>;
/// Force and moment over ω².
type Pair = (Complex64, Complex64);
/// x and y of an axis, None where free.
type FreeAxis = (Option<f64>, Option<f64>);
/// Ratio, axis, places of the unbalances, and what to remove.
type WantedShaft = (RatioNumber, FreeAxis, Option<Vec<f64>>, String);
/// Axis, unbalances, force and moment.
type FittedShaft = ((f64, f64), Vec<Weight>, Pair);

/// Part of force and moment that turns with a shaft of this ratio, over ω².
#[guarded]
#[pyfunction]
pub fn turning(engine: &Bound<'_, Engine>, speed: RatioNumber) -> PyResult<Pair> {
    let ratio = ratio(speed)?;
    let core = &engine.get().0;
    let work = |cancel: &_| balancing::turning(core, ratio, cancel);
    let found = interrupt::run(engine.py(), work)?;
    Ok((found.force, found.moment))
}

/// What each bay exerts on its main bearings of what turns with its crank, over ω².
#[guarded]
#[pyfunction]
pub fn bay_loads(engine: &Bound<'_, Engine>) -> PyResult<Vec<Pair>> {
    let core = &engine.get().0;
    let found = interrupt::run(engine.py(), |cancel| counterweights::bay_loads(core, cancel))?;
    Ok(found.iter().map(|part| (part.force, part.moment)).collect())
}

/// Orders, and quantities of them, that vanish in an engine and not in the same with other hardware.
#[guarded]
#[pyfunction]
pub fn appearing(
    before: &Bound<'_, Engine>,
    after: &Engine,
) -> PyResult<Vec<(OrderNumber, &'static str)>> {
    let (core, after) = (&before.get().0, &after.0);
    let found = interrupt::run(before.py(), |cancel| balancing::appearing(core, after, cancel))?;
    let named = |(order, kind): (Order, Appearing)| {
        let name = match kind {
            Appearing::Force => "force",
            Appearing::Moment => "moment",
            Appearing::Roll => "torque",
        };
        (number(order), name)
    };
    Ok(found.into_iter().map(named).collect())
}

/// Roll torque of an order over ω², with that of gas pressure at a speed.
#[guarded]
#[pyfunction]
pub fn roll_torque(
    engine: &Bound<'_, Engine>,
    order: OrderNumber,
    rpm: Option<f64>,
) -> PyResult<Complex64> {
    let (core, order) = (&engine.get().0, orders(&[order])?[0]);
    interrupt::run(engine.py(), |cancel| balancing::roll_torque(core, order, rpm, cancel))
}

/// Weights that remove the most of what an engine, each of its bays or each half of its cranks exerts at
/// order 1: plane, place among its angles and weight of each, whether they are proved to exert what was
/// wanted, and the part of it that is missing.
///
/// `planes` are places and indices of cranks. `parts` are the names of what matters, each with the share of
/// the reciprocating mass to balance, none for all; `keep` those of sums that weights of bays must not
/// change, none for those that vanish.
#[guarded]
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "those of crankpin.counterweights")]
pub fn fit_weights(
    engine: &Bound<'_, Engine>,
    planes: Vec<(f64, usize)>,
    bounds: Vec<f64>,
    angles: Option<Vec<Vec<f64>>>,
    parts: Vec<(String, Option<f64>)>,
    length: Option<f64>,
    minimise: &str,
    target: &str,
    keep: Option<Vec<String>>,
) -> PyResult<(Vec<PlacedWeight>, bool, f64)> {
    let words = [("squares", Minimise::Squares), ("largest", Minimise::Largest)];
    let minimise = choice("minimise", minimise, &words)?;
    let part_of = |name: &str| match parts.iter().find(|(part, _)| part == name) {
        None => Target::Ignored,
        Some((_, None)) => Target::All,
        Some((_, Some(factor))) => Target::Share(*factor),
    };
    let (force, moment) = (part_of("force"), part_of("moment"));
    let keep = keep.map_or(Keep::Vanishing, |names| {
        Keep::Named(["force", "moment"].map(|name| names.iter().any(|kept| kept == name)))
    });
    let planes = read_planes(planes);
    let core = &engine.get().0;
    let found = interrupt::run(engine.py(), |cancel| {
        let (planes, bounds, angles) = (planes.as_slice(), bounds.as_slice(), angles.as_deref());
        let fit = counterweights::Fit { planes, bounds, angles, force, moment, length, minimise };
        let bays = match target {
            "external" => return counterweights::fit_counterweights(core, &fit, cancel),
            "internal" => counterweights::bays(core),
            _ => counterweights::half_cranks(core)?,
        };
        counterweights::internal(core, &fit, &bays, keep, cancel)
    })?;
    let each = found.list.iter().map(|one| (one.plane, one.angle, weight(&one.unbalance)));
    Ok((each.collect(), found.exact, found.missing))
}

fn read_planes(planes: Vec<(f64, usize)>) -> Vec<Plane> {
    planes.into_iter().map(|(z, crank)| Plane { z, crank: CrankIndex::new(crank) }).collect()
}

/// The engine with counterweights that balance a bob weight of this factor at each crankpin.
#[guarded]
#[pyfunction]
pub fn with_bob_weights(engine: &Engine, factor: f64) -> PyResult<Engine> {
    bob_weight::with_bob_weights(&engine.0, factor).or_raise().map(Engine::from)
}

/// Amount, kg·m, and direction, degrees, of the weight at a pin that removes the forward part of a cylinder's order 1.
#[guarded]
#[pyfunction]
pub fn forward_weight(py: Python<'_>, parts: Parts, rotating_mass: f64) -> PyResult<[f64; 2]> {
    let cylinder = cylinder(parts)?;
    interrupt::run(py, |cancel| bob_weight::forward_weight(&cylinder, rotating_mass, cancel))
}

/// Rotating and reciprocating mass on each crankpin, its bob weight, and what acts across it, from front to flywheel, kg.
#[guarded]
#[pyfunction]
pub fn masses_on_pins(engine: &Engine, factor: f64, oil: f64) -> Vec<[f64; 4]> {
    let masses = |pin: &card::PinMasses| {
        [pin.rotating, pin.reciprocating, pin.bob_weight(factor, oil), pin.across(factor)]
    };
    card::pins(&engine.0).iter().map(masses).collect()
}

/// Angles at which to add and to drill, mass at the radius and in heavy metal.
#[derive(IntoPyObject)]
struct Correction {
    plane: usize,
    amount: f64,
    add_at_deg: f64,
    drill_at_deg: f64,
    mass: Option<f64>,
    heavy_metal: Option<f64>,
}

/// Corrections in planes that balance a crankshaft to a factor.
#[guarded]
#[pyfunction]
pub fn corrections(
    engine: &Bound<'_, Engine>,
    factor: f64,
    planes: Vec<(f64, usize)>,
    radii: Option<Vec<f64>>,
    oil: f64,
    balanced_to: Option<Vec<f64>>,
) -> PyResult<Vec<Correction>> {
    let (core, planes) = (&engine.get().0, read_planes(planes));
    let found = interrupt::run(engine.py(), |cancel| {
        let (planes, radii) = (planes.as_slice(), radii.as_deref());
        let balanced_to = balanced_to.as_deref();
        let request = card::CorrectionRequest { planes, radii, oil, balanced_to };
        card::corrections(core, factor, &request, cancel)
    })?;
    let row = |each: &card::Correction| Correction {
        plane: each.plane,
        amount: each.unbalance.amount,
        add_at_deg: each.unbalance.angle.degrees(),
        drill_at_deg: each.drilled_at.degrees(),
        mass: each.mass,
        heavy_metal: each.heavy_metal,
    };
    Ok(found.iter().map(row).collect())
}

/// Force and moment of order 1 by balance factor.
#[pyclass(frozen, module = "crankpin._core")]
pub struct FirstOrder(bob_weight::FirstOrder);

#[guarded]
#[pymethods]
impl FirstOrder {
    #[new]
    fn new(engine: &Bound<'_, Engine>) -> PyResult<Self> {
        let core = &engine.get().0;
        let work = |cancel: &_| bob_weight::FirstOrder::new(core, cancel);
        interrupt::run(engine.py(), work).map(Self)
    }

    /// Whether it is not zero at every factor.
    fn exists(&self, quantity: &str) -> PyResult<bool> {
        Ok(self.0.exists(vector(quantity)?))
    }

    /// Longest and shortest half axis by factor.
    fn half_axes<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
        factors: Vec<f64>,
    ) -> PyResult<(Column<'py>, Column<'py>)> {
        let vector = vector(quantity)?;
        let axes: Vec<_> = factors.iter().map(|&k| self.0.half_axes(vector, k)).collect();
        let column = |k: usize| frozen(py, axes.iter().map(|each| each[k]).collect::<Array1<_>>());
        Ok((column(0)?, column(1)?))
    }

    /// Whether there is a roll torque about the axis of the main crank at some factor.
    fn has_roll(&self) -> bool {
        self.0.has_roll()
    }

    /// Roll torque by factor.
    fn roll<'py>(&self, py: Python<'py>, factors: Vec<f64>) -> PyResult<Column<'py>> {
        frozen(py, factors.iter().map(|&k| self.0.roll(k)).collect::<Array1<_>>())
    }

    /// Factor of the least longest vector.
    fn least(&self, quantity: &str) -> PyResult<Option<f64>> {
        Ok(self.0.least(vector(quantity)?))
    }

    /// Factors that leave a straight line, and its direction.
    fn straight(&self, quantity: &str) -> PyResult<Vec<(f64, f64)>> {
        Ok(self.0.straight(vector(quantity)?))
    }

    /// Direction of the longest half axis in words; `sides` is what is on the right and on the left.
    fn direction(&self, quantity: &str, factor: f64, sides: (String, String)) -> PyResult<String> {
        Ok(self.0.direction(vector(quantity)?, factor, [&sides.0, &sides.1]))
    }
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
    let request = |(speed, (x, y), planes, remove): WantedShaft| {
        let remove = choice("remove", &remove, &words)?;
        Ok(shafts::ShaftRequest { ratio: ratio(speed)?, axis: [x, y], planes, remove })
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
