//! Functions of a crank angle with their first three derivatives, and their parts that are even and odd under half
//! a turn.

use std::ops::{Add, Mul, Sub};

/// Value, first, second and third derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jet(pub [f64; 4]);

impl Jet {
    /// Sine and cosine of an angle of which these are the values.
    #[inline(always)]
    pub fn turning(sin: f64, cos: f64) -> [Self; 2] {
        [Self([sin, cos, -sin, -cos]), Self([cos, -sin, -cos, sin])]
    }

    /// The constant.
    #[inline(always)]
    pub fn constant(value: f64) -> Self {
        Self([value, 0.0, 0.0, 0.0])
    }

    #[inline(always)]
    pub fn times(self, factor: f64) -> Self {
        Self(self.0.map(|value| factor * value))
    }

    /// √f: from f = g², with g' = f'/(2g) and so on.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let [f, f1, f2, f3] = self.0;
        let root = f.sqrt();
        let half = 0.5 / root;
        let g1 = f1 * half;
        let g2 = (f2 - 2.0 * g1 * g1) * half;
        let g3 = (f3 - 6.0 * g1 * g2) * half;
        Self([root, g1, g2, g3])
    }

    /// 1/f: from f·g = 1.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        let [f, f1, f2, f3] = self.0;
        let g = 1.0 / f;
        let g1 = -f1 * g * g;
        let g2 = -(f2 * g + 2.0 * f1 * g1) * g;
        let g3 = -(f3 * g + 3.0 * f2 * g1 + 3.0 * f1 * g2) * g;
        Self([g, g1, g2, g3])
    }
}

impl Add for Jet {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self([0, 1, 2, 3].map(|k| self.0[k] + other.0[k]))
    }
}

impl Sub for Jet {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self([0, 1, 2, 3].map(|k| self.0[k] - other.0[k]))
    }
}

impl Mul for Jet {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let ([a, a1, a2, a3], [b, b1, b2, b3]) = (self.0, other.0);
        Self([
            a * b,
            a1 * b + a * b1,
            a2 * b + 2.0 * a1 * b1 + a * b2,
            a3 * b + 3.0 * (a2 * b1 + a1 * b2) + a * b3,
        ])
    }
}

/// Parts of a function that half a turn leaves, and negates: neither is a difference of nearly equal numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HalfTurnParts {
    pub even: Jet,
    pub odd: Jet,
}

impl HalfTurnParts {
    #[inline(always)]
    pub fn times(self, factor: f64) -> Self {
        Self { even: self.even.times(factor), odd: self.odd.times(factor) }
    }

    /// √(length² − f²): its odd part is −2·odd·even/(R₊ + R₋), with R₊ and R₋ the root here and half a turn on.
    #[inline(always)]
    pub fn leg(self, length: f64) -> Self {
        let root = |side: Jet| {
            let [above, below] = [Jet::constant(length) + side, Jet::constant(length) - side];
            (above * below).sqrt()
        };
        let sum = root(self.even + self.odd) + root(self.even - self.odd);
        let odd = (self.odd * self.even * sum.inverse()).times(-2.0);
        Self { even: sum.times(0.5), odd }
    }
}

impl Add for HalfTurnParts {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { even: self.even + other.even, odd: self.odd + other.odd }
    }
}
