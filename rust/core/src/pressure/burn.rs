//! Cycles of one zone with a Wiebe burn, and heat loss to the wall.

use std::sync::LazyLock;

use super::Cycle;
use super::Strokes;
use super::chamber::{
    Chamber, Curves, DEGREE, NARROWEST, RESOLVED, absolute, exponent, is_resolved, within,
};
use super::period_deg;
use crate::numbers::cancel::Cancel;
use crate::numbers::chebyshev::{coefficient, largest_of_last, node, points};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// Gas constant of air, J/(kg·K).
const AIR: f64 = 287.05;
/// Iterations of a panel before it is halved.
const MOST_ITERATIONS: usize = 30;

/// Heat that a cycle's fuel holds.
#[derive(Debug, Clone)]
pub enum Heat {
    /// J.
    Given(f64),
    /// Of fuel in the air of the cylinder when the intake closes.
    Fuel {
        /// Air over that of a stoichiometric mixture, λ.
        excess_air: f64,
        /// Mass of air over mass of fuel of a stoichiometric mixture.
        stoichiometric_ratio: f64,
        /// Lower heating value, J/kg.
        heating_value: f64,
    },
}

/// Heat loss by Woschni's correlation, as in Heywood, Internal Combustion Engine Fundamentals (1988),
/// section 12.4.3, without swirl.
#[derive(Debug, Clone)]
pub struct WallLoss {
    /// Temperature of head, piston and liner, K.
    pub temperature: f64,
    /// Crank speed.
    pub rpm: f64,
}

/// A cycle of one zone of constant heat capacity between intake closing and exhaust opening.
///
/// Angles are degrees after the firing top dead centre.
#[derive(Debug, Clone)]
pub struct Wiebe {
    /// Heat of the fuel.
    pub heat: Heat,
    /// Start of the burn, below 0 before top dead centre.
    pub start_deg: f64,
    /// Duration of the burn.
    pub duration_deg: f64,
    /// Efficiency parameter: 1 − e^{−a} of the heat is released.
    pub a: f64,
    /// Form parameter.
    pub m: f64,
    /// Ratio of heat capacities.
    pub gamma: f64,
    /// Absolute pressure from the intake stroke to intake closing, Pa.
    pub intake_pressure: f64,
    /// Absolute pressure after the blowdown, in a four-stroke, Pa.
    pub exhaust_pressure: f64,
    /// Temperature of the charge when the intake closes, K.
    pub charge_temperature: f64,
    /// Intake closing, below 0.
    pub intake_closes_deg: f64,
    /// Exhaust opening.
    pub exhaust_opens_deg: f64,
    /// Wall loss, if it counts.
    pub wall: Option<WallLoss>,
}

/// State of the closed part of a cycle.
struct Closed<'a> {
    wiebe: &'a Wiebe,
    chamber: &'a Chamber,
    /// Heat of the fuel over what p·V of the charge is, `p_i·V_c`.
    heat: f64,
    /// Volume over clearance when the intake closes.
    ratio: f64,
}

impl Wiebe {
    /// Figures by name, in the units of the fields.
    #[must_use]
    pub fn figures(&self) -> Vec<(&'static str, f64)> {
        let mut figures = match self.heat {
            Heat::Given(heat) => vec![("heat", heat)],
            Heat::Fuel { excess_air, stoichiometric_ratio, heating_value } => vec![
                ("excess_air", excess_air),
                ("stoichiometric_ratio", stoichiometric_ratio),
                ("heating_value", heating_value),
            ],
        };
        figures.extend([
            ("start_deg", self.start_deg),
            ("duration_deg", self.duration_deg),
            ("a", self.a),
            ("m", self.m),
            ("gamma", self.gamma),
            ("intake_pressure", self.intake_pressure),
            ("exhaust_pressure", self.exhaust_pressure),
            ("charge_temperature", self.charge_temperature),
            ("intake_closes_deg", self.intake_closes_deg),
            ("exhaust_opens_deg", self.exhaust_opens_deg),
        ]);
        if let Some(wall) = &self.wall {
            figures.extend([("wall_temperature", wall.temperature), ("rpm", wall.rpm)]);
        }
        figures
    }

    /// The cycle: p·V^γ by collocation at Chebyshev points, panels halved until exact to rounding.
    ///
    /// From exhaust opening to the piston's lowest point pressure falls as a cosine to that of the
    /// exhaust, or of the intake in a two-stroke.
    pub fn cycle(&self, chamber: &Chamber, name: String, cancel: &Cancel) -> Result<Cycle> {
        self.check(chamber)?;
        let (from, to) = (self.intake_closes_deg, self.exhaust_opens_deg);
        let ratio = chamber.ratio(from);
        let charge = self.intake_pressure * ratio * chamber.clearance();
        let joules = match self.heat {
            Heat::Given(joules) => limits::not_negative("heat", joules)?,
            Heat::Fuel { excess_air, stoichiometric_ratio, heating_value } => {
                within("excess_air", excess_air, 0.1, 1000.0)?;
                within("stoichiometric_ratio", stoichiometric_ratio, 0.1, 100.0)?;
                within("heating_value", heating_value, 1e5, 2e8)?;
                let air = charge / (AIR * self.charge_temperature);
                air / (excess_air * stoichiometric_ratio) * heating_value
            }
        };
        let heat = joules / (self.intake_pressure * chamber.clearance());
        let closed = Closed { wiebe: self, chamber, heat, ratio };
        let mut curves = Curves::default();
        let mut state = ratio.powf(self.gamma);
        let end = (self.start_deg + self.duration_deg).min(to);
        // Pressure bends where the burn begins and ends.
        for (low, high, burns) in [
            (from, self.start_deg, None),
            (self.start_deg, end, Some(true)),
            (end, to, Some(false)),
        ] {
            state = closed.integrate(low, high, burns, state, &mut curves, cancel)?;
        }
        let opened = self.intake_pressure * state / chamber.ratio(to).powf(self.gamma);
        let (period, four) = (period_deg(chamber.strokes), chamber.strokes == Strokes::Four);
        let after = if four { self.exhaust_pressure } else { self.intake_pressure };
        let fall = 180.0 / (chamber.bottom - to);
        curves.add(to, chamber.bottom, |angle| {
            after + 0.5 * (opened - after) * (1.0 + (fall * (angle - to)).to_radians().cos())
        })?;
        let exchange = chamber.top + 360.0;
        if four {
            curves.add(chamber.bottom, exchange, |_| self.exhaust_pressure)?;
        }
        let intake = if four { exchange } else { chamber.bottom };
        curves.add(intake, from + period, |_| self.intake_pressure)?;
        curves.cycle(name, chamber.strokes)
    }

    fn check(&self, chamber: &Chamber) -> Result<()> {
        let top = chamber.top;
        let lowest = [chamber.bottom - 360.0, chamber.bottom];
        within("intake_closes_deg", self.intake_closes_deg, lowest[0], top - 1.0)?;
        within("exhaust_opens_deg", self.exhaust_opens_deg, top + 1.0, lowest[1] - 1.0)?;
        within("start_deg", self.start_deg, self.intake_closes_deg, self.exhaust_opens_deg)?;
        within("duration_deg", self.duration_deg, 0.1, 360.0)?;
        within("a", self.a, 0.1, 100.0)?;
        within("m", self.m, 0.0, 20.0)?;
        exponent("gamma", self.gamma)?;
        absolute("intake_pressure", self.intake_pressure)?;
        absolute("exhaust_pressure", self.exhaust_pressure)?;
        within("charge_temperature", self.charge_temperature, 50.0, 2000.0)?;
        if let Some(wall) = &self.wall {
            within("wall_temperature", wall.temperature, 50.0, 2000.0)?;
            within("rpm", wall.rpm, 1.0, 1e6)?;
        }
        Ok(())
    }

    /// dx/dθ of the burnt fraction x = 1 − e^{−a·y^{m+1}}, per degree.
    fn burn_rate(&self, angle: f64) -> f64 {
        let y = ((angle - self.start_deg) / self.duration_deg).max(0.0);
        let power = y.powf(self.m);
        self.a * (self.m + 1.0) * power * (-self.a * power * y).exp() / self.duration_deg
    }
}

impl Closed<'_> {
    /// Integrate y = p·V^γ, in intake pressures and clearance volumes, from `low` to `high`; add its
    /// panels. `burns` is none before the burn, and whether it lasts after that.
    fn integrate(
        &self,
        low: f64,
        high: f64,
        burns: Option<bool>,
        start: f64,
        curves: &mut Curves,
        cancel: &Cancel,
    ) -> Result<f64> {
        let mut state = start;
        let mut parts = if high > low { vec![(low, high)] } else { Vec::new() };
        while let Some((low, high)) = parts.pop() {
            cancel.check()?;
            let ratios: Vec<f64> =
                points(low, high, DEGREE).map(|angle| self.chamber.ratio(angle)).collect();
            let narrow = high - low < NARROWEST;
            match self.panel(low, high, burns, state, &ratios) {
                Some((values, resolved)) if resolved || narrow => {
                    let gamma = self.wiebe.gamma;
                    let pressure: Vec<f64> = values
                        .iter()
                        .zip(&ratios)
                        .map(|(y, ratio)| self.wiebe.intake_pressure * y / ratio.powf(gamma))
                        .collect();
                    if narrow || is_resolved(&pressure) {
                        curves.panel(low, high, &pressure)?;
                        state = values[DEGREE];
                        continue;
                    }
                }
                None if narrow => {
                    let hint = "pressure has no finite course: give less heat, or a higher wall_temperature";
                    return Err(Error::figure("start_deg", self.wiebe.start_deg, hint));
                }
                _ => {}
            }
            let middle = 0.5 * (low + high);
            parts.extend([(middle, high), (low, middle)]);
        }
        Ok(state)
    }

    /// y at the points of a panel, and whether its slope is resolved there; none if the iteration does
    /// not converge.
    fn panel(
        &self,
        low: f64,
        high: f64,
        burns: Option<bool>,
        start: f64,
        ratios: &[f64],
    ) -> Option<(Vec<f64>, bool)> {
        let half = 0.5 * (high - low);
        let burnt: Vec<f64> =
            points(low, high, DEGREE)
                .map(|angle| {
                    if burns == Some(true) { self.heat * self.wiebe.burn_rate(angle) } else { 0.0 }
                })
                .collect();
        let gamma = self.wiebe.gamma;
        let mut values = vec![start; DEGREE + 1];
        for _ in 0..MOST_ITERATIONS {
            let slopes: Vec<f64> = (0..=DEGREE)
                .map(|k| {
                    let lost = self.wall_loss(values[k], ratios[k], burns.is_some());
                    (gamma - 1.0) * ratios[k].powf(gamma - 1.0) * (burnt[k] - lost)
                })
                .collect();
            let next = INTEGRALS.iter().map(|row| {
                start + half * row.iter().zip(&slopes).map(|(w, slope)| w * slope).sum::<f64>()
            });
            let next: Vec<f64> = next.collect();
            let largest = next.iter().fold(0.0, |largest: f64, y| largest.max(y.abs()));
            let change =
                next.iter().zip(&values).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            if !largest.is_finite() || next.iter().any(|&y| y <= 0.0) {
                return None;
            }
            values = next;
            if change <= 4.0 * f64::EPSILON * largest {
                let resolved =
                    half * largest_of_last(&slopes) <= RESOLVED * largest * DEGREE as f64;
                return Some((values, resolved));
            }
        }
        None
    }

    /// Heat to the wall per degree, over `p_i·V_c`, at y and a volume.
    fn wall_loss(&self, state: f64, ratio: f64, ignited: bool) -> f64 {
        let Some(wall) = &self.wiebe.wall else { return 0.0 };
        let (wiebe, chamber) = (self.wiebe, self.chamber);
        let pressure = state / ratio.powf(wiebe.gamma);
        let temperature = wiebe.charge_temperature * pressure * ratio / self.ratio;
        let speed = 2.0 * chamber.stroke * wall.rpm / 60.0;
        let motored = (self.ratio / ratio).powf(wiebe.gamma);
        let displaced = chamber.compression_ratio - 1.0;
        let by_burn = if ignited {
            3.24e-3 * displaced * wiebe.charge_temperature / self.ratio
                * (pressure - motored).max(0.0)
        } else {
            0.0
        };
        let velocity = 2.28 * speed + by_burn;
        let film = 3.26
            * chamber.bore.powf(-0.2)
            * (1e-3 * wiebe.intake_pressure * pressure).powf(0.8)
            * temperature.powf(-0.55)
            * velocity.powf(0.8);
        // Head, piston crown, and the liner's height as that of a disc of the same volume.
        let volume = ratio * chamber.clearance();
        let surface = 2.0 * chamber.area() + 4.0 * volume / chamber.bore;
        let per_degree = 1.0 / (6.0 * wall.rpm);
        film * surface * (temperature - wall.temperature) * per_degree
            / (wiebe.intake_pressure * chamber.clearance())
    }
}

/// Weights of values at ascending Chebyshev points for the integral from −1 to each of them.
static INTEGRALS: LazyLock<Vec<Vec<f64>>> = LazyLock::new(|| {
    let points: Vec<f64> = (0..=DEGREE).map(|k| -node(k, DEGREE)).collect();
    let mut rows = vec![vec![0.0; DEGREE + 1]; DEGREE + 1];
    for j in 0..=DEGREE {
        let mut unit = vec![0.0; DEGREE + 1];
        unit[j] = 1.0;
        for n in 0..=DEGREE {
            let c = coefficient(&unit, n);
            for (row, &x) in rows.iter_mut().zip(&points) {
                row[j] += c * (antiderivative(n, x) - antiderivative(n, -1.0));
            }
        }
    }
    rows
});

/// An antiderivative of the Chebyshev polynomial `T_n`.
fn antiderivative(n: usize, x: f64) -> f64 {
    let chebyshev = |n: usize| (n as f64 * x.clamp(-1.0, 1.0).acos()).cos();
    match n {
        0 => x,
        1 => 0.5 * x * x,
        _ => 0.5 * (chebyshev(n + 1) / (n + 1) as f64 - chebyshev(n - 1) / (n - 1) as f64),
    }
}
