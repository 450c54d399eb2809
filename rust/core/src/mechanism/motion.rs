//! Where a crank stands, and how what it drives moves there.

use crate::Complex64;

/// Where a crank stands, as far as nothing of the rod enters.
#[derive(Debug, Clone, Copy)]
pub struct CrankPosition {
    /// sin θ.
    pub sin: f64,
    /// cos θ.
    pub cos: f64,
    /// cos²θ.
    pub(crate) squared: f64,
    /// 1 − sin θ.
    pub(crate) to_above: f64,
    /// 1 + sin θ.
    pub(crate) to_below: f64,
}

impl CrankPosition {
    /// Where sine and cosine of the angle from the bore are these.
    #[must_use]
    #[inline(always)]
    pub fn new(sin: f64, cos: f64) -> Self {
        // (l + e − r sin θ)(l − e + r sin θ): with 1 ∓ sin θ = cos²θ/(1 ± sin θ) neither factor
        // loses digits where it is small.
        let squared = cos * cos;
        let (near, far) = (squared / (1.0 + sin.abs()), 1.0 + sin.abs());
        let (to_above, to_below) = if sin >= 0.0 { (near, far) } else { (far, near) };
        Self { sin, cos, squared, to_above, to_below }
    }

    /// Behind one of these cosine and sine by an angle of which `e^{iφ}` is the conjugate.
    #[inline(always)]
    fn turned(cos: f64, sin: f64, phase: Complex64) -> Self {
        Self::new(sin * phase.re + cos * phase.im, cos * phase.re - sin * phase.im)
    }
}

/// Where the piston is and how it moves, in crank radii; derivatives by crank angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// x/r, of an infinite rod from the middle of the stroke.
    pub position: f64,
    /// (dx/dθ)/r.
    pub velocity: f64,
    /// (d²x/dθ²)/r.
    pub acceleration: f64,
    /// (d³x/dθ³)/r.
    pub jerk: f64,
    /// tan φ of the rod's angle to the bore: above zero where its crankpin end lies on the side to
    /// which the crankpin swings after top dead centre.
    pub slope: f64,
    /// 1/cos φ.
    pub secant: f64,
}

/// How a rod turns, by crank angle: its angle to the bore is −φ about +z, sin φ = (r sin θ − e)/l.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swing {
    /// dφ/dθ.
    pub velocity: f64,
    /// d²φ/dθ².
    pub acceleration: f64,
}

impl Swing {
    /// Torque on the block over J·ω².
    #[inline(always)]
    pub(crate) fn roll(&self) -> f64 {
        self.acceleration * (1.0 + self.velocity)
    }

    /// Torque on the crank over J·ω².
    #[inline(always)]
    pub(crate) fn crank(&self) -> f64 {
        -self.acceleration * self.velocity
    }
}

/// Positions of a crank, side by side: units `e^{iθ}`, times one of a phase.
#[derive(Debug, Clone, Copy)]
pub struct Cranks<'a> {
    cos: &'a [f64],
    sin: &'a [f64],
    phase: Complex64,
    /// 1 − sin θ and 1 + sin θ where they are known: of units that are turned by the phase.
    reach: Option<[&'a [f64]; 2]>,
}

impl<'a> Cranks<'a> {
    /// At angles of which these are cosines and sines, as many of both, and `e^{iφ}` of a phase that is added.
    #[inline(always)]
    pub(crate) fn new(cos: &'a [f64], sin: &'a [f64], phase: Complex64) -> Self {
        Self { cos, sin, phase, reach: None }
    }

    /// With cosines, sines, and 1 ∓ sin θ of the positions themselves.
    #[inline(always)]
    pub(crate) fn known([cos, sin, to_above, to_below]: [&'a [f64]; 4]) -> Self {
        Self { cos, sin, phase: Complex64::ONE, reach: Some([to_above, to_below]) }
    }

    /// How many.
    #[must_use]
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.cos.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cos.is_empty()
    }

    /// One of them.
    #[must_use]
    #[inline(always)]
    pub fn at(&self, i: usize) -> CrankPosition {
        CrankPosition::turned(self.cos[i], self.sin[i], self.phase)
    }
}

/// Motion of a piston at some positions of its crank, as in [`Motion`]; columns as long as there are positions.
#[derive(Debug)]
pub struct MotionColumns<'a> {
    /// (dx/dθ)/r.
    pub velocity: &'a mut [f64],
    /// (d²x/dθ²)/r.
    pub acceleration: &'a mut [f64],
    /// (d³x/dθ³)/r, if wanted.
    pub jerk: Option<&'a mut [f64]>,
    /// Slope and secant of the rod's angle to the bore, if wanted.
    pub lean: Option<[&'a mut [f64]; 2]>,
}

impl MotionColumns<'_> {
    /// Fills them one by one.
    #[inline(always)]
    pub fn fill(self, cranks: &Cranks, motion: impl Fn(&CrankPosition) -> Motion) {
        match self {
            Self { velocity, acceleration, jerk: None, lean: None } => {
                fill(
                    cranks,
                    [velocity, acceleration],
                    #[inline(always)]
                    |crank| {
                        let Motion { velocity, acceleration, .. } = motion(crank);
                        [velocity, acceleration]
                    },
                );
            }
            Self { velocity, acceleration, jerk: Some(jerk), lean: None } => {
                fill(
                    cranks,
                    [velocity, acceleration, jerk],
                    #[inline(always)]
                    |crank| {
                        let Motion { velocity, acceleration, jerk, .. } = motion(crank);
                        [velocity, acceleration, jerk]
                    },
                );
            }
            Self { velocity, acceleration, jerk, lean: Some([slope, secant]) } => {
                fill(
                    cranks,
                    [velocity, acceleration, slope, secant],
                    #[inline(always)]
                    |crank| {
                        let Motion { velocity, acceleration, slope, secant, .. } = motion(crank);
                        [velocity, acceleration, slope, secant]
                    },
                );
                if let Some(jerk) = jerk {
                    fill(
                        cranks,
                        [jerk],
                        #[inline(always)]
                        |crank| [motion(crank).jerk],
                    );
                }
            }
        }
    }
}

/// Fills columns with values at positions of a crank.
#[inline(always)]
pub(crate) fn fill<const N: usize>(
    cranks: &Cranks,
    columns: [&mut [f64]; N],
    values: impl Fn(&CrankPosition) -> [f64; N],
) {
    let count = cranks.len();
    // Of one length, so that the loop is free of checks.
    let (cos, sin) = (&cranks.cos[..count], &cranks.sin[..count]);
    let Some(reach) = cranks.reach else {
        return fill_at(
            count,
            columns,
            #[inline(always)]
            |i| values(&CrankPosition::turned(cos[i], sin[i], cranks.phase)),
        );
    };
    let [to_above, to_below] = reach.map(|column| &column[..count]);
    fill_at(
        count,
        columns,
        #[inline(always)]
        |i| {
            let (sin, cos, to_above, to_below) = (sin[i], cos[i], to_above[i], to_below[i]);
            values(&CrankPosition { sin, cos, squared: cos * cos, to_above, to_below })
        },
    );
}

#[inline(always)]
fn fill_at<const N: usize>(
    count: usize,
    mut columns: [&mut [f64]; N],
    values: impl Fn(usize) -> [f64; N],
) {
    let mut columns = columns.each_mut().map(|column| &mut column[..count]);
    for i in 0..count {
        for (column, value) in columns.iter_mut().zip(values(i)) {
            column[i] = value;
        }
    }
}
