//! Vibration severity grades of reciprocating machines (ISO 10816-6:1995).
//!
//! For machines above 100 kW that do not drive road vehicles: r.m.s. values of 2 Hz to 1000 Hz at points of
//! the machine. The criterion is constant displacement below 10 Hz, constant velocity up to 250 Hz, and
//! constant acceleration above.

use std::f64::consts::TAU;

/// Frequencies that count, Hz.
const BAND: [f64; 2] = [2.0, 1000.0];
/// Frequencies between which velocity is the criterion, Hz.
const CORNERS: [f64; 2] = [10.0, 250.0];

/// Names of the grades: their velocities, mm/s r.m.s., as the standard rounds them.
pub const GRADES: [f64; 12] = [1.1, 1.8, 2.8, 4.5, 7.1, 11.0, 18.0, 28.0, 45.0, 71.0, 112.0, 180.0];

/// R.m.s. values along one direction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Levels {
    /// m.
    pub displacement: f64,
    /// m/s.
    pub velocity: f64,
    /// m/s².
    pub acceleration: f64,
}

impl Levels {
    /// Of the peaks of displacement at some angular speeds, m and rad/s; those outside of the band do not
    /// count.
    #[must_use]
    pub fn of(peaks: impl Iterator<Item = (f64, f64)>) -> Self {
        let counted = peaks.filter(|(_, omega)| (BAND[0]..=BAND[1]).contains(&(omega / TAU)));
        let squares = counted.fold([0.0; 3], |[x, v, a], (peak, omega)| {
            let [of_x, of_v, of_a] = [peak, peak * omega, peak * omega * omega].map(|p| p * p);
            [x + of_x, v + of_v, a + of_a]
        });
        let [displacement, velocity, acceleration] = squares.map(|sum| (sum / 2.0).sqrt());
        Self { displacement, velocity, acceleration }
    }

    /// Upper limits of the grade of an index.
    #[must_use]
    pub fn limits(index: usize) -> Self {
        let velocity = 1e-3 * 10.0_f64.powf(0.05 + 0.2 * index as f64);
        let [low, high] = CORNERS.map(|corner| corner * TAU);
        Self { displacement: velocity / low, velocity, acceleration: velocity * high }
    }
}

/// The grade of some levels, the worst of the three: its name, or infinity above the last one.
#[must_use]
pub fn grade(levels: &Levels) -> f64 {
    let is_within = |index: &usize| {
        let limits = Levels::limits(*index);
        levels.displacement <= limits.displacement
            && levels.velocity <= limits.velocity
            && levels.acceleration <= limits.acceleration
    };
    (0..GRADES.len()).find(is_within).map_or(f64::INFINITY, |index| GRADES[index])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_those_of_the_standard() {
        // ISO 10816-6:1995, table A.1, grade 4.5: 71.0 µm, 4.46 mm/s, 7.01 m/s².
        let limits = Levels::limits(3);
        assert!((limits.velocity - 4.466_835_9e-3).abs() < 1e-10);
        assert!((limits.displacement - 71.091_902e-6).abs() < 1e-12);
        assert!((limits.acceleration - 7.016_489_5).abs() < 1e-7);
        for (index, name) in GRADES.into_iter().enumerate() {
            // Names are rounded to two or three digits.
            assert!((Levels::limits(index).velocity * 1e3 / name - 1.0).abs() < 0.021, "{name}");
        }
    }

    #[test]
    fn the_worst_of_the_three_is_the_grade() {
        let limits = Levels::limits(3);
        assert_eq!(grade(&limits), 4.5);
        assert_eq!(grade(&Levels { displacement: limits.displacement * 1.01, ..limits }), 7.1);
        assert_eq!(grade(&Levels { acceleration: 1e3, ..limits }), 1e3_f64.max(f64::INFINITY));
        assert_eq!(grade(&Levels::default()), 1.1);
    }

    #[test]
    fn levels_are_rms_of_the_band_alone() {
        let peaks = [(1e-3, TAU * 1.9), (2e-3, TAU * 2.0), (1e-3, TAU * 50.0), (1.0, TAU * 1001.0)];
        let levels = Levels::of(peaks.into_iter());
        assert!((levels.displacement - (2.5e-6_f64).sqrt()).abs() < 1e-12);
        let squares = (2e-3 * TAU * 2.0).powi(2) + (1e-3 * TAU * 50.0).powi(2);
        assert!((levels.velocity - (squares / 2.0).sqrt()).abs() < 1e-12);
    }
}
