//! Laws that hold for any engine.

mod common;

use std::f64::consts::TAU;

use common::random::{angles, cylinders, engines, vees};
use common::{InArrays, by_orders, changed, turning, whole, xy};
use crankpin_core::angle::cis_degrees;
use crankpin_core::balance::{Vector, balance};
use crankpin_core::harmonics::torque::TorqueHarmonics;
use crankpin_core::quantity::{Part, Quantity};
use crankpin_core::sweep::{Statistic, SweepAxes};
use crankpin_core::{
    Angle, Balance, Cancel, Complex64, Crank, Cylinder, Engine, Hold, Order, Orders, Request,
    Spectrum, Station, Sweep, waveform,
};
use proptest::prelude::*;

const TORQUE: Quantity<'static> = Quantity::TORQUE;

const ORDERS: [u32; 6] = [1, 2, 3, 4, 6, 9];
const REQUEST: Request = Request { rpm: 3000.0, reference_z: Some(0.0), torque: true };
const VECTORS: [Vector; 2] = [Vector::Force, Vector::Moment];

fn of(engine: &Engine) -> Balance {
    by_orders(engine, &REQUEST, &ORDERS)
}

fn auto(engine: &Engine, request: &Request, rtol: f64) -> crankpin_core::Result<Balance> {
    balance(engine, request, &Orders::Auto { rtol }, &Cancel::new())
}

/// Roll torque, order by order.
fn rolls(balance: &Balance) -> impl Iterator<Item = Complex64> {
    assert!(balance.has_torque);
    balance.wrenches.iter().map(|wrench| wrench.torque.roll)
}

/// Size that rounding is relative to: Σ m r ω² (1 + |z|).
fn size(engine: &Engine) -> f64 {
    let omega = 3000.0 * TAU / 60.0;
    let each = |p: &Station| {
        (p.cylinder.mass_radius() + p.rotating_mass * p.cylinder.crank_radius()) * (1.0 + p.z.abs())
    };
    engine.stations().iter().map(each).sum::<f64>() * omega * omega
}

/// Equal to rounding: phases of order 9 of angles to 1024° are good to 9·1.1e-13·π/180 = 2e-14, of
/// which a sum of nine terms is allowed ten.
#[track_caller]
fn same(a: Complex64, b: Complex64, size: f64) {
    assert!((a - b).norm() <= 2e-13 * size, "{a} is not {b} (of {size})");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn force_goes_with_mass_radius_and_speed_squared(engine in engines(true), factor in 0.1..9.0_f64) {
        let scaled = changed(&engine, |p| {
            let c = p.cylinder;
            let cylinder = Cylinder::new(
                c.crank_radius() * factor,
                c.rod_length() * factor,
                c.reciprocating_mass() * factor,
                c.pin_offset() * factor,
            ).unwrap();
            let rod_inertia = c.rod_inertia_excess() * factor.powi(3);
            let cylinder = cylinder.with_rod_inertia_excess(rod_inertia).unwrap();
            Station { cylinder, rotating_mass: p.rotating_mass * factor, ..*p }
        });
        let before = of(&engine);
        let faster = Request { rpm: 3000.0 * factor, ..REQUEST };
        let after = by_orders(&scaled, &faster, &ORDERS);
        let power = factor.powi(4);
        let force = |balance| xy(balance, Vector::Force).concat();
        for (a, b) in force(&before).iter().zip(force(&after)) {
            same(*a * power, b, size(&engine) * power);
        }
        for (a, b) in rolls(&before).zip(rolls(&after)) {
            same(a * power * factor, b, size(&engine) * power * factor);
        }
    }

    #[test]
    fn turning_the_engine_turns_the_result(engine in engines(true), by in angles()) {
        let turned = changed(&engine, |p| Station { bank: p.bank + by, ..*p });
        let (before, after) = (of(&engine), of(&turned));
        for vector in VECTORS {
            for ([f, g], [f2, g2]) in turning(&before, vector).into_iter().zip(turning(&after, vector)) {
                same(f * by.cis(1), f2, size(&engine));
                same(g * by.cis(1), g2, size(&engine));
            }
        }
    }

    #[test]
    fn turning_the_crank_turns_the_phase(engine in engines(true), by in angles()) {
        let turned = changed(&engine, |p| Station { tdc: p.tdc + by, ..*p });
        let (before, after) = (of(&engine), of(&turned));
        for (k, &n) in ORDERS.iter().enumerate() {
            let phase = by.cis(-i64::from(n));
            let [a, b] = [&before, &after].map(|balance| &balance.wrenches[k]);
            same(a.force.forward * phase, b.force.forward, size(&engine));
            same(a.force.backward() * phase.conj(), b.force.backward(), size(&engine));
            same(a.torque.roll * phase, b.torque.roll, size(&engine));
        }
    }

    #[test]
    fn relabelling_changes_nothing(engine in engines(true), by in 0_usize..8) {
        let mut stations = engine.stations().to_vec();
        let count = stations.len();
        stations.rotate_left(by % count);
        stations.reverse();
        let (before, after) = (of(&engine), of(&Engine::new("", "", stations).unwrap()));
        let moment = |balance| xy(balance, Vector::Moment).concat();
        for (a, b) in moment(&before).iter().zip(moment(&after)) {
            same(*a, b, size(&engine));
        }
    }

    #[test]
    fn moving_the_plane_adds_force_times_distance(engine in engines(true), by in -1.0..1.0) {
        let here = of(&engine);
        let there = by_orders(&engine, &Request { reference_z: Some(by), ..REQUEST }, &ORDERS);
        for k in 0..ORDERS.len() {
            let [x, y] = here.xy(Vector::Force, k);
            let [a, b] = [&here, &there].map(|balance| balance.xy(Vector::Moment, k));
            same(a[0] + y * by, b[0], 2.0 * size(&engine));
            same(a[1] - x * by, b[1], 2.0 * size(&engine));
        }
    }

    #[test]
    fn a_mirror_swaps_and_conjugates(engine in engines(true)) {
        let upright = Angle::from_degrees(180.0).unwrap();
        // Without rotating mass: a mirrored pin would turn the other way.
        let engine = changed(&engine, |p| Station { rotating_mass: 0.0, ..*p });
        let mirrored = changed(&engine, |p| Station { bank: upright - p.bank, ..*p });
        for (vector, sign) in [(Vector::Force, -1.0), (Vector::Moment, 1.0)] {
            let [before, after] = [&engine, &mirrored].map(|engine| turning(&of(engine), vector));
            for ([f, b], [f2, b2]) in before.into_iter().zip(after) {
                same(b.conj() * sign, f2, size(&engine));
                same(f.conj() * sign, b2, size(&engine));
            }
        }
    }

    #[test]
    fn reversing_the_crank_swaps_forward_and_backward(engine in engines(false)) {
        let engine = changed(&engine, |p| Station { rotating_mass: 0.0, ..*p });
        let reversed = changed(&engine, |p| Station { tdc: -p.tdc, ..*p });
        let force = |engine| turning(&of(engine), Vector::Force).into_iter();
        for ([f, b], [f2, b2]) in force(&engine).zip(force(&reversed)) {
            same(b, f2, size(&engine));
            same(f, b2, size(&engine));
        }
    }

    #[test]
    fn boxer_pairs_cancel(cylinder in cylinders(true), tdc in angles(), bank in angles(), mass in 0.0..2.0) {
        let half = Angle::from_degrees(180.0).unwrap();
        let place = |bank| Station { cylinder, tdc, bank, z: 0.1, rotating_mass: mass };
        let engine = Engine::new("", "", vec![place(bank), place(bank + half)]).unwrap();
        let balance = of(&engine);
        for vector in VECTORS {
            let phasors = [xy(&balance, vector), turning(&balance, vector)].concat().concat();
            prop_assert!(phasors.iter().all(|z| *z == Complex64::default()));
        }
    }

    #[test]
    fn rotating_mass_is_all_forward(engine in engines(true)) {
        let without = changed(&engine, |p| Station { rotating_mass: 0.0, ..*p });
        let (with, without) = (of(&engine), of(&without));
        let [with, without] = [with, without].map(|balance| turning(&balance, Vector::Force));
        for ([_, a], [_, b]) in with.iter().zip(&without) {
            same(*a, *b, size(&engine));
        }
        let omega = 3000.0 * TAU / 60.0;
        let turning: Complex64 = engine
            .stations()
            .iter()
            .map(|p| Crank::MAIN.pin(p.bank, p.tdc).cis(1) * p.rotating_mass * p.cylinder.crank_radius() * omega * omega)
            .sum();
        same(with[0][0] - without[0][0], turning, size(&engine));
    }

    #[test]
    fn a_balance_is_the_sum_of_its_cylinders(engine in engines(true), reference in -0.3..0.3) {
        let request = Request { reference_z: Some(reference), ..REQUEST };
        let balance = by_orders(&engine, &request, &ORDERS);
        let square = (3000.0 * TAU / 60.0).powi(2);
        for (k, &n) in ORDERS.iter().enumerate() {
            let mut force = [Complex64::default(); 2];
            let mut moment = [Complex64::default(); 2];
            let (mut roll, mut crank) = (Complex64::default(), Complex64::default());
            // Σ|terms| of force, moment (of its levers' two parts) and torque.
            let mut terms = [0.0; 4];
            for p in engine.stations() {
                let (c, radius) = (p.cylinder, p.cylinder.crank_radius());
                let mechanism = c.mechanism();
                let alone = mechanism.force(&[n], &Cancel::new()).unwrap()[0];
                let phase = p.tdc.cis(-i64::from(n)) * square;
                let along = alone * phase * c.mass_radius();
                let turning = if n == 1 {
                    Crank::MAIN.pin(p.bank, p.tdc).cis(1) * (p.rotating_mass * radius * square)
                } else {
                    Complex64::default()
                };
                let here = [
                    along * p.bank.cis(1).re + turning,
                    along * p.bank.cis(1).im - Complex64::i() * turning,
                ];
                let size = along.norm() + turning.norm();
                let lever = p.z - reference;
                for (sum, part) in force.iter_mut().zip(here) {
                    *sum += part;
                }
                moment[0] -= here[1] * lever;
                moment[1] += here[0] * lever;
                let torques = mechanism.torque(&[n], &Cancel::new()).unwrap();
                let weight = c.mass_radius() * radius;
                roll += torques.roll[0] * phase * weight;
                crank += torques.crank[0] * phase * weight;
                terms[0] += size;
                terms[1] += size * (p.z.abs() + reference.abs());
                let sizes = |of: &TorqueHarmonics| [&of.roll, &of.crank].map(|parts| parts[0].norm());
                for (sum, size) in terms[2..].iter_mut().zip(sizes(&torques)) {
                    *sum += size * weight * square;
                }
                let inertia = c.rod_inertia_excess();
                let swing = mechanism.swing_torque(&[n], &Cancel::new()).unwrap();
                roll += swing.roll[0] * phase * inertia;
                crank += swing.crank[0] * phase * inertia;
                for (sum, size) in terms[2..].iter_mut().zip(sizes(&swing)) {
                    *sum += size * inertia.abs() * square;
                }
            }
            let size = 2.0 * size(&engine);
            for (vector, expected) in [(Vector::Force, force), (Vector::Moment, moment)] {
                for (found, expected) in balance.xy(vector, k).into_iter().zip(expected) {
                    same(found, expected, size);
                }
            }
            let torque = balance.wrenches[k].torque;
            same(torque.roll, roll, size);
            same(torque.crank, crank, size);
            // The documented bound of rounding errors: a load for each piston, rotating mass and rod.
            let rods = engine.stations().iter().filter(|p| p.cylinder.has_rod_inertia()).count();
            let loads = engine.stations().len() + engine.crank_unbalances().count();
            let factor = |loads: usize| (loads as f64 + 16.0 + 8.0 * f64::from(n)) * f64::EPSILON;
            let of_torque = factor(loads + rods);
            let factors = [factor(loads), factor(loads), of_torque, of_torque];
            let [force, moment] = VECTORS.map(|vector| balance.zero_bound(vector, k));
            let [roll, crank] = balance.torque_zero_bounds(Part::Whole, k);
            let bounds = [force, moment, roll, crank];
            for ((bound, terms), factor) in bounds.into_iter().zip(terms).zip(factors) {
                prop_assert!((bound - terms * factor).abs() <= 1e-12 * terms * factor);
            }
        }
    }

    #[test]
    fn peaks_of_all_orders_are_those_of_the_waveform(engine in engines(true)) {
        let found = of(&engine);
        let thetas: Vec<f64> = (0..3600).map(|k| f64::from(k) * 0.1).collect();
        let orders = Orders::whole(&ORDERS).unwrap();
        let wave =
            waveform::from_orders(&engine, &REQUEST, &thetas, &orders, &Cancel::new()).unwrap();
        // Half a step of 3600 at order 9: (9·8.7e-4)²/2 = 3.1e-5; six orders add up to 6 sizes.
        let close = |peak: f64, sampled: f64| {
            sampled <= peak + 1e-12 * size(&engine) && peak <= sampled + 2e-4 * size(&engine)
        };
        for (vector, wave) in [(Vector::Force, &wave.force), (Vector::Moment, &wave.moment)] {
            let largest = |of: &dyn Fn([f64; 2]) -> f64| {
                wave.rows().into_iter().map(|row| of([row[0], row[1]])).fold(0.0, f64::max)
            };
            let [x, y] = found.peak_xy(vector, &Cancel::new()).unwrap();
            prop_assert!(close(x, largest(&|[x, _]| x.abs())));
            prop_assert!(close(y, largest(&|[_, y]| y.abs())));
            prop_assert!(close(found.peak(vector, &Cancel::new()).unwrap(), largest(&|[x, y]| x.hypot(y))));
        }
        let torques = [&wave.torque, &wave.crank_torque];
        for (peak, torque) in [false, true].map(|on_crank| found.torque_peak(Part::Whole, on_crank, &Cancel::new()).unwrap()).into_iter().zip(torques) {
            let torque = torque.iter().flatten();
            prop_assert!(close(peak, torque.map(|t| t.abs()).fold(0.0, f64::max)));
        }
    }

    #[test]
    fn orders_and_kinematics_agree_and_keep_their_energy(engine in engines(true)) {
        let thetas: Vec<f64> = (0..256).map(|k| f64::from(k) * 360.0 / 256.0).collect();
        let cancel = Cancel::new();
        let exact = waveform::exact(&engine, &REQUEST, &thetas, &cancel).unwrap();
        let all = Orders::whole(&(1..=120).collect::<Vec<_>>()).unwrap();
        let summed =
            waveform::from_orders(&engine, &REQUEST, &thetas, &all, &cancel).unwrap();
        // λ ≤ 1/1.8 and e ≤ r/2: order 120 is below 1e-20; 120 powers of e^{iθ} lose 120 roundings.
        let tolerance = 1e-12 * size(&engine);
        for (a, b) in exact.force.iter().zip(&summed.force) {
            prop_assert!((a - b).abs() <= tolerance);
        }
        for (a, b) in exact.moment.iter().zip(&summed.moment) {
            prop_assert!((a - b).abs() <= tolerance);
        }
        for (a, b) in exact.torque.unwrap().iter().zip(&summed.torque.unwrap()) {
            prop_assert!((a - b).abs() <= tolerance);
        }
        for (a, b) in exact.crank_torque.unwrap().iter().zip(&summed.crank_torque.unwrap()) {
            prop_assert!((a - b).abs() <= tolerance);
        }
        // Parseval: the mean square of x + iy is the sum of |forward|² + |backward|².
        let mean: f64 = exact.force.iter().map(|x| x * x).sum::<f64>() / 256.0;
        let parts = summed.balance.unwrap();
        let parts = turning(&parts, Vector::Force).concat();
        let total: f64 = parts.iter().map(Complex64::norm_sqr).sum();
        prop_assert!((mean - total).abs() <= 1e-12 * size(&engine).powi(2));
    }

    #[test]
    fn chosen_orders_keep_their_promise(engine in engines(true), digits in 2_i32..13) {
        let rtol = 10_f64.powi(-digits);
        let thetas: Vec<f64> = (0..90).map(|k| f64::from(k) * 4.0).collect();
        let cancel = Cancel::new();
        let exact = waveform::exact(&engine, &REQUEST, &thetas, &cancel).unwrap();
        let orders = Orders::Auto { rtol };
        let chosen = auto(&engine, &REQUEST, rtol).unwrap();
        let summed = waveform::from_orders(&engine, &REQUEST, &thetas, &orders, &cancel).unwrap();
        prop_assert_eq!(summed.balance.as_ref(), Some(&chosen));
        let rounding = 1e-13 * size(&engine);
        for (a, b, bound) in [
            (&exact.force, &summed.force, chosen.error_bound.force),
            (&exact.moment, &summed.moment, chosen.error_bound.moment),
        ] {
            for (a, b) in a.rows().into_iter().zip(b.rows()) {
                prop_assert!((a[0] - b[0]).hypot(a[1] - b[1]) <= bound + rounding);
            }
        }
        let bound = chosen.error_bound.torque;
        let torques = exact.torque.unwrap().into_iter().zip(summed.torque.unwrap());
        let crank_torques = exact.crank_torque.unwrap().into_iter().zip(summed.crank_torque.unwrap());
        for (a, b) in torques.chain(crank_torques) {
            prop_assert!((a - b).abs() <= bound + rounding);
        }
        let largest = engine
            .stations()
            .iter()
            .map(|p| p.cylinder.mass_radius().max(p.rotating_mass * p.cylinder.crank_radius()))
            .fold(0.0, f64::max);
        let omega = 3000.0 * TAU / 60.0;
        prop_assert!(chosen.error_bound.force <= rtol * largest * omega * omega);
    }

    #[test]
    fn the_tail_bound_holds(cylinder in cylinders(true), highest in 1_u32..12) {
        let mechanism = cylinder.mechanism();
        let orders: Vec<u32> = (highest + 1..=200).collect();
        let tail: f64 =
            mechanism.force(&orders, &Cancel::new()).unwrap().iter().map(|a| a.norm()).sum();
        prop_assert!(tail <= mechanism.force_beyond(highest).unwrap());
        let of_rod = mechanism.swing_torque(&orders, &Cancel::new()).unwrap();
        let bound = mechanism.swing_torque_beyond(highest).unwrap();
        for harmonics in [of_rod.roll, of_rod.crank] {
            prop_assert!(harmonics.iter().map(|a| a.norm()).sum::<f64>() <= bound);
        }
    }

    #[test]
    fn a_sweep_is_a_loop_over_engines(
        engine in vees(), angles in proptest::collection::vec(0.0..180.0, 1..5), firing in any::<bool>(),
        ratio in 0.1..0.5, offset in -0.01..0.01, rpm in 100.0..9000.0,
    ) {
        let hold = if firing { Hold::Firing } else { Hold::Pins };
        let axes = SweepAxes {
            bank_angle: Some((angles.clone(), hold)),
            rod_ratio: Some(vec![0.5 * ratio, ratio]),
            pin_offset: Some(vec![offset, 0.0, -offset]),
            rpm: vec![rpm, 3000.0], map: None };
        let cancel = Cancel::new();
        let sweep = Sweep::new(vec![engine.clone().into()], axes, &Orders::whole(&ORDERS).unwrap(), Some(0.1), true, &Cancel::new()).unwrap();
        let phasors = |quantity| sweep.phasors(quantity, Statistic::Amplitude, &cancel).unwrap();
        let (force, moment) = (phasors(Quantity::FORCE), phasors(Quantity::MOMENT));
        let torque = phasors(TORQUE);
        let peaks = sweep.peaks(Quantity::MOMENT, Statistic::Amplitude, &cancel).unwrap();
        let vectors = sweep.peaks(Quantity::FORCE, Statistic::Length, &cancel).unwrap();
        for (i, &angle) in angles.iter().enumerate() {
            let there = engine.with_bank_angle(Angle::from_degrees(angle).unwrap(), hold).unwrap();
            let there = changed(&there, |p| {
                let (r, m) = (p.cylinder.crank_radius(), p.cylinder.reciprocating_mass());
                let cylinder = Cylinder::new(r, r / ratio, m, -offset).unwrap();
                let rod_inertia = p.cylinder.rod_inertia_excess();
                Station { cylinder: cylinder.with_rod_inertia_excess(rod_inertia).unwrap(), ..*p }
            });
            let alone = by_orders(&there, &Request { reference_z: Some(0.1), ..REQUEST }, &ORDERS);
            let size = 2.0 * size(&there);
            for k in 0..ORDERS.len() {
                for axis in 0..2 {
                    let phasor = alone.xy(Vector::Force, k)[axis];
                    same(force[[0, i, 1, 2, 1, 0, k, axis]], phasor, size);
                    let phasor = alone.xy(Vector::Moment, k)[axis];
                    same(moment[[0, i, 1, 2, 1, 0, k, axis]], phasor, size);
                    let peak = peaks[[0, i, 1, 2, 1, 0, k, axis]];
                    same(peak.into(), phasor.norm().into(), size);
                }
                same(torque[[0, i, 1, 2, 1, 0, k]], alone.wrenches[k].torque.roll, size);
                let longest = alone.planar(Vector::Force, k).peak();
                same(vectors[[0, i, 1, 2, 1, 0, k]].into(), longest.into(), size);
            }
        }
    }

    #[test]
    fn a_sweep_over_speed_and_rods_is_a_loop(engine in engines(true), ratio in 0.1..0.5) {
        let rpm = vec![0.0, 1000.0, 3000.0];
        let axes = SweepAxes { bank_angle: None, rod_ratio: Some(vec![ratio]), pin_offset: None, rpm, map: None };
        let engine = changed(&engine, |p| {
            let (r, m) = (p.cylinder.crank_radius(), p.cylinder.reciprocating_mass());
            Station { cylinder: Cylinder::new(r, r / ratio, m, 0.0).unwrap(), ..*p }
        });
        let engines = vec![engine.clone().into()];
        let sweep = Sweep::new(engines, axes, &Orders::whole(&ORDERS).unwrap(), Some(0.0), true, &Cancel::new()).unwrap();
        let moment = sweep.phasors(Quantity::MOMENT, Statistic::Amplitude, &Cancel::new()).unwrap();
        let alone = of(&engine);
        for k in 0..ORDERS.len() {
            for axis in 0..2 {
                let phasor = alone.xy(Vector::Moment, k)[axis];
                same(moment[[0, 0, 0, 0, 2, 0, k, axis]], phasor, size(&engine));
                prop_assert_eq!(moment[[0, 0, 0, 0, 0, 0, k, axis]], Complex64::default());
            }
        }
    }

    #[test]
    fn long_and_short_axes_agree(engine in vees(), split in 1_usize..40) {
        // The same angles in one sweep of many blocks and in two.
        let angles: Vec<f64> = (0..150).map(|k| f64::from(k) * 1.2).collect();
        let sweep = |angles: &[f64]| {
            let axes = SweepAxes {
                bank_angle: Some((angles.to_vec(), Hold::Pins)),
                rod_ratio: None,
                pin_offset: None,
                rpm: vec![3000.0], map: None };
            let engines = vec![engine.clone().into(), engine.clone().into()];
            let sweep = Sweep::new(engines, axes, &Orders::whole(&[1, 2, 4]).unwrap(), None, true, &Cancel::new()).unwrap();
            sweep.peaks(Quantity::MOMENT, Statistic::Sum, &Cancel::new()).unwrap()
        };
        let whole = sweep(&angles);
        let (first, last) = (sweep(&angles[..split]), sweep(&angles[split..]));
        for i in 0..150 {
            let part = if i < split { first[[1, i, 0, 0, 0, 0, 1]] } else { last[[1, i - split, 0, 0, 0, 0, 1]] };
            prop_assert_eq!(whole[[1, i, 0, 0, 0, 0, 1]], part);
        }
    }
}

/// Cylinders in phase and in line, one at z = 0 and one at 0.2, whose orders all add up.
fn in_phase(cylinder: Cylinder, tdc: f64) -> Engine {
    let tdc = Angle::from_degrees(tdc).unwrap();
    let bank = Angle::from_degrees(90.0).unwrap();
    let place = |z| Station { cylinder, tdc, bank, z, rotating_mass: 0.0 };
    Engine::new("", "", vec![place(0.0), place(0.2)]).unwrap()
}

#[test]
fn bounds_of_what_is_left_out_are_the_sums_of_its_sizes() {
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.01).unwrap();
    let mechanism = cylinder.mechanism();
    let above: Vec<u32> = (1..=200).collect();
    let sizes = mechanism.force(&above, &Cancel::new()).unwrap();
    let torques = mechanism.torque(&above, &Cancel::new()).unwrap();
    let square = (3000.0 * TAU / 60.0).powi(2);
    // A part of a turn, and none.
    for tdc in [0.0, 90.0, 17.123_456_789] {
        let engine = in_phase(cylinder, tdc);
        for rtol in [0.3, 1e-2, 1e-5, 1e-9] {
            let chosen = auto(&engine, &REQUEST, rtol).unwrap();
            let left = |n: &u32| !chosen.orders.contains(&Order::whole(*n).unwrap());
            let sum = |of: &dyn Fn(usize) -> f64| -> f64 {
                (0..above.len()).rev().filter(|&k| left(&above[k])).map(of).sum()
            };
            let force = 2.0 * cylinder.mass_radius() * square * sum(&|k| sizes[k].norm());
            let turning = sum(&|k| torques.roll[k].norm().max(torques.crank[k].norm()));
            let turning = 2.0 * cylinder.mass_radius() * 0.05 * square * turning;
            // The rest above the last candidate is bounded, by a hundredth of the tolerance.
            let slack = 1e-12 * force + 0.01 * rtol * square * cylinder.mass_radius();
            let expected = [force, 0.1 * force, turning];
            for (found, expected) in chosen.error_bound.values().into_iter().zip(expected) {
                assert!((found - expected).abs() <= slack);
            }
            assert!(chosen.error_bound.force <= rtol * cylinder.mass_radius() * square);
            assert!(chosen.omitted.iter().all(|order| !chosen.orders.contains(order)));
            assert!(chosen.omitted.windows(2).all(|pair| pair[0] < pair[1]));
            let last = chosen.omitted.last().unwrap().as_whole().unwrap();
            assert!(sizes[last as usize].norm() < 0.01 * rtol);
        }
    }
}

#[test]
fn orders_that_a_layout_cancels_are_not_omitted() {
    // A boxer pair: no force or moment at any order; and a pair half a turn apart in line, no force
    // at odd ones.
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let at = |degrees| Angle::from_degrees(degrees).unwrap();
    let place =
        |tdc, bank, z| Station { cylinder, tdc: at(tdc), bank: at(bank), z, rotating_mass: 0.0 };
    let request = Request { torque: false, ..REQUEST };
    let boxer = Engine::new("", "", vec![place(0.0, 0.0, 0.1), place(0.0, 180.0, 0.1)]).unwrap();
    let balance = auto(&boxer, &request, 1e-9).unwrap();
    assert_eq!((balance.orders.len(), balance.omitted.len()), (0, 0));
    // Orders above those evaluated are bounded as if nothing cancelled.
    let square = (request.rpm * TAU / 60.0).powi(2);
    assert!(balance.error_bound.force <= 1e-11 * cylinder.mass_radius() * square);
    let pair = Engine::new("", "", vec![place(0.0, 90.0, 0.0), place(180.0, 90.0, 0.0)]).unwrap();
    let balance = auto(&pair, &request, 1e-6).unwrap();
    assert!(!balance.orders.is_empty() && !balance.omitted.is_empty());
    let mut orders = balance.orders.iter().chain(&balance.omitted);
    assert!(orders.all(|order| order.as_whole().unwrap() % 2 == 0));
}

#[test]
fn tolerances_out_of_reach_are_refused() {
    let engine = |ratio: f64| in_phase(Cylinder::new(0.05, 0.05 / ratio, 0.5, 0.0).unwrap(), 0.0);
    let auto = |ratio: f64, rtol: f64| auto(&engine(ratio), &REQUEST, rtol);
    for rtol in [0.0, -1.0, 1.0, 1e-16, f64::NAN] {
        assert!(auto(0.3, rtol).unwrap_err().to_string().contains("rtol"), "{rtol}");
    }
    // 10 000 orders are too few for a crank that can hardly turn.
    assert!(auto(1.0 - 1e-9, 1e-6).is_err());
    assert!(auto(0.99, 1e-6).is_ok());
}

#[test]
fn a_spectrum_stands_in_for_the_rods() {
    let engine = in_phase(Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap(), 0.0);
    let turning = changed(&engine, |p| Station { rotating_mass: 1.0, ..*p });
    let amplitudes = [(2, 0.2), (4, 1e-6), (6, 0.0)];
    let spectrum = Spectrum::new(amplitudes.map(|(n, a)| (n, Complex64::new(a, 0.0)))).unwrap();
    let [still, turning] = [&engine, &turning]
        .map(|engine| auto(&engine.with_spectrum(spectrum.clone()), &REQUEST, 1e-3).unwrap());
    assert_eq!((&still.orders, &still.omitted), (&whole(&[2]), &whole(&[4])));
    // Rotating mass acts at order 1, which the spectrum does not have.
    assert_eq!((turning.orders, turning.omitted), (whole(&[1, 2]), whole(&[4])));
    assert!(!still.has_torque);
    let square = (3000.0 * TAU / 60.0).powi(2);
    same(still.xy(Vector::Force, 0)[1], Complex64::new(0.4 * square, 0.0), square);
    same(still.error_bound.force.into(), (2e-6 * square).into(), 1e-6 * square);
}

#[test]
fn degrees_of_the_circle_are_exact() {
    for quarter in 0..8 {
        let unit = cis_degrees(90.0 * f64::from(quarter));
        assert_eq!(unit.re * unit.im, 0.0);
    }
}
