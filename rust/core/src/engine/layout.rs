//! Common layouts of engines from a few figures: throws, bank angle, firing order.

pub use super::firing_order::FiringOrder;
use super::{Engine, Station, bank_angle_in_range, check_each_cylinder, check_number};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::angle::{Angle, MOST_ROUNDING};
use crate::numbers::decimal;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
pub use crate::pressure::Strokes;

/// A bank of a vee, seen from the flywheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// At x > 0.
    Right,
    /// At x < 0.
    Left,
}

/// How the cylinders of a vee are numbered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Numbering {
    /// Along the crank, from bank to bank: 1 and 2 on the first throw.
    Alternating,
    /// Along one bank, then along the other.
    ByBank,
}

/// Distances of neighbouring throws along the crank.
#[derive(Debug, Clone, PartialEq)]
pub enum Spacing {
    /// One for all, m.
    Even(f64),
    /// That of each throw from the one before it, m.
    Each(Vec<f64>),
}

impl Spacing {
    /// Places of this many throws, the first at 0.
    pub(super) fn places(&self, throws: usize) -> Result<Vec<f64>> {
        let distances = match self {
            Self::Even(distance) => {
                limits::distance("spacing", *distance)?;
                return Ok((0..throws)
                    .map(|throw| decimal::product(throw as f64, *distance))
                    .collect());
            }
            Self::Each(distances) => distances,
        };
        if distances.is_empty() || distances.iter().any(|each| *each <= 0.0 || !each.is_finite()) {
            let hint =
                "give metres, or a list with the distance of each throw from the one before it";
            return Err(Error::value("spacing", format!("{distances:?}"), hint));
        }
        let gaps = throws.saturating_sub(1);
        limits::same_length("spacing", distances.len(), "the crank", gaps, "gap between throws")?;
        let place = |at: &mut f64, distance: &f64| {
            *at = decimal::sum(*at, *distance);
            Some(*at)
        };
        Ok([0.0].into_iter().chain(distances.iter().scan(0.0, place)).collect())
    }
}

/// How a firing order fixes the crank.
#[derive(Debug, Clone, PartialEq)]
pub enum FiringRule {
    /// Equal intervals: pins are split wherever the bank angle asks for it.
    Even(Strokes),
    /// These intervals, from each cylinder of the order to the next and from the last to the first.
    Intervals(Strokes, Vec<Angle>),
    /// The IJESC paper's: within each bank the cylinders, in the order in which they fire, lag by
    /// equal parts of a turn; the lags of both banks start from the same crank angle.
    Ijesc,
}

/// An upright engine of one bank.
#[derive(Debug, Clone, PartialEq)]
pub struct Inline {
    /// Crankpin angles in the direction of rotation, relative to each other, front to flywheel.
    pub throws: Vec<Angle>,
    /// Distances between neighbouring cylinders.
    pub spacing: Spacing,
    /// Mass that turns with each cylinder's pin, kg: none, one for all, or one for each.
    pub rotating_mass: Vec<f64>,
    /// Crank angle at which cylinder 1 is at top dead centre.
    pub first_tdc: Angle,
}

impl Inline {
    /// The engine with this cylinder throughout.
    pub fn engine(&self, cylinder: Cylinder) -> Result<Engine> {
        let places = self.spacing.places(self.throws.len())?;
        let upright = Angle::QUARTER_TURN;
        let masses = per_cylinder(&self.rotating_mass, self.throws.len())?;
        let stations = self.throws.iter().zip(masses).zip(places).map(|((&throw, mass), z)| {
            Station { cylinder, tdc: upright - throw, bank: upright, z, rotating_mass: mass }
        });
        Ok(Engine::new("", "", stations.collect())?.with_first_tdc(self.first_tdc))
    }
}

/// An upright vee: two cylinders to a throw, one in each bank.
#[derive(Debug, Clone, PartialEq)]
pub struct Vee {
    /// Angle between the banks.
    pub bank_angle: Angle,
    /// Crankpin angles of the right bank, in the direction of rotation, front to flywheel.
    pub throws: Vec<Angle>,
    /// Distances between neighbouring throws.
    pub spacing: Spacing,
    /// Left pin minus right pin, in the direction of rotation.
    pub pin_split: Angle,
    /// How far the left bank stands behind the right, towards the flywheel, m.
    pub bank_stagger: f64,
    /// Mass that turns with each cylinder's pin, kg: none, one for all, or one for each.
    pub rotating_mass: Vec<f64>,
    /// How the cylinders are numbered.
    pub numbering: Numbering,
    /// Numbers of cylinders that are not there; those that are there are numbered anew.
    pub absent: Vec<usize>,
    /// The bank with cylinder 1.
    pub first_bank: Side,
    /// Crank angle at which cylinder 1 is at top dead centre.
    pub first_tdc: Angle,
}

impl Vee {
    /// The engine with this cylinder throughout.
    pub fn engine(&self, cylinder: Cylinder) -> Result<Engine> {
        let count = 2 * self.throws.len();
        if let Some(number) = self.absent.iter().find(|number| !(1..=count).contains(*number)) {
            let hint = format!("the whole vee has cylinders 1 to {count}");
            return Err(Error::value("absent", number, hint));
        }
        let seats = self.seats(count)?.into_iter().enumerate();
        let seats = seats.filter(|(i, _)| !self.absent.contains(&(i + 1))).map(|(_, seat)| {
            let split = if seat.side == Side::Left { self.pin_split } else { Angle::ZERO };
            let tdc = seat.bank - (self.throws[seat.throw] + split);
            (seat, tdc)
        });
        let seats: Vec<_> = seats.collect();
        if seats.is_empty() && count > 0 {
            let all = format!("{:?}", self.absent);
            return Err(Error::value("absent", all, "leave one cylinder at least"));
        }
        self.seated(cylinder, &seats)
    }

    /// The engine with a cylinder in each seat, at top dead centre at these crank angles.
    fn seated(&self, cylinder: Cylinder, seats: &[(Seat, Angle)]) -> Result<Engine> {
        let masses = per_cylinder(&self.rotating_mass, seats.len())?;
        let stations = seats.iter().zip(masses).map(|((seat, tdc), rotating_mass)| Station {
            cylinder,
            tdc: *tdc,
            bank: seat.bank,
            z: seat.z,
            rotating_mass,
        });
        let sides: Vec<usize> = seats.iter().map(|(seat, _)| seat.side as usize).collect();
        let engine = Engine::in_banks("", "", stations.collect(), &sides)?;
        Ok(engine.with_first_tdc(self.first_tdc))
    }

    /// Where each cylinder sits, by number; `throws` is ignored.
    pub(crate) fn seats(&self, cylinders: usize) -> Result<Vec<Seat>> {
        let throws = cylinders / 2;
        let places = self.spacing.places(throws)?;
        limits::finite("bank_stagger", self.bank_stagger)?;
        bank_angle_in_range(self.bank_angle.degrees())?;
        let (upright, half) = (Angle::QUARTER_TURN, self.bank_angle.half());
        let seat = |i: usize| {
            let (throw, on_first) = match self.numbering {
                Numbering::Alternating => (i / 2, i.is_multiple_of(2)),
                Numbering::ByBank => (i % throws, i < throws),
            };
            let side = match (self.first_bank, on_first) {
                (Side::Right, true) | (Side::Left, false) => Side::Right,
                _ => Side::Left,
            };
            let (bank, stagger) = match side {
                Side::Right => (upright - half, 0.0),
                Side::Left => (upright + half, self.bank_stagger),
            };
            Seat { throw, side, bank, z: decimal::sum(places[throw], stagger) }
        };
        Ok((0..cylinders).map(seat).collect())
    }
}

/// An engine with a cylinder of every bank on every throw, such as a W or an X.
///
/// Cylinders are numbered bank by bank, each from the front to the flywheel.
#[derive(Debug, Clone, PartialEq)]
pub struct MultiBankLayout {
    /// Directions of the banks from +x.
    pub banks: Vec<Angle>,
    /// How far each bank stands behind the one before it, m.
    pub bank_stagger: f64,
    /// What stands along the crank.
    pub along: Inline,
}

impl MultiBankLayout {
    /// The engine with this cylinder throughout.
    pub fn engine(&self, cylinder: Cylinder) -> Result<Engine> {
        let Inline { throws, spacing, rotating_mass, first_tdc } = &self.along;
        check_number(self.banks.len().saturating_mul(throws.len()))?;
        let places = spacing.places(throws.len())?;
        limits::finite("bank_stagger", self.bank_stagger)?;
        let mut masses = per_cylinder(rotating_mass, self.banks.len() * throws.len())?.into_iter();
        let (mut stations, mut keys) = (Vec::new(), Vec::new());
        for (key, &bank) in self.banks.iter().enumerate() {
            for (&throw, place) in throws.iter().zip(&places) {
                let z = decimal::sum(*place, decimal::product(key as f64, self.bank_stagger));
                let rotating_mass = masses.next().unwrap_or_default();
                stations.push(Station { cylinder, tdc: bank - throw, bank, z, rotating_mass });
                keys.push(key);
            }
        }
        Ok(Engine::in_banks("", "", stations, &keys)?.with_first_tdc(*first_tdc))
    }
}

/// Where a cylinder of a vee sits.
pub(crate) struct Seat {
    pub throw: usize,
    pub side: Side,
    bank: Angle,
    z: f64,
}

impl FiringOrder {
    /// Crank angles after the first firing at which the first, second … cylinder fires.
    fn times(&self, rule: &FiringRule) -> Result<Vec<Angle>> {
        self.check_complete()?;
        let together = self.together();
        let count = together.len();
        let (strokes, intervals) = match rule {
            FiringRule::Even(strokes) => {
                let firings = together.iter().filter(|with_former| !**with_former).count();
                let ranks = together.iter().scan(0, |begun, with_former| {
                    *begun += usize::from(!with_former);
                    Some(*begun - 1)
                });
                let cycle = 360 * strokes.turns();
                return Ok(ranks.map(|rank| part(rank, cycle, firings)).collect());
            }
            FiringRule::Intervals(strokes, intervals) => (*strokes, intervals),
            FiringRule::Ijesc if self.has_groups() => {
                let hint = "the rule \"ijesc\" knows no cylinders that fire together; give an order \
                            without '+', or leave the rule out";
                return Err(Error::value("firing_order", self, hint));
            }
            // One bank has the same crank by either rule.
            FiringRule::Ijesc => return self.times(&FiringRule::Even(Strokes::Four)),
        };
        let joined = together.iter().filter(|joined| **joined).count();
        if joined > 0 && intervals.len() + joined == count {
            let hint = format!(
                "give {count}, one for each cylinder: 0 between those joined by '+', such as \
                 0,180,540 for 1+2-3"
            );
            return Err(Error::value("number of intervals_deg", intervals.len(), hint));
        }
        limits::same_length("intervals_deg", intervals.len(), "firing_order", count, "cylinder")?;
        let mut times = vec![Angle::ZERO];
        for (k, &interval) in intervals.iter().enumerate() {
            let joined = together.get(k + 1) == Some(&true);
            let hint = match interval.degrees() {
                degrees if joined && degrees != 0.0 => "give 0 between cylinders joined by '+'",
                degrees if !joined && degrees <= 0.0 => {
                    "give degrees above 0, or join cylinders that fire together by '+'"
                }
                _ => {
                    times.push(times[k] + interval);
                    continue;
                }
            };
            return Err(Error::value(format!("intervals_deg[{k}]"), interval, hint));
        }
        let (sum, cycle) = (times.pop().unwrap_or(Angle::ZERO), strokes.cycle());
        // Intervals that are no parts of a turn may have been rounded, once each.
        if (sum - cycle).degrees().abs() > MOST_ROUNDING {
            let hint = format!(
                "make them add up to {cycle}, the cycle of a {}-stroke",
                if strokes == Strokes::Four { "four" } else { "two" }
            );
            return Err(Error::value("sum of intervals_deg", sum, hint));
        }
        Ok(times)
    }

    /// When each cylinder fires, by number: 0 for the first.
    fn ranks(&self) -> Vec<usize> {
        let cylinders = self.cylinders();
        let mut ranks = vec![0; cylinders.len()];
        for (rank, cylinder) in cylinders.into_iter().enumerate() {
            ranks[cylinder - 1] = rank;
        }
        ranks
    }

    /// An upright inline engine that fires so; `layout.throws` is not asked.
    pub fn inline(&self, cylinder: Cylinder, rule: &FiringRule, layout: &Inline) -> Result<Engine> {
        Inline { throws: self.throws(rule)?, ..layout.clone() }.engine(cylinder)
    }

    /// Crankpins of an inline engine that fires so, in the direction of rotation.
    pub(crate) fn throws(&self, rule: &FiringRule) -> Result<Vec<Angle>> {
        let times = self.times(rule)?;
        Ok(self.ranks().into_iter().map(|rank| -times[rank]).collect())
    }

    /// Directions of the crankpins of a vee that fires so, at a crank angle of no meaning.
    pub(crate) fn vee_pins(&self, rule: &FiringRule, layout: &Vee) -> Result<Vec<Angle>> {
        Ok(self.vee_seats(rule, layout)?.iter().map(|(seat, tdc)| seat.bank - *tdc).collect())
    }

    /// A vee that fires so; `layout.throws` and `layout.pin_split` are not asked.
    pub fn vee(&self, cylinder: Cylinder, rule: &FiringRule, layout: &Vee) -> Result<Engine> {
        layout.seated(cylinder, &self.vee_seats(rule, layout)?)
    }

    /// Where each cylinder of a vee sits, and its top dead centre.
    fn vee_seats(&self, rule: &FiringRule, layout: &Vee) -> Result<Vec<(Seat, Angle)>> {
        let count = self.cylinders().len();
        if count % 2 == 1 {
            let hint = format!(
                "has {count} cylinders and a vee an even number; leave out the bank angle for an \
                 inline engine, or build one of {} by its throws and leave a cylinder out: \
                 a `Vee` with `absent: [{}]` and this firing order",
                count + 1,
                count + 1
            );
            return Err(Error::value("firing_order", self.to_string(), hint));
        }
        let times = self.times(rule)?;
        let ranks = self.ranks();
        let seats = layout.seats(count)?;
        // An order has no beginning: from cylinder 1 on.
        let since_first = |rank: usize| (rank + count - ranks[0]) % count;
        let tdc = |seat: &Seat, rank: usize| match rule {
            FiringRule::Even(_) | FiringRule::Intervals(..) => times[rank],
            FiringRule::Ijesc => {
                let fired_before = seats
                    .iter()
                    .zip(&ranks)
                    .filter(|&(other, &earlier)| {
                        other.side == seat.side && since_first(earlier) < since_first(rank)
                    })
                    .count();
                // Top dead centre at φ ∓ γ, up to a turn of the whole crank.
                seat.bank + part(fired_before, 360, count / 2)
            }
        };
        let tdcs: Vec<Angle> =
            seats.iter().zip(&ranks).map(|(seat, &rank)| tdc(seat, rank)).collect();
        Ok(seats.into_iter().zip(tdcs).collect())
    }
}

/// `index` of `count` equal parts of this many degrees.
fn part(index: usize, degrees: i64, count: usize) -> Angle {
    // Both are at most the number of cylinders.
    let (index, count) = (index as i64, count as i64);
    Angle::from_degree_fraction(index * degrees, count.max(1)).unwrap_or(Angle::ZERO)
}

/// One mass for each cylinder; a single one is for all.
pub(super) fn per_cylinder(masses: &[f64], cylinders: usize) -> Result<Vec<f64>> {
    for (i, &mass) in masses.iter().enumerate() {
        limits::not_negative(&format!("rotating_mass[{i}]"), mass)?;
    }
    match masses {
        [] => Ok(vec![0.0; cylinders]),
        [mass] => Ok(vec![*mass; cylinders]),
        _ => {
            check_each_cylinder("rotating_mass", masses.len(), cylinders)?;
            Ok(masses.to_vec())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vee(bank_angle: f64, numbering: Numbering, first_bank: Side) -> Vee {
        Vee {
            bank_angle: Angle::from_degrees(bank_angle).unwrap(),
            throws: Vec::new(),
            spacing: Spacing::Even(0.1),
            pin_split: Angle::ZERO,
            bank_stagger: 0.0,
            rotating_mass: Vec::new(),
            numbering,
            absent: Vec::new(),
            first_bank,
            first_tdc: Angle::ZERO,
        }
    }

    fn cylinder() -> Cylinder {
        Cylinder::new(0.045, 0.158, 1.487, 0.0).unwrap()
    }

    fn pins(engine: &Engine) -> Vec<f64> {
        let pin = |i| (engine.pin(i) - engine.pin(0)).reduced().degrees();
        (0..engine.stations().len()).map(pin).collect()
    }

    #[test]
    fn the_cross_plane_crank_follows_from_its_firing_order() {
        let order: FiringOrder = "1-8-4-3-6-5-7-2".parse().unwrap();
        let layout = vee(90.0, Numbering::Alternating, Side::Left);
        let engine = order.vee(cylinder(), &FiringRule::Even(Strokes::Four), &layout).unwrap();
        assert_eq!(pins(&engine), [0.0, 0.0, 90.0, 90.0, 270.0, 270.0, 180.0, 180.0]);
    }

    #[test]
    fn the_ijesc_rule_gives_each_bank_its_own_lags() {
        let order: FiringOrder = "1-4-5-2-3-6".parse().unwrap();
        let layout = vee(60.0, Numbering::Alternating, Side::Right);
        let engine = order.vee(cylinder(), &FiringRule::Ijesc, &layout).unwrap();
        // cylinders (1, 3, 5) lag by 0, 240, 120 and (2, 4, 6) by 120, 0, 240
        assert_eq!(pins(&engine), [0.0, 240.0, 120.0, 0.0, 240.0, 120.0]);
    }

    #[test]
    fn the_ijesc_rule_takes_a_firing_order_from_any_cylinder_on() {
        let layout = vee(60.0, Numbering::Alternating, Side::Right);
        let engine = |order: &str| {
            let order: FiringOrder = order.parse().unwrap();
            order.vee(cylinder(), &FiringRule::Ijesc, &layout).unwrap()
        };
        for order in ["4-5-2-3-6-1", "5-2-3-6-1-4", "6-1-4-5-2-3"] {
            assert_eq!(engine(order), engine("1-4-5-2-3-6"), "{order}");
        }
    }

    #[test]
    fn even_firing_of_a_60_degree_v6_splits_its_pins_by_minus_60() {
        let order: FiringOrder = "1-2-3-4-5-6".parse().unwrap();
        let layout = vee(60.0, Numbering::Alternating, Side::Right);
        let engine = order.vee(cylinder(), &FiringRule::Even(Strokes::Four), &layout).unwrap();
        assert_eq!(pins(&engine)[1], 300.0);
    }

    #[test]
    fn strokes_are_two_or_four() {
        for number in [2, 4] {
            assert_eq!(Strokes::from_number(number).unwrap().number(), number);
            assert_eq!(Strokes::from_number(number).unwrap().turns(), i64::from(number / 2));
        }
        assert!(Strokes::from_number(3).is_err());
    }

    #[test]
    fn cylinders_sit_where_the_numbering_says() {
        let angle = |degrees| Angle::from_degrees(degrees).unwrap();
        let place = |numbering, first_bank| {
            let layout = Vee {
                throws: [0.0, 100.0, 240.0].map(angle).to_vec(),
                pin_split: angle(20.0),
                bank_stagger: 0.03,
                rotating_mass: vec![0.5],
                first_tdc: angle(7.0),
                ..vee(70.0, numbering, first_bank)
            };
            let engine = layout.engine(cylinder()).unwrap();
            // Bank, place, mass, pin relative to the first cylinder's.
            assert_eq!(engine.stations()[0].tdc, angle(7.0));
            let of = |(p, pin): (&Station, f64)| (p.bank.degrees(), p.z, p.rotating_mass, pin);
            engine.stations().iter().zip(pins(&engine)).map(of).collect::<Vec<_>>()
        };
        let right = [(55.0, 0.0, 0.5, 0.0), (55.0, 0.1, 0.5, 100.0), (55.0, 0.2, 0.5, 240.0)];
        let left = [
            (125.0, 0.03, 0.5, 20.0),
            (125.0, 0.1 + 0.03, 0.5, 120.0),
            (125.0, 0.2 + 0.03, 0.5, 260.0),
        ];
        let [a, b, c] = right;
        let [d, e, f] = left;
        assert_eq!(place(Numbering::Alternating, Side::Right), [a, d, b, e, c, f]);
        assert_eq!(place(Numbering::ByBank, Side::Right), [a, b, c, d, e, f]);
        let back = |places: [(f64, f64, f64, f64); 6]| {
            places.map(|(bank, z, mass, pin)| (bank, z, mass, (pin + 340.0) % 360.0))
        };
        assert_eq!(place(Numbering::Alternating, Side::Left), back([d, a, e, b, f, c]));
        assert_eq!(place(Numbering::ByBank, Side::Left), back([d, e, f, a, b, c]));
    }

    #[test]
    fn an_inline_engine_stands_upright_along_the_crank() {
        let angle = |degrees| Angle::from_degrees(degrees).unwrap();
        let layout = Inline {
            throws: [0.0, 120.0, 240.0].map(angle).to_vec(),
            spacing: Spacing::Even(0.1),
            rotating_mass: vec![0.7],
            first_tdc: angle(30.0),
        };
        let engine = layout.engine(cylinder()).unwrap();
        let of = |p: &Station| (p.tdc.degrees(), p.bank.degrees(), p.z, p.rotating_mass);
        let found: Vec<_> = engine.stations().iter().map(of).collect();
        // A throw 120° ahead is at the top 120° earlier.
        let expected = [(30.0, 90.0, 0.0, 0.7), (270.0, 90.0, 0.1, 0.7), (150.0, 90.0, 0.2, 0.7)];
        assert_eq!(found, expected);
        let order: FiringOrder = "1-3-2".parse().unwrap();
        let rule = FiringRule::Even(Strokes::Four);
        // 3 fires 240° after 1: the throws given are not asked.
        let fired = order.inline(cylinder(), &rule, &layout).unwrap();
        let tdcs: Vec<f64> = fired.stations().iter().map(|p| p.tdc.degrees()).collect();
        assert_eq!(tdcs, [30.0, 150.0, 270.0]);
        for (masses, fits) in [(vec![], true), (vec![1.0, 2.0, 3.0], true), (vec![1.0; 2], false)] {
            let layout = Inline { rotating_mass: masses, ..layout.clone() };
            assert_eq!(layout.engine(cylinder()).is_ok(), fits);
        }
        let negative = Inline { rotating_mass: vec![-1.0], ..layout };
        assert!(negative.engine(cylinder()).is_err());
    }

    #[test]
    fn cylinders_that_fire_together_are_at_the_top_together() {
        let angle = |degrees| Angle::from_degrees(degrees).unwrap();
        let throws = |order: &str, rule: &FiringRule| {
            let throws = order.parse::<FiringOrder>().unwrap().throws(rule)?;
            Ok(throws.iter().map(|each| each.reduced().degrees()).collect::<Vec<_>>())
        };
        let given = |intervals: &[f64]| {
            FiringRule::Intervals(
                Strokes::Four,
                intervals.iter().map(|&each| angle(each)).collect(),
            )
        };
        // Two firings in a cycle are a turn apart in a four-stroke, half a turn in a two-stroke.
        assert_eq!(throws("1+4-2+3", &FiringRule::Even(Strokes::Four)), Ok(vec![0.0; 4]));
        let expected = Ok(vec![0.0, 180.0, 180.0, 0.0]);
        assert_eq!(throws("1 + 4 - 2 + 3", &FiringRule::Even(Strokes::Two)), expected);
        assert_eq!(throws("1+4-2+3", &given(&[0.0, 180.0, 0.0, 540.0])), expected);
        assert_eq!(throws("2-1+3", &FiringRule::Even(Strokes::Two)), Ok(vec![180.0, 0.0, 180.0]));
        let message = |intervals: &[f64]| {
            let error: Error = throws("1+4-2+3", &given(intervals)).unwrap_err();
            error.to_string()
        };
        assert!(message(&[180.0, 180.0, 180.0, 180.0]).contains("[0] = 180: give 0 between"));
        assert!(message(&[0.0, 0.0, 0.0, 720.0]).contains("[1] = 0: give degrees above 0"));
        assert!(message(&[0.0, 180.0, 0.0, 180.0]).contains("make them add up to 720"));
        assert!(throws("1+4-2+3", &FiringRule::Ijesc).is_err());
        // A flat twin whose pistons reach the top together has opposite pins.
        let boxer = "1+2".parse::<FiringOrder>().unwrap();
        let layout = vee(180.0, Numbering::Alternating, Side::Right);
        let engine = boxer.vee(cylinder(), &FiringRule::Even(Strokes::Four), &layout).unwrap();
        assert_eq!(pins(&engine), [0.0, 180.0]);
    }

    #[test]
    fn vees_by_firing_order_give_each_cylinder_its_rotating_mass() {
        let layout = Vee {
            rotating_mass: vec![0.5, 0.5, 1.0, 1.0],
            first_tdc: Angle::from_turns(1, 12).unwrap(),
            ..vee(90.0, Numbering::Alternating, Side::Right)
        };
        let order: FiringOrder = "1-3-4-2".parse().unwrap();
        let engine = order.vee(cylinder(), &FiringRule::Even(Strokes::Four), &layout).unwrap();
        let masses: Vec<f64> = engine.stations().iter().map(|p| p.rotating_mass).collect();
        assert_eq!(masses, [0.5, 0.5, 1.0, 1.0]);
        let tdcs: Vec<f64> = engine.stations().iter().map(|p| p.tdc.degrees()).collect();
        assert_eq!(tdcs, [30.0, 210.0, 210.0, 30.0]);
        let any = vee(90.0, Numbering::ByBank, Side::Right);
        for (order, fits) in [("1-2", true), ("1-2-3", false), ("1-2-3-4-5", false)] {
            let order: FiringOrder = order.parse().unwrap();
            assert_eq!(order.vee(cylinder(), &FiringRule::Ijesc, &any).is_ok(), fits);
        }
    }
}
