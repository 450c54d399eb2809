//! Firing orders by name, such as 1-3-4-2.

use std::str::FromStr;

use crate::layout::FiringOrder;
use crate::numbers::error::{Error, Result};

/// An order in which an engine is asked to fire, such as 1-3-4-2, or 1+4-2+3 for cylinders that
/// fire together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedOrder {
    /// Cylinders by index from 0, from the first cylinder on.
    pub(super) cylinders: Vec<usize>,
    /// True where a cylinder fires together with the one before it.
    pub(super) together: Vec<bool>,
}

impl FromStr for NamedOrder {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let parts = text.split(['-', ',', ' ']).filter(|part| !part.is_empty());
        let groups: std::result::Result<Vec<Vec<usize>>, _> =
            parts.map(|part| part.split('+').map(str::parse).collect()).collect();
        let Ok(mut groups) = groups else {
            let hint = "give cylinder numbers joined by '-', such as 1-3-4-2, those that fire \
                        together by '+'";
            return Err(Error::value("firing_order", text, hint));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_that_are_none_are_refused() {
        for bad in ["", "+", "1+", "1-1", "1+1", "1-+2", "2-3", "1-x"] {
            assert!(bad.parse::<NamedOrder>().is_err(), "{bad}");
        }
    }
}
