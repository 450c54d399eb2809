//! The words of an explanation: a sentence for each kind of finding.

use super::Explanation;
use super::finding::{Acting, Finding, LargestOrder, Reason, Weights};
use super::words::{ACROSS, listed, number, orders, sense};
use crate::engine::Engine;
use crate::engine::loads::dead_text;
use crate::engine::loads::in_one_line;
use crate::numbers::figure::{rounded, significant};
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::readings::balance::Vector;

/// Most pairs of cylinders that a sentence lists.
const LISTED: usize = 4;
/// Forward and backward parts that differ by less make a straight line; one that is less of both is no
/// part, and the vector's tip draws a circle.
const EQUAL_PARTS: f64 = 1e-9;
/// Levers from here on, m, are given in metres: in millimetres they have more than three digits.
const SHORTEST_IN_METRES: f64 = 0.9995;
/// Peaks that differ by less are as large in three digits, or nearly.
const SAME: f64 = 0.005;
/// Bounds and means below this part of what they are relative to are not mentioned.
const NEGLIGIBLE: f64 = 1e-6;

/// What sentences are written with.
pub struct Wording<'a> {
    /// Which gas pressure counts.
    pub loads: String,
    /// Unit that is shown in place of another, and the factor of numbers; none for the same.
    pub convert: &'a dyn Fn(&str) -> Option<(String, f64)>,
}

impl Wording<'_> {
    /// Of an engine, in SI units.
    #[must_use]
    pub fn of(engine: &Engine) -> Self {
        Self { loads: engine.loads_counted(), convert: &|_| None }
    }

    /// A value with three digits, or rounded up to two, and its unit with a prefix.
    fn figure(&self, value: f64, unit: &str, up: bool) -> String {
        let value = if up { rounded_up(value) } else { value };
        if let Some((shown, factor)) = (self.convert)(unit) {
            let rounded = significant(value * factor, 3).parse().unwrap_or(value);
            return format!("{} {shown}", significant(rounded, 10));
        }
        let (mut prefix, mut scale) = ("", 1.0);
        for (name, factor) in [("k", 1e3), ("M", 1e6)] {
            if value >= 0.9995 * factor && ["N", "N·m"].contains(&unit) {
                (prefix, scale) = (name, factor);
            }
        }
        format!("{} {prefix}{unit}", significant(value / scale, 3))
    }
}

/// A value above zero rounded up to two digits.
fn rounded_up(value: f64) -> f64 {
    let exponent = format!("{value:e}").split_once('e').and_then(|(_, n)| n.parse::<i32>().ok());
    let step: f64 = format!("1e{}", exponent.unwrap_or_default() - 1).parse().unwrap_or(1.0);
    (value / step * (1.0 - 1e-12)).ceil() * step
}

fn words(vector: Vector) -> &'static str {
    match vector {
        Vector::Force => "shaking force",
        Vector::Moment => "rocking moment",
    }
}

fn zero(proved: bool) -> &'static str {
    if proved { "exactly zero" } else { "zero to within rounding" }
}

/// `s` if there are several.
fn plural(several: bool) -> &'static str {
    if several { "s" } else { "" }
}

impl Explanation {
    /// The sentences of some of the findings, one for each; the force that figures are relative to has a
    /// letter where it comes again.
    #[must_use]
    pub fn sentences<'a>(
        &self,
        findings: impl IntoIterator<Item = &'a Finding>,
        wording: &Wording,
    ) -> Vec<String> {
        let sentence = |finding| {
            let text = self.clause(finding, wording);
            let mut rest = text.chars();
            let first = rest.next().into_iter().flat_map(char::to_uppercase);
            format!("{}{}.", first.collect::<String>(), rest.as_str())
        };
        let mut sentences: Vec<String> = findings.into_iter().map(sentence).collect();
        let phrase = self.unit_force();
        let times = sentences.iter().map(|text| text.matches(&phrase).count()).sum::<usize>();
        if times > 1 {
            let mut texts = sentences.iter_mut().skip_while(|text| !text.contains(&phrase));
            if let Some(text) = texts.next()
                && let Some((before, after)) = text.split_once(&phrase)
            {
                *text = format!("{before}{phrase} F{}", after.replace(&phrase, "F"));
            }
            texts.for_each(|text| *text = text.replace(&phrase, "F"));
        }
        sentences
    }

    fn clause(&self, finding: &Finding, wording: &Wording) -> String {
        match finding {
            Finding::Hardware { vector, order, before, after, acting, proved } => {
                let what = format!("{} of {}", words(*vector), orders(&[*order]));
                let size =
                    |parts: &[f64; 2]| self.size(parts[0] + parts[1], *vector, false, wording);
                let sizes = [size(before), size(after)];
                self.hardware(&what, [before, after], sizes, *acting, *proved)
            }
            Finding::Shakes { vector, order, parts, tilt_deg, together } => {
                let peak = self.size(parts[0] + parts[1], *vector, false, wording);
                let how = shape(*parts, *tilt_deg, *vector);
                let [what, order] = [words(*vector).to_owned(), orders(&[*order])];
                let left = format!("{order} leaves a {what} of {peak}, {how}");
                match self.count() {
                    _ if !together => left,
                    2 => format!("{left}: both pistons pull together"),
                    count => format!("{left}: all {} pistons pull together", number(count)),
                }
            }
            Finding::Remedy { vector, order, kept, shafts, weights } => {
                let what = format!("the {} of {}", words(*vector), orders(&[*order]));
                let least = format!("down to {}", self.size(*kept, *vector, false, wording));
                let is_all = *kept <= EQUAL_PARTS * self.unit;
                self.remedy(&what, *order, shafts, *weights, &least, is_all)
            }
            Finding::BobWeights { one_sense } => {
                let rotates = self.engine.stations().iter().enumerate().any(|(i, place)| {
                    place.rotating_mass != 0.0 || self.engine.knuckle_mass(i).is_some()
                });
                let rotating = if rotates { "all rotating and " } else { "" };
                let replaced = !self.engine.counterweights().is_empty();
                let instead = if replaced { " in place of the counterweights" } else { "" };
                let crank = if *one_sense { "the crank" } else { "the crank of each piston" };
                format!(
                    "bob weights of {rotating}half the reciprocating mass{instead} remove what turns \
                     with {crank} at order 1, of force and moment"
                )
            }
            Finding::Roll { peak, kept } => {
                let size = |torque: f64| self.size(torque, Vector::Moment, false, wording);
                let left = if *kept <= EQUAL_PARTS * *peak {
                    "could remove it".to_owned()
                } else if *kept < (1.0 - SAME) * *peak {
                    format!("could bring it down to {}", size(*kept))
                } else {
                    "do not lessen it".to_owned()
                };
                format!(
                    "order 1 leaves a roll torque of {} about the axis of the main crank, as cranks on \
                     other axes push and pull beside it: counterweights on the cranks {left}",
                    size(*peak)
                )
            }
            Finding::Cancels { vector, orders: list, reason, pairs, proved } => {
                let several = list.len() > 1;
                let (what, zero) = (words(*vector), zero(*proved));
                let (s, verb) = (plural(several), if several { "are" } else { "is" });
                let why = self.why(*vector, *reason, pairs);
                format!("the {what}{s} of {} {verb} {zero}: {why}", orders(list))
            }
            Finding::Rest { mentioned, bounds } => {
                let other = if mentioned.is_empty() { "" } else { "other " };
                self.rest(other, *bounds, wording)
            }
            Finding::InertiaTorque { order, peak } => {
                let peak = self.rpm.map(|_| format!(": {}", wording.figure(*peak, "N·m", false)));
                let counted = match self.engine.cycles_in_use() {
                    0 => format!(", {}", wording.loads),
                    _ => String::new(),
                };
                format!(
                    "the roll torque of the moving parts is largest at {}{}{counted}",
                    orders(&[*order]),
                    peak.unwrap_or_default()
                )
            }
            Finding::GasTorque { mean, largest } => gas_torque(*mean, largest, wording),
            Finding::Fires { order, intervals_deg, even } => {
                self.fires(order, intervals_deg, *even)
            }
            Finding::GasOrders { orders, firing, even } => self.gas_orders(orders, firing, *even),
            Finding::GivenLoad { name, largest } => given_load(name, largest.as_ref(), wording),
            Finding::Articulated { rows } => format!(
                "{} rods share a crankpin: each rod is computed on the crankpin itself; link rods on a \
                 master rod, which this engine does not have, move their pistons differently",
                number(rows[0].len())
            ),
        }
    }

    /// Number of cylinders.
    fn count(&self) -> usize {
        self.engine.stations().len()
    }

    // --- figures ---

    /// A force or moment: with a speed in N or N·m, else relative to one piston's force.
    fn size(&self, value: f64, vector: Vector, up: bool, wording: &Wording) -> String {
        let [unit, over_square] = match vector {
            Vector::Force => ["N", "kg·m"],
            Vector::Moment => ["N·m", "kg·m²"],
        };
        if self.rpm.is_some() {
            return wording.figure(value, unit, up);
        }
        if self.unit == 0.0 {
            return format!("{} times ω²", wording.figure(value, over_square, up));
        }
        let (force, share) = (self.unit_force(), value / self.unit);
        if vector == Vector::Moment {
            let (length, unit) =
                if share >= SHORTEST_IN_METRES { (share, "m") } else { (1e3 * share, "mm") };
            return format!("{force} at a lever of {}", wording.figure(length, unit, up));
        }
        if (share - 1.0).abs() <= SAME {
            return force;
        }
        let (times, of) = if share < 1.0 { (100.0 * share, "% of") } else { (share, "times") };
        format!("{} {force}", wording.figure(times, of, up))
    }

    /// What forces are relative to where no speed is given.
    fn unit_force(&self) -> String {
        format!("one {}'s first-order force", self.part.name())
    }

    // --- sentences ---

    fn hardware(
        &self,
        what: &str,
        [before, after]: [&[f64; 2]; 2],
        [was, left]: [String; 2],
        acting: Acting,
        proved: bool,
    ) -> String {
        let weights = match self.engine.counterweights().len() {
            1 => "the counterweight",
            _ => "counterweights",
        };
        let shafts = match self.engine.shafts().len() {
            1 => "the balance shaft",
            _ => "balance shafts",
        };
        let subject = match acting {
            Acting::Counterweights => weights.to_owned(),
            Acting::Shafts => shafts.to_owned(),
            Acting::Both => format!("{weights} and {shafts}"),
        };
        let s = plural(acting != Acting::Both && subject.starts_with("the "));
        let [sum, now] = [before, after].map(|parts| parts[0] + parts[1]);
        if sum == 0.0 {
            return format!("{subject} bring{s} a {what}: {left}");
        }
        if now == 0.0 {
            return format!("{subject} remove{s} the whole {what}, {was}: it is {}", zero(proved));
        }
        if (now - sum).abs() <= SAME * sum {
            return format!("{subject} leave{s} the {what} at {left} and turn{s} its direction");
        }
        let gone = (0..2).filter(|&part| before[part] != 0.0 && after[part] == 0.0);
        let gone = gone.map(|part| sense(part == 0)).next();
        let rest = match gone {
            None => String::new(),
            // One of them may do nothing in this sense.
            Some(sense) if acting == Acting::Both => {
                format!(", none of which turns {sense} the crank")
            }
            Some(sense) => {
                let all_of = format!("all of the {what} that turns {sense} the crank");
                return format!("{subject} remove{s} {all_of}: it changes from {was} to {left}");
            }
        };
        let verb = if now < sum { "reduce" } else { "raise" };
        format!("{subject} {verb}{s} the {what} from {was} to {left}{rest}")
    }

    fn remedy(
        &self,
        what: &str,
        order: Order,
        shafts: &[SpeedRatio],
        weights: Weights,
        least: &str,
        is_all: bool,
    ) -> String {
        let fitted = !self.engine.counterweights().is_empty();
        let mut other = if fitted { "other counterweights" } else { "counterweights" }.to_owned();
        if weights == Weights::OnCranks {
            other.push_str(" on the cranks");
        }
        let speed = match order.halves() {
            1 => "half crank speed".to_owned(),
            2 => "crank speed".to_owned(),
            4 => "twice crank speed".to_owned(),
            _ => format!("{order} times crank speed"),
        };
        let is_fitted = self.engine.shafts().iter().any(|shaft| shafts.contains(&shaft.ratio));
        let [one, two] = if is_fitted { ["another", "two more"] } else { ["a", "two"] };
        let senses: Vec<&str> = shafts.iter().map(|ratio| sense(ratio.is_forward())).collect();
        let shaft = match &senses[..] {
            [] if is_all => return format!("{other} could remove all of {what}"),
            [] => {
                return format!(
                    "{other} could bring {what} {least}, too little for a balance shaft"
                );
            }
            [sense, ..] if weights != Weights::No => {
                return format!(
                    "{other} could bring {what} {least}; the rest turns {sense} the crank, and takes \
                     {one} balance shaft that does so at {speed}"
                );
            }
            [sense] => format!("{one} balance shaft at {speed}, {sense} the crank"),
            [first, second, ..] => format!(
                "{two} balance shafts at {speed}, one {first} the crank and one {second} it"
            ),
        };
        if order == Order::FIRST {
            format!("no counterweight reaches {what}: it takes {shaft}")
        } else if is_all {
            format!("{shaft}, would remove {what}")
        } else {
            format!("{shaft}, would bring {what} {least}")
        }
    }

    fn why(&self, vector: Vector, reason: Reason, pairs: &[[usize; 2]]) -> String {
        let (count, banks) = (self.count(), self.engine.bank_directions().len());
        let pair = |[one, other]: &[usize; 2]| format!("{} and {}", one + 1, other + 1);
        let named = if (2..=LISTED).contains(&pairs.len()) {
            format!(" ({})", pairs.iter().map(pair).collect::<Vec<_>>().join(", "))
        } else {
            String::new()
        };
        let opposite = if vector == Vector::Force { "pistons" } else { "cylinders" };
        let pistons = if banks > 1 { "the pistons of each bank" } else { "the pistons" };
        match reason {
            Reason::Plane if count == 1 => "the cylinder is in the reference plane".to_owned(),
            Reason::Plane => "all cylinders are in the reference plane".to_owned(),
            Reason::Pairs if count == 2 && pairs.len() == 1 => {
                format!("the {opposite} are opposite")
            }
            Reason::Pairs => format!("opposite {opposite} cancel in pairs{named}"),
            Reason::Mirrored => format!("front and rear mirror each other{named}"),
            Reason::Evenly => format!("{pistons} pull at even intervals"),
            Reason::Each => format!("{pistons} cancel one another"),
            Reason::Between if banks < count => "the banks cancel one another".to_owned(),
            Reason::Between => "the cylinders cancel one another".to_owned(),
        }
    }

    fn rest(&self, other: &str, bounds: [f64; 2], wording: &Wording) -> String {
        let scales = [self.unit, self.unit * self.lever];
        let vectors =
            [Vector::Force, Vector::Moment].into_iter().zip(bounds.into_iter().zip(scales));
        let left = vectors.filter(|(_, (bound, scale))| *bound > NEGLIGIBLE * scale);
        let left = left.map(|(vector, (bound, _))| {
            format!("a {} of {}", words(vector), self.size(bound, vector, true, wording))
        });
        match &left.collect::<Vec<_>>()[..] {
            [] => {
                let force = self.unit_force();
                format!("no {other}order of force or moment is as large as a millionth of {force}")
            }
            left => format!("all {other}orders together make at most {}", listed(left)),
        }
    }

    fn fires(&self, fired: &[usize], intervals_deg: &[f64], even: Option<usize>) -> String {
        let order = self.engine.firing_order();
        let intervals: Vec<String> = intervals_deg.iter().map(|&x| significant(x, 6)).collect();
        let count = 0..self.count();
        let is_dummy = |cylinder: usize| self.engine.details()[cylinder].dummy;
        // A dummy piston is not in the order, a dead cylinder is.
        let dead = dead_text(count.clone().map(|k| is_dummy(k) || self.engine.fires(k)));
        let of_which = if dead.is_empty() { dead } else { format!(", of which {dead}") };
        let dummies: Vec<String> =
            count.filter(|&k| is_dummy(k)).map(|k| (k + 1).to_string()).collect();
        let dummies = match &dummies[..] {
            [] => String::new(),
            [one] => format!("; cylinder {one} is a dummy piston"),
            _ => format!("; cylinders {} are dummy pistons", listed(&dummies)),
        };
        if let ([one], [interval]) = (fired, &intervals[..]) {
            return match self.count() {
                1 => format!("the cylinder fires every {interval}°"),
                _ => format!("only cylinder {} fires, every {interval}°{dummies}", one + 1),
            };
        }
        if let (Some(size), Some(gap)) = (even, intervals.iter().find(|gap| *gap != "0")) {
            let how = match size {
                1 => "it fires evenly".to_owned(),
                2 if size == fired.len() => "both cylinders fire together".to_owned(),
                _ if size == fired.len() => format!("all {} cylinders fire together", number(size)),
                _ => format!("it fires evenly, {} cylinders at a time", number(size)),
            };
            return format!("{how}, every {gap}°: {order}{of_which}{dummies}");
        }
        let intervals = intervals.join("-");
        format!("it fires unevenly, at intervals of {intervals}°: {order}{of_which}{dummies}")
    }

    fn gas_orders(&self, left: &[Order], firing: &[usize], even: Option<usize>) -> String {
        let firings = firing.len() / even.unwrap_or(1);
        let of_firing = 4 * firings as u32 / self.engine.strokes().number(); // in halves
        if even.is_some() && left.iter().all(|order| order.halves().is_multiple_of(of_firing)) {
            let lower = if firings > 1 { ": all lower orders cancel exactly" } else { "" };
            return format!("gas torque begins at {}{lower}", orders(&left[..1]));
        }
        let figures = |&cylinder: &usize| {
            let gear = &self.engine.stations()[cylinder].cylinder;
            let bore = self.engine.details()[cylinder].bore;
            let linked = self.engine.running_gear(cylinder).knuckle;
            (gear.crank_radius(), gear.rod_length(), gear.pin_offset(), bore, linked)
        };
        let is_first = |cylinder| figures(cylinder) == figures(&firing[0]);
        let unlike = if !firing.iter().all(is_first) {
            " of unlike cylinders"
        } else if self.engine.cycles_in_use() > 1 {
            " of unlike cycles"
        } else {
            ""
        };
        let how = if even.is_some() { "even" } else { "uneven" };
        format!("{how} firing{unlike} leaves gas torque of {}, and of higher ones", orders(left))
    }
}

/// How a vector moves.
fn shape([forward, backward]: [f64; 2], tilt_deg: f64, vector: Vector) -> String {
    let turning = format!("turning {} the crank", sense(forward > backward));
    let least = EQUAL_PARTS * (forward + backward);
    if forward.min(backward) <= least {
        return format!("constant in size, {turning}");
    }
    let ([level, upright], other) = match vector {
        Vector::Force => (ACROSS, "along a line at"),
        Vector::Moment => (["in pitch", "in yaw"], "about an axis at"),
    };
    let tilt = rounded(tilt_deg.abs(), 1);
    let direction = if tilt == 0.0 {
        level.to_owned()
    } else if tilt == 90.0 {
        upright.to_owned()
    } else {
        format!("{other} {}°", significant(tilt_deg, 3))
    };
    if (forward - backward).abs() <= least {
        return direction;
    }
    format!("largest {direction}, {turning}")
}

fn gas_torque(mean: f64, largest: &[(Order, f64)], wording: &Wording) -> String {
    let peak = |&(order, peak): &(Order, f64)| {
        format!("{} at {}", wording.figure(peak, "N·m", false), orders(&[order]))
    };
    let peaks = listed(&largest.iter().map(peak).collect::<Vec<_>>());
    let loads = wording.loads.strip_prefix("gas: ").unwrap_or(&wording.loads);
    let highest = largest.first().map_or(0.0, |(_, peak)| *peak);
    if mean.abs() <= NEGLIGIBLE * highest {
        return format!(
            "gas pressure ({loads}) does no work over a cycle; its torque has peaks of {peaks}"
        );
    }
    let verb = if mean > 0.0 { "turns" } else { "brakes" };
    let average = wording.figure(mean.abs(), "N·m", false);
    format!(
        "gas pressure ({loads}) {verb} the crank with {average} on average, and peaks of {peaks}"
    )
}

/// What a further load adds: its largest orders of force and of torque, where a speed was given.
fn given_load(
    name: &str,
    largest: Option<&[Option<LargestOrder>; 2]>,
    wording: &Wording,
) -> String {
    let name = in_one_line(name);
    let Some(both) = largest else {
        return format!("the load \"{name}\" acts too; give a speed for what it adds");
    };
    let one = |(largest, (what, unit)): (&Option<LargestOrder>, (&str, &str))| {
        let LargestOrder { order, peak, dominates } = (*largest)?;
        let figure = wording.figure(peak, unit, false);
        let most = if dominates { ", the largest part of it" } else { "" };
        Some(format!("a {what} of {figure} at {}{most}", orders(&[order])))
    };
    let adds = both.iter().zip([("force", "N"), ("torque", "N·m")]).filter_map(one);
    let adds = adds.collect::<Vec<_>>().join(" and ");
    let adds = if adds.is_empty() { "nothing that shakes" } else { &adds };
    format!("the load \"{name}\" adds {adds}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_three_digits_and_bounds_are_rounded_up() {
        let wording = Wording { loads: String::new(), convert: &|_| None };
        for (value, up, text) in [
            (999.4, false, "999 N"),
            (999.6, false, "1 kN"),
            (12_345.0, false, "12.3 kN"),
            (2.5e6, false, "2.5 MN"),
            (0.001_234, false, "0.00123 N"),
            (5.61, true, "5.7 N"),
            (5.6, true, "5.6 N"),
            (1010.0, true, "1.1 kN"),
        ] {
            assert_eq!(wording.figure(value, "N", up), text);
        }
        // In other units a large number has no exponent.
        let convert = |unit: &str| (unit == "N").then(|| ("ozf".to_owned(), 3.597));
        let wording = Wording { convert: &convert, ..wording };
        assert_eq!(wording.figure(12_345.0, "N", false), "44400 ozf");
        assert_eq!(wording.figure(12_345.0, "N·m", false), "12.3 kN·m");
    }

    #[test]
    fn a_direction_is_named_or_an_angle() {
        let way = |parts, tilt| shape(parts, tilt, Vector::Force);
        assert_eq!(way([1.0, 1.0], 90.0), "up and down");
        assert_eq!(way([1.0, 1.0], 0.04), "sideways");
        assert_eq!(way([1.0, 1.0], -30.06), "along a line at -30.1°");
        assert_eq!(way([2.0, 1.0], 90.0), "largest up and down, turning with the crank");
        assert_eq!(way([0.0, 1.0], 0.0), "constant in size, turning against the crank");
        assert_eq!(shape([1.0, 1.0], 0.0, Vector::Moment), "in pitch");
    }
}
