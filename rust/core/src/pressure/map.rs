//! Maps of cycles over speed and load: places of values among those at which cycles are given.

use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::memory;

/// Place between two neighbours on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Between {
    /// Index of the lower one.
    pub lower: usize,
    /// Weight of the upper one in linear interpolation, 0 to 1.
    pub share: f64,
}

impl Between {
    /// Indices of the two and their weights; of an axis of one value the second has none.
    #[must_use]
    pub fn weights(self) -> [(usize, f64); 2] {
        [(self.lower, 1.0 - self.share), (self.lower + 1, self.share)]
    }
}

/// Places of values on an ascending axis; an error for one beyond its ends, since nothing is
/// extrapolated.
pub fn between(
    argument: &str,
    axis: &[f64],
    values: &[f64],
    cancel: &Cancel,
) -> Result<Vec<Between>> {
    let (&[first, ..], &[.., last]) = (axis, axis) else {
        return Err(Error::value(argument, "of an empty map", "give at least one cycle"));
    };
    let mut places = memory::with_capacity(values.len())?;
    for &value in values {
        cancel.check()?;
        if !(first <= value && value <= last) {
            let hint = format!("the map has {first} to {last}");
            return Err(Error::figure(argument, value, hint));
        }
        // The upper one is the first not below it.
        let lower = axis.partition_point(|&at| at < value).max(1) - 1;
        let share =
            axis.get(lower + 1).map_or(0.0, |upper| (value - axis[lower]) / (upper - axis[lower]));
        places.push(Between { lower, share });
    }
    Ok(places)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_lie_between_neighbours_and_on_them() {
        let found = |axis: &[f64], values: &[f64]| {
            let places = between("load", axis, values, &Cancel::new()).unwrap();
            places.into_iter().map(|Between { lower, share }| (lower, share)).collect::<Vec<_>>()
        };
        let places = found(&[1.0, 2.0, 4.0], &[1.0, 1.25, 2.0, 3.0, 4.0]);
        assert_eq!(places, [(0, 0.0), (0, 0.25), (0, 1.0), (1, 0.5), (1, 1.0)]);
        assert_eq!(found(&[3.0], &[3.0]), [(0, 0.0)]);
        let upper = Between { lower: 1, share: 0.25 };
        assert_eq!(upper.weights(), [(1, 0.75), (2, 0.25)]);
    }

    #[test]
    fn nothing_is_extrapolated() {
        for value in [0.9, 4.1, f64::NAN] {
            let refused = between("load", &[1.0, 4.0], &[2.0, value], &Cancel::new());
            let error = refused.map(drop).unwrap_err().to_string();
            assert!(
                error.starts_with("load = ") && error.ends_with("the map has 1 to 4"),
                "{error}"
            );
        }
        assert!(between("load", &[], &[1.0], &Cancel::new()).is_err());
    }
}
