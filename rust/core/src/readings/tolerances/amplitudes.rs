//! Harmonics of one cylinder whose crank radius and rod length deviate.

use crate::Complex64;
use crate::gear::harmonics::{self, rod, table, torque, torque_table};
use crate::gear::slider_crank::Cylinder;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;

/// Real and imaginary parts at some samples.
pub(super) type ComplexColumns = [Vec<f64>; 2];

/// Harmonics of a torque, by order.
#[derive(Default)]
pub(super) struct Torques {
    /// Over m·r²·ω².
    pub masses: Vec<ComplexColumns>,
    /// Over the rod's inertia and ω²; empty where it has none beyond its two masses.
    pub rod: Vec<ComplexColumns>,
}

/// Harmonics at some samples.
pub(super) struct Amplitudes {
    /// By order.
    pub force: Vec<ComplexColumns>,
    pub roll: Torques,
    pub crank: Torques,
}

/// What of a cylinder decides how its harmonics are computed.
pub(super) struct Shape {
    offset: f64,
    has_rod_inertia: bool,
    torque: bool,
}

impl Shape {
    pub fn new(cylinder: &Cylinder, torque: bool) -> Self {
        let has_rod_inertia = cylinder.has_rod_inertia();
        Self { offset: cylinder.pin_offset(), has_rod_inertia, torque }
    }

    /// Harmonics for crank radii and rod lengths, m.
    pub fn amplitudes(
        &self,
        radii: &[f64],
        rods: &[f64],
        orders: &[u32],
        cancel: &Cancel,
    ) -> Result<Amplitudes> {
        let mut found = if self.offset == 0.0 {
            self.centred(radii, rods, orders, cancel)?
        } else {
            self.one_by_one(radii, rods, orders, cancel)?
        };
        if self.torque && self.has_rod_inertia {
            let mut columns = [(); 2].map(|()| empty(orders, radii.len()));
            for (&radius, &length) in radii.iter().zip(rods) {
                let proportions = Cylinder::new(radius, length, 0.0, self.offset)?.proportions();
                let harmonics = rod::torque(&proportions, orders, cancel)?;
                push(&mut columns[0], &harmonics.roll);
                push(&mut columns[1], &harmonics.crank);
            }
            [found.roll.rod, found.crank.rod] = columns;
        }
        Ok(found)
    }

    /// Without offset, many samples at once.
    fn centred(
        &self,
        radii: &[f64],
        rods: &[f64],
        orders: &[u32],
        cancel: &Cancel,
    ) -> Result<Amplitudes> {
        let ratios: Vec<f64> = radii.iter().zip(rods).map(|(r, l)| r / l).collect();
        let mut values = vec![0.0; ratios.len() * orders.len()];
        let column = |values: &[f64], k: usize, factor: f64| -> Vec<f64> {
            values.iter().skip(k).step_by(orders.len()).map(|value| factor * value).collect()
        };
        let zeros = vec![0.0; ratios.len()];
        table::write_centred(&ratios, orders, None, &mut values, cancel)?;
        let columns = 0..orders.len();
        let force = columns.clone().map(|k| [column(&values, k, 1.0), zeros.clone()]).collect();
        let (mut roll, mut crank) = (Torques::default(), Torques::default());
        if self.torque {
            torque_table::write_centred_roll(&ratios, orders, &mut values, cancel)?;
            for k in columns {
                roll.masses.push([zeros.clone(), column(&values, k, 1.0)]);
                crank.masses.push([zeros.clone(), column(&values, k, -1.0)]);
            }
        }
        Ok(Amplitudes { force, roll, crank })
    }

    fn one_by_one(
        &self,
        radii: &[f64],
        rods: &[f64],
        orders: &[u32],
        cancel: &Cancel,
    ) -> Result<Amplitudes> {
        let [mut force, mut roll, mut crank] = [(); 3].map(|()| empty(orders, radii.len()));
        for (&radius, &length) in radii.iter().zip(rods) {
            let proportions = Cylinder::new(radius, length, 0.0, self.offset)?.proportions();
            push(&mut force, &harmonics::coefficients(&proportions, orders, cancel)?);
            if self.torque {
                let harmonics = torque::torque(&proportions, orders, cancel)?;
                push(&mut roll, &harmonics.roll);
                push(&mut crank, &harmonics.crank);
            }
        }
        let [roll, crank] = [roll, crank].map(|masses| Torques { masses, rod: Vec::new() });
        Ok(Amplitudes { force, roll, crank })
    }
}

fn empty(orders: &[u32], samples: usize) -> Vec<ComplexColumns> {
    orders.iter().map(|_| [(); 2].map(|()| Vec::with_capacity(samples))).collect()
}

/// Appends the harmonics of one more sample.
fn push(columns: &mut [ComplexColumns], harmonics: &[Complex64]) {
    for ([re, im], value) in columns.iter_mut().zip(harmonics) {
        re.push(value.re);
        im.push(value.im);
    }
}
