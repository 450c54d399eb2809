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

    /// Largest crank radius of any cylinder, m.
    #[must_use]
    pub fn largest_crank_radius(&self) -> f64 {
        self.engines.iter().map(Engine::largest_crank_radius).fold(0.0, f64::max)
    }

    /// Peak phasors of each order: (…, `n_orders`, components).
    pub fn phasors(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<Complex64>> {
        let components = quantity.components();
        self.fill(quantity, &[self.orders.len(), components], cancel, |block, out| {
            for (i, row) in out.chunks_exact_mut(self.orders.len() * components).enumerate() {
                for (order, phasors) in row.chunks_exact_mut(components).enumerate() {
                    phasors.copy_from_slice(&block.phasors(order, i)[..components]);
                }
            }
        })
    }

    /// max over θ of each order along (about) each axis: (…, `n_orders`, components).
    pub fn peaks(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<f64>> {
        let tail = [self.orders.len(), quantity.components()];
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
            for (i, row) in out.chunks_exact_mut(orders).enumerate() {
                for (order, length) in row.iter_mut().enumerate() {
                    let bound = block.bounds[order];
                    let [forward, backward] = block.turning(order, i);
                    *length = snapped(forward, bound).norm() + snapped(backward, bound).norm();
                }
            }
        })
    }

    /// max over θ of the sum of orders along (about) each axis: (…, components).
    pub fn sum_peaks(&self, quantity: Quantity, cancel: &Cancel) -> Result<Values<f64>> {
        let components = quantity.components();
        let finder = PeakFinder::new(&self.orders);
        self.fill(quantity, &[components], cancel, |block, out| {
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
            for (i, peak) in out.iter_mut().enumerate() {
                let [x, y] = block.by_component(i);
                *peak = finder.of_vector(&x, &y);
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
        let [_, angles, ratios, offsets, _] = self.shape();
        let width: usize = tail.iter().product();
        let run = Run { plan: &plan, squares: &self.squares, points: ratios * offsets, width, cancel };
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

/// Layout sums of one order as constants of those functions: two for the part that turns with the
/// crank and two for (the conjugate of) the part that turns against it.
type Constants = [Complex64; FUNCTIONS];

/// A sum over cylinders, order by order.
struct Terms {
    constants: Vec<Constants>,
    /// Σ|terms|.
    sizes: Vec<f64>,
}

/// One engine: cylinders that share their harmonics, and what turns with the pins.
struct EnginePlan {
    /// Layout sums, and harmonics by (point of rod ratio and offset, order).
    groups: Vec<(Terms, Array2<Complex64>)>,
    rotating: Option<Terms>,
    /// What rounding can leave, relative to Σ|terms|.
    zero_factors: Vec<f64>,
}

/// All that does not depend on the bank angle.
struct Plan<'a> {
    orders: &'a [u32],
    hold: Option<Hold>,
    engines: Vec<EnginePlan>,
    quantity: Quantity,
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
        Ok(Self { orders: &sweep.orders, hold, engines, quantity })
    }

    /// Layout sums of an engine times its harmonics at a point, all groups together.
    fn combined(&self, engine: usize, point: usize) -> Terms {
        let plan = &self.engines[engine];
        let (mut constants, mut sizes) = (Vec::new(), Vec::new());
        for order in 0..self.orders.len() {
            let (mut sum, mut size) = (Constants::default(), 0.0);
            let mut add = |terms: &Terms, factor: Complex64| {
                // The part that turns backward was conjugated, its harmonic was not.
                for (sum, constant) in sum.iter_mut().zip(&terms.constants[order]) {
                    *sum += constant * factor;
                }
                size += terms.sizes[order] * factor.norm();
            };
            for (terms, harmonics) in &plan.groups {
                add(terms, harmonics[[point, order]]);
            }
            if let Some(terms) = &plan.rotating {
                add(terms, Complex64::new(1.0, 0.0));
            }
            constants.push(sum);
            sizes.push(size * plan.zero_factors[order]);
        }
        Terms { constants, sizes }
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
            let terms = layout.terms(&members, weight, [0.5, 0.5]);
            Ok((terms, sweep.harmonics(&cylinder, quantity, cancel)?))
        });
        let groups = groups.collect::<Result<_>>()?;
        let turning: Vec<&Placement> = placements
            .iter()
            .filter(|p| p.rotating_mass > 0.0 && quantity != Quantity::Torque)
            .collect();
        let rotating = (!turning.is_empty() && sweep.orders.contains(&1)).then(|| {
            // A mass on the pin: its force is all forward, and of order 1.
            let weight = |p: &Placement| p.rotating_mass * p.cylinder.crank_radius();
            let mut terms = layout.terms(&turning, weight, [1.0, 0.0]);
            for (k, &order) in sweep.orders.iter().enumerate() {
                if order != 1 {
                    terms.constants[k] = Constants::default();
                    terms.sizes[k] = 0.0;
                }
            }
            terms
        });
        let zero_factors = sweep.orders.iter().map(|&n| zero_factor(placements.len(), n)).collect();
        Ok(Self { groups, rotating, zero_factors })
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
    /// Σ weight·e^{±i·bank}·e^{−in·tdc} times the shares of force that turn with and against the
    /// crank; for torque Σ weight·e^{−in·tdc}.
    fn terms(
        &self,
        members: &[&Placement],
        weight: impl Fn(&Placement) -> f64,
        shares: [f64; 2],
    ) -> Terms {
        let lever = |p: &Placement| match self.quantity {
            Quantity::Moment => (p.z - self.reference, p.z.abs() + self.reference.abs()),
            _ => (1.0, 1.0),
        };
        // Rounding of a lever is relative to what it is the difference of.
        let size: f64 = members.iter().map(|p| weight(p) * lever(p).1).sum();
        let constants = self.orders.iter().map(|&n| {
            if self.quantity == Quantity::Torque {
                let [[cos, sin]] = self.functions(members, n, [0], |p| weight(p) * lever(p).0);
                return [cos, sin, Complex64::default(), Complex64::default()];
            }
            let [ahead, against] =
                self.functions(members, n, [1, -1], |p| weight(p) * lever(p).0);
            [ahead[0] * shares[0], ahead[1] * shares[0], against[0] * shares[1], against[1] * shares[1]]
        });
        Terms { constants: constants.collect(), sizes: vec![size; self.orders.len()] }
    }

    /// Σ weight·e^{i(turn·bank − n·tdc)} for each turn, as constants of cosine and sine of a multiple
    /// of half the bank angle.
    fn functions<const TURNS: usize>(
        &self,
        members: &[&Placement],
        order: u32,
        turns: [i64; TURNS],
        weight: impl Fn(&Placement) -> f64,
    ) -> [[Complex64; 2]; TURNS] {
        let n = i64::from(order);
        let Some((banks, hold)) = self.frame else {
            let mut sums = [[Complex64::default(); 2]; TURNS];
            for p in members {
                let term = p.tdc.cis(-n) * weight(p);
                for (sum, &turn) in sums.iter_mut().zip(&turns) {
                    sum[0] += term * p.bank.cis(turn);
                }
            }
            return sums;
        };
        let (mut right, mut left) = (Complex64::default(), Complex64::default());
        for p in members {
            // e^{in·pin}, or e^{−in·tdc}.
            let unit = match hold {
                Hold::Pins => p.bank.cis(n) * p.tdc.cis(-n),
                Hold::Firing => p.tdc.cis(-n),
            };
            *if p.bank == banks.right { &mut right } else { &mut left } += unit * weight(p);
        }
        turns.map(|turn| {
            // With the pins held the phase turns with the bank: e^{i(turn − n)·bank} e^{in·pin}.
            let multiple = match hold {
                Hold::Pins => turn - n,
                Hold::Firing => turn,
            };
            let middle = banks.bisector().cis(multiple);
            // Bores at bisector ∓ γ: e^{−i·m·γ} right + e^{i·m·γ} left.
            [middle * (right + left), Complex64::i() * middle * (left - right)]
        })
    }
}

/// Powers of `e^{iγ}` up to here come from multiplication, within the allowance of the zero bound.
const MOST_MULTIPLIED: u32 = 16;

/// One column of a block.
type Column = [f64; BLOCK];

/// Layout sums of one engine at one point, for up to [`BLOCK`] bank angles.
struct Block {
    quantity: Quantity,
    count: usize,
    /// Cosine and sine of the multiples of γ, two pairs to an order.
    functions: Vec<[Column; FUNCTIONS]>,
    /// What rounding can leave, by order.
    bounds: Vec<f64>,
    /// Real and imaginary part of what turns with the crank and of the conjugate of what turns
    /// against it (of the torque and nothing), by order.
    sums: Vec<[Column; FUNCTIONS]>,
}

impl Block {
    fn new(plan: &Plan) -> Self {
        let empty = vec![[[0.0; BLOCK]; FUNCTIONS]; plan.orders.len()];
        Self {
            quantity: plan.quantity,
            count: 0,
            functions: empty.clone(),
            bounds: vec![0.0; plan.orders.len()],
            sums: empty,
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
        let mut half = [0.0; BLOCK];
        for (half, angle) in half.iter_mut().zip(bank_angles) {
            *half = 0.5 * angle;
        }
        let (mut sin, mut cos) = ([0.0; BLOCK], [0.0; BLOCK]);
        sin_cos_degrees(&half, &mut sin, &mut cos);
        // Powers are reached from the last one, orders being mostly ascending.
        let (mut power, mut power_cos, mut power_sin) = (1, cos, sin);
        for (&order, functions) in plan.orders.iter().zip(&mut self.functions) {
            let n = i64::from(order);
            let turns = match (hold, plan.quantity) {
                (Hold::Pins, Quantity::Torque) => [-n, 0],
                (Hold::Pins, _) => [1 - n, -1 - n],
                (Hold::Firing, Quantity::Torque) => [0, 0],
                (Hold::Firing, _) => [1, -1],
            };
            for (turn, pair) in turns.into_iter().zip(functions.chunks_exact_mut(2)) {
                let [out_cos, out_sin] = pair else { continue };
                let multiple = turn.unsigned_abs() as u32;
                let sign = if turn < 0 { -1.0 } else { 1.0 };
                if multiple == 0 {
                    out_cos.fill(1.0);
                    out_sin.fill(0.0);
                    continue;
                }
                if multiple > MOST_MULTIPLIED {
                    let multiples = half.map(|angle| angle * turn as f64);
                    sin_cos_degrees(&multiples, out_sin, out_cos);
                    continue;
                }
                if multiple < power {
                    (power, power_cos, power_sin) = (1, cos, sin);
                }
                while power < multiple {
                    for i in 0..BLOCK {
                        let (re, im) = (power_cos[i], power_sin[i]);
                        power_cos[i] = re * cos[i] - im * sin[i];
                        power_sin[i] = re * sin[i] + im * cos[i];
                    }
                    power += 1;
                }
                *out_cos = power_cos;
                for i in 0..BLOCK {
                    out_sin[i] = sign * power_sin[i];
                }
            }
        }
    }

    /// Functions times constants, for every order and angle.
    #[inline(always)]
    fn evaluate(&mut self, terms: &Terms, scale: f64) {
        for (order, constants) in terms.constants.iter().enumerate() {
            self.bounds[order] = terms.sizes[order] * scale;
            let [ka, kb, kc, kd] = constants.map(|constant| constant * scale);
            let [a, b, c, d] = &self.functions[order];
            let [ahead_re, ahead_im, against_re, against_im] = &mut self.sums[order];
            for i in 0..BLOCK {
                ahead_re[i] = a[i].mul_add(ka.re, b[i] * kb.re);
                ahead_im[i] = a[i].mul_add(ka.im, b[i] * kb.im);
                against_re[i] = c[i].mul_add(kc.re, d[i] * kd.re);
                against_im[i] = c[i].mul_add(kc.im, d[i] * kd.im);
            }
        }
    }

    /// Forward and conjugate of backward part of force or moment (torque and nothing).
    fn turning(&self, order: usize, i: usize) -> [Complex64; 2] {
        let [a, b, c, d] = &self.sums[order];
        [Complex64::new(a[i], b[i]), Complex64::new(c[i], d[i])]
    }

    /// Phasors of the components (for torque the first is it), zero where rounding is all there is.
    fn phasors(&self, order: usize, i: usize) -> [Complex64; 2] {
        let [ahead, against] = self.turning(order, i);
        let (along, across) = (ahead + against, -Complex64::i() * (ahead - against));
        // A moment is its levered force turned by a quarter.
        let components = match self.quantity {
            Quantity::Moment => [-across, along],
            _ => [along, across],
        };
        components.map(|phasor| snapped(phasor, self.bounds[order]))
    }

    /// Phasors of all orders at one angle, component by component.
    fn by_component(&self, i: usize) -> [Vec<Complex64>; 2] {
        let phasors: Vec<_> = (0..self.bounds.len()).map(|order| self.phasors(order, i)).collect();
        [0, 1].map(|component| phasors.iter().map(|both| both[component]).collect())
    }

    /// Magnitudes of the phasors: out[angle][order][component].
    #[inline(always)]
    fn peaks(&self, out: &mut [f64]) {
        let components = self.quantity.components();
        let width = self.bounds.len() * components;
        // Two orders at a time, so that rows are written four numbers at once.
        let mut columns = [[0.0; BLOCK]; 4];
        for first in (0..self.bounds.len()).step_by(2) {
            let orders = (self.bounds.len() - first).min(2);
            for (order, pair) in (first..).zip(columns.chunks_exact_mut(2)).take(orders) {
                let [along, across] = pair else { continue };
                match self.quantity {
                    Quantity::Moment => self.magnitudes(order, across, along),
                    _ => self.magnitudes(order, along, across),
                }
            }
            let [a, b, c, d] = &columns;
            let rows = out.chunks_exact_mut(width);
            match (orders * components, width) {
                (4, 4) => {
                    let (rows, _) = out.as_chunks_mut::<4>();
                    for (i, row) in rows.iter_mut().enumerate().take(BLOCK) {
                        *row = [a[i], b[i], c[i], d[i]];
                    }
                }
                (4, _) => rows.zip(0..BLOCK).for_each(|(row, i)| {
                    row[2 * first..2 * first + 4].copy_from_slice(&[a[i], b[i], c[i], d[i]]);
                }),
                (2, _) if components == 2 => rows.zip(0..BLOCK).for_each(|(row, i)| {
                    row[2 * first..].copy_from_slice(&[a[i], b[i]]);
                }),
                (2, _) => rows.zip(0..BLOCK).for_each(|(row, i)| {
                    row[first..first + 2].copy_from_slice(&[a[i], c[i]]);
                }),
                _ => rows.zip(0..BLOCK).for_each(|(row, i)| row[first] = a[i]),
            }
        }
    }

    /// |forward + conj backward| and |forward − conj backward| of one order.
    #[inline(always)]
    fn magnitudes(&self, order: usize, along: &mut Column, across: &mut Column) {
        let [ahead_re, ahead_im, against_re, against_im] = &self.sums[order];
        let bound = self.bounds[order] * self.bounds[order];
        for i in 0..BLOCK {
            let (re, im) = (ahead_re[i] + against_re[i], ahead_im[i] + against_im[i]);
            let square = re.mul_add(re, im * im);
            along[i] = if square > bound { square.sqrt() } else { 0.0 };
            let (re, im) = (ahead_re[i] - against_re[i], ahead_im[i] - against_im[i]);
            let square = re.mul_add(re, im * im);
            across[i] = if square > bound { square.sqrt() } else { 0.0 };
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
        // With one point to an engine its constants serve every block.
        let engines = 0..self.plan.engines.len();
        let single: Vec<Terms> = if self.points == 1 {
            engines.map(|engine| self.plan.combined(engine, 0)).collect()
        } else {
            Vec::new()
        };
        let work = |block: &mut Block, (angles, outs): (&[f64], Vec<&mut [T]>)| -> Result<()> {
            vectorised(
                #[inline(always)]
                || {
                    block.set_angles(self.plan, angles);
                    for (engine, out) in outs.into_iter().enumerate() {
                        self.cancel.check()?;
                        if let (Some(terms), [square]) = (single.get(engine), self.squares) {
                            block.evaluate(terms, *square);
                            finish(block, out);
                        } else {
                            self.engine_block(engine, block, out, finish);
                        }
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
        let mut unscaled = vec![T::default(); block.count * width];
        for point in 0..self.points {
            block.evaluate(&self.plan.combined(engine, point), 1.0);
            finish(block, &mut unscaled);
            for (i, values) in unscaled.chunks_exact(width).enumerate() {
                let start = (i * self.points + point) * speeds * width;
                scale(values, self.squares, &mut out[start..start + speeds * width]);
            }
        }
    }

    /// Few bank angles or none: runs of the other points, in parallel.
    fn over_other_axes<T>(
        &self,
        bank_angles: &[f64],
        values: &mut [T],
        finish: &(impl Fn(&Block, &mut [T]) + Sync),
    ) -> Result<()>
    where
        T: Copy + Default + Send + Sync + std::ops::Mul<f64, Output = T>,
    {
        let (speeds, width) = (self.squares.len(), self.width);
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
                block.evaluate(&self.plan.combined(engine, point), 1.0);
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
