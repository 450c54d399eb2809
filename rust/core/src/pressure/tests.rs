use super::chamber::{Compressor, Face, Swept};
use super::*;
use crate::Complex64;
use crate::mechanism::cylinder::Cylinder;
use crate::mechanism::motion::CrankPosition;
use crate::mechanism::{Mechanism, with_ratios};
use crate::numbers::cancel::Cancel;
use crate::numbers::chebyshev::node;
use crate::numbers::order::Order;
use approx::assert_relative_eq;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

fn table(
    angles: impl Iterator<Item = f64>,
    of: impl Fn(f64) -> f64,
    strokes: u32,
) -> Result<Cycle> {
    let theta_deg: Vec<f64> = angles.collect();
    let pressure = theta_deg.iter().map(|&theta| of(theta)).collect();
    Cycle::new(Given { name: String::new(), strokes, theta_deg, pressure, degree: None })
}

fn even(count: usize, period: f64) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| period * k as f64 / count as f64)
}

/// Smooth, four-stroke, with all orders: 1e5/(1.1 − cos θ/2).
fn smooth(theta_deg: f64) -> f64 {
    1e5 / (1.1 - (0.5 * theta_deg).to_radians().cos())
}

/// Chebyshev panels of a function over a period.
fn panels(of: impl Fn(f64) -> f64, edges: &[f64], degree: usize) -> Cycle {
    let (mut theta_deg, mut pressure) = (Vec::new(), Vec::new());
    for pair in edges.windows(2) {
        for k in 0..=degree {
            let theta = match k {
                0 => pair[0],
                k if k == degree => pair[1],
                k => 0.5 * (pair[0] + pair[1]) - 0.5 * (pair[1] - pair[0]) * node(k, degree),
            };
            theta_deg.push(theta);
            pressure.push(of(theta));
        }
    }
    let strokes = if edges[edges.len() - 1] - edges[0] > 400.0 { 4 } else { 2 };
    Cycle::new(Given { name: String::new(), strokes, theta_deg, pressure, degree: Some(degree) })
        .unwrap()
}

/// ∫ p·dv·e^{−ikθ} by the trapezoidal rule, which converges exponentially for smooth functions.
fn phasor(of: impl Fn(f64) -> f64, p: &Arc<dyn Mechanism>, k: f64, turns: f64) -> Complex64 {
    const COUNT: usize = 3000;
    let sum: Complex64 = (0..COUNT)
        .map(|j| {
            let theta = TAU * turns * j as f64 / COUNT as f64;
            let torque = -of(theta.to_degrees())
                * p.motion(&CrankPosition::new(theta.sin(), theta.cos())).velocity;
            torque * Complex64::cis(-k * theta)
        })
        .sum();
    sum * (if k == 0.0 { 1.0 } else { 2.0 } / COUNT as f64)
}

#[test]
fn harmonics_of_smooth_panels_are_those_of_their_function() {
    let edges: Vec<f64> = (0..=48).map(|k| 15.0 * f64::from(k)).collect();
    let cycle = panels(smooth, &edges, 15);
    for (ratio, offset) in [(0.3, 0.0), (0.3, 0.4), (0.9, -0.05)] {
        let p = with_ratios(ratio, offset).unwrap();
        let orders: Vec<Order> =
            [30, 1, 2, 3, 7, 80].map(|h| Order::from_halves(h).unwrap()).into();
        let torque = cycle.torque_of(&p, ATMOSPHERE, &orders, &Cancel::new()).unwrap();
        let gauge = |theta: f64| smooth(theta) - ATMOSPHERE;
        // Roundings of the largest pressure, 1e6 Pa.
        assert!((torque.mean - phasor(gauge, &p, 0.0, 2.0).re).abs() < 1e-8);
        for (order, found) in orders.iter().zip(&torque.phasors) {
            let expected = phasor(gauge, &p, order.number(), 2.0);
            assert!((found - expected).norm() < 1e-8, "{ratio} {order}: {found} {expected}");
        }
    }
}

#[test]
fn a_long_rod_and_a_constant_pressure_have_closed_forms() {
    // −velocity = sin θ: torque p·sin θ; pressure (1 + cos θ/2)·p gives orders ½, 1, 3/2.
    let p = with_ratios(1e-9, 0.0).unwrap();
    let edges = [0.0, 180.0, 360.0, 540.0, 720.0];
    let cycle = panels(|theta| 1e6 * (1.0 + (0.5 * theta).to_radians().cos()), &edges, 20);
    let orders: Vec<Order> = (1..=4).map(|h| Order::from_halves(h).unwrap()).collect();
    let torque = cycle.torque_of(&p, 0.0, &orders, &Cancel::new()).unwrap();
    let i = Complex64::I;
    let expected = [-0.5 * i, -i, -0.5 * i, Complex64::default()];
    for (found, expected) in torque.phasors.iter().zip(expected) {
        assert!((found / 1e6 - expected).norm() < 2e-9, "{found} {expected}");
    }
}

#[test]
fn a_table_converges_to_its_function_in_the_fourth_order() {
    let p = with_ratios(0.3, 0.1).unwrap();
    let orders: Vec<Order> = (1..=24).map(|h| Order::from_halves(h).unwrap()).collect();
    let error = |count: usize| {
        let cycle = table(even(count, 720.0), smooth, 4).unwrap();
        let torque = cycle.torque_of(&p, 0.0, &orders, &Cancel::new()).unwrap();
        let pairs = orders.iter().zip(&torque.phasors);
        pairs.map(|(k, t)| (t - phasor(smooth, &p, k.number(), 2.0)).norm()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(180), error(720));
    // 4⁴ = 256 for four times the points.
    assert!(fine * 150.0 < coarse && fine < 0.2, "{coarse} {fine}");
}

#[test]
fn closed_open_shifted_and_uneven_grids_are_one_cycle() {
    let open = table(even(720, 720.0), smooth, 4).unwrap();
    let closed = table((0..=720).map(f64::from), smooth, 4).unwrap();
    let shifted = table((-360..360).map(f64::from), smooth, 4).unwrap();
    assert!(closed.is_closed() && !open.is_closed() && !shifted.is_closed());
    for theta in [0.0, 0.4, 359.9, 719.7, -0.3, 1234.5] {
        let expected = open.pressure_deg(theta);
        assert_relative_eq!(closed.pressure_deg(theta), expected, max_relative = 1e-12);
        assert_relative_eq!(shifted.pressure_deg(theta), expected, max_relative = 1e-12);
        assert_relative_eq!(open.pressure(theta.to_radians()), expected, max_relative = 1e-12);
    }
    let uneven = table((0..720).map(|k| f64::from(k) + 0.3 * f64::from(k % 2)), smooth, 4).unwrap();
    assert_relative_eq!(uneven.pressure_deg(100.7), smooth(100.7), max_relative = 1e-6);
}

#[test]
fn cubics_do_not_overshoot_and_keep_to_their_side_of_a_jump() {
    let step = |theta: f64| if theta < 100.0 { 1e5 } else { 4e6 };
    let cycle = table((0..720).map(f64::from), step, 4).unwrap();
    for k in 0..7200 {
        let value = cycle.pressure_deg(0.1 * f64::from(k));
        assert!((1e5 - 1e-6..=4e6 + 1e-6).contains(&value), "{k} {value}");
    }
    // A line on one side of a jump, a parabola on the other.
    let of = |theta: f64, after: bool| match theta {
        t if t > 90.0 || (t == 90.0 && after) => 1e5 + 10.0 * (t - 90.0).powi(2),
        t => 2e5 + 100.0 * t,
    };
    let mut theta_deg: Vec<f64> = (0..36).map(|k| 10.0 * f64::from(k)).collect();
    theta_deg.insert(9, 90.0);
    let pressure = theta_deg.iter().enumerate().map(|(k, &t)| of(t, k > 9)).collect();
    let cycle =
        Cycle::new(Given { name: String::new(), strokes: 2, theta_deg, pressure, degree: None });
    let cycle = cycle.unwrap();
    for theta in [82.0, 89.999, 90.0, 90.001, 97.0, 133.0] {
        assert_relative_eq!(cycle.pressure_deg(theta), of(theta, true), max_relative = 1e-12);
    }
}

#[test]
fn cubics_are_monotone_where_the_table_is() {
    // Steps that differ by powers of ten, up to the middle and down again.
    let mut theta_deg: Vec<f64> = (0..=60).map(|k| 6.0 * f64::from(k)).collect();
    let mut pressure = vec![1e5];
    for k in 1..=30_i32 {
        pressure.push(pressure[pressure.len() - 1] + 10_f64.powi((k * k * 7 + k) % 5));
    }
    let rise: Vec<f64> = pressure.clone();
    pressure.extend(rise.iter().rev().skip(1));
    theta_deg.pop();
    pressure.pop();
    let given = Given {
        name: String::new(),
        strokes: 2,
        theta_deg: theta_deg.clone(),
        pressure: pressure.clone(),
        degree: None,
    };
    let cycle = Cycle::new(given).unwrap();
    for (pair, ends) in theta_deg.windows(2).zip(pressure.windows(2)) {
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        for k in 1..20 {
            let value = cycle.pressure_deg(pair[0] + 0.3 * f64::from(k));
            // Roundings of 2e5.
            assert!((low - 1e-9..=high + 1e-9).contains(&value), "{pair:?}: {low} {value} {high}");
        }
    }
}

#[test]
fn grids_that_are_no_period_are_rejected_with_a_hint() {
    let error = |angles: Vec<f64>, strokes| {
        table(angles.into_iter(), |_| 1e5, strokes).unwrap_err().to_string()
    };
    let degrees = |from: i32, to: i32| (from..to).map(f64::from).collect::<Vec<_>>();
    assert!(error(degrees(0, 360), 4).contains("strokes = 2"));
    assert!(error(degrees(0, 700), 4).contains("one period, 720°"));
    assert!(error(degrees(0, 1440), 4).contains("several cycles"));
    assert!(error(degrees(0, 720).iter().map(|t| t.to_radians()).collect(), 4).contains("radians"));
    assert!(error(vec![0.0, 2.0, 1.0, 3.0, 4.0, 5.0, 6.0, 7.0], 4).contains("theta_deg[2] = 1.0"));
    let ramp = table((0..=720).map(f64::from), |t| 1e5 + t, 4).unwrap_err().to_string();
    assert!(ramp.starts_with("pressure[720] = 100720.0: the grid is closed"), "{ramp}");
    assert!(error(degrees(0, 5), 4).contains("5 points"));
    let mut thrice = degrees(0, 720);
    thrice.splice(5..5, [5.0, 5.0]);
    assert!(error(thrice, 4).contains("three times"));
    let dip = |least: f64| {
        table(even(720, 720.0), |t| if t == 5.0 { least } else { 1e5 }, 4)
            .map_err(|error| error.to_string())
    };
    assert!(dip(-1e5).is_ok());
    assert!(dip(-1e6).unwrap_err().starts_with("pressure[5] = -1000000.0: give absolute"));
    let below = (0..3).flat_map(|_| degrees(0, 720)).collect();
    assert!(error(below, 4).contains("of several cycles below each other"));
}

#[test]
fn tails_bound_what_is_left_out_and_are_close() {
    let p = with_ratios(0.3, 0.0).unwrap();
    let cycle = table(even(360, 720.0), smooth, 4).unwrap();
    let highest = Order::whole(40).unwrap();
    let tails = cycle.torque_up_to(&p, ATMOSPHERE, highest, &Cancel::new()).unwrap().1;
    let orders: Vec<Order> = (1..=600).map(|h| Order::from_halves(h).unwrap()).collect();
    let torque = cycle.torque_of(&p, ATMOSPHERE, &orders, &Cancel::new()).unwrap();
    for (above, tail) in tails.iter().enumerate() {
        let left: f64 = torque.phasors[above + 1..].iter().map(|phasor| phasor.norm()).sum();
        assert!(left <= *tail, "{above}: {left} {tail}");
        assert!(*tail <= 4.0 * left + 1.0 || above > 30, "{above}: {left} {tail}");
    }
    assert_eq!(tails.len(), 80);
    // A jump where the piston moves has a divergent sum; one where it stands has not.
    let jump = |at: f64| {
        let cycle = panels(|t| 1e5 + 1e4 * (t - at), &[at, at + 720.0], 3);
        cycle.torque_up_to(&p, 0.0, highest, &Cancel::new()).unwrap().1[79]
    };
    assert_eq!(jump(90.0), f64::INFINITY);
    assert!(jump(0.0) < 1e7);
}

#[test]
fn a_torque_that_is_kept_is_that_of_its_own_question() {
    let cycle = table(even(90, 720.0), smooth, 4).unwrap();
    let orders = |halves: &[u32]| -> Vec<Order> {
        halves.iter().map(|&h| Order::from_halves(h).unwrap()).collect()
    };
    let mut questions = Vec::new();
    for offset in [0.0, 0.1] {
        for crankcase in [0.0, ATMOSPHERE] {
            for halves in [&[1, 2, 3][..], &[2], &[3, 2, 1]] {
                let p = with_ratios(0.3, offset).unwrap();
                questions.push((p, crankcase, orders(halves)));
            }
        }
    }
    let answers = |(p, crankcase, orders): &(Arc<dyn Mechanism>, f64, Vec<Order>),
                   cycle: &Cycle| {
        let torque = cycle.torque_of(p, *crankcase, orders, &Cancel::new()).unwrap();
        (torque, cycle.torque_up_to(p, *crankcase, orders[0], &Cancel::new()).unwrap())
    };
    for question in &questions {
        // A copy keeps nothing.
        let alone = answers(question, &cycle.clone());
        for _ in 0..2 {
            assert_eq!(answers(question, &cycle), alone);
        }
    }
}

#[test]
fn a_two_stroke_has_whole_orders_alone() {
    let p = with_ratios(0.3, 0.0).unwrap();
    let of = |theta: f64| 1e5 / (1.1 - theta.to_radians().cos());
    let cycle = panels(of, &(0..=24).map(|k| 15.0 * f64::from(k)).collect::<Vec<_>>(), 15);
    let orders: Vec<Order> = (1..=6).map(|h| Order::from_halves(h).unwrap()).collect();
    let torque = cycle.torque_of(&p, 0.0, &orders, &Cancel::new()).unwrap();
    for (order, found) in orders.iter().zip(&torque.phasors) {
        match order.as_whole() {
            None => assert_eq!(*found, Complex64::default()),
            Some(k) => {
                let expected = phasor(of, &p, f64::from(k), 1.0);
                assert!((found - expected).norm() < 1e-9, "{k} {found} {expected}");
            }
        }
    }
    assert_relative_eq!(cycle.pressure(-PI), of(180.0), max_relative = 1e-12);
}

#[test]
fn half_the_points_are_a_table_of_their_own() {
    let cycle = table((0..=720).map(f64::from), smooth, 4).unwrap();
    let (even, odd) = (cycle.thinned(false).unwrap(), cycle.thinned(true).unwrap());
    assert_eq!((even.given().theta_deg.len(), odd.given().theta_deg[0]), (361, 1.0));
    assert_relative_eq!(even.pressure_deg(718.0), smooth(718.0), max_relative = 1e-14);
    let text = serde_json::to_string(&cycle).unwrap();
    assert_eq!(serde_json::from_str::<Cycle>(&text).unwrap(), cycle);
}

/// Even and odd numbers of points, open and closed, equal steps and others.
#[test]
fn every_table_of_sixteen_points_has_two_halves() {
    for count in 16..80 {
        let step = 720.0 / f64::from(count);
        for (bend, closed) in [(0.0, false), (0.0, true), (0.4, true)] {
            let angle = |k: i32| step * (f64::from(k) + bend * f64::from(k).sin());
            let angles = (0..count).map(angle).chain(closed.then_some(720.0));
            let cycle = table(angles, smooth, 4).unwrap();
            for from_second in [false, true] {
                let half = cycle.thinned(from_second).unwrap();
                let widest = half.given().theta_deg.windows(2).map(|pair| pair[1] - pair[0]);
                assert!(widest.fold(0.0, f64::max) <= 2.001 * step * (1.0 + bend));
            }
        }
    }
    let few = table((0..15).map(|k| 48.0 * f64::from(k)), smooth, 4).unwrap();
    assert!(few.thinned(true).is_some());
    let fewer = table((0..14).map(|k| 720.0 / 14.0 * f64::from(k)), smooth, 4).unwrap();
    assert!(fewer.thinned(false).is_none());
}

#[test]
fn a_compressor_does_the_work_of_its_polytropes_at_either_end() {
    let [suction, discharge] = [1e5, 4e5];
    let ratio: f64 = discharge / suction;
    for (n, offset) in [(1.3, 0.0), (1.0, 0.004), (1.4, -0.004)] {
        let cylinder = Cylinder::new(0.05, 0.15, 1.0, offset).unwrap();
        let [highest, lowest] = cylinder.turning_points_deg();
        for clearance in [0.0, 1e-12, 1e-4, 0.1, 0.3] {
            for face in [Face::Outer, Face::Inner] {
                let compressor = Compressor {
                    suction,
                    discharge: Some(discharge),
                    clearance,
                    n,
                    expansion_n: n,
                };
                let swept = Swept::new(&cylinder, face);
                let cycle = Arc::new(compressor.cycle(&swept, String::new()).unwrap());
                let drawn_in = 1.0 - clearance * (ratio.powf(1.0 / n) - 1.0);
                let polytropic = match n {
                    1.0 => ratio.ln(),
                    n => n / (n - 1.0) * (ratio.powf((n - 1.0) / n) - 1.0),
                };
                let expected = -suction * drawn_in * polytropic;
                let found = cycle.imep_at(face, &cylinder, &Cancel::new()).unwrap();
                assert!(
                    (found / expected - 1.0).abs() < 1e-10,
                    "{n} {offset} {clearance} {face:?} {found} {expected}"
                );
                // Where the piston turns it is at the pressure of a valve, before and after.
                let turns = if face == Face::Outer { highest } else { 0.0 };
                assert_relative_eq!(
                    cycle.pressure_beside(turns, turns - 1e-3),
                    discharge,
                    max_relative = 1e-9
                );
                let bottom = if face == Face::Outer { lowest } else { highest + 360.0 - lowest };
                assert_relative_eq!(cycle.pressure_deg(bottom), suction, max_relative = 1e-9);
                // As far as it is resolved, p·Vⁿ is constant between the valves.
                for angle in (0..360).map(f64::from) {
                    let (pressure, volume) =
                        (cycle.pressure_deg(angle), clearance + swept.at(angle));
                    let is_between = pressure > 1.001 * suction && pressure < 0.999 * discharge;
                    if is_between && clearance > 1e-6 {
                        let constant = if swept.at(angle + 1e-3) < swept.at(angle) {
                            suction * (1.0 + clearance).powf(n)
                        } else {
                            discharge * clearance.powf(n)
                        };
                        assert_relative_eq!(
                            pressure * volume.powf(n),
                            constant,
                            max_relative = 1e-11_f64.max(1e-14 / clearance)
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn compressors_that_never_open_their_valves_are_rejected_and_unloaded_ends_have_one_pressure() {
    let cylinder = Cylinder::new(0.05, 0.15, 1.0, 0.0).unwrap();
    let swept = Swept::new(&cylinder, Face::Inner);
    let one =
        Compressor { suction: 1e5, discharge: Some(4e5), clearance: 0.1, n: 1.3, expansion_n: 1.3 };
    let error = |of: Compressor| of.cycle(&swept, String::new()).unwrap_err().to_string();
    // 1/(4^(1/1.3) − 1).
    let closed = error(Compressor { clearance: 0.6, ..one });
    assert!(closed.contains("at most 0.52497") && closed.starts_with("clearance"), "{closed}");
    assert!(error(Compressor { discharge: Some(9e4), ..one }).starts_with("discharge"));
    assert!(error(Compressor { clearance: -0.1, ..one }).starts_with("clearance"));
    assert!(error(Compressor { suction: 0.0, ..one }).starts_with("suction"));
    for discharge in [None, Some(1e5)] {
        let idle = Compressor { discharge, ..one }.cycle(&swept, String::new()).unwrap();
        assert!((0..360).all(|k| (idle.pressure_deg(f64::from(k)) - 1e5).abs() < 1e-9));
    }
}
