//! The fewest orders that reach a tolerance, and the bound of what they leave out.
//!
//! What is left out is at most the sum of the sizes of its orders, |forward| + |backward| after the
//! layout's cancellations. Orders are worked out as far as what is above them all is negligible, and
//! that rest is bounded in closed form; so the bound is loose only where orders that are left out do
//! not peak together.

use super::fewest::most_left_out;
use super::sums::Sums;
use super::{Balance, Shake};
use crate::cancel::Cancel;
use crate::engine::Engine;
use crate::error::{Error, Result};
use crate::harmonics;
use crate::limits;
use crate::slider_crank::{Cylinder, Proportions};

/// Orders above the last one looked at add less than this part of a sum's largest term: a tenth of
/// what rounding does.
const NEGLIGIBLE: f64 = 1e-17;

/// The fewest orders within `rtol`, the same at every speed.
pub(super) fn within(
    rtol: f64,
    sums: &Sums,
    engine: &Engine,
    omega: f64,
    cancel: &Cancel,
) -> Result<Balance> {
    let candidates = candidates(limits::tolerance(rtol)?, engine, sums)?;
    let last = candidates.last().copied().unwrap_or(1);
    let whole = sums.balance(&candidates, 1.0, cancel)?;
    let tail = if sums.spectrum.is_some() { [0.0; 3] } else { sums.tail(last) };
    let allowed = scales(engine, sums.reference).map(|largest| rtol * largest);
    let share = |sizes: &[f64; 3]| -> Vec<f64> {
        let shares = sizes.iter().zip(&allowed);
        shares.map(|(&size, &allowed)| if size == 0.0 { 0.0 } else { size / allowed }).collect()
    };
    let sizes: Vec<[f64; 3]> = (0..candidates.len()).map(|k| whole.sizes(k)).collect();
    let shares: Vec<Vec<f64>> = sizes.iter().map(share).collect();
    let left_out = most_left_out(&shares, &share(&tail));
    // From the highest order, mostly the smallest, down.
    let bounds: [f64; 3] = std::array::from_fn(|sum| {
        let rest: f64 = left_out.iter().rev().map(|&k| sizes[k][sum]).sum();
        (tail[sum] + rest) * omega * omega
    });
    let mut kept = candidates.clone();
    kept.retain(|n| left_out.binary_search_by(|&k| candidates[k].cmp(n)).is_err());
    let mut balance = sums.balance(&kept, omega, cancel)?;
    balance.omitted = left_out
        .into_iter()
        .filter(|&k| sizes[k].iter().any(|&size| size > 0.0))
        .map(|k| candidates[k])
        .collect();
    [balance.force.error_bound, balance.moment.error_bound] = [bounds[0], bounds[1]];
    if let Some(torque) = &mut balance.torque {
        torque.error_bound = bounds[2];
    }
    Ok(balance)
}

/// Orders that may matter: those of the spectrum, or all up to where the rest is negligible.
fn candidates(rtol: f64, engine: &Engine, sums: &Sums) -> Result<Vec<u32>> {
    if let Some(spectrum) = sums.spectrum {
        let rotating = engine.placements().iter().any(|p| p.rotating_mass > 0.0);
        return Ok(spectrum.orders_with(rotating));
    }
    let placements = engine.placements();
    let allowed = scales(engine, sums.reference);
    let cylinders = sums.groups.iter().map(|group| {
        let members = group.members.iter().map(|&i| rod_share(&placements[i].cylinder, &allowed));
        (group.proportions, members.fold(0.0, f64::max))
    });
    Ok((1..=highest(rtol, NEGLIGIBLE, placements.len(), cylinders, sums.torque)?).collect())
}

/// Size of a rod's inertia over what a tolerance of torque is relative to.
pub(crate) fn rod_share(cylinder: &Cylinder, scales: &[f64; 3]) -> f64 {
    let inertia = cylinder.rod_inertia_excess().abs();
    if inertia == 0.0 { 0.0 } else { inertia / scales[2] }
}

/// The last order worth a look, for so many cylinders of these proportions and shares of rod inertia:
/// the rest is `negligible`, which is less than a quarter of the tolerance, or at least that.
pub(crate) fn highest(
    rtol: f64,
    negligible: f64,
    count: usize,
    cylinders: impl Iterator<Item = (Proportions, f64)>,
    torque: bool,
) -> Result<u32> {
    let (needed, enough) = (0.25 * rtol / count as f64, negligible / count as f64);
    let mut highest = 1;
    for (proportions, rod_share) in cylinders {
        let torque = torque.then_some(rod_share);
        let last = match harmonics::highest_order(&proportions, enough, torque) {
            Some(order) => order,
            // A rest that is not negligible still is within the tolerance.
            None if harmonics::highest_order(&proportions, needed, torque).is_some() => {
                limits::HIGHEST_ORDER
            }
            None => return Err(Error::TooManyOrders { rtol, rod_ratio: 1.0 / proportions.rod }),
        };
        highest = highest.max(last);
    }
    Ok(highest)
}

/// Bounds of what orders above `highest` add to one cylinder's force over m·r·ω² and, where it is
/// wanted, to either torque over m·r²·ω².
pub(crate) fn tail(proportions: &Proportions, highest: u32, torque: bool) -> [f64; 2] {
    let known = |bound: Option<f64>| bound.unwrap_or(f64::INFINITY);
    let of_torque = torque.then(|| known(harmonics::torque::tail_bound(proportions, highest)));
    [known(harmonics::tail_bound(proportions, highest)), of_torque.unwrap_or(0.0)]
}

/// The same of the torque of a rod's inertia, over it and ω².
pub(crate) fn rod_tail(proportions: &Proportions, highest: u32) -> f64 {
    harmonics::rod::tail_bound(proportions, highest).unwrap_or(f64::INFINITY)
}

/// What a tolerance is relative to, over ω²: the largest m·r of a cylinder, times the longest lever,
/// times its crank radius. Where rod inertia makes more of order 1, what it makes: about J·r/l.
pub(crate) fn scales(engine: &Engine, reference: f64) -> [f64; 3] {
    let mut largest = [0.0_f64; 3];
    for p in engine.placements() {
        let radius = p.cylinder.crank_radius();
        let force = p.cylinder.first_order().max(p.rotating_mass * radius);
        largest[0] = largest[0].max(force);
        let of_rod = p.cylinder.rod_inertia_excess().abs() * p.cylinder.rod_ratio();
        largest[2] = largest[2].max(force * radius).max(of_rod);
    }
    largest[1] = largest[0] * engine.longest_lever(reference);
    largest
}

impl Balance {
    /// Length of force and moment and size of the larger torque of the k-th order.
    fn sizes(&self, k: usize) -> [f64; 3] {
        let length = |shake: &Shake| shake.forward[k].norm() + shake.backward[k].norm();
        let torque = self.torque.as_ref().map_or(0.0, |t| t.roll[k].norm().max(t.crank[k].norm()));
        [length(&self.force), length(&self.moment), torque]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angle::Angle;
    use crate::engine::Placement;

    fn placement(cylinder: Cylinder, z: f64, rotating_mass: f64) -> Placement {
        Placement { cylinder, tdc: Angle::ZERO, bank: Angle::QUARTER_TURN, z, rotating_mass }
    }

    fn engine(cylinders: &[Cylinder]) -> Engine {
        let placements =
            cylinders.iter().enumerate().map(|(i, &c)| placement(c, 0.1 * i as f64, 0.0));
        Engine::new("", "", placements.collect()).unwrap()
    }

    #[test]
    fn tolerances_are_relative_to_the_largest_cylinder() {
        let small = Cylinder::new(0.05, 0.2, 2.0, 0.0).unwrap();
        let large = Cylinder::new(0.08, 0.2, 4.0, 0.0).unwrap();
        let near = |found: [f64; 3], expected: [f64; 3]| {
            let close = |(a, b): (f64, f64)| (a / b - 1.0).abs() < 1e-14;
            assert!(found.into_iter().zip(expected).all(close), "{found:?} {expected:?}");
        };
        // m·r = 0.1 and 0.32; the longest lever is that of the other cylinder.
        let two = |rotating, inertia| {
            let other = small.with_rod_inertia_excess(inertia).unwrap();
            let places = vec![placement(other, 0.7, 0.0), placement(large, 0.1, rotating)];
            Engine::new("", "", places).unwrap()
        };
        near(scales(&two(0.0, 0.0), 0.0), [0.32, 0.32 * 0.7, 0.32 * 0.08]);
        // 5 kg at 0.08 m.
        near(scales(&two(5.0, 0.0), 0.2), [0.4, 0.4 * 0.5, 0.4 * 0.08]);
        // J·r/l = 0.25 J.
        let with_inertia = two(0.0, -2.0);
        near(scales(&with_inertia, 0.0), [0.32, 0.32 * 0.7, 0.5]);
        let [inert, plain] = [0, 1].map(|i| with_inertia.placements()[i].cylinder);
        assert_eq!(rod_share(&inert, &[1.0, 1.0, 0.5]), 4.0);
        // Where nothing moves, nothing over nothing is nothing.
        assert_eq!(rod_share(&plain, &[0.0; 3]), 0.0);
    }

    #[test]
    fn candidates_end_where_the_rest_is_negligible() {
        let short = Cylinder::new(0.05, 0.12, 1.0, 0.01).unwrap();
        // Rods of which a few have a last order for their own inertia.
        let cases = (0..20)
            .flat_map(|k| [0.0, 0.001, 10.0].map(|inertia| (0.13 + 0.02 * f64::from(k), inertia)));
        for (rod_length, inertia) in cases {
            let plain = Cylinder::new(0.05, rod_length, 2.0, 0.0).unwrap();
            let heavy = plain.with_rod_inertia_excess(inertia).unwrap();
            for cylinders in
                [vec![heavy; 2], vec![plain, heavy, heavy], vec![short, heavy, plain, short]]
            {
                let engine = engine(&cylinders);
                for torque in [false, true] {
                    let sums = Sums::new(&engine, 0.0, None, torque);
                    let last = *candidates(1e-6, &engine, &sums).unwrap().last().unwrap();
                    let largest = 0.005_f64.max(inertia * 0.05 / rod_length);
                    // As if nothing cancelled, and each cylinder were the largest.
                    let rest = |highest: u32| {
                        let each = cylinders.iter().map(|c| {
                            let [force, mut of_torque] = tail(&c.proportions(), highest, torque);
                            if torque && c.has_rod_inertia() {
                                of_torque +=
                                    inertia / largest * rod_tail(&c.proportions(), highest);
                            }
                            force.max(of_torque)
                        });
                        each.fold(0.0, f64::max) * cylinders.len() as f64
                    };
                    assert!(rest(last) <= NEGLIGIBLE * (1.0 + 1e-12));
                    assert!(rest(last - 1) > NEGLIGIBLE);
                }
            }
        }
    }

    #[test]
    fn a_rest_that_never_is_negligible_must_be_within_the_tolerance() {
        let proportions = Proportions::new(1.0 / (1.0 + 1e-6), 0.0).unwrap();
        let rod_ratio = 1.0 / proportions.rod;
        let [rest, _] = tail(&proportions, limits::HIGHEST_ORDER, false);
        for count in [1, 5] {
            let of =
                |rtol: f64| highest(rtol, 1e-17, count, [(proportions, 0.0)].into_iter(), false);
            // A quarter of the tolerance is for what is above the highest order.
            let rtol = 4.0 * rest * count as f64;
            assert_eq!(of(rtol * 1.000_001), Ok(limits::HIGHEST_ORDER));
            let rtol = rtol * 0.999_999;
            assert_eq!(of(rtol), Err(Error::TooManyOrders { rtol, rod_ratio }));
        }
    }
}
