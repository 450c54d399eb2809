//! Force and moment of one order in closed form: whole numbers times cosines of parts of a turn.
//!
//! In units of one cylinder's force m·r·ω²·aₙ (and of the spacing a) a phasor is a sum of roots of
//! unity with rational weights. Its real and imaginary part and the square of its size are sums
//! c₀ + Σ cₖ·2cos(2πk/N) with whole cₖ, unique if k stays below half the degree of `Φ_N`: see
//! [`crate::numbers::ring`]. What radicals these make is left to a computer algebra system.

use num_traits::{CheckedDiv, CheckedMul};

use super::roots::{FormalSum, Share};
use super::{ExactLoads, Levers, too_long, whole};
use crate::Complex64;
use crate::engine::Engine;
use crate::load::{Load, LoadIndex, Scene, Wanted, superpose};
use crate::mechanism::exact::ExactHarmonic;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::List;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::numbers::rational::{Multiples, Ratio, common_measure, nearest};
use crate::numbers::ring::{LARGEST_REDUCED, RootSum};

/// Coefficients of 1, 2cos(2π/N), 2cos(4π/N) …, to be divided by the form's denominator.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Phasor {
    /// Of the real part.
    pub real: Vec<i128>,
    /// Of the imaginary part.
    pub imaginary: Vec<i128>,
    /// Of the size squared, to be divided by the denominator squared.
    pub square: Vec<i128>,
}

/// How the force of a load moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadMotion {
    /// Along its direction.
    Along,
    /// Turning with the crank.
    Forward,
    /// Turning against the crank.
    Backward,
}

/// One load's part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LoadPart {
    /// m·r, or the unbalance times the square of its speed, in units of the unit cylinder's m·r.
    pub weight: Ratio,
    /// z − z₀ in units of the spacing.
    pub lever: Ratio,
    /// How its force moves.
    pub motion: LoadMotion,
    /// Direction, as part of a turn.
    pub direction: (i64, i64),
    /// Crank angle at which the force points there, as part of a turn.
    pub phase: (i64, i64),
}

/// Force or moment of one order.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedForm {
    /// Index of the cylinder whose force is the unit: the first that has reciprocating mass.
    pub unit: usize,
    /// Length of which all distances between cylinders are whole multiples, m; 0 if all stand in
    /// the plane of reference.
    pub spacing: f64,
    /// Whether the harmonic aₙ is zero, and all with it.
    pub no_harmonic: bool,
    /// Load by load: the cylinders, then what rotates at this order.
    pub parts: Vec<LoadPart>,
    /// N.
    pub period: i128,
    /// By which coefficients are divided.
    pub denominator: i128,
    /// Along (about) x, along (about) y, forward, backward; without loads that are given by numbers.
    pub phasors: [Phasor; 4],
    /// Indices of the periodic loads that act at this order besides.
    pub loads: Vec<usize>,
}

fn refused(argument: &str, value: impl std::fmt::Display, hint: &str) -> Error {
    Error::value(argument, value, format!("a closed form needs {hint}"))
}

fn part_of_turn(argument: &str, angle: Angle) -> Result<(i64, i64)> {
    angle.turns().filter(|&(_, parts)| i128::from(parts) <= LARGEST_REDUCED).ok_or_else(|| {
        let hint = format!(
            "parts of a turn of denominator {LARGEST_REDUCED} at most, such as 60 or \"360/7\""
        );
        refused(argument, angle.degrees(), &hint)
    })
}

/// Levers in units of the spacing, and the spacing.
fn levers(
    engine: &Engine,
    loads: &Scene,
    reference: Option<f64>,
    cancel: &Cancel,
) -> Result<(Vec<Ratio>, f64)> {
    let Levers { units, of } = Levers::new(engine, loads, reference, cancel)?;
    let unit = of.iter().flatten().find(|(_, ratio)| *ratio != Ratio::ZERO).map_or(0, |u| u.0);
    let single = |lever: &Vec<(usize, Ratio)>| {
        let others = lever.iter().any(|&(other, ratio)| other != unit && ratio != Ratio::ZERO);
        let own = lever.iter().find(|(other, _)| *other == unit);
        (!others).then(|| own.map_or(Ratio::ZERO, |&(_, ratio)| ratio))
    };
    let Some(levers) = of.iter().map(single).collect::<Option<Vec<Ratio>>>() else {
        let value = format!("{:?}", loads.list.iter().map(|load| load.place.z).collect::<Vec<_>>());
        return Err(refused("z", value, "distances that are rational multiples of each other"));
    };
    let measure = |levers: &[Ratio], from: Ratio| {
        let mut distances = levers.iter().map(|lever| lever - from);
        distances.try_fold(Ratio::ZERO, common_measure).ok_or_else(too_long)
    };
    let mut step = measure(&levers[..engine.stations().len()], levers[0])?;
    if step == Ratio::ZERO {
        step = measure(&levers, Ratio::ZERO)?;
    }
    if step == Ratio::ZERO {
        return Ok((levers, 0.0));
    }
    let sign = Ratio::from(units[unit].signum() as i128);
    let scaled = levers.into_iter().map(|lever| lever.checked_div(&step)?.checked_mul(&sign));
    let scaled: Option<Vec<Ratio>> = scaled.collect();
    Ok((scaled.ok_or_else(too_long)?, units[unit].abs() * nearest(*step.numer(), *step.denom())))
}

/// Weights of the loads of an order, in units of the first cylinder that has mass.
fn weights(loads: &[Load], cancel: &Cancel) -> Result<(usize, Vec<Ratio>)> {
    let figures: Vec<f64> = loads.iter().map(|load| load.weight).collect();
    let Some(unit) = loads.iter().position(|load| !load.is_turning() && load.weight > 0.0) else {
        return Err(refused("reciprocating_mass", 0, "a cylinder that has some"));
    };
    let multiples = Multiples::new(&figures, cancel)?;
    if multiples.units.len() > 1 {
        let value = format!("m·r = {figures:?}");
        let hint = "masses times radius that are rational multiples of each other";
        return Err(refused("cylinders and unbalances", value, hint));
    }
    let one = multiples.of[unit].1;
    let ratio = |&(_, ratio): &(usize, Ratio)| ratio.checked_div(&one).ok_or_else(too_long);
    Ok((unit, multiples.of.iter().map(ratio).collect::<Result<_>>()?))
}

/// Force, or moment about the plane z = `reference_z`, of one order.
pub fn closed_form(
    engine: &Engine,
    order: Order,
    moment: bool,
    reference_z: Option<f64>,
    cancel: &Cancel,
) -> Result<ClosedForm> {
    if order.as_whole().is_none() {
        return Err(refused("order", order, "a whole order: pistons have no others"));
    }
    let (loads, (unit, weights), known) = one_harmonic(engine, order, reference_z, cancel)?;
    let (levers, spacing) = if moment {
        levers(engine, &loads, reference_z, cancel)?
    } else {
        (vec![Ratio::ONE; loads.list.len()], 0.0)
    };
    let product =
        |(weight, lever): (&Ratio, &Ratio)| weight.checked_mul(lever).ok_or_else(too_long);
    let products = weights.iter().zip(&levers).map(product).collect::<Result<Vec<_>>>()?;
    let parts = loads.list.iter().zip(weights).zip(levers);
    let parts = parts.map(|((load, weight), lever)| load_part(load, weight, lever));
    let parts = parts.collect::<Result<_>>()?;
    let no_harmonic = !known.exists();
    let (denominator, [forward, backward_conj]) = sums(&loads, order, &products, moment, cancel)?;
    // x = f + b*, y = −i(f − b*), b* conjugate.
    let x = forward.plus(&backward_conj, 1)?;
    let y = forward.plus(&backward_conj, -1)?.turned(-1, 4);
    let backward = backward_conj.conjugate();
    let phasors = [
        phasor(&x, cancel)?,
        phasor(&y, cancel)?,
        phasor(&forward, cancel)?,
        phasor(&backward, cancel)?,
    ];
    // Real parts come doubled, and forward and backward are halves: a quarter.
    let denominator = denominator.checked_mul(4).ok_or_else(too_long)?;
    let period = forward.period();
    let loads = given_loads(engine, order, moment, reference_z, cancel)?;
    Ok(ClosedForm { unit, spacing, no_harmonic, parts, period, denominator, phasors, loads })
}

/// Loads with forces of an order, where all are rational multiples of one harmonic: with the unit and the
/// multiples, and what is known of the harmonic.
fn one_harmonic(
    engine: &Engine,
    order: Order,
    reference_z: Option<f64>,
    cancel: &Cancel,
) -> Result<(Scene, (usize, Vec<Ratio>), ExactHarmonic)> {
    let ExactLoads { mut loads, motions, .. } = ExactLoads::new(engine, reference_z)?;
    if motions.iter().any(|motion| motion.speed != SpeedRatio::ONE.halves_of_speed()) {
        let hint = "cylinders on cranks as fast as the main one";
        return Err(refused("cranks", "of different speeds", hint));
    }
    let [motion] = &*motions else {
        return Err(refused("cylinders", "of different proportions", "rods and offsets alike"));
    };
    loads.list.retain(|load| load.parts.force.is_some() && load.acts_at(order));
    let multiples = weights(&loads.list, cancel)?;
    if loads.list.len() > engine.stations().len() {
        if order > Order::FIRST {
            let hint =
                "no unbalance at an order above 1, to whose harmonic it has no rational ratio";
            return Err(refused("shafts", format!("of order {order}"), hint));
        }
        if motion.mechanism.exact_force(1).rest.exists() {
            let offset = engine.stations()[0].cylinder.pin_offset();
            let hint = "no rotating mass at order 1, whose phase is another, or no offset";
            return Err(refused("pin_offset", offset, hint));
        }
    }
    let known = motion.mechanism.exact_force(motion.own_order(order));
    Ok((loads, multiples, known))
}

/// A load over the unit, times the square of its speed.
fn load_part(load: &Load, weight: Ratio, lever: Ratio) -> Result<LoadPart> {
    let place = &load.place;
    let motion = match (load.has_part(true), load.has_part(false)) {
        (true, true) => LoadMotion::Along,
        (true, false) => LoadMotion::Forward,
        _ => LoadMotion::Backward,
    };
    let speed = Ratio::new(place.ratio.halves().into(), 2);
    let argument = if motion == LoadMotion::Along { "bank_deg" } else { "angle_deg" };
    Ok(LoadPart {
        weight: weight.checked_mul(&(speed * speed)).ok_or_else(too_long)?,
        lever,
        motion,
        direction: part_of_turn(argument, place.direction)?,
        phase: part_of_turn("tdc_deg", place.phase)?,
    })
}

/// Indices of the periodic loads whose force, or moment about a plane, has an order.
fn given_loads(
    engine: &Engine,
    order: Order,
    moment: bool,
    reference_z: Option<f64>,
    cancel: &Cancel,
) -> Result<Vec<usize>> {
    let loads = Scene::of(engine, reference_z)?;
    let mut found = Vec::new();
    for (index, load) in loads.further() {
        let has_lever = !moment || load.place.z != loads.reference;
        if load.parts.force.is_some() && has_lever && !found.contains(&index) {
            let force = loads.source(load).force(&[order], cancel)?;
            if force.iter().any(|amplitude| *amplitude != Complex64::ZERO) {
                found.push(index);
            }
        }
    }
    Ok(found)
}

/// Twice the forward and twice the conjugate of the backward part, over a denominator; `products` are
/// weights times levers.
fn sums(
    loads: &Scene,
    order: Order,
    products: &[Ratio],
    moment: bool,
    cancel: &Cancel,
) -> Result<(i128, [RootSum; 2])> {
    let (weights, measure) = whole(products)?;
    let weights: List<LoadIndex, i128> = List::new(weights);
    let wanted = Wanted { planar: true, roll: false, by_bank: false };
    let terms = superpose(&FormalSum::new(loads, cancel)?, &loads.list, order, wanted);
    let of = |side: usize| -> Result<Vec<(i128, i128, i128)>> {
        let shares =
            terms.iter().flat_map(|t| if moment { &t.moment[side] } else { &t.force[side] });
        let root = |share: &Share| {
            // What turns here has crank speed: shares are whole halves.
            let factor = i128::from(share.eighths / 4).checked_mul(*measure.numer())?;
            let (numerator, denominator) = share.root.turns.into_raw();
            Some((numerator, denominator, weights[share.load].checked_mul(factor)?))
        };
        shares.map(|share| root(share).ok_or_else(too_long)).collect()
    };
    let (forward, backward) = (of(0)?, of(1)?);
    // A period for both, and with quarters of a turn for i; three at least, so that there is a cosine.
    let one = RootSum::new(&forward, 4)?.period();
    let backward = RootSum::new(&backward, one)?;
    let forward = RootSum::new(&forward, backward.period())?;
    Ok((*measure.denom(), [forward, backward]))
}

fn phasor(sum: &RootSum, cancel: &Cancel) -> Result<Phasor> {
    let square = sum.squared_size()?.twice_real(cancel)?;
    let doubled = |&c: &i128| c.checked_mul(2).ok_or_else(too_long);
    Ok(Phasor {
        real: sum.twice_real(cancel)?,
        // Im z = Re(−iz).
        imaginary: sum.turned(-1, 4).twice_real(cancel)?,
        // Twice |z|², over the square of a denominator that has a 2 for the real parts.
        square: square.iter().map(doubled).collect::<Result<_>>()?,
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::*;
    use crate::engine::{CrankIndex, Shaft, Station, Unbalance};
    use crate::mechanism::cylinder::Cylinder;
    use crate::numbers::ratio::SpeedRatio;
    use crate::readings::balance::{Request, Vector, balance};

    /// Of a whole order.
    fn of_order(
        engine: &Engine,
        order: u32,
        moment: bool,
        reference: Option<f64>,
    ) -> Result<ClosedForm> {
        closed_form(engine, Order::whole(order)?, moment, reference, &Cancel::new())
    }

    fn crossplane() -> Engine {
        let cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.0).unwrap();
        let throws = [(0.0, 0.0), (270.0, 0.13), (90.0, 0.26), (180.0, 0.39)];
        let place = |(tdc, z), bank: f64| Station {
            cylinder,
            tdc: Angle::from_degrees(tdc + bank - 135.0).unwrap(),
            bank: Angle::from_degrees(bank).unwrap(),
            z,
            rotating_mass: 0.0,
        };
        let places = throws.into_iter().flat_map(|t| [place(t, 135.0), place(t, 45.0)]);
        Engine::new("", "", places.collect()).unwrap()
    }

    #[test]
    fn the_couple_of_the_cross_plane_eight_is_root_ten() {
        let form = of_order(&crossplane(), 1, true, None).unwrap();
        assert!((form.spacing - 0.13).abs() < 1e-15);
        assert_eq!(form.parts[0].lever, Ratio::new(-3, 2));
        let square = &form.phasors[2].square;
        let (value, rest) = square.split_first().unwrap();
        assert_eq!(*value, 10 * form.denominator * form.denominator);
        assert!(rest.iter().all(|&c| c == 0));
        assert!(form.phasors[3].square.iter().all(|&c| c == 0));
    }

    #[test]
    fn shafts_turn_with_the_crank_or_against_it() {
        let shaft = |ratio| {
            let unbalance = Unbalance {
                amount: 0.0125,
                angle: Angle::ZERO,
                z: 0.0,
                pin: None,
                crank: CrankIndex::MAIN,
            };
            let ratio = SpeedRatio::whole(ratio);
            Shaft { name: String::new(), ratio, axis: [0.0; 2], unbalances: vec![unbalance] }
        };
        let engine = crossplane().with_shafts(vec![shaft(1), shaft(-1)]).unwrap();
        let form = of_order(&engine, 1, false, None).unwrap();
        let (pistons, shafts) = form.parts.split_at(8);
        assert!(pistons.iter().all(|part| part.motion == LoadMotion::Along));
        let shafts: Vec<_> = shafts.iter().map(|part| (part.motion, part.weight)).collect();
        let half = Ratio::new(1, 2);
        assert_eq!(shafts, [(LoadMotion::Forward, half), (LoadMotion::Backward, half)]);
    }

    /// c₀ + Σ cₖ·2cos(2πk/N).
    fn value(coefficients: &[i128], period: i128) -> f64 {
        let cosine = |k: usize| match k {
            0 => 1.0,
            _ => 2.0 * (std::f64::consts::TAU * k as f64 / period as f64).cos(),
        };
        coefficients.iter().enumerate().map(|(k, &c)| c as f64 * cosine(k)).sum()
    }

    /// A form times its harmonic is the balance at 1 rad/s.
    fn assert_balance(
        form: &ClosedForm,
        engine: &Engine,
        order: u32,
        moment: bool,
        reference: Option<f64>,
    ) {
        let rpm = 60.0 / std::f64::consts::TAU;
        let orders = crate::Orders::whole(&[order]).unwrap();
        let request = Request { rpm, reference_z: reference, torque: false };
        let found = balance(engine, &request, &orders, &Cancel::new()).unwrap();
        let vector = if moment { Vector::Moment } else { Vector::Force };
        let planar = found.planar(vector, 0);
        let [x, y] = found.xy(vector, 0);
        let cylinder = engine.stations()[form.unit].cylinder;
        let harmonic = cylinder.mechanism().force(&[order], &Cancel::new()).unwrap()[0];
        assert_eq!(form.no_harmonic, harmonic.norm() == 0.0);
        let length = if moment { form.spacing } else { 1.0 };
        let unit = harmonic * (cylinder.mass_radius() * length);
        let denominator = form.denominator as f64;
        let expected = [x, y, planar.forward, planar.backward()];
        for (k, (phasor, expected)) in form.phasors.iter().zip(expected).enumerate() {
            let of = |part: &[i128]| value(part, form.period) / denominator;
            // A backward part is the conjugate of what the harmonic multiplies.
            let unit = if k == 3 { unit.conj() } else { unit };
            let sum = crate::Complex64::new(of(&phasor.real), of(&phasor.imaginary)) * unit;
            // Eight cylinders of m·r = 0.025 kg·m and levers of half a metre, or levers of up to ten spacings
            // of 0.0375 kg·m; a size that is zero is the root of what rounding leaves.
            assert!((sum - expected).norm() < 1e-14, "{order} {moment} {k} {sum} {expected}");
            let size = value(&phasor.square, form.period).max(0.0).sqrt() / denominator;
            assert!((size * unit.norm() - expected.norm()).abs() < 1e-9, "{order} {moment} {k}");
        }
    }

    #[test]
    fn closed_forms_are_the_balance() {
        let turning = |engine: &Engine| {
            let with = |(i, p): (usize, &Station)| Station {
                rotating_mass: if i == 1 { 0.75 } else { 0.0 },
                ..*p
            };
            let places = engine.stations().iter().enumerate().map(with).collect();
            Engine::new("", "", places).unwrap()
        };
        let v8 = crossplane();
        let two = Engine::new("", "", v8.stations()[1..3].to_vec()).unwrap();
        let single = Engine::new("", "", v8.stations()[..1].to_vec()).unwrap();
        for engine in [turning(&v8), turning(&two), v8, two, single] {
            for (order, reference) in [(1, None), (2, Some(0.0)), (4, None), (1, Some(0.52))] {
                for moment in [false, true] {
                    let form = of_order(&engine, order, moment, reference).unwrap();
                    assert_balance(&form, &engine, order, moment, reference);
                    assert!(!form.no_harmonic);
                }
            }
            let none = |order| of_order(&engine, order, false, None).unwrap().no_harmonic;
            assert!(none(3) && none(5) && !none(1) && !none(6));
        }
    }

    #[test]
    fn what_has_none_is_refused_with_the_reason() {
        let mut places = crossplane().stations().to_vec();
        places[3].z = 0.13 * 2.0_f64.sqrt();
        let engine = Engine::new("", "", places.clone()).unwrap();
        assert!(of_order(&engine, 1, true, None).unwrap_err().to_string().contains('z'));
        assert!(of_order(&engine, 1, false, None).is_ok());
        places[3].bank = Angle::from_degrees(49.541_234_567_89).unwrap();
        let error = |places: &[Station], order| {
            let engine = Engine::new("", "", places.to_vec()).unwrap();
            of_order(&engine, order, false, None).unwrap_err().to_string()
        };
        let text = error(&places, 1);
        assert!(text.contains("bank_deg = 49.54123456789"), "{text}");
        let mut places = crossplane().stations().to_vec();
        places[2].cylinder = Cylinder::new(0.05, 0.15, 0.5 * 2.0_f64.sqrt(), 0.0).unwrap();
        assert!(error(&places, 2).contains("rational multiples"));
        // With an offset order 1 of the pistons is out of phase with what turns.
        for place in &mut places {
            place.cylinder = Cylinder::new(0.05, 0.15, 0.5, 0.01).unwrap();
        }
        places[2].rotating_mass = 0.25;
        assert!(error(&places, 1).contains("pin_offset = 0.01"));
        let engine = Engine::new("", "", places).unwrap();
        assert!(of_order(&engine, 2, false, None).is_ok());
    }

    #[test]
    fn the_unit_is_the_first_cylinder_with_reciprocating_mass() {
        let mut places = crossplane().stations()[..3].to_vec();
        let massless = Cylinder::new(0.05, 0.15, 0.0, 0.0).unwrap();
        places[0].cylinder = massless;
        let engine = Engine::new("", "", places.clone()).unwrap();
        let form = of_order(&engine, 1, false, None).unwrap();
        assert_eq!(form.unit, 1);
        let weights: Vec<Ratio> = form.parts.iter().map(|part| part.weight).collect();
        assert_eq!(weights, [Ratio::ZERO, Ratio::ONE, Ratio::ONE]);
        for place in &mut places {
            place.cylinder = massless;
        }
        let engine = Engine::new("", "", places).unwrap();
        let error = of_order(&engine, 1, false, None).unwrap_err().to_string();
        assert!(error.contains("reciprocating_mass"), "{error}");
    }

    #[test]
    fn levers_are_multiples_of_the_distances_of_cylinders() {
        let places = crossplane().stations().to_vec();
        let of = |z: &[f64], plane: f64| {
            let with = |(place, z): (&Station, &f64)| Station { z: *z, ..*place };
            let engine = Engine::new("", "", places.iter().zip(z).map(with).collect()).unwrap();
            let form = of_order(&engine, 1, true, Some(plane)).unwrap();
            (form.parts.iter().map(|part| part.lever).collect::<Vec<_>>(), form.spacing)
        };
        // A third of a spacing from the plane: 0.3 m between them.
        let (levers, spacing) = of(&[0.1, 0.4], 0.0);
        assert_eq!(levers, [Ratio::new(1, 3), Ratio::new(4, 3)]);
        assert!((spacing - 0.3).abs() < 1e-15);
        // All in one place, beside a plane that is no decimal.
        let plane = 0.1 * 2.0_f64.sqrt();
        for z in [&[0.1][..], &[0.1; 2]] {
            let (levers, spacing) = of(z, plane);
            assert!(levers.iter().all(|lever| *lever == Ratio::from(-1)), "{levers:?}");
            assert!((spacing - (plane - 0.1)).abs() < 1e-15);
        }
        assert_eq!(of(&[0.1; 2], 0.1), (vec![Ratio::ZERO; 2], 0.0));
    }

    fn engines() -> impl Strategy<Value = Engine> {
        let angle = |angles: Vec<f64>| {
            select(angles).prop_map(|degrees| Angle::from_degrees(degrees).unwrap())
        };
        let unbalance = move || {
            let angle = angle(vec![0.0, 60.0, 270.0]);
            (select(vec![0.0125, 0.02]), angle, select(vec![0.0, 0.1, 0.3])).prop_map(
                |(amount, angle, z)| Unbalance {
                    amount,
                    angle,
                    z,
                    pin: None,
                    crank: CrankIndex::MAIN,
                },
            )
        };
        let place = (
            select(vec![0.5, 0.0, 0.75]),
            angle(vec![0.0, 90.0, 120.0, 240.0]),
            angle(vec![45.0, 90.0, 135.0]),
            select(vec![0.1, 0.2, 0.4]),
            select(vec![0.0, 0.0, 0.25]),
        );
        let places = proptest::collection::vec(place, 1..4);
        let shaft = (select(vec![1, -1, 2]), unbalance()).prop_map(|(ratio, unbalance)| Shaft {
            name: String::new(),
            ratio: SpeedRatio::whole(ratio),
            axis: [0.0; 2],
            unbalances: vec![unbalance],
        });
        let weights = proptest::collection::vec(unbalance(), 0..2);
        let shafts = proptest::collection::vec(shaft, 0..3);
        (places, select(vec![0.0, 0.0, 0.01]), select(vec![0.0, 0.001]), weights, shafts).prop_map(
            |(places, offset, inertia, weights, shafts)| {
                let place = |(mass, tdc, bank, z, rotating_mass)| Station {
                    cylinder: Cylinder::new(0.05, 0.15, mass, offset)
                        .and_then(|cylinder| cylinder.with_rod_inertia_excess(inertia))
                        .unwrap(),
                    tdc,
                    bank,
                    z,
                    rotating_mass,
                };
                let engine = Engine::new("", "", places.into_iter().map(place).collect());
                let engine = engine.and_then(|engine| engine.with_counterweights(weights));
                engine.and_then(|engine| engine.with_shafts(shafts)).unwrap()
            },
        )
    }

    /// What refuses a closed form of such an engine, if anything does.
    fn refusal(engine: &Engine, order: u32) -> Option<&'static str> {
        let masses = engine.stations().iter().map(|place| place.cylinder.reciprocating_mass());
        let turns = |ratio: SpeedRatio| ratio.halves_of_speed() == 2 * order;
        let on_crank = !engine.counterweights().is_empty()
            || engine.stations().iter().any(|place| place.rotating_mass > 0.0);
        let turning =
            order == 1 && on_crank || engine.shafts().iter().any(|shaft| turns(shaft.ratio));
        if masses.sum::<f64>() == 0.0 {
            Some("reciprocating_mass")
        } else if turning && order > 1 {
            Some("shafts")
        } else if turning && engine.stations()[0].cylinder.pin_offset() != 0.0 {
            Some("pin_offset")
        } else {
            None
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]

        #[test]
        fn closed_forms_are_balances_or_refused_with_the_reason(
            engine in engines(),
            order in 1_u32..5,
            moment in any::<bool>(),
            reference in select(vec![None, Some(0.0), Some(0.05)]),
        ) {
            let form = match (of_order(&engine, order, moment, reference), refusal(&engine, order)) {
                (Ok(form), None) => form,
                (Err(error), Some(argument)) => {
                    let text = error.to_string();
                    prop_assert!(text.starts_with(argument), "{text}");
                    return Ok(());
                }
                (found, expected) => {
                    return Err(TestCaseError::fail(format!("{expected:?} {found:?}")));
                }
            };
            assert_balance(&form, &engine, order, moment, reference);
            for (part, load) in form.parts.iter().zip(engine.stations()) {
                let angles = [load.bank, load.tdc].map(|angle| angle.turns().unwrap());
                prop_assert_eq!([part.direction, part.phase], angles);
            }
        }
    }
}
