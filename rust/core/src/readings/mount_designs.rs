//! An engine on many designs of its mounts: natural frequencies, and the largest responses over speed.

#![allow(clippy::needless_range_loop, reason = "several arrays are indexed in step")]

use std::f64::consts::TAU;

use nalgebra::{Matrix3x6, RowVector6, Vector3};
use pulp::{Simd, WithSimd};

use crate::Complex64;
use crate::engine::Engine;
use crate::mounts::equations::{
    Equations, LANES, Lane, Lanes6, Numbers, damped_product, flags, product, read, real_product,
    write,
};
use crate::mounts::{ComplexVector6, Mount, NaturalModes, Powertrain, motion_of_point, natural_at};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::pool;
use crate::numbers::simd::{vector, vector_mut};
use crate::readings::balance::{ErrorBounds, Orders};
use crate::readings::mounted::EngineLoads;

/// Designs computed between two checks whether another thread is idle.
const DESIGNS_PER_TASK: usize = 8;

/// A figure of a mount that differs between designs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MountFigure {
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
    pub figure: MountFigure,
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
pub struct DesignResponses {
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

/// Loads and stiffness at speeds and orders, which all designs share. A place is an order at the speeds of a lane,
/// the last speed again where there are fewer.
struct Shared<'a> {
    request: DesignRequest<'a>,
    loads: EngineLoads,
    /// Lanes of speeds.
    lanes: usize,
    /// Load of each order over (nω)², and that of gas pressure.
    amplitudes: Vec<[ComplexVector6; 2]>,
    /// nω at each place.
    rates: Vec<Lane>,
    /// Mounts whose stiffness depends on frequency otherwise than by viscous damping.
    varying: Vec<usize>,
    /// Stiffness of each of their directions at each place, as it is without variations.
    stiffnesses: Vec<[Lane; 2]>,
    /// Which of them differ between designs.
    varied: Vec<usize>,
}

/// Evaluate the designs of a powertrain that variations make.
pub fn design_responses<'a>(
    engine: impl Into<Option<&'a Engine>>,
    base: &Powertrain,
    variations: &[Variation],
    request: &DesignRequest,
    cancel: &Cancel,
) -> Result<DesignResponses> {
    base.require_ground()?;
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
    let shared = Shared::new(engine.into(), base, variations, request, cancel)?;
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
            let natural = natural_at(&powertrain, request.frequency).map_err(of)?;
            if let Some(natural) = &natural {
                *frequency = natural.frequency();
            }
            let rms = &mut rms[k * quantities..(k + 1) * quantities];
            let largest = &mut largest[k * quantities * orders..(k + 1) * quantities * orders];
            shared.evaluate(&powertrain, natural.as_ref(), largest, rms, cancel).map_err(of)?;
        }
        Ok(())
    })?;
    let EngineLoads { orders, omitted, error_bound, .. } = shared.loads;
    Ok(DesignResponses { orders, omitted, error_bound, frequency, largest, rms, quantities })
}

/// A design.
fn varied(base: &Powertrain, variations: &[Variation], design: usize) -> Result<Powertrain> {
    let mut mounts = base.mounts().to_vec();
    for variation in variations {
        let mut figures = mounts[variation.mount].figures().clone();
        let value = variation.values[design];
        match variation.figure {
            MountFigure::At => figures.at = value,
            MountFigure::Tilt => (figures.tilt_deg, figures.axes) = (value[0], None),
            MountFigure::Stiffness => figures.stiffness = value,
            MountFigure::DynamicStiffness => figures.dynamic_stiffness = Some(value),
            MountFigure::LossFactor => figures.loss_factor = value,
            MountFigure::Damping => figures.damping = value,
        }
        let name = figures.name.clone();
        mounts[variation.mount] =
            Mount::new(figures).map_err(|error| error.within(&format!("mount {name:?}: ")))?;
    }
    Powertrain::resting(*base.body(), mounts, *base.rest())
}

impl<'a> Shared<'a> {
    fn new(
        engine: Option<&Engine>,
        base: &Powertrain,
        variations: &[Variation],
        request: &DesignRequest<'a>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let loads = EngineLoads::new(engine, base, request.rpm, request.orders, cancel)?;
        let (amplitudes, speeds) = (loads.amplitudes()?, &loads.omega);
        let (lanes, orders) = (speeds.len().div_ceil(LANES), amplitudes.len());
        let is_varying = |&k: &usize| base.mounts()[k].dynamic().constant().is_none();
        let varying: Vec<usize> = (0..base.mounts().len()).filter(is_varying).collect();
        // Which snubbers act at rest differs with any mount.
        let is_varied =
            |&k: &usize| base.is_snubbed() || variations.iter().any(|one| one.mount == varying[k]);
        let varied = (0..varying.len()).filter(is_varied).collect();
        let lengths = [lanes * orders, 1 + 6 * varying.len(), LANES];
        limits::result_size("designs", &lengths, size_of::<f64>(), "give fewer speeds or orders")?;
        let mut rates = memory::with_capacity(lanes * orders)?;
        for few in speeds.chunks(LANES) {
            let omega: Lane = std::array::from_fn(|l| few[l.min(few.len() - 1)]);
            rates.extend(loads.orders.iter().map(|order| omega.map(|one| one * order.number())));
        }
        let (request, stiffnesses) = (*request, Vec::new());
        let mut shared =
            Self { request, loads, lanes, amplitudes, rates, varying, stiffnesses, varied };
        let directions = 3 * shared.varying.len();
        let mut stiffnesses = memory::with_capacity(shared.rates.len() * directions)?;
        for place in 0..shared.rates.len() {
            cancel.check()?;
            let from = stiffnesses.len();
            stiffnesses.extend(std::iter::repeat_n([[0.0; LANES]; 2], directions));
            let all = 0..shared.varying.len();
            shared.write_stiffnesses(base, place, all, &mut stiffnesses[from..])?;
        }
        shared.stiffnesses = stiffnesses;
        Ok(shared)
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
        for k in mounts {
            let mount = &powertrain.mounts()[self.varying[k]];
            for l in 0..LANES {
                let along = mount.stiffness_at(self.rates[place][l], || self.words(place, l))?;
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
        natural: Option<&NaturalModes>,
        largest: &mut [[f64; 3]],
        rms: &mut [[f64; 3]],
        cancel: &Cancel,
    ) -> Result<()> {
        let lowest = self.loads.orders.iter().map(|order| order.number()).fold(f64::MAX, f64::min);
        let least = self.loads.omega.iter().copied().fold(f64::MAX, f64::min) * lowest;
        let equations = Equations::new(powertrain, least, natural)?;
        let outputs = Outputs::new(powertrain, &equations, &self.request);
        let amplitudes: Vec<[[f64; 6]; 4]> = self
            .amplitudes
            .iter()
            .map(|both| {
                let zero = ComplexVector6::zeros();
                let [by_square, fixed] =
                    both.map(|load| if load == zero { zero } else { equations.to * load });
                [
                    by_square.map(|p| p.re),
                    by_square.map(|p| p.im),
                    fixed.map(|p| p.re),
                    fixed.map(|p| p.im),
                ]
                .map(Into::into)
            })
            .collect();
        let (orders, quantities) = (amplitudes.len(), rms.len());
        // Squares of magnitudes at each speed of a lane.
        let zero = [[0.0; LANES]; 3];
        let mut most = memory::collected(std::iter::repeat_n(zero, orders * quantities))?;
        let mut rms_most = memory::collected(std::iter::repeat_n(zero, quantities))?;
        pulp::Arch::new().dispatch(Evaluation {
            shared: self,
            powertrain,
            equations: &equations,
            outputs: &outputs,
            amplitudes: &amplitudes,
            most: &mut most,
            rms_most: &mut rms_most,
            cancel,
        })?;
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
        let [by_square, fixed] = &self.amplitudes[place % self.amplitudes.len()];
        let mass = powertrain.body().mass_matrix().map(Complex64::from);
        for l in (0..LANES).filter(|&l| !is_solved[l]) {
            let omega = self.rates[place][l];
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

/// A design over all speeds and orders.
struct Evaluation<'a> {
    shared: &'a Shared<'a>,
    powertrain: &'a Powertrain,
    equations: &'a Equations,
    outputs: &'a Outputs,
    /// Real and imaginary part of each order's load over (nω)², and of that of gas pressure.
    amplitudes: &'a [[[f64; 6]; 4]],
    /// Largest squares of each order and quantity.
    most: &'a mut [[Lane; 3]],
    /// Largest sums of squares over orders, of each quantity.
    rms_most: &'a mut [[Lane; 3]],
    cancel: &'a Cancel,
}

impl WithSimd for Evaluation<'_> {
    type Output = Result<()>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Result<()> {
        let Self { shared, powertrain, equations, outputs, amplitudes, most, .. } = self;
        let (orders, quantities) = (amplitudes.len(), self.rms_most.len());
        let zero = [[0.0; LANES]; 3];
        let mut sums = memory::collected(std::iter::repeat_n(zero, quantities))?;
        let directions = 3 * shared.varying.len();
        let mut stiffnesses =
            memory::collected(std::iter::repeat_n([[0.0; LANES]; 2], directions))?;
        for lane in 0..shared.lanes {
            self.cancel.check()?;
            sums.fill(zero);
            for order in 0..orders {
                // Without a load nothing moves, and what was written for it is zero.
                if amplitudes[order] == [[0.0; 6]; 4] {
                    continue;
                }
                let place = lane * orders + order;
                if directions > 0 {
                    let from = place * directions;
                    stiffnesses.copy_from_slice(&shared.stiffnesses[from..from + directions]);
                    let varied = shared.varied.iter().copied();
                    shared.write_stiffnesses(powertrain, place, varied, &mut stiffnesses)?;
                }
                let most = &mut most[order * quantities..(order + 1) * quantities];
                for at in 0..LANES / S::F64_LANES {
                    let rates = vector::<S>(&shared.rates[place], at);
                    let mut solution = loaded(simd, &amplitudes[order], rates);
                    let mask = equations.solve(simd, rates, (&stiffnesses, at), &mut solution);
                    let solved = flags(simd, mask);
                    if simd.reduce_min_f64s(solved) < 1.0 {
                        let mut is_solved = [1.0; LANES];
                        *vector_mut::<S>(&mut is_solved, at) = solved;
                        let is_solved = is_solved.map(|flag| flag > 0.0);
                        let mut lanes: Lanes6 = [[[0.0; LANES]; 6]; 2];
                        write(&solution, at, &mut lanes);
                        shared.repair(powertrain, equations, place, is_solved, &mut lanes)?;
                        read(&lanes, at, &mut solution);
                    }
                    outputs.add(simd, &solution, rates, (&stiffnesses, at), most, &mut sums);
                }
            }
            for (most, sum) in self.rms_most.iter_mut().zip(&sums) {
                for (most, sum) in most.as_flattened_mut().iter_mut().zip(sum.as_flattened()) {
                    *most = most.max(*sum);
                }
            }
        }
        Ok(())
    }
}

/// Load of an order at speeds.
#[inline(always)]
fn loaded<S: Simd>(simd: S, of: &[[f64; 6]; 4], rates: S::f64s) -> [Numbers<S>; 6] {
    let square = simd.mul_f64s(rates, rates);
    let mut load = [Numbers::zero(simd); 6];
    for k in 0..6 {
        let [p_re, p_im, q_re, q_im] = [of[0][k], of[1][k], of[2][k], of[3][k]];
        load[k] = Numbers {
            re: simd.mul_add_f64s(simd.splat_f64s(p_re), square, simd.splat_f64s(q_re)),
            im: simd.mul_add_f64s(simd.splat_f64s(p_im), square, simd.splat_f64s(q_im)),
        };
    }
    load
}

/// A vector along three axes as products with a solution.
type VectorRows = [[Complex64; 6]; 3];

/// A force as products with the solution of a design's equations.
struct ForceRows {
    /// By stiffness that does not depend on frequency.
    constant: VectorRows,
    /// By viscous damping, over iω.
    viscous: Option<[[f64; 6]; 3]>,
    /// Of each direction of the mounts that depend on frequency otherwise: its index, its axis, and the deflection
    /// along it.
    varying: Vec<(usize, [f64; 3], [f64; 6])>,
}

/// Quantities of a design, as products with the solution of its equations.
struct Outputs {
    /// Force of all mounts, and of each that counts.
    forces: Vec<ForceRows>,
    /// Displacement of points.
    points: Vec<VectorRows>,
}

fn rows(matrix: &Matrix3x6<Complex64>) -> VectorRows {
    [0, 1, 2].map(|i| [0, 1, 2, 3, 4, 5].map(|j| matrix[(i, j)]))
}

impl ForceRows {
    /// Force of some mounts, with the index of the first direction of each that depends on frequency.
    fn of(
        powertrain: &Powertrain,
        equations: &Equations,
        mounts: impl Iterator<Item = (usize, usize)>,
    ) -> Self {
        let mut constant = Matrix3x6::zeros();
        let (mut viscous, mut varying) = (Matrix3x6::zeros(), Vec::new());
        let unit = equations.from.map(|part| part.re);
        for (k, first) in mounts {
            let (mount, deflection) = (&powertrain.mounts()[k], &powertrain.deflections()[k]);
            let force =
                |axis: usize, row: &RowVector6<f64>| mount.axes().row(axis).transpose() * row;
            let constant_of = mount.dynamic().constant();
            for axis in 0..3 {
                let row: RowVector6<f64> = deflection.row(axis).into();
                let Some((stiffness, damping)) = constant_of else {
                    let direction: Vector3<f64> = mount.axes().row(axis).transpose();
                    let row: [f64; 6] = (row * unit).transpose().into();
                    varying.push((first + axis, direction.into(), row));
                    continue;
                };
                constant += force(axis, &row).map(Complex64::from) * stiffness[axis];
                viscous += force(axis, &row) * damping[axis];
            }
        }
        let constant = rows(&(constant * equations.from));
        let viscous = (viscous.amax() > 0.0).then(|| {
            let viscous = viscous * unit;
            [0, 1, 2].map(|i| [0, 1, 2, 3, 4, 5].map(|j| viscous[(i, j)]))
        });
        Self { constant, viscous, varying }
    }

    #[inline(always)]
    fn times<S: Simd>(
        &self,
        simd: S,
        solution: &[Numbers<S>; 6],
        rates: S::f64s,
        (stiffnesses, at): (&[[Lane; 2]], usize),
    ) -> [Numbers<S>; 3] {
        let mut force = [Numbers::zero(simd); 3];
        for axis in 0..3 {
            let row = &self.constant[axis];
            force[axis] = match &self.viscous {
                None => product(simd, row, solution),
                Some(viscous) => damped_product(simd, row, &viscous[axis], rates, solution),
            };
        }
        for k in 0..self.varying.len() {
            let (direction, axis, row) = &self.varying[k];
            let [re, im] = &stiffnesses[*direction];
            let stiffness = Numbers { re: vector::<S>(re, at), im: vector::<S>(im, at) };
            let along =
                Numbers::zero(simd).plus(simd, stiffness, real_product(simd, row, solution));
            for axis_of_engine in 0..3 {
                let factor = simd.splat_f64s(axis[axis_of_engine]);
                force[axis_of_engine] = force[axis_of_engine].plus_real(simd, factor, along);
            }
        }
        force
    }
}

impl Outputs {
    fn new(powertrain: &Powertrain, equations: &Equations, request: &DesignRequest) -> Self {
        let cg = powertrain.body().cg();
        let moved = |place: &[f64; 3]| {
            let motion = motion_of_point(&(Vector3::from(*place) - cg));
            rows(&(motion.map(Complex64::from) * equations.from))
        };
        let points = request.points.iter().map(moved).collect();
        let mut first = 0;
        let mounts: Vec<(usize, usize)> = powertrain
            .mounts()
            .iter()
            .enumerate()
            .map(|(k, mount)| {
                let own = first;
                first += if mount.dynamic().constant().is_none() { 3 } else { 0 };
                (k, own)
            })
            .collect();
        let mut forces = vec![ForceRows::of(powertrain, equations, mounts.iter().copied())];
        if request.mount_forces {
            let each = mounts.iter().map(|&one| std::iter::once(one));
            forces.extend(each.map(|one| ForceRows::of(powertrain, equations, one)));
        }
        Self { forces, points }
    }

    /// Adds squares of the magnitudes of all quantities: the largest, and the sum over orders.
    #[inline(always)]
    fn add<S: Simd>(
        &self,
        simd: S,
        solution: &[Numbers<S>; 6],
        rates: S::f64s,
        (stiffnesses, at): (&[[Lane; 2]], usize),
        most: &mut [[Lane; 3]],
        sums: &mut [[Lane; 3]],
    ) {
        let one = simd.splat_f64s(1.0);
        for k in 0..self.forces.len() {
            let force = self.forces[k].times(simd, solution, rates, (stiffnesses, at));
            take(simd, &force, one, at, [&mut most[k], &mut sums[k]]);
        }
        for k in 0..self.points.len() {
            let mut moved = [Numbers::zero(simd); 3];
            for axis in 0..3 {
                moved[axis] = product(simd, &self.points[k][axis], solution);
            }
            let quantity = self.forces.len() + k;
            take(simd, &moved, rates, at, [&mut most[quantity], &mut sums[quantity]]);
        }
    }
}

/// Adds squares of magnitudes times a rate.
#[inline(always)]
fn take<S: Simd>(
    simd: S,
    vectors: &[Numbers<S>; 3],
    rates: S::f64s,
    at: usize,
    [most, sums]: [&mut [Lane; 3]; 2],
) {
    let rates = simd.mul_f64s(rates, rates);
    for axis in 0..3 {
        let square = simd.mul_f64s(vectors[axis].squares(simd), rates);
        let largest = vector_mut::<S>(&mut most[axis], at);
        *largest = simd.max_f64s(*largest, square);
        let sum = vector_mut::<S>(&mut sums[axis], at);
        *sum = simd.add_f64s(*sum, square);
    }
}

#[cfg(test)]
mod tests;
