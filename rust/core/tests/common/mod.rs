//! Engines no two of whose cylinders are alike, and what a sweep makes of one at a point.

use std::sync::Arc;

use crankpin_core::sweep::Axes;
use crankpin_core::{Angle, Cylinder, Engine, Placement};

/// Crank radius, rod length, reciprocating mass, pin offset, inertia of the rod beyond its two
/// masses; top dead centre and bank, degrees; z; rotating mass.
type Figures = ([f64; 5], [f64; 2], f64, f64);

fn engine(cylinders: &[Figures]) -> Arc<Engine> {
    let angle = |degrees| Angle::from_degrees(degrees).unwrap();
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
    let placements = turned.as_ref().unwrap_or(engine).placements();
    Engine::new("", "", placements.iter().map(change).collect()).unwrap()
}
