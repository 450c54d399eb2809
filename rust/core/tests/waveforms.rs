//! Waveforms: of an engine and of a sweep, as each cylinder's motion written out plainly makes them,
//! and as sums of orders.

mod common;

use std::sync::Arc;

use common::{alone, in_line, mixed, places, plain, there};
use crankpin_core::sweep::{Axes, Quantity};
use crankpin_core::{
    Angle, Asked, Balance, Cancel, Complex64, CrankAngles, Cylinder, Engine, Error, Hold, Orders,
    Placement, Spectrum, Sweep, Waveform, balance, waveform,
};

const REFERENCE: f64 = 0.07;
const RPM: f64 = 3000.0;
const ASKED: Asked = Asked { rpm: RPM, reference_z: Some(REFERENCE), spectrum: None, torque: true };

fn square(rpm: f64) -> f64 {
    (rpm * std::f64::consts::TAU / 60.0).powi(2)
}

/// Force x, y, moment x, y, roll and crank torque over ω²; and the sizes of their terms.
fn kinematics(engine: &Engine, θ: f64) -> ([f64; 6], [f64; 6]) {
    let (mut sums, mut sizes) = ([0.0; 6], [0.0; 6]);
    for p in engine.placements() {
        let (c, bank, pin) = (p.cylinder, p.bank.cis(1), p.pin().degrees().to_radians());
        let (r, lever) = (c.crank_radius(), p.z - REFERENCE);
        let (sin, cos) = (θ - p.tdc.degrees().to_radians()).sin_cos();
        // x = cos θ + h with h² = (l/r)² − u², u = sin θ − e/r, in radii.
        let (rod, offset) = (c.rod_length() / r, c.pin_offset() / r);
        let u = sin - offset;
        let h = (rod * rod - u * u).sqrt();
        let velocity = -sin - u * cos / h;
        let acceleration = -cos - (cos * cos - u * sin) / h - (u * cos).powi(2) / h.powi(3);
        let along = -c.first_order() * acceleration;
        let turning = Complex64::cis(pin + θ) * (p.rotating_mass * r);
        let force = bank * along + turning;
        // A force across the bore at the piston, and one along it at the crank: r × F.
        let weight = c.first_order() * r * acceleration;
        // sin φ = u/(l/r): how the rod swings.
        let swing = cos / h;
        let bend = (u * swing * swing - sin) / h;
        let inertia = c.rod_inertia_excess() * bend;
        let terms = [
            force.re,
            force.im,
            -lever * force.im,
            lever * force.re,
            weight * (velocity + offset) + inertia * (1.0 + swing),
            -weight * velocity - inertia * swing,
        ];
        let moved = c.first_order() * 3.0 + turning.norm();
        let torque = 5.0 * moved * r + 3.0 * c.rod_inertia_excess().abs();
        let levered = moved * (p.z.abs() + REFERENCE);
        let size = [moved, moved, levered, levered, torque, torque];
        for k in 0..6 {
            sums[k] += terms[k];
            sizes[k] += size[k];
        }
    }
    (sums, sizes)
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
    for engine in [mixed(), plain(), in_line()] {
        // Blocks of 256, and enough of them for threads.
        for count in [0, 1, 255, 256, 257, 1024, 1025, 1300] {
            let thetas = thetas(count);
            let cancel = Cancel::new();
            let wave = waveform::exact(&engine, &ASKED, &thetas, &cancel).unwrap();
            assert_eq!(wave.force.shape(), [count, 2]);
            assert!(wave.balance.is_none());
            let asked = Asked { torque: false, ..ASKED };
            let planar = waveform::exact(&engine, &asked, &thetas, &cancel).unwrap();
            assert_eq!((&planar.force, &planar.moment), (&wave.force, &wave.moment));
            assert!(planar.torque.is_none() && planar.crank_torque.is_none());
            for (i, θ) in thetas.iter().enumerate() {
                let (expected, sizes) = kinematics(&engine, θ.to_radians());
                for (k, found) in rows(&wave, i).into_iter().enumerate() {
                    let off = (found - expected[k] * square(RPM)).abs();
                    assert!(off <= ROUNDING * sizes[k] * square(RPM), "{count} {θ} {k}: {found}");
                }
            }
        }
    }
}

/// Σ Re(P e^{inθ}) of force x, y, moment x, y, roll and crank torque.
fn sum_of_orders(balance: &Balance, θ: f64) -> Vec<f64> {
    let mut sums = vec![0.0; if balance.torque.is_some() { 6 } else { 4 }];
    for (k, &n) in balance.orders.iter().enumerate() {
        let unit = Complex64::cis(f64::from(n) * θ.to_radians());
        let [force, moment] = [&balance.force.xy, &balance.moment.xy];
        let mut phasors = vec![force[[k, 0]], force[[k, 1]], moment[[k, 0]], moment[[k, 1]]];
        phasors.extend(balance.torque.iter().flat_map(|torque| [torque.roll[k], torque.crank[k]]));
        for (sum, phasor) in sums.iter_mut().zip(phasors) {
            *sum += (phasor * unit).re;
        }
    }
    sums
}

#[test]
fn sums_of_orders_are_sums_of_orders() {
    let spectrum = Spectrum::new([(1, Complex64::new(0.02, 0.003)), (4, Complex64::i())]).unwrap();
    for engine in [mixed(), plain(), in_line()] {
        for (spectrum, torque) in [(None, true), (None, false), (Some(&spectrum), true)] {
            let asked = Asked { spectrum, torque, ..ASKED };
            let given = Orders::Given(vec![1, 4, 2, 7]);
            let balance = balance::of(&engine, &asked, &given, &Cancel::new()).unwrap();
            for count in [1, 256, 257, 1300] {
                let thetas = thetas(count);
                let cancel = Cancel::new();
                let wave =
                    waveform::from_orders(&engine, &asked, &thetas, &given, &cancel).unwrap();
                assert_eq!(wave.balance.as_ref(), Some(&balance));
                assert_eq!(wave.torque.is_some(), torque && spectrum.is_none());
                for (i, &θ) in thetas.iter().enumerate() {
                    let found = rows(&wave, i);
                    let expected = sum_of_orders(&balance, θ);
                    assert_eq!(found.len(), expected.len());
                    let size: f64 = balance.force.xy.iter().map(|p| p.norm()).sum();
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
    let place = |k: u32| Placement {
        cylinder,
        tdc: Angle::from_degrees(f64::from(k)).unwrap(),
        bank: Angle::ZERO,
        z: 0.0,
        rotating_mass: 0.0,
    };
    Engine::new("", "", degrees.map(place).collect()).unwrap()
}

#[test]
fn waveforms_keep_their_tolerance_whichever_way_is_taken() {
    let thetas = thetas(90);
    let cancel = Cancel::new();
    let of = |engine: &Engine, asked: &Asked, rtol: f64| {
        waveform::from_orders(engine, asked, &thetas, &Orders::Auto { rtol }, &cancel).unwrap()
    };
    let turned = |count: u32| at_degrees(0..count);
    for torque in [true, false] {
        let asked = Asked { torque, ..ASKED };
        // One cylinder to many orders, and forty to few.
        let (one, forty) = (of(&turned(1), &asked, 1e-12), of(&turned(40), &asked, 1e-2));
        assert_eq!(one, waveform::exact(&turned(1), &asked, &thetas, &cancel).unwrap());
        let balance =
            balance::of(&turned(40), &asked, &Orders::Auto { rtol: 1e-2 }, &Cancel::new()).unwrap();
        assert_eq!(forty.balance.as_ref(), Some(&balance));
    }
    // A rod as long as the crank takes more orders than there are.
    let stiff = Cylinder::new(0.05, 0.05 * (1.0 + 1e-12), 0.5, 0.0).unwrap();
    let stiff = Placement { cylinder: stiff, ..turned(1).placements()[0] };
    let stiff = Engine::new("", "", vec![stiff; 40]).unwrap();
    let exact = waveform::exact(&stiff, &ASKED, &thetas, &cancel).unwrap();
    assert_eq!(of(&stiff, &ASKED, 1e-6), exact);
    // A spectrum is summed, however many orders it has, and has no kinematics.
    let spectrum = Spectrum::new((1..40).map(|n| (n, Complex64::new(1.0, 0.0)))).unwrap();
    let asked = Asked { spectrum: Some(&spectrum), ..ASKED };
    let summed = of(&turned(1), &asked, 1e-9);
    assert_eq!(summed.balance.unwrap().orders.len(), 39);
    let refused = waveform::exact(&turned(1), &asked, &thetas, &cancel).unwrap_err();
    assert!(refused.to_string().starts_with("spectrum = given"));
}

#[test]
fn what_cannot_be_is_refused() {
    let (engine, cancel, given) = (plain(), Cancel::new(), Orders::Given(vec![1]));
    let raised = Cancel::new();
    raised.raise();
    let both = |asked: &Asked, thetas: &[f64], cancel: &Cancel| {
        [
            waveform::exact(&engine, asked, thetas, cancel).unwrap_err(),
            waveform::from_orders(&engine, asked, thetas, &given, cancel).unwrap_err(),
        ]
    };
    for count in [1, 2000] {
        for error in both(&ASKED, &thetas(count), &raised) {
            assert_eq!(error, Error::Cancelled);
        }
    }
    for (asked, theta, told) in [
        (Asked { rpm: -1.0, ..ASKED }, 0.0, "rpm"),
        (Asked { reference_z: Some(f64::NAN), ..ASKED }, 0.0, "reference_z"),
        (ASKED, f64::NAN, "theta_deg"),
        (ASKED, 1e13, "theta_deg"),
    ] {
        for error in both(&asked, &[0.0, theta], &cancel) {
            assert!(error.to_string().starts_with(told), "{error}");
        }
    }
}

/// Which numbers of [`kinematics`] are a quantity's.
fn components(quantity: Quantity) -> std::ops::Range<usize> {
    match quantity {
        Quantity::Force => 0..2,
        Quantity::Moment => 2..4,
        Quantity::Torque => 4..5,
        Quantity::CrankTorque => 5..6,
    }
}

const QUANTITIES: [Quantity; 3] = [Quantity::Force, Quantity::Moment, Quantity::Torque];

fn sweep(engines: &[Arc<Engine>], axes: &Axes, orders: &[u32]) -> Sweep {
    let (axes, orders) = (axes.clone(), orders.to_vec());
    Sweep::new(engines.to_vec(), axes, orders, Some(REFERENCE), None, &Cancel::new()).unwrap()
}

fn waveforms(sweep: &Sweep, quantity: Quantity, thetas: &[f64], exact: bool) -> Vec<f64> {
    let shape = sweep.waveform_shape(quantity, thetas.len()).unwrap();
    let components = if quantity == Quantity::Torque { vec![] } else { vec![2] };
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
    axes: &Axes,
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
        let phasors = all.phasors(quantity, &Cancel::new()).unwrap();
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
                let (expected, sizes) = kinematics(&there, θ);
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
        let axes = Axes {
            bank_angle: holds[k % 3].map(|hold| (vec![0.0, 37.0, 90.0], hold)),
            rod_ratio: (k / 3 % 2 == 1).then(|| vec![0.4, 0.1]),
            pin_offset: (k / 6 == 1).then(|| vec![-0.003, 0.0, 0.005]),
            rpm: vec![3000.0, 500.0],
        };
        each_row_is_a_waveform(&engines, &axes, &[1, 2, 4, 6, 3], &thetas(40), [1, 5]);
    }
    let ratios = Axes { rod_ratio: Some(vec![0.3, 0.2]), rpm: vec![RPM], ..Axes::default() };
    each_row_is_a_waveform(&[in_line()], &ratios, &[9, 1], &thetas(3), [1, 1]);
}

#[test]
fn nothing_depends_on_how_many_rows_and_angles_there_are() {
    // Tiles and blocks of 256 angles, spans of 1024, 128 rows that share them, threads or not.
    for count in [1, 255, 256, 257, 1023, 1024, 1025, 2100] {
        for rows in [1, 127, 128, 129, 300] {
            let axes = Axes {
                bank_angle: Some((evenly(rows, [0.0, 180.0]), Hold::Pins)),
                rpm: vec![RPM],
                ..Axes::default()
            };
            if count * rows <= 150_000 {
                each_row_is_a_waveform(&[plain()], &axes, &[1, 2, 4], &thetas(count), [43, 85]);
            }
        }
    }
    let axes = Axes {
        bank_angle: Some((evenly(3, [0.0, 180.0]), Hold::Firing)),
        rod_ratio: Some(evenly(7, [0.1, 0.4])),
        pin_offset: Some(evenly(5, [-0.003, 0.003])),
        rpm: evenly(3, [1000.0, 4000.0]),
    };
    each_row_is_a_waveform(&[mixed(), plain()], &axes, &[1, 2, 4], &thetas(300), [31, 57]);
}

/// Upright and in phase: force has cosines alone, about both axes or one. From none to nine.
#[test]
fn any_number_of_terms_is_added() {
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let place = |bank: f64, tdc: f64| Placement {
        cylinder,
        tdc: Angle::from_degrees(tdc).unwrap(),
        bank: Angle::from_degrees(bank).unwrap(),
        z: 0.1,
        rotating_mass: 0.0,
    };
    let engine = |places: &[(f64, f64)]| {
        let placements = places.iter().map(|&(bank, tdc)| place(bank, tdc)).collect();
        Arc::new(Engine::new("", "", placements).unwrap())
    };
    let orders: Vec<u32> = vec![1, 2, 4, 6, 8, 10, 12, 14, 16, 18];
    for count in 1..=orders.len() {
        for speeds in [1, 200] {
            let axes = Axes { rpm: evenly(speeds, [3000.0, 4000.0]), ..Axes::default() };
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
    let light = Placement { cylinder: light, ..place(40.0, 20.0) };
    let engines = [Arc::new(Engine::new("", "", vec![light]).unwrap())];
    let axes = Axes { rpm: vec![RPM], ..Axes::default() };
    each_row_is_a_waveform_of_orders(&engines, &axes, &[1, 2, 4]);
}

#[track_caller]
fn each_row_is_a_waveform_of_orders(engines: &[Arc<Engine>], axes: &Axes, orders: &[u32]) {
    let (sweep, thetas) = (sweep(engines, axes, orders), thetas(5));
    for quantity in QUANTITIES {
        let count = components(quantity).len();
        let phasors = sweep.phasors(quantity, &Cancel::new()).unwrap();
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

/// Whether kinematics take less time depends on how many groups there are to how many orders.
#[test]
fn kinematics_cost_less_than_many_orders() {
    // Two alike among them: they move as one.
    let engine = |groups: u32| Arc::new(at_degrees((0..groups).chain([0])));
    let axes = Axes { rpm: vec![RPM], ..Axes::default() };
    let less = |engines: &[Arc<Engine>], orders: u32| {
        sweep(engines, &axes, &(1..=orders).collect::<Vec<_>>()).kinematics_cost_less()
    };
    for groups in 1..8 {
        for orders in 1..16 {
            let one = less(&[engine(groups)], orders);
            assert_eq!(less(&[engine(2 * groups)], 2 * orders), one, "{groups} {orders}");
            // Each of four engines is summed.
            let four = [engine(groups), engine(1), engine(2 * groups - 1), engine(groups)];
            assert_eq!(less(&four, orders), one, "{groups} {orders}");
        }
    }
    assert!(less(&[engine(1)], 16) && !less(&[engine(16)], 1));
    let spectrum = Spectrum::new((1..40).map(|n| (n, Complex64::i()))).unwrap();
    let orders = (1..40).collect();
    let measured =
        Sweep::new(vec![engine(1)], axes.clone(), orders, None, Some(spectrum), &Cancel::new());
    assert!(!measured.unwrap().kinematics_cost_less());
}

#[test]
fn waveforms_of_a_sweep_have_their_refusals() {
    let axes = Axes { rpm: vec![RPM, 1000.0], ..Axes::default() };
    let cancel = Cancel::new();
    let angles = CrankAngles::new(&thetas(9)).unwrap();
    let with = |spectrum: Option<Spectrum>| {
        let reference = Some(REFERENCE);
        Sweep::new(vec![plain()], axes.clone(), vec![1], reference, spectrum, &cancel).unwrap()
    };
    let told = |sweep: &Sweep, quantity: Quantity, exact: bool, room: usize| {
        let mut out = vec![0.0; room];
        let result = sweep.waveforms(quantity, &angles, exact, &mut out, &cancel);
        result.err().map(|error| error.to_string()).unwrap_or_default()
    };
    for exact in [true, false] {
        for room in [0, 35, 37] {
            let told = told(&with(None), Quantity::Force, exact, room);
            assert!(told.starts_with(&format!("out = {room}")), "{told}");
        }
        assert_eq!(told(&with(None), Quantity::Force, exact, 36), "");
        assert_eq!(told(&with(None), Quantity::Torque, exact, 18), "");
        let told = told(&with(None).without_torque(), Quantity::Torque, exact, 18);
        assert!(told.starts_with("torque = False"), "{told}");
    }
    let spectrum = Spectrum::new([(1, Complex64::new(1.0, 0.0))]).unwrap();
    assert_eq!(told(&with(Some(spectrum.clone())), Quantity::Force, false, 36), "");
    let told = told(&with(Some(spectrum)), Quantity::Force, true, 36);
    assert!(told.starts_with("spectrum = given"), "{told}");

    let raised = Cancel::new();
    raised.raise();
    for count in [3, 20_000] {
        let angles = CrankAngles::new(&thetas(count)).unwrap();
        for exact in [true, false] {
            let mut out = vec![0.0; 4 * count];
            let result = with(None).waveforms(Quantity::Force, &angles, exact, &mut out, &raised);
            assert_eq!(result, Err(Error::Cancelled));
        }
    }
    assert!(waveforms(&with(None), Quantity::Force, &[], true).is_empty());
}
