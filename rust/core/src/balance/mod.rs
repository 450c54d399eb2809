//! How an engine shakes, order by order: force, moment and roll torque as peak phasors.
//!
//! In the cross-section plane force and moment are complex numbers x + iy, and each order is
//! `forward·e^{inθ} + backward·e^{−inθ}`: a part that turns with the crank and one against it. With
//! w = m·r and `aₙ` the slider-crank's harmonics, the reciprocating masses give
//! `forward = aₙ/2 Σ w e^{i(bank − n·tdc)}` and `backward = conj(aₙ/2 Σ w e^{−i(bank + n·tdc)})`; rotating
//! mass turns forward with its pin at order 1. Since the moment is r × F, that of a cylinder is
//! i·(z − z₀) times its force.

mod choice;
mod fewest;
mod sums;

use std::f64::consts::FRAC_PI_2;

use ndarray::{Array1, Array2};

pub(crate) use self::choice::{highest, rod_share, rod_tail, scales, tail};
pub(crate) use self::fewest::most_left_out;
use self::sums::Sums;
pub(crate) use self::sums::{snapped, zero_factor};
use crate::Complex64;
use crate::cancel::Cancel;
use crate::engine::Engine;
use crate::error::Result;
use crate::extrema::PeakFinder;
use crate::harmonics;
use crate::limits;
pub(crate) use crate::limits::tolerance;
use crate::spectrum::Spectrum;

/// Which orders to give.
#[derive(Debug, Clone, PartialEq)]
pub enum Orders {
    /// These.
    Given(Vec<u32>),
    /// The fewest that leave out at most this part of the largest m·r·ω² of a cylinder (times the
    /// longest lever, for moments, and the crank radius, for torque).
    Auto {
        /// Relative tolerance.
        rtol: f64,
    },
}

impl Orders {
    /// About how many steps of some nanoseconds they take at most.
    #[must_use]
    pub fn steps(&self, engine: &Engine) -> usize {
        /// More orders than a tolerance asks of a rod that is not next to the shortest.
        const CHOSEN: usize = 256;
        let count = if let Self::Given(orders) = self { orders.len() } else { CHOSEN };
        let each = engine.placements().iter().map(|p| harmonics::steps(p.cylinder.slack(), count));
        each.fold(0, usize::saturating_add)
    }
}

/// Force and moment of one kind, order by order.
#[derive(Debug, Clone, PartialEq)]
pub struct Shake {
    /// Peak phasors along (about) x and y: (`n_orders`, 2).
    pub xy: Array2<Complex64>,
    /// Coefficients of `e^{inθ}`: (`n_orders`,).
    pub forward: Array1<Complex64>,
    /// Coefficients of `e^{−inθ}`: (`n_orders`,).
    pub backward: Array1<Complex64>,
    /// What rounding can leave of a sum that vanishes; phasors below it are given as zero.
    pub zero_bound: Array1<f64>,
    /// What the orders left out can add to the length of the vector at any crank angle; 0 for
    /// orders that were asked for by number.
    pub error_bound: f64,
}

/// Roll torque, order by order.
#[derive(Debug, Clone, PartialEq)]
pub struct Torque {
    /// On the block, about +z: peak phasors, (`n_orders`,).
    pub roll: Array1<Complex64>,
    /// On the crank, about +z.
    pub crank: Array1<Complex64>,
    /// What rounding can leave of a sum that vanishes.
    pub zero_bound: Array1<f64>,
    /// What the orders left out can add to either torque at any crank angle.
    pub error_bound: f64,
}

/// How an engine shakes at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    /// Orders, ascending where they were chosen here.
    pub orders: Vec<u32>,
    /// Orders that were looked at and left out, of those that are not zero.
    pub omitted: Vec<u32>,
    /// Shaking force, N.
    pub force: Shake,
    /// Rocking moment, N·m.
    pub moment: Shake,
    /// Torque, N·m; none where it was not asked for, or a spectrum of forces tells nothing of it.
    pub torque: Option<Torque>,
}

/// An ellipse traced by force or moment in one order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// Longest half axis.
    pub major: f64,
    /// Shortest half axis; below zero where the vector turns against the crank.
    pub minor: f64,
    /// Direction of the long axis from +x, radians in (−π/2, π/2]; 0 for a circle.
    pub tilt: f64,
}

impl Ellipse {
    /// From forward and backward parts.
    #[must_use]
    pub fn new(forward: Complex64, backward: Complex64) -> Self {
        let (f, b) = (forward.norm(), backward.norm());
        let mut tilt = 0.0;
        if f != 0.0 && b != 0.0 {
            tilt = (forward / f * (backward / b)).sqrt().arg();
            // The root of −1 − 0i points down.
            if tilt <= -FRAC_PI_2 {
                tilt = FRAC_PI_2;
            }
        }
        Self { major: f + b, minor: f - b, tilt }
    }
}

impl Shake {
    /// max over θ along x and y of the sum of all orders.
    #[must_use]
    pub fn peak_xy(&self, finder: &PeakFinder) -> [f64; 2] {
        [0, 1].map(|axis| finder.along_axis(&self.xy.column(axis).to_vec()))
    }

    /// max over θ of the length of the sum of all orders.
    #[must_use]
    pub fn peak_vector(&self, finder: &PeakFinder) -> f64 {
        finder.of_vector(&self.xy.column(0).to_vec(), &self.xy.column(1).to_vec())
    }
}

/// Angular speed in rad/s.
pub fn angular_speed(rpm: f64) -> Result<f64> {
    Ok(limits::not_negative("rpm", rpm)? * std::f64::consts::TAU / 60.0)
}

/// What is asked of an engine, besides orders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked<'a> {
    /// Crank speed.
    pub rpm: f64,
    /// Plane about which moments are taken; by default half-way between the first and the last
    /// cylinder.
    pub reference_z: Option<f64>,
    /// Stands in for every cylinder's slider-crank.
    pub spectrum: Option<&'a Spectrum>,
    /// Whether torques are wanted too.
    pub torque: bool,
}

/// How the engine shakes at `rpm`, about the plane z = `reference_z`, torques and all.
pub fn balance(
    engine: &Engine,
    rpm: f64,
    orders: &Orders,
    reference_z: Option<f64>,
    spectrum: Option<&Spectrum>,
) -> Result<Balance> {
    let asked = Asked { rpm, reference_z, spectrum, torque: true };
    of(engine, &asked, orders, &Cancel::new())
}

/// How the engine shakes.
pub fn of(engine: &Engine, asked: &Asked, orders: &Orders, cancel: &Cancel) -> Result<Balance> {
    let omega = angular_speed(asked.rpm)?;
    let reference = engine.reference(asked.reference_z)?;
    let sums = || Sums::new(engine, reference, asked.spectrum, asked.torque);
    match orders {
        Orders::Given(orders) => {
            limits::orders(orders)?;
            let cure = "give fewer orders";
            limits::result_size("orders", &[orders.len(), 8], size_of::<Complex64>(), cure)?;
            sums().balance(orders, omega, cancel)
        }
        Orders::Auto { rtol } => choice::within(*rtol, &sums(), engine, omega, cancel),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipse_points_up_where_it_points_down() {
        let i = Complex64::i();
        for (forward, backward) in [(i, i), (-i, -i), (i * 2.0, Complex64::new(-0.0, 1.0))] {
            assert_eq!(Ellipse::new(forward, backward).tilt, FRAC_PI_2);
        }
        let circle = Ellipse::new(Complex64::default(), i * 3.0);
        assert_eq!((circle.major, circle.minor, circle.tilt), (3.0, -3.0, 0.0));
    }
}
