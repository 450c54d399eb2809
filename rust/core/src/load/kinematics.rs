//! Loads over crank angle, exactly: those of one source that act together are one function times their sums.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use super::source::{Repeats, Scaling, Source};
use super::{GroupIndex, SourceIndex};
use super::{LoadList, count, find_or_push};
use crate::Complex64;
use crate::mechanism::Mechanism;
use crate::mechanism::slider_crank::CrankPosition;
use crate::numbers::angle::Angle;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::index::List;
use crate::numbers::order::Order;
use crate::wrench::rounding;

/// Crank angles evaluated side by side.
pub(crate) const BLOCK: usize = 256;

/// One value for each crank angle of a block.
pub(crate) type AngleColumn = [f64; BLOCK];

/// Values at a block of crank angles; whole lines of the cache.
#[repr(align(64))]
pub(crate) struct Columns {
    /// Along x and y.
    pub force: [AngleColumn; 2],
    /// About x and y.
    pub moment: [AngleColumn; 2],
    /// On the block and on the main crank.
    pub torque: [AngleColumn; 2],
}

/// Quantities to evaluate.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quantities {
    /// Force and moment.
    pub planar: bool,
    /// Torques.
    pub torque: bool,
}

/// Loads of one source and phase.
pub(crate) struct LoadSum {
    pub source: Arc<dyn Source>,
    /// Index of the source.
    index: SourceIndex,
    /// Index into [`LoadList::groups`].
    pub group: GroupIndex,
    phase: Angle,
    /// Speed of their crank or shaft.
    pub ratio: i32,
    /// Crank angle of the phase, degrees.
    pub phase_deg: f64,
    /// `e^{−iφ}` of the angle of their own crank at which the phase stands.
    pub turned: Complex64,
    /// Force and moment, x + iy, in their direction, over ω².
    pub force: Complex64,
    pub moment: Complex64,
    /// The force's torque about the main crank's axis, as the imaginary part.
    pub arm: Complex64,
    /// Weight of the torque.
    pub roll: f64,
    /// Whether the phase is half the crank angle, which half orders turn by whole numbers.
    halved: bool,
}

impl LoadSum {
    /// `e^{−inφ}` of an order.
    pub fn lag(&self, order: Order) -> Complex64 {
        let halves = i64::from(order.halves());
        self.phase.cis(if self.halved { -halves } else { -halves / 2 })
    }
}

/// An engine's loads as functions of crank angle.
pub(crate) struct Kinematics {
    pub sums: Vec<LoadSum>,
    /// Bounds of the rounding errors of force and moment that cancel, of each group over what it scales with.
    zero_bounds: List<GroupIndex, [f64; 2]>,
    scalings: List<GroupIndex, Scaling>,
}

impl Kinematics {
    pub fn new(loads: &LoadList) -> Self {
        let (mut sums, mut zero_bounds) =
            (Vec::<LoadSum>::new(), loads.groups.map_to(|_| [0.0; 2]));
        let count = count(&loads.list, false);
        for load in &loads.list {
            let place = &load.place;
            let square = f64::from(place.speed_squared());
            let mut force = place.unit * (load.weight * square);
            if load.weight != 0.0 {
                // At a top dead centre a piston exerts its mass·radius and more.
                let most = force.norm() * loads.source(load).scale().force;
                let size = rounding(count, f64::from(place.ratio.abs())) * most;
                let bounds = &mut zero_bounds[loads.group_of[load.source]];
                bounds[0] += size;
                bounds[1] += size * place.lever_size(loads.reference);
            }
            let mut phase = place.phase;
            if load.is_turning() {
                // All of one speed are one vector at θ = 0.
                force *= phase.cis(-i64::from(place.ratio));
                phase = Angle::ZERO;
            }
            let of_phase = load.phase_multiple(Order::FIRST);
            let same = |sum: &LoadSum| (sum.index, sum.phase) == (load.source, phase);
            let sum = find_or_push(&mut sums, same, || LoadSum {
                source: Arc::clone(&loads.sources[load.source]),
                index: load.source,
                group: loads.group_of[load.source],
                phase,
                ratio: place.ratio,
                phase_deg: of_phase as f64 * phase.degrees(),
                turned: phase.cis(-of_phase * i64::from(place.ratio.abs())),
                force: Complex64::default(),
                moment: Complex64::default(),
                arm: Complex64::default(),
                roll: 0.0,
                halved: load.parts.repeats == Repeats::EveryTwoTurns,
            });
            sum.force += force;
            // A moment is its levered force turned by a quarter.
            sum.moment += Complex64::new(0.0, place.lever(loads.reference)) * force;
            sum.arm += place.axis.conj() * force;
            sum.roll += load.roll * square;
        }
        let scalings = loads.groups.map_to(|group| group.scaling);
        Self { sums, zero_bounds, scalings }
    }

    /// What each group is multiplied by at a speed, rad/s.
    pub fn factors(&self, omega: f64) -> List<GroupIndex, f64> {
        self.scalings.map_to(|scaling| scaling.factor(omega))
    }

    /// 1 for each group of a scaling, or for all, 0 for the others.
    pub fn factors_of(&self, scaling: Option<Scaling>) -> List<GroupIndex, f64> {
        let counts = |own: &Scaling| scaling.is_none_or(|scaling| scaling == *own);
        self.scalings.map_to(|own| f64::from(u8::from(counts(own))))
    }

    /// Bounds of the rounding errors of force and moment that cancel: of groups times factors.
    pub fn zero_bounds(&self, factors: &List<GroupIndex, f64>) -> [f64; 2] {
        let bounds = self.zero_bounds.iter().zip(factors);
        bounds.fold([0.0; 2], |sum, (own, factor)| {
            [sum[0] + own[0] * factor, sum[1] + own[1] * factor]
        })
    }

    /// Adds the moment of inertia of what moves as seen from the main crank at a block of angles, kg·m²,
    /// and its slope.
    pub fn add_inertia(&self, angles: &CrankAngles, [inertia, slope]: [&mut [f64]; 2]) {
        for sum in &self.sums {
            sum.source.add_inertia(sum, angles, [&mut *inertia, &mut *slope]);
        }
    }
}

/// Adds the moment of inertia of loads whose velocity and acceleration per unit of crank speed a function
/// gives, and its slope: with I the kinetic energy is ½I·ω², and inertia torque −½I′·ω².
pub(super) fn add_inertia(
    mechanism: &Mechanism,
    sum: &LoadSum,
    angles: &CrankAngles,
    [inertia, slope]: [&mut [f64]; 2],
    motion: impl Fn(&CrankPosition) -> [f64; 2],
) {
    let units = Units::at_speed(angles, 0..angles.len(), mechanism.ratio);
    let [_, speed] = mechanism.senses();
    for i in 0..angles.len() {
        let [velocity, acceleration] = motion(&units.crank(sum.turned, i));
        inertia[i] += sum.roll * velocity * velocity;
        slope[i] += 2.0 * speed * sum.roll * velocity * acceleration;
    }
}

impl Columns {
    pub const ZERO: Self =
        Self { force: [[0.0; BLOCK]; 2], moment: [[0.0; BLOCK]; 2], torque: [[0.0; BLOCK]; 2] };

    /// Adds the wanted ones of other columns.
    pub fn add(&mut self, other: &Self, wanted: Quantities) {
        let planar = self.force.iter_mut().chain(&mut self.moment);
        let planar = planar.zip(other.force.iter().chain(&other.moment)).filter(|_| wanted.planar);
        let torque = self.torque.iter_mut().zip(&other.torque).filter(|_| wanted.torque);
        for (into, from) in planar.chain(torque) {
            into.iter_mut().zip(from).for_each(|(into, from)| *into += from);
        }
    }

    /// The wanted ones of other columns in place of these.
    pub fn copy(&mut self, from: &Self, wanted: Quantities) {
        if wanted.planar {
            self.force.clone_from_slice(&from.force);
            self.moment.clone_from_slice(&from.moment);
        }
        if wanted.torque {
            self.torque.clone_from_slice(&from.torque);
        }
    }
}

/// A block of crank angles.
pub(crate) struct AngleBlock<'a> {
    angles: &'a CrankAngles,
    range: Range<usize>,
    main: Units,
}

impl<'a> AngleBlock<'a> {
    /// These of the angles, at most [`BLOCK`].
    pub fn new(angles: &'a CrankAngles, range: Range<usize>) -> Self {
        let main = Units::new(angles, range.clone(), Order::FIRST);
        Self { angles, range, main }
    }

    /// `e^{iθ}` at some multiple of the angles, either way round.
    pub fn units(&self, ratio: i32) -> Cow<'_, Units> {
        if ratio.abs() == 1 {
            return Cow::Borrowed(&self.main);
        }
        Cow::Owned(Units::at_speed(self.angles, self.range.clone(), ratio))
    }

    /// `e^{inθ}` of an order.
    pub fn orders(&self, order: Order) -> Units {
        Units::new(self.angles, self.range.clone(), order)
    }

    pub fn degrees(&self) -> &[f64] {
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
    pub fn new(angles: &CrankAngles, range: Range<usize>, order: Order) -> Self {
        let mut units = Self { cos: [1.0; BLOCK], sin: [0.0; BLOCK] };
        angles.multiples(order, range, &mut units.cos, &mut units.sin);
        units
    }

    /// At some multiple of these crank angles; a shaft's speed is an order.
    pub fn at_speed(angles: &CrankAngles, range: Range<usize>, ratio: i32) -> Self {
        let order = Order::whole(ratio.unsigned_abs()).unwrap_or(Order::FIRST);
        Self::new(angles, range, order)
    }

    /// Position of a crank that is `phase` ahead.
    #[inline(always)]
    pub fn crank(&self, phase: Complex64, i: usize) -> CrankPosition {
        let (cos, sin) = (self.cos[i], self.sin[i]);
        CrankPosition::new(sin * phase.re + cos * phase.im, cos * phase.re - sin * phase.im)
    }

    /// Adds real and imaginary part of a vector that turns from here at ±1 times these angles.
    #[inline(always)]
    pub fn add_turning(&self, at_start: Complex64, sense: i32, [x, y]: [&mut AngleColumn; 2]) {
        let sign = f64::from(sense.signum());
        for ((x, y), (cos, sin)) in x.iter_mut().zip(y).zip(self.cos.iter().zip(&self.sin[..])) {
            let sin = sign * sin;
            *x += at_start.re * cos - at_start.im * sin;
            *y += at_start.re * sin + at_start.im * cos;
        }
    }
}
