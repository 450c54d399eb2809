//! Turning points of pistons, and the angles that count as one.

use super::schedule::firing;
use crate::engine::Engine;
use crate::numbers::angle::{Angle, MOST_ROUNDING};
use crate::numbers::error::Result;

/// Crank angles at which pistons are highest, after the first one's, within a turn.
///
/// Rejects pistons that are highest more than once in it and not dummies, which never fire.
pub(super) fn highest_points(engine: &Engine) -> Result<Vec<Angle>> {
    for cylinder in firing(engine) {
        engine.check_cycle_is_of_main_crank(cylinder, "cylinders but dummy pistons fire")?;
    }
    let stations = engine.stations();
    let mut highest: Vec<Angle> = (0..stations.len())
        .map(|i| {
            let past = fires_after_first(engine, i);
            let top = stations[i].tdc - stations[0].tdc;
            // Engines with offset pins are laid out so that this is a part of a turn.
            let top =
                if past == Angle::ZERO { top } else { (top + past).nearby_part(MOST_ROUNDING) };
            let top = top.reduced();
            if same(top, Angle::TURN) { Angle::ZERO } else { top }
        })
        .collect();
    // Merge angles that differ only by rounding.
    let mut order: Vec<usize> = (0..highest.len()).collect();
    order.sort_by(|&a, &b| highest[a].degrees().total_cmp(&highest[b].degrees()));
    for pair in order.windows(2) {
        if same(highest[pair[0]], highest[pair[1]]) {
            highest[pair[1]] = highest[pair[0]];
        }
    }
    Ok(highest)
}

/// Angle after top dead centre at which a cylinder fires: where its piston is highest, or the chamber smallest that
/// it shares.
pub(super) fn fires_after_tdc(engine: &Engine, cylinder: usize) -> Angle {
    let highest = || degrees(highest_after_tdc(engine, cylinder));
    engine.chamber_delay(cylinder).unwrap_or_else(highest)
}

/// The same less that of the first cylinder.
pub(super) fn fires_after_first(engine: &Engine, cylinder: usize) -> Angle {
    let both = [cylinder, 0];
    if both.iter().all(|&i| engine.chamber_delay(i).is_none()) {
        let [own, first] = both.map(|i| highest_after_tdc(engine, i));
        return degrees(own - first);
    }
    let [own, first] = both.map(|i| fires_after_tdc(engine, i));
    own - first
}

/// Degrees after top dead centre at which crank and rod are in line.
pub(super) fn highest_after_tdc(engine: &Engine, cylinder: usize) -> f64 {
    engine.mechanism(cylinder).turning_points_deg()[0]
}

/// From a piston's highest to its lowest point: half a turn but for a pin offset or a link rod.
pub(super) fn top_to_bottom(engine: &Engine, cylinder: usize) -> Angle {
    let [highest, lowest] = engine.mechanism(cylinder).turning_points_deg();
    Angle::HALF_TURN + degrees(lowest - 180.0 - highest)
}

/// An angle from degrees that are in range, such as those of an arc sine.
pub(super) fn degrees(degrees: f64) -> Angle {
    Angle::from_degrees(degrees).unwrap_or(Angle::ZERO)
}

/// True if two angles are equal: exactly as fractions of a turn, otherwise within rounding.
pub(super) fn same(a: Angle, b: Angle) -> bool {
    a == b
        || (!(a.turns().is_some() && b.turns().is_some())
            && (a.degrees() - b.degrees()).abs() <= MOST_ROUNDING)
}

#[cfg(test)]
mod tests {
    use super::super::Firing;
    use super::super::tests::{cylinder, intervals, placed};
    use super::*;
    use crate::layout::Strokes;
    use crate::numbers::cancel::Cancel;

    #[test]
    fn what_only_rounding_parts_fires_together() {
        let apart = |by: f64| {
            // No decimal of few digits: such ones are exact, however close.
            let tdc = 300.0_f64.sqrt();
            let tdcs = [0.0, tdc, tdc + by];
            let engine = placed(&tdcs.map(|tdc| (cylinder(0.0), tdc, 90.0)));
            Firing::all(&engine, Strokes::Two, &Cancel::new()).unwrap()[0].to_string()
        };
        assert_eq!(apart(0.0), "1-2+3");
        assert_eq!(apart(0.1 * MOST_ROUNDING), "1-2+3");
        assert_eq!(apart(10.0 * MOST_ROUNDING), "1-2-3");
        // An offset of one and not of the other: highest points asin(e/(l + r)) apart from their pins'.
        let past = (0.02_f64 / 0.2).asin().to_degrees();
        let engine = placed(&[(cylinder(0.02), 0.0, 90.0), (cylinder(0.0), past + 120.0, 90.0)]);
        let firing = Firing::all(&engine, Strokes::Two, &Cancel::new()).unwrap().remove(0);
        assert_eq!(intervals(&firing), [120.0, 240.0]);
        assert_eq!(firing.intervals()[0], Angle::TURN - Angle::from_degrees(240.0).unwrap());
    }
}
