//! Places and directions of loads: the geometry of an engine, once.

use crate::Complex64;
use crate::engine::{Crank, Engine, Origin};
use crate::numbers::angle::Angle;
use crate::numbers::ratio::SpeedRatio;

/// Where, which way and when a load acts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    /// Part of the engine that it belongs to.
    pub origin: Origin,
    /// Direction of the force when the crank stands at `phase`, from +x.
    pub direction: Angle,
    /// Unit vector of that direction, x + iy.
    pub unit: Complex64,
    /// Crank angle; of a load that repeats in two turns half of it, which half orders turn by whole numbers.
    pub phase: Angle,
    /// Place along the crank, m.
    pub z: f64,
    /// Speed of its shaft.
    pub ratio: SpeedRatio,
    /// Place of the shaft's axis, x + iy, m.
    pub axis: Complex64,
    /// Bank that it belongs to: that of a piston, or of a crankpin's piston.
    pub bank: Option<usize>,
    /// Whether it acts at the knuckle of a link rod, which is not where its cylinder's own parts are.
    pub at_knuckle: bool,
}

impl Place {
    /// On the main crank, with this direction at θ = 0.
    pub fn on_main(origin: Origin, direction: Angle, z: f64) -> Self {
        Self {
            origin,
            direction,
            unit: direction.cis(1),
            phase: Angle::ZERO,
            z,
            ratio: SpeedRatio::ONE,
            axis: Complex64::default(),
            bank: None,
            at_knuckle: false,
        }
    }

    /// On a shaft or crank of this speed and axis.
    pub fn on(self, Crank { axis: [x, y], ratio }: Crank) -> Self {
        Self { ratio, axis: Complex64::new(x, y), ..self }
    }

    /// On the crank of a cylinder, of its bank, at its top dead centre.
    pub fn of_cylinder(self, engine: &Engine, cylinder: usize) -> Self {
        let crank = engine.cranks()[engine.crank_of(cylinder)];
        let (phase, bank) = (engine.stations()[cylinder].tdc, Some(engine.bank_of(cylinder)));
        Self { phase, bank, ..self.on(crank) }
    }

    /// In another direction.
    pub fn towards(self, direction: Angle) -> Self {
        Self { direction, unit: direction.cis(1), ..self }
    }

    /// Along the bore of a cylinder.
    pub fn along_bore(engine: &Engine, cylinder: usize) -> Self {
        let station = &engine.stations()[cylinder];
        Self::on_main(Origin::Cylinder(cylinder), station.bank, station.z)
            .of_cylinder(engine, cylinder)
    }

    /// Distance from a plane, m.
    pub fn lever(&self, reference: f64) -> f64 {
        self.z - reference
    }

    /// What the rounding error of that distance is relative to.
    pub fn lever_size(&self, reference: f64) -> f64 {
        self.z.abs() + reference.abs()
    }

    /// Square of its shaft's speed, by which inertia scales.
    pub fn speed_squared(&self) -> f64 {
        self.ratio.number() * self.ratio.number()
    }
}
