//! Engines no two of whose cylinders are alike, and what a sweep makes of one at a point.

#![allow(dead_code, reason = "each test crate uses some of these")]

pub mod random;

use std::sync::Arc;

use crankpin_core::balance::{Balance, Vector, balance};
use crankpin_core::engine::CrankIndex;
use crankpin_core::index::ListIndex;
use crankpin_core::quantity::Quantity;
use crankpin_core::sweep::{Statistic, SweepAxes};
use crankpin_core::{
    Angle, Cancel, Complex64, Crank, Cylinder, Engine, Order, Orders, Request, Result, Shaft,
    SpeedRatio, Station, Sweep, Unbalance,
};
use ndarray::ArrayD;

/// Crank radius, rod length, reciprocating mass, pin offset, inertia of the rod beyond its two
/// masses; top dead centre and bank, degrees; z; rotating mass.
type Figures = ([f64; 5], [f64; 2], f64, f64);

pub fn angle(degrees: f64) -> Angle {
    Angle::from_degrees(degrees).unwrap()
}

fn engine(cylinders: &[Figures]) -> Arc<Engine> {
    let place = |&([r, l, m, e, j], [tdc, bank], z, rotating_mass): &Figures| {
        let cylinder = Cylinder::new(r, l, m, e).unwrap().with_rod_inertia_excess(j).unwrap();
        Station { cylinder, tdc: angle(tdc), bank: angle(bank), z, rotating_mass }
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
    let weight = |amount, degrees, z, pin| Unbalance {
        amount,
        angle: angle(degrees),
        z,
        pin,
        crank: CrankIndex::MAIN,
    };
    let shaft = |ratio, axis, unbalances| {
        let ratio = SpeedRatio::whole(ratio);
        Shaft { name: String::new(), ratio, axis, unbalances }
    };
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

/// The [`plain`] engine with cylinders on a second crank, which turns twice as fast the other way.
pub fn geared() -> Arc<Engine> {
    let cranks = vec![Crank::MAIN, Crank { axis: [0.2, 0.1], ratio: SpeedRatio::whole(-2) }];
    Arc::new(plain().with_cranks(cranks, vec![0, 1, 1]).unwrap())
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

/// Indices along engine, bank angle, rod ratio, pin offset, speed and load, in the order of a result.
pub fn places(shape: [usize; 6]) -> impl Iterator<Item = [usize; 6]> {
    (0..shape.iter().product()).map(move |mut index: usize| {
        let mut place = [0; 6];
        for axis in (0..6).rev() {
            (place[axis], index) = (index % shape[axis], index / shape[axis]);
        }
        place
    })
}

/// The axes at a place alone.
pub fn alone(axes: &SweepAxes, [_, angle, ratio, offset, speed, _]: [usize; 6]) -> SweepAxes {
    let only = |values: &Option<Vec<f64>>, k: usize| values.as_ref().map(|values| vec![values[k]]);
    SweepAxes {
        bank_angle: axes.bank_angle.as_ref().map(|(angles, hold)| (vec![angles[angle]], *hold)),
        rod_ratio: only(&axes.rod_ratio, ratio),
        pin_offset: only(&axes.pin_offset, offset),
        rpm: vec![axes.rpm[speed]],
        map: None,
    }
}

/// The engine that stands at the first point of these axes.
pub fn there(engine: &Engine, axes: &SweepAxes) -> Engine {
    let turned = axes.bank_angle.as_ref().map(|(angles, hold)| {
        engine.with_bank_angle(Angle::from_degrees(angles[0]).unwrap(), *hold).unwrap()
    });
    let change = |p: &Station| {
        let c = p.cylinder;
        let rod = axes.rod_ratio.as_ref().map_or(c.rod_length(), |λ| c.crank_radius() / λ[0]);
        let offset = axes.pin_offset.as_ref().map_or(c.pin_offset(), |offsets| offsets[0]);
        let cylinder =
            Cylinder::new(c.crank_radius(), rod, c.reciprocating_mass(), offset).unwrap();
        let cylinder = cylinder.with_rod_inertia_excess(c.rod_inertia_excess()).unwrap();
        Station { cylinder, ..*p }
    };
    changed(turned.as_ref().unwrap_or(engine), change)
}

/// An engine with its stations changed, its cranks, counterweights and shafts as they are.
pub fn changed(engine: &Engine, change: impl Fn(&Station) -> Station) -> Engine {
    let stations = engine.stations();
    let crank_of = (0..stations.len()).map(|i| engine.crank_of(i).position()).collect();
    Engine::new("", "", stations.iter().map(change).collect())
        .and_then(|changed| changed.with_cranks(engine.cranks().to_vec(), crank_of))
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

/// Force x, y, moment x, y, roll and crank torque over ω²; and the sizes of their terms.
pub fn kinematics(engine: &Engine, reference: f64, θ: f64) -> ([f64; 6], [f64; 6]) {
    let (mut sums, mut sizes) = ([0.0; 6], [0.0; 6]);
    for (i, p) in engine.stations().iter().enumerate() {
        let (c, bank, pin) = (p.cylinder, p.bank.cis(1), engine.pin(i).degrees().to_radians());
        let (r, lever) = (c.crank_radius(), p.z - reference);
        let (sin, cos) = (θ - p.tdc.degrees().to_radians()).sin_cos();
        // x = cos θ + h with h² = (l/r)² − u², u = sin θ − e/r, in radii.
        let (rod, offset) = (c.rod_length() / r, c.pin_offset() / r);
        let u = sin - offset;
        let h = (rod * rod - u * u).sqrt();
        let velocity = -sin - u * cos / h;
        let acceleration = -cos - (cos * cos - u * sin) / h - (u * cos).powi(2) / h.powi(3);
        let along = -c.mass_radius() * acceleration;
        let turning = Complex64::cis(pin + θ) * (p.rotating_mass * r);
        let force = bank * along + turning;
        // A force across the bore at the piston, and one along it at the crank: r × F.
        let weight = c.mass_radius() * r * acceleration;
        // sin φ = u/(l/r): how the rod swings.
        let swing = cos / h;
        let bend = (u * swing * swing - sin) / h;
        let inertia = c.rod_inertia_excess() * bend;
        let terms = [
            force.re,
            force.im,
            -lever * force.im,
            lever * force.re,
            weight * (velocity + offset) + inertia * (1.0 + swing),
            -weight * velocity - inertia * swing,
        ];
        let moved = c.mass_radius() * 3.0 + turning.norm();
        let torque = 5.0 * moved * r + 3.0 * c.rod_inertia_excess().abs();
        let levered = moved * (p.z.abs() + reference.abs());
        let size = [moved, moved, levered, levered, torque, torque];
        for k in 0..6 {
            sums[k] += terms[k];
            sizes[k] += size[k];
        }
    }
    let mut add = |force: Complex64, z: f64, [x, y]: [f64; 2]| {
        let (lever, size) = (z - reference, force.norm());
        let roll = x * force.im - y * force.re;
        let terms = [force.re, force.im, -lever * force.im, lever * force.re, roll, 0.0];
        let levered = size * (z.abs() + reference.abs());
        let terms_of = [size, size, levered, levered, size * (x.abs() + y.abs()), 0.0];
        for k in 0..6 {
            sums[k] += terms[k];
            // Up to three turns of the crank are nine of a shaft.
            sizes[k] += 3.0 * terms_of[k];
        }
    };
    for weight in engine.counterweights() {
        let pin = weight.pin.map_or(Angle::ZERO, |i| engine.pin(i));
        let turned = pin.degrees().to_radians() + weight.angle.degrees().to_radians() + θ;
        add(Complex64::cis(turned) * weight.amount, weight.z, [0.0; 2]);
    }
    for shaft in engine.shafts() {
        let ratio = shaft.ratio.number();
        for weight in &shaft.unbalances {
            let turned = weight.angle.degrees().to_radians() + ratio * θ;
            let force = Complex64::cis(turned) * (ratio * ratio * weight.amount);
            add(force, weight.z, shaft.axis);
        }
    }
    (sums, sizes)
}

/// The largest m·r of a cylinder or ρ²·U of an unbalance, times the longest lever; of torque times the
/// crank radius or the distance of the shaft, or what rod inertia makes of order 1.
pub fn scales(engine: &Engine, reference: f64) -> [f64; 3] {
    let (mut force, mut lever, mut torque) = (0.0_f64, 0.0_f64, 0.0_f64);
    let radius = engine.largest_crank_radius();
    let mut add = |amount: f64, arm: f64, z: f64| {
        force = force.max(amount);
        torque = torque.max(amount * arm);
        lever = lever.max((z - reference).abs());
    };
    for p in engine.stations() {
        let (c, r) = (p.cylinder, p.cylinder.crank_radius());
        add(c.mass_radius(), r, p.z);
        add(p.rotating_mass * r, radius, p.z);
    }
    for weight in engine.counterweights() {
        add(weight.amount, radius, weight.z);
    }
    for shaft in engine.shafts() {
        let [x, y] = shaft.axis;
        for weight in &shaft.unbalances {
            add(weight.amount * shaft.ratio.number().powi(2), radius.max(x.hypot(y)), weight.z);
        }
    }
    for p in engine.stations() {
        torque = torque.max(p.cylinder.rod_inertia_excess().abs() * p.cylinder.rod_ratio());
    }
    [force, force * lever, torque]
}

/// Results of a sweep in arrays of their own.
pub trait InArrays {
    fn phasors(
        &self,
        quantity: Quantity,
        figure: Statistic,
        cancel: &Cancel,
    ) -> Result<ArrayD<Complex64>>;
    fn peaks(&self, quantity: Quantity, figure: Statistic, cancel: &Cancel) -> Result<ArrayD<f64>>;
}

impl InArrays for Sweep {
    fn phasors(
        &self,
        quantity: Quantity,
        figure: Statistic,
        cancel: &Cancel,
    ) -> Result<ArrayD<Complex64>> {
        let write = |out: &mut [Complex64]| self.write_phasors(quantity, figure, out, cancel);
        in_array(self, (quantity, figure), write)
    }

    fn peaks(&self, quantity: Quantity, figure: Statistic, cancel: &Cancel) -> Result<ArrayD<f64>> {
        let write = |out: &mut [f64]| self.write_peaks(quantity, figure, out, cancel);
        in_array(self, (quantity, figure), write)
    }
}

fn in_array<T: Clone + Default>(
    sweep: &Sweep,
    (quantity, figure): (Quantity, Statistic),
    write: impl FnOnce(&mut [T]) -> Result<()>,
) -> Result<ArrayD<T>> {
    sweep.check_size(quantity, figure, size_of::<T>())?;
    let mut values = ArrayD::default(sweep.result_shape(quantity, figure));
    write(values.as_slice_mut().unwrap())?;
    Ok(values)
}
