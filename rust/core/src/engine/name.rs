//! Names of engines, in which their own figures may stand.

use super::Engine;

/// Stands for the bank angle, degrees.
const BANK_ANGLE: &str = "{bank_angle}";
/// Stands for "shared pins" or "split pins".
const PINS: &str = "{pins}";

impl Engine {
    /// Name as it is shown, its placeholders filled in.
    #[must_use]
    pub fn shown_name(&self) -> String {
        self.filled(self.name())
    }

    /// A text with its placeholders filled in: `{bank_angle}` and `{pins}`.
    #[must_use]
    pub fn filled(&self, pattern: &str) -> String {
        let mut text = pattern.to_owned();
        if text.contains(BANK_ANGLE) {
            let angle = self.banks().map(|banks| format!("{:.2}", banks.angle().degrees()));
            let angle = angle.unwrap_or_else(|_| "–".to_owned());
            text = text.replace(BANK_ANGLE, angle.trim_end_matches('0').trim_end_matches('.'));
        }
        if text.contains(PINS) {
            text = text
                .replace(PINS, if self.has_split_pins() { "split pins" } else { "shared pins" });
        }
        text
    }

    /// Whether a left crankpin points elsewhere than the right one of its throw, of two banks of as many
    /// cylinders on one crankshaft.
    fn has_split_pins(&self) -> bool {
        let one_crank = self.crank_of.iter().all(|&crank| crank == self.crank_of[0]);
        let mut banks = self.cylinders_of_banks();
        if self.banks().is_err() || !one_crank || banks[0].len() != banks[1].len() {
            return false;
        }
        for bank in &mut banks {
            bank.sort_by(|&a, &b| self.stations[a].z.total_cmp(&self.stations[b].z));
        }
        let mut throws = banks[0].iter().zip(&banks[1]);
        throws.any(|(&one, &other)| !self.pin(one).is_direction_of(self.pin(other)))
    }
}

#[cfg(test)]
mod tests {
    use crate::layout::{Numbering, Side, Spacing, Vee};
    use crate::{Angle, Cylinder};

    #[test]
    fn names_have_the_figures_of_their_engine() {
        let angle = |degrees| Angle::from_degrees(degrees).unwrap();
        let mut vee = Vee {
            bank_angle: angle(72.5),
            throws: vec![angle(0.0), angle(120.0)],
            spacing: Spacing::Even(0.1),
            pin_split: Angle::ZERO,
            bank_stagger: 0.0,
            rotating_mass: vec![],
            numbering: Numbering::Alternating,
            absent: vec![],
            first_bank: Side::Right,
            first_tdc: Angle::ZERO,
        };
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let name = |vee: &Vee| {
            let engine = vee.engine(cylinder).unwrap().named("{bank_angle}° V4, {pins}", "");
            engine.unwrap().shown_name()
        };
        assert_eq!(name(&vee), "72.5° V4, shared pins");
        (vee.pin_split, vee.bank_angle) = (angle(-30.0), angle(90.0));
        assert_eq!(name(&vee), "90° V4, split pins");
    }
}
