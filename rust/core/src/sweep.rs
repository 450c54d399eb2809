//! Sweeps over engines, bank angle, rod ratio, pin offset and speed, without a sample of θ.
//!
//! One point of a sweep is a product: ω², the harmonic aₙ(λ, e) and a layout sum. With the two
//! banks at `bisector ∓ γ` (γ half the bank angle) and the bank sums right ± left, the layout sum
//! along (about) each axis is four functions of γ times four complex constants of the engine: with
//! pins held, bores turn a cylinder's direction and its phase together,
//! `Σ e^{±i·bank} e^{−in(bank − pin)}`, and the functions are cosine and sine of (n ∓ 1)γ; with the
//! firing held they are cosine and sine of γ. The four are worked out once for all engines.

use ndarray::{Array, Array2, IxDyn};
use rayon::prelude::*;

use crate::Complex64;
use crate::angle::Angle;
use crate::balance::{angular_speed, snapped, zero_factor};
use crate::cancel::Cancel;
use crate::engine::{Banks, Engine, Hold, Placement, bank_angle_in_range};
use crate::error::{Error, Result};
use crate::extrema::PeakFinder;
use crate::harmonics;
use crate::limits;
use crate::simd::{sin_cos_degrees, vectorised};
use crate::slider_crank::{Cylinder, Proportions};
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
    engines: Vec<Engine>,
    axes: Axes,
    orders: Vec<u32>,
    references: Vec<f64>,
    spectrum: Option<Spectrum>,
    /// ω² of each speed.
    squares: Vec<f64>,
}

/// Bank angles that are worked out side by side; cancellation is looked at between blocks.
const BLOCK: usize = 64;
/// Points of the other axes between two looks at cancellation.
const POINTS: usize = 1024;
/// A result of fewer numbers is not worth waking another thread for.
const WORTH_A_THREAD: usize = 1 << 14;

/// Axes: engine, bank angle, rod ratio, pin offset, speed; then orders and components, if any.
pub type Values<T> = Array<T, IxDyn>;

impl Sweep {
    /// Check everything that can be wrong.
    pub fn new(
        engines: Vec<Engine>,
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
            angles.iter().try_for_each(|&angle| bank_angle_in_range(angle).map(drop))?;
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
        let sweep = Self { engines, axes, orders, references, spectrum, squares };
        sweep.check_geometry()?;
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

    /// Peak phasors of each order: (…, `n_orders`, components).
    pub fn phasors(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<Complex64>> {
        let tail = [self.orders.len(), quantity.components()];
        self.fill(quantity, &tail, cancel, |block, out| {
            for (channel, bound) in block.bounds.iter().enumerate() {
                for i in 0..block.count {
                    out[i * block.bounds.len() + channel] = snapped(block.phasor(channel, i), *bound);
                }
            }
        })
    }

    /// max over θ of each order along (about) each axis: (…, `n_orders`, components).
    pub fn peaks(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<f64>> {
        let tail = [self.orders.len(), quantity.components()];
        self.fill(quantity, &tail, cancel, |block, out| {
            block.magnitudes(out);
        })
    }

    /// max over θ of the length of each order's vector: (…, `n_orders`).
    pub fn vector_peaks(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<f64>> {
        let orders = self.orders.len();
        self.fill(quantity, &[orders], cancel, |block, out| {
            for order in 0..orders {
                let bound = block.bounds[2 * order];
                for i in 0..block.count {
                    let (x, y) = (block.phasor(2 * order, i), block.phasor(2 * order + 1, i));
                    let turned = Complex64::i() * y;
                    let (forward, backward) = ((x + turned) * 0.5, (x - turned) * 0.5);
                    out[i * orders + order] =
                        snapped(forward, bound).norm() + snapped(backward, bound).norm();
                }
            }
        })
    }

    /// max over θ of the sum of orders along (about) each axis: (…, components).
    pub fn sum_peaks(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<f64>> {
        let components = quantity.components();
        let finder = PeakFinder::new(&self.orders);
        self.fill(quantity, &[components], cancel, |block, out| {
            for i in 0..block.count {
                for component in 0..components {
                    out[i * components + component] =
                        finder.along_axis(&block.orders(component, components, i));
                }
            }
        })
    }

    /// max over θ of the length of the sum of orders: (…).
    pub fn sum_vector_peaks(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<f64>> {
        let finder = PeakFinder::new(&self.orders);
        self.fill(quantity, &[], cancel, |block, out| {
            for (i, out) in out.iter_mut().enumerate().take(block.count) {
                *out = finder.of_vector(&block.orders(0, 2, i), &block.orders(1, 2, i));
            }
        })
    }

    /// Work out every point: layout sums block by block, handed to `finish`, times ω².
    fn fill<T>(
        &self,
        quantity: Quantity,
        tail: &[usize],
        cancel: &Cancel,
        finish: impl Fn(&Block, &mut [T]) + Sync,
    ) -> Result<Values<T>>
    where
        T: Copy + Default + Send + Sync + std::ops::Mul<f64, Output = T>,
    {
        let shape = [&self.shape()[..], tail].concat();
        let cure = "sweep one axis in parts";
        limits::result_size("sweep", &shape, size_of::<T>(), cure)?;
        let plan = Plan::new(self, quantity, cancel)?;
        let mut values = vec![T::default(); shape.iter().product()];
        let [_, angles, ratios, offsets, speeds] = self.shape();
        let width: usize = tail.iter().product();
        let run = Run { plan: &plan, squares: &self.squares, points: ratios * offsets, width, cancel };
        if angles > 1 {
            run.over_bank_angles(self.bank_angles(), &mut values, &finish)?;
        } else {
            run.over_other_axes(self.bank_angles(), speeds, &mut values, &finish)?;
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
        for cylinder in self.engines.iter().flat_map(Engine::placements).map(|p| p.cylinder) {
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
    /// x and y, or z alone.
    #[must_use]
    pub fn components(self) -> usize {
        if self == Self::Torque { 1 } else { 2 }
    }
}

fn not_empty(argument: &str, length: usize) -> Result<()> {
    if length > 0 {
        return Ok(());
    }
    Err(Error::value(argument, "[]", "give at least one value"))
}

/// A cylinder's proportions with rod ratio and pin offset replaced.
fn proportions(
    cylinder: &Cylinder,
    rod_ratio: Option<f64>,
    pin_offset: Option<f64>,
) -> Result<Proportions> {
    let offset = pin_offset.unwrap_or(cylinder.pin_offset());
    let radius = cylinder.crank_radius();
    match rod_ratio {
        Some(ratio) => Proportions::new(ratio, offset / radius),
        None => Cylinder::new(radius, cylinder.rod_length(), 0.0, offset).map(|c| c.proportions()),
    }
}

/// How many functions of half the bank angle a layout sum has.
const FUNCTIONS: usize = 4;

/// A sum over cylinders as constants of those functions, for each channel (order × component).
struct Terms {
    constants: Vec<[Complex64; FUNCTIONS]>,
    /// Σ|terms| per channel.
    sizes: Vec<f64>,
}

/// One engine: cylinders that share their harmonics, and what turns with the pins.
struct EnginePlan {
    /// Layout sums, and harmonics by (point of rod ratio and offset, order).
    groups: Vec<(Terms, Array2<Complex64>)>,
    rotating: Option<Terms>,
    cylinders: usize,
}

/// All that does not depend on the bank angle.
struct Plan<'a> {
    orders: &'a [u32],
    hold: Option<Hold>,
    engines: Vec<EnginePlan>,
    components: usize,
}

impl<'a> Plan<'a> {
    fn new(sweep: &'a Sweep, quantity: Quantity, cancel: &Cancel) -> Result<Self> {
        let engines = sweep
            .engines
            .iter()
            .zip(&sweep.references)
            .map(|(engine, &reference)| EnginePlan::new(sweep, engine, reference, quantity, cancel))
            .collect::<Result<_>>()?;
        let hold = sweep.axes.bank_angle.as_ref().map(|&(_, hold)| hold);
        Ok(Self { orders: &sweep.orders, hold, engines, components: quantity.components() })
    }

    fn channels(&self) -> usize {
        self.orders.len() * self.components
    }

    /// Constants of an engine at a point, all groups together, times `scale`; and the bounds.
    fn combined(&self, engine: usize, point: usize, scale: f64, block: &mut Block) {
        let plan = &self.engines[engine];
        for channel in 0..self.channels() {
            let order = channel / self.components;
            let (mut sum, mut size) = ([Complex64::default(); FUNCTIONS], 0.0);
            let mut add = |terms: &Terms, factor: Complex64| {
                for (sum, constant) in sum.iter_mut().zip(&terms.constants[channel]) {
                    *sum += constant * factor;
                }
                size += terms.sizes[channel] * factor.norm();
            };
            for (terms, harmonics) in &plan.groups {
                add(terms, harmonics[[point, order]] * scale);
            }
            if let Some(terms) = &plan.rotating {
                add(terms, Complex64::new(scale, 0.0));
            }
            block.constants[channel] = sum;
            block.bounds[channel] = size * zero_factor(plan.cylinders, self.orders[order]);
        }
    }
}

impl EnginePlan {
    fn new(
        sweep: &Sweep,
        engine: &Engine,
        reference: f64,
        quantity: Quantity,
        cancel: &Cancel,
    ) -> Result<Self> {
        let placements = engine.placements();
        let hold = sweep.axes.bank_angle.as_ref().map(|&(_, hold)| hold);
        let frame = hold.map(|hold| engine.banks().map(|banks| (banks, hold))).transpose()?;
        let layout = Layout { reference, orders: &sweep.orders, frame, quantity };
        let mut groups: Vec<(Cylinder, Vec<&Placement>)> = Vec::new();
        for placement in placements {
            let cylinder = placement.cylinder;
            let same = |other: &Cylinder| {
                other.crank_radius() == cylinder.crank_radius()
                    && other.rod_length() == cylinder.rod_length()
                    && other.pin_offset() == cylinder.pin_offset()
            };
            match groups.iter_mut().find(|(other, _)| same(other)) {
                Some((_, members)) => members.push(placement),
                None => groups.push((cylinder, vec![placement])),
            }
        }
        let by_spectrum = sweep.spectrum.is_some();
        let groups = groups.into_iter().map(|(cylinder, members)| {
            let weight = |p: &Placement| match quantity {
                _ if by_spectrum => 1.0,
                Quantity::Torque => p.cylinder.first_order() * p.cylinder.crank_radius(),
                _ => p.cylinder.first_order(),
            };
            let terms = layout.terms(&members, weight, 0.5, 0.5);
            Ok((terms, sweep.harmonics(&cylinder, quantity, cancel)?))
        });
        let groups = groups.collect::<Result<_>>()?;
        let turning: Vec<&Placement> = placements
            .iter()
            .filter(|p| p.rotating_mass > 0.0 && quantity != Quantity::Torque)
            .collect();
        let rotating = (!turning.is_empty() && sweep.orders.contains(&1)).then(|| {
            // A mass on the pin: its force is all forward.
            let mut terms =
                layout.terms(&turning, |p| p.rotating_mass * p.cylinder.crank_radius(), 1.0, 0.0);
            for channel in 0..terms.constants.len() {
                if sweep.orders[channel / quantity.components()] != 1 {
                    terms.constants[channel] = Default::default();
                    terms.sizes[channel] = 0.0;
                }
            }
            terms
        });
        Ok(Self { groups, rotating, cylinders: placements.len() })
    }
}

impl Sweep {
    /// Harmonics of a cylinder at every point of rod ratio and offset: (points, `n_orders`).
    fn harmonics(
        &self,
        cylinder: &Cylinder,
        quantity: Quantity,
        cancel: &Cancel,
    ) -> Result<Array2<Complex64>> {
        if let Some(spectrum) = &self.spectrum {
            if quantity == Quantity::Torque {
                let cure = "a spectrum of forces tells nothing of torque; leave it out";
                return Err(Error::value("spectrum", "given", cure));
            }
            let row = self.orders.iter().map(|&n| spectrum.amplitude(n)).collect();
            return Ok(one_row(row));
        }
        let centred = cylinder.pin_offset() == 0.0 && self.axes.pin_offset.is_none();
        if let (Some(ratios), true, true) =
            (&self.axes.rod_ratio, centred, quantity != Quantity::Torque)
        {
            let table = harmonics::centred_table(ratios, &self.orders, cancel)?;
            return Ok(table.mapv(Complex64::from));
        }
        let one = [f64::NAN];
        let list = |values: &'_ Option<Vec<f64>>| -> Vec<Option<f64>> {
            match values {
                Some(values) => values.iter().copied().map(Some).collect(),
                None => one.iter().map(|_| None).collect(),
            }
        };
        let (ratios, offsets) = (list(&self.axes.rod_ratio), list(&self.axes.pin_offset));
        let points = ratios.len() * offsets.len();
        let row = |point: usize| -> Result<Vec<Complex64>> {
            cancel.check()?;
            let (ratio, offset) = (ratios[point / offsets.len()], offsets[point % offsets.len()]);
            let proportions = proportions(cylinder, ratio, offset)?;
            Ok(match quantity {
                Quantity::Torque => harmonics::torque(&proportions, &self.orders).roll,
                _ => harmonics::coefficients(&proportions, &self.orders),
            })
        };
        if points == 1 {
            return row(0).map(one_row);
        }
        let rows: Vec<Vec<Complex64>> = (0..points).into_par_iter().map(row).collect::<Result<_>>()?;
        Ok(Array2::from_shape_fn((points, self.orders.len()), |(point, order)| rows[point][order]))
    }
}

fn one_row(row: Vec<Complex64>) -> Array2<Complex64> {
    Array2::from_shape_fn((1, row.len()), |(_, order)| row[order])
}

/// What layout sums are taken over.
struct Layout<'a> {
    reference: f64,
    orders: &'a [u32],
    /// The banks and what is held, where the bank angle is swept.
    frame: Option<(Banks, Hold)>,
    quantity: Quantity,
}

impl Layout<'_> {
    /// Σ weight·(forward·e^{i·bank} + backward·e^{−i·bank})·e^{−in·tdc} along x, and the same with
    /// ∓i along y; for torque Σ weight·e^{−in·tdc}.
    fn terms(
        &self,
        members: &[&Placement],
        weight: impl Fn(&Placement) -> f64,
        forward: f64,
        backward: f64,
    ) -> Terms {
        let (mut constants, mut sizes) = (Vec::new(), Vec::new());
        let i = Complex64::i();
        for &n in self.orders {
            let lever = |p: &Placement| match self.quantity {
                Quantity::Moment => p.z - self.reference,
                _ => 1.0,
            };
            let size: f64 = members
                .iter()
                .map(|p| match self.quantity {
                    // Rounding of a lever is relative to what it is the difference of.
                    Quantity::Moment => weight(p) * (p.z.abs() + self.reference.abs()),
                    _ => weight(p),
                })
                .sum();
            let sum = |turn: i64| self.functions(members, n, turn, |p| weight(p) * lever(p));
            if self.quantity == Quantity::Torque {
                constants.push(sum(0));
                sizes.push(size);
                continue;
            }
            let (ahead, against) = (sum(1), sum(-1));
            let mut x = [Complex64::default(); FUNCTIONS];
            let mut y = x;
            for k in 0..FUNCTIONS {
                let (ahead, against) = (ahead[k] * forward, against[k] * backward);
                x[k] = ahead + against;
                y[k] = -i * (ahead - against);
            }
            match self.quantity {
                Quantity::Moment => constants.extend([y.map(|z| -z), x]),
                _ => constants.extend([x, y]),
            }
            sizes.extend([size, size]);
        }
        Terms { constants, sizes }
    }

    /// Σ weight·e^{i(turn·bank − n·tdc)} as constants of the functions of half the bank angle: slots
    /// 0 and 1 (2 and 3 for turn < 0) are cosine and sine.
    fn functions(
        &self,
        members: &[&Placement],
        order: u32,
        turn: i64,
        weight: impl Fn(&Placement) -> f64,
    ) -> [Complex64; FUNCTIONS] {
        let n = i64::from(order);
        let mut constants = [Complex64::default(); FUNCTIONS];
        let Some((banks, hold)) = self.frame else {
            constants[0] = members
                .iter()
                .map(|p| p.bank.cis(turn) * p.tdc.cis(-n) * weight(p))
                .sum();
            return constants;
        };
        // With the pins held the phase turns with the bank: e^{i(turn − n)·bank} e^{in·pin}.
        let multiple = match hold {
            Hold::Pins => turn - n,
            Hold::Firing => turn,
        };
        let (mut right, mut left) = (Complex64::default(), Complex64::default());
        for p in members {
            let unit = match hold {
                Hold::Pins => p.pin().cis(n),
                Hold::Firing => p.tdc.cis(-n),
            };
            *if p.bank == banks.right { &mut right } else { &mut left } += unit * weight(p);
        }
        let bisector: Angle = banks.bisector();
        let middle = bisector.cis(multiple);
        // Bores at bisector ∓ γ: e^{−i·m·γ} right + e^{i·m·γ} left.
        let slot = if turn < 0 { 2 } else { 0 };
        constants[slot] = middle * (right + left);
        constants[slot + 1] = Complex64::i() * middle * (left - right);
        constants
    }
}

/// Layout sums of one engine at one point, for up to [`BLOCK`] bank angles.
struct Block {
    count: usize,
    /// Cosine and sine of the multiples of γ, per order: [order][function][angle].
    functions: Vec<[[f64; BLOCK]; FUNCTIONS]>,
    constants: Vec<[Complex64; FUNCTIONS]>,
    bounds: Vec<f64>,
    /// The sums: [channel][angle].
    re: Vec<[f64; BLOCK]>,
    im: Vec<[f64; BLOCK]>,
    components: usize,
}

impl Block {
    fn new(plan: &Plan) -> Self {
        let channels = plan.channels();
        Self {
            count: 0,
            functions: vec![[[0.0; BLOCK]; FUNCTIONS]; plan.orders.len()],
            constants: vec![[Complex64::default(); FUNCTIONS]; channels],
            bounds: vec![0.0; channels],
            re: vec![[0.0; BLOCK]; channels],
            im: vec![[0.0; BLOCK]; channels],
            components: plan.components,
        }
    }

    /// The functions of γ at these bank angles.
    #[inline(always)]
    fn set_angles(&mut self, plan: &Plan, bank_angles: &[f64]) {
        self.count = bank_angles.len();
        let Some(hold) = plan.hold else {
            for functions in &mut self.functions {
                functions[0][..self.count].fill(1.0);
            }
            return;
        };
        let mut multiple = [0.0; BLOCK];
        for (&order, functions) in plan.orders.iter().zip(&mut self.functions) {
            let n = f64::from(order);
            let turns = match (hold, plan.components) {
                (Hold::Pins, 1) => [-n, 0.0],
                (Hold::Pins, _) => [1.0 - n, -1.0 - n],
                (Hold::Firing, 1) => [0.0, 0.0],
                (Hold::Firing, _) => [1.0, -1.0],
            };
            for (turn, pair) in turns.into_iter().zip(functions.chunks_exact_mut(2)) {
                for (multiple, angle) in multiple.iter_mut().zip(bank_angles) {
                    *multiple = 0.5 * turn * angle;
                }
                let [cos, sin] = pair else { continue };
                sin_cos_degrees(&multiple, sin, cos);
            }
        }
    }

    /// Four functions times four constants, for every channel and angle.
    #[inline(always)]
    fn evaluate(&mut self) {
        for (channel, constants) in self.constants.iter().enumerate() {
            let [a, b, c, d] = &self.functions[channel / self.components];
            let [ka, kb, kc, kd] = constants;
            let (re, im) = (&mut self.re[channel], &mut self.im[channel]);
            for i in 0..BLOCK {
                re[i] = a[i] * ka.re + b[i] * kb.re + (c[i] * kc.re + d[i] * kd.re);
                im[i] = a[i] * ka.im + b[i] * kb.im + (c[i] * kc.im + d[i] * kd.im);
            }
        }
    }

    fn phasor(&self, channel: usize, i: usize) -> Complex64 {
        Complex64::new(self.re[channel][i], self.im[channel][i])
    }

    /// All orders of one component at one angle.
    fn orders(&self, component: usize, components: usize, i: usize) -> Vec<Complex64> {
        (component..self.bounds.len())
            .step_by(components)
            .map(|channel| snapped(self.phasor(channel, i), self.bounds[channel]))
            .collect()
    }

    /// Magnitudes, channels side by side: out[angle][channel].
    #[inline(always)]
    fn magnitudes(&self, out: &mut [f64]) {
        let channels = self.bounds.len();
        let mut columns = [[0.0; BLOCK]; FUNCTIONS];
        for first in (0..channels).step_by(FUNCTIONS) {
            let here = FUNCTIONS.min(channels - first);
            for (k, column) in columns.iter_mut().enumerate().take(here) {
                let (re, im) = (&self.re[first + k], &self.im[first + k]);
                let bound = self.bounds[first + k] * self.bounds[first + k];
                for i in 0..BLOCK {
                    let square = re[i] * re[i] + im[i] * im[i];
                    column[i] = if square > bound { square.sqrt() } else { 0.0 };
                }
            }
            if here == FUNCTIONS && channels == FUNCTIONS {
                // The common case in one pass: four channels, written in order.
                let [a, b, c, d] = &columns;
                for (i, row) in out.chunks_exact_mut(FUNCTIONS).enumerate().take(BLOCK) {
                    (row[0], row[1], row[2], row[3]) = (a[i], b[i], c[i], d[i]);
                }
            } else {
                for (i, row) in out.chunks_exact_mut(channels).enumerate().take(BLOCK) {
                    for k in 0..here {
                        row[first + k] = columns[k][i];
                    }
                }
            }
        }
    }
}

/// One pass over all points.
struct Run<'a> {
    plan: &'a Plan<'a>,
    squares: &'a [f64],
    /// Points of rod ratio and pin offset.
    points: usize,
    /// Numbers to a point and speed.
    width: usize,
    cancel: &'a Cancel,
}

impl Run<'_> {
    /// Blocks of bank angles, each for all engines, in parallel.
    fn over_bank_angles<T>(
        &self,
        bank_angles: &[f64],
        values: &mut [T],
        finish: &(impl Fn(&Block, &mut [T]) + Sync),
    ) -> Result<()>
    where
        T: Copy + Default + Send + Sync + std::ops::Mul<f64, Output = T>,
    {
        let row = self.points * self.squares.len() * self.width;
        let large = values.len() >= WORTH_A_THREAD;
        let mut by_engine: Vec<_> = values
            .chunks_mut(bank_angles.len() * row)
            .map(|engine| engine.chunks_mut(BLOCK * row))
            .collect();
        let tasks: Vec<(&[f64], Vec<&mut [T]>)> = bank_angles
            .chunks(BLOCK)
            .map(|angles| (angles, by_engine.iter_mut().filter_map(Iterator::next).collect()))
            .collect();
        let work = |block: &mut Block, (angles, outs): (&[f64], Vec<&mut [T]>)| -> Result<()> {
            vectorised(
                #[inline(always)]
                || {
                    block.set_angles(self.plan, angles);
                    for (engine, out) in outs.into_iter().enumerate() {
                        self.cancel.check()?;
                        self.engine_block(engine, block, out, finish);
                    }
                    Ok(())
                },
            )
        };
        if large {
            tasks.into_par_iter().try_for_each_init(|| Block::new(self.plan), work)
        } else {
            let mut block = Block::new(self.plan);
            tasks.into_iter().try_for_each(|task| work(&mut block, task))
        }
    }

    /// One engine at the block's bank angles: every point of the other axes.
    #[inline(always)]
    fn engine_block<T>(
        &self,
        engine: usize,
        block: &mut Block,
        out: &mut [T],
        finish: &(impl Fn(&Block, &mut [T]) + Sync),
    ) where
        T: Copy + Default + std::ops::Mul<f64, Output = T>,
    {
        let (speeds, width) = (self.squares.len(), self.width);
        if self.points * speeds == 1 {
            self.plan.combined(engine, 0, self.squares[0], block);
            block.evaluate();
            finish(block, out);
            return;
        }
        let mut unscaled = vec![T::default(); block.count * width];
        for point in 0..self.points {
            self.plan.combined(engine, point, 1.0, block);
            block.evaluate();
            finish(block, &mut unscaled);
            for (i, values) in unscaled.chunks_exact(width).enumerate() {
                let start = (i * self.points + point) * speeds * width;
                let rows = &mut out[start..start + speeds * width];
                scale(values, self.squares, rows);
            }
        }
    }

    /// Few bank angles or none: runs of the other points, in parallel.
    fn over_other_axes<T>(
        &self,
        bank_angles: &[f64],
        speeds: usize,
        values: &mut [T],
        finish: &(impl Fn(&Block, &mut [T]) + Sync),
    ) -> Result<()>
    where
        T: Copy + Default + Send + Sync + std::ops::Mul<f64, Output = T>,
    {
        let width = self.width;
        let large = values.len() >= WORTH_A_THREAD;
        let tasks: Vec<(usize, usize, &mut [T])> = values
            .chunks_mut(self.points * speeds * width)
            .enumerate()
            .flat_map(|(engine, out)| {
                let parts = out.chunks_mut(POINTS * width).enumerate();
                parts.map(move |(part, out)| (engine, part * POINTS, out))
            })
            .collect();
        let work = |block: &mut Block, (engine, first, out): (usize, usize, &mut [T])| -> Result<()> {
            self.cancel.check()?;
            block.set_angles(self.plan, bank_angles);
            let mut unscaled = vec![T::default(); width];
            let (mut at, mut rest) = (first, out);
            while !rest.is_empty() {
                let (point, speed) = (at / speeds, at % speeds);
                let here = (speeds - speed).min(rest.len() / width);
                self.plan.combined(engine, point, 1.0, block);
                block.evaluate();
                finish(block, &mut unscaled);
                let (rows, after) = rest.split_at_mut(here * width);
                scale(&unscaled, &self.squares[speed..speed + here], rows);
                (at, rest) = (at + here, after);
            }
            Ok(())
        };
        if large {
            tasks.into_par_iter().try_for_each_init(|| Block::new(self.plan), work)
        } else {
            let mut block = Block::new(self.plan);
            tasks.into_iter().try_for_each(|task| work(&mut block, task))
        }
    }
}

/// The values of one point at every speed.
#[inline(always)]
fn scale<T: Copy + std::ops::Mul<f64, Output = T>>(values: &[T], squares: &[f64], rows: &mut [T]) {
    for (&square, row) in squares.iter().zip(rows.chunks_exact_mut(values.len())) {
        for (out, &value) in row.iter_mut().zip(values) {
            *out = value * square;
        }
    }
}
