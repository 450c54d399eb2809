//! Harmonics of one slider-crank against fifty digits.
//!
//! The tables are those of `tests/rederivation/harmonics_mp.py`, which integrates the motion itself.

use crankpin_core::Cancel;
use crankpin_core::Cylinder;
use crankpin_core::harmonics::{self, coefficients, rod, table, torque};
use crankpin_core::mechanism::with_ratios;
use crankpin_core::motion::CrankPosition;
use crankpin_core::slider_crank::Proportions;

const USUAL: &str = include_str!("../../../tests/data/harmonics_50_digits.csv");
const HARD: &str = include_str!("../../../tests/data/harmonics_where_methods_fail.csv");

/// One slider-crank: the part of each order that is not zero, real of even orders, imaginary of odd.
struct Row {
    ratio: f64,
    offset: f64,
    orders: Vec<u32>,
    parts: Vec<f64>,
}

fn rows(table: &str) -> impl Iterator<Item = Row> {
    let (head, rest) = table.split_once('\n').unwrap();
    let order = |name: &str| name.split_once('_').unwrap().1.parse().unwrap();
    let orders: Vec<u32> = head.split(',').skip(2).map(order).collect();
    rest.lines().map(move |line| {
        let mut values = line.split(',').map(|text| text.parse().unwrap());
        let (ratio, offset) = (values.next().unwrap(), values.next().unwrap());
        Row { ratio, offset, orders: orders.clone(), parts: values.collect() }
    })
}

#[test]
fn every_order_to_its_own_last_digits() {
    for Row { ratio, offset, orders, parts } in rows(USUAL).chain(rows(HARD)) {
        let proportions = Proportions::new(ratio, offset).unwrap();
        let found = coefficients(&proportions, &orders, &Cancel::new()).unwrap();
        for ((&n, exact), found) in orders.iter().zip(parts).zip(found) {
            let (part, other) =
                if n % 2 == 0 { (found.re, found.im) } else { (found.im, found.re) };
            assert_eq!(other, if n == 1 { 1.0 } else { 0.0 });
            // Units in the last place. Measured: 2.9 (3.8 above order 40) of closed forms, 20 of
            // the quadrature; with an offset 8, and each step of the recurrence adds part of one.
            let most = match offset {
                _ if ratio > 0.9999 => 25.0,
                0.0 => 4.0,
                _ => 9.0 + 0.2 * f64::from(n),
            };
            // Below 1e-300 doubles lose digits.
            let allowed = most * f64::EPSILON * exact.abs() + 1e-310;
            assert!((part - exact).abs() <= allowed, "{ratio} {offset} {n}: {part:e} {exact:e}");
        }
    }
}

#[test]
fn tables_to_the_last_digits() {
    let (mut ratios, mut parts) = (Vec::new(), Vec::new());
    let mut all = Vec::new();
    for row in rows(USUAL).chain(rows(HARD)).filter(|row| row.offset == 0.0) {
        all = row.orders;
        ratios.push(row.ratio);
        parts.push(row.parts);
    }
    for orders in [(1..=40).collect(), all] {
        let rows = ratios.iter().zip(&parts).filter(|(_, parts)| parts.len() == orders.len());
        let (ratios, parts): (Vec<f64>, Vec<&Vec<f64>>) = rows.unzip();
        let table = table::centred_table(&ratios, &orders, &Cancel::new()).unwrap();
        for ((row, parts), ratio) in table.rows().into_iter().zip(parts).zip(ratios) {
            for ((&value, &exact), &n) in row.iter().zip(parts).zip(&orders) {
                let exact = if n == 1 { 1.0 } else { exact };
                // Units in the last place. Measured: 2.2, 4.5 above order 40, 10.3 of the quadrature.
                let most = match n {
                    _ if ratio > 0.9999 => 25.0,
                    ..=40 => 3.0,
                    _ => 7.0,
                };
                let allowed = most * f64::EPSILON * exact.abs() + 1e-310;
                assert!((value - exact).abs() <= allowed, "{ratio} {n}: {value:e} {exact:e}");
            }
        }
    }
}

/// (rod ratio, offset over crank radius), usual and close to the crank that cannot turn.
const SHAPES: [(f64, f64); 7] =
    [(0.3, 0.0), (0.3, 0.4), (0.55, -0.3), (0.01, 0.0), (0.01, -50.0), (0.98, 0.0), (0.9, 0.1)];

#[test]
fn bounds_of_tails_are_their_sums() {
    // p = a − √(a² − 1), a = (l ± e)/r.
    let root = |a: f64| 1.0 / (a + ((a - 1.0) * (a + 1.0)).sqrt());
    for (ratio, offset) in SHAPES {
        let proportions = Proportions::new(ratio, offset).unwrap();
        let rod = 1.0 / ratio;
        let (p1, p) = (root(rod + f64::abs(offset)), root(rod - f64::abs(offset)));
        for highest in [0, 1, 2, 5, 30, 100] {
            // |aₙ| ≤ n²p₂ⁿ/(√(p₁p₂)(1 − p₂²)), and n p₂ⁿ⁻¹, added up from the smallest.
            let sum = |from: u32, term: &dyn Fn(f64) -> f64| -> f64 {
                (from..from + 3000).rev().map(|n| term(f64::from(n))).sum()
            };
            let squares = |n: f64| n * n * p.powf(n) / ((p1 * p).sqrt() * (1.0 - p * p));
            let linear = |n: f64| n * p.powf(n - 1.0);
            let force = sum(highest + 1, &squares);
            let neighbours = sum(highest.saturating_sub(1) + 1, &squares);
            let of_torque =
                (1.5 + offset.abs()) * neighbours + 0.5 * rod * sum(highest + 1, &linear);
            let of_swing = (2.0 * p / (1.0 - p * p) + 0.5 / rod) * sum(highest + 1, &linear);
            for (bound, sum) in [
                (harmonics::tail_bound(&proportions, highest), force),
                (torque::tail_bound(&proportions, highest), of_torque),
                (rod::tail_bound(&proportions, highest), of_swing),
            ] {
                // p is near 1 to 1e-16 at most, which order 100 takes to the hundredth power, and
                // of which 1 − p, squared and cubed, is a fifth or more.
                let bound = bound.unwrap();
                assert!(
                    (bound - sum).abs() <= 1e-12 * sum,
                    "{ratio} {offset} {highest}: {bound} {sum}"
                );
            }
        }
    }
}

#[test]
fn torques_of_a_cylinder_are_over_its_second_moment() {
    let cylinder = Cylinder::new(0.05, 0.16, 0.5, 0.01).unwrap();
    let orders = [1, 2, 3, 4, 6];
    let of_masses = cylinder.mechanism().torque(&orders, &Cancel::new()).unwrap();
    let of_rod = cylinder.mechanism().swing_torque(&orders, &Cancel::new()).unwrap();
    assert_eq!(torque::over_second_moment(&cylinder, &orders, &Cancel::new()).unwrap(), of_masses);
    let swinging = cylinder.with_rod_inertia_excess(-4e-4).unwrap();
    let both = torque::over_second_moment(&swinging, &orders, &Cancel::new()).unwrap();
    for k in 0..orders.len() {
        // m·r² = 0.5 · 0.05² = 1.25e-3, of which the excess is −0.32.
        for (both, masses, swing) in [
            (both.roll[k], of_masses.roll[k], of_rod.roll[k]),
            (both.crank[k], of_masses.crank[k], of_rod.crank[k]),
        ] {
            // A few roundings of either term.
            assert!((both - (masses - 0.32 * swing)).norm() < 1e-15);
        }
    }
    let no_mass = Cylinder::new(0.05, 0.16, 0.0, 0.0).unwrap();
    assert!(torque::over_second_moment(&no_mass, &orders, &Cancel::new()).is_ok());
    let swinging = no_mass.with_rod_inertia_excess(1e-3).unwrap();
    assert!(torque::over_second_moment(&swinging, &orders, &Cancel::new()).is_err());
}

/// Far up, where a harmonic has decayed below the rounding of the spike near the crank that cannot turn.
#[test]
fn high_orders_keep_their_digits_near_the_crank_that_cannot_turn() {
    // `even_harmonic_closed_form` of the same file, Gauss's hypergeometric function, to 30 digits.
    let exact = [(1.0 - 1e-5, -6.479_787_038_726_869e-4), (1.0 - 3e-6, -2.823_316_220_837_553e-2)];
    for (ratio, exact) in exact {
        let alone = coefficients(&Proportions::new(ratio, 0.0).unwrap(), &[2000], &Cancel::new())
            .unwrap()[0]
            .re;
        // An offset too small to matter, by another series.
        let reach = (1.0 - ratio) / ratio;
        let offset = Proportions::new(ratio, 1e-20 * reach).unwrap();
        for found in [alone, coefficients(&offset, &[2000], &Cancel::new()).unwrap()[0].re] {
            // The two-thousandth power, and steps of a recurrence.
            assert!((found / exact - 1.0).abs() < 1e-13, "{ratio}: {found:e}");
        }
    }
}

/// The real part of odd orders of the roll torque x''(x' + e): trapezoidal sums of 1200 to 120 000
/// points in 60 to 170 digits. Units in the last place, more where an order is close to a zero of it:
/// the third of λ = 0.9, the 25th of 0.999.
#[test]
fn odd_torque_orders_with_an_offset_keep_their_digits() {
    let orders = [1, 3, 5, 25, 99];
    for (ratio, offset, exact, most) in [
        (
            0.3,
            0.4,
            [
                -0.410_221_641_875_147_65,
                -0.029_147_398_464_088_255,
                0.002_433_416_501_828_465,
                1.512_490_628_621_024_5e-17,
                -7.847_523_692_278_092e-73,
            ],
            3.0,
        ),
        (
            0.3,
            1e-9,
            [
                -1.024_711_534_876_266_2e-9,
                -7.063_940_980_455_266e-11,
                5.619_341_500_572_571_6e-12,
                9.024_238_965_648_245e-27,
                -8.797_041_393_103_542e-86,
            ],
            3.0,
        ),
        (
            0.9,
            -0.1,
            [
                0.228_814_293_319_666_13,
                -0.008_141_829_242_005_126,
                -0.119_392_200_125_523_7,
                -0.050_145_237_158_367_995,
                3.247_432_705_014_084e-6,
            ],
            40.0,
        ),
        (
            0.999,
            5e-4,
            [
                -0.011_119_175_991_279_205,
                0.026_597_143_585_431_04,
                -0.036_670_924_939_328_27,
                0.005_197_315_743_077_866,
                -0.056_347_493_491_367_04,
            ],
            60.0,
        ),
        (
            0.999_999,
            5e-7,
            [
                -0.000_365_526_867_779_071_1,
                0.001_089_105_720_366_501_4,
                -0.001_805_259_784_623_748,
                -0.008_541_778_457_477_106,
                0.027_392_176_857_179_45,
            ],
            3.0,
        ),
        (
            0.3,
            2.333,
            [
                -3.117_801_840_048_658_2,
                -0.099_868_439_967_069_1,
                0.188_864_073_147_050_2,
                0.564_223_565_241_017_4,
                -0.330_655_112_708_427_3,
            ],
            3.0,
        ),
    ] {
        let proportions = Proportions::new(ratio, offset).unwrap();
        let found = torque::torque(&proportions, &orders, &Cancel::new()).unwrap();
        for ((n, exact), found) in orders.iter().zip(exact).zip(found.roll) {
            let units = (found.re / exact - 1.0).abs() / f64::EPSILON;
            assert!(units < most, "{ratio} {offset} {n}: {units} units");
        }
    }
}

#[test]
fn an_infinite_rod_is_the_limit_of_long_ones() {
    let orders: Vec<u32> = (1..=24).collect();
    let cancel = Cancel::new();
    let mechanism = |ratio| with_ratios(ratio, 0.0).unwrap();
    let of = |ratio: f64| {
        let mechanism = mechanism(ratio);
        let masses = mechanism.torque(&orders, &cancel).unwrap();
        let rods = mechanism.swing_torque(&orders, &cancel).unwrap();
        let force = mechanism.force(&orders, &cancel).unwrap();
        [force, masses.roll, masses.crank, rods.roll, rods.crank].concat()
    };
    for ratio in [1e-9, 1e-12, 1e-30] {
        for (long, infinite) in of(ratio).into_iter().zip(of(0.0)) {
            // The first order of the rod goes with λ, and two roundings of the others.
            assert!((long - infinite).norm() <= 2.0 * ratio + 1e-15, "{ratio}: {long} {infinite}");
        }
        for crank in [(0.6, 0.8), (-0.8, 0.6), (1.0, 0.0)] {
            let motion = |ratio| mechanism(ratio).motion(&CrankPosition::new(crank.0, crank.1));
            let (long, infinite) = (motion(ratio), motion(0.0));
            assert!((long.velocity - infinite.velocity).abs() <= ratio);
            assert!((long.acceleration - infinite.acceleration).abs() <= ratio);
            assert!((long.slope - infinite.slope).abs() <= ratio);
            assert!((long.secant - infinite.secant).abs() <= ratio + 1e-15);
        }
    }
    // Only order 1 of the force and order 2 of the torque are there, exactly, and in tables alike.
    let [first, second] =
        [1, 2].map(|n| orders.iter().map(move |&k| if k == n { 1.0 } else { 0.0 }));
    let force: Vec<f64> = first.collect();
    let roll: Vec<f64> = second.map(|one: f64| -0.5 * one).collect();
    let known = of(0.0);
    assert!(known.iter().zip(&force).all(|(z, &f)| (z.re, z.im) == (f, 0.0)));
    assert!(known[24..].iter().zip(&roll).all(|(z, &t)| (z.re, z.im) == (0.0, t)));
    let ratios = [0.0, 0.3, 0.0, 0.995];
    let table = table::centred_table(&ratios, &orders, &cancel).unwrap();
    let mut rolls = vec![0.0; ratios.len() * orders.len()];
    table::write_centred_roll(&ratios, &orders, &mut rolls, &cancel).unwrap();
    for row in [0, 2] {
        assert_eq!(table.row(row).to_vec(), force);
        let own = &rolls[row * orders.len()..][..orders.len()];
        assert!(own.iter().zip(&roll).all(|(value, known)| (value - known).abs() == 0.0));
    }
    let pair = table::centred_table(&ratios[1..2], &orders, &cancel).unwrap();
    assert_eq!(table.row(1), pair.row(0));
    // And bounds of the orders left out.
    let infinite = mechanism(0.0);
    for (highest, force, masses) in [(0, 1.0, 0.5), (1, 0.0, 0.5), (2, 0.0, 0.0), (9, 0.0, 0.0)] {
        assert_eq!(infinite.force_beyond(highest), Some(force));
        assert_eq!(infinite.torque_beyond(highest), Some(masses));
        assert_eq!(infinite.swing_torque_beyond(highest), Some(0.0));
    }
}
