//! What each part of an engine adds to force or moment, and the findings that follow from it.

use super::SMALLEST_MENTIONED;
use super::finding::{Acting, Finding, Reason, Weights};
use crate::Complex64;
use crate::engine::{CrankIndex, Engine, Origin};
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::readings::balance::{Balance, Vector};
use crate::readings::exact::vanishing::{ProofQuantity, ZeroProofs};
use crate::readings::turning::cranks_by_sense;
use crate::wrench::{Planar, tilt_deg};

/// Phasors that differ by less of the largest are taken for equal.
const EQUAL_PHASORS: f64 = 1e-9;
/// Highest order for which balance shafts are named: faster ones are hardly built.
const REMOVABLE: u32 = 2;
/// Steps of phases that are as good as equal.
const SAME_PULLS: f64 = 1e-6;

/// Forward and backward part.
type BothSenses = [Complex64; 2];

/// Force or moment of an engine: its orders, and what each part adds to them.
pub(super) struct VectorSums<'a> {
    engine: &'a Engine,
    proofs: &'a ZeroProofs<'a>,
    /// Places of the cylinders from the reference plane, m.
    levers: &'a [f64],
    vector: Vector,
    /// One piston's first-order force, or that at the longest lever.
    size: f64,
    orders: &'a [Order],
    whole: Vec<BothSenses>,
    tilts_deg: Vec<f64>,
    peaks: Vec<f64>,
    /// Of each cylinder, order by order.
    cylinders: Vec<Vec<BothSenses>>,
    /// Of counterweights and of balance shafts, where there are any.
    hardware: [Option<Vec<BothSenses>>; 2],
}

fn parts_of(planar: &Planar) -> BothSenses {
    [planar.forward, planar.backward()]
}

fn sizes([forward, backward]: BothSenses) -> [f64; 2] {
    [forward.norm(), backward.norm()]
}

fn larger(parts: BothSenses) -> f64 {
    let [forward, backward] = sizes(parts);
    forward.max(backward)
}

fn plus(a: BothSenses, b: BothSenses) -> BothSenses {
    [a[0] + b[0], a[1] + b[1]]
}

impl<'a> VectorSums<'a> {
    /// Of a balance, and what each part adds to it.
    pub fn new(
        (engine, proofs): (&'a Engine, &'a ZeroProofs<'a>),
        levers: &'a [f64],
        (vector, size): (Vector, f64),
        balance: &'a Balance,
        terms: &[(Origin, Balance)],
    ) -> Self {
        let count = balance.orders.len();
        let of = |balance: &Balance| -> Vec<BothSenses> {
            (0..count).map(|k| parts_of(balance.planar(vector, k))).collect()
        };
        let mut cylinders = Vec::new();
        let mut hardware = [const { None }; 2];
        for (origin, part) in terms {
            if origin.cylinder().is_some() {
                cylinders.push(of(part));
                continue;
            }
            // On cranks, or on shafts.
            let group = usize::from(engine.crank_with(*origin).is_none());
            let sums = hardware[group].get_or_insert_with(|| vec![BothSenses::default(); count]); // bounded: by a balance's orders
            sums.iter_mut().zip(of(part)).for_each(|(sum, added)| *sum = plus(*sum, added));
        }
        let whole = of(balance);
        let peaks = (0..count).map(|k| balance.planar(vector, k).peak()).collect();
        let tilts_deg = whole.iter().map(|&[f, b]| tilt_deg(f, b).unwrap_or(0.0)).collect();
        let orders = &balance.orders;
        Self {
            engine,
            proofs,
            levers,
            vector,
            size,
            orders,
            whole,
            tilts_deg,
            peaks,
            cylinders,
            hardware,
        }
    }

    /// Whether an order is worth mention.
    fn shakes(&self, k: usize) -> bool {
        self.peaks[k] > SMALLEST_MENTIONED * self.size && self.peaks[k] > 0.0
    }

    /// Places of the orders that are worth mention.
    pub fn shaking(&self) -> impl Iterator<Item = usize> {
        (0..self.orders.len()).filter(|&k| self.shakes(k))
    }

    /// Sum of the peaks of the others.
    pub fn rest(&self) -> f64 {
        (0..self.orders.len()).filter(|&k| !self.shakes(k)).fold(0.0, |sum, k| sum + self.peaks[k])
    }

    /// How large an order is, in units; infinite of shafts without pistons.
    pub fn share(&self, k: usize) -> f64 {
        if self.size == 0.0 { f64::INFINITY } else { self.peaks[k] / self.size }
    }

    /// Whether pistons make an order, of which this is the force.
    pub fn is_made(&self, k: usize) -> bool {
        let made: f64 = self.cylinders.iter().flat_map(|of_orders| sizes(of_orders[k])).sum();
        made > SMALLEST_MENTIONED * self.size
    }

    /// What counterweights and shafts do.
    pub fn of_hardware(&self) -> Result<Vec<Finding>> {
        (0..self.orders.len()).filter_map(|k| self.hardware_of(k).transpose()).collect()
    }

    fn hardware_of(&self, k: usize) -> Result<Option<Finding>> {
        let acts = |added: &Option<Vec<BothSenses>>| {
            let added = added.as_ref()?[k];
            (sizes(added).iter().sum::<f64>() > SMALLEST_MENTIONED * self.size).then_some(added)
        };
        let (acting, added) = match self.hardware.each_ref().map(acts) {
            [None, None] => return Ok(None),
            [Some(weights), None] => (Acting::Counterweights, vec![weights]),
            [None, Some(shafts)] => (Acting::Shafts, vec![shafts]),
            [Some(weights), Some(shafts)] => (Acting::Both, vec![weights, shafts]),
        };
        let all = added.iter().fold(BothSenses::default(), |sum, &parts| plus(sum, parts));
        let least = EQUAL_PHASORS * added.iter().map(|&parts| larger(parts)).fold(0.0, f64::max);
        let without = [0, 1].map(|sense| self.whole[k][sense] - all[sense]);
        let before = sizes(without).map(|part| if part <= least { 0.0 } else { part });
        let after = sizes(self.whole[k]);
        let (vector, order) = (self.vector, self.orders[k]);
        let gone = (0..2).filter(|&sense| before[sense] != 0.0 && after[sense] == 0.0);
        let gone: Vec<_> = gone.map(|sense| ProofQuantity::senses(vector)[sense]).collect();
        let proved = !gone.is_empty() && self.proofs.vanish(&gone, order)?;
        Ok(Some(Finding::Hardware { vector, order, before, after, acting, proved }))
    }

    /// What an order leaves.
    pub fn left(&self, k: usize) -> Finding {
        Finding::Shakes {
            vector: self.vector,
            order: self.orders[k],
            parts: sizes(self.whole[k]),
            tilt_deg: self.tilts_deg[k],
            together: self.vector == Vector::Force && self.pull_together(k),
        }
    }

    /// What would remove it.
    pub fn remedy(&self, k: usize) -> Option<Finding> {
        let order = Some(self.orders[k]).filter(|order| order.halves() <= 2 * REMOVABLE)?;
        let [forward, backward] = sizes(self.whole[k]);
        let parts =
            [(SpeedRatio::at(order, true), forward), (SpeedRatio::at(order, false), backward)];
        // A part that would not be mentioned alone is not worth hardware of its own; a weight on a crank
        // turns with it.
        let worth = parts.map(|(_, part)| part > SMALLEST_MENTIONED * self.size);
        if worth == [false; 2] {
            return None;
        }
        // Weights on faster cranks have other orders.
        let cranks = cranks_by_sense(self.engine);
        let weighed = [0, 1]
            .map(|sense| worth[sense] && order == Order::FIRST && !cranks[sense].1.is_empty());
        let reached = if weighed == [false; 2] { worth } else { weighed };
        let kept = (0..2).filter(|&sense| !reached[sense]);
        let kept = kept.fold(0.0, |sum, sense| sum + parts[sense].1);
        let shafts = (0..2).filter(|&sense| worth[sense] && !weighed[sense]);
        let weights = match weighed {
            [false, false] => Weights::No,
            [true, false] if cranks[0].1 == [CrankIndex::MAIN] => Weights::OnMain,
            _ => Weights::OnCranks,
        };
        Some(Finding::Remedy {
            vector: self.vector,
            order: self.orders[k],
            kept,
            shafts: shafts.map(|sense| parts[sense].0).collect(),
            weights,
        })
    }

    /// Whether all pistons pull at once, each along its own bore.
    fn pull_together(&self, k: usize) -> bool {
        let pulls: Vec<Complex64> = (0..self.cylinders.len()).map(|i| self.pull(k, i)).collect();
        let sizes = || pulls.iter().map(|pull| pull.norm());
        let (smallest, largest) = sizes()
            .fold((f64::INFINITY, 0.0_f64), |(low, high), size| (low.min(size), high.max(size)));
        let together = pulls.iter().sum::<Complex64>().norm();
        pulls.len() > 1
            && smallest > 0.0
            && (sizes().sum::<f64>() - together).abs() <= EQUAL_PHASORS * largest
    }

    /// Half the pull of a piston along its bore.
    fn pull(&self, k: usize, cylinder: usize) -> Complex64 {
        let [forward, backward] = self.cylinders[cylinder][k];
        let along = self.engine.stations()[cylinder].bank.cis(-1);
        // What rotates has no part that turns against its own crank.
        if self.engine.cranks()[self.engine.crank_of(cylinder)].ratio.is_forward() {
            (backward * along).conj()
        } else {
            forward * along
        }
    }

    // --- why orders cancel ---

    /// Why orders are zero that pistons make, those of one reason together.
    pub fn cancelling(&self, made: &[bool], banks: &[Vec<usize>]) -> Result<Vec<Finding>> {
        let mut found: Vec<Finding> = Vec::new();
        let all: Vec<usize> = (0..self.cylinders.len()).collect();
        for (k, &is_made) in made.iter().enumerate() {
            if !is_made || self.peaks[k] != 0.0 || !self.cancel(k, &all) {
                continue;
            }
            let (why, groups) = self.reason(k, banks);
            let both = ProofQuantity::components(self.vector);
            let is_proved = self.proofs.vanish(&both, self.orders[k])?;
            let same = found.iter_mut().find_map(|finding| match finding {
                Finding::Cancels { orders, reason, pairs, proved, .. } => {
                    (*reason == why && *pairs == groups && *proved == is_proved).then_some(orders)
                }
                _ => None,
            });
            match same {
                Some(orders) => orders.push(self.orders[k]),
                None => found.push(Finding::Cancels {
                    vector: self.vector,
                    orders: vec![self.orders[k]],
                    reason: why,
                    pairs: groups,
                    proved: is_proved,
                }),
            }
        }
        Ok(found)
    }

    fn largest(&self, k: usize) -> f64 {
        self.cylinders.iter().map(|of_orders| larger(of_orders[k])).fold(0.0, f64::max)
    }

    /// Whether some cylinders cancel each other.
    fn cancel(&self, k: usize, members: &[usize]) -> bool {
        let added = members.iter().map(|&i| self.cylinders[i][k]);
        larger(added.fold(BothSenses::default(), plus)) <= EQUAL_PHASORS * self.largest(k)
    }

    /// Why the cylinders' sum is zero, and which cylinders cancel in pairs.
    fn reason(&self, k: usize, banks: &[Vec<usize>]) -> (Reason, Vec<[usize; 2]>) {
        if self.largest(k) == 0.0 {
            return (Reason::Plane, Vec::new());
        }
        if let Some(pairs) = self.pairs(k) {
            let longest = self.levers.iter().fold(0.0, |most: f64, lever| most.max(lever.abs()));
            let is_mirrored = |&[one, other]: &[usize; 2]| {
                (self.levers[one] + self.levers[other]).abs() <= EQUAL_PHASORS * longest
            };
            let mirrored = self.vector == Vector::Moment && pairs.iter().all(is_mirrored);
            return (if mirrored { Reason::Mirrored } else { Reason::Pairs }, pairs);
        }
        let reason = if !banks.iter().all(|bank| self.cancel(k, bank)) {
            Reason::Between
        } else if self.vector == Vector::Force && banks.iter().all(|bank| self.pull_evenly(k, bank))
        {
            Reason::Evenly
        } else {
            Reason::Each
        };
        (reason, Vec::new())
    }

    /// Whether the pistons of a bank pull as strongly, at even intervals.
    fn pull_evenly(&self, k: usize, bank: &[usize]) -> bool {
        let pulls: Vec<Complex64> = bank.iter().map(|&i| self.pull(k, i)).collect();
        let largest = pulls.iter().map(|pull| pull.norm()).fold(0.0, f64::max);
        let first = pulls[0] / largest;
        if first.norm() <= SAME_PULLS {
            return false; // one that does not pull
        }
        let key = |pull: Complex64| {
            let turned = pull / largest / first / SAME_PULLS;
            [turned.re.round_ties_even() as i64, turned.im.round_ties_even() as i64]
        };
        let mut counts = std::collections::BTreeMap::new();
        for &pull in &pulls {
            *counts.entry(key(pull)).or_insert(0) += 1;
        }
        let power = |pull: Complex64| pull.powu(counts.len() as u32);
        let same = |&pull: &Complex64| (power(pull / largest) - power(first)).norm() <= SAME_PULLS;
        let times = counts.values().next();
        counts.values().all(|count| Some(count) == times) && pulls.iter().all(same)
    }

    /// Pairs of cylinders that cancel: of one bank, or moments at opposite levers.
    fn pairs(&self, k: usize) -> Option<Vec<[usize; 2]>> {
        let least = EQUAL_PHASORS * self.largest(k);
        let far = |one: usize, other: usize| match self.vector {
            Vector::Moment => (self.levers[one] + self.levers[other]).abs(),
            Vector::Force => f64::from(self.engine.bank_of(one) != self.engine.bank_of(other)),
        };
        let adds = |&i: &usize| larger(self.cylinders[i][k]) > least;
        let mut free: Vec<usize> = (0..self.cylinders.len()).filter(adds).collect();
        let mut pairs = Vec::new();
        while let [one, rest @ ..] = &free[..] {
            let one = *one;
            let opposite = rest.iter().copied().filter(|&other| {
                larger(plus(self.cylinders[one][k], self.cylinders[other][k])) <= least
            });
            let other = opposite.min_by(|&a, &b| far(one, a).total_cmp(&far(one, b)))?;
            free.retain(|&i| i != one && i != other);
            pairs.push([one, other]);
        }
        Some(pairs)
    }
}
