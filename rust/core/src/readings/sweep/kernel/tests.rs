use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::engine::{Engine, Hold, Station};
use crate::numbers::error::Error;
use crate::readings::balance::Orders;
use crate::readings::quantity::Quantity;
use crate::readings::sweep::{Statistic, SweepAxes};
use crate::{Angle, Cylinder};

#[test]
fn cancellation_stops_at_the_next_stretch() {
    let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
    let place = |bank: f64| Station {
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
    for (bank_angle, rod_ratio) in [
        (None, None),
        (angles(300), None),
        (angles(300), some(4)),
        (None, some(1200)),
        (angles(2), some(200)),
    ] {
        for rpm in [vec![3000.0], vec![3000.0, 1000.0]] {
            let (bank_angle, rod_ratio) = (bank_angle.clone(), rod_ratio.clone());
            let of_engine = bank_angle.as_ref().map_or(1, |(angles, _)| angles.len())
                * rod_ratio.as_ref().map_or(1, Vec::len);
            let rows = 2 * of_engine;
            // Pieces of values times speeds are steps too.
            let pieces = if rpm.len() > 1 { (rows * rpm.len()).div_ceil(ROWS_PER_TASK) } else { 0 };
            let axes = SweepAxes { bank_angle, rod_ratio, rpm, ..SweepAxes::default() };
            let orders = Orders::whole(&[2]).unwrap();
            let sweep =
                Sweep::new(engines.clone(), axes, &orders, None, true, &Cancel::new()).unwrap();
            // Raises the flag once a number of rows are done.
            let run = |after: usize| {
                let (cancel, done) = (Cancel::new(), AtomicUsize::new(0));
                let shape = sweep.result_shape(Quantity::FORCE, Statistic::Length);
                let mut out = vec![0.0; shape.iter().product()];
                let finish = |_: &Block, _: f64, out: &mut [f64]| {
                    if done.fetch_add(out.len(), Ordering::Relaxed) + out.len() >= after {
                        cancel.raise();
                    }
                    Ok(())
                };
                let quantity = Quantity::FORCE;
                let selection = Selection { quantity, group: None };
                let job = Job { sweep: &sweep, selection, width: 1, slow: false, cancel: &cancel };
                let result =
                    sweep.at_each_speed(quantity, 1, &mut out, &cancel, |_, out, factor| {
                        job.rows(out, factor, finish)
                    });
                (result, done.into_inner(), cancel.progress())
            };
            assert_eq!(run(usize::MAX), (Ok(()), rows, (rows + pieces, rows + pieces)));
            for first in (0..rows).filter(|row| (row % of_engine).is_multiple_of(ROWS_PER_CHECK)) {
                let end = (first / of_engine + 1) * of_engine;
                let end = end.min(first + ROWS_PER_CHECK);
                let (result, done, _) = run(first + 1);
                // After the last row only a step over speeds can notice.
                let noticed = end < rows || pieces > 0;
                assert_eq!(
                    (result, done),
                    (if noticed { Err(Error::Cancelled) } else { Ok(()) }, end)
                );
            }
        }
    }
}

/// Numbers without a pattern, each a whole number of quarters: sums of products are exact.
pub(in crate::readings::sweep) fn numbers(count: usize, seed: usize) -> Vec<f64> {
    (0..count).map(|k| ((k * 37 + seed * 101) % 113) as f64 * 0.25 - 14.0).collect()
}
