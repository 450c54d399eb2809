//! What an engine's layout contributes to a sweep: sums that rod, speed and bank angle multiply.

use super::{Selection, Sweep};
use crate::Complex64;
use crate::engine::{Engine, Hold};
use crate::load::{
    BankPhase, Group, Harmonic, Load, PhasorSum, Scene, Term, Wanted, count, find_or_push,
};
use crate::numbers::angle::Angle;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::readings::quantity::{Kind, Quantity};
use crate::source::Column;
use crate::wrench::rounding;

/// Sums of one harmonic of an order, over its amplitude.
#[derive(Clone, Default)]
pub(super) struct LayoutSum {
    pub harmonic: Harmonic,
    /// Forward part and conjugate of the backward part, or torque and nothing.
    pub parts: [BanksTurned; 2],
    /// Bound of the rounding error.
    pub bound: f64,
}

/// A sum with the two banks at `bisector ∓ γ`: cos·cos(|m|γ/2) + sin·sin(|m|γ/2) + rest, m being the
/// multiple of half an angle by which the part turns with its bank.
#[derive(Clone, Copy, Default)]
pub(super) struct BanksTurned {
    pub cos: Complex64,
    pub sin: Complex64,
    /// Of loads that belong to no bank.
    pub rest: Complex64,
}

/// Layout sums of one engine and quantity, order by order.
pub(super) type Layout = Vec<Vec<LayoutSum>>;

impl Sweep {
    /// Layout sums of an engine.
    pub(super) fn layout(
        &self,
        engine: &Engine,
        loads: &Scene,
        selection: Selection,
    ) -> Result<Layout> {
        let vee = match &self.axes.bank_angle {
            Some((_, hold)) => {
                let banks = engine.banks()?;
                let bisector = banks.bisector();
                // The shorter way, half of it, by whole multiples of which half orders turn.
                let halves = banks.directions.map(|bore| {
                    ((bisector - bore + Angle::HALF_TURN).reduced() - Angle::HALF_TURN).half()
                });
                Some((banks.right, halves, *hold))
            }
            None => None,
        };
        let (quantity, planar) = (selection.quantity, selection.quantity.is_planar());
        let wanted = Wanted { planar, roll: !planar, by_bank: vee.is_some() };
        let counts = |load: &&Load| selection.has(loads.group(load.source));
        let counted: Vec<Load> = loads.list.iter().filter(counts).copied().collect();
        let count = count(&loads.list, !planar);
        let mut layout = Layout::new();
        for &order in &self.orders {
            let rounding = rounding(count, order.number());
            let mut sums = Vec::new();
            for term in loads.sums(&counted, order, wanted) {
                let Some(parts) = selection.parts(&term) else { continue };
                let harmonic = term.harmonic;
                let sum = find_or_push(
                    &mut sums,
                    |sum: &LayoutSum| sum.harmonic == harmonic,
                    || LayoutSum { harmonic, ..LayoutSum::default() },
                );
                sum.bound += (parts[0].size + parts[1].size) * rounding;
                let Some((bank, (right, to_bisector, hold))) = term.bank.zip(vee) else {
                    sum.parts.iter_mut().zip(parts).for_each(|(k, part)| k.rest += part.value);
                    continue;
                };
                let is_right = bank == right;
                let to_bisector = to_bisector[usize::from(!is_right)];
                let multiples = quantity.turn(order, hold);
                for ((sum, part), multiple) in sum.parts.iter_mut().zip(parts).zip(multiples) {
                    let turned = part.value * to_bisector.cis(multiple);
                    // e^{−imγ/2} of the right bank, e^{imγ/2} of the left.
                    let sine = Complex64::i() * turned;
                    sum.cos += turned;
                    sum.sin += if is_right == (multiple > 0) { -sine } else { sine };
                }
            }
            layout.push(sums);
        }
        Ok(layout)
    }
}

impl Selection<'_> {
    /// Whether it counts the loads of a group.
    pub(super) fn has(&self, group: &Group) -> bool {
        self.group.is_none_or(|own| own == group) && self.quantity.part.has(&group.name)
    }

    /// The sums of a term that make it: forward part and conjugate of the backward part, or torque.
    fn parts(&self, term: &Term<PhasorSum>) -> Option<[PhasorSum; 2]> {
        let own = term.harmonic.column == Column::Roll;
        match self.quantity.kind {
            Kind::Force | Kind::Moment if own => None,
            Kind::Force => Some(term.force),
            Kind::Moment => Some(term.moment),
            // A shaft that turns evenly takes no torque of the crank, nor does a force on an arm.
            Kind::CrankTorque if !own => None,
            Kind::Torque | Kind::CrankTorque => Some([term.roll, PhasorSum::default()]),
        }
    }
}

impl Quantity<'_> {
    /// Multiples of a quarter of the bank angle for the forward part (or torque) and for the conjugate of
    /// the backward part.
    pub(super) fn turn(self, order: Order, hold: Hold) -> [i64; 2] {
        let turn = BankPhase::new(order, hold);
        if self.is_planar() { [turn.forward, turn.backward_conj] } else { [turn.roll, 0] }
    }
}
