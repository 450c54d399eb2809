use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::engine::{Engine, Hold, Placement};
use crate::error::Error;
use crate::order::Order;
use crate::sweep::{Axes, Figure};
use crate::{Angle, Cylinder};

#[test]
fn cancellation_stops_at_the_next_block() {
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let place = |bank: f64| Placement {
        cylinder,
        tdc: Angle::ZERO,
        bank: Angle::from_degrees(bank).unwrap(),
        z: 0.0,
        rotating_mass: 0.0,
    };
    let engine = Arc::new(Engine::new("", "", vec![place(60.0), place(120.0)]).unwrap());
    let engines = vec![Arc::clone(&engine), engine];
    let some = |count| Some(vec![0.3; count]);
    let angles = |count| Some((vec![60.0; count], Hold::Pins));
    // Blocks of two engines' rows, in pieces of 1024.
    for (bank_angle, rod_ratio, blocks) in [
        (None, None, 2),
        (angles(300), None, 2 * 3),
        (angles(300), some(4), 2 * (8 + 2)),
        (None, some(1200), 2 * (8 + 2)),
        (angles(2), some(200), 2 * 4),
    ] {
        for rpm in [vec![3000.0], vec![3000.0, 1000.0]] {
            let (bank_angle, rod_ratio) = (bank_angle.clone(), rod_ratio.clone());
            let rows = 2
                * bank_angle.as_ref().map_or(1, |(angles, _)| angles.len())
                * rod_ratio.as_ref().map_or(1, Vec::len);
            // Pieces of values times speeds are steps too.
            let pieces = if rpm.len() > 1 { (rows * rpm.len()).div_ceil(PIECE) } else { 0 };
            let axes = Axes { bank_angle, rod_ratio, pin_offset: None, rpm };
            let orders = vec![Order::whole(2).unwrap()];
            let sweep = Sweep::new(engines.clone(), axes, orders, None, None).unwrap();
            let run = |last: usize| {
                let (cancel, done) = (Cancel::new(), AtomicUsize::new(0));
                let shape = sweep.result_shape(Quantity::Force, Figure::Length);
                let mut out = vec![0.0; shape.iter().product()];
                let finish = |_: &Block, _: f64, _: &mut [f64]| {
                    if done.fetch_add(1, Ordering::Relaxed) + 1 == last {
                        cancel.raise();
                    }
                    Ok(())
                };
                let what = (Quantity::Force, Figure::Length, false);
                let result = sweep.fill(what, &mut out, &cancel, finish);
                (result, done.into_inner(), cancel.progress())
            };
            assert_eq!(run(0), (Ok(()), blocks, (rows + pieces, rows + pieces)));
            for last in 1..blocks {
                let (result, done, _) = run(last);
                assert_eq!((result, done), (Err(Error::Cancelled), last));
            }
            // After the last block only a step over speeds can notice.
            assert_eq!(run(blocks).0.is_err(), pieces > 0);
        }
    }
}

/// Numbers without a pattern, each a whole number of quarters: sums of products are exact.
fn numbers(count: usize, seed: usize) -> Vec<f64> {
    (0..count).map(|k| ((k * 37 + seed * 101) % 113) as f64 * 0.25 - 14.0).collect()
}

#[test]
fn rows_combine_functions_of_their_angle_with_constants_of_their_point() {
    let orders = 3;
    for (angles, points) in [(300, 1), (1, 300), (7, 40), (40, 7), (3, 128), (2, 129)] {
        let functions = |order| [0, 1, 2, 3].map(|k| numbers(angles, 7 * order + k)).concat();
        let turning = Turning((0..orders).map(functions).collect());
        let columns = |order| {
            let mut seed = 100 * (order + 1);
            let columns = [(); CONSTANTS].map(|()| {
                seed += 1;
                numbers(points, seed)
            });
            columns.concat()
        };
        let constants = Constants { by_order: (0..orders).map(columns).collect(), points };
        let mut block = Block::new(orders);
        // Also of a first row within an angle, after more rows than there are now.
        for rows in [0..BLOCK, 5..5 + BLOCK, 13..20, angles * points - 1..angles * points] {
            block.evaluate(&turning, &constants, rows.clone());
            for (i, row) in rows.enumerate() {
                for order in 0..orders {
                    let f: [&[f64]; FUNCTIONS] = columns_of(&turning.0[order]);
                    let f = f.map(|f| f[row / points]);
                    let c: [&[f64]; CONSTANTS] = columns_of(&constants.by_order[order]);
                    let c = c.map(|c| c[row % points]);
                    let part = |cos: f64, sin: f64, at: usize| {
                        let complex = |k: usize| Complex64::new(c[k], c[k + 1]);
                        complex(at) * cos + complex(4 + at) * sin + complex(8 + at)
                    };
                    let expected = [part(f[0], f[1], 0), part(f[2], f[3], 2)];
                    let bound = c[CONSTANTS - 1];
                    assert_eq!(block.bound(order, i), bound);
                    assert_eq!(block.turning(order, i), expected.map(|p| snapped(p, bound)));
                    let [x, y] = [expected[0] + expected[1], expected[0] - expected[1]];
                    let xy = [x, -Complex64::i() * y].map(|p| snapped(p, bound));
                    assert_eq!(block.phasors(order, i), xy);
                    assert_eq!(block.by_component(i).map(|all| all[order]), xy);
                }
            }
        }
    }
}

#[test]
fn magnitudes_are_zero_within_their_bound() {
    assert_eq!(magnitude(3.0, -4.0, 24.9), 5.0);
    assert_eq!(magnitude(3.0, -4.0, 25.0), 0.0);
    assert_eq!(magnitude(0.0, 0.0, 0.0), 0.0);
}

#[test]
fn rows_are_scaled_from_any_row_and_speed_on() {
    let (rows, speeds, width) = (numbers(3 * 4, 1), numbers(5, 2), 3);
    let all: Vec<f64> = rows
        .chunks(width)
        .flat_map(|row| speeds.iter().map(move |speed| row.iter().map(move |v| v * speed)))
        .flatten()
        .collect();
    for first in 0..20 {
        for count in 0..=20 - first {
            let mut out = vec![f64::NAN; count * width];
            scale(&rows, &speeds, width, first, &mut out);
            assert_eq!(out, all[first * width..(first + count) * width]);
        }
    }
}
