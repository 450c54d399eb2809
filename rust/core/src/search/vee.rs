//! The engine that an arrangement is of.

use crate::engine::{Engine, Hold, Station};
use crate::gear::slider_crank::Cylinder;
use crate::numbers::angle::Angle;
use crate::numbers::error::Result;
use crate::numbers::limits;

/// The vee of two banks, the right one first, by the phases of their throws; cylinders are numbered
/// along the crank, odd ones in the right bank. The bank angle is in degrees.
pub fn vee(
    hold: Hold,
    bank_angle: f64,
    banks: &[Vec<Angle>; 2],
    cylinder: Cylinder,
    spacing: f64,
) -> Result<Engine> {
    limits::distance("spacing", spacing)?;
    limits::finite("bank_angle_deg", bank_angle)?;
    let throws = banks[0].len();
    limits::same_length("second_deg", banks[1].len(), "first_deg", throws, "throw")?;
    let half = Angle::from_degrees(bank_angle)?.half();
    let upright = Angle::QUARTER_TURN;
    let stations = (0..2 * throws).map(|i| {
        let (throw, bank) = (i / 2, i % 2);
        let phase = banks[bank][throw];
        let bore = if bank == 0 { upright - half } else { upright + half };
        Station {
            cylinder,
            tdc: match hold {
                Hold::Firing => -phase,
                Hold::Pins => bore - phase,
            },
            bank: bore,
            z: throw as f64 * spacing,
            rotating_mass: 0.0,
        }
    });
    let name = format!("V{} {bank_angle:.2}°", 2 * throws);
    // At 0° the bores have one direction, and the banks are two all the same.
    let banks: Vec<usize> = (0..2 * throws).map(|i| i % 2).collect();
    Engine::in_banks(name, "crankpin's search of arrangements", stations.collect(), &banks)
}
