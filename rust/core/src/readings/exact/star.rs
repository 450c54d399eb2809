//! Star diagrams: phase vectors of the cylinders at an order of their firing, and their sum.
//!
//! What repeats with the cycle of each cylinder, such as the torque of its gas, has at order k the phase
//! `e^{−ik·fire}`, fire being the crank angle of its firing within two turns. Of cylinders whose cycles are
//! alike the sum Σβ·e^{−ik·fire} says what is left, with weights β such as those of a mode shape. A slip
//! of a turn changes the sign of a vector at half orders, and nothing at whole ones.

use std::collections::BTreeMap;

use super::roots::{PartOfTurn, parts_of_turn};
use super::vanishing::Verdict;
use super::whole;
use crate::Complex64;
use crate::engine::{Engine, FacePressure};
use crate::firing::Firing;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::index::{List, distinct};
use crate::numbers::limits;
use crate::numbers::order::Order;
use crate::numbers::rational::{Multiples, Ratio};
use crate::numbers::ring::RootSum;
use crate::wrench::{rounding, snapped};

/// Phase vectors of one order.
#[derive(Debug, Clone, PartialEq)]
pub struct Star {
    /// Vector of each cylinder: weight times `e^{−ik·fire}`.
    pub vectors: Vec<Complex64>,
    /// Their sum; zero where it is proved to vanish or within rounding.
    pub sum: Complex64,
    /// What is proved of the sum.
    pub verdict: Verdict,
    /// Whether all cylinders have one phase: a major order.
    pub is_major: bool,
}

/// Angles of firing, and weights of cylinders.
pub struct Stars {
    fire: Vec<Angle>,
    /// Halves of the angles, as parts of a turn.
    halves: List<usize, PartOfTurn>,
    weights: Vec<f64>,
    /// Whether each cylinder fires: those that do not have no vector, and make no order a major one.
    fires: Vec<bool>,
    multiples: Multiples,
    /// Groups of which only the vectors of one have a known ratio, and whether the vector is that of the
    /// mirrored gear.
    groups: Vec<(usize, bool)>,
}

impl Stars {
    /// Of angles of firing within two turns, with a weight for each cylinder. Cylinders of different
    /// groups have vectors of no known ratio. Of mirrored ones, of opposite pin offsets, a part is the
    /// same and the rest has the opposite sign.
    pub fn new(
        fire: Vec<Angle>,
        mut weights: Vec<f64>,
        groups: Vec<(usize, bool)>,
        fires: Vec<bool>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let lists =
            [("mode_shape", weights.len()), ("groups", groups.len()), ("fires", fires.len())];
        for (argument, found) in lists {
            limits::same_length(argument, found, "the engine", fire.len(), "cylinder")?;
        }
        for (weight, &fires) in weights.iter_mut().zip(&fires) {
            *weight = if fires { *weight } else { 0.0 };
        }
        let halves = parts_of_turn(fire.iter().map(|angle| angle.half()), true, cancel)?;
        let multiples = Multiples::new(&weights, cancel)?;
        Ok(Self { fire, halves, weights, fires, multiples, groups })
    }

    /// Of a way to fire, with a weight for each cylinder.
    pub fn of_firing(firing: &Firing, weights: Vec<f64>, cancel: &Cancel) -> Result<Self> {
        let (groups, engine) = (vec![(0, false); weights.len()], firing.engine());
        let fires = (0..weights.len()).map(|i| engine.fires(i) && engine.fires_as(i) == i);
        Self::new(firing.phases(), weights, groups, fires.collect(), cancel)
    }

    /// Of the roll torque of the gas of an engine, as it fires if it has no cycles: alike are cylinders of
    /// equal radius, rod, offset, bore and cycle, met at the same time, on cranks of one speed; the torque of one that turns
    /// against the main crank has the opposite sign.
    pub fn of_gas(engine: &Engine, firing: Option<&Firing>, cancel: &Cancel) -> Result<Self> {
        let phases = || (0..engine.stations().len()).map(|i| engine.firing_phase(i)).collect();
        let mut fire: Vec<Angle> =
            firing.filter(|_| engine.cycles_in_use() == 0).map_or_else(phases, Firing::phases);
        // The faces on which pressure acts: of the cylinders' cycles, then at crank ends.
        let cylinders = 0..engine.stations().len();
        let own = |i: usize| {
            let size = (engine.details()[i].bore, engine.working_face(i));
            (i, size, engine.cycle_of(i), engine.chamber_delay(i))
        };
        let mut faces: Vec<_> = cylinders.clone().map(own).collect();
        let mut fires: Vec<bool> = cylinders.clone().map(|i| engine.fires(i)).collect();
        for i in cylinders {
            for FacePressure { face, area, index, delay, phase, .. } in engine.pressures(i) {
                if face != engine.working_face(i) {
                    fire.push(phase);
                    fires.push(true);
                    faces.push((i, (Some(area), face), Some(index), Some(delay)));
                }
            }
        }
        let ratio = |i: usize| engine.cranks()[engine.crank_of(i)].ratio;
        let sizes = |&(i, size, cycle, delay): &(usize, _, _, _)| {
            let gear = &engine.stations()[i].cylinder;
            let sizes = [gear.crank_radius(), gear.rod_length(), gear.pin_offset().abs()];
            let linked = engine.running_gear(i).knuckle;
            (sizes, linked, size, cycle, delay, ratio(i).halves().abs())
        };
        let (_, groups) = distinct::<usize, _>(faces.iter().map(sizes));
        let mirrored =
            faces.iter().map(|&(i, ..)| engine.stations()[i].cylinder.pin_offset() < 0.0);
        let groups: Vec<_> = groups.into_iter().zip(mirrored).collect();
        let sense = faces.iter().map(|&(i, ..)| f64::from(ratio(i).sense())).collect();
        Self::new(fire, sense, groups, fires, cancel)
    }

    /// Whether some cylinders are of different groups.
    pub(super) fn are_unlike(&self) -> bool {
        let pairs = self.groups.iter().zip(&self.fires);
        let firing: Vec<_> = pairs.filter(|(_, fires)| **fires).map(|(group, _)| group).collect();
        firing.windows(2).any(|pair| pair[0] != pair[1])
    }

    /// The vectors of an order.
    pub fn at(&self, order: Order) -> Result<Star> {
        let halves = order.halves();
        let phase = |angle: &Angle| angle.half().cis(-i64::from(halves));
        let weighted = self.fire.iter().zip(&self.weights);
        let vectors: Vec<Complex64> =
            weighted.map(|(angle, weight)| phase(angle) * weight).collect();
        let turns = |k: usize| self.halves[k].turns * i128::from(halves);
        let mut firing = (0..self.fire.len()).filter(|&k| self.fires[k]);
        let is_major = firing.next().is_some_and(|first| {
            firing.all(|k| {
                self.halves[k].symbol == self.halves[first].symbol
                    && (turns(k) - turns(first)).is_integer()
            })
        });
        // Each term with its sign in the sum of a gear's vectors and of those of the mirrored one.
        let mut sums: BTreeMap<_, Vec<(Ratio, Ratio, bool)>> = BTreeMap::new();
        for (k, &(unit, weight)) in self.multiples.of.iter().enumerate() {
            let (group, mirrored) = self.groups[k];
            let key = (group, unit, self.halves[k].symbol);
            sums.entry(key).or_default().push((-turns(k), weight, mirrored));
        }
        let mut left = 0;
        for terms in sums.values() {
            let (weights, _) = whole(&terms.iter().map(|term| term.1).collect::<Vec<_>>())?;
            // A·a + B·b of two unknown harmonics a, b is (A + B)·(a + b)/2 + (A − B)·(a − b)/2.
            let remains = |factor: fn(bool) -> i128| -> Result<usize> {
                let roots = terms.iter().zip(&weights).map(|((turns, _, mirrored), weight)| {
                    (*turns.numer(), *turns.denom(), weight * factor(*mirrored))
                });
                let sum = RootSum::new(&roots.collect::<Vec<_>>(), 1)?;
                Ok(usize::from(!sum.vanishes()?))
            };
            let apart = remains(i128::from)? + remains(|m| i128::from(!m))?;
            left += match apart {
                2 => remains(|_| 1)? + remains(|mirrored| 1 - 2 * i128::from(mirrored))?,
                _ => apart,
            };
        }
        let verdict = match left {
            0 => Verdict::Vanishes,
            1 => Verdict::Remains,
            _ => Verdict::Undecided,
        };
        let size: f64 = self.weights.iter().map(|weight| weight.abs()).sum();
        let bound = match verdict {
            Verdict::Vanishes => f64::INFINITY,
            Verdict::Remains => 0.0,
            Verdict::Undecided => rounding(self.fire.len(), order.number()) * size,
        };
        let sum = snapped(vectors.iter().sum(), bound);
        Ok(Star { vectors, sum, verdict, is_major })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Station;
    use crate::numbers::error::Error;

    fn stars(fire: &[f64], weights: &[f64]) -> Stars {
        let fire = fire.iter().map(|&degrees| Angle::from_degrees(degrees).unwrap()).collect();
        let (groups, fires) = (vec![(0, false); weights.len()], vec![true; weights.len()]);
        Stars::new(fire, weights.to_vec(), groups, fires, &Cancel::new()).unwrap()
    }

    fn at(stars: &Stars, halves: u32) -> Star {
        stars.at(Order::from_halves(halves).unwrap()).unwrap()
    }

    #[test]
    fn even_firing_leaves_multiples_of_half_the_number_of_cylinders() {
        for count in 1..=16_u32 {
            let fire: Vec<f64> =
                (0..count).map(|k| 720.0 * f64::from(k) / f64::from(count)).collect();
            let stars = stars(&fire, &vec![1.0; count as usize]);
            for halves in 1..=40 {
                let star = at(&stars, halves);
                let expected = if halves % count == 0 { f64::from(count) } else { 0.0 };
                assert!((star.sum.norm() - expected).abs() <= 1e-14 * f64::from(count));
                assert_eq!(star.is_major, halves % count == 0, "{count} {halves}");
                let [vanishes, remains] = [Verdict::Vanishes, Verdict::Remains];
                assert_eq!(star.verdict, if expected == 0.0 { vanishes } else { remains });
            }
        }
    }

    #[test]
    fn a_vector_lags_by_its_order_times_the_angle_of_firing() {
        let star = at(&stars(&[0.0, 90.0], &[1.0, 2.0]), 1);
        let lag = Complex64::from_polar(2.0, -std::f64::consts::FRAC_PI_4);
        assert!((star.vectors[1] - lag).norm() < 1e-15);
        assert_eq!(star.sum, star.vectors[0] + star.vectors[1]);
    }

    #[test]
    fn a_turn_changes_the_sign_at_half_orders() {
        let [early, late] = [[0.0, 90.0], [0.0, 450.0]].map(|fire| stars(&fire, &[1.0; 2]));
        for halves in 1..12 {
            let sign = if halves % 2 == 1 { -1.0 } else { 1.0 };
            let [early, late] = [&early, &late].map(|stars| at(stars, halves).vectors[1]);
            assert_eq!(early * sign, late, "{halves}");
        }
    }

    #[test]
    fn angles_and_weights_without_a_ratio_are_symbols() {
        // A step between two firings keeps a symbol: order 1 cancels, order 1/2 does not.
        let odd = 300.0_f64.sqrt();
        let pair = stars(&[odd, odd + 180.0], &[1.0; 2]);
        assert_eq!(at(&pair, 2).verdict, Verdict::Vanishes);
        assert_eq!(at(&pair, 1).verdict, Verdict::Remains);
        let apart = stars(&[0.0, odd], &[1.0; 2]);
        assert_eq!(at(&apart, 2).verdict, Verdict::Undecided);
        assert!(!at(&apart, 2).is_major);
        let root = stars(&[0.0, 180.0], &[1.0, 2.0_f64.sqrt()]);
        assert_eq!(at(&root, 2).verdict, Verdict::Undecided);
        // A turn apart, wherever the first fires.
        let twin = stars(&[90.0, 450.0], &[1.0; 2]);
        assert_eq!([1, 2].map(|halves| at(&twin, halves).is_major), [false, true]);
        let decimals = stars(&[0.0, 180.0, 180.0], &[0.3, 0.1, 0.2]);
        assert_eq!(at(&decimals, 2).verdict, Verdict::Vanishes);
        assert!(at(&decimals, 2).sum == Complex64::default());
        let other = [0.0, 360.0].map(|degrees| Angle::from_degrees(degrees).unwrap()).to_vec();
        let unlike = Stars::new(
            other,
            vec![1.0; 2],
            vec![(0, false), (1, false)],
            vec![true; 2],
            &Cancel::new(),
        )
        .unwrap();
        assert_eq!(at(&unlike, 1).verdict, Verdict::Undecided);
        for [weights, groups, fires] in [[2, 1, 1], [1, 0, 1], [1, 1, 2], [0, 1, 1]] {
            let groups = vec![(0, false); groups];
            let (weights, fires) = (vec![1.0; weights], vec![true; fires]);
            let found = Stars::new(vec![Angle::ZERO], weights, groups, fires, &Cancel::new());
            assert!(matches!(found.err(), Some(Error::Length { .. })));
        }
    }

    /// Of 14 decimals, a part of a turn with too many for a root; small parts of a turn beyond it, rounded.
    #[test]
    fn typed_angles_beside_rounded_ones_are_steps_of_one_symbol() {
        let typed: Angle = "236.37001175040001".parse().unwrap();
        for parts in [3_u32, 997] {
            let step = 360.0 / f64::from(parts);
            let rounded = Angle::from_degrees(typed.degrees() + step).unwrap();
            assert!(typed.turns().is_some() && rounded.turns().is_none());
            for fire in [[typed, rounded], [rounded, typed]] {
                let (groups, fires) = (vec![(0, false); 2], vec![true; 2]);
                let stars =
                    Stars::new(fire.to_vec(), vec![1.0, -1.0], groups, fires, &Cancel::new());
                let star = at(&stars.unwrap(), 2 * parts);
                assert_eq!((star.verdict, star.is_major), (Verdict::Vanishes, true), "{parts}");
            }
        }
    }

    /// What is undecided and within rounding is zero, whatever the weights.
    #[test]
    fn roundings_of_undecided_sums_scale_with_the_weights() {
        let fire: Vec<Angle> = (0..7).map(|k| format!("{}/7", 360 * k).parse().unwrap()).collect();
        for size in [1e-6, 1.0, 1e6] {
            let groups = (0..7).map(|k| (k, false)).collect();
            let stars =
                Stars::new(fire.clone(), vec![size; 7], groups, vec![true; 7], &Cancel::new())
                    .unwrap();
            let star = at(&stars, 2);
            let rounded: Complex64 = star.vectors.iter().sum();
            assert!(rounded != Complex64::ZERO && star.verdict == Verdict::Undecided);
            assert_eq!(star.sum, Complex64::ZERO, "{rounded} at {size}");
            // Beyond it, it is what it is.
            let one = Stars::new(
                fire[..2].to_vec(),
                vec![size; 2],
                vec![(0, false), (1, false)],
                vec![true; 2],
                &Cancel::new(),
            );
            let star = at(&one.unwrap(), 2);
            assert!(star.sum.norm() > 0.5 * size && star.verdict == Verdict::Undecided);
        }
    }

    #[test]
    fn gas_of_opposite_offsets_is_of_two_harmonics() {
        let place = |offset: f64, tdc: f64| Station {
            cylinder: crate::Cylinder::new(0.05, 0.15, 0.5, offset).unwrap(),
            tdc: Angle::from_degrees(tdc).unwrap(),
            bank: Angle::ZERO,
            z: 0.0,
            rotating_mass: 0.0,
        };
        let verdict = |offsets: [f64; 2]| {
            let places = vec![place(offsets[0], 0.0), place(offsets[1], 180.0)];
            let engine = Engine::new("", "", places).unwrap();
            let stars = Stars::of_gas(&engine, None, &Cancel::new()).unwrap();
            at(&stars, 2).verdict
        };
        // Half a turn apart at order 1: alike they cancel, mirrored their difference is left.
        assert_eq!(verdict([0.01, 0.01]), Verdict::Vanishes);
        assert_eq!(verdict([-0.01, -0.01]), Verdict::Vanishes);
        assert_eq!(verdict([0.01, -0.01]), Verdict::Remains);
    }

    #[test]
    fn vectors_of_mirrored_gears_remain_where_they_have_one_size() {
        // A V of opposite offsets: the banks fire in turn, a third of the cycle within a bank.
        let fire: Vec<Angle> =
            (0..6).map(|k| Angle::from_degrees(120.0 * f64::from(k)).unwrap()).collect();
        let of = |groups: Vec<(usize, bool)>| {
            Stars::new(fire.clone(), vec![1.0; 6], groups, vec![true; 6], &Cancel::new()).unwrap()
        };
        let mirrored = of((0..6).map(|k| (0, k % 2 == 1)).collect());
        let unlike = of((0..6).map(|k| (k % 2, false)).collect());
        for halves in 1..=24 {
            let major = halves % 3 == 0;
            let expected = |of_major| if major { of_major } else { Verdict::Vanishes };
            assert_eq!(at(&mirrored, halves).verdict, expected(Verdict::Remains), "{halves}");
            assert_eq!(at(&unlike, halves).verdict, expected(Verdict::Undecided), "{halves}");
        }
        // Sums of different sizes may cancel for some pressure.
        let two_and_one = of((0..6).map(|k| (0, k == 1)).collect());
        assert_eq!(at(&two_and_one, 12).verdict, Verdict::Undecided);
        assert_eq!(at(&two_and_one, 2).verdict, Verdict::Remains);
    }
}
