//! Force, moment and torque at given crank angles: from exact kinematics, or as a sum of orders.

use ndarray::{Array1, Array2};
use rayon::prelude::*;

use crate::Complex64;
use crate::balance::{self, Asked, Balance, Orders, angular_speed};
use crate::cancel::Cancel;
use crate::crank_angles::{CrankAngles, check};
use crate::engine::Engine;
use crate::error::{Error, Result};
use crate::kinematics::{Alike, BLOCK, Column, Kinematics, Units};
use crate::limits;
use crate::memory;
use crate::pool;
use crate::rod::Swing;
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
    let memory = in_blocks(theta_deg, asked.torque, cancel, |angles, rows| {
        vectorised(
            #[inline(always)]
            || {
                let mut units = Units::START;
                angles.multiples(1, 0..angles.len(), &mut units.cos[..], &mut units.sin[..]);
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
    memory.waveform(None, asked.torque)
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
    let balance = match balance::of(engine, asked, orders, cancel) {
        // Of a slider-crank alone.
        Err(Error::TooManyOrders { .. }) => None,
        found => Some(found?),
    };
    let balance = balance.filter(|balance| {
        !kinematics || !kinematics_cost_less(engine, balance.orders.len(), asked.torque)
    });
    let Some(balance) = balance else {
        return exact(engine, asked, theta_deg, cancel);
    };
    let torque = balance.torque.is_some();
    let memory = in_blocks(theta_deg, torque, cancel, |angles, rows| {
        vectorised(
            #[inline(always)]
            || rows.add_orders(&balance, angles),
        );
    })?;
    memory.waveform(Some(balance), torque)
}

/// What the kinematics of cylinders that move alike and an order of a sum take, in nanoseconds for an
/// angle: slopes from 1 to 48 cylinders and from 1 to 16 orders, 1024 angles on one core (AMD EPYC,
/// AVX-512).
const COST: [f64; 2] = [1.5, 1.9];
/// ... with roll and crank torque, and what a rod's inertia adds to the first.
const COST_WITH_TORQUE: [f64; 2] = [1.8, 2.2];
const COST_OF_ROD: f64 = 1.4;

/// Whether an engine's kinematics take less time than a sum of so many orders.
fn kinematics_cost_less(engine: &Engine, orders: usize, torque: bool) -> bool {
    let ([alike, order], rod) = if torque { (COST_WITH_TORQUE, COST_OF_ROD) } else { (COST, 0.0) };
    Kinematics::new(engine.placements(), 0.0).cost(alike, rod) <= order * orders as f64
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
        if TORQUE && alike.rod_inertia != 0.0 {
            let inertia = alike.rod_inertia * square;
            for i in 0..BLOCK {
                let swing = Swing::new(&proportions, &units.crank(alike.phase, i));
                roll[i] += inertia * swing.roll();
                crank[i] += inertia * swing.crank();
            }
        }
    }

    #[inline(always)]
    fn add_orders(&mut self, balance: &Balance, angles: &CrankAngles) {
        let (mut cos, mut sin) = (Column::ZERO, Column::ZERO);
        for (k, &order) in balance.orders.iter().enumerate() {
            angles.multiples(order, 0..angles.len(), &mut cos[..], &mut sin[..]);
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

/// Results in memory: force and moment in pairs of x and y, roll and crank torque if wanted.
struct Memory {
    pairs: [Vec<f64>; 2],
    torques: [Vec<f64>; 2],
}

impl Memory {
    fn waveform(self, balance: Option<Balance>, torque: bool) -> Result<Waveform> {
        let pairs = |values: Vec<f64>| {
            let shape = (values.len() / 2, 2);
            Array2::from_shape_vec(shape, values)
                .map_err(|error| Error::value("theta_deg", format!("{shape:?}"), error.to_string()))
        };
        let ([force, moment], [roll, crank]) = (self.pairs, self.torques);
        Ok(Waveform {
            force: pairs(force)?,
            moment: pairs(moment)?,
            torque: torque.then(|| Array1::from(roll)),
            crank_torque: torque.then(|| Array1::from(crank)),
            balance,
        })
    }
}

/// Run over the crank angles in blocks, in parallel.
fn in_blocks(
    theta_deg: &[f64],
    torque: bool,
    cancel: &Cancel,
    add: impl Fn(&CrankAngles, &mut Rows) + Send + Sync,
) -> Result<Memory> {
    let cure = "split theta_deg into parts";
    limits::result_size("theta_deg", &[theta_deg.len(), 12], size_of::<f64>(), cure)?;
    check(theta_deg, cancel)?;
    if theta_deg.len() <= 4 * BLOCK {
        return fill_blocks(theta_deg, torque, cancel, add);
    }
    // Results are allocated there too: an allocator that keeps an arena for each thread then reuses
    // their memory, which halves the time of a hundred thousand angles.
    pool::run(cancel, || fill_blocks(theta_deg, torque, cancel, add))
}

fn fill_blocks(
    theta_deg: &[f64],
    torque: bool,
    cancel: &Cancel,
    add: impl Fn(&CrankAngles, &mut Rows) + Sync,
) -> Result<Memory> {
    let (angles, torques) = (theta_deg.len(), if torque { theta_deg.len() } else { 0 });
    let mut memory = Memory {
        pairs: [memory::zeros(2 * angles)?, memory::zeros(2 * angles)?],
        torques: [memory::zeros(torques)?, memory::zeros(torques)?],
    };
    let mut pairs = memory.pairs.each_mut().map(|values| values.chunks_mut(2 * BLOCK));
    let mut torques = memory.torques.each_mut().map(|values| values.chunks_mut(BLOCK));
    let tasks = theta_deg.chunks(BLOCK).map(|thetas| {
        let pairs = pairs.each_mut().map(|chunks| chunks.next().unwrap_or_default());
        let torques = torques.each_mut().map(|chunks| chunks.next().unwrap_or_default());
        (thetas, pairs, torques)
    });
    let mut listed = memory::room(tasks.len())?;
    listed.extend(tasks);
    let tasks = listed;
    let block = |(thetas, pairs, torques): (&[f64], [&mut [f64]; 2], [&mut [f64]; 2])| {
        cancel.check()?;
        let mut rows = Rows { columns: [const { Column::ZERO }; 6] };
        add(&CrankAngles::of_checked(thetas), &mut rows);
        let [force_x, force_y, moment_x, moment_y, roll, crank] = &rows.columns;
        for (out, [x, y]) in pairs.into_iter().zip([[force_x, force_y], [moment_x, moment_y]]) {
            for (pair, (x, y)) in out.chunks_exact_mut(2).zip(x.iter().zip(&y[..])) {
                pair.copy_from_slice(&[*x, *y]);
            }
        }
        for (out, column) in torques.into_iter().zip([roll, crank]) {
            out.copy_from_slice(&column[..out.len()]);
        }
        Ok(())
    };
    let done = if tasks.len() <= 4 {
        tasks.into_iter().try_for_each(block)
    } else {
        tasks.into_par_iter().try_for_each(block)
    };
    if let Err(cancelled) = done {
        memory::free_later(memory);
        return Err(cancelled);
    }
    Ok(memory)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::kinematics::tests::unlike as engine;

    #[test]
    fn whoever_stops_waiting_at_any_step_is_told_at_once() {
        // Four blocks are worked out one by one.
        let thetas = [0.0; 4 * BLOCK];
        let run = |last: usize| {
            let (cancel, blocks) = (Cancel::new(), AtomicUsize::new(0));
            let add = |_: &CrankAngles, _: &mut Rows| {
                if blocks.fetch_add(1, Ordering::Relaxed) + 1 == last {
                    cancel.raise();
                }
            };
            let result = in_blocks(&thetas, true, &cancel, add).map(drop);
            (result, blocks.into_inner())
        };
        assert_eq!(run(0), (Ok(()), 4));
        for last in 1..4 {
            assert_eq!(run(last), (Err(Error::Cancelled), last));
        }
    }

    #[test]
    fn how_many_orders_a_group_is_worth_does_not_depend_on_how_many_there_are() {
        for torque in [true, false] {
            let less = |groups, orders| kinematics_cost_less(&engine(groups), orders, torque);
            for groups in 1..8 {
                for orders in 1..16 {
                    let twice = less(2 * groups, 2 * orders);
                    assert_eq!(less(groups, orders), twice, "{groups} {orders}");
                }
            }
            assert!(less(1, 16) && !less(16, 1));
        }
    }
}
