//! A force of inertia that was given, order by order: it does not determine a torque, nor a motion.

use crate::Complex64;
use crate::mechanism::at_own_orders;
use crate::mechanism::spectrum::Spectrum;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::source::{
    ExactFactor, ForcePart, INERTIA, Parts, Scale, Series, Source, UpTo, is_equal,
};

/// Force over ω², kg·m: masses and radius are in it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GivenForce {
    pub spectrum: Spectrum,
    /// Speed of the crank.
    pub ratio: SpeedRatio,
}

impl Source for GivenForce {
    fn name(&self) -> &'static str {
        INERTIA
    }

    fn parts(&self) -> Parts {
        Parts::inertia(Some(ForcePart::Along), false)
    }

    fn equals(&self, other: &dyn Source) -> bool {
        is_equal(self, other)
    }

    fn force(&self, orders: &[Order], _: &Cancel) -> Result<Vec<Complex64>> {
        at_own_orders(self.ratio, orders, |own| {
            Ok(own.iter().map(|&n| self.spectrum.amplitude(n)).collect())
        })
    }

    fn series(&self, up_to: UpTo, _: &Cancel) -> Result<Series> {
        let own = self.spectrum.orders().into_iter();
        let order = |own| Order::from_halves(own * self.ratio.halves_of_speed());
        Ok(Series::unbounded(own.filter_map(|own| order(own).ok()).collect(), up_to))
    }

    fn scale(&self) -> Scale {
        Scale { force: self.spectrum.largest(), torque: Some(0.0), least: 0.0 }
    }

    fn exact(&self) -> ExactFactor {
        ExactFactor::Unknown
    }
}
