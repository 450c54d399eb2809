//! Bob weights: masses that a crankshaft is balanced against, and the residual of order 1 by balance factor.

use super::TurningPart;
use crate::Complex64;
use crate::engine::{CrankIndex, Engine, Unbalance};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::figure::rounded;
use crate::numbers::limits::SMALLEST;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::readings::balance::Vector;
use crate::readings::explain::words::{across, turns};
use crate::readings::turning::over_square;
use crate::wrench::tilt_deg;

/// Largest share of the reciprocating mass that is balanced.
pub const LARGEST_FACTOR: f64 = 10.0;
/// Factors that differ by less, and relative figures below, are rounding.
const ALIKE: f64 = 1e-12;
/// Of an interval of factors, to the last digits of a double.
const HALVINGS: u32 = 60;
/// Part of a sum that its rounding is below.
pub(super) const SUM_ROUNDING: f64 = 1e-14;
/// Part of the sum of all magnitudes of an engine that their rounding is below.
const ROUNDING_OF_ALL: f64 = 1e-15;

/// The engine with counterweights opposite its crankpins, in place of those it has, that balance a bob
/// weight at each: all of the rotating and a share of the reciprocating mass.
///
/// The mass at the knuckle of a link rod rotates but for the part that moves as the master's wrist pin: where it turns
/// with the crank, the knuckle's angle ahead of the crankpin.
pub fn with_bob_weights(engine: &Engine, factor: f64) -> Result<Engine> {
    let mut weights = Vec::new();
    for (i, station) in engine.stations().iter().enumerate() {
        let mut push = |mass: f64, angle: Angle| {
            let amount = mass * station.cylinder.crank_radius();
            let angle = if amount < 0.0 { (angle + Angle::HALF_TURN).reduced() } else { angle };
            if amount.abs() >= SMALLEST {
                let (amount, crank) = (amount.abs(), CrankIndex::MAIN);
                weights.push(Unbalance { amount, angle, z: station.z, pin: Some(i), crank });
            }
        };
        let knuckle = engine.knuckle_mass(i);
        let rotating = station.rotating_mass + knuckle.map_or(0.0, |knuckle| knuckle.mass);
        let reciprocating = station.cylinder.reciprocating_mass();
        push(bob_weight([rotating, reciprocating], factor), Angle::HALF_TURN);
        if let Some(knuckle) = knuckle {
            push((1.0 - factor) * (knuckle.mass * knuckle.share), knuckle.angle);
        }
    }
    engine.with_counterweights(weights)
}

/// Bob weight, kg, of a rotating and a reciprocating mass: all of the one and a share of the other.
pub(super) fn bob_weight([rotating, reciprocating]: [f64; 2], factor: f64) -> f64 {
    rotating + factor * reciprocating
}

/// Amount, kg·m, and direction from the crankpin, degrees, of the weight at the pin that removes the forward part of
/// its cylinder's first order: half the reciprocating mass, whatever the bank, and all that rotates.
///
/// With an offset piston pin the first harmonic is a complex number, and the weight beside the opposite of the pin.
pub fn forward_weight(
    cylinder: &Cylinder,
    rotating_mass: f64,
    cancel: &Cancel,
) -> Result<[f64; 2]> {
    let first = cylinder.mechanism().force(&[1], cancel)?[0];
    let mass = first * (0.5 * cylinder.reciprocating_mass()) + rotating_mass;
    let weight = mass * -cylinder.crank_radius();
    Ok([weight.norm(), rounded(weight.arg().to_degrees(), 13)])
}

/// Force, moment and roll torque of order 1 by balance factor, over ω².
///
/// ```
/// # let single = crankpin_core::engine::file::from_toml(
/// #     "schema = 1
/// #     cylinder = { crank_radius = 0.04, rod_length = 0.13, reciprocating_mass = 0.5 }
/// #     placements = [{ tdc_deg = 0, bank_deg = 90, z = 0 }]",
/// # )?;
/// use crankpin_core::Cancel;
/// use crankpin_core::balance::Vector;
/// use crankpin_core::balancing::bob_weight::FirstOrder;
///
/// let single = FirstOrder::new(&single, &Cancel::new())?;
/// let straight = single.straight(Vector::Force); // factors, and directions from +x
/// assert_eq!(straight, [(0.0, 90.0), (1.0, 0.0)]);
/// assert_eq!(single.least(Vector::Force), Some(0.5));
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FirstOrder {
    /// Forward and backward part.
    force: [PartByFactor; 2],
    moment: [PartByFactor; 2],
    /// Roll torque of inertia about the axis of the main crank, which weights change about other axes.
    roll: PartByFactor,
}

/// Part of a vector that turns in one sense, by balance factor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct PartByFactor {
    /// At factor 0.
    start: Complex64,
    /// To factor 1.
    change: Complex64,
    /// Sum of the magnitudes that cancel in it.
    size: f64,
}

impl PartByFactor {
    /// By factor; rounding of one that vanishes is zero.
    fn at(&self, factor: f64) -> Complex64 {
        let added = self.change * factor;
        let part = self.start + added;
        // What is left of many figures that cancel is as large as the rounding of their sum.
        let of_sum = SUM_ROUNDING * (self.start.norm() + added.norm());
        let least = of_sum.max(ROUNDING_OF_ALL * (1.0 + factor) * self.size);
        if part.norm() < least { Complex64::default() } else { part }
    }

    fn changes(&self) -> bool {
        self.change != Complex64::default()
    }

    /// Whether it is not zero at every factor.
    fn exists(&self) -> bool {
        self.start != Complex64::default() || self.changes()
    }

    /// Factor at which the part is smallest.
    fn nearest(&self) -> f64 {
        // Squares of what is small would underflow.
        let unit = self.change.norm();
        let (start, change) = (self.start / unit, self.change / unit);
        -(start * change.conj()).re / change.norm_sqr()
    }

    /// Change of its size per unit of factor.
    fn slope(&self, factor: f64) -> f64 {
        let part = self.start + self.change * factor;
        let size = part.norm();
        if size == 0.0 { 0.0 } else { (part.conj() / size * self.change).re }
    }
}

impl FirstOrder {
    /// Of an engine, whose counterweights those of the bob weights replace.
    ///
    /// A bob weight changes the part that turns with its own crank.
    pub fn new(engine: &Engine, cancel: &Cancel) -> Result<Self> {
        let [bare, weighted] = [0.0, 1.0].map(|factor| with_bob_weights(engine, factor));
        let (bare, weighted) = (bare?, weighted?);
        let reference = engine.reference(None)?;
        let weights = weighted.counterweights();
        let of_force: f64 = weights.iter().map(|weight| weight.amount).sum();
        let lever = |weight: &Unbalance| (weight.z - reference).abs();
        let of_moment: f64 = weights.iter().map(|weight| weight.amount * lever(weight)).sum();
        let [start, end] = [&bare, &weighted].map(|engine| {
            over_square(&engine.of_speed_squared(), Order::FIRST, true, None, cancel)
        });
        let (start, end) = (start?, end?);
        let arm = |weight: &Unbalance| {
            let [x, y] = engine.cranks()[engine.crank_carrying(weight)].axis;
            weight.amount * x.hypot(y)
        };
        let arms: f64 = weights.iter().map(arm).sum();
        let change =
            if arms == 0.0 { Complex64::default() } else { end.torque.roll - start.torque.roll };
        let roll = PartByFactor { start: start.torque.roll, change, size: arms };
        let mut found = Self {
            force: [PartByFactor::default(); 2],
            moment: [PartByFactor::default(); 2],
            roll,
        };
        for (sense, ratio) in [1, -1].map(SpeedRatio::whole).into_iter().enumerate() {
            let changes = engine.cranks().iter().any(|crank| crank.ratio == ratio);
            let [one, other] = [&start, &end].map(|wrench| TurningPart::of(wrench, ratio));
            let part = |start: Complex64, end: Complex64, size: f64| {
                let change = if changes { end - start } else { Complex64::default() };
                PartByFactor { start, change, size }
            };
            found.force[sense] = part(one.force, other.force, of_force);
            found.moment[sense] = part(one.moment, other.moment, of_moment);
        }
        Ok(found)
    }

    fn parts(&self, vector: Vector) -> &[PartByFactor; 2] {
        match vector {
            Vector::Force => &self.force,
            Vector::Moment => &self.moment,
        }
    }

    /// Whether there is a force or moment of order 1 at some factor.
    #[must_use]
    pub fn exists(&self, vector: Vector) -> bool {
        self.parts(vector).iter().any(PartByFactor::exists)
    }

    /// Roll torque about the axis of the main crank, kg·m².
    #[must_use]
    pub fn roll(&self, factor: f64) -> f64 {
        self.roll.at(factor).norm()
    }

    /// Whether there is a roll torque of order 1 at some factor.
    #[must_use]
    pub fn has_roll(&self) -> bool {
        self.roll.exists()
    }

    /// Longest and shortest half axis, kg·m or kg·m²; the shortest below zero where the vector turns against
    /// the main crank.
    #[must_use]
    pub fn half_axes(&self, vector: Vector, factor: f64) -> [f64; 2] {
        let parts = self.parts(vector);
        let [forward, backward] = parts.map(|part| part.at(factor).norm());
        let (longest, shortest) = (forward + backward, forward - backward);
        let of_all = ROUNDING_OF_ALL * (1.0 + factor) * parts[0].size;
        let least = of_all.max(SUM_ROUNDING * longest);
        [longest, if shortest.abs() < least { 0.0 } else { shortest }]
    }

    /// Factor of the least longest vector, from 0 to [`LARGEST_FACTOR`]; none if it makes no difference.
    #[must_use]
    pub fn least(&self, vector: Vector) -> Option<f64> {
        let changing = || self.parts(vector).iter().filter(|part| part.changes());
        // The sum of two convex sizes is least between the factors at which either is.
        let mut low = changing().map(PartByFactor::nearest).reduce(f64::min)?;
        let mut high = changing().map(PartByFactor::nearest).reduce(f64::max)?;
        for _ in 0..if high - low > ALIKE { HALVINGS } else { 0 } {
            let middle = 0.5 * (low + high);
            if changing().map(|part| part.slope(middle)).sum::<f64>() > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(low.clamp(0.0, LARGEST_FACTOR))
    }

    /// Factors from 0 to [`LARGEST_FACTOR`] that leave a vector along a straight line, and its direction,
    /// degrees from +x in (−90, 90]; none where every factor does.
    #[must_use]
    pub fn straight(&self, vector: Vector) -> Vec<(f64, f64)> {
        let [forward, backward] = self.parts(vector);
        let factors = of_one_size(forward, backward).into_iter();
        let within = factors.filter(|factor| (0.0..=LARGEST_FACTOR).contains(factor));
        within.filter_map(|factor| Some((factor, self.direction_deg(vector, factor)?))).collect()
    }

    /// Direction of the longest half axis, degrees from +x in (−90, 90]; none where either part vanishes:
    /// a circle has no longest half axis.
    #[must_use]
    pub fn direction_deg(&self, vector: Vector, factor: f64) -> Option<f64> {
        let [forward, backward] = self.parts(vector).map(|part| part.at(factor));
        let tilt = rounded(tilt_deg(forward, backward)?, 9);
        Some(if tilt <= -90.0 { 90.0 } else { tilt + 0.0 }) // no −0
    }

    /// Which way the longest half axis points, in words, and of a moment which way the ends go; `sides` is
    /// what is on the right and on the left, seen from the flywheel.
    #[must_use]
    pub fn direction(&self, vector: Vector, factor: f64, sides: [&str; 2]) -> String {
        match (self.direction_deg(vector, factor), self.half_axes(vector, factor)) {
            (Some(tilt), _) if vector == Vector::Force => across(tilt, sides),
            // A moment about x moves the ends up and down.
            (Some(tilt), _) => across(tilt - 90.0, sides),
            (None, [0.0, _]) => "–".to_owned(),
            (None, [_, shortest]) => turns(shortest),
        }
    }
}

/// Factors at which two parts have one size, ascending; none where all have.
fn of_one_size(forward: &PartByFactor, backward: &PartByFactor) -> Vec<f64> {
    if forward.changes() && backward.changes() {
        // |forward|² − |backward|² is quadratic in the factor.
        let unit = forward.change.norm().max(backward.change.norm()); // squares would underflow
        let terms = [(forward, 1.0), (backward, -1.0)].map(|(part, sign)| {
            let (start, change) = (part.start / unit, part.change / unit);
            let both = (start.conj() * change).re;
            [sign * change.norm().powi(2), 2.0 * sign * both, sign * start.norm().powi(2)]
        });
        let largest = terms.iter().flatten().map(|term| term.abs()).fold(0.0, f64::max);
        let sum = |power: usize| {
            let sum = terms[0][power] + terms[1][power];
            if sum.abs() > ALIKE * largest { sum } else { 0.0 }
        };
        return roots([0, 1, 2].map(sum));
    }
    let (moving, still) = if forward.changes() { (forward, backward) } else { (backward, forward) };
    if !moving.changes() || still.start == Complex64::default() {
        return Vec::new();
    }
    // |start + κ·change| = |still|, about the factor at which the left side is least.
    let middle = moving.nearest();
    let least = (moving.start + moving.change * middle).norm();
    let [under, over] = [-least, least].map(|least| still.start.norm() + least);
    if under < 0.0 {
        return Vec::new();
    }
    let change = moving.change.norm();
    let apart = (under / change).sqrt() * (over / change).sqrt();
    // A root of zero comes out beside it.
    let mut found =
        [middle - apart, middle + apart].map(|x| if x.abs() < ALIKE { 0.0 } else { x }).to_vec();
    found.dedup();
    found
}

/// Real roots of a quadratic, ascending; none of one that is zero throughout.
fn roots([square, linear, constant]: [f64; 3]) -> Vec<f64> {
    if square == 0.0 {
        return if linear == 0.0 { Vec::new() } else { vec![0.0 - constant / linear] };
    }
    let discriminant = linear * linear - 4.0 * square * constant;
    // A double root comes out with a trace beside the real axis.
    if discriminant < 0.0
        && discriminant.abs().sqrt() > ALIKE * 2.0 * (square * constant).abs().sqrt()
    {
        return Vec::new();
    }
    let sum = -0.5 * (linear + discriminant.max(0.0).sqrt().copysign(linear));
    if sum == 0.0 {
        return vec![0.0];
    }
    let mut found = vec![sum / square, 0.0 + constant / sum];
    found.sort_by(f64::total_cmp);
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadratics_have_their_real_roots() {
        let of = |terms| roots(terms);
        assert_eq!(of([1.0, -3.0, 2.0]), [1.0, 2.0]);
        assert_eq!(of([1.0, 2.0, -3.0]), [-3.0, 1.0]);
        assert_eq!(of([1.0, -1.0, 0.0]), [0.0, 1.0]);
        assert_eq!(of([2.0, 0.0, -8.0]), [-2.0, 2.0]);
        assert_eq!((of([1.0, -2.0, 1.0]), of([3.0, 0.0, 0.0])), (vec![1.0], vec![0.0]));
        assert_eq!((of([0.0, 2.0, -1.0]), of([0.0, 2.0, 0.0])), (vec![0.5], vec![0.0]));
        assert!(of([1.0, 0.0, 1.0]).is_empty() && of([0.0, 0.0, 1.0]).is_empty());
    }

    #[test]
    fn parts_of_one_size_and_the_least_of_their_sum() {
        let part = |start: f64, change: f64| PartByFactor {
            start: Complex64::new(start, 0.0),
            change: Complex64::new(0.0, change),
            size: 0.0,
        };
        // |1 + 2iκ| is 1 and more, and 3 at √2.
        let found = of_one_size(&part(1.0, 2.0), &part(3.0, 0.0));
        assert!(
            found.iter().zip([-2.0_f64.sqrt(), 2.0_f64.sqrt()]).all(|(a, b)| (a - b).abs() < 1e-15)
        );
        assert_eq!(found.len(), 2);
        assert!(of_one_size(&part(3.0, 2.0), &part(1.0, 0.0)).is_empty());
        assert!(of_one_size(&part(1.0, 0.0), &part(1.0, 0.0)).is_empty());
        // Both change: 1 + 4κ² = 9 + κ².
        let found = of_one_size(&part(1.0, 2.0), &part(3.0, 1.0));
        let root = (8.0_f64 / 3.0).sqrt();
        // A handful of roundings of figures of about 2.
        assert!((found[1] - root).abs() < 4e-15 && (found[0] + root).abs() < 4e-15);
        let both = FirstOrder {
            force: [part(1.0, 2.0), part(3.0, 1.0)],
            moment: [PartByFactor::default(); 2],
            roll: PartByFactor::default(),
        };
        assert_eq!((both.least(Vector::Force), both.least(Vector::Moment)), (Some(0.0), None));
        assert!(both.exists(Vector::Force) && !both.exists(Vector::Moment));
        assert_eq!(both.half_axes(Vector::Force, 0.0), [4.0, -2.0]);
        assert_eq!(both.direction(Vector::Moment, 0.5, ["right", "left"]), "–");
    }
}
