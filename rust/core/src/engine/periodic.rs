//! Periodic loads of a valve train, a pump, a belt, a propeller or a machine, by order or as samples.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{Crank, CrankIndex, Engine};
use crate::Complex64;
use crate::numbers::amplitudes::Amplitudes;
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::{ListIndex, number_from_one};
use crate::numbers::is_default;
use crate::numbers::limits;
use crate::numbers::ratio::SpeedRatio;
use crate::source::{GAS, INERTIA, Scaling, Source};

/// Most loads of an engine.
const MOST_LOADS: usize = 256;

/// What a load acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ActsOn {
    /// Its shaft, from outside: a propeller, a belt that pulls.
    Shaft,
    /// The block, from outside.
    Block,
    /// Both, one against the other: a pump or a valve train, whose forces on the engine as a whole cancel.
    Both,
}

impl ActsOn {
    /// Torques on the block and on the main crank over that on a shaft of a speed over that of the main crank.
    ///
    /// Shafts turn evenly, so that their gears transmit what acts on them: ρ times it arrives at the main
    /// crank, and the block bears what the moments of all inner forces leave.
    #[must_use]
    pub fn torque_shares(self, ratio: f64) -> [f64; 2] {
        match self {
            Self::Shaft => [1.0 - ratio, ratio],
            Self::Block => [1.0, 0.0],
            Self::Both => [-ratio, ratio],
        }
    }
}

/// What amplitudes do as the speed changes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OverSpeed {
    /// They stay.
    #[default]
    Independent,
    /// They grow with its square; the crank speed at which they are those given, rpm.
    SpeedSquared(f64),
    /// They are given at these crank speeds, rpm, and linear between them.
    Table(Vec<f64>),
}

/// A periodic load: amplitudes, or a source that has them, and their place.
///
/// Amplitudes are peak phasors: at a crank angle θ of the main crank an order n of amplitude A is
/// Re(A·e^{in(θ − phase)}).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PeriodicLoad {
    /// Under which it is counted.
    pub name: String,
    /// What it acts on.
    pub on: ActsOn,
    /// What has its amplitudes, in place of force, torque and their change with speed here. Its force acts along
    /// the direction or turns with the shaft as the source says; its torques are those that it says, whatever the
    /// load acts on. Files have none.
    #[serde(skip)]
    pub source: Option<Arc<dyn Source>>,
    /// Of the force, N.
    #[serde(default, skip_serializing_if = "is_default")]
    pub force: Amplitudes,
    /// Of the torque on its shaft about +z, or on the block where it acts on that alone, N·m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub torque: Amplitudes,
    /// What they do as the speed changes.
    #[serde(default, skip_serializing_if = "is_default")]
    pub over_speed: OverSpeed,
    /// Crank angle at which its own angle is 0, of the two turns of a cycle.
    #[serde(default, skip_serializing_if = "is_default")]
    pub phase_deg: Angle,
    /// Direction of the force, from +x; of one that turns when the crank stands at the phase.
    #[serde(default, skip_serializing_if = "is_default")]
    pub direction_deg: Angle,
    /// Whether the direction turns with its shaft.
    #[serde(default, skip_serializing_if = "is_default")]
    pub turning: bool,
    /// Place along the crank, m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub z: f64,
    /// Index of the crank that is its shaft, if one is.
    #[serde(default, skip_serializing_if = "is_default")]
    pub crank: Option<usize>,
    /// Speed of a shaft of its own.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ratio: SpeedRatio,
    /// Axis of a shaft of its own, x and y from that of the main crank, m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub axis: [f64; 2],
    /// Index of the cylinder with whose bank it and its axis turn about the main crank as the bank angle changes; in
    /// files its number, from 1.
    #[serde(default, skip_serializing_if = "is_default", with = "number_from_one")]
    pub cylinder: Option<usize>,
}

impl PeriodicLoad {
    /// A load of a name that acts on something, without amplitudes yet.
    pub fn new(name: impl Into<String>, on: ActsOn) -> Self {
        Self {
            name: name.into(),
            on,
            source: None,
            force: Amplitudes::default(),
            torque: Amplitudes::default(),
            over_speed: OverSpeed::default(),
            phase_deg: Angle::ZERO,
            direction_deg: Angle::ZERO,
            turning: false,
            z: 0.0,
            crank: None,
            ratio: SpeedRatio::ONE,
            axis: [0.0; 2],
            cylinder: None,
        }
    }

    /// A load of a source, under its name, whose force acts on something.
    #[must_use]
    pub fn of(source: impl Source, on: ActsOn) -> Self {
        let load = Self::new(source.name(), on);
        Self { source: Some(Arc::new(source)), ..load }
    }

    /// Rejects what no engine can have; `place` is its name in errors, and a point.
    pub fn checked(mut self, place: &str) -> Result<Self> {
        let named = |field: &str| format!("{place}{field}");
        limits::name(&named("name"), &self.name)?;
        if self.name.trim().is_empty() || [INERTIA, GAS].contains(&&*self.name) {
            let hint = "give a name of its own, under which results count it";
            return Err(Error::value(named("name"), format!("{:?}", self.name), hint));
        }
        let rows = self.check_speeds(&named("over_speed"))?;
        let mean =
            if self.turning { "" } else { "a force that stays does not shake: leave its mean out" };
        for (field, amplitudes, no_mean) in
            [("force", &mut self.force, mean), ("torque", &mut self.torque, "")]
        {
            amplitudes.check(&named(field), rows, no_mean)?;
        }
        let is_empty = self.force == Amplitudes::default() && self.torque == Amplitudes::default();
        if let Some(source) = &self.source {
            let is_plain = is_empty && !self.turning && self.over_speed == OverSpeed::default();
            if !is_plain || *self.name != *source.name() {
                let hint = "has its name and amplitudes, and whether they turn and scale with speed: leave these out";
                return Err(Error::value(named("source"), format!("{:?}", source.name()), hint));
            }
        } else if is_empty {
            let hint = "give amplitudes of a force, of a torque, or of both";
            return Err(Error::value(named("force"), "none", hint));
        }
        limits::finite(&named("z"), self.z)?;
        super::shaft::check_rotation(place, self.ratio, self.axis)?;
        if self.crank.is_some() && self.own_shaft() != Crank::MAIN {
            let hint = "is that of the crank that it sits on; leave it out, or the crank";
            return Err(Error::value(named("ratio"), self.ratio, hint));
        }
        self.phase_deg = in_two_turns(self.phase_deg);
        self.direction_deg = self.direction_deg.reduced();
        Ok(self)
    }

    /// Rejects a crank or a cylinder that an engine does not have.
    fn check_on(&self, place: &str, engine: &Engine) -> Result<()> {
        if let Some(crank) = self.crank.filter(|&crank| crank >= engine.cranks().len()) {
            let hint = format!("give the index of a crank, below {}", engine.cranks().len());
            return Err(Error::value(format!("{place}crank"), crank, hint));
        }
        if let Some(cylinder) = self.cylinder.filter(|&i| i >= engine.stations().len()) {
            let hint = format!("give the number of a cylinder, 1 to {}", engine.stations().len());
            return Err(Error::value(format!("{place}cylinder"), cylinder.wrapping_add(1), hint));
        }
        Ok(())
    }

    /// Number of speeds at which there are amplitudes.
    fn check_speeds(&self, place: &str) -> Result<usize> {
        match &self.over_speed {
            OverSpeed::Independent => Ok(1),
            OverSpeed::SpeedSquared(rpm) => limits::length(place, *rpm).map(|_| 1),
            OverSpeed::Table(rpm) => {
                for &rpm in rpm {
                    limits::not_negative(place, rpm)?;
                }
                if rpm.len() < 2 || !rpm.is_sorted_by(|before, after| before < after) {
                    let hint = "give two or more crank speeds, ascending, rpm";
                    return Err(Error::value(place, format!("{rpm:?}"), hint));
                }
                limits::axis_length("rpm", rpm.len())?;
                Ok(rpm.len())
            }
        }
    }

    /// Whether its force acts on the engine as a whole: not where shaft and block bear it against each other.
    #[must_use]
    pub fn net_force(&self) -> bool {
        self.on != ActsOn::Both
    }

    fn own_shaft(&self) -> Crank {
        Crank { axis: self.axis, ratio: self.ratio }
    }

    /// Its shaft.
    #[must_use]
    pub fn shaft(&self, engine: &Engine) -> Crank {
        self.crank.map_or_else(|| self.own_shaft(), |crank| engine.cranks()[CrankIndex::new(crank)])
    }

    /// Index of the crank that it sits on: one that was named, or the main one where it has no shaft of its own.
    #[must_use]
    pub fn on_crank(&self) -> Option<usize> {
        self.crank.or((self.own_shaft() == Crank::MAIN).then_some(0))
    }
}

/// An angle in the two turns of a cycle.
fn in_two_turns(angle: Angle) -> Angle {
    angle.half().reduced().times(2)
}

impl Engine {
    /// Periodic loads besides those of pistons, pressure and unbalances.
    #[must_use]
    pub fn loads(&self) -> &[PeriodicLoad] {
        &self.loads
    }

    /// The same engine with these periodic loads instead of those it has.
    pub fn with_loads(&self, loads: Vec<PeriodicLoad>) -> Result<Self> {
        if loads.len() > MOST_LOADS {
            let hint = format!("give at most {MOST_LOADS}");
            return Err(Error::value("loads", loads.len(), hint));
        }
        let checked = loads.into_iter().enumerate();
        let checked = checked.map(|(i, load)| {
            let place = format!("loads[{i}].");
            load.check_on(&place, self)?;
            load.checked(&place)
        });
        Ok(Self { loads: checked.collect::<Result<_>>()?, ..self.clone() })
    }

    /// The same engine with nothing but its moving parts: without pressure and further loads.
    #[must_use]
    pub fn bare(&self) -> Self {
        Self { loads: Vec::new(), ..self.without_gas() }
    }

    /// The same engine with what scales with the square of the speed alone: without pressure and loads
    /// that do not.
    #[must_use]
    pub fn of_speed_squared(&self) -> Self {
        let scales = |load: &&PeriodicLoad| match &load.source {
            Some(source) => source.parts().scaling == Scaling::SpeedSquared,
            None => matches!(load.over_speed, OverSpeed::SpeedSquared(_)),
        };
        Self { loads: self.loads.iter().filter(scales).cloned().collect(), ..self.without_gas() }
    }

    /// Loads tabulated over speed, with their first and last crank speed, rpm.
    fn tables(&self) -> impl Iterator<Item = (&PeriodicLoad, [f64; 2])> {
        self.loads.iter().filter_map(|load| match &load.over_speed {
            OverSpeed::Table(rpm) => Some((load, [rpm[0], rpm[rpm.len() - 1]])),
            OverSpeed::Independent | OverSpeed::SpeedSquared(_) => None,
        })
    }

    /// Lowest and highest crank speed that every table of a load has, rpm; none without tables.
    #[must_use]
    pub fn speeds_of_tables(&self) -> Option<[f64; 2]> {
        let ends = self.tables().map(|(_, ends)| ends);
        ends.reduce(|[low, high], [first, last]| [low.max(first), high.min(last)])
    }

    /// Rejects crank speeds that a load's table does not have, rpm.
    pub(crate) fn check_speeds(&self, rpm: &[f64]) -> Result<()> {
        for (load, [first, last]) in self.tables() {
            if let Some(&outside) = rpm.iter().find(|&&rpm| rpm < first || rpm > last) {
                let hint = format!("{:?} is given from {first} to {last} rpm", load.name);
                return Err(Error::figure("rpm", outside, hint));
            }
        }
        Ok(())
    }

    /// Turns all loads on by an angle of the main crank.
    pub(super) fn delay_loads(&mut self, by: Angle) {
        for load in &mut self.loads {
            load.phase_deg = in_two_turns(load.phase_deg + by);
        }
    }

    /// Turns the loads of a cylinder's bank with it, by an angle, their axes too; with the pins held their phase
    /// goes along.
    pub(super) fn turn_loads(&mut self, bank: usize, by: Angle, with_phase: bool) {
        let bank_of = &self.bank_of;
        for load in
            self.loads.iter_mut().filter(|load| load.cylinder.is_some_and(|i| bank_of[i] == bank))
        {
            let ([x, y], Complex64 { re: cos, im: sin }) = (load.axis, by.cis(1));
            load.axis = [x * cos - y * sin, x * sin + y * cos];
            load.direction_deg = (load.direction_deg + by).reduced();
            if with_phase {
                load.phase_deg = in_two_turns(load.phase_deg + by);
            }
        }
    }
}
