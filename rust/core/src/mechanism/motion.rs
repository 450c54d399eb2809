//! Where a crank stands, and how what it drives moves there.

use crate::Complex64;
use crate::numbers::angle::cis_degrees;

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

    /// At an angle from the bore, degrees.
    pub(crate) fn at_degrees(degrees: f64) -> Self {
        let unit = cis_degrees(degrees);
        Self::new(unit.im, unit.re)
    }

    /// Where an angle has this cosine and sine, turned by one of which `e^{iφ}` is this.
    #[inline(always)]
    fn turned(cos: f64, sin: f64, phase: Complex64) -> Self {
        Self::new(sin * phase.re + cos * phase.im, cos * phase.re - sin * phase.im)
    }

    /// Half a turn on.
    #[inline(always)]
    pub(super) fn opposite(&self) -> Self {
        let Self { sin, cos, squared, to_above, to_below } = *self;
        Self { sin: -sin, cos: -cos, squared, to_above: to_below, to_below: to_above }
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

/// Positions of a crank, side by side.
#[derive(Debug, Clone, Copy)]
pub struct Cranks<'a>(Positions<'a>);

#[derive(Debug, Clone, Copy)]
enum Positions<'a> {
    /// Cosines and sines, and `e^{iφ}` of an angle by which all of them are turned.
    Turned([&'a [f64]; 2], Complex64),
    /// The parts of positions that are kept.
    Kept(KeptCranks<'a>),
}

#[derive(Debug, Clone, Copy)]
struct KeptCranks<'a> {
    sin: &'a [f64],
    cos: &'a [f64],
    to_above: &'a [f64],
    to_below: &'a [f64],
}

impl<'a> Cranks<'a> {
    /// Where angles have these cosines and sines; all of them are turned by an angle of which this is `e^{iφ}`.
    pub(crate) fn new(cos: &'a [f64], sin: &'a [f64], phase: Complex64) -> Self {
        Self(Positions::Turned([cos, sin], phase))
    }

    /// Number of them.
    #[must_use]
    pub fn len(&self) -> usize {
        match self.0 {
            Positions::Turned([cos, _], _) => cos.len(),
            Positions::Kept(kept) => kept.sin.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One of them.
    #[must_use]
    #[inline(always)]
    pub fn at(&self, i: usize) -> CrankPosition {
        match self.0 {
            Positions::Turned([cos, sin], phase) => CrankPosition::turned(cos[i], sin[i], phase),
            Positions::Kept(kept) => kept.at(i),
        }
    }
}

impl KeptCranks<'_> {
    #[inline(always)]
    fn at(&self, i: usize) -> CrankPosition {
        let (sin, cos) = (self.sin[i], self.cos[i]);
        let (to_above, to_below) = (self.to_above[i], self.to_below[i]);
        CrankPosition { sin, cos, squared: cos * cos, to_above, to_below }
    }
}

/// Columns of [`Cranks`]; whole lines of the cache.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(crate) struct CrankColumns<const N: usize> {
    sin: [f64; N],
    cos: [f64; N],
    to_above: [f64; N],
    to_below: [f64; N],
}

impl<const N: usize> CrankColumns<N> {
    pub const ZERO: Self =
        Self { sin: [0.0; N], cos: [0.0; N], to_above: [0.0; N], to_below: [0.0; N] };

    /// Keeps positions, as [`Cranks::new`] has them.
    #[inline(always)]
    pub fn set(&mut self, cos: &[f64; N], sin: &[f64; N], phase: Complex64) {
        for i in 0..N {
            let crank = CrankPosition::turned(cos[i], sin[i], phase);
            (self.sin[i], self.cos[i]) = (crank.sin, crank.cos);
            (self.to_above[i], self.to_below[i]) = (crank.to_above, crank.to_below);
        }
    }

    #[inline(always)]
    pub fn cranks(&self) -> Cranks<'_> {
        let Self { sin, cos, to_above, to_below } = self;
        Cranks(Positions::Kept(KeptCranks { sin, cos, to_above, to_below }))
    }
}

/// Motion of a piston at some positions of its crank, as in [`Motion`]: columns that are wanted, as long as there
/// are positions.
#[derive(Debug)]
pub struct MotionColumns<'a> {
    /// (d²x/dθ²)/r.
    pub acceleration: &'a mut [f64],
    /// (dx/dθ)/r.
    pub velocity: Option<&'a mut [f64]>,
    /// (d³x/dθ³)/r.
    pub jerk: Option<&'a mut [f64]>,
    /// Slope and secant of the rod's angle to the bore.
    pub lean: Option<[&'a mut [f64]; 2]>,
    /// Velocity and acceleration where the crank is half a turn on.
    pub opposite: Option<[&'a mut [f64]; 2]>,
}

impl<'a> MotionColumns<'a> {
    /// Of the acceleration alone.
    pub(crate) fn of(acceleration: &'a mut [f64]) -> Self {
        Self { acceleration, velocity: None, jerk: None, lean: None, opposite: None }
    }

    /// Of velocity and acceleration.
    pub(crate) fn of_both([velocity, acceleration]: [&'a mut [f64]; 2]) -> Self {
        Self { velocity: Some(velocity), ..Self::of(acceleration) }
    }

    /// Fills them in one loop, since each takes a root and a quotient.
    #[inline(always)]
    pub(crate) fn fill(self, cranks: &Cranks, motion: impl Fn(&CrankPosition) -> Motion) {
        match (self, cranks.0) {
            (Self { acceleration, velocity: None, jerk: None, lean: None, opposite: None }, _) => {
                fill(cranks, [acceleration], |crank| [motion(crank).acceleration]);
            }
            (
                Self {
                    acceleration,
                    velocity: Some(velocity),
                    jerk: None,
                    lean: None,
                    opposite: None,
                },
                _,
            ) => {
                fill(cranks, [velocity, acceleration], |crank| {
                    let Motion { velocity, acceleration, .. } = motion(crank);
                    [velocity, acceleration]
                });
            }
            (
                Self {
                    acceleration,
                    velocity: Some(velocity),
                    jerk: Some(jerk),
                    lean: None,
                    opposite: None,
                },
                Positions::Turned(units, phase),
            ) => {
                fill_turned((units, phase), [velocity, acceleration, jerk], |crank| {
                    let Motion { velocity, acceleration, jerk, .. } = motion(crank);
                    [velocity, acceleration, jerk]
                });
            }
            (
                Self {
                    acceleration,
                    velocity: None,
                    jerk: None,
                    lean: Some([slope, secant]),
                    opposite: None,
                },
                Positions::Turned(units, phase),
            ) => {
                fill_turned((units, phase), [acceleration, slope, secant], |crank| {
                    let Motion { acceleration, slope, secant, .. } = motion(crank);
                    [acceleration, slope, secant]
                });
            }
            (columns, _) => columns.fill_one_by_one(cranks, &motion),
        }
    }

    /// Fills them one by one.
    pub(crate) fn fill_one_by_one(
        mut self,
        cranks: &Cranks,
        motion: &dyn Fn(&CrankPosition) -> Motion,
    ) {
        let at_opposite = |i: usize| motion(&cranks.at(i).opposite());
        for i in 0..cranks.len() {
            let motion = motion(&cranks.at(i));
            self.acceleration[i] = motion.acceleration;
            if let Some(velocity) = &mut self.velocity {
                velocity[i] = motion.velocity;
            }
            if let Some(jerk) = &mut self.jerk {
                jerk[i] = motion.jerk;
            }
            if let Some([slope, secant]) = &mut self.lean {
                (slope[i], secant[i]) = (motion.slope, motion.secant);
            }
            if let Some([velocity, acceleration]) = &mut self.opposite {
                let motion = at_opposite(i);
                (velocity[i], acceleration[i]) = (motion.velocity, motion.acceleration);
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
    // Of one length, so that loops are free of checks.
    let count = cranks.len();
    match cranks.0 {
        Positions::Turned(units, phase) => fill_turned((units, phase), columns, values),
        Positions::Kept(KeptCranks { sin, cos, to_above, to_below }) => {
            let [sin, cos, to_above, to_below] =
                [sin, cos, to_above, to_below].map(|column| &column[..count]);
            let kept = KeptCranks { sin, cos, to_above, to_below };
            fill_by(count, columns, |i| kept.at(i), values);
        }
    }
}

#[inline(always)]
fn fill_turned<const N: usize>(
    (units, phase): ([&[f64]; 2], Complex64),
    columns: [&mut [f64]; N],
    values: impl Fn(&CrankPosition) -> [f64; N],
) {
    let count = units[0].len();
    let [cos, sin] = units.map(|column| &column[..count]);
    fill_by(count, columns, |i| CrankPosition::turned(cos[i], sin[i], phase), values);
}

#[inline(always)]
fn fill_by<const N: usize>(
    count: usize,
    mut columns: [&mut [f64]; N],
    at: impl Fn(usize) -> CrankPosition,
    values: impl Fn(&CrankPosition) -> [f64; N],
) {
    let mut columns = columns.each_mut().map(|column| &mut column[..count]);
    for i in 0..count {
        let values = values(&at(i));
        for (column, value) in columns.iter_mut().zip(values) {
            column[i] = value;
        }
    }
}
