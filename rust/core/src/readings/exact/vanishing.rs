//! Which orders of force, moment and torque vanish, with proof.
//!
//! Each order and direction is a sum over the loads, Σ w ζᵏ, where w is a weight (times a lever) and
//! ζᵏ the load's direction turned by n times its phase. Where angles are rational parts of a turn and
//! the weights rational multiples of each other, [`crate::numbers::ring`] decides in integers whether it is
//! zero.
//!
//! A quantity with no rational relation to the others is treated as an independent symbol: an angle
//! that is no simple part of a turn (others a simple part of a turn away from it share its symbol), a mass or a place that is no simple part of another, the harmonic of a slider-crank of
//! other proportions. The sum is then one over these symbols, each times a sum of roots of unity. It
//! vanishes if each of those does, whatever the symbols are. It remains if just one of them does not
//! and its symbol is known not to be zero, or if its value is beyond any error of its evaluation. Otherwise nothing is
//! proved.
//!
//! One relation of angles that are no parts of a turn is known: the bank angle of Ito and Hattori, at
//! which two sums of order 1 that are left have one size, decided in integers, and cancel. Doubles of
//! it stand for it, as those of 360/7° do for that.
//!
//! Gas is a load of its own, whose harmonics are not known here: its torque vanishes where the phase
//! vectors of the firing do ([`super::star`]). Of an engine with cycles it remains where its value is
//! beyond any error of its evaluation.
//!
//! Which harmonics are known not to be zero:
//! - a₁ = 1 + ib of any slider-crank;
//! - without pin offset the even orders of the force: √(1 − λ² sin²θ) is a power series in λ² sin²θ
//!   whose coefficients all are negative, and so every even power gives cos nθ the sign (−1)^{n/2};
//! - without pin offset every order of the torque of the masses, half the derivative of x′²: order n
//!   has, of x′² = sin²θ − 2 sin θ h′ + h′², for odd n the difference of two neighbouring orders of
//!   h′, of opposite signs, for even n > 2 a term of a geometric series, and for n = 2 such a term
//!   and −½, both negative;
//! - others where their value is beyond any error of its evaluation: 10⁻⁹ of the harmonics of masses
//!   and rod that it is the sum of, and 10⁻¹² of n² p₂^{n−2}, which bounds the terms that these are
//!   made of (p₂ as in [`crate::mechanism::harmonics`]).

mod terms;

use std::collections::BTreeMap;
use std::sync::Arc;

use self::terms::{Channel, Proof, Symbol, SymbolSums, SymbolTerm, View};
use super::roots::{PartOfTurn, SymbolEntry};
use super::star::Stars;
use super::{ExactMotion, MotionIndex, NumberedLoads, whole};
use crate::Complex64;
use crate::engine::Engine;
use crate::firing::Firing;
use crate::layout::Strokes;
use crate::load::{Load, LoadIndex, Scene};
use crate::mechanism::exact::TorqueKey;
use crate::numbers::UNIT_RPM;
use crate::numbers::angle::Angle;
use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};
use crate::numbers::index::{List, ListIndex};
use crate::numbers::order::{Order, check_list};
use crate::numbers::ring::RootSum;
use crate::readings::amplitude::SourceAmplitudes;
use crate::readings::balance::{self, Orders, Request, Vector};
use crate::readings::quantity::Part;
use crate::source::{ExactFactor, ForcePart, Source};
use crate::wrench::Wrench;

/// Sums of weights in doubles of angles within this part of Σ|weights| may be of one exact angle.
const ROUNDED_ANGLES: f64 = 16.0 * f64::EPSILON;

/// Part of the largest torque of gas beyond which that of an order is no error: it is evaluated to 1e-13.
const EVALUATED: f64 = 1e-9;

/// Multiples of the bounds of rounding of a sum of terms, and of the sum of their weights as if all harmonics were 1,
/// beyond which its value is no error: harmonics are evaluated to 1e-14 of themselves, those of link rods to 1e-14 of
/// the largest.
const TERMS_BEYOND: f64 = 1e5;
const WEIGHTS_BEYOND: f64 = 1e4;

/// What is known of a sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// It is zero, proved.
    Vanishes,
    /// It is not, proved.
    Remains,
    /// Neither is proved.
    Undecided,
}

/// The sums of one order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ProofQuantity {
    /// Force along x.
    ForceX,
    /// Force along y.
    ForceY,
    /// Force that turns with the crank.
    ForceForward,
    /// Force that turns against it.
    ForceBackward,
    /// Moment about x.
    MomentX,
    /// Moment about y.
    MomentY,
    /// Moment that turns with the crank.
    MomentForward,
    /// Moment that turns against it.
    MomentBackward,
    /// Roll torque of inertia; that on the crank vanishes with it.
    Torque,
    /// Torque of gas: cylinders that are alike have one cycle.
    GasTorque,
}

/// All of them, in the order in which they are reported.
pub const QUANTITIES: [ProofQuantity; 10] = [
    ProofQuantity::ForceX,
    ProofQuantity::ForceY,
    ProofQuantity::ForceForward,
    ProofQuantity::ForceBackward,
    ProofQuantity::MomentX,
    ProofQuantity::MomentY,
    ProofQuantity::MomentForward,
    ProofQuantity::MomentBackward,
    ProofQuantity::Torque,
    ProofQuantity::GasTorque,
];

impl ListIndex for ProofQuantity {
    fn new(position: usize) -> Self {
        QUANTITIES[position]
    }

    fn position(self) -> usize {
        self as usize
    }
}

/// A value for each quantity.
pub type ByQuantity<T> = List<ProofQuantity, T>;

impl ProofQuantity {
    /// Parts of a force or moment along (about) x and y.
    pub(crate) fn components(vector: Vector) -> [Self; 2] {
        match vector {
            Vector::Force => [Self::ForceX, Self::ForceY],
            Vector::Moment => [Self::MomentX, Self::MomentY],
        }
    }

    /// Parts of a force or moment that turn with the crank and against it.
    pub(crate) fn senses(vector: Vector) -> [Self; 2] {
        match vector {
            Vector::Force => [Self::ForceForward, Self::ForceBackward],
            Vector::Moment => [Self::MomentForward, Self::MomentBackward],
        }
    }

    /// Bounds of the rounding errors of the sums of a wrench.
    fn bounds(wrench: &Wrench) -> ByQuantity<f64> {
        let planar = [wrench.force, wrench.moment].map(|vector| [vector.bound; 4]);
        planar.into_iter().flatten().chain([wrench.torque.bounds[0], 0.0]).collect()
    }

    /// The sums of a wrench, of which the parts of a vector along (about) x and y are rounding up to bounds;
    /// nothing of gas.
    pub(super) fn of_wrench(
        wrench: &Wrench,
        bound: impl Fn(Vector) -> f64,
    ) -> ByQuantity<Complex64> {
        let planar = |vector: Vector| {
            let planar = vector.of(wrench);
            let [x, y] = planar.xy(bound(vector));
            [x, y, planar.forward, planar.backward_conj]
        };
        let [force, moment] = [Vector::Force, Vector::Moment].map(planar);
        force.into_iter().chain(moment).chain([wrench.torque.roll, Complex64::ZERO]).collect()
    }
}

/// What vanishes, order by order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Vanishing {
    /// As asked for.
    pub orders: Vec<Order>,
    /// Of the sums of each order.
    pub verdicts: Vec<ByQuantity<Verdict>>,
    /// Whether each is within the bound of rounding errors in floating point.
    pub within_rounding: Vec<ByQuantity<bool>>,
    /// Why sums are undecided, where some are.
    pub obstacles: Vec<String>,
}

impl Vanishing {
    /// The verdict on a sum of an order, if it is among [`Self::orders`].
    #[must_use]
    pub fn verdict(&self, order: Order, quantity: ProofQuantity) -> Option<Verdict> {
        let place = self.orders.iter().position(|own| *own == order)?;
        Some(self.verdicts[place][quantity])
    }

    /// Why sums are undecided, if some are.
    fn add_obstacles(&mut self, proof: &Proof, gas: &GasProof, numbered: &NumberedLoads) {
        let is_open = |verdict: &Verdict| *verdict == Verdict::Undecided;
        if self.verdicts.iter().flatten().any(is_open) {
            self.obstacles = proof.obstacles();
        }
        if self.verdicts.iter().any(|verdicts| is_open(&verdicts[ProofQuantity::GasTorque])) {
            self.obstacles.extend(gas.obstacle().map(String::from));
        }
        if numbered.0.iter().flatten().any(|acts| *acts) {
            let given = "loads that were given by numbers: they cancel with nothing for certain";
            self.obstacles.push(given.to_owned());
        }
    }
}

impl Proof {
    fn verdict(
        &self,
        sums: &SymbolSums,
        quantity: ProofQuantity,
        order: Order,
        cancel: &Cancel,
    ) -> Result<Verdict> {
        let torque = quantity == ProofQuantity::Torque;
        let views = [(false, torque), (true, torque), (false, false), (true, false)];
        let views = views.into_iter().take(if torque { 4 } else { 2 });
        let mut undecided = Ok(Verdict::Undecided);
        for view in views.map(|(parts, gears)| View { parts, gears }) {
            let decided = self
                .terms(sums, quantity, order, view)
                .and_then(|terms| self.decided(&terms, order, torque, view, cancel));
            match decided {
                Ok(Verdict::Undecided) => {}
                Err(error) => undecided = Err(error),
                decided => return decided,
            }
        }
        undecided
    }

    /// The verdict on Σ symbol · weight · root.
    fn decided(
        &self,
        terms: &[SymbolTerm],
        order: Order,
        torque: bool,
        view: View,
        cancel: &Cancel,
    ) -> Result<Verdict> {
        let mut sums: BTreeMap<Symbol, Vec<&SymbolTerm>> = BTreeMap::new();
        for term in terms {
            sums.entry(term.symbol).or_default().push(term);
        }
        let mut left = Vec::new();
        for (symbol, terms) in sums {
            let roots = roots(&terms)?;
            if !RootSum::new(&roots, 1)?.vanishes()? {
                left.push((symbol, terms));
            }
        }
        Ok(match &left[..] {
            [] => Verdict::Vanishes,
            [(symbol, _)] if self.is_nonzero(symbol.channel, order, view, cancel)? => {
                Verdict::Remains
            }
            [_, _] if order == Order::FIRST && !torque && self.balanced_angle(&left, order)? => {
                Verdict::Vanishes
            }
            _ => Verdict::Undecided,
        })
    }

    /// Whether what is left are two sums of one size, s·A + t·B, that cancel at the directions given.
    ///
    /// |A| = |B| is decided in integers. The angle between s and t at which they then cancel is in
    /// general no part of a turn; angles that are doubles and rounded from it stand for it, as those
    /// of 360/7 do.
    fn balanced_angle(&self, left: &[(Symbol, Vec<&SymbolTerm>)], order: Order) -> Result<bool> {
        let [(s, a), (t, b)] = left else { return Ok(false) };
        if (s.channel, s.weight, s.lever) != (t.channel, t.weight, t.lever) {
            return Ok(false);
        }
        let all = roots(&[&a[..], &b[..]].concat())?;
        let (a, b) = all.split_at(a.len());
        let values = [(s, a), (t, b)].map(|(symbol, roots)| {
            let sum: Complex64 = roots
                .iter()
                .map(|&(k, n, weight)| {
                    Complex64::cis(std::f64::consts::TAU * (k as f64 / n as f64)) * weight as f64
                })
                .sum();
            Some(sum * self.unit_of(symbol, order)?)
        });
        let [Some(x), Some(y)] = values else { return Ok(false) };
        // Doubles of a few units in the last place of a turn, and the sums of as many terms.
        let size: f64 = all.iter().map(|&(_, _, weight)| weight.abs() as f64).sum();
        if (x + y).norm() > ROUNDED_ANGLES * size {
            return Ok(false);
        }
        let period = RootSum::new(&all, 1)?.period();
        let [a, b] = [a, b].map(|roots| RootSum::new(roots, period)?.squared_size());
        a?.plus(&b?, -1)?.vanishes()
    }

    /// The number that symbols stand for, of directions and phases that are doubles.
    fn unit_of(&self, symbol: &Symbol, order: Order) -> Option<Complex64> {
        let first =
            |list: &List<LoadIndex, PartOfTurn>, index: usize, angle: fn(&Load) -> Angle| {
                let place = list.indices().find(|&load| list[load].symbol == index && index > 0);
                let angle = place.map_or(Angle::ZERO, |load| angle(&self.loads.list[load]));
                (index == 0 || angle.turns().is_none()).then_some(angle)
            };
        let (index, entry) = symbol.direction;
        let direction = first(&self.roots.directions, index, |load| load.place.direction)?;
        let phase = first(&self.roots.phases, symbol.phase, |load| load.place.phase)?;
        let sign = match entry {
            SymbolEntry::UnityRoot => 1,
            SymbolEntry::Conjugate => -1,
            SymbolEntry::Component => return None,
        };
        Some(direction.cis(sign) * phase.cis(-i64::from(order.halves() / 2)))
    }

    /// Whether a harmonic is known not to be zero; see the head of this file.
    fn is_nonzero(
        &self,
        channel: Channel,
        order: Order,
        view: View,
        cancel: &Cancel,
    ) -> Result<bool> {
        use Channel::{Coupling, Force, Gear, One, Torque};
        let of_motion = |motion: MotionIndex| {
            let motion = &self.motions[motion];
            (Arc::clone(&motion.mechanism), motion.own_order(order))
        };
        let ((mechanism, own), weights, is_odd) = match channel {
            One => return Ok(true),
            // By the value of the whole sum, if at all.
            Coupling(_) => return Ok(false),
            Force(motion) => (of_motion(motion), None, false),
            Torque(motion, key, is_odd) => (of_motion(motion), Some(vec![(key, 1.0)]), is_odd),
            Gear(gear, is_odd) => {
                let (gear, speed) = self.gears[gear];
                let weights =
                    gear.cylinder.torque_weights().into_iter().filter(|(_, weight)| *weight != 0.0);
                ((gear.mechanism(), order.halves() / speed), Some(weights.collect()), is_odd)
            }
        };
        let known = match &weights {
            Some(_) => mechanism.exact_torque(own),
            None => mechanism.exact_force(own),
        };
        let is_certain = match weights.as_deref() {
            Some(weights) => matches!(weights, [(key, _)] if key.is_certain(known)),
            None => known.is_certain,
        };
        if is_certain || (known.crank && !view.parts) {
            return Ok(true);
        }
        let torque = |&(key, weight): &(TorqueKey, f64)| {
            Ok(key.torque(&*mechanism, &[own], cancel)?.roll[0] * weight)
        };
        let (terms, size): (Vec<Complex64>, f64) = match &weights {
            Some(weights) => {
                let size = weights.iter().map(|(_, weight)| weight.abs()).sum();
                (weights.iter().map(torque).collect::<Result<_>>()?, size)
            }
            None => (mechanism.force(&[own], cancel)?, 1.0),
        };
        let value: Complex64 = terms.iter().sum();
        let value = match view.parts {
            false => value.norm(),
            true if !is_odd && (weights.is_some() || own % 2 == 1) => value.im.abs(),
            true => value.re.abs(),
        };
        let n = f64::from(own);
        let made_of = n * n * mechanism.decay().powf(n - 2.0) * size;
        let largest: f64 = terms.iter().map(|term| term.norm()).sum();
        Ok(value > 1e-12 * made_of && value > 1e-9 * largest)
    }

    /// Why a sum may be undecided.
    fn obstacles(&self) -> Vec<String> {
        let mut found = Vec::new();
        let is_piston = |load: &&Load| load.parts.force == Some(ForcePart::Along);
        let listed = |angles: &List<LoadIndex, PartOfTurn>| {
            let number = |(load, angle): (&Load, &PartOfTurn)| {
                let cylinder = load.place.origin.cylinder();
                let i = cylinder.filter(|_| is_piston(&load) && angle.symbol > 0)?;
                Some((i + 1).to_string())
            };
            let numbers: Vec<String> =
                self.loads.list.iter().zip(angles).filter_map(number).take(12).collect();
            (!numbers.is_empty()).then(|| numbers.join(", "))
        };
        for (name, directions) in
            [("tdc_deg", &self.roots.phases), ("bank_deg", &self.roots.directions)]
        {
            if let Some(numbers) = listed(directions) {
                found.push(format!("{name} is no simple part of a turn in cylinders {numbers}"));
            }
        }
        let unrelated = self.unrelated().into_iter().filter(|(is_so, _)| *is_so);
        found.extend(unrelated.map(|(_, text)| text.to_owned()));
        let has_offset = |motion: &ExactMotion| motion.mechanism.exact_force(1).rest.exists();
        if found.is_empty() && self.motions.iter().any(has_offset) {
            found.push(
                "pin offsets: harmonics with no rational relation to what rotates".to_owned(),
            );
        }
        if found.is_empty() && self.gears.iter().any(|(gear, _)| gear.cylinder.has_rod_inertia()) {
            found.push("rod inertia: its torque nearly cancels that of the masses".to_owned());
        }
        found
    }

    /// What may have no rational relation, and whether it has none.
    fn unrelated(&self) -> [(bool, &'static str); 9] {
        let turning = || self.loads.list.iter().filter(|load| load.is_turning());
        let directions = self.loads.list.iter().zip(&self.roots.directions);
        let mut turned = directions.filter(|(load, _)| load.is_turning());
        let mut speeds = self.motions.iter().map(|motion| motion.speed);
        let has_speeds = speeds.next().is_some_and(|first| speeds.any(|speed| speed != first));
        let mut inertias = self.gears.iter().map(|(gear, _)| gear.cylinder.rod_inertia_excess());
        let first = inertias.next();
        let is_piston = |load: &&Load| load.parts.force == Some(ForcePart::Along);
        let beside = |load: &Load| load.place.axis != Complex64::default();
        let units = || self.levers.of.iter().flatten().map(|&(unit, _)| unit);
        [
            (
                turned.any(|(_, direction)| direction.symbol > 0),
                "angles of unbalances that are no simple part of a turn",
            ),
            (has_speeds, "cranks of different speeds"),
            (!has_speeds && self.motions.len() > 1, "slider-cranks of different proportions"),
            (
                inertias.any(|inertia| Some(inertia) != first),
                "rods of different moments of inertia",
            ),
            (
                self.planar_units > 1,
                "masses times radius that are no rational multiples of each other",
            ),
            (
                turning().any(|load| !load.place.ratio.is_crank_speed()),
                "unbalances of other orders than 1, no rational multiples of pistons'",
            ),
            (turning().any(beside), "roll torques of shafts, no rational multiples of pistons'"),
            (
                self.loads.list.iter().filter(is_piston).any(beside),
                "roll torques of forces on cranks beside the main one",
            ),
            (
                units().any(|unit| Some(unit) != units().next()),
                "places that are no rational multiples of each other",
            ),
        ]
    }
}

/// Numerators and denominators of parts of a turn, with weights as whole numbers.
fn roots(terms: &[&SymbolTerm]) -> Result<Vec<(i128, i128, i128)>> {
    let (weights, _) = whole(&terms.iter().map(|term| term.weight).collect::<Vec<_>>())?;
    let root = |(t, weight): (&&SymbolTerm, i128)| (*t.turns.numer(), *t.turns.denom(), weight);
    Ok(terms.iter().zip(weights).map(root).collect())
}

/// What vanishes of an engine, at any speed, about the plane z = `reference_z` (default: half-way
/// between the first and the last cylinder).
///
/// Half orders are those of gas, and need `firing` unless the engine has cycles; at whole ones gas
/// does not distinguish the turns.
///
/// ```
/// # let four = crankpin_core::engine::file::from_toml(
/// #     "schema = 1
/// #     cylinder = { crank_radius = 0.043, rod_length = 0.145, reciprocating_mass = 0.66 }
/// #     placements = [
/// #         { tdc_deg = 0, bank_deg = 90, z = 0 }, { tdc_deg = 180, bank_deg = 90, z = 0.1 },
/// #         { tdc_deg = 180, bank_deg = 90, z = 0.2 }, { tdc_deg = 0, bank_deg = 90, z = 0.3 },
/// #     ]",
/// # )?;
/// use crankpin_core::exact::vanishing::{ProofQuantity, Verdict, vanishing};
/// use crankpin_core::{Cancel, Order};
///
/// let found = vanishing(&four, &Order::all_whole(&[1, 2])?, None, None, &Cancel::new())?;
/// let vertical = |n| Ok::<_, crankpin_core::Error>(found.verdict(Order::whole(n)?, ProofQuantity::ForceY));
/// assert_eq!(vertical(1)?, Some(Verdict::Vanishes));
/// assert_eq!(vertical(2)?, Some(Verdict::Remains));
/// assert_eq!(vertical(3)?, None);
/// # Ok::<(), crankpin_core::Error>(())
/// ```
pub fn vanishing(
    engine: &Engine,
    orders: &[Order],
    reference_z: Option<f64>,
    firing: Option<&Firing>,
    cancel: &Cancel,
) -> Result<Vanishing> {
    vanishing_of(&QUANTITIES, engine, orders, reference_z, firing, cancel)
}

/// [`vanishing`], of some quantities alone; others are undecided.
pub(crate) fn vanishing_of(
    quantities: &[ProofQuantity],
    engine: &Engine,
    orders: &[Order],
    reference_z: Option<f64>,
    firing: Option<&Firing>,
    cancel: &Cancel,
) -> Result<Vanishing> {
    check_list(orders)?;
    let is_torque = |own| matches!(own, &ProofQuantity::Torque | &ProofQuantity::GasTorque);
    let torque = quantities.iter().any(is_torque);
    let known = || evaluated(engine, orders, reference_z, torque, cancel);
    decided(quantities, engine, known, (orders, reference_z, firing), cancel)
}

/// Verdicts on sums by symbols, and by what floating point finds of them.
fn decided(
    quantities: &[ProofQuantity],
    engine: &Engine,
    known: impl FnOnce() -> Result<Vec<Evaluated>>,
    (orders, reference_z, firing): (&[Order], Option<f64>, Option<&Firing>),
    cancel: &Cancel,
) -> Result<Vanishing> {
    let proof = Proof::of(engine, reference_z, cancel)?;
    let has_halves = proof.has_half_orders() || firing.is_some() || engine.cycles_in_use() > 0;
    let half = orders.iter().find(|order| order.as_whole().is_none());
    if let Some(half) = half.filter(|_| !has_halves && engine.loads().is_empty()) {
        return Err(Error::value("orders", half, "half orders need a firing order"));
    }
    let gas = GasProof::new(engine, firing, cancel)?;
    let numbered = NumberedLoads::new(engine, reference_z, orders, cancel)?;
    let mut found = Vanishing { orders: orders.to_vec(), ..Vanishing::default() };
    let mut errors: Vec<String> = Vec::new();
    let known = known()?.into_iter().zip(&numbered.0);
    for (&order, (mut value, numbered)) in orders.iter().zip(known) {
        let mut beyond_errors = None;
        // Neither gas nor half orders, which inertia has of shafts at half speed alone, need them.
        let of_inertia = quantities.iter().any(|&own| own != ProofQuantity::GasTorque);
        let has_order = order.as_whole().is_some() || proof.has_half_orders();
        let sums = if of_inertia && has_order { proof.sums(order) } else { SymbolSums::new() };
        let mut verdicts: ByQuantity<_> = QUANTITIES.iter().map(|_| Verdict::Undecided).collect();
        for &quantity in quantities {
            cancel.check()?;
            let proved = match quantity {
                ProofQuantity::GasTorque => gas.at(order, value.gas_remains),
                // What was given is no rational, and cancels with nothing for certain.
                _ if numbered[quantity] => Ok((Verdict::Undecided, Some(false))),
                _ => proof.verdict(&sums, quantity, order, cancel).map(|verdict| (verdict, None)),
            };
            if matches!(proved, Err(_) | Ok((Verdict::Undecided, None))) {
                let beyond = match &beyond_errors {
                    Some(beyond) => beyond,
                    None => {
                        beyond_errors.insert(value.beyond_errors(&proof.loads, order, cancel)?)
                    }
                };
                if beyond[quantity] {
                    verdicts[quantity] = Verdict::Remains;
                    continue;
                }
            }
            match proved {
                Ok((verdict, is_rounding)) => {
                    verdicts[quantity] = verdict;
                    if let Some(is_rounding) = is_rounding {
                        value.within_rounding[quantity] = is_rounding;
                    }
                }
                Err(error) if errors.contains(&error.to_string()) => {}
                Err(error) => errors.push(error.to_string()),
            }
        }
        found.verdicts.push(verdicts);
        found.within_rounding.push(value.within_rounding);
    }
    found.add_obstacles(&proof, &gas, &numbered);
    found.obstacles.extend(errors);
    Ok(found)
}

/// What is known of the torque of gas of an engine that fires.
struct GasProof {
    stars: Stars,
    strokes: Strokes,
    /// Whether some fire on cranks of other speeds, whose cycles begin at turns that nothing says.
    has_other_cycles: bool,
}

impl GasProof {
    fn new(engine: &Engine, firing: Option<&Firing>, cancel: &Cancel) -> Result<Self> {
        let is_faster = |i| !engine.cranks()[engine.crank_of(i)].ratio.is_crank_speed();
        Ok(Self {
            stars: Stars::of_gas(engine, firing, cancel)?,
            strokes: firing.map_or(engine.strokes(), Firing::strokes),
            has_other_cycles: (0..engine.stations().len()).any(|i| engine.fires(i) && is_faster(i)),
        })
    }

    /// The verdict on an order, of which the value may be beyond any error; and whether it is zero within
    /// rounding, where another sum than that of cylinders that are alike says so.
    fn at(&self, order: Order, remains: bool) -> Result<(Verdict, Option<bool>)> {
        if order.as_whole().is_none() && self.strokes == Strokes::Two {
            return Ok((Verdict::Vanishes, None));
        }
        if self.has_other_cycles {
            return Ok((Verdict::Undecided, Some(false)));
        }
        let star = self.stars.at(order)?;
        Ok(match star.verdict {
            Verdict::Vanishes => (Verdict::Vanishes, Some(true)),
            // The sum of vectors is no torque where cylinders are unlike.
            Verdict::Undecided if !remains => {
                (Verdict::Undecided, Some(star.sum == Complex64::ZERO))
            }
            Verdict::Remains | Verdict::Undecided => (Verdict::Remains, Some(false)),
        })
    }

    /// Why it may be undecided.
    fn obstacle(&self) -> Option<&'static str> {
        let unlike = "cylinders of different dimensions, whose gas torques have no ratio";
        let other_cycles = "gas on cranks of other speeds, whose cycles begin at no known turn";
        let unlike = self.stars.are_unlike().then_some(unlike);
        if self.has_other_cycles { Some(other_cycles) } else { unlike }
    }
}

/// Proofs of an engine's sums, about the plane midway between its first and last cylinder, one by one as they
/// are wanted.
pub(crate) struct ZeroProofs<'a> {
    engine: &'a Engine,
    proof: Arc<Proof>,
    cancel: &'a Cancel,
}

impl<'a> ZeroProofs<'a> {
    /// Of an engine.
    pub fn new(engine: &'a Engine, cancel: &'a Cancel) -> Result<Self> {
        Ok(Self { engine, proof: Proof::of(engine, None, cancel)?, cancel })
    }

    /// Whether these sums of forces, moments and torques of inertia are proved to vanish at an order.
    pub fn vanish(&self, quantities: &[ProofQuantity], order: Order) -> Result<bool> {
        let numbered = NumberedLoads::new(self.engine, None, &[order], self.cancel)?;
        let sums = self.proof.sums(order);
        let vanishes = |&quantity: &ProofQuantity| {
            let verdict = self.proof.verdict(&sums, quantity, order, self.cancel);
            !numbered.0[0][quantity] && verdict == Ok(Verdict::Vanishes)
        };
        self.cancel.check()?;
        Ok(quantities.iter().all(vanishes))
    }
}

/// What floating point finds of an order, at no speed in particular.
struct Evaluated {
    /// Of inertia, over ω².
    wrench: Wrench,
    /// Which sums of it are zero within rounding.
    within_rounding: ByQuantity<bool>,
    /// Whether the torque of gas is beyond any error of its evaluation.
    gas_remains: bool,
}

impl Evaluated {
    /// Which sums of inertia are beyond any error of their evaluation.
    fn beyond_errors(
        &self,
        loads: &Scene,
        order: Order,
        cancel: &Cancel,
    ) -> Result<ByQuantity<bool>> {
        let ones = SourceAmplitudes::ones(&loads.sources, &[order]);
        let of_weights = ones.wrenches(loads, &loads.list, true, &[order], cancel)?;
        // Inertia is the first group.
        let [of_terms, of_weights] = [&self.wrench, &of_weights[0]].map(ProofQuantity::bounds);
        let sums = ProofQuantity::of_wrench(&self.wrench, |_| 0.0);
        let bound = of_terms.iter().zip(&of_weights);
        let bound = bound.map(|(terms, weights)| TERMS_BEYOND * terms + WEIGHTS_BEYOND * weights);
        Ok(sums.iter().zip(bound).map(|(sum, bound)| sum.norm() > bound).collect())
    }
}

fn evaluated(
    engine: &Engine,
    orders: &[Order],
    reference_z: Option<f64>,
    torque: bool,
    cancel: &Cancel,
) -> Result<Vec<Evaluated>> {
    let request = Request { rpm: UNIT_RPM, reference_z, torque };
    let orders = Orders::Given(orders.to_vec());
    let all = balance::balance(engine, &request, &orders, cancel)?;
    let found = all.of_part(Part::INERTIA);
    let loads = Scene::of(engine, reference_z)?;
    let weights = loads.torque_weights();
    let of_sources = weights.iter().zip(&loads.sources);
    let of_cycles = of_sources.filter(|(_, source)| source.exact() == ExactFactor::Cycle);
    let torque = |source: &dyn Source| source.scale().torque.unwrap_or(0.0);
    let largest: f64 = of_cycles.map(|(weight, source)| weight.size * torque(&**source)).sum();
    let of_order = |k: usize| {
        let wrench = found.wrenches[k];
        let sums = ProofQuantity::of_wrench(&wrench, |vector| vector.of(&wrench).bound);
        Evaluated {
            wrench,
            within_rounding: sums.map_to(|sum| *sum == Complex64::ZERO),
            gas_remains: all.torque(Part::GAS, k).roll.norm() > EVALUATED * largest,
        }
    };
    Ok((0..found.orders.len()).map(of_order).collect())
}

#[cfg(test)]
mod tests;
