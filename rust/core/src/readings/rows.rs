//! Rows of a page: values by order as polynomials in the rod ratio, which pictures of a turning engine
//! evaluate and sum.
//!
//! The variable q is the tangent of half the rod's largest swing: harmonic n of a piston is qⁿ⁻¹ times a series in
//! q² that converges wherever the crank turns.

use serde::{Serialize, Serializer};
use serde_json::json;

use super::figures::HIGHEST_LISTED;
use crate::engine::Engine;
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::error::Result;
use crate::numbers::figure;

/// Rod ratios that a page reaches, besides the engine's own: of 20 crank radii to 1.4.
const REACHED_ROD_RATIOS: [f64; 2] = [0.05, 0.7];
/// Part of the largest rod ratio at which the crank turns that a page reaches at most.
const PART_OF_TURNING: f64 = 0.9;
/// Least rod ratio over the largest, where that is a small one.
const LEAST_OF_LARGEST: f64 = 0.9;
/// Sums and coefficients below this part of what they are added to are rounding, and left out.
pub(super) const ROW_ROUNDING: f64 = 1e-13;
/// Polynomials that are enough have coefficients below this many roundings in their last eighth; ways in which an
/// order changes are smaller than as many of the largest.
const SMALL_IN_ROUNDINGS: f64 = 10.0;
/// Rod ratios at which rows are computed: twice as many until their polynomials have converged.
pub(super) const FEWEST_ROD_RATIOS: usize = 16;
const MOST_ROD_RATIOS: usize = 512;

/// Rod ratios that a page reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RodRatios {
    /// The least.
    pub least: f64,
    /// The largest.
    pub most: f64,
    /// The crank turns below this one.
    pub turning: f64,
    /// The engine's own, of all cylinders; none where they differ.
    pub common: Option<f64>,
}

impl RodRatios {
    /// Those of an engine; none but its own where others would fire its chambers at other crank angles, or move
    /// link rods elsewhere.
    #[must_use]
    pub fn reached(engine: &Engine) -> Option<Self> {
        (!engine.rods_time_chambers() && !engine.has_link_rods()).then(|| Self::of(engine))
    }

    /// Those of an engine, whose own is among them.
    #[must_use]
    pub fn of(engine: &Engine) -> Self {
        let cylinders = engine.distinct_cylinders();
        let offset = cylinders.iter().map(|c| c.pin_offset().abs() / c.crank_radius());
        let turning = 1.0 / (1.0 + offset.fold(0.0, f64::max));
        let mut own = cylinders.iter().map(Cylinder::rod_ratio);
        let first = own.next();
        let common = first.filter(|&first| own.all(|ratio| ratio == first));
        let [least, most] = REACHED_ROD_RATIOS;
        let most = (1e3 * most.min(PART_OF_TURNING * turning)).floor() / 1e3;
        let most = common.map_or(most, |own| most.max(own));
        let least = least.min(LEAST_OF_LARGEST * most);
        let least = common.map_or(least, |own| least.min(own));
        Self { least, most, turning, common }
    }

    /// Chebyshev's points in q, ascending, and the rod ratios there.
    fn points(&self, count: usize) -> Vec<(f64, f64)> {
        // The tangent of half an angle of this sine, and the sine.
        let [low, high] = [self.least, self.most].map(|ratio| ratio / self.turning);
        let [low, high] =
            [low, high].map(|sine| sine / (1.0 + ((1.0 - sine) * (1.0 + sine)).sqrt()));
        let point = |k: usize| {
            let q = low + 0.5 * (high - low) * (1.0 + chebyshev_angle(k, count).cos());
            let ratio = self.turning * 2.0 * q / (1.0 + q * q);
            (q, ratio.clamp(self.least, self.most))
        };
        (0..count).map(point).collect()
    }
}

impl Serialize for RodRatios {
    fn serialize<S: Serializer>(&self, to: S) -> std::result::Result<S::Ok, S::Error> {
        [self.least, self.most, self.turning].serialize(to)
    }
}

/// Angle whose cosine is Chebyshev's point k of a number of them, ascending.
fn chebyshev_angle(k: usize, count: usize) -> f64 {
    std::f64::consts::PI * ((count - k) as f64 - 0.5) / count as f64
}

/// Values of an order: order, power, polynomial, values of groups, and the factor at the engine's own rod ratios.
///
/// A term of a group is its values times a factor: q to the power times a sum of Chebyshev's polynomials.
#[derive(Debug, Clone, PartialEq)]
pub struct PageRow {
    order: f64,
    power: u32,
    polynomial: Vec<f64>,
    groups: Vec<(usize, Vec<f64>)>,
    own: Option<f64>,
}

impl PageRow {
    /// One that no rod ratio changes; none without values.
    fn still(order: f64, groups: Vec<(usize, Vec<f64>)>) -> Option<Self> {
        let row = Self { order, power: 0, polynomial: vec![1.0], groups, own: Some(1.0) };
        (!row.groups.is_empty()).then_some(row)
    }
}

impl Serialize for PageRow {
    fn serialize<S: Serializer>(&self, to: S) -> std::result::Result<S::Ok, S::Error> {
        let short = |values: &[f64]| values.iter().copied().map(Short).collect::<Vec<_>>();
        let group = |(group, values): &(usize, Vec<f64>)| {
            let mut listed = vec![Short(*group as f64)];
            listed.extend(short(values));
            listed
        };
        let groups: Vec<_> = self.groups.iter().map(group).collect();
        let (order, polynomial) = (Short(self.order), short(&self.polynomial));
        let mut row = vec![json!(order), json!(self.power), json!(polynomial), json!(groups)];
        row.extend(self.own.map(|own| json!(Short(own))));
        row.serialize(to)
    }
}

/// A number that is written without a point where it is whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Short(pub(super) f64);

impl Serialize for Short {
    fn serialize<S: Serializer>(&self, to: S) -> std::result::Result<S::Ok, S::Error> {
        let whole = self.0 as i32;
        if f64::from(whole) == self.0 { to.serialize_i32(whole) } else { to.serialize_f64(self.0) }
    }
}

/// Values by order of some groups at one rod ratio.
pub(super) struct OrderTable {
    /// Order, the power of q with which it begins, and values, those of each group side by side.
    pub(super) orders: Vec<(f64, u32, Vec<f64>)>,
    /// Of a group.
    pub(super) width: usize,
    /// Part of the largest that is rounding.
    pub(super) rounding: f64,
    /// Whether every order is precise in itself, and not only in the sum of all.
    pub(super) relative: bool,
}

impl OrderTable {
    /// Values of the groups that have some.
    fn groups(&self, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
        let groups = values.chunks(self.width).enumerate();
        let listed = groups.filter(|(_, values)| values.iter().any(|&value| value != 0.0));
        listed.map(|(group, values)| (group, values.to_vec())).collect()
    }

    /// Rows that no rod ratio changes.
    pub(super) fn still(&self) -> Vec<PageRow> {
        let rows = self.orders.iter();
        rows.filter_map(|(order, _, values)| PageRow::still(*order, self.groups(values))).collect()
    }
}

/// Rows of tables: of all rod ratios that a page reaches, or of the engine's own alone.
pub(super) fn rows_of(
    engine: &Engine,
    ratios: Option<&RodRatios>,
    fewest: usize,
    sample: &dyn Fn(&Engine) -> Result<Vec<OrderTable>>,
) -> Result<Vec<Vec<PageRow>>> {
    let Some(ratios) = ratios else {
        return Ok(sample(engine)?.iter().map(OrderTable::still).collect());
    };
    let own = ratios.common.is_none().then(|| sample(engine)).transpose()?;
    let mut count = fewest;
    loop {
        let points = ratios.points(count);
        let at = |&(_, ratio): &(f64, f64)| sample(&engine.at_rod_ratio(ratio)?);
        let sampled = points.iter().map(at).collect::<Result<Vec<_>>>()?;
        let q: Vec<f64> = points.iter().map(|(q, _)| *q).collect();
        let fitted = (0..sampled[0].len()).map(|t| {
            let tables: Vec<&OrderTable> = sampled.iter().map(|tables| &tables[t]).collect();
            polynomials(&tables, &q, own.as_ref().map(|own| &own[t]))
        });
        let (rows, enough): (Vec<_>, Vec<_>) = fitted.unzip();
        if count == 1 || count == MOST_ROD_RATIOS || enough.iter().all(|&enough| enough) {
            return Ok(rows);
        }
        count *= 2;
    }
}

/// Rows of tables at Chebyshev's points q, and whether the points are enough.
///
/// The values of an order change with the rod ratio in as few ways as there are kinds of cylinders: the largest entry
/// of their matrix has the column and the row of one way, and what is left has the others.
fn polynomials(
    tables: &[&OrderTable],
    q: &[f64],
    own: Option<&OrderTable>,
) -> (Vec<PageRow>, bool) {
    let (first, last, count) = (tables[0], tables.len() - 1, tables.len());
    let all = tables.iter().flat_map(|table| table.orders.iter().flat_map(|(.., values)| values));
    let largest = all.map(|value| value.abs()).fold(0.0, f64::max);
    let (mut rows, mut enough) = (Vec::new(), true);
    for (k, (order, power, _)) in first.orders.iter().enumerate() {
        let scale = |q: f64| q.powi(*power as i32);
        let middle = scale(q[count / 2]);
        let scaled = |table: &OrderTable, by: f64| -> Vec<f64> {
            table.orders[k].2.iter().map(|value| value / by).collect()
        };
        let at_points = tables.iter().zip(q).map(|(table, &q)| scaled(table, scale(q)));
        let ways = ways(at_points.chain(own.map(|own| scaled(own, middle))).collect());
        let Some((strongest, _)) = ways.first() else { continue };
        let mut fitted: Vec<Vec<f64>> =
            ways.iter().map(|(column, _)| coefficients(&column[..count])).collect();
        let size = |values: &[f64]| values.iter().map(|value| value.abs()).fold(0.0, f64::max);
        let peak = fitted.iter().map(|own| size(own)).fold(f64::MIN_POSITIVE, f64::max);
        let mut allowed = first.rounding * peak;
        if !first.relative || *order > f64::from(HIGHEST_LISTED) {
            allowed = allowed.max(first.rounding * largest / scale(q[last]));
        }
        let rest = count - count.div_ceil(8);
        enough &= fitted.iter().all(|own| size(&own[rest..]) <= SMALL_IN_ROUNDINGS * allowed);
        let decimals = (-allowed.log10().floor()).max(0.0) as usize;
        let digits = (size(strongest) / allowed).log10().ceil().max(0.0) as usize;
        for (polynomial, (column, direction)) in fitted.iter_mut().zip(&ways) {
            for value in polynomial.iter_mut() {
                let is_rounding = value.abs() <= allowed;
                *value = if is_rounding { 0.0 } else { figure::rounded(*value, decimals) };
            }
            polynomial
                .truncate(polynomial.iter().rposition(|&value| value != 0.0).map_or(0, |k| k + 1));
            let direction: Vec<f64> =
                direction.iter().map(|&value| figure::rounded(value, digits)).collect();
            let groups = first.groups(&direction);
            if !groups.is_empty() && (!polynomial.is_empty() || own.is_some()) {
                let own = own.map(|_| column[count] * middle);
                let polynomial = std::mem::take(polynomial);
                rows.push(PageRow { order: *order, power: *power, polynomial, groups, own });
            }
        }
    }
    (rows, enough)
}

/// Columns and rows whose products are a matrix, largest first, of which no entry of a row is above one.
fn ways(mut rest: Vec<Vec<f64>>) -> Vec<(Vec<f64>, Vec<f64>)> {
    let mut ways = Vec::new();
    let mut negligible = 0.0;
    loop {
        let mut pivot = (0, 0, 0.0_f64);
        for (i, row) in rest.iter().enumerate() {
            for (j, &value) in row.iter().enumerate() {
                if value.abs() > pivot.2.abs() {
                    pivot = (i, j, value);
                }
            }
        }
        let (i, j, value) = pivot;
        if ways.is_empty() {
            negligible = SMALL_IN_ROUNDINGS * ROW_ROUNDING * value.abs();
        }
        if value.abs() <= negligible {
            return ways;
        }
        let column: Vec<f64> = rest.iter().map(|row| row[j]).collect();
        let direction: Vec<f64> = rest[i].iter().map(|entry| entry / value).collect();
        for (row, &size) in rest.iter_mut().zip(&column) {
            for (entry, &by) in row.iter_mut().zip(&direction) {
                *entry -= size * by;
            }
        }
        // Exactly nothing: neither is chosen again.
        rest[i].fill(0.0);
        for row in &mut rest {
            row[j] = 0.0;
        }
        ways.push((column, direction));
    }
}

/// Coefficients of Chebyshev's polynomials through values at their points.
fn coefficients(values: &[f64]) -> Vec<f64> {
    let count = values.len();
    let coefficient = |n: usize| {
        let term = |(k, value): (usize, &f64)| value * (n as f64 * chebyshev_angle(k, count)).cos();
        let sum: f64 = values.iter().enumerate().map(term).sum();
        sum * if n == 0 { 1.0 } else { 2.0 } / count as f64
    };
    (0..count).map(coefficient).collect()
}
