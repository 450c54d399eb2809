//! Sweeps over engines, bank angle, rod ratio, pin offset and speed, without a sample of θ.
//!
//! One point of a sweep is a product: ω², the harmonic aₙ(λ, e) and a layout sum. With the two
//! banks at `bisector ∓ γ` (γ half the bank angle) and the bank sums right ± left, the layout sum
//! along (about) each axis is four functions of γ times four complex constants of the engine: with
//! pins held, bores turn a cylinder's direction and its phase together,
//! `Σ e^{±i·bank} e^{−in(bank − pin)}`, and the functions are cosine and sine of (n ∓ 1)γ; with the
//! firing held they are cosine and sine of γ. The four are worked out once for all engines.

mod block;
mod choice;
mod harmonics;
mod plan;
mod run;
mod waveform;

use std::sync::Arc;

use ndarray::{Array, IxDyn};

use self::block::Block;
use self::harmonics::proportions;
use self::plan::Plan;
use self::run::Run;
use crate::Complex64;
use crate::balance::{angular_speed, snapped};
use crate::cancel::Cancel;
use crate::engine::{Engine, Hold, bank_angle_in_range};
use crate::error::{Error, Result};
use crate::extrema::PeakFinder;
use crate::limits;
use crate::spectrum::Spectrum;

/// What is swept; `None` leaves what each engine has.
#[derive(Debug, Clone)]
pub struct Axes {
    /// Degrees between the banks, and what is held as they change.
    pub bank_angle: Option<(Vec<f64>, Hold)>,
    /// λ; the crank radius stays and the rod changes.
    pub rod_ratio: Option<Vec<f64>>,
    /// Pin offset of every cylinder, m.
    pub pin_offset: Option<Vec<f64>>,
    /// Speeds.
    pub rpm: Vec<f64>,
}

/// What is asked of each point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Shaking force along x and y.
    Force,
    /// Rocking moment about x and y.
    Moment,
    /// Roll torque on the block.
    Torque,
}

/// Engines and axes, checked; values are worked out when they are asked for.
#[derive(Debug)]
pub struct Sweep {
    engines: Vec<Arc<Engine>>,
    axes: Axes,
    orders: Vec<u32>,
    references: Vec<f64>,
    spectrum: Option<Spectrum>,
    /// ω² of each speed.
    squares: Vec<f64>,
    /// Whether torque is wanted.
    torque: bool,
    omitted: Vec<u32>,
    error_bound: [f64; 3],
}

/// Axes: engine, bank angle, rod ratio, pin offset, speed; then orders and components, if any.
pub type Values<T> = Array<T, IxDyn>;

impl Sweep {
    /// Check everything that can be wrong.
    pub fn new(
        engines: Vec<Arc<Engine>>,
        axes: Axes,
        orders: Vec<u32>,
        reference_z: Option<f64>,
        spectrum: Option<Spectrum>,
    ) -> Result<Self> {
        limits::orders(&orders)?;
        not_empty("engines", engines.len())?;
        not_empty("rpm", axes.rpm.len())?;
        let squares = axes.rpm.iter().map(|&rpm| angular_speed(rpm).map(|omega| omega * omega));
        let squares = squares.collect::<Result<_>>()?;
        if let Some((angles, _)) = &axes.bank_angle {
            not_empty("bank_angle_deg", angles.len())?;
            // Counted before they are looked at one by one, which takes longer.
            if angles.iter().filter(|angle| !(0.0..=180.0).contains(*angle)).count() > 0 {
                angles.iter().try_for_each(|&angle| bank_angle_in_range(angle).map(drop))?;
            }
            engines.iter().try_for_each(|engine| engine.banks().map(drop))?;
        }
        for (name, values) in [("rod_ratio", &axes.rod_ratio), ("pin_offset", &axes.pin_offset)] {
            let Some(values) = values else { continue };
            not_empty(name, values.len())?;
            if spectrum.is_some() {
                let cure = "a spectrum stands in for the slider-crank: leave out one of the two";
                return Err(Error::value(name, "swept together with a spectrum", cure));
            }
        }
        let references = engines.iter().map(|engine| engine.reference(reference_z));
        let references = references.collect::<Result<_>>()?;
        let replaced = axes.rod_ratio.is_some() || axes.pin_offset.is_some();
        let sweep = Self {
            engines,
            axes,
            orders,
            references,
            spectrum,
            squares,
            torque: true,
            omitted: Vec::new(),
            error_bound: [0.0; 3],
        };
        if replaced {
            sweep.check_geometry()?;
        }
        Ok(sweep)
    }

    /// Lengths of the axes engine, bank angle, rod ratio, pin offset, speed.
    #[must_use]
    pub fn shape(&self) -> [usize; 5] {
        let length = |values: &Option<Vec<f64>>| values.as_ref().map_or(1, Vec::len);
        [
            self.engines.len(),
            self.axes.bank_angle.as_ref().map_or(1, |(angles, _)| angles.len()),
            length(&self.axes.rod_ratio),
            length(&self.axes.pin_offset),
            self.squares.len(),
        ]
    }

    /// Largest mean piston speed of any cylinder at any speed, m/s.
    #[must_use]
    pub fn mean_piston_speed(&self) -> f64 {
        let radius = self.engines.iter().map(|e| e.largest_crank_radius()).fold(0.0, f64::max);
        let square = self.squares.iter().copied().fold(0.0, f64::max);
        // Four radii a turn.
        4.0 * radius * square.sqrt() / std::f64::consts::TAU
    }

    /// Multiples of crank speed.
    #[must_use]
    pub fn orders(&self) -> &[u32] {
        &self.orders
    }

    /// Orders that were looked at and left out, of those that are not zero everywhere.
    #[must_use]
    pub fn omitted(&self) -> &[u32] {
        &self.omitted
    }

    /// What orders left out can add to force, moment and torque at any crank angle of any point.
    #[must_use]
    pub fn error_bound(&self) -> [f64; 3] {
        self.error_bound
    }

    /// The same, and no torque can be asked of it.
    #[must_use]
    pub fn without_torque(self) -> Self {
        Self { torque: false, ..self }
    }

    /// What is swept.
    #[must_use]
    pub fn axes(&self) -> &Axes {
        &self.axes
    }

    /// Peak phasors of each order: (…, `n_orders`, and 2 but for torque).
    pub fn phasors(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<Complex64>> {
        let components = quantity.components();
        self.fill(quantity, &self.by_order(quantity), cancel, |block, out| {
            block.evaluate();
            for (i, row) in out.chunks_exact_mut(self.orders.len() * components).enumerate() {
                for (order, phasors) in row.chunks_exact_mut(components).enumerate() {
                    phasors.copy_from_slice(&block.phasors(order, i)[..components]);
                }
            }
        })
    }

    /// max over θ of each order along (about) each axis: (…, `n_orders`, and 2 but for torque).
    pub fn peaks(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<f64>> {
        let tail = self.by_order(quantity);
        self.fill(
            quantity,
            &tail,
            cancel,
            #[inline(always)]
            |block, out| block.peaks(out),
        )
    }

    /// max over θ of the length of each order's vector: (…, `n_orders`).
    pub fn vector_peaks(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<f64>> {
        let orders = self.orders.len();
        self.fill(quantity, &[orders], cancel, |block, out| {
            block.evaluate();
            for (i, row) in out.chunks_exact_mut(orders).enumerate() {
                for (order, length) in row.iter_mut().enumerate() {
                    let bound = block.bounds[order];
                    let [forward, backward] = block.turning(order, i);
                    *length = snapped(forward, bound).norm() + snapped(backward, bound).norm();
                }
            }
        })
    }

    /// max over θ of the sum of orders along (about) each axis: (…, and 2 but for torque).
    pub fn sum_peaks(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<f64>> {
        let components = quantity.components();
        let finder = PeakFinder::new(&self.orders);
        self.fill(quantity, quantity.shape(), cancel, |block, out| {
            block.evaluate();
            for (i, row) in out.chunks_exact_mut(components).enumerate() {
                for (peak, phasors) in row.iter_mut().zip(block.by_component(i)) {
                    *peak = finder.along_axis(&phasors);
                }
            }
        })
    }

    /// max over θ of the length of the sum of orders: (…).
    pub fn sum_vector_peaks(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<f64>> {
        let finder = PeakFinder::new(&self.orders);
        self.fill(quantity, &[], cancel, |block, out| {
            block.evaluate();
            for (i, peak) in out.iter_mut().enumerate() {
                let [x, y] = block.by_component(i);
                *peak = finder.of_vector(&x, &y);
            }
        })
    }

    /// Torque may not have been asked for.
    fn check_asked(&self, quantity: Quantity) -> Result<()> {
        if quantity == Quantity::Torque && !self.torque {
            return Err(Error::value("torque", "False", "it was not asked for; give torque=True"));
        }
        Ok(())
    }

    /// Trailing axes of a result that has all orders.
    fn by_order(&self, quantity: Quantity) -> Vec<usize> {
        [&[self.orders.len()], quantity.shape()].concat()
    }

    /// Work out every point: layout sums block by block, handed to `finish`, times ω².
    fn fill<T>(
        &self,
        quantity: Quantity,
        tail: &[usize],
        cancel: &Cancel,
        finish: impl Fn(&mut Block, &mut [T]) + Sync,
    ) -> Result<Values<T>>
    where
        T: Copy + Default + Send + Sync + std::ops::Mul<f64, Output = T>,
    {
        self.check_asked(quantity)?;
        let shape = [&self.shape()[..], tail].concat();
        let cure = "sweep one axis in parts";
        limits::result_size("sweep", &shape, size_of::<T>(), cure)?;
        let plan = Plan::new(self, quantity, cancel)?;
        let mut values = vec![T::default(); shape.iter().product()];
        let [_, angles, ratios, offsets, _] = self.shape();
        let width: usize = tail.iter().product();
        let run = Run::new(&plan, &self.squares, ratios * offsets, width, cancel);
        if angles > 1 {
            run.over_bank_angles(self.bank_angles(), &mut values, &finish)?;
        } else {
            run.over_other_axes(self.bank_angles(), &mut values, &finish)?;
        }
        Array::from_shape_vec(IxDyn(&shape), values)
            .map_err(|error| Error::value("sweep", format!("{shape:?}"), error.to_string()))
    }

    fn bank_angles(&self) -> &[f64] {
        self.axes.bank_angle.as_ref().map_or(&[0.0], |(angles, _)| angles)
    }

    /// Every slider-crank of the sweep can turn: it is enough to look at the largest values.
    fn check_geometry(&self) -> Result<()> {
        let ends = |values: &Option<Vec<f64>>| -> Vec<Option<f64>> {
            values.as_ref().map_or(vec![None], |values| values.iter().copied().map(Some).collect())
        };
        let (ratios, offsets) = (ends(&self.axes.rod_ratio), ends(&self.axes.pin_offset));
        let size = offsets.iter().flatten().fold(None, |largest: Option<f64>, &offset| {
            // NaN is kept, so that it is found below.
            Some(largest.map_or(offset, |l| if l.abs() >= offset.abs() { l } else { offset }))
        });
        for cylinder in self.engines.iter().flat_map(|e| e.placements()).map(|p| p.cylinder) {
            for &ratio in &ratios {
                proportions(&cylinder, ratio, size)?;
            }
            for &offset in &offsets {
                proportions(&cylinder, ratios[0], offset)?;
            }
        }
        Ok(())
    }
}

impl Quantity {
    /// Axes of one value: x and y, or none for what is about z alone.
    fn shape(self) -> &'static [usize] {
        if self == Self::Torque { &[] } else { &[2] }
    }

    /// How many components one value has.
    fn components(self) -> usize {
        self.shape().iter().product()
    }
}

fn not_empty(argument: &str, length: usize) -> Result<()> {
    if length > 0 {
        return Ok(());
    }
    Err(Error::value(argument, "[]", "give at least one value"))
}
