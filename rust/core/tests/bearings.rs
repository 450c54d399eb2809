//! Loads of bearings and walls with a gas force: they shake the engine as without it, and turn it by
//! the work that the gas does.

mod common;

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use common::{angle, mixed, weighted};
use crankpin_core::bearing_loads::{Bearing, BearingLoadsModel, CutPart, TurningAxes};
use crankpin_core::engine::crankpins::Bay;
use crankpin_core::engine::{CrankIndex, Details, Gas};
use crankpin_core::motion::CrankPosition;
use crankpin_core::pressure::{Cycle, Given};
use crankpin_core::waveform::exact;
use crankpin_core::{
    Angle, Cancel, Complex64, Cylinder, Engine, Error, Request, Spectrum, Station, Unbalance,
};

const RPM: f64 = 3000.0;
const BORE: f64 = 0.09;
const AREA: f64 = 0.25 * PI * BORE * BORE;

fn engine() -> Engine {
    weighted().with_mains(vec![0.0, 0.13, 0.25, 0.45]).unwrap()
}

/// Pressures on the pistons of an engine, Pa, by degrees after its firing top dead centre.
fn fired(engine: &Engine, crankcase: f64, pressure: impl Fn(f64) -> f64) -> Engine {
    let theta_deg: Vec<f64> = (0..360).map(|k| 2.0 * f64::from(k)).collect();
    let pressure = theta_deg.iter().map(|&theta| pressure(theta)).collect();
    let given = Given { name: String::new(), strokes: 4, theta_deg, pressure, degree: None };
    let count = engine.stations().len();
    let gas = Gas {
        cycles: vec![Arc::new(Cycle::new(given).unwrap())],
        cycle_of: (0..count).map(|i| (i != 2).then_some(0)).collect(),
        crank_ends: Vec::new(),
        crankcase,
        later: vec![false; count],
    };
    let bore = Details { bore: Some(BORE), ..Details::default() };
    engine.with_details(vec![bore; count]).and_then(|engine| engine.with_gas(gas)).unwrap()
}

/// A pressure of every half order.
fn pressure(theta_deg: f64) -> f64 {
    2e5 + 3e6 * (6.0 * (0.5 * theta_deg).to_radians().cos() - 6.0).exp()
        + 1e4 * (1.5 * theta_deg).to_radians().sin()
}

fn angles() -> Vec<f64> {
    (0..600).map(|k| 1.3 * f64::from(k) - 30.0).collect()
}

/// Force, moment about z = 0 and roll torque of a set of loads on the block, at one angle.
fn block(engine: &Engine, thetas: &[f64]) -> Vec<[Complex64; 3]> {
    let model = BearingLoadsModel::new(engine, RPM).unwrap();
    let loads = model.loads(thetas, &Cancel::new()).unwrap();
    let i = Complex64::i();
    let at = |k: usize| {
        let mut sums = [Complex64::default(); 3];
        for (j, &z) in engine.mains().iter().enumerate() {
            let force = Complex64::new(loads.main[[j, k, 0]], loads.main[[j, k, 1]]);
            sums[0] += force;
            sums[1] += i * z * force;
        }
        for (j, place) in engine.stations().iter().enumerate() {
            let force =
                place.bank.cis(1) * Complex64::new(loads.gas[[j, k]], -loads.side_thrust[[j, k]]);
            sums[0] += force;
            sums[1] += i * place.z * force;
            let unit = (angle(thetas[k]) - place.tdc).cis(1);
            let motion = place.cylinder.mechanism().motion(&CrankPosition::new(unit.im, unit.re));
            let height = motion.position * place.cylinder.crank_radius();
            let arm = place.bank.cis(1) * Complex64::new(height, place.cylinder.pin_offset());
            sums[2] += (arm.conj() * force).im;
        }
        sums
    };
    (0..thetas.len()).map(at).collect()
}

#[test]
fn gas_shakes_nothing_and_turns_the_block_against_its_own_crank_torque() {
    let (still, thetas) = (engine(), angles());
    let fired = fired(&still, 1.2e5, pressure);
    let loads =
        BearingLoadsModel::new(&fired, RPM).unwrap().loads(&thetas, &Cancel::new()).unwrap();
    let sums = block(&fired, &thetas).into_iter().zip(block(&still, &thetas));
    for (k, (with_gas, without)) in sums.enumerate() {
        // Roundings of forces of some 10⁵ N.
        assert!((with_gas[0] - without[0]).norm() < 1e-9, "force at {k}");
        assert!((with_gas[1] - without[1]).norm() < 1e-9, "moment at {k}");
        let mut on_crank = 0.0;
        for (j, place) in still.stations().iter().enumerate() {
            let local = angle(thetas[k]) - place.tdc;
            let after = thetas[k] - fired.firing_phase(j).degrees();
            let expected = if j == 2 { 0.0 } else { AREA * (pressure(after) - 1.2e5) };
            // Cubics of steps of 2° of a peak some 30° wide: (2/30)⁴/384 of 2·10⁴ N.
            assert!((loads.gas[[j, k]] - expected).abs() < 0.01, "gas of {j} at {k}");
            let motion = place
                .cylinder
                .mechanism()
                .motion(&CrankPosition::new(local.cis(1).im, local.cis(1).re));
            on_crank -= loads.gas[[j, k]] * place.cylinder.crank_radius() * motion.velocity;
        }
        assert!((with_gas[2].re - without[2].re + on_crank).abs() < 1e-9, "roll torque at {k}");
    }
}

#[test]
fn without_shafts_all_forces_are_those_of_the_waveform() {
    let engine = engine().with_shafts(Vec::new()).unwrap();
    let thetas = angles();
    let request = Request { rpm: RPM, reference_z: Some(0.0), torque: true };
    let shaken = exact(&engine, &request, &thetas, &Cancel::new()).unwrap();
    let roll = shaken.torque.unwrap();
    for (k, sums) in block(&engine, &thetas).iter().enumerate() {
        let expected = [&shaken.force, &shaken.moment];
        for (sum, expected) in sums.iter().zip(expected) {
            let expected = Complex64::new(expected[[k, 0]], expected[[k, 1]]);
            assert!((sum - expected).norm() < 1e-9, "{sum} is not {expected}");
        }
        assert!((sums[2].re - roll[k]).abs() < 1e-9);
    }
}

/// One cylinder with a very long rod: a yoke.
fn yoke() -> Engine {
    let cylinder = Cylinder::new(0.05, 1e9, 0.5, 0.0).unwrap();
    let place =
        Station { cylinder, tdc: angle(0.0), bank: angle(90.0), z: 0.0, rotating_mass: 0.0 };
    Engine::new("", "", vec![place]).unwrap().with_mains(vec![-0.1, 0.1]).unwrap()
}

#[test]
fn gas_keeps_a_rod_in_compression_as_far_as_it_outweighs_inertia() {
    let peak = 0.5 * 0.05 * (RPM * TAU / 60.0).powi(2);
    let tension = |crankcase: f64, pressure: f64| {
        let engine = fired(&yoke(), crankcase, |_| pressure);
        BearingLoadsModel::new(&engine, RPM)
            .unwrap()
            .tension(720, &Cancel::new())
            .unwrap()
            .remove(0)
    };
    // Tension where cos θ > ½.
    let half = tension(1e5, 1e5 + 0.5 * peak / AREA);
    assert_eq!(half.len(), 2);
    for (range, expected) in half.iter().zip([[-60.0, 60.0], [300.0, 420.0]]) {
        assert!((range[0] - expected[0]).abs() < 1e-6 && (range[1] - expected[1]).abs() < 1e-6);
    }
    assert!(tension(1e5, 1e5 + 2.0 * peak / AREA).is_empty());
    assert_eq!(tension(1e5 + 2.0 * peak / AREA, 1e5), [[0.0, 720.0]]);
}

#[test]
fn cancellation_stops_every_reading() {
    let engine = engine();
    let (model, thetas) = (BearingLoadsModel::new(&engine, RPM).unwrap(), angles());
    let cancel = Cancel::new();
    cancel.raise();
    assert_eq!(model.loads(&thetas, &cancel), Err(Error::Cancelled));
    let turned = model.turned(Bearing::Main, TurningAxes::Crank, &thetas, &cancel);
    assert_eq!(turned, Err(Error::Cancelled));
    assert_eq!(
        model.sections(CutPart::Crank(CrankIndex::MAIN), &thetas, &cancel),
        Err(Error::Cancelled)
    );
    assert_eq!(model.tension(720, &cancel), Err(Error::Cancelled));
}

#[test]
fn bearings_are_between_throws_unless_they_are_given() {
    // Cylinders of one bank, or as far apart as a crank radius, are on throws of their own.
    let z = [0.05, 0.1, 0.17, 0.21, 0.29, 0.33, 0.4];
    let throws = [0.05, 0.1, 0.19, 0.31, 0.4];
    let places = |of: &Engine| {
        of.throw_places(CrankIndex::MAIN).iter().map(|place| place.z).collect::<Vec<_>>()
    };
    assert_close(&places(&mixed()), &throws);
    let in_one_bank = |place: &Station| Station { bank: angle(60.0), ..*place };
    let inline = mixed().stations().iter().map(in_one_bank).collect();
    assert_close(&places(&Engine::new("", "", inline).unwrap()), &z);
    let bearings = mixed().bearings(CrankIndex::MAIN);
    assert_close(&bearings, &[0.025, 0.075, 0.145, 0.25, 0.355, 0.445]);
    assert_eq!(mixed().with_mains(bearings.clone()).unwrap().bearings(CrankIndex::MAIN), bearings);
    assert_close(
        &yoke().with_mains(Vec::new()).unwrap().bearings(CrankIndex::MAIN),
        &[-0.05, 0.05],
    );
    for mains in [vec![0.06, 0.5], vec![0.0, 0.35], vec![0.0, z[1], 0.5]] {
        let error = mixed().with_mains(mains).unwrap_err().to_string();
        assert!(error.starts_with("mains = [") && error.contains("the throw of"), "{error}");
    }
}

#[test]
fn bays_are_between_bearings_and_have_what_turns_there() {
    let bays = mixed().bays();
    let cylinders: Vec<usize> = bays.iter().flat_map(|bay| bay.cylinders.clone()).collect();
    assert_eq!(cylinders, [0, 1, 2, 3, 4, 5, 6]);
    assert_close(&bays.iter().map(Bay::z).collect::<Vec<_>>(), &[0.05, 0.1, 0.19, 0.31, 0.4]);
    // A weight at the pin of a cylinder of another bay has the angle of that pin, exactly.
    let weight =
        |pin, z| Unbalance { amount: 0.01, angle: angle(180.0), z, pin, crank: CrankIndex::MAIN };
    let weights = vec![weight(Some(6), 0.16), weight(None, 0.25), weight(None, 0.6)];
    let engine = mixed().with_counterweights(weights).unwrap();
    let alone: Vec<Engine> = bays.iter().map(|bay| engine.of_bay(bay).unwrap()).collect();
    let own: Vec<Vec<Angle>> = alone
        .iter()
        .map(|bay| bay.counterweights().iter().map(|weight| weight.angle).collect())
        .collect();
    let ahead = (engine.pin(6) + angle(180.0)).reduced();
    assert_eq!(own, [vec![], vec![], vec![ahead], vec![angle(180.0)], vec![]]);
    for (bay, alone) in bays.iter().zip(&alone) {
        assert_eq!(alone.reference_z(), Some(bay.z()));
        for (k, &cylinder) in bay.cylinders.iter().enumerate() {
            assert_eq!(alone.stations()[k], engine.stations()[cylinder]);
            assert_eq!(alone.pin(k), engine.pin(cylinder));
        }
    }
}

/// To a few units in the last place.
fn assert_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
}

#[test]
fn an_engine_of_unknown_motion_has_no_loads() {
    let refused = |engine: &Engine| BearingLoadsModel::new(engine, RPM).err().unwrap().to_string();
    let spectrum = Spectrum::new(vec![(1, Complex64::new(1.0, 0.0))]).unwrap();
    assert!(refused(&engine().with_spectrum(spectrum)).starts_with("spectrum = given: "));
}
