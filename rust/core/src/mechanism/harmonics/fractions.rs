//! Fourier series of the two fractions that the squares of velocities have, in closed form.
//!
//! h'² = u²cos²θ/h² and φ'² = cos²θ/h² are rational in sin θ. Their partial fractions,
//! cos²θ/(A − sin θ) and cos²θ/(B + sin θ), have geometric series in p₁ and p₂.

use super::roots::{Root, Roots, Sides};
use crate::Complex64;
use crate::mechanism::slider_crank::Proportions;

/// `F = (l/2r)·(cos²θ/(A − sin θ) + cos²θ/(B + sin θ))`: h'² = F − cos²θ, and φ'² = F·(r/l)².
pub(super) struct Fractions {
    rod: f64,
    sides: Sides,
    roots: Roots,
}

impl Fractions {
    pub fn new(proportions: &Proportions) -> Self {
        let sides = Sides::new(proportions);
        let roots = Roots::new(&sides);
        Self { rod: proportions.rod, sides, roots }
    }

    /// Peak phasor of order n ≥ 1.
    ///
    /// cos²θ/(A − sin θ) = sin θ + A − (A² − 1)/(A − sin θ), whose order n is
    /// −2√(A² − 1) p₁ⁿ (−i)ⁿ, plus sin θ; the other fraction has p₂, iⁿ and −sin θ.
    pub fn harmonic(&self, n: u32) -> Complex64 {
        let Roots { first, second, .. } = &self.roots;
        // √(a² − 1) pⁿ, which does not underflow before pⁿ⁻¹ does.
        let part = |root: &Root| root.height * root.p * root.power(n - 1);
        if n.is_multiple_of(2) {
            let sum = self.rod * (part(first) + part(second));
            return Complex64::new(if n.is_multiple_of(4) { -sum } else { sum }, 0.0);
        }
        if self.sides.offset == 0.0 {
            return Complex64::default();
        }
        let difference = if n == 1 {
            -0.5 * self.roots.difference * (first.p + second.p)
        } else {
            // log (p₁/p₂)ⁿ
            let ratio = f64::from(n) * (self.roots.difference / second.p).ln_1p();
            if ratio < -std::f64::consts::LN_2 {
                part(first) - part(second)
            } else {
                // √(A² − 1) − √(B² − 1) and 1 − (p₁/p₂)ⁿ, each without a subtraction.
                let heights = 4.0 * self.sides.offset * self.rod / (first.height + second.height);
                second.p * second.power(n - 1) * (heights + first.height * ratio.exp_m1())
            }
        };
        let magnitude = self.rod * if self.sides.mirrored { -difference } else { difference };
        Complex64::new(0.0, if n % 4 == 1 { magnitude } else { -magnitude })
    }
}
