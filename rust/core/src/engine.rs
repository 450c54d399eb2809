//! An engine is where its cylinders sit: when each is at top dead centre, which way its bore
//! points, where along the crank it is, and what turns with its crankpin.

use crate::angle::Angle;
use crate::error::{Error, Result};
use crate::limits;
use crate::slider_crank::Cylinder;

/// One cylinder in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Its moving parts.
    pub cylinder: Cylinder,
    /// Crank angle at which its crankpin points along its bore.
    pub tdc: Angle,
    /// Direction of its bore, from +x.
    pub bank: Angle,
    /// Place along the crank, from the front, m.
    pub z: f64,
    /// Mass that turns at crank radius with its crankpin, kg.
    pub rotating_mass: f64,
}

impl Placement {
    /// Direction of its crankpin, from +x, at θ = 0.
    #[must_use]
    pub fn pin(&self) -> Angle {
        (self.bank - self.tdc).reduced()
    }
}

/// What a change of bank angle leaves as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// The crank: crankpins keep their angles and the firing intervals change (the IJESC paper).
    Pins,
    /// The firing: every top dead centre stays and the pins are split as needed (Ito, Hattori).
    Firing,
}

/// Directions of the two banks of a vee.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Banks {
    /// The bank at x > 0 where the vee stands upright.
    pub right: Angle,
    /// The other, up to 180° ahead of it.
    pub left: Angle,
}

impl Banks {
    /// Angle between the banks, up to 180°.
    #[must_use]
    pub fn angle(&self) -> Angle {
        (self.left - self.right).reduced()
    }

    /// Direction half-way from the right bank to the left.
    #[must_use]
    pub fn bisector(&self) -> Angle {
        (self.right + self.angle().half()).reduced()
    }
}

/// Cylinders, in the order of their numbers, at their places on one crankshaft.
#[derive(Debug, Clone, PartialEq)]
pub struct Engine {
    name: String,
    source: String,
    placements: Vec<Placement>,
}

impl Engine {
    /// From one placement for each cylinder; angles are reduced to one turn.
    pub fn new(
        name: impl Into<String>,
        source: impl Into<String>,
        mut placements: Vec<Placement>,
    ) -> Result<Self> {
        let count = placements.len();
        if count == 0 || count > limits::MOST_CYLINDERS {
            let cure = format!("an engine has 1 to {} cylinders", limits::MOST_CYLINDERS);
            return Err(Error::value("number of cylinders", count, cure));
        }
        let (name, source) = (name.into(), source.into());
        for (argument, text) in [("name", &name), ("source", &source)] {
            if text.len() > limits::LONGEST_NAME {
                let cure = format!("give {} bytes at most", limits::LONGEST_NAME);
                return Err(Error::value(argument, text, cure));
            }
        }
        for (i, placement) in placements.iter_mut().enumerate() {
            limits::finite(&format!("z[{i}]"), placement.z)?;
            limits::not_negative(&format!("rotating_mass[{i}]"), placement.rotating_mass)?;
            placement.tdc = placement.tdc.reduced();
            placement.bank = placement.bank.reduced();
        }
        Ok(Self { name, source, placements })
    }

    /// What people call it; may be empty.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Where its layout is from; may be empty.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.source
    }

    /// The cylinders, by number.
    #[must_use]
    pub fn placements(&self) -> &[Placement] {
        &self.placements
    }

    /// z midway between the first and the last cylinder: the default reference plane.
    #[must_use]
    pub fn middle(&self) -> f64 {
        let (first, last) = self
            .placements
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(first, last), placement| {
                (first.min(placement.z), last.max(placement.z))
            });
        f64::midpoint(first, last)
    }

    /// The reference plane asked for, or the default one.
    pub fn reference(&self, z: Option<f64>) -> Result<f64> {
        z.map_or_else(|| Ok(self.middle()), |z| limits::finite("reference_z", z))
    }

    /// Longest lever about a reference plane, m.
    #[must_use]
    pub fn longest_lever(&self, reference: f64) -> f64 {
        self.placements.iter().map(|p| (p.z - reference).abs()).fold(0.0, f64::max)
    }

    /// Largest crank radius of any cylinder, m.
    #[must_use]
    pub fn largest_crank_radius(&self) -> f64 {
        self.placements.iter().map(|p| p.cylinder.crank_radius()).fold(0.0, f64::max)
    }

    /// Directions of the banks of an engine that has two.
    pub fn banks(&self) -> Result<Banks> {
        let mut directions: Vec<Angle> = Vec::new();
        for placement in &self.placements {
            if !directions.contains(&placement.bank) {
                directions.push(placement.bank);
            }
        }
        let [first, second] = directions[..] else {
            let listed: Vec<String> = directions.iter().map(|d| format!("{d}°")).collect();
            return Err(Error::value(
                "bank_angle_deg",
                format!("of an engine with bores along {}", listed.join(", ")),
                "the bank angle of an engine with exactly two banks can be changed",
            ));
        };
        let (right, left) = if (second - first).reduced().degrees() <= 180.0 {
            (first, second)
        } else {
            (second, first)
        };
        // 0° and 180° in whichever order they come: the flat engine's right bank points along +x.
        if (left - right).reduced().degrees() == 180.0 && right.degrees() >= 180.0 {
            return Ok(Banks { right: left, left: right });
        }
        Ok(Banks { right, left })
    }

    /// The same engine with its two banks at another angle about the same bisector.
    pub fn with_bank_angle(&self, bank_angle: Angle, hold: Hold) -> Result<Self> {
        bank_angle_in_range(bank_angle.degrees())?;
        let banks = self.banks()?;
        let (middle, half) = (banks.bisector(), bank_angle.half());
        let placements = self.placements.iter().map(|placement| {
            let bank = if placement.bank == banks.right { middle - half } else { middle + half };
            let tdc = match hold {
                Hold::Pins => bank - placement.pin(),
                Hold::Firing => placement.tdc,
            };
            Placement { tdc, bank, ..*placement }
        });
        Self::new(self.name.clone(), self.source.clone(), placements.collect())
    }

    /// The same engine with its whole crank turned so that the first cylinder is at top dead
    /// centre at this crank angle.
    pub fn with_first_tdc(&self, tdc: Angle) -> Result<Self> {
        let turn = tdc - self.placements[0].tdc;
        let placements =
            self.placements.iter().map(|p| Placement { tdc: p.tdc + turn, ..*p }).collect();
        Self::new(self.name.clone(), self.source.clone(), placements)
    }

    /// The same engine under another name.
    pub fn named(&self, name: impl Into<String>, source: impl Into<String>) -> Result<Self> {
        Self::new(name, source, self.placements.clone())
    }
}

/// A bank angle from 0° to 180°.
pub fn bank_angle_in_range(degrees: f64) -> Result<f64> {
    if (0.0..=180.0).contains(&degrees) {
        return Ok(degrees);
    }
    Err(Error::figure("bank_angle_deg", degrees, "give degrees between 0 and 180"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degrees(degrees: f64) -> Angle {
        Angle::from_degrees(degrees).unwrap()
    }

    fn vee(right: f64, left: f64) -> Engine {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let place = |bank: f64, tdc: f64, z| Placement {
            cylinder,
            tdc: degrees(tdc),
            bank: degrees(bank),
            z,
            rotating_mass: 0.0,
        };
        Engine::new("", "", vec![place(left, 30.0, 0.0), place(right, 0.0, 0.1)]).unwrap()
    }

    #[test]
    fn banks_are_told_apart_in_any_order() {
        let banks = vee(60.0, 120.0).banks().unwrap();
        assert_eq!((banks.right, banks.left), (degrees(60.0), degrees(120.0)));
        assert_eq!(banks.bisector(), degrees(90.0));
        assert_eq!(vee(0.0, 180.0).banks().unwrap().right, degrees(0.0));
        assert_eq!(vee(350.0, 10.0).banks().unwrap().bisector(), degrees(0.0));
        assert!(vee(90.0, 90.0).banks().is_err());
        // Opposite bores, whichever comes first; and two that only add up to half a turn more.
        for (a, b) in [(90.0, 270.0), (270.0, 90.0)] {
            let banks = vee(a, b).banks().unwrap();
            assert_eq!((banks.right, banks.left), (degrees(90.0), degrees(270.0)));
        }
        let banks = vee(200.0, 340.0).banks().unwrap();
        assert_eq!((banks.right, banks.left), (degrees(200.0), degrees(340.0)));
    }

    #[test]
    fn what_is_held_is_held() {
        let engine = vee(60.0, 120.0);
        let by_pins = engine.with_bank_angle(degrees(90.0), Hold::Pins).unwrap();
        let by_firing = engine.with_bank_angle(degrees(90.0), Hold::Firing).unwrap();
        for (before, after) in engine.placements().iter().zip(by_pins.placements()) {
            assert_eq!(before.pin(), after.pin());
        }
        for (before, after) in engine.placements().iter().zip(by_firing.placements()) {
            assert_eq!(before.tdc, after.tdc);
        }
        assert_eq!(by_pins.banks().unwrap().angle(), degrees(90.0));
        // Each cylinder stays on its side.
        let bores: Vec<f64> = by_pins.placements().iter().map(|p| p.bank.degrees()).collect();
        assert_eq!(bores, [135.0, 45.0]);
    }

    #[test]
    fn an_engine_tells_what_it_is_made_of() {
        let engine = vee(60.0, 120.0).named("V2", "a drawing").unwrap();
        assert_eq!((engine.name(), engine.source()), ("V2", "a drawing"));
        assert_eq!((engine.middle(), engine.largest_crank_radius()), (0.05, 0.05));
        assert_eq!(engine.longest_lever(0.0), 0.1);
        assert_eq!((engine.longest_lever(0.25), engine.longest_lever(-0.25)), (0.25, 0.35));
        assert_eq!(vee(180.0, 0.0).banks().unwrap().right, degrees(0.0));
        for angle in [0.0, 45.0, 180.0] {
            assert_eq!(bank_angle_in_range(angle), Ok(angle));
        }
        for angle in [-1e-9, 180.1, f64::NAN] {
            assert!(bank_angle_in_range(angle).is_err());
        }
    }

    #[test]
    fn turning_back_gives_the_same_engine() {
        let engine = vee(60.0, 120.0);
        let turned = engine.with_first_tdc(degrees(17.3)).unwrap();
        assert_eq!(turned.placements()[0].tdc, degrees(17.3));
        assert_eq!(turned.placements()[1].tdc, degrees(17.3 - 30.0).reduced());
        assert_eq!(turned.with_first_tdc(degrees(30.0)).unwrap(), engine);
    }
}
