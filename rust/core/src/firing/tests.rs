//! Engines that the tests of this module share.

use std::sync::Arc;

use super::Firing;
use crate::engine::{Engine, Station};
use crate::layout::{Numbering, Side, Spacing, Vee};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::angle::Angle;

pub fn vee(bank_angle: f64, pin_split: f64, throws: &[f64], first_bank: Side) -> Vee {
    let angle = |degrees| Angle::from_degrees(degrees).unwrap();
    Vee {
        bank_angle: angle(bank_angle),
        throws: throws.iter().map(|&throw| angle(throw)).collect(),
        spacing: Spacing::Even(0.1),
        pin_split: angle(pin_split),
        bank_stagger: 0.0,
        rotating_mass: Vec::new(),
        numbering: Numbering::Alternating,
        absent: vec![],
        first_bank,
        first_tdc: Angle::ZERO,
    }
}

pub fn engine(layout: &Vee) -> Arc<Engine> {
    let cylinder = Cylinder::new(0.045, 0.158, 1.487, 0.0).unwrap();
    Arc::new(layout.engine(cylinder).unwrap())
}

/// Cylinder, TDC, bore of each; z does not matter.
pub fn placed(places: &[(Cylinder, f64, f64)]) -> Arc<Engine> {
    let angle = |degrees| Angle::from_degrees(degrees).unwrap();
    let place = |&(cylinder, tdc, bank): &(Cylinder, f64, f64)| Station {
        cylinder,
        tdc: angle(tdc),
        bank: angle(bank),
        z: 0.0,
        rotating_mass: 0.0,
    };
    Arc::new(Engine::new("", "", places.iter().map(place).collect()).unwrap())
}

pub fn cylinder(pin_offset: f64) -> Cylinder {
    Cylinder::new(0.05, 0.15, 0.5, pin_offset).unwrap()
}

pub fn intervals(firing: &Firing) -> Vec<f64> {
    firing.intervals().iter().map(|interval| interval.degrees()).collect()
}

pub fn figures(angles: &[Angle]) -> Vec<f64> {
    angles.iter().map(|angle| angle.degrees()).collect()
}
