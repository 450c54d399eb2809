//! Polynomials by their values at Chebyshev points, and Chebyshev series.

use crate::numbers::simd::MultiplyAdd;

/// Chebyshev point `k` of a degree, descending from 1.
pub(crate) fn node(k: usize, degree: usize) -> f64 {
    // By the sine, so that they are symmetric.
    (std::f64::consts::FRAC_PI_2 * (degree as f64 - 2.0 * k as f64) / degree as f64).sin()
}

/// Chebyshev points of a panel, ascending, its edges exact.
pub(crate) fn points(low: f64, high: f64, degree: usize) -> impl Iterator<Item = f64> {
    (0..=degree).map(move |k| match k {
        0 => low,
        k if k == degree => high,
        k => 0.5 * (low + high) - 0.5 * (high - low) * node(k, degree),
    })
}

/// Coefficient `n` of the Chebyshev series through ascending Chebyshev points.
pub(crate) fn coefficient(values: &[f64], n: usize) -> f64 {
    let degree = values.len() - 1;
    let half = |k: usize| if k == 0 || k == degree { 0.5 } else { 1.0 };
    // The cosine of a whole number of parts of half a turn, the angle reduced as a number of parts.
    let cosine = |k: usize| {
        let parts = (n * (degree - k)) % (2 * degree);
        (std::f64::consts::PI * parts as f64 / degree as f64).cos()
    };
    let sum: f64 = values.iter().enumerate().map(|(k, value)| half(k) * value * cosine(k)).sum();
    half(n) * 2.0 * sum / degree as f64
}

/// Sum of a Chebyshev series and its first two derivatives.
pub(crate) fn jet(coefficients: &[f64], x: f64) -> [f64; 3] {
    jets(coefficients, &[x]).map(|[value]| value)
}

/// Sums of a Chebyshev series at some places side by side, by Clenshaw's recurrence.
#[inline(always)]
pub(crate) fn values<const N: usize>(coefficients: &[f64], x: &[f64; N]) -> [f64; N] {
    let [mut b, mut b_before] = [[0.0; N]; 2];
    for &c in coefficients[1..].iter().rev() {
        for i in 0..N {
            let next = (2.0 * x[i]).multiply_add(b[i], c - b_before[i]);
            (b_before[i], b[i]) = (b[i], next);
        }
    }
    for i in 0..N {
        b[i] = x[i].multiply_add(b[i], coefficients[0] - b_before[i]);
    }
    b
}

/// Sums of a Chebyshev series at some places side by side, and their first two derivatives, by
/// Clenshaw's recurrence.
#[inline(always)]
pub(crate) fn jets<const N: usize>(coefficients: &[f64], x: &[f64; N]) -> [[f64; N]; 3] {
    let [mut b, mut slope, mut bend] = [[0.0; N]; 3];
    let [mut b_before, mut slope_before, mut bend_before] = [[0.0; N]; 3];
    for &c in coefficients[1..].iter().rev() {
        for i in 0..N {
            let next_bend = 2.0 * (2.0 * slope[i] + x[i] * bend[i]) - bend_before[i];
            let next_slope = 2.0 * (b[i] + x[i] * slope[i]) - slope_before[i];
            let next = 2.0 * x[i] * b[i] - b_before[i] + c;
            (bend_before[i], bend[i]) = (bend[i], next_bend);
            (slope_before[i], slope[i]) = (slope[i], next_slope);
            (b_before[i], b[i]) = (b[i], next);
        }
    }
    for i in 0..N {
        bend[i] = 2.0 * slope[i] + x[i] * bend[i] - bend_before[i];
        slope[i] = b[i] + x[i] * slope[i] - slope_before[i];
        b[i] = x[i] * b[i] - b_before[i] + coefficients[0];
    }
    [b, slope, bend]
}

/// The larger of the last two coefficients of the polynomial through values at Chebyshev points.
pub(crate) fn largest_of_last(values: &[f64]) -> f64 {
    let degree = values.len() - 1;
    let last = [degree - 1, degree].map(|n| coefficient(values, n).abs());
    last[0].max(last[1])
}
