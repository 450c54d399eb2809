//! Sources of loads: amplitudes by order, and a bound of the rest.
//!
//! The loads of an engine are sources at places. Its own are the inertia of pistons and rods, unbalances,
//! pressure and loads that are given by numbers; any other implements [`Source`] and joins them by
//! [`PeriodicLoad::of`]. Every reading then counts it under its name. [`check_source`] runs a source through the
//! readings, against plain sums of its own amplitudes.
//!
//! ```
//! use crankpin_core::engine::{ActsOn, PeriodicLoad};
//! use crankpin_core::source::{Parts, Repeats, Scaling, Series, Source, TorqueAmplitudes, UpTo};
//! use crankpin_core::{Cancel, Order, Result, check_source};
//!
//! /// Springs that a camshaft compresses once in two turns: 10 N·m on it.
//! #[derive(Debug)]
//! struct ValveSprings;
//!
//! impl Source for ValveSprings {
//!     fn name(&self) -> &'static str {
//!         "valve springs"
//!     }
//!
//!     fn parts(&self) -> Parts {
//!         Parts { force: None, roll: true, scaling: Scaling::Independent, repeats: Repeats::EveryTwoTurns }
//!     }
//!
//!     fn series(&self, _: UpTo, _: &Cancel) -> Result<Series> {
//!         let on_both = ActsOn::Both.torque_shares(0.5);
//!         let torque = TorqueAmplitudes::shared(&[10.0.into()], 0.0, on_both);
//!         Ok(Series { orders: vec![Order::from_halves(1)?], torque, ..Series::default() })
//!     }
//! }
//!
//! let springs = PeriodicLoad::of(ValveSprings, ActsOn::Both);
//! check_source(&springs, None)?;
//! # Ok::<(), crankpin_core::Error>(())
//! ```
//!
//! [`check_source`]: crate::check_source
//! [`PeriodicLoad::of`]: crate::engine::PeriodicLoad::of

pub(crate) mod over_angle;
mod series;

use std::any::Any;
use std::fmt::Debug;
use std::ptr;
use std::sync::Arc;

use self::over_angle::{AngleBlock, Columns, LoadSum, Quantities};
pub use self::series::{Series, Tail, TorqueAmplitudes, UpTo};
use crate::Complex64;
use crate::mechanism::DrivenMechanism;
use crate::mechanism::exact::TorqueKey;
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::numbers::UNIT_RPM;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::pool;
use crate::pressure::Cycle;

/// Name of what moving parts make.
pub const INERTIA: &str = "inertia";
/// Name of what the pressure in cylinders makes.
pub const GAS: &str = "gas";

/// How a source acts at its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parts {
    /// Force; none where all that remains of forces is a torque.
    pub force: Option<ForcePart>,
    /// Whether it makes a torque besides that of its force about another axis.
    pub roll: bool,
    /// What it scales with.
    pub scaling: Scaling,
    /// When it repeats.
    pub repeats: Repeats,
}

/// How a force moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ForcePart {
    /// Along its direction, at multiples of the speed of its crank.
    Along,
    /// Turning with its shaft, at the order of its speed alone; the argument of its amplitude is the angle by
    /// which it is ahead of its direction in the sense of the shaft.
    Turning,
}

/// What amplitudes scale with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Scaling {
    /// With the square of the speed: inertia.
    #[default]
    SpeedSquared,
    /// With nothing: the same at any speed.
    Independent,
    /// With the height of a line that rises from 0 at the first of three crank speeds to 1 at the second,
    /// and falls to 0 at the third, rpm: a row of a table over speed.
    Row([f64; 3]),
}

impl Scaling {
    /// What amplitudes are multiplied by at an angular speed of the crank, rad/s.
    #[must_use]
    pub fn factor(self, omega: f64) -> f64 {
        match self {
            Self::SpeedSquared => omega * omega,
            Self::Independent => 1.0,
            Self::Row([below, at, above]) => {
                let rpm = omega * UNIT_RPM;
                // Speeds of a table that was given in rpm come back with a rounding.
                let share = |end: f64| ((rpm - end) / (at - end)).clamp(0.0, 1.0);
                if rpm < at {
                    share(below)
                } else if rpm > at {
                    share(above)
                } else {
                    1.0
                }
            }
        }
    }
}

/// After which turns a source repeats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Repeats {
    /// Of its crank.
    EveryTurn,
    /// Those of a cycle of four strokes: it has half orders.
    EveryTwoTurns,
}

impl Parts {
    /// Of inertia that repeats in a turn.
    pub(crate) const fn inertia(force: Option<ForcePart>, roll: bool) -> Self {
        Self { force, roll, scaling: Scaling::SpeedSquared, repeats: Repeats::EveryTurn }
    }
}

/// Which amplitude of a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Column {
    /// Of the force, and of its torque about another axis.
    #[default]
    Force,
    /// Of the torque of its own.
    Roll,
}

/// What a tolerance is relative to, over the weights of a load.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scale {
    /// Of the force.
    pub force: f64,
    /// None where it is that of the force at a crank radius, or at the distance of its axis.
    pub torque: Option<f64>,
    /// Smallest part of that of the torque which counts as a tolerance: larger than 0 where orders decline so
    /// slowly that those which are left out are better bounded than summed.
    pub least: f64,
}

/// Factor of a source in exact sums.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExactFactor {
    /// 1.
    One,
    /// Symbols, one for a motion and, in torques, for this key.
    Motion(TorqueKey),
    /// A symbol for each source, of the orders beside those that its motion's force has.
    Coupling,
    /// That of the sum of directions in which cylinders fire: of pressure.
    Cycle,
    /// No rational multiple of anything.
    Unknown,
}

/// A point of a sweep: what it replaces of a mechanism, and of pressure.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point<'a> {
    /// Crank radius over rod length.
    pub rod_ratio: Option<f64>,
    /// m.
    pub pin_offset: Option<f64>,
    /// One in place of each of the cycles of an engine.
    pub cycles: Option<&'a [Arc<Cycle>]>,
}

/// Real and imaginary parts of amplitudes at some points, order by order.
#[doc(hidden)]
pub type PointColumns = Vec<[Vec<f64>; 2]>;

/// What acts at a place, over the weights of a load.
///
/// A source says what every reading asks of it; none asks which source it is. It has a name, says how it acts,
/// and has a series of orders, with their amplitudes and a bound of the rest; what else there is follows from
/// these. A minimal source has [`name`], [`parts`] and [`series`]. One that evaluates amplitudes faster at the
/// orders that are wanted has [`force`] and [`torque`] as well, and may leave them out of its series.
///
/// Orders are multiples of the speed of the main crank, whatever the shaft; amplitudes are peak phasors, those
/// of order n at a crank angle θ `Re(A·e^{in(θ − φ)})`, with φ the phase of the place, and do not change with
/// speed but as [`Parts::scaling`] says: N and N·m, or kg·m and kg·m² where that is ω².
///
/// [`name`]: Self::name
/// [`parts`]: Self::parts
/// [`series`]: Self::series
/// [`force`]: Self::force
/// [`torque`]: Self::torque
pub trait Source: Debug + Send + Sync + Any {
    /// Under which its loads are counted: a name of its own; engines count their own as `inertia` and `gas`.
    fn name(&self) -> &str;

    /// How it acts.
    fn parts(&self) -> Parts;

    /// Whether another source is the same; loads of equal sources share their amplitudes.
    fn equals(&self, other: &dyn Source) -> bool {
        let _ = other;
        false
    }

    /// The motion that it depends on.
    #[doc(hidden)]
    fn mechanism(&self) -> Option<&DrivenMechanism> {
        None
    }

    /// Its orders as far as they are wanted, and a bound of the rest: in closed form, or of what is integrated.
    fn series(&self, up_to: UpTo, cancel: &Cancel) -> Result<Series>;

    /// Amplitudes of the force; zero at orders that it does not have.
    fn force(&self, orders: &[Order], cancel: &Cancel) -> Result<Vec<Complex64>> {
        Ok(series_to_highest(self, orders, cancel)?.force_at(orders))
    }

    /// Whether its torque at these orders is to be integrated: that takes as long as waking another
    /// thread.
    fn is_integrated(&self, orders: &[Order]) -> bool {
        let _ = orders;
        false
    }

    /// Amplitudes of its torque on the block and on the main crank, and their means; without those that its
    /// force makes about the main crank.
    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        Ok(series_to_highest(self, orders, cancel)?.torque_at(orders))
    }

    /// What a tolerance is relative to: by default all of its orders together.
    fn scale(&self) -> Scale {
        // An error is that of its amplitudes as well.
        let all = series(self, UpTo::Halves(0), &Cancel::new()).unwrap_or_default();
        let Tail { force, torque } = all.rest;
        Scale { force, torque: (torque > 0.0).then_some(torque), least: 0.0 }
    }

    /// Bounds of the sizes of its amplitudes at some orders, for the torque on the block and on the crank, which
    /// hold at any rod ratio and pin offset up to its own, as its bounds of the rest do; none where it is to be
    /// evaluated at each.
    #[doc(hidden)]
    fn sizes_up_to_own(
        &self,
        column: Column,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Option<[Vec<f64>; 2]>> {
        let _ = (column, orders, cancel);
        Ok(None)
    }

    /// Amplitudes at some orders and many rod ratios, where they are evaluated side by side: those of the force
    /// alone, or of the torques on the block and on the crank.
    #[doc(hidden)]
    fn at_rod_ratios(
        &self,
        column: Column,
        rod_ratios: &[f64],
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Option<[PointColumns; 2]>> {
        let _ = (column, rod_ratios, orders, cancel);
        Ok(None)
    }

    /// The source at a point of a sweep, where it is another there.
    fn at_point(&self, point: &Point) -> Result<Option<Arc<dyn Source>>> {
        let _ = point;
        Ok(None)
    }

    /// Its factor in exact sums.
    #[doc(hidden)]
    fn exact(&self) -> ExactFactor {
        ExactFactor::Unknown
    }

    /// Adds what loads of it add at a block of crank angles, times a factor: of a source without kinematics
    /// of its own the sum of its orders.
    #[doc(hidden)]
    fn over_angle(
        &self,
        sum: &LoadSum,
        block: &AngleBlock,
        wanted: Quantities,
        factor: f64,
        columns: &mut Columns,
    ) -> Result<()> {
        let cancel = Cancel::new();
        let orders = resolved(self, &cancel)?;
        let Columns { force: [force_x, force_y], moment: [moment_x, moment_y], torque } = columns;
        let [force, moment, arm] = [sum.force, sum.moment, sum.arm].map(|sum| sum * factor);
        let [on_block, on_crank] = torque;
        let has_force =
            self.parts().force.is_some() && [force, moment, arm] != [Complex64::ZERO; 3];
        let forces = if has_force { self.force(&orders, &cancel)? } else { Vec::new() };
        for (&order, amplitude) in orders.iter().zip(forces) {
            let (units, amplitude) = (block.orders(order), amplitude * sum.lag(order));
            for (i, (cos, sin)) in units.cos.iter().zip(&units.sin).enumerate() {
                let value = amplitude.re * cos - amplitude.im * sin;
                if wanted.force {
                    force_x[i] += force.re * value;
                    force_y[i] += force.im * value;
                }
                if wanted.moment {
                    moment_x[i] += moment.re * value;
                    moment_y[i] += moment.im * value;
                }
                if wanted.torque {
                    on_block[i] += arm.im * value;
                }
            }
        }
        if !wanted.torque || !self.parts().roll {
            return Ok(());
        }
        let weight = factor * sum.roll;
        let TorqueAmplitudes { harmonics, mean } = self.torque(&orders, &cancel)?;
        let both =
            [on_block, on_crank].into_iter().zip([harmonics.roll, harmonics.crank]).zip(mean);
        for ((column, series), mean) in both {
            for value in column.iter_mut() {
                *value += weight * mean;
            }
            for (&order, amplitude) in orders.iter().zip(series) {
                let (units, amplitude) = (block.orders(order), amplitude * sum.lag(order) * weight);
                for (value, (cos, sin)) in column.iter_mut().zip(units.cos.iter().zip(&units.sin)) {
                    *value += amplitude.re * cos - amplitude.im * sin;
                }
            }
        }
        Ok(())
    }

    /// Adds the moment of inertia of loads of it as seen from the main crank, kg·m², and its slope per
    /// radian.
    #[doc(hidden)]
    fn add_inertia(&self, sum: &LoadSum, angles: &CrankAngles, into: [&mut [f64]; 2]) {
        let _ = (sum, angles, into);
    }
}

/// The orders of a source as far as they are wanted.
pub(crate) fn series<S: Source + ?Sized>(
    source: &S,
    up_to: UpTo,
    cancel: &Cancel,
) -> Result<Series> {
    cancel.check()?;
    Ok(source.series(up_to, cancel)?.cut(up_to))
}

fn series_to_highest<S: Source + ?Sized>(
    source: &S,
    orders: &[Order],
    cancel: &Cancel,
) -> Result<Series> {
    cancel.check()?;
    let highest = orders.iter().max().map_or(0, |order| order.halves());
    source.series(UpTo::Halves(highest), cancel)
}

/// Amplitudes of a source, for the torque on the block and on the crank; those of forces twice.
pub(crate) fn amplitudes(
    source: &(impl Source + ?Sized),
    column: Column,
    orders: &[Order],
    cancel: &Cancel,
) -> Result<TorqueHarmonics> {
    match column {
        Column::Force => {
            let force = source.force(orders, cancel)?;
            Ok(TorqueHarmonics { roll: force.clone(), crank: force })
        }
        Column::Roll => Ok(source.torque(orders, cancel)?.harmonics),
    }
}

/// Sources at points that are evaluated side by side where they are integrated.
const SOURCES_AT_ONCE: usize = 64;

/// Amplitudes of a source at some points: those of the force alone, or of the torques on the block and on the crank.
pub(crate) fn at_points(
    source: &Arc<dyn Source>,
    column: Column,
    points: &[Point],
    orders: &[Order],
    cancel: &Cancel,
) -> Result<[PointColumns; 2]> {
    let ratio = |point: &Point| point.rod_ratio.filter(|_| point.pin_offset.is_none());
    if let Some(ratios) = points.iter().map(ratio).collect::<Option<Vec<f64>>>()
        && let Some(columns) = source.at_rod_ratios(column, &ratios, orders, cancel)?
    {
        return Ok(columns);
    }
    let mut both = [PointColumns::new(), PointColumns::new()];
    for columns in both.iter_mut().take(if column == Column::Roll { 2 } else { 1 }) {
        *columns = memory::with_capacity(orders.len())?;
        for _ in orders {
            columns.push([memory::zeros(points.len())?, memory::zeros(points.len())?]);
        }
    }
    let values = |source: &Arc<dyn Source>| {
        cancel.check()?;
        let TorqueHarmonics { roll, crank } = amplitudes(&**source, column, orders, cancel)?;
        Ok([roll, crank])
    };
    let Some(first) = points.first().map(|first| source.at_point(first)).transpose()?.flatten()
    else {
        for (columns, values) in both.iter_mut().zip(values(source)?) {
            for ([re, im], value) in columns.iter_mut().zip(values) {
                re.fill(value.re);
                im.fill(value.im);
            }
        }
        return Ok(both);
    };
    let (mut first, mut row) = (Some(first), 0);
    for some in points.chunks(SOURCES_AT_ONCE) {
        let there = |point| first.take().map_or_else(|| at_point(source, point), Ok);
        let sources = some.iter().map(there).collect::<Result<Vec<_>>>()?;
        let integrated = sources.iter().filter(|source| source.is_integrated(orders));
        let several = integrated.count() > 3;
        for of_point in pool::map_if(several, cancel, sources, |source| values(&source))? {
            for (columns, values) in both.iter_mut().zip(of_point) {
                for ([re, im], value) in columns.iter_mut().zip(values) {
                    (re[row], im[row]) = (value.re, value.im);
                }
            }
            row += 1;
        }
    }
    Ok(both)
}

/// Orders of a source, without those that together are rounding.
pub(crate) fn resolved<S: Source + ?Sized>(source: &S, cancel: &Cancel) -> Result<Vec<Order>> {
    /// Part of all orders that is rounding.
    const ROUNDING: f64 = 1e-17;
    let all = series(source, UpTo::Halves(0), cancel)?.rest;
    let is_below = |rest: f64, all: f64| rest.is_finite() && rest <= ROUNDING * all;
    let is_rounding =
        |rest: Tail| is_below(rest.force, all.force) && is_below(rest.torque, all.torque);
    Ok(series(source, UpTo::Enough(&is_rounding), cancel)?.orders)
}

/// A source at a point of a sweep.
pub(crate) fn at_point(source: &Arc<dyn Source>, point: &Point) -> Result<Arc<dyn Source>> {
    Ok(source.at_point(point)?.unwrap_or_else(|| Arc::clone(source)))
}

impl PartialEq for dyn Source {
    fn eq(&self, other: &Self) -> bool {
        ptr::addr_eq(self, other) || self.equals(other)
    }
}

/// Whether another source is of the same kind, and equal.
pub(crate) fn is_equal<S: Source + PartialEq>(source: &S, other: &dyn Source) -> bool {
    (other as &dyn Any).downcast_ref::<S>().is_some_and(|other| source == other)
}
