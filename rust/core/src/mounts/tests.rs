//! Published and computed figures, and laws of random bodies on random mounts.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::*;
use crate::numbers::cancel::Cancel;
use crate::numbers::draws;

/// A mount without damping, upright.
pub fn mount(name: &str, at: [f64; 3], stiffness: [f64; 3]) -> MountFigures {
    MountFigures { name: name.into(), at, stiffness, ..MountFigures::default() }
}

pub fn powertrain(body: RigidBody, mounts: impl IntoIterator<Item = MountFigures>) -> Powertrain {
    let mounts = mounts.into_iter().map(|figures| Mount::new(figures).unwrap()).collect();
    Powertrain::new(body, mounts).unwrap()
}

fn diagonal(mass: f64, moments: [f64; 3]) -> RigidBody {
    let inertia = Matrix3::from_diagonal(&moments.into());
    let rows = [0, 1, 2].map(|row| [0, 1, 2].map(|column| inertia[(row, column)]));
    RigidBody::new(mass, [0.0; 3], rows, None).unwrap()
}

/// 150 kg on four equal mounts.
pub fn four_mounts(loss: f64) -> Powertrain {
    let places = [[0.22, 0.28], [-0.22, 0.28], [0.22, -0.28], [-0.22, -0.28]];
    let mounts = places.into_iter().enumerate().map(|(k, [x, z])| MountFigures {
        loss_factor: [loss; 3],
        ..mount(&k.to_string(), [x, -0.18, z], [1.5e5, 3e5, 1.2e5])
    });
    powertrain(diagonal(150.0, [7.0, 8.0, 4.5]), mounts)
}

fn assert_near(value: f64, expected: f64) {
    // Figures have eight digits.
    assert!((value - expected).abs() <= 6e-8 * expected.abs(), "{value} is not {expected}");
}

#[test]
fn four_equal_mounts_have_six_modes_in_closed_form() {
    let found = modes(&four_mounts(0.1), None).unwrap();
    let expected = [8.198_354_2, 8.424_767_4, 14.235_251, 14.916_478, 20.262_275, 21.603_265];
    found.frequency.iter().zip(expected).for_each(|(f, expected)| assert_near(*f, expected));
    // The lower lateral-roll mode.
    assert_near(found.energy[(0, 1)], 92.331_915);
    assert_near(found.energy[(5, 1)], 7.668_084_7);
    assert_near(found.purity[1], 92.331_915);
    for mode in 0..6 {
        assert!((found.loss_factor[mode] - 0.1).abs() < 1e-13);
        assert!((found.damped_frequency[mode] / found.frequency[mode] - 1.0).abs() < 1e-13);
        let sum: f64 = found.strain.iter().map(|row| row[mode]).sum();
        assert!((sum - 100.0).abs() < 1e-11);
    }
    assert!(found.free.is_empty() && found.group == [0, 1, 2, 3, 4, 5]);
}

#[test]
fn inclined_mounts_have_an_elastic_centre_above_them() {
    let [stiff, soft] = [4e5, 8e4];
    let inclined = |name, x: f64, degrees| MountFigures {
        tilt_deg: degrees,
        ..mount(name, [x, -0.222_748_08, 0.0], [stiff, soft, soft])
    };
    let pair = [inclined("right", 0.3, 130.0), inclined("left", -0.3, 50.0)];
    let on_two = powertrain(diagonal(1.0, [1.0; 3]), pair);
    let along = on_two.stiffnesses(0.0, String::new).unwrap();
    let matrix = on_two.assembled(&along);
    // The CG is put where the elastic centre is said to be, to eight digits.
    assert!(matrix[(0, 5)].norm() < 5e-9 * 424_432.58);
    assert_near(matrix[(0, 0)].re, 424_432.58);
    assert_near(matrix[(5, 5)].re, 27_142.12);
}

#[test]
fn the_torque_roll_axis_tilts_by_the_products() {
    let inertia = [[6.0, 0.4, -0.9], [0.4, 8.5, 0.3], [-0.9, 0.3, 3.2]];
    for (products, x) in
        [(Products::Tensor, 0.150_945_11), (Products::PositiveIntegrals, -0.146_455_93)]
    {
        let body = RigidBody::new(150.0, [0.0; 3], inertia, Some(products)).unwrap();
        let on_mounts = powertrain(
            body,
            [
                mount("a", [0.3, 0.0, 0.1], [1e5; 3]),
                mount("b", [-0.3, 0.0, 0.0], [1e5; 3]),
                mount("c", [0.0, 0.1, 0.5], [1e5; 3]),
            ],
        );
        let found = axes(&on_mounts, None).unwrap();
        assert_near(found.torque_roll[0], x);
        if products == Products::Tensor {
            assert_near(found.torque_roll_deg, 9.013_610_2);
        }
    }
}

#[test]
fn three_mounts_carry_by_statics_alone() {
    let body = RigidBody::new(
        160.0,
        [0.03, 0.1, 0.2],
        [[7.0, 0.0, 0.0], [0.0, 8.0, 0.0], [0.0, 0.0, 4.5]],
        None,
    );
    let body = body.unwrap();
    let places = [[0.3, 0.0, 0.0], [-0.3, 0.0, 0.0], [0.0, 0.0, 0.7]];
    for stiffness in [[2e5; 3], [1e5, 3e5, 2e5]] {
        let mounts = places.iter().enumerate().map(|(k, &at)| mount(&k.to_string(), at, stiffness));
        let found = at_rest(&powertrain(body, mounts), &LoadCase::default()).unwrap();
        for (force, expected) in found.force[0].iter().zip([638.8332, 481.9268, 448.304]) {
            // Printed with a step of half a unit of the fourth decimal.
            assert!((force[1] + expected).abs() < 5.1e-5, "{force:?}");
        }
        assert!(found.support_margin > 0.0 && found.force[1].iter().flatten().all(|f| *f == 0.0));
    }
}

#[test]
fn forces_that_symmetry_forbids_are_zero_and_small_ones_are_not() {
    let mut number = draws(41);
    for _ in 0..200 {
        let mut positive = |least: f64| least + 0.5 * (1.0 + number());
        let scale = 10.0_f64.powf(8.0 * positive(0.0) - 4.0);
        let moments = [positive(1.0), positive(1.0), positive(1.0)].map(|m| 5.0 * m * scale);
        let body = diagonal(100.0 * scale * positive(1.0), moments);
        // A mirror image on the other side of the plane of the crank and the weight.
        let pairs: Vec<_> = (0..2)
            .map(|k| {
                let z = if k == 0 { 0.3 } else { -0.4 } * positive(0.5);
                let at = [0.3 * positive(0.5), -0.4 * positive(0.0), z];
                let stiffness = [0; 3].map(|_| 1e5 * scale * positive(0.2));
                (at, stiffness, 90.0 * positive(0.0))
            })
            .collect();
        let mounted = |shift: f64| {
            let mounts = pairs.iter().enumerate().flat_map(|(k, &(at, stiffness, tilt))| {
                [1.0, -1.0].map(|side| {
                    let place = [side * at[0] + if k == 0 { shift } else { 0.0 }, at[1], at[2]];
                    let tilt_deg = 90.0 + side * (tilt - 90.0);
                    let name = format!("{k} {side}");
                    MountFigures { tilt_deg, ..mount(&name, place, stiffness) }
                })
            });
            powertrain(body, mounts)
        };
        let rest = |of: &Powertrain| {
            let (thrust, thrust_at) = ([0.0, 0.0, 50.0 * scale], [0.0, -0.1, 0.0]);
            let gravity = [0.0, -9.8, 0.0];
            let case = LoadCase {
                gravity,
                torque: -100.0 * scale,
                thrust,
                thrust_at,
                ..LoadCase::default()
            };
            at_rest(of, &case).unwrap()
        };
        let found = rest(&mounted(0.0));
        for cause in [0, 2] {
            let [x, _, _, _, yaw, roll] = found.displacement[cause];
            assert_eq!([x, yaw, roll], [0.0; 3]);
            // Forces along x are those of the tilt, against each other.
            for pair in found.force[cause].as_chunks::<2>().0 {
                let size = pair[0].iter().map(|f| f.abs()).fold(0.0, f64::max);
                assert!((pair[0][0] + pair[1][0]).abs() <= 1e-12 * size);
            }
        }
        let [_, y, z, pitch, _, _] = found.displacement[1];
        assert_eq!([y, z, pitch], [0.0; 3]);
        // A micrometre to the side.
        let moved = rest(&mounted(1e-6)).displacement[0];
        assert!([moved[0], moved[4], moved[5]].iter().all(|part| *part != 0.0), "{moved:?}");
    }
    let upright =
        at_rest(&four_mounts(0.0), &LoadCase { torque: -100.0, ..LoadCase::default() }).unwrap();
    for (weight, torque) in upright.force[0].iter().zip(&upright.force[1]) {
        assert!(weight[0] == 0.0 && weight[1] < 0.0 && weight[2] == 0.0 && torque[2] == 0.0);
    }
}

#[test]
fn equal_frequencies_are_a_group_whatever_one_mount_differs_by() {
    let body = diagonal(100.0, [9.0, 18.0, 9.0]);
    let places = [[0.3, 0.3], [-0.3, 0.3], [0.3, -0.3], [-0.3, -0.3]];
    for factor in [1.0, 1.0 + 1e-12] {
        let mounts = places.iter().enumerate().map(|(k, &[x, z])| {
            let stiffness = if k == 0 { 1e5 * factor } else { 1e5 };
            mount(&k.to_string(), [x, 0.0, z], [stiffness; 3])
        });
        let found = modes(&powertrain(body, mounts), None).unwrap();
        assert_eq!(found.group, [0; 6]);
        let equal = found.energy - Matrix6::from_element(100.0 / 6.0);
        assert!(equal.amax() < 1e-9 && found.purity.iter().all(|p| (p - 100.0).abs() < 1e-9));
    }
}

#[test]
fn what_no_mount_resists_is_named() {
    let body = diagonal(100.0, [9.0, 18.0, 9.0]);
    let two =
        [mount("a", [0.3, 0.1, 0.0], [1e5; 3]), mount("b", [-0.3, 0.1, 0.0], [1e5, 2e5, 1e5])];
    let found = modes(&powertrain(body, two.clone()), None).unwrap();
    assert_eq!(found.frequency[0], 0.0);
    assert!(found.frequency[1] > 1.0 && found.free.len() == 1);
    let words = found.free[0].in_words();
    assert!(words.starts_with("rotation about the line through (0, 0.1, 0) m along ("), "{words}");
    let error = at_rest(&powertrain(body, two), &LoadCase::default()).unwrap_err().to_string();
    assert!(error.contains("mounts = a, b: rotation about the line"), "{error}");
    let upright = (0..3).map(|k| {
        let k = f64::from(k);
        mount(&k.to_string(), [0.3 * k, 0.1, 0.1 * k * k], [0.0, 1e5, 1e5])
    });
    let found = modes(&powertrain(body, upright), None).unwrap();
    assert_eq!(found.free[0].in_words().replace('-', ""), "translation along (1, 0, 0)");
}

#[test]
fn low_frequencies_keep_their_digits() {
    // Three mounts ever nearer to a line: roll about it goes with their distance from it.
    let body = diagonal(100.0, [9.0, 18.0, 9.0]);
    for power in 1..9 {
        let distance = 10.0_f64.powi(-power);
        let places = [[0.3, 0.0], [-0.3, 0.0], [0.0, distance]];
        let mounts = places
            .iter()
            .enumerate()
            .map(|(k, &[x, z])| mount(&k.to_string(), [x, 0.0, z], [1e5; 3]));
        let found = modes(&powertrain(body, mounts), None).unwrap();
        // Rayleigh's quotient of rotation about x through the line, exact as the distance goes to zero.
        let omega = (1e5 * distance * distance * (2.0 / 3.0) / 9.0).sqrt();
        let error = found.frequency[0] * std::f64::consts::TAU / omega - 1.0;
        // What the other modes add goes with the square of the distance; 64 roundings of its inverse.
        assert!(error.abs() < distance * distance + 64.0 * f64::EPSILON / distance, "{error}");
    }
}

/// A random body, and three to six random mounts of it.
pub fn random(number: &mut impl FnMut() -> f64, damping: bool) -> Powertrain {
    let scale = 10.0_f64.powf(3.0 * number());
    let root = Matrix3::from_fn(|_, _| number()) + Matrix3::identity() * 2.0;
    let moments = root * root.transpose();
    // The tensor of masses along three directions: no moment is larger than the sum of the others.
    let inertia = (Matrix3::identity() * moments.trace() - moments) * scale;
    let rows = [0, 1, 2].map(|row| [0, 1, 2].map(|column| inertia[(row, column)]));
    let cg = [number(), number(), number()];
    let body = RigidBody::new(20.0 * scale, cg, rows, Some(Products::Tensor)).unwrap();
    let count = 3 + (2.0 * (number() + 1.0)) as usize;
    let mut figures = Vec::new();
    for k in 0..count {
        let turn = nalgebra::Rotation3::new(Vector3::from_fn(|_, _| 2.0 * number()));
        let axes = turn.matrix();
        let mut positive = |scale: f64| [0; 3].map(|_| scale * (1.0 + 0.9 * number()));
        figures.push(MountFigures {
            axes: Some([0, 1, 2].map(|row| [0, 1, 2].map(|column| axes[(row, column)]))),
            loss_factor: if damping { positive(0.2) } else { [0.0; 3] },
            damping: if damping { positive(scale * 50.0) } else { [0.0; 3] },
            stiffness: positive(scale * 1e4),
            ..mount(&k.to_string(), [0; 3].map(|_| number()), [0.0; 3])
        });
    }
    powertrain(body, figures)
}

#[test]
fn stiffness_is_the_curvature_of_the_elastic_energy() {
    let mut number = draws(5);
    for _ in 0..20 {
        let on_mounts = random(&mut number, false);
        let along = on_mounts.stiffnesses(0.0, String::new).unwrap();
        let matrix = on_mounts.assembled(&along);
        let energy = |q: &Vector6<f64>| {
            // Exact rotation, about the CG.
            let turn = nalgebra::Rotation3::new(Vector3::new(q[3], q[4], q[5]));
            let shift = Vector3::new(q[0], q[1], q[2]);
            let cg = on_mounts.body().cg();
            let of_mount = |mount: &Mount| {
                let arm = mount.at() - cg;
                let along = mount.axes() * (shift + turn * arm - arm);
                let stiffness = Vector3::from(mount.static_stiffness());
                0.5 * along.component_mul(&along).dot(&stiffness)
            };
            on_mounts.mounts().iter().map(of_mount).sum::<f64>()
        };
        let step = 1e-4;
        let unit = |k: usize| Vector6::from_fn(|j, _| if j == k { step } else { 0.0 });
        let largest = matrix.map(num_complex::Complex::norm).max();
        for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
            let [a, b] = [unit(i), unit(j)];
            let mixed = energy(&(a + b)) - energy(&(a - b)) - energy(&(b - a)) + energy(&-(a + b));
            // Fourth derivatives times the square of the step.
            let error = mixed / (4.0 * step * step) - matrix[(i, j)].re;
            assert!(error.abs() < 1e-6 * largest, "{i} {j} {error}");
        }
    }
}

#[test]
fn modes_are_orthonormal_and_their_energies_sum_to_a_hundred() {
    let mut number = draws(6);
    for _ in 0..50 {
        let on_mounts = random(&mut number, false);
        let found = modes(&on_mounts, None).unwrap();
        let mass = on_mounts.body().mass_matrix();
        let along = on_mounts.stiffnesses(0.0, String::new).unwrap();
        let matrix = on_mounts.assembled(&along).map(|entry| entry.re);
        let unit = found.shapes.transpose() * mass * &found.shapes;
        assert!((unit - Matrix6::identity()).amax() < 1e-12);
        let squares = Vector6::from_fn(|k, _| (std::f64::consts::TAU * found.frequency[k]).powi(2));
        let error =
            found.shapes.transpose() * matrix * &found.shapes - Matrix6::from_diagonal(&squares);
        assert!(error.amax() < 1e-12 * squares.max());
        for mode in 0..6 {
            assert!((found.energy.column(mode).sum() - 100.0).abs() < 1e-10);
        }
        assert_eq!((found.loss_factor, found.damped_frequency[0] > 0.0), (vec![0.0; 6], true));
    }
}

#[test]
fn bodies_on_a_subframe_have_twelve_modes_and_the_preloads_of_firm_ground() {
    let mut number = draws(61);
    for _ in 0..40 {
        let (above, below) = (random(&mut number, false), random(&mut number, false));
        let on = above.clone().on(Support::Subframe(Box::new(below.clone()))).unwrap();
        let found = modes(&on, None).unwrap();
        let (mass, stiffness) = matrices(&on, None).unwrap();
        let unit = found.shapes.transpose() * &mass * &found.shapes;
        let elastic = found.shapes.transpose() * stiffness.map(|k| k.re) * &found.shapes;
        let largest = (std::f64::consts::TAU * found.frequency[11]).powi(2);
        for (row, column) in (0..12).flat_map(|row| (0..12).map(move |column| (row, column))) {
            let one = f64::from(u8::from(row == column));
            let square = one * (std::f64::consts::TAU * found.frequency[row]).powi(2);
            assert!((unit[(row, column)] - one).abs() < 1e-12);
            assert!((elastic[(row, column)] - square).abs() < 1e-12 * largest);
        }
        for mode in 0..12 {
            assert!((found.energy.column(mode).sum() - 100.0).abs() < 1e-10);
            let strained: f64 = found.strain.iter().map(|row| row[mode]).sum();
            assert!((strained - 100.0).abs() < 1e-9);
        }
        assert_eq!(found.strain.len(), on.all_names().len());
        // What is above follows the subframe as a rigid body: its mounts feel the same forces at rest.
        let rest = |of: &Powertrain| {
            let (thrust, thrust_at) = ([5.0, 0.0, 50.0], [0.0, -0.1, 0.0]);
            let case = LoadCase {
                gravity: [1.0, -9.8, 2.0],
                torque: -30.0,
                thrust,
                thrust_at,
                ..LoadCase::default()
            };
            at_rest(of, &case).unwrap()
        };
        let (firm, soft) = (rest(&above), rest(&on));
        for (firm, soft) in firm.force.iter().zip(&soft.force) {
            let largest = firm.iter().flatten().fold(0.0, |m: f64, f| m.max(f.abs()));
            for (a, b) in firm.iter().flatten().zip(soft.iter().flatten()) {
                // Roundings of flexibilities that differ by as much as the stiffness.
                assert!((a - b).abs() <= 1e-7 * largest, "{a} {b}");
            }
        }
        // What the subframe's mounts bear is both weights, of stiffnesses up to 1e6 apart.
        for (axis, gravity) in [1.0, -9.8, 2.0].into_iter().enumerate() {
            let all = soft.force[0].iter().skip(above.mounts().len()).map(|force| force[axis]);
            let weight = gravity * (above.body().mass() + below.body().mass());
            assert!((all.sum::<f64>() / weight - 1.0).abs() < 1e-6);
        }
        let (plain, whole) = (axes(&above, None).unwrap(), axes(&on, None).unwrap());
        assert_eq!(plain.torque_roll, whole.torque_roll);
        assert!(whole.elastic.compliance >= plain.elastic.compliance);
    }
}

#[test]
fn free_motions_of_two_bodies_are_named() {
    let body = diagonal(100.0, [9.0, 18.0, 9.0]);
    let corners = [[0.3, 0.3], [-0.3, 0.3], [0.3, -0.3]];
    let three = |stiffness| {
        let at = |(k, &[x, z]): (usize, &[f64; 2])| mount(&k.to_string(), [x, 0.0, z], stiffness);
        powertrain(body, corners.iter().enumerate().map(at))
    };
    let free = |above, below| {
        let on = three(above).on(Support::Subframe(Box::new(three(below)))).unwrap();
        let found = modes(&on, None).unwrap();
        found.free.iter().map(FreeMotion::in_words).collect::<Vec<_>>()
    };
    assert!(free([1e5; 3], [1e5; 3]).is_empty());
    let sideways = free([1e5; 3], [0.0, 1e5, 1e5]);
    assert_eq!(sideways, ["translation along (1, 0, 0)"]);
    let upper = free([0.0, 1e5, 1e5], [1e5; 3]);
    assert_eq!(upper, ["translation along (1, 0, 0)"]);
    let both = free([0.0, 1e5, 1e5], [0.0, 1e5, 1e5]);
    assert_eq!(both.len(), 2);
    let error = axes(&three([0.0; 3]), None).unwrap_err().to_string();
    assert!(error.contains("; ") && error.contains("are free: add a mount"), "{error}");
}

#[test]
fn loss_factors_of_light_damping_are_those_of_the_strain_energy() {
    let mut number = draws(7);
    for _ in 0..20 {
        let heavy = random(&mut number, true);
        let light = heavy.mounts().iter().map(|mount| MountFigures {
            loss_factor: mount.figures().loss_factor.map(|loss| 1e-6 * loss),
            damping: mount.figures().damping.map(|damping| 1e-6 * damping),
            ..mount.figures().clone()
        });
        let light = powertrain(*heavy.body(), light);
        let found = modes(&light, None).unwrap();
        for mode in 0..6 {
            let omega = std::f64::consts::TAU * found.frequency[mode];
            let along = light.stiffnesses(omega, String::new).unwrap();
            let shape = found.shapes.column(mode).map(Complex64::from);
            let energy = (shape.transpose() * light.assembled(&along) * shape)[(0, 0)];
            // Second order in the damping.
            assert!((found.loss_factor[mode] / (energy.im / energy.re) - 1.0).abs() < 1e-4);
        }
    }
}

#[test]
fn the_elastic_axis_is_the_screw_of_the_motion_under_a_torque() {
    let mut number = draws(8);
    for _ in 0..50 {
        let on_mounts = random(&mut number, false);
        let found = axes(&on_mounts, None).unwrap().elastic;
        let along = on_mounts.stiffnesses(0.0, String::new).unwrap();
        let matrix = on_mounts.assembled(&along).map(|entry| entry.re);
        let motion = matrix.try_inverse().unwrap().column(5).into_owned();
        let moved = motion.map(Complex64::from);
        let turn = Vector3::new(motion[3], motion[4], motion[5]);
        // Points of the axis move along it, by the pitch.
        for at in [0.0, 1.0] {
            let point = Vector3::from(found.foot) + Vector3::from(found.direction) * at;
            let shift = Vector3::from(on_mounts.motion_of(point.into(), &moved).map(|u| u.re));
            let expected = turn * found.pitch;
            assert!((shift - expected).norm() < 1e-11 * (turn.norm() + shift.norm()));
        }
        assert!((found.compliance / turn.z - 1.0).abs() < 1e-9 && found.direction[2] > 0.0);
    }
}

#[test]
fn frequency_is_asked_for_where_stiffness_depends_on_it() {
    let track = Some(InertiaTrack { stiffness: 1e5, frequency: 10.0, damping_ratio: 0.2 });
    let mut figures = vec![MountFigures { track, ..mount("front", [0.3, 0.0, 0.0], [1e5; 3]) }];
    figures.push(mount("left", [-0.3, 0.1, 0.1], [1e5; 3]));
    figures.push(mount("rear", [0.0, 0.0, 0.5], [1e5; 3]));
    let on_mounts = powertrain(diagonal(100.0, [9.0, 12.0, 5.0]), figures);
    let error = modes(&on_mounts, None).unwrap_err().to_string();
    assert!(error.starts_with("frequency = None: the stiffness of mount \"front\""), "{error}");
    assert!(
        modes(&on_mounts, Some(1e5)).unwrap().frequency
            > modes(&on_mounts, Some(0.0)).unwrap().frequency
    );
}

#[test]
fn mounts_are_counted_and_named_apart() {
    let body = diagonal(100.0, [9.0, 18.0, 9.0]);
    let error = |mounts| Powertrain::new(body, mounts).unwrap_err().to_string();
    assert!(error(vec![]).starts_with("mounts = 0 mounts: give 1 to 1000"));
    let one = Mount::new(mount("a", [0.0; 3], [1e5; 3])).unwrap();
    assert!(error(vec![one.clone(), one]).starts_with("mounts[1].name = a: is the name"));
}

#[test]
fn tolerances_of_stiffness_have_exact_bounds_and_purity_is_searched_within_them() {
    let cancel = Cancel::new();
    let mut number = draws(41);
    for _ in 0..3 {
        let on_mounts = random(&mut number, false);
        let count = on_mounts.mounts().len().min(3);
        let on_mounts =
            Powertrain::new(*on_mounts.body(), on_mounts.mounts()[..count].to_vec()).unwrap();
        let tolerances = |share: f64| MountTolerances {
            stiffness: vec![share; count],
            mass: 0.02,
            inertia: 0.1,
            cg: 1e-3,
            by_axis: true,
        };
        let found = robustness(&on_mounts, &tolerances(0.2), None, &cancel).unwrap();
        let plain = modes(&on_mounts, None).unwrap();
        assert_eq!((&found.frequency, &found.purity), (&plain.frequency, &plain.purity));
        for mode in 0..6 {
            let frequency = plain.frequency[mode];
            // All scale alike: the square root, to a few roundings.
            let near = |value: f64, factor: f64| {
                assert!((value / (frequency * f64::sqrt(factor)) - 1.0).abs() < 1e-12);
            };
            near(found.by_stiffness[0][mode], 0.8);
            near(found.by_stiffness[1][mode], 1.2);
            assert!(found.least_purity[mode] <= found.purity[mode] + 1e-9);
            for ends in [&found.by_stiffness, &found.by_mass, &found.by_cg] {
                assert!(ends[0][mode] <= frequency && frequency <= ends[1][mode]);
            }
            // First differences of the place of the centre of gravity.
            for axis in 0..3 {
                let at = |step: f64| {
                    let shift = Vector3::ith(axis, step);
                    let body = on_mounts.body().at(on_mounts.body().cg() + shift);
                    let other = Powertrain::new(body, on_mounts.mounts().to_vec()).unwrap();
                    modes(&other, None).unwrap().frequency[mode]
                };
                let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
                let size = frequency / 0.1;
                assert!((found.cg_slope[axis][mode] - slope).abs() < 1e-5 * size);
            }
        }
        // Within the box: random stiffness keeps the bounds; where purity was found least it has that.
        let mut least_of_draws = [f64::INFINITY; 6];
        for _ in 0..1000 {
            let scaled = |factor: &mut dyn FnMut() -> f64| {
                let mounts = on_mounts.mounts().iter().map(|mount| {
                    let mut figures = mount.figures().clone();
                    figures.stiffness = figures.stiffness.map(|k| k * factor());
                    Mount::new(figures).unwrap()
                });
                Powertrain::new(*on_mounts.body(), mounts.collect()).unwrap()
            };
            let inside = modes(&scaled(&mut || 1.0 + 0.2 * number()), None).unwrap();
            for (mode, least) in least_of_draws.iter_mut().enumerate() {
                let [low, high] = [0, 1].map(|end| found.by_stiffness[end][mode]);
                let frequency = inside.frequency[mode];
                assert!(low * (1.0 - 1e-12) <= frequency && frequency <= high * (1.0 + 1e-12));
                *least = least.min(inside.purity[mode]);
            }
        }
        for (mode, least) in least_of_draws.into_iter().enumerate() {
            // A search, not a bound: where modes mix in a narrow band, draws may meet it a little lower.
            assert!(found.least_purity[mode] <= least + 0.5);
            let mounts =
                on_mounts.mounts().iter().zip(&found.least_pure[mode]).map(|(mount, factors)| {
                    let mut figures = mount.figures().clone();
                    for (stiffness, &factor) in figures.stiffness.iter_mut().zip(factors) {
                        assert!((0.8 - 1e-15..=1.2 + 1e-15).contains(&factor));
                        *stiffness *= factor;
                    }
                    Mount::new(figures).unwrap()
                });
            let at_least = Powertrain::new(*on_mounts.body(), mounts.collect()).unwrap();
            let purity = modes(&at_least, None).unwrap().purity[mode];
            assert!((purity - found.least_purity[mode]).abs() < 1e-9);
        }
    }
    let on_mounts = four_mounts(0.1);
    let tolerances = |share: f64, by_axis| MountTolerances {
        stiffness: vec![share; 4],
        mass: 0.0,
        inertia: 0.0,
        cg: 0.0,
        by_axis,
    };
    let error = robustness(&on_mounts, &tolerances(1.0, true), None, &cancel).unwrap_err();
    assert!(error.to_string().starts_with("stiffness = 1.0: give a tolerance"), "{error}");
    let by_axis = robustness(&on_mounts, &tolerances(0.1, true), None, &cancel).unwrap();
    let together = robustness(&on_mounts, &tolerances(0.1, false), None, &cancel).unwrap();
    for mode in 0..6 {
        assert!(by_axis.least_purity[mode] <= together.least_purity[mode] + 1e-9);
    }
    assert!(by_axis.least_purity[1] < 92.0);
}
