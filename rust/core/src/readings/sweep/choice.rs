//! A few orders that serve every point of a sweep within a tolerance, chosen by bounds.
//!
//! With the two banks at `bisector ∓ γ` a part of one order is `Σ h·(R·e^{−imγ} + L·e^{imγ} + K)`:
//! an amplitude h of a source (1 for unbalances) times sums of the right bank, of the left bank and of what
//! belongs to none. At every bank angle it is at most `Σ |h|·(|R| + |L| + |K|)`, whatever the loads
//! are; harmonics that no axis varies are multiplied first, so that what they cancel stays cancelled.
//! Those that rod ratio or pin offset vary count with a bound of |h| over the axis:
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
//!
//! Where no axis but speed and load is swept, orders are those of a balance, chosen by its wrenches.

use std::borrow::Cow;
use std::sync::Arc;

use super::layout::{BanksTurned, Layout, LayoutSum};
use super::{Selection, Sweep, SweepAxes};
use crate::Complex64;
use crate::engine::Engine;
use crate::load::{GroupIndex, Harmonic, KnownSeries, Sources};
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::index::List;
use crate::numbers::order::Order;
use crate::readings::amplitude::wrenches;
use crate::readings::balance::ErrorBounds;
use crate::readings::choice::{Candidate, Choice, bounds, rest, rests, sum_of_rests, times};
use crate::readings::quantity::{Kind, Part, Quantity};
use crate::source::{Column, Point, Series, Source, amplitudes, at_point};

impl Sweep {
    /// With few orders that leave out at most `rtol` at any point, as [`crate::Orders::Auto`] does
    /// for one engine; torque counts if it is wanted.
    pub fn within(
        rtol: f64,
        engines: Vec<Arc<Engine>>,
        axes: SweepAxes,
        reference_z: Option<f64>,
        torque: bool,
        cancel: &Cancel,
    ) -> Result<Self> {
        let mut sweep = Self::new(engines, axes, vec![Order::FIRST], reference_z, cancel)?;
        sweep.torque &= torque;
        let loads = std::mem::take(&mut sweep.loads);
        let [rod_ratio, pin_offset] = sweep.extremes;
        // Between the cycles of a map no sum is larger than the largest of theirs.
        let (mut candidates, nodes) = (Vec::new(), sweep.nodes.count());
        for loads in &loads {
            for node in 0..nodes {
                let cycles = sweep.cycles_at(node);
                let own = match cycles {
                    Some(_) => Cow::Owned(loads.at_point(&Point { cycles, ..Point::default() })?),
                    None => Cow::Borrowed(&loads.sources),
                };
                let slowest = loads.at_point(&Point { rod_ratio, pin_offset, cycles })?;
                candidates.push(Candidate { loads, own, sources: Cow::Owned(slowest) });
            }
        }
        let mut choice = Choice::new(rtol, &candidates, sweep.torque, cancel)?;
        let Choice { orders, series, rest, .. } = &mut choice;
        for ((candidate, series), rest) in candidates.iter().zip(series).zip(rest) {
            sweep.add_rests(candidate, series, orders, rest, cancel)?;
        }
        sweep.orders.clone_from(&choice.orders);
        // By order, engine and group.
        let mut sizes: Vec<Vec<ErrorBounds>> = vec![Vec::new(); sweep.orders.len()];
        let mut known = Known::new();
        let is_one_point = sweep.axes.bank_angle.is_none() && sweep.points() == 1;
        let mut layouts = Vec::new();
        for (k, (candidate, series)) in candidates.iter().zip(&choice.series).enumerate() {
            cancel.check()?;
            let Candidate { loads, sources: slowest, .. } = candidate;
            if is_one_point {
                let sources = (&**slowest, series);
                let (all, _) = wrenches(loads, sources, sweep.torque, &sweep.orders, cancel)?;
                for (sizes, of_order) in sizes.iter_mut().zip(all.chunks(loads.groups.len())) {
                    sizes.extend(of_order.iter().map(ErrorBounds::of));
                }
                continue;
            }
            // Of each group the quantities that it makes.
            let mut selected = Vec::new();
            for (k, group) in loads.groups.indices().zip(&loads.groups) {
                let [force, torque] = loads.has(k);
                let planar = [Quantity::FORCE, Quantity::MOMENT];
                let torques = [Quantity::TORQUE, Quantity::CRANK_TORQUE];
                let planar = planar.into_iter().filter(|_| force);
                for quantity in planar.chain(torques.into_iter().filter(|_| torque && sweep.torque))
                {
                    let quantity = quantity.part(Part::Of(&group.name));
                    selected.push((k, Selection { quantity, scaling: Some(group.scaling) }));
                }
            }
            // Another cycle changes amplitudes alone.
            if k % nodes == 0 {
                let selections: Vec<Selection> = selected.iter().map(|(_, one)| *one).collect();
                layouts = sweep.layouts(&sweep.engines[k / nodes], loads, &selections)?;
            }
            let mut of_engine = vec![loads.groups.map_to(|_| ErrorBounds::default()); sizes.len()]; // bounded: orders
            for ((group, selection), layout) in selected.into_iter().zip(&layouts) {
                let largest = sweep.largest(layout, slowest, selection, &mut known, cancel)?;
                for (sums, size) in of_engine.iter_mut().zip(largest) {
                    let sum = selection.of(&mut sums[group]);
                    *sum = sum.max(size);
                }
            }
            sizes.iter_mut().zip(&of_engine).for_each(|(sizes, sums)| sizes.extend(&**sums));
        }
        let flat: Vec<ErrorBounds> = sizes.iter().flatten().copied().collect();
        let (kept, left_out) = choice.few(&flat);
        for (lost, candidate) in left_out.iter().zip(&candidates) {
            for &omega in &sweep.omegas {
                let own = bounds(lost, &candidate.loads.groups, omega);
                sweep.error_bound = sweep.error_bound.max(own);
            }
        }
        sweep.orders.clear();
        for ((order, kept), sizes) in choice.orders.into_iter().zip(kept).zip(sizes) {
            if kept {
                sweep.orders.push(order);
            } else if sizes.iter().any(|&size| size != ErrorBounds::default()) {
                sweep.omitted.push(order);
            }
        }
        drop(candidates);
        sweep.loads = loads;
        Ok(sweep)
    }

    /// Raises bounds of what orders above those evaluated add to what they are at any point, of sources that are
    /// evaluated at each.
    fn add_rests(
        &self,
        Candidate { loads, sources, .. }: &Candidate,
        known: &mut KnownSeries,
        orders: &[Order],
        most: &mut List<GroupIndex, ErrorBounds>,
        cancel: &Cancel,
    ) -> Result<()> {
        let varies = |source: &Arc<dyn Source>| -> Result<bool> {
            let is_bounded = || source.sizes_up_to_own(Column::Roll, &[], cancel);
            let has_points = source.at_point(&self.proportions_at(0))?.is_some();
            Ok(has_points && is_bounded()?.is_none())
        };
        if self.points() == 1 {
            return Ok(());
        }
        let varying: Vec<bool> = sources.iter().map(varies).collect::<Result<_>>()?;
        if !varying.contains(&true) {
            return Ok(());
        }
        let mut rests = rests(loads, sources, known, orders, self.torque, cancel)?;
        *most = loads.groups.map_to(|_| ErrorBounds::default());
        for point in 0..self.points() {
            cancel.check()?;
            let all = sources.iter().zip(rests.iter_mut()).zip(&varying);
            for ((source, own), _) in all.filter(|(_, varies)| **varies) {
                let there = at_point(source, &self.proportions_at(point))?;
                *own = rest(&*there, &mut Series::default(), orders, cancel)?;
            }
            let sums = sum_of_rests(loads, &rests, self.torque);
            most.iter_mut().zip(&sums).for_each(|(most, sum)| *most = most.max(*sum));
        }
        Ok(())
    }

    /// Bounds, of inertia over ω², of the size of each order, |forward| + |backward| or |torque|, at any point;
    /// `slowest` are the sources at the point where harmonics decrease most slowly.
    fn largest(
        &self,
        layout: &Layout,
        slowest: &Sources,
        selection: Selection,
        known: &mut Known,
        cancel: &Cancel,
    ) -> Result<Vec<f64>> {
        let mut factors: Vec<(Harmonic, usize)> = Vec::new();
        for sum in layout.iter().flatten() {
            if factors.iter().all(|(harmonic, _)| *harmonic != sum.harmonic) {
                factors.push((sum.harmonic, self.factors(slowest, sum.harmonic, known, cancel)?));
            }
        }
        let known: &Known = known;
        let factor = |harmonic: Harmonic, order: usize| {
            let found = factors.iter().find(|(known, _)| *known == harmonic);
            let on_crank = usize::from(selection.quantity.kind == Kind::CrankTorque);
            found.map_or(SizeFactor::AtMost(0.0), |&(_, place)| known[place].2[on_crank][order])
        };
        let size = |(k, sums): (usize, &Vec<LayoutSum>)| {
            let (mut size, mut fixed, mut rounding) = (0.0, [BanksTurned::default(); 2], 0.0);
            for sum in sums {
                match factor(sum.harmonic, k) {
                    SizeFactor::Fixed(amplitude) => {
                        rounding += sum.bound * amplitude.norm();
                        for (total, part) in fixed.iter_mut().zip(&sum.parts) {
                            total.cos += part.cos * amplitude;
                            total.sin += part.sin * amplitude;
                            total.rest += part.rest * amplitude;
                        }
                    }
                    SizeFactor::AtMost(largest) => {
                        size += times(span(&sum.parts, sum.bound), largest);
                    }
                }
            }
            size + span(&fixed, rounding)
        };
        Ok(layout.iter().enumerate().map(size).collect())
    }

    /// Place among those known, evaluated if there are none yet, of the amplitudes of a source, or of
    /// their bounds over the axes.
    fn factors(
        &self,
        slowest: &Sources,
        Harmonic { source, column }: Harmonic,
        known: &mut Known,
        cancel: &Cancel,
    ) -> Result<usize> {
        let source = &slowest[source];
        let same = |(of, at, _): &(Arc<dyn Source>, Column, _)| *at == column && **of == **source;
        if let Some(place) = known.iter().position(same) {
            return Ok(place);
        }
        let found = self.evaluated(source, column, cancel)?;
        known.push((Arc::clone(source), column, found));
        Ok(known.len() - 1)
    }

    fn evaluated(
        &self,
        source: &Arc<dyn Source>,
        column: Column,
        cancel: &Cancel,
    ) -> Result<[Vec<SizeFactor>; 2]> {
        let orders = &self.orders;
        if self.points() == 1 || source.at_point(&self.proportions_at(0))?.is_none() {
            let TorqueHarmonics { roll, crank } = amplitudes(&**source, column, orders, cancel)?;
            let fixed =
                |values: Vec<Complex64>| values.into_iter().map(SizeFactor::Fixed).collect();
            return Ok([roll, crank].map(fixed));
        }
        let mut sizes = [vec![0.0_f64; orders.len()], vec![0.0; orders.len()]];
        if let Some(bounds) = source.sizes_up_to_own(column, orders, cancel)? {
            sizes = bounds;
        } else {
            for point in 0..self.points() {
                let there = at_point(source, &self.proportions_at(point))?;
                let TorqueHarmonics { roll, crank } = amplitudes(&*there, column, orders, cancel)?;
                for (sizes, values) in sizes.iter_mut().zip([roll, crank]) {
                    sizes.iter_mut().zip(values).for_each(|(s, v)| *s = s.max(v.norm()));
                }
            }
        }
        Ok(sizes.map(|sizes| sizes.into_iter().map(SizeFactor::AtMost).collect()))
    }
}

/// Factors by order, for the torque on the block and on the crank, of a source's amplitudes.
type Known = Vec<(Arc<dyn Source>, Column, [Vec<SizeFactor>; 2])>;

/// Harmonic of an order.
#[derive(Debug, Clone, Copy)]
enum SizeFactor {
    /// The same at every point.
    Fixed(Complex64),
    /// Of at most this size at any point.
    AtMost(f64),
}

/// Largest size at any bank angle of both parts together; zero where rounding is all there is.
fn span(parts: &[BanksTurned; 2], rounding: f64) -> f64 {
    let part = |&BanksTurned { cos, sin, rest }: &BanksTurned| {
        let sin = Complex64::i() * sin;
        0.5 * ((cos + sin).norm() + (cos - sin).norm()) + rest.norm()
    };
    let size = parts.iter().map(part).sum();
    if size <= rounding { 0.0 } else { size }
}

impl Selection<'_> {
    /// The sum that it counts for.
    fn of<'s>(&self, sums: &'s mut ErrorBounds) -> &'s mut f64 {
        match self.quantity.kind {
            Kind::Force => &mut sums.force,
            Kind::Moment => &mut sums.moment,
            Kind::Torque | Kind::CrankTorque => &mut sums.torque,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Cylinder;
    use crate::engine::{Crank, Station};
    use crate::load::SourceIndex;
    use crate::numbers::angle::Angle;
    use crate::numbers::index::ListIndex;
    use crate::numbers::ratio::SpeedRatio;

    /// Bounds of a gear's harmonics over the axes, and the largest of those at any point.
    fn bounds_and_largest(
        ratio: SpeedRatio,
        [rod_ratio, pin_offset]: [Option<Vec<f64>>; 2],
        kind: usize,
    ) -> [Vec<[f64; 2]>; 2] {
        let (tdc, bank, cancel) = (Angle::ZERO, Angle::ZERO, Cancel::new());
        let cylinder = Cylinder::new(0.05, 0.2, 0.5, 0.0).unwrap();
        let cylinder = cylinder.with_rod_inertia_excess(1e-3).unwrap();
        let place = Station { cylinder, tdc, bank, z: 0.0, rotating_mass: 0.0 };
        let cranks = vec![Crank::MAIN, Crank { axis: [0.1, 0.0], ratio }];
        let engine = Engine::new("", "", vec![place]).unwrap().with_cranks(cranks, vec![1]);
        let axes = SweepAxes { rod_ratio, pin_offset, rpm: vec![1000.0], ..SweepAxes::default() };
        let orders = Order::all_whole(&(1..=24).collect::<Vec<u32>>()).unwrap();
        let engines = vec![Arc::new(engine.unwrap())];
        let sweep = Sweep::new(engines, axes, orders.clone(), None, &cancel).unwrap();
        let (source, column) = [(0, Column::Force), (0, Column::Roll), (1, Column::Roll)][kind];
        let source = &sweep.loads[0].sources[SourceIndex::new(source)];
        let [rod_ratio, pin_offset] = sweep.extremes;
        let slowest = at_point(source, &Point { rod_ratio, pin_offset, cycles: None }).unwrap();
        let bounds = sweep.evaluated(&slowest, column, &cancel).unwrap();
        let mut found = bounds.map(|bounds| {
            let bound = |factor| match factor {
                SizeFactor::AtMost(bound) => [bound, 0.0],
                SizeFactor::Fixed(_) => unreachable!("there are many points"),
            };
            bounds.into_iter().map(bound).collect::<Vec<_>>()
        });
        for point in 0..sweep.points() {
            let there = at_point(source, &sweep.proportions_at(point)).unwrap();
            let TorqueHarmonics { roll, crank } =
                amplitudes(&*there, column, &orders, &cancel).unwrap();
            for (found, values) in found.iter_mut().zip([roll, crank]) {
                found.iter_mut().zip(values).for_each(|([_, l], value)| *l = l.max(value.norm()));
            }
        }
        found
    }

    #[test]
    fn a_span_is_the_largest_size_at_any_bank_angle() {
        let complex = |re, im| Complex64::new(re, im);
        let part = BanksTurned {
            cos: complex(1.0, 2.0),
            sin: complex(-0.5, 1.5),
            rest: complex(0.0, 0.0),
        };
        let at = |angle: f64| (part.cos * angle.cos() + part.sin * angle.sin()).norm();
        let largest = (0..3600).map(|k| at(f64::from(k).to_radians() / 10.0)).fold(0.0, f64::max);
        let span = |rest: Complex64, rounding| {
            super::span(&[BanksTurned { rest, ..part }, BanksTurned::default()], rounding)
        };
        let of_part = span(Complex64::default(), 0.0);
        // Cosines within a twentieth of a degree of the largest.
        assert!(of_part >= largest && of_part < largest * (1.0 + 1e-6), "{of_part} {largest}");
        let with_rest = span(complex(3.0, 4.0), 0.0);
        assert_eq!(with_rest, of_part + 5.0);
        assert_eq!(
            [span(complex(3.0, 4.0), with_rest), span(complex(3.0, 4.0), of_part)],
            [0.0, with_rest]
        );
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
}
