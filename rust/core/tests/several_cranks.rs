//! Laws of engines with several cranks, random ones.

mod common;

use std::sync::Arc;

use common::random::{angles, cylinders, weighted};
use common::{InArrays, angle};
use crankpin_core::balance::{Balance, ErrorBounds, Request, Vector};
use crankpin_core::engine::{
    ActsOn, Amplitudes, CrankEnd, CrankIndex, Details, Gas, Origin, OverSpeed, PeriodicLoad,
};
use crankpin_core::exact::vanishing::{ProofQuantity, QUANTITIES, Verdict, vanishing};
use crankpin_core::flywheel::{CrankDrive, CycleGrid, FlywheelTarget};
use crankpin_core::index::ListIndex;
use crankpin_core::pressure::Given;
use crankpin_core::quantity::{Kind, Part, Quantity};
use crankpin_core::sweep::{Statistic, SweepAxes};
use crankpin_core::{
    Cancel, Complex64, Crank, Cycle, Cylinder, Engine, Order, Orders, Shaft, Spectrum, SpeedRatio,
    Station, Sweep, Unbalance, balance, terms, waveform,
};
use proptest::prelude::*;
use proptest::sample::select;

const REQUEST: Request = Request { rpm: 3000.0, reference_z: Some(0.07), torque: true };

fn orders() -> Vec<Order> {
    Order::all_whole(&[1, 2, 3, 4, 6]).unwrap()
}

fn of(engine: &Engine) -> Balance {
    balance::balance(engine, &REQUEST, &Orders::Given(orders()), &Cancel::new()).unwrap()
}

/// Cylinders on one to three cranks of either sense, some of them without cylinders.
fn engines() -> impl Strategy<Value = Engine> {
    let crank = (select(vec![1, -1, 2, -2]), [-0.3..0.3, -0.3..0.3]);
    let crank = crank.prop_map(|(ratio, axis)| Crank { axis, ratio: SpeedRatio::whole(ratio) });
    let place = (cylinders(true), angles(), angles(), -0.5..0.5, 0.0..2.0, 0_usize..3);
    let lists = (proptest::collection::vec(crank, 1..3), proptest::collection::vec(place, 1..7));
    lists.prop_map(|(others, places)| {
        let cranks: Vec<Crank> = std::iter::once(Crank::MAIN).chain(others).collect();
        let on = places.iter().map(|place| place.5 % cranks.len()).collect();
        let stations = places.into_iter().map(|(cylinder, tdc, bank, z, rotating_mass, _)| {
            Station { cylinder, tdc, bank, z, rotating_mass }
        });
        Engine::new("", "", stations.collect()).unwrap().with_cranks(cranks, on).unwrap()
    })
}

/// The same with pressure in some cylinders, and at some crank ends, of those on cranks as fast as the main one.
fn fired(engines: impl Strategy<Value = Engine>) -> impl Strategy<Value = Engine> {
    let theta_deg: Vec<f64> = (0..48).map(|k| 15.0 * f64::from(k)).collect();
    let at = |θ: &f64| 1e5 + 3e6 * (-0.02 * f64::abs(θ - 15.0)).exp();
    let pressure = theta_deg.iter().map(at).collect();
    let given = Given { name: String::new(), strokes: 4, theta_deg, pressure, degree: None };
    let cycle = Arc::new(Cycle::new(given).unwrap());
    let fires = proptest::collection::vec([any::<bool>(), any::<bool>(), any::<bool>()], 7);
    (engines, fires, select(vec![0.0, 0.03])).prop_map(move |(engine, fires, rod_diameter)| {
        let ratio = |i: usize| engine.cranks()[engine.crank_of(i)].ratio;
        let cylinders = 0..engine.stations().len();
        let cycle_of = |i: usize| (fires[i][0] && ratio(i).is_crank_speed()).then_some(0);
        let crank_end = |i: usize| {
            let acts = fires[i][2] && ratio(i).is_crank_speed();
            acts.then_some(CrankEnd { cycle: 0, rod_diameter })
        };
        let gas = Gas {
            cycles: vec![Arc::clone(&cycle)],
            cycle_of: cylinders.clone().map(cycle_of).collect(),
            crank_ends: cylinders.clone().map(crank_end).collect(),
            crankcase: 1e5,
            later: cylinders.clone().map(|i| fires[i][1]).collect(),
        };
        let bored = Details { bore: Some(0.08), ..Details::default() };
        engine.with_details(vec![bored; cylinders.len()]).and_then(|e| e.with_gas(gas)).unwrap()
    })
}

/// Phasors of an order: forward and backward of force and moment, roll and torque on the crank.
fn phasors(balance: &Balance, k: usize) -> [Complex64; 6] {
    let [force, moment] = [Vector::Force, Vector::Moment].map(|v| *balance.planar(v, k));
    let torque = balance.torque(Part::Whole, k);
    let turning = [force.forward, force.backward(), moment.forward, moment.backward()];
    let [a, b, c, d] = turning;
    [a, b, c, d, torque.roll, torque.crank]
}

/// Bounds of the rounding of the same.
fn bounds(balance: &Balance, k: usize) -> [f64; 6] {
    let [force, moment] = [Vector::Force, Vector::Moment].map(|v| balance.zero_bound(v, k));
    let [roll, crank] = balance.torque_zero_bounds(Part::Whole, k);
    [force, force, moment, moment, roll, crank]
}

#[test]
fn a_crankpin_points_along_its_bore_at_top_dead_centre_whichever_way_it_turns() {
    for (ratio, pin) in [(1, 60.0), (-1, 120.0), (2, 30.0), (-2, 150.0)] {
        let crank = Crank { axis: [0.1, 0.0], ratio: SpeedRatio::whole(ratio) };
        assert_eq!(crank.pin(angle(90.0), angle(30.0)), angle(pin), "{ratio}");
        assert_eq!(crank.tdc(angle(90.0), angle(pin)), angle(30.0), "{ratio}");
    }
}

#[test]
fn cylinders_on_two_cranks_share_no_crankpin_nor_throw() {
    let cylinder = Cylinder::new(0.04, 0.13, 0.6, 0.0).unwrap();
    let at = |bank: f64| Station {
        cylinder,
        tdc: angle(bank),
        bank: angle(bank),
        z: 0.0,
        rotating_mass: 0.0,
    };
    let engine = Engine::new("", "", vec![at(60.0), at(120.0)]).unwrap();
    let beside = Crank { axis: [0.2, 0.0], ratio: SpeedRatio::ONE };
    let apart = engine.with_cranks(vec![Crank::MAIN, beside], vec![0, 1]).unwrap();
    let pins = |engine: &Engine| -> Vec<(usize, Vec<usize>)> {
        engine
            .throws()
            .into_iter()
            .flatten()
            .map(|pin| (pin.crank.position(), pin.cylinders))
            .collect()
    };
    assert_eq!(pins(&engine), [(0, vec![0, 1])]);
    assert_eq!(pins(&apart), [(0, vec![0]), (1, vec![1])]);
    // Throws and bearings along the main crank are of what is on it.
    assert_eq!(apart.throw_places(CrankIndex::MAIN).len(), 1);
    assert_eq!(apart.throw_places(CrankIndex::MAIN)[0].cylinders, [0]);
    let none = engine.with_cranks(vec![Crank::MAIN, beside], vec![1, 1]).unwrap();
    assert!(
        none.throw_places(CrankIndex::MAIN).is_empty()
            && none.bearings(CrankIndex::MAIN).is_empty()
    );
}

#[test]
fn pistons_of_unlike_cranks_have_unlike_harmonics() {
    let at = |mass: f64, bank: f64| Station {
        cylinder: Cylinder::new(0.04, 0.13, mass, 0.0).unwrap(),
        tdc: angle(0.0),
        bank: angle(bank),
        z: 0.0,
        rotating_mass: 0.0,
    };
    let engine = Engine::new("", "", vec![at(1.0, 90.0), at(0.25, 270.0)]).unwrap();
    let twice = Crank { axis: [0.0, 0.2], ratio: SpeedRatio::whole(2) };
    let engine = engine.with_cranks(vec![Crank::MAIN, twice], vec![0, 1]).unwrap();
    // Order 2 is a₂ of the first and a₁ of the second, of one weight: they do not cancel.
    let second = [Order::whole(2).unwrap()];
    let found = vanishing(&engine, &second, None, None, &Cancel::new()).unwrap();
    let along_y = ProofQuantity::ForceY;
    let verdict = found.verdicts[0][along_y];
    assert!(verdict != Verdict::Vanishes && !found.within_rounding[0][along_y]);
    assert!(found.obstacles[0].contains("cranks of different speeds"), "{:?}", found.obstacles);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    #[test]
    fn a_mass_on_a_crankpin_pulls_along_it(engine in engines(), cylinder in 0_usize..6) {
        let cylinder = cylinder % engine.stations().len();
        let still: Vec<Station> =
            engine.stations().iter().map(|p| Station { rotating_mass: 0.0, ..*p }).collect();
        let on: Vec<usize> = (0..still.len()).map(|i| engine.crank_of(i).position()).collect();
        let still = Engine::new("", "", still).unwrap();
        let still = still.with_cranks(engine.cranks().to_vec(), on).unwrap();
        let weight = Unbalance { amount: 0.1, angle: angle(0.0), z: 0.0, pin: Some(cylinder), crank: CrankIndex::MAIN };
        let laden = still.with_counterweights(vec![weight]).unwrap();
        let ratio = engine.cranks()[engine.crank_of(cylinder)].ratio;
        let k = orders().iter().position(|o| Ok(*o) == ratio.order()).unwrap();
        let side = usize::from(!ratio.is_forward());
        let added = phasors(&of(&laden), k)[side] - phasors(&of(&still), k)[side];
        let square = (3000.0 * std::f64::consts::TAU / 60.0).powi(2) * ratio.number().powi(2);
        let expected = engine.pin(cylinder).cis(1) * 0.1 * square;
        let bound = bounds(&of(&laden), k)[0] + bounds(&of(&still), k)[0];
        prop_assert!((added - expected).norm() <= bound, "{added} {expected}");
    }

    #[test]
    fn pins_say_as_much_as_top_dead_centres(engine in engines()) {
        let pins: Vec<_> = (0..engine.stations().len()).map(|i| engine.pin(i)).collect();
        let again = engine.with_pins(&pins).unwrap();
        for (i, pin) in pins.iter().enumerate() {
            let ratio = engine.cranks()[engine.crank_of(i)].ratio.size();
            let apart = again.stations()[i].tdc.degrees() - engine.stations()[i].tdc.degrees();
            // Cranks twice as fast are at top dead centre twice a turn.
            let turns = apart * ratio / 360.0;
            prop_assert!((turns - turns.round()).abs() < 1e-12);
            prop_assert!((again.pin(i).degrees() - pin.degrees()).abs() < 1e-10);
        }
    }

    #[test]
    fn terms_add_up_to_the_balance_about_any_point(
        engine in fired(weighted(engines())), aside in [-0.5..0.5, -0.5..0.5]
    ) {
        let whole = of(&engine);
        let terms = terms::terms(&engine, &REQUEST, aside, &orders(), &Cancel::new()).unwrap();
        let count = engine.stations().len();
        prop_assert_eq!(terms[count - 1].0, Origin::Cylinder(count - 1));
        prop_assert_eq!(terms.len(), count + engine.counterweights().len() + engine.shafts().len());
        for on in [0, 1] {
            let means: Vec<f64> = terms.iter().map(|(_, t)| t.mean(Part::Whole)[on]).collect();
            let size: f64 = means.iter().map(|mean| mean.abs()).sum();
            let mean = whole.mean(Part::Whole)[on];
            // Roundings of a sum of seven terms.
            prop_assert!((means.iter().sum::<f64>() - mean).abs() <= 1e-14 * size);
        }
        for k in 0..orders().len() {
            let mut sums = [Complex64::default(); 6];
            let mut bound = bounds(&whole, k);
            for (_, term) in &terms {
                let both = phasors(term, k).into_iter().zip(bounds(term, k));
                for ((sum, bound), (phasor, own)) in sums.iter_mut().zip(&mut bound).zip(both) {
                    *sum += phasor;
                    *bound += own;
                }
            }
            let mut expected = phasors(&whole, k);
            expected[4] = whole.wrenches[k].moved([aside[0], aside[1], 0.0]).torque.roll;
            for ((sum, expected), bound) in sums.into_iter().zip(expected).zip(bound) {
                prop_assert!((sum - expected).norm() <= bound, "{k} {sum} {expected} {bound}");
            }
        }
    }

    #[test]
    fn inertia_torque_is_the_slope_of_the_moving_inertia(engine in engines()) {
        let (grid, cancel) = (CycleGrid::new(360.0, &[], &Cancel::new()).unwrap(), Cancel::new());
        let none = vec![0.0; grid.nodes_deg.len()];
        let drive = CrankDrive {
            grid: &grid, torque: &none, load: &none, engines: &[&engine], rpm: REQUEST.rpm,
        };
        let run = drive.speed(FlywheelTarget::Inertia(1e6), &cancel).unwrap();
        let exact = waveform::exact(&engine, &REQUEST, &grid.edges_deg, &cancel).unwrap();
        let expected = exact.crank_torque.unwrap();
        let size = expected.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
        for (torque, expected) in run.inertia_torque.iter().zip(&expected) {
            // Some ten roundings of what cancels between cylinders.
            prop_assert!((torque - expected).abs() <= 1e-9 * size, "{torque} {expected}");
        }
    }

    #[test]
    fn a_spectrum_acts_at_multiples_of_the_speed_of_its_crank(
        engine in engines(), amplitudes in [(-1.0..1.0, -1.0..1.0), (-1.0..1.0, -1.0..1.0)]
    ) {
        let amplitudes = amplitudes.map(|(re, im): (f64, f64)| Complex64::new(re, im));
        let spectrum = Spectrum::new((1..).zip(amplitudes)).unwrap();
        let given = engine.with_spectrum(spectrum);
        let auto = Orders::Auto { rtol: 1e-12 };
        let found = balance::balance(&given, &REQUEST, &auto, &Cancel::new()).unwrap();
        let square = (REQUEST.rpm * std::f64::consts::TAU / 60.0).powi(2);
        for order in 1..=4 {
            let (mut expected, mut size) = (Complex64::default(), 0.0);
            for (i, station) in engine.stations().iter().enumerate() {
                let ratio = engine.cranks()[engine.crank_of(i)].ratio;
                let speed = ratio.as_whole().unwrap().unsigned_abs();
                let own = (order % speed == 0).then_some((order / speed) as usize);
                let of_piston = own.and_then(|n| amplitudes.get(n - 1)).copied();
                let turning = station.rotating_mass * station.cylinder.crank_radius();
                let turning = if ratio == SpeedRatio::whole(order as i32) { turning } else { 0.0 };
                let lag = station.bank.degrees() - f64::from(order) * station.tdc.degrees();
                let weight = ratio.number().powi(2) * square;
                let amplitude = 0.5 * of_piston.unwrap_or_default() + turning;
                expected += Complex64::cis(lag.to_radians()) * amplitude * weight;
                size += (2.0 + station.rotating_mass) * weight;
            }
            let at = found.order(Order::whole(order).unwrap());
            let force = at.map_or(Complex64::default(), |wrench| wrench.force.forward);
            // Degrees of phases to radians, and orders below the tolerance.
            prop_assert!((force - expected).norm() <= 1e-11 * size, "{order} {force} {expected}");
        }
    }

    #[test]
    fn verdicts_are_not_refuted_by_the_balance(engine in weighted(engines())) {
        let found = vanishing(&engine, &orders(), Some(0.07), None, &Cancel::new()).unwrap();
        let balance = of(&engine);
        for (k, verdicts) in found.verdicts.iter().enumerate() {
            let [force, moment] =
                [Vector::Force, Vector::Moment].map(|vector| balance.xy(vector, k));
            let [f, b, m, n, roll, _] = phasors(&balance, k);
            let values = [force[0], force[1], f, b, moment[0], moment[1], m, n, roll];
            for ((value, verdict), quantity) in values.iter().zip(verdicts).zip(QUANTITIES) {
                prop_assert!(
                    *verdict != Verdict::Vanishes || *value == Complex64::default(),
                    "{k} {quantity:?} {value}"
                );
            }
        }
    }

    /// Twins of opposite senses, or one crank beside another: what cancels is proved, and nothing else.
    #[test]
    fn verdicts_of_twins_are_those_of_their_figures(
        cylinder in cylinders(true),
        tdc in 0_i64..24,
        lag in select(vec![0_i64, 12]),
        bank in select(vec![0_i64, 12]),
        ratio in select(vec![1, -1]),
        above in any::<bool>(),
    ) {
        let step = |k: i64| angle(15.0 * k as f64);
        let at = |tdc: i64, bank: i64| Station {
            cylinder, tdc: step(tdc), bank: step(bank), z: 0.0, rotating_mass: 0.0
        };
        let beside = Crank { axis: if above { [0.0, 0.125] } else { [0.125, 0.0] }, ratio: SpeedRatio::whole(ratio) };
        let engine = Engine::new("", "", vec![at(tdc, 6), at(tdc + lag, 6 + bank)]).unwrap();
        let engine = engine.with_cranks(vec![Crank::MAIN, beside], vec![0, 1]).unwrap();
        let found = vanishing(&engine, &orders(), None, None, &Cancel::new()).unwrap();
        for (verdicts, within) in found.verdicts.iter().zip(&found.within_rounding) {
            for k in QUANTITIES.into_iter().take(9) {
                let decided = verdicts[k] != Verdict::Undecided;
                // The roll torque of a force beside the axis has no ratio to that of the masses; along
                // the bores there is none.
                let is_torque = k == ProofQuantity::Torque;
                prop_assert!(decided || (is_torque && !above), "{k:?} {:?}", found.obstacles);
                prop_assert!(!decided || (verdicts[k] == Verdict::Vanishes) == within[k], "{k:?}");
            }
        }
    }
}

/// Engines of few figures, so that things coincide: cylinders on cranks at halves of crank speed and of either sense,
/// some of them dead, pins that carry mass or none, shafts at halves, and loads that scale with speed in each way.
fn coinciding() -> impl Strategy<Value = Engine> {
    let figures = [(0.0, 0.0), (0.01, 0.0), (0.0, -2e-4), (0.0, 0.0)];
    let cylinder = select(figures.to_vec()).prop_map(|(offset, inertia)| {
        let cylinder = Cylinder::new(0.05, 0.16, 0.5, offset).unwrap();
        cylinder.with_rod_inertia_excess(inertia).unwrap()
    });
    let place = (
        cylinder,
        select(vec![0.0, 90.0, 120.0, 180.0, 240.0]),
        select(vec![60.0, 90.0, 240.0]),
        select(vec![0.0, 0.1, -0.1]),
        select(vec![0.0, 0.3]),
        0_usize..3,
    );
    let crank = (select(vec![1, 2, -2, 4, -1]), select(vec![[0.0, 0.0], [0.2, -0.1]]));
    let shaft = (select(vec![1, -2, 2, 4, -3]), select(vec![0.002, 0.025]));
    // What makes it, its order in halves, and what it scales with.
    let load = (0_usize..3, select(vec![1, 2, 4]), 0_usize..3, select(vec!["pump", "valves"]));
    let lists = (
        proptest::collection::vec(crank, 0..3),
        proptest::collection::vec(place, 1..7),
        proptest::collection::vec(shaft, 0..3),
        proptest::collection::vec(load, 0..4),
    );
    lists.prop_map(|(others, places, shafts, loads)| {
        let crank = |(halves, axis)| Crank { axis, ratio: SpeedRatio::from_halves(halves) };
        let main = std::iter::once(Crank::MAIN);
        let cranks: Vec<Crank> = main.chain(others.into_iter().map(crank)).collect();
        // Others carry no cylinders.
        let whole: Vec<usize> =
            (0..cranks.len()).filter(|&k| cranks[k].ratio.as_whole().is_some()).collect();
        let on = places.iter().map(|place| whole[place.5 % whole.len()]).collect();
        let station = |(cylinder, tdc, bank, z, rotating_mass, _)| Station {
            cylinder,
            tdc: angle(tdc),
            bank: angle(bank),
            z,
            rotating_mass,
        };
        let shaft = |(halves, amount)| Shaft {
            name: String::new(),
            ratio: SpeedRatio::from_halves(halves),
            axis: [0.1, 0.0],
            unbalances: vec![Unbalance {
                amount,
                angle: angle(90.0),
                z: 0.1,
                pin: None,
                crank: CrankIndex::MAIN,
            }],
        };
        let load = |(kind, halves, scaling, name): (usize, u32, usize, &str)| {
            let rows = if scaling == 2 { 2 } else { 1 };
            let of_order: Vec<_> = (1..=rows).map(|k| Complex64::new(-90.0, k as f64)).collect();
            let force = vec![(halves, of_order.clone())];
            let torque = vec![(0, vec![5.0.into(); rows]), (halves, of_order)];
            let [force, torque] = [(kind != 1, force), (kind != 0, torque)]
                .map(|(has, all)| Amplitudes(if has { all } else { Vec::new() }));
            let over_speed = match scaling {
                0 => OverSpeed::Independent,
                1 => OverSpeed::SpeedSquared(3000.0),
                _ => OverSpeed::Table(vec![1000.0, 4000.0]),
            };
            PeriodicLoad {
                force,
                torque,
                over_speed,
                z: 0.1,
                ..PeriodicLoad::new(name, ActsOn::Block)
            }
        };
        let stations = places.into_iter().map(station).collect();
        Engine::new("", "", stations)
            .and_then(|engine| engine.with_cranks(cranks, on))
            .and_then(|engine| engine.with_shafts(shafts.into_iter().map(shaft).collect()))
            .and_then(|engine| engine.with_loads(loads.into_iter().map(load).collect()))
            .unwrap()
    })
}

/// Each number of a sweep's point is that of the balance there, to the last bit: forward and backward parts, torques,
/// their means and bounds of rounding, whole and of each name, and the orders that are chosen with the bound of what
/// they leave out.
#[track_caller]
fn each_point_is_its_balance(
    engine: Engine,
    rtol: f64,
    [first, second]: [f64; 2],
    reference_z: Option<f64>,
) -> Result<(), TestCaseError> {
    let (engines, cancel) = (vec![Arc::new(engine)], Cancel::new());
    let orders: Vec<Order> = (1..=9).map(|h| Order::from_halves(h).unwrap()).collect();
    let (auto, given) = (Orders::Auto { rtol }, Orders::Given(orders));
    for speeds in [&[first][..], &[first, second]] {
        let axes = SweepAxes { rpm: speeds.to_vec(), ..SweepAxes::default() };
        let sweep = |orders| {
            Sweep::new(engines.clone(), axes.clone(), orders, reference_z, true, &cancel).unwrap()
        };
        let (chosen, all) = (sweep(&auto), sweep(&given));
        let balance = |rpm, orders| {
            let request = Request { rpm, reference_z, torque: true };
            balance::balance(&engines[0], &request, orders, &cancel).unwrap()
        };
        let (mut bound, names) = (ErrorBounds::default(), all.names());
        for (speed, &rpm) in speeds.iter().enumerate() {
            let of_chosen = balance(rpm, &auto);
            prop_assert_eq!(chosen.orders(), &of_chosen.orders);
            prop_assert_eq!(chosen.omitted(), &of_chosen.omitted);
            bound = bound.max(of_chosen.error_bound);
            let alone = balance(rpm, &given);
            prop_assert_eq!(&names[..], alone.names());
            let parts = names.iter().map(|name| Part::Of(name)).chain([Part::Whole]);
            for (part, quantity) in parts.flat_map(|part| {
                [Quantity::FORCE, Quantity::MOMENT, Quantity::TORQUE, Quantity::CRANK_TORQUE]
                    .map(|quantity| (part, quantity.part(part)))
            }) {
                let of = |figure, width: usize| {
                    let all = all.phasors(quantity, figure, &cancel).unwrap();
                    all.into_raw_vec_and_offset().0[speed * width..][..width].to_vec()
                };
                let peaks = |figure, width: usize| {
                    let all = all.peaks(quantity, figure, &cancel).unwrap();
                    all.into_raw_vec_and_offset().0[speed * width..][..width].to_vec()
                };
                let bounds = peaks(Statistic::ZeroBound, 9);
                let on_crank = usize::from(quantity.kind == Kind::CrankTorque);
                let vector = match quantity.kind {
                    Kind::Force => Vector::Force,
                    Kind::Moment => Vector::Moment,
                    Kind::Torque | Kind::CrankTorque => {
                        let torque = |k| {
                            let torque = alone.torque(part, k);
                            ([torque.roll, torque.crank][on_crank], torque.bounds[on_crank])
                        };
                        let (expected, expected_bounds): (Vec<_>, Vec<_>) =
                            (0..9).map(torque).unzip();
                        prop_assert_eq!(of(Statistic::Amplitude, 9), expected, "{:?}", quantity);
                        prop_assert_eq!(bounds, expected_bounds, "{:?}", quantity);
                        let mean = alone.mean(part)[on_crank];
                        prop_assert_eq!(peaks(Statistic::Mean, 1), [mean], "{:?}", quantity);
                        continue;
                    }
                };
                let planar = |k| *vector.of(&alone.wrench(part, k));
                // Along x and y the parts add up, before or after they are multiplied by ω².
                for (k, found) in of(Statistic::Amplitude, 18).chunks(2).enumerate() {
                    let (own, slack) = (planar(k), planar(k).bound + 1e-15 * planar(k).peak());
                    for (found, expected) in found.iter().zip(own.xy(own.bound)) {
                        prop_assert!((found - expected).norm() <= slack, "{:?} {}", quantity, k);
                    }
                }
                let expected: Vec<_> =
                    (0..9).flat_map(|k| [planar(k).forward, planar(k).backward()]).collect();
                prop_assert_eq!(of(Statistic::Turning, 18), expected, "{:?}", quantity);
                let expected: Vec<_> = (0..9).map(|k| planar(k).bound).collect();
                prop_assert_eq!(bounds, expected, "{:?}", quantity);
            }
        }
        prop_assert_eq!(chosen.error_bound(), bound);
    }
    Ok(())
}

proptest! {
    // Choices of orders of an engine: a second each without optimisation.
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn a_balance_is_a_row_of_a_sweep(
        engine in fired(weighted(engines())),
        digits in 1.0..9.0_f64,
    ) {
        each_point_is_its_balance(engine, 10_f64.powf(-digits), [3000.0, 1234.5], Some(0.07))?;
    }

    #[test]
    fn a_balance_is_a_row_of_a_sweep_where_things_coincide(
        engine in fired(coinciding()),
        rtol in select(vec![0.1, 1e-3, 1e-6]),
        speeds in select(vec![[3000.0, 1000.0], [1000.0, 4000.0], [2000.0, 2000.0]]),
        reference in select(vec![None, Some(0.0), Some(0.1), Some(-1.0)]),
    ) {
        each_point_is_its_balance(engine, rtol, speeds, reference)?;
    }
}
