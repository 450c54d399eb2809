//! Loads inside an engine: what rods, wrist pins, cylinder walls and main bearings carry, and the
//! shear and bending of crank and crankcase along z.
//!
//! A crank is statically determinate between neighbouring main bearings of its own: each load of it is
//! shared by the bearing in front of it and the one behind by the lever rule, and one outside the end
//! bearings is carried by the two nearest, one of which is pulled. Gears between cranks load nothing.

mod extremes;
mod rod;
mod rod_loads;
mod sections;

use std::ops::Range;

use ndarray::{Array2, Array3, ArrayViewMut, Axis, Dimension};

pub use self::extremes::Extremes;
pub use self::rod::TurningAxes;
use self::rod::{DrivenRod, RodColumns};
pub use self::rod_loads::{Peak, RodLoads};
pub use self::sections::{CutPart, Sections};
use crate::Complex64;
use crate::engine::{CrankIndex, Engine};
use crate::load::find_or_push;
use crate::load::given::{ShaftForce, shaft_forces};
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::{CrankAngles, check, parts};
use crate::numbers::error::{Error, Result};
use crate::numbers::index::{List, ListIndex};
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::numbers::{limits, memory, pool};
use crate::readings::balance::angular_speed;
use crate::source::over_angle::{AngleColumn, BLOCK, Units};
use crate::wrench::rounding;

/// Largest share of a load outside the end bearings that one carries: rounding is that times larger.
const MOST_SHARE: f64 = 1e6;

/// An engine at a speed, for the loads inside it.
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
/// use crankpin_core::Cancel;
/// use crankpin_core::bearing_loads::BearingLoadsModel;
///
/// let engine = BearingLoadsModel::new(&four, 6000.0)?;
/// let loads = engine.loads(&[0.0, 90.0, 180.0], &Cancel::new())?;
/// assert_eq!(loads.main.dim(), (5, 3, 2)); // a bearing beside each throw
/// assert!(loads.main[[2, 0, 1]].abs() > loads.main[[0, 0, 1]].abs()); // the middle one has two throws
/// # Ok::<(), crankpin_core::Error>(())
/// ```
pub struct BearingLoadsModel {
    rods: Vec<DrivenRod>,
    /// On each crank besides the forces of rods on its pins.
    on_cranks: List<CrankIndex, Vec<Periodic>>,
    /// On the crankcase besides: by balance shafts, and further loads.
    on_crankcase: Vec<Periodic>,
    /// Rods on each crankpin, by index.
    pins: Vec<Vec<usize>>,
    /// Main bearings by crank, those of one by place.
    mains: Vec<MainBearing>,
    /// Speed of each crank over that of the main one, negative where it turns the other way.
    ratios: List<CrankIndex, SpeedRatio>,
}

/// A bearing of a crank in the crankcase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MainBearing {
    /// Its crank.
    pub crank: CrankIndex,
    /// Place along it, m.
    pub z: f64,
}

/// Loads of bearings and walls at given crank angles, N; vectors along x and y, fixed in the engine.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingLoads {
    /// Force of each rod on its crankpin, of a master rod with those of its links, of a link rod on its knuckle:
    /// (`n_cylinders`, `n_theta`, 2).
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

/// A force at a place: coefficients of `e^{ikθ/2}` of x + iy, N, by k.
struct Periodic {
    z: f64,
    waves: Vec<(i32, Complex64)>,
}

impl Periodic {
    /// Adds real and imaginary part at a block of angles.
    fn add(
        waves: &[(i32, Complex64)],
        angles: &CrankAngles,
        [x, y]: [&mut AngleColumn; 2],
    ) -> Result<()> {
        for &(halves, at_start) in waves {
            let order = Order::from_halves(halves.unsigned_abs())?;
            let units = Units::new(angles, 0..angles.len(), order);
            units.add_turning(at_start, halves, [&mut *x, &mut *y]);
        }
        Ok(())
    }
}

/// What a main bearing or a crankpin carries.
struct Carried {
    /// Shares of the loads of crankpins, and numbers of their rods.
    rods: Vec<(f64, usize)>,
    /// The other forces: coefficients of `e^{ikθ/2}`, by k.
    waves: Vec<(i32, Complex64)>,
    /// Speed of its crank.
    ratio: SpeedRatio,
    /// Forces up to this are rounding.
    bound: f64,
}

impl Carried {
    /// Adds the other forces at a block of crank angles; what is rounding becomes zero.
    fn add_waves(&self, units: &Units, theta_deg: &[f64], row: &mut [f64]) -> Result<()> {
        let [mut x, mut y] = [[0.0; BLOCK]; 2];
        let (own, others) = self.waves.split_at(usize::from(!self.waves.is_empty()));
        for &(halves, at_start) in own {
            // What turns with the crank.
            units.add_turning(at_start, halves, [&mut x, &mut y]);
        }
        if !others.is_empty() {
            Periodic::add(others, &CrankAngles::of_checked(theta_deg), [&mut x, &mut y])?;
        }
        for (pair, (x, y)) in row.chunks_exact_mut(2).zip(x.iter().zip(&y)) {
            pair[0] += x;
            pair[1] += y;
            for part in pair {
                *part = if part.abs() <= self.bound { 0.0 } else { *part };
            }
        }
        Ok(())
    }
}

/// Loads of one rod over crank angle.
struct RodRows<'a> {
    /// On crankpin and wrist pin.
    vectors: [&'a mut [f64]; 2],
    /// Side thrust, compression of the rod, gas force.
    scalars: [&'a mut [f64]; 3],
}

impl RodRows<'_> {
    fn write(&mut self, range: &Range<usize>, columns: &RodColumns) {
        let pairs = [&columns.crankpin, &columns.wrist_pin];
        for (row, [x, y]) in self.vectors.iter_mut().zip(pairs) {
            let row = row[2 * range.start..2 * range.end].chunks_exact_mut(2);
            for (pair, (x, y)) in row.zip(x.iter().zip(&y[..])) {
                pair.copy_from_slice(&[*x, *y]);
            }
        }
        let values = [&columns.across, &columns.compression, &columns.gas];
        for (row, column) in self.scalars.iter_mut().zip(values) {
            row[range.clone()].copy_from_slice(&column[..range.len()]);
        }
    }
}

impl BearingLoadsModel {
    /// Of an engine, on its main bearings.
    pub fn new(engine: &Engine, rpm: f64) -> Result<Self> {
        if engine.spectrum().is_some() {
            let hint = "bearing loads need the slider-crank; leave out the spectrum";
            return Err(Error::value("spectrum", "given", hint));
        }
        let omega = angular_speed(rpm)?;
        let square = omega * omega;
        let of_crank =
            |crank| engine.bearings(crank).into_iter().map(move |z| MainBearing { crank, z });
        let mut found = Self {
            rods: Vec::new(),
            on_cranks: engine.cranks().map_to(|_| Vec::new()),
            on_crankcase: Vec::new(),
            pins: engine.crankpins().into_iter().map(|pin| pin.cylinders).collect(),
            mains: engine.cranks().indices().flat_map(of_crank).collect(),
            ratios: engine.cranks().map_to(|crank| crank.ratio),
        };
        engine.check_speeds(&[rpm])?;
        for ShaftForce { z, crank, waves } in shaft_forces(engine, omega, &Cancel::new())? {
            let on = crank.map_or(&mut found.on_crankcase, |crank| &mut found.on_cranks[crank]);
            on.push(Periodic { z, waves });
        }
        for i in 0..engine.stations().len() {
            let rod = DrivenRod::new(engine, i, square)?;
            // What the crankpin gets from the rod is part of the rotating mass.
            let at_start = rod.at_start(-rod.rotating);
            let waves = vec![(rod.ratio.halves(), at_start)];
            found.on_cranks[rod.crank].push(Periodic { z: rod.z, waves });
            found.rods.push(rod);
        }
        found.check_levers()?;
        Ok(found)
    }

    /// Rejects loads too far from the bearings of their crank, or on a crank without any.
    fn check_levers(&self) -> Result<()> {
        for (crank, turning) in self.on_cranks.indices().zip(&self.on_cranks) {
            let rods = self.rods.iter().filter(|rod| rod.crank == crank).map(|rod| rod.z);
            for z in rods.chain(turning.iter().map(|load| load.z)) {
                let levers = self.levers(crank, z);
                if levers.is_empty() {
                    let number = crank.position() + 1;
                    let reason = format!("crank {number} has no throws, hence no bearings");
                    return Err(Error::Undefined { argument: "bearing_loads", reason });
                }
                if levers.iter().any(|(_, share)| share.abs() > MOST_SHARE) {
                    let hint =
                        format!("the load at z = {z:e} is too far from them for the lever rule");
                    let mains: Vec<f64> =
                        self.mains_of(crank).1.iter().map(|main| main.z).collect();
                    return Err(Error::value("mains", format!("{mains:?}"), hint));
                }
            }
        }
        Ok(())
    }

    /// The main bearings, by crank and place.
    #[must_use]
    pub fn mains(&self) -> &[MainBearing] {
        &self.mains
    }

    /// Number of the first main bearing of a crank, and all of them.
    fn mains_of(&self, crank: CrankIndex) -> (usize, &[MainBearing]) {
        let first = self.mains.partition_point(|main| main.crank < crank);
        let behind = self.mains.partition_point(|main| main.crank <= crank);
        (first, &self.mains[first..behind])
    }

    /// Places of loads and main bearings along z, ascending, m.
    #[must_use]
    pub fn places(&self) -> Vec<f64> {
        let turning = self.on_cranks.iter().flatten().chain(&self.on_crankcase).map(|load| load.z);
        let loads = self.rods.iter().map(|rod| rod.z).chain(turning);
        let mut places: Vec<f64> = loads.chain(self.mains.iter().map(|main| main.z)).collect();
        places.sort_unstable_by(f64::total_cmp);
        places.dedup();
        places
    }

    /// Share of each cylinder's crankpin load that each main bearing carries, none of a link rod's, which is in its
    /// master's: (`n_mains`, `n_cylinders`).
    #[must_use]
    pub fn shares(&self) -> Array2<f64> {
        let mut shares = Array2::zeros((self.mains.len(), self.rods.len()));
        let rods = self.rods.iter().enumerate().filter(|(_, rod)| rod.is_on_crankpin());
        for (i, rod) in rods {
            for (main, share) in self.levers(rod.crank, rod.z) {
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
        let blocks = self.blocks(theta_deg, cancel)?;
        let [mut crankpin, mut wrist_pin] = [&mut found.crankpin, &mut found.wrist_pin]
            .map(|rows| rows.outer_iter_mut().map(slice));
        let [mut across, mut rod, mut gas] =
            [&mut found.side_thrust, &mut found.rod, &mut found.gas]
                .map(|rows| rows.outer_iter_mut().map(slice));
        let rows = self.rods.iter().filter_map(|own| {
            let vectors = [crankpin.next()?, wrist_pin.next()?];
            Some((own, RodRows { vectors, scalars: [across.next()?, rod.next()?, gas.next()?] }))
        });
        pool::each(cancel, rows.collect(), 2 * rods * count, |(rod, mut rows)| {
            let mut columns = RodColumns::ZERO;
            for (range, units) in blocks_at(&blocks, rod.ratio) {
                cancel.check()?;
                columns.set_gas(rod, &theta_deg[range.clone()]);
                columns.fill(rod, units, &theta_deg[range.clone()]);
                rows.write(range, &columns);
            }
            Ok(())
        })?;
        let rows = found.main.outer_iter_mut().map(slice).enumerate().collect();
        pool::each(cancel, rows, mains * count, |(main, row)| {
            let carried = self.carried(main);
            let row_of = |i: usize| found.crankpin.index_axis(Axis(0), i).to_slice();
            let rods = carried.rods.iter().filter_map(|&(share, i)| Some((share, row_of(i)?)));
            let rods: Vec<_> = rods.collect();
            for (range, units) in blocks_at(&blocks, carried.ratio) {
                cancel.check()?;
                let row = &mut row[2 * range.start..2 * range.end];
                for (share, force) in &rods {
                    for (sum, force) in row.iter_mut().zip(&force[2 * range.start..]) {
                        *sum += share * force;
                    }
                }
                carried.add_waves(units, &theta_deg[range.clone()], row)?;
            }
            Ok(())
        })?;
        Ok(found)
    }

    /// Loads of bearings in axes that turn: (n, `n_theta`, 2). Of main bearings those of the journals,
    /// on each crank as its first cylinder's crankpin.
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
        let (blocks, numbers) = (self.blocks(theta_deg, cancel)?, vectors.len());
        let rows = vectors.outer_iter_mut().map(slice).enumerate().collect();
        pool::each(cancel, rows, numbers, |(row, values)| {
            let of_main = || self.rods.iter().find(|rod| rod.crank == self.mains[row].crank);
            let rod = if bearing == Bearing::Main { of_main() } else { self.rods.get(row) };
            let Some(rod) = rod else { return Ok(()) };
            for (range, units) in blocks_at(&blocks, rod.ratio) {
                cancel.check()?;
                let pairs = values[2 * range.start..2 * range.end].chunks_exact_mut(2);
                for (k, pair) in pairs.enumerate() {
                    let vector = Complex64::new(pair[0], pair[1]);
                    let seen = rod.seen(vector, &units.crank(rod.phase, k), axes);
                    pair.copy_from_slice(&seen);
                }
            }
            Ok(())
        })?;
        Ok(vectors)
    }

    /// What a main bearing carries.
    fn carried(&self, main: usize) -> Carried {
        let crank = self.mains[main].crank;
        let share = |z: f64| {
            let levers = self.levers(crank, z);
            levers.into_iter().find(|(j, _)| *j == main).map(|(_, share)| share)
        };
        // What link rods exert is in the load of their master.
        let rods = self.rods.iter().enumerate();
        let rods = rods.filter(|(_, rod)| rod.crank == crank && rod.is_on_crankpin());
        let rods: Vec<_> = rods.filter_map(|(i, rod)| Some((share(rod.z)?, i))).collect();
        let shared = self.on_cranks[crank].iter().filter_map(|load| {
            let share = share(load.z)?;
            Some(load.waves.iter().map(move |(halves, wave)| (*halves, wave * share)))
        });
        let waves: Vec<(i32, Complex64)> = shared.flatten().collect();
        self.cancelling(rods, &waves, crank)
    }

    /// What a crankpin carries: all of its rods.
    fn on_pin(&self, pin: &[usize]) -> Carried {
        let rods = pin.iter().filter(|&&i| self.rods[i].is_on_crankpin()).map(|&i| (1.0, i));
        self.cancelling(rods.collect(), &[], self.rods[pin[0]].crank)
    }

    /// Shares of rods and what turns with their crank, of which what cancels leaves its rounding.
    fn cancelling(
        &self,
        rods: Vec<(f64, usize)>,
        all: &[(i32, Complex64)],
        crank: CrankIndex,
    ) -> Carried {
        let sizes = rods.iter().map(|&(share, i)| share.abs() * self.rods[i].size());
        let sizes = sizes.chain(all.iter().map(|(_, wave)| wave.norm()));
        let bound = rounding(self.rods.len() + all.len(), 1.0) * sizes.sum::<f64>();
        let ratio = self.ratios[crank];
        // First what turns with the crank, of which there always is some.
        let mut waves = vec![(ratio.halves(), Complex64::ZERO)];
        for &(halves, wave) in all {
            let sum =
                find_or_push(&mut waves, |(own, _)| *own == halves, || (halves, Complex64::ZERO));
            sum.1 += wave;
        }
        Carried { rods, waves, ratio, bound }
    }

    /// Main bearings of a crank that carry a load at some place, and their shares of it.
    fn levers(&self, crank: CrankIndex, z: f64) -> Vec<(usize, f64)> {
        let (first, mains) = self.mains_of(crank);
        if mains.is_empty() {
            return Vec::new();
        }
        let behind = mains.partition_point(|main| main.z <= z).clamp(1, mains.len() - 1);
        let [front, rear] = [mains[behind - 1].z, mains[behind].z];
        let share = (z - front) / (rear - front);
        vec![(first + behind - 1, 1.0 - share), (first + behind, share)]
    }

    /// `e^{iθ}` of the crank angles at each speed of a crank, in blocks, and where each is in the list.
    fn blocks(&self, theta_deg: &[f64], cancel: &Cancel) -> Result<Vec<Blocks>> {
        let mut of_speeds = Vec::<Blocks>::new();
        for &ratio in &self.ratios {
            let speed = ratio.halves_of_speed();
            if of_speeds.iter().any(|(known, _)| *known == speed) {
                continue;
            }
            let ranges = parts(0..theta_deg.len(), BLOCK);
            let mut blocks = memory::with_capacity(ranges.len())?;
            for range in ranges {
                cancel.check()?;
                let angles = CrankAngles::of_checked(&theta_deg[range.clone()]);
                blocks.push((range, Units::at_speed(&angles, 0..angles.len(), ratio)));
            }
            of_speeds.push((speed, blocks));
        }
        Ok(of_speeds)
    }
}

/// A speed in halves of that of the main crank, and blocks of crank angles.
type Blocks = (u32, Vec<(Range<usize>, Units)>);

/// The blocks of a crank's speed.
fn blocks_at(blocks: &[Blocks], ratio: SpeedRatio) -> impl Iterator<Item = &(Range<usize>, Units)> {
    let of_speed = blocks.iter().filter(move |(speed, _)| *speed == ratio.halves_of_speed());
    of_speed.flat_map(|(_, blocks)| blocks)
}

/// The numbers of a row.
fn slice<D: Dimension>(row: ArrayViewMut<'_, f64, D>) -> &mut [f64] {
    row.into_slice().unwrap_or_default()
}

/// Rejects crank angles, or results of too many numbers for each angle.
fn check_angles(theta_deg: &[f64], numbers: usize, cancel: &Cancel) -> Result<()> {
    let hint = "split theta_deg into parts";
    limits::result_size("theta_deg", &[theta_deg.len(), numbers], size_of::<f64>(), hint)?;
    check(theta_deg, cancel)
}

fn vectors(rows: usize, count: usize) -> Result<Array3<f64>> {
    memory::array("theta_deg", (rows, count, 2), memory::zeros(2 * rows * count)?)
}

fn scalars(rows: usize, count: usize) -> Result<Array2<f64>> {
    memory::array("theta_deg", (rows, count), memory::zeros(rows * count)?)
}
