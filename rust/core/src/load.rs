//! Every load of an engine, in one list, and their superposition order by order.
//!
//! A load has an amplitude, a direction in the cross-section, a crank angle at which it points that
//! way, and a place along the crank. At order n, with β the direction and φ that crank angle:
//!
//! - a piston of amplitude A = m·r·aₙ has the forward part ½·A·e^{i(β − nφ)} and the backward part
//!   conj(½·A·e^{−i(β + nφ)}); its torques are amplitudes times e^{−inφ};
//! - an unbalance U on a shaft of ratio ρ has ρ²·U·e^{i(β − φ)} at order |ρ|, all of it forward if
//!   ρ > 0, backward if ρ < 0; about the crank axis an axis at a = x + iy makes a roll torque of
//!   Im(ā·F).
//!
//! The moment is i·(z − z₀) times the force. When a bank turns by δ, whatever belongs to it is
//! multiplied as [`Turn`] says. Balances, waveforms, sweeps and proofs read this list.

use crate::Complex64;
use crate::engine::{Engine, Hold, first_equal};
use crate::gear::slider_crank::Cylinder;
use crate::numbers::angle::Angle;
use crate::wrench::Planar;

/// Origin of a load's amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Source {
    /// A piston and its rod.
    Piston {
        /// Index into [`Loads::motions`].
        motion: usize,
        /// m·r², kg·m²: weight of the torques of the masses.
        second_moment: f64,
        /// Weight of the torques of the rod's inertia, kg·m².
        rod_inertia: f64,
    },
    /// A mass off the axis of a shaft.
    Unbalance {
        /// Speed of the shaft over crank speed.
        ratio: i32,
        /// Place of the shaft's axis, x + iy, m.
        axis: Complex64,
    },
}

/// A periodic load on the engine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Load {
    pub source: Source,
    /// m·r of a piston, the unbalance of a shaft, kg·m.
    pub weight: f64,
    /// Direction of the force when the crank stands at `phase`, from +x.
    pub direction: Angle,
    /// Unit vector of that direction, x + iy.
    unit: Complex64,
    /// Crank angle.
    pub phase: Angle,
    /// Place along the crank, m.
    pub z: f64,
    /// Bank that it belongs to: that of a piston, or of a crankpin's piston.
    pub bank: Option<usize>,
}

/// Factor of the sums, which depends on the order and on the running gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) enum Channel {
    /// 1: unbalances.
    #[default]
    Unit,
    /// Harmonics of the force or of the torque of a motion's masses.
    Masses(usize),
    /// Harmonics of the torque of a motion's rod inertia.
    Rod(usize),
}

/// Sum of the loads of one channel and bank at one order, over ω² and the channel's factor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlanarSum {
    pub channel: Channel,
    pub bank: Option<usize>,
    pub force: Planar,
    pub moment: Planar,
}

/// The same of torque; size is Σ|terms|.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RollSum {
    pub channel: Channel,
    pub bank: Option<usize>,
    pub sum: Complex64,
    pub size: f64,
}

/// Which pistons share a motion, hence their harmonics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Alike {
    /// Those of equal rod ratio and relative pin offset.
    Proportions,
    /// Those of equal crank radius, rod length and pin offset.
    Dimensions,
    /// All: a spectrum replaces the slider-cranks.
    All,
}

/// All loads of an engine about a reference plane.
pub(crate) struct Loads {
    pub list: Vec<Load>,
    /// One gear of each motion.
    pub motions: Vec<Cylinder>,
    /// Reference plane z₀ of moments, m.
    pub reference: f64,
}

impl Loads {
    /// Loads of an engine. Where all pistons are alike they have weight 1: a spectrum in kg·m has the
    /// mass and the radius in it.
    pub fn new(engine: &Engine, reference: f64, alike: Alike) -> Self {
        let gears = engine.gears();
        let motion_of = match alike {
            Alike::Proportions => first_equal(gears.iter().map(Cylinder::proportions)),
            Alike::Dimensions => {
                let sizes = |c: &Cylinder| (c.crank_radius(), c.rod_length(), c.pin_offset());
                first_equal(gears.iter().map(sizes))
            }
            Alike::All => vec![0; gears.len()],
        };
        let mut motions: Vec<Cylinder> = Vec::new();
        for (&motion, &gear) in motion_of.iter().zip(gears) {
            if motion == motions.len() {
                motions.push(gear);
            }
        }
        let pistons = engine.placements().iter().enumerate().map(|(i, place)| {
            let cylinder = place.cylinder;
            Load {
                source: Source::Piston {
                    motion: motion_of[engine.gear_of(i)],
                    second_moment: cylinder.second_moment(),
                    rod_inertia: cylinder.rod_inertia_excess(),
                },
                weight: if alike == Alike::All { 1.0 } else { cylinder.first_order() },
                direction: place.bank,
                unit: place.bank.cis(1),
                phase: place.tdc,
                z: place.z,
                bank: Some(engine.bank_of(i)),
            }
        });
        let on_crank = engine.crank_unbalances().map(|unbalance| {
            // A crankpin points along its bore at top dead centre.
            let pin = unbalance.pin.map(|i| (engine.placements()[i], engine.bank_of(i)));
            let direction = unbalance.angle + pin.map_or(Angle::ZERO, |(place, _)| place.bank);
            Load {
                source: Source::Unbalance { ratio: 1, axis: Complex64::default() },
                weight: unbalance.amount,
                direction,
                unit: direction.cis(1),
                phase: pin.map_or(Angle::ZERO, |(place, _)| place.tdc),
                z: unbalance.z,
                bank: pin.map(|(_, bank)| bank),
            }
        });
        let on_shafts = engine.shafts().iter().flat_map(|shaft| {
            shaft.unbalances.iter().map(|unbalance| Load {
                source: Source::Unbalance {
                    ratio: shaft.ratio,
                    axis: Complex64::new(shaft.axis[0], shaft.axis[1]),
                },
                weight: unbalance.amount,
                direction: unbalance.angle,
                unit: unbalance.angle.cis(1),
                phase: Angle::ZERO,
                z: unbalance.z,
                bank: None,
            })
        });
        Self { list: pistons.chain(on_crank).chain(on_shafts).collect(), motions, reference }
    }

    /// Longest lever of any load about the reference plane, m.
    pub fn longest_lever(&self) -> f64 {
        self.list.iter().map(|load| (load.z - self.reference).abs()).fold(0.0, f64::max)
    }

    /// Whole orders at which unbalances act, ascending.
    pub fn unbalance_orders(&self) -> Vec<u32> {
        let mut orders: Vec<u32> = self.list.iter().filter_map(Load::unbalance_order).collect();
        orders.sort_unstable();
        orders.dedup();
        orders
    }

    /// Force and moment of one whole order, by channel, and by bank where `by_bank`.
    pub fn planar(&self, order: u32, by_bank: bool) -> Vec<PlanarSum> {
        self.sums(order, by_bank, [true, false]).0
    }

    /// Torque of one whole order, by channel, and by bank where `by_bank`.
    pub fn roll(&self, order: u32, by_bank: bool) -> Vec<RollSum> {
        self.sums(order, by_bank, [false, true]).1
    }

    /// Force and moment, and torque, as far as each is wanted.
    pub fn sums(
        &self,
        order: u32,
        by_bank: bool,
        [planar, roll]: [bool; 2],
    ) -> (Vec<PlanarSum>, Vec<RollSum>) {
        let (mut planar_sums, mut roll_sums) = (Vec::new(), Vec::new());
        for load in &self.list {
            let Some(phase) = load.phasor(order) else { continue };
            let bank = load.bank.filter(|_| by_bank);
            if planar {
                self.add_planar(&mut planar_sums, load, bank, phase);
            }
            if roll {
                load.add_roll(&mut roll_sums, bank, phase);
            }
        }
        (planar_sums, roll_sums)
    }

    fn add_planar(
        &self,
        sums: &mut Vec<PlanarSum>,
        load: &Load,
        bank: Option<usize>,
        phase: Complex64,
    ) {
        let (channel, unit) = load.planar(phase);
        let known = sums.iter().position(|sum| (sum.channel, sum.bank) == (channel, bank));
        let known = known.unwrap_or_else(|| {
            let zero = Planar::default();
            sums.push(PlanarSum { channel, bank, force: zero, moment: zero });
            sums.len() - 1
        });
        let sum = &mut sums[known];
        sum.force.add(&unit.scaled(load.weight));
        let levered = unit.scaled(load.weight * (load.z - self.reference));
        // Rounding of a lever is relative to what it is the difference of.
        let size = unit.size * load.weight * (load.z.abs() + self.reference.abs());
        sum.moment.add(&Planar { size, ..levered.quarter_turned() });
    }
}

impl Load {
    /// Unit vector of its direction, x + iy.
    pub fn unit(&self) -> Complex64 {
        self.unit
    }

    /// The order of an unbalance.
    pub fn unbalance_order(&self) -> Option<u32> {
        match self.source {
            Source::Unbalance { ratio, .. } => Some(ratio.unsigned_abs()),
            Source::Piston { .. } => None,
        }
    }

    /// `e^{−inφ}` of a piston at order n, and of an unbalance at its own order.
    ///
    /// Where its crankpin stands δ further ahead, φ is less by δ: of a load that follows the pin this is
    /// multiplied by `e^{inδ}` (n = 1 of an unbalance).
    pub fn phasor(&self, order: u32) -> Option<Complex64> {
        match self.source {
            Source::Piston { .. } => Some(self.phase.cis(-i64::from(order))),
            Source::Unbalance { ratio, .. } => {
                (ratio.unsigned_abs() == order).then(|| self.phase.cis(-1))
            }
        }
    }

    /// Force over ω², weight and the channel's factor, given its [`Load::phasor`].
    pub fn planar(&self, phase: Complex64) -> (Channel, Planar) {
        match self.source {
            Source::Piston { motion, .. } => {
                let half = phase * 0.5;
                let (forward, backward_conj) = (half * self.unit, half * self.unit.conj());
                (Channel::Masses(motion), Planar { forward, backward_conj, size: 1.0 })
            }
            Source::Unbalance { ratio, .. } => {
                let size = f64::from(ratio) * f64::from(ratio);
                let (at_start, zero) = (self.unit * phase * size, Complex64::default());
                let (forward, backward_conj) =
                    if ratio > 0 { (at_start, zero) } else { (zero, at_start.conj()) };
                (Channel::Unit, Planar { forward, backward_conj, size })
            }
        }
    }

    /// Adds the roll torque over ω² and the channel's factor.
    fn add_roll(&self, sums: &mut Vec<RollSum>, bank: Option<usize>, phase: Complex64) {
        let mut add = |channel, phasor: Complex64, size: f64| match sums
            .iter_mut()
            .find(|sum| (sum.channel, sum.bank) == (channel, bank))
        {
            Some(known) => {
                known.sum += phasor;
                known.size += size;
            }
            None => sums.push(RollSum { channel, bank, sum: phasor, size }),
        };
        match self.source {
            Source::Piston { motion, second_moment, rod_inertia } => {
                add(Channel::Masses(motion), phase * second_moment, second_moment);
                if rod_inertia != 0.0 {
                    add(Channel::Rod(motion), phase * rod_inertia, rod_inertia.abs());
                }
            }
            Source::Unbalance { axis, .. } if axis == Complex64::default() => {}
            Source::Unbalance { axis, .. } => {
                // Im(ā·F) of F = P·e^{inθ} is Re(−i·ā·P·e^{inθ}), of F = conj(P·e^{inθ}) it is
                // Re(i·a·P·e^{inθ}).
                let (i, (channel, unit)) = (Complex64::i(), self.planar(phase));
                let phasor = -i * axis.conj() * unit.forward + i * axis * unit.backward_conj;
                add(channel, phasor * self.weight, unit.size * self.weight * axis.norm());
            }
        }
    }
}

/// Multiples of δ by whose unit phasors a bank's loads of one order are multiplied as it turns by δ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Turn {
    pub forward: i64,
    pub backward_conj: i64,
    pub roll: i64,
}

impl Turn {
    /// With pins held, a bore takes its top dead centres along; with the firing held it does not.
    pub fn new(order: u32, hold: Hold) -> Self {
        let n = i64::from(order);
        match hold {
            Hold::Pins => Self { forward: 1 - n, backward_conj: -1 - n, roll: -n },
            Hold::Firing => Self { forward: 1, backward_conj: -1, roll: 0 },
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
