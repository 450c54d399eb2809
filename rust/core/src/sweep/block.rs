//! Layout sums of one engine at up to [`BLOCK`] bank angles, side by side.

use super::Quantity;
use super::plan::{Constants, FUNCTIONS, Plan, Terms};
use crate::Complex64;
use crate::balance::snapped;
use crate::engine::Hold;
use crate::simd::sin_cos_degrees;

/// Bank angles that are worked out side by side; cancellation is looked at between blocks.
pub(super) const BLOCK: usize = 64;
/// Powers of `e^{iγ}` up to here come from multiplication, within the allowance of the zero bound.
const MOST_MULTIPLIED: u32 = 16;

/// One column of a block.
type Column = [f64; BLOCK];

/// Layout sums of one engine at one point, for up to [`BLOCK`] bank angles.
pub(super) struct Block {
    quantity: Quantity,
    pub count: usize,
    /// Cosine and sine of the multiples of γ, two pairs to an order.
    functions: Vec<[Column; FUNCTIONS]>,
    /// What rounding can leave, by order.
    pub bounds: Vec<f64>,
    /// Constants of the functions, by order.
    constants: Vec<Constants>,
    /// Real and imaginary part of what turns with the crank and of the conjugate of what turns
    /// against it (of the torque and nothing), by order.
    sums: Vec<[Column; FUNCTIONS]>,
}

impl Block {
    pub fn new(plan: &Plan) -> Self {
        let empty = vec![[[0.0; BLOCK]; FUNCTIONS]; plan.orders.len()];
        Self {
            quantity: plan.quantity,
            count: 0,
            functions: empty.clone(),
            bounds: vec![0.0; plan.orders.len()],
            constants: vec![Constants::default(); plan.orders.len()],
            sums: empty,
        }
    }

    /// The functions of γ at these bank angles.
    #[inline(always)]
    pub fn set_angles(&mut self, plan: &Plan, bank_angles: &[f64]) {
        self.count = bank_angles.len();
        let Some(hold) = plan.hold else {
            // Cosines of nothing.
            for [ahead, _, against, _] in &mut self.functions {
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
        sin_cos_degrees(&half, &mut sin, &mut cos);
        // Powers are reached from the last one, orders being mostly ascending.
        let (mut power, mut power_cos, mut power_sin) = (1, cos, sin);
        for (&order, functions) in plan.orders.iter().zip(&mut self.functions) {
            let n = i64::from(order);
            let turns = match (hold, plan.quantity) {
                (Hold::Pins, Quantity::Torque) => [-n, 0],
                (Hold::Pins, _) => [1 - n, -1 - n],
                (Hold::Firing, Quantity::Torque) => [0, 0],
                (Hold::Firing, _) => [1, -1],
            };
            for (turn, pair) in turns.into_iter().zip(functions.chunks_exact_mut(2)) {
                let [out_cos, out_sin] = pair else { continue };
                let multiple = turn.unsigned_abs() as u32;
                let sign = if turn < 0 { -1.0 } else { 1.0 };
                if multiple == 0 {
                    out_cos.fill(1.0);
                    out_sin.fill(0.0);
                    continue;
                }
                if multiple > MOST_MULTIPLIED {
                    let multiples = half.map(|angle| angle * turn as f64);
                    sin_cos_degrees(&multiples, out_sin, out_cos);
                    continue;
                }
                if multiple < power {
                    (power, power_cos, power_sin) = (1, cos, sin);
                }
                while power < multiple {
                    for i in 0..BLOCK {
                        let (re, im) = (power_cos[i], power_sin[i]);
                        power_cos[i] = re * cos[i] - im * sin[i];
                        power_sin[i] = re * sin[i] + im * cos[i];
                    }
                    power += 1;
                }
                *out_cos = power_cos;
                for i in 0..BLOCK {
                    out_sin[i] = sign * power_sin[i];
                }
            }
        }
    }

    /// The constants of an engine at a point, times ω² or 1.
    pub fn set_terms(&mut self, terms: &Terms, scale: f64) {
        for (order, constants) in terms.constants.iter().enumerate() {
            self.constants[order] = constants.map(|constant| constant * scale);
            self.bounds[order] = terms.sizes[order] * scale;
        }
    }

    /// Functions times constants, for every order and angle.
    pub fn evaluate(&mut self) {
        for (order, sums) in self.sums.iter_mut().enumerate() {
            for i in 0..self.count {
                let at = turning(&self.functions[order], &self.constants[order], i);
                for (sum, value) in sums.iter_mut().zip(at) {
                    sum[i] = value;
                }
            }
        }
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
        components.map(|phasor| snapped(phasor, self.bounds[order]))
    }

    /// Phasors of all orders at one angle, component by component.
    pub fn by_component(&self, i: usize) -> [Vec<Complex64>; 2] {
        let phasors: Vec<_> = (0..self.bounds.len()).map(|order| self.phasors(order, i)).collect();
        [0, 1].map(|component| phasors.iter().map(|both| both[component]).collect())
    }

    /// Magnitudes of the phasors: out[angle][order][component].
    #[inline(always)]
    pub fn peaks(&self, out: &mut [f64]) {
        let components = self.quantity.components();
        let width = self.bounds.len() * components;
        // Two orders at a time, so that rows are written four numbers at once.
        let mut columns = [[0.0; BLOCK]; 4];
        for first in (0..self.bounds.len()).step_by(2) {
            let orders = (self.bounds.len() - first).min(2);
            for (order, pair) in (first..).zip(columns.chunks_exact_mut(2)).take(orders) {
                let [along, across] = pair else { continue };
                match self.quantity {
                    Quantity::Moment => self.magnitudes(order, across, along),
                    _ => self.magnitudes(order, along, across),
                }
            }
            let [a, b, c, d] = &columns;
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
    }

    /// |forward + conj backward| and |forward − conj backward| of one order.
    #[inline(always)]
    fn magnitudes(&self, order: usize, along: &mut Column, across: &mut Column) {
        let (functions, constants) = (&self.functions[order], &self.constants[order]);
        let bound = self.bounds[order] * self.bounds[order];
        let magnitude = |re: f64, im: f64| {
            let square = re.mul_add(re, im * im);
            if square > bound { square.sqrt() } else { 0.0 }
        };
        // In one loop with the square roots, the products cost next to nothing.
        for i in 0..BLOCK {
            let [ahead_re, ahead_im, against_re, against_im] = turning(functions, constants, i);
            along[i] = magnitude(ahead_re + against_re, ahead_im + against_im);
            across[i] = magnitude(ahead_re - against_re, ahead_im - against_im);
        }
    }
}

/// Real and imaginary part of what turns with the crank, and of the conjugate of what turns against
/// it, at one angle.
#[inline(always)]
fn turning(
    [a, b, c, d]: &[Column; FUNCTIONS],
    [ka, kb, kc, kd]: &Constants,
    i: usize,
) -> [f64; FUNCTIONS] {
    [
        a[i].mul_add(ka.re, b[i] * kb.re),
        a[i].mul_add(ka.im, b[i] * kb.im),
        c[i].mul_add(kc.re, d[i] * kd.re),
        c[i].mul_add(kc.im, d[i] * kd.im),
    ]
}
