//! The arrangement search against every pair of arrangements, looked at one by one.

use std::f64::consts::{PI, TAU};

use crankpin_core::balance::{Vector, balance};
use crankpin_core::search::{Angles, Bank, Criterion, Search, Solution, bank};
use crankpin_core::{Angle, Cancel, Complex64, Cylinder, Engine, Error, Hold, Orders, Request};

/// Sums of at most seven terms of at most 3, and their arguments, are good to 1e-14; different |Z|
/// and angles of such small banks are 1e-4 apart at least.
const NEAR: f64 = 1e-9;

fn given(degrees: &[f64]) -> Bank {
    let phases: Vec<Angle> = degrees.iter().map(|&d| Angle::from_degrees(d).unwrap()).collect();
    bank(2 * degrees.len(), false, Some(&phases)).unwrap()
}

/// With and without a mirror, with odd and even numbers of turns, with phases that repeat.
fn banks() -> Vec<Bank> {
    let mut banks: Vec<Bank> = (2..=6).map(|n| Bank::even_firing(n, false).unwrap()).collect();
    banks.extend((4..=7).map(|n| Bank::even_firing(n, true).unwrap()));
    banks.extend([
        given(&[0.0, 180.0]),
        given(&[0.0, 90.0, 180.0, 270.0]),
        given(&[0.0, 60.0, 120.0, 180.0, 240.0, 300.0]),
        given(&[0.0, 40.0, 120.0, 160.0, 240.0, 280.0]),
        given(&[0.0, 30.0, 90.0, 210.0]),
        given(&[0.0, 30.0, 30.0, 90.0, 240.0]),
        given(&[0.0, 72.0, 216.0]),
        given(&[10.0, 50.0, 190.0, 230.0]),
        given(&[0.0, 0.0, 90.0, 180.0, 180.0, 270.0]),
        given(&[0.0, 0.0, 0.0, 90.0, 180.0, 180.0, 180.0, 270.0]),
        given(&[0.0, 30.0, 90.0, 180.0, 210.0, 270.0]),
        given(&[0.0, 0.0, 90.0, 270.0]),
        given(&[0.0, 0.0, 0.0, 90.0, 180.0]),
    ]);
    // Of which some Z nearly vanish, 0 < |2Z| < 0.1, also in classes of several; without and with a
    // mirror.
    let small: [(f64, &[u32]); 6] = [
        (15.0, &[0, 1, 2, 14]),
        (16.0, &[0, 2, 7, 9, 12, 13]),
        (18.0, &[0, 5, 7, 8, 15, 16]),
        (21.0, &[0, 3, 9, 11, 17, 20]),
        (28.0, &[0, 2, 13, 14, 16, 17]),
        (30.0, &[0, 5, 6, 10, 19, 20]),
    ];
    for (parts, phases) in small {
        let degrees = phases.iter().map(|&k| 360.0 * f64::from(k) / parts);
        banks.push(given(&degrees.collect::<Vec<_>>()));
    }
    banks
}

/// Every order of the phases, each once.
fn arrangements(bank: &Bank) -> Vec<Vec<u32>> {
    fn extend(rest: &[u32], so_far: &[u32], out: &mut Vec<Vec<u32>>) {
        if rest.is_empty() {
            out.push(so_far.to_vec());
        }
        for i in (0..rest.len()).filter(|&i| i == 0 || rest[i] != rest[i - 1]) {
            let others = [&rest[..i], &rest[i + 1..]].concat();
            extend(&others, &[so_far, &rest[i..=i]].concat(), out);
        }
    }
    let mut out = Vec::new();
    extend(&bank.phases, &[], &mut out);
    if bank.alternating {
        out.retain(|arrangement| alternates(arrangement));
    }
    out
}

/// In firing order, over a whole cycle, front and rear throws take turns; a central one stands
/// between a rear and a front one.
fn alternates(arrangement: &[u32]) -> bool {
    let n = arrangement.len();
    let half = n / 2;
    // Even numbers of throws fire two at a phase, a turn apart: either may be the first.
    let at = |phase: usize| -> Vec<usize> {
        (0..n).filter(|&throw| arrangement[throw] as usize == phase).collect()
    };
    if n % 2 == 1 {
        let centre = arrangement[half] as usize;
        let order: Vec<bool> = (1..n).map(|k| at((centre + 2 * k) % n)[0] < half).collect();
        return order.windows(2).all(|pair| pair[0] != pair[1]);
    }
    (0..1_usize << half).any(|choice| {
        let order = |k: usize| at(k % half)[(choice >> (k % half) & 1) ^ (k / half)] < half;
        (0..n).all(|k| order(k) != order((k + 1) % n))
    })
}

fn unit(bank: &Bank, phase: u32) -> Complex64 {
    Complex64::cis(TAU * f64::from(phase) / f64::from(bank.parts))
}

/// Σ s e^{i·phase}, s from the middle, positive to the front.
fn first_moment(bank: &Bank, arrangement: &[u32]) -> Complex64 {
    let middle = 0.5 * (arrangement.len() as f64 - 1.0);
    arrangement.iter().enumerate().map(|(i, &p)| unit(bank, p) * (middle - i as f64)).sum()
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= NEAR
}

/// Moment of both banks at an order, over m·r·ω²·spacing·aₙ: forward, about x and about y.
fn moments(
    bank: &Bank,
    hold: Hold,
    order: i32,
    angle: f64,
    pair: [&[u32]; 2],
) -> (Complex64, [f64; 2]) {
    let mut sums = [Complex64::default(); 3];
    for (phases, side) in pair.into_iter().zip([-0.5, 0.5]) {
        let bore = Complex64::cis(0.5 * PI + side * angle);
        for (i, &phase) in phases.iter().enumerate() {
            let lever = 0.5 * (phases.len() as f64 - 1.0) - i as f64;
            // e^{−i·tdc}; a pin stands at bore − tdc.
            let tdc = match hold {
                Hold::Firing => unit(bank, phase),
                Hold::Pins => unit(bank, phase) * bore.conj(),
            };
            let pressed = tdc.powi(order) * lever;
            let parts = [0.5 * pressed * bore, pressed * bore.im, pressed * bore.re];
            for (sum, part) in sums.iter_mut().zip(parts) {
                *sum += part;
            }
        }
    }
    (sums[0], [sums[1].norm(), sums[2].norm()])
}

/// A bank angle, degrees, and of the pairs that have it the larger second-order moment and the
/// counterweight's moment: those of the pair of which the one is least, and of which the other is.
#[derive(Debug, Clone, Copy)]
struct Brute {
    degrees: f64,
    least: [[f64; 2]; 2],
}

/// Pairs of equal |Z|, pairs without Z, and the angles of the others.
fn by_brute_force(bank: &Bank, hold: Hold) -> (usize, usize, Vec<Brute>) {
    let mut all: Vec<(Complex64, Vec<u32>)> =
        arrangements(bank).into_iter().map(|a| (first_moment(bank, &a), a)).collect();
    all.sort_by(|(a, _), (b, _)| a.norm().total_cmp(&b.norm()));
    let (mut qualifying, mut balanced) = (0, 0);
    let mut angles: Vec<(f64, [f64; 2])> = Vec::new();
    for class in all.chunk_by(|(a, _), (b, _)| near(a.norm(), b.norm())) {
        qualifying += class.len() * class.len();
        if near(class[0].0.norm(), 0.0) {
            balanced += class.len() * class.len();
            continue;
        }
        for (z1, first) in class {
            for (z2, second) in class {
                let condition = (-z2 / z1).arg();
                // A half that is half a circle on is the same in the other direction.
                let beyond = 0.5 * condition - PI.copysign(condition);
                let found = match hold {
                    Hold::Firing => vec![condition],
                    Hold::Pins => vec![0.5 * condition, beyond],
                };
                for angle in found {
                    let pair: [&[u32]; 2] =
                        if angle < 0.0 { [second, first] } else { [first, second] };
                    let angle = angle.abs();
                    let (forward, _) = moments(bank, hold, 1, angle, pair);
                    let (_, [x, y]) = moments(bank, hold, 2, angle, pair);
                    angles.push((angle.to_degrees(), [x.max(y), forward.norm()]));
                }
            }
        }
    }
    angles.sort_by(|a, b| a.0.total_cmp(&b.0));
    let least = |found: &[(f64, [f64; 2])]| {
        let by = |k: usize| {
            let better = |a: &[f64; 2], b: &[f64; 2]| {
                a[k] < b[k] - NEAR || (near(a[k], b[k]) && a[1 - k] < b[1 - k])
            };
            let pairs = found.iter().map(|found| found.1);
            pairs.reduce(|least, pair| if better(&pair, &least) { pair } else { least }).unwrap()
        };
        Brute { degrees: found[0].0, least: [by(0), by(1)] }
    };
    let angles = angles.chunk_by(|last, next| near(last.0, next.0)).map(least).collect();
    (qualifying, balanced, angles)
}

/// The pair listed for an angle.
fn listed(search: &Search, angles: &Angles, k: usize, by: Criterion) -> Option<Solution> {
    search.solution(angles, k, by, &Cancel::new()).unwrap()
}

fn search(bank: &Bank, hold: Hold) -> Search {
    Search::new(bank.clone(), hold, &Cancel::new()).unwrap()
}

#[track_caller]
fn same(found: &[f64], expected: &[f64], what: &dyn std::fmt::Debug) {
    assert_eq!(found.len(), expected.len(), "{what:?}: {found:?} {expected:?}");
    assert!(found.iter().zip(expected).all(|(a, b)| near(*a, *b)), "{what:?}: {found:?}");
}

#[test]
fn every_pair_is_found_and_no_other() {
    for bank in banks() {
        for hold in [Hold::Firing, Hold::Pins] {
            let search = search(&bank, hold);
            let (qualifying, balanced, angles) = by_brute_force(&bank, hold);
            let all = arrangements(&bank).len();
            assert_eq!(search.candidates(), (all * all) as u128, "{bank:?}");
            assert_eq!(search.qualifying(), qualifying as u128, "{bank:?}");
            assert_eq!(search.balanced(), balanced as u128, "{bank:?}");
            assert!(search.distinct() * 4 * bank.turns as usize >= all && search.distinct() <= all);
            let cancel = Cancel::new();
            let found = search.angles([0.0, 180.0], &cancel).unwrap();
            let (done, total) = cancel.progress();
            assert!(done == total && done > 0);
            assert_eq!(found.count(), found.degrees(&Cancel::new()).unwrap().len());
            let degrees: Vec<f64> = angles.iter().map(|angle| angle.degrees).collect();
            same(&found.degrees(&Cancel::new()).unwrap(), &degrees, &(&bank, hold));
            for (k, angle) in angles.iter().enumerate() {
                for (by, least) in
                    [Criterion::SecondOrder, Criterion::Counterweight].into_iter().zip(angle.least)
                {
                    let solution = listed(&search, &found, k, by).unwrap();
                    let [x, y] = solution.second_order;
                    same(&[x.max(y), solution.counterweight], &least, &(&bank, hold, angle, by));
                }
            }
        }
    }
}

#[test]
fn a_window_has_the_angles_within_it() {
    for bank in banks() {
        for hold in [Hold::Firing, Hold::Pins] {
            let search = search(&bank, hold);
            let all = search
                .angles([0.0, 180.0], &Cancel::new())
                .unwrap()
                .degrees(&Cancel::new())
                .unwrap();
            let Some(&middle) = all.get(all.len() / 2) else { continue };
            for window in [
                [0.0, 50.0],
                [50.0, 130.0],
                [88.0, 92.0],
                [130.0, 180.0],
                [180.0, 180.0],
                [0.0, 0.0],
                [middle, middle],
                [100.0, 80.0],
            ] {
                let found = search.angles(window, &Cancel::new()).unwrap();
                let within = |angle: &f64| (window[0]..=window[1]).contains(angle);
                let expected: Vec<f64> = all.iter().copied().filter(within).collect();
                same(&found.degrees(&Cancel::new()).unwrap(), &expected, &(&bank, hold, window));
                assert!(listed(&search, &found, expected.len(), Criterion::SecondOrder).is_none());
            }
        }
    }
}

/// What a solution says of its engine, by the engine's own balance.
#[track_caller]
fn check(solution: &Solution, engine: &Engine, unit: f64, second_order: f64) {
    let orders = Orders::whole(&[1, 2]).unwrap();
    let request = Request { rpm: 3000.0, reference_z: None, torque: false };
    let balance = balance(engine, &request, &orders, &Cancel::new()).unwrap();
    // Sums of fourteen terms, good to 1e-14 of the longest lever, 3.
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} is not {b} of {solution:?}");
    let first = balance.planar(Vector::Moment, 0);
    close(first.backward().norm(), 0.0);
    close(first.forward.norm() / unit, solution.counterweight);
    let xy = balance.xy(Vector::Moment, 1);
    close(xy[0].norm() / (unit * second_order), solution.second_order[0]);
    close(xy[1].norm() / (unit * second_order), solution.second_order[1]);
}

#[test]
fn a_solution_is_the_balance_of_its_engine() {
    let (cylinder, spacing) = (Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap(), 0.1);
    let omega = 3000.0 * TAU / 60.0;
    let second_order = cylinder.mechanism().force(&[2], &Cancel::new()).unwrap()[0].norm();
    for bank in banks() {
        for hold in [Hold::Firing, Hold::Pins] {
            let search = search(&bank, hold);
            let angles = search.angles([0.0, 180.0], &Cancel::new()).unwrap();
            for (k, degrees) in angles.degrees(&Cancel::new()).unwrap().into_iter().enumerate() {
                let solution = listed(&search, &angles, k, Criterion::SecondOrder).unwrap();
                assert!(near(solution.bank_angle, degrees));
                assert!(0.0 <= solution.bank_angle && solution.bank_angle <= 180.0);
                for phases in &solution.banks {
                    let mut phases = phases.clone();
                    phases.sort_unstable();
                    assert_eq!(phases, bank.phases);
                }
                let engine = solution.engine(cylinder, spacing).unwrap();
                let unit = cylinder.mass_radius() * omega * omega * spacing;
                check(&solution, &engine, unit, second_order);
            }
        }
    }
}

#[test]
fn what_is_no_bank_is_refused() {
    let said = |result: Result<Bank, Error>| result.unwrap_err().to_string();
    assert!(said(bank(7, false, None)).contains("even number"));
    for cylinders in [2, 32] {
        assert!(said(bank(cylinders, false, None)).contains("4 to 24"), "{cylinders}");
        assert!(said(bank(cylinders, false, None)).contains(&cylinders.to_string()));
    }
    let three = [0.0, 120.0, 240.0].map(|d| Angle::from_degrees(d).unwrap());
    assert!(bank(6, false, Some(&three)).is_ok());
    assert!(said(bank(8, false, Some(&three))).contains('4'));
    assert!(said(bank(6, true, Some(&three))).contains("alternati"));
    for (finer, hint) in [(0.5, "1/360"), (17.3, "1/360"), (17.123_456_789_123_4, "rational parts")]
    {
        let phases = [0.0, finer].map(|d| Angle::from_degrees(d).unwrap());
        assert!(said(bank(4, false, Some(&phases))).contains(hint), "{finer}");
    }
    let finest = [0.0, 1.0].map(|d| Angle::from_degrees(d).unwrap());
    assert_eq!(bank(4, false, Some(&finest)).unwrap().parts, 360);
}
