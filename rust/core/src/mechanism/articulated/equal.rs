//! Knuckles at which the travel of a link rod's piston equals that of its master's: Newton's method on the ends of the
//! travel, whose angles do not count, as positions are stationary there.

use super::{Knuckle, Linkage};
use crate::Complex64;
use crate::mechanism::Cylinder;
use crate::mechanism::motion::CrankPosition;
use crate::numbers::angle::Angle;
use crate::numbers::error::Result;

/// Most steps; each about doubles the digits.
const MOST_STEPS: usize = 60;
/// Most halvings of a step.
const MOST_HALVINGS: usize = 40;
/// Longest step of an angle, radians: knuckles are near their bores.
const LONGEST_TURN: f64 = 0.1;
/// Difference that is rounding, over the largest height.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What is equal of a link rod's piston and its master's, at a knuckle that is solved for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EqualTravel {
    /// The stroke, by the angle of the knuckle.
    Stroke,
    /// Stroke and height, by its angle and radius: whatever the distance of the heads, the compression ratio.
    Compression,
}

/// Differences of height and stroke from the master's, over the crank radius, and their derivatives over radius and
/// angle of the knuckle.
struct Difference {
    height: f64,
    stroke: f64,
    /// By radius and by angle.
    of_height: [f64; 2],
    of_stroke: [f64; 2],
}

impl EqualTravel {
    /// Its word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Stroke => "stroke",
            Self::Compression => "compression",
        }
    }

    /// That of a word.
    #[must_use]
    pub fn named(word: &str) -> Option<Self> {
        [Self::Stroke, Self::Compression].into_iter().find(|equal| equal.word() == word)
    }

    /// Size of what should be zero.
    fn size(self, difference: &Difference) -> f64 {
        match self {
            Self::Stroke => difference.stroke.abs(),
            Self::Compression => difference.height.abs().max(difference.stroke.abs()),
        }
    }

    /// Changes of radius and angle that would make it zero.
    fn step(self, difference: &Difference) -> [f64; 2] {
        let Difference { height, stroke, of_height: [ha, hp], of_stroke: [sa, sp] } = *difference;
        match self {
            Self::Stroke => [0.0, -stroke / sp],
            Self::Compression => {
                let determinant = ha * sp - hp * sa;
                [hp * stroke - sp * height, sa * height - ha * stroke].map(|of| of / determinant)
            }
        }
    }
}

impl Knuckle {
    /// The knuckle near this one at which a piston has the height and the stroke, m, of its master's, or the stroke
    /// alone; none where none is.
    pub fn equalised(
        &self,
        cylinder: &Cylinder,
        equal: EqualTravel,
        of_master: [f64; 2],
    ) -> Result<Option<Self>> {
        self.check(cylinder)?;
        let crank_radius = cylinder.crank_radius();
        let goal = of_master.map(|length| length / crank_radius);
        let mut own = *self;
        let mut difference = Linkage::new(cylinder, &own).difference(goal);
        for _ in 0..MOST_STEPS {
            let size = equal.size(&difference);
            if size == 0.0 {
                break;
            }
            let [mut wider, mut turned] = equal.step(&difference);
            let part = (LONGEST_TURN / turned.abs()).min(1.0);
            (wider, turned) = (wider * part, turned * part);
            let mut better = None;
            for _ in 0..MOST_HALVINGS {
                let angle = Angle::from_degrees(own.angle.degrees() + turned.to_degrees());
                let radius = (own.radius / crank_radius + wider) * crank_radius;
                if let Ok(angle) = angle
                    && radius > 0.0
                {
                    let knuckle = Self { radius, angle: angle.reduced(), ..own };
                    let next = Linkage::new(cylinder, &knuckle).difference(goal);
                    if equal.size(&next) < size {
                        better = Some((knuckle, next));
                        break;
                    }
                }
                (wider, turned) = (0.5 * wider, 0.5 * turned);
                if size <= ROUNDING * goal[0] {
                    break;
                }
            }
            let Some(next) = better else { break };
            (own, difference) = next;
        }
        let is_equal = equal.size(&difference) <= ROUNDING * goal[0];
        Ok((is_equal && own.check(cylinder).is_ok()).then_some(own))
    }
}

impl Linkage {
    /// From a height and a stroke.
    fn difference(&self, [height, stroke]: [f64; 2]) -> Difference {
        let ends = self.turning_points_deg().map(CrankPosition::at_degrees);
        let [highest, lowest] = ends.map(|crank| self.motion(&crank).position);
        let [at_top, at_bottom] = ends.map(|crank| self.by_knuckle(&crank));
        Difference {
            height: highest - height,
            stroke: highest - lowest - stroke,
            of_height: at_top,
            of_stroke: [0, 1].map(|k| at_top[k] - at_bottom[k]),
        }
    }

    /// Derivatives of the piston's position over radius and angle of the knuckle.
    fn by_knuckle(&self, crank: &CrankPosition) -> [f64; 2] {
        let from_master = crank.sin * self.ahead.re + crank.cos * self.ahead.im;
        let lean = self.master_ratio * (self.master_offset - from_master);
        let upright = ((1.0 - lean) * (1.0 + lean)).sqrt();
        let outwards = self.knuckle * Complex64::new(upright, lean);
        let slope = self.motion(crank).slope;
        [outwards, Complex64::i() * outwards * self.radius].map(|of| of.re - slope * of.im)
    }
}
