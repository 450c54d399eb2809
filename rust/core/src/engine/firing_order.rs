//! Firing orders by name, such as 1-3-4-2.

use std::str::FromStr;

use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// What stands between cylinders: hyphens and the dashes that typesetters make of them.
const BETWEEN: [char; 9] =
    ['-', ',', ' ', '\u{2010}', '\u{2011}', '\u{2012}', '\u{2013}', '\u{2014}', '\u{2212}'];

/// The order in which cylinders fire, by number from 1, such as 1-3-4-2, or 1+4-2+3 for cylinders that
/// fire together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FiringOrder(Vec<Vec<usize>>);

impl FiringOrder {
    /// Each cylinder from 1 to the number of them once, in groups that fire together.
    pub fn new(groups: Vec<Vec<usize>>) -> Result<Self> {
        let mut sorted = groups.concat();
        sorted.sort_unstable();
        let count = sorted.len();
        let twice = sorted.windows(2).find(|pair| pair[0] == pair[1]);
        let missing = (1..=count).find(|number| sorted.binary_search(number).is_err());
        let fault = twice
            .map(|pair| (pair[0], "there twice"))
            .or_else(|| missing.map(|number| (number, "missing")));
        let listed = count > 0 && fault.is_none();
        let order = Self(groups);
        if !listed || count > limits::MOST_CYLINDERS {
            let named =
                "name every cylinder from 1 to the number of cylinders once, such as 1-3-4-2";
            let hint = match fault {
                Some(_) if count == 1 => {
                    let digits: Vec<_> = order.to_string().chars().map(String::from).collect();
                    format!("write '-' between cylinders: {}", digits.join("-"))
                }
                Some((number, fault)) => format!("{number} is {fault}; {named}"),
                None => named.to_owned(),
            };
            return Err(Error::value("firing_order", order, hint));
        }
        Ok(order)
    }

    /// The cylinders by number from 1, in the order in which they fire.
    #[must_use]
    pub fn cylinders(&self) -> Vec<usize> {
        self.0.concat()
    }

    /// Whether some cylinders fire together.
    #[must_use]
    pub fn has_groups(&self) -> bool {
        self.0.iter().any(|group| group.len() > 1)
    }

    /// The cylinders by index from 0, and where one fires together with the one before it; from the
    /// first cylinder on, as is the custom, for an order has no beginning.
    pub(crate) fn rotated(&self) -> (Vec<usize>, Vec<bool>) {
        let mut groups = self.0.clone();
        let first = groups.iter().position(|group| group.contains(&1)).unwrap_or(0);
        groups.rotate_left(first);
        for group in &mut groups {
            group.sort_unstable();
        }
        let together = groups.iter().flat_map(|group| (0..group.len()).map(|k| k > 0));
        (groups.iter().flatten().map(|number| number - 1).collect(), together.collect())
    }
}

impl FromStr for FiringOrder {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let parts = text.split(BETWEEN).filter(|part| !part.is_empty());
        let groups: std::result::Result<Vec<Vec<usize>>, _> =
            parts.map(|part| part.split('+').map(str::parse).collect()).collect();
        let mut hint = "give cylinder numbers joined by '-', such as 1-3-4-2, those that fire \
                        together by '+'"
            .to_owned();
        if text.contains(|letter: char| letter.is_ascii_alphabetic()) {
            hint += "; letters of banks are not read: number all cylinders from 1 in place of them";
        }
        groups.map_err(|_| Error::value("firing_order", text, hint)).and_then(Self::new)
    }
}

impl std::fmt::Display for FiringOrder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let joined = |group: &Vec<usize>| {
            group.iter().map(ToString::to_string).collect::<Vec<_>>().join("+")
        };
        f.write_str(&self.0.iter().map(joined).collect::<Vec<_>>().join("-"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_that_are_none_are_refused() {
        let hint = |text: &str| text.parse::<FiringOrder>().unwrap_err().to_string();
        assert!(hint("145236").ends_with("write '-' between cylinders: 1-4-5-2-3-6"));
        assert!(hint("1L-3R-2L-4R").contains("letters of banks are not read"));
        for bad in ["", "-", "+", "1+", "1-1", "1+1", "1-+2", "0-1", "1-3", "2-3", "1-x"] {
            assert!(bad.parse::<FiringOrder>().is_err(), "{bad}");
        }
    }

    #[test]
    fn orders_begin_with_the_first_cylinder() {
        let order: FiringOrder = "3+2 4,1-5-6".parse().unwrap();
        assert_eq!(order.to_string(), "3+2-4-1-5-6");
        assert_eq!("3+2 – 4‐1—5−6".parse(), Ok(order.clone()));
        let (cylinders, together) = order.rotated();
        assert_eq!(cylinders, [0, 4, 5, 1, 2, 3]);
        assert_eq!(together, [false, false, false, false, true, false]);
    }
}
