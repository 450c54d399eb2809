//! Numbers of twice a double's digits: the unevaluated sum of two.

/// `a · b + c` rounded once, or as near as without a machine that rounds so: exact where the sum of the
/// rounded product and `c` is, but for underflow.
///
/// WebAssembly has no such machine, and what replaces it takes as long as dozens of operations.
#[must_use]
#[inline(always)]
pub fn fused(a: f64, b: f64, c: f64) -> f64 {
    /// Times a double leaves the upper half of its digits (Dekker, Veltkamp).
    const SPLITTER: f64 = 134_217_729.0;
    if cfg!(not(target_family = "wasm")) {
        return a.mul_add(b, c);
    }
    let upper = |x: f64| SPLITTER * x - (SPLITTER * x - x);
    let product = a * b;
    let [(a, rest_of_a), (b, rest_of_b)] = [a, b].map(|x| (upper(x), x - upper(x)));
    let lost = ((a * b - product) + a * rest_of_b + rest_of_a * b) + rest_of_a * rest_of_b;
    (product + c) + lost
}

/// `high + low`, with `low` below half a unit in the last place of `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Double {
    /// The nearest double.
    pub high: f64,
    /// The rest.
    pub low: f64,
}

impl Double {
    /// `a + b`, exactly (Knuth's two-sum).
    #[must_use]
    #[inline]
    pub fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let of_b = high - a;
        Self { high, low: (a - (high - of_b)) + (b - of_b) }
    }

    /// `a · b`, exactly.
    #[must_use]
    #[inline]
    pub fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        Self { high, low: fused(a, b, -high) }
    }

    /// Plus a double, to twice its digits.
    #[must_use]
    #[inline]
    pub fn plus(self, x: f64) -> Self {
        let sum = Self::sum(self.high, x);
        Self::sum(sum.high, sum.low + self.low)
    }

    /// Product with another, to twice a double's digits.
    #[must_use]
    #[inline]
    pub fn times(self, other: Self) -> Self {
        let product = Self::product(self.high, other.high);
        Self::sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }

    /// Over a double, to twice its digits.
    #[must_use]
    #[inline]
    pub fn over(self, x: f64) -> Self {
        let quotient = self.high / x;
        let rest = fused(-quotient, x, self.high) + self.low;
        Self::sum(quotient, rest / x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_double_loses_is_kept() {
        assert_eq!(Double::sum(1.0, 1e-20), Double { high: 1.0, low: 1e-20 });
        let square = Double::product(1.0 + f64::EPSILON, 1.0 + f64::EPSILON);
        assert_eq!(square.low, f64::EPSILON * f64::EPSILON);
        let third = Double { high: 1.0, low: 0.0 }.over(3.0);
        let back = Double::product(third.high, 3.0).plus(3.0 * third.low);
        let whole = third.times(Double { high: 3.0, low: 0.0 });
        // twice 53 bits, three roundings
        assert!((whole.high - 1.0).abs() + whole.low.abs() < 1e-31);
        assert!((back.high - 1.0).abs() + back.low.abs() < 1e-31);
    }

    /// Whole numbers of up to 120 bits, in integers and as two doubles.
    #[test]
    fn products_and_quotients_are_those_of_integers() {
        let double = |whole: i128| {
            let high = whole as f64;
            Double { high, low: (whole - high as i128) as f64 }
        };
        for k in 0..200_i128 {
            // 64 bits: both parts count.
            let (a, b) =
                ((1 << 63) + 0x0123_4567_89ab_cdef * (k + 1), (1 << 62) - 0x0357_9bdf_1357 * k);
            let c = 0x1f_ffff_ffff_fff1 - 0x1_2345_6789 * k;
            for (a, b) in [(a, b), (-a, b), (a, -b)] {
                let product = double(a).times(double(b));
                let rest = (a * b - product.high as i128) as f64 - product.low;
                // 2⁻¹⁰⁴: the product of the rests, and roundings of rests.
                assert!(rest.abs() <= product.high.abs() * 2_f64.powi(-104), "{a} {b}: {rest:e}");
                let quotient = double(a).over(c as f64);
                let back = quotient.times(double(c));
                let rest = (a - back.high as i128) as f64 - back.low;
                assert!(rest.abs() <= back.high.abs() * 2_f64.powi(-102), "{a} {c}: {rest:e}");
                let sum = double(a).plus(c as f64);
                assert_eq!(sum.high as i128 + sum.low as i128, a + c);
            }
        }
    }
}
