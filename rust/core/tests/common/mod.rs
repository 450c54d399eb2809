//! Engines no two of whose cylinders are alike, and what a sweep makes of one at a point.

#![allow(dead_code, reason = "each test crate uses some of these")]

use std::sync::Arc;

use crankpin_core::balance::{Balance, Vector, balance};
use crankpin_core::sweep::Axes;
use crankpin_core::{
    Angle, Cancel, Complex64, Cylinder, Engine, Order, Orders, Placement, Request, Shaft, Unbalance,
};

/// Crank radius, rod length, reciprocating mass, pin offset, inertia of the rod beyond its two
/// masses; top dead centre and bank, degrees; z; rotating mass.
type Figures = ([f64; 5], [f64; 2], f64, f64);

pub fn angle(degrees: f64) -> Angle {
    Angle::from_degrees(degrees).unwrap()
}

fn engine(cylinders: &[Figures]) -> Arc<Engine> {
    let place = |&([r, l, m, e, j], [tdc, bank], z, rotating_mass): &Figures| {
        let cylinder = Cylinder::new(r, l, m, e).unwrap().with_rod_inertia_excess(j).unwrap();
        Placement { cylinder, tdc: angle(tdc), bank: angle(bank), z, rotating_mass }
    };
    Arc::new(Engine::new("", "", cylinders.iter().map(place).collect()).unwrap())
}

/// A vee that leans. From the first, others differ in one figure of their slider-cranks, or in none;
/// some pins carry mass.
pub fn mixed() -> Arc<Engine> {
    engine(&[
        ([0.05, 0.16, 0.5, 0.0, 0.0], [0.0, 60.0], 0.05, 0.3),
        ([0.05, 0.16, 0.7, 0.0, 0.0], [123.4, 132.0], 0.1, 0.0),
        ([0.045, 0.16, 0.6, 0.0, 0.0], [240.0, 60.0], 0.17, 0.2),
        ([0.05, 0.15, 0.4, 0.0, 0.0], [77.7, 132.0], 0.21, 0.0),
        ([0.05, 0.16, 0.45, 0.004, 0.0], [300.0, 60.0], 0.29, 0.4),
        ([0.05, 0.16, 0.5, 0.0, -2e-4], [211.0, 132.0], 0.33, 0.0),
        ([0.05, 0.16, 0.55, 0.0, 3e-4], [30.0, 60.0], 0.4, 0.1),
    ])
}

/// The [`mixed`] engine with counterweights, free and at pins, and balance shafts either way round.
pub fn weighted() -> Arc<Engine> {
    let weight = |amount, degrees, z, pin| Unbalance { amount, angle: angle(degrees), z, pin };
    let shaft = |ratio, axis, unbalances| Shaft { name: String::new(), ratio, axis, unbalances };
    let engine = mixed().with_counterweights(vec![
        weight(0.02, 200.0, -0.02, None),
        weight(0.015, 180.0, 0.11, Some(1)),
        weight(0.01, 165.5, 0.05, Some(0)),
    ]);
    let shafts = vec![
        shaft(1, [0.1, -0.05], vec![weight(0.005, 33.0, 0.1, None)]),
        shaft(
            -1,
            [-0.12, 0.04],
            vec![weight(0.01, 70.0, 0.0, None), weight(0.004, 250.5, 0.4, None)],
        ),
        shaft(2, [0.08, 0.2], vec![weight(0.002, 123.4, 0.2, None)]),
        shaft(-2, [0.0, 0.1], vec![weight(0.003, 0.0, 0.25, None)]),
        shaft(-3, [0.03, -0.07], vec![weight(0.001, 300.0, 0.3, None)]),
    ];
    Arc::new(engine.and_then(|engine| engine.with_shafts(shafts)).unwrap())
}

/// A vee whose cylinders share one slider-crank without offset, and whose pins carry nothing.
pub fn plain() -> Arc<Engine> {
    let alike = [0.04, 0.13, 0.6, 0.0, 0.0];
    engine(&[
        (alike, [10.0, 45.0], 0.0, 0.0),
        (alike, [95.0, 135.0], 0.04, 0.0),
        (alike, [200.0, 135.0], 0.11, 0.0),
    ])
}

/// Cylinders in line, with an offset of their own.
pub fn in_line() -> Arc<Engine> {
    let [a, b] = [[0.04, 0.11, 0.5, 0.003, 1e-4], [0.04, 0.11, 0.3, 0.003, 0.0]];
    engine(&[
        (a, [0.0, 80.0], 0.0, 0.2),
        (b, [120.0, 80.0], 0.1, 0.0),
        (a, [233.3, 80.0], 0.25, 0.1),
    ])
}

/// Indices along engine, bank angle, rod ratio, pin offset and speed, in the order of a result.
pub fn places(shape: [usize; 5]) -> impl Iterator<Item = [usize; 5]> {
    (0..shape.iter().product()).map(move |mut index: usize| {
        let mut place = [0; 5];
        for axis in (0..5).rev() {
            (place[axis], index) = (index % shape[axis], index / shape[axis]);
        }
        place
    })
}

/// The axes at a place alone.
pub fn alone(axes: &Axes, [_, angle, ratio, offset, speed]: [usize; 5]) -> Axes {
    let only = |values: &Option<Vec<f64>>, k: usize| values.as_ref().map(|values| vec![values[k]]);
    Axes {
        bank_angle: axes.bank_angle.as_ref().map(|(angles, hold)| (vec![angles[angle]], *hold)),
        rod_ratio: only(&axes.rod_ratio, ratio),
        pin_offset: only(&axes.pin_offset, offset),
        rpm: vec![axes.rpm[speed]],
    }
}

/// The engine that stands at the first point of these axes.
pub fn there(engine: &Engine, axes: &Axes) -> Engine {
    let turned = axes.bank_angle.as_ref().map(|(angles, hold)| {
        engine.with_bank_angle(Angle::from_degrees(angles[0]).unwrap(), *hold).unwrap()
    });
    let change = |p: &Placement| {
        let c = p.cylinder;
        let rod = axes.rod_ratio.as_ref().map_or(c.rod_length(), |λ| c.crank_radius() / λ[0]);
        let offset = axes.pin_offset.as_ref().map_or(c.pin_offset(), |offsets| offsets[0]);
        let cylinder =
            Cylinder::new(c.crank_radius(), rod, c.reciprocating_mass(), offset).unwrap();
        let cylinder = cylinder.with_rod_inertia_excess(c.rod_inertia_excess()).unwrap();
        Placement { cylinder, ..*p }
    };
    changed(turned.as_ref().unwrap_or(engine), change)
}

/// An engine with its placements changed, its counterweights and shafts as they are.
pub fn changed(engine: &Engine, change: impl Fn(&Placement) -> Placement) -> Engine {
    Engine::new("", "", engine.placements().iter().map(change).collect())
        .and_then(|changed| changed.with_counterweights(engine.counterweights().to_vec()))
        .and_then(|changed| changed.with_shafts(engine.shafts().to_vec()))
        .unwrap()
}

/// Whole orders.
pub fn whole(orders: &[u32]) -> Vec<Order> {
    Order::all_whole(orders).unwrap()
}

/// The balance of an engine by given whole orders.
pub fn by_orders(engine: &Engine, request: &Request, orders: &[u32]) -> Balance {
    balance(engine, request, &Orders::whole(orders).unwrap(), &Cancel::new()).unwrap()
}

/// Phasors along (about) x and y, order by order.
pub fn xy(balance: &Balance, vector: Vector) -> Vec<[Complex64; 2]> {
    (0..balance.orders.len()).map(|k| balance.xy(vector, k)).collect()
}

/// Forward and backward parts, order by order.
pub fn turning(balance: &Balance, vector: Vector) -> Vec<[Complex64; 2]> {
    let planar = |k| balance.planar(vector, k);
    (0..balance.orders.len()).map(|k| [planar(k).forward, planar(k).backward()]).collect()
}
