use ndarray::Array2;

use super::*;
use crate::Order;
use crate::engine::{CrankIndex, Shaft, Station, Unbalance};
use crate::numbers::ratio::SpeedRatio;
use crate::quantity::Part;
use crate::{Angle, Cylinder};

const ORDERS: [u32; 4] = [1, 2, 3, 4];
const REQUEST: Request = Request { rpm: 3000.0, reference_z: Some(0.1), torque: true };
const NONE: [Vec<f64>; FIGURES] = [const { Vec::new() }; FIGURES];
/// Cylinders 0 and 1 share a pin.
const PINS: [usize; 4] = [0, 0, 1, 2];

fn angle(degrees: f64) -> Angle {
    Angle::from_degrees(degrees).unwrap()
}

/// Unlike cylinders, one with an offset and one with a rod of inertia; weights, and a shaft.
fn engine() -> Engine {
    let place = |[radius, rod, mass, offset, inertia]: [f64; 5],
                 [tdc, bank]: [f64; 2],
                 z,
                 rotating_mass| {
        let cylinder = Cylinder::new(radius, rod, mass, offset).unwrap();
        let cylinder = cylinder.with_rod_inertia_excess(inertia).unwrap();
        Station { cylinder, tdc: angle(tdc), bank: angle(bank), z, rotating_mass }
    };
    let places = vec![
        place([0.05, 0.16, 0.5, 0.0, 0.0], [0.0, 60.0], 0.0, 0.3),
        place([0.05, 0.15, 0.6, 0.0, -2e-4], [60.0, 120.0], 0.01, 0.0),
        place([0.045, 0.16, 0.4, 0.003, 0.0], [130.0, 60.0], 0.1, 0.5),
        place([0.05, 0.16, 0.5, 0.0, 0.0], [300.0, 120.0], 0.2, 0.4),
    ];
    let weight = |amount, degrees, z, pin| Unbalance {
        amount,
        angle: angle(degrees),
        z,
        pin,
        crank: CrankIndex::MAIN,
    };
    let shaft = Shaft {
        name: String::new(),
        ratio: SpeedRatio::whole(-2),
        axis: [0.1, -0.05],
        unbalances: vec![weight(0.002, 20.0, 0.1, None)],
    };
    Engine::new("", "", places)
        .and_then(|e| {
            e.with_counterweights(vec![
                weight(0.02, 170.0, 0.05, Some(2)),
                weight(0.01, 30.0, 0.0, None),
            ])
        })
        .and_then(|e| e.with_shafts(vec![shaft]))
        .unwrap()
}

fn spreads() -> [Vec<f64>; FIGURES] {
    [
        vec![0.01, 0.02, 0.0, 0.01],
        vec![0.03, 0.01, 0.02, 0.02],
        vec![1e-4, 2e-4, 1e-4],
        vec![0.5, 0.1, 0.3],
        vec![1e-3, 2e-3, 1e-3, 0.0],
        vec![3e-4, 2e-4, 1e-4, 1e-4],
    ]
}

fn made(spreads: &[Vec<f64>; FIGURES], distribution: Distribution) -> Result<Tolerances> {
    let spreads = (spreads, distribution);
    Tolerances::new(
        &engine(),
        &REQUEST,
        &Order::all_whole(&ORDERS)?,
        spreads,
        &PINS,
        &Cancel::new(),
    )
}

/// Deviations between minus and plus each spread, by a low-discrepancy sequence.
fn deviations(spreads: &[Vec<f64>; FIGURES], samples: usize) -> [Vec<f64>; FIGURES] {
    let mut k = 0.0_f64;
    spreads.each_ref().map(|spreads| {
        let rows = (0..samples).flat_map(|_| spreads);
        rows.map(|spread| {
            k += 1.0;
            spread * (2.0 * (k * 0.618_033_988_749_895).fract() - 1.0)
        })
        .collect()
    })
}

fn sample(tolerances: &Tolerances, count: usize, deviations: &[Vec<f64>; FIGURES]) -> Sampled {
    tolerances.sample(count, &deviations.each_ref().map(|d| &d[..]), &Cancel::new()).unwrap()
}

fn nominal(engine: &Engine) -> Balance {
    balance(engine, &REQUEST, &Orders::whole(&ORDERS).unwrap(), &Cancel::new()).unwrap()
}

#[test]
fn without_spreads_a_sample_is_the_balance_bit_for_bit() {
    let zeros = spreads().map(|values| vec![0.0; 2 * values.len()]);
    let known = nominal(&engine());
    for deviations in [NONE, zeros] {
        let found = sample(&made(&NONE, Distribution::Normal).unwrap(), 2, &deviations);
        for (i, row) in found.force.iter().zip(&found.moment).zip(&found.torque).enumerate() {
            let ((force, moment), torque) = row;
            let k = i % ORDERS.len();
            for (found, vector) in [(force, Vector::Force), (moment, Vector::Moment)] {
                let ([x, y], planar) = (known.xy(vector, k), known.planar(vector, k));
                assert_eq!(*found, [x, y, planar.forward, planar.backward()]);
            }
            assert_eq!(*torque, [known.wrenches[k].torque.roll, known.wrenches[k].torque.crank]);
        }
        let [force, moment] =
            [Vector::Force, Vector::Moment].map(|v| known.peak(v, &Cancel::new()).unwrap());
        let [roll, crank] = [false, true]
            .map(|on_crank| known.torque_peak(Part::Whole, on_crank, &Cancel::new()).unwrap());
        let peaks = [force, moment, roll, crank];
        assert_eq!(found.peaks, [peaks; 2]);
    }
}

#[test]
fn a_sample_is_the_balance_of_the_engine_that_was_drawn() {
    {
        let tolerances = made(&spreads(), Distribution::Uniform).unwrap();
        let drawn = deviations(&spreads(), 40);
        let found = sample(&tolerances, 40, &drawn);
        let [masses, rotating, radii, angles, places, rods] =
            drawn.map(|values| Array2::from_shape_vec((40, values.len() / 40), values).unwrap());
        for s in 0..40 {
            let engine = engine();
            let drawn = engine.stations().iter().enumerate().map(|(i, p)| {
                let (c, pin) = (p.cylinder, PINS[i]);
                let cylinder = Cylinder::new(
                    c.crank_radius() + radii[[s, pin]],
                    c.rod_length() + rods[[s, i]],
                    c.reciprocating_mass() + masses[[s, i]],
                    c.pin_offset(),
                );
                Station {
                    cylinder: cylinder
                        .and_then(|made| made.with_rod_inertia_excess(c.rod_inertia_excess()))
                        .unwrap(),
                    tdc: angle(p.tdc.degrees() - angles[[s, pin]]),
                    bank: p.bank,
                    z: p.z + places[[s, i]],
                    rotating_mass: p.rotating_mass + rotating[[s, i]],
                }
            });
            // A mass below zero is no engine's; its unbalance points the other way.
            let stations: Vec<Station> = drawn.collect();
            let mut weights = engine.counterweights().to_vec();
            weights.extend(stations.iter().enumerate().filter(|(_, p)| p.rotating_mass < 0.0).map(
                |(i, p)| Unbalance {
                    crank: CrankIndex::MAIN,
                    amount: -p.rotating_mass * p.cylinder.crank_radius(),
                    angle: Angle::HALF_TURN,
                    z: p.z,
                    pin: Some(i),
                },
            ));
            let stations = stations
                .into_iter()
                .map(|p| Station { rotating_mass: p.rotating_mass.max(0.0), ..p });
            let drawn = Engine::new("", "", stations.collect())
                .and_then(|made| made.with_counterweights(weights))
                .and_then(|made| made.with_shafts(engine.shafts().to_vec()))
                .unwrap();
            let known = nominal(&drawn);
            for k in 0..ORDERS.len() {
                let row = s * ORDERS.len() + k;
                // Rounding of a sum of twenty terms, and of the deviations added to figures.
                for (found, vector) in
                    [(found.force[row], Vector::Force), (found.moment[row], Vector::Moment)]
                {
                    let planar = known.planar(vector, k);
                    let ([x, y], size) = (known.xy(vector, k), 2.0 * (planar.bound + 1e-23));
                    let there = [x, y, planar.forward, planar.backward()];
                    for (found, known) in found.iter().zip(there) {
                        assert!((found - known).norm() <= size, "{s} {k}: {found} {known}");
                    }
                }
                let torque = known.wrenches[k].torque;
                for (found, known) in found.torque[row].iter().zip([torque.roll, torque.crank]) {
                    let apart = (found - known).norm();
                    assert!(
                        apart <= 2.0 * torque.bounds[0].max(torque.bounds[1]),
                        "{s} {k}: {found} {known}"
                    );
                }
            }
            let [force, moment] =
                [Vector::Force, Vector::Moment].map(|v| known.peak(v, &Cancel::new()).unwrap());
            let [roll, crank] = [false, true]
                .map(|on_crank| known.torque_peak(Part::Whole, on_crank, &Cancel::new()).unwrap());
            let peaks = [force, moment, roll, crank];
            for (found, known) in found.peaks[s].iter().zip(peaks) {
                assert!((found - known).abs() <= 1e-12 * known, "{s}: {found} {known}");
            }
        }
    }
}

#[test]
fn a_sample_is_the_same_whichever_others_are_evaluated_with_it() {
    let tolerances = made(&spreads(), Distribution::Uniform).unwrap();
    let all = deviations(&spreads(), 1000);
    // By the pool; in pieces by the calling thread.
    let whole = sample(&tolerances, 1000, &all);
    let pieces = [0..1, 1..130, 130..400, 400..750, 750..1000].map(|range| {
        let rows = |values: &Vec<f64>| {
            let width = values.len() / 1000;
            values[range.start * width..range.end * width].to_vec()
        };
        sample(&tolerances, range.len(), &all.each_ref().map(rows))
    });
    assert_eq!(whole.force, pieces.each_ref().map(|p| p.force.clone()).concat());
    assert_eq!(whole.moment, pieces.each_ref().map(|p| p.moment.clone()).concat());
    assert_eq!(whole.torque, pieces.each_ref().map(|p| p.torque.clone()).concat());
    assert_eq!(whole.peaks, pieces.each_ref().map(|p| p.peaks.clone()).concat());
}

#[test]
fn a_figure_that_does_not_deviate_may_be_left_out() {
    let tolerances = made(&spreads(), Distribution::Uniform).unwrap();
    let all = deviations(&spreads(), 20);
    for k in 0..FIGURES {
        let (mut alone, mut beside_zeros) = (NONE, all.clone().map(|each| vec![0.0; each.len()]));
        alone[k].clone_from(&all[k]);
        beside_zeros[k].clone_from(&all[k]);
        let [alone, beside_zeros] =
            [alone, beside_zeros].map(|deviations| sample(&tolerances, 20, &deviations));
        assert_eq!(alone, beside_zeros, "{}", Parameter::ALL[k].name());
    }
}

#[test]
fn spreads_that_leave_no_engine_are_rejected() {
    let error = |figure: Parameter, values: Vec<f64>, distribution| {
        let mut spreads = NONE;
        spreads[figure as usize] = values;
        made(&spreads, distribution).err().map(|error| error.to_string()).unwrap_or_default()
    };
    let normal = Distribution::Normal;
    let uniform = Distribution::Uniform;
    let masses = error(Parameter::ReciprocatingMass, vec![0.0, 0.0, 0.4 / 8.0, 0.0], normal);
    assert!(masses.starts_with("reciprocating_mass = 0.05: a draw may take more than"), "{masses}");
    // 0.4 kg over 12.3
    assert!(masses.ends_with("give 3.252e-2 at most"), "{masses}");
    assert_eq!(error(Parameter::ReciprocatingMass, vec![0.0, 0.0, 3.252e-2, 0.0], normal), "");
    assert_eq!(error(Parameter::ReciprocatingMass, vec![0.4; 4], uniform), "");
    // The longest crank on the shortest rod: 0.05 and 0.15 m.
    assert_eq!(error(Parameter::CrankRadius, vec![0.0499, 0.0, 0.0], uniform), "");
    let radii = error(Parameter::CrankRadius, vec![0.0, 0.0, 0.051], uniform);
    assert!(radii.starts_with("crank_radius = 0.051: a draw may keep the crank"), "{radii}");
    let rods = error(Parameter::RodLength, vec![0.0, 0.1, 0.0, 0.0], uniform);
    assert!(
        rods.starts_with("rod_length = 0.1: a draw may keep the crank of cylinder 2"),
        "{rods}"
    );
    // 0.16 m less the offset of 0.003 and the radius of 0.045
    assert_eq!(error(Parameter::RodLength, vec![0.0, 0.0, 0.111, 0.0], uniform), "");
    assert!(error(Parameter::RodLength, vec![0.0, 0.0, 0.113, 0.0], uniform).contains("turning"));
    assert!(error(Parameter::Pin, vec![30.0, 0.0, 0.0], normal).contains("half a turn"));
    assert!(error(Parameter::Pin, vec![1.0; 4], normal).contains("one for each crankpin"));
    assert!(error(Parameter::Z, vec![1.0, 1.0], normal).contains("one for each cylinder"));
    assert!(error(Parameter::Z, vec![1.0, -1.0, 0.0, 0.0], normal).starts_with("z = -1.0:"));
    // Any deviation of a rotating mass is an unbalance.
    assert_eq!(error(Parameter::RotatingMass, vec![9.0; 4], normal), "");
    for pins in [&[0, 0, 1][..], &[0, 0, 2, 2], &[0, 0, 0, 9]] {
        let none = (&NONE, normal);
        let orders = Order::all_whole(&ORDERS).unwrap();
        let made = Tolerances::new(&engine(), &REQUEST, &orders, none, pins, &Cancel::new());
        assert!(made.is_err(), "{pins:?}");
    }
    let none = made(&NONE, normal).unwrap();
    assert!(none.check_size(1000).is_ok() && none.check_size(1 << 40).is_err());
}

#[test]
fn a_request_to_stop_is_met() {
    let cancel = Cancel::new();
    let tolerances = made(&spreads(), Distribution::Normal).unwrap();
    cancel.raise();
    assert_eq!(tolerances.sample(10_000, &[&[]; FIGURES], &cancel), Err(Error::Cancelled));
    let short = [&[0.0; 7][..]; FIGURES];
    let error = tolerances.sample(2, &short, &Cancel::new()).unwrap_err().to_string();
    assert!(error.contains("reciprocating_mass has 7 entries"), "{error}");
}

#[test]
fn sums_of_many_rows_peak_as_each_by_itself() {
    let orders = Order::all_whole(&ORDERS).unwrap();
    let rows: Vec<Complex64> =
        (0..1200).map(|k| Complex64::cis(0.7 * f64::from(k)) / f64::from(1 + k % 7)).collect();
    let found = crate::readings::peaks::largest_sums(&orders, &rows, &[], &Cancel::new()).unwrap();
    let finder = PeakFinder::new(&orders).unwrap();
    for (found, row) in found.iter().zip(rows.chunks(4)) {
        assert_eq!(Ok(*found), finder.along_axis(row, &Cancel::new()));
    }
}
