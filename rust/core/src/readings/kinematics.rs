//! Exact kinematics of a whole engine: its loads gathered by motion and top dead centre.

use std::ops::{Deref, DerefMut};

use crate::Complex64;
use crate::gear::slider_crank::{Crank, Cylinder};
use crate::load::{Load, Loads, Source};
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::order::Order;

/// Crank angles evaluated side by side.
pub(crate) const BLOCK: usize = 256;

/// One value for each crank angle of a block; whole cache lines.
#[derive(Clone)]
#[repr(align(64))]
pub(crate) struct Column([f64; BLOCK]);

impl Column {
    pub const ZERO: Self = Self([0.0; BLOCK]);
}

impl Deref for Column {
    type Target = [f64; BLOCK];

    #[inline(always)]
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl DerefMut for Column {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.0
    }
}

/// An engine's loads as functions of crank angle, over ω².
pub(crate) struct Kinematics {
    pub pistons: Vec<Pistons>,
    pub unbalances: Vec<Unbalances>,
}

/// Pistons of one motion and top dead centre.
pub(crate) struct Pistons {
    pub cylinder: Cylinder,
    /// `e^{−i·tdc}`.
    pub phase: Complex64,
    /// Force and moment, x + iy, for one crank radius of acceleration.
    pub planar: [Complex64; 2],
    /// Σ m·r².
    pub second_moment: f64,
    /// Σ of the rods' inertia beyond their two masses.
    pub rod_inertia: f64,
}

/// Unbalances on shafts of one ratio: all at θ = 0.
pub(crate) struct Unbalances {
    pub ratio: i32,
    /// Force and moment, x + iy.
    pub planar: [Complex64; 2],
    /// Roll torque as the imaginary part.
    pub roll: Complex64,
}

impl Kinematics {
    pub fn new(loads: &Loads) -> Self {
        let (mut pistons, mut found) = (Vec::<Pistons>::new(), Vec::<&Load>::new());
        let mut unbalances = Vec::<Unbalances>::new();
        for load in &loads.list {
            // A moment is its levered force turned by a quarter.
            let lever = Complex64::new(0.0, load.z - loads.reference);
            match load.source {
                Source::Piston { motion, second_moment, rod_inertia } => {
                    let same = |other: &&Load| {
                        other.phase == load.phase
                            && matches!(other.source, Source::Piston { motion: m, .. } if m == motion)
                    };
                    let k = found.iter().position(same).unwrap_or_else(|| {
                        found.push(load);
                        pistons.push(Pistons {
                            cylinder: loads.motions[motion],
                            phase: load.phase.cis(-1),
                            planar: Default::default(),
                            second_moment: 0.0,
                            rod_inertia: 0.0,
                        });
                        pistons.len() - 1
                    });
                    // The force is against the acceleration of the piston away from the crank.
                    let force = -load.unit() * load.weight;
                    for (sum, term) in pistons[k].planar.iter_mut().zip([force, lever * force]) {
                        *sum += term;
                    }
                    pistons[k].second_moment += second_moment;
                    pistons[k].rod_inertia += rod_inertia;
                }
                Source::Unbalance { ratio, axis } => {
                    let k = unbalances.iter().position(|u| u.ratio == ratio).unwrap_or_else(|| {
                        let roll = Complex64::default();
                        unbalances.push(Unbalances { ratio, planar: Default::default(), roll });
                        unbalances.len() - 1
                    });
                    let square = f64::from(ratio) * f64::from(ratio);
                    let force = load.unit() * load.phase.cis(-1) * (load.weight * square);
                    for (sum, term) in unbalances[k].planar.iter_mut().zip([force, lever * force]) {
                        *sum += term;
                    }
                    unbalances[k].roll += axis.conj() * force;
                }
            }
        }
        Self { pistons, unbalances }
    }
}

/// `e^{iθ}` of a block of crank angles, or of a multiple of θ.
#[derive(Clone)]
pub(crate) struct Units {
    pub cos: Column,
    pub sin: Column,
}

impl Units {
    /// At these crank angles, at most [`BLOCK`]; the rest of the columns is that of θ = 0.
    #[inline(always)]
    pub fn new(angles: &CrankAngles, range: std::ops::Range<usize>, order: Order) -> Self {
        let mut units = Self { cos: Column([1.0; BLOCK]), sin: Column::ZERO };
        angles.multiples(order, range, &mut units.cos[..], &mut units.sin[..]);
        units
    }

    /// Position of a crank that is `phase` ahead.
    #[inline(always)]
    pub fn crank(&self, phase: Complex64, i: usize) -> Crank {
        let (cos, sin) = (self.cos[i], self.sin[i]);
        Crank::new(sin * phase.re + cos * phase.im, cos * phase.re - sin * phase.im)
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
