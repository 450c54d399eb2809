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

pub mod rod;
mod spike;
pub mod table;
pub mod torque;

use self::spike::spike_integral;
use crate::Complex64;
use crate::cancel::Cancel;
use crate::double::Double;
use crate::error::Result;
use crate::limits;
use crate::slider_crank::Proportions;

/// Terms left out are below this part of the sum: under half a unit in the last place.
const NEGLIGIBLE_LOG: f64 = 38.0;
/// A series this long costs as much as the quadrature that replaces it near λ = 1.
const LONGEST_SERIES: f64 = 2000.0;
/// ... unless the order is so high that its coefficient has decayed, which the quadrature, exact
/// relative to the spike only, would not resolve.
const SERIES_TERMS_PER_ORDER: f64 = 4.0;
/// With more terms than this their roundings would pass a few units in the last place.
const LONGEST_PLAIN_SERIES: f64 = 100.0;

/// With less slack an order may take hundreds of terms, or a quadrature.
pub(crate) const LITTLE_SLACK: f64 = 0.01;
/// What that is, in steps of some nanoseconds.
const MOST_STEPS: usize = 1 << 15;

/// The tolerance that leaves nothing out but what rounding loses anyway.
const ALL_DIGITS: f64 = 0.0;

/// `aₙ` of the given orders: force along the bore over m·r·ω², as peak phasors.
pub fn coefficients(
    proportions: &Proportions,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<Vec<Complex64>> {
    if proportions.offset == 0.0 {
        let centred = Centred::new(proportions);
        return each(orders, cancel, |n| Complex64::new(centred.coefficient(n, ALL_DIGITS), 0.0));
    }
    Offset::new(proportions).coefficients(orders, cancel)
}

/// A function of every order, until somebody stops waiting.
fn each(orders: &[u32], cancel: &Cancel, of: impl Fn(u32) -> Complex64) -> Result<Vec<Complex64>> {
    let mut values = Vec::with_capacity(orders.len());
    for &n in orders {
        cancel.check()?;
        values.push(of(n));
    }
    Ok(values)
}

/// About how many steps of some nanoseconds so many orders of a cylinder take at most, by the slack of
/// its rod.
#[must_use]
pub fn steps(slack: f64, orders: usize) -> usize {
    orders.saturating_mul(if slack < LITTLE_SLACK { MOST_STEPS } else { 64 })
}

/// Whether an order is better integrated than summed from so many terms.
fn is_by_quadrature(n: u32, terms: f64) -> bool {
    terms > LONGEST_SERIES && terms > SERIES_TERMS_PER_ORDER * f64::from(n)
}

/// Coefficients whose products, n apart, are so many terms of each order.
fn series_length(highest: u32, terms: f64) -> usize {
    highest as usize + terms.ceil() as usize + 1
}

/// Ratio of term j + 1 to term j.
#[inline(always)]
fn next_term(j: f64, m: f64) -> f64 {
    ((j - 0.5) * (j + m - 0.5)) / ((j + 1.0) * (j + m + 1.0))
}

/// What may be missing from `1 − Σⱼ |b_j| b_{j+m}/b_m p^{4j}` to keep it within a relative tolerance.
///
/// That sum's rest falls with p; at p = 1, where the height of the rod is |cos φ|, it is
/// `(4/π)/((4m² − 1)|b_m|)`, and √m times that rises from 0.849 at m = 1.
fn may_be_missing(n: u32, rtol: f64) -> f64 {
    0.8 * rtol / (0.5 * f64::from(n)).sqrt()
}

/// `(−1)^{m+1} n² |b_m|`, n = 2m.
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
    height: f64,
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
        Self { p, correction: residual.high / (2.0 * root * p), height: root }
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
    /// p⁴.
    fourth: Double,
}

impl Centred {
    fn new(proportions: &Proportions) -> Self {
        let root = Root::new(proportions.above);
        let square = Double::product(root.p, root.p);
        let fourth = Double::product(square.high, square.high);
        let rest = 2.0 * square.high * square.low + 4.0 * root.correction * fourth.high;
        let fourth = Double::sum(fourth.high, fourth.low + rest);
        Self { root, reach: proportions.above.high, fourth }
    }

    /// Within a relative tolerance, or to all digits.
    fn coefficient(&self, n: u32, rtol: f64) -> f64 {
        if n % 2 == 1 {
            return if n == 1 { 1.0 } else { 0.0 };
        }
        // The terms fall faster than p⁴ⁱ, so that what follows one is below it over 1 − p⁴.
        let last = may_be_missing(n, rtol) * (1.0 - self.fourth.high);
        let digits = NEGLIGIBLE_LOG.min(-last.ln());
        let count = (digits / -self.fourth.high.ln()).ceil();
        if is_by_quadrature(n, count) {
            let integral = spike_integral(self.reach, self.reach, 0.0, n);
            return if n.is_multiple_of(4) { integral } else { -integral };
        }
        let rest = if count > LONGEST_PLAIN_SERIES {
            self.long_series(n, last)
        } else {
            self.series(n, last)
        };
        leading(n) * self.root.power(n - 1) * rest
    }

    /// `1 − Σⱼ |b_j| b_{j+m}/b_m p^{4j}`, of the terms above the last that may be missing.
    fn series(&self, n: u32, last: f64) -> f64 {
        let m = f64::from(n / 2);
        let mut term = 0.5 * (m - 0.5) / (m + 1.0) * self.fourth.high;
        let mut sum = 0.0;
        let mut j = 1.0;
        while term > last.max(sum * f64::EPSILON / 16.0) {
            sum += term;
            term *= next_term(j, m) * self.fourth.high;
            j += 1.0;
        }
        1.0 - sum
    }

    /// The same to twice the digits: with many terms the sum nears 1, and their roundings add up.
    fn long_series(&self, n: u32, last: f64) -> f64 {
        let m = f64::from(n / 2);
        let first = Double { high: 0.5 * (m - 0.5), low: 0.0 };
        let mut term = first.over(m + 1.0).times(self.fourth);
        let mut sum = Double { high: 0.0, low: 0.0 };
        let mut j = 1.0;
        while term.high > last.max(sum.high * f64::EPSILON / 16.0) {
            sum = sum.plus(term.high);
            sum.low += term.low;
            // Both products are whole numbers over 4, hence exact.
            let ratio = Double { high: (j - 0.5) * (j + m - 0.5), low: 0.0 };
            term = term.times(ratio.over((j + 1.0) * (j + m + 1.0))).times(self.fourth);
            j += 1.0;
        }
        Double::sum(1.0, -sum.high).plus(-sum.low).high
    }
}

/// A slider-crank with an offset: all orders, the odd ones as sines.
struct Offset {
    /// |e|/r, with `above` ≥ `below`; a negative offset mirrors the motion in time.
    size: f64,
    mirrored: bool,
    above: Double,
    below: Double,
}

impl Offset {
    fn new(proportions: &Proportions) -> Self {
        let Proportions { offset, above, below, .. } = *proportions;
        let mirrored = offset < 0.0;
        let (above, below) = if mirrored { (below, above) } else { (above, below) };
        Self { size: offset.abs(), mirrored, above, below }
    }

    fn coefficients(&self, orders: &[u32], cancel: &Cancel) -> Result<Vec<Complex64>> {
        let highest = orders.iter().copied().max().unwrap_or(1);
        let roots = Roots::new(self.size, self.above, self.below);
        let count = roots.terms();
        let series = if orders.iter().all(|&n| is_by_quadrature(n, count)) {
            Vec::new()
        } else {
            roots.series(series_length(highest, count))
        };
        each(orders, cancel, |n| {
            let magnitude = if is_by_quadrature(n, count) {
                // The integral is over the angle from sin θ = 1: (−i)ⁿ for iⁿ.
                let integral = spike_integral(self.above.high, self.below.high, self.size, n);
                if n % 2 == 1 { -integral } else { integral }
            } else {
                let terms = series.len() - n as usize;
                // From the smallest term up.
                let tail: f64 = (1..terms).rev().map(|j| series[j] * series[j + n as usize]).sum();
                f64::from(n).powi(2) / roots.product.sqrt() * (series[n as usize] + tail)
            };
            self.turned(n, magnitude)
        })
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
            -2.0 * offset * (p1 + p2) / (first.height + second.height)
        };
        Self { p1, p2, product, difference }
    }

    /// How many terms of a series in p₂² matter.
    fn terms(&self) -> f64 {
        NEGLIGIBLE_LOG / (-2.0 * self.p2.ln())
    }

    /// h₀ … h_{count − 1} of √((1 + p₁w)(1 − p₂w)): all below zero from h₁ on, since p₁ ≤ p₂, so
    /// that the recurrence adds terms of one sign.
    fn series(&self, count: usize) -> Vec<f64> {
        let mut h = Vec::with_capacity(count.max(2));
        h.extend([1.0, 0.5 * self.difference]);
        for k in 1..count.saturating_sub(1) {
            let x = k as f64;
            let next = self.difference * (0.5 - x) * h[k] + self.product * (x - 2.0) * h[k - 1];
            h.push(next / (x + 1.0));
        }
        h
    }
}

/// Bound of `Σ_{n > highest} |aₙ|`, what orders above `highest` can add to a force over m·r·ω².
///
/// |hₖ| ≤ p₂ᵏ: by the generating function (2 − √(1 − x))² the binomial coefficients of the two
/// roots convolve to 1 at most. Hence `|aₙ| ≤ n² p₂ⁿ / (√(p₁p₂) (1 − p₂²))`, summed as the second
/// derivative of a geometric series. `None` where p₂ is so near 1 that it overflows.
#[must_use]
pub fn tail_bound(proportions: &Proportions, highest: u32) -> Option<f64> {
    let Offset { size, above, below, .. } = Offset::new(proportions);
    let Roots { p2: p, product, .. } = Roots::new(size, above, below);
    let first = f64::from(highest + 1);
    let gap = 1.0 - p;
    // Σ_{n ≥ N} n² pⁿ = p^N (N²/g + 2Np/g² + p(1 + p)/g³), g = 1 − p.
    let sum = p.powf(first)
        * (first * first / gap + 2.0 * first * p / (gap * gap) + p * (1.0 + p) / gap.powi(3));
    let bound = sum / (product.sqrt() * (1.0 - p * p));
    bound.is_finite().then_some(bound)
}

/// The lowest order above which the rest of the force is below `tolerance` times m·r·ω² and, where it
/// is wanted, that of the torque below `tolerance` times m·r²·ω²; none that is taken may be. `torque`
/// is the size of the rod's inertia, beyond that of its two masses, over the same m·r².
#[must_use]
pub fn highest_order(
    proportions: &Proportions,
    tolerance: f64,
    torque: Option<f64>,
) -> Option<u32> {
    let of_torque = |n: u32, rod_inertia: f64| -> Option<f64> {
        let of_masses = torque::tail_bound(proportions, n)?;
        if rod_inertia == 0.0 {
            return Some(of_masses);
        }
        Some(of_masses + rod_inertia * rod::tail_bound(proportions, n)?)
    };
    let enough = |n: u32| {
        let within = |bound: Option<f64>| bound.is_some_and(|bound| bound <= tolerance);
        within(tail_bound(proportions, n))
            && torque.is_none_or(|rod_inertia| within(of_torque(n, rod_inertia)))
    };
    if !enough(limits::HIGHEST_ORDER) {
        return None;
    }
    let (mut low, mut high) = (0, limits::HIGHEST_ORDER);
    while low < high {
        let middle = u32::midpoint(low, high);
        if enough(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    Some(high.max(1))
}
