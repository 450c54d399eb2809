//! Engines whose angles vary: objectives of their forces, moments and torques, with derivatives.
//!
//! Angles are linear in the variables, so that the phasor of each load is a constant times
//! `e^{i·rates·x}`. An objective is the largest of some sums of lengths of vectors that are linear in
//! the sums of these phasors. A length is not smooth at zero, nor is the largest where two are equal:
//! with μ > 0 they are replaced by √(u² + μ²) and μ·ln Σ exp(h/μ), which are, and tend to them with μ.

mod objective;

use self::objective::{ObjectiveFunction, Rotor, TurningPhasor, dot};
use crate::Complex64;
use crate::engine::Engine;
use crate::load::{
    Arithmetic, Factor, Load, LoadIndex, PhasorSum, Phasors, Scene, Term, Wanted, Weight, superpose,
};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::List;
use crate::numbers::limits;
use crate::numbers::order::{self, Order};
use crate::numbers::pool;
use crate::numbers::ratio::SpeedRatio;
use crate::readings::amplitude::{Amplitude, SourceAmplitudes};
use crate::source::{Repeats, Scaling};

/// Weight of each objective relative to the one before it. A length that can vanish stays at zero under
/// weights this small: its slope there is 1.
const NEXT_OBJECTIVE_WEIGHT: f64 = 1e-3;
/// Points evaluated in one task.
const STARTS_PER_TASK: usize = 16;

/// Quantity of an objective.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectiveQuantity {
    /// Shaking force.
    Force,
    /// Rocking moment.
    Moment,
    /// Roll torque on the block.
    Roll,
    /// Torque on the crank.
    Crank,
}

/// Figure of a quantity that is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectiveFigure {
    /// Longest vector, or largest torque.
    Peak,
    /// Larger of the peaks along (about) x and y.
    PeakXy,
    /// Part that turns with the crank.
    Forward,
    /// Part that turns against it.
    Backward,
}

/// Figure to minimise: of one order, or of all together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Objective {
    /// Quantity.
    pub quantity: ObjectiveQuantity,
    /// Figure of it; peaks alone of torques and of all orders together.
    pub reading: ObjectiveFigure,
    /// None for the total.
    pub order: Option<Order>,
}

/// Directions in which the angles of an engine vary, each by cylinder.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Turn of each bore per radian of the variable.
    pub bores: Vec<f64>,
    /// Turn of each crankpin.
    pub pins: Vec<f64>,
}

/// A value and its derivatives by the variables.
pub type Derived = (f64, Vec<f64>);

/// Arithmetic of loads that turn: a sum is a list of phasors.
struct VaryingPhasors<'a> {
    phasors: Phasors,
    /// Turns of the direction and of the crankpin of each load, by variable.
    turns: &'a List<LoadIndex, [Vec<f64>; 2]>,
}

impl Arithmetic for VaryingPhasors<'_> {
    type Unit = Rotor;
    type Sum = Vec<Rotor>;

    fn phase(&self, load @ (k, _): (LoadIndex, &Load), times: i64) -> Rotor {
        // At top dead centre the crankpin points along the bore.
        let [bores, pins] = &self.turns[k];
        let share = if load.1.parts.repeats == Repeats::EveryTwoTurns { 0.5 } else { 1.0 };
        let rates = bores.iter().zip(pins).map(|(bore, pin)| share * times as f64 * (bore - pin));
        Rotor { phasor: self.phasors.phase(load, times), rates: rates.collect() }
    }

    fn toward(&self, load @ (k, _): (LoadIndex, &Load), unit: &Rotor, conjugate: bool) -> Rotor {
        let sign = if conjugate { -1.0 } else { 1.0 };
        let turned = unit.rates.iter().zip(&self.turns[k][0]);
        Rotor {
            phasor: self.phasors.toward(load, &unit.phasor, conjugate),
            rates: turned.map(|(rate, bore)| rate + sign * bore).collect(),
        }
    }

    fn add(
        &self,
        sum: &mut Vec<Rotor>,
        load: (LoadIndex, &Load),
        weight: Weight,
        unit: &Rotor,
        times: Factor,
    ) {
        let mut one = PhasorSum::default();
        self.phasors.add(&mut one, load, weight, &unit.phasor, times);
        sum.push(Rotor { phasor: one.value, rates: unit.rates.clone() });
    }
}

/// Objectives of an engine whose angles vary, over the largest values that they could have; the later
/// ones with small weights.
#[derive(Debug, Clone)]
pub struct Objectives {
    functions: Vec<ObjectiveFunction>,
    /// Number of variables.
    variables: usize,
}

impl Objectives {
    /// Objectives of an engine, with all variables at 0 as it is given; totals are of `orders`. Balance
    /// shafts at the ratios of `removed` leave nothing of their part of force and moment.
    pub fn new(
        engine: &Engine,
        variables: &[Variable],
        objectives: &[Objective],
        orders: &[Order],
        removed: &[SpeedRatio],
        cancel: &Cancel,
    ) -> Result<Self> {
        let loads = Scene::of(engine, None)?;
        let count = engine.stations().len();
        let lists = variables.iter().flat_map(|each| [&each.bores, &each.pins]);
        for list in lists {
            limits::same_length("variables", list.len(), "the engine", count, "cylinder")?;
        }
        let turns = |of: &dyn Fn(&Variable) -> f64| variables.iter().map(of).collect::<Vec<f64>>();
        let of_cylinder = |i: usize| [turns(&|each| each.bores[i]), turns(&|each| each.pins[i])];
        let fixed = || [vec![0.0; variables.len()], vec![0.0; variables.len()]];
        let of_load =
            |load: &Load| engine.cylinder_with(load.place.origin).map_or_else(fixed, of_cylinder);
        let all_turns = loads.list.map_to(of_load);
        let arithmetic =
            VaryingPhasors { phasors: Phasors { reference: loads.reference }, turns: &all_turns };

        let all = orders_of(objectives, orders, &loads)?;
        let amplitudes = SourceAmplitudes::new(&loads.sources, true, &all, cancel)?;
        let wanted = Wanted { planar: true, roll: true, by_bank: false };
        let by_order: Vec<[Vec<TurningPhasor>; 4]> = all
            .iter()
            .enumerate()
            .map(|(k, &order)| {
                let terms = superpose(&arithmetic, &loads.list, order, wanted);
                quantities(&terms, order, removed, |term| amplitudes.of(term.harmonic, k))
            })
            .collect();
        let function = |objective: &Objective| {
            let counts =
                |order: &Order| objective.order.map_or(orders.contains(order), |own| own == *order);
            let counted = all.iter().zip(&by_order).filter(|(order, _)| counts(order));
            let parts = counted.flat_map(|(_, parts)| &parts[objective.quantity as usize]);
            let parts: Vec<TurningPhasor> = parts.cloned().collect();
            let skipped = usize::from(objective.reading == ObjectiveFigure::Backward);
            let last = if objective.reading == ObjectiveFigure::Forward { 1 } else { parts.len() };
            let parts = parts.into_iter().take(last).skip(skipped).collect();
            ObjectiveFunction::new(*objective, parts)
        };
        let functions = objectives.iter().map(function).collect();
        Ok(Self { functions, variables: variables.len() })
    }

    /// Weight of each objective.
    #[must_use]
    pub fn weights(&self) -> Vec<f64> {
        std::iter::successors(Some(1.0), |weight| Some(weight * NEXT_OBJECTIVE_WEIGHT))
            .take(self.functions.len())
            .collect()
    }

    /// Largest value that each objective could have, over ω².
    #[must_use]
    pub fn scales(&self) -> Vec<f64> {
        self.functions.iter().map(|function| function.scale).collect()
    }

    /// Upper bound on the change of the weighted sum per radian of a variable.
    #[must_use]
    pub fn steepest(&self) -> f64 {
        let slopes: Vec<f64> =
            self.functions.iter().map(|function| function.steepest() / function.scale).collect();
        dot(&slopes, &self.weights())
    }

    /// The objectives at points (points, variables) in radians, and their derivatives: (points,
    /// objectives) and (points, objectives, variables).
    pub fn evaluated(&self, points: &[Vec<f64>], cancel: &Cancel) -> Result<Vec<Vec<Derived>>> {
        for point in points {
            let found = point.len();
            limits::same_length("points", found, "the objectives", self.variables, "variable")?;
        }
        let chunks = pool::map(cancel, points.chunks(STARTS_PER_TASK).collect(), |chunk| {
            let of_point = |x: &Vec<f64>| {
                cancel.check()?;
                Ok(self.functions.iter().map(|function| function.value(x)).collect::<Vec<_>>())
            };
            chunk.iter().map(of_point).collect::<Result<Vec<_>>>()
        })?;
        Ok(chunks.into_iter().flatten().collect())
    }

    /// The smoothed weighted sum of the first few objectives, and its derivatives.
    #[must_use]
    pub fn smoothed(&self, x: &[f64], mu: f64, objectives: usize) -> Derived {
        let (mut value, mut slopes) = (0.0, vec![0.0; x.len()]);
        for (function, weight) in self.functions.iter().zip(self.weights()).take(objectives) {
            let (own, own_slopes) = function.smoothed(x, mu);
            value += weight * own;
            for (slope, own) in slopes.iter_mut().zip(own_slopes) {
                *slope += weight * own;
            }
        }
        (value, slopes)
    }
}

/// Orders of objectives and of totals, ascending, where the loads allow them.
fn orders_of(objectives: &[Objective], orders: &[Order], loads: &Scene) -> Result<Vec<Order>> {
    let mut all: Vec<Order> = objectives.iter().filter_map(|each| each.order).collect();
    all.extend_from_slice(orders);
    all.sort_unstable();
    all.dedup();
    if !all.is_empty() {
        order::check_list(&all)?;
    }
    let repeat = loads.list.iter().all(|load| load.parts.repeats == Repeats::EveryTurn);
    if let Some(half) = all.iter().find(|order| repeat && order.as_whole().is_none()) {
        return Err(Error::value("orders", half, "give whole orders: inertia has no others"));
    }
    if loads.list.iter().any(|load| load.parts.scaling != Scaling::SpeedSquared) {
        let reason = "it has loads that do not scale with the square of the speed".to_owned();
        return Err(Error::Undefined { argument: "objectives", reason });
    }
    Ok(all)
}

/// Parts of force, moment, roll torque and crank torque of one order, in the order of [`ObjectiveQuantity`].
fn quantities(
    terms: &[Term<Vec<Rotor>>],
    order: Order,
    removed: &[SpeedRatio],
    amplitudes: impl Fn(&Term<Vec<Rotor>>) -> Amplitude,
) -> [Vec<TurningPhasor>; 4] {
    let [forward, backward] = [true, false].map(|forward| SpeedRatio::at(order, forward));
    let planar = |of: fn(&Term<Vec<Rotor>>) -> &[Vec<Rotor>; 2]| {
        let part = |side: usize, speed: SpeedRatio| {
            let mut part = TurningPhasor::new(speed);
            for term in terms.iter().filter(|_| !removed.contains(&speed)) {
                part.extend(&of(term)[side], amplitudes(term).force);
            }
            part
        };
        vec![part(0, forward), part(1, backward).conjugate()]
    };
    let torque = |of: fn(&Amplitude) -> Complex64| {
        let mut part = TurningPhasor::new(forward);
        for term in terms {
            part.extend(&term.roll, of(&amplitudes(term)));
        }
        vec![part]
    };
    [
        planar(|term| &term.force),
        planar(|term| &term.moment),
        torque(|of| of.roll),
        torque(|of| of.crank),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objectives_are_of_inertia_at_whole_orders() {
        let (engine, _) = crate::load::tests::fired([Some(0); 3]);
        let objective = |halves| {
            let order = Some(Order::from_halves(halves).unwrap());
            let quantity = ObjectiveQuantity::Roll;
            Objective { quantity, reading: ObjectiveFigure::Peak, order }
        };
        let made = |engine: &Engine, halves| {
            let variable = Variable { bores: vec![0.0; 3], pins: vec![1.0, 0.0, 0.0] };
            Objectives::new(engine, &[variable], &[objective(halves)], &[], &[], &Cancel::new())
        };
        let found = made(&engine.without_gas(), 4).unwrap();
        assert!(found.evaluated(&[vec![0.1]], &Cancel::new()).unwrap()[0][0].0 > 0.0);
        for point in [vec![], vec![0.0; 2]] {
            assert!(matches!(found.evaluated(&[point], &Cancel::new()), Err(Error::Length { .. })));
        }
        let text = made(&engine.without_gas(), 1).unwrap_err().to_string();
        assert!(text.starts_with("orders = 0.5"), "{text}");
        assert!(matches!(made(&engine, 4), Err(Error::Undefined { .. })));
    }
}
