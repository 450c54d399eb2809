//! Loops compiled for the widest vectors of the machine they run on.

use pulp::Simd;

/// Run a loop, compiled once for each instruction set, with the best that this machine has. All
/// the loop calls must be inlined into it, or they are compiled for the baseline only.
#[inline]
pub(crate) fn vectorised<R>(work: impl FnOnce() -> R) -> R {
    // WebAssembly has one set, chosen where it is compiled.
    if cfg!(target_family = "wasm") {
        return work();
    }
    pulp::Arch::new().dispatch(work)
}

/// The vector of a run of numbers that begins at a multiple of its own length.
#[inline(always)]
pub(crate) fn vector<S: Simd>(of: &[f64], at: usize) -> S::f64s {
    S::as_simd_f64s(of).0[at]
}

/// The same, to write to.
#[inline(always)]
pub(crate) fn vector_mut<S: Simd>(of: &mut [f64], at: usize) -> &mut S::f64s {
    &mut S::as_mut_simd_f64s(of).0[at]
}

/// Multiplication and addition in loops: in one step, rounded once, where machines have it.
pub(crate) trait MultiplyAdd {
    /// This times `factor`, plus `summand`.
    fn multiply_add(self, factor: Self, summand: Self) -> Self;
}

impl MultiplyAdd for f64 {
    #[inline(always)]
    fn multiply_add(self, factor: Self, summand: Self) -> Self {
        // WebAssembly has not, and one step in software takes as long as dozens.
        if cfg!(target_family = "wasm") {
            return self * factor + summand;
        }
        self.mul_add(factor, summand)
    }
}

/// 1.5·2⁵²: adding and taking it away rounds to the nearest whole number.
pub(crate) const ROUND: f64 = 6_755_399_441_055_744.0;

/// Sine and cosine of degrees, for a whole slice at once.
///
/// Quadrants are taken off exactly; on the ±45° that are left, minimax polynomials (fdlibm's) are
/// within a unit in the last place.
#[inline(always)]
#[expect(clippy::excessive_precision, reason = "the coefficients as fdlibm gives them")]
pub(crate) fn sin_cos_degrees(degrees: &[f64], sin: &mut [f64], cos: &mut [f64]) {
    const RADIANS: f64 = std::f64::consts::PI / 180.0;
    for ((&degrees, sin), cos) in degrees.iter().zip(sin).zip(cos) {
        let quarters = (degrees * (1.0 / 90.0) + ROUND) - ROUND;
        let x = (degrees - 90.0 * quarters) * RADIANS;
        let square = x * x;
        let s = [
            1.589_690_995_211_550_1e-10,
            -2.505_076_025_340_686_34e-8,
            2.755_731_370_707_006_77e-6,
            -1.984_126_982_985_794_93e-4,
            8.333_333_333_322_489_46e-3,
            -1.666_666_666_666_663_243e-1,
        ];
        let c = [
            -1.135_964_755_778_819_48e-11,
            2.087_572_321_298_174_83e-9,
            -2.755_731_435_139_066_33e-7,
            2.480_158_728_947_672_94e-5,
            -1.388_888_888_887_410_96e-3,
            4.166_666_666_666_660_19e-2,
        ];
        // Without loops and branches, so that those over angles are vectors where code is made for
        // size too.
        let polynomial = |[a, b, c, d, e, f]: [f64; 6]| {
            let a = square.multiply_add(square.multiply_add(a, b), c);
            square.multiply_add(square.multiply_add(square.multiply_add(a, d), e), f)
        };
        let of_sin = polynomial(s);
        let of_cos = polynomial(c);
        let s = (x * square).multiply_add(of_sin, x);
        let c = (square * square).multiply_add(of_cos, (-0.5_f64).multiply_add(square, 1.0));
        // Quarters modulo 4 as −2, −1, 0, 1 (or 2): odd ones exchange sine and cosine.
        let rest = quarters - 4.0 * ((quarters * 0.25 + ROUND) - ROUND);
        let odd = rest.abs() == 1.0;
        let sign = if (rest - 0.5).abs() > 1.0 { -1.0 } else { 1.0 };
        let a = sign * if odd { c } else { s };
        let b = sign * if odd { -s } else { c };
        (*sin, *cos) = (a, b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_library() {
        let degrees: Vec<f64> = (-40_000..40_000).map(|k| f64::from(k) * 0.037).collect();
        let (mut sin, mut cos) = (degrees.clone(), degrees.clone());
        vectorised(
            #[inline(always)]
            || sin_cos_degrees(&degrees, &mut sin, &mut cos),
        );
        for (i, &d) in degrees.iter().enumerate() {
            let unit = crate::numbers::angle::cis_degrees(d);
            // one unit in the last place of numbers below 1, twice
            assert!((sin[i] - unit.im).abs() <= 2.3e-16, "sin {d}");
            assert!((cos[i] - unit.re).abs() <= 2.3e-16, "cos {d}");
        }
    }
}
