//! The schedules by which an engine can fire: all of them, those of a named order, and the most even one.

use std::cmp::Ordering;
use std::sync::Arc;

use super::highest_points::highest_points;
use super::schedule::{Firing, firing};
use crate::engine::Engine;
use crate::layout::{FiringOrder, Strokes};
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result, shorten};
use crate::numbers::memory;

/// Most cylinders of which all orders are listed: a V16 has 2¹⁵ choices of turns.
pub const MOST_CYLINDERS_LISTED: usize = 16;
/// Orders that an error lists.
const EXAMPLES: usize = 3;

impl Firing {
    /// Every choice of turns by which an engine fires in this order, the most even first.
    pub fn all_named(
        engine: &Arc<Engine>,
        order: &FiringOrder,
        strokes: Strokes,
    ) -> Result<Vec<Self>> {
        let highest = highest_points(engine)?;
        let count = highest.len();
        let fires: Vec<usize> = firing(engine).collect();
        order.check_names_all(count, &fires, |i| match engine.fires_as(i) {
            lead if lead == i => "is a dummy piston, which does not fire".to_owned(),
            lead => format!("shares the chamber of {}, which fires once", lead + 1),
        })?;
        // From that whose piston is highest first.
        let first =
            firing(engine).min_by(|&a, &b| highest[a].degrees().total_cmp(&highest[b].degrees()));
        let (cylinders, together) = order.rotated(first.unwrap_or(0));
        // Within a turn cylinders fire as they reach the top; the order may go back to an earlier
        // top once, where the second turn begins.
        let mut second_turn_at = Vec::new();
        for (k, pair) in (1..).zip(cylinders.windows(2)) {
            let [before, now] = [pair[0], pair[1]].map(|cylinder| highest[cylinder]);
            if together[k] {
                if before != now {
                    return Ok(Vec::new());
                }
            } else if before.partial_cmp(&now) != Some(Ordering::Less) {
                second_turn_at.push(k);
            }
        }
        let splits: Vec<usize> = match (strokes, &second_turn_at[..]) {
            (Strokes::Four, &[split]) => vec![split],
            (Strokes::Four, []) => {
                (1..=cylinders.len()).filter(|&k| together.get(k) != Some(&true)).collect()
            }
            (Strokes::Two, []) => vec![cylinders.len()],
            _ => Vec::new(),
        };
        let mut found: Vec<Self> = splits
            .into_iter()
            .map(|split| {
                let mut later = vec![false; count];
                for &cylinder in &cylinders[split..] {
                    later[cylinder] = true;
                }
                Self::assemble(engine, &highest, strokes, &later)
            })
            .collect();
        most_even_first(&mut found);
        Ok(found)
    }

    /// The most even schedule for an engine to fire in this order.
    pub fn named(
        engine: &Arc<Engine>,
        order: &FiringOrder,
        strokes: Strokes,
        cancel: &Cancel,
    ) -> Result<Self> {
        if let Some(found) = Self::all_named(engine, order, strokes)?.into_iter().next() {
            return Ok(found);
        }
        let later = vec![false; engine.stations().len()];
        let within_a_turn = Self::assemble(engine, &highest_points(engine)?, Strokes::Two, &later);
        let sequence = shorten(&within_a_turn.to_string().replace('-', ", "));
        let mut hint =
            format!("this crank cannot fire in this order: its TDC sequence is {sequence}");
        if can_list(firing(engine).count(), strokes) {
            let possible = Self::all(engine, strokes, cancel)?;
            hint = format!("{hint}. Possible orders, most even first: {}", listed(&possible));
        }
        Err(Error::value("firing_order", order, hint))
    }

    /// The schedule at these intervals, from each cylinder of an order to the next and from the last to the
    /// first; the most even one where the crank fires at none of them.
    pub fn at_intervals(
        engine: &Arc<Engine>,
        order: &FiringOrder,
        strokes: Strokes,
        intervals: &[Angle],
        cancel: &Cancel,
    ) -> Result<Self> {
        let (cylinders, together) = (order.cylinders(), order.together());
        let group = 1 + together.iter().skip(1).take_while(|joined| **joined).count();
        // Of those that fire together schedules have the lowest number first.
        let first = cylinders[..group.min(cylinders.len())].iter().min();
        let distance = |one: &Self| {
            let own = one.intervals();
            let at = one.order().iter().position(|cylinder| Some(&(cylinder + 1)) == first);
            let difference = |k: usize, interval: Angle| {
                (own[(at.unwrap_or(0) + k) % own.len()] - interval).degrees().abs()
            };
            intervals.iter().enumerate().map(|(k, &interval)| difference(k, interval)).sum::<f64>()
        };
        let all = Self::all_named(engine, order, strokes)?.into_iter();
        let nearest = all.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or_else(|| Self::named(engine, order, strokes, cancel), Ok)
    }

    /// The engine of a schedule, which keeps the turns in which its cylinders fire where these are not
    /// those of the most even one.
    pub fn kept(&self, cancel: &Cancel) -> Result<Engine> {
        let order = self.to_string();
        let engine = self.engine().firing_as(order.as_str(), self.strokes())?;
        let most_even = Self::named(self.engine(), &order.parse()?, self.strokes(), cancel)?;
        let is_chosen = most_even.later() != self.later();
        engine.with_turns(is_chosen.then(|| self.fires_in_second_turn()))
    }

    /// The schedule by which an engine fires: that of its gas or of the turns that were chosen, the most
    /// even one in its own firing order, or the only one.
    pub fn own(engine: &Arc<Engine>, cancel: &Cancel) -> Result<Self> {
        let strokes = engine.strokes();
        if !engine.firing_order().is_empty() {
            let order = engine.firing_order().parse()?;
            let of_turns = |later: &[bool]| {
                // Whichever turn is called the first.
                let same = |firing_of_order: &Self| {
                    let second = firing_of_order.fires_in_second_turn();
                    let turned: Vec<bool> = firing(engine).map(|i| second[i] != later[i]).collect();
                    turned.iter().all(|each| *each == turned[0])
                };
                Ok(Self::all_named(engine, &order, strokes)?.into_iter().find(same))
            };
            return match engine.turns().map_or(Ok(None), of_turns)? {
                Some(firing) => Ok(firing),
                None => Self::named(engine, &order, strokes, cancel),
            };
        }
        let mut hint = "the engine has none; give it one, such as 1-3-4-2".to_owned();
        if can_list(firing(engine).count(), strokes) {
            let mut possible = Self::all(engine, strokes, cancel)?;
            if possible.len() == 1 {
                return Ok(possible.swap_remove(0));
            }
            hint = format!("{hint}. Possible orders, most even first: {}", listed(&possible));
        }
        Err(Error::value("firing_order", "None", hint))
    }

    /// Every schedule for an engine to fire, the most even first.
    pub fn all(engine: &Arc<Engine>, strokes: Strokes, cancel: &Cancel) -> Result<Vec<Self>> {
        let highest = highest_points(engine)?;
        // The first begins the cycle, whose turns are those of the others.
        let others: Vec<usize> = firing(engine).skip(1).collect();
        let count = others.len() + 1;
        if !can_list(count, strokes) {
            let hint = format!(
                "all firing orders are listed for up to {MOST_CYLINDERS_LISTED} cylinders, 2 to the power of {}; \
                 name an order in place of it",
                MOST_CYLINDERS_LISTED - 1
            );
            return Err(Error::value("number of cylinders", count, hint));
        }
        let choices = if strokes == Strokes::Two { 1 } else { 1_usize << (count - 1) };
        let mut found = memory::with_capacity(choices)?;
        for choice in 0..choices {
            cancel.check()?;
            let mut later = vec![false; highest.len()];
            for (k, &cylinder) in (0..).zip(&others) {
                later[cylinder] = choice.checked_shr(k).unwrap_or(0) & 1 == 1;
            }
            found.push(Self::assemble(engine, &highest, strokes, &later));
        }
        most_even_first(&mut found);
        Ok(found)
    }
}

/// True if every schedule can be listed.
fn can_list(cylinders: usize, strokes: Strokes) -> bool {
    strokes == Strokes::Two || cylinders <= MOST_CYLINDERS_LISTED
}

fn most_even_first(firings: &mut [Firing]) {
    firings.sort_unstable_by(|a, b| {
        let evenness = unevenness(a).cmp(&unevenness(b));
        evenness
            .then_with(|| a.order().cmp(b.order()))
            .then_with(|| a.fire_in_second_turn().cmp(b.fire_in_second_turn()))
    });
}

/// Unevenness in millionths of a degree: equally even choices tie in spite of rounding.
fn unevenness(firing: &Firing) -> u64 {
    (firing.unevenness() * 1e6).round() as u64
}

/// The first few distinct orders, shortened, as a list.
fn listed(firings: &[Firing]) -> String {
    let mut texts: Vec<String> = Vec::new();
    for text in firings.iter().map(|firing| shorten(&firing.to_string())) {
        if texts.contains(&text) {
            continue;
        }
        if texts.len() == EXAMPLES {
            texts.push("…".to_owned());
            break;
        }
        texts.push(text);
    }
    texts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cylinder, engine, figures, intervals, placed, vee};
    use super::*;
    use crate::layout::Side;

    #[test]
    fn the_phases_of_an_engine_are_dead_centres_in_the_turn_of_firing() {
        // Crank angles of an inline-4 by its order, and of a vee with offset pins whose pistons are
        // highest asin(e/(l + r)) later, half of them a turn later.
        let four = placed(&[30.0, 210.0, 210.0, 30.0].map(|tdc| (cylinder(0.0), tdc, 90.0)));
        let four = |order: &str| four.firing_as(order, Strokes::Four).map(Arc::new).unwrap();
        let phases = |engine| figures(&Firing::own(&engine, &Cancel::new()).unwrap().phases());
        assert_eq!(phases(four("1-3-4-2")), [30.0, 570.0, 210.0, 390.0]);
        assert_eq!(phases(four("1-2-4-3")), [30.0, 210.0, 570.0, 390.0]);
        let past = (0.02_f64 / 0.2).asin().to_degrees();
        let mixed = [(cylinder(0.02), 700.0 - 360.0, 90.0), (cylinder(0.0), 340.0 + past, 90.0)];
        let together = placed(&mixed).firing_as("1-2", Strokes::Four).unwrap();
        assert_eq!(phases(Arc::new(together)), [340.0, (340.0 + past) % 360.0 + 360.0]);
        let unknown = Firing::own(&four(""), &Cancel::new()).unwrap_err().to_string();
        assert!(unknown.starts_with("firing_order = None: the engine has none"), "{unknown}");
        assert!(unknown.contains("1-2-4-3, 1-3-4-2"), "{unknown}");
    }

    #[test]
    fn an_order_within_one_turn_leaves_the_start_of_the_next_open() {
        let v6 = engine(&vee(60.0, 0.0, &[0.0, 120.0, 240.0], Side::Right));
        let order: FiringOrder = "1-2-5-6-3-4".parse().unwrap();
        let schedules = Firing::all_named(&v6, &order, Strokes::Four).unwrap();
        assert_eq!(schedules.len(), 6);
        for schedule in &schedules {
            let mut sorted = intervals(schedule);
            sorted.sort_by(f64::total_cmp);
            assert_eq!(sorted, [60.0, 60.0, 60.0, 60.0, 60.0, 420.0]);
        }
        let two_stroke = Firing::named(&v6, &order, Strokes::Two, &Cancel::new()).unwrap();
        assert_eq!(intervals(&two_stroke), [60.0; 6]);
    }

    #[test]
    fn cylinders_that_fire_together_are_told_and_read_back() {
        let boxer = engine(&vee(180.0, 180.0, &[0.0, 180.0], Side::Right));
        let schedules = Firing::all(&boxer, Strokes::Four, &Cancel::new()).unwrap();
        assert_eq!(schedules.len(), 8);
        for schedule in &schedules {
            let order: FiringOrder = schedule.to_string().parse().unwrap();
            assert_eq!(order.to_string(), schedule.to_string());
            assert!(Firing::all_named(&boxer, &order, Strokes::Four).unwrap().contains(schedule));
        }
        let together: FiringOrder = "3+4-1+2".parse().unwrap();
        let two_stroke = Firing::named(&boxer, &together, Strokes::Two, &Cancel::new()).unwrap();
        assert_eq!(two_stroke.to_string(), "1+2-3+4");
        assert_eq!(intervals(&two_stroke), [0.0, 180.0, 0.0, 180.0]);
        assert!(
            Firing::named(&boxer, &"1-2-3-4".parse().unwrap(), Strokes::Two, &Cancel::new())
                .is_err()
        );
    }

    /// A firing's own figures from its definition: each cylinder at its top in its own turn.
    #[test]
    fn every_way_to_fire_is_listed_once_and_tells_itself() {
        let tdcs = [40.0, 130.0, 305.5, 40.0];
        let engine = placed(&tdcs.map(|tdc| (cylinder(0.0), tdc, 90.0)));
        let schedules = Firing::all(&engine, Strokes::Four, &Cancel::new()).unwrap();
        assert_eq!(schedules.len(), 8);
        let mut choices: Vec<Vec<bool>> = schedules.iter().map(Firing::later).collect();
        for schedule in &schedules {
            let later = schedule.later();
            assert!(!later[0]);
            assert_eq!(&Firing::with_later(&engine, Strokes::Four, &later).unwrap(), schedule);
            // Times after the first firing, and angles 40° later.
            let after = |i: usize| {
                let top: f64 = (tdcs[i] - tdcs[0] + 360.0) % 360.0;
                top + if later[i] { 360.0 } else { 0.0 }
            };
            let angles: Vec<f64> = (0..4).map(|i| (after(i) + 40.0) % 720.0).collect();
            assert_eq!(figures(&schedule.angles()), angles);
            let mut times: Vec<f64> = schedule.order().iter().map(|&i| after(i)).collect();
            assert!(times.is_sorted() && schedule.order()[0] == 0);
            times.push(720.0);
            let gaps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert_eq!(intervals(schedule), gaps);
            let square: f64 = gaps.iter().map(|gap| (gap - 180.0).powi(2)).sum();
            assert!((schedule.unevenness() - (square / 4.0).sqrt()).abs() < 1e-12);
            assert!(!schedule.even());
        }
        assert!(schedules.is_sorted_by(|a, b| a.unevenness() <= b.unevenness() + 1e-6));
        choices.sort();
        choices.dedup();
        assert_eq!(choices.len(), 8);
        let [none, some] = [[false; 4], [false, true, false, false]];
        assert!(Firing::with_later(&engine, Strokes::Two, &some).is_err());
        assert!(Firing::with_later(&engine, Strokes::Two, &none).is_ok());
        assert!(Firing::with_later(&engine, Strokes::Four, &[true, false, false, false]).is_err());
        assert!(Firing::with_later(&engine, Strokes::Four, &[false; 3]).is_err());
        assert_eq!(Firing::all(&engine, Strokes::Two, &Cancel::new()).unwrap().len(), 1);
        let many = placed(&vec![(cylinder(0.0), 0.0, 90.0); MOST_CYLINDERS_LISTED + 1]);
        assert!(Firing::all(&many, Strokes::Four, &Cancel::new()).is_err());
        assert!(Firing::all(&many, Strokes::Two, &Cancel::new()).is_ok());
    }

    #[test]
    fn the_most_even_way_comes_first_however_near_the_others() {
        // Half of the schedules come within a degree of another.
        let tdcs = [0.0, 90.3, 180.4, 270.9];
        let engine = placed(&tdcs.map(|tdc| (cylinder(0.0), tdc, 90.0)));
        let schedules = Firing::all(&engine, Strokes::Four, &Cancel::new()).unwrap();
        let unevenness: Vec<f64> = schedules.iter().map(Firing::unevenness).collect();
        assert!(
            unevenness.windows(2).any(|pair| 1e-3 < pair[1] - pair[0] && pair[1] - pair[0] < 0.5)
        );
        assert!(unevenness.is_sorted_by(|a, b| *a <= b + 1e-6), "{unevenness:?}");
    }

    #[test]
    fn the_error_of_an_impossible_order_lists_possible_ones() {
        let engine = placed(&[0.0, 180.0, 180.0, 0.0].map(|tdc| (cylinder(0.0), tdc, 90.0)));
        let message = |order: &str, strokes| {
            Firing::named(&engine, &order.parse().unwrap(), strokes, &Cancel::new())
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            message("1-2-3-4", Strokes::Four),
            "firing_order = 1-2-3-4: this crank cannot fire in this order: its TDC sequence is 1+4, \
             2+3. Possible orders, most even first: 1-2-4-3, 1-3-4-2, 1-2+3-4, …"
        );
        assert_eq!(
            message("1-2-3-4", Strokes::Two),
            "firing_order = 1-2-3-4: this crank cannot fire in this order: its TDC sequence is 1+4, \
             2+3. Possible orders, most even first: 1+4-2+3"
        );
    }

    #[test]
    fn the_errors_of_an_engine_of_a_thousand_cylinders_are_short() {
        let engine = placed(&vec![(cylinder(0.0), 0.0, 90.0); 1000]);
        let numbers: Vec<String> = (1..=1000).map(|number| number.to_string()).collect();
        let order: FiringOrder = numbers.join("-").parse().unwrap();
        for strokes in [Strokes::Two, Strokes::Four] {
            let message =
                Firing::named(&engine, &order, strokes, &Cancel::new()).unwrap_err().to_string();
            assert!(message.len() < 1000, "{}", message.len());
        }
        let message = "9-".repeat(500_000).parse::<FiringOrder>().unwrap_err().to_string();
        assert!(message.len() < 1000, "{}", message.len());
    }
}
