//! Counterweights fitted to an engine: weights on its cranks, each in its own sense of turning.
//!
//! A weight on a crank that turns with the main one changes what turns forward at order 1, one on a crank
//! that turns against it what turns backward. Cranks of other speeds have other orders.

use nalgebra::DMatrix;

use super::bob_weight::with_bob_weights;
use super::least_squares::least_squares;
use super::shafts::unbalance;
use super::weights::{Minimise, SOLVED, Vectors, WeightRequest, complex, least, vectors};
use super::{TurningPart, VALUE_ROUNDING, turning, without_rounding};
use crate::Complex64;
use crate::engine::crankpins::Bay;
use crate::engine::{CrankIndex, Engine, Unbalance};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::ListIndex;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::numbers::singular_values::SingularValues;
use crate::readings::balance::Vector;
use crate::readings::exact::vanishing::{ProofQuantity, Verdict, vanishing_of};
use crate::readings::turning::on_cranks;

/// A plane in which a crank can have weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Place along the crank, m.
    pub z: f64,
    /// Index of the crank.
    pub crank: CrankIndex,
}

/// What weights are to do to a force or moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// It does not matter.
    Ignored,
    /// All of it is to go.
    All,
    /// It is to be what bob weights of this share of the reciprocating mass leave.
    Share(f64),
}

/// Weights that are wanted of an engine.
#[derive(Debug, Clone)]
pub struct Fit<'a> {
    /// The planes.
    pub planes: &'a [Plane],
    /// Largest mass·radius of each plane, kg·m; infinite for none.
    pub bounds: &'a [f64],
    /// Angles allowed in each plane, radians; None for any.
    pub angles: Option<&'a [Vec<f64>]>,
    /// What is to be done to the force.
    pub force: Target,
    /// What is to be done to the moment.
    pub moment: Target,
    /// Length over which a moment counts as much as a force, m; by default the longest lever of a plane or
    /// a cylinder.
    pub length: Option<f64>,
    /// What is minimised of weights that do the same.
    pub minimise: Minimise,
}

/// A weight, and where it was wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedWeight {
    /// Index of the plane.
    pub plane: usize,
    /// Index among the angles allowed in the plane, 0 where any is.
    pub angle: usize,
    /// The weight.
    pub unbalance: Unbalance,
}

/// Weights fitted to an engine.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedCounterweights {
    /// Those that are not zero, by plane and angle.
    pub list: Vec<FittedWeight>,
    /// Whether they are proved, but for rounding, to do all that was wanted.
    pub exact: bool,
    /// Part of it that they do not do; 0 of those that are exact.
    pub missing: f64,
}

/// Sums of a whole engine that weights for its bays must not change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// Those that vanish.
    Vanishing,
    /// Of the force, of the moment.
    Named([bool; 2]),
}

/// Part of two figures below which their difference is rounding.
const CHANGE_ROUNDING: f64 = 1e-14;

impl Fit<'_> {
    /// Indices of the planes on cranks of a ratio, by the index of their crank.
    fn planes_by_crank(&self, engine: &Engine, ratio: SpeedRatio) -> Vec<(CrankIndex, Vec<usize>)> {
        let of_ratio =
            engine.cranks().indices().filter(|&crank| engine.cranks()[crank].ratio == ratio);
        let on = |crank: CrankIndex| {
            let all = 0..self.planes.len();
            (crank, all.filter(|&plane| self.planes[plane].crank == crank).collect::<Vec<_>>())
        };
        of_ratio.map(on).filter(|(_, planes)| !planes.is_empty()).collect()
    }

    /// What weights on some cranks of one ratio are to exert, of each crank: force and moment, none of what
    /// does not matter.
    fn wanted(
        &self,
        engine: &Engine,
        ratio: SpeedRatio,
        cranks: &[CrankIndex],
        cancel: &Cancel,
    ) -> Result<Vec<[Option<Complex64>; 2]>> {
        let exerted = on_cranks(engine, ratio, cranks, cancel)?;
        let change = |target, part: fn(&TurningPart) -> Complex64| -> Result<Vec<_>> {
            let left = match target {
                Target::Ignored => return Ok(vec![None; cranks.len()]),
                Target::All => vec![TurningPart::default(); cranks.len()],
                Target::Share(factor) => {
                    on_cranks(&left_by(engine, factor)?, ratio, cranks, cancel)?
                }
            };
            let change = |(left, exerted): (&TurningPart, &TurningPart)| {
                let [left, exerted] = [left, exerted].map(part);
                let change = left - exerted;
                // Two figures that agree leave their rounding, not a weight.
                let is_none = change.norm() <= CHANGE_ROUNDING * (left.norm() + exerted.norm());
                Some(if is_none { Complex64::default() } else { change })
            };
            Ok(left.iter().zip(&exerted).map(change).collect())
        };
        let force = change(self.force, |part| part.force)?;
        let moment = change(self.moment, |part| part.moment)?;
        Ok(force.into_iter().zip(moment).map(|(force, moment)| [force, moment]).collect())
    }

    /// The length over which a moment counts as much as a force, m.
    fn compared(&self, engine: &Engine) -> Result<f64> {
        let longest = engine.longest_lever(self.planes.iter().map(|plane| plane.z))?;
        Ok(self.length.unwrap_or(if longest > 0.0 { longest } else { 1.0 }))
    }

    /// What is to be done to force and moment.
    fn targets(&self) -> [(Vector, Target); 2] {
        [(Vector::Force, self.force), (Vector::Moment, self.moment)]
    }

    fn check(&self, engine: &Engine) -> Result<()> {
        for (k, plane) in self.planes.iter().enumerate() {
            let crank = engine.cranks().get(plane.crank.position());
            if crank.is_none_or(|crank| !crank.ratio.is_crank_speed()) {
                let hint = "give the number of a crank of ratio 1 or -1, 0 for the main one: \
                            weights on others have no force of order 1";
                return Err(Error::value(
                    format!("planes[{k}].crank"),
                    plane.crank.position(),
                    hint,
                ));
            }
        }
        Ok(())
    }
}

/// The unbalances at some places that remove the most of an engine's force and moment of order 1, of what
/// turns with the crank of each place.
///
/// Where they cannot remove both, those of a crank leave the least |force|² + |moment/length|². On several
/// cranks of one sense each removes what it carries itself, hence its roll torque about other axes too.
///
/// ```
/// # let single = crankpin_core::engine::file::from_toml(
/// #     "schema = 1
/// #     cylinder = { crank_radius = 0.04, rod_length = 0.13, reciprocating_mass = 0.5 }
/// #     placements = [{ tdc_deg = 0, bank_deg = 90, z = 0 }]",
/// # )?;
/// use crankpin_core::Cancel;
/// use crankpin_core::balancing::counterweights::{Fit, Plane, Target, fit_counterweights};
/// use crankpin_core::balancing::weights::Minimise;
/// use crankpin_core::engine::CrankIndex;
///
/// let fit = Fit {
///     planes: &[Plane { z: 0.0, crank: CrankIndex::MAIN }],
///     bounds: &[f64::INFINITY],
///     angles: None,
///     force: Target::All,
///     moment: Target::All,
///     length: None,
///     minimise: Minimise::Squares,
/// };
/// let fitted = fit_counterweights(&single, &fit, &Cancel::new())?;
/// assert!(fitted.exact && (fitted.list[0].unbalance.amount - 0.01).abs() < 1e-15); // half of m·r
/// # Ok::<(), crankpin_core::Error>(())
/// ```
pub fn fit_counterweights(
    engine: &Engine,
    fit: &Fit,
    cancel: &Cancel,
) -> Result<FittedCounterweights> {
    fit.check(engine)?;
    let (reference, length) = (engine.reference(None)?, fit.compared(engine)?);
    let mut all = FittedCounterweights { list: Vec::new(), exact: true, missing: 0.0 };
    for ratio in [1, -1].map(SpeedRatio::whole) {
        let by_crank = fit.planes_by_crank(engine, ratio);
        if by_crank.is_empty() {
            continue;
        }
        let cranks: Vec<CrankIndex> = by_crank.iter().map(|(crank, _)| *crank).collect();
        let wanted = fit.wanted(engine, ratio, &cranks, cancel)?;
        for ((crank, planes), [force, moment]) in by_crank.iter().zip(wanted) {
            let z: Vec<f64> = planes.iter().map(|&plane| fit.planes[plane].z).collect();
            let bounds: Vec<f64> = planes.iter().map(|&plane| fit.bounds[plane]).collect();
            let angles: Option<Vec<Vec<f64>>> =
                fit.angles.map(|all| planes.iter().map(|&plane| all[plane].clone()).collect());
            let request = WeightRequest {
                z: &z,
                reference,
                length,
                force,
                moment,
                bounds: &bounds,
                angles: angles.as_deref(),
                minimise: fit.minimise,
            };
            let fitted = least(&request, cancel)?;
            let usable: Vec<f64> =
                z.iter().zip(&bounds).filter(|(_, bound)| **bound > 0.0).map(|(z, _)| *z).collect();
            let is_alone = cranks.len() == 1;
            let exact =
                fitted.reached && can_remove(engine, ratio, is_alone, &usable, fit, cancel)?;
            all.exact &= exact;
            if !exact {
                all.missing = all.missing.max(fitted.missing);
            }
            for one in fitted.list {
                let unbalance = Unbalance { crank: *crank, ..unbalance(one.vector, z[one.plane])? };
                all.list.push(FittedWeight {
                    plane: planes[one.plane],
                    angle: one.angle,
                    unbalance,
                });
            }
        }
    }
    all.list.sort_by_key(|one| (one.plane, one.angle));
    Ok(all)
}

/// The engine that bob weights leave, without shafts: they stay, and what is left is the cranks' own.
fn left_by(engine: &Engine, factor: f64) -> Result<Engine> {
    with_bob_weights(engine, factor)?.with_shafts(Vec::new())
}

/// Whether weights of any size at these places of a crank can do all that is wanted, decided without
/// floating-point sums.
///
/// A weight u at z makes the force u and the moment i(z − z₀)·u: two equations, whose rank is the number
/// of different places, up to two. So two places serve any force and moment. One place z serves a force,
/// or a moment if it is not z₀; it serves both if there is no moment about z itself, which is proved in
/// integers: of a crank that is `alone` in its sense, to which all of that sense belongs.
fn can_remove(
    engine: &Engine,
    ratio: SpeedRatio,
    alone: bool,
    places: &[f64],
    fit: &Fit,
    cancel: &Cancel,
) -> Result<bool> {
    let mut different = places.to_vec();
    different.sort_by(f64::total_cmp);
    different.dedup();
    if different.len() >= 2 || !alone {
        return Ok(different.len() >= 2);
    }
    let reference = engine.reference(None)?;
    let vanishes = |vector: Vector, target: Target, z: f64| -> Result<bool> {
        let left = match target {
            Target::Ignored => return Ok(true),
            Target::All => None,
            Target::Share(factor) => Some(left_by(engine, factor)?),
        };
        for engine in std::iter::once(engine).chain(&left) {
            if !turning_vanishes(engine, vector, ratio, z, cancel)? {
                return Ok(false);
            }
        }
        Ok(true)
    };
    let mut wanted = Vec::new();
    for (vector, target) in fit.targets() {
        if !vanishes(vector, target, reference)? {
            wanted.push(vector);
        }
    }
    if wanted.is_empty() {
        return Ok(true);
    }
    let [z] = different[..] else { return Ok(false) };
    if fit.targets().iter().any(|(_, target)| *target == Target::Ignored) {
        return Ok(wanted == [Vector::Force] || z != reference);
    }
    Ok(vanishes(Vector::Moment, fit.moment, z)? && (fit.force == fit.moment || z == reference))
}

/// Whether the part of order 1 that turns with cranks of this ratio is proved to vanish.
fn turning_vanishes(
    engine: &Engine,
    vector: Vector,
    ratio: SpeedRatio,
    z: f64,
    cancel: &Cancel,
) -> Result<bool> {
    let [forward, backward] = ProofQuantity::senses(vector);
    let quantity = if ratio.is_forward() { forward } else { backward };
    let found = vanishing_of(&[quantity], engine, &[Order::FIRST], Some(z), None, cancel)?;
    Ok(found.verdict(Order::FIRST, quantity) == Some(Verdict::Vanishes))
}

/// The bays of the cranks whose order is the first, from front to flywheel.
#[must_use]
pub fn bays(engine: &Engine) -> Vec<Bay> {
    let mut bays = engine.bays();
    bays.retain(|bay| engine.cranks()[bay.crank].ratio.is_crank_speed());
    bays
}

/// The halves of these cranks: their bays in front of the main bearing in the middle and those behind it.
pub fn half_cranks(engine: &Engine) -> Result<Vec<Bay>> {
    let mut halves = Vec::new();
    for crank in engine.cranks().indices() {
        let own: Vec<Bay> = bays(engine).into_iter().filter(|bay| bay.crank == crank).collect();
        if !own.len().is_multiple_of(2) {
            let hint = "half cranks need a main bearing with as many bays on either side";
            let found = format!("{} bays on crank {}", own.len(), crank.position());
            return Err(Error::value("target", found, hint));
        }
        halves.extend(own.chunks((own.len() / 2).max(1)).map(|bays| Bay {
            cylinders: bays.iter().flat_map(|bay| bay.cylinders.clone()).collect(),
            throws: bays.iter().flat_map(|bay| bay.throws.clone()).collect(),
            bearings: [bays[0].bearings[0], bays[bays.len() - 1].bearings[1]],
            crank,
        }));
    }
    Ok(halves)
}

/// The weights that remove the most of the force and moment of order 1 that each bay exerts on its main
/// bearings, of what turns with its crank, by planes in it, and that keep sums of the whole engine.
pub fn internal(
    engine: &Engine,
    fit: &Fit,
    bays: &[Bay],
    keep: Keep,
    cancel: &Cancel,
) -> Result<FittedCounterweights> {
    fit.check(engine)?;
    let mut all = FittedCounterweights { list: Vec::new(), exact: true, missing: 0.0 };
    for bay in bays {
        let planes = inside(bay, fit);
        if planes.is_empty() {
            (all.exact, all.missing) = (false, 1.0);
            continue;
        }
        let on_own = |&plane: &usize| Plane { z: fit.planes[plane].z, crank: alone(bay) };
        let of_planes = |list: &[Vec<f64>]| planes.iter().map(|&p| list[p].clone()).collect();
        let angles: Option<Vec<Vec<f64>>> = fit.angles.map(of_planes);
        let own = Fit {
            planes: &planes.iter().map(on_own).collect::<Vec<_>>(),
            bounds: &planes.iter().map(|&plane| fit.bounds[plane]).collect::<Vec<_>>(),
            angles: angles.as_deref(),
            length: Some(fit.length.unwrap_or_else(|| half(bay))),
            ..*fit
        };
        let fitted = fit_counterweights(&engine.of_bay(bay)?, &own, cancel)?;
        all.exact &= fitted.exact;
        all.missing = all.missing.max(fitted.missing);
        all.list.extend(fitted.list.into_iter().map(|one| FittedWeight {
            plane: planes[one.plane],
            unbalance: Unbalance { crank: bay.crank, ..one.unbalance },
            ..one
        }));
    }
    for ratio in [1, -1].map(SpeedRatio::whole) {
        let kept = kept(engine, ratio, keep, cancel)?;
        if kept != [false; 2] && changes(engine, ratio, kept, &all.list)? {
            keep_sums(engine, fit, bays, (ratio, kept), &mut all, cancel)?;
        }
    }
    all.list.sort_by_key(|one| (one.plane, one.angle));
    Ok(all)
}

/// Index of the crank of a bay in the engine of the bay alone: the main one, or the only one besides.
fn alone(bay: &Bay) -> CrankIndex {
    CrankIndex::new(usize::from(bay.crank != CrankIndex::MAIN))
}

/// Indices of the planes in a bay.
fn inside(bay: &Bay, fit: &Fit) -> Vec<usize> {
    let [front, rear] = bay.bearings;
    let is_inside = |plane: &Plane| plane.crank == bay.crank && front <= plane.z && plane.z < rear;
    (0..fit.planes.len()).filter(|&plane| is_inside(&fit.planes[plane])).collect()
}

/// Half of the distance between the bearings of a bay, m: with it as length the sum of squares of their
/// loads is what is the least.
fn half(bay: &Bay) -> f64 {
    (bay.bearings[1] - bay.bearings[0]) / 2.0
}

/// Which sums of what turns in a sense are to stay: of the force, of the moment.
fn kept(engine: &Engine, ratio: SpeedRatio, keep: Keep, cancel: &Cancel) -> Result<[bool; 2]> {
    match keep {
        Keep::Named(kept) => Ok(kept),
        Keep::Vanishing => {
            let TurningPart { force, moment } = turning(engine, ratio, cancel)?;
            Ok([force, moment].map(|sum| sum == Complex64::default()))
        }
    }
}

/// Levers of force and moment of a weight at z.
fn lever(vector: usize, z: f64, reference: f64, length: f64) -> f64 {
    if vector == 0 { 1.0 } else { (z - reference) / length }
}

/// Whether weights change one of the sums, by more than the errors of a fit.
fn changes(
    engine: &Engine,
    ratio: SpeedRatio,
    kept: [bool; 2],
    list: &[FittedWeight],
) -> Result<bool> {
    let reference = engine.reference(None)?;
    Ok((0..2).filter(|&vector| kept[vector]).any(|vector| {
        let (mut sum, mut size) = (Complex64::default(), 0.0);
        for FittedWeight { unbalance: weight, .. } in list {
            if engine.cranks()[weight.crank].ratio == ratio {
                let one = weight.amount * lever(vector, weight.z, reference, 1.0);
                sum += weight.angle.cis(1) * one;
                size += one.abs();
            }
        }
        sum.norm() > SOLVED * size
    }))
}

/// The weights of a sense in place of those that change its sums: the least that leave the least squares
/// of the forces and moments of the bays, of those that change no sum.
fn keep_sums(
    engine: &Engine,
    fit: &Fit,
    bays: &[Bay],
    (ratio, kept): (SpeedRatio, [bool; 2]),
    all: &mut FittedCounterweights,
    cancel: &Cancel,
) -> Result<()> {
    let refused = |hint: &str| {
        let named = ["force", "moment"].into_iter().zip(kept).filter(|(_, kept)| *kept);
        let named: Vec<&str> = named.map(|(name, _)| name).collect();
        Err(Error::value("keep", named.join(" and "), hint))
    };
    if fit.angles.is_some() {
        return refused(
            "weights at these angles would change it; leave out the angles, or keep nothing",
        );
    }
    let own: Vec<&Bay> =
        bays.iter().filter(|bay| engine.cranks()[bay.crank].ratio == ratio).collect();
    let planes: Vec<usize> = own.iter().flat_map(|bay| inside(bay, fit)).collect();
    let (rows, target) = bay_equations(engine, fit, &own, &planes, ratio, cancel)?;
    let (reference, length) = (engine.reference(None)?, fit.compared(engine)?);
    let sums: Vec<usize> = (0..2).filter(|&vector| kept[vector]).collect();
    let sums = DMatrix::from_fn(sums.len(), planes.len(), |row, k| {
        lever(sums[row], fit.planes[planes[k]].z, reference, length)
    });
    // Weights that change no sum are those across the directions that do.
    let values = SingularValues::of(&sums);
    let changing = values.right.rows(0, values.rank(super::least_squares::RANK_TOLERANCE));
    let across = DMatrix::identity(planes.len(), planes.len()) - changing.transpose() * changing;
    let mut seen = &rows * &across;
    if seen.amax() <= VALUE_ROUNDING * rows.amax() {
        seen.fill(0.0); // no weights change a bay and no sum
    }
    let found = least_squares(&seen, &target, target.nrows());
    let mut weights = complex(&(&across * &found.solution));
    without_rounding(&mut weights);
    for (&plane, weight) in planes.iter().zip(&weights) {
        if weight.norm() > fit.bounds[plane] {
            return refused(
                "the weights that keep it are larger than their bound; raise that, or keep nothing",
            );
        }
    }
    if fit.minimise == Minimise::Largest && found.rank + sums.nrows() < planes.len() {
        return refused(
            "of weights that keep it the least sum of squares is found; leave minimise out",
        );
    }
    let left = &target - &seen * &found.solution;
    all.exact = false;
    all.missing = all.missing.max(left.norm() / target.norm());
    all.list.retain(|one| engine.cranks()[one.unbalance.crank].ratio != ratio);
    for (plane, vector) in planes.into_iter().zip(weights) {
        if vector != Complex64::default() {
            let Plane { z, crank } = fit.planes[plane];
            let unbalance = Unbalance { crank, ..unbalance(vector, z)? };
            all.list.push(FittedWeight { plane, angle: 0, unbalance });
        }
    }
    Ok(())
}

/// Forces and moments of bays by the weights of planes, and what these should be.
fn bay_equations(
    engine: &Engine,
    fit: &Fit,
    bays: &[&Bay],
    planes: &[usize],
    ratio: SpeedRatio,
    cancel: &Cancel,
) -> Result<(DMatrix<f64>, Vectors)> {
    let (mut rows, mut target) = (Vec::new(), Vec::new());
    for bay in bays {
        let [wanted] = fit.wanted(&engine.of_bay(bay)?, ratio, &[alone(bay)], cancel)?[..] else {
            continue;
        };
        let (here, length) = (inside(bay, fit), fit.length.unwrap_or_else(|| half(bay)));
        for (vector, wanted) in wanted.into_iter().enumerate() {
            let Some(wanted) = wanted else { continue };
            target.push(if vector == 0 { wanted } else { -Complex64::i() * wanted / length });
            for plane in planes {
                let z = fit.planes[*plane].z;
                let is_here = here.contains(plane);
                rows.push(if is_here { lever(vector, z, bay.z(), length) } else { 0.0 });
            }
        }
    }
    let rows = DMatrix::from_row_slice(target.len(), planes.len(), &rows);
    Ok((rows, vectors(&target)))
}

/// What each bay exerts on its main bearings, of what turns with its crank, over ω²; the moment about the
/// middle of its throws.
pub fn bay_loads(engine: &Engine, cancel: &Cancel) -> Result<Vec<TurningPart>> {
    let of = |bay: &Bay| turning(&engine.of_bay(bay)?, engine.cranks()[bay.crank].ratio, cancel);
    bays(engine).iter().map(of).collect()
}
