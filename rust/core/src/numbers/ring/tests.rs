use super::*;
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use std::f64::consts::TAU;

/// A generator of the same numbers each time.
fn numbers(mut state: u64) -> impl FnMut(u64) -> i128 {
    move |below| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        i128::from((state >> 33) % below)
    }
}

fn sum(period: i128, terms: &[(i128, i128)]) -> RootSum {
    let listed: Vec<_> = terms.iter().map(|&(e, w)| (e, period, w)).collect();
    RootSum::new(&listed, 1).unwrap()
}

#[test]
fn known_polynomials() {
    assert_eq!(cyclotomic(1).unwrap(), [-1, 1]);
    assert_eq!(cyclotomic(2).unwrap(), [1, 1]);
    assert_eq!(cyclotomic(7).unwrap(), [1; 7]);
    assert_eq!(cyclotomic(12).unwrap(), [1, 0, -1, 0, 1]);
    assert_eq!(cyclotomic(24).unwrap(), [1, 0, 0, 0, -1, 0, 0, 0, 1]);
    // The first with a coefficient other than 0 and ±1, and the first with 3.
    assert_eq!(cyclotomic(105).unwrap()[7], -2);
    assert_eq!(cyclotomic(385).unwrap().iter().map(|c| c.abs()).max(), Some(3));
    assert!(cyclotomic(0).is_err());
    assert!(cyclotomic(LARGEST_REDUCED + 1).is_err());
}

#[test]
fn their_products_over_divisors_are_x_to_the_n_less_one() {
    for n in 1..=120_i128 {
        let mut product = vec![1_i128];
        for d in (1..=n).filter(|d| n % d == 0) {
            let factor = cyclotomic(d).unwrap();
            let mut next = vec![0; product.len() + factor.len() - 1];
            for (i, a) in product.iter().enumerate() {
                for (j, b) in factor.iter().enumerate() {
                    next[i + j] += a * b;
                }
            }
            product = next;
        }
        let mut expected = vec![0; n as usize + 1];
        (expected[0], expected[n as usize]) = (-1, 1);
        assert_eq!(product, expected);
    }
}

#[test]
fn all_roots_of_one_period_cancel_and_fewer_do_not() {
    for n in 2..=1000 {
        let all: Vec<_> = (0..n).map(|k| (k, 1)).collect();
        assert!(sum(n, &all).vanishes().unwrap(), "{n}");
        assert!(!sum(n, &all[1..]).vanishes().unwrap(), "{n}");
        assert_eq!(cyclotomic(n).unwrap().iter().sum::<i128>(), at_one(n), "{n}");
    }
}

/// `Φ_n(1)`: p for a power of the prime p, else 1.
fn at_one(n: i128) -> i128 {
    match primes(n as u64)[..] {
        [prime] => prime.into(),
        _ => 1,
    }
}

#[test]
fn both_ways_to_zero_agree_and_with_floating_point() {
    let mut random = numbers(7);
    let mut zeros = 0;
    for n in 2..=1000_i128 {
        let mut terms: Vec<(i128, i128)> = Vec::new();
        // Rotated sets of p-th roots cancel; now and then something is left over.
        let primes: Vec<i128> = primes(n as u64).into_iter().map(i128::from).collect();
        for _ in 0..3 {
            let (p, start, weight) =
                (primes[random(primes.len() as u64) as usize], random(n as u64), random(9) - 4);
            terms.extend((0..p).map(|k| ((start + k * (n / p)) % n, weight)));
        }
        if random(2) == 1 {
            terms.push((random(n as u64), random(3) - 1));
        }
        let sum = sum(n, &terms);
        let vanishes = sum.vanishes().unwrap();
        if n <= 360 {
            let mut weights = vec![0; n as usize];
            for &(e, w) in &terms {
                weights[e as usize] += w as i64;
            }
            let ring = Ring::new(n as u32).unwrap();
            assert_eq!(vanishes, ring.vanishes(&weights, &mut Vec::new()), "{n}");
        }
        let (mut re, mut im) = (0.0, 0.0);
        for &(e, w) in &terms {
            let (sin, cos) = (TAU * e as f64 / n as f64).sin_cos();
            re += w as f64 * cos;
            im += w as f64 * sin;
        }
        // What is left over is ±1; what cancels leaves 1e-16 of 4 · 3000 terms.
        assert_eq!(vanishes, f64::hypot(re, im) < 1e-9, "{n}: {re} {im}");
        zeros += i32::from(vanishes);
    }
    assert!((400..900).contains(&zeros), "{zeros}");
}

#[test]
fn real_parts_are_what_they_were() {
    let mut random = numbers(3);
    for n in 1..=360_i128 {
        let terms: Vec<_> = (0..5).map(|_| (random(n as u64), random(19) - 9)).collect();
        let found = sum_of_period(n, &terms).twice_real(&Cancel::new()).unwrap();
        let degree = cyclotomic(n).unwrap().len() - 1;
        assert_eq!(found.len(), (degree / 2).max(1));
        let cosine = |k: i128| (TAU * k as f64 / n as f64).cos();
        let expected: f64 = terms.iter().map(|&(e, w)| 2.0 * w as f64 * cosine(e)).sum();
        let value: f64 = found
            .iter()
            .enumerate()
            .map(|(k, &c)| c as f64 * if k == 0 { 1.0 } else { 2.0 * cosine(k as i128) })
            .sum();
        assert!((value - expected).abs() < 1e-10, "{n}: {value} {expected}");
    }
}

fn sum_of_period(period: i128, terms: &[(i128, i128)]) -> RootSum {
    let listed: Vec<_> = terms.iter().map(|&(e, w)| (e, period, w)).collect();
    RootSum::new(&listed, period).unwrap()
}

#[test]
fn a_real_part_has_one_form() {
    // The five fifth roots add to nothing: ζ = −(1 + ζ² + ζ³ + ζ⁴).
    let one = sum_of_period(5, &[(1, 1)]).twice_real(&Cancel::new()).unwrap();
    let other =
        sum_of_period(5, &[(0, -1), (2, -1), (3, -1), (4, -1)]).twice_real(&Cancel::new()).unwrap();
    assert_eq!(one, other);
}

#[test]
fn sums_turn_and_are_mirrored_as_the_numbers_they_are() {
    let value = |sum: &RootSum| -> Complex64 {
        let angle = |e: i128| TAU * e as f64 / sum.period() as f64;
        sum.terms.iter().map(|&(e, w)| Complex64::cis(angle(e)) * w as f64).sum()
    };
    let near = |a: Complex64, b: Complex64| assert!((a - b).norm() < 1e-13, "{a} {b}");
    for period in [1, 2, 12, 15] {
        let sum = sum_of_period(period, &[(0, 3), (1, -2), (4, 5), (7, 1)]);
        assert_eq!(sum.period(), period);
        near(value(&sum.conjugate()), value(&sum).conj());
        for k in -2..=2 * period {
            let turn = Complex64::cis(TAU * k as f64 / period as f64);
            near(value(&sum.turned(k, period)), value(&sum) * turn);
            near(value(&sum.turned(2 * k, 2 * period)), value(&sum) * turn);
        }
    }
}

#[test]
fn squares_of_sizes() {
    // |1 + 3i|² = 10.
    let square = sum_of_period(4, &[(0, 1), (1, 3)]).squared_size().unwrap();
    assert_eq!(square.twice_real(&Cancel::new()).unwrap(), [20]);
    assert_eq!(square.turned(1, 4).twice_real(&Cancel::new()).unwrap(), [0]);
}

#[test]
fn what_is_too_large_is_refused() {
    let huge = i128::MAX;
    assert!(RootSum::new(&[(1, 3, huge), (1, 3, huge)], 1).is_err());
    assert!(sum(6, &[(0, huge), (2, huge), (4, huge)]).squared_size().is_err());
    assert!(RootSum::new(&[(1, 999_999_937, 1), (1, 1009, 1)], 1).is_err());
    let largest = sum(999_999_937, &[(1, 1), (5, -1)]);
    assert!(!largest.vanishes().unwrap());
    assert!(largest.squared_size().is_err());
}

#[test]
fn all_roots_sum_to_nothing() {
    for parts in 2..=60 {
        let ring = Ring::new(parts).unwrap();
        assert!(ring.remainder(&vec![1; parts as usize]).iter().all(|&c| c == 0), "{parts}");
        let mut one = vec![0; parts as usize];
        one[parts as usize - 1] = 1;
        // ζ^{N−1}·conj(ζ^{N−1}) = 1
        let mut product = Vec::new();
        ring.times_conjugate(&one, &one, &mut product);
        assert_eq!(ring.remainder(&product), ring.powers[0]);
    }
}
