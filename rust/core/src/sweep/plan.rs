//! What a sweep's bank angles do not change: layout sums as constants of a few functions.

use super::harmonics::{Harmonics, Rows};
use super::{Quantity, Sweep};
use crate::Complex64;
use crate::balance::zero_factor;
use crate::cancel::Cancel;
use crate::engine::{Banks, Engine, Hold, Placement};
use crate::error::Result;
use crate::slider_crank::Cylinder;
use std::ops::Range;

/// How many functions of half the bank angle a layout sum has.
pub(super) const FUNCTIONS: usize = 4;

/// Layout sums of one order as constants of those functions: two for the part that turns with the
/// crank and two for (the conjugate of) the part that turns against it.
pub(super) type Constants = [Complex64; FUNCTIONS];

/// A sum over cylinders, order by order.
pub(super) struct Terms {
    pub constants: Vec<Constants>,
    /// Σ|terms|.
    pub sizes: Vec<f64>,
}

/// An engine's order at one point of rod ratio and offset.
#[derive(Clone, Copy, Default)]
pub(super) struct At {
    pub constants: Constants,
    /// What rounding can leave.
    pub bound: f64,
}

/// One engine: cylinders that share their harmonics, and what turns with the pins.
pub(super) struct EnginePlan {
    /// Layout sums, and where their harmonics come from.
    pub groups: Vec<(Terms, Harmonics)>,
    pub rotating: Option<Terms>,
    /// What rounding can leave, relative to Σ|terms|.
    pub zero_factors: Vec<f64>,
    /// The orders at the only point; none where there are several.
    pub at_only_point: Vec<At>,
}

/// All that does not depend on the bank angle.
pub(super) struct Plan<'a> {
    pub sweep: &'a Sweep,
    pub orders: &'a [u32],
    pub hold: Option<Hold>,
    pub engines: Vec<EnginePlan>,
    pub quantity: Quantity,
}

impl<'a> Plan<'a> {
    /// With harmonics worked out once, if the points are passed over that many times.
    pub fn new(
        sweep: &'a Sweep,
        quantity: Quantity,
        passes: usize,
        cancel: &Cancel,
    ) -> Result<Self> {
        let engines = sweep
            .engines
            .iter()
            .zip(&sweep.references)
            .map(|(engine, &reference)| {
                EnginePlan::new(sweep, engine, reference, quantity, passes, cancel)
            })
            .collect::<Result<_>>()?;
        let hold = sweep.axes.bank_angle.as_ref().map(|&(_, hold)| hold);
        Ok(Self { sweep, orders: &sweep.orders, hold, engines, quantity })
    }
}

impl EnginePlan {
    fn new(
        sweep: &Sweep,
        engine: &Engine,
        reference: f64,
        quantity: Quantity,
        passes: usize,
        cancel: &Cancel,
    ) -> Result<Self> {
        let placements = engine.placements();
        let hold = sweep.axes.bank_angle.as_ref().map(|&(_, hold)| hold);
        let frame = hold.map(|hold| engine.banks().map(|banks| (banks, hold))).transpose()?;
        let layout = Layout { reference, orders: &sweep.orders, frame, quantity };
        let mut groups: Vec<(Cylinder, Vec<&Placement>)> = Vec::new();
        for placement in placements {
            let cylinder = placement.cylinder;
            let same = |other: &Cylinder| {
                if quantity.is_torque() && (other.has_rod_inertia() || cylinder.has_rod_inertia()) {
                    return *other == cylinder;
                }
                other.crank_radius() == cylinder.crank_radius()
                    && other.rod_length() == cylinder.rod_length()
                    && other.pin_offset() == cylinder.pin_offset()
            };
            match groups.iter_mut().find(|(other, _)| same(other)) {
                Some((_, members)) => members.push(placement),
                None => groups.push((cylinder, vec![placement])),
            }
        }
        let by_spectrum = sweep.spectrum.is_some();
        let groups = groups.into_iter().map(|(cylinder, members)| {
            let weight = |p: &Placement| match quantity {
                _ if by_spectrum => 1.0,
                // In the harmonics.
                _ if quantity.is_torque() && p.cylinder.has_rod_inertia() => 1.0,
                _ if quantity.is_torque() => p.cylinder.second_moment(),
                _ => p.cylinder.first_order(),
            };
            let terms = layout.terms(&members, weight, [0.5, 0.5]);
            Ok((terms, Harmonics::new(sweep, cylinder, quantity, passes, cancel)?))
        });
        let groups = groups.collect::<Result<_>>()?;
        let turning: Vec<&Placement> =
            placements.iter().filter(|p| p.rotating_mass > 0.0 && !quantity.is_torque()).collect();
        let rotating = (!turning.is_empty() && sweep.orders.contains(&1)).then(|| {
            // A mass on the pin: its force is all forward, and of order 1.
            let weight = |p: &Placement| p.rotating_mass * p.cylinder.crank_radius();
            let mut terms = layout.terms(&turning, weight, [1.0, 0.0]);
            for (k, &order) in sweep.orders.iter().enumerate() {
                if order != 1 {
                    terms.constants[k] = Constants::default();
                    terms.sizes[k] = 0.0;
                }
            }
            terms
        });
        let zero_factors = sweep.orders.iter().map(|&n| zero_factor(placements.len(), n)).collect();
        let mut plan = Self { groups, rotating, zero_factors, at_only_point: Vec::new() };
        if sweep.points() == 1 {
            let harmonics = plan.harmonics(sweep, &(0..1), cancel)?;
            plan.at_only_point = plan.at(&harmonics, 0).collect();
        }
        Ok(plan)
    }

    /// Harmonics of each group at a range of points.
    pub fn harmonics(
        &self,
        sweep: &Sweep,
        points: &Range<usize>,
        cancel: &Cancel,
    ) -> Result<Vec<Rows<'_>>> {
        self.groups.iter().map(|(_, harmonics)| harmonics.rows(sweep, points, cancel)).collect()
    }

    /// The orders at a point.
    pub fn at(&self, harmonics: &[Rows], point: usize) -> impl Iterator<Item = At> {
        self.zero_factors.iter().enumerate().map(move |(order, zero_factor)| {
            let (mut constants, mut size) = (Constants::default(), 0.0);
            let mut add = |terms: &Terms, factor: Complex64| {
                // The part that turns backward was conjugated, its harmonic was not.
                for (sum, constant) in constants.iter_mut().zip(&terms.constants[order]) {
                    *sum += constant * factor;
                }
                size += terms.sizes[order] * length(factor);
            };
            for ((terms, _), harmonics) in self.groups.iter().zip(harmonics) {
                add(terms, harmonics.at(point, order));
            }
            if let Some(terms) = &self.rotating {
                add(terms, Complex64::new(1.0, 0.0));
            }
            At { constants, bound: size * zero_factor }
        })
    }
}

/// |z|, without a root where z is real.
#[inline(always)]
pub(super) fn length(z: Complex64) -> f64 {
    if z.im == 0.0 { z.re.abs() } else { z.norm() }
}

/// What layout sums are taken over.
struct Layout<'a> {
    reference: f64,
    orders: &'a [u32],
    /// The banks and what is held, where the bank angle is swept.
    frame: Option<(Banks, Hold)>,
    quantity: Quantity,
}

impl Layout<'_> {
    /// Σ weight·e^{±i·bank}·e^{−in·tdc} times the shares of force that turn with and against the
    /// crank; for torque Σ weight·e^{−in·tdc}.
    fn terms(
        &self,
        members: &[&Placement],
        weight: impl Fn(&Placement) -> f64,
        shares: [f64; 2],
    ) -> Terms {
        let lever = |p: &Placement| match self.quantity {
            Quantity::Moment => (p.z - self.reference, p.z.abs() + self.reference.abs()),
            _ => (1.0, 1.0),
        };
        // Rounding of a lever is relative to what it is the difference of.
        let size: f64 = members.iter().map(|p| weight(p) * lever(p).1).sum();
        let constants = self.orders.iter().map(|&n| {
            if self.quantity.is_torque() {
                let [[cos, sin]] = self.functions(members, n, [0], &weight);
                return [cos, sin, Complex64::default(), Complex64::default()];
            }
            let [ahead, against] = self.functions(members, n, [1, -1], |p| weight(p) * lever(p).0);
            [
                ahead[0] * shares[0],
                ahead[1] * shares[0],
                against[0] * shares[1],
                against[1] * shares[1],
            ]
        });
        Terms { constants: constants.collect(), sizes: vec![size; self.orders.len()] }
    }

    /// Σ weight·e^{i(turn·bank − n·tdc)} for each turn, as constants of cosine and sine of a multiple
    /// of half the bank angle.
    fn functions<const TURNS: usize>(
        &self,
        members: &[&Placement],
        order: u32,
        turns: [i64; TURNS],
        weight: impl Fn(&Placement) -> f64,
    ) -> [[Complex64; 2]; TURNS] {
        let n = i64::from(order);
        let Some((banks, hold)) = self.frame else {
            let mut sums = [[Complex64::default(); 2]; TURNS];
            for p in members {
                let term = p.tdc.cis(-n) * weight(p);
                for (sum, &turn) in sums.iter_mut().zip(&turns) {
                    sum[0] += term * p.bank.cis(turn);
                }
            }
            return sums;
        };
        let (mut right, mut left) = (Complex64::default(), Complex64::default());
        for p in members {
            let term = p.tdc.cis(-n) * weight(p);
            *if p.bank == banks.right { &mut right } else { &mut left } += term;
        }
        if hold == Hold::Pins {
            // e^{in·pin} = e^{in·bank} e^{−in·tdc}
            right *= banks.right.cis(n);
            left *= banks.left.cis(n);
        }
        turns.map(|turn| {
            // With the pins held the phase turns with the bank: e^{i(turn − n)·bank} e^{in·pin}.
            let multiple = match hold {
                Hold::Pins => turn - n,
                Hold::Firing => turn,
            };
            let middle = banks.bisector().cis(multiple);
            // Bores at bisector ∓ γ: e^{−i·m·γ} right + e^{i·m·γ} left.
            [middle * (right + left), Complex64::i() * middle * (left - right)]
        })
    }
}
