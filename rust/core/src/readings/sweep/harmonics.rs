//! What a sweep's rod ratios and pin offsets change: the amplitudes of its sources.

use std::ops::Range;
use std::sync::Arc;

use super::layout::Layout;
use super::{Selection, Sweep};
use crate::Complex64;
use crate::load::{Harmonic, Sources};
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::order::Order;
use crate::numbers::pool;
use crate::pressure::Cycle;
use crate::readings::quantity::Kind;
use crate::source::{Column, Point, Source, at_point};

/// Real and imaginary parts at some points, order by order.
type PointColumns = Vec<[Vec<f64>; 2]>;

/// Harmonics at some points of rod ratio and pin offset.
pub(super) struct PointHarmonics(Vec<(Harmonic, PointColumns)>);

impl PointHarmonics {
    /// Those of a layout.
    pub fn new(
        sweep: &Sweep,
        (sources, layout): (&Sources, &Layout),
        selection: Selection,
        points: &Range<usize>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let mut found: Vec<(Harmonic, PointColumns)> = Vec::new();
        for harmonic in layout.iter().flatten().map(|sum| sum.harmonic) {
            if found.iter().all(|(known, _)| *known != harmonic) {
                let columns =
                    sweep.columns(sources, harmonic, selection, points.clone(), cancel)?;
                found.push((harmonic, columns));
            }
        }
        Ok(Self(found))
    }

    /// Real and imaginary parts of a harmonic at an order; none where it is zero everywhere.
    pub fn of(&self, harmonic: Harmonic, order: usize) -> Option<&[Vec<f64>; 2]> {
        let (_, columns) = self.0.iter().find(|(known, _)| *known == harmonic)?;
        columns.get(order)
    }
}

impl Sweep {
    /// What a point of a quantity replaces: the cycle changes first.
    pub(super) fn at(&self, selection: Selection, point: usize) -> Point<'_> {
        let cycles = self.cycles_of(selection);
        Point { cycles: self.cycles_at(point % cycles), ..self.proportions_at(point / cycles) }
    }

    /// Cycles of a map at one of its speeds and loads.
    pub(super) fn cycles_at(&self, node: usize) -> Option<&[Arc<Cycle>]> {
        self.axes.map.as_ref().map(|map| &map.cycles[node][..])
    }

    /// Rod ratio and pin offset of a point, where they are swept.
    pub(super) fn proportions_at(&self, point: usize) -> Point<'static> {
        let [ratios, offsets] = [&self.axes.rod_ratio, &self.axes.pin_offset];
        let in_a_row = offsets.as_ref().map_or(1, Vec::len);
        Point {
            rod_ratio: ratios.as_ref().map(|ratios| ratios[point / in_a_row]),
            pin_offset: offsets.as_ref().map(|offsets| offsets[point % in_a_row]),
            cycles: None,
        }
    }

    fn columns(
        &self,
        sources: &Sources,
        harmonic: Harmonic,
        selection: Selection,
        points: Range<usize>,
        cancel: &Cancel,
    ) -> Result<PointColumns> {
        let mut columns = memory::with_capacity(self.orders.len())?;
        for _ in &self.orders {
            columns.push([memory::zeros(points.len())?, memory::zeros(points.len())?]);
        }
        let (source, column) = (&sources[harmonic.source], harmonic.column);
        let Some(mechanism) = source.mechanism() else {
            let values = selection.among(of(&**source, column, &self.orders, cancel)?);
            for ([re, im], value) in columns.iter_mut().zip(values) {
                re.fill(value.re);
                im.fill(value.im);
            }
            return Ok(columns);
        };
        let [ratios, offsets] = [&self.axes.rod_ratio, &self.axes.pin_offset];
        let whole: Vec<u32> = self.orders.iter().filter_map(|n| n.as_whole()).collect();
        if let (Some(ratios), None, Column::Force) = (ratios, offsets, column)
            && mechanism.ratio.is_crank_speed()
            && let Some(table) =
                mechanism.mechanism.force_at_ratios(&ratios[points.clone()], &whole, cancel)
        {
            let table = table?;
            let whole =
                self.orders.iter().zip(&mut columns).filter(|(n, _)| n.as_whole().is_some());
            for ((_, [re, _]), values) in whole.zip(table.columns()) {
                re.iter_mut().zip(values).for_each(|(out, &value)| *out = value);
            }
            return Ok(columns);
        }
        let mut write = |row: usize, values: Vec<Complex64>| {
            for ([re, im], value) in columns.iter_mut().zip(values) {
                (re[row], im[row]) = (value.re, value.im);
            }
        };
        let at = |point| at_point(source, &self.at(selection, point));
        let values = |source: Arc<dyn Source>| {
            cancel.check()?;
            Ok(selection.among(of(&*source, column, &self.orders, cancel)?))
        };
        if source.has_open_tail() {
            let sources = points.map(at).collect::<Result<Vec<_>>>()?;
            let integrated = sources.iter().filter(|source| source.is_integrated(&self.orders));
            let several = integrated.count() > 3;
            let values = pool::map_if(several, cancel, sources, values)?;
            values.into_iter().enumerate().for_each(|(row, values)| write(row, values));
        } else {
            for (row, point) in points.enumerate() {
                write(row, values(at(point)?)?);
            }
        }
        Ok(columns)
    }
}

impl Selection<'_> {
    /// Its own of two harmonics; those of forces are alike.
    fn among(self, harmonics: TorqueHarmonics) -> Vec<Complex64> {
        if self.quantity.kind == Kind::CrankTorque { harmonics.crank } else { harmonics.roll }
    }
}

/// Amplitudes of a source, for the torque on the block and on the crank; those of forces twice.
pub(super) fn of(
    source: &dyn Source,
    column: Column,
    orders: &[Order],
    cancel: &Cancel,
) -> Result<TorqueHarmonics> {
    match column {
        Column::Force => {
            let force = source.force(orders, cancel)?;
            Ok(TorqueHarmonics { roll: force.clone(), crank: force })
        }
        Column::Roll => Ok(source.torque(orders, cancel)?.harmonics),
    }
}
