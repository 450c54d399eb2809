//! How an engine shakes, order by order: force, moment and roll torque as peak phasors.
//!
//! In the cross-section plane force and moment are complex numbers x + iy, and each order is
//! `forward·e^{inθ} + backward·e^{−inθ}`: a part that turns with the crank and one against it. With
//! w = m·r and `aₙ` the slider-crank's harmonics, the reciprocating masses give
//! `forward = aₙ/2 Σ w e^{i(bank − n·tdc)}` and `backward = conj(aₙ/2 Σ w e^{−i(bank + n·tdc)})`; rotating
//! mass turns forward with its pin at order 1. Since the moment is r × F, that of a cylinder is
//! i·(z − z₀) times its force.

use ndarray::{Array1, Array2};

use crate::Complex64;
use crate::engine::{Engine, Placement};
use crate::error::{Error, Result};
use crate::extrema::PeakFinder;
use crate::harmonics;
use crate::limits;
use crate::slider_crank::{Cylinder, Proportions};
use crate::spectrum::Spectrum;

/// Which orders to give.
#[derive(Debug, Clone, PartialEq)]
pub enum Orders {
    /// These.
    Given(Vec<u32>),
    /// The fewest that leave out at most this part of the largest m·r·ω² of a cylinder (times the
    /// longest lever, for moments, and the crank radius, for torque).
    Auto {
        /// Relative tolerance.
        rtol: f64,
    },
}

/// Force and moment of one kind, order by order.
#[derive(Debug, Clone, PartialEq)]
pub struct Shake {
    /// Peak phasors along (about) x and y: (`n_orders`, 2).
    pub xy: Array2<Complex64>,
    /// Coefficients of `e^{inθ}`: (`n_orders`,).
    pub forward: Array1<Complex64>,
    /// Coefficients of `e^{−inθ}`: (`n_orders`,).
    pub backward: Array1<Complex64>,
    /// What rounding can leave of a sum that vanishes; phasors below it are given as zero.
    pub zero_bound: Array1<f64>,
    /// What the orders left out can add to the length of the vector at any crank angle; 0 for
    /// orders that were asked for by number.
    pub error_bound: f64,
}

/// Roll torque, order by order.
#[derive(Debug, Clone, PartialEq)]
pub struct Torque {
    /// On the block, about +z: peak phasors, (`n_orders`,).
    pub roll: Array1<Complex64>,
    /// On the crank, about +z.
    pub crank: Array1<Complex64>,
    /// What rounding can leave of a sum that vanishes.
    pub zero_bound: Array1<f64>,
    /// What the orders left out can add to either torque at any crank angle.
    pub error_bound: f64,
}

/// How an engine shakes at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    /// Orders, ascending where they were chosen here.
    pub orders: Vec<u32>,
    /// Orders that were looked at and left out.
    pub omitted: Vec<u32>,
    /// Shaking force, N.
    pub force: Shake,
    /// Rocking moment, N·m.
    pub moment: Shake,
    /// Torque, N·m; a spectrum given by the user tells nothing of it.
    pub torque: Option<Torque>,
}

/// An ellipse traced by force or moment in one order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// Longest half axis.
    pub major: f64,
    /// Shortest half axis; below zero where the vector turns against the crank.
    pub minor: f64,
    /// Direction of the long axis from +x, radians in (−π/2, π/2]; 0 for a circle.
    pub tilt: f64,
}

impl Ellipse {
    /// From forward and backward parts.
    #[must_use]
    pub fn new(forward: Complex64, backward: Complex64) -> Self {
        let (f, b) = (forward.norm(), backward.norm());
        let tilt =
            if f == 0.0 || b == 0.0 { 0.0 } else { (forward * backward / (f * b)).sqrt().arg() };
        Self { major: f + b, minor: f - b, tilt }
    }
}

impl Shake {
    /// max over θ along x and y of the sum of all orders.
    #[must_use]
    pub fn peak_xy(&self, finder: &PeakFinder) -> [f64; 2] {
        [0, 1].map(|axis| finder.along_axis(&self.xy.column(axis).to_vec()))
    }

    /// max over θ of the length of the sum of all orders.
    #[must_use]
    pub fn peak_vector(&self, finder: &PeakFinder) -> f64 {
        finder.of_vector(&self.xy.column(0).to_vec(), &self.xy.column(1).to_vec())
    }
}

impl Balance {
    /// Length of force and moment and size of the larger torque of the k-th order.
    fn sizes(&self, k: usize) -> [f64; 3] {
        let length = |shake: &Shake| shake.forward[k].norm() + shake.backward[k].norm();
        let torque = self.torque.as_ref().map_or(0.0, |t| t.roll[k].norm().max(t.crank[k].norm()));
        [length(&self.force), length(&self.moment), torque]
    }
}

/// Angular speed in rad/s.
pub fn angular_speed(rpm: f64) -> Result<f64> {
    Ok(limits::not_negative("rpm", rpm)? * std::f64::consts::TAU / 60.0)
}

/// How the engine shakes at `rpm`, about the plane z = `reference_z` (default: half-way between
/// the first and the last cylinder). A spectrum stands in for every cylinder's slider-crank.
pub fn balance(
    engine: &Engine,
    rpm: f64,
    orders: &Orders,
    reference_z: Option<f64>,
    spectrum: Option<&Spectrum>,
) -> Result<Balance> {
    let omega = angular_speed(rpm)?;
    let reference = engine.reference(reference_z)?;
    match orders {
        Orders::Given(orders) => {
            limits::orders(orders)?;
            let cure = "give fewer orders";
            limits::result_size("orders", &[orders.len(), 8], size_of::<Complex64>(), cure)?;
            Ok(Sums::new(engine, reference, spectrum).balance(orders, omega))
        }
        Orders::Auto { rtol } => chosen(engine, omega, *rtol, reference, spectrum),
    }
}

/// The fewest orders within `rtol`.
fn chosen(
    engine: &Engine,
    omega: f64,
    rtol: f64,
    reference: f64,
    spectrum: Option<&Spectrum>,
) -> Result<Balance> {
    if !(1e-15..1.0).contains(&rtol) {
        return Err(Error::figure("rtol", rtol, "give a number from 1e-15 to below 1"));
    }
    let sums = Sums::new(engine, reference, spectrum);
    let count = engine.placements().len() as f64;
    let candidates = candidates(engine, &sums, 0.25 * rtol / count)?;
    let last = candidates.last().copied().unwrap_or(1);
    let whole = sums.balance(&candidates, omega);
    let tail = if spectrum.is_some() { [0.0; 3] } else { sums.tail(last, omega) };
    let allowed = sums.largest(reference).map(|largest| rtol * largest * omega * omega);
    // Each candidate's share of force, moment and torque.
    let sizes: Vec<[f64; 3]> = (0..candidates.len()).map(|k| whole.sizes(k)).collect();
    let weight = |&k: &usize| {
        let shares = sizes[k].iter().zip(&allowed);
        shares
            .map(|(&size, &allowed)| if size == 0.0 { 0.0 } else { size / allowed })
            .fold(0.0, f64::max)
    };
    let mut by_size: Vec<usize> = (0..candidates.len()).collect();
    by_size.sort_by(|a, b| weight(a).total_cmp(&weight(b)));
    let (mut bounds, mut left_out) = (tail, 0);
    for &k in &by_size {
        let more: [f64; 3] = std::array::from_fn(|i| bounds[i] + sizes[k][i]);
        if more.iter().zip(&allowed).any(|(more, allowed)| more > allowed) {
            break;
        }
        (bounds, left_out) = (more, left_out + 1);
    }
    let pick = |indices: &[usize]| {
        let mut picked: Vec<u32> = indices.iter().map(|&k| candidates[k]).collect();
        picked.sort_unstable();
        picked
    };
    let mut balance = sums.balance(&pick(&by_size[left_out..]), omega);
    balance.omitted = pick(&by_size[..left_out]);
    [balance.force.error_bound, balance.moment.error_bound] = [bounds[0], bounds[1]];
    if let Some(torque) = &mut balance.torque {
        torque.error_bound = bounds[2];
    }
    Ok(balance)
}

/// Orders that may matter: those of the spectrum, or all whose harmonics are not below `tolerance`.
fn candidates(engine: &Engine, sums: &Sums, tolerance: f64) -> Result<Vec<u32>> {
    if let Some(spectrum) = sums.spectrum {
        let mut orders = spectrum.orders();
        if !orders.contains(&1) && engine.placements().iter().any(|p| p.rotating_mass > 0.0) {
            orders.insert(0, 1);
        }
        return Ok(orders);
    }
    let mut highest = 1;
    for group in &sums.groups {
        highest = highest.max(harmonics::highest_order(&group.proportions, tolerance)?);
    }
    Ok((1..=highest).collect())
}

/// Cylinders whose slider-cranks have the same proportions, hence the same harmonics.
pub(crate) struct Group {
    pub proportions: Proportions,
    /// Indices into the engine's placements.
    pub members: Vec<usize>,
}

/// Group an engine's cylinders by their proportions.
pub(crate) fn groups(cylinders: impl Iterator<Item = Cylinder>) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (i, cylinder) in cylinders.enumerate() {
        let proportions = cylinder.proportions();
        match groups.iter_mut().find(|group| group.proportions == proportions) {
            Some(group) => group.members.push(i),
            None => groups.push(Group { proportions, members: vec![i] }),
        }
    }
    groups
}

/// What rounding can leave of a sum over `count` cylinders at order n, per unit of Σ|terms|.
///
/// Each angle comes with three roundings of half a unit of 360° (2.2 ε rad each), turned n-fold
/// in the phase and once in the direction; sines, products and weights add less than 8 ε, and the
/// summation (count − 1) ε.
pub(crate) fn zero_factor(count: usize, order: u32) -> f64 {
    (count as f64 + 16.0 + 8.0 * f64::from(order)) * f64::EPSILON
}

/// A sum is zero where it is within what rounding can leave.
pub(crate) fn snapped(sum: Complex64, bound: f64) -> Complex64 {
    if sum.norm() <= bound { Complex64::default() } else { sum }
}

/// Weighted sum of unit vectors along the bores, in phase with their cylinders.
#[derive(Clone, Copy, Default)]
struct Planar {
    x: Complex64,
    y: Complex64,
    forward: Complex64,
    /// Conjugate of the backward part.
    backward_conj: Complex64,
    /// Σ|terms|.
    size: f64,
}

impl Planar {
    fn add(&mut self, weight: f64, size: f64, bore: Complex64, phase: Complex64) {
        let term = phase * weight;
        self.x += term * bore.re;
        self.y += term * bore.im;
        self.forward += term * bore * 0.5;
        self.backward_conj += term * bore.conj() * 0.5;
        self.size += size;
    }

    /// A mass that turns with the pin: all of it forward.
    fn add_rotating(&mut self, weight: f64, size: f64, pin: Complex64) {
        let term = pin * weight;
        self.x += term;
        self.y += -Complex64::i() * term;
        self.forward += term;
        self.size += size;
    }

    fn add_scaled(&mut self, other: &Self, factor: Complex64) {
        self.x += other.x * factor;
        self.y += other.y * factor;
        self.forward += other.forward * factor;
        self.backward_conj += other.backward_conj * factor;
        self.size += other.size * factor.norm();
    }

    /// The same sum turned a quarter forward: the moment of levered forces.
    fn quarter_turned(&self) -> Self {
        let i = Complex64::i();
        Self {
            x: -self.y,
            y: self.x,
            forward: i * self.forward,
            backward_conj: -i * self.backward_conj,
            size: self.size,
        }
    }
}

/// Everything about an engine that does not depend on the order.
struct Sums<'a> {
    engine: &'a Engine,
    spectrum: Option<&'a Spectrum>,
    groups: Vec<Group>,
    bores: Vec<Complex64>,
    /// Lever about the reference plane, and the size its rounding is relative to.
    levers: Vec<(f64, f64)>,
}

impl<'a> Sums<'a> {
    fn new(engine: &'a Engine, reference: f64, spectrum: Option<&'a Spectrum>) -> Self {
        let placements = engine.placements();
        Self {
            engine,
            spectrum,
            groups: groups(placements.iter().map(|p| p.cylinder)),
            bores: placements.iter().map(|p| p.bank.cis(1)).collect(),
            levers: placements
                .iter()
                .map(|p| (p.z - reference, p.z.abs() + reference.abs()))
                .collect(),
        }
    }

    fn balance(&self, orders: &[u32], omega: f64) -> Balance {
        let square = omega * omega;
        let count = orders.len();
        let mut force = empty_shake(count);
        let mut moment = empty_shake(count);
        let harmonics: Vec<Vec<Complex64>> =
            self.groups.iter().map(|group| self.harmonics(group, orders)).collect();
        for (k, &n) in orders.iter().enumerate() {
            let (mut forces, mut levered) = (Planar::default(), Planar::default());
            for (group, harmonics) in self.groups.iter().zip(&harmonics) {
                if harmonics[k] == Complex64::default() {
                    continue;
                }
                let (group_forces, group_levered) = self.reciprocating(group, n);
                forces.add_scaled(&group_forces, harmonics[k]);
                levered.add_scaled(&group_levered, harmonics[k]);
            }
            if n == 1 {
                self.add_rotating(&mut forces, &mut levered);
            }
            let factor = zero_factor(self.bores.len(), n);
            store(&mut force, k, &forces, square, factor);
            store(&mut moment, k, &levered.quarter_turned(), square, factor);
        }
        let torque = self.spectrum.is_none().then(|| self.torque(orders, square));
        Balance { orders: orders.to_vec(), omitted: Vec::new(), force, moment, torque }
    }

    /// Amplitudes by which the layout sums of a group are multiplied.
    fn harmonics(&self, group: &Group, orders: &[u32]) -> Vec<Complex64> {
        match self.spectrum {
            Some(spectrum) => orders.iter().map(|&n| spectrum.amplitude(n)).collect(),
            None => harmonics::coefficients(&group.proportions, orders),
        }
    }

    fn reciprocating(&self, group: &Group, order: u32) -> (Planar, Planar) {
        let (mut forces, mut levered) = (Planar::default(), Planar::default());
        for &i in &group.members {
            let placement = &self.engine.placements()[i];
            // A spectrum in kg·m already has the mass and the radius in it.
            let weight =
                if self.spectrum.is_some() { 1.0 } else { placement.cylinder.first_order() };
            let phase = placement.tdc.cis(-i64::from(order));
            let (lever, lever_size) = self.levers[i];
            forces.add(weight, weight, self.bores[i], phase);
            levered.add(weight * lever, weight * lever_size, self.bores[i], phase);
        }
        (forces, levered)
    }

    fn add_rotating(&self, forces: &mut Planar, levered: &mut Planar) {
        for (placement, &(lever, lever_size)) in self.engine.placements().iter().zip(&self.levers) {
            let weight = placement.rotating_mass * placement.cylinder.crank_radius();
            if weight > 0.0 {
                let pin = placement.pin().cis(1);
                forces.add_rotating(weight, weight, pin);
                levered.add_rotating(weight * lever, weight * lever_size, pin);
            }
        }
    }

    fn torque(&self, orders: &[u32], square: f64) -> Torque {
        let mut torque = Torque {
            roll: Array1::default(orders.len()),
            crank: Array1::default(orders.len()),
            zero_bound: Array1::default(orders.len()),
            error_bound: 0.0,
        };
        for group in &self.groups {
            let harmonics = harmonics::torque::torque(&group.proportions, orders);
            for (k, &n) in orders.iter().enumerate() {
                let (mut sum, mut size) = (Complex64::default(), 0.0);
                for &i in &group.members {
                    let Placement { cylinder, tdc, .. } = &self.engine.placements()[i];
                    let weight = cylinder.first_order() * cylinder.crank_radius() * square;
                    sum += tdc.cis(-i64::from(n)) * weight;
                    size += weight;
                }
                torque.roll[k] += sum * harmonics.roll[k];
                torque.crank[k] += sum * harmonics.crank[k];
                torque.zero_bound[k] +=
                    size * harmonics.roll[k].norm().max(harmonics.crank[k].norm());
            }
        }
        for (k, &n) in orders.iter().enumerate() {
            torque.zero_bound[k] *= zero_factor(self.bores.len(), n);
            torque.roll[k] = snapped(torque.roll[k], torque.zero_bound[k]);
            torque.crank[k] = snapped(torque.crank[k], torque.zero_bound[k]);
        }
        torque
    }

    /// What orders above `highest` can add to force, moment and torque.
    fn tail(&self, highest: u32, omega: f64) -> [f64; 3] {
        let mut tail = [0.0; 3];
        for Group { proportions, members } in &self.groups {
            let known = |bound: Option<f64>| bound.unwrap_or(f64::INFINITY) * omega * omega;
            let force = known(harmonics::tail_bound(proportions, highest));
            let torque = known(harmonics::torque::tail_bound(proportions, highest));
            for &i in members {
                let cylinder = self.engine.placements()[i].cylinder;
                let first_order = cylinder.first_order();
                tail[0] += first_order * force;
                tail[1] += first_order * force * self.levers[i].0.abs();
                tail[2] += first_order * cylinder.crank_radius() * torque;
            }
        }
        tail
    }

    /// Largest m·r of a cylinder, times the longest lever, times its crank radius.
    fn largest(&self, reference: f64) -> [f64; 3] {
        let mut largest = [0.0_f64; 3];
        for p in self.engine.placements() {
            let radius = p.cylinder.crank_radius();
            let force = p.cylinder.first_order().max(p.rotating_mass * radius);
            largest[0] = largest[0].max(force);
            largest[2] = largest[2].max(force * radius);
        }
        largest[1] = largest[0] * self.engine.longest_lever(reference);
        largest
    }
}

fn empty_shake(count: usize) -> Shake {
    Shake {
        xy: Array2::default((count, 2)),
        forward: Array1::default(count),
        backward: Array1::default(count),
        zero_bound: Array1::default(count),
        error_bound: 0.0,
    }
}

fn store(shake: &mut Shake, k: usize, sum: &Planar, square: f64, factor: f64) {
    let bound = sum.size * square * factor;
    shake.xy[[k, 0]] = snapped(sum.x * square, bound);
    shake.xy[[k, 1]] = snapped(sum.y * square, bound);
    shake.forward[k] = snapped(sum.forward * square, bound);
    shake.backward[k] = snapped(sum.backward_conj.conj() * square, bound);
    shake.zero_bound[k] = bound;
}
