//! Every mechanism keeps what [`Mechanism`] promises: what it says of orders is what its motion has.

use super::articulated::{Knuckle, RunningGear};
use super::motion::CrankColumns;
use super::*;
use crate::numbers::angle::Angle;
use std::f64::consts::TAU;

/// Samples of a turn; orders above half of them fold back.
const SAMPLES: usize = 512;
/// Orders that are compared.
const HIGHEST: u32 = 12;

fn cranks() -> [Vec<f64>; 2] {
    let angles = || (0..SAMPLES).map(|k| TAU * k as f64 / SAMPLES as f64);
    [angles().map(f64::cos).collect(), angles().map(f64::sin).collect()]
}

/// Peak phasors of orders 1 to the highest of a function of the crank's position.
fn phasors(of: impl Fn(&CrankPosition) -> f64) -> Vec<Complex64> {
    let [cos, sin] = cranks();
    let values: Vec<f64> =
        cos.iter().zip(&sin).map(|(&cos, &sin)| of(&CrankPosition::new(sin, cos))).collect();
    let phasor = |n: u32| -> Complex64 {
        let turn =
            |k: usize| Complex64::cis(-TAU * (k * n as usize % SAMPLES) as f64 / SAMPLES as f64);
        let terms = values.iter().enumerate().map(|(k, value)| turn(k) * value);
        terms.sum::<Complex64>() * (2.0 / SAMPLES as f64)
    };
    (1..=HIGHEST).map(phasor).collect()
}

/// Orders agree with samples of the motion: roundings of 512 numbers of a few times `scale`.
fn assert_same(found: &[Complex64], sampled: &[Complex64], scale: f64) {
    for (n, (found, sampled)) in found.iter().zip(sampled).enumerate() {
        assert!((found - sampled).norm() <= 1e-14 * scale, "{}: {found} {sampled}", n + 1);
    }
}

/// Columns have the values of these single positions: velocity, jerk and lean if wanted.
fn check_columns(mechanism: &dyn Mechanism, [cranks, single]: [&Cranks; 2], wanted: [bool; 4]) {
    let mut columns = vec![vec![f64::NAN; cranks.len()]; 9];
    let [acceleration, velocity, jerk, slope, secant, opposite @ .., turning, bending] =
        &mut columns[..]
    else {
        unreachable!("nine of them")
    };
    let motion = MotionColumns {
        acceleration,
        velocity: wanted[0].then_some(velocity),
        jerk: wanted[1].then_some(jerk),
        lean: wanted[2].then_some([slope, secant]),
        opposite: opposite
            .as_chunks_mut()
            .0
            .first_mut()
            .filter(|_| wanted[3])
            .map(|both| both.each_mut().map(|own: &mut Vec<f64>| &mut own[..])),
    };
    mechanism.motions(cranks, motion);
    mechanism.swings(cranks, [turning, bending]);
    for i in 0..cranks.len() {
        let (motion, swing) = (mechanism.motion(&single.at(i)), mechanism.swing(&single.at(i)));
        let opposite = mechanism.motion(&single.at(i).opposite());
        let lean = [motion.slope, motion.secant].map(|value| wanted[2].then_some(value));
        let one_by_one = [
            Some(motion.acceleration),
            wanted[0].then_some(motion.velocity),
            wanted[1].then_some(motion.jerk),
            lean[0],
            lean[1],
            wanted[3].then_some(opposite.velocity),
            wanted[3].then_some(opposite.acceleration),
            Some(swing.velocity),
            Some(swing.acceleration),
        ];
        for (column, value) in columns.iter().zip(one_by_one) {
            // Products and sums may be rounded once there.
            let is_it = |value: f64| (column[i] - value).abs() <= 1e-13 * (1.0 + value.abs());
            assert!(value.map_or(column[i].is_nan(), is_it), "{wanted:?} {i}: {value:?}");
        }
    }
}

fn check(mechanism: &dyn Mechanism) {
    let (orders, cancel): (Vec<u32>, _) = ((1..=HIGHEST).collect(), Cancel::new());
    let at = |crank: &CrankPosition| mechanism.motion(crank);
    let swing = |crank: &CrankPosition| mechanism.swing(crank);
    // Columns are positions one by one, whichever are wanted, of positions that are kept or not.
    let ([cos, sin], phase) =
        (cranks().map(|c| <[f64; SAMPLES]>::try_from(c).unwrap()), Complex64::cis(0.3));
    let mut kept = CrankColumns::ZERO;
    kept.set(&cos, &sin, phase);
    let turned = Cranks::new(&cos, &sin, phase);
    for cranks in [turned, kept.cranks()] {
        for wanted in 0..16 {
            check_columns(mechanism, [&cranks, &turned], [1, 2, 4, 8].map(|bit| wanted & bit != 0));
        }
    }
    // Half a turn on they are what is evaluated there, to the last bit.
    let mut columns = vec![vec![f64::NAN; SAMPLES]; 6];
    let [velocity, acceleration, opposite @ .., velocity_there, acceleration_there] =
        &mut columns[..]
    else {
        unreachable!("six of them")
    };
    let opposite = opposite.as_chunks_mut().0.first_mut();
    let opposite = opposite.map(|both| both.each_mut().map(|own: &mut Vec<f64>| &mut own[..]));
    mechanism.motions(
        &turned,
        MotionColumns { opposite, ..MotionColumns::of_both([velocity, acceleration]) },
    );
    let there = Cranks::new(&cos, &sin, -phase);
    mechanism.motions(&there, MotionColumns::of_both([velocity_there, acceleration_there]));
    assert_eq!(columns[2..4], columns[4..]);
    // Derivatives: order n of each is i·n times that of the one before.
    let series = [
        phasors(|crank| at(crank).position),
        phasors(|crank| at(crank).velocity),
        phasors(|crank| at(crank).acceleration),
        phasors(|crank| at(crank).jerk),
    ];
    let times_order = |values: &[Complex64]| -> Vec<Complex64> {
        values.iter().zip(&orders).map(|(z, &n)| z * Complex64::new(0.0, f64::from(n))).collect()
    };
    for pair in series.windows(2) {
        assert_same(&times_order(&pair[0]), &pair[1], 100.0);
    }
    let [swings, bends] =
        [phasors(|crank| swing(crank).velocity), phasors(|crank| swing(crank).acceleration)];
    assert_same(&times_order(&swings), &bends, 100.0);
    // Force and torques.
    let force = mechanism.force(&orders, &cancel).unwrap();
    assert_same(&force, &phasors(|crank| -at(crank).acceleration), 10.0);
    let torque = mechanism.torque(&orders, &cancel).unwrap();
    let offset = mechanism.offset();
    let on_block = |crank: &CrankPosition| at(crank).acceleration * (at(crank).velocity + offset);
    assert_same(&torque.roll, &phasors(on_block), 10.0);
    let on_crank = |crank: &CrankPosition| -at(crank).acceleration * at(crank).velocity;
    assert_same(&torque.crank, &phasors(on_crank), 10.0);
    let of_rod = mechanism.swing_torque(&orders, &cancel).unwrap();
    assert_same(&of_rod.roll, &phasors(|crank| swing(crank).roll()), 10.0);
    assert_same(&of_rod.crank, &phasors(|crank| swing(crank).crank()), 10.0);
    // Bounds of what is above an order, and what exact sums may take for granted.
    let sum = |values: &[Complex64]| values.iter().map(|z| z.norm()).sum::<f64>();
    for highest in 0..HIGHEST {
        let above = highest as usize..;
        let torques =
            |of: &TorqueHarmonics| sum(&of.roll[above.clone()]).max(sum(&of.crank[above.clone()]));
        let bounds = [
            (mechanism.force_beyond(highest), sum(&force[above.clone()])),
            (mechanism.torque_beyond(highest), torques(&torque)),
            (mechanism.swing_torque_beyond(highest), torques(&of_rod)),
        ];
        for (bound, sum) in bounds {
            assert!(bound.unwrap() >= sum * (1.0 - 1e-15), "above {highest}: {bound:?} {sum}");
        }
    }
    for ((&n, force), torque) in orders.iter().zip(&force).zip(&torque.roll) {
        for (known, value) in
            [(mechanism.exact_force(n), force), (mechanism.exact_torque(n), torque)]
        {
            let crank = f64::from(u8::from(known.crank));
            let rest = value - crank;
            assert!(known.rest.exists() || rest.norm() == 0.0, "{n}: {known:?} {value}");
            assert!(
                !known.is_certain || !(known.rest.exists() || known.crank) || value.norm() > 0.0
            );
        }
    }
    assert!(mechanism.equals(mechanism));
}

#[test]
fn every_mechanism_of_the_house_keeps_its_promises() {
    for (rod_ratio, offset) in
        [(0.0, 0.0), (0.3, 0.0), (0.3, 0.2), (0.3, -0.2), (0.05, 1.0), (0.7, 1e-3), (0.7, 0.0)]
    {
        let mechanism = with_ratios(rod_ratio, offset).unwrap();
        check(&*mechanism);
        assert_eq!(mechanism.key().is_mirrored, offset < 0.0);
    }
}

#[test]
fn link_rods_keep_the_promises_of_mechanisms() {
    for ([radius, rod, offset], [ahead, knuckle]) in [
        ([0.052, 0.178, 0.0], [72.0, 72.0]),
        ([0.052, 0.178, 0.0], [-72.0, -72.0]),
        ([0.038, 0.152, 0.0], [60.0, 67.0]),
        ([0.038, 0.152, 0.01], [60.0, 67.0]),
        ([0.038, 0.152, -0.01], [-60.0, -67.0]),
        ([0.1, 0.3, 0.0], [144.0, 144.0]),
        ([1e-6, 0.152, 0.0], [60.0, 67.0]),
        ([0.052, 0.1, 0.0], [0.0, 180.0]),
    ] {
        let master = Cylinder::new(0.06, 0.23, 0.0, offset).unwrap();
        let cylinder = Cylinder::new(0.06, rod, 0.0, 0.0).unwrap();
        let [ahead, angle] = [ahead, knuckle].map(|degrees| Angle::from_degrees(degrees).unwrap());
        let knuckle = Knuckle { master, radius, angle, ahead };
        knuckle.check(&cylinder).unwrap();
        let mechanism = RunningGear { cylinder, knuckle: Some(knuckle) }.mechanism();
        check(&*mechanism);
        assert_eq!(mechanism.key().is_mirrored, ahead < Angle::ZERO);
        assert!(*mechanism == *mechanism.with_proportions(None, None).unwrap());
        assert!(mechanism.with_proportions(Some(0.3), None).is_err());
    }
}

#[test]
fn keys_are_those_of_figures_as_typed() {
    let of = |radius: f64, rod: f64, offset: f64| {
        Cylinder::new(radius, rod, 0.5, offset).unwrap().mechanism()
    };
    // 0.3/0.1 is no double, and 0.15/0.05 another one.
    assert_eq!(of(0.1, 0.3, 0.0).key(), of(0.05, 0.15, 0.0).key());
    assert_ne!(of(0.1, 0.3, 0.0).key(), of(0.1, 0.3001, 0.0).key());
    let [one, other] = [0.01, -0.01].map(|offset| of(0.05, 0.15, offset).key());
    assert_eq!((&one.figures, one.is_mirrored), (&other.figures, !other.is_mirrored));
    let swept = of(0.1, 0.3, 0.0).with_proportions(Some(0.25), None).unwrap();
    assert_eq!(swept.key().figures[0], exact::FigureKey::Nearest(4.0_f64.to_bits()));
    assert_ne!(of(0.05, f64::INFINITY, 0.0).key(), of(0.05, 0.15, 0.0).key());
}
