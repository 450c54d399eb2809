//! Waveforms: of an engine and of a sweep, as each cylinder's motion written out plainly makes them,
//! and as sums of orders.

mod common;

use std::sync::Arc;

use common::{
    InArrays, alone, angle, by_orders, in_line, kinematics, mixed, places, plain, there, weighted,
    xy,
};
use crankpin_core::balance::{Vector, balance};
use crankpin_core::quantity::Quantity;
use crankpin_core::sweep::{Statistic, SweepAxes};
use crankpin_core::{
    Angle, Balance, Cancel, Complex64, CrankAngles, Cylinder, Engine, Error, Hold, Orders, Request,
    Spectrum, Station, Sweep, Waveform, waveform,
};

const TORQUE: Quantity<'static> = Quantity::TORQUE;
const CRANK_TORQUE: Quantity<'static> = Quantity::CRANK_TORQUE;

const REFERENCE: f64 = 0.07;
const RPM: f64 = 3000.0;
const REQUEST: Request = Request { rpm: RPM, reference_z: Some(REFERENCE), torque: true };

fn square(rpm: f64) -> f64 {
    (rpm * std::f64::consts::TAU / 60.0).powi(2)
}

/// Crank angles, some of more than a turn.
fn thetas(count: usize) -> Vec<f64> {
    (0..count).map(|k| 7.0 + 1000.0 * k as f64 / count as f64).collect()
}

/// The rows of a waveform: those of [`kinematics`], as far as there are.
fn rows(wave: &Waveform, i: usize) -> Vec<f64> {
    let mut row = vec![wave.force[[i, 0]], wave.force[[i, 1]]];
    row.extend([wave.moment[[i, 0]], wave.moment[[i, 1]]]);
    row.extend(wave.torque.iter().chain(&wave.crank_torque).map(|torque| torque[i]));
    row
}

/// Angles of up to three turns in radians are good to 1e-15, and so are the terms.
const ROUNDING: f64 = 1e-14;

#[test]
fn kinematics_are_those_of_each_cylinder() {
    for engine in [mixed(), plain(), in_line(), weighted()] {
        // Blocks of 256, and enough of them for threads.
        for count in [0, 1, 255, 256, 257, 1024, 1025, 1300] {
            let thetas = thetas(count);
            let cancel = Cancel::new();
            let wave = waveform::exact(&engine, &REQUEST, &thetas, &cancel).unwrap();
            assert_eq!(wave.force.shape(), [count, 2]);
            assert!(wave.balance.is_none());
            let request = Request { torque: false, ..REQUEST };
            let planar = waveform::exact(&engine, &request, &thetas, &cancel).unwrap();
            assert_eq!((&planar.force, &planar.moment), (&wave.force, &wave.moment));
            assert!(planar.torque.is_none() && planar.crank_torque.is_none());
            for (i, θ) in thetas.iter().enumerate() {
                let (expected, sizes) = kinematics(&engine, REFERENCE, θ.to_radians());
                for (k, found) in rows(&wave, i).into_iter().enumerate() {
                    let off = (found - expected[k] * square(RPM)).abs();
                    assert!(off <= ROUNDING * sizes[k] * square(RPM), "{count} {θ} {k}: {found}");
                }
            }
        }
    }
}

#[test]
fn kinematics_that_cancel_are_zero() {
    // Two pistons as far in front of the plane as behind it, but for the rounding of 0.14 − 0.07.
    let pair = |heavier: f64| {
        let at = |z, mass| Station {
            cylinder: Cylinder::new(0.05, 0.15, mass, 0.0).unwrap(),
            tdc: angle(20.0),
            bank: angle(77.0),
            z,
            rotating_mass: mass,
        };
        let stations = vec![at(0.14 / 3.0, 0.5), at(0.14 - 0.14 / 3.0, 0.5 * (1.0 + heavier))];
        Arc::new(Engine::new("", "", stations).unwrap())
    };
    for (heavier, vanishes) in [(0.0, true), (1e-15, true), (1e-12, false)] {
        let engine = pair(heavier);
        let wave = waveform::exact(&engine, &REQUEST, &thetas(300), &Cancel::new()).unwrap();
        assert_eq!(wave.moment.iter().all(|moment| *moment == 0.0), vanishes, "{heavier}");
        let swept = sweep(&[engine], &SweepAxes { rpm: vec![RPM], ..SweepAxes::default() }, &[1]);
        let moments = waveforms(&swept, Quantity::MOMENT, &thetas(300), true);
        assert_eq!(moments.iter().all(|moment| *moment == 0.0), vanishes, "{heavier}");
    }
}

/// Σ Re(P e^{inθ}) of force x, y, moment x, y, roll and crank torque.
fn sum_of_orders(balance: &Balance, θ: f64) -> Vec<f64> {
    let mut sums = vec![0.0; if balance.has_torque { 6 } else { 4 }];
    for (k, &n) in balance.orders.iter().enumerate() {
        let unit = Complex64::cis(n.number() * θ.to_radians());
        let mut phasors = [balance.xy(Vector::Force, k), balance.xy(Vector::Moment, k)].concat();
        if balance.has_torque {
            let torque = balance.wrenches[k].torque;
            phasors.extend([torque.roll, torque.crank]);
        }
        for (sum, phasor) in sums.iter_mut().zip(phasors) {
            *sum += (phasor * unit).re;
        }
    }
    sums
}

#[test]
fn sums_of_orders_are_sums_of_orders() {
    let spectrum = Spectrum::new([(1, Complex64::new(0.02, 0.003)), (4, Complex64::i())]).unwrap();
    for engine in [mixed(), plain(), in_line(), weighted()] {
        for (spectrum, torque) in [(None, true), (None, false), (Some(&spectrum), true)] {
            let request = Request { torque, ..REQUEST };
            let engine = spectrum
                .map_or(engine.clone(), |s: &Spectrum| engine.with_spectrum(s.clone()).into());
            let given = Orders::whole(&[1, 4, 2, 7]).unwrap();
            let balance = by_orders(&engine, &request, &[1, 4, 2, 7]);
            for count in [1, 256, 257, 1300] {
                let thetas = thetas(count);
                let cancel = Cancel::new();
                let wave =
                    waveform::from_orders(&engine, &request, &thetas, &given, &cancel).unwrap();
                assert_eq!(wave.balance.as_ref(), Some(&balance));
                assert_eq!(wave.torque.is_some(), torque && spectrum.is_none());
                for (i, &θ) in thetas.iter().enumerate() {
                    let found = rows(&wave, i);
                    let expected = sum_of_orders(&balance, θ);
                    assert_eq!(found.len(), expected.len());
                    let size: f64 =
                        xy(&balance, Vector::Force).concat().iter().map(|p| p.norm()).sum();
                    for (found, expected) in found.into_iter().zip(expected) {
                        // n·θ to 1e-14, of moments and torques shorter than a metre.
                        assert!((found - expected).abs() <= 7.0 * ROUNDING * size);
                    }
                }
            }
        }
    }
}

/// Equal cylinders with top dead centres at these degrees.
fn at_degrees(degrees: impl Iterator<Item = u32>) -> Engine {
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let place = |k: u32| Station {
        cylinder,
        tdc: Angle::from_degrees(f64::from(k)).unwrap(),
        bank: Angle::ZERO,
        z: 0.0,
        rotating_mass: 0.0,
    };
    Engine::new("", "", degrees.map(place).collect()).unwrap()
}

#[test]
fn chosen_orders_are_summed_or_too_many() {
    let (thetas, cancel) = (thetas(90), Cancel::new());
    let auto = |engine: &Engine, request: &Request, rtol: f64| {
        waveform::from_orders(engine, request, &thetas, &Orders::Auto { rtol }, &cancel)
    };
    let (one, forty) = (at_degrees(0..1), at_degrees(0..40));
    for torque in [true, false] {
        let request = Request { torque, ..REQUEST };
        for (engine, rtol) in [(&one, 1e-12), (&forty, 1e-2)] {
            let summed = auto(engine, &request, rtol).unwrap();
            let orders = Orders::Auto { rtol };
            let chosen = balance(engine, &request, &orders, &cancel).unwrap();
            assert_eq!(summed.balance.as_ref(), Some(&chosen));
            let given = Orders::Given(chosen.orders);
            let again = waveform::from_orders(engine, &request, &thetas, &given, &cancel).unwrap();
            assert_eq!((summed.force, summed.torque), (again.force, again.torque));
        }
    }
    // A rod as long as the crank takes more orders than there are.
    let stiff = Cylinder::new(0.05, 0.05 * (1.0 + 1e-12), 0.5, 0.0).unwrap();
    let stiff = Station { cylinder: stiff, ..one.stations()[0] };
    let stiff = Engine::new("", "", vec![stiff]).unwrap();
    let refused = auto(&stiff, &REQUEST, 1e-6).unwrap_err().to_string();
    assert!(refused.starts_with("rtol = 1e-6: too many orders"), "{refused}");
    // A spectrum is summed, however many orders it has, and has no kinematics.
    let spectrum = Spectrum::new((1..40).map(|n| (n, Complex64::new(1.0, 0.0)))).unwrap();
    let one = one.with_spectrum(spectrum);
    let summed = auto(&one, &REQUEST, 1e-9).unwrap();
    assert_eq!(summed.balance.unwrap().orders.len(), 39);
    let refused = waveform::exact(&one, &REQUEST, &thetas, &cancel).unwrap_err();
    assert!(refused.to_string().starts_with("spectrum = given"));
}

#[test]
fn what_cannot_be_is_refused() {
    let (engine, cancel, given) = (plain(), Cancel::new(), Orders::whole(&[1]).unwrap());
    let raised = Cancel::new();
    raised.raise();
    let both = |request: &Request, thetas: &[f64], cancel: &Cancel| {
        [
            waveform::exact(&engine, request, thetas, cancel).unwrap_err(),
            waveform::from_orders(&engine, request, thetas, &given, cancel).unwrap_err(),
        ]
    };
    for count in [1, 2000] {
        for error in both(&REQUEST, &thetas(count), &raised) {
            assert_eq!(error, Error::Cancelled);
        }
    }
    for (request, theta, told) in [
        (Request { rpm: -1.0, ..REQUEST }, 0.0, "rpm"),
        (Request { reference_z: Some(f64::NAN), ..REQUEST }, 0.0, "reference_z"),
        (REQUEST, f64::NAN, "theta_deg"),
        (REQUEST, 1e13, "theta_deg"),
    ] {
        for error in both(&request, &[0.0, theta], &cancel) {
            assert!(error.to_string().starts_with(told), "{error}");
        }
    }
}

/// Which numbers of [`kinematics`] are a quantity's.
fn components(quantity: Quantity) -> std::ops::Range<usize> {
    match quantity {
        Quantity::FORCE => 0..2,
        Quantity::MOMENT => 2..4,
        TORQUE => 4..5,
        _ => 5..6,
    }
}

const QUANTITIES: [Quantity; 4] = [Quantity::FORCE, Quantity::MOMENT, TORQUE, CRANK_TORQUE];

fn sweep(engines: &[Arc<Engine>], axes: &SweepAxes, orders: &[u32]) -> Sweep {
    Sweep::new(
        engines.to_vec(),
        axes.clone(),
        &Orders::whole(orders).unwrap(),
        Some(REFERENCE),
        true,
        &Cancel::new(),
    )
    .unwrap()
}

fn waveforms(sweep: &Sweep, quantity: Quantity, thetas: &[f64], exact: bool) -> Vec<f64> {
    let shape = sweep.waveform_shape(quantity, thetas.len()).unwrap();
    let components = if components(quantity).len() == 1 { vec![] } else { vec![2] };
    assert_eq!(shape, [&sweep.shape()[..], &[thetas.len()], &components].concat());
    let mut out = vec![f64::NAN; shape.iter().product()];
    let (angles, cancel) = (CrankAngles::new(thetas).unwrap(), Cancel::new());
    sweep.waveforms(quantity, &angles, exact, &mut out, &cancel).unwrap();
    let (done, total) = cancel.progress();
    assert!(done == total && (total > 0 || out.is_empty()), "{done} of {total}");
    out
}

/// Waveforms of a sweep by kinematics are those of each cylinder, and the same, bit for bit, alone;
/// as sums of orders they are the sums of its phasors. At every so many points, and angles.
#[track_caller]
fn each_row_is_a_waveform(
    engines: &[Arc<Engine>],
    axes: &SweepAxes,
    orders: &[u32],
    thetas: &[f64],
    every: [usize; 2],
) {
    let all = sweep(engines, axes, orders);
    for quantity in QUANTITIES {
        let which = components(quantity);
        let width = thetas.len() * which.len();
        let exact = waveforms(&all, quantity, thetas, true);
        let summed = waveforms(&all, quantity, thetas, false);
        let phasors = all.phasors(quantity, Statistic::Amplitude, &Cancel::new()).unwrap();
        let phasors = phasors.as_slice().unwrap();
        let last = phasors.len() / orders.len() / which.len() - 1;
        for (point, place) in places(all.shape()).enumerate() {
            if point % every[0] != 0 && point != last {
                continue;
            }
            let engine = Arc::clone(&engines[place[0]]);
            let axes = alone(axes, place);
            let square = square(axes.rpm[0]);
            let there = there(&engine, &axes);
            let exact = &exact[point * width..][..width];
            let summed = &summed[point * width..][..width];
            let phasors = &phasors[point * orders.len() * which.len()..];
            let only = waveforms(&sweep(&[engine], &axes, orders), quantity, thetas, true);
            assert!(only == exact, "{quantity:?} {place:?}");
            for (i, θ) in thetas.iter().map(|θ| θ.to_radians()).enumerate() {
                if i % every[1] != 0 && i + 1 != thetas.len() {
                    continue;
                }
                let (expected, sizes) = kinematics(&there, REFERENCE, θ);
                for (k, of_all) in which.clone().enumerate() {
                    let slack = ROUNDING * sizes[of_all] * square;
                    let (found, expected) = (exact[i * which.len() + k], expected[of_all] * square);
                    assert!((found - expected).abs() <= slack, "{quantity:?} {place:?} {i} {k}");
                    let terms = orders.iter().zip(phasors.iter().skip(k).step_by(which.len()));
                    let expected: f64 =
                        terms.map(|(&n, p)| (p * Complex64::cis(f64::from(n) * θ)).re).sum();
                    // nθ in radians of order 9.
                    let found = summed[i * which.len() + k];
                    assert!(
                        (found - expected).abs() <= 9.0 * slack,
                        "{quantity:?} {place:?} {i} {k}: {found} {expected}"
                    );
                }
            }
        }
    }
}

/// So many values, evenly from one to another.
fn evenly(count: usize, [from, to]: [f64; 2]) -> Vec<f64> {
    (0..count).map(|k| from + (to - from) * (k as f64 / count as f64)).collect()
}

#[test]
fn each_row_of_a_sweep_is_a_waveform() {
    let engines = [mixed(), plain()];
    let holds = [None, Some(Hold::Pins), Some(Hold::Firing)];
    for k in 0..12 {
        let axes = SweepAxes {
            bank_angle: holds[k % 3].map(|hold| (vec![0.0, 37.0, 90.0], hold)),
            rod_ratio: (k / 3 % 2 == 1).then(|| vec![0.4, 0.1]),
            pin_offset: (k / 6 == 1).then(|| vec![-0.003, 0.0, 0.005]),
            rpm: vec![3000.0, 500.0],
            map: None,
        };
        each_row_is_a_waveform(&engines, &axes, &[1, 2, 4, 6, 3], &thetas(40), [1, 5]);
        each_row_is_a_waveform(&[weighted()], &axes, &[1, 2, 4, 6, 3], &thetas(40), [1, 5]);
    }
    let ratios =
        SweepAxes { rod_ratio: Some(vec![0.3, 0.2]), rpm: vec![RPM], ..SweepAxes::default() };
    each_row_is_a_waveform(&[in_line()], &ratios, &[9, 1], &thetas(3), [1, 1]);
}

#[test]
fn nothing_depends_on_how_many_rows_and_angles_there_are() {
    // Tiles and blocks of 256 angles, spans of 1024, 128 rows that share them, threads or not.
    for count in [1, 255, 256, 257, 1023, 1024, 1025, 2100] {
        for rows in [1, 127, 128, 129, 300] {
            let axes = SweepAxes {
                bank_angle: Some((evenly(rows, [0.0, 180.0]), Hold::Pins)),
                rpm: vec![RPM],
                ..SweepAxes::default()
            };
            if count * rows <= 150_000 {
                each_row_is_a_waveform(&[plain()], &axes, &[1, 2, 4], &thetas(count), [43, 85]);
            }
        }
    }
    let axes = SweepAxes {
        bank_angle: Some((evenly(3, [0.0, 180.0]), Hold::Firing)),
        rod_ratio: Some(evenly(7, [0.1, 0.4])),
        pin_offset: Some(evenly(5, [-0.003, 0.003])),
        rpm: evenly(3, [1000.0, 4000.0]),
        map: None,
    };
    each_row_is_a_waveform(&[mixed(), plain()], &axes, &[1, 2, 4], &thetas(300), [31, 57]);
}

/// Upright and in phase: force has cosines alone, about both axes or one. From none to nine.
#[test]
fn any_number_of_terms_is_added() {
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let place = |bank: f64, tdc: f64| Station {
        cylinder,
        tdc: Angle::from_degrees(tdc).unwrap(),
        bank: Angle::from_degrees(bank).unwrap(),
        z: 0.1,
        rotating_mass: 0.0,
    };
    let engine = |places: &[(f64, f64)]| {
        let stations = places.iter().map(|&(bank, tdc)| place(bank, tdc)).collect();
        Arc::new(Engine::new("", "", stations).unwrap())
    };
    let orders: Vec<u32> = vec![1, 2, 4, 6, 8, 10, 12, 14, 16, 18];
    for count in 1..=orders.len() {
        for speeds in [1, 200] {
            let axes = SweepAxes { rpm: evenly(speeds, [3000.0, 4000.0]), ..SweepAxes::default() };
            for places in [
                &[(90.0, 0.0)][..],
                // Sines as well.
                &[(90.0, 20.0)],
                // Nothing at all, and nothing but order 4, 8, ...
                &[(0.0, 0.0), (180.0, 0.0)],
                &[(90.0, 0.0), (90.0, 90.0), (90.0, 180.0), (90.0, 270.0)],
            ] {
                let engines = [engine(places)];
                each_row_is_a_waveform_of_orders(&engines, &axes, &orders[..count]);
            }
        }
    }
    // However small the masses are.
    let light = Cylinder::new(0.05, 0.15, 1e-20, 0.0).unwrap();
    let light = Station { cylinder: light, ..place(40.0, 20.0) };
    let engines = [Arc::new(Engine::new("", "", vec![light]).unwrap())];
    let axes = SweepAxes { rpm: vec![RPM], ..SweepAxes::default() };
    each_row_is_a_waveform_of_orders(&engines, &axes, &[1, 2, 4]);
}

#[track_caller]
fn each_row_is_a_waveform_of_orders(engines: &[Arc<Engine>], axes: &SweepAxes, orders: &[u32]) {
    let (sweep, thetas) = (sweep(engines, axes, orders), thetas(5));
    for quantity in QUANTITIES {
        let count = components(quantity).len();
        let phasors = sweep.phasors(quantity, Statistic::Amplitude, &Cancel::new()).unwrap();
        let all = waveforms(&sweep, quantity, &thetas, false);
        let points = phasors.as_slice().unwrap().chunks(orders.len() * count);
        for (point, row) in points.zip(all.chunks(thetas.len() * count)) {
            let size: f64 = point.iter().map(|p| p.norm()).sum();
            for (values, θ) in row.chunks(count).zip(&thetas) {
                for (k, value) in values.iter().enumerate() {
                    let of_order = |(place, &n): (usize, &u32)| {
                        (point[place * count + k] * Complex64::cis(f64::from(n) * θ.to_radians()))
                            .re
                    };
                    let expected: f64 = orders.iter().enumerate().map(of_order).sum();
                    assert!((value - expected).abs() <= 18.0 * ROUNDING * size);
                }
            }
        }
    }
}

#[test]
fn waveforms_of_a_sweep_have_their_refusals() {
    let axes = SweepAxes { rpm: vec![RPM, 1000.0], ..SweepAxes::default() };
    let cancel = Cancel::new();
    let angles = CrankAngles::new(&thetas(9)).unwrap();
    let with = |spectrum: Option<Spectrum>, torque: bool| {
        let reference = Some(REFERENCE);
        let engine = spectrum.map_or(plain(), |spectrum| plain().with_spectrum(spectrum).into());
        Sweep::new(
            vec![engine],
            axes.clone(),
            &Orders::whole(&[1]).unwrap(),
            reference,
            torque,
            &Cancel::new(),
        )
        .unwrap()
    };
    let told = |sweep: &Sweep, quantity: Quantity, exact: bool, room: usize| {
        let mut out = vec![0.0; room];
        let result = sweep.waveforms(quantity, &angles, exact, &mut out, &cancel);
        result.err().map(|error| error.to_string()).unwrap_or_default()
    };
    for exact in [true, false] {
        for room in [0, 35, 37] {
            let told = told(&with(None, true), Quantity::FORCE, exact, room);
            assert!(told.starts_with(&format!("out = {room}")), "{told}");
        }
        assert_eq!(told(&with(None, true), Quantity::FORCE, exact, 36), "");
        assert_eq!(told(&with(None, true), TORQUE, exact, 18), "");
        let told = told(&with(None, false), TORQUE, exact, 18);
        assert!(told.starts_with("torque is not available: `torque: false`"), "{told}");
    }
    let spectrum = Spectrum::new([(1, Complex64::new(1.0, 0.0))]).unwrap();
    assert_eq!(told(&with(Some(spectrum.clone()), true), Quantity::FORCE, false, 36), "");
    let told = told(&with(Some(spectrum), true), Quantity::FORCE, true, 36);
    assert!(told.starts_with("spectrum = given"), "{told}");

    let raised = Cancel::new();
    raised.raise();
    for count in [3, 20_000] {
        let angles = CrankAngles::new(&thetas(count)).unwrap();
        for exact in [true, false] {
            let mut out = vec![0.0; 4 * count];
            let result =
                with(None, true).waveforms(Quantity::FORCE, &angles, exact, &mut out, &raised);
            assert_eq!(result, Err(Error::Cancelled));
        }
    }
    assert!(waveforms(&with(None, true), Quantity::FORCE, &[], true).is_empty());
}
