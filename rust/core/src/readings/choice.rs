//! A few orders that reach a tolerance, and the bound of what they leave out: of an engine at one point, or of some
//! at all points of a sweep.
//!
//! What is left out is at most the sum of the sizes of its orders, |forward| + |backward| after the
//! layout's cancellations. Orders are evaluated up to where all above them are negligible, and that
//! rest is bounded in closed form; so the bound is loose only where the orders left out do not peak
//! together.
//!
//! At every bank angle an order is at most the sum of what each bank makes of it, and what belongs to none. Loads
//! whose amplitudes no axis varies are summed first, so that what they cancel stays cancelled; those of the others
//! count with a bound over the axes, |amplitude| at most, times the sum of their weights:
//!
//! - Force without offset: √(1 − λ² sin²θ) is a power series in λ² whose terms give each order one
//!   sign, so that every |aₙ| is largest at the largest λ.
//! - Torque of masses without offset: half the derivative of x′². Odd orders are differences of two
//!   neighbouring orders of h′, of opposite signs, which grow with λ. With q = p² order 2 is −½(1 + q²),
//!   order 2j above is ½(1 − q²)q^{j−1} up to factors of n, which grows up to q² = (j − 1)/(j + 1), or
//!   λ = 0.96 for order 4 and beyond that for others.
//! - Torque of rods without offset: φ' = λ cos θ/√(1 − λ² sin²θ) is a power series in λ whose terms give
//!   each order one sign; it makes the odd orders. The even ones are half the derivative of φ'², whose
//!   order 2j is 2qʲ(1 − q)/(1 + q), which grows up to j(1 − q²) = 2q, or λ = 0.91 for order 2 and beyond
//!   that for others.
//! - Any other: the bound of the tail that begins with the order, which grows with λ and with the
//!   magnitude of the offset from order 3 on for torques, and for forces if order 1 counts 1 more.
//!   Orders 1 and 2 of torques are kept where the layout has them.
//! - Torque of pressure: the largest of the points, each evaluated.

use std::borrow::Cow;
use std::sync::Arc;

use crate::load::{
    Group, GroupIndex, Harmonic, KnownSeries, LargestWeights, Load, Scene, SourceIndex, Sources,
    count, find_or_push,
};
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::{List, distinct};
use crate::numbers::limits;
use crate::numbers::order::{self, Order};
use crate::readings::amplitude::{Means, SourceAmplitudes};
use crate::readings::balance::{Balance, ErrorBounds, Orders};
use crate::source::{
    Column, Point, Scale, Series, Source, Tail, UpTo, amplitudes, at_point, series,
};
use crate::wrench::Wrench;

/// Orders above the last one evaluated add less than this part of the tolerance.
const NEGLIGIBLE_REST: f64 = 0.01;
/// Part of the tolerance that they may add where orders decline slowly, or where no order achieves less.
const LARGEST_REST: f64 = 0.25;

/// Largest number of given orders that are kept with an engine.
const MOST_ORDERS_KEPT: usize = 100;

/// Orders chosen for an engine, over what its groups scale with so that they serve any speed.
pub(crate) struct Chosen {
    /// Orders evaluated, ascending.
    orders: Vec<Order>,
    /// Which of them are kept.
    kept: Vec<bool>,
    /// Wrenches of each order and group.
    wrenches: Vec<Wrench>,
    /// Mean torques of each group on the block and on the crank.
    means: Means,
    /// Bounds of what all orders left out add, of each group.
    left_out: List<GroupIndex, ErrorBounds>,
}

impl Chosen {
    /// What the orders that are left out add at most at some speeds, rad/s.
    pub fn error_bound(&self, loads: &Scene, omegas: &[f64]) -> ErrorBounds {
        bounds(&self.left_out, &loads.groups, omegas)
    }

    /// Orders that are kept, and the wrenches of each group.
    pub fn kept(&self) -> impl Iterator<Item = (Order, &[Wrench])> {
        self.all().filter(|(_, kept, _)| *kept).map(|(order, _, wrenches)| (order, wrenches))
    }

    /// Orders that were evaluated and left out, of those that are not zero.
    pub fn omitted(&self) -> Vec<Order> {
        let left = self.all().filter(|(_, kept, of)| !kept && !of.iter().all(Wrench::is_zero));
        left.map(|(order, ..)| order).collect()
    }

    /// Orders that were evaluated, whether they are kept, and the wrenches of each group.
    fn all(&self) -> impl Iterator<Item = (Order, bool, &[Wrench])> {
        let all = self.orders.iter().zip(&self.kept).zip(self.wrenches.chunks(self.left_out.len()));
        all.map(|((order, kept), wrenches)| (*order, *kept, wrenches))
    }

    /// The balance at a speed, rad/s.
    pub fn at_speed(&self, loads: &Scene, omega: f64) -> Result<Balance> {
        let all = Balance::of(loads, self.orders.clone(), &self.wrenches, &self.means, omega)?;
        Ok(all.keep(&self.kept, self.error_bound(loads, &[omega])))
    }
}

/// Bounds of what groups leave out at some speeds, rad/s.
pub(crate) fn bounds(left_out: &[ErrorBounds], groups: &[Group], omegas: &[f64]) -> ErrorBounds {
    let at = |&omega: &f64| {
        let groups = left_out.iter().zip(groups);
        groups.fold(ErrorBounds::default(), |sum, (lost, group)| {
            sum.plus(lost.times(group.scaling.factor(omega)))
        })
    };
    omegas.iter().map(at).fold(ErrorBounds::default(), ErrorBounds::max)
}

/// An engine whose orders are chosen, at some points.
pub(crate) struct Candidate<'a> {
    pub loads: &'a Scene,
    /// Sources of its loads, of which tolerances are parts.
    pub own: Cow<'a, Sources>,
    /// The same where harmonics decrease most slowly.
    pub slowest: Cow<'a, Sources>,
    /// Number of points, and what each replaces of these.
    pub points: (usize, &'a dyn Fn(usize) -> Point<'static>),
    /// Whether its banks turn.
    pub by_bank: bool,
}

/// Loads that are summed before they are bounded: of each bank, and of what varies of each amplitude.
type Summand = ((Option<usize>, Option<Harmonic>), Vec<Load>);

/// Wrenches of each order and group, and means of each group.
type Summed = (Vec<Wrench>, Means);

/// A few orders for some engines.
pub(crate) struct Choice {
    /// Orders evaluated, ascending.
    pub orders: Vec<Order>,
    /// Which of them are kept, and which are zero.
    pub kept: Vec<bool>,
    pub is_zero: Vec<bool>,
    /// Bounds of what each engine leaves out, by group.
    pub left_out: Vec<List<GroupIndex, ErrorBounds>>,
    /// Wrenches and means of the last engine, of all of its loads that are summed before they are bounded.
    summed: Summed,
}

impl Choice {
    /// Among the orders that leave out at most `rtol` at any point of any engine.
    pub fn new(rtol: f64, candidates: &[Candidate], torque: bool, cancel: &Cancel) -> Result<Self> {
        let rtol = limits::tolerance(rtol)?;
        let (mut orders, mut series, mut allowed) = (Vec::new(), Vec::new(), Vec::new());
        for Candidate { loads, own, slowest, .. } in candidates {
            cancel.check()?;
            let scales = scales(loads, own, torque);
            let known = self::candidates(rtol, &scales, loads, slowest, torque, cancel)?;
            orders.extend(known.iter().flat_map(|series| &series.orders));
            series.push(known);
            allowed.extend(scales.iter().flat_map(|scale| scale.allowed(rtol)));
        }
        orders.sort_unstable();
        orders.dedup();
        let (mut lost, mut summed) = (Vec::new(), Default::default());
        // By order, engine and group.
        let mut sizes: Vec<Vec<f64>> = vec![Vec::new(); orders.len()];
        for (candidate, series) in candidates.iter().zip(&mut series) {
            cancel.check()?;
            let rest = candidate.rest(series, &orders, torque, cancel)?;
            lost.extend(rest.iter().flat_map(|sums| sums.values()));
            let own;
            (own, summed) = candidate.sizes(series, &orders, torque, cancel)?;
            for (all, own) in sizes.iter_mut().zip(own.chunks(candidate.loads.groups.len())) {
                all.extend(
                    own.iter().flat_map(|[force, moment, roll, crank]| {
                        [*force, *moment, roll.max(*crank)]
                    }),
                );
            }
        }
        let kept = few(&sizes, &allowed, &mut lost);
        let mut lost = lost.as_chunks().0.iter().map(|&lost| ErrorBounds::from(lost));
        let of = |candidate: &Candidate| lost.by_ref().take(candidate.loads.groups.len()).collect();
        let left_out = candidates.iter().map(of).collect();
        let is_zero = sizes.iter().map(|sizes| sizes.iter().all(|size| *size == 0.0)).collect();
        Ok(Self { orders, kept, is_zero, left_out, summed })
    }
}

impl Candidate<'_> {
    /// An engine as it is.
    fn alone(loads: &Scene) -> Candidate<'_> {
        let own = Cow::Borrowed(&loads.sources);
        let points: (usize, &dyn Fn(usize) -> Point<'static>) = (1, &|_| Point::default());
        Candidate { loads, slowest: own.clone(), own, points, by_bank: false }
    }

    /// Whether the points vary a source.
    fn varies(&self, source: &Arc<dyn Source>) -> Result<bool> {
        let (count, at) = self.points;
        Ok(count > 1 && source.at_point(&at(0))?.is_some())
    }

    /// Bounds of what orders above those evaluated add at any point: of sources that have no bound for all of them
    /// the largest.
    fn rest(
        &self,
        known: &mut KnownSeries,
        orders: &[Order],
        torque: bool,
        cancel: &Cancel,
    ) -> Result<List<GroupIndex, ErrorBounds>> {
        let is_evaluated = |source: &Arc<dyn Source>| -> Result<bool> {
            let is_bounded = || source.sizes_up_to_own(Column::Roll, &[], cancel);
            Ok(self.varies(source)? && is_bounded()?.is_none())
        };
        let (count, at) = self.points;
        let evaluated: Vec<bool> = self.slowest.iter().map(is_evaluated).collect::<Result<_>>()?;
        let mut rests = rests(self.loads, &self.slowest, known, orders, torque, cancel)?;
        let mut most = self.loads.groups.map_to(|_| ErrorBounds::default());
        for point in 0..if evaluated.contains(&true) { count } else { 1 } {
            cancel.check()?;
            let all = self.slowest.iter().zip(rests.iter_mut()).zip(&evaluated);
            for ((source, own), _) in all.filter(|(_, evaluated)| **evaluated) {
                let there = at_point(source, &at(point))?;
                *own = rest(&*there, &mut Series::default(), orders, cancel)?;
            }
            let sums = sum_of_rests(self.loads, &rests, torque);
            most.iter_mut().zip(&sums).for_each(|(most, sum)| *most = most.max(*sum));
        }
        Ok(most)
    }

    /// Sizes of each order and group at any point and bank angle at most, of force, moment and both torques; and
    /// wrenches and means of the loads that are summed first.
    fn sizes(
        &self,
        known: &KnownSeries,
        orders: &[Order],
        torque: bool,
        cancel: &Cancel,
    ) -> Result<(Vec<[f64; 4]>, Summed)> {
        let Self { loads, slowest, by_bank, .. } = self;
        let varies: List<SourceIndex, bool> =
            slowest.iter().map(|source| self.varies(source)).collect::<Result<_>>()?;
        let mut summands: Vec<Summand> = vec![((None, None), Vec::new())];
        for load in &loads.list {
            let bank = load.place.bank.filter(|_| *by_bank);
            let mut add = |harmonic: Option<Harmonic>, load: Load| {
                let is_such = |(key, _): &Summand| *key == (bank, harmonic);
                let new = || ((bank, harmonic), Vec::new());
                find_or_push(&mut summands, is_such, new).1.push(load);
            };
            if !varies[load.source] {
                add(None, *load);
                continue;
            }
            for column in [Column::Force, Column::Roll] {
                let (mut own, harmonic) = (*load, Harmonic { source: load.source, column });
                match column {
                    Column::Force => own.parts.roll = false,
                    Column::Roll => own.parts.force = None,
                }
                if own.parts.roll || own.parts.force.is_some() {
                    add(Some(harmonic), own);
                }
            }
        }
        let amplitudes = SourceAmplitudes::of_known((slowest, known), torque, orders, cancel)?;
        let ones = SourceAmplitudes::ones(slowest, orders);
        let (mut sizes, mut first) = (vec![[0.0; 4]; orders.len() * loads.groups.len()], None);
        for ((_, harmonic), own) in summands {
            let factors = harmonic.map(|of| self.largest(of, orders, cancel)).transpose()?;
            let by = if factors.is_some() { &ones } else { &amplitudes };
            let wrenches = by.wrenches(loads, &own, torque, orders, cancel)?;
            for (k, (sums, wrench)) in sizes.iter_mut().zip(&wrenches).enumerate() {
                let Wrench { force, moment, torque } = wrench;
                let own = [force.peak(), moment.peak(), torque.roll.norm(), torque.crank.norm()];
                for (which, (sum, size)) in sums.iter_mut().zip(own).enumerate() {
                    let factor = |of: &[Vec<f64>; 2]| of[which / 3][k / loads.groups.len()];
                    *sum += factors.as_ref().map_or(size, |of| times(size, factor(of)));
                }
            }
            first.get_or_insert(wrenches);
        }
        let means = amplitudes.means(loads, &loads.list);
        Ok((sizes, (first.unwrap_or_default(), means)))
    }

    /// Bounds of an amplitude over the points, by order, for the torque on the block and on the crank.
    fn largest(
        &self,
        Harmonic { source, column }: Harmonic,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<[Vec<f64>; 2]> {
        let (source, (count, at)) = (&self.slowest[source], self.points);
        if let Some(bounds) = source.sizes_up_to_own(column, orders, cancel)? {
            return Ok(bounds);
        }
        let mut sizes = [vec![0.0_f64; orders.len()], vec![0.0; orders.len()]];
        for point in 0..count {
            let there = at_point(source, &at(point))?;
            let TorqueHarmonics { roll, crank } = amplitudes(&*there, column, orders, cancel)?;
            for (sizes, values) in sizes.iter_mut().zip([roll, crank]) {
                sizes.iter_mut().zip(values).for_each(|(s, v)| *s = s.max(v.norm()));
            }
        }
        Ok(sizes)
    }
}

/// Orders of all loads of an engine that are given, or chosen; the last ones are kept with them, since they
/// serve any speed.
pub(crate) fn evaluated(
    loads: &Scene,
    orders: &Orders,
    torque: bool,
    cancel: &Cancel,
) -> Result<Arc<Chosen>> {
    type Known = (bool, Orders, Arc<Chosen>);
    let new = || Ok(Arc::new(evaluated_anew(loads, orders, torque, cancel)?));
    if matches!(orders, Orders::Given(orders) if orders.len() > MOST_ORDERS_KEPT) {
        return new();
    }
    let is_such = |(with_torque, known, _): &Known| *with_torque == torque && known == orders;
    let known = loads.kept.get(is_such, || Ok((torque, orders.clone(), new()?)))?;
    Ok(Arc::clone(&known.2))
}

fn evaluated_anew(loads: &Scene, orders: &Orders, torque: bool, cancel: &Cancel) -> Result<Chosen> {
    match orders {
        Orders::Given(orders) => {
            order::check_list(orders)?;
            let amplitudes = SourceAmplitudes::new(&loads.sources, torque, orders, cancel)?;
            let wrenches = amplitudes.wrenches(loads, &loads.list, torque, orders, cancel)?;
            let means = amplitudes.means(loads, &loads.list);
            let left_out = loads.groups.map_to(|_| ErrorBounds::default());
            let kept = vec![true; orders.len()];
            Ok(Chosen { orders: orders.clone(), kept, wrenches, means, left_out })
        }
        Orders::Auto { rtol } => within(*rtol, loads, torque, cancel),
    }
}

/// The orders of an engine that leave out at most `rtol`.
pub(crate) fn within(rtol: f64, loads: &Scene, torque: bool, cancel: &Cancel) -> Result<Chosen> {
    let Choice { orders, kept, mut left_out, summed: (wrenches, means), .. } =
        Choice::new(rtol, &[Candidate::alone(loads)], torque, cancel)?;
    Ok(Chosen { orders, kept, wrenches, means, left_out: left_out.swap_remove(0) })
}

/// Orders of which each cylinder and each further load alone leaves out at most `rtol`, as if nothing
/// cancelled, with those of shafts and counterweights; and bounds at a speed, rad/s, of what all of them
/// leave out.
pub(crate) fn within_each(
    rtol: f64,
    loads: &Scene,
    (torque, omega): (bool, f64),
    cancel: &Cancel,
) -> Result<(Vec<Order>, ErrorBounds)> {
    let (turning, others): (Vec<Load>, Vec<Load>) =
        loads.list.iter().copied().partition(Load::is_turning);
    let mut orders =
        turning.iter().map(|load| load.place.ratio.order()).collect::<Result<Vec<_>>>()?;
    let mut left_out = loads.groups.map_to(|_| ErrorBounds::default());
    let (origins, by_origin) = distinct::<usize, _>(others.iter().map(|load| load.place.origin));
    for origin in origins.indices() {
        let own = others.iter().zip(&by_origin).filter(|(_, of)| **of == origin);
        let alone = Scene { list: own.map(|(load, _)| *load).collect(), ..loads.clone() };
        let chosen = within(rtol, &alone, torque, cancel)?;
        orders.extend(chosen.kept().map(|(order, _)| order));
        for (sum, lost) in left_out.iter_mut().zip(&chosen.left_out) {
            *sum = sum.plus(*lost);
        }
    }
    orders.sort_unstable();
    orders.dedup();
    Ok((orders, bounds(&left_out, &loads.groups, &[omega])))
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

/// Series of orders to evaluate, of sources in place of those of the loads: at the point of a sweep where their
/// harmonics decrease most slowly.
///
/// What higher orders add is at most [`NEGLIGIBLE_REST`] times the tolerance, or, if no order achieves
/// that, at most [`LARGEST_REST`]. Of sources whose orders decline slowly that is enough, or the highest that
/// they evaluate: then more is left out than the tolerance.
fn candidates(
    rtol: f64,
    scales: &List<GroupIndex, GroupScale>,
    loads: &Scene,
    sources: &Sources,
    torque: bool,
    cancel: &Cancel,
) -> Result<KnownSeries> {
    let count = count(&loads.list, torque) as f64;
    let (needed, enough) = (LARGEST_REST * rtol / count, NEGLIGIBLE_REST * rtol / count);
    let candidate = |(k, source): (SourceIndex, &Arc<dyn Source>)| {
        if !counts(&**source, torque) {
            return Ok(Series::default());
        }
        let GroupScale { sums, least, weight } = &scales[loads.group_of[k]];
        if *least > 0.0 && source.parts().force.is_none() {
            let most = LARGEST_REST * rtol.max(*least) * sums.torque;
            if most == 0.0 {
                return Ok(Series::default());
            }
            let is_enough = |rest: Tail| times(*weight, rest.torque) <= most;
            return series(&**source, UpTo::Enough(&is_enough), cancel);
        }
        // What a weight is over that which the tolerance is relative to.
        let LargestWeights { force, arm, roll } = loads.largest_weights(k);
        let share = |weight: f64, scale: f64| if weight == 0.0 { 0.0 } else { weight / scale };
        let (force, arm) = (share(force, sums.force), share(arm, sums.torque));
        let roll = share(roll, sums.torque);
        let within = |rest: Tail, tolerance: f64| {
            let of_torque = times(roll, rest.torque) + times(arm, rest.force);
            times(force, rest.force) <= tolerance && (!torque || of_torque <= tolerance)
        };
        let series = series(&**source, UpTo::Enough(&|rest| within(rest, enough)), cancel)?;
        // A rest that is not negligible still is within the tolerance.
        if within(series.rest, needed) {
            return Ok(series);
        }
        let ratio = source.mechanism().map_or(0.0, |of| of.mechanism.rod_ratio());
        let hint = format!(
            "too many orders would be needed at a rod ratio of {ratio:?}; ask for exact kinematics \
             or a larger rtol"
        );
        Err(Error::figure("rtol", rtol, hint))
    };
    sources.indices().zip(sources).map(candidate).collect()
}

/// Whether a source acts in what is wanted.
fn counts(source: &dyn Source, torque: bool) -> bool {
    torque || source.parts().force.is_some()
}

/// Bounds of what orders beyond those evaluated add to each source in place of one of the loads; series that do
/// not reach the last of them are continued.
fn rests(
    loads: &Scene,
    sources: &Sources,
    known: &mut KnownSeries,
    evaluated: &[Order],
    torque: bool,
    cancel: &Cancel,
) -> Result<List<SourceIndex, Tail>> {
    debug_assert_eq!(loads.sources.len(), sources.len());
    let rest = |(source, known): (&Arc<dyn Source>, &mut Series)| {
        if !counts(&**source, torque) {
            return Ok(Tail::default());
        }
        rest(&**source, known, evaluated, cancel)
    };
    sources.iter().zip(known.iter_mut()).map(rest).collect()
}

/// Bounds of what orders of a source beyond those evaluated add; of its series as far as it is known, which is
/// continued up to the last of them.
fn rest(
    source: &dyn Source,
    known: &mut Series,
    evaluated: &[Order],
    cancel: &Cancel,
) -> Result<Tail> {
    let last = evaluated.last();
    // What bounds all orders above those known so far bounds those that are left out of them.
    let most = if known.orders.is_empty() { Tail::UNKNOWN } else { known.rest };
    if known.orders.last() < last || last.is_none() {
        *known = series(source, UpTo::Halves(last.map_or(0, |last| last.halves())), cancel)?;
    }
    // Another source may have the last order: those from the first one missing on are left out.
    let is_missing = |own: &Order| evaluated.binary_search(own).is_err();
    let rest = match known.orders.iter().find(|own| is_missing(own)) {
        None => known.rest,
        Some(_) if known.has_amplitudes() => known.left_out(|order| is_missing(&order)),
        Some(first) => series(source, UpTo::Halves(first.halves() - 1), cancel)?.rest,
    };
    Ok(Tail { force: rest.force.min(most.force), torque: rest.torque.min(most.torque) })
}

/// Bounds over what groups scale with of what the rests of sources add to force, moment and torque, as if nothing
/// cancelled.
fn sum_of_rests(
    loads: &Scene,
    rests: &List<SourceIndex, Tail>,
    torque: bool,
) -> List<GroupIndex, ErrorBounds> {
    let mut sums = loads.groups.map_to(|_| ErrorBounds::default());
    for load in &loads.list {
        let (place, rest) = (&load.place, rests[load.source]);
        let square = place.speed_squared();
        let force = times(load.weight.abs(), rest.force) * square;
        let sum = &mut sums[loads.group_of[load.source]];
        sum.force += force;
        sum.moment += times(place.lever(loads.reference).abs(), force);
        if torque {
            sum.torque +=
                times(load.roll.abs(), rest.torque) * square + times(place.axis.norm(), force);
        }
    }
    sums
}

/// Zero times infinity is zero.
fn times(weight: f64, bound: f64) -> f64 {
    if weight == 0.0 || bound == 0.0 { 0.0 } else { weight * bound }
}

/// What a tolerance is relative to, of a group over what it scales with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct GroupScale {
    sums: ErrorBounds,
    /// Smallest tolerance of the torque that counts.
    least: f64,
    /// Sum of the weights of torques.
    weight: f64,
}

impl GroupScale {
    /// What of force, moment and torque may be left out.
    fn allowed(&self, rtol: f64) -> [f64; 3] {
        let [force, moment, torque] = self.sums.values();
        [rtol * force, rtol * moment, rtol.max(self.least) * torque]
    }
}

/// What a tolerance is relative to, of each group over what it scales with: for force the largest m·r of a
/// cylinder, amplitude of a spectrum or load, or unbalance; for moment that times the longest lever of a
/// load that has weight; for torque the largest m·r², amplitude of a torque, largest torque of pressure, or force
/// times crank radius or the distance of its axis from the crank. Where rod inertia makes more of order 1, what
/// it makes: about J·r/l.
fn scales(loads: &Scene, sources: &Sources, torque: bool) -> List<GroupIndex, GroupScale> {
    let mut scales = loads.groups.map_to(|_| GroupScale::default());
    let mut levers = loads.groups.map_to(|_| 0.0_f64);
    let of_sources = sources.map_to(|source| counts(&**source, torque).then(|| source.scale()));
    for load in &loads.list {
        let (place, group) = (&load.place, loads.group_of[load.source]);
        let Some(Scale { force: of_force, torque: of_torque, least }) = of_sources[load.source]
        else {
            continue;
        };
        let own = load.weight.abs() * of_force;
        let arm = || loads.crank_radius.max(place.axis.norm());
        let of_torque = of_torque.map_or_else(|| own * arm(), |scale| load.roll.abs() * scale);
        let square = place.speed_squared();
        let scale = &mut scales[group];
        scale.sums.force = scale.sums.force.max(square * own);
        scale.sums.torque = scale.sums.torque.max(square * of_torque);
        scale.least = scale.least.max(least);
        scale.weight += square * load.roll.abs();
        if own > 0.0 {
            levers[group] = levers[group].max(place.lever(loads.reference).abs());
        }
    }
    for (scale, lever) in scales.iter_mut().zip(&levers) {
        scale.sums.moment = scale.sums.force * lever;
    }
    scales
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::*;
    use crate::engine::{Crank, Engine, Station};
    use crate::load::SourceIndex;
    use crate::mechanism::cylinder::Cylinder;
    use crate::numbers::angle::Angle;
    use crate::numbers::index::ListIndex;
    use crate::numbers::ratio::SpeedRatio;

    fn orders_of(
        rtol: f64,
        scales: &List<GroupIndex, GroupScale>,
        loads: &Scene,
        torque: bool,
    ) -> Result<Vec<Order>> {
        let series = candidates(rtol, scales, loads, &loads.sources, torque, &Cancel::new())?;
        let mut orders: Vec<Order> = series.iter().flat_map(|one| one.orders.clone()).collect();
        orders.sort_unstable();
        Ok(orders)
    }

    fn rests_of(loads: &Scene, orders: &[u32]) -> List<GroupIndex, ErrorBounds> {
        let evaluated = Order::all_whole(orders).unwrap();
        let mut known = loads.sources.map_to(|_| Series::default());
        let rests =
            rests(loads, &loads.sources, &mut known, &evaluated, true, &Cancel::new()).unwrap();
        sum_of_rests(loads, &rests, true)
    }

    fn rest_above(source: &dyn Source, order: u32) -> Tail {
        series(source, UpTo::Halves(2 * order), &Cancel::new()).unwrap().rest
    }

    fn sums_of(loads: &Scene) -> ErrorBounds {
        scales(loads, &loads.sources, true)[GroupIndex::default()].sums
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
            let loads = Scene::anew(&engine, 0.0);
            // Against a scale of its own a heavier rod takes more orders.
            let sums = ErrorBounds { force: 1e9, moment: 1e9, torque: 4.0 };
            let scales = List::new(vec![GroupScale { sums, ..GroupScale::default() }]);
            let orders = orders_of(1e-6, &scales, &loads, true).unwrap();
            let highest = *orders.last().unwrap();
            for (order, enough) in [(highest.halves() / 2, true), (highest.halves() / 2 - 1, false)]
            {
                let rest = rest_above(&*loads.sources[SourceIndex::new(1)], order);
                let beyond = rest.torque * inertia.abs() / 4.0;
                assert_eq!(beyond <= NEGLIGIBLE_REST * 1e-6 / 2.0, enough, "{inertia} {order}");
            }
            highest
        };
        assert!(highest(0.5) < highest(-40.0));
    }

    #[test]
    fn loads_that_act_the_other_way_are_bounded_alike() {
        let engine = crate::load::tests::fired([Some(0); 3]).0;
        let ahead = Scene::anew(&engine, 0.0);
        let mut opposite = Scene::anew(&engine, 0.0);
        opposite.list.iter_mut().for_each(|load| {
            load.weight *= -1.0;
            load.roll *= -1.0;
        });
        let bounds =
            |loads: &Scene| (rests_of(loads, &[1, 2, 3, 4]), scales(loads, &loads.sources, true));
        let found = bounds(&opposite);
        assert_eq!(bounds(&ahead), found);
        let [inertia, gas] = [0, 1].map(|k| found.0[GroupIndex::new(k)].values());
        assert!(inertia.iter().all(|&bound| bound > 0.0));
        assert!(gas[2] > 0.0 && found.1[GroupIndex::new(1)].allowed(0.1)[2] > 0.0);
    }

    /// Bounds of a gear's harmonics over the axes, and the largest of those at any point.
    fn bounds_and_largest(
        ratio: SpeedRatio,
        [rod_ratios, pin_offsets]: [Option<Vec<f64>>; 2],
        kind: usize,
    ) -> [Vec<[f64; 2]>; 2] {
        let (tdc, bank, cancel) = (Angle::ZERO, Angle::ZERO, Cancel::new());
        let cylinder = Cylinder::new(0.05, 0.2, 0.5, 0.0).unwrap();
        let cylinder = cylinder.with_rod_inertia_excess(1e-3).unwrap();
        let place = Station { cylinder, tdc, bank, z: 0.0, rotating_mass: 0.0 };
        let cranks = vec![Crank::MAIN, Crank { axis: [0.1, 0.0], ratio }];
        let engine = Engine::new("", "", vec![place]).unwrap().with_cranks(cranks, vec![1]);
        let loads = Scene::anew(&engine.unwrap(), 0.0);
        let orders = Order::all_whole(&(1..=24).collect::<Vec<u32>>()).unwrap();
        let (source, column) = [(0, Column::Force), (0, Column::Roll), (1, Column::Roll)][kind];
        let harmonic = Harmonic { source: SourceIndex::new(source), column };
        let axes = [&rod_ratios, &pin_offsets];
        let [ratios, offsets] = axes.map(|axis| axis.as_ref().map_or(1, Vec::len));
        let at = |point: usize| Point {
            rod_ratio: rod_ratios.as_ref().map(|all| all[point / offsets]),
            pin_offset: pin_offsets.as_ref().map(|all| all[point % offsets]),
            cycles: None,
        };
        let largest = |axis: &Option<Vec<f64>>| {
            axis.iter().flatten().copied().reduce(|a, b| if a.abs() < b.abs() { b } else { a })
        };
        let [rod_ratio, pin_offset] = axes.map(largest);
        let slowest = Point { rod_ratio, pin_offset, cycles: None };
        let candidate = Candidate {
            slowest: Cow::Owned(loads.at_point(&slowest).unwrap()),
            points: (ratios * offsets, &at),
            ..Candidate::alone(&loads)
        };
        let bounds = candidate.largest(harmonic, &orders, &cancel).unwrap();
        let mut found =
            bounds.map(|bounds| bounds.into_iter().map(|b| [b, 0.0]).collect::<Vec<_>>());
        for point in 0..ratios * offsets {
            let there = at_point(&loads.sources[harmonic.source], &at(point)).unwrap();
            let TorqueHarmonics { roll, crank } =
                amplitudes(&*there, column, &orders, &cancel).unwrap();
            for (found, values) in found.iter_mut().zip([roll, crank]) {
                found.iter_mut().zip(values).for_each(|([_, l], value)| *l = l.max(value.norm()));
            }
        }
        found
    }

    #[test]
    fn harmonics_count_as_no_less_than_at_any_point() {
        let evenly = |from: f64, to: f64| -> Option<Vec<f64>> {
            Some((0..=40).map(|k| from + (to - from) * f64::from(k) / 40.0).collect())
        };
        let (usual, both_sides) = (evenly(0.05, 0.4), evenly(-0.02, 0.01));
        // Whether each order is largest at the largest rod ratio: force, torque of masses and of rods.
        for (ratio, ratios, offsets, grows) in [
            (1, usual.clone(), None, [true; 3]),
            (1, evenly(0.8, 0.92), None, [true, true, false]),
            (1, evenly(0.9, 0.99), None, [true, false, false]),
            (-2, evenly(0.9, 0.99), None, [true, false, false]),
            (1, None, both_sides.clone(), [false; 3]),
            (1, usual.clone(), evenly(0.0, 0.02), [false; 3]),
            (5, usual, both_sides, [false; 3]),
        ] {
            for (kind, grows) in grows.into_iter().enumerate() {
                for found in bounds_and_largest(
                    SpeedRatio::whole(ratio),
                    [ratios.clone(), offsets.clone()],
                    kind,
                ) {
                    let own = i32::unsigned_abs(ratio) as usize;
                    for (n, &[bound, largest]) in (1..).zip(&found) {
                        let context = format!("{ratio} {kind} {n}: {bound} {largest}");
                        assert!(largest <= bound * (1.0 + 1e-12), "{context}");
                        if grows {
                            assert!(bound <= largest * (1.0 + 1e-12), "{context}");
                        } else if n < 3 * own && kind != 0 {
                            // Of these no growth is known.
                            assert_eq!(bound, f64::INFINITY, "{context}");
                        } else if let Some([later, _]) = found.get(n + 2 * own - 1) {
                            assert!(bound.is_finite() && *later < 0.99 * bound, "{context}");
                        }
                    }
                }
            }
        }
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
            let loads = Scene::anew(&engine, 0.1);
            rests_of(&loads, orders)[GroupIndex::default()]
        };
        let parts = [(0.5, 0.0, 0.0), (0.5, 0.01, 0.0), (0.0, 0.0, 1e-3), (0.5, 0.01, -1e-3)];
        for (ratio, (mass, offset, inertia)) in
            [1, -1, 2, -2, 3, -3].into_iter().flat_map(|ratio| parts.map(|own| (ratio, own)))
        {
            let cylinder = Cylinder::new(0.05, 0.15, mass, offset).unwrap();
            let cylinder = cylinder.with_rod_inertia_excess(inertia).unwrap();
            let on_main = rest(cylinder, Crank { axis: [0.0; 2], ..Crank::MAIN }, &[1, 2, 3]);
            assert!(on_main.torque > 0.0);
            let speed = i32::unsigned_abs(ratio);
            // Another load has an order above those of the cylinder, one of which is missing.
            let own = [1, 2, 3, 5].map(|own| own * speed);
            let found =
                rest(cylinder, Crank { axis: [-0.3, 0.4], ratio: SpeedRatio::whole(ratio) }, &own);
            let square = f64::from(speed * speed);
            let force = square * on_main.force;
            let inertia = square * f64::from(speed) * on_main.torque + 0.5 * force;
            let expected = ErrorBounds { force, moment: 0.2 * force, torque: inertia };
            for (found, expected) in found.values().into_iter().zip(expected.values()) {
                assert!((found - expected).abs() <= 1e-14 * expected, "{found} {expected}");
            }
        }
    }

    /// Engines on their own scales: what is left out, what it is over and what is kept, in plain sums.
    #[test]
    fn what_is_left_out_is_what_plain_sums_say() {
        let cylinder = |mass: f64, offset: f64| Cylinder::new(0.05, 0.14, mass, offset).unwrap();
        let place = |cylinder, tdc: f64, z, rotating_mass| Station {
            cylinder,
            tdc: Angle::from_degrees(tdc).unwrap(),
            bank: Angle::QUARTER_TURN,
            z,
            rotating_mass,
        };
        let four = [(0.0, 0.0), (180.0, 0.1), (180.0, 0.2), (0.0, 0.3)];
        let engine = |places: Vec<Station>| Engine::new("", "", places).unwrap();
        let engines = [
            engine(vec![place(cylinder(0.4, 0.0), 0.0, 0.2, 0.0)]),
            engine(vec![place(cylinder(0.4, 0.01), 70.0, 0.2, 1.0)]),
            engine(four.map(|(tdc, z)| place(cylinder(0.6, 0.0), tdc, z, 0.0)).to_vec()),
            engine(four.map(|(tdc, z)| place(cylinder(0.6, 0.01), tdc, z, 0.3)).to_vec()),
            engine(vec![
                place(cylinder(0.4, 0.0), 0.0, -0.2, 0.0),
                place(cylinder(0.0, 0.0), 0.0, 0.7, 0.0),
                place(cylinder(0.2, 0.0), 100.0, 0.1, 0.3),
            ]),
            engine(vec![place(cylinder(0.4, 0.0), 0.0, 0.2, 0.0)])
                .with_cranks(
                    vec![Crank::MAIN, Crank { axis: [0.3, -0.4], ratio: SpeedRatio::whole(-2) }],
                    vec![1],
                )
                .unwrap(),
        ];
        // Of each the largest m·r, the longest lever about 0.05 of what has weight, and the largest m·r².
        // On a crank of twice the speed a weight counts four times.
        let scales_of =
            [[0.02, 0.15], [0.05, 0.15], [0.03, 0.25], [0.03, 0.25], [0.02, 0.25], [0.08, 0.15]];
        let all = Order::all_whole(&(1..=100).collect::<Vec<_>>()).unwrap();
        let cancel = Cancel::new();
        for (engine, [weight, lever]) in engines.iter().zip(scales_of) {
            let loads = Scene::anew(engine, 0.05);
            let one = GroupIndex::default();
            let scales = sums_of(&loads).values();
            let expected = [weight, weight * lever, weight * 0.05];
            for (scale, expected) in scales.into_iter().zip(expected) {
                assert!((scale - expected).abs() < 1e-15, "{scales:?} {expected}");
            }
            let every = SourceAmplitudes::new(&loads.sources, true, &all, &cancel).unwrap();
            let every = every.wrenches(&loads, &loads.list, true, &all, &cancel).unwrap();
            for rtol in [0.3, 1e-2, 1e-4, 1e-9] {
                let chosen = within(rtol, &loads, true, &cancel).unwrap();
                let kept: Vec<Order> = chosen.kept().map(|(order, _)| order).collect();
                let mut sums = [0.0; 3];
                let mut of_kept = Vec::new();
                for (order, wrench) in all.iter().zip(&every) {
                    let sizes = [wrench.force.peak(), wrench.moment.peak(), wrench.torque.peak()];
                    if kept.contains(order) {
                        of_kept.push(sizes);
                    } else {
                        sums.iter_mut().zip(sizes).for_each(|(sum, size)| *sum += size);
                    }
                    let is_left = chosen.orders.contains(order)
                        && !kept.contains(order)
                        && sizes.iter().any(|size| *size > 0.0);
                    assert_eq!(chosen.omitted().contains(order), is_left);
                }
                let lost = chosen.left_out[one].values();
                for k in 0..3 {
                    let most = rtol * scales[k] * (1.0 + 1e-12);
                    assert!(lost[k] >= sums[k] * (1.0 - 1e-12) && lost[k] <= most);
                    // The rest above all that are evaluated is a hundredth of what may be left out.
                    assert!(lost[k] <= sums[k] + NEGLIGIBLE_REST * most, "{lost:?} {sums:?}");
                }
                for sizes in of_kept {
                    assert!((0..3).any(|k| lost[k] + sizes[k] > rtol * scales[k]));
                }
                let bound = chosen.error_bound(&loads, &[300.0, 100.0]).values();
                assert_eq!(bound, lost.map(|lost| lost * (300.0 * 300.0)));
            }
        }
    }

    #[test]
    fn bounds_of_groups_add_up_by_what_they_scale_with() {
        let engine = crate::load::tests::fired([Some(0); 3]).0;
        let loads = Scene::anew(&engine, 0.0);
        assert_eq!(loads.groups.len(), 2);
        let of = |k: f64| ErrorBounds { force: k, moment: 2.0 * k, torque: 3.0 * k };
        let found = bounds(&[of(1.0), of(10.0)], &loads.groups, &[5.0, 2.0]).values();
        let factors = [0, 1].map(|k| loads.groups[GroupIndex::new(k)].scaling.factor(5.0));
        assert_eq!(factors.iter().sum::<f64>(), 26.0);
        let sum = factors[0] + 10.0 * factors[1];
        assert_eq!(found, [sum, 2.0 * sum, 3.0 * sum]);
    }

    /// Each by itself, and the shafts.
    #[test]
    fn orders_of_cylinders_alone_are_those_of_engines_of_one() {
        let engine = crate::load::tests::engine();
        let (loads, cancel) = (Scene::anew(&engine, 0.03), Cancel::new());
        for rtol in [1e-2, 1e-6] {
            let mut expected = Order::all_whole(&[1, 2]).unwrap();
            let mut sums = [0.0; 3];
            for station in engine.stations() {
                let alone = Station { rotating_mass: 0.0, ..*station };
                let alone = Engine::new("", "", vec![alone]).unwrap();
                let loads = Scene::anew(&alone, 0.03);
                let chosen = within(rtol, &loads, true, &cancel).unwrap();
                expected.extend(chosen.kept().map(|(order, _)| order));
                let bound = chosen.error_bound(&loads, &[7.0]).values();
                sums.iter_mut().zip(bound).for_each(|(sum, bound)| *sum += bound);
            }
            expected.sort_unstable();
            expected.dedup();
            let (orders, bound) = within_each(rtol, &loads, (true, 7.0), &cancel).unwrap();
            assert_eq!(orders, expected);
            for (bound, sum) in bound.values().into_iter().zip(sums) {
                assert!(sum > 0.0 && (bound - sum).abs() <= 1e-13 * sum, "{bound} {sum}");
            }
        }
    }

    #[test]
    fn a_rod_hardly_longer_than_the_crank_needs_too_many_orders() {
        let cylinder = Cylinder::new(0.05, 0.05 * (1.0 + 1e-13), 0.5, 0.0).unwrap();
        let (tdc, bank) = (Angle::ZERO, Angle::ZERO);
        let place = Station { cylinder, tdc, bank, z: 0.0, rotating_mass: 0.0 };
        let engine = Engine::new("", "", vec![place]).unwrap();
        let loads = Scene::anew(&engine, 0.0);
        let error = within(1e-9, &loads, true, &Cancel::new()).err().unwrap();
        let ratio = format!("at a rod ratio of {:?};", cylinder.mechanism().rod_ratio());
        assert!(error.to_string().contains(&ratio), "{error}");
    }

    /// Where no order leaves a hundredth of the tolerance, the highest is enough if it leaves a quarter.
    #[test]
    fn the_highest_order_is_enough_where_it_leaves_a_quarter() {
        let cylinder = Cylinder::new(0.05, 0.05 * (1.0 + 1e-9), 0.5, 0.0).unwrap();
        let (tdc, bank) = (Angle::ZERO, Angle::ZERO);
        let place = Station { cylinder, tdc, bank, z: 0.0, rotating_mass: 0.0 };
        let engine = Engine::new("", "", vec![place; 2]).unwrap();
        let loads = Scene::anew(&engine, 0.0);
        let rest = rest_above(&*loads.sources[SourceIndex::new(0)], limits::HIGHEST_ORDER).force;
        assert!(rest > 0.0 && rest.is_finite());
        let scales = scales(&loads, &loads.sources, false);
        // Of two cylinders each leaves half of that.
        for (part, is_enough) in [(0.1, true), (0.12, true), (0.13, false), (0.3, false)] {
            let found = orders_of(rest / part, &scales, &loads, false);
            assert_eq!(found.is_ok(), is_enough, "{part}");
            let highest = found.ok().and_then(|orders| orders.last().copied());
            assert!(!is_enough || highest.and_then(Order::as_whole) == Some(limits::HIGHEST_ORDER));
        }
    }

    #[test]
    fn tolerances_are_relative_to_amplitudes_and_to_what_rods_make() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.0, 0.0).unwrap();
        let cylinder = cylinder.with_rod_inertia_excess(0.01).unwrap();
        let (tdc, bank) = (Angle::ZERO, Angle::ZERO);
        let place = Station { cylinder, tdc, bank, z: 0.2, rotating_mass: 0.0 };
        let rod = Engine::new("", "", vec![place]).unwrap();
        let scales_of = |engine: &Engine| sums_of(&Scene::anew(engine, 0.05));
        // About J·r/l.
        let torque = scales_of(&rod).torque;
        assert!((torque / (0.01 / 3.0) - 1.0).abs() < 0.1, "{torque}");
        let spectrum = crate::Spectrum::new([(1, 0.02.into()), (2, 0.005.into())]).unwrap();
        let ErrorBounds { force, moment, .. } = scales_of(&rod.with_spectrum(spectrum));
        assert!((force - 0.02).abs() < 1e-16 && (moment - 0.15 * 0.02).abs() < 1e-16);
    }

    #[test]
    fn nothing_times_anything_is_nothing() {
        for (weight, bound, product) in [
            (0.0, f64::INFINITY, 0.0),
            (f64::INFINITY, 0.0, 0.0),
            (3.0, 0.5, 1.5),
            (2.0, f64::INFINITY, f64::INFINITY),
        ] {
            assert_eq!(times(weight, bound), product);
        }
    }

    #[test]
    fn bounds_of_loads_add_up() {
        let engine = crate::load::tests::fired([Some(0); 3]).0;
        let once = Scene::anew(&engine, 0.0);
        let mut twice = Scene::anew(&engine, 0.0);
        twice.list = once.list.iter().chain(&once.list).copied().collect();
        let rest = |loads: &Scene| rests_of(loads, &[1, 2, 3, 4])[GroupIndex::default()].values();
        for (one, both) in rest(&once).into_iter().zip(rest(&twice)) {
            assert!((both - 2.0 * one).abs() <= 1e-14 * one, "{both} {one}");
        }
        for (one, both) in once.torque_weights().iter().zip(&twice.torque_weights()) {
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
