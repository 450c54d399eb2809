//! What a sweep's rod ratios and pin offsets change: the harmonics of its gears.

use std::ops::Range;

use super::layout::Layout;
use super::{Quantity, Sweep};
use crate::Complex64;
use crate::gear::Gear;
use crate::gear::harmonics::rod::TorqueHarmonics;
use crate::gear::harmonics::table;
use crate::load::Harmonic;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::memory;
use crate::numbers::order::Order;

/// Real and imaginary parts at some points, order by order.
type Columns = Vec<[Vec<f64>; 2]>;

/// Harmonics at some points of rod ratio and pin offset.
pub(super) struct PointHarmonics(Vec<(Harmonic, Columns)>);

impl PointHarmonics {
    /// Those of a layout.
    pub fn new(
        sweep: &Sweep,
        (gears, layout): (&[Gear], &Layout),
        quantity: Quantity,
        points: &Range<usize>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let mut found: Vec<(Harmonic, Columns)> = Vec::new();
        for harmonic in layout.iter().flatten().map(|sum| sum.harmonic) {
            if found.iter().all(|(known, _)| *known != harmonic) {
                let columns = sweep.columns(gears, harmonic, quantity, points.clone(), cancel)?;
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
    /// Rod ratio and pin offset of a point, where they are swept.
    pub(super) fn at(&self, point: usize) -> (Option<f64>, Option<f64>) {
        let [ratios, offsets] = [&self.axes.rod_ratio, &self.axes.pin_offset];
        let in_a_row = offsets.as_ref().map_or(1, Vec::len);
        let ratio = ratios.as_ref().map(|ratios| ratios[point / in_a_row]);
        (ratio, offsets.as_ref().map(|offsets| offsets[point % in_a_row]))
    }

    /// A gear with the rod ratio and pin offset of a point.
    pub(super) fn at_point(&self, gear: &Gear, point: usize) -> Result<Gear> {
        let (ratio, offset) = self.at(point);
        gear.replaced(ratio, offset)
    }

    fn columns(
        &self,
        gears: &[Gear],
        harmonic: Harmonic,
        quantity: Quantity,
        points: Range<usize>,
        cancel: &Cancel,
    ) -> Result<Columns> {
        let mut columns = memory::room(self.orders.len())?;
        for _ in &self.orders {
            columns.push([memory::zeros(points.len())?, memory::zeros(points.len())?]);
        }
        let Some(gear) = harmonic.gear().map(|k| &gears[k]) else {
            for [re, _] in &mut columns {
                re.fill(1.0);
            }
            return Ok(columns);
        };
        let [ratios, offsets] = [&self.axes.rod_ratio, &self.axes.pin_offset];
        if let (Some(ratios), None, Harmonic::Force(_)) = (ratios, offsets, harmonic)
            && gear.is_centred()
            && gear.ratio.abs() == 1
        {
            let orders: Vec<u32> = self.orders.iter().filter_map(|n| n.as_whole()).collect();
            let table = table::centred_table(&ratios[points], &orders, cancel)?;
            let whole =
                self.orders.iter().zip(&mut columns).filter(|(n, _)| n.as_whole().is_some());
            for ((_, [re, _]), values) in whole.zip(table.columns()) {
                re.iter_mut().zip(values).for_each(|(out, &value)| *out = value);
            }
            return Ok(columns);
        }
        for (row, point) in points.enumerate() {
            cancel.check()?;
            let gear = self.at_point(gear, point)?;
            let values = quantity.among(of(&gear, harmonic, &self.orders, cancel)?);
            for ([re, im], value) in columns.iter_mut().zip(values) {
                (re[row], im[row]) = (value.re, value.im);
            }
        }
        Ok(columns)
    }
}

impl Quantity {
    /// Its own of two harmonics; those of forces are alike.
    fn among(self, harmonics: TorqueHarmonics) -> Vec<Complex64> {
        if matches!(self, Self::CrankTorque(_)) { harmonics.crank } else { harmonics.roll }
    }
}

/// Harmonics of a gear, for the torque on the block and on the crank; those of forces twice.
pub(super) fn of(
    gear: &Gear,
    harmonic: Harmonic,
    orders: &[Order],
    cancel: &Cancel,
) -> Result<TorqueHarmonics> {
    let force = match harmonic {
        Harmonic::Torque(_) => return gear.torque(orders, cancel),
        Harmonic::Rod(_) => return gear.rod_torque(orders, cancel),
        Harmonic::Gas(_) => return Ok(gear.gas(orders, None, cancel)?.0),
        Harmonic::One => vec![Complex64::new(1.0, 0.0); orders.len()],
        Harmonic::Force(_) => gear.force(orders, cancel)?,
    };
    Ok(TorqueHarmonics { roll: force.clone(), crank: force })
}
