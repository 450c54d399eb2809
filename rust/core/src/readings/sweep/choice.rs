//! A few orders that serve every point of a sweep within a tolerance.
//!
//! Sizes of all orders that may matter are evaluated at every engine, bank angle, rod ratio and
//! offset, once for all speeds, and each order counts with its worst. Where no cylinder has an offset
//! the largest rod ratio is the worst of force and moment: `√(1 − λ² sin²θ)` is a power series in λ²
//! whose terms give each order one sign, so that every |aₙ| grows with λ, and all cylinders share it.

use std::sync::Arc;

use super::harmonics::proportions;
use super::{Axes, Figure, Quantity, Sweep};
use crate::engine::Engine;
use crate::gear::slider_crank::{Cylinder, Proportions};
use crate::gear::spectrum::Spectrum;
use crate::load::Loads;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::readings::choice::{few, highest, of_spectrum, rod_share, scales, tail};

/// Orders above the last one evaluated add less than this part of the tolerance.
const NEGLIGIBLE: f64 = 0.01;
/// Numbers evaluated at a time.
const MOST_SIZES: usize = 1 << 22;

impl Sweep {
    /// With few orders that leave out at most `rtol` at any point, as [`crate::Orders::Auto`] does
    /// for one engine; torque counts if it is wanted.
    pub fn within(
        rtol: f64,
        engines: Vec<Arc<Engine>>,
        axes: Axes,
        reference_z: Option<f64>,
        spectrum: Option<Spectrum>,
        torque: bool,
        cancel: &Cancel,
    ) -> Result<Self> {
        let rtol = limits::tolerance(rtol)?;
        let mut sweep =
            Self::new(engines, axes, vec![Order::FIRST], reference_z, spectrum, cancel)?;
        sweep.torque &= torque;
        let loads: Vec<Loads> = (0..sweep.engines.len()).map(|k| sweep.loads(k)).collect();
        let candidates = sweep.candidates(rtol, &loads)?;
        let last = candidates.last().copied().unwrap_or(1);
        let mut quantities = vec![Quantity::Force, Quantity::Moment];
        if sweep.torque {
            quantities.extend([Quantity::Torque, Quantity::CrankTorque]);
        }
        // A sum for each engine and quantity, in the order of the engines.
        let mut sizes = vec![Vec::new(); candidates.len()];
        let (mut lost, mut allowed) = (Vec::new(), Vec::new());
        for (index, loads) in loads.iter().enumerate() {
            let scales = scales(&sweep.engines[index], loads).map(|scale| rtol * scale);
            let rest = sweep.rest(loads, last)?;
            for &quantity in &quantities {
                let sum = quantity.bound();
                let worst = sweep.worst(index, quantity, &candidates, &sweep.axes, cancel)?;
                sizes.iter_mut().zip(worst).for_each(|(sizes, size)| sizes.push(size));
                lost.push(rest[sum]);
                allowed.push(scales[sum]);
            }
        }
        let kept = few(&sizes, &allowed, &mut lost);
        let fastest = sweep.squares.iter().copied().fold(0.0, f64::max);
        for (lost, quantity) in lost.into_iter().zip(quantities.iter().cycle()) {
            let worst = &mut sweep.error_bound[quantity.bound()];
            *worst = worst.max(lost * fastest);
        }
        let orders = Order::all_whole(&candidates)?;
        sweep.orders = Vec::new();
        for ((order, kept), sizes) in orders.into_iter().zip(kept).zip(sizes) {
            if kept {
                sweep.orders.push(order);
            } else if sizes.iter().any(|&size| size > 0.0) {
                sweep.omitted.push(order);
            }
        }
        Ok(sweep)
    }

    /// Orders that may matter anywhere in the sweep.
    fn candidates(&self, rtol: f64, loads: &[Loads]) -> Result<Vec<u32>> {
        let unbalances: Vec<u32> = loads.iter().flat_map(Loads::unbalance_orders).collect();
        if let Some(spectrum) = &self.spectrum {
            return Ok(of_spectrum(spectrum, &unbalances));
        }
        let most = loads.iter().map(|loads| loads.list.len()).max().unwrap_or(1);
        let mut motions = Vec::new();
        for (engine, loads) in self.engines.iter().zip(loads) {
            let scales = scales(engine, loads);
            for (k, motion) in loads.motions.iter().enumerate() {
                motions.push((self.slowest(motion)?, rod_share(loads, k, &scales)));
            }
        }
        let negligible = NEGLIGIBLE * rtol;
        let last = highest(rtol, negligible, most, motions.into_iter(), self.torque)?;
        Ok((1..=unbalances.into_iter().max().unwrap_or(1).max(last)).collect())
    }

    /// Proportions of a cylinder whose harmonics fall off most slowly: the tail bounds grow with rod
    /// ratio and with the magnitude of the offset.
    fn slowest(&self, cylinder: &Cylinder) -> Result<Proportions> {
        let [ratio, offset] = self.extremes;
        proportions(cylinder, ratio, offset)
    }

    /// Bounds over ω² of what orders above the last add to an engine's force, moment and torque.
    fn rest(&self, loads: &Loads, last: u32) -> Result<[f64; 3]> {
        if self.spectrum.is_some() {
            return Ok([0.0; 3]);
        }
        let slowest = loads.motions.iter().map(|motion| self.slowest(motion));
        let slowest: Vec<Proportions> = slowest.collect::<Result<_>>()?;
        Ok(tail(loads, last, self.torque, &slowest))
    }

    /// The largest size over ω² of each order of an engine on these axes.
    fn worst(
        &self,
        engine: usize,
        quantity: Quantity,
        candidates: &[u32],
        axes: &Axes,
        cancel: &Cancel,
    ) -> Result<Vec<f64>> {
        let planar = matches!(quantity, Quantity::Force | Quantity::Moment);
        let centred = match &axes.pin_offset {
            Some(offsets) => offsets.iter().all(|&offset| offset == 0.0),
            None => self.engines[engine].gears().iter().all(|gear| gear.pin_offset() == 0.0),
        };
        let ratios = axes.rod_ratio.as_ref().filter(|ratios| ratios.len() > 1);
        if let (Some(ratios), true, true) = (ratios, planar, centred) {
            let largest = ratios.iter().copied().fold(0.0, f64::max);
            let angles = axes.bank_angle.as_ref();
            let angles = angles.map(|(angles, hold)| Ok((memory::copied(angles, cancel)?, *hold)));
            let bank_angle = angles.transpose()?;
            // Offsets that are all zero are as one.
            let pin_offset = axes.pin_offset.as_ref().map(|_| vec![0.0]);
            let largest = Some(vec![largest]);
            let axes = Axes { bank_angle, rod_ratio: largest, pin_offset, rpm: Vec::new() };
            return self.worst(engine, quantity, candidates, &axes, cancel);
        }
        let mut worst = vec![0.0_f64; candidates.len()];
        if let Some(parts) = axes.parts(MOST_SIZES / candidates.len(), cancel) {
            for part in parts {
                let here = self.worst(engine, quantity, candidates, &part?, cancel)?;
                worst.iter_mut().zip(here).for_each(|(worst, here)| *worst = worst.max(here));
            }
            return Ok(worst);
        }
        let axes = Axes {
            bank_angle: axes.bank_angle.clone(),
            rod_ratio: axes.rod_ratio.clone(),
            pin_offset: axes.pin_offset.clone(),
            rpm: Vec::new(),
        };
        let part = Self {
            engines: vec![Arc::clone(&self.engines[engine])],
            axes,
            orders: Order::all_whole(candidates)?,
            references: vec![self.references[engine]],
            spectrum: self.spectrum.clone(),
            extremes: self.extremes,
            squares: vec![1.0],
            torque: self.torque,
            omitted: Vec::new(),
            error_bound: [0.0; 3],
        };
        let figure = if planar { Figure::Length } else { Figure::Amplitude };
        for (k, size) in part.peaks(quantity, figure, cancel)?.iter().enumerate() {
            let worst = &mut worst[k % candidates.len()];
            *worst = worst.max(*size);
        }
        Ok(worst)
    }
}

impl Quantity {
    /// Which of the bounds of force, moment and torque it counts for.
    fn bound(self) -> usize {
        match self {
            Self::Force => 0,
            Self::Moment => 1,
            Self::Torque | Self::CrankTorque => 2,
        }
    }
}
