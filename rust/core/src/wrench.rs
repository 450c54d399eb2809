//! Force and moment of one order: phasors of a vector in the cross-section, and of a wrench.

use crate::Complex64;

/// A vector of one order in the cross-section: `x + iy = forward·e^{inθ} + backward·e^{−inθ}`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Planar {
    /// Coefficient of `e^{inθ}`: what turns with the crank.
    pub forward: Complex64,
    /// Conjugate of the backward part, which is the coefficient of `e^{−inθ}`.
    pub backward_conj: Complex64,
    /// Bound of its rounding error: of either part, and of their sum.
    pub bound: f64,
}

/// Roll torque of one order on the block and torque on the crank, about +z.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Torque {
    /// On the block: peak phasor.
    pub roll: Complex64,
    /// On the crank: peak phasor.
    pub crank: Complex64,
    /// Bounds of the rounding errors on the block and on the crank: a force at an arm turns the block alone.
    pub bounds: [f64; 2],
}

/// Force, moment about a point, and torque of one order: peak phasors.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wrench {
    /// Shaking force, N.
    pub force: Planar,
    /// Rocking moment about the reference point, N·m.
    pub moment: Planar,
    /// Torques, N·m.
    pub torque: Torque,
}

/// Part of the larger of two parts of a vector up to which the smaller is rounding: the vector traces a circle.
const CIRCLE: f64 = 1e-12;

/// Direction of the longest half axis of the ellipse that a forward and a backward part trace, degrees from +x
/// in (−90, 90]; none of a circle, which has no longest.
#[must_use]
pub fn tilt_deg(forward: Complex64, backward: Complex64) -> Option<f64> {
    let (f, b) = (forward.norm(), backward.norm());
    if f.min(b) <= CIRCLE * f.max(b) {
        return None;
    }
    // Half the sum of the phases; of the two directions of the axis the upper one.
    let tilt = ((forward / f) * (backward / b)).arg().to_degrees() / 2.0;
    Some(if tilt <= -90.0 { 90.0 } else { tilt + 0.0 }) // no −0
}

/// Bound of the rounding error of a sum of `count` loads at order n, per unit of Σ|terms|.
///
/// Each angle comes with three roundings of half a unit of 360° (2.2 ε rad each), turned n-fold
/// in the phase and once in the direction; sines, products and weights add less than 8 ε, and the
/// summation (count − 1) ε.
#[must_use]
pub fn rounding(count: usize, order: f64) -> f64 {
    (count as f64 + 16.0 + 8.0 * order) * f64::EPSILON
}

/// Zero for a sum within the bound of its rounding error.
#[inline]
#[must_use]
pub fn snapped(sum: Complex64, bound: f64) -> Complex64 {
    // Mostly one part is larger, or both are zero, and no root is taken.
    let larger = sum.re.abs().max(sum.im.abs());
    let is_within = larger <= bound && (larger == 0.0 || sum.norm() <= bound);
    if is_within { Complex64::default() } else { sum }
}

impl Planar {
    /// Adds another vector times a complex amplitude.
    pub fn add_scaled(&mut self, other: &Self, amplitude: Complex64) {
        // The backward part was conjugated, its amplitude was not.
        self.forward += other.forward * amplitude;
        self.backward_conj += other.backward_conj * amplitude;
        self.bound += other.bound * amplitude.norm();
    }

    /// Sum of two.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            forward: self.forward + other.forward,
            backward_conj: self.backward_conj + other.backward_conj,
            bound: self.bound + other.bound,
        }
    }

    /// The vector times a real factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            // Adding zero makes −0, of a part below zero at rest, 0.
            forward: self.forward * factor + Complex64::default(),
            backward_conj: self.backward_conj * factor,
            bound: self.bound * factor,
        }
    }

    /// The vector turned a quarter forward: the moment of a force one metre towards the flywheel.
    #[must_use]
    pub fn quarter_turned(&self) -> Self {
        let i = Complex64::i();
        Self { forward: i * self.forward, backward_conj: -i * self.backward_conj, ..*self }
    }

    /// Both parts, zero where rounding is all there is.
    #[inline]
    #[must_use]
    pub fn snapped(&self) -> Self {
        Self {
            forward: snapped(self.forward, self.bound),
            backward_conj: snapped(self.backward_conj, self.bound),
            ..*self
        }
    }

    /// Peak phasors along (about) x and y, zero where they are within the bound.
    #[must_use]
    pub fn xy(&self, bound: f64) -> [Complex64; 2] {
        let (sum, difference) =
            (self.forward + self.backward_conj, self.forward - self.backward_conj);
        // Adding zero makes −0 of a part 0.
        [sum, -Complex64::i() * difference]
            .map(|phasor| snapped(phasor, bound) + Complex64::default())
    }

    /// Coefficient of `e^{−inθ}`: what turns against the crank.
    #[must_use]
    pub fn backward(&self) -> Complex64 {
        // Adding zero makes −0 of the conjugate 0.
        self.backward_conj.conj() + Complex64::default()
    }

    /// Longest vector over a turn.
    #[must_use]
    pub fn peak(&self) -> f64 {
        self.forward.norm() + self.backward_conj.norm()
    }
}

impl Torque {
    /// Sum of two.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            roll: self.roll + other.roll,
            crank: self.crank + other.crank,
            bounds: [0, 1].map(|on| self.bounds[on] + other.bounds[on]),
        }
    }

    /// The torques times a real factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        // As of vectors.
        let [roll, crank] = [self.roll, self.crank].map(|t| t * factor + Complex64::default());
        Self { roll, crank, bounds: self.bounds.map(|bound| bound * factor) }
    }

    /// The larger of the two.
    #[must_use]
    pub fn peak(&self) -> f64 {
        self.roll.norm().max(self.crank.norm())
    }
}

impl Wrench {
    /// Whether it is none at all.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        let Self { force, moment, torque } = self;
        let planar = [force.forward, force.backward_conj, moment.forward, moment.backward_conj];
        planar == [Complex64::ZERO; 4] && [torque.roll, torque.crank] == [Complex64::ZERO; 2]
    }

    /// Sum of two.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            force: self.force.plus(&other.force),
            moment: self.moment.plus(&other.moment),
            torque: self.torque.plus(&other.torque),
        }
    }

    /// The wrench times a real factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            force: self.force.scaled(factor),
            moment: self.moment.scaled(factor),
            torque: self.torque.scaled(factor),
        }
    }

    /// The wrench, zero where rounding is all there is.
    #[must_use]
    pub fn snapped(&self) -> Self {
        let Torque { roll, crank, bounds } = self.torque;
        let torque =
            Torque { roll: snapped(roll, bounds[0]), crank: snapped(crank, bounds[1]), bounds };
        Self { force: self.force.snapped(), moment: self.moment.snapped(), torque }
    }

    /// The same wrench with its moment about a point this far from the reference point, m.
    ///
    /// M′ = M − a × F: with a = (x, y, z), the moment in the cross-section loses i·z·F and the roll
    /// torque `x·F_y − y·F_x`.
    #[must_use]
    pub fn moved(&self, [x, y, z]: [f64; 3]) -> Self {
        let mut moved = *self;
        moved.moment.add_scaled(&self.force.quarter_turned(), Complex64::new(-z, 0.0));
        let [force_x, force_y] = self.force.xy(0.0);
        moved.torque.roll -= force_y * x - force_x * y;
        moved.torque.bounds[0] += self.force.bound * (x.abs() + y.abs());
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_half_axis_is_where_the_vector_is_longest() {
        let mut draw = crate::numbers::draws(7);
        for _ in 0..100 {
            let mut part = || Complex64::new(draw(), draw());
            let (forward, backward) = (part(), part());
            let tilt = Complex64::cis(tilt_deg(forward, backward).unwrap().to_radians());
            let turned = |theta: f64| {
                let turn = Complex64::cis(theta);
                (forward * turn + backward * turn.conj()) * tilt.conj()
            };
            let along = (0..3600).map(|k| turned(f64::from(k).to_radians() / 10.0).re);
            let peak = along.fold(0.0, f64::max);
            assert!((peak - (forward.norm() + backward.norm())).abs() < 3e-6);
        }
        let unit = Complex64::new(0.6, 0.8);
        for (forward, backward) in
            [(unit, Complex64::default()), (1e-13 * unit, unit), (0.0 * unit, 0.0 * unit)]
        {
            assert_eq!(tilt_deg(forward, backward), None);
        }
        assert_eq!(tilt_deg(-unit, unit.conj()), Some(90.0));
    }

    #[test]
    fn sums_longer_than_the_bound_are_kept_though_their_parts_are_not() {
        let z = Complex64::new(0.8, -0.8);
        assert_eq!(snapped(z, 1.0), z);
        assert_eq!(snapped(z, 1.2), Complex64::default());
        assert_eq!(snapped(z, 0.7), z);
    }

    #[test]
    fn moving_the_reference_point_subtracts_the_moment_of_the_force() {
        // F = (3, 4i) at (0.1, −0.2, 0.5) seen from the origin and from (0.1, −0.2, 0.5).
        let [x, y] = [Complex64::new(3.0, 0.0), Complex64::new(0.0, 4.0)];
        let i = Complex64::i();
        let force =
            Planar { forward: (x + i * y) * 0.5, backward_conj: (x - i * y) * 0.5, bound: 7.0 };
        let at_force = Wrench { force, ..Wrench::default() };
        let seen = at_force.moved([-0.1, 0.2, -0.5]);
        let [about_x, about_y] = seen.moment.xy(0.0);
        assert!((about_x + y * 0.5).norm() < 1e-15 && (about_y - x * 0.5).norm() < 1e-15);
        assert!((seen.torque.roll - (y * 0.1 + x * 0.2)).norm() < 1e-15);
        let back = seen.moved([0.1, -0.2, 0.5]);
        assert!(back.moment.peak() < 1e-15 && back.torque.roll.norm() < 1e-15);
    }
}
