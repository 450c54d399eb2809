//! Arrangements of a vee whose banks share their pins: with these held, Z is that of both banks, and
//! first-order moment is all forward at 90°.

use super::images::{Image, Packed};
use super::{Search, Solution};
use crate::engine::Hold;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::memory;

/// Most arrangements that are listed: sorting them takes a tenth of a second.
const MOST_SHARED: usize = 1 << 20;

impl Search {
    /// Arrangements of the pins, turned ones counted apart.
    #[must_use]
    pub fn shared_candidates(&self) -> u128 {
        self.bank().count()
    }

    /// Arrangements of the pins without any first-order moment.
    #[must_use]
    pub fn shared_balanced(&self) -> u128 {
        let turns = u128::from(self.moments.bank.turns);
        let images = self.zero_class().iter().map(|entry| u128::from(entry.image_count()));
        turns * images.sum::<u128>()
    }

    /// Places of the arrangements, turned, reversed and mirrored ones once, ascending by their pins
    /// after the front one.
    pub fn shared(&self, cancel: &Cancel) -> Result<Vec<usize>> {
        let entries = &self.entries.all;
        if entries.len() > MOST_SHARED {
            let hint = format!("at most {MOST_SHARED} are listed: give fewer cylinders");
            return Err(Error::value("arrangements", entries.len(), hint));
        }
        cancel.expect(entries.len());
        let mut keyed = memory::with_capacity(entries.len())?;
        for (place, entry) in entries.iter().enumerate() {
            cancel.step()?;
            keyed.push((self.shared_key(entry.packed), place));
        }
        keyed.sort_unstable();
        memory::collected(keyed.into_iter().map(|(_, place)| place))
    }

    /// Phases after the front one, nine bits each, of the image where they are least: a bank has at
    /// most 360 parts of a turn.
    fn shared_key(&self, packed: Packed) -> u128 {
        let images = &self.moments.images;
        let key = |image: Image| {
            let mut phases = images.phases(packed, image);
            let front = phases.next().unwrap_or(0);
            let after = phases.map(|phase| (phase + images.parts - front) % images.parts);
            after.fold(0, |key, phase| key << 9 | u128::from(phase))
        };
        images.all().map(key).min().unwrap_or(0)
    }

    /// What the arrangement at a place is at 90°; its front pin is at 0.
    #[must_use]
    pub fn shared_solution(&self, place: usize) -> Option<Solution> {
        let key = self.shared_key(self.entries.all.get(place)?.packed);
        let throws = self.bank().throws();
        let phases: Vec<u32> = (0..throws).rev().map(|i| (key >> (9 * i)) as u32 & 0x1ff).collect();
        Some(self.evaluated(Hold::Pins, [phases.clone(), phases], 90.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::balance::Vector;
    use crate::mechanism::cylinder::Cylinder;
    use crate::search::Bank;
    use crate::{Complex64, Orders, Request, Spectrum, balance};

    /// Each arrangement once, and its figures those that the sum of loads has for its engine.
    #[test]
    fn shared_pins_are_all_arrangements_balanced_at_a_right_angle() {
        let one = Complex64::new(1.0, 0.0);
        let spectrum = Spectrum::new(vec![(1, one), (2, one)]).unwrap();
        let rpm = 30.0 / std::f64::consts::PI;
        let request = Request { rpm, reference_z: None, torque: false };
        let orders = Orders::whole(&[1, 2]).unwrap();
        let cylinder = Cylinder::new(1.0, 4.0, 1.0, 0.0).unwrap();
        for throws in 2..=7 {
            let bank = Bank::even_firing(throws, false).unwrap();
            let search = Search::new(bank, Hold::Pins, &Cancel::new()).unwrap();
            let places = search.shared(&Cancel::new()).unwrap();
            assert_eq!(places.len(), search.distinct());
            let (mut last, mut balanced) = (Vec::new(), 0);
            for &place in &places {
                let found = search.shared_solution(place).unwrap();
                assert_eq!((found.bank_angle, found.banks[0][0]), (90.0, 0));
                assert!(last < found.banks[0]);
                last.clone_from(&found.banks[0]);
                let engine = found.engine(cylinder, 1.0).unwrap().with_spectrum(spectrum.clone());
                let summed = balance::balance(&engine, &request, &orders, &Cancel::new()).unwrap();
                let first = summed.planar(Vector::Moment, 0);
                // Sums of 14 terms of at most 3.
                assert!(first.backward().norm() < 1e-13);
                assert!((first.forward.norm() - found.counterweight).abs() < 1e-13);
                for (wanted, phasor) in found.second_order.iter().zip(summed.xy(Vector::Moment, 1))
                {
                    assert!((phasor.norm() - wanted).abs() < 1e-13);
                }
                let images = search.entries.all[place].image_count();
                balanced += if found.counterweight < 1e-13 { images } else { 0 };
            }
            let turns = u64::from(search.bank().turns);
            assert_eq!(u128::from(balanced * turns), search.shared_balanced());
            let cancel = Cancel::new();
            cancel.raise();
            assert!(search.shared(&cancel).is_err());
        }
    }
}
