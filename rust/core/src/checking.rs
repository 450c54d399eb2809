//! Runs a source through every reading, against plain sums of its own amplitudes.
//!
//! Nothing here asks how loads are superposed: force, moment and torques of each order are written out, at each
//! speed and turned bank, and compared with what readings of engines with the load, and without it, differ by.

use std::f64::consts::TAU;
use std::fmt::Display;
use std::sync::Arc;

use crate::Complex64;
use crate::balancing::roll_torque;
use crate::engine::{ActsOn, Details, Engine, Gas, Hold, PeriodicLoad, Station, file};
use crate::mechanism::cylinder::Cylinder;
use crate::mounts::{Mount, MountFigures, Powertrain, RigidBody};
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::error::{Error, Result};
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::pressure::{Cycle, Given};
use crate::readings::balance::{Balance, Orders, Request, Vector, balance};
use crate::readings::bearing_loads::{BearingLoadsModel, CutPart};
use crate::readings::exact::vanishing::{Vanishing, Verdict, vanishing};
use crate::readings::explain::finding::Finding;
use crate::readings::explain::{Subject, explain};
use crate::readings::mounted::Response;
use crate::readings::quantity::{Kind, Part, Quantity};
use crate::readings::sweep::{Statistic, Sweep, SweepAxes};
use crate::readings::terms::terms;
use crate::readings::tolerances::{Distribution, FIGURES, Tolerances};
use crate::readings::waveform;
use crate::source::{
    ForcePart, Repeats, Scaling, Series, Source, Tail, TorqueAmplitudes, UpTo, series,
};

/// Force of a load along its direction, N, and its torques on the block and on the main crank, N·m, at a crank
/// speed, rpm, and a crank angle from its phase, degrees: measured, or known in another way.
pub type Measured<'a> = &'a dyn Fn(f64, f64) -> [f64; 3];

/// Highest order that is summed.
const HIGHEST_SUMMED: u32 = 96;
/// Part of the sizes of terms that a reading may differ by: rounding of a hundred orders, and of angles times them.
const READING_ROUNDING: f64 = 1e-10;
/// Speeds at which readings are compared, rpm.
const SPEEDS: [f64; 2] = [1000.0, 3000.0];
/// Tolerance of default orders.
const DEFAULT_RTOL: f64 = 1e-6;

/// Checks that a source says of itself what holds, and that every reading of engines that have its load counts
/// it, under its name: balances about any point, default orders and their bounds, waveforms, sweeps, terms,
/// proofs, bearings, mounts, tolerances, explanations. The error names the reading that disagrees.
///
/// The load is tried where it is, and at other places of its crank or shaft. With what is measured the
/// amplitudes and their change with speed are compared as well.
pub fn check_source(load: &PeriodicLoad, measured: Option<Measured>) -> Result<()> {
    let Some(source) = &load.source else {
        return Err(Error::value("load", format!("{:?}", load.name), "give a load of a source"));
    };
    let amplitudes = StatedAmplitudes::new(&**source)?;
    if let Some(measured) = measured {
        amplitudes.check_measured(&**source, measured)?;
    }
    let phase_deg = Angle::from_degrees(400.0)?;
    let direction_deg = Angle::from_degrees(30.0)?;
    let other = PeriodicLoad { z: 0.17, phase_deg, direction_deg, ..load.clone() };
    let with_bank = PeriodicLoad { cylinder: Some(1), ..other.clone() };
    for load in [load.clone(), with_bank].into_iter().chain(
        [ActsOn::Shaft, ActsOn::Block, ActsOn::Both].map(|on| PeriodicLoad { on, ..other.clone() }),
    ) {
        for fired in [false, true] {
            let case = Case::new(&load, &amplitudes, fired)?;
            case.check_balances()?;
            case.check_default_orders()?;
            case.check_waveforms()?;
            case.check_sweeps()?;
            case.check_proofs()?;
            case.check_bearings()?;
            case.check_mounts()?;
            case.check_words()?;
            if !fired {
                case.check_tolerances()?;
            }
        }
    }
    Ok(())
}

/// Rejects a figure of a reading that is not the plain one.
fn same(
    reading: impl Display,
    found: impl Into<Complex64>,
    expected: impl Into<Complex64>,
    slack: f64,
) -> Result<()> {
    let (found, expected) = (found.into(), expected.into());
    if (found - expected).norm() <= slack {
        return Ok(());
    }
    let hint = format!("plain sums of the amplitudes of its source make {expected:.9e}");
    Err(rejected(reading, format!("{found:.9e}"), hint))
}

/// [`same`], of all of [`NAMES`] at some order or crank angle.
fn same_six<T: Into<Complex64>>(
    reading: &str,
    at: impl Display,
    [found, expected]: [[T; 6]; 2],
    slack: f64,
) -> Result<()> {
    let pairs = found.into_iter().zip(expected);
    let mut named = NAMES.iter().zip(pairs);
    named.try_for_each(|(what, (found, expected))| {
        same(format_args!("{reading}: {what} {at}"), found, expected, slack)
    })
}

/// The error of a reading.
fn rejected(reading: impl Display, found: impl Display, hint: impl Into<String>) -> Error {
    Error::value(reading.to_string(), found, hint)
}

/// Rejects what a source says of itself.
fn wrong(of: &str, found: impl Display, hint: &str) -> Error {
    rejected(format_args!("Source::{of}"), found, hint)
}

/// What a source says, by order.
struct StatedAmplitudes {
    /// Up to [`HIGHEST_SUMMED`].
    orders: Vec<Order>,
    /// Of the force, and of the torques on the block and on the main crank.
    values: Vec<[Complex64; 3]>,
    mean: [f64; 2],
    /// Bounds of what orders above those add to force and torque.
    tail: [f64; 2],
}

impl StatedAmplitudes {
    /// Checks what a source says of its orders and of its tail.
    fn new(source: &dyn Source) -> Result<Self> {
        let (cancel, parts) = (Cancel::new(), source.parts());
        let series = |up_to: UpTo<'_>| series(source, up_to, &cancel);
        let longest = source.series(UpTo::Halves(2 * HIGHEST_SUMMED), &cancel)?;
        if !longest.orders.is_sorted_by(|before, after| before < after) {
            let orders = format!("{:?}", longest.orders);
            return Err(wrong("series", orders, "give orders once, ascending"));
        }
        let Series { force, torque: TorqueAmplitudes { harmonics, .. }, .. } = &longest;
        for amplitudes in [force, &harmonics.roll, &harmonics.crank] {
            if ![0, longest.orders.len()].contains(&amplitudes.len()) {
                let hint = "give one amplitude for each order, of force and torques";
                return Err(wrong("series", amplitudes.len(), hint));
            }
        }
        let Series { mut orders, rest, .. } = series(UpTo::Halves(2 * HIGHEST_SUMMED))?;
        orders.retain(|order| order.halves() <= 2 * HIGHEST_SUMMED);
        let has_halves =
            parts.repeats != Repeats::EveryTurn || parts.force == Some(ForcePart::Turning);
        let half = orders.iter().find(|order| order.as_whole().is_none());
        if let Some(half) = half.filter(|_| !has_halves) {
            let hint = "has a half order, and says that it repeats in every turn";
            return Err(wrong("series", half, hint));
        }
        let (values, mean) = Self::at(source, &orders)?;
        let all: Vec<Order> = (1..=4 * 16).map(Order::from_halves).collect::<Result<_>>()?;
        let largest = values.iter().flatten().map(|value| value.norm()).fold(0.0, f64::max);
        for (order, of_order) in all.iter().zip(Self::at(source, &all)?.0) {
            let own = orders.binary_search(order).map_or([Complex64::ZERO; 3], |k| values[k]);
            for (found, expected) in of_order.into_iter().zip(own) {
                let reading = format_args!("Source::force or torque at order {order}");
                same(reading, found, expected, READING_ROUNDING * largest)?;
            }
        }
        let checked = Self { orders, values, mean, tail: [rest.force, rest.torque] };
        for halves in [0, 1, 2, 3, 4, 5, 8, 12, 24, 48] {
            checked.check_rest(series(UpTo::Halves(halves))?, halves)?;
        }
        // As much as matters for some tolerances.
        let Tail { force, torque } = series(UpTo::Halves(0))?.rest;
        for part in [0.3, 1e-2, 1e-4] {
            let is_within = |rest: f64, all: f64| rest <= part * all;
            let is_enough =
                |rest: Tail| is_within(rest.force, force) && is_within(rest.torque, torque);
            let some = series(UpTo::Enough(&is_enough))?;
            let halves = some.orders.last().map_or(0, |last| last.halves());
            if !is_enough(some.rest) && halves < 2 * HIGHEST_SUMMED {
                let hint = format!("is no rest of {part:?} of all, which was enough");
                return Err(wrong("series", format!("{:?}", some.rest), &hint));
            }
            checked.check_rest(some, halves)?;
        }
        Ok(checked)
    }

    /// Amplitudes at some orders, and mean torques.
    fn at(source: &dyn Source, orders: &[Order]) -> Result<(Vec<[Complex64; 3]>, [f64; 2])> {
        let (cancel, parts) = (Cancel::new(), source.parts());
        let forces = match parts.force {
            Some(_) => source.force(orders, &cancel)?,
            None => vec![Complex64::ZERO; orders.len()], // bounded: by HIGHEST_SUMMED
        };
        if !parts.roll {
            let alone = |force| [force, Complex64::ZERO, Complex64::ZERO];
            return Ok((forces.into_iter().map(alone).collect(), [0.0; 2]));
        }
        let torque = source.torque(orders, &cancel)?;
        let torques = torque.harmonics.roll.iter().zip(&torque.harmonics.crank);
        if [forces.len(), torques.len()] != [orders.len(); 2] {
            let hint = "give one amplitude for each order, of force and torque";
            return Err(wrong("force", forces.len(), hint));
        }
        let all = forces.into_iter().zip(torques);
        let all = all.map(|(force, (roll, crank))| [force, *roll, *crank]);
        Ok((all.collect(), torque.mean))
    }

    /// Checks that a series up to a number of halves has its orders and amplitudes, and that the rest is bounded.
    fn check_rest(&self, series: Series, halves: u32) -> Result<()> {
        let Series { orders, force, torque: TorqueAmplitudes { harmonics, .. }, rest } = series;
        let largest = self.values.iter().flatten().map(|value| value.norm()).fold(0.0, f64::max);
        for (k, amplitudes) in [force, harmonics.roll, harmonics.crank].iter().enumerate() {
            for (found, expected) in amplitudes.iter().zip(&self.values) {
                same("Source::series", *found, expected[k], READING_ROUNDING * largest)?;
            }
        }
        let expected = self.orders.iter().filter(|order| order.halves() <= halves);
        if halves <= 2 * HIGHEST_SUMMED && !orders.iter().eq(expected) {
            let hint = format!("are not its orders up to {}", 0.5 * f64::from(halves));
            return Err(wrong("series", format!("{orders:?}"), &hint));
        }
        for theta in (0..1440).map(|k| 0.5 * f64::from(k)) {
            let [force, roll, crank] = self.over_angle(theta, halves);
            let largest = [force.abs(), roll.abs().max(crank.abs())];
            for (largest, bound) in largest.into_iter().zip([rest.force, rest.torque]) {
                if largest > bound * (1.0 + READING_ROUNDING) + f64::MIN_POSITIVE {
                    let hint = format!("orders above {} make {largest:?}", 0.5 * f64::from(halves));
                    return Err(wrong("series", bound, &hint));
                }
            }
        }
        Ok(())
    }

    /// Sum of the orders above a number of halves at a crank angle from the phase, degrees.
    fn over_angle(&self, theta_deg: f64, halves: u32) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (order, values) in
            self.orders.iter().zip(&self.values).filter(|(order, _)| order.halves() > halves)
        {
            let unit = turned_by(*order, theta_deg);
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += (value * unit).re);
        }
        sum
    }

    fn check_measured(&self, source: &dyn Source, measured: Measured) -> Result<()> {
        for rpm in SPEEDS {
            let factor = factor(source.parts().scaling, rpm);
            let thetas = || (0..96).map(|k| 7.5 * f64::from(k));
            let all: Vec<[f64; 3]> = thetas().map(|theta| measured(rpm, theta)).collect();
            for ((theta, measured), k) in
                thetas().zip(&all).flat_map(|of| [(of, 0), (of, 1), (of, 2)])
            {
                let mean = [0.0, self.mean[0], self.mean[1]][k];
                let own = factor * (self.over_angle(theta, 0)[k] + mean);
                let largest = all.iter().fold(0.0, |most: f64, of| most.max(of[k].abs()));
                let slack = 1e-9 * largest + factor * self.tail[k.min(1)];
                if (own - measured[k]).abs() > slack {
                    let what = ["force", "torque on the block", "torque on the crank"][k];
                    let hint = format!(
                        "its orders make {own:?} of {what} at {rpm} rpm and {theta}°, as they scale"
                    );
                    return Err(Error::figure("measured", measured[k], hint));
                }
            }
        }
        Ok(())
    }
}

/// What an order turns by at a crank angle, degrees.
fn turned_by(order: Order, theta_deg: f64) -> Complex64 {
    Complex64::cis(order.number() * theta_deg / 360.0 * TAU)
}

/// What amplitudes are multiplied by at a speed.
fn factor(scaling: Scaling, rpm: f64) -> f64 {
    match scaling {
        Scaling::SpeedSquared => (rpm * TAU / 60.0).powi(2),
        Scaling::Independent => 1.0,
        Scaling::Row([below, at, above]) => {
            let end = if rpm < at { below } else { above };
            if rpm == at { 1.0 } else { ((rpm - end) / (at - end)).max(0.0) }
        }
    }
}

/// A load at a place of an engine.
struct Case<'a> {
    load: &'a PeriodicLoad,
    amplitudes: &'a StatedAmplitudes,
    scaling: Scaling,
    force: Option<ForcePart>,
    bare: Arc<Engine>,
    with: Arc<Engine>,
    /// Rounding of the readings of the engine without it, over ω², and at any speed.
    rounding: [f64; 2],
    cancel: Cancel,
}

/// Force along x and y, moment about them, torque on the block and on the crank.
type Six = [Complex64; 6];

impl<'a> Case<'a> {
    fn new(load: &'a PeriodicLoad, amplitudes: &'a StatedAmplitudes, fired: bool) -> Result<Self> {
        let [radius, mass] = [0.045, 0.5];
        let cylinder = Cylinder::new(radius, 0.15, mass, 0.002)?;
        let station = |[tdc, bank, z]: [f64; 3]| -> Result<Station> {
            let [tdc, bank] = [Angle::from_degrees(tdc)?, Angle::from_degrees(bank)?];
            Ok(Station { cylinder, tdc, bank, z, rotating_mass: 0.3 })
        };
        let places = [station([0.0, 120.0, 0.0])?, station([200.0, 60.0, 0.1])?];
        // On the cranks that the load may sit on.
        let cranks = (0..=load.crank.unwrap_or(0)).map(|k| crate::Crank {
            axis: [0.2 * k as f64, 0.0],
            ratio: SpeedRatio::whole(if k == 0 { 1 } else { -1 }),
        });
        let mut bare = Engine::new("", "", places.to_vec())?;
        let cranks: Vec<crate::Crank> = cranks.collect();
        let last = cranks.len() - 1;
        if last > 0 {
            bare = bare.with_cranks(cranks, vec![0, last])?;
        }
        if fired {
            let details = vec![Details { bore: Some(0.08), ..Details::default() }; 2];
            bare = bare.with_details(details)?.with_gas(Self::gas()?)?;
        }
        let with = bare.with_loads(vec![load.clone()])?;
        let parts = load.source.as_ref().map(|source| source.parts());
        let (scaling, force) =
            parts.map_or_else(Default::default, |parts| (parts.scaling, parts.force));
        let rounding = [4.0 * mass * radius, if fired { 1e3 } else { 0.0 }];
        let (bare, with, cancel) = (Arc::new(bare), Arc::new(with), Cancel::new());
        Ok(Self { load, amplitudes, scaling, force, bare, with, rounding, cancel })
    }

    /// A pressure with a single hump, in both cylinders.
    fn gas() -> Result<Gas> {
        let theta_deg: Vec<f64> = (0..144).map(|k| 5.0 * f64::from(k)).collect();
        let pressure = |theta: &f64| 1e5 + 2e6 * (-((theta - 60.0) / 25.0).powi(2)).exp();
        let pressure = theta_deg.iter().map(pressure).collect();
        let name = String::new();
        let cycle = Cycle::new(Given { name, strokes: 4, theta_deg, pressure, degree: None })?;
        let (cycles, cycle_of) = (vec![Arc::new(cycle)], vec![Some(0); 2]);
        let (crank_ends, later) = (Vec::new(), vec![false; 2]);
        Ok(Gas { cycles, cycle_of, crank_ends, crankcase: 1e5, later })
    }

    fn factor(&self, rpm: f64) -> f64 {
        factor(self.scaling, rpm)
    }

    /// Force on the shaft or block, along x and y, of the k-th order at a speed, turned as its bank is: its
    /// direction and phase, degrees.
    fn on_shaft(&self, k: usize, rpm: f64, [direction, phase]: [f64; 2]) -> [Complex64; 2] {
        let (order, [force, ..]) = (self.amplitudes.orders[k], self.amplitudes.values[k]);
        let lagged = self.lagged(k, force, rpm, phase);
        let at = Complex64::cis((self.load.direction_deg.degrees() + direction) / 360.0 * TAU);
        let ratio = self.load.shaft(&self.bare).ratio.number();
        match self.force {
            None => [Complex64::ZERO; 2],
            Some(ForcePart::Along) => [lagged * at.re, lagged * at.im],
            Some(ForcePart::Turning) if order.number() != ratio.abs() => [Complex64::ZERO; 2],
            Some(ForcePart::Turning) => {
                let sense = ratio.signum();
                let x = lagged * Complex64::new(at.re, sense * at.im);
                [x, x * Complex64::new(0.0, -sense)]
            }
        }
    }

    /// An amplitude of the k-th order at a speed, as seen at θ = 0.
    fn lagged(&self, k: usize, amplitude: Complex64, rpm: f64, phase: f64) -> Complex64 {
        let phase = (self.load.phase_deg.degrees() + phase) / 360.0 * TAU;
        amplitude * self.factor(rpm) * Complex64::cis(-self.amplitudes.orders[k].number() * phase)
    }

    /// What the k-th order makes about a point.
    fn six(&self, k: usize, rpm: f64, point: [f64; 3], turned: [f64; 2]) -> Six {
        let [_, roll, crank] =
            self.amplitudes.values[k].map(|one| self.lagged(k, one, rpm, turned[1]));
        let on_shaft = self.on_shaft(k, rpm, turned);
        let [x, y] = if self.load.on == ActsOn::Both { [Complex64::ZERO; 2] } else { on_shaft };
        let [at_x, at_y] = self.load.shaft(&self.bare).axis;
        let axis = Complex64::new(at_x, at_y) * Complex64::cis(turned[0] / 360.0 * TAU);
        let arm = [axis.re - point[0], axis.im - point[1], self.load.z - point[2]];
        [x, y, -y * arm[2], x * arm[2], roll + y * arm[0] - x * arm[1], crank]
    }

    /// The sum of some orders at a crank angle.
    fn sum(
        &self,
        rpm: f64,
        theta_deg: f64,
        point: [f64; 3],
        is_counted: impl Fn(Order) -> bool,
    ) -> [f64; 6] {
        let mut sum = [0.0; 6];
        for (k, &order) in
            self.amplitudes.orders.iter().enumerate().filter(|(_, order)| is_counted(**order))
        {
            let unit = turned_by(order, theta_deg);
            let six = self.six(k, rpm, point, [0.0; 2]);
            sum.iter_mut().zip(six).for_each(|(sum, one)| *sum += (one * unit).re);
        }
        sum
    }

    /// What rounding may change, of its own part, or of readings that have the engine's loads as well.
    fn slack(&self, rpm: f64, of_engine: bool) -> f64 {
        let [force, torque] = self.largest(rpm);
        let [over_square, any] = self.rounding;
        let omega = rpm * TAU / 60.0;
        let others = if of_engine { over_square * omega * omega + any } else { 0.0 };
        READING_ROUNDING * (force + torque + others) + 1e-15
    }

    /// Sums of sizes of force and torque, with their arms.
    fn largest(&self, rpm: f64) -> [f64; 2] {
        let sums =
            self.amplitudes.values.iter().fold([0.0; 2], |[force, torque], [f, roll, crank]| {
                [force + f.norm(), torque + roll.norm() + crank.norm()]
            });
        let mean: f64 = self.amplitudes.mean.iter().map(|mean| mean.abs()).sum();
        [sums[0] * self.factor(rpm), (sums[1] + mean) * self.factor(rpm)]
    }

    fn request(rpm: f64, point: [f64; 3]) -> Request {
        Request { rpm, reference_z: Some(point[2]), torque: true }
    }

    /// Orders that are compared: those of the load and two that engines have, up to 24.
    fn orders(&self) -> Result<Vec<Order>> {
        let mut orders = Order::all_whole(&[1, 2, 7])?;
        orders.extend(self.amplitudes.orders.iter().filter(|order| order.halves() <= 48));
        orders.sort_unstable();
        orders.dedup();
        Ok(orders)
    }

    /// Index of an order among those of the load.
    fn place(&self, order: Order) -> Option<usize> {
        self.amplitudes.orders.binary_search(&order).ok()
    }

    /// What an order makes, none where the load does not have it.
    fn plain(&self, order: Order, rpm: f64, point: [f64; 3], turned: [f64; 2]) -> Six {
        self.place(order).map_or([Complex64::ZERO; 6], |k| self.six(k, rpm, point, turned))
    }

    fn compare(
        &self,
        reading: &str,
        found: Six,
        order: Order,
        rpm: f64,
        point: [f64; 3],
    ) -> Result<()> {
        let expected = self.plain(order, rpm, point, [0.0; 2]);
        let at = format_args!("of order {order}");
        same_six(reading, at, [found, expected], self.slack(rpm, false))
    }

    fn check_balances(&self) -> Result<()> {
        let (orders, name) = (self.orders()?, &*self.load.name);
        for (rpm, point) in SPEEDS.into_iter().zip([[0.0, 0.0, 0.05], [0.1, -0.2, 0.3]]) {
            let request = Self::request(rpm, point);
            let found =
                balance(&self.with, &request, &Orders::Given(orders.clone()), &self.cancel)?;
            let found = found.moved([point[0], point[1], 0.0]);
            if !found.names().iter().any(|own| **own == *name) {
                let names = format!("{:?}", found.names());
                return Err(rejected("names of a balance", names, "lack its name"));
            }
            let own = found.of_part(Part::Of(name));
            for (k, &order) in orders.iter().enumerate() {
                self.compare("part of a balance", six_of(&own, k), order, rpm, point)?;
                if let Some(at) = self.place(order) {
                    let about = self.six(at, rpm, [0.0, 0.0, point[2]], [0.0; 2])[4];
                    let rolls = [Some(rpm), None]
                        .map(|rpm| roll_torque(&self.with, order, rpm, &self.cancel));
                    let bare = roll_torque(&self.bare, order, Some(rpm), &self.cancel)?;
                    let square = (rpm * TAU / 60.0).powi(2);
                    let [at_speed, at_none] = rolls;
                    same("roll_torque", (at_speed? - bare) * square, about, self.slack(rpm, true))?;
                    let needs_speed = self.scaling != Scaling::SpeedSquared && about.norm() > 0.0;
                    if at_none.is_ok() && needs_speed {
                        let hint = "needs a speed, and asked for none";
                        return Err(rejected("roll_torque", "a figure", hint));
                    }
                }
            }
            let mean = self.amplitudes.mean.map(|mean| mean * self.factor(rpm));
            for (found, expected) in found.mean(Part::Of(name)).into_iter().zip(mean) {
                same("mean torque of a balance", found, expected, self.slack(rpm, false))?;
            }
            // It is the last of all parts.
            let parts = terms(&self.with, &request, [point[0], point[1]], &orders, &self.cancel)?;
            if let Some((_, part)) = parts.last() {
                for (k, &order) in orders.iter().enumerate() {
                    self.compare("terms", six_of(part, k), order, rpm, point)?;
                }
            }
        }
        Ok(())
    }

    fn check_default_orders(&self) -> Result<()> {
        let point = [0.0, 0.0, 0.05];
        for rpm in SPEEDS {
            let request = Self::request(rpm, point);
            let found =
                balance(&self.with, &request, &Orders::Auto { rtol: DEFAULT_RTOL }, &self.cancel)?;
            let sweep = Sweep::new(
                vec![Arc::clone(&self.with)],
                Self::axes(None, vec![rpm]),
                &Orders::Auto { rtol: DEFAULT_RTOL },
                Some(point[2]),
                true,
                &self.cancel,
            )?;
            for (reading, orders, bound) in [
                ("default orders", &found.orders[..], found.error_bound),
                ("default orders of a sweep", sweep.orders(), sweep.error_bound()),
            ] {
                for theta in (0..96).map(|k| 7.5 * f64::from(k)) {
                    let left = self.sum(rpm, theta, point, |order| !orders.contains(&order));
                    let [x, y, about_x, about_y, roll, crank] = left;
                    let torque = roll.abs().max(crank.abs());
                    for (what, left, bound) in [
                        ("force", x.hypot(y), bound.force),
                        ("moment", about_x.hypot(about_y), bound.moment),
                        ("torque", torque, bound.torque),
                    ] {
                        if left > bound + self.slack(rpm, false) {
                            let hint = format!("its orders that are left out make {left:?}");
                            let reading = format!("{reading}: bound of {what}");
                            return Err(Error::figure(reading, bound, hint));
                        }
                    }
                }
            }
        }
        Ok(())
    }

    fn check_waveforms(&self) -> Result<()> {
        let thetas: Vec<f64> = (0..48).map(|k| 15.0 * f64::from(k) + 1.0).collect();
        let (rpm, point) = (SPEEDS[1], [0.0, 0.0, 0.05]);
        let request = Self::request(rpm, point);
        let orders = Orders::Given(self.orders()?);
        let exact = waveform::exact(&self.with, &request, &thetas, &self.cancel)?;
        let by_orders =
            waveform::from_orders(&self.with, &request, &thetas, &orders, &self.cancel)?;
        let tail: f64 = self.amplitudes.tail.iter().map(|tail| tail * self.factor(rpm)).sum();
        let [slack, mean] = [self.slack(rpm, false), self.factor(rpm)];
        for (reading, found, highest, slack) in [
            ("exact waveform", &exact, 2 * HIGHEST_SUMMED, slack + tail),
            ("waveform by orders", &by_orders, 48, slack),
        ] {
            let part = found.parts.iter().find(|part| *part.name == *self.load.name);
            for (i, &theta) in thetas.iter().enumerate() {
                let mut expected = self.sum(rpm, theta, point, |order| order.halves() <= highest);
                expected[4] += mean * self.amplitudes.mean[0];
                expected[5] += mean * self.amplitudes.mean[1];
                let planar = part.and_then(|part| part.planar.as_ref()).map(|[force, moment]| {
                    [force[[i, 0]], force[[i, 1]], moment[[i, 0]], moment[[i, 1]]]
                });
                let torque = part
                    .and_then(|part| part.torque.as_ref())
                    .map(|torque| torque.each_ref().map(|of| of[i]));
                let [a, b, c, d] = planar.unwrap_or_default();
                let [e, f] = torque.unwrap_or_default();
                let pair = [[a, b, c, d, e, f], expected];
                same_six(reading, format_args!("at {theta}°"), pair, slack)?;
            }
        }
        Ok(())
    }

    fn axes(bank_angle: Option<(Vec<f64>, Hold)>, rpm: Vec<f64>) -> SweepAxes {
        SweepAxes { bank_angle, rpm, ..SweepAxes::default() }
    }

    fn check_sweeps(&self) -> Result<()> {
        let (orders, point, angles) = (self.orders()?, [0.0, 0.0, 0.05], [50.0, 130.0]);
        for hold in [Hold::Pins, Hold::Firing] {
            // Cranks of other senses hold their pins in other ways.
            let bank_angle = (self.bare.cranks().len() == 1).then(|| (angles.to_vec(), hold));
            let turns: Vec<f64> = match &bank_angle {
                None => vec![0.0],
                // The second cylinder stands in the right bank, whose bore is at 60°.
                Some(_) => angles.iter().map(|angle| 90.0 - 0.5 * angle - 60.0).collect(),
            };
            let engines = vec![Arc::clone(&self.with)];
            let axes = Self::axes(bank_angle, SPEEDS.to_vec());
            let sweep = Sweep::new(
                engines,
                axes,
                &Orders::Given(orders.clone()),
                Some(point[2]),
                true,
                &self.cancel,
            )?;
            for (kind, first) in
                [(Kind::Force, 0), (Kind::Moment, 2), (Kind::Torque, 4), (Kind::CrankTorque, 5)]
            {
                let quantity = Quantity { kind, part: Part::Of(&self.load.name) };
                let width = quantity.components();
                let rows = turns.len() * SPEEDS.len();
                let mut phasors = vec![Complex64::ZERO; rows * orders.len() * width]; // bounded: by HIGHEST_SUMMED
                sweep.write_phasors(quantity, Statistic::Amplitude, &mut phasors, &self.cancel)?;
                let mut means = vec![0.0; rows]; // bounded: by speeds and angles
                sweep.write_peaks(quantity, Statistic::Mean, &mut means, &self.cancel)?;
                let theta = 33.0;
                let angles = CrankAngles::new(&[theta])?;
                let mut values = vec![0.0; rows * width]; // bounded: by speeds and angles
                sweep.waveforms(quantity, &angles, false, &mut values, &self.cancel)?;
                for row in 0..rows {
                    let (turn, rpm) = (turns[row / SPEEDS.len()], SPEEDS[row % SPEEDS.len()]);
                    let turn = if self.load.cylinder.is_some() { turn } else { 0.0 };
                    let turned = [turn, if hold == Hold::Pins { turn } else { 0.0 }];
                    let slack = self.slack(rpm, false);
                    let mean = match kind {
                        Kind::Force | Kind::Moment => 0.0,
                        Kind::Torque => self.amplitudes.mean[0] * self.factor(rpm),
                        Kind::CrankTorque => self.amplitudes.mean[1] * self.factor(rpm),
                    };
                    if !quantity.is_planar() {
                        same("mean torque of a sweep", means[row], mean, slack)?;
                    }
                    for component in 0..width {
                        let mut sum = mean;
                        for (k, &order) in orders.iter().enumerate() {
                            let expected = self.plain(order, rpm, point, turned)[first + component];
                            let found = phasors[(row * orders.len() + k) * width + component];
                            let what = NAMES[first + component];
                            let reading =
                                format_args!("sweep: {what} of order {order} at {rpm} rpm");
                            same(reading, found, expected, slack)?;
                            let unit = turned_by(order, theta);
                            sum += (expected * unit).re;
                        }
                        same("waveform of a sweep", values[row * width + component], sum, slack)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn check_proofs(&self) -> Result<()> {
        let (orders, point) = (self.orders()?, [0.0, 0.0, 0.05]);
        let (whole, rpm) = (Order::all_whole(&[1, 2, 7])?, 1.0);
        let of = |engine, orders: &[Order]| {
            vanishing(engine, orders, Some(point[2]), None, &self.cancel)
        };
        let Vanishing { verdicts, .. } = of(&self.with, &orders)?;
        let bare = of(&self.bare, &whole)?.verdicts;
        for (order, verdicts) in orders.iter().zip(&verdicts) {
            let [x, y, mx, my, roll, _] = self.plain(*order, rpm, point, [0.0; 2]);
            let turning = |x: Complex64, y: Complex64| {
                let i = Complex64::i();
                [x, y, 0.5 * (x + i * y), 0.5 * (x - i * y)]
            };
            let acts = [turning(x, y), turning(mx, my)].concat();
            let acts = acts.iter().chain([&roll]).map(|one| one.norm() > self.slack(rpm, false));
            let alone = whole.iter().position(|own| own == order).map(|k| &bare[k]);
            for ((quantity, verdict), acts) in verdicts.indices().zip(verdicts).zip(acts) {
                let is_right = match alone {
                    _ if acts => *verdict != Verdict::Vanishes,
                    Some(alone) => *verdict == alone[quantity] || *verdict == Verdict::Undecided,
                    None => true,
                };
                if !is_right {
                    let reading = format_args!("proof of {quantity:?} of order {order}");
                    let hint = "it acts there, or nothing does";
                    return Err(rejected(reading, format_args!("{verdict:?}"), hint));
                }
            }
        }
        Ok(())
    }

    fn check_bearings(&self) -> Result<()> {
        let (rpm, thetas) = (SPEEDS[1], [10.0, 100.0, 333.0, 700.0]);
        let of = |engine| -> Result<_> {
            let model = BearingLoadsModel::new(engine, rpm)?;
            let mains = model.loads(&thetas, &self.cancel)?.main;
            let places: Vec<f64> = model.mains().iter().map(|main| main.z).collect();
            let shear = model.sections(CutPart::Crankcase, &thetas, &self.cancel)?.shear;
            let last = shear.shape()[0] - 1;
            Ok((mains, places, shear.index_axis_move(ndarray::Axis(0), last)))
        };
        let ((bare, places, bare_shear), (with, _, shear)) = (of(&self.bare)?, of(&self.with)?);
        let carried = self.load.on != ActsOn::Block && self.load.on_crank().is_some();
        let slack = self.slack(rpm, true) + self.factor(rpm) * self.amplitudes.tail[0];
        for (i, theta) in thetas.iter().enumerate() {
            for axis in 0..2 {
                let orders = self.amplitudes.orders.iter().enumerate();
                let of_order = |(k, order): (usize, &Order)| {
                    let unit = turned_by(*order, *theta);
                    (self.on_shaft(k, rpm, [0.0; 2])[axis] * unit).re
                };
                let force: f64 = orders.map(of_order).sum();
                let on_mains = |z0: f64| -> f64 {
                    let own = |(main, z): (usize, &f64)| {
                        (z - z0) * (with[[main, i, axis]] - bare[[main, i, axis]])
                    };
                    places.iter().enumerate().map(own).sum()
                };
                let force_on_mains = on_mains(-1.0) - on_mains(0.0);
                let expected = if carried { force } else { 0.0 };
                same("force on main bearings", force_on_mains, expected, 10.0 * slack)?;
                let (moment, about) = (on_mains(0.0), expected * self.load.z);
                same("moment of main bearings", moment, about, 10.0 * slack)?;
                let net = if self.load.on == ActsOn::Both { 0.0 } else { force };
                let found = shear[[i, axis]] - bare_shear[[i, axis]];
                same("force on the crankcase", found, net, 10.0 * slack)?;
            }
        }
        Ok(())
    }

    fn check_mounts(&self) -> Result<()> {
        let (orders, cg) = (self.orders()?, [0.02, 0.1, 0.3]);
        let inertia = [[8.0, 0.0, 0.0], [0.0, 12.0, 0.0], [0.0, 0.0, 6.0]];
        let body = RigidBody::new(150.0, cg, inertia, None)?;
        let mount = |(name, x, z): (&str, f64, f64)| {
            let (name, at, loss_factor) = (name.into(), [x, 0.0, z], [0.1; 3]);
            let stiffness = [2e5, 4e5, 2e5];
            let others = MountFigures::default();
            Mount::new(MountFigures { name, at, stiffness, loss_factor, ..others })
        };
        let mounts = [("a", -0.3, 0.1), ("b", 0.3, 0.1), ("c", 0.0, 0.6)].map(mount);
        let powertrain =
            Arc::new(Powertrain::new(body, mounts.into_iter().collect::<Result<_>>()?)?);
        let given = Orders::Given(orders.clone());
        let of = |engine: &Arc<Engine>| {
            Response::new(&**engine, Arc::clone(&powertrain), &SPEEDS, &given, &self.cancel)
        };
        let (with, bare) = (of(&self.with)?, of(&self.bare)?);
        for (row, (with, bare)) in with.loads().iter().zip(bare.loads()).enumerate() {
            let (rpm, order) = (SPEEDS[row / orders.len()], orders[row % orders.len()]);
            let [x, y, mx, my, roll, _] = self.plain(order, rpm, cg, [0.0; 2]);
            let reading = format_args!("load of mounts at order {order}");
            for (k, expected) in [x, y, Complex64::ZERO, mx, my, roll].into_iter().enumerate() {
                same(reading, with[k] - bare[k], expected, self.slack(rpm, true))?;
            }
        }
        Ok(())
    }

    fn check_tolerances(&self) -> Result<()> {
        let (orders, rpm, point) = (self.orders()?, SPEEDS[1], [0.0, 0.0, 0.05]);
        let spreads: [Vec<f64>; FIGURES] = Default::default();
        let of = |engine| {
            let spreads = (&spreads, Distribution::Normal);
            let request = Self::request(rpm, point);
            Tolerances::new(engine, &request, &orders, spreads, &[0, 1], &self.cancel)?.sample(
                1,
                &[&[]; FIGURES],
                &self.cancel,
            )
        };
        let (with, bare) = (of(&self.with)?, of(&self.bare)?);
        for (k, &order) in orders.iter().enumerate() {
            let expected = self.plain(order, rpm, point, [0.0; 2]);
            let planar = [(&with.force, &bare.force), (&with.moment, &bare.moment)];
            let [[x, y], [about_x, about_y]] =
                planar.map(|(with, bare)| [0, 1].map(|axis| with[k][axis] - bare[k][axis]));
            let [roll, crank] = [0, 1].map(|on| with.torque[k][on] - bare.torque[k][on]);
            let pair = [[x, y, about_x, about_y, roll, crank], expected];
            same_six("tolerances", format_args!("of order {order}"), pair, self.slack(rpm, true))?;
        }
        Ok(())
    }

    fn check_words(&self) -> Result<()> {
        let name = &self.load.name;
        let text = self.with.loads_counted();
        // Long lists of names are cut.
        if !text.contains(name.as_str()) && name.len() < 30 {
            return Err(rejected("loads_counted", text, format!("lacks {name:?}")));
        }
        if file::to_toml(&self.with).is_ok() {
            return Err(Error::value("to_toml", "a file", "a source of a program has no file"));
        }
        let (rpm, point) = (SPEEDS[1], [0.0, 0.0, 0.05]);
        let found = explain(&self.with, Some(rpm), Subject::Everything, &self.cancel)?.findings;
        let own = found.iter().find_map(|finding| match finding {
            Finding::GivenLoad { name: own, largest } if own == name => Some(*largest),
            _ => None,
        });
        let Some(Some([force, torque])) = own else {
            return Err(Error::value("explain", format!("{found:?}"), format!("lacks {name:?}")));
        };
        let all = (0..self.amplitudes.orders.len()).map(|k| self.six(k, rpm, point, [0.0; 2]));
        let largest = all.fold([0.0_f64; 2], |[force, torque], [x, y, _, _, roll, crank]| {
            let i = Complex64::i();
            let longest = 0.5 * ((x + i * y).norm() + (x - i * y).norm());
            [force.max(longest), torque.max(roll.norm()).max(crank.norm())]
        });
        for (found, expected) in [force, torque].into_iter().zip(largest) {
            let found = found.map_or(0.0, |largest| largest.peak);
            same("explain", found, expected, 1e-6 * expected + self.slack(rpm, false))?;
        }
        Ok(())
    }
}

/// Names of the six figures.
const NAMES: [&str; 6] = [
    "force along x",
    "force along y",
    "moment about x",
    "moment about y",
    "torque",
    "crank torque",
];

/// Force, moment and torques of the k-th order.
fn six_of(balance: &Balance, k: usize) -> Six {
    let torque = balance.wrenches[k].torque;
    let [force, moment] =
        [Vector::Force, Vector::Moment].map(|vector| balance.planar(vector, k).xy(0.0));
    [force[0], force[1], moment[0], moment[1], torque.roll, torque.crank]
}

#[cfg(test)]
mod tests;
