//! Every crank arrangement of a vee, searched for bank angles at which a counterweight removes the
//! whole first-order moment (Ito and Hattori: with every top dead centre held, α = arg(−Z₂/Z₁), which
//! exists where |Z₁| = |Z₂|, Z = Σ s e^{i·phase} over a bank's throws; with the pins held and phase
//! the pin's angle, 2α takes the place of α).
//!
//! n!² pairs are never looked at: |Z|² is a whole number that decides equality exactly, so one bank's
//! arrangements are sorted by it, and each class of k arrangements gives k² pairs.

mod angles;
mod best;
mod enumerate;
mod families;
mod family;
mod images;
mod magnitude;
mod moments;
mod packing;
mod ranges;
mod shared;
mod throws;
mod window;

use std::f64::consts::PI;
use std::sync::OnceLock;

pub use self::angles::Angles;
pub use self::best::Criterion;
use self::best::EqualBanks;
pub use self::enumerate::LARGEST_SEARCH;
use self::enumerate::{Entries, KeyedArrangement, classes};
use self::family::Families;
use self::magnitude::Magnitude;
use self::moments::Moments;
pub use self::throws::{Arrangement, Bank};
use self::window::WindowTarget;
use crate::Complex64;
use crate::engine::{Engine, Hold, Station};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::pool;
use crate::wrench::rounding;

/// All arrangements of one bank, grouped by |Z|.
///
/// ```
/// use crankpin_core::search::{Search, bank};
/// use crankpin_core::{Cancel, Hold};
///
/// let cancel = Cancel::new();
/// let search = Search::new(bank(6, true, None)?, Hold::Firing, &cancel)?;
/// assert!(search.qualifying() <= search.candidates());
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug)]
pub struct Search {
    moments: Moments,
    entries: Entries,
    qualifying: u128,
    balanced: u128,
    hold: Hold,
    equals: OnceLock<EqualBanks>,
}

/// A pair of banks and the angle between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// What the phases are of: top dead centres (at minus them), or pins.
    pub hold: Hold,
    /// |α|, degrees.
    pub bank_angle: f64,
    /// Phases of both banks' throws, the right one first, front to flywheel, in multiples of 1/`parts` of a turn.
    pub banks: [Arrangement; 2],
    /// Parts of a turn.
    pub parts: u32,
    /// Moment that a counterweight on the crank takes away, over m·r·ω²·spacing.
    pub counterweight: f64,
    /// Second-order moments about x and y, over m·r·ω²·spacing·a₂.
    pub second_order: [f64; 2],
}

impl Search {
    /// Group all arrangements of a bank.
    pub fn new(bank: Bank, hold: Hold, cancel: &Cancel) -> Result<Self> {
        let moments = Moments::new(bank)?;
        let magnitude = Magnitude::new(&moments.bank, &moments.ring)?;
        let entries = Entries::new(&moments.bank, &magnitude, &moments.images, cancel)?;
        let turns = u128::from(moments.bank.turns);
        let pairs = |class: &[KeyedArrangement]| {
            let images: u64 = class.iter().map(|entry| entry.image_count()).sum();
            (u128::from(images) * turns).pow(2)
        };
        let qualifying = pool::map(cancel, entries.ranges(), |(_, range)| {
            Ok(classes(range).map(pairs).sum::<u128>())
        })?
        .into_iter()
        .sum::<u128>();
        let mut search =
            Self { moments, entries, qualifying, balanced: 0, hold, equals: OnceLock::new() };
        search.balanced = pairs(search.zero_class());
        Ok(search)
    }

    /// The arrangements without any first-order moment.
    fn zero_class(&self) -> &[KeyedArrangement] {
        // Rows of a remainder that is zero are zero: the key is 0, and the class is the first.
        let first = classes(&self.entries.all).next();
        first.filter(|class| self.moments.vanishes(class[0].packed)).unwrap_or_default()
    }

    /// One bank's throws.
    #[must_use]
    pub fn bank(&self) -> &Bank {
        &self.moments.bank
    }

    /// Arrangements of one bank, turned, reversed and mirrored ones counted once.
    #[must_use]
    pub fn distinct(&self) -> usize {
        self.entries.all.len()
    }

    /// Pairs of arrangements.
    #[must_use]
    pub fn candidates(&self) -> u128 {
        self.bank().count().pow(2)
    }

    /// Pairs with equal |Z|, a bank with itself included.
    #[must_use]
    pub fn qualifying(&self) -> u128 {
        self.qualifying
    }

    /// Pairs of banks without any first-order moment: qualifying at every bank angle.
    #[must_use]
    pub fn balanced(&self) -> u128 {
        self.balanced
    }

    fn families(&self) -> Families<'_> {
        Families { moments: &self.moments, entries: &self.entries }
    }

    /// Every |α| within a window of [0°, 180°] at which some pair has no backward moment, ascending.
    pub fn angles(&self, window: [f64; 2], cancel: &Cancel) -> Result<Angles> {
        let wanted = WindowTarget::new(window, self.hold, self.moments.turn);
        let families = self.families().all(&wanted, cancel)?;
        Angles::new(self.families(), families, self.hold, window)
    }

    /// The best of the pairs that have the k-th angle.
    pub fn solution(
        &self,
        angles: &Angles,
        k: usize,
        by: Criterion,
        cancel: &Cancel,
    ) -> Result<Option<Solution>> {
        let Some(origin) = angles.get(k) else { return Ok(None) };
        let bank_angle = angles.degrees_at(k);
        let Some(pair) = self.best_pair(angles, origin, bank_angle, by, cancel)? else {
            return Ok(None);
        };
        let mut banks = pair.map(|bank| bank.phases(self.families()));
        let [z1, z2] = banks.each_ref().map(|phases| self.moment(phases, 1));
        let condition = (-z2 / z1).arg();
        let angle = match self.hold {
            Hold::Firing => condition,
            // Of the two halves of an angle the one asked for.
            Hold::Pins if origin.beyond => 0.5 * condition - PI.copysign(condition),
            Hold::Pins => 0.5 * condition,
        };
        // Seen the other way round, the left bank is the first.
        if angle < 0.0 {
            banks.swap(0, 1);
        }
        Ok(Some(self.evaluated(self.hold, banks, bank_angle)))
    }

    /// Z of a bank at an order.
    fn moment(&self, phases: &[u32], order: i64) -> Complex64 {
        let unit = |p: u32| self.moments.part.cis(i64::from(p) * order);
        let weights = self.bank().weights();
        phases.iter().zip(weights).map(|(&p, w)| unit(p) * (0.5 * w as f64)).sum()
    }

    /// A pair of banks at a bank angle that leaves no backward moment.
    fn evaluated(&self, hold: Hold, banks: [Arrangement; 2], bank_angle: f64) -> Solution {
        let parts = self.bank().parts;
        let orders = [1, 2].map(|order| banks.each_ref().map(|phases| self.moment(phases, order)));
        let half = 0.5 * bank_angle.to_radians();
        // Bores at 90° ∓ α/2. With the pins held a cylinder's phase turns with its bore.
        let [[first, second], [z1, z2]] =
            [(1.0, orders[0]), (2.0, orders[1])].map(|(n, [a, b])| {
                let turned = if hold == Hold::Pins { n * half } else { 0.0 };
                [a * Complex64::cis(turned), b * Complex64::cis(-turned)]
            });
        // A bank has half of each weight.
        let weights = self.bank().weights();
        let size: f64 = weights.iter().map(|&w| (w as f64).abs()).sum();
        let left = |moment: f64, order: f64| {
            if moment <= rounding(2 * weights.len(), order) * size { 0.0 } else { moment }
        };
        // F_y with cos α/2, F_x with ± sin α/2.
        let second_order = [(z1 + z2).norm() * half.cos(), (z1 - z2).norm() * half.sin()]
            .map(|moment| left(moment, 2.0));
        // Forward part of what both banks make: (e^{i·bank₁} Z₁ + e^{i·bank₂} Z₂)/2.
        let forward = 0.5 * (Complex64::cis(-half) * first + Complex64::cis(half) * second).norm();
        let counterweight = left(forward, 1.0);
        Solution { hold, bank_angle, banks, parts, counterweight, second_order }
    }
}

impl Solution {
    /// The vee: cylinders numbered along the crank, odd ones in the right bank.
    pub fn engine(&self, cylinder: Cylinder, spacing: f64) -> Result<Engine> {
        let phase = |&p: &u32| Angle::from_turns(p.into(), self.parts.into());
        let bank = |k: usize| self.banks[k].iter().map(phase).collect::<Result<Vec<_>>>();
        vee(self.hold, self.bank_angle, &[bank(0)?, bank(1)?], cylinder, spacing)
    }
}

/// The vee of two banks, the right one first, by the phases of their throws; cylinders are numbered
/// along the crank, odd ones in the right bank. The bank angle is in degrees.
pub fn vee(
    hold: Hold,
    bank_angle: f64,
    banks: &[Vec<Angle>; 2],
    cylinder: Cylinder,
    spacing: f64,
) -> Result<Engine> {
    limits::distance("spacing", spacing)?;
    limits::finite("bank_angle_deg", bank_angle)?;
    let throws = banks[0].len();
    limits::same_length("second_deg", banks[1].len(), "first_deg", throws, "throw")?;
    let half = Angle::from_degrees(bank_angle)?.half();
    let upright = Angle::QUARTER_TURN;
    let stations = (0..2 * throws).map(|i| {
        let (throw, bank) = (i / 2, i % 2);
        let phase = banks[bank][throw];
        let bore = if bank == 0 { upright - half } else { upright + half };
        Station {
            cylinder,
            tdc: match hold {
                Hold::Firing => -phase,
                Hold::Pins => bore - phase,
            },
            bank: bore,
            z: throw as f64 * spacing,
            rotating_mass: 0.0,
        }
    });
    let name = format!("V{} {bank_angle:.2}°", 2 * throws);
    // At 0° the bores have one direction, and the banks are two all the same.
    let banks: Vec<usize> = (0..2 * throws).map(|i| i % 2).collect();
    Engine::in_banks(name, "crankpin's search of arrangements", stations.collect(), &banks)
}

/// The phases a caller gives, or the even-firing ones.
pub fn bank(cylinders: usize, alternating: bool, phases: Option<&[Angle]>) -> Result<Bank> {
    if cylinders % 2 == 1 {
        return Err(Error::value("cylinders", cylinders, "a vee has an even number of cylinders"));
    }
    let Some(phases) = phases else { return Bank::even_firing(cylinders / 2, alternating) };
    limits::same_length("phases_deg", phases.len(), "a bank", cylinders / 2, "throw")?;
    if alternating {
        let hint =
            "the alternation rule is that of the even-firing crank: leave out one of the two";
        return Err(Error::value("alternating", "given with phases_deg", hint));
    }
    Bank::with_phases(phases)
}

#[cfg(test)]
mod tests {
    use super::images::Image;
    use super::*;
    use crate::load::{Scene, Wanted};
    use crate::numbers::order::Order;
    use crate::readings::balance::{Request, Vector, balance};

    fn search(cylinders: usize, alternating: bool, phases: Option<&[f64]>) -> Search {
        let phases: Option<Vec<Angle>> =
            phases.map(|p| p.iter().map(|&d| Angle::from_degrees(d).unwrap()).collect());
        let bank = bank(cylinders, alternating, phases.as_deref()).unwrap();
        Search::new(bank, Hold::Firing, &Cancel::new()).unwrap()
    }

    fn counts(search: &Search) -> (u128, usize) {
        (search.qualifying(), search.angles([0.0, 180.0], &Cancel::new()).unwrap().count())
    }

    #[test]
    fn counts_by_brute_force() {
        assert_eq!(counts(&search(6, false, None)), (36, 4));
        assert_eq!(counts(&search(8, false, Some(&[0.0, 90.0, 180.0, 270.0]))), (192, 7));
        assert_eq!(counts(&search(10, false, None)), (2000, 46));
        let six = search(12, false, Some(&[0.0, 60.0, 120.0, 180.0, 240.0, 300.0]));
        assert_eq!((counts(&six), six.balanced()), ((27_648, 46), 576));
        assert_eq!(counts(&search(14, false, None)), (169_344, 2248));
        assert_eq!(counts(&search(14, true, None)), (12_936, 218));
    }

    /// The search's own sum in integers, tied to the one sum: |2Z| of every arrangement, beside others in
    /// the other bank, and classes of equal keys, which are those of equal moments.
    #[test]
    fn sizes_and_keys_are_those_of_the_sum_of_loads() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let wanted = Wanted { planar: true, roll: false, by_bank: true };
        for (throws, hold) in
            [(3, Hold::Pins), (4, Hold::Firing), (6, Hold::Pins), (7, Hold::Firing)]
        {
            let bank = Bank::even_firing(throws, false).unwrap();
            let search = Search::new(bank, hold, &Cancel::new()).unwrap();
            let (entries, moments) = (&search.entries.all, &search.moments);
            let phases = |k: usize| {
                let phases = moments.images.phases(entries[k].packed, Image::ITSELF);
                let angle = |p: u32| Angle::from_turns(p.into(), moments.bank.parts.into());
                phases.map(|p| angle(p).unwrap()).collect::<Vec<_>>()
            };
            let size = |k: usize| {
                let banks = [phases(k), phases((7 * k + 3) % entries.len())];
                let engine = vee(hold, 70.0, &banks, cylinder, 0.1).unwrap();
                let loads = Scene::anew(&engine, engine.middle());
                let terms = loads.sums(&loads.list, Order::FIRST, wanted);
                let right = terms.iter().find(|term| term.bank == Some(engine.bank_of(0))).unwrap();
                // Half of m·r·Z times the spacing turns either way.
                let [forward, backward] = [0, 1].map(|k| right.moment[k].value.norm());
                // Sums of 7 terms of at most 3.
                assert!((forward - backward).abs() < 1e-15);
                4.0 * backward / (cylinder.mass_radius() * 0.1)
            };
            let sizes: Vec<f64> = (0..entries.len()).map(size).collect();
            for (j, (&entry, &size)) in entries.iter().zip(&sizes).enumerate() {
                assert!((moments.twice(entry.packed).norm() - size).abs() < 1e-12, "{throws} {j}");
                for (&other, &others) in entries.iter().zip(&sizes).take(j) {
                    assert_eq!(entry.key == other.key, (size - others).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn every_solution_leaves_no_backward_moment() {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let search = search(14, true, None);
        let angles = search.angles([0.0, 180.0], &Cancel::new()).unwrap();
        for (k, degrees) in angles.degrees(&Cancel::new()).unwrap().into_iter().enumerate() {
            let solution = search
                .solution(&angles, k, Criterion::SecondOrder, &Cancel::new())
                .unwrap()
                .unwrap();
            assert_eq!(solution.bank_angle, degrees);
            let engine = solution.engine(cylinder, 0.1).unwrap();
            let request = Request { rpm: 3000.0, reference_z: None, torque: false };
            let orders = crate::Orders::whole(&[1, 2]).unwrap();
            let found = balance(&engine, &request, &orders, &Cancel::new()).unwrap();
            assert_eq!(found.planar(Vector::Moment, 0).backward(), Complex64::default());
        }
    }
}
