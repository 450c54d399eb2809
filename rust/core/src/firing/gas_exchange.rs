//! Strokes, and when valves and ports are open.

use super::highest_points::{same, top_to_bottom};
use super::schedule::Firing;
use crate::layout::Strokes;
use crate::numbers::angle::{Angle, MOST_ROUNDING};
use crate::numbers::error::{Error, Result};

/// Two cylinders whose exhaust valves, or ports, are open at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Index of the cylinder whose exhaust is open.
    pub before: usize,
    /// Index of the one whose exhaust opens.
    pub after: usize,
    /// Crank angle from one opening to the other.
    pub gap: Angle,
    /// Crank angle for which both are open.
    pub overlap: Angle,
}

/// When valves or ports open and close.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Timing {
    /// Of a four-stroke: opening before a stroke, closing after it.
    Valves {
        /// Before top, after bottom dead centre.
        intake: [Angle; 2],
        /// Before bottom, after top dead centre.
        exhaust: [Angle; 2],
    },
    /// Of a two-stroke: opening before bottom dead centre, and closing as much after it.
    Ports {
        /// Of the transfer ports.
        transfer: Angle,
        /// Of the exhaust ports.
        exhaust: Angle,
    },
}

impl Timing {
    /// Of valves: intake opens, intake closes, exhaust opens, exhaust closes. Of ports: transfer opens,
    /// exhaust opens.
    pub fn new(angles: &[Angle]) -> Result<Self> {
        let check = |names: &[&str], fits: fn(f64) -> bool, hint: &str| {
            let wrong = names.iter().zip(angles).find(|(_, angle)| !fits(angle.degrees()));
            wrong.map_or(Ok(()), |(name, angle)| Err(Error::value(*name, angle, hint)))
        };
        match *angles {
            [transfer, exhaust] => {
                let names = ["transfer_opens_deg", "exhaust_opens_deg"];
                let fits = |degrees| 0.0 < degrees && degrees < 180.0;
                check(&names, fits, "give degrees above 0 and below 180")?;
                Ok(Self::Ports { transfer, exhaust })
            }
            [a, b, c, d] => {
                let names = [
                    "intake_opens_deg",
                    "intake_closes_deg",
                    "exhaust_opens_deg",
                    "exhaust_closes_deg",
                ];
                let fits = |degrees| -90.0 < degrees && degrees <= 180.0;
                check(&names, fits, "give degrees above -90 and up to 180")?;
                Ok(Self::Valves { intake: [a, b], exhaust: [c, d] })
            }
            _ => {
                let hint = "give four angles of valves, or two of ports";
                Err(Error::value("timing", angles.len(), hint))
            }
        }
    }
}

/// From opening to closing, or from beginning to end of a stroke: the first within a cycle, the
/// second after it.
pub type Period = [Angle; 2];

/// Periods of each cylinder.
pub type Periods = Vec<Period>;

/// Crank angle for which a valve of cylinder i (from 0) is open: it opens by the first angle before a
/// stroke, and closes by the second one after it.
fn open_for(valve: &str, i: usize, [opens, closes]: [Angle; 2], stroke: Angle) -> Result<Angle> {
    let open = opens + stroke + closes;
    if open.degrees() > 0.0 {
        return Ok(open);
    }
    let argument = format!("{valve}_opens_deg + {valve}_closes_deg");
    let hint = format!(
        "the valve of cylinder {} would close before it opens, as its {valve} stroke takes {:.1}°; make \
         the sum greater than {:.1}",
        i + 1,
        stroke.degrees(),
        -stroke.degrees()
    );
    Err(Error::value(argument, opens + closes, hint))
}

impl Firing {
    /// From beginning to end of each stroke, in order from the firing on.
    #[must_use]
    pub fn stroke_periods(&self) -> Vec<(&'static str, Periods)> {
        let names: &[_] = match self.strokes() {
            Strokes::Four => &["power", "exhaust", "intake", "compression"],
            Strokes::Two => &["power", "compression"],
        };
        let period = |k: usize, (i, firing): (usize, Angle)| {
            let downwards = top_to_bottom(self.engine(), i);
            let before = Angle::whole_turns((k / 2) as i32);
            let (from, length) = if k.is_multiple_of(2) {
                (before, downwards)
            } else {
                (before + downwards, Angle::TURN - downwards)
            };
            self.period(firing + from, length)
        };
        names
            .iter()
            .enumerate()
            .map(|(k, &name)| {
                let angles = self.highest().into_iter().enumerate();
                (name, angles.map(|each| period(k, each)).collect())
            })
            .collect()
    }

    /// When intake valves or transfer ports, and exhausts are open.
    pub fn open(&self, timing: &Timing) -> Result<[Periods; 2]> {
        let mut found = [(); 2].map(|()| Vec::new());
        for (i, firing) in self.highest().into_iter().enumerate() {
            let (turn, downwards) = (Angle::TURN, top_to_bottom(self.engine(), i));
            let [first, second] = match (*timing, self.strokes()) {
                (Timing::Valves { intake, exhaust }, Strokes::Four) => {
                    let open = open_for("intake", i, intake, downwards)?;
                    let first = self.period(firing + (turn - intake[0]), open);
                    let open = open_for("exhaust", i, exhaust, turn - downwards)?;
                    [first, self.period(firing + downwards - exhaust[0], open)]
                }
                (Timing::Ports { transfer, exhaust }, Strokes::Two) => [transfer, exhaust]
                    .map(|half| self.period(firing + downwards - half, half + half)),
                (Timing::Valves { .. }, Strokes::Two) => {
                    let hint = "valves are those of a four-stroke; a two-stroke breathes through \
                                ports: `Timing::Ports`";
                    return Err(Error::value("strokes", 2, hint));
                }
                (Timing::Ports { .. }, Strokes::Four) => {
                    let hint = "ports are those of a two-stroke; a four-stroke breathes through \
                                valves: `Timing::Valves`";
                    return Err(Error::value("strokes", 4, hint));
                }
            };
            found[0].push(first);
            found[1].push(second);
        }
        Ok(found)
    }

    /// Where of a group two are open at one time; a period for each cylinder of the engine.
    #[must_use]
    pub fn overlaps(&self, groups: &[Vec<usize>], open: &[Period]) -> Vec<Vec<Overlap>> {
        let length = |i: usize| open[i][1] - open[i][0];
        let mut found = Vec::new();
        for group in groups {
            let members = self.in_order(group);
            let mut overlaps = Vec::new();
            for (k, &before) in members.iter().enumerate() {
                // The others as they follow this one.
                for step in 1..members.len() {
                    let place = (k + step) % members.len();
                    let after = members[place];
                    let gap = self.within(open[after][0] - open[before][0]);
                    let gap = if same(gap, self.strokes().cycle()) { Angle::ZERO } else { gap };
                    // Two that open together overlap once, not each with the other.
                    if same(gap, Angle::ZERO) && place < k {
                        continue;
                    }
                    let (rest, other) = (length(before) - gap, length(after));
                    let overlap = if rest < other { rest } else { other };
                    if overlap.degrees() > MOST_ROUNDING {
                        overlaps.push(Overlap { before, after, gap, overlap });
                    }
                }
            }
            found.push(overlaps);
        }
        found
    }

    /// From an angle within a cycle on, of this length.
    fn period(&self, start: Angle, length: Angle) -> Period {
        let start = self.within(start);
        [start, start + length]
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cylinder, placed};
    use super::*;

    /// Highest where crank and rod are in one line, asin(e/(l + r)) after TDC; lowest half a turn
    /// and asin(e/(l − r)) after it.
    #[test]
    fn strokes_go_from_one_turning_point_of_the_piston_to_the_next() {
        for e in [0.0, 0.02, -0.02] {
            let engine = placed(&[(cylinder(e), 30.0, 90.0), (cylinder(0.0), 200.0, 90.0)]);
            let (high, low) = ((e / 0.2).asin().to_degrees(), (e / 0.1).asin().to_degrees());
            let down = 180.0 + low - high;
            let near = |period: Period, start: f64, length: f64| {
                let [from, to] = period.map(Angle::degrees);
                assert!((from - start).abs() < 1e-9, "{from} {start}");
                assert!((to - from - length).abs() < 1e-9, "{to} {from} {length}");
            };
            let four = Firing::with_later(&engine, Strokes::Four, &[false, true]).unwrap();
            let angles = four.angles();
            assert!((angles[0].degrees() - 30.0 - high).abs() < 1e-9);
            assert!((angles[1].degrees() - 560.0).abs() < 1e-9);
            let strokes = four.stroke_periods();
            let names: Vec<&str> = strokes.iter().map(|(name, _)| *name).collect();
            assert_eq!(names, ["power", "exhaust", "intake", "compression"]);
            let top = 30.0 + high;
            near(strokes[0].1[0], top, down);
            near(strokes[1].1[0], top + down, 360.0 - down);
            near(strokes[2].1[0], top + 360.0, down);
            near(strokes[3].1[0], top + 360.0 + down, 360.0 - down);
            near(strokes[2].1[1], 200.0, 180.0);
            let angle = |degrees| Angle::from_degrees(degrees).unwrap();
            let timing = Timing::new(&[10.0, 40.0, 50.0, 15.0].map(angle)).unwrap();
            let [intake, exhaust] = four.open(&timing).unwrap();
            near(intake[0], top + 350.0, 50.0 + down);
            near(exhaust[0], top + down - 50.0, 65.0 + 360.0 - down);
            let ports = Timing::new(&[60.0, 80.0].map(angle)).unwrap();
            assert!(four.open(&ports).is_err());
            let two = Firing::with_later(&engine, Strokes::Two, &[false; 2]).unwrap();
            assert!(two.open(&timing).is_err());
            let strokes = two.stroke_periods();
            assert_eq!((strokes.len(), strokes[1].0), (2, "compression"));
            near(strokes[1].1[1], 20.0, 180.0);
            let [transfer, exhaust] = two.open(&ports).unwrap();
            near(transfer[0], top + down - 60.0, 120.0);
            near(exhaust[0], top + down - 80.0, 160.0);
        }
    }

    /// A piston with an offset of nearly its limit goes down in 122° or 237° of the crank.
    #[test]
    fn a_valve_that_would_close_before_it_opens_is_refused() {
        let angle = |degrees| Angle::from_degrees(degrees).unwrap();
        let timing = |intake: f64, exhaust: f64| {
            let [intake, exhaust] = [intake, exhaust].map(angle);
            Timing::new(&[intake, intake, exhaust, exhaust]).unwrap()
        };
        for (offset, intake, exhaust) in [(-0.0999, -80.0, 0.0), (0.0999, 0.0, -80.0)] {
            let engine = placed(&[(cylinder(0.0), 0.0, 90.0), (cylinder(offset), 0.0, 90.0)]);
            let firing = Firing::with_later(&engine, Strokes::Four, &[false; 2]).unwrap();
            let message = firing.open(&timing(intake, exhaust)).unwrap_err().to_string();
            let [name, other] =
                if intake < 0.0 { ["intake", "exhaust"] } else { ["exhaust", "intake"] };
            assert!(message.starts_with(&format!("{name}_opens_deg + {name}_closes_deg = -160: ")));
            assert!(message.contains("cylinder 2"), "{message}");
            assert!(!message.contains(other), "{message}");
            // Later by 20° on either side they open before they close.
            let open = firing.open(&timing(0.4 * intake, 0.4 * exhaust)).unwrap();
            for [opens, closes] in open.concat() {
                assert!(closes.degrees() > opens.degrees());
            }
        }
    }

    #[test]
    fn overlaps_are_where_two_are_open_together() {
        let engine = placed(&[0.0, 120.0, 240.0, 0.0].map(|tdc| (cylinder(0.0), tdc, 90.0)));
        let firing = Firing::with_later(&engine, Strokes::Two, &[false; 4]).unwrap();
        let open = |lengths: [f64; 4]| -> Periods {
            let periods = firing.angles().into_iter().zip(lengths);
            periods.map(|(from, by)| [from, from + Angle::from_degrees(by).unwrap()]).collect()
        };
        let found = |lengths: [f64; 4], group: &[usize]| -> Vec<(usize, usize, f64, f64)> {
            let all = firing.overlaps(&[group.to_vec()], &open(lengths));
            let of = |o: &Overlap| (o.before, o.after, o.gap.degrees(), o.overlap.degrees());
            all[0].iter().map(of).collect()
        };
        let three = [0, 1, 2];
        assert_eq!(found([100.0; 4], &three), []);
        assert_eq!(found([120.0; 4], &three), []);
        let each = [(0, 1, 120.0, 30.0), (1, 2, 120.0, 30.0), (2, 0, 120.0, 30.0)];
        assert_eq!(found([150.0; 4], &three), each);
        // One that is short lies wholly within the other.
        assert_eq!(found([150.0, 20.0, 100.0, 0.0], &three), [(0, 1, 120.0, 20.0)]);
        // Two that open together overlap once.
        assert_eq!(found([50.0; 4], &[0, 3]), [(0, 3, 0.0, 50.0)]);
        let late = found([300.0, 0.0, 300.0, 0.0], &[0, 2]);
        assert_eq!(late, [(0, 2, 240.0, 60.0), (2, 0, 120.0, 180.0)]);
        // What rounding may be is none.
        assert_eq!(found([MOST_ROUNDING; 4], &[0, 3]), []);
        let just = 1.1e-9;
        assert_eq!(found([just; 4], &[0, 3]), [(0, 3, 0.0, just)]);
    }
}
