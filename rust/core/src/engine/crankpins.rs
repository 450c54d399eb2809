//! Crankpins, throws and main bearings, read off an engine's stations.

use super::{Crank, CrankIndex, Engine, LinkRod, Unbalance};
use crate::numbers::angle::Angle;
use crate::numbers::decimal;
use crate::numbers::error::{Error, Result, shorten};
use crate::numbers::index::{List, ListIndex};

/// Distance along the crank, in crank radii, up to which two throws are at one place.
const SAME_PLACE: f64 = 1e-6;

/// A crankpin and the cylinders whose rods share it.
#[derive(Debug, Clone, PartialEq)]
pub struct Crankpin {
    /// Cylinders by index, ascending.
    pub cylinders: Vec<usize>,
    /// Its crank.
    pub crank: CrankIndex,
    /// Direction from +x at θ = 0.
    pub pin: Angle,
    /// Place along the crank, midway between its cylinders', m.
    pub z: f64,
}

/// Throws at one place along a crank.
#[derive(Debug, Clone, PartialEq)]
pub struct ThrowPlace {
    /// Place, m.
    pub z: f64,
    /// Cylinders by index.
    pub cylinders: Vec<usize>,
}

/// Part of a crank between two main bearings, with one throw or several.
#[derive(Debug, Clone, PartialEq)]
pub struct Bay {
    /// Cylinders by index, ascending.
    pub cylinders: Vec<usize>,
    /// Places of the throws, ascending, m.
    pub throws: Vec<f64>,
    /// Places of the bearings in front and behind, m.
    pub bearings: [f64; 2],
    /// Index of its crank.
    pub crank: CrankIndex,
}

impl Bay {
    /// Places of the webs, m: midway between neighbouring throws and bearings.
    #[must_use]
    pub fn webs(&self) -> Vec<f64> {
        let [front, rear] = self.bearings;
        let places: Vec<f64> =
            [front].into_iter().chain(self.throws.iter().copied()).chain([rear]).collect();
        places.windows(2).map(|pair| decimal::midpoint(pair[0], pair[1])).collect()
    }

    /// Place midway between the first throw and the last, m.
    #[must_use]
    pub fn z(&self) -> f64 {
        middle(self.throws.iter().copied())
    }
}

impl Engine {
    /// The crankpins of all cranks from front to flywheel, those of one throw a list.
    ///
    /// Cylinders of one crank and different banks whose places are less than a crank radius apart are on
    /// one throw.
    /// Those of them whose pins are at one place share a crankpin; a throw has several where pins are
    /// split, and in a boxer.
    #[must_use]
    pub fn throws(&self) -> Vec<Vec<Crankpin>> {
        let stations = self.stations();
        let radius = |k: usize| stations[k].cylinder.crank_radius();
        let pins: Vec<Angle> = (0..stations.len()).map(|k| self.pin(k)).collect();
        let on_one_throw = |k: usize, other: usize| {
            let apart = (stations[k].z - stations[other].z).abs();
            self.crank_of(k) == self.crank_of(other)
                && self.bank_of(k) != self.bank_of(other)
                && apart < radius(k)
        };
        let on_one_pin = |k: usize, other: usize| {
            radius(k) == radius(other) && pins[k].is_direction_of(pins[other])
        };
        let crankpin = |mut cylinders: Vec<usize>| {
            let (pin, z) = (pins[cylinders[0]], middle(cylinders.iter().map(|&k| stations[k].z)));
            cylinders.sort_unstable();
            Crankpin { crank: self.crank_of(cylinders[0]), cylinders, pin, z }
        };
        let mut from_front: Vec<usize> = (0..stations.len()).collect();
        from_front.sort_by(|&a, &b| stations[a].z.total_cmp(&stations[b].z));
        let throws = grouped(&from_front, on_one_throw).into_iter();
        throws.map(|on| grouped(&on, on_one_pin).into_iter().map(crankpin).collect()).collect()
    }

    /// The crankpins of all cranks from front to flywheel.
    #[must_use]
    pub fn crankpins(&self) -> Vec<Crankpin> {
        let mut pins = self.throws().concat();
        pins.sort_by(|a, b| a.z.total_cmp(&b.z));
        pins
    }

    /// Places of the throws along a crank, ascending; those at one place are one.
    #[must_use]
    pub fn throw_places(&self, crank: CrankIndex) -> Vec<ThrowPlace> {
        let most = SAME_PLACE * self.largest_crank_radius();
        let place = |throw: Vec<Crankpin>| ThrowPlace {
            z: middle(throw.iter().map(|pin| pin.z)),
            cylinders: throw.into_iter().flat_map(|pin| pin.cylinders).collect(),
        };
        let on_crank = self.throws().into_iter().filter(|throw| throw[0].crank == crank);
        let mut places: Vec<ThrowPlace> = on_crank.map(place).collect();
        places.sort_by(|a, b| a.z.total_cmp(&b.z));
        places.dedup_by(|next, place| {
            let is_same = next.z - place.z <= most;
            if is_same {
                place.cylinders.append(&mut next.cylinders);
            }
            is_same
        });
        places
    }

    /// Places of the bearings along a crank, ascending, m: along the main one those given,
    /// or else one midway between neighbouring throws and one as far beyond the first and the last as the
    /// next is from them; none where it has no throws.
    #[must_use]
    pub fn bearings(&self, crank: CrankIndex) -> Vec<f64> {
        if crank == CrankIndex::MAIN && !self.mains().is_empty() {
            return self.mains().to_vec();
        }
        let places: Vec<f64> = self.throw_places(crank).iter().map(|place| place.z).collect();
        let [Some(&first), Some(&last)] = [places.first(), places.last()] else {
            return Vec::new();
        };
        let between = places.windows(2).map(|pair| decimal::midpoint(pair[0], pair[1]));
        let between: Vec<f64> = between.collect();
        let (Some(front), Some(rear)) = (between.first(), between.last()) else {
            let radius = self.largest_crank_radius();
            return [-radius, radius].map(|beside| decimal::sum(first, beside)).to_vec();
        };
        let beyond = |throw: f64, next: f64| decimal::sum(decimal::product(2.0, throw), -next);
        [&[beyond(first, *front)][..], &between, &[beyond(last, *rear)]].concat()
    }

    /// The bays of all cranks that have throws, crank by crank from front to flywheel.
    #[must_use]
    pub fn bays(&self) -> Vec<Bay> {
        self.cranks().indices().flat_map(|crank| self.bays_of(crank)).collect()
    }

    fn bays_of(&self, crank: CrankIndex) -> Vec<Bay> {
        let (places, bearings) = (self.throw_places(crank), self.bearings(crank));
        let bay = |pair: &[f64]| {
            let [front, rear] = [pair[0], pair[1]];
            let between = || places.iter().filter(|place| front < place.z && place.z < rear);
            let throws: Vec<f64> = between().map(|place| place.z).collect();
            let mut cylinders: Vec<usize> =
                between().flat_map(|place| &place.cylinders).copied().collect();
            cylinders.sort_unstable();
            (!throws.is_empty()).then_some(Bay {
                cylinders,
                throws,
                bearings: [front, rear],
                crank,
            })
        };
        bearings.windows(2).filter_map(bay).collect()
    }

    /// The cylinders of a bay and what its crank carries in it, as an engine of its own with moments about
    /// the bay's plane; on another crank than the main one, which has no cylinders then.
    pub fn of_bay(&self, bay: &Bay) -> Result<Self> {
        let [front, rear] = bay.bearings;
        let stations = bay.cylinders.iter().map(|&i| self.stations()[i]).collect();
        let banks: Vec<usize> = bay.cylinders.iter().map(|&i| self.bank_of(i)).collect();
        let (mut cranks, mut own) = (List::new(vec![Crank::MAIN]), CrankIndex::MAIN);
        if bay.crank != CrankIndex::MAIN {
            own = cranks.push(self.cranks()[bay.crank]);
        }
        let is_inside = |weight: &Unbalance| {
            self.crank_carrying(weight) == bay.crank && front <= weight.z && weight.z < rear
        };
        // The cylinder at whose pin a weight is may be in another bay.
        let at_own_angle = |weight: Unbalance| Unbalance {
            angle: self.direction(&weight),
            pin: None,
            crank: own,
            ..weight
        };

        let weights = self.counterweights().iter().copied().filter(is_inside).map(at_own_angle);
        // A master rod and its links share a crankpin, hence a bay.
        let link = |link: LinkRod| {
            let master = bay.cylinders.iter().position(|&i| i == link.master)?;
            Some(LinkRod { master, ..link })
        };
        let link_rods = bay.cylinders.iter().map(|&i| self.link_rods()[i].and_then(link)).collect();
        Self::in_banks("", "", stations, &banks)?
            .with_cranks(cranks.to_vec(), vec![own.position(); bay.cylinders.len()])?
            .with_link_rods(link_rods)?
            .with_counterweights(weights.collect())?
            .with_reference(Some(bay.z()))
    }

    /// Rejects main bearings that leave a throw outside, or one at a bearing.
    pub(super) fn check_throws_between(&self, mains: &[f64]) -> Result<()> {
        let [front, .., rear] = mains else { return Ok(()) };
        let outside = |z: f64| !(*front < z && z < *rear) || mains.contains(&z);
        match self.throw_places(CrankIndex::MAIN).into_iter().find(|place| outside(place.z)) {
            None => Ok(()),
            Some(place) => {
                let number = place.cylinders[0] + 1;
                let hint = format!(
                    "the throw of cylinder {number} is outside or at a bearing; give places in front \
                     of, between and behind the throws"
                );
                Err(Error::value("mains", shorten(&format!("{mains:?}")), hint))
            }
        }
    }
}

/// Puts each cylinder into the first group to whose every member it is alike.
fn grouped(cylinders: &[usize], is_same: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for &k in cylinders {
        match groups.iter_mut().find(|group| group.iter().all(|&other| is_same(k, other))) {
            Some(group) => group.push(k),
            None => groups.push(vec![k]),
        }
    }
    groups
}

/// Midway between the first and the last place.
fn middle(places: impl Iterator<Item = f64> + Clone) -> f64 {
    let (low, high) = (places.clone().reduce(f64::min), places.reduce(f64::max));
    decimal::midpoint(low.unwrap_or_default(), high.unwrap_or_default())
}
