//! The terms of an engine's sums: of every quantity and order, each load's weight, root of unity and
//! symbol.

use std::sync::Arc;

use super::super::roots::{FormalSum, PartOfTurn, Share, SymbolEntry, parts_of_turn};
use super::super::{ExactLoads, ExactMotion, Levers, MotionIndex, too_long};
use super::ProofQuantity;
use crate::engine::Engine;
use crate::load::{self, Harmonic, Load, LoadIndex, Scene, SourceIndex, Wanted, superpose};
use crate::mechanism::articulated::RunningGear;
use crate::mechanism::exact::{Rest, TorqueKey};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::index::{List, distinct, list_index};
use crate::numbers::order::Order;
use crate::numbers::rational::{Multiples, Ratio, product};
use crate::source::{Column, ExactFactor, Repeats};

list_index! {
    /// Index of a running gear with the speed of its crank, whichever its sense, among those that differ.
    pub(in crate::readings::exact) DrivenCylinderIndex
}

/// Harmonic by which a sum is multiplied; of pin offsets the odd parts apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) enum Channel {
    /// 1: the first order of pistons without offset, and unbalances.
    #[default]
    One,
    /// Of the force of a motion.
    Force(MotionIndex),
    /// Torque of a motion; whether its odd part.
    Torque(MotionIndex, TorqueKey, bool),
    /// All torque of a running gear; whether its odd part.
    Gear(DrivenCylinderIndex, bool),
    /// Torque of a source that couples motions.
    Coupling(SourceIndex),
}

/// Lists of weights that have no rational relation to each other's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) enum SymbolWeights {
    /// m·r and unbalances, kg·m.
    #[default]
    Planar,
    /// m·r² and rod inertia, kg·m², each with its own kind.
    Roll,
    /// m·r or unbalance times x or y of the axis of its crank or shaft, kg·m².
    Arm,
    /// 1.
    Gear,
}

/// What a sum of roots of unity is multiplied by: indices of symbols.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) struct Symbol {
    pub channel: Channel,
    /// Unit of weight.
    pub weight: (SymbolWeights, usize),
    /// Unit of length.
    pub lever: usize,
    /// Direction that is no simple part of a turn, 0 for others.
    pub direction: (usize, SymbolEntry),
    /// Phase that is none.
    pub phase: usize,
}

/// A load's part of a sum: weight times the root of unity at `turns`.
pub(super) struct SymbolTerm {
    pub symbol: Symbol,
    pub turns: Ratio,
    pub weight: Ratio,
}

/// How the harmonics of cylinders of different proportions are distinguished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct View {
    /// Real and imaginary parts apart, of which a mirrored pin offset changes some signs:
    /// `a₁ = 1 + ib`, even orders are real and even in the offset, odd ones above imaginary and odd in
    /// it. Otherwise a complex number for each set of proportions.
    pub parts: bool,
    /// Torque by whole running gears, all of whose torques have one phase.
    pub gears: bool,
}

/// Units of weight and of length, and how many of them.
type Amount = ((SymbolWeights, usize), usize, Ratio);

/// Sums of one order, by harmonic.
pub(super) type SymbolSums = Vec<load::Term<Vec<Share>>>;

/// Everything about an engine that does not depend on the order.
pub(super) struct Proof {
    pub loads: Scene,
    /// Motions, of proportions and speed of a crank.
    pub motions: List<MotionIndex, ExactMotion>,
    /// Motion of each source that has one.
    motion_of: List<SourceIndex, Option<MotionIndex>>,
    pub roots: FormalSum,
    /// Directions, equal ones by one symbol.
    bores: List<LoadIndex, PartOfTurn>,
    /// For each list of weights, unit and multiple of every load; of arms along x and y.
    planar: List<LoadIndex, (usize, Ratio)>,
    rolls: List<LoadIndex, (usize, Ratio)>,
    arms: List<LoadIndex, [(usize, Ratio); 2]>,
    /// Number of units of m·r and unbalances.
    pub planar_units: usize,
    pub levers: Levers,
    /// For each motion the first of its size but for the sign of the offset.
    mirrored: List<MotionIndex, MotionIndex>,
    /// Running gears that differ, each with the speed of its crank, whichever its sense.
    pub gears: List<DrivenCylinderIndex, (RunningGear, u32)>,
    /// Running gear of each load of a cylinder, and the first of its size but for the sign of the offset.
    distinct_cylinder_of: List<LoadIndex, Option<[DrivenCylinderIndex; 2]>>,
}

impl Proof {
    /// Of an engine, with which it is kept.
    pub fn of(engine: &Engine, reference: Option<f64>, cancel: &Cancel) -> Result<Arc<Self>> {
        type Known = (Option<f64>, Arc<Proof>);
        let is_such = |(own, _): &Known| own.map(f64::to_bits) == reference.map(f64::to_bits);
        let new = || Ok((reference, Arc::new(Self::new(engine, reference, cancel)?)));
        Ok(Arc::clone(&Scene::of(engine, reference)?.kept.get(is_such, new)?.1))
    }

    fn new(engine: &Engine, reference: Option<f64>, cancel: &Cancel) -> Result<Self> {
        let ExactLoads { loads, motions, motion_of } = ExactLoads::new(engine, reference)?;
        let levers = Levers::new(engine, &loads, reference, cancel)?;
        let weights = |of: &dyn Fn(&Load) -> f64| {
            Multiples::new(&loads.list.iter().map(of).collect::<Vec<_>>(), cancel)
        };
        let planar = weights(&|load| load.weight)?;
        let mut rolls = loads.list.map_to(|_| (0, Ratio::ZERO));
        let of_motions = TorqueKey::ALL.map(ExactFactor::Motion);
        for factor in of_motions.into_iter().chain([ExactFactor::Coupling]) {
            let is_own = |load: &Load| loads.source(load).exact() == factor;
            let own = weights(&|load| if is_own(load) { load.roll } else { 0.0 })?.of;
            for ((roll, load), own) in rolls.iter_mut().zip(&loads.list).zip(own) {
                if is_own(load) {
                    *roll = own;
                }
            }
        }
        let arm = |load: &Load| {
            let axis = load.place.axis;
            [axis.re, axis.im].map(|arm| load.weight * arm)
        };
        let arms: Vec<f64> = loads.list.iter().flat_map(arm).collect();
        let arms = Multiples::new(&arms, cancel)?.of;
        let bores = loads.list.iter().map(|load| load.place.direction);
        let mirrored = motions.first_equal(|motion| (motion.key.figures.clone(), motion.speed));
        let driven = |i: usize| {
            let crank = engine.cranks()[engine.crank_of(i)];
            (engine.running_gear(i), crank.ratio.halves_of_speed())
        };
        let (gears, of_cylinder) =
            distinct::<DrivenCylinderIndex, _>((0..engine.stations().len()).map(driven));
        let first_of_size = gears.first_equal(|(gear, speed)| {
            let (linked, gear) =
                (gear.knuckle.map(|_| gear.mechanism().key().figures), gear.cylinder);
            let inertia = gear.rod_inertia_excess();
            let offset = gear.pin_offset().abs();
            let mass = gear.reciprocating_mass();
            let sizes = [gear.crank_radius(), gear.rod_length(), offset, mass, inertia];
            (sizes, linked, *speed)
        });
        let of_size = |i: usize| [of_cylinder[i], first_of_size[of_cylinder[i]]];
        let distinct_cylinder_of = loads.list.map_to(|load| {
            let own = load.place.origin.cylinder().filter(|_| !load.place.at_knuckle);
            own.map(of_size)
        });
        Ok(Self {
            roots: FormalSum::new(&loads, cancel)?,
            bores: parts_of_turn(bores, false, cancel)?,
            planar_units: planar.units.len(),
            planar: List::new(planar.of),
            rolls,
            arms: List::new(arms.as_chunks().0.to_vec()),
            levers,
            mirrored,
            motions,
            motion_of,
            distinct_cylinder_of,
            gears,
            loads,
        })
    }

    pub fn sums(&self, order: Order) -> SymbolSums {
        let wanted = Wanted { planar: true, roll: true, by_bank: false };
        superpose(&self.roots, &self.loads.list, order, wanted)
    }

    /// Whether some of its loads have half orders.
    pub fn has_half_orders(&self) -> bool {
        self.loads.list.iter().any(|load| load.parts.repeats == Repeats::EveryTwoTurns)
    }

    /// Channels of a piston's force and their signs; none where its harmonic is zero.
    fn force_channels(
        &self,
        motion: MotionIndex,
        order: Order,
        view: View,
    ) -> Vec<(Channel, i128)> {
        use Channel::{Force, One};
        let (of, mirrored) = (&self.motions[motion], self.mirrored[motion]);
        let known = of.mechanism.exact_force(of.own_order(order));
        if known.rest == Rest::Both || known.rest.exists() && !view.parts {
            return vec![(Force(motion), 1)];
        }
        let [whole, rest] = [(One, 1), (Force(mirrored), 1)];
        let odd = (Force(mirrored), self.sign(motion));
        let [has_even, has_odd] = known.rest.parts();
        let parts = [(known.crank, whole), (has_even, rest), (has_odd, odd)];
        parts.into_iter().filter_map(|(has, part)| has.then_some(part)).collect()
    }

    /// Sign of parts that are odd in the side of an offset.
    fn sign(&self, motion: MotionIndex) -> i128 {
        if self.motions[motion].key.is_mirrored { -1 } else { 1 }
    }

    /// Channels of a torque and their signs: of a motion or of a running gear, `own` or the first of
    /// its size.
    fn torque_channels<I: Copy>(
        &self,
        (motion, load): (MotionIndex, LoadIndex),
        order: Order,
        view: View,
        channel: impl Fn(I, bool) -> Channel,
        [own, mirrored]: [I; 2],
    ) -> Vec<(Channel, i128)> {
        let of = &self.motions[motion];
        let known = of.mechanism.exact_torque(of.own_order(order));
        // A crank that turns the other way mirrors the torque on the block.
        let sense = i128::from(self.loads.list[load].place.ratio.sense());
        // T(θ) of an offset is −T(−θ) of the opposite one: sines are even in it.
        let [has_even, has_odd] = known.rest.parts();
        let even = (has_even, (channel(mirrored, false), sense));
        let odd = (has_odd, (channel(mirrored, true), sense * self.sign(motion)));
        let parts = [even, odd].into_iter().filter_map(|(has, part)| has.then_some(part));
        if view.parts || !known.rest.exists() {
            parts.collect()
        } else {
            vec![(channel(own, false), sense)]
        }
    }

    /// Channels and their signs of one load's share of a sum.
    fn channels(
        &self,
        harmonic: Harmonic,
        share: &Share,
        order: Order,
        view: View,
    ) -> Vec<(Channel, i128)> {
        let both = |motion: MotionIndex| [motion, self.mirrored[motion]];
        let Some(motion) = self.motion_of[harmonic.source] else { return vec![(Channel::One, 1)] };
        let at = (motion, share.load);
        match (harmonic.column, self.exact(share.load)) {
            (Column::Force, _) => self.force_channels(motion, order, view),
            (Column::Roll, _) if self.is_by_gears(share.load, view) => {
                // Once for each gear: with the force.
                let has_force = self.loads.list[share.load].parts.force.is_some();
                let of_gear = self.distinct_cylinder_of[share.load].filter(|_| has_force);
                let of = |of_gear| self.torque_channels(at, order, view, Channel::Gear, of_gear);
                of_gear.map_or_else(Vec::new, of)
            }
            (Column::Roll, ExactFactor::Motion(key)) => {
                let channel = |motion, is_odd| Channel::Torque(motion, key, is_odd);
                self.torque_channels(at, order, view, channel, both(motion))
            }
            (Column::Roll, ExactFactor::Coupling) => {
                let own = self.motions[motion].own_order(order);
                let has = |n| n == 0 || self.motions[motion].mechanism.exact_force(n).exists();
                let acts = has(own - 1) || has(own + 1);
                acts.then_some((Channel::Coupling(harmonic.source), 1)).into_iter().collect()
            }
            (Column::Roll, _) => vec![],
        }
    }

    /// Whether the torque of a load is counted with its running gear, of which a mass at a knuckle is no part.
    fn is_by_gears(&self, load: LoadIndex, view: View) -> bool {
        view.gears && !self.loads.list[load].place.at_knuckle
    }

    /// Factor of a load.
    fn exact(&self, load: LoadIndex) -> ExactFactor {
        self.loads.source(&self.loads.list[load]).exact()
    }

    /// Weights of one load's share of a sum, with their units and those of its levers.
    fn weights(&self, share: &Share, view: View) -> Result<Vec<Amount>> {
        use load::Weight;
        let i = share.load;
        let (list, (unit, weight)) = match share.weight {
            Weight::Force | Weight::Moment => (SymbolWeights::Planar, self.planar[i]),
            Weight::Roll if self.is_by_gears(i, view) => (SymbolWeights::Gear, (0, Ratio::ONE)),
            Weight::Roll => (SymbolWeights::Roll, self.rolls[i]),
            Weight::ArmX => (SymbolWeights::Arm, self.arms[i][0]),
            Weight::ArmY => (SymbolWeights::Arm, self.arms[i][1]),
        };
        let weight = product(weight, Ratio::from(i128::from(share.eighths)));
        let weight = weight.ok_or_else(too_long)?;
        if share.weight != Weight::Moment {
            return Ok(vec![((list, unit), 0, weight)]);
        }
        let levered = |&(lever, factor): &(usize, Ratio)| {
            Ok(((list, unit), lever, product(weight, factor).ok_or_else(too_long)?))
        };
        self.levers.of[i].iter().map(levered).collect()
    }

    /// The terms of a quantity, all times one number that is not zero.
    pub fn terms(
        &self,
        sums: &SymbolSums,
        quantity: ProofQuantity,
        order: Order,
        view: View,
    ) -> Result<Vec<SymbolTerm>> {
        let mut terms = Vec::new();
        for sum in sums {
            for (shares, sign) in quantity.shares(sum) {
                for share in shares {
                    let Some(share) = self.component(quantity, share) else { continue };
                    for (weight, lever, amount) in self.weights(&share, view)? {
                        for (channel, of_channel) in
                            self.channels(sum.harmonic, &share, order, view)
                        {
                            // Both signs are 1 or −1.
                            let amount = if sign == of_channel { amount } else { -amount };
                            if amount == Ratio::ZERO {
                                continue;
                            }
                            let root = share.root;
                            let symbol = Symbol {
                                channel,
                                weight,
                                lever,
                                direction: root.direction,
                                phase: root.phase,
                            };
                            terms.push(SymbolTerm { symbol, turns: root.turns, weight: amount });
                        }
                    }
                }
            }
        }
        Ok(terms)
    }

    /// A share, in which the forward and the backward part of a piston along (about) x or y are one
    /// where its bore is a symbol.
    fn component(&self, quantity: ProofQuantity, share: &Share) -> Option<Share> {
        let piston = !self.loads.list[share.load].is_turning();
        let bore = self.bores[share.load];
        if !quantity.is_component() || !piston || bore.symbol == 0 {
            return Some(*share);
        }
        // All of one bore are turned alike.
        let mut component = *share;
        component.root.direction = (bore.symbol, SymbolEntry::Component);
        (share.root.direction.1 == SymbolEntry::UnityRoot).then_some(component)
    }
}

impl ProofQuantity {
    /// Along (about) x or y.
    fn is_component(self) -> bool {
        matches!(self, Self::ForceX | Self::ForceY | Self::MomentX | Self::MomentY)
    }

    /// What of a sum it is made of, with signs: forward and conjugate backward parts add up to the
    /// part along x, and differ by i times that along y.
    fn shares(self, sum: &load::Term<Vec<Share>>) -> Vec<(&Vec<Share>, i128)> {
        let load::Term { force: [f, b], moment: [m, n], roll, .. } = sum;
        match self {
            Self::ForceX => vec![(f, 1), (b, 1)],
            Self::ForceY => vec![(f, 1), (b, -1)],
            Self::ForceForward => vec![(f, 1)],
            Self::ForceBackward => vec![(b, 1)],
            Self::MomentX => vec![(m, 1), (n, 1)],
            Self::MomentY => vec![(m, 1), (n, -1)],
            Self::MomentForward => vec![(m, 1)],
            Self::MomentBackward => vec![(n, 1)],
            Self::Torque => vec![(roll, 1)],
            Self::GasTorque => vec![],
        }
    }
}
