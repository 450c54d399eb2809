//! What a sweep's rod ratios and pin offsets change: the amplitudes of its pistons.

use std::ops::Range;

use super::layout::Layout;
use super::{Quantity, Sweep};
use crate::Complex64;
use crate::gear::harmonics::{self, table};
use crate::gear::slider_crank::{Cylinder, Proportions};
use crate::load::Channel;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;

/// A cylinder's proportions with rod ratio and pin offset replaced.
pub(super) fn proportions(
    cylinder: &Cylinder,
    rod_ratio: Option<f64>,
    pin_offset: Option<f64>,
) -> Result<Proportions> {
    let offset = pin_offset.unwrap_or(cylinder.pin_offset());
    let radius = cylinder.crank_radius();
    match rod_ratio {
        Some(ratio) => Proportions::new(ratio, offset / radius),
        None => Cylinder::new(radius, cylinder.rod_length(), 0.0, offset).map(|c| c.proportions()),
    }
}

/// Amplitudes of every channel at some points: real and imaginary parts, order by order.
pub(super) struct Amplitudes {
    channels: Vec<(Channel, Vec<[Vec<f64>; 2]>)>,
}

impl Amplitudes {
    /// Amplitudes at points of rod ratio and pin offset of the channels that a layout has.
    pub fn new(
        sweep: &Sweep,
        layout: &Layout,
        quantity: Quantity,
        points: Range<usize>,
        cancel: &Cancel,
    ) -> Result<Self> {
        let mut channels: Vec<(Channel, Vec<[Vec<f64>; 2]>)> = Vec::new();
        for channel in layout.by_order.iter().flatten().map(|sum| sum.channel) {
            if channel == Channel::Unit || channels.iter().any(|(known, _)| *known == channel) {
                continue;
            }
            let columns = sweep.amplitudes(layout, channel, quantity, points.clone(), cancel)?;
            channels.push((channel, columns));
        }
        Ok(Self { channels })
    }

    /// Those of a channel and order, at so many points.
    pub fn of(
        &self,
        channel: Channel,
        order: usize,
        points: usize,
    ) -> [std::borrow::Cow<'_, [f64]>; 2] {
        let found = self.channels.iter().find(|(known, _)| *known == channel);
        found.map_or_else(
            || [vec![1.0; points].into(), vec![0.0; points].into()],
            |(_, columns)| columns[order].each_ref().map(|column| column.as_slice().into()),
        )
    }
}

impl Sweep {
    fn amplitudes(
        &self,
        layout: &Layout,
        channel: Channel,
        quantity: Quantity,
        points: Range<usize>,
        cancel: &Cancel,
    ) -> Result<Vec<[Vec<f64>; 2]>> {
        let orders = &self.whole_orders();
        let mut columns: Vec<[Vec<f64>; 2]> =
            orders.iter().map(|_| [(); 2].map(|()| vec![0.0; points.len()])).collect();
        let (Channel::Masses(motion) | Channel::Rod(motion)) = channel else {
            return Ok(columns);
        };
        let cylinder = &layout.motions[motion];
        if let Some(spectrum) = &self.spectrum {
            for (column, &order) in columns.iter_mut().zip(orders) {
                let amplitude = spectrum.amplitude(order);
                column[0].fill(amplitude.re);
                column[1].fill(amplitude.im);
            }
            return Ok(columns);
        }
        let centred = cylinder.pin_offset() == 0.0 && self.axes.pin_offset.is_none();
        if let (Some(ratios), true, true) =
            (&self.axes.rod_ratio, centred, matches!(quantity, Quantity::Force | Quantity::Moment))
        {
            let table = table::centred_table(&ratios[points], orders, cancel)?;
            for (column, values) in columns.iter_mut().zip(table.columns()) {
                column[0].iter_mut().zip(values).for_each(|(out, &value)| *out = value);
            }
            return Ok(columns);
        }
        let offsets = self.axes.pin_offset.as_deref();
        let in_a_row = offsets.map_or(1, <[f64]>::len);
        for (row, point) in points.enumerate() {
            cancel.check()?;
            let ratio = self.axes.rod_ratio.as_ref().map(|ratios| ratios[point / in_a_row]);
            let offset = offsets.map(|offsets| offsets[point % in_a_row]);
            let proportions = proportions(cylinder, ratio, offset)?;
            let values = of_channel(channel, quantity, &proportions, orders, cancel)?;
            for (column, value) in columns.iter_mut().zip(values) {
                (column[0][row], column[1][row]) = (value.re, value.im);
            }
        }
        Ok(columns)
    }
}

/// Harmonics by which the sums of a channel are multiplied.
fn of_channel(
    channel: Channel,
    quantity: Quantity,
    proportions: &Proportions,
    orders: &[u32],
    cancel: &Cancel,
) -> Result<Vec<Complex64>> {
    let torques = match (channel, quantity) {
        (_, Quantity::Force | Quantity::Moment) => {
            return harmonics::coefficients(proportions, orders, cancel);
        }
        (Channel::Rod(_), _) => harmonics::rod::torque(proportions, orders, cancel)?,
        _ => harmonics::torque::torque(proportions, orders, cancel)?,
    };
    Ok(if quantity == Quantity::Torque { torques.roll } else { torques.crank })
}
