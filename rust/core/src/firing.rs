//! When the cylinders of an engine fire, and which pins a firing order needs.
//!
//! A cylinder fires when its piston is highest: at top dead centre, or with a pin offset e where
//! crank and rod are in line, asin(e/(l + r)) later. A crank tells this within a turn; in a
//! four-stroke each cylinder fires in one of two turns, which its camshaft chooses. The turns are
//! counted from the first cylinder's firing, so that they do not depend on where θ is zero.
//!
//! Angles that are parts of a turn are exact, and with them what is said to be even or
//! simultaneous; others are told apart when more than [`MOST_ROUNDING`] lies between them.

use std::cmp::Ordering;
use std::str::FromStr;
use std::sync::Arc;

use crate::angle::Angle;
use crate::engine::{Engine, Placement};
use crate::error::{Error, Result, shorten};
use crate::layout::{FiringOrder, FiringRule, MOST_ROUNDING, Side, Strokes, Vee};

/// Most cylinders of which all orders are listed: a V16 has 2¹⁵ choices of turns.
pub const MOST_LISTED: usize = 16;
/// Orders that an error shows to say what is possible.
const EXAMPLES: usize = 3;

/// One way for an engine to fire: cylinders by index from 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Firing {
    engine: Arc<Engine>,
    strokes: Strokes,
    /// Crank angles after the first cylinder's firing, within a cycle.
    times: Vec<Angle>,
    order: Vec<usize>,
    intervals: Vec<Angle>,
}

/// An order in which an engine is asked to fire, such as 1-3-4-2, or 1+4-2+3 for cylinders that
/// fire together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedOrder {
    /// Cylinders by index from 0, from the first cylinder on.
    cylinders: Vec<usize>,
    /// Whether each fires together with the one before it.
    together: Vec<bool>,
}

impl FromStr for NamedOrder {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let parts = text.split(['-', ',', ' ']).filter(|part| !part.is_empty());
        let groups: std::result::Result<Vec<Vec<usize>>, _> =
            parts.map(|part| part.split('+').map(str::parse).collect()).collect();
        let Ok(mut groups) = groups else {
            let cure = "give cylinder numbers joined by '-', such as 1-3-4-2, those that fire \
                        together by '+'";
            return Err(Error::value("firing_order", text, cure));
        };
        let order = FiringOrder::new(groups.concat())?;
        // An order has no beginning: from cylinder 1, as is the custom.
        let first = groups.iter().position(|group| group.contains(&1)).unwrap_or(0);
        groups.rotate_left(first);
        let mut named = Self { cylinders: Vec::new(), together: Vec::new() };
        for mut group in groups {
            group.sort_unstable();
            named.together.extend((0..group.len()).map(|k| k > 0));
            named.cylinders.extend(group.iter().map(|number| number - 1));
        }
        debug_assert_eq!(named.cylinders.len(), order.cylinders().len());
        Ok(named)
    }
}

impl std::fmt::Display for NamedOrder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (k, (cylinder, &together)) in self.cylinders.iter().zip(&self.together).enumerate() {
            let joint = if k == 0 {
                ""
            } else if together {
                "+"
            } else {
                "-"
            };
            write!(f, "{joint}{}", cylinder + 1)?;
        }
        Ok(())
    }
}

/// From one cylinder's firing to the next one's in a group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Index of the cylinder that fires first.
    pub before: usize,
    /// Index of the next one; the same where it is alone.
    pub after: usize,
    /// Crank angle between them.
    pub gap: Angle,
}

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

/// When valves open and close.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValveTiming {
    intake: [Angle; 2],
    exhaust: [Angle; 2],
}

impl ValveTiming {
    /// The intake valve opens before top and closes after bottom dead centre, the exhaust valve
    /// opens before bottom and closes after top dead centre, by these angles.
    pub fn new(
        intake_opens: Angle,
        intake_closes: Angle,
        exhaust_opens: Angle,
        exhaust_closes: Angle,
    ) -> Result<Self> {
        let given = [
            ("intake_opens_deg", intake_opens),
            ("intake_closes_deg", intake_closes),
            ("exhaust_opens_deg", exhaust_opens),
            ("exhaust_closes_deg", exhaust_closes),
        ];
        for (argument, angle) in given {
            let degrees = angle.degrees();
            if !(-90.0 < degrees && degrees <= 180.0) {
                let cure = "give degrees above -90 and up to 180";
                return Err(Error::value(argument, angle, cure));
            }
        }
        Ok(Self { intake: [intake_opens, intake_closes], exhaust: [exhaust_opens, exhaust_closes] })
    }
}

/// When the ports of a two-stroke open and close.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PortTiming {
    transfer: Angle,
    exhaust: Angle,
}

impl PortTiming {
    /// Each opens before bottom dead centre by its angle, and closes as much after it.
    pub fn new(transfer_opens: Angle, exhaust_opens: Angle) -> Result<Self> {
        let given = [("transfer_opens_deg", transfer_opens), ("exhaust_opens_deg", exhaust_opens)];
        for (argument, angle) in given {
            if !(0.0 < angle.degrees() && angle.degrees() < 180.0) {
                let cure = "give degrees above 0 and below 180";
                return Err(Error::value(argument, angle, cure));
            }
        }
        Ok(Self { transfer: transfer_opens, exhaust: exhaust_opens })
    }
}

/// From opening to closing, or from beginning to end of a stroke: the first within a cycle, the
/// second after it.
pub type Period = [Angle; 2];

/// Periods of each cylinder.
pub type Periods = Vec<Period>;

/// Periods in which valves are open.
#[derive(Debug, Clone, PartialEq)]
pub struct Valves {
    /// Of the intake valves.
    pub intake: Periods,
    /// Of the exhaust valves.
    pub exhaust: Periods,
}

/// Periods in which ports are open.
#[derive(Debug, Clone, PartialEq)]
pub struct Ports {
    /// Of the transfer ports.
    pub transfer: Periods,
    /// Of the exhaust ports.
    pub exhaust: Periods,
}

impl Firing {
    /// Every choice of turns by which an engine fires in this order, the most even first.
    pub fn all_named(
        engine: &Arc<Engine>,
        order: &NamedOrder,
        strokes: Strokes,
    ) -> Result<Vec<Self>> {
        let tops = Tops::of(engine);
        let count = tops.0.len();
        if order.cylinders.len() != count {
            let cure = format!("name each of the engine's {count} cylinders once");
            return Err(Error::value("firing_order", order, cure));
        }
        // Within a turn cylinders fire as they reach the top; the order may go back to an earlier
        // top once, where the second turn begins.
        let mut second_turn_at = Vec::new();
        for k in 1..count {
            let [before, now] = [k - 1, k].map(|k| tops.0[order.cylinders[k]]);
            if order.together[k] {
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
                (1..=count).filter(|&k| order.together.get(k) != Some(&true)).collect()
            }
            (Strokes::Two, []) => vec![count],
            _ => Vec::new(),
        };
        let mut found: Vec<Self> = splits
            .into_iter()
            .map(|split| {
                let mut later = vec![false; count];
                for &cylinder in &order.cylinders[split..] {
                    later[cylinder] = true;
                }
                Self::assemble(engine, &tops, strokes, &later)
            })
            .collect();
        most_even_first(&mut found);
        Ok(found)
    }

    /// The most even way for an engine to fire in this order.
    pub fn named(engine: &Arc<Engine>, order: &NamedOrder, strokes: Strokes) -> Result<Self> {
        if let Some(found) = Self::all_named(engine, order, strokes)?.into_iter().next() {
            return Ok(found);
        }
        let within_a_turn = Self::assemble(
            engine,
            &Tops::of(engine),
            Strokes::Two,
            &vec![false; engine.placements().len()],
        );
        let turn = shorten(&within_a_turn.to_string());
        let cure = match strokes {
            Strokes::Two => format!("this crank reaches its top dead centres as {turn}"),
            Strokes::Four => {
                let mut cure = format!(
                    "this crank cannot fire so: its top dead centres come as {turn} in a turn, and \
                     each cylinder fires at every second of its own"
                );
                if let Ok(possible) = Self::all(engine, strokes) {
                    let mut texts: Vec<String> = Vec::new();
                    for text in possible.iter().map(ToString::to_string) {
                        if !texts.contains(&text) && texts.len() < EXAMPLES {
                            texts.push(text);
                        }
                    }
                    cure = format!("{cure}, most evenly {}", texts.join(" or "));
                }
                cure
            }
        };
        Err(Error::value("firing_order", order, cure))
    }

    /// Every way for an engine to fire, the most even first.
    pub fn all(engine: &Arc<Engine>, strokes: Strokes) -> Result<Vec<Self>> {
        let tops = Tops::of(engine);
        let count = tops.0.len();
        let choices = match strokes {
            Strokes::Two => 1_u32,
            Strokes::Four if count <= MOST_LISTED => 1 << (count - 1),
            Strokes::Four => {
                let cure = format!(
                    "all firing orders are listed for up to {MOST_LISTED} cylinders, 2 to the power \
                     of {}; name an order in place of it",
                    MOST_LISTED - 1
                );
                return Err(Error::value("number of cylinders", count, cure));
            }
        };
        let mut found: Vec<Self> = (0..choices)
            .map(|choice| {
                let later: Vec<bool> =
                    (0..count).map(|i| i > 0 && choice >> (i - 1) & 1 == 1).collect();
                Self::assemble(engine, &tops, strokes, &later)
            })
            .collect();
        most_even_first(&mut found);
        Ok(found)
    }

    /// The way to fire in which these cylinders do so in the second turn after the first cylinder.
    pub fn with_later(engine: &Arc<Engine>, strokes: Strokes, later: &[bool]) -> Result<Self> {
        let count = engine.placements().len();
        if later.len() != count || later[0] || (strokes == Strokes::Two && later.contains(&true)) {
            let cure = "give 0 or 1 for each cylinder, 0 for the first and in a two-stroke";
            return Err(Error::value("revolutions", format!("{later:?}"), cure));
        }
        Ok(Self::assemble(engine, &Tops::of(engine), strokes, later))
    }

    fn assemble(engine: &Arc<Engine>, tops: &Tops, strokes: Strokes, later: &[bool]) -> Self {
        let turn = |later| if later { Angle::TURN } else { Angle::ZERO };
        let times: Vec<Angle> =
            tops.0.iter().zip(later).map(|(&top, &later)| top + turn(later)).collect();
        let mut order: Vec<usize> = (0..times.len()).collect();
        order.sort_by(|&a, &b| times[a].partial_cmp(&times[b]).unwrap_or(Ordering::Equal));
        let cycle = Angle::whole_turns(strokes.turns() as i32);
        let intervals = order
            .iter()
            .enumerate()
            .map(|(k, &now)| match order.get(k + 1) {
                Some(&next) => times[next] - times[now],
                None => cycle - times[now],
            })
            .collect();
        Self { engine: Arc::clone(engine), strokes, times, order, intervals }
    }

    /// The engine.
    #[must_use]
    pub fn engine(&self) -> &Arc<Engine> {
        &self.engine
    }

    /// Strokes of a cycle.
    #[must_use]
    pub fn strokes(&self) -> Strokes {
        self.strokes
    }

    /// Cylinders by index, from the first on; those that fire together by number.
    #[must_use]
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// Crank angles from each firing of the order to the next, and from the last to the first.
    #[must_use]
    pub fn intervals(&self) -> &[Angle] {
        &self.intervals
    }

    /// Which cylinders fire in the second turn after the first cylinder's firing.
    #[must_use]
    pub fn later(&self) -> Vec<bool> {
        self.times.iter().map(|&time| time >= Angle::TURN).collect()
    }

    /// Crank angles at which the cylinders fire, by number, within a cycle.
    #[must_use]
    pub fn angles(&self) -> Vec<Angle> {
        let first = &self.engine.placements()[0];
        let top = first.tdc + degrees(highest_after_tdc(first));
        self.times.iter().map(|&time| self.within(top.reduced() + time)).collect()
    }

    /// Whether all intervals are equal.
    #[must_use]
    pub fn even(&self) -> bool {
        self.intervals.iter().all(|&interval| same(interval, self.mean()))
    }

    /// How far intervals are from equal, degrees: root mean square; 0 for even firing.
    #[must_use]
    pub fn unevenness(&self) -> f64 {
        if self.even() {
            return 0.0;
        }
        let mut squares: Vec<f64> =
            self.intervals.iter().map(|&each| (each - self.mean()).degrees().powi(2)).collect();
        // The same intervals in another order add up to the same.
        squares.sort_by(f64::total_cmp);
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    }

    /// The groups of cylinders whose bores have one direction, by index.
    #[must_use]
    pub fn banks(&self) -> Vec<Vec<usize>> {
        let mut banks: Vec<(Angle, Vec<usize>)> = Vec::new();
        for (i, placement) in self.engine.placements().iter().enumerate() {
            match banks.iter_mut().find(|(bank, _)| *bank == placement.bank) {
                Some((_, members)) => members.push(i),
                None => banks.push((placement.bank, vec![i])),
            }
        }
        banks.into_iter().map(|(_, members)| members).collect()
    }

    /// The groups given by cylinder number, or the banks, by index.
    pub fn groups(&self, given: Option<&[Vec<usize>]>) -> Result<Vec<Vec<usize>>> {
        let Some(given) = given else {
            return Ok(self.banks());
        };
        let mut seen = vec![false; self.times.len()];
        for (k, group) in given.iter().enumerate() {
            if group.is_empty() {
                let cure = "name at least one cylinder in each group";
                return Err(Error::value(format!("groups[{k}]"), "[]", cure));
            }
            for &number in group {
                match number.checked_sub(1).and_then(|i| seen.get_mut(i)) {
                    Some(seen) if !*seen => *seen = true,
                    _ => {
                        let cure =
                            format!("name cylinders from 1 to {}, each once", self.times.len());
                        return Err(Error::value(format!("groups[{k}]"), number, cure));
                    }
                }
            }
        }
        Ok(given.iter().map(|group| group.iter().map(|number| number - 1).collect()).collect())
    }

    /// Crank angles between firings within groups of cylinders, each in firing order.
    #[must_use]
    pub fn gaps(&self, groups: &[Vec<usize>]) -> Vec<Vec<Gap>> {
        let of_group = |group: &Vec<usize>| {
            let members = self.in_order(group);
            (0..members.len())
                .map(|k| {
                    let (before, after) = (members[k], members[(k + 1) % members.len()]);
                    let gap = self.times[after] - self.times[before];
                    // Round the end of the cycle; cylinders that fire together stay 0 apart.
                    let gap = if k + 1 == members.len() { gap + self.cycle() } else { gap };
                    Gap { before, after, gap }
                })
                .collect()
        };
        groups.iter().map(of_group).collect()
    }

    /// From beginning to end of each stroke, in order from the firing on.
    #[must_use]
    pub fn stroke_periods(&self) -> Vec<(&'static str, Periods)> {
        let names: &[_] = match self.strokes {
            Strokes::Four => &["power", "exhaust", "intake", "compression"],
            Strokes::Two => &["power", "compression"],
        };
        let period = |k: usize, (firing, placement): (Angle, &Placement)| {
            let downwards = top_to_bottom(placement);
            let turns = Angle::whole_turns((k / 2) as i32);
            let (from, length) = if k.is_multiple_of(2) {
                (turns, downwards)
            } else {
                (turns + downwards, Angle::TURN - downwards)
            };
            self.period(firing + from, length)
        };
        names
            .iter()
            .enumerate()
            .map(|(k, &name)| {
                let angles = self.angles().into_iter().zip(self.engine.placements());
                (name, angles.map(|each| period(k, each)).collect())
            })
            .collect()
    }

    /// When valves are open; of a four-stroke.
    pub fn valves(&self, timing: &ValveTiming) -> Result<Valves> {
        if self.strokes == Strokes::Two {
            let cure = "valves are those of a four-stroke; a two-stroke breathes through ports: \
                        Firing.ports, PortTiming";
            return Err(Error::value("strokes", 2, cure));
        }
        let mut valves = Valves { intake: Vec::new(), exhaust: Vec::new() };
        for (firing, placement) in self.angles().into_iter().zip(self.engine.placements()) {
            let (turn, downwards) = (Angle::TURN, top_to_bottom(placement));
            let [opens, closes] = timing.intake;
            valves.intake.push(self.period(firing + (turn - opens), opens + downwards + closes));
            let [opens, closes] = timing.exhaust;
            let open = opens + (turn - downwards) + closes;
            valves.exhaust.push(self.period(firing + downwards - opens, open));
        }
        Ok(valves)
    }

    /// When ports are open; of a two-stroke.
    pub fn ports(&self, timing: &PortTiming) -> Result<Ports> {
        if self.strokes == Strokes::Four {
            let cure = "ports are those of a two-stroke; a four-stroke breathes through valves: \
                        Firing.valves, ValveTiming";
            return Err(Error::value("strokes", 4, cure));
        }
        let open = |half: Angle| -> Periods {
            let tops = self.angles().into_iter().zip(self.engine.placements());
            tops.map(|(firing, placement)| {
                self.period(firing + top_to_bottom(placement) - half, half + half)
            })
            .collect()
        };
        Ok(Ports { transfer: open(timing.transfer), exhaust: open(timing.exhaust) })
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
                    let gap = if same(gap, self.cycle()) { Angle::ZERO } else { gap };
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

    fn cycle(&self) -> Angle {
        Angle::whole_turns(self.strokes.turns() as i32)
    }

    /// The interval of even firing.
    fn mean(&self) -> Angle {
        Angle::from_degree_fraction(360 * self.strokes.turns(), self.times.len() as i64)
            .unwrap_or(Angle::ZERO)
    }

    fn within(&self, angle: Angle) -> Angle {
        angle.reduced_to(self.strokes.turns())
    }

    fn period(&self, start: Angle, length: Angle) -> Period {
        let start = self.within(start);
        [start, start + length]
    }

    fn in_order(&self, group: &[usize]) -> Vec<usize> {
        self.order.iter().copied().filter(|cylinder| group.contains(cylinder)).collect()
    }
}

impl std::fmt::Display for Firing {
    /// The order as [`NamedOrder`] reads it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (k, cylinder) in self.order.iter().enumerate() {
            let joint = match k {
                0 => "",
                _ if self.intervals[k - 1] == Angle::ZERO => "+",
                _ => "-",
            };
            write!(f, "{joint}{}", cylinder + 1)?;
        }
        Ok(())
    }
}

/// Crank angles at which pistons are highest, after the first one's, within a turn.
struct Tops(Vec<Angle>);

impl Tops {
    fn of(engine: &Engine) -> Self {
        let placements = engine.placements();
        let (first, past_first) = (placements[0].tdc, highest_after_tdc(&placements[0]));
        let mut tops: Vec<Angle> = placements
            .iter()
            .map(|placement| {
                let past = highest_after_tdc(placement) - past_first;
                let top = placement.tdc - first;
                // Engines with offset pins are laid out so that this is a part of a turn.
                let top = if past == 0.0 {
                    top
                } else {
                    (top + degrees(past)).nearby_part(MOST_ROUNDING)
                };
                let top = top.reduced();
                if same(top, Angle::TURN) { Angle::ZERO } else { top }
            })
            .collect();
        // What only rounding parts is one angle.
        let mut order: Vec<usize> = (0..tops.len()).collect();
        order.sort_by(|&a, &b| tops[a].degrees().total_cmp(&tops[b].degrees()));
        for pair in order.windows(2) {
            if same(tops[pair[0]], tops[pair[1]]) {
                tops[pair[1]] = tops[pair[0]];
            }
        }
        Self(tops)
    }
}

/// Degrees after top dead centre at which crank and rod are in line.
fn highest_after_tdc(placement: &Placement) -> f64 {
    let part = placement.cylinder;
    (part.pin_offset() / (part.rod_length() + part.crank_radius())).asin().to_degrees()
}

/// From a piston's highest to its lowest point: half a turn but for a pin offset.
fn top_to_bottom(placement: &Placement) -> Angle {
    let part = placement.cylinder;
    let lowest = (part.pin_offset() / (part.rod_length() - part.crank_radius())).asin();
    Angle::HALF_TURN + degrees(lowest.to_degrees() - highest_after_tdc(placement))
}

/// Of an arc sine, hence in range.
fn degrees(degrees: f64) -> Angle {
    Angle::from_degrees(degrees).unwrap_or(Angle::ZERO)
}

/// Fractions of a turn are the same when they are equal.
fn same(a: Angle, b: Angle) -> bool {
    a == b
        || ((a.turns().is_none() || b.turns().is_none())
            && (a.degrees() - b.degrees()).abs() <= MOST_ROUNDING)
}

fn most_even_first(firings: &mut [Firing]) {
    firings.sort_by_cached_key(|firing| {
        // To a millionth of a degree, so that rounding does not order what is equally even.
        ((firing.unevenness() * 1e6).round() as u64, firing.order.clone(), firing.later())
    });
}

/// The pins that a vee needs to fire in this order.
#[derive(Debug, Clone, PartialEq)]
pub struct Throws {
    /// Crankpins of the right bank in the direction of rotation, from the front one.
    pub throws: Vec<Angle>,
    /// Left pin minus right pin of each throw, above −180° and up to 180°.
    pub pin_splits: Vec<Angle>,
}

/// The crankpins of an inline engine that fires so, from the front one.
pub fn inline_throws(order: &FiringOrder, rule: &FiringRule) -> Result<Vec<Angle>> {
    let throws = order.throws(rule)?;
    Ok(throws.iter().map(|&throw| (throw - throws[0]).reduced()).collect())
}

/// The crankpins of a vee that fires so; `layout.throws` and `layout.pin_split` are not asked.
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
    use super::*;
    use crate::layout::Numbering;
    use crate::slider_crank::Cylinder;

    fn vee(bank_angle: f64, pin_split: f64, throws: &[f64], first_bank: Side) -> Vee {
        let angle = |degrees| Angle::from_degrees(degrees).unwrap();
        Vee {
            bank_angle: angle(bank_angle),
            throws: throws.iter().map(|&throw| angle(throw)).collect(),
            spacing: 0.1,
            pin_split: angle(pin_split),
            bank_stagger: 0.0,
            rotating_mass: Vec::new(),
            numbering: Numbering::Alternating,
            first_bank,
            first_tdc: Angle::ZERO,
        }
    }

    fn engine(layout: &Vee) -> Arc<Engine> {
        let cylinder = Cylinder::new(0.045, 0.158, 1.487, 0.0).unwrap();
        Arc::new(layout.engine(cylinder).unwrap())
    }

    fn intervals(firing: &Firing) -> Vec<f64> {
        firing.intervals().iter().map(|interval| interval.degrees()).collect()
    }

    #[test]
    fn the_cross_plane_v8_fires_evenly() {
        let v8 = engine(&vee(90.0, 0.0, &[0.0, 90.0, 270.0, 180.0], Side::Left));
        let order: NamedOrder = "1-8-4-3-6-5-7-2".parse().unwrap();
        let firing = Firing::named(&v8, &order, Strokes::Four).unwrap();
        assert!(firing.even());
        assert_eq!(intervals(&firing), [90.0; 8]);
        assert_eq!(Firing::all_named(&v8, &order, Strokes::Four).unwrap().len(), 1);
        let gaps = firing.gaps(&firing.banks());
        let left: Vec<f64> = gaps[0].iter().map(|gap| gap.gap.degrees()).collect();
        assert_eq!(left, [270.0, 180.0, 90.0, 180.0]); // 1-3-5-7
    }

    #[test]
    fn an_order_within_one_turn_leaves_the_start_of_the_next_open() {
        let v6 = engine(&vee(60.0, 0.0, &[0.0, 120.0, 240.0], Side::Right));
        let order: NamedOrder = "1-2-5-6-3-4".parse().unwrap();
        let ways = Firing::all_named(&v6, &order, Strokes::Four).unwrap();
        assert_eq!(ways.len(), 6);
        for way in &ways {
            let mut sorted = intervals(way);
            sorted.sort_by(f64::total_cmp);
            assert_eq!(sorted, [60.0, 60.0, 60.0, 60.0, 60.0, 420.0]);
        }
        let two_stroke = Firing::named(&v6, &order, Strokes::Two).unwrap();
        assert_eq!(intervals(&two_stroke), [60.0; 6]);
    }

    #[test]
    fn cylinders_that_fire_together_are_told_and_read_back() {
        let boxer = engine(&vee(180.0, 180.0, &[0.0, 180.0], Side::Right));
        let ways = Firing::all(&boxer, Strokes::Four).unwrap();
        assert_eq!(ways.len(), 8);
        for way in &ways {
            let order: NamedOrder = way.to_string().parse().unwrap();
            assert_eq!(order.to_string(), way.to_string());
            assert!(Firing::all_named(&boxer, &order, Strokes::Four).unwrap().contains(way));
        }
        let together: NamedOrder = "3+4-1+2".parse().unwrap();
        let two_stroke = Firing::named(&boxer, &together, Strokes::Two).unwrap();
        assert_eq!(two_stroke.to_string(), "1+2-3+4");
        assert_eq!(intervals(&two_stroke), [0.0, 180.0, 0.0, 180.0]);
        assert!(Firing::named(&boxer, &"1-2-3-4".parse().unwrap(), Strokes::Two).is_err());
    }

    #[test]
    fn orders_that_are_none_are_refused() {
        for bad in ["", "+", "1+", "1-1", "1+1", "1-+2", "2-3", "1-x"] {
            assert!(bad.parse::<NamedOrder>().is_err(), "{bad}");
        }
    }

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

    fn figures(angles: &[Angle]) -> Vec<f64> {
        angles.iter().map(|angle| angle.degrees()).collect()
    }

    /// Cylinder, TDC, bore of each; z does not matter.
    fn placed(places: &[(Cylinder, f64, f64)]) -> Arc<Engine> {
        let angle = |degrees| Angle::from_degrees(degrees).unwrap();
        let place = |&(cylinder, tdc, bank): &(Cylinder, f64, f64)| Placement {
            cylinder,
            tdc: angle(tdc),
            bank: angle(bank),
            z: 0.0,
            rotating_mass: 0.0,
        };
        Arc::new(Engine::new("", "", places.iter().map(place).collect()).unwrap())
    }

    fn cylinder(pin_offset: f64) -> Cylinder {
        Cylinder::new(0.05, 0.15, 0.5, pin_offset).unwrap()
    }

    /// A firing's own figures from its definition: each cylinder at its top in its own turn.
    #[test]
    fn every_way_to_fire_is_listed_once_and_tells_itself() {
        let tdcs = [40.0, 130.0, 305.5, 40.0];
        let engine = placed(&tdcs.map(|tdc| (cylinder(0.0), tdc, 90.0)));
        let ways = Firing::all(&engine, Strokes::Four).unwrap();
        assert_eq!(ways.len(), 8);
        let mut choices: Vec<Vec<bool>> = ways.iter().map(Firing::later).collect();
        for way in &ways {
            let later = way.later();
            assert!(!later[0]);
            assert_eq!(&Firing::with_later(&engine, Strokes::Four, &later).unwrap(), way);
            // Times after the first firing, and the angles 40° on.
            let after = |i: usize| {
                let top: f64 = (tdcs[i] - tdcs[0] + 360.0) % 360.0;
                top + if later[i] { 360.0 } else { 0.0 }
            };
            let angles: Vec<f64> = (0..4).map(|i| (after(i) + 40.0) % 720.0).collect();
            assert_eq!(figures(&way.angles()), angles);
            let mut times: Vec<f64> = way.order().iter().map(|&i| after(i)).collect();
            assert!(times.is_sorted() && way.order()[0] == 0);
            times.push(720.0);
            let gaps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert_eq!(intervals(way), gaps);
            let square: f64 = gaps.iter().map(|gap| (gap - 180.0).powi(2)).sum();
            assert!((way.unevenness() - (square / 4.0).sqrt()).abs() < 1e-12);
            assert!(!way.even());
        }
        assert!(ways.is_sorted_by(|a, b| a.unevenness() <= b.unevenness() + 1e-6));
        choices.sort();
        choices.dedup();
        assert_eq!(choices.len(), 8);
        let [none, some] = [[false; 4], [false, true, false, false]];
        assert!(Firing::with_later(&engine, Strokes::Two, &some).is_err());
        assert!(Firing::with_later(&engine, Strokes::Two, &none).is_ok());
        assert!(Firing::with_later(&engine, Strokes::Four, &[true, false, false, false]).is_err());
        assert!(Firing::with_later(&engine, Strokes::Four, &[false; 3]).is_err());
        assert_eq!(Firing::all(&engine, Strokes::Two).unwrap().len(), 1);
        let many = placed(&vec![(cylinder(0.0), 0.0, 90.0); MOST_LISTED + 1]);
        assert!(Firing::all(&many, Strokes::Four).is_err());
        assert!(Firing::all(&many, Strokes::Two).is_ok());
    }

    #[test]
    fn the_most_even_way_comes_first_however_near_the_others() {
        // Half of the ways come within a degree of another.
        let tdcs = [0.0, 90.3, 180.4, 270.9];
        let engine = placed(&tdcs.map(|tdc| (cylinder(0.0), tdc, 90.0)));
        let ways = Firing::all(&engine, Strokes::Four).unwrap();
        let unevenness: Vec<f64> = ways.iter().map(Firing::unevenness).collect();
        assert!(
            unevenness.windows(2).any(|pair| 1e-3 < pair[1] - pair[0] && pair[1] - pair[0] < 0.5)
        );
        assert!(unevenness.is_sorted_by(|a, b| *a <= b + 1e-6), "{unevenness:?}");
    }

    #[test]
    fn what_cannot_be_named_is_told_what_can() {
        let engine = placed(&[0.0, 180.0, 180.0, 0.0].map(|tdc| (cylinder(0.0), tdc, 90.0)));
        let told = |strokes| {
            let order = "1-2-3-4".parse().unwrap();
            Firing::named(&engine, &order, strokes).unwrap_err().to_string()
        };
        assert!(told(Strokes::Two).contains("1+4-2+3"), "{}", told(Strokes::Two));
        let four = told(Strokes::Four);
        assert!(four.contains("most evenly 1-2-4-3 or 1-3-4-2 or "), "{four}");
        let listed = four.split("most evenly ").nth(1).unwrap();
        assert_eq!(listed.matches(" or ").count(), EXAMPLES - 1, "{listed}");
    }

    #[test]
    fn groups_are_by_number_and_apart() {
        let v8 = engine(&vee(90.0, 0.0, &[0.0, 90.0, 270.0, 180.0], Side::Left));
        let order: NamedOrder = "1-8-4-3-6-5-7-2".parse().unwrap();
        let firing = Firing::named(&v8, &order, Strokes::Four).unwrap();
        assert_eq!(firing.groups(None).unwrap(), firing.banks());
        assert_eq!(firing.banks(), [[0, 2, 4, 6], [1, 3, 5, 7]]);
        let given = [vec![1, 8], vec![4]];
        assert_eq!(firing.groups(Some(&given)).unwrap(), [vec![0, 7], vec![3]]);
        for bad in [vec![vec![]], vec![vec![0]], vec![vec![9]], vec![vec![1], vec![1]]] {
            assert!(firing.groups(Some(&bad)).is_err(), "{bad:?}");
        }
        let gaps = firing.gaps(&[vec![0, 7], vec![3]]);
        let gap = |k: usize| -> Vec<_> {
            gaps[k].iter().map(|g| (g.before, g.after, g.gap.degrees())).collect()
        };
        assert_eq!(gap(0), [(0, 7, 90.0), (7, 0, 630.0)]);
        assert_eq!(gap(1), [(3, 3, 720.0)]);
    }

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
            let timing =
                ValveTiming { intake: [10.0, 40.0].map(angle), exhaust: [50.0, 15.0].map(angle) };
            let valves = four.valves(&timing).unwrap();
            near(valves.intake[0], top + 350.0, 50.0 + down);
            near(valves.exhaust[0], top + down - 50.0, 65.0 + 360.0 - down);
            let ports = PortTiming { transfer: angle(60.0), exhaust: angle(80.0) };
            assert!(four.ports(&ports).is_err());
            let two = Firing::with_later(&engine, Strokes::Two, &[false; 2]).unwrap();
            assert!(two.valves(&timing).is_err());
            let strokes = two.stroke_periods();
            assert_eq!((strokes.len(), strokes[1].0), (2, "compression"));
            near(strokes[1].1[1], 20.0, 180.0);
            let open = two.ports(&ports).unwrap();
            near(open.transfer[0], top + down - 60.0, 120.0);
            near(open.exhaust[0], top + down - 80.0, 160.0);
        }
    }

    #[test]
    fn overlaps_are_where_two_are_open_together() {
        let engine = placed(&[0.0, 120.0, 240.0, 0.0].map(|tdc| (cylinder(0.0), tdc, 90.0)));
        let firing = Firing::with_later(&engine, Strokes::Two, &[false; 4]).unwrap();
        let whole = Angle::from_degrees(1.0).unwrap();
        let open = |lengths: [f64; 4]| -> Periods {
            let periods = firing.angles().into_iter().zip(lengths);
            periods.map(|(from, by)| [from, from + Angle::from_degrees(by).unwrap()]).collect()
        };
        let found = |lengths: [f64; 4], group: &[usize]| -> Vec<(usize, usize, f64, f64)> {
            let all = firing.overlaps(&[group.to_vec()], &open(lengths));
            let of = |o: &Overlap| (o.before, o.after, o.gap.degrees(), o.overlap.degrees());
            all[0].iter().map(of).collect()
        };
        assert_eq!(whole.turns(), Some((1, 360)));
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
        let just = MOST_ROUNDING.next_up();
        assert_eq!(found([just; 4], &[0, 3]), [(0, 3, 0.0, just)]);
    }

    #[test]
    fn what_only_rounding_parts_fires_together() {
        let apart = |by: f64| {
            let tdcs = [0.0, 17.123_456, 17.123_456 + by];
            let engine = placed(&tdcs.map(|tdc| (cylinder(0.0), tdc, 90.0)));
            Firing::all(&engine, Strokes::Two).unwrap()[0].to_string()
        };
        assert_eq!(apart(0.0), "1-2+3");
        assert_eq!(apart(0.1 * MOST_ROUNDING), "1-2+3");
        assert_eq!(apart(10.0 * MOST_ROUNDING), "1-2-3");
        // An offset of one and not of the other: tops asin(e/(l + r)) apart from their pins'.
        let past = (0.02_f64 / 0.2).asin().to_degrees();
        let engine = placed(&[(cylinder(0.02), 0.0, 90.0), (cylinder(0.0), past + 120.0, 90.0)]);
        let firing = Firing::all(&engine, Strokes::Two).unwrap().remove(0);
        assert_eq!(intervals(&firing), [120.0, 240.0]);
        assert_eq!(firing.intervals()[0].turns(), Some((1, 3)));
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
