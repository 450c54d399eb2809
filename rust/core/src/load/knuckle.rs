//! Torque of a mass at the knuckle of a link rod beyond those of what turns and of what moves as the master's piston.
//!
//! The knuckle moves as (1 − k) times the crankpin and k times the wrist pin of the master rod, k = a·e^{iψ}/l in the
//! sense of the crank. With q = k̄(1 − k), the master's piston at x, its offset e, and all lengths over the crank
//! radius, half the square of its speed is ½|1 − k|² + ½|k|²x′² − x′·Im(q·e^{iθ}): the first is constant, the second
//! the piston's; of the third this is the torque, on the crank its derivative, on the block what the moment of momentum
//! adds to its negative: −x′·Re(q·e^{iθ}) + Im(q·e^{iθ}(x − ie)).

use super::piston::{multiples, torque_by};
use crate::Complex64;
use crate::mechanism::DrivenMechanism;
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::mechanism::motion::{CrankPosition, MotionColumns};
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::source::over_angle::{BLOCK, LoadSum, Units};
use crate::source::{
    ExactFactor, INERTIA, Parts, Scale, Series, Source, Tail, TorqueAmplitudes, UpTo, is_equal,
};

/// Most samples of a mean.
const MOST_SAMPLES: usize = 1 << 16;

/// That torque over the mass, the square of the crank radius and ω².
#[derive(Debug, Clone, PartialEq)]
pub(super) struct KnuckleCoupling {
    /// Of the master's piston.
    driven: DrivenMechanism,
    /// q.
    coupling: Complex64,
    /// Mean of the master's piston's position, over the crank radius.
    mean: f64,
}

impl KnuckleCoupling {
    /// Of |k| and ψ, in the sense of the crank.
    pub fn new(driven: DrivenMechanism, share: f64, angle: Angle) -> Self {
        let unit = angle.cis(1);
        let coupling = unit.conj() * share - share * share;
        let mean = mean_position(&driven);
        Self { driven, coupling, mean }
    }

    /// What orders above a number of halves add: amplitudes of the product with e^{iθ} are means of the neighbours'.
    fn rest(&self, halves: u32) -> Tail {
        let own = self.driven.own_highest(halves);
        let force = self.driven.mechanism.force_beyond(own.saturating_sub(1));
        let mean =
            if own == 0 { self.mean.abs() + self.driven.mechanism.offset().abs() } else { 0.0 };
        let bound = 2.0 * force.unwrap_or(f64::INFINITY) + mean;
        Tail { force: 0.0, torque: self.coupling.norm() * bound * self.driven.ratio.size() }
    }

    /// On the block and on its own crank.
    fn harmonics(&self, orders: &[u32], cancel: &Cancel) -> Result<TorqueHarmonics> {
        let neighbours: Vec<u32> = orders.iter().flat_map(|&n| [n - 1, n + 1]).collect();
        let known: Vec<u32> = neighbours.iter().copied().filter(|&n| n > 0).collect();
        let mut force = self.driven.mechanism.force(&known, cancel)?.into_iter();
        // Amplitudes of the position.
        let mut position = |n: u32| {
            let square = f64::from(n) * f64::from(n);
            if n == 0 { Complex64::ZERO } else { force.next().unwrap_or_default() / square }
        };
        let (i, q, offset) = (Complex64::i(), self.coupling, self.driven.mechanism.offset());
        let mut harmonics = TorqueHarmonics::default();
        for &n in orders {
            let [below, above] = [n - 1, n + 1].map(|n| (f64::from(n), position(n)));
            let product = |of: Complex64, [below, above]: [Complex64; 2]| {
                0.5 * (of * below + of.conj() * above)
            };
            let velocity = [below, above].map(|(n, value)| i * n * value);
            let speed = product(-i * q, velocity);
            let mut roll = product(-q, velocity) + product(-i * q, [below.1, above.1]);
            if n == 1 {
                roll -= q * (i * self.mean + offset);
            }
            harmonics.roll.push(roll);
            harmonics.crank.push(i * f64::from(n) * speed);
        }
        Ok(harmonics)
    }
}

/// By samples, twice as many until it stays.
fn mean_position(driven: &DrivenMechanism) -> f64 {
    let position = |turn: f64| {
        let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
        driven.mechanism.motion(&CrankPosition::new(sin, cos)).position
    };
    let (mut count, mut mean) = (32, f64::INFINITY);
    while count <= MOST_SAMPLES {
        let sum: f64 = (0..count).map(|k| position(k as f64 / count as f64)).sum();
        let before = mean;
        mean = sum / count as f64;
        if (mean - before).abs() <= 2.0 * f64::EPSILON * mean.abs() {
            break;
        }
        count *= 2;
    }
    mean
}

impl Source for KnuckleCoupling {
    fn name(&self) -> &'static str {
        INERTIA
    }

    fn parts(&self) -> Parts {
        Parts::inertia(None, true)
    }

    fn equals(&self, other: &dyn Source) -> bool {
        is_equal(self, other)
    }

    fn mechanism(&self) -> Option<&DrivenMechanism> {
        Some(&self.driven)
    }

    fn exact(&self) -> ExactFactor {
        ExactFactor::Coupling
    }

    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        torque_by(&self.driven, orders, |own| self.harmonics(own, cancel))
    }

    fn series(&self, up_to: UpTo, _: &Cancel) -> Result<Series> {
        Ok(multiples(&self.driven, up_to, |halves| self.rest(halves)))
    }

    fn scale(&self) -> Scale {
        Scale { torque: Some(self.coupling.norm()), ..Scale::default() }
    }

    fn add_inertia(&self, sum: &LoadSum, angles: &CrankAngles, [inertia, slope]: [&mut [f64]; 2]) {
        let units = Units::at_speed(angles, 0..angles.len(), self.driven.ratio);
        let [_, speed] = self.driven.senses();
        let [mut velocities, mut accelerations] = [[0.0; BLOCK]; 2];
        let cranks = units.cranks(sum.turned);
        let both = [&mut velocities[..], &mut accelerations[..]];
        self.driven.mechanism.motions(&cranks, MotionColumns::of_both(both));
        for i in 0..angles.len() {
            let CrankPosition { sin, cos, .. } = cranks.at(i);
            let turned = self.coupling * Complex64::new(cos, sin);
            let [velocity, acceleration] = [velocities[i], accelerations[i]];
            inertia[i] -= 2.0 * sum.roll * velocity * turned.im;
            slope[i] -= 2.0 * speed * sum.roll * (acceleration * turned.im + velocity * turned.re);
        }
    }
}
