//! Harmonics of the torque of gas pressure, and a bound of those left out.

use std::sync::{Arc, LazyLock, Mutex};

use super::Strokes;
use super::chamber::Face;
use super::{ATMOSPHERE, Cycle, period_deg};
use crate::Complex64;
use crate::mechanism::Mechanism;
use crate::mechanism::cylinder::Cylinder;
use crate::mechanism::motion::{CrankPosition, Cranks, MotionColumns};
use crate::numbers::angle::{Angle, cis_degrees};
use crate::numbers::cancel::Cancel;
use crate::numbers::chebyshev::{jet, jets, values};
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::quadrature::gauss_legendre;
use crate::numbers::simd::{MultiplyAdd, sin_cos_degrees, vectorised};

/// Torque on a crank over piston area and crank radius, Pa.
#[derive(Debug, Clone, PartialEq)]
pub struct GasTorque {
    /// Mean over the cycle.
    pub mean: f64,
    /// Peak phasors of the orders asked for.
    pub phasors: Vec<Complex64>,
}

impl GasTorque {
    /// The phasors of some orders, of one that has all halves up to the highest of them.
    pub(crate) fn at(&self, orders: &[Order]) -> Self {
        let phasor = |order: &Order| self.phasors[order.halves() as usize - 1];
        Self { mean: self.mean, phasors: orders.iter().map(phasor).collect() }
    }
}

/// The last torque of a cycle that was integrated, alone and with squares of its derivatives: all readings
/// of an engine need the same one, at any speed.
#[derive(Debug, Default)]
pub(super) struct LastTorques([Mutex<Option<Integrated>>; 2]);

/// A torque, and the figures on which it depends.
#[derive(Debug)]
struct Integrated {
    mechanism: Arc<dyn Mechanism>,
    crankcase: f64,
    orders: Vec<Order>,
    torque: GasTorque,
    squares: [f64; 2],
}

impl Clone for LastTorques {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// They are no part of a cycle.
impl PartialEq for LastTorques {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Nodes that are summed at once: they stay in the cache.
const NODES_AT_ONCE: usize = 512;
/// Numbers that are summed side by side.
const SUMMED_SIDE_BY_SIDE: usize = 8;
type PartialSums = [f64; SUMMED_SIDE_BY_SIDE];
/// Orders after which powers are computed afresh: rounding grows with each multiplication.
const ORDERS_PER_POWER: usize = 32;
/// Part of the total within which the quadrature of a squared slope or bend is exact.
const QUADRATURE: f64 = 1e-12;
/// Part of the largest pressure, or slope of it, below which a jump is rounding.
const JUMP_OF_ROUNDING: f64 = 1e-12;

/// A quadrature rule, and up to where it reaches rounding.
struct Rule {
    /// Points beyond those that integrate the polynomial of pressure exactly.
    points: u32,
    /// Largest phase, radians, of the highest order over half a panel.
    phase: f64,
    /// Least distance of a singularity of the piston's motion, in half panels.
    distance: f64,
}

/// From the error term of Gauss-Legendre quadrature of `e^{iκx}`, 2^{2m+1}(m!)⁴κ^{2m}/((2m+1)(2m)!³),
/// and from its rate of convergence ρ^{−2m} on the ellipse through the singularity.
const RULES: [Rule; 5] = [
    Rule { points: 4, phase: 0.05, distance: 50.0 },
    Rule { points: 5, phase: 0.2, distance: 20.0 },
    Rule { points: 6, phase: 0.45, distance: 11.0 },
    Rule { points: 8, phase: 1.3, distance: 5.0 },
    Rule { points: 16, phase: 6.0, distance: 1.7 },
];

/// Largest number of points of a rule: that for polynomials of degree 32.
const MOST_NODES: usize = 16 + 17;

static NODES: LazyLock<Vec<Vec<(f64, f64)>>> =
    LazyLock::new(|| (0..=MOST_NODES as u32).map(gauss_legendre).collect());

/// Points of the quadrature that are summed at once.
#[derive(Default)]
struct Abscissae {
    /// Crank angles, degrees.
    theta_deg: Vec<f64>,
    /// Weights, radians, times torques there.
    weighted: Vec<f64>,
    /// Sums over all points so far of the weight times the squares of the torque's slope and bend, per
    /// radian.
    squares: [f64; 2],
    /// Parts of a panel that are left.
    parts: Vec<(f64, f64)>,
}

/// Pressure on a panel.
struct PressurePanel<'a> {
    /// Of its Chebyshev series.
    coefficients: &'a [f64],
    /// Degrees.
    middle: f64,
    /// Half its width, radians.
    half: f64,
}

impl Abscissae {
    /// Append some nodes of a panel: the first of these places and weights.
    #[inline(always)]
    fn add<const SQUARES: bool>(
        &mut self,
        (places, weights, count): (&PartialSums, &PartialSums, usize),
        panel: &PressurePanel,
        mechanism: &dyn Mechanism,
        crankcase: f64,
    ) {
        let (half, half_deg) = (panel.half, panel.half.to_degrees());
        let [mut degrees, mut sin, mut cos, mut weighted] = [[0.0; SUMMED_SIDE_BY_SIDE]; 4];
        for (degrees, place) in degrees.iter_mut().zip(places) {
            *degrees = panel.middle + half_deg * place;
        }
        sin_cos_degrees(&degrees, &mut sin, &mut cos);
        let [pressure, mut slope, mut bend] = if SQUARES {
            jets(panel.coefficients, places)
        } else {
            [
                values(panel.coefficients, places),
                [0.0; SUMMED_SIDE_BY_SIDE],
                [0.0; SUMMED_SIDE_BY_SIDE],
            ]
        };
        let [mut velocity, mut acceleration, mut jerk] = [[0.0; SUMMED_SIDE_BY_SIDE]; 3];
        let mut motion = MotionColumns::of_both([&mut velocity, &mut acceleration]);
        motion.jerk = if SQUARES { Some(&mut jerk) } else { None };
        mechanism.motions(&Cranks::new(&cos, &sin, Complex64::ONE), motion);
        for k in 0..SUMMED_SIDE_BY_SIDE {
            let gauge = pressure[k] - crankcase;
            // The piston's way down is minus its distance from the crank.
            weighted[k] = weights[k] * (-gauge * velocity[k]);
            if SQUARES {
                let (of_slope, of_bend) = (slope[k] / half, bend[k] / (half * half));
                slope[k] = of_slope * velocity[k] + gauge * acceleration[k];
                bend[k] =
                    of_bend * velocity[k] + 2.0 * of_slope * acceleration[k] + gauge * jerk[k];
            }
        }
        self.theta_deg.extend_from_slice(&degrees[..count]);
        self.weighted.extend_from_slice(&weighted[..count]);
        if SQUARES {
            for (square, derivative) in self.squares.iter_mut().zip([slope, bend]) {
                for (weight, derivative) in weights.iter().zip(&derivative).take(count) {
                    *square += weight * derivative * derivative;
                }
            }
        }
    }
}

impl Cycle {
    /// Torque on a crank over piston area and crank radius, of the pressure above the crankcase's.
    pub fn torque_of(
        &self,
        mechanism: &Arc<dyn Mechanism>,
        crankcase: f64,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<GasTorque> {
        self.integrate::<false>(mechanism, crankcase, orders, cancel).map(|(torque, _)| torque)
    }

    /// Indicated mean effective pressure over the piston of a cylinder, Pa: work over displacement.
    pub fn imep(&self, cylinder: &Cylinder, cancel: &Cancel) -> Result<f64> {
        let torque = self.torque_of(&cylinder.mechanism(), ATMOSPHERE, &[], cancel)?;
        let travel = cylinder.travel() / cylinder.crank_radius();
        Ok(torque.mean * period_deg(self.strokes).to_radians() / travel)
    }

    /// The same at an end of the piston, from where its chamber is smallest on.
    pub fn imep_at(
        self: &Arc<Self>,
        face: Face,
        cylinder: &Cylinder,
        cancel: &Cancel,
    ) -> Result<f64> {
        let [_, lowest] = cylinder.turning_points_deg();
        let delay = match face {
            Face::Outer => Angle::ZERO,
            Face::Inner => Angle::from_degrees(lowest)?,
        };
        Ok(face.sign() * self.delayed(delay).imep(cylinder, cancel)?)
    }

    /// Torque at orders ½, 1, 1½ … up to one, and bounds of the sum of the magnitudes of all phasors above
    /// each; infinite where the torque jumps.
    ///
    /// By Cauchy and Schwarz from those of a derivative: Σ|cₖ| ≤ √(Σ k⁻²ʲ · Σ k²ʲ|cₖ|²), and the last sum
    /// is known from the mean square of the j-th derivative less that of the orders below (Parseval). Of
    /// slope and bend whichever is less, the bend where the slope does not jump.
    pub fn torque_up_to(
        &self,
        mechanism: &Arc<dyn Mechanism>,
        crankcase: f64,
        highest: Order,
        cancel: &Cancel,
    ) -> Result<(GasTorque, Vec<f64>)> {
        let orders = (1..=highest.halves()).map(Order::from_halves).collect::<Result<Vec<_>>>()?;
        let (torque, squares) = self.integrate::<true>(mechanism, crankcase, &orders, cancel)?;
        let step = if self.strokes == Strokes::Four { 0.5 } else { 1.0 };
        let mut left = squares;
        let tail = |(order, phasor): (&Order, &Complex64)| {
            let k = order.number();
            // Σ k⁻²ʲ above an order is below the integral from the middle to the next.
            let from = (k / step).floor() * step + 0.5 * step;
            let bounds = [0, 1].map(|j| {
                left[j] -= (k * k).powi(j as i32 + 1) * phasor.norm_sqr();
                let above = from.powi(-2 * j as i32 - 1) / (step * (2 * j + 1) as f64);
                ((left[j].max(0.0) + QUADRATURE * squares[j]) * above).sqrt()
            });
            bounds[0].min(bounds[1])
        };
        let tails = orders.iter().zip(&torque.phasors).map(tail).collect();
        Ok((torque, tails))
    }

    /// Whether [`Self::torque_of`] has been integrated, and is kept.
    pub(crate) fn keeps_torque_of(
        &self,
        mechanism: &Arc<dyn Mechanism>,
        crankcase: f64,
        orders: &[Order],
    ) -> bool {
        self.kept::<false, _>(mechanism, crankcase, orders, |_| ()).is_some()
    }

    /// Something of the torque that was integrated last, if it is this one.
    fn kept<const SQUARES: bool, T>(
        &self,
        mechanism: &Arc<dyn Mechanism>,
        crankcase: f64,
        orders: &[Order],
        something: impl FnOnce(&Integrated) -> T,
    ) -> Option<T> {
        // None waits for a lock: a forked child has no thread that would release it.
        let last = self.last_torques.0[usize::from(SQUARES)].try_lock().ok()?;
        let is_it = |kept: &&Integrated| {
            *kept.mechanism == **mechanism && kept.crankcase == crankcase && kept.orders == orders
        };
        last.as_ref().filter(is_it).map(something)
    }

    /// Torque, and if wanted twice the mean squares of its slope and bend: infinite where it jumps, or its
    /// slope; of what is kept, if it is.
    fn integrate<const SQUARES: bool>(
        &self,
        mechanism: &Arc<dyn Mechanism>,
        crankcase: f64,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<(GasTorque, [f64; 2])> {
        let copied = |kept: &Integrated| (kept.torque.clone(), kept.squares);
        if let Some(kept) = self.kept::<SQUARES, _>(mechanism, crankcase, orders, copied) {
            return Ok(kept);
        }
        let (torque, squares) = self.integrated::<SQUARES>(mechanism, crankcase, orders, cancel)?;
        if let Ok(mut last) = self.last_torques.0[usize::from(SQUARES)].try_lock() {
            let (mechanism, orders) = (Arc::clone(mechanism), orders.to_vec());
            let torque = torque.clone();
            *last = Some(Integrated { mechanism, crankcase, orders, torque, squares });
        }
        Ok((torque, squares))
    }

    fn integrated<const SQUARES: bool>(
        &self,
        mechanism: &Arc<dyn Mechanism>,
        crankcase: f64,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<(GasTorque, [f64; 2])> {
        let period = period_deg(self.strokes).to_radians();
        let mut sorted: Vec<usize> = (0..orders.len()).collect();
        sorted.sort_unstable_by_key(|&k| orders[k]);
        // A two-stroke has no half orders.
        sorted.retain(|&k| self.strokes == Strokes::Four || orders[k].as_whole().is_some());
        let halves: Vec<u32> = sorted.iter().map(|&k| orders[k].halves()).collect();
        let highest = halves.last().map_or(0.0, |&halves| 0.5 * f64::from(halves));
        let mut sums: Vec<Complex64> = memory::zeros(sorted.len())?;
        let (mut mean, mut points) = (0.0, Abscissae::default());
        let motion = &**mechanism;
        let mut powers = Powers::default();
        let mut finish = |points: &mut Abscissae| -> Result<()> {
            mean += points.weighted.iter().sum::<f64>();
            vectorised(
                #[inline(always)]
                || powers.add(points, &halves, &mut sums, cancel),
            )?;
            points.theta_deg.clear();
            points.weighted.clear();
            cancel.check()
        };
        for panel in 0..self.panels.edges.len() - 1 {
            let points = &mut points;
            self.nodes::<SQUARES>(panel, motion, crankcase, highest, points, &mut finish)?;
        }
        finish(&mut points)?;
        let mut phasors = memory::zeros(orders.len())?;
        for (&k, sum) in sorted.iter().zip(&sums) {
            phasors[k] = sum * (2.0 / period);
        }
        let jumps = if SQUARES { self.jumps(mechanism, crankcase) } else { [false; 2] };
        let squares = [0, 1].map(|j| {
            if jumps[..=j].contains(&true) {
                f64::INFINITY
            } else {
                2.0 * points.squares[j] / period
            }
        });
        Ok((GasTorque { mean: mean / period, phasors }, squares))
    }

    /// Append the nodes of a panel, halved until a rule is exact to rounding.
    fn nodes<const SQUARES: bool>(
        &self,
        panel: usize,
        motion: &dyn Mechanism,
        crankcase: f64,
        highest: f64,
        points: &mut Abscissae,
        finish: &mut impl FnMut(&mut Abscissae) -> Result<()>,
    ) -> Result<()> {
        let (from, to) = (self.panels.edges[panel], self.panels.edges[panel + 1]);
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from).to_radians());
        let panel = PressurePanel { coefficients: self.panels.panel(panel), middle, half };
        let centred = middle.to_radians();
        let extra = self.panels.degree.div_ceil(2) as u32;
        // Parts of the panel, as intervals of [−1, 1].
        points.parts.push((-1.0, 1.0));
        while let Some((low, high)) = points.parts.pop() {
            let (centre, width): (f64, f64) = (0.5 * (low + high), 0.5 * (high - low));
            let theta = centred + half * centre;
            let distance = motion.to_singularity(theta) / (half * width);
            let phase = highest * half * width;
            let rule = RULES.iter().find(|rule| phase <= rule.phase && distance >= rule.distance);
            // A panel that is a point to rounding has no parts.
            let Some(rule) = rule.or(if width < 1e-15 { RULES.last() } else { None }) else {
                points.parts.extend([(centre, high), (low, centre)]);
                continue;
            };
            vectorised(
                #[inline(always)]
                || {
                    for rule in NODES[(rule.points + extra) as usize].chunks(SUMMED_SIDE_BY_SIDE) {
                        let [mut places, mut weights] = [[0.0; SUMMED_SIDE_BY_SIDE]; 2];
                        for (k, (x, weight)) in rule.iter().enumerate() {
                            places[k] = centre + width * x;
                            weights[k] = weight * half * width;
                        }
                        points.add::<SQUARES>(
                            (&places, &weights, rule.len()),
                            &panel,
                            motion,
                            crankcase,
                        );
                    }
                },
            );
            if points.weighted.len() >= NODES_AT_ONCE {
                finish(points)?;
            }
        }
        Ok(())
    }

    /// Whether torque jumps at an edge, where pressure does and the piston moves; and whether its slope
    /// does, with that of pressure or where the piston stands.
    fn jumps(&self, mechanism: &Arc<dyn Mechanism>, crankcase: f64) -> [bool; 2] {
        let panels = &self.panels;
        let count = panels.edges.len() - 1;
        // Pressure and its slope per radian.
        let ends = |k: usize| {
            let half = 0.5 * (panels.edges[k + 1] - panels.edges[k]).to_radians();
            [-1.0, 1.0].map(|place| {
                let [pressure, slope, _] = jet(panels.panel(k), place);
                [pressure - crankcase, slope / half]
            })
        };
        let mut largest = [0.0_f64; 2];
        for end in (0..count).flat_map(ends) {
            largest = [0, 1].map(|j| largest[j].max(end[j].abs()));
        }
        let mut jumps = [false; 2];
        for k in 0..count {
            let ([after, _], [_, before]) = (ends((k + 1) % count), ends(k));
            let unit = cis_degrees(panels.edges[k + 1]);
            let motion = mechanism.motion(&CrankPosition::new(unit.im, unit.re));
            let [gauge, slope] = [0, 1].map(|j| after[j] - before[j]);
            jumps[0] |= (gauge * motion.velocity).abs() > JUMP_OF_ROUNDING * largest[0];
            let of_slope = slope * motion.velocity + gauge * motion.acceleration;
            jumps[1] |= of_slope.abs() > JUMP_OF_ROUNDING * (largest[0] + largest[1]);
        }
        jumps
    }
}

/// Sums over nodes of torque times `e^{−ikθ}` for ascending orders, by powers of `e^{iθ/2}`.
#[derive(Default)]
struct Powers {
    wave: Wave,
    step: Wave,
    /// Halves by which a step turns.
    gap: u32,
}

/// Cosines and sines of multiples of the nodes' angles.
#[derive(Default)]
struct Wave {
    angles: Vec<f64>,
    cos: Vec<f64>,
    sin: Vec<f64>,
}

impl Wave {
    #[inline(always)]
    fn fill(&mut self, theta_deg: &[f64], halves: u32) {
        self.angles.clear();
        self.angles.extend(theta_deg.iter().map(|theta| 0.5 * f64::from(halves) * theta));
        self.cos.resize(theta_deg.len(), 0.0);
        self.sin.resize(theta_deg.len(), 0.0);
        sin_cos_degrees(&self.angles, &mut self.sin, &mut self.cos);
    }
}

impl Powers {
    #[inline(always)]
    fn add(
        &mut self,
        points: &mut Abscissae,
        halves: &[u32],
        sums: &mut [Complex64],
        cancel: &Cancel,
    ) -> Result<()> {
        // Points of no weight, up to whole lanes.
        let whole = points.weighted.len().next_multiple_of(SUMMED_SIDE_BY_SIDE);
        points.weighted.resize(whole, 0.0);
        points.theta_deg.resize(whole, 0.0);
        let Abscissae { theta_deg, weighted, .. } = &*points;
        self.gap = 0;
        let mut before = 0;
        for (i, (&order, sum)) in halves.iter().zip(sums).enumerate() {
            let gap = order - before;
            before = order;
            *sum += if gap > 2 || i % ORDERS_PER_POWER == 0 {
                self.wave.fill(theta_deg, order);
                cancel.check()?;
                self.sum::<false>(weighted)
            } else {
                if gap != self.gap {
                    self.step.fill(theta_deg, gap);
                    self.gap = gap;
                }
                self.sum::<true>(weighted)
            };
        }
        Ok(())
    }

    /// Sum of torque times the conjugate wave, by lanes; of the wave turned by the step, or as it is.
    #[inline(always)]
    fn sum<const TURNED: bool>(&mut self, weighted: &[f64]) -> Complex64 {
        let (mut re, mut im) = ([0.0; SUMMED_SIDE_BY_SIDE], [0.0; SUMMED_SIDE_BY_SIDE]);
        let Self { wave, step, .. } = self;
        let waves = wave.cos.as_chunks_mut().0.iter_mut().zip(wave.sin.as_chunks_mut().0);
        let mut steps = step.cos.as_chunks().0.iter().zip(step.sin.as_chunks().0);
        for (weighted, (cos, sin)) in weighted.as_chunks().0.iter().zip(waves) {
            let (cos, sin): (&mut PartialSums, &mut PartialSums) = (cos, sin);
            let weighted: &PartialSums = weighted;
            if TURNED && let Some((c, s)) = steps.next() {
                let (c, s): (&PartialSums, &PartialSums) = (c, s);
                for k in 0..SUMMED_SIDE_BY_SIDE {
                    let before = cos[k];
                    cos[k] = before.multiply_add(c[k], -(sin[k] * s[k]));
                    sin[k] = before.multiply_add(s[k], sin[k] * c[k]);
                }
            }
            for k in 0..SUMMED_SIDE_BY_SIDE {
                re[k] = weighted[k].multiply_add(cos[k], re[k]);
                im[k] = (-weighted[k]).multiply_add(sin[k], im[k]);
            }
        }
        Complex64::new(re.iter().sum(), im.iter().sum())
    }
}
