//! Loads over crank angle, exactly: those of one source that act together are one function times their sums.

use std::sync::Arc;

use super::{GroupIndex, Scene, SourceIndex, count, find_or_push};
use crate::Complex64;
use crate::numbers::angle::Angle;
use crate::numbers::crank_angles::CrankAngles;
use crate::numbers::index::List;
use crate::numbers::order::Order;
use crate::source::over_angle::LoadSum;
use crate::source::{Repeats, Scaling, Source};
use crate::wrench::rounding;

/// Loads of one source and phase.
pub(crate) struct SourceSum {
    pub source: Arc<dyn Source>,
    /// Index of the source.
    index: SourceIndex,
    /// Index into [`Scene::groups`].
    pub group: GroupIndex,
    pub loads: LoadSum,
}

/// An engine's loads as functions of crank angle.
pub(crate) struct Kinematics {
    pub sums: Vec<SourceSum>,
    /// Bounds of the rounding errors of force and moment that cancel, of each group over what it scales with.
    zero_bounds: List<GroupIndex, [f64; 2]>,
    scalings: List<GroupIndex, Scaling>,
}

impl Kinematics {
    pub fn new(loads: &Scene) -> Self {
        let (mut sums, mut zero_bounds) =
            (Vec::<SourceSum>::new(), loads.groups.map_to(|_| [0.0; 2]));
        let count = count(&loads.list, false);
        for load in &loads.list {
            let place = &load.place;
            let square = place.speed_squared();
            let mut force = place.unit * (load.weight * square);
            if load.weight != 0.0 {
                // At a top dead centre a piston exerts its mass·radius and more.
                let most = force.norm() * loads.source(load).scale().force;
                let size = rounding(count, place.ratio.size()) * most;
                let bounds = &mut zero_bounds[loads.group_of[load.source]];
                bounds[0] += size;
                bounds[1] += size * place.lever_size(loads.reference);
            }
            let mut phase = place.phase;
            if load.is_turning() {
                // All of one speed are one vector at θ = 0.
                force *= phase.cis(-load.turns_of_phase());
                phase = Angle::ZERO;
            }
            let of_phase = load.phase_multiple(Order::FIRST);
            let same = |sum: &SourceSum| (sum.index, sum.loads.phase) == (load.source, phase);
            let SourceSum { loads: sum, .. } = find_or_push(&mut sums, same, || SourceSum {
                source: Arc::clone(&loads.sources[load.source]),
                index: load.source,
                group: loads.group_of[load.source],
                loads: LoadSum {
                    phase,
                    halved: load.parts.repeats == Repeats::EveryTwoTurns,
                    ratio: place.ratio,
                    phase_deg: of_phase as f64 * phase.degrees(),
                    turned: phase.cis(-load.turns_of_phase().abs()),
                    force: Complex64::default(),
                    moment: Complex64::default(),
                    arm: Complex64::default(),
                    roll: 0.0,
                    has_opposite: false,
                },
            });
            sum.force += force;
            // A moment is its levered force turned by a quarter.
            sum.moment += Complex64::new(0.0, place.lever(loads.reference)) * force;
            sum.arm += place.axis.conj() * force;
            sum.roll += load.roll * square;
        }
        for i in 0..sums.len() {
            let (index, turned) = (sums[i].index, sums[i].loads.turned);
            let opposite = |own: &SourceSum| own.index == index && own.loads.turned == -turned;
            sums[i].loads.has_opposite = sums.iter().any(opposite);
        }
        let scalings = loads.groups.map_to(|group| group.scaling);
        Self { sums, zero_bounds, scalings }
    }

    /// What each group is multiplied by at a speed, rad/s.
    pub fn factors(&self, omega: f64) -> List<GroupIndex, f64> {
        self.scalings.map_to(|scaling| scaling.factor(omega))
    }

    /// Bounds of the rounding errors of force and moment that cancel: of groups times factors.
    pub fn zero_bounds(&self, factors: &List<GroupIndex, f64>) -> [f64; 2] {
        let bounds = self.zero_bounds.iter().zip(factors);
        bounds.fold([0.0; 2], |sum, (own, factor)| {
            [sum[0] + own[0] * factor, sum[1] + own[1] * factor]
        })
    }

    /// Adds the moment of inertia of what moves as seen from the main crank at a block of angles, kg·m²,
    /// and its slope.
    pub fn add_inertia(&self, angles: &CrankAngles, [inertia, slope]: [&mut [f64]; 2]) {
        for sum in &self.sums {
            sum.source.add_inertia(&sum.loads, angles, [&mut *inertia, &mut *slope]);
        }
    }
}
