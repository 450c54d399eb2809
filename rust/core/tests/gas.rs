//! Gas pressure in engines: with a second crank, phases of firing in files, and errors.

mod common;

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use common::{InArrays, angle};
use crankpin_core::balance::{Balance, Orders, Request, balance};
use crankpin_core::engine::layout::Strokes;
use crankpin_core::engine::{CrankEnd, CrankIndex, Details, Gas, file};
use crankpin_core::pressure::Given;
use crankpin_core::quantity::{Part, Quantity};
use crankpin_core::sweep::{MapAxes, Statistic, SweepAxes};
use crankpin_core::{
    Angle, Cancel, Complex64, Crank, CrankAngles, Cycle, Cylinder, Engine, Hold, Order, Shaft,
    SpeedRatio, Station, Sweep, Unbalance, waveform,
};

const BORE: f64 = 0.08;
const RADIUS: f64 = 0.04;
const ROD: f64 = 0.13;
const CRANKCASE: f64 = 1e5;

fn pressure(degrees: f64) -> f64 {
    1e5 + 3e6 * (8.0 * ((0.5 * (degrees - 14.0)).to_radians().cos() - 1.0)).exp()
}

fn cycle(strokes: u32) -> Arc<Cycle> {
    cycle_of(strokes, pressure)
}

fn cycle_of(strokes: u32, pressure: impl Fn(f64) -> f64) -> Arc<Cycle> {
    let theta_deg: Vec<f64> = (0..180 * strokes).map(f64::from).collect();
    let pressure = theta_deg.iter().map(|&θ| pressure(θ)).collect();
    let given = Given { name: String::new(), strokes, theta_deg, pressure, degree: None };
    Arc::new(Cycle::new(given).unwrap())
}

/// Two upright cylinders in one plane.
fn pair(cylinder: Cylinder) -> Engine {
    let place = Station {
        cylinder,
        tdc: angle(30.0),
        bank: Angle::QUARTER_TURN,
        z: 0.0,
        rotating_mass: 0.0,
    };
    let known = Details { bore: Some(BORE), ..Details::default() };
    Engine::new("", "", vec![place; 2]).unwrap().with_details(vec![known; 2]).unwrap()
}

/// Two upright cylinders on cranks of these ratios, 0.2 m apart.
fn twin(ratios: [i32; 2]) -> Engine {
    let engine = pair(Cylinder::new(RADIUS, ROD, 0.5, 0.0).unwrap());
    let cranks = ratios.map(|ratio| Crank {
        axis: [0.2 * f64::from(1 - ratio), 0.0],
        ratio: SpeedRatio::whole(ratio),
    });
    if ratios == [1, 1] {
        return engine;
    }
    engine.with_cranks(cranks.to_vec(), vec![0, 1]).unwrap()
}

/// The second fires a turn after the first.
fn gas(cycles: Vec<Arc<Cycle>>, cycle_of: [Option<usize>; 2]) -> Gas {
    let (cycle_of, later) = (cycle_of.to_vec(), vec![false, true]);
    Gas { cycles, cycle_of, crank_ends: Vec::new(), crankcase: CRANKCASE, later }
}

fn fired(ratios: [i32; 2]) -> Engine {
    twin(ratios).with_gas(gas(vec![cycle(4)], [Some(0); 2])).unwrap()
}

/// Torque of one cylinder on its own crank: pressure times the change of volume per radian.
fn derived(after: f64) -> f64 {
    let height = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        RADIUS * cos + (ROD * ROD - (RADIUS * sin).powi(2)).sqrt()
    };
    let step = 1e-3;
    let slope = (height(after + step) - height(after - step)) / (2.0 * step).to_radians();
    -(pressure(after) - CRANKCASE) * 0.25 * PI * BORE * BORE * slope
}

fn of_all(engine: &Engine) -> Balance {
    let request = Request { rpm: 60.0 / TAU, reference_z: None, torque: true };
    balance(engine, &request, &Orders::Auto { rtol: 1e-9 }, &Cancel::new()).unwrap()
}

#[test]
fn contra_rotating_cranks_drive_together_and_leave_the_block_no_mean() {
    let theta_deg: Vec<f64> = (0..72).map(|k| 10.0 * f64::from(k)).collect();
    let request = Request { rpm: 0.0, reference_z: None, torque: true };
    for (ratios, sense) in [([1, 1], 1.0), ([1, -1], -1.0)] {
        let engine = fired(ratios);
        let [block, crank] = waveform::exact(&engine, &request, &theta_deg, &Cancel::new())
            .unwrap()
            .parts
            .remove(0)
            .torque
            .unwrap();
        for (k, θ) in theta_deg.iter().enumerate() {
            let [one, other] = [derived(θ - 30.0), derived(θ - 390.0)];
            // Cubics at steps of a degree, and a difference quotient: 1e-6 of some 500 N·m.
            assert!((crank[k] - (one + other)).abs() < 1e-3, "{ratios:?} {θ}");
            assert!((block[k] + (one + sense * other)).abs() < 1e-3, "{ratios:?} {θ}");
        }
        let balance = of_all(&engine);
        for (k, θ) in theta_deg.iter().enumerate() {
            let gas = (0..balance.orders.len()).map(|n| balance.torque(Part::GAS, n));
            let at = |order: Order| Complex64::from_polar(1.0, order.number() * θ.to_radians());
            let mut sums = balance.mean(Part::GAS);
            for (gas, order) in gas.zip(&balance.orders) {
                sums[0] += (gas.roll * at(*order)).re;
                sums[1] += (gas.crank * at(*order)).re;
            }
            // Roundings of sums of some 100 N·m.
            let within = balance.error_bound.torque + 1e-11;
            assert!((sums[0] - block[k]).abs() < within, "{ratios:?} {θ}");
            assert!((sums[1] - crank[k]).abs() < within, "{ratios:?} {θ}");
        }
        let [on_block, on_crank] = balance.mean(Part::Whole);
        assert!(on_crank > 10.0);
        assert!((on_block + 0.5 * (1.0 + sense) * on_crank).abs() < 1e-12 * on_crank);
        assert_eq!(balance.mean(Part::INERTIA), [0.0; 2]);
    }
    // Equal pressures half a period apart: on the crank whole orders, on the block the others.
    let balance = of_all(&fired([1, -1]));
    for (k, order) in balance.orders.iter().enumerate() {
        let gas = balance.torque(Part::GAS, k);
        let (there, zero) =
            if order.as_whole().is_some() { (gas.crank, gas.roll) } else { (gas.roll, gas.crank) };
        assert!(zero.norm() == 0.0 && there.norm() > 0.0, "{order}");
    }
}

#[test]
fn files_keep_cycles_and_the_turn_in_which_cylinders_fire() {
    // Neither a fraction nor a double that a turn added to it leaves as it is.
    let odd = Angle::from_degrees(0.1_f64.sqrt()).unwrap();
    let other = gas(vec![cycle(4), cycle(4)], [Some(1), None]);
    let engines =
        [fired([1, 1]), fired([1, -1]), twin([1, 1]).with_first_tdc(odd).with_gas(other).unwrap()];
    for engine in engines {
        assert_eq!(file::from_toml(&file::to_toml(&engine).unwrap()).unwrap(), engine);
        assert_eq!(file::from_json(&file::to_json(&engine).unwrap()).unwrap(), engine);
    }
    let text = file::to_json(&fired([1, 1])).unwrap();
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from));
        file::from_json(&text.replacen(from, to, 1)).unwrap_err().to_string()
    };
    assert!(refused("\"cycle\": 1", "\"cycle\": 0").starts_with("placements[0].cycle = 0"));
    assert!(refused("\"cycle\": 1", "\"cycle\": 2").starts_with("cycle_of[0] = 1"));
    assert!(refused("\"crankcase\": 100000.0", "\"crankcase\": -1.0").starts_with("crankcase"));
}

#[test]
fn firing_turns_with_the_crank() {
    let engine = fired([1, 1]);
    let phases = |engine: &Engine| [0, 1].map(|i| engine.firing_phase(i).degrees());
    assert_eq!(phases(&engine), [30.0, 390.0]);
    assert_eq!(phases(&engine.with_first_tdc(angle(350.0))), [350.0, 710.0]);
    let back = engine.with_first_tdc(angle(350.0)).with_first_tdc(angle(30.0));
    assert_eq!(back, engine);
}

#[test]
fn pressure_that_makes_no_torque_known_is_refused() {
    let refused = |engine: Engine, gas: Gas| engine.with_gas(gas).unwrap_err().to_string();
    let four = || gas(vec![cycle(4)], [Some(0); 2]);
    let ratio = refused(twin([1, 2]), four());
    assert!(ratio.starts_with("cranks[1].ratio = 2"), "{ratio}");
    let bare = twin([1, 1]).with_details(vec![Details::default(); 2]).unwrap();
    assert!(refused(bare, four()).starts_with("cylinder[0].bore = None"));
    let two = gas(vec![cycle(2)], [Some(0); 2]);
    assert!(refused(twin([1, 1]), two).starts_with("cycle[0].strokes = 2"));
    let engine = fired([1, 1]);
    assert!(engine.with_details(vec![Details::default(); 2]).is_err());
    let geared = vec![Crank::MAIN, Crank { axis: [0.1, 0.0], ratio: SpeedRatio::whole(-3) }];
    assert!(engine.with_cranks(geared, vec![0, 1]).is_err());
    // Without any cycle there is nothing to refuse, and nothing is kept.
    assert_eq!(twin([1, 1]).with_gas(gas(vec![cycle(4)], [None; 2])).unwrap(), twin([1, 1]));
    assert!(engine.firing_as("", Strokes::Two).is_err());
    assert!(engine.firing_as("1-2", Strokes::Four).is_ok());
}

/// Gas torque is linear in pressure: between the cycles of a map it is between theirs, at any speed; what
/// the moving parts make does not know the load.
#[test]
fn sweeps_of_a_map_weigh_the_torques_of_its_cycles() {
    let (speeds, loads) = ([1000.0, 2000.0, 3500.0], [0.2, 1.0]);
    let swept_rpm = [1000.0, 1250.0, 3500.0];
    let factor = |speed: usize, load: usize| 0.3 + 0.2 * speed as f64 + 0.5 * load as f64;
    let made = |stroke: f64, ratio: f64, factor: f64| {
        let cylinder = Cylinder::new(stroke / 2.0, stroke / 2.0 / ratio, 0.5, 0.0).unwrap();
        let cycle = cycle_of(4, |θ| CRANKCASE + factor * (pressure(θ) - CRANKCASE));
        Arc::new(pair(cylinder).with_gas(gas(vec![cycle], [Some(0), None])).unwrap())
    };
    let (strokes, ratios) = ([0.08, 0.1], [0.25, 0.3]);
    let nodes = || (0..3).flat_map(|speed| [0, 1].map(|load| (speed, load)));
    let swept = |strokes: &[f64], ratios: &[f64]| {
        // Those of the engines do not count.
        let engines: Vec<_> = strokes.iter().map(|&stroke| made(stroke, 0.2, 7.0)).collect();
        let cycles: Vec<_> = nodes()
            .map(|(speed, load)| made(0.1, 0.2, factor(speed, load)).gas().unwrap().cycles.clone())
            .collect();
        let orders = Orders::whole(&[1, 2, 4]).unwrap();
        let sweep = |cycles: &[Vec<Arc<Cycle>>]| {
            let map = MapAxes {
                rpm: speeds.to_vec(),
                loads: loads.to_vec(),
                cycles: cycles.to_vec(),
                load: vec![1.0, 0.4],
            };
            let axes = SweepAxes {
                rod_ratio: Some(ratios.to_vec()),
                rpm: swept_rpm.to_vec(),
                map: Some(map),
                ..SweepAxes::default()
            };
            Sweep::new(engines.clone(), axes, &orders, None, true, &Cancel::new())
        };
        let refused = |cycles: &[Vec<Arc<Cycle>>]| sweep(cycles).unwrap_err().to_string();
        assert!(refused(&cycles[1..]).starts_with("cycles = 5"));
        let twice: Vec<_> = cycles.iter().map(|cycles| [&cycles[..]; 2].concat()).collect();
        assert!(refused(&twice).starts_with("cycles = 2"));
        let mut other = cycles.clone();
        other[4] = vec![cycle_of(2, pressure)];
        assert!(refused(&other).starts_with("cycle[0].strokes = 2"));
        sweep(&cycles).unwrap()
    };
    let (orders, cancel) = (common::whole(&[1, 2, 4]), Cancel::new());
    let sweep = swept(&strokes, &ratios);
    assert_eq!(sweep.shape(), [2, 1, 2, 1, 3, 2]);
    // The share of the upper speed and load.
    let weights = [0.0, 0.25, 2.0];
    let of_load = [1.0, 0.25];
    let orders = Orders::Given(orders);
    let parts = [Part::Whole, Part::GAS, Part::INERTIA];
    for (on_crank, part) in [false, true].into_iter().flat_map(|c| parts.map(|part| (c, part))) {
        let quantity =
            if on_crank { Quantity::CRANK_TORQUE.part(part) } else { Quantity::TORQUE.part(part) };
        let phasors = sweep.phasors(quantity, Statistic::Amplitude, &cancel).unwrap();
        let [peaks, sums, means] = [Statistic::Amplitude, Statistic::Sum, Statistic::Mean]
            .map(|figure| sweep.peaks(quantity, figure, &cancel).unwrap());
        for (place, &mean) in means.indexed_iter() {
            let (e, r, s, l) = (place[0], place[2], place[4], place[5]);
            let lower = (weights[s] as usize).min(1);
            let share = weights[s] - lower as f64;
            let (mut expected, mut expected_mean) = (vec![Complex64::default(); 3], 0.0);
            let sides = [(0, 0), (0, 1), (1, 0), (1, 1)];
            for (upper, load) in sides {
                let of_speed = if upper == 1 { share } else { 1.0 - share };
                let weight = of_speed * if load == 1 { of_load[l] } else { 1.0 - of_load[l] };
                let engine = made(strokes[e], ratios[r], factor(lower + upper, load));
                let request = Request { rpm: swept_rpm[s], reference_z: None, torque: true };
                let balance = balance(&engine, &request, &orders, &cancel).unwrap();
                for (k, sum) in expected.iter_mut().enumerate() {
                    let torque = balance.torque(part, k);
                    *sum += weight * if on_crank { torque.crank } else { torque.roll };
                }
                expected_mean += weight * balance.mean(part)[usize::from(on_crank)];
            }
            // Roundings of some 100 N·m.
            assert!((mean - expected_mean).abs() < 1e-10, "{quantity:?} {place:?}");
            let at = |k: usize| [e, 0, r, 0, s, l, k];
            for (k, phasor) in expected.iter().enumerate() {
                let found = phasors[&at(k)[..]];
                assert!((found - phasor).norm() < 1e-10, "{quantity:?} {place:?} {k}");
                assert!((peaks[&at(k)[..]] - phasor.norm()).abs() < 1e-10);
            }
            let sampled = (0..3600).map(|k| TAU * f64::from(k) / 3600.0).map(|θ| {
                let numbers = [1.0, 2.0, 4.0];
                let turned = |(n, p): (f64, &Complex64)| (p * Complex64::from_polar(1.0, n * θ)).re;
                (expected_mean + numbers.into_iter().zip(&expected).map(turned).sum::<f64>()).abs()
            });
            let largest = sampled.fold(0.0, f64::max);
            // Between two samples cos 4θ falls by (4·0.00087)²/2 at most.
            let sum = sums[place];
            assert!(sum > largest - 1e-9 && sum < largest * (1.0 + 1e-5) + 1e-9, "{sum} {largest}");
        }
    } // Rows of several tasks are those of one.
    let quantity = Quantity::CRANK_TORQUE;
    let many: Vec<f64> = (0..40).map(|k| 0.2 + 0.003 * f64::from(k)).collect();
    let sums = |ratios: &[f64]| {
        let found = swept(&strokes[..1], ratios).peaks(quantity, Statistic::Sum, &cancel);
        found.unwrap().into_raw_vec_and_offset().0
    };
    let all = sums(&many);
    for (k, of_ratio) in all.chunks_exact(6).enumerate().filter(|(k, _)| k % 13 == 0) {
        assert_eq!(of_ratio, sums(&many[k..=k]), "{k}");
    }
}

/// A leaning vee with a balance shaft, whose second bank alone is under pressure; the directions of its banks are on either side of
/// that from which they are counted.
fn fired_vee([ratio, offset]: [f64; 2]) -> Engine {
    let place = |tdc: f64, bank: f64, z: f64| Station {
        cylinder: Cylinder::new(RADIUS, RADIUS / ratio, 0.5, offset).unwrap(),
        tdc: angle(tdc),
        bank: angle(bank),
        z,
        rotating_mass: 0.0,
    };
    let known = Details { bore: Some(BORE), ..Details::default() };
    let weight =
        Unbalance { amount: 0.005, angle: angle(33.0), z: 0.1, pin: None, crank: CrankIndex::MAIN };
    let (name, axis) = (String::new(), [0.1, -0.05]);
    let beside = Shaft { name, ratio: SpeedRatio::whole(2), axis, unbalances: vec![weight] };
    Engine::new("", "", vec![place(30.0, 350.0, 0.0), place(100.0, 50.0, 0.1)])
        .and_then(|engine| engine.with_details(vec![known; 2]))
        .and_then(|engine| engine.with_gas(gas(vec![cycle(4)], [None, Some(0)])))
        .and_then(|engine| engine.with_shafts(vec![beside]))
        .unwrap()
}

fn unfired(engine: &Engine) -> Engine {
    engine.with_gas(gas(vec![cycle(4)], [None; 2])).unwrap()
}

fn halves(orders: impl Iterator<Item = u32>) -> Vec<Order> {
    orders.map(|halves| Order::from_halves(halves).unwrap()).collect()
}

const VEE: [f64; 2] = [0.3, 0.0];

/// Half orders turn by quarters of the bank angle, and gas by each rod ratio and offset.
#[test]
fn each_point_of_a_sweep_of_a_fired_vee_is_a_balance() {
    let (angles, ratios, offsets) = ([40.0, 170.0], [0.25, 0.3], [0.0, 0.004]);
    let (orders, cancel) = (halves([1, 2, 3, 4, 9].into_iter()), Cancel::new());
    let orders_given = Orders::Given(orders.clone());
    for hold in [Hold::Pins, Hold::Firing] {
        let axes = SweepAxes {
            bank_angle: Some((angles.to_vec(), hold)),
            rod_ratio: Some(ratios.to_vec()),
            pin_offset: Some(offsets.to_vec()),
            rpm: vec![1000.0],
            map: None,
        };
        let engines = vec![Arc::new(fired_vee(VEE)), Arc::new(unfired(&fired_vee(VEE)))];
        let sweep =
            Sweep::new(engines, axes, &Orders::Given(orders.clone()), None, true, &cancel).unwrap();
        for (part, on_crank) in
            [(Part::GAS, false), (Part::GAS, true), (Part::Whole, false), (Part::Whole, true)]
        {
            let quantity = if on_crank {
                Quantity::CRANK_TORQUE.part(part)
            } else {
                Quantity::TORQUE.part(part)
            };
            let phasors = sweep.phasors(quantity, Statistic::Amplitude, &cancel).unwrap();
            let means = sweep.peaks(quantity, Statistic::Mean, &cancel).unwrap();
            for (place, &mean) in means.indexed_iter() {
                let (e, a, r, o) = (place[0], place[1], place[2], place[3]);
                let fired = fired_vee([ratios[r], offsets[o]]);
                let engine = if e == 0 { fired } else { unfired(&fired) };
                let engine = engine.with_bank_angle(angle(angles[a]), hold).unwrap();
                let request = Request { rpm: 1000.0, reference_z: None, torque: true };
                let balance = balance(&engine, &request, &orders_given, &cancel).unwrap();
                // Roundings of some 500 N·m.
                let expected = balance.mean(part)[usize::from(on_crank)];
                assert!((mean - expected).abs() < 1e-10, "{quantity:?} {hold:?} {place:?}");
                for k in 0..orders.len() {
                    let torque = balance.torque(part, k);
                    let expected = if on_crank { torque.crank } else { torque.roll };
                    let found = phasors[&[e, a, r, o, 0, 0, k][..]];
                    assert!((found - expected).norm() < 1e-10, "{quantity:?} {hold:?} {place:?}");
                }
            }
        }
    }
}

#[test]
fn few_orders_of_fired_sweeps_leave_out_no_more_than_their_bound() {
    let (rtol, rpm) = (5e-3, 300.0);
    let chosen = |engine: Engine, axes: &SweepAxes, torque: bool| {
        let engines = vec![Arc::new(engine)];
        Sweep::new(engines, axes.clone(), &Orders::Auto { rtol }, None, torque, &Cancel::new())
            .unwrap()
    };
    let one = SweepAxes { rpm: vec![rpm], ..SweepAxes::default() };
    let twice = SweepAxes { pin_offset: Some(vec![0.0; 2]), ..one.clone() };
    let ratios = SweepAxes { rod_ratio: Some(vec![0.2, 0.3, 0.25]), ..one.clone() };
    // Of one cylinder's torque, and of the scale of the torque of its masses over ω².
    let largest = (0..720).map(|k| derived(f64::from(k)).abs()).fold(0.0, f64::max);
    let square = (rpm * TAU / 60.0).powi(2);
    let most = rtol * (largest + 0.5 * RADIUS * RADIUS * square);
    // A point that is there twice loses as much as alone.
    let [alone, both] = [&one, &twice].map(|axes| chosen(fired_vee(VEE), axes, true));
    assert_eq!(alone.orders(), both.orders());
    let [alone, both] = [alone, both].map(|sweep| sweep.error_bound().torque);
    assert!((alone - both).abs() < 1e-3 * alone, "{alone} {both}");
    for axes in [&one, &twice, &ratios] {
        let sweep = chosen(fired_vee(VEE), axes, true);
        let bound = sweep.error_bound().torque;
        assert!(bound > 0.0 && bound < 1.05 * most, "{bound} of {most}");
        let left_out: Vec<Order> =
            halves(1..384).into_iter().filter(|order| !sweep.orders().contains(order)).collect();
        for ratio in axes.rod_ratio.as_deref().unwrap_or(&VEE[..1]) {
            let request = Request { rpm, reference_z: None, torque: true };
            let engine = fired_vee([*ratio, 0.0]);
            let orders = Orders::Given(left_out.clone());
            let balance = balance(&engine, &request, &orders, &Cancel::new()).unwrap();
            let lost = (0..left_out.len()).fold([0.0; 2], |[roll, crank], k| {
                let torque = balance.torque(Part::Whole, k);
                [roll + torque.roll.norm(), crank + torque.crank.norm()]
            });
            assert!(lost[0].max(lost[1]) <= bound * (1.0 + 1e-9), "{lost:?} of {bound}");
        }
    }
    // Without torque pressure does not count.
    let [fired, other] = [fired_vee(VEE), unfired(&fired_vee(VEE))]
        .map(|engine| chosen(engine, &ratios, false).orders().to_vec());
    assert_eq!(fired, other);
}

#[test]
fn waveforms_of_a_fired_sweep_have_its_means() {
    let (ratios, cancel) = ([0.25, 0.3], Cancel::new());
    let degrees: Vec<f64> = (0..72).map(|k| 10.0 * f64::from(k)).collect();
    let angles = CrankAngles::new(&degrees).unwrap();
    let rod_ratio = Some(ratios.to_vec());
    let axes = SweepAxes { rod_ratio, rpm: vec![1000.0], ..SweepAxes::default() };
    let orders = halves([1, 2, 3, 4, 9].into_iter());
    let sweep = Sweep::new(
        vec![Arc::new(fired_vee(VEE))],
        axes,
        &Orders::Given(orders),
        None,
        true,
        &cancel,
    )
    .unwrap();
    for on_crank in [false, true] {
        let whole = Part::Whole;
        let quantity = if on_crank {
            Quantity::CRANK_TORQUE.part(whole)
        } else {
            Quantity::TORQUE.part(whole)
        };
        let means = sweep.peaks(quantity, Statistic::Mean, &cancel).unwrap();
        let [by_orders, exact] = [false, true].map(|exact| {
            let mut out = vec![f64::NAN; 2 * degrees.len()];
            sweep.waveforms(quantity, &angles, exact, &mut out, &cancel).unwrap();
            out
        });
        for (k, (mean, ratio)) in means.iter().zip(ratios).enumerate() {
            let row = k * degrees.len()..(k + 1) * degrees.len();
            // Over two turns every order of a few sums to nothing.
            let average = by_orders[row.clone()].iter().sum::<f64>() / degrees.len() as f64;
            assert!((average - mean).abs() < 1e-10 && mean.abs() > 1.0, "{average} {mean}");
            let engine = fired_vee([ratio, 0.0]);
            let request = Request { rpm: 1000.0, reference_z: None, torque: true };
            let wave = waveform::exact(&engine, &request, &degrees, &cancel).unwrap();
            let torque = if on_crank { wave.crank_torque } else { wave.torque }.unwrap();
            for (found, expected) in exact[row].iter().zip(&torque) {
                assert!((found - expected).abs() < 1e-10, "{found} {expected}");
            }
        }
    }
}

// --- both faces of a piston ---

fn bored(cylinder: Cylinder, tdc: f64, strokes: u32) -> Engine {
    let place = Station {
        cylinder,
        tdc: angle(tdc),
        bank: Angle::QUARTER_TURN,
        z: 0.0,
        rotating_mass: 0.0,
    };
    let known = Details { bore: Some(BORE), ..Details::default() };
    let engine = Engine::new("", "", vec![place]).and_then(|e| e.with_details(vec![known]));
    engine.and_then(|e| e.firing_as("", Strokes::from_number(strokes)?)).unwrap()
}

/// With cycles at the head end and the crank end, where it has them.
fn acted_on(engine: &Engine, head: Option<Arc<Cycle>>, end: Option<(Arc<Cycle>, f64)>) -> Engine {
    let cycle_of = vec![head.as_ref().map(|_| 0)];
    let index = head.iter().count();
    let crank_end = end.as_ref().map(|(_, d)| CrankEnd { cycle: index, rod_diameter: *d });
    let cycles = head.into_iter().chain(end.map(|(cycle, _)| cycle)).collect();
    let (crank_ends, later) = (vec![crank_end], vec![false]);
    engine.with_gas(Gas { cycles, cycle_of, crank_ends, crankcase: CRANKCASE, later }).unwrap()
}

fn crank_torque(engine: &Engine, theta_deg: &[f64]) -> Vec<f64> {
    let request = Request { rpm: 0.0, reference_z: None, torque: true };
    let wave = waveform::exact(engine, &request, theta_deg, &Cancel::new()).unwrap();
    let [_, crank] = wave.parts.into_iter().next().unwrap().torque.unwrap();
    crank.to_vec()
}

fn gas_mean(engine: &Engine) -> f64 {
    let request = Request { rpm: 0.0, reference_z: None, torque: true };
    let orders = Orders::Given(vec![Order::FIRST]);
    balance(engine, &request, &orders, &Cancel::new()).unwrap().mean(Part::GAS)[1]
}

#[test]
fn pressure_on_both_faces_does_the_work_of_both_volumes() {
    let other = |degrees: f64| 2e5 + 1e6 * (6.0 * (degrees.to_radians().cos() - 1.0)).exp();
    for (offset, strokes, rod) in
        [(0.0, 2, 0.0), (0.006, 2, 0.03), (-0.006, 4, 0.03), (0.0, 4, BORE)]
    {
        let bare = bored(Cylinder::new(RADIUS, ROD, 0.5, offset).unwrap(), 30.0, strokes);
        let ends = [cycle(strokes), cycle_of(strokes, other)];
        let both = acted_on(&bare, Some(Arc::clone(&ends[0])), Some((Arc::clone(&ends[1]), rod)));
        let height = |θ: f64| {
            let (sin, cos) = (θ - 30.0).to_radians().sin_cos();
            RADIUS * cos + (ROD * ROD - (RADIUS * sin - offset).powi(2)).sqrt()
        };
        let lowest =
            (0..3600).map(|k| 0.1 * f64::from(k)).min_by(|a, b| height(*a).total_cmp(&height(*b)));
        let begins = both.pressures(0)[1].phase.degrees().rem_euclid(360.0);
        assert!((begins - lowest.unwrap()).abs() < 0.06, "{begins} {lowest:?}");
        let area = |diameter: f64| 0.25 * PI * diameter * diameter;
        let degrees: Vec<f64> = (0..80).map(|k| 9.0 * f64::from(k)).collect();
        let torque = crank_torque(&both, &degrees);
        for (k, θ) in degrees.iter().enumerate() {
            let slope = (height(θ + 1e-3) - height(θ - 1e-3)) / 2e-3_f64.to_radians();
            let within = |after: f64| after.rem_euclid(180.0 * f64::from(strokes));
            let head = (pressure(within(θ - 30.0)) - CRANKCASE) * area(BORE);
            let end = (other(within(θ - begins)) - CRANKCASE) * (area(BORE) - area(rod));
            // A table of whole degrees, and a difference quotient: 1e-6 of some 500 N·m.
            assert!((torque[k] + (head - end) * slope).abs() < 2e-3, "{offset} {strokes} {θ}");
        }
        let [head, end] = [
            acted_on(&bare, Some(Arc::clone(&ends[0])), None),
            acted_on(&bare, None, Some((Arc::clone(&ends[1]), rod))),
        ];
        assert!((gas_mean(&both) - gas_mean(&head) - gas_mean(&end)).abs() < 1e-10);
        if rod == BORE {
            assert_eq!(torque, crank_torque(&head, &degrees));
            assert_eq!(gas_mean(&end), 0.0);
        }
        let text = file::to_toml(&both).unwrap();
        assert_eq!(file::from_toml(&text).unwrap(), both, "{text}");
    }
}

#[test]
fn the_inner_face_of_a_yoke_is_the_outer_one_of_its_mirror_image() {
    let yoke = Cylinder::new(RADIUS, f64::INFINITY, 0.5, 0.0).unwrap();
    let degrees: Vec<f64> = (0..72).map(|k| 5.0 * f64::from(k)).collect();
    let inner = acted_on(&bored(yoke, 30.0, 2), None, Some((cycle(2), 0.0)));
    let outer = acted_on(&bored(yoke, 210.0, 2), Some(cycle(2)), None);
    for (one, other) in crank_torque(&inner, &degrees).iter().zip(crank_torque(&outer, &degrees)) {
        // Torques of some 500 N·m.
        assert!((one - other).abs() < 1e-10, "{one} {other}");
    }
    // Equal cycles at both ends: the mean of two.
    let both = acted_on(&bored(yoke, 30.0, 2), Some(cycle(2)), Some((cycle(2), 0.0)));
    assert!((gas_mean(&both) - 2.0 * gas_mean(&outer)).abs() < 1e-10);
}

#[test]
fn crank_ends_that_cannot_be_are_named() {
    let bare = bored(Cylinder::new(RADIUS, ROD, 0.5, 0.0).unwrap(), 0.0, 4);
    let error = |engine: &Engine, index: usize, rod_diameter: f64| {
        let crank_ends = vec![Some(CrankEnd { cycle: index, rod_diameter })];
        let (cycles, cycle_of, later) = (vec![cycle(4)], vec![None], vec![false]);
        let gas = Gas { cycles, cycle_of, crank_ends, crankcase: CRANKCASE, later };
        engine.with_gas(gas).unwrap_err().to_string()
    };
    assert!(error(&bare, 1, 0.0).starts_with("crank_end[0] = 1"));
    for diameter in [-0.01, 1.01 * BORE, f64::NAN] {
        assert!(error(&bare, 0, diameter).starts_with("rod_diameter[0]"));
    }
    let dummy = Details { bore: Some(BORE), dummy: true, ..Details::default() };
    assert!(error(&bare.with_details(vec![dummy]).unwrap(), 0, 0.0).contains("dummy"));
    // Where the piston is lowest depends on rod and offset: swept pressure there would be another.
    let offset = bored(Cylinder::new(RADIUS, ROD, 0.5, 0.004).unwrap(), 0.0, 4);
    let axes = |engine: Engine| {
        let engine = Arc::new(acted_on(&engine, None, Some((cycle(4), 0.01))));
        let rod_ratio = Some(vec![0.2, 0.3]);
        let ratios = SweepAxes { rod_ratio, rpm: vec![1000.0], ..SweepAxes::default() };
        let orders = Orders::Given(vec![Order::FIRST]);
        Sweep::new(vec![engine], ratios, &orders, None, true, &Cancel::new()).map(|_| ())
    };
    assert!(axes(bare).is_ok());
    let error = axes(offset).unwrap_err().to_string();
    assert!(error.contains("the chamber at the crank end of cylinder 1"), "{error}");
}
