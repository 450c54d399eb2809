//! Link rods: rods that hang on the master rod of another cylinder, at a knuckle beside the crankpin.

use std::sync::Arc;

use super::{Engine, check_each_cylinder};
use crate::Complex64;
use crate::mechanism::Mechanism;
pub use crate::mechanism::articulated::equal::EqualTravel;
use crate::mechanism::articulated::{HAS_LINK_RODS, Knuckle, RunningGear};
use crate::mechanism::motion::CrankPosition;
use crate::numbers::angle::{Angle, cis_degrees};
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::ratio::SpeedRatio;

/// Where the rod of a cylinder hangs on the master rod of another; its length is that of the cylinder's rod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkRod {
    /// Index of the cylinder of the master rod.
    pub master: usize,
    /// Distance of the knuckle from the crankpin, m.
    pub radius: f64,
    /// Angle of the knuckle from the master's shank, counter-clockwise as directions of bores.
    pub angle: Angle,
    /// Mass of the link rod at the knuckle, kg; the rest of it moves with the piston.
    pub big_end_mass: f64,
}

/// Link rods on every crankpin that cylinders share with that of a master rod.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkRods {
    /// Distance of the knuckles from the crankpin, m; none where it is solved for.
    pub radius: Option<f64>,
    /// Length of the link rods, m; none for those of the cylinders' rods.
    pub length: Option<f64>,
    /// Angles of the knuckles from the master's shank, counter-clockwise, in the order of the cylinders that have link
    /// rods; none for those between the bores, or where they are solved for.
    pub angles: Option<Vec<Angle>>,
    /// Mass of each link rod at its knuckle, kg; none for the big end of the cylinder's rod.
    pub big_end_mass: Option<f64>,
    /// What knuckles are solved for.
    pub equal: Option<EqualTravel>,
}

impl LinkRods {
    /// Rejects figures that are solved for, and the lack of others.
    fn check(&self) -> Result<()> {
        let solved = "it is solved for with `equal`: leave it out";
        if self.angles.is_some() && self.equal.is_some() {
            return Err(Error::value("angles_deg", "given", solved));
        }
        let is_solved = self.equal == Some(EqualTravel::Compression);
        match self.radius {
            Some(radius) if is_solved => Err(Error::figure("radius", radius, solved)),
            None if !is_solved => {
                let hint = "give the distance of the knuckles from the crankpin, m, or let equal compression solve for it";
                Err(Error::value("radius", "None", hint))
            }
            _ => Ok(()),
        }
    }
}

/// Ends of the travel of a piston.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeadCentres {
    /// Angles of the main crank at which the piston is highest and lowest, degrees, in a turn.
    pub angles_deg: [f64; 2],
    /// Distance of the piston pin from the axis of its crank along the bore where it is highest, m; of an infinite rod
    /// from the middle of the stroke.
    pub height: f64,
    /// Travel of the piston, m.
    pub stroke: f64,
    /// Ratio of largest to smallest volume, where that of the first cylinder is given: of equal pistons below heads
    /// that are equally far from the crank.
    pub compression_ratio: Option<f64>,
}

/// The mass at a knuckle, whose motion is (1 − k) times that of the crankpin and k times that of the master's wrist
/// pin, k = a·e^{iψ}/l.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct KnuckleMass {
    /// Index of the master's cylinder.
    pub master: usize,
    /// kg.
    pub mass: f64,
    /// |k|.
    pub share: f64,
    /// ψ, in the sense in which the crank turns.
    pub angle: Angle,
}

impl KnuckleMass {
    /// The part, kg, that moves as the master's wrist pin, as a vector from the crankpin's direction in the sense of
    /// the crank.
    pub fn reciprocating(&self) -> Complex64 {
        self.angle.cis(1) * (self.mass * self.share)
    }
}

impl Engine {
    /// Where the rod of each cylinder hangs; none of rods on their crankpin.
    #[must_use]
    pub fn link_rods(&self) -> &[Option<LinkRod>] {
        &self.link_rods
    }

    /// Whether it has link rods.
    #[must_use]
    pub fn has_link_rods(&self) -> bool {
        self.link_rods.iter().any(Option::is_some)
    }

    /// The same engine with rods of its cylinders hung on those of others, one entry for each cylinder.
    ///
    /// A master rod and its links are on one crankpin and in one plane.
    pub fn with_link_rods(&self, link_rods: Vec<Option<LinkRod>>) -> Result<Self> {
        check_each_cylinder("link_rods", link_rods.len(), self.stations.len())?;
        let linked = Self { link_rods, ..self.clone() };
        linked.check_link_rods()?;
        linked.with_known_torque()
    }

    /// The same engine with master rods in these cylinders, by default in the first of each crankpin that several
    /// share, and link rods in those beside them. The big end of a link rod's cylinder no longer turns with the
    /// crankpin.
    pub fn with_master_rods(&self, rods: &LinkRods, masters: Option<&[usize]>) -> Result<Self> {
        rods.check()?;
        let count = self.stations.len();
        let pins = || self.crankpins().into_iter().map(|pin| pin.cylinders);
        let shared: Vec<Vec<usize>> = pins().filter(|cylinders| cylinders.len() > 1).collect();
        let first: Vec<usize> = shared.iter().map(|cylinders| cylinders[0]).collect();
        let masters = masters.unwrap_or(&first);
        let mut master_of = vec![None; count];
        for &master in masters {
            let Some(pin) = shared.iter().find(|cylinders| cylinders.contains(&master)) else {
                let hint = "give the number of a cylinder that shares its crankpin with others";
                return Err(Error::value("master", master + 1, hint));
            };
            for &i in pin.iter().filter(|&&i| i != master) {
                if masters.contains(&i) {
                    let hint = format!("cylinder {} is on the same crankpin: give one", master + 1);
                    return Err(Error::value("master", i + 1, hint));
                }
                master_of[i] = Some(master);
            }
        }
        let links: Vec<usize> = (0..count).filter(|&i| master_of[i].is_some()).collect();
        if links.is_empty() {
            let hint = "no cylinders share a crankpin, as they do in a radial or a vee";
            return Err(Error::value("rods", "given", hint));
        }
        if let Some(angles) = &rods.angles {
            limits::same_length("angles_deg", angles.len(), "the engine", links.len(), "link rod")?;
        }
        let (mut engine, mut link_rods) = (self.clone(), vec![None; count]);
        for (k, &i) in links.iter().enumerate() {
            let Some(master) = master_of[i] else { continue };
            let own_angle = (self.stations[i].bank - self.stations[master].bank).reduced();
            let angle = rods.angles.as_ref().map_or(own_angle, |angles| angles[k]);
            let (station, details) = (&mut engine.stations[i], &mut engine.details[i]);
            let big_end = details.big_end(station.cylinder.rod_length())?;
            let big_end_mass = rods.big_end_mass.unwrap_or(big_end);
            if station.rotating_mass == big_end {
                station.rotating_mass = 0.0;
            }
            if let Some(length) = rods.length.filter(|&own| own != station.cylinder.rod_length()) {
                station.cylinder = station.cylinder.with_rod_length(length)?;
                // Those of a rod of another length.
                (details.rod, details.piston_mass) = (None, None);
            }
            let length = station.cylinder.rod_length();
            let nominal = self.stations[master].cylinder.rod_length() - length;
            let radius = rods.radius.unwrap_or(nominal);
            if radius < 0.0 {
                let hint = "with equal compression link rods are shorter than their master's rod: give less";
                return Err(Error::figure("length", length, hint));
            }
            link_rods[i] = Some(LinkRod { master, radius, angle, big_end_mass });
        }
        engine.number_cylinders();
        let linked = engine.with_link_rods(link_rods)?;
        match rods.equal {
            Some(equal) => linked.equalised(equal),
            None => Ok(linked),
        }
    }

    /// The same engine with knuckles solved for, near its own.
    fn equalised(&self, equal: EqualTravel) -> Result<Self> {
        let mut link_rods = self.link_rods.clone();
        for (i, link) in link_rods.iter_mut().enumerate() {
            let (Some(link), Some(knuckle)) = (link, self.knuckle(i)) else { continue };
            let DeadCentres { height, stroke, .. } = self.ends_of(link.master);
            let solved = knuckle.equalised(&self.stations[i].cylinder, equal, [height, stroke])?;
            let Some(solved) = solved else {
                let what = match equal {
                    EqualTravel::Stroke => "the stroke",
                    EqualTravel::Compression => "height and stroke",
                };
                let hint = format!(
                    "no knuckle near its bore gives the piston of cylinder {} {what} of cylinder {}: give other \
                     lengths, or `angles_deg`",
                    i + 1,
                    link.master + 1
                );
                return Err(Error::value("equal", format!("{:?}", equal.word()), hint));
            };
            if solved != knuckle {
                link.radius = solved.radius;
                link.angle = self.seen(i, solved.angle).reduced();
            }
        }
        self.with_link_rods(link_rods)
    }

    /// Ends of the travel of each piston, and compression ratios by that of the first cylinder.
    pub fn dead_centres(&self, compression_ratio: Option<f64>) -> Result<Vec<DeadCentres>> {
        let mut found: Vec<DeadCentres> =
            (0..self.stations.len()).map(|i| self.ends_of(i)).collect();
        let Some(ratio) = compression_ratio else { return Ok(found) };
        if !(1.001..=1000.0).contains(&ratio) {
            let hint = "give largest over smallest volume, 1.001 to 1000";
            return Err(Error::figure("compression_ratio", ratio, hint));
        }
        let head = found[0].height + found[0].stroke / (ratio - 1.0);
        for (i, ends) in found.iter_mut().enumerate() {
            let clearance = head - ends.height;
            if clearance <= 0.0 {
                let hint =
                    format!("the piston of cylinder {} would touch its head; give less", i + 1);
                return Err(Error::figure("compression_ratio", ratio, hint));
            }
            ends.compression_ratio = Some(1.0 + ends.stroke / clearance);
        }
        Ok(found)
    }

    fn ends_of(&self, cylinder: usize) -> DeadCentres {
        let (mechanism, station) = (self.mechanism(cylinder), &self.stations[cylinder]);
        let speed = self.ratio_of(cylinder).size();
        let turning = mechanism.turning_points_deg();
        let angle = |own: f64| (station.tdc.degrees() + own / speed).rem_euclid(360.0);
        let highest = mechanism.motion(&CrankPosition::at_degrees(turning[0])).position;
        DeadCentres {
            angles_deg: turning.map(angle),
            height: highest * station.cylinder.crank_radius(),
            stroke: self.travel(cylinder),
            compression_ratio: None,
        }
    }

    /// Ends of each rod at an angle of the main crank, x + iy, m: at its crankpin or knuckle, and at its piston.
    #[must_use]
    pub fn rod_ends(&self, theta_deg: f64) -> Vec<[Complex64; 2]> {
        let pin = |i: usize| {
            let (crank, station) = (self.cranks[self.crank_of[i]], &self.stations[i]);
            let turned = cis_degrees(crank.ratio.number() * theta_deg) * self.pin(i).cis(1);
            (Complex64::new(crank.axis[0], crank.axis[1]), turned * station.cylinder.crank_radius())
        };
        let piston = |i: usize| {
            let (station, ratio) = (&self.stations[i], self.ratio_of(i));
            let (axis, crankpin) = pin(i);
            let own = crankpin / station.bank.cis(1) / station.cylinder.crank_radius();
            let crank = CrankPosition::new(own.im * f64::from(ratio.sense()), own.re);
            let height =
                self.mechanism(i).motion(&crank).position * station.cylinder.crank_radius();
            let side = station.cylinder.pin_offset() * f64::from(ratio.sense());
            axis + station.bank.cis(1) * Complex64::new(height, side)
        };
        let ends = |i: usize| {
            let (axis, crankpin) = pin(i);
            let Some(link) = self.link_rods[i] else { return [axis + crankpin, piston(i)] };
            let shank = piston(link.master) - axis - crankpin;
            let knuckle = shank / shank.norm() * link.angle.cis(1) * link.radius;
            [axis + crankpin + knuckle, piston(i)]
        };
        (0..self.stations.len()).map(ends).collect()
    }

    /// Rejects link rods that cannot turn, or whose cylinders are not on the crankpin of their master.
    pub(super) fn check_link_rods(&self) -> Result<()> {
        let links = self.link_rods.iter().enumerate();
        for (i, link) in links.filter_map(|(i, link)| Some((i, (*link)?))) {
            let at = |what: &str| format!("link_rods[{i}].{what}");
            let LinkRod { master, radius, big_end_mass, .. } = link;
            limits::distance(&at("radius"), radius)?;
            limits::not_negative(&at("big_end_mass"), big_end_mass)?;
            let fault = |hint: String| Err(Error::value(at("master"), master + 1, hint));
            if master >= self.stations.len() || master == i {
                let count = self.stations.len();
                return fault(format!("give the number of another cylinder, 1 to {count}"));
            }
            if self.link_rods[master].is_some() {
                return fault("it is a link itself; give the cylinder of its master rod".into());
            }
            let [own, of_master] = [i, master].map(|k| &self.stations[k]);
            let is_one_pin = self.crank_of[i] == self.crank_of[master]
                && self.pin(i).is_direction_of(self.pin(master));
            if !is_one_pin {
                return fault(format!(
                    "cylinders {} and {} are not on one crankpin: give a cylinder on the same crank with tdc_deg \
                     apart as the bores are",
                    i + 1,
                    master + 1
                ));
            }
            if own.z != of_master.z {
                let hint = format!(
                    "make it {:?}, that of cylinder {}: a master rod and its links lie in one plane",
                    of_master.z,
                    master + 1
                );
                return Err(Error::value(format!("z[{i}]"), format!("{:?}", own.z), hint));
            }
            if let Some(knuckle) = self.knuckle(i) {
                let place = format!("cylinder {}: ", i + 1);
                knuckle.check(&own.cylinder).map_err(|error| error.within(&place))?;
            }
        }
        Ok(())
    }

    /// Sense in which the crank of a cylinder turns.
    fn ratio_of(&self, cylinder: usize) -> SpeedRatio {
        self.cranks[self.crank_of[cylinder]].ratio
    }

    /// The knuckle on which a link rod hangs, in the sense of its crank.
    fn knuckle(&self, cylinder: usize) -> Option<Knuckle> {
        let LinkRod { master, radius, angle, .. } = self.link_rods[cylinder]?;
        let [own, of_master] = [cylinder, master].map(|i| &self.stations[i]);
        Some(Knuckle {
            master: of_master.cylinder.without_masses(),
            radius,
            angle: self.seen(cylinder, angle).reduced(),
            ahead: self.seen(cylinder, own.bank - of_master.bank).reduced(),
        })
    }

    /// An angle in the sense in which the crank of a cylinder turns, and back.
    fn seen(&self, cylinder: usize, angle: Angle) -> Angle {
        if self.ratio_of(cylinder).is_forward() { angle } else { -angle }
    }

    /// A cylinder, and what its rod hangs on.
    #[must_use]
    pub fn running_gear(&self, cylinder: usize) -> RunningGear {
        let knuckle = self.knuckle(cylinder);
        RunningGear { cylinder: self.stations[cylinder].cylinder, knuckle }
    }

    /// How a cylinder's piston moves.
    #[must_use]
    pub fn mechanism(&self, cylinder: usize) -> Arc<dyn Mechanism> {
        if self.link_rods[cylinder].is_none() {
            return self.stations[cylinder].cylinder.mechanism();
        }
        let all = || Ok((0..self.stations.len()).map(|i| self.link_mechanism(i)).collect());
        let known = self.kept.get(|_: &Vec<Option<Arc<dyn Mechanism>>>| true, all);
        let known = known.ok().and_then(|known| known[cylinder].clone());
        known.unwrap_or_else(|| self.running_gear(cylinder).mechanism())
    }

    /// Travel of a cylinder's piston, m.
    pub(crate) fn travel(&self, cylinder: usize) -> f64 {
        match self.link_rods[cylinder] {
            None => self.stations[cylinder].cylinder.travel(),
            Some(_) => self.mechanism(cylinder).travel(),
        }
    }

    fn link_mechanism(&self, cylinder: usize) -> Option<Arc<dyn Mechanism>> {
        self.link_rods[cylinder].map(|_| self.running_gear(cylinder).mechanism())
    }

    /// The mass at the knuckle of a link rod, if it has some.
    pub(crate) fn knuckle_mass(&self, cylinder: usize) -> Option<KnuckleMass> {
        let LinkRod { master, radius, angle, big_end_mass } = self.link_rods[cylinder]?;
        let length = self.stations[master].cylinder.rod_length();
        let angle = self.seen(cylinder, angle).reduced();
        let mass = KnuckleMass { master, mass: big_end_mass, share: radius / length, angle };
        (big_end_mass > 0.0).then_some(mass)
    }

    /// Indices of the cylinders whose rods hang on that of one.
    pub(crate) fn links_of(&self, master: usize) -> impl Iterator<Item = usize> {
        let links = self.link_rods.iter().enumerate();
        links
            .filter(move |(_, link)| link.is_some_and(|link| link.master == master))
            .map(|(i, _)| i)
    }

    /// Crank angle after that at which the crankpin points along the bore at which a link rod's piston is highest: there
    /// its cycle begins.
    pub(super) fn link_delay(&self, cylinder: usize) -> Option<Angle> {
        self.link_rods[cylinder]?;
        let [highest, _] = self.mechanism(cylinder).turning_points_deg();
        let own = Angle::from_degrees(highest).ok()?;
        Some(own.times(2).over(self.ratio_of(cylinder).halves().abs()))
    }

    /// Rejects link rods, where a quantity is swept with which they would change.
    pub(crate) fn check_no_link_rods(&self, argument: &str) -> Result<()> {
        if self.has_link_rods() {
            return Err(Error::value(argument, "given", HAS_LINK_RODS));
        }
        Ok(())
    }
}
