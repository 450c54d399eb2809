//! Tables of forces: what shakes a body in place of an engine, or besides one, order by order.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{ComplexVector6, motion_of_point};
use crate::Complex64;
use crate::numbers::UNIT_RPM;
use crate::numbers::amplitudes::Amplitudes;
use crate::numbers::error::{Error, Result};
use crate::numbers::is_default;
use crate::numbers::limits;
use crate::numbers::order::Order;

/// Amplitudes of an order: forces along x, y and z, moments about these, and the X-type bimoment.
pub const COMPONENTS: usize = 7;

/// Forces and moments of a machine by order, as its maker prints them.
///
/// Amplitudes are peak phasors, those of order n at a crank angle θ `Re(A·e^{inθ})`: forces, N, moments, N·m, and the
/// X-type bimoment, N·m², which twists a frame and moves no rigid body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForceTable {
    /// Name, may be empty.
    #[serde(default, skip_serializing_if = "is_default")]
    pub name: String,
    /// Crank speed at which amplitudes are those given, rpm.
    pub rpm: f64,
    /// Point about which moments are, m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub about: [f64; 3],
    /// Amplitudes that grow with the square of the speed: of moving parts.
    #[serde(default, skip_serializing_if = "is_default")]
    pub speed_squared: Amplitudes,
    /// Amplitudes that stay as the speed changes: of pressure.
    #[serde(default, skip_serializing_if = "is_default")]
    pub independent: Amplitudes,
}

impl ForceTable {
    /// Rejects what no machine has; `place` is its name in errors, and a point.
    pub fn checked(mut self, place: &str) -> Result<Self> {
        let named = |field: &str| format!("{place}{field}");
        limits::name(&named("name"), &self.name)?;
        limits::length(&named("rpm"), self.rpm)?;
        for (k, along) in self.about.into_iter().enumerate() {
            limits::finite(&named(&format!("about[{k}]")), along)?;
        }
        for (field, amplitudes) in
            [("speed_squared", &mut self.speed_squared), ("independent", &mut self.independent)]
        {
            for (halves, values) in &mut amplitudes.0 {
                if values.len() == COMPONENTS - 1 {
                    values.push(Complex64::ZERO);
                }
                if values.len() != COMPONENTS {
                    let argument = named(&format!("{field}[{}]", 0.5 * f64::from(*halves)));
                    let hint =
                        "give F_x, F_y, F_z, M_x, M_y, M_z, and the X-type bimoment if it has one";
                    return Err(Error::value(argument, format!("{} numbers", values.len()), hint));
                }
            }
            let no_mean = "a force that stays does not shake: leave order 0 out";
            amplitudes.check(&named(field), COMPONENTS, no_mean)?;
        }
        if self.speed_squared.0.is_empty() && self.independent.0.is_empty() {
            let hint = "give amplitudes of one order at least, here or in independent";
            return Err(Error::value(named("speed_squared"), "none", hint));
        }
        Ok(self)
    }

    /// Orders that it has, in halves of crank speed: some of them twice.
    pub fn orders(&self) -> impl Iterator<Item = Order> {
        let all = self.speed_squared.0.iter().chain(&self.independent.0);
        all.filter_map(|(halves, _)| Order::from_halves(*halves).ok())
    }

    /// Load of an order about a point, over the square of the angular speed of the crank, and that of any speed.
    #[must_use]
    pub fn loads(&self, order: Order, point: Vector3<f64>) -> [ComplexVector6; 2] {
        let omega = self.rpm / UNIT_RPM;
        let about = |amplitudes: &Amplitudes| {
            let own = amplitudes.0.iter().find(|(halves, _)| *halves == order.halves());
            own.map_or_else(ComplexVector6::zeros, |(_, values)| {
                let load = ComplexVector6::from_iterator(values.iter().copied());
                moved(&load, &(Vector3::from(self.about) - point))
            })
        };
        [about(&self.speed_squared) / Complex64::from(omega * omega), about(&self.independent)]
    }
}

/// Largest rounding of a moment of a few products, over their sizes.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A load about a point from which the point that it was about is as far as the arm; zero in place of moments that
/// cancel to rounding.
pub(crate) fn moved(load: &ComplexVector6, arm: &Vector3<f64>) -> ComplexVector6 {
    let arms = motion_of_point(arm).transpose();
    let force = load.fixed_rows::<3>(0);
    let mut sum = arms.map(Complex64::from) * force;
    let size = arms.abs() * force.map(Complex64::norm);
    for k in 3..6 {
        sum[k] += load[k];
        // What rounding leaves of moments that cancel is none.
        sum[k] = crate::wrench::snapped(sum[k], ROUNDING * (size[k] + load[k].norm()));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(order: u32, values: Vec<Complex64>) -> Amplitudes {
        Amplitudes(vec![(2 * order, values)])
    }

    fn table(speed_squared: Amplitudes, independent: Amplitudes) -> ForceTable {
        let about = [0.1, -0.2, 0.3];
        ForceTable { name: "maker's".into(), rpm: 600.0, about, speed_squared, independent }
    }

    #[test]
    fn loads_are_moved_and_scale_as_the_table_says() {
        let unit = |k: usize, size: f64| {
            let value = |i: usize| if i == k { Complex64::new(0.0, size) } else { Complex64::ZERO };
            (0..6).map(value).collect::<Vec<_>>()
        };
        let given = table(one(1, unit(1, 100.0)), one(2, unit(5, 7.0))).checked("").unwrap();
        let omega = 600.0 / UNIT_RPM;
        let [by_square, stays] = given.loads(Order::FIRST, Vector3::zeros());
        // F_y at (0.1, -0.2, 0.3): M_x = −z·F_y, M_z = x·F_y.
        let expected = [0.0, 100.0, 0.0, -30.0, 0.0, 10.0];
        for (found, expected) in by_square.iter().zip(expected) {
            assert!((found * omega * omega - Complex64::new(0.0, expected)).norm() < 1e-13);
        }
        assert_eq!(stays, ComplexVector6::zeros());
        let second = Order::whole(2).unwrap();
        let [by_square, stays] = given.loads(second, Vector3::new(4.0, 5.0, 6.0));
        assert_eq!(by_square, ComplexVector6::zeros());
        assert_eq!(stays[5], Complex64::new(0.0, 7.0));
        assert_eq!(given.orders().collect::<Vec<_>>(), [Order::FIRST, second]);
    }

    #[test]
    fn moments_that_cancel_are_zero() {
        let force = Complex64::new(0.1, 0.7);
        let load = ComplexVector6::from_fn(|k, _| match k {
            0 => force,
            4 => -force * 0.3,
            _ => Complex64::ZERO,
        });
        // F_x at a height of 0.3 along z makes M_y = z·F_x.
        let sum = moved(&load, &Vector3::new(0.0, 0.0, 0.1 + 0.2));
        assert_eq!(sum[4], Complex64::ZERO);
    }

    #[test]
    fn figures_out_of_range_are_named() {
        let values = vec![Complex64::ONE; 7];
        let error = |table: ForceTable| table.checked("forces.").unwrap_err().to_string();
        let none = Amplitudes::default;
        assert!(error(table(none(), none())).starts_with("forces.speed_squared = none"));
        let short = table(none(), one(3, values[..5].to_vec()));
        assert!(error(short).starts_with("forces.independent[3] = 5 numbers: give F_x, F_y"));
        let slow = ForceTable { rpm: 0.0, ..table(one(1, values.clone()), none()) };
        assert!(error(slow).starts_with("forces.rpm"));
        let mean = table(one(0, values.clone()), none());
        assert!(error(mean).contains("leave order 0 out"));
        let twice = Amplitudes(vec![(2, values.clone()), (2, values.clone())]);
        assert!(error(table(twice, none())).contains("given twice"));
        let far = ForceTable { about: [0.0, f64::NAN, 0.0], ..table(one(1, values), none()) };
        assert!(error(far).starts_with("forces.about[1]"));
    }
}
