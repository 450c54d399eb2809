//! Sums over the cylinders of a layout: where forces, moments and torques add up or cancel.

use nalgebra::Vector2;
use ndarray::{Array1, Array2};

use super::{Balance, Shake, Torque, choice};
use crate::Complex64;
use crate::cancel::Cancel;
use crate::engine::{Engine, Placement};
use crate::error::Result;
use crate::harmonics::{self, torque::TorqueHarmonics};
use crate::rational::common_multiple;
use crate::slider_crank::{Cylinder, Proportions};
use crate::spectrum::Spectrum;

/// Cylinders whose slider-cranks have the same proportions, hence the same harmonics.
pub(super) struct Group {
    pub proportions: Proportions,
    /// Indices into the engine's placements.
    pub members: Vec<usize>,
}

/// Group an engine's cylinders by their proportions.
fn groups(cylinders: impl Iterator<Item = Cylinder>) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (i, cylinder) in cylinders.enumerate() {
        let proportions = cylinder.proportions();
        match groups.iter_mut().find(|group| group.proportions == proportions) {
            Some(group) => group.members.push(i),
            None => groups.push(Group { proportions, members: vec![i] }),
        }
    }
    groups
}

/// What rounding can leave of a sum over `count` cylinders at order n, per unit of Σ|terms|.
///
/// Each angle comes with three roundings of half a unit of 360° (2.2 ε rad each), turned n-fold
/// in the phase and once in the direction; sines, products and weights add less than 8 ε, and the
/// summation (count − 1) ε.
pub(crate) fn zero_factor(count: usize, order: u32) -> f64 {
    (count as f64 + 16.0 + 8.0 * f64::from(order)) * f64::EPSILON
}

/// A sum is zero where it is within what rounding can leave.
pub(crate) fn snapped(sum: Complex64, bound: f64) -> Complex64 {
    // Mostly a part is larger, and no root is taken.
    let larger = sum.re.abs().max(sum.im.abs());
    if larger <= bound && sum.norm() <= bound { Complex64::default() } else { sum }
}

/// Weighted sum of unit vectors along the bores, in phase with their cylinders.
#[derive(Clone, Copy, Default)]
struct Planar {
    xy: Vector2<Complex64>,
    forward: Complex64,
    /// Conjugate of the backward part.
    backward_conj: Complex64,
    /// Σ|terms|.
    size: f64,
}

impl Planar {
    fn add(&mut self, weight: f64, size: f64, bore: Complex64, phase: Complex64) {
        let term = phase * weight;
        self.xy += Vector2::new(term * bore.re, term * bore.im);
        self.forward += term * bore * 0.5;
        self.backward_conj += term * bore.conj() * 0.5;
        self.size += size;
    }

    /// A mass that turns with the pin: all of it forward.
    fn add_rotating(&mut self, weight: f64, size: f64, pin: Complex64) {
        let term = pin * weight;
        self.xy += Vector2::new(term, -Complex64::i() * term);
        self.forward += term;
        self.size += size;
    }

    fn add_scaled(&mut self, other: &Self, factor: Complex64) {
        self.xy += other.xy * factor;
        self.forward += other.forward * factor;
        self.backward_conj += other.backward_conj * factor;
        self.size += other.size * factor.norm();
    }

    /// The same sum turned a quarter forward: the moment of levered forces.
    fn quarter_turned(&self) -> Self {
        let i = Complex64::i();
        Self {
            xy: Vector2::new(-self.xy.y, self.xy.x),
            forward: i * self.forward,
            backward_conj: -i * self.backward_conj,
            size: self.size,
        }
    }
}

/// Everything about an engine that does not depend on the order.
pub(super) struct Sums<'a> {
    engine: &'a Engine,
    pub spectrum: Option<&'a Spectrum>,
    /// Whether torques are wanted, and known.
    pub torque: bool,
    pub groups: Vec<Group>,
    bores: Vec<Complex64>,
    /// Lever about the reference plane, and the size its rounding is relative to.
    levers: Vec<(f64, f64)>,
    pub reference: f64,
}

impl<'a> Sums<'a> {
    pub fn new(
        engine: &'a Engine,
        reference: f64,
        spectrum: Option<&'a Spectrum>,
        torque: bool,
    ) -> Self {
        let placements = engine.placements();
        Self {
            engine,
            spectrum,
            torque: torque && spectrum.is_none(),
            groups: groups(placements.iter().map(|p| p.cylinder)),
            bores: placements.iter().map(|p| p.bank.cis(1)).collect(),
            levers: placements
                .iter()
                .map(|p| (p.z - reference, p.z.abs() + reference.abs()))
                .collect(),
            reference,
        }
    }

    pub fn balance(&self, orders: &[u32], omega: f64, cancel: &Cancel) -> Result<Balance> {
        let square = omega * omega;
        let count = orders.len();
        let mut force = empty_shake(count);
        let mut moment = empty_shake(count);
        let harmonics = self.groups.iter().map(|group| self.harmonics(group, orders, cancel));
        let harmonics: Vec<Vec<Complex64>> = harmonics.collect::<Result<_>>()?;
        for (k, &n) in orders.iter().enumerate() {
            cancel.check()?;
            let (mut forces, mut levered) = (Planar::default(), Planar::default());
            for (group, harmonics) in self.groups.iter().zip(&harmonics) {
                if harmonics[k] == Complex64::default() {
                    continue;
                }
                let (group_forces, group_levered) = self.reciprocating(group, n);
                forces.add_scaled(&group_forces, harmonics[k]);
                levered.add_scaled(&group_levered, harmonics[k]);
            }
            if n == 1 {
                self.add_rotating(&mut forces, &mut levered);
            }
            let factor = zero_factor(self.bores.len(), n);
            store(&mut force, k, &forces, square, factor);
            store(&mut moment, k, &levered.quarter_turned(), square, factor);
        }
        let torque = self.torque.then(|| self.torques(orders, square, cancel)).transpose()?;
        Ok(Balance { orders: orders.to_vec(), omitted: Vec::new(), force, moment, torque })
    }

    /// Amplitudes by which the layout sums of a group are multiplied.
    fn harmonics(&self, group: &Group, orders: &[u32], cancel: &Cancel) -> Result<Vec<Complex64>> {
        match self.spectrum {
            Some(spectrum) => Ok(orders.iter().map(|&n| spectrum.amplitude(n)).collect()),
            None => harmonics::coefficients(&group.proportions, orders, cancel),
        }
    }

    fn reciprocating(&self, group: &Group, order: u32) -> (Planar, Planar) {
        let (mut forces, mut levered) = (Planar::default(), Planar::default());
        for &i in &group.members {
            let placement = &self.engine.placements()[i];
            // A spectrum in kg·m already has the mass and the radius in it.
            let weight =
                if self.spectrum.is_some() { 1.0 } else { placement.cylinder.first_order() };
            let phase = placement.tdc.cis(-i64::from(order));
            let (lever, lever_size) = self.levers[i];
            forces.add(weight, weight, self.bores[i], phase);
            levered.add(weight * lever, weight * lever_size, self.bores[i], phase);
        }
        (forces, levered)
    }

    fn add_rotating(&self, forces: &mut Planar, levered: &mut Planar) {
        for (placement, &(lever, lever_size)) in self.engine.placements().iter().zip(&self.levers) {
            let weight = placement.rotating_mass * placement.cylinder.crank_radius();
            if weight > 0.0 {
                let pin = placement.pin().cis(1);
                forces.add_rotating(weight, weight, pin);
                levered.add_rotating(weight * lever, weight * lever_size, pin);
            }
        }
    }

    fn torques(&self, orders: &[u32], square: f64, cancel: &Cancel) -> Result<Torque> {
        let mut torque = Torque {
            roll: Array1::default(orders.len()),
            crank: Array1::default(orders.len()),
            zero_bound: Array1::default(orders.len()),
            error_bound: 0.0,
        };
        for group in &self.groups {
            let harmonics = harmonics::torque::torque(&group.proportions, orders, cancel)?;
            self.add_torques(
                &mut torque,
                group,
                orders,
                square,
                &harmonics,
                Cylinder::second_moment,
            );
            if self.has_rod_inertia(group) {
                let harmonics = harmonics::rod::torque(&group.proportions, orders, cancel)?;
                let inertia = Cylinder::rod_inertia_excess;
                self.add_torques(&mut torque, group, orders, square, &harmonics, inertia);
            }
        }
        for (k, &n) in orders.iter().enumerate() {
            torque.zero_bound[k] *= zero_factor(self.bores.len(), n);
            torque.roll[k] = snapped(torque.roll[k], torque.zero_bound[k]);
            torque.crank[k] = snapped(torque.crank[k], torque.zero_bound[k]);
        }
        Ok(torque)
    }

    /// Torques of a group, whose harmonics count with m·r², or with the rod's inertia.
    fn add_torques(
        &self,
        torque: &mut Torque,
        group: &Group,
        orders: &[u32],
        square: f64,
        harmonics: &TorqueHarmonics,
        weight: fn(&Cylinder) -> f64,
    ) {
        for (k, &n) in orders.iter().enumerate() {
            let (sum, size) = self.turning(group, n, weight);
            let (sum, size) = (sum * square, size * square);
            torque.roll[k] += sum * harmonics.roll[k];
            torque.crank[k] += sum * harmonics.crank[k];
            torque.zero_bound[k] += size * harmonics.roll[k].norm().max(harmonics.crank[k].norm());
        }
    }

    /// Σ weight·e^{−in·tdc} of a group, and Σ|terms|.
    fn turning(&self, group: &Group, order: u32, weight: fn(&Cylinder) -> f64) -> (Complex64, f64) {
        let (mut sum, mut size) = (Complex64::default(), 0.0);
        for &i in &group.members {
            let Placement { cylinder, tdc, .. } = &self.engine.placements()[i];
            let weight = weight(cylinder);
            sum += tdc.cis(-i64::from(order)) * weight;
            size += weight.abs();
        }
        (sum, size)
    }

    fn has_rod_inertia(&self, group: &Group) -> bool {
        let mut members = group.members.iter().map(|&i| &self.engine.placements()[i]);
        members.any(|placement| placement.cylinder.has_rod_inertia())
    }

    /// What orders above `highest` can add to force, moment and torque over ω².
    pub fn tail(&self, highest: u32) -> [f64; 3] {
        let mut tail = [0.0; 3];
        for group in &self.groups {
            let [force, torque] = choice::tail(&group.proportions, highest, self.torque);
            let of_rod =
                if self.torque { choice::rod_tail(&group.proportions, highest) } else { 0.0 };
            let parts = [0, 1, 2, 2].into_iter().zip([force, force, torque, of_rod]);
            for ((sum, bound), most) in parts.zip(self.most(group, highest)) {
                tail[sum] += if most == 0.0 { 0.0 } else { most * bound };
            }
        }
        tail
    }

    /// What a group's force, moment, torque and torque of rod inertia can be at any order, per unit of
    /// its harmonic and ω².
    ///
    /// Top dead centres that are parts of a turn make layout sums periodic in the order: the largest
    /// of a period, up to `longest`. Otherwise as if nothing cancelled.
    fn most(&self, group: &Group, longest: u32) -> [f64; 4] {
        let mut most = [0.0_f64; 4];
        let Some(period) = self.period(group, longest) else {
            for &i in &group.members {
                let cylinder = self.engine.placements()[i].cylinder;
                most[0] += cylinder.first_order();
                most[1] += cylinder.first_order() * self.levers[i].0.abs();
                most[2] += cylinder.second_moment();
                most[3] += cylinder.rod_inertia_excess().abs();
            }
            return most;
        };
        for order in 1..=period {
            let factor = zero_factor(self.bores.len(), order);
            let length = |sum: &Planar| {
                let bound = sum.size * factor;
                snapped(sum.forward, bound).norm() + snapped(sum.backward_conj, bound).norm()
            };
            let (forces, levered) = self.reciprocating(group, order);
            most[0] = most[0].max(length(&forces));
            most[1] = most[1].max(length(&levered));
            if self.torque {
                let weights = [Cylinder::second_moment, Cylinder::rod_inertia_excess];
                for (most, weight) in most[2..].iter_mut().zip(weights) {
                    let (sum, size) = self.turning(group, order, weight);
                    *most = most.max(snapped(sum, size * factor).norm());
                }
            }
        }
        most
    }

    /// After how many orders the layout sums of a group come again.
    fn period(&self, group: &Group, longest: u32) -> Option<u32> {
        let mut period = 1;
        for &i in &group.members {
            let (_, parts) = self.engine.placements()[i].tdc.turns()?;
            period = common_multiple(period, i128::from(parts))?;
        }
        u32::try_from(period).ok().filter(|&period| period <= longest)
    }
}

fn empty_shake(count: usize) -> Shake {
    Shake {
        xy: Array2::default((count, 2)),
        forward: Array1::default(count),
        backward: Array1::default(count),
        zero_bound: Array1::default(count),
        error_bound: 0.0,
    }
}

fn store(shake: &mut Shake, k: usize, sum: &Planar, square: f64, factor: f64) {
    let bound = sum.size * square * factor;
    shake.xy[[k, 0]] = snapped(sum.xy.x * square, bound);
    shake.xy[[k, 1]] = snapped(sum.xy.y * square, bound);
    shake.forward[k] = snapped(sum.forward * square, bound);
    shake.backward[k] = snapped(sum.backward_conj.conj() * square, bound);
    shake.zero_bound[k] = bound;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_longer_than_the_bound_stays_though_its_parts_are_not() {
        let z = Complex64::new(0.8, -0.8);
        assert_eq!(snapped(z, 1.0), z);
        assert_eq!(snapped(z, 1.2), Complex64::default());
        assert_eq!(snapped(z, 0.7), z);
    }

    fn engine(cylinder: Cylinder, places: &[(f64, f64, f64)]) -> Engine {
        let angle = |degrees| crate::Angle::from_degrees(degrees).unwrap();
        let place = |&(tdc, bank, z): &(f64, f64, f64)| Placement {
            cylinder,
            tdc: angle(tdc),
            bank: angle(bank),
            z,
            rotating_mass: 0.0,
        };
        Engine::new("", "", places.iter().map(place).collect()).unwrap()
    }

    /// Per m·r = 1, crank radius 0.05 m, about z = 0.1.
    #[track_caller]
    fn most_is(places: &[(f64, f64, f64)], longest: u32, expected: [f64; 3]) {
        let engine = engine(Cylinder::new(0.05, 0.15, 20.0, 0.0).unwrap(), places);
        let sums = Sums::new(&engine, 0.1, None, true);
        let most = sums.most(&sums.groups[0], longest);
        let near = most.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14);
        assert!(near, "{most:?} is not {expected:?}");
    }

    #[test]
    fn a_layout_makes_at_most_what_its_worst_order_does() {
        // In phase at order 3; apart, at orders 1 and 2, the levers −0.1, 0, 0.3 at 120° leave
        // √(0.1² + 0.3² + 0.1·0.3) = √0.13.
        let three = [(0.0, 90.0, 0.0), (120.0, 90.0, 0.1), (240.0, 90.0, 0.4)];
        most_is(&three, 100, [3.0, 0.13_f64.sqrt(), 0.15]);
        // The period is 3: where no more is asked for, nothing is known to cancel.
        most_is(&three, 3, [3.0, 0.13_f64.sqrt(), 0.15]);
        most_is(&three, 2, [3.0, 0.4, 0.15]);
        let odd = three.map(|(tdc, bank, z)| (tdc + 1.234_567, bank, z));
        most_is(&odd, 100, [3.0, 0.4, 0.15]);
        // A boxer pair in one plane has no force or moment at all, and torques that add up.
        most_is(&[(0.0, 0.0, 0.3), (0.0, 180.0, 0.3)], 100, [0.0, 0.0, 0.1]);
        // Half a turn apart in line: even orders add up.
        most_is(&[(0.0, 90.0, 0.0), (180.0, 90.0, 0.3)], 100, [2.0, 0.3, 0.1]);
    }

    #[test]
    fn the_tail_is_that_of_every_group_times_what_its_layout_makes() {
        let [a, b] = [Cylinder::new(0.05, 0.15, 20.0, 0.0), Cylinder::new(0.05, 0.12, 10.0, 0.0)];
        let (a, b) = (a.unwrap(), b.unwrap());
        let alike = engine(a, &[(0.0, 90.0, 0.0), (0.0, 90.0, 0.3)]);
        let mut placements = alike.placements().to_vec();
        placements.push(Placement { cylinder: b, z: 0.2, ..placements[0] });
        let both = Engine::new("", "", placements).unwrap();
        for highest in [1, 4, 9] {
            let [of_a, of_b] = [a, b].map(|c| choice::tail(&c.proportions(), highest, true));
            let expected = [
                2.0 * of_a[0] + 0.5 * of_b[0],
                // Levers −0.1 and 0.2 in phase, and 0.1.
                0.1 * of_a[0] + 0.05 * of_b[0],
                0.1 * of_a[1] + 0.025 * of_b[1],
            ];
            let tail = Sums::new(&both, 0.1, None, true).tail(highest);
            for (tail, expected) in tail.iter().zip(expected) {
                assert!((tail / expected - 1.0).abs() < 1e-13, "{tail} {expected}");
            }
            let [force, _, none] = Sums::new(&both, 0.1, None, false).tail(highest);
            assert_eq!((force, none), (tail[0], 0.0));
        }
        // A rod's inertia adds to torque what it makes, where it does not cancel.
        let rod = a.with_rod_inertia_excess(-0.02).unwrap();
        for (odd, tdc) in [(0.0, 180.0), (1.234_567, 90.0)] {
            let pair = [(odd, 90.0, 0.0), (odd + tdc, 90.0, 0.3)];
            let [with, without] =
                [rod, a].map(|c| Sums::new(&engine(c, &pair), 0.1, None, true).tail(4));
            let rods = 0.04 * choice::rod_tail(&a.proportions(), 4);
            assert_eq!(with[..2], without[..2]);
            assert!(((with[2] - without[2]) / rods - 1.0).abs() < 1e-12);
            assert_eq!(Sums::new(&engine(rod, &pair), 0.1, None, false).tail(4)[2], 0.0);
        }
        // Nothing times a bound that is not finite is nothing.
        let stiff = Cylinder::new(0.05, 0.05 * (1.0 + 1e-15), 1.0, 0.0).unwrap();
        let boxer = engine(stiff, &[(0.0, 0.0, 0.3), (0.0, 180.0, 0.3)]);
        assert_eq!(Sums::new(&boxer, 0.0, None, true).tail(2)[..2], [0.0, 0.0]);
    }
}
