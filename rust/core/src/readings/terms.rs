//! What each part of an engine adds to an order: forward, backward, roll and the bound of its rounding.
//!
//! A balance is the sum of these: both superpose the one list of loads, this reading the loads of each
//! part apart.

use std::sync::Arc;

use super::amplitude::Amplitudes;
use super::balance::{Balance, Request, angular_speed};
use crate::engine::{Engine, Origin};
use crate::load::{Load, LoadList};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::limits;
use crate::numbers::order::{self, Order};

/// The terms of an engine at some orders, of each part with what it adds: cylinders, counterweights,
/// shafts, further loads.
///
/// Moments are about the plane of the request, and the roll torque about the point `aside`, x and y from
/// the axis of the main crank, m.
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
/// use crankpin_core::balance::{Request, Vector};
/// use crankpin_core::terms::terms;
/// use crankpin_core::{Cancel, Order};
///
/// let request = Request { rpm: 6000.0, reference_z: None, torque: false };
/// let orders = Order::all_whole(&[1])?;
/// let parts = terms(&four, &request, [0.0; 2], &orders, &Cancel::new())?;
/// let forces: Vec<f64> = parts.iter().map(|(_, part)| part.planar(Vector::Force, 0).peak()).collect();
/// assert_eq!(forces.len(), 4); // of each cylinder, though together they vanish
/// assert!(forces.iter().all(|force| (force - forces[0]).abs() < 1e-9));
/// # Ok::<(), crankpin_core::Error>(())
/// ```
pub fn terms(
    engine: &Engine,
    request: &Request,
    aside: [f64; 2],
    orders: &[Order],
    cancel: &Cancel,
) -> Result<Vec<(Origin, Balance)>> {
    order::check_list(orders)?;
    let [x, y] = aside;
    for (name, place) in [("x", x), ("y", y)] {
        limits::finite(name, place)?;
    }
    let (cylinders, weights) = (engine.stations().len(), engine.counterweights().len());
    let count = |origin: fn(usize) -> Origin, count: usize| (0..count).map(origin);
    let parts = count(Origin::Cylinder, cylinders)
        .chain(count(Origin::Counterweight, weights))
        .chain(count(Origin::Shaft, engine.shafts().len()))
        .chain(count(Origin::Load, engine.loads().len()));
    let own = |origin| match origin {
        Origin::Cylinder(i) => i,
        Origin::Counterweight(k) => cylinders + k,
        Origin::Shaft(k) => cylinders + weights + k,
        Origin::Load(k) => cylinders + weights + engine.shafts().len() + k,
    };
    let parts: Vec<Origin> = parts.collect();
    let sums = sums_by(engine, request, aside, orders, (parts.len(), &own), cancel)?;
    Ok(parts.into_iter().zip(sums).collect())
}

/// The sums of groups of parts: as many as said, of each part by the index of its group.
pub(super) fn sums_by(
    engine: &Engine,
    request: &Request,
    [x, y]: [f64; 2],
    orders: &[Order],
    (groups, group_of): (usize, &dyn Fn(Origin) -> usize),
    cancel: &Cancel,
) -> Result<Vec<Balance>> {
    let omega = angular_speed(request.rpm)?;
    engine.check_speeds(&[request.rpm])?;
    let sums = Sums::new(engine, request.reference_z, request.torque, orders, cancel)?;
    let mut own: Vec<Vec<Load>> = vec![Vec::new(); groups]; // bounded: by the parts of an engine
    for load in &sums.loads.list {
        own[group_of(load.place.origin)].push(*load);
    }
    own.iter().map(|own| Ok(sums.of(own, omega, cancel)?.moved([x, y, 0.0]))).collect()
}

/// Sums of some of an engine's loads at some orders.
pub(super) struct Sums<'a> {
    pub loads: Arc<LoadList>,
    amplitudes: Amplitudes,
    orders: &'a [Order],
    torque: bool,
}

impl<'a> Sums<'a> {
    /// Those about a plane; with torques, unless none follow from the engine's spectrum.
    pub(super) fn new(
        engine: &Engine,
        reference_z: Option<f64>,
        torque: bool,
        orders: &'a [Order],
        cancel: &Cancel,
    ) -> Result<Self> {
        let torque = torque && engine.spectrum().is_none();
        let loads = LoadList::of(engine, engine.reference(reference_z)?)?;
        let amplitudes = Amplitudes::new(&loads.sources, torque, orders, cancel)?;
        Ok(Self { loads, amplitudes, orders, torque })
    }

    /// The sum of some loads at an angular speed, rad/s.
    pub(super) fn of(&self, own: &[Load], omega: f64, cancel: &Cancel) -> Result<Balance> {
        let Self { loads, amplitudes, orders, torque } = self;
        let wrenches = amplitudes.wrenches(loads, own, *torque, orders, cancel)?;
        let means = amplitudes.means(loads, own);
        let mut sum = Balance::of(loads, own, orders.to_vec(), &wrenches, &means, omega)?;
        sum.has_torque = *torque;
        Ok(sum)
    }
}
