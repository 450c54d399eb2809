//! Exact answers: which orders vanish, with proof, and what the others are in closed form; the phase
//! vectors of a firing order.
//!
//! Both superpose the engine's loads with rational weights and roots of unity instead of doubles.

pub mod closed_form;
mod roots;
pub mod star;
pub mod vanishing;

use std::sync::Arc;

use num_traits::{CheckedAdd, CheckedMul};

use self::vanishing::{ByQuantity, ProofQuantity, QUANTITIES};
use crate::Complex64;
use crate::engine::Engine;
use crate::load::{Load, LoadIndex, Scene, SourceIndex};
use crate::mechanism::Mechanism;
use crate::mechanism::exact::MotionKey;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::{List, list_index};
use crate::numbers::order::Order;
use crate::numbers::rational::{Multiples, Ratio, common_measure, decimal, product};
use crate::readings::amplitude::SourceAmplitudes;
use crate::source::ExactFactor;

fn too_long() -> Error {
    Error::value("weights", "too many digits", "exact sums need simple ratios of masses and places")
}

/// Weights as whole numbers without a common divisor, and the measure of which they are multiples.
fn whole(weights: &[Ratio]) -> Result<(Vec<i128>, Ratio)> {
    let measure = weights.iter().try_fold(Ratio::ZERO, |m, &w| common_measure(m, w));
    let measure = measure.ok_or_else(too_long)?;
    if measure == Ratio::ZERO {
        return Ok((vec![0; weights.len()], Ratio::ONE));
    }
    let whole = weights.iter().map(|&w| Some(product(w, measure.recip())?.to_integer()));
    Ok((whole.collect::<Option<_>>().ok_or_else(too_long)?, measure))
}

/// A motion of pistons on cranks of one speed.
#[derive(Debug, Clone)]
pub(crate) struct ExactMotion {
    pub mechanism: Arc<dyn Mechanism>,
    pub key: MotionKey,
    /// Of the crank, in halves of the main crank's.
    pub speed: u32,
}

impl ExactMotion {
    /// Multiple of the speed of its own crank that an order is.
    pub fn own_order(&self, order: Order) -> u32 {
        order.halves() / self.speed
    }
}

list_index! {
    /// Index of a motion that loads of exact sums have.
    pub(crate) MotionIndex
}

/// Loads of which exact sums are made, and their motions.
struct ExactLoads {
    loads: Scene,
    /// Motions that differ as typed, or in the speed of their cranks, whichever the sense: offsets are on
    /// the side to which the crankpin swings.
    motions: List<MotionIndex, ExactMotion>,
    /// Motion of each source that has one.
    motion_of: List<SourceIndex, Option<MotionIndex>>,
}

impl ExactLoads {
    fn new(engine: &Engine, reference: Option<f64>) -> Result<Self> {
        if engine.spectrum().is_some() {
            let reason = "its forces are a spectrum that was given".to_owned();
            return Err(Error::Undefined { argument: "an exact sum", reason });
        }
        let mut loads = Scene::clone(&*Scene::of(engine, reference)?);
        loads.retain_exact();
        let acts = |source: &SourceIndex| loads.list.iter().any(|load| load.source == *source);
        let mechanism = |source| Some((source, loads.sources[source].mechanism()?));
        let mechanisms = loads.sources.indices().filter(acts).filter_map(mechanism);
        let mut motion_of = loads.sources.map_to(|_| None);
        let mut motions: List<MotionIndex, ExactMotion> = List::default();
        for (source, driven) in mechanisms {
            let (key, speed) = (driven.mechanism.key(), driven.ratio.halves_of_speed());
            let is_known = |known: &ExactMotion| (&known.key, known.speed) == (&key, speed);
            let known = motions.indices().find(|&known| is_known(&motions[known]));
            motion_of[source] = Some(known.unwrap_or_else(|| {
                motions.push(ExactMotion { mechanism: Arc::clone(&driven.mechanism), key, speed })
            }));
        }
        Ok(Self { loads, motions, motion_of })
    }
}

/// Levers of all loads, each a sum of rational multiples of few units of length.
struct Levers {
    /// Lengths of which none is a rational multiple of another.
    units: Vec<f64>,
    /// For each load, unit and multiple.
    of: List<LoadIndex, Vec<(usize, Ratio)>>,
}

impl Levers {
    /// Levers about a reference plane, by default midway between the first and the last cylinder.
    fn new(
        engine: &Engine,
        loads: &Scene,
        reference: Option<f64>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let mut lengths: Vec<f64> = loads.list.iter().map(|load| load.place.z).collect();
        // A plane that is a decimal is exact; any other is known from the middle of the engine.
        let reference = reference.or(engine.reference_z());
        let exact = reference.filter(|&plane| decimal(plane).is_some());
        let shares = match (reference, exact) {
            (_, Some(plane)) => {
                lengths.push(plane);
                vec![Ratio::from(-1)]
            }
            (plane, None) => {
                lengths.extend(engine.ends());
                let half = Ratio::new(-1, 2);
                let rest = plane.map(|plane| plane - engine.middle());
                lengths.extend(rest);
                rest.map_or(vec![half; 2], |_| vec![half, half, Ratio::from(-1)])
            }
        };
        let Multiples { units, of } = Multiples::new(&lengths, cancel)?;
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
        let of = places.iter().map(lever).collect::<Result<_>>()?;
        Ok(Self { units, of })
    }
}

/// In which sums of each order a load that was given by numbers acts.
pub(crate) struct NumberedLoads(Vec<ByQuantity<bool>>);

impl NumberedLoads {
    /// Of an engine at some orders.
    fn new(
        engine: &Engine,
        reference: Option<f64>,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Self> {
        let none = || QUANTITIES.iter().map(|_| false).collect::<ByQuantity<_>>();
        let mut acts: Vec<_> = orders.iter().map(|_| none()).collect();
        if engine.loads().is_empty() {
            return Ok(Self(acts));
        }
        let loads = Scene::of(engine, reference)?;
        let is_numbered = |load: &&Load| loads.source(load).exact() == ExactFactor::Unknown;
        let amplitudes = SourceAmplitudes::new(&loads.sources, true, orders, cancel)?;
        for load in loads.list.iter().filter(is_numbered) {
            let wrenches = amplitudes.wrenches(&loads, &[*load], true, orders, cancel)?;
            for (acts, of_order) in acts.iter_mut().zip(wrenches.chunks(loads.groups.len())) {
                for wrench in of_order {
                    let sums = ProofQuantity::of_wrench(wrench, |_| 0.0);
                    acts.iter_mut()
                        .zip(&sums)
                        .for_each(|(acts, sum)| *acts |= *sum != Complex64::ZERO);
                }
            }
        }
        Ok(Self(acts))
    }
}
