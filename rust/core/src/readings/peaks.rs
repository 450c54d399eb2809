//! The true peak of a sum of orders: the largest magnitude of a trigonometric polynomial, or of a
//! vector of two or three.
//!
//! Samples alone miss it by up to 1 − cos(nh/2). Here intervals of a grid of sixteen points to the
//! shortest wave of the squared magnitude are halved until bounds of the derivatives rule them out, or
//! show that they hold one peak, which Newton's method polishes.

use std::f64::consts::TAU;
use std::mem;

use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::{self, Order};
use crate::numbers::pool;
use crate::numbers::rational::divisor;
use crate::numbers::simd::vectorised;

/// Grid points to the shortest wave of the squared magnitude.
const POINTS_PER_WAVE: usize = 16;
/// Parts of a step of the grid in which what could be hidden is below 1e-13 of the peak.
const FINEST_STEP: f64 = 4096.0;
/// A polynomial falls from an extreme by 1 − cos nθ of its excursion at most (M. Riesz), and the nearest
/// of the grid is half a step off: 1/(2 cos(π/16)), rounded up.
const EXCURSION_OVER_SAMPLED: f64 = 0.51;
/// Sums of a task.
const SUMS_PER_TASK: usize = 128;
/// Most cosines that a grid keeps, a quarter of a mebibyte; beyond, a Fourier transform takes less time.
const MOST_COSINES: usize = 1 << 15;

/// A grid that serves every sum of the same orders.
#[derive(Debug, Clone)]
pub struct PeakFinder {
    /// Orders over their greatest common divisor.
    waves: Vec<u32>,
    /// Degree of the squared magnitude.
    degree: usize,
    /// `e^{iθ}` at the points of the grid: a power of two of them where there is no table.
    units: Vec<Complex64>,
    /// cos nθ and sin nθ of each wave at the points of the grid; empty where there are too many.
    table: Vec<[Vec<f64>; 2]>,
}

impl PeakFinder {
    /// For sums of these orders.
    pub fn new(orders: &[Order]) -> Result<Self> {
        Self::with(orders, false)
    }

    /// For sums of a mean and these orders.
    pub fn about_mean(orders: &[Order]) -> Result<Self> {
        Self::with(orders, true)
    }

    fn with(orders: &[Order], mean: bool) -> Result<Self> {
        let common = orders.iter().map(|order| order.halves()).fold(0, divisor).max(1);
        let mut waves = memory::with_capacity(orders.len() + 1)?;
        waves.extend(mean.then_some(0));
        waves.extend(orders.iter().map(|order| order.halves() / common));
        let degree = 2 * waves.iter().copied().max().unwrap_or(1) as usize;
        let mut points = POINTS_PER_WAVE * degree;
        let tabled = points * waves.len() <= MOST_COSINES;
        if !tabled {
            points = points.next_power_of_two();
        }
        let unit = |k: usize| Complex64::cis(k as f64 * TAU / points as f64);
        let units = memory::collected((0..points).map(unit))?;
        let columns = |&n: &u32| {
            let turned = (0..points).map(|k| units[k * n as usize % points]);
            let (cos, sin) = turned.map(|unit| (unit.re, unit.im)).unzip();
            [cos, sin]
        };
        let table = if tabled { waves.iter().map(columns).collect() } else { Vec::new() };
        Ok(Self { waves, degree, units, table })
    }

    /// max over θ of |Re Σ Pₙ e^{inθ}|, phasors in the order of the orders.
    pub fn along_axis(&self, phasors: &[Complex64], cancel: &Cancel) -> Result<f64> {
        self.longest([phasors], cancel)
    }

    /// max over θ of |mean + Re Σ Pₙ e^{inθ}|, of a grid about a mean.
    pub fn beside_mean(&self, mean: f64, phasors: &[Complex64], cancel: &Cancel) -> Result<f64> {
        let mut all = memory::with_capacity(phasors.len() + 1)?;
        all.push(Complex64::new(mean, 0.0));
        all.extend_from_slice(phasors);
        self.along_axis(&all, cancel)
    }

    /// max over θ of the length of the vector (Re Σ Xₙ e^{inθ}, Re Σ Yₙ e^{inθ}).
    pub fn of_vector(&self, x: &[Complex64], y: &[Complex64], cancel: &Cancel) -> Result<f64> {
        self.longest([x, y], cancel)
    }

    /// max over θ of the length of the vector (Re Σ Xₙ e^{inθ}, Re Σ Yₙ e^{inθ}, Re Σ Zₙ e^{inθ}).
    pub fn of_vector_in_space(&self, rows: [&[Complex64]; 3], cancel: &Cancel) -> Result<f64> {
        self.longest(rows, cancel)
    }

    fn longest<const N: usize>(&self, rows: [&[Complex64]; N], cancel: &Cancel) -> Result<f64> {
        for row in rows {
            limits::same_length("phasors", row.len(), "the sum", self.waves.len(), "order")?;
        }
        let parts = rows.iter().copied().flatten().map(|p| p.re.abs().max(p.im.abs()));
        let largest = parts.fold(0.0, f64::max);
        if largest == 0.0 {
            return Ok(0.0);
        }
        let in_range = (1e-60..1e60).contains(&largest);
        let scale = if in_range { 1.0 } else { largest.recip().min(1e300) };
        let vector = VectorSum { finder: self, rows, scale };
        let heights =
            if self.table.is_empty() { vector.transformed(cancel)? } else { vector.sampled()? };
        Ok(self.peak(&vector, &heights, cancel)?.sqrt() / scale)
    }

    /// Largest squared length over the circle, given its values at the points of the grid.
    fn peak<const N: usize>(
        &self,
        vector: &VectorSum<N>,
        heights: &[f64],
        cancel: &Cancel,
    ) -> Result<f64> {
        let step = TAU / heights.len() as f64;
        let (lowest, mut best) = heights
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(low, high), &h| (low.min(h), high.max(h)));
        let negligible = 0.25 * f64::EPSILON * best;
        let bounds = vector.bounds(EXCURSION_OVER_SAMPLED * (best - lowest));
        let may_hold_more = |interval: &Interval, best: f64| {
            let ceiling = bounds.ceiling(interval);
            ceiling - interval.highest_end() > negligible && ceiling > best
        };
        // Slopes are evaluated only where values leave room for a peak.
        let most_hidden = bounds.hidden_in_bracket(step).max(step.powi(3) / 12.0 * bounds.third);
        if most_hidden <= negligible {
            return Ok(best);
        }
        let needed = best - most_hidden;
        let mut rest = Vec::new();
        let mut right: Option<(usize, LocalParabola)> = None;
        for (k, &height) in heights.iter().enumerate() {
            let next = if k + 1 == heights.len() { 0 } else { k + 1 };
            if height <= needed && heights[next] <= needed {
                continue;
            }
            let known = right.filter(|(place, _)| *place == k).map(|(_, jet)| jet);
            let left = known.unwrap_or_else(|| vector.squared(self.units[k]));
            let jet = vector.squared(self.units[next]);
            right = Some((next, jet));
            let interval = Interval { from: k as f64 * step, width: step, ends: [left, jet] };
            if may_hold_more(&interval, best) {
                memory::push(&mut rest, interval)?;
            }
            if self.table.is_empty() {
                cancel.check()?;
            }
        }
        // The last is the first to be looked at: a peak found rules out others.
        rest.sort_unstable_by(|a, b| {
            let peaks = a.rises_then_falls().cmp(&b.rises_then_falls());
            peaks.then_with(|| a.highest_end().total_cmp(&b.highest_end()))
        });
        while let Some(interval) = rest.pop() {
            if self.table.is_empty() {
                cancel.check()?;
            }
            best = best.max(interval.highest_end());
            if !may_hold_more(&interval, best) {
                continue;
            }
            let last = interval.width <= step / FINEST_STEP;
            if interval.rises_then_falls() && (last || bounds.bends_down(&interval)) {
                best = best.max(interval.polish(&|θ| vector.squared(Complex64::cis(θ))));
            } else if !last {
                let mut halves = interval.halve(&|θ| vector.squared(Complex64::cis(θ)));
                halves.sort_by_key(Interval::rises_then_falls);
                for half in halves {
                    memory::push(&mut rest, half)?;
                }
            }
        }
        Ok(best)
    }
}

/// Largest magnitude over the turn of each sum of a mean and orders: rows of peak phasors, one of each
/// order, and means of the rows, if any.
pub fn largest_sums(
    orders: &[Order],
    phasors: &[Complex64],
    means: &[f64],
    cancel: &Cancel,
) -> Result<Vec<f64>> {
    let rows = check_rows(orders, phasors)?;
    if !means.is_empty() {
        limits::same_length("means", means.len(), "the phasors", rows, "row")?;
    }
    let finder = PeakFinder::about_mean(orders)?;
    let mut peaks = memory::zeros(rows)?;
    let rows = phasors.chunks(SUMS_PER_TASK * orders.len());
    let parts = memory::collected(peaks.chunks_mut(SUMS_PER_TASK).zip(rows).enumerate())?;
    pool::map(cancel, parts, |(part, (peaks, rows))| {
        cancel.check()?;
        for (k, (peak, row)) in peaks.iter_mut().zip(rows.chunks_exact(orders.len())).enumerate() {
            let mean = means.get(part * SUMS_PER_TASK + k).copied().unwrap_or(0.0);
            *peak = finder.beside_mean(mean, row, cancel)?;
        }
        Ok(())
    })?;
    Ok(peaks)
}

/// Number of rows of one phasor of each order; rejects a row that is cut.
fn check_rows<T>(orders: &[Order], phasors: &[T]) -> Result<usize> {
    order::check_list(orders)?;
    let rows = phasors.len().div_ceil(orders.len());
    limits::same_length("phasors", phasors.len(), "rows of orders", rows * orders.len(), "phasor")?;
    Ok(rows)
}

/// Largest magnitude along x, y and z, and largest length, of each sum of orders of vectors in space: rows
/// of peak phasors, one of each order.
pub fn largest_vectors(
    orders: &[Order],
    phasors: &[[Complex64; 3]],
    cancel: &Cancel,
) -> Result<Vec<[f64; 4]>> {
    check_rows(orders, phasors)?;
    let rows = phasors.chunks_exact(orders.len());
    if let [_] = orders {
        let of_ellipse = |[x, y, z]: &[Complex64; 3]| {
            let squares = x * x + y * y + z * z;
            let size = x.norm_sqr() + y.norm_sqr() + z.norm_sqr();
            // The longer half axis.
            [x.norm(), y.norm(), z.norm(), (0.5 * (size + squares.norm())).sqrt()]
        };
        return memory::collected(phasors.iter().map(of_ellipse));
    }
    let finder = PeakFinder::new(orders)?;
    let mut peaks = memory::zeros(rows.len())?;
    let rows = memory::collected(peaks.iter_mut().zip(rows))?;
    pool::map(cancel, rows, |(peaks, row)| {
        cancel.check()?;
        let component = |axis: usize| memory::collected(row.iter().map(|vector| vector[axis]));
        let [x, y, z] = [component(0)?, component(1)?, component(2)?];
        *peaks = [
            finder.along_axis(&x, cancel)?,
            finder.along_axis(&y, cancel)?,
            finder.along_axis(&z, cancel)?,
            finder.of_vector_in_space([&x, &y, &z], cancel)?,
        ];
        Ok(())
    })?;
    Ok(peaks)
}

/// Value and two derivatives by crank angle.
pub(crate) type LocalParabola = [f64; 3];

/// A vector of sums of orders, times a scale at which squares are in range.
struct VectorSum<'a, const N: usize> {
    finder: &'a PeakFinder,
    rows: [&'a [Complex64]; N],
    scale: f64,
}

impl<const N: usize> VectorSum<'_, N> {
    /// The squared length where `e^{iθ}` is given, and its derivatives.
    fn squared(&self, unit: Complex64) -> LocalParabola {
        let mut sums = [[0.0; 3]; N];
        let (mut power, mut at) = (Complex64::new(1.0, 0.0), 0);
        for (k, &wave) in self.finder.waves.iter().enumerate() {
            // Ascending orders go from power to power; others start again.
            if wave < at {
                (power, at) = (Complex64::new(1.0, 0.0), 0);
            }
            let step = wave - at;
            power *= if step == 1 { unit } else { unit.powu(step) };
            at = wave;
            let n = f64::from(wave);
            for (sum, row) in sums.iter_mut().zip(self.rows) {
                let term = row[k] * power;
                sum[0] += term.re;
                sum[1] -= n * term.im;
                sum[2] -= n * n * term.re;
            }
        }
        let mut jet = [0.0; 3];
        for sum in sums {
            let [value, slope, bend] = sum.map(|part| part * self.scale);
            jet[0] += value * value;
            jet[1] += 2.0 * value * slope;
            jet[2] += 2.0 * (slope * slope + value * bend);
        }
        jet
    }

    /// The squared length at the points of the grid, from its table.
    fn sampled(&self) -> Result<Vec<f64>> {
        let count = self.finder.units.len();
        let (mut squares, mut heights) = (memory::zeros(count)?, memory::zeros(count)?);
        vectorised(
            #[inline(always)]
            || {
                for row in self.rows {
                    heights.fill(0.0);
                    for ([cos, sin], phasor) in self.finder.table.iter().zip(row) {
                        for ((height, cos), sin) in heights.iter_mut().zip(cos).zip(sin) {
                            *height += phasor.re * cos - phasor.im * sin;
                        }
                    }
                    for (square, height) in squares.iter_mut().zip(&heights) {
                        let height: f64 = height * self.scale;
                        *square += height * height;
                    }
                }
            },
        );
        Ok(squares)
    }

    /// The same by fast Fourier transforms (Stockham's, radix 2) of x + iy, a pair of rows each.
    fn transformed(&self, cancel: &Cancel) -> Result<Vec<f64>> {
        let mut squares: Vec<f64> = memory::zeros(self.finder.units.len())?;
        for pair in self.rows.chunks(2) {
            for (square, value) in squares.iter_mut().zip(self.transform(pair, cancel)?) {
                *square += value.norm_sqr();
            }
        }
        Ok(squares)
    }

    /// x + iy at the points of the grid, of one row or two.
    fn transform(&self, pair: &[&[Complex64]], cancel: &Cancel) -> Result<Vec<Complex64>> {
        let units = &self.finder.units;
        let count = units.len();
        let mut from: Vec<Complex64> = memory::zeros(count)?;
        for (row, unit) in pair.iter().zip([Complex64::new(0.5, 0.0), Complex64::new(0.0, 0.5)]) {
            for (&wave, phasor) in self.finder.waves.iter().zip(*row) {
                let phasor = phasor * self.scale;
                from[wave as usize] += unit * phasor;
                from[(count - wave as usize) % count] += unit * phasor.conj();
            }
        }
        let mut to: Vec<Complex64> = memory::zeros(count)?;
        let (mut half, mut stride) = (count / 2, 1);
        while half > 0 {
            cancel.poll()?;
            let (low, high) = from.split_at(half * stride);
            let pairs = low.chunks_exact(stride).zip(high.chunks_exact(stride));
            for (k, ((low, high), to)) in pairs.zip(to.chunks_exact_mut(2 * stride)).enumerate() {
                let (sums, differences) = to.split_at_mut(stride);
                let unit = units[k * stride];
                for i in 0..stride {
                    sums[i] = low[i] + high[i];
                    differences[i] = (low[i] - high[i]) * unit;
                }
            }
            mem::swap(&mut from, &mut to);
            (half, stride) = (half / 2, 2 * stride);
        }
        Ok(from)
    }

    /// Bounds on the derivatives of the squared length, whose distance from its mean is known.
    ///
    /// By Bernstein's inequality each derivative is within the degree times the one before. Where high
    /// waves are small, the sum of the amplitudes' derivatives is less.
    fn bounds(&self, excursion: f64) -> Bounds {
        let mut sums = [0.0; 4];
        for (k, &wave) in self.finder.waves.iter().enumerate() {
            let squares = self.rows.map(|row| (row[k] * self.scale).norm_sqr());
            let mut part = squares.iter().sum::<f64>().sqrt();
            for sum in &mut sums {
                *sum += part;
                part *= f64::from(wave);
            }
        }
        let [zeroth, first, second, third] = sums;
        let degree = self.finder.degree as f64;
        Bounds {
            second: (degree.powi(2) * excursion).min(2.0 * (zeroth * second + first * first)),
            third: (degree.powi(3) * excursion).min(2.0 * (zeroth * third + 3.0 * first * second)),
        }
    }
}

/// Bounds on the derivatives of a function of the crank angle.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    second: f64,
    third: f64,
}

impl Bounds {
    /// A value that the sum does not exceed between the ends.
    fn ceiling(&self, interval: &Interval) -> f64 {
        let width = interval.width;
        if !interval.rises_then_falls() {
            // It rises from a dip to a peak: between two zeros of the slope, by the third derivative.
            return interval.highest_end() + width.powi(3) / 12.0 * self.third;
        }
        // In either half the parabola at its end, and what the third derivative adds.
        let [left, right] = interval.ends.map(|[value, slope, bend]| {
            if bend < 0.0 { value - 0.5 * slope * slope / bend } else { f64::INFINITY }
        });
        let by_parabolas = left.max(right) + width.powi(3) / 48.0 * self.third;
        by_parabolas.min(interval.highest_end() + self.hidden_in_bracket(width))
    }

    /// How far the sum may rise above both ends where it rises at one and falls at the other: from one
    /// peak to the nearer end by the second derivative.
    fn hidden_in_bracket(&self, width: f64) -> f64 {
        width.powi(2) / 8.0 * self.second
    }

    /// Whether it has no more than one peak there, since the second derivative stays below zero.
    fn bends_down(&self, interval: &Interval) -> bool {
        let [left, right] = interval.ends;
        left[2].max(right[2]) + 0.5 * interval.width * self.third < 0.0
    }
}

/// Part of the circle with the function's values at its ends.
struct Interval {
    from: f64,
    width: f64,
    ends: [LocalParabola; 2],
}

impl Interval {
    fn highest_end(&self) -> f64 {
        self.ends[0][0].max(self.ends[1][0])
    }

    fn rises_then_falls(&self) -> bool {
        self.ends[0][1] > 0.0 && self.ends[1][1] < 0.0
    }

    fn halve(&self, at: &impl Fn(f64) -> LocalParabola) -> [Self; 2] {
        let width = 0.5 * self.width;
        let middle = at(self.from + width);
        [
            Self { from: self.from, width, ends: [self.ends[0], middle] },
            Self { from: self.from + width, width, ends: [middle, self.ends[1]] },
        ]
    }

    /// Height of the maximum between the ends, from where a straight line of slopes is zero.
    fn polish(&self, at: &impl Fn(f64) -> LocalParabola) -> f64 {
        let [rise, fall] = [self.ends[0][1], self.ends[1][1]];
        let bracket = [self.from, self.from + self.width];
        let start = self.from + self.width * (rise / (rise - fall));
        polished(bracket, start, at)[1].max(self.highest_end())
    }
}

/// Place and height of the maximum in a bracket: Newton's method on the slope from a place in it;
/// bisection where that would leave the bracket or the top.
pub(crate) fn polished(
    [mut low, mut high]: [f64; 2],
    start: f64,
    at: &impl Fn(f64) -> LocalParabola,
) -> [f64; 2] {
    let (width, mut here, mut best) = (high - low, start, f64::NEG_INFINITY);
    for _ in 0..60 {
        let [value, slope, bend] = at(here);
        best = best.max(value);
        if slope > 0.0 {
            low = here;
        } else {
            high = here;
        }
        let newton = here - slope / bend;
        // Where it bends upwards Newton's method goes to a dip.
        let next = if bend < 0.0 && (low..=high).contains(&newton) {
            // The parabola's top is right to rounding where its steps are so short that what it lacks, of
            // the third power, is.
            if (newton - here).abs() <= 3e-6 * width {
                return [newton, best.max(value - 0.5 * slope * slope / bend)];
            }
            newton
        } else {
            f64::midpoint(low, high)
        };
        // The value has no slope at the top: 1e-9 of the width off it is right to rounding.
        if (next - here).abs() <= 1e-9 * width {
            break;
        }
        here = next;
    }
    [here, best]
}

#[cfg(test)]
mod tests;
