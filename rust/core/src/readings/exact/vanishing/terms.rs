//! The terms of an engine's sums: of every quantity and order, each load's weight, root of unity and
//! symbol.

use num_traits::CheckedMul;

use super::super::{Levers, Proportions, too_long};
use super::Quantity;
use super::symbols::{Channel, Direct, Entry, Symbol, Term, View, Weights, directions};
use crate::engine::{Engine, first_equal};
use crate::gear::slider_crank::Cylinder;
use crate::load::{Load, Loads, Source};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::rational::{Multiples, Ratio, common_multiple};

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

/// Everything about an engine that does not depend on the order.
pub(super) struct Proof {
    pub loads: Loads,
    /// A slider-crank of each gear.
    pub motions: Vec<Cylinder>,
    /// Directions, equal ones by one symbol; and those a rational part of a turn apart.
    pub directions: [Vec<Direct>; 2],
    pub phases: Vec<Direct>,
    /// For each list of weights, unit and multiple of every load; arms have two weights a load.
    pub planar: Multiples,
    masses: Multiples,
    rods: Multiples,
    arms: Multiples,
    pub levers: Levers,
    /// For each motion the first of its size but for the sign of the offset.
    mirrored: Vec<usize>,
    pub gears: Vec<Cylinder>,
    /// Running gear of each cylinder, and the first of its size but for the sign of the offset.
    pub gear_of: Vec<(usize, usize)>,
}

impl Proof {
    pub fn new(engine: &Engine, reference: Option<f64>, cancel: &Cancel) -> Result<Self> {
        let loads = super::super::loads(engine, reference)?;
        let levers = Levers::new(engine, &loads, reference, cancel)?;
        let weights = |of: &dyn Fn(&Load) -> f64| {
            Multiples::new(&loads.list.iter().map(of).collect::<Vec<_>>(), cancel)
        };
        let piston = |load: &Load, of: fn(f64, f64) -> f64| match load.source {
            Source::Piston { second_moment, rod_inertia, .. } => of(second_moment, rod_inertia),
            Source::Unbalance => 0.0,
        };
        let arms = loads.list.iter().flat_map(|load| match load.source {
            Source::Unbalance => [load.weight * load.axis.re, load.weight * load.axis.im],
            Source::Piston { .. } => [0.0; 2],
        });
        let angles = || loads.list.iter().map(|load| load.direction);
        let motions = loads.cylinders();
        let sizes = motions.iter().map(|motion| Proportions::of(motion).mirrored());
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
            directions: [directions(angles(), false, cancel)?, directions(angles(), true, cancel)?],
            phases: directions(loads.list.iter().map(|load| load.phase), true, cancel)?,
            planar: weights(&|load| load.weight)?,
            masses: weights(&|load| piston(load, |second_moment, _| second_moment))?,
            rods: weights(&|load| piston(load, |_, rod_inertia| rod_inertia))?,
            arms: Multiples::new(&arms.collect::<Vec<_>>(), cancel)?,
            levers,
            mirrored: first_equal(sizes),
            motions,
            gear_of: gear_of.collect(),
            gears,
            loads,
        })
    }

    /// Channels of a piston's force and their signs; none where its harmonic is zero.
    fn force_channels(&self, motion: usize, order: u32, view: View) -> Vec<(Channel, i128)> {
        use Channel::{Masses, One};
        let (mirrored, odd) = (self.mirrored[motion], order % 2 == 1);
        let offset = self.motions[motion].pin_offset();
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
        let offset = self.motions[motion].pin_offset();
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

    pub fn terms(&self, quantity: Quantity, order: u32, view: View) -> Result<Vec<Term>> {
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
                    Source::Piston { gear: motion, .. } => {
                        for (channel, sign) in self.force_channels(motion, order, view) {
                            self.add_piston(&mut terms, i, order, direction, channel, lever, sign)?;
                        }
                    }
                    Source::Unbalance if load.ratio.unsigned_abs() == order => {
                        self.add_unbalance(&mut terms, i, load.ratio, direction, lever)?;
                    }
                    Source::Unbalance => {}
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
            Source::Piston { gear: motion, .. } => {
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
            Source::Unbalance if self.loads.list[i].ratio.unsigned_abs() == order => {
                let ratio = self.loads.list[i].ratio;
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
            Source::Unbalance => {}
        }
        Ok(())
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
