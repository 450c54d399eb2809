//! Engines whose angles vary: objectives of their forces, moments and torques, with derivatives.
//!
//! Angles are linear in the variables, so that the phasor of each load is a constant times
//! `e^{i·rates·x}`. An objective is the largest of some sums of lengths of vectors that are linear in
//! the sums of these phasors. A length is not smooth at zero, nor is the largest where two are equal:
//! with μ > 0 they are replaced by √(u² + μ²) and μ·ln Σ exp(h/μ), which are, and tend to them with μ.

use std::f64::consts::TAU;

use crate::Complex64;
use crate::engine::Engine;
use crate::load::{Arithmetic, Load, Loads, PhasorSum, Phasors, Times, Wanted, Weight};
use crate::load::{Term, superpose};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::limits;
use crate::numbers::order::{self, Order};
use crate::numbers::pool;
use crate::readings::amplitude::GearHarmonics;

/// Weight of each objective relative to the one before it. A length that can vanish stays at zero under
/// weights this small: its slope there is 1.
const LATER: f64 = 1e-3;
/// Crank angles to the shortest wave at which peaks are looked for.
const SAMPLES: usize = 12;
/// Part of the highest sample below which there is no peak to consider: samples are short of a peak by
/// 1 − cos(π/12) at most.
const HIGH: f64 = 0.9;
/// Part of the largest possible sum below which rounding makes the peaks.
const NOTHING: f64 = 1e-9;
/// Points evaluated in one task.
const CHUNK: usize = 16;

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
pub enum Reading {
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
    pub reading: Reading,
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

/// A phasor that turns as the variables change: `phasor · e^{i·rates·x}`.
#[derive(Debug, Clone, Default)]
struct Rotor {
    phasor: Complex64,
    rates: Vec<f64>,
}

/// Arithmetic of loads that turn: a sum is a list of phasors.
struct Rotors<'a> {
    phasors: Phasors,
    /// Turns of the direction and of the crankpin of each load, by variable.
    turns: &'a [[Vec<f64>; 2]],
}

impl Arithmetic for Rotors<'_> {
    type Unit = Rotor;
    type Sum = Vec<Rotor>;

    fn phase(&self, load @ (k, _): (usize, &Load), times: i64) -> Rotor {
        // At top dead centre the crankpin points along the bore.
        let [bores, pins] = &self.turns[k];
        let rates = bores.iter().zip(pins).map(|(bore, pin)| times as f64 * (bore - pin));
        Rotor { phasor: self.phasors.phase(load, times), rates: rates.collect() }
    }

    fn toward(&self, load @ (k, _): (usize, &Load), unit: &Rotor, conjugate: bool) -> Rotor {
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
        load: (usize, &Load),
        weight: Weight,
        unit: &Rotor,
        times: Times,
    ) {
        let mut one = PhasorSum::default();
        self.phasors.add(&mut one, load, weight, &unit.phasor, times);
        sum.push(Rotor { phasor: one.value, rates: unit.rates.clone() });
    }
}

/// Part of a quantity that turns at a multiple of crank speed, negative against the crank.
#[derive(Debug, Clone)]
struct TurningPhasor {
    speed: i64,
    rotors: Vec<Rotor>,
}

impl TurningPhasor {
    fn new(speed: i64) -> Self {
        Self { speed, rotors: Vec::new() }
    }

    fn extend(&mut self, sum: &[Rotor], factor: Complex64) {
        let scaled = sum.iter().map(|each| Rotor { phasor: each.phasor * factor, ..each.clone() });
        self.rotors.extend(scaled);
    }

    /// From phasors of the conjugate.
    fn conjugate(mut self) -> Self {
        for each in &mut self.rotors {
            each.phasor = each.phasor.conj();
            each.rates.iter_mut().for_each(|rate| *rate = -*rate);
        }
        self
    }

    /// Phasor, and its derivatives.
    fn at(&self, x: &[f64]) -> WithSlopes {
        let mut found = WithSlopes::zero(x.len());
        for each in &self.rotors {
            let turned = each.phasor * Complex64::cis(dot(&each.rates, x));
            found.value += turned;
            for (slope, rate) in found.slopes.iter_mut().zip(&each.rates) {
                *slope += Complex64::i() * turned * rate;
            }
        }
        found
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A vector in the plane, and its derivatives by the variables.
#[derive(Debug, Clone)]
struct WithSlopes {
    value: Complex64,
    slopes: Vec<Complex64>,
}

impl WithSlopes {
    fn zero(variables: usize) -> Self {
        Self { value: Complex64::default(), slopes: vec![Complex64::default(); variables] }
    }

    fn add(&mut self, other: &Self, of: impl Fn(Complex64) -> Complex64) {
        self.value += of(other.value);
        for (slope, more) in self.slopes.iter_mut().zip(&other.slopes) {
            *slope += of(*more);
        }
    }
}

/// An objective with its parts.
#[derive(Debug, Clone)]
struct Goal {
    objective: Objective,
    parts: Vec<TurningPhasor>,
    /// Largest value that it could have: that of all phasors in phase.
    scale: f64,
    /// `e^{iθ}` at the crank angles of the samples.
    units: Vec<Complex64>,
}

impl Goal {
    fn new(objective: Objective, parts: Vec<TurningPhasor>) -> Self {
        let sizes = parts.iter().flat_map(|part| &part.rotors).map(|each| each.phasor.norm());
        let scale: f64 = sizes.sum();
        let highest = parts.iter().map(|part| part.speed.unsigned_abs() as usize).max();
        let points = SAMPLES * highest.unwrap_or(1).max(1);
        let units = (0..points).map(|k| Complex64::cis(k as f64 * TAU / points as f64));
        Self {
            scale: if scale > 0.0 { scale } else { 1.0 },
            units: units.collect(),
            objective,
            parts,
        }
    }

    /// Upper bound on the change of the objective per radian of a variable.
    fn steepest(&self) -> f64 {
        let rotors = self.parts.iter().flat_map(|part| &part.rotors);
        rotors
            .map(|each| {
                each.phasor.norm()
                    * each.rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()))
            })
            .sum()
    }

    /// The sums of lengths of vectors of which the largest is the objective.
    fn sums(&self, x: &[f64]) -> Vec<Vec<WithSlopes>> {
        let phasors: Vec<WithSlopes> = self.parts.iter().map(|part| part.at(x)).collect();
        if self.objective.order.is_none() {
            let planar = matches!(
                self.objective.quantity,
                ObjectiveQuantity::Force | ObjectiveQuantity::Moment
            );
            let axes: &[Option<Complex64>] = match (planar, self.objective.reading) {
                (true, Reading::PeakXy) => {
                    &[Some(Complex64::new(1.0, 0.0)), Some(Complex64::new(0.0, -1.0))]
                }
                (true, _) => &[None],
                (false, _) => &[Some(Complex64::new(1.0, 0.0))],
            };
            return axes.iter().flat_map(|axis| self.peaks(&phasors, *axis, x.len())).collect();
        }
        match (self.objective.reading, &phasors[..]) {
            (Reading::PeakXy, [forward, backward]) => [1.0, -1.0]
                .map(|sign| {
                    let mut sum = forward.clone();
                    sum.add(backward, |part| sign * part.conj());
                    vec![sum]
                })
                .into(),
            _ => vec![phasors],
        }
    }

    /// The vectors of all orders together at the crank angles of the highest peaks of their length, or
    /// of their projection on an axis.
    fn peaks(
        &self,
        phasors: &[WithSlopes],
        axis: Option<Complex64>,
        variables: usize,
    ) -> Vec<Vec<WithSlopes>> {
        let square = |vector: Complex64| match axis {
            Some(axis) => (axis * vector).re.powi(2),
            None => vector.norm_sqr(),
        };
        let count = self.units.len();
        let squares: Vec<f64> = (0..count)
            .map(|j| {
                let turned = self.parts.iter().zip(phasors).map(|(part, phasor)| {
                    let k = (j as i64 * part.speed).rem_euclid(count as i64) as usize;
                    phasor.value * self.units[k]
                });
                square(turned.sum())
            })
            .collect();
        let size: f64 = phasors.iter().map(|each| each.value.norm()).sum();
        let highest = squares.iter().copied().fold(0.0, f64::max);
        let least = (HIGH * HIGH * highest).max((NOTHING * size).powi(2));
        let mut at: Vec<usize> = (0..count)
            .filter(|&k| {
                let (before, after) = (squares[(k + count - 1) % count], squares[(k + 1) % count]);
                squares[k] >= before && squares[k] > after && squares[k] > least
            })
            .collect();
        if at.is_empty() {
            at.push(0);
        }
        let step = TAU / count as f64;
        at.into_iter()
            .map(|k| {
                let theta = self.polished(phasors, axis, k as f64 * step, step);
                let mut sum = WithSlopes::zero(variables);
                for (part, phasor) in self.parts.iter().zip(phasors) {
                    let unit = Complex64::cis(part.speed as f64 * theta);
                    sum.add(phasor, |part| {
                        axis.map_or(part * unit, |axis| (axis * part * unit).re.into())
                    });
                }
                vec![sum]
            })
            .collect()
    }

    /// Crank angle of the peak beside one that is a step off at most: Newton's method on the slope of
    /// the square.
    fn polished(
        &self,
        phasors: &[WithSlopes],
        axis: Option<Complex64>,
        start: f64,
        step: f64,
    ) -> f64 {
        let mut theta = start;
        for _ in 0..8 {
            let mut jet = [Complex64::default(); 3];
            for (part, phasor) in self.parts.iter().zip(phasors) {
                let speed = part.speed as f64;
                let turned = phasor.value * Complex64::cis(speed * theta);
                jet[0] += turned;
                jet[1] += Complex64::i() * speed * turned;
                jet[2] -= speed * speed * turned;
            }
            if let Some(axis) = axis {
                jet = jet.map(|each| (axis * each).re.into());
            }
            let product = |a: Complex64, b: Complex64| a.re * b.re + a.im * b.im;
            let slope = product(jet[0], jet[1]);
            let bend = product(jet[1], jet[1]) + product(jet[0], jet[2]);
            let moved = if bend < 0.0 { -slope / bend } else { 0.25 * step.copysign(slope) };
            let next = (theta + moved).clamp(start - step, start + step);
            if (next - theta).abs() <= 1e-9 * step {
                return next;
            }
            theta = next;
        }
        theta
    }

    /// The objective over its scale, and its derivatives.
    fn value(&self, x: &[f64]) -> Derived {
        let lengths = |sum: &[WithSlopes]| sum.iter().map(|each| each.value.norm()).sum::<f64>();
        let sums = self.sums(x);
        let largest = sums.iter().max_by(|a, b| lengths(a).total_cmp(&lengths(b)));
        let largest = largest.map_or(&[][..], Vec::as_slice);
        let mut slopes = vec![0.0; x.len()];
        for vector in largest.iter().filter(|each| each.value != Complex64::default()) {
            add_slopes(&mut slopes, vector, vector.value.norm() * self.scale, 1.0);
        }
        (lengths(largest) / self.scale, slopes)
    }

    /// The smoothed objective over its scale, and its derivatives.
    fn smoothed(&self, x: &[f64], mu: f64) -> Derived {
        let sums = self.sums(x);
        let length = |vector: &WithSlopes| (vector.value.norm() / self.scale).hypot(mu);
        let totals: Vec<f64> = sums.iter().map(|sum| sum.iter().map(length).sum()).collect();
        let largest = totals.iter().copied().fold(0.0, f64::max);
        let shares: Vec<f64> = totals.iter().map(|total| ((total - largest) / mu).exp()).collect();
        let together: f64 = shares.iter().sum();
        let mut slopes = vec![0.0; x.len()];
        for (sum, share) in sums.iter().zip(&shares) {
            for vector in sum {
                let divisor = length(vector) * self.scale * self.scale;
                add_slopes(&mut slopes, vector, divisor, share / together);
            }
        }
        (largest + mu * together.ln(), slopes)
    }
}

/// Adds the derivatives of half the square of a length over a divisor.
fn add_slopes(to: &mut [f64], vector: &WithSlopes, divisor: f64, factor: f64) {
    for (sum, slope) in to.iter_mut().zip(&vector.slopes) {
        *sum += factor * (vector.value.conj() * slope).re / divisor;
    }
}

/// Objectives of an engine whose angles vary, over the largest values that they could have; the later
/// ones with small weights.
#[derive(Debug, Clone)]
pub struct Merit {
    goals: Vec<Goal>,
}

impl Merit {
    /// Objectives of an engine, with all variables at 0 as it is given; totals are of `orders`. Balance
    /// shafts at the ratios of `removed` leave nothing of their part of force and moment.
    pub fn new(
        engine: &Engine,
        variables: &[Variable],
        objectives: &[Objective],
        orders: &[Order],
        removed: &[i32],
        cancel: &Cancel,
    ) -> Result<Self> {
        let loads = Loads::new(engine, engine.reference(None)?);
        let count = engine.stations().len();
        let lists = variables.iter().flat_map(|each| [&each.bores, &each.pins]);
        for list in lists {
            limits::same_length("variables", list.len(), "the engine", count, "cylinder")?;
        }
        let turns = |of: &dyn Fn(&Variable) -> f64| variables.iter().map(of).collect::<Vec<f64>>();
        let of_cylinder = |i: usize| [turns(&|each| each.bores[i]), turns(&|each| each.pins[i])];
        let fixed = || [vec![0.0; variables.len()], vec![0.0; variables.len()]];
        let pistons = (0..engine.stations().len()).map(of_cylinder);
        let weights =
            engine.crank_unbalances().map(|each| each.pin.map_or_else(fixed, of_cylinder));
        let mut all_turns: Vec<_> = pistons.chain(weights).collect();
        all_turns.resize_with(loads.list.len(), fixed);
        let arithmetic =
            Rotors { phasors: Phasors { reference: loads.reference }, turns: &all_turns };

        let mut all: Vec<Order> = objectives.iter().filter_map(|each| each.order).collect();
        all.extend_from_slice(orders);
        all.sort_unstable();
        all.dedup();
        if !all.is_empty() {
            order::check_list(&all)?;
        }
        let gears = GearHarmonics::new(&loads, true, &all, &[], cancel)?;
        let wanted = Wanted { planar: true, roll: true, by_bank: false };
        let by_order: Vec<[Vec<TurningPhasor>; 4]> = all
            .iter()
            .enumerate()
            .map(|(k, &order)| {
                let terms = superpose(&arithmetic, &loads, order, wanted);
                quantities(&terms, i64::from(order.as_whole().unwrap_or(0)), removed, |term| {
                    gears.of(term.harmonic, k)
                })
            })
            .collect();
        let goal = |objective: &Objective| {
            let of_goal =
                |order: &Order| objective.order.map_or(orders.contains(order), |own| own == *order);
            let mut parts: Vec<TurningPhasor> = Vec::new();
            for (_, found) in all.iter().zip(&by_order).filter(|(order, _)| of_goal(order)) {
                parts.extend_from_slice(&found[objective.quantity as usize]);
            }
            match objective.reading {
                Reading::Forward => parts.truncate(1),
                Reading::Backward => parts = parts.split_off(parts.len().min(1)),
                Reading::Peak | Reading::PeakXy => {}
            }
            Goal::new(*objective, parts)
        };
        Ok(Self { goals: objectives.iter().map(goal).collect() })
    }

    /// Weight of each objective.
    #[must_use]
    pub fn weights(&self) -> Vec<f64> {
        std::iter::successors(Some(1.0), |weight| Some(weight * LATER))
            .take(self.goals.len())
            .collect()
    }

    /// Largest value that each objective could have, over ω².
    #[must_use]
    pub fn scales(&self) -> Vec<f64> {
        self.goals.iter().map(|goal| goal.scale).collect()
    }

    /// Upper bound on the change of the weighted sum per radian of a variable.
    #[must_use]
    pub fn steepest(&self) -> f64 {
        let slopes: Vec<f64> = self.goals.iter().map(|goal| goal.steepest() / goal.scale).collect();
        dot(&slopes, &self.weights())
    }

    /// The objectives at points (points, variables) in radians, and their derivatives: (points,
    /// objectives) and (points, objectives, variables).
    pub fn evaluated(&self, points: &[Vec<f64>], cancel: &Cancel) -> Result<Vec<Vec<Derived>>> {
        let chunks = pool::map(cancel, points.chunks(CHUNK).collect(), |chunk| {
            let of_point = |x: &Vec<f64>| {
                cancel.check()?;
                Ok(self.goals.iter().map(|goal| goal.value(x)).collect::<Vec<_>>())
            };
            chunk.iter().map(of_point).collect::<Result<Vec<_>>>()
        })?;
        Ok(chunks.into_iter().flatten().collect())
    }

    /// The smoothed weighted sum of the first few objectives, and its derivatives.
    #[must_use]
    pub fn smoothed(&self, x: &[f64], mu: f64, objectives: usize) -> Derived {
        let (mut value, mut slopes) = (0.0, vec![0.0; x.len()]);
        for (goal, weight) in self.goals.iter().zip(self.weights()).take(objectives) {
            let (own, own_slopes) = goal.smoothed(x, mu);
            value += weight * own;
            for (slope, own) in slopes.iter_mut().zip(own_slopes) {
                *slope += weight * own;
            }
        }
        (value, slopes)
    }
}

/// Parts of force, moment, roll torque and crank torque of one order, in the order of [`ObjectiveQuantity`].
fn quantities(
    terms: &[Term<Vec<Rotor>>],
    order: i64,
    removed: &[i32],
    factors: impl Fn(&Term<Vec<Rotor>>) -> [Complex64; 3],
) -> [Vec<TurningPhasor>; 4] {
    let kept = |speed: i64| !removed.iter().any(|&ratio| i64::from(ratio) == speed);
    let planar = |of: fn(&Term<Vec<Rotor>>) -> &[Vec<Rotor>; 2]| {
        let part = |side: usize, speed: i64| {
            let mut part = TurningPhasor::new(speed);
            for term in terms.iter().filter(|_| kept(speed)) {
                part.extend(&of(term)[side], factors(term)[0]);
            }
            part
        };
        vec![part(0, order), part(1, -order).conjugate()]
    };
    let torque = |which: usize| {
        let mut part = TurningPhasor::new(order);
        for term in terms {
            part.extend(&term.roll, factors(term)[which]);
        }
        vec![part]
    };
    [planar(|term| &term.force), planar(|term| &term.moment), torque(1), torque(2)]
}
