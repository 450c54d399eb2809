//! A series of amplitudes by order, as far as it matters, and a bound of the rest.

use crate::Complex64;
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::numbers::limits;
use crate::numbers::order::Order;

/// Amplitudes of the torque of a source at some orders, and its mean.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TorqueAmplitudes {
    /// By order.
    pub harmonics: TorqueHarmonics,
    /// On the block and on the main crank.
    pub mean: [f64; 2],
}

impl TorqueAmplitudes {
    /// Of a torque of which block and main crank get these shares: those of [`ActsOn::torque_shares`] where it
    /// acts on a shaft.
    ///
    /// [`ActsOn::torque_shares`]: crate::engine::ActsOn::torque_shares
    #[must_use]
    pub fn shared(amplitudes: &[Complex64], mean: f64, shares: [f64; 2]) -> Self {
        let [roll, crank] = shares.map(|share| amplitudes.iter().map(|a| a * share).collect());
        Self { harmonics: TorqueHarmonics { roll, crank }, mean: shares.map(|share| share * mean) }
    }
}

/// Bounds of what some orders add at any crank angle, mostly the sum of the sizes of their amplitudes; infinite
/// where none is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tail {
    /// To the force.
    pub force: f64,
    /// To either torque.
    pub torque: f64,
}

impl Tail {
    pub(crate) const UNKNOWN: Self = Self { force: f64::INFINITY, torque: f64::INFINITY };
}

/// How far a series goes.
#[derive(Clone, Copy)]
pub enum UpTo<'a> {
    /// All orders up to this number of halves, which may be none.
    Halves(u32),
    /// All that matter: up to the lowest order above which the rest is little enough for a function, or to the
    /// highest that is worth evaluating.
    Enough(&'a dyn Fn(Tail) -> bool),
}

impl UpTo<'_> {
    /// Number of halves up to which it goes, of bounds of what orders above a number of halves add.
    pub fn halves(self, rest: impl Fn(u32) -> Tail) -> u32 {
        match self {
            Self::Halves(halves) => halves,
            Self::Enough(is_enough) => {
                2 * lowest(|order| is_enough(rest(2 * order))).unwrap_or(limits::HIGHEST_ORDER)
            }
        }
    }
}

/// Lowest order from 1 on that is enough, as all above it are; none if the highest is not.
fn lowest(is_enough: impl Fn(u32) -> bool) -> Option<u32> {
    // Mostly it is low: doubling asks less often than halving what there is.
    let (mut low, mut high) = (1, 1);
    while !is_enough(high) {
        if high == limits::HIGHEST_ORDER {
            return None;
        }
        (low, high) = (high + 1, limits::HIGHEST_ORDER.min(2 * high));
    }
    while low < high {
        let middle = u32::midpoint(low, high);
        if is_enough(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    Some(high)
}

/// Orders of a source, their amplitudes, and a bound of the rest.
///
/// A source of a few orders may give all of them, however many are wanted: those beyond count as the rest.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Ascending.
    pub orders: Vec<Order>,
    /// Amplitudes of the force at these; empty where there is none, or where [`Source::force`] evaluates it.
    ///
    /// [`Source::force`]: super::Source::force
    pub force: Vec<Complex64>,
    /// Amplitudes of the torques; empty where there are none, or where [`Source::torque`] evaluates them.
    ///
    /// [`Source::torque`]: super::Source::torque
    pub torque: TorqueAmplitudes,
    /// What orders above these add.
    pub rest: Tail,
}

impl Series {
    /// Of orders whose amplitudes are evaluated elsewhere.
    pub(crate) fn without_amplitudes(orders: Vec<Order>, rest: Tail) -> Self {
        Self { orders, rest, ..Self::default() }
    }

    /// Of orders of a force that are all evaluated: no bound does without them.
    pub(crate) fn unbounded(mut own: Vec<Order>, up_to: UpTo) -> Self {
        let rest = |halves| {
            let is_left_out = own.iter().any(|order| order.halves() > halves);
            Tail { force: if is_left_out { f64::INFINITY } else { 0.0 }, torque: 0.0 }
        };
        let highest = up_to.halves(rest);
        let rest = rest(highest);
        own.retain(|order| order.halves() <= highest);
        Self::without_amplitudes(own, rest)
    }

    /// What those of its orders add that are such, and what the rest does.
    pub(crate) fn left_out(&self, is_left: impl Fn(Order) -> bool) -> Tail {
        let Self { orders, force, torque: TorqueAmplitudes { harmonics, .. }, rest } = self;
        let sum = |amplitudes: &[Complex64]| -> f64 {
            let own = orders.iter().zip(amplitudes).filter(|(order, _)| is_left(**order));
            own.map(|(_, amplitude)| amplitude.norm()).sum()
        };
        Tail {
            force: sum(force) + rest.force,
            torque: sum(&harmonics.roll).max(sum(&harmonics.crank)) + rest.torque,
        }
    }

    /// Whether it has amplitudes.
    pub(crate) fn has_amplitudes(&self) -> bool {
        !self.force.is_empty() || !self.torque.harmonics.roll.is_empty()
    }

    /// Without the orders beyond those wanted, if their amplitudes are known.
    pub(crate) fn cut(mut self, up_to: UpTo) -> Self {
        if !self.has_amplitudes() {
            return self;
        }
        let halves = up_to.halves(|halves| self.left_out(|order| order.halves() > halves));
        let is_beyond = |order: Order| order.halves() > halves;
        let count = self.orders.partition_point(|order| !is_beyond(*order));
        if count < self.orders.len() {
            self.rest = self.left_out(is_beyond);
            let TorqueHarmonics { roll, crank } = &mut self.torque.harmonics;
            for amplitudes in [&mut self.force, roll, crank] {
                amplitudes.truncate(count);
            }
            self.orders.truncate(count);
        }
        self
    }

    /// Whether it has the torques at all orders up to one.
    pub(crate) fn knows_torque_up_to(&self, last: Option<&Order>) -> bool {
        !self.torque.harmonics.roll.is_empty() && self.orders.last() >= last
    }

    /// Amplitudes of the force at some orders.
    pub(crate) fn force_at(&self, orders: &[Order]) -> Vec<Complex64> {
        self.at(&self.force, orders)
    }

    /// Amplitudes of the torques at some orders.
    pub(crate) fn torque_at(&self, orders: &[Order]) -> TorqueAmplitudes {
        let TorqueAmplitudes { harmonics: TorqueHarmonics { roll, crank }, mean } = &self.torque;
        let [roll, crank] = [roll, crank].map(|amplitudes| self.at(amplitudes, orders));
        TorqueAmplitudes { harmonics: TorqueHarmonics { roll, crank }, mean: *mean }
    }

    fn at(&self, amplitudes: &[Complex64], orders: &[Order]) -> Vec<Complex64> {
        let at = |order: &Order| {
            let place = self.orders.binary_search(order).ok();
            place.and_then(|k| amplitudes.get(k)).copied().unwrap_or_default()
        };
        orders.iter().map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_order_that_is_enough_is_found() {
        for expected in [1, 2, 7, 100, limits::HIGHEST_ORDER] {
            assert_eq!(lowest(|order| order >= expected), Some(expected));
        }
        assert_eq!(lowest(|_| false), None);
    }
}
