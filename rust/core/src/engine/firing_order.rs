//! Firing orders by name, such as 1-3-4-2.

use std::str::FromStr;

use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// What stands between cylinders: hyphens and the dashes that typesetters make of them.
const BETWEEN: [char; 9] =
    ['-', ',', ' ', '\u{2010}', '\u{2011}', '\u{2012}', '\u{2013}', '\u{2014}', '\u{2212}'];

const NAMED: &str = "name every cylinder from 1 to the number of cylinders once, such as 1-3-4-2";

/// The order in which cylinders fire, by number from 1, such as 1-3-4-2, or 1+4-2+3 for cylinders that
/// fire together. Dummy pistons are not in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FiringOrder(Vec<Vec<usize>>);

impl FiringOrder {
    /// Cylinders by number from 1, each once, in groups that fire together.
    pub fn new(groups: Vec<Vec<usize>>) -> Result<Self> {
        let mut sorted = groups.concat();
        sorted.sort_unstable();
        let twice = sorted.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0]);
        let numbers = 1..=limits::MOST_CYLINDERS;
        let order = Self(groups);
        let outside = sorted.iter().find(|number| !numbers.contains(number));
        let hint = match (twice, outside) {
            (Some(number), _) => format!("{number} is there twice; {NAMED}"),
            (None, Some(_)) => order.dashed(),
            _ if sorted.is_empty() => NAMED.to_owned(),
            _ => return Ok(order),
        };
        Err(Error::value("firing_order", order, hint))
    }

    /// Rejects an order that does not name every cylinder that fires, and no other, by whether each of
    /// the engine's is a dummy.
    pub(crate) fn check_names_all(
        &self,
        count: usize,
        firing: &[usize],
        why_not: impl Fn(usize) -> String,
    ) -> Result<()> {
        let which = if firing.len() < count { " that fire" } else { "" };
        let named = format!("name each of the engine's {} cylinders{which} once", firing.len());
        self.check(count, firing, why_not, &named)
    }

    /// Rejects an order that leaves out a cylinder below the highest that it names.
    pub(crate) fn check_complete(&self) -> Result<()> {
        let all: Vec<usize> = (0..self.cylinders().len()).collect();
        self.check(all.len(), &all, |_| String::new(), NAMED)
    }

    fn check(
        &self,
        count: usize,
        firing: &[usize],
        why_not: impl Fn(usize) -> String,
        named: &str,
    ) -> Result<()> {
        let cylinders = self.cylinders();
        let missing = firing.iter().map(|i| i + 1).find(|number| !cylinders.contains(number));
        let other = cylinders.iter().find(|&&number| !firing.contains(&(number - 1)));
        let hint = match (missing, other) {
            (None, None) => return Ok(()),
            (_, Some(&number)) if number <= count => {
                format!("{number} {}; leave it out", why_not(number - 1))
            }
            (_, Some(_)) if cylinders.len() == 1 => self.dashed(),
            (Some(number), _) => format!("{number} is missing; {named}"),
            (None, Some(_)) => named.to_owned(),
        };
        Err(Error::value("firing_order", self, hint))
    }

    /// A hint for digits that nothing separates.
    fn dashed(&self) -> String {
        let digits: Vec<_> = self.to_string().chars().map(String::from).collect();
        if self.cylinders().len() > 1 || digits.len() == 1 {
            return NAMED.to_owned();
        }
        format!("write '-' between cylinders: {}", digits.join("-"))
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

    /// The cylinders by index from 0, and where one fires together with the one before it; from a
    /// cylinder on, by index, for an order has no beginning.
    pub(crate) fn rotated(&self, first: usize) -> (Vec<usize>, Vec<bool>) {
        let mut groups = self.0.clone();
        let first = groups.iter().position(|group| group.contains(&(first + 1))).unwrap_or(0);
        groups.rotate_left(first);
        for group in &mut groups {
            group.sort_unstable();
        }
        let order = Self(groups);
        (order.cylinders().iter().map(|number| number - 1).collect(), order.together())
    }

    /// Whether each cylinder, in the order in which they fire, fires together with the one before it.
    pub(crate) fn together(&self) -> Vec<bool> {
        self.0.iter().flat_map(|group| (0..group.len()).map(|k| k > 0)).collect()
    }
}

impl FromStr for FiringOrder {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let joined = text.split('+').map(str::trim).collect::<Vec<_>>().join("+");
        let parts = joined.split(BETWEEN).filter(|part| !part.is_empty());
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
        let order: FiringOrder = "145".parse().unwrap();
        let missing = order.check_complete().unwrap_err().to_string();
        assert!(missing.ends_with("write '-' between cylinders: 1-4-5"), "{missing}");
        assert!(hint("1L-3R-2L-4R").contains("letters of banks are not read"));
        for bad in ["", "-", "+", "1+", "1-1", "1+1", "1-+2", "0-1", "1-x"] {
            assert!(bad.parse::<FiringOrder>().is_err(), "{bad}");
        }
        for bad in ["1-3", "2-3", "2"] {
            assert!(bad.parse::<FiringOrder>().unwrap().check_complete().is_err(), "{bad}");
        }
    }

    #[test]
    fn orders_name_all_but_dummy_pistons() {
        let order: FiringOrder = "1-3".parse().unwrap();
        let check = |count: usize, firing: &[usize]| {
            order.check_names_all(count, firing, |_| "is a dummy piston".to_owned())
        };
        let hint = |count: usize, firing: &[usize]| check(count, firing).unwrap_err().to_string();
        assert_eq!(check(3, &[0, 2]), Ok(()));
        assert!(hint(3, &[0, 1, 2]).contains("2 is missing"));
        assert!(
            hint(2, &[0, 1]).ends_with("2 is missing; name each of the engine's 2 cylinders once")
        );
        assert!(hint(2, &[0]).ends_with("name each of the engine's 1 cylinders that fire once"));
        assert!(hint(3, &[0]).contains("3 is a dummy piston"));
    }

    #[test]
    fn orders_begin_with_the_first_cylinder() {
        let order: FiringOrder = "3+2 4,1-5-6".parse().unwrap();
        assert_eq!(order.to_string(), "3+2-4-1-5-6");
        assert_eq!("3+2 – 4‐1—5−6".parse(), Ok(order.clone()));
        let (cylinders, together) = order.rotated(0);
        assert_eq!(cylinders, [0, 4, 5, 1, 2, 3]);
        assert_eq!(together, [false, false, false, false, true, false]);
    }
}
