//! An engine on many designs of its mounts: natural frequencies, and the largest responses over speed.

#![allow(clippy::needless_range_loop, reason = "lanes of several arrays are indexed in step")]

use std::f64::consts::TAU;

use nalgebra::Matrix3x6;

use crate::Complex64;
use crate::engine::Engine;
use crate::mounts::equations::{Equations, LANES, Lane, Lanes6, product, rows};
use crate::mounts::{
    ComplexMatrix6, ComplexVector6, Mount, Orientation, Powertrain, motion_of_point,
    natural_frequencies,
};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::pool;
use crate::numbers::simd::vectorised;
use crate::readings::balance::{ErrorBounds, Orders};
use crate::readings::mounted::Loads;

/// Designs computed between two checks whether another thread is idle.
const DESIGNS_PER_TASK: usize = 8;

/// A figure of a mount that differs between designs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Figure {
    /// Place, m.
    At,
    /// Degrees, the first of three numbers.
    Tilt,
    /// N/m at rest, and in motion where no dynamic stiffness is given.
    Stiffness,
    /// N/m in motion.
    DynamicStiffness,
    /// Imaginary over real part.
    LossFactor,
    /// N·s/m.
    Damping,
}

/// A figure of a mount in each design.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// Index of the mount.
    pub mount: usize,
    /// The figure.
    pub figure: Figure,
    /// Its values along x, y and z, or the mount's axes.
    pub values: Vec<[f64; 3]>,
}

/// What is computed of each design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DesignRequest<'a> {
    /// Crank speeds.
    pub rpm: &'a [f64],
    /// Multiples of crank speed.
    pub orders: &'a Orders,
    /// Whether the force of each mount counts, besides their sum.
    pub mount_forces: bool,
    /// Points of the powertrain whose velocity counts, m.
    pub points: &'a [[f64; 3]],
    /// Frequency at which natural frequencies take the stiffness, Hz.
    pub frequency: Option<f64>,
}

/// Largest responses of each design: first the force on what carries the mounts, then that of each mount,
/// then the velocity of each point, along x, y and z.
#[derive(Debug, Clone, PartialEq)]
pub struct MountDesigns {
    /// Multiples of crank speed.
    pub orders: Vec<Order>,
    /// Orders left out that are not zero.
    pub omitted: Vec<Order>,
    /// Bounds of what they add to the load at the highest speed.
    pub error_bound: ErrorBounds,
    /// Hz, ascending, six of each design; NaN where the stiffness depends on frequency and none is given.
    pub frequency: Vec<[f64; 6]>,
    /// Largest peak over speed, of each design, quantity and order.
    pub largest: Vec<[f64; 3]>,
    /// Largest root mean square over speed of all orders, of each design and quantity.
    pub rms: Vec<[f64; 3]>,
    /// Quantities of each design.
    pub quantities: usize,
}

/// Loads and stiffness at speeds and orders, which all designs share.
struct Shared<'a> {
    request: DesignRequest<'a>,
    loads: Loads,
    /// Speeds in lanes, the last one again where there are fewer.
    omega: Vec<Lane>,
    /// Load of each order over (nω)², and that of gas pressure.
    amplitudes: Vec<[ComplexVector6; 2]>,
    /// Stiffness of each direction of each mount at the speeds of each lane and order, as it is without
    /// variations; empty where no design needs it.
    stiffnesses: Vec<[Lane; 2]>,
    /// Mounts whose stiffness differs between designs.
    varied: Vec<usize>,
}

/// Evaluate the designs of a powertrain that variations make.
pub fn mount_designs(
    engine: &Engine,
    base: &Powertrain,
    variations: &[Variation],
    request: &DesignRequest,
    cancel: &Cancel,
) -> Result<MountDesigns> {
    if base.support().is_some() {
        let hint = "designs are those of mounts on what does not move: leave out the support";
        return Err(Error::value("support", "given", hint));
    }
    let count = variations.first().map_or(0, |first| first.values.len());
    for variation in variations {
        let (found, mounts) = (variation.values.len(), base.mounts().len());
        limits::same_length("vary", found, "the first figure", count, "design")?;
        if variation.mount >= mounts {
            let hint = format!("give an index below {mounts}");
            return Err(Error::value("vary", format!("mount {}", variation.mount), hint));
        }
    }
    if count == 0 {
        return Err(Error::value("vary", "no design", "give one value or more of some figure"));
    }
    for (k, point) in request.points.iter().enumerate() {
        for &place in point {
            limits::finite(&format!("at[{k}]"), place)?;
        }
    }
    let shared = Shared::new(engine, base, variations, request, cancel)?;
    let (orders, mounts) = (shared.loads.orders.len(), base.mounts().len());
    let quantities = 1 + usize::from(request.mount_forces) * mounts + request.points.len();
    let hint = "give fewer designs, orders or quantities";
    limits::result_size("designs", &[count, quantities, orders + 1, 3], size_of::<f64>(), hint)?;
    let mut frequency = memory::collected(std::iter::repeat_n([f64::NAN; 6], count))?;
    let zero = [0.0; 3];
    let mut largest = memory::collected(std::iter::repeat_n(zero, count * quantities * orders))?;
    let mut rms = memory::collected(std::iter::repeat_n(zero, count * quantities))?;
    let of_largest = (quantities * orders).max(1);
    let mut tasks = memory::with_capacity(count.div_ceil(DESIGNS_PER_TASK))?;
    let mut parts = largest.chunks_mut(DESIGNS_PER_TASK * of_largest);
    let both =
        frequency.chunks_mut(DESIGNS_PER_TASK).zip(rms.chunks_mut(DESIGNS_PER_TASK * quantities));
    for (task, (frequency, rms)) in both.enumerate() {
        tasks.push((task, frequency, rms, parts.next().unwrap_or_default()));
    }
    let numbers = count * (64 + orders * request.rpm.len());
    pool::each(cancel, tasks, numbers, |(task, frequency, rms, largest)| {
        for (k, frequency) in frequency.iter_mut().enumerate() {
            cancel.check()?;
            let design = task * DESIGNS_PER_TASK + k;
            let of = |error: Error| error.within(&format!("design {design}: "));
            let powertrain = varied(base, variations, design).map_err(of)?;
            *frequency = natural_frequencies(&powertrain, request.frequency).map_err(of)?;
            let rms = &mut rms[k * quantities..(k + 1) * quantities];
            let largest = &mut largest[k * quantities * orders..(k + 1) * quantities * orders];
            shared.evaluate(&powertrain, largest, rms, cancel).map_err(of)?;
        }
        Ok(())
    })?;
    let Loads { orders, omitted, error_bound, .. } = shared.loads;
    Ok(MountDesigns { orders, omitted, error_bound, frequency, largest, rms, quantities })
}

/// A design.
fn varied(base: &Powertrain, variations: &[Variation], design: usize) -> Result<Powertrain> {
    let mut mounts = base.mounts().to_vec();
    for variation in variations {
        let mut figures = mounts[variation.mount].figures().clone();
        let value = variation.values[design];
        match variation.figure {
            Figure::At => figures.at = value,
            Figure::Tilt => figures.orientation = Orientation::Tilt(value[0]),
            Figure::Stiffness => figures.stiffness = value,
            Figure::DynamicStiffness => figures.dynamic_stiffness = Some(value),
            Figure::LossFactor => figures.loss_factor = value,
            Figure::Damping => figures.damping = value,
        }
        let name = figures.name.clone();
        mounts[variation.mount] =
            Mount::new(figures).map_err(|error| error.within(&format!("mount {name:?}: ")))?;
    }
    Powertrain::new(*base.body(), mounts)
}

impl<'a> Shared<'a> {
    fn new(
        engine: &Engine,
        base: &Powertrain,
        variations: &[Variation],
        request: &DesignRequest<'a>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let loads = Loads::new(engine, base.body().cg(), request.rpm, request.orders, cancel)?;
        let omega: Vec<Lane> = loads
            .omega
            .chunks(LANES)
            .map(|few| std::array::from_fn(|l| few[l.min(few.len() - 1)]))
            .collect();
        let amplitudes = loads.amplitudes();
        let is_of_stiffness =
            |variation: &&Variation| !matches!(variation.figure, Figure::At | Figure::Tilt);
        let mut varied: Vec<usize> =
            variations.iter().filter(is_of_stiffness).map(|variation| variation.mount).collect();
        varied.sort_unstable();
        varied.dedup();
        let mut shared =
            Self { request: *request, loads, omega, amplitudes, stiffnesses: Vec::new(), varied };
        let directions = 3 * base.mounts().len();
        let points = shared.omega.len() * shared.amplitudes.len();
        let lengths = [points, directions, 2 * LANES];
        limits::result_size("designs", &lengths, size_of::<f64>(), "give fewer speeds or orders")?;
        let mut stiffnesses = memory::with_capacity(points * directions)?;
        for place in 0..points {
            cancel.check()?;
            let all = 0..base.mounts().len();
            let zero = [[0.0; LANES]; 2];
            let from = stiffnesses.len();
            stiffnesses.extend(std::iter::repeat_n(zero, directions));
            shared.write_stiffnesses(base, place, all, &mut stiffnesses[from..])?;
        }
        shared.stiffnesses = stiffnesses;
        Ok(shared)
    }

    /// Angular speeds of an order at some speeds.
    #[inline(always)]
    fn rates(&self, place: usize) -> Lane {
        let (lane, order) = (place / self.amplitudes.len(), place % self.amplitudes.len());
        let order = self.loads.orders[order].number();
        self.omega[lane].map(|omega| omega * order)
    }

    fn words(&self, place: usize, l: usize) -> String {
        let (lane, order) = (place / self.amplitudes.len(), place % self.amplitudes.len());
        let rpm = self.request.rpm[(lane * LANES + l).min(self.request.rpm.len() - 1)];
        format!("order {} at {rpm} rpm", self.loads.orders[order])
    }

    fn write_stiffnesses(
        &self,
        powertrain: &Powertrain,
        place: usize,
        mounts: impl Iterator<Item = usize>,
        to: &mut [[Lane; 2]],
    ) -> Result<()> {
        let rates = self.rates(place);
        for k in mounts {
            let mount = &powertrain.mounts()[k];
            for l in 0..LANES {
                let along = mount.stiffness_at(rates[l], || self.words(place, l))?;
                for (axis, value) in along.iter().enumerate() {
                    to[3 * k + axis][0][l] = value.re;
                    to[3 * k + axis][1][l] = value.im;
                }
            }
        }
        Ok(())
    }

    /// Largest responses of a design.
    fn evaluate(
        &self,
        powertrain: &Powertrain,
        largest: &mut [[f64; 3]],
        rms: &mut [[f64; 3]],
        cancel: &Cancel,
    ) -> Result<()> {
        let lowest = self.loads.orders.iter().map(|order| order.number()).fold(f64::MAX, f64::min);
        let least = self.loads.omega.iter().copied().fold(f64::MAX, f64::min) * lowest;
        let equations = Equations::new(powertrain, least)?;
        let outputs = Outputs::new(powertrain, &equations, &self.request, least)?;
        let amplitudes: Vec<[ComplexVector6; 2]> =
            self.amplitudes.iter().map(|both| both.map(|load| equations.to * load)).collect();
        let (orders, quantities) = (amplitudes.len(), rms.len());
        // Squares of magnitudes at each speed of a lane.
        let zero = [[0.0; LANES]; 3];
        let mut most = memory::collected(std::iter::repeat_n(zero, orders * quantities))?;
        let mut sums = memory::collected(std::iter::repeat_n(zero, quantities))?;
        let mut rms_most = memory::collected(std::iter::repeat_n(zero, quantities))?;
        let directions = 3 * powertrain.mounts().len();
        let mut stiffnesses =
            memory::collected(std::iter::repeat_n([[0.0; LANES]; 2], directions))?;
        for lane in 0..self.omega.len() {
            cancel.check()?;
            sums.fill(zero);
            for order in 0..orders {
                let place = lane * orders + order;
                let shared = &self.stiffnesses[place * directions..(place + 1) * directions];
                if equations.is_factored() {
                    stiffnesses.copy_from_slice(shared);
                    let varied = self.varied.iter().copied();
                    self.write_stiffnesses(powertrain, place, varied, &mut stiffnesses)?;
                }
                let rates = self.rates(place);
                let squares = rates.map(|rate| rate * rate);
                let mut solution: Lanes6 = [[[0.0; LANES]; 6]; 2];
                let is_solved = vectorised(
                    #[inline(always)]
                    || {
                        let [by_square, fixed] = &amplitudes[order];
                        for k in 0..6 {
                            for l in 0..LANES {
                                let square = squares[l];
                                solution[0][k][l] = by_square[k].re.mul_add(square, fixed[k].re);
                                solution[1][k][l] = by_square[k].im.mul_add(square, fixed[k].im);
                            }
                        }
                        equations.solve(&squares, &stiffnesses, &mut solution)
                    },
                );
                if is_solved != [true; LANES] {
                    self.repair(powertrain, &equations, place, is_solved, &mut solution)?;
                }
                let most = &mut most[order * quantities..(order + 1) * quantities];
                vectorised(
                    #[inline(always)]
                    || outputs.add(&solution, &squares, &stiffnesses, most, &mut sums),
                );
            }
            for (most, sum) in rms_most.iter_mut().zip(&sums) {
                for (most, sum) in most.iter_mut().zip(sum) {
                    (0..LANES).for_each(|l| most[l] = most[l].max(sum[l]));
                }
            }
        }
        let root = |of: &[Lane; 3]| of.map(|lane| lane.into_iter().fold(0.0, f64::max).sqrt());
        for quantity in 0..quantities {
            for order in 0..orders {
                largest[quantity * orders + order] = root(&most[order * quantities + quantity]);
            }
            rms[quantity] = root(&rms_most[quantity]).map(|peak| peak / std::f64::consts::SQRT_2);
        }
        Ok(())
    }

    /// Solves what was left, with pivots.
    fn repair(
        &self,
        powertrain: &Powertrain,
        equations: &Equations,
        place: usize,
        is_solved: [bool; LANES],
        solution: &mut Lanes6,
    ) -> Result<()> {
        let rates = self.rates(place);
        let [by_square, fixed] = &self.amplitudes[place % self.amplitudes.len()];
        let mass = powertrain.body().mass_matrix().map(Complex64::from);
        for l in (0..LANES).filter(|&l| !is_solved[l]) {
            let omega = rates[l];
            let load = by_square * Complex64::from(omega * omega) + fixed;
            let solved = if load == ComplexVector6::zeros() {
                load
            } else {
                let stiffnesses = powertrain.stiffnesses(omega, || self.words(place, l))?;
                let motion = powertrain.motion(&stiffnesses, omega, &load).ok_or_else(|| {
                    let hint = format!(
                        "{} is at a mode without damping, and motion is unbounded; give mounts a \
                         loss_factor or damping, or another speed",
                        self.words(place, l)
                    );
                    Error::value("rpm", format!("{:.6} Hz", omega / TAU), hint)
                })?;
                equations.to * (mass * motion)
            };
            for k in 0..6 {
                (solution[0][k][l], solution[1][k][l]) = (solved[k].re, solved[k].im);
            }
        }
        Ok(())
    }
}

/// A vector along three axes as products with a solution.
type Rows = [[Complex64; 6]; 3];

/// Quantities of a design, as products with the solution of its equations.
struct Outputs {
    /// Constant stiffness: rows of the force of all, and of each mount that counts.
    forces: Vec<Rows>,
    /// Otherwise: deflection along its axes, and the axes, of each mount.
    deflections: Vec<(Rows, [[f64; 3]; 3])>,
    mount_forces: bool,
    /// Displacement of points.
    points: Vec<Rows>,
}

impl Outputs {
    fn new(
        powertrain: &Powertrain,
        equations: &Equations,
        request: &DesignRequest,
        omega: f64,
    ) -> Result<Self> {
        let rows_of = |motion: &Matrix3x6<Complex64>| {
            let product = motion * equations.from;
            [0, 1, 2].map(|i| [0, 1, 2, 3, 4, 5].map(|j| product[(i, j)]))
        };
        let cg = powertrain.body().cg();
        let moved = |place: &[f64; 3]| {
            let arm = nalgebra::Vector3::from(*place) - cg;
            rows_of(&motion_of_point(&arm).map(Complex64::from))
        };
        let points = request.points.iter().map(moved).collect();
        let mount_forces = request.mount_forces;
        let mut outputs =
            Self { forces: Vec::new(), deflections: Vec::new(), mount_forces, points };
        if equations.is_factored() {
            for (mount, deflection) in powertrain.mounts().iter().zip(powertrain.deflections()) {
                let axes = mount.axes();
                let axes = [0, 1, 2].map(|i| [0, 1, 2].map(|j| axes[(i, j)]));
                let rows = rows_of(&deflection.map(Complex64::from));
                outputs.deflections.push((rows, axes));
            }
            return Ok(outputs);
        }
        let stiffnesses = powertrain.stiffnesses(omega, String::new)?;
        let whole: ComplexMatrix6 = powertrain.assembled(&stiffnesses) * equations.from;
        let all = rows(&whole);
        outputs.forces.push([all[0], all[1], all[2]]);
        if mount_forces {
            for (k, deflection) in powertrain.deflections().iter().enumerate() {
                let along = nalgebra::Matrix3::from_diagonal(&stiffnesses[k].into());
                let axes = powertrain.mounts()[k].axes().transpose().map(Complex64::from);
                let force = axes * along * deflection.map(Complex64::from);
                outputs.forces.push(rows_of(&force));
            }
        }
        Ok(outputs)
    }

    /// Adds squares of the magnitudes of all quantities: the largest, and the sum over orders. Without closures
    /// for the reason in [`crate::mounts::equations`].
    #[inline(always)]
    fn add(
        &self,
        solution: &Lanes6,
        squares: &Lane,
        stiffnesses: &[[Lane; 2]],
        most: &mut [[Lane; 3]],
        sums: &mut [[Lane; 3]],
    ) {
        let one = [1.0; LANES];
        let mut quantity = 0;
        for rows in &self.forces {
            let vector = vector(rows, solution);
            take(&vector, &one, &mut most[quantity], &mut sums[quantity]);
            quantity += 1;
        }
        if !self.deflections.is_empty() {
            let mut sum = [[[0.0; LANES]; 2]; 3];
            for (mount, (rows, axes)) in self.deflections.iter().enumerate() {
                let moved = vector(rows, solution);
                let mut forces = [[[0.0; LANES]; 2]; 3];
                for axis in 0..3 {
                    let [k_re, k_im] = &stiffnesses[3 * mount + axis];
                    let [re, im] = &moved[axis];
                    for along in 0..3 {
                        let factor = axes[axis][along];
                        for l in 0..LANES {
                            let real = k_re[l].mul_add(re[l], -(k_im[l] * im[l]));
                            let imaginary = k_re[l].mul_add(im[l], k_im[l] * re[l]);
                            forces[along][0][l] = factor.mul_add(real, forces[along][0][l]);
                            forces[along][1][l] = factor.mul_add(imaginary, forces[along][1][l]);
                        }
                    }
                }
                for along in 0..3 {
                    for l in 0..LANES {
                        sum[along][0][l] += forces[along][0][l];
                        sum[along][1][l] += forces[along][1][l];
                    }
                }
                if self.mount_forces {
                    take(&forces, &one, &mut most[1 + mount], &mut sums[1 + mount]);
                }
            }
            take(&sum, &one, &mut most[0], &mut sums[0]);
            quantity = if self.mount_forces { 1 + self.deflections.len() } else { 1 };
        }
        for rows in &self.points {
            let moved = vector(rows, solution);
            take(&moved, squares, &mut most[quantity], &mut sums[quantity]);
            quantity += 1;
        }
    }
}

/// Three components of a quantity.
#[inline(always)]
fn vector(rows: &[[Complex64; 6]; 3], solution: &Lanes6) -> [[Lane; 2]; 3] {
    [product(&rows[0], solution), product(&rows[1], solution), product(&rows[2], solution)]
}

/// Adds squares of magnitudes times a factor.
#[inline(always)]
fn take(vector: &[[Lane; 2]; 3], factor: &Lane, most: &mut [Lane; 3], sums: &mut [Lane; 3]) {
    for axis in 0..3 {
        let [re, im] = &vector[axis];
        for l in 0..LANES {
            let square = re[l].mul_add(re[l], im[l] * im[l]) * factor[l];
            most[axis][l] = if square > most[axis][l] { square } else { most[axis][l] };
            sums[axis][l] += square;
        }
    }
}

#[cfg(test)]
mod tests;
