//! Force, moment and torque at given crank angles: from exact kinematics, or as a sum of orders.

use ndarray::{Array1, Array2};

use crate::Complex64;
use crate::engine::Engine;
use crate::load::LoadList;
use crate::load::kinematics::{AngleBlock, BLOCK, Columns, Kinematics, Quantities, Units};
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::{CrankAngles, check};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::pool;
use crate::numbers::simd::vectorised;
use crate::readings::balance::{self, Balance, Orders, Request, Vector, angular_speed};

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
///
/// ```
/// # let four = crankpin_core::engine::file::from_toml(
/// #     "schema = 1
/// #     cylinder = { crank_radius = 0.043, rod_length = 0.145, reciprocating_mass = 0.66 }
/// #     placements = [
/// #         { tdc_deg = 0, bank_deg = 90, z = 0 }, { tdc_deg = 180, bank_deg = 90, z = 0.1 },
/// #         { tdc_deg = 180, bank_deg = 90, z = 0.2 }, { tdc_deg = 0, bank_deg = 90, z = 0.3 },
/// #     ]",
/// # )?;
/// use crankpin_core::balance::Request;
/// use crankpin_core::{Cancel, waveform};
///
/// let request = Request { rpm: 6000.0, reference_z: None, torque: true };
/// let found = waveform::exact(&four, &request, &[0.0, 45.0, 90.0], &Cancel::new())?;
/// assert_eq!(found.force.dim(), (3, 2));
/// assert!(found.force[[0, 1]] > 1e4); // N, upwards with the pistons 1 and 4 at the top
/// # Ok::<(), crankpin_core::Error>(())
/// ```
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
    let loads = LoadList::new(engine, reference);
    let kinematics = Kinematics::new(&loads);
    let square = omega * omega;
    let shape = Shape {
        torques: torques(engine, request.torque),
        zero_bounds: kinematics.zero_bounds.map(|bound| bound * square),
    };
    let wanted = Quantities { planar: true, torque: request.torque };
    in_blocks(theta_deg, &shape, cancel, |angles, columns| {
        let block = AngleBlock::new(angles, 0..angles.len());
        for sum in &kinematics.sums {
            sum.source.over_angle(sum, &block, wanted, square, columns);
        }
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
    let waveform = in_blocks(theta_deg, &shape, cancel, |angles, columns| {
        vectorised(
            #[inline(always)]
            || columns.add_orders(&balance, angles),
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

impl Columns {
    #[inline(always)]
    fn add_orders(&mut self, balance: &Balance, angles: &CrankAngles) {
        for (k, mean) in balance.mean.into_iter().enumerate() {
            for column in [&mut self.torque[k], &mut self.gas[k]] {
                for torque in column.iter_mut() {
                    *torque += mean;
                }
            }
        }
        for (k, &order) in balance.orders.iter().enumerate() {
            let Units { cos, sin } = Units::new(angles, 0..angles.len(), order);
            let (torque, gas) = (balance.wrenches[k].torque(), balance.wrenches[k].gas);
            let pairs = [
                (&mut self.force, balance.xy(Vector::Force, k)),
                (&mut self.moment, balance.xy(Vector::Moment, k)),
                (&mut self.torque, [torque.roll, torque.crank]),
                (&mut self.gas, [gas.roll, gas.crank]),
            ];
            let each =
                pairs.into_iter().flat_map(|(columns, phasors)| columns.iter_mut().zip(phasors));
            for (column, phasor) in each {
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

/// Numbers of [`pool::is_worth_parallel`] that take as long as a crank angle of an engine of a few cylinders.
const NUMBERS_PER_ANGLE: usize = 24;

/// Run over the crank angles in blocks, in parallel.
fn in_blocks(
    theta_deg: &[f64],
    shape: &Shape,
    cancel: &Cancel,
    add: impl Fn(&CrankAngles, &mut Columns) -> Result<()> + Send + Sync,
) -> Result<Waveform> {
    let hint = "split theta_deg into parts";
    limits::result_size("theta_deg", &[theta_deg.len(), 16], size_of::<f64>(), hint)?;
    check(theta_deg, cancel)?;
    if !pool::is_worth_parallel(NUMBERS_PER_ANGLE * theta_deg.len()) {
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
    add: impl Fn(&CrankAngles, &mut Columns) -> Result<()> + Sync,
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
        let mut columns = Columns::ZERO;
        add(&CrankAngles::of_checked(thetas), &mut columns)?;
        let Columns { force, moment, torque, gas } = &columns;
        let planar = pairs.into_iter().zip([force, moment]).zip(shape.zero_bounds);
        for ((out, [x, y]), bound) in planar {
            let snapped = |value: f64| if value.abs() <= bound { 0.0 } else { value };
            for (pair, (x, y)) in out.as_chunks_mut().0.iter_mut().zip(x.iter().zip(&y[..])) {
                *pair = [snapped(*x), snapped(*y)];
            }
        }
        for (out, column) in torques.into_iter().zip(torque.iter().chain(gas)) {
            out.copy_from_slice(&column[..out.len()]);
        }
        Ok(())
    };
    pool::each(cancel, tasks, NUMBERS_PER_ANGLE * angles, block)?;
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
            let add = |_: &CrankAngles, _: &mut Columns| {
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
