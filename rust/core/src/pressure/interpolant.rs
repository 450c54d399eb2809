//! Piecewise polynomials through the points of a cycle.

use crate::numbers::chebyshev::{coefficient, jet, points};
use crate::numbers::error::{Error, Result};

/// Degree of the polynomials between the points of a table.
const CUBIC: usize = 3;
/// Highest degree of given polynomials.
const HIGHEST_DEGREE: usize = 32;

/// Difference of the ends of a closed grid, over the range of pressure, up to which they are one point.
const LARGEST_CLOSING_ERROR: f64 = 0.05;

/// Polynomials of one degree on adjoining panels of a period, as Chebyshev series.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Panels {
    /// Edges of the panels, degrees, ascending over one period: one more than panels.
    pub edges: Vec<f64>,
    pub degree: usize,
    /// `degree` + 1 coefficients of each panel.
    coefficients: Vec<f64>,
}

/// A point at which polynomials meet: values before and after it, equal unless pressure jumps.
#[derive(Clone, Copy)]
struct Knot {
    angle: f64,
    before: f64,
    after: f64,
}

impl Panels {
    /// Cubics through the points of a table that covers a period, closed if it repeats its first point.
    ///
    /// Slopes are those of the polynomial through five points, fourth order on any smooth grid,
    /// limited so that cubics do not overshoot monotone data (Hyman, SIAM J. Sci. Stat. Comput. 4
    /// (1983) 645). No stencil reaches across a jump.
    pub fn of_table(angles: &[f64], values: &[f64], period: f64, closed: bool) -> Result<Self> {
        let mut knots: Vec<Knot> = Vec::with_capacity(angles.len() + 1);
        for (&angle, &value) in angles.iter().zip(values) {
            match knots.last_mut() {
                Some(knot) if knot.angle == angle => knot.after = value,
                _ => knots.push(Knot { angle, before: value, after: value }),
            }
        }
        if closed && let Some(last) = knots.pop() {
            let first = &mut knots[0];
            let (before, after) = (last.before, first.after);
            let (low, high) = values
                .iter()
                .fold((f64::INFINITY, 0.0_f64), |(low, high), &p| (low.min(p), high.max(p)));
            if (after - before).abs() > LARGEST_CLOSING_ERROR * (high - low) {
                let hint = format!(
                    "the grid is closed, and a period earlier pressure is {after:?}; leave the \
                     last point out if pressure jumps there"
                );
                return Err(Error::figure(format!("pressure[{}]", values.len() - 1), before, hint));
            }
            // Rounding, or drift between cycles: the mean of both ends.
            let mean = 0.5 * (before + after);
            (first.before, first.after) = (mean, mean);
        }
        if knots.len() < 4 {
            let hint = "give at least four different angles";
            return Err(Error::value("theta_deg", format!("{} angles", knots.len()), hint));
        }
        let count = knots.len();
        let mut coefficients = Vec::with_capacity((CUBIC + 1) * count);
        for k in 0..count {
            let (here, next) = (at(&knots, k as isize, period), at(&knots, k as isize + 1, period));
            let half = 0.5 * (next.angle - here.angle);
            let slopes =
                [slope(&knots, k, true, period), slope(&knots, (k + 1) % count, false, period)];
            let [from, to] = slopes.map(|slope| slope * half);
            // On [−1, 1], by even and odd parts.
            let (sum, difference) = (here.after + next.before, next.before - here.after);
            let (bend, rise) = (0.25 * (to - from), 0.5 * (to + from));
            let cube = 0.5 * (rise - 0.5 * difference);
            let linear = 0.5 * difference - cube;
            let constant = 0.5 * sum - bend;
            coefficients.extend([
                constant + 0.5 * bend,
                linear + 0.75 * cube,
                0.5 * bend,
                0.25 * cube,
            ]);
        }
        let mut edges: Vec<f64> = knots.iter().map(|knot| knot.angle).collect();
        edges.push(edges[0] + period);
        Ok(Self { edges, degree: CUBIC, coefficients })
    }

    /// Polynomials of a degree through their values at the Chebyshev points of their panels, which
    /// begin and end at their edges.
    pub fn of_chebyshev(
        angles: &[f64],
        values: &[f64],
        period: f64,
        degree: usize,
    ) -> Result<Self> {
        let hint = |text: &str| Error::value("degree", degree, text);
        if !(1..=HIGHEST_DEGREE).contains(&degree) {
            return Err(hint("give a degree of polynomials from 1 to 32, or none for a table"));
        }
        if !angles.len().is_multiple_of(degree + 1) {
            return Err(hint("give degree + 1 points of each polynomial"));
        }
        let mut edges = vec![angles[0]];
        let mut coefficients = Vec::with_capacity(values.len());
        for (nodes, values) in angles.chunks(degree + 1).zip(values.chunks(degree + 1)) {
            let (from, to) = (nodes[0], nodes[degree]);
            let mut both = nodes.iter().zip(points(from, to, degree));
            if edges[edges.len() - 1] != from
                || from >= to
                || both.any(|(angle, point)| (angle - point).abs() > 1e-9 * period)
            {
                return Err(hint("angles are not Chebyshev points of adjoining panels"));
            }
            edges.push(to);
            for n in 0..=degree {
                coefficients.push(coefficient(values, n));
            }
        }
        if (edges[edges.len() - 1] - edges[0] - period).abs() > 1e-9 * period {
            return Err(hint("panels do not cover one period"));
        }
        Ok(Self { edges, degree, coefficients })
    }

    /// Coefficients of a panel.
    pub fn panel(&self, k: usize) -> &[f64] {
        &self.coefficients[k * (self.degree + 1)..(k + 1) * (self.degree + 1)]
    }

    /// Value at any angle, degrees.
    pub fn value(&self, angle: f64) -> f64 {
        self.beside(angle, angle)
    }

    /// Value at an angle of the polynomial that counts at another one.
    pub fn beside(&self, angle: f64, at: f64) -> f64 {
        let (first, last) = (self.edges[0], self.edges[self.edges.len() - 1]);
        let within = first + (at - first).rem_euclid(last - first);
        let angle = within + (angle - at);
        let panel =
            self.edges.partition_point(|&edge| edge <= within).clamp(1, self.edges.len() - 1) - 1;
        let (from, to) = (self.edges[panel], self.edges[panel + 1]);
        let place = ((angle - from) - (to - angle)) / (to - from);
        jet(self.panel(panel), place.clamp(-1.0, 1.0))[0]
    }
}

/// Points of the weighted sum of piecewise polynomials of one period: angles, values, and their degree.
///
/// The panels of the sum lie between all edges, so that it is exact.
pub(super) fn blend(parts: &[(f64, &Panels)]) -> (Vec<f64>, Vec<f64>, usize) {
    let first = parts[0].1;
    let (start, end) = (first.edges[0], first.edges[first.edges.len() - 1]);
    let period = end - start;
    let mut edges: Vec<f64> = parts
        .iter()
        .flat_map(|(_, panels)| &panels.edges)
        .map(|edge| start + (edge - start).rem_euclid(period))
        .chain([start])
        .collect();
    edges.sort_unstable_by(f64::total_cmp);
    // Edges that only rounding parts are one.
    edges.dedup_by(|later, before| *later - *before <= EQUAL_EDGES * period);
    edges.retain(|edge| end - edge > EQUAL_EDGES * period);
    edges.push(end);
    let degree = parts.iter().map(|(_, panels)| panels.degree).max().unwrap_or(CUBIC);
    let (mut angles, mut values) = (Vec::new(), Vec::new());
    for pair in edges.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        for angle in points(pair[0], pair[1], degree) {
            angles.push(angle);
            let sum: f64 =
                parts.iter().map(|(weight, panels)| weight * panels.beside(angle, middle)).sum();
            values.push(sum);
        }
    }
    (angles, values, degree)
}

/// Part of a period within which edges are one.
const EQUAL_EDGES: f64 = 1e-12;

/// Knot of any number, those of the neighbouring periods included.
fn at(knots: &[Knot], k: isize, period: f64) -> Knot {
    let count = knots.len() as isize;
    let knot = knots[k.rem_euclid(count) as usize];
    Knot { angle: knot.angle + period * k.div_euclid(count) as f64, ..knot }
}

/// Slope at a knot, after it or before it, per degree.
fn slope(knots: &[Knot], k: usize, after: bool, period: f64) -> f64 {
    let here = at(knots, k as isize, period);
    let jumps = |k: isize| {
        let knot = at(knots, k, period);
        knot.before != knot.after
    };
    // How far the stencil reaches, up to a jump, at most two points to either side, or four to one.
    let reach = |step: isize| {
        if jumps(k as isize) && (step > 0) != after {
            return 0;
        }
        let clear = (1..=4).take_while(|&n| n == 1 || !jumps(k as isize + step * (n - 1)));
        clear.last().unwrap_or(0)
    };
    let (back, forth) = (reach(-1), reach(1));
    let (back, forth) = (back.min(2.max(4 - forth)), forth.min(2.max(4 - back)));
    let own = if after { here.after } else { here.before };
    // Value of a point of the stencil on the side that is seen from here.
    let point = |n: isize| {
        let knot = at(knots, k as isize + n, period);
        (knot.angle - here.angle, if n > 0 { knot.before } else { knot.after } - own)
    };
    let stencil: Vec<(f64, f64)> = (-back..=forth).filter(|&n| n != 0).map(point).collect();
    let mut slope = 0.0;
    for (j, &(x, value)) in stencil.iter().enumerate() {
        let others = stencil.iter().enumerate().filter(|&(m, _)| m != j);
        slope += value / x * others.map(|(_, &(other, _))| other / (other - x)).product::<f64>();
    }
    let secant = |n: isize| {
        let (x, value) = point(n);
        value / x
    };
    let (before, after) = match (back, forth) {
        (0, _) => (secant(1), secant(1)),
        (_, 0) => (secant(-1), secant(-1)),
        _ => (secant(-1), secant(1)),
    };
    let largest = 3.0 * before.abs().min(after.abs());
    if before * after > 0.0 && slope * before <= 0.0 {
        return 0.0;
    }
    slope.clamp(-largest, largest)
}
