//! Harmonics of many link rods at once: as many samples of half a turn as the narrowest strip of some demands.

use std::f64::consts::TAU;

use super::{Linkage, SPARE_LENGTH};
use crate::Complex64;
use crate::mechanism::harmonics::table::{check_size, fill};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::order::Order;
use crate::numbers::simd::{MultiplyAdd, sin_cos_degrees, vectorised};

/// Link rods that are evaluated side by side.
const LANES: usize = 8;
/// Samples of half a turn are a multiple of this.
const STEP: usize = 4;
/// What samples may fold back, as a power of e: 1e-14 times the largest of the motion.
const FOLDED: f64 = 32.0;
/// Most samples of half a turn; link rods with narrower strips are evaluated one by one.
const MOST_SAMPLES: usize = 96;

/// Figures of link rods, one of each for a link rod: lengths over the crank radius, and degrees.
#[derive(Debug, Clone, Copy)]
pub struct LinkFigures<'a> {
    /// r/L.
    pub rod_ratios: &'a [f64],
    /// r/l of the master rods.
    pub master_ratios: &'a [f64],
    /// a/r.
    pub knuckle_ratios: &'a [f64],
    /// D, the bore ahead of the master's.
    pub bores_deg: &'a [f64],
    /// ψ, the knuckle from the master's shank.
    pub knuckles_deg: &'a [f64],
}

/// A sample of half a turn: sine and cosine, and factors of each order.
struct Sample {
    sin: f64,
    cos: f64,
    /// 4/N·n²·e^{−inθ}, and whether the order is odd.
    orders: Vec<(Complex64, bool)>,
}

/// Amplitudes of the force of each link rod at some orders, over m·r·ω²: to 1e-12 of the largest; (n, `n_orders`).
pub fn write(
    figures: LinkFigures,
    orders: &[u32],
    out: &mut [Complex64],
    cancel: &Cancel,
) -> Result<()> {
    let count = figures.rod_ratios.len();
    check_size::<Complex64>(count, orders)?;
    let others = [
        ("master_ratio", figures.master_ratios),
        ("knuckle_ratio", figures.knuckle_ratios),
        ("bore_deg", figures.bores_deg),
        ("knuckle_deg", figures.knuckles_deg),
    ];
    for (name, values) in others {
        limits::same_length(name, values.len(), "rod_ratio", count, "value")?;
    }
    let width = orders.len();
    fill(count, width, out, cancel, |range, rows| {
        let mut tables: Vec<Option<Vec<Sample>>> = Vec::new();
        tables.resize_with(MOST_SAMPLES / STEP + 1, || None);
        let mut lanes = Lanes::default();
        for (from, rows) in range.step_by(LANES).zip(rows.chunks_mut(LANES * width)) {
            let places = from..from + rows.len() / width;
            let reach = lanes.read(&figures, places.clone())?;
            let highest = orders.iter().copied().max().map_or(0.0, f64::from);
            let samples = 0.5 * (highest + (FOLDED + 2.0 * highest.max(1.0).ln()) / reach);
            let samples = (samples / STEP as f64).ceil() * STEP as f64;
            if samples.is_nan() || samples > MOST_SAMPLES as f64 {
                for (i, row) in places.zip(rows.chunks_mut(width)) {
                    row.copy_from_slice(&one(&figures, i, orders, cancel)?);
                }
                continue;
            }
            let samples = samples as usize;
            let table = tables[samples / STEP].get_or_insert_with(|| table(samples, orders));
            let mut sums = vec![[[0.0; LANES]; 2]; width]; // bounded: orders of a table
            vectorised(
                #[inline(always)]
                || lanes.sum(table, &mut sums),
            );
            for (lane, row) in rows.chunks_mut(width).enumerate() {
                for ((value, [re, im]), &n) in row.iter_mut().zip(&sums).zip(orders) {
                    let of_crank = if n == 1 { 1.0 } else { 0.0 };
                    *value = Complex64::new(re[lane] + of_crank, im[lane]);
                }
            }
        }
        Ok(())
    })
}

fn table(samples: usize, orders: &[u32]) -> Vec<Sample> {
    let count = 2 * samples;
    let sample = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
        let factor = |&n: &u32| {
            let turned = Complex64::cis(-TAU * (k * n as usize % count) as f64 / count as f64);
            (turned * (f64::from(n) * f64::from(n) * 2.0 / samples as f64), n % 2 == 1)
        };
        Sample { sin, cos, orders: orders.iter().map(factor).collect() }
    };
    (0..samples).map(sample).collect()
}

/// The amplitudes of one link rod, from as many samples as it takes.
fn one(figures: &LinkFigures, i: usize, orders: &[u32], cancel: &Cancel) -> Result<Vec<Complex64>> {
    orders.iter().try_for_each(|&n| Order::whole(n).map(drop))?;
    let linkage = figures.linkage(i);
    if linkage.farthest(0.0) * (1.0 + SPARE_LENGTH) >= linkage.rod {
        return Err(figures.too_short(i, linkage.farthest(0.0)));
    }
    linkage.force(&linkage.strip(), orders, cancel)
}

impl LinkFigures<'_> {
    /// Of a link rod.
    fn linkage(&self, i: usize) -> Linkage {
        let [mut sin, mut cos] = [[0.0; 2]; 2];
        let degrees = [self.knuckles_deg[i] - self.bores_deg[i], self.bores_deg[i]];
        sin_cos_degrees(&degrees, &mut sin, &mut cos);
        Linkage {
            rod: 1.0 / self.rod_ratios[i],
            radius: self.knuckle_ratios[i],
            knuckle: Complex64::new(cos[0], sin[0]),
            ahead: Complex64::new(cos[1], sin[1]),
            master_ratio: self.master_ratios[i],
            master_offset: 0.0,
        }
    }

    fn too_short(&self, i: usize, farthest: f64) -> Error {
        let most = 1.0 / (farthest * (1.0 + SPARE_LENGTH));
        let hint = format!(
            "the link rod is too short for its knuckle, which goes {farthest:.6} crank radii off its bore: give less \
             than {most:.6}"
        );
        let value = format!(
            "{:?}, master_ratio = {:?}, knuckle_ratio = {:?}, bore_deg = {:?}, knuckle_deg = {:?}",
            self.rod_ratios[i],
            self.master_ratios[i],
            self.knuckle_ratios[i],
            self.bores_deg[i],
            self.knuckles_deg[i]
        );
        Error::value(format!("rod_ratio[{i}]"), value, hint)
    }
}

/// Figures of some link rods; those beyond the last are its copies.
#[derive(Default)]
struct Lanes {
    rod: [f64; LANES],
    master_ratio: [f64; LANES],
    /// a·cos and a·sin of ψ − D.
    knuckle: [[f64; LANES]; 2],
    ahead: [[f64; LANES]; 2],
}

impl Lanes {
    /// Read those at some places; returns the height of the narrowest strip, below zero where one is not known.
    #[inline(always)]
    fn read(&mut self, figures: &LinkFigures, places: std::ops::Range<usize>) -> Result<f64> {
        let mut height = f64::INFINITY;
        for lane in 0..LANES {
            let i = (places.start + lane).min(places.end - 1);
            for (name, values) in
                [("rod_ratio", figures.rod_ratios), ("master_ratio", figures.master_ratios)]
            {
                if !(limits::SMALLEST..1.0).contains(&values[i]) {
                    let hint = "give crank radius over rod length, above 0 and less than 1";
                    return Err(Error::figure(format!("{name}[{i}]"), values[i], hint));
                }
            }
            let numbers =
                [figures.knuckle_ratios[i], figures.bores_deg[i], figures.knuckles_deg[i]];
            if numbers[0] < 0.0 || !numbers.iter().all(|value| value.abs() <= limits::LARGEST) {
                limits::distance(&format!("knuckle_ratio[{i}]"), numbers[0])?;
                limits::finite(&format!("bore_deg[{i}]"), numbers[1])?;
                limits::finite(&format!("knuckle_deg[{i}]"), numbers[2])?;
            }
            let linkage = figures.linkage(i);
            height = height.min(linkage.known_height());
            self.rod[lane] = linkage.rod;
            self.master_ratio[lane] = linkage.master_ratio;
            self.knuckle[0][lane] = linkage.radius * linkage.knuckle.re;
            self.knuckle[1][lane] = linkage.radius * linkage.knuckle.im;
            (self.ahead[0][lane], self.ahead[1][lane]) = (linkage.ahead.re, linkage.ahead.im);
        }
        Ok(height)
    }

    /// Adds the samples of all of them, in the parts that half a turn leaves and negates: as
    /// `Linkage::beyond_crank`.
    #[inline(always)]
    fn sum(&self, table: &[Sample], sums: &mut [[[f64; LANES]; 2]]) {
        for Sample { sin, cos, orders } in table {
            let (mut evens, mut odds) = ([0.0; LANES], [0.0; LANES]);
            for (l, (even_part, odd_part)) in evens.iter_mut().zip(&mut odds).enumerate() {
                let (rod, [along, across]) =
                    (self.rod[l], [self.knuckle[0][l], self.knuckle[1][l]]);
                let from_master = sin * self.ahead[0][l] + cos * self.ahead[1][l];
                let lean = -self.master_ratio[l] * from_master;
                let upright = ((1.0 - lean) * (1.0 + lean)).sqrt();
                let (odd, even) = (sin + along * lean, across * upright);
                let root = |side: f64| ((rod - side) * (rod + side)).sqrt();
                let sum = root(even + odd) + root(even - odd);
                *even_part = along * upright + 0.5 * sum;
                *odd_part = -across * lean - 2.0 * odd * even / sum;
            }
            for ([re, im], (factor, is_odd)) in sums.iter_mut().zip(orders) {
                let part = if *is_odd { &odds } else { &evens };
                for ((re, im), part) in re.iter_mut().zip(im).zip(part) {
                    *re = part.multiply_add(factor.re, *re);
                    *im = part.multiply_add(factor.im, *im);
                }
            }
        }
    }
}
