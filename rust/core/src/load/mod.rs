//! Loads on an engine, and the one sum of them; `scene` has those of an engine.
//!
//! A load has an amplitude, a direction in the cross-section, a crank angle at which it points that
//! way, and a place along a shaft. At order n, with β the direction, φ that crank angle and ρ the
//! speed of the shaft (1 for the crank; below zero against it):
//!
//! - a piston of amplitude A = m·r·aₙ has the forward part ½·ρ²·A·e^{i(β − nφ)} and the backward part
//!   conj(½·ρ²·A·e^{−i(β + nφ)}); its torques are amplitudes times e^{−inφ};
//! - an unbalance U has, at n = |ρ|, ρ²·U·e^{i(β − nφ)}, all of it forward, if ρ > 0, and the backward
//!   part conj(ρ²·U·e^{−i(β + nφ)}) if ρ < 0;
//! - pressure has only a torque, an amplitude times e^{−inφ}, φ the crank angle of the firing, also at
//!   half orders;
//! - a given load is a piston's of its own amplitudes in the first, and a torque of its own in the second;
//! - the moment is i·(z − z₀) times the force; a force at a = x + iy makes a roll torque of Im(ā·F).
//!
//! [`superpose`] sums these, and nothing else does. A reading of the list is an [`Arithmetic`]: it
//! says what a unit phasor is, and to what a load's weight times a unit phasor is added.
//!
//! | reading | unit phasor | sum |
//! |---|---|---|
//! | balances, sweeps ([`Phasors`]) | a complex number | a complex number and Σ\|terms\| |
//! | tolerances | a complex number | a complex number for each sample, whose weights and levers come from its draws |
//! | proofs, closed forms | a root of unity, times symbols for angles that are no parts of a turn | a list of such roots with rational weights |
//!
//! When a bank turns by δ, whatever belongs to it is multiplied as [`BankPhase`] says.

mod gas;
pub(crate) mod given;
pub(crate) mod kinematics;
mod knuckle;
mod piston;
mod place;
mod rod;
mod scene;
mod spectrum;
mod unbalance;

pub(crate) use self::place::Place;
pub(crate) use self::scene::{Group, KnownSeries, LargestWeights, Scene, Sources};
use crate::Complex64;
use crate::engine::Hold;
use crate::numbers::index::{ListIndex, list_index};
use crate::numbers::order::Order;
use crate::source::{Column, ForcePart, Parts, Repeats};
use crate::wrench::Planar;

list_index! {
    /// Index of a load in a [`Scene`].
    pub(crate) LoadIndex
}

list_index! {
    /// Index of a source in a [`Scene`].
    pub(crate) SourceIndex
}

list_index! {
    /// Index of a group in a [`Scene`].
    pub(crate) GroupIndex
}

/// A periodic load on the engine: a place, and a source with its weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Load {
    pub place: Place,
    pub source: SourceIndex,
    /// Those of the source.
    pub parts: Parts,
    /// Of the force: m·r of a piston, the unbalance of a shaft, kg·m. Below zero, as the other weight,
    /// where the load acts the other way.
    pub weight: f64,
    /// Of its torque: m·r² or rod inertia, kg·m²; area times crank radius of pressure, m³.
    pub roll: f64,
}

/// Factor of a sum, which depends on the order: an amplitude of a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) struct Harmonic {
    pub source: SourceIndex,
    pub column: Column,
}

/// Real factor of a load's unit phasor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weight {
    /// That of the force.
    Force,
    /// The same times z − z₀.
    Moment,
    /// That of the force times x of its axis.
    ArmX,
    /// That of the force times y of its axis.
    ArmY,
    /// That of the torque.
    Roll,
}

/// Factor of a load's part: `eighths`/8 · i^`quarters`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Factor {
    pub eighths: i32,
    pub quarters: i32,
}

/// Numbers in which loads are summed.
pub(crate) trait Arithmetic {
    /// Unit phasor.
    type Unit;
    /// Sum of weights times unit phasors.
    type Sum: Default;

    /// `e^{i·times·φ}` of a load; with its index in the list.
    fn phase(&self, load: (LoadIndex, &Load), times: i64) -> Self::Unit;

    /// A unit phasor times `e^{iβ}`, or its conjugate.
    fn toward(&self, load: (LoadIndex, &Load), unit: &Self::Unit, conjugate: bool) -> Self::Unit;

    /// Adds a load's weight times a unit phasor, times an eighth of a whole number and a power of i.
    fn add(
        &self,
        sum: &mut Self::Sum,
        load: (LoadIndex, &Load),
        weight: Weight,
        unit: &Self::Unit,
        times: Factor,
    );
}

/// Sums of the loads of one harmonic and bank at one order, over the harmonic and what it scales with.
#[derive(Debug, Clone)]
pub(crate) struct Term<S> {
    pub harmonic: Harmonic,
    pub bank: Option<usize>,
    /// Forward part, and conjugate of the backward part.
    pub force: [S; 2],
    pub moment: [S; 2],
    pub roll: S,
}

/// Quantities to sum.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted {
    /// Force and moment.
    pub planar: bool,
    /// Roll torque.
    pub roll: bool,
    /// Apart for each bank.
    pub by_bank: bool,
}

/// Sums of one order, by harmonic and, if wanted, by bank: in the order of sources, whatever else is wanted.
pub(crate) fn superpose<A: Arithmetic>(
    arithmetic: &A,
    loads: &[Load],
    order: Order,
    wanted: Wanted,
) -> Vec<Term<A::Sum>> {
    let mut terms = Vec::new();
    let acting = loads.iter().enumerate().filter(|(_, load)| load.acts_at(order));
    for at @ (_, load) in acting.map(|(i, load)| (LoadIndex::new(i), load)) {
        let (parts, place) = (load.parts, &load.place);
        let arm = wanted.roll && place.axis != Complex64::default();
        let force = parts.force.filter(|_| wanted.planar || arm);
        let roll = parts.roll && wanted.roll;
        if force.is_none() && !roll {
            continue;
        }
        let halves_squared = place.ratio.halves() * place.ratio.halves();
        let phase = arithmetic.phase(at, -load.phase_multiple(order));
        let bank = place.bank.filter(|_| wanted.by_bank);
        let harmonic = |column| Harmonic { source: load.source, column };
        if let Some(force) = force {
            let term = term_of(&mut terms, harmonic(Column::Force), bank);
            // What moves along a line is half forward, half backward.
            let eighths =
                if force == ForcePart::Along { halves_squared } else { 2 * halves_squared };
            for (side, sign) in [(0, 1), (1, -1)] {
                if !load.has_part(side == 0) {
                    continue;
                }
                let unit = arithmetic.toward(at, &phase, side == 1);
                let add = |sum: &mut A::Sum, weight, quarters| {
                    arithmetic.add(sum, at, weight, &unit, Factor { eighths, quarters });
                };
                if wanted.planar {
                    add(&mut term.force[side], Weight::Force, 0);
                    add(&mut term.moment[side], Weight::Moment, sign);
                }
                if arm {
                    // Im(ā·F) is Re(∓i·x·P − y·P) of the forward and of the conjugate backward part.
                    add(&mut term.roll, Weight::ArmX, -sign);
                    add(&mut term.roll, Weight::ArmY, 2);
                }
            }
        }
        if roll {
            let times = Factor { eighths: 2 * halves_squared, quarters: 0 };
            let term = term_of(&mut terms, harmonic(Column::Roll), bank);
            arithmetic.add(&mut term.roll, at, Weight::Roll, &phase, times);
        }
    }
    // A force without an arm has no term where torque alone is wanted.
    terms.sort_by_key(|term| term.harmonic);
    terms
}

/// The term of this harmonic and bank, added where there is none yet.
fn term_of<S: Default>(
    terms: &mut Vec<Term<S>>,
    harmonic: Harmonic,
    bank: Option<usize>,
) -> &mut Term<S> {
    let same = |term: &Term<S>| (term.harmonic, term.bank) == (harmonic, bank);
    find_or_push(terms, same, || {
        let [force, moment] = [(); 2].map(|()| [(); 2].map(|()| S::default()));
        Term { harmonic, bank, force, moment, roll: S::default() }
    })
}

/// Number of loads that have a part in forces and moments, or of all, which have one in torques: on it the
/// rounding of their sums depends.
pub(crate) fn count(loads: &[Load], torque: bool) -> usize {
    loads.iter().filter(|load| torque || load.parts.force.is_some()).count()
}

/// The first of a list that is such, or a new one at its end.
pub(crate) fn find_or_push<T>(
    list: &mut Vec<T>,
    is_such: impl FnMut(&T) -> bool,
    new: impl FnOnce() -> T,
) -> &mut T {
    let place = list.iter().position(is_such).unwrap_or_else(|| {
        list.push(new());
        list.len() - 1
    });
    &mut list[place]
}

/// Arithmetic of balances and sweeps: complex numbers.
pub(crate) struct Phasors {
    /// Reference plane z₀ of moments, m.
    pub reference: f64,
}

/// A sum and Σ|terms|, on which its rounding error depends.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PhasorSum<T = Complex64> {
    pub value: T,
    pub size: f64,
}

impl Arithmetic for Phasors {
    type Unit = Complex64;
    type Sum = PhasorSum;

    fn phase(&self, (_, load): (LoadIndex, &Load), times: i64) -> Complex64 {
        load.place.phase.cis(times)
    }

    fn toward(
        &self,
        (_, load): (LoadIndex, &Load),
        unit: &Complex64,
        conjugate: bool,
    ) -> Complex64 {
        unit * if conjugate { load.place.unit.conj() } else { load.place.unit }
    }

    #[inline]
    fn add(
        &self,
        sum: &mut PhasorSum,
        (_, load): (LoadIndex, &Load),
        weight: Weight,
        unit: &Complex64,
        times: Factor,
    ) {
        let weight_and_size = |weight: f64| (weight, weight.abs());
        let place = &load.place;
        let (weight, size) = match weight {
            Weight::Force => weight_and_size(load.weight),
            // Rounding of a lever is relative to what it is the difference of.
            Weight::Moment => (
                load.weight * place.lever(self.reference),
                load.weight.abs() * place.lever_size(self.reference),
            ),
            Weight::ArmX => weight_and_size(load.weight * place.axis.re),
            Weight::ArmY => weight_and_size(load.weight * place.axis.im),
            Weight::Roll => weight_and_size(load.roll),
        };
        sum.value += times.of(*unit) * weight;
        sum.size += 0.125 * f64::from(times.eighths) * size;
    }
}

impl Factor {
    /// A complex number times this factor.
    pub fn of(self, unit: Complex64) -> Complex64 {
        let factor = 0.125 * f64::from(self.eighths);
        factor
            * match self.quarters.rem_euclid(4) {
                0 => unit,
                1 => Complex64::new(-unit.im, unit.re),
                2 => -unit,
                _ => Complex64::new(unit.im, -unit.re),
            }
    }
}

impl Term<PhasorSum> {
    /// Force and moment, with this rounding error of a sum of 1.
    pub fn planar(&self, rounding: f64) -> [Planar; 2] {
        [&self.force, &self.moment].map(|[forward, backward_conj]| Planar {
            forward: forward.value,
            backward_conj: backward_conj.value,
            bound: (forward.size + backward_conj.size) * rounding,
        })
    }
}

impl Load {
    /// Whether it has a part at this order.
    pub fn acts_at(&self, order: Order) -> bool {
        let own = self.place.ratio.halves_of_speed();
        match (self.parts.force, self.parts.repeats) {
            (Some(ForcePart::Turning), _) => order.halves() == own,
            (_, Repeats::EveryTurn) => order.halves().is_multiple_of(own),
            (_, Repeats::EveryTwoTurns) => true,
        }
    }

    /// Multiple of its phase by which it lags at an order.
    fn phase_multiple(&self, order: Order) -> i64 {
        let halves = i64::from(order.halves());
        if self.parts.repeats == Repeats::EveryTwoTurns { halves } else { halves / 2 }
    }

    /// Multiple of its phase by which its shaft turns meanwhile.
    fn turns_of_phase(&self) -> i64 {
        let halves = i64::from(self.place.ratio.halves());
        if self.parts.repeats == Repeats::EveryTwoTurns { halves } else { halves / 2 }
    }

    /// Whether its force has a forward part, or a backward part.
    pub fn has_part(&self, forward: bool) -> bool {
        !self.is_turning() || forward == self.place.ratio.is_forward()
    }

    /// Whether it turns with a shaft.
    pub fn is_turning(&self) -> bool {
        self.parts.force == Some(ForcePart::Turning)
    }
}

/// Multiples of δ/2 in the phase by which the parts of a bank's loads change at one order as it turns by δ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BankPhase {
    pub forward: i64,
    pub backward_conj: i64,
    pub roll: i64,
}

impl BankPhase {
    /// With pins held, a bore takes its top dead centres along; with the firing held it does not.
    pub fn new(order: Order, hold: Hold) -> Self {
        let halves = i64::from(order.halves());
        match hold {
            Hold::Pins => Self { forward: 2 - halves, backward_conj: -2 - halves, roll: -halves },
            Hold::Firing => Self { forward: 2, backward_conj: -2, roll: 0 },
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
