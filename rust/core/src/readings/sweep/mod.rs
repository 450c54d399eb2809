//! Sweeps over engines, bank angle, rod ratio, pin offset, speed and load, without a sample of θ.
//!
//! One point of a sweep is a product: ω², harmonics of rod ratio and pin offset, and sums of the
//! engine's loads with its banks turned. Torque of pressure does not scale with ω²; harmonics are
//! linear in pressure, so that those of a map of cycles are interpolated over speed and load.

mod axes;
mod block;
mod choice;
mod factors;
mod kernel;
mod layout;
mod operating;
mod placed;
mod tiles;
mod waveform;

use std::array::from_fn;
use std::sync::Arc;

use bytemuck::cast_slice_mut;

pub use self::axes::{MapAxes, SweepAxes};
use self::block::{Block, components, magnitude};
use self::kernel::Job;
use self::operating::{Nodes, RowsAtSpeeds};
use crate::Complex64;
use crate::engine::Engine;
use crate::load::{Group, Scene, find_or_push};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::{self, Order};
use crate::pressure::Cycle;
use crate::readings::balance::{ErrorBounds, Orders};
use crate::readings::peaks::PeakFinder;
use crate::readings::quantity::Quantity;
use crate::source::{INERTIA, Point, Scaling};
use crate::wrench::Planar;

/// Rows of a quantity: of all that makes it, or of a group of loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Selection<'a> {
    pub quantity: Quantity<'a>,
    pub group: Option<&'a Group>,
}

/// Which value of force, moment or torque over the turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Statistic {
    /// Of each order along (about) each axis: (…, `n_orders`, and 2 except for torque).
    Amplitude,
    /// Forward and backward part of each order: (…, `n_orders`, 2).
    Turning,
    /// The longest vector of each order: (…, `n_orders`).
    Length,
    /// Bound of the rounding error of each order: (…, `n_orders`).
    ZeroBound,
    /// Of all orders together along (about) each axis: (…, and 2 except for torque).
    Sum,
    /// The longest vector of all orders together: (…).
    LengthOfSum,
    /// The mean over the turn: (…).
    Mean,
}

/// Engines and axes, checked; values are evaluated when they are read.
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
/// use std::sync::Arc;
///
/// use crankpin_core::quantity::Quantity;
/// use crankpin_core::sweep::{SweepAxes, Statistic, Sweep};
/// use crankpin_core::{Cancel, Orders};
///
/// let rpm = vec![1000.0, 2000.0];
/// let axes = SweepAxes { bank_angle: None, rod_ratio: None, pin_offset: None, rpm, map: None };
/// let orders = Orders::whole(&[1, 2])?;
/// let sweep = Sweep::new(vec![Arc::new(four)], axes, &orders, None, false, &Cancel::new())?;
/// assert_eq!(sweep.result_shape(Quantity::FORCE, Statistic::Length), [1, 1, 1, 1, 2, 1, 2]);
/// let mut peaks = vec![0.0; 4]; // by speed and order, N
/// sweep.write_peaks(Quantity::FORCE, Statistic::Length, &mut peaks, &Cancel::new())?;
/// assert_eq!((peaks[0], peaks[2]), (0.0, 0.0));
/// assert!((peaks[3] / peaks[1] - 4.0).abs() < 1e-12);
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug)]
pub struct Sweep {
    engines: Vec<Arc<Engine>>,
    axes: SweepAxes,
    /// Loads of each engine.
    loads: Vec<Arc<Scene>>,
    /// Groups of the loads of all engines, and whether each has forces, and torques.
    groups: Vec<(Group, [bool; 2])>,
    /// Places of speeds and loads in a map of cycles.
    nodes: Nodes,
    orders: Vec<Order>,
    /// The largest rod ratio, and the offset of largest magnitude, where they are swept.
    extremes: [Option<f64>; 2],
    /// Angular speeds, rad/s.
    omegas: Vec<f64>,
    /// Whether torque is wanted.
    torque: bool,
    omitted: Vec<Order>,
    error_bound: ErrorBounds,
}

impl Sweep {
    /// Checks everything that can be wrong, and chooses orders where they are not given: few that leave out little at
    /// any point, of torque if it is wanted. With a map of cycles those of the engines are replaced by the map's.
    pub fn new(
        engines: Vec<Arc<Engine>>,
        axes: SweepAxes,
        orders: &Orders,
        reference_z: Option<f64>,
        torque: bool,
        cancel: &Cancel,
    ) -> Result<Self> {
        if let Orders::Given(orders) = orders {
            order::check_list(orders)?;
        }
        axes::not_empty("engines", engines.len())?;
        let omegas = axes.omegas(cancel)?;
        let nodes = Nodes::new(&axes, cancel)?;
        axes.check(&engines, cancel)?;
        let extremes = axes.check_geometry(&engines, cancel)?;
        let mut loads = memory::with_capacity(engines.len())?;
        let mut groups: Vec<(Group, [bool; 2])> = Vec::new();
        for engine in &engines {
            cancel.check()?;
            engine.check_speeds(&axes.rpm)?;
            let list = Scene::of(engine, reference_z)?;
            for (k, group) in list.groups.indices().zip(&list.groups) {
                let new = || (group.clone(), [false; 2]);
                let (_, has) = find_or_push(&mut groups, |(own, _)| own == group, new);
                has.iter_mut().zip(list.has(k)).for_each(|(has, own)| *has |= own);
            }
            loads.push(list);
        }
        let mut sweep = Self {
            torque: torque && engines.iter().all(|engine| engine.spectrum().is_none()),
            engines,
            axes,
            loads,
            groups,
            nodes,
            orders: Vec::new(),
            extremes,
            omegas,
            omitted: Vec::new(),
            error_bound: ErrorBounds::default(),
        };
        let chosen = match orders {
            Orders::Given(orders) => (orders.clone(), Vec::new(), ErrorBounds::default()),
            Orders::Auto { rtol } => sweep.chosen(*rtol, cancel)?,
        };
        (sweep.orders, sweep.omitted, sweep.error_bound) = chosen;
        Ok(sweep)
    }

    /// Names of the parts of its quantities: of the loads of all engines.
    #[must_use]
    pub fn names(&self) -> Vec<Arc<str>> {
        let mut names: Vec<Arc<str>> = Vec::new();
        for (group, _) in &self.groups {
            if !names.contains(&group.name) {
                names.push(Arc::clone(&group.name));
            }
        }
        names
    }

    /// Lengths of the axes engine, bank angle, rod ratio, pin offset, speed, load.
    #[must_use]
    pub fn shape(&self) -> [usize; 6] {
        let length = |values: &Option<Vec<f64>>| values.as_ref().map_or(1, Vec::len);
        [
            self.engines.len(),
            self.axes.bank_angle.as_ref().map_or(1, |(angles, _)| angles.len()),
            length(&self.axes.rod_ratio),
            length(&self.axes.pin_offset),
            self.omegas.len(),
            self.nodes.loads(),
        ]
    }

    /// Largest mean piston speed of any cylinder at any speed, m/s.
    #[must_use]
    pub fn mean_piston_speed(&self) -> f64 {
        let rpm = self.axes.rpm.iter().copied().fold(0.0, f64::max);
        let [ratio, offset] = self.extremes;
        // Shorter rods and larger offsets make the travel longer.
        let travel = |engine: &Engine, i: usize| {
            let cylinder = &engine.stations()[i].cylinder;
            if ratio.is_none() && offset.is_none() {
                return engine.mechanism(i).travel();
            }
            let radius = cylinder.crank_radius();
            let rod = match ratio {
                None => cylinder.rod_length(),
                Some(ratio) => radius / ratio,
            };
            let offset = offset.unwrap_or(cylinder.pin_offset());
            let swept = Cylinder::new(radius, rod, 0.0, offset);
            swept.map_or(2.0 * radius, |swept| swept.travel())
        };
        let speeds = self.engines.iter();
        let speeds = speeds.map(|engine| engine.mean_piston_speed_of(rpm, |i| travel(engine, i)));
        speeds.fold(0.0, f64::max)
    }

    /// Multiples of crank speed.
    #[must_use]
    pub fn orders(&self) -> &[Order] {
        &self.orders
    }

    /// Orders evaluated and left out, of those that are not zero everywhere.
    #[must_use]
    pub fn omitted(&self) -> &[Order] {
        &self.omitted
    }

    /// Bounds of what orders left out add at any crank angle and point.
    #[must_use]
    pub fn error_bound(&self) -> ErrorBounds {
        self.error_bound
    }

    /// Lengths of all axes of a result: engine, bank angle, rod ratio, pin offset, speed, load; then orders
    /// and components, if any.
    #[must_use]
    pub fn result_shape(&self, quantity: Quantity, figure: Statistic) -> Vec<usize> {
        let orders = &[self.orders.len()][..];
        let tail: [&[usize]; 2] = match figure {
            Statistic::Amplitude => [orders, quantity.shape()],
            Statistic::Turning => [orders, &[2]],
            Statistic::Length | Statistic::ZeroBound => [orders, &[]],
            Statistic::Sum => [&[], quantity.shape()],
            Statistic::LengthOfSum | Statistic::Mean => [&[], &[]],
        };
        [&self.shape()[..], &tail.concat()].concat()
    }

    /// Rejects a result of numbers of this many bytes that is too large for one call.
    pub fn check_size(&self, quantity: Quantity, figure: Statistic, bytes: usize) -> Result<()> {
        let hint = "sweep one axis in parts";
        limits::result_size("sweep", &self.result_shape(quantity, figure), bytes, hint)
    }

    /// Writes peak phasors of each order, along (about) x and y or as forward and backward parts, to a
    /// buffer as long as the product of [`Self::result_shape`].
    pub fn write_phasors(
        &self,
        quantity: Quantity,
        figure: Statistic,
        out: &mut [Complex64],
        cancel: &Cancel,
    ) -> Result<()> {
        let width = self.checked_width(quantity, figure, out.len())?;
        if out.is_empty() {
            return Ok(());
        }
        if self.is_of_one_square(quantity) {
            let numbers = cast_slice_mut(out);
            return self.at_each_speed(
                quantity,
                2 * width,
                numbers,
                cancel,
                |selection, out, factor| {
                    self.phasor_rows((selection, figure), cast_slice_mut(out), factor, cancel)
                },
            );
        }
        let sums = self.sums(quantity, cancel)?;
        let components = width / self.orders.len();
        sums.finish(None, (out, width, 1), cancel, |row, _, out| {
            for (sum, out) in sums_of(row, quantity).iter().zip(out.chunks_exact_mut(components)) {
                out.copy_from_slice(&figure.phasors(sum)[..components]);
            }
            Ok(())
        })
    }

    /// Writes a figure of every point to a buffer as long as the product of [`Self::result_shape`].
    pub fn write_peaks(
        &self,
        quantity: Quantity,
        figure: Statistic,
        out: &mut [f64],
        cancel: &Cancel,
    ) -> Result<()> {
        let figure = if figure == Statistic::Turning { Statistic::Amplitude } else { figure };
        let width = self.checked_width(quantity, figure, out.len())?;
        if out.is_empty() {
            return Ok(());
        }
        let has_others = !self.is_of_one_square(quantity) || self.may_have_mean(quantity);
        let finder = figure.is_of_sum().then(|| {
            let orders = &self.orders;
            if has_others && !quantity.is_planar() {
                PeakFinder::about_mean(orders)
            } else {
                PeakFinder::new(orders)
            }
        });
        let finder = finder.transpose()?;
        let means = |selection: Selection, out: &mut [f64], factor: f64| {
            self.mean_rows(selection, out, factor, cancel)
        };
        if figure == Statistic::Mean {
            return self.at_each_speed(quantity, width, out, cancel, means);
        }
        if !has_others || !figure.is_after_sums() {
            return self.at_each_speed(quantity, width, out, cancel, |selection, out, factor| {
                self.peak_rows((selection, figure), finder.as_ref(), out, factor, cancel)
            });
        }
        let sums = self.sums(quantity, cancel)?;
        let Some(finder) = finder else {
            return sums.finish(
                None,
                (out, width, 1),
                cancel,
                #[inline(always)]
                |row, _, out| {
                    write_sizes(row, quantity, figure, out);
                    Ok(())
                },
            );
        };
        let means = self.operating(quantity, 1, means)?;
        // A search for an extremum takes some hundred times as long.
        sums.finish(Some(&means), (out, width, 256), cancel, |row, mean, out| {
            cancel.check()?;
            let [x, y] = components(sums_of(row, quantity).into_iter());
            if !quantity.is_planar() {
                out[0] = finder.beside_mean(mean, &x, cancel)?;
            } else if figure == Statistic::LengthOfSum {
                out[0] = finder.of_vector(&x, &y, cancel)?;
            } else {
                out[0] = finder.along_axis(&x, cancel)?;
                out[1] = finder.along_axis(&y, cancel)?;
            }
            Ok(())
        })
    }

    /// Sums of every order at every speed and load, as columns of numbers: real and imaginary parts, and the bounds of
    /// their rounding errors.
    fn sums(&self, quantity: Quantity, cancel: &Cancel) -> Result<RowsAtSpeeds<'_>> {
        let (orders, columns) = (self.orders.len(), 2 * quantity.components() + 1);
        let width = orders * columns;
        self.operating(quantity, width, |selection, out, _| {
            let job = Job { sweep: self, selection, width, slow: false, cancel };
            job.rows(out, 1.0, |block: &Block, _, out: &mut [f64]| {
                for (i, row) in out.chunks_exact_mut(width).enumerate() {
                    for order in 0..orders {
                        let sum = block.planar(order, i).snapped();
                        let Planar { forward: f, backward_conj: b, bound } = sum;
                        let numbers = [f.re, f.im, b.re, b.im, bound];
                        for (column, k) in (0..columns - 1).chain([4]).enumerate() {
                            row[column * orders + order] = numbers[k];
                        }
                    }
                }
                Ok(())
            })
        })
    }

    /// Phasors of every row, times a factor.
    fn phasor_rows(
        &self,
        (selection, figure): (Selection, Statistic),
        out: &mut [Complex64],
        factor: f64,
        cancel: &Cancel,
    ) -> Result<()> {
        let width = self.width(selection.quantity, figure);
        let components = width / self.orders.len().max(1);
        let job = Job { sweep: self, selection, width, slow: false, cancel };
        job.rows(
            out,
            factor,
            #[inline(always)]
            |block: &Block, factor: f64, out: &mut [Complex64]| {
                for (i, row) in out.chunks_exact_mut(width).enumerate() {
                    for (order, out) in row.chunks_exact_mut(components).enumerate() {
                        let phasors = figure.phasors(&block.planar(order, i));
                        out.iter_mut()
                            .zip(phasors)
                            .for_each(|(out, phasor)| *out = phasor * factor);
                    }
                }
                Ok(())
            },
        )
    }

    /// A figure of every row, times a factor.
    fn peak_rows(
        &self,
        (selection, figure): (Selection, Statistic),
        finder: Option<&PeakFinder>,
        out: &mut [f64],
        factor: f64,
        cancel: &Cancel,
    ) -> Result<()> {
        let quantity = selection.quantity;
        let (orders, components) = (self.orders.len(), quantity.components());
        let (width, slow) = (self.width(quantity, figure), figure.is_of_sum());
        let job = Job { sweep: self, selection, width, slow, cancel };
        job.rows(
            out,
            factor,
            #[inline(always)]
            |block: &Block, factor: f64, out: &mut [f64]| {
                match (figure, finder) {
                    (Statistic::Length, _) => block.lengths(factor, out),
                    (Statistic::ZeroBound, _) => {
                        for (i, row) in out.chunks_exact_mut(orders).enumerate() {
                            for (order, bound) in row.iter_mut().enumerate() {
                                *bound = block.planar(order, i).bound * factor;
                            }
                        }
                    }
                    (Statistic::Sum, Some(finder)) => {
                        for (i, row) in out.chunks_exact_mut(components).enumerate() {
                            cancel.check()?;
                            for (peak, phasors) in row.iter_mut().zip(block.by_component(i)) {
                                *peak = factor * finder.along_axis(&phasors, cancel)?;
                            }
                        }
                    }
                    (Statistic::LengthOfSum, Some(finder)) => {
                        for (i, peak) in out.iter_mut().enumerate() {
                            cancel.check()?;
                            let [x, y] = block.by_component(i);
                            *peak = finder.of_vector(&x, &y, cancel)? * factor;
                        }
                    }
                    _ if components == 2 => block.magnitudes::<2>(factor, out),
                    _ => block.magnitudes::<1>(factor, out),
                }
                Ok(())
            },
        )
    }

    /// Rejects torque that was not asked for or that a spectrum does not determine.
    fn check_known(&self, quantity: Quantity) -> Result<()> {
        if quantity.is_planar() || self.torque {
            return Ok(());
        }
        let reason = if self.engines.iter().any(|engine| engine.spectrum().is_some()) {
            "a force spectrum does not determine it; compute without `spectrum`"
        } else {
            "`torque: false` was given; leave it out"
        };
        Err(Error::NoTorque(reason))
    }

    /// Numbers of a row, after a check of a buffer for all rows.
    fn checked_width(&self, quantity: Quantity, figure: Statistic, room: usize) -> Result<usize> {
        self.check_known(quantity)?;
        let shape = self.result_shape(quantity, figure);
        if room != shape.iter().product::<usize>() {
            return Err(Error::value("out", room, format!("give room for {shape:?}")));
        }
        Ok(self.width(quantity, figure))
    }

    /// Numbers of a row.
    fn width(&self, quantity: Quantity, figure: Statistic) -> usize {
        self.result_shape(quantity, figure)[self.shape().len()..].iter().product()
    }

    /// Groups that make a quantity.
    fn groups_of(&self, quantity: Quantity) -> impl Iterator<Item = &Group> {
        let makes =
            move |[force, torque]: [bool; 2]| if quantity.is_planar() { force } else { torque };
        let own =
            self.groups.iter().filter(move |(_, parts)| makes(*parts)).map(|(group, _)| group);
        own.filter(move |group| quantity.part.has(&group.name))
    }

    /// Whether one group makes a quantity, and scales with the square of the speed.
    fn is_of_one_square(&self, quantity: Quantity) -> bool {
        let mut groups = self.groups_of(quantity);
        let is_square = |group: &Group| group.scaling == Scaling::SpeedSquared;
        groups.next().is_some_and(is_square) && groups.next().is_none()
    }

    /// Whether it is a torque that more than inertia makes.
    fn may_have_mean(&self, quantity: Quantity) -> bool {
        !quantity.is_planar() && self.groups_of(quantity).any(|group| &*group.name != INERTIA)
    }

    /// Number of points of a selection: of rod ratio and pin offset and, of what does not scale with speed,
    /// of cycle.
    fn points_of(&self, selection: Selection) -> usize {
        self.points() * self.cycles_of(selection)
    }

    /// Number of cycles of a map at which a selection is evaluated.
    fn cycles_of(&self, selection: Selection) -> usize {
        let by_cycle = |group: &Group| group.scaling == Scaling::Independent;
        if selection.group.is_some_and(by_cycle) { self.nodes.count() } else { 1 }
    }

    /// Number of points of rod ratio and pin offset.
    fn points(&self) -> usize {
        let [_, _, ratios, offsets, ..] = self.shape();
        ratios * offsets
    }

    /// What a point of a quantity replaces: the cycle changes first.
    fn at(&self, selection: Selection, point: usize) -> Point<'_> {
        let cycles = self.cycles_of(selection);
        Point { cycles: self.cycles_at(point % cycles), ..self.proportions_at(point / cycles) }
    }

    /// Cycles of a map at one of its speeds and loads.
    fn cycles_at(&self, node: usize) -> Option<&[Arc<Cycle>]> {
        self.axes.map.as_ref().map(|map| &map.cycles[node][..])
    }

    /// Rod ratio and pin offset of a point, where they are swept.
    fn proportions_at(&self, point: usize) -> Point<'static> {
        let [ratios, offsets] = [&self.axes.rod_ratio, &self.axes.pin_offset];
        let in_a_row = offsets.as_ref().map_or(1, Vec::len);
        Point {
            rod_ratio: ratios.as_ref().map(|ratios| ratios[point / in_a_row]),
            pin_offset: offsets.as_ref().map(|offsets| offsets[point % in_a_row]),
            cycles: None,
        }
    }

    fn bank_angles(&self) -> &[f64] {
        self.axes.bank_angle.as_ref().map_or(&[0.0], |(angles, _)| angles)
    }
}

/// Columns of numbers of a row.
fn columns<const N: usize>(row: &[f64]) -> [&[f64]; N] {
    let orders = row.len() / N;
    from_fn(|column| &row[column * orders..][..orders])
}

/// The sums of a row of numbers, zero where rounding is all there is.
fn sums_of(row: &[f64], quantity: Quantity) -> Vec<Planar> {
    let complex = |re: &[f64], im: &[f64], k: usize| Complex64::new(re[k], im[k]);
    let planar = |forward, backward_conj, bound| Planar { forward, backward_conj, bound }.snapped();
    if quantity.is_planar() {
        let [f, g, u, v, bounds] = columns(row);
        let of = |(k, bound): (usize, &f64)| planar(complex(f, g, k), complex(u, v, k), *bound);
        return bounds.iter().enumerate().map(of).collect();
    }
    let [re, im, bounds] = columns(row);
    let of = |(k, bound): (usize, &f64)| planar(complex(re, im, k), Complex64::ZERO, *bound);
    bounds.iter().enumerate().map(of).collect()
}

/// Writes the amplitudes along (about) each axis, or the length, of the sums of a row of numbers.
#[inline(always)]
fn write_sizes(row: &[f64], quantity: Quantity, figure: Statistic, out: &mut [f64]) {
    if !quantity.is_planar() {
        let [re, im, bounds] = columns(row);
        for (((out, re), im), bound) in out.iter_mut().zip(re).zip(im).zip(bounds) {
            *out = magnitude(*re, *im, *bound);
        }
        return;
    }
    let [f, g, u, v, bounds] = columns(row);
    let parts = f.iter().zip(g).zip(u.iter().zip(v)).zip(bounds);
    if figure == Statistic::Length {
        for (out, (((f, g), (u, v)), bound)) in out.iter_mut().zip(parts) {
            *out = magnitude(*f, *g, *bound) + magnitude(*u, *v, *bound);
        }
        return;
    }
    let pairs = out.as_chunks_mut::<2>().0;
    for (out, (((f, g), (u, v)), bound)) in pairs.iter_mut().zip(parts) {
        *out = [1.0, -1.0].map(|sign| magnitude(f + sign * u, g + sign * v, *bound));
    }
}

impl Statistic {
    /// The phasors of a sum: forward and backward part, or along (about) x and y.
    #[inline(always)]
    fn phasors(self, sum: &Planar) -> [Complex64; 2] {
        if self != Self::Turning {
            return sum.xy(sum.bound);
        }
        let sum = sum.snapped();
        [sum.forward, sum.backward()]
    }

    /// Whether it takes a search for an extremum.
    fn is_of_sum(self) -> bool {
        matches!(self, Self::Sum | Self::LengthOfSum)
    }

    /// Whether it is of what all scalings make together.
    fn is_after_sums(self) -> bool {
        self.is_of_sum() || matches!(self, Self::Amplitude | Self::Length)
    }
}
