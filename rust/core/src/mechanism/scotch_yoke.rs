//! The motion of a piston whose bar is moved by a sliding crankpin: r cos θ about the middle of its stroke, the
//! limit of infinite rods.

use super::exact::{ExactHarmonic, MotionKey, Rest};
use super::harmonics::rod::TorqueHarmonics;
use super::motion::{CrankPosition, Motion, Swing};
use super::{Cylinder, HarmonicsOf, Mechanism, is_equal};
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;

/// A Scotch yoke.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ScotchYoke {
    /// What it was made of; it has no masses here.
    lengths: Cylinder,
}

impl ScotchYoke {
    /// Of a cylinder.
    pub fn new(cylinder: &Cylinder) -> Self {
        Self { lengths: cylinder.without_masses() }
    }
}

/// A value at one order, zero at the others.
fn only(own: u32, value: Complex64, orders: &[u32]) -> Vec<Complex64> {
    orders.iter().map(|&n| if n == own { value } else { Complex64::ZERO }).collect()
}

impl Mechanism for ScotchYoke {
    fn equals(&self, other: &dyn Mechanism) -> bool {
        is_equal(self, other)
    }

    fn motion(&self, crank: &CrankPosition) -> Motion {
        let CrankPosition { sin, cos, .. } = *crank;
        let [position, velocity, acceleration, jerk] = [cos, -sin, -cos, sin];
        Motion { position, velocity, acceleration, jerk, slope: 0.0, secant: 1.0 }
    }

    fn swing(&self, _: &CrankPosition) -> Swing {
        Swing { velocity: 0.0, acceleration: 0.0 }
    }

    fn to_singularity(&self, _: f64) -> f64 {
        f64::INFINITY
    }

    fn force(&self, orders: &[u32], _: &Cancel) -> Result<Vec<Complex64>> {
        Ok(only(1, Complex64::ONE, orders))
    }

    fn force_beyond(&self, highest: u32) -> Option<f64> {
        Some(if highest == 0 { 1.0 } else { 0.0 })
    }

    /// x'² = sin²θ = ½ − ½ cos 2θ.
    fn torque(&self, orders: &[u32], _: &Cancel) -> Result<TorqueHarmonics> {
        let [roll, crank] = [-0.5, 0.5].map(|half| only(2, Complex64::new(0.0, half), orders));
        Ok(TorqueHarmonics { roll, crank })
    }

    fn torque_beyond(&self, highest: u32) -> Option<f64> {
        Some(if highest < 2 { 0.5 } else { 0.0 })
    }

    fn swing_torque(&self, orders: &[u32], _: &Cancel) -> Result<TorqueHarmonics> {
        let none = only(0, Complex64::ZERO, orders);
        Ok(TorqueHarmonics { roll: none.clone(), crank: none })
    }

    fn swing_torque_beyond(&self, _: u32) -> Option<f64> {
        Some(0.0)
    }

    fn rod_ratio(&self) -> f64 {
        0.0
    }

    fn lengths(&self) -> &Cylinder {
        &self.lengths
    }

    fn grows_with_rod_ratio(&self, _: HarmonicsOf) -> bool {
        true
    }

    fn key(&self) -> MotionKey {
        MotionKey { figures: Vec::new(), is_mirrored: false }
    }

    fn exact_force(&self, order: u32) -> ExactHarmonic {
        ExactHarmonic { crank: order == 1, rest: Rest::None, is_certain: true }
    }

    fn exact_torque(&self, order: u32) -> ExactHarmonic {
        let rest = if order == 2 { Rest::Even } else { Rest::None };
        ExactHarmonic { crank: false, rest, is_certain: true }
    }

    fn decay(&self) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::with_ratios;
    use approx::assert_relative_eq;

    #[test]
    fn a_long_rod_moves_its_piston_like_a_scotch_yoke() {
        let motion = with_ratios(1e-12, 0.0).unwrap().motion(&CrankPosition::new(0.6, 0.8));
        assert_relative_eq!(motion.velocity, -0.6, max_relative = 1e-11);
        assert_relative_eq!(motion.acceleration, -0.8, max_relative = 1e-11);
    }

    #[test]
    fn an_infinite_rod_moves_its_piston_as_a_scotch_yoke_does() {
        let cylinder = Cylinder::new(0.05, f64::INFINITY, 0.5, 0.0).unwrap();
        assert_eq!((cylinder.rod_ratio(), cylinder.has_infinite_rod()), (0.0, true));
        let mechanism = cylinder.mechanism();
        assert!(*mechanism == *cylinder.mechanism_with(Some(0.0), None).unwrap());
        let [position, velocity, acceleration, jerk] = [0.8, -0.6, -0.8, 0.6];
        let known = Motion { position, velocity, acceleration, jerk, slope: 0.0, secant: 1.0 };
        assert_eq!(mechanism.motion(&CrankPosition::new(0.6, 0.8)), known);
        for (cylinder, name) in [
            (Cylinder::new(0.05, f64::INFINITY, 0.5, 0.01), "pin_offset = 0.01"),
            (cylinder.with_rod_inertia_excess(-2e-3), "rod_inertia_excess = -0.002"),
            (Cylinder::new(0.05, f64::NEG_INFINITY, 0.5, 0.0), "rod_length = -inf"),
            (Cylinder::new(f64::INFINITY, f64::INFINITY, 0.5, 0.0), "crank_radius = inf"),
        ] {
            assert!(cylinder.unwrap_err().to_string().starts_with(name), "{name}");
        }
        assert!(with_ratios(0.0, 0.01).is_err());
    }
}
