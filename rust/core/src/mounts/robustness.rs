//! How far natural frequencies and the purity of modes go within tolerances.
//!
//! K grows by a positive semidefinite matrix with each stiffness, and M with mass and inertia, so that by
//! Courant and Fischer's theorem every frequency is monotone in each of them: its bounds are at the two ends,
//! with no corner between. Purity is not monotone, and least inside the tolerances as often as at a corner: where
//! two frequencies approach each other, their modes mix. It is searched at every corner, at random points, and from
//! the worst of them along lines; what is found is an upper bound of the least.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::bodies::{Bodies, OfPowertrain};
use super::modes::{NaturalModes, dynamic, natural, purities};
use super::{Powertrain, real};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::pool;

/// Figures at two ends each of which corners are taken: a quarter of a million.
const MOST_PARAMETERS: usize = 18;
/// Random points at which purity is evaluated besides the corners.
const RANDOM_POINTS: usize = 4096;
/// Points computed between two checks whether another thread is idle.
const POINTS_PER_TASK: usize = 256;
/// Worst points from which lines are searched.
const STARTS: usize = 3;
/// Points of a line across the tolerances.
const POINTS_OF_LINE: usize = 13;
/// Steps of a golden section: to a ten thousandth of the bracket.
const SECTIONS: usize = 20;
/// Rounds of lines along all parameters; a purity that falls by less than the share ends them.
const MOST_ROUNDS: usize = 8;
/// See [`MOST_ROUNDS`].
const NO_PROGRESS: f64 = 1e-6;

/// Tolerances of a powertrain.
#[derive(Debug, Clone, PartialEq)]
pub struct MountTolerances {
    /// Of the stiffness of each mount, over it.
    pub stiffness: Vec<f64>,
    /// Of the mass, over it.
    pub mass: f64,
    /// Of the tensor of inertia, over it.
    pub inertia: f64,
    /// Of the centre of gravity along x, y and z, m.
    pub cg: f64,
    /// Whether the axes of a mount are stiff or soft each by itself in corners.
    pub by_axis: bool,
}

/// What tolerances do.
#[derive(Debug, Clone, PartialEq)]
pub struct Robustness {
    /// Hz, without tolerances: of six modes, or on a subframe of twelve.
    pub frequency: Vec<f64>,
    /// Least and largest frequencies within the tolerance of stiffness.
    pub by_stiffness: [Vec<f64>; 2],
    /// Within that of mass and inertia.
    pub by_mass: [Vec<f64>; 2],
    /// Of the eight corners of the centre of gravity, and its own place.
    pub by_cg: [Vec<f64>; 2],
    /// Derivatives by the place of the centre of gravity along x, y, z, Hz/m; of modes of one frequency the
    /// mean.
    pub cg_slope: [Vec<f64>; 3],
    /// %, without tolerances.
    pub purity: Vec<f64>,
    /// Least that was found within the tolerance of stiffness.
    pub least_purity: Vec<f64>,
    /// Where it is, of each mode: the factor of the stiffness of each mount along its axes.
    pub least_pure: Vec<Vec<[f64; 3]>>,
}

/// Evaluate tolerances of the body and its own mounts with the stiffness at a frequency, Hz; a subframe is as it is.
pub fn robustness(
    powertrain: &Powertrain,
    tolerances: &MountTolerances,
    frequency: Option<f64>,
    cancel: &Cancel,
) -> Result<Robustness> {
    let count = powertrain.mounts().len();
    limits::same_length("stiffness", tolerances.stiffness.len(), "mounts", count, "mount")?;
    let shares = [("mass", tolerances.mass), ("inertia", tolerances.inertia)];
    let of_mounts = tolerances.stiffness.iter().map(|&share| ("stiffness", share));
    for (name, share) in shares.into_iter().chain(of_mounts) {
        if !(0.0..1.0).contains(&share) {
            let hint = "give a tolerance over the figure itself: 0.1 for ±10 %, less than 1";
            return Err(Error::figure(name, share, hint));
        }
    }
    limits::distance("cg", tolerances.cg)?;
    match powertrain.subframe()? {
        None => evaluated(powertrain, Powertrain::alone, tolerances, frequency, cancel),
        Some(_) => evaluated(powertrain, Powertrain::with_subframe, tolerances, frequency, cancel),
    }
}

fn evaluated<const N: usize>(
    powertrain: &Powertrain,
    bodies_of: OfPowertrain<N>,
    tolerances: &MountTolerances,
    frequency: Option<f64>,
    cancel: &Cancel,
) -> Result<Robustness> {
    let (_, stiffnesses) = dynamic(powertrain, frequency)?;
    let bodies = bodies_of(powertrain)?;
    let search = Search::new(&bodies, tolerances, real(&stiffnesses), cancel)?;
    let along = &search.along;
    let nominal = natural(&bodies, along);
    let scaled = |sign: f64| -> Vec<[f64; 3]> {
        let shares = tolerances.stiffness.iter().copied().chain(std::iter::repeat(0.0));
        let each = along.iter().zip(shares);
        each.map(|(along, share)| along.map(|k| k * (1.0 + sign * share))).collect()
    };
    let by_stiffness = [-1.0, 1.0].map(|sign| natural(&bodies, &scaled(sign)).frequency().to_vec());
    let body = powertrain.body();
    let of_body = |body| {
        let mut other = Powertrain::new(body, powertrain.mounts().to_vec())?;
        if let Some(support) = powertrain.support() {
            other = other.on(support.clone())?;
        }
        Ok(natural(&bodies_of(&other)?, along).frequency())
    };
    let heavier = |sign: f64| -> Result<Vec<f64>> {
        let body = body.scaled(1.0 + sign * tolerances.mass, 1.0 + sign * tolerances.inertia);
        of_body(body).map(|frequency| frequency.to_vec())
    };
    let [mut least, mut largest] = [nominal.frequency(); 2];
    for corner in 0..8_u32 {
        let sign = |axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
        let shift = Vector3::new(sign(0), sign(1), sign(2)) * tolerances.cg;
        for (mode, frequency) in of_body(body.at(body.cg() + shift))?.into_iter().enumerate() {
            least[mode] = least[mode].min(frequency);
            largest[mode] = largest[mode].max(frequency);
        }
    }
    let (least_purity, least_pure) = search.least_pure()?.into_iter().unzip();
    Ok(Robustness {
        frequency: nominal.frequency().to_vec(),
        by_stiffness,
        by_mass: [heavier(1.0)?, heavier(-1.0)?],
        by_cg: [least.to_vec(), largest.to_vec()],
        cg_slope: slopes(powertrain, &nominal),
        purity: purities(&bodies, &nominal).to_vec(),
        least_purity,
        least_pure,
    })
}

/// Derivatives of the frequencies by the place of the CG: −f m u·(φ × e) of a mode of unit mass.
fn slopes<const N: usize>(powertrain: &Powertrain, modes: &NaturalModes<N>) -> [Vec<f64>; 3] {
    let mass = powertrain.body().mass();
    let group = modes.groups();
    [0, 1, 2].map(|axis| {
        let unit = Vector3::ith(axis, 1.0);
        let of_mode = |mode: usize| {
            let shape = modes.shapes.column(mode);
            let part = |first: usize| Vector3::from_fn(|k, _| shape[first + k]);
            -modes.omega[mode] / TAU * mass * part(0).dot(&part(3).cross(&unit)) + 0.0
        };
        let mean = |mode: usize| {
            let members = (0..N).filter(|&other| group[other] == group[mode]);
            let (sum, count) = members.fold((0.0, 0.0), |(s, n), k| (s + of_mode(k), n + 1.0));
            sum / count
        };
        (0..N).map(mean).collect()
    })
}

/// A purity, and a point: places of the parameters from −1 to 1 between the ends of their tolerances.
type Point = (f64, Vec<f64>);

/// The search for the least purity of each mode within tolerances of stiffness.
struct Search<'a, const N: usize> {
    bodies: &'a Bodies<'a, N>,
    /// Stiffness of all mounts.
    along: Vec<[f64; 3]>,
    /// Mounts and axes that vary together, and their tolerance.
    parameters: Vec<(Vec<(usize, usize)>, f64)>,
    cancel: &'a Cancel,
}

impl<'a, const N: usize> Search<'a, N> {
    fn new(
        bodies: &'a Bodies<'a, N>,
        tolerances: &MountTolerances,
        along: Vec<[f64; 3]>,
        cancel: &'a Cancel,
    ) -> Result<Self> {
        let mut parameters = Vec::new();
        for (mount, &share) in tolerances.stiffness.iter().enumerate().filter(|one| *one.1 > 0.0) {
            let axes = (0..3).filter(|&axis| along[mount][axis] > 0.0).map(|axis| (mount, axis));
            if tolerances.by_axis {
                parameters.extend(axes.map(|place| (vec![place], share)));
            } else {
                parameters.push((axes.collect(), share));
            }
        }
        let count = parameters.len();
        if count > MOST_PARAMETERS {
            let (argument, hint) = if tolerances.by_axis {
                ("corners", "give corners=\"mounts\", where the axes of a mount go together")
            } else {
                ("stiffness", "give tolerances of fewer mounts")
            };
            let value = format!("2 to the power of {count} corners");
            return Err(Error::value(argument, value, format!("are too many: {hint}")));
        }
        Ok(Self { bodies, along, parameters, cancel })
    }

    /// Factors of the stiffness of each mount along its axes.
    fn factors(&self, point: &[f64]) -> Vec<[f64; 3]> {
        let mut factors = vec![[1.0; 3]; self.along.len()]; // bounded: mounts of two bodies
        for ((places, share), at) in self.parameters.iter().zip(point) {
            for &(mount, axis) in places {
                factors[mount][axis] = 1.0 + share * at;
            }
        }
        factors
    }

    /// Natural frequencies, and the purity of each mode, at a point.
    fn at(&self, point: &[f64]) -> ([f64; N], [f64; N]) {
        let mut along = self.factors(point);
        for (factors, own) in along.iter_mut().zip(&self.along) {
            *factors = [0, 1, 2].map(|axis| factors[axis] * own[axis]);
        }
        let natural = natural(self.bodies, &along);
        (natural.omega, purities(self.bodies, &natural))
    }

    /// The k-th point: first the corners, then random ones.
    fn point(&self, k: usize) -> Vec<f64> {
        let count = self.parameters.len();
        if k < 1 << count {
            return (0..count).map(|bit| if k >> bit & 1 == 1 { 1.0 } else { -1.0 }).collect();
        }
        // SplitMix64, of the number of the point: the same on any number of threads.
        let draw = |j: usize| {
            let mut state = ((k * MOST_PARAMETERS + j) as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            state = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            state = (state ^ (state >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((state ^ (state >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        (0..count).map(draw).collect()
    }

    /// Least purity found of each mode, and the factors of the stiffness at which it is.
    fn least_pure(&self) -> Result<Vec<(f64, Vec<[f64; 3]>)>> {
        let count = self.parameters.len();
        let all = (1_usize << count) + if count > 0 { RANDOM_POINTS } else { 0 };
        let tasks: Vec<usize> = (0..all.div_ceil(POINTS_PER_TASK)).collect();
        let parts = pool::map(self.cancel, tasks, |task| {
            let first = task * POINTS_PER_TASK;
            let mut worst = vec![[(f64::INFINITY, 0); STARTS]; N]; // bounded: twelve modes
            for k in first..(first + POINTS_PER_TASK).min(all) {
                if k.is_multiple_of(16) {
                    self.cancel.check()?;
                }
                let (_, purity) = self.at(&self.point(k));
                for (worst, purity) in worst.iter_mut().zip(purity) {
                    keep(worst, (purity, k));
                }
            }
            Ok(worst)
        })?;
        let mut starts = Vec::new();
        for mode in 0..N {
            let mut worst = [(f64::INFINITY, 0); STARTS];
            parts.iter().flat_map(|part| part[mode]).for_each(|one| keep(&mut worst, one));
            starts.extend(worst.into_iter().filter(|one| one.0.is_finite()).map(|one| (mode, one)));
        }
        let ends = pool::map(self.cancel, starts, |(mode, (purity, k))| {
            self.descended(mode, (purity, self.point(k))).map(|end| (mode, end))
        })?;
        let least_of = |mode: usize| {
            let own = ends.iter().filter(|end| end.0 == mode).map(|end| &end.1);
            let least = own.min_by(|a, b| a.0.total_cmp(&b.0)).expect("a corner at least");
            (least.0, self.factors(&least.1))
        };
        Ok((0..N).map(least_of).collect())
    }

    /// The end of searches along all parameters, and along what each round of them moved, from a point.
    fn descended(&self, mode: usize, start: Point) -> Result<Point> {
        let count = self.parameters.len();
        let mut best = start;
        for _ in 0..MOST_ROUNDS {
            let before = best.clone();
            for parameter in 0..=count {
                self.cancel.check()?;
                let direction: Vec<f64> = if parameter < count {
                    (0..count).map(|k| f64::from(u8::from(k == parameter))).collect()
                } else {
                    best.1.iter().zip(&before.1).map(|(new, old)| new - old).collect()
                };
                best = self.along_line(mode, &direction, best);
            }
            if best.0 >= before.0 * (1.0 - NO_PROGRESS) {
                break;
            }
        }
        Ok(best)
    }

    /// The least purity found on a line through a point: on a grid, about its minimum there, and where the mode's
    /// frequency is nearest to another's, and modes mix.
    fn along_line(&self, mode: usize, direction: &[f64], start: Point) -> Point {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for (at, along) in start.1.iter().zip(direction).filter(|one| *one.1 != 0.0) {
            let ends = [(-1.0 - at) / along, (1.0 - at) / along];
            low = low.max(ends[0].min(ends[1]));
            high = high.min(ends[0].max(ends[1]));
        }
        if low.is_infinite() {
            return start;
        }
        let (from, mut best) = (start.1.clone(), start);
        let mut evaluated = |place: f64| {
            let moved = from.iter().zip(direction).map(|(at, along)| at + place * along);
            let point: Vec<f64> = moved.map(|at| at.clamp(-1.0, 1.0)).collect();
            let (omega, purity) = self.at(&point);
            if purity[mode] < best.0 {
                best = (purity[mode], point);
            }
            let apart = |other: usize| (omega[other] - omega[mode]).abs();
            let others = (0..N).filter(|&other| other != mode);
            [purity[mode], others.map(apart).fold(f64::INFINITY, f64::min)]
        };
        let last = POINTS_OF_LINE - 1;
        let place = |k: usize| low + (high - low) * k as f64 / last as f64;
        let values: Vec<[f64; 2]> = (0..=last).map(|k| evaluated(place(k))).collect();
        for figure in [0, 1] {
            let least = (0..=last).min_by(|&a, &b| values[a][figure].total_cmp(&values[b][figure]));
            let k = least.unwrap_or_default();
            let (low, high) = (place(k.saturating_sub(1)), place((k + 1).min(last)));
            golden(low, high, |at| evaluated(at)[figure]);
        }
        best
    }
}

/// Keeps the smallest purities, ascending.
fn keep(worst: &mut [(f64, usize); STARTS], one: (f64, usize)) {
    if one.0 < worst[STARTS - 1].0 {
        worst[STARTS - 1] = one;
        worst.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
}

/// Narrows a bracket of a minimum by golden sections.
fn golden(mut low: f64, mut high: f64, mut value: impl FnMut(f64) -> f64) {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut of_left, mut of_right) = (value(left), value(right));
    for _ in 0..SECTIONS {
        if of_left <= of_right {
            (high, right, of_right) = (right, left, of_left);
            left = high - GOLDEN * (high - low);
            of_left = value(left);
        } else {
            (low, left, of_left) = (left, right, of_right);
            right = low + GOLDEN * (high - low);
            of_right = value(right);
        }
    }
}
