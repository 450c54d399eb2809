use super::*;
use crate::readings::sweep::kernel::tests::numbers;

#[test]
fn rows_combine_functions_of_their_angle_with_constants_of_their_point() {
    let orders = 3;
    for (angles, points) in [(300, 1), (1, 300), (7, 40), (40, 7), (3, 128), (2, 129)] {
        let functions = |order| [0, 1, 2, 3].map(|k| numbers(angles, 7 * order + k)).concat();
        let turning = Turning((0..orders).map(functions).collect());
        let columns = |order| {
            let mut seed = 100 * (order + 1);
            let columns = [(); CONSTANTS].map(|()| {
                seed += 1;
                numbers(points, seed)
            });
            columns.concat()
        };
        let constants = Constants { by_order: (0..orders).map(columns).collect(), points };
        let mut block = Block::new(orders);
        // Also of a first row within an angle, after more rows than there are now.
        for rows in [0..BLOCK, 5..5 + BLOCK, 13..20, angles * points - 1..angles * points] {
            block.evaluate(&turning, &constants, rows.clone());
            for (i, row) in rows.enumerate() {
                for order in 0..orders {
                    let f: [&[f64]; FUNCTIONS] = columns_of(&turning.0[order]);
                    let f = f.map(|f| f[row / points]);
                    let c: [&[f64]; CONSTANTS] = columns_of(&constants.by_order[order]);
                    let c = c.map(|c| c[row % points]);
                    let part = |cos: f64, sin: f64, at: usize| {
                        let complex = |k: usize| Complex64::new(c[k], c[k + 1]);
                        complex(at) * cos + complex(4 + at) * sin + complex(8 + at)
                    };
                    let expected = [part(f[0], f[1], 0), part(f[2], f[3], 2)];
                    let bound = c[CONSTANTS - 1];
                    assert_eq!(block.bound(order, i), bound);
                    assert_eq!(block.turning(order, i), expected.map(|p| snapped(p, bound)));
                    let [x, y] = [expected[0] + expected[1], expected[0] - expected[1]];
                    let xy = [x, -Complex64::i() * y].map(|p| snapped(p, bound));
                    assert_eq!(block.phasors(order, i), xy);
                    assert_eq!(block.by_component(i).map(|all| all[order]), xy);
                }
            }
        }
    }
}

#[test]
fn magnitudes_are_zero_within_their_bound() {
    assert_eq!(magnitude(3.0, -4.0, 24.9), 5.0);
    assert_eq!(magnitude(3.0, -4.0, 25.0), 0.0);
    assert_eq!(magnitude(0.0, 0.0, 0.0), 0.0);
}
