//! Is an engine of several cranks the sum of its parts, each in its own place, time and sense?

mod common;

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use common::angle;
use common::random::{angles, engines, weighted};
use crankpin_core::balance::{Orders, Request, balance};
use crankpin_core::engine::layout::Strokes;
use crankpin_core::engine::{CrankIndex, Details, EngineOnCrank};
use crankpin_core::pressure::Given;
use crankpin_core::quantity::Part;
use crankpin_core::waveform::{Waveform, exact};
use crankpin_core::{
    Angle, Cancel, Complex64, Crank, Cycle, Cylinder, Engine, Firing, Hold, Order, SpeedRatio,
    Station, Unbalance,
};
use proptest::prelude::*;
use proptest::sample::select;

const RPM: f64 = 3000.0;

fn on(engine: &Engine, crank: Crank) -> EngineOnCrank<'_> {
    EngineOnCrank { engine, crank, delay: Angle::ZERO, tilt: Angle::ZERO, z: 0.0 }
}

fn wave(engine: &Engine, reference_z: f64, degrees: &[f64]) -> Waveform {
    let request = Request { rpm: RPM, reference_z: Some(reference_z), torque: true };
    exact(engine, &request, degrees, &Cancel::new()).unwrap()
}

fn planar(wave: &Waveform, i: usize) -> [Complex64; 2] {
    [&wave.force, &wave.moment].map(|row| Complex64::new(row[[i, 0]], row[[i, 1]]))
}

/// The engine that stands behind the first one, alone: without its shafts' and cranks' roll.
fn parts() -> impl Strategy<Value = Engine> {
    weighted(engines(true))
}

/// Sums of some twenty terms, of which each is good to an ulp or two, at angles of several turns.
const ROUNDING: f64 = 1e-11;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// The same engine, tilted, delayed and moved along: its forces are turned, later and at longer levers;
    /// turning backwards, they are those at the opposite angle.
    #[test]
    fn forces_and_moments_add(
        first in parts(),
        second in parts(),
        [delay, tilt] in [angles(), angles()],
        axis in [-0.5..0.5, -0.5..0.5],
        is_forward in any::<bool>(),
        z in select(vec![0.0, 0.3]),
    ) {
        let crank = Crank { axis, ratio: SpeedRatio::whole(if is_forward { 1 } else { -1 }) };
        let part = EngineOnCrank { engine: &second, crank, delay, tilt, z };
        let whole = Engine::on_cranks(&[on(&first, Crank::MAIN), part], Hold::Pins).unwrap();
        let degrees: Vec<f64> = (0..13).map(|k| 59.0 * f64::from(k)).collect();
        let own = |θ: f64| (θ - delay.degrees()) * if is_forward { 1.0 } else { -1.0 };
        let own: Vec<f64> = degrees.iter().map(|&θ| own(θ)).collect();
        let [whole, first, second] =
            [wave(&whole, 0.1, &degrees), wave(&first, 0.1, &degrees), wave(&second, 0.1 - z, &own)];
        for i in 0..degrees.len() {
            let [both, one, other] = [&whole, &first, &second].map(|wave| planar(wave, i));
            for k in 0..2 {
                let expected = one[k] + other[k] * tilt.cis(1);
                let size = one[k].norm() + other[k].norm() + 1e3;
                prop_assert!((both[k] - expected).norm() < ROUNDING * size);
            }
            // About the main crank, with the lever of the other one's axis.
            let [both, first, second] = [&whole, &first, &second]
                .map(|wave| wave.torque.as_ref().map_or(f64::NAN, |torque| torque[i]));
            let force = other[0] * tilt.cis(1);
            let lever = axis[0] * force.im - axis[1] * force.re;
            let size = first.abs() + second.abs() + lever.abs() + other[0].norm() + 1e3;
            prop_assert!((both - first - second - lever).abs() < ROUNDING * size);
        }
    }

    /// One engine is itself, to the last bit; turned backwards twice, but for the rounding of angles.
    #[test]
    fn one_engine_is_itself(engine in parts()) {
        let alone = Engine::on_cranks(&[on(&engine, Crank::MAIN)], Hold::Pins).unwrap();
        prop_assert_eq!(alone.stations(), engine.stations());
        prop_assert_eq!(alone.counterweights(), engine.counterweights());
        prop_assert_eq!(alone.shafts(), engine.shafts());
        let against = Crank { axis: [0.2, 0.0], ratio: SpeedRatio::whole(-1) };
        let pair = |engine: &Engine| {
            Engine::on_cranks(&[on(engine, Crank::MAIN), on(engine, against)], Hold::Pins).unwrap()
        };
        let twice = pair(&engine);
        for i in 0..engine.stations().len() {
            let backwards = i + engine.stations().len();
            prop_assert!(twice.pin(backwards).is_direction_of(engine.pin(i)));
        }
    }

    /// With the firing held each piston is where it was at every crank angle, and the crankpin at its mirror image.
    #[test]
    fn held_firing_mirrors_crankpins_at_their_bores(engine in engines(true)) {
        let against = Crank { axis: [0.2, 0.0], ratio: SpeedRatio::whole(-1) };
        let pair = [on(&engine, Crank::MAIN), on(&engine, against)];
        let pair = Engine::on_cranks(&pair, Hold::Firing).unwrap();
        let count = engine.stations().len();
        for (i, station) in engine.stations().iter().enumerate() {
            prop_assert_eq!(pair.stations()[i + count], *station);
            let image = station.bank + station.bank - engine.pin(i);
            prop_assert!(pair.pin(i + count).is_direction_of(image));
        }
    }
}

// --- chambers ---

const BORE: f64 = 0.08;
const CRANKCASE: f64 = 1e5;

fn pressure(degrees: f64) -> f64 {
    1e5 + 3e6 * (8.0 * ((0.5 * (degrees - 14.0)).to_radians().cos() - 1.0)).exp()
}

/// Of Chebyshev polynomials, which follow the pressure to rounding.
fn cycle(strokes: u32) -> Arc<Cycle> {
    const DEGREE: u32 = 15;
    let (mut theta_deg, mut values) = (Vec::new(), Vec::new());
    for panel in 0..36 * strokes / 2 {
        for k in 0..=DEGREE {
            let place = -(PI * f64::from(k) / f64::from(DEGREE)).cos();
            let angle = 10.0 * f64::from(panel) + 5.0 + 5.0 * place;
            theta_deg.push(angle);
            values.push(pressure(angle));
        }
    }
    let given =
        Given { name: String::new(), strokes, theta_deg, pressure: values, degree: Some(15) };
    Arc::new(Cycle::new(given).unwrap())
}

/// One bore with two pistons, the upper one `lead` degrees ahead.
fn opposed(lead: f64, ratio: i32, lower: Cylinder, upper: Cylinder, strokes: Strokes) -> Engine {
    let single = |cylinder| {
        let tdc = angle(40.0);
        let place =
            Station { cylinder, tdc, bank: Angle::QUARTER_TURN, z: 0.0, rotating_mass: 0.0 };
        let known = Details { bore: Some(BORE), ..Details::default() };
        let engine = Engine::new("", "", vec![place]).unwrap().with_details(vec![known]).unwrap();
        engine.firing_as("", strokes).unwrap()
    };
    let [lower, upper] = [lower, upper].map(single);
    let above = EngineOnCrank {
        delay: angle(-lead),
        tilt: Angle::HALF_TURN,
        ..on(&upper, Crank { axis: [0.0, 0.9], ratio: SpeedRatio::whole(ratio) })
    };
    Engine::on_cranks(&[on(&lower, Crank::MAIN), above], Hold::Firing).unwrap()
}

/// The same on one crank: side rods drive the upper piston, whose crankpin stands opposite but for the lead.
fn on_one_crank(lead: f64, lower: Cylinder, upper: Cylinder, strokes: Strokes) -> Engine {
    let place = |cylinder, tdc| {
        let bank = Angle::QUARTER_TURN;
        Station { cylinder, tdc: angle(tdc), bank, z: 0.0, rotating_mass: 0.0 }
    };
    let known = |side_rods| Details { bore: Some(BORE), side_rods, ..Details::default() };
    Engine::new("", "", vec![place(lower, 40.0), place(upper, 220.0 - lead)])
        .and_then(|engine| engine.with_details(vec![known(false), known(true)]))
        .and_then(|engine| engine.firing_as("", strokes))
        .unwrap()
}

/// Volume of a chamber, but for a constant, and the angle at which it is smallest.
fn volume(engine: &Engine, degrees: f64) -> f64 {
    let down = |(place, details): (&Station, &Details)| {
        let gear = &place.cylinder;
        let (sin, cos) = (degrees - place.tdc.degrees()).to_radians().sin_cos();
        let (r, l, e) = (gear.crank_radius(), gear.rod_length(), gear.pin_offset());
        let height = r * cos + (l * l - (r * sin - e).powi(2)).sqrt();
        if details.side_rods { height } else { -height }
    };
    let pistons = engine.stations().iter().zip(engine.details());
    0.25 * PI * BORE * BORE * pistons.map(down).sum::<f64>()
}

fn cylinder(radius: f64, rod: f64, offset: f64) -> Cylinder {
    Cylinder::new(radius, rod, 0.5, offset).unwrap()
}

#[test]
fn a_shared_chamber_fires_once_where_it_is_smallest_and_does_its_work() {
    let usual = cylinder(0.04, 0.13, 0.0);
    for upper in [usual, cylinder(0.03, 0.13, 0.0), cylinder(0.04, 0.16, 0.005)] {
        for (lead, ratio) in [(0.0, 1), (20.0, -1), (-35.0, 1), (90.0, -1), (0.0, 0), (20.0, 0)] {
            for strokes in [Strokes::Two, Strokes::Four] {
                let engine = Arc::new(match ratio {
                    0 => on_one_crank(lead, usual, upper, strokes),
                    _ => opposed(lead, ratio, usual, upper, strokes),
                });
                let firing = Firing::all(&engine, strokes, &Cancel::new()).unwrap();
                assert_eq!((firing.len(), firing[0].to_string().as_str()), (1, "1"));
                let fires = firing[0].angles()[0].degrees();
                let least = volume(&engine, fires);
                // A minimum is flat: a thousandth of a degree on each side is higher by 1e-10 of the bore.
                for beside in (1..720).map(|k| fires + 0.5 * f64::from(k)) {
                    assert!(volume(&engine, beside) > least - 1e-15, "{lead} {ratio} {beside}");
                }
                let later = firing[0].fires_in_second_turn();
                let fired = engine.fired_by(cycle(strokes.number()), later).unwrap();
                let request = Request { rpm: RPM, reference_z: None, torque: true };
                let orders = Orders::Given(vec![Order::FIRST]);
                let mean = balance(&fired, &request, &orders, &Cancel::new()).unwrap();
                let [_, mean] = mean.mean(Part::GAS);
                // ∮ p dV by the trapezoidal rule, exact for what repeats.
                let samples = 7200 * strokes.turns() as usize;
                let at = |k: usize| fires + 0.05 * k as f64;
                let work = (0..samples).map(|k| {
                    let (p, step) = (pressure(at(k) - fires) - CRANKCASE, 0.05);
                    p * (volume(&engine, at(k) + 0.5 * step) - volume(&engine, at(k) - 0.5 * step))
                });
                let expected = work.sum::<f64>() / (TAU * strokes.turns() as f64);
                // The crankcase's share of a closed loop is nothing; central differences are good to 1e-7.
                assert!(
                    (mean - expected).abs() < 1e-5 * expected.abs().max(1.0),
                    "{mean} {expected}"
                );
            }
        }
    }
}

#[test]
fn what_a_shared_chamber_cannot_do_is_named() {
    let usual = cylinder(0.04, 0.13, 0.0);
    let error = |lead: f64, later: Vec<bool>| {
        let engine = opposed(lead, 1, usual, usual, Strokes::Four);
        engine.fired_by(cycle(4), later).unwrap_err().to_string()
    };
    assert!(error(120.0, vec![false; 2]).contains("at most 90° apart; these are 120°"));
    assert!(error(20.0, vec![false, true]).contains("fires once"));
    // Pistons that fire apart, until their cranks stand opposite.
    let beside = opposed(20.0, 1, usual, usual, Strokes::Four);
    let own = beside.cranks().iter().copied().collect::<Vec<_>>();
    let away = Crank { axis: [0.0, -0.9], ..own[1] };
    let away = beside.with_cranks(vec![own[0], away], vec![0, 1]).unwrap();
    let fired = away.fired_by(cycle(4), vec![false, true]).unwrap();
    let error = fired.with_cranks(own, vec![0, 1]).unwrap_err().to_string();
    assert!(error.contains("fires once"), "{error}");
    let engine = opposed(20.0, 1, usual, usual, Strokes::Two);
    assert_eq!(engine.shared_chambers().len(), 1);
    let order = "1-2".parse().unwrap();
    let error = Firing::named(&Arc::new(engine), &order, Strokes::Two, &Cancel::new());
    let error = error.unwrap_err().to_string();
    assert!(error.contains("2 shares the chamber of 1, which fires once"), "{error}");
}

#[test]
fn parts_that_the_whole_engine_must_have_are_rejected_by_name() {
    let usual = cylinder(0.04, 0.13, 0.0);
    let place = Station {
        cylinder: usual,
        tdc: Angle::ZERO,
        bank: angle(90.0),
        z: 0.0,
        rotating_mass: 0.0,
    };
    let single = Engine::new("", "", vec![place]).unwrap();
    let against = Crank { axis: [0.2, 0.0], ratio: SpeedRatio::whole(-1) };
    let error = |second: &Engine, crank: Crank| {
        let parts = [on(&single, Crank::MAIN), on(second, crank)];
        Engine::on_cranks(&parts, Hold::Firing).unwrap_err().to_string()
    };
    let weight =
        Unbalance { amount: 0.01, angle: Angle::ZERO, z: 0.0, pin: None, crank: CrankIndex::MAIN };
    let weighted = single.with_counterweights(vec![weight]).unwrap();
    assert!(error(&weighted, against).starts_with("engines[1].counterweights or shafts"));
    let two_stroke = single.firing_as("", Strokes::Two).unwrap();
    assert!(error(&two_stroke, against).starts_with("engines[1].strokes = 2"));
    let nowhere = Crank { ratio: SpeedRatio::whole(0), ..against };
    assert!(error(&single, nowhere).starts_with("cranks[1].ratio = 0"));
    assert!(Engine::on_cranks(&[], Hold::Pins).is_err());
}

#[test]
fn one_crank_carries_the_pistons_of_a_chamber_without_loading_its_bearings() {
    use crankpin_core::bearing_loads::BearingLoadsModel;
    // Infinite rods, equal throws: what pushes one piston down pulls the other up, at every crank angle.
    let yoke = cylinder(0.04, f64::INFINITY, 0.0);
    let engine = on_one_crank(0.0, yoke, yoke, Strokes::Two);
    let fired = engine.fired_by(cycle(2), vec![false; 2]).unwrap();
    let degrees: Vec<f64> = (0..36).map(|k| 10.0 * f64::from(k)).collect();
    let loads = |engine: &Engine| {
        let model = BearingLoadsModel::new(engine, RPM).unwrap();
        model.loads(&degrees, &Cancel::new()).unwrap()
    };
    let (with, without) = (loads(&fired), loads(&engine));
    let crankcase = fired.gas().unwrap().crankcase;
    for (k, &θ) in degrees.iter().enumerate() {
        let force = 0.25 * PI * BORE * BORE * (pressure((θ - 40.0).rem_euclid(360.0)) - crankcase);
        // Forces of 1.5·10⁴ N.
        let [lower, upper] = [0, 1].map(|i| with.gas[[i, k]]);
        assert!(
            (lower - force).abs() < 1e-6 && (lower + upper).abs() < 1e-6,
            "{θ} {lower} {upper} {force}"
        );
        for main in 0..with.main.dim().0 {
            assert!((with.main[[main, k, 1]] - without.main[[main, k, 1]]).abs() < 1e-8, "{θ}");
        }
    }
}

/// Three cranks at the corners of a triangle, the lowest one turning backwards, each bore between two of them.
#[test]
fn three_cranks_share_three_chambers_that_fire_forty_degrees_apart() {
    // A corner that was typed to micrometres.
    let corners = [[0.0, 0.0], [0.89, 0.0], [0.445, -0.770_763]];
    let cranks = corners.map(|axis| Crank { axis, ratio: SpeedRatio::ONE });
    let cranks = [cranks[0], cranks[1], Crank { ratio: SpeedRatio::whole(-1), ..cranks[2] }];
    // Crank, bore and top dead centre of the later piston of each bore, then of the one that leads by 20°.
    let pistons = [
        (0, 0.0, 0.0),
        (1, 240.0, 40.0),
        (2, 120.0, 320.0),
        (1, 180.0, 340.0),
        (2, 60.0, 20.0),
        (0, 300.0, 300.0),
    ];
    let place = |&(_, bank, tdc): &(usize, f64, f64)| Station {
        cylinder: cylinder(0.092, 0.3, 0.0),
        tdc: angle(tdc),
        bank: angle(bank),
        z: 0.0,
        rotating_mass: 0.0,
    };
    let engine = Engine::new("", "", pistons.iter().map(place).collect())
        .and_then(|e| e.with_cranks(cranks.to_vec(), pistons.map(|piston| piston.0).to_vec()))
        .unwrap();
    assert_eq!(engine.chambers(), [[0, 3], [1, 4], [2, 5]]);
    // One crankpin for the two pistons of each crank.
    assert_eq!(engine.crankpins().len(), 3);
    let firing = Firing::all(&Arc::new(engine), Strokes::Two, &Cancel::new()).unwrap();
    let angles: Vec<f64> = firing[0].angles().iter().take(3).map(|a| a.degrees()).collect();
    assert_eq!(angles, [350.0, 30.0, 310.0]);
}
