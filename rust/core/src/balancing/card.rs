//! Card of a balancing shop: the bob weight of each crankpin, and the correction of a crankshaft.

use super::bob_weight::{SUM_ROUNDING, bob_weight};
use super::counterweights::{Fit, FittedWeight, Plane, Target, fit_counterweights};
use super::weights::Minimise;
use crate::Complex64;
use crate::engine::crankpins::Crankpin;
use crate::engine::{CrankIndex, Engine, Unbalance};
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::limits;

/// Densities of a crankshaft and of the tungsten alloy pressed into its holes, g/cm³.
const STEEL: f64 = 7.85;
const HEAVY_METAL: f64 = 17.0;

/// A crankpin and what is on it, kg.
#[derive(Debug, Clone, PartialEq)]
pub struct PinMasses {
    /// The crankpin.
    pub pin: Crankpin,
    /// Rotating mass of its rods.
    pub rotating: f64,
    /// Reciprocating mass.
    pub reciprocating: f64,
    /// Reciprocating mass that acts a quarter of a turn ahead of the crankpin, of masses at the knuckles of link rods;
    /// as much less rotates there.
    reciprocating_across: f64,
}

impl PinMasses {
    /// Bob weight of a balance factor, with this oil in the crankpin, kg.
    #[must_use]
    pub fn bob_weight(&self, factor: f64, oil: f64) -> f64 {
        bob_weight([self.rotating, self.reciprocating], factor) + oil
    }

    /// What a bob weight lacks that is clamped to the crankpin: mass at its radius a quarter of a turn ahead, kg.
    #[must_use]
    pub fn across(&self, factor: f64) -> f64 {
        bob_weight([-self.reciprocating_across, self.reciprocating_across], factor)
    }
}

/// The crankpins from front to flywheel, and what is on each.
#[must_use]
pub fn pins(engine: &Engine) -> Vec<PinMasses> {
    let on = |pin: Crankpin| {
        let stations = || pin.cylinders.iter().map(|&i| &engine.stations()[i]);
        let knuckles = || pin.cylinders.iter().filter_map(|&i| engine.knuckle_mass(i));
        let at_knuckles: f64 = knuckles().map(|knuckle| knuckle.mass).sum();
        let moving: Complex64 = knuckles().map(|knuckle| knuckle.reciprocating()).sum();
        let reciprocating: f64 =
            stations().map(|station| station.cylinder.reciprocating_mass()).sum();
        let big_ends: f64 = stations().map(|station| station.rotating_mass).sum();
        // Knuckles all around cancel across the crankpin.
        let across = if moving.im.abs() > SUM_ROUNDING * at_knuckles { moving.im } else { 0.0 };
        PinMasses {
            pin,
            rotating: big_ends + (at_knuckles - moving.re),
            reciprocating: reciprocating + moving.re,
            reciprocating_across: across,
        }
    };
    engine.crankpins().into_iter().map(on).collect()
}

/// Planes in which a crankshaft is corrected, and what it is balanced to now.
#[derive(Debug, Clone, Copy)]
pub struct CorrectionRequest<'a> {
    /// The planes.
    pub planes: &'a [Plane],
    /// Radius of the weight or hole in each, m; none where it is not known.
    pub radii: Option<&'a [f64]>,
    /// Oil of each crankpin, kg.
    pub oil: f64,
    /// Bob weight to which the crankshaft is balanced now, of each crankpin, kg; by default its
    /// counterweights are those of the engine.
    pub balanced_to: Option<&'a [f64]>,
}

/// Mass to be added in a plane, or drilled away opposite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correction {
    /// Index of the plane.
    pub plane: usize,
    /// What is to be added.
    pub unbalance: Unbalance,
    /// Direction in which the same is drilled away.
    pub drilled_at: Angle,
    /// Mass at the radius, kg; none where that is not known.
    pub mass: Option<f64>,
    /// Mass of a slug of heavy metal in a hole there, in place of steel, kg.
    pub heavy_metal: Option<f64>,
}

/// Corrections that balance a crankshaft to a factor.
pub fn corrections(
    engine: &Engine,
    factor: f64,
    request: &CorrectionRequest,
    cancel: &Cancel,
) -> Result<Vec<Correction>> {
    let engine = as_it_is(engine, request)?;
    let fit = Fit {
        planes: request.planes,
        bounds: &vec![f64::INFINITY; request.planes.len()],
        angles: None,
        force: Target::Share(factor),
        moment: Target::Share(factor),
        length: None,
        minimise: Minimise::Squares,
    };
    let fitted = fit_counterweights(&engine, &fit, cancel)?;
    let correction = |FittedWeight { unbalance, plane, .. }: FittedWeight| {
        let mass = request.radii.map(|radii| unbalance.amount / radii[plane]);
        Correction {
            plane,
            unbalance,
            drilled_at: (unbalance.angle + Angle::HALF_TURN).reduced(),
            mass,
            heavy_metal: mass.map(|mass| mass * HEAVY_METAL / (HEAVY_METAL - STEEL)),
        }
    };
    Ok(fitted.list.into_iter().map(correction).collect())
}

/// The engine with the oil of its crankpins, midway between the rods of each, and what its cranks have now.
fn as_it_is(engine: &Engine, request: &CorrectionRequest) -> Result<Engine> {
    let pins = engine.crankpins();
    let mut weights = Vec::new();
    let bobs = if let Some(bobs) = request.balanced_to {
        limits::same_length("balanced_to", bobs.len(), "the engine", pins.len(), "crankpin")?;
        bobs.to_vec()
    } else {
        weights.extend_from_slice(engine.counterweights());
        vec![0.0; pins.len()]
    };
    for (pin, bob) in pins.iter().zip(bobs) {
        let first = pin.cylinders[0];
        let along = (request.oil - bob) * engine.stations()[first].cylinder.crank_radius();
        let angle = if along < 0.0 { Angle::HALF_TURN } else { Angle::ZERO };
        if along != 0.0 {
            weights.push(Unbalance {
                amount: along.abs(),
                angle,
                z: pin.z,
                pin: Some(first),
                crank: CrankIndex::MAIN,
            });
        }
    }
    engine.with_counterweights(weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::{Numbering, Side, Spacing, Vee};
    use crate::mechanism::cylinder::Cylinder;

    fn v8() -> Engine {
        let angle = |degrees: f64| Angle::from_degrees(degrees).unwrap();
        Vee {
            bank_angle: angle(90.0),
            throws: [0.0, 90.0, 270.0, 180.0].map(angle).to_vec(),
            spacing: Spacing::Even(0.1),
            pin_split: Angle::ZERO,
            bank_stagger: 0.02,
            rotating_mass: vec![0.4],
            numbering: Numbering::Alternating,
            absent: vec![],
            first_bank: Side::Left,
            first_tdc: Angle::ZERO,
        }
        .engine(Cylinder::new(0.045, 0.15, 0.5, 0.0).unwrap())
        .unwrap()
    }

    #[test]
    fn a_crankpin_has_what_its_rods_have() {
        let found = pins(&v8());
        assert_eq!(found.len(), 4);
        for pin in &found {
            assert_eq!((pin.rotating, pin.reciprocating), (0.8, 1.0));
            assert_eq!(pin.bob_weight(0.5, 0.004), 1.304);
        }
        assert!(found.is_sorted_by(|a, b| a.pin.z < b.pin.z));
    }

    #[test]
    fn a_crankshaft_balanced_to_its_bob_weights_needs_nothing() {
        let (engine, cancel) = (v8(), Cancel::new());
        let needed = |factor, balanced_to: Option<&[f64]>| {
            let request = CorrectionRequest {
                planes: &[-0.05, 0.35].map(|z| Plane { z, crank: CrankIndex::MAIN }),
                radii: Some(&[0.08, 0.1]),
                oil: 0.004,
                balanced_to,
            };
            corrections(&engine, factor, &request, &cancel).unwrap()
        };
        assert!(needed(0.5, Some(&[1.304; 4])).is_empty());
        // From nothing, what is missing in each plane: the moment of the bob weights over their distance.
        let found = needed(0.5, None);
        assert_eq!(found.iter().map(|each| each.plane).collect::<Vec<_>>(), [0, 1]);
        let pull = |k: f64, throw: f64| {
            Angle::from_degrees(throw).unwrap().cis(1) * (1.304 * 0.045 * (0.1 * k - 0.15))
        };
        let moment: crate::Complex64 =
            (0..4).map(|k| pull(f64::from(k), [0.0, 90.0, 270.0, 180.0][k as usize])).sum();
        for (each, radius) in found.iter().zip([0.08, 0.1]) {
            let amount = each.unbalance.amount;
            // Angles are rounded to 1e-9 of a degree.
            assert!((amount - moment.norm() / 0.4).abs() < 1e-9 * amount, "{amount}");
            let mass = each.mass.unwrap();
            assert!((mass * radius - amount).abs() < 1e-15);
            assert!((each.heavy_metal.unwrap() / mass - 1.857_923_497).abs() < 1e-9);
            let opposite = each.drilled_at.degrees() - each.unbalance.angle.degrees();
            assert!((opposite.abs() - 180.0).abs() < 1e-9);
        }
        let wrong =
            CorrectionRequest { planes: &[], radii: None, oil: 0.0, balanced_to: Some(&[1.0]) };
        let error = corrections(&engine, 0.5, &wrong, &cancel).unwrap_err().to_string();
        assert!(error.starts_with("balanced_to has 1 entries"), "{error}");
    }
}
