//! Which orders of force, moment and torque vanish, with proof.
//!
//! Each order and direction is a sum over the loads, Σ w ζᵏ, where w is a weight (times a lever) and
//! ζᵏ the load's direction turned by n times its phase. Where angles are rational parts of a turn and
//! the weights rational multiples of each other, [`crate::ring`] decides in integers whether it is
//! zero.
//!
//! A quantity with no rational relation to the others is treated as an independent symbol: an angle
//! that is no rational part of a turn (others a rational part of a turn away from it share its
//! symbol), a mass or a place that is no simple part of another, the harmonic of a slider-crank of
//! other proportions. The sum is then one over these symbols, each times a sum of roots of unity. It
//! vanishes if each of those does, whatever the symbols are. It remains if just one of them does not
//! and its symbol is known not to be zero. Otherwise nothing is proved.
//!
//! Which harmonics are known not to be zero:
//! - a₁ = 1 + ib of any slider-crank;
//! - without pin offset the even orders of the force: √(1 − λ² sin²θ) is a power series in λ² sin²θ
//!   whose coefficients all are negative, and so every even power gives cos nθ the sign (−1)^{n/2};
//! - without pin offset every order of the torque of the masses, half the derivative of x′²: order n
//!   has, of x′² = sin²θ − 2 sin θ h′ + h′², for odd n the difference of two neighbouring orders of
//!   h′, of opposite signs, for even n > 2 a term of a geometric series, and for n = 2 such a term
//!   and −½, both negative;
//! - others where their value is beyond any error of its evaluation: 10⁻⁹ of n² p₂^{n−2}, which
//!   bounds the terms that they are made of (p₂ as in [`crate::harmonics`]).

use std::collections::BTreeMap;

use num_traits::CheckedMul;

use super::{Levers, too_long, whole};
use crate::Complex64;
use crate::angle::Angle;
use crate::balance::{self, Orders, Request, Vector};
use crate::cancel::Cancel;
use crate::engine::{Engine, first_equal};
use crate::error::{Error, Result};
use crate::harmonics;
use crate::load::{Alike, Load, Loads, Source};
use crate::order::{Order, check_list};
use crate::rational::{Multiples, Ratio, WITHIN_ULP, common_multiple, recognise};
use crate::ring::RootSum;
use crate::slider_crank::Cylinder;

/// What is known of a sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// It is zero, proved.
    Vanishes,
    /// It is not, proved.
    Remains,
    /// Neither is proved.
    Undecided,
}

/// The sums of one order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Force along x.
    ForceX,
    /// Force along y.
    ForceY,
    /// Force that turns with the crank.
    ForceForward,
    /// Force that turns against it.
    ForceBackward,
    /// Moment about x.
    MomentX,
    /// Moment about y.
    MomentY,
    /// Moment that turns with the crank.
    MomentForward,
    /// Moment that turns against it.
    MomentBackward,
    /// Roll torque; that on the crank vanishes with it.
    Torque,
}

/// All of them, in the order in which they are reported.
pub const QUANTITIES: [Quantity; 9] = [
    Quantity::ForceX,
    Quantity::ForceY,
    Quantity::ForceForward,
    Quantity::ForceBackward,
    Quantity::MomentX,
    Quantity::MomentY,
    Quantity::MomentForward,
    Quantity::MomentBackward,
    Quantity::Torque,
];

/// Components in the cross-section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Direction {
    X,
    Y,
    Forward,
    Backward,
}

impl Quantity {
    /// A levered sum; and its direction, that of the force: a moment about x comes from forces
    /// along y. None for torque.
    fn sum(self) -> (bool, Option<Direction>) {
        match self {
            Self::ForceX => (false, Some(Direction::X)),
            Self::ForceY => (false, Some(Direction::Y)),
            Self::ForceForward => (false, Some(Direction::Forward)),
            Self::ForceBackward => (false, Some(Direction::Backward)),
            Self::MomentX => (true, Some(Direction::Y)),
            Self::MomentY => (true, Some(Direction::X)),
            Self::MomentForward => (true, Some(Direction::Forward)),
            Self::MomentBackward => (true, Some(Direction::Backward)),
            Self::Torque => (false, None),
        }
    }
}

/// What vanishes, order by order.
#[derive(Debug, Clone, PartialEq)]
pub struct Vanishing {
    /// As asked for.
    pub orders: Vec<u32>,
    /// One for each of [`QUANTITIES`], order by order.
    pub verdicts: Vec<[Verdict; 9]>,
    /// Whether each is within the bound of rounding errors in floating point.
    pub within_rounding: Vec<[bool; 9]>,
    /// Why sums are undecided, where some are.
    pub obstacles: Vec<String>,
}

/// Factor of a sum of roots of unity, by which the harmonic of a motion is meant; of odd parts in the
/// pin offset apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
enum Channel {
    /// 1: the first order of pistons without offset, and unbalances.
    #[default]
    One,
    /// Of the masses of a motion.
    Masses(usize),
    OddOfMasses(usize),
    /// Torque of the rod inertia of a motion.
    Rod(usize),
    OddOfRod(usize),
    /// Torque of a whole running gear, masses and rod.
    Gear(usize),
    OddOfGear(usize),
}

/// Lists of weights that have no rational relation to each other's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
enum Weights {
    /// m·r and unbalances, kg·m.
    #[default]
    Planar,
    /// m·r², kg·m².
    Masses,
    /// Rod inertia, kg·m².
    Rod,
    /// Unbalance times x or y of the shaft's axis, kg·m².
    Arm,
    /// 1.
    Gear,
}

/// How a direction that is no rational part of a turn enters a sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
enum Entry {
    #[default]
    Root,
    Conjugate,
    /// Cosine along x, sine along y; neither is zero.
    Component,
}

/// What a sum of roots of unity is multiplied by: indices of symbols.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
struct Symbol {
    channel: Channel,
    /// Unit of weight.
    weight: (Weights, usize),
    /// Unit of length.
    lever: usize,
    /// Direction that is no rational part of a turn, 0 for others.
    direction: (usize, Entry),
    /// Phase that is none.
    phase: usize,
}

/// A load's part of a sum: weight times the root of unity at `turns`.
struct Term {
    symbol: Symbol,
    turns: (i128, i128),
    weight: Ratio,
}

/// Angle as a rational part of a turn and, if it is none, an index from 1 instead.
#[derive(Debug, Clone, Copy)]
struct Direct {
    turns: (i128, i128),
    symbol: usize,
}

/// Rational parts of a turn as they are; others by one index where they are equal or, if
/// `in_steps`, a rational part of a turn apart.
fn directions(angles: impl Iterator<Item = Angle>, in_steps: bool) -> Vec<Direct> {
    let mut others: Vec<f64> = Vec::new();
    let direct = |angle: Angle| {
        if let Some((numerator, denominator)) = angle.turns() {
            return Direct { turns: (numerator.into(), denominator.into()), symbol: 0 };
        }
        let degrees = angle.degrees();
        let step_from = |other: f64| {
            if other == degrees {
                return Some((0, 1));
            }
            // Both are right within a few units in the last place of a turn.
            let step = recognise((degrees - other) / 360.0, WITHIN_ULP * f64::EPSILON)?;
            in_steps.then_some(step.into_raw())
        };
        let known = others.iter().enumerate().find_map(|(k, &o)| Some((k, step_from(o)?)));
        let (index, turns) = known.unwrap_or_else(|| {
            others.push(degrees);
            (others.len() - 1, (0, 1))
        });
        Direct { turns, symbol: index + 1 }
    };
    angles.map(direct).collect()
}

/// How the harmonics of cylinders of different proportions are distinguished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct View {
    /// Real and imaginary parts apart, of which a mirrored pin offset changes some signs:
    /// `a₁ = 1 + ib`, even orders are real and even in the offset, odd ones above imaginary and odd in
    /// it. Otherwise a complex number for each set of proportions.
    parts: bool,
    /// Torque by whole running gears, whose masses and rod have one phase.
    gears: bool,
}

/// Everything about an engine that does not depend on the order.
struct Proof {
    loads: Loads,
    /// Directions, equal ones by one symbol; and those a rational part of a turn apart.
    directions: [Vec<Direct>; 2],
    phases: Vec<Direct>,
    /// For each list of weights, unit and multiple of every load; arms have two weights a load.
    planar: Multiples,
    masses: Multiples,
    rods: Multiples,
    arms: Multiples,
    levers: Levers,
    /// For each motion the first of its size but for the sign of the offset.
    mirrored: Vec<usize>,
    gears: Vec<Cylinder>,
    /// Running gear of each cylinder, and the first of its size but for the sign of the offset.
    gear_of: Vec<(usize, usize)>,
}

impl Proof {
    fn new(engine: &Engine, reference: Option<f64>) -> Result<Self> {
        let loads = Loads::new(engine, engine.reference(reference)?, Alike::Proportions);
        let levers = Levers::new(engine, &loads, reference)?;
        let weights = |of: &dyn Fn(&Load) -> f64| -> Multiples {
            Multiples::of_figures(&loads.list.iter().map(of).collect::<Vec<_>>())
        };
        let piston = |load: &Load, of: fn(f64, f64) -> f64| match load.source {
            Source::Piston { second_moment, rod_inertia, .. } => of(second_moment, rod_inertia),
            Source::Unbalance { .. } => 0.0,
        };
        let arms = loads.list.iter().flat_map(|load| match load.source {
            Source::Unbalance { axis, .. } => [load.weight * axis.re, load.weight * axis.im],
            Source::Piston { .. } => [0.0; 2],
        });
        let angles = || loads.list.iter().map(|load| load.direction);
        let sizes = loads.motions.iter().map(|motion| {
            let proportions = motion.proportions();
            (proportions.rod, proportions.offset.abs())
        });
        let gears = engine.gears().to_vec();
        let of_gear = first_equal(gears.iter().map(|gear| {
            let inertia = gear.rod_inertia_excess();
            let offset = gear.pin_offset().abs();
            [gear.crank_radius(), gear.rod_length(), offset, gear.reciprocating_mass(), inertia]
        }));
        let gear_of = (0..engine.placements().len()).map(|i| {
            let gear = engine.gear_of(i);
            (gear, of_gear[gear])
        });
        Ok(Self {
            directions: [directions(angles(), false), directions(angles(), true)],
            phases: directions(loads.list.iter().map(|load| load.phase), true),
            planar: weights(&|load| load.weight),
            masses: weights(&|load| piston(load, |second_moment, _| second_moment)),
            rods: weights(&|load| piston(load, |_, rod_inertia| rod_inertia)),
            arms: Multiples::of_figures(&arms.collect::<Vec<_>>()),
            levers,
            mirrored: first_equal(sizes),
            gear_of: gear_of.collect(),
            gears,
            loads,
        })
    }

    /// Channels of a piston's force and their signs; none where its harmonic is zero.
    fn force_channels(&self, motion: usize, order: u32, view: View) -> Vec<(Channel, i128)> {
        use Channel::{Masses, One};
        let (mirrored, odd) = (self.mirrored[motion], order % 2 == 1);
        let offset = self.loads.motions[motion].pin_offset();
        let sign = offset.signum() as i128;
        match (offset == 0.0, order, view.parts) {
            (true, 1, _) => vec![(One, 1)],
            (true, _, _) if odd => vec![],
            (_, 1, true) => vec![(One, 1), (Masses(mirrored), sign)],
            (_, _, false) => vec![(Masses(motion), 1)],
            (_, _, true) => vec![(Masses(mirrored), if odd { sign } else { 1 })],
        }
    }

    /// Channels of a piston's torque, their signs and weights.
    fn torque_channels(
        &self,
        load: usize,
        motion: usize,
        view: View,
    ) -> Vec<(Channel, i128, (Weights, usize, Ratio))> {
        let offset = self.loads.motions[motion].pin_offset();
        let sign = offset.signum() as i128;
        let of = |whole: fn(usize) -> Channel, odd: fn(usize) -> Channel, own, mirrored| {
            // T(θ) of an offset is −T(−θ) of the opposite one: sines are even in it.
            match (view.parts, offset == 0.0) {
                (false, _) => vec![(whole(own), 1)],
                (true, true) => vec![(whole(mirrored), 1)],
                (true, false) => vec![(whole(mirrored), 1), (odd(mirrored), sign)],
            }
        };
        if view.gears {
            let (gear, mirrored) = self.gear_of[load];
            let channels = of(Channel::Gear, Channel::OddOfGear, gear, mirrored).into_iter();
            return channels.map(|(c, sign)| (c, sign, (Weights::Gear, 0, Ratio::ONE))).collect();
        }
        let mirrored = self.mirrored[motion];
        let masses = of(Channel::Masses, Channel::OddOfMasses, motion, mirrored).into_iter();
        let rods = of(Channel::Rod, Channel::OddOfRod, motion, mirrored).into_iter();
        let (unit, weight) = self.masses.of[load];
        let masses = masses.map(|(c, sign)| (c, sign, (Weights::Masses, unit, weight)));
        let (unit, weight) = self.rods.of[load];
        masses.chain(rods.map(|(c, sign)| (c, sign, (Weights::Rod, unit, weight)))).collect()
    }

    fn terms(&self, quantity: Quantity, order: u32, view: View) -> Result<Vec<Term>> {
        let (levered, direction) = quantity.sum();
        let mut terms = Vec::new();
        for (i, load) in self.loads.list.iter().enumerate() {
            let Some(direction) = direction else {
                self.add_torque(&mut terms, i, order, view)?;
                continue;
            };
            let no_lever = vec![(0, Ratio::ONE)];
            let levers = if levered { &self.levers.of[i] } else { &no_lever };
            for &lever in levers {
                match load.source {
                    Source::Piston { motion, .. } => {
                        for (channel, sign) in self.force_channels(motion, order, view) {
                            self.add_piston(&mut terms, i, order, direction, channel, lever, sign)?;
                        }
                    }
                    Source::Unbalance { ratio, .. } if ratio.unsigned_abs() == order => {
                        self.add_unbalance(&mut terms, i, ratio, direction, lever)?;
                    }
                    Source::Unbalance { .. } => {}
                }
            }
        }
        Ok(terms)
    }

    /// Twice the forward part, twice the conjugate of the backward part, or their sum (2X) and
    /// difference (2iY).
    #[expect(clippy::too_many_arguments, reason = "a term is this many factors")]
    fn add_piston(
        &self,
        terms: &mut Vec<Term>,
        i: usize,
        order: u32,
        direction: Direction,
        channel: Channel,
        (lever, factor): (usize, Ratio),
        sign: i128,
    ) -> Result<()> {
        let (unit, weight) = self.planar.of[i];
        let weight = product(&[weight, factor, Ratio::from(sign)])?;
        let [bore, stepped] = [self.directions[0][i], self.directions[1][i]];
        let phase = multiple(self.phases[i].turns, -i128::from(order));
        let mut push = |(direction, entry), turns, weight| {
            let weight_unit = (Weights::Planar, unit);
            let direction = (direction, if direction == 0 { Entry::Root } else { entry });
            let phase = self.phases[i].symbol;
            let symbol = Symbol { channel, weight: weight_unit, lever, direction, phase };
            add(terms, symbol, turns, weight);
        };
        let root = (stepped.symbol, Entry::Root);
        let conjugate = (stepped.symbol, Entry::Conjugate);
        match direction {
            Direction::Forward => push(root, turned(phase, stepped.turns, 1)?, weight),
            Direction::Backward => push(conjugate, turned(phase, stepped.turns, -1)?, weight),
            Direction::X | Direction::Y if bore.symbol > 0 => {
                push((bore.symbol, Entry::Component), phase, weight);
            }
            Direction::X | Direction::Y => {
                let mirrored = if direction == Direction::X { weight } else { -weight };
                push(root, turned(phase, bore.turns, 1)?, weight);
                push(conjugate, turned(phase, bore.turns, -1)?, mirrored);
            }
        }
        Ok(())
    }

    /// Twice an unbalance's force: all forward or all backward.
    fn add_unbalance(
        &self,
        terms: &mut Vec<Term>,
        i: usize,
        ratio: i32,
        direction: Direction,
        (lever, factor): (usize, Ratio),
    ) -> Result<()> {
        let forward = ratio > 0;
        let none = if forward { Direction::Backward } else { Direction::Forward };
        if direction == none {
            return Ok(());
        }
        let (unit, weight) = self.planar.of[i];
        let square = Ratio::from(2 * i128::from(ratio).pow(2));
        let sign = if !forward && direction == Direction::Y { -1 } else { 1 };
        let weight = product(&[weight, factor, square, Ratio::from(sign)])?;
        let (entry, turns) = self.root_of_unbalance(i, forward)?;
        let symbol = Symbol {
            channel: Channel::One,
            weight: (Weights::Planar, unit),
            lever,
            direction: entry,
            phase: self.phases[i].symbol,
        };
        add(terms, symbol, turns, weight);
        Ok(())
    }

    /// Direction of an unbalance at θ = 0, conjugate where it turns against the crank.
    fn root_of_unbalance(&self, i: usize, forward: bool) -> Result<((usize, Entry), (i128, i128))> {
        let stepped = self.directions[1][i];
        let phase = multiple(self.phases[i].turns, -1);
        let entry = match (stepped.symbol, forward) {
            (0, _) | (_, true) => Entry::Root,
            _ => Entry::Conjugate,
        };
        let turns = turned(phase, stepped.turns, if forward { 1 } else { -1 })?;
        Ok(((stepped.symbol, entry), turns))
    }

    fn add_torque(&self, terms: &mut Vec<Term>, i: usize, order: u32, view: View) -> Result<()> {
        let phase = self.phases[i];
        match self.loads.list[i].source {
            Source::Piston { motion, .. } => {
                let turns = multiple(phase.turns, -i128::from(order));
                for (channel, sign, (list, unit, weight)) in self.torque_channels(i, motion, view) {
                    let symbol = Symbol {
                        channel,
                        weight: (list, unit),
                        phase: phase.symbol,
                        ..Symbol::default()
                    };
                    add(terms, symbol, turns, product(&[weight, Ratio::from(sign)])?);
                }
            }
            Source::Unbalance { ratio, .. } if ratio.unsigned_abs() == order => {
                // With F the force at θ = 0, x + iy the axis: −i·x·F − y·F if it turns with the crank,
                // i·x·F̄ − y·F̄ if against it.
                let forward = ratio > 0;
                let (direction, turns) = self.root_of_unbalance(i, forward)?;
                let square = Ratio::from(i128::from(ratio).pow(2));
                let quarter = if forward { (3, 4) } else { (1, 4) };
                for (arm, turn) in [(2 * i, quarter), (2 * i + 1, (1, 2))] {
                    let (unit, weight) = self.arms.of[arm];
                    let symbol = Symbol {
                        weight: (Weights::Arm, unit),
                        direction,
                        phase: phase.symbol,
                        ..Symbol::default()
                    };
                    add(terms, symbol, turned(turns, turn, 1)?, product(&[weight, square])?);
                }
            }
            Source::Unbalance { .. } => {}
        }
        Ok(())
    }

    fn verdict(&self, quantity: Quantity, order: u32, cancel: &Cancel) -> (Verdict, Option<Error>) {
        let torque = quantity == Quantity::Torque;
        let views = [(false, torque), (true, torque), (false, false), (true, false)];
        let views = views.into_iter().take(if torque { 4 } else { 2 });
        let mut obstacle = None;
        for view in views.map(|(parts, gears)| View { parts, gears }) {
            let decided = self
                .terms(quantity, order, view)
                .and_then(|terms| self.decided(&terms, order, torque, view, cancel));
            match decided {
                Ok(Verdict::Undecided) => {}
                Ok(verdict) => return (verdict, None),
                Err(error) => obstacle = Some(error),
            }
        }
        (Verdict::Undecided, obstacle)
    }

    /// The verdict on Σ symbol · weight · root.
    fn decided(
        &self,
        terms: &[Term],
        order: u32,
        torque: bool,
        view: View,
        cancel: &Cancel,
    ) -> Result<Verdict> {
        let mut sums: BTreeMap<Symbol, Vec<&Term>> = BTreeMap::new();
        for term in terms {
            sums.entry(term.symbol).or_default().push(term);
        }
        let mut left = Vec::new();
        for (symbol, terms) in sums {
            let (weights, _) = whole(&terms.iter().map(|term| term.weight).collect::<Vec<_>>())?;
            let roots: Vec<(i128, i128, i128)> =
                terms.iter().zip(weights).map(|(t, w)| (t.turns.0, t.turns.1, w)).collect();
            if !RootSum::new(&roots, 1)?.vanishes()? {
                left.push(symbol.channel);
            }
        }
        Ok(match left[..] {
            [] => Verdict::Vanishes,
            [channel] if self.is_nonzero(channel, order, torque, view, cancel)? => Verdict::Remains,
            _ => Verdict::Undecided,
        })
    }

    /// Whether a harmonic is known not to be zero; see the head of this file.
    fn is_nonzero(
        &self,
        channel: Channel,
        order: u32,
        torque: bool,
        view: View,
        cancel: &Cancel,
    ) -> Result<bool> {
        use Channel::{Gear, Masses, OddOfGear, OddOfMasses, OddOfRod, One, Rod};
        let (cylinder, [masses, inertia]) = match channel {
            One => return Ok(true),
            Masses(motion) | OddOfMasses(motion) => (self.loads.motions[motion], [1.0, 0.0]),
            Rod(motion) | OddOfRod(motion) => (self.loads.motions[motion], [0.0, 1.0]),
            Gear(gear) | OddOfGear(gear) => {
                let gear = self.gears[gear];
                (gear, [gear.second_moment(), gear.rod_inertia_excess()])
            }
        };
        let centred = cylinder.pin_offset() == 0.0;
        if (centred && inertia == 0.0 && masses != 0.0) || (!torque && order == 1 && !view.parts) {
            return Ok(true);
        }
        let proportions = cylinder.proportions();
        let terms = if torque {
            let of_masses = harmonics::torque::torque(&proportions, &[order], cancel)?.roll[0];
            let of_rod = harmonics::rod::torque(&proportions, &[order], cancel)?.roll[0];
            [of_masses * masses, of_rod * inertia]
        } else {
            let force = harmonics::coefficients(&proportions, &[order], cancel)?[0];
            [force, Complex64::default()]
        };
        let value = terms[0] + terms[1];
        let value = match (view.parts, channel) {
            (false, _) => value.norm(),
            (true, OddOfMasses(_) | OddOfRod(_) | OddOfGear(_)) => value.re.abs(),
            (true, _) if torque || order % 2 == 1 => value.im.abs(),
            (true, _) => value.re.abs(),
        };
        // p₂ of l/r and e/r.
        let reach = proportions.rod - proportions.offset.abs();
        let root = 1.0 / (reach + (reach * reach - 1.0).max(0.0).sqrt());
        let n = f64::from(order);
        let made_of = n * n * root.powf(n - 2.0) * (masses + inertia.abs());
        Ok(value > 1e-9 * made_of.max(terms[0].norm() + terms[1].norm()))
    }

    /// Why a sum may be undecided.
    fn obstacles(&self) -> Vec<String> {
        let mut found = Vec::new();
        let cylinders = self.gear_of.len();
        let listed = |directions: &[Direct]| {
            let numbers: Vec<String> = (1..)
                .zip(&directions[..cylinders])
                .filter(|(_, d)| d.symbol > 0)
                .map(|(number, _): (usize, _)| number.to_string())
                .take(12)
                .collect();
            (!numbers.is_empty()).then(|| numbers.join(", "))
        };
        for (name, directions) in [("tdc_deg", &self.phases), ("bank_deg", &self.directions[0])] {
            if let Some(numbers) = listed(directions) {
                found.push(format!("{name} is no rational part of a turn in cylinders {numbers}"));
            }
        }
        if self.directions[0][cylinders..].iter().any(|direction| direction.symbol > 0) {
            found.push("angles of unbalances that are no rational part of a turn".to_owned());
        }
        if self.loads.motions.len() > 1 {
            found.push("slider-cranks of different proportions".to_owned());
        }
        let inertia = |gear: &Cylinder| gear.rod_inertia_excess();
        if self.gears.iter().any(|gear| inertia(gear) != inertia(&self.gears[0])) {
            found.push("rods of different moments of inertia".to_owned());
        }
        if self.planar.units.len() > 1 {
            found.push("masses times radius that are no rational multiples of each other".into());
        }
        if self.loads.list.len() > cylinders {
            let above = self.loads.unbalance_orders().iter().any(|&order| order > 1);
            if above {
                found
                    .push("unbalances of orders above 1, no rational multiples of pistons'".into());
            }
        }
        let mut units: Vec<usize> =
            self.levers.of.iter().flatten().map(|&(unit, _)| unit).collect();
        units.sort_unstable();
        units.dedup();
        if units.len() > 1 {
            found.push("places that are no rational multiples of each other".to_owned());
        }
        let has_offset = |motion: &Cylinder| motion.pin_offset() != 0.0;
        if found.is_empty() && self.loads.motions.iter().any(has_offset) {
            found.push(
                "pin offsets: harmonics with no rational relation to what rotates".to_owned(),
            );
        }
        if found.is_empty() && self.gears.iter().any(Cylinder::has_rod_inertia) {
            found.push("rod inertia: its torque nearly cancels that of the masses".to_owned());
        }
        found
    }
}

fn add(terms: &mut Vec<Term>, symbol: Symbol, turns: (i128, i128), weight: Ratio) {
    if weight != Ratio::ZERO {
        terms.push(Term { symbol, turns, weight });
    }
}

fn product(factors: &[Ratio]) -> Result<Ratio> {
    let product = factors.iter().try_fold(Ratio::ONE, |product, f| product.checked_mul(f));
    product.ok_or_else(too_long)
}

fn multiple(turns: (i128, i128), times: i128) -> (i128, i128) {
    (times * turns.0, turns.1)
}

/// One angle more, times a sign.
fn turned(a: (i128, i128), b: (i128, i128), sign: i128) -> Result<(i128, i128)> {
    let denominator = common_multiple(a.1, b.1).ok_or_else(too_long)?;
    let sum = a.0 * (denominator / a.1) + sign * b.0 * (denominator / b.1);
    Ok((sum, denominator))
}

/// What vanishes of an engine, at any speed, about the plane z = `reference_z` (default: half-way
/// between the first and the last cylinder).
pub fn vanishing(
    engine: &Engine,
    orders: &[u32],
    reference_z: Option<f64>,
    cancel: &Cancel,
) -> Result<Vanishing> {
    let listed = Order::all_whole(orders)?;
    check_list(&listed)?;
    let proof = Proof::new(engine, reference_z)?;
    let mut verdicts = Vec::with_capacity(orders.len());
    let mut errors: Vec<String> = Vec::new();
    for &order in orders {
        let mut of_order = [Verdict::Undecided; 9];
        for (verdict, quantity) in of_order.iter_mut().zip(QUANTITIES) {
            cancel.check()?;
            let (found, error) = proof.verdict(quantity, order, cancel);
            *verdict = found;
            if let Some(text) = error.map(|error| error.to_string())
                && !errors.contains(&text)
            {
                errors.push(text);
            }
        }
        verdicts.push(of_order);
    }
    let undecided = verdicts.iter().flatten().any(|&v| v == Verdict::Undecided);
    let mut obstacles = if undecided { proof.obstacles() } else { Vec::new() };
    obstacles.extend(errors);
    Ok(Vanishing {
        orders: orders.to_vec(),
        verdicts,
        within_rounding: within_rounding(engine, listed, reference_z, cancel)?,
        obstacles,
    })
}

/// What is zero within rounding, at no speed in particular.
fn within_rounding(
    engine: &Engine,
    orders: Vec<Order>,
    reference_z: Option<f64>,
    cancel: &Cancel,
) -> Result<Vec<[bool; 9]>> {
    let request = Request { rpm: 60.0, reference_z, spectrum: None, torque: true };
    let found = balance::balance(engine, &request, &Orders::Given(orders), cancel)?;
    Ok((0..found.orders.len())
        .map(|k| {
            let zero = Complex64::default();
            let of = |vector: Vector| {
                let [x, y] = found.xy(vector, k);
                let planar = found.planar(vector, k);
                [x, y, planar.forward, planar.backward_conj].map(|phasor| phasor == zero)
            };
            let ([a, b, c, d], [e, f, g, h]) = (of(Vector::Force), of(Vector::Moment));
            [a, b, c, d, e, f, g, h, found.wrenches[k].torque.roll == zero]
        })
        .collect())
}

#[cfg(test)]
mod tests;
