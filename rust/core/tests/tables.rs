//! Tables of harmonics, many rod ratios side by side, against one slider-crank at a time.

use crankpin_core::harmonics::{coefficients, table};
use crankpin_core::slider_crank::Proportions;
use crankpin_core::{Cancel, Complex64};

#[test]
fn a_table_has_what_one_asks_for_alone() {
    let orders = [1, 2, 3, 4, 6, 8, 16, 17, 18, 40, 200];
    let ratios: Vec<f64> = (1..=199).map(|k| 0.005 * f64::from(k)).collect();
    let table = table::centred_table(&ratios, &orders, &Cancel::new()).unwrap();
    for rtol in [1e-3, 1e-6, 1e-12] {
        let mut within = vec![0.0; ratios.len() * orders.len()];
        let cancel = Cancel::new();
        table::write_centred(&ratios, &orders, Some(rtol), &mut within, &cancel).unwrap();
        for (value, &exact) in within.iter().zip(&table) {
            assert!((value - exact).abs() <= (rtol + 1e-14) * exact.abs());
        }
    }
    for (row, &ratio) in table.rows().into_iter().zip(&ratios) {
        let alone = coefficients(&Proportions::new(ratio, 0.0).unwrap(), &orders);
        for ((&value, exact), n) in row.iter().zip(alone).zip(orders) {
            // Ten roundings of numbers near 1, and those of up to 68 terms.
            assert!((value - exact.re).abs() <= 5e-15 * exact.re.abs(), "{ratio} {n}");
        }
    }
    let offsets: Vec<f64> = ratios.iter().map(|ratio| 0.3 * (1.0 / ratio - 1.0)).collect();
    let mut pairs = vec![Complex64::default(); ratios.len() * orders.len()];
    table::write_offset(&ratios, &offsets, &orders, &mut pairs, &Cancel::new()).unwrap();
    for ((row, &ratio), &offset) in pairs.chunks(orders.len()).zip(&ratios).zip(&offsets) {
        assert_eq!(row, coefficients(&Proportions::new(ratio, offset).unwrap(), &orders));
    }
    assert!(table::check_size::<f64>(usize::MAX, &orders).is_err());
    assert!(table::centred_table(&[0.3], &[0], &Cancel::new()).is_err());
    assert!(table::centred_table(&[0.3, 1.0], &[2], &Cancel::new()).is_err());
    let raised = Cancel::new();
    raised.raise();
    assert!(table::centred_table(&vec![0.3; 5000], &[2], &raised).is_err());
}
