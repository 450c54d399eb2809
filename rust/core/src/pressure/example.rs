//! Example cycles, computed for no engine in particular.

use std::sync::{Arc, OnceLock};

use super::Cycle;
use super::Strokes;
use super::burn::{Heat, WallLoss, Wiebe};
use super::chamber::Chamber;
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::figure::significant;

/// Indicated mean effective pressure of the examples that idle, Pa: that of friction.
const IDLING_IMEP: f64 = 1.2e5;
/// Relative difference from its mean effective pressure at which an example's load is settled.
const SETTLED: f64 = 1e-10;
/// Least part of the charge of full load that is tried.
const LEAST_CHARGE: f64 = 0.01;

/// Which engine it is like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExampleKind {
    /// A naturally aspirated one, at full load and 3000 rpm.
    Petrol,
    /// A turbocharged one, at 2000 rpm.
    Diesel,
}

impl ExampleKind {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Petrol, Self::Diesel];

    /// `petrol` or `diesel`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Petrol => "petrol",
            Self::Diesel => "diesel",
        }
    }

    /// Name of its cycle at full load.
    pub(crate) fn name_at_full_load(self) -> String {
        self.name_at(1.0)
    }

    fn name_at(self, load: f64) -> String {
        format!("example {}, {}", self.name(), load_in_words(load))
    }

    fn compression_ratio(self) -> f64 {
        match self {
            Self::Petrol => 10.5,
            Self::Diesel => 16.5,
        }
    }

    /// The cycle of four-strokes at full load.
    fn full_load(self) -> Wiebe {
        let (petrol, a) = (self == Self::Petrol, 6.908);
        let (intake_closes_deg, exhaust_opens_deg) = (-140.0, 130.0);
        let fuel = |excess_air, stoichiometric_ratio, heating_value| Heat::Fuel {
            excess_air,
            stoichiometric_ratio,
            heating_value,
        };
        let wall = |temperature, rpm| Some(WallLoss { temperature, rpm });
        if petrol {
            Wiebe {
                heat: fuel(1.0, 14.6, 43e6),
                start_deg: -18.0,
                duration_deg: 52.0,
                a,
                m: 2.0,
                gamma: 1.3,
                intake_pressure: 0.95e5,
                exhaust_pressure: 1.05e5,
                charge_temperature: 350.0,
                intake_closes_deg,
                exhaust_opens_deg,
                wall: wall(440.0, 3000.0),
            }
        } else {
            Wiebe {
                heat: fuel(1.7, 14.5, 42.7e6),
                start_deg: -6.0,
                duration_deg: 70.0,
                a,
                m: 0.8,
                gamma: 1.33,
                intake_pressure: 1.9e5,
                exhaust_pressure: 1.8e5,
                charge_temperature: 360.0,
                intake_closes_deg,
                exhaust_opens_deg,
                wall: wall(470.0, 2000.0),
            }
        }
    }

    /// The figures that are others where the engine idles; between, they are linear in load.
    fn idling(self, full: &Wiebe) -> Wiebe {
        let (of_full, wall) =
            (full.clone(), |temperature, rpm| Some(WallLoss { temperature, rpm }));
        match self {
            Self::Petrol => Wiebe {
                start_deg: -24.0,
                duration_deg: 75.0,
                exhaust_pressure: 1.02e5,
                wall: wall(390.0, 800.0),
                ..of_full
            },
            Self::Diesel => Wiebe {
                start_deg: -3.0,
                duration_deg: 40.0,
                intake_pressure: 1.0e5,
                exhaust_pressure: 1.04e5,
                charge_temperature: 335.0,
                wall: wall(390.0, 700.0),
                ..of_full
            },
        }
    }
}

/// A cylinder, its bore, compression ratio and burn, and a name.
#[derive(Debug, Clone)]
pub struct Example {
    /// The cylinder.
    pub cylinder: Cylinder,
    /// Diameter of its bore, m.
    pub bore: f64,
    /// Largest over smallest volume.
    pub compression_ratio: f64,
    /// Strokes of a cycle.
    pub strokes: Strokes,
    /// The burn.
    pub wiebe: Wiebe,
    /// Which example, and its load.
    pub name: String,
}

impl Example {
    /// An example at a part of full load, down to 0, which is idling.
    ///
    /// Indicated mean effective pressure is linear in load, and set by the pressure of the intake (petrol
    /// four-strokes) or by the fuel; other figures are linear in load too.
    ///
    /// ```
    /// use crankpin_core::Cancel;
    /// use crankpin_core::layout::Strokes;
    /// use crankpin_core::pressure::example::{Example, ExampleKind};
    ///
    /// let cancel = Cancel::new();
    /// let petrol = Example::new(ExampleKind::Petrol, 1.0, Strokes::Four, &cancel)?;
    /// assert_eq!(petrol.cycle(&cancel)?.given().name, "example petrol, full load");
    /// # Ok::<(), crankpin_core::Error>(())
    /// ```
    pub fn new(kind: ExampleKind, load: f64, strokes: Strokes, cancel: &Cancel) -> Result<Self> {
        if !(0.0..=1.0).contains(&load) {
            let hint = "give a part of full load, 0 (idling) to 1";
            return Err(Error::figure("load", load, hint));
        }
        let mut full = Self {
            cylinder: Cylinder::new(0.043, 0.145, 0.5, 0.0)?,
            bore: 0.086,
            compression_ratio: kind.compression_ratio(),
            strokes,
            wiebe: kind.full_load(),
            name: kind.name_at(load),
        };
        if strokes == Strokes::Two {
            (full.wiebe.intake_closes_deg, full.wiebe.exhaust_opens_deg) = (-115.0, 105.0);
        }
        if load == 1.0 {
            return Ok(full);
        }
        let target = IDLING_IMEP + load * (full.imep(cancel)? - IDLING_IMEP);
        let part = between(&kind.idling(&full.wiebe), &full.wiebe, load);
        // A throttle sets the charge of four-strokes with petrol. A two-stroke's cylinder is filled at
        // the pressure of the exhaust, with less of what burns.
        let throttled = kind == ExampleKind::Petrol && strokes == Strokes::Four;
        let with_charge = |charge: f64| {
            let mut wiebe = part.clone();
            match &mut wiebe.heat {
                _ if throttled => wiebe.intake_pressure = full.wiebe.intake_pressure * charge,
                Heat::Fuel { excess_air, .. } => *excess_air /= charge,
                Heat::Given(heat) => *heat *= charge,
            }
            Self { wiebe, ..full.clone() }
        };
        // Work is all but linear in the charge: secants converge from anywhere.
        let (mut charge, mut before): (f64, Option<(f64, f64)>) = (1.0, None);
        loop {
            let found = with_charge(charge);
            let error = found.imep(cancel)? / target - 1.0;
            if error.abs() < SETTLED {
                return Ok(found);
            }
            let next = before.map_or(0.5, |(earlier, of_earlier)| {
                let slope = (error - of_earlier) / (charge - earlier);
                (charge - error / slope).max(LEAST_CHARGE)
            });
            before = Some((charge, error));
            charge = next;
        }
    }

    fn chamber(&self) -> Result<Chamber> {
        Chamber::new(&self.cylinder, self.bore, self.compression_ratio, self.strokes)
    }

    /// The cycle.
    pub fn cycle(&self, cancel: &Cancel) -> Result<Cycle> {
        self.wiebe.cycle(&self.chamber()?, self.name.clone(), cancel)
    }

    /// Indicated mean effective pressure, Pa.
    fn imep(&self, cancel: &Cancel) -> Result<f64> {
        self.cycle(cancel)?.imep(&self.cylinder, cancel)
    }
}

/// The cycle of an example at full load, computed once.
pub(crate) fn full_load(kind: ExampleKind, strokes: Strokes) -> Result<Arc<Cycle>> {
    static CYCLES: [[OnceLock<Arc<Cycle>>; 2]; 2] = [const { [const { OnceLock::new() }; 2] }; 2];
    let cycle = &CYCLES[kind as usize][usize::from(strokes == Strokes::Two)];
    if let Some(computed) = cycle.get() {
        return Ok(Arc::clone(computed));
    }
    let cancel = Cancel::new();
    let computed = Example::new(kind, 1.0, strokes, &cancel)?.cycle(&cancel)?;
    Ok(Arc::clone(cycle.get_or_init(|| Arc::new(computed))))
}

fn load_in_words(load: f64) -> String {
    if load == 1.0 {
        return "full load".to_owned();
    }
    if load == 0.0 {
        return "idling".to_owned();
    }
    format!("{} % load", significant(100.0 * load, 4))
}

/// Figures between idling and full load.
fn between(idling: &Wiebe, full: &Wiebe, load: f64) -> Wiebe {
    let at = |figure: fn(&Wiebe) -> f64| figure(idling) + load * (figure(full) - figure(idling));
    let of_wall = |figure: fn(&WallLoss) -> f64| {
        let [idling, full] = [idling, full].map(|wiebe| wiebe.wall.as_ref().map_or(0.0, figure));
        idling + load * (full - idling)
    };
    Wiebe {
        start_deg: at(|w| w.start_deg),
        duration_deg: at(|w| w.duration_deg),
        intake_pressure: at(|w| w.intake_pressure),
        exhaust_pressure: at(|w| w.exhaust_pressure),
        charge_temperature: at(|w| w.charge_temperature),
        wall: full.wall.as_ref().map(|_| WallLoss {
            temperature: of_wall(|wall| wall.temperature),
            rpm: of_wall(|wall| wall.rpm),
        }),
        ..full.clone()
    }
}
