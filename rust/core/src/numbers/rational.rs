//! Figures as rational multiples of one another.
//!
//! Places and masses come as doubles: 0, 0.1, 0.2, 0.3 stand for equal steps although 0.3 is not
//! three times 0.1 in binary. Taken at their last bit they would leave 1e-17 of a sum that
//! vanishes; so decimals are exact ([`crate::numbers::decimal`]), and another figure is taken for
//! p/q of one, q ≤ 10 000, where it is within a few units in the last place of it. One that is no
//! such multiple is a unit of its own.

use crate::numbers::cancel::Cancel;
use crate::numbers::decimal::{WITHIN_ULP, meant};
use crate::numbers::error::Result;
use std::iter::zip;

/// Largest denominator: millimetres of an engine of ten metres.
const LARGEST_DENOMINATOR_OF_RATIO: f64 = 10_000.0;
/// Ratios that are known less well than this are not looked for: with tolerance t, a figure at
/// random is taken for a ratio with a chance of t times the square of [`LARGEST_DENOMINATOR_OF_RATIO`].
const COARSEST: f64 = 1e-12;

/// Number of figures among which one that is equal is looked for.
const ALIKE_WITHIN: usize = 8;

/// A rational number in lowest terms, denominator > 0. Its checked arithmetic gives None where it
/// overflows.
pub type Ratio = num_rational::Ratio<i128>;

/// The nearest double to a quotient, its denominator not 0 (beyond 72 bits one beside it).
#[must_use]
pub fn nearest(numerator: i128, denominator: i128) -> f64 {
    let (above, below) = (numerator.unsigned_abs(), denominator.unsigned_abs());
    let exact = |whole: u128| whole <= 1 << 53;
    if numerator == 0 || exact(above) && exact(below) || below >= 1 << 72 {
        return numerator as f64 / denominator as f64;
    }
    // At least 55 bits of the quotient, the last of them 1 if anything is left: rounded once.
    let shift = above.leading_zeros();
    let shifted = above << shift;
    let quotient = (shifted / below) | u128::from(!shifted.is_multiple_of(below));
    let size = quotient as f64 * 0.5_f64.powi(shift as i32);
    if (numerator < 0) == (denominator < 0) { size } else { -size }
}

/// Numerator and denominator where products of two of them fit 64 bits: a division of 128 takes some ten
/// times as long.
fn small(ratio: Ratio) -> Option<[i64; 2]> {
    let part = |whole: i128| i32::try_from(whole).ok().map(i64::from);
    Some([part(*ratio.numer())?, part(*ratio.denom())?])
}

/// A quotient in lowest terms, of a denominator > 0.
fn lowest_terms(numerator: i64, denominator: i64) -> Ratio {
    let divisor = divisor(numerator.unsigned_abs(), denominator.unsigned_abs()) as i64;
    Ratio::new_raw((numerator / divisor).into(), (denominator / divisor).into())
}

/// The product. None where it overflows.
#[must_use]
pub fn product(a: Ratio, b: Ratio) -> Option<Ratio> {
    match (small(a), small(b)) {
        (Some([n, d]), Some([m, e])) => Some(lowest_terms(n * m, d * e)),
        _ => num_traits::CheckedMul::checked_mul(&a, &b),
    }
}

/// The sum of two parts of a turn, less whole turns. Denominators are below 10⁹.
#[must_use]
pub fn turned(a: Ratio, b: Ratio) -> Ratio {
    if let (Some([n, d]), Some([m, e])) = (small(a), small(b)) {
        let common = d / divisor(d.unsigned_abs(), e.unsigned_abs()) as i64 * e;
        let part = |numerator: i64, denominator: i64| {
            numerator.rem_euclid(denominator) * (common / denominator)
        };
        let sum = part(n, d) + part(m, e);
        lowest_terms(if sum < common { sum } else { sum - common }, common)
    } else {
        let sum = a + b;
        sum - sum.floor()
    }
}

/// The largest number of which both are whole multiples, of either sign; 0 if both are 0. None where
/// it overflows.
#[must_use]
pub fn common_measure(a: Ratio, b: Ratio) -> Option<Ratio> {
    if let (Some([n, d]), Some([m, e])) = (small(a), small(b)) {
        let (left, right) = ((n * e).unsigned_abs(), (m * d).unsigned_abs());
        let measure = if left == 0 && right == 0 { 0 } else { divisor(left, right) as i64 };
        return Some(lowest_terms(measure, d * e));
    }
    let left = a.numer().checked_mul(*b.denom())?;
    let right = b.numer().checked_mul(*a.denom())?;
    let common = a.denom().checked_mul(*b.denom())?;
    if left == 0 && right == 0 {
        return Some(Ratio::ZERO);
    }
    Some(Ratio::new(common_divisor(left, right), common))
}

/// Greatest common divisor, > 0; 1 where both are 0.
#[must_use]
pub fn common_divisor(a: i128, b: i128) -> i128 {
    i128::try_from(divisor(a.unsigned_abs(), b.unsigned_abs())).unwrap_or(i128::MAX)
}

/// Greatest common divisor of two numbers without a sign; 1 where both are 0.
pub(crate) fn divisor<T>(mut a: T, mut b: T) -> T
where
    T: Copy + PartialEq + From<u8> + std::ops::Rem<Output = T>,
{
    let zero = T::from(0);
    while b != zero {
        (a, b) = (b, a % b);
    }
    if a == zero { T::from(1) } else { a }
}

/// Least common multiple; None where it overflows.
#[must_use]
pub fn common_multiple(a: i128, b: i128) -> Option<i128> {
    (a / common_divisor(a, b)).checked_mul(b)
}

/// p/q within the tolerance of x, q ≤ [`LARGEST_DENOMINATOR_OF_RATIO`]: the first convergent that is.
pub(crate) fn recognise(x: f64, tolerance: f64) -> Option<Ratio> {
    // A quotient that underflows is of figures that are not zero.
    if tolerance > COARSEST || x.abs() > 1.0 / COARSEST || x == 0.0 {
        return None;
    }
    convergents(x, LARGEST_DENOMINATOR_OF_RATIO)
        .find(|&(p, q)| (p / q - x).abs() <= tolerance)
        .map(|(p, q)| Ratio::new(p as i128, q as i128))
}

/// The convergents p/q of the continued fraction of x, with denominators of `most` at most; whole
/// numbers, exact below 2⁵³.
pub(crate) fn convergents(x: f64, most: f64) -> impl Iterator<Item = (f64, f64)> {
    let (mut p0, mut q0, mut p1, mut q1) = (0.0, 1.0, 1.0, 0.0);
    let mut rest = Some(x);
    std::iter::from_fn(move || {
        let x = rest?;
        let whole = x.floor();
        (p0, q0, p1, q1) = (p1, q1, whole * p1 + p0, whole * q1 + q0);
        rest = (x != whole).then(|| 1.0 / (x - whole));
        (q1 <= most).then_some((p1, q1))
    })
}

/// Figures, each a rational multiple of one of few units.
#[derive(Debug, Clone, PartialEq)]
pub struct Multiples {
    /// Figures of which none is a rational multiple of another; 1 is that of decimals.
    pub units: Vec<f64>,
    /// For each figure the index of its unit and how many of it; figures of zero are 0 times the
    /// first unit.
    pub of: Vec<(usize, Ratio)>,
}

impl Multiples {
    /// Of figures that are decimals, or right within [`WITHIN_ULP`] of their own last place.
    ///
    /// Where some are no decimals, all are first tried as multiples of each other: a double is
    /// sometimes a decimal by chance, and what is a multiple of it then is one of 1 with it.
    pub fn new(figures: &[f64], cancel: &Cancel) -> Result<Self> {
        use num_traits::{CheckedDiv, CheckedMul};
        let mut decimals: Vec<Option<Ratio>> = Vec::with_capacity(figures.len());
        for (i, &figure) in figures.iter().enumerate() {
            // Cylinders are mostly alike, and a decimal is read from text.
            let last = &figures[i.saturating_sub(ALIKE_WITHIN)..i];
            let known = last.iter().rev().position(|known| known.to_bits() == figure.to_bits());
            decimals.push(known.map_or_else(|| decimal(figure), |back| decimals[i - 1 - back]));
        }
        if let Some(of) = decimals.iter().map(|ratio| ratio.map(|r| (0, r))).collect() {
            return Ok(Self { units: vec![1.0], of });
        }
        let together = Self::of_each_other(figures, cancel)?;
        if together.units.len() <= 1 {
            return Ok(together);
        }
        // Each unit as a decimal, by one of its multiples or itself.
        let mut values: Vec<Option<Ratio>> =
            together.units.iter().map(|&unit| recognise(unit, tolerance(unit))).collect();
        for (&(unit, times), known) in together.of.iter().zip(&decimals) {
            if let Some(known) = known.filter(|_| times != Ratio::ZERO) {
                values[unit] = known.checked_div(&times).or(values[unit]);
            }
        }
        let mut units = vec![1.0];
        let mut places = vec![None; together.units.len()];
        let figure = |(&(unit, times), known): (&(usize, Ratio), &Option<Ratio>)| {
            if let Some(of_one) =
                (*known).or(values[unit].and_then(|value| value.checked_mul(&times)))
            {
                return (0, of_one);
            }
            let place = *places[unit].get_or_insert_with(|| {
                units.push(together.units[unit]);
                units.len() - 1
            });
            (place, times)
        };
        let of = zip(&together.of, &decimals).map(figure).collect();
        Ok(Self { units, of })
    }

    /// Figures as multiples of one another, decimals or not.
    fn of_each_other(figures: &[f64], cancel: &Cancel) -> Result<Self> {
        let mut units: Vec<f64> = Vec::new();
        let mut of = vec![(0, Ratio::ZERO); figures.len()];
        // From the largest down, so that ratios and their errors are small.
        let mut falling: Vec<usize> = (0..figures.len()).filter(|&i| figures[i] != 0.0).collect();
        falling.sort_by(|&a, &b| figures[b].abs().total_cmp(&figures[a].abs()));
        for i in falling {
            cancel.check()?;
            let figure = figures[i];
            let multiple = units.iter().enumerate().find_map(|(k, &unit)| {
                let ratio = figure / unit;
                if ratio.abs() == 1.0 {
                    return Some((k, Ratio::from_integer(ratio as i128)));
                }
                recognise(ratio, tolerance(ratio)).map(|r| (k, r))
            });
            of[i] = multiple.unwrap_or_else(|| {
                units.push(figure);
                (units.len() - 1, Ratio::ONE)
            });
        }
        Ok(Self { units, of })
    }
}

/// How well a quotient of two figures is known.
fn tolerance(ratio: f64) -> f64 {
    2.0 * WITHIN_ULP * f64::EPSILON * ratio.abs()
}

/// The decimal that a figure stands for.
pub(crate) fn decimal(x: f64) -> Option<Ratio> {
    meant(x).map(Ratio::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_traits::{CheckedDiv, CheckedMul, CheckedSub};
    use proptest::prelude::*;

    /// Against a division in 128 bits whose remainder decides between neighbouring doubles.
    #[test]
    fn quotients_are_rounded_once() {
        assert_eq!(nearest(0, 7), 0.0);
        assert_eq!(nearest(-1, 3), -1.0 / 3.0);
        // Midway between two doubles, to the even one; and a third beyond.
        let midway = (1 << 54) + 2;
        assert_eq!(nearest(midway, 1), 2_f64.powi(54));
        assert_eq!(nearest(3 * midway + 1, 3), 2_f64.powi(54).next_up());
        // Less than 3072 by a part of 2⁸⁰; in 128 bits the quotient has 48.
        assert_eq!(nearest(3 << 90, (1 << 80) + 1), 3072.0);
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            i128::from(state >> 1)
        };
        let mut compared = 0;
        for k in 0..10_000 {
            // Denominators on both sides of 2⁵³, to which doubles are exact.
            let (above, below) = (random() * 360, (random() >> [13, 8][k % 2]) + 1);
            let found = nearest(-above, below);
            assert_eq!(found, -nearest(above, below));
            // |q − above/below|·2⁴⁰ in whole multiples of 1/below, for q and its neighbours: doubles
            // from 2¹³ on are multiples of 2⁻³⁹.
            let error = |q: f64| ((q * 2_f64.powi(40)) as i128 * below - (above << 40)).abs();
            let found = -found;
            if (8192.0..1e9).contains(&found) {
                assert!(error(found) <= error(found.next_up()).min(error(found.next_down())));
                compared += 1;
            }
        }
        assert!(compared > 5000, "{compared}");
    }

    fn multiples(figures: &[f64]) -> Multiples {
        Multiples::new(figures, &Cancel::new()).unwrap()
    }

    fn ratio(numerator: i128, denominator: i128) -> Ratio {
        Ratio::new(numerator, denominator)
    }

    #[test]
    fn only_what_is_known_well_enough_is_taken_for_a_fraction() {
        assert_eq!(recognise(0.1, COARSEST), Some(ratio(1, 10)));
        assert_eq!(recognise(0.1, COARSEST.next_up()), None);
        assert_eq!(recognise(1e12, 1e-16), Some(ratio(1_000_000_000_000, 1)));
        assert_eq!(recognise(1e12_f64.next_up(), 1e-15), None);
        assert_eq!(recognise(1.0 / 10_000.0, 1e-19), Some(ratio(1, 10_000)));
        assert_eq!(recognise(1.0 / 10_001.0, 1e-19), None);
        assert_eq!(recognise(-9_999.0 / 10_000.0, 1e-15), Some(ratio(-9_999, 10_000)));
        assert_eq!(recognise(0.0, 0.0), None);
        let half = ratio(1, 2);
        assert_eq!(common_measure(Ratio::ZERO, Ratio::ZERO), Some(Ratio::ZERO));
        assert_eq!(common_measure(Ratio::ZERO, half), Some(half));
        assert_eq!(common_measure(half, Ratio::ZERO), Some(half));
    }

    #[test]
    fn decimals_are_taken_as_they_are_meant() {
        assert_ne!(0.3, 3.0 * 0.1);
        let steps = multiples(&[0.1, 0.2, 3.0 * 0.1, -0.3, 0.0]);
        assert_eq!(steps.units, [1.0]);
        let found: Vec<Ratio> = steps.of.iter().map(|&(_, r)| r).collect();
        let tenths = |k| ratio(k, 10);
        assert_eq!(found, [tenths(1), tenths(2), tenths(3), tenths(-3), Ratio::ZERO]);
        // No simple fraction of each other: 48 013 of 51 000 parts.
        assert_eq!(multiples(&[0.480_13, 0.51]).units, [1.0]);
    }

    #[test]
    fn what_is_no_ratio_is_a_unit_of_its_own() {
        let root = 2.0_f64.sqrt();
        let figures = multiples(&[1.0, root, 2.0 * root, 0.25, 1.0 / 3.0]);
        assert_eq!(figures.units, [1.0, 2.0 * root]);
        let expected = [
            (0, ratio(1, 1)),
            (1, ratio(1, 2)),
            (1, ratio(1, 1)),
            (0, ratio(1, 4)),
            (0, ratio(1, 3)),
        ];
        assert_eq!(figures.of, expected);
        // A double among thirds that is a decimal by chance stays their multiple.
        let unit = 0.123_456_789_012;
        let thirds = multiples(&[unit, unit / 3.0, unit / 7.0]);
        assert_eq!(thirds.units, [unit]);
        assert_eq!(thirds.of[1], (0, ratio(1, 3)));
        // So does its half, beside what is no multiple of either.
        let halves = multiples(&[unit * root, 7.0 * unit, 3.5 * unit, 1.75 * unit]);
        assert_eq!(halves.units, [1.0, unit * root]);
        assert_eq!(halves.of[2].1 / halves.of[3].1, ratio(2, 1));
    }

    #[test]
    fn extreme_figures_are_units_or_ratios() {
        for figures in [[1e30, 1e-30], [5e-324, 1e30], [0.0, -0.0], [1e-300, 3e-300]] {
            let found = multiples(&figures);
            for (&figure, &(unit, ratio)) in figures.iter().zip(&found.of) {
                let back = found
                    .units
                    .get(unit)
                    .map_or(0.0, |u| u * nearest(*ratio.numer(), *ratio.denom()));
                assert!((back - figure).abs() <= figure.abs() * 1e-15);
            }
        }
    }

    #[test]
    fn arithmetic_does_not_wrap() {
        let huge = ratio(i128::MAX, 1);
        assert_eq!(huge.checked_mul(&huge), None);
        assert_eq!(huge.checked_sub(&ratio(-1, 1)), None);
        assert_eq!(ratio(1, 2).checked_div(&Ratio::ZERO), None);
        assert_eq!(common_measure(huge, ratio(1, 2)), None);
        assert_eq!(common_measure(ratio(1, 2), ratio(1, 3)), Some(ratio(1, 6)));
        assert_eq!(common_multiple(i128::MAX, i128::MAX - 1), None);
    }

    /// Numbers on both sides of 32 bits, against the arithmetic of 128.
    fn ratios() -> impl Strategy<Value = Ratio> {
        let parts = [1_i128, 2, 3, 360, 999_999_937, i32::MAX.into(), (1 << 31) + 1];
        let whole = [0_i128, 1, -1, 2, 7, -360, i32::MIN.into(), i32::MAX.into(), 1 << 32];
        (select(&whole), select(&parts)).prop_map(|(numerator, parts)| Ratio::new(numerator, parts))
    }

    fn select(from: &[i128]) -> impl Strategy<Value = i128> + use<> {
        proptest::sample::select(from.to_vec())
    }

    proptest! {
        #[test]
        fn small_and_large_numbers_have_one_arithmetic(a in ratios(), b in ratios()) {
            prop_assert_eq!(product(a, b), a.checked_mul(&b));
            let sum = a + b;
            prop_assert_eq!(turned(a, b), sum - sum.floor());
            let measure = common_measure(a, b).unwrap();
            let zero = a == Ratio::ZERO && b == Ratio::ZERO;
            prop_assert_eq!(measure == Ratio::ZERO, zero);
            if !zero {
                let [of_a, of_b] = [a, b].map(|one| one / measure);
                prop_assert!(of_a.is_integer() && of_b.is_integer() && measure > Ratio::ZERO);
                prop_assert_eq!(common_divisor(of_a.to_integer(), of_b.to_integer()), 1);
            }
        }

        #[test]
        fn fractions_are_recognised(p in -999_i32..999, q in 1_i32..999, unit in 0.01..10.0) {
            let figure = f64::from(p) * unit / f64::from(q);
            let found = multiples(&[unit, figure]);
            prop_assert!(found.units.len() == 1);
            if p != 0 {
                let quotient = found.of[1].1.checked_div(&found.of[0].1).unwrap();
                prop_assert_eq!(quotient, ratio(p.into(), q.into()));
            }
        }
    }
}
