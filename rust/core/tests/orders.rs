//! Closed forms of the orders against the motion itself, sampled.
//!
//! The mean of N samples is the integral but for orders N and above, which have decayed: by e^{−w} an
//! order, w = √(2·reach) the width of the spike near the crank that cannot turn.

use std::f64::consts::TAU;

use crankpin_core::harmonics::{self, torque};
use crankpin_core::motion::Motion;
use crankpin_core::slider_crank::Proportions;
use crankpin_core::{
    Angle, Cancel, Complex64, Cylinder, Engine, Error, Orders, Request, Spectrum, Station, balance,
};

const HIGHEST: u32 = 12;

/// λ, e/r and how many samples: w·N > 40.
const PROPORTIONS: [(f64, f64, u32); 14] = [
    (0.05, 0.0, 256),
    (0.3, 0.0, 256),
    (0.3, 0.2, 256),
    (0.3, -0.2, 256),
    (0.3, 1e-8, 256),
    (0.25, 1.7, 256),
    (0.6, 0.5, 512),
    (0.9, 0.0, 1024),
    (0.99, 0.005, 2048),
    (0.999, 0.0, 2048),
    (0.999_9, -0.000_05, 1 << 13),
    (0.999_995, 0.0, 1 << 15),
    (0.999_99, 0.000_003, 1 << 15),
    (0.999_99, -0.000_003, 1 << 15),
];

/// Peak phasors of orders 0 (half of it) to `HIGHEST` of what is made of the motion, and the largest
/// sample, to which rounding is relative.
fn sampled(
    proportions: &Proportions,
    samples: u32,
    of: impl Fn(Motion) -> f64,
) -> (Vec<Complex64>, f64) {
    let mut orders = vec![Complex64::default(); HIGHEST as usize + 1];
    let mut largest = 0.0_f64;
    for k in 0..samples {
        let angle = |turns: u32| TAU * f64::from(turns % samples) / f64::from(samples);
        let (sin, cos) = angle(k).sin_cos();
        let value = of(proportions.motion(sin, cos));
        largest = largest.max(value.abs());
        for (n, order) in (0..).zip(&mut orders) {
            *order += Complex64::cis(-angle(n * k)) * (value * 2.0 / f64::from(samples));
        }
    }
    (orders, largest)
}

/// Each sample is good to some units, near λ = 1 to some more; their mean is.
const ROUNDING: f64 = 2e-14;

#[test]
fn a_cylinders_force_is_what_its_piston_does() {
    let orders: Vec<u32> = (1..=HIGHEST).collect();
    for (ratio, offset, samples) in PROPORTIONS {
        let proportions = Proportions::new(ratio, offset).unwrap();
        let (expected, largest) = sampled(&proportions, samples, |m| -m.acceleration);
        let all = harmonics::coefficients(&proportions, &orders, &Cancel::new()).unwrap();
        for (&n, found) in orders.iter().zip(&all) {
            let off = (found - expected[n as usize]).norm();
            assert!(off <= ROUNDING * largest, "{ratio} {offset} {n}: {found}, off {off:e}");
            // Alone as among others.
            let alone = harmonics::coefficients(&proportions, &[n], &Cancel::new()).unwrap()[0];
            assert!((alone - found).norm() <= ROUNDING * largest);
        }
    }
}

#[test]
fn a_cylinders_torques_are_what_its_piston_does() {
    let orders: Vec<u32> = (1..=HIGHEST).collect();
    for (ratio, offset, samples) in PROPORTIONS {
        let proportions = Proportions::new(ratio, offset).unwrap();
        let found = torque::torque(&proportions, &orders, &Cancel::new()).unwrap();
        let roll = sampled(&proportions, samples, |m| m.acceleration * (m.velocity + offset));
        let crank = sampled(&proportions, samples, |m| -m.acceleration * m.velocity);
        for (found, (expected, largest)) in [(&found.roll, roll), (&found.crank, crank)] {
            for (&n, found) in orders.iter().zip(found) {
                let off = (found - expected[n as usize]).norm();
                assert!(off <= ROUNDING * largest, "{ratio} {offset} {n}: {found}, off {off:e}");
            }
        }
    }
}

/// Many orders are worked out once each; few are not looked through for those that come again.
#[test]
fn torques_of_orders_that_come_again_are_those_of_each_alone() {
    let centred = Cylinder::new(0.05, 0.15, 1.3, 0.0).unwrap();
    let centred = centred.with_rod_inertia_excess(2e-4).unwrap();
    let orders: Vec<u32> = (1..=90).rev().chain([7, 7, 300, 1, 90]).collect();
    let nobody = Cancel::new();
    let all = torque::over_second_moment(&centred, &orders, &nobody).unwrap();
    for (k, &n) in orders.iter().enumerate() {
        let alone = torque::over_second_moment(&centred, &[n], &nobody).unwrap();
        assert_eq!((all.roll[k], all.crank[k]), (alone.roll[0], alone.crank[0]), "{n}");
    }
}

#[test]
fn who_stops_waiting_is_told_at_once() {
    let stopped = Cancel::new();
    stopped.raise();
    let cylinders = [0.0, 1e-3].map(|offset| Cylinder::new(0.05, 0.15, 1.0, offset).unwrap());
    for cylinder in cylinders {
        let mechanism = cylinder.mechanism();
        let found = mechanism.force(&[2], &stopped);
        assert_eq!(found.unwrap_err(), Error::Cancelled);
        let found = mechanism.torque(&[2], &stopped);
        assert_eq!(found.unwrap_err(), Error::Cancelled);
        let found = mechanism.swing_torque(&[2], &stopped);
        assert_eq!(found.unwrap_err(), Error::Cancelled);
    }
    // A spectrum stands in for all of that.
    let zero = Angle::from_degrees(0.0).unwrap();
    let cylinder = cylinders[0];
    let station = Station { cylinder, tdc: zero, bank: zero, z: 0.0, rotating_mass: 0.0 };
    let engine = Engine::new("", "", vec![station]).unwrap();
    let spectrum = Spectrum::new(vec![(1, Complex64::new(1.0, 0.0))]).unwrap();
    let engine = engine.with_spectrum(spectrum);
    let request = Request { rpm: 1000.0, reference_z: None, torque: false };
    for orders in [Orders::whole(&[1]).unwrap(), Orders::Auto { rtol: 1e-3 }] {
        let found = balance::balance(&engine, &request, &orders, &stopped);
        assert_eq!(found.unwrap_err(), Error::Cancelled);
    }
}

/// The sums of which the bounds are the closed forms: n² p₂ⁿ/(√(p₁p₂)(1 − p₂²)) for the force, and
/// (1.5 + |e|) of it from an order below on, with n p₂ⁿ⁻¹ l/2r, for the torque.
#[test]
fn tails_are_the_sums_they_say_and_bound_what_is_above() {
    for (ratio, offset) in [(0.1, 0.0), (0.3, 0.0), (0.3, 0.4), (0.6, -0.3), (0.9, 0.05)] {
        let proportions = Proportions::new(ratio, offset).unwrap();
        let root = |a: f64| a - (a * a - 1.0).sqrt();
        let p = root(proportions.rod - offset.abs());
        let product = p * root(proportions.rod + offset.abs());
        let series = |highest: u32, term: &dyn Fn(f64) -> f64| -> f64 {
            (highest + 1..highest + 3000).rev().map(|n| term(f64::from(n))).sum()
        };
        for highest in [1, 2, 5, 10, 31] {
            let squares = |highest| {
                series(highest, &|n| n * n * p.powf(n)) / (product.sqrt() * (1.0 - p * p))
            };
            let force = harmonics::tail_bound(&proportions, highest).unwrap();
            // p loses up to three digits to cancellation, p³¹ thirty times that.
            assert!((force / squares(highest) - 1.0).abs() < 1e-10);
            let rational = series(highest, &|n| n * p.powf(n - 1.0));
            let expected =
                (1.5 + offset.abs()) * squares(highest - 1) + 0.5 * proportions.rod * rational;
            let turning = torque::tail_bound(&proportions, highest).unwrap();
            assert!((turning / expected - 1.0).abs() < 1e-10);

            let above: Vec<u32> = (highest + 1..=highest + 400).collect();
            let coefficients =
                harmonics::coefficients(&proportions, &above, &Cancel::new()).unwrap();
            assert!(coefficients.iter().map(|a| a.norm()).sum::<f64>() <= force);
            let torques = torque::torque(&proportions, &above, &Cancel::new()).unwrap();
            let larger = |(a, b): (&Complex64, &Complex64)| a.norm().max(b.norm());
            let torques = torques.roll.iter().zip(&torques.crank);
            assert!(torques.map(larger).sum::<f64>() <= turning);
        }
    }
}
