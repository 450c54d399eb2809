//! Gauss-Legendre quadrature.

use std::f64::consts::PI;

/// Nodes and weights of the Gauss-Legendre rule of `count` points on [−1, 1].
#[must_use]
pub fn gauss_legendre(count: u32) -> Vec<(f64, f64)> {
    let legendre = |x: f64| {
        let (mut before, mut here) = (1.0, x);
        for k in 2..=count {
            let k = f64::from(k);
            (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
        }
        (here, f64::from(count) * (x * here - before) / (x * x - 1.0))
    };
    (0..count)
        .map(|i| {
            let mut x = (PI * (f64::from(i) + 0.75) / (f64::from(count) + 0.5)).cos();
            for _ in 0..8 {
                let (value, slope) = legendre(x);
                x -= value / slope;
            }
            let (_, slope) = legendre(x);
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_is_exact_for_powers_below_twice_its_points() {
        for count in [2_u32, 6, 15, 24] {
            let rule = gauss_legendre(count);
            for power in (0..2 * count as i32).step_by(2) {
                let sum: f64 = rule.iter().map(|&(x, w)| w * x.powi(power)).sum();
                // Roundings of `count` terms, whose sum is at most 2.
                assert!((sum - 2.0 / f64::from(power + 1)).abs() < 1e-14, "{count} {power}");
            }
            let sum: f64 = rule.iter().map(|&(x, w)| w * x.powi(2 * count as i32)).sum();
            assert!(count > 20 || (sum - 2.0 / f64::from(2 * count + 1)).abs() > 1e-11);
        }
    }
}
