//! The scene of an engine: every load in one list, their sources, and what readings keep of them.

use std::sync::Arc;

use super::gas::GasPressure;
use super::knuckle::KnuckleCoupling;
use super::piston::PistonInertia;
use super::rod::RodInertia;
use super::spectrum::GivenForce;
use super::unbalance::TurningUnbalance;
use super::{
    GroupIndex, Load, LoadIndex, PhasorSum, Phasors, Place, SourceIndex, Term, Wanted, superpose,
};
use crate::Complex64;
use crate::engine::links::KnuckleMass;
use crate::engine::{Crank, Engine, Origin, Unbalance};
use crate::mechanism::DrivenMechanism;
use crate::numbers::error::Result;
use crate::numbers::index::List;
use crate::numbers::kept::Kept;
use crate::numbers::order::Order;
use crate::source::{
    ExactFactor, INERTIA, Parts, Point, Repeats, Scaling, Series, Source, at_point,
};

/// Largest magnitudes of the weights of some loads.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct LargestWeights {
    /// Of the force.
    pub force: f64,
    /// Of the force at the distance of its axis, of which it makes a torque about the main crank.
    pub arm: f64,
    /// Of the torque.
    pub roll: f64,
}

/// The sources of loads.
pub(crate) type Sources = List<SourceIndex, Arc<dyn Source>>;

/// Series of the sources of loads.
pub(crate) type KnownSeries = List<SourceIndex, Series>;

/// Sources that are counted together: of one name and scaling.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Group {
    pub name: Arc<str>,
    pub scaling: Scaling,
}

impl Group {
    /// Of a source.
    pub fn of(source: &dyn Source) -> Self {
        Self { name: source.name().into(), scaling: source.parts().scaling }
    }

    fn has(&self, source: &dyn Source) -> bool {
        *self.name == *source.name() && self.scaling == source.parts().scaling
    }
}

/// All loads of an engine about a reference plane, which every reading asks.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    /// Pistons, one for each cylinder; unbalances of cranks, then of shafts; pressures; rods.
    pub list: List<LoadIndex, Load>,
    /// One of each kind.
    pub sources: Sources,
    /// Names and scalings of the sources that differ; inertia is the first.
    pub groups: List<GroupIndex, Group>,
    /// Group of each source.
    pub group_of: List<SourceIndex, GroupIndex>,
    /// Reference plane z₀ of moments, m.
    pub reference: f64,
    /// The largest crank radius, m: arm of forces in tolerances of torques.
    pub crank_radius: f64,
    /// What readings evaluated of it last: orders that were chosen and their wrenches, a proof.
    pub kept: Kept,
}

impl Scene {
    /// That of an engine, made once and kept with it, about a plane, by default midway between its first and its
    /// last cylinder.
    pub fn of(engine: &Engine, reference_z: Option<f64>) -> Result<Arc<Self>> {
        let reference = engine.reference(reference_z)?;
        let is_such = |known: &Self| known.reference.to_bits() == reference.to_bits();
        engine.kept().get(is_such, || Ok(Self::new(engine, reference)))
    }

    #[cfg(test)]
    pub fn anew(engine: &Engine, reference: f64) -> Self {
        Self::new(engine, reference)
    }

    /// Loads of an engine. Pistons of equal crank radius, rod length and pin offset share a source, hence
    /// their harmonics; a spectrum is one source for all, with masses and radius in it.
    fn new(engine: &Engine, reference: f64) -> Self {
        let mut groups = List::default();
        groups.push(Group { name: INERTIA.into(), scaling: Scaling::SpeedSquared });
        let (list, sources, group_of) = (List::default(), List::default(), List::default());
        let (crank_radius, kept) = (engine.largest_crank_radius(), Kept::default());
        let mut loads = Self { list, sources, groups, group_of, reference, crank_radius, kept };
        let ratio = |i: usize| engine.cranks()[engine.crank_of(i)].ratio;
        let driven = |i: usize| DrivenMechanism { mechanism: engine.mechanism(i), ratio: ratio(i) };
        let along_bore = |i: usize| Place::along_bore(engine, i);
        let cylinders = 0..engine.stations().len();
        for i in cylinders.clone() {
            if let Some(spectrum) = engine.spectrum() {
                let force = GivenForce { spectrum: spectrum.clone(), ratio: ratio(i) };
                loads.push(along_bore(i), force, 1.0, 0.0);
            } else {
                let cylinder = &engine.stations()[i].cylinder;
                let (weight, roll) = (cylinder.mass_radius(), cylinder.mass_radius_squared());
                loads.push(along_bore(i), PistonInertia(driven(i)), weight, roll);
            }
        }
        loads.push_unbalances(engine);
        if engine.spectrum().is_none() {
            loads.push_knuckles(engine, &driven);
        }
        super::given::push(&mut loads, engine);
        if engine.spectrum().is_some() {
            // A spectrum does not determine a motion, against which pressure and rods would act.
            return loads;
        }
        for i in cylinders.clone() {
            for pressure in engine.pressures(i) {
                let roll = pressure.area * engine.stations()[i].cylinder.crank_radius();
                let gas = GasPressure::new(driven(i), &pressure);
                let mut place = along_bore(i);
                if gas.parts().repeats == Repeats::EveryTwoTurns {
                    place.phase = engine.firing_tdc(i).half();
                }
                loads.push(place, gas, 0.0, roll);
            }
        }
        for i in cylinders {
            let roll = engine.stations()[i].cylinder.rod_inertia_excess();
            if roll != 0.0 {
                loads.push(along_bore(i), RodInertia(driven(i)), 0.0, roll);
            }
        }
        loads
    }

    /// Those of cranks and balance shafts.
    fn push_unbalances(&mut self, engine: &Engine) {
        for (origin, Unbalance { amount, angle, z, pin, crank }) in engine.crank_unbalances() {
            let mut place = Place::on_main(origin, angle, z).on(engine.cranks()[crank]);
            if let Some(i) = pin {
                // A crankpin points along its bore at top dead centre.
                let bore = engine.stations()[i].bank;
                let is_forward = engine.cranks()[engine.crank_of(i)].ratio.is_forward();
                let ahead = if is_forward { bore + angle } else { bore - angle };
                place = Place::on_main(origin, ahead, z).of_cylinder(engine, i);
            }
            self.push_unbalance(place, amount);
        }
        for (k, shaft) in engine.shafts().iter().enumerate() {
            for unbalance in &shaft.unbalances {
                let place = Place::on_main(Origin::Shaft(k), unbalance.angle, unbalance.z)
                    .on(Crank { axis: shaft.axis, ratio: shaft.ratio });
                self.push_unbalance(place, unbalance.amount);
            }
        }
    }

    /// Masses at the knuckles of link rods: an unbalance at the crankpin, what moves as the master's piston does,
    /// along its bore turned by the knuckle's angle, and the torque of moving as both.
    fn push_knuckles(&mut self, engine: &Engine, driven: &dyn Fn(usize) -> DrivenMechanism) {
        for i in 0..engine.stations().len() {
            let Some(KnuckleMass { master, mass, share, angle }) = engine.knuckle_mass(i) else {
                continue;
            };
            let of_master = Place::along_bore(engine, master);
            let place = |direction| Place {
                origin: Origin::Cylinder(i),
                at_knuckle: true,
                bank: Some(engine.bank_of(i)),
                ..of_master.towards(direction)
            };
            let is_forward = of_master.ratio.is_forward();
            let turned = of_master.direction + if is_forward { angle } else { -angle };
            let radius = engine.stations()[i].cylinder.crank_radius();
            // 1 − k of the crankpin's motion, as two unbalances whose angles are those that were given.
            self.push_unbalance(place(of_master.direction), mass * radius);
            self.push_unbalance(place(turned), -(mass * radius * share));
            let along = PistonInertia(driven(master));
            let amounts = [mass * radius * share, mass * radius * radius * share * share];
            self.push(place(turned), along, amounts[0], amounts[1]);
            let coupling = KnuckleCoupling::new(driven(master), share, angle);
            self.push(place(of_master.direction), coupling, 0.0, mass * radius * radius);
        }
    }

    pub(super) fn push(&mut self, place: Place, source: impl Source, weight: f64, roll: f64) {
        let parts = source.parts();
        let index = self.index_of(&source).unwrap_or_else(|| self.push_source(Arc::new(source)));
        self.list.push(Load { place, source: index, parts, weight, roll });
    }

    /// A load with some of the parts of a source, and weights of force and torque.
    pub(super) fn push_as(
        &mut self,
        place: Place,
        parts: Parts,
        source: Arc<dyn Source>,
        [weight, roll]: [f64; 2],
    ) {
        let index = self.index_of(&*source).unwrap_or_else(|| self.push_source(source));
        self.list.push(Load { place, source: index, parts, weight, roll });
    }

    fn index_of(&self, source: &dyn Source) -> Option<SourceIndex> {
        self.sources.indices().find(|&known| *self.sources[known] == *source)
    }

    fn push_source(&mut self, source: Arc<dyn Source>) -> SourceIndex {
        let group = self.name_group(&*source);
        self.group_of.push(group);
        self.sources.push(source)
    }

    /// The group of a source, which is there from now on.
    pub(super) fn name_group(&mut self, source: &dyn Source) -> GroupIndex {
        let known = self.groups.indices().find(|&group| self.groups[group].has(source));
        known.unwrap_or_else(|| self.groups.push(Group::of(source)))
    }

    fn push_unbalance(&mut self, place: Place, amount: f64) {
        self.push(place, TurningUnbalance { ratio: place.ratio }, amount, 0.0);
    }

    /// Complex sums of some of its loads at one order, by harmonic and, if wanted, by bank.
    pub fn sums(&self, some: &[Load], order: Order, wanted: Wanted) -> Vec<Term<PhasorSum>> {
        superpose(&Phasors { reference: self.reference }, some, order, wanted)
    }

    /// Loads that are none of the engine's own parts, with their indices among the engine's.
    pub fn further(&self) -> impl Iterator<Item = (usize, &Load)> {
        self.list.iter().filter_map(|load| match load.place.origin {
            Origin::Load(index) => Some((index, load)),
            _ => None,
        })
    }

    /// Source of a load.
    pub fn source(&self, load: &Load) -> &dyn Source {
        &*self.sources[load.source]
    }

    /// Group of a source.
    pub fn group(&self, source: SourceIndex) -> &Group {
        &self.groups[self.group_of[source]]
    }

    /// Whether a group has forces, and torques.
    pub fn has(&self, group: GroupIndex) -> [bool; 2] {
        let mut has = [false; 2];
        for load in self.list.iter().filter(|load| self.group_of[load.source] == group) {
            let force = load.parts.force.is_some();
            has[0] |= force;
            has[1] |= load.parts.roll || force && load.place.axis != Complex64::default();
        }
        has
    }

    /// Names of the groups, each once: parts of results.
    pub fn names(&self) -> Vec<Arc<str>> {
        let mut names: Vec<Arc<str>> = Vec::new();
        for group in &self.groups {
            if !names.contains(&group.name) {
                names.push(Arc::clone(&group.name));
            }
        }
        names
    }

    /// The sources at a point of a sweep.
    pub fn at_point(&self, point: &Point) -> Result<Sources> {
        self.sources.iter().map(|source| at_point(source, point)).collect()
    }

    /// Σ weights of the torques of each source, and Σ of the magnitudes, of which bounds are made.
    pub fn torque_weights(&self) -> List<SourceIndex, PhasorSum<f64>> {
        let mut weights = self.sources.map_to(|_| PhasorSum::default());
        for load in &self.list {
            weights[load.source].value += load.roll;
            weights[load.source].size += load.roll.abs();
        }
        weights
    }

    /// The loads, and sources, that exact sums know.
    pub fn retain_exact(&mut self) {
        let Self { list, sources, .. } = self;
        let is_known = |factor| !matches!(factor, ExactFactor::Cycle | ExactFactor::Unknown);
        list.retain(|load| is_known(sources[load.source].exact()));
    }

    /// Largest weights of the loads of a source, times the square of their speed.
    pub fn largest_weights(&self, source: SourceIndex) -> LargestWeights {
        let mut largest = LargestWeights::default();
        for load in self.list.iter().filter(|load| load.source == source) {
            let square = load.place.speed_squared();
            let force = square * load.weight.abs();
            largest.force = largest.force.max(force);
            largest.arm = largest.arm.max(force * load.place.axis.norm());
            largest.roll = largest.roll.max(square * load.roll.abs());
        }
        largest
    }
}
