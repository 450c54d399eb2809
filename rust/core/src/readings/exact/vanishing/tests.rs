use proptest::prelude::*;
use proptest::sample::select;

use std::sync::Arc;

use super::*;
use crate::engine::{
    ActsOn, Amplitudes, Crank, CrankIndex, Details, Gas, Hold, PeriodicLoad, Shaft, Station,
    Unbalance,
};
use crate::numbers::ratio::SpeedRatio;
use crate::pressure::{Cycle, Given};
use crate::search::{Bank, Criterion, Search};
use crate::{Angle, Cylinder};

fn engine(places: &[(f64, f64, f64, f64, f64)]) -> Engine {
    let place = |&(tdc, bank, z, mass, offset): &(f64, f64, f64, f64, f64)| Station {
        cylinder: Cylinder::new(0.05, 0.15, mass, offset).unwrap(),
        tdc: Angle::from_degrees(tdc).unwrap(),
        bank: Angle::from_degrees(bank).unwrap(),
        z,
        rotating_mass: 0.0,
    };
    Engine::new("", "", places.iter().map(place).collect()).unwrap()
}

/// At whole orders, without a firing order: by symbols alone, whatever the values of sums of inertia.
fn vanishing(
    engine: &Engine,
    orders: &[u32],
    reference: Option<f64>,
    cancel: &Cancel,
) -> Result<Vanishing> {
    let orders = Order::all_whole(orders)?;
    check_list(&orders)?;
    let known = || {
        let mut known = evaluated(engine, &orders, reference, true, cancel)?;
        for known in &mut known {
            known.wrench = Wrench::default();
        }
        Ok(known)
    };
    decided(&QUANTITIES, engine, known, (&orders, reference, None), cancel)
}

/// All but that of gas.
fn verdicts(engine: &Engine, order: u32) -> [Verdict; 9] {
    let found = vanishing(engine, &[order], None, &crate::Cancel::new()).unwrap();
    std::array::from_fn(|k| found.verdicts[0][QUANTITIES[k]])
}

const V: Verdict = Verdict::Vanishes;
const R: Verdict = Verdict::Remains;
const U: Verdict = Verdict::Undecided;

#[test]
fn an_inline_three() {
    let i3 = engine(&[0.0, 1.0, 2.0].map(|k| (120.0 * k, 90.0, 0.13 * k, 0.45, 0.0)));
    assert_eq!(verdicts(&i3, 1), [V, V, V, V, R, V, R, R, V]);
    assert_eq!(verdicts(&i3, 5), [V; 9]);
    assert_eq!(verdicts(&i3, 6), [V, R, R, R, V, V, V, V, R]);
}

#[test]
fn gas_has_half_orders_in_a_four_stroke_alone() {
    let i3 = Arc::new(engine(&[0.0, 1.0, 2.0].map(|k| (120.0 * k, 90.0, 0.1 * k, 0.45, 0.0))));
    let orders = [1, 2, 6].map(|halves| Order::from_halves(halves).unwrap());
    let found = |firing: Option<&Firing>| {
        let found = super::vanishing(&i3, &orders, None, firing, &crate::Cancel::new())?;
        Ok::<_, Error>(
            found
                .verdicts
                .iter()
                .map(|verdicts| verdicts[ProofQuantity::GasTorque])
                .collect::<Vec<_>>(),
        )
    };
    // All fire in the first turn: of order ½ 1 + e^{−60°} + e^{−120°} is left.
    for (strokes, expected) in [(Strokes::Two, [V, V, R]), (Strokes::Four, [R, V, R])] {
        let firing = Firing::with_later(&i3, strokes, &[false; 3]).unwrap();
        assert_eq!(found(Some(&firing)).unwrap(), expected);
    }
    assert!(found(None).unwrap_err().to_string().contains("need a firing order"));
}

/// Cylinders of unlike dimensions have no ratio that is known, but torques that are evaluated, of whatever size.
#[test]
fn gas_of_unlike_cylinders_remains_where_it_is_evaluated() {
    for size in [1e-3, 1.0, 50.0] {
        let mut stations =
            engine(&[0.0, 180.0].map(|tdc| (tdc, 90.0, 0.0, 0.4, 0.0))).stations().to_vec();
        for (station, radius) in stations.iter_mut().zip([0.05, 0.04]) {
            station.cylinder = Cylinder::new(size * radius, size * 0.15, 0.4, 0.0).unwrap();
        }
        let theta_deg: Vec<f64> = (0..72).map(|k| 10.0 * f64::from(k)).collect();
        let pressure = theta_deg.iter().map(|&theta| 1e5 * (2.0 - (0.01 * theta).cos())).collect();
        let given = Given { name: String::new(), strokes: 4, theta_deg, pressure, degree: None };
        let gas = Gas {
            cycles: vec![Arc::new(Cycle::new(given).unwrap())],
            cycle_of: vec![Some(0); 2],
            crank_ends: Vec::new(),
            crankcase: 1e5,
            later: vec![false; 2],
        };
        let bored = Details { bore: Some(size * 0.08), ..Details::default() };
        let plain = Engine::new("", "", stations).unwrap().with_details(vec![bored; 2]).unwrap();
        let fired = plain.with_gas(gas).unwrap();
        let order = [Order::from_halves(1).unwrap()];
        let firing = Firing::with_later(&Arc::new(plain.clone()), Strokes::Four, &[false; 2]);
        let firing = firing.unwrap();
        for (engine, firing, verdict) in [(&fired, None, R), (&plain, Some(&firing), U)] {
            let found =
                super::vanishing(engine, &order, None, firing, &crate::Cancel::new()).unwrap();
            assert_eq!(
                (
                    found.verdicts[0][ProofQuantity::GasTorque],
                    found.within_rounding[0][ProofQuantity::GasTorque]
                ),
                (verdict, false)
            );
        }
    }
}

/// Loads that are numbers cancel with nothing for certain, and leave what they do not act on.
#[test]
fn what_is_given_by_numbers_is_undecided() {
    let pair = engine(&[0.0, 180.0].map(|tdc| (tdc, 90.0, 0.0, 0.4, 0.0)));
    assert_eq!(verdicts(&pair, 1)[..2], [V, V]);
    let upward = PeriodicLoad {
        force: Amplitudes(vec![(2, vec![Complex64::new(30.0, 0.0)])]),
        direction_deg: Angle::QUARTER_TURN,
        ..PeriodicLoad::new("pump", ActsOn::Block)
    };
    let loaded = pair.with_loads(vec![upward]).unwrap();
    let found = vanishing(&loaded, &[1, 3], None, &crate::Cancel::new()).unwrap();
    assert_eq!((*found.verdicts[0])[..4], [V, U, U, U]);
    assert_eq!((*found.within_rounding[0])[..4], [true, false, false, false]);
    assert_eq!((*found.verdicts[1])[..4], [V; 4]);
    assert!(
        found.obstacles.iter().any(|text| text.starts_with("loads that were given by numbers"))
    );
}

/// A rod without a piston's mass has a torque all the same.
#[test]
fn rods_alone_have_torques() {
    let place = |tdc: f64| Station {
        cylinder: Cylinder::new(0.05, 0.15, 0.0, 0.0)
            .and_then(|cylinder| cylinder.with_rod_inertia_excess(0.01))
            .unwrap(),
        tdc: Angle::from_degrees(tdc).unwrap(),
        bank: Angle::QUARTER_TURN,
        z: 0.0,
        rotating_mass: 0.0,
    };
    let torque = |places: &[f64]| {
        let places = places.iter().map(|&tdc| place(tdc)).collect();
        verdicts(&Engine::new("", "", places).unwrap(), 2)[8]
    };
    assert_eq!([torque(&[0.0]), torque(&[0.0, 180.0]), torque(&[0.0, 90.0])], [R, R, V]);
}

/// The harmonic is below the smallest double, and known not to be zero by its sign.
#[test]
fn harmonics_that_underflow_remain() {
    let single = engine(&[(0.0, 90.0, 0.0, 0.45, 0.0)]);
    let force = single.mechanism(0).force(&[1000], &crate::Cancel::new());
    assert_eq!(force.unwrap()[0].norm(), 0.0);
    assert_eq!(verdicts(&single, 1000)[1], R);
}

/// The bank angles arg(−Z₂/Z₁) of Ito and Hattori are in general no parts of a turn.
#[test]
fn bank_angles_without_backward_moment_are_proved() {
    let cancel = crate::Cancel::new();
    let phases = [0.0, 90.0, 180.0, 270.0].map(|degrees| Angle::from_degrees(degrees).unwrap());
    for hold in [Hold::Firing, Hold::Pins] {
        let bank = Bank::with_phases(&phases).unwrap();
        let search = Search::new(bank, hold, &cancel).unwrap();
        // At 0° both banks are one.
        let angles = search.angles([1.0, 180.0], &cancel).unwrap();
        let mut irrational = 0;
        for k in 0..angles.count() {
            let found =
                search.solution(&angles, k, Criterion::SecondOrder, &cancel).unwrap().unwrap();
            let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
            let engine = found.engine(cylinder, 0.1).unwrap();
            assert_eq!(verdicts(&engine, 1)[7], V, "{}", found.bank_angle);
            let bank_angle = engine.banks().unwrap().angle();
            if bank_angle.turns().is_none() {
                irrational += 1;
                // Far beyond rounding, but no decimal of a few digits.
                let beside = Angle::from_degrees(bank_angle.degrees() + 1e-9 / 3.0).unwrap();
                let moved = engine.with_bank_angle(beside, hold).unwrap();
                assert_ne!(verdicts(&moved, 1)[7], V, "{}", found.bank_angle);
            }
        }
        assert!(irrational > 2, "{irrational}");
    }
}

#[test]
fn decimals_of_spacing_count_as_even() {
    // 0.3 is not 3 · 0.1 in doubles; an evenly spaced inline-4 has no moment all the same.
    let i4 = |last| {
        let tdc_z = [(0.0, 0.0), (180.0, 0.1), (180.0, 0.2), (0.0, last)];
        engine(&tdc_z.map(|(tdc, z)| (tdc, 90.0, z, 0.45, 0.0)))
    };
    assert_eq!(verdicts(&i4(0.3), 1)[..8], [V; 8]);
    assert_eq!(verdicts(&i4(0.3001), 1)[4], R);
}

#[test]
fn irrational_banks_cancel_bank_by_bank_or_not_at_all() {
    // Each bank by itself is an inline-3 in one plane: no force whatever the angle.
    let banks = |b: f64| [0.0, 1.0, 2.0].map(|k| (120.0 * k, b, 0.1 * k, 0.45, 0.0));
    let v6 = engine(&[banks(61.234_567_891_2), banks(118.765_432_108_8)].concat());
    assert_eq!(verdicts(&v6, 1)[..4], [V; 4]);
    assert_eq!(verdicts(&v6, 1)[4..8], [U; 4]);
    assert_eq!(verdicts(&v6, 1)[8], V);
    // One bank alone: the direction is a factor, and not zero.
    assert_eq!(verdicts(&engine(&banks(61.234_567_891_2)), 1)[4..8], [R; 4]);
}

#[test]
fn rows_that_are_no_part_of_a_turn_apart_cancel_row_by_row() {
    // As in a VR6: two rows of three, evenly spaced, the second 22.123456° later.
    let row = |tdc: f64, bank: f64, z: f64| {
        [0.0, 1.0, 2.0].map(|k| (120.0 * k + tdc, bank, z, 0.45, 0.0))
    };
    let vr6 = engine(&[row(0.0, 82.5, 0.0), row(22.123_456_789_1, 97.5, 0.0)].concat());
    assert_eq!(verdicts(&vr6, 2), [V; 9]);
    assert_eq!(verdicts(&vr6, 6)[..4], [U; 4]);
    assert_eq!(verdicts(&vr6, 6)[8], U);
}

#[test]
fn proportions_that_differ_cancel_group_by_group() {
    let mut places = [0.0, 180.0].map(|tdc| (tdc, 90.0, 0.0, 0.45, 0.001)).to_vec();
    assert_eq!(verdicts(&engine(&places), 1)[..4], [V; 4]);
    // Opposite offsets have the same even orders, and odd ones of opposite sign.
    places[1].4 = -0.001;
    assert_eq!(verdicts(&engine(&places), 2)[1], R);
    places[1].0 = 90.0;
    assert_eq!(verdicts(&engine(&places), 2)[1], V);
    places[1].0 = 0.0;
    assert_eq!(verdicts(&engine(&places), 3)[1], V);
    assert_eq!(verdicts(&engine(&places), 1)[1], R);
    // Another offset is another slider-crank.
    places[1] = (90.0, 90.0, 0.0, 0.45, 0.002);
    assert_eq!(verdicts(&engine(&places), 2)[1], U);
}

#[test]
fn rotating_mass_counts_as_a_reciprocating_one_at_order_one() {
    // A 90° twin on one pin: reciprocating forces add to a forward one of half its size each.
    let twin = engine(&[(0.0, 45.0, 0.0, 0.5, 0.0), (90.0, 135.0, 0.0, 0.5, 0.0)]);
    assert_eq!(verdicts(&twin, 1)[..4], [R, R, R, V]);
    // Turning masses that make up for a piston between them: 2·0.5/2 forward at 90° and 270°.
    let mut places =
        engine(&[(0.0, 90.0, 0.0, 0.5, 0.0), (180.0, 90.0, 0.0, 0.0, 0.0)]).stations().to_vec();
    places[1].rotating_mass = 0.25;
    let countered = Engine::new("", "", places).unwrap();
    assert_eq!(verdicts(&countered, 1)[..4], [R, R, V, R]);
}

#[test]
fn what_is_in_the_way_is_named() {
    let obstacles = |engine: &Engine, order| {
        vanishing(engine, &[order], None, &crate::Cancel::new()).unwrap().obstacles
    };
    let place = (0.0, 90.0, 0.0, 0.45, 0.0);
    let (tdc, bank) =
        ((17.123_456_789_1, 90.0, 0.0, 0.45, 0.0), (0.0, 61.234_567_891_2, 0.0, 0.45, 0.0));
    let (rod, mass) =
        ((90.0, 90.0, 0.0, 0.45, 0.002), (180.0, 90.0, 0.0, 0.45 * 2_f64.sqrt(), 0.0));
    // At an order that is decided nothing is in the way.
    assert_eq!(obstacles(&engine(&[place, place]), 2), [""; 0]);
    assert_eq!(obstacles(&engine(&[bank, bank]), 2), [""; 0]);
    // Neither are places along the crank that are multiples of one length.
    let further = (17.123_456_789_1, 90.0, 0.1, 0.45, 0.0);
    assert_eq!(obstacles(&engine(&[place, further]), 2).len(), 1);
    assert_eq!(
        obstacles(&engine(&[place, tdc]), 2),
        ["tdc_deg is no simple part of a turn in cylinders 2"]
    );
    assert_eq!(
        obstacles(&engine(&[place, bank, bank]), 2),
        ["bank_deg is no simple part of a turn in cylinders 2, 3"]
    );
    assert_eq!(
        obstacles(&engine(&[place, rod]), 2),
        [
            "slider-cranks of different proportions",
            "cylinders of different dimensions, whose gas torques have no ratio"
        ]
    );
    assert_eq!(
        obstacles(&engine(&[place, mass]), 2),
        ["masses times radius that are no rational multiples of each other"]
    );
    let spread = [0.0, 0.1, 0.1 + 0.1 * 2_f64.sqrt(), 0.4].map(|z| (0.0, 90.0, z, 0.45, 0.0));
    assert_eq!(
        obstacles(&engine(&spread), 2),
        ["places that are no rational multiples of each other"]
    );
}

/// 2/7 is 2/7 as typed: 0.06/0.21 and 0.04/0.14 are other doubles.
#[test]
fn proportions_are_equal_as_typed() {
    assert_ne!(0.14 / 0.04, 0.21 / 0.06);
    let place = |(radius, rod, mass, offset), tdc| Station {
        cylinder: Cylinder::new(radius, rod, mass, offset).unwrap(),
        tdc: Angle::from_degrees(tdc).unwrap(),
        bank: Angle::QUARTER_TURN,
        z: 0.0,
        rotating_mass: 0.0,
    };
    let sizes = |e: f64| [(0.04, 0.14, 0.6, 2.0 * e), (0.06, 0.21, 0.4, 3.0 * e)];
    for [small, large] in [sizes(0.0), sizes(0.001)] {
        let twin = Engine::new("", "", vec![place(small, 0.0), place(large, 90.0)]).unwrap();
        assert_eq!(verdicts(&twin, 2)[..8], [V; 8]);
        assert_eq!(verdicts(&twin, 2)[8], R);
        let form = |moment| {
            super::super::closed_form::closed_form(
                &twin,
                Order::whole(2).unwrap(),
                moment,
                None,
                &Cancel::new(),
            )
        };
        assert!(form(false).unwrap().phasors[1].square.iter().all(|&c| c == 0));
    }
    // Masses of five digits, no simple fraction of each other: 480.13 of 510 with 510 of 480.13.
    let mut places = engine(&[(0.0, 90.0, 0.0, 0.480_13, 0.0), (90.0, 90.0, 0.0, 0.51, 0.0)]);
    assert_eq!(verdicts(&places, 2)[1], R);
    let mut swapped = places.stations().to_vec();
    swapped[0].cylinder = Cylinder::new(0.051, 0.153, 0.480_13, 0.0).unwrap();
    swapped[1].cylinder = Cylinder::new(0.048_013, 0.144_039, 0.51, 0.0).unwrap();
    places = Engine::new("", "", swapped).unwrap();
    assert_eq!(verdicts(&places, 2)[1], V);
}

/// Cylinders of few kinds, so that sums vanish now and then; m·r² of some is 1, the unit of rods.
fn stations() -> impl Strategy<Value = Vec<Station>> {
    let root = 2.0_f64.sqrt();
    let mass = select(vec![400.0, 800.0, 400.0 * root]);
    let cylinder = (mass, select(vec![0.0, 0.001, -0.001, 0.002, 0.003]), select(vec![0.0, 0.3]));
    let cylinder = cylinder.prop_map(|(mass, offset, inertia)| {
        let cylinder = Cylinder::new(0.05, 0.15, mass, offset).unwrap();
        cylinder.with_rod_inertia_excess(inertia).unwrap()
    });
    let tdc = select(vec![0.0, 90.0, 120.0, 180.0, 240.0, 17.123_456_789_1, 107.123_456_789_1]);
    let bank = select(vec![0.0, 60.0, 90.0, 120.0, 61.234_567_891_2]);
    let z = select(vec![0.0, 0.1, 0.2, 0.1 * root]);
    let place = (cylinder, tdc, bank, z, select(vec![0.0, 200.0])).prop_map(
        |(cylinder, tdc, bank, z, rotating_mass)| Station {
            cylinder,
            tdc: Angle::from_degrees(tdc).unwrap(),
            bank: Angle::from_degrees(bank).unwrap(),
            z,
            rotating_mass,
        },
    );
    let half = Angle::HALF_TURN;
    // With each a second one that differs in few things.
    let pair = (place, any::<[bool; 4]>()).prop_map(move |(p, [tdc, bank, offset, rod])| {
        let c = p.cylinder;
        let e = if offset { -c.pin_offset() } else { c.pin_offset() };
        let second = Cylinder::new(0.05, 0.15, c.reciprocating_mass(), e).unwrap();
        let inertia = if rod { c.rod_inertia_excess() } else { 0.0 };
        let second = Station {
            cylinder: second.with_rod_inertia_excess(inertia).unwrap(),
            tdc: if tdc { p.tdc + half } else { p.tdc },
            bank: if bank { p.bank + half } else { p.bank },
            ..p
        };
        [p, second]
    });
    proptest::collection::vec(pair, 1..3).prop_map(|pairs| pairs.concat())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1024))]

    #[test]
    fn what_is_proved_is_so(
        stations in stations(),
        reference in select(vec![None, Some(0.0), Some(0.05), Some(0.05 * 2.0_f64.sqrt())]),
    ) {
        let engine = Engine::new("", "", stations).unwrap();
        let orders = [1, 2, 3, 4];
        let found = vanishing(&engine, &orders, reference, &crate::Cancel::new()).unwrap();
        // Nothing of these kinds is near zero without being zero.
        for (verdicts, zeros) in found.verdicts.iter().zip(&found.within_rounding) {
            for (&verdict, &zero) in verdicts.iter().zip(zeros) {
                prop_assert!(verdict == U || (verdict == V) == zero, "{:?}", verdicts);
            }
        }
    }
}

/// Unbalances of the sizes of [`stations`], on the crankshaft, at a pin of it, and on shafts.
fn weights() -> impl Strategy<Value = (Vec<Unbalance>, Vec<Shaft>)> {
    let angles = vec![0.0, 60.0, 180.0, 270.0, 61.234_567_891_2, 241.234_567_891_2];
    let unbalance = || {
        let amount = select(vec![10.0, 20.0, 2.5, 10.0 * 2.0_f64.sqrt()]);
        let place = select(vec![0.0, 0.1, 0.2, 0.1 * 2.0_f64.sqrt()]);
        (amount, select(angles.clone()), place).prop_map(|(amount, degrees, z)| Unbalance {
            amount,
            angle: Angle::from_degrees(degrees).unwrap(),
            z,
            pin: None,
            crank: CrankIndex::MAIN,
        })
    };
    let arm = || select(vec![0.0, 0.1, -0.1, 0.2, 0.1 * 2.0_f64.sqrt()]);
    // Each shaft with a second unbalance, opposite the first one or not.
    let shaft = (select(vec![1, -1, 2, -2, 4, -3, 6]), [arm(), arm()], unbalance(), any::<bool>())
        .prop_map(|(ratio, axis, first, twice)| {
            let second = Unbalance { angle: first.angle + Angle::HALF_TURN, ..first };
            let unbalances = if twice { vec![first, second] } else { vec![first] };
            let ratio = SpeedRatio::from_halves(ratio);
            Shaft { name: String::new(), ratio, axis, unbalances }
        });
    let on_crank = (unbalance(), select(vec![None, Some(0), Some(1)]))
        .prop_map(|(unbalance, pin)| Unbalance { pin, ..unbalance });
    (proptest::collection::vec(on_crank, 0..3), proptest::collection::vec(shaft, 0..3))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1024))]

    #[test]
    fn verdicts_on_shafts_are_true_and_obstacles_named(
        stations in stations(),
        (counterweights, shafts) in weights(),
        reference in select(vec![None, Some(0.0), Some(0.05), Some(1000.0)]),
    ) {
        let engine = Engine::new("", "", stations)
            .and_then(|engine| engine.with_counterweights(counterweights))
            .and_then(|engine| engine.with_shafts(shafts))
            .unwrap();
        let found = vanishing(&engine, &[1, 2, 3], reference, &crate::Cancel::new()).unwrap();
        for (verdicts, zeros) in found.verdicts.iter().zip(&found.within_rounding) {
            for (&verdict, &zero) in verdicts.iter().zip(zeros) {
                prop_assert!(verdict == U || (verdict == V) == zero, "{:?} {:?}", verdicts, zeros);
            }
        }
        let undecided = found.verdicts.iter().flatten().any(|&verdict| verdict == U);
        prop_assert_eq!(undecided, !found.obstacles.is_empty(), "{:?}", found.verdicts);
    }
}

#[test]
fn an_undecided_roll_torque_of_a_shaft_is_named() {
    let unbalance =
        Unbalance { amount: 10.0, angle: Angle::ZERO, z: 0.0, pin: None, crank: CrankIndex::MAIN };
    let shaft = Shaft {
        name: String::new(),
        ratio: SpeedRatio::ONE,
        axis: [0.0, 0.1],
        unbalances: vec![unbalance],
    };
    let engine = engine(&[(0.0, 0.0, 0.0, 400.0, 0.0)]).with_shafts(vec![shaft]).unwrap();
    let found = vanishing(&engine, &[1], None, &crate::Cancel::new()).unwrap();
    assert_eq!(found.verdicts[0][ProofQuantity::Torque], U);
    assert_eq!(found.obstacles, ["roll torques of shafts, no rational multiples of pistons'"]);
}

#[test]
fn roll_torques_of_shafts_cancel_where_one_leads_by_a_quarter() {
    let cancel = crate::Cancel::new();
    for ratio in [1, -1, 2, -2, 3, -3] {
        // Torques of the two pistons are opposite at this order.
        let apart = 180.0 / f64::from(ratio).abs();
        let twin = engine(&[0.0, apart].map(|tdc| (tdc, 90.0, 0.0, 0.5, 0.0)));
        let torque = |beside: f64, above: f64| {
            let shaft = |axis, degrees: f64| {
                let angle = Angle::from_degrees(degrees).unwrap();
                let unbalance =
                    Unbalance { amount: 0.004, angle, z: 0.1, pin: None, crank: CrankIndex::MAIN };
                let ratio = SpeedRatio::whole(ratio);
                Shaft { name: String::new(), ratio, axis, unbalances: vec![unbalance] }
            };
            let shafts = vec![shaft([0.1, 0.0], beside), shaft([0.0, 0.1], above)];
            let engine = twin.with_shafts(shafts).unwrap();
            let found = vanishing(&engine, &[i32::unsigned_abs(ratio)], None, &cancel).unwrap();
            assert_eq!(
                found.verdicts[0][ProofQuantity::Torque] == V,
                found.within_rounding[0][ProofQuantity::Torque],
                "{ratio}"
            );
            found.verdicts[0][ProofQuantity::Torque]
        };
        // x·sin(α + ρθ) − y·cos(β + ρθ) with x = y is zero for α = β + 90°.
        for above in [0.0, 37.0, 61.234_567_891_2] {
            assert_eq!(torque(above + 90.0, above), V, "{ratio} {above}");
            assert_eq!(torque(above - 90.0, above), R, "{ratio} {above}");
            assert_eq!(torque(above, above), R, "{ratio} {above}");
        }
    }
}

#[test]
fn far_reference_planes_neither_prove_nor_undo_zeros() {
    let i4 = |last: f64| {
        let tdc_z = [(0.0, 0.0), (180.0, 0.1), (180.0, 0.2), (0.0, last)];
        engine(&tdc_z.map(|(tdc, z)| (tdc, 90.0, z, 0.45, 0.0)))
    };
    let about = |last: f64, plane: f64| {
        let found = vanishing(&i4(last), &[1, 2], Some(plane), &crate::Cancel::new());
        found.unwrap().verdicts.iter().map(|verdicts| verdicts.to_vec()).collect::<Vec<_>>()
    };
    for plane in [0.0, 1000.0, 1e6, 1e14, -1e14, 12_345.678_9] {
        // Forces of order 1 are in balance, so that no plane changes their couple.
        assert_eq!(about(0.3, plane)[0][..8], [V; 8], "{plane}");
        // 0 − 0.1 − 0.2 + 0.31 is not zero.
        assert_eq!(about(0.31, plane)[0][..8], [V, V, V, V, R, V, R, R], "{plane}");
        // About a plane so far away the force of order 2 has a moment.
        assert_eq!(about(0.3, plane)[1][4..8], [R, V, R, R], "{plane}");
    }
    // About the plane in the middle it has none.
    assert_eq!(about(0.3, 0.15)[1][4..8], [V; 4]);
}

#[test]
fn rod_inertia_that_nearly_cancels_torque_is_never_a_false_proof() {
    let single = |inertia: f64| {
        let cylinder = Cylinder::new(0.045, 0.158, 0.5, 0.0).unwrap();
        let cylinder = cylinder.with_rod_inertia_excess(inertia).unwrap();
        let place = engine(&[(0.0, 90.0, 0.0, 0.5, 0.0)]).stations()[0];
        Engine::new("", "", vec![Station { cylinder, ..place }]).unwrap()
    };
    let of = |inertia: f64| {
        let found = vanishing(&single(inertia), &[1], None, &crate::Cancel::new()).unwrap();
        (
            found.verdicts[0][ProofQuantity::Torque],
            found.within_rounding[0][ProofQuantity::Torque],
            !found.obstacles.is_empty(),
        )
    };
    let mechanism = single(0.0).mechanism(0);
    let cancel = crate::Cancel::new();
    let [masses, rod] = [mechanism.torque(&[1], &cancel), mechanism.swing_torque(&[1], &cancel)]
        .map(|torque| torque.unwrap().roll[0]);
    let cancelling = -(masses / rod).re * single(0.0).stations()[0].cylinder.mass_radius_squared();
    // To four digits it is that of the rod at hand.
    assert!((cancelling / -2.558e-4 - 1.0).abs() < 1e-3, "{cancelling}");
    for inertia in [-2.558e-4, 2.558e-4, cancelling * (1.0 + 1e-5), cancelling * (1.0 - 1e-5)] {
        assert_eq!(of(inertia), (R, false, false), "{inertia}");
    }
    // More than 1e-9 of what the masses and the rod make each.
    for off in [3e-9, -3e-9, 1e-8, 1e-7] {
        assert_eq!(of(cancelling * (1.0 + off)).0, R, "{off}");
    }
    for off in [0.0, 1e-16, -1e-15, 1e-14, -1e-13, 1e-12, 1e-11] {
        let (verdict, _, obstacles) = of(cancelling * (1.0 + off));
        assert_eq!((verdict, obstacles), (U, true), "{off}");
    }
    for k in 0..200 {
        let (verdict, zero, _) = of(cancelling * (1.0 + 10_f64.powf(-16.0 + 0.06 * f64::from(k))));
        assert!(verdict == U || !zero);
    }
}

#[test]
fn pin_offsets_beside_rotating_masses_are_an_obstacle() {
    // Order 1 of an offset has a phase of its own, with no rational relation to what rotates.
    let places = engine(&[(0.0, 90.0, 0.0, 0.5, 0.001), (120.0, 90.0, 0.1, 0.5, 0.001)]);
    let turning = |p: &Station| Station { rotating_mass: 0.25, ..*p };
    let places = places.stations().iter().map(turning).collect();
    let found = vanishing(&Engine::new("", "", places).unwrap(), &[1], None, &crate::Cancel::new())
        .unwrap();
    assert!(found.verdicts[0].contains(&U));
    assert_eq!(
        found.obstacles,
        ["pin offsets: harmonics with no rational relation to what rotates"]
    );
}

#[test]
fn what_is_out_of_reach_is_told_once() {
    // Parts of a turn whose common denominator is beyond what is tested.
    let tdc = |parts: i64| Angle::from_degree_fraction(360, parts).unwrap();
    let places = engine(&[(0.0, 90.0, 0.0, 0.45, 0.0); 2]).stations().to_vec();
    let places = [
        Station { tdc: tdc(1_000_003), ..places[0] },
        Station { tdc: tdc(1_000_033), ..places[1] },
    ];
    let engine = Engine::new("", "", places.to_vec()).unwrap();
    let found = vanishing(&engine, &[1, 2, 4], None, &crate::Cancel::new()).unwrap();
    let moments = 4..8;
    for verdicts in &found.verdicts {
        assert!(verdicts.iter().take(4).all(|&v| v == U));
        assert!(verdicts.iter().take(moments.end).skip(moments.start).all(|&v| v == V));
    }
    let mut told = found.obstacles.clone();
    assert!(
        !told.is_empty() && told.iter().all(|text| text.contains("common denominator")),
        "{told:?}"
    );
    told.sort();
    told.dedup();
    assert_eq!(told.len(), found.obstacles.len());
}

#[test]
fn floating_point_finds_the_same_zeros() {
    let i3 = engine(&[0.0, 1.0, 2.0].map(|k| (120.0 * k, 90.0, 0.13 * k, 0.45, 0.0)));
    let boxer = engine(&[(0.0, 0.0, 0.0, 0.45, 0.0), (0.0, 180.0, 0.1, 0.45, 0.0)]);
    let unlike = engine(&[(0.0, 90.0, 0.0, 0.45, 0.0), (180.0, 90.0, 0.2, 0.9, 0.0)]);
    for engine in [i3, boxer, unlike] {
        for reference in [None, Some(0.0), Some(0.05), Some(0.07)] {
            let orders = [1, 2, 3, 4, 6];
            let cancel = crate::Cancel::new();
            let found = vanishing(&engine, &orders, reference, &cancel).unwrap();
            assert_eq!(found.within_rounding.len(), orders.len());
            for (verdicts, zeros) in found.verdicts.iter().zip(&found.within_rounding) {
                assert_eq!(verdicts.map_to(|v| *v == V), *zeros, "{reference:?}");
                assert!(!verdicts.contains(&U));
            }
        }
    }
}

#[test]
fn orders_and_planes_are_checked() {
    let single = engine(&[(0.0, 90.0, 0.0, 0.5, 0.0)]);
    let cancel = crate::Cancel::new();
    assert!(vanishing(&single, &[], None, &cancel).is_err());
    assert!(vanishing(&single, &[1], Some(f64::NAN), &cancel).is_err());
    cancel.raise();
    assert_eq!(vanishing(&single, &[1], None, &cancel), Err(Error::Cancelled));
}

/// A cylinder in whole numbers: times 0.01 m, 0.01 kg·m, 0.1 m and parts of 15°.
#[derive(Debug, Clone, Copy)]
struct Whole {
    /// Rods of one ratio to different radii among them; 0 for one that is infinite.
    rod: i64,
    radius: i64,
    offset: i64,
    /// Masses times radius: of what reciprocates, and of what turns.
    weights: [i64; 2],
    tdc: i64,
    bank: i64,
    z: i64,
    /// Speed of its crank over the main one's.
    ratio: i64,
}

impl Whole {
    fn station(&self) -> Station {
        let [mass, rotating_mass] = self.weights.map(|weight| weight as f64 / self.radius as f64);
        // Quotients of whole numbers are the doubles that a user types.
        let radius = self.radius as f64 / 100.0;
        let (rod, offset) = match self.rod {
            0 => (f64::INFINITY, 0.0),
            rod => {
                ((rod * self.radius) as f64 / 200.0, (self.offset * self.radius) as f64 / 1000.0)
            }
        };
        let angle = |parts: i64| Angle::from_degree_fraction(15 * parts, 1).unwrap();
        Station {
            cylinder: Cylinder::new(radius, rod, mass, offset).unwrap(),
            tdc: angle(self.tdc),
            bank: angle(self.bank),
            z: self.z as f64 / 10.0,
            rotating_mass,
        }
    }

    /// Its harmonics at a multiple of the speed of its own crank, with factors: of the force, or of the torque. By
    /// what offsets of one size have in common, or all of each.
    fn harmonics(&self, own: i64, torque: bool, in_common: bool) -> Vec<(String, i64)> {
        let offset = if self.rod == 0 { 0 } else { self.offset };
        let (size, sign) = (offset.abs(), offset.signum());
        let of = |part: &str, of: i64| format!("{part} {} {} {of}", self.rod, self.ratio.abs());
        match (torque, own % 2 == 1) {
            (true, _) if self.rod == 0 && own != 2 => vec![],
            (true, _) if in_common => {
                vec![(of("even torque", size), 1), (of("odd torque", size), sign)]
            }
            (true, _) => vec![(of("torque", offset), 1)],
            (false, _) if self.rod == 0 || own == 1 && offset == 0 => {
                if own == 1 {
                    vec![("one".into(), 1)]
                } else {
                    vec![]
                }
            }
            (false, true) if offset == 0 => vec![],
            (false, odd) if in_common => {
                let own_part = (of("force", size), if odd { sign } else { 1 });
                if own == 1 { vec![("one".into(), 1), own_part] } else { vec![own_part] }
            }
            (false, _) => vec![(of("force", offset), 1)],
        }
    }
}

/// Whether a sum of 24th roots of unity is zero: its remainder by their polynomial, x⁸ − x⁴ + 1.
fn is_zero(mut sum: [i64; 24]) -> bool {
    for k in (8..24).rev() {
        let of = std::mem::take(&mut sum[k]);
        sum[k - 4] += of;
        sum[k - 8] -= of;
    }
    sum == [0; 24]
}

/// The verdict of plain sums: nothing left of any harmonic, or of one alone.
fn plainly(cylinders: &[Whole], quantity: usize, order: i64, plane: Option<i64>) -> Verdict {
    let z = || cylinders.iter().map(|of| of.z);
    // Halves of 0.1 m.
    let plane = plane.unwrap_or(z().min().unwrap() + z().max().unwrap());
    let verdict = |in_common: bool| {
        let mut sums: BTreeMap<String, [i64; 24]> = BTreeMap::new();
        let mut add = |name: String, weight: i64, turns: i64| {
            sums.entry(name).or_insert([0; 24])[turns.rem_euclid(24) as usize] += weight;
        };
        for of in cylinders.iter().filter(|of| order % of.ratio.abs() == 0) {
            let own = order / of.ratio.abs();
            if quantity == 8 {
                for (name, factor) in of.harmonics(own, true, in_common) {
                    let weight = of.weights[0] * of.radius * of.ratio.signum();
                    add(name, weight * factor, -order * of.tdc);
                }
                continue;
            }
            let lever = if quantity < 4 { 1 } else { 2 * of.z - plane };
            // Of forward and of conjugate backward parts; a moment about x is made by what acts along y.
            let signs = match quantity {
                0 | 5 => [1, 1],
                1 | 4 => [1, -1],
                2 | 6 => [1, 0],
                _ => [0, 1],
            };
            for (sense, sign) in [1, -1].into_iter().zip(signs) {
                for (name, factor) in of.harmonics(own, false, in_common) {
                    let weight = of.weights[0] * of.ratio.pow(2) * lever;
                    add(name, weight * factor * sign, sense * of.bank - order * of.tdc);
                }
                if own == 1 && of.ratio.signum() == sense {
                    let weight = 2 * of.weights[1] * of.ratio.pow(2) * lever;
                    add("one".into(), weight * sign, sense * of.bank - order * of.tdc);
                }
            }
        }
        match sums.into_values().filter(|sum| !is_zero(*sum)).count() {
            0 => V,
            1 => R,
            _ => U,
        }
    };
    let [apart, in_common] = [false, true].map(verdict);
    if apart == U { in_common } else { apart }
}

fn wholes(kinds: Vec<[i64; 3]>, ratios: Vec<i64>) -> impl Strategy<Value = Vec<Whole>> {
    let one = (
        select(kinds),
        [select(vec![4, 4, 8]), select(vec![0, 0, 2])],
        select(vec![0, 6, 8, 12, 16, 18, 23]),
        select(vec![0, 4, 6, 18]),
        0_i64..3,
        select(ratios),
    );
    let one = one.prop_map(|([rod, radius, offset], weights, tdc, bank, z, ratio)| Whole {
        rod,
        radius,
        offset,
        weights,
        tdc,
        bank,
        z,
        ratio,
    });
    // With each one that differs in few things, by which sums vanish.
    let pair = (one, any::<[bool; 5]>()).prop_map(|(of, [tdc, bank, offset, z, ratio])| {
        let turned = |angle: i64, by: bool| angle + if by { 12 } else { 0 };
        let second = Whole {
            tdc: turned(of.tdc, tdc),
            bank: turned(of.bank, bank),
            offset: if offset { -of.offset } else { of.offset },
            z: if z { of.z } else { 0 },
            ratio: if ratio { -of.ratio } else { of.ratio },
            ..of
        };
        [of, second]
    });
    proptest::collection::vec(pair, 1..4).prop_map(|pairs| pairs.concat())
}

fn assert_plain(cylinders: &[Whole], plane: Option<i64>) {
    let (mut cranks, mut crank_of) = (vec![Crank::MAIN], Vec::new());
    for of in cylinders {
        let crank = Crank { axis: [0.0; 2], ratio: SpeedRatio::whole(of.ratio as i32) };
        crank_of.push(cranks.iter().position(|own| *own == crank).unwrap_or_else(|| {
            cranks.push(crank);
            cranks.len() - 1
        }));
    }
    let stations = cylinders.iter().map(Whole::station).collect();
    let engine = Engine::new("", "", stations).unwrap().with_cranks(cranks, crank_of).unwrap();
    let orders = [1, 2, 3, 4, 6];
    let reference = plane.map(|plane| plane as f64 / 20.0);
    let found = vanishing(&engine, &orders, reference, &Cancel::new()).unwrap();
    for (order, verdicts) in orders.into_iter().zip(&found.verdicts) {
        for (quantity, &verdict) in verdicts.iter().take(9).enumerate() {
            let expected = plainly(cylinders, quantity, order.into(), plane);
            assert_eq!(verdict, expected, "{order} {:?} {cylinders:?}", QUANTITIES[quantity]);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Neither more nor less is proved than sums of whole numbers prove: of cylinders of different rods and radii,
    /// with pin offsets on either side, and on cranks of any speed.
    #[test]
    fn as_much_is_proved_as_plain_sums_prove(
        rods in wholes(vec![[6, 5, 0], [6, 10, 0], [8, 5, 0], [0, 5, 0]], vec![1]),
        offsets in wholes(vec![[6, 5, 1], [6, 5, -1], [6, 10, 1], [6, 5, 2], [6, 5, 0]], vec![1]),
        cranks in wholes(vec![[6, 5, 0], [8, 10, 0], [6, 5, 1], [0, 5, 0]], vec![1, -1, 2, -2]),
        plane in select(vec![None, None, Some(0), Some(3), Some(-4)]),
    ) {
        for cylinders in [rods, offsets, cranks] {
            assert_plain(&cylinders, plane);
        }
    }
}

/// Whatever the symbols, a sum is not zero where its value is beyond any error; nearer to zero nothing is known.
#[test]
fn sums_beyond_any_error_of_their_values_remain() {
    let rods = [0.15, 0.2].map(|rod| Cylinder::new(0.05, rod, 0.5, 0.0).unwrap());
    let second = rods.map(|rod| rod.mechanism().force(&[2], &crate::Cancel::new()).unwrap()[0].re);
    let verdicts = |off: f64| {
        // A quarter of a turn apart forces of order 2 are opposite.
        let mut places =
            engine(&[0.0, 90.0].map(|tdc| (tdc, 90.0, 0.0, 0.5, 0.0))).stations().to_vec();
        let mass = 0.5 * second[0] / second[1] * (1.0 + off);
        places[1].cylinder = Cylinder::new(0.05, 0.2, mass, 0.0).unwrap();
        let orders = Order::all_whole(&[2]).unwrap();
        let engine = Engine::new("", "", places).unwrap();
        let found = super::vanishing(&engine, &orders, None, None, &crate::Cancel::new()).unwrap();
        let along_y = ProofQuantity::ForceY;
        assert_eq!(found.verdicts[0][ProofQuantity::ForceX], V);
        (found.verdicts[0][along_y], found.within_rounding[0][along_y], found.obstacles.is_empty())
    };
    assert_eq!(verdicts(0.0), (U, true, false));
    assert_eq!(verdicts(1e-12), (U, false, false));
    for off in [1e-6, -1e-6, 0.5] {
        let (verdict, is_zero, _) = verdicts(off);
        assert_eq!((verdict, is_zero), (R, false), "{off}");
    }
}

/// Torques of order 1 of unlike rods cancel at no angle that is known: only forces of one size do.
#[test]
fn torques_of_unlike_rods_are_not_proved_to_cancel() {
    let mut stations =
        engine(&[0.0, 90.0].map(|tdc| (tdc, 90.0, 0.0, 0.5, 0.0))).stations().to_vec();
    stations[1].cylinder = Cylinder::new(0.05, 0.2, 0.5, 0.0).unwrap();
    assert_eq!(verdicts(&Engine::new("", "", stations).unwrap(), 1)[8], U);
}

/// Wherever the engine stands: of the two banks one is at an angle that is no part of a turn, or both are.
#[test]
fn backward_moments_stay_proved_as_the_engine_is_turned() {
    let cancel = crate::Cancel::new();
    let phases = [0.0, 90.0, 180.0, 270.0].map(|degrees| Angle::from_degrees(degrees).unwrap());
    let bank = Bank::with_phases(&phases).unwrap();
    let search = Search::new(bank, Hold::Firing, &cancel).unwrap();
    let angles = search.angles([1.0, 180.0], &cancel).unwrap();
    let mut proved = 0;
    for k in 0..angles.count() {
        let found = search.solution(&angles, k, Criterion::SecondOrder, &cancel).unwrap().unwrap();
        let engine = found.engine(Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap(), 0.1).unwrap();
        let banks = engine.banks().unwrap();
        if banks.angle().turns().is_some() {
            continue;
        }
        let right = engine.stations().iter().map(|place| place.bank.degrees()).reduce(f64::min);
        for to in [0.0, 50.0] {
            let turned = engine.stations().iter().map(|place| {
                let bank = if place.bank.degrees() == right.unwrap() {
                    to
                } else {
                    to + banks.angle().degrees()
                };
                Station { bank: Angle::from_degrees(bank).unwrap(), ..*place }
            });
            let turned = Engine::new("", "", turned.collect()).unwrap();
            assert_eq!(verdicts(&turned, 1)[7], V, "{} {to}", found.bank_angle);
            proved += 1;
        }
    }
    assert!(proved > 4, "{proved}");
}

/// Nothing says at which turn a cycle of a faster crank begins.
#[test]
fn gas_of_faster_cranks_is_undecided() {
    let twin = engine(&[0.0, 90.0].map(|tdc| (tdc, 90.0, 0.0, 0.5, 0.0)));
    let faster = Crank { axis: [0.0; 2], ratio: SpeedRatio::whole(2) };
    let twin = twin.with_cranks(vec![Crank::MAIN, faster], vec![1, 1]).unwrap();
    let found = vanishing(&twin, &[1, 2], None, &crate::Cancel::new()).unwrap();
    for (verdicts, within) in found.verdicts.iter().zip(&found.within_rounding) {
        let gas = ProofQuantity::GasTorque;
        assert_eq!((verdicts[gas], within[gas]), (U, false));
    }
    assert!(found.obstacles.iter().any(|text| text.starts_with("gas on cranks of other speeds")));
}

#[test]
fn unbalances_at_angles_that_are_no_parts_of_a_turn_are_named() {
    let weight = |degrees: f64| Unbalance {
        amount: 0.02,
        angle: Angle::from_degrees(degrees).unwrap(),
        z: 0.0,
        pin: None,
        crank: CrankIndex::MAIN,
    };
    let named = |degrees: f64| {
        let weights = vec![weight(degrees), weight(31.0)];
        let single = engine(&[(0.0, 90.0, 0.0, 0.5, 0.0)]).with_counterweights(weights).unwrap();
        let found = vanishing(&single, &[1], None, &crate::Cancel::new()).unwrap();
        found.obstacles.iter().any(|text| text.starts_with("angles of unbalances"))
    };
    assert!(named(61.234_567_891_2_f64.sqrt()));
    assert!(!named(61.0));
}
