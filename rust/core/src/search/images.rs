//! Arrangements that are one another's images: seen from the other end, which changes the sign of Z,
//! and running backward, which conjugates it. One of up to four is enough.

use super::throws::Bank;

/// An arrangement in four bits a throw, as indices into the distinct phases, from bit 4 on. The
/// lowest four bits hold the number of its images.
pub(super) type Packed = u64;

/// Index of the phase of a throw, counted from 0.
#[inline]
pub(super) fn index(packed: Packed, throw: usize) -> usize {
    (packed >> (4 * throw + 4)) as usize & 15
}

/// An image of an arrangement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Image {
    pub mirrored: bool,
    pub reversed: bool,
}

impl Image {
    pub(super) const ITSELF: Self = Self { reversed: false, mirrored: false };

    pub(super) const ALL: [Self; 4] =
        [Self::ITSELF, Self::OTHERS[0], Self::OTHERS[1], Self::OTHERS[2]];

    /// All but the arrangement itself.
    pub(super) const OTHERS: [Self; 3] = [
        Self { reversed: true, mirrored: false },
        Self { reversed: false, mirrored: true },
        Self { reversed: true, mirrored: true },
    ];

    /// The image of this one.
    pub(super) const fn then(self, image: Self) -> Self {
        let Self { reversed, mirrored } = image;
        Self { reversed: self.reversed != reversed, mirrored: self.mirrored != mirrored }
    }

    /// In two bits.
    pub(super) const fn bits(self) -> u32 {
        self.reversed as u32 | (self.mirrored as u32) << 1
    }
}

/// Index of a phase → index of its image's, by the index that comes to the front.
type Tables = Vec<[u8; 16]>;

/// How images are made.
#[derive(Debug)]
pub(super) struct Images {
    pub throws: usize,
    /// Distinct phases, ascending.
    pub distinct: Vec<u32>,
    /// Parts of a turn.
    pub parts: u32,
    /// Sum of a phase and its mirror image, if the bank has a mirror.
    pub mirror: Option<u32>,
    plain: Tables,
    mirrored: Tables,
}

impl Images {
    pub(super) fn new(bank: &Bank) -> Self {
        let mut distinct = bank.phases.clone();
        distinct.dedup();
        let parts = bank.parts;
        let period = parts / bank.turns;
        let table = |mirror: Option<u32>| -> Tables {
            let seen = |phase: u32| mirror.map_or(phase, |sum| (parts + sum - phase) % parts);
            let turned_back = |front: u32| {
                // By whole periods, which leave the phases as they are.
                let by = seen(front) - seen(front) % period;
                let mut row = [0; 16];
                for (entry, &phase) in row.iter_mut().zip(&distinct) {
                    let image = (seen(phase) + parts - by) % parts;
                    *entry = distinct.binary_search(&image).unwrap_or(0) as u8;
                }
                row
            };
            distinct.iter().map(|&front| turned_back(front)).collect()
        };
        let plain = table(None);
        let mirrored = bank.mirror.map(|sum| table(Some(sum))).unwrap_or_default();
        let mirror = bank.mirror;
        Self { throws: bank.throws(), distinct, parts, mirror, plain, mirrored }
    }

    /// Images that the bank has.
    #[inline]
    pub(super) fn all(&self) -> impl Iterator<Item = Image> + Clone {
        let mirrored = self.mirror.is_some();
        Image::ALL.into_iter().filter(move |image| mirrored || !image.mirrored)
    }

    /// What phases become where these come to the front and to the flywheel, turned back so that the
    /// front throw has one of the bank's first phases.
    #[inline]
    pub(super) fn table(&self, image: Image, front: usize, last: usize) -> &[u8; 16] {
        let tables = if image.mirrored { &self.mirrored } else { &self.plain };
        &tables[if image.reversed { last } else { front }]
    }

    /// How many images arrangements have.
    pub(super) fn count(&self) -> u32 {
        if self.mirror.is_some() { 4 } else { 2 }
    }

    /// Phase of an image's throw.
    #[inline]
    pub(super) fn seen(&self, phase: u32, image: Image) -> u32 {
        match self.mirror {
            Some(sum) if image.mirrored => (self.parts + sum - phase) % self.parts,
            _ => phase,
        }
    }

    /// Phases of an image, front to flywheel; not turned back.
    #[inline]
    pub(super) fn phases(&self, packed: Packed, image: Image) -> impl Iterator<Item = u32> {
        (0..self.throws).map(move |i| {
            let throw = if image.reversed { self.throws - 1 - i } else { i };
            self.seen(self.distinct[index(packed, throw)], image)
        })
    }
}
