use super::*;
use crate::readings::sweep::kernel::tests::numbers;

/// Columns of numbers without a pattern.
fn columns<const N: usize>(count: usize, seed: usize) -> Padded<N> {
    let mut columns = Padded::zeros(count).unwrap();
    for (k, column) in columns.each().enumerate() {
        column[..count].copy_from_slice(&numbers(count, seed + k));
    }
    columns
}

#[test]
fn rows_combine_waves_of_their_angle_with_coefficients_of_their_point() {
    let orders = 3;
    for (angles, points) in [(300, 1), (1, 300), (7, 40), (40, 7), (3, 128), (2, 129)] {
        let of_order = vec![[0, 1], [1, 2], [3, 1]];
        let columns_of = (0..4).map(|wave| columns(angles, 7 * wave)).collect();
        let waves = Waves { columns: columns_of, of_order };
        let by_order = (0..orders).map(|order| columns(points, 100 * (order + 1))).collect();
        let coefficients = Coefficients { by_order, points };
        let mut block = Block::new(orders);
        // Also of a first row within an angle, and of rows after the last one.
        for row in [0, 5, 13, (angles * points).saturating_sub(3)] {
            block.evaluate(&waves, &coefficients, row);
            for (i, row) in (row..angles * points).take(ROWS_SIDE_BY_SIDE).enumerate() {
                for order in 0..orders {
                    let wave = |side: usize, column: usize| {
                        let wave = &waves.columns[waves.of_order[order][side]];
                        wave.values[column * wave.length + row / points]
                    };
                    let c = &coefficients.by_order[order];
                    let c = |column: usize| c.values[column * c.length + row % points];
                    let part = |side: usize| {
                        let complex =
                            |k: usize| Complex64::new(c(6 * side + k), c(6 * side + k + 1));
                        complex(0) * wave(side, 0) + complex(2) * wave(side, 1) + complex(4)
                    };
                    let planar = Planar { forward: part(0), backward_conj: part(1), bound: c(12) };
                    assert_eq!(block.planar(order, i), planar);
                    let xy = planar.xy(planar.bound);
                    assert_eq!(block.by_component(i).map(|all| all[order]), xy);
                }
            }
        }
    }
}

#[test]
fn magnitudes_are_zero_within_their_bound() {
    assert_eq!(magnitude(3.0, -4.0, 4.9), 5.0);
    assert_eq!(magnitude(3.0, -4.0, 5.0), 0.0);
    assert_eq!(magnitude(0.0, 0.0, 0.0), 0.0);
}
