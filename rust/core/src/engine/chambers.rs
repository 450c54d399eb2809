//! Chambers that two pistons share: they face each other along one bore, each on a crank of its own, or on one crank,
//! where side rods drive the upper one, whose inner face is at the chamber.

use std::sync::Arc;

use super::faces::Face;
use super::layout::Strokes;
use super::{Engine, Gas};
use crate::Complex64;
use crate::mechanism::motion::CrankPosition;
use crate::numbers::angle::{Angle, cis_degrees};
use crate::numbers::error::{Error, Result};

/// Distances below this part of that between two axes are rounding, of coordinates that were typed too: a tenth of a
/// millimetre in a metre.
const FACING_TOLERANCE: f64 = 1e-4;
/// Most degrees by which one of the pistons may lead the other: further apart they compress little, and the chamber
/// may be smallest twice in a turn.
const LARGEST_LEAD: f64 = 90.0;
/// Bisections, of which each halves an interval below a turn.
const BISECTIONS: usize = 60;

/// A chamber between two pistons; it fires once in a cycle, when it is smallest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedChamber {
    /// Indices of the cylinders, the lower first: under its number the chamber fires.
    pub pistons: [usize; 2],
    /// The face of each that is at the chamber.
    pub faces: [Face; 2],
    /// Angle of the main crank from the top dead centre of each to where the chamber is smallest.
    pub delays: [Angle; 2],
}

impl SharedChamber {
    /// Angle from the dead centre of a piston at its face, by its place, to where the chamber is smallest.
    fn past_dead_centre(&self, place: usize) -> Angle {
        self.delays[place] - self.faces[place].dead_centre()
    }

    /// Whether it is smallest elsewhere with rods of another length.
    fn is_timed_by_rods(&self) -> bool {
        self.past_dead_centre(0) != -self.past_dead_centre(1)
            || self.faces[0] != self.faces[1] && self.past_dead_centre(0) != Angle::ZERO
    }
}

impl Engine {
    /// Chambers that two pistons share. Dummy pistons share none, nor do pistons of cranks that are faster than
    /// the main one or slower.
    #[must_use]
    pub fn shared_chambers(&self) -> Arc<Vec<SharedChamber>> {
        let new = || Ok(self.facing_pistons().into_iter().map(|pair| self.chamber(pair)).collect());
        self.kept.get(|_: &Vec<SharedChamber>| true, new).unwrap_or_default()
    }

    /// Indices of the cylinders of each chamber that can fire, in the order of those under whose numbers they do.
    #[must_use]
    pub fn chambers(&self) -> Vec<Vec<usize>> {
        let cylinders = || (0..self.stations.len()).filter(|&i| !self.details[i].dummy);
        let of = |lead: usize| cylinders().filter(|&i| self.fires_as(i) == lead).collect();
        cylinders().filter(|&i| self.fires_as(i) == i).map(of).collect()
    }

    /// Angle of the main crank from a piston's top dead centre to where its cycle begins: where the chamber is
    /// smallest, if the piston shares it or side rods drive it, or where the piston of a link rod is highest; none of
    /// a chamber over one piston whose cycle begins at top dead centre.
    #[must_use]
    pub fn chamber_delay(&self, cylinder: usize) -> Option<Angle> {
        let shared = self.shared_chamber(cylinder).map(|(chamber, place)| chamber.delays[place]);
        shared.or_else(|| {
            let is_inner = self.working_face(cylinder) == Face::Inner;
            is_inner.then(|| self.lowest_after_tdc(cylinder)).or_else(|| self.link_delay(cylinder))
        })
    }

    /// The cylinder under whose number its chamber fires.
    #[must_use]
    pub fn fires_as(&self, cylinder: usize) -> usize {
        self.shared_chamber(cylinder).map_or(cylinder, |(chamber, _)| chamber.pistons[0])
    }

    /// Whether a chamber is smallest elsewhere with rods of another length: where its pistons are unlike, or offset.
    #[must_use]
    pub fn rods_time_chambers(&self) -> bool {
        self.shared_chambers().iter().any(SharedChamber::is_timed_by_rods)
            || (0..self.stations.len()).any(|i| self.rods_time_inner_chamber(i))
    }

    /// Whether the chamber at the inner face of a piston alone is smallest elsewhere with rods of another length.
    fn rods_time_inner_chamber(&self, cylinder: usize) -> bool {
        self.has_inner_chamber(cylinder) && self.stations[cylinder].cylinder.pin_offset() != 0.0
    }

    /// Rejects another rod ratio, or pin offset, where pressure acts in chambers that are smallest elsewhere then.
    pub(crate) fn check_chambers_keep(&self, changed: &'static str) -> Result<()> {
        let is_offset_swept = changed == "pin_offset";
        let is_moved = |chamber: &&SharedChamber| {
            let fires = self.cycle_of(chamber.pistons[0]).is_some();
            fires && (is_offset_swept || chamber.is_timed_by_rods())
        };
        let shared = self.shared_chambers();
        let which = if let Some(chamber) = shared.iter().find(is_moved) {
            let [one, other] = chamber.pistons.map(|i| i + 1);
            format!("the chamber that cylinders {one} and {other} share")
        } else {
            let is_moved = |&i: &usize| {
                let offset = is_offset_swept || self.rods_time_inner_chamber(i);
                offset && self.has_inner_chamber(i) && self.has_pressure(i)
            };
            match (0..self.stations.len()).find(is_moved) {
                None => return Ok(()),
                Some(i) => format!("the chamber at the crank end of cylinder {}", i + 1),
            }
        };
        let hint = format!(
            "{which} is smallest elsewhere at each; give an engine for each, or one without pressure"
        );
        Err(Error::value(changed, "swept", hint))
    }

    /// The chamber that a piston shares, and its place there.
    fn shared_chamber(&self, cylinder: usize) -> Option<(SharedChamber, usize)> {
        if self.cranks.len() == 1 && !self.details.iter().any(|of| of.side_rods) {
            return None;
        }
        let place = |chamber: &SharedChamber| {
            let place = chamber.pistons.iter().position(|&piston| piston == cylinder)?;
            Some((*chamber, place))
        };
        self.shared_chambers().iter().find_map(place)
    }

    /// Pairs of pistons that face each other along one bore: on different cranks, or on one by side rods.
    fn facing_pistons(&self) -> Vec<[usize; 2]> {
        let is_facing = |one: usize, other: usize| {
            let [a, b] = [one, other].map(|i| &self.stations[i]);
            let [from, to] = [one, other].map(|i| self.cranks[self.crank_of[i]].axis);
            let apart = Complex64::new(to[0] - from[0], to[1] - from[1]);
            let along = apart * a.bank.cis(-1);
            if self.crank_of[one] == self.crank_of[other] {
                let size = a.cylinder.reach() + b.cylinder.reach();
                let is_beside = (a.z - b.z).abs() > FACING_TOLERANCE * size;
                return b.bank.is_direction_of(a.bank) && !is_beside;
            }
            let is_opposite = b.bank.is_direction_of(a.bank + Angle::HALF_TURN);
            let is_beside = (a.z - b.z).abs().max(along.im.abs()) > FACING_TOLERANCE * apart.norm();
            is_opposite && !is_beside && along.re > 0.0
        };
        let shares = |&i: &usize| {
            !self.details[i].dummy && self.cranks[self.crank_of[i]].ratio.is_crank_speed()
        };
        let mut free: Vec<usize> = (0..self.stations.len()).filter(shares).collect();
        let mut pairs = Vec::new();
        while let [one, rest @ ..] = &free[..] {
            let one = *one;
            let is_other = |&other: &usize| {
                let side_rods = [one, other].map(|i| self.details[i].side_rods);
                if self.crank_of[one] == self.crank_of[other] {
                    side_rods[0] != side_rods[1]
                } else {
                    side_rods == [false; 2]
                }
            };
            let facing = rest.iter().copied().filter(is_other).find(|&other| is_facing(one, other));
            free.retain(|&i| i != one && Some(i) != facing);
            pairs.extend(facing.map(|other| [one, other]));
        }
        pairs
    }

    fn chamber(&self, pistons: [usize; 2]) -> SharedChamber {
        let faces = pistons.map(|i| self.working_face(i));
        let [one, other] = [0, 1].map(|k| self.stations[pistons[k]].tdc + faces[k].dead_centre());
        let apart = (other - one + Angle::HALF_TURN).reduced() - Angle::HALF_TURN;
        let sizes = |i: usize| {
            let gear = &self.stations[i].cylinder;
            (gear.crank_radius(), gear.rod_length(), self.details[i].bore)
        };
        let is_even = pistons
            .iter()
            .all(|&i| self.stations[i].cylinder.pin_offset() == 0.0 && self.link_rods[i].is_none());
        let is_alike = faces[0] == faces[1] && sizes(pistons[0]) == sizes(pistons[1]);
        let first = if is_even && (is_alike || apart == Angle::ZERO) {
            apart.half()
        } else {
            // An angle that is finite.
            Angle::from_degrees(self.smallest_after(pistons, faces, apart.degrees()))
                .unwrap_or(apart.half())
        };
        let delays = [first + faces[0].dead_centre(), first - apart + faces[1].dead_centre()];
        SharedChamber { pistons, faces, delays }
    }

    /// Degrees from the dead centre of the first piston at its face, of which the other's is so far apart, to where the
    /// volume between both is smallest.
    fn smallest_after(&self, pistons: [usize; 2], faces: [Face; 2], apart: f64) -> f64 {
        let swept = pistons.map(|i| self.swept_by_radius(i));
        let weights = match swept {
            [Some(one), Some(other)] => [one, other],
            _ => pistons.map(|i| self.stations[i].cylinder.crank_radius()),
        };
        let mechanisms = pistons.map(|i| self.mechanism(i));
        let dead_centres = faces.map(|face| face.dead_centre().degrees());
        let grows = |degrees: f64| {
            let rate = |k: usize, past: f64| {
                let unit = cis_degrees(past + dead_centres[k]);
                let motion = mechanisms[k].motion(&CrankPosition::new(unit.im, unit.re));
                faces[k].sign() * weights[k] * motion.velocity
            };
            // A piston that moves away from its crank makes the chamber at its outer face smaller.
            rate(0, degrees) + rate(1, degrees - apart) < 0.0
        };
        let smallest = |k: usize| {
            mechanisms[k].turning_points_deg()[faces[k].turning_point()] - dead_centres[k]
        };
        let ends = [smallest(0), apart + smallest(1)];
        let (mut low, mut high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if grows(middle) { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    }

    /// Rejects pressure of shared chambers that is not one cycle's, or that fires twice in it.
    pub(super) fn check_shared_pressure(&self, gas: &Gas) -> Result<()> {
        for chamber in self.shared_chambers().iter() {
            let [one, other] = chamber.pistons;
            let named =
                format!("cylinders {} and {} are the two ends of one chamber", one + 1, other + 1);
            if gas.cycle_of[one] != gas.cycle_of[other] {
                let hint = format!("{named}: give both the same cycle, or none");
                return Err(Error::value(format!("cycle[{other}]"), "another one", hint));
            }
            if gas.cycle_of[one].is_none() {
                continue;
            }
            let lead = (chamber.past_dead_centre(0) - chamber.past_dead_centre(1)).degrees().abs();
            if lead > LARGEST_LEAD {
                let hint = format!(
                    "{named}, which needs cranks at most {LARGEST_LEAD}° apart; these are {lead}°"
                );
                return Err(Error::value("cycle", "given", hint));
            }
            let apart = self.firing_phase(one) - self.firing_phase(other);
            if self.strokes == Strokes::Four
                && (apart.reduced_to(2).degrees() - 360.0).abs() < 180.0
            {
                let hint = format!("{named}, which fires once: in one turn of the cycle");
                return Err(Error::value(format!("later[{other}]"), gas.later[other], hint));
            }
        }
        Ok(())
    }
}
