//! Ranges of natural frequencies and of the purity of modes within tolerances.
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
    let search = PuritySearch::new(&bodies, tolerances, real(&stiffnesses), cancel)?;
    let along = &search.along;
    let nominal = natural(&bodies, along);
    let scaled = |sign: f64| -> Vec<[f64; 3]> {
        // A subframe's mounts have none.
        let share = |owner: usize| tolerances.stiffness.get(owner).copied().unwrap_or(0.0);
        let springs = powertrain.all_springs().zip(along);
        springs
            .map(|(spring, along)| along.map(|k| k * (1.0 + sign * share(spring.owner))))
            .collect()
    };
    let by_stiffness = [-1.0, 1.0].map(|sign| natural(&bodies, &scaled(sign)).frequency().to_vec());
    let body = powertrain.body();
    let of_body = |body| {
        let mut other =
            Powertrain::resting(body, powertrain.mounts().to_vec(), *powertrain.rest())?;
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
type PurityAt = (f64, Vec<f64>);

/// The search for the least purity of each mode within tolerances of stiffness.
struct PuritySearch<'a, const N: usize> {
    bodies: &'a Bodies<'a, N>,
    /// Stiffness of all mounts.
    along: Vec<[f64; 3]>,
    /// Springs and axes that vary together, and their tolerance.
    parameters: Vec<(Vec<(usize, usize)>, f64)>,
    cancel: &'a Cancel,
}

impl<'a, const N: usize> PuritySearch<'a, N> {
    fn new(
        bodies: &'a Bodies<'a, N>,
        tolerances: &MountTolerances,
        along: Vec<[f64; 3]>,
        cancel: &'a Cancel,
    ) -> Result<Self> {
        let mut parameters = Vec::new();
        for (mount, &share) in tolerances.stiffness.iter().enumerate().filter(|one| *one.1 > 0.0) {
            let springs = bodies.powertrain.springs().enumerate();
            let own = springs.filter(|(_, spring)| spring.owner == mount).map(|(k, _)| k);
            let axes = own.flat_map(|spring| (0..3).map(move |axis| (spring, axis)));
            let axes = axes.filter(|&(spring, axis)| along[spring][axis] > 0.0);
            if tolerances.by_axis {
                parameters.extend(axes.map(|place| (vec![place], share)));
            } else {
                parameters.push((axes.collect(), share));
            }
        }
        let count = parameters.len();
        if count > MOST_PARAMETERS {
            let (argument, hint) = if tolerances.by_axis {
                ("corners", "give `by_axis: false`, where the axes of a mount go together")
            } else {
                ("stiffness", "give tolerances of fewer mounts")
            };
            let value = format!("2 to the power of {count} corners");
            return Err(Error::value(argument, value, format!("are too many: {hint}")));
        }
        Ok(Self { bodies, along, parameters, cancel })
    }

    /// Factors of the stiffness of each spring.
    fn factors(&self, point: &[f64]) -> Vec<[f64; 3]> {
        let mut factors = vec![[1.0; 3]; self.along.len()]; // bounded: springs of two bodies
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
    fn descended(&self, mode: usize, start: PurityAt) -> Result<PurityAt> {
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
    fn along_line(&self, mode: usize, direction: &[f64], start: PurityAt) -> PurityAt {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mounts::tests::{four_mounts, mount, powertrain, random};
    use crate::mounts::{Mount, MountFigures, RigidBody, Support, modes};
    use crate::numbers::draws;

    /// Of each mount its own, none of the first.
    fn tolerances(mounts: usize) -> MountTolerances {
        let stiffness = (0..mounts).map(|k| 0.07 * (k % 4) as f64).collect();
        MountTolerances { stiffness, mass: 0.03, inertia: 0.1, cg: 0.01, by_axis: false }
    }

    /// Every bound is that of the modes of engines made heavier, stiffer or moved, one after the other.
    #[test]
    fn bounds_are_those_of_powertrains_at_the_ends() {
        let cancel = Cancel::new();
        let mut number = draws(83);
        for k in 0..6 {
            let (above, below) = (random(&mut number, false), random(&mut number, false));
            let on = |powertrain: Powertrain| {
                let support = Support::Subframe(Box::new(below.clone()));
                if k % 2 == 0 { powertrain } else { powertrain.on(support).unwrap() }
            };
            let plain = |body, mounts: &[Mount]| {
                modes(&on(Powertrain::new(body, mounts.to_vec()).unwrap()), None).unwrap()
            };
            let (body, mounts) = (*above.body(), above.mounts());
            let mut tolerances = tolerances(mounts.len());
            // Corners are searched by the test above this one; here one mount has a tolerance.
            tolerances.stiffness.iter_mut().skip(2).for_each(|share| *share = 0.0);
            let found = robustness(&on(above.clone()), &tolerances, None, &cancel).unwrap();
            let nominal = plain(body, mounts);
            assert_eq!((&found.frequency, &found.purity), (&nominal.frequency, &nominal.purity));
            let near = |found: &[f64], expected: &[f64]| {
                for (found, expected) in found.iter().zip(expected) {
                    // Roundings of another order of sums, at most of the highest frequency.
                    let size = 1e-13 * nominal.frequency.last().unwrap();
                    assert!((found - expected).abs() <= size, "{found} {expected}");
                }
                assert_eq!(found.len(), nominal.frequency.len());
            };
            for (end, sign) in [-1.0, 1.0].into_iter().enumerate() {
                let scaled = mounts.iter().zip(&tolerances.stiffness).map(|(mount, share)| {
                    let mut figures = mount.figures().clone();
                    figures.stiffness = figures.stiffness.map(|along| along * (1.0 + sign * share));
                    Mount::new(figures).unwrap()
                });
                let scaled: Vec<Mount> = scaled.collect();
                near(&found.by_stiffness[end], &plain(body, &scaled).frequency);
                let lighter = body.scaled(1.0 - 0.03 * sign, 1.0 - 0.1 * sign);
                near(&found.by_mass[end], &plain(lighter, mounts).frequency);
            }
            let [mut least, mut largest] = [0; 2].map(|_| nominal.frequency.clone());
            for (x, y, z) in (0..8).map(|k| (k & 1, k >> 1 & 1, k >> 2)) {
                let shift = [x, y, z].map(|end| 0.01 * f64::from(2 * end - 1));
                let moved = plain(body.at(body.cg() + Vector3::from(shift)), mounts);
                for (mode, frequency) in moved.frequency.into_iter().enumerate() {
                    least[mode] = least[mode].min(frequency);
                    largest[mode] = largest[mode].max(frequency);
                }
            }
            near(&found.by_cg[0], &least);
            near(&found.by_cg[1], &largest);
            let step = 1e-5;
            for axis in 0..3 {
                let at = |sign: f64| {
                    let shift = Vector3::ith(axis, sign * step);
                    plain(body.at(body.cg() + shift), mounts).frequency
                };
                let slopes = at(1.0).into_iter().zip(at(-1.0)).map(|(a, b)| 0.5 * (a - b) / step);
                for (found, slope) in found.cg_slope[axis].iter().zip(slopes) {
                    // Differences of the second order, and of roundings.
                    let size = nominal.frequency.last().unwrap() / 0.1;
                    assert!((found - slope).abs() < 1e-6 * size, "{k} {axis} {found} {slope}");
                }
            }
        }
    }

    /// A cube on equal springs: three modes of one frequency, in any directions of their space.
    #[test]
    fn slopes_of_modes_of_one_frequency_are_their_mean() {
        let body = |cg: f64| {
            let moments = [[6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 6.0]];
            RigidBody::new(100.0, [0.0, cg, 0.0], moments, None).unwrap()
        };
        let places = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
        let on = |cg: f64, at: [f64; 3]| {
            let mounts = places.into_iter().enumerate().map(|(k, place)| {
                let place = [0, 1, 2].map(|axis| place[axis] + at[axis]);
                mount(&k.to_string(), place, [1e5; 3])
            });
            powertrain(body(cg), mounts)
        };
        let nothing = MountTolerances {
            stiffness: vec![0.0; 4],
            mass: 0.0,
            inertia: 0.0,
            cg: 0.0,
            by_axis: true,
        };
        let cancel = Cancel::new();
        // Moved by equal stiffness in all directions, a sum of slopes of a group is what their sum does.
        for (at, cg) in [([0.1, -0.2, 0.3], 0.0), ([0.0; 3], 0.0), ([0.0, 0.3, 0.0], 0.1)] {
            let on_mounts = on(cg, at);
            let found = robustness(&on_mounts, &nothing, None, &cancel).unwrap();
            let group = modes(&on_mounts, None).unwrap().group;
            let sum_of = |shift: f64, first: usize| -> f64 {
                let moved = modes(&on(cg + shift, at), None).unwrap().frequency;
                (0..6).filter(|&mode| group[mode] == first).map(|mode| moved[mode]).sum()
            };
            for mode in 0..6 {
                let count = group.iter().filter(|of| **of == group[mode]).count() as f64;
                let sum = (sum_of(1e-5, group[mode]) - sum_of(-1e-5, group[mode])) / 2e-5;
                // Of frequencies of a few Hz, differences of the second order and of roundings.
                let slope = found.cg_slope[1][mode];
                assert!((slope - sum / count).abs() < 1e-6, "{slope} {sum} {count}");
            }
        }
    }

    #[test]
    fn tolerances_out_of_range_are_named_and_so_are_too_many_corners() {
        let cancel = Cancel::new();
        let with = |count: usize| {
            let places = (0..count).map(|k| [0.1 * k as f64, 0.02 * (k * k) as f64, 0.3]);
            let mounts =
                places.enumerate().map(|(k, at)| mount(&k.to_string(), at, [1e5, 0.0, 2e5]));
            powertrain(*four_mounts(0.0).body(), mounts)
        };
        let none = |count: usize| MountTolerances {
            stiffness: vec![0.0; count],
            mass: 0.0,
            inertia: 0.0,
            cg: 0.0,
            by_axis: false,
        };
        let error = |count: usize, of: &MountTolerances| {
            robustness(&with(count), of, None, &cancel).unwrap_err().to_string()
        };
        for share in [-0.1, 1.0, f64::NAN] {
            let of_mass = error(4, &MountTolerances { mass: share, ..none(4) });
            assert!(of_mass.starts_with("mass = "), "{of_mass}");
            let of_inertia = error(4, &MountTolerances { inertia: share, ..none(4) });
            assert!(of_inertia.starts_with("inertia = "), "{of_inertia}");
            let stiffness = vec![0.0, 0.0, share, 0.0];
            let of_mount = error(4, &MountTolerances { stiffness, ..none(4) });
            assert!(of_mount.starts_with("stiffness = "), "{of_mount}");
        }
        assert!(error(4, &MountTolerances { cg: -0.1, ..none(4) }).starts_with("cg = "));
        assert!(error(4, &none(3)).contains("stiffness"));
        // Along one axis of the three a mount has no stiffness, and no end.
        let parameters = |count: usize, by_axis: bool, some: usize| {
            let on_mounts = with(count);
            let bodies = on_mounts.alone().unwrap();
            let mut of = MountTolerances { by_axis, ..none(count) };
            of.stiffness.iter_mut().take(some).for_each(|share| *share = 0.1);
            let along = on_mounts.mounts().iter().map(Mount::static_stiffness).collect();
            PuritySearch::new(&bodies, &of, along, &cancel).map(|search| search.parameters)
        };
        assert_eq!(parameters(20, false, 18).unwrap().len(), 18);
        let by_axis = parameters(20, true, 9).unwrap();
        let places: Vec<_> = by_axis.iter().map(|(places, _)| places[0]).collect();
        let expected: Vec<_> = (0..9).flat_map(|mount| [(mount, 0), (mount, 2)]).collect();
        assert_eq!(places, expected);
        let error = |by_axis, some| parameters(20, by_axis, some).unwrap_err().to_string();
        assert!(error(false, 19).contains("give tolerances of fewer mounts"));
        assert!(
            error(true, 10)
                .contains("2 to the power of 20 corners: are too many: give `by_axis: false`")
        );
    }

    fn searched<const N: usize, R>(
        bodies: &Bodies<N>,
        tolerances: &MountTolerances,
        of: impl FnOnce(&PuritySearch<N>) -> R,
    ) -> R {
        let along = bodies.static_stiffnesses();
        let cancel = Cancel::new();
        of(&PuritySearch::new(bodies, tolerances, along, &cancel).unwrap())
    }

    /// The corners, and then numbers that are the same on any machine.
    #[test]
    fn points_are_corners_and_draws() {
        let on_mounts = four_mounts(0.0);
        let bodies = on_mounts.alone().unwrap();
        searched(&bodies, &tolerances(4), |search| {
            // The first has no tolerance.
            let corners: Vec<Vec<f64>> = (0..8).map(|k| search.point(k)).collect();
            for (k, corner) in corners.iter().enumerate() {
                let ends = [k & 1, k >> 1 & 1, k >> 2].map(|end| 2.0 * end as f64 - 1.0);
                assert_eq!(corner[..], ends);
                let factors = search.factors(corner);
                let shares = [0.07, 0.14, 0.21];
                assert_eq!(factors[0], [1.0; 3]);
                for ((of, end), share) in factors[1..].iter().zip(ends).zip(shares) {
                    assert!(of.iter().all(|factor| (factor - 1.0 - share * end).abs() < 1e-15));
                }
            }
            let drawn: Vec<Vec<f64>> = (8..8 + RANDOM_POINTS).map(|k| search.point(k)).collect();
            let all = drawn.concat();
            let count = all.len() as f64;
            let mean = |power: i32| all.iter().map(|x| x.powi(power)).sum::<f64>() / count;
            // Even from −1 to 1, within three standard deviations of 12 288 draws.
            assert!(all.iter().all(|x| (-1.0..1.0).contains(x)));
            assert!(mean(1).abs() < 3.0 / (3.0 * count).sqrt(), "{}", mean(1));
            assert!((mean(2) - 1.0 / 3.0).abs() < 3.0 * (4.0 / 45.0 / count).sqrt());
            let mut sorted = all.clone();
            sorted.sort_by(f64::total_cmp);
            sorted.dedup();
            assert_eq!(sorted.len(), all.len());
            assert_eq!(
                drawn[0],
                [0.786_688_748_578_528_8, 0.939_441_951_812_663_8, 0.450_067_402_808_647_77]
            );
        });
    }

    /// At a point, and where a mode is least pure, it is a powertrain on mounts as stiff as that.
    #[test]
    fn points_are_powertrains_on_stiffer_mounts() {
        let mut number = draws(41);
        for by_axis in [false, true] {
            let on_mounts = random(&mut number, false);
            let bodies = on_mounts.alone().unwrap();
            let mut of = tolerances(on_mounts.mounts().len());
            of.by_axis = by_axis;
            of.stiffness.iter_mut().skip(3).for_each(|share| *share = 0.0);
            let plain = |factors: &[[f64; 3]]| {
                assert_eq!(factors.len(), on_mounts.mounts().len());
                let scaled = on_mounts.mounts().iter().zip(factors).map(|(mount, factors)| {
                    let mut figures = mount.figures().clone();
                    let own = figures.stiffness;
                    figures.stiffness = [0, 1, 2].map(|axis| own[axis] * factors[axis]);
                    Mount::new(figures).unwrap()
                });
                modes(&Powertrain::new(*on_mounts.body(), scaled.collect()).unwrap(), None).unwrap()
            };
            searched(&bodies, &of, |search| {
                let corners = 1 << search.parameters.len();
                for k in [0, 1, corners - 1, corners, corners + 77] {
                    let point = search.point(k);
                    let mut factors = vec![[1.0; 3]; on_mounts.mounts().len()];
                    for ((places, share), at) in search.parameters.iter().zip(&point) {
                        for &(mount, axis) in places {
                            factors[mount][axis] += share * at;
                        }
                    }
                    let ((omega, purity), expected) = (search.at(&point), plain(&factors));
                    for mode in 0..6 {
                        // Roundings of squares of frequencies, of the highest.
                        let size = 1e-9 * expected.frequency[5];
                        assert!((omega[mode] / TAU - expected.frequency[mode]).abs() < size);
                        assert!((purity[mode] - expected.purity[mode]).abs() < 1e-6);
                    }
                }
                let (least, nominal) =
                    (search.least_pure().unwrap(), plain(&vec![[1.0; 3]; of.stiffness.len()]));
                assert_eq!(least.len(), 6);
                for (mode, (purity, factors)) in least.iter().enumerate() {
                    assert!((purity - plain(factors).purity[mode]).abs() < 1e-6);
                    assert!(*purity <= nominal.purity[mode]);
                }
            });
        }
    }

    #[test]
    fn the_three_smallest_are_kept() {
        let mut number = draws(5);
        for count in [1, 2, 3, 4, 50] {
            let mut all: Vec<(f64, usize)> = (0..count).map(|k| (number(), k)).collect();
            let mut kept = [(f64::INFINITY, 0); STARTS];
            for &one in &all {
                keep(&mut kept, one);
            }
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            all.resize(STARTS.max(count), (f64::INFINITY, 0));
            assert_eq!(kept, all[..STARTS]);
        }
    }

    #[test]
    fn golden_sections_close_in_on_a_minimum() {
        for k in 0..=30 {
            let (low, high, least) = (-1.0, 2.0, -1.0 + 0.1 * f64::from(k));
            let mut places = Vec::new();
            golden(low, high, |place| {
                places.push(place);
                (place - least).abs()
            });
            assert_eq!(places.len(), SECTIONS + 2);
            // A bracket is 0.618 of the one before it, and has the place looked at last.
            for (step, place) in places.iter().enumerate().skip(1) {
                let width = 3.0 * 0.618_034_f64.powi(step as i32 - 1);
                assert!((place - least).abs() <= width, "{least} {step} {place}");
                assert!((low..=high).contains(place));
            }
        }
    }

    /// A body whose stiffness along x goes through that along y: of a mount on its centre of gravity, beside one
    /// that is turned a little and mixes both in a band a hundredth as wide as the tolerance.
    fn crossing(turn: f64, share: f64) -> (Powertrain, MountTolerances) {
        let moments = [[900.0, 0.0, 0.0], [0.0, 1000.0, 0.0], [0.0, 0.0, 1100.0]];
        let body = RigidBody::new(100.0, [0.0; 3], moments, None).unwrap();
        let turned =
            MountFigures { tilt_deg: turn, ..mount("turned", [0.0; 3], [1e5, 1.53e5, 4e5]) };
        let holds = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]];
        let holding = holds.into_iter().enumerate().map(|(k, at)| {
            let stiffness = [0, 1, 2].map(|axis| if at[axis] == 0.0 { 1e5 } else { 0.0 });
            mount(&format!("hold {k}"), at, stiffness)
        });
        let varied = mount("varied", [0.0; 3], [5e4, 0.0, 0.0]);
        let on_mounts = powertrain(body, [varied, turned].into_iter().chain(holding));
        let mut stiffness = vec![0.0; 6];
        stiffness[0] = share;
        let tolerances =
            MountTolerances { stiffness, mass: 0.0, inertia: 0.0, cg: 0.0, by_axis: true };
        (on_mounts, tolerances)
    }

    /// On a line the minimum is met between the points of its grid, and so is a narrow band where modes mix.
    #[test]
    fn lines_meet_minima_and_crossings_between_their_points() {
        for (turn, share) in [(0.3, 0.2), (5.0, 0.2), (0.1, 0.3)] {
            let (on_mounts, tolerances) = crossing(turn, share);
            let bodies = on_mounts.alone().unwrap();
            searched(&bodies, &tolerances, |search| {
                let scanned: Vec<([f64; 6], [f64; 6])> =
                    (0..=2000).map(|k| search.at(&[1e-3 * f64::from(k) - 1.0])).collect();
                for mode in 0..6 {
                    let least = scanned.iter().map(|of| of.1[mode]).fold(f64::INFINITY, f64::min);
                    for (start, direction) in [(-1.0, 1.0), (0.4, -3.0), (1.0, 0.25)] {
                        let from = vec![start];
                        let own = (search.at(&from).1[mode], from);
                        let (purity, point) = search.along_line(mode, &[direction], own);
                        assert!((-1.0..=1.0).contains(&point[0]));
                        assert_eq!(search.at(&point).1[mode], purity);
                        // Two modes that cross share their energy: half and half.
                        assert!(purity < least + 0.2, "{turn} {mode} {start}: {purity} {least}");
                    }
                }
            });
        }
    }

    /// Searches from a point end where no line along a parameter leads further down, and no start is better.
    #[test]
    fn descents_end_where_no_parameter_leads_further_down() {
        let mut number = draws(29);
        for k in 0..3 {
            let on_mounts = random(&mut number, false);
            let bodies = on_mounts.alone().unwrap();
            let mut tolerances = tolerances(on_mounts.mounts().len());
            tolerances.by_axis = k == 0;
            let some = if k == 0 { 2 } else { 4 };
            tolerances.stiffness.iter_mut().skip(some).for_each(|share| *share = 0.0);
            searched(&bodies, &tolerances, |search| {
                let count = search.parameters.len();
                for mode in 0..6 {
                    let from: Vec<f64> = (0..count).map(|_| number()).collect();
                    let start = (search.at(&from).1[mode], from);
                    let (purity, point) = search.descended(mode, start.clone()).unwrap();
                    assert!(purity <= start.0);
                    assert_eq!(search.at(&point).1[mode], purity);
                    for parameter in 0..count {
                        let direction: Vec<f64> =
                            (0..count).map(|k| if k == parameter { 1.0 } else { 0.0 }).collect();
                        let further = search.along_line(mode, &direction, (purity, point.clone()));
                        // A round that gains less than a millionth ends the search, or the eighth.
                        assert!(further.0 >= purity * (1.0 - 1e-3), "{k} {mode} {parameter}");
                    }
                }
                let all = search.least_pure().unwrap();
                let starts = (1 << count) + RANDOM_POINTS;
                for k in (0..starts).step_by(97).chain([0, (1 << count) - 1, starts - 1]) {
                    let (_, purity) = search.at(&search.point(k));
                    assert!(all.iter().zip(purity).all(|(least, purity)| least.0 <= purity));
                }
            });
        }
    }
}
