//! Which orders of force, moment and torque vanish, with proof.
//!
//! Of each order and direction there is a sum over the cylinders, Σ w ζᵏ, where w is mass × radius
//! (× lever) and ζᵏ the direction of the bore turned by n·tdc. Where angles are rational parts of a
//! turn and the weights rational multiples of each other, [`crate::ring`] tells in integers
//! whether it is zero.
//!
//! What is no rational multiple of anything stands for itself: a bank angle of ten decimals, a top
//! dead centre (others a rational part of a turn away from it stand with it), a mass
//! or a place that is no simple part of another, the harmonic of a slider-crank of other
//! proportions. The sum is then one over these symbols, each times a sum of roots of unity. It
//! vanishes if each of those does, whatever the symbols are; it remains if just one of them does
//! not, since no symbol is zero; else two may cancel, and nothing is proved.

use std::collections::BTreeMap;

use num_traits::CheckedMul;

use crate::angle::Angle;
use crate::balance::{self, Orders};
use crate::engine::Engine;
use crate::error::{Error, Result};
use crate::limits;
use crate::rational::{Multiples, Ratio, WITHIN_ULP, common_multiple, recognise};
use crate::ring::RootSum;
use crate::slider_crank::{Cylinder, Proportions};

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
    /// Whether floating point finds each below what rounding can leave of a sum that vanishes.
    pub within_rounding: Vec<[bool; 9]>,
    /// Why sums are undecided, where some are.
    pub obstacles: Vec<String>,
}

/// A harmonic, by the index of the first cylinder that has it; of torques that of the masses or of a
/// whole cylinder with rod inertia, and what is odd in the pin offset of either apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
enum Channel {
    /// a₁ = 1, the same for all, and for what turns with the pins.
    #[default]
    One,
    Masses(usize),
    OddOfMasses(usize),
    Rod(usize),
    OddOfRod(usize),
}

/// What a sum of roots of unity is multiplied by: indices of symbols, none of them zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
struct Symbol {
    /// Harmonic.
    channel: Channel,
    /// Unit of mass × radius.
    mass: usize,
    /// Unit of length.
    lever: usize,
    /// Bank that is no rational part of a turn, and how it enters: its root, or cosine and sine.
    bank: (usize, bool),
    /// Top dead centre that is none.
    tdc: usize,
}

/// One cylinder's part of a sum: weight times the root of unity at `turns`.
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

/// Places along the crank and the plane of reference, as multiples of few lengths.
pub(crate) struct Places {
    /// Multiples of units, from midway between the first and the last cylinder; the plane is last.
    pub multiples: Multiples,
}

impl Places {
    /// Rounding of z is relative to z itself, not to what is left of it behind the middle.
    pub fn new(engine: &Engine, reference: Option<f64>) -> Self {
        let middle = engine.middle();
        let mut z: Vec<f64> = engine.placements().iter().map(|p| p.z).collect();
        z.push(reference.unwrap_or(middle));
        let largest = z.iter().fold(0.0_f64, |largest, z| largest.max(z.abs()));
        let levers: Vec<f64> = z.iter().map(|z| z - middle).collect();
        let errors = vec![largest * WITHIN_ULP * f64::EPSILON; z.len()];
        Self { multiples: Multiples::new(&levers, &errors) }
    }

    /// The lever of a cylinder: place and plane, perhaps multiples of different units.
    fn lever(&self, cylinder: usize) -> Vec<(usize, Ratio)> {
        let (of_plane, plane) = self.multiples.of[self.multiples.of.len() - 1];
        vec![self.multiples.of[cylinder], (of_plane, -plane)]
    }
}

pub(crate) fn too_long() -> Error {
    Error::value("weights", "too many digits", "exact sums need simple ratios of masses and places")
}

/// How the harmonics of cylinders of different proportions are told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum View {
    /// A complex number for each set of proportions.
    Whole,
    /// Real and imaginary parts, of which a mirrored pin offset changes some signs: `a₁ = 1 + ib`,
    /// even orders are real and even in the offset, odd ones above imaginary and odd in it.
    Parts,
}

/// Everything about an engine that does not depend on the order.
struct Layout<'a> {
    engine: &'a Engine,
    banks: Vec<Direct>,
    tdcs: Vec<Direct>,
    /// m·r of cylinders, then of what turns with their pins.
    forces: Multiples,
    /// m·r²; 1 where there is rod inertia.
    torques: Multiples,
    places: Places,
    /// Indices of equal proportions, and of those equal but for the sign of the offset.
    groups: Vec<(usize, usize)>,
    /// The same of whole cylinders with rod inertia: its torque has harmonics of its own, so that only
    /// the sum with that of the masses has one phase.
    rods: Vec<Option<(usize, usize)>>,
}

fn first_equal<T: PartialEq>(values: &[T]) -> Vec<usize> {
    values.iter().map(|v| values.iter().position(|w| w == v).unwrap_or_default()).collect()
}

impl<'a> Layout<'a> {
    fn new(engine: &'a Engine, reference: Option<f64>) -> Self {
        let placements = engine.placements();
        let mut forces: Vec<f64> = placements.iter().map(|p| p.cylinder.first_order()).collect();
        let torques: Vec<f64> = placements
            .iter()
            .map(|p| if p.cylinder.has_rod_inertia() { 1.0 } else { p.cylinder.second_moment() })
            .collect();
        forces.extend(placements.iter().map(|p| p.rotating_mass * p.cylinder.crank_radius()));
        let proportions: Vec<Proportions> =
            placements.iter().map(|p| p.cylinder.proportions()).collect();
        let cylinders: Vec<Cylinder> = placements.iter().map(|p| p.cylinder).collect();
        let figures: Vec<[f64; 5]> = cylinders
            .iter()
            .map(|c| {
                let (masses, rod_inertia) = (c.second_moment(), c.rod_inertia_excess());
                let offset = c.pin_offset().abs();
                [c.crank_radius(), c.rod_length(), offset, masses, rod_inertia]
            })
            .collect();
        let rods = first_equal(&cylinders).into_iter().zip(first_equal(&figures));
        let rods = rods.zip(&cylinders).map(|(rod, c)| c.has_rod_inertia().then_some(rod));
        let sizes: Vec<(f64, f64)> = proportions.iter().map(|p| (p.rod, p.offset.abs())).collect();
        Self {
            engine,
            banks: directions(placements.iter().map(|p| p.bank), false),
            tdcs: directions(placements.iter().map(|p| p.tdc), true),
            forces: Multiples::of_figures(&forces),
            torques: Multiples::of_figures(&torques),
            places: Places::new(engine, reference),
            groups: first_equal(&proportions).into_iter().zip(first_equal(&sizes)).collect(),
            rods: rods.collect(),
        }
    }

    fn offset(&self, i: usize) -> f64 {
        self.engine.placements()[i].cylinder.pin_offset()
    }

    /// The harmonics that a cylinder's force is made of, and their signs; none where they are zero.
    fn channels(&self, i: usize, order: u32, torque: bool, view: View) -> Vec<(Channel, i128)> {
        use Channel::{Masses, OddOfMasses, OddOfRod, One, Rod};
        let (group, mirrored) = self.groups[i];
        let (offset, odd) = (self.offset(i), order % 2 == 1);
        let sign = offset.signum() as i128;
        if torque {
            return match (self.rods[i], view) {
                (None, View::Whole) => vec![(Masses(group), 1)],
                // T(θ) of an offset is −T(−θ) of the opposite one: sines are even in it.
                (None, View::Parts) => vec![(Masses(mirrored), 1), (OddOfMasses(mirrored), sign)],
                (Some((group, _)), View::Whole) => vec![(Rod(group), 1)],
                (Some((_, mirrored)), View::Parts) => {
                    vec![(Rod(mirrored), 1), (OddOfRod(mirrored), sign)]
                }
            };
        }
        match (offset == 0.0, order, view) {
            (true, 1, _) => vec![(One, 1)],
            (true, _, _) if odd => vec![],
            (_, 1, View::Parts) => vec![(One, 1), (Masses(mirrored), sign)],
            (_, _, View::Whole) => vec![(Masses(group), 1)],
            (_, _, View::Parts) => vec![(Masses(mirrored), if odd { sign } else { 1 })],
        }
    }

    fn terms(&self, quantity: Quantity, order: u32, view: View) -> Result<Vec<Term>> {
        let (levered, direction) = quantity.sum();
        let count = self.groups.len();
        let mut terms = Vec::new();
        for i in 0..count {
            let levers = if levered { self.places.lever(i) } else { vec![(0, Ratio::ONE)] };
            let masses = if direction.is_none() { &self.torques } else { &self.forces };
            for (channel, sign) in self.channels(i, order, direction.is_none(), view) {
                for &lever in &levers {
                    let symbol = Symbol { channel, ..Symbol::default() };
                    self.add(&mut terms, i, order, direction, symbol, masses.of[i], lever, sign)?;
                }
            }
            if order == 1 && direction.is_some_and(|d| d != Direction::Backward) {
                for &lever in &levers {
                    self.add_rotating(&mut terms, i, direction, lever)?;
                }
            }
        }
        Ok(terms)
    }

    #[expect(clippy::too_many_arguments, reason = "a term is this many factors")]
    fn add(
        &self,
        terms: &mut Vec<Term>,
        i: usize,
        order: u32,
        direction: Option<Direction>,
        symbol: Symbol,
        (mass, weight): (usize, Ratio),
        (lever, factor): (usize, Ratio),
        sign: i128,
    ) -> Result<()> {
        let weight = weight.checked_mul(&factor).ok_or_else(too_long)?;
        if weight == Ratio::ZERO {
            return Ok(());
        }
        let (bank, tdc) = (self.banks[i], self.tdcs[i]);
        let phase = multiple(tdc.turns, -i128::from(order));
        let mut push = |bank_symbol, turns, sign| {
            let symbol = Symbol { mass, lever, tdc: tdc.symbol, bank: bank_symbol, ..symbol };
            let weight = if sign < 0 { -weight } else { weight };
            terms.push(Term { symbol, turns, weight });
        };
        let whole = (bank.symbol, false);
        match direction {
            None => push((0, false), phase, sign),
            Some(Direction::Forward) => push(whole, turned(phase, bank.turns, 1)?, sign),
            // The conjugate of the backward part.
            Some(Direction::Backward) => push(whole, turned(phase, bank.turns, -1)?, sign),
            // Cosine or sine of a bank that is no part of a turn: neither is zero.
            Some(Direction::X | Direction::Y) if bank.symbol > 0 => {
                push((bank.symbol, true), phase, sign);
            }
            // 2X and 2iY.
            Some(direction) => {
                let mirrored = if direction == Direction::X { sign } else { -sign };
                push((0, false), turned(phase, bank.turns, 1)?, sign);
                push((0, false), turned(phase, bank.turns, -1)?, mirrored);
            }
        }
        Ok(())
    }

    /// Mass that turns with a pin: e^{i(bank − tdc)}, twice what a reciprocating one has forward.
    fn add_rotating(
        &self,
        terms: &mut Vec<Term>,
        i: usize,
        direction: Option<Direction>,
        lever: (usize, Ratio),
    ) -> Result<()> {
        let count = self.groups.len();
        // Of harmonic a₁ = 1.
        let symbol = Symbol::default();
        let (unit, weight) = self.forces.of[count + i];
        let weight = weight.checked_mul(&Ratio::from_integer(2)).ok_or_else(too_long)?;
        debug_assert!(direction.is_some());
        let forward = Some(Direction::Forward);
        self.add(terms, i, 1, forward, symbol, (unit, weight), lever, 1)
    }

    fn verdict(&self, quantity: Quantity, order: u32) -> (Verdict, Option<Error>) {
        let mut obstacle = None;
        for view in [View::Whole, View::Parts] {
            match self.terms(quantity, order, view).and_then(|terms| decided(&terms)) {
                Ok(Verdict::Undecided) => {}
                Ok(verdict) => return (verdict, None),
                Err(error) => obstacle = Some(error),
            }
        }
        (Verdict::Undecided, obstacle)
    }

    /// Why a sum may be undecided.
    fn obstacles(&self) -> Vec<String> {
        let mut found = Vec::new();
        let listed = |directions: &[Direct]| {
            let numbers: Vec<String> = (1..)
                .zip(directions)
                .filter(|(_, d)| d.symbol > 0)
                .map(|(number, _): (usize, _)| number.to_string())
                .take(12)
                .collect();
            (!numbers.is_empty()).then(|| numbers.join(", "))
        };
        for (name, directions) in [("tdc_deg", &self.tdcs), ("bank_deg", &self.banks)] {
            if let Some(numbers) = listed(directions) {
                found.push(format!("{name} is no rational part of a turn in cylinders {numbers}"));
            }
        }
        if self.groups.iter().any(|&(group, _)| group != self.groups[0].0) {
            found.push("slider-cranks of different proportions".to_owned());
        }
        if self.rods.iter().any(|&rod| rod != self.rods[0]) {
            found.push("rods of different moments of inertia".to_owned());
        }
        if self.forces.units.len() > 1 {
            found.push("masses times radius that are no rational multiples of each other".into());
        }
        if self.places.multiples.units.len() > 1 {
            found.push("places that are no rational multiples of each other".to_owned());
        }
        found
    }
}

fn multiple(turns: (i128, i128), times: i128) -> (i128, i128) {
    // Without whole turns, sums with other angles do not overflow.
    ((times * turns.0).rem_euclid(turns.1), turns.1)
}

/// One angle more, times a sign.
fn turned(a: (i128, i128), b: (i128, i128), sign: i128) -> Result<(i128, i128)> {
    let denominator = common_multiple(a.1, b.1).ok_or_else(too_long)?;
    let sum = a.0 * (denominator / a.1) + sign * b.0 * (denominator / b.1);
    Ok((sum, denominator))
}

/// Weights as whole numbers, over their least common denominator.
pub(crate) fn whole(weights: &[Ratio]) -> Result<(Vec<i128>, i128)> {
    let common = weights
        .iter()
        .try_fold(1, |common, weight| common_multiple(common, *weight.denom()))
        .ok_or_else(too_long)?;
    let whole = weights.iter().map(|w| (*w.numer()).checked_mul(common / w.denom()));
    Ok((whole.collect::<Option<_>>().ok_or_else(too_long)?, common))
}

/// The verdict on Σ symbol · weight · root.
fn decided(terms: &[Term]) -> Result<Verdict> {
    let mut sums: BTreeMap<Symbol, Vec<&Term>> = BTreeMap::new();
    for term in terms {
        sums.entry(term.symbol).or_default().push(term);
    }
    let mut left = 0;
    for terms in sums.values() {
        let (weights, _) = whole(&terms.iter().map(|term| term.weight).collect::<Vec<_>>())?;
        let roots: Vec<(i128, i128, i128)> =
            terms.iter().zip(weights).map(|(t, w)| (t.turns.0, t.turns.1, w)).collect();
        if !RootSum::new(&roots, 1)?.vanishes()? {
            left += 1;
        }
    }
    Ok(match left {
        0 => Verdict::Vanishes,
        1 => Verdict::Remains,
        _ => Verdict::Undecided,
    })
}

/// What vanishes of an engine, at any speed, about the plane z = `reference_z` (default: half-way
/// between the first and the last cylinder).
pub fn vanishing(
    engine: &Engine,
    orders: &[u32],
    reference_z: Option<f64>,
    cancel: &crate::Cancel,
) -> Result<Vanishing> {
    limits::orders(orders)?;
    let reference = reference_z.map(|z| engine.reference(Some(z))).transpose()?;
    let layout = Layout::new(engine, reference);
    let mut verdicts = Vec::with_capacity(orders.len());
    let mut errors: Vec<String> = Vec::new();
    for &order in orders {
        let mut of_order = [Verdict::Undecided; 9];
        for (verdict, quantity) in of_order.iter_mut().zip(QUANTITIES) {
            cancel.check()?;
            let (found, error) = layout.verdict(quantity, order);
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
    let mut obstacles = if undecided { layout.obstacles() } else { Vec::new() };
    obstacles.extend(errors);
    Ok(Vanishing {
        orders: orders.to_vec(),
        verdicts,
        within_rounding: within_rounding(engine, orders, reference)?,
        obstacles,
    })
}

/// What floating point says, of no speed in particular.
fn within_rounding(
    engine: &Engine,
    orders: &[u32],
    reference: Option<f64>,
) -> Result<Vec<[bool; 9]>> {
    let found = balance::balance(engine, 60.0, &Orders::Given(orders.to_vec()), reference, None)?;
    Ok((0..orders.len())
        .map(|k| {
            let zero = crate::Complex64::default();
            let of = |shake: &balance::Shake| {
                [shake.xy[[k, 0]], shake.xy[[k, 1]], shake.forward[k], shake.backward[k]]
                    .map(|phasor| phasor == zero)
            };
            let ([a, b, c, d], [e, f, g, h]) = (of(&found.force), of(&found.moment));
            let torque = found.torque.as_ref().is_none_or(|t| t.roll[k] == zero);
            [a, b, c, d, e, f, g, h, torque]
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::*;
    use crate::engine::Placement;
    use crate::slider_crank::Cylinder;

    fn engine(places: &[(f64, f64, f64, f64, f64)]) -> Engine {
        let place = |&(tdc, bank, z, mass, offset): &(f64, f64, f64, f64, f64)| Placement {
            cylinder: Cylinder::new(0.05, 0.15, mass, offset).unwrap(),
            tdc: Angle::from_degrees(tdc).unwrap(),
            bank: Angle::from_degrees(bank).unwrap(),
            z,
            rotating_mass: 0.0,
        };
        Engine::new("", "", places.iter().map(place).collect()).unwrap()
    }

    fn verdicts(engine: &Engine, order: u32) -> [Verdict; 9] {
        vanishing(engine, &[order], None, &crate::Cancel::new()).unwrap().verdicts[0]
    }

    const V: Verdict = Verdict::Vanishes;
    const R: Verdict = Verdict::Remains;
    const U: Verdict = Verdict::Undecided;

    #[test]
    fn an_inline_three() {
        let i3 = engine(&[0.0, 1.0, 2.0].map(|k| (120.0 * k, 90.0, 0.13 * k, 0.45, 0.0)));
        assert_eq!(verdicts(&i3, 1), [V, V, V, V, R, V, R, R, V]);
        assert_eq!(verdicts(&i3, 5), [V; 9]);
        assert_eq!(verdicts(&i3, 6), [V, R, R, R, V, V, V, V, R]);
    }

    #[test]
    fn decimals_of_spacing_count_as_even() {
        // 0.3 is not 3 · 0.1 in doubles; an evenly spaced inline-4 has no moment all the same.
        let i4 = |last| {
            let tdc_z = [(0.0, 0.0), (180.0, 0.1), (180.0, 0.2), (0.0, last)];
            engine(&tdc_z.map(|(tdc, z)| (tdc, 90.0, z, 0.45, 0.0)))
        };
        assert_eq!(verdicts(&i4(0.3), 1)[..8], [V; 8]);
        assert_eq!(verdicts(&i4(0.3001), 1)[4], R);
    }

    #[test]
    fn irrational_banks_cancel_bank_by_bank_or_not_at_all() {
        // Each bank by itself is an inline-3 in one plane: no force whatever the angle.
        let banks = |b: f64| [0.0, 1.0, 2.0].map(|k| (120.0 * k, b, 0.1 * k, 0.45, 0.0));
        let v6 = engine(&[banks(61.234_567_891_2), banks(118.765_432_108_8)].concat());
        assert_eq!(verdicts(&v6, 1)[..4], [V; 4]);
        assert_eq!(verdicts(&v6, 1)[4..8], [U; 4]);
        assert_eq!(verdicts(&v6, 1)[8], V);
        // One bank alone: the direction is a factor, and not zero.
        assert_eq!(verdicts(&engine(&banks(61.234_567_891_2)), 1)[4..8], [R; 4]);
    }

    #[test]
    fn rows_that_are_no_part_of_a_turn_apart_cancel_row_by_row() {
        // As in a VR6: two rows of three, evenly spaced, the second 22.123456° later.
        let row = |tdc: f64, bank: f64, z: f64| {
            [0.0, 1.0, 2.0].map(|k| (120.0 * k + tdc, bank, z, 0.45, 0.0))
        };
        let vr6 = engine(&[row(0.0, 82.5, 0.0), row(22.123_456_789_1, 97.5, 0.0)].concat());
        assert_eq!(verdicts(&vr6, 2), [V; 9]);
        assert_eq!(verdicts(&vr6, 6)[..4], [U; 4]);
        assert_eq!(verdicts(&vr6, 6)[8], U);
    }

    #[test]
    fn proportions_that_differ_cancel_group_by_group() {
        let mut places = [0.0, 180.0].map(|tdc| (tdc, 90.0, 0.0, 0.45, 0.001)).to_vec();
        assert_eq!(verdicts(&engine(&places), 1)[..4], [V; 4]);
        // Opposite offsets have the same even orders, and odd ones of opposite sign.
        places[1].4 = -0.001;
        assert_eq!(verdicts(&engine(&places), 2)[1], R);
        places[1].0 = 90.0;
        assert_eq!(verdicts(&engine(&places), 2)[1], V);
        places[1].0 = 0.0;
        assert_eq!(verdicts(&engine(&places), 3)[1], V);
        assert_eq!(verdicts(&engine(&places), 1)[1], R);
        // Another offset is another slider-crank.
        places[1] = (90.0, 90.0, 0.0, 0.45, 0.002);
        assert_eq!(verdicts(&engine(&places), 2)[1], U);
    }

    #[test]
    fn rotating_mass_counts_as_a_reciprocating_one_at_order_one() {
        // A 90° twin on one pin: reciprocating forces add to a forward one of half its size each.
        let twin = engine(&[(0.0, 45.0, 0.0, 0.5, 0.0), (90.0, 135.0, 0.0, 0.5, 0.0)]);
        assert_eq!(verdicts(&twin, 1)[..4], [R, R, R, V]);
        // Turning masses that make up for a piston between them: 2·0.5/2 forward at 90° and 270°.
        let mut places = engine(&[(0.0, 90.0, 0.0, 0.5, 0.0), (180.0, 90.0, 0.0, 0.0, 0.0)])
            .placements()
            .to_vec();
        places[1].rotating_mass = 0.25;
        let countered = Engine::new("", "", places).unwrap();
        assert_eq!(verdicts(&countered, 1)[..4], [R, R, V, R]);
    }

    #[test]
    fn what_is_in_the_way_is_named() {
        let obstacles = |engine: &Engine, order| {
            vanishing(engine, &[order], None, &crate::Cancel::new()).unwrap().obstacles
        };
        let place = (0.0, 90.0, 0.0, 0.45, 0.0);
        let (tdc, bank) =
            ((17.123_456_789_1, 90.0, 0.0, 0.45, 0.0), (0.0, 61.234_567_891_2, 0.0, 0.45, 0.0));
        let (rod, mass) =
            ((90.0, 90.0, 0.0, 0.45, 0.002), (180.0, 90.0, 0.0, 0.45 * 2_f64.sqrt(), 0.0));
        // At an order that is decided nothing is in the way.
        assert_eq!(obstacles(&engine(&[place, place]), 2), [""; 0]);
        assert_eq!(obstacles(&engine(&[bank, bank]), 2), [""; 0]);
        // Neither are places along the crank that are multiples of one length.
        let further = (17.123_456_789_1, 90.0, 0.1, 0.45, 0.0);
        assert_eq!(obstacles(&engine(&[place, further]), 2).len(), 1);
        assert_eq!(
            obstacles(&engine(&[place, tdc]), 2),
            ["tdc_deg is no rational part of a turn in cylinders 2"]
        );
        assert_eq!(
            obstacles(&engine(&[place, bank, bank]), 2),
            ["bank_deg is no rational part of a turn in cylinders 2, 3"]
        );
        assert_eq!(
            obstacles(&engine(&[place, rod]), 2),
            ["slider-cranks of different proportions"]
        );
        assert_eq!(
            obstacles(&engine(&[place, mass]), 2),
            ["masses times radius that are no rational multiples of each other"]
        );
        let spread = [0.0, 0.1, 0.1 + 0.1 * 2_f64.sqrt(), 0.4].map(|z| (0.0, 90.0, z, 0.45, 0.0));
        assert_eq!(
            obstacles(&engine(&spread), 2),
            ["places that are no rational multiples of each other"]
        );
    }

    /// Cylinders of few kinds, so that sums vanish now and then; m·r² of some is 1, the unit of rods.
    fn placements() -> impl Strategy<Value = Vec<Placement>> {
        let root = 2.0_f64.sqrt();
        let mass = select(vec![400.0, 800.0, 400.0 * root]);
        let cylinder =
            (mass, select(vec![0.0, 0.001, -0.001, 0.002, 0.003]), select(vec![0.0, 0.3]));
        let cylinder = cylinder.prop_map(|(mass, offset, inertia)| {
            let cylinder = Cylinder::new(0.05, 0.15, mass, offset).unwrap();
            cylinder.with_rod_inertia_excess(inertia).unwrap()
        });
        let tdc = select(vec![0.0, 90.0, 120.0, 180.0, 240.0, 17.123_456_789_1, 107.123_456_789_1]);
        let bank = select(vec![0.0, 60.0, 90.0, 120.0, 61.234_567_891_2]);
        let z = select(vec![0.0, 0.1, 0.2, 0.1 * root]);
        let place = (cylinder, tdc, bank, z, select(vec![0.0, 200.0])).prop_map(
            |(cylinder, tdc, bank, z, rotating_mass)| Placement {
                cylinder,
                tdc: Angle::from_degrees(tdc).unwrap(),
                bank: Angle::from_degrees(bank).unwrap(),
                z,
                rotating_mass,
            },
        );
        let half = Angle::HALF_TURN;
        // With each a second one that differs in few things.
        let pair = (place, any::<[bool; 4]>()).prop_map(move |(p, [tdc, bank, offset, rod])| {
            let c = p.cylinder;
            let e = if offset { -c.pin_offset() } else { c.pin_offset() };
            let second = Cylinder::new(0.05, 0.15, c.reciprocating_mass(), e).unwrap();
            let inertia = if rod { c.rod_inertia_excess() } else { 0.0 };
            let second = Placement {
                cylinder: second.with_rod_inertia_excess(inertia).unwrap(),
                tdc: if tdc { p.tdc + half } else { p.tdc },
                bank: if bank { p.bank + half } else { p.bank },
                ..p
            };
            [p, second]
        });
        proptest::collection::vec(pair, 1..3).prop_map(|pairs| pairs.concat())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1024))]

        #[test]
        fn what_is_proved_is_so(
            placements in placements(),
            reference in select(vec![None, Some(0.0), Some(0.05), Some(0.05 * 2.0_f64.sqrt())]),
        ) {
            let engine = Engine::new("", "", placements).unwrap();
            let orders = [1, 2, 3, 4];
            let found = vanishing(&engine, &orders, reference, &crate::Cancel::new()).unwrap();
            // Nothing of these kinds is near zero without being zero.
            for (verdicts, zeros) in found.verdicts.iter().zip(&found.within_rounding) {
                for (&verdict, &zero) in verdicts.iter().zip(zeros) {
                    prop_assert!(verdict == U || (verdict == V) == zero, "{:?}", verdicts);
                }
            }
        }
    }

    #[test]
    fn what_is_out_of_reach_is_told_once() {
        // Parts of a turn whose common denominator is beyond what is tested.
        let tdc = |parts: i64| Angle::from_degree_fraction(360, parts).unwrap();
        let places = engine(&[(0.0, 90.0, 0.0, 0.45, 0.0); 2]).placements().to_vec();
        let places = [
            Placement { tdc: tdc(1_000_003), ..places[0] },
            Placement { tdc: tdc(1_000_033), ..places[1] },
        ];
        let engine = Engine::new("", "", places.to_vec()).unwrap();
        let found = vanishing(&engine, &[1, 2, 4], None, &crate::Cancel::new()).unwrap();
        let moments = 4..8;
        for verdicts in &found.verdicts {
            assert!(verdicts[..4].iter().all(|&v| v == U));
            assert!(verdicts[moments.clone()].iter().all(|&v| v == V));
        }
        let mut told = found.obstacles.clone();
        assert!(
            !told.is_empty() && told.iter().all(|text| text.contains("common denominator")),
            "{told:?}"
        );
        told.sort();
        told.dedup();
        assert_eq!(told.len(), found.obstacles.len());
    }

    #[test]
    fn floating_point_finds_the_same_zeros() {
        let i3 = engine(&[0.0, 1.0, 2.0].map(|k| (120.0 * k, 90.0, 0.13 * k, 0.45, 0.0)));
        let boxer = engine(&[(0.0, 0.0, 0.0, 0.45, 0.0), (0.0, 180.0, 0.1, 0.45, 0.0)]);
        let unlike = engine(&[(0.0, 90.0, 0.0, 0.45, 0.0), (180.0, 90.0, 0.2, 0.9, 0.0)]);
        for engine in [i3, boxer, unlike] {
            for reference in [None, Some(0.0), Some(0.05), Some(0.07)] {
                let orders = [1, 2, 3, 4, 6];
                let cancel = crate::Cancel::new();
                let found = vanishing(&engine, &orders, reference, &cancel).unwrap();
                assert_eq!(found.within_rounding.len(), orders.len());
                for (verdicts, zeros) in found.verdicts.iter().zip(&found.within_rounding) {
                    assert_eq!(verdicts.map(|v| v == V), *zeros, "{reference:?}");
                    assert!(!verdicts.contains(&U));
                }
            }
        }
    }

    #[test]
    fn orders_and_planes_are_checked() {
        let single = engine(&[(0.0, 90.0, 0.0, 0.5, 0.0)]);
        let cancel = crate::Cancel::new();
        assert!(vanishing(&single, &[], None, &cancel).is_err());
        assert!(vanishing(&single, &[1], Some(f64::NAN), &cancel).is_err());
        cancel.raise();
        assert_eq!(vanishing(&single, &[1], None, &cancel), Err(Error::Cancelled));
    }
}
