//! Preparation of measured pressure: peaks of motored traces, offsets of sensors, noise.

use std::f64::consts::TAU;

use nalgebra::DMatrix;
use ndarray::{ArrayView1, ArrayView2, Axis};

use super::chamber::{Chamber, within};
use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::chebyshev::{coefficient, jet, points};
use crate::numbers::error::{Error, Result};
use crate::numbers::figure::significant;
use crate::numbers::fourier::Transform;
use crate::numbers::limits::SMALLEST;
use crate::numbers::singular_values::SingularValues;
use crate::numbers::{memory, pool};

/// Degrees beside the peak of a motored trace within which a polynomial is fitted to it.
const AROUND_PEAK: f64 = 20.0;
/// Its degree: what it leaves of compression, 1e-3, is even and moves no peak; noise of 0.1 bar at every half
/// degree moves it by 0.1°, in the mean of 60 cycles by 0.01°.
const DEGREE_AT_PEAK: usize = 6;
/// Range in which the exponent of compression is fitted: air has 1.4, rich mixtures 1.25.
const EXPONENTS: [f64; 2] = [1.15, 1.45];
/// Degree of the polynomial through what is left at exponents of that range: exact to rounding.
const DEGREE_BY_EXPONENT: usize = 16;
/// Distance from an end of that range up to which the exponent is the end.
const AT_AN_END: f64 = 1e-3;
/// Order of the Butterworth filter.
const STEEPNESS: i32 = 4;
/// Difference of steps, over the largest, up to which a grid is even.
const EVEN_STEPS: f64 = 1e-3;
/// Part of a period that may be missing from one whose last point repeats the first.
const CLOSED_PERIOD: f64 = 1e-9;

/// Crank angle of the largest pressure of a motored cycle, between points, degrees.
///
/// That of a polynomial fitted to the points about the largest one, at which the noise of one point would
/// decide.
pub fn compression_peak(theta_deg: &[f64], pressure: &[f64], period_deg: f64) -> Result<f64> {
    let Some(largest) =
        (0..pressure.len()).reduce(|best, k| if pressure[k] > pressure[best] { k } else { best })
    else {
        return Err(Error::fault("motored", "has no points".into(), "give a trace"));
    };
    let (half, largest) = (0.5 * period_deg, theta_deg[largest]);
    let away = |theta: f64| (theta - largest + half).rem_euclid(period_deg) - half;
    let near: Vec<(f64, f64)> = theta_deg
        .iter()
        .zip(pressure)
        .map(|(&theta, &value)| (away(theta), value))
        .filter(|(away, _)| away.abs() <= AROUND_PEAK)
        .collect();
    if near.len() <= DEGREE_AT_PEAK + 2 {
        let fault = format!("has {} points within {AROUND_PEAK}° of its peak", near.len());
        return Err(Error::fault("motored", fault, "give a finer one"));
    }
    // Chebyshev's polynomials of places in [−1, 1], which a fit distinguishes well.
    let basis = DMatrix::from_fn(near.len(), DEGREE_AT_PEAK + 1, |row, n| {
        (n as f64 * (near[row].0 / AROUND_PEAK).clamp(-1.0, 1.0).acos()).cos()
    });
    let values = DMatrix::from_iterator(near.len(), 1, near.iter().map(|&(_, value)| value));
    let fit = SingularValues::of(&basis);
    let fit = fit.solve(&values, fit.values.len());
    let height = |x: f64| jet(fit.as_slice(), x)[0];
    let peak = stationary(fit.as_slice()).max_by(|&a, &b| height(a).total_cmp(&height(b)));
    let hint = "give the trace of a motored cylinder";
    let peak = peak.ok_or_else(|| Error::fault("motored", "has no peak".into(), hint))?;
    Ok(largest + AROUND_PEAK * peak)
}

/// Exponent of a polytropic compression and what must be added to the pressure of each cycle, a row, that it is
/// `C·V⁻ⁿ` at crank angles; without an exponent that of the mean cycle which leaves the least squares.
pub fn polytropic_offsets(
    chamber: &Chamber,
    theta_deg: &[f64],
    pressure: &ArrayView2<f64>,
    exponent: Option<f64>,
    cancel: &Cancel,
) -> Result<(f64, Vec<f64>)> {
    let volume: Vec<f64> = theta_deg.iter().map(|&theta| chamber.ratio(theta)).collect();
    let exponent = match exponent {
        Some(exponent) => exponent,
        None => match pressure.mean_axis(Axis(0)) {
            Some(mean) => fitted_exponent(mean.as_slice().unwrap_or_default(), &volume)?,
            None => 1.0,
        },
    };
    let offset = |row: ArrayView1<f64>| {
        cancel.check()?;
        Ok(-line(&row.to_vec(), &volume, exponent)[0])
    };
    Ok((exponent, pressure.rows().into_iter().map(offset).collect::<Result<_>>()?))
}

/// Apparent net heat that a gas has received from the first of crank angles to each, J, by cycle:
/// (`n_cycles`, `n_theta`).
///
/// The first law of one zone, dQ = γ/(γ−1)·p·dV + 1/(γ−1)·V·dp (Heywood, Internal Combustion Engine Fundamentals
/// (1988), section 9.2.2), as p·dV + d(p·V)/(γ−1): work by trapezes and a difference, so that no pressure is
/// differentiated.
pub fn heat_release(
    chamber: &Chamber,
    theta_deg: &[f64],
    pressure: &ArrayView2<f64>,
    gamma: f64,
    cancel: &Cancel,
) -> Result<Vec<f64>> {
    within("gamma", gamma, 1.01, 2.0)?;
    let volumes: Vec<f64> =
        theta_deg.iter().map(|&theta| chamber.clearance() * chamber.ratio(theta)).collect();
    let mut heats = memory::with_capacity(pressure.len())?;
    for row in pressure.rows() {
        cancel.check()?;
        let (mut work, mut before) = (0.0, None::<(f64, f64)>);
        let first = row.first().zip(volumes.first()).map_or(0.0, |(p, volume)| p * volume);
        heats.extend(row.iter().zip(&volumes).map(|(&now, &volume)| {
            if let Some((pressure, smaller)) = before {
                work += f64::midpoint(pressure, now) * (volume - smaller);
            }
            before = Some((now, volume));
            work + (now * volume - first) / (gamma - 1.0)
        }));
    }
    Ok(heats)
}

/// Constant of the best `constant + C·V⁻ⁿ`, and the sum of squares that it leaves.
fn line(pressure: &[f64], volume: &[f64], exponent: f64) -> [f64; 2] {
    let count = pressure.len() as f64;
    let powers: Vec<f64> = volume.iter().map(|volume| volume.powf(-exponent)).collect();
    let [mean, middle] = [pressure, &powers].map(|values| values.iter().sum::<f64>() / count);
    let pairs = || pressure.iter().map(|p| p - mean).zip(powers.iter().map(|power| power - middle));
    let slope = pairs().map(|(p, power)| p * power).sum::<f64>()
        / pairs().map(|(_, power)| power * power).sum::<f64>();
    [mean - slope * middle, pairs().map(|(p, power)| (p - slope * power).powi(2)).sum()]
}

/// The exponent that leaves the least sum of squares.
fn fitted_exponent(pressure: &[f64], volume: &[f64]) -> Result<f64> {
    let [low, high] = EXPONENTS;
    let left: Vec<f64> = points(low, high, DEGREE_BY_EXPONENT)
        .map(|exponent| line(pressure, volume, exponent)[1])
        .collect();
    let curve: Vec<f64> = (0..=DEGREE_BY_EXPONENT).map(|n| coefficient(&left, n)).collect();
    let height = |x: f64| jet(&curve, x)[0];
    let places = [-1.0, 1.0].into_iter().chain(stationary(&curve));
    let best = places.min_by(|&a, &b| height(a).total_cmp(&height(b))).unwrap_or_default();
    let exponent = f64::midpoint(low, high) + 0.5 * (high - low) * best;
    if (exponent - low).min(high - exponent) < AT_AN_END {
        let exponent = significant(exponent, 4);
        let fault = format!("is {exponent} at best, an end of {low} to {high}");
        let hint = "the window has no compression, or noise: give a number";
        return Err(Error::fault("exponent", fault, hint));
    }
    Ok(exponent)
}

/// Places in (−1, 1) at which a Chebyshev series is largest or least among its neighbours.
fn stationary(series: &[f64]) -> impl Iterator<Item = f64> {
    /// Steps in which slopes change sign once at most, for each degree.
    const STEPS_PER_DEGREE: usize = 16;
    let steps = STEPS_PER_DEGREE * series.len();
    // Closer together at the ends, where a polynomial turns most often.
    let place = move |k: usize| -(std::f64::consts::PI * k as f64 / steps as f64).cos();
    let slope = move |x: f64| jet(series, x)[1];
    (0..steps).filter_map(move |k| {
        let [mut low, mut high] = [place(k), place(k + 1)];
        let rises = slope(low) < 0.0;
        if slope(low) == 0.0 || (slope(high) > 0.0) != rises {
            return None;
        }
        loop {
            let middle = f64::midpoint(low, high);
            if middle <= low || middle >= high {
                return Some(middle);
            }
            let is_before = (slope(middle) < 0.0) == rises;
            *(if is_before { &mut low } else { &mut high }) = middle;
        }
    })
}

/// Pressure of cycles, a row each, one after the other, without what is above an order of crank speed: the filter
/// of Butterworth, forwards and backwards, so that it halves the amplitude at the order and shifts no phase.
///
/// The transform of all is one over rows and one over columns, with a twist between.
pub fn low_passed(
    theta_deg: &[f64],
    pressure: &ArrayView2<f64>,
    period_deg: f64,
    order: f64,
    cancel: &Cancel,
) -> Result<Vec<f64>> {
    let steps = || theta_deg.windows(2).map(|pair| pair[1] - pair[0]);
    let [least, most] =
        [steps().fold(f64::INFINITY, f64::min), steps().fold(f64::NEG_INFINITY, f64::max)];
    let is_closed = theta_deg.len() > 1
        && theta_deg[theta_deg.len() - 1] - theta_deg[0] > period_deg * (1.0 - CLOSED_PERIOD);
    let (count, width) = pressure.dim();
    let length = width - usize::from(is_closed);
    if most - least > EVEN_STEPS * most {
        let fault = "have steps that differ".into();
        return Err(Error::fault("traces", fault, "filters need equal steps"));
    }
    let highest = length as f64 * 180.0 / period_deg;
    if !(SMALLEST <= order && order < highest) {
        let highest = significant(highest, 6);
        let hint = format!("give an order above 0 and below {highest}, half the points of a turn");
        return Err(Error::figure("lowpass_order", order, hint));
    }
    let (over_columns, over_rows) = (Transform::of(count)?, Transform::of(length)?);
    let numbers = count * length;
    // A list for each column, then the part of the spectrum with one remainder: of real numbers half of these are
    // the conjugates of the others.
    let mut spectra = memory::collected((0..numbers).map(|_| Complex64::ZERO))?;
    let columns = spectra.chunks_exact_mut(count).enumerate().collect();
    pool::each(cancel, columns, numbers, |(j, column): (usize, &mut [Complex64])| {
        cancel.check()?;
        for (entry, &value) in column.iter_mut().zip(pressure.column(j)) {
            *entry = value.into();
        }
        over_columns.forward(column)
    })?;
    let halves = (0..=count / 2).collect();
    let rows = pool::map_if(pool::is_worth_parallel(numbers), cancel, halves, |k| {
        cancel.check()?;
        let twist = |j: usize| Complex64::cis(-TAU * ((j * k) as f64 / numbers as f64));
        let turned = |j: usize| spectra[j * count + k] * twist(j);
        let mut values = memory::collected((0..length).map(turned))?;
        over_rows.forward(&mut values)?;
        for (j, value) in values.iter_mut().enumerate() {
            let whole = if 2 * j < length { j as f64 } else { j as f64 - length as f64 };
            let turns = (whole + k as f64 / count as f64).abs();
            *value /= 1.0 + (turns * 360.0 / period_deg / order).powi(2 * STEEPNESS);
        }
        over_rows.inverse(&mut values)?;
        for (j, value) in values.iter_mut().enumerate() {
            *value *= twist(j).conj();
        }
        Ok(values)
    })?;
    let columns = spectra.chunks_exact_mut(count).enumerate().collect();
    pool::each(cancel, columns, numbers, |(j, column): (usize, &mut [Complex64])| {
        cancel.check()?;
        let entry = |k: usize| if 2 * k <= count { rows[k][j] } else { rows[count - k][j].conj() };
        for (k, value) in column.iter_mut().enumerate() {
            *value = entry(k);
        }
        over_columns.inverse(column)
    })?;
    let mut smooth = memory::with_capacity(count * width)?;
    for row in 0..count {
        cancel.check()?;
        smooth.extend((0..width).map(|j| spectra[j % length * count + row].re));
    }
    Ok(smooth)
}
