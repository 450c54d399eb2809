//! Sources of another crate: written with public items alone, run through every reading.

use std::f64::consts::TAU;
use std::sync::Arc;

use crankpin_core::balance::balance;
use crankpin_core::bearing_loads::BearingLoadsModel;
use crankpin_core::engine::{ActsOn, PeriodicLoad};
use crankpin_core::exact::vanishing::{ProofQuantity, Verdict, vanishing};
use crankpin_core::quantity::{Part, Quantity};
use crankpin_core::source::{
    ForcePart, Parts, Repeats, Scaling, Series, Source, Tail, TorqueAmplitudes, UpTo,
};
use crankpin_core::sweep::{Statistic, Sweep, SweepAxes};
use crankpin_core::{
    Angle, Cancel, Complex64, Cylinder, Engine, Error, Order, Orders, Request, Result, SpeedRatio,
    Station, balancing, check_source, waveform,
};

const SPRINGS: &str = "valve springs";

/// A torque at orders 1/2 and 5/2, the same at any speed, and lies about it.
#[derive(Debug, Clone, Copy)]
struct ValveSprings {
    tail: f64,
    repeats: Repeats,
    scaling: Scaling,
    series: SpringSeries,
}

/// What the series of springs is like.
#[derive(Debug, Clone, Copy, PartialEq)]
enum SpringSeries {
    Honest,
    /// Without order ½ where order 5/2 is beyond.
    Forgets,
    /// Of twice the torque.
    Doubled,
    /// Never further than order ½.
    Lazy,
    /// The higher order first.
    Descending,
}

impl ValveSprings {
    const HONEST: Self = Self {
        tail: 1.0,
        repeats: Repeats::EveryTwoTurns,
        scaling: Scaling::Independent,
        series: SpringSeries::Honest,
    };

    /// Of 20 N·m on the camshaft at both orders.
    fn orders() -> Vec<Order> {
        [1, 5].map(|halves| Order::from_halves(halves).unwrap()).to_vec()
    }
}

impl Source for ValveSprings {
    fn name(&self) -> &'static str {
        SPRINGS
    }

    fn parts(&self) -> Parts {
        let Self { repeats, scaling, .. } = *self;
        Parts { force: None, roll: true, scaling, repeats }
    }

    fn series(&self, up_to: UpTo, _: &Cancel) -> Result<Series> {
        let rest = |halves: u32| {
            let left = Self::orders().iter().filter(|order| order.halves() > halves).count();
            Tail { force: 0.0, torque: 10.0 * self.tail * left as f64 }
        };
        let highest = match (self.series, up_to) {
            (SpringSeries::Lazy, UpTo::Enough(_)) => 1,
            _ => up_to.halves(rest),
        };
        let mut orders = Self::orders();
        orders.retain(|order| order.halves() <= highest);
        match self.series {
            SpringSeries::Forgets if highest < 5 => orders.clear(),
            SpringSeries::Descending => orders.reverse(),
            _ => {}
        }
        let size = if self.series == SpringSeries::Doubled { 40.0 } else { 20.0 };
        let on_camshaft = vec![size.into(); orders.len()];
        let torque = TorqueAmplitudes::shared(&on_camshaft, 0.0, ActsOn::Both.torque_shares(0.5));
        Ok(Series { orders, torque, rest: rest(highest), ..Series::default() })
    }

    fn torque(&self, orders: &[Order], _: &Cancel) -> Result<TorqueAmplitudes> {
        let size = |order: &Order| if Self::orders().contains(order) { 20.0 } else { 0.0 };
        let on_camshaft: Vec<Complex64> = orders.iter().map(|order| size(order).into()).collect();
        Ok(TorqueAmplitudes::shared(&on_camshaft, 0.0, ActsOn::Both.torque_shares(0.5)))
    }
}

/// A weight on a shaft of half the crank's speed that a belt pulls round, the same at any speed.
#[derive(Debug)]
struct Belt;

impl Source for Belt {
    fn name(&self) -> &'static str {
        "belt"
    }

    fn parts(&self) -> Parts {
        let (force, repeats) = (Some(ForcePart::Turning), Repeats::EveryTwoTurns);
        Parts { force, roll: false, scaling: Scaling::Independent, repeats }
    }

    fn series(&self, _: UpTo, _: &Cancel) -> Result<Series> {
        let (orders, force) = (vec![Order::from_halves(1)?], vec![Complex64::new(300.0, 150.0)]);
        Ok(Series { orders, force, ..Series::default() })
    }
}

/// A force of a train of pulses, whose orders have no end: that of order n is 200·e^{−n/3}, over ω² at 2000 rpm.
#[derive(Debug)]
struct Pulses;

impl Pulses {
    fn size(halves: u32) -> f64 {
        200.0 * (-f64::from(halves) / 6.0).exp() / (2000.0 * TAU / 60.0).powi(2)
    }
}

impl Source for Pulses {
    fn name(&self) -> &'static str {
        "pulses"
    }

    fn parts(&self) -> Parts {
        let force = Some(ForcePart::Along);
        let (scaling, repeats) = (Scaling::SpeedSquared, Repeats::EveryTurn);
        Parts { force, roll: true, scaling, repeats }
    }

    fn series(&self, up_to: UpTo, _: &Cancel) -> Result<Series> {
        let rest = |halves: u32| {
            let force = Self::size(2 * (halves / 2 + 1)) / (1.0 - (-1.0_f64 / 3.0).exp());
            Tail { force, torque: 0.1 * force }
        };
        let highest = up_to.halves(rest);
        let orders = (1..=highest / 2).map(Order::whole).collect::<Result<Vec<_>>>()?;
        let force: Vec<Complex64> =
            orders.iter().map(|order| Self::size(order.halves()).into()).collect();
        let torque: Vec<_> = force.iter().map(|force| 0.1 * Complex64::i() * force).collect();
        let torque = TorqueAmplitudes::shared(&torque, 1e-4, ActsOn::Shaft.torque_shares(1.0));
        Ok(Series { orders, force, torque, rest: rest(highest) })
    }
}

fn load(source: impl Source, on: ActsOn) -> PeriodicLoad {
    PeriodicLoad::of(source, on)
}

fn four() -> Engine {
    let cylinder = Cylinder::new(0.043, 0.145, 0.66, 0.0).unwrap();
    let station = |(tdc, z): (f64, f64)| Station {
        cylinder,
        tdc: Angle::from_degrees(tdc).unwrap(),
        bank: Angle::from_degrees(90.0).unwrap(),
        z,
        rotating_mass: 0.0,
    };
    let places = [(0.0, 0.0), (180.0, 0.1), (180.0, 0.2), (0.0, 0.3)];
    Engine::new("", "", places.map(station).to_vec()).unwrap()
}

fn with_springs() -> Engine {
    four().with_loads(vec![load(ValveSprings::HONEST, ActsOn::Both)]).unwrap()
}

const REQUEST: Request = Request { rpm: 3000.0, reference_z: None, torque: true };

#[test]
fn sources_of_another_crate_are_counted_by_every_reading() {
    check_source(&load(ValveSprings::HONEST, ActsOn::Both), None).unwrap();
    let belt = PeriodicLoad {
        ratio: SpeedRatio::from_halves(1),
        axis: [0.1, 0.2],
        z: -0.1,
        ..load(Belt, ActsOn::Shaft)
    };
    check_source(&belt, None).unwrap();
    check_source(&PeriodicLoad { ratio: SpeedRatio::from_halves(-1), ..belt }, None).unwrap();
    for crank in [0, 1] {
        let sitting = PeriodicLoad { crank: Some(crank), ..load(Pulses, ActsOn::Shaft) };
        check_source(&sitting, None).unwrap();
    }
}

#[test]
fn what_is_measured_is_compared_with_amplitudes_as_they_scale() {
    let springs = load(ValveSprings::HONEST, ActsOn::Both);
    let torque = |theta_deg: f64| {
        let cos = |n: f64| (n * theta_deg.to_radians()).cos();
        10.0 * (cos(0.5) + cos(2.5))
    };
    check_source(&springs, Some(&|_, theta| [0.0, -torque(theta), torque(theta)])).unwrap();
    // They are not those of something else, nor do they grow with speed.
    let text = |load: &PeriodicLoad, factor: &dyn Fn(f64) -> f64| {
        let measured =
            |rpm: f64, theta: f64| [0.0, -torque(theta) * factor(rpm), torque(theta) * factor(rpm)];
        check_source(load, Some(&measured)).unwrap_err().to_string()
    };
    let grows = |rpm: f64| (rpm / 1000.0).powi(2);
    assert!(text(&springs, &grows).contains("at 3000 rpm"), "{}", text(&springs, &grows));
    let lying = ValveSprings { scaling: Scaling::SpeedSquared, ..ValveSprings::HONEST };
    let lying = load(lying, ActsOn::Both);
    assert!(text(&lying, &|_| 1.0).starts_with("measured"), "{}", text(&lying, &|_| 1.0));
}

#[test]
fn sources_that_lie_are_found_out() {
    let text = |source: ValveSprings| {
        check_source(&load(source, ActsOn::Both), None).unwrap_err().to_string()
    };
    for tail in [0.0, 0.6] {
        let found = text(ValveSprings { tail, ..ValveSprings::HONEST });
        assert!(found.starts_with("Source::series"), "{found}");
        assert!(found.contains("orders above"), "{found}");
    }
    let found = text(ValveSprings { repeats: Repeats::EveryTurn, ..ValveSprings::HONEST });
    assert!(found.starts_with("Source::series") && found.contains("half order"), "{found}");
    for (series, words) in [
        (SpringSeries::Forgets, "are not its orders up to"),
        (SpringSeries::Doubled, "plain sums"),
        (SpringSeries::Lazy, "is no rest of"),
        (SpringSeries::Descending, "ascending"),
    ] {
        let found = text(ValveSprings { series, ..ValveSprings::HONEST });
        assert!(found.starts_with("Source::series") && found.contains(words), "{found}");
    }
}

#[test]
fn a_torque_independent_of_speed_is_the_same_at_any() {
    let rpm = vec![1000.0, 3000.0];
    let engines = vec![Arc::new(with_springs())];
    let axes = SweepAxes { rpm, ..SweepAxes::default() };
    let sweep = Sweep::new(
        engines,
        axes,
        &Orders::Given(ValveSprings::orders()),
        None,
        true,
        &Cancel::new(),
    )
    .unwrap();
    let mut peaks = [0.0; 4];
    let mut write = |quantity| {
        sweep.write_peaks(quantity, Statistic::Amplitude, &mut peaks, &Cancel::new()).unwrap();
        peaks
    };
    assert_eq!(write(Quantity::CRANK_TORQUE), [10.0; 4]);
    assert_eq!(write(Quantity::TORQUE.part(Part::Of(SPRINGS))), [10.0; 4]);
    let auto = Orders::Auto { rtol: 1e-6 };
    let found = balance(&with_springs(), &REQUEST, &auto, &Cancel::new()).unwrap();
    assert!(ValveSprings::orders().iter().all(|own| found.orders.contains(own)));
    assert!(found.error_bound.torque < 1e-2);
    let names: Vec<&str> = found.names().iter().map(|name| &**name).collect();
    assert_eq!(names, ["inertia", SPRINGS]);
    assert_eq!(with_springs().loads_counted(), "without gas pressure; loads: valve springs");
}

#[test]
fn proofs_bearings_and_the_roll_torque_see_it() {
    let (engine, cancel) = (with_springs(), Cancel::new());
    let halves = ValveSprings::orders();
    for verdicts in vanishing(&engine, &halves, None, None, &cancel).unwrap().verdicts {
        assert_eq!(verdicts[ProofQuantity::Torque], Verdict::Undecided);
        assert_eq!(verdicts[ProofQuantity::ForceX], Verdict::Vanishes);
    }
    assert!(balancing::roll_torque(&engine, halves[0], None, &cancel).is_err());
    let over_square = balancing::roll_torque(&engine, halves[0], Some(3000.0), &cancel).unwrap();
    assert!((over_square.re * (3000.0 * TAU / 60.0).powi(2) + 10.0).abs() < 1e-12);
    let wave = |orders: Option<&Orders>| match orders {
        None => waveform::exact(&engine, &REQUEST, &[0.0], &cancel).unwrap(),
        Some(orders) => waveform::from_orders(&engine, &REQUEST, &[0.0], orders, &cancel).unwrap(),
    };
    let part = |wave: waveform::Waveform| {
        let own = wave.parts.iter().find(|part| &*part.name == SPRINGS).unwrap();
        own.torque.as_ref().unwrap()[1][0]
    };
    for orders in [None, Some(&Orders::Auto { rtol: 1e-6 })] {
        assert!((part(wave(orders)) - 20.0).abs() < 1e-12);
    }
    // On a crank its bearings carry what turns with it.
    let belt = PeriodicLoad { z: 0.05, ..load(Pulses, ActsOn::Shaft) };
    let pulled = four().with_loads(vec![belt]).unwrap();
    let [alone, with] = [four(), pulled].map(|engine| {
        let model = BearingLoadsModel::new(&engine, 3000.0).unwrap();
        model.loads(&[0.0], &cancel).unwrap().main
    });
    assert!((&with - &alone).iter().map(|one| one.abs()).sum::<f64>() > 100.0);
}

#[test]
fn engines_of_foreign_sources_compare_and_have_no_file() {
    let engine = with_springs();
    assert_eq!(engine.clone(), engine);
    assert_ne!(with_springs(), engine);
    let error = crankpin_core::engine::file::to_toml(&engine).unwrap_err();
    assert!(error.to_string().contains("valve springs"), "{error}");
    let twice = PeriodicLoad { name: "other".into(), ..load(ValveSprings::HONEST, ActsOn::Both) };
    assert!(matches!(four().with_loads(vec![twice]), Err(Error::Value { .. })));
    let turning = PeriodicLoad { turning: true, ..load(Belt, ActsOn::Shaft) };
    assert!(matches!(four().with_loads(vec![turning]), Err(Error::Value { .. })));
}
