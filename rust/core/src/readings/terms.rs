//! Contributions of each part of an engine to an order: forward, backward, roll and the bound of its rounding.
//!
//! A balance is the sum of these: both superpose the one list of loads, this reading the loads of each
//! part apart.

use std::sync::Arc;

use super::amplitude::SourceAmplitudes;
use super::balance::{Balance, Request, angular_speed};
use crate::engine::{Engine, Origin};
use crate::load::{Load, Scene};
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::limits;
use crate::numbers::order::{self, Order};

/// The terms of an engine at some orders, of each part with what it adds: cylinders, counterweights,
/// shafts, further loads.
///
/// Moments are about the plane of the request, and the roll torque about the point `aside`, x and y from
/// the axis of the main crank, m.
///
/// ```
/// # let four = crankpin_core::engine::file::from_toml(
/// #     "schema = 1
/// #     cylinder = { crank_radius = 0.043, rod_length = 0.145, reciprocating_mass = 0.66 }
/// #     placements = [
/// #         { tdc_deg = 0, bank_deg = 90, z = 0 }, { tdc_deg = 180, bank_deg = 90, z = 0.1 },
/// #         { tdc_deg = 180, bank_deg = 90, z = 0.2 }, { tdc_deg = 0, bank_deg = 90, z = 0.3 },
/// #     ]",
/// # )?;
/// use crankpin_core::balance::{Request, Vector};
/// use crankpin_core::terms::terms;
/// use crankpin_core::{Cancel, Order};
///
/// let request = Request { rpm: 6000.0, reference_z: None, torque: false };
/// let orders = Order::all_whole(&[1])?;
/// let parts = terms(&four, &request, [0.0; 2], &orders, &Cancel::new())?;
/// let forces: Vec<f64> = parts.iter().map(|(_, part)| part.planar(Vector::Force, 0).peak()).collect();
/// assert_eq!(forces.len(), 4); // of each cylinder, though together they vanish
/// assert!(forces.iter().all(|force| (force - forces[0]).abs() < 1e-9));
/// # Ok::<(), crankpin_core::Error>(())
/// ```
pub fn terms(
    engine: &Engine,
    request: &Request,
    aside: [f64; 2],
    orders: &[Order],
    cancel: &Cancel,
) -> Result<Vec<(Origin, Balance)>> {
    order::check_list(orders)?;
    let [x, y] = aside;
    for (name, place) in [("x", x), ("y", y)] {
        limits::finite(name, place)?;
    }
    let parts = engine.parts();
    let own = |part| engine.position_of(part);
    let sums = sums_by(engine, request, aside, orders, (parts.len(), &own), cancel)?;
    Ok(parts.into_iter().zip(sums).collect())
}

/// The sums of groups of parts: as many as said, of each part by the index of its group.
pub(super) fn sums_by(
    engine: &Engine,
    request: &Request,
    [x, y]: [f64; 2],
    orders: &[Order],
    (groups, group_of): (usize, &dyn Fn(Origin) -> usize),
    cancel: &Cancel,
) -> Result<Vec<Balance>> {
    let omega = angular_speed(request.rpm)?;
    engine.check_speeds(&[request.rpm])?;
    let sums = LoadSums::new(engine, request.reference_z, request.torque, orders, cancel)?;
    let mut own: Vec<Vec<Load>> = vec![Vec::new(); groups]; // bounded: by the parts of an engine
    for load in &sums.loads.list {
        own[group_of(load.place.origin)].push(*load);
    }
    own.iter().map(|own| Ok(sums.of(own, omega, cancel)?.moved([x, y, 0.0]))).collect()
}

/// Sums of some of an engine's loads at some orders.
pub(super) struct LoadSums<'a> {
    pub loads: Arc<Scene>,
    amplitudes: SourceAmplitudes,
    orders: &'a [Order],
    torque: bool,
}

impl<'a> LoadSums<'a> {
    /// Those about a plane; with torques, unless none follow from the engine's spectrum.
    pub(super) fn new(
        engine: &Engine,
        reference_z: Option<f64>,
        torque: bool,
        orders: &'a [Order],
        cancel: &Cancel,
    ) -> Result<Self> {
        let torque = torque && engine.spectrum().is_none();
        let loads = Scene::of(engine, reference_z)?;
        let amplitudes = SourceAmplitudes::new(&loads.sources, torque, orders, cancel)?;
        Ok(Self { loads, amplitudes, orders, torque })
    }

    /// The sum of some loads at an angular speed, rad/s.
    pub(super) fn of(&self, own: &[Load], omega: f64, cancel: &Cancel) -> Result<Balance> {
        let Self { loads, amplitudes, orders, torque } = self;
        let wrenches = amplitudes.wrenches(loads, own, *torque, orders, cancel)?;
        let means = amplitudes.means(loads, own);
        let mut sum = Balance::of(loads, orders.to_vec(), &wrenches, &means, omega)?;
        sum.has_torque = *torque;
        Ok(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Complex64;
    use crate::Spectrum;
    use crate::engine::{ActsOn, Amplitudes, PeriodicLoad};
    use crate::load::tests::engine;
    use crate::readings::balance::{Orders, Vector, balance};
    use crate::readings::quantity::Part;

    /// An engine with parts of every kind, each adds what the engine lacks without it.
    #[test]
    fn parts_are_what_the_balance_lacks_without_them() {
        let load = |x: f64| PeriodicLoad {
            force: Amplitudes(vec![(2, vec![Complex64::new(x, 7.0)])]),
            z: 0.4,
            ..PeriodicLoad::new("pump", ActsOn::Block)
        };
        let loads = vec![load(30.0), load(50.0)];
        let whole = engine().with_loads(loads.clone()).unwrap();
        let request = Request { rpm: 3000.0, reference_z: Some(0.03), torque: true };
        let (orders, aside) = (Order::all_whole(&[1, 2]).unwrap(), [0.2, -0.1]);
        let cancel = Cancel::new();
        let of = |engine: &Engine| {
            let given = Orders::Given(orders.clone());
            balance(engine, &request, &given, &cancel).unwrap().moved([0.2, -0.1, 0.0])
        };
        let parts = terms(&whole, &request, aside, &orders, &cancel).unwrap();
        let origins: Vec<Origin> = parts.iter().map(|(origin, _)| *origin).collect();
        let expected = [
            [Origin::Cylinder(0), Origin::Cylinder(1), Origin::Cylinder(2)].as_slice(),
            &[Origin::Counterweight(0), Origin::Counterweight(1)],
            &[Origin::Shaft(0), Origin::Shaft(1), Origin::Load(0), Origin::Load(1)],
        ];
        assert_eq!(origins, expected.concat());
        let all = of(&whole);
        for (origin, part) in &parts {
            assert!(part.has_torque);
            let without = |k: usize, list: usize| (0..list).filter(move |other| *other != k);
            let rest = match *origin {
                Origin::Cylinder(_) => continue,
                Origin::Counterweight(k) => {
                    let all = whole.counterweights();
                    whole.with_counterweights(without(k, 2).map(|k| all[k]).collect())
                }
                Origin::Shaft(k) => {
                    let all = whole.shafts();
                    whole.with_shafts(without(k, 2).map(|k| all[k].clone()).collect())
                }
                Origin::Load(k) => {
                    whole.with_loads(without(k, 2).map(|k| loads[k].clone()).collect())
                }
            };
            let rest = of(&rest.unwrap());
            let mut size = 0.0;
            for k in 0..2 {
                for vector in [Vector::Force, Vector::Moment] {
                    let [all, rest, part] = [&all, &rest, part].map(|of| of.planar(vector, k));
                    let lacking = all.forward - rest.forward - part.forward;
                    let conjugate = all.backward_conj - rest.backward_conj - part.backward_conj;
                    // Of forces of some kN.
                    assert!(lacking.norm() + conjugate.norm() < 1e-9, "{origin:?}");
                    size += part.peak();
                }
                let [all, rest, part] =
                    [&all, &rest, part].map(|of| of.torque(Part::Whole, k).roll);
                assert!((all - rest - part).norm() < 1e-9, "{origin:?}");
            }
            assert!(size > 1.0, "{origin:?}");
        }
        // With the others the cylinders make up the whole.
        for k in 0..2 {
            let sum: Complex64 =
                parts.iter().map(|(_, part)| part.planar(Vector::Force, k).forward).sum();
            assert!((sum - all.planar(Vector::Force, k).forward).norm() < 1e-9);
            let cylinders = parts[..3].iter().map(|(_, part)| part.planar(Vector::Force, k).peak());
            let sizes: Vec<f64> = cylinders.collect();
            // The second is lighter by what turns with it, and larger by what moves up and down.
            assert!(sizes.iter().all(|size| *size > 1.0) && sizes[0] != sizes[1]);
        }
        for (aside, name) in [([f64::NAN, 0.0], "x = "), ([0.0, f64::INFINITY], "y = ")] {
            let error = terms(&whole, &request, aside, &orders, &cancel).unwrap_err();
            assert!(error.to_string().starts_with(name), "{error}");
        }
        assert!(terms(&whole, &request, aside, &[], &cancel).is_err());
        let quiet = Request { torque: false, ..request };
        let parts = terms(&whole, &quiet, aside, &orders, &cancel).unwrap();
        assert!(parts.iter().all(|(_, part)| !part.has_torque));
        // Of a spectrum of forces no torque is known.
        let spectrum = Spectrum::new([(1, Complex64::from(0.02))]).unwrap();
        let parts = terms(&whole.with_spectrum(spectrum), &request, aside, &orders, &cancel);
        assert!(parts.unwrap().iter().all(|(_, part)| !part.has_torque));
    }
}
