use super::*;
use crate::load::Scene;
use crate::load::tests::fired;
use crate::mechanism::DrivenMechanism;
use crate::source::over_angle::{AngleBlock, Columns, LoadSum, Quantities};
use crate::source::{
    Column, ExactFactor, Parts, Point, Scale, Series, TorqueAmplitudes, UpTo, resolved,
};

/// A source of the house under a name of its own.
#[derive(Debug)]
struct Renamed(Arc<dyn Source>);

impl Source for Renamed {
    fn name(&self) -> &'static str {
        "of the house"
    }

    fn parts(&self) -> Parts {
        self.0.parts()
    }

    fn mechanism(&self) -> Option<&DrivenMechanism> {
        self.0.mechanism()
    }

    fn force(&self, orders: &[Order], cancel: &Cancel) -> Result<Vec<Complex64>> {
        self.0.force(orders, cancel)
    }

    fn is_integrated(&self, orders: &[Order]) -> bool {
        self.0.is_integrated(orders)
    }

    fn torque(&self, orders: &[Order], cancel: &Cancel) -> Result<TorqueAmplitudes> {
        self.0.torque(orders, cancel)
    }

    fn series(&self, up_to: UpTo, cancel: &Cancel) -> Result<Series> {
        self.0.series(up_to, cancel)
    }

    fn scale(&self) -> Scale {
        self.0.scale()
    }

    fn sizes_up_to_own(
        &self,
        column: Column,
        orders: &[Order],
        cancel: &Cancel,
    ) -> Result<Option<[Vec<f64>; 2]>> {
        self.0.sizes_up_to_own(column, orders, cancel)
    }

    fn at_point(&self, point: &Point) -> Result<Option<Arc<dyn Source>>> {
        Ok(self.0.at_point(point)?.map(|source| -> Arc<dyn Source> { Arc::new(Self(source)) }))
    }

    fn exact(&self) -> ExactFactor {
        ExactFactor::Unknown
    }

    fn over_angle(
        &self,
        sum: &LoadSum,
        block: &AngleBlock,
        wanted: Quantities,
        factor: f64,
        columns: &mut Columns,
    ) -> Result<()> {
        self.0.over_angle(sum, block, wanted, factor, columns)
    }
}

#[test]
fn sources_of_the_house_are_counted_by_every_reading() {
    let (engine, _) = fired([Some(0); 3]);
    let amplitudes = crate::engine::Amplitudes(vec![
        (1, vec![Complex64::new(3.0, -4.0)]),
        (4, vec![Complex64::new(-2.0, 1.0)]),
    ]);
    let numbers = PeriodicLoad {
        force: amplitudes.clone(),
        torque: amplitudes,
        ..PeriodicLoad::new("numbers", ActsOn::Block)
    };
    let loads = Scene::anew(&engine.with_loads(vec![numbers]).unwrap(), 0.0);
    let mut kinds = Vec::new();
    for source in &loads.sources {
        let kind = format!("{source:?}").split([' ', '(']).next().unwrap_or_default().to_owned();
        if kinds.contains(&kind) {
            continue;
        }
        let mut load = PeriodicLoad::of(Renamed(Arc::clone(source)), ActsOn::Block);
        if source.parts().force == Some(ForcePart::Turning) {
            // The shaft that a force turns with has its speed.
            let own = resolved(&**source, &Cancel::new()).unwrap();
            load.ratio = crate::SpeedRatio::at(own[0], true);
        }
        check_source(&load, None).unwrap_or_else(|error| panic!("{kind}: {error}"));
        kinds.push(kind);
    }
    assert_eq!(
        kinds,
        ["PistonInertia", "TurningUnbalance", "GivenLoad", "GasPressure", "RodInertia"]
    );
}
