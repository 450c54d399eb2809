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
        let alone =
            coefficients(&Proportions::new(ratio, 0.0).unwrap(), &orders, &Cancel::new()).unwrap();
        for ((&value, exact), n) in row.iter().zip(alone).zip(orders) {
            // Ten roundings of numbers near 1, and those of up to 68 terms.
            assert!((value - exact.re).abs() <= 5e-15 * exact.re.abs(), "{ratio} {n}");
        }
    }
    let offsets: Vec<f64> = ratios.iter().map(|ratio| 0.3 * (1.0 / ratio - 1.0)).collect();
    let mut pairs = vec![Complex64::default(); ratios.len() * orders.len()];
    table::write_offset(&ratios, &offsets, &orders, &mut pairs, &Cancel::new()).unwrap();
    for ((row, &ratio), &offset) in pairs.chunks(orders.len()).zip(&ratios).zip(&offsets) {
        assert_eq!(
            row,
            coefficients(&Proportions::new(ratio, offset).unwrap(), &orders, &Cancel::new())
                .unwrap()
        );
    }
    assert!(table::check_size::<f64>(usize::MAX, &orders).is_err());
    assert!(table::centred_table(&[0.3], &[0], &Cancel::new()).is_err());
    assert!(table::centred_table(&[0.3, 1.0], &[2], &Cancel::new()).is_err());
    let raised = Cancel::new();
    raised.raise();
    assert!(table::centred_table(&vec![0.3; 5000], &[2], &raised).is_err());
}

#[test]
fn a_tolerance_leaves_terms_out() {
    let orders = [2, 4, 8, 20, 64];
    let cancel = Cancel::new();
    // Side by side; by itself next to 1, in a plain sum and in one of twice the digits.
    for (from, to) in [(0.2, 0.9), (0.9901, 0.995), (0.9975, 0.9999)] {
        let ratios: Vec<f64> = (0..64).map(|k| from + (to - from) * f64::from(k) / 63.0).collect();
        let exact = table::centred_table(&ratios, &orders, &cancel).unwrap();
        for rtol in [1e-2, 1e-4, 1e-6, 1e-9] {
            for together in [64, 1] {
                let mut within = vec![0.0; ratios.len() * orders.len()];
                for (ratios, rows) in
                    ratios.chunks(together).zip(within.chunks_mut(together * orders.len()))
                {
                    table::write_centred(ratios, &orders, Some(rtol), rows, &cancel).unwrap();
                }
                for (k, n) in orders.into_iter().enumerate() {
                    let values = within.iter().skip(k).step_by(orders.len());
                    let worst = values
                        .zip(exact.column(k))
                        .map(|(value, exact)| (value / exact - 1.0).abs())
                        .fold(0.0, f64::max);
                    // Measured: from 0.16 of the tolerance next to 1, where many terms are of its
                    // size; from 0.0048 where one is a hundredth of that before.
                    let least = if from > 0.99 { 0.1 } else { 0.004 };
                    assert!((least * rtol..=rtol).contains(&worst), "{from} {rtol} {n}: {worst:e}");
                }
            }
        }
    }
}

#[test]
fn long_tables_are_many_short_ones() {
    // More than two chunks, the last one short.
    let count = 5003;
    let ratios: Vec<f64> = (0..count).map(|k| 0.05 + 0.949 * f64::from(k) / 5003.0).collect();
    let offsets: Vec<f64> = ratios.iter().map(|ratio| 0.5 * (1.0 / ratio - 1.0)).collect();
    let orders = [2, 3, 5];
    let cancel = Cancel::new();
    let table = table::centred_table(&ratios, &orders, &cancel).unwrap();
    let mut pairs = vec![Complex64::default(); ratios.len() * orders.len()];
    table::write_offset(&ratios, &offsets, &orders, &mut pairs, &cancel).unwrap();
    // Two tables of three chunks each.
    assert_eq!(cancel.progress(), (6, 6));
    for (k, row) in table.rows().into_iter().enumerate() {
        let alone = table::centred_table(&ratios[k..=k], &orders, &cancel).unwrap();
        assert_eq!(row, alone.row(0));
        let pair = Proportions::new(ratios[k], offsets[k]).unwrap();
        assert_eq!(pairs[3 * k..3 * k + 3], coefficients(&pair, &orders, &Cancel::new()).unwrap());
    }
}

#[test]
fn powers_keep_their_digits() {
    let orders = [2, 4, 16, 18, 40, 200, 1000];
    let ratios: Vec<f64> = (0..2000).map(|k| 0.5 + 0.49 * f64::from(k) / 2000.0).collect();
    let table = table::centred_table(&ratios, &orders, &Cancel::new()).unwrap();
    let mut worst = [0.0_f64; 7];
    for (row, &ratio) in table.rows().into_iter().zip(&ratios) {
        let alone =
            coefficients(&Proportions::new(ratio, 0.0).unwrap(), &orders, &Cancel::new()).unwrap();
        for ((value, exact), worst) in row.iter().zip(alone).zip(&mut worst) {
            if exact.re.abs() > 1e-290 {
                // Below 1e-290 doubles lose digits.
                if exact.re.abs() < 1e-290 {
                    continue;
                }
                *worst = worst.max((value / exact.re - 1.0).abs() / f64::EPSILON);
            }
        }
    }
    // Units in the last place, of each order. Measured: 2, 2, 4, 1.5, 2, 3, 2.5.
    let most = [2.5, 2.5, 4.5, 3.0, 3.0, 4.0, 4.0];
    assert!(worst.iter().zip(most).all(|(worst, most)| *worst <= most), "{worst:?}");
}
