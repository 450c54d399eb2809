//! Exact kinematics of a whole engine: its loads gathered by motion and top dead centre.

use std::borrow::Cow;
use std::ops::Range;

use crate::Complex64;
use crate::gear::rod::Swing;
use crate::gear::slider_crank::{CrankPosition, Cylinder, Proportions};
use crate::gear::{Gear, GearKind, Pressure};
use crate::load::{Loads, Source, found_or};
use crate::numbers::angle::Angle;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::order::Order;
use crate::wrench::rounding;

/// Crank angles evaluated side by side.
pub(crate) const BLOCK: usize = 256;

/// One value for each crank angle of a block.
pub(crate) type AngleColumn = [f64; BLOCK];

/// An engine's loads as functions of crank angle, over ω².
pub(crate) struct Kinematics {
    pub pistons: Vec<Pistons>,
    pub unbalances: Vec<Unbalances>,
    pub pressures: Vec<Pressures>,
    /// Bounds of the rounding errors of force and moment that cancel.
    pub zero_bounds: [f64; 2],
}

/// Pistons of one gear and top dead centre.
pub(crate) struct Pistons {
    gear: usize,
    /// A slider-crank of the gear.
    pub cylinder: Cylinder,
    /// Speed of the crank over that of the main one.
    pub ratio: i32,
    /// Factors of the torques on the block and on the main crank.
    pub senses: [f64; 2],
    tdc: Angle,
    /// `e^{−iρ·tdc}`.
    pub phase: Complex64,
    /// Force and moment, x + iy, for one crank radius of acceleration.
    pub planar: [Complex64; 2],
    /// Roll torque of that force about the main crank's axis.
    pub arm: f64,
    /// Σ m·r².
    pub second_moment: f64,
    /// Σ of the rods' inertia beyond their two masses.
    pub rod_inertia: f64,
}

/// Pistons under pressure of one gear that fire together.
pub(crate) struct Pressures {
    gear_index: usize,
    firing: Angle,
    /// The gear, a slider-crank with pressure.
    pub gear: Gear,
    pub proportions: Proportions,
    /// Degrees at which they fire.
    pub firing_deg: f64,
    /// `e^{−iφ}` of it.
    pub phase: Complex64,
    /// Σ area × crank radius, m³.
    pub volume: f64,
}

impl Pressures {
    /// Adds the torque on a crank of ratio 1 by pistons that move so, at a block of crank angles.
    pub fn add(&self, proportions: &Proportions, block: &AngleBlock, torque: &mut [f64]) {
        let Some(Pressure { cycle, crankcase }) = &self.gear.pressure else { return };
        for (i, (θ, torque)) in block.degrees().iter().zip(torque).enumerate() {
            let velocity = proportions.motion_at(&block.main.crank(self.phase, i)).velocity;
            let gauge = cycle.pressure_deg(θ - self.firing_deg) - crankcase;
            // The piston's way down is minus its distance from the crank.
            *torque -= gauge * velocity * self.volume;
        }
    }
}

/// Unbalances on shafts of one ratio: all at θ = 0.
#[derive(Default)]
pub(crate) struct Unbalances {
    pub ratio: i32,
    /// Force and moment, x + iy.
    pub planar: [Complex64; 2],
    /// Roll torque as the imaginary part.
    pub roll: Complex64,
}

impl Kinematics {
    pub fn new(loads: &Loads) -> Self {
        let (mut pistons, mut unbalances) = (Vec::<Pistons>::new(), Vec::<Unbalances>::new());
        let mut pressures = Vec::<Pressures>::new();
        let mut zero_bounds = [0.0; 2];
        // Of a force that was given no motion is known.
        let slider_crank = |gear: usize| match loads.gears[gear].kind {
            GearKind::SliderCrank { cylinder, .. } => Some(cylinder),
            GearKind::Given(_) => None,
        };
        for load in &loads.list {
            let ratio = load.ratio;
            let square = f64::from(ratio * ratio);
            let force = load.unit * (load.weight * square);
            // A moment is its levered force turned by a quarter.
            let lever = Complex64::new(0.0, load.z - loads.reference);
            if !matches!(load.source, Source::Pressure { .. }) {
                // At a top dead centre a piston exerts its mass·radius and more. Rounding of a lever
                // is relative to what it is the difference of.
                let size = rounding(loads.list.len(), f64::from(ratio.abs())) * force.norm();
                zero_bounds[0] += size;
                zero_bounds[1] += size * (load.z.abs() + loads.reference.abs());
            }
            match load.source {
                Source::Piston { gear, second_moment, rod_inertia } => {
                    let Some(cylinder) = slider_crank(gear) else { continue };
                    let same = |p: &Pistons| p.gear == gear && p.tdc == load.phase;
                    let sum = found_or(&mut pistons, same, || Pistons {
                        gear,
                        cylinder,
                        ratio,
                        senses: loads.gears[gear].senses(),
                        tdc: load.phase,
                        phase: load.phase.cis(-i64::from(ratio.abs())),
                        planar: Default::default(),
                        arm: 0.0,
                        second_moment: 0.0,
                        rod_inertia: 0.0,
                    });
                    // The force is against the acceleration of the piston away from the crank.
                    for (sum, term) in sum.planar.iter_mut().zip([-force, -lever * force]) {
                        *sum += term;
                    }
                    sum.arm -= (load.axis.conj() * force).im;
                    sum.second_moment += second_moment * square;
                    sum.rod_inertia += rod_inertia * square;
                }
                Source::Unbalance => {
                    let none = || Unbalances { ratio, ..Unbalances::default() };
                    let sum = found_or(&mut unbalances, |u: &Unbalances| u.ratio == ratio, none);
                    let force = force * load.phase.cis(-i64::from(ratio));
                    for (sum, term) in sum.planar.iter_mut().zip([force, lever * force]) {
                        *sum += term;
                    }
                    sum.roll += load.axis.conj() * force;
                }
                Source::Pressure { gear } => {
                    let Some(cylinder) = slider_crank(gear) else { continue };
                    let same = |p: &Pressures| (p.gear_index, p.firing) == (gear, load.phase);
                    let sum = found_or(&mut pressures, same, || Pressures {
                        gear_index: gear,
                        firing: load.phase,
                        gear: loads.gears[gear].clone(),
                        proportions: cylinder.proportions(),
                        // Its phase is half of it.
                        firing_deg: 2.0 * load.phase.degrees(),
                        phase: load.phase.cis(-2),
                        volume: 0.0,
                    });
                    sum.volume += load.weight;
                }
            }
        }
        Self { pistons, unbalances, pressures, zero_bounds }
    }

    /// Adds the moment of inertia of pistons and rods as seen from the crank at a block of angles, kg·m²,
    /// and its slope: with I the kinetic energy is ½I·ω², and inertia torque −½I′·ω².
    pub fn add_inertia(&self, angles: &CrankAngles, [inertia, slope]: [&mut [f64]; 2]) {
        for pistons in &self.pistons {
            let units = Units::at_speed(angles, 0..angles.len(), pistons.ratio);
            let (proportions, [_, speed]) = (pistons.cylinder.proportions(), pistons.senses);
            for i in 0..angles.len() {
                let crank = units.crank(pistons.phase, i);
                let motion = proportions.motion_at(&crank);
                let mut add = |of: f64, velocity: f64, acceleration: f64| {
                    inertia[i] += of * velocity * velocity;
                    slope[i] += 2.0 * speed * of * velocity * acceleration;
                };
                add(pistons.second_moment, motion.velocity, motion.acceleration);
                if pistons.rod_inertia != 0.0 {
                    let swing = Swing::new(&proportions, &crank);
                    add(pistons.rod_inertia, swing.velocity, swing.acceleration);
                }
            }
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

    fn degrees(&self) -> &[f64] {
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
    pub fn add_turning(&self, at_start: Complex64, sense: i32, [x, y]: [&mut [f64]; 2]) {
        let sign = f64::from(sense.signum());
        for ((x, y), (cos, sin)) in x.iter_mut().zip(y).zip(self.cos.iter().zip(&self.sin[..])) {
            let sin = sign * sin;
            *x += at_start.re * cos - at_start.im * sin;
            *y += at_start.re * sin + at_start.im * cos;
        }
    }
}
