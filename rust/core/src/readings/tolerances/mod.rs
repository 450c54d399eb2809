//! Residual forces and moments of an engine whose parts deviate from their figures, sample by sample.

mod terms;

use self::terms::Terms;
use crate::Complex64;
use crate::engine::Engine;
use crate::load::Scene;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::pool;
use crate::readings::balance::{
    Balance, ErrorBounds, Orders, Request, Vector, angular_speed, balance,
};
use crate::readings::choice;
use crate::readings::peaks::PeakFinder;
use crate::wrench::Planar;

/// A figure that may spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameter {
    /// Mass that moves with the piston, of each cylinder, kg.
    ReciprocatingMass,
    /// Mass that turns at crank radius, of each cylinder, kg.
    RotatingMass,
    /// Crank radius of each pin, m.
    CrankRadius,
    /// Direction of each pin, degrees.
    Pin,
    /// Place of each cylinder along the crank, m.
    Z,
    /// Rod length of each cylinder, m.
    RodLength,
}

/// Number of figures.
pub const FIGURES: usize = 6;

impl Parameter {
    /// All figures, in the order of their random streams.
    pub const ALL: [Self; FIGURES] = [
        Self::ReciprocatingMass,
        Self::RotatingMass,
        Self::CrankRadius,
        Self::Pin,
        Self::Z,
        Self::RodLength,
    ];

    /// Name as callers know it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ReciprocatingMass => "reciprocating_mass",
            Self::RotatingMass => "rotating_mass",
            Self::CrankRadius => "crank_radius",
            Self::Pin => "pin_deg",
            Self::Z => "z",
            Self::RodLength => "rod_length",
        }
    }

    /// Whether it is a figure of each pin, not of each cylinder.
    #[must_use]
    pub fn of_pin(self) -> bool {
        matches!(self, Self::CrankRadius | Self::Pin)
    }
}

/// Samples evaluated side by side.
const SAMPLES_AT_ONCE: usize = 128;

/// Deviations of each of [`Parameter::ALL`] in some samples, one row of cylinders or pins after the other;
/// empty where none deviates.
pub type Deviations<'a> = [&'a [f64]; FIGURES];

/// How figures deviate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distribution {
    /// Normal; a spread is the standard deviation.
    Normal,
    /// Uniform; a spread is half the width.
    Uniform,
}

impl Distribution {
    /// Largest magnitude of a deviation of spread 1.
    ///
    /// The tail of `NumPy`'s ziggurat beyond r = 3.654 is x = −ln u/r where −2·ln v > x², for u and v of
    /// 2⁻⁵³ at least: x² < 73.5.
    fn largest(self) -> f64 {
        match self {
            Self::Normal => 12.3,
            Self::Uniform => 1.0,
        }
    }
}

/// An engine whose figures may deviate, and the request for its samples; checked.
pub struct Tolerances {
    terms: Terms,
    nominal: Balance,
    /// ω².
    square: f64,
}

/// What remains of each sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// Force of each sample and order: peak phasors along x and y, forward and backward part.
    pub force: Vec<[Complex64; 4]>,
    /// The same of the moment.
    pub moment: Vec<[Complex64; 4]>,
    /// Torque of each sample and order on the block and on the crank; empty where it was not wanted.
    pub torque: Vec<[Complex64; 2]>,
    /// Of each sample the longest force and moment and the largest torques, all orders together.
    pub peaks: Vec<[f64; 4]>,
}

/// Orders of samples that leave out at most `rtol` of each cylinder, because deviations undo what a layout
/// cancels, and bounds of what the others add to the nominal engine; order 1 among them, which rotating
/// masses have that deviate.
pub fn orders(
    engine: &Engine,
    request: &Request,
    rtol: f64,
    cancel: &Cancel,
) -> Result<(Vec<Order>, ErrorBounds)> {
    check_without_gas(engine, request)?;
    let omega = angular_speed(request.rpm)?;
    let loads = Scene::of(engine, request.reference_z)?;
    let wanted = (request.torque, omega);
    let (mut orders, left_out) = choice::within_each(rtol, &loads, wanted, cancel)?;
    if orders.first() != Some(&Order::FIRST) && !orders.contains(&Order::FIRST) {
        orders.push(Order::FIRST);
        orders.sort_unstable();
    }
    Ok((orders, left_out))
}

/// Rejects torques of an engine with pressure, which do not deviate.
fn check_without_gas(engine: &Engine, request: &Request) -> Result<()> {
    if request.torque && engine.cycles_in_use() > 0 {
        return Err(Error::NoTorque(
            "tolerances do not count gas pressure; give `torque: false`, or `Engine::without_gas`",
        ));
    }
    Ok(())
}

impl Tolerances {
    /// Checks everything that can be wrong.
    ///
    /// `spreads` has for each of [`Parameter::ALL`] one of each cylinder or pin, or nothing; `pin_of` the
    /// pin of each cylinder, counted from 0.
    pub fn new(
        engine: &Engine,
        request: &Request,
        orders: &[Order],
        (spreads, distribution): (&[Vec<f64>; FIGURES], Distribution),
        pin_of: &[usize],
        cancel: &Cancel,
    ) -> Result<Self> {
        check_without_gas(engine, request)?;
        check_pins(engine, pin_of)?;
        for (figure, spreads) in Parameter::ALL.into_iter().zip(spreads) {
            check_spreads(engine, pin_of, figure, spreads)?;
        }
        check_reach(engine, pin_of, spreads, distribution.largest())?;
        let nominal = balance(engine, request, &Orders::Given(orders.to_vec()), cancel)?;
        let reference = engine.reference(request.reference_z)?;
        let terms = Terms::new(engine, pin_of, orders, reference, request.torque)?;
        let omega = angular_speed(request.rpm)?;
        Ok(Self { terms, nominal, square: omega * omega })
    }

    /// Rejects more samples than results may hold.
    pub fn check_size(&self, count: usize) -> Result<()> {
        let sizes = [count, self.nominal.orders.len(), 10];
        let hint = "ask for fewer samples or orders";
        limits::result_size("samples", &sizes, size_of::<Complex64>(), hint).map(drop)
    }

    /// What remains of some samples. A sample is the same whichever others are evaluated with it.
    pub fn sample(
        &self,
        count: usize,
        deviations: &Deviations,
        cancel: &Cancel,
    ) -> Result<Sampled> {
        let orders = self.nominal.orders.len();
        self.check_size(count)?;
        for (figure, values) in Parameter::ALL.into_iter().zip(deviations) {
            let expected = count * self.terms.count(figure);
            if !values.is_empty() {
                let found = values.len();
                limits::same_length(figure.name(), found, "the samples", expected, "deviation")?;
            }
        }
        let mut sampled = Sampled {
            force: memory::zeros(count * orders)?,
            moment: memory::zeros(count * orders)?,
            torque: memory::zeros(if self.nominal.has_torque { count * orders } else { 0 })?,
            peaks: memory::zeros(count)?,
        };
        let finder = PeakFinder::new(&self.nominal.orders)?;
        let Sampled { force, moment, torque, peaks } = &mut sampled;
        let mut torque = torque.chunks_mut(SAMPLES_AT_ONCE * orders);
        let planar = force
            .chunks_mut(SAMPLES_AT_ONCE * orders)
            .zip(moment.chunks_mut(SAMPLES_AT_ONCE * orders));
        let mut tasks = memory::with_capacity(count.div_ceil(SAMPLES_AT_ONCE))?;
        for (k, ((force, moment), peaks)) in
            planar.zip(peaks.chunks_mut(SAMPLES_AT_ONCE)).enumerate()
        {
            let torque = torque.next().unwrap_or_default();
            tasks.push((k * SAMPLES_AT_ONCE, Chunk { planar: [force, moment], torque, peaks }));
        }
        let work = |(first, out): (usize, Chunk)| {
            self.write((first, deviations), &finder, out, cancel)?;
            cancel.step()
        };
        cancel.expect(tasks.len());
        // An order of a sample takes as long as some sixty numbers of a sweep.
        pool::each(cancel, tasks, 60 * count * orders, work)?;
        Ok(sampled)
    }

    /// Writes the samples of a chunk.
    fn write(
        &self,
        (first, deviations): (usize, &Deviations),
        finder: &PeakFinder,
        out: Chunk,
        cancel: &Cancel,
    ) -> Result<()> {
        let orders = self.nominal.orders.len();
        let Chunk { planar: [force, moment], torque, peaks: longest } = out;
        self.terms.write_sums(deviations, first, cancel, |k, sums| {
            for i in 0..longest.len() {
                let at_order = i * orders + k;
                let vectors = [
                    (Vector::Force, &sums.force, &mut force[at_order]),
                    (Vector::Moment, &sums.moment, &mut moment[at_order]),
                ];
                for (vector, change, out) in vectors {
                    let nominal = self.nominal.planar(vector, k);
                    let planar = Planar {
                        forward: nominal.forward + at(&change[0], i) * self.square,
                        backward_conj: nominal.backward_conj + at(&change[1], i) * self.square,
                        bound: nominal.bound,
                    };
                    let [x, y] = planar.xy(planar.bound);
                    *out = [x, y, planar.forward, planar.backward()];
                }
                if self.nominal.has_torque {
                    let nominal = self.nominal.wrenches[k].torque;
                    let nominal = [nominal.roll, nominal.crank];
                    let sum =
                        |which: usize| nominal[which] + at(&sums.torque[which], i) * self.square;
                    torque[at_order] = [sum(0), sum(1)];
                }
            }
        })?;
        let mut by_component = vec![Complex64::default(); 6 * orders];
        for (i, longest) in longest.iter_mut().enumerate() {
            // Of force and moment along (about) x and y, of torque on block and crank.
            for (k, at_order) in (i * orders..(i + 1) * orders).enumerate() {
                let ([fx, fy, ..], [mx, my, ..]) = (force[at_order], moment[at_order]);
                let [roll, crank] = torque.get(at_order).copied().unwrap_or_default();
                for (component, value) in [fx, fy, mx, my, roll, crank].into_iter().enumerate() {
                    by_component[component * orders + k] = value;
                }
            }
            *longest = peaks(finder, &by_component, cancel)?;
        }
        Ok(())
    }
}

/// Longest force and moment, largest torques on block and crank, of phasors of one sample: of force and
/// moment along (about) x and y, of both torques, order by order.
fn peaks(finder: &PeakFinder, phasors: &[Complex64], cancel: &Cancel) -> Result<[f64; 4]> {
    let orders = phasors.len() / 6;
    let of = |component: usize| &phasors[component * orders..][..orders];
    let vector = |k: usize| finder.of_vector(of(2 * k), of(2 * k + 1), cancel);
    let (roll, crank) = (of(4), of(5));
    let on_block = finder.along_axis(roll, cancel)?;
    // Without pin offset, rod inertia and shafts beside the crank one is minus the other.
    let opposite = roll.iter().zip(crank).all(|(roll, crank)| *roll == -crank);
    let on_crank = if opposite { on_block } else { finder.along_axis(crank, cancel)? };
    Ok([vector(0)?, vector(1)?, on_block, on_crank])
}

/// Buffers of the samples of a chunk, as those of [`Sampled`].
struct Chunk<'a> {
    planar: [&'a mut [[Complex64; 4]]; 2],
    torque: &'a mut [[Complex64; 2]],
    peaks: &'a mut [[f64; 4]],
}

/// The complex number of one sample.
fn at([re, im]: &[[f64; SAMPLES_AT_ONCE]; 2], sample: usize) -> Complex64 {
    Complex64::new(re[sample], im[sample])
}

/// One pin of each cylinder, counted from 0 without gaps.
fn check_pins(engine: &Engine, pin_of: &[usize]) -> Result<()> {
    let count = engine.stations().len();
    limits::same_length("pins", pin_of.len(), "the engine", count, "cylinder")?;
    if (0..pins(pin_of)).any(|pin| !pin_of.contains(&pin)) {
        let hint = "count the pins from 0, each with a cylinder";
        return Err(Error::value("pins", format!("{pin_of:?}"), hint));
    }
    for (i, pin) in pin_of.iter().enumerate() {
        let first = pin_of[..i].iter().position(|other| other == pin).unwrap_or(i);
        if engine.crank_of(first) != engine.crank_of(i) {
            let pair = format!("[{}, {}]", first + 1, i + 1);
            let hint = "these cylinders are on different cranks; give them pins of their own";
            return Err(Error::value("pins", pair, hint));
        }
    }
    Ok(())
}

/// Number of pins.
fn pins(pin_of: &[usize]) -> usize {
    pin_of.iter().max().map_or(0, |last| last + 1)
}

/// As many spreads as cylinders or pins, each zero or more; or none.
fn check_spreads(
    engine: &Engine,
    pin_of: &[usize],
    figure: Parameter,
    spreads: &[f64],
) -> Result<()> {
    let (expected, item) = if figure.of_pin() {
        (pins(pin_of), "crankpin")
    } else {
        (engine.stations().len(), "cylinder")
    };
    if !spreads.is_empty() {
        limits::same_length(figure.name(), spreads.len(), "the engine", expected, item)?;
    }
    spreads.iter().try_for_each(|&spread| limits::not_negative(figure.name(), spread).map(drop))
}

/// Every sample is an engine: no draw takes more of a mass than there is, or keeps a crank from turning.
///
/// A rotating mass may fall below zero: what deviates from a throw that is balanced is an unbalance.
fn check_reach(
    engine: &Engine,
    pin_of: &[usize],
    spreads: &[Vec<f64>; FIGURES],
    largest: f64,
) -> Result<()> {
    let deviation = |figure: Parameter, k: usize| spreads[figure as usize].get(k).copied();
    let name = Parameter::name;
    for figure in [Parameter::CrankRadius, Parameter::RodLength] {
        if !spreads[figure as usize].is_empty() {
            engine.check_no_link_rods(name(figure))?;
        }
    }
    for (i, place) in engine.stations().iter().enumerate() {
        let (cylinder, number) = (place.cylinder, i + 1);
        let mass = deviation(Parameter::ReciprocatingMass, i).unwrap_or(0.0);
        if largest * mass > cylinder.reciprocating_mass() {
            let most = cylinder.reciprocating_mass() / largest;
            let hint = format!(
                "a draw may take more than the {} kg of cylinder {number}; give {most:.3e} at most",
                cylinder.reciprocating_mass()
            );
            return Err(Error::figure(name(Parameter::ReciprocatingMass), mass, hint));
        }
        let radius = deviation(Parameter::CrankRadius, pin_of[i]).unwrap_or(0.0);
        let rod = deviation(Parameter::RodLength, i).unwrap_or(0.0);
        let smallest = cylinder.crank_radius() - largest * radius;
        let slack = cylinder.rod_length() - cylinder.pin_offset().abs() - cylinder.crank_radius();
        let shrunk = largest * (radius + rod);
        if smallest < limits::SMALLEST || shrunk >= slack {
            let figure = if radius >= rod { Parameter::CrankRadius } else { Parameter::RodLength };
            let hint =
                format!("a draw may keep the crank of cylinder {number} from turning; give less");
            return Err(Error::figure(name(figure), radius.max(rod), hint));
        }
    }
    let turn = spreads[Parameter::Pin as usize].iter().copied().fold(0.0, f64::max);
    if largest * turn > 180.0 {
        let hint = format!("a draw may exceed half a turn; give {:.3} at most", 180.0 / largest);
        return Err(Error::figure(name(Parameter::Pin), turn, hint));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
