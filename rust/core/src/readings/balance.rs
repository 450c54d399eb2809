//! How an engine shakes, order by order: force, moment and torque as peak phasors.

use std::sync::Arc;

use crate::Complex64;
use crate::engine::Engine;
use crate::load::{GroupIndex, Scene};
pub use crate::numbers::UNIT_RPM;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::List;
use crate::numbers::limits;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::readings::choice;
use crate::readings::peaks::PeakFinder;
use crate::readings::quantity::Part;
use crate::wrench::{Planar, Torque, Wrench};

/// Which orders to report.
#[derive(Debug, Clone, PartialEq)]
pub enum Orders {
    /// These.
    Given(Vec<Order>),
    /// A few that leave out at most this part of the largest m·r·ω² of a cylinder (times the longest
    /// lever for moments, and the crank radius for torque), and of the torque of gas pressure at most
    /// this part of a cylinder's largest, but a thousandth of it if the tolerance is smaller.
    Auto {
        /// Relative tolerance.
        rtol: f64,
    },
}

impl Orders {
    /// Whole orders from a list.
    pub fn whole(orders: &[u32]) -> Result<Self> {
        Order::all_whole(orders).map(Self::Given)
    }
}

/// Operating point and options of a balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// Crank speed.
    pub rpm: f64,
    /// Plane about which moments are taken; by default half-way between the first and the last
    /// cylinder.
    pub reference_z: Option<f64>,
    /// Whether torques are wanted too.
    pub torque: bool,
}

/// How an engine shakes at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    /// Orders, ascending where they were chosen here.
    pub orders: Vec<Order>,
    /// Orders evaluated and left out, of those that are not zero.
    pub omitted: Vec<Order>,
    /// Wrench of each order; what vanishes to within rounding is zero.
    pub wrenches: Vec<Wrench>,
    /// Names of the parts: `inertia`, `gas` where pressure counts, and those of further loads.
    names: Vec<Arc<str>>,
    /// Wrenches of each order and part; none of a single one, which is the whole.
    parts: Vec<Wrench>,
    /// Orders evaluated that are not among them, and their wrenches.
    left: Vec<(Order, OfOrder)>,
    /// Mean torques on the block and on the crank, and of each part.
    mean: [f64; 2],
    means: Vec<[f64; 2]>,
    /// Bounds of what the orders left out add at any crank angle; 0 for orders that were given.
    pub error_bound: ErrorBounds,
    /// Whether torque is known: it was wanted, and the engine has no given spectrum of forces.
    pub has_torque: bool,
}

/// Wrench of an order at a speed, and its parts; none of a single one.
#[derive(Debug, Clone, PartialEq)]
struct OfOrder {
    whole: Wrench,
    parts: Vec<Wrench>,
}

/// Bounds of what orders add, or of what is left out; of groups of loads over what they scale with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ErrorBounds {
    /// To the shaking force, N.
    pub force: f64,
    /// To the rocking moment, N·m.
    pub moment: f64,
    /// To either torque, N·m.
    pub torque: f64,
}

impl ErrorBounds {
    /// Of force, moment and torque side by side.
    #[must_use]
    pub fn values(self) -> [f64; 3] {
        [self.force, self.moment, self.torque]
    }

    /// The larger of both.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        self.with(other, f64::max)
    }

    /// The sum of both.
    pub(super) fn plus(self, other: Self) -> Self {
        self.with(other, |own, other| own + other)
    }

    pub(super) fn times(self, factor: f64) -> Self {
        Self::from(self.values().map(|bound| bound * factor))
    }

    fn with(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        let ([a, b, c], [d, e, f]) = (self.values(), other.values());
        Self::from([of(a, d), of(b, e), of(c, f)])
    }

    /// The same about a point this far away along x, y and z, m: at most force times distance is added.
    ///
    /// Forces act across the crank: a point aside changes the torque, and one along the crank the moment.
    #[must_use]
    pub fn moved(self, [x, y, z]: [f64; 3]) -> Self {
        let Self { force, moment, torque } = self;
        Self { force, moment: moment + z.abs() * force, torque: torque + x.hypot(y) * force }
    }
}

impl From<[f64; 3]> for ErrorBounds {
    fn from([force, moment, torque]: [f64; 3]) -> Self {
        Self { force, moment, torque }
    }
}

/// Force or moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vector {
    /// Shaking force, N.
    Force,
    /// Rocking moment, N·m.
    Moment,
}

impl Vector {
    /// Which of a wrench.
    #[must_use]
    pub fn of(self, wrench: &Wrench) -> &Planar {
        match self {
            Self::Force => &wrench.force,
            Self::Moment => &wrench.moment,
        }
    }
}

impl Balance {
    /// The balance of one order alone, if it was evaluated here.
    #[must_use]
    pub fn alone(&self, order: Order) -> Option<Self> {
        let place = self.orders.iter().position(|&own| own == order);
        let left = || self.left.iter().find(|(own, _)| *own == order);
        let OfOrder { whole, parts } = match place {
            Some(k) => self.of_order(k),
            None => left()?.1.clone(),
        };
        Some(Self {
            orders: vec![order],
            omitted: Vec::new(),
            wrenches: vec![whole],
            names: self.names.clone(),
            parts,
            left: Vec::new(),
            means: self.means.clone(),
            error_bound: ErrorBounds::default(),
            ..*self
        })
    }

    /// Wrench of an order, if it is among [`Self::orders`].
    #[must_use]
    pub fn order(&self, order: Order) -> Option<&Wrench> {
        let place = self.orders.iter().position(|&own| own == order)?;
        Some(&self.wrenches[place])
    }

    /// The same balance about a point this far away along x, y and z, m.
    #[must_use]
    pub fn moved(&self, arm: [f64; 3]) -> Self {
        let moved = |wrenches: &[Wrench]| wrenches.iter().map(|one| one.moved(arm)).collect();
        let left = |(order, of): &(Order, OfOrder)| {
            (*order, OfOrder { whole: of.whole.moved(arm), parts: moved(&of.parts) })
        };
        Self {
            wrenches: moved(&self.wrenches),
            parts: moved(&self.parts),
            left: self.left.iter().map(left).collect(),
            error_bound: self.error_bound.moved(arm),
            ..self.clone()
        }
    }

    fn of_order(&self, k: usize) -> OfOrder {
        let count = if self.parts.is_empty() { 0 } else { self.names.len() };
        OfOrder { whole: self.wrenches[k], parts: self.parts[k * count..][..count].to_vec() }
    }

    /// The balance of a part alone; its bound is that of the whole.
    #[must_use]
    pub fn of_part(&self, part: Part) -> Self {
        let Part::Of(name) = part else { return self.clone() };
        let of_left = |(order, of): &(Order, OfOrder)| {
            let place = self.names.iter().position(|own| **own == *name);
            let whole = match place {
                Some(place) => of.parts.get(place).copied().unwrap_or(of.whole),
                None => Wrench::default(),
            };
            (*order, OfOrder { whole, parts: Vec::new() })
        };
        Self {
            orders: self.orders.clone(),
            omitted: self.omitted.clone(),
            wrenches: (0..self.orders.len()).map(|k| self.wrench(part, k)).collect(),
            names: vec![name.into()],
            parts: Vec::new(),
            left: self.left.iter().map(of_left).collect(),
            mean: self.mean(part),
            means: vec![self.mean(part)],
            ..*self
        }
    }

    /// Names of the parts of its quantities.
    #[must_use]
    pub fn names(&self) -> &[Arc<str>] {
        &self.names
    }

    /// Wrench of a part of the k-th order.
    #[must_use]
    pub fn wrench(&self, part: Part, k: usize) -> Wrench {
        let Part::Of(name) = part else { return self.wrenches[k] };
        match self.names.iter().position(|own| **own == *name) {
            Some(_) if self.parts.is_empty() => self.wrenches[k],
            Some(place) => self.parts[k * self.names.len() + place],
            None => Wrench::default(),
        }
    }

    /// Of wrenches of an engine's loads, by order and group, at a speed, rad/s.
    pub(super) fn of(
        loads: &Scene,
        orders: Vec<Order>,
        wrenches: &[Wrench],
        means: &List<GroupIndex, [f64; 2]>,
        omega: f64,
    ) -> Result<Self> {
        let names = loads.names();
        let (mut wholes, mut parts) = (memory::with_capacity(orders.len())?, Vec::new());
        let (mut whole, mut of_names) = ([0.0; 2], vec![[0.0; 2]; names.len()]);
        let of_groups: Vec<(usize, f64)> = loads
            .groups
            .iter()
            .map(|group| {
                let name = names.iter().position(|name| *name == group.name).unwrap_or(0);
                (name, group.scaling.factor(omega))
            })
            .collect();
        for (&(name, factor), own) in of_groups.iter().zip(means) {
            for on in 0..2 {
                whole[on] += factor * own[on];
                of_names[name][on] += factor * own[on];
            }
        }
        if let [(_, factor)] = of_groups[..] {
            wholes.extend(wrenches.iter().map(|wrench| wrench.scaled(factor)));
        } else {
            parts = memory::with_capacity(orders.len() * names.len())?;
            for of_order in wrenches.chunks(of_groups.len()) {
                let (first, mut whole) = (parts.len(), Wrench::default());
                parts.resize(first + names.len(), Wrench::default());
                for (&(name, factor), wrench) in of_groups.iter().zip(of_order) {
                    let (part, scaled) = (&mut parts[first + name], wrench.scaled(factor));
                    *part = Wrench::plus(part, &scaled);
                    whole = whole.plus(&scaled);
                }
                wholes.push(whole.snapped());
            }
        }
        Ok(Self {
            orders,
            omitted: Vec::new(),
            wrenches: wholes,
            names,
            parts,
            left: Vec::new(),
            mean: whole,
            means: of_names,
            error_bound: ErrorBounds::default(),
            has_torque: true,
        })
    }

    /// Leaves out the orders that are not kept; `error_bound` bounds them and those that were not evaluated.
    pub(super) fn keep(mut self, kept: &[bool], error_bound: ErrorBounds) -> Self {
        let names = if self.parts.is_empty() { 0 } else { self.names.len() };
        let (mut orders, mut wrenches, mut parts) = (Vec::new(), Vec::new(), Vec::new());
        for (k, (&order, &kept)) in self.orders.iter().zip(kept).enumerate() {
            let of_order = self.of_order(k);
            if kept {
                orders.push(order);
                wrenches.push(of_order.whole);
                parts.extend(of_order.parts);
            } else {
                let parts = &self.parts[k * names..][..names];
                if !parts.iter().chain([&of_order.whole]).all(Wrench::is_zero) {
                    self.omitted.push(order);
                }
                self.left.push((order, of_order));
            }
        }
        Self { orders, wrenches, parts, error_bound, ..self }
    }

    /// Force or moment of the k-th order.
    #[must_use]
    pub fn planar(&self, vector: Vector, k: usize) -> &Planar {
        vector.of(&self.wrenches[k])
    }

    /// Bound of the rounding error of the k-th order of force or moment.
    #[must_use]
    pub fn zero_bound(&self, vector: Vector, k: usize) -> f64 {
        self.planar(vector, k).bound
    }

    /// A part of the torques of the k-th order.
    #[must_use]
    pub fn torque(&self, part: Part, k: usize) -> Torque {
        self.wrench(part, k).torque
    }

    /// Mean torques of a part on the block and on the crank.
    #[must_use]
    pub fn mean(&self, part: Part) -> [f64; 2] {
        let Part::Of(name) = part else { return self.mean };
        let own = self.names.iter().position(|own| **own == *name);
        own.map_or([0.0; 2], |own| self.means[own])
    }

    /// Bounds of the rounding errors of the k-th order of a part of the torques, on the block and on the
    /// crank.
    #[must_use]
    pub fn torque_zero_bounds(&self, part: Part, k: usize) -> [f64; 2] {
        self.torque(part, k).bounds
    }

    /// Peak phasors along (about) x and y of the k-th order.
    #[must_use]
    pub fn xy(&self, vector: Vector, k: usize) -> [Complex64; 2] {
        self.planar(vector, k).xy(self.zero_bound(vector, k))
    }

    /// Largest value along (about) x and y of the sum of all orders.
    pub fn peak_xy(&self, vector: Vector, cancel: &Cancel) -> Result<[f64; 2]> {
        let finder = PeakFinder::new(&self.orders)?;
        let [x, y] = self.by_component(vector);
        Ok([finder.along_axis(&x, cancel)?, finder.along_axis(&y, cancel)?])
    }

    /// Longest vector of the sum of all orders.
    pub fn peak(&self, vector: Vector, cancel: &Cancel) -> Result<f64> {
        let [x, y] = self.by_component(vector);
        PeakFinder::new(&self.orders)?.of_vector(&x, &y, cancel)
    }

    /// Largest magnitude of a part of the torque on the block or on the crank: of the mean and all
    /// orders together.
    pub fn torque_peak(&self, part: Part, on_crank: bool, cancel: &Cancel) -> Result<f64> {
        let mean = self.mean(part)[usize::from(on_crank)];
        let torque = |k: usize| {
            let Torque { roll, crank, .. } = self.torque(part, k);
            if on_crank { crank } else { roll }
        };
        let phasors: Vec<_> = (0..self.orders.len()).map(torque).collect();
        PeakFinder::about_mean(&self.orders)?.beside_mean(mean, &phasors, cancel)
    }

    fn by_component(&self, vector: Vector) -> [Vec<Complex64>; 2] {
        let all: Vec<_> = (0..self.orders.len()).map(|k| self.xy(vector, k)).collect();
        [0, 1].map(|component| all.iter().map(|xy| xy[component]).collect())
    }
}

/// Angular speed in rad/s.
pub fn angular_speed(rpm: f64) -> Result<f64> {
    if rpm < 0.0 {
        let hint = "give zero or more; the crank turns counter-clockwise seen from the flywheel: \
                    mirror an engine that turns the other way, bank = 180° - bank";
        return Err(Error::figure("rpm", rpm, hint));
    }
    Ok(limits::not_negative("rpm", rpm)? * std::f64::consts::TAU / 60.0)
}

/// The balance of an engine.
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
/// use crankpin_core::balance::{Orders, Request, balance};
/// use crankpin_core::{Cancel, Order};
///
/// let request = Request { rpm: 6000.0, reference_z: None, torque: true };
/// let found = balance(&four, &request, &Orders::Auto { rtol: 1e-9 }, &Cancel::new())?;
/// let force = |order| found.order(order).map(|wrench| wrench.force.peak().round());
/// assert_eq!(force(Order::whole(2)?), Some(13595.0)); // N
/// assert_eq!(force(Order::FIRST), None); // it cancels
/// assert!(found.error_bound.force < 1e-4);
/// # Ok::<(), crankpin_core::Error>(())
/// ```
pub fn balance(
    engine: &Engine,
    request: &Request,
    orders: &Orders,
    cancel: &Cancel,
) -> Result<Balance> {
    let omega = angular_speed(request.rpm)?;
    engine.check_speeds(&[request.rpm])?;
    let loads = Scene::of(engine, request.reference_z)?;
    let torque = request.torque && engine.spectrum().is_none();
    let chosen = choice::evaluated(&loads, orders, torque, cancel)?;
    let mut balance = chosen.at_speed(&loads, omega)?;
    balance.has_torque = torque;
    Ok(balance)
}
