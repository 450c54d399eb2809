//! A periodic load that is given order by order: a force along a direction, torques, or both.

use std::sync::Arc;

use super::source::{
    ForcePart, Parts, Repeats, Scale, Scaling, Source, Tail, TorqueAmplitudes, is_equal,
};
use super::{LoadList, Place};
use crate::Complex64;
use crate::engine::{Crank, Engine, Origin, OverSpeed, PeriodicLoad};
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::numbers::UNIT_RPM;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;

/// Amplitudes of some orders, ascending.
type Series = Vec<(Order, Complex64)>;

/// Force and torques as they are, at one speed of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GivenLoad {
    name: Arc<str>,
    scaling: Scaling,
    force: Series,
    /// On the block and on the main crank.
    torque: [Series; 2],
    mean: [f64; 2],
}

/// Adds the loads that an engine was given to a list.
pub(super) fn push(loads: &mut LoadList, engine: &Engine) {
    for (k, load) in engine.loads().iter().enumerate() {
        let (axis, ratio) = load.shaft(engine);
        let place = |direction: Angle, of: &GivenLoad| Place {
            phase: match of.parts().repeats {
                Repeats::EveryTurn => load.phase_deg.reduced(),
                Repeats::EveryTwoTurns => load.phase_deg.half(),
            },
            // Orders are multiples of the speed of the main crank.
            bank: load.cylinder.map(|cylinder| engine.bank_of(cylinder)),
            ..Place::on_main(Origin::Load(k), direction, load.z).on(Crank { axis, ratio: 1 })
        };
        for (row, (scaling, factor)) in scalings(load).into_iter().enumerate() {
            let name: Arc<str> = load.name.as_str().into();
            let given = |force: Series, torque: [Series; 2], mean| GivenLoad {
                name: Arc::clone(&name),
                scaling,
                force,
                torque,
                mean,
            };
            let of_row = |amplitudes: &[(u32, Vec<Complex64>)]| -> Vec<(u32, Complex64)> {
                amplitudes.iter().map(|(halves, rows)| (*halves, rows[row] * factor)).collect()
            };
            let torque = of_row(&load.torque.0);
            let mean = torque.first().filter(|(halves, _)| *halves == 0).map_or(0.0, |(_, a)| a.re);
            let shares = load.torque_shares(engine);
            let series = |share: f64| -> Series {
                torque
                    .iter()
                    .filter(|(_, a)| *a * share != Complex64::ZERO)
                    .filter_map(|&(n, a)| Some((Order::from_halves(n).ok()?, a * share)))
                    .collect()
            };
            let force = if load.net_force() { of_row(&load.force.0) } else { Vec::new() };
            let [along, across] = components(&force, if load.turning { ratio } else { 0.0 });
            let torques = given(along, shares.map(series), shares.map(|share| share * mean));
            // A load of no size has a name, and no part in any sum.
            loads.name_group(&torques);
            let Parts { force, roll, .. } = torques.parts();
            if force.is_some() || roll {
                let [weight, roll] = [force.is_some(), roll].map(|has| f64::from(u8::from(has)));
                loads.push(place(load.direction_deg, &torques), torques, weight, roll);
            }
            if !across.is_empty() {
                let direction = load.direction_deg + Angle::HALF_TURN.half();
                let across = given(across, Default::default(), [0.0; 2]);
                loads.push(place(direction, &across), across, 1.0, 0.0);
            }
        }
    }
}

/// The force of a load on its shaft, or on the block, at a speed, rad/s: coefficients of `e^{ikθ/2}` of x + iy,
/// by k; without its mean.
pub(crate) fn waves(engine: &Engine, load: &PeriodicLoad, omega: f64) -> Vec<(i32, Complex64)> {
    let (_, ratio) = load.shaft(engine);
    let scalings = scalings(load);
    let sum = |rows: &[Complex64]| -> Complex64 {
        let scaled = rows.iter().zip(&scalings);
        scaled.map(|(a, (scaling, factor))| a * factor * scaling.factor(omega)).sum()
    };
    let force: Vec<_> = load.force.0.iter().map(|(halves, rows)| (*halves, sum(rows))).collect();
    let [along, across] = components(&force, if load.turning { ratio } else { 0.0 });
    let half_phase = load.phase_deg.half();
    let (direction, mut waves) = (load.direction_deg.cis(1), Vec::new());
    for (series, unit) in [(along, direction), (across, direction * Complex64::i())] {
        for (order, amplitude) in series {
            let halves = i64::from(order.halves());
            let forward = 0.5 * amplitude * half_phase.cis(-halves);
            waves.push((halves as i32, unit * forward));
            waves.push((-(halves as i32), unit * forward.conj()));
        }
    }
    waves
}

/// What each row of a load's table scales with, and the factor of its amplitudes.
fn scalings(load: &PeriodicLoad) -> Vec<(Scaling, f64)> {
    match &load.over_speed {
        OverSpeed::Independent => vec![(Scaling::Independent, 1.0)],
        OverSpeed::SpeedSquared(rpm) => {
            let omega = rpm / UNIT_RPM;
            vec![(Scaling::SpeedSquared, 1.0 / (omega * omega))]
        }
        OverSpeed::Table(rpm) => {
            let row = |k: usize| {
                let below = if k == 0 { f64::MIN } else { rpm[k - 1] };
                let above = rpm.get(k + 1).copied().unwrap_or(f64::MAX);
                (Scaling::Row([below, rpm[k], above]), 1.0)
            };
            (0..rpm.len()).map(row).collect()
        }
    }
}

/// A force along a direction that turns at some times crank speed, along that direction and a quarter turn
/// ahead of it, both at rest: by orders, without the mean.
fn components(force: &[(u32, Complex64)], ratio: f64) -> [Series; 2] {
    let (mut along, mut across) = (Vec::new(), Vec::new());
    let speed = (2.0 * ratio) as i64;
    let add = |series: &mut Vec<(i64, Complex64)>, halves: i64, amplitude: Complex64| {
        // Re(A·e^{−inθ}) is that of the conjugate at n.
        let (halves, amplitude) =
            if halves < 0 { (-halves, amplitude.conj()) } else { (halves, amplitude) };
        match series.iter_mut().find(|(known, _)| *known == halves) {
            Some((_, sum)) => *sum += amplitude,
            None => series.push((halves, amplitude)),
        }
    };
    for &(halves, amplitude) in force {
        let halves = i64::from(halves);
        if speed == 0 {
            add(&mut along, halves, amplitude);
            continue;
        }
        let (half, i) = (amplitude * 0.5, Complex64::i());
        for (sign, quarter) in [(1, -i), (-1, i)] {
            add(&mut along, halves + sign * speed, half);
            add(&mut across, halves + sign * speed, half * quarter);
        }
    }
    [along, across].map(|mut series| {
        series.sort_by_key(|(halves, _)| *halves);
        let order = |(halves, a)| Some((Order::from_halves(u32::try_from(halves).ok()?).ok()?, a));
        series.into_iter().filter(|(_, a)| *a != Complex64::ZERO).filter_map(order).collect()
    })
}

fn at_orders(series: &Series, orders: &[Order]) -> Vec<Complex64> {
    let value = |order: &Order| {
        let place = series.binary_search_by_key(order, |(own, _)| *own);
        place.map_or(Complex64::ZERO, |k| series[k].1)
    };
    orders.iter().map(value).collect()
}

/// Sum of the sizes of orders above a number of halves.
fn above(series: &Series, halves: u32) -> f64 {
    let own = series.iter().filter(|(order, _)| order.halves() > halves);
    own.map(|(_, amplitude)| amplitude.norm()).sum()
}

fn largest(series: &Series) -> f64 {
    series.iter().map(|(_, amplitude)| amplitude.norm()).fold(0.0, f64::max)
}

impl Source for GivenLoad {
    fn name(&self) -> &str {
        &self.name
    }

    fn parts(&self) -> Parts {
        let [block, crank] = &self.torque;
        let has_halves = [&self.force, block, crank]
            .into_iter()
            .flatten()
            .any(|(order, _)| order.as_whole().is_none());
        Parts {
            force: (!self.force.is_empty()).then_some(ForcePart::Along),
            roll: !block.is_empty() || !crank.is_empty() || self.mean != [0.0; 2],
            scaling: self.scaling,
            repeats: if has_halves { Repeats::EveryTwoTurns } else { Repeats::EveryTurn },
        }
    }

    fn equals(&self, other: &dyn Source) -> bool {
        is_equal(self, other)
    }

    fn force(&self, orders: &[Order], cancel: &Cancel) -> Result<Vec<Complex64>> {
        cancel.check()?;
        Ok(at_orders(&self.force, orders))
    }

    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        cancel.check()?;
        let [roll, crank] = self.torque.each_ref().map(|series| at_orders(series, orders));
        Ok(TorqueAmplitudes { harmonics: TorqueHarmonics { roll, crank }, mean: self.mean })
    }

    fn orders(&self, highest: Order) -> Vec<Order> {
        let [block, crank] = &self.torque;
        let all = [&self.force, block, crank].into_iter().flatten().map(|(order, _)| *order);
        let mut orders: Vec<Order> = all.filter(|order| *order <= highest).collect();
        orders.sort_unstable();
        orders.dedup();
        orders
    }

    fn beyond(&self, halves: u32, torque: bool) -> Tail {
        let [block, crank] = self.torque.each_ref().map(|series| above(series, halves));
        let torque = if torque { block.max(crank) } else { 0.0 };
        Tail { force: above(&self.force, halves), torque }
    }

    fn scale(&self) -> Scale {
        let torque = self.torque.iter().map(largest).fold(0.0, f64::max);
        Scale { force: largest(&self.force), torque: (torque > 0.0).then_some(torque) }
    }
}
