//! Quantities of an engine: force, moment or a torque, whole or the part of one name.

use crate::numbers::error::{Error, Result};
use crate::source::{GAS, INERTIA};

/// Kinds of quantities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Shaking force along x and y, N.
    Force,
    /// Rocking moment about x and y, N·m.
    Moment,
    /// Roll torque on the block, N·m.
    Torque,
    /// Torque on the crank, N·m.
    CrankTorque,
}

/// Part of a quantity, by the name of what makes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part<'a> {
    /// All of it.
    Whole,
    /// What the sources of a name make, such as `inertia`; nothing where there are none.
    Of(&'a str),
}

impl Part<'static> {
    /// Of moving parts.
    pub const INERTIA: Self = Self::Of(INERTIA);
    /// Of the pressure in cylinders.
    pub const GAS: Self = Self::Of(GAS);
}

impl Part<'_> {
    /// Whether a name makes some of it.
    #[must_use]
    pub fn has(self, name: &str) -> bool {
        match self {
            Self::Whole => true,
            Self::Of(own) => own == name,
        }
    }
}

/// A quantity, or a part of it.
///
/// ```
/// use crankpin_core::quantity::{Kind, Part, Quantity};
///
/// assert_eq!(Quantity::parse("force")?, Quantity::FORCE);
/// assert_eq!(Quantity::parse("torque.gas")?, Quantity::TORQUE.part(Part::GAS));
/// assert!(Quantity::parse("power").is_err());
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantity<'a> {
    /// What it is.
    pub kind: Kind,
    /// How much of it.
    pub part: Part<'a>,
}

/// Words of the kinds.
const WORDS: [(&str, Kind); 4] = [
    ("force", Kind::Force),
    ("moment", Kind::Moment),
    ("torque", Kind::Torque),
    ("crank_torque", Kind::CrankTorque),
];

impl Quantity<'static> {
    /// Shaking force.
    pub const FORCE: Self = Self { kind: Kind::Force, part: Part::Whole };
    /// Rocking moment.
    pub const MOMENT: Self = Self { kind: Kind::Moment, part: Part::Whole };
    /// Roll torque on the block.
    pub const TORQUE: Self = Self { kind: Kind::Torque, part: Part::Whole };
    /// Torque on the crank.
    pub const CRANK_TORQUE: Self = Self { kind: Kind::CrankTorque, part: Part::Whole };
}

impl<'a> Quantity<'a> {
    /// By its text: `force`, `moment`, `torque` or `crank_torque`, and after a point the name of a part.
    pub fn parse(text: &'a str) -> Result<Self> {
        let (word, name) = match text.split_once('.') {
            Some((word, name)) => (word, Some(name)),
            None => (text, None),
        };
        let kind = WORDS.iter().find(|(own, _)| *own == word).map(|(_, kind)| *kind);
        let kind = kind.filter(|_| name != Some("")).ok_or_else(|| {
            let hint = "give \"force\", \"moment\", \"torque\" or \"crank_torque\", or a part of one such \
                        as \"torque.gas\"";
            Error::value("quantity", format!("{text:?}"), hint)
        })?;
        Ok(Self { kind, part: name.map_or(Part::Whole, Part::Of) })
    }

    /// A part of the same quantity.
    #[must_use]
    pub fn part(self, part: Part) -> Quantity {
        Quantity { kind: self.kind, part }
    }

    /// Whether it is a vector in the cross-section.
    #[must_use]
    pub fn is_planar(self) -> bool {
        matches!(self.kind, Kind::Force | Kind::Moment)
    }

    /// Axes of one value: x and y, or none for what is about z alone.
    #[must_use]
    pub fn shape(self) -> &'static [usize] {
        if self.is_planar() { &[2] } else { &[] }
    }

    /// How many components one value has.
    #[must_use]
    pub fn components(self) -> usize {
        self.shape().iter().product()
    }
}
