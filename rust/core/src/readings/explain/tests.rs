//! Sentences of engines whose shaking is known, and what holds of those of any engine.

use super::*;
use crate::engine::layout::{FiringOrder, Inline, Numbering, Side, Spacing, Strokes, Vee};
use crate::engine::{Crank, CrankIndex, Shaft, Station};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::angle::Angle;
use crate::numbers::draws;

fn angle(degrees: f64) -> Angle {
    Angle::from_degrees(degrees).unwrap()
}

fn cylinder(mass: f64) -> Cylinder {
    Cylinder::new(0.043, 0.143, mass, 0.0).unwrap()
}

fn inline(throws: &[f64], mass: f64) -> Engine {
    let throws = throws.iter().map(|&throw| angle(throw)).collect();
    Inline { throws, spacing: Spacing::Even(0.1), rotating_mass: vec![], first_tdc: Angle::ZERO }
        .engine(cylinder(mass))
        .unwrap()
}

fn sentences(engine: Engine, rpm: Option<f64>) -> Vec<String> {
    let engine = Arc::new(engine);
    let found = explain(&engine, rpm, Subject::Everything, &Cancel::new()).unwrap();
    found.sentences(&found.findings, &Wording::of(&engine))
}

#[test]
fn an_inline_four_shakes_at_twice_its_speed() {
    let four = inline(&[0.0, 180.0, 180.0, 0.0], 0.5).firing_as("1-3-4-2", Strokes::Four).unwrap();
    // With λ = 43/143: 4·(λ + λ³/4 + 15·λ⁵/128) = 1.23 and 4·(λ³/4 + 3·λ⁵/16 + 35·λ⁷/256) = 0.0292.
    assert_eq!(
        sentences(four, None),
        [
            "Order 2 leaves a shaking force of 1.23 times one piston's first-order force F, up and \
             down: all four pistons pull together.",
            "Two balance shafts at twice crank speed, one with the crank and one against it, would \
             remove the shaking force of order 2.",
            "Order 4 leaves a shaking force of 2.92 % of F, up and down: all four pistons pull together.",
            "The shaking force of order 1 is exactly zero: opposite pistons cancel in pairs (1 and 2, 3 \
             and 4).",
            "The rocking moments of orders 1, 2 and 4 are exactly zero: front and rear mirror each other \
             (1 and 4, 2 and 3).",
            "All other orders together make at most a shaking force of 0.08 % of F.",
            "The roll torque of the moving parts is largest at order 2, without gas pressure.",
            "It fires evenly, every 180°: 1-3-4-2.",
            "Gas torque begins at order 2: all lower orders cancel exactly.",
        ]
    );
}

#[test]
fn cylinders_that_fire_together_fire_evenly() {
    let said = |throws: &[f64], order: &str, strokes| {
        let engine = inline(throws, 0.5).firing_as(order, strokes).unwrap();
        let said = sentences(engine, None);
        said[said.len() - 2..].join(" ")
    };
    assert_eq!(
        said(&[0.0, 180.0, 180.0, 0.0], "1+4-2+3", Strokes::Two),
        "It fires evenly, two cylinders at a time, every 180°: 1+4-2+3. Gas torque begins at order 2: \
         all lower orders cancel exactly."
    );
    assert_eq!(
        said(&[0.0, 0.0], "1+2", Strokes::Four),
        "Both cylinders fire together, every 720°: 1+2. Gas torque begins at order 0.5."
    );
    let uneven = said(&[0.0, 180.0, 180.0, 0.0], "1+4-2+3", Strokes::Four);
    assert!(uneven.starts_with("It fires unevenly, at intervals of 0-180-0-540°: 1+4-2+3."));
    let sizes = said(&[0.0, 0.0, 180.0], "1+2-3", Strokes::Two);
    assert!(sizes.starts_with("It fires unevenly, at intervals of 0-180-180°: 1+2-3."), "{sizes}");
}

#[test]
fn hardware_is_named_by_what_it_does() {
    let weight = |amount: f64| Unbalance {
        amount,
        angle: angle(180.0),
        z: 0.0,
        pin: Some(0),
        crank: CrankIndex::MAIN,
    };
    let single = inline(&[0.0], 0.5);
    let half = single.with_counterweights(vec![weight(0.5 * 0.5 * 0.043)]).unwrap();
    let texts = sentences(half.clone(), Some(3000.0));
    assert_eq!(
        texts[..3],
        [
            "The counterweight removes all of the shaking force of order 1 that turns with the crank: it \
             changes from 2.12 kN to 1.06 kN.",
            "Order 1 leaves a shaking force of 1.06 kN, constant in size, turning against the crank.",
            "No counterweight reaches the shaking force of order 1: it takes a balance shaft at crank \
             speed, against the crank.",
        ]
    );
    // The shaft takes the rest.
    let unbalances = vec![Unbalance { pin: None, angle: angle(270.0), ..weight(0.25 * 0.043) }];
    let shaft =
        Shaft { name: String::new(), ratio: SpeedRatio::whole(-1), axis: [0.0; 2], unbalances };
    let texts = sentences(half.with_shafts(vec![shaft]).unwrap(), Some(3000.0));
    assert_eq!(
        texts[0],
        "The counterweight and the balance shaft remove the whole shaking force of order 1, 2.12 kN: it is \
         exactly zero."
    );
}

#[test]
fn what_turns_against_a_second_crank_is_removed_on_it() {
    let station = Station {
        cylinder: cylinder(0.5),
        tdc: Angle::ZERO,
        bank: angle(90.0),
        z: 0.0,
        rotating_mass: 0.0,
    };
    let twins = Engine::new("", "", vec![station; 2]).unwrap();
    let cranks = vec![Crank::MAIN, Crank { axis: [0.2, 0.0], ratio: SpeedRatio::whole(-1) }];
    let texts = sentences(twins.with_cranks(cranks, vec![0, 1]).unwrap(), Some(3000.0)).join("\n");
    assert!(
        texts.contains(
            "ounterweights on the cranks could remove all of the shaking force of order 1"
        )
    );
    assert!(texts.contains("what turns with the crank of each piston at order 1"), "{texts}");
}

/// Engines of every kind: a sentence for each finding, the first of them those on force and moment alone.
#[test]
fn every_finding_has_a_sentence() {
    let mut draw = draws(7);
    let mut choose = |count: usize| (f64::midpoint(draw(), 1.0) * count as f64) as usize % count;
    for _ in 0..60 {
        let step = [90.0, 120.0, 60.0, 72.0, 37.3][choose(5)];
        let count = 1 + choose(6);
        let throws: Vec<f64> = (0..count).map(|_| step * choose(8) as f64).collect();
        let engine = if choose(2) == 0 {
            inline(&throws, [0.0, 0.5][choose(2)])
        } else {
            let vee = Vee {
                bank_angle: angle([60.0, 90.0, 180.0][choose(3)]),
                throws: throws.iter().map(|&throw| angle(throw)).collect(),
                spacing: Spacing::Even(0.1),
                pin_split: angle([0.0, -30.0][choose(2)]),
                bank_stagger: 0.02,
                rotating_mass: vec![[0.0, 0.4][choose(2)]],
                numbering: Numbering::Alternating,
                absent: vec![],
                first_bank: Side::Left,
                first_tdc: Angle::ZERO,
            };
            vee.engine(cylinder(0.4)).unwrap()
        };
        let weight = Unbalance {
            amount: 0.01,
            angle: angle(200.0),
            z: 0.1,
            pin: None,
            crank: CrankIndex::MAIN,
        };
        let engine = engine.with_counterweights(vec![weight; choose(3)]).unwrap();
        let engine = Arc::new(engine);
        let rpm = [None, Some(0.0), Some(3000.0)][choose(3)];
        let cancel = Cancel::new();
        let [all, vectors] = [Subject::Everything, Subject::Vectors]
            .map(|subject| explain(&engine, rpm, subject, &cancel).unwrap());
        let texts = all.sentences(&all.findings, &Wording::of(&engine));
        assert_eq!(texts.len(), all.findings.len());
        assert!(vectors.findings == all.findings[..vectors.findings.len()]);
        for (finding, text) in all.findings.iter().zip(&texts) {
            assert!(text.starts_with(char::is_uppercase) && text.ends_with('.'), "{text}");
            assert!(
                !text.contains("  ") && !text.contains("NaN") && !text.contains("inf"),
                "{text}"
            );
            let row = finding.row();
            assert_eq!(row.vector, finding.vector());
            assert!(
                row.groups.iter().flatten().all(|&k| (1..=engine.stations().len()).contains(&k))
            );
            assert!(row.proved || !text.contains("exactly"), "{text}");
            assert!(row.values.iter().all(|value| value.is_finite()), "{row:?}");
        }
    }
}

#[test]
fn an_engine_fires_as_its_gas_does() {
    // Four cylinders whose order leaves open which turn is the first: 1-2 of a twin in one turn.
    let twin = inline(&[0.0, 180.0], 0.5).firing_as("1-2", Strokes::Four).unwrap();
    let ways = Firing::all_named(
        &Arc::new(twin.clone()),
        &"1-2".parse::<FiringOrder>().unwrap(),
        Strokes::Four,
    )
    .unwrap();
    assert_eq!(ways.len(), 2);
    for way in ways {
        let theta_deg: Vec<f64> = (0..12).map(|k| 60.0 * f64::from(k)).collect();
        let given = crate::pressure::Given {
            name: "steps".into(),
            strokes: 4,
            pressure: theta_deg.iter().map(|x| if *x < 180.0 { 2e6 } else { 1e5 }).collect(),
            theta_deg,
            degree: None,
        };
        let bored = crate::engine::Details { bore: Some(0.08), ..Default::default() };
        let cycle = Arc::new(crate::Cycle::new(given).unwrap());
        let fired = twin.with_details(vec![bored; 2]).unwrap();
        let fired = Arc::new(fired.fired_by(cycle, way.fires_in_second_turn()).unwrap());
        let own = Firing::own(&fired, &Cancel::new()).unwrap();
        assert_eq!((own.intervals(), own.later()), (way.intervals(), way.later()));
        let texts = sentences((*fired).clone(), Some(3000.0)).join("\n");
        assert!(texts.contains("Gas pressure (steps) turns the crank with "), "{texts}");
        let intervals: Vec<String> =
            way.intervals().iter().map(|gap| gap.degrees().to_string()).collect();
        assert!(texts.contains(&format!("intervals of {}°", intervals.join("-"))), "{texts}");
    }
}
