//! A few orders that reach a tolerance, and the bound of what they leave out.
//!
//! What is left out is at most the sum of the sizes of its orders, |forward| + |backward| after the
//! layout's cancellations. Orders are evaluated up to where all above them are negligible, and that
//! rest is bounded in closed form; so the bound is loose only where the orders left out do not peak
//! together.

use crate::engine::Engine;
use crate::engine::layout::Strokes;
use crate::gear::{Gear, GearKind, harmonics};
use crate::load::{Loads, Source};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::pressure::GasTorque;
use crate::readings::amplitude::wrenches;
use crate::wrench::Wrench;

/// Orders above the last one evaluated add less than this part of the tolerance.
const NEGLIGIBLE: f64 = 0.01;

/// Part of the largest torque of pressure on a cylinder that orders may leave out, at least: those of
/// pressure decline slowly.
const LEAST_OF_GAS: f64 = 1e-3;
/// Highest order of the torque of pressure that is evaluated; that of a cycle in which it jumps declines
/// like 1/n.
const HIGHEST_OF_GAS: u32 = 192;

/// Order up to which the torque of pressure is integrated first; then to four times it, as far as
/// [`HIGHEST_OF_GAS`].
pub(crate) const FIRST_OF_GAS: u32 = 48;

/// Orders chosen for an engine, those of inertia over ω² so that they serve any speed.
pub(crate) struct Chosen {
    /// Orders kept, ascending.
    pub orders: Vec<Order>,
    /// Their wrenches, those of inertia over ω².
    pub wrenches: Vec<Wrench>,
    /// Mean torques of pressure on the block and on the crank.
    pub mean: [f64; 2],
    /// Orders left out that are not zero.
    pub omitted: Vec<Order>,
    /// Bounds of what all orders left out add: over ω² to force, moment and torque of inertia, and to
    /// the torque of pressure.
    pub error_bound: [f64; 4],
}

/// The orders of an engine that leave out at most `rtol`.
pub(crate) fn within(
    rtol: f64,
    engine: &Engine,
    loads: &Loads,
    torque: bool,
    cancel: &Cancel,
) -> Result<Chosen> {
    let rtol = limits::tolerance(rtol)?;
    let scales = scales(engine, loads);
    let mut orders = candidates(rtol, &scales, loads, &loads.gears, torque)?;
    let [force, moment, inertia] = tail(loads, orders.last(), torque, &loads.gears);
    let mut gas = GasOrders::default();
    if torque {
        // As far as the others at once, which have a part of gas too.
        let last = orders.last().map_or(0, |order| order.halves().div_ceil(2));
        let highest = last.clamp(FIRST_OF_GAS, HIGHEST_OF_GAS);
        gas = GasOrders::new(rtol, loads, &loads.gears, highest, cancel)?;
        orders.extend(&gas.orders);
        orders.sort_unstable();
        orders.dedup();
    }
    let (all, mean) = wrenches(loads, torque, &orders, &gas.torques, cancel)?;
    let sizes: Vec<[f64; 4]> = all.iter().map(sizes).collect();
    let mut error_bound = [force, moment, inertia, gas.tail];
    let [force, moment, torque] = scales.map(|scale| rtol * scale);
    let kept = few(&sizes, &[force, moment, torque, gas.allowed], &mut error_bound);
    let mut chosen =
        Chosen { orders: vec![], wrenches: vec![], mean, omitted: vec![], error_bound };
    for (((order, wrench), size), kept) in orders.into_iter().zip(all).zip(sizes).zip(kept) {
        if kept {
            chosen.orders.push(order);
            memory::push(&mut chosen.wrenches, wrench)?;
        } else if size.iter().any(|&size| size > 0.0) {
            chosen.omitted.push(order);
        }
    }
    Ok(chosen)
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

/// Largest rod inertia of a gear over what a tolerance of torque is relative to.
fn rod_share(loads: &Loads, gear: usize, scales: &[f64; 3]) -> f64 {
    let largest = loads.largest_rod_inertia(gear);
    if largest == 0.0 { 0.0 } else { largest / scales[2] }
}

/// Orders to evaluate, ascending.
///
/// What higher orders add is at most [`NEGLIGIBLE`] times the tolerance, or, if no order achieves
/// that, at most a quarter of it. `gears` are those of the loads, at the point of a sweep where their
/// harmonics decrease most slowly.
pub(crate) fn candidates(
    rtol: f64,
    scales: &[f64; 3],
    loads: &Loads,
    gears: &[Gear],
    torque: bool,
) -> Result<Vec<Order>> {
    let count = loads.list.len() as f64;
    let (needed, enough) = (0.25 * rtol / count, NEGLIGIBLE * rtol / count);
    let mut orders = loads.unbalance_orders();
    for (k, gear) in gears.iter().enumerate() {
        let ratio = gear.ratio.unsigned_abs();
        let own = match &gear.kind {
            GearKind::Given(spectrum) => spectrum.orders(),
            GearKind::SliderCrank { proportions, .. } => {
                let torque = torque.then(|| rod_share(loads, k, scales));
                let last = match harmonics::highest_order(proportions, enough, torque) {
                    Some(order) => order,
                    // A rest that is not negligible still is within the tolerance.
                    None if harmonics::highest_order(proportions, needed, torque).is_some() => {
                        limits::HIGHEST_ORDER
                    }
                    None => {
                        let hint = format!(
                            "too many orders would be needed at a rod ratio of {:?}; ask for exact \
                             kinematics or a larger rtol",
                            1.0 / proportions.rod
                        );
                        return Err(Error::figure("rtol", rtol, hint));
                    }
                };
                (1..=last).collect()
            }
        };
        let whole: Vec<u32> =
            own.into_iter().map(|n| n * ratio).filter(|&n| n <= limits::HIGHEST_ORDER).collect();
        orders.extend(Order::all_whole(&whole)?);
    }
    orders.sort_unstable();
    orders.dedup();
    Ok(orders)
}

/// Bounds over ω² of what orders above the last one evaluated add to force, moment and torque, as if
/// nothing cancelled, with these gears in place of those of the loads.
pub(crate) fn tail(loads: &Loads, last: Option<&Order>, torque: bool, gears: &[Gear]) -> [f64; 3] {
    let last = last.map_or(0, |order| order.halves() / 2);
    let bounds: Vec<[f64; 3]> = gears.iter().map(|gear| gear.tail(last, torque)).collect();
    let mut sum = [0.0; 3];
    for load in &loads.list {
        let Source::Piston { gear, second_moment, rod_inertia } = load.source else { continue };
        let [force, masses, rod] = bounds[gear];
        let square = f64::from(load.ratio * load.ratio);
        let force = times(load.weight.abs(), force) * square;
        sum[0] += force;
        sum[1] += times((load.z - loads.reference).abs(), force);
        if torque {
            let own = times(second_moment, masses) + times(rod_inertia.abs(), rod);
            sum[2] += own * square * f64::from(load.ratio.abs()) + times(load.axis.norm(), force);
        }
    }
    sum
}

/// Zero times infinity is zero.
pub(crate) fn times(weight: f64, bound: f64) -> f64 {
    if weight == 0.0 { 0.0 } else { weight * bound }
}

/// What a tolerance is relative to, over ω²: for force the largest m·r of a cylinder, amplitude of
/// its spectrum or unbalance; for moment that times the longest lever of a load that has weight; for
/// torque the largest m·r² or unbalance times crank radius or its shaft's distance from the crank.
/// Where rod inertia makes more of order 1, what it makes: about J·r/l.
pub(crate) fn scales(engine: &Engine, loads: &Loads) -> [f64; 3] {
    let [mut force, mut lever, mut torque] = [0.0_f64; 3];
    for load in &loads.list {
        let square = f64::from(load.ratio * load.ratio);
        let (of_load, of_torque) = match load.source {
            Source::Piston { gear, second_moment, rod_inertia } => match &loads.gears[gear].kind {
                GearKind::SliderCrank { proportions, .. } => {
                    (load.weight.abs(), second_moment.max(rod_inertia.abs() / proportions.rod))
                }
                GearKind::Given(spectrum) => (spectrum.largest(), 0.0),
            },
            Source::Pressure { .. } => continue,
            Source::Unbalance => {
                let arm = engine.largest_crank_radius().max(load.axis.norm());
                (load.weight.abs(), load.weight.abs() * arm)
            }
        };
        force = force.max(square * of_load);
        torque = torque.max(square * of_torque);
        if of_load > 0.0 {
            lever = lever.max((load.z - loads.reference).abs());
        }
    }
    [force, force * lever, torque]
}

/// Sizes of force, moment and the larger torques of inertia and of pressure.
fn sizes(wrench: &Wrench) -> [f64; 4] {
    let Wrench { force, moment, inertia, gas } = wrench;
    [force.peak(), moment.peak(), inertia.peak(), gas.peak()]
}

/// Orders of the torque of pressure to evaluate.
#[derive(Default)]
pub(crate) struct GasOrders {
    /// Up to where the rest is a quarter of what may be left out, or to the highest.
    pub orders: Vec<Order>,
    /// Bound of the sum of those above.
    pub tail: f64,
    /// What may be left out, N·m.
    pub allowed: f64,
    /// Harmonics ½, 1, 1½ … of each gear that has pressure.
    pub torques: Vec<Option<GasTorque>>,
}

impl GasOrders {
    /// Of an engine; what may be left out is this part of the largest torque of a cylinder, or
    /// [`LEAST_OF_GAS`]. Orders up to `highest` are looked at before any above.
    /// `gears` are those of the loads, at the point of a sweep where their harmonics decrease most
    /// slowly.
    pub fn new(
        rtol: f64,
        loads: &Loads,
        gears: &[Gear],
        mut highest: u32,
        cancel: &Cancel,
    ) -> Result<Self> {
        let (volumes, mut largest, mut step) = (loads.volumes(), 0.0_f64, 2);
        for load in &loads.list {
            let Source::Pressure { gear: k } = load.source else { continue };
            let Some(of_cylinder) = gears[k].largest_gas() else { continue };
            largest = largest.max(load.weight.abs() * of_cylinder);
            if gears[k].pressure.as_ref().is_some_and(|p| p.cycle.strokes() == Strokes::Four) {
                step = 1;
            }
        }
        let allowed = rtol.max(LEAST_OF_GAS) * largest;
        if allowed == 0.0 {
            return Ok(Self::default());
        }
        loop {
            let mut tails = vec![0.0; 2 * highest as usize];
            let mut torques = Vec::new();
            for (gear, weight) in gears.iter().zip(&volumes) {
                let found = gear.gas_up_to(Order::whole(highest)?, cancel)?;
                torques.push(found.map(|(torque, of_gear)| {
                    let own = of_gear.into_iter().map(|tail| times(weight.size, tail));
                    tails.iter_mut().zip(own).for_each(|(sum, tail)| *sum += tail);
                    torque
                }));
            }
            let enough = tails.iter().position(|&tail| tail <= 0.25 * allowed);
            let Some(last) = enough.or((highest == HIGHEST_OF_GAS).then_some(tails.len() - 1))
            else {
                highest = HIGHEST_OF_GAS.min(4 * highest);
                continue;
            };
            let halves = (1..=last as u32 + 1).filter(|halves| halves % step == 0);
            let orders = halves.map(Order::from_halves).collect::<Result<_>>()?;
            return Ok(Self { orders, tail: tails[last], allowed, torques });
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::*;
    use crate::engine::Station;
    use crate::gear::slider_crank::Cylinder;
    use crate::numbers::angle::Angle;

    #[test]
    fn a_rod_counts_by_its_inertia_over_what_a_tolerance_is_relative_to() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let place = |inertia: f64| Station {
            cylinder: cylinder.with_rod_inertia_excess(inertia).unwrap(),
            tdc: Angle::ZERO,
            bank: Angle::ZERO,
            z: 0.0,
            rotating_mass: 0.0,
        };
        let share = |inertias: [f64; 2], motion: usize| {
            let engine = Engine::new("", "", inertias.map(place).to_vec()).unwrap();
            let loads = Loads::new(&engine, 0.0);
            rod_share(&loads, motion, &[1.0, 1.0, 4.0])
        };
        assert_eq!(share([0.0, 0.0], 0), 0.0);
        assert_eq!(share([0.002, -0.008], 0), 0.002);
        assert_eq!(share([0.002, -0.008], 1), 0.0);
    }

    #[test]
    fn loads_that_act_the_other_way_are_bounded_alike() {
        let engine = crate::load::tests::fired([Some(0); 3]).0;
        let ahead = Loads::new(&engine, 0.0);
        let mut opposite = Loads::new(&engine, 0.0);
        opposite.list.iter_mut().for_each(|load| load.weight *= -1.0);
        let last = Order::whole(4).unwrap();
        let bounds = |loads: &Loads| {
            let gas = GasOrders::new(0.1, loads, &loads.gears, FIRST_OF_GAS, &Cancel::new());
            let gas = gas.unwrap();
            let inertia = tail(loads, Some(&last), true, &loads.gears);
            (inertia, scales(&engine, loads), gas.tail, gas.allowed)
        };
        let found = bounds(&opposite);
        assert_eq!(bounds(&ahead), found);
        assert!(found.0.iter().all(|&bound| bound > 0.0) && found.2 > 0.0 && found.3 > 0.0);
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
