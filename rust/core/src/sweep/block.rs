//! Layout sums of one engine at up to [`BLOCK`] rows of a sweep, side by side.

use std::borrow::Cow;
use std::mem;

use super::Quantity;
use super::harmonics::Rows;
use super::plan::{At, Constants, EnginePlan, FUNCTIONS, Plan, Terms, length};
use crate::Complex64;
use crate::balance::snapped;
use crate::engine::Hold;
use crate::simd::sin_cos_degrees;

/// Rows that are worked out side by side.
pub(super) const BLOCK: usize = 128;
/// Powers of `e^{iγ}` up to here come from multiplication, within the allowance of the zero bound.
const MOST_MULTIPLIED: u32 = 16;

/// Rows that one instruction works on, at most.
const LANES: usize = 8;

/// One column of a block.
type Column = [f64; BLOCK];

/// Cosine and sine of the multiples of γ, two pairs to an order, at up to [`BLOCK`] bank angles.
#[derive(Clone)]
pub(super) struct Functions {
    by_order: Vec<[Column; FUNCTIONS]>,
    lanes: usize,
}

/// Layout sums of one engine, for up to [`BLOCK`] rows side by side: bank angles at one point of the
/// other axes, or such points at one bank angle. Either way a row's numbers come from the same
/// operations in the same order, so that they do not depend on what else is swept.
pub(super) struct Block<'a> {
    quantity: Quantity,
    /// How much of the columns is used.
    lanes: usize,
    functions: Cow<'a, Functions>,
    /// Place of the first bank angle that functions were worked out for.
    first_angle: Option<usize>,
    /// The engine at a point of the other axes, by order, where rows are bank angles.
    at: Vec<At>,
    /// Whether rows are points of the other axes: sums are ready.
    by_point: bool,
    /// What rounding can leave, by order.
    pub bounds: Vec<Column>,
    /// Real and imaginary part of what turns with the crank and of the conjugate of what turns
    /// against it (of the torque and nothing), by order.
    sums: Vec<[Column; FUNCTIONS]>,
    /// Room for the magnitudes of two orders.
    magnitudes: Vec<Column>,
}

impl Functions {
    pub fn new(plan: &Plan) -> Self {
        Self { by_order: vec![[[0.0; BLOCK]; FUNCTIONS]; plan.orders.len()], lanes: BLOCK }
    }

    /// Their values at these bank angles.
    #[inline(always)]
    pub fn set(&mut self, plan: &Plan, bank_angles: &[f64]) {
        self.lanes = lanes(bank_angles.len());
        let lanes = lanes(bank_angles.len());
        let Some(hold) = plan.hold else {
            // Cosines of nothing.
            for [ahead, _, against, _] in &mut self.by_order {
                ahead.fill(1.0);
                against.fill(1.0);
            }
            return;
        };
        let mut half = [0.0; BLOCK];
        for (half, angle) in half.iter_mut().zip(bank_angles) {
            *half = 0.5 * angle;
        }
        let (mut sin, mut cos) = ([0.0; BLOCK], [0.0; BLOCK]);
        sin_cos_degrees(&half[..lanes], &mut sin, &mut cos);
        // Powers are reached from the last one, orders being mostly ascending.
        let (mut power, mut power_cos, mut power_sin) = (1, cos, sin);
        for (&order, functions) in plan.orders.iter().zip(&mut self.by_order) {
            let n = i64::from(order);
            let torque = plan.quantity.is_torque();
            let turns = match hold {
                Hold::Pins if torque => [-n, 0],
                Hold::Pins => [1 - n, -1 - n],
                Hold::Firing if torque => [0, 0],
                Hold::Firing => [1, -1],
            };
            for (turn, pair) in turns.into_iter().zip(functions.chunks_exact_mut(2)) {
                let [out_cos, out_sin] = pair else { continue };
                let multiple = turn.unsigned_abs() as u32;
                if multiple == 0 {
                    out_cos.fill(1.0);
                    out_sin.fill(0.0);
                    continue;
                }
                if multiple > MOST_MULTIPLIED {
                    let multiples = half.map(|angle| angle * turn as f64);
                    sin_cos_degrees(&multiples[..lanes], out_sin, out_cos);
                    continue;
                }
                if multiple < power {
                    (power, power_cos, power_sin) = (1, cos, sin);
                }
                for _ in power..multiple {
                    for i in 0..lanes {
                        let (re, im) = (power_cos[i], power_sin[i]);
                        power_cos[i] = re * cos[i] - im * sin[i];
                        power_sin[i] = re * sin[i] + im * cos[i];
                    }
                }
                power = multiple;
                *out_cos = power_cos;
                let sign = turn.signum() as f64;
                for i in 0..lanes {
                    out_sin[i] = sign * power_sin[i];
                }
            }
        }
    }
}

impl<'a> Block<'a> {
    pub fn new(plan: &Plan) -> Self {
        let orders = plan.orders.len();
        Self {
            quantity: plan.quantity,
            lanes: 0,
            functions: Cow::Owned(Functions::new(plan)),
            first_angle: None,
            at: vec![At::default(); orders],
            by_point: false,
            bounds: vec![[0.0; BLOCK]; orders],
            sums: vec![[[0.0; BLOCK]; FUNCTIONS]; orders],
            magnitudes: vec![[0.0; BLOCK]; 4],
        }
    }

    /// Take the functions at these bank angles, which somebody else has worked out.
    pub fn share(&mut self, functions: &'a Functions) {
        self.lanes = functions.lanes;
        self.functions = Cow::Borrowed(functions);
        self.first_angle = None;
    }

    /// Work out the functions at these bank angles, the first of which has this place among all, if
    /// they are not there from the last time.
    #[inline(always)]
    pub fn set_angles(&mut self, plan: &Plan, bank_angles: &[f64], first: usize) {
        if self.first_angle != Some(first) {
            self.functions.to_mut().set(plan, bank_angles);
            self.first_angle = Some(first);
        }
        self.lanes = self.functions.lanes;
    }

    /// An engine at a point of the other axes; rows are the bank angles of the functions.
    pub fn set_point(&mut self, at: impl Iterator<Item = At>) {
        self.at.iter_mut().zip(at).for_each(|(place, at)| *place = at);
    }

    /// An engine at so many points of the other axes from the first; rows are the points, all at the
    /// first bank angle of the functions.
    #[inline(always)]
    pub fn set_points(
        &mut self,
        engine: &EnginePlan,
        harmonics: &[Rows],
        first: usize,
        count: usize,
    ) {
        (self.lanes, self.by_point) = (lanes(count), true);
        let lanes = lanes(count);
        for order in 0..self.sums.len() {
            let mut constants = [[[0.0; BLOCK]; 2]; FUNCTIONS];
            let mut sizes = [0.0; BLOCK];
            let mut add = |terms: &Terms, factors: &[Column; 2], lengths: &Column| {
                for ([re, im], constant) in constants.iter_mut().zip(&terms.constants[order]) {
                    for i in 0..lanes {
                        re[i] += constant.re * factors[0][i] - constant.im * factors[1][i];
                        im[i] += constant.re * factors[1][i] + constant.im * factors[0][i];
                    }
                }
                for i in 0..lanes {
                    sizes[i] += terms.sizes[order] * lengths[i];
                }
            };
            let (mut factors, mut lengths) = ([[0.0; BLOCK]; 2], [0.0; BLOCK]);
            for (terms, harmonics) in engine.groups.iter().zip(harmonics) {
                for i in 0..count {
                    let factor = harmonics.at(first + i, order);
                    (factors[0][i], factors[1][i]) = (factor.re, factor.im);
                    lengths[i] = length(factor);
                }
                add(&terms.0, &factors, &lengths);
            }
            if let Some(terms) = &engine.rotating {
                add(terms, &[[1.0; BLOCK], [0.0; BLOCK]], &[1.0; BLOCK]);
            }
            let [a, b, c, d] = self.functions.by_order[order].each_ref().map(|column| column[0]);
            let [ka, kb, kc, kd] = &constants;
            for i in 0..lanes {
                let at = [ka, kb, kc, kd].map(|k| Complex64::new(k[0][i], k[1][i]));
                for (sum, value) in self.sums[order].iter_mut().zip(turning([a, b, c, d], &at)) {
                    sum[i] = value;
                }
                self.bounds[order][i] = sizes[i] * engine.zero_factors[order];
            }
        }
    }

    /// Functions times constants, for every order and row.
    #[inline(always)]
    pub fn evaluate(&mut self) {
        if self.by_point {
            return;
        }
        let lanes = self.lanes();
        for (order, sums) in self.sums.iter_mut().enumerate() {
            let (functions, At { constants, bound }) =
                (&self.functions.by_order[order], &self.at[order]);
            self.bounds[order][..lanes].fill(*bound);
            for i in 0..lanes {
                let at = turning(functions.each_ref().map(|column| column[i]), constants);
                for (sum, value) in sums.iter_mut().zip(at) {
                    sum[i] = value;
                }
            }
        }
    }

    /// How much of the columns is used; the compiler sees that it is no more than there is.
    #[inline(always)]
    fn lanes(&self) -> usize {
        self.lanes.min(BLOCK)
    }

    /// Forward and conjugate of backward part of force or moment (torque and nothing).
    pub fn turning(&self, order: usize, i: usize) -> [Complex64; 2] {
        let [a, b, c, d] = &self.sums[order];
        [Complex64::new(a[i], b[i]), Complex64::new(c[i], d[i])]
    }

    /// Phasors of the components (for torque the first is it), zero where rounding is all there is.
    pub fn phasors(&self, order: usize, i: usize) -> [Complex64; 2] {
        let [ahead, against] = self.turning(order, i);
        let (along, across) = (ahead + against, -Complex64::i() * (ahead - against));
        // A moment is its levered force turned by a quarter.
        let components = match self.quantity {
            Quantity::Moment => [-across, along],
            _ => [along, across],
        };
        components.map(|phasor| snapped(phasor, self.bounds[order][i]))
    }

    /// Phasors of all orders of one row, component by component.
    pub fn by_component(&self, i: usize) -> [Vec<Complex64>; 2] {
        let phasors: Vec<_> = (0..self.bounds.len()).map(|order| self.phasors(order, i)).collect();
        [0, 1].map(|component| phasors.iter().map(|both| both[component]).collect())
    }

    /// Magnitudes of the phasors times a factor: out[row][order][component].
    #[inline(always)]
    pub fn peaks(&mut self, factor: f64, out: &mut [f64]) {
        let components = self.quantity.components();
        let width = self.bounds.len() * components;
        // Two orders at a time, so that rows are written four numbers at once.
        let mut columns = mem::take(&mut self.magnitudes);
        for first in (0..self.bounds.len()).step_by(2) {
            let orders = (self.bounds.len() - first).min(2);
            for (order, pair) in (first..).zip(columns.chunks_exact_mut(2)).take(orders) {
                let [along, across] = pair else { continue };
                match self.quantity {
                    Quantity::Moment => self.magnitudes(order, factor, across, along),
                    _ => self.magnitudes(order, factor, along, across),
                }
            }
            let [a, b, c, d] = &columns[..] else { continue };
            let rows = out.chunks_exact_mut(width);
            match (orders * components, width) {
                (4, 4) => {
                    let (rows, _) = out.as_chunks_mut::<4>();
                    for (i, row) in rows.iter_mut().enumerate().take(BLOCK) {
                        *row = [a[i], b[i], c[i], d[i]];
                    }
                }
                (4, _) => rows.zip(0..BLOCK).for_each(|(row, i)| {
                    row[2 * first..2 * first + 4].copy_from_slice(&[a[i], b[i], c[i], d[i]]);
                }),
                (2, _) if components == 2 => rows.zip(0..BLOCK).for_each(|(row, i)| {
                    row[2 * first..].copy_from_slice(&[a[i], b[i]]);
                }),
                (2, _) => rows.zip(0..BLOCK).for_each(|(row, i)| {
                    row[first..first + 2].copy_from_slice(&[a[i], c[i]]);
                }),
                _ => rows.zip(0..BLOCK).for_each(|(row, i)| row[first] = a[i]),
            }
        }
        self.magnitudes = columns;
    }

    /// |forward + conj backward| and |forward − conj backward| of one order.
    #[inline(always)]
    fn magnitudes(&self, order: usize, factor: f64, along: &mut Column, across: &mut Column) {
        let lanes = self.lanes();
        let both = |[ahead_re, ahead_im, against_re, against_im]: [f64; FUNCTIONS], bound: f64| {
            let square = bound * bound;
            [
                factor * magnitude(ahead_re + against_re, ahead_im + against_im, square),
                factor * magnitude(ahead_re - against_re, ahead_im - against_im, square),
            ]
        };
        if self.by_point {
            let (sums, bounds) = (&self.sums[order], &self.bounds[order]);
            for i in 0..lanes {
                [along[i], across[i]] = both(sums.each_ref().map(|column| column[i]), bounds[i]);
            }
            return;
        }
        let (functions, At { constants, bound }) =
            (&self.functions.by_order[order], &self.at[order]);
        // In one loop with the square roots, the products cost next to nothing.
        for i in 0..lanes {
            let at = turning(functions.each_ref().map(|column| column[i]), constants);
            [along[i], across[i]] = both(at, *bound);
        }
    }
}

/// How much of a column so many rows use: rows past the last, up to a whole instruction, are worked
/// out as well.
#[inline(always)]
fn lanes(rows: usize) -> usize {
    rows.next_multiple_of(LANES).min(BLOCK)
}

/// Length of a phasor, 0 where its square is within a bound's.
#[inline(always)]
fn magnitude(re: f64, im: f64, bound: f64) -> f64 {
    let square = re.mul_add(re, im * im);
    if square > bound { square.sqrt() } else { 0.0 }
}

/// Real and imaginary part of what turns with the crank, and of the conjugate of what turns against
/// it.
#[inline(always)]
fn turning([a, b, c, d]: [f64; FUNCTIONS], [ka, kb, kc, kd]: &Constants) -> [f64; FUNCTIONS] {
    [
        a.mul_add(ka.re, b * kb.re),
        a.mul_add(ka.im, b * kb.im),
        c.mul_add(kc.re, d * kd.re),
        c.mul_add(kc.im, d * kd.im),
    ]
}
