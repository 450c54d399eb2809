//! Force, moment and torque at given crank angles: from exact kinematics, or as a sum of orders.

use ndarray::{Array1, Array2};
use rayon::prelude::*;

use crate::Complex64;
use crate::angle::{LARGEST_ANGLE, cis_degrees};
use crate::balance::{self, Asked, Balance, Orders, angular_speed};
use crate::cancel::Cancel;
use crate::engine::Engine;
use crate::error::{Error, Result};
use crate::limits;
use crate::simd::vectorised;
use crate::slider_crank::Proportions;

/// Crank angles that go through a cylinder's kinematics side by side.
const BLOCK: usize = 256;

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
    let square = omega * omega;
    let sources: Vec<Source> = engine
        .placements()
        .iter()
        .map(|p| {
            let force = p.cylinder.first_order() * square;
            Source {
                proportions: p.cylinder.proportions(),
                phase: p.tdc.cis(-1),
                bore: p.bank.cis(1),
                pin: p.pin().cis(1),
                lever: p.z - reference,
                force,
                torque: force * p.cylinder.crank_radius(),
                rotating: p.rotating_mass * p.cylinder.crank_radius() * square,
            }
        })
        .collect();
    let rows = in_blocks(theta_deg, cancel, |units, rows| {
        vectorised(
            #[inline(always)]
            || {
                for source in &sources {
                    if asked.torque {
                        source.add::<true>(units, rows);
                    } else {
                        source.add::<false>(units, rows);
                    }
                }
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
    let cylinders = engine.placements().len();
    let balance = balance.filter(|balance| {
        !kinematics || !kinematics_cost_less(cylinders, balance.orders.len(), asked.torque)
    });
    let Some(balance) = balance else {
        return exact(engine, asked, theta_deg, cancel);
    };
    let rows = in_blocks(theta_deg, cancel, |units, rows| {
        add_orders(&balance, units, rows);
    })?;
    let torque = balance.torque.is_some();
    Ok(rows.waveform(Some(balance), torque))
}

/// What a cylinder's kinematics and an order of a sum take, in nanoseconds for an angle: slopes
/// from 1 to 48 cylinders and from 1 to 16 orders, 1024 angles on one core (AMD EPYC, AVX-512).
const COST: [f64; 2] = [9.0, 5.0];
/// ... with roll and crank torque.
const COST_WITH_TORQUE: [f64; 2] = [11.0, 6.0];

/// Whether the kinematics of so many cylinders take less time than a sum of so many orders.
fn kinematics_cost_less(cylinders: usize, orders: usize, torque: bool) -> bool {
    let [cylinder, order] = if torque { COST_WITH_TORQUE } else { COST };
    cylinder * cylinders as f64 <= order * orders as f64
}

fn add_orders(balance: &Balance, units: &Units, rows: &mut Rows) {
    let zero = Complex64::default();
    for (k, &n) in balance.orders.iter().enumerate() {
        let torque = balance.torque.as_ref();
        let columns = if torque.is_some() { 6 } else { 4 };
        let phasors = [
            balance.force.xy[[k, 0]],
            balance.force.xy[[k, 1]],
            balance.moment.xy[[k, 0]],
            balance.moment.xy[[k, 1]],
            torque.map_or(zero, |t| t.roll[k]),
            torque.map_or(zero, |t| t.crank[k]),
        ];
        for i in 0..units.count {
            let unit = Complex64::new(units.cos[i], units.sin[i]).powu(n);
            for (column, phasor) in rows.columns.iter_mut().zip(phasors).take(columns) {
                column[i] += phasor.re * unit.re - phasor.im * unit.im;
            }
        }
    }
}

/// One cylinder as its kinematics need it.
struct Source {
    proportions: Proportions,
    /// `e^{−i·tdc}`.
    phase: Complex64,
    bore: Complex64,
    pin: Complex64,
    lever: f64,
    /// m·r·ω².
    force: f64,
    /// m·r²·ω².
    torque: f64,
    /// Rotating mass times r·ω².
    rotating: f64,
}

impl Source {
    #[inline(always)]
    fn add<const TORQUE: bool>(&self, units: &Units, rows: &mut Rows) {
        let [force_x, force_y, moment_x, moment_y, roll, crank] = &mut rows.columns;
        for i in 0..BLOCK {
            let (sin, cos) = (units.sin[i], units.cos[i]);
            let motion = self.proportions.motion(
                sin * self.phase.re + cos * self.phase.im,
                cos * self.phase.re - sin * self.phase.im,
            );
            let along = -self.force * motion.acceleration;
            let x = along * self.bore.re + self.rotating * (self.pin.re * cos - self.pin.im * sin);
            let y = along * self.bore.im + self.rotating * (self.pin.re * sin + self.pin.im * cos);
            force_x[i] += x;
            force_y[i] += y;
            moment_x[i] -= self.lever * y;
            moment_y[i] += self.lever * x;
            if TORQUE {
                let torque = self.torque * motion.acceleration;
                roll[i] += torque * (motion.velocity + self.proportions.offset);
                crank[i] -= torque * motion.velocity;
            }
        }
    }
}

/// `e^{iθ}` of a block of crank angles.
struct Units {
    cos: [f64; BLOCK],
    sin: [f64; BLOCK],
    count: usize,
}

/// Force x, y, moment x, y, roll and crank torque.
#[derive(Clone)]
struct Rows {
    columns: [Vec<f64>; 6],
}

impl Rows {
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
    add: impl Fn(&Units, &mut Rows) + Sync,
) -> Result<Rows> {
    let cure = "split theta_deg into parts";
    limits::result_size("theta_deg", &[theta_deg.len(), 12], size_of::<f64>(), cure)?;
    let block = |thetas: &[f64]| -> Result<Rows> {
        cancel.check()?;
        let mut units = Units { cos: [1.0; BLOCK], sin: [0.0; BLOCK], count: thetas.len() };
        for (i, &θ) in thetas.iter().enumerate() {
            if !θ.is_finite() || θ.abs() > LARGEST_ANGLE {
                let cure = format!("give finite degrees of magnitude {LARGEST_ANGLE:e} at most");
                return Err(Error::figure("theta_deg", θ, cure));
            }
            let unit = cis_degrees(θ);
            (units.cos[i], units.sin[i]) = (unit.re, unit.im);
        }
        let mut rows = Rows { columns: std::array::from_fn(|_| vec![0.0; BLOCK]) };
        add(&units, &mut rows);
        rows.columns.iter_mut().for_each(|column| column.truncate(thetas.len()));
        Ok(rows)
    };
    let blocks: Vec<Rows> = if theta_deg.len() <= 4 * BLOCK {
        theta_deg.chunks(BLOCK).map(block).collect::<Result<_>>()?
    } else {
        theta_deg.par_chunks(BLOCK).map(block).collect::<Result<_>>()?
    };
    let join =
        |column: usize| blocks.iter().flat_map(|b| b.columns[column].iter().copied()).collect();
    Ok(Rows { columns: std::array::from_fn(join) })
}
