//! A schedule by which an engine fires: when each cylinder does, and how evenly.

use std::cmp::Ordering;
use std::sync::Arc;

use super::highest_points::{
    degrees, fires_after_first, fires_after_tdc, highest_after_tdc, highest_points, same,
};
use crate::engine::Engine;
use crate::layout::Strokes;
use crate::numbers::angle::{Angle, MOST_ROUNDING};
use crate::numbers::error::{Error, Result};

/// A schedule by which an engine fires: cylinders by index from 0.
///
/// ```
/// # let four = crankpin_core::engine::file::from_toml(
/// #     "schema = 1
/// #     cylinder = { crank_radius = 0.043, rod_length = 0.145, reciprocating_mass = 0.66 }
/// #     placements = [
/// #         { tdc_deg = 0, bank_deg = 90, z = 0 }, { tdc_deg = 180, bank_deg = 90, z = 0.1 },
/// #         { tdc_deg = 180, bank_deg = 90, z = 0.2 }, { tdc_deg = 0, bank_deg = 90, z = 0.3 },
/// #     ]",
/// # )?;
/// use std::sync::Arc;
///
/// use crankpin_core::Firing;
/// use crankpin_core::layout::Strokes;
///
/// // Cylinders 2 and 4 fire in the second turn.
/// let later = [false, false, true, true];
/// let firing = Firing::with_later(&Arc::new(four), Strokes::Four, &later)?;
/// assert_eq!(firing.order(), [0, 1, 3, 2]); // 1-2-4-3, by index
/// assert!(firing.even());
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Firing {
    engine: Arc<Engine>,
    strokes: Strokes,
    /// Crank angles after the first cylinder's firing, within a cycle.
    pub(super) times: Vec<Angle>,
    /// All cylinders but dummy pistons, as the crank and the camshaft have them.
    order: Vec<usize>,
    /// Those of them that fire.
    fired: Vec<usize>,
    intervals: Vec<Angle>,
    unevenness: f64,
}

impl Firing {
    /// The schedule in which the cylinders marked `later` fire in the second turn after the first
    /// cylinder.
    pub fn with_later(engine: &Arc<Engine>, strokes: Strokes, later: &[bool]) -> Result<Self> {
        let count = engine.stations().len();
        let first = firing(engine).next().unwrap_or(0);
        if later.len() != count
            || later[first]
            || (strokes == Strokes::Two && later.contains(&true))
        {
            let hint = "give 0 or 1 for each cylinder, 0 for the first and in a two-stroke";
            return Err(Error::value("revolutions", format!("{later:?}"), hint));
        }
        Ok(Self::assemble(engine, &highest_points(engine)?, strokes, later))
    }

    pub(super) fn assemble(
        engine: &Arc<Engine>,
        highest: &[Angle],
        strokes: Strokes,
        later: &[bool],
    ) -> Self {
        let time = |i: usize| highest[i] + turn_if(later[engine.fires_as(i)]);
        let times: Vec<Angle> = (0..highest.len()).map(time).collect();
        let mut order: Vec<usize> = firing(engine).collect();
        order.sort_by(|&a, &b| times[a].partial_cmp(&times[b]).unwrap_or(Ordering::Equal));
        let fired: Vec<usize> = order.iter().copied().filter(|&i| engine.fires(i)).collect();
        let cycle = strokes.cycle();
        let intervals: Vec<Angle> = fired
            .iter()
            .enumerate()
            .map(|(k, &now)| match fired.get(k + 1) {
                Some(&next) => times[next] - times[now],
                None => cycle + times[fired[0]] - times[now],
            })
            .collect();
        let mean = Angle::from_degree_fraction(360 * strokes.turns(), fired.len() as i64)
            .unwrap_or(Angle::ZERO);
        let unevenness = if intervals.iter().all(|&interval| same(interval, mean)) {
            0.0
        } else {
            let squares = intervals.iter().map(|&each| (each - mean).degrees().powi(2));
            let mut squares: Vec<f64> = squares.collect();
            // The same intervals in another order add up to the same.
            squares.sort_unstable_by(f64::total_cmp);
            (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
        };
        Self { engine: Arc::clone(engine), strokes, times, order, fired, intervals, unevenness }
    }

    /// The engine.
    #[must_use]
    pub fn engine(&self) -> &Arc<Engine> {
        &self.engine
    }

    /// Strokes of a cycle.
    #[must_use]
    pub fn strokes(&self) -> Strokes {
        self.strokes
    }

    /// Cylinders by index, from the first on, whether or not they fire, but no dummy pistons; those at
    /// top dead centre together by number.
    #[must_use]
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// The cylinders of the order that fire.
    #[must_use]
    pub fn fired(&self) -> &[usize] {
        &self.fired
    }

    /// Crank angles from each firing to the next, and from the last to the first.
    #[must_use]
    pub fn intervals(&self) -> &[Angle] {
        &self.intervals
    }

    /// True for cylinders that fire in the second turn after the first cylinder's firing.
    #[must_use]
    pub fn later(&self) -> Vec<bool> {
        self.fire_in_second_turn().collect()
    }

    pub(super) fn fire_in_second_turn(&self) -> impl Iterator<Item = bool> {
        self.times.iter().map(|&time| time >= Angle::TURN)
    }

    /// Crank angles at which the cylinders fire, by number, within a cycle.
    #[must_use]
    pub fn angles(&self) -> Vec<Angle> {
        let top = self.engine.stations()[0].tdc + fires_after_tdc(&self.engine, 0);
        self.times.iter().map(|&time| self.within(top.reduced() + time)).collect()
    }

    /// Crank angles at which pistons are highest about their firing, by number, within a cycle.
    pub(super) fn highest(&self) -> Vec<Angle> {
        let highest = |(i, fires): (usize, Angle)| {
            let Some(delay) = self.engine.chamber_delay(i) else { return fires };
            let past = degrees(highest_after_tdc(&self.engine, i));
            self.within(fires - delay + past)
        };
        self.angles().into_iter().enumerate().map(highest).collect()
    }

    /// Whether each cylinder fires at its top dead centre in the second turn of the cycle, by number.
    #[must_use]
    pub fn fires_in_second_turn(&self) -> Vec<bool> {
        let stations = self.engine.stations();
        let second = |i: usize| {
            // Times are those of highest points, which with pin offsets lie beside the dead centres.
            let past = fires_after_first(&self.engine, i).degrees();
            let phase = stations[0].tdc.reduced().degrees() + self.times[i].degrees() - past;
            let turn = (phase - stations[i].tdc.reduced().degrees()) / 360.0;
            turn.round().rem_euclid(self.strokes.turns() as f64) != 0.0
        };
        (0..stations.len()).map(second).collect()
    }

    /// Crank angle at which the cycle of each cylinder begins, by number: its firing top dead centre, within a cycle,
    /// and so much later as a chamber is smallest that it shares.
    #[must_use]
    pub fn phases(&self) -> Vec<Angle> {
        let phase = |(i, second): (usize, bool)| {
            let tdc = self.engine.stations()[i].tdc.reduced() + turn_if(second);
            self.engine.chamber_delay(i).map_or(tdc, |delay| self.within(tdc + delay))
        };
        self.fires_in_second_turn().into_iter().enumerate().map(phase).collect()
    }

    /// True if all intervals are equal.
    #[must_use]
    pub fn even(&self) -> bool {
        self.unevenness == 0.0
    }

    /// How many cylinders fire at a time, where groups of one size fire at equal intervals: 1 for even
    /// firing; none for uneven.
    #[must_use]
    pub fn evenly_at_a_time(&self) -> Option<usize> {
        let gaps = (1..).zip(&self.intervals).filter(|(_, gap)| **gap != Angle::ZERO);
        let (ends, gaps): (Vec<usize>, Vec<Angle>) = gaps.unzip();
        let size = self.intervals.len() / ends.len().max(1);
        let of_one_size = ends.iter().zip(1..).all(|(end, group)| *end == group * size);
        let equal = gaps.iter().all(|gap| (*gap - gaps[0]).degrees().abs() <= MOST_ROUNDING);
        (self.even() || of_one_size && equal).then_some(size)
    }

    /// Root mean square difference of the intervals from equal ones, degrees; 0 for even firing.
    #[must_use]
    pub fn unevenness(&self) -> f64 {
        self.unevenness
    }

    /// Reduced modulo a cycle.
    pub(super) fn within(&self, angle: Angle) -> Angle {
        angle.reduced_to(self.strokes.turns())
    }

    /// The members of a group in the order in which they fire.
    pub(super) fn in_order(&self, group: &[usize]) -> Vec<usize> {
        self.order.iter().copied().filter(|cylinder| group.contains(cylinder)).collect()
    }
}

/// Cylinders by index that a firing order names: all but dummy pistons, and one of those that share a chamber.
pub(super) fn firing(engine: &Engine) -> impl Iterator<Item = usize> {
    let fires = |i: &usize| !engine.details()[*i].dummy && engine.fires_as(*i) == *i;
    (0..engine.stations().len()).filter(fires)
}

/// A whole turn for what comes a turn later, else none.
fn turn_if(later: bool) -> Angle {
    Angle::whole_turns(later.into())
}

impl std::fmt::Display for Firing {
    /// The order as [`crate::layout::FiringOrder`] reads it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (k, cylinder) in self.order.iter().enumerate() {
            let joint = match k {
                0 => "",
                _ if self.times[self.order[k - 1]] == self.times[*cylinder] => "+",
                _ => "-",
            };
            write!(f, "{joint}{}", cylinder + 1)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cylinder, engine, intervals, placed, vee};
    use super::*;
    use crate::engine::Details;
    use crate::layout::{FiringOrder, Side};
    use crate::numbers::cancel::Cancel;

    #[test]
    fn the_cross_plane_v8_fires_evenly() {
        let v8 = engine(&vee(90.0, 0.0, &[0.0, 90.0, 270.0, 180.0], Side::Left));
        let order: FiringOrder = "1-8-4-3-6-5-7-2".parse().unwrap();
        let firing = Firing::named(&v8, &order, Strokes::Four, &Cancel::new()).unwrap();
        assert!(firing.even());
        assert_eq!(intervals(&firing), [90.0; 8]);
        assert_eq!(Firing::all_named(&v8, &order, Strokes::Four).unwrap().len(), 1);
        let gaps = firing.gaps(&firing.banks());
        let left: Vec<f64> = gaps[0].iter().map(|gap| gap.gap.degrees()).collect();
        assert_eq!(left, [270.0, 180.0, 90.0, 180.0]); // 1-3-5-7
    }

    /// An engine without its dummy pistons fires as it does with them, wherever they stand.
    #[test]
    fn dummy_pistons_have_no_place_in_a_firing_order() {
        let tdcs = [0.0, 77.0, 180.0, 180.0, 33.5, 0.0];
        let dummies = [false, true, false, false, true, false];
        let with = |order: &[usize]| -> (Arc<Engine>, Arc<Engine>) {
            let placed = |kept: &[usize]| {
                let places: Vec<_> = kept.iter().map(|&k| (cylinder(0.0), tdcs[k], 90.0)).collect();
                let engine = placed(&places);
                let details =
                    kept.iter().map(|&k| Details { dummy: dummies[k], ..Details::default() });
                Arc::new(engine.with_details(details.collect()).unwrap())
            };
            let firing: Vec<usize> = order.iter().copied().filter(|&k| !dummies[k]).collect();
            (placed(order), placed(&firing))
        };
        for order in [[0, 1, 2, 3, 4, 5], [1, 0, 4, 2, 3, 5], [4, 1, 5, 3, 2, 0]] {
            let (all, firing) = with(&order);
            for strokes in [Strokes::Four, Strokes::Two] {
                let known = Firing::all(&firing, strokes, &Cancel::new()).unwrap();
                let found = Firing::all(&all, strokes, &Cancel::new()).unwrap();
                assert_eq!(found.len(), known.len());
                // Beginnings of cycles may differ by a turn: of rotations of a list, the first by name.
                let rotated = |firing: &Firing| {
                    let gaps = intervals(firing);
                    let from = |k: usize| format!("{:?}", [&gaps[k..], &gaps[..k]].concat());
                    (0..gaps.len()).map(from).min().unwrap()
                };
                let sorted = |firings: &[Firing]| {
                    let mut each: Vec<String> = firings.iter().map(rotated).collect();
                    each.sort();
                    each
                };
                assert_eq!(sorted(&found), sorted(&known));
                for firing in &found {
                    let named: FiringOrder = firing.to_string().parse().unwrap();
                    assert_eq!(named.cylinders().len(), 4);
                    let again = Firing::all_named(&all, &named, strokes).unwrap();
                    assert!(again.iter().any(|one| rotated(one) == rotated(firing)));
                }
            }
            let complete: FiringOrder = "1-2-3-4-5-6".parse().unwrap();
            let error = Firing::all_named(&all, &complete, Strokes::Four).unwrap_err().to_string();
            assert!(error.contains("is a dummy piston"), "{error}");
        }
    }
}
