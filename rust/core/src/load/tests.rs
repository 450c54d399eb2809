use std::f64::consts::TAU;
use std::sync::Arc;

use super::gas::GasPressure;
use super::kinematics::Kinematics;
use super::*;
use crate::Spectrum;
use crate::engine::{CrankIndex, Details, Engine, Gas, Shaft, Station, Unbalance};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::index::ListIndex;
use crate::numbers::ratio::SpeedRatio;
use crate::pressure::{Cycle, Given};
use crate::readings::amplitude::SourceAmplitudes;
use crate::source::over_angle::{AngleBlock, Columns, Quantities};
use crate::source::{self, GAS as GAS_NAME};
use crate::wrench::Wrench;

const REFERENCE: f64 = 0.03;

/// Sources of unbalances of the engine below, at 1, −1 and 2 times its speed, and of its rods.
const ONE: [usize; 3] = [2, 3, 4];
const RODS: [usize; 2] = [5, 6];

fn force(source: usize) -> Harmonic {
    Harmonic { source: SourceIndex::new(source), column: Column::Force }
}

fn roll(source: usize) -> Harmonic {
    Harmonic { source: SourceIndex::new(source), column: Column::Roll }
}

fn angle(degrees: f64) -> Angle {
    Angle::from_degrees(degrees).unwrap()
}

/// e^{ix}, x in degrees.
fn cis(degrees: f64) -> Complex64 {
    Complex64::cis(degrees * TAU / 360.0)
}

fn unbalance(amount: f64, degrees: f64, z: f64, pin: Option<usize>) -> Unbalance {
    Unbalance { amount, angle: angle(degrees), z, pin, crank: CrankIndex::MAIN }
}

/// A vee of three cylinders, two of one gear, with weights at pins and elsewhere, and shafts.
pub(crate) fn engine() -> Engine {
    let gears = [(0.05, 0.15, 0.5, 0.0), (0.04, 0.12, 0.75, 0.0), (0.05, 0.15, 0.5, 0.0)];
    let places = [(10.0, 60.0, 0.0, 0.3), (130.0, 130.0, 0.1, 0.0), (255.0, 60.0, 0.2, 0.4)];
    let place = |((r, l, m, e), (tdc, bank, z, rotating_mass))| Station {
        cylinder: Cylinder::new(r, l, m, e).unwrap().with_rod_inertia_excess(-1e-4).unwrap(),
        tdc: angle(tdc),
        bank: angle(bank),
        z,
        rotating_mass,
    };
    let shaft = |halves, axis, unbalances| {
        let ratio = SpeedRatio::from_halves(halves);
        Shaft { name: String::new(), ratio, axis, unbalances }
    };
    Engine::new("", "", gears.into_iter().zip(places).map(place).collect())
        .unwrap()
        .with_counterweights(vec![
            unbalance(0.01, 200.0, -0.1, None),
            unbalance(0.02, 170.0, 0.15, Some(1)),
        ])
        .unwrap()
        .with_shafts(vec![
            shaft(-2, [0.1, 0.05], vec![unbalance(0.004, 30.0, 0.3, None)]),
            shaft(4, [-0.08, 0.2], vec![unbalance(0.003, 77.0, 0.1, None)]),
        ])
        .unwrap()
}

fn loads(engine: &Engine) -> Scene {
    Scene::anew(engine, REFERENCE)
}

fn whole(order: u32) -> Order {
    Order::whole(order).unwrap()
}

/// Sums of one order.
fn sums(loads: &Scene, order: u32, by_bank: bool) -> Vec<Term<PhasorSum>> {
    loads.sums(&loads.list, whole(order), Wanted { planar: true, roll: true, by_bank })
}

/// Forward part and conjugate of the backward part of force and moment, and roll torque.
fn values(term: &Term<PhasorSum>) -> [Complex64; 5] {
    let ([f, b], [mf, mb]) = (&term.force, &term.moment);
    [f, b, mf, mb, &term.roll].map(|sum| sum.value)
}

#[track_caller]
fn close(found: Complex64, expected: Complex64) {
    assert!((found - expected).norm() < 1e-15, "{found} is not {expected}");
}

#[test]
fn loads_are_pistons_then_crank_unbalances_then_shafts() {
    let loads = loads(&engine());
    let list: Vec<_> = loads
        .list
        .iter()
        .map(|l| (l.weight, l.place.direction.degrees(), l.place.z, l.place.bank))
        .collect();
    assert_eq!(
        list,
        [
            (0.5 * 0.05, 60.0, 0.0, Some(0)),
            (0.75 * 0.04, 130.0, 0.1, Some(1)),
            (0.5 * 0.05, 60.0, 0.2, Some(0)),
            // Rotating masses, and a counterweight that belongs to the bank of its pin's cylinder.
            (0.3 * 0.05, 60.0, 0.0, Some(0)),
            (0.4 * 0.05, 60.0, 0.2, Some(0)),
            (0.01, 200.0, -0.1, None),
            (0.02, 300.0, 0.15, Some(1)),
            (0.004, 30.0, 0.3, None),
            (0.003, 77.0, 0.1, None),
            // Rods, which make a torque alone.
            (0.0, 60.0, 0.0, Some(0)),
            (0.0, 130.0, 0.1, Some(1)),
            (0.0, 60.0, 0.2, Some(0)),
        ]
    );
    let rolls: Vec<f64> = loads.list.iter().map(|load| load.roll).collect();
    let second = |mass: f64, radius: f64| mass * radius * radius;
    assert_eq!(rolls[..3], [second(0.5, 0.05), second(0.75, 0.04), second(0.5, 0.05)]);
    assert_eq!(rolls[3..], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1e-4, -1e-4, -1e-4]);
    let rod = LargestWeights { roll: 1e-4, ..LargestWeights::default() };
    assert_eq!(loads.largest_weights(SourceIndex::new(RODS[0])), rod);
    let (force, distance) = (4.0 * 0.003, f64::hypot(-0.08, 0.2));
    let fast = LargestWeights { force, arm: force * distance, roll: 0.0 };
    assert_eq!(loads.largest_weights(SourceIndex::new(ONE[2])), fast);
    let plain = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let station = Station { cylinder: plain, ..engine().stations()[0] };
    let plain = self::loads(&Engine::new("", "", vec![station]).unwrap());
    // Without rod inertia there is no load of it.
    assert_eq!(plain.list.len(), 2);
}

/// Sources of the pressures of an engine that fires.
const GAS: std::ops::Range<usize> = 5..7;

/// The [`engine`] with bores and one cycle, and area times crank radius of each cylinder.
pub(crate) fn fired(cycle_of: [Option<usize>; 3]) -> (Engine, [f64; 3]) {
    let theta_deg: Vec<f64> = (0..72).map(|k| 10.0 * f64::from(k)).collect();
    let pressure = theta_deg.iter().map(|&theta| loads_cycle(theta)).collect();
    let given = Given { name: String::new(), strokes: 4, theta_deg, pressure, degree: None };
    let gas = Gas {
        cycles: vec![Arc::new(Cycle::new(given).unwrap())],
        cycle_of: cycle_of.to_vec(),
        crank_ends: Vec::new(),
        crankcase: 1e5,
        later: vec![false, true, false],
    };
    let bores = [0.08, 0.07, 0.09];
    let details = bores.map(|bore| Details { bore: Some(bore), ..Details::default() });
    let fired = engine().with_details(details.to_vec()).and_then(|engine| engine.with_gas(gas));
    let swept = |(bore, radius): (f64, f64)| TAU / 8.0 * bore * bore * radius;
    (fired.unwrap(), [(bores[0], 0.05), (bores[1], 0.04), (bores[2], 0.05)].map(swept))
}

#[test]
fn torque_weights_are_of_the_pistons_under_pressure_by_gear() {
    let (all, swept) = fired([Some(0); 3]);
    // Cylinders 1 and 3 share a gear.
    let expected = [swept[0] + swept[2], swept[1]];
    for (found, expected) in loads(&all).torque_weights().iter().skip(GAS.start).zip(expected) {
        // Some roundings of half a unit in the last place.
        assert!((found.value - expected).abs() < 1e-15 * expected, "{found:?} {expected}");
    }
}

/// As of the under side of a piston.
#[test]
fn what_acts_the_other_way_has_the_same_sizes() {
    let (engine, _) = fired([Some(0); 3]);
    let ahead = loads(&engine);
    let mut opposite = loads(&engine);
    opposite.list.iter_mut().for_each(|load| {
        load.weight *= -1.0;
        load.roll *= -1.0;
    });
    for (a, b) in ahead.torque_weights().iter().zip(&opposite.torque_weights()) {
        assert_eq!((a.value, a.size), (-b.value, b.size));
    }
    for order in 1..4 {
        for (a, b) in sums(&ahead, order, true).iter().zip(sums(&opposite, order, true)) {
            let sums = [a, &b].map(|term| [term.force, term.moment, [term.roll; 2]]);
            for (a, b) in sums[0].iter().flatten().zip(sums[1].iter().flatten()) {
                assert!(a.size == b.size && b.size >= b.value.norm() * (1.0 - 1e-15));
            }
        }
    }
}

/// Pressure on the other face of a piston, a rod's area less, is one more load of a source there is.
#[test]
fn pressure_under_a_piston_is_a_load_of_the_other_sign() {
    let (engine, swept) = fired([Some(0); 3]);
    let mut loads = loads(&engine);
    let theta_deg: Vec<f64> = (0..=72).map(|k| 10.0 * f64::from(k)).collect();
    let under = |degrees: f64| 1e5 * (1.5 - 0.4 * (0.5 * degrees).to_radians().sin());
    let pressure = theta_deg.iter().map(|&theta| under(theta)).collect();
    let given = Given { name: String::new(), strokes: 4, theta_deg, pressure, degree: None };
    let cycle = Arc::new(Cycle::new(given).unwrap());
    let is_gas = |load: &&Load| loads.source(load).name() == GAS_NAME;
    let above: Vec<Load> = loads.list.iter().filter(is_gas).copied().collect();
    for load in &above {
        let driven = loads.source(load).mechanism().unwrap().clone();
        let gas = GasPressure {
            driven,
            cycle: Arc::clone(&cycle),
            place: 0,
            delay: Angle::ZERO,
            crankcase: 0.0,
        };
        loads.push(load.place, gas, 0.0, -0.8 * load.roll);
    }
    let degrees: Vec<f64> = (0..200).map(|k| 3.7 * f64::from(k)).collect();
    let angles = CrankAngles::new(&degrees).unwrap();
    let block = AngleBlock::new(&angles, 0..degrees.len());
    let (mut columns, wanted) =
        (Columns::ZERO, Quantities { force: false, moment: false, torque: true });
    for sum in &Kinematics::new(&loads).sums {
        let factor = f64::from(u8::from(sum.group != GroupIndex::default()));
        sum.source.over_angle(&sum.loads, &block, wanted, factor, &mut columns).unwrap();
    }
    let orders: Vec<Order> = (1..400).map(|halves| Order::from_halves(halves).unwrap()).collect();
    let amplitudes = SourceAmplitudes::new(&loads.sources, true, &orders, &Cancel::new()).unwrap();
    let wrenches = amplitudes.wrenches(&loads, &loads.list, true, &orders, &Cancel::new()).unwrap();
    let by_orders = (wrenches, amplitudes.means(&loads, &loads.list));
    let firing = [10.0, 130.0 + 360.0, 255.0];
    let lengths = [(0.05, 0.15), (0.04, 0.12), (0.05, 0.15)];
    for (k, &theta) in degrees.iter().enumerate() {
        // Each piston as a free body: what drives it down, times how fast it moves down.
        let expected: f64 = (0..3)
            .map(|i| {
                let own = theta - firing[i];
                let ((r, l), (sin, cos)) = (lengths[i], own.to_radians().sin_cos());
                let slope = -sin - r * sin * cos / (l * l - r * r * sin * sin).sqrt();
                let cycle = loads_cycle(own) - 1e5;
                -swept[i] * (cycle - 0.8 * under(own.rem_euclid(720.0))) * slope
            })
            .sum();
        let found = columns.torque[1][k];
        // Cubics through points 10° apart miss a sine by 1e-6 of it.
        assert!((found - expected).abs() < 1e-5 * 50.0, "{theta}: {found} {expected}");
        assert_eq!(columns.torque[0][k], -found);
        let (wrenches, means) = &by_orders;
        // Of inertia, then of gas.
        let wave = |(wrenches, order): (&[Wrench], &Order)| {
            (wrenches[1].torque.crank * cis(order.number() * theta)).re
        };
        let sum =
            means[GroupIndex::new(1)][1] + wrenches.chunks(2).zip(&orders).map(wave).sum::<f64>();
        // Bends of the tables at their points, 1/n⁴ above order 200.
        assert!((found - sum).abs() < 1e-6 * 50.0, "{theta}: {found} {sum}");
    }
}

/// Pressure of the cycle of [`fired`], Pa.
fn loads_cycle(degrees: f64) -> f64 {
    1e5 * (2.0 + degrees.to_radians().cos())
}

/// The series of pressure's torque is that of its rod ratio and cycle.
#[test]
fn pressure_at_another_point_is_evaluated_anew() {
    let (engine, _) = fired([Some(0); 3]);
    let (loads, cancel) = (loads(&engine), Cancel::new());
    let source = &loads.sources[SourceIndex::new(GAS.start)];
    let orders = Order::all_whole(&[1, 2, 3]).unwrap();
    let both = |source: &dyn source::Source| {
        let series = source.series(source::UpTo::Halves(8), &cancel).unwrap();
        [series.torque_at(&orders), source.torque(&orders, &cancel).unwrap()]
            .map(|torque| (torque.harmonics.roll, torque.harmonics.crank, torque.mean))
    };
    let [known, _] = both(&**source);
    let theta_deg = (0..72).map(|k| 10.0 * f64::from(k)).collect();
    let pressure = (0..72).map(|k| 1e5 + 1e3 * f64::from(k * (72 - k))).collect();
    let given = Given { name: String::new(), strokes: 4, theta_deg, pressure, degree: None };
    let cycles = [Arc::new(Cycle::new(given).unwrap())];
    let points = [
        source::Point { rod_ratio: Some(0.2), ..source::Point::default() },
        source::Point { pin_offset: Some(0.01), ..source::Point::default() },
        source::Point { cycles: Some(&cycles), ..source::Point::default() },
    ];
    for point in points {
        let [series, torque] = both(&*source::at_point(source, &point).unwrap());
        for (a, b) in series.0.iter().zip(&torque.0) {
            assert!((a - b).norm() <= 1e-13 * a.norm(), "{a} {b}");
        }
        assert_ne!(series, known);
    }
}

/// Σ area · radius · e^{−inφ} over the cylinders of a gear, φ the firing top dead centre.
#[test]
fn pressure_turns_with_the_crank_angle_of_firing() {
    let (engine, swept) = fired([Some(0); 3]);
    let firing = [10.0, 130.0 + 360.0, 255.0];
    for halves in 1..=5 {
        let wanted = Wanted { planar: false, roll: true, by_bank: false };
        let loads = loads(&engine);
        let terms = loads.sums(&loads.list, Order::from_halves(halves).unwrap(), wanted);
        let of = |i: usize| cis(-0.5 * f64::from(halves) * firing[i]) * swept[i];
        for (gear, expected) in [of(0) + of(2), of(1)].into_iter().enumerate() {
            let gas = roll(GAS.start + gear);
            let gas = terms.iter().find(|term| term.harmonic == gas).unwrap();
            close(gas.roll.value, expected);
        }
    }
}

#[test]
fn equal_pistons_share_a_source() {
    // Two pistons, three speeds of unbalances, two rods.
    assert_eq!(loads(&engine()).sources.len(), 7);
    // One of half the size has the same proportions, but not where a sweep replaces its pin offset.
    let halved = engine().stations()[0];
    let cylinder = Cylinder::new(0.025, 0.075, 0.5, 0.0).unwrap();
    let halved = Engine::new("", "", vec![halved, Station { cylinder, ..halved }]).unwrap();
    // Its rod is another too; both have a rotating mass.
    assert_eq!(loads(&halved).sources.len(), 4);
    // A spectrum has the masses in it.
    let spectrum = Spectrum::new([(1, Complex64::new(2.0, 0.0))]).unwrap();
    let given = Scene::anew(&engine().with_spectrum(spectrum.clone()), REFERENCE);
    assert!(given.sources.iter().all(|source| source.mechanism().is_none()));
    let orders = Order::all_whole(&[1, 2, 3]).unwrap();
    let force = given.sources[SourceIndex::default()].force(&orders, &Cancel::new()).unwrap();
    assert_eq!(force, [spectrum.amplitude(1), spectrum.amplitude(2), spectrum.amplitude(3)]);
    // Then shafts of three speeds.
    assert_eq!(given.sources.len(), 4);
    let weights = given.list.into_iter().map(|load| load.weight);
    assert_eq!(weights.take(4).collect::<Vec<_>>(), [1.0, 1.0, 1.0, 0.3 * 0.05]);
}

/// Sums of one order written out: channel by channel, forward part, conjugate of the backward part and
/// roll torque.
fn written_out(order: u32) -> [[Complex64; 5]; 3] {
    let n = f64::from(order);
    let i = Complex64::i();
    // Motions 0 and 1, and unbalances.
    let mut sums = [[Complex64::default(); 5]; 3];
    let mut add = |channel: usize, forward: Complex64, backward: Complex64, z: f64, roll| {
        let lever = z - REFERENCE;
        let moment = [i * forward * lever, i * backward * lever];
        let parts = [forward, backward.conj(), moment[0], moment[1].conj(), roll];
        sums[channel].iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
    };
    for (motion, tdc, bank, z, weight, inertia) in [
        (0, 10.0, 60.0, 0.0, 0.025, 0.5 * 0.05 * 0.05),
        (1, 130.0, 130.0, 0.1, 0.03, 0.75 * 0.04 * 0.04),
        (0, 255.0, 60.0, 0.2, 0.025, 0.5 * 0.05 * 0.05),
    ] {
        let [forward, backward] = [cis(bank - n * tdc), cis(bank + n * tdc)];
        add(
            motion,
            forward * (0.5 * weight),
            backward * (0.5 * weight),
            z,
            cis(-n * tdc) * inertia,
        );
    }
    for (ratio, amount, start, z, [x, y]) in [
        (1, 0.015, 60.0 - 10.0, 0.0, [0.0, 0.0]),
        (1, 0.02, 60.0 - 255.0, 0.2, [0.0, 0.0]),
        (1, 0.01, 200.0, -0.1, [0.0, 0.0]),
        (1, 0.02, 170.0, 0.15, [0.0, 0.0]),
        (-1, 0.004, 30.0, 0.3, [0.1, 0.05]),
        (2, 0.003, 77.0, 0.1, [-0.08, 0.2]),
    ] {
        if i32::unsigned_abs(ratio) != order {
            continue;
        }
        let force = cis(start) * (amount * f64::from(ratio * ratio));
        let (forward, backward) =
            if ratio > 0 { (force, Complex64::default()) } else { (Complex64::default(), force) };
        // F = forward·e^{inθ} + backward·e^{−inθ}; peak phasors of its real and imaginary part.
        let along_x = forward + backward.conj();
        let along_y = -i * (forward - backward.conj());
        add(2, forward, backward, z, along_y * x - along_x * y);
    }
    sums
}

#[test]
fn sums_are_those_of_loads_written_out() {
    let loads = loads(&engine());
    for order in 1..5 {
        let terms = sums(&loads, order, false);
        let of = |harmonic| {
            let found = terms.iter().find(|term| term.harmonic == harmonic);
            found.map_or_else(Default::default, values)
        };
        let [first, second, unbalances] = written_out(order);
        for (gear, expected) in [first, second].into_iter().enumerate() {
            let mut found = of(force(gear));
            found[4] = of(roll(gear))[4];
            found.into_iter().zip(expected).for_each(|(found, expected)| close(found, expected));
        }
        let mut one = [Complex64::default(); 5];
        for values in ONE.map(|source| of(force(source))) {
            one.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
        one.into_iter().zip(unbalances).for_each(|(a, b)| close(a, b));
        // Both rods of the first gear and one of the other, at −1e-4 kg·m².
        let rods = [
            cis(-10.0 * f64::from(order)) + cis(-255.0 * f64::from(order)),
            cis(-130.0 * f64::from(order)),
        ];
        for (gear, expected) in rods.into_iter().enumerate() {
            close(of(roll(RODS[gear]))[4], expected * -1e-4);
        }
    }
    assert!(
        loads
            .sums(
                &loads.list,
                Order::from_halves(3).unwrap(),
                Wanted { planar: true, roll: true, by_bank: true }
            )
            .is_empty()
    );
}

#[test]
fn sizes_are_sums_of_terms() {
    let loads = loads(&engine());
    let of = |order: u32, planar, roll| {
        let terms = sums(&loads, order, false);
        let found = |harmonic| terms.iter().find(|term| term.harmonic == harmonic).unwrap();
        let [force, moment] = found(planar).planar(1.0);
        [force.bound, moment.bound, found(roll).roll.size]
    };
    let near = |found: [f64; 3], expected: [f64; 3]| {
        found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15)
    };
    // Levers count by what they are the difference of.
    let levered = 0.025 * (REFERENCE + 0.2 + REFERENCE);
    let found = of(3, self::force(0), self::roll(0));
    assert!(near(found, [0.05, levered, 2.0 * 0.5 * 0.0025]));
    // The arms of a force are those of its components.
    let (force, arms) = (4.0 * 0.003, 0.08 + 0.2);
    let found = of(2, self::force(ONE[2]), self::force(ONE[2]));
    assert!(near(found, [force, force * (0.1 + REFERENCE), force * arms]));
}

/// The sums of each bank, turned as [`BankPhase`] says, are those of the engine with its banks turned.
#[test]
fn banks_turn_their_loads() {
    let engine = engine();
    let by = engine.banks().unwrap();
    assert_eq!((by.right, by.angle()), (0, angle(70.0)));
    for (hold, to) in [Hold::Pins, Hold::Firing].into_iter().zip([100.0, 35.5]) {
        let turned = engine.with_bank_angle(angle(to), hold).unwrap();
        let [before, after] = [&engine, &turned].map(loads);
        // The left bank turns ahead by this, the right one back.
        let turn_of = |bank: Option<usize>| match bank {
            None => 0.0,
            Some(0) => -0.5 * (to - 70.0),
            Some(_) => 0.5 * (to - 70.0),
        };
        for order in 1..4 {
            let turn = BankPhase::new(whole(order), hold);
            let multiples =
                [turn.forward, turn.backward_conj, turn.forward, turn.backward_conj, turn.roll];
            let banks = sums(&before, order, true);
            for expected in sums(&after, order, false) {
                let mut found = [Complex64::default(); 5];
                for part in banks.iter().filter(|part| part.harmonic == expected.harmonic) {
                    for ((sum, value), n) in found.iter_mut().zip(values(part)).zip(multiples) {
                        *sum += value * cis(0.5 * turn_of(part.bank) * n as f64);
                    }
                }
                found.into_iter().zip(values(&expected)).for_each(|(a, b)| close(a, b));
            }
        }
    }
}
