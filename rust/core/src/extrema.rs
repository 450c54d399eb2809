//! The true peak of a sum of orders: the largest magnitude of a trigonometric polynomial.
//!
//! Samples alone miss it by up to 1 − cos(nh/2). Here intervals of a grid of sixteen points to the
//! shortest wave are halved until bounds of the derivatives rule them out, or show that they hold one
//! peak, which Newton's method polishes.

use std::f64::consts::TAU;

use crate::Complex64;
use crate::order::Order;
use crate::rational::divisor;
use crate::simd::vectorised;

/// Grid points to the shortest wave.
const POINTS_PER_WAVE: usize = 16;
/// Parts of a step of the grid in which what could be hidden is below 1e-13 of the peak.
const MOST_PARTS: f64 = 4096.0;
/// A polynomial falls from an extreme by 1 − cos nθ of its excursion at most (M. Riesz), and the nearest
/// of the grid is half a step off: 1/(2 cos(π/16)), rounded up.
const EXCURSION_OVER_SAMPLED: f64 = 0.51;

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
        heights.iter_mut().for_each(|height| *height = -*height);
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
        let mut heights = self.heights(&self.quadratic, x);
        let across = self.heights(&self.quadratic, y);
        heights.iter_mut().zip(across).for_each(|(x, y)| *x = *x * *x + y * y);
        let bounds = Bounds::new(&heights, self.squared_terms(x, y).into_iter());
        let squared = |unit| self.squared_length(x, y, unit);
        Self::peak(&self.quadratic, &heights, bounds, 0.0, &squared).sqrt()
    }

    /// Waves of a vector's squared length and their amplitudes.
    ///
    /// Of x + iy = Σ vⱼ e^{ijθ} it has order d from every two terms that are d apart.
    fn squared_terms(&self, x: &[Complex64], y: &[Complex64]) -> Vec<(u32, f64)> {
        let i = Complex64::i();
        let highest = self.waves.iter().copied().max().unwrap_or(0) as usize;
        let parts = self.waves.iter().zip(x).zip(y).flat_map(|((&wave, x), y)| {
            let (forward, backward) = (0.5 * (x + i * y), 0.5 * (x.conj() + i * y.conj()));
            [(i64::from(wave), forward), (-i64::from(wave), backward)]
        });
        let parts: Vec<_> = parts.filter(|(_, part)| *part != Complex64::default()).collect();
        let mut terms = vec![Complex64::default(); 2 * highest + 1];
        for (k, (wave, part)) in parts.iter().enumerate() {
            for (other, of_other) in &parts[k + 1..] {
                let (above, below) =
                    if wave > other { (part, of_other) } else { (of_other, part) };
                terms[wave.abs_diff(*other) as usize] += above * below.conj();
            }
        }
        // Their squares are within range: a tenth of what `norm` takes.
        (0..).zip(&terms).map(|(wave, term)| (wave, 2.0 * term.norm_sqr().sqrt())).collect()
    }

    /// The sum's real part at the points of a grid.
    fn heights(&self, grid: &Grid, phasors: &[Complex64]) -> Vec<f64> {
        if grid.waves.is_empty() {
            return grid.units.iter().map(|&unit| self.sum(phasors, unit)[0]).collect();
        }
        let mut heights = vec![0.0; grid.units.len()];
        vectorised(
            #[inline(always)]
            || {
                for ([cos, sin], phasor) in grid.waves.iter().zip(phasors) {
                    for ((height, cos), sin) in heights.iter_mut().zip(cos).zip(sin) {
                        *height += phasor.re * cos - phasor.im * sin;
                    }
                }
            },
        );
        heights
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
        heights: &[f64],
        bounds: Bounds,
        known: f64,
        at: &impl Fn(Complex64) -> Jet,
    ) -> f64 {
        let step = TAU / heights.len() as f64;
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // The mean is zero or more, and so is the highest.
        let negligible = 0.25 * f64::EPSILON * highest;
        let mut best = highest.max(known);
        let may_hold_more = |interval: &Interval, best: f64| {
            let hidden = bounds.hidden(interval);
            hidden > negligible && interval.highest_end() + hidden > best
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
        for (k, &height) in heights.iter().enumerate() {
            let next = if k + 1 == heights.len() { 0 } else { k + 1 };
            if height.max(heights[next]) + most_hidden > best && most_hidden > negligible {
                let ends = [jet(0, k), jet(1, next)];
                let interval = Interval { from: k as f64 * step, width: step, ends };
                if may_hold_more(&interval, best) {
                    rest.push(interval);
                }
            }
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
    fn new(heights: &[f64], terms: impl Iterator<Item = (u32, f64)>) -> Self {
        let degree = (heights.len() / POINTS_PER_WAVE) as f64;
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let excursion = EXCURSION_OVER_SAMPLED * (highest - lowest);
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

    /// How far the sum may rise above both ends.
    fn hidden(&self, interval: &Interval) -> f64 {
        if interval.rises_then_falls() {
            return self.hidden_in_bracket(interval.width);
        }
        // It rises from a dip to a peak: between two zeros of the slope, by the third derivative.
        interval.width.powi(3) / 12.0 * self.third
    }

    /// The same where it rises at one end and falls at the other, from one peak to the nearer end by
    /// the second derivative.
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
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn finder(orders: &[u32]) -> PeakFinder {
        PeakFinder::new(&Order::all_whole(orders).unwrap())
    }

    fn sampled(orders: &[u32], phasors: &[Complex64], points: usize) -> f64 {
        let at = |k: usize| {
            let θ = k as f64 * TAU / points as f64;
            let term = |(&n, p): (&u32, &Complex64)| (p * Complex64::cis(f64::from(n) * θ)).re;
            orders.iter().zip(phasors).map(term).sum::<f64>().abs()
        };
        (0..points).map(at).fold(0.0, f64::max)
    }

    #[test]
    fn one_order_peaks_at_its_magnitude() {
        let finder = finder(&[3]);
        let p = Complex64::new(3.0, -4.0);
        // 16 roundings of half a unit at most
        assert!((finder.along_axis(&[p]) - 5.0).abs() < 1e-14);
        let i = Complex64::i();
        assert!((finder.of_vector(&[p], &[-i * p]) - 5.0).abs() < 1e-14);
        assert_eq!(finder.along_axis(&[Complex64::default()]), 0.0);
    }

    #[test]
    fn a_flat_maximum_is_found() {
        // cos θ − cos 2θ / 4 has T'' = 0 at θ = 0
        let finder = finder(&[1, 2]);
        let phasors = [Complex64::new(1.0, 0.0), Complex64::new(-0.25, 0.0)];
        // its largest magnitude is at θ = π
        assert!((finder.along_axis(&phasors) - 1.25).abs() < 1e-15);
        let quartic = [Complex64::new(4.0 / 3.0, 0.0), Complex64::new(-1.0 / 3.0, 0.0)];
        assert!((finder.of_vector(&quartic, &[Complex64::default(); 2]) - 5.0 / 3.0).abs() < 1e-14);
    }

    #[test]
    fn vectors_are_longest_where_samples_are() {
        let orders = [1, 2, 5];
        let parts = |a: f64| {
            orders.map(|n| Complex64::new((a * f64::from(n)).sin(), (a + f64::from(n * n)).cos()))
        };
        for k in 0..20 {
            let (x, y) = (parts(0.37 * f64::from(k)), parts(1.0 + 0.61 * f64::from(k)));
            let length = |sample: u32| {
                let θ = f64::from(sample) * TAU / 20_000.0;
                let along = |phasors: &[Complex64; 3]| -> f64 {
                    let terms = orders.iter().zip(phasors);
                    terms.map(|(&n, p)| (p * Complex64::cis(f64::from(n) * θ)).re).sum()
                };
                along(&x).hypot(along(&y))
            };
            let dense = (0..20_000).map(length).fold(0.0, f64::max);
            // Large and small vectors alike: they are scaled.
            for scale in [1.0, 1e-200, 1e200] {
                let scaled = |phasors: [Complex64; 3]| phasors.map(|p| p * scale);
                let peak = finder(&orders).of_vector(&scaled(x), &scaled(y)) / scale;
                // Rounding of twelve terms; half a step of 20 000 at order 5, of a length below 5.
                assert!(dense <= peak + 1e-13 && peak <= dense + 2e-6, "{dense} {peak}");
            }
        }
        assert_eq!(finder(&orders).of_vector(&parts(0.0).map(|p| p * 0.0), &[]), 0.0);
    }

    #[test]
    fn derivatives_are_those_of_the_sum() {
        // Not in ascending order, and with a common factor that is left out.
        let finder = finder(&[4, 6, 8, 2]);
        let phasors = |a: f64| {
            [1.0, 2.0, 3.0, 4.0].map(|k| Complex64::new((a * k).sin() + 0.1, (a + k * k).cos()))
        };
        let (x, y) = (phasors(0.7), phasors(1.9));
        for k in 0..10 {
            let θ = 0.6 * f64::from(k);
            let along = |θ: f64| finder.sum(&x, Complex64::cis(θ));
            let squared = |θ: f64| finder.squared_length(&x, &y, Complex64::cis(θ));
            let waves = [2.0, 3.0, 4.0, 1.0].iter().zip(&x);
            let value: f64 = waves.map(|(n, p)| (p * Complex64::cis(n * θ)).re).sum();
            assert!((along(θ)[0] - value).abs() < 1e-14);
            let other = finder.sum(&y, Complex64::cis(θ))[0];
            assert!((squared(θ)[0] - (value * value + other * other)).abs() < 1e-13);
            for jet in [&along as &dyn Fn(f64) -> Jet, &squared] {
                let (before, here, after) = (jet(θ - 1e-5), jet(θ), jet(θ + 1e-5));
                for order in 1..3 {
                    let slope = (after[order - 1] - before[order - 1]) / 2e-5;
                    // A sixth of 1e-10 of a fourth derivative below 8⁴·50, and rounding over 1e-5.
                    assert!((here[order] - slope).abs() < 1e-5, "{order} {θ}");
                }
            }
        }
    }

    /// cos θ − (1 + s)/9 cos 3θ has two peaks either side of a dip, a good √s apart, where s = 0 has one
    /// without second derivative; some sin θ makes one of them higher.
    #[test]
    fn of_two_peaks_close_together_the_higher_counts() {
        let finder = finder(&[1, 3]);
        for (exponent, tilt) in (0..16).flat_map(|k| [(k, 0.0), (k, 0.2), (k, -0.2)]) {
            let s = 0.5_f64.powi(exponent);
            let c = -(1.0 + s) / 9.0;
            let tilt = tilt * s.powf(1.5);
            let at = |θ: f64| θ.cos() + c * (3.0 * θ).cos() + tilt * θ.sin();
            // 2e-4 of the distance between the peaks, which cover ±√s: half a step's square is 1e-8 s
            // of a second derivative below 3s.
            let near = |k: i32| at(f64::from(k) * 1e-4 * s.sqrt());
            let peak = (-15_000..=15_000).map(near).fold(0.0, f64::max);
            for k in 0..24 {
                // Wherever they lie between points of the grid, also in the middle of two, in any unit.
                let turn = f64::from(k) * TAU / 48.0 / 24.0;
                let unit = [1.0, 1e-9, 1e9][k as usize % 3];
                let first = Complex64::new(1.0, -tilt) * Complex64::cis(turn);
                let phasors = [first, c * Complex64::cis(3.0 * turn)].map(|p| p * unit);
                let vector = finder.of_vector(&phasors, &[Complex64::default(); 2]);
                for found in [finder.along_axis(&phasors), vector] {
                    let apart = found / unit - peak;
                    // A few roundings of three terms; the samples miss the peak.
                    let allowed = -2e-15..=2e-15 + 1e-8 * s * s;
                    assert!(allowed.contains(&apart), "{s} {tilt} {k}: {apart:e}");
                }
            }
        }
    }

    #[test]
    fn high_orders_peak_where_they_meet() {
        let finder = finder(&[999, 1000]);
        for k in 0..40 {
            let at = 0.151 * f64::from(k);
            let phasors = [999.0, 1000.0].map(|n| Complex64::cis(-n * at));
            // The thousandth power of e^{iθ} has a thousand times its rounding.
            let peak = finder.along_axis(&phasors);
            assert!((peak - 2.0).abs() < 5e-13, "{k}: {peak}");
        }
    }

    /// Besides the heights at the points of the grid, on average: a few steps of Newton's method for each peak that may be the highest,
    /// and what rules out the rest. No bound of anything but time.
    #[test]
    fn few_values_are_needed() {
        let calls = std::cell::Cell::new(0);
        // Means of fifty sums, as measured: of a force's, and of a vector's squared length.
        let most = [(1_u32, [8, 16]), (2, [9, 11]), (5, [10, 13]), (12, [16, 18]), (40, [24, 20])];
        for (degree, most) in most {
            let orders: Vec<u32> = (1..=degree).collect();
            let finder = finder(&orders);
            calls.set(0);
            let (mut of_sums, mut of_vectors) = (0, 0);
            for k in 0..50 {
                let parts = |a: f64| -> Vec<Complex64> {
                    let part = |&n: &u32| {
                        let n = f64::from(n);
                        Complex64::new((a + 3.7 * n * n).sin(), (1.3 * a * n).cos()) / n
                    };
                    orders.iter().map(part).collect()
                };
                let (x, y) = (parts(0.7 + 1.1 * f64::from(k)), parts(5.1 + 0.3 * f64::from(k)));
                let counted = |jet: Jet| {
                    calls.set(calls.get() + 1);
                    jet
                };
                let along = |unit| counted(finder.sum(&x, unit));
                let heights = finder.heights(&finder.linear, &x);
                let norms = finder.waves.iter().zip(&x).map(|(&n, p)| (n, p.norm()));
                let bounds = Bounds::new(&heights, norms);
                PeakFinder::peak(&finder.linear, &heights, bounds, 0.0, &along);
                of_sums += calls.replace(0);
                let squared = |unit| counted(finder.squared_length(&x, &y, unit));
                let both = [&x, &y].map(|phasors| finder.heights(&finder.quadratic, phasors));
                let squares = both[0].iter().zip(&both[1]).map(|(x, y)| x * x + y * y);
                let heights: Vec<f64> = squares.collect();
                let bounds = Bounds::new(&heights, finder.squared_terms(&x, &y).into_iter());
                PeakFinder::peak(&finder.quadratic, &heights, bounds, 0.0, &squared);
                of_vectors += calls.replace(0);
            }
            let mean = [of_sums, of_vectors].map(|calls| calls.div_ceil(50));
            assert!(mean.iter().zip(most).all(|(mean, most)| *mean <= most), "{degree}: {mean:?}");
        }
    }

    #[test]
    fn a_dip_is_not_taken_for_a_peak() {
        // −(θ² − 1/100)² between −1/4 and 1/4, where the slope in the middle is exactly zero.
        let hump = |unit: Complex64| {
            let θ = unit.arg();
            let rest = θ * θ - 0.01;
            [-rest * rest, -4.0 * θ * rest, -4.0 * (rest + 2.0 * θ * θ)]
        };
        let ends = [hump(Complex64::cis(-0.25)), hump(Complex64::cis(0.25))];
        let interval = Interval { from: -0.25, width: 0.5, ends };
        assert!(interval.rises_then_falls());
        let peak = interval.polish(&hump);
        // The peak is zero, the dip −1e-4; 1e-9 of the width off the top is its square.
        assert!((-1e-17..=0.0).contains(&peak), "{peak}");
    }

    #[test]
    fn orders_in_any_order_and_with_a_common_factor() {
        let phasors = [1.0, 0.7, -0.4].map(|re| Complex64::new(re, 0.3 * re * re));
        let [a, b, c] = phasors;
        let peak = finder(&[2, 6, 8]).along_axis(&phasors);
        assert!((finder(&[8, 2, 6]).along_axis(&[c, a, b]) - peak).abs() < 1e-14);
        assert!((finder(&[1, 3, 4]).along_axis(&phasors) - peak).abs() < 1e-14);
        assert!((sampled(&[2, 6, 8], &phasors, 20_000) - peak).abs() < 1e-5);
    }

    proptest! {
        #[test]
        fn no_sample_is_higher_and_a_dense_one_as_high(
            orders in proptest::sample::subsequence((1_u32..12).collect::<Vec<_>>(), 1..6),
            parts in proptest::collection::vec((-1.0..1.0, -1.0..1.0), 6),
        ) {
            let phasors: Vec<_> =
                orders.iter().zip(&parts).map(|(_, &(re, im))| Complex64::new(re, im)).collect();
            let peak = finder(&orders).along_axis(&phasors);
            let dense = sampled(&orders, &phasors, 20_000);
            let size: f64 = phasors.iter().map(|p| p.norm()).sum();
            // rounding of six terms, and of θ·n at the samples
            prop_assert!(dense <= peak + 1e-13 * size);
            // half a step of 20 000 at order 11: (11·1.6e-4)²/2 = 1.5e-6 of the size
            prop_assert!(peak <= dense + 2e-6 * size);
        }
    }
}
