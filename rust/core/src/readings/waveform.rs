//! Force, moment and torque at given crank angles: from exact kinematics, or as a sum of orders.

use std::sync::Arc;

use ndarray::{Array1, Array2};

use crate::Complex64;
use crate::engine::Engine;
use crate::load::kinematics::Kinematics;
use crate::load::{Scene, find_or_push};
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::{CrankAngles, check};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::pool;
use crate::numbers::simd::vectorised;
use crate::readings::balance::{self, Balance, Orders, Request, Vector, angular_speed};
use crate::readings::quantity::Part;
use crate::source::INERTIA;
use crate::source::over_angle::{AngleBlock, BLOCK, Columns, Quantities, Units};

/// An engine's shaking over crank angle.
#[derive(Debug, Clone, PartialEq)]
pub struct Waveform {
    /// Shaking force along x and y, N: (`n_theta`, 2).
    pub force: Array2<f64>,
    /// Rocking moment about x and y, N·m: (`n_theta`, 2).
    pub moment: Array2<f64>,
    /// Roll torque on the block about +z, N·m: (`n_theta`,).
    pub torque: Option<Array1<f64>>,
    /// Torque on the crank about +z, N·m: (`n_theta`,).
    pub crank_torque: Option<Array1<f64>>,
    /// What each name but `inertia` makes of these: gas pressure, and further loads.
    pub parts: Vec<PartOverAngle>,
    /// The orders summed; none for exact kinematics.
    pub balance: Option<Balance>,
}

/// What the sources of a name make, where they make any.
#[derive(Debug, Clone, PartialEq)]
pub struct PartOverAngle {
    /// Name of the sources.
    pub name: Arc<str>,
    /// Of the shaking force along x and y, and of the rocking moment about them: (`n_theta`, 2).
    pub planar: Option<[Array2<f64>; 2]>,
    /// Of the torques on the block and on the crank.
    pub torque: Option<[Array1<f64>; 2]>,
}

/// From exact kinematics at crank angles in degrees.
///
/// ```
/// # let four = crankpin_core::engine::file::from_toml(
/// #     "schema = 1
/// #     cylinder = { crank_radius = 0.043, rod_length = 0.145, reciprocating_mass = 0.66 }
/// #     placements = [
/// #         { tdc_deg = 0, bank_deg = 90, z = 0 }, { tdc_deg = 180, bank_deg = 90, z = 0.1 },
/// #         { tdc_deg = 180, bank_deg = 90, z = 0.2 }, { tdc_deg = 0, bank_deg = 90, z = 0.3 },
/// #     ]",
/// # )?;
/// use crankpin_core::balance::Request;
/// use crankpin_core::{Cancel, waveform};
///
/// let request = Request { rpm: 6000.0, reference_z: None, torque: true };
/// let found = waveform::exact(&four, &request, &[0.0, 45.0, 90.0], &Cancel::new())?;
/// assert_eq!(found.force.dim(), (3, 2));
/// assert!(found.force[[0, 1]] > 1e4); // N, upwards with the pistons 1 and 4 at the top
/// # Ok::<(), crankpin_core::Error>(())
/// ```
pub fn exact(
    engine: &Engine,
    request: &Request,
    theta_deg: &[f64],
    cancel: &Cancel,
) -> Result<Waveform> {
    if engine.spectrum().is_some() {
        let hint = "exact kinematics needs the slider-crank; give orders, or \"auto\"";
        return Err(Error::value("spectrum", "given", hint));
    }
    let omega = angular_speed(request.rpm)?;
    engine.check_speeds(&[request.rpm])?;
    let loads = Scene::of(engine, request.reference_z)?;
    let kinematics = Kinematics::new(&loads);
    let factors = kinematics.factors(omega);
    let mut shape = Shape::new(&loads, request.torque);
    shape.zero_bounds = kinematics.zero_bounds(&factors);
    let wanted = Quantities { force: true, moment: true, torque: request.torque };
    let part_of = loads.groups.map_to(|group| shape.part(&group.name).map_or(0, |part| part + 1));
    in_blocks(theta_deg, &shape, cancel, |angles, columns| {
        let block = AngleBlock::new(angles, 0..angles.len());
        for sum in &kinematics.sums {
            let (factor, columns) = (factors[sum.group], &mut columns[part_of[sum.group]]);
            sum.source.over_angle(&sum.loads, &block, wanted, factor, columns)?;
        }
        if let [whole, parts @ ..] = columns {
            for part in parts.iter() {
                whole.add(part, wanted);
            }
        }
        Ok(())
    })
}

/// As a sum of orders.
pub fn from_orders(
    engine: &Engine,
    request: &Request,
    theta_deg: &[f64],
    orders: &Orders,
    cancel: &Cancel,
) -> Result<Waveform> {
    let balance = balance::balance(engine, request, orders, cancel)?;
    let loads = Scene::of(engine, request.reference_z)?;
    // Phasors that cancel are zero already.
    let shape = Shape::new(&loads, balance.has_torque);
    let parts = shape.parts.iter().map(|(name, _)| balance.of_part(Part::Of(name)));
    let balances: Vec<Balance> = std::iter::once(balance.clone()).chain(parts).collect();
    let waveform = in_blocks(theta_deg, &shape, cancel, |angles, columns| {
        vectorised(
            #[inline(always)]
            || {
                for (columns, balance) in columns.iter_mut().zip(&balances) {
                    columns.add_orders(balance, angles);
                }
            },
        );
        Ok(())
    })?;
    Ok(Waveform { balance: Some(balance), ..waveform })
}

/// What a waveform has.
struct Shape {
    torque: bool,
    /// Names of its parts but inertia, and whether each has forces, and torques.
    parts: Vec<(Arc<str>, [bool; 2])>,
    /// Forces and moments that are rounding.
    zero_bounds: [f64; 2],
}

impl Shape {
    /// Of loads, with torques if they are wanted.
    fn new(loads: &Scene, torque: bool) -> Self {
        let mut parts: Vec<(Arc<str>, [bool; 2])> = Vec::new();
        for (k, group) in
            loads.groups.indices().zip(&loads.groups).filter(|(_, group)| *group.name != *INERTIA)
        {
            let new = || (Arc::clone(&group.name), [false; 2]);
            let (_, has) = find_or_push(&mut parts, |(name, _)| *name == group.name, new);
            let [force, own_torque] = loads.has(k);
            (has[0], has[1]) = (has[0] || force, has[1] || own_torque && torque);
        }
        Self { torque, parts, zero_bounds: [0.0; 2] }
    }

    /// Index of a part.
    fn part(&self, name: &str) -> Option<usize> {
        self.parts.iter().position(|(own, _)| **own == *name)
    }
}

impl Columns {
    #[inline(always)]
    fn add_orders(&mut self, balance: &Balance, angles: &CrankAngles) {
        for (column, mean) in self.torque.iter_mut().zip(balance.mean(Part::Whole)) {
            for torque in column.iter_mut() {
                *torque += mean;
            }
        }
        for (k, &order) in balance.orders.iter().enumerate() {
            let Units { cos, sin } = Units::new(angles, 0..angles.len(), order);
            let torque = balance.wrenches[k].torque;
            let pairs = [
                (&mut self.force, balance.xy(Vector::Force, k)),
                (&mut self.moment, balance.xy(Vector::Moment, k)),
                (&mut self.torque, [torque.roll, torque.crank]),
            ];
            let columns =
                pairs.into_iter().flat_map(|(columns, phasors)| columns.iter_mut().zip(phasors));
            for (column, phasor) in columns {
                if phasor == Complex64::default() {
                    continue;
                }
                for i in 0..BLOCK {
                    column[i] += phasor.re * cos[i] - phasor.im * sin[i];
                }
            }
        }
    }
}

/// Numbers of [`pool::is_worth_parallel`] that take as long as a crank angle of an engine of a few cylinders.
const NUMBERS_PER_ANGLE: usize = 24;

/// Run over the crank angles in blocks, in parallel.
fn in_blocks(
    theta_deg: &[f64],
    shape: &Shape,
    cancel: &Cancel,
    add: impl Fn(&CrankAngles, &mut [Columns]) -> Result<()> + Send + Sync,
) -> Result<Waveform> {
    let hint = "split theta_deg into parts";
    limits::result_size("theta_deg", &[theta_deg.len(), 16], size_of::<f64>(), hint)?;
    check(theta_deg, cancel)?;
    if !pool::is_worth_parallel(NUMBERS_PER_ANGLE * theta_deg.len()) {
        return fill_blocks(theta_deg, shape, cancel, add);
    }
    // Results are allocated there too: an allocator that keeps an arena for each thread then reuses
    // their memory, which halves the time of a hundred thousand angles.
    pool::run(cancel, || fill_blocks(theta_deg, shape, cancel, add))
}

fn fill_blocks(
    theta_deg: &[f64],
    shape: &Shape,
    cancel: &Cancel,
    add: impl Fn(&CrankAngles, &mut [Columns]) -> Result<()> + Sync,
) -> Result<Waveform> {
    let angles = theta_deg.len();
    let whole = [true, shape.torque];
    let has: Vec<[bool; 2]> =
        std::iter::once(whole).chain(shape.parts.iter().map(|(_, has)| *has)).collect();
    // Of the whole and each part: force and moment, then torques.
    let mut planar: Vec<[Vec<f64>; 2]> = Vec::new();
    let mut torques: Vec<[Vec<f64>; 2]> = Vec::new();
    for [has_planar, has_torque] in &has {
        let zeros = |has: bool, size: usize| memory::zeros(if has { size * angles } else { 0 });
        planar.push([zeros(*has_planar, 2)?, zeros(*has_planar, 2)?]);
        torques.push([zeros(*has_torque, 1)?, zeros(*has_torque, 1)?]);
    }
    let mut pairs: Vec<_> =
        planar.iter_mut().flatten().map(|values| values.chunks_mut(2 * BLOCK)).collect();
    let mut columns: Vec<_> =
        torques.iter_mut().flatten().map(|values| values.chunks_mut(BLOCK)).collect();
    let mut tasks = memory::with_capacity(angles.div_ceil(BLOCK))?;
    for thetas in theta_deg.chunks(BLOCK) {
        let mut of_block: Vec<&mut [f64]> = memory::with_capacity(2 * pairs.len())?;
        of_block.extend(pairs.iter_mut().map(|chunks| chunks.next().unwrap_or_default()));
        of_block.extend(columns.iter_mut().map(|chunks| chunks.next().unwrap_or_default()));
        tasks.push((thetas, of_block));
    }
    let block = |(thetas, mut out): (&[f64], Vec<&mut [f64]>)| {
        cancel.check()?;
        let mut columns: Vec<Columns> = memory::with_capacity(has.len())?;
        columns.resize_with(has.len(), || Columns::ZERO);
        add(&CrankAngles::of_checked(thetas), &mut columns)?;
        let (planar, torques) = out.split_at_mut(2 * has.len());
        for (columns, planar) in columns.iter().zip(planar.chunks_mut(2)) {
            let vectors = [&columns.force, &columns.moment].into_iter().zip(shape.zero_bounds);
            for (out, ([x, y], bound)) in planar.iter_mut().zip(vectors) {
                let snapped = |value: f64| if value.abs() <= bound { 0.0 } else { value };
                for (pair, (x, y)) in out.as_chunks_mut().0.iter_mut().zip(x.iter().zip(&y[..])) {
                    *pair = [snapped(*x), snapped(*y)];
                }
            }
        }
        let torque = columns.iter().flat_map(|columns| &columns.torque);
        for (out, column) in torques.iter_mut().zip(torque) {
            let count = out.len();
            out.copy_from_slice(&column[..count]);
        }
        Ok(())
    };
    pool::each(cancel, tasks, NUMBERS_PER_ANGLE * angles, block)?;
    let pair = |values: Vec<f64>| memory::array("theta_deg", (values.len() / 2, 2), values);
    let mut of_all = Vec::new();
    for (([force, moment], torque), [has_planar, has_torque]) in
        planar.into_iter().zip(torques).zip(has)
    {
        let planar = if has_planar { Some([pair(force)?, pair(moment)?]) } else { None };
        of_all.push((planar, has_torque.then(|| torque.map(Array1::from))));
    }
    let mut of_all = of_all.into_iter();
    let (planar, torque) = of_all.next().unwrap_or_default();
    let [force, moment] = planar.unwrap_or_default();
    let (torque, crank_torque) = torque.map(<(_, _)>::from).unzip();
    let part = |((name, _), (planar, torque)): (&(Arc<str>, _), _)| PartOverAngle {
        name: Arc::clone(name),
        planar,
        torque,
    };
    let parts = shape.parts.iter().zip(of_all).map(part).collect();
    Ok(Waveform { force, moment, torque, crank_torque, parts, balance: None })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::load;

    #[test]
    fn exact_samples_are_the_sums_of_all_orders() {
        let engine = load::tests::engine();
        let request = Request { rpm: 1000.0, reference_z: Some(0.07), torque: true };
        let theta_deg: Vec<f64> = (0..40).map(|k| 27.0 * f64::from(k)).collect();
        let exact = exact(&engine, &request, &theta_deg, &Cancel::new()).unwrap();
        let all = Orders::Auto { rtol: 1e-14 };
        let summed = from_orders(&engine, &request, &theta_deg, &all, &Cancel::new()).unwrap();
        let planar = [(&exact.force, &summed.force), (&exact.moment, &summed.moment)];
        for (one, other) in planar {
            let largest = one.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            for (one, other) in one.iter().zip(other) {
                // Roundings of some twenty orders and ten loads.
                assert!((one - other).abs() < 1e-13 * largest, "{one} is not {other}");
            }
        }
        let torques = [(exact.torque, summed.torque), (exact.crank_torque, summed.crank_torque)];
        for (one, other) in torques {
            let (one, other) = (one.unwrap(), other.unwrap());
            let largest = one.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!(largest > 0.1, "no torque");
            for (one, other) in one.iter().zip(&other) {
                assert!((one - other).abs() < 1e-13 * largest, "{one} is not {other}");
            }
        }
    }

    #[test]
    fn cancellation_stops_at_the_next_block() {
        // Four blocks are evaluated one by one.
        let thetas = [0.0; 4 * BLOCK];
        let run = |last: usize| {
            let (cancel, blocks) = (Cancel::new(), AtomicUsize::new(0));
            let add = |_: &CrankAngles, _: &mut [Columns]| {
                if blocks.fetch_add(1, Ordering::Relaxed) + 1 == last {
                    cancel.raise();
                }
                Ok(())
            };
            let shape = Shape { torque: true, parts: Vec::new(), zero_bounds: [0.0; 2] };
            let result = in_blocks(&thetas, &shape, &cancel, add).map(drop);
            (result, blocks.into_inner())
        };
        assert_eq!(run(0), (Ok(()), 4));
        for last in 1..4 {
            assert_eq!(run(last), (Err(Error::Cancelled), last));
        }
    }
}
