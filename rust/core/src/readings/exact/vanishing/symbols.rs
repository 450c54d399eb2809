//! What has no rational relation to the rest of a sum: symbols that multiply roots of unity.

use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::decimal::WITHIN_ULP;
use crate::numbers::error::Result;
use crate::numbers::rational::{Ratio, recognise};

/// Factor of a sum of roots of unity, by which the harmonic of a motion is meant; of odd parts in the
/// pin offset apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) enum Channel {
    /// 1: the first order of pistons without offset, and unbalances.
    #[default]
    One,
    /// Of the masses of a motion.
    Masses(usize),
    OddOfMasses(usize),
    /// Torque of the rod inertia of a motion.
    Rod(usize),
    OddOfRod(usize),
    /// Torque of a whole running gear, masses and rod.
    Gear(usize),
    OddOfGear(usize),
}

/// Lists of weights that have no rational relation to each other's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) enum Weights {
    /// m·r and unbalances, kg·m.
    #[default]
    Planar,
    /// m·r², kg·m².
    Masses,
    /// Rod inertia, kg·m².
    Rod,
    /// Unbalance times x or y of the shaft's axis, kg·m².
    Arm,
    /// 1.
    Gear,
}

/// How a direction that is no rational part of a turn enters a sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) enum Entry {
    #[default]
    Root,
    Conjugate,
    /// Cosine along x, sine along y; neither is zero.
    Component,
}

/// What a sum of roots of unity is multiplied by: indices of symbols.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) struct Symbol {
    pub channel: Channel,
    /// Unit of weight.
    pub weight: (Weights, usize),
    /// Unit of length.
    pub lever: usize,
    /// Direction that is no rational part of a turn, 0 for others.
    pub direction: (usize, Entry),
    /// Phase that is none.
    pub phase: usize,
}

/// A load's part of a sum: weight times the root of unity at `turns`.
pub(super) struct Term {
    pub symbol: Symbol,
    pub turns: (i128, i128),
    pub weight: Ratio,
}

/// Angle as a rational part of a turn and, if it is no simple one, an index from 1 of what is beside.
#[derive(Debug, Clone, Copy)]
pub(super) struct Direct {
    pub turns: (i128, i128),
    pub symbol: usize,
}

/// Angles of more parts of a turn are symbols: those of six decimals have 3.6e8 at most.
const MOST_PARTS: i64 = 1_000_000_000;

/// Simple parts of a turn as they are; others by one index where they are equal or, if `in_steps`, a
/// simple part of a turn apart.
pub(super) fn directions(
    angles: impl Iterator<Item = Angle>,
    in_steps: bool,
    cancel: &Cancel,
) -> Result<Vec<Direct>> {
    let mut others: Vec<Angle> = Vec::new();
    let direct = |angle: Angle| {
        if let Some(turns) = simple(angle) {
            return Ok(Direct { turns, symbol: 0 });
        }
        cancel.check()?;
        let known = others.iter().enumerate().find_map(|(k, &other)| {
            let step = if other == angle { Some((0, 1)) } else { step(angle, other) };
            Some((k, step.filter(|&(turns, _)| in_steps || turns == 0)?))
        });
        let (index, turns) = known.unwrap_or_else(|| {
            others.push(angle);
            (others.len() - 1, (0, 1))
        });
        Ok(Direct { turns, symbol: index + 1 })
    };
    angles.map(direct).collect()
}

fn simple(angle: Angle) -> Option<(i128, i128)> {
    let (numerator, denominator) = angle.turns().filter(|&(_, parts)| parts <= MOST_PARTS)?;
    Some((numerator.into(), denominator.into()))
}

/// The simple part of a turn from one angle to another, if it is one.
fn step(to: Angle, from: Angle) -> Option<(i128, i128)> {
    if to.turns().is_some() && from.turns().is_some() {
        return simple(to - from);
    }
    // Both are right within a few units in the last place of a turn.
    let apart = (to.degrees() - from.degrees()) / 360.0;
    Some(recognise(apart, WITHIN_ULP * f64::EPSILON)?.into_raw())
}

/// How the harmonics of cylinders of different proportions are distinguished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct View {
    /// Real and imaginary parts apart, of which a mirrored pin offset changes some signs:
    /// `a₁ = 1 + ib`, even orders are real and even in the offset, odd ones above imaginary and odd in
    /// it. Otherwise a complex number for each set of proportions.
    pub parts: bool,
    /// Torque by whole running gears, whose masses and rod have one phase.
    pub gears: bool,
}
