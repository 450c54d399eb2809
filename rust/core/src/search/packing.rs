//! Whole vectors packed side by side into one integer: sums of vectors are sums of integers, and
//! equal where the vectors are.

/// What each vector is packed into, and how many bits that takes.
pub(super) struct Packing {
    pub columns: Vec<u128>,
    pub bits: u32,
    /// Rows that are packed, and where.
    rows: Vec<(usize, u32)>,
}

impl Packing {
    /// Of each vector the rows that tell combinations of the vectors `telling` apart, where no entry
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

/// Rows from which all other rows follow, by elimination over the rationals.
fn independent_rows(columns: &[Vec<i64>]) -> Vec<usize> {
    let mut basis: Vec<(usize, Vec<f64>)> = Vec::new();
    let mut rows = Vec::new();
    for row in 0..columns.first().map_or(0, Vec::len) {
        let mut rest: Vec<f64> = columns.iter().map(|column| column[row] as f64).collect();
        for (pivot, vector) in &basis {
            let factor = rest[*pivot] / vector[*pivot];
            for (term, other) in rest.iter_mut().zip(vector) {
                *term -= factor * other;
            }
        }
        // Entries are small whole numbers: what is left of a dependent row is rounding.
        let largest = (0..rest.len()).max_by(|&a, &b| rest[a].abs().total_cmp(&rest[b].abs()));
        if let Some(pivot) = largest
            && rest[pivot].abs() > 1e-6
        {
            basis.push((pivot, rest));
            rows.push(row);
        }
    }
    rows
}
