//! Unbalances of the crankshaft and of balance shafts, against sums over time written out.

mod common;

use std::f64::consts::TAU;

use common::random::{angles, engines, stations, vees, weighted};
use common::{InArrays, angle, by_orders, changed, kinematics, scales, turning, whole, xy};
use crankpin_core::balance::{Vector, balance};
use crankpin_core::engine::CrankIndex;
use crankpin_core::exact::vanishing::{ProofQuantity as Sum, Verdict, vanishing};
use crankpin_core::quantity::Quantity;
use crankpin_core::sweep::{Statistic, SweepAxes};
use crankpin_core::wrench::{Torque, Wrench};
use crankpin_core::{
    Angle, Balance, Cancel, Complex64, Crank, CrankAngles, Cylinder, Engine, Hold, Order, Orders,
    Request, Shaft, SpeedRatio, Station, Sweep, Unbalance, waveform,
};
use proptest::prelude::*;

const TORQUE: Quantity<'static> = Quantity::TORQUE;
const CRANK_TORQUE: Quantity<'static> = Quantity::CRANK_TORQUE;

const ORDERS: [u32; 5] = [1, 2, 3, 4, 6];
const REQUEST: Request = Request { rpm: 3000.0, reference_z: Some(0.0), torque: true };
const VECTORS: [Vector; 2] = [Vector::Force, Vector::Moment];

fn square() -> f64 {
    (3000.0 * TAU / 60.0).powi(2)
}

fn of(engine: &Engine) -> Balance {
    by_orders(engine, &REQUEST, &ORDERS)
}

/// Size that rounding is relative to: of force, moment and torque of every load.
fn size(engine: &Engine) -> f64 {
    let pistons = engine.stations().iter().map(|p| {
        let c = p.cylinder;
        (c.mass_radius() + p.rotating_mass * c.crank_radius()) * (1.0 + p.z.abs())
            + c.mass_radius_squared()
            + c.rod_inertia_excess().abs()
    });
    let on_crank = engine.counterweights().iter().map(|u| u.amount * (1.0 + u.z.abs()));
    let on_shafts = engine.shafts().iter().flat_map(|shaft| {
        let [x, y] = shaft.axis;
        let arm = 1.0 + x.hypot(y);
        let square = shaft.ratio.number().powi(2);
        shaft.unbalances.iter().map(move |u| square * u.amount * (arm + u.z.abs()))
    });
    pistons.chain(on_crank).chain(on_shafts).sum::<f64>() * square()
}

/// Equal to rounding: sums of some twenty terms, of angles to 1024° at order 6.
#[track_caller]
fn same(a: Complex64, b: Complex64, size: f64) {
    assert!((a - b).norm() <= 2e-13 * size, "{a} is not {b} (of {size})");
}

/// Force x, y, moment x, y, roll and crank torque of a balance at a crank angle.
fn sum_of_orders(balance: &Balance, θ: f64) -> [f64; 6] {
    let mut sums = [0.0; 6];
    for (k, order) in balance.orders.iter().enumerate() {
        let unit = Complex64::cis(order.number() * θ);
        let ([a, b], [c, d]) = (balance.xy(Vector::Force, k), balance.xy(Vector::Moment, k));
        let Torque { roll, crank, .. } = balance.wrenches[k].torque;
        for (sum, phasor) in sums.iter_mut().zip([a, b, c, d, roll, crank]) {
            *sum += (phasor * unit).re;
        }
    }
    sums
}

/// Weights wherever they are: at a pin or not, as free ones.
fn freed(engine: &Engine) -> Vec<Unbalance> {
    let free = |weight: &Unbalance| {
        let pin = weight.pin.map_or(Angle::ZERO, |i| engine.pin(i));
        Unbalance { angle: (weight.angle + pin).reduced(), pin: None, ..*weight }
    };
    engine.counterweights().iter().map(free).collect()
}

const HALF: Angle = Angle::HALF_TURN;

/// Orders ½, 1, 1½ … up to one.
fn halves_up_to(order: u32) -> Vec<Order> {
    (1..=2 * order).map(|halves| Order::from_halves(halves).unwrap()).collect()
}

fn shaft(ratio: SpeedRatio, axis: [f64; 2], unbalances: Vec<Unbalance>) -> Shaft {
    Shaft { name: String::new(), ratio, axis, unbalances }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn balances_and_waveforms_are_plain_sums(engine in weighted(engines(true))) {
        let thetas: Vec<f64> = (0..16).map(|k| 7.0 + 45.0 * f64::from(k)).collect();
        let cancel = Cancel::new();
        let exact = waveform::exact(&engine, &REQUEST, &thetas, &cancel).unwrap();
        // λ ≤ 1/1.8 and e ≤ r/2: order 120 is below 1e-20.
        let all = Orders::Given(halves_up_to(120));
        let summed = waveform::from_orders(&engine, &REQUEST, &thetas, &all, &cancel).unwrap();
        let balance = summed.balance.as_ref().unwrap();
        // Motion written out plainly loses digits to cancellation where rods are short; 120 orders
        // lose 120 roundings.
        let slack = 2e-12 * size(&engine);
        let (roll, crank) = (exact.torque.unwrap(), exact.crank_torque.unwrap());
        for (i, θ) in thetas.iter().map(|θ| θ.to_radians()).enumerate() {
            let plain = kinematics(&engine, 0.0, θ).0.map(|value| value * square());
            let row = [exact.force.row(i).to_vec(), exact.moment.row(i).to_vec()].concat();
            let row = [row, vec![roll[i], crank[i]]].concat();
            let orders = sum_of_orders(balance, θ);
            for k in 0..6 {
                prop_assert!((row[k] - plain[k]).abs() <= slack, "{} {} {}", k, row[k], plain[k]);
                prop_assert!((orders[k] - plain[k]).abs() <= slack, "{} {}", k, orders[k]);
            }
        }
    }

    #[test]
    fn sweeps_over_bank_angle_move_the_weights_that_are_at_pins(
        engine in weighted(vees()),
        bank_angles in proptest::collection::vec(0.0..180.0, 1..4),
        firing in any::<bool>(),
        reference in -0.3..0.3,
    ) {
        let hold = if firing { Hold::Firing } else { Hold::Pins };
        let axes = SweepAxes {
            bank_angle: Some((bank_angles.clone(), hold)),
            rpm: vec![3000.0],
            ..SweepAxes::default()
        };
        let engines = vec![engine.clone().into()];
        let sweep = Sweep::new(engines, axes, &Orders::whole(&ORDERS).unwrap(), Some(reference), true, &Cancel::new()).unwrap();
        let cancel = Cancel::new();
        let all = [Quantity::FORCE, Quantity::MOMENT, TORQUE, CRANK_TORQUE];
        let phasors =
            all.map(|quantity| sweep.phasors(quantity, Statistic::Amplitude, &cancel).unwrap());
        let thetas = [10.0, 133.0];
        let waves = all.map(|quantity| {
            let shape = sweep.waveform_shape(quantity, thetas.len()).unwrap();
            let mut out = vec![f64::NAN; shape.iter().product()];
            let angles = CrankAngles::new(&thetas).unwrap();
            sweep.waveforms(quantity, &angles, true, &mut out, &cancel).unwrap();
            out
        });
        let banks = engine.banks().unwrap();
        for (i, &bank_angle) in bank_angles.iter().enumerate() {
            let half = Angle::from_degrees(0.5 * bank_angle).unwrap();
            let turned = changed(&engine, |p| {
                let right = p.bank == banks.directions[0];
                let bank = if right { banks.bisector() - half } else { banks.bisector() + half };
                let tdc = if firing { p.tdc } else { bank - Crank::MAIN.pin(p.bank, p.tdc) };
                Station { bank, tdc, ..*p }
            });
            // With pins held a pin and its weight stay; with the firing held they follow the bank.
            let weights = if firing { freed(&turned) } else { freed(&engine) };
            let there = turned.with_counterweights(weights).unwrap();
            let request = Request { reference_z: Some(reference), ..REQUEST };
            let alone = by_orders(&there, &request, &ORDERS);
            let size = 2.0 * size(&there);
            for k in 0..ORDERS.len() {
                for (vector, phasors) in VECTORS.into_iter().zip(&phasors) {
                    for (axis, expected) in alone.xy(vector, k).into_iter().enumerate() {
                        same(phasors[[0, i, 0, 0, 0, 0, k, axis]], expected, size);
                    }
                }
                let torque = alone.wrenches[k].torque;
                same(phasors[2][[0, i, 0, 0, 0, 0, k]], torque.roll, size);
                same(phasors[3][[0, i, 0, 0, 0, 0, k]], torque.crank, size);
            }
            for (j, θ) in thetas.iter().map(|θ: &f64| θ.to_radians()).enumerate() {
                let plain = kinematics(&there, reference, θ).0.map(|value| value * square());
                let at = thetas.len() * i + j;
                let [force, moment] = [&waves[0], &waves[1]].map(|w| [w[2 * at], w[2 * at + 1]]);
                let found = [force[0], force[1], moment[0], moment[1], waves[2][at], waves[3][at]];
                for (found, plain) in found.into_iter().zip(plain) {
                    prop_assert!((found - plain).abs() <= 1e-12 * size, "{} {}", found, plain);
                }
            }
        }
    }

    #[test]
    fn adding_and_removing_weights_is_the_identity(
        engine in weighted(engines(true)), amount in 0.0..0.1, at in angles(), z in -0.5..0.5,
        ratio in prop_oneof![Just(1), Just(-2), Just(4), Just(-3)],
    ) {
        let before = of(&engine);
        let weight = Unbalance { amount, angle: at, z, pin: None, crank: CrankIndex::MAIN };
        let opposite = Unbalance { angle: at + HALF, ..weight };
        let on_crank = |more: &[Unbalance]| {
            let all = [engine.counterweights(), more].concat();
            engine.with_counterweights(all).unwrap()
        };
        let on_shaft = |more: &[Unbalance]| {
            let more = vec![shaft(SpeedRatio::from_halves(ratio), [0.1, -0.2], more.to_vec())];
            engine.with_shafts([engine.shafts(), &more].concat()).unwrap()
        };
        let added = on_crank(&[weight]);
        let removed = added.with_counterweights(engine.counterweights().to_vec()).unwrap();
        prop_assert_eq!(&removed, &engine);
        prop_assert_eq!(&of(&removed), &before);
        let removed = on_shaft(&[weight]).with_shafts(engine.shafts().to_vec()).unwrap();
        prop_assert_eq!(of(&removed), before.clone());
        for engine in [on_crank(&[weight, opposite]), on_shaft(&[weight, opposite])] {
            let after = of(&engine);
            for (a, b) in before.wrenches.iter().zip(&after.wrenches) {
                for (a, b) in [(a.force, b.force), (a.moment, b.moment)] {
                    same(a.forward, b.forward, size(&engine));
                    same(a.backward_conj, b.backward_conj, size(&engine));
                }
                same(a.torque.roll, b.torque.roll, size(&engine));
                same(a.torque.crank, b.torque.crank, size(&engine));
            }
        }
    }

    #[test]
    fn turning_the_crank_only_shifts_phases(engine in weighted(engines(true)), by in angles()) {
        let turned = engine.with_first_tdc(engine.stations()[0].tdc + by);
        let (before, after) = (of(&engine), of(&turned));
        for ((a, b), n) in before.wrenches.iter().zip(&after.wrenches).zip(ORDERS) {
            let phase = by.cis(-i64::from(n));
            for (a, b) in [(a.force, b.force), (a.moment, b.moment)] {
                same(a.forward * phase, b.forward, size(&engine));
                same(a.backward_conj * phase, b.backward_conj, size(&engine));
            }
            same(a.torque.roll * phase, b.torque.roll, size(&engine));
            same(a.torque.crank * phase, b.torque.crank, size(&engine));
        }
        for θ in [0.3, 2.0, 4.4] {
            let earlier = θ - by.degrees().to_radians();
            let [a, b] = [(&engine, earlier), (&turned, θ)]
                .map(|(engine, θ)| kinematics(engine, 0.0, θ).0);
            for (a, b) in a.into_iter().zip(b) {
                prop_assert!((a - b).abs() * square() <= 1e-12 * size(&engine), "{} {}", a, b);
            }
        }
    }

    /// Seen from the front: the crank turns the same way again once time runs backward.
    #[test]
    fn mirrored_engines_run_backward_in_time(engine in weighted(engines(true))) {
        let upside = |weight: &Unbalance| {
            let angle = if weight.pin.is_some() { -weight.angle } else { HALF - weight.angle };
            Unbalance { angle, ..*weight }
        };
        let mirrored = changed(&engine, |p| {
            let c = p.cylinder;
            let (r, l, m) = (c.crank_radius(), c.rod_length(), c.reciprocating_mass());
            let cylinder = Cylinder::new(r, l, m, -c.pin_offset()).unwrap();
            let cylinder = cylinder.with_rod_inertia_excess(c.rod_inertia_excess()).unwrap();
            Station { cylinder, tdc: -p.tdc, bank: HALF - p.bank, ..*p }
        });
        let shafts = engine.shafts().iter().map(|s| {
            shaft(s.ratio, [-s.axis[0], s.axis[1]], s.unbalances.iter().map(upside).collect())
        });
        let mirrored = mirrored
            .with_counterweights(engine.counterweights().iter().map(upside).collect())
            .and_then(|mirrored| mirrored.with_shafts(shafts.collect()))
            .unwrap();
        for (a, b) in of(&engine).wrenches.iter().zip(&of(&mirrored).wrenches) {
            for (a, b, sign) in [(a.force, b.force, -1.0), (a.moment, b.moment, 1.0)] {
                same(a.forward.conj() * sign, b.forward, size(&engine));
                same(a.backward_conj.conj() * sign, b.backward_conj, size(&engine));
            }
            same(-a.torque.roll.conj(), b.torque.roll, size(&engine));
            same(-a.torque.crank.conj(), b.torque.crank, size(&engine));
        }
    }

    /// What turns with the crank turns against it in a mirror: a shaft at +1 becomes one at −1.
    #[test]
    fn mirrors_swap_forward_and_backward(engine in weighted(engines(true))) {
        let mirror = |ratio: SpeedRatio, [x, y]: [f64; 2], unbalances: &[Unbalance]| {
            let unbalances = unbalances.iter();
            let unbalances = unbalances.map(|u| Unbalance { angle: HALF - u.angle, ..*u });
            shaft(SpeedRatio::from_halves(-ratio.halves()), [-x, y], unbalances.collect())
        };
        let engine = changed(&engine, |p| Station { rotating_mass: 0.0, ..*p });
        // The crankshaft's unbalances are on a shaft of ratio −1 there.
        let mut shafts = vec![mirror(SpeedRatio::ONE, [0.0; 2], &freed(&engine))];
        shafts.extend(engine.shafts().iter().map(|s| mirror(s.ratio, s.axis, &s.unbalances)));
        let mirrored = changed(&engine, |p| Station { bank: HALF - p.bank, ..*p });
        let mirrored = mirrored.with_counterweights(vec![]).unwrap().with_shafts(shafts).unwrap();
        let without = engine.with_counterweights(vec![]).unwrap().with_shafts(vec![]).unwrap();
        let found = [&engine, &mirrored, &without].map(of);
        for k in 0..ORDERS.len() {
            let [a, b, pistons] = found.each_ref().map(|balance| &balance.wrenches[k]);
            for (a, b, sign) in [(a.force, b.force, -1.0), (a.moment, b.moment, 1.0)] {
                same(a.forward * sign, b.backward_conj, size(&engine));
                same(a.backward_conj * sign, b.forward, size(&engine));
            }
            // The torque of a piston depends on its crank angle alone.
            let [a, b, pistons] = [a, b, pistons].map(|wrench| wrench.torque.roll);
            same(pistons - a, b - pistons, size(&engine));
        }
    }

    /// Half of each reciprocating mass as bob weight opposite its pin leaves the forward part of a pin
    /// offset alone, ½(a₁ − 1) of m·r·ω², and the backward part as it is.
    #[test]
    fn half_the_reciprocating_mass_opposite_each_pin_removes_the_forward_first_order(
        stations in proptest::collection::vec(stations(true), 1..9),
        centred in any::<bool>(),
    ) {
        let no_offset = |mut p: Station| {
            let c = p.cylinder;
            p.cylinder = Cylinder::new(c.crank_radius(), c.rod_length(), c.reciprocating_mass(), 0.0)
                .unwrap();
            p
        };
        let stations = stations.into_iter().map(|p| if centred { no_offset(p) } else { p });
        let plain = Engine::new("", "", stations.collect()).unwrap();
        let opposite = |i: usize, amount: f64, z: f64| {
            Unbalance { amount, angle: HALF, z, pin: Some(i), crank: CrankIndex::MAIN }
        };
        let bob = plain.stations().iter().enumerate().flat_map(|(i, p)| {
            let c = p.cylinder;
            let rotating = p.rotating_mass * c.crank_radius();
            [opposite(i, 0.5 * c.mass_radius(), p.z), opposite(i, rotating, p.z)]
        });
        let balanced = plain.with_counterweights(bob.collect()).unwrap();
        let [before, after] = [&plain, &balanced].map(of);
        let (mut force, mut moment) = (Complex64::default(), Complex64::default());
        for p in plain.stations() {
            let a1 = p.cylinder.mechanism().force(&[1], &Cancel::new());
            let left = (a1.unwrap()[0] - 1.0) * (0.5 * p.cylinder.mass_radius() * square());
            force += left * Crank::MAIN.pin(p.bank, p.tdc).cis(1);
            moment += Complex64::i() * p.z * left * Crank::MAIN.pin(p.bank, p.tdc).cis(1);
        }
        for (vector, left) in VECTORS.into_iter().zip([force, moment]) {
            let [forward, backward] = turning(&after, vector)[0];
            same(forward, left, size(&plain));
            same(backward, turning(&before, vector)[0][1], size(&plain));
            prop_assert!(!centred || forward == Complex64::default());
        }
        // Higher orders and torques stay.
        for (a, b) in before.wrenches.iter().zip(&after.wrenches).skip(1) {
            // But for bounds of rounding, which count all loads.
            let [a, b] = [a, b].map(|Wrench { force, moment, torque }| {
                let parts = [force, moment].map(|of| [of.forward, of.backward_conj]);
                (parts, [torque.roll, torque.crank])
            });
            prop_assert_eq!(a, b);
        }
        if centred {
            let found = vanishing(&balanced, &[Order::FIRST], None, None, &Cancel::new()).unwrap();
            for sum in [Sum::ForceForward, Sum::MomentForward] {
                let verdict = found.verdicts[0][sum];
                prop_assert_eq!(verdict, Verdict::Vanishes, "{:?} {:?}", sum, found.obstacles);
            }
        }
    }

    #[test]
    fn wrenches_move_as_those_of_waveforms(
        engine in weighted(engines(true)), by in [-0.5..0.5, -0.5..0.5, -0.5..0.5],
    ) {
        let [x, y, z] = by;
        let here = of(&engine);
        let there = by_orders(&engine, &Request { reference_z: Some(z), ..REQUEST }, &ORDERS);
        let size = 3.0 * size(&engine);
        for (a, b) in here.wrenches.iter().zip(&there.wrenches) {
            let moved = a.moved(by);
            same(moved.moment.forward, b.moment.forward, size);
            same(moved.moment.backward_conj, b.moment.backward_conj, size);
            prop_assert_eq!((moved.force, moved.torque.crank), (a.force, a.torque.crank));
            // M′ = M − a × F about z: in time, F(θ) at (x, y, z) has no roll torque about that point.
            let [force_x, force_y] = a.force.xy(0.0);
            for θ in [0.0, 0.7, 2.9] {
                let at = |phasor: Complex64| phasor * Complex64::cis(θ);
                let lost = x * at(force_y).re - y * at(force_x).re;
                let found = at(moved.torque.roll).re - at(a.torque.roll).re;
                prop_assert!((found + lost).abs() <= 1e-13 * size, "{} {}", found, lost);
            }
            let back = moved.moved([-x, -y, -z]);
            same(back.moment.forward, a.moment.forward, size);
            same(back.moment.backward_conj, a.moment.backward_conj, size);
            same(back.torque.roll, a.torque.roll, size);
            let in_steps = a.moved([x, 0.0, 0.0]).moved([0.0, y, z]);
            same(in_steps.torque.roll, moved.torque.roll, size);
            same(in_steps.moment.forward, moved.moment.forward, size);
        }
    }

    /// Orders are dropped from the smallest up while each sum stays within its tolerance, and what is
    /// reported bounds what they add.
    #[test]
    fn few_orders_are_those_of_a_plain_search(
        engine in weighted(engines(true)), digits in 0.3..9.0_f64,
    ) {
        let rtol = 10_f64.powf(-digits);
        let chosen = balance(&engine, &REQUEST, &Orders::Auto { rtol }, &Cancel::new()).unwrap();
        let allowed = scales(&engine, 0.0).map(|scale| rtol * scale * square());
        // Order 120 of these cranks is below 1e-20.
        let orders = halves_up_to(120);
        let given = Orders::Given(orders.clone());
        let all = balance(&engine, &REQUEST, &given, &Cancel::new()).unwrap();
        let sizes = |n: Order| {
            let Wrench { force, moment, torque } = all.wrenches[n.halves() as usize - 1];
            [force.peak(), moment.peak(), torque.roll.norm().max(torque.crank.norm())]
        };
        let share = |n: Order| {
            let parts = sizes(n).into_iter().zip(allowed);
            parts.map(|(size, most)| if size > 0.0 { size / most } else { 0.0 }).fold(0.0, f64::max)
        };
        let mut rising = orders.clone();
        rising.sort_by(|&a, &b| share(a).total_cmp(&share(b)));
        let plainly = |part: f64| {
            let (mut lost, mut kept) = ([0.0; 3], Vec::new());
            for &n in &rising {
                let with = [0, 1, 2].map(|sum| lost[sum] + sizes(n)[sum]);
                if (0..3).all(|sum| sizes(n)[sum] == 0.0 || with[sum] <= part * allowed[sum]) {
                    lost = with;
                } else {
                    kept.push(n);
                }
            }
            kept
        };
        // Orders above the last candidate take up to a hundredth of the tolerance.
        let [kept, strictly] = [plainly(1.0), plainly(0.99)];
        prop_assert!((kept.len()..=strictly.len()).contains(&chosen.orders.len()));
        for (sum, bound) in chosen.error_bound.values().into_iter().enumerate() {
            prop_assert!(bound <= allowed[sum] * (1.0 + 1e-12));
            let left = orders.iter().filter(|&&n| !chosen.orders.contains(&n));
            let lost: f64 = left.map(|&n| sizes(n)[sum]).sum();
            let slack = 1e-12 * lost + 1e-15 * size(&engine);
            prop_assert!(bound - lost <= 0.01 * allowed[sum] + slack, "{sum} {bound} {lost}");
            prop_assert!(lost - bound <= slack, "{sum} {bound} {lost}");
        }
        // Waveforms of these orders are within it of the exact ones.
        let thetas: Vec<f64> = (0..45).map(|k| f64::from(k) * 8.0).collect();
        let cancel = Cancel::new();
        let exact = waveform::exact(&engine, &REQUEST, &thetas, &cancel).unwrap();
        let given = Orders::Auto { rtol };
        let summed = waveform::from_orders(&engine, &REQUEST, &thetas, &given, &cancel).unwrap();
        prop_assert_eq!(summed.balance.as_ref(), Some(&chosen));
        let rounding = 1e-13 * size(&engine);
        let planar = [(&exact.force, &summed.force), (&exact.moment, &summed.moment)];
        for ((a, b), bound) in planar.into_iter().zip(chosen.error_bound.values()) {
            for (a, b) in a.rows().into_iter().zip(b.rows()) {
                prop_assert!((a[0] - b[0]).hypot(a[1] - b[1]) <= bound + rounding);
            }
        }
        let (exact, summed) = ([exact.torque, exact.crank_torque], [summed.torque, summed.crank_torque]);
        for (a, b) in exact.into_iter().flatten().flatten().zip(summed.into_iter().flatten().flatten())
        {
            prop_assert!((a - b).abs() <= chosen.error_bound.torque + rounding);
        }
    }
}

/// An upright inline-4 without its shafts, and one of its cylinders.
fn inline_four() -> (Engine, Cylinder) {
    let cylinder = Cylinder::new(0.043, 0.145, 0.66, 0.0).unwrap();
    let place = |(k, tdc): (usize, f64)| Station {
        cylinder,
        tdc: angle(tdc),
        bank: Angle::QUARTER_TURN,
        z: 0.1 * k as f64,
        rotating_mass: 0.0,
    };
    let places = [0.0, 180.0, 180.0, 0.0].into_iter().enumerate().map(place);
    (Engine::new("", "", places.collect()).unwrap(), cylinder)
}

/// Two shafts at twice the speed of the crank, A turning with it, that remove order 2 of the force.
fn lanchester(a: [f64; 2], b: [f64; 2]) -> (Engine, Balance) {
    let (i4, cylinder) = inline_four();
    let a2 = cylinder.mechanism().force(&[2], &Cancel::new()).unwrap()[0];
    let amount = cylinder.mass_radius() * a2.re / 2.0;
    // The force points up at the first top dead centre, the weights down.
    let down =
        Unbalance { amount, angle: angle(270.0), z: 0.15, pin: None, crank: CrankIndex::MAIN };
    let shafts = vec![
        shaft(SpeedRatio::whole(2), a, vec![down]),
        shaft(SpeedRatio::whole(-2), b, vec![down]),
    ];
    let engine = i4.with_shafts(shafts).unwrap();
    let request = Request { reference_z: None, ..REQUEST };
    (engine.clone(), by_orders(&engine, &request, &[2]))
}

/// Order 2 of the roll torque of the block without shafts, 4·m·r²·ω²·b₂ sin 2θ, and half the force
/// that shafts remove.
fn second_order() -> (f64, f64, f64) {
    let (i4, cylinder) = inline_four();
    let mechanism = cylinder.mechanism();
    let torque = mechanism.torque(&[2], &Cancel::new()).unwrap().roll[0];
    let b2 = -torque.im;
    let a2 = mechanism.force(&[2], &Cancel::new()).unwrap()[0].re;
    let found = by_orders(&i4, &REQUEST, &[2]);
    let expected = Complex64::new(0.0, -4.0 * cylinder.mass_radius_squared() * b2 * square());
    same(found.wrenches[0].torque.roll, expected, expected.norm());
    let force = 4.0 * cylinder.mass_radius() * a2 * square();
    same(found.xy(Vector::Force, 0)[1], force.into(), force);
    (b2, a2, force / 2.0)
}

#[test]
fn lanchester_shafts_remove_order_two_of_an_inline_four() {
    let (b2, a2, half_force) = second_order();
    // About ½ and about λ = 0.297.
    assert!((b2 - 0.5).abs() < 0.01 && (a2 - 0.043 / 0.145).abs() < 0.02);
    let (_, cylinder) = inline_four();
    let apart = 2.0 * b2 * cylinder.crank_radius() / a2;
    // A little under one rod length.
    assert!((0.9..1.0).contains(&(apart / cylinder.rod_length())), "{apart}");
    // Wherever the lower one is, and as long as the two are on either side alike.
    for (low, side) in [(0.0, 0.0), (-0.06, 0.08), (0.02, -0.11)] {
        let (_, found) = lanchester([side, low + apart], [-side, low]);
        assert_eq!(xy(&found, Vector::Force), [[Complex64::default(); 2]]);
        assert_eq!(xy(&found, Vector::Moment), [[Complex64::default(); 2]]);
        let torque = half_force * apart;
        assert!(found.wrenches[0].torque.roll.norm() < 1e-12 * torque);
        // Exchanged, the shafts double it.
        let (_, found) = lanchester([side, low], [-side, low + apart]);
        same(found.wrenches[0].torque.roll, Complex64::new(0.0, -2.0 * torque), torque);
    }
    // At one height they leave it; beside the crank they add −(x_A + x_B)(F₂/2) cos 2θ.
    let (_, found) = lanchester([0.05, 0.03], [0.02, 0.03]);
    let expected = Complex64::new(-0.07 * half_force, -apart * half_force);
    same(found.wrenches[0].torque.roll, expected, expected.norm());
}

#[test]
fn one_counter_rotating_shaft_leaves_a_rolling_couple() {
    // Order 1 of an upright single at 50 %: ½·m·r·ω² turns backward; a shaft at −1 removes it, and
    // leaves its force times its distance from the crank.
    let cylinder = Cylinder::new(0.04, 0.13, 0.5, 0.0).unwrap();
    let place = Station {
        cylinder,
        tdc: Angle::ZERO,
        bank: Angle::QUARTER_TURN,
        z: 0.0,
        rotating_mass: 0.0,
    };
    let amount = 0.5 * cylinder.mass_radius();
    let bob = Unbalance { amount, angle: HALF, z: 0.0, pin: Some(0), crank: CrankIndex::MAIN };
    let down =
        Unbalance { amount, angle: angle(270.0), z: 0.0, pin: None, crank: CrankIndex::MAIN };
    let single = Engine::new("", "", vec![place]).unwrap();
    let with = |axis| {
        let engine = single.with_counterweights(vec![bob]).unwrap();
        engine.with_shafts(vec![shaft(SpeedRatio::whole(-1), axis, vec![down])]).unwrap()
    };
    let engine = with([0.1, 0.0]);
    let found = of(&engine);
    assert_eq!(turning(&found, Vector::Force)[0], [Complex64::default(); 2]);
    let proved = vanishing(&engine, &[Order::FIRST], None, None, &Cancel::new()).unwrap();
    assert_eq!((*proved.verdicts[0])[..8], [Verdict::Vanishes; 8]);
    // Down at θ = 0, at x = 0.1: −0.1·U·ω² cos θ beside what the block has without.
    let roll = |balance: &Balance| balance.wrenches[0].torque.roll;
    let left = roll(&found) - roll(&of(&single));
    same(left, Complex64::new(-0.1 * amount * square(), 0.0), size(&engine));
    // On the crank axis none.
    assert_eq!(roll(&of(&with([0.0; 2]))), roll(&of(&single)));
}

#[test]
fn half_orders_of_inertia_are_zero() {
    let engine = common::weighted();
    let half = |halves| Order::from_halves(halves).unwrap();
    let orders = vec![half(1), half(4), half(3)];
    let given = Orders::Given(orders.clone());
    let found = balance(&engine, &REQUEST, &given, &Cancel::new()).unwrap();
    assert_eq!([found.wrenches[0], found.wrenches[2]], [Wrench::default(); 2]);
    assert_eq!(found.wrenches[1], by_orders(&engine, &REQUEST, &[2]).wrenches[0]);
    let axes = SweepAxes {
        bank_angle: Some((vec![72.0, 90.0], Hold::Pins)),
        rpm: vec![3000.0],
        ..SweepAxes::default()
    };
    let sweep = |orders| {
        Sweep::new(
            vec![engine.clone()],
            axes.clone(),
            &Orders::Given(orders),
            Some(0.0),
            true,
            &Cancel::new(),
        )
    };
    let (all, second) = (sweep(orders).unwrap(), sweep(whole(&[2])).unwrap());
    for quantity in [Quantity::FORCE, Quantity::MOMENT, TORQUE, CRANK_TORQUE] {
        let lengths =
            |sweep: &Sweep| sweep.peaks(quantity, Statistic::Length, &Cancel::new()).unwrap();
        let (all, second) = (lengths(&all), lengths(&second));
        for angle in 0..2 {
            let row = [0, 1, 2].map(|order| all[[0, angle, 0, 0, 0, 0, order]]);
            assert_eq!(row, [0.0, second[[0, angle, 0, 0, 0, 0, 0]], 0.0]);
            assert!(row[1] > 0.0);
        }
    }
}
