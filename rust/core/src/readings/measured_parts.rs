//! Measured masses of the parts of an engine, matched to its cylinders.
//!
//! The engine's own masses stand for the means of the measured ones. Its remainder is what is left of
//! force, and of moment over half its length, over ω²: forward and backward parts as real numbers.

use super::balance::{Balance, Orders, Request, UNIT_RPM, Vector, balance};
use super::terms::LoadSums;
use crate::engine::Engine;
use crate::load::Load;
use crate::matching::spread::{self, SpreadSets};
use crate::matching::{Match, Matching, Measure, PartKind, Partition};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::order::Order;
use crate::source::ForcePart;

/// Engines whose cylinders are up to this many have parts exchanged for the least spread.
const MOST_EXCHANGED: usize = 64;

/// What a kilogram adds to a remainder, by cylinder.
type Influences = Vec<Vec<f64>>;

/// Measured masses of parts, what they are matched by, and the engine that they are for.
#[derive(Debug, Clone)]
pub struct MeasuredParts {
    measure: Measure,
    /// Remainder of the engine with its own masses.
    start: Vec<f64>,
    kinds: Vec<PartKind>,
    places: usize,
}

impl MeasuredParts {
    /// Masses that move with the pistons, and where wanted those of small and big ends, kg. The measure is
    /// the length of the remainder of some orders, or the spread of the reciprocating masses.
    pub fn new(
        engine: &Engine,
        measure: Measure,
        orders: &[Order],
        masses: &[f64],
        ends: Option<[&[f64]; 2]>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let places = engine.stations().len();
        let lists = || [vec![masses]].into_iter().chain(ends.map(Vec::from));
        let (start, kinds) = match measure {
            Measure::Spread => {
                let unit = |j: usize| (0..places).map(|k| f64::from(u8::from(j == k))).collect();
                let kind = |of: Vec<&[f64]>| {
                    PartKind::new(vec![of[0].to_vec()], vec![(0..places).map(unit).collect()])
                };
                (vec![0.0; places], lists().map(kind).collect::<Result<Vec<_>>>()?)
            }
            Measure::Length => {
                let (start, influences) = influences(engine, orders, cancel)?;
                let kind = |of: Vec<&[f64]>| {
                    let figures = influences[..of.len()].to_vec();
                    PartKind::new(of.into_iter().map(deviations).collect(), figures)
                };
                (start, lists().map(kind).collect::<Result<Vec<_>>>()?)
            }
        };
        Ok(Self { measure, start, kinds, places })
    }

    /// The problem of filling a number of engines.
    fn problem(&self, sets: usize) -> Result<Matching> {
        Matching::new(self.measure, self.start.clone(), self.kinds.clone(), sets)
    }

    /// The measure of one engine with the chosen parts of each kind.
    pub fn value(&self, chosen: &[Vec<usize>]) -> Result<f64> {
        Ok(self.problem(1)?.value(chosen))
    }

    /// The best assignment that is found to a number of engines; of equal ones that of the first start.
    ///
    /// Parts are exchanged from starts of its own and from the sequences of parts that are given, where they
    /// are too many to compare.
    pub fn matched(&self, sets: usize, random: &[Partition], cancel: &Cancel) -> Result<Match> {
        let problem = self.problem(sets)?;
        let mut starts = match self.measure {
            Measure::Length => vec![self.kinds.iter().map(PartKind::rising).collect()],
            Measure::Spread => match spread::sets(&self.kinds, self.places, sets) {
                SpreadSets::Least(chosen) => {
                    let value = problem.value(&chosen);
                    return Ok(Match { chosen, value, bound: value, exact: true });
                }
                SpreadSets::Starts(mut starts) if self.places > MOST_EXCHANGED => {
                    let mut chosen = starts.swap_remove(0);
                    for parts in &mut chosen {
                        parts.truncate(sets * self.places);
                    }
                    let value = problem.value(&chosen);
                    // Ends might make up for any difference of masses.
                    return Ok(Match { chosen, value, bound: 0.0, exact: false });
                }
                SpreadSets::Starts(starts) => starts,
            },
        };
        starts.extend_from_slice(random);
        if self.measure == Measure::Spread {
            return problem.solve(&starts, cancel);
        }
        let Match { chosen, bound, exact, .. } = problem.reduced()?.solve(&starts, cancel)?;
        let value = problem.value(&chosen);
        Ok(Match { chosen, value, bound: if exact { value } else { bound.min(value) }, exact })
    }
}

/// Deviations from the mean.
fn deviations(of: &[f64]) -> Vec<f64> {
    let mean = of.iter().sum::<f64>() / of.len() as f64;
    of.iter().map(|mass| mass - mean).collect()
}

/// Remainder of an engine, and what a kilogram in each cylinder adds that moves with its piston, and one that
/// turns with its crankpin.
fn influences(
    engine: &Engine,
    orders: &[Order],
    cancel: &Cancel,
) -> Result<(Vec<f64>, [Influences; 2])> {
    if engine.spectrum().is_some() {
        let reason = "it has a spectrum of forces in place of masses".to_owned();
        return Err(Error::Undefined { argument: "parts", reason });
    }
    let [first, last] = engine.ends();
    let vector = |of: &Balance| remainder(of, 0.5 * (last - first));
    let engine = engine.of_speed_squared();
    let request = Request { rpm: UNIT_RPM, reference_z: None, torque: false };
    let start = vector(&balance(&engine, &request, &Orders::Given(orders.to_vec()), cancel)?);
    let count = engine.stations().len();
    // Every pin carries mass.
    let laden = engine.with_rotating_masses(&vec![1.0; count])?;
    let sums = LoadSums::new(&laden, None, false, orders, cancel)?;
    let mut added = [(); 2].map(|()| vec![vec![0.0; start.len()]; count]);
    for load in &sums.loads.list {
        let (Some(i), Some(part)) = (load.place.origin.cylinder(), load.parts.force) else {
            continue;
        };
        let weight = laden.stations()[i].cylinder.crank_radius();
        let sum = vector(&sums.of(&[Load { weight, ..*load }], 1.0, cancel)?);
        added[usize::from(part == ForcePart::Turning)][i] = sum;
    }
    Ok((start, added))
}

/// Forward and backward parts as real numbers, moments over half the length of the engine.
fn remainder(of: &Balance, half: f64) -> Vec<f64> {
    // By less no complex number can be divided.
    let has_length = half > f64::MIN_POSITIVE;
    let vectors = [(Vector::Force, 1.0), (Vector::Moment, half)];
    let parts = vectors.into_iter().filter(|(vector, _)| *vector == Vector::Force || has_length);
    let all: Vec<_> = parts
        .flat_map(|(vector, length)| [(vector, length, true), (vector, length, false)])
        .flat_map(|(vector, length, forward)| {
            (0..of.orders.len()).map(move |k| {
                let planar = of.planar(vector, k);
                if forward { planar.forward } else { planar.backward() }.unscale(length)
            })
        })
        .collect();
    all.iter().map(|part| part.re).chain(all.iter().map(|part| part.im)).collect()
}
