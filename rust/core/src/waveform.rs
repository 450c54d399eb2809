//! Force, moment and torque at given crank angles: from exact kinematics, or as a sum of orders.

use std::ops::Range;

use ndarray::{Array1, Array2};
use rayon::prelude::*;

use crate::Complex64;
use crate::balance::{self, Asked, Balance, Orders, angular_speed};
use crate::cancel::Cancel;
use crate::crank_angles::{CrankAngles, parts};
use crate::engine::Engine;
use crate::error::{Error, Result};
use crate::kinematics::{Alike, BLOCK, Column, Kinematics, Units};
use crate::limits;
use crate::simd::vectorised;

/// An engine's shaking over crank angle.
#[derive(Debug, Clone, PartialEq)]
pub struct Waveform {
    /// Shaking force along x and y, N: (`n_theta`, 2).
    pub force: Array2<f64>,
    /// Rocking moment about x and y, N·m: (`n_theta`, 2).
    pub moment: Array2<f64>,
    /// Roll torque on the block about +z, N·m: (`n_theta`,).
    pub torque: Option<Array1<f64>>,
    /// Inertia torque on the crank about +z, N·m: (`n_theta`,).
    pub crank_torque: Option<Array1<f64>>,
    /// The orders summed; none where the kinematics were.
    pub balance: Option<Balance>,
}

/// From exact kinematics at crank angles in degrees.
pub fn exact(
    engine: &Engine,
    asked: &Asked,
    theta_deg: &[f64],
    cancel: &Cancel,
) -> Result<Waveform> {
    if asked.spectrum.is_some() {
        let cure = "exact kinematics needs the slider-crank; give orders, or \"auto\"";
        return Err(Error::value("spectrum", "given", cure));
    }
    let omega = angular_speed(asked.rpm)?;
    let reference = engine.reference(asked.reference_z)?;
    let kinematics = Kinematics::new(engine.placements(), reference);
    let rows = in_blocks(theta_deg, cancel, |angles, range, rows| {
        vectorised(
            #[inline(always)]
            || {
                let mut units = Units::START;
                angles.multiples(1, range, &mut units.cos[..], &mut units.sin[..]);
                for alike in &kinematics.groups {
                    if asked.torque {
                        rows.add::<true>(alike, omega * omega, &units);
                    } else {
                        rows.add::<false>(alike, omega * omega, &units);
                    }
                }
                let [force_x, force_y, moment_x, moment_y, ..] = &mut rows.columns;
                let [force, moment] = kinematics.rotating.map(|sum| sum * (omega * omega));
                units.add_turning(force, [force_x, force_y]);
                units.add_turning(moment, [moment_x, moment_y]);
            },
        );
    })?;
    Ok(rows.waveform(None, asked.torque))
}

/// As a sum of orders; a spectrum may stand in for the kinematics.
///
/// Orders are given, or the fewest that reach a tolerance: unless the kinematics cost less than
/// their sum, or more orders were needed than there are. The kinematics are taken then.
pub fn from_orders(
    engine: &Engine,
    asked: &Asked,
    theta_deg: &[f64],
    orders: &Orders,
    cancel: &Cancel,
) -> Result<Waveform> {
    let kinematics = matches!(orders, Orders::Auto { .. }) && asked.spectrum.is_none();
    let balance = match balance::of(engine, asked, orders) {
        Err(Error::TooManyOrders { .. }) if kinematics => None,
        found => Some(found?),
    };
    let balance = balance.filter(|balance| {
        !kinematics || !kinematics_cost_less(engine, balance.orders.len(), asked.torque)
    });
    let Some(balance) = balance else {
        return exact(engine, asked, theta_deg, cancel);
    };
    let rows = in_blocks(theta_deg, cancel, |angles, range, rows| {
        vectorised(
            #[inline(always)]
            || rows.add_orders(&balance, angles, range),
        );
    })?;
    let torque = balance.torque.is_some();
    Ok(rows.waveform(Some(balance), torque))
}

/// What the kinematics of cylinders that move alike and an order of a sum take, in nanoseconds for an
/// angle: slopes from 1 to 48 cylinders and from 1 to 16 orders, 1024 angles on one core (AMD EPYC,
/// AVX-512).
const COST: [f64; 2] = [1.5, 2.0];
/// ... with roll and crank torque.
const COST_WITH_TORQUE: [f64; 2] = [1.8, 2.3];

/// Whether an engine's kinematics take less time than a sum of so many orders.
fn kinematics_cost_less(engine: &Engine, orders: usize, torque: bool) -> bool {
    let [alike, order] = if torque { COST_WITH_TORQUE } else { COST };
    let groups = Kinematics::new(engine.placements(), 0.0).groups.len();
    alike * groups as f64 <= order * orders as f64
}

/// Force x, y, moment x, y, roll and crank torque.
struct Rows {
    columns: [Column; 6],
}

impl Rows {
    #[inline(always)]
    fn add<const TORQUE: bool>(&mut self, alike: &Alike, square: f64, units: &Units) {
        let [force_x, force_y, moment_x, moment_y, roll, crank] = &mut self.columns;
        let [force, moment] = alike.along.map(|along| along * square);
        let (proportions, torque) = (alike.cylinder.proportions(), alike.torque * square);
        for i in 0..BLOCK {
            let motion = proportions.motion_at(&units.crank(alike.phase, i));
            force_x[i] += force.re * motion.acceleration;
            force_y[i] += force.im * motion.acceleration;
            moment_x[i] += moment.re * motion.acceleration;
            moment_y[i] += moment.im * motion.acceleration;
            if TORQUE {
                let torque = torque * motion.acceleration;
                roll[i] += torque * (motion.velocity + proportions.offset);
                crank[i] -= torque * motion.velocity;
            }
        }
    }

    #[inline(always)]
    fn add_orders(&mut self, balance: &Balance, angles: &CrankAngles, range: Range<usize>) {
        let (mut cos, mut sin) = (Column::ZERO, Column::ZERO);
        for (k, &order) in balance.orders.iter().enumerate() {
            angles.multiples(order, range.clone(), &mut cos[..], &mut sin[..]);
            let zero = Complex64::default();
            let torque = balance.torque.as_ref();
            let phasors = [
                balance.force.xy[[k, 0]],
                balance.force.xy[[k, 1]],
                balance.moment.xy[[k, 0]],
                balance.moment.xy[[k, 1]],
                torque.map_or(zero, |t| t.roll[k]),
                torque.map_or(zero, |t| t.crank[k]),
            ];
            for (column, phasor) in self.columns.iter_mut().zip(phasors) {
                if phasor == zero {
                    continue;
                }
                for i in 0..BLOCK {
                    column[i] += phasor.re * cos[i] - phasor.im * sin[i];
                }
            }
        }
    }
}

/// The columns of all blocks, one after the other.
struct Joined {
    columns: [Vec<f64>; 6],
}

impl Joined {
    fn waveform(self, balance: Option<Balance>, torque: bool) -> Waveform {
        let [force_x, force_y, moment_x, moment_y, roll, crank] = self.columns;
        let pair = |x: Vec<f64>, y: Vec<f64>| {
            let mut pair = Array2::zeros((x.len(), 2));
            pair.column_mut(0).assign(&Array1::from(x));
            pair.column_mut(1).assign(&Array1::from(y));
            pair
        };
        Waveform {
            force: pair(force_x, force_y),
            moment: pair(moment_x, moment_y),
            torque: torque.then(|| Array1::from(roll)),
            crank_torque: torque.then(|| Array1::from(crank)),
            balance,
        }
    }
}

/// Run over the crank angles in blocks, in parallel, in order.
fn in_blocks(
    theta_deg: &[f64],
    cancel: &Cancel,
    add: impl Fn(&CrankAngles, Range<usize>, &mut Rows) + Sync,
) -> Result<Joined> {
    let cure = "split theta_deg into parts";
    limits::result_size("theta_deg", &[theta_deg.len(), 12], size_of::<f64>(), cure)?;
    let angles = CrankAngles::new(theta_deg)?;
    let block = |range: Range<usize>| -> Result<Rows> {
        cancel.check()?;
        let mut rows = Rows { columns: [const { Column::ZERO }; 6] };
        add(&angles, range, &mut rows);
        Ok(rows)
    };
    let ranges = parts(0..angles.len(), BLOCK);
    let blocks: Vec<Rows> = if ranges.len() <= 4 {
        ranges.map(block).collect::<Result<_>>()?
    } else {
        ranges.collect::<Vec<_>>().into_par_iter().map(block).collect::<Result<_>>()?
    };
    let join = |column: usize| {
        let mut joined = Vec::with_capacity(blocks.len() * BLOCK);
        for block in &blocks {
            joined.extend_from_slice(&block.columns[column][..]);
        }
        joined.truncate(angles.len());
        joined
    };
    Ok(Joined { columns: std::array::from_fn(join) })
}
