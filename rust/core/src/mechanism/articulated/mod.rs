//! The motion of a piston whose rod, a link rod, hangs on the master rod of another cylinder.
//!
//! With lengths over the crank radius and θ from where the crankpin points along the own bore, which is D ahead of
//! the master's, the master's rod leans by φ, sin φ = −λ(sin(θ + D) − e), and carries the knuckle at a radius a and
//! an angle ψ from its shank: K = e^{iθ} + a·e^{i(ψ − D + φ)}. The piston stands at Re K + √(L² − (Im K)²).
//!
//! Harmonics are those of samples, as many as the height of the strip demands in which the motion is analytic
//! (`strip`). Even and odd orders are sampled apart: what half a turn negates is proportional to sin(ψ − D) beyond
//! the crankpin's own, so that odd orders keep their relative accuracy where knuckle and bore nearly agree, and are
//! zero where they do.

pub mod equal;
mod jet;
mod strip;
pub mod table;

use std::f64::consts::TAU;
use std::sync::Arc;

use self::jet::{HalfTurnParts, Jet};
use self::strip::Strip;
use super::exact::{ExactHarmonic, FigureKey, MotionKey, Rest};
use super::harmonics::rod::TorqueHarmonics;
use super::motion::{CrankPosition, Cranks, Motion, MotionColumns, Swing, fill};
use super::{Cylinder, HarmonicsOf, Mechanism, is_equal};
use crate::Complex64;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::order::Order;
use crate::numbers::rational::Ratio;
use crate::numbers::simd::vectorised;

/// Largest coefficient that samples may fold back onto others: below the rounding of their sum.
const FOLDED: f64 = 1e-17;
/// Fewest samples of a turn.
const FEWEST_SAMPLES: usize = 64;
/// Most samples of a turn: those of a link rod that is as little longer than it must be as is taken.
const MOST_SAMPLES: usize = 1 << 17;
/// Part by which a link rod, and a master rod, are longer than what they must reach.
const SPARE_LENGTH: f64 = 1e-6;

/// Where a link rod hangs: the master rod, and the knuckle on it. Angles are in the sense of the crank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knuckle {
    /// The master's cylinder, without masses.
    pub master: Cylinder,
    /// Distance of the knuckle from the crankpin, m.
    pub radius: f64,
    /// Angle of the knuckle from the master's shank.
    pub angle: Angle,
    /// Angle of the link's bore ahead of the master's.
    pub ahead: Angle,
}

/// A cylinder and what its rod hangs on: none on the crankpin itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunningGear {
    /// The cylinder.
    pub cylinder: Cylinder,
    /// Of a link rod.
    pub knuckle: Option<Knuckle>,
}

impl RunningGear {
    /// How its piston moves; a knuckle at the crankpin's centre is none.
    #[must_use]
    pub fn mechanism(&self) -> Arc<dyn Mechanism> {
        match &self.knuckle {
            Some(knuckle) if knuckle.radius > 0.0 => {
                Arc::new(Articulated::new(&self.cylinder, knuckle))
            }
            _ => self.cylinder.mechanism(),
        }
    }
}

impl Knuckle {
    /// Check that a link rod of a cylinder on it can turn.
    pub fn check(&self, cylinder: &Cylinder) -> Result<()> {
        limits::distance("radius", self.radius)?;
        if self.master.has_infinite_rod() || cylinder.has_infinite_rod() {
            let hint = "master rod and link rods are finite";
            return Err(Error::value("rod_length", "inf", hint));
        }
        if cylinder.pin_offset() != 0.0 {
            let hint = "a link rod's piston has none: leave it out, or give it to the master";
            return Err(Error::figure("pin_offset", cylinder.pin_offset(), hint));
        }
        let radius = self.master.crank_radius();
        if cylinder.crank_radius() != radius {
            let hint = format!("make it {radius:?}, that of the master: they share its crankpin");
            return Err(Error::figure("crank_radius", cylinder.crank_radius(), hint));
        }
        if self.radius == 0.0 {
            return Ok(());
        }
        let reach = self.master.rod_length() - self.master.pin_offset().abs();
        if reach < radius * (1.0 + SPARE_LENGTH) {
            let hint =
                "a master rod is longer than the crank radius and the pin offset by 1e-6 of it";
            return Err(Error::figure("rod_length", self.master.rod_length(), hint));
        }
        let needed = Linkage::new(cylinder, self).farthest(0.0) * radius * (1.0 + SPARE_LENGTH);
        if cylinder.rod_length() <= needed {
            let hint = format!(
                "the link rod is too short for its knuckle, which goes {needed:.6} m off its bore: make it longer \
                 than that"
            );
            return Err(Error::figure("rod_length", cylinder.rod_length(), hint));
        }
        Ok(())
    }
}

/// Lengths of a link rod and its master over the crank radius, and angles as unit vectors.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Linkage {
    /// L.
    rod: f64,
    /// a.
    radius: f64,
    /// `e^{i(ψ − D)}`.
    knuckle: Complex64,
    /// `e^{iD}`.
    ahead: Complex64,
    /// λ and e of the master.
    master_ratio: f64,
    master_offset: f64,
}

impl Linkage {
    fn new(cylinder: &Cylinder, knuckle: &Knuckle) -> Self {
        let (radius, master) = (cylinder.crank_radius(), &knuckle.master);
        Self {
            rod: cylinder.rod_length() / radius,
            radius: knuckle.radius / radius,
            knuckle: (knuckle.angle - knuckle.ahead).cis(1),
            ahead: knuckle.ahead.cis(1),
            master_ratio: radius / master.rod_length(),
            master_offset: master.pin_offset() / radius,
        }
    }

    /// Knuckle along the bore and across it, and the link rod's height.
    #[inline(always)]
    fn jets(&self, crank: &CrankPosition) -> [Jet; 3] {
        let Self { knuckle, ahead, .. } = *self;
        let [sin, cos] = Jet::turning(crank.sin, crank.cos);
        let from_master = sin.times(ahead.re) + cos.times(ahead.im);
        let lean = (Jet::constant(self.master_offset) - from_master).times(self.master_ratio);
        let one = Jet::constant(1.0);
        let upright = ((one - lean) * (one + lean)).sqrt();
        let along =
            cos + upright.times(self.radius * knuckle.re) + lean.times(-(self.radius * knuckle.im));
        let across =
            sin + upright.times(self.radius * knuckle.im) + lean.times(self.radius * knuckle.re);
        let rod = Jet::constant(self.rod);
        [along, across, ((rod - across) * (rod + across)).sqrt()]
    }

    #[inline(always)]
    fn motion(&self, crank: &CrankPosition) -> Motion {
        let [along, across, height] = self.jets(crank);
        let [position, velocity, acceleration, jerk] = (along + height).0;
        let inverse = 1.0 / height.0[0];
        let (slope, secant) = (across.0[0] * inverse, self.rod * inverse);
        Motion { position, velocity, acceleration, jerk, slope, secant }
    }

    /// sin of the lean is across/L, and its cosine height/L.
    #[inline(always)]
    fn swing(&self, crank: &CrankPosition) -> Swing {
        let [_, across, height] = self.jets(crank);
        let ([_, s1, s2, _], [h, h1, ..]) = (across.0, height.0);
        Swing { velocity: s1 / h, acceleration: (s2 * h - s1 * h1) / (h * h) }
    }

    /// The piston's distance beyond the crankpin's along the bore, in its parts.
    #[inline(always)]
    fn beyond_crank(&self, crank: &CrankPosition) -> HalfTurnParts {
        let Self { knuckle, ahead, .. } = *self;
        let [sin, cos] = Jet::turning(crank.sin, crank.cos);
        let zero = Jet::constant(0.0);
        let from_master = sin.times(ahead.re) + cos.times(ahead.im);
        let lean = HalfTurnParts {
            even: Jet::constant(self.master_ratio * self.master_offset),
            odd: from_master.times(-self.master_ratio),
        };
        let upright = lean.leg(1.0);
        let across = HalfTurnParts { even: zero, odd: sin }
            + upright.times(self.radius * knuckle.im)
            + lean.times(self.radius * knuckle.re);
        upright.times(self.radius * knuckle.re)
            + lean.times(-(self.radius * knuckle.im))
            + across.leg(self.rod)
    }

    /// Degrees at which the piston is highest, and lowest.
    fn turning_points_deg(&self) -> [f64; 2] {
        [1.0, -1.0].map(|side| {
            let at = |degrees: f64| self.motion(&CrankPosition::at_degrees(degrees));
            let height = |degrees: &f64| side * at(*degrees).position;
            let whole = (-90..270).map(f64::from);
            let start = whole.max_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or(0.0);
            let (mut low, mut high) = (start - 1.0, start + 1.0);
            for _ in 0..60 {
                let middle = f64::midpoint(low, high);
                *(if side * at(middle).velocity > 0.0 { &mut low } else { &mut high }) = middle;
            }
            let degrees = f64::midpoint(low, high);
            // At 0° where rounding alone parts it.
            if (degrees - start).abs() < 1e-13 { start } else { degrees }
        })
    }

    /// Amplitudes of the force, over m·r·ω²: those of even and of odd orders of samples of half a turn.
    fn force(&self, strip: &Strip, orders: &[u32], cancel: &Cancel) -> Result<Vec<Complex64>> {
        let sampled = samples(|n| strip.accelerations_beyond(n));
        let count = sampled.0;
        let parts = |k: usize| {
            let HalfTurnParts { even, odd } = self.beyond_crank(&sampled_crank(k, count));
            [-even.0[2], -odd.0[2]]
        };
        let values: Vec<[f64; 2]> = (0..count / 2).map(parts).collect();
        let value = |k: usize, n: u32| values[k][n as usize % 2];
        let mut amplitudes = phasors(orders, sampled, cancel, value, count / 2)?;
        for (&n, amplitude) in orders.iter().zip(&mut amplitudes) {
            if n == 1 {
                *amplitude += 1.0;
            }
        }
        Ok(amplitudes)
    }
}

/// Number of samples, and the order from which on coefficients are below what counts, of a bound of the sum of
/// the amplitudes above one.
fn samples(beyond: impl Fn(u32) -> Option<f64>) -> (usize, u32) {
    let is_little = |n: u32| beyond(n).is_some_and(|bound| bound < FOLDED);
    let mut count = FEWEST_SAMPLES;
    while count < MOST_SAMPLES && !is_little(count as u32 / 2) {
        count *= 2;
    }
    let (mut low, mut high) = (0, count as u32 / 2);
    while low + 1 < high {
        let middle = u32::midpoint(low, high);
        *(if is_little(middle) { &mut high } else { &mut low }) = middle;
    }
    (count, high)
}

/// Phasors at some orders of values over a turn, or of values over half of it of which the rest follows.
fn phasors(
    orders: &[u32],
    (count, last): (usize, u32),
    cancel: &Cancel,
    value: impl Fn(usize, u32) -> f64,
    values: usize,
) -> Result<Vec<Complex64>> {
    let units: Vec<Complex64> =
        (0..count).map(|k| Complex64::cis(-TAU * k as f64 / count as f64)).collect();
    let phasor = |&n: &u32| {
        cancel.check()?;
        Order::whole(n)?;
        if n > last {
            return Ok(Complex64::ZERO);
        }
        let at = |k: usize| units[k * n as usize % count] * value(k, n);
        Ok((0..values).map(at).sum::<Complex64>() * (2.0 / values as f64))
    };
    orders.iter().map(phasor).collect()
}

/// Positions of the crank at which there are samples.
fn sampled_crank(k: usize, count: usize) -> CrankPosition {
    let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
    CrankPosition::new(sin, cos)
}

/// Phasors of two functions over a turn.
fn torques(
    orders: &[u32],
    beyond: impl Fn(u32) -> Option<f64>,
    cancel: &Cancel,
    torques: impl Fn(&CrankPosition) -> [f64; 2],
) -> Result<TorqueHarmonics> {
    let sampled = samples(beyond);
    let count = sampled.0;
    let values: Vec<[f64; 2]> = (0..count).map(|k| torques(&sampled_crank(k, count))).collect();
    let of = |side: usize| phasors(orders, sampled, cancel, |k, _| values[k][side], count);
    Ok(TorqueHarmonics { roll: of(0)?, crank: of(1)? })
}

/// The mechanism of a link rod.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Articulated {
    /// What it was made of; it has no masses here.
    lengths: Cylinder,
    knuckle: Knuckle,
    linkage: Linkage,
    strip: Strip,
}

impl Articulated {
    fn new(cylinder: &Cylinder, knuckle: &Knuckle) -> Self {
        let linkage = Linkage::new(cylinder, knuckle);
        let (lengths, strip) = (cylinder.without_masses(), linkage.strip());
        let master = knuckle.master.without_masses();
        Self { lengths, knuckle: Knuckle { master, ..*knuckle }, linkage, strip }
    }

    /// Angle of the knuckle ahead of the own bore.
    fn lean(&self) -> Angle {
        self.knuckle.angle - self.knuckle.ahead
    }

    /// Whether odd orders are the crankpin's own alone.
    fn is_even(&self) -> bool {
        self.linkage.knuckle.im == 0.0 && self.linkage.master_offset == 0.0
    }

    /// The same figures, of which the first that is not zero is positive in what is not mirrored.
    fn figures(&self) -> [(f64, FigureKey); 3] {
        let signed = |angle: Angle| {
            let angle = (angle + Angle::HALF_TURN).reduced() - Angle::HALF_TURN;
            let key = match angle.turns() {
                Some((k, n)) => FigureKey::Exact(Ratio::new(k.unsigned_abs().into(), n.into())),
                None => FigureKey::Nearest(angle.degrees().abs().to_bits()),
            };
            // Half a turn is its own mirror image.
            (if angle == -Angle::HALF_TURN { 180.0 } else { angle.degrees() }, key)
        };
        let offset = self.knuckle.master.pin_offset();
        let over = FigureKey::quotient(offset.abs(), self.lengths.crank_radius());
        [signed(self.knuckle.ahead), signed(self.lean()), (offset, over)]
    }
}

impl Mechanism for Articulated {
    fn equals(&self, other: &dyn Mechanism) -> bool {
        is_equal(self, other)
    }

    fn motion(&self, crank: &CrankPosition) -> Motion {
        self.linkage.motion(crank)
    }

    fn swing(&self, crank: &CrankPosition) -> Swing {
        self.linkage.swing(crank)
    }

    fn motions(&self, cranks: &Cranks, into: MotionColumns) {
        vectorised(
            #[inline(always)]
            || {
                into.fill(
                    cranks,
                    #[inline(always)]
                    |crank| self.linkage.motion(crank),
                );
            },
        );
    }

    fn swings(&self, cranks: &Cranks, into: [&mut [f64]; 2]) {
        vectorised(
            #[inline(always)]
            || {
                fill(
                    cranks,
                    into,
                    #[inline(always)]
                    |crank| {
                        let Swing { velocity, acceleration } = self.linkage.swing(crank);
                        [velocity, acceleration]
                    },
                );
            },
        );
    }

    fn to_singularity(&self, _: f64) -> f64 {
        self.strip.height
    }

    fn force(&self, orders: &[u32], cancel: &Cancel) -> Result<Vec<Complex64>> {
        self.linkage.force(&self.strip, orders, cancel)
    }

    fn force_beyond(&self, highest: u32) -> Option<f64> {
        let of_crank = if highest == 0 { 1.0 } else { 0.0 };
        self.strip.accelerations_beyond(highest).map(|bound| bound + of_crank)
    }

    fn torque(&self, orders: &[u32], cancel: &Cancel) -> Result<TorqueHarmonics> {
        torques(
            orders,
            |n| self.torque_beyond(n),
            cancel,
            |crank| {
                let Motion { velocity, acceleration, .. } = self.motion(crank);
                [acceleration * velocity, -acceleration * velocity]
            },
        )
    }

    fn torque_beyond(&self, highest: u32) -> Option<f64> {
        let Strip { height, most } = self.strip;
        // In the strip the crankpin's own distance is at most cosh ρ.
        self.strip.products_beyond(most + height.cosh(), 0.0, highest)
    }

    fn swing_torque(&self, orders: &[u32], cancel: &Cancel) -> Result<TorqueHarmonics> {
        torques(
            orders,
            |n| self.swing_torque_beyond(n),
            cancel,
            |crank| {
                let swing = self.swing(crank);
                [swing.roll(), swing.crank()]
            },
        )
    }

    /// The rod's angle is the arc sine of what is below 1 in the strip: below a quarter turn.
    fn swing_torque_beyond(&self, highest: u32) -> Option<f64> {
        self.strip.products_beyond(std::f64::consts::FRAC_PI_2, 1.0, highest)
    }

    fn rod_ratio(&self) -> f64 {
        1.0 / self.linkage.rod
    }

    fn lengths(&self) -> &Cylinder {
        &self.lengths
    }

    /// Its proportions are five: a change of one alone is none of an engine.
    fn with_proportions(
        &self,
        rod_ratio: Option<f64>,
        pin_offset: Option<f64>,
    ) -> Result<Arc<dyn Mechanism>> {
        match (rod_ratio, pin_offset) {
            (None, None) => Ok(Arc::new(self.clone())),
            (Some(ratio), _) => Err(Error::figure("rod_ratio", ratio, HAS_LINK_RODS)),
            (None, Some(offset)) => Err(Error::figure("pin_offset", offset, HAS_LINK_RODS)),
        }
    }

    fn has_proportions(&self) -> bool {
        false
    }

    fn at_rod_ratios(
        &self,
        _: HarmonicsOf,
        _: &[f64],
        _: &[u32],
        _: &Cancel,
    ) -> Result<Option<Vec<f64>>> {
        Ok(None)
    }

    /// Quotients of lengths as they were typed, and exact angles.
    fn key(&self) -> MotionKey {
        let over = |length: f64| FigureKey::quotient(length, self.lengths.crank_radius());
        let signed = self.figures();
        let first = signed.iter().map(|(value, _)| *value).find(|value| *value != 0.0);
        let is_mirrored = first.is_some_and(|first| first < 0.0);
        // Signs beside the first one's.
        let senses = signed.iter().map(|(value, _)| value * first.unwrap_or(1.0) < 0.0);
        let sense = senses.fold(0, |bits, is_against| 2 * bits + u64::from(is_against));
        let lengths =
            [self.lengths.rod_length(), self.knuckle.radius, self.knuckle.master.rod_length()];
        let figures = lengths.map(over).into_iter().chain(signed.map(|(_, key)| key));
        let figures = figures.chain([FigureKey::Nearest(sense)]).collect();
        MotionKey { figures, is_mirrored }
    }

    fn exact_force(&self, order: u32) -> ExactHarmonic {
        let rest = if order % 2 == 1 && self.is_even() { Rest::None } else { Rest::Both };
        let is_certain = order == 1 && rest == Rest::None;
        ExactHarmonic { crank: order == 1, rest, is_certain }
    }

    fn exact_torque(&self, _: u32) -> ExactHarmonic {
        ExactHarmonic { crank: false, rest: Rest::Both, is_certain: false }
    }

    fn turning_points_deg(&self) -> [f64; 2] {
        self.linkage.turning_points_deg()
    }

    fn travel(&self) -> f64 {
        let [highest, lowest] = self
            .turning_points_deg()
            .map(|degrees| self.motion(&CrankPosition::at_degrees(degrees)).position);
        (highest - lowest) * self.lengths.crank_radius()
    }

    /// Errors of samples do not fall with the order.
    fn decay(&self) -> f64 {
        1.0
    }
}

/// Why lengths of an engine with link rods are not swept.
pub const HAS_LINK_RODS: &str =
    "the engine has link rods, which it would move elsewhere; build an engine for each value";
