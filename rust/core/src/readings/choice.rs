//! A few orders that reach a tolerance, and the bound of what they leave out.
//!
//! What is left out is at most the sum of the sizes of its orders, |forward| + |backward| after the
//! layout's cancellations. Orders are evaluated up to where all above them are negligible, and that
//! rest is bounded in closed form; so the bound is loose only where the orders left out do not peak
//! together.

use crate::engine::Engine;
use crate::gear::harmonics;
use crate::gear::slider_crank::{Cylinder, Proportions};
use crate::gear::spectrum::Spectrum;
use crate::load::{Loads, Source};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::order::Order;
use crate::readings::amplitude::wrenches;
use crate::wrench::Wrench;

/// Orders above the last one evaluated add less than this part of a sum's largest term: a tenth of
/// the rounding error.
const NEGLIGIBLE: f64 = 1e-17;

/// Orders chosen for an engine, over ω² so that they serve any speed.
pub(crate) struct Chosen {
    /// Orders kept, ascending.
    pub orders: Vec<Order>,
    /// Their wrenches over ω².
    pub wrenches: Vec<Wrench>,
    /// Orders left out that are not zero.
    pub omitted: Vec<Order>,
    /// Bounds over ω² of what all orders left out add to force, moment and torque.
    pub error_bound: [f64; 3],
}

/// The orders of an engine that leave out at most `rtol`.
pub(crate) fn within(
    rtol: f64,
    engine: &Engine,
    loads: &Loads,
    spectrum: Option<&Spectrum>,
    torque: bool,
    cancel: &Cancel,
) -> Result<Chosen> {
    let rtol = limits::tolerance(rtol)?;
    let scales = scales(engine, loads);
    let proportions: Vec<Proportions> = loads.motions.iter().map(Cylinder::proportions).collect();
    let unbalances = loads.unbalance_orders();
    let candidates = if let Some(spectrum) = spectrum {
        of_spectrum(spectrum, &unbalances)
    } else {
        let motions = proportions.iter().enumerate();
        let motions = motions.map(|(k, motion)| (*motion, rod_share(loads, k, &scales)));
        let last = highest(rtol, NEGLIGIBLE, loads.list.len(), motions, torque)?;
        (1..=last.max(unbalances.last().copied().unwrap_or(1))).collect()
    };
    let orders = Order::all_whole(&candidates)?;
    let all = wrenches(loads, spectrum, torque, &orders, cancel)?;
    let sizes: Vec<[f64; 3]> = all.iter().map(sizes).collect();
    let last = candidates.last().copied().unwrap_or(1);
    let mut error_bound =
        if spectrum.is_some() { [0.0; 3] } else { tail(loads, last, torque, &proportions) };
    let kept = few(&sizes, &scales.map(|scale| rtol * scale), &mut error_bound);
    let mut chosen = Chosen { orders: vec![], wrenches: vec![], omitted: vec![], error_bound };
    for (((order, wrench), size), kept) in orders.into_iter().zip(all).zip(sizes).zip(kept) {
        if kept {
            chosen.orders.push(order);
            chosen.wrenches.push(wrench);
        } else if size.iter().any(|&size| size > 0.0) {
            chosen.omitted.push(order);
        }
    }
    Ok(chosen)
}

/// The orders of a spectrum, and those of unbalances.
pub(crate) fn of_spectrum(spectrum: &Spectrum, unbalances: &[u32]) -> Vec<u32> {
    let mut orders = [&spectrum.orders(), unbalances].concat();
    orders.sort_unstable();
    orders.dedup();
    orders
}

/// Drops orders from the smallest up while every sum stays within what it may lose.
///
/// `lost` holds what each sum has lost already and is given what it loses. Returns which orders are
/// kept. A size counts relative to what its sum may lose, and the largest of an order's decides.
pub(crate) fn few<S: AsRef<[f64]>>(sizes: &[S], allowed: &[f64], lost: &mut [f64]) -> Vec<bool> {
    let share = |sizes: &S| {
        let shares = sizes.as_ref().iter().zip(allowed);
        shares.map(|(&size, &most)| if size == 0.0 { 0.0 } else { size / most }).fold(0.0, f64::max)
    };
    let mut rising: Vec<(f64, usize)> = sizes.iter().map(share).zip(0..).collect();
    rising.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept = vec![true; sizes.len()];
    for (_, k) in rising {
        let sizes = sizes[k].as_ref();
        let sums = || lost.iter().zip(sizes).zip(allowed);
        if sums().all(|((lost, size), allowed)| *size == 0.0 || lost + size <= *allowed) {
            lost.iter_mut().zip(sizes).for_each(|(lost, size)| *lost += size);
            kept[k] = false;
        }
    }
    kept
}

/// Size of a motion's rod inertia over what a tolerance of torque is relative to.
pub(crate) fn rod_share(loads: &Loads, of_motion: usize, scales: &[f64; 3]) -> f64 {
    let inertia = loads.list.iter().map(|load| match load.source {
        Source::Piston { motion, rod_inertia, .. } if motion == of_motion => rod_inertia.abs(),
        _ => 0.0,
    });
    let largest = inertia.fold(0.0, f64::max);
    if largest == 0.0 { 0.0 } else { largest / scales[2] }
}

/// Highest order to evaluate for `count` loads of these proportions and shares of rod inertia.
///
/// Above it the remainder is at most `negligible`, or, if no order achieves that, at most `rtol`/4.
pub(crate) fn highest(
    rtol: f64,
    negligible: f64,
    count: usize,
    motions: impl Iterator<Item = (Proportions, f64)>,
    torque: bool,
) -> Result<u32> {
    let (needed, enough) = (0.25 * rtol / count as f64, negligible / count as f64);
    let mut highest = 1;
    for (proportions, rod_share) in motions {
        let torque = torque.then_some(rod_share);
        let last = match harmonics::highest_order(&proportions, enough, torque) {
            Some(order) => order,
            // A rest that is not negligible still is within the tolerance.
            None if harmonics::highest_order(&proportions, needed, torque).is_some() => {
                limits::HIGHEST_ORDER
            }
            None => return Err(Error::TooManyOrders { rtol, rod_ratio: 1.0 / proportions.rod }),
        };
        highest = highest.max(last);
    }
    Ok(highest)
}

/// Bounds over ω² of what orders above `highest` add to force, moment and torque, as if nothing
/// cancelled, for these proportions of each motion.
pub(crate) fn tail(
    loads: &Loads,
    highest: u32,
    torque: bool,
    proportions: &[Proportions],
) -> [f64; 3] {
    let known = |bound: Option<f64>| bound.unwrap_or(f64::INFINITY);
    let times = |weight: f64, bound: f64| if weight == 0.0 { 0.0 } else { weight * bound };
    let mut sum = [0.0; 3];
    for (k, motion) in proportions.iter().enumerate() {
        let force = known(harmonics::tail_bound(motion, highest));
        let (masses, rod) = if torque {
            let rod = known(harmonics::rod::tail_bound(motion, highest));
            (known(harmonics::torque::tail_bound(motion, highest)), rod)
        } else {
            (0.0, 0.0)
        };
        for load in &loads.list {
            let Source::Piston { motion, second_moment, rod_inertia, .. } = load.source else {
                continue;
            };
            if motion != k {
                continue;
            }
            sum[0] += times(load.weight, force);
            sum[1] += times(load.weight * (load.z - loads.reference).abs(), force);
            sum[2] += times(second_moment, masses) + times(rod_inertia.abs(), rod);
        }
    }
    sum
}

/// What a tolerance is relative to, over ω²: the largest m·r of a cylinder or unbalance, times the
/// longest lever, times its crank radius (of an unbalance, the engine's largest or its shaft's
/// distance from the crank). Where rod inertia makes more of order 1, what it makes: about J·r/l.
pub(crate) fn scales(engine: &Engine, loads: &Loads) -> [f64; 3] {
    let mut largest = [0.0_f64; 3];
    for gear in engine.gears() {
        largest[0] = largest[0].max(gear.first_order());
        let of_rod = gear.rod_inertia_excess().abs() * gear.rod_ratio();
        largest[2] = largest[2].max(gear.second_moment()).max(of_rod);
    }
    for load in &loads.list {
        if let Source::Unbalance { ratio, axis } = load.source {
            let force = load.weight * f64::from(ratio) * f64::from(ratio);
            largest[0] = largest[0].max(force);
            largest[2] = largest[2].max(force * engine.largest_crank_radius().max(axis.norm()));
        }
    }
    largest[1] = largest[0] * loads.longest_lever();
    largest
}

/// Sizes of force, moment and the larger torque.
fn sizes(wrench: &Wrench) -> [f64; 3] {
    [wrench.force.peak(), wrench.moment.peak(), wrench.torque.peak()]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::*;
    use crate::engine::Placement;
    use crate::load::Alike;
    use crate::numbers::angle::Angle;

    #[test]
    fn a_rod_counts_by_its_inertia_over_what_a_tolerance_is_relative_to() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let place = |inertia: f64| Placement {
            cylinder: cylinder.with_rod_inertia_excess(inertia).unwrap(),
            tdc: Angle::ZERO,
            bank: Angle::ZERO,
            z: 0.0,
            rotating_mass: 0.0,
        };
        let share = |inertias: [f64; 2], motion: usize| {
            let engine = Engine::new("", "", inertias.map(place).to_vec()).unwrap();
            let loads = Loads::new(&engine, 0.0, Alike::Proportions);
            rod_share(&loads, motion, &[1.0, 1.0, 4.0])
        };
        assert_eq!(share([0.0, 0.0], 0), 0.0);
        assert_eq!(share([0.002, -0.008], 0), 0.002);
        assert_eq!(share([0.002, -0.008], 1), 0.0);
    }

    #[test]
    fn orders_are_dropped_from_the_smallest_up() {
        let sizes = [[4.0], [1.0], [0.0], [3.0], [2.0]];
        let mut lost = [0.5];
        // 1 and 2 fit beside the half that is lost already; 3 does not, nor does 4.
        assert_eq!(few(&sizes, &[4.0], &mut lost), [true, false, false, true, false]);
        assert_eq!(lost, [3.5]);
        // A sum that is met exactly is within its tolerance.
        let mut lost = [0.0];
        assert_eq!(few(&sizes, &[3.0], &mut lost), [true, false, false, true, false]);
        assert_eq!(lost, [3.0]);
    }

    #[test]
    fn the_sum_of_which_an_order_takes_most_ranks_it() {
        // Half of the second sum's tolerance ranks after a third of the first's.
        let sizes = [[1.0, 0.05], [0.1, 0.1], [2.5, 0.0]];
        let mut lost = [0.0; 2];
        assert_eq!(few(&sizes, &[3.0, 0.2], &mut lost), [false, false, true]);
        let mut lost = [0.0, 0.08];
        // The second order no longer fits, the third does.
        assert_eq!(few(&sizes, &[4.0, 0.2], &mut lost), [false, true, false]);
        assert_eq!(lost, [3.5, 0.13]);
    }

    #[test]
    fn orders_of_no_size_are_dropped_whatever_is_lost_already() {
        let mut lost = [1.0, 0.0];
        assert_eq!(
            few(&[[0.0, 0.0], [1e-9, 0.0], [0.0, 0.5]], &[0.0, 1.0], &mut lost),
            [false, true, false]
        );
        assert_eq!(lost, [1.0, 0.5]);
        assert!(few(&[[0.0]; 0], &[1.0], &mut [0.0]).is_empty());
    }

    /// Looks for the smallest order left, again and again.
    fn plainly(sizes: &[[f64; 3]], allowed: [f64; 3], lost: &mut [f64; 3]) -> Vec<bool> {
        let (mut kept, mut tried) = (vec![true; sizes.len()], vec![false; sizes.len()]);
        let share = |k: usize| -> f64 {
            let mut largest = 0.0;
            for sum in 0..3 {
                if sizes[k][sum] > 0.0 && sizes[k][sum] / allowed[sum] > largest {
                    largest = sizes[k][sum] / allowed[sum];
                }
            }
            largest
        };
        while let Some(first) = tried.iter().position(|tried| !tried) {
            let mut smallest = first;
            for (k, tried) in tried.iter().enumerate().skip(first + 1) {
                if !tried && share(k) < share(smallest) {
                    smallest = k;
                }
            }
            tried[smallest] = true;
            let size = sizes[smallest];
            let fits = |sum: usize| size[sum] == 0.0 || lost[sum] + size[sum] <= allowed[sum];
            if (0..3).all(fits) {
                (0..3).for_each(|sum| lost[sum] += size[sum]);
                kept[smallest] = false;
            }
        }
        kept
    }

    fn sizes() -> impl Strategy<Value = [f64; 3]> {
        let size = prop_oneof![
            select(vec![0.0, 0.0, 1.0, 2.0, 0.5]),
            (-9.0..1.0_f64).prop_map(|digits| 10_f64.powf(digits)),
        ];
        [size.clone(), size.clone(), size]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]

        #[test]
        fn few_orders_are_those_of_a_plain_search(
            sizes in proptest::collection::vec(sizes(), 0..12),
            allowed in [0.01..8.0, 0.01..8.0, 0.01..8.0],
            before in [0.0..0.02, 0.0..0.02, 0.0..0.02],
        ) {
            let (mut lost, mut expected) = (before, before);
            let kept = few(&sizes, &allowed, &mut lost);
            prop_assert_eq!(&kept, &plainly(&sizes, allowed, &mut expected));
            prop_assert_eq!(lost, expected);
            for sum in 0..3 {
                // More is lost than allowed only where it was before.
                prop_assert!(lost[sum] <= allowed[sum].max(before[sum]));
            }
            // None of those kept would fit as well.
            for (size, _) in sizes.iter().zip(&kept).filter(|(_, kept)| **kept) {
                prop_assert!((0..3).any(|sum| lost[sum] + size[sum] > allowed[sum]));
            }
        }
    }
}
