//! Exact kinematics of a whole engine: cylinders that move alike are worked out once.

use std::ops::{Deref, DerefMut};

use crate::Complex64;
use crate::engine::Placement;
use crate::slider_crank::{Crank, Cylinder};

/// Crank angles that go through a cylinder's kinematics side by side.
pub(crate) const BLOCK: usize = 256;

/// One value for each crank angle of a block; whole lines of the cache.
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

/// What turns a cylinder's motion into forces, over ω².
pub(crate) struct Kinematics {
    pub groups: Vec<Alike>,
    /// Rotating masses: force and moment at θ = 0 as x + iy, both turning with the crank.
    pub rotating: [Complex64; 2],
}

/// Cylinders with the same slider-crank and the same top dead centre.
pub(crate) struct Alike {
    /// One of them.
    pub cylinder: Cylinder,
    /// `e^{−i·tdc}`.
    pub phase: Complex64,
    /// Force and moment, x + iy, for one radius of acceleration.
    pub along: [Complex64; 2],
    /// Σ m·r².
    pub torque: f64,
    /// Σ of the rods' inertia beyond their two masses.
    pub rod_inertia: f64,
}

impl Kinematics {
    pub fn new(placements: &[Placement], reference: f64) -> Self {
        let (mut groups, mut found) = (Vec::<Alike>::new(), Vec::<&Placement>::new());
        let mut rotating = [Complex64::default(); 2];
        // A moment is its levered force turned by a quarter.
        let both =
            |force: Complex64, p: &Placement| [force, Complex64::new(0.0, p.z - reference) * force];
        for p in placements {
            let same = |other: &&Placement| {
                let [a, b] = [other.cylinder, p.cylinder];
                other.tdc == p.tdc
                    && a.crank_radius() == b.crank_radius()
                    && a.rod_length() == b.rod_length()
                    && a.pin_offset() == b.pin_offset()
            };
            let k = found.iter().position(same).unwrap_or_else(|| {
                found.push(p);
                groups.push(Alike {
                    cylinder: p.cylinder,
                    phase: p.tdc.cis(-1),
                    along: Default::default(),
                    torque: 0.0,
                    rod_inertia: 0.0,
                });
                groups.len() - 1
            });
            let (radius, weight) = (p.cylinder.crank_radius(), p.cylinder.first_order());
            for (sum, term) in groups[k].along.iter_mut().zip(both(-p.bank.cis(1) * weight, p)) {
                *sum += term;
            }
            groups[k].torque += weight * radius;
            groups[k].rod_inertia += p.cylinder.rod_inertia_excess();
            if p.rotating_mass > 0.0 {
                let force = p.pin().cis(1) * (p.rotating_mass * radius);
                for (sum, term) in rotating.iter_mut().zip(both(force, p)) {
                    *sum += term;
                }
            }
        }
        Self { groups, rotating }
    }

    /// What they take, if cylinders that move alike take so much, and more with a rod's inertia.
    pub fn cost(&self, alike: f64, rod: f64) -> f64 {
        let of = |group: &Alike| if group.rod_inertia == 0.0 { alike } else { alike + rod };
        self.groups.iter().map(of).sum()
    }
}

/// `e^{iθ}` of a block of crank angles.
#[derive(Clone)]
pub(crate) struct Units {
    pub cos: Column,
    pub sin: Column,
}

impl Units {
    /// At θ = 0.
    pub const START: Self = Self { cos: Column([1.0; BLOCK]), sin: Column::ZERO };

    /// Where a crank stands that is `phase` ahead.
    #[inline(always)]
    pub fn crank(&self, phase: Complex64, i: usize) -> Crank {
        let (cos, sin) = (self.cos[i], self.sin[i]);
        Crank::new(sin * phase.re + cos * phase.im, cos * phase.re - sin * phase.im)
    }

    /// Add what turns with the crank, x + iy.
    #[inline(always)]
    pub fn add_turning(&self, at_start: Complex64, [x, y]: [&mut Column; 2]) {
        if at_start == Complex64::default() {
            return;
        }
        for i in 0..BLOCK {
            let (cos, sin) = (self.cos[i], self.sin[i]);
            x[i] += at_start.re * cos - at_start.im * sin;
            y[i] += at_start.re * sin + at_start.im * cos;
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::angle::Angle;
    use crate::engine::Engine;

    fn place(cylinder: Cylinder, tdc: f64) -> Placement {
        Placement {
            cylinder,
            tdc: Angle::from_degrees(tdc).unwrap(),
            bank: Angle::ZERO,
            z: 0.0,
            rotating_mass: 0.0,
        }
    }

    /// An engine of so many cylinders, none of which moves like another.
    pub(crate) fn unlike(count: u32) -> Engine {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let placements = (0..count).map(|k| place(cylinder, f64::from(k))).collect();
        Engine::new("", "", placements).unwrap()
    }

    #[test]
    fn groups_cost_alike_and_more_with_a_rods_inertia() {
        let plain = Cylinder::new(0.05, 0.15, 1.0, 0.0).unwrap();
        let with_rod = plain.with_rod_inertia_excess(1e-3).unwrap();
        let cost = |placements: &[Placement]| Kinematics::new(placements, 0.0).cost(2.0, 3.0);
        // Two that move alike are one.
        assert_eq!(cost(&[place(plain, 0.0), place(plain, 0.0)]), 2.0);
        assert_eq!(cost(&[place(plain, 0.0), place(with_rod, 90.0)]), 2.0 + 2.0 + 3.0);
    }
}
