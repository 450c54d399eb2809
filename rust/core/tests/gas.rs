//! Gas pressure in engines: what a second crank makes of it, phases of firing in files, and refusals.

mod common;

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use common::angle;
use crankpin_core::balance::{Balance, Orders, Request, TorquePart, balance};
use crankpin_core::engine::layout::Strokes;
use crankpin_core::engine::{Details, Gas, file};
use crankpin_core::pressure::Given;
use crankpin_core::{
    Angle, Cancel, Complex64, Crank, Cycle, Cylinder, Engine, Order, Station, waveform,
};

const BORE: f64 = 0.08;
const RADIUS: f64 = 0.04;
const ROD: f64 = 0.13;
const CRANKCASE: f64 = 1e5;

fn pressure(degrees: f64) -> f64 {
    1e5 + 3e6 * (8.0 * ((0.5 * (degrees - 14.0)).to_radians().cos() - 1.0)).exp()
}

fn cycle(strokes: u32) -> Arc<Cycle> {
    let theta_deg: Vec<f64> = (0..180 * strokes).map(f64::from).collect();
    let pressure = theta_deg.iter().map(|&θ| pressure(θ)).collect();
    let given = Given { name: String::new(), strokes, theta_deg, pressure, degree: None };
    Arc::new(Cycle::new(given).unwrap())
}

/// Two upright cylinders on cranks of these ratios, 0.2 m apart.
fn twin(ratios: [i32; 2]) -> Engine {
    let cylinder = Cylinder::new(RADIUS, ROD, 0.5, 0.0).unwrap();
    let place = Station {
        cylinder,
        tdc: angle(30.0),
        bank: Angle::QUARTER_TURN,
        z: 0.0,
        rotating_mass: 0.0,
    };
    let cranks = ratios.map(|ratio| Crank { axis: [0.2 * f64::from(1 - ratio), 0.0], ratio });
    let known = Details { bore: Some(BORE), ..Details::default() };
    let engine = Engine::new("", "", vec![place; 2]).unwrap().with_details(vec![known; 2]).unwrap();
    if ratios == [1, 1] {
        return engine;
    }
    engine.with_cranks(cranks.to_vec(), vec![0, 1]).unwrap()
}

/// The second fires a turn after the first.
fn gas(cycles: Vec<Arc<Cycle>>, cycle_of: [Option<usize>; 2]) -> Gas {
    Gas { cycles, cycle_of: cycle_of.to_vec(), crankcase: CRANKCASE, later: vec![false, true] }
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
        let [block, crank] =
            waveform::exact(&engine, &request, &theta_deg, &Cancel::new()).unwrap().gas.unwrap();
        for (k, θ) in theta_deg.iter().enumerate() {
            let [one, other] = [derived(θ - 30.0), derived(θ - 390.0)];
            // Cubics at steps of a degree, and a difference quotient: 1e-6 of some 500 N·m.
            assert!((crank[k] - (one + other)).abs() < 1e-3, "{ratios:?} {θ}");
            assert!((block[k] + (one + sense * other)).abs() < 1e-3, "{ratios:?} {θ}");
        }
        let balance = of_all(&engine);
        for (k, θ) in theta_deg.iter().enumerate() {
            let gas = (0..balance.orders.len()).map(|n| balance.torque(TorquePart::Gas, n));
            let at = |order: Order| Complex64::from_polar(1.0, order.number() * θ.to_radians());
            let mut sums = balance.mean(TorquePart::Gas);
            for (gas, order) in gas.zip(&balance.orders) {
                sums[0] += (gas.roll * at(*order)).re;
                sums[1] += (gas.crank * at(*order)).re;
            }
            // Roundings of sums of some 100 N·m.
            let within = balance.error_bound[2] + 1e-11;
            assert!((sums[0] - block[k]).abs() < within, "{ratios:?} {θ}");
            assert!((sums[1] - crank[k]).abs() < within, "{ratios:?} {θ}");
        }
        let [on_block, on_crank] = balance.mean(TorquePart::Whole);
        assert!(on_crank > 10.0);
        assert!((on_block + 0.5 * (1.0 + sense) * on_crank).abs() < 1e-12 * on_crank);
        assert_eq!(balance.mean(TorquePart::Inertia), [0.0; 2]);
    }
    // Equal pressures half a period apart: on the crank whole orders, on the block the others.
    let balance = of_all(&fired([1, -1]));
    for (k, order) in balance.orders.iter().enumerate() {
        let gas = balance.torque(TorquePart::Gas, k);
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
    let geared = vec![Crank::MAIN, Crank { axis: [0.1, 0.0], ratio: -3 }];
    assert!(engine.with_cranks(geared, vec![0, 1]).is_err());
    // Without any cycle there is nothing to refuse, and nothing is kept.
    assert_eq!(twin([1, 1]).with_gas(gas(vec![cycle(4)], [None; 2])).unwrap(), twin([1, 1]));
    assert!(engine.firing_as("", Strokes::Two).is_err());
    assert!(engine.firing_as("1-2", Strokes::Four).is_ok());
}
