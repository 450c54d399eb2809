//! A family of bank angles: one folded angle, and a pair of arrangements that has it; and whether two
//! have the same one, exactly.

use std::f64::consts::{PI, TAU};

use super::enumerate::{Entries, KeyedArrangement, LARGEST_SEARCH};
use super::images::{Image, Packed};
use super::moments::Moments;

/// A folded angle, and the two arrangements that have it; ascending by the angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Family {
    /// Bits of the folded angle: it is not negative.
    bits: u64,
    /// Place of the first bank's arrangement.
    pub first: u32,
    /// Place of the second bank's arrangement, and its image.
    pub second: u32,
    pub image: Image,
    /// Whether |Z| is small.
    pub small: bool,
}

/// Places fit into 32 bits.
const _: () = assert!(LARGEST_SEARCH / size_of::<KeyedArrangement>() as u128 <= 1 << 32);

impl Family {
    pub(super) fn new(folded: f64, [first, second]: [u32; 2], image: Image, small: bool) -> Self {
        Self { bits: folded.to_bits(), first, second, image, small }
    }

    /// In [0, half of the least turn], radians.
    #[inline]
    pub(super) fn folded(self) -> f64 {
        f64::from_bits(self.bits)
    }

    /// Whether its arrangements are one, or one and its reverse: others have the same angle then.
    pub(super) fn is_common(self) -> bool {
        self.first == self.second && !self.image.mirrored
    }

    /// Its arrangements, with the folded angle of another that is the same.
    pub(super) fn at(self, other: Self) -> Self {
        Self { bits: other.bits, ..self }
    }
}

/// All arrangements and what their angles are computed from.
#[derive(Clone, Copy)]
pub(super) struct Families<'a> {
    pub moments: &'a Moments,
    pub entries: &'a Entries,
}

impl Families<'_> {
    pub(super) fn packed(self, place: u32) -> Packed {
        self.entries.all[place as usize].packed
    }

    /// arg(−Z₂/Z₁) of a family, before it is folded.
    pub(super) fn angle(self, family: Family) -> f64 {
        let argument = |place: u32| self.moments.twice(self.packed(place)).arg();
        PI + self.moments.seen(argument(family.second), family.image) - argument(family.first)
    }

    /// The folded angle of a family in steps of a turn over `4·parts`, if it is a whole number of
    /// them; no other angle is a rational part of a turn.
    ///
    /// The angle of w = −Z₂Z̄₁ is one where w/w̄ is a root of unity, which lies in the field of the
    /// `parts`-th roots and is thus one of them or minus one.
    pub(super) fn steps(self, family: Family) -> Option<i64> {
        let moments = self.moments;
        let parts = i64::from(moments.bank.parts);
        let angle = self.angle(family);
        let steps = (angle * (4 * parts) as f64 / TAU).round() as i64;
        // w/w̄ is a turn times steps/(2·parts).
        let (sign, power) = match (steps % 2 == 0, parts % 2 == 0) {
            (true, _) => (1, steps / 2),
            (false, false) => (-1, (steps - parts) / 2),
            (false, true) => return None,
        };
        let [mut first, mut other, mut product] = [const { Vec::new() }; 3];
        moments.combination(self.packed(family.first), Image::ITSELF, &mut first);
        moments.combination(self.packed(family.second), family.image, &mut other);
        moments.ring.times_conjugate(&other, &first, &mut product);
        let mut difference = product.clone();
        for (k, term) in product.iter().enumerate() {
            difference[(power - k as i64).rem_euclid(parts) as usize] -= sign * term;
        }
        let exact = moments.ring.vanishes(&difference, &mut Vec::new());
        let in_a_turn = 4 * parts / i64::from(moments.bank.turns);
        let rest = steps.rem_euclid(in_a_turn);
        exact.then(|| rest.min(in_a_turn - rest))
    }
}

/// Combinations of roots of unity that are multiplied out, in memory that is used again.
pub(super) struct ExactComparison<'a> {
    families: Families<'a>,
    of_a: Quotient,
    of_b: Quotient,
    scaled: [Vec<i64>; 2],
    difference: Vec<i64>,
    remainder: Vec<i64>,
}

/// What −Z₂/Z₁ = −Z₂Z̄₁/|Z₁|² is made of.
#[derive(Default)]
struct Quotient {
    first: Vec<i64>,
    second: Vec<i64>,
    /// Z₂Z̄₁.
    numerator: Vec<i64>,
    /// |Z₁|².
    denominator: Vec<i64>,
}

impl<'a> ExactComparison<'a> {
    pub(super) fn new(families: Families<'a>) -> Self {
        Self {
            families,
            of_a: Quotient::default(),
            of_b: Quotient::default(),
            scaled: [Vec::new(), Vec::new()],
            difference: Vec::new(),
            remainder: Vec::new(),
        }
    }

    /// Whether −Z₂Z̄₁/|Z₁|² is the same up to a turn and conjugation.
    pub(super) fn angle(&mut self, a: Family, b: Family) -> bool {
        let Families { moments, entries } = self.families;
        for (family, of) in [(a, &mut self.of_a), (b, &mut self.of_b)] {
            let packed = [family.first, family.second].map(|place| self.families.packed(place));
            moments.combination(packed[0], Image::ITSELF, &mut of.first);
            moments.combination(packed[1], family.image, &mut of.second);
            moments.ring.times_conjugate(&of.second, &of.first, &mut of.numerator);
        }
        let class = |family: Family| entries.all[family.first as usize].key;
        let (mut x, mut y) = (&self.of_a.numerator, &self.of_b.numerator);
        if class(a) != class(b) {
            // Multiplied out, |Z|² being its own conjugate.
            for of in [&mut self.of_a, &mut self.of_b] {
                moments.ring.times_conjugate(&of.first, &of.first, &mut of.denominator);
            }
            let [of_a, of_b] = &mut self.scaled;
            moments.ring.times_conjugate(&self.of_a.numerator, &self.of_b.denominator, of_a);
            moments.ring.times_conjugate(&self.of_b.numerator, &self.of_a.denominator, of_b);
            (x, y) = (of_a, of_b);
        }
        // The turn between them is known from the angles; its exact value is wanted.
        let (angle_a, angle_b) = (self.families.angle(a), self.families.angle(b));
        let parts = x.len();
        [(false, angle_a - angle_b), (true, angle_a + angle_b)].into_iter().any(|(mirrored, by)| {
            let turned = moments.turns_in(by);
            self.difference.clear();
            self.difference.extend_from_slice(x);
            for (k, term) in y.iter().enumerate() {
                let from = if mirrored { turned + parts - k } else { turned + k };
                self.difference[if from < parts { from } else { from - parts }] -= term;
            }
            moments.ring.vanishes(&self.difference, &mut self.remainder)
        })
    }
}
