//! Engines whose angles are typed as decimals: proofs and closed forms with large denominators.

use std::sync::Arc;
use std::time::Duration;

use crankpin_core::exact::closed_form::closed_form;
use crankpin_core::exact::vanishing::{ProofQuantity, Verdict, vanishing};
use crankpin_core::layout::{Numbering, Side, Spacing, Vee};
use crankpin_core::{Angle, Cancel, Cylinder, Engine, Error, Order, Station};

fn angle(text: &str) -> Angle {
    text.parse().unwrap()
}

fn cylinder() -> Cylinder {
    Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap()
}

/// A vee of three throws, with cylinder 1 at top dead centre at `first_tdc`.
fn v6(bank_angle: Angle, throws: [Angle; 3], pin_split: Angle, first_tdc: Angle) -> Engine {
    let layout = Vee {
        bank_angle,
        throws: throws.to_vec(),
        spacing: Spacing::Even(0.1),
        pin_split,
        bank_stagger: 0.03,
        rotating_mass: vec![0.25],
        numbering: Numbering::Alternating,
        absent: vec![],
        first_bank: Side::Right,
        first_tdc,
    };
    layout.engine(cylinder()).unwrap()
}

#[test]
fn engines_are_equal_whether_angles_are_typed_or_computed() {
    let throws = [Angle::ZERO, angle("120"), angle("240")];
    let vee = v6(angle("49.54"), throws, angle("-10.46"), angle("0.05"));
    // 90° ∓ 24.77°, and cylinder 1 at its top at 0.05°.
    let typed = [65.23, 114.77].map(|bank| Angle::from_degrees(bank).unwrap());
    let shift = angle("0.05");
    for (i, place) in vee.stations().iter().enumerate() {
        let split = if i % 2 == 1 { angle("-10.46") } else { Angle::ZERO };
        assert_eq!(place.bank, typed[i % 2]);
        let turned = place.bank - typed[0] - throws[i / 2] - split + shift;
        assert_eq!(place.tdc.reduced(), turned.reduced());
    }
}

/// Each cylinder's angles end in the sixth decimal: N = 3.6e8, and what takes as many steps is left undecided.
#[test]
fn a_v6_with_six_decimals_is_decided() {
    let throws = ["0.000007", "120.000007", "240.000007"].map(angle);
    let v6 = v6(angle("61.234568"), throws, angle("-1.234567"), angle("17.123456"));
    assert!(v6.stations().iter().any(|p| p.tdc.turns().unwrap().1 >= 360_000_000));
    let orders = Order::all_whole(&[1, 2, 3, 4, 6]).unwrap();
    let found = vanishing(&v6, &orders, None, None, &Cancel::new()).unwrap();
    assert!(found.verdicts.iter().flatten().all(|&v| v != Verdict::Undecided));
    assert!(found.obstacles.is_empty(), "{:?}", found.obstacles);
    // Even spacing in each bank: no force below order 6 but for the third's own absence.
    for of_order in &found.verdicts[..4] {
        assert_eq!((**of_order)[..4], [Verdict::Vanishes; 4]);
    }
    assert_eq!(found.verdicts[4][ProofQuantity::ForceForward], Verdict::Remains);
}

/// N = 37 380 = 4·3·5·7·89: `Φ_N` has thousands of coefficients other than 0.
fn many_parts() -> Engine {
    let parts = [4, 3, 5, 7, 89];
    let place = |(i, &n): (usize, &i64)| Station {
        cylinder: cylinder(),
        tdc: Angle::from_turns(1, n).unwrap(),
        bank: Angle::QUARTER_TURN,
        z: 0.1 * i as f64,
        rotating_mass: 0.0,
    };
    Engine::new("", "", parts.iter().enumerate().map(place).collect()).unwrap()
}

#[test]
fn closed_forms_stop_when_asked() {
    let engine = Arc::new(many_parts());
    let cancel = Arc::new(Cancel::new());
    let (theirs, flag) = (Arc::clone(&engine), Arc::clone(&cancel));
    let worker = std::thread::spawn(move || closed_form(&theirs, Order::FIRST, true, None, &flag));
    std::thread::sleep(Duration::from_millis(20));
    cancel.raise();
    assert_eq!(worker.join().unwrap(), Err(Error::Cancelled));
}
