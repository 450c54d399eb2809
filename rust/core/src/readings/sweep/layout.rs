//! What an engine's layout contributes to a sweep: sums that rod, speed and bank angle multiply.

use super::{Quantity, Sweep};
use crate::Complex64;
use crate::gear::slider_crank::Cylinder;
use crate::load::{Alike, Channel, Loads, Turn};
use crate::numbers::error::Result;
use crate::wrench::rounding;

/// Sums of one channel of an order, over its amplitude.
pub(super) struct Sum {
    pub channel: Channel,
    /// A, B and K as the kernel has them, each forward and backward.
    pub constants: [Complex64; 6],
    /// Bound of the rounding error.
    pub bound: f64,
}

/// Layout sums of one engine, order by order.
pub(super) struct Layout {
    pub by_order: Vec<Vec<Sum>>,
    /// A gear of each motion.
    pub motions: Vec<Cylinder>,
}

impl Layout {
    pub fn new(sweep: &Sweep, engine: usize, quantity: Quantity) -> Result<Self> {
        let loads = sweep.loads(engine);
        let engine = &sweep.engines[engine];
        let vee = match &sweep.axes.bank_angle {
            Some((_, hold)) => Some((engine.banks()?, *hold)),
            None => None,
        };
        let mut by_order = Vec::with_capacity(sweep.orders.len());
        for &order in &sweep.orders {
            let Some(whole) = order.as_whole() else {
                by_order.push(Vec::new());
                continue;
            };
            let rounding = rounding(loads.list.len(), order.number());
            let mut sums: Vec<Sum> = Vec::new();
            for (channel, bank, parts, size) in parts(&loads, quantity, whole, vee.is_some()) {
                let known = sums.iter().position(|sum| sum.channel == channel);
                let known = known.unwrap_or_else(|| {
                    let constants = [Complex64::default(); 6];
                    sums.push(Sum { channel, constants, bound: 0.0 });
                    sums.len() - 1
                });
                let sum = &mut sums[known];
                sum.bound += size * rounding;
                let Some((bank, (banks, hold))) = bank.zip(vee) else {
                    sum.constants[4] += parts[0];
                    sum.constants[5] += parts[1];
                    continue;
                };
                let is_right = bank == banks.right;
                let bore = banks.directions[usize::from(!is_right)];
                let to_bisector = banks.bisector() - bore;
                for (k, multiple) in quantity.turn(order, hold).into_iter().enumerate() {
                    let turned = parts[k] * to_bisector.cis(multiple);
                    // e^{−imγ} of the right bank, e^{imγ} of the left.
                    let sine = Complex64::i() * turned;
                    sum.constants[k] += turned;
                    sum.constants[2 + k] += if is_right { -sine } else { sine };
                }
            }
            by_order.push(sums);
        }
        Ok(Self { by_order, motions: loads.motions })
    }
}

/// The loads' sums of a quantity: channel, bank, forward part and conjugate of the backward part (or
/// torque and nothing), Σ|terms|.
fn parts(
    loads: &Loads,
    quantity: Quantity,
    order: u32,
    by_bank: bool,
) -> Vec<(Channel, Option<usize>, [Complex64; 2], f64)> {
    match quantity {
        Quantity::Force | Quantity::Moment => {
            let sums = loads.planar(order, by_bank).into_iter().map(|sum| {
                let vector = if quantity == Quantity::Force { sum.force } else { sum.moment };
                let parts = [vector.forward, vector.backward_conj];
                (sum.channel, sum.bank, parts, vector.size)
            });
            sums.collect()
        }
        Quantity::Torque | Quantity::CrankTorque => {
            let sums = loads.roll(order, by_bank).into_iter();
            // A shaft that turns evenly takes no torque of the crank.
            let sums = sums
                .filter(|sum| quantity == Quantity::Torque || sum.channel != Channel::Unit)
                .map(|sum| (sum.channel, sum.bank, [sum.sum, Complex64::default()], sum.size));
            sums.collect()
        }
    }
}

impl Sweep {
    /// Loads of an engine.
    pub(super) fn loads(&self, engine: usize) -> Loads {
        let alike = if self.spectrum.is_some() { Alike::All } else { Alike::Dimensions };
        Loads::new(&self.engines[engine], self.references[engine], alike)
    }
}

impl Quantity {
    /// Multiples of half the bank angle for the forward part (or torque) and for the conjugate of
    /// the backward part.
    pub(super) fn turn(self, order: crate::Order, hold: crate::Hold) -> [i64; 2] {
        let turn = Turn::new(order.as_whole().unwrap_or(0), hold);
        match self {
            Self::Force | Self::Moment => [turn.forward, turn.backward_conj],
            Self::Torque | Self::CrankTorque => [turn.roll, 0],
        }
    }
}
