//! Crank angle from the pulses of an encoder on the crankshaft, and the speed of the crank within the cycle.

use std::f64::consts::TAU;
use std::fmt;

use nalgebra::{DMatrix, DVector};
use ndarray::ArrayView2;

use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::figure::significant;
use crate::numbers::memory;
use crate::numbers::order::Order;

/// Part of a signal's range on either side of the threshold that it must leave before it crosses again.
const HYSTERESIS: f64 = 0.15;
/// Intervals at either side of one whose median is the usual one.
const BESIDE: usize = 5;
/// Part of the usual interval below which one of two pulses is extra.
const TOO_SOON: f64 = 0.6;
/// Part of a place by which an interval may be no whole number of them; more is added to the next.
const CARRIED: f64 = 0.35;
/// Part of the pulses, or marks, that may be missing or extra.
const RARE: f64 = 0.05;
/// Degrees by which marks of a turn may differ, and half a place at least.
const MARK_SCATTER: f64 = 1.0;
/// Places of a wheel: of fewer the speed within a turn is unknown, more than every hundredth of a degree is a mistake.
const PLACES: [u32; 2] = [4, 36_000];
/// Places for an order of speed: those of shorter waves are noise of the teeth.
const PLACES_PER_ORDER: f64 = 5.0;
/// Highest order of speed.
const HIGHEST_ORDER: f64 = 24.0;
/// Degrees beside a dead centre within which pressure peaks.
const AROUND_TDC: f64 = 60.0;
/// Rise of pressure at one dead centre over that at the other from which it is the firing one.
const DECISIVE: f64 = 1.5;
/// Places of the lost pulses after which no count is kept: a rounding of many intervals says little.
const FARTHEST_LOSS: f64 = 1e6;

/// Pulses of a turn: places at equal angles, of which some in a row have no tooth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wheel {
    places: u32,
    missing: u32,
}

impl Wheel {
    /// Read `360`, or `60-2` for 60 places of which two have no tooth.
    pub fn parse(text: &str) -> Result<Self> {
        let plain = text.trim().replace(['−', '–'], "-");
        let (places, missing) = plain.split_once('-').unwrap_or((&plain, "0"));
        let numbers = places.trim().parse().ok().zip(missing.trim().parse().ok());
        let Some((places, missing)): Option<(u32, u32)> = numbers else {
            let hint =
                "give the pulses of a turn, such as 360, or 60-2 for a wheel of 60 less 2 teeth";
            return Err(Error::value("pulses", text, hint));
        };
        let [fewest, most] = PLACES;
        if !(fewest..=most).contains(&places) {
            let hint =
                format!("give {fewest} to {most} pulses of a turn: fewer show no speed within it");
            return Err(Error::value("pulses", text, hint));
        }
        if missing > places / 4 {
            return Err(Error::value("pulses", text, "a quarter of the teeth is missing at most"));
        }
        Ok(Self { places, missing })
    }

    /// Degrees from one place to the next.
    fn step_deg(self) -> f64 {
        360.0 / f64::from(self.places)
    }

    fn has_tooth(self, place: i64) -> bool {
        place.rem_euclid(self.places.into()) < i64::from(self.places - self.missing)
    }

    /// Harmonics of a cycle that the teeth resolve.
    #[must_use]
    pub fn harmonics(self, period_deg: f64) -> usize {
        let highest = (f64::from(self.places) / PLACES_PER_ORDER).min(HIGHEST_ORDER);
        ((highest * period_deg / 360.0) as usize).max(1)
    }
}

impl fmt::Display for Wheel {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", self.places)?;
        if self.missing > 0 { write!(out, "-{}", self.missing) } else { Ok(()) }
    }
}

/// A signal over time, with what counts as a pulse of it.
#[derive(Debug, Clone, Copy)]
pub struct Signal<'a> {
    /// Name, for errors.
    pub name: &'static str,
    /// Values, as many as times.
    pub values: &'a [f64],
    /// Level of a crossing; by default midway between the extremes.
    pub threshold: Option<f64>,
    /// Whether a pulse is where the signal falls.
    pub falls: bool,
}

impl Signal<'_> {
    /// Times at which the signal crosses its threshold in one direction, between samples.
    ///
    /// It has to leave a band about the threshold before it crosses again. Where noise makes it cross several times
    /// within the band, the middle counts.
    pub fn crossings(&self, times: &[f64], cancel: &Cancel) -> Result<Vec<f64>> {
        let values = self.values;
        // Of three neighbours the middle: a spike of one sample is no extreme.
        let middles = || {
            values.windows(3).map(|three| {
                let [a, b, c] = [three[0], three[1], three[2]];
                a.min(b).max(a.max(b).min(c))
            })
        };
        let low = middles().fold(f64::INFINITY, f64::min);
        let high = middles().fold(f64::NEG_INFINITY, f64::max);
        if low >= high {
            let fault = "has no pulses: it is constant".into();
            return Err(Error::fault(
                self.name,
                fault,
                "is it the right column, and the sensor alive?",
            ));
        }
        let threshold = self.threshold.unwrap_or_else(|| f64::midpoint(low, high));
        if !(low < threshold && threshold < high) {
            let [low, high] = [low, high].map(|level| significant(level, 4));
            let fault = format!(
                "never crosses {}: it is between {low} and {high}",
                significant(threshold, 4)
            );
            return Err(Error::fault(self.name, fault, "give a threshold between its levels"));
        }
        let band = [high - threshold, threshold - low]
            .into_iter()
            .fold(HYSTERESIS * (high - low), |band, room| band.min(0.5 * room));
        let sign = if self.falls { -1.0 } else { 1.0 };
        let mut found = Vec::new();
        let (mut is_armed, mut between) = (false, None::<[f64; 2]>);
        let mut before = values.first().map_or(0.0, |value| sign * (value - threshold));
        for k in 1..values.len() {
            if k % 65_536 == 0 {
                cancel.check()?;
            }
            let value = sign * (values[k] - threshold);
            if value < -band {
                (is_armed, between) = (true, None);
            } else if is_armed && before < 0.0 && value >= 0.0 {
                let at = times[k - 1] + (times[k] - times[k - 1]) * before / (before - value);
                between = Some([between.map_or(at, |[first, _]| first), at]);
            }
            if let (true, Some([first, last])) = (is_armed && value > band, between) {
                memory::push(&mut found, f64::midpoint(first, last))?;
                (is_armed, between) = (false, None);
            }
            before = value;
        }
        Ok(found)
    }
}

/// Pulses that are missing, if their number is above zero, or one too many.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PulseFault {
    /// Time of the pulse before, or of the one too many.
    pub seconds: f64,
    /// Number of missing pulses, or −1.
    pub missing: i64,
}

/// Times at which the crank is at known angles.
#[derive(Debug, Clone, PartialEq)]
pub struct CrankClock {
    /// Times of the pulses, ascending.
    pub times: Vec<f64>,
    /// Crank angles, degrees, from a mark of the index, or the first tooth behind a gap.
    pub angles_deg: Vec<f64>,
    /// Turns from one mark of the index to the next, 1 or 2.
    pub turns_per_mark: u32,
    /// Pulses that are missing or extra, in order of time.
    pub faults: Vec<PulseFault>,
}

/// Crank angles of the pulses of an encoder, of which the index marks one place once a turn or once in two.
pub fn crank_clock(
    times: &[f64],
    encoder: &Signal<'_>,
    wheel: Wheel,
    index: Option<&Signal<'_>>,
    cancel: &Cancel,
) -> Result<CrankClock> {
    let crossings = encoder.crossings(times, cancel)?;
    let mut pulses = Pulses::placed(encoder.name, wheel, &crossings, cancel)?;
    let (zero, turns_per_mark) = match index {
        Some(index) => pulses.marked(index.name, &index.crossings(times, cancel)?)?,
        None if wheel.missing == 0 => {
            let fault = "is not given, and the encoder has no gap".into();
            return Err(Error::fault(
                "index",
                fault,
                "give a signal that marks a place of the turn",
            ));
        }
        None => (0.0, 1),
    };
    pulses.check()?;
    let step = wheel.step_deg();
    let angles_deg = pulses.places.iter().map(|&place| (place as f64 - zero) * step).collect();
    pulses.faults.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    Ok(CrankClock { times: pulses.times, angles_deg, turns_per_mark, faults: pulses.faults })
}

/// Pulses and the places of the wheel that they are, counted on over turns.
struct Pulses {
    name: &'static str,
    wheel: Wheel,
    times: Vec<f64>,
    places: Vec<i64>,
    faults: Vec<PulseFault>,
}

impl Pulses {
    fn placed(
        name: &'static str,
        wheel: Wheel,
        crossings: &[f64],
        cancel: &Cancel,
    ) -> Result<Self> {
        let teeth = (wheel.places - wheel.missing) as usize;
        if crossings.len() <= teeth {
            let fault = format!("has {} pulses, a turn of {wheel} has {teeth}", crossings.len());
            let hint =
                "is it the right column, with the threshold between its levels, and long enough?";
            return Err(Error::fault(name, fault, hint));
        }
        let (times, faults) = without_extra(crossings);
        cancel.check()?;
        let mut pulses =
            Self { name, wheel, places: Vec::with_capacity(times.len()), times, faults };
        pulses.count()?;
        if wheel.missing > 0 {
            pulses.begin_behind_gap()?;
        }
        Ok(pulses)
    }

    /// Count places from intervals, of which the usual ones have one.
    fn count(&mut self) -> Result<()> {
        let usual = usual_intervals(&self.times);
        let (mut place, mut carry) = (0_i64, 0.0);
        self.places.push(place);
        for (pair, usual) in self.times.windows(2).zip(usual) {
            let steps = (pair[1] - pair[0]) / usual + carry;
            if steps >= FARTHEST_LOSS {
                let fault = format!("has no pulses from {} s on", significant(pair[0], 6));
                return Err(Error::fault(self.name, fault, "record while the engine runs"));
            }
            let whole = steps.round().max(1.0);
            carry = if (steps - whole).abs() > CARRIED { steps - whole } else { 0.0 };
            place += whole as i64;
            self.places.push(place);
        }
        Ok(())
    }

    /// Number of turns counted.
    fn turns(&self) -> f64 {
        let ends = self.places.first().zip(self.places.last());
        ends.map_or(0.0, |(first, last)| (last - first) as f64 / f64::from(self.wheel.places))
    }

    /// Indices of the pulses behind an interval of some places.
    fn behind(&self, is_wide: impl Fn(i64) -> bool) -> Vec<usize> {
        (1..self.places.len()).filter(|&k| is_wide(self.places[k] - self.places[k - 1])).collect()
    }

    /// Places that follow each other most often between pulses, and how often.
    fn most_frequent(&self, at: &[usize], remainder: Option<i64>) -> Option<(i64, usize)> {
        let mut keys: Vec<i64> = match remainder {
            Some(count) => at.iter().map(|&k| self.places[k].rem_euclid(count)).collect(),
            None => at.windows(2).map(|pair| self.places[pair[1]] - self.places[pair[0]]).collect(),
        };
        keys.sort_unstable();
        keys.chunk_by(|a, b| a == b).map(|same| (same[0], same.len())).max_by_key(|&(_, n)| n)
    }

    /// Count places from the first tooth behind the gap.
    fn begin_behind_gap(&mut self) -> Result<()> {
        let Wheel { places, missing } = self.wheel;
        let (places, gap) = (i64::from(places), i64::from(missing) + 1);
        let gaps = self.behind(|steps| steps == gap);
        let first = self.most_frequent(&gaps, Some(places));
        let Some((first, count)) = first.filter(|&(_, n)| 2.0 * n as f64 >= self.turns().floor())
        else {
            let wide = self.behind(|steps| steps > 1);
            let hint = match self.most_frequent(&wide, None) {
                Some((apart, n)) if 3 * n > wide.len() => {
                    let wide = wide.iter().map(|&k| self.places[k] - self.places[k - 1] - 1);
                    let most = wide.max().unwrap_or_default();
                    format!(
                        "the encoder's gaps, of {most} missing teeth at most, are {apart} places apart"
                    )
                }
                _ => "the encoder has no such gap once a turn".to_owned(),
            };
            return Err(Error::value("pulses", self.wheel, hint));
        };
        let odd = gaps.iter().filter(|&&k| self.places[k].rem_euclid(places) != first);
        let odd: Vec<usize> = odd.copied().collect();
        if odd.len() as f64 > (RARE * gaps.len() as f64).max(2.0) {
            let at = significant(self.times[odd[0]], 6);
            let fault = format!(
                "has its gap at another place in {} of {} turns, first at {at} s",
                odd.len(),
                count + odd.len()
            );
            return Err(Error::fault(
                self.name,
                fault,
                "are pulses lost, or is the threshold too high?",
            ));
        }
        let mut k = 0;
        while k < self.places.len() {
            self.places[k] -= first;
            if self.wheel.has_tooth(self.places[k]) {
                k += 1;
            } else {
                self.faults.push(PulseFault { seconds: self.times.remove(k), missing: -1 });
                self.places.remove(k);
            }
        }
        Ok(())
    }

    /// Place of the index, and turns between its marks.
    fn marked(&self, name: &str, marks: &[f64]) -> Result<(f64, u32)> {
        let places: Vec<f64> = self.places.iter().map(|&place| place as f64).collect();
        let inside = |&at: &f64| self.times[0] <= at && at <= self.times[self.times.len() - 1];
        let marks: Vec<f64> = marks.iter().copied().filter(inside).collect();
        let at = straight(&self.times, &places, &marks);
        let turn = f64::from(self.wheel.places);
        let scatter = (turn * MARK_SCATTER / 360.0).max(0.5);
        let mut apart: Vec<f64> = at.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if apart.is_empty() {
            let fault =
                format!("marks {} places in {} turns", at.len(), significant(self.turns(), 3));
            return Err(Error::fault(
                name,
                fault,
                "give a signal with a pulse in each turn or cycle",
            ));
        }
        let usual = median(&mut apart);
        let turns = [1.0, 2.0].into_iter().find(|turns| (usual - turns * turn).abs() <= scatter);
        let Some(turns) = turns else {
            let hint = format!(
                "{} pulses, gaps filled, are between marks of the index: give that number, or half of it if \
                 the mark comes once a cycle",
                significant(usual, 4)
            );
            return Err(Error::value("pulses", self.wheel, hint));
        };
        let period = turns * turn;
        let apart =
            |place: f64, from: f64| (place - from + 0.5 * period).rem_euclid(period) - 0.5 * period;
        // The first mark may be odd: of all as a zero the one which is nearest to the others.
        let sample: Vec<f64> = at.iter().copied().take(64).collect();
        let far = |from: f64| sample.iter().map(|&place| apart(place, from).abs()).sum::<f64>();
        let first =
            sample.iter().copied().min_by(|&a, &b| far(a).total_cmp(&far(b))).unwrap_or_default();
        let (near, odd): (Vec<usize>, Vec<usize>) =
            (0..at.len()).partition(|&k| apart(at[k], first).abs() <= scatter);
        if odd.len() as f64 > (RARE * at.len() as f64).max(1.0) {
            let (count, all, seconds) = (odd.len(), at.len(), significant(marks[odd[0]], 6));
            let fault = format!(
                "is at another place of the wheel in {count} of {all} marks, first at {seconds} s"
            );
            return Err(Error::fault(name, fault, "are pulses lost, or is it noise?"));
        }
        let mean = near.iter().map(|&k| apart(at[k], first)).sum::<f64>() / near.len() as f64;
        Ok((first + mean, turns as u32))
    }

    /// Note missing pulses, and reject an encoder of which many are missing or extra.
    fn check(&mut self) -> Result<()> {
        let mut lost = Vec::new();
        for k in 1..self.places.len() {
            let between = self.places[k - 1] + 1..self.places[k];
            let missing = between.filter(|&place| self.wheel.has_tooth(place)).count() as i64;
            if missing > 0 {
                lost.push((k, PulseFault { seconds: self.times[k - 1], missing }));
            }
        }
        let turns = self.turns();
        if self.wheel.missing == 0 && lost.len() > 2 {
            let behind: Vec<usize> = lost.iter().map(|&(k, _)| k).collect();
            let same = self.most_frequent(&behind, Some(self.wheel.places.into()));
            if same.is_some_and(|(_, n)| 2.0 * n as f64 > turns) {
                let missing = lost[lost.len() / 2].1.missing;
                let hint = format!("each turn has a gap; is it {}-{missing}?", self.wheel.places);
                return Err(Error::value("pulses", self.wheel, hint));
            }
        }
        self.faults.extend(lost.iter().map(|&(_, fault)| fault));
        let count: i64 = self.faults.iter().map(|fault| fault.missing.abs()).sum();
        if count as f64 > RARE * self.times.len() as f64 {
            let fault = format!("has {count} pulses missing or extra beside {}", self.times.len());
            let hint = "is it the right column, with the threshold between its levels?";
            return Err(Error::fault(self.name, fault, hint));
        }
        Ok(())
    }
}

/// Pulses without those that follow too soon.
fn without_extra(crossings: &[f64]) -> (Vec<f64>, Vec<PulseFault>) {
    let usual = usual_intervals(crossings);
    let (mut times, mut faults) = (Vec::<f64>::with_capacity(crossings.len()), Vec::new());
    for (k, &time) in crossings.iter().enumerate() {
        let Some(&last) = times.last() else {
            times.push(time);
            continue;
        };
        let usual = usual[k - 1];
        if time - last >= TOO_SOON * usual {
            times.push(time);
            continue;
        }
        // Whichever leaves whole numbers of places.
        let off = |interval: f64| {
            let places = interval / usual;
            (places - places.round().max(1.0)).abs()
        };
        let before = times.len().checked_sub(2).map(|k| times[k]);
        let next = crossings.get(k + 1);
        let with = |kept: f64| {
            before.map_or(0.0, |at| off(kept - at)) + next.map_or(0.0, |at| off(at - kept))
        };
        let extra = if with(time) < with(last) { times.pop().unwrap_or(time) } else { time };
        if extra == last {
            times.push(time);
        }
        faults.push(PulseFault { seconds: extra, missing: -1 });
    }
    (times, faults)
}

/// Median of the intervals about each.
fn usual_intervals(times: &[f64]) -> Vec<f64> {
    let intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    (0..intervals.len())
        .map(|k| {
            let end = (k + BESIDE + 1).min(intervals.len());
            median(&mut intervals[k.saturating_sub(BESIDE)..end].to_vec())
        })
        .collect()
}

/// Median of numbers, the upper one of two; NaN of none.
fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Values at places of the straight lines between points, beyond their ends those at the ends; NaN of none.
fn straight(x: &[f64], y: &[f64], at: &[f64]) -> Vec<f64> {
    let line = |&at: &f64| {
        let k = x.partition_point(|&x| x <= at);
        if k == 0 || k == x.len() {
            return y.get(k.min(x.len().saturating_sub(1))).copied().unwrap_or(f64::NAN);
        }
        y[k - 1] + (y[k] - y[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1])
    };
    at.iter().map(line).collect()
}

/// Values at places of the cubics through the four points about each; of fewer, or of such as do not ascend, those of
/// the straight lines.
pub fn cubics(x: &[f64], y: &[f64], at: &[f64], cancel: &Cancel) -> Result<Vec<f64>> {
    if x.len() < 4 || x.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Ok(straight(x, y, at));
    }
    let mut values = memory::with_capacity(at.len())?;
    for (k, &at) in at.iter().enumerate() {
        if k % 65_536 == 0 {
            cancel.check()?;
        }
        let first = x.partition_point(|&x| x < at).saturating_sub(2).min(x.len() - 4);
        let four = first..first + 4;
        values.push(four.clone().fold(0.0, |sum, k| {
            let others = four.clone().filter(|&j| j != k);
            sum + y[k] * others.map(|j| (at - x[j]) / (x[k] - x[j])).product::<f64>()
        }));
    }
    Ok(values)
}

/// Whether cylinders fire a turn later than their dead centres say, which pressure shows: rows of it by cylinder, over
/// crank angles that ascend.
pub fn fires_a_turn_later(
    angles_deg: &[f64],
    pressure: &ArrayView2<f64>,
    tdc_deg: &[f64],
    cancel: &Cancel,
) -> Result<bool> {
    let mut later = None::<bool>;
    for (number, (row, tdc)) in pressure.rows().into_iter().zip(tdc_deg).enumerate() {
        cancel.check()?;
        let values = row.to_vec();
        let usual = median(&mut values.clone());
        let peaks = [0.0, 360.0].map(|turn| {
            let from = tdc + turn - AROUND_TDC;
            let first = ((angles_deg[0] - from) / 720.0).ceil();
            let windows = (0..)
                .map(|k| from + 720.0 * (first + f64::from(k)))
                .take_while(|from| from + 2.0 * AROUND_TDC <= angles_deg[angles_deg.len() - 1]);
            let largest = |from: f64| {
                let place = |angle: f64| angles_deg.partition_point(|&at| at < angle);
                let inside = &values[place(from)..place(from + 2.0 * AROUND_TDC)];
                inside.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            };
            median(&mut windows.map(largest).collect::<Vec<_>>())
        });
        let [rise, other] = peaks.map(|peak| peak - usual);
        let in_bar = peaks.map(|peak| significant(peak / 1e5, 4));
        let is_later = if rise > DECISIVE * other.max(0.0) {
            false
        } else if other > DECISIVE * rise.max(0.0) {
            true
        } else {
            let fault = format!(
                "of cylinder {} peaks at {} bar about the dead centre at {}° and at {} bar about that a turn later, \
                 and either may be the firing one",
                number + 1,
                in_bar[0],
                significant(*tdc, 5),
                in_bar[1]
            );
            let hint = "give an index that marks once a cycle; or is it a two-stroke, or the dead centre wrong?";
            return Err(Error::fault("pressure", fault, hint));
        };
        if later.is_some_and(|first| first != is_later) {
            let fault = format!(
                "of cylinder {} fires a turn from where cylinder 1 and the firing order have it",
                number + 1
            );
            let hint = "are pressures in the order of the cylinders, and the firing order right?";
            return Err(Error::fault("pressure", fault, hint));
        }
        later = Some(is_later);
    }
    Ok(later.unwrap_or(false))
}

/// Speed of the crank, rpm, at equal steps of each cycle from its start: (`n_cycles`, `n_points`).
///
/// The time of each pulse is that of the cycle's mean speed and a Fourier series over the crank angle, fitted by least
/// squares to the teeth there are; its slope is the reciprocal of speed. A change of the mean speed from cycle to cycle
/// is taken out.
pub fn speed_within_cycles(
    clock: (&[f64], &[f64]),
    wheel: Wheel,
    starts_deg: &[f64],
    period_deg: f64,
    points: usize,
    cancel: &Cancel,
) -> Result<Vec<f64>> {
    let (times, angles) = clock;
    let harmonics = wheel.harmonics(period_deg);
    let ends: Vec<f64> = starts_deg.iter().flat_map(|&start| [start, start + period_deg]).collect();
    let ends = cubics(angles, times, &ends, cancel)?;
    let lengths: Vec<f64> = ends.chunks_exact(2).map(|pair| pair[1] - pair[0]).collect();
    let mut speeds = memory::with_capacity(starts_deg.len() * points)?;
    for (cycle, &start) in starts_deg.iter().enumerate() {
        cancel.check()?;
        let [before, after] = [cycle.saturating_sub(1), (cycle + 1).min(lengths.len() - 1)];
        let grows = (lengths[after] - lengths[before]) / (after - before).max(1) as f64;
        let place = |angle: f64| angles.partition_point(|&at| at < angle);
        let inside = place(start)..place(start + period_deg);
        if inside.len() < 2 * harmonics + 1 {
            let fault = format!("has {} pulses in cycle {cycle}", inside.len());
            return Err(Error::fault("encoder", fault, "record without interruption"));
        }
        let shares: Vec<f64> = inside.clone().map(|k| (angles[k] - start) / period_deg).collect();
        let wave = |share: f64, column: usize| match column {
            0 => 1.0,
            _ if column % 2 == 1 => (TAU * column.div_ceil(2) as f64 * share).cos(),
            _ => (TAU * (column / 2) as f64 * share).sin(),
        };
        let basis = DMatrix::from_fn(shares.len(), 2 * harmonics + 1, |row, column| {
            wave(shares[row], column)
        });
        let late = DVector::from_iterator(
            shares.len(),
            inside.zip(&shares).map(|(k, &share)| {
                times[k]
                    - ends[2 * cycle]
                    - lengths[cycle] * share
                    - 0.5 * grows * share * (share - 1.0)
            }),
        );
        let fit = basis.tr_mul(&basis).cholesky().map(|square| square.solve(&basis.tr_mul(&late)));
        let fit = fit.ok_or_else(|| {
            let fault = format!("has too long a gap in cycle {cycle}");
            Error::fault("encoder", fault, "record without interruption")
        })?;
        for k in 0..points {
            let share = k as f64 / points as f64;
            let slope = (1..=harmonics).fold(lengths[cycle], |slope, n| {
                let (sine, cosine) = (TAU * n as f64 * share).sin_cos();
                slope + TAU * n as f64 * (fit[2 * n] * cosine - fit[2 * n - 1] * sine)
            });
            if slope <= 0.0 {
                let fault = format!("has no direction of rotation in cycle {cycle}");
                return Err(Error::fault(
                    "encoder",
                    fault,
                    "its pulses are noise, or the crank stands",
                ));
            }
            speeds.push(period_deg / (6.0 * slope));
        }
    }
    Ok(speeds)
}

/// Peak phasors of curves at equal steps of a period, a row each: (`n_curves`, `n_orders`).
pub fn phasors(
    curves: &ArrayView2<f64>,
    period_deg: f64,
    orders: &[Order],
    cancel: &Cancel,
) -> Result<Vec<Complex64>> {
    let points = curves.ncols() as f64;
    let mut phasors = memory::with_capacity(curves.nrows() * orders.len())?;
    for curve in curves.rows() {
        cancel.check()?;
        phasors.extend(orders.iter().map(|order| {
            let turns = order.number() * period_deg / 360.0;
            let turned = curve.iter().enumerate().map(|(k, &value)| {
                Complex64::cis(-TAU * (turns * k as f64 / points).fract()) * value
            });
            2.0 / points * turned.sum::<Complex64>()
        }));
    }
    Ok(phasors)
}
