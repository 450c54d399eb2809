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
mod placed;
mod plan;
mod run;
mod tiles;
mod waveform;

use std::mem;
use std::sync::Arc;

use ndarray::{Array, IxDyn};

use self::block::Block;
use self::harmonics::proportions;
use self::plan::Plan;
use self::run::{Cost, Number, Run};
use crate::Complex64;
use crate::balance::{angular_speed, snapped};
use crate::cancel::{Cancel, give_back};
use crate::engine::{Engine, Hold, bank_angle_in_range};
use crate::error::{Error, Result};
use crate::extrema::PeakFinder;
use crate::harmonics::LITTLE_SLACK;
use crate::limits;
use crate::slider_crank::{Cylinder, slack};
use crate::spectrum::Spectrum;

/// What is swept; `None` leaves what each engine has.
#[derive(Debug, Clone, Default)]
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
    /// Torque on the crank.
    CrankTorque,
}

/// Which figure of force, moment or torque over the turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Figure {
    /// Of each order along (about) each axis: (…, `n_orders`, and 2 but for torque).
    Amplitude,
    /// The longest vector of each order: (…, `n_orders`).
    Length,
    /// Of all orders together along (about) each axis: (…, and 2 but for torque).
    Sum,
    /// The longest vector of all orders together: (…).
    LengthOfSum,
}

/// Engines and axes, checked; values are worked out when they are asked for.
#[derive(Debug)]
pub struct Sweep {
    engines: Vec<Arc<Engine>>,
    axes: Axes,
    orders: Vec<u32>,
    references: Vec<f64>,
    spectrum: Option<Spectrum>,
    /// The largest rod ratio, and the offset of largest magnitude, where they are swept.
    extremes: [Option<f64>; 2],
    /// ω² of each speed.
    squares: Vec<f64>,
    /// Whether torque is wanted.
    torque: bool,
    omitted: Vec<u32>,
    error_bound: [f64; 3],
}

/// Values of an axis between two looks at cancellation.
const PART: usize = 1 << 16;

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
        cancel: &Cancel,
    ) -> Result<Self> {
        limits::orders(&orders)?;
        not_empty("engines", engines.len())?;
        not_empty("rpm", axes.rpm.len())?;
        let mut squares = Vec::with_capacity(axes.rpm.len());
        for part in axes.rpm.chunks(PART) {
            cancel.check()?;
            for &rpm in part {
                squares.push(angular_speed(rpm).map(|omega| omega * omega)?);
            }
        }
        if let Some((angles, _)) = &axes.bank_angle {
            not_empty("bank_angle_deg", angles.len())?;
            for part in angles.chunks(PART) {
                cancel.check()?;
                // Counted before they are looked at one by one, which takes longer.
                if part.iter().filter(|angle| !(0.0..=180.0).contains(*angle)).count() > 0 {
                    part.iter().try_for_each(|&angle| bank_angle_in_range(angle).map(drop))?;
                }
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
        let mut sweep = Self {
            engines,
            axes,
            orders,
            references,
            spectrum,
            extremes: [None; 2],
            squares,
            torque: true,
            omitted: Vec::new(),
            error_bound: [0.0; 3],
        };
        if replaced {
            sweep.extremes = sweep.check_geometry(cancel)?;
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

    /// About how many steps of some nanoseconds a result takes at most.
    #[must_use]
    pub fn steps(&self, figure: Figure) -> usize {
        /// A true peak of a sum of orders, in steps for each.
        const PEAK: usize = 100;
        let each = match figure {
            Figure::Amplitude | Figure::Length => 2,
            Figure::Sum | Figure::LengthOfSum => PEAK,
        };
        let orders = self.orders.len();
        let sums = self.shape().iter().fold(each * orders, |size, &n| size.saturating_mul(n));
        let [ratio, offset] = self.extremes;
        let slack_of = |cylinder: &Cylinder| {
            let radius = cylinder.crank_radius();
            let rod = ratio.map_or(cylinder.rod_length() / radius, |ratio| 1.0 / ratio);
            slack(rod, offset.unwrap_or(cylinder.pin_offset()) / radius)
        };
        let cylinders = self.engines.iter().flat_map(|engine| engine.placements());
        let least = cylinders.map(|p| slack_of(&p.cylinder)).fold(f64::INFINITY, f64::min);
        if least >= LITTLE_SLACK {
            return sums;
        }
        let points = self.engines.len().saturating_mul(self.points());
        sums.saturating_add(crate::harmonics::steps(least, orders.saturating_mul(points)))
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
    pub fn without_torque(mut self) -> Self {
        self.torque = false;
        self
    }

    /// What is swept.
    #[must_use]
    pub fn axes(&self) -> &Axes {
        &self.axes
    }

    /// Lengths of all axes of a result.
    #[must_use]
    pub fn result_shape(&self, quantity: Quantity, figure: Figure) -> Vec<usize> {
        let orders = &[self.orders.len()][..];
        let tail: [&[usize]; 2] = match figure {
            Figure::Amplitude => [orders, quantity.shape()],
            Figure::Length => [orders, &[]],
            Figure::Sum => [&[], quantity.shape()],
            Figure::LengthOfSum => [&[], &[]],
        };
        [&self.shape()[..], &tail.concat()].concat()
    }

    /// A result of numbers of this many bytes is not too large for one call.
    pub fn check_size(&self, quantity: Quantity, figure: Figure, bytes: usize) -> Result<()> {
        let cure = "sweep one axis in parts, or give chunks";
        limits::result_size("sweep", &self.result_shape(quantity, figure), bytes, cure)
    }

    /// Peak phasors of each order: (…, `n_orders`, and 2 but for torque).
    pub fn phasors(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<Complex64>> {
        self.allocated(quantity, Figure::Amplitude, |out| self.write_phasors(quantity, out, cancel))
    }

    /// A figure of every point.
    pub fn peaks(
        &self,
        quantity: Quantity,
        figure: Figure,
        cancel: &Cancel,
    ) -> Result<Values<f64>> {
        self.allocated(quantity, figure, |out| self.write_peaks(quantity, figure, out, cancel))
    }

    /// [`Self::phasors`] into memory that is there, as long as the product of
    /// [`Self::result_shape`].
    pub fn write_phasors(
        &self,
        quantity: Quantity,
        out: &mut [Complex64],
        cancel: &Cancel,
    ) -> Result<()> {
        self.write_phasors_of(quantity, Cost::Small, out, cancel)
    }

    fn write_phasors_of(
        &self,
        quantity: Quantity,
        cost: Cost,
        out: &mut [Complex64],
        cancel: &Cancel,
    ) -> Result<()> {
        let width = self.orders.len() * quantity.components();
        self.fill(
            (quantity, Figure::Amplitude, cost),
            out,
            cancel,
            #[inline(always)]
            |block: &mut Block, factor: f64, out: &mut [Complex64]| {
                block.evaluate();
                for (i, row) in out.chunks_exact_mut(width).enumerate() {
                    for (order, phasors) in row.chunks_exact_mut(quantity.components()).enumerate()
                    {
                        for (out, phasor) in phasors.iter_mut().zip(block.phasors(order, i)) {
                            *out = phasor * factor;
                        }
                    }
                }
                Ok(())
            },
        )
    }

    /// Forward and backward parts of force or moment, of the shape of [`Self::phasors`].
    pub fn write_turning(
        &self,
        quantity: Quantity,
        out: &mut [Complex64],
        cancel: &Cancel,
    ) -> Result<()> {
        if quantity.is_torque() {
            let cure = "only force and moment have a forward and a backward part";
            return Err(Error::value("quantity", format!("{quantity:?}"), cure));
        }
        let width = 2 * self.orders.len();
        self.fill((quantity, Figure::Amplitude, Cost::Small), out, cancel, |block, factor, out| {
            block.evaluate();
            for (i, row) in out.chunks_exact_mut(width).enumerate() {
                for (order, parts) in row.chunks_exact_mut(2).enumerate() {
                    let bound = block.bounds[order][i];
                    let [ahead, against] = block.turning(order, i).map(|part| snapped(part, bound));
                    // A moment is its levered force turned by a quarter.
                    let turned = match quantity {
                        Quantity::Moment => Complex64::i(),
                        _ => Complex64::new(1.0, 0.0),
                    };
                    parts[0] = ahead * turned * factor;
                    parts[1] = against.conj() * turned * factor;
                }
            }
            Ok(())
        })
    }

    /// Largest rounding error of a sum that vanishes, of the shape of [`Figure::Length`].
    pub fn write_zero_bounds(
        &self,
        quantity: Quantity,
        out: &mut [f64],
        cancel: &Cancel,
    ) -> Result<()> {
        let orders = self.orders.len();
        self.fill((quantity, Figure::Length, Cost::Small), out, cancel, |block, factor, out| {
            block.evaluate();
            for (i, row) in out.chunks_exact_mut(orders).enumerate() {
                for (bound, out) in block.bounds.iter().zip(row) {
                    *out = bound[i] * factor;
                }
            }
            Ok(())
        })
    }

    /// [`Self::peaks`] into memory that is there, as long as the product of [`Self::result_shape`].
    pub fn write_peaks(
        &self,
        quantity: Quantity,
        figure: Figure,
        out: &mut [f64],
        cancel: &Cancel,
    ) -> Result<()> {
        let orders = self.orders.len();
        match figure {
            Figure::Amplitude => self.fill(
                (quantity, figure, Cost::Small),
                out,
                cancel,
                #[inline(always)]
                |block: &mut Block, factor: f64, out: &mut [f64]| {
                    block.peaks(factor, out);
                    Ok(())
                },
            ),
            Figure::Length => self.fill(
                (quantity, figure, Cost::Small),
                out,
                cancel,
                #[inline(always)]
                |block: &mut Block, factor: f64, out: &mut [f64]| {
                    block.evaluate();
                    for (i, row) in out.chunks_exact_mut(orders).enumerate() {
                        for (order, length) in row.iter_mut().enumerate() {
                            let bound = block.bounds[order][i];
                            let [forward, backward] = block.turning(order, i);
                            let both = [forward, backward].map(|part| snapped(part, bound).norm());
                            *length = (both[0] + both[1]) * factor;
                        }
                    }
                    Ok(())
                },
            ),
            Figure::Sum => {
                let finder = PeakFinder::new(&self.orders);
                self.fill((quantity, figure, Cost::Large), out, cancel, |block, factor, out| {
                    block.evaluate();
                    for (i, row) in out.chunks_exact_mut(quantity.components()).enumerate() {
                        cancel.check()?;
                        for (peak, phasors) in row.iter_mut().zip(block.by_component(i)) {
                            *peak = finder.along_axis(&phasors) * factor;
                        }
                    }
                    Ok(())
                })
            }
            Figure::LengthOfSum => {
                let finder = PeakFinder::new(&self.orders);
                self.fill((quantity, figure, Cost::Large), out, cancel, |block, factor, out| {
                    block.evaluate();
                    for (i, peak) in out.iter_mut().enumerate() {
                        cancel.check()?;
                        let [x, y] = block.by_component(i);
                        *peak = finder.of_vector(&x, &y) * factor;
                    }
                    Ok(())
                })
            }
        }
    }

    /// Torque may not have been asked for.
    fn check_asked(&self, quantity: Quantity) -> Result<()> {
        if quantity.is_torque() && !self.torque {
            return Err(Error::value("torque", "False", "it was not asked for; give torque=True"));
        }
        Ok(())
    }

    fn allocated<T: Number>(
        &self,
        quantity: Quantity,
        figure: Figure,
        write: impl FnOnce(&mut [T]) -> Result<()>,
    ) -> Result<Values<T>> {
        self.check_size(quantity, figure, size_of::<T>())?;
        let shape = self.result_shape(quantity, figure);
        let mut values = vec![T::default(); shape.iter().product()];
        write(&mut values)?;
        Array::from_shape_vec(IxDyn(&shape), values)
            .map_err(|error| Error::value("sweep", format!("{shape:?}"), error.to_string()))
    }

    /// Work out every point: layout sums block by block, handed to `finish` with a factor of its
    /// results.
    fn fill<T: Number>(
        &self,
        (quantity, figure, cost): (Quantity, Figure, Cost),
        out: &mut [T],
        cancel: &Cancel,
        finish: impl Fn(&mut Block, f64, &mut [T]) -> Result<()> + Sync,
    ) -> Result<()> {
        self.check_asked(quantity)?;
        if self.orders.is_empty() {
            out.fill(T::default());
            return Ok(());
        }
        let shape = self.result_shape(quantity, figure);
        if out.len() != shape.iter().product::<usize>() {
            return Err(Error::value("out", out.len(), format!("give room for {shape:?}")));
        }
        let width = shape[5..].iter().product();
        let counts = [self.engines.len(), self.points(), width];
        let run = Run::new(counts, self.bank_angles(), &self.squares, cost, cancel);
        let plan = Plan::new(self, quantity, run.passes(), cancel)?;
        run.fill(&plan, out, &finish)
    }

    /// Points of rod ratio and pin offset.
    fn points(&self) -> usize {
        let [_, _, ratios, offsets, _] = self.shape();
        ratios * offsets
    }

    fn bank_angles(&self) -> &[f64] {
        self.axes.bank_angle.as_ref().map_or(&[0.0], |(angles, _)| angles)
    }

    /// Every slider-crank of the sweep can turn: where the extreme ones can, all can. Returns them.
    fn check_geometry(&self, cancel: &Cancel) -> Result<[Option<f64>; 2]> {
        let (ratios, offsets) = (self.axes.rod_ratio.as_deref(), self.axes.pin_offset.as_deref());
        let extreme_ratios = ends(ratios, cancel)?;
        let extreme_offsets = ends(offsets, cancel)?;
        for cylinder in self.engines.iter().flat_map(|e| e.placements()).map(|p| p.cylinder) {
            let each = |ratio, offset| proportions(&cylinder, ratio, offset).map(drop);
            let extremes = extreme_ratios.iter().try_for_each(|&ratio| {
                extreme_offsets.iter().try_for_each(|&offset| each(ratio, offset))
            });
            let Err(error) = extremes else { continue };
            // Who is told of a value is told of the first that is wrong.
            let some = |values: Option<&[f64]>, k: usize| values.map(|values| values[k]);
            for k in 0..ratios.map_or(1, <[f64]>::len) {
                cancel.check()?;
                extreme_offsets.iter().try_for_each(|&offset| each(some(ratios, k), offset))?;
            }
            for k in 0..offsets.map_or(1, <[f64]>::len) {
                cancel.check()?;
                each(some(ratios, 0), some(offsets, k))?;
            }
            return Err(error);
        }
        let [least, most] = extreme_offsets;
        let farthest = least.zip(most).map(|(a, b)| if -a > b { a } else { b });
        Ok([extreme_ratios[1], farthest])
    }
}

/// The least and the largest value of an axis, or a value that is no number; nothing where it is not
/// swept.
fn ends(values: Option<&[f64]>, cancel: &Cancel) -> Result<[Option<f64>; 2]> {
    let Some(values) = values else { return Ok([None; 2]) };
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for part in values.chunks(PART) {
        cancel.check()?;
        let mut numbers = true;
        for &value in part {
            numbers &= !value.is_nan();
            (least, most) = (least.min(value), most.max(value));
        }
        if !numbers {
            return Ok([Some(f64::NAN); 2]);
        }
    }
    Ok([Some(least), Some(most)])
}

impl Drop for Sweep {
    fn drop(&mut self) {
        // What takes long to give back is given back by somebody for whom nobody waits.
        let numbers: usize = self.shape().iter().sum();
        if numbers > PART {
            give_back((mem::take(&mut self.axes), mem::take(&mut self.squares)));
        }
    }
}

impl Quantity {
    /// Axes of one value: x and y, or none for what is about z alone.
    fn shape(self) -> &'static [usize] {
        if self.is_torque() { &[] } else { &[2] }
    }

    /// Whether it is about z: one number instead of two.
    pub(crate) fn is_torque(self) -> bool {
        matches!(self, Self::Torque | Self::CrankTorque)
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

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::{Angle, Cylinder, Placement};

    #[test]
    fn whoever_stops_waiting_at_any_step_is_told_at_once() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let place = |bank: f64| Placement {
            cylinder,
            tdc: Angle::ZERO,
            bank: Angle::from_degrees(bank).unwrap(),
            z: 0.0,
            rotating_mass: 0.0,
        };
        let engine = Arc::new(Engine::new("", "", vec![place(60.0), place(120.0)]).unwrap());
        let engines = vec![Arc::clone(&engine), engine];
        let some = |count| Some(vec![0.3; count]);
        let angles = |count| Some((vec![60.0; count], Hold::Pins));
        // Angles side by side at one point and at several, and points side by side; engines, units
        // and blocks of each.
        for (bank_angle, rod_ratio, steps) in [
            (None, None, 2),
            (angles(300), None, 2 * 3),
            (angles(300), some(4), 2 * 3 * 4),
            (None, some(1200), 2 * 10),
            (angles(2), some(200), 2 * 2 * 2),
        ] {
            for rpm in [vec![3000.0], vec![3000.0, 1000.0]] {
                let (bank_angle, rod_ratio) = (bank_angle.clone(), rod_ratio.clone());
                let axes = Axes { bank_angle, rod_ratio, pin_offset: None, rpm };
                let sweep =
                    Sweep::new(engines.clone(), axes, vec![2], None, None, &Cancel::new()).unwrap();
                let what = (Quantity::Force, Figure::Length, Cost::Small);
                let run = |last: usize| {
                    let (cancel, done) = (Cancel::new(), AtomicUsize::new(0));
                    let shape = sweep.result_shape(what.0, what.1);
                    let mut out = vec![0.0; shape.iter().product()];
                    let finish = |_: &mut Block, _: f64, _: &mut [f64]| {
                        if done.fetch_add(1, Ordering::Relaxed) + 1 == last {
                            cancel.raise();
                        }
                        Ok(())
                    };
                    (sweep.fill(what, &mut out, &cancel, finish), done.into_inner())
                };
                assert_eq!(run(0), (Ok(()), steps));
                for last in 1..steps {
                    assert_eq!(run(last), (Err(Error::Cancelled), last));
                }
            }
        }
    }
}
