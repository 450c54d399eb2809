//! Warnings of implausible pressures: other units, or another origin of angles.

use super::{Cycle, period_deg};
use crate::numbers::error::Warning;
use crate::numbers::figure::significant;

/// Peak pressures, Pa, below which they are in bar or kPa: a motored cylinder reaches 1e6 Pa, a diesel 3e7.
const LARGEST_IN_BAR: f64 = 500.0;
const LARGEST_IN_KPA: f64 = 5e4;
/// Peak pressure, Pa, above which it is not in Pa: the highest of diesels are 3e7.
const LARGEST_PRESSURE: f64 = 5e7;
/// Least pressure, Pa, below which gauge pressure is likely: an engine that idles has 2e4 Pa.
const LEAST_ABSOLUTE: f64 = 1.5e4;
/// Least pressure, Pa, above which figures are in another unit: charged engines have up to 5e5.
const LARGEST_INTAKE: f64 = 6e5;
/// Part of a cycle's points that noise may have below the least pressure; of gauge pressure two strokes of
/// four are.
const NOISE: f64 = 0.05;
/// Degrees from the firing top dead centre up to which pressure peaks: compression does at 0, and the latest
/// burns at 40.
const FARTHEST_PEAK: f64 = 60.0;
/// Peak over mean pressure from which there is a peak: compression alone has 4 and more.
const PEAKED: f64 = 2.0;
/// Indicated mean effective pressure, Pa, below which figures are likely wrong: motored engines have -2e5, and
/// engine brakes, the exception, as much as -1.2e6.
const STRONGEST_BRAKE: f64 = -5e5;

fn figure(value: f64) -> String {
    significant(value, 6)
}

/// Of a cycle: its pressures, and where they peak.
#[must_use]
pub fn of_cycle(cycle: &Cycle) -> Vec<Warning> {
    let points = cycle.given();
    let peak = peak(&points.theta_deg, &points.pressure, period_deg(cycle.strokes()));
    pressures(&points.pressure).into_iter().chain(peak).collect()
}

/// Of cylinder pressures in bar or kPa, or against the atmosphere, Pa.
#[must_use]
pub fn pressures(values: &[f64]) -> Option<Warning> {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let other_unit = "are its numbers in the unit that is named for them? Pressures are Pa here";
    let [lowest, highest, range] = [least, most, most - least].map(figure);
    let (fault, hint) = if most < LARGEST_IN_BAR {
        (format!("is at most {highest} Pa"), "was it given in bar? Pressures are Pa here")
    } else if most < LARGEST_IN_KPA {
        (format!("is at most {highest} Pa"), "was it given in kPa? Pressures are Pa here")
    } else if 0.0 < most - least && most - least < LARGEST_IN_BAR {
        let hint = "was gauge pressure given in bar? Pressures are Pa here";
        (format!("varies by {range} Pa alone"), hint)
    } else if most > LARGEST_PRESSURE {
        (format!("is as much as {highest} Pa, more than any engine's"), other_unit)
    } else if least > LARGEST_INTAKE && most > PEAKED * least {
        (format!("is {lowest} Pa at its least, more than any intake has"), other_unit)
    } else if quantile(values, NOISE) < LEAST_ABSOLUTE {
        let hint = "is it gauge pressure? Pressures are absolute here: add that of the atmosphere, \
                    101325 Pa";
        (format!("is {lowest} Pa at its least"), hint)
    } else if least < 0.0 {
        let hint = "torque is linear in pressure, and counts it as it is";
        let fault = "at its least, which noise or an offset of the sensor does";
        (format!("is {lowest} Pa {fault}"), hint)
    } else {
        return None;
    };
    Some(Warning::new("pressure", fault, hint))
}

/// Value below which this part of values is, between two of them in proportion.
fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let place = part * (sorted.len() - 1) as f64;
    let below = place.floor() as usize;
    let above = sorted[(below + 1).min(sorted.len() - 1)];
    sorted[below] + (place - below as f64) * (above - sorted[below])
}

/// Of pressure whose peak is far from the firing top dead centre.
#[must_use]
pub fn peak(theta_deg: &[f64], values: &[f64], period_deg: f64) -> Option<Warning> {
    let far = far_peak(theta_deg, values, period_deg)?;
    let fault = format!(
        "peaks at {}°, far from the firing top dead centre, from which angles are counted \
         here",
        significant(far, 4)
    );
    let hint = "for a file that counts from elsewhere, give the angle at which it has that centre";
    Some(Warning::new("theta_deg", fault, hint).about("theta_deg: pressure".into()))
}

/// Crank angle of the peak of pressure, degrees, if it is far from the firing top dead centre.
#[must_use]
pub fn far_peak(theta_deg: &[f64], values: &[f64], period_deg: f64) -> Option<f64> {
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    if most < PEAKED * mean {
        return None;
    }
    let half = 0.5 * period_deg;
    let peaks = theta_deg.iter().zip(values).filter(|&(_, &value)| value == most);
    let places = peaks.map(|(theta, _)| (theta + half).rem_euclid(period_deg) - half);
    let nearest = places.min_by(|a, b| a.abs().total_cmp(&b.abs()))?;
    (nearest.abs() > FARTHEST_PEAK).then_some(nearest)
}

/// Of a cycle that takes more work from the crank than an engine does, by its mean effective pressure, Pa; none
/// where it peaks elsewhere, of which [`peak`] is.
#[must_use]
pub fn work(cycle: &Cycle, mean_effective: f64) -> Option<Warning> {
    let given = cycle.given();
    // The angles of a computed cycle are right, as of a compressor's.
    let strong = mean_effective < STRONGEST_BRAKE
        && given.degree.is_none()
        && far_peak(&given.theta_deg, &given.pressure, period_deg(cycle.strokes())).is_none();
    let fault = format!("= {} bar", significant(mean_effective / 1e5, 3));
    let hint = "pressure brakes the crank. Are angles counted in the direction of rotation, from the \
                firing top dead centre?";
    strong.then(|| Warning::new("imep", fault, hint))
}

/// Of the pressure of crankcase or intake in other units, Pa; 0 is a vacuum.
#[must_use]
pub fn absolute(argument: &str, pressure: f64) -> Option<Warning> {
    let hint = if 0.0 < pressure && pressure < LARGEST_IN_BAR {
        "was it given in bar or kPa? Pressures are Pa here"
    } else if pressure > LARGEST_PRESSURE {
        "is it in Pa? Pressures are Pa here"
    } else {
        return None;
    };
    Some(Warning::new(argument, format!("= {} Pa", figure(pressure)), hint))
}
