//! Dynamic stiffness of a mount along its three axes, complex, over frequency.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::file::TableEntry;
use crate::Complex64;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// What a hydraulic mount adds along its first axis: fluid that swings in a channel between two chambers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InertiaTrack {
    /// Stiffness that the chambers' walls add where the fluid is locked, N/m.
    pub stiffness: f64,
    /// Frequency of the fluid on the chambers' walls, Hz.
    pub frequency: f64,
    /// Damping of the fluid over its critical damping.
    pub damping_ratio: f64,
}

/// Measured stiffness over frequency.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "TableEntry", into = "TableEntry")]
pub struct Table {
    /// Hz, ascending.
    pub frequency: Vec<f64>,
    /// Along the three axes at each of them, N/m.
    pub stiffness: Vec<[Complex64; 3]>,
}

/// Stiffness of a mount that moves.
#[derive(Debug, Clone, PartialEq)]
pub enum Dynamic {
    /// The same at any frequency but for its damping.
    Constant {
        /// Real part along the three axes, N/m.
        stiffness: [f64; 3],
        /// Imaginary over real part (hysteretic damping).
        loss_factor: [f64; 3],
        /// Viscous damping, N·s/m.
        damping: [f64; 3],
        /// Fluid of a hydraulic mount, along the first axis.
        track: Option<InertiaTrack>,
    },
    /// Measured.
    Table(Table),
}

const LOSS_HINT: &str = "give zero or more; data of test benches that write e^{-iωt} have the other sign: \
                         conjugate them";

impl InertiaTrack {
    fn check(&self) -> Result<()> {
        let figures = [
            ("stiffness", self.stiffness),
            ("frequency", self.frequency),
            ("damping_ratio", self.damping_ratio),
        ];
        for (name, figure) in figures {
            if !(limits::SMALLEST..=limits::LARGEST).contains(&figure) {
                let hint = "give a number that is more than zero";
                return Err(Error::figure(format!("track.{name}"), figure, hint));
            }
        }
        Ok(())
    }

    /// Stiffness that the fluid adds at a frequency, N/m.
    fn at(&self, frequency: f64) -> Complex64 {
        let x = frequency / self.frequency;
        let damping = Complex64::new(0.0, 2.0 * self.damping_ratio * x);
        // Far above, where squares would overflow, the fluid is locked.
        if x > 1e100 {
            return Complex64::new(self.stiffness, 0.0);
        }
        self.stiffness * (damping - x * x) / (damping + (1.0 - x * x))
    }
}

impl Table {
    fn check(&self) -> Result<()> {
        limits::same_length(
            "table: stiffness",
            self.stiffness.len(),
            "its frequency",
            self.frequency.len(),
            "frequency",
        )?;
        limits::ascending("table: frequency", &self.frequency)?;
        for (k, stiffness) in self.stiffness.iter().enumerate() {
            for (axis, value) in stiffness.iter().enumerate() {
                let argument = format!("table: stiffness[{k}][{axis}]");
                if !(value.re.abs() <= limits::LARGEST && value.im.abs() <= limits::LARGEST) {
                    let hint = "give finite numbers, N/m";
                    return Err(Error::value(argument, value, hint));
                }
                if value.im < 0.0 {
                    return Err(Error::value(
                        argument,
                        value,
                        format!("its loss is below zero: {LOSS_HINT}"),
                    ));
                }
            }
        }
        Ok(())
    }

    /// Real and imaginary part between its points, or none outside.
    fn at(&self, frequency: f64) -> Option<[Complex64; 3]> {
        let (below, above, share) = limits::between(&self.frequency, frequency)?;
        let [before, next] = [below, above].map(|k| self.stiffness[k]);
        Some([0, 1, 2].map(|axis| before[axis] * (1.0 - share) + next[axis] * share))
    }
}

impl Dynamic {
    /// Rejects what no mount has.
    pub fn check(&self) -> Result<()> {
        match self {
            Self::Table(table) => table.check(),
            Self::Constant { stiffness, loss_factor, damping, track } => {
                // Names at hand: mounts are made by the million.
                let names = [
                    ["dynamic_stiffness[0]", "loss_factor[0]", "damping[0]"],
                    ["dynamic_stiffness[1]", "loss_factor[1]", "damping[1]"],
                    ["dynamic_stiffness[2]", "loss_factor[2]", "damping[2]"],
                ];
                for (axis, [of_stiffness, of_loss, of_damping]) in names.into_iter().enumerate() {
                    limits::not_negative(of_stiffness, stiffness[axis])?;
                    let [loss, viscous] = [loss_factor[axis], damping[axis]];
                    if loss < 0.0 {
                        return Err(Error::figure(of_loss, loss, LOSS_HINT));
                    }
                    limits::distance(of_loss, loss)?;
                    limits::distance(of_damping, viscous)?;
                }
                track.iter().try_for_each(InertiaTrack::check)
            }
        }
    }

    /// Complex stiffness along the three axes at an angular speed of zero or more, N/m; none outside of a
    /// table. At rest there is no damping.
    #[must_use]
    pub fn at(&self, omega: f64) -> Option<[Complex64; 3]> {
        match self {
            Self::Table(table) => table.at(omega / TAU),
            Self::Constant { stiffness, loss_factor, damping, track } => {
                let of_axis = |axis: usize| {
                    let hysteretic =
                        if omega > 0.0 { stiffness[axis] * loss_factor[axis] } else { 0.0 };
                    Complex64::new(stiffness[axis], hysteretic + omega * damping[axis])
                };
                let mut along = [0, 1, 2].map(of_axis);
                along[0] += track.map_or_else(Complex64::default, |track| track.at(omega / TAU));
                Some(along)
            }
        }
    }

    /// Complex stiffness with its hysteretic damping, N/m, and viscous damping, N·s/m, along the three axes; none
    /// where it depends on frequency otherwise.
    #[must_use]
    pub fn constant(&self) -> Option<([Complex64; 3], [f64; 3])> {
        let Self::Constant { stiffness, loss_factor, damping, track: None } = self else {
            return None;
        };
        let of_axis = |k: usize| Complex64::new(stiffness[k], stiffness[k] * loss_factor[k]);
        Some(([0, 1, 2].map(of_axis), *damping))
    }

    /// Whether its real part depends on frequency.
    #[must_use]
    pub fn varies(&self) -> bool {
        !matches!(self, Self::Constant { track: None, .. })
    }

    /// Whether its imaginary part does.
    #[must_use]
    pub fn damping_varies(&self) -> bool {
        match self {
            Self::Constant { damping, track, .. } => track.is_some() || *damping != [0.0; 3],
            Self::Table(_) => true,
        }
    }

    /// Adds stiffness along the axes, N/m, with the loss factors; elastic beside a table.
    pub fn stiffen(&mut self, by: [f64; 3]) {
        match self {
            Self::Table(table) => {
                for along in &mut table.stiffness {
                    for (value, by) in along.iter_mut().zip(by) {
                        value.re += by;
                    }
                }
            }
            Self::Constant { stiffness, .. } => {
                for (value, by) in stiffness.iter_mut().zip(by) {
                    *value += by;
                }
            }
        }
    }

    /// First and last frequency at which it is known, Hz.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Constant { .. } => [0.0, f64::INFINITY],
            Self::Table(table) => [table.frequency[0], table.frequency[table.frequency.len() - 1]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn constant(track: Option<InertiaTrack>, loss: f64, damping: f64) -> Dynamic {
        let stiffness = [2e5, 1e5, 0.0];
        Dynamic::Constant { stiffness, loss_factor: [loss; 3], damping: [damping; 3], track }
    }

    #[test]
    fn a_hydraulic_mount_is_soft_at_rest_lossy_between_and_stiff_above() {
        let track = InertiaTrack { stiffness: 1.8e5, frequency: 10.0, damping_ratio: 0.25 };
        let mount = constant(Some(track), 0.06, 0.0);
        let along = |frequency: f64| mount.at(TAU * frequency).unwrap()[0];
        assert!((along(8.0).norm() - 303_865.19).abs() < 0.005);
        assert!((along(8.0).arg().to_degrees() - 59.056_968).abs() < 5e-7);
        // At a thousand times the fluid's frequency, where a millionth of the limit is missing.
        assert!((along(1e4).norm() - 380_189.61).abs() < 0.005);
        assert!((along(1e9).norm() - 3.8e5_f64.hypot(1.2e4)).abs() < 1e-9);
        assert_eq!(along(0.0), Complex64::new(2e5, 0.0));
        assert_eq!(along(1e200), Complex64::new(3.8e5, 1.2e4));
        let largest = (1..400)
            .map(|k| f64::from(k) * 0.1)
            .max_by(|a, b| along(*a).arg().total_cmp(&along(*b).arg()));
        assert!(largest.unwrap() < 10.0);
    }

    #[test]
    fn damping_is_hysteretic_viscous_or_both_and_none_at_rest() {
        let both = constant(None, 0.1, 30.0);
        assert_eq!(both.at(0.0).unwrap()[0], Complex64::new(2e5, 0.0));
        assert_eq!(both.at(100.0).unwrap()[0], Complex64::new(2e5, 2e4 + 3e3));
        assert_eq!(both.at(100.0).unwrap()[2], Complex64::new(0.0, 3e3));
    }

    #[test]
    fn tables_are_interpolated_and_never_extrapolated() {
        let value = |re: f64| [Complex64::new(re, 0.1 * re); 3];
        let frequency = vec![5.0, 10.0, 40.0];
        let table = Table { frequency, stiffness: vec![value(1.0), value(2.0), value(8.0)] };
        let mount = Dynamic::Table(table.clone());
        assert!(mount.check().is_ok());
        let along = |frequency: f64| mount.at(TAU * frequency).map(|along| along[1].re);
        for (frequency, stiffness) in [(7.5, 1.5), (25.0, 5.0)] {
            assert!((along(frequency).unwrap() - stiffness).abs() < 1e-14);
        }
        assert_eq!([table.at(5.0), table.at(40.0)], [Some(value(1.0)), Some(value(8.0))]);
        assert_eq!([along(4.99), along(40.01), along(f64::INFINITY)], [None; 3]);
        assert_eq!(mount.range(), [5.0, 40.0]);
    }

    #[test]
    fn impossible_figures_are_rejected_by_name() {
        let error = |dynamic: Dynamic| dynamic.check().unwrap_err().to_string();
        assert!(error(constant(None, -0.1, 0.0)).starts_with("loss_factor[0] = -0.1: give zero"));
        assert!(error(constant(None, 0.1, -2.0)).starts_with("damping[0] = -2.0"));
        let track = InertiaTrack { stiffness: 1.0, frequency: 10.0, damping_ratio: 0.0 };
        assert!(error(constant(Some(track), 0.0, 0.0)).starts_with("track.damping_ratio = 0.0"));
        let table = |frequency: &[f64], stiffness: Complex64| {
            let stiffness = vec![[stiffness; 3]; frequency.len()];
            error(Dynamic::Table(Table { frequency: frequency.to_vec(), stiffness }))
        };
        let one = Complex64::new(1.0, 0.0);
        assert!(table(&[1.0], one).contains("give two or more"));
        assert!(
            table(&[1.0, 3.0, 2.0], one).contains("frequency[2] = 2.0: give frequencies in asc")
        );
        assert!(table(&[1.0, f64::NAN], one).contains("frequency[1] = NaN"));
        assert!(table(&[1.0, 2.0], one.conj() - Complex64::i()).contains("conjugate them"));
        assert!(table(&[1.0, 2.0], one * f64::NAN).contains("give finite numbers"));
    }
}
