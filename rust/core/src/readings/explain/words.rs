//! Small texts that sentences and tables share.

use crate::numbers::figure::{rounded, significant};
use crate::numbers::order::Order;

/// Small numbers in words.
const NUMBERS: [&str; 13] = [
    "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven",
    "twelve",
];

/// Line across the engine, along +x, and along +y.
pub(super) const ACROSS: [&str; 2] = ["sideways", "up and down"];

/// What is on the right and on the left where nothing else is said.
const SIDES: [&str; 2] = ["right", "left"];

/// A line across the engine, from its direction in degrees from +x; `sides` is what is on the right and
/// on the left, seen from the flywheel.
#[must_use]
pub fn across(direction_deg: f64, sides: [&str; 2]) -> String {
    // From upright, to the right.
    let lean = rounded((90.0 - direction_deg + 90.0).rem_euclid(180.0) - 90.0, 1);
    let [sideways, upright] = ACROSS;
    if lean.abs() == 90.0 {
        let [right, left] = sides;
        return if sides == SIDES { sideways.to_owned() } else { format!("{left} to {right}") };
    }
    if lean == 0.0 {
        return upright.to_owned();
    }
    let side = sides[usize::from(lean < 0.0)];
    format!("{}° towards the {side} side", significant(lean.abs(), 6))
}

/// How a vector of constant size turns, from its half axis, signed.
#[must_use]
pub fn turns(minor: f64) -> String {
    format!("all round, {} the crank", sense(minor >= 0.0))
}

pub(super) fn sense(forward: bool) -> &'static str {
    if forward { "with" } else { "against" }
}

/// Items joined by commas and "and".
pub(super) fn listed(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [before @ .., last] => format!("{} and {last}", before.join(", ")),
    }
}

/// `order 2` or `orders 1 and 2`.
pub(super) fn orders(orders: &[Order]) -> String {
    let items: Vec<String> = orders.iter().map(Order::to_string).collect();
    format!("order{} {}", if orders.len() > 1 { "s" } else { "" }, listed(&items))
}

/// A count in words, from 13 on in figures.
pub(super) fn number(count: usize) -> String {
    NUMBERS.get(count).map_or_else(|| count.to_string(), |&word| word.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_across_lean_to_the_side_that_is_named() {
        let sides = ["exhaust", "intake"];
        for (direction, text) in [
            (90.0, "up and down"),
            (-90.0, "up and down"),
            (0.04, "intake to exhaust"),
            (180.0, "intake to exhaust"),
            (60.0, "30° towards the exhaust side"),
            (-45.26, "44.7° towards the intake side"),
        ] {
            assert_eq!(across(direction, sides), text);
        }
        assert_eq!(across(180.0, SIDES), "sideways");
        let turned = [1.0, -1.0].map(turns);
        assert_eq!(turned, ["all round, with the crank", "all round, against the crank"]);
    }

    #[test]
    fn lists_have_commas_and_a_last_and() {
        let of = |numbers: &[u32]| orders(&Order::all_whole(numbers).unwrap());
        assert_eq!([of(&[2]), of(&[1, 2, 10])], ["order 2", "orders 1, 2 and 10"]);
        assert_eq!(orders(&[Order::from_halves(3).unwrap()]), "order 1.5");
        assert_eq!([0, 12, 13].map(number), ["no", "twelve", "13"]);
    }
}
