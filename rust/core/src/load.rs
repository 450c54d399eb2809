//! Loads on an engine, and the one sum of them; `list` has those of an engine.
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
//! When a bank turns by δ, whatever belongs to it is multiplied as [`Turn`] says.

mod list;

pub(crate) use self::list::Loads;
use crate::Complex64;
use crate::engine::{Hold, Origin};
use crate::numbers::angle::Angle;
use crate::numbers::order::Order;
use crate::wrench::Planar;

/// Origin of a load's amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Source {
    /// A piston and its rod.
    Piston {
        /// Index into [`Loads::gears`].
        gear: usize,
        /// m·r², kg·m²: weight of the torques of the masses.
        second_moment: f64,
        /// Weight of the torques of the rod's inertia, kg·m².
        rod_inertia: f64,
    },
    /// A mass off the axis of a shaft.
    Unbalance,
    /// Pressure on a piston, which makes torque alone: forces on head, wall and bearings cancel.
    Pressure {
        /// Index into [`Loads::gears`].
        gear: usize,
    },
}

/// A periodic load on the engine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Load {
    /// Part of the engine that it belongs to.
    pub origin: Origin,
    pub source: Source,
    /// m·r of a piston, the unbalance of a shaft, kg·m; area times crank radius of pressure, m³; below
    /// zero where the load acts the other way.
    pub weight: f64,
    /// Direction of the force when the crank stands at `phase`, from +x.
    pub direction: Angle,
    /// Unit vector of that direction, x + iy.
    pub unit: Complex64,
    /// Crank angle; of pressure half of that of the firing, which half orders turn by whole numbers.
    pub phase: Angle,
    /// Place along the crank, m.
    pub z: f64,
    /// Speed of its shaft over crank speed, negative where it turns against the crank.
    pub ratio: i32,
    /// Place of the shaft's axis, x + iy, m.
    pub axis: Complex64,
    /// Bank that it belongs to: that of a piston, or of a crankpin's piston.
    pub bank: Option<usize>,
}

/// Factor of a sum, which depends on the order and on the gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) enum Harmonic {
    /// 1: unbalances.
    #[default]
    One,
    /// Of the force of a gear.
    Force(usize),
    /// Of the torque of a gear's masses.
    Torque(usize),
    /// Of the torque of a gear's rod inertia.
    Rod(usize),
    /// Of the torque of the pressure on a gear's piston: whatever the speed, where all others are over ω².
    Gas(usize),
}

impl Harmonic {
    /// Index of the gear that it is of, if it is of one.
    pub fn gear(self) -> Option<usize> {
        match self {
            Self::One => None,
            Self::Force(k) | Self::Torque(k) | Self::Rod(k) | Self::Gas(k) => Some(k),
        }
    }
}

/// Real factor of a load's unit phasor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weight {
    /// m·r or unbalance.
    Force,
    /// The same times z − z₀.
    Moment,
    /// m·r².
    Torque,
    /// Rod inertia.
    Rod,
    /// m·r or unbalance times x of its axis.
    ArmX,
    /// m·r or unbalance times y of its axis.
    ArmY,
    /// Area times crank radius.
    Volume,
}

/// Factor of a load's part: `halves`/2 · i^`quarters`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Times {
    pub halves: i32,
    pub quarters: i32,
}

/// Numbers in which loads are summed.
pub(crate) trait Arithmetic {
    /// Unit phasor.
    type Unit;
    /// Sum of weights times unit phasors.
    type Sum: Default;

    /// `e^{i·times·φ}` of a load; with its index in the list.
    fn phase(&self, load: (usize, &Load), times: i64) -> Self::Unit;

    /// A unit phasor times `e^{iβ}`, or its conjugate.
    fn toward(&self, load: (usize, &Load), unit: &Self::Unit, conjugate: bool) -> Self::Unit;

    /// Adds a load's weight times a unit phasor, times half a whole number and a power of i.
    fn add(
        &self,
        sum: &mut Self::Sum,
        load: (usize, &Load),
        weight: Weight,
        unit: &Self::Unit,
        times: Times,
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

/// Sums of one order, by harmonic and, if wanted, by bank.
pub(crate) fn superpose<A: Arithmetic>(
    arithmetic: &A,
    loads: &[Load],
    order: Order,
    wanted: Wanted,
) -> Vec<Term<A::Sum>> {
    let mut terms = Vec::new();
    for at @ (_, load) in loads.iter().enumerate().filter(|(_, load)| load.acts_at(order)) {
        let bank = load.bank.filter(|_| wanted.by_bank);
        if let Source::Pressure { gear } = load.source {
            if wanted.roll {
                let phase = arithmetic.phase(at, -i64::from(order.halves()));
                let sum = &mut term_of(&mut terms, Harmonic::Gas(gear), bank).roll;
                arithmetic.add(sum, at, Weight::Volume, &phase, Times { halves: 2, quarters: 0 });
            }
            continue;
        }
        let phase = arithmetic.phase(at, -i64::from(order.halves() / 2));
        let square = load.ratio * load.ratio;
        let (harmonic, halves) = match load.source {
            Source::Piston { gear, .. } => (Harmonic::Force(gear), square),
            _ => (Harmonic::One, 2 * square),
        };
        let arm = wanted.roll && load.axis != Complex64::default();
        if wanted.planar || arm {
            let term = term_of(&mut terms, harmonic, bank);
            for (side, sign) in [(0, 1), (1, -1)] {
                if !load.has_part(side == 0) {
                    continue;
                }
                let unit = arithmetic.toward(at, &phase, side == 1);
                let add = |sum: &mut A::Sum, weight, quarters| {
                    arithmetic.add(sum, at, weight, &unit, Times { halves, quarters });
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
        let Source::Piston { gear, rod_inertia, .. } = load.source else { continue };
        if wanted.roll {
            let mut add = |harmonic, weight| {
                let sum = &mut term_of(&mut terms, harmonic, bank).roll;
                arithmetic.add(sum, at, weight, &phase, Times { halves: 2 * square, quarters: 0 });
            };
            add(Harmonic::Torque(gear), Weight::Torque);
            if rod_inertia != 0.0 {
                add(Harmonic::Rod(gear), Weight::Rod);
            }
        }
    }
    terms
}

/// The term of this harmonic and bank, added where there is none yet.
fn term_of<S: Default>(
    terms: &mut Vec<Term<S>>,
    harmonic: Harmonic,
    bank: Option<usize>,
) -> &mut Term<S> {
    let same = |term: &Term<S>| (term.harmonic, term.bank) == (harmonic, bank);
    found_or(terms, same, || {
        let [force, moment] = [(); 2].map(|()| [(); 2].map(|()| S::default()));
        Term { harmonic, bank, force, moment, roll: S::default() }
    })
}

/// The first of a list that is such, or a new one at its end.
pub(crate) fn found_or<T>(
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

    fn phase(&self, (_, load): (usize, &Load), times: i64) -> Complex64 {
        load.phase.cis(times)
    }

    fn toward(&self, (_, load): (usize, &Load), unit: &Complex64, conjugate: bool) -> Complex64 {
        unit * if conjugate { load.unit.conj() } else { load.unit }
    }

    #[inline]
    fn add(
        &self,
        sum: &mut PhasorSum,
        (_, load): (usize, &Load),
        weight: Weight,
        unit: &Complex64,
        times: Times,
    ) {
        let weight_and_size = |weight: f64| (weight, weight.abs());
        let (weight, size) = match (weight, load.source) {
            (Weight::Force | Weight::Volume, _) => weight_and_size(load.weight),
            // Rounding of a lever is relative to what it is the difference of.
            (Weight::Moment, _) => (
                load.weight * (load.z - self.reference),
                load.weight.abs() * (load.z.abs() + self.reference.abs()),
            ),
            (Weight::ArmX, _) => weight_and_size(load.weight * load.axis.re),
            (Weight::ArmY, _) => weight_and_size(load.weight * load.axis.im),
            (Weight::Torque, Source::Piston { second_moment, .. }) => {
                weight_and_size(second_moment)
            }
            (Weight::Rod, Source::Piston { rod_inertia, .. }) => weight_and_size(rod_inertia),
            (Weight::Torque | Weight::Rod, _) => (0.0, 0.0),
        };
        sum.value += times.of(*unit) * weight;
        sum.size += 0.5 * f64::from(times.halves) * size;
    }
}

impl Times {
    /// A complex number times this factor.
    pub fn of(self, unit: Complex64) -> Complex64 {
        let half = 0.5 * f64::from(self.halves);
        half * match self.quarters.rem_euclid(4) {
            0 => unit,
            1 => Complex64::new(-unit.im, unit.re),
            2 => -unit,
            _ => Complex64::new(unit.im, -unit.re),
        }
    }
}

impl Term<PhasorSum> {
    /// Force and moment.
    pub fn planar(&self) -> [Planar; 2] {
        [&self.force, &self.moment].map(|[forward, backward_conj]| Planar {
            forward: forward.value,
            backward_conj: backward_conj.value,
            size: forward.size + backward_conj.size,
        })
    }
}

impl Load {
    /// The order of an unbalance.
    pub fn unbalance_order(&self) -> Option<Order> {
        let order = Order::whole(self.ratio.unsigned_abs()).ok()?;
        (self.source == Source::Unbalance).then_some(order)
    }

    /// Whether it has a part at this order.
    fn acts_at(&self, order: Order) -> bool {
        match self.source {
            Source::Piston { .. } => order.halves().is_multiple_of(2 * self.ratio.unsigned_abs()),
            Source::Unbalance => order.halves() == 2 * self.ratio.unsigned_abs(),
            Source::Pressure { .. } => true,
        }
    }

    /// Whether it has a forward part, or a backward part.
    pub fn has_part(&self, forward: bool) -> bool {
        self.source != Source::Unbalance || forward == (self.ratio > 0)
    }
}

/// Multiples of δ/2 in the phase by which the parts of a bank's loads change at one order as it turns by δ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Turn {
    pub forward: i64,
    pub backward_conj: i64,
    pub roll: i64,
}

impl Turn {
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
