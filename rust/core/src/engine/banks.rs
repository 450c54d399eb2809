//! The two banks of a vee, and the angle between them.

use super::{Engine, Station};
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::distinct;

/// What a change of bank angle leaves as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// The crank: crankpins keep their angles and the firing intervals change (the IJESC paper).
    Pins,
    /// The firing: every top dead centre stays and the pins are split as needed (Ito, Hattori).
    Firing,
}

/// The two banks of a vee.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Banks {
    /// Index of the bank at x > 0 where the vee stands upright.
    pub right: usize,
    /// Directions of the right bank and of the left, which is up to 180° ahead of it.
    pub directions: [Angle; 2],
}

impl Banks {
    /// Angle between the banks, up to 180°.
    #[must_use]
    pub fn angle(&self) -> Angle {
        (self.directions[1] - self.directions[0]).reduced()
    }

    /// Direction half-way from the right bank to the left.
    #[must_use]
    pub fn bisector(&self) -> Angle {
        (self.directions[0] + self.angle().half()).reduced()
    }
}

impl Engine {
    /// The cylinders of each bank, by index.
    #[must_use]
    pub fn cylinders_of_banks(&self) -> Vec<Vec<usize>> {
        let mut banks = vec![Vec::new(); self.bank_directions().len()];
        self.bank_of.iter().enumerate().for_each(|(i, &bank)| banks[bank].push(i));
        banks
    }

    /// Whether directions alone say which cylinders are in which bank, but for some at 0° and 180°.
    pub(super) fn has_banks_of_directions(&self) -> bool {
        let keys = banks_of_directions(&self.stations);
        right_bank(&self.stations, &keys) == self.right
            && distinct::<usize, _>(keys.iter()).1 == self.bank_of
    }

    /// The two banks of a vee.
    pub fn banks(&self) -> Result<Banks> {
        let directions = self.bank_directions();
        let Some(right) = self.right else {
            let listed: Vec<String> = directions.iter().map(|bank| format!("{bank}°")).collect();
            let count = match listed.len() {
                1 => "one bank".to_owned(),
                count => format!("{count} banks"),
            };
            return Err(Error::Undefined {
                argument: "bank_angle_deg",
                reason: format!("it has {count} ({}); exactly two are needed", listed.join(", ")),
            });
        };
        Ok(Banks { right, directions: [directions[right], directions[1 - right]] })
    }

    /// The two banks; rejects engines whose cylinders do not all turn with one crank, where a change of
    /// bank angle would have to say about which.
    pub(crate) fn check_bank_angle_can_change(&self) -> Result<Banks> {
        self.check_one_crank("a change of bank_angle_deg")?;
        self.check_no_link_rods("bank_angle_deg")?;
        self.banks()
    }

    /// Bank angle that can change, degrees: of two banks on one crank.
    #[must_use]
    pub fn changeable_bank_angle(&self) -> Option<f64> {
        self.check_bank_angle_can_change().ok().map(|banks| banks.angle().degrees())
    }

    /// The same engine with its two banks at another angle about the same bisector.
    pub fn with_bank_angle(&self, bank_angle: Angle, hold: Hold) -> Result<Self> {
        bank_angle_in_range(bank_angle.degrees())?;
        let vee = self.check_bank_angle_can_change()?;
        let (middle, half) = (vee.bisector(), bank_angle.half());
        let mut turned = self.clone();
        for (bank, old) in self.bank_directions().into_iter().enumerate() {
            let bore = if bank == vee.right { middle - half } else { middle + half };
            let turn = (bore - old + Angle::HALF_TURN).reduced() - Angle::HALF_TURN;
            turned.turn_loads(bank, turn, hold == Hold::Pins);
        }
        for i in 0..self.stations.len() {
            let bore = if self.bank_of[i] == vee.right { middle - half } else { middle + half };
            if hold == Hold::Pins {
                // The shorter way: firing goes along.
                let turn = (bore - turned.stations[i].bank + Angle::HALF_TURN).reduced()
                    - Angle::HALF_TURN;
                turned.delay(i, turn);
            }
            turned.stations[i].bank = bore.reduced();
        }
        Ok(turned)
    }
}

/// Keys of the banks of stations that their directions alone distinguish.
pub(super) fn banks_of_directions(stations: &[Station]) -> Vec<usize> {
    let (_, mut banks) = distinct::<usize, _>(stations.iter().map(|p| p.bank.reduced()));
    // Of opposite bores those nearer to +x are the right bank: a flat engine's at 0°.
    if let Some(first) = stations.first()
        && stations.iter().any(|p| p.bank.reduced().degrees() < first.bank.reduced().degrees())
    {
        let last = banks.iter().copied().max().unwrap_or(0);
        banks = banks.into_iter().map(|bank| last - bank).collect();
    }
    banks
}

/// The right one of two banks: the other is up to 180° ahead of it.
pub(super) fn right_bank(stations: &[Station], keys: &[usize]) -> Option<usize> {
    let second = keys.iter().position(|key| *key != keys[0])?;
    if keys.iter().any(|key| *key != keys[0] && *key != keys[second]) {
        return None;
    }
    let (first, other) = (stations[0].bank, stations[second].bank);
    Some(match (other - first).reduced().degrees() {
        0.0 | 180.0 => usize::from(keys[second] < keys[0]),
        ahead => usize::from(ahead > 180.0),
    })
}

/// A bank angle from 0° to 180°.
pub fn bank_angle_in_range(degrees: f64) -> Result<f64> {
    if (0.0..=180.0).contains(&degrees) {
        return Ok(degrees);
    }
    Err(Error::figure("bank_angle_deg", degrees, "give degrees between 0 and 180"))
}
