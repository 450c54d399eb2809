//! Rims and discs of a moment of inertia.

use std::f64::consts::{PI, TAU};

use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::readings::balance::angular_speed;

/// Steps in which the thickness of a rim of some width is solved for; each halves the error at least.
const STEPS: usize = 200;

/// What determines the mean diameter of a rim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RimDiameter {
    /// Itself, m.
    Mean(f64),
    /// Its speed, m/s, at a crank speed, rpm.
    Speed(f64, f64),
    /// Its hoop stress, Pa, at a crank speed, rpm.
    Stress(f64, f64),
}

/// What determines the section of a rim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RimSection {
    /// Its area alone: all mass is at the mean diameter.
    Thin,
    /// Width along the crank over thickness.
    WidthOverThickness(f64),
    /// Width, m.
    Width(f64),
    /// Thickness along the radius, m.
    Thickness(f64),
}

/// A rim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rim {
    /// kg.
    pub mass: f64,
    /// m.
    pub mean_diameter: f64,
    /// Area of the section, m².
    pub area: f64,
    /// Along the crank, and along the radius, m; none of a thin rim.
    pub section: Option<[f64; 2]>,
}

impl Rim {
    /// Of a moment of inertia, kg·m², and a density, kg/m³. A ring of thickness t about a mean radius R has
    /// m·(R² + t²/4).
    pub fn new(
        inertia: f64,
        density: f64,
        diameter: RimDiameter,
        section: RimSection,
    ) -> Result<Self> {
        check_positive("inertia", inertia, "kg·m²")?;
        check_positive("density", density, "kg/m³, such as 7200 of cast iron or 7850 of steel")?;
        let mean_diameter = diameter.meters(density)?;
        let radius = 0.5 * mean_diameter;
        let square = radius * radius;
        // Mass of a section of 1 m².
        let per_area = TAU * radius * density;
        let of = |argument: &str, value: f64, [width, thickness]: [f64; 2]| {
            if thickness >= mean_diameter {
                let hint = format!(
                    "a rim {thickness:.4} m thick has no hole at a mean diameter of {mean_diameter:.4} m; give a \
                     larger diameter, or a wider rim, or take a disc"
                );
                return Err(Error::figure(argument, value, hint));
            }
            let area = width * thickness;
            Ok(Self {
                mass: per_area * area,
                mean_diameter,
                area,
                section: Some([width, thickness]),
            })
        };
        match section {
            RimSection::Thin => {
                let mass = inertia / square;
                Ok(Self { mass, mean_diameter, area: mass / per_area, section: None })
            }
            RimSection::WidthOverThickness(ratio) => {
                check_positive("width_ratio", ratio, "width over thickness, such as 2")?;
                // ratio·t²·(R² + t²/4) = J/per_area, without a difference.
                let part = inertia / (per_area * ratio);
                let thickness = (2.0 * part / (square + (square * square + part).sqrt())).sqrt();
                of("width_ratio", ratio, [ratio * thickness, thickness])
            }
            RimSection::Width(width) => {
                limits::length("width", width)?;
                // t·(R² + t²/4) = J/(per_area·width) rises with t.
                let part = inertia / (per_area * width);
                let mut thickness = part / square;
                for _ in 0..STEPS {
                    let excess = thickness * (square + 0.25 * thickness * thickness) - part;
                    let next = thickness - excess / (square + 0.75 * thickness * thickness);
                    if next >= thickness {
                        break;
                    }
                    thickness = next;
                }
                of("width", width, [width, thickness])
            }
            RimSection::Thickness(thickness) => {
                limits::length("thickness", thickness)?;
                let area = inertia / (per_area * (square + 0.25 * thickness * thickness));
                of("thickness", thickness, [area / thickness, thickness])
            }
        }
    }
}

impl RimDiameter {
    /// m.
    fn meters(self, density: f64) -> Result<f64> {
        let at = |speed: f64, rpm: f64| {
            let omega = angular_speed(rpm)?;
            if omega == 0.0 {
                return Err(Error::figure("rpm", rpm, "give a speed above 0"));
            }
            Ok(2.0 * speed / omega)
        };
        match self {
            Self::Mean(diameter) => limits::length("mean_diameter", diameter),
            Self::Speed(speed, rpm) => {
                check_positive("rim_speed", speed, "m/s")?;
                at(speed, rpm)
            }
            // That of a thin ring, σ = ρ·v².
            Self::Stress(stress, rpm) => {
                check_positive("hoop_stress", stress, "Pa")?;
                at((stress / density).sqrt(), rpm)
            }
        }
    }
}

/// A disc without a hole: thickness along the crank and diameter, m.
pub fn disc(
    inertia: f64,
    density: f64,
    diameter: Option<f64>,
    thickness: Option<f64>,
) -> Result<[f64; 2]> {
    check_positive("inertia", inertia, "kg·m²")?;
    check_positive("density", density, "kg/m³, such as 7200 of cast iron or 7850 of steel")?;
    match (diameter, thickness) {
        (Some(diameter), None) => {
            let radius = 0.5 * limits::length("diameter", diameter)?;
            Ok([2.0 * inertia / (PI * density * radius.powi(4)), diameter])
        }
        (None, Some(thickness)) => {
            limits::length("thickness", thickness)?;
            Ok([thickness, 2.0 * (2.0 * inertia / (PI * density * thickness)).sqrt().sqrt()])
        }
        _ => Err(Error::value("diameter", "and thickness", "give one of them")),
    }
}

fn check_positive(name: &str, value: f64, unit: &str) -> Result<f64> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(Error::figure(name, value, format!("give a number above 0, in {unit}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// ∫ r²·dm of a ring between two radii.
    fn integrated(rim: &Rim, density: f64) -> f64 {
        let [width, thickness] = rim.section.unwrap();
        let [inner, outer] = [-0.5, 0.5].map(|side| 0.5 * rim.mean_diameter + side * thickness);
        let steps = 200_000;
        let step = (outer - inner) / f64::from(steps);
        let at = |k: u32| (inner + (f64::from(k) + 0.5) * step).powi(3);
        TAU * density * width * step * (0..steps).map(at).sum::<f64>()
    }

    #[test]
    fn rims_have_their_moment_of_inertia() {
        let sections = [
            RimSection::WidthOverThickness(2.0),
            RimSection::WidthOverThickness(0.1),
            RimSection::Width(0.2),
            RimSection::Thickness(0.07),
        ];
        for section in sections {
            for inertia in [0.05, 3.0, 90.0] {
                let rim = Rim::new(inertia, 7200.0, RimDiameter::Mean(1.1), section).unwrap();
                assert_relative_eq!(integrated(&rim, 7200.0), inertia, max_relative = 1e-9);
                let [width, thickness] = rim.section.unwrap();
                assert_relative_eq!(rim.area, width * thickness, max_relative = 1e-15);
                // Thicker rims of a mean diameter have less mass.
                let thin =
                    Rim::new(inertia, 7200.0, RimDiameter::Mean(1.1), RimSection::Thin).unwrap();
                assert!(rim.mass < thin.mass);
            }
        }
        let narrow = Rim::new(50.0, 7200.0, RimDiameter::Mean(0.5), RimSection::Width(0.01));
        assert!(narrow.is_err());
    }

    #[test]
    fn stress_and_speed_are_of_the_mean_diameter() {
        let stress = RimDiameter::Stress(4e6, 300.0).meters(7200.0).unwrap();
        let speed = RimDiameter::Speed((4e6_f64 / 7200.0).sqrt(), 300.0).meters(7200.0).unwrap();
        assert_relative_eq!(stress, speed, max_relative = 1e-15);
        assert_relative_eq!(0.5 * speed * 10.0 * PI, 23.570_226, max_relative = 1e-7);
        assert!(RimDiameter::Speed(20.0, 0.0).meters(7200.0).is_err());
    }

    #[test]
    fn discs_either_way() {
        let [thickness, diameter] = disc(2.0, 7850.0, Some(0.6), None).unwrap();
        assert_relative_eq!(
            0.5 * PI * 0.3_f64.powi(4) * 7850.0 * thickness,
            2.0,
            max_relative = 1e-14
        );
        let again = disc(2.0, 7850.0, None, Some(thickness)).unwrap();
        assert_relative_eq!(again[1], diameter, max_relative = 1e-14);
        assert!(disc(2.0, 7850.0, Some(0.6), Some(0.1)).is_err());
        assert!(disc(2.0, 0.0, Some(0.6), None).is_err());
    }
}
