//! Loads inside an engine: what rods, wrist pins, cylinder walls and main bearings carry, and the
//! shear and bending of crank and crankcase along z.
//!
//! Each part of a cylinder is a free body. With u along the bore away from the crank, w the side to
//! which the crankpin swings after top dead centre, a the piston's acceleration along u, G the gas
//! force on the piston along −u, m the reciprocating mass, of which mₚ is the piston's, φ the rod's
//! angle to the bore, and J the rod's moment of inertia beyond that of its two masses:
//!
//! - the force that drives the massless rod at the wrist pin is −(G + m·a) along u, and
//!   N = (G + m·a)·tan φ − J·φ̈/(l·cos φ) along w: J is swung by a pair of forces across the bore;
//! - the wall exerts N on the piston along w, the piston −N on the wall;
//! - the rod exerts that force on the crankpin, and the centrifugal force of its rotating mass;
//! - the wrist pin carries G + mₚ·a along u and −N along w.
//!
//! A crank is statically determinate between neighbouring main bearings: each load of it is shared by
//! the bearing in front of it and the one behind by the lever rule, and one outside the end bearings
//! is carried by the two nearest, one of which is pulled.

use std::ops::Range;
use std::sync::Arc;

use ndarray::{Array2, Array3, ArrayViewMut, Axis, Dimension};

use crate::Complex64;
use crate::engine::Engine;
use crate::gear::rod::{Rod, Swing};
use crate::gear::slider_crank::{CrankPosition, Proportions};
use crate::load::{Alike, Load, Loads, Source};
use crate::numbers::angle::cis_degrees;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::{CrankAngles, check, parts};
use crate::numbers::error::{Error, Result};
use crate::numbers::order::Order;
use crate::numbers::simd::vectorised;
use crate::numbers::{limits, memory, pool};
use crate::pressure::Cycle;
use crate::readings::balance::angular_speed;
use crate::readings::kinematics::{AngleColumn, BLOCK, Units};

/// Largest share of a load outside the end bearings that one carries: rounding is that times larger.
const MOST_SHARE: f64 = 1e6;

/// An engine at a speed, for the loads inside it.
pub struct Internal {
    rods: Vec<DrivenRod>,
    /// On the crank besides what rods bring to its pins.
    on_crank: Vec<Turning>,
    on_shafts: Vec<Turning>,
    /// Places of the main bearings, ascending, m.
    mains: Vec<f64>,
}

/// Loads of bearings and walls at given crank angles, N; vectors along x and y, fixed in the engine.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingLoads {
    /// Force of each rod on its crankpin: (`n_cylinders`, `n_theta`, 2).
    pub crankpin: Array3<f64>,
    /// Force of each rod on its wrist pin: (`n_cylinders`, `n_theta`, 2).
    pub wrist_pin: Array3<f64>,
    /// Force of the crank on each main bearing: (`n_mains`, `n_theta`, 2).
    pub main: Array3<f64>,
    /// Force of each piston on its wall, towards the side from which the crankpin swings after top
    /// dead centre: (`n_cylinders`, `n_theta`).
    pub side_thrust: Array2<f64>,
    /// Force along each rod at its wrist pin, compression above zero: (`n_cylinders`, `n_theta`).
    pub rod: Array2<f64>,
    /// Gas force on each piston towards the crank, and on each head away from it: (`n_cylinders`,
    /// `n_theta`).
    pub gas: Array2<f64>,
}

/// Bearings whose loads are vectors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bearing {
    /// Of a rod on its crankpin.
    Crankpin,
    /// Of a rod on its wrist pin.
    WristPin,
    /// Of the crank in the crankcase.
    Main,
}

/// Axes that turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TurningAxes {
    /// From the crank's axis to the crankpin, and a quarter turn ahead: those of pins and journals.
    Crank,
    /// Along the rod to the wrist pin, and a quarter turn ahead: those of the rod's bearings.
    Rod,
}

/// What is cut at some z.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The crankshaft, which rods and unbalances load and main bearings support.
    Crank,
    /// The crankcase, which main bearings, walls, heads and balance shafts load.
    Crankcase,
}

/// Shear and bending moment along z, at given crank angles.
#[derive(Debug, Clone, PartialEq)]
pub struct Sections {
    /// Sum of the loads up to each place and at it, along x and y, N: (`n_places`, `n_theta`, 2).
    pub shear: Array3<f64>,
    /// Moment of the loads in front of each place about it, about x and y, N·m: (`n_places`,
    /// `n_theta`, 2).
    pub bending: Array3<f64>,
}

/// A cylinder's piston and rod at a speed.
struct DrivenRod {
    proportions: Proportions,
    /// `e^{−i·tdc}`.
    phase: Complex64,
    /// Unit vector along the bore.
    bore: Complex64,
    z: f64,
    /// m·r·ω² of the reciprocating mass, N.
    reciprocating: f64,
    /// The same of the piston alone; of the whole where it is not known.
    piston: f64,
    /// The same of the rod's rotating mass; zero where it is not known.
    rotating: f64,
    /// J·ω²/l, N.
    couple: f64,
    /// Pressure on the piston, where it counts.
    gas: Option<PistonGas>,
}

/// Pressure on a piston.
struct PistonGas {
    cycle: Arc<Cycle>,
    /// Crank angle of the firing top dead centre, degrees.
    phase: f64,
    /// Absolute, Pa.
    crankcase: f64,
    /// m².
    area: f64,
}

/// A force that turns at a multiple of crank speed.
struct Turning {
    z: f64,
    ratio: i32,
    /// At θ = 0, x + iy, N.
    at_start: Complex64,
}

/// Forces of one cylinder; vectors along u and w.
struct RodForces {
    crankpin: [f64; 2],
    wrist_pin: [f64; 2],
    across: f64,
    compression: f64,
}

/// The same over a block of crank angles; vectors along x and y.
struct RodColumns {
    crankpin: [AngleColumn; 2],
    wrist_pin: [AngleColumn; 2],
    across: AngleColumn,
    compression: AngleColumn,
    gas: AngleColumn,
}

impl PistonGas {
    /// Of a cylinder of an engine.
    fn of(engine: &Engine, cylinder: usize) -> Option<Self> {
        let gas = engine.gas()?;
        let cycle = Arc::clone(&gas.cycles[gas.cycle_of[cylinder]?]);
        let radius = engine.placements()[cylinder].cylinder.crank_radius();
        let area = engine.swept_by_radius(cylinder)? / radius;
        let phase = engine.firing_phase(cylinder).degrees();
        Some(Self { cycle, phase, crankcase: gas.crankcase, area })
    }

    /// Force on the piston towards the crank, N.
    fn force(&self, theta_deg: f64) -> f64 {
        let pressure = self.cycle.pressure((theta_deg - self.phase).to_radians());
        self.area * (pressure - self.crankcase)
    }
}

impl DrivenRod {
    #[inline(always)]
    fn forces(&self, crank: &CrankPosition, gas: f64) -> RodForces {
        let motion = self.proportions.motion_at(crank);
        let towards_crank = gas + self.reciprocating * motion.acceleration;
        let mut across = motion.slope * towards_crank;
        if self.couple != 0.0 {
            let swing = Swing::new(&self.proportions, crank);
            across -= self.couple * motion.secant * swing.acceleration;
        }
        let on_wrist_pin = gas + self.piston * motion.acceleration;
        RodForces {
            crankpin: [
                self.rotating * crank.cos - towards_crank,
                self.rotating * crank.sin + across,
            ],
            wrist_pin: [on_wrist_pin, -across],
            across,
            compression: (on_wrist_pin + motion.slope * across) / motion.secant,
        }
    }

    /// Unit vector of the first of some axes.
    #[inline(always)]
    fn axis(&self, crank: &CrankPosition, axes: TurningAxes) -> Complex64 {
        let along = match axes {
            TurningAxes::Crank => Complex64::new(crank.cos, crank.sin),
            TurningAxes::Rod => {
                let motion = self.proportions.motion_at(crank);
                Complex64::new(1.0, -motion.slope) / motion.secant
            }
        };
        self.bore * along
    }
}

impl RodColumns {
    const ZERO: Self = Self {
        crankpin: [AngleColumn::ZERO; 2],
        wrist_pin: [AngleColumn::ZERO; 2],
        across: AngleColumn::ZERO,
        compression: AngleColumn::ZERO,
        gas: AngleColumn::ZERO,
    };

    /// Overwrite all but the gas, which is read.
    #[inline(always)]
    fn fill(&mut self, rod: &DrivenRod, units: &Units) {
        for k in 0..BLOCK {
            let forces = rod.forces(&units.crank(rod.phase, k), self.gas[k]);
            let pairs =
                [(&mut self.crankpin, forces.crankpin), (&mut self.wrist_pin, forces.wrist_pin)];
            for ([x, y], [u, w]) in pairs {
                x[k] = rod.bore.re * u - rod.bore.im * w;
                y[k] = rod.bore.im * u + rod.bore.re * w;
            }
            self.across[k] = forces.across;
            self.compression[k] = forces.compression;
        }
    }
}

impl Internal {
    /// Of an engine whose main bearings are known.
    pub fn new(engine: &Engine, rpm: f64) -> Result<Self> {
        engine.check_one_crank("bearing_loads")?;
        if engine.spectrum().is_some() {
            let hint = "bearing loads need the slider-crank; leave out the spectrum";
            return Err(Error::value("spectrum", "given", hint));
        }
        if engine.mains().is_empty() {
            return Err(Error::value("mains", "none", "give the places of the main bearings"));
        }
        let omega = angular_speed(rpm)?;
        let square = omega * omega;
        let turning = |load: &Load, amount: f64| Turning {
            z: load.z,
            ratio: load.ratio,
            at_start: load.unit()
                * load.phase.cis(-i64::from(load.ratio))
                * (amount * square * f64::from(load.ratio * load.ratio)),
        };
        let loads = Loads::new(engine, 0.0, Alike::Dimensions);
        let (pistons, turn) = loads.list.split_at(engine.placements().len());
        let (of_crank, of_shafts) = turn.split_at(engine.crank_unbalances().count());
        let all = |loads: &[Load]| {
            let unbalances = loads.iter().filter(|load| load.source == Source::Unbalance);
            unbalances.map(|load| turning(load, load.weight)).collect()
        };
        let mut found = Self {
            rods: Vec::new(),
            on_crank: all(of_crank),
            on_shafts: all(of_shafts),
            mains: engine.mains().to_vec(),
        };
        for (i, load) in pistons.iter().enumerate() {
            let Source::Piston { rod_inertia, .. } = load.source else { continue };
            let (cylinder, details) = (&engine.placements()[i].cylinder, &engine.details()[i]);
            let (radius, length) = (cylinder.crank_radius(), cylinder.rod_length());
            let mut rotating = 0.0;
            if let Some([mass, inertia, to_crankpin]) = details.rod {
                rotating = radius * Rod::new(mass, inertia, length, to_crankpin)?.rotating_mass();
                // The crank's own share of the rotating mass is what the rod's leaves of it.
                found.on_crank.push(turning(load, -rotating));
            }
            let piston = details.piston_mass.map_or(load.weight, |mass| mass * radius);
            found.rods.push(DrivenRod {
                proportions: cylinder.proportions(),
                phase: load.phase.cis(-1),
                bore: load.unit(),
                z: load.z,
                reciprocating: load.weight * square,
                piston: piston * square,
                rotating: rotating * square,
                couple: rod_inertia * square / length,
                gas: PistonGas::of(engine, i),
            });
        }
        let far = |z: &f64| found.levers(*z).iter().any(|(_, share)| share.abs() > MOST_SHARE);
        if let Some(z) = found.places().into_iter().find(far) {
            let hint = format!("the load at z = {z:e} is too far from them for the lever rule");
            return Err(Error::value("mains", format!("{:?}", found.mains), hint));
        }
        Ok(found)
    }

    /// Places of loads and main bearings along z, ascending, m.
    #[must_use]
    pub fn places(&self) -> Vec<f64> {
        let turning = self.on_crank.iter().chain(&self.on_shafts).map(|load| load.z);
        let loads = self.rods.iter().map(|rod| rod.z).chain(turning);
        let mut places: Vec<f64> = loads.chain(self.mains.iter().copied()).collect();
        places.sort_unstable_by(f64::total_cmp);
        places.dedup();
        places
    }

    /// Share of each cylinder's crankpin load that each main bearing carries: (`n_mains`,
    /// `n_cylinders`).
    #[must_use]
    pub fn shares(&self) -> Array2<f64> {
        let mut shares = Array2::zeros((self.mains.len(), self.rods.len()));
        for (i, rod) in self.rods.iter().enumerate() {
            for (main, share) in self.levers(rod.z) {
                shares[[main, i]] += share;
            }
        }
        shares
    }

    /// Loads at crank angles in degrees.
    pub fn loads(&self, theta_deg: &[f64], cancel: &Cancel) -> Result<BearingLoads> {
        let (rods, mains, count) = (self.rods.len(), self.mains.len(), theta_deg.len());
        let numbers = 7 * rods + 2 * mains;
        check_angles(theta_deg, numbers, cancel)?;
        let mut found = BearingLoads {
            crankpin: vectors(rods, count)?,
            wrist_pin: vectors(rods, count)?,
            main: vectors(mains, count)?,
            side_thrust: scalars(rods, count)?,
            rod: scalars(rods, count)?,
            gas: scalars(rods, count)?,
        };
        let blocks = blocks(theta_deg, cancel)?;
        let vectors = found.crankpin.outer_iter_mut().zip(found.wrist_pin.outer_iter_mut());
        let scalars = found.side_thrust.outer_iter_mut().zip(found.rod.outer_iter_mut());
        let rows = vectors.zip(scalars).zip(found.gas.outer_iter_mut()).enumerate();
        let rows = rows.map(|(i, (((crankpin, wrist_pin), (across, rod)), gas))| {
            (i, [crankpin, wrist_pin].map(slice), [across, rod, gas].map(slice))
        });
        each(rows.collect(), 2 * rods * count, cancel, |(i, mut vectors, mut scalars)| {
            let mut columns = RodColumns::ZERO;
            for (range, units) in &blocks {
                cancel.check()?;
                if let Some(gas) = &self.rods[i].gas {
                    for (value, &theta) in columns.gas.iter_mut().zip(&theta_deg[range.clone()]) {
                        *value = gas.force(theta);
                    }
                }
                vectorised(
                    #[inline(always)]
                    || columns.fill(&self.rods[i], units),
                );
                let pairs = [&columns.crankpin, &columns.wrist_pin];
                for (row, [x, y]) in vectors.iter_mut().zip(pairs) {
                    let row = row[2 * range.start..2 * range.end].chunks_exact_mut(2);
                    for (pair, (x, y)) in row.zip(x.iter().zip(&y[..])) {
                        pair.copy_from_slice(&[*x, *y]);
                    }
                }
                let values = [&columns.across, &columns.compression, &columns.gas];
                for (row, column) in scalars.iter_mut().zip(values) {
                    row[range.clone()].copy_from_slice(&column[..range.len()]);
                }
            }
            Ok(())
        })?;
        let rows = found.main.outer_iter_mut().map(slice).enumerate().collect();
        each(rows, mains * count, cancel, |(main, row)| {
            let share = |z: f64| self.levers(z).iter().find(|(j, _)| *j == main).map(|at| at.1);
            let turning = self.on_crank.iter().filter_map(|u| Some(u.at_start * share(u.z)?));
            let turning: Complex64 = turning.sum();
            let carried = self.rods.iter().zip(found.crankpin.outer_iter());
            let carried =
                carried.filter_map(|(rod, force)| Some((share(rod.z)?, force.to_slice()?)));
            let carried: Vec<_> = carried.collect();
            for (range, units) in &blocks {
                cancel.check()?;
                let (start, end) = (2 * range.start, 2 * range.end);
                let row = &mut row[start..end];
                for (share, force) in &carried {
                    for (sum, force) in row.iter_mut().zip(&force[start..]) {
                        *sum += share * force;
                    }
                }
                let units = units.cos.iter().zip(&units.sin[..]);
                for (pair, (cos, sin)) in row.chunks_exact_mut(2).zip(units) {
                    pair[0] += turning.re * cos - turning.im * sin;
                    pair[1] += turning.re * sin + turning.im * cos;
                }
            }
            Ok(())
        })?;
        Ok(found)
    }

    /// Loads of bearings in axes that turn: (n, `n_theta`, 2). Of main bearings those of the journals,
    /// on the crank as the first cylinder's crankpin.
    pub fn turned(
        &self,
        bearing: Bearing,
        axes: TurningAxes,
        theta_deg: &[f64],
        cancel: &Cancel,
    ) -> Result<Array3<f64>> {
        let loads = self.loads(theta_deg, cancel)?;
        let (mut vectors, axes) = match bearing {
            Bearing::Crankpin => (loads.crankpin, axes),
            Bearing::WristPin => (loads.wrist_pin, axes),
            Bearing::Main => (loads.main, TurningAxes::Crank),
        };
        let (blocks, numbers) = (blocks(theta_deg, cancel)?, vectors.len());
        let rows = vectors.outer_iter_mut().map(slice).enumerate().collect();
        each(rows, numbers, cancel, |(row, values)| {
            let rod = &self.rods[if bearing == Bearing::Main { 0 } else { row }];
            for (range, units) in &blocks {
                cancel.check()?;
                let pairs = values[2 * range.start..2 * range.end].chunks_exact_mut(2);
                for (k, pair) in pairs.enumerate() {
                    let axis = rod.axis(&units.crank(rod.phase, k), axes);
                    let seen = Complex64::new(pair[0], pair[1]) * axis.conj();
                    pair.copy_from_slice(&[seen.re, seen.im]);
                }
            }
            Ok(())
        })?;
        Ok(vectors)
    }

    /// Shear and bending of a part at [`Self::places`].
    pub fn sections(&self, part: Part, theta_deg: &[f64], cancel: &Cancel) -> Result<Sections> {
        let (z, count) = (self.places(), theta_deg.len());
        check_angles(theta_deg, 4 * z.len(), cancel)?;
        let loads = self.loads(theta_deg, cancel)?;
        let (mut shear, mut bending) = (vectors(z.len(), count)?, vectors(z.len(), count)?);
        let at = |place: f64| z.partition_point(|&other| other < place);
        let (sign, turning) = match part {
            Part::Crank => (-1.0, &self.on_crank),
            Part::Crankcase => (1.0, &self.on_shafts),
        };
        for (&place, row) in self.mains.iter().zip(loads.main.outer_iter()) {
            shear.index_axis_mut(Axis(0), at(place)).scaled_add(sign, &row);
        }
        for (i, rod) in self.rods.iter().enumerate() {
            cancel.check()?;
            let mut sum = shear.index_axis_mut(Axis(0), at(rod.z));
            if part == Part::Crank {
                sum += &loads.crankpin.index_axis(Axis(0), i);
                continue;
            }
            let (gas, thrust) = (loads.gas.row(i), loads.side_thrust.row(i));
            for ((mut sum, &gas), &thrust) in sum.outer_iter_mut().zip(gas).zip(thrust) {
                let force = rod.bore * Complex64::new(gas, -thrust);
                sum[0] += force.re;
                sum[1] += force.im;
            }
        }
        for load in turning {
            let mut sum = shear.index_axis_mut(Axis(0), at(load.z));
            for range in parts(0..count, BLOCK) {
                cancel.check()?;
                let angles = CrankAngles::of_checked(&theta_deg[range.clone()]);
                let units = Units::at_speed(&angles, 0..angles.len(), load.ratio);
                let [mut x, mut y] = [AngleColumn::ZERO; 2];
                units.add_turning(load.at_start, load.ratio, [&mut x[..], &mut y[..]]);
                for (at, (x, y)) in range.zip(x.iter().zip(&y[..])) {
                    sum[[at, 0]] += x;
                    sum[[at, 1]] += y;
                }
            }
        }
        for (k, ends) in z.windows(2).enumerate() {
            cancel.check()?;
            let (before, mut after) = shear.view_mut().split_at(Axis(0), k + 1);
            let before = before.index_axis(Axis(0), k);
            after.index_axis_mut(Axis(0), 0).scaled_add(1.0, &before);
            let (front, mut behind) = bending.view_mut().split_at(Axis(0), k + 1);
            let mut moment = behind.index_axis_mut(Axis(0), 0);
            moment.assign(&front.index_axis(Axis(0), k));
            // The loads in front are farther off by so much: r × F with r towards the front.
            let farther = ends[1] - ends[0];
            moment.column_mut(0).scaled_add(farther, &before.column(1));
            moment.column_mut(1).scaled_add(-farther, &before.column(0));
        }
        Ok(Sections { shear, bending })
    }

    /// Ranges of crank angles in which each rod is in tension at its wrist pin, [from, to] in degrees
    /// of a cycle of so many; [0, cycle] where it always is.
    pub fn tension(&self, cycle_deg: u32, cancel: &Cancel) -> Result<Vec<Vec<[f64; 2]>>> {
        /// Steps in a degree, between which a rod changes sign once at most.
        const STEPS: u32 = 4;
        let cycle = f64::from(cycle_deg);
        let of_rod = |rod: &DrivenRod| {
            cancel.check()?;
            let in_tension = |theta: f64| {
                let unit = cis_degrees(theta) * rod.phase;
                let gas = rod.gas.as_ref().map_or(0.0, |gas| gas.force(theta));
                rod.forces(&CrankPosition::new(unit.im, unit.re), gas).compression < 0.0
            };
            let starts = in_tension(0.0);
            let (mut last, mut changes) = ((0.0, starts), Vec::new());
            for k in 1..=cycle_deg * STEPS {
                let theta = f64::from(k) / f64::from(STEPS);
                let here = (theta, if theta < cycle { in_tension(theta) } else { starts });
                if here.1 != last.1 {
                    let (mut low, mut high) = (last.0, here.0);
                    // Halving a step so often reaches the last place of 720.
                    for _ in 0..42 {
                        let middle = f64::midpoint(low, high);
                        *(if in_tension(middle) == here.1 { &mut high } else { &mut low }) = middle;
                    }
                    changes.push(high);
                }
                last = here;
            }
            if starts {
                // The range that is cut by the start of the cycle is counted from where it begins.
                let first = if changes.is_empty() { cycle } else { changes.remove(0) };
                let from = changes.pop().map_or(0.0, |from| from - cycle);
                changes.splice(0..0, [from, first]);
            }
            Ok(changes.chunks_exact(2).map(|ends| [ends[0], ends[1]]).collect())
        };
        self.rods.iter().map(of_rod).collect()
    }

    /// Main bearings that carry a load at some place, and their shares of it.
    fn levers(&self, z: f64) -> [(usize, f64); 2] {
        let behind = self.mains.partition_point(|&main| main <= z).clamp(1, self.mains.len() - 1);
        let [front, rear] = [self.mains[behind - 1], self.mains[behind]];
        let share = (z - front) / (rear - front);
        [(behind - 1, 1.0 - share), (behind, share)]
    }
}

/// `e^{iθ}` of crank angles, in blocks, and where each is in the list.
fn blocks(theta_deg: &[f64], cancel: &Cancel) -> Result<Vec<(Range<usize>, Units)>> {
    let ranges = parts(0..theta_deg.len(), BLOCK);
    let mut blocks = memory::room(ranges.len())?;
    for range in ranges {
        cancel.check()?;
        let angles = CrankAngles::of_checked(&theta_deg[range.clone()]);
        let units = vectorised(
            #[inline(always)]
            || Units::new(&angles, 0..angles.len(), Order::FIRST),
        );
        blocks.push((range, units));
    }
    Ok(blocks)
}

/// Do some work for each row, in parallel where so many numbers are worth it.
fn each<T: Send>(
    rows: Vec<T>,
    numbers: usize,
    cancel: &Cancel,
    work: impl Fn(T) -> Result<()> + Send + Sync,
) -> Result<()> {
    if pool::worth(numbers) {
        return pool::map(cancel, rows, work).map(drop);
    }
    rows.into_iter().try_for_each(work)
}

/// The numbers of a row.
fn slice<D: Dimension>(row: ArrayViewMut<'_, f64, D>) -> &mut [f64] {
    row.into_slice().unwrap_or_default()
}

/// Rejects crank angles, or results of so many numbers an angle.
fn check_angles(theta_deg: &[f64], numbers: usize, cancel: &Cancel) -> Result<()> {
    let hint = "split theta_deg into parts";
    limits::result_size("theta_deg", &[theta_deg.len(), numbers], size_of::<f64>(), hint)?;
    check(theta_deg, cancel)
}

fn vectors(rows: usize, count: usize) -> Result<Array3<f64>> {
    let values = memory::zeros(2 * rows * count)?;
    Array3::from_shape_vec((rows, count, 2), values).map_err(|error| shape_error(&error))
}

fn scalars(rows: usize, count: usize) -> Result<Array2<f64>> {
    let values = memory::zeros(rows * count)?;
    Array2::from_shape_vec((rows, count), values).map_err(|error| shape_error(&error))
}

fn shape_error(error: &ndarray::ShapeError) -> Error {
    Error::value("theta_deg", "its length", error.to_string())
}
