use super::*;
use crate::numbers::error::Error;
use proptest::prelude::*;

/// Peaks of these orders, never cancelled.
struct Finder(PeakFinder);

fn finder(orders: &[u32]) -> Finder {
    Finder(PeakFinder::new(&Order::all_whole(orders).unwrap()).unwrap())
}

impl Finder {
    fn along_axis(&self, phasors: &[Complex64]) -> f64 {
        self.0.along_axis(phasors, &Cancel::new()).unwrap()
    }

    fn of_vector(&self, x: &[Complex64], y: &[Complex64]) -> f64 {
        self.0.of_vector(x, y, &Cancel::new()).unwrap()
    }
}

fn sampled(orders: &[u32], phasors: &[Complex64], points: usize) -> f64 {
    let at = |k: usize| {
        let θ = k as f64 * TAU / points as f64;
        let term = |(&n, p): (&u32, &Complex64)| (p * Complex64::cis(f64::from(n) * θ)).re;
        orders.iter().zip(phasors).map(term).sum::<f64>().abs()
    };
    (0..points).map(at).fold(0.0, f64::max)
}

#[test]
fn rows_of_phasors_are_whole() {
    let orders = Order::all_whole(&[1, 2]).unwrap();
    let sums = |phasors: usize, means: usize| {
        let (phasors, means) = (vec![Complex64::ONE; phasors], vec![0.0; means]);
        largest_sums(&orders, &phasors, &means, &Cancel::new())
    };
    assert_eq!(sums(4, 2).unwrap().len(), 2);
    for (phasors, means) in [(3, 0), (4, 1), (4, 3), (1, 1)] {
        assert!(matches!(sums(phasors, means), Err(Error::Length { .. })), "{phasors} {means}");
    }
    let vectors = largest_vectors(&orders, &[[Complex64::ONE; 3]; 3], &Cancel::new());
    assert!(matches!(vectors, Err(Error::Length { .. })));
}

#[test]
fn one_order_peaks_at_its_magnitude() {
    let finder = finder(&[3]);
    let p = Complex64::new(3.0, -4.0);
    // 16 roundings of half a unit at most
    assert!((finder.along_axis(&[p]) - 5.0).abs() < 1e-14);
    let i = Complex64::i();
    assert!((finder.of_vector(&[p], &[-i * p]) - 5.0).abs() < 1e-14);
    assert_eq!(finder.along_axis(&[Complex64::default()]), 0.0);
}

#[test]
fn a_flat_maximum_is_found() {
    // cos θ − cos 2θ / 4 has T'' = 0 at θ = 0
    let finder = finder(&[1, 2]);
    let phasors = [Complex64::new(1.0, 0.0), Complex64::new(-0.25, 0.0)];
    // its largest magnitude is at θ = π
    assert!((finder.along_axis(&phasors) - 1.25).abs() < 1e-15);
    let quartic = [Complex64::new(4.0 / 3.0, 0.0), Complex64::new(-1.0 / 3.0, 0.0)];
    assert!((finder.of_vector(&quartic, &[Complex64::default(); 2]) - 5.0 / 3.0).abs() < 1e-14);
}

#[test]
fn vectors_are_longest_where_samples_are() {
    let orders = [1, 2, 5];
    let parts = |a: f64| {
        orders.map(|n| Complex64::new((a * f64::from(n)).sin(), (a + f64::from(n * n)).cos()))
    };
    for k in 0..20 {
        let (x, y) = (parts(0.37 * f64::from(k)), parts(1.0 + 0.61 * f64::from(k)));
        let length = |sample: u32| {
            let θ = f64::from(sample) * TAU / 20_000.0;
            let along = |phasors: &[Complex64; 3]| -> f64 {
                let terms = orders.iter().zip(phasors);
                terms.map(|(&n, p)| (p * Complex64::cis(f64::from(n) * θ)).re).sum()
            };
            along(&x).hypot(along(&y))
        };
        let dense = (0..20_000).map(length).fold(0.0, f64::max);
        // Large and small vectors alike: they are scaled.
        for scale in [1.0, 1e-200, 1e200] {
            let scaled = |phasors: [Complex64; 3]| phasors.map(|p| p * scale);
            let peak = finder(&orders).of_vector(&scaled(x), &scaled(y)) / scale;
            // Rounding of twelve terms; half a step of 20 000 at order 5, of a length below 5.
            assert!(dense <= peak + 1e-13 && peak <= dense + 2e-6, "{dense} {peak}");
        }
    }
    let zero = parts(0.0).map(|p| p * 0.0);
    assert_eq!(finder(&orders).of_vector(&zero, &zero), 0.0);
}

#[test]
fn derivatives_are_those_of_the_squared_length() {
    // Not in ascending order, and with a common factor that is left out.
    let Finder(finder) = &finder(&[4, 6, 8, 2]);
    let phasors = |a: f64| {
        [1.0, 2.0, 3.0, 4.0].map(|k| Complex64::new((a * k).sin() + 0.1, (a + k * k).cos()))
    };
    let (x, y) = (phasors(0.7), phasors(1.9));
    let vector = VectorSum { finder, rows: [&x, &y], scale: 1.0 };
    for k in 0..10 {
        let θ = 0.6 * f64::from(k);
        let along = |phasors: &[Complex64]| -> f64 {
            let waves = [2.0, 3.0, 4.0, 1.0].iter().zip(phasors);
            waves.map(|(n, p)| (p * Complex64::cis(n * θ)).re).sum()
        };
        let jet = |θ: f64| vector.squared(Complex64::cis(θ));
        assert!((jet(θ)[0] - (along(&x).powi(2) + along(&y).powi(2))).abs() < 1e-13);
        let (before, here, after) = (jet(θ - 1e-5), jet(θ), jet(θ + 1e-5));
        for order in 1..3 {
            let slope = (after[order - 1] - before[order - 1]) / 2e-5;
            // A sixth of 1e-10 of a fourth derivative below 8⁴·50, and rounding over 1e-5.
            assert!((here[order] - slope).abs() < 1e-5, "{order} {θ}");
        }
    }
}

#[test]
fn the_transform_gives_what_the_table_gives() {
    let orders: Vec<u32> = (1..=32).collect();
    let Finder(tabled) = finder(&orders);
    // 32 · 32 points are a power of two.
    let transformed = PeakFinder { table: Vec::new(), ..tabled.clone() };
    let part = |a: f64| move |&n: &u32| Complex64::new((a * f64::from(n)).sin(), a / f64::from(n));
    let [x, y] = [0.7, 1.9].map(|a| orders.iter().map(part(a)).collect::<Vec<_>>());
    let squares = |finder: &PeakFinder, transform: bool| {
        let vector = VectorSum { finder, rows: [&x, &y], scale: 0.5 };
        if transform { vector.transformed(&Cancel::new()) } else { vector.sampled() }.unwrap()
    };
    let (one, other) = (squares(&tabled, false), squares(&transformed, true));
    assert_eq!((one.len(), other.len()), (1024, 1024));
    // Rounding of 64 terms below 2 in a square below 400.
    assert!(one.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-12));
}

/// All orders there are, none of them small: a Dirichlet kernel, turned.
#[test]
fn ten_thousand_orders_are_transformed() {
    let orders: Vec<u32> = (1..=10_000).collect();
    let finder = finder(&orders);
    let phasors: Vec<_> = orders.iter().map(|&n| Complex64::cis(-0.3 * f64::from(n))).collect();
    // Every value of every wave would be three thousand million of them.
    assert!(finder.0.table.is_empty());
    let peak = finder.along_axis(&phasors);
    // Powers up to the ten thousandth of e^{iθ}: as many roundings of its argument.
    assert!((peak / 1e4 - 1.0).abs() < 5e-12, "{peak}");
    let cancel = Cancel::new();
    cancel.raise();
    assert!(finder.0.of_vector(&phasors, &phasors, &cancel).is_err());
}

/// cos θ − (1 + s)/9 cos 3θ has two peaks either side of a dip, a good √s apart, where s = 0 has one
/// without second derivative; some sin θ makes one of them higher.
#[test]
fn of_two_peaks_close_together_the_higher_counts() {
    let finder = finder(&[1, 3]);
    for (exponent, tilt) in (0..16).flat_map(|k| [(k, 0.0), (k, 0.2), (k, -0.2)]) {
        let s = 0.5_f64.powi(exponent);
        let c = -(1.0 + s) / 9.0;
        let tilt = tilt * s.powf(1.5);
        let at = |θ: f64| θ.cos() + c * (3.0 * θ).cos() + tilt * θ.sin();
        // 2e-4 of the distance between the peaks, which cover ±√s: half a step's square is 1e-8 s
        // of a second derivative below 3s.
        let near = |k: i32| at(f64::from(k) * 1e-4 * s.sqrt());
        let peak = (-15_000..=15_000).map(near).fold(0.0, f64::max);
        for k in 0..24 {
            // Wherever they lie between points of the grid, also in the middle of two, in any unit.
            let turn = f64::from(k) * TAU / 48.0 / 24.0;
            let unit = [1.0, 1e-9, 1e9][k as usize % 3];
            let first = Complex64::new(1.0, -tilt) * Complex64::cis(turn);
            let phasors = [first, c * Complex64::cis(3.0 * turn)].map(|p| p * unit);
            let vector = finder.of_vector(&phasors, &[Complex64::default(); 2]);
            for found in [finder.along_axis(&phasors), vector] {
                let apart = found / unit - peak;
                // A few roundings of three terms; the samples miss the peak.
                let allowed = -2e-15..=2e-15 + 1e-8 * s * s;
                assert!(allowed.contains(&apart), "{s} {tilt} {k}: {apart:e}");
            }
        }
    }
}

#[test]
fn high_orders_peak_where_they_meet() {
    let finder = finder(&[999, 1000]);
    for k in 0..40 {
        let at = 0.151 * f64::from(k);
        let phasors = [999.0, 1000.0].map(|n| Complex64::cis(-n * at));
        // The thousandth power of e^{iθ} has a thousand times its rounding.
        let peak = finder.along_axis(&phasors);
        assert!((peak - 2.0).abs() < 5e-13, "{k}: {peak}");
    }
}

#[test]
fn a_dip_is_not_taken_for_a_peak() {
    // −(θ² − 1/100)² between −1/4 and 1/4, where the slope in the middle is exactly zero.
    let hump = |θ: f64| {
        let rest = θ * θ - 0.01;
        [-rest * rest, -4.0 * θ * rest, -4.0 * (rest + 2.0 * θ * θ)]
    };
    let ends = [hump(-0.25), hump(0.25)];
    let interval = Interval { from: -0.25, width: 0.5, ends };
    assert!(interval.rises_then_falls());
    let peak = interval.polish(&hump);
    // The peak is zero, the dip −1e-4; 1e-9 of the width off the top is its square.
    assert!((-1e-17..=0.0).contains(&peak), "{peak}");
}

#[test]
fn orders_in_any_order_and_with_a_common_factor() {
    let phasors = [1.0, 0.7, -0.4].map(|re| Complex64::new(re, 0.3 * re * re));
    let [a, b, c] = phasors;
    let peak = finder(&[2, 6, 8]).along_axis(&phasors);
    assert!((finder(&[8, 2, 6]).along_axis(&[c, a, b]) - peak).abs() < 1e-14);
    assert!((finder(&[1, 3, 4]).along_axis(&phasors) - peak).abs() < 1e-14);
    assert!((sampled(&[2, 6, 8], &phasors, 20_000) - peak).abs() < 1e-5);
}

proptest! {
    #[test]
    fn no_sample_is_higher_and_a_dense_one_as_high(
        orders in proptest::sample::subsequence((1_u32..12).collect::<Vec<_>>(), 1..6),
        parts in proptest::collection::vec((-1.0..1.0, -1.0..1.0), 6),
    ) {
        let phasors: Vec<_> =
            orders.iter().zip(&parts).map(|(_, &(re, im))| Complex64::new(re, im)).collect();
        let peak = finder(&orders).along_axis(&phasors);
        let dense = sampled(&orders, &phasors, 20_000);
        let size: f64 = phasors.iter().map(|p| p.norm()).sum();
        // rounding of six terms, and of θ·n at the samples
        prop_assert!(dense <= peak + 1e-13 * size);
        // half a step of 20 000 at order 11: (11·1.6e-4)²/2 = 1.5e-6 of the size
        prop_assert!(peak <= dense + 2e-6 * size);
    }
}

#[test]
fn peaks_about_a_mean_are_those_of_samples() {
    // A table of cosines, and a Fourier transform.
    for highest in [6, 700] {
        let orders: Vec<u32> = (1..=highest).collect();
        let phasor = |&n: &u32| Complex64::new(f64::from(n).sin(), 1.0) / f64::from(n * n);
        let phasors: Vec<Complex64> = orders.iter().map(phasor).collect();
        let finder = PeakFinder::about_mean(&Order::all_whole(&orders).unwrap()).unwrap();
        for mean in [0.0, 0.7, -3.0] {
            let found = finder.beside_mean(mean, &phasors, &Cancel::new()).unwrap();
            let with_mean: Vec<u32> = [0].iter().chain(&orders).copied().collect();
            let all: Vec<Complex64> = [mean.into()].iter().chain(&phasors).copied().collect();
            let sampled = sampled(&with_mean, &all, 20_000);
            // Samples are π/20 000 off at most, the second derivative is below 1000.
            assert!(found >= sampled - 1e-12 && found < sampled + 1e-4, "{found} {sampled}");
        }
    }
}

#[test]
fn a_sum_needs_a_phasor_of_each_order() {
    let one = [Complex64::new(1.0, 0.0)];
    let error = finder(&[1, 2]).0.along_axis(&one, &Cancel::new()).unwrap_err().to_string();
    assert!(error.contains("phasors"), "{error}");
}
