//! What the deviations of some samples add to the sums of an engine's loads.
//!
//! Superposition is linear in the loads: a sample is the nominal engine, and of each load that
//! deviates what it makes less what it made. Without deviations that is nothing, to the last bit; and
//! sums that the nominal engine cancels stay free of its rounding. A load of weight 1 is summed once, and
//! multiplied by that difference, harmonics included: one complex number for each sample.

use std::ops::Range;
use std::sync::Arc;

use super::{Deviations, Parameter, SAMPLES_AT_ONCE, pins};
use crate::Complex64;
use crate::engine::{Engine, Station};
use crate::load::{Load, Scene, SourceIndex, Wanted};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::index::List;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::numbers::simd::{sin_cos_degrees, vectorised};
use crate::source::{Column, ForcePart, Point, PointColumns, Source, at_points};

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
        let laden = engine.without_gas().with_loads(Vec::new())?;
        let laden = laden.with_rotating_masses(&vec![1.0; pin_of.len()])?; // bounded: by cylinders
        let mut ratio_of = vec![SpeedRatio::ONE; pins(pin_of)]; // bounded: by cylinders
        for (i, &pin) in pin_of.iter().enumerate() {
            ratio_of[pin] = engine.cranks()[engine.crank_of(i)].ratio;
        }
        let mut loads = Scene::clone(&*Scene::of(&laden, Some(reference))?);
        let deviating = |load: &Load| {
            let origin = load.place.origin;
            let pin = pin_of[laden.cylinder_with(origin)?];
            // The mass at a knuckle is none of its cylinder's figures.
            let cylinder = origin.cylinder().filter(|_| !load.place.at_knuckle);
            Some(Deviating { pin, cylinder })
        };
        loads.list.retain(|load| deviating(load).is_some());
        Ok(Self {
            orders: orders.to_vec(),
            torque,
            places: engine.stations().to_vec(),
            deviating: loads.list.iter().filter_map(deviating).collect(),
            loads,
            pin_of: pin_of.to_vec(),
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
        let figures = DrawnFigures::new(self, deviations, first, orders, cancel)?;
        let drawn = |load| self.drawn(&figures, load, orders, cancel);
        let drawn =
            self.deviating.iter().zip(&self.loads.list).map(drawn).collect::<Result<Vec<_>>>()?;
        let wanted = Wanted { planar: true, roll: self.torque, by_bank: false };
        for (k, &order) in orders.iter().enumerate() {
            cancel.check()?;
            let mut sums = SampleSums { force: [ZEROS; 2], moment: [ZEROS; 2], torque: [ZEROS; 2] };
            for (load, drawn) in self.loads.list.iter().zip(&drawn) {
                let one = Load { weight: 1.0, roll: 1.0, ..*load };
                for term in self.loads.sums(&[one], order, wanted) {
                    if term.harmonic.column == Column::Roll {
                        for (sum, amplitude) in sums.torque.iter_mut().zip([ROLL, CRANK]) {
                            add(sum, term.roll.value, &drawn.change(amplitude, k)[0]);
                        }
                        continue;
                    }
                    let [change, levered] = drawn.change(FORCE, k);
                    for (side, i) in [Complex64::i(), -Complex64::i()].into_iter().enumerate() {
                        let unit = term.force[side].value;
                        add(&mut sums.force[side], unit, &change);
                        // A moment is its levered force turned by a quarter.
                        add(&mut sums.moment[side], i * unit, &levered);
                    }
                    // A force on an arm turns the block alone.
                    add(&mut sums.torque[0], term.roll.value, &change);
                }
            }
            write(k, &sums);
        }
        Ok(())
    }

    /// A load as it was drawn, and as it is nominally.
    fn drawn<'a>(
        &self,
        figures: &'a DrawnFigures,
        (&Deviating { pin, cylinder }, load): (&Deviating, &Load),
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Drawn<'a>> {
        let source = &self.loads.sources[load.source];
        let (fixed, reference) =
            (|value: f64| ([value; SAMPLES_AT_ONCE], value), self.loads.reference);
        let mut drawn = Drawn {
            weights: [fixed(load.weight), fixed(load.roll)],
            lever: fixed(load.place.lever(reference)),
            nominal: &figures.nominal[load.source],
            changed: None,
            turns: figures.turns.get(pin).map(|turns| &turns[..]),
        };
        let Some(i) = cylinder else { return Ok(drawn) };
        let Station { cylinder, rotating_mass, z, .. } = &self.places[i];
        drawn.lever.0 = around(-reference, &around(*z, &figures.places[i]));
        let (nominal, has_motion) = (cylinder.crank_radius(), source.mechanism().is_some());
        let radius = around(nominal, &figures.radii[pin]);
        match load.parts.force {
            Some(ForcePart::Turning) => {
                let unbalance = product(around(*rotating_mass, &figures.rotating[i]), &radius);
                drawn.weights[0] = (unbalance, rotating_mass * nominal);
            }
            Some(ForcePart::Along) if has_motion => {
                let mass = around(cylinder.reciprocating_mass(), &figures.masses[i]);
                let force = product(mass, &radius);
                drawn.weights = [
                    (force, cylinder.mass_radius()),
                    (product(force, &radius), cylinder.mass_radius_squared()),
                ];
            }
            _ => {}
        }
        if has_motion && figures.has_lengths {
            let rods = around(cylinder.rod_length(), &figures.rods[i]);
            let lengths = radius.into_iter().zip(rods);
            let points: Vec<Point> =
                lengths.map(|lengths| proportions(cylinder, lengths)).collect();
            drawn.changed = Some(self.amplitudes(source, &points, orders, cancel)?);
        }
        Ok(drawn)
    }

    /// Amplitudes of a source at some points: of the force, and of the torques on the block and on the crank.
    fn amplitudes(
        &self,
        source: &Arc<dyn Source>,
        points: &[Point],
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<[PointColumns; 3]> {
        let of = |column, is_wanted: bool| {
            if !is_wanted {
                return Ok(Default::default());
            }
            at_points(source, column, points, orders, cancel)
        };
        let parts = source.parts();
        let [force, _] = of(Column::Force, parts.force.is_some())?;
        let [roll, crank] = of(Column::Roll, parts.roll && self.torque)?;
        Ok([force, roll, crank])
    }
}

/// A cylinder of other lengths, crank radius and rod length, as a point of a sweep: a mechanism is that of its
/// proportions.
fn proportions(cylinder: &Cylinder, (radius, rod): (f64, f64)) -> Point<'static> {
    let offset = cylinder.pin_offset() * (cylinder.crank_radius() / radius);
    let pin_offset = (offset != 0.0).then_some(offset);
    Point { rod_ratio: Some(radius / rod), pin_offset, cycles: None }
}

/// Deviations of some samples by cylinder or pin.
struct DrawnFigures {
    masses: Vec<Reals>,
    rotating: Vec<Reals>,
    radii: Vec<Reals>,
    places: Vec<Reals>,
    rods: Vec<Reals>,
    /// Whether radii or rods deviate.
    has_lengths: bool,
    /// Amplitudes without deviations.
    nominal: List<SourceIndex, [PointColumns; 3]>,
    /// Turns by pin and order; empty where no pin deviates.
    turns: Vec<Vec<Complexes>>,
}

impl DrawnFigures {
    fn new(
        terms: &Terms,
        deviations: &Deviations,
        first: usize,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Self> {
        let [masses, rotating, radii, angles, places, rods] = Parameter::ALL
            .map(|figure| columns(deviations[figure as usize], terms.count(figure), first));
        let nominal = |source: &Arc<dyn Source>| {
            let varies = source.mechanism().filter(|of| of.mechanism.has_proportions());
            let lengths = varies.map(|of| of.mechanism.lengths());
            let point = lengths.map(|of| proportions(of, (of.crank_radius(), of.rod_length())));
            terms.amplitudes(source, &[point.unwrap_or_default()], orders, cancel)
        };
        let nominal = terms.loads.sources.iter().map(nominal).collect::<Result<_>>()?;
        let deviates = |figure: Parameter| !deviations[figure as usize].is_empty();
        let has_lengths = deviates(Parameter::CrankRadius) || deviates(Parameter::RodLength);
        let has_turns = deviates(Parameter::Pin);
        let turns = if has_turns { turns(&angles, &terms.ratio_of, orders) } else { Vec::new() };
        Ok(Self { masses, rotating, radii, places, rods, has_lengths, nominal, turns })
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

/// Indices of amplitudes: of the force, and of the torques on the block and on the crank.
const FORCE: usize = 0;
const ROLL: usize = 1;
const CRANK: usize = 2;

/// A load as it was drawn, and as it is nominally.
struct Drawn<'a> {
    /// Of the force and of the torque.
    weights: [(Reals, f64); 2],
    lever: (Reals, f64),
    /// Amplitudes of a sample, and of each with its deviations, if lengths deviate.
    nominal: &'a [PointColumns; 3],
    changed: Option<[PointColumns; 3]>,
    /// Turn of its pin, by order.
    turns: Option<&'a [Complexes]>,
}

impl Drawn<'_> {
    /// Weight times an amplitude at the order of this index, less the nominal one; and the same times the lever.
    fn change(&self, amplitude: usize, k: usize) -> [Complexes; 2] {
        let (weight, before) = &self.weights[usize::from(amplitude != FORCE)];
        let nominal = &self.nominal[amplitude][k];
        let drawn = self.changed.as_ref().map_or(nominal, |changed| &changed[amplitude][k]);
        let (mut change, mut levered) = ([*weight; 2], ZEROS);
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
        [change, levered]
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
    if unit == Complex64::ZERO {
        return;
    }
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
