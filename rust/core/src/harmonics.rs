//! The slider-crank's harmonics: every order exact, for any rod ratio below 1 and any offset.
//!
//! The inertia force of a piston is `m r ω² Re Σ aₙ e^{in(θ − tdc)}`; this file gives `aₙ`, and
//! the harmonics of the roll torque. With A = (l + e)/r and B = (l − e)/r the height of the rod,
//! √((A − sin θ)(B + sin θ)), factors into
//! `√((1 + p₁w)(1 − p₂w)) · √((1 + p₁/w)(1 − p₂/w)) / (2√(p₁p₂))` with w = i e^{iθ},
//! p₁ = A − √(A² − 1) and p₂ = B − √(B² − 1). The first root is a power series Σ hₖwᵏ with a
//! two-term recurrence, and the coefficient of e^{inθ} is `iⁿ Σⱼ h_{j+n} hⱼ / (2√(p₁p₂))`: sums of
//! terms of one sign after the first, so that every order keeps its *relative* accuracy, where a
//! transform of samples loses high orders to the rounding of the low ones.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

use ndarray::{Array2, Axis, parallel::prelude::*};
use rayon::slice::ParallelSlice;

use crate::Complex64;
use crate::cancel::Cancel;
use crate::double::Double;
use crate::error::{Error, Result};
use crate::limits;
use crate::simd::vectorised;
use crate::slider_crank::Proportions;

/// Terms left out are below this part of the sum: under half a unit in the last place.
const NEGLIGIBLE_LOG: f64 = 38.0;
/// A series this long costs as much as the quadrature that replaces it near λ = 1.
const LONGEST_SERIES: f64 = 2000.0;
/// ... unless the order is so high that its coefficient has decayed, which the quadrature, exact
/// relative to the spike only, would not resolve.
const SERIES_TERMS_PER_ORDER: f64 = 4.0;
/// Up to this power repeated multiplication is within 2e-15.
const LARGEST_PLAIN_POWER: u32 = 15;

/// `aₙ` of the given orders: force along the bore over m·r·ω², as peak phasors.
#[must_use]
pub fn coefficients(proportions: &Proportions, orders: &[u32]) -> Vec<Complex64> {
    if proportions.offset == 0.0 {
        let centred = Centred::new(proportions);
        return orders.iter().map(|&n| Complex64::new(centred.coefficient(n), 0.0)).collect();
    }
    Offset::new(proportions).coefficients(orders)
}

/// Harmonics of the torques that the inertia force makes, over m·r²·ω², as peak phasors.
#[derive(Debug, Clone, PartialEq)]
pub struct TorqueHarmonics {
    /// Roll torque on the block about +z: `x''·(x' + e)` in crank radii.
    pub roll: Vec<Complex64>,
    /// Inertia torque on the crank: `−x''·x'`.
    pub crank: Vec<Complex64>,
}

/// Torque harmonics of the given orders, in closed form.
///
/// `x'' x'` is half the derivative of `x'²`. With `x' = h' − sin θ`, `x'² = sin²θ − 2 sin θ h' + h'²`,
/// where the middle term shifts the orders of h by one and `h'² = u²cos²θ/h²` is rational: its
/// partial fractions in sin θ have the geometric series in p₁ and p₂ as Fourier series.
#[must_use]
pub fn torque(proportions: &Proportions, orders: &[u32]) -> TorqueHarmonics {
    // Orders n − 1, n and n + 1 of the force, side by side.
    let around: Vec<u32> = orders.iter().flat_map(|&n| [n - 1, n, n + 1]).collect();
    let force = coefficients(proportions, &around.iter().map(|&n| n.max(1)).collect::<Vec<_>>());
    // Order n of h' from order n of the acceleration: h'ₙ = i n hₙ and aₙ = n² hₙ.
    let slope = |index: usize| -> Complex64 {
        let n = around[index];
        if n == 0 {
            return Complex64::default();
        }
        let of_crank = if n == 1 { 1.0 } else { 0.0 };
        Complex64::i() * (force[index] - of_crank) / f64::from(n)
    };
    let rational = RationalPart::new(proportions);
    let (mut roll, mut crank) = (Vec::new(), Vec::new());
    for (k, &n) in orders.iter().enumerate() {
        let shifted = Complex64::i() * (slope(3 * k) - slope(3 * k + 2));
        let of_sine = if n == 2 { -0.5 } else { 0.0 };
        let velocity_squared = shifted + rational.harmonic(n) + of_sine;
        let half_derivative = Complex64::i() * velocity_squared * (0.5 * f64::from(n));
        crank.push(-half_derivative);
        // x'' = −Σ aₙ e^{inθ}
        roll.push(half_derivative - force[3 * k + 1] * proportions.offset);
    }
    TorqueHarmonics { roll, crank }
}

/// `aₙ` without offset, real, for every rod ratio (rows) and order (columns).
pub fn centred_table(rod_ratios: &[f64], orders: &[u32], cancel: &Cancel) -> Result<Array2<f64>> {
    let mut table = checked_table::<f64>(rod_ratios.len(), orders)?;
    let longest = Horner::tables(orders);
    fill(&mut table, rod_ratios, cancel, |rod_ratios, rows| {
        centred_rows(rod_ratios, orders, &longest, rows)
    })?;
    Ok(table)
}

/// `aₙ` for every pair of rod ratio and offset over r (rows) and order (columns).
pub fn offset_table(
    rod_ratios: &[f64],
    offsets: &[f64],
    orders: &[u32],
    cancel: &Cancel,
) -> Result<Array2<Complex64>> {
    let mut table = checked_table::<Complex64>(rod_ratios.len(), orders)?;
    let pairs: Vec<(f64, f64)> = rod_ratios.iter().copied().zip(offsets.iter().copied()).collect();
    fill(&mut table, &pairs, cancel, |pairs, rows| {
        for (&(rod_ratio, offset), row) in pairs.iter().zip(rows.chunks_exact_mut(orders.len())) {
            row.copy_from_slice(&coefficients(&Proportions::new(rod_ratio, offset)?, orders));
        }
        Ok(())
    })?;
    Ok(table)
}

fn checked_table<T: Clone + Default>(rows: usize, orders: &[u32]) -> Result<Array2<T>> {
    limits::orders(orders)?;
    let cure = "split rod_ratio into parts";
    limits::result_size("rod_ratio", &[rows, orders.len()], size_of::<T>(), cure)?;
    Ok(Array2::default((rows, orders.len())))
}

/// Fill the rows of a table in parallel, chunk by chunk.
fn fill<I: Sync, T: Send + Sync>(
    table: &mut Array2<T>,
    inputs: &[I],
    cancel: &Cancel,
    rows: impl Fn(&[I], &mut [T]) -> Result<()> + Sync,
) -> Result<()> {
    const CHUNK: usize = 2048;
    if inputs.len() <= CHUNK {
        return rows(inputs, table.as_slice_mut().unwrap_or_default());
    }
    table
        .axis_chunks_iter_mut(Axis(0), CHUNK)
        .into_par_iter()
        .zip(inputs.par_chunks(CHUNK))
        .try_for_each(|(mut block, inputs)| {
            cancel.check()?;
            rows(inputs, block.as_slice_mut().unwrap_or_default())
        })
}

/// How many rod ratios go through a polynomial side by side.
const LANES: usize = 16;

/// The rows of a block of rod ratios, in lanes; a lane near λ = 1 goes by itself.
fn centred_rows(
    rod_ratios: &[f64],
    orders: &[u32],
    tables: &[Horner],
    rows: &mut [f64],
) -> Result<()> {
    for &rod_ratio in rod_ratios {
        if !(rod_ratio > 0.0 && rod_ratio < 1.0) {
            return Proportions::new(rod_ratio, 0.0).map(drop);
        }
    }
    let width = orders.len();
    vectorised(
        #[inline(always)]
        || {
            for (lanes, rows) in
                rod_ratios.chunks(LANES).zip(rows.chunks_mut(LANES * width))
            {
                if lanes.len() == LANES && lanes.iter().all(|&λ| λ <= Horner::LARGEST_ROD_RATIO) {
                    lanes_of_rows(lanes, orders, tables, rows);
                } else {
                    for (&λ, row) in lanes.iter().zip(rows.chunks_exact_mut(width)) {
                        let Ok(proportions) = Proportions::new(λ, 0.0) else { continue };
                        let centred = Centred::new(&proportions);
                        for (&n, value) in orders.iter().zip(row) {
                            *value = centred.coefficient(n);
                        }
                    }
                }
            }
        },
    );
    Ok(())
}

#[inline(always)]
fn lanes_of_rows(rod_ratios: &[f64], orders: &[u32], tables: &[Horner], rows: &mut [f64]) {
    let width = orders.len();
    let mut p = [0.0; LANES];
    for (p, &λ) in p.iter_mut().zip(rod_ratios) {
        *p = λ / (1.0 + ((1.0 - λ) * (1.0 + λ)).sqrt());
    }
    let square = p.map(|p| p * p);
    let fourth = square.map(|s| s * s);
    let largest = fourth.iter().fold(0.0, |a: f64, &b| a.max(b));
    for (column, (&n, table)) in orders.iter().zip(tables).enumerate() {
        if n == 1 || n % 2 == 1 {
            let value = if n == 1 { 1.0 } else { 0.0 };
            rows.iter_mut().skip(column).step_by(width).for_each(|v| *v = value);
            continue;
        }
        let mut sum = [0.0; LANES];
        for &t in table.terms[..table.needed(largest)].iter().rev() {
            for lane in 0..LANES {
                sum[lane] = (sum[lane] + t) * fourth[lane];
            }
        }
        let mut power = p;
        if n - 1 <= LARGEST_PLAIN_POWER {
            for _ in 1..n / 2 {
                for lane in 0..LANES {
                    power[lane] *= square[lane];
                }
            }
        } else {
            for lane in 0..LANES {
                let Ok(proportions) = Proportions::new(rod_ratios[lane], 0.0) else { continue };
                power[lane] = Root::new(proportions.above).power(n - 1);
            }
        }
        for lane in 0..LANES {
            rows[lane * width + column] = table.leading * power[lane] * (1.0 - sum[lane]);
        }
    }
}

/// The polynomial in p⁴ that belongs to one even order.
struct Horner {
    /// ±n²·|b_m|, with b the coefficients of √(1 − x) and n = 2m.
    leading: f64,
    /// |b_j| b_{j+m} / b_m for j = 1, 2, …
    terms: Vec<f64>,
}

impl Horner {
    /// Rod ratios up to here take at most as many terms as a table holds.
    const LARGEST_ROD_RATIO: f64 = 0.9;
    /// p⁴ there: p = 0.62678…
    const LARGEST_FOURTH: f64 = 0.155;

    fn tables(orders: &[u32]) -> Vec<Self> {
        let count = (NEGLIGIBLE_LOG / -Self::LARGEST_FOURTH.ln()).ceil() as usize;
        orders.iter().map(|&n| Self::new(n, count)).collect()
    }

    fn new(n: u32, count: usize) -> Self {
        let m = f64::from(n / 2);
        let mut term = 0.5 * (m - 0.5) / (m + 1.0);
        let mut terms = Vec::with_capacity(count);
        for j in 1..=count {
            terms.push(term);
            term *= next_term(j as f64, m);
        }
        Self { leading: leading(n), terms }
    }

    /// How many terms matter for a given p⁴.
    #[inline(always)]
    fn needed(&self, fourth: f64) -> usize {
        let count = (NEGLIGIBLE_LOG / -fourth.ln()).ceil();
        (count as usize).min(self.terms.len())
    }
}

/// Ratio of term j + 1 to term j.
#[inline(always)]
fn next_term(j: f64, m: f64) -> f64 {
    ((j - 0.5) * (j + m - 0.5)) / ((j + 1.0) * (j + m + 1.0))
}

/// (−1)^{m+1} n² |b_m|, n = 2m.
fn leading(n: u32) -> f64 {
    let m = n / 2;
    let mut b = 0.5;
    for k in 1..m {
        b *= (f64::from(k) - 0.5) / f64::from(k + 1);
    }
    let sign = if m % 2 == 1 { 1.0 } else { -1.0 };
    sign * f64::from(n).powi(2) * b
}

/// p = a − √(a² − 1) for a = 1 + reach.
#[derive(Clone, Copy)]
struct Root {
    /// The double next to it, within a few units.
    p: f64,
    /// What is missing, relative to p.
    correction: f64,
    /// √(a² − 1).
    root: f64,
}

impl Root {
    fn new(reach: Double) -> Self {
        let g = reach.high;
        let root = (g * (2.0 + g)).sqrt();
        let p = 1.0 / (1.0 + g + root);
        // Residual of p² − 2(1 + g)p + 1 to twice the digits, and a step of Newton's method.
        let (cross, square) = (Double::product(-2.0 * g, p), Double::product(p, p));
        let residual = Double::sum(1.0, cross.high)
            .plus(-2.0 * p)
            .plus(square.high)
            .plus(cross.low + square.low - 2.0 * reach.low * p);
        Self { p, correction: residual.high / (2.0 * root * p), root }
    }

    /// pⁿ: the library's power is right to half a unit, the rounding of p is taken out.
    fn power(&self, n: u32) -> f64 {
        self.p.powf(f64::from(n)) * (1.0 + f64::from(n) * self.correction)
    }
}

/// A slider-crank without offset: p₁ = p₂ = p, odd orders vanish, even ones are
/// `±n²|b_m| p^{n−1} (1 − Σⱼ |b_j| b_{j+m}/b_m p^{4j})`.
struct Centred {
    root: Root,
    reach: f64,
    fourth: f64,
}

impl Centred {
    fn new(proportions: &Proportions) -> Self {
        let root = Root::new(proportions.above);
        Self { root, reach: proportions.above.high, fourth: root.p.powi(4) }
    }

    fn coefficient(&self, n: u32) -> f64 {
        if n % 2 == 1 {
            return if n == 1 { 1.0 } else { 0.0 };
        }
        let count = (NEGLIGIBLE_LOG / -self.fourth.ln()).ceil();
        if count > LONGEST_SERIES && count > SERIES_TERMS_PER_ORDER * f64::from(n) {
            let reach = self.reach;
            return spike_integral(reach, reach, 0.0, n) * if n % 4 == 0 { 1.0 } else { -1.0 };
        }
        let m = f64::from(n / 2);
        let mut term = 0.5 * (m - 0.5) / (m + 1.0) * self.fourth;
        let mut sum = 0.0;
        let mut j = 1.0;
        while term > sum * f64::EPSILON / 16.0 {
            sum += term;
            term *= next_term(j, m) * self.fourth;
            j += 1.0;
        }
        leading(n) * self.root.power(n - 1) * (1.0 - sum)
    }
}

/// A slider-crank with an offset: all orders, the odd ones as sines.
struct Offset {
    /// |e|/r, with `above` ≥ `below`; a negative offset mirrors the motion in time.
    offset: f64,
    mirrored: bool,
    above: Double,
    below: Double,
}

impl Offset {
    fn new(proportions: &Proportions) -> Self {
        let Proportions { offset, above, below, .. } = *proportions;
        let mirrored = offset < 0.0;
        let (above, below) = if mirrored { (below, above) } else { (above, below) };
        Self { offset: offset.abs(), mirrored, above, below }
    }

    fn coefficients(&self, orders: &[u32]) -> Vec<Complex64> {
        let highest = orders.iter().copied().max().unwrap_or(1);
        let roots = Roots::new(self.offset, self.above, self.below);
        let count = NEGLIGIBLE_LOG / (-2.0 * roots.p2.ln());
        let by_quadrature = |n: u32| {
            count > LONGEST_SERIES && count > SERIES_TERMS_PER_ORDER * f64::from(n)
        };
        let series = if orders.iter().all(|&n| by_quadrature(n)) {
            Vec::new()
        } else {
            roots.series(highest as usize + count.ceil() as usize + 1)
        };
        orders
            .iter()
            .map(|&n| {
                let magnitude = if by_quadrature(n) {
                    // The integral is over the angle from sin θ = 1: (−i)ⁿ for iⁿ.
                    let sign = if n % 2 == 1 { -1.0 } else { 1.0 };
                    sign * spike_integral(self.above.high, self.below.high, self.offset, n)
                } else {
                    let terms = series.len() - n as usize;
                    // From the smallest term up.
                    let tail: f64 =
                        (1..terms).rev().map(|j| series[j] * series[j + n as usize]).sum();
                    f64::from(n).powi(2) / roots.product.sqrt() * (series[n as usize] + tail)
                };
                self.turned(n, magnitude)
            })
            .collect()
    }

    /// iⁿ times a real magnitude, mirrored in time where the offset is negative, plus the crank.
    fn turned(&self, n: u32, magnitude: f64) -> Complex64 {
        let imaginary = if self.mirrored { -magnitude } else { magnitude };
        match n % 4 {
            0 => Complex64::new(magnitude, 0.0),
            1 => Complex64::new(if n == 1 { 1.0 } else { 0.0 }, imaginary),
            2 => Complex64::new(-magnitude, 0.0),
            _ => Complex64::new(0.0, -imaginary),
        }
    }
}

/// p₁, p₂ and what the recurrence needs of them.
struct Roots {
    p1: f64,
    p2: f64,
    /// p₁p₂.
    product: f64,
    /// p₁ − p₂, which for small offsets the difference would lose.
    difference: f64,
}

impl Roots {
    fn new(offset: f64, above: Double, below: Double) -> Self {
        let (first, second) = (Root::new(above), Root::new(below));
        let (p1, p2) = (first.p, second.p);
        let rounded = Double::product(p1, p2);
        let correction = rounded.low + rounded.high * (first.correction + second.correction);
        let product = rounded.high + correction;
        // 2e/r = A − B = (p₁ − p₂)(1 − 1/p₁p₂)/2; near 1 the difference is lost, the roots are not.
        let difference = if product < 0.5 {
            -4.0 * offset * product / (1.0 - product)
        } else {
            -2.0 * offset * (p1 + p2) / (first.root + second.root)
        };
        Self { p1, p2, product, difference }
    }

    /// h₀ … h_{count − 1} of √((1 + p₁w)(1 − p₂w)): all below zero from h₁ on, since p₁ ≤ p₂, so
    /// that the recurrence adds terms of one sign.
    fn series(&self, count: usize) -> Vec<f64> {
        let mut h = Vec::with_capacity(count.max(2));
        h.extend([1.0, 0.5 * self.difference]);
        for k in 1..count.max(2) - 1 {
            let x = k as f64;
            let next = self.difference * (0.5 - x) * h[k] + self.product * (x - 2.0) * h[k - 1];
            h.push(next / (x + 1.0));
        }
        h
    }
}

/// `h'² = u²cos²θ/h²` as a Fourier series.
struct RationalPart {
    rod: f64,
    offset: f64,
    roots: Roots,
    mirrored: bool,
}

impl RationalPart {
    fn new(proportions: &Proportions) -> Self {
        let Offset { offset, mirrored, above, below } = Offset::new(proportions);
        Self { rod: proportions.rod, offset, roots: Roots::new(offset, above, below), mirrored }
    }

    /// Peak phasor of order n ≥ 1.
    ///
    /// h'² = −cos²θ + (l/2r)·(cos²θ/(A − sin θ) + cos²θ/(B + sin θ)), and cos²θ/(A − sin θ) =
    /// sin θ + A − (A² − 1)/(A − sin θ), whose order n ≥ 2 is −(1 − p₁²) p₁ⁿ⁻¹ (−i)ⁿ and whose
    /// order 1 is −i p₁²; the other fraction has p₂ and iⁿ.
    fn harmonic(&self, n: u32) -> Complex64 {
        let Roots { p1, p2, difference, .. } = self.roots;
        let power = |p: f64, k: u32| p.powf(f64::from(k));
        if n % 2 == 1 {
            if self.offset == 0.0 {
                return Complex64::default();
            }
            // Powers of p₂ less powers of p₁, with p₂ − p₁ taken out.
            let spread = |k: u32| -> f64 { (0..k).map(|i| power(p1, i) * power(p2, k - 1 - i)).sum() };
            let magnitude = if n == 1 {
                -0.5 * self.rod * difference * (p1 + p2)
            } else {
                0.5 * self.rod * difference * (spread(n - 1) - spread(n + 1))
            };
            let magnitude = if self.mirrored { -magnitude } else { magnitude };
            return Complex64::new(0.0, if n % 4 == 1 { magnitude } else { -magnitude });
        }
        let sum = (1.0 - p1 * p1) * power(p1, n - 1) + (1.0 - p2 * p2) * power(p2, n - 1);
        let fraction = 0.5 * self.rod * sum * if n % 4 == 0 { -1.0 } else { 1.0 };
        Complex64::new(if n == 2 { fraction - 0.5 } else { fraction }, 0.0)
    }
}

/// `(2/π)∫₀^π −h''(φ) cos nφ dφ` with φ the crank angle from sin θ = 1.
///
/// Near the crank that cannot turn, h'' is a spike as narrow as √(2·reach) at either end: panels
/// halve towards it, so that their number grows with the logarithm of its width only. Exact
/// relative to the spike's area; orders that have decayed below it are left to the series.
fn spike_integral(above: f64, below: f64, offset: f64, n: u32) -> f64 {
    let far_sign = if n % 2 == 1 { -1.0 } else { 1.0 };
    let rod = 1.0 + 0.5 * (above + below);
    let half = |near: f64, far: f64, offset: f64| {
        graded_panels((2.0 * near).sqrt(), f64::from(n), |φ| {
            let (sin, cos) = φ.sin_cos();
            let (half_sin, half_cos) = (0.5 * φ).sin_cos();
            let height_squared =
                (near + 2.0 * half_sin * half_sin) * (far + 2.0 * half_cos * half_cos);
            let lateral = cos - offset;
            let curvature = rod * rod * sin * sin / height_squared - lateral * cos;
            curvature / height_squared.sqrt() * (f64::from(n) * φ).cos()
        })
    };
    (half(above, below, offset) + far_sign * half(below, above, -offset)) * 2.0 / PI
}

/// Integral over [0, π/2] of a function with a spike of this width at 0 and waves of order n.
fn graded_panels(width: f64, n: f64, f: impl Fn(f64) -> f64) -> f64 {
    /// Radians of a wave that one panel of [`GAUSS`] resolves to rounding.
    const WAVE_PER_PANEL: f64 = 4.0;
    let mut edges = vec![FRAC_PI_2];
    while edges[edges.len() - 1] > 0.5 * width {
        edges.push(0.5 * edges[edges.len() - 1]);
    }
    edges.push(0.0);
    let mut sum = 0.0;
    // From the spike outwards.
    for pair in edges.windows(2).rev() {
        let parts = (n * (pair[0] - pair[1]) / WAVE_PER_PANEL).ceil().max(1.0);
        let half = 0.5 * (pair[0] - pair[1]) / parts;
        for part in 0..parts as usize {
            let middle = pair[1] + half * (2 * part + 1) as f64;
            sum += GAUSS.iter().map(|&(x, w)| w * f(half.mul_add(x, middle))).sum::<f64>() * half;
        }
    }
    sum
}

/// Nodes and weights of the 20-point Gauss-Legendre rule on [−1, 1].
static GAUSS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    const COUNT: u32 = 20;
    let legendre = |x: f64| {
        let (mut before, mut here) = (1.0, x);
        for k in 2..=COUNT {
            let k = f64::from(k);
            (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
        }
        (here, f64::from(COUNT) * (x * here - before) / (x * x - 1.0))
    };
    (0..COUNT)
        .map(|i| {
            let mut x = (PI * (f64::from(i) + 0.75) / (f64::from(COUNT) + 0.5)).cos();
            for _ in 0..8 {
                let (value, slope) = legendre(x);
                x -= value / slope;
            }
            let (_, slope) = legendre(x);
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
});

/// Bound of `Σ_{n > highest} |aₙ|`, what orders above `highest` can add to a force over m·r·ω².
///
/// |hₖ| ≤ p₂ᵏ: by the generating function (2 − √(1 − x))² the binomial coefficients of the two
/// roots convolve to 1 at most. Hence `|aₙ| ≤ n² p₂ⁿ / (√(p₁p₂) (1 − p₂²))`, summed as the second
/// derivative of a geometric series. `None` where p₂ is so near 1 that it overflows.
#[must_use]
pub fn tail_bound(proportions: &Proportions, highest: u32) -> Option<f64> {
    let Offset { offset, above, below, .. } = Offset::new(proportions);
    let Roots { p2: p, product, .. } = Roots::new(offset, above, below);
    let first = f64::from(highest + 1);
    let gap = 1.0 - p;
    // Σ_{n ≥ N} n² pⁿ = p^N (N²/g + 2Np/g² + p(1 + p)/g³), g = 1 − p.
    let sum = p.powf(first)
        * (first * first / gap + 2.0 * first * p / (gap * gap) + p * (1.0 + p) / gap.powi(3));
    let bound = sum / (product.sqrt() * (1.0 - p * p));
    bound.is_finite().then_some(bound)
}

/// The lowest order above which the rest of the force is below `tolerance` times m·r·ω².
pub fn highest_order(proportions: &Proportions, tolerance: f64) -> Result<u32> {
    let enough = |n: u32| tail_bound(proportions, n).is_some_and(|bound| bound <= tolerance);
    if !enough(limits::HIGHEST_ORDER) {
        let cure = format!(
            "more than {} orders would be needed at a rod ratio of {}; ask for exact kinematics or \
             a larger rtol",
            limits::HIGHEST_ORDER,
            1.0 / proportions.rod
        );
        return Err(Error::value("rtol", tolerance, cure));
    }
    let (mut low, mut high) = (0, limits::HIGHEST_ORDER);
    while low < high {
        let middle = u32::midpoint(low, high);
        if enough(middle) { high = middle } else { low = middle + 1 }
    }
    Ok(high.max(1))
}
