//! Sweeps: each point is the balance of the engine that stands there, whatever else is swept.

mod common;

use std::sync::Arc;

use common::{
    InArrays, alone, by_orders, changed, geared, in_line, mixed, places, plain, random, scales,
    there, turning, weighted, whole, xy,
};
use crankpin_core::balance::Vector;
use crankpin_core::engine::CrankIndex;
use crankpin_core::peaks::PeakFinder;
use crankpin_core::quantity::{Part, Quantity};
use crankpin_core::slider_crank::Proportions;
use crankpin_core::sweep::{Statistic, SweepAxes};
use crankpin_core::{
    Angle, Balance, Cancel, Complex64, CrankAngles, Cylinder, Engine, Error, Hold, Orders, Request,
    Shaft, Spectrum, SpeedRatio, Station, Sweep, Unbalance, harmonics,
};
use proptest::prelude::*;

const TORQUE: Quantity<'static> = Quantity::TORQUE;
const CRANK_TORQUE: Quantity<'static> = Quantity::CRANK_TORQUE;

const QUANTITIES: [Quantity; 4] = [Quantity::FORCE, Quantity::MOMENT, TORQUE, CRANK_TORQUE];
const REFERENCE: f64 = 0.07;
const REQUEST: Request = Request { rpm: 3000.0, reference_z: Some(REFERENCE), torque: true };

/// The engine with the force of its cylinders given, if one is.
fn given(engine: &Arc<Engine>, spectrum: Option<&Spectrum>) -> Arc<Engine> {
    spectrum.map_or_else(
        || Arc::clone(engine),
        |spectrum| Arc::new(engine.with_spectrum(spectrum.clone())),
    )
}

fn sweep(
    engines: &[Arc<Engine>],
    axes: &SweepAxes,
    orders: &[u32],
    spectrum: Option<&Spectrum>,
) -> Sweep {
    let reference = Some(REFERENCE);
    let engines = engines.iter().map(|engine| given(engine, spectrum)).collect();
    Sweep::new(
        engines,
        axes.clone(),
        &Orders::whole(orders).unwrap(),
        reference,
        true,
        &Cancel::new(),
    )
    .unwrap()
}

fn phasors(sweep: &Sweep, quantity: Quantity, figure: Statistic) -> Vec<Complex64> {
    let phasors = sweep.phasors(quantity, figure, &Cancel::new()).unwrap();
    assert_eq!(phasors.shape(), sweep.result_shape(quantity, figure));
    phasors.into_raw_vec_and_offset().0
}

fn peaks(sweep: &Sweep, quantity: Quantity, figure: Statistic) -> Vec<f64> {
    let cancel = Cancel::new();
    let peaks = sweep.peaks(quantity, figure, &cancel).unwrap();
    assert_eq!(peaks.shape(), sweep.result_shape(quantity, figure));
    // All that was to be done was done.
    let (done, total) = cancel.progress();
    assert!(done == total && total > 0, "{done} of {total}");
    peaks.into_raw_vec_and_offset().0
}

fn components(quantity: Quantity) -> usize {
    if is_torque(quantity) { 1 } else { 2 }
}

fn is_torque(quantity: Quantity) -> bool {
    matches!(quantity, TORQUE | CRANK_TORQUE)
}

/// Phasors of a quantity, order by order and component by component, forward and backward parts, bounds of
/// rounding errors, and lengths, order by order.
struct OfBalance {
    phasors: Vec<Complex64>,
    turning: Vec<[Complex64; 2]>,
    bounds: Vec<f64>,
    lengths: Vec<f64>,
}

impl OfBalance {
    fn new(balance: &Balance, quantity: Quantity) -> Self {
        let all = 0..balance.orders.len();
        let vector = match quantity {
            Quantity::FORCE => Vector::Force,
            Quantity::MOMENT => Vector::Moment,
            _ => {
                assert!(balance.has_torque);
                let of = |torque: &crankpin_core::wrench::Torque| match quantity {
                    TORQUE => torque.roll,
                    _ => torque.crank,
                };
                let bound = |k| {
                    let [of_roll, of_crank] = balance.torque_zero_bounds(Part::Whole, k);
                    if quantity == TORQUE { of_roll } else { of_crank }
                };
                let phasors: Vec<_> =
                    balance.wrenches.iter().map(|wrench| of(&wrench.torque)).collect();
                return Self {
                    turning: phasors.iter().map(|&p| [p, Complex64::default()]).collect(),
                    bounds: all.map(bound).collect(),
                    lengths: phasors.iter().map(|p| p.norm()).collect(),
                    phasors,
                };
            }
        };
        let turning = turning(balance, vector);
        Self {
            phasors: xy(balance, vector).concat(),
            bounds: all.map(|k| balance.zero_bound(vector, k)).collect(),
            lengths: turning.iter().map(|[f, b]| f.norm() + b.norm()).collect(),
            turning,
        }
    }
}

/// Every figure of every point is that of the balance, to what rounding can leave; and the same, bit
/// for bit, where that point is all there is.
#[track_caller]
fn each_point_is_a_balance(
    engines: &[Arc<Engine>],
    axes: &SweepAxes,
    orders: &[u32],
    spectrum: Option<&Spectrum>,
) {
    let together = sweep(engines, axes, orders, spectrum);
    let finder = PeakFinder::new(&whole(orders)).unwrap();
    let quantities = if spectrum.is_some() { &QUANTITIES[..2] } else { &QUANTITIES };
    for &quantity in quantities {
        let count = components(quantity);
        let figures = [
            Statistic::Amplitude,
            Statistic::Length,
            Statistic::Sum,
            Statistic::LengthOfSum,
            Statistic::ZeroBound,
        ];
        let all_phasors = phasors(&together, quantity, Statistic::Amplitude);
        let all_turning = phasors(&together, quantity, Statistic::Turning);
        let all = figures.map(|figure| peaks(&together, quantity, figure));
        for (point, place) in places(together.shape()).enumerate() {
            let (engine, axes) = (&engines[place[0]], alone(axes, place));
            let request = Request {
                rpm: axes.rpm[0],
                reference_z: Some(REFERENCE),
                torque: spectrum.is_none(),
            };
            let placed = given(&there(engine, &axes).into(), spectrum);
            let balance = by_orders(&placed, &request, orders);
            let OfBalance { phasors: expected, turning, bounds, lengths } =
                OfBalance::new(&balance, quantity);
            let width = orders.len() * count;
            let [amplitudes, vectors, sums, longest, zero_bounds] = &all;
            let found = &all_phasors[point * width..][..width];
            let parts = &all_turning[point * 2 * orders.len()..][..2 * orders.len()];
            let context = format!("{quantity:?} at {place:?}");
            // What either lets rounding leave.
            let bound = |k: usize| 2.0 * bounds[k / count];
            for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
                assert!((found - expected).norm() <= bound(k), "{context} {k}: {found} {expected}");
                let amplitude = amplitudes[point * width + k];
                // Three roundings.
                assert!((amplitude - found.norm()).abs() <= 1e-15 * amplitude, "{context} {k}");
                assert_eq!(amplitude == 0.0, *found == Complex64::default());
            }
            for (k, (found, expected)) in parts.iter().zip(turning.concat()).enumerate() {
                let slack = 2.0 * bounds[k / 2];
                assert!((found - expected).norm() <= slack, "{context} {k}: {found} {expected}");
                // Zero has no sign, but for products with no speed.
                assert!(found.im != 0.0 || found.im.is_sign_positive() || axes.rpm[0] == 0.0);
            }
            for (k, expected) in bounds.iter().enumerate() {
                let bound = zero_bounds[point * orders.len() + k];
                // That of torque by a balance holds for either torque.
                let close = (bound - expected).abs() <= 1e-9 * expected;
                assert!(close || is_torque(quantity) && bound < *expected, "{context} {k}");
            }
            for (k, expected) in lengths.iter().enumerate() {
                let length = vectors[point * orders.len() + k];
                assert!((length - expected).abs() <= bound(k * count), "{context} {k} {length}");
            }
            let slack = bounds.iter().sum::<f64>() * 2.0 + 1e-13 * lengths.iter().sum::<f64>();
            let of = |axis: usize| -> Vec<Complex64> {
                expected.iter().skip(axis).step_by(count).copied().collect()
            };
            for axis in 0..count {
                let peak = finder.along_axis(&of(axis), &Cancel::new()).unwrap();
                assert!((sums[point * count + axis] - peak).abs() <= slack, "{context}");
            }
            if count == 2 {
                let peak = finder.of_vector(&of(0), &of(1), &Cancel::new()).unwrap();
                assert!((longest[point] - peak).abs() <= slack, "{context}");
            }
            let only = sweep(&[Arc::clone(&engines[place[0]])], &axes, orders, spectrum);
            assert_eq!(phasors(&only, quantity, Statistic::Amplitude), found, "{context}");
            assert_eq!(phasors(&only, quantity, Statistic::Turning), parts, "{context}");
            for (figure, all) in figures.into_iter().zip(&all) {
                let here = peaks(&only, quantity, figure);
                assert_eq!(here, all[point * here.len()..][..here.len()], "{context} {figure:?}");
            }
        }
    }
}

/// Every choice of axes, each with these values.
fn axes(
    angles: &[f64],
    ratios: &[f64],
    offsets: &[f64],
    rpm: &[f64],
) -> impl Iterator<Item = SweepAxes> {
    let holds = [None, Some(Hold::Pins), Some(Hold::Firing)];
    (0..12).map(move |k| SweepAxes {
        bank_angle: holds[k % 3].map(|hold| (angles.to_vec(), hold)),
        rod_ratio: (k / 3 % 2 == 1).then(|| ratios.to_vec()),
        pin_offset: (k / 6 == 1).then(|| offsets.to_vec()),
        rpm: rpm.to_vec(),
        map: None,
    })
}

/// Multiples of half the bank angle up to 16 are reached by multiplication, also from a lower one.
const ORDERS: [u32; 9] = [1, 2, 3, 5, 4, 15, 16, 17, 18];

#[test]
fn each_point_is_a_balance_whatever_is_swept() {
    let engines = [mixed(), plain()];
    let (angles, ratios) = ([0.0, 37.0, 90.0, 180.0], [0.4, 0.1, 0.3]);
    for axes in axes(&angles, &ratios, &[-0.003, 0.0, 0.005], &[3000.0, 0.0, 1000.0]) {
        each_point_is_a_balance(&engines, &axes, &ORDERS, None);
    }
    for axes in axes(&angles, &ratios[..2], &[0.002, 0.0], &[3000.0]) {
        each_point_is_a_balance(&[weighted()], &axes, &ORDERS[..4], None);
    }
    // One engine, one speed, and banks that are not two.
    for axes in axes(&[60.0], &ratios, &[0.001], &[2000.0]).step_by(3) {
        each_point_is_a_balance(&[in_line()], &axes, &ORDERS, None);
    }
    // Rod ratios of several cranks.
    let ratios =
        SweepAxes { rod_ratio: Some(vec![0.4, 0.1]), rpm: vec![3000.0], ..SweepAxes::default() };
    each_point_is_a_balance(&[geared()], &ratios, &ORDERS, None);
}

#[test]
fn each_point_is_a_balance_of_any_number_of_orders() {
    let engines = [plain(), mixed()];
    for count in 1..6 {
        for axes in axes(&[50.0, 110.0], &[0.25, 0.35], &[0.002, -0.001], &[3000.0]) {
            each_point_is_a_balance(&engines, &axes, &ORDERS[..count], None);
        }
    }
    // Without the first, at which pins turn, and with it in another place.
    for orders in [&[2, 4][..], &[6, 1, 2]] {
        for axes in axes(&[50.0], &[0.25], &[0.002], &[3000.0, 1000.0]) {
            each_point_is_a_balance(&engines, &axes, orders, None);
        }
    }
}

#[test]
fn each_point_is_a_balance_with_a_spectrum() {
    let terms = [(1, Complex64::new(0.02, 0.003)), (4, Complex64::new(-0.001, 0.004))];
    let spectrum = Spectrum::new(terms).unwrap();
    for axes in axes(&[0.0, 50.0, 77.0], &[], &[], &[3000.0, 500.0]).take(3) {
        each_point_is_a_balance(
            &[mixed(), plain(), weighted()],
            &axes,
            &[1, 2, 4],
            Some(&spectrum),
        );
    }
}

/// Values alone are those in company, bit for bit, at places near the ends of an axis and on either
/// side of each whole block of 128.
#[track_caller]
fn alone_as_in_company(
    engines: &[Arc<Engine>],
    axes: &SweepAxes,
    orders: &[u32],
    (quantity, figure): (Quantity, Statistic),
) {
    let together = sweep(engines, axes, orders, None);
    let shape = together.shape();
    let all = peaks(&together, quantity, figure);
    let looked_at = |k: usize, length: usize| {
        k < 9 || k + 2 >= length || [0, 127].contains(&(k % 128)) && k + 130 >= length
    };
    for (point, place) in places(shape).enumerate() {
        if place.into_iter().zip(shape).all(|(k, length)| looked_at(k, length)) {
            let engine = Arc::clone(&engines[place[0]]);
            let here =
                peaks(&sweep(&[engine], &alone(axes, place), orders, None), quantity, figure);
            assert_eq!(here, all[point * here.len()..][..here.len()], "{shape:?} {place:?}");
        }
    }
}

/// So many values, evenly from one to another.
fn evenly(count: usize, [from, to]: [f64; 2]) -> Vec<f64> {
    (0..count).map(|k| from + (to - from) * (k as f64 / count as f64)).collect()
}

const DEGREES: [f64; 2] = [0.0, 180.0];
const RATIOS: [f64; 2] = [0.1, 0.45];
const OFFSETS: [f64; 2] = [-0.004, 0.006];

#[test]
fn nothing_depends_on_how_long_an_axis_is() {
    let moments = (Quantity::MOMENT, Statistic::Amplitude);
    let engines = [plain(), mixed()];
    let pins = |angles| Some((angles, Hold::Pins));
    for count in [7, 8, 9, 127, 128, 129, 256, 1023, 1024, 1025] {
        let angles = pins(evenly(count, DEGREES));
        let ratios = Some(evenly(count, RATIOS));
        let offsets = Some(evenly(count, OFFSETS));
        let (two, three) = (Some(vec![0.3, 0.2]), Some(vec![0.3, 0.2, 0.4]));
        let one_speed = SweepAxes { rpm: vec![3000.0], ..SweepAxes::default() };
        let long = [
            SweepAxes { bank_angle: angles.clone(), ..one_speed.clone() },
            SweepAxes { rod_ratio: ratios.clone(), ..one_speed.clone() },
            SweepAxes { pin_offset: offsets.clone(), rod_ratio: two.clone(), ..one_speed.clone() },
            SweepAxes { bank_angle: angles.clone(), rod_ratio: three, ..one_speed.clone() },
            SweepAxes {
                bank_angle: pins(vec![40.0, 70.0]),
                rod_ratio: ratios.clone(),
                ..one_speed
            },
        ];
        for (k, axes) in long.into_iter().enumerate() {
            alone_as_in_company(&engines, &axes, &[1, 2, 6], moments);
            alone_as_in_company(&engines[1..], &axes, &[2], moments);
            let axes = SweepAxes { rpm: vec![1000.0, 4000.0], ..axes };
            alone_as_in_company(&engines, &axes, &[2, 4], (TORQUE, Statistic::Amplitude));
            alone_as_in_company(&engines[..1], &axes, &[3], (Quantity::FORCE, Statistic::Length));
            if count < 129 || k == 0 {
                alone_as_in_company(&engines, &axes, &[1, 2], (Quantity::FORCE, Statistic::Sum));
            }
        }
    }
}

#[test]
fn nothing_depends_on_how_much_is_worked_out_together() {
    let amplitude = (Quantity::FORCE, Statistic::Amplitude);
    let orders: Vec<u32> = (1..=4096).collect();
    for (angles, ratios) in [(130, 2), (2, 130)] {
        // So many orders leave room for 128 of either axis in a slab.
        let axes = SweepAxes {
            bank_angle: Some((evenly(angles, DEGREES), Hold::Firing)),
            rod_ratio: Some(evenly(ratios, RATIOS)),
            rpm: vec![3000.0],
            ..SweepAxes::default()
        };
        alone_as_in_company(&[plain()], &axes, &orders, amplitude);
    }
    // More than one piece of numbers at all speeds, and a row in several pieces.
    for (count, speeds) in [(300, 257), (3, 30_000)] {
        let axes = SweepAxes {
            rod_ratio: Some(evenly(count, RATIOS)),
            rpm: evenly(speeds, [100.0, 9000.0]),
            ..SweepAxes::default()
        };
        alone_as_in_company(&[plain()], &axes, &[1, 4], amplitude);
        alone_as_in_company(&[plain()], &axes, &[1, 2, 4], (TORQUE, Statistic::Amplitude));
    }
}

/// Two cylinders whose forces, moments and odd torques cancel but for a part of one's mass, beside
/// two that cancel wholly.
fn nearly_balanced(more: f64, inertia: f64) -> Engine {
    let angle = |degrees| Angle::from_degrees(degrees).unwrap();
    let place = |rod: f64, mass: f64, side: f64, z| {
        let cylinder = Cylinder::new(0.05, rod, mass, 0.0).unwrap();
        let cylinder = cylinder.with_rod_inertia_excess(inertia).unwrap();
        Station { cylinder, tdc: angle(side), bank: angle(side), z, rotating_mass: 0.0 }
    };
    let cylinders = [
        place(0.15, 0.5, 0.0, 0.25),
        place(0.15, 0.5 * (1.0 + more), 180.0, 0.25),
        place(0.12, 0.75, 0.0, -0.5),
        place(0.12, 0.75, 180.0, -0.5),
    ];
    Engine::new("", "", cylinders.to_vec()).unwrap()
}

/// The crankpins of [`nearly_balanced`] lie in one direction: odd orders of force add up, unless top
/// dead centres are the same.
fn boxer(engine: &Engine, rotating_mass: f64) -> Engine {
    changed(engine, |p| Station { tdc: Angle::ZERO, rotating_mass, ..*p })
}

/// What is left is zero up to what rounding can leave and not above, by the balance's account of it.
#[test]
fn what_rounding_can_leave_is_zero_and_no_more() {
    let bank_angle = Some((vec![180.0, 90.0, 45.0], Hold::Firing));
    let rpm = vec![3000.0];
    let ratio = Some(vec![0.05 / 0.15]);
    let ratios = Some(vec![0.05 / 0.15, 0.2]);
    let long = Some(vec![0.05 / 0.15; 130]);
    let none = SweepAxes { rpm, ..SweepAxes::default() };
    let all = [
        none.clone(),
        SweepAxes { bank_angle: bank_angle.clone(), ..none.clone() },
        SweepAxes { rod_ratio: ratios.clone(), ..none.clone() },
        SweepAxes { bank_angle: bank_angle.clone(), rod_ratio: ratio, ..none.clone() },
        SweepAxes { bank_angle, rod_ratio: ratios, ..none.clone() },
        SweepAxes { rod_ratio: long, rpm: vec![3000.0, 500.0], ..none },
    ];
    let cases = [
        (Quantity::FORCE, 1, 0.0, 0.0),
        (Quantity::FORCE, 1, 0.4, 0.0),
        (Quantity::FORCE, 4, 0.4, 0.0),
        (Quantity::MOMENT, 1, 0.3, 0.0),
        (Quantity::MOMENT, 2, 0.3, 0.0),
        (TORQUE, 1, 0.0, 0.0),
        (TORQUE, 3, 0.0, 0.0),
        (TORQUE, 1, 0.0, 2e-4),
        (TORQUE, 3, 0.0, -2e-4),
    ];
    for axes in &all {
        for (quantity, order, rotating_mass, inertia) in cases {
            let engine = |more| {
                let engine = nearly_balanced(more, inertia);
                if quantity == TORQUE { engine } else { boxer(&engine, rotating_mass) }
            };
            let first = alone(axes, [0; 6]);
            let of = |more: f64| {
                let balance = by_orders(&there(&engine(more), &first), &REQUEST, &[order]);
                let OfBalance { phasors, bounds, .. } = OfBalance::new(&balance, quantity);
                (phasors.iter().map(|p| p.norm()).fold(0.0, f64::max), bounds[0])
            };
            let (balanced, bound) = of(0.0);
            assert_eq!(balanced, 0.0);
            let (left, _) = of(1e-3);
            for (part, figure) in [
                (0.85, Statistic::Amplitude),
                (1.2, Statistic::Amplitude),
                (0.85, Statistic::Sum),
                (1.2, Statistic::Sum),
                // Half of it turns with the crank and half against it.
                (1.7, Statistic::Length),
                (2.4, Statistic::Length),
            ] {
                if quantity == TORQUE && figure == Statistic::Length {
                    continue;
                }
                let engine = Arc::new(engine(1e-3 * bound / left * part));
                let sweep = sweep(&[engine], axes, &[order], None);
                let here = peaks(&sweep, quantity, figure);
                let count = if figure == Statistic::Length { 1 } else { components(quantity) };
                let largest = here[..count].iter().copied().fold(0.0, f64::max);
                let zero = [0.85, 1.7].contains(&part);
                assert_eq!(
                    largest == 0.0,
                    zero,
                    "{quantity:?} {order} {part} of {bound}: {largest} {:?}",
                    sweep.shape()
                );
            }
        }
    }
}

/// As large as what rounding can leave, to the last bit, is zero: a lever of 25 ε between two planes
/// 1 m in all from the origin, of one cylinder at order 1.
#[test]
fn as_much_as_rounding_can_leave_is_zero() {
    let lever = 25.0 * f64::EPSILON;
    let [z, reference] = [0.5 + 0.5 * lever, 0.5 - 0.5 * lever];
    let cylinder = Cylinder::new(0.5, 2.0, 2.0, 0.0).unwrap();
    let place = Station { cylinder, tdc: Angle::ZERO, bank: Angle::ZERO, z, rotating_mass: 0.0 };
    let engine = Arc::new(Engine::new("", "", vec![place]).unwrap());
    let spectrum = Spectrum::new([(1, Complex64::new(1.0, 0.0))]).unwrap();
    let of = |reference: f64| {
        let axes = SweepAxes { rpm: vec![3000.0], ..SweepAxes::default() };
        let engines = vec![given(&engine, Some(&spectrum))];
        let sweep = Sweep::new(
            engines,
            axes,
            &Orders::whole(&[1]).unwrap(),
            Some(reference),
            true,
            &Cancel::new(),
        )
        .unwrap();
        peaks(&sweep, Quantity::MOMENT, Statistic::Amplitude)[1]
    };
    assert_eq!(of(reference), 0.0);
    assert!(of(reference.next_down()) > 0.0);
}

fn refusal(result: Result<impl Sized, Error>) -> String {
    match result {
        Err(error) => error.to_string(),
        Ok(_) => String::new(),
    }
}

fn new(axes: &SweepAxes, orders: &[u32], spectrum: Option<&Spectrum>) -> Result<Sweep, Error> {
    let engines = [plain(), mixed()].map(|engine| given(&engine, spectrum)).to_vec();
    let orders = Orders::Given(whole(orders));
    Sweep::new(engines, axes.clone(), &orders, None, true, &Cancel::new())
}

#[test]
fn values_that_cannot_be_are_refused() {
    let good = SweepAxes { rpm: vec![3000.0], ..SweepAxes::default() };
    assert!(new(&good, &[1], None).is_ok());
    assert!(refusal(new(&good, &[], None)).contains("orders"));
    assert!(refusal(new(&good, &[2, 2], None)).contains("orders"));
    let no_engine =
        Sweep::new(vec![], good.clone(), &Orders::whole(&[1]).unwrap(), None, true, &Cancel::new());
    assert!(refusal(no_engine).starts_with("engines = []"));
    let engines = vec![plain()];
    let far = Sweep::new(
        engines,
        good.clone(),
        &Orders::whole(&[1]).unwrap(),
        Some(f64::NAN),
        true,
        &Cancel::new(),
    );
    assert!(refusal(far).contains("reference_z"));

    // Behind many that can be.
    let among = |bad: f64| {
        let mut values = vec![0.01; 70_000];
        values[69_000] = bad;
        values
    };
    for (rpm, told) in
        [(vec![], "rpm = []"), (among(-1.0), "rpm = -1"), (among(f64::NAN), "rpm = NaN")]
    {
        assert!(
            refusal(new(&SweepAxes { rpm, ..good.clone() }, &[1], None)).starts_with(told),
            "{told}"
        );
    }
    for (angles, told) in [
        (vec![], "bank_angle_deg = []"),
        (among(180.5), "bank_angle_deg = 180.5"),
        (among(-0.5), "bank_angle_deg = -0.5"),
        (among(f64::NAN), "bank_angle_deg = NaN"),
    ] {
        let axes = SweepAxes { bank_angle: Some((angles, Hold::Pins)), ..good.clone() };
        assert!(refusal(new(&axes, &[1], None)).starts_with(told), "{told}");
    }
    let axes = SweepAxes { bank_angle: Some((vec![60.0], Hold::Pins)), ..good.clone() };
    let no_banks = Sweep::new(
        vec![plain(), in_line()],
        axes,
        &Orders::whole(&[1]).unwrap(),
        None,
        true,
        &Cancel::new(),
    );
    assert!(
        refusal(no_banks)
            .starts_with("bank_angle_deg is undefined for this engine: it has one bank")
    );

    let spectrum = Spectrum::new([(1, Complex64::new(1.0, 0.0))]).unwrap();
    for (name, swept) in [
        ("rod_ratio", SweepAxes { rod_ratio: Some(vec![0.3]), ..good.clone() }),
        ("pin_offset", SweepAxes { pin_offset: Some(vec![0.0]), ..good.clone() }),
    ] {
        assert!(new(&swept, &[1], None).is_ok());
        let told = refusal(new(&swept, &[1], Some(&spectrum)));
        assert!(told.starts_with(&format!("{name} = swept together")), "{told}");
    }
    for empty in [
        SweepAxes { rod_ratio: Some(vec![]), ..good.clone() },
        SweepAxes { pin_offset: Some(vec![]), ..good.clone() },
    ] {
        assert!(refusal(new(&empty, &[1], None)).contains("= []"));
    }
}

/// A sweep is refused where a point of it would be alone, with one's words.
#[test]
fn cranks_that_cannot_turn_are_refused() {
    let nan = f64::NAN;
    let good = SweepAxes { rpm: vec![3000.0], ..SweepAxes::default() };
    let mut refused = 0;
    let ratio_lists: [&[f64]; 9] = [
        &[],
        &[0.3, 0.2],
        &[0.2, 0.9, 0.95, 0.3],
        &[1.5, 0.2],
        &[0.2, nan, 0.3],
        &[nan, 0.3],
        &[0.3, nan],
        &[0.2, -0.1],
        &[0.5, 0.0],
    ];
    let offset_lists: [&[f64]; 9] = [
        &[],
        &[0.0, 0.003],
        &[-0.02, 0.01],
        &[0.02, -0.09],
        &[0.2, -0.3, 0.0],
        &[0.0, nan],
        &[nan, 0.0],
        &[0.001, f64::INFINITY],
        &[0.001, 0.3, 0.001],
    ];
    for ratios in ratio_lists {
        for offsets in offset_lists {
            let some = |values: &[f64]| (!values.is_empty()).then(|| values.to_vec());
            let axes =
                SweepAxes { rod_ratio: some(ratios), pin_offset: some(offsets), ..good.clone() };
            let found = new(&axes, &[1], None);
            let shape = [1, 1, ratios.len().max(1), offsets.len().max(1), 1, 1];
            let alone: Vec<String> =
                places(shape).map(|place| refusal(new(&alone(&axes, place), &[1], None))).collect();
            let fails = alone.iter().any(|told| !told.is_empty());
            assert_eq!(found.is_err(), fails, "{ratios:?} {offsets:?}");
            if let Err(error) = found {
                refused += 1;
                let told = error.to_string();
                assert!(alone.contains(&told), "{ratios:?} {offsets:?}: {told}, not of {alone:?}");
                // The first wrong ratio, if it is wrong with no offset at all.
                if let Some(bad) = ratios.iter().find(|λ| !(1e-30..1.0).contains(*λ)) {
                    assert!(
                        told.starts_with(&format!("rod_ratio = {bad:?}"))
                            || told.contains("pin_offset")
                    );
                }
            }
        }
    }
    assert!(refused > 40);
}

#[test]
fn a_sweep_tells_what_it_is() {
    let axes = SweepAxes {
        bank_angle: Some((vec![60.0, 90.0, 10.0], Hold::Pins)),
        rod_ratio: Some(vec![0.3, 0.2]),
        pin_offset: Some(vec![0.001; 5]),
        rpm: vec![3000.0, 6000.0, 1000.0, 0.0],
        map: None,
    };
    let all = new(&axes, &[4, 2, 1], None).unwrap();
    assert_eq!(all.shape(), [2, 3, 2, 5, 4, 1]);
    assert_eq!((all.orders(), all.omitted()), (&whole(&[4, 2, 1])[..], &[][..]));
    assert_eq!(all.error_bound().values(), [0.0; 3]);
    // Twice the travel of the longest a turn; 100 turns a second.
    let (r, l, e) = (0.05, 0.05 / 0.3, 0.001_f64);
    let reach = |arm: f64| (arm * arm - e * e).sqrt();
    let travel = reach(l + r) - reach(l - r);
    assert!((all.mean_piston_speed() - 200.0 * travel).abs() < 1e-12);
    let tails: [(Quantity, Statistic, &[usize]); 11] = [
        (Quantity::FORCE, Statistic::Amplitude, &[3, 2]),
        (Quantity::MOMENT, Statistic::Length, &[3]),
        (Quantity::MOMENT, Statistic::Sum, &[2]),
        (Quantity::FORCE, Statistic::LengthOfSum, &[]),
        (TORQUE, Statistic::Amplitude, &[3]),
        (TORQUE, Statistic::Length, &[3]),
        (TORQUE, Statistic::Sum, &[]),
        (TORQUE, Statistic::LengthOfSum, &[]),
        (CRANK_TORQUE, Statistic::Amplitude, &[3]),
        (Quantity::MOMENT, Statistic::ZeroBound, &[3]),
        (CRANK_TORQUE, Statistic::Sum, &[]),
    ];
    for (quantity, figure, tail) in tails {
        let shape = [&[2, 3, 2, 5, 4, 1], tail].concat();
        assert_eq!(all.result_shape(quantity, figure), shape);
        let length = shape.iter().product::<usize>();
        // Room for as much, no less and no more.
        for (room, fits) in [(length, true), (length - 1, false), (length + 1, false), (0, false)] {
            let mut out = vec![f64::NAN; room];
            let told = refusal(all.write_peaks(quantity, figure, &mut out, &Cancel::new()));
            assert_eq!(told.is_empty(), fits);
            assert!(fits || told.starts_with(&format!("out = {room}")), "{told}");
            assert_eq!(out.iter().all(|x| x.is_finite()), fits || room == 0);
        }
    }
    for figure in [Statistic::Amplitude, Statistic::Turning] {
        let mut short = vec![Complex64::default(); 7];
        assert!(all.write_phasors(Quantity::FORCE, figure, &mut short, &Cancel::new()).is_err());
        let mut out = vec![Complex64::new(f64::NAN, 0.0); 2 * 3 * 2 * 5 * 4 * 6];
        all.write_phasors(Quantity::FORCE, figure, &mut out, &Cancel::new()).unwrap();
        assert_eq!(out, phasors(&all, Quantity::FORCE, figure));
    }

    // Torque, if it was wanted and is known.
    let spectrum = Spectrum::new([(1, Complex64::new(1.0, 0.0))]).unwrap();
    let speeds = SweepAxes { rpm: vec![3000.0], ..SweepAxes::default() };
    let (engines, orders) = (vec![plain(), mixed()], Orders::whole(&[1]).unwrap());
    let quiet = Sweep::new(engines, speeds.clone(), &orders, None, false, &Cancel::new());
    for sweep in [quiet.unwrap(), new(&speeds, &[1], Some(&spectrum)).unwrap()] {
        for (quantity, known) in [(Quantity::FORCE, true), (TORQUE, false), (CRANK_TORQUE, false)] {
            let found = sweep.phasors(quantity, Statistic::Amplitude, &Cancel::new());
            assert_eq!(found.is_ok(), known);
            assert_eq!(sweep.peaks(quantity, Statistic::Sum, &Cancel::new()).is_ok(), known);
        }
    }
}

#[test]
fn results_are_as_large_as_there_is_room_for() {
    // 2 engines, 2 components of 8 bytes, or 16: 32 or 64 bytes a point of 2³².
    let sized = |angles: usize, speeds: usize| {
        let bank_angle = Some((vec![60.0; angles], Hold::Pins));
        new(
            &SweepAxes { bank_angle, rpm: vec![1000.0; speeds], ..SweepAxes::default() },
            &[1],
            None,
        )
        .unwrap()
    };
    let (fits, does_not) = (sized(1 << 13, 1 << 14), sized(1 << 13, (1 << 14) + 1));
    for (sweep, expected) in [(&fits, true), (&does_not, false)] {
        assert_eq!(sweep.check_size(Quantity::FORCE, Statistic::Amplitude, 8).is_ok(), expected);
        assert_eq!(sweep.waveform_shape(Quantity::FORCE, 1).is_ok(), expected);
    }
    let too_large = |result: Result<_, Error>| matches!(result, Err(Error::TooLarge { .. }));
    assert!(too_large(does_not.check_size(Quantity::FORCE, Statistic::Sum, 8)));
    let cancel = Cancel::new();
    assert!(too_large(does_not.peaks(Quantity::FORCE, Statistic::Amplitude, &cancel).map(drop)));
    assert!(too_large(fits.phasors(Quantity::FORCE, Statistic::Amplitude, &cancel).map(drop)));
    assert!(fits.check_size(TORQUE, Statistic::Amplitude, 16).is_ok());
}

#[test]
fn whoever_no_longer_waits_is_told_so() {
    let raised = Cancel::new();
    raised.raise();
    let axes = SweepAxes {
        bank_angle: Some((evenly(9, DEGREES), Hold::Pins)),
        rod_ratio: Some(evenly(200, RATIOS)),
        pin_offset: None,
        rpm: vec![3000.0, 1000.0],
        map: None,
    };
    let engines = || vec![plain(), mixed()];
    let stopped = |result: Result<_, Error>| result.err() == Some(Error::Cancelled);
    assert!(stopped(
        Sweep::new(engines(), axes.clone(), &Orders::Auto { rtol: 1e-3 }, None, true, &raised)
            .map(drop)
    ));
    let speeds = SweepAxes { rpm: vec![3000.0, 1000.0], ..SweepAxes::default() };
    for axes in [axes, speeds] {
        let made =
            Sweep::new(engines(), axes.clone(), &Orders::whole(&[1]).unwrap(), None, true, &raised);
        assert!(stopped(made.map(drop)));
        let sweep = new(&axes, &[1, 2], None).unwrap();
        for quantity in QUANTITIES {
            assert!(stopped(sweep.phasors(quantity, Statistic::Turning, &raised).map(drop)));
            for figure in
                [Statistic::Amplitude, Statistic::Length, Statistic::Sum, Statistic::LengthOfSum]
            {
                assert!(stopped(sweep.peaks(quantity, figure, &raised).map(drop)));
            }
        }
    }
}

/// Sizes of an engine's orders over ω² at the worst point of a sweep, what orders above them add, and
/// what may be left out: force, moment, roll and crank torque.
struct Worst {
    sizes: Vec<[f64; 4]>,
    rest: [f64; 4],
    allowed: [f64; 4],
}

impl Worst {
    fn new(engine: &Arc<Engine>, axes: &SweepAxes, last: u32, rtol: f64) -> Self {
        let axes = SweepAxes { rpm: vec![3000.0], ..axes.clone() };
        let orders: Vec<u32> = (1..=last).collect();
        let one = sweep(&[Arc::clone(engine)], &axes, &[1], None);
        let (mut sizes, mut rest) = (vec![[0.0_f64; 4]; orders.len()], [0.0_f64; 4]);
        for place in places(one.shape()) {
            let there = there(engine, &alone(&axes, place));
            let balance = by_orders(&there, &REQUEST, &orders);
            for (which, quantity) in QUANTITIES.into_iter().enumerate() {
                let lengths = OfBalance::new(&balance, quantity).lengths;
                for (size, length) in sizes.iter_mut().zip(lengths) {
                    size[which] = size[which].max(length / square(3000.0));
                }
            }
            let mut here = [0.0; 4];
            for p in there.stations() {
                let (c, mechanism) = (p.cylinder, p.cylinder.mechanism());
                let force = c.mass_radius() * mechanism.force_beyond(last).unwrap();
                let torque = mechanism.torque_beyond(last).unwrap();
                let swing = mechanism.swing_torque_beyond(last).unwrap();
                let torque =
                    c.mass_radius_squared() * torque + c.rod_inertia_excess().abs() * swing;
                let added = [force, force * (p.z - REFERENCE).abs(), torque, torque];
                here.iter_mut().zip(added).for_each(|(here, added)| *here += added);
            }
            (0..4).for_each(|which| rest[which] = rest[which].max(here[which]));
        }
        let [force, moment, torque] = scales(engine, REFERENCE);
        let allowed = [force, moment, torque, torque].map(|scale| rtol * scale);
        Self { sizes, rest, allowed }
    }
}

/// Number of loads: pistons, rotating masses and unbalances.
fn loads(engine: &Engine, torque: bool) -> usize {
    let rotating = engine.stations().iter().filter(|p| p.rotating_mass > 0.0).count();
    let on_shafts: usize = engine.shafts().iter().map(|shaft| shaft.unbalances.len()).sum();
    let rods = engine.stations().iter().filter(|p| p.cylinder.has_rod_inertia()).count();
    let of_torque = if torque { rods } else { 0 };
    engine.stations().len() + rotating + engine.counterweights().len() + on_shafts + of_torque
}

/// The last order evaluated: orders above it add a hundredth of the tolerance at most, even if every
/// load had its part in them; and no unbalance has a higher order.
fn last(engines: &[Arc<Engine>], axes: &SweepAxes, rtol: f64, torque: bool) -> u32 {
    let ratios =
        engines.iter().flat_map(|e| e.shafts()).map(|shaft| shaft.ratio.size().ceil() as u32);
    let mut last = ratios.max().unwrap_or(1);
    for place in places(sweep(engines, axes, &[1], None).shape()) {
        let engine = &engines[place[0]];
        for p in there(engine, &alone(axes, place)).stations() {
            let c = &p.cylinder;
            // Parts of what the tolerance is relative to.
            let [of_force, _, of_torque] = scales(engine, REFERENCE);
            let force = c.mass_radius() / of_force;
            let [masses, rod] = [c.mass_radius_squared(), c.rod_inertia_excess().abs()]
                .map(|weight| weight / of_torque);
            let part = 0.01 * rtol / loads(engine, torque) as f64;
            let mechanism = c.mechanism();
            let enough = |n: &u32| {
                let within = |bound: Option<f64>, share: f64| bound.unwrap() * share <= part;
                within(mechanism.force_beyond(*n), force)
                    && (!torque || within(mechanism.torque_beyond(*n), masses))
                    && (!torque || within(mechanism.swing_torque_beyond(*n), rod))
            };
            last = last.max((1..=crankpin_core::limits::HIGHEST_ORDER).find(enough).unwrap());
        }
    }
    last
}

fn square(rpm: f64) -> f64 {
    (rpm * std::f64::consts::TAU / 60.0).powi(2)
}

/// What is left out stays within the bound at every point, and the bound within the tolerance.
#[track_caller]
fn few_orders_are_chosen(
    engines: &[Arc<Engine>],
    axes: &SweepAxes,
    rtol: f64,
    torque: bool,
) -> Sweep {
    let cancel = Cancel::new();
    let (all, reference) = (engines.to_vec(), Some(REFERENCE));
    let chosen =
        Sweep::new(all, axes.clone(), &Orders::Auto { rtol }, reference, torque, &cancel).unwrap();
    assert_eq!(chosen.shape(), sweep(engines, axes, &[1], None).shape());
    let known = |quantity| chosen.peaks(quantity, Statistic::Sum, &cancel).is_ok();
    assert_eq!(QUANTITIES.map(known), [true, true, torque, torque]);
    // Twice as many orders as are evaluated.
    let last = 2 * last(engines, axes, rtol, torque);
    let fastest = square(axes.rpm.iter().copied().fold(0.0, f64::max));
    let allowed = engines.iter().map(|engine| scales(engine, REFERENCE).map(|scale| rtol * scale));
    let allowed = allowed.reduce(|a, b| [0, 1, 2].map(|k| f64::max(a[k], b[k]))).unwrap();
    for (sum, bound) in chosen.error_bound().values().into_iter().enumerate() {
        assert!(bound <= allowed[sum] * fastest * (1.0 + 1e-14), "{sum}: {bound}");
    }
    let left_out: Vec<u32> =
        (1..=last).filter(|&n| !chosen.orders().contains(&whole(&[n])[0])).collect();
    for place in places(chosen.shape()) {
        let engine = there(&engines[place[0]], &alone(axes, place));
        let balance = by_orders(&engine, &REQUEST, &left_out);
        for (which, quantity) in QUANTITIES.into_iter().enumerate().take(if torque { 4 } else { 2 })
        {
            let lengths = OfBalance::new(&balance, quantity).lengths;
            let lost = lengths.iter().sum::<f64>() / square(3000.0) * fastest;
            let bound = chosen.error_bound().values()[which.min(2)];
            // Roundings of sums of ten loads in twenty orders.
            assert!(lost <= bound * (1.0 + 1e-12), "{quantity:?} {place:?}: {lost} > {bound}");
        }
    }
    chosen
}

/// Of a point alone, orders are left out from the smallest up while every sum stays within its
/// tolerance, and the bound is the sum of what is left out.
#[track_caller]
fn fewest_orders_are_chosen(engines: &[Arc<Engine>], axes: &SweepAxes, rtol: f64, torque: bool) {
    let chosen = few_orders_are_chosen(engines, axes, rtol, torque);
    let last = last(engines, axes, rtol, torque);
    let sums = if torque { 4 } else { 2 };
    let mut all: Vec<Worst> =
        engines.iter().map(|engine| Worst::new(engine, axes, last, rtol)).collect();
    // Of either torque as much as of both.
    for [_, _, roll, crank] in all.iter_mut().flat_map(|worst| &mut worst.sizes) {
        (*roll, *crank) = (roll.max(*crank), roll.max(*crank));
    }
    // Sizes as parts of what may be left out, engine by engine and sum by sum.
    let parts = |sizes: &dyn Fn(&Worst) -> [f64; 4]| -> Vec<f64> {
        let of = |worst| {
            let sizes: [f64; 4] = sizes(worst);
            (0..sums).map(move |sum| sizes[sum] / worst.allowed[sum])
        };
        all.iter().flat_map(of).collect()
    };
    let mut lost = parts(&|worst| worst.rest);
    assert!(lost.iter().all(|&part| part <= 0.01));
    let of_order = |n: u32| parts(&|worst| worst.sizes[n as usize - 1]);
    let largest = |n: u32| of_order(n).into_iter().fold(0.0, f64::max);
    let mut rising: Vec<u32> = (1..=last).collect();
    rising.sort_by(|&a, &b| largest(a).total_cmp(&largest(b)));
    let mut left_out = Vec::new();
    for n in rising {
        let with: Vec<f64> = lost.iter().zip(of_order(n)).map(|(lost, part)| lost + part).collect();
        if with.iter().all(|&part| part <= 1.0) {
            lost = with;
            left_out.push(n);
        }
    }
    left_out.sort_unstable();
    let kept: Vec<u32> = (1..=last).filter(|n| !left_out.contains(n)).collect();
    assert_eq!(chosen.orders(), whole(&kept));
    let omitted: Vec<u32> = left_out.iter().copied().filter(|&n| largest(n) > 0.0).collect();
    assert_eq!(chosen.omitted(), whole(&omitted));
    let fastest = axes.rpm.iter().copied().fold(0.0, f64::max);
    for (bound, these) in [(0, 0..1), (1, 1..2), (2, 2..4)] {
        let of_sum = |(worst, sum): (&Worst, usize)| -> f64 {
            let sizes: f64 = omitted.iter().map(|&n| worst.sizes[n as usize - 1][sum]).sum();
            (sizes + worst.rest[sum]) * square(fastest)
        };
        let these = these.filter(|&sum| sum < sums);
        let expected = these.flat_map(|sum| all.iter().map(move |worst| (worst, sum))).map(of_sum);
        let expected = expected.fold(0.0, f64::max);
        let found = chosen.error_bound().values()[bound];
        // Tails amplify what λ and e/r are rounded by, up to the order-th power.
        assert!((found - expected).abs() <= 1e-11 * expected, "{bound}: {found} {expected}");
    }
}

/// Order 2 of two cylinders of unlike cranks cancels at one rod ratio, if they have this offset; and
/// order 3 of one's torque, without it, for a rod as heavy as that.
fn cancelling_at(ratio: f64, offset: f64) -> [Arc<Engine>; 2] {
    let cancel = Cancel::new();
    let at = |r: f64| Proportions::new(ratio, offset / r).unwrap();
    let second = |r: f64| harmonics::coefficients(&at(r), &[2], &cancel).unwrap()[0].norm();
    let place = |r: f64, m: f64, side: f64| {
        let bank = Angle::from_degrees(side).unwrap();
        let cylinder = Cylinder::new(r, r / 0.3, m, offset).unwrap();
        Station { cylinder, tdc: Angle::ZERO, bank, z: 0.1, rotating_mass: 0.0 }
    };
    let other = 0.5 * 0.05 * second(0.05) / (0.03 * second(0.03));
    let pair = vec![place(0.05, 0.5, 0.0), place(0.03, other, 180.0)];
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let [masses, rod] = [harmonics::torque::torque, harmonics::rod::torque].map(|torque| {
        torque(&Proportions::new(ratio, 0.0).unwrap(), &[3], &cancel).unwrap().roll[0]
    });
    let inertia = -(masses / rod).re * cylinder.mass_radius_squared();
    let cylinder = cylinder.with_rod_inertia_excess(inertia).unwrap();
    let one = vec![Station { cylinder, ..pair[0] }];
    [pair, one].map(|stations| Arc::new(Engine::new("", "", stations).unwrap()))
}

#[test]
fn few_orders_are_chosen_for_any_sweep() {
    let rpm = vec![1000.0, 3000.0, 2000.0];
    let ratios = Some(vec![0.2, 0.4, 0.3]);
    let none = SweepAxes { rpm, ..SweepAxes::default() };
    let turned = |hold| Some((vec![40.0, 90.0], hold));
    for rtol in [0.2, 1e-2, 1e-4] {
        for torque in [false, true] {
            fewest_orders_are_chosen(&[mixed(), plain(), in_line()], &none, rtol, torque);
            fewest_orders_are_chosen(&[weighted(), plain()], &none, rtol, torque);
            fewest_orders_are_chosen(&[even_three()], &none, rtol, torque);
            few_orders_are_chosen(&[with_fast_shaft()], &none, rtol, torque);
            let chosen = |engines: &[Arc<Engine>], axes: &SweepAxes| {
                few_orders_are_chosen(engines, axes, rtol, torque);
            };
            chosen(&[plain()], &SweepAxes { rod_ratio: ratios.clone(), ..none.clone() });
            let both = SweepAxes {
                bank_angle: turned(Hold::Pins),
                rod_ratio: ratios.clone(),
                ..none.clone()
            };
            chosen(&[mixed(), plain()], &both);
            chosen(&[weighted()], &both);
            let offsets = Some(vec![-0.004, 0.002]);
            let three =
                SweepAxes { bank_angle: turned(Hold::Firing), pin_offset: offsets, ..both.clone() };
            chosen(&[plain(), mixed()], &three);
            let offsets = Some(vec![0.001, 0.004, -0.002]);
            chosen(&[mixed()], &SweepAxes { pin_offset: offsets, ..none.clone() });
            chosen(&[mixed()], &SweepAxes { pin_offset: Some(vec![0.0; 2]), ..both });
            let [pair, one] = cancelling_at(0.4, 0.01);
            let offset = Some(vec![0.01]);
            let cancelling = SweepAxes { rod_ratio: ratios.clone(), ..none.clone() };
            chosen(&[one], &cancelling);
            chosen(&[Arc::clone(&pair)], &cancelling);
            chosen(&[pair], &SweepAxes { pin_offset: offset, ..cancelling.clone() });
            chosen(&[balanced_at(0.4)], &cancelling);
        }
    }
    // The orders of a usual engine, from those that are needed to all that matter.
    let orders = |rtol| few_orders_are_chosen(&[plain()], &none, rtol, false).orders().to_vec();
    assert_eq!(orders(0.2), whole(&[1, 2]));
    assert_eq!(orders(1e-4), whole(&[1, 2, 4, 6]));
}

/// Orders that only multiples of three do not cancel, to rounding.
fn even_three() -> Arc<Engine> {
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let place = |k: f64| Station {
        cylinder,
        tdc: Angle::from_degrees(10.1 + 120.0 * k).unwrap(),
        bank: Angle::QUARTER_TURN,
        z: 0.1 * k,
        rotating_mass: 0.0,
    };
    Arc::new(Engine::new("", "", [0.0, 1.0, 2.0].map(place).to_vec()).unwrap())
}

/// A cylinder, whose orders all peak together, with a shaft of an order far above those that count.
fn with_fast_shaft() -> Arc<Engine> {
    let single = Station { ..even_three().stations()[0] };
    let against = Unbalance {
        amount: 1e-6,
        angle: Angle::QUARTER_TURN,
        z: single.z,
        pin: None,
        crank: CrankIndex::MAIN,
    };
    let shaft = Shaft {
        name: String::new(),
        ratio: SpeedRatio::whole(20),
        axis: [0.0; 2],
        unbalances: vec![against],
    };
    let engine = Engine::new("", "", vec![single]).unwrap();
    Arc::new(engine.with_shafts(vec![shaft]).unwrap())
}

/// Two shafts that cancel order 2 of a cylinder at one rod ratio, the largest, and leave most of it at
/// others.
fn balanced_at(ratio: f64) -> Arc<Engine> {
    let proportions = Proportions::new(ratio, 0.0).unwrap();
    let second = harmonics::coefficients(&proportions, &[2], &Cancel::new()).unwrap()[0].re;
    let (cylinder, z) = (Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap(), 0.1);
    let (tdc, bank) = (Angle::ZERO, Angle::QUARTER_TURN);
    let single = Station { cylinder, tdc, bank, z, rotating_mass: 0.0 };
    let amount = 0.5 * 0.5 * 0.05 * second / 4.0;
    let against = Unbalance { amount, angle: -bank, z, pin: None, crank: CrankIndex::MAIN };
    let shaft = |ratio| Shaft {
        name: String::new(),
        ratio: SpeedRatio::whole(ratio),
        axis: [0.0; 2],
        unbalances: vec![against],
    };
    let engine = Engine::new("", "", vec![single]).unwrap();
    Arc::new(engine.with_shafts(vec![shaft(2), shaft(-2)]).unwrap())
}

#[test]
fn orders_that_shafts_cancel_at_one_rod_ratio_are_kept() {
    let axes = SweepAxes {
        rod_ratio: Some(vec![0.15, 0.2, 0.3]),
        rpm: vec![3000.0],
        ..SweepAxes::default()
    };
    let sweep = few_orders_are_chosen(&[balanced_at(0.3)], &axes, 1e-6, true);
    assert!(sweep.orders().contains(&whole(&[2])[0]));
    // And where that is the only one they stay cancelled, but for torque.
    let here = SweepAxes { rod_ratio: Some(vec![0.3]), ..axes };
    let sweep = few_orders_are_chosen(&[balanced_at(0.3)], &here, 1e-6, false);
    assert!(!sweep.orders().contains(&whole(&[2])[0]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn few_orders_leave_out_less_than_their_bound(
        engine in random::weighted(random::vees()),
        ratios in proptest::option::of([0.05..0.5, 0.05..0.5]),
        offsets in proptest::option::of([-0.004..0.004, -0.004..0.004]),
        angles in proptest::option::of([0.0..180.0, 0.0..180.0]),
        firing in any::<bool>(),
        digits in 1.0..6.0_f64,
    ) {
        let hold = if firing { Hold::Firing } else { Hold::Pins };
        let axes = SweepAxes {
            bank_angle: angles.map(|angles| (angles.to_vec(), hold)),
            rod_ratio: ratios.map(Vec::from),
            pin_offset: offsets.map(Vec::from),
            rpm: vec![2000.0], map: None };
        few_orders_are_chosen(&[Arc::new(engine)], &axes, 10_f64.powf(-digits), true);
    }
}

#[test]
fn sweeps_with_no_order_needed_are_zero_everywhere() {
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let place = |tdc: f64, bank: f64| Station {
        cylinder,
        tdc: Angle::from_degrees(tdc).unwrap(),
        bank: Angle::from_degrees(bank).unwrap(),
        z: REFERENCE,
        rotating_mass: 0.0,
    };
    let axes = SweepAxes { rpm: vec![3000.0, 1000.0], ..SweepAxes::default() };
    let chosen = |places: &[(f64, f64)], rtol: f64| {
        let stations = places.iter().map(|&(tdc, bank)| place(tdc, bank)).collect();
        let engine = Arc::new(Engine::new("", "", stations).unwrap());
        let (axes, cancel) = (axes.clone(), Cancel::new());
        Sweep::new(vec![engine], axes, &Orders::Auto { rtol }, Some(REFERENCE), false, &cancel)
            .unwrap()
    };
    // A boxer pair in one plane: nothing at all. And half a turn apart in line order 2 is two thirds of
    // m·r·ω², and may be left out.
    let boxer = chosen(&[(0.0, 0.0), (0.0, 180.0)], 1e-6);
    assert!(boxer.omitted().is_empty());
    let twin = chosen(&[(0.0, 90.0), (180.0, 90.0)], 0.9);
    assert_eq!(twin.omitted()[..2], whole(&[2, 4]));
    assert!(twin.error_bound().force > 0.6 * 0.025 * square(3000.0));
    for sweep in [boxer, twin] {
        assert!(sweep.orders().is_empty());
        for quantity in [Quantity::FORCE, Quantity::MOMENT] {
            for figure in [Statistic::Amplitude, Statistic::Turning] {
                let phasors = sweep.phasors(quantity, figure, &Cancel::new()).unwrap();
                assert_eq!(phasors.shape(), [1, 1, 1, 1, 2, 1, 0, 2]);
            }
            for (figure, shape) in [
                (Statistic::Length, &[1, 1, 1, 1, 2, 1, 0][..]),
                (Statistic::Sum, &[1, 1, 1, 1, 2, 1, 2]),
                (Statistic::LengthOfSum, &[1, 1, 1, 1, 2, 1]),
            ] {
                let peaks = sweep.peaks(quantity, figure, &Cancel::new()).unwrap();
                assert_eq!(peaks.shape(), shape);
                assert!(peaks.iter().all(|&peak| peak == 0.0));
            }
            let angles = CrankAngles::new(&[0.0, 10.0]).unwrap();
            let mut out = vec![f64::NAN; 8];
            sweep.waveforms(quantity, &angles, false, &mut out, &Cancel::new()).unwrap();
            assert_eq!(out, [0.0; 8]);
        }
    }
}

#[test]
fn a_sweep_of_rod_ratios_leaves_out_what_the_largest_does() {
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let cylinder = cylinder.with_rod_inertia_excess(3e-4).unwrap();
    let bank = Angle::QUARTER_TURN;
    let upright = Station { cylinder, tdc: Angle::ZERO, bank, z: REFERENCE, rotating_mass: 0.0 };
    let upright = Arc::new(Engine::new("", "", vec![upright]).unwrap());
    let chosen = |ratios: &[f64]| {
        let (rod_ratio, rpm) = (Some(ratios.to_vec()), vec![3000.0]);
        let axes = SweepAxes { rod_ratio, rpm, ..SweepAxes::default() };
        Sweep::new(
            vec![Arc::clone(&upright)],
            axes,
            &Orders::Auto { rtol: 1e-5 },
            None,
            true,
            &Cancel::new(),
        )
        .unwrap()
    };
    let (many, one) = (chosen(&[0.2, 0.25, 0.3]), chosen(&[0.3]));
    assert_eq!((many.orders(), many.omitted()), (one.orders(), one.omitted()));
    // Each order of a centred piston is largest there: the same sums.
    for (many, one) in many.error_bound().values().into_iter().zip(one.error_bound().values()) {
        assert!((many - one).abs() <= 1e-14 * one, "{many} {one}");
    }
}

#[test]
fn a_sweep_of_offsets_has_the_orders_that_the_farthest_needs() {
    let chosen = |offsets: &[f64]| {
        let axes = SweepAxes {
            pin_offset: Some(offsets.to_vec()),
            rpm: vec![3000.0],
            ..SweepAxes::default()
        };
        few_orders_are_chosen(&[plain()], &axes, 1e-8, true).orders().to_vec()
    };
    for sign in [1.0, -1.0] {
        let farthest = [0.07 * sign];
        let others = [0.01 * sign, -0.02 * sign, 0.0];
        let (alone, beside) = (chosen(&farthest), chosen(&[&others[..], &farthest].concat()));
        assert!(alone.iter().all(|order| beside.contains(order)), "{alone:?} {beside:?}");
        // The others alone need fewer.
        assert!(chosen(&others).len() < alone.len());
    }
}

#[test]
fn few_orders_of_a_spectrum_are_chosen() {
    let terms = [(1, 0.02), (3, 1e-5), (4, 2e-5), (6, 0.01)];
    let terms = terms.map(|(n, size)| (n, Complex64::new(0.0, size)));
    let spectrum = Spectrum::new(terms).unwrap();
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let bank = Angle::QUARTER_TURN;
    let upright = Station { cylinder, tdc: Angle::ZERO, bank, z: REFERENCE, rotating_mass: 0.0 };
    let upright = Arc::new(Engine::new("", "", vec![upright]).unwrap());
    let axes = SweepAxes { rpm: vec![3000.0], ..SweepAxes::default() };
    let chosen = |engine: &Arc<Engine>, rtol: f64, spectrum: &Spectrum| {
        let (engines, cancel) = (vec![given(engine, Some(spectrum))], Cancel::new());
        Sweep::new(engines, axes.clone(), &Orders::Auto { rtol }, Some(REFERENCE), true, &cancel)
    };
    let one = chosen(&upright, 2e-3, &spectrum).unwrap();
    assert_eq!((one.orders(), one.omitted()), (&whole(&[1, 6])[..], &whole(&[3, 4])[..]));
    // Nothing is above it.
    let bound = 3e-5 * square(3000.0);
    assert!((one.error_bound().force - bound).abs() <= 1e-14 * bound);
    assert_eq!(one.error_bound().values()[1..], [0.0, 0.0]);
    // What turns has orders of its own.
    let only = Spectrum::new([(4, Complex64::i())]).unwrap();
    let orders = |engine: &Arc<Engine>| chosen(engine, 1e-3, &only).unwrap().orders().to_vec();
    assert_eq!(orders(&mixed()), whole(&[1, 4]));
    assert_eq!(orders(&plain()), whole(&[4]));
    assert_eq!(orders(&weighted()), whole(&[1, 2, 3, 4]));

    assert!(refusal(chosen(&upright, 1.0, &only)).starts_with("rtol = 1"));
    let stiff = SweepAxes { rod_ratio: Some(vec![0.3, 1.0 - 1e-12]), ..axes.clone() };
    let stiff =
        Sweep::new(vec![plain()], stiff, &Orders::Auto { rtol: 1e-6 }, None, true, &Cancel::new());
    assert!(refusal(stiff).starts_with("rtol = 1e-6: too many orders"));
}
