//! The same matching in as few dimensions as its influences span.
//!
//! Sums are taken term by term: a library of linear algebra rounds otherwise on another processor, and another
//! of several equally good matchings would come first.

use super::{Matching, PartKind, length};
use crate::numbers::error::Result;

/// Part of the longest vector below which what axes leave of the others is rounding.
const SPANNED: f64 = 1e-13;

impl Matching {
    /// The same lengths in as few dimensions as the influences span, and one for the rest.
    ///
    /// The first dimension is that of the start where this is longer than what parts add: it sorts the sums
    /// best.
    pub fn reduced(&self) -> Result<Self> {
        let stacked: Vec<Vec<f64>> = self
            .kinds
            .iter()
            .flat_map(|kind| (0..self.places).map(move |place| (kind, place)))
            .flat_map(|(kind, place)| kind.influences.iter().map(move |unit| unit[place].clone()))
            .collect();
        let mut axes = axes_of(&stacked, Vec::new());
        let along = components(&self.start, &axes);
        let figures = self.kinds.iter().flat_map(|kind| &kind.deviations).flatten();
        let largest = figures.fold(0.0, |most: f64, x| most.max(x.abs()));
        let all = stacked.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
        if length(&along) > largest * all {
            axes =
                axes_of(&axes, axes_of(&[combined(&along, &axes, self.start.len())], Vec::new()));
        }
        axes = axes_of(std::slice::from_ref(&self.start), axes);
        if axes.is_empty() {
            axes.push((0..self.start.len()).map(|k| f64::from(u8::from(k == 0))).collect());
        }
        let kinds = self.kinds.iter().map(|kind| {
            let turned = kind.influences.iter().map(|unit| {
                unit.iter().map(|vector| components(vector, &axes)).collect::<Vec<_>>()
            });
            PartKind::new(kind.deviations.clone(), turned.collect())
        });
        let kinds = kinds.collect::<Result<_>>()?;
        Self::new(self.measure, components(&self.start, &axes), kinds, self.sets)
    }
}

/// Components along orthonormal axes.
fn components(vector: &[f64], axes: &[Vec<f64>]) -> Vec<f64> {
    axes.iter().map(|axis| vector.iter().zip(axis).map(|(x, y)| x * y).sum()).collect()
}

/// The vector with these components.
fn combined(parts: &[f64], axes: &[Vec<f64>], dimensions: usize) -> Vec<f64> {
    let sum = |k: usize| parts.iter().zip(axes).map(|(part, axis)| part * axis[k]).sum();
    (0..dimensions).map(sum).collect()
}

/// Orthonormal axes, and more until they span some vectors: the longest rest next.
///
/// By Gram and Schmidt; twice, since what rounding leaves of one projection is not orthogonal.
fn axes_of(vectors: &[Vec<f64>], mut axes: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let dimensions = vectors.first().map_or(0, Vec::len);
    let longest = vectors.iter().map(|vector| length(vector)).fold(0.0, f64::max);
    while axes.len() < dimensions {
        let rest = vectors.iter().map(|vector| {
            let mut rest = vector.clone();
            for _ in 0..2 {
                let spanned = combined(&components(&rest, &axes), &axes, dimensions);
                rest.iter_mut().zip(spanned).for_each(|(x, y)| *x -= y);
            }
            rest
        });
        let longer = |best: Vec<f64>, other: Vec<f64>| {
            if length(&other) > length(&best) { other } else { best }
        };
        let Some(mut next) = rest.reduce(longer) else { break };
        let size = length(&next);
        if size <= SPANNED * longest {
            break;
        }
        for x in &mut next {
            *x /= size;
        }
        axes.push(next);
    }
    axes
}

#[cfg(test)]
mod tests {
    use super::super::tests::problem;
    use crate::numbers::draws;

    #[test]
    fn lengths_are_the_same_in_few_dimensions() {
        let mut number = draws(17);
        for (sizes, parts) in [([1, 3, 8], &[4][..]), ([2, 2, 9], &[5, 4]), ([1, 2, 1], &[2])] {
            for distance in [0.0, 1.0, 1e3] {
                let problem = problem(sizes, parts, distance, &mut number);
                let reduced = problem.reduced().unwrap();
                let figures = sizes[1] * (parts.len() * (parts.len() + 1) / 2);
                assert!(reduced.start.len() <= sizes[2].min(figures + 1));
                let mut chosen: Vec<Vec<usize>> = parts.iter().map(|&n| (0..n).collect()).collect();
                for _ in 0..3 {
                    for list in &mut chosen {
                        list.rotate_left(1);
                    }
                    let [one, other] = [&problem, &reduced].map(|of| of.value(&chosen));
                    assert!((one - other).abs() < 1e-13 * one, "{one} {other}");
                }
            }
        }
    }
}
