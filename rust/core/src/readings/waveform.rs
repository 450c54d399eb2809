//! Force, moment and torque at given crank angles: from exact kinematics, or as a sum of orders.

use ndarray::{Array1, Array2};
use rayon::prelude::*;

use crate::Complex64;
use crate::engine::Engine;
use crate::gear::rod::Swing;
use crate::load::{Alike, Loads};
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::{CrankAngles, check};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::pool;
use crate::numbers::simd::vectorised;
use crate::readings::balance::{self, Balance, Orders, Request, Vector, angular_speed};
use crate::readings::kinematics::{AngleColumn, BLOCK, Kinematics, Pistons, Units};

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
    /// The orders summed; none for exact kinematics.
    pub balance: Option<Balance>,
}

/// From exact kinematics at crank angles in degrees.
pub fn exact(
    engine: &Engine,
    request: &Request,
    theta_deg: &[f64],
    cancel: &Cancel,
) -> Result<Waveform> {
    if engine.spectrum().is_some() {
        let hint = "exact kinematics needs the slider-crank; give orders, or \"auto\"";
        return Err(Error::value("spectrum", "given", hint));
    }
    let omega = angular_speed(request.rpm)?;
    let reference = engine.reference(request.reference_z)?;
    let loads = Loads::new(engine, reference, Alike::Proportions);
    let kinematics = Kinematics::new(&loads);
    let memory = in_blocks(theta_deg, request.torque, cancel, |angles, rows| {
        vectorised(
            #[inline(always)]
            || rows.add_kinematics(&kinematics, angles, request.torque, omega * omega),
        );
        Ok(())
    })?;
    memory.waveform(None, request.torque)
}

/// As a sum of orders.
pub fn from_orders(
    engine: &Engine,
    request: &Request,
    theta_deg: &[f64],
    orders: &Orders,
    cancel: &Cancel,
) -> Result<Waveform> {
    let balance = balance::balance(engine, request, orders, cancel)?;
    let memory = in_blocks(theta_deg, balance.has_torque, cancel, |angles, rows| {
        vectorised(
            #[inline(always)]
            || rows.add_orders(&balance, angles),
        );
        Ok(())
    })?;
    let torque = balance.has_torque;
    memory.waveform(Some(balance), torque)
}

/// Force x, y, moment x, y, roll and crank torque.
struct WaveformRows {
    columns: [AngleColumn; 6],
}

impl WaveformRows {
    #[inline(always)]
    fn add_kinematics(
        &mut self,
        kinematics: &Kinematics,
        angles: &CrankAngles,
        torque: bool,
        square: f64,
    ) {
        let main = Units::new(angles, 0..angles.len(), Order::FIRST);
        for pistons in &kinematics.pistons {
            let other = (pistons.ratio.abs() != 1)
                .then(|| Units::at_speed(angles, 0..angles.len(), pistons.ratio));
            let units = other.as_ref().unwrap_or(&main);
            if torque {
                self.add::<true>(pistons, square, units);
            } else {
                self.add::<false>(pistons, square, units);
            }
        }
        let [force_x, force_y, moment_x, moment_y, roll, _] = &mut self.columns;
        for unbalances in &kinematics.unbalances {
            let units = Units::at_speed(angles, 0..angles.len(), unbalances.ratio);
            let [force, moment] = unbalances.planar.map(|sum| sum * square);
            units.add_turning(force, unbalances.ratio, [&mut force_x[..], &mut force_y[..]]);
            units.add_turning(moment, unbalances.ratio, [&mut moment_x[..], &mut moment_y[..]]);
            if torque && unbalances.roll != Complex64::default() {
                let mut real = AngleColumn::ZERO;
                let at_start = unbalances.roll * square;
                units.add_turning(at_start, unbalances.ratio, [&mut real[..], &mut roll[..]]);
            }
        }
    }

    #[inline(always)]
    fn add<const TORQUE: bool>(&mut self, pistons: &Pistons, square: f64, units: &Units) {
        let [force_x, force_y, moment_x, moment_y, roll, crank] = &mut self.columns;
        let [force, moment] = pistons.planar.map(|sum| sum * square);
        let (proportions, arm) = (pistons.cylinder.proportions(), pistons.arm * square);
        let senses = pistons.senses().map(|sense| sense * square);
        let [on_block, on_crank] = senses.map(|sense| sense * pistons.second_moment);
        for i in 0..BLOCK {
            let motion = proportions.motion_at(&units.crank(pistons.phase, i));
            force_x[i] += force.re * motion.acceleration;
            force_y[i] += force.im * motion.acceleration;
            moment_x[i] += moment.re * motion.acceleration;
            moment_y[i] += moment.im * motion.acceleration;
            if TORQUE {
                let along = motion.velocity + proportions.offset;
                roll[i] += (on_block * along + arm) * motion.acceleration;
                crank[i] -= on_crank * motion.velocity * motion.acceleration;
            }
        }
        if TORQUE && pistons.rod_inertia != 0.0 {
            let [on_block, on_crank] = senses.map(|sense| sense * pistons.rod_inertia);
            for i in 0..BLOCK {
                let swing = Swing::new(&proportions, &units.crank(pistons.phase, i));
                roll[i] += on_block * swing.roll();
                crank[i] += on_crank * swing.crank();
            }
        }
    }

    #[inline(always)]
    fn add_orders(&mut self, balance: &Balance, angles: &CrankAngles) {
        for (k, &order) in balance.orders.iter().enumerate() {
            let Units { cos, sin } = Units::new(angles, 0..angles.len(), order);
            let ([force_x, force_y], [moment_x, moment_y]) =
                (balance.xy(Vector::Force, k), balance.xy(Vector::Moment, k));
            let torque = &balance.wrenches[k].torque();
            let phasors = [force_x, force_y, moment_x, moment_y, torque.roll, torque.crank];
            for (column, phasor) in self.columns.iter_mut().zip(phasors) {
                if phasor == Complex64::default() {
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
    add: impl Fn(&CrankAngles, &mut WaveformRows) -> Result<()> + Send + Sync,
) -> Result<Memory> {
    let hint = "split theta_deg into parts";
    limits::result_size("theta_deg", &[theta_deg.len(), 12], size_of::<f64>(), hint)?;
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
    add: impl Fn(&CrankAngles, &mut WaveformRows) -> Result<()> + Sync,
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
        let mut rows = WaveformRows { columns: [const { AngleColumn::ZERO }; 6] };
        add(&CrankAngles::of_checked(thetas), &mut rows)?;
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
    done?;
    Ok(memory)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::load;

    #[test]
    fn exact_samples_are_the_sums_of_all_orders() {
        let engine = load::tests::engine();
        let request = Request { rpm: 1000.0, reference_z: Some(0.07), torque: true };
        let theta_deg: Vec<f64> = (0..40).map(|k| 27.0 * f64::from(k)).collect();
        let exact = exact(&engine, &request, &theta_deg, &Cancel::new()).unwrap();
        let all = Orders::Auto { rtol: 1e-14 };
        let summed = from_orders(&engine, &request, &theta_deg, &all, &Cancel::new()).unwrap();
        let planar = [(&exact.force, &summed.force), (&exact.moment, &summed.moment)];
        for (one, other) in planar {
            let largest = one.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            for (one, other) in one.iter().zip(other) {
                // Roundings of some twenty orders and ten loads.
                assert!((one - other).abs() < 1e-13 * largest, "{one} is not {other}");
            }
        }
        let torques = [(exact.torque, summed.torque), (exact.crank_torque, summed.crank_torque)];
        for (one, other) in torques {
            let (one, other) = (one.unwrap(), other.unwrap());
            let largest = one.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!(largest > 0.1, "no torque");
            for (one, other) in one.iter().zip(&other) {
                assert!((one - other).abs() < 1e-13 * largest, "{one} is not {other}");
            }
        }
    }

    #[test]
    fn cancellation_stops_at_the_next_block() {
        // Four blocks are evaluated one by one.
        let thetas = [0.0; 4 * BLOCK];
        let run = |last: usize| {
            let (cancel, blocks) = (Cancel::new(), AtomicUsize::new(0));
            let add = |_: &CrankAngles, _: &mut WaveformRows| {
                if blocks.fetch_add(1, Ordering::Relaxed) + 1 == last {
                    cancel.raise();
                }
                Ok(())
            };
            let result = in_blocks(&thetas, true, &cancel, add).map(drop);
            (result, blocks.into_inner())
        };
        assert_eq!(run(0), (Ok(()), 4));
        for last in 1..4 {
            assert_eq!(run(last), (Err(Error::Cancelled), last));
        }
    }
}
