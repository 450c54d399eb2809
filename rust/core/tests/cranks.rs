//! Engines with several cranks, against momentum and energy of their masses.
//!
//! The reference knows places and speeds of masses alone. Force is the change of momentum, moment that
//! of moment of momentum about x and y; the roll torque is that about z and what turns each crank
//! evenly, the change of kinetic energy per radian of its own turn, in the sense in which it turns.

mod common;

use std::f64::consts::TAU;

use common::{angle, by_orders};
use crankpin_core::balance::{Orders, Request, Vector};
use crankpin_core::engine::CrankIndex;
use crankpin_core::engine::Unbalance;
use crankpin_core::{Cancel, Complex64, Crank, Cylinder, Engine, SpeedRatio, Station, waveform};

const RADIUS: f64 = 0.04;
const ROD: f64 = 0.13;
const MASS: f64 = 0.6;
/// Order 8 of a kinematics with λ = 0.31 is below 1e-5 of the first; aliases of 64 samples are nothing.
const SAMPLES: usize = 64;
const ORDERS: [u32; 6] = [1, 2, 3, 4, 6, 8];

/// Crank, top dead centre of the main crank's angle, bore, z, rotating mass, and unbalance at the pin.
#[derive(Clone, Copy)]
struct Piece {
    crank: usize,
    tdc: f64,
    bore: f64,
    z: f64,
    rotating_mass: f64,
    /// Amount and angle ahead of the pin.
    weight: [f64; 2],
}

fn piece(crank: usize, tdc: f64, bore: f64, z: f64) -> Piece {
    Piece { crank, tdc, bore, z, rotating_mass: 0.0, weight: [0.0; 2] }
}

fn engine(cranks: &[Crank], pieces: &[Piece]) -> Engine {
    let cylinder = Cylinder::new(RADIUS, ROD, MASS, 0.0).unwrap();
    let place = |s: &Piece| Station {
        cylinder,
        tdc: angle(s.tdc),
        bank: angle(s.bore),
        z: s.z,
        rotating_mass: s.rotating_mass,
    };
    let weights = pieces.iter().enumerate().map(|(i, s)| {
        let [amount, ahead] = s.weight;
        Unbalance { amount, angle: angle(ahead), z: s.z, pin: Some(i), crank: CrankIndex::MAIN }
    });
    Engine::new("", "", pieces.iter().map(place).collect())
        .and_then(|e| e.with_counterweights(weights.filter(|w| w.amount > 0.0).collect()))
        .and_then(|e| e.with_cranks(cranks.to_vec(), pieces.iter().map(|s| s.crank).collect()))
        .unwrap()
}

/// Peak phasors over ω² of force x, y, moment x, y, roll torque and torque on the main crank.
fn derived(cranks: &[Crank], pieces: &[Piece], reference: f64, order: u32) -> [Complex64; 6] {
    let phasor = |of: &dyn Fn(f64) -> f64| -> Complex64 {
        let sample = |k: usize| {
            let θ = TAU * k as f64 / SAMPLES as f64;
            Complex64::cis(-f64::from(order) * θ) * of(θ) * 2.0 / SAMPLES as f64
        };
        (0..SAMPLES).map(sample).sum()
    };
    let derivative = Complex64::i() * f64::from(order);
    let mut sums = [Complex64::default(); 6];
    for s in pieces {
        let Crank { axis: [x, y], ratio } = cranks[s.crank];
        let (axis, along, ratio) =
            (Complex64::new(x, y), Complex64::cis(s.bore.to_radians()), ratio.number());
        // Angle of the crankpin past the bore, by which it has turned since top dead centre.
        let past = |θ: f64| ratio * (θ - s.tdc.to_radians());
        // Piston: distance from the crank, and its speed over that of the main crank.
        let piston = |θ: f64| {
            let (sin, cos) = past(θ).sin_cos();
            let height = (ROD * ROD - RADIUS * RADIUS * sin * sin).sqrt();
            let speed = -RADIUS * sin - RADIUS * RADIUS * sin * cos / height;
            (RADIUS * cos + height, speed * ratio)
        };
        let [amount, ahead] = s.weight;
        let on_pin =
            [(s.rotating_mass * RADIUS, 0.0), (amount, ratio.signum() * ahead.to_radians())];
        let turning = |θ: f64| -> Complex64 {
            on_pin.iter().map(|(u, ahead)| u * along * Complex64::cis(past(θ) + ahead)).sum()
        };
        // Momentum in the plane, and moment of momentum about z, over ω.
        let momentum = |θ: f64| {
            let turned = Complex64::i() * ratio * turning(θ);
            along * (MASS * piston(θ).1) + turned
        };
        let about_z = |θ: f64| {
            let (place, speed) = piston(θ);
            let of_piston = (axis + along * place).conj() * along * (MASS * speed);
            // What turns has a constant moment of momentum about its own axis.
            (of_piston + axis.conj() * Complex64::i() * ratio * turning(θ)).im
        };
        let energy = |θ: f64| 0.5 * MASS * piston(θ).1 * piston(θ).1;
        let force =
            [-derivative * phasor(&|θ| momentum(θ).re), -derivative * phasor(&|θ| momentum(θ).im)];
        let turned_by_main = derivative * phasor(&energy);
        let lever = s.z - reference;
        let terms = [
            force[0],
            force[1],
            -force[1] * lever,
            force[0] * lever,
            turned_by_main / ratio - derivative * phasor(&about_z),
            -turned_by_main,
        ];
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
    }
    sums
}

/// The engine's balance and waveform are those derived; returns the engine.
#[track_caller]
fn check(cranks: &[Crank], pieces: &[Piece]) -> Engine {
    let engine = engine(cranks, pieces);
    let reference = engine.middle();
    let rpm = 60.0 / TAU;
    let request = Request { rpm, reference_z: None, torque: true };
    let balance = by_orders(&engine, &request, &ORDERS);
    for (k, &order) in ORDERS.iter().enumerate() {
        let [[fx, fy], [mx, my]] = [Vector::Force, Vector::Moment].map(|v| balance.xy(v, k));
        let torque = balance.wrenches[k].torque;
        let found = [fx, fy, mx, my, torque.roll, torque.crank];
        let expected = derived(cranks, pieces, reference, order);
        for (which, (found, expected)) in found.into_iter().zip(expected).enumerate() {
            // Four cylinders of m·r = 0.024 and levers of decimetres, each to rounding.
            assert!((found - expected).norm() < 2e-15, "{order} {which}: {found} {expected}");
        }
    }
    let thetas: Vec<f64> = (0..25).map(|k| 15.3 * f64::from(k)).collect();
    let cancel = Cancel::new();
    let exact = waveform::exact(&engine, &request, &thetas, &cancel).unwrap();
    let all = Orders::Auto { rtol: 1e-14 };
    let summed = waveform::from_orders(&engine, &request, &thetas, &all, &cancel).unwrap();
    let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14);
    assert!(same(exact.force.as_slice().unwrap(), summed.force.as_slice().unwrap()));
    assert!(same(exact.moment.as_slice().unwrap(), summed.moment.as_slice().unwrap()));
    for (a, b) in [(exact.torque, summed.torque), (exact.crank_torque, summed.crank_torque)] {
        assert!(same(a.unwrap().as_slice().unwrap(), b.unwrap().as_slice().unwrap()));
    }
    engine
}

fn beside(x: f64, ratio: i32) -> Crank {
    Crank { axis: [x, 0.0], ratio: SpeedRatio::whole(ratio) }
}

#[test]
fn a_main_crank_alone_is_the_usual_engine() {
    let pieces = [piece(0, 0.0, 60.0, 0.0), piece(0, 130.0, 120.0, 0.1)];
    check(&[Crank::MAIN], &pieces);
}

#[test]
fn contra_rotating_twins_have_no_force_of_order_one() {
    let cranks = [Crank::MAIN, beside(0.12, -1)];
    let mass = 0.3;
    // Bob weights of the whole reciprocating mass: what they leave across the bores is opposite.
    let weighed = |crank| Piece {
        rotating_mass: mass,
        weight: [(MASS + mass) * RADIUS, 180.0],
        ..piece(crank, 0.0, 90.0, 0.0)
    };
    let engine = check(&cranks, &[weighed(0), weighed(1)]);
    let rpm = 60.0 / TAU;
    let request = Request { rpm, reference_z: None, torque: true };
    let balance = by_orders(&engine, &request, &[1, 2]);
    assert_eq!(balance.xy(Vector::Force, 0), [Complex64::default(); 2]);
    // Order 2 adds up: 2·m·r·a₂. Each crank's own torque is the other's, the other way round; forces
    // beside the main axis make what is left.
    let mechanism = Cylinder::new(RADIUS, ROD, MASS, 0.0).unwrap().mechanism();
    let second = mechanism.force(&[2], &Cancel::new()).unwrap()[0];
    let [x, y] = balance.xy(Vector::Force, 1);
    assert!(x == Complex64::default() && (y - second * (2.0 * MASS * RADIUS)).norm() < 1e-16);
    let arm = second * (MASS * RADIUS * 0.12);
    assert!((balance.wrenches[1].torque.roll - arm).norm() < 1e-16);
}

#[test]
fn a_square_four_is_two_twins_back_to_back() {
    // Pins half a turn apart on each crank; cylinders in a square.
    for ratio in [1, -1] {
        let cranks = [Crank::MAIN, beside(0.1, ratio)];
        let at = |crank, tdc, z| piece(crank, tdc, 90.0, z);
        check(&cranks, &[at(0, 0.0, 0.0), at(0, 180.0, 0.1), at(1, 180.0, 0.0), at(1, 0.0, 0.1)]);
    }
}

#[test]
fn a_u_four_has_two_parallel_twins() {
    for (ratio, phase) in [(1, 90.0), (-1, 33.0), (2, 10.0), (-2, 20.0)] {
        let cranks = [Crank::MAIN, Crank { axis: [0.09, -0.02], ratio: SpeedRatio::whole(ratio) }];
        let on = |crank, tdc, z| Piece {
            rotating_mass: 0.2,
            weight: [0.01, 170.0],
            ..piece(crank, tdc, 90.0, z)
        };
        let pieces = [
            on(0, 0.0, 0.0),
            on(0, 180.0, 0.1),
            on(1, phase, 0.0),
            on(1, phase + 180.0 / f64::from(i32::abs(ratio)), 0.1),
        ];
        check(&cranks, &pieces);
    }
}

#[test]
fn opposed_pistons_balance_if_their_cranks_are_in_phase() {
    let cranks = [Crank::MAIN, Crank { axis: [0.0, 0.5], ratio: SpeedRatio::whole(-1) }];
    let pair = |lag: f64| [piece(0, 0.0, 90.0, 0.0), piece(1, lag, 270.0, 0.0)];
    let rpm = 60.0 / TAU;
    let request = Request { rpm, reference_z: None, torque: true };
    let in_phase = by_orders(&check(&cranks, &pair(0.0)), &request, &ORDERS);
    assert!((0..ORDERS.len()).all(|k| in_phase.planar(Vector::Force, k).peak() == 0.0));
    // The exhaust crank leads by 12°: |1 − e^{12°i}| of m·r.
    let led = by_orders(&check(&cranks, &pair(-12.0)), &request, &[1]);
    let expected = 2.0 * MASS * RADIUS * 6.0_f64.to_radians().sin();
    assert!((led.xy(Vector::Force, 0)[1].norm() - expected).abs() < 1e-16);
}

#[test]
fn cranks_that_are_none_are_rejected_by_name() {
    let pieces = [piece(0, 0.0, 90.0, 0.0), piece(1, 0.0, 90.0, 0.0)];
    let plain = engine(&[Crank::MAIN, beside(0.1, 1)], &pieces);
    let error = |cranks: &[Crank], of: &[usize]| {
        plain.with_cranks(cranks.to_vec(), of.to_vec()).unwrap_err().to_string()
    };
    let both = [Crank::MAIN, beside(0.1, -1)];
    assert!(error(&[], &[0, 0]).starts_with("cranks[0]"));
    assert!(error(&both[1..], &[0, 0]).starts_with("cranks[0]"));
    assert!(error(&[Crank::MAIN, beside(0.1, 0)], &[0, 1]).starts_with("cranks[1].ratio = 0"));
    let half = Crank { ratio: SpeedRatio::from_halves(-1), ..beside(0.1, 1) };
    let text = error(&[Crank::MAIN, half], &[0, 1]);
    assert!(text.starts_with("cranks[1].ratio = -1/2: cylinders need"), "{text}");
    assert!(plain.with_cranks(vec![Crank::MAIN, half], vec![0, 0]).is_ok());
    assert!(error(&[Crank::MAIN, beside(f64::NAN, 1)], &[0, 1]).starts_with("cranks[1].x = NaN"));
    assert!(error(&both, &[0]).starts_with("crank_of has 1 entries"));
    assert!(error(&both, &[0, 2]).starts_with("crank_of[1] = 2"));
    // What is defined for one crank is not for two.
    let turned = plain.with_bank_angle(angle(60.0), crankpin_core::Hold::Pins);
    assert!(turned.unwrap_err().to_string().contains("it has 2 cranks"));
}
