//! Integrals of a function with a narrow spike, by panels that halve towards it.

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

use crate::numbers::quadrature::gauss_legendre;

/// Integral over [0, π/2] of a function with a spike of this width at 0 and waves of order n.
pub(super) fn graded_panels(width: f64, n: f64, f: impl Fn(f64) -> f64) -> f64 {
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

/// The 20-point rule on [−1, 1].
static GAUSS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| gauss_legendre(20));

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// ∫ cos nφ/(w² + φ²): between 0 and π/2 by the exponential of a wide range, and its spike.
    #[test]
    fn panels_follow_spike_and_waves_and_no_more() {
        for exponent in 0..30 {
            let width = 0.5_f64.powi(exponent);
            for n in [0.0, 1.0, 30.0, 1000.0] {
                let calls = std::cell::Cell::new(0);
                // w/(w² + φ²) is the slope of arctan(φ/w), n cos nφ that of sin nφ.
                let integral = graded_panels(width, n, |φ| {
                    calls.set(calls.get() + 1);
                    width / (width * width + φ * φ) + n * (n * φ).cos()
                });
                let exact = (FRAC_PI_2 / width).atan() + (n * FRAC_PI_2).sin();
                // Twenty nodes to a panel: 1e-15 of its size, waves of n included.
                assert!(
                    (integral - exact).abs() < 1e-14 * (1.0 + n),
                    "{width} {n}: {integral} {exact}"
                );
                // One panel for each halving, and one for each four radians of waves.
                let halvings = (PI / width).log2().ceil() + 1.0;
                let most = 20.0 * (halvings + n * FRAC_PI_2 / 4.0);
                assert!(
                    f64::from(calls.get()) <= most + 20.0,
                    "{width} {n}: {} {most}",
                    calls.get()
                );
            }
        }
    }
}
