//! A periodic load of known amplitudes by order: a force along a direction, torques, or both.

use std::any::Any;
use std::sync::Arc;

use super::{Place, Scene};
use crate::Complex64;
use crate::engine::{ActsOn, Crank, CrankIndex, Engine, Origin, OverSpeed, PeriodicLoad};
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::numbers::UNIT_RPM;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::index::ListIndex;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::source::{
    ForcePart, Parts, Point, Repeats, Scale, Scaling, Series, Source, Tail, TorqueAmplitudes, UpTo,
    is_equal, resolved, series,
};

/// Amplitudes of some orders, ascending.
type OrderAmplitudes = Vec<(Order, Complex64)>;

/// Force and torques as they are, at one speed of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GivenLoad {
    name: Arc<str>,
    scaling: Scaling,
    series: Series,
}

/// Adds the loads that an engine was given to a list.
pub(super) fn push(loads: &mut Scene, engine: &Engine) {
    for (k, load) in engine.loads().iter().enumerate() {
        let axis = load.shaft(engine).axis;
        for (source, direction) in directed(load, engine) {
            let mut parts = source.parts();
            // A load of no size has a name, and no part in any sum.
            loads.name_group(&*source);
            parts.force = parts.force.filter(|_| load.net_force());
            if parts.force.is_none() && !parts.roll {
                continue;
            }
            let place = Place {
                phase: match parts.repeats {
                    Repeats::EveryTurn => load.phase_deg.reduced(),
                    Repeats::EveryTwoTurns => load.phase_deg.half(),
                },
                // Orders are multiples of the speed of the main crank.
                bank: load.cylinder.map(|cylinder| engine.bank_of(cylinder)),
                ..Place::on_main(Origin::Load(k), direction, load.z)
                    .on(Crank { axis, ..Crank::MAIN })
            };
            let weights = [parts.force.is_some(), parts.roll].map(|has| f64::from(u8::from(has)));
            loads.push_as(place, parts, source, weights);
        }
    }
}

/// A force on a crank, or on the crankcase: coefficients of `e^{ikθ/2}` of x + iy, N, by k; without its mean.
pub(crate) struct ShaftForce {
    pub z: f64,
    /// The crank that it acts on; the crankcase where there is none.
    pub crank: Option<CrankIndex>,
    pub waves: Vec<(i32, Complex64)>,
}

/// The forces on cranks and crankcase at a speed, rad/s, besides those of pistons and pressure: of unbalances,
/// and of further loads, both sides of those that act from within.
pub(crate) fn shaft_forces(
    engine: &Engine,
    omega: f64,
    cancel: &Cancel,
) -> Result<Vec<ShaftForce>> {
    let mut forces = Vec::new();
    for load in Scene::of(engine, Some(0.0))?.list.iter().filter(|load| load.is_turning()) {
        let place = &load.place;
        let crank = engine.crank_with(place.origin);
        let force = load.weight * omega * omega * place.speed_squared();
        let at_start = place.unit * place.ratio.cis(place.phase, -1) * force;
        forces.push(ShaftForce {
            z: place.z,
            crank,
            waves: vec![(place.ratio.halves(), at_start)],
        });
    }
    for load in engine.loads() {
        let (half_phase, mut waves) = (load.phase_deg.half(), Vec::new());
        for (source, direction) in directed(load, engine) {
            let Parts { force: Some(_), scaling, .. } = source.parts() else { continue };
            let (orders, unit) = (resolved(&*source, cancel)?, direction.cis(1));
            for (order, amplitude) in orders.iter().zip(source.force(&orders, cancel)?) {
                let halves = i64::from(order.halves());
                let forward = 0.5 * scaling.factor(omega) * amplitude * half_phase.cis(-halves);
                if forward != Complex64::ZERO {
                    waves.push((halves as i32, unit * forward));
                    waves.push((-(halves as i32), unit * forward.conj()));
                }
            }
        }
        if waves.is_empty() {
            continue;
        }
        if load.on == ActsOn::Both {
            let against = waves.iter().map(|(halves, wave)| (*halves, -wave)).collect();
            forces.push(ShaftForce { z: load.z, crank: None, waves: against });
        }
        let crank = load.on_crank().filter(|_| load.on != ActsOn::Block).map(CrankIndex::new);
        forces.push(ShaftForce { z: load.z, crank, waves });
    }
    Ok(forces)
}

/// The sources of a load, each with the direction of its force: of one that turns also that a quarter turn ahead;
/// of a table one for each speed.
fn directed(load: &PeriodicLoad, engine: &Engine) -> Vec<(Arc<dyn Source>, Angle)> {
    let ratio = load.shaft(engine).ratio;
    let across = load.direction_deg + Angle::HALF_TURN.half();
    let mut sources: Vec<(Arc<dyn Source>, Angle)> = Vec::new();
    if let Some(source) = &load.source {
        if source.parts().force != Some(ForcePart::Turning) {
            return vec![(Arc::clone(source), load.direction_deg)];
        }
        let part = |ahead| TurningForce { source: Arc::clone(source), ratio, ahead };
        return vec![(Arc::new(part(false)), load.direction_deg), (Arc::new(part(true)), across)];
    }
    let (name, shares): (Arc<str>, _) =
        (load.name.as_str().into(), load.on.torque_shares(ratio.number()));
    for (row, (scaling, factor)) in scalings(load).into_iter().enumerate() {
        let of_row = |amplitudes: &[(u32, Vec<Complex64>)]| -> Vec<(u32, Complex64)> {
            amplitudes.iter().map(|(halves, rows)| (*halves, rows[row] * factor)).collect()
        };
        let torque = of_row(&load.torque.0);
        let mean = torque.first().filter(|(halves, _)| *halves == 0).map_or(0.0, |(_, a)| a.re);
        let torque = |share: f64| -> OrderAmplitudes {
            torque
                .iter()
                .filter(|(_, a)| *a * share != Complex64::ZERO)
                .filter_map(|&(n, a)| Some((Order::from_halves(n).ok()?, a * share)))
                .collect()
        };
        let force = of_row(&load.force.0);
        let [along, ahead] = components(&force, if load.turning { ratio.halves() } else { 0 });
        let given = |force: OrderAmplitudes, torque: [OrderAmplitudes; 2], mean| {
            let series = series_of(&force, &torque, mean);
            Arc::new(GivenLoad { name: Arc::clone(&name), scaling, series })
        };
        let mean = shares.map(|share| share * mean);
        sources.push((given(along, shares.map(torque), mean), load.direction_deg));
        if !ahead.is_empty() {
            sources.push((given(ahead, Default::default(), [0.0; 2]), across));
        }
    }
    sources
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

/// A force along a direction that turns at some halves of crank speed, along that direction and a quarter turn
/// ahead of it, both at rest: by orders, without the mean.
fn components(force: &[(u32, Complex64)], speed: i32) -> [OrderAmplitudes; 2] {
    let (mut along, mut across) = (Vec::new(), Vec::new());
    let speed = i64::from(speed);
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

/// The series of a force and of torques on the block and on the main crank.
fn series_of(force: &OrderAmplitudes, torque: &[OrderAmplitudes; 2], mean: [f64; 2]) -> Series {
    let [roll, crank] = torque;
    let all = [force, roll, crank].into_iter().flatten().map(|(order, _)| *order);
    let mut orders: Vec<Order> = all.collect();
    orders.sort_unstable();
    orders.dedup();
    let at = |amplitudes: &OrderAmplitudes| {
        let own = |order| amplitudes.binary_search_by_key(order, |(own, _)| *own);
        let value = |order| own(order).map_or(Complex64::ZERO, |k| amplitudes[k].1);
        orders.iter().map(value).collect()
    };
    let torque =
        TorqueAmplitudes { harmonics: TorqueHarmonics { roll: at(roll), crank: at(crank) }, mean };
    Series { force: at(force), torque, orders, rest: Tail::default() }
}

fn largest(amplitudes: &[Complex64]) -> f64 {
    amplitudes.iter().map(|amplitude| amplitude.norm()).fold(0.0, f64::max)
}

impl Source for GivenLoad {
    fn name(&self) -> &str {
        &self.name
    }

    fn parts(&self) -> Parts {
        let Series { orders, force, torque, .. } = &self.series;
        let TorqueHarmonics { roll, crank } = &torque.harmonics;
        let acts = |amplitudes: &[Complex64]| amplitudes.iter().any(|a| *a != Complex64::ZERO);
        let has_halves = orders.iter().any(|order| order.as_whole().is_none());
        Parts {
            force: acts(force).then_some(ForcePart::Along),
            roll: acts(roll) || acts(crank) || torque.mean != [0.0; 2],
            scaling: self.scaling,
            repeats: if has_halves { Repeats::EveryTwoTurns } else { Repeats::EveryTurn },
        }
    }

    fn equals(&self, other: &dyn Source) -> bool {
        is_equal(self, other)
    }

    fn series(&self, _: UpTo, _: &Cancel) -> Result<Series> {
        Ok(self.series.clone())
    }

    fn force(&self, orders: &[Order], cancel: &Cancel) -> Result<Vec<Complex64>> {
        cancel.check()?;
        Ok(self.series.force_at(orders))
    }

    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        cancel.check()?;
        Ok(self.series.torque_at(orders))
    }

    fn scale(&self) -> Scale {
        let Series { force, torque, .. } = &self.series;
        let TorqueHarmonics { roll, crank } = &torque.harmonics;
        let torque = largest(roll).max(largest(crank));
        Scale { force: largest(force), torque: (torque > 0.0).then_some(torque), least: 0.0 }
    }
}

/// A force that turns with a shaft, seen along a direction at rest: that from which it starts, with the torque of
/// its source, or one a quarter turn ahead of it.
#[derive(Debug)]
struct TurningForce {
    source: Arc<dyn Source>,
    /// Speed of the shaft over crank speed, negative where it turns against the crank.
    ratio: SpeedRatio,
    ahead: bool,
}

impl TurningForce {
    /// The only order of the force.
    fn own(&self) -> Option<Order> {
        self.ratio.order().ok()
    }
}

impl Source for TurningForce {
    fn name(&self) -> &str {
        self.source.name()
    }

    fn parts(&self) -> Parts {
        let parts = self.source.parts();
        Parts { force: Some(ForcePart::Along), roll: parts.roll && !self.ahead, ..parts }
    }

    fn equals(&self, other: &dyn Source) -> bool {
        let other = (other as &dyn Any).downcast_ref::<Self>();
        other.is_some_and(|other| {
            (self.ratio, self.ahead) == (other.ratio, other.ahead) && *self.source == *other.source
        })
    }

    fn force(&self, orders: &[Order], cancel: &Cancel) -> Result<Vec<Complex64>> {
        let factor = match (self.ahead, self.ratio.is_forward()) {
            (false, _) => Complex64::ONE,
            (true, true) => -Complex64::i(),
            (true, false) => Complex64::i(),
        };
        let own = self.own();
        let at_own = |(order, amplitude)| {
            if Some(order) == own { amplitude * factor } else { Complex64::ZERO }
        };
        let amplitudes = self.source.force(orders, cancel)?;
        Ok(orders.iter().copied().zip(amplitudes).map(at_own).collect())
    }

    fn is_integrated(&self, orders: &[Order]) -> bool {
        self.source.is_integrated(orders)
    }

    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        self.source.torque(orders, cancel)
    }

    /// Its own order, which is always among them, and those of the torque.
    fn series(&self, up_to: UpTo, cancel: &Cancel) -> Result<Series> {
        let torque = |rest: Tail| if self.ahead { 0.0 } else { rest.torque };
        let torque_alone = |rest: Tail| Tail { force: 0.0, torque: torque(rest) };
        let Series { mut orders, mut rest, .. } = match up_to {
            UpTo::Enough(is_enough) => {
                let is_enough = |rest| is_enough(torque_alone(rest));
                series(&*self.source, UpTo::Enough(&is_enough), cancel)?
            }
            UpTo::Halves(_) => series(&*self.source, up_to, cancel)?,
        };
        if self.ahead {
            orders.clear();
        }
        let is_left_out = |own: &Order| matches!(up_to, UpTo::Halves(most) if own.halves() > most);
        rest = match self.own().filter(is_left_out) {
            Some(_) => Tail { torque: torque(rest), ..rest },
            None => torque_alone(rest),
        };
        orders.extend(self.own().filter(|own| !is_left_out(own)));
        orders.sort_unstable();
        orders.dedup();
        Ok(Series::without_amplitudes(orders, rest))
    }

    fn scale(&self) -> Scale {
        self.source.scale()
    }

    fn at_point(&self, point: &Point) -> Result<Option<Arc<dyn Source>>> {
        let at = self.source.at_point(point)?;
        Ok(at.map(|source| -> Arc<dyn Source> { Arc::new(Self { source, ..*self }) }))
    }
}
