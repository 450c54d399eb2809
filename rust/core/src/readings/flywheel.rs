//! Speed of a crank over a cycle, and the moment of inertia that keeps it even.
//!
//! The first integral of the equation of motion, ½J(θ)ω² = E₀ + ∫(T − `T_load`)dθ, with
//! J = J₀ + Σ m·s′² + Σ (I − m·a·b)·φ′² of pistons and rods. T is the torque of the gas alone: inertia
//! torque is what the change of J makes of the speed, and counted with T it would count twice.

pub mod areas;
pub mod rim;

use std::sync::LazyLock;

use crate::Complex64;
use crate::engine::Engine;
use crate::load::kinematics::Kinematics;
use crate::load::{Load, Scene};
use crate::numbers::angle::cis_degrees;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::{CrankAngles, parts};
use crate::numbers::error::{Error, Result};
use crate::numbers::figure::significant;
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::quadrature::gauss_legendre;
use crate::readings::balance::angular_speed;
use crate::source::over_angle::BLOCK;

/// Widest cell, degrees. Extremes between edges are those of a cubic, which misses a wave of order 12
/// by 3e-7 of its height.
const WIDEST_CELL: f64 = 0.5;
/// Points inside a cell: through four goes a cubic, as pressure is between the angles of a table.
const POINTS_IN_CELL: usize = 4;
/// Gauss-Legendre points of a cell, ascending in halves of its width from its middle, and weights.
static RULE: LazyLock<[(f64, f64); POINTS_IN_CELL]> = LazyLock::new(|| {
    let rule = gauss_legendre(POINTS_IN_CELL as u32);
    let mut ascending = std::array::from_fn(|k| rule[k]);
    ascending.sort_unstable_by(|(one, _), (other, _)| f64::total_cmp(one, other));
    ascending
});
/// Most cells of a period, and most knots: sorting them takes a tenth of a second.
const MOST_CELLS: usize = 1_000_000;
/// Cells evaluated between two checks for cancellation.
const PIECE: usize = 1 << 12;
/// Lowest square of a speed, over its mean, at which an engine runs.
pub(super) const SLOWEST: f64 = 1e-4;
/// Largest irregularity that can be asked for.
const MOST_IRREGULAR: f64 = 0.5;
/// Part of a number of rounds by which one of a period differs from a whole one at most.
const ROUNDS: f64 = 1e-9;
/// Part of the work of a drive below which its fluctuation is rounding.
const WORK_ROUNDING: f64 = 1e-13;
/// Steps of iterations that gain digits with each.
const MOST_STEPS_OF_ENERGY: usize = 200;

/// Crank angles of one period at which torque is evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleGrid {
    /// Edges of the cells, degrees, from 0 to the period: torque may jump there.
    pub edges_deg: Vec<f64>,
    /// Points inside each cell, degrees.
    pub nodes_deg: Vec<f64>,
}

impl CycleGrid {
    /// A grid of one period, with edges at `knots` besides those of its own.
    pub fn new(period_deg: f64, knots: &[f64], cancel: &Cancel) -> Result<Self> {
        if !(WIDEST_CELL..=WIDEST_CELL * MOST_CELLS as f64).contains(&period_deg) {
            let hint = "give the period of the torque in degrees, such as 720";
            return Err(Error::figure("period_deg", period_deg, hint));
        }
        if knots.len() > MOST_CELLS {
            let hint = format!("give at most {MOST_CELLS}");
            return Err(Error::value("theta_deg", format!("{} angles", knots.len()), hint));
        }
        let cells = (period_deg / WIDEST_CELL).ceil();
        let mut edges_deg = memory::with_capacity(knots.len() + cells as usize + 1)?;
        edges_deg.extend((0..cells as usize).map(|k| period_deg * (k as f64 / cells)));
        for piece in knots.chunks(PIECE) {
            cancel.check()?;
            for &knot in piece {
                edges_deg.push(limits::finite("theta_deg", knot)?.rem_euclid(period_deg));
            }
        }
        edges_deg.sort_unstable_by(f64::total_cmp);
        // Knots beside an edge by no more than rounding.
        edges_deg.dedup_by(|next, edge| *next - *edge <= 1e-9 * WIDEST_CELL);
        edges_deg.push(period_deg);
        let mut nodes_deg = memory::with_capacity(POINTS_IN_CELL * (edges_deg.len() - 1))?;
        for pair in edges_deg.windows(2) {
            let (middle, half) = (f64::midpoint(pair[0], pair[1]), 0.5 * (pair[1] - pair[0]));
            nodes_deg.extend(RULE.map(|(node, _)| middle + node * half));
        }
        Ok(Self { edges_deg, nodes_deg })
    }

    /// Width of a cell, radians.
    fn width(&self, cell: usize) -> f64 {
        (self.edges_deg[cell + 1] - self.edges_deg[cell]).to_radians()
    }

    /// Mean over the period of a function from its values at the points inside the cells.
    #[must_use]
    pub fn mean(&self, values: &[f64]) -> f64 {
        let of_cell = |(k, inside): (usize, &[f64])| self.width(k) * mean_of(inside);
        let sum: f64 = values.chunks_exact(POINTS_IN_CELL).enumerate().map(of_cell).sum();
        sum / self.edges_deg[self.edges_deg.len() - 1].to_radians()
    }
}

/// Moment of inertia of all that turns with the crank, given or wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlywheelTarget {
    /// This moment of inertia, kg·m².
    Inertia(f64),
    /// The least that keeps the irregularity, (largest − least)/mean speed, down to this.
    Irregularity(f64),
}

/// What drives a crank, and what it drives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrankDrive<'a> {
    /// Crank angles of one period.
    pub grid: &'a CycleGrid,
    /// Torque of the gas at the nodes of the grid, N·m.
    pub torque: &'a [f64],
    /// Torque of the load there, N·m, of which the variation about its mean counts.
    pub load: &'a [f64],
    /// Engines on the crank whose pistons and rods move, of drive and loads; none for a constant moment of
    /// inertia.
    pub engines: &'a [&'a Engine],
    /// Mean crank speed: turns over the time that they take.
    pub rpm: f64,
}

/// Speed over a cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedFluctuation {
    /// Moment of inertia of all that turns with the crank, kg·m².
    pub inertia: f64,
    /// Moment of inertia of pistons and rods at the edges of the grid, kg·m².
    pub moving_inertia: Vec<f64>,
    /// Torque of their inertia on the crank at the mean speed, N·m.
    pub inertia_torque: Vec<f64>,
    /// Speed at the edges, rad/s.
    pub speed: Vec<f64>,
    /// Lowest and highest speed, at any angle, rad/s.
    pub extremes: [f64; 2],
    /// Largest angular acceleration, either way, at any angle, rad/s².
    pub acceleration: f64,
    /// Largest less smallest speed, over the mean speed.
    pub irregularity: f64,
    /// Mean torque of the gas, N·m.
    pub mean_torque: f64,
    /// Largest less smallest work of gas and load, J.
    pub energy: f64,
    /// Irregularity by two approximations with the mean moment of inertia: of the gas torque alone, and
    /// of gas and inertia torque together.
    pub approximations: [f64; 2],
}

impl CrankDrive<'_> {
    /// Speed over the cycle.
    pub fn speed(&self, evenness: FlywheelTarget, cancel: &Cancel) -> Result<SpeedFluctuation> {
        let omega = angular_speed(self.rpm)?;
        if omega == 0.0 {
            return Err(Error::figure("rpm", self.rpm, "give a speed above 0"));
        }
        let motion = WorkCurve::new(self, omega, cancel)?;
        let (inertia, run) = match evenness {
            FlywheelTarget::Inertia(inertia) => {
                limits::inertia("inertia", inertia)?;
                if inertia < 0.0 {
                    return Err(Error::figure("inertia", inertia, "give zero or more"));
                }
                (inertia, motion.run(inertia, cancel)?)
            }
            FlywheelTarget::Irregularity(wanted) => motion.inertia_for(wanted, cancel)?,
        };
        let mean_inertia = inertia + motion.mean_moving();
        let over = mean_inertia * omega * omega;
        let work = range(motion.cells.iter().map(|cell| cell.work));
        let turning = range(motion.cells.iter().map(|cell| cell.work_with_inertia(omega)));
        let half = -0.5 * omega * omega;
        let mut moving_inertia = memory::with_capacity(motion.cells.len() + 1)?;
        let mut inertia_torque = memory::with_capacity(motion.cells.len() + 1)?;
        for cell in &motion.cells {
            moving_inertia.push(cell.moving.ends[0]);
            inertia_torque.push(half * cell.moving.slopes[0]);
        }
        moving_inertia.push(moving_inertia[0]);
        inertia_torque.push(inertia_torque[0]);
        Ok(SpeedFluctuation {
            inertia,
            moving_inertia,
            inertia_torque,
            speed: run.speed,
            extremes: run.extremes,
            acceleration: run.acceleration,
            irregularity: run.irregularity,
            mean_torque: motion.mean_torque,
            energy: work,
            approximations: [work, turning].map(|energy| energy / over),
        })
    }
}

/// Values and slopes of a function at the ends of a cell.
#[derive(Debug, Clone, Copy)]
struct Cubic {
    ends: [f64; 2],
    /// Per radian.
    slopes: [f64; 2],
    /// Width of the cell, radians.
    width: f64,
}

impl Cubic {
    /// The cubic with these values at the points inside a cell.
    fn through(values: [f64; POINTS_IN_CELL], width: f64) -> Self {
        let [_, _, (inner, _), (outer, _)] = *RULE;
        let square = outer * outer - inner * inner;
        // e₀ + e₂t² and t(o₁ + o₃t²) by the values at either pair of points.
        let even = [values[3] + values[0], values[2] + values[1]].map(|sum| 0.5 * sum);
        let odd = [(values[3] - values[0]) / outer, (values[2] - values[1]) / inner]
            .map(|quotient| 0.5 * quotient);
        let [second, third] =
            [even, odd].map(|[of_outer, of_inner]| (of_outer - of_inner) / square);
        let (middle, first) = (even[1] - second * inner * inner, odd[1] - third * inner * inner);
        Self {
            ends: [-1.0, 1.0].map(|t| middle + second + t * (first + third)),
            slopes: [-1.0, 1.0].map(|t| (first + 2.0 * second * t + 3.0 * third) * 2.0 / width),
            width,
        }
    }

    fn integral(&self) -> f64 {
        let Self { ends, slopes, width } = *self;
        width * (0.5 * (ends[0] + ends[1]) + width * (slopes[0] - slopes[1]) / 12.0)
    }

    /// Least and largest value of the cubic that has them.
    fn extremes(&self) -> [f64; 2] {
        let [from, to] = self.ends;
        let [rise, fall] = self.slopes.map(|slope| slope * self.width);
        // Slope over the width: a + 2bx + cx².
        let (a, b, c) =
            (rise, 3.0 * (to - from) - 2.0 * rise - fall, 3.0 * (rise + fall - 2.0 * (to - from)));
        let root = (b * b - a * c).sqrt();
        // The larger of the roots' numerators loses no digits; where there is none it is not a number.
        let q = -(b + root.copysign(b));
        let inside = [q / c, a / q].into_iter().filter(|x| (0.0..=1.0).contains(x));
        let values = inside.map(|x| self.at(x));
        values.fold([from.min(to), from.max(to)], |[low, high], x| [low.min(x), high.max(x)])
    }

    /// Value at a part of the width.
    fn at(&self, x: f64) -> f64 {
        let [from, to] = self.ends;
        let [rise, fall] = self.slopes.map(|slope| slope * self.width);
        let (b, c) = (3.0 * (to - from) - 2.0 * rise - fall, rise + fall - 2.0 * (to - from));
        from + x * (rise + x * (b + x * c))
    }
}

/// Largest less smallest value over all cells.
fn range(cells: impl Iterator<Item = Cubic>) -> f64 {
    let all = [f64::INFINITY, f64::NEG_INFINITY];
    let [low, high] = cells
        .map(|cell| cell.extremes())
        .fold(all, |[low, high], [least, most]| [low.min(least), high.max(most)]);
    high - low
}

/// Part of a cycle between two edges.
struct Cell {
    /// Work of gas and load from the start of the cycle; its slopes are torques.
    work: Cubic,
    /// Moment of inertia of pistons and rods.
    moving: Cubic,
    /// The same, and its slope per radian, at the points inside.
    moving_inside: [[f64; 2]; POINTS_IN_CELL],
    /// Torque of gas and load there.
    torque: [f64; POINTS_IN_CELL],
}

impl Cell {
    /// Work of gas, load and inertia torque at a constant speed.
    fn work_with_inertia(&self, omega: f64) -> Cubic {
        let with = |work: [f64; 2], moving: [f64; 2]| {
            [0, 1].map(|k| work[k] - 0.5 * omega * omega * moving[k])
        };
        Cubic {
            ends: with(self.work.ends, self.moving.ends),
            slopes: with(self.work.slopes, self.moving.slopes),
            width: self.work.width,
        }
    }

    /// Half the square of the speed, ω²/2, with a flywheel, beyond that at which the moment of inertia is
    /// the mean.
    fn beyond(&self, level: Level) -> Cubic {
        let Level { inertia, mean_moving, half } = level;
        let total = self.moving.ends.map(|moving| inertia + moving);
        let ends = [0, 1]
            .map(|k| (self.work.ends[k] - half * (self.moving.ends[k] - mean_moving)) / total[k]);
        let slopes = [0, 1]
            .map(|k| (self.work.slopes[k] - (half + ends[k]) * self.moving.slopes[k]) / total[k]);
        Cubic { ends, slopes, width: self.work.width }
    }

    /// Angular acceleration.
    fn acceleration(&self, level: Level) -> Cubic {
        let Level { inertia, mean_moving, half } = level;
        let inside = std::array::from_fn(|j| {
            let [moving, slope] = self.moving_inside[j];
            let total = inertia + moving;
            let work = self.work.at(0.5 + 0.5 * RULE[j].0);
            let beyond = (work - half * (moving - mean_moving)) / total;
            (self.torque[j] - (half + beyond) * slope) / total
        });
        Cubic::through(inside, self.work.width)
    }
}

/// What half the square of the speed varies about: what is left is known to parts of itself, however
/// heavy the flywheel.
#[derive(Debug, Clone, Copy)]
struct Level {
    inertia: f64,
    /// Mean moment of inertia of pistons and rods.
    mean_moving: f64,
    /// ω²/2 of the energy at the start with the mean moment of inertia.
    half: f64,
}

impl Level {
    /// Speed where half its square is this beyond.
    fn speed(&self, beyond: f64) -> f64 {
        (2.0 * (self.half + beyond)).sqrt()
    }
}

/// Work and moving masses over a cycle.
struct WorkCurve {
    cells: Vec<Cell>,
    mean_torque: f64,
    /// Work of torque and load without their signs.
    size: f64,
    /// Mean speed, rad/s.
    omega: f64,
}

/// Speeds for one moment of inertia.
struct Run {
    speed: Vec<f64>,
    extremes: [f64; 2],
    acceleration: f64,
    irregularity: f64,
}

impl WorkCurve {
    fn new(drive: &CrankDrive, omega: f64, cancel: &Cancel) -> Result<Self> {
        let edges = &drive.grid.edges_deg;
        for (argument, values) in [("torque", drive.torque), ("load", drive.load)] {
            limits::same_length(
                argument,
                values.len(),
                "nodes_deg",
                drive.grid.nodes_deg.len(),
                "crank angle",
            )?;
            for &value in values {
                limits::finite(argument, value)?;
            }
        }
        let [values, slopes] = moving(drive.engines, edges, cancel)?;
        let inside = moving(drive.engines, &drive.grid.nodes_deg, cancel)?;
        let period = edges[edges.len() - 1].to_radians();
        let width = |k: usize| drive.grid.width(k);
        let means = [drive.torque, drive.load].map(|values| drive.grid.mean(values));
        let (mut cells, mut work) = (memory::with_capacity(edges.len() - 1)?, 0.0);
        for k in 0..edges.len() - 1 {
            if k % PIECE == 0 {
                cancel.check()?;
            }
            let places: [usize; POINTS_IN_CELL] = std::array::from_fn(|j| POINTS_IN_CELL * k + j);
            let torque = places.map(|j| (drive.torque[j] - means[0]) - (drive.load[j] - means[1]));
            let slopes_of_work = Cubic::through(torque, width(k)).ends;
            let next = work + width(k) * mean_of(&torque);
            let cubic = |ends, slopes| Cubic { ends, slopes, width: width(k) };
            cells.push(Cell {
                work: cubic([work, next], slopes_of_work),
                moving: cubic([values[k], values[k + 1]], [slopes[k], slopes[k + 1]]),
                moving_inside: places.map(|j| [inside[0][j], inside[1][j]]),
                torque,
            });
            work = next;
        }
        let sizes = drive.torque.iter().chain(drive.load).map(|torque| torque.abs());
        let size = sizes.sum::<f64>() / drive.torque.len() as f64 * period;
        Ok(Self { cells, mean_torque: means[0], size, omega })
    }

    fn period(&self) -> f64 {
        self.cells.iter().map(|cell| cell.work.width).sum()
    }

    fn mean_moving(&self) -> f64 {
        self.cells.iter().map(|cell| cell.moving.integral()).sum::<f64>() / self.period()
    }

    /// The speeds with a flywheel, at the mean speed: by Newton's method on the energy at the start.
    fn run(&self, inertia: f64, cancel: &Cancel) -> Result<Run> {
        let lowest = self.cells.iter().map(|cell| cell.work.ends[0]).fold(0.0, f64::min);
        let square = 0.5 * self.omega * self.omega;
        let least = self.cells.iter().map(|cell| cell.moving.ends[0]).fold(f64::INFINITY, f64::min);
        if inertia + least <= 0.0 {
            return Err(Error::figure("inertia", inertia, "give the flywheel's, above 0 kg·m²"));
        }
        let wanted = self.period() / self.omega;
        let highest = self.cells.iter().map(|cell| cell.work.ends[0]).fold(0.0, f64::max);
        let mean_moving = self.mean_moving();
        let mut energy = (inertia + mean_moving) * square - lowest;
        for _ in 0..MOST_STEPS_OF_ENERGY {
            cancel.check()?;
            let level = Level { inertia, mean_moving, half: energy / (inertia + mean_moving) };
            // The time of a period, and its slope by the energy.
            let (mut time, mut slope) = (0.0, 0.0);
            for cell in &self.cells {
                let beyond = cell.beyond(level);
                let slowness = beyond.ends.map(|each| level.speed(each).recip());
                let steep = [0, 1].map(|k| -beyond.slopes[k] * slowness[k].powi(3));
                time += Cubic { ends: slowness, slopes: steep, width: beyond.width }.integral();
                slope -= beyond.width * slowness[0].powi(3) / (inertia + cell.moving.ends[0]);
            }
            let next = energy + (wanted - time) / slope;
            // The time is convex in the energy and grows without limit as the crank stops.
            let next = if next > -lowest { next } else { f64::midpoint(energy, -lowest) };
            // What is left is the square of this, or this times the error of the slope. The energy at the
            // start may be next to nothing beside the cycle's largest, of which it is known to parts.
            let done = (next - energy).abs() <= 1e-11 * (next + highest);
            energy = next;
            if done {
                let half = energy / (inertia + mean_moving);
                return self.checked(Level { inertia, mean_moving, half });
            }
        }
        Err(stops(inertia))
    }

    fn checked(&self, level: Level) -> Result<Run> {
        let square = 0.5 * self.omega * self.omega;
        let mut speed = memory::with_capacity(self.cells.len() + 1)?;
        let (mut low, mut high, mut acceleration) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        for cell in &self.cells {
            let beyond = cell.beyond(level);
            let [least, most] = beyond.extremes();
            (low, high) = (low.min(least), high.max(most));
            let either = cell.acceleration(level).extremes();
            acceleration = either.iter().fold(acceleration, |most, each| most.max(each.abs()));
            speed.push(level.speed(beyond.ends[0]));
        }
        if level.half + low < SLOWEST * square {
            return Err(stops(level.inertia));
        }
        speed.push(speed[0]);
        let extremes = [low, high].map(|beyond| level.speed(beyond));
        // The difference of speeds by that of their squares, of which no digits are lost.
        let irregularity = 2.0 * (high - low) / ((extremes[0] + extremes[1]) * self.omega);
        Ok(Run { speed, extremes, acceleration, irregularity })
    }

    /// The least flywheel that keeps an irregularity: it is nearly as one over the inertia.
    fn inertia_for(&self, wanted: f64, cancel: &Cancel) -> Result<(f64, Run)> {
        if !(limits::SMALLEST..=MOST_IRREGULAR).contains(&wanted) {
            let hint =
                format!("give (largest − least)/mean speed, such as 0.01, to {MOST_IRREGULAR}");
            return Err(Error::figure("irregularity", wanted, hint));
        }
        let moving = self.mean_moving();
        let energy = range(self.cells.iter().map(|cell| cell.work_with_inertia(self.omega)));
        let of_moving = 0.5 * self.omega * self.omega * moving;
        if energy <= WORK_ROUNDING * (self.size + of_moving) {
            let hint = "the torque does not vary, and no flywheel is needed; give inertia";
            return Err(Error::figure("irregularity", wanted, hint));
        }
        // Where gas and inertia torque cancel, rounding of the larger is what their sum jitters by.
        let larger = of_moving.max(range(self.cells.iter().map(|cell| cell.work)));
        let tolerance = 1e-12_f64.max(4.0 * f64::EPSILON * larger / energy);
        let mut total = energy / (self.omega * self.omega * wanted);
        for _ in 0..MOST_STEPS_OF_ENERGY {
            let inertia = (total - moving).max(0.0);
            let Ok(run) = self.run(inertia, cancel) else {
                cancel.check()?;
                total = 2.0 * total.max(moving);
                continue;
            };
            let ratio = run.irregularity / wanted;
            if (ratio - 1.0).abs() <= tolerance || ratio < 1.0 && inertia == 0.0 {
                return Ok((inertia, run));
            }
            total = total.max(moving) * ratio;
        }
        let hint = "no flywheel was found that keeps it; give inertia";
        Err(Error::figure("irregularity", wanted, hint))
    }
}

fn stops(inertia: f64) -> Error {
    Error::figure("inertia", inertia, "the crank nearly stops within a cycle; give more")
}

/// Mean of a function over a cell from its values at the points inside.
fn mean_of(values: &[f64]) -> f64 {
    0.5 * RULE.iter().zip(values).map(|((_, weight), value)| weight * value).sum::<f64>()
}

/// Mean moment of inertia over a turn of each cylinder's piston and rod as seen from the main crank, kg·m².
pub fn mean_inertias(engine: &Engine, cancel: &Cancel) -> Result<Vec<f64>> {
    let grid = CycleGrid::new(360.0, &[], cancel)?;
    let loads = Scene::of(engine, None)?;
    let of_cylinder = |i: usize| {
        let own = |load: &&Load| load.place.origin.cylinder() == Some(i);
        let list = loads.list.iter().filter(own).copied().collect();
        let own = Scene { list, ..(*loads).clone() };
        let mut sums = [memory::zeros(grid.nodes_deg.len())?, memory::zeros(grid.nodes_deg.len())?];
        add_moving(&own, &grid.nodes_deg, &mut sums, cancel)?;
        Ok(grid.mean(&sums[0]))
    };
    (0..engine.stations().len()).map(of_cylinder).collect()
}

/// Largest less smallest speed of each order alone, over the mean speed, from the speed over one period by
/// trapezes; orders come round in it.
pub fn irregularity_by_order(
    theta_deg: &[f64],
    speed: &[f64],
    mean_speed: f64,
    orders: &[Order],
    cancel: &Cancel,
) -> Result<Vec<f64>> {
    let period = theta_deg[theta_deg.len() - 1] - theta_deg[0];
    let of = |order: &Order| {
        cancel.check()?;
        let rounds = order.number() * period / 360.0;
        if (rounds - rounds.round()).abs() > ROUNDS * rounds {
            let hint = format!("give ones that come round in {}°", significant(period, 6));
            return Err(Error::figure("orders", order.number(), hint));
        }
        let wave = |k: usize| cis_degrees(-order.number() * theta_deg[k]) * speed[k];
        let cells = 1..theta_deg.len();
        let trapeze = |k: usize| (wave(k - 1) + wave(k)) * (theta_deg[k] - theta_deg[k - 1]);
        let phasor: Complex64 = cells.map(trapeze).sum::<Complex64>() / period;
        Ok(2.0 * phasor.norm() / mean_speed)
    };
    orders.iter().map(of).collect()
}

/// Largest less smallest angle by which a crank leads one that turns evenly, degrees, from its speed over one
/// period by trapezes of the time that an angle takes.
#[must_use]
pub fn swing_deg(theta_deg: &[f64], speed: &[f64]) -> f64 {
    let mut time = 0.0;
    let mut times = vec![0.0];
    for (angles, speeds) in theta_deg.windows(2).zip(speed.windows(2)) {
        time += (angles[1] - angles[0]) * 0.5 * (1.0 / speeds[0] + 1.0 / speeds[1]);
        times.push(time);
    }
    let even = (theta_deg[theta_deg.len() - 1] - theta_deg[0]) / time;
    let leads = theta_deg.iter().zip(times).map(|(theta, at)| theta - theta_deg[0] - at * even);
    let range = |[low, high]: [f64; 2], lead: f64| [low.min(lead), high.max(lead)];
    let [low, high] = leads.fold([f64::INFINITY, f64::NEG_INFINITY], range);
    high - low
}

/// Moment of inertia of engines' pistons and rods as seen from the crank, and its slope per radian.
fn moving(engines: &[&Engine], edges_deg: &[f64], cancel: &Cancel) -> Result<[Vec<f64>; 2]> {
    let mut sums = [memory::zeros(edges_deg.len())?, memory::zeros(edges_deg.len())?];
    for engine in engines {
        let loads = Scene::of(engine, None)?;
        add_moving(&loads, edges_deg, &mut sums, cancel)?;
    }
    Ok(sums)
}

/// Adds those of a scene's loads.
fn add_moving(
    loads: &Scene,
    edges_deg: &[f64],
    [values, slopes]: &mut [Vec<f64>; 2],
    cancel: &Cancel,
) -> Result<()> {
    let kinematics = Kinematics::new(loads);
    for part in parts(0..edges_deg.len(), BLOCK) {
        cancel.check()?;
        let angles = CrankAngles::new(&edges_deg[part.clone()])?;
        kinematics.add_inertia(&angles, [&mut values[part.clone()], &mut slopes[part]]);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::engine::Station;
    use crate::mechanism::cylinder::Cylinder;
    use crate::numbers::angle::Angle;

    fn grid(knots: &[f64]) -> CycleGrid {
        CycleGrid::new(360.0, knots, &Cancel::new()).unwrap()
    }

    fn at(grid: &CycleGrid, torque: impl Fn(f64) -> f64) -> Vec<f64> {
        grid.nodes_deg.iter().map(|degrees| torque(degrees.to_radians())).collect()
    }

    fn run(
        grid: &CycleGrid,
        torque: &[f64],
        engines: &[&Engine],
        how: FlywheelTarget,
    ) -> SpeedFluctuation {
        let load = vec![0.0; torque.len()];
        let drive = CrankDrive { grid, torque, load: &load, engines, rpm: 300.0 };
        drive.speed(how, &Cancel::new()).unwrap()
    }

    fn single(rod_inertia: f64) -> Engine {
        let cylinder = Cylinder::new(0.05, 0.15, 2.0, 0.01).unwrap();
        let cylinder = cylinder.with_rod_inertia_excess(rod_inertia).unwrap();
        let bank = Angle::from_degrees(90.0).unwrap();
        let place = Station { cylinder, tdc: Angle::ZERO, bank, z: 0.0, rotating_mass: 0.0 };
        Engine::new("", "", vec![place]).unwrap()
    }

    #[test]
    fn a_sine_of_torque_swings_by_its_work() {
        // ∫A sin 2θ dθ swings by A. ω² = ω₀² − (A/J) cos 2θ, of which √(1 ± A/(Jω₀²)) are the ends.
        let grid = grid(&[]);
        let torque = at(&grid, |theta| 100.0 + 40.0 * (2.0 * theta).sin());
        let found = run(&grid, &torque, &[], FlywheelTarget::Inertia(2.0));
        // Cubics over half a degree: (2·0.0087)⁴/384 of what waves, 2.4e-10.
        assert!((found.energy - 40.0).abs() < 40.0 * 3e-10, "{}", found.energy);
        assert!((found.mean_torque - 100.0).abs() < 1e-10);
        let omega = 10.0 * PI;
        let [low, high] = [0, 180].map(|k| found.speed[k]);
        assert!((high * high - low * low - 40.0).abs() < 1e-7);
        assert!((found.irregularity * omega - (high - low)).abs() < 1e-9);
        // ω is the mean over time: Σ of the times of the cells is a turn's.
        let time: f64 = found.speed[1..].iter().map(|speed| (PI / 360.0) / speed).sum();
        assert!((time - 0.2).abs() < 1e-12);
        assert_eq!(found.approximations[0], found.approximations[1]);
        assert!((found.acceleration - 20.0).abs() < 20.0 * 1e-10, "{}", found.acceleration);
    }

    #[test]
    fn jumps_at_knots_are_exact() {
        // 10 N·m above the mean over a third of a turn, 5 below it elsewhere.
        let grid = grid(&[100.1, 220.1]);
        let torque =
            at(
                &grid,
                |theta| if (100.1..220.1).contains(&theta.to_degrees()) { 30.0 } else { 15.0 },
            );
        let found = run(&grid, &torque, &[], FlywheelTarget::Inertia(1.0));
        assert!((found.energy - 10.0 * 2.0 * PI / 3.0).abs() < 1e-11, "{}", found.energy);
        assert!((found.acceleration - 10.0).abs() < 1e-11);
    }

    #[test]
    fn without_torque_the_kinetic_energy_is_constant() {
        for rod_inertia in [0.0, 3e-3] {
            let (grid, engine) = (grid(&[]), single(rod_inertia));
            let found = run(
                &grid,
                &vec![0.0; grid.nodes_deg.len()],
                &[&engine],
                FlywheelTarget::Inertia(0.05),
            );
            let energies: Vec<f64> = found
                .speed
                .iter()
                .zip(&found.moving_inertia)
                .map(|(speed, moving)| (0.05 + moving) * speed * speed)
                .collect();
            assert!(energies.iter().all(|energy| (energy / energies[0] - 1.0).abs() < 1e-14));
            // Inertia torque is the slope of the energy at a constant speed, by central differences.
            let step = PI / 360.0;
            for k in 1..720 {
                let [before, after] = [k - 1, k + 1].map(|k| found.moving_inertia[k]);
                let slope = (after - before) / (2.0 * step);
                let torque = -0.5 * (10.0 * PI).powi(2) * slope;
                // h²/6 of a third derivative: 1.3e-5 times a few
                assert!((found.inertia_torque[k] - torque).abs() < 1e-4 * 2.0 * 0.0025 * 987.0);
            }
            let rod = found.moving_inertia[0];
            assert!((rod > 1e-4) == (rod_inertia > 0.0), "{rod}");
        }
    }

    #[test]
    fn an_irregularity_gives_its_inertia_back() {
        let (grid, engine) = (grid(&[]), single(0.0));
        let torque = at(&grid, |theta| 20.0 + 30.0 * theta.sin() - 8.0 * (3.0 * theta).cos());
        for wanted in [0.3, 0.05, 1e-4, 6e-5, 1e-5, 3.7e-6, 1e-7, 1e-9] {
            let fit = run(&grid, &torque, &[&engine], FlywheelTarget::Irregularity(wanted));
            let again = run(&grid, &torque, &[&engine], FlywheelTarget::Inertia(fit.inertia));
            assert!(
                (again.irregularity / wanted - 1.0).abs() < 1e-11_f64.max(WORK_ROUNDING / wanted)
            );
            assert_eq!(again.speed, fit.speed);
        }
    }

    #[test]
    fn a_crank_that_would_stop_is_an_error() {
        let grid = grid(&[]);
        let torque = at(&grid, |theta| 1e4 * theta.sin());
        let load = vec![0.0; torque.len()];
        let drive =
            CrankDrive { grid: &grid, torque: &torque, load: &load, engines: &[], rpm: 300.0 };
        for how in [
            FlywheelTarget::Inertia(0.1),
            FlywheelTarget::Inertia(0.0),
            FlywheelTarget::Irregularity(0.9),
        ] {
            assert!(drive.speed(how, &Cancel::new()).is_err());
        }
        let cancel = Cancel::new();
        cancel.raise();
        assert_eq!(drive.speed(FlywheelTarget::Inertia(1e3), &cancel), Err(Error::Cancelled));
    }
}
