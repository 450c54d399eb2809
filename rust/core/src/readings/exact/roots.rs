//! Loads in exact numbers: roots of unity, times symbols for angles that are no simple parts of a turn.

use crate::load::{Arithmetic, Factor, Load, LoadIndex, Scene, Weight};
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::decimal::WITHIN_ULP;
use crate::numbers::error::Result;
use crate::numbers::index::List;
use crate::numbers::rational::{Ratio, product, recognise, turned};

/// Angles of more parts of a turn are symbols: those of six decimals have 3.6e8 at most.
const MOST_PARTS_OF_ROOT: i64 = 1_000_000_000;

/// Angle as a rational part of a turn and, if it is no simple one, an index from 1 of what is beside.
#[derive(Debug, Clone, Copy)]
pub(super) struct PartOfTurn {
    pub turns: Ratio,
    pub symbol: usize,
}

/// Simple parts of a turn as they are; others by one index where they are equal or, if `in_steps`, a
/// simple part of a turn apart.
pub(super) fn parts_of_turn<I>(
    angles: impl Iterator<Item = Angle>,
    in_steps: bool,
    cancel: &Cancel,
) -> Result<List<I, PartOfTurn>> {
    let mut others: Vec<Angle> = Vec::new();
    let part = |angle: Angle| {
        if let Some(turns) = simple(angle) {
            return Ok(PartOfTurn { turns, symbol: 0 });
        }
        cancel.check()?;
        let known = others.iter().enumerate().find_map(|(k, &other)| {
            let step = if other == angle { Some(Ratio::ZERO) } else { step(angle, other) };
            Some((k, step.filter(|&turns| in_steps || turns == Ratio::ZERO)?))
        });
        let (index, turns) = known.unwrap_or_else(|| {
            others.push(angle);
            (others.len() - 1, Ratio::ZERO)
        });
        Ok(PartOfTurn { turns, symbol: index + 1 })
    };
    angles.map(part).collect()
}

fn simple(angle: Angle) -> Option<Ratio> {
    let (numerator, denominator) =
        angle.turns().filter(|&(_, parts)| parts <= MOST_PARTS_OF_ROOT)?;
    Some(Ratio::new(numerator.into(), denominator.into()))
}

/// The simple part of a turn from one angle to another, if it is one.
fn step(to: Angle, from: Angle) -> Option<Ratio> {
    if to.turns().is_some() && from.turns().is_some() {
        return simple(to - from);
    }
    // Both are right within a few units in the last place of a turn.
    recognise((to.degrees() - from.degrees()) / 360.0, WITHIN_ULP * f64::EPSILON)
}

/// How a direction that is no simple part of a turn enters a sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) enum SymbolEntry {
    #[default]
    UnityRoot,
    Conjugate,
    /// Cosine along x, sine along y; neither is zero.
    Component,
}

/// A root of unity times symbols, by their indices, 0 for none.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnityRoot {
    /// In [0, 1).
    pub turns: Ratio,
    pub direction: (usize, SymbolEntry),
    pub phase: usize,
}

impl UnityRoot {
    /// Turned by a part of a turn, whose denominator is below 10⁹ as that of the others.
    pub fn turned(self, by: Ratio) -> Self {
        Self { turns: turned(self.turns, by), ..self }
    }
}

/// A load's part of a sum: a number of eighths of its weight times a root.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    pub load: LoadIndex,
    pub weight: Weight,
    pub root: UnityRoot,
    pub eighths: i32,
}

/// Arithmetic of proofs and closed forms: sums are lists of what each load adds.
pub(super) struct FormalSum {
    pub directions: List<LoadIndex, PartOfTurn>,
    pub phases: List<LoadIndex, PartOfTurn>,
}

impl FormalSum {
    pub fn new(loads: &Scene, cancel: &Cancel) -> Result<Self> {
        let directions = loads.list.iter().map(|load| load.place.direction);
        let phases = loads.list.iter().map(|load| load.place.phase);
        Ok(Self {
            directions: parts_of_turn(directions, true, cancel)?,
            phases: parts_of_turn(phases, true, cancel)?,
        })
    }
}

impl Arithmetic for FormalSum {
    type Unit = UnityRoot;
    type Sum = Vec<Share>;

    fn phase(&self, (i, _): (LoadIndex, &Load), times: i64) -> UnityRoot {
        let PartOfTurn { turns, symbol } = self.phases[i];
        let none =
            UnityRoot { turns: Ratio::ZERO, direction: (0, SymbolEntry::UnityRoot), phase: symbol };
        let times = i128::from(times);
        none.turned(product(turns, times.into()).unwrap_or_else(|| turns * times))
    }

    fn toward(&self, (i, _): (LoadIndex, &Load), unit: &UnityRoot, conjugate: bool) -> UnityRoot {
        let PartOfTurn { turns, symbol } = self.directions[i];
        let entry =
            if conjugate && symbol > 0 { SymbolEntry::Conjugate } else { SymbolEntry::UnityRoot };
        let turned = unit.turned(if conjugate { -turns } else { turns });
        UnityRoot { direction: (symbol, entry), ..turned }
    }

    fn add(
        &self,
        sum: &mut Vec<Share>,
        (load, _): (LoadIndex, &Load),
        weight: Weight,
        unit: &UnityRoot,
        Factor { eighths, quarters }: Factor,
    ) {
        let root = unit.turned(Ratio::new(quarters.into(), 4));
        sum.push(Share { load, weight, root, eighths });
    }
}
