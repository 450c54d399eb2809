//! Force, moment and torque at given crank angles: from exact kinematics, or as a sum of orders.

use ndarray::{Array1, Array2};

use crate::Complex64;
use crate::engine::Engine;
use crate::gear::rod::Swing;
use crate::gear::slider_crank::Proportions;
use crate::load::Loads;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::{CrankAngles, check};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::pool;
use crate::numbers::simd::vectorised;
use crate::readings::balance::{self, Balance, Orders, Request, Vector, angular_speed};
use crate::readings::kinematics::{
    AngleBlock, AngleColumn, BLOCK, Kinematics, Pistons, Pressures, Units,
};

/// An engine's shaking over crank angle.
#[derive(Debug, Clone, PartialEq)]
pub struct Waveform {
    /// Shaking force along x and y, N: (`n_theta`, 2).
    pub force: Array2<f64>,
    /// Rocking moment about x and y, N·m: (`n_theta`, 2).
    pub moment: Array2<f64>,
    /// Roll torque on the block about +z, N·m: (`n_theta`,).
    pub torque: Option<Array1<f64>>,
    /// Torque on the crank about +z, N·m: (`n_theta`,).
    pub crank_torque: Option<Array1<f64>>,
    /// What gas pressure adds to both, of an engine with cycles.
    pub gas: Option<[Array1<f64>; 2]>,
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
    let loads = Loads::new(engine, reference);
    let kinematics = Kinematics::new(&loads);
    let square = omega * omega;
    let shape = Shape {
        torques: torques(engine, request.torque),
        zero_bounds: kinematics.zero_bounds.map(|bound| bound * square),
    };
    in_blocks(theta_deg, &shape, cancel, |angles, rows| {
        vectorised(
            #[inline(always)]
            || rows.add_kinematics(&kinematics, angles, request.torque, square),
        );
        Ok(())
    })
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
    // Phasors that cancel are zero already.
    let shape = Shape { torques: torques(engine, balance.has_torque), zero_bounds: [0.0; 2] };
    let waveform = in_blocks(theta_deg, &shape, cancel, |angles, rows| {
        vectorised(
            #[inline(always)]
            || rows.add_orders(&balance, angles),
        );
        Ok(())
    })?;
    Ok(Waveform { balance: Some(balance), ..waveform })
}

/// What a waveform has.
struct Shape {
    /// Number of torques.
    torques: usize,
    /// Forces and moments that are rounding.
    zero_bounds: [f64; 2],
}

/// Number of torques: on the block and on the crank, and what pressure adds to them.
fn torques(engine: &Engine, wanted: bool) -> usize {
    match (wanted, engine.gas()) {
        (false, _) => 0,
        (true, None) => 2,
        (true, Some(_)) => 4,
    }
}

/// Force x, y, moment x, y, roll and crank torque, and what pressure adds to these, at a block of crank
/// angles; whole lines of the cache.
#[repr(align(64))]
pub(super) struct WaveformRows {
    pub columns: [AngleColumn; 8],
}

impl WaveformRows {
    pub const ZERO: Self = Self { columns: [[0.0; BLOCK]; 8] };

    #[inline(always)]
    fn add_kinematics(
        &mut self,
        kinematics: &Kinematics,
        angles: &CrankAngles,
        torque: bool,
        square: f64,
    ) {
        let block = AngleBlock::new(angles, 0..angles.len());
        for pistons in &kinematics.pistons {
            let proportions = pistons.cylinder.proportions();
            self.add_pistons(pistons, &proportions, &block, [true, torque], square);
        }
        self.add_unbalances(kinematics, &block, torque, square);
        if torque {
            for pressures in &kinematics.pressures {
                self.add_pressure(pressures, &pressures.proportions, &block);
            }
        }
    }

    #[inline(always)]
    pub fn add_unbalances(
        &mut self,
        kinematics: &Kinematics,
        block: &AngleBlock,
        torque: bool,
        square: f64,
    ) {
        let [force_x, force_y, moment_x, moment_y, roll, ..] = &mut self.columns;
        for unbalances in &kinematics.unbalances {
            let units = block.units(unbalances.ratio);
            let [force, moment] = unbalances.planar.map(|sum| sum * square);
            units.add_turning(force, unbalances.ratio, [&mut force_x[..], &mut force_y[..]]);
            units.add_turning(moment, unbalances.ratio, [&mut moment_x[..], &mut moment_y[..]]);
            if torque && unbalances.roll != Complex64::default() {
                let mut real = [0.0; BLOCK];
                let at_start = unbalances.roll * square;
                units.add_turning(at_start, unbalances.ratio, [&mut real[..], &mut roll[..]]);
            }
        }
    }

    /// Adds force and moment, torques or all of them of pistons of slider-cranks of these proportions.
    #[inline(always)]
    pub fn add_pistons(
        &mut self,
        pistons: &Pistons,
        proportions: &Proportions,
        block: &AngleBlock,
        [planar, torque]: [bool; 2],
        square: f64,
    ) {
        let units = &*block.units(pistons.ratio);
        let [force_x, force_y, moment_x, moment_y, roll, crank, ..] = &mut self.columns;
        let [force, moment] = pistons.planar.map(|sum| sum * square);
        let arm = pistons.arm * square;
        let senses = pistons.senses.map(|sense| sense * square);
        let [on_block, on_crank] = senses.map(|sense| sense * pistons.second_moment);
        for i in 0..BLOCK {
            let motion = proportions.motion_at(&units.crank(pistons.phase, i));
            if planar {
                force_x[i] += force.re * motion.acceleration;
                force_y[i] += force.im * motion.acceleration;
                moment_x[i] += moment.re * motion.acceleration;
                moment_y[i] += moment.im * motion.acceleration;
            }
            if torque {
                let along = motion.velocity + proportions.offset;
                roll[i] += (on_block * along + arm) * motion.acceleration;
                crank[i] -= on_crank * motion.velocity * motion.acceleration;
            }
        }
        if torque && pistons.rod_inertia != 0.0 {
            let [on_block, on_crank] = senses.map(|sense| sense * pistons.rod_inertia);
            for i in 0..BLOCK {
                let swing = Swing::new(proportions, &units.crank(pistons.phase, i));
                roll[i] += on_block * swing.roll();
                crank[i] += on_crank * swing.crank();
            }
        }
    }

    pub fn add_pressure(
        &mut self,
        pressures: &Pressures,
        proportions: &Proportions,
        block: &AngleBlock,
    ) {
        let mut torques = [0.0; BLOCK];
        pressures.add(proportions, block, &mut torques[..]);
        let [on_block, on_crank] = pressures.gear.senses();
        for (column, sense) in [(4, -on_block), (5, on_crank)] {
            for (i, torque) in torques.iter().enumerate() {
                self.columns[column][i] += sense * torque;
                self.columns[column + 2][i] += sense * torque;
            }
        }
    }

    #[inline(always)]
    fn add_orders(&mut self, balance: &Balance, angles: &CrankAngles) {
        for (k, mean) in balance.mean.into_iter().enumerate() {
            for column in [4 + k, 6 + k] {
                self.columns[column].iter_mut().for_each(|torque| *torque += mean);
            }
        }
        for (k, &order) in balance.orders.iter().enumerate() {
            let Units { cos, sin } = Units::new(angles, 0..angles.len(), order);
            let ([force_x, force_y], [moment_x, moment_y]) =
                (balance.xy(Vector::Force, k), balance.xy(Vector::Moment, k));
            let (torque, gas) = (balance.wrenches[k].torque(), balance.wrenches[k].gas);
            let torques = [torque.roll, torque.crank, gas.roll, gas.crank];
            let [a, b, c, d] = torques;
            let phasors = [force_x, force_y, moment_x, moment_y, a, b, c, d];
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

/// Numbers of [`pool::worth`] that take as long as a crank angle of an engine of a few cylinders.
const NUMBERS: usize = 24;

/// Run over the crank angles in blocks, in parallel.
fn in_blocks(
    theta_deg: &[f64],
    shape: &Shape,
    cancel: &Cancel,
    add: impl Fn(&CrankAngles, &mut WaveformRows) -> Result<()> + Send + Sync,
) -> Result<Waveform> {
    let hint = "split theta_deg into parts";
    limits::result_size("theta_deg", &[theta_deg.len(), 16], size_of::<f64>(), hint)?;
    check(theta_deg, cancel)?;
    if !pool::worth(NUMBERS * theta_deg.len()) {
        return fill_blocks(theta_deg, shape, cancel, add);
    }
    // Results are allocated there too: an allocator that keeps an arena for each thread then reuses
    // their memory, which halves the time of a hundred thousand angles.
    pool::run(cancel, || fill_blocks(theta_deg, shape, cancel, add))
}

fn fill_blocks(
    theta_deg: &[f64],
    shape: &Shape,
    cancel: &Cancel,
    add: impl Fn(&CrankAngles, &mut WaveformRows) -> Result<()> + Sync,
) -> Result<Waveform> {
    let angles = theta_deg.len();
    let mut planar: [Vec<f64>; 2] = [memory::zeros(2 * angles)?, memory::zeros(2 * angles)?];
    let mut torques: Vec<Vec<f64>> =
        (0..shape.torques).map(|_| memory::zeros(angles)).collect::<Result<_>>()?;
    let mut pairs = planar.each_mut().map(|values| values.chunks_mut(2 * BLOCK));
    let mut columns: Vec<_> = torques.iter_mut().map(|values| values.chunks_mut(BLOCK)).collect();
    let tasks = theta_deg.chunks(BLOCK).map(|thetas| {
        let pairs = pairs.each_mut().map(|chunks| chunks.next().unwrap_or_default());
        let mut of_block: [&mut [f64]; 4] = Default::default();
        for (out, chunks) in of_block.iter_mut().zip(&mut columns) {
            *out = chunks.next().unwrap_or_default();
        }
        (thetas, pairs, of_block)
    });
    let tasks = memory::collected(tasks)?;
    let block = |(thetas, pairs, torques): (&[f64], [&mut [f64]; 2], [&mut [f64]; 4])| {
        cancel.check()?;
        let mut rows = WaveformRows::ZERO;
        add(&CrankAngles::of_checked(thetas), &mut rows)?;
        let [force_x, force_y, moment_x, moment_y, torque_columns @ ..] = &rows.columns;
        let columns = [[force_x, force_y], [moment_x, moment_y]];
        for ((out, [x, y]), bound) in pairs.into_iter().zip(columns).zip(shape.zero_bounds) {
            let snapped = |value: f64| if value.abs() <= bound { 0.0 } else { value };
            for (pair, (x, y)) in out.as_chunks_mut().0.iter_mut().zip(x.iter().zip(&y[..])) {
                *pair = [snapped(*x), snapped(*y)];
            }
        }
        for (out, column) in torques.into_iter().zip(torque_columns) {
            out.copy_from_slice(&column[..out.len()]);
        }
        Ok(())
    };
    pool::each(cancel, tasks, NUMBERS * angles, block)?;
    let [force, moment] =
        planar.map(|values| memory::array("theta_deg", (values.len() / 2, 2), values));
    let mut torques = torques.into_iter().map(Array1::from);
    Ok(Waveform {
        force: force?,
        moment: moment?,
        torque: torques.next(),
        crank_torque: torques.next(),
        gas: torques.next().zip(torques.next()).map(|(roll, crank)| [roll, crank]),
        balance: None,
    })
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
            let shape = Shape { torques: 2, zero_bounds: [0.0; 2] };
            let result = in_blocks(&thetas, &shape, &cancel, add).map(drop);
            (result, blocks.into_inner())
        };
        assert_eq!(run(0), (Ok(()), 4));
        for last in 1..4 {
            assert_eq!(run(last), (Err(Error::Cancelled), last));
        }
    }
}
