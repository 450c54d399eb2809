//! The fewest orders that serve every point of a sweep within a tolerance.
//!
//! Sizes of all orders that may matter are worked out at every engine, bank angle, rod ratio and
//! offset, once for all speeds, and each order counts with its worst. Where no cylinder has an offset
//! the largest rod ratio is the worst of force and moment: `√(1 − λ² sin²θ)` is a power series in λ²
//! whose terms give each order one sign, so that every |aₙ| grows with λ, and all cylinders share it.

use std::sync::Arc;

use super::harmonics::proportions;
use super::{Axes, Figure, Quantity, Sweep};
use crate::balance::{highest, most_left_out, rod_share, rod_tail, scales, tail, tolerance};
use crate::cancel::Cancel;
use crate::engine::{Engine, Hold};
use crate::error::Result;
use crate::slider_crank::Proportions;
use crate::spectrum::Spectrum;

/// Orders above the last one looked at add less than this part of the tolerance.
const NEGLIGIBLE: f64 = 0.01;
/// Sizes held at a time.
const MOST_SIZES: usize = 1 << 22;

impl Sweep {
    /// With the fewest orders that leave out at most `rtol` at any point, as [`crate::Orders::Auto`]
    /// does for one engine; torque counts if it is wanted.
    pub fn within(
        rtol: f64,
        engines: Vec<Arc<Engine>>,
        axes: Axes,
        reference_z: Option<f64>,
        spectrum: Option<Spectrum>,
        torque: bool,
        cancel: &Cancel,
    ) -> Result<Self> {
        let rtol = tolerance(rtol)?;
        let mut sweep = Self::new(engines, axes, vec![1], reference_z, spectrum, cancel)?;
        sweep.torque = torque;
        let candidates = sweep.candidates(rtol)?;
        let quantities: &[Quantity] = if torque && sweep.spectrum.is_none() {
            &[Quantity::Force, Quantity::Moment, Quantity::Torque]
        } else {
            &[Quantity::Force, Quantity::Moment]
        };
        let last = candidates.last().copied().unwrap_or(1);
        // By order, then by engine and quantity.
        let mut sizes = vec![Vec::new(); candidates.len()];
        let (mut rests, mut allowed) = (Vec::new(), Vec::new());
        for (index, engine) in sweep.engines.iter().enumerate() {
            let scales = scales(engine, sweep.references[index]).map(|scale| rtol * scale);
            let rest = sweep.rest(index, last)?;
            for &quantity in quantities {
                let worst = sweep.worst(index, quantity, &candidates, cancel)?;
                sizes.iter_mut().zip(worst).for_each(|(sizes, size)| sizes.push(size));
                rests.push(rest[quantity as usize]);
                allowed.push(scales[quantity as usize]);
            }
        }
        let share = |sizes: &Vec<f64>| -> Vec<f64> {
            let shares = sizes.iter().zip(&allowed);
            shares.map(|(&size, &most)| if size == 0.0 { 0.0 } else { size / most }).collect()
        };
        let shares: Vec<Vec<f64>> = sizes.iter().map(share).collect();
        let left_out = most_left_out(&shares, &share(&rests));
        let fastest = sweep.squares.iter().copied().fold(0.0, f64::max);
        for (sum, rest) in rests.into_iter().enumerate() {
            let bound = rest + left_out.iter().rev().map(|&k| sizes[k][sum]).sum::<f64>();
            let worst = &mut sweep.error_bound[quantities[sum % quantities.len()] as usize];
            *worst = worst.max(bound * fastest);
        }
        (sweep.orders, sweep.omitted) = (Vec::new(), Vec::new());
        for (k, &order) in candidates.iter().enumerate() {
            if left_out.binary_search(&k).is_err() {
                sweep.orders.push(order);
            } else if sizes[k].iter().any(|&size| size > 0.0) {
                sweep.omitted.push(order);
            }
        }
        Ok(sweep)
    }

    /// Orders that may matter anywhere in the sweep.
    fn candidates(&self, rtol: f64) -> Result<Vec<u32>> {
        let placements = || self.engines.iter().flat_map(|engine| engine.placements());
        if let Some(spectrum) = &self.spectrum {
            return Ok(spectrum.orders_with(placements().any(|p| p.rotating_mass > 0.0)));
        }
        let most = self.engines.iter().map(|engine| engine.placements().len()).max().unwrap_or(1);
        let worst = self.engines.iter().enumerate().flat_map(|(k, engine)| {
            let allowed = scales(engine, self.references[k]);
            let share = move |p: &crate::Placement| rod_share(&p.cylinder, &allowed);
            engine.placements().iter().map(move |p| Ok((self.slowest(p)?, share(p))))
        });
        let worst: Vec<(Proportions, f64)> = worst.collect::<Result<_>>()?;
        let last = highest(rtol, NEGLIGIBLE * rtol, most, worst.into_iter(), self.torque)?;
        Ok((1..=last).collect())
    }

    /// Proportions of a cylinder whose harmonics fall off most slowly: the tail bounds grow with rod
    /// ratio and with the magnitude of the offset.
    fn slowest(&self, placement: &crate::Placement) -> Result<Proportions> {
        let [ratio, offset] = self.extremes;
        proportions(&placement.cylinder, ratio, offset)
    }

    /// What orders above the last add to an engine's force, moment and torque over ω², anywhere.
    fn rest(&self, engine: usize, last: u32) -> Result<[f64; 3]> {
        let mut rest = [0.0; 3];
        if self.spectrum.is_some() {
            return Ok(rest);
        }
        for placement in self.engines[engine].placements() {
            let [force, torque] = tail(&self.slowest(placement)?, last, self.torque);
            let first_order = placement.cylinder.first_order();
            rest[0] += first_order * force;
            rest[1] += first_order * force * (placement.z - self.references[engine]).abs();
            rest[2] += first_order * placement.cylinder.crank_radius() * torque;
            let inertia = placement.cylinder.rod_inertia_excess().abs();
            if inertia > 0.0 {
                rest[2] += inertia * rod_tail(&self.slowest(placement)?, last);
            }
        }
        Ok(rest)
    }

    /// The largest size over ω² of each order of an engine.
    fn worst(
        &self,
        engine: usize,
        quantity: Quantity,
        candidates: &[u32],
        cancel: &Cancel,
    ) -> Result<Vec<f64>> {
        let mut worst = vec![0.0_f64; candidates.len()];
        let angles = self.axes.bank_angle.as_ref();
        let centred = match &self.axes.pin_offset {
            Some(offsets) => offsets.iter().all(|&offset| offset == 0.0),
            None => {
                self.engines[engine].placements().iter().all(|p| p.cylinder.pin_offset() == 0.0)
            }
        };
        let ratios = match self.extremes[0] {
            Some(largest) if centred && !quantity.is_torque() => Some(vec![largest]),
            _ => self.axes.rod_ratio.clone(),
        };
        // As many points at a time as fit.
        let points = (MOST_SIZES / candidates.len().max(1)).max(1);
        let angle_parts = parts(angles.map(|(angles, _)| &angles[..]), points);
        let points = (points / longest(&angle_parts)).max(1);
        let ratio_parts = parts(ratios.as_deref(), points);
        let points = (points / longest(&ratio_parts)).max(1);
        let offset_parts = parts(self.axes.pin_offset.as_deref(), points);
        let hold = angles.map_or(Hold::Pins, |&(_, hold)| hold);
        for angles in &angle_parts {
            for ratios in &ratio_parts {
                for offsets in &offset_parts {
                    let part = Self {
                        engines: vec![Arc::clone(&self.engines[engine])],
                        axes: Axes {
                            bank_angle: angles.map(|angles| (angles.to_vec(), hold)),
                            rod_ratio: ratios.map(<[f64]>::to_vec),
                            pin_offset: offsets.map(<[f64]>::to_vec),
                            rpm: Vec::new(),
                        },
                        orders: candidates.to_vec(),
                        references: vec![self.references[engine]],
                        spectrum: self.spectrum.clone(),
                        extremes: self.extremes,
                        squares: vec![1.0],
                        torque: self.torque,
                        omitted: Vec::new(),
                        error_bound: [0.0; 3],
                    };
                    let figure = match quantity {
                        _ if quantity.is_torque() => Figure::Amplitude,
                        _ => Figure::Length,
                    };
                    let sizes = part.peaks(quantity, figure, cancel)?;
                    for (k, size) in sizes.iter().enumerate() {
                        let worst = &mut worst[k % candidates.len()];
                        *worst = worst.max(*size);
                    }
                }
            }
        }
        Ok(worst)
    }
}

/// The values of an axis, so many at a time; one part without values where it is not swept.
fn parts(values: Option<&[f64]>, length: usize) -> Vec<Option<&[f64]>> {
    values.map_or(vec![None], |values| values.chunks(length).map(Some).collect())
}

fn longest(parts: &[Option<&[f64]>]) -> usize {
    parts.first().copied().flatten().map_or(1, <[f64]>::len)
}
