//! The true peak of a sum of orders: the largest magnitude of a trigonometric polynomial.
//!
//! Samples alone miss it by up to 1 − cos(nh/2). Here intervals of a grid of sixteen points to the
//! shortest wave are halved until bounds of the derivatives rule them out, or show that they hold one
//! peak, which Newton's method polishes.

use std::f64::consts::TAU;

use crate::Complex64;
use crate::numbers::order::Order;
use crate::numbers::rational::divisor;
use crate::numbers::simd::vectorised;

/// Grid points to the shortest wave.
const POINTS_PER_WAVE: usize = 16;
/// Parts of a step of the grid in which what could be hidden is below 1e-13 of the peak.
const MOST_PARTS: f64 = 4096.0;
/// A polynomial falls from an extreme by 1 − cos nθ of its excursion at most (M. Riesz), and the nearest
/// of the grid is half a step off: 1/(2 cos(π/16)), rounded up.
const EXCURSION_OVER_SAMPLED: f64 = 0.51;

/// Points of a grid evaluated side by side; a grid has whole lanes of them.
const LANES: usize = 16;
/// Most values of waves that a grid keeps: half a mebibyte.
const MOST_WAVE_VALUES: usize = 1 << 15;

/// A grid that serves every sum of the same orders.
#[derive(Debug, Clone)]
pub struct PeakFinder {
    /// Orders over their greatest common divisor.
    waves: Vec<u32>,
    /// Grid of a force or torque.
    linear: Grid,
    /// ... and of its squared length, which has twice the degree.
    quadratic: Grid,
}

/// Points of the circle.
#[derive(Debug, Clone)]
struct Grid {
    /// `e^{iθ}`.
    units: Vec<Complex64>,
    /// cos nθ and sin nθ of each wave; empty where there are too many.
    waves: Vec<[Vec<f64>; 2]>,
}

/// Value and two derivatives by crank angle.
type Jet = [f64; 3];

impl PeakFinder {
    /// For sums of these orders.
    #[must_use]
    pub fn new(orders: &[Order]) -> Self {
        let halves = || orders.iter().map(|order| order.halves());
        let common = halves().fold(0, divisor);
        let waves: Vec<u32> = halves().map(|n| n / common.max(1)).collect();
        let degree = waves.iter().copied().max().unwrap_or(1) as usize;
        let linear = Grid::new(POINTS_PER_WAVE * degree, &waves);
        let quadratic = Grid::new(2 * POINTS_PER_WAVE * degree, &waves);
        Self { waves, linear, quadratic }
    }

    /// max over θ of |Re Σ Pₙ e^{inθ}|, phasors in the order of the orders.
    #[must_use]
    pub fn along_axis(&self, phasors: &[Complex64]) -> f64 {
        let mut heights = self.heights(&self.linear, phasors);
        let terms = self.waves.iter().zip(phasors).map(|(&wave, phasor)| (wave, phasor.norm()));
        let bounds = Bounds::new(&heights, terms);
        let up = Self::peak(&self.linear, &heights, bounds, 0.0, &|unit| self.sum(phasors, unit));
        heights.negate();
        let down = |unit| self.sum(phasors, unit).map(|v| -v);
        Self::peak(&self.linear, &heights, bounds, up, &down)
    }

    /// max over θ of the length of the vector (Re Σ Xₙ e^{inθ}, Re Σ Yₙ e^{inθ}).
    #[must_use]
    pub fn of_vector(&self, x: &[Complex64], y: &[Complex64]) -> f64 {
        // Scaled where fourth powers would overflow or vanish.
        let largest = x.iter().chain(y).map(|z| z.re.abs().max(z.im.abs())).fold(0.0, f64::max);
        if largest == 0.0 {
            return 0.0;
        }
        if !(1e-60..1e60).contains(&largest) {
            let scaled =
                |phasors: &[Complex64]| phasors.iter().map(|z| z / largest).collect::<Vec<_>>();
            return self.of_vector(&scaled(x), &scaled(y)) * largest;
        }
        let heights = self.squares(&self.quadratic, x, y);
        let bounds = self.squared_bounds(&heights, x, y);
        let squared = |unit| self.squared_length(x, y, unit);
        Self::peak(&self.quadratic, &heights, bounds, 0.0, &squared).sqrt()
    }

    /// Bounds of a vector's squared length.
    ///
    /// Of x + iy = Σ vⱼ e^{ijθ} it has order d from every two terms that are d apart.
    fn squared_bounds(&self, heights: &Heights, x: &[Complex64], y: &[Complex64]) -> Bounds {
        /// Orders up to which everything fits on the stack.
        const FEW: usize = 16;
        let i = Complex64::i();
        let highest = self.waves.iter().copied().max().unwrap_or(0) as usize;
        let (mut few, mut few_parts) = ([Complex64::default(); 2 * FEW + 1], [(0, i); 2 * FEW]);
        let (mut many, mut many_parts) = (Vec::new(), Vec::new());
        let (terms, parts) = if highest <= FEW {
            (&mut few[..], &mut few_parts[..])
        } else {
            many.resize(2 * highest + 1, Complex64::default());
            many_parts.resize(2 * self.waves.len(), (0, i));
            (&mut many[..], &mut many_parts[..])
        };
        for (k, ((&wave, x), y)) in self.waves.iter().zip(x).zip(y).enumerate() {
            parts[2 * k] = (i64::from(wave), 0.5 * (x + i * y));
            parts[2 * k + 1] = (-i64::from(wave), 0.5 * (x.conj() + i * y.conj()));
        }
        let parts = &parts[..2 * self.waves.len()];
        for (k, (wave, part)) in parts.iter().enumerate() {
            for (other, of_other) in &parts[k + 1..] {
                let (above, below) = if wave > other { (part, of_other) } else { (of_other, part) };
                terms[wave.abs_diff(*other) as usize] += above * below.conj();
            }
        }
        // Their squares are within range: a tenth of what `norm` takes.
        let amplitudes = terms.iter().map(|term| 2.0 * term.norm_sqr().sqrt());
        Bounds::new(heights, (0..).zip(amplitudes))
    }

    /// The sum's real part at the points of a grid.
    fn heights(&self, grid: &Grid, phasors: &[Complex64]) -> Heights {
        if grid.waves.is_empty() {
            let heights = grid.units.iter().map(|&unit| self.sum(phasors, unit)[0]);
            return Heights::new(heights.collect());
        }
        let mut heights = vec![0.0; grid.units.len()];
        vectorised(
            #[inline(always)]
            || {
                for (k, out) in heights.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
                    *out = grid.lanes(phasors, k);
                }
            },
        );
        Heights::new(heights)
    }

    /// The square of a vector's length at the points of a grid.
    fn squares(&self, grid: &Grid, x: &[Complex64], y: &[Complex64]) -> Heights {
        if grid.waves.is_empty() {
            let squares = grid.units.iter().map(|&unit| self.squared_length(x, y, unit)[0]);
            return Heights::new(squares.collect());
        }
        let mut squares = vec![0.0; grid.units.len()];
        vectorised(
            #[inline(always)]
            || {
                for (k, out) in squares.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
                    let (x, y) = (grid.lanes(x, k), grid.lanes(y, k));
                    for i in 0..LANES {
                        out[i] = x[i] * x[i] + y[i] * y[i];
                    }
                }
            },
        );
        Heights::new(squares)
    }

    /// The square of a vector's length, and its derivatives.
    fn squared_length(&self, x: &[Complex64], y: &[Complex64], unit: Complex64) -> Jet {
        let [x, y] = self.sums([x, y], unit);
        [
            x[0] * x[0] + y[0] * y[0],
            2.0 * (x[0] * x[1] + y[0] * y[1]),
            2.0 * (x[1] * x[1] + x[0] * x[2] + y[1] * y[1] + y[0] * y[2]),
        ]
    }

    /// The sum's real part and its two derivatives where `e^{iθ}` is given.
    fn sum(&self, phasors: &[Complex64], unit: Complex64) -> Jet {
        let [jet] = self.sums([phasors], unit);
        jet
    }

    /// [`Self::sum`] of several rows of phasors.
    #[inline]
    fn sums<const N: usize>(&self, rows: [&[Complex64]; N], unit: Complex64) -> [Jet; N] {
        let mut jets = [[0.0; 3]; N];
        let (mut power, mut at) = (Complex64::new(1.0, 0.0), 0);
        for (k, &wave) in self.waves.iter().enumerate() {
            // Ascending orders go from power to power; others start again.
            if wave < at {
                (power, at) = (Complex64::new(1.0, 0.0), 0);
            }
            let step = wave - at;
            power *= if step == 1 { unit } else { unit.powu(step) };
            at = wave;
            let n = f64::from(wave);
            for (jet, phasors) in jets.iter_mut().zip(rows) {
                let term = phasors[k] * power;
                jet[0] += term.re;
                jet[1] -= n * term.im;
                jet[2] -= n * n * term.re;
            }
        }
        jets
    }

    /// Largest value over the circle, or `known` if that is larger, given the values at the points of
    /// the grid.
    fn peak(
        grid: &Grid,
        heights: &Heights,
        bounds: Bounds,
        known: f64,
        at: &impl Fn(Complex64) -> Jet,
    ) -> f64 {
        let Heights { values: heights, highest, .. } = heights;
        let step = TAU / heights.len() as f64;
        // The mean is zero or more, and so is the highest.
        let negligible = 0.25 * f64::EPSILON * highest;
        let mut best = highest.max(known);
        let may_hold_more = |interval: &Interval, best: f64| {
            let ceiling = bounds.ceiling(interval);
            ceiling - interval.highest_end() > negligible && ceiling > best
        };
        // Slopes are evaluated only where values leave room for a peak.
        let most_hidden = bounds.hidden_in_bracket(step).max(step.powi(3) / 12.0 * bounds.third);
        let mut jets: [Option<(usize, Jet)>; 2] = [None; 2];
        let mut jet = |end: usize, k: usize| {
            let known = jets.iter().flatten().find(|(place, _)| *place == k).map(|(_, jet)| *jet);
            let found = known.unwrap_or_else(|| at(grid.units[k]));
            jets[end] = Some((k, found));
            found
        };
        let mut rest = Vec::new();
        let mut look = |k: usize| {
            let ends = [jet(0, k), jet(1, if k + 1 == heights.len() { 0 } else { k + 1 })];
            let interval = Interval { from: k as f64 * step, width: step, ends };
            if may_hold_more(&interval, best) {
                rest.push(interval);
            }
        };
        let needed = if most_hidden > negligible { best - most_hidden } else { f64::INFINITY };
        let mut looked = 0;
        for (part, lanes) in heights.as_chunks::<LANES>().0.iter().enumerate() {
            // Most lanes have no point that is high enough.
            if lanes.iter().map(|&height| u32::from(height > needed)).sum::<u32>() == 0 {
                continue;
            }
            for k in (part * LANES..).take(LANES).filter(|&k| heights[k] > needed) {
                (k.saturating_sub(1).max(looked)..=k).for_each(&mut look);
                looked = k + 1;
            }
        }
        if heights[0] > needed && looked < heights.len() {
            look(heights.len() - 1);
        }
        // The last is the first to be looked at: a peak found rules out others.
        rest.sort_by(|a, b| {
            let peaks = a.rises_then_falls().cmp(&b.rises_then_falls());
            peaks.then_with(|| a.highest_end().total_cmp(&b.highest_end()))
        });
        while let Some(interval) = rest.pop() {
            best = best.max(interval.highest_end());
            if !may_hold_more(&interval, best) {
                continue;
            }
            let last = interval.width <= step / MOST_PARTS;
            if interval.rises_then_falls() && (last || bounds.bends_down(&interval)) {
                best = best.max(interval.polish(at));
            } else if !last {
                let mut halves = interval.halve(at);
                halves.sort_by_key(Interval::rises_then_falls);
                rest.extend(halves);
            }
        }
        best
    }
}

/// Values at the points of a grid.
struct Heights {
    values: Vec<f64>,
    lowest: f64,
    highest: f64,
}

impl Heights {
    fn new(values: Vec<f64>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
        // Side by side: one after the other each comparison would wait for the one before.
        let (parts, _) = values.as_chunks::<LANES>();
        vectorised(
            #[inline(always)]
            || {
                for part in parts {
                    for i in 0..LANES {
                        low[i] = if part[i] < low[i] { part[i] } else { low[i] };
                        high[i] = if part[i] > high[i] { part[i] } else { high[i] };
                    }
                }
            },
        );
        let lowest = low.into_iter().fold(f64::INFINITY, f64::min);
        let highest = high.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self { values, lowest, highest }
    }

    fn negate(&mut self) {
        for value in &mut self.values {
            *value = -*value;
        }
        (self.lowest, self.highest) = (-self.highest, -self.lowest);
    }
}

/// Bounds on the derivatives of a sum.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    second: f64,
    third: f64,
}

impl Bounds {
    /// From the values at the points of a grid, and from waves and their amplitudes.
    ///
    /// By Bernstein's inequality each derivative is within the degree times the one before, the first
    /// within the degree times half of what lies between the extremes. Where high waves are small, the
    /// sum of the amplitudes' derivatives is less.
    fn new(heights: &Heights, terms: impl Iterator<Item = (u32, f64)>) -> Self {
        let degree = (heights.values.len() / POINTS_PER_WAVE) as f64;
        let excursion = EXCURSION_OVER_SAMPLED * (heights.highest - heights.lowest);
        let (mut second, mut third) = (0.0, 0.0);
        for (wave, amplitude) in terms {
            let n = f64::from(wave);
            second += n * n * amplitude;
            third += n * n * n * amplitude;
        }
        Self {
            second: second.min(degree.powi(2) * excursion),
            third: third.min(degree.powi(3) * excursion),
        }
    }

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
    ends: [Jet; 2],
}

impl Interval {
    fn highest_end(&self) -> f64 {
        self.ends[0][0].max(self.ends[1][0])
    }

    fn rises_then_falls(&self) -> bool {
        self.ends[0][1] > 0.0 && self.ends[1][1] < 0.0
    }

    fn halve(&self, at: &impl Fn(Complex64) -> Jet) -> [Self; 2] {
        let width = 0.5 * self.width;
        let middle = at(Complex64::cis(self.from + width));
        [
            Self { from: self.from, width, ends: [self.ends[0], middle] },
            Self { from: self.from + width, width, ends: [middle, self.ends[1]] },
        ]
    }

    /// Height of the maximum between the ends: Newton's method on the slope, from where a straight line
    /// of slopes is zero; bisection where that would leave the bracket or the top.
    fn polish(&self, at: &impl Fn(Complex64) -> Jet) -> f64 {
        let (mut low, mut high) = (self.from, self.from + self.width);
        let mut best = self.highest_end();
        let [rise, fall] = [self.ends[0][1], self.ends[1][1]];
        let mut here = self.from + self.width * (rise / (rise - fall));
        for _ in 0..60 {
            let [value, slope, bend] = at(Complex64::cis(here));
            best = best.max(value);
            if slope > 0.0 {
                low = here;
            } else {
                high = here;
            }
            let newton = here - slope / bend;
            // Where it bends upwards Newton's method goes to a dip.
            let next = if bend < 0.0 && (low..=high).contains(&newton) {
                // The parabola's top is right to rounding where its steps are so short that what it
                // lacks, of the third power, is.
                if (newton - here).abs() <= 3e-6 * self.width {
                    best = best.max(value - 0.5 * slope * slope / bend);
                    break;
                }
                newton
            } else {
                f64::midpoint(low, high)
            };
            // The value has no slope at the top: 1e-9 of the width off it is right to rounding.
            if (next - here).abs() <= 1e-9 * self.width {
                break;
            }
            here = next;
        }
        best
    }
}

impl Grid {
    /// A sum's real part at the points of the k-th lanes.
    #[inline(always)]
    fn lanes(&self, phasors: &[Complex64], k: usize) -> [f64; LANES] {
        let mut heights = [0.0; LANES];
        for ([cos, sin], phasor) in self.waves.iter().zip(phasors) {
            let (cos, sin) = (&cos.as_chunks::<LANES>().0[k], &sin.as_chunks::<LANES>().0[k]);
            for i in 0..LANES {
                heights[i] += phasor.re * cos[i] - phasor.im * sin[i];
            }
        }
        heights
    }

    fn new(points: usize, waves: &[u32]) -> Self {
        let units: Vec<Complex64> =
            (0..points).map(|k| Complex64::cis(k as f64 * TAU / points as f64)).collect();
        if points * waves.len() > MOST_WAVE_VALUES {
            return Self { units, waves: Vec::new() };
        }
        let wave = |&n: &u32| {
            let turned = (0..points).map(|k| units[k * n as usize % points]);
            let (cos, sin) = turned.map(|unit| (unit.re, unit.im)).unzip();
            [cos, sin]
        };
        let waves = waves.iter().map(wave).collect();
        Self { units, waves }
    }
}

#[cfg(test)]
mod tests;
