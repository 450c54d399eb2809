//! Every load of an engine in one list, and the gears that give their amplitudes.

use std::sync::Arc;

use super::{Load, PhasorSum, Phasors, Source, Term, Wanted, superpose};
use crate::Complex64;
use crate::engine::{Crank, Engine, Origin, Unbalance, first_equal};
use crate::gear::slider_crank::Cylinder;
use crate::gear::{Gear, GearKind, Pressure};
use crate::numbers::angle::Angle;
use crate::numbers::order::Order;

/// All loads of an engine about a reference plane.
pub(crate) struct Loads {
    pub list: Vec<Load>,
    /// One gear of each kind.
    pub gears: Vec<Gear>,
    /// Reference plane z₀ of moments, m.
    pub reference: f64,
}

impl Loads {
    /// Loads of an engine. Pistons of equal crank radius, rod length and pin offset share a gear, hence
    /// their harmonics; a spectrum is one gear for all, with masses and radius in it.
    pub fn new(engine: &Engine, reference: f64) -> Self {
        let (cylinders, spectrum) = (engine.gears(), engine.spectrum());
        let sizes = |c: &Cylinder| (c.crank_radius(), c.rod_length(), c.pin_offset());
        let alike_to = match spectrum {
            Some(_) => vec![0; cylinders.len()],
            None => first_equal(cylinders.iter().map(sizes)),
        };
        let crank = |i: usize| &engine.cranks()[engine.crank_of(i)];
        // A spectrum does not determine a motion, against which pressure would act.
        let gas = engine.gas().filter(|_| spectrum.is_none());
        let cycle_of = |i: usize| gas.and_then(|gas| gas.cycle_of[i]);
        let count = engine.stations().len();
        let gear_of = first_equal(
            (0..count).map(|i| (alike_to[engine.gear_of(i)], crank(i).ratio, cycle_of(i))),
        );
        let mut gears: Vec<Gear> = Vec::new();
        for (i, &gear) in gear_of.iter().enumerate() {
            if gear == gears.len() {
                let (cylinder, ratio) = (cylinders[engine.gear_of(i)], crank(i).ratio);
                let pressure = gas.zip(cycle_of(i)).map(|(gas, cycle)| Pressure {
                    cycle: Arc::clone(&gas.cycles[cycle]),
                    crankcase: gas.crankcase,
                });
                let kind = spectrum.cloned().map(GearKind::Given);
                let kind = kind.unwrap_or_else(|| Gear::of(cylinder, ratio).kind);
                gears.push(Gear { kind, ratio, pressure });
            }
        }
        // A load on the crank of a cylinder.
        let on_crank_of = |i: usize, load: Load| {
            let Crank { axis: [x, y], ratio } = *crank(i);
            let (phase, bank) = (engine.stations()[i].tdc, Some(engine.bank_of(i)));
            Load { phase, bank, ratio, axis: Complex64::new(x, y), ..load }
        };
        let on_main = |origin, source, weight, direction: Angle, z| Load {
            origin,
            source,
            weight,
            direction,
            unit: direction.cis(1),
            phase: Angle::ZERO,
            z,
            ratio: 1,
            axis: Complex64::default(),
            bank: None,
        };
        let pistons = engine.stations().iter().enumerate().map(|(i, place)| {
            let cylinder = place.cylinder;
            let source = Source::Piston {
                gear: gear_of[i],
                second_moment: cylinder.second_moment(),
                rod_inertia: cylinder.rod_inertia_excess(),
            };
            let weight = if spectrum.is_some() { 1.0 } else { cylinder.first_order() };
            on_crank_of(i, on_main(Origin::Cylinder(i), source, weight, place.bank, place.z))
        });
        let on_crank = engine.crank_unbalances().map(|(origin, unbalance)| {
            let Unbalance { amount, z, .. } = unbalance;
            let load = |angle| on_main(origin, Source::Unbalance, amount, angle, z);
            let Some(i) = unbalance.pin else { return load(unbalance.angle) };
            // A crankpin points along its bore at top dead centre.
            let (angle, bore) = (unbalance.angle, engine.stations()[i].bank);
            let ahead = if crank(i).ratio > 0 { bore + angle } else { bore - angle };
            on_crank_of(i, load(ahead))
        });
        let on_shafts = engine.shafts().iter().enumerate().flat_map(|(k, shaft)| {
            shaft.unbalances.iter().map(move |&Unbalance { amount, angle, z, .. }| Load {
                ratio: shaft.ratio,
                axis: Complex64::new(shaft.axis[0], shaft.axis[1]),
                ..on_main(Origin::Shaft(k), Source::Unbalance, amount, angle, z)
            })
        });
        let in_cylinders = (0..count).filter_map(|i| {
            let (_, weight) = (cycle_of(i)?, engine.swept_by_radius(i)?);
            let source = Source::Pressure { gear: gear_of[i] };
            let z = engine.stations()[i].z;
            let load = on_main(Origin::Cylinder(i), source, weight, Angle::ZERO, z);
            Some(Load { phase: engine.firing_phase(i).half(), ..on_crank_of(i, load) })
        });
        let list = pistons.chain(on_crank).chain(on_shafts).chain(in_cylinders);
        Self { list: list.collect(), gears, reference }
    }

    /// Complex sums of one order, by harmonic and, if wanted, by bank.
    pub fn sums(&self, order: Order, wanted: Wanted) -> Vec<Term<PhasorSum>> {
        superpose(&Phasors { reference: self.reference }, &self.list, order, wanted)
    }

    /// Σ area × crank radius of the pistons under pressure of each gear, m³, and Σ of the magnitudes, of
    /// which bounds are made.
    pub fn volumes(&self) -> Vec<PhasorSum<f64>> {
        let mut volumes = vec![PhasorSum::default(); self.gears.len()];
        for load in &self.list {
            if let Source::Pressure { gear } = load.source {
                volumes[gear].value += load.weight;
                volumes[gear].size += load.weight.abs();
            }
        }
        volumes
    }

    /// Orders at which unbalances act, ascending.
    pub fn unbalance_orders(&self) -> Vec<Order> {
        let mut orders: Vec<Order> = self.list.iter().filter_map(Load::unbalance_order).collect();
        orders.sort_unstable();
        orders.dedup();
        orders
    }

    /// Slider-cranks of the gears, by their index; none where a spectrum replaces them.
    pub fn cylinders(&self) -> Option<Vec<Cylinder>> {
        let cylinder = |gear: &Gear| match gear.kind {
            GearKind::SliderCrank { cylinder, .. } => Some(cylinder),
            GearKind::Given(_) => None,
        };
        self.gears.iter().map(cylinder).collect()
    }

    /// Largest magnitude of the inertia of a rod of this gear beyond that of its two masses, kg·m².
    pub fn largest_rod_inertia(&self, of_gear: usize) -> f64 {
        let own = |load: &Load| match load.source {
            Source::Piston { gear, rod_inertia, .. } if gear == of_gear => rod_inertia.abs(),
            _ => 0.0,
        };
        self.list.iter().map(own).fold(0.0, f64::max)
    }
}
