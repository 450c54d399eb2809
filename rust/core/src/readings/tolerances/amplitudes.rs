//! Harmonics of one cylinder whose crank radius and rod length deviate.

use crate::Complex64;
use crate::mechanism::DrivenMechanism;
use crate::mechanism::cylinder::Cylinder;
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::mechanism::harmonics::table;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;

/// Real and imaginary parts of harmonics by order and sample: of the force; of the torques of the masses on block and crank over
/// m·r²·ω²; of the same of the rod's inertia over it and ω². Empty where there are none.
pub(super) type SampleAmplitudes = [Vec<[Vec<f64>; 2]>; 5];

/// Harmonics of a cylinder, on a crank of some speed, at some orders of the main crank, for other crank radii and rod lengths, m.
///
/// At orders that are no multiples of the speed of its crank they are any: no load has a part there.
pub(super) fn amplitudes(
    (cylinder, ratio): &(Cylinder, SpeedRatio),
    wants_torque: bool,
    (radii, rods): (&[f64], &[f64]),
    orders: &[Order],
    cancel: &Cancel,
) -> Result<SampleAmplitudes> {
    let driven = DrivenMechanism { mechanism: cylinder.mechanism(), ratio: *ratio };
    let own: Vec<u32> = orders.iter().map(|n| driven.own_highest(n.halves()).max(1)).collect();
    let numbers = &own[..];
    let [on_block, on_crank] = driven.senses();
    let offset = cylinder.pin_offset();
    let [centred, has_rod] = [offset == 0.0, wants_torque && cylinder.has_rod_inertia()];
    let mut found = SampleAmplitudes::default();
    if centred {
        // Many samples at once.
        let ratios: Vec<f64> = radii.iter().zip(rods).map(|(r, l)| r / l).collect();
        let mut values = vec![0.0; ratios.len() * numbers.len()];
        let columns = |values: &[f64], factors: [f64; 2]| -> Vec<[Vec<f64>; 2]> {
            let column =
                |k, by: f64| values.iter().skip(k).step_by(numbers.len()).map(move |v| by * v);
            (0..numbers.len()).map(|k| factors.map(|by| column(k, by).collect())).collect()
        };
        table::write_centred(&ratios, numbers, None, &mut values, cancel)?;
        found[0] = columns(&values, [1.0, 0.0]);
        if wants_torque {
            table::write_centred_roll(&ratios, numbers, &mut values, cancel)?;
            found[1] = columns(&values, [0.0, on_block]);
            found[2] = columns(&values, [0.0, -on_crank]);
        }
    }
    for (&radius, &length) in radii.iter().zip(rods).filter(|_| !centred || has_rod) {
        let mechanism = Cylinder::new(radius, length, 0.0, offset)?.mechanism();
        let mut push = |list: usize, harmonics: Vec<Complex64>| {
            found[list].resize_with(numbers.len(), Default::default);
            for ([re, im], value) in found[list].iter_mut().zip(harmonics) {
                re.push(value.re);
                im.push(value.im);
            }
        };
        let mut push_torque = |list, TorqueHarmonics { roll, crank }: TorqueHarmonics| {
            push(list, roll.iter().map(|roll| roll * on_block).collect());
            push(list + 1, crank.iter().map(|crank| crank * on_crank).collect());
        };
        if has_rod {
            push_torque(3, mechanism.swing_torque(numbers, cancel)?);
        }
        if !centred && wants_torque {
            push_torque(1, mechanism.torque(numbers, cancel)?);
        }
        if !centred {
            push(0, mechanism.force(numbers, cancel)?);
        }
    }
    Ok(found)
}
