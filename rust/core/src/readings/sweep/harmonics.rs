//! What a sweep's rod ratios and pin offsets change: the amplitudes of its sources.

use std::ops::Range;
use std::sync::Arc;

use super::layout::Layout;
use super::{Selection, Sweep};
use crate::Complex64;
use crate::load::{Harmonic, Sources};
use crate::mechanism::harmonics::rod::TorqueHarmonics;
use crate::numbers::cancel::Cancel;
use crate::numbers::crank_angles::parts;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::pool;
use crate::pressure::Cycle;
use crate::readings::quantity::Kind;
use crate::source::{Column, Point, Source, amplitudes};

/// Sources at points that are evaluated side by side where they are integrated.
const SOURCES_AT_ONCE: usize = 64;

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
        let [ratios, offsets] = [&self.axes.rod_ratio, &self.axes.pin_offset];
        let whole: Vec<u32> = self.orders.iter().filter_map(|n| n.as_whole()).collect();
        if let (Some(ratios), None, Column::Force) = (ratios, offsets, column)
            && let Some(mechanism) = source.mechanism()
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
        let values = |source: &Arc<dyn Source>| {
            cancel.check()?;
            Ok(selection.among(amplitudes(&**source, column, &self.orders, cancel)?))
        };
        let at = |point| source.at_point(&self.at(selection, point));
        let Some(first) = at(points.start)? else {
            for ([re, im], value) in columns.iter_mut().zip(values(source)?) {
                re.fill(value.re);
                im.fill(value.im);
            }
            return Ok(columns);
        };
        let (mut first, mut row) = (Some(first), 0);
        for some in parts(points, SOURCES_AT_ONCE) {
            let source = |point| match first.take() {
                Some(first) => Ok(first),
                None => Ok(at(point)?.unwrap_or_else(|| Arc::clone(source))),
            };
            let sources = some.map(source).collect::<Result<Vec<_>>>()?;
            let integrated = sources.iter().filter(|source| source.is_integrated(&self.orders));
            let several = integrated.count() > 3;
            let values = pool::map_if(several, cancel, sources, |source| values(&source))?;
            for of_point in values {
                for ([re, im], value) in columns.iter_mut().zip(of_point) {
                    (re[row], im[row]) = (value.re, value.im);
                }
                row += 1;
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
