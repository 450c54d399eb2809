//! Folded angles that unfold to bank angles within a window.

use std::f64::consts::TAU;

use crate::engine::Hold;

/// More than rounding moves an angle of at most half a circle, radians.
const WINDOW_ERROR: f64 = 1e-9;

/// Folded angles, in [0, turn/2], that are wanted.
pub(super) struct WindowTarget {
    /// From, to; radians.
    intervals: Vec<[f64; 2]>,
}

impl WindowTarget {
    /// For a window of bank angles, degrees.
    pub(super) fn new(window: [f64; 2], hold: Hold, turn: f64) -> Self {
        let half = 0.5 * turn;
        let [low, high] = window.map(|degrees| degrees.clamp(0.0, 180.0).to_radians());
        let windows = match hold {
            Hold::Firing => vec![[low, high]],
            // Half of an angle, or what that is short of half a circle.
            Hold::Pins => {
                vec![[2.0 * low, 2.0 * high], [TAU - 2.0 * high, TAU - 2.0 * low]]
            }
        };
        let intervals: Vec<[f64; 2]> = windows
            .into_iter()
            .filter(|[low, high]| low <= high)
            .flat_map(|[low, high]| {
                // In units of half a turn unfolded angles run up, down, up, …; three are enough to
                // have a whole one.
                let (first, last) = ((low / half).floor() as i64, (high / half).floor() as i64);
                (first..=last.min(first + 2)).map(move |run| {
                    let start = run as f64 * half;
                    let (from, to) = ((low - start).max(0.0), (high - start).min(half));
                    if run % 2 == 0 { [from, to] } else { [half - to, half - from] }
                })
            })
            .map(|[from, to]| [from - WINDOW_ERROR, to + WINDOW_ERROR])
            .collect();
        Self { intervals }
    }

    #[inline]
    pub(super) fn has(&self, folded: f64) -> bool {
        self.intervals.iter().any(|[from, to]| folded >= *from && folded <= *to)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_folded_angle_is_wanted_if_one_it_unfolds_to_is() {
        const ANGLES: u32 = 1000;
        for turn in [TAU, PI, TAU / 3.0, TAU / 7.0] {
            for hold in [Hold::Firing, Hold::Pins] {
                for window in [[0.0, 180.0], [20.0, 31.0], [0.0, 5.0], [88.0, 92.5], [170.0, 180.0]]
                {
                    let wanted = WindowTarget::new(window, hold, turn);
                    for step in 0..ANGLES {
                        // Halves, so that none is at the edge of a window.
                        let folded = 0.5 * turn * (f64::from(step) + 0.5) / f64::from(ANGLES);
                        let unfolded = (0..8).flat_map(|k| {
                            let middle = f64::from(k) * turn;
                            [middle - folded, middle + folded]
                        });
                        let expected =
                            unfolded.filter(|angle| (0.0..=PI).contains(angle)).any(|angle| {
                                let within = |radians: f64| {
                                    (window[0]..=window[1]).contains(&radians.to_degrees())
                                };
                                match hold {
                                    Hold::Firing => within(angle),
                                    Hold::Pins => within(0.5 * angle) || within(PI - 0.5 * angle),
                                }
                            });
                        assert_eq!(wanted.has(folded), expected, "{turn} {hold:?} {window:?}");
                    }
                }
            }
        }
        assert!(!WindowTarget::new([50.0, 40.0], Hold::Firing, 1.0).has(0.3));
    }
}
