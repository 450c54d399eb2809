//! A few orders that serve every point of a sweep within a tolerance.

use std::borrow::Cow;

use super::Sweep;
use crate::load::Sources;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::readings::balance::ErrorBounds;
use crate::readings::choice::{Candidate, Choice, bounds};
use crate::source::Point;

impl Sweep {
    /// Orders that leave out at most `rtol` at any point, those that were evaluated besides and are not zero
    /// everywhere, and the bound of what is left out.
    pub(super) fn chosen(
        &self,
        rtol: f64,
        cancel: &Cancel,
    ) -> Result<(Vec<Order>, Vec<Order>, ErrorBounds)> {
        let ([rod_ratio, pin_offset], at) = (self.extremes, |point| self.proportions_at(point));
        let (points, by_bank) = ((self.points(), &at as _), self.axes.bank_angle.is_some());
        let mut candidates = Vec::new();
        for loads in &self.loads {
            let sources = |point: Point| -> Result<Cow<Sources>> {
                if point == Point::default() {
                    return Ok(Cow::Borrowed(&loads.sources));
                }
                loads.at_point(&point).map(Cow::Owned)
            };
            // Between the cycles of a map no sum is larger than the largest of theirs.
            for cycles in (0..self.nodes.count()).map(|node| self.cycles_at(node)) {
                let own = sources(Point { cycles, ..Point::default() })?;
                let slowest = sources(Point { rod_ratio, pin_offset, cycles })?;
                candidates.push(Candidate { loads, own, slowest, points, by_bank });
            }
        }
        let choice = Choice::new(rtol, &candidates, self.torque, cancel)?;
        let of = |(lost, Candidate { loads, .. }): (&_, &Candidate)| {
            bounds(lost, &loads.groups, &self.omegas)
        };
        let bound = choice.left_out.iter().map(|lost| &**lost).zip(&candidates).map(of);
        let bound = bound.fold(ErrorBounds::default(), ErrorBounds::max);
        let (mut orders, mut omitted) = (Vec::new(), Vec::new());
        for (order, (kept, is_zero)) in
            choice.orders.into_iter().zip(choice.kept.into_iter().zip(choice.is_zero))
        {
            if kept {
                orders.push(order);
            } else if !is_zero {
                omitted.push(order);
            }
        }
        Ok((orders, omitted, bound))
    }
}
