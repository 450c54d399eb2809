//! Engines of several cranks, put together of engines.

use super::banks::Hold;
use super::shaft::check_rotation;
use super::{Crank, CrankIndex, Engine, LinkRod, Shaft, Station, Unbalance};
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::ListIndex;
use crate::numbers::ratio::SpeedRatio;

/// An engine as a part of one of several cranks.
#[derive(Debug, Clone, PartialEq)]
pub struct EngineOnCrank<'a> {
    /// The engine.
    pub engine: &'a Engine,
    /// Axis of its main crank, and the speed of that over the whole engine's main crank.
    pub crank: Crank,
    /// Crank angle of the whole engine's main crank at which its own is zero.
    pub delay: Angle,
    /// How far it is turned about the axis of its main crank, in the direction of rotation.
    pub tilt: Angle,
    /// How far it stands behind its own places, towards the flywheel, m.
    pub z: f64,
}

impl Engine {
    /// One engine of several, whose cylinders are numbered in their order.
    ///
    /// A crank that turns the other way holds either its crankpins, which makes it the same engine turning
    /// backwards, or its firing: then each cylinder is at top dead centre when it was, and crankpins are mirrored
    /// at their bores.
    ///
    /// ```
    /// use crankpin_core::engine::{Crank, EngineOnCrank, Hold};
    /// use crankpin_core::engine::file::from_toml;
    /// use crankpin_core::{Angle, Engine, SpeedRatio};
    ///
    /// let single = from_toml(
    ///     "schema = 1
    ///     cylinder = { crank_radius = 0.043, rod_length = 0.145, reciprocating_mass = 0.66 }
    ///     placements = [{ tdc_deg = 0, bank_deg = 90, z = 0 }]",
    /// )?;
    /// let on = |crank| EngineOnCrank {
    ///     engine: &single, crank, delay: Angle::ZERO, tilt: Angle::ZERO, z: 0.0,
    /// };
    /// let against = Crank { axis: [0.2, 0.0], ratio: SpeedRatio::whole(-1) };
    /// let twin = Engine::on_cranks(&[on(Crank::MAIN), on(against)], Hold::Pins)?;
    /// assert_eq!((twin.stations().len(), twin.cranks().len()), (2, 2));
    /// # Ok::<(), crankpin_core::Error>(())
    /// ```
    pub fn on_cranks(parts: &[EngineOnCrank], hold: Hold) -> Result<Self> {
        let Some(first) = parts.first() else {
            return Err(Error::value("engines", "[]", "give at least one"));
        };
        let strokes = first.engine.strokes;
        let (mut stations, mut banks, mut details) = (Vec::new(), Vec::new(), Vec::new());
        let (mut cranks, mut crank_of) = (Vec::new(), Vec::new());
        let (mut counterweights, mut shafts) = (Vec::new(), Vec::new());
        let mut link_rods = Vec::new();
        for (k, part) in parts.iter().enumerate() {
            part.check(k, strokes == part.engine.strokes, hold)?;
            let [cylinders, bank, crank] =
                [stations.len(), banks.iter().max().map_or(0, |most| most + 1), cranks.len()];
            cranks.extend(part.cranks(k)?);
            let engine = part.engine;
            for (i, station) in engine.stations.iter().enumerate() {
                let own = crank + engine.crank_of[i].position();
                let is_backwards = part.is_mirrored(hold);
                let gear = station.cylinder;
                stations.push(Station {
                    // The side to which the crankpin swings is the other one.
                    cylinder: if is_backwards { gear.mirrored() } else { gear },
                    tdc: part.tdc(i, cranks[own], hold),
                    bank: station.bank + part.tilt,
                    z: station.z + part.z,
                    ..*station
                });
                banks.push(bank + engine.bank_of[i]);
                crank_of.push(own);
            }
            details.extend_from_slice(&engine.details);
            let link = |link: LinkRod| LinkRod { master: link.master + cylinders, ..link };
            link_rods.extend(engine.link_rods.iter().map(|own| own.map(link)));
            for weight in &engine.counterweights {
                counterweights.push(part.counterweight(k, weight, [cylinders, crank], hold)?);
            }
            for shaft in &engine.shafts {
                shafts.push(part.shaft(k, shaft)?);
            }
        }
        Engine::in_banks("", "", stations, &banks)?
            .firing_as("", strokes)?
            .with_cranks(cranks, crank_of)?
            .with_details(details)?
            .with_link_rods(link_rods)?
            .with_counterweights(counterweights)?
            .with_shafts(shafts)
    }
}

impl EngineOnCrank<'_> {
    /// Whether its main crank turns as the whole engine's.
    fn is_forward(&self) -> bool {
        self.crank.ratio.is_forward()
    }

    /// Whether it is the same engine turning backwards.
    fn is_mirrored(&self, hold: Hold) -> bool {
        !self.is_forward() && hold == Hold::Pins
    }

    /// Rejects what has no meaning in an engine of several cranks.
    fn check(&self, k: usize, has_same_strokes: bool, hold: Hold) -> Result<()> {
        let engine = self.engine;
        check_rotation(&format!("cranks[{k}]."), self.crank.ratio, self.crank.axis)?;
        let fault = |what: &str, value: &str, hint: &str| {
            Err(Error::value(format!("engines[{k}].{what}"), value, hint))
        };
        if !has_same_strokes {
            return fault(
                "strokes",
                &engine.strokes.number().to_string(),
                "all parts need the first one's",
            );
        }
        if engine.spectrum.is_some() {
            return fault(
                "spectrum",
                "given",
                "leave it out: a spectrum is one of all cylinders of an engine",
            );
        }
        if engine.gas.is_some() {
            return fault(
                "cycle",
                "given",
                "leave it out; the whole engine takes a cycle, and its own firing order",
            );
        }
        if !engine.loads.is_empty() {
            return fault("loads", "given", "leave them out; the whole engine takes loads");
        }
        if !engine.mains.is_empty() {
            return fault("mains", "given", "leave them out; the whole engine takes main bearings");
        }
        if engine.has_link_rods() && !self.is_forward() && hold == Hold::Firing {
            let hint = "hold the pins: where firing is held on a crank that turns the other way, crankpins are \
                        mirrored, each at its own bore, and link rods leave that of their master";
            return fault("link_rods", "given", hint);
        }
        let is_free = engine.counterweights.iter().any(|weight| weight.pin.is_none());
        if !self.is_forward() && hold == Hold::Firing && (is_free || !engine.shafts.is_empty()) {
            let hint = "hold the pins, or leave them out: where firing is held on a crank that turns the other \
                        way, crankpins are mirrored, and weights that follow none have no place";
            return fault("counterweights or shafts", "given", hint);
        }
        Ok(())
    }

    /// Its cranks in the whole engine.
    fn cranks(&self, k: usize) -> Result<Vec<Crank>> {
        let place = |own: &Crank| {
            let ratio = self.ratio(k, own.ratio)?;
            Ok(Crank { axis: self.axis(own.axis), ratio })
        };
        self.engine.cranks.iter().map(place).collect()
    }

    /// A speed over that of the whole engine's main crank, of one over its own.
    fn ratio(&self, k: usize, own: SpeedRatio) -> Result<SpeedRatio> {
        let halves = self.crank.ratio.halves() * own.halves();
        if halves % 2 == 0 {
            return Ok(SpeedRatio::from_halves(halves / 2));
        }
        let hint =
            format!("give a multiple of 1/2 times {own}, the ratio of a shaft of this engine");
        Err(Error::value(format!("cranks[{k}].ratio"), self.crank.ratio, hint))
    }

    /// A place in the cross-section, of one from the axis of its main crank.
    fn axis(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let turned = self.tilt.cis(1);
        let [from_x, from_y] = self.crank.axis;
        [from_x + x * turned.re - y * turned.im, from_y + x * turned.im + y * turned.re]
    }

    /// Crank angle of top dead centre, on a crank of the whole engine.
    fn tdc(&self, cylinder: usize, crank: Crank, hold: Hold) -> Angle {
        let station = &self.engine.stations[cylinder];
        if self.is_mirrored(hold) {
            return crank.tdc(station.bank, self.engine.pin(cylinder)) + self.delay;
        }
        station.tdc.times(2).over(self.crank.ratio.halves().abs()) + self.delay
    }

    /// Direction at θ = 0, of one that had another when its own main crank was at zero.
    fn direction(&self, angle: Angle, ratio: SpeedRatio) -> Angle {
        (angle + self.tilt - ratio.turned(self.delay)).reduced()
    }

    /// A weight of it, behind these numbers of cylinders and cranks.
    fn counterweight(
        &self,
        k: usize,
        weight: &Unbalance,
        [cylinders, cranks]: [usize; 2],
        hold: Hold,
    ) -> Result<Unbalance> {
        let z = weight.z + self.z;
        if let Some(pin) = weight.pin {
            // Ahead of its pin in the direction in which that turns now.
            let angle = if self.is_mirrored(hold) { -weight.angle } else { weight.angle };
            return Ok(Unbalance { angle, z, pin: Some(pin + cylinders), ..*weight });
        }
        let ratio = self.ratio(k, self.engine.cranks[weight.crank].ratio)?;
        let crank = CrankIndex::new(weight.crank.position() + cranks);
        Ok(Unbalance { angle: self.direction(weight.angle, ratio), z, crank, ..*weight })
    }

    fn shaft(&self, k: usize, shaft: &Shaft) -> Result<Shaft> {
        let ratio = self.ratio(k, shaft.ratio)?;
        let unbalance = |unbalance: &Unbalance| {
            let angle = self.direction(unbalance.angle, ratio);
            Unbalance { angle, z: unbalance.z + self.z, ..*unbalance }
        };
        let unbalances = shaft.unbalances.iter().map(unbalance).collect();
        Ok(Shaft { axis: self.axis(shaft.axis), ratio, unbalances, name: shaft.name.clone() })
    }
}
