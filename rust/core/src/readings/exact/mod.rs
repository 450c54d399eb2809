//! Exact answers: which orders vanish, with proof, and what the others are in closed form.
//!
//! Both read the engine's loads with whole-number weights and roots of unity instead of doubles.

pub mod closed_form;
pub mod vanishing;

use num_traits::{CheckedAdd, CheckedMul};

use crate::engine::Engine;
use crate::load::Loads;
use crate::numbers::error::{Error, Result};
use crate::numbers::rational::{Multiples, Ratio, common_multiple, decimal};

fn too_long() -> Error {
    Error::value("weights", "too many digits", "exact sums need simple ratios of masses and places")
}

/// Weights as whole numbers, over their least common denominator.
fn whole(weights: &[Ratio]) -> Result<(Vec<i128>, i128)> {
    let common = weights
        .iter()
        .try_fold(1, |common, weight| common_multiple(common, *weight.denom()))
        .ok_or_else(too_long)?;
    let whole = weights.iter().map(|w| i128::checked_mul(*w.numer(), common / w.denom()));
    Ok((whole.collect::<Option<_>>().ok_or_else(too_long)?, common))
}

/// Levers of all loads, each a sum of rational multiples of few units of length.
struct Levers {
    /// Lengths of which none is a rational multiple of another; the first is 1 m.
    units: Vec<f64>,
    /// For each load, unit and multiple.
    of: Vec<Vec<(usize, Ratio)>>,
}

impl Levers {
    /// Levers about a reference plane, by default midway between the first and the last cylinder.
    fn new(engine: &Engine, loads: &Loads, reference: Option<f64>) -> Result<Self> {
        let places = || engine.placements().iter().map(|place| place.z);
        let ends = [f64::min, f64::max].map(|end| places().reduce(end).unwrap_or_default());
        let mut lengths: Vec<f64> = loads.list.iter().map(|load| load.z).collect();
        // A plane that is a decimal is exact; any other is known from the middle of the engine.
        let reference = reference.or(engine.reference_z());
        let exact = reference.filter(|&plane| decimal(plane).is_some());
        let shares = match (reference, exact) {
            (_, Some(plane)) => {
                lengths.push(plane);
                vec![Ratio::from(-1)]
            }
            (plane, None) => {
                lengths.extend(ends);
                let half = Ratio::new(-1, 2);
                let rest = plane.map(|plane| plane - engine.middle());
                lengths.extend(rest);
                rest.map_or(vec![half; 2], |_| vec![half, half, Ratio::from(-1)])
            }
        };
        let Multiples { units, of } = Multiples::of_lengths(&lengths);
        let (places, planes) = of.split_at(loads.list.len());
        let lever = |&place: &(usize, Ratio)| {
            let mut lever = vec![place];
            for ((unit, plane), share) in planes.iter().zip(&shares) {
                let part = plane.checked_mul(share).ok_or_else(too_long)?;
                match lever.iter_mut().find(|(known, _)| known == unit) {
                    Some((_, sum)) => *sum = sum.checked_add(&part).ok_or_else(too_long)?,
                    None => lever.push((*unit, part)),
                }
            }
            Ok(lever)
        };
        let levers = places.iter().map(lever).collect::<Result<_>>()?;
        Ok(Self { units, of: levers })
    }
}
