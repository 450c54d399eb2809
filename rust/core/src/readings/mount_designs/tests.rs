//! Designs against responses one by one, with stiffness that depends on frequency and that does not.

use std::sync::Arc;

use super::*;
use crate::engine::Station;
use crate::mechanism::cylinder::Cylinder;
use crate::mounts::equations::{lanes, rows};
use crate::mounts::tests::random;
use crate::mounts::{InertiaTrack, MountFigures};
use crate::numbers::angle::Angle;
use crate::numbers::draws;
use crate::readings::mounted::{Derivative, Response};

fn twin() -> Engine {
    let cylinder = Cylinder::new(0.043, 0.145, 0.45, 0.0).unwrap();
    let stations = [(0.0, -0.1), (130.0, 0.15)].map(|(tdc, z)| {
        let [tdc, bank] = [tdc, 80.0].map(|degrees| Angle::from_degrees(degrees).unwrap());
        Station { cylinder, tdc, bank, z, rotating_mass: 0.2 }
    });
    Engine::new("", "", stations.to_vec()).unwrap()
}

/// A random powertrain with some change of its mounts.
fn changed(
    number: &mut impl FnMut() -> f64,
    damping: bool,
    change: impl Fn(usize, &mut MountFigures),
) -> Powertrain {
    let base = random(number, damping);
    let mounts = base.mounts().iter().enumerate().map(|(k, mount)| {
        let mut figures = mount.figures().clone();
        change(k, &mut figures);
        Mount::new(figures).unwrap()
    });
    Powertrain::new(*base.body(), mounts.collect()).unwrap()
}

fn check(engine: &Engine, base: &Powertrain, number: &mut impl FnMut() -> f64) {
    let cancel = Cancel::new();
    let mut positive = |scale: f64| {
        let row = |_| [0; 3].map(|_| scale * (1.1 + number()));
        (0..5).map(row).collect::<Vec<_>>()
    };
    let size = base.mounts()[1].figures().stiffness[0];
    let variations = [
        Variation { mount: 1, figure: MountFigure::DynamicStiffness, values: positive(size) },
        Variation { mount: 2, figure: MountFigure::At, values: positive(0.4) },
        Variation { mount: 2, figure: MountFigure::Tilt, values: positive(90.0) },
    ];
    let rpm: Vec<f64> = (0..13).map(|k| 700.0 + 150.0 * f64::from(k)).collect();
    let orders = Orders::whole(&[1, 2, 3, 4]).unwrap();
    let points = [[0.1, 0.3, -0.2]];
    let frequency = Some(20.0);
    let request = DesignRequest {
        rpm: &rpm,
        orders: &orders,
        mount_forces: true,
        points: &points,
        frequency,
    };
    let found = design_responses(engine, base, &variations, &request, &cancel).unwrap();
    let mounts = base.mounts().len();
    assert_eq!(found.quantities, 2 + mounts);
    for design in 0..5 {
        let one = Arc::new(varied(base, &variations, design).unwrap());
        let modes = crate::mounts::modes(&one, frequency).unwrap();
        assert_eq!(found.frequency[design].to_vec(), modes.frequency);
        let response = Response::new(engine, Arc::clone(&one), &rpm, &orders, &cancel).unwrap();
        // By a factorisation of each point with pivots.
        for (point, motion) in response.motions().iter().enumerate() {
            let omega = rpm[point / 4] / 60.0 * TAU * (point % 4 + 1) as f64;
            let along = one.stiffnesses(omega, String::new).unwrap();
            let direct = one.motion(&along, omega, &response.loads()[point]).unwrap();
            let scale = one.body().mass_matrix().diagonal().map(f64::sqrt);
            let size = |v: &ComplexVector6| v.map(Complex64::norm).component_mul(&scale).norm();
            assert!(size(&(direct - motion)) <= 1e-11 * size(&direct), "{point}");
        }
        let sums = response.support_loads(&cancel).unwrap();
        let forces = response.mount_forces(&cancel).unwrap();
        let velocities = response.at(points[0], Derivative::Velocity, false, &cancel).unwrap();
        let value = |quantity: usize, point: usize, axis: usize| match quantity {
            0 => sums[point][axis].norm(),
            k if k <= mounts => forces[point * mounts + k - 1][axis].norm(),
            _ => velocities[point][axis].norm(),
        };
        for quantity in 0..found.quantities {
            let of_design = design * found.quantities + quantity;
            let size = (0..3).map(|axis| found.rms[of_design][axis]).fold(0.0, f64::max);
            for axis in 0..3 {
                let mut largest = [0.0_f64; 4];
                let mut rms = 0.0_f64;
                for row in 0..rpm.len() {
                    let peaks = [0, 1, 2, 3].map(|order| value(quantity, row * 4 + order, axis));
                    rms = rms.max((peaks.iter().map(|p| p * p).sum::<f64>() / 2.0).sqrt());
                    (0..4).for_each(|order| largest[order] = largest[order].max(peaks[order]));
                }
                assert!((found.rms[of_design][axis] - rms).abs() <= 1e-10 * size);
                for (order, peak) in largest.iter().enumerate() {
                    let value = found.largest[of_design * 4 + order][axis];
                    assert!((value - peak).abs() <= 1e-10 * size, "{quantity} {order} {axis}");
                }
            }
        }
    }
}

#[test]
fn designs_are_responses_one_by_one() {
    let mut number = draws(31);
    let fired = crate::load::tests::fired([Some(0), None, Some(0)]).0;
    for engine in [&twin(), &fired, &twin(), &fired] {
        // Hysteretic, viscous too, and with a fluid.
        let base = changed(&mut number, true, |_, figures| figures.damping = [0.0; 3]);
        check(engine, &base, &mut number);
        let base = changed(&mut number, true, |_, _| {});
        check(engine, &base, &mut number);
        let base = changed(&mut number, true, |k, figures| {
            let stiffness = figures.stiffness[0];
            let track = InertiaTrack { stiffness, frequency: 12.0, damping_ratio: 0.3 };
            figures.track = (k == 1 || k == 2).then_some(track);
        });
        check(engine, &base, &mut number);
    }
}

/// Two masses' worth of an exceptional point: modes along x and y of equal frequency, whose loss factors
/// differ by twice what couples them.
#[test]
fn modes_that_merge_lose_no_digits() {
    let body = crate::mounts::RigidBody::new(
        1.0,
        [0.0; 3],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        None,
    );
    let body = body.unwrap();
    // K = 1e4·[[1 + i(η + e), κ], [κ, 1 + i(η − e)]], κ = e: a plain spring along a diagonal, and a lossy one
    // along an axis.
    let along = |name: &str, degrees: f64, stiffness: f64, loss: f64| MountFigures {
        name: name.into(),
        tilt_deg: degrees,
        stiffness: [stiffness, 0.0, 0.0],
        loss_factor: [loss, 0.0, 0.0],
        ..MountFigures::default()
    };
    let e = 0.1;
    let round = |name: &str, at: [f64; 3]| MountFigures {
        name: name.into(),
        at,
        stiffness: [0.0, 0.0, 5e3],
        loss_factor: [0.1; 3],
        ..MountFigures::default()
    };
    let figures = [
        along("x", 0.0, 1e4 * (1.0 - e), 0.3 / (1.0 - e)),
        along("y", 90.0, 1e4 * (1.0 - e), (0.3 - 2.0 * e) / (1.0 - e)),
        along("between", 45.0, 2e4 * e, 0.0),
        round("a", [0.7, 0.0, 0.0]),
        round("b", [-0.7, 0.0, 0.0]),
        MountFigures { stiffness: [0.0, 0.0, 5e3], at: [0.0, 0.7, 0.0], ..round("c", [0.0; 3]) },
    ];
    let mounts = figures.into_iter().map(|figures| Mount::new(figures).unwrap()).collect();
    let merged = Arc::new(Powertrain::new(body, mounts).unwrap());
    let stiffnesses = merged.stiffnesses(1.0, String::new).unwrap();
    let matrix = merged.assembled(&stiffnesses);
    let [a, b, c] = [matrix[(0, 0)], matrix[(0, 1)], matrix[(1, 1)]];
    let gap = (a - c) * (a - c) + b * b * 4.0;
    assert!(gap.norm() < 1e-12 * a.norm_sqr(), "{gap}");
    // ω = 90 rad/s is .9 of the modes' frequency.
    let natural = natural_at(&merged, None).unwrap();
    let equations = Equations::new(&merged, 90.0, natural.as_ref()).unwrap();
    assert!(equations.is_triangular());
    let load = nalgebra::Vector6::new(1.0, 0.3, 0.0, 0.0, 0.0, 0.0).map(Complex64::from);
    let turns = [rows(&equations.to), rows(&equations.from)];
    let (is_solved, moved) = equations.motions(&turns, &[90.0; LANES], &[], &lanes(&[load]));
    assert_eq!(is_solved, [true; LANES]);
    let moved = ComplexVector6::from_fn(|k, _| Complex64::new(moved[0][k][0], moved[1][k][0]));
    // Cramer's rule of the two.
    let [p, q] = [a - 8100.0, c - 8100.0];
    let determinant = p * q - b * b;
    let expected =
        [(q * load[0] - b * load[1]) / determinant, (p * load[1] - b * load[0]) / determinant];
    for (value, expected) in moved.iter().zip(expected) {
        assert!((value - expected).norm() <= 1e-13 * expected.norm(), "{value} {expected}");
    }
}

/// Speeds at which a pivot is small, though no mode is near, are left to a factorisation with pivots.
#[test]
fn speeds_that_vectors_leave_are_solved_with_pivots() {
    let mut number = draws(35);
    let fired = crate::load::tests::fired([Some(0), None, Some(0)]).0;
    let (cancel, orders) = (Cancel::new(), Orders::whole(&[1, 2]).unwrap());
    let mut found = 0;
    for _ in 0..2 {
        // With a fluid, whose stiffness depends on frequency, and hardly damped.
        let base = changed(&mut number, false, |_, figures| {
            let stiffness = 0.1 * figures.stiffness[0];
            figures.track = Some(InertiaTrack { stiffness, frequency: 2.0, damping_ratio: 1e-6 });
        });
        let values = vec![base.mounts()[1].figures().stiffness];
        let variations = [Variation { mount: 1, figure: MountFigure::DynamicStiffness, values }];
        let one = Arc::new(varied(&base, &variations, 0).unwrap());
        let equations = Equations::new(&one, 1.0, None).unwrap();
        let turns = [rows(&equations.to), rows(&equations.from)];
        let load = lanes(&[ComplexVector6::from_element(Complex64::new(1.0, 0.0))]);
        let is_left = |omega: f64| {
            let along = one.mounts().iter().map(|mount| mount.stiffness_at(omega, String::new));
            let along: Vec<_> = along
                .flat_map(|along| along.unwrap().map(|k| [[k.re; LANES], [k.im; LANES]]))
                .collect();
            let (is_solved, _) = equations.motions(&turns, &[omega; LANES], &along, &load);
            is_solved == [false; LANES]
        };
        // The middle of speeds that are left, where the pivot is smallest.
        let middle = |omega: f64| {
            let edges = [0.99, 1.01].map(|factor| {
                let (mut left, mut solved) = (omega, factor * omega);
                for _ in 0..40 {
                    let half = 0.5 * (left + solved);
                    *(if is_left(half) { &mut left } else { &mut solved }) = half;
                }
                left
            });
            0.5 * (edges[0] + edges[1])
        };
        let speeds = (0..4000).map(|k| 10.0 * 1.001_f64.powi(k)).filter(|&omega| is_left(omega));
        for omega in speeds.take(3).map(middle) {
            found += 1;
            // In order 2; beside a speed at which inertia is small.
            let speed = omega / 2.0 * 60.0 / TAU;
            for (engine, rpm) in [(&twin(), &[60.0, speed][..]), (&fired, &[speed])] {
                let request = DesignRequest {
                    rpm,
                    orders: &orders,
                    mount_forces: false,
                    points: &[],
                    frequency: None,
                };
                let designs = design_responses(engine, &base, &variations, &request, &cancel);
                let designs = designs.unwrap();
                let response = Response::new(engine, Arc::clone(&one), rpm, &orders, &cancel);
                let loads = response.unwrap().support_loads(&cancel).unwrap();
                for axis in 0..3 {
                    let force = |point: usize| loads[point][axis].norm();
                    let expected = (0..rpm.len()).map(|k| force(2 * k + 1)).fold(0.0, f64::max);
                    let apart = designs.largest[1][axis] - expected;
                    let most = loads.iter().map(|load| load.map(Complex64::norm).max());
                    let most = most.fold(0.0, f64::max);
                    // Rounding, of modes that are not near.
                    assert!(apart.abs() <= 1e-11 * most, "{omega}: {apart} of {most}");
                }
            }
        }
    }
    assert!(found > 3, "{found}");
}

#[test]
fn what_cannot_be_is_named() {
    let mut number = draws(33);
    let base = random(&mut number, true);
    let (engine, cancel, rpm) = (twin(), Cancel::new(), [1000.0]);
    let orders = Orders::whole(&[1]).unwrap();
    let request = DesignRequest {
        rpm: &rpm,
        orders: &orders,
        mount_forces: false,
        points: &[],
        frequency: None,
    };
    let error = |variations: &[Variation]| {
        design_responses(&engine, &base, variations, &request, &cancel).unwrap_err().to_string()
    };
    assert!(error(&[]).starts_with("vary = no design"));
    let variation = |values| Variation { mount: 0, figure: MountFigure::LossFactor, values };
    let said = "design 1: mount \"0\": loss_factor[2] = -0.1: give zero or more";
    let found = error(&[variation(vec![[0.1; 3], [0.1, 0.1, -0.1]])]);
    assert!(found.starts_with(said), "{found}");
    let two = [variation(vec![[0.1; 3]; 2]), variation(vec![[0.1; 3]; 3])];
    assert!(error(&two).contains("3 entries"), "{}", error(&two));
    let body = *base.body();
    let below = Powertrain::new(body, base.mounts().to_vec()).unwrap();
    let carried = base.clone().on(crate::mounts::Support::Subframe(Box::new(below))).unwrap();
    let found = design_responses(&engine, &carried, &two[..1], &request, &cancel);
    assert!(found.unwrap_err().to_string().starts_with("support = a subframe"));
}
