//! Whether two families have the same folded angle, exactly.

use super::enumerate::{key, packed};
use super::family::{Families, Family};
use super::images::Image;

/// Combinations of roots of unity that are multiplied out, in memory that is used again.
pub(super) struct Same<'a> {
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

impl<'a> Same<'a> {
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
            let (second, image) = family.second();
            let arrangement = |place: usize| packed(entries.all[place]);
            moments.combination(arrangement(family.first()), Image::ITSELF, &mut of.first);
            moments.combination(arrangement(second), image, &mut of.second);
            moments.ring.times_conjugate(&of.second, &of.first, &mut of.numerator);
        }
        let class = |family: Family| key(entries.all[family.first()]);
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
        // The turn between them is known from the angles; which it is exactly is what is asked.
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
