//! How an engine shakes, order by order: force, moment and torque as peak phasors.

use crate::Complex64;
use crate::engine::Engine;
use crate::load::{Load, LoadList, count};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::order::{self, Order};
use crate::readings::amplitude::wrenches;
use crate::readings::choice::{self, Chosen, OrderSums};
use crate::readings::peaks::PeakFinder;
use crate::wrench::{Planar, Torque, Wrench, rounding};

/// Crank speed at which ω is 1 rad/s.
pub const UNIT_RPM: f64 = 30.0 / std::f64::consts::PI;

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
    /// Orders evaluated that are not among them, and their wrenches.
    left: Vec<(Order, Wrench)>,
    /// Mean torques on the block and on the crank, of pressure alone.
    pub mean: [f64; 2],
    /// Bounds of what the orders left out add at any crank angle; 0 for orders that were given.
    pub error_bound: ErrorBounds,
    /// Whether torque is known: it was wanted, and the engine has no given spectrum of forces.
    pub has_torque: bool,
    /// What the orders left out add, those of inertia over ω².
    left_out: OrderSums,
    /// Numbers of loads that have a force, and of all, on which rounding depends.
    counts: [usize; 2],
}

/// Bounds of what is left out.
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

    /// The same about a point this far away along x, y and z, m: at most force times distance is added.
    ///
    /// Forces act across the crank: a point aside changes the torque, and one along the crank the moment.
    #[must_use]
    pub fn moved(self, [x, y, z]: [f64; 3]) -> Self {
        let Self { force, moment, torque } = self;
        Self { force, moment: moment + z.abs() * force, torque: torque + x.hypot(y) * force }
    }
}

/// Part of a torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TorquePart {
    /// All of it.
    Whole,
    /// Of inertia forces.
    Inertia,
    /// Of gas pressure.
    Gas,
}

/// Force or moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vector {
    /// Shaking force, N.
    Force,
    /// Rocking moment, N·m.
    Moment,
}

impl Balance {
    /// Of wrenches of orders that were given, and mean torques; of these loads.
    pub(super) fn of_orders(
        orders: Vec<Order>,
        wrenches: Vec<Wrench>,
        mean: [f64; 2],
        has_torque: bool,
        loads: &[Load],
    ) -> Self {
        let (omitted, left, error_bound) = (Vec::new(), Vec::new(), ErrorBounds::default());
        let (left_out, counts) =
            (OrderSums::default(), [false, true].map(|torque| count(loads, torque)));
        Self { orders, omitted, wrenches, left, mean, error_bound, has_torque, left_out, counts }
    }

    /// The balance of one order alone, if it was evaluated here.
    #[must_use]
    pub fn alone(&self, order: Order) -> Option<Self> {
        let place = self.orders.iter().position(|&own| own == order);
        let left = || self.left.iter().find(|(own, _)| *own == order).map(|(_, wrench)| wrench);
        let wrench = *place.map(|k| &self.wrenches[k]).or_else(left)?;
        Some(Self {
            orders: vec![order],
            omitted: Vec::new(),
            wrenches: vec![wrench],
            left: Vec::new(),
            error_bound: ErrorBounds::default(),
            left_out: OrderSums::default(),
            ..*self
        })
    }

    /// Force or moment of the k-th order.
    #[must_use]
    pub fn planar(&self, vector: Vector, k: usize) -> &Planar {
        match vector {
            Vector::Force => &self.wrenches[k].force,
            Vector::Moment => &self.wrenches[k].moment,
        }
    }

    /// Bound of the rounding error of the k-th order of force or moment.
    #[must_use]
    pub fn zero_bound(&self, vector: Vector, k: usize) -> f64 {
        self.planar(vector, k).size * rounding(self.counts[0], self.orders[k].number())
    }

    /// Bounds of what the orders left out add at another speed, rad/s.
    pub(crate) fn error_bound_at(&self, omega: f64) -> ErrorBounds {
        self.left_out.bounds(omega * omega)
    }

    /// Bounds of rounding over the sizes of sums, of planar vectors and of torques of an order.
    pub(crate) fn roundings(&self, order: Order) -> [f64; 2] {
        self.counts.map(|count| rounding(count, order.number()))
    }

    /// A part of the torques of the k-th order.
    #[must_use]
    pub fn torque(&self, part: TorquePart, k: usize) -> Torque {
        let wrench = &self.wrenches[k];
        match part {
            TorquePart::Whole => wrench.torque(),
            TorquePart::Inertia => wrench.inertia,
            TorquePart::Gas => wrench.gas,
        }
    }

    /// Mean torques of a part on the block and on the crank: those of inertia are zero.
    #[must_use]
    pub fn mean(&self, part: TorquePart) -> [f64; 2] {
        if part == TorquePart::Inertia { [0.0; 2] } else { self.mean }
    }

    /// Bounds of the rounding errors of the k-th order of a part of the torques, on the block and on the
    /// crank.
    #[must_use]
    pub fn torque_zero_bounds(&self, part: TorquePart, k: usize) -> [f64; 2] {
        let rounding = rounding(self.counts[1], self.orders[k].number());
        self.torque(part, k).sizes.map(|size| size * rounding)
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
    pub fn torque_peak(&self, part: TorquePart, on_crank: bool, cancel: &Cancel) -> Result<f64> {
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
                    mirror an engine that turns the other way, bank_deg = 180 - bank_deg";
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
/// use crankpin_core::balance::{Orders, Request, Vector, balance};
/// use crankpin_core::Cancel;
///
/// let request = Request { rpm: 6000.0, reference_z: None, torque: true };
/// let found = balance(&four, &request, &Orders::Auto { rtol: 1e-9 }, &Cancel::new())?;
/// let second = found.planar(Vector::Force, 0); // the first order that remains
/// assert_eq!((found.orders[0].as_whole(), second.peak().round()), (Some(2), 13595.0)); // N
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
    let reference = engine.reference(request.reference_z)?;
    let torque = request.torque && engine.spectrum().is_none();
    let loads = LoadList::new(engine, reference);
    let square = omega * omega;
    let chosen = match orders {
        Orders::Given(orders) => {
            order::check_list(orders)?;
            let (wrenches, mean) = wrenches(&loads, &loads.sources, torque, orders, cancel)?;
            let (orders, left) = (orders.clone(), Vec::new());
            Chosen { orders, wrenches, mean, left, left_out: OrderSums::default() }
        }
        Orders::Auto { rtol } => choice::within(*rtol, engine, &loads, torque, cancel)?,
    };
    let is_omitted = |(_, wrench): &&(Order, Wrench)| OrderSums::of(wrench) != OrderSums::default();
    let omitted = chosen.left.iter().filter(is_omitted).map(|&(order, _)| order).collect();
    let at_speed = |(order, wrench): (Order, Wrench)| (order, wrench.at_speed(square));
    Ok(Balance {
        orders: chosen.orders,
        omitted,
        wrenches: chosen.wrenches.into_iter().map(|wrench| wrench.at_speed(square)).collect(),
        left: chosen.left.into_iter().map(at_speed).collect(),
        mean: chosen.mean,
        error_bound: chosen.left_out.bounds(square),
        has_torque: torque,
        left_out: chosen.left_out,
        counts: [false, true].map(|torque| count(&loads.list, torque)),
    })
}
