//! A few orders that reach a tolerance, and the bound of what they leave out: of balances and of sweeps.
//!
//! What is left out is at most the sum of the sizes of its orders, |forward| + |backward| after the
//! layout's cancellations. Orders are evaluated up to where all above them are negligible, and that
//! rest is bounded in closed form; so the bound is loose only where the orders left out do not peak
//! together.

use std::sync::Arc;

use crate::engine::{Engine, Origin};
use crate::load::source::{Repeats, Scale, Scaling, Source, Tail};
use crate::load::{LargestWeights, Load, LoadList, Sources, count};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::readings::amplitude::wrenches;
use crate::readings::balance::ErrorBounds;
use crate::wrench::Wrench;

/// Orders above the last one evaluated add less than this part of the tolerance.
const NEGLIGIBLE_REST: f64 = 0.01;

/// Part of the largest torque of pressure on a cylinder that orders may leave out, at least: those of
/// pressure decline slowly.
const LEAST_OF_GAS: f64 = 1e-3;
/// Highest order of the torque of pressure that is evaluated; that of a cycle in which it jumps declines
/// like 1/n.
const HIGHEST_OF_GAS: u32 = 192;

/// Order up to which the torque of pressure is integrated first; then to four times it, as far as
/// [`HIGHEST_OF_GAS`].
const FIRST_OF_GAS: u32 = 48;

/// Orders chosen for an engine, those of inertia over ω² so that they serve any speed.
pub(crate) struct Chosen {
    /// Orders kept, ascending.
    pub orders: Vec<Order>,
    /// Their wrenches, those of inertia over ω².
    pub wrenches: Vec<Wrench>,
    /// Mean torques of pressure on the block and on the crank.
    pub mean: [f64; 2],
    /// Orders evaluated and left out, and their wrenches.
    pub left: Vec<(Order, Wrench)>,
    /// Bounds of what all orders left out add.
    pub left_out: OrderSums,
}

/// What orders add, or may leave out: those of inertia over ω².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct OrderSums {
    pub force: f64,
    pub moment: f64,
    /// Torque of inertia, on the block or on the crank.
    pub inertia: f64,
    /// Torque of pressure.
    pub gas: f64,
}

impl OrderSums {
    /// What an order adds at most.
    pub fn of(wrench: &Wrench) -> Self {
        let Wrench { force, moment, inertia, gas } = wrench;
        Self {
            force: force.peak(),
            moment: moment.peak(),
            inertia: inertia.peak(),
            gas: gas.peak(),
        }
    }

    /// Side by side.
    fn values(self) -> [f64; 4] {
        [self.force, self.moment, self.inertia, self.gas]
    }

    fn from_values([force, moment, inertia, gas]: [f64; 4]) -> Self {
        Self { force, moment, inertia, gas }
    }

    /// The larger of both, sum by sum.
    pub fn max(self, other: Self) -> Self {
        let mut largest = self.values();
        largest.iter_mut().zip(other.values()).for_each(|(a, b)| *a = a.max(b));
        Self::from_values(largest)
    }

    /// All times a tolerance.
    fn scaled(self, rtol: f64) -> Self {
        Self::from_values(self.values().map(|value| rtol * value))
    }

    /// Bounds at a square of speed.
    pub fn bounds(self, square: f64) -> ErrorBounds {
        ErrorBounds {
            force: self.force * square,
            moment: self.moment * square,
            torque: self.inertia * square + self.gas,
        }
    }
}

/// An engine whose orders are chosen: its loads, and their sources where harmonics decrease most slowly.
pub(crate) struct Candidate<'a> {
    pub engine: &'a Engine,
    pub loads: &'a LoadList,
    pub sources: Sources,
    /// Whether it is the one before it with other cycles.
    pub repeats: bool,
}

/// The choice of a few orders for some engines, whose sizes are still to be evaluated.
pub(crate) struct Choice {
    /// Orders to evaluate, ascending.
    pub orders: Vec<Order>,
    /// Orders of the torque of pressure, of each engine.
    pub gas: Vec<GasOrders>,
    /// Bounds of what orders above those add, of each engine.
    pub rest: Vec<OrderSums>,
    /// What may be left out, of each engine.
    allowed: Vec<OrderSums>,
}

impl Choice {
    /// Among the orders that leave out at most `rtol`.
    pub fn new(rtol: f64, candidates: &[Candidate], torque: bool, cancel: &Cancel) -> Result<Self> {
        let rtol = limits::tolerance(rtol)?;
        let (mut orders, mut allowed) = (Vec::new(), Vec::new());
        for Candidate { engine, loads, sources, repeats } in candidates {
            cancel.check()?;
            let scales = scales(engine, loads);
            if !repeats {
                orders.extend(self::candidates(rtol, &scales, loads, sources, torque)?);
            }
            allowed.push(scales.scaled(rtol));
        }
        orders.sort_unstable();
        orders.dedup();
        // As far as the others at once, which have a part of gas too.
        let last = orders.last().map_or(0, |order| order.halves().div_ceil(2));
        let highest = last.clamp(FIRST_OF_GAS, HIGHEST_OF_GAS);
        let (mut of_gas, mut rest, mut all) = (Vec::new(), Vec::new(), orders.clone());
        for (Candidate { loads, sources, repeats, .. }, allowed) in
            candidates.iter().zip(&mut allowed)
        {
            let inertia = match rest.last() {
                Some(&before) if *repeats => before,
                _ => tail(loads, &orders, torque, sources),
            };
            let gas = if torque {
                GasOrders::new(rtol, loads, sources, highest, cancel)?
            } else {
                GasOrders { sources: sources.clone(), ..GasOrders::default() }
            };
            rest.push(OrderSums { gas: gas.tail, ..inertia });
            allowed.gas = gas.allowed;
            all.extend(&gas.orders);
            of_gas.push(gas);
        }
        all.sort_unstable();
        all.dedup();
        Ok(Self { orders: all, gas: of_gas, rest, allowed })
    }

    /// Which orders are kept, of sizes of each order and engine, and bounds of what each engine leaves
    /// out.
    pub fn few(&self, sizes: &[Vec<OrderSums>]) -> (Vec<bool>, Vec<OrderSums>) {
        let side_by_side = |sums: &[OrderSums]| -> Vec<f64> {
            sums.iter().flat_map(|sums| sums.values()).collect()
        };
        let sizes: Vec<Vec<f64>> = sizes.iter().map(|sums| side_by_side(sums)).collect();
        let mut lost = side_by_side(&self.rest);
        let kept = few(&sizes, &side_by_side(&self.allowed), &mut lost);
        (kept, lost.as_chunks().0.iter().map(|&lost| OrderSums::from_values(lost)).collect())
    }
}

/// The orders of an engine that leave out at most `rtol`.
pub(crate) fn within(
    rtol: f64,
    engine: &Engine,
    loads: &LoadList,
    torque: bool,
    cancel: &Cancel,
) -> Result<Chosen> {
    let alone = Candidate { engine, loads, sources: loads.sources.clone(), repeats: false };
    let choice = Choice::new(rtol, &[alone], torque, cancel)?;
    let (all, mean) = wrenches(loads, &choice.gas[0].sources, torque, &choice.orders, cancel)?;
    let sizes: Vec<_> = all.iter().map(|wrench| vec![OrderSums::of(wrench)]).collect();
    let (kept, left_out) = choice.few(&sizes);
    let mut chosen =
        Chosen { orders: vec![], wrenches: vec![], mean, left: vec![], left_out: left_out[0] };
    for ((order, wrench), kept) in choice.orders.into_iter().zip(all).zip(kept) {
        if kept {
            chosen.orders.push(order);
            memory::push(&mut chosen.wrenches, wrench)?;
        } else {
            memory::push(&mut chosen.left, (order, wrench))?;
        }
    }
    Ok(chosen)
}

/// Orders of which each cylinder alone leaves out at most `rtol`, as if nothing cancelled, with those of
/// shafts and counterweights; and bounds of what all cylinders leave out, over ω². Without pressure.
pub(crate) fn within_each(
    rtol: f64,
    engine: &Engine,
    loads: &LoadList,
    torque: bool,
    cancel: &Cancel,
) -> Result<(Vec<Order>, OrderSums)> {
    let (turning, others): (Vec<Load>, Vec<Load>) = loads
        .list
        .iter()
        .filter(|load| load.parts.scaling == Scaling::SpeedSquared)
        .partition(|load| load.is_turning());
    let mut orders = turning
        .iter()
        .map(|load| Order::whole(load.place.ratio.unsigned_abs()))
        .collect::<Result<Vec<_>>>()?;
    let mut left_out = OrderSums::default().values();
    for cylinder in 0..engine.stations().len() {
        let own = others.iter().filter(|load| load.place.origin == Origin::Cylinder(cylinder));
        let list = own.copied().collect();
        let alone = LoadList { list, sources: loads.sources.clone(), ..*loads };
        let chosen = within(rtol, engine, &alone, torque, cancel)?;
        orders.extend(chosen.orders);
        let lost = chosen.left_out.values();
        left_out.iter_mut().zip(lost).for_each(|(sum, lost)| *sum += lost);
    }
    orders.sort_unstable();
    orders.dedup();
    Ok((orders, OrderSums::from_values(left_out)))
}

/// Drops orders from the smallest up while every sum stays within what it may lose.
///
/// `lost` holds what each sum has lost already and is given what it loses. Returns which orders are
/// kept. A size counts relative to what its sum may lose, and the largest of an order's decides.
fn few<S: AsRef<[f64]>>(sizes: &[S], allowed: &[f64], lost: &mut [f64]) -> Vec<bool> {
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

/// Orders to evaluate, ascending.
///
/// What higher orders add is at most [`NEGLIGIBLE_REST`] times the tolerance, or, if no order achieves
/// that, at most a quarter of it. `sources` are those of the loads, at the point of a sweep where their
/// harmonics decrease most slowly.
fn candidates(
    rtol: f64,
    scales: &OrderSums,
    loads: &LoadList,
    sources: &Sources,
    torque: bool,
) -> Result<Vec<Order>> {
    let count = count(&loads.list, torque) as f64;
    let (needed, enough) = (0.25 * rtol / count, NEGLIGIBLE_REST * rtol / count);
    let mut orders = Vec::new();
    for (k, source) in sources.indices().zip(sources) {
        if source.parts().scaling == Scaling::Given {
            continue;
        }
        // What a weight is over that which the tolerance is relative to.
        let LargestWeights { force, arm, roll } = loads.largest_weights(k);
        let share = |weight: f64, scale: f64| if weight == 0.0 { 0.0 } else { weight / scale };
        let (force, arm) = (share(force, scales.force), share(arm, scales.inertia));
        let roll = share(roll, scales.inertia);
        let within = |highest: u32, tolerance: f64| {
            let beyond = source.beyond(highest, torque && roll > 0.0);
            let of_torque = times(roll, beyond.torque) + times(arm, beyond.force);
            times(force, beyond.force) <= tolerance && (!torque || of_torque <= tolerance)
        };
        let highest = match lowest(|highest| within(highest, enough)) {
            Some(order) => order,
            // A rest that is not negligible still is within the tolerance.
            None if within(limits::HIGHEST_ORDER, needed) => limits::HIGHEST_ORDER,
            None => {
                let ratio = source.mechanism().map_or(0.0, |of| 1.0 / of.proportions.rod);
                let hint = format!(
                    "too many orders would be needed at a rod ratio of {ratio:?}; ask for exact \
                     kinematics or a larger rtol"
                );
                return Err(Error::figure("rtol", rtol, hint));
            }
        };
        let mut own = source.orders(highest);
        own.retain(|&order| order <= limits::HIGHEST_ORDER);
        orders.extend(Order::all_whole(&own)?);
    }
    orders.sort_unstable();
    orders.dedup();
    Ok(orders)
}

/// Lowest order from 1 on that is enough, as all above it are; none if the highest is not.
fn lowest(is_enough: impl Fn(u32) -> bool) -> Option<u32> {
    // Mostly it is low: doubling asks less often than halving what there is.
    let (mut low, mut high) = (1, 1);
    while !is_enough(high) {
        if high == limits::HIGHEST_ORDER {
            return None;
        }
        (low, high) = (high + 1, limits::HIGHEST_ORDER.min(2 * high));
    }
    while low < high {
        let middle = u32::midpoint(low, high);
        if is_enough(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    Some(high)
}

/// Bounds over ω² of what orders beyond those evaluated add to force, moment and torque, as if nothing
/// cancelled, with these sources in place of those of the loads.
fn tail(loads: &LoadList, evaluated: &[Order], torque: bool, sources: &Sources) -> OrderSums {
    let last = evaluated.last().map_or(0, |order| order.halves() / 2);
    // Another source may have the last order: those from the first one missing on are left out.
    let is_missing =
        |own: &u32| evaluated.binary_search_by_key(&(2 * own), |order| order.halves()).is_err();
    let inertia = |source: &Arc<dyn Source>| match source.parts().scaling {
        Scaling::SpeedSquared => {
            let missing = source.orders(last).into_iter().filter(is_missing).min();
            source.beyond(missing.map_or(last, |order| order - 1), torque)
        }
        Scaling::Given => Tail::default(),
    };
    let beyond = sources.map_to(inertia);
    let mut sum = OrderSums::default();
    for load in &loads.list {
        let (place, beyond) = (&load.place, beyond[load.source]);
        let square = f64::from(place.speed_squared());
        let force = times(load.weight.abs(), beyond.force) * square;
        sum.force += force;
        sum.moment += times(place.lever(loads.reference).abs(), force);
        if torque {
            sum.inertia +=
                times(load.roll.abs(), beyond.torque) * square + times(place.axis.norm(), force);
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
fn scales(engine: &Engine, loads: &LoadList) -> OrderSums {
    let [mut force, mut lever, mut torque] = [0.0_f64; 3];
    for load in &loads.list {
        let place = &load.place;
        let Scale { force: of_force, torque: of_torque } = loads.source(load).scale();
        let own = load.weight.abs() * of_force;
        let arm = || engine.largest_crank_radius().max(place.axis.norm());
        let of_torque = of_torque.map_or_else(|| own * arm(), |scale| load.roll.abs() * scale);
        let square = f64::from(place.speed_squared());
        force = force.max(square * own);
        torque = torque.max(square * of_torque);
        if own > 0.0 {
            lever = lever.max(place.lever(loads.reference).abs());
        }
    }
    OrderSums { force, moment: force * lever, inertia: torque, gas: 0.0 }
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
    /// The sources, which keep their harmonics that were evaluated.
    pub sources: Sources,
}

impl GasOrders {
    /// Of an engine; what may be left out is this part of the largest torque of a cylinder, or
    /// [`LEAST_OF_GAS`]. Orders up to `highest` are looked at before any above.
    /// `sources` are those of the loads, at the point of a sweep where their harmonics decrease most
    /// slowly.
    pub fn new(
        rtol: f64,
        loads: &LoadList,
        sources: &Sources,
        mut highest: u32,
        cancel: &Cancel,
    ) -> Result<Self> {
        let (volumes, mut largest, mut step) = (loads.volumes(), 0.0_f64, 2);
        let largest_of = sources.map_to(|source| source.largest_torque());
        for load in loads.list.iter().filter(|load| load.parts.scaling == Scaling::Given) {
            largest = largest.max(load.roll.abs() * largest_of[load.source]);
            if load.parts.repeats == Repeats::EveryTwoTurns {
                step = 1;
            }
        }
        let allowed = rtol.max(LEAST_OF_GAS) * largest;
        if allowed == 0.0 {
            return Ok(Self { sources: sources.clone(), ..Self::default() });
        }
        loop {
            let mut tails = vec![0.0; 2 * highest as usize];
            let mut known = Sources::default();
            for (source, weight) in sources.iter().zip(&volumes) {
                let up_to = source.up_to(Order::whole(highest)?, cancel)?;
                known.push(up_to.map_or_else(
                    || Arc::clone(source),
                    |(known, of_source)| {
                        let own = of_source.into_iter().map(|tail| times(weight.size, tail));
                        tails.iter_mut().zip(own).for_each(|(sum, tail)| *sum += tail);
                        known
                    },
                ));
            }
            let enough = tails.iter().position(|&tail| tail <= 0.25 * allowed);
            let Some(last) = enough.or((highest == HIGHEST_OF_GAS).then_some(tails.len() - 1))
            else {
                highest = HIGHEST_OF_GAS.min(4 * highest);
                continue;
            };
            let halves = (1..=last as u32 + 1).filter(|halves| halves % step == 0);
            let orders = halves.map(Order::from_halves).collect::<Result<_>>()?;
            return Ok(Self { orders, tail: tails[last], allowed, sources: known });
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::*;
    use crate::engine::{Crank, Station};
    use crate::load::SourceIndex;
    use crate::mechanism::slider_crank::Cylinder;
    use crate::numbers::angle::Angle;
    use crate::numbers::index::ListIndex;

    #[test]
    fn the_lowest_order_that_is_enough_is_found() {
        for expected in [1, 2, 7, 100, limits::HIGHEST_ORDER] {
            assert_eq!(lowest(|order| order >= expected), Some(expected));
        }
        assert_eq!(lowest(|_| false), None);
    }

    #[test]
    fn a_rod_counts_by_its_inertia_over_what_a_tolerance_is_relative_to() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let highest = |inertia: f64| {
            let place = Station {
                cylinder: cylinder.with_rod_inertia_excess(inertia).unwrap(),
                tdc: Angle::ZERO,
                bank: Angle::ZERO,
                z: 0.0,
                rotating_mass: 0.0,
            };
            let engine = Engine::new("", "", vec![place]).unwrap();
            let loads = LoadList::new(&engine, 0.0);
            // Against a scale of its own a heavier rod takes more orders.
            let scales = OrderSums { force: 1e9, moment: 1e9, inertia: 4.0, gas: 0.0 };
            let orders = candidates(1e-6, &scales, &loads, &loads.sources, true).unwrap();
            let highest = *orders.last().unwrap();
            for (order, enough) in [(highest.halves() / 2, true), (highest.halves() / 2 - 1, false)]
            {
                let beyond = loads.sources[SourceIndex::new(1)].beyond(order, true).torque
                    * inertia.abs()
                    / 4.0;
                assert_eq!(beyond <= NEGLIGIBLE_REST * 1e-6 / 2.0, enough, "{inertia} {order}");
            }
            highest
        };
        assert!(highest(0.5) < highest(-40.0));
    }

    #[test]
    fn loads_that_act_the_other_way_are_bounded_alike() {
        let engine = crate::load::tests::fired([Some(0); 3]).0;
        let ahead = LoadList::new(&engine, 0.0);
        let mut opposite = LoadList::new(&engine, 0.0);
        opposite.list.iter_mut().for_each(|load| {
            load.weight *= -1.0;
            load.roll *= -1.0;
        });
        let evaluated = Order::all_whole(&[1, 2, 3, 4]).unwrap();
        let bounds = |loads: &LoadList| {
            let gas = GasOrders::new(0.1, loads, &loads.sources, FIRST_OF_GAS, &Cancel::new());
            let gas = gas.unwrap();
            let inertia = tail(loads, &evaluated, true, &loads.sources);
            (inertia, scales(&engine, loads), gas.tail, gas.allowed)
        };
        let found = bounds(&opposite);
        assert_eq!(bounds(&ahead), found);
        assert!(
            [found.0.force, found.0.moment, found.0.inertia].iter().all(|&bound| bound > 0.0)
                && found.2 > 0.0
                && found.3 > 0.0
        );
    }

    /// What is left out of a cylinder on a crank of any speed is what it would leave out on the main one by the
    /// squares of its speed, the torque by the cube, and that of its force at the distance of the axis.
    #[test]
    fn the_rest_of_a_crank_is_that_of_the_main_one_by_its_speed() {
        let rest = |cylinder: Cylinder, crank: Crank, orders: &[u32]| {
            let (tdc, bank) = (Angle::ZERO, Angle::HALF_TURN);
            let place = Station { cylinder, tdc, bank, z: 0.3, rotating_mass: 0.4 };
            let engine = Engine::new("", "", vec![place]).unwrap();
            let engine = engine.with_cranks(vec![Crank::MAIN, crank], vec![1]).unwrap();
            let loads = LoadList::new(&engine, 0.1);
            tail(&loads, &Order::all_whole(orders).unwrap(), true, &loads.sources)
        };
        let parts = [(0.5, 0.0, 0.0), (0.5, 0.01, 0.0), (0.0, 0.0, 1e-3), (0.5, 0.01, -1e-3)];
        for (ratio, (mass, offset, inertia)) in
            [1, -1, 2, -2, 3, -3].into_iter().flat_map(|ratio: i32| parts.map(|own| (ratio, own)))
        {
            let cylinder = Cylinder::new(0.05, 0.15, mass, offset).unwrap();
            let cylinder = cylinder.with_rod_inertia_excess(inertia).unwrap();
            let on_main = rest(cylinder, Crank { axis: [0.0; 2], ..Crank::MAIN }, &[1, 2, 3]);
            assert!(on_main.inertia > 0.0);
            let speed = ratio.unsigned_abs();
            // Another load has an order above those of the cylinder, one of which is missing.
            let own = [1, 2, 3, 5].map(|own| own * speed);
            let found = rest(cylinder, Crank { axis: [-0.3, 0.4], ratio }, &own);
            let square = f64::from(speed * speed);
            let force = square * on_main.force;
            let inertia = square * f64::from(speed) * on_main.inertia + 0.5 * force;
            let expected = OrderSums { force, moment: 0.2 * force, inertia, gas: 0.0 };
            for (found, expected) in found.values().into_iter().zip(expected.values()) {
                assert!((found - expected).abs() <= 1e-14 * expected, "{found} {expected}");
            }
        }
    }

    #[test]
    fn bounds_of_loads_add_up() {
        let engine = crate::load::tests::fired([Some(0); 3]).0;
        let once = LoadList::new(&engine, 0.0);
        let mut twice = LoadList::new(&engine, 0.0);
        twice.list = once.list.iter().chain(&once.list).copied().collect();
        let evaluated = Order::all_whole(&[1, 2, 3, 4]).unwrap();
        let rest = |loads: &LoadList| tail(loads, &evaluated, true, &loads.sources).values();
        for (one, both) in rest(&once).into_iter().zip(rest(&twice)) {
            assert!((both - 2.0 * one).abs() <= 1e-14 * one, "{both} {one}");
        }
        for (one, both) in once.volumes().iter().zip(&twice.volumes()) {
            assert!((both.size - 2.0 * one.size).abs() <= 1e-14 * one.size);
            assert!((both.value - 2.0 * one.value).abs() <= 1e-14 * one.size);
        }
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
