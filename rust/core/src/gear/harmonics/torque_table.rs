//! Torque harmonics of many slider-cranks without offset at once.

use super::table::write_centred;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::memory;

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
                let fraction = 2.0 * height / (λ * λ) * p.powi(n as i32);
                *value = half * (sign * fraction + of_crank);
            }
            continue;
        }
        let place = |order: u32| forces.partition_point(|&other| other < order);
        let (below, above) = (place(n - 1), place(n + 1));
        for (value, row) in values.zip(table.chunks_exact(forces.len())) {
            // h'ₙ = i·aₙ/n, and none of order 0.
            let slope = |n: u32, place: usize| if n == 0 { 0.0 } else { row[place] / f64::from(n) };
            *value = half * (slope(n + 1, above) - slope(n - 1, below));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::harmonics::torque::torque;
    use crate::gear::slider_crank::Proportions;

    /// The rows agree with [`torque`], one slider-crank at a time.
    fn check(orders: &[u32]) {
        let ratios = [1e-3, 0.1, 0.285, 0.3, 0.5, 0.9, 0.999];
        let mut rows = vec![0.0; ratios.len() * orders.len()];
        write_centred_roll(&ratios, orders, &mut rows, &Cancel::new()).unwrap();
        for (&λ, row) in ratios.iter().zip(rows.chunks(orders.len())) {
            let of_one = Proportions::new(λ, 0.0).unwrap();
            let known = torque(&of_one, orders, &Cancel::new()).unwrap();
            let largest = known.roll.iter().map(|z| z.norm()).fold(0.0, f64::max);
            for (value, known) in row.iter().zip(&known.roll) {
                // Some ten roundings, of differences that halve the larger term.
                assert!((value - known.im).abs() <= 1e-14 * largest, "{λ}: {value} {known}");
                assert_eq!(known.re, 0.0);
            }
        }
    }

    #[test]
    fn rows_are_the_harmonics_of_each_slider_crank() {
        check(&[7, 1, 2, 3, 4, 5, 6, 8, 9, 12]);
        // Even orders need no forces.
        check(&[2]);
        check(&[2, 4]);
    }
}
