//! The pins that a firing order needs.

use crate::layout::{FiringOrder, FiringRule, Side, Vee};
use crate::numbers::angle::Angle;
use crate::numbers::error::Result;

/// The pins that a vee needs to fire in this order.
#[derive(Debug, Clone, PartialEq)]
pub struct Throws {
    /// Crankpins of the right bank in the direction of rotation, from the front one.
    pub throws: Vec<Angle>,
    /// Left pin minus right pin of each throw, above −180° and up to 180°.
    pub pin_splits: Vec<Angle>,
}

/// Crankpins of an inline engine with this firing order, from the front one.
pub fn inline_throws(order: &FiringOrder, rule: &FiringRule) -> Result<Vec<Angle>> {
    let throws = order.throws(rule)?;
    Ok(throws.iter().map(|&throw| (throw - throws[0]).reduced()).collect())
}

/// Crankpins of a vee with this firing order; `layout.throws` and `layout.pin_split` are ignored.
pub fn vee_throws(order: &FiringOrder, rule: &FiringRule, layout: &Vee) -> Result<Throws> {
    let pins = order.vee_pins(rule, layout)?;
    let seats = layout.seats(pins.len())?;
    let mut sides = [(); 2].map(|()| vec![Angle::ZERO; pins.len() / 2]);
    for (seat, pin) in seats.iter().zip(pins) {
        sides[usize::from(seat.side == Side::Left)][seat.throw] = pin;
    }
    let [right, left] = sides;
    let half = Angle::HALF_TURN;
    let splits = left.iter().zip(&right).map(|(&left, &right)| {
        // Half a turn less what is in [0°, 360°) is above −180° and up to 180°.
        half - (half - (left - right)).reduced()
    });
    let pin_splits = splits.collect();
    let throws = right.iter().map(|&pin| (pin - right[0]).reduced()).collect();
    Ok(Throws { throws, pin_splits })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{figures, vee};
    use super::*;
    use crate::layout::Strokes;

    #[test]
    fn even_firing_splits_pins_by_bank_angle_less_interval() {
        let order: FiringOrder = "1-2-3-4-5-6".parse().unwrap();
        let rule = FiringRule::Even(Strokes::Four);
        for (bank_angle, split) in [(60.0, -60.0), (90.0, -30.0), (120.0, 0.0), (150.0, 30.0)] {
            let found = vee_throws(&order, &rule, &vee(bank_angle, 0.0, &[], Side::Right)).unwrap();
            assert!(found.pin_splits.iter().all(|each| each.degrees() == split));
            let throws: Vec<f64> = found.throws.iter().map(|each| each.degrees()).collect();
            assert_eq!(throws, [0.0, 120.0, 240.0]);
        }
    }

    #[test]
    fn crankpins_of_an_inline_engine_go_from_the_front() {
        let order: FiringOrder = "2-1-3".parse().unwrap();
        let throws = inline_throws(&order, &FiringRule::Even(Strokes::Four)).unwrap();
        // 2 fires first, 1 240° later, 3 480°: pins −240°, 0, −480°, all 240° on.
        assert_eq!(figures(&throws), [0.0, 240.0, 120.0]);
    }

    #[test]
    fn intervals_must_fill_a_cycle() {
        let order: FiringOrder = "1-2".parse().unwrap();
        let rule = |intervals: [f64; 2], strokes| {
            let intervals = intervals.map(|each| Angle::from_degrees(each).unwrap()).to_vec();
            inline_throws(&order, &FiringRule::Intervals(strokes, intervals))
        };
        assert_eq!(rule([180.0, 540.0], Strokes::Four).unwrap()[1].degrees(), 180.0);
        assert_eq!(rule([90.0, 270.0], Strokes::Two).unwrap()[1].degrees(), 270.0);
        assert!(rule([180.0, 180.0], Strokes::Four).is_err());
        assert!(rule([0.0, 720.0], Strokes::Four).is_err());
        assert!(rule([-90.0, 810.0], Strokes::Four).is_err());
    }
}
