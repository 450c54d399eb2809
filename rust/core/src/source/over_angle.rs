//! A block of crank angles, the values of loads there, and what of the loads of a source acts together.

use std::borrow::Cow;
use std::cell::{RefCell, RefMut};
use std::ops::Range;

use crate::Complex64;
use crate::mechanism::DrivenMechanism;
use crate::mechanism::motion::{CrankColumns, CrankPosition, Cranks, MotionColumns};
use crate::numbers::angle::Angle;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::numbers::simd::vectorised;

/// Crank angles evaluated side by side.
pub(crate) const BLOCK: usize = 256;

/// One value for each crank angle of a block.
pub(crate) type AngleColumn = [f64; BLOCK];

/// Values at a block of crank angles; whole lines of the cache.
#[repr(align(64))]
pub struct Columns {
    /// Along x and y.
    pub(crate) force: [AngleColumn; 2],
    /// About x and y.
    pub(crate) moment: [AngleColumn; 2],
    /// On the block and on the main crank.
    pub(crate) torque: [AngleColumn; 2],
}

/// Quantities to evaluate.
#[derive(Debug, Clone, Copy)]
pub struct Quantities {
    pub(crate) force: bool,
    pub(crate) moment: bool,
    /// Torques.
    pub(crate) torque: bool,
}

/// Weights of the loads of one source and phase, summed.
pub struct LoadSum {
    pub(crate) phase: Angle,
    /// Whether the phase is half the crank angle, which half orders turn by whole numbers.
    pub(crate) halved: bool,
    /// Speed of their crank or shaft.
    pub(crate) ratio: SpeedRatio,
    /// Crank angle of the phase, degrees.
    pub(crate) phase_deg: f64,
    /// `e^{−iφ}` of the angle of their own crank at which the phase stands.
    pub(crate) turned: Complex64,
    /// Force and moment, x + iy, in their direction, over ω².
    pub(crate) force: Complex64,
    pub(crate) moment: Complex64,
    /// The force's torque about the main crank's axis, as the imaginary part.
    pub(crate) arm: Complex64,
    /// Weight of the torque.
    pub(crate) roll: f64,
    /// Whether there is another of the same source half a turn of their crank away.
    pub(crate) has_opposite: bool,
}

impl LoadSum {
    /// `e^{−inφ}` of an order.
    pub(crate) fn lag(&self, order: Order) -> Complex64 {
        let halves = i64::from(order.halves());
        self.phase.cis(if self.halved { -halves } else { -halves / 2 })
    }
}

/// Adds the moment of inertia of loads whose velocity and acceleration per unit of crank speed a function
/// fills in, and its slope: with I the kinetic energy is ½I·ω², and inertia torque −½I′·ω².
pub(crate) fn add_inertia(
    driven: &DrivenMechanism,
    sum: &LoadSum,
    angles: &CrankAngles,
    [inertia, slope]: [&mut [f64]; 2],
    motions: impl Fn(&Cranks, [&mut [f64]; 2]),
) {
    let units = Units::at_speed(angles, 0..angles.len(), driven.ratio);
    let [_, speed] = driven.senses();
    let [mut velocities, mut accelerations] = [[0.0; BLOCK]; 2];
    motions(&units.cranks(sum.turned), [&mut velocities, &mut accelerations]);
    for i in 0..angles.len() {
        let [velocity, acceleration] = [velocities[i], accelerations[i]];
        inertia[i] += sum.roll * velocity * velocity;
        slope[i] += 2.0 * speed * sum.roll * velocity * acceleration;
    }
}

impl Columns {
    pub(crate) const ZERO: Self =
        Self { force: [[0.0; BLOCK]; 2], moment: [[0.0; BLOCK]; 2], torque: [[0.0; BLOCK]; 2] };

    /// Adds the wanted ones of other columns.
    pub(crate) fn add(&mut self, other: &Self, wanted: Quantities) {
        let force = self.force.iter_mut().zip(&other.force).filter(|_| wanted.force);
        let moment = self.moment.iter_mut().zip(&other.moment).filter(|_| wanted.moment);
        let torque = self.torque.iter_mut().zip(&other.torque).filter(|_| wanted.torque);
        for (into, from) in force.chain(moment).chain(torque) {
            into.iter_mut().zip(from).for_each(|(into, from)| *into += from);
        }
    }

    /// The wanted ones of other columns in place of these.
    pub(crate) fn copy(&mut self, from: &Self, wanted: Quantities) {
        if wanted.force {
            self.force.clone_from_slice(&from.force);
        }
        if wanted.moment {
            self.moment.clone_from_slice(&from.moment);
        }
        if wanted.torque {
            self.torque.clone_from_slice(&from.torque);
        }
    }
}

/// Positions of a crank of some speed and phase.
type CranksOfPhase = (SpeedRatio, Complex64, Box<CrankColumns<BLOCK>>);

/// A block of crank angles.
pub struct AngleBlock<'a> {
    angles: &'a CrankAngles,
    range: Range<usize>,
    main: Units,
    /// Positions of cranks by speed and phase, if they are kept.
    kept: Option<RefCell<Vec<CranksOfPhase>>>,
    scratch: RefCell<[AngleColumn; 2]>,
    opposites: RefCell<Vec<OppositeMotion>>,
}

/// Motion that was evaluated beside that half a turn away.
struct OppositeMotion {
    /// Of which, and `e^{−iφ}` of its phase, until it is used.
    of: Option<(DrivenMechanism, Complex64)>,
    /// Velocity and acceleration.
    columns: Box<[AngleColumn; 2]>,
}

impl<'a> AngleBlock<'a> {
    /// These of the angles, at most [`BLOCK`].
    pub(crate) fn new(angles: &'a CrankAngles, range: Range<usize>) -> Self {
        let main = Units::new(angles, range.clone(), Order::FIRST);
        let scratch = RefCell::new([[0.0; BLOCK]; 2]);
        Self { angles, range, main, kept: None, scratch, opposites: RefCell::default() }
    }

    /// The same block, which keeps positions of cranks: for many rods.
    pub(crate) fn shared(self) -> Self {
        Self { kept: Some(RefCell::default()), ..self }
    }

    /// Columns for what is overwritten.
    pub(crate) fn scratch(&self) -> RefMut<'_, [AngleColumn; 2]> {
        self.scratch.borrow_mut()
    }

    /// Hands velocity, if that is wanted, and acceleration of a mechanism at the phase of a sum to a function.
    /// Of phases half a turn apart both are evaluated with the first.
    pub(crate) fn with_motion(
        &self,
        driven: &DrivenMechanism,
        sum: &LoadSum,
        wants_velocity: bool,
        work: impl FnOnce(&[AngleColumn; 2]),
    ) {
        let mut scratch = self.scratch.borrow_mut();
        let mut opposites = self.opposites.borrow_mut();
        let shares = sum.has_opposite && driven.mechanism.has_cheap_opposites();
        let is_such = |own: &&mut OppositeMotion| {
            own.of.as_ref().is_some_and(|(of, turned)| *turned == sum.turned && of == driven)
        };
        if shares && let Some(known) = opposites.iter_mut().find(is_such) {
            known.of = None;
            return work(&known.columns);
        }
        let free = opposites.iter().position(|own| own.of.is_none()).filter(|_| shares);
        let place = free.unwrap_or(opposites.len());
        if shares && free.is_none() {
            opposites.push(OppositeMotion { of: None, columns: Box::new([[0.0; BLOCK]; 2]) });
        }
        let [velocity, acceleration] = &mut *scratch;
        let mut motion = MotionColumns::of(acceleration);
        motion.velocity = (wants_velocity || shares).then_some(&mut velocity[..]);
        if shares {
            let OppositeMotion { of, columns } = &mut opposites[place];
            *of = Some((driven.clone(), -sum.turned));
            motion.opposite = Some(columns.each_mut().map(|column| &mut column[..]));
        }
        let ratio = sum.ratio;
        self.with_cranks(ratio, sum.turned, |cranks| driven.mechanism.motions(cranks, motion));
        work(&scratch);
    }

    /// Hands positions of a crank at some multiple of the angles that is `phase` ahead to a function.
    pub(crate) fn with_cranks(
        &self,
        ratio: SpeedRatio,
        phase: Complex64,
        work: impl FnOnce(&Cranks),
    ) {
        let Some(kept) = &self.kept else { return work(&self.units(ratio).cranks(phase)) };
        let is_such = |(own, turned, _): &CranksOfPhase| (*own, *turned) == (ratio, phase);
        let mut kept = kept.borrow_mut();
        let place = kept.iter().position(is_such).unwrap_or_else(|| {
            let (units, mut cranks) = (self.units(ratio), CrankColumns::ZERO);
            vectorised(
                #[inline(always)]
                || cranks.set(&units.cos, &units.sin, phase),
            );
            kept.push((ratio, phase, cranks.into()));
            kept.len() - 1
        });
        work(&kept[place].2.cranks());
    }

    /// `e^{iθ}` at some multiple of the angles, either way round.
    pub(crate) fn units(&self, ratio: SpeedRatio) -> Cow<'_, Units> {
        if ratio.is_crank_speed() {
            return Cow::Borrowed(&self.main);
        }
        Cow::Owned(Units::at_speed(self.angles, self.range.clone(), ratio))
    }

    /// `e^{inθ}` of an order.
    pub(crate) fn orders(&self, order: Order) -> Units {
        Units::new(self.angles, self.range.clone(), order)
    }

    pub(crate) fn degrees(&self) -> &[f64] {
        &self.angles.degrees()[self.range.clone()]
    }
}

/// `e^{iθ}` of a block of crank angles, or of a multiple of θ; whole lines of the cache.
#[derive(Clone)]
#[repr(align(64))]
pub(crate) struct Units {
    pub cos: AngleColumn,
    pub sin: AngleColumn,
}

impl Units {
    /// At these crank angles, at most [`BLOCK`]; the rest of the columns is that of θ = 0.
    pub(crate) fn new(angles: &CrankAngles, range: Range<usize>, order: Order) -> Self {
        let mut units = Self { cos: [1.0; BLOCK], sin: [0.0; BLOCK] };
        angles.multiples(order, range, &mut units.cos, &mut units.sin);
        units
    }

    /// At some multiple of these crank angles; a shaft's speed is an order.
    pub(crate) fn at_speed(angles: &CrankAngles, range: Range<usize>, ratio: SpeedRatio) -> Self {
        let order = ratio.order().unwrap_or(Order::FIRST);
        Self::new(angles, range, order)
    }

    /// Positions of a crank that is `phase` ahead.
    pub(crate) fn cranks(&self, phase: Complex64) -> Cranks<'_> {
        Cranks::new(&self.cos, &self.sin, phase)
    }

    /// One of them.
    #[inline(always)]
    pub(crate) fn crank(&self, phase: Complex64, i: usize) -> CrankPosition {
        self.cranks(phase).at(i)
    }

    /// Adds real and imaginary part of a vector that turns from here at ±1 times these angles.
    #[inline(always)]
    pub(crate) fn add_turning(
        &self,
        at_start: Complex64,
        sense: i32,
        [x, y]: [&mut AngleColumn; 2],
    ) {
        let sign = f64::from(sense.signum());
        for ((x, y), (cos, sin)) in x.iter_mut().zip(y).zip(self.cos.iter().zip(&self.sin[..])) {
            let sin = sign * sin;
            *x += at_start.re * cos - at_start.im * sin;
            *y += at_start.re * sin + at_start.im * cos;
        }
    }
}
