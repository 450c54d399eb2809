//! Harmonics of many slider-cranks at once.

use std::ops::Range;

use ndarray::Array2;

use super::centred::{ALL_DIGITS, Centred, leading, may_be_missing, next_term};
use super::force::coefficients;
use super::near_one;
use super::roots::{NEGLIGIBLE_LOG, Root};
use crate::Complex64;
use crate::mechanism::slider_crank::Proportions;
use crate::mechanism::with_ratios;
use crate::numbers::cancel::Cancel;
use crate::numbers::double::fused;
use crate::numbers::error::Result;
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::{self, Order};
use crate::numbers::pool;
use crate::numbers::simd::{MultiplyAdd, vectorised};

/// Up to this order repeated multiplication to the power below it is within 2e-15.
const LARGEST_PLAIN_ORDER: u32 = 16;

/// `aₙ` without offset, real, for every rod ratio (rows) and order (columns).
pub fn centred_table(rod_ratios: &[f64], orders: &[u32], cancel: &Cancel) -> Result<Array2<f64>> {
    check_size::<f64>(rod_ratios.len(), orders)?;
    let mut values = memory::zeros(rod_ratios.len() * orders.len())?;
    write_centred(rod_ratios, orders, None, &mut values, cancel)?;
    memory::array("rod_ratio", (rod_ratios.len(), orders.len()), values)
}

/// [`centred_table`] into memory that is there, row by row; with `rtol` each is within that of itself,
/// from as many terms as it takes.
pub fn write_centred(
    rod_ratios: &[f64],
    orders: &[u32],
    rtol: Option<f64>,
    out: &mut [f64],
    cancel: &Cancel,
) -> Result<()> {
    let rtol = rtol.map_or(Ok(ALL_DIGITS), limits::tolerance)?;
    let longest = Horner::tables(orders, rtol, rod_ratios, cancel)?;
    fill(rod_ratios.len(), orders.len(), out, cancel, |range, rows| {
        centred_rows(&rod_ratios[range], orders, rtol, &longest, rows, cancel)
    })
}

/// `aₙ` for every pair of rod ratio and offset over r (rows) and order (columns), into memory that is
/// there.
pub fn write_offset(
    rod_ratios: &[f64],
    offsets: &[f64],
    orders: &[u32],
    out: &mut [Complex64],
    cancel: &Cancel,
) -> Result<()> {
    let pairs = rod_ratios.len();
    limits::same_length("offset", offsets.len(), "rod_ratio", pairs, "value")?;
    fill(pairs, orders.len(), out, cancel, |range, rows| {
        let pairs = rod_ratios[range.clone()].iter().zip(&offsets[range]);
        for ((&rod_ratio, &offset), row) in pairs.zip(rows.chunks_exact_mut(orders.len())) {
            let values = if rod_ratio == 0.0 {
                with_ratios(rod_ratio, offset)?.force(orders, cancel)?
            } else {
                coefficients(&Proportions::new(rod_ratio, offset)?, orders, cancel)?
            };
            row.copy_from_slice(&values);
        }
        Ok(())
    })
}

/// A table of numbers of type `T` is not too large.
pub fn check_size<T>(rows: usize, orders: &[u32]) -> Result<()> {
    order::check_list(&Order::all_whole(orders)?)?;
    let hint = "split rod_ratio into parts";
    limits::result_size("rod_ratio", &[rows, orders.len()], size_of::<T>(), hint)
}

/// Fill the rows of a table in parallel, chunk by chunk.
pub(crate) fn fill<T: Send>(
    rows: usize,
    width: usize,
    out: &mut [T],
    cancel: &Cancel,
    write: impl Fn(Range<usize>, &mut [T]) -> Result<()> + Sync,
) -> Result<()> {
    const RATIOS_PER_TASK: usize = 2048;
    if width == 0 {
        return Ok(());
    }
    if rows <= RATIOS_PER_TASK {
        return write(0..rows, out);
    }
    cancel.expect(rows.div_ceil(RATIOS_PER_TASK));
    let chunks = memory::collected(out.chunks_mut(RATIOS_PER_TASK * width).enumerate())?;
    pool::map(cancel, chunks, |(chunk, out)| {
        cancel.step()?;
        write(chunk * RATIOS_PER_TASK..rows.min((chunk + 1) * RATIOS_PER_TASK), out)
    })
    .map(drop)
}

/// How many rod ratios go through a polynomial side by side.
const RATIOS_SIDE_BY_SIDE: usize = 16;

/// Orders between two checks for cancellation.
const ORDERS_PER_CHECK: usize = 16;

/// The rows of a block of rod ratios, in lanes; one near λ = 1 goes by itself.
fn centred_rows(
    rod_ratios: &[f64],
    orders: &[u32],
    rtol: f64,
    tables: &[Horner],
    rows: &mut [f64],
    cancel: &Cancel,
) -> Result<()> {
    rod_ratios.iter().try_for_each(|&rod_ratio| Proportions::check_rod_ratio(rod_ratio))?;
    let width = orders.len();
    vectorised(
        #[inline(always)]
        || {
            for (ratios, rows) in rod_ratios
                .chunks(RATIOS_SIDE_BY_SIDE)
                .zip(rows.chunks_mut(RATIOS_SIDE_BY_SIDE * width))
            {
                // What a lane is given does not show in others: rows depend on their own ratio alone.
                let mut lanes = [0.5; RATIOS_SIDE_BY_SIDE];
                for (lane, &λ) in lanes.iter_mut().zip(ratios) {
                    *lane = if is_alone(λ) { 0.5 } else { λ };
                }
                lanes_of_rows(&lanes, orders, tables, rows, cancel)?;
                for (&λ, row) in ratios.iter().zip(rows.chunks_exact_mut(width)) {
                    if !is_alone(λ) {
                        continue;
                    }
                    if λ == 0.0 {
                        let only = |n: u32| if n == 1 { 1.0 } else { 0.0 };
                        row.iter_mut().zip(orders).for_each(|(value, &n)| *value = only(n));
                        continue;
                    }
                    let centred = Centred::new(&Proportions::new(λ, 0.0)?);
                    for (&n, value) in orders.iter().zip(row) {
                        // Near λ = 1 an order takes up to a tenth of a millisecond.
                        cancel.check()?;
                        *value = centred.coefficient(n, rtol);
                    }
                }
            }
            Ok(())
        },
    )
}

/// Whether a rod ratio takes no lane: one near 1, and that of an infinite rod.
#[inline(always)]
fn is_alone(rod_ratio: f64) -> bool {
    near_one::is_near(rod_ratio) || rod_ratio == 0.0
}

/// p of a rod ratio, to a few units in the last place.
#[inline(always)]
fn root(λ: f64) -> f64 {
    λ / (1.0 + ((1.0 - λ) * (1.0 + λ)).sqrt())
}

#[inline(always)]
fn lanes_of_rows(
    rod_ratios: &[f64; RATIOS_SIDE_BY_SIDE],
    orders: &[u32],
    tables: &[Horner],
    rows: &mut [f64],
    cancel: &Cancel,
) -> Result<()> {
    let width = orders.len();
    let mut p = [0.0; RATIOS_SIDE_BY_SIDE];
    for (p, &λ) in p.iter_mut().zip(rod_ratios) {
        *p = root(λ);
    }
    let square = p.map(|p| p * p);
    let fourth = square.map(|s| s * s);
    // What rounding took from p, and from its square, relative to them: they go into powers.
    let (mut of_p, mut of_square) = ([0.0; RATIOS_SIDE_BY_SIDE], [0.0; RATIOS_SIDE_BY_SIDE]);
    for lane in 0..RATIOS_SIDE_BY_SIDE {
        let (λ, p, square) = (rod_ratios[lane], p[lane], square[lane]);
        let rest = fused(p, p, -square);
        // Residual of λ(1 + p²) = 2p, where λ − 2p is exact, and a step of Newton's method.
        let residual = fused(λ, square, λ - 2.0 * p) + λ * rest;
        of_p[lane] = residual / ((2.0 - 2.0 * λ * p) * p);
        of_square[lane] = rest / square;
    }
    let largest = fourth.iter().fold(0.0, |a: f64, &b| a.max(b));
    for (column, (&n, table)) in orders.iter().zip(tables).enumerate() {
        // Orders of sixteen lanes take microseconds, and eight checks are one look at the clock.
        if column % ORDERS_PER_CHECK == 0 {
            cancel.check()?;
        }
        if n == 1 || n % 2 == 1 {
            let value = if n == 1 { 1.0 } else { 0.0 };
            rows.iter_mut().skip(column).step_by(width).for_each(|v| *v = value);
            continue;
        }
        let mut sum = [0.0; RATIOS_SIDE_BY_SIDE];
        let needed = table.terms.iter().take_while(|(_, from)| largest > *from).count();
        for &(term, from) in table.terms[..needed].iter().rev() {
            for lane in 0..RATIOS_SIDE_BY_SIDE {
                let term = if fourth[lane] > from { term } else { 0.0 };
                sum[lane] = (sum[lane] + term) * fourth[lane];
            }
        }
        let mut power = p;
        if n <= LARGEST_PLAIN_ORDER {
            let squares = n / 2 - 1;
            for _ in 0..squares {
                for lane in 0..RATIOS_SIDE_BY_SIDE {
                    power[lane] *= square[lane];
                }
            }
            let (degree, squares) = (f64::from(n - 1), f64::from(squares));
            for lane in 0..RATIOS_SIDE_BY_SIDE {
                let correction = degree * of_p[lane] + squares * of_square[lane];
                power[lane] = power[lane].multiply_add(correction, power[lane]);
            }
        } else {
            for lane in 0..RATIOS_SIDE_BY_SIDE {
                let Ok(proportions) = Proportions::new(rod_ratios[lane], 0.0) else {
                    continue;
                };
                power[lane] = Root::new(proportions.above).power(n - 1);
            }
        }
        for lane in 0..RATIOS_SIDE_BY_SIDE {
            power[lane] = table.leading * power[lane] * (1.0 - sum[lane]);
        }
        rows.iter_mut().skip(column).step_by(width).zip(power).for_each(|(v, p)| *v = p);
    }
    Ok(())
}

/// The polynomial in p⁴ that belongs to one even order.
struct Horner {
    /// `±n²·|b_m|`, with b the coefficients of √(1 − x) and n = 2m.
    leading: f64,
    /// `|b_j| b_{j+m} / b_m` for j = 1, 2, …, and the p⁴ above which the term matters.
    terms: Vec<(f64, f64)>,
}

impl Horner {
    /// A table for each order, as long as the largest of the rod ratios needs.
    fn tables(orders: &[u32], rtol: f64, rod_ratios: &[f64], cancel: &Cancel) -> Result<Vec<Self>> {
        let within = rod_ratios.iter().filter(|&&λ| !near_one::is_near(λ));
        // Others' lanes are filled with 1/2.
        let largest = within.fold(0.5_f64, |a, &b| a.max(b));
        let fourth = root(largest).powi(4);
        let count = (NEGLIGIBLE_LOG / -fourth.ln()).ceil() as usize;
        let negligible: Vec<f64> = (0..count).map(|j| (-NEGLIGIBLE_LOG / j as f64).exp()).collect();
        let table = |&n: &u32| {
            // The factor in front of an order takes as many steps as half of it.
            cancel.check()?;
            Ok(Self::new(n, &negligible, fourth, rtol))
        };
        orders.iter().map(table).collect()
    }

    /// `negligible` has for each term the p⁴ up to which it is below rounding.
    fn new(n: u32, negligible: &[f64], largest_fourth: f64, rtol: f64) -> Self {
        let m = f64::from(n / 2);
        let mut term = 0.5 * (m - 0.5) / (m + 1.0);
        let mut terms = Vec::with_capacity(negligible.len());
        // From term j on all are below |b_j| p^{4j}/(1 − p⁴), and |b| ≤ 1/2.
        let missing = 2.0 * (1.0 - largest_fourth) * may_be_missing(n, rtol);
        for (j, &negligible) in (1_u32..).zip(negligible) {
            let within = if missing > 0.0 { missing.powf(1.0 / f64::from(j)) } else { 0.0 };
            terms.push((term, negligible.max(within)));
            term *= next_term(f64::from(j), m);
        }
        Self { leading: leading(n), terms }
    }
}

/// Imaginary part of order n of the roll torque over m·r²·ω² for every rod ratio (rows) and order
/// (columns), into memory that is there; the real part is zero, and the torque on the crank its
/// negative.
///
/// The sums of [`super::torque::torque`], where without offset every second term is zero.
pub fn write_centred_roll(
    rod_ratios: &[f64],
    orders: &[u32],
    out: &mut [f64],
    cancel: &Cancel,
) -> Result<()> {
    let mut forces: Vec<u32> =
        orders.iter().filter(|&&n| n % 2 == 1).flat_map(|&n| [n.max(3) - 1, n + 1]).collect();
    forces.sort_unstable();
    forces.dedup();
    let mut table = memory::zeros(rod_ratios.len() * forces.len())?;
    write_centred(rod_ratios, &forces, None, &mut table, cancel)?;
    for (column, &n) in orders.iter().enumerate() {
        let half = 0.5 * f64::from(n);
        let values = out.iter_mut().skip(column).step_by(orders.len());
        if n % 2 == 0 {
            let sign = if n.is_multiple_of(4) { -1.0 } else { 1.0 };
            let of_crank = if n == 2 { -1.0 } else { 0.0 };
            for (value, &λ) in values.zip(rod_ratios) {
                let height = ((1.0 - λ) * (1.0 + λ)).sqrt();
                let p = λ / (1.0 + height);
                let fraction = match λ {
                    // cos²θ
                    0.0 => {
                        if n == 2 {
                            0.5
                        } else {
                            0.0
                        }
                    }
                    _ => 2.0 * height / (λ * λ) * p.powi(n as i32),
                };
                *value = half * (sign * fraction + of_crank);
            }
            continue;
        }
        // Of even orders n + 1 is the first above n, and n − 1 the last below.
        let above = forces.partition_point(|&order| order < n);
        for (value, row) in values.zip(table.chunks_exact(forces.len())) {
            // h'ₙ = i·aₙ/n, and none of order 0.
            let below = if n == 1 { 0.0 } else { row[above - 1] / f64::from(n - 1) };
            *value = half * (row[above] / f64::from(n + 1) - below);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows agree with the torques of [`with_ratios`], one slider-crank at a time.
    fn check(orders: &[u32]) {
        let ratios = [0.0, 1e-3, 0.1, 0.285, 0.3, 0.5, 0.9, 0.999];
        let mut rows = vec![0.0; ratios.len() * orders.len()];
        write_centred_roll(&ratios, orders, &mut rows, &Cancel::new()).unwrap();
        for (&λ, row) in ratios.iter().zip(rows.chunks(orders.len())) {
            let known = with_ratios(λ, 0.0).unwrap().torque(orders, &Cancel::new()).unwrap();
            let largest = known.roll.iter().map(|z| z.norm()).fold(0.0, f64::max);
            for (value, known) in row.iter().zip(&known.roll) {
                // Some ten roundings, of differences that halve the larger term.
                assert!((value - known.im).abs() <= 1e-14 * largest, "{λ}: {value} {known}");
                assert_eq!(known.re, 0.0);
            }
        }
    }

    #[test]
    fn cancellation_is_checked_between_orders() {
        let orders: Vec<u32> = (1..=1000).collect();
        let calls = |ratios: &[f64]| {
            let cancel = Cancel::polling(|_| false);
            let mut rows = vec![0.0; ratios.len() * orders.len()];
            write_centred(ratios, &orders, None, &mut rows, &cancel).unwrap();
            cancel.calls().unwrap() as usize
        };
        let (count, table) = (orders.len(), orders.len());
        let lanes = count / ORDERS_PER_CHECK;
        assert!(calls(&[0.3]) >= table + lanes);
        assert!(calls(&[0.3; 17]) >= table + 2 * lanes);
        assert!(calls(&[0.995; 3]) >= table + 3 * count);
    }

    #[test]
    fn rows_are_the_harmonics_of_each_slider_crank() {
        check(&[7, 1, 2, 3, 4, 5, 6, 8, 9, 12]);
        // Each odd order needs two of the forces, that no other asks for.
        check(&[1, 7]);
        // Even orders need no forces.
        check(&[2]);
        check(&[2, 4]);
    }
}
