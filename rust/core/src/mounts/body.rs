//! A rigid body: mass, centre of gravity, and inertia tensor about it.

use nalgebra::{Matrix3, Matrix6, SymmetricEigen, Vector3};

use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// Difference of two products that should be equal, over the largest entry, that rounding makes.
const ASYMMETRY_BY_ROUNDING: f64 = 1e-9;
/// Least principal moment over the largest of a tensor that has an inverse to some digits.
const LEAST_MOMENT: f64 = 1e-12;

/// Least and largest side of a block, m.
const SIDES: [f64; 2] = [1e-3, 1e3];
/// Least and largest density of a block, kg/m³.
const DENSITIES: [f64; 2] = [1.0, 1e5];

/// Sign convention of products of inertia.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Products {
    /// Entries of the tensor: minus the integrals ∫xy dm off its diagonal.
    Tensor,
    /// The integrals ∫xy dm themselves, as many CAD systems print them.
    PositiveIntegrals,
}

/// A rigid body in the engine's axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidBody {
    mass: f64,
    cg: Vector3<f64>,
    inertia: Matrix3<f64>,
}

impl RigidBody {
    /// From mass, centre of gravity and inertia about it; the convention of products may be left open
    /// where all are zero.
    pub fn new(
        mass: f64,
        cg: [f64; 3],
        inertia: [[f64; 3]; 3],
        products: Option<Products>,
    ) -> Result<Self> {
        limits::length("mass", mass).map_err(|_| {
            let hint = format!("give kilograms, more than zero, at most {:e}", limits::LARGEST);
            Error::figure("mass", mass, hint)
        })?;
        for (k, place) in cg.into_iter().enumerate() {
            limits::finite(&format!("cg[{k}]"), place)?;
        }
        let mut tensor = Matrix3::from_fn(|row, column| inertia[row][column]);
        let largest = tensor.amax();
        if let Some(&wrong) = tensor.iter().find(|entry| !entry.is_finite()) {
            return Err(Error::figure("inertia", wrong, "give finite numbers, kg·m²"));
        }
        for (row, column) in [(0, 1), (0, 2), (1, 2)] {
            let [one, other] = [tensor[(row, column)], tensor[(column, row)]];
            if (one - other).abs() > ASYMMETRY_BY_ROUNDING * largest {
                let argument = format!("inertia[{row}][{column}]");
                let hint = format!("is {other:?} below the diagonal: make them equal");
                return Err(Error::figure(argument, one, hint));
            }
            let mean = f64::midpoint(one, other);
            let entry = match products {
                _ if mean == 0.0 => 0.0,
                Some(Products::Tensor) => mean,
                Some(Products::PositiveIntegrals) => -mean,
                None => {
                    let hint = "give \"tensor\" if the entries off the diagonal are those of the \
                                tensor, -∫xy dm, or \"positive-integrals\" if they are ∫xy dm, as many \
                                CAD systems print them: the torque roll axis tilts to the other side";
                    return Err(Error::value("products", "None", hint));
                }
            };
            (tensor[(row, column)], tensor[(column, row)]) = (entry, entry);
        }
        let body = Self { mass, cg: cg.into(), inertia: tensor };
        let [least, _, most] = body.principal_moments();
        if least > LEAST_MOMENT * most {
            return Ok(body);
        }
        let hint = "is the least principal moment: give a tensor about the CG, kg·m², whose principal \
                    moments are all above zero";
        Err(Error::figure("inertia", least, hint))
    }

    /// A cuboid of one density, kg/m³, with sides along x, y and z, m, about its centre, m.
    pub fn block(sides: [f64; 3], centre: [f64; 3], density: f64) -> Result<Self> {
        let check = |name: &str, value: f64, [least, most]: [f64; 2], what: &str, of: &str| {
            if (least..=most).contains(&value) {
                return Ok(());
            }
            Err(Error::figure(name, value, format!("give {what}, {least} to {most}{of}")))
        };
        for (name, side) in ["width", "height", "length"].into_iter().zip(sides) {
            check(name, side, SIDES, "metres", "")?;
        }
        check("density", density, DENSITIES, "kg/m³", ": 2400 of concrete")?;
        let mass = density * sides.iter().product::<f64>();
        let squares = sides.map(|side| side * side);
        let all = squares.iter().sum::<f64>();
        let moment = |axis: usize| mass * (all - squares[axis]) / 12.0;
        let inertia = Matrix3::from_diagonal(&Vector3::from([0, 1, 2].map(moment)));
        Self::new(mass, centre, inertia.into(), None)
    }

    /// Several bodies that move as one.
    pub fn combined(bodies: &[Self]) -> Result<Self> {
        let mass = bodies.iter().map(Self::mass).sum::<f64>();
        if bodies.is_empty() {
            return Err(Error::value("bodies", "none", "give one body or more"));
        }
        let cg = bodies.iter().map(|body| body.cg * (body.mass / mass)).sum::<Vector3<f64>>();
        let inertia = bodies.iter().map(|body| body.inertia_about(cg)).sum::<Matrix3<f64>>();
        // Sums of rounded products are symmetric to their rounding.
        Self::new(mass, cg.into(), inertia.into(), Some(Products::Tensor))
    }

    /// Inertia tensor about a point, kg·m².
    #[must_use]
    pub fn inertia_about(&self, point: Vector3<f64>) -> Matrix3<f64> {
        let arm = point - self.cg;
        let square = Matrix3::from_diagonal_element(arm.norm_squared());
        self.inertia + (square - arm * arm.transpose()) * self.mass
    }

    /// Mass, kg.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Centre of gravity, m.
    #[must_use]
    pub fn cg(&self) -> Vector3<f64> {
        self.cg
    }

    /// Inertia tensor about the centre of gravity, kg·m².
    #[must_use]
    pub fn inertia(&self) -> Matrix3<f64> {
        self.inertia
    }

    /// Principal moments of inertia, ascending, kg·m².
    #[must_use]
    pub fn principal_moments(&self) -> [f64; 3] {
        let largest = self.inertia.amax();
        if largest == 0.0 {
            return [0.0; 3];
        }
        let moments = SymmetricEigen::new(self.inertia / largest).eigenvalues * largest;
        let mut moments: [f64; 3] = moments.into();
        moments.sort_by(f64::total_cmp);
        moments
    }

    /// What the sum of the two smaller principal moments lacks to the largest, over the largest: above
    /// zero of no body there is.
    #[must_use]
    pub fn missing_inertia(&self) -> f64 {
        let [least, middle, most] = self.principal_moments();
        1.0 - (least + middle) / most
    }

    /// The same body with its centre of gravity elsewhere.
    #[must_use]
    pub fn at(&self, cg: Vector3<f64>) -> Self {
        Self { cg, ..*self }
    }

    /// The same body with its mass and its tensor of inertia times factors above zero.
    #[must_use]
    pub fn scaled(&self, mass: f64, inertia: f64) -> Self {
        Self { mass: self.mass * mass, inertia: self.inertia * inertia, ..*self }
    }

    /// The matrix of the equations of motion of (displacement of the CG, rotation).
    #[must_use]
    pub fn mass_matrix(&self) -> Matrix6<f64> {
        let mut matrix = Matrix6::from_diagonal_element(self.mass);
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.inertia);
        matrix
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INERTIA: [[f64; 3]; 3] = [[6.0, 0.4, -0.9], [0.4, 8.5, 0.3], [-0.9, 0.3, 3.2]];

    #[test]
    fn products_have_a_convention_that_is_named() {
        let body = |products| RigidBody::new(1.0, [0.0; 3], INERTIA, products);
        let tensor = body(Some(Products::Tensor)).unwrap().inertia();
        let integrals = body(Some(Products::PositiveIntegrals)).unwrap().inertia();
        assert_eq!((tensor[(0, 2)], integrals[(2, 0)]), (-0.9, 0.9));
        assert_eq!(tensor.diagonal(), integrals.diagonal());
        let error = body(None).unwrap_err().to_string();
        assert!(error.starts_with("products = None: give \"tensor\""), "{error}");
        let diagonal = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.5]];
        assert!(RigidBody::new(1.0, [0.0; 3], diagonal, None).is_ok());
    }

    #[test]
    fn blocks_have_the_sides_and_the_density_of_some_material() {
        let error =
            |sides, density| RigidBody::block(sides, [0.0; 3], density).unwrap_err().to_string();
        for (k, name) in ["width", "height", "length"].into_iter().enumerate() {
            for wrong in [0.0, -1.0, 0.9e-3, 1.1e3, f64::NAN] {
                let mut sides = [2.0; 3];
                sides[k] = wrong;
                let said = format!("{name} = {wrong:?}: give metres, 0.001 to 1000");
                assert!(error(sides, 2400.0).starts_with(&said), "{}", error(sides, 2400.0));
            }
        }
        for wrong in [0.0, 0.9, 1.1e5, f64::NAN] {
            let said = format!("density = {wrong:?}: give kg/m³, 1 to 100000: 2400 of concrete");
            assert!(error([2.0; 3], wrong).starts_with(&said), "{}", error([2.0; 3], wrong));
        }
        let block = RigidBody::block([1e-3, 1e3, 2.0], [0.0; 3], 1e5).unwrap();
        assert!((block.mass() - 2e5).abs() < 1e-9);
    }

    #[test]
    fn impossible_tensors_are_known_by_what_they_lack() {
        let body = |z| {
            let inertia = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, z]];
            RigidBody::new(1.0, [0.0; 3], inertia, None).unwrap().missing_inertia()
        };
        assert!(body(3.0).abs() < 1e-15 && body(2.5) < 0.0);
        assert!((body(3.0 / 0.94) - 0.06).abs() < 1e-15);
    }

    #[test]
    fn what_is_no_tensor_is_rejected() {
        let body = |inertia| RigidBody::new(1.0, [0.0; 3], inertia, Some(Products::Tensor));
        let mut other = INERTIA;
        other[1][0] = 0.4 * (1.0 + 1e-15);
        assert!(body(other).is_ok());
        other[1][0] = 0.41;
        let error = body(other).unwrap_err().to_string();
        assert!(error.starts_with("inertia[0][1] = 0.4: is 0.41 below the diagonal"), "{error}");
        for wrong in [[[0.0; 3]; 3], [[1.0; 3]; 3], [[f64::NAN; 3]; 3]] {
            assert!(body(wrong).unwrap_err().to_string().starts_with("inertia = "));
        }
        let body = RigidBody::new(0.0, [0.0; 3], INERTIA, Some(Products::Tensor));
        assert!(body.unwrap_err().to_string().starts_with("mass = 0.0: give kilograms"));
    }
}
