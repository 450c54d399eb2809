//! Loads of bearings and walls with a gas force: they shake the engine as without it, and turn it by
//! the work that the gas does.

mod common;

use common::{angle, weighted};
use crankpin_core::internal::{Bearing, GasForce, Internal, Part, TurningAxes};
use crankpin_core::waveform::exact;
use crankpin_core::{Cancel, Complex64, Cylinder, Engine, Error, Placement, Request};

const RPM: f64 = 3000.0;

fn engine() -> Engine {
    weighted().with_mains(vec![0.0, 0.13, 0.25, 0.45]).unwrap()
}

/// A force of its own for each cylinder, of period 720°, positive and negative.
fn gas(cylinder: usize, theta_deg: f64) -> f64 {
    let shift = 40.0 * cylinder as f64;
    4000.0 * (0.5 * (theta_deg - shift)).to_radians().cos() + 1500.0
}

fn angles() -> Vec<f64> {
    (0..600).map(|k| 1.3 * f64::from(k) - 30.0).collect()
}

/// Force, moment about z = 0 and roll torque of a set of loads on the block, at one angle.
fn block(engine: &Engine, gas: Option<&GasForce<'_>>, thetas: &[f64]) -> Vec<[Complex64; 3]> {
    let internal = Internal::new(engine, RPM, gas).unwrap();
    let loads = internal.loads(thetas, &Cancel::new()).unwrap();
    let i = Complex64::i();
    let at = |k: usize| {
        let mut sums = [Complex64::default(); 3];
        for (j, &z) in engine.mains().iter().enumerate() {
            let force = Complex64::new(loads.main[[j, k, 0]], loads.main[[j, k, 1]]);
            sums[0] += force;
            sums[1] += i * z * force;
        }
        for (j, place) in engine.placements().iter().enumerate() {
            let force =
                place.bank.cis(1) * Complex64::new(loads.gas[[j, k]], -loads.side_thrust[[j, k]]);
            sums[0] += force;
            sums[1] += i * place.z * force;
            let unit = (angle(thetas[k]) - place.tdc).cis(1);
            let motion = place.cylinder.proportions().motion(unit.im, unit.re);
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
    let (engine, thetas) = (engine(), angles());
    let (fired, still) = (block(&engine, Some(&gas), &thetas), block(&engine, None, &thetas));
    for (k, (fired, still)) in fired.iter().zip(&still).enumerate() {
        // Roundings of forces of some 10⁵ N.
        assert!((fired[0] - still[0]).norm() < 1e-9, "force at {k}");
        assert!((fired[1] - still[1]).norm() < 1e-9, "moment at {k}");
        let on_crank: f64 = (engine.placements().iter().enumerate())
            .map(|(j, place)| {
                let unit = (angle(thetas[k]) - place.tdc).cis(1);
                let motion = place.cylinder.proportions().motion(unit.im, unit.re);
                -gas(j, thetas[k]) * place.cylinder.crank_radius() * motion.velocity
            })
            .sum();
        assert!((fired[2].re - still[2].re + on_crank).abs() < 1e-9, "roll torque at {k}");
        assert!(on_crank.abs() > 0.1);
    }
}

#[test]
fn without_shafts_all_forces_are_those_of_the_waveform() {
    let engine = engine().with_shafts(Vec::new()).unwrap();
    let thetas = angles();
    let request = Request { rpm: RPM, reference_z: Some(0.0), spectrum: None, torque: true };
    let shaken = exact(&engine, &request, &thetas, &Cancel::new()).unwrap();
    let roll = shaken.torque.unwrap();
    for (k, sums) in block(&engine, Some(&|_, _| 0.0), &thetas).iter().enumerate() {
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
        Placement { cylinder, tdc: angle(0.0), bank: angle(90.0), z: 0.0, rotating_mass: 0.0 };
    Engine::new("", "", vec![place]).unwrap().with_mains(vec![-0.1, 0.1]).unwrap()
}

#[test]
fn gas_keeps_a_rod_in_compression_as_far_as_it_outweighs_inertia() {
    let engine = yoke();
    let peak = 0.5 * 0.05 * (RPM * std::f64::consts::TAU / 60.0).powi(2);
    let half = move |_: usize, _: f64| 0.5 * peak;
    let tension = |gas: &GasForce<'_>| {
        let internal = Internal::new(&engine, RPM, Some(gas)).unwrap();
        internal.tension(720, &Cancel::new()).unwrap().remove(0)
    };
    // Tension where cos θ > ½.
    let found = tension(&half);
    for (range, expected) in found.iter().zip([[-60.0, 60.0], [300.0, 420.0]]) {
        assert!((range[0] - expected[0]).abs() < 1e-6 && (range[1] - expected[1]).abs() < 1e-6);
    }
    assert_eq!(found.len(), 2);
    assert!(tension(&move |_, _| 2.0 * peak).is_empty());
    assert_eq!(tension(&move |_, _| -2.0 * peak), [[0.0, 720.0]]);
    // Within the second turn alone, up to its end.
    let second =
        |_: usize, theta: f64| if theta.rem_euclid(720.0) < 360.0 { 2.0 * peak } else { 0.0 };
    for (range, expected) in tension(&second).iter().zip([[360.0, 450.0], [630.0, 720.0]]) {
        assert!((range[0] - expected[0]).abs() < 1e-6 && (range[1] - expected[1]).abs() < 1e-6);
    }
    assert_eq!(tension(&second).len(), 2);
}

#[test]
fn cancellation_stops_every_reading() {
    let engine = engine();
    let (internal, thetas) = (Internal::new(&engine, RPM, None).unwrap(), angles());
    let cancel = Cancel::new();
    cancel.raise();
    assert_eq!(internal.loads(&thetas, &cancel), Err(Error::Cancelled));
    let turned = internal.turned(Bearing::Main, TurningAxes::Crank, &thetas, &cancel);
    assert_eq!(turned, Err(Error::Cancelled));
    assert_eq!(internal.sections(Part::Crank, &thetas, &cancel), Err(Error::Cancelled));
    assert_eq!(internal.tension(720, &cancel), Err(Error::Cancelled));
}

#[test]
fn an_engine_without_main_bearings_has_no_loads() {
    let engine = engine().with_mains(Vec::new()).unwrap();
    let error = Internal::new(&engine, RPM, None).err().unwrap();
    assert!(error.to_string().starts_with("mains = none: "));
}
