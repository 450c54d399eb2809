//! Parts of force and moment that turn with a crank or shaft: weights on it can remove them.

use crate::Complex64;
use crate::engine::{CrankIndex, Engine};
use crate::load::Scene;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::ListIndex;
use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::readings::amplitude::SourceAmplitudes;
use crate::readings::balance::{Request, UNIT_RPM, angular_speed};
use crate::readings::terms::sums_by;
use crate::source::Scaling;
use crate::wrench::Wrench;

/// Force and moment that turn with a shaft, x + iy at θ = 0, over ω².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TurningPart {
    /// Force, kg·m.
    pub force: Complex64,
    /// Moment about the reference plane, kg·m².
    pub moment: Complex64,
}

impl TurningPart {
    /// Part of an order's wrench that turns with a shaft of this ratio.
    pub(crate) fn of(wrench: &Wrench, ratio: SpeedRatio) -> Self {
        let [force, moment] = [wrench.force, wrench.moment]
            .map(|vector| if ratio.is_forward() { vector.forward } else { vector.backward() });
        Self { force, moment }
    }
}

/// Part of an engine's force and moment that turns with a shaft of this ratio, over ω².
pub fn turning(engine: &Engine, ratio: SpeedRatio, cancel: &Cancel) -> Result<TurningPart> {
    let order = ratio.order()?;
    Ok(TurningPart::of(&over_square(engine, order, false, None, cancel)?, ratio))
}

/// The wrench of an order over ω², at a speed where some of it does not scale so.
pub(crate) fn over_square(
    engine: &Engine,
    order: Order,
    torque: bool,
    rpm: Option<f64>,
    cancel: &Cancel,
) -> Result<Wrench> {
    let omega = rpm.map(angular_speed).transpose()?;
    if let Some(rpm) = rpm.filter(|_| omega == Some(0.0)) {
        let hint = "shafts make no force at rest; give a speed above 0";
        return Err(Error::figure("rpm", rpm, hint));
    }
    engine.check_speeds(rpm.as_slice())?;
    let loads = Scene::of(engine, None)?;
    let torque = torque && engine.spectrum().is_none();
    let amplitudes = SourceAmplitudes::new(&loads.sources, torque, &[order], cancel)?;
    let by_group = amplitudes.wrenches(&loads, &loads.list, torque, &[order], cancel)?;
    let mut sum = Wrench::default();
    for (group, wrench) in loads.groups.iter().zip(&by_group) {
        let factor = match (group.scaling, omega) {
            (Scaling::SpeedSquared, _) => 1.0,
            (scaling, Some(omega)) => scaling.factor(omega) / (omega * omega),
            _ if wrench.is_zero() => continue,
            (_, None) => {
                let what = if wrench.torque.peak() > 0.0 { "torque" } else { "force" };
                let hint = format!(
                    "the {what} of {} does not scale with speed as that of shafts does; give the crank \
                     speed, above 0, at which they cancel it",
                    group.name
                );
                return Err(Error::value("rpm", "None", hint));
            }
        };
        sum = sum.plus(&wrench.scaled(factor));
    }
    Ok(sum)
}

/// Ratios of the cranks that carry throws and turn as fast as the main one, by sense, with their indices.
pub(crate) fn cranks_by_sense(engine: &Engine) -> [(SpeedRatio, Vec<CrankIndex>); 2] {
    [1, -1].map(SpeedRatio::whole).map(|ratio| {
        let carries = |&crank: &CrankIndex| {
            engine.cranks()[crank].ratio == ratio
                && (0..engine.stations().len()).any(|i| engine.crank_of(i) == crank)
        };
        (ratio, engine.cranks().indices().filter(carries).collect())
    })
}

/// What is to be balanced on each of some cranks of one ratio, over ω²: what its own cylinders and
/// counterweights exert in its sense, which then vanishes at its axis, and an even share of what all
/// other parts exert in that sense.
pub(crate) fn on_cranks(
    engine: &Engine,
    ratio: SpeedRatio,
    cranks: &[CrankIndex],
    cancel: &Cancel,
) -> Result<Vec<TurningPart>> {
    if cranks.len() == 1 {
        return Ok(vec![turning(engine, ratio, cancel)?]);
    }
    // Loads that do not scale with speed as weights do are rejected, as on one crank.
    turning(engine, ratio, cancel)?;
    let engine = &engine.of_speed_squared();
    let request = Request { rpm: UNIT_RPM, reference_z: None, torque: false };
    let others = cranks.len();
    let group_of = |part| {
        let crank = engine.crank_with(part);
        cranks.iter().position(|&own| Some(own) == crank).unwrap_or(others)
    };
    let order = [ratio.order()?];
    let sums = sums_by(engine, &request, [0.0; 2], &order, (others + 1, &group_of), cancel)?;
    let parts: Vec<TurningPart> =
        sums.iter().map(|sum| TurningPart::of(&sum.wrenches[0], ratio)).collect();
    let share = 1.0 / others as f64;
    let with_share = |own: &TurningPart| TurningPart {
        force: own.force + parts[others].force * share,
        moment: own.moment + parts[others].moment * share,
    };
    Ok(parts[..others].iter().map(with_share).collect())
}

/// Magnitudes of roll torque of inertia at order 1 about the axis of the main crank, over ω², kg·m².
pub(crate) struct RollOfAxes {
    /// All of it.
    pub whole: f64,
    /// That of forces of cranks on other axes.
    pub beside: f64,
    /// What is left of all by counterweights on the cranks that remove what [`on_cranks`] says.
    pub kept: f64,
}

/// The roll torque that cranks on several axes make.
pub(crate) fn roll_of_axes(engine: &Engine, cancel: &Cancel) -> Result<RollOfAxes> {
    /// Part of the terms of a sum that its rounding is below.
    const TERMS_ROUNDING: f64 = 1e-12;
    let engine = &engine.of_speed_squared();
    let axis = |crank: CrankIndex| {
        let [x, y] = engine.cranks()[crank].axis;
        Complex64::new(x, y)
    };
    let (cranks, request) =
        (engine.cranks().len(), Request { rpm: UNIT_RPM, reference_z: None, torque: false });
    let crank_of = |part| engine.crank_with(part).map_or(cranks, CrankIndex::position);
    let first = [Order::FIRST];
    let sums = sums_by(engine, &request, [0.0; 2], &first, (cranks + 1, &crank_of), cancel)?;
    let (mut beside, mut size) = (Complex64::default(), 0.0);
    for (crank, sum) in engine.cranks().indices().zip(&sums) {
        let [x, y] = sum.wrenches[0].force.xy(0.0);
        let at = axis(crank);
        beside += y * at.re - x * at.im;
        size += (x.norm() + y.norm()) * at.norm();
    }
    let whole = over_square(engine, Order::FIRST, true, None, cancel)?.torque.roll;
    let mut kept = whole;
    for (ratio, own) in cranks_by_sense(engine) {
        if own.is_empty() {
            continue;
        }
        for (part, &crank) in on_cranks(engine, ratio, &own, cancel)?.iter().zip(&own) {
            // Im(ā·F) of a force F·e^{±iθ} in place of the one that is there.
            let removed = Complex64::i() * axis(crank).conj() * part.force;
            kept += if ratio.is_forward() { removed } else { removed.conj() };
            size += removed.norm();
        }
    }
    let or_zero = |torque: Complex64| {
        if torque.norm() <= TERMS_ROUNDING * (size + whole.norm()) { 0.0 } else { torque.norm() }
    };
    Ok(RollOfAxes { whole: whole.norm(), beside: or_zero(beside), kept: or_zero(kept) })
}
