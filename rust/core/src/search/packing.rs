//! Whole vectors packed side by side into one integer: sums of vectors are sums of integers, and
//! equal where the vectors are.

use crate::numbers::rational::common_divisor;

/// What each vector is packed into, and how many bits that takes.
pub(super) struct Packing {
    pub columns: Vec<u128>,
    pub bits: u32,
    /// Rows that are packed, and where.
    rows: Vec<(usize, u32)>,
}

impl Packing {
    /// Of each vector the rows that distinguish combinations of the vectors `telling`, where no entry
    /// of a combination is larger than `bound` of its row.
    pub(super) fn new(
        vectors: &[Vec<i64>],
        telling: &[Vec<i64>],
        bound: impl Fn(usize) -> i64,
    ) -> Self {
        let (mut rows, mut bits) = (Vec::new(), 0);
        for row in independent_rows(telling) {
            rows.push((row, bits));
            bits += 64 - (2 * bound(row) + 1).leading_zeros();
            if bits > 128 {
                return Self { columns: Vec::new(), bits, rows };
            }
        }
        let mut packing = Self { columns: Vec::new(), bits, rows };
        packing.columns = vectors.iter().map(|vector| packing.pack(vector)).collect();
        packing
    }

    pub(super) fn pack(&self, vector: &[i64]) -> u128 {
        let shifted =
            self.rows.iter().map(|&(row, shift)| (i128::from(vector[row]) as u128) << shift);
        shifted.fold(0, u128::wrapping_add)
    }
}

/// Rows from which all other rows follow, by elimination in whole numbers.
///
/// A row whose elimination overflows counts as independent: it distinguishes no more than the others,
/// and takes bits.
fn independent_rows(columns: &[Vec<i64>]) -> Vec<usize> {
    let mut basis: Vec<(usize, Vec<i128>)> = Vec::new();
    let mut rows = Vec::new();
    for row in 0..columns.first().map_or(0, Vec::len) {
        let entries = columns.iter().map(|column| i128::from(column[row])).collect();
        let eliminated =
            basis.iter().try_fold(entries, |rest, (pivot, vector)| eliminate(rest, *pivot, vector));
        if let Some(rest) = eliminated {
            // Small pivots keep what follows small.
            let least = (0..rest.len()).filter(|&k| rest[k] != 0).min_by_key(|&k| rest[k].abs());
            let Some(pivot) = least else { continue };
            basis.push((pivot, rest));
        }
        rows.push(row);
    }
    rows
}

/// A multiple of a row less a multiple of another one, so that the entry at its pivot is 0, and
/// without a common divisor; None if that overflows.
fn eliminate(mut row: Vec<i128>, pivot: usize, other: &[i128]) -> Option<Vec<i128>> {
    if row[pivot] == 0 {
        return Some(row);
    }
    let divisor = common_divisor(row[pivot], other[pivot]);
    let (times, less) = (other[pivot] / divisor, row[pivot] / divisor);
    let mut content = 0;
    for (entry, &other) in row.iter_mut().zip(other) {
        *entry = entry.checked_mul(times)?.checked_sub(other.checked_mul(less)?)?;
        content = if *entry == 0 { content } else { common_divisor(content, *entry) };
    }
    if content > 1 {
        for entry in &mut row {
            *entry /= content;
        }
    }
    Some(row)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_independent_whatever_the_size_of_their_difference() {
        let large = 1_000_000_000_000;
        assert_eq!(independent_rows(&[vec![large, large + 1, 2 * large], vec![1, 1, 2]]), [0, 1]);
        assert_eq!(independent_rows(&[vec![0, 2, 3], vec![0, 4, 6]]), [1]);
        // What overflows counts as independent.
        assert_eq!(independent_rows(&[vec![i64::MAX, 3, 5], vec![1, i64::MAX, 7]]).len(), 2);
    }
}
