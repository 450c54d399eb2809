//! Engine orders: multiples of crank speed, counted in halves.

use std::fmt;

use crate::numbers::error::{Error, Result};
use crate::numbers::limits::HIGHEST_ORDER;

/// A multiple of crank speed, a whole number of halves above zero.
///
/// ```
/// use crankpin_core::Order;
///
/// let half = Order::from_number(0.5)?;
/// assert_eq!((half.halves(), half.as_whole(), Order::FIRST.as_whole()), (1, None, Some(1)));
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Order(u32);

impl Order {
    /// Order 1, crank speed.
    pub const FIRST: Self = Self(2);
    /// The highest there is.
    pub const HIGHEST: Self = Self(2 * HIGHEST_ORDER);

    /// A whole order, 1 to [`HIGHEST_ORDER`].
    pub fn whole(order: u32) -> Result<Self> {
        if (1..=HIGHEST_ORDER).contains(&order) {
            return Ok(Self(2 * order));
        }
        Err(out_of_range(order))
    }

    /// Twice the order, 1 to 2·[`HIGHEST_ORDER`].
    pub fn from_halves(halves: u32) -> Result<Self> {
        if (1..=2 * HIGHEST_ORDER).contains(&halves) {
            return Ok(Self(halves));
        }
        Err(out_of_range(0.5 * f64::from(halves)))
    }

    /// From a number, whole or half.
    pub fn from_number(order: f64) -> Result<Self> {
        let halves = 2.0 * order;
        if halves.fract() == 0.0 && (1.0..=2.0 * f64::from(HIGHEST_ORDER)).contains(&halves) {
            return Ok(Self(halves as u32));
        }
        Err(out_of_range(order))
    }

    /// Whole orders from a list.
    pub fn all_whole(orders: &[u32]) -> Result<Vec<Self>> {
        orders.iter().map(|&order| Self::whole(order)).collect()
    }

    /// Twice the order.
    #[must_use]
    pub fn halves(self) -> u32 {
        self.0
    }

    /// The order if it is whole.
    #[must_use]
    pub fn as_whole(self) -> Option<u32> {
        self.0.is_multiple_of(2).then_some(self.0 / 2)
    }

    /// Whether it is 1, 3, 5 …
    #[must_use]
    pub fn is_odd(self) -> bool {
        self.0 % 4 == 2
    }

    /// The order as a number.
    #[must_use]
    pub fn number(self) -> f64 {
        0.5 * f64::from(self.0)
    }
}

fn out_of_range(order: impl fmt::Display) -> Error {
    let hint = format!("orders are multiples of crank speed, 1 to {HIGHEST_ORDER}");
    Error::value("orders", order, hint)
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.number())
    }
}

/// Rejects an empty list and an order given twice.
pub fn check_list(orders: &[Order]) -> Result<()> {
    if orders.is_empty() {
        return Err(Error::value("orders", "[]", "give at least one order, such as [1, 2]"));
    }
    let mut sorted = orders.to_vec();
    sorted.sort_unstable();
    if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(Error::value("orders", pair[0], "is given twice; give each order once"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_counted_in_halves() {
        let order = Order::from_halves(3).unwrap();
        assert_eq!(
            (order.number(), order.as_whole(), order.to_string()),
            (1.5, None, "1.5".into())
        );
        assert_eq!(Order::whole(4).unwrap().as_whole(), Some(4));
        let odd = |halves: &u32| Order::from_halves(*halves).unwrap().is_odd();
        assert_eq!((1..=10).filter(odd).collect::<Vec<_>>(), [2, 6, 10]);
        assert_eq!(Order::whole(1), Ok(Order::FIRST));
        assert_eq!(Order::whole(HIGHEST_ORDER).unwrap().halves(), 2 * HIGHEST_ORDER);
    }

    #[test]
    fn orders_out_of_range_and_repeated_are_rejected() {
        for order in [0, HIGHEST_ORDER + 1, u32::MAX] {
            let error = Order::whole(order).unwrap_err().to_string();
            assert!(error.contains(&format!("orders = {order}:")), "{error}");
        }
        assert!(Order::from_halves(0).is_err());
        let list = |orders: &[u32]| check_list(&Order::all_whole(orders).unwrap());
        assert!(list(&[2, 1, HIGHEST_ORDER]).is_ok());
        assert!(list(&[1, 2, 1]).unwrap_err().to_string().contains("orders = 1: is given twice"));
        assert!(list(&[]).is_err());
    }
}
