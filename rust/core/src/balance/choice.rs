//! The fewest orders that reach a tolerance, and the bound of what they leave out.

use super::sums::Sums;
use super::{Balance, Shake};
use crate::engine::Engine;
use crate::error::{Error, Result};
use crate::harmonics;
use crate::spectrum::Spectrum;

/// The fewest orders within `rtol`.
pub(super) fn within(
    rtol: f64,
    engine: &Engine,
    omega: f64,
    reference: f64,
    spectrum: Option<&Spectrum>,
) -> Result<Balance> {
    if !(1e-15..1.0).contains(&rtol) {
        return Err(Error::figure("rtol", rtol, "give a number from 1e-15 to below 1"));
    }
    let sums = Sums::new(engine, reference, spectrum);
    let count = engine.placements().len() as f64;
    let candidates = candidates(engine, &sums, 0.25 * rtol / count)?;
    let last = candidates.last().copied().unwrap_or(1);
    let whole = sums.balance(&candidates, omega);
    let tail = if spectrum.is_some() { [0.0; 3] } else { sums.tail(last, omega) };
    let allowed = sums.largest(reference).map(|largest| rtol * largest * omega * omega);
    // Each candidate's share of force, moment and torque.
    let sizes: Vec<[f64; 3]> = (0..candidates.len()).map(|k| whole.sizes(k)).collect();
    let weight = |&k: &usize| {
        let shares = sizes[k].iter().zip(&allowed);
        shares
            .map(|(&size, &allowed)| if size == 0.0 { 0.0 } else { size / allowed })
            .fold(0.0, f64::max)
    };
    let mut by_size: Vec<usize> = (0..candidates.len()).collect();
    by_size.sort_by(|a, b| weight(a).total_cmp(&weight(b)));
    let (mut bounds, mut left_out) = (tail, 0);
    for &k in &by_size {
        let more: [f64; 3] = std::array::from_fn(|i| bounds[i] + sizes[k][i]);
        if more.iter().zip(&allowed).any(|(more, allowed)| more > allowed) {
            break;
        }
        (bounds, left_out) = (more, left_out + 1);
    }
    let pick = |indices: &[usize]| {
        let mut picked: Vec<u32> = indices.iter().map(|&k| candidates[k]).collect();
        picked.sort_unstable();
        picked
    };
    let mut balance = sums.balance(&pick(&by_size[left_out..]), omega);
    balance.omitted = pick(&by_size[..left_out]);
    [balance.force.error_bound, balance.moment.error_bound] = [bounds[0], bounds[1]];
    if let Some(torque) = &mut balance.torque {
        torque.error_bound = bounds[2];
    }
    Ok(balance)
}

/// Orders that may matter: those of the spectrum, or all whose harmonics are not below `tolerance`.
fn candidates(engine: &Engine, sums: &Sums, tolerance: f64) -> Result<Vec<u32>> {
    if let Some(spectrum) = sums.spectrum {
        let mut orders = spectrum.orders();
        if !orders.contains(&1) && engine.placements().iter().any(|p| p.rotating_mass > 0.0) {
            orders.insert(0, 1);
        }
        return Ok(orders);
    }
    let mut highest = 1;
    for group in &sums.groups {
        highest = highest.max(harmonics::highest_order(&group.proportions, tolerance)?);
    }
    Ok((1..=highest).collect())
}

impl Balance {
    /// Length of force and moment and size of the larger torque of the k-th order.
    fn sizes(&self, k: usize) -> [f64; 3] {
        let length = |shake: &Shake| shake.forward[k].norm() + shake.backward[k].norm();
        let torque = self.torque.as_ref().map_or(0.0, |t| t.roll[k].norm().max(t.crank[k].norm()));
        [length(&self.force), length(&self.moment), torque]
    }
}
