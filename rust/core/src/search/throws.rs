//! Which throw sits where: the arrangements of one bank, up to turning the crank.

use crate::angle::Angle;
use crate::error::{Error, Result};
use crate::rational::divisor;

/// Most throws in a bank; an arrangement is packed into four bits a throw.
pub const MOST_THROWS: usize = 15;

/// Phases of one bank's throws, and which of their arrangements are candidates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bank {
    /// Phases as multiples of 1/`parts` of a turn, one for each throw, ascending.
    pub phases: Vec<u32>,
    /// Parts of a turn.
    pub parts: u32,
    /// Only arrangements whose front and rear halves take turns to fire.
    pub alternating: bool,
    turns: u32,
    mirror: Option<u32>,
}

/// One arrangement: the phase of each throw, front to flywheel, in multiples of 1/`parts` of a turn.
pub type Arrangement = Vec<u32>;

impl Bank {
    /// The even-firing four-stroke crank: an odd number of throws n has n phases, an even one n/2
    /// phases, each twice.
    pub fn even_firing(throws: usize, alternating: bool) -> Result<Self> {
        check_count(throws)?;
        let parts = if throws % 2 == 1 { throws } else { throws / 2 };
        let mut phases: Vec<u32> = (0..throws).map(|k| (k % parts) as u32).collect();
        phases.sort_unstable();
        Ok(Self::of(phases, parts as u32, alternating))
    }

    /// Given phases, each a rational part of a turn; the alternation rule asks for even firing.
    pub fn with_phases(phases: &[Angle]) -> Result<Self> {
        check_count(phases.len())?;
        let mut parts: i64 = 1;
        for phase in phases {
            let Angle::Turns(_, denominator) = phase.reduced() else {
                let cure = "give rational parts of a turn, such as 90 or \"360/7\"";
                return Err(Error::value("phases_deg", phase, cure));
            };
            parts = parts / divisor(parts, denominator) * denominator;
            if parts > 360 {
                let cure = "give phases that are multiples of one part of a turn, 1/360 or larger";
                return Err(Error::value("phases_deg", phase, cure));
            }
        }
        let mut multiples: Vec<u32> = phases
            .iter()
            .map(|phase| match phase.reduced() {
                Angle::Turns(numerator, denominator) => (numerator * (parts / denominator)) as u32,
                Angle::Degrees(_) => 0,
            })
            .collect();
        multiples.sort_unstable();
        Ok(Self::of(multiples, parts as u32, false))
    }

    /// Ascending phases, and what leaves them as they are: both are asked for each arrangement.
    fn of(phases: Vec<u32>, parts: u32, alternating: bool) -> Self {
        let same = |image: &dyn Fn(u32) -> u32| {
            let mut images: Vec<u32> = phases.iter().map(|&phase| image(phase) % parts).collect();
            images.sort_unstable();
            images == phases
        };
        let turns = (0..parts).filter(|&by| same(&|phase| phase + by)).count() as u32;
        let mirror = (0..parts).find(|&sum| same(&|phase| parts + sum - phase));
        Self { phases, parts, alternating, turns, mirror }
    }

    /// Number of throws.
    #[must_use]
    pub fn throws(&self) -> usize {
        self.phases.len()
    }

    /// Twice the distance of each throw from the middle, in spacings, positive to the front.
    #[must_use]
    pub fn weights(&self) -> Vec<i64> {
        let n = self.throws() as i64;
        (0..n).map(|i| n - 1 - 2 * i).collect()
    }

    /// In how many ways the crank can be turned and still have the same phases.
    #[must_use]
    pub fn turns(&self) -> u32 {
        self.turns
    }

    /// Phases the front throw need take: one for each way that turning the crank does not reach.
    #[must_use]
    pub fn first_phases(&self) -> Vec<u32> {
        let period = self.parts / self.turns();
        let mut first: Vec<u32> = self.phases.iter().map(|phase| phase % period).collect();
        first.sort_unstable();
        first.dedup();
        first.retain(|phase| self.phases.contains(phase));
        first
    }

    /// Sum of a phase and its mirror image, where the crank running backward has the same phases.
    #[must_use]
    pub fn mirror(&self) -> Option<u32> {
        self.mirror
    }

    /// Number of arrangements, turned ones counted apart.
    #[must_use]
    pub fn count(&self) -> u128 {
        let n = self.throws();
        let factorial = |n: usize| (1..=n as u128).product::<u128>();
        if !self.alternating {
            let mut count = factorial(n);
            for group in self.phases.chunk_by(|a, b| a == b) {
                count /= factorial(group.len());
            }
            return count;
        }
        let half = n / 2;
        match n % 4 {
            // One half takes the even phases, the other the odd ones, each phase twice.
            0 => 2 * (factorial(half) >> (half / 2)).pow(2),
            // Each phase has a throw of either half.
            2 => factorial(half).pow(2),
            _ => 2 * factorial(half).pow(2) * n as u128,
        }
    }

    /// Whether an arrangement keeps the alternation rule: in firing order front and rear halves take
    /// turns, and a central throw stands between a rear and a front one.
    #[must_use]
    pub fn alternates(&self, arrangement: &[u32]) -> bool {
        let n = arrangement.len();
        let half = n / 2;
        let is_front = |throw: usize| throw < half;
        if n.is_multiple_of(2) {
            let phases_of = |front: bool| {
                let mut phases: Vec<u32> =
                    (0..n).filter(|&i| is_front(i) == front).map(|i| arrangement[i]).collect();
                phases.sort_unstable();
                phases
            };
            let (front, rear) = (phases_of(true), phases_of(false));
            if half % 2 == 1 {
                // A phase fires again half a cycle later, when it is the other half's turn.
                return front == rear && front.windows(2).all(|pair| pair[0] != pair[1]);
            }
            let parity = |phases: &[u32], odd: u32| phases.iter().all(|phase| phase % 2 == odd);
            return (parity(&front, 0) && parity(&rear, 1))
                || (parity(&front, 1) && parity(&rear, 0));
        }
        // Phases in firing order are two parts apart; from the central throw on, they alternate.
        let mut by_phase = vec![0; n];
        for (throw, &phase) in arrangement.iter().enumerate() {
            by_phase[phase as usize] = throw;
        }
        let centre = arrangement[half] as usize;
        let fired = |step: usize| by_phase[(centre + 2 * step) % n];
        (1..n - 1).all(|step| is_front(fired(step)) != is_front(fired(step + 1)))
    }
}

fn check_count(throws: usize) -> Result<()> {
    if (2..=MOST_THROWS).contains(&throws) {
        return Ok(());
    }
    let cure =
        format!("a bank has 2 to {MOST_THROWS} throws: give 4 to {} cylinders", 2 * MOST_THROWS);
    Err(Error::value("cylinders", 2 * throws, cure))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(bank: &Bank) -> Vec<Arrangement> {
        fn extend(
            bank: &Bank,
            rest: &mut Vec<u32>,
            so_far: &mut Vec<u32>,
            out: &mut Vec<Arrangement>,
        ) {
            if rest.is_empty() {
                if !bank.alternating || bank.alternates(so_far) {
                    out.push(so_far.clone());
                }
                return;
            }
            for i in 0..rest.len() {
                if i > 0 && rest[i] == rest[i - 1] {
                    continue;
                }
                let phase = rest.remove(i);
                so_far.push(phase);
                extend(bank, rest, so_far, out);
                so_far.pop();
                rest.insert(i, phase);
            }
        }
        let mut out = Vec::new();
        extend(bank, &mut bank.phases.clone(), &mut Vec::new(), &mut out);
        out
    }

    #[test]
    fn counts_are_those_of_enumeration() {
        for throws in 2..=8 {
            for alternating in [false, true] {
                let bank = Bank::even_firing(throws, alternating).unwrap();
                assert_eq!(bank.count(), all(&bank).len() as u128, "{throws} {alternating}");
            }
        }
        // Ito and Hattori: 2·3!·3!·7
        assert_eq!(Bank::even_firing(7, true).unwrap().count(), 504);
    }

    #[test]
    fn a_bank_of_an_inline_six_has_its_phases_twice() {
        let bank = Bank::even_firing(6, false).unwrap();
        assert_eq!((bank.phases.clone(), bank.parts), (vec![0, 0, 1, 1, 2, 2], 3));
        assert_eq!((bank.turns(), bank.first_phases()), (3, vec![0]));
    }
}
