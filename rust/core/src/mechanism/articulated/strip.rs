//! How far the motion of a link rod's piston is analytic above the real axis, and what bounds of it follow.

use super::Linkage;
use crate::Complex64;

/// Places of a period at which a function is sampled to find where it is largest.
const PLACES: usize = 96;
/// Sections of an interval between two of them that narrow it to where the value is right to rounding.
const SECTIONS: usize = 40;
/// Bisections of the height.
const BISECTIONS: usize = 30;
/// Part of a link rod's length below which the bound of its knuckle's distance from the bore will do.
const LONG: f64 = 0.9;
/// The largest value that is found may be below the true one by this part of it.
const SEARCH: f64 = 1e-9;

/// A strip of crank angles around the real axis in which the motion is analytic.
///
/// There an analytic function of at most M has a coefficient of `e^{inθ}` of at most M·e^{−ρ|n|}, ρ the height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Strip {
    /// Its height above the axis, radians.
    pub height: f64,
    /// Bound in it of the piston's distance, over the crank radius, beyond that of the crankpin, less a constant.
    pub most: f64,
}

impl Linkage {
    /// sin φ of the master rod, and of what the knuckle is off the bore, at a complex crank angle.
    fn complex_side(&self, theta: Complex64) -> Complex64 {
        let lean = self.complex_lean(theta);
        let upright = (Complex64::ONE - lean * lean).sqrt();
        theta.sin() + (upright * self.knuckle.im + lean * self.knuckle.re) * self.radius
    }

    fn complex_lean(&self, theta: Complex64) -> Complex64 {
        let from_master = theta.sin() * self.ahead.re + theta.cos() * self.ahead.im;
        (Complex64::from(self.master_offset) - from_master) * self.master_ratio
    }

    /// Largest distance of the knuckle from the bore, over the crank radius, at crank angles of this imaginary part:
    /// by the maximum principle the largest in the strip between both signs of it.
    pub(super) fn farthest(&self, height: f64) -> f64 {
        let step = std::f64::consts::TAU / PLACES as f64;
        let size = |theta: f64| self.complex_side(Complex64::new(theta, height)).norm();
        let sizes: Vec<f64> = (0..PLACES).map(|k| size(step * k as f64)).collect();
        let at = (0..PLACES).max_by(|&a, &b| sizes[a].total_cmp(&sizes[b])).unwrap_or(0);
        // Other peaks as high as this one are its images half a turn on, or lower than what is found here.
        let rivals = (0..PLACES).filter(|&k| {
            let [before, after] = [PLACES - 1, 1].map(|by| sizes[(k + by) % PLACES]);
            k == at || sizes[k] >= before.max(after) && sizes[k] > 0.98 * sizes[at]
        });
        let peak = |k: usize| {
            let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
            let (mut low, mut high) = (step * (k as f64 - 1.0), step * (k as f64 + 1.0));
            let mut largest = sizes[k];
            for _ in 0..SECTIONS {
                let [left, right] = [high - golden * (high - low), low + golden * (high - low)];
                let [of_left, of_right] = [left, right].map(size);
                largest = largest.max(of_left).max(of_right);
                if of_left > of_right { high = right } else { low = left }
            }
            largest
        };
        rivals.map(peak).fold(0.0, f64::max) * (1.0 + SEARCH)
    }

    /// The part of the knuckle's distance from the bore that is a sine of the crank angle: its amplitude.
    fn sine_amplitude(&self) -> f64 {
        let leaning = self.radius * self.master_ratio * self.knuckle.re;
        (1.0 - leaning * self.ahead.re).hypot(leaning * self.ahead.im)
    }

    /// Bound of the distance of the knuckle from the bore in a strip, of cosh of its height: of the sine at most its
    /// amplitude times that, and |cos φ| ≤ √(1 + |sin φ|²).
    fn farthest_within(&self, cosh: f64) -> f64 {
        let (offset, lean) = (self.master_offset.abs(), self.lean_within(cosh));
        self.sine_amplitude() * cosh
            + self.radius * self.knuckle.re.abs() * self.master_ratio * offset
            + self.radius * self.knuckle.im.abs() * (1.0 + lean * lean).sqrt()
    }

    fn lean_within(&self, cosh: f64) -> f64 {
        self.master_ratio * (cosh + self.master_offset.abs())
    }

    /// Height of a strip of a master without offset in closed form, where that bound is the rod's length; zero where
    /// the rod is shorter.
    pub(super) fn known_height(&self) -> f64 {
        let (size, rod) = (self.sine_amplitude(), self.rod);
        let side = self.radius * self.knuckle.im.abs();
        let (rest, leaning) = ((rod - side) * (rod + side), side * self.master_ratio);
        // (L − A·x)² = s²(1 + λ²x²).
        let root = (size * size * rod * rod - (size * size - leaning * leaning) * rest).max(0.0);
        let cosh = (rest / (size * rod + root.sqrt())).min(1.0 / self.master_ratio);
        if rod > side && cosh > 1.0 { cosh.acosh() } else { 0.0 }
    }

    /// The widest strip that is known.
    pub(super) fn strip(&self) -> Strip {
        let lean_within = |height: f64| self.lean_within(height.cosh());
        // The master's rod would stand across its bore where sin φ = 1.
        let mut high = (1.0 / self.master_ratio - self.master_offset.abs()).max(1.0).acosh();
        high = high.min((2.0 * (1.0 + self.rod + self.radius)).acosh());
        // A link rod that is barely long enough for its knuckle takes the distance itself, polished at its peaks.
        let is_long = self.farthest_within(1.0) < LONG * self.rod;
        let farthest = |height: f64| {
            if is_long { self.farthest_within(height.cosh()) } else { self.farthest(height) }
        };
        let is_analytic = |height: f64| lean_within(height) < 1.0 && farthest(height) < self.rod;
        let mut low = 0.0;
        for _ in 0..BISECTIONS {
            let middle = f64::midpoint(low, high);
            *(if is_analytic(middle) { &mut low } else { &mut high }) = middle;
        }
        let (lean, side) = (lean_within(low), farthest(low).min(self.rod));
        // |cos φ − 1| = |sin²φ|/|1 + cos φ| with a real part of cos φ above zero; and so of the link.
        let of_knuckle =
            self.radius * (self.knuckle.re.abs() * lean * lean + self.knuckle.im.abs() * lean);
        Strip { height: low, most: of_knuckle + side * side / self.rod }
    }
}

impl Strip {
    /// Bound of Σ nᵏ·2M·e^{−ρn} of the orders above one, k = 2: phasors are twice coefficients.
    pub fn accelerations_beyond(&self, highest: u32) -> Option<f64> {
        let (n, q) = (f64::from(highest) + 1.0, (-self.height).exp());
        let gap = 1.0 - q;
        // Σ_{m ≥ n} m²qᵐ = qⁿ(n²/g + 2nq/g² + q(1 + q)/g³).
        let sum = n * n / gap + 2.0 * n * q / (gap * gap) + q * (1.0 + q) / (gap * gap * gap);
        let bound = 2.0 * self.most * sum * (-self.height * n).exp();
        bound.is_finite().then_some(bound)
    }

    /// Bound of the amplitudes above an order of `f″·(f′ + c)` with |f| at most `most` in the strip: derivatives at a
    /// distance d of its border are at most M/d and 2M/d² (Cauchy).
    pub fn products_beyond(&self, most: f64, besides: f64, highest: u32) -> Option<f64> {
        let n = f64::from(highest) + 1.0;
        let distance = (0.5 * self.height).min(3.0 / n);
        let rest = self.height - distance;
        let [velocity, acceleration] = [most / distance, 2.0 * most / (distance * distance)];
        let largest = acceleration * (velocity + besides);
        let bound = 2.0 * largest * (-rest * n).exp() / (-(-rest).exp_m1());
        bound.is_finite().then_some(bound)
    }
}
