//! Figures of an inline four on four mounts, and laws of random powertrains under random engines.

use nalgebra::Vector3;

use super::*;
use crate::engine::Station;
use crate::mechanism::cylinder::Cylinder;
use crate::mounts::tests::{four_mounts, random};
use crate::numbers::angle::Angle;
use crate::numbers::draws;
use crate::readings::balance::{Request, balance};
use crate::readings::peaks::largest_vectors;

fn degrees(degrees: f64) -> Angle {
    Angle::from_degrees(degrees).unwrap()
}

fn station(cylinder: Cylinder, tdc: f64, bank: f64, z: f64) -> Station {
    Station { cylinder, tdc: degrees(tdc), bank: degrees(bank), z, rotating_mass: 0.0 }
}

/// An inline four of 0.45 kg, r 43 mm, l 145 mm, its mid-plane at z = 0.
fn inline_four() -> Engine {
    let cylinder = Cylinder::new(0.043, 0.145, 0.45, 0.0).unwrap();
    let places = [(0.0, -0.15), (180.0, -0.05), (180.0, 0.05), (0.0, 0.15)];
    let stations = places.map(|(tdc, z)| station(cylinder, tdc, 90.0, z));
    Engine::new("", "", stations.to_vec()).unwrap()
}

/// The crank 60 mm below the CG of the body on four mounts: everything moved up by that.
fn crank_below() -> Arc<Powertrain> {
    let [loss, up] = [0.1, 0.06];
    let of_cg = four_mounts(loss);
    let rows = |m: nalgebra::Matrix3<f64>| [0, 1, 2].map(|i| [0, 1, 2].map(|j| m[(i, j)]));
    let body =
        crate::mounts::RigidBody::new(150.0, [0.0, up, 0.0], rows(of_cg.body().inertia()), None);
    let mounts = of_cg.mounts().iter().map(|mount| {
        let mut figures = mount.figures().clone();
        figures.at[1] += up;
        crate::mounts::Mount::new(figures).unwrap()
    });
    Arc::new(Powertrain::new(body.unwrap(), mounts.collect()).unwrap())
}

fn whole(orders: &[u32]) -> Orders {
    Orders::whole(orders).unwrap()
}

fn assert_near(value: f64, expected: f64) {
    // Figures have eight digits.
    assert!((value - expected).abs() <= 6e-8 * expected.abs(), "{value} is not {expected}");
}

#[test]
fn an_inline_four_at_3000_rpm() {
    let cancel = Cancel::new();
    let response =
        Response::new(&inline_four(), crank_below(), &[3000.0], &whole(&[2, 4, 6]), &cancel)
            .unwrap();
    assert_near(response.loads()[0][1].norm(), 2317.3515);
    assert_near(response.loads()[0][5].norm(), 164.327_04);
    let sums = response.support_loads(&cancel).unwrap();
    assert_near(sums[0][1].norm(), 48.169_592);
    assert_near(sums[0][0].norm(), 10.606_355);
    assert_near(response.motions()[0][1].norm(), 39.942_113e-6);
    let free = response.loads()[0][1].norm() / (200.0 * std::f64::consts::PI).powi(2) / 150.0;
    assert_near(free, 39.1328e-6);
    let power = response.power(&cancel).unwrap();
    assert_near(power[0][2..].iter().sum(), 83.048_425e-3);
    assert_near(power[0][0], 83.048_425e-3);
    let head = [0.0, 0.06 + 0.35, 0.0];
    let velocity = response.at(head, Derivative::Velocity, false, &cancel).unwrap();
    let rms =
        |axis: usize| (velocity.iter().map(|v| v[axis].norm_sqr()).sum::<f64>() / 2.0).sqrt() * 1e3;
    assert_near(rms(1), 17.746_952);
    assert_near(rms(0), 14.966_088);
    // 17.7 mm/s, most of it at 100 Hz.
    assert_eq!(response.grades(head, false, &cancel).unwrap(), [18.0]);
}

#[test]
fn a_half_order_of_torque_rolls_the_engine() {
    // 60 N m about z at order 1/2 of 800 rpm.
    let on_mounts = crank_below();
    let omega = TAU * 800.0 / 120.0;
    let mut load = ComplexVector6::zeros();
    load[5] = Complex64::from(60.0);
    let along = on_mounts.stiffnesses(omega, String::new).unwrap();
    let motion = on_mounts.motion(&along, omega, &load).unwrap();
    assert_near(motion[5].norm().to_degrees(), 0.095_812_975);
}

/// A random vee of one to six cylinders.
fn random_engine(number: &mut impl FnMut() -> f64) -> Engine {
    let count = 1 + (2.5 * (number() + 1.0)) as usize;
    let stations = (0..count).map(|k| {
        let cylinder = Cylinder::new(0.05, 0.15, 0.6 + 0.5 * number(), 0.01 * number()).unwrap();
        let bank = if k.is_multiple_of(2) { 60.0 } else { 120.0 };
        let mut place = station(cylinder, (180.0 * number()).round(), bank, number());
        place.rotating_mass = 0.3 + 0.2 * number();
        place
    });
    Engine::new("", "", stations.collect()).unwrap()
}

#[test]
fn loads_are_those_about_the_centre_of_gravity() {
    let (mut number, cancel) = (draws(25), Cancel::new());
    for k in 0..20 {
        let engine = match k % 2 {
            0 => random_engine(&mut number),
            _ => crate::load::tests::fired([Some(0), None, Some(0)]).0,
        };
        let on_mounts = Arc::new(random(&mut number, true));
        let [x, y, z] = on_mounts.body().cg().into();
        let (rpm, orders) = (2000.0 * (1.1 + number()), whole(&[1, 2, 4]));
        let response = Response::new(&engine, on_mounts, &[rpm], &orders, &cancel).unwrap();
        // About the crank's axis at z = 0, less r × F of the centre of gravity.
        let request = Request { rpm, reference_z: Some(0.0), torque: true };
        let about_crank = balance(&engine, &request, &orders, &cancel).unwrap();
        for (wrench, load) in about_crank.wrenches.iter().zip(response.loads()) {
            let ([force_x, force_y], [pitch, yaw]) = (wrench.force.xy(0.0), wrench.moment.xy(0.0));
            let expected = ComplexVector6::new(
                force_x,
                force_y,
                Complex64::ZERO,
                pitch + force_y * z,
                yaw - force_x * z,
                wrench.torque.roll - (force_y * x - force_x * y),
            );
            // Some ten roundings of what is added up.
            let size = load.norm() * (1.0 + x.abs() + y.abs() + z.abs());
            assert!((load - expected).norm() <= 1e-12 * size, "{load} {expected}");
        }
    }
}

#[test]
fn what_orders_left_out_add_at_any_speed_is_bounded() {
    let (mut number, cancel) = (draws(26), Cancel::new());
    for _ in 0..20 {
        let (engine, on_mounts) = (random_engine(&mut number), Arc::new(random(&mut number, true)));
        let fastest = 3000.0 * (1.2 + number());
        let rpm = [0.2 * fastest, fastest, 0.7 * fastest];
        let loads = |rpm: &[f64], orders| {
            Response::new(&engine, Arc::clone(&on_mounts), rpm, &orders, &cancel).unwrap()
        };
        let found = loads(&rpm, Orders::Auto { rtol: 0.1 });
        let (bound, omitted) = (found.error_bound(), found.omitted().to_vec());
        if omitted.is_empty() {
            continue;
        }
        let rest = loads(&[fastest], Orders::Given(omitted));
        let sum = |axis: usize| rest.loads().iter().map(|load| load[axis].norm()).sum::<f64>();
        assert!(sum(0).max(sum(1)) <= bound.force * (1.0 + 1e-12), "{} {bound:?}", sum(1));
        assert!(sum(3).max(sum(4)) <= bound.moment * (1.0 + 1e-12), "{} {bound:?}", sum(3));
        assert!(sum(5) <= bound.torque * (1.0 + 1e-12), "{} {bound:?}", sum(5));
    }
}

#[test]
fn points_move_as_their_derivatives_and_grades_are_those_of_each_speed() {
    let (mut number, cancel) = (draws(27), Cancel::new());
    for _ in 0..10 {
        let (engine, on_mounts) = (random_engine(&mut number), Arc::new(random(&mut number, true)));
        let rpm = [0.0; 3].map(|_| 3000.0 * (1.2 + number()));
        let response = |rpm: &[f64]| {
            Response::new(&engine, Arc::clone(&on_mounts), rpm, &whole(&[1, 2, 4]), &cancel)
                .unwrap()
        };
        let (found, point) = (response(&rpm), [0; 3].map(|_| number()));
        let at = |derivative| found.at(point, derivative, false, &cancel).unwrap();
        let [velocity, acceleration] = [Derivative::Velocity, Derivative::Acceleration].map(at);
        for (k, (slower, faster)) in velocity.iter().zip(&acceleration).enumerate() {
            for (slower, faster) in slower.iter().zip(faster) {
                let expected = slower * Complex64::new(0.0, found.omega_of(k));
                assert!((faster - expected).norm() <= 1e-14 * expected.norm());
            }
        }
        let alone = rpm.map(|rpm| response(&[rpm]).grades(point, false, &cancel).unwrap()[0]);
        assert_eq!(found.grades(point, false, &cancel).unwrap(), alone);
    }
}

#[test]
fn forces_moments_and_power_balance() {
    let (mut number, cancel) = (draws(21), Cancel::new());
    for _ in 0..30 {
        let engine = random_engine(&mut number);
        let on_mounts = Arc::new(random(&mut number, true));
        let rpm = [0.0, 300.0 * (1.1 + number()), 3000.0 * (1.1 + number())];
        let auto = Orders::Auto { rtol: 1e-9 };
        let response =
            Response::new(&engine, Arc::clone(&on_mounts), &rpm, &auto, &cancel).unwrap();
        let mass = on_mounts.body().mass_matrix().map(Complex64::from);
        let cg = on_mounts.body().cg();
        let forces = response.mount_forces(&cancel).unwrap();
        let sums = response.support_loads(&cancel).unwrap();
        let power = response.power(&cancel).unwrap();
        let count = on_mounts.mounts().len();
        for (point, load) in response.loads().iter().enumerate() {
            let (motion, omega) = (response.motions()[point], response.omega_of(point));
            let inertia = mass * motion * Complex64::from(omega * omega);
            let expected = load + inertia;
            // Sizes of what is added up, and some hundred roundings of each.
            let size = load.norm() + inertia.norm() + sums[point].norm();
            assert!((expected - sums[point]).norm() <= 1e-12 * size);
            let mut sum = ComplexVector6::zeros();
            for (mount, force) in on_mounts.mounts().iter().zip(&forces[point * count..]) {
                let arm = (mount.at() - cg).map(Complex64::from);
                let force = Vector3::from(*force);
                let moment = arm.cross(&force);
                sum += ComplexVector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
            }
            assert!((sum - sums[point]).norm() <= 1e-12 * size);
            let lost: f64 = power[point][2..].iter().sum();
            // Reactive power is what the power put in is the small rest of.
            let reactive = omega * load.norm() * motion.norm();
            assert!((lost - power[point][0]).abs() <= 1e-12 * reactive);
            assert!(power[point].iter().skip(2).all(|&lost| lost >= 0.0));
        }
        assert!(response.error_bound().force >= 0.0);
    }
}

#[test]
fn receptances_are_reciprocal_and_have_the_limits_of_springs_and_of_a_free_body() {
    let mut number = draws(22);
    for _ in 0..30 {
        let on_mounts = random(&mut number, true);
        let unit = |k: usize| {
            let mut load = ComplexVector6::zeros();
            load[k] = Complex64::ONE;
            load
        };
        let mass = on_mounts.body().mass_matrix().map(Complex64::from);
        let motions = |omega: f64| {
            let along = on_mounts.stiffnesses(omega, String::new).unwrap();
            [0, 1, 2, 3, 4, 5].map(|k| on_mounts.motion(&along, omega, &unit(k)).unwrap())
        };
        let between = motions(30.0);
        for (i, j) in (0..6).flat_map(|i| (0..i).map(move |j| (i, j))) {
            let size = (between[i][i] * between[j][j]).norm().sqrt();
            assert!((between[i][j] - between[j][i]).norm() < 1e-12 * size);
        }
        let rest = on_mounts.assembled(&on_mounts.stiffnesses(0.0, String::new).unwrap());
        for (k, motion) in motions(0.0).iter().enumerate() {
            assert!((rest * motion - unit(k)).norm() < 1e-10);
        }
        let omega = 1e9;
        for (k, motion) in motions(omega).iter().enumerate() {
            let free = mass * motion * Complex64::from(-omega * omega);
            // Viscous damping falls with the speed alone.
            assert!((free - unit(k)).norm() < 1e-4);
        }
    }
}

#[test]
fn undamped_resonance_and_tables_left_are_named() {
    let cancel = Cancel::new();
    let on_mounts = Arc::new(four_mounts(0.0));
    let vertical = crate::mounts::modes(&on_mounts, None).unwrap().frequency[2];
    let rpm = [1000.0, vertical * 30.0];
    let error = Response::new(&inline_four(), on_mounts, &rpm, &whole(&[4, 2]), &cancel);
    let error = error.unwrap_err().to_string();
    assert!(error.contains("order 2 is at 14.235251 Hz"), "{error}");
    let mut figures = four_mounts(0.0).mounts()[0].figures().clone();
    let stiffness = vec![[Complex64::new(1e5, 1e4); 3]; 2];
    figures.table = Some(crate::mounts::Table { frequency: vec![0.0, 90.0], stiffness });
    let mut mounts = four_mounts(0.1).mounts().to_vec();
    mounts[0] = crate::mounts::Mount::new(figures).unwrap();
    let on_mounts = Arc::new(Powertrain::new(*four_mounts(0.1).body(), mounts).unwrap());
    let response = |rpm: f64| {
        let on_mounts = Arc::clone(&on_mounts);
        Response::new(&inline_four(), on_mounts, &[rpm], &whole(&[2]), &cancel)
    };
    assert!(response(2699.0).is_ok());
    let error = response(3000.0).unwrap_err().to_string();
    let said = "table of mount \"0\" = 100.000000 Hz: order 2 at 3000 rpm, is outside";
    assert!(error.starts_with(said), "{error}");
}

#[test]
fn peaks_of_vectors_in_space_are_true() {
    let (mut number, cancel) = (draws(23), Cancel::new());
    let some =
        |halves: &[u32]| halves.iter().map(|&h| Order::from_halves(h).unwrap()).collect::<Vec<_>>();
    let many: Vec<u32> = (1..260).collect();
    for halves in [&[4][..], &[1, 2, 3, 8], &many] {
        let orders = some(halves);
        let mut draw = || Complex64::new(number(), number());
        let phasors: Vec<[Complex64; 3]> =
            orders.iter().map(|_| [draw(), draw(), draw()]).collect();
        let peaks = largest_vectors(&orders, &phasors, &cancel).unwrap()[0];
        let mut sampled = [0.0_f64; 4];
        let samples = 40 * 1024;
        for k in 0..samples {
            let theta = 2.0 * TAU * f64::from(k) / f64::from(samples);
            let mut vector = [0.0; 3];
            for (order, phasor) in orders.iter().zip(&phasors) {
                let unit = Complex64::cis(order.number() * theta);
                (0..3).for_each(|axis| vector[axis] += (phasor[axis] * unit).re);
            }
            let length = Vector3::from(vector).norm();
            for (largest, value) in
                sampled.iter_mut().zip([vector[0], vector[1], vector[2], length])
            {
                *largest = largest.max(value.abs());
            }
        }
        for (peak, sampled) in peaks.iter().zip(sampled) {
            assert!(*peak >= sampled * (1.0 - 1e-12) && *peak < sampled * (1.0 + 2e-4), "{peak}");
        }
    }
}

/// A point mass above another one, alone in the vertical: mount below the upper, spring below the lower.
fn two_stages(below: f64) -> Powertrain {
    let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let stage = |mass: f64, stiffness: f64, loss: f64| {
        let body = crate::mounts::RigidBody::new(mass, [0.0; 3], unit, None).unwrap();
        let figures = crate::mounts::MountFigures {
            loss_factor: [loss; 3],
            ..crate::mounts::tests::mount("below", [0.0; 3], [stiffness; 3])
        };
        Powertrain::new(body, vec![crate::mounts::Mount::new(figures).unwrap()]).unwrap()
    };
    let subframe = stage(below, 4e5, 0.05);
    stage(150.0, 1.2e6, 0.1).on(Support::Subframe(Box::new(subframe))).unwrap()
}

/// State under 1 N along y.
fn pushed(powertrain: &Powertrain, omega: f64) -> (State, [Complex64; 3]) {
    let load = nalgebra::Vector6::new(0.0, 1.0, 0.0, 0.0, 0.0, 0.0).map(Complex64::from);
    let along = powertrain.stiffnesses(omega, String::new).unwrap();
    let state = powertrain.state(&along, omega, &load, String::new).unwrap().unwrap();
    let deflection = powertrain.deflection(0, &state.motion, state.carrier.first());
    let force = powertrain.force_on_support(0, &along[0], &deflection);
    (state, force)
}

#[test]
fn a_mass_on_a_mass_passes_more_than_on_a_fixed_floor() {
    let cancel = Cancel::new();
    let omega = TAU * 25.0;
    let (state, force) = pushed(&two_stages(300.0), omega);
    assert_near(force[1].norm(), 0.642_787_54);
    assert_near(state.subframe[1].norm() * omega * omega, 0.002_265_013_1);
    let (_, on_floor) = pushed(&two_stages(1e15), omega);
    assert_near(on_floor[1].norm(), 0.481_627_52);
    // As a receptance, and as 1/k = 1/k + H.
    let stiffness = Complex64::new(4e5, 2e4) - 300.0 * omega * omega;
    let receptance = |values: Complex64, imaginary: f64| {
        crate::mounts::Receptance {
            coordinates: vec![("below".into(), 1)],
            frequency: vec![20.0, 25.0, 30.0],
            values: vec![vec![values + Complex64::new(0.0, imaginary)]; 3],
            receivers: vec![crate::mounts::Receiver {
                name: "seat rail".into(),
                transfer: vec![vec![[Complex64::ZERO, values * 2.0, Complex64::ZERO]]; 3],
            }],
        }
        .checked()
        .map(Support::Receptance)
    };
    let measured = two_stages(300.0).on(receptance(stiffness.inv(), 0.0).unwrap()).unwrap();
    let (state, force) = pushed(&measured, omega);
    assert_near(force[1].norm(), 0.642_787_54);
    assert_near((state.carrier[0].y * omega * omega).norm(), 0.002_265_013_1);
    let (_, on_floor) =
        pushed(&two_stages(300.0).on(receptance(Complex64::ZERO, 0.0).unwrap()).unwrap(), omega);
    assert_near(on_floor[1].norm(), 0.481_627_52);
    // The receiver moves twice as far as what carries the mount.
    let response =
        Response::new(&inline_four(), Arc::new(measured.clone()), &[750.0], &whole(&[2]), &cancel);
    let response = response.unwrap();
    let moved = response.at_receiver("seat rail", Derivative::Displacement, &cancel).unwrap();
    let expected = response.carriers[0].y * 2.0;
    assert!((moved[0][1] - expected).norm() <= 1e-13 * expected.norm(), "{moved:?} {expected}");
    let error = receptance(stiffness.inv(), 1e-7).unwrap_err().to_string();
    assert!(error.contains("conjugate them"), "{error}");
    let outside =
        measured.state(&[[Complex64::ONE; 3]], TAU * 31.0, &state.motion, || "order 1".into());
    let error = outside.unwrap_err().to_string();
    assert!(
        error.starts_with("table of the support = 31.000000 Hz: order 1, is outside"),
        "{error}"
    );
}

#[test]
fn stages_balance_in_force_and_power_and_agree_with_their_receptance() {
    let (mut number, cancel) = (draws(24), Cancel::new());
    for _ in 0..20 {
        let engine = random_engine(&mut number);
        let (above, below) = (random(&mut number, true), random(&mut number, true));
        let rpm = [300.0 * (1.2 + number()), 3000.0 * (1.1 + number())];
        let orders = whole(&[1, 2, 4]);
        let subframe = Support::Subframe(Box::new(below.clone()));
        let carried = Arc::new(above.clone().on(subframe).unwrap());
        let response =
            Response::new(&engine, Arc::clone(&carried), &rpm, &orders, &cancel).unwrap();
        let forces = response.mount_forces(&cancel).unwrap();
        let ground = response.ground_forces(&cancel).unwrap();
        let sums = response.support_loads(&cancel).unwrap();
        let power = response.power(&cancel).unwrap();
        let count = above.mounts().len();
        for point in 0..6 {
            let omega = response.omega_of(point);
            let load = response.loads()[point];
            // The lower body: forces of the upper mounts, its own mounts, inertia.
            let moved = response.subframe_motions().unwrap()[point];
            let mut sum = below.body().mass_matrix().map(Complex64::from)
                * moved
                * Complex64::from(omega * omega);
            let mut size = sum.norm();
            let mut add = |at: Vector3<f64>, force: [Complex64; 3], sign: f64| {
                let arm = (at - below.body().cg()).map(Complex64::from);
                let force = Vector3::from(force) * Complex64::from(sign);
                let moment = arm.cross(&force);
                let whole =
                    ComplexVector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
                sum += whole;
                size += whole.norm();
            };
            let mut whole = Vector3::zeros();
            for (k, mount) in above.mounts().iter().enumerate() {
                add(mount.at(), forces[point * count + k], 1.0);
                whole += Vector3::from(forces[point * count + k]);
            }
            // A force of a mount is the small difference of large ones where its ends move alike.
            let mut at_ends = 0.0;
            for (mount, along) in
                above.mounts().iter().zip(above.stiffnesses(omega, String::new).unwrap())
            {
                let stiffest = along.iter().map(|along| along.norm()).fold(0.0, f64::max);
                let at = mount.at().into();
                let ends =
                    [above.motion_of(at, &response.motions()[point]), below.motion_of(at, &moved)];
                at_ends += stiffest * ends.map(|end| Vector3::from(end).norm()).iter().sum::<f64>();
            }
            for (k, mount) in below.mounts().iter().enumerate() {
                add(mount.at(), ground[point * below.mounts().len() + k], -1.0);
            }
            let size = size + at_ends;
            assert!((whole - sums[point].fixed_rows::<3>(0)).norm() <= 1e-12 * size);
            assert!(sum.norm() <= 1e-11 * size, "{sum} {size}");
            let row = &power[point];
            let reactive = omega * load.norm() * response.motions()[point].norm();
            let lost: f64 = row[1..].iter().sum();
            assert!((row[0] - lost).abs() <= 1e-11 * reactive);
            assert!(row[1..].iter().all(|&power| power >= 0.0));
            // The same by the receptance of the lower body at the upper mounts.
            let frequency = omega / TAU;
            let along = below.stiffnesses(omega, String::new).unwrap();
            let places: Vec<usize> = (0..3 * count).collect();
            let columns: Vec<Vec<Complex64>> = places
                .iter()
                .map(|place| {
                    let arm = above.mounts()[place / 3].at() - below.body().cg();
                    let row = crate::mounts::motion_of_point(&arm).row(place % 3).transpose();
                    let moved = below.motion(&along, omega, &row.map(Complex64::from)).unwrap();
                    let at = |place: &usize| {
                        let at = above.mounts()[place / 3].at().into();
                        below.motion_of(at, &moved)[place % 3]
                    };
                    places.iter().map(at).collect()
                })
                .collect();
            let names =
                places.iter().map(|place| (above.mounts()[place / 3].name().into(), place % 3));
            let receptance = crate::mounts::Receptance {
                coordinates: names.collect(),
                frequency: vec![0.5 * frequency, frequency, 2.0 * frequency],
                values: vec![columns.concat(); 3],
                receivers: Vec::new(),
            };
            let measured =
                above.clone().on(Support::Receptance(receptance.checked().unwrap())).unwrap();
            let stiffnesses = above.stiffnesses(omega, String::new).unwrap();
            let state = measured.state(&stiffnesses, omega, &load, String::new).unwrap().unwrap();
            let scale = above.body().mass_matrix().diagonal().map(f64::sqrt);
            let size = |v: &ComplexVector6| v.map(Complex64::norm).component_mul(&scale).norm();
            let motion = response.motions()[point];
            assert!(size(&(state.motion - motion)) <= 1e-9 * size(&motion));
        }
        // On a body that does not move, the answer of one stage.
        let heavy = below.body().scaled(1e20, 1e20);
        let heavy = Powertrain::new(heavy, below.mounts().to_vec()).unwrap();
        let on_heavy = Arc::new(above.clone().on(Support::Subframe(Box::new(heavy))).unwrap());
        let fixed = Response::new(&engine, Arc::new(above), &rpm, &orders, &cancel).unwrap();
        let other = Response::new(&engine, on_heavy, &rpm, &orders, &cancel).unwrap();
        for (one, two) in fixed.motions().iter().zip(other.motions()) {
            assert!((one - two).norm() <= 1e-10 * one.norm());
        }
    }
}
