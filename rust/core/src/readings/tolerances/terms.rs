//! What the deviations of one sample add to the sums of an engine's loads.
//!
//! Superposition is linear in the loads: a sample is the nominal engine, and of each load that
//! deviates what it makes less what it made. Without deviations that is nothing, to the last bit; and
//! sums that the nominal engine cancels stay free of its rounding.

use super::amplitudes::{Amplitudes, ComplexColumns, Shape};
use super::{CHUNK, Deviations, Parameter, SampleColumn};
use crate::Complex64;
use crate::engine::{Engine, Placement};
use crate::load::{Alike, Load, Loads, Wanted};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::simd::{sin_cos_degrees, vectorised};
use crate::wrench::Planar;

/// Sums of one order over ω²: real and imaginary parts.
#[derive(Clone)]
pub(super) struct SampleSums {
    /// Forward part, and conjugate of the backward part.
    pub force: [[SampleColumn; 2]; 2],
    pub moment: [[SampleColumn; 2]; 2],
    /// On the block and on the crank.
    pub torque: [[SampleColumn; 2]; 2],
}

impl SampleSums {
    pub const ZERO: Self = {
        let pairs = [[[0.0; CHUNK]; 2]; 2];
        Self { force: pairs, moment: pairs, torque: pairs }
    };
}

/// A load of weight 1 at one order.
struct Unit {
    force: Planar,
    /// Of the roll torque and of the torque on the crank.
    phase: Complex64,
}

impl Unit {
    fn of(load: &Load, order: u32) -> Option<Self> {
        let mut one = *load;
        one.weight = 1.0;
        let loads = Loads { list: vec![one], gears: Vec::new(), reference: 0.0 };
        let wanted = Wanted { planar: true, roll: false, by_bank: false };
        let [force, _] = loads.sums(Order::whole(order).ok()?, wanted).pop()?.planar();
        Some(Self { force, phase: load.phase.cis(-i64::from(order)) })
    }

    /// Adds a load of these complex weights, and of these weights times levers.
    #[inline(always)]
    fn add_planar(
        &self,
        sums: &mut SampleSums,
        weight: &[SampleColumn; 2],
        levered: &[SampleColumn; 2],
    ) {
        let turned = self.force.quarter_turned();
        add(&mut sums.force[0], self.force.forward, weight);
        add(&mut sums.force[1], self.force.backward_conj, weight);
        add(&mut sums.moment[0], turned.forward, levered);
        add(&mut sums.moment[1], turned.backward_conj, levered);
    }
}

#[inline(always)]
fn add(sum: &mut [SampleColumn; 2], unit: Complex64, values: &[SampleColumn; 2]) {
    let ([sum_re, sum_im], [re, im]) = (sum, values);
    for i in 0..CHUNK {
        sum_re[i] += unit.re * re[i] - unit.im * im[i];
        sum_im[i] += unit.re * im[i] + unit.im * re[i];
    }
}

/// What of a cylinder may deviate.
struct UnitPart {
    place: Placement,
    pin: usize,
    /// Of its piston, by order.
    piston: Vec<Option<Unit>>,
    /// Of what rotates with its crankpin, by order.
    rotating: Vec<Option<Unit>>,
    nominal: Amplitudes,
}

/// A counterweight that follows a pin.
struct LoadWeight {
    pin: usize,
    amount: f64,
    lever: f64,
    by_order: Vec<Option<Unit>>,
}

/// Loads of an engine whose figures deviate.
pub(super) struct Terms {
    orders: Vec<u32>,
    torque: bool,
    reference: f64,
    parts: Vec<UnitPart>,
    weights: Vec<LoadWeight>,
    pins: usize,
}

/// Unit phasors of pins, by pin and order: cosine and sine of n times the deviation.
type Turns = Vec<Vec<[SampleColumn; 2]>>;

impl Terms {
    pub fn new(
        engine: &Engine,
        pin_of: &[usize],
        orders: &[u32],
        reference: f64,
        torque: bool,
        cancel: &Cancel,
    ) -> Result<Self> {
        // Every pin carries mass: a tolerance of none is an unbalance too.
        let laden = engine.placements().iter().map(|p| Placement { rotating_mass: 1.0, ..*p });
        let laden = Engine::new("", "", laden.collect())?
            .with_counterweights(engine.counterweights().to_vec())?;
        let loads = Loads::new(&laden, reference, Alike::Dimensions, None).list;
        let count = engine.placements().len();
        let by_order = |load: &Load| orders.iter().map(|&n| Unit::of(load, n)).collect::<Vec<_>>();
        let mut parts = Vec::with_capacity(count);
        for (i, &place) in engine.placements().iter().enumerate() {
            let shape = Shape::new(&place.cylinder, torque);
            let (radius, rod) = (place.cylinder.crank_radius(), place.cylinder.rod_length());
            let nominal = shape.amplitudes(&[radius], &[rod], orders, cancel)?;
            let (piston, rotating) = (by_order(&loads[i]), by_order(&loads[count + i]));
            parts.push(UnitPart { place, pin: pin_of[i], piston, rotating, nominal });
        }
        let weights = engine.counterweights().iter().zip(&loads[2 * count..]);
        let weights = weights.filter_map(|(weight, load)| {
            let (pin, lever) = (pin_of[weight.pin?], weight.z - reference);
            Some(LoadWeight { pin, amount: weight.amount, lever, by_order: by_order(load) })
        });
        let pins = pin_of.iter().max().map_or(0, |last| last + 1);
        let weights = weights.collect();
        Ok(Self { orders: orders.to_vec(), torque, reference, parts, weights, pins })
    }

    /// Number of cylinders or pins that have a figure.
    pub fn count(&self, figure: Parameter) -> usize {
        if figure.of_pin() { self.pins } else { self.parts.len() }
    }

    /// Sums of every order, over ω², that the deviations of some samples add.
    pub fn sums(
        &self,
        deviations: &Deviations,
        first: usize,
        cancel: &Cancel,
    ) -> Result<Vec<SampleSums>> {
        let [masses, rotating, radii, angles, places, rods] = Parameter::ALL
            .map(|figure| columns(deviations[figure as usize], self.count(figure), first));
        let turns = angles.as_ref().map(|angles| self.turns(angles));
        let mut sums = vec![SampleSums::ZERO; self.orders.len()];
        for (i, part) in self.parts.iter().enumerate() {
            cancel.check()?;
            let deviation = Deviation {
                mass: masses.as_ref().map(|columns| &columns[i]),
                rotating: rotating.as_ref().map(|columns| &columns[i]),
                radius: radii.as_ref().map(|columns| &columns[part.pin]),
                z: places.as_ref().map(|columns| &columns[i]),
                rod: rods.as_ref().map(|columns| &columns[i]),
                turns: turns.as_ref().map(|turns| &turns[part.pin][..]),
            };
            self.add_part(part, &deviation, &mut sums, cancel)?;
        }
        for weight in &self.weights {
            let Some(turns) = &turns else { continue };
            let moved = weight.by_order.iter().zip(&turns[weight.pin]).zip(&mut sums);
            for ((unit, turn), sums) in moved {
                let Some(unit) = unit else { continue };
                let [force, moment] = [1.0, weight.lever].map(|lever| {
                    let amount = weight.amount * lever;
                    let one = [vec![1.0], vec![0.0]];
                    less(turned(&[amount; CHUNK], &one, Some(turn)), [amount, 0.0])
                });
                unit.add_planar(sums, &force, &moment);
            }
        }
        Ok(sums)
    }

    fn turns(&self, angles: &[SampleColumn]) -> Turns {
        let mut turns: Turns = vec![vec![[[0.0; CHUNK]; 2]; self.orders.len()]; self.pins];
        vectorised(
            #[inline(always)]
            || {
                for (turns, angles) in turns.iter_mut().zip(angles) {
                    for ([cos, sin], &n) in turns.iter_mut().zip(&self.orders) {
                        let mut degrees = *angles;
                        for angle in &mut degrees {
                            *angle *= f64::from(n);
                        }
                        sin_cos_degrees(&degrees, sin, cos);
                    }
                }
            },
        );
        turns
    }

    fn add_part(
        &self,
        part: &UnitPart,
        deviation: &Deviation,
        sums: &mut [SampleSums],
        cancel: &Cancel,
    ) -> Result<()> {
        let cylinder = &part.place.cylinder;
        let radius = around(cylinder.crank_radius(), deviation.radius);
        let mass = around(cylinder.reciprocating_mass(), deviation.mass);
        let rotating = around(part.place.rotating_mass, deviation.rotating);
        let z = around(part.place.z, deviation.z);
        let changed = if deviation.radius.is_some() || deviation.rod.is_some() {
            let rod = around(cylinder.rod_length(), deviation.rod);
            let shape = Shape::new(cylinder, self.torque);
            Some(shape.amplitudes(&radius, &rod, &self.orders, cancel)?)
        } else {
            None
        };
        let amplitudes = changed.as_ref().unwrap_or(&part.nominal);
        vectorised(
            #[inline(always)]
            || {
                let lever = around(-self.reference, Some(&z));
                let nominal = Nominal::new(&part.place, self.reference);
                let first_order = product(&mass, &radius);
                let second_moment = product(&first_order, &radius);
                let unbalance = product(&rotating, &radius);
                let inertia = [cylinder.rod_inertia_excess(); CHUNK];
                for (k, sums) in sums.iter_mut().enumerate() {
                    let turn = deviation.turns.map(|turns| &turns[k]);
                    let change = |weight: &SampleColumn,
                                  nominal: f64,
                                  a: &ComplexColumns,
                                  a0: &ComplexColumns| {
                        less(turned(weight, a, turn), at_rest(nominal, a0))
                    };
                    if let Some(unit) = &part.piston[k] {
                        let weight = turned(&first_order, &amplitudes.force[k], turn);
                        let base = at_rest(nominal.first_order, &part.nominal.force[k]);
                        let levered = levered(&weight, &lever, base, nominal.lever);
                        unit.add_planar(sums, &less(weight, base), &levered);
                        let torques = [&amplitudes.roll, &amplitudes.crank];
                        let bases = [&part.nominal.roll, &part.nominal.crank];
                        for (which, (a, a0)) in torques.iter().zip(bases).enumerate() {
                            if !self.torque {
                                continue;
                            }
                            let masses = change(
                                &second_moment,
                                nominal.second_moment,
                                &a.masses[k],
                                &a0.masses[k],
                            );
                            add(&mut sums.torque[which], unit.phase, &masses);
                            if let (Some(a), Some(a0)) = (a.rod.get(k), a0.rod.get(k)) {
                                let rod = change(&inertia, inertia[0], a, a0);
                                add(&mut sums.torque[which], unit.phase, &rod);
                            }
                        }
                    }
                    if let Some(unit) = &part.rotating[k] {
                        let one = [vec![1.0], vec![0.0]];
                        let weight = turned(&unbalance, &one, turn);
                        let base = at_rest(nominal.unbalance, &one);
                        let levered = levered(&weight, &lever, base, nominal.lever);
                        unit.add_planar(sums, &less(weight, base), &levered);
                    }
                }
            },
        );
        Ok(())
    }
}

/// Columns of the samples from `first` on, of rows of so many values; None where nothing deviates.
fn columns(values: &[f64], width: usize, first: usize) -> Option<Vec<SampleColumn>> {
    let rows = values.get(first * width..).filter(|rows| !rows.is_empty())?;
    let mut columns = vec![[0.0; CHUNK]; width];
    for (sample, row) in rows.chunks_exact(width).take(CHUNK).enumerate() {
        for (column, &value) in columns.iter_mut().zip(row) {
            column[sample] = value;
        }
    }
    Some(columns)
}

/// Deviations of a cylinder's figures; None where they do not spread.
struct Deviation<'a> {
    mass: Option<&'a SampleColumn>,
    rotating: Option<&'a SampleColumn>,
    radius: Option<&'a SampleColumn>,
    z: Option<&'a SampleColumn>,
    rod: Option<&'a SampleColumn>,
    /// By order.
    turns: Option<&'a [[SampleColumn; 2]]>,
}

/// Weights and lever of a cylinder as it was drawn, by the operations that its samples take.
struct Nominal {
    first_order: f64,
    second_moment: f64,
    unbalance: f64,
    lever: f64,
}

impl Nominal {
    fn new(place: &Placement, reference: f64) -> Self {
        Self {
            first_order: place.cylinder.first_order(),
            second_moment: place.cylinder.second_moment(),
            unbalance: place.rotating_mass * place.cylinder.crank_radius(),
            lever: place.z - reference,
        }
    }
}

/// A nominal value and its deviations.
#[inline(always)]
fn around(value: f64, deviation: Option<&SampleColumn>) -> SampleColumn {
    let mut values = [value; CHUNK];
    if let Some(deviation) = deviation {
        for i in 0..CHUNK {
            values[i] += deviation[i];
        }
    }
    values
}

#[inline(always)]
fn product(a: &SampleColumn, b: &SampleColumn) -> SampleColumn {
    let mut values = *a;
    for i in 0..CHUNK {
        values[i] *= b[i];
    }
    values
}

/// Weights times amplitudes, one for all samples or one for each, turned by `e^{inδ}`.
#[inline(always)]
fn turned(
    weight: &SampleColumn,
    amplitude: &ComplexColumns,
    turn: Option<&[SampleColumn; 2]>,
) -> [SampleColumn; 2] {
    let [mut re, mut im] = [*weight; 2];
    for (column, values) in [&mut re, &mut im].into_iter().zip(amplitude) {
        match values[..] {
            [value] => {
                for weight in column.iter_mut() {
                    *weight *= value;
                }
            }
            _ => column.iter_mut().zip(values).for_each(|(weight, value)| *weight *= value),
        }
    }
    let Some([cos, sin]) = turn else { return [re, im] };
    for i in 0..CHUNK {
        let (x, y) = (re[i], im[i]);
        re[i] = x * cos[i] - y * sin[i];
        im[i] = x * sin[i] + y * cos[i];
    }
    [re, im]
}

/// A weight times the first of some amplitudes.
fn at_rest(weight: f64, amplitude: &ComplexColumns) -> [f64; 2] {
    amplitude.each_ref().map(|values| weight * values[0])
}

#[inline(always)]
fn less(mut values: [SampleColumn; 2], base: [f64; 2]) -> [SampleColumn; 2] {
    for (values, base) in values.iter_mut().zip(base) {
        for value in values.iter_mut() {
            *value -= base;
        }
    }
    values
}

/// Weights times levers, less what they were.
#[inline(always)]
fn levered(
    weight: &[SampleColumn; 2],
    lever: &SampleColumn,
    base: [f64; 2],
    nominal: f64,
) -> [SampleColumn; 2] {
    let mut values = *weight;
    for (values, base) in values.iter_mut().zip(base) {
        for i in 0..CHUNK {
            values[i] = values[i] * lever[i] - base * nominal;
        }
    }
    values
}
