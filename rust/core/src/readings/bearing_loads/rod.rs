//! One cylinder's piston and rod: the forces between them, on the wall and on the crankpin.
//!
//! Each part of a cylinder is a free body. With u along the bore away from the crank, w the side to
//! which the crankpin swings after top dead centre, a the piston's acceleration along u, G the gas
//! force on the piston along −u, m the reciprocating mass, of which mₚ is the piston's, φ the rod's
//! angle to the bore, and J the rod's moment of inertia beyond that of its two masses:
//!
//! - the force that drives the massless rod at the wrist pin is −(G + m·a) along u, and
//!   N = (G + m·a)·tan φ − J·φ̈/(l·cos φ) along w: J is swung by a pair of forces across the bore;
//! - the wall exerts N on the piston along w, the piston −N on the wall;
//! - the rod exerts that force on the crankpin, and the centrifugal force of its rotating mass;
//! - the wrist pin carries G + mₚ·a along u and −N along w.
//!
//! w is a quarter turn ahead of u in the sense in which the cylinder's own crank turns.
//!
//! A link rod exerts its force P, and its big end's mass there the force of its inertia, on the knuckle of the master
//! rod, at k·l from the crankpin with k the complex share of [`Knuckle`]. They reach the crankpin, and their moment
//! about it changes the master's N by −Im(k̄·(1 + i·tan φ)·P): the moments on a massless rod add up to nothing.
//!
//! [`Knuckle`]: crate::mechanism::articulated::Knuckle

use std::sync::Arc;

use crate::Complex64;
use crate::engine::{CrankIndex, Engine, FacePressure, LinkRod};
use crate::load::Place;
use crate::mechanism::Mechanism;
use crate::mechanism::motion::{CrankPosition, Motion, MotionColumns};
use crate::numbers::angle::{Angle, cis_degrees};
use crate::numbers::error::Result;
use crate::numbers::ratio::SpeedRatio;
use crate::numbers::simd::vectorised;
use crate::source::over_angle::{AngleColumn, BLOCK, Units};

/// Axes that turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TurningAxes {
    /// From the crank's axis to the crankpin, and a quarter turn ahead: those of pins and journals.
    Crank,
    /// Along the rod to the wrist pin, and a quarter turn ahead: those of the rod's bearings.
    Rod,
}

/// A cylinder's piston and rod at a speed.
pub(super) struct DrivenRod {
    mechanism: Arc<dyn Mechanism>,
    pub crank: CrankIndex,
    pub ratio: SpeedRatio,
    /// `e^{−iφ}` of the angle φ of its own crank at top dead centre.
    pub phase: Complex64,
    /// Unit vectors along the bore, u, and across it, w.
    axes: [Complex64; 2],
    pub z: f64,
    /// m·r·ω² of the reciprocating mass, N.
    reciprocating: f64,
    /// The same of the piston alone; of the whole where it is not known.
    piston: f64,
    /// The same of the rod's rotating mass; zero where it is not known.
    pub rotating: f64,
    /// J·ω²/l, N.
    couple: f64,
    /// Pressures on the faces of the piston.
    gas: Vec<FaceForce>,
    /// Of a link rod.
    hangs: Option<Hanging>,
    /// Link rods that hang on this one, and the conjugate of their share k.
    links: Vec<(Self, Complex64)>,
}

/// What of a link rod depends on its master.
struct Hanging {
    master: Arc<dyn Mechanism>,
    /// `e^{iD}` of the own bore ahead of the master's, in the sense of the crank.
    ahead: Complex64,
    /// Share k of the wrist pin's motion in that of the knuckle.
    share: Complex64,
    /// m·r·ω² of the mass at the knuckle, N.
    mass: f64,
}

impl Hanging {
    /// Force of the inertia of the mass at the knuckle along the own bore and across it, of the piston of the
    /// master that accelerates so.
    #[inline(always)]
    fn inertia(&self, crank: &CrankPosition, acceleration: f64) -> Complex64 {
        let pin = Complex64::new(crank.cos, crank.sin) * (1.0 - self.share);
        (pin - self.ahead.conj() * self.share * acceleration) * self.mass
    }
}

/// What link rods exert on a master rod: force, along u and w, and the change of N.
#[derive(Clone, Copy, Default)]
struct OfLinks {
    force: Complex64,
    across: f64,
}

/// Pressure on a face of a piston.
struct FaceForce {
    pressure: FacePressure,
    /// Crank angle at which its cycle begins, degrees.
    phase: f64,
}

/// Forces of one cylinder; vectors along u and w.
pub(super) struct RodForces {
    pub crankpin: [f64; 2],
    pub wrist_pin: [f64; 2],
    pub across: f64,
    pub compression: f64,
    pub gas: f64,
}

/// The same over a block of crank angles; vectors along x and y. Whole lines of the cache.
#[repr(align(64))]
pub(super) struct RodColumns {
    pub crankpin: [AngleColumn; 2],
    pub wrist_pin: [AngleColumn; 2],
    pub across: AngleColumn,
    pub compression: AngleColumn,
    pub gas: AngleColumn,
}

impl FaceForce {
    fn of(pressure: FacePressure) -> Self {
        Self { phase: pressure.phase.degrees(), pressure }
    }

    /// Force on the piston towards the crank, N, by the polynomial that counts at another angle.
    fn force(&self, theta_deg: f64, at: f64) -> f64 {
        let Self { pressure: FacePressure { cycle, area, crankcase, .. }, phase } = self;
        area * (cycle.pressure_beside(theta_deg - phase, at - phase) - crankcase)
    }
}

impl DrivenRod {
    /// m·r·ω² of all masses, N: less than the force on the crankpin at a top dead centre.
    pub fn size(&self) -> f64 {
        let at_knuckle = self.hangs.as_ref().map_or(0.0, |hangs| hangs.mass);
        let links = self.links.iter().map(|(link, _)| link.size());
        self.reciprocating + self.rotating + at_knuckle + links.sum::<f64>()
    }

    /// Whether it is on its crankpin itself, and not a link rod.
    pub fn is_on_crankpin(&self) -> bool {
        self.hangs.is_none()
    }

    /// Of a cylinder of an engine, at a square of angular speed of the main crank.
    pub fn new(engine: &Engine, cylinder: usize, square: f64) -> Result<Self> {
        let square_of_main = square;
        let (i, details) = (cylinder, &engine.details()[cylinder]);
        let (cylinder, place) = (&engine.stations()[i].cylinder, Place::along_bore(engine, i));
        let (radius, length) = (cylinder.crank_radius(), cylinder.rod_length());
        let is_link = engine.link_rods()[i].is_some();
        let rotating = if is_link { 0.0 } else { details.big_end(length)? * radius };
        let piston = details.piston_mass.map_or(cylinder.mass_radius(), |mass| mass * radius);
        let square = square * place.speed_squared();
        let ahead = Complex64::new(0.0, f64::from(place.ratio.sense()));
        let ratio = place.ratio;
        let share = |link: usize| {
            engine.link_rods()[link].map(|LinkRod { master, radius, angle, .. }| {
                let length = engine.stations()[master].cylinder.rod_length();
                seen(angle, ratio) * (radius / length)
            })
        };
        let hangs = engine.link_rods()[i].zip(share(i)).map(|(link, share)| Hanging {
            master: engine.mechanism(link.master),
            ahead: seen(engine.stations()[i].bank - engine.stations()[link.master].bank, ratio),
            share,
            mass: link.big_end_mass * radius * square,
        });
        let link = |k: usize| Some((Self::new(engine, k, square_of_main), share(k)?.conj()));
        let links = engine.links_of(i).filter_map(link);
        let links = links.map(|(rod, share)| Ok((rod?, share))).collect::<Result<_>>()?;
        Ok(Self {
            mechanism: engine.mechanism(i),
            crank: engine.crank_of(i),
            ratio: place.ratio,
            phase: place.ratio.cis(place.phase, -place.ratio.sense()),
            axes: [place.unit, place.unit * ahead],
            z: place.z,
            reciprocating: cylinder.mass_radius() * square,
            piston: piston * square,
            rotating: rotating * square,
            couple: cylinder.rod_inertia_excess() * square / length,
            gas: engine.pressures(i).into_iter().map(FaceForce::of).collect(),
            hangs,
            links,
        })
    }

    /// Forces at a crank angle, degrees, where pressure has the polynomial that counts at another angle.
    pub fn forces_beside(&self, theta_deg: f64, at: f64) -> RodForces {
        let unit = cis_degrees(theta_deg * self.ratio.size()) * self.phase;
        let gas = self.gas.iter().fold(0.0, |sum, gas| sum + gas.force(theta_deg, at));
        let crank = CrankPosition::new(unit.im, unit.re);
        let Motion { acceleration, slope, secant, .. } = self.mechanism.motion(&crank);
        let swing = self.mechanism.swing(&crank).acceleration;
        let mut links = OfLinks::default();
        for (link, share) in &self.links {
            let force = link.on_crankpin(&link.forces_beside(theta_deg, at));
            links.add(self.along_axes(force), *share, slope);
        }
        let at_knuckle = self.hangs.as_ref().map_or(Complex64::ZERO, |hangs| {
            let of_master = unit * hangs.ahead;
            let of_master = CrankPosition::new(of_master.im, of_master.re);
            hangs.inertia(&crank, hangs.master.motion(&of_master).acceleration)
        });
        self.forces(&crank, &[acceleration, slope, secant, swing], gas, Some((links, at_knuckle)))
    }

    /// A vector x + iy along u and w.
    #[inline(always)]
    fn along_axes(&self, vector: Complex64) -> Complex64 {
        let [u, w] = self.axes.map(|axis| (axis.conj() * vector).re);
        Complex64::new(u, w)
    }

    /// A vector along u and w, x + iy.
    #[inline(always)]
    pub fn vector(&self, [u, w]: [f64; 2]) -> Complex64 {
        self.axes[0] * u + self.axes[1] * w
    }

    /// Force on the crankpin, x + iy.
    pub fn on_crankpin(&self, forces: &RodForces) -> Complex64 {
        self.vector(forces.crankpin)
    }

    /// What turns with the crankpin, of a magnitude, along it at θ = 0, x + iy.
    pub fn at_start(&self, magnitude: f64) -> Complex64 {
        self.vector([self.phase.re * magnitude, self.phase.im * magnitude])
    }

    /// Crank angles at which its pressure may jump or bend, and those at which the rod leans most, where
    /// loads of one hardly longer than the crank have narrow peaks, degrees.
    pub fn edges_deg(&self) -> Vec<f64> {
        let (tdc, speed) = (-self.phase.arg().to_degrees(), self.ratio.size());
        let quarter = move |k: u32| (tdc + 90.0 + 180.0 * f64::from(k)) / speed;
        // In two turns of the main crank.
        let leaning = (0..2 * self.ratio.halves_of_speed()).map(quarter);
        let gas = self.gas.iter();
        let links = self.links.iter().flat_map(|(link, _)| link.edges_deg());
        gas.flat_map(|gas| gas.pressure.cycle.edges_deg().iter().map(|edge| edge + gas.phase))
            .chain(leaning)
            .chain(links)
            .collect()
    }

    /// Size of what forces are sums and differences of, by the largest force on the crankpin, N.
    pub fn terms(&self, on_crankpin: f64) -> f64 {
        let size = |FaceForce { pressure, .. }: &FaceForce| {
            pressure.area.abs() * (pressure.crankcase + pressure.cycle.largest())
        };
        let links = self.links.iter().map(|(link, _)| link.terms(0.0)).sum::<f64>();
        self.size() + on_crankpin + self.gas.iter().map(size).sum::<f64>() + links
    }

    /// At an acceleration of the piston, slope and secant of its rod, and an acceleration of the rod's angle.
    #[inline(always)]
    fn forces(
        &self,
        crank: &CrankPosition,
        &[acceleration, slope, secant, swing]: &[f64; 4],
        gas: f64,
        linked: Option<(OfLinks, Complex64)>,
    ) -> RodForces {
        let towards_crank = gas + self.reciprocating * acceleration;
        let mut across = slope * towards_crank;
        if self.couple != 0.0 {
            across -= self.couple * secant * swing;
        }
        let mut besides = None;
        if let Some((links, at_knuckle)) = linked {
            across += links.across;
            besides = Some(links.force + at_knuckle);
        }
        let crankpin =
            [self.rotating * crank.cos - towards_crank, self.rotating * crank.sin + across];
        let on_wrist_pin = gas + self.piston * acceleration;
        RodForces {
            crankpin: besides
                .map_or(crankpin, |force| [crankpin[0] + force.re, crankpin[1] + force.im]),
            wrist_pin: [on_wrist_pin, -across],
            across,
            compression: (on_wrist_pin + slope * across) / secant,
            gas,
        }
    }

    /// A vector x + iy in axes of this crank or rod: along the first, and a quarter turn ahead in the
    /// sense of the crank.
    #[inline(always)]
    pub fn seen(&self, vector: Complex64, crank: &CrankPosition, axes: TurningAxes) -> [f64; 2] {
        let along = match axes {
            TurningAxes::Crank => Complex64::new(crank.cos, crank.sin),
            TurningAxes::Rod => {
                let Motion { slope, secant, .. } = self.mechanism.motion(crank);
                Complex64::new(1.0, -slope) / secant
            }
        };
        // Adding zero makes −0 0.
        let seen = self.along_axes(vector) * along.conj() + Complex64::default();
        [seen.re, seen.im]
    }
}

impl OfLinks {
    /// Adds a force on a knuckle, along u and w, of a rod whose lean has this tangent.
    #[inline(always)]
    fn add(&mut self, force: Complex64, share_conj: Complex64, slope: f64) {
        self.force += force;
        self.across -= (share_conj * Complex64::new(1.0, slope) * force).im;
    }
}

/// `e^{iφ}` of an angle, in the sense of a crank.
fn seen(angle: Angle, ratio: SpeedRatio) -> Complex64 {
    angle.cis(i64::from(ratio.sense()))
}

impl RodColumns {
    pub const ZERO: Self = Self {
        crankpin: [[0.0; BLOCK]; 2],
        wrist_pin: [[0.0; BLOCK]; 2],
        across: [0.0; BLOCK],
        compression: [0.0; BLOCK],
        gas: [0.0; BLOCK],
    };

    /// Gas forces at crank angles of a block, degrees.
    pub fn set_gas(&mut self, rod: &DrivenRod, theta_deg: &[f64]) {
        for (k, gas) in rod.gas.iter().enumerate() {
            for (value, &theta) in self.gas.iter_mut().zip(theta_deg) {
                let others = if k == 0 { 0.0 } else { *value };
                *value = others + gas.force(theta, theta);
            }
        }
    }

    /// Overwrite all but the gas, which is read; that of link rods is evaluated at these crank angles, degrees.
    pub fn fill(&mut self, rod: &DrivenRod, units: &Units, theta_deg: &[f64]) {
        let [mut velocity, mut acceleration, mut slope, mut secant, mut swing] = [[0.0; BLOCK]; 5];
        let cranks = units.cranks(rod.phase);
        if rod.couple != 0.0 {
            rod.mechanism.swings(&cranks, [&mut velocity, &mut swing]);
        }
        let mut motion = MotionColumns::of(&mut acceleration);
        motion.lean = Some([&mut slope, &mut secant]);
        rod.mechanism.motions(&cranks, motion);
        let motions = [&acceleration, &slope, &secant, &swing];
        if rod.hangs.is_none() && rod.links.is_empty() {
            vectorised(
                #[inline(always)]
                || self.add(rod, units, motions, |_, _, _| None),
            );
            return;
        }
        let mut links = Vec::new();
        for (link, share) in &rod.links {
            let mut columns = Box::new(Self::ZERO);
            columns.set_gas(link, theta_deg);
            columns.fill(link, units, theta_deg);
            links.push((columns, *share));
        }
        let mut of_master = [0.0; BLOCK];
        if let Some(hangs) = rod.hangs.as_ref().filter(|hangs| hangs.mass != 0.0) {
            let cranks = units.cranks(rod.phase * hangs.ahead);
            hangs.master.motions(&cranks, MotionColumns::of(&mut of_master));
        }
        let linked = |k: usize, crank: &CrankPosition, slope: f64| {
            let mut of_links = OfLinks::default();
            for (columns, share) in &links {
                let [x, y] = &columns.crankpin;
                of_links.add(rod.along_axes(Complex64::new(x[k], y[k])), *share, slope);
            }
            let at_knuckle = rod.hangs.as_ref().map(|hangs| hangs.inertia(crank, of_master[k]));
            Some((of_links, at_knuckle.unwrap_or_default()))
        };
        vectorised(
            #[inline(always)]
            || self.add(rod, units, motions, linked),
        );
    }

    /// With what link rods add at a place of the block, of a slope of the rod.
    #[inline(always)]
    fn add(
        &mut self,
        rod: &DrivenRod,
        units: &Units,
        motions: [&AngleColumn; 4],
        linked: impl Fn(usize, &CrankPosition, f64) -> Option<(OfLinks, Complex64)>,
    ) {
        for k in 0..BLOCK {
            let motion = motions.map(|column| column[k]);
            let crank = units.crank(rod.phase, k);
            let linked = linked(k, &crank, motion[1]);
            let forces = rod.forces(&crank, &motion, self.gas[k], linked);
            let pairs =
                [(&mut self.crankpin, forces.crankpin), (&mut self.wrist_pin, forces.wrist_pin)];
            for ([x, y], vector) in pairs {
                let vector = rod.vector(vector);
                // Adding zero makes −0 0.
                x[k] = vector.re + 0.0;
                y[k] = vector.im + 0.0;
            }
            self.across[k] = forces.across + 0.0;
            self.compression[k] = forces.compression + 0.0;
        }
    }
}
