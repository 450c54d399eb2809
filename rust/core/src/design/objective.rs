//! The value of an objective and its derivatives, from phasors that turn as variables change.

use std::f64::consts::TAU;

use super::{Derived, Objective, ObjectiveFigure, ObjectiveQuantity};
use crate::Complex64;
use crate::numbers::ratio::SpeedRatio;
use crate::readings::peaks::{LocalParabola, polished};

/// Crank angles to the shortest wave at which peaks are looked for.
const SAMPLES: usize = 12;
/// Part of the highest sample below which there is no peak to consider: samples are short of a peak by
/// 1 − cos(π/12) at most.
const LOWEST_SAMPLE_AT_PEAK: f64 = 0.9;
/// Part of the largest possible sum below which rounding makes the peaks.
const LEAST_PEAK: f64 = 1e-9;

/// A phasor that turns as the variables change: `phasor · e^{i·rates·x}`.
#[derive(Debug, Clone, Default)]
pub(super) struct Rotor {
    pub phasor: Complex64,
    pub rates: Vec<f64>,
}

/// Part of a quantity that turns at a multiple of crank speed.
#[derive(Debug, Clone)]
pub(super) struct TurningPhasor {
    /// Multiple of crank speed, negative against the crank; or of half of it.
    speed: i64,
    rotors: Vec<Rotor>,
}

impl TurningPhasor {
    pub fn new(speed: SpeedRatio) -> Self {
        Self { speed: speed.halves().into(), rotors: Vec::new() }
    }

    pub fn extend(&mut self, sum: &[Rotor], factor: Complex64) {
        let scaled = sum.iter().map(|each| Rotor { phasor: each.phasor * factor, ..each.clone() });
        self.rotors.extend(scaled);
    }

    /// From phasors of the conjugate.
    pub fn conjugate(mut self) -> Self {
        for each in &mut self.rotors {
            each.phasor = each.phasor.conj();
            each.rates.iter_mut().for_each(|rate| *rate = -*rate);
        }
        self
    }

    /// Phasor, and its derivatives.
    fn at(&self, x: &[f64]) -> WithSlopes {
        let mut found = WithSlopes::zero(x.len());
        for each in &self.rotors {
            let turned = each.phasor * Complex64::cis(dot(&each.rates, x));
            found.value += turned;
            for (slope, rate) in found.slopes.iter_mut().zip(&each.rates) {
                *slope += Complex64::i() * turned * rate;
            }
        }
        found
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A vector in the plane, and its derivatives by the variables.
#[derive(Debug, Clone)]
struct WithSlopes {
    value: Complex64,
    slopes: Vec<Complex64>,
}

impl WithSlopes {
    fn zero(variables: usize) -> Self {
        Self { value: Complex64::default(), slopes: vec![Complex64::default(); variables] }
    }

    fn add(&mut self, other: &Self, of: impl Fn(Complex64) -> Complex64) {
        self.value += of(other.value);
        for (slope, more) in self.slopes.iter_mut().zip(&other.slopes) {
            *slope += of(*more);
        }
    }
}

/// An objective with its parts.
#[derive(Debug, Clone)]
pub(super) struct ObjectiveFunction {
    objective: Objective,
    parts: Vec<TurningPhasor>,
    /// Largest value that it could have: that of all phasors in phase.
    pub scale: f64,
    /// `e^{iθ}`, or of half the crank angle, at those of the samples.
    units: Vec<Complex64>,
}

impl ObjectiveFunction {
    pub fn new(objective: Objective, mut parts: Vec<TurningPhasor>) -> Self {
        if parts.iter().all(|part| part.speed % 2 == 0) {
            // All is over in a turn.
            for part in &mut parts {
                part.speed /= 2;
            }
        }
        let sizes = parts.iter().flat_map(|part| &part.rotors).map(|each| each.phasor.norm());
        let scale: f64 = sizes.sum();
        let highest = parts.iter().map(|part| part.speed.unsigned_abs() as usize).max();
        let points = SAMPLES * highest.unwrap_or(1).max(1);
        let units = (0..points).map(|k| Complex64::cis(k as f64 * TAU / points as f64));
        Self {
            scale: if scale > 0.0 { scale } else { 1.0 },
            units: units.collect(),
            objective,
            parts,
        }
    }

    /// Upper bound on the change of the objective per radian of a variable.
    pub fn steepest(&self) -> f64 {
        let rotors = self.parts.iter().flat_map(|part| &part.rotors);
        rotors
            .map(|each| {
                each.phasor.norm()
                    * each.rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()))
            })
            .sum()
    }

    /// The sums of lengths of vectors of which the largest is the objective.
    fn sums(&self, x: &[f64]) -> Vec<Vec<WithSlopes>> {
        let phasors: Vec<WithSlopes> = self.parts.iter().map(|part| part.at(x)).collect();
        if self.objective.order.is_none() {
            let planar = matches!(
                self.objective.quantity,
                ObjectiveQuantity::Force | ObjectiveQuantity::Moment
            );
            let axes: &[Option<Complex64>] = match (planar, self.objective.reading) {
                (true, ObjectiveFigure::PeakXy) => {
                    &[Some(Complex64::new(1.0, 0.0)), Some(Complex64::new(0.0, -1.0))]
                }
                (true, _) => &[None],
                (false, _) => &[Some(Complex64::new(1.0, 0.0))],
            };
            return axes.iter().flat_map(|axis| self.peaks(&phasors, *axis, x.len())).collect();
        }
        match (self.objective.reading, &phasors[..]) {
            (ObjectiveFigure::PeakXy, [forward, backward]) => [1.0, -1.0]
                .map(|sign| {
                    let mut sum = forward.clone();
                    sum.add(backward, |part| sign * part.conj());
                    vec![sum]
                })
                .into(),
            _ => vec![phasors],
        }
    }

    /// The vectors of all orders together at the crank angles of the highest peaks of their length, or
    /// of their projection on an axis.
    fn peaks(
        &self,
        phasors: &[WithSlopes],
        axis: Option<Complex64>,
        variables: usize,
    ) -> Vec<Vec<WithSlopes>> {
        let square = |vector: Complex64| match axis {
            Some(axis) => (axis * vector).re.powi(2),
            None => vector.norm_sqr(),
        };
        let count = self.units.len();
        let squares: Vec<f64> = (0..count)
            .map(|j| {
                let turned = self.parts.iter().zip(phasors).map(|(part, phasor)| {
                    let k = (j as i64 * part.speed).rem_euclid(count as i64) as usize;
                    phasor.value * self.units[k]
                });
                square(turned.sum())
            })
            .collect();
        let size: f64 = phasors.iter().map(|each| each.value.norm()).sum();
        let highest = squares.iter().copied().fold(0.0, f64::max);
        let least = (LOWEST_SAMPLE_AT_PEAK * LOWEST_SAMPLE_AT_PEAK * highest)
            .max((LEAST_PEAK * size).powi(2));
        let mut at: Vec<usize> = (0..count)
            .filter(|&k| {
                let (before, after) = (squares[(k + count - 1) % count], squares[(k + 1) % count]);
                squares[k] >= before && squares[k] > after && squares[k] > least
            })
            .collect();
        if at.is_empty() {
            at.push(0);
        }
        let step = TAU / count as f64;
        at.into_iter()
            .map(|k| {
                // A step off at most.
                let (start, at) = (k as f64 * step, |θ| self.squared(phasors, axis, θ));
                let [theta, _] = polished([start - step, start + step], start, &at);
                let mut sum = WithSlopes::zero(variables);
                for (part, phasor) in self.parts.iter().zip(phasors) {
                    let unit = Complex64::cis(part.speed as f64 * theta);
                    sum.add(phasor, |part| {
                        axis.map_or(part * unit, |axis| (axis * part * unit).re.into())
                    });
                }
                vec![sum]
            })
            .collect()
    }

    /// Half the square of a sum at a crank angle, or of its projection on an axis, and its derivatives.
    fn squared(
        &self,
        phasors: &[WithSlopes],
        axis: Option<Complex64>,
        theta: f64,
    ) -> LocalParabola {
        let mut jet = [Complex64::default(); 3];
        for (part, phasor) in self.parts.iter().zip(phasors) {
            let speed = part.speed as f64;
            let turned = phasor.value * Complex64::cis(speed * theta);
            jet[0] += turned;
            jet[1] += Complex64::i() * speed * turned;
            jet[2] -= speed * speed * turned;
        }
        if let Some(axis) = axis {
            jet = jet.map(|each| (axis * each).re.into());
        }
        let product = |a: Complex64, b: Complex64| a.re * b.re + a.im * b.im;
        let [value, slope, bend] = jet;
        let bend = product(slope, slope) + product(value, bend);
        [0.5 * value.norm_sqr(), product(value, slope), bend]
    }

    /// The objective over its scale, and its derivatives.
    pub fn value(&self, x: &[f64]) -> Derived {
        let lengths = |sum: &[WithSlopes]| sum.iter().map(|each| each.value.norm()).sum::<f64>();
        let sums = self.sums(x);
        let largest = sums.iter().max_by(|a, b| lengths(a).total_cmp(&lengths(b)));
        let largest = largest.map_or(&[][..], Vec::as_slice);
        let mut slopes = vec![0.0; x.len()];
        for vector in largest.iter().filter(|each| each.value != Complex64::default()) {
            add_slopes(&mut slopes, vector, vector.value.norm() * self.scale, 1.0);
        }
        (lengths(largest) / self.scale, slopes)
    }

    /// The smoothed objective over its scale, and its derivatives.
    pub fn smoothed(&self, x: &[f64], mu: f64) -> Derived {
        let sums = self.sums(x);
        let length = |vector: &WithSlopes| (vector.value.norm() / self.scale).hypot(mu);
        let totals: Vec<f64> = sums.iter().map(|sum| sum.iter().map(length).sum()).collect();
        let largest = totals.iter().copied().fold(0.0, f64::max);
        let shares: Vec<f64> = totals.iter().map(|total| ((total - largest) / mu).exp()).collect();
        let together: f64 = shares.iter().sum();
        let mut slopes = vec![0.0; x.len()];
        for (sum, share) in sums.iter().zip(&shares) {
            for vector in sum {
                let divisor = length(vector) * self.scale * self.scale;
                add_slopes(&mut slopes, vector, divisor, share / together);
            }
        }
        (largest + mu * together.ln(), slopes)
    }
}

/// Adds the derivatives of half the square of a length over a divisor.
fn add_slopes(to: &mut [f64], vector: &WithSlopes, divisor: f64, factor: f64) {
    for (sum, slope) in to.iter_mut().zip(&vector.slopes) {
        *sum += factor * (vector.value.conj() * slope).re / divisor;
    }
}
