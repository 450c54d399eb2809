//! An engine on its mounts: motion, forces on the support, and power, order by order.
//!
//! (K(nω) − (nω)²·M)·q = f, with f the engine's own wrench of order n about the CG: of inertia times ω², of
//! gas as it is.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;

use crate::Complex64;
use crate::engine::Engine;
use crate::load::{Group, GroupIndex, Scene};
use crate::mounts::equations::{Equations, LANES, lanes, rows};
use crate::mounts::{
    ComplexVector6, ForceTable, Levels, Powertrain, State, Support, grade, moved, natural_at,
};
use crate::numbers::amplitudes::Amplitudes;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::List;
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::pool;
use crate::readings::balance::{ErrorBounds, Orders, angular_speed};
use crate::readings::choice;
use crate::source::Scaling;
use crate::wrench::{Planar, Wrench, snapped};

/// Points solved between two checks for cancellation.
const POINTS_PER_TASK: usize = 256;

/// An engine, a body and its mounts at some speeds.
#[derive(Debug, Clone)]
pub struct Response {
    powertrain: Arc<Powertrain>,
    orders: Vec<Order>,
    omitted: Vec<Order>,
    error_bound: ErrorBounds,
    /// Angular speed of the crank at each speed.
    omega: Vec<f64>,
    loads: Vec<ComplexVector6>,
    motions: Vec<ComplexVector6>,
    /// Displacement of what carries each mount; empty where it does not move.
    carriers: Vec<Vector3<Complex64>>,
    /// Motion of a subframe; empty without one.
    subframe: Vec<ComplexVector6>,
    /// Motion of a rigid base under all that stands on it, at the CG of the powertrain; empty where it does not move.
    base: Vec<ComplexVector6>,
    /// Whether nothing but the base acts, so that its speeds are frequencies.
    stands: bool,
}

/// An engine's loads about a centre of gravity.
pub(crate) struct EngineLoads {
    pub orders: Vec<Order>,
    pub omitted: Vec<Order>,
    pub error_bound: ErrorBounds,
    /// Angular speed of the crank at each speed.
    pub omega: Vec<f64>,
    groups: List<GroupIndex, Group>,
    /// At each order of each group, over what it scales with.
    unit: Vec<Wrench>,
    /// Of tables of forces at each order, over the square of the angular speed, and those of any speed.
    of_tables: Vec<[ComplexVector6; 2]>,
}

/// One order at one speed.
struct OrderAtSpeed<'a> {
    /// nω.
    omega: f64,
    load: &'a ComplexVector6,
    motion: &'a ComplexVector6,
    stiffnesses: &'a [[Complex64; 3]],
    carriers: &'a [Vector3<Complex64>],
    /// Rotation of a subframe.
    turned: Option<Vector3<Complex64>>,
}

/// What the motion of a point is: displacement, or its first or second derivative by time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// m.
    Displacement,
    /// m/s.
    Velocity,
    /// m/s².
    Acceleration,
}

/// Load of a wrench about the CG: three forces, three moments, zero where they are within rounding.
fn load(wrench: &Wrench) -> ComplexVector6 {
    let along = |planar: &Planar| planar.xy(planar.bound);
    let ([force_x, force_y], [pitch, yaw]) = (along(&wrench.force), along(&wrench.moment));
    let roll = snapped(wrench.torque.roll, wrench.torque.bounds[0]);
    ComplexVector6::new(force_x, force_y, Complex64::ZERO, pitch, yaw, roll)
}

impl EngineLoads {
    /// Those of an engine, if there is one, and of the tables of forces on a body at some speeds.
    pub fn new(
        engine: Option<&Engine>,
        powertrain: &Powertrain,
        rpm: &[f64],
        orders: &Orders,
        cancel: &Cancel,
    ) -> Result<Self> {
        Self::beside(engine, powertrain, rpm, orders, &[], cancel)
    }

    /// The same at further orders, at which something else acts.
    fn beside(
        engine: Option<&Engine>,
        powertrain: &Powertrain,
        rpm: &[f64],
        orders: &Orders,
        further: &[Order],
        cancel: &Cancel,
    ) -> Result<Self> {
        let (cg, tables) = (powertrain.body().cg(), powertrain.forces());
        let mut loads = match engine {
            Some(engine) => Self::of_engine(engine, cg, rpm, orders, cancel)?,
            None if tables.is_empty() && further.is_empty() => {
                let hint = "nothing shakes the body: give an engine, a table of forces, or a base that moves";
                return Err(Error::value("engine", "None", hint));
            }
            None => Self::at_speeds(rpm)?,
        };
        if tables.is_empty() && further.is_empty() {
            return Ok(loads);
        }
        let mut all = match orders {
            Orders::Given(orders) => orders.clone(),
            Orders::Auto { .. } => {
                let of_tables =
                    tables.iter().flat_map(ForceTable::orders).chain(further.iter().copied());
                loads.orders.iter().copied().chain(of_tables).collect()
            }
        };
        if matches!(orders, Orders::Auto { .. }) {
            all.sort_unstable();
            all.dedup();
        }
        let groups = loads.groups.len();
        let mut unit = memory::with_capacity(all.len() * groups)?;
        for order in &all {
            match loads.orders.iter().position(|own| own == order) {
                Some(k) => unit.extend_from_slice(&loads.unit[k * groups..(k + 1) * groups]),
                None => unit.extend(std::iter::repeat_n(Wrench::default(), groups)),
            }
        }
        let of_tables = all.iter().map(|order| {
            tables.iter().fold([ComplexVector6::zeros(); 2], |[by_square, stays], table| {
                let own = table.loads(*order, cg);
                [by_square + own[0], stays + own[1]]
            })
        });
        loads.of_tables = memory::collected(of_tables)?;
        loads.omitted.retain(|order| !all.contains(order));
        (loads.orders, loads.unit) = (all, unit);
        Ok(loads)
    }

    /// No loads at some speeds.
    fn at_speeds(rpm: &[f64]) -> Result<Self> {
        limits::axis_length("rpm", rpm.len())?;
        if rpm.is_empty() {
            return Err(Error::value("rpm", "[]", "give at least one speed"));
        }
        let mut omega = memory::with_capacity(rpm.len())?;
        for &rpm in rpm {
            omega.push(angular_speed(rpm)?);
        }
        Ok(Self {
            orders: Vec::new(),
            omitted: Vec::new(),
            error_bound: ErrorBounds::default(),
            omega,
            groups: List::new(Vec::new()),
            unit: Vec::new(),
            of_tables: Vec::new(),
        })
    }

    /// Those of an engine at some speeds.
    fn of_engine(
        engine: &Engine,
        cg: Vector3<f64>,
        rpm: &[f64],
        orders: &Orders,
        cancel: &Cancel,
    ) -> Result<Self> {
        let mut own = Self::at_speeds(rpm)?;
        engine.check_speeds(rpm)?;
        let loads = Scene::of(engine, Some(cg.z))?;
        let torque = engine.spectrum().is_none();
        let chosen = choice::evaluated(&loads, orders, torque, cancel)?;
        for (order, wrenches) in chosen.kept() {
            own.orders.push(order);
            own.unit.extend(wrenches.iter().map(|wrench| wrench.moved([cg.x, cg.y, 0.0])));
        }
        own.omitted = chosen.omitted();
        own.error_bound = chosen.error_bound(&loads, &own.omega).moved([cg.x, cg.y, 0.0]);
        own.groups = loads.groups.clone();
        Ok(own)
    }

    /// Wrenches of the engine's groups at each order.
    fn of_orders(&self) -> impl Iterator<Item = &[Wrench]> {
        let count = self.groups.len();
        (0..self.orders.len()).map(move |k| &self.unit[k * count..(k + 1) * count])
    }

    /// Loads of each order at a speed, rad/s.
    fn at_speed(&self, omega: f64) -> impl Iterator<Item = ComplexVector6> {
        let factors = self.groups.map_to(|group| group.scaling.factor(omega));
        self.of_orders().enumerate().map(move |(k, of_order)| {
            let scaled =
                of_order.iter().zip(&factors).map(|(wrench, factor)| wrench.scaled(*factor));
            let of_engine = load(&scaled.fold(Wrench::default(), |sum, one| sum.plus(&one)));
            self.of_tables.get(k).map_or(of_engine, |[by_square, stays]| {
                of_engine + by_square * Complex64::from(omega * omega) + stays
            })
        })
    }

    /// Load of each order over ω², and what does not scale with speed; rejects other loads, in which `hint` says why.
    fn by_scaling(&self, hint: &str) -> Result<Vec<[ComplexVector6; 2]>> {
        let of_order = |(k, wrenches): (usize, &[Wrench])| {
            let mut sums = [Wrench::default(); 2];
            for (group, wrench) in self.groups.iter().zip(wrenches) {
                let sum = match group.scaling {
                    Scaling::SpeedSquared => &mut sums[0],
                    Scaling::Independent => &mut sums[1],
                    Scaling::Row(_) => {
                        return Err(Error::value("loads", format!("{:?}", group.name), hint));
                    }
                };
                *sum = sum.plus(wrench);
            }
            let [by_square, fixed] = sums.map(|sum| load(&sum));
            let [more, stays] = self.of_tables.get(k).copied().unwrap_or_default();
            Ok([by_square + more, fixed + stays])
        };
        self.of_orders().enumerate().map(of_order).collect()
    }

    /// Load of each order over (nω)², and what does not scale with speed; rejects other loads.
    pub fn amplitudes(&self) -> Result<Vec<[ComplexVector6; 2]>> {
        let hint = "designs of mounts count loads that scale with the square of speed or not at all, no tables \
                    over speed";
        let over = |([by_square, fixed], order): ([ComplexVector6; 2], &Order)| {
            [by_square / Complex64::from(order.number().powi(2)), fixed]
        };
        Ok(self.by_scaling(hint)?.into_iter().zip(&self.orders).map(over).collect())
    }
}

/// The forces and moments of an engine about a point at a speed, rpm, as a table.
pub fn force_table(
    engine: &Engine,
    rpm: f64,
    orders: &Orders,
    about: [f64; 3],
    cancel: &Cancel,
) -> Result<ForceTable> {
    for (k, along) in about.into_iter().enumerate() {
        limits::finite(&format!("about[{k}]"), along)?;
    }
    let loads = EngineLoads::of_engine(engine, about.into(), &[rpm], orders, cancel)?;
    let hint =
        "a table has loads that scale with the square of speed or not at all, no tables over speed";
    let (mut speed_squared, mut independent) = (Amplitudes::default(), Amplitudes::default());
    let square = Complex64::from(loads.omega[0] * loads.omega[0]);
    for (order, [by_square, fixed]) in loads.orders.iter().zip(loads.by_scaling(hint)?) {
        let both = [(&mut speed_squared, by_square * square), (&mut independent, fixed)];
        for (amplitudes, load) in both {
            if load != ComplexVector6::zeros() {
                let row = load.iter().copied().chain([Complex64::ZERO]).collect();
                amplitudes.0.push((order.halves(), row));
            }
        }
    }
    let name = engine.name().to_owned();
    ForceTable { name, rpm, about, speed_squared, independent }.checked("")
}

impl Response {
    /// Motion at each speed, rpm, in each order of the engine's balance.
    pub fn new<'a>(
        engine: impl Into<Option<&'a Engine>>,
        powertrain: Arc<Powertrain>,
        rpm: &[f64],
        orders: &Orders,
        cancel: &Cancel,
    ) -> Result<Self> {
        let mut response = Self::at_rest(engine.into(), powertrain, rpm, orders, cancel)?;
        response.solve(rpm, cancel)?;
        Ok(response)
    }

    /// Loads of the engine, and no motion.
    fn at_rest(
        engine: Option<&Engine>,
        powertrain: Arc<Powertrain>,
        rpm: &[f64],
        orders: &Orders,
        cancel: &Cancel,
    ) -> Result<Self> {
        let loads = EngineLoads::new(engine, &powertrain, rpm, orders, cancel)?;
        Self::under(loads, powertrain)
    }

    /// These loads, and no motion.
    fn under(of_engine: EngineLoads, powertrain: Arc<Powertrain>) -> Result<Self> {
        let speeds = of_engine.omega.len();
        let count = of_engine.orders.len();
        let hint = "give fewer speeds or orders";
        limits::result_size("response", &[speeds, count, 6], size_of::<Complex64>(), hint)?;
        let mut loads = memory::with_capacity(speeds * count)?;
        for omega in &of_engine.omega {
            loads.extend(of_engine.at_speed(*omega));
        }
        let EngineLoads { orders, omitted, error_bound, omega, .. } = of_engine;
        Ok(Self {
            powertrain,
            orders,
            omitted,
            error_bound,
            omega,
            loads,
            motions: Vec::new(),
            carriers: Vec::new(),
            subframe: Vec::new(),
            base: Vec::new(),
            stands: false,
        })
    }

    /// Motion under the loads of a point on the powertrain and on its subframe, which are not zero.
    fn state(&self, point: usize, rpm: f64, loads: [&ComplexVector6; 2]) -> Result<State> {
        let (_, order) = self.place(point);
        let omega = self.omega_of(point);
        let stiffnesses = self.stiffnesses(point, rpm)?;
        let words = || self.words(point, rpm);
        let state = self.powertrain.state_under(&stiffnesses, omega, loads, words)?;
        state.ok_or_else(|| {
            let unbounded = "where the powertrain has a mode without damping and its motion is unbounded; give mounts \
                             a loss_factor or damping, or another";
            let frequency = omega / TAU;
            if self.stands {
                return Error::figure("frequency", frequency, format!("{unbounded} frequency"));
            }
            let hint = format!("order {order} is at {frequency:.6} Hz, {unbounded} speed");
            Error::figure("rpm", rpm, hint)
        })
    }

    /// A point of operation, in words.
    fn words(&self, point: usize, rpm: f64) -> String {
        if self.stands {
            return format!("{} Hz", self.omega_of(point) / TAU);
        }
        format!("order {} at {rpm} rpm", self.place(point).1)
    }

    fn solve(&mut self, rpm: &[f64], cancel: &Cancel) -> Result<()> {
        let [loads, below] = self.driving(rpm)?;
        let none = ComplexVector6::zeros();
        let below = |point: usize| below.get(point).unwrap_or(&none);
        let (points, count) = (self.loads.len(), self.powertrain.mounts().len());
        let moves = usize::from(self.powertrain.support().is_some());
        let mut motions = memory::collected(std::iter::repeat_n(ComplexVector6::zeros(), points))?;
        let zero = Vector3::zeros();
        let mut carriers = memory::collected(std::iter::repeat_n(zero, points * count * moves))?;
        let is_subframe = matches!(self.powertrain.support(), Some(Support::Subframe(_)));
        let of_subframe = points * usize::from(is_subframe);
        let mut subframe =
            memory::collected(std::iter::repeat_n(ComplexVector6::zeros(), of_subframe))?;
        let mut parts = memory::with_capacity(points.div_ceil(POINTS_PER_TASK))?;
        let mut of_carriers = carriers.chunks_mut(POINTS_PER_TASK * count);
        let mut of_subframe = subframe.chunks_mut(POINTS_PER_TASK);
        for (piece, motions) in motions.chunks_mut(POINTS_PER_TASK).enumerate() {
            let carriers = of_carriers.next().unwrap_or_default();
            parts.push((piece, motions, carriers, of_subframe.next().unwrap_or_default()));
        }
        let equations = if points > 0 && moves == 0 {
            let rates = (0..points).map(|point| self.omega_of(point));
            let natural = natural_at(&self.powertrain, None)?;
            Some(Equations::new(
                &self.powertrain,
                rates.fold(f64::MAX, f64::min),
                natural.as_ref(),
            )?)
        } else {
            None
        };
        // What takes a factorisation takes some two hundred times as long as a product.
        let numbers = if equations.is_some() { 16 } else { 256 };
        pool::each(cancel, parts, numbers * points, |(piece, motions, carriers, subframe)| {
            cancel.check()?;
            let solved = match &equations {
                Some(equations) => self.solve_in_lanes(equations, rpm, piece, &loads, motions)?,
                None => vec![false; motions.len()], // bounded: a piece of the points
            };
            for (k, motion) in motions.iter_mut().enumerate() {
                let point = piece * POINTS_PER_TASK + k;
                if solved[k] || (loads[point] == none && *below(point) == none) {
                    continue;
                }
                let on_both = [&loads[point], below(point)];
                let state = self.state(point, rpm[self.place(point).0], on_both)?;
                *motion = state.motion;
                if let Some(place) = carriers.get_mut(k * count..(k + 1) * count) {
                    place.copy_from_slice(&state.carrier);
                }
                if let Some(place) = subframe.get_mut(k) {
                    *place = state.subframe;
                }
            }
            Ok(())
        })?;
        drop(loads);
        if moves == 0 && !self.base.is_empty() {
            let places =
                self.powertrain.mounts().iter().map(|mount| self.powertrain.arm(&mount.at()));
            let places: Vec<_> = places.collect(); // bounded: 1000 mounts
            let at = |base: &ComplexVector6| {
                places.iter().map(|arm| displaced(base, arm)).collect::<Vec<_>>()
            };
            carriers = memory::with_capacity(points * count)?;
            self.base.iter().for_each(|base| carriers.extend(at(base)));
        }
        (self.motions, self.carriers, self.subframe) = (motions, carriers, subframe);
        Ok(())
    }

    /// Motions of a piece of the points; which of them were solved.
    fn solve_in_lanes(
        &self,
        equations: &Equations,
        rpm: &[f64],
        piece: usize,
        loads: &[ComplexVector6],
        motions: &mut [ComplexVector6],
    ) -> Result<Vec<bool>> {
        let first = piece * POINTS_PER_TASK;
        let mut all = memory::with_capacity(motions.len())?;
        let turns = [rows(&equations.to), rows(&equations.from)];
        let varying: Vec<_> = self
            .powertrain
            .mounts()
            .iter()
            .filter(|mount| mount.dynamic().constant().is_none())
            .collect();
        let mut stiffnesses = vec![[[0.0; LANES]; 2]; 3 * varying.len()];
        for (k, motions) in motions.chunks_mut(LANES).enumerate() {
            let points = first + k * LANES..first + k * LANES + motions.len();
            let in_lanes = lanes(&loads[points.clone()]);
            let mut rates = [0.0; LANES];
            for l in 0..LANES {
                let point = (points.start + l).min(points.end - 1);
                let omega = self.omega_of(point);
                rates[l] = omega;
                if varying.is_empty() || loads[point] == ComplexVector6::zeros() {
                    continue;
                }
                let words = || self.words(point, rpm[self.place(point).0]);
                for (mount, along) in varying.iter().zip(stiffnesses.chunks_mut(3)) {
                    for (value, to) in mount.stiffness_at(omega, words)?.iter().zip(along) {
                        (to[0][l], to[1][l]) = (value.re, value.im);
                    }
                }
            }
            let (solved, moved) = equations.motions(&turns, &rates, &stiffnesses, &in_lanes);
            for (l, motion) in motions.iter_mut().enumerate() {
                all.push(solved[l]);
                if solved[l] && loads[points.start + l] != ComplexVector6::zeros() {
                    let part = |k: usize, _| Complex64::new(moved[0][k][l], moved[1][k][l]);
                    *motion = ComplexVector6::from_fn(part);
                }
            }
        }
        Ok(all)
    }

    /// Index of the speed, and the order, of a point.
    fn place(&self, point: usize) -> (usize, Order) {
        (point / self.orders.len(), self.orders[point % self.orders.len()])
    }

    /// nω of a point.
    fn omega_of(&self, point: usize) -> f64 {
        let (row, order) = self.place(point);
        self.omega[row] * order.number()
    }

    fn stiffnesses(&self, point: usize, rpm: f64) -> Result<Vec<[Complex64; 3]>> {
        self.powertrain.stiffnesses(self.omega_of(point), || self.words(point, rpm))
    }

    /// Multiples of crank speed.
    #[must_use]
    pub fn orders(&self) -> &[Order] {
        &self.orders
    }

    /// Orders of the engine evaluated and left out, of those that are not zero.
    #[must_use]
    pub fn omitted(&self) -> &[Order] {
        &self.omitted
    }

    /// Bounds of what the orders left out add to the engine's own force, moment and torque about the CG, at
    /// the highest speed.
    #[must_use]
    pub fn error_bound(&self) -> ErrorBounds {
        self.error_bound
    }

    /// The engine's load about the CG, force and moment, at each speed and order.
    #[must_use]
    pub fn loads(&self) -> &[ComplexVector6] {
        &self.loads
    }

    /// Loads about a point, m, of loads about the CG.
    #[must_use]
    pub fn about(&self, point: [f64; 3], loads: &[ComplexVector6]) -> Vec<ComplexVector6> {
        let arm = self.powertrain.body().cg() - Vector3::from(point);
        loads.iter().map(|load| moved(load, &arm)).collect() // bounded: as many as there are loads
    }

    /// Displacement of the CG, m, and rotation, rad, at each speed and order.
    #[must_use]
    pub fn motions(&self) -> &[ComplexVector6] {
        &self.motions
    }

    /// Calls a function for each speed and order.
    fn for_each(
        &self,
        cancel: &Cancel,
        mut work: impl FnMut(&OrderAtSpeed) -> Result<()>,
    ) -> Result<()> {
        let count = self.powertrain.mounts().len();
        for (point, motion) in self.motions.iter().enumerate() {
            if point.is_multiple_of(POINTS_PER_TASK) {
                cancel.check()?;
            }
            // Within tables: they were read for the motion. At rest of a load that is zero nothing moves.
            let zero = ComplexVector6::zeros();
            let base = self.base.get(point);
            let stiffnesses = if *motion == zero && base.is_none_or(|base| *base == zero) {
                vec![[Complex64::ZERO; 3]; self.powertrain.deflections().len()] // bounded: springs
            } else {
                self.stiffnesses(point, f64::NAN)?
            };
            work(&OrderAtSpeed {
                omega: self.omega_of(point),
                load: &self.loads[point],
                motion,
                stiffnesses: &stiffnesses,
                carriers: self.carriers.get(point * count..(point + 1) * count).unwrap_or_default(),
                turned: self
                    .subframe
                    .get(point)
                    .or(base)
                    .map(|moved| moved.fixed_rows::<3>(3).into()),
            })?;
        }
        Ok(())
    }

    /// Displacement of what carries a spring, or its rotation; none where it does not move.
    fn carrier<'a>(
        &self,
        spring: usize,
        point: &'a OrderAtSpeed,
    ) -> Option<&'a Vector3<Complex64>> {
        let is_rotation = spring >= self.powertrain.mounts().len();
        if is_rotation { point.turned.as_ref() } else { point.carriers.get(spring) }
    }

    /// Force of a mount on what carries it.
    fn force(&self, mount: usize, point: &OrderAtSpeed) -> [Complex64; 3] {
        let deflection = self.powertrain.deflection(mount, point.motion, point.carriers.get(mount));
        self.powertrain.force_on_support(mount, &point.stiffnesses[mount], &deflection)
    }

    /// Force of each mount on what carries it along x, y and z, N, at each speed and order.
    pub fn mount_forces(&self, cancel: &Cancel) -> Result<Vec<[Complex64; 3]>> {
        let count = self.powertrain.mounts().len();
        let lengths = [self.motions.len(), count, 3];
        limits::result_size("response", &lengths, size_of::<Complex64>(), "give fewer speeds")?;
        let mut forces = memory::with_capacity(self.motions.len() * count)?;
        self.for_each(cancel, |point| {
            forces.extend((0..count).map(|k| self.force(k, point)));
            Ok(())
        })?;
        Ok(forces)
    }

    /// Sum of the mounts' forces on what carries them, N, and of their moments about the CG, N·m, at each
    /// speed and order.
    pub fn support_loads(&self, cancel: &Cancel) -> Result<Vec<ComplexVector6>> {
        let mut sums = memory::with_capacity(self.motions.len())?;
        self.for_each(cancel, |point| {
            let mut sum = ComplexVector6::zeros();
            for (k, deflection) in self.powertrain.deflections().iter().enumerate() {
                let moved = self.powertrain.deflection(k, point.motion, self.carrier(k, point));
                let along = Vector3::from(point.stiffnesses[k]).component_mul(&moved);
                sum += deflection.transpose().map(Complex64::from) * along;
            }
            sums.push(sum);
            Ok(())
        })?;
        Ok(sums)
    }

    /// Motion of a point of the powertrain, or of its subframe, along x, y and z at each speed and order.
    pub fn at(
        &self,
        point: [f64; 3],
        derivative: Derivative,
        of_subframe: bool,
        cancel: &Cancel,
    ) -> Result<Vec<[Complex64; 3]>> {
        let (body, motions) = if of_subframe {
            (self.subframe()?, &self.subframe)
        } else {
            (&*self.powertrain, &self.motions)
        };
        for (k, place) in point.into_iter().enumerate() {
            limits::finite(&format!("point[{k}]"), place)?;
        }
        let mut values = memory::with_capacity(self.motions.len())?;
        for (k, motion) in motions.iter().enumerate() {
            if k.is_multiple_of(POINTS_PER_TASK) {
                cancel.check()?;
            }
            values.push(derivative.of(body.motion_of(point, motion), self.omega_of(k)));
        }
        Ok(values)
    }

    /// Severity grade (ISO 10816-6) of a point at each speed: the worst of its three directions.
    pub fn grades(&self, point: [f64; 3], of_subframe: bool, cancel: &Cancel) -> Result<Vec<f64>> {
        let moved = self.at(point, Derivative::Displacement, of_subframe, cancel)?;
        Ok(self.grades_of(&moved))
    }

    /// Severity grade of a receiver at each speed.
    pub fn grades_at_receiver(&self, name: &str, cancel: &Cancel) -> Result<Vec<f64>> {
        Ok(self.grades_of(&self.at_receiver(name, Derivative::Displacement, cancel)?))
    }

    fn grades_of(&self, moved: &[[Complex64; 3]]) -> Vec<f64> {
        let count = self.orders.len();
        let of_speed = |(row, moved): (usize, &[[Complex64; 3]])| {
            let along = |axis: usize| {
                let peaks = moved.iter().enumerate();
                let peaks = peaks.map(|(k, at)| (at[axis].norm(), self.omega_of(row * count + k)));
                grade(&Levels::of(peaks))
            };
            [0, 1, 2].map(along).into_iter().fold(0.0, f64::max)
        };
        moved.chunks(count).enumerate().map(of_speed).collect()
    }

    /// Mean power at each speed and order: what the engine puts in, what what carries the mounts takes,
    /// then what each mount dissipates, W.
    pub fn power(&self, cancel: &Cancel) -> Result<Vec<Vec<f64>>> {
        let mut rows = memory::with_capacity(self.motions.len())?;
        self.for_each(cancel, |point| {
            let velocity = point.motion * Complex64::new(0.0, point.omega);
            let mut row = memory::zeros(2 + self.powertrain.mounts().len())?;
            row[0] = 0.5 * point.load.dotc(&velocity).re;
            for (k, (spring, along)) in self.powertrain.springs().zip(point.stiffnesses).enumerate()
            {
                let carrier = self.carrier(k, point);
                let moved = self.powertrain.deflection(k, point.motion, carrier);
                let parts = moved.iter().zip(along);
                let lost: f64 = parts.map(|(part, k)| k.im * part.norm_sqr()).sum();
                row[2 + spring.owner] += 0.5 * point.omega * lost;
                if let Some(carrier) = carrier {
                    let force = self.powertrain.force_on_support(spring.owner, along, &moved);
                    let force = Vector3::from(force);
                    let velocity = carrier * Complex64::new(0.0, point.omega);
                    row[1] += 0.5 * force.dotc(&velocity).re;
                }
            }
            rows.push(row);
            Ok(())
        })?;
        Ok(rows)
    }

    /// Displacement of the CG of a subframe, m, and its rotation, rad, at each speed and order.
    pub fn subframe_motions(&self) -> Result<&[ComplexVector6]> {
        self.subframe().map(|_| self.subframe.as_slice())
    }

    fn subframe(&self) -> Result<&Powertrain> {
        match self.powertrain.support() {
            Some(Support::Subframe(subframe)) => Ok(subframe),
            _ => Err(Error::value(
                "support",
                "no subframe",
                "give the powertrain one: `Powertrain::on`",
            )),
        }
    }

    /// Force of each mount of a subframe on what carries it along x, y and z, N, at each speed and order.
    pub fn ground_forces(&self, cancel: &Cancel) -> Result<Vec<[Complex64; 3]>> {
        let subframe = self.subframe()?;
        let count = subframe.mounts().len();
        let lengths = [self.motions.len(), count, 3];
        limits::result_size("response", &lengths, size_of::<Complex64>(), "give fewer speeds")?;
        let mut forces = memory::with_capacity(self.motions.len() * count)?;
        let arms = subframe.mounts().iter().map(|mount| self.powertrain.arm(&mount.at()));
        let arms: Vec<_> = arms.collect(); // bounded: 1000 mounts
        let zero = ComplexVector6::zeros();
        for (point, motion) in self.subframe.iter().enumerate() {
            if point.is_multiple_of(POINTS_PER_TASK) {
                cancel.check()?;
            }
            let base = self.base.get(point);
            if *motion == zero && base.is_none_or(|base| *base == zero) {
                forces.extend(std::iter::repeat_n([Complex64::ZERO; 3], count));
                continue;
            }
            let stiffnesses = subframe.stiffnesses(self.omega_of(point), String::new)?;
            forces.extend((0..count).map(|k| {
                let carrier = base.map(|base| displaced(base, &arms[k]));
                let deflection = subframe.deflection(k, motion, carrier.as_ref());
                subframe.force_on_support(k, &stiffnesses[k], &deflection)
            }));
        }
        Ok(forces)
    }

    /// Motion of a receiver of a receptance along x, y and z at each speed and order.
    pub fn at_receiver(
        &self,
        name: &str,
        derivative: Derivative,
        cancel: &Cancel,
    ) -> Result<Vec<[Complex64; 3]>> {
        let Some(Support::Receptance(receptance)) = self.powertrain.support() else {
            let hint = "a name is that of a receiver of a receptance that carries the mounts";
            return Err(Error::value("point", format!("{name:?}"), hint));
        };
        let receiver = receptance.receivers.iter().find(|receiver| receiver.name == name);
        let receiver = receiver.ok_or_else(|| {
            let names: Vec<&str> = receptance.receivers.iter().map(|r| r.name.as_str()).collect();
            let hint = format!("is no receiver of the receptance; there are: {}", names.join(", "));
            Error::value("point", format!("{name:?}"), hint)
        })?;
        let mut values = memory::with_capacity(self.motions.len())?;
        self.for_each(cancel, |point| {
            if *point.motion == ComplexVector6::zeros() {
                values.push([Complex64::ZERO; 3]);
                return Ok(());
            }
            let coordinates = self.powertrain.coordinates();
            let forces: Vec<Complex64> =
                coordinates.iter().map(|place| self.force(place / 3, point)[place % 3]).collect();
            let moved = receptance.moved(receiver, point.omega, &forces)?;
            values.push(derivative.of(moved, point.omega));
            Ok(())
        })?;
        Ok(values)
    }
}

impl Derivative {
    /// Phasors of this, of those of a displacement.
    fn of(self, moved: [Complex64; 3], omega: f64) -> [Complex64; 3] {
        let factor = self.factor(omega);
        // Adding zero makes −0 0.
        moved.map(|phasor| phasor * factor + Complex64::ZERO)
    }

    /// Its phasors over those of a displacement.
    fn factor(self, omega: f64) -> Complex64 {
        let rate = Complex64::new(0.0, omega);
        match self {
            Self::Displacement => Complex64::ONE,
            Self::Velocity => rate,
            Self::Acceleration => rate * rate,
        }
    }
}

mod base;
mod driven;
pub use self::base::BaseMotion;
use self::base::displaced;
pub use self::driven::ActuatorForces;
#[cfg(test)]
mod tests;
