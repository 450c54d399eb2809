//! Arrangements of the throws of one bank, up to turning the crank.

use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};
use crate::numbers::rational::divisor;

/// Most throws in a bank.
pub const MOST_THROWS: usize = 12;

/// Phases of one bank's throws, and which of their arrangements are candidates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bank {
    /// Phases as multiples of 1/`parts` of a turn, one for each throw, ascending.
    pub phases: Vec<u32>,
    /// Parts of a turn.
    pub parts: u32,
    /// Only arrangements whose front and rear halves take turns to fire.
    pub alternating: bool,
    /// In how many ways the crank can be turned and still have the same phases.
    pub turns: u32,
    /// Sum of a phase and its mirror image, where the crank running backward has the same phases.
    pub mirror: Option<u32>,
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
            let Some((_, denominator)) = phase.reduced().turns() else {
                let hint = "give rational parts of a turn, such as 90 or \"360/7\"";
                return Err(Error::value("phases_deg", phase, hint));
            };
            parts = (parts / divisor(parts, denominator)).saturating_mul(denominator);
            if parts > 360 {
                let hint = "give phases that are multiples of one part of a turn, 1/360 or larger";
                return Err(Error::value("phases_deg", phase, hint));
            }
        }
        let mut multiples: Vec<u32> = phases
            .iter()
            .filter_map(|phase| phase.reduced().turns())
            .map(|(numerator, denominator)| (numerator * (parts / denominator)) as u32)
            .collect();
        multiples.sort_unstable();
        Ok(Self::of(multiples, parts as u32, false))
    }

    /// Ascending phases, and what leaves them as they are: both are read for each arrangement.
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

    /// What front and rear throws may take, in each way that the rule leaves open: any phase; or,
    /// alternating, what makes front and rear halves take turns in firing order, a central throw
    /// between a rear and a front one.
    pub(super) fn pools(&self) -> Vec<Pool> {
        let (n, m) = (self.throws(), self.parts as usize);
        let with = |amount: u8, takes: &dyn Fn(usize) -> bool| -> [u8; 16] {
            std::array::from_fn(|phase| if phase < m && takes(phase) { amount } else { 0 })
        };
        if !self.alternating {
            let mut left = [0; 16];
            for (amount, group) in left.iter_mut().zip(self.phases.chunk_by(|a, b| a == b)) {
                *amount = group.len() as u8;
            }
            return vec![Pool::shared(left)];
        }
        match n % 4 {
            0 => {
                let halves = [with(2, &|phase| phase % 2 == 0), with(2, &|phase| phase % 2 == 1)];
                vec![Pool::apart(halves, None), Pool::apart([halves[1], halves[0]], None)]
            }
            // A phase fires again half a cycle later, when it is the other half's turn.
            2 => vec![Pool::apart([with(1, &|_| true); 2], None)],
            _ => {
                // Phases in firing order are two parts apart; from the central throw on, odd steps
                // are of one half and even ones of the other.
                let both_ways = |centre: usize| {
                    let [odd, even] = [1, 2].map(|first| {
                        let steps = (first..n).step_by(2);
                        with(1, &|phase| steps.clone().any(|step| (centre + 2 * step) % n == phase))
                    });
                    [[odd, even], [even, odd]].map(|halves| Pool::apart(halves, Some(centre)))
                };
                (0..n).flat_map(both_ways).collect()
            }
        }
    }
}

/// Phases that the throws of a bank's halves may still take, by index among the distinct ones.
#[derive(Debug, Clone)]
pub(super) struct Pool {
    /// How many throws each phase takes, front and rear.
    left: [[u8; 16]; 2],
    /// Phases of which `left` is not zero, as bits.
    open: [u16; 2],
    /// Whether the halves take from the same.
    shared: bool,
    centre: Option<usize>,
}

impl Pool {
    fn shared(left: [u8; 16]) -> Self {
        Self { shared: true, ..Self::apart([left, left], None) }
    }

    fn apart(left: [[u8; 16]; 2], centre: Option<usize>) -> Self {
        let open = left.map(|left| {
            (0..16).filter(|&phase| left[phase] > 0).map(|phase| 1 << phase).sum::<u16>()
        });
        Self { left, open, shared: false, centre }
    }

    /// Phases open to the front half (0) or the rear one (1).
    #[inline]
    pub(super) fn open(&self, half: usize) -> Bits {
        Bits(self.open[half])
    }

    /// A throw takes a phase that is open.
    #[inline]
    pub(super) fn take(&mut self, half: usize, phase: usize) {
        let halves = if self.shared { 0..2 } else { half..half + 1 };
        for half in halves {
            self.left[half][phase & 15] -= 1;
            self.open[half] ^= u16::from(self.left[half][phase & 15] == 0) << phase;
        }
    }

    /// What is left for a central throw.
    #[inline]
    pub(super) fn centre(&self) -> usize {
        self.centre.unwrap_or(self.open[0].trailing_zeros() as usize)
    }
}

/// Set bits, ascending.
pub(super) struct Bits(u16);

impl Iterator for Bits {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        let lowest = self.0.trailing_zeros() as usize;
        self.0 &= self.0.wrapping_sub(1);
        (lowest < 16).then_some(lowest)
    }
}

fn check_count(throws: usize) -> Result<()> {
    if (2..=MOST_THROWS).contains(&throws) {
        return Ok(());
    }
    let hint =
        format!("a bank has 2 to {MOST_THROWS} throws: give 4 to {} cylinders", 2 * MOST_THROWS);
    Err(Error::value("cylinders", 2 * throws, hint))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Whether an arrangement keeps the alternation rule: in firing order front and rear halves take
    /// turns, and a central throw stands between a rear and a front one.
    pub(in super::super) fn alternates(arrangement: &[u32]) -> bool {
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

    fn all(bank: &Bank) -> Vec<Arrangement> {
        fn extend(
            bank: &Bank,
            rest: &mut Vec<u32>,
            so_far: &mut Vec<u32>,
            out: &mut Vec<Arrangement>,
        ) {
            if rest.is_empty() {
                if !bank.alternating || alternates(so_far) {
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
        assert_eq!(bank.turns, 3);
        assert_eq!(bank.mirror, Some(0));
        let one_way = [0.0, 30.0, 90.0].map(|d| Angle::from_degrees(d).unwrap());
        assert_eq!(Bank::with_phases(&one_way).unwrap().mirror, None);
    }
}
