//! Arrangements that are one another's images: seen from the other end, which changes the sign of Z,
//! and running backward, which conjugates it. One of up to four is enough.

use super::throws::Bank;

/// An arrangement in four bits a throw, as indices into the distinct phases, from bit 4 on. The
/// lowest four bits are free.
pub(super) type Packed = u64;

/// Index of the phase of a throw, counted from 1.
#[inline]
pub(super) fn index(packed: Packed, throw: usize) -> usize {
    (packed >> (4 * throw)) as usize & 15
}

/// How images are made: a table for each phase that the front throw may come to have.
#[derive(Debug)]
pub(super) struct Images {
    throws: usize,
    /// Distinct phases, ascending.
    pub distinct: Vec<u32>,
    /// Index → index, by the index that comes to the front; plain, and mirrored if that is possible.
    tables: Vec<Vec<[u64; 16]>>,
}

impl Images {
    pub(super) fn new(bank: &Bank) -> Self {
        let mut distinct = bank.phases.clone();
        distinct.dedup();
        let parts = bank.parts;
        let period = parts / bank.turns();
        let table = |mirror: Option<u32>| -> Vec<[u64; 16]> {
            let seen = |phase: u32| mirror.map_or(phase, |sum| (parts + sum - phase) % parts);
            let turned_back = |front: u32| {
                // By whole periods, which leave the phases as they are.
                let by = seen(front) - seen(front) % period;
                let mut row = [0; 16];
                for (entry, &phase) in row.iter_mut().zip(&distinct) {
                    let image = (seen(phase) + parts - by) % parts;
                    *entry = distinct.binary_search(&image).unwrap_or(0) as u64;
                }
                row
            };
            distinct.iter().map(|&front| turned_back(front)).collect()
        };
        let mut tables = vec![table(None)];
        tables.extend(bank.mirror().map(|sum| table(Some(sum))));
        Self { throws: bank.throws(), distinct, tables }
    }

    /// The image, turned so that its front throw has one of the bank's first phases.
    #[inline]
    fn image(&self, packed: Packed, reversed: bool, table: &[[u64; 16]]) -> Packed {
        let source = |throw: usize| if reversed { self.throws + 1 - throw } else { throw };
        let row = &table[index(packed, source(1))];
        (1..=self.throws)
            .fold(0, |image, throw| image | row[index(packed, source(throw))] << (4 * throw))
    }

    /// All distinct images, itself first.
    pub(super) fn all(&self, packed: Packed) -> Vec<Packed> {
        let packed = packed & !15;
        let mut images = vec![packed];
        for table in &self.tables {
            for reversed in [false, true] {
                let image = self.image(packed, reversed, table);
                if !images.contains(&image) {
                    images.push(image);
                }
            }
        }
        images
    }

    /// How many images an arrangement has, if it is the first of them.
    #[inline]
    pub(super) fn count_of_first(&self, packed: Packed) -> Option<u64> {
        let mut seen = [packed; 4];
        let mut count = 1;
        for table in &self.tables {
            for reversed in [false, true] {
                let image = self.image(packed, reversed, table);
                if image < packed {
                    return None;
                }
                if !seen[..count].contains(&image) {
                    seen[count] = image;
                    count += 1;
                }
            }
        }
        Some(count as u64)
    }

    /// Phases, front to flywheel.
    pub(super) fn phases(&self, packed: Packed) -> Vec<u32> {
        (1..=self.throws).map(|throw| self.distinct[index(packed, throw)]).collect()
    }
}
