//! Soil under the base of a block: springs and dashpots of the elastic half-space.
//!
//! Stiffness and dashpots are those of Richart, Hall and Woods, Vibrations of Soils and Foundations (1970), chapter 10,
//! of a circular base: springs as in table 3 of Whitman and Richart, J. Soil Mech. Found. Div. ASCE 93 SM6 (1967) 169,
//! with mass and damping ratios in table 12-1 of UFC 3-220-01N (2005). A rectangular base has the circles of equal area
//! and of equal second moments of area, whose springs are compared with those of Pais and Kausel (1988), table 2-2a of
//! NIST GCR 12-917-21 (2012). Factors of embedment are Whitman's, as in Arya, O'Neill and Pincus, Design of Structures
//! and Foundations for Vibrating Machines (1979), chapter 4, which has none for torsion.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::{MountFigures, RigidBody};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// Poisson's ratio of an incompressible soil.
const INCOMPRESSIBLE: f64 = 0.5;
/// Hysteretic loss over damping ratio.
const LOSS_OF_DAMPING: f64 = 2.0;

/// An elastic half-space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Soil {
    /// Shear modulus, Pa.
    pub shear_modulus: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Damping of the material over its critical damping.
    pub damping_ratio: f64,
}

/// Base of a block, horizontal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Base {
    /// Its radius, m.
    Circle(f64),
    /// Its sides along x and z, m.
    Rectangle([f64; 2]),
}

impl Base {
    fn check(self) -> Result<()> {
        match self {
            Self::Circle(radius) => limits::length("radius", radius).map(drop),
            Self::Rectangle([width, length]) => {
                limits::length("width", width)?;
                limits::length("length", length).map(drop)
            }
        }
    }

    /// Radii of equal circles: of equal area, and of equal second moments of area about x, y and z.
    #[must_use]
    pub fn radii(self) -> (f64, [f64; 3]) {
        match self {
            Self::Circle(radius) => (radius, [radius; 3]),
            Self::Rectangle([width, length]) => {
                let area = width * length;
                let fourth_root = |value: f64| value.sqrt().sqrt();
                let rocking = |across: f64| fourth_root(area * across * across / (3.0 * PI));
                let torsion = fourth_root(area * (width * width + length * length) / (6.0 * PI));
                ((area / PI).sqrt(), [rocking(length), torsion, rocking(width)])
            }
        }
    }
}

impl Soil {
    /// Rejects what no soil has.
    pub fn check(&self) -> Result<()> {
        let moduli = [("shear_modulus", self.shear_modulus), ("density", self.density)];
        for (name, value) in moduli {
            if !(limits::SMALLEST..=limits::LARGEST).contains(&value) {
                return Err(Error::figure(name, value, "give a number above zero"));
            }
        }
        if !(0.0..INCOMPRESSIBLE).contains(&self.poisson) {
            let hint = "give 0 or more, below 0.5: about 0.33 of sand, 0.45 of saturated clay";
            return Err(Error::figure("poisson", self.poisson, hint));
        }
        if !(0.0..1.0).contains(&self.damping_ratio) {
            let hint = "give damping over critical damping, such as 0.05";
            return Err(Error::figure("damping_ratio", self.damping_ratio, hint));
        }
        Ok(())
    }

    /// The soil under a base as a mount at its middle, m, for a body that stands on it, embedded to a depth, m.
    ///
    /// The body's inertia counts in the dashpots of rocking and torsion.
    pub fn mount(
        &self,
        name: String,
        base: Base,
        at: [f64; 3],
        depth: f64,
        body: &RigidBody,
    ) -> Result<MountFigures> {
        self.check()?;
        base.check()?;
        limits::not_negative("embedment", depth)?;
        let (radius, about) = base.radii();
        let Self { shear_modulus, poisson, density, damping_ratio } = *self;
        let impedance = (shear_modulus * density).sqrt();
        let [drained, lateral] = [1.0 - poisson, 2.0 - poisson];
        let sliding = 32.0 * drained / (7.0 - 8.0 * poisson);
        let ratio = depth / radius;
        let vertical = 4.0 * shear_modulus * radius / drained * (1.0 + 0.6 * drained * ratio);
        let horizontal = sliding * shear_modulus * radius * (1.0 + 0.55 * lateral * ratio);
        let vertical_damping =
            3.4 * radius.powi(2) * impedance / drained * (1.0 + 1.9 * drained * ratio);
        let horizontal_damping =
            0.576 * sliding * radius.powi(2) * impedance * (1.0 + 1.9 * lateral * ratio);
        let inertia = body.inertia_about(Vector3::from(at));
        let about_axis = |axis: usize| {
            let (radius, inertia) = (about[axis], inertia[(axis, axis)]);
            let ratio = depth / radius;
            let over = inertia / (density * radius.powi(5));
            if axis == 1 {
                let stiffness = 16.0 / 3.0 * shear_modulus * radius.powi(3);
                return (stiffness, (stiffness * inertia).sqrt() / (1.0 + 2.0 * over));
            }
            let cube = lateral * ratio.powi(3);
            let stiffness = 8.0 * shear_modulus * radius.powi(3) / (3.0 * drained)
                * (1.0 + 1.2 * drained * ratio + 0.2 * cube);
            let damping = 0.8 * radius.powi(4) * impedance
                / (drained * (1.0 + 3.0 / 8.0 * drained * over))
                * (1.0 + 0.7 * drained * ratio + 0.6 * cube);
            (stiffness, damping)
        };
        let [pitch, yaw, roll] = [0, 1, 2].map(about_axis);
        let loss = LOSS_OF_DAMPING * damping_ratio;
        Ok(MountFigures {
            name,
            at,
            stiffness: [horizontal, vertical, horizontal],
            loss_factor: [loss; 3],
            damping: [horizontal_damping, vertical_damping, horizontal_damping],
            rotational_stiffness: [pitch.0, yaw.0, roll.0],
            rotational_loss_factor: [loss; 3],
            rotational_damping: [pitch.1, yaw.1, roll.1],
            ..MountFigures::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn soil() -> Soil {
        Soil { shear_modulus: 5e7, poisson: 0.35, density: 1700.0, damping_ratio: 0.0 }
    }

    fn body() -> RigidBody {
        RigidBody::block([3.0, 2.0, 4.0], [0.1, 1.0, 0.2], 2400.0).unwrap()
    }

    fn under(base: Base, depth: f64) -> MountFigures {
        soil().mount("soil".into(), base, [0.0; 3], depth, &body()).unwrap()
    }

    /// Damping ratios of the book, from its mass ratios.
    #[test]
    fn dashpots_have_the_damping_ratios_of_the_book() {
        let (found, body, soil) = (under(Base::Circle(1.8), 0.0), body(), soil());
        let (mass, cube) = (body.mass(), soil.density * 1.8_f64.powi(3));
        let near = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        };
        let ratio =
            |damping: f64, stiffness: f64, mass: f64| damping / (2.0 * (stiffness * mass).sqrt());
        let b = 0.65 * mass / (4.0 * cube);
        near(ratio(found.damping[1], found.stiffness[1], mass), 0.425 / b.sqrt());
        let b = (7.0 - 2.8) * mass / (32.0 * 0.65 * cube);
        near(ratio(found.damping[0], found.stiffness[0], mass), 0.288 / b.sqrt());
        let inertia = body.inertia_about(Vector3::zeros());
        for axis in [0, 2] {
            let moment = inertia[(axis, axis)];
            let b = 3.0 * 0.65 * moment / (8.0 * cube * 1.8 * 1.8);
            let [k, c] = [found.rotational_stiffness[axis], found.rotational_damping[axis]];
            near(ratio(c, k, moment), 0.15 / ((1.0 + b) * b.sqrt()));
        }
        let b = inertia[(1, 1)] / (cube * 1.8 * 1.8);
        let [k, c] = [found.rotational_stiffness[1], found.rotational_damping[1]];
        near(ratio(c, k, inertia[(1, 1)]), 0.5 / (1.0 + 2.0 * b));
    }

    #[test]
    fn rectangles_have_the_second_moments_of_their_circles() {
        let (radius, about) = Base::Rectangle([3.0, 5.0]).radii();
        let second = |radius: f64| PI / 4.0 * radius.powi(4);
        assert!((PI * radius * radius - 15.0).abs() < 1e-13);
        assert!((second(about[0]) - 3.0 * 125.0 / 12.0).abs() < 1e-12);
        assert!((second(about[2]) - 5.0 * 27.0 / 12.0).abs() < 1e-12);
        assert!((2.0 * second(about[1]) - 15.0 * 34.0 / 12.0).abs() < 1e-12);
    }

    #[test]
    fn embedment_stiffens_all_but_torsion_and_vanishes_at_the_surface() {
        let base = Base::Rectangle([3.0, 5.0]);
        let [surface, shallow, deep] = [0.0, 1e-9, 1.0].map(|depth| under(base, depth));
        for axis in 0..3 {
            let change = shallow.stiffness[axis] / surface.stiffness[axis] - 1.0;
            assert!((0.0..1e-8).contains(&change));
            assert!(deep.stiffness[axis] > surface.stiffness[axis]);
            assert!(deep.damping[axis] > surface.damping[axis]);
            let [low, high] = [surface.rotational_stiffness[axis], deep.rotational_stiffness[axis]];
            assert!(if axis == 1 { high == low } else { high > low });
        }
    }

    #[test]
    fn figures_out_of_range_are_named() {
        let error = |soil: Soil, base: Base, depth: f64| {
            let found = soil.mount("soil".into(), base, [0.0; 3], depth, &body());
            found.unwrap_err().to_string()
        };
        let (plain, circle) = (soil(), Base::Circle(1.0));
        for poisson in [-0.1, 0.5, f64::NAN] {
            assert!(error(Soil { poisson, ..plain }, circle, 0.0).starts_with("poisson"));
        }
        let soft = Soil { shear_modulus: 0.0, ..plain };
        assert!(error(soft, circle, 0.0).starts_with("shear_modulus"));
        assert!(error(Soil { density: -1.0, ..plain }, circle, 0.0).starts_with("density"));
        assert!(
            error(Soil { damping_ratio: 5.0, ..plain }, circle, 0.0).starts_with("damping_ratio")
        );
        assert!(error(plain, Base::Circle(0.0), 0.0).starts_with("radius"));
        assert!(error(plain, Base::Rectangle([1.0, -1.0]), 0.0).starts_with("length"));
        assert!(error(plain, circle, -0.1).starts_with("embedment"));
    }
}
