//! What the deviations of some samples add to the sums of an engine's loads.
//!
//! Superposition is linear in the loads: a sample is the nominal engine, and of each load that
//! deviates what it makes less what it made. Without deviations that is nothing, to the last bit; and
//! sums that the nominal engine cancels stay free of its rounding. The weight of a load in the one sum
//! is that difference, harmonics included, with one complex number for each sample.

use std::ops::Range;
use std::rc::Rc;

use super::amplitudes::{SampleAmplitudes, amplitudes};
use super::{Deviations, Parameter, SAMPLES_AT_ONCE, pins};
use crate::Complex64;
use crate::engine::{Engine, Station};
use crate::load::{Arithmetic, Factor, Load, LoadIndex, Phasors, Scene, Wanted, Weight, superpose};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::index::{List, ListIndex, distinct, list_index};
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::numbers::simd::{sin_cos_degrees, vectorised};
use crate::source::ForcePart;

/// A number of each sample.
type Reals = [f64; SAMPLES_AT_ONCE];
/// A complex number of each sample: real and imaginary parts.
pub(super) type Complexes = [Reals; 2];

const ZEROS: Complexes = [[0.0; SAMPLES_AT_ONCE]; 2];

/// Sums of one order over ω².
pub(super) struct SampleSums {
    /// Forward part, and conjugate of the backward part.
    pub force: [Complexes; 2],
    pub moment: [Complexes; 2],
    /// On the block and on the crank.
    pub torque: [Complexes; 2],
}

list_index! {
    /// Index of a cylinder with the speed of its crank, among those that differ.
    DrivenIndex
}

/// Load of a pin that deviates.
#[derive(Clone, Copy)]
struct Deviating {
    pin: usize,
    /// Whose figures act on it, besides its pin's angle.
    cylinder: Option<usize>,
}

/// Loads of an engine whose figures deviate.
pub(super) struct Terms {
    orders: Vec<Order>,
    torque: bool,
    places: Vec<Station>,
    loads: Scene,
    deviating: Vec<Deviating>,
    pin_of: Vec<usize>,
    /// Different cylinders with the speeds of their cranks, and which of them is in each place.
    mechanisms: List<DrivenIndex, (Cylinder, SpeedRatio)>,
    mechanism_of: Vec<DrivenIndex>,
    /// Speed of each pin's crank over that of the main one.
    ratio_of: Vec<SpeedRatio>,
}

impl Terms {
    pub fn new(
        engine: &Engine,
        pin_of: &[usize],
        orders: &[Order],
        reference: f64,
        torque: bool,
    ) -> Result<Self> {
        // Every pin carries mass: a tolerance of none is an unbalance too.
        let laden = engine.stations().iter().map(|p| Station { rotating_mass: 1.0, ..*p });
        let count = engine.stations().len();
        let crank_of = (0..count).map(|i| engine.crank_of(i).position()).collect();
        let laden = Engine::new("", "", laden.collect())?
            .with_cranks(engine.cranks().to_vec(), crank_of)?
            .with_counterweights(engine.counterweights().to_vec())?;
        let ratio = |i: usize| engine.cranks()[engine.crank_of(i)].ratio;
        let (mechanisms, mechanism_of) =
            distinct((0..count).map(|i| (engine.stations()[i].cylinder, ratio(i))));
        let mut ratio_of = vec![SpeedRatio::ONE; pins(pin_of)];
        for (i, &pin) in pin_of.iter().enumerate() {
            ratio_of[pin] = ratio(i);
        }
        let mut loads = Scene::clone(&*Scene::of(&laden, Some(reference))?);
        let deviating = |load: &Load| {
            let origin = load.place.origin;
            let pin = pin_of[laden.cylinder_with(origin)?];
            Some(Deviating { pin, cylinder: origin.cylinder() })
        };
        loads.list.retain(|load| deviating(load).is_some());
        Ok(Self {
            orders: orders.to_vec(),
            torque,
            places: engine.stations().to_vec(),
            deviating: loads.list.iter().filter_map(deviating).collect(),
            loads,
            pin_of: pin_of.to_vec(),
            mechanisms,
            mechanism_of,
            ratio_of,
        })
    }

    /// Number of cylinders or pins that have a figure.
    pub fn count(&self, figure: Parameter) -> usize {
        if figure.of_pin() { pins(&self.pin_of) } else { self.places.len() }
    }

    /// Writes the sums of every order, over ω², that the deviations of some samples add: some orders at
    /// once, as many as take little memory beside their results.
    pub fn write_sums(
        &self,
        deviations: &Deviations,
        first: usize,
        cancel: &Cancel,
        mut write: impl FnMut(usize, &SampleSums),
    ) -> Result<()> {
        /// Harmonics of cylinders in all places that are kept at once: six lists of 128 samples each.
        const HARMONICS_AT_ONCE: usize = 4096;
        let most = (HARMONICS_AT_ONCE / self.places.len().max(1)).max(1);
        for start in (0..self.orders.len()).step_by(most) {
            let range = start..self.orders.len().min(start + most);
            let sums = |k: usize, sums: &SampleSums| write(start + k, sums);
            self.write_block(deviations, first, range, cancel, sums)?;
        }
        Ok(())
    }

    /// [`Terms::write_sums`] of a range of the orders, counted from its start.
    fn write_block(
        &self,
        deviations: &Deviations,
        first: usize,
        range: Range<usize>,
        cancel: &Cancel,
        mut write: impl FnMut(usize, &SampleSums),
    ) -> Result<()> {
        let orders = &self.orders[range];
        let drawn = DrawnParts::new(self, deviations, first, orders, cancel)?;
        let loads = self.deviating.iter().zip(&self.loads.list);
        let loads: List<LoadIndex, Drawn> = loads.map(|of| self.drawn(&drawn, of)).collect();
        let wanted = Wanted { planar: true, roll: self.torque, by_bank: false };
        for (k, &order) in orders.iter().enumerate() {
            cancel.check()?;
            let phasors = Phasors { reference: self.loads.reference };
            let arithmetic = Samples { loads: &loads, k, phasors };
            let mut sums = SampleSums { force: [ZEROS; 2], moment: [ZEROS; 2], torque: [ZEROS; 2] };
            for term in superpose(&arithmetic, &self.loads.list, order, wanted) {
                // Empty where nothing was added: an unbalance turns one way.
                let planar = sums.force.iter_mut().chain(&mut sums.moment);
                for (sum, part) in planar.zip(term.force.iter().chain(&term.moment)) {
                    if let Some(part) = part.first() {
                        add(sum, Complex64::ONE, part);
                    }
                }
                for (sum, part) in sums.torque.iter_mut().zip(&term.roll) {
                    add(sum, Complex64::ONE, part);
                }
            }
            write(k, &sums);
        }
        Ok(())
    }

    /// A load with its parts as they were drawn.
    fn drawn<'a>(
        &self,
        drawn: &'a DrawnParts,
        (&Deviating { pin, cylinder }, load): (&Deviating, &Load),
    ) -> Drawn<'a> {
        let turns = drawn.turns.get(pin).map(|turns| &turns[..]);
        let (fixed, reference) =
            (|value: f64| ([value; SAMPLES_AT_ONCE], value), self.loads.reference);
        let one = [&drawn.one; 2];
        let Some(i) = cylinder else {
            let lever = fixed(load.place.lever(reference));
            return Drawn { parts: vec![(0, fixed(load.weight))], lever, amplitudes: one, turns };
        };
        let Station { cylinder, rotating_mass, z, .. } = self.places[i];
        let radius = around(cylinder.crank_radius(), &drawn.radii[pin]);
        let lever = (around(-reference, &around(z, &drawn.places[i])), z - reference);
        let nominal = &drawn.nominal[self.mechanism_of[i]];
        let of_cylinder = [drawn.changed.get(i).unwrap_or(nominal), nominal];
        let (parts, amplitudes) = match load.parts.force {
            Some(ForcePart::Along) => {
                let mass = around(cylinder.reciprocating_mass(), &drawn.masses[i]);
                let first_order = product(mass, &radius);
                let force = (first_order, cylinder.mass_radius());
                let torque = (product(first_order, &radius), cylinder.mass_radius_squared());
                (vec![(0, force), (1, torque), (2, torque)], of_cylinder)
            }
            None => {
                let torque = fixed(cylinder.rod_inertia_excess());
                (vec![(3, torque), (4, torque)], of_cylinder)
            }
            Some(ForcePart::Turning) => {
                let unbalance = product(around(rotating_mass, &drawn.rotating[i]), &radius);
                (vec![(0, (unbalance, rotating_mass * cylinder.crank_radius()))], one)
            }
        };
        Drawn { parts, lever, amplitudes, turns }
    }
}

/// Deviations of some samples by cylinder or pin, and what follows from them at some orders.
struct DrawnParts {
    masses: Vec<Reals>,
    rotating: Vec<Reals>,
    radii: Vec<Reals>,
    places: Vec<Reals>,
    /// Amplitudes without deviations.
    nominal: List<DrivenIndex, SampleAmplitudes>,
    /// Of each cylinder with them; empty where they are the nominal ones.
    changed: Vec<SampleAmplitudes>,
    /// Of an unbalance.
    one: SampleAmplitudes,
    /// By pin and order; empty where no pin deviates.
    turns: Vec<Vec<Complexes>>,
}

impl DrawnParts {
    fn new(
        terms: &Terms,
        deviations: &Deviations,
        first: usize,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Self> {
        let [masses, rotating, radii, angles, places, rods] = Parameter::ALL
            .map(|figure| columns(deviations[figure as usize], terms.count(figure), first));
        let deviates = |figure: Parameter| !deviations[figure as usize].is_empty();
        let nominal = terms.mechanisms.iter().map(|of| {
            let lengths = (&[of.0.crank_radius()][..], &[of.0.rod_length()][..]);
            amplitudes(of, terms.torque, lengths, orders, cancel)
        });
        let changed = terms.places.iter().enumerate().map(|(i, Station { cylinder, .. })| {
            cancel.check()?;
            let radius = around(cylinder.crank_radius(), &radii[terms.pin_of[i]]);
            let rod = around(cylinder.rod_length(), &rods[i]);
            let of = &terms.mechanisms[terms.mechanism_of[i]];
            amplitudes(of, terms.torque, (&radius, &rod), orders, cancel)
        });
        let has_changed = deviates(Parameter::CrankRadius) || deviates(Parameter::RodLength);
        let changed = changed.take(if has_changed { terms.places.len() } else { 0 });
        let has_turns = deviates(Parameter::Pin);
        let mut one = SampleAmplitudes::default();
        one[0] = vec![[vec![1.0], vec![0.0]]; orders.len()];
        Ok(Self {
            nominal: nominal.collect::<Result<_>>()?,
            changed: changed.collect::<Result<_>>()?,
            one,
            turns: if has_turns { turns(&angles, &terms.ratio_of, orders) } else { Vec::new() },
            masses,
            rotating,
            radii,
            places,
        })
    }
}

/// Unit phasors by pin and order: of n times the angle of the main crank by which it is ahead.
fn turns(angles: &[Reals], ratio_of: &[SpeedRatio], orders: &[Order]) -> Vec<Vec<Complexes>> {
    let turn = |angles: &Reals, multiple: f64| {
        vectorised(
            #[inline(always)]
            || {
                let [mut cos, mut sin] = ZEROS;
                let degrees = product([multiple; SAMPLES_AT_ONCE], angles);
                sin_cos_degrees(&degrees, &mut sin, &mut cos);
                [cos, sin]
            },
        )
    };
    let of_pin = |(angles, ratio): (&Reals, &SpeedRatio)| {
        orders.iter().map(|n| turn(angles, n.number() / ratio.number())).collect()
    };
    angles.iter().zip(ratio_of).map(of_pin).collect()
}

/// A load as it was drawn, and as it is nominally.
struct Drawn<'a> {
    /// Lists of amplitudes, and weights: of the force, or of the torques on the block and on the crank.
    parts: Vec<(usize, (Reals, f64))>,
    lever: (Reals, f64),
    amplitudes: [&'a SampleAmplitudes; 2],
    /// Turn of its pin, by order.
    turns: Option<&'a [Complexes]>,
}

impl Drawn<'_> {
    /// Complex weights at the order of this index, less the nominal ones: of the force, of the moment,
    /// of the torques on the block and on the crank; without those of which there are no amplitudes.
    fn changes(&self, k: usize) -> Vec<Complexes> {
        let mut changes = Vec::with_capacity(4);
        for &(list, (ref weight, before)) in &self.parts {
            let [drawn, nominal] = self.amplitudes.map(|lists| lists[list].get(k));
            let (Some(drawn), Some(nominal)) = (drawn, nominal) else { break };
            let mut change = [*weight; 2];
            let mut levered = ZEROS;
            vectorised(
                #[inline(always)]
                || {
                    for (change, values) in change.iter_mut().zip(drawn) {
                        match values[..] {
                            [value] => multiply(change, &[value; SAMPLES_AT_ONCE]),
                            _ => multiply(change, values),
                        }
                    }
                    if let Some(turns) = self.turns {
                        let ([re, im], [cos, sin]) = (&mut change, &turns[k]);
                        for i in 0..SAMPLES_AT_ONCE {
                            let (x, y) = (re[i], im[i]);
                            re[i] = x * cos[i] - y * sin[i];
                            im[i] = x * sin[i] + y * cos[i];
                        }
                    }
                    for part in 0..2 {
                        let base = before * nominal[part][0];
                        let (lever, at_rest) = &self.lever;
                        for i in 0..SAMPLES_AT_ONCE {
                            levered[part][i] = change[part][i] * lever[i] - base * at_rest;
                            change[part][i] -= base;
                        }
                    }
                },
            );
            changes.push(change);
            if list == 0 {
                changes.push(levered);
            }
        }
        changes
    }
}

/// Arithmetic of samples at one order: unit phasors, and complex weights less the nominal ones.
struct Samples<'a> {
    loads: &'a List<LoadIndex, Drawn<'a>>,
    /// Index of the order.
    k: usize,
    phasors: Phasors,
}

impl Arithmetic for Samples<'_> {
    type Unit = (Complex64, Rc<Vec<Complexes>>);
    /// One, of torques those on the block and on the crank; none where nothing was added.
    type Sum = Vec<Complexes>;

    fn phase(&self, load: (LoadIndex, &Load), times: i64) -> Self::Unit {
        (self.phasors.phase(load, times), Rc::new(self.loads[load.0].changes(self.k)))
    }

    fn toward(&self, load: (LoadIndex, &Load), unit: &Self::Unit, conjugate: bool) -> Self::Unit {
        (self.phasors.toward(load, &unit.0, conjugate), Rc::clone(&unit.1))
    }

    fn add(
        &self,
        sum: &mut Self::Sum,
        (_, load): (LoadIndex, &Load),
        weight: Weight,
        (unit, changes): &Self::Unit,
        times: Factor,
    ) {
        let (values, arm) = match weight {
            Weight::Force => (&changes[..1], 1.0),
            Weight::Moment => (&changes[1..2], 1.0),
            Weight::Roll => (&changes[changes.len() - 2..], 1.0),
            // A force on an arm turns the block alone.
            Weight::ArmX => (&changes[..1], load.place.axis.re),
            Weight::ArmY => (&changes[..1], load.place.axis.im),
        };
        sum.resize(values.len(), ZEROS);
        let unit = times.of(*unit) * arm;
        sum.iter_mut().zip(values).for_each(|(sum, values)| add(sum, unit, values));
    }
}

/// Columns of the samples from `first` on, of rows of `width` values; zero where nothing deviates.
fn columns(values: &[f64], width: usize, first: usize) -> Vec<Reals> {
    let mut columns = vec![[0.0; SAMPLES_AT_ONCE]; width];
    let rows = values.get(first * width..).unwrap_or_default();
    for (sample, row) in rows.chunks_exact(width).take(SAMPLES_AT_ONCE).enumerate() {
        for (column, &value) in columns.iter_mut().zip(row) {
            column[sample] = value;
        }
    }
    columns
}

/// A nominal value and its deviations.
fn around(value: f64, deviations: &Reals) -> Reals {
    let mut values = [value; SAMPLES_AT_ONCE];
    values.iter_mut().zip(deviations).for_each(|(value, deviation)| *value += deviation);
    values
}

fn product(mut a: Reals, b: &Reals) -> Reals {
    multiply(&mut a, b);
    a
}

#[inline(always)]
fn multiply(values: &mut Reals, factors: &[f64]) {
    values.iter_mut().zip(factors).for_each(|(value, factor)| *value *= factor);
}

/// Adds a complex number times the values.
fn add(sum: &mut Complexes, unit: Complex64, values: &Complexes) {
    vectorised(
        #[inline(always)]
        || {
            let ([sum_re, sum_im], [re, im]) = (sum, values);
            for i in 0..SAMPLES_AT_ONCE {
                sum_re[i] += unit.re * re[i] - unit.im * im[i];
                sum_im[i] += unit.re * im[i] + unit.im * re[i];
            }
        },
    );
}
