//! Radial engines: the cylinders of a row stand evenly around one crankpin.

use std::collections::BTreeMap;

use super::layout::{Spacing, Strokes, per_cylinder};
use super::{Engine, Station};
use crate::mechanism::cylinder::Cylinder;
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

/// Largest number of rows.
pub const MOST_ROWS: usize = 6;

/// A radial of one row or more.
///
/// Cylinder 1 is upright; numbers ascend in the direction of rotation, in several rows from row to row. Pins
/// of several rows share the turn, and cylinders of each row stand between those of the others.
///
/// ```
/// use crankpin_core::layout::Strokes;
/// use crankpin_core::engine::radial::Radial;
/// use crankpin_core::{Angle, Cylinder};
///
/// let nine = Radial {
///     cylinders: 9,
///     rows: 1,
///     spacing: None,
///     rotating_mass: vec![],
///     first_tdc: Angle::ZERO,
/// };
/// assert_eq!(nine.engine(Cylinder::new(0.066, 0.26, 2.5, 0.0)?)?.bank_directions().len(), 9);
/// assert_eq!(nine.firing_order(Strokes::Four), "1-3-5-7-9-2-4-6-8");
/// # Ok::<(), crankpin_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Radial {
    /// Number of cylinders of all rows.
    pub cylinders: usize,
    /// Number of rows.
    pub rows: usize,
    /// Distances between neighbouring rows; of one row they may be left out.
    pub spacing: Option<Spacing>,
    /// Mass that turns with each cylinder's pin, kg: none, one for all, or one for each.
    pub rotating_mass: Vec<f64>,
    /// Crank angle at which cylinder 1 is at top dead centre.
    pub first_tdc: Angle,
}

impl Radial {
    /// The engine with this cylinder throughout.
    pub fn engine(&self, cylinder: Cylinder) -> Result<Engine> {
        let Self { cylinders: count, rows, .. } = *self;
        self.check()?;
        let places = self.spacing.as_ref().unwrap_or(&Spacing::Even(0.0)).places(rows)?;
        let masses = per_cylinder(&self.rotating_mass, count)?;
        let part =
            |index: usize, of: usize| Angle::from_degree_fraction(360 * index as i64, of as i64);
        let station = |(place, rotating_mass): (usize, f64)| {
            let (around, row) = (part(place, count)?, place % rows);
            let (tdc, bank) = (around - part(row, rows)?, Angle::QUARTER_TURN + around);
            Ok(Station { cylinder, tdc, bank, z: places[row], rotating_mass })
        };
        let stations = masses.into_iter().enumerate().map(station).collect::<Result<_>>()?;
        Ok(Engine::new("", "", stations)?.with_first_tdc(self.first_tdc))
    }

    fn check(&self) -> Result<()> {
        let Self { cylinders, rows, ref spacing, .. } = *self;
        if !(1..=MOST_ROWS).contains(&rows) {
            let hint = format!("give 1 to {MOST_ROWS}; `Engine::new` takes any layout");
            return Err(Error::value("rows", rows, hint));
        }
        let hint = if !cylinders.is_multiple_of(rows) {
            format!("give a multiple of rows, {rows}: all rows have as many cylinders")
        } else if cylinders < 3 * rows {
            "give three or more to each row; two opposed cylinders are a `Vee` of 180°".to_owned()
        } else if cylinders > limits::MOST_CYLINDERS {
            format!("an engine has 1 to {}", limits::MOST_CYLINDERS)
        } else if spacing.is_none() && rows > 1 {
            return Err(Error::value("spacing", "None", "give the distance between rows, m"));
        } else {
            return Ok(());
        };
        Err(Error::value("cylinders", cylinders, hint))
    }

    /// The even firing order; empty if there is none.
    ///
    /// In a four-stroke each row fires at every second of its top dead centres. Cylinders of several rows
    /// that reach theirs together fire a turn apart, or together if their number is odd.
    #[must_use]
    pub fn firing_order(&self, strokes: Strokes) -> String {
        let Self { cylinders, rows, .. } = *self;
        let four = strokes == Strokes::Four;
        if self.check().is_err() || (four && (cylinders / rows).is_multiple_of(2)) {
            return String::new();
        }
        let turn = cylinders * rows; // in whole parts of it
        let tdc = |place: usize| (place * rows + turn - place % rows * cylinders) % turn;
        let mut best: Vec<Vec<usize>> = Vec::new();
        // The first row begins at once; any other may begin a turn later.
        for later in 0..if four { 1_usize << (rows - 1) } else { 1 } {
            let mut fired: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
            for place in 0..cylinders {
                let row = place % rows;
                let before =
                    (row..cylinders).step_by(rows).filter(|&other| tdc(other) < tdc(place));
                let begun_later = row > 0 && (later >> (rows - 1 - row)) & 1 == 1;
                let turns = if four { (before.count() + usize::from(begun_later)) % 2 } else { 0 };
                fired.entry(tdc(place) + turns * turn).or_default().push(place + 1);
            }
            let cycle = turn * strokes.turns() as usize;
            let times: Vec<usize> = fired.keys().copied().collect();
            let next = times.iter().skip(1).copied().chain([times[0] + cycle]);
            let mut intervals = times.iter().zip(next).map(|(now, then)| then - now);
            let interval = intervals.next();
            let groups: Vec<Vec<usize>> = fired.into_values().collect();
            let even = intervals.all(|other| Some(other) == interval)
                && groups.iter().all(|group| group.len() == groups[0].len());
            if even && groups.len() > best.len() {
                best = groups;
            }
        }
        let joined = |group: &Vec<usize>| {
            group.iter().map(ToString::to_string).collect::<Vec<_>>().join("+")
        };
        best.iter().map(joined).collect::<Vec<_>>().join("-")
    }
}
