//! A mass off the axis of a shaft that turns evenly.

use crate::Complex64;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::numbers::simd::vectorised;
use crate::source::over_angle::{AngleBlock, BLOCK, Columns, LoadSum, Quantities};
use crate::source::{
    ExactFactor, ForcePart, INERTIA, Parts, Repeats, Scale, Series, Source, UpTo, is_equal,
};

/// Force over unbalance, ω² and the square of the shaft's speed, which this is.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TurningUnbalance {
    /// Speed of the shaft.
    pub ratio: SpeedRatio,
}

impl Source for TurningUnbalance {
    fn name(&self) -> &'static str {
        INERTIA
    }

    fn parts(&self) -> Parts {
        let repeats = match self.ratio.as_whole() {
            Some(_) => Repeats::EveryTurn,
            None => Repeats::EveryTwoTurns,
        };
        Parts { repeats, ..Parts::inertia(Some(ForcePart::Turning), false) }
    }

    fn equals(&self, other: &dyn Source) -> bool {
        is_equal(self, other)
    }

    /// One at every order: loads of it have none but that of their speed.
    fn force(&self, orders: &[Order], cancel: &Cancel) -> Result<Vec<Complex64>> {
        cancel.check()?;
        let own = self.ratio.order()?;
        let one = |order: &Order| Complex64::new(f64::from(u8::from(*order == own)), 0.0);
        Ok(orders.iter().map(one).collect())
    }

    fn series(&self, up_to: UpTo, _: &Cancel) -> Result<Series> {
        Ok(Series::unbounded(self.ratio.order().into_iter().collect(), up_to))
    }

    fn scale(&self) -> Scale {
        Scale { force: 1.0, ..Scale::default() }
    }

    fn exact(&self) -> ExactFactor {
        ExactFactor::One
    }

    fn over_angle(
        &self,
        sum: &LoadSum,
        block: &AngleBlock,
        wanted: Quantities,
        square: f64,
        columns: &mut Columns,
    ) -> Result<()> {
        let units = &*block.units(sum.ratio);
        let Columns { force: [force_x, force_y], moment: [moment_x, moment_y], torque, .. } =
            columns;
        let [force, moment, arm] = [sum.force, sum.moment, sum.arm].map(|sum| sum * square);
        vectorised(
            #[inline(always)]
            || {
                if wanted.force {
                    units.add_turning(force, sum.ratio.sense(), [force_x, force_y]);
                }
                if wanted.moment {
                    units.add_turning(moment, sum.ratio.sense(), [moment_x, moment_y]);
                }
                // A shaft that turns evenly takes no torque of the crank.
                if wanted.torque && arm != Complex64::default() {
                    let ([roll, _], mut real) = (torque, [0.0; BLOCK]);
                    units.add_turning(arm, sum.ratio.sense(), [&mut real, roll]);
                }
            },
        );
        Ok(())
    }
}
