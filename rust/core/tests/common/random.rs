//! Random engines.

use crankpin_core::engine::CrankIndex;
use crankpin_core::{Angle, Cylinder, Engine, Shaft, SpeedRatio, Station, Unbalance};
use proptest::prelude::*;
use proptest::sample::select;

/// Moving parts of a usual engine, offset or not.
pub fn cylinders(offset: bool) -> impl Strategy<Value = Cylinder> {
    let rod_inertia = prop_oneof![Just(0.0), -0.3..0.3];
    let parts = (0.02..0.2, 1.8..6.0, 0.1..3.0, -0.5..0.5_f64, rod_inertia);
    parts.prop_map(move |(r, l, m, e, j)| {
        let pin_offset = if offset { r * e } else { 0.0 };
        let cylinder = Cylinder::new(r, r * l, m, pin_offset).unwrap();
        cylinder.with_rod_inertia_excess(j * m * r * r).unwrap()
    })
}

/// Angles that are parts of a turn, and angles that are not.
pub fn angles() -> impl Strategy<Value = Angle> {
    prop_oneof![
        (0_i64..24).prop_map(|k| Angle::from_degree_fraction(15 * k, 1).unwrap()),
        (0_i64..7).prop_map(|k| Angle::from_degree_fraction(360 * k, 7).unwrap()),
        (0.0..360.0).prop_map(|d| Angle::from_degrees(d).unwrap()),
    ]
}

pub fn stations(offset: bool) -> impl Strategy<Value = Station> {
    (cylinders(offset), angles(), angles(), -0.5..0.5, 0.0..2.0).prop_map(
        |(cylinder, tdc, bank, z, rotating_mass)| Station { cylinder, tdc, bank, z, rotating_mass },
    )
}

pub fn engines(offset: bool) -> impl Strategy<Value = Engine> {
    proptest::collection::vec(stations(offset), 1..9)
        .prop_map(|stations| Engine::new("", "", stations).unwrap())
}

/// Vees whose cylinders stand in two banks.
pub fn vees() -> impl Strategy<Value = Engine> {
    let cylinder = cylinders(true);
    let rest =
        proptest::collection::vec((cylinder, angles(), -0.5..0.5, 0.0..2.0, any::<bool>()), 0..7);
    (stations(true), stations(true), rest, 20.0..160.0).prop_map(|(a, b, rest, angle)| {
        let right = Angle::from_degrees(90.0 - 0.5 * angle).unwrap();
        let left = Angle::from_degrees(90.0 + 0.5 * angle).unwrap();
        let mut stations = vec![Station { bank: right, ..a }, Station { bank: left, ..b }];
        stations.extend(rest.into_iter().map(|(cylinder, tdc, z, rotating_mass, on_left)| {
            let bank = if on_left { left } else { right };
            Station { cylinder, tdc, bank, z, rotating_mass }
        }));
        Engine::new("", "", stations).unwrap()
    })
}

fn unbalances(most: usize) -> impl Strategy<Value = Vec<Unbalance>> {
    let one = (0.0..0.05, angles(), -0.5..0.5).prop_map(|(amount, angle, z)| Unbalance {
        amount,
        angle,
        z,
        pin: None,
        crank: CrankIndex::MAIN,
    });
    proptest::collection::vec(one, 0..most)
}

/// Balance shafts of ratio ±½ to ±3 beside the crank.
pub fn shafts() -> impl Strategy<Value = Vec<Shaft>> {
    let ratio = select(vec![1, -1, 2, -2, 3, -3, 4, -4, 6, -6]);
    let one =
        (ratio, [-0.3..0.3, -0.3..0.3], unbalances(3)).prop_map(|(ratio, axis, unbalances)| {
            let ratio = SpeedRatio::from_halves(ratio);
            Shaft { name: String::new(), ratio, axis, unbalances }
        });
    proptest::collection::vec(one, 0..4)
}

/// Engines that carry counterweights, free or at a pin, and balance shafts.
pub fn weighted(engines: impl Strategy<Value = Engine>) -> impl Strategy<Value = Engine> {
    let pins = proptest::collection::vec(proptest::option::of(0_usize..8), 4);
    (engines, unbalances(4), pins, shafts()).prop_map(|(engine, mut weights, pins, shafts)| {
        let cylinders = engine.stations().len();
        for (weight, pin) in weights.iter_mut().zip(pins) {
            weight.pin = pin.map(|pin| pin % cylinders);
        }
        let engine = engine.with_counterweights(weights);
        engine.and_then(|engine| engine.with_shafts(shafts)).unwrap()
    })
}
