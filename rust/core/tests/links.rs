//! Engines with link rods, against the loops that their rods close and the masses that move with them.
//!
//! The reference closes each loop with circles and lines in the cross-section, in place of any formula of the core, and
//! takes momentum, moment of momentum and kinetic energy of point masses and of rods that turn. Their derivatives are
//! those of samples over a turn.

mod common;

use std::f64::consts::TAU;
use std::sync::Arc;

use common::{angle, by_orders};
use crankpin_core::balance::{Orders, Request, Vector};
use crankpin_core::bearing_loads::BearingLoadsModel;
use crankpin_core::engine::file::{from_json_text, from_toml, to_json_text, to_toml};
use crankpin_core::engine::{Details, EngineOnCrank, Gas, LinkRod};
use crankpin_core::exact::vanishing::{ProofQuantity, Verdict, vanishing};
use crankpin_core::mechanism::{Mechanism, motion::CrankPosition};
use crankpin_core::pressure::{Cycle, Given};
use crankpin_core::{
    Angle, Cancel, Complex64, Crank, Cylinder, Engine, Error, Hold, Order, SpeedRatio, Station,
    waveform,
};
use proptest::prelude::*;
use proptest::sample::select;

/// Samples of a turn: 256 of motions whose orders fall by a factor of 2 at least.
const SAMPLES: usize = 256;
/// Radian per second.
const RPM: f64 = 60.0 / TAU;

fn request() -> Request {
    Request { rpm: RPM, reference_z: None, torque: true }
}

/// A star: cylinders at even angles from 0°, all on one crankpin; the first has the master rod.
struct StarRods {
    count: usize,
    radius: f64,
    master: f64,
    knuckle: f64,
    link: f64,
    big_end: f64,
}

const FIVE: StarRods =
    StarRods { count: 5, radius: 0.06, master: 0.23, knuckle: 0.052, link: 0.178, big_end: 0.0 };

impl StarRods {
    /// With these masses that move with pistons, and knuckles so many degrees ahead of the bores.
    fn engine(&self, mass: f64, master_mass: f64, ahead: &str) -> Engine {
        let turned = |i: usize| Angle::from_degree_fraction(360 * i as i64, self.count as i64);
        let station = |i: usize| {
            let (rod, mass) = if i == 0 { (self.master, master_mass) } else { (self.link, mass) };
            let cylinder = Cylinder::new(self.radius, rod, mass, 0.0).unwrap();
            let bank = turned(i).unwrap();
            Station { cylinder, tdc: bank, bank, z: 0.0, rotating_mass: 0.0 }
        };
        let ahead: Angle = ahead.parse().unwrap();
        let link = |i: usize| {
            let angle = turned(i).unwrap() + ahead;
            let (radius, big_end_mass) = (self.knuckle, self.big_end);
            (i > 0).then_some(LinkRod { master: 0, radius, angle, big_end_mass })
        };
        Engine::new("", "", (0..self.count).map(station).collect())
            .and_then(|engine| engine.with_link_rods((0..self.count).map(link).collect()))
            .unwrap()
    }
}

/// Forward and backward force of an order over m·r·ω².
fn turning(engine: &Engine, order: u32, scale: f64) -> [Complex64; 2] {
    let balance = by_orders(engine, &request(), &[order]);
    let [x, y] = balance.xy(Vector::Force, 0);
    let i = Complex64::i();
    [(x + i * y) / (2.0 * scale), (x - i * y).conj() / (2.0 * scale)]
}

#[test]
fn a_star_of_links_has_the_figures_of_its_rods() {
    let engine = FIVE.engine(1.0, 1.0, "0");
    let sizes = |order| turning(&engine, order, 0.06).map(Complex64::norm);
    let near = |found: f64, expected: f64| {
        assert!((found / expected - 1.0).abs() < 1e-7, "{found} is not {expected}");
    };
    assert!((sizes(1)[0] - 2.5).abs() < 1e-14 && sizes(1)[1] < 1e-14);
    near(sizes(2)[0], 0.399_585_19);
    near(sizes(2)[1], 0.000_267_595_69);
    near(sizes(4)[1], 0.026_812_432);
    // The least: N·(r/L)(a/l).
    assert!((sizes(2)[0] / (5.0 * (60.0 / 178.0) * (52.0 / 230.0)) - 1.05).abs() < 0.003);
    let travels = (0..5).map(|i| engine.mechanism(i).travel() / 0.12);
    near(travels.fold(0.0, f64::max), 1.004_238_4);
    let alike = StarRods { knuckle: 0.0, link: 0.23, ..FIVE }.engine(1.0, 1.0, "0");
    assert!(turning(&alike, 2, 0.06)[0].norm() < 1e-13);
    near(turning(&alike, 4, 0.06)[1].norm(), 0.011_691_518);
}

#[test]
fn big_ends_of_links_leave_half_of_a_over_l_backward_until_the_master_weighs_more() {
    let star = StarRods { big_end: 1.0, ..FIVE };
    let parts = |master_mass| turning(&star.engine(0.0, master_mass, "0"), 1, 0.06);
    let [forward, backward] = parts(0.0).map(Complex64::norm);
    assert!((backward - 0.113_043_48).abs() < 1e-8 && (forward - 4.113_043_5).abs() < 1e-7);
    // The master's extra mass that makes the star whole again: (a/l)·m.
    let share = 52.0 / 230.0;
    let [forward, backward] = parts(share).map(Complex64::norm);
    assert!(backward < 1e-15 && (forward - 4.0 - share).abs() < 1e-14);
}

#[test]
fn odd_orders_fall_smoothly_to_exact_zero_as_knuckles_meet_their_bores() {
    let odd = |ahead: &str| {
        let engine = FIVE.engine(1.0, 1.0, ahead);
        engine.mechanism(1).force(&[1, 3, 5], &Cancel::new()).unwrap()
    };
    let exact = odd("0");
    assert_eq!(exact, [Complex64::ONE, Complex64::ZERO, Complex64::ZERO]);
    assert_eq!(odd("180")[1..], exact[1..]);
    // Proportional to the sine of the angle between, with all digits.
    let unit = odd("1e-4").map_to(1e-4);
    for small in ["1e-6", "1e-9", "1e-12", "1e-15"] {
        let size: f64 = small.parse().unwrap();
        for (found, expected) in odd(small).map_to(size).into_iter().zip(&unit) {
            assert!((found / expected - 1.0).norm() < 3e-5 && found.norm() > 0.0, "{small}");
        }
    }
}

trait MapTo {
    fn map_to(self, size: f64) -> Vec<Complex64>;
}

impl MapTo for Vec<Complex64> {
    /// Orders above the first over a size.
    fn map_to(self, size: f64) -> Vec<Complex64> {
        self[1..].iter().map(|value| value / size).collect()
    }
}

#[test]
fn a_knuckle_at_the_crankpin_is_the_plain_rod_to_the_last_digit() {
    let star = StarRods { knuckle: 0.0, ..FIVE };
    let engine = star.engine(1.0, 1.0, "7");
    let plain = Cylinder::new(0.06, 0.178, 1.0, 0.0).unwrap().mechanism();
    assert!(*engine.mechanism(3) == *plain);
    let orders: Vec<u32> = (1..=12).collect();
    let of = |mechanism: &dyn Mechanism| mechanism.force(&orders, &Cancel::new()).unwrap();
    let limit = StarRods { knuckle: 1e-18, ..FIVE }.engine(1.0, 1.0, "7").mechanism(3);
    for (near, plain) in of(&*limit).into_iter().zip(of(&*plain)) {
        assert!((near - plain).norm() < 1e-15);
    }
}

/// Of an engine, absolute and in the sense x to y: places of each cylinder's knuckle, or crankpin, and wrist pin at a
/// crank angle.
fn closed(engine: &Engine, theta: f64) -> Vec<[Complex64; 2]> {
    let crankpin = |i: usize| {
        let crank = engine.cranks()[engine.crank_of(i)];
        let turned = engine.pin(i).degrees().to_radians() + crank.ratio.number() * theta;
        engine.stations()[i].cylinder.crank_radius() * Complex64::cis(turned)
    };
    // Where a circle about a point meets a line along the bore, farther from the crank.
    let on_bore = |i: usize, end: Complex64| {
        let place = &engine.stations()[i];
        let sense = f64::from(engine.cranks()[engine.crank_of(i)].ratio.sense());
        let (along, rod) = (place.bank.cis(1), place.cylinder.rod_length());
        let foot = sense * place.cylinder.pin_offset() * Complex64::i() * along;
        let from = (end - foot) / along;
        foot + along * (from.re + (rod * rod - from.im * from.im).sqrt())
    };
    let place = |i: usize| {
        let Some(link) = engine.link_rods()[i] else {
            return [crankpin(i), on_bore(i, crankpin(i))];
        };
        let pin = crankpin(link.master);
        let shank = on_bore(link.master, pin) - pin;
        let knuckle = pin + shank / shank.norm() * link.angle.cis(1) * link.radius;
        [knuckle, on_bore(i, knuckle)]
    };
    (0..engine.stations().len()).map(place).collect()
}

/// Derivative of samples over a turn.
fn derivative(values: &[f64]) -> Vec<f64> {
    let count = values.len();
    let at = |k: usize| Complex64::cis(TAU * (k % count) as f64 / count as f64);
    let units: Vec<Complex64> = (0..count).map(at).collect();
    let phasor = |n: usize| -> Complex64 {
        let terms = values.iter().enumerate().map(|(k, value)| units[k * n % count].conj() * value);
        terms.sum::<Complex64>() * (2.0 / count as f64)
    };
    // Above a quarter of the samples there is rounding.
    let slopes: Vec<Complex64> =
        (0..count / 4).map(|n| phasor(n) * Complex64::new(0.0, n as f64)).collect();
    let sum =
        |k: usize| slopes.iter().enumerate().map(|(n, a)| (a * units[k * n % count]).re).sum();
    (0..count).map(sum).collect()
}

/// Force x, y, roll torque on the block and torque on the main crank of all pistons, knuckles and rods, at samples of a
/// turn, with ω = 1; of engines whose crankpins carry nothing else.
fn derived(engine: &Engine) -> [Vec<f64>; 4] {
    let theta = |k: usize| TAU * k as f64 / SAMPLES as f64;
    let all: Vec<_> = (0..SAMPLES).map(|k| closed(engine, theta(k))).collect();
    let mut sums = [(); 4].map(|()| vec![0.0; SAMPLES]);
    for i in 0..engine.stations().len() {
        let cylinder = engine.stations()[i].cylinder;
        let crank = engine.cranks()[engine.crank_of(i)];
        let axis = Complex64::new(crank.axis[0], crank.axis[1]);
        let big_end = engine.link_rods()[i].map_or(0.0, |link| link.big_end_mass);
        let mut momenta = [(); 3].map(|()| vec![0.0; SAMPLES]);
        let mut energy = vec![0.0; SAMPLES];
        for (end, mass) in [(1, cylinder.reciprocating_mass()), (0, big_end)] {
            let part = |of: fn(Complex64) -> f64| -> Vec<f64> {
                all.iter().map(|places| of(axis + places[i][end])).collect()
            };
            let (x, y) = (part(|z| z.re), part(|z| z.im));
            let (vx, vy) = (derivative(&x), derivative(&y));
            for k in 0..SAMPLES {
                momenta[0][k] += mass * vx[k];
                momenta[1][k] += mass * vy[k];
                momenta[2][k] += mass * (x[k] * vy[k] - y[k] * vx[k]);
                energy[k] += 0.5 * mass * (vx[k] * vx[k] + vy[k] * vy[k]);
            }
        }
        let inertia = cylinder.rod_inertia_excess();
        let lean = |places: &Vec<[Complex64; 2]>| {
            let [low, high] = places[i];
            ((high - low) / engine.stations()[i].bank.cis(1)).arg()
        };
        let turning = derivative(&all.iter().map(lean).collect::<Vec<_>>());
        for k in 0..SAMPLES {
            momenta[2][k] += inertia * turning[k];
            energy[k] += 0.5 * inertia * turning[k] * turning[k];
        }
        let [force_x, force_y, about] = momenta.map(|momentum| derivative(&momentum));
        let power = derivative(&energy);
        for k in 0..SAMPLES {
            sums[0][k] -= force_x[k];
            sums[1][k] -= force_y[k];
            sums[2][k] += power[k] / crank.ratio.number() - about[k];
            sums[3][k] -= power[k];
        }
    }
    sums
}

/// Waveform by kinematics and by orders, and loads inside, are those of the loops.
fn check(engine: &Engine) {
    let expected = derived(engine);
    let sizes =
        expected.each_ref().map(|values| values.iter().fold(0.01, |m: f64, v| m.max(v.abs())));
    let all: Vec<f64> = (0..SAMPLES).map(|k| 360.0 * k as f64 / SAMPLES as f64).collect();
    let cancel = Cancel::new();
    let thetas: Vec<f64> = all.iter().copied().step_by(31).collect();
    let exact = waveform::exact(engine, &request(), &thetas, &cancel).unwrap();
    let orders = Orders::Auto { rtol: 1e-13 };
    let summed = waveform::from_orders(engine, &request(), &thetas, &orders, &cancel).unwrap();
    let loads = BearingLoadsModel::new(engine, RPM).unwrap().loads(&thetas, &cancel).unwrap();
    let places: Vec<_> = thetas.iter().map(|theta| closed(engine, theta.to_radians())).collect();
    for (k, row) in (0..SAMPLES).step_by(31).enumerate() {
        for of in [&exact, &summed] {
            let found = [
                of.force[[k, 0]],
                of.force[[k, 1]],
                of.torque.as_ref().unwrap()[k],
                of.crank_torque.as_ref().unwrap()[k],
            ];
            for n in 0..4 {
                let (found, expected) = (found[n], expected[n][row]);
                assert!(
                    (found - expected).abs() < 1e-9 * sizes[n],
                    "{n} at {k}: {found} {expected}"
                );
            }
        }
        // Free bodies: what crankpins get turns the cranks, and walls and bearings turn the block.
        let (mut on_crank, mut on_block, mut force) = (0.0, 0.0, Complex64::ZERO);
        for (i, place) in engine.stations().iter().enumerate() {
            let crank = engine.cranks()[engine.crank_of(i)];
            let axis = Complex64::new(crank.axis[0], crank.axis[1]);
            let of_pin = Complex64::new(loads.crankpin[[i, k, 0]], loads.crankpin[[i, k, 1]]);
            let wall = f64::from(crank.ratio.sense()) * -loads.side_thrust[[i, k]];
            let wall = place.bank.cis(1) * Complex64::new(loads.gas[[i, k]], wall);
            on_block += ((axis + places[k][i][1]).conj() * wall).im;
            force += wall;
            if engine.link_rods()[i].is_none() {
                on_crank += crank.ratio.number() * (places[k][i][0].conj() * of_pin).im;
                on_block += (axis.conj() * of_pin).im;
                force += of_pin;
            }
        }
        assert!((on_crank - expected[3][row]).abs() < 1e-9 * sizes[3], "{k}: {on_crank}");
        assert!((on_block - expected[2][row]).abs() < 1e-9 * sizes[2], "{k}: {on_block}");
        assert!((force.re - expected[0][row]).abs() < 1e-9 * sizes[0], "{k}: {force}");
        assert!((force.im - expected[1][row]).abs() < 1e-9 * sizes[1], "{k}: {force}");
    }
}

/// Fired, what crankpins get still turns the cranks, and walls and heads the block, as the waveform says.
fn check_fired(engine: &Engine) {
    let count = engine.stations().len();
    let bored = Details { bore: Some(0.09), ..Details::default() };
    let theta_deg: Vec<f64> = (0..72).map(|k| 10.0 * f64::from(k)).collect();
    let pressure = |theta: &f64| 2e5 + 1e6 * (4.0 * (0.5 * theta).to_radians().cos() - 4.0).exp();
    let pressure = theta_deg.iter().map(pressure).collect();
    let given = Given { name: String::new(), strokes: 4, theta_deg, pressure, degree: None };
    let gas = Gas {
        cycles: vec![Arc::new(Cycle::new(given).unwrap())],
        // One does not fire.
        cycle_of: (0..count).map(|i| (i != 1).then_some(0)).collect(),
        crank_ends: vec![],
        crankcase: 1e5,
        later: (0..count).map(|i| i % 3 == 1).collect(),
    };
    let fired = engine.with_details(vec![bored; count]).and_then(|e| e.with_gas(gas)).unwrap();
    let (cancel, rpm) = (Cancel::new(), 3000.0);
    let thetas: Vec<f64> = (0..37).map(|k| 19.7 * f64::from(k)).collect();
    let request = Request { rpm, ..request() };
    let expected = waveform::exact(&fired, &request, &thetas, &cancel).unwrap();
    let loads = BearingLoadsModel::new(&fired, rpm).unwrap().loads(&thetas, &cancel).unwrap();
    let (roll, on_cranks) = (expected.torque.unwrap(), expected.crank_torque.unwrap());
    for (k, theta) in thetas.iter().enumerate() {
        let places = closed(&fired, theta.to_radians());
        let (mut on_crank, mut on_block) = (0.0, 0.0);
        for (i, place) in fired.stations().iter().enumerate() {
            let crank = fired.cranks()[fired.crank_of(i)];
            let axis = Complex64::new(crank.axis[0], crank.axis[1]);
            let of_pin = Complex64::new(loads.crankpin[[i, k, 0]], loads.crankpin[[i, k, 1]]);
            let wall = f64::from(crank.ratio.sense()) * -loads.side_thrust[[i, k]];
            let wall = place.bank.cis(1) * Complex64::new(loads.gas[[i, k]], wall);
            on_block += ((axis + places[i][1]).conj() * wall).im;
            if fired.link_rods()[i].is_none() {
                on_crank += crank.ratio.number() * (places[i][0].conj() * of_pin).im;
                on_block += (axis.conj() * of_pin).im;
            }
        }
        // Roundings of forces of some 10⁵ N.
        assert!((on_crank - on_cranks[k]).abs() < 1e-8, "{k}: {on_crank} {}", on_cranks[k]);
        assert!((on_block - roll[k]).abs() < 1e-8, "{k}: {on_block} {}", roll[k]);
    }
}

/// A link rod beside its master: bore ahead of the master's and knuckle ahead of the bore, degrees; knuckle radius,
/// length, mass at the knuckle.
type Hung = ([f64; 2], f64, f64, f64);

fn hung() -> impl Strategy<Value = Hung> {
    let angles = [select(vec![0.0, 60.0, 72.0, -72.0, 180.0]), select(vec![0.0, 7.0, -7.0, 1e-6])];
    let radius = select(vec![0.0, 0.02, 0.052]);
    (angles, radius, select(vec![0.178, 0.15]), select(vec![0.0, 0.3]))
}

/// Speed of the crank, pin offset of the master, bore and pin in degrees, and links.
type MasterRod = (i32, f64, [f64; 2], Vec<Hung>);

fn masters() -> impl Strategy<Value = Vec<MasterRod>> {
    let ratio = select(vec![1, 1, -1, -2]);
    let offset = select(vec![0.0, 0.0, 0.0, 0.006]);
    let angles = [select(vec![0.0, 90.0, 33.0]), select(vec![0.0, 120.0])];
    let one = (ratio, offset, angles, prop::collection::vec(hung(), 0..4));
    prop::collection::vec(one, 1..3)
}

fn linked(masters: &[MasterRod]) -> crankpin_core::Result<Engine> {
    let (mut cranks, mut crank_of) = (vec![Crank::MAIN], Vec::new());
    let (mut stations, mut links) = (Vec::new(), Vec::new());
    for (k, (ratio, offset, [bore, pin], hung)) in masters.iter().enumerate() {
        let mut own = 0;
        if *ratio != 1 {
            own = cranks.len();
            cranks.push(Crank { axis: [0.3, 0.1 * k as f64], ratio: SpeedRatio::whole(*ratio) });
        }
        let crank = cranks[own];
        let mut place = |bank: Angle, rod: f64, mass: f64, offset: f64| {
            let cylinder =
                Cylinder::new(0.06, rod, mass, offset)?.with_rod_inertia_excess(-1e-3)?;
            let tdc = crank.tdc(bank, angle(*pin));
            stations.push(Station { cylinder, tdc, bank, z: 0.1 * k as f64, rotating_mass: 0.0 });
            crank_of.push(own);
            Ok::<_, Error>(())
        };
        let master = links.len();
        place(angle(*bore), 0.23, 0.7, *offset)?;
        links.push(None);
        for &([ahead, knuckle], radius, rod, big_end_mass) in hung {
            place(angle(bore + ahead), rod, 0.5, 0.0)?;
            let angle = angle(ahead + knuckle);
            links.push(Some(LinkRod { master, radius, angle, big_end_mass }));
        }
    }
    Engine::new("", "", stations)?.with_cranks(cranks, crank_of)?.with_link_rods(links)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn all_readings_are_those_of_the_loops(masters in masters()) {
        let engine = linked(&masters).unwrap();
        check(&engine);
        if engine.fires_in_main_cycles() {
            check_fired(&engine);
        }
    }
}

#[test]
fn a_master_with_unlike_links_is_that_of_its_loops() {
    let hung = vec![
        ([72.0, 7.0], 0.052, 0.178, 0.3),
        ([-72.0, 0.0], 0.02, 0.15, 0.3),
        ([60.0, -7.0], 0.052, 0.178, 0.0),
    ];
    for ratio in [1, -1, -2] {
        for offset in [0.0, 0.006] {
            check(&linked(&[(ratio, offset, [33.0, 120.0], hung.clone())]).unwrap());
        }
    }
}

/// Two cylinders of a vee, of which the second has a link rod.
fn twin(bank: &str, knuckle: &str) -> Engine {
    let cylinder = |rod| Cylinder::new(0.048, rod, 1.0, 0.0).unwrap();
    let bank: Angle = bank.parse().unwrap();
    let place = |rod, bank| Station {
        cylinder: cylinder(rod),
        tdc: bank,
        bank,
        z: 0.0,
        rotating_mass: 0.0,
    };
    let angle = knuckle.parse().unwrap();
    let link = LinkRod { master: 0, radius: 0.038, angle, big_end_mass: 0.0 };
    Engine::new("", "", vec![place(0.19, Angle::ZERO), place(0.152, bank)])
        .and_then(|engine| engine.with_link_rods(vec![None, Some(link)]))
        .unwrap()
}

#[test]
fn a_v_twin_has_no_third_order_exactly_where_its_knuckle_stands_at_the_bore() {
    let engine = twin("45", "45");
    let longest = |order| {
        let [forward, backward] = turning(&engine, order, 0.048);
        forward.norm() + backward.norm()
    };
    assert!((longest(1) - 1.707_106_8).abs() < 1e-7 && (longest(2) - 0.301_484_8).abs() < 1e-7);
    assert_eq!(longest(3), 0.0);
    let verdict = |engine: &Engine, order| {
        let orders = [Order::whole(order).unwrap()];
        let found = vanishing(engine, &orders, None, None, &Cancel::new()).unwrap();
        found.verdict(orders[0], ProofQuantity::ForceX).unwrap()
    };
    for order in [3, 5, 7] {
        assert_eq!(verdict(&engine, order), Verdict::Vanishes);
        assert_ne!(verdict(&twin("45", "46"), order), Verdict::Vanishes);
    }
    assert!(turning(&twin("45", "52"), 3, 0.048)[0].norm() > 1e-3);
    // A V-12: six cranks at 120° in step at order 3, and links that are alike share their symbols at order 5.
    let v12 = twelve();
    assert_eq!(verdict(&v12, 5), Verdict::Vanishes);
    let third = turning(&v12, 3, 0.048).map(Complex64::norm);
    let one = v12.mechanism(1).force(&[3], &Cancel::new()).unwrap()[0].norm();
    assert!((third[0] - 3.0 * one).abs() < 1e-14 && one > 1e-3, "{third:?}");
}

/// A V-12 of 60° whose knuckles stand at 67°.
fn twelve() -> Engine {
    let pair = twin("60", "67");
    let mut places = Vec::new();
    for (k, throw) in [0.0, 120.0, 240.0, 240.0, 120.0, 0.0].into_iter().enumerate() {
        places.extend(pair.stations().iter().map(|place| Station {
            tdc: place.tdc - angle(throw),
            z: 0.1 * k as f64,
            ..*place
        }));
    }
    let link = |i: usize| {
        let own = pair.link_rods()[i % 2]?;
        Some(LinkRod { master: i - 1, ..own })
    };
    let engine = Engine::new("", "", places).unwrap();
    engine.with_link_rods((0..12).map(link).collect()).unwrap()
}

#[test]
fn link_rods_follow_their_cylinders() {
    let star = StarRods { big_end: 0.2, ..FIVE }.engine(1.0, 1.2, "3");
    let text = to_toml(&star).unwrap();
    assert_eq!(from_toml(&text).unwrap(), star);
    assert_eq!(from_json_text(&to_json_text(&star).unwrap()).unwrap(), star);
    // Angles between bores are the knuckles' where none are given.
    let plain = FIVE.engine(1.0, 1.0, "0");
    let text = to_toml(&plain).unwrap();
    let bare: Vec<&str> = text.lines().filter(|line| !line.starts_with("angle_deg")).collect();
    assert_eq!(from_toml(&bare.join("\n")).unwrap(), plain);
    assert!(from_toml(&text.replace("master = 1", "master = 0")).is_err());
    // On other cranks, the same engine beside itself, and turning backwards.
    let on = |x, ratio| EngineOnCrank {
        engine: &star,
        crank: Crank { axis: [x, 0.0], ratio: SpeedRatio::whole(ratio) },
        delay: angle(40.0),
        tilt: angle(25.0),
        z: 0.5,
    };
    let both = Engine::on_cranks(&[on(0.0, 1), on(0.4, -1)], Hold::Pins).unwrap();
    check(&both);
    assert!(Engine::on_cranks(&[on(0.0, 1), on(0.4, -1)], Hold::Firing).is_err());
    // One bay of it is a star.
    let bays = both.bays();
    assert_eq!(both.of_bay(&bays[0]).unwrap().link_rods()[1].unwrap().master, 0);
    check(&star.with_first_tdc(angle(17.0)));
}

#[test]
fn link_rods_that_cannot_be_are_rejected_by_name() {
    let star = FIVE.engine(1.0, 1.0, "0");
    let with = |change: &dyn Fn(&mut LinkRod)| {
        let mut links = star.link_rods().to_vec();
        change(links[1].as_mut().unwrap());
        star.with_link_rods(links).unwrap_err().to_string()
    };
    assert!(with(&|link| link.master = 1).starts_with("link_rods[1].master = 2"));
    assert!(with(&|link| link.master = 2).contains("is a link itself"));
    assert!(with(&|link| link.radius = f64::NAN).starts_with("link_rods[1].radius"));
    assert!(with(&|link| link.big_end_mass = -1.0).starts_with("link_rods[1].big_end_mass"));
    let long = with(&|link| (link.radius, link.angle) = (0.2, angle(162.0)));
    assert!(
        long.starts_with("cylinder 2: rod_length = 0.178") && long.contains("make it longer"),
        "{long}"
    );
    assert!(star.with_link_rods(vec![None; 4]).is_err());
    let pins: Vec<Angle> = (0..5).map(|i| angle(10.0 * f64::from(i))).collect();
    assert!(star.with_pins(&pins).unwrap_err().to_string().contains("not on one crankpin"));
    let mut links = vec![None; 5];
    links[2] = Some(LinkRod { master: 1, radius: 0.05, angle: angle(72.0), big_end_mass: 0.0 });
    let other = Crank { axis: [0.3, 0.0], ratio: SpeedRatio::ONE };
    let two = star
        .with_link_rods(links)
        .unwrap()
        .with_cranks(vec![Crank::MAIN, other], vec![0, 0, 1, 1, 1]);
    assert!(two.unwrap_err().to_string().contains("not on one crankpin"));
    assert!(star.at_rod_ratio(0.3).unwrap_err().to_string().contains("link rods"));
}

#[test]
fn pressure_acts_on_a_link_from_its_own_highest_point() {
    let engine = FIVE.engine(1.0, 1.0, "3");
    for i in 1..5 {
        let delay = engine.chamber_delay(i).unwrap().degrees();
        let at = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            engine.mechanism(i).motion(&CrankPosition::new(sin, cos))
        };
        let motion = at(delay);
        assert!(motion.velocity.abs() < 1e-13 && motion.acceleration < 0.0, "{i}");
        assert!((0..360).all(|k| at(f64::from(k)).position <= motion.position + 1e-15));
        let begins = engine.firing_phase(i) - engine.stations()[i].tdc - angle(delay);
        assert!(begins.is_direction_of(Angle::ZERO));
    }
    assert!(engine.chamber_delay(0).is_none());
}
