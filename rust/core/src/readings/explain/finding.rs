//! A fact about an engine, before it is put into words.

use crate::numbers::order::Order;
use crate::numbers::ratio::SpeedRatio;
use crate::readings::balance::Vector;

/// A fact about an engine. Parts of a vector are forward and backward; cylinders are indices; forces
/// are in N, moments in N·m, without a speed over ω².
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// What counterweights and shafts do to an order.
    Hardware {
        /// Force or moment.
        vector: Vector,
        /// Order.
        order: Order,
        /// Parts without them.
        before: [f64; 2],
        /// Parts with them.
        after: [f64; 2],
        /// Which of them act.
        acting: Acting,
        /// Whether the parts that they remove are proved to vanish.
        proved: bool,
    },
    /// An order that remains.
    Shakes {
        /// Force or moment.
        vector: Vector,
        /// Order.
        order: Order,
        /// Parts.
        parts: [f64; 2],
        /// Direction of the longest half axis from +x, degrees.
        tilt_deg: f64,
        /// Whether all pistons pull at once, each along its own bore.
        together: bool,
    },
    /// What would remove an order.
    Remedy {
        /// Force or moment.
        vector: Vector,
        /// Order.
        order: Order,
        /// What counterweights, or else the shafts, leave.
        kept: f64,
        /// Ratios of balance shafts.
        shafts: Vec<SpeedRatio>,
        /// Counterweights, which take what turns with a crank.
        weights: Weights,
    },
    /// Half of each reciprocating mass as bob weight removes what turns with the crank.
    BobWeights {
        /// Whether the main crank is the only one.
        one_sense: bool,
    },
    /// Roll torque of order 1 that forces on several axes make about that of the main crank.
    Roll {
        /// Peak, N·m.
        peak: f64,
        /// What counterweights on the cranks leave of it.
        kept: f64,
    },
    /// Orders that cancel though pistons make them.
    Cancels {
        /// Force or moment.
        vector: Vector,
        /// Orders of this reason.
        orders: Vec<Order>,
        /// Why they cancel.
        reason: Reason,
        /// Cylinders that cancel each other.
        pairs: Vec<[usize; 2]>,
        /// Whether they are proved to vanish.
        proved: bool,
    },
    /// Bounds of all orders that are not mentioned, together.
    Rest {
        /// Orders that are mentioned.
        mentioned: Vec<Order>,
        /// Of force and moment.
        bounds: [f64; 2],
    },
    /// The largest order of the roll torque of inertia.
    InertiaTorque {
        /// Order.
        order: Order,
        /// Peak, N·m.
        peak: f64,
    },
    /// The crank torque of gas pressure.
    GasTorque {
        /// Mean, N·m.
        mean: f64,
        /// The largest orders with their peaks, N·m.
        largest: Vec<(Order, f64)>,
    },
    /// How the engine fires.
    Fires {
        /// Cylinders in the order in which they do.
        order: Vec<usize>,
        /// Crank angles between them, degrees.
        intervals_deg: Vec<f64>,
        /// How many fire at a time at equal intervals; none for uneven firing.
        even: Option<usize>,
    },
    /// Orders of gas torque that the firing leaves, up to that of the firing, proved.
    GasOrders {
        /// Orders.
        orders: Vec<Order>,
        /// Cylinders in the order in which they fire.
        firing: Vec<usize>,
        /// How many fire at a time at equal intervals; none for uneven firing.
        even: Option<usize>,
    },
    /// What a further load adds.
    GivenLoad {
        /// Its name.
        name: String,
        /// Its largest orders of force and of torque on block or crank; none without a speed, at which they are.
        largest: Option<[Option<LargestOrder>; 2]>,
    },
    /// Rows of a radial without link rods.
    Articulated {
        /// Cylinders on one crankpin.
        rows: Vec<Vec<usize>>,
    },
}

/// Which hardware acts on an order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acting {
    /// Counterweights.
    Counterweights,
    /// Balance shafts.
    Shafts,
    /// Both.
    Both,
}

/// Counterweights that would help.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weights {
    /// None.
    No,
    /// On the main crank.
    OnMain,
    /// On cranks besides the main one, or on others.
    OnCranks,
}

/// Why an order cancels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// All cylinders are in the reference plane.
    Plane,
    /// Two cylinders at a time cancel.
    Pairs,
    /// Such pairs are as far in front of the reference plane as behind it.
    Mirrored,
    /// The pistons of each bank pull at even intervals.
    Evenly,
    /// The pistons of each bank cancel.
    Each,
    /// Only all cylinders together cancel.
    Between,
}

/// A finding as a row of a table.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Row {
    /// Kind of finding.
    pub kind: &'static str,
    /// Force or moment, if it is about one.
    pub vector: Option<Vector>,
    /// Orders that it is about.
    pub orders: Vec<Order>,
    /// Figures; parts before angles, what is before what will be.
    pub values: Vec<f64>,
    /// Why it is so, or what does it; may be empty.
    pub reason: &'static str,
    /// Numbers of cylinders that belong together.
    pub groups: Vec<Vec<usize>>,
    /// Whether its zeros are proved.
    pub proved: bool,
}

impl Finding {
    /// Force or moment, of a finding about one.
    #[must_use]
    pub fn vector(&self) -> Option<Vector> {
        match self {
            Self::Hardware { vector, .. }
            | Self::Shakes { vector, .. }
            | Self::Remedy { vector, .. }
            | Self::Cancels { vector, .. } => Some(*vector),
            _ => None,
        }
    }

    /// The finding as a row.
    #[must_use]
    pub fn row(&self) -> Row {
        let one = |order: &Order| vec![*order];
        let numbers = |cylinders: &[usize]| cylinders.iter().map(|k| k + 1).collect::<Vec<_>>();
        let row = |kind| Row { kind, vector: self.vector(), ..Row::default() };
        match self {
            Self::Hardware { order, before, after, acting, proved, .. } => Row {
                orders: one(order),
                values: [*before, *after].concat(),
                reason: acting.name(),
                proved: *proved,
                ..row("hardware")
            },
            Self::Shakes { order, parts: [forward, backward], tilt_deg, together, .. } => Row {
                orders: one(order),
                values: vec![*forward, *backward, *tilt_deg],
                reason: if *together { "together" } else { "" },
                ..row("shakes")
            },
            Self::Remedy { order, kept, shafts, weights, .. } => Row {
                orders: one(order),
                values: [*kept]
                    .into_iter()
                    .chain(shafts.iter().map(|ratio| ratio.number()))
                    .collect(),
                reason: weights.name(),
                ..row("remedy")
            },
            Self::BobWeights { one_sense } => Row {
                orders: vec![Order::FIRST],
                values: vec![0.5],
                reason: if *one_sense { "one sense" } else { "own sense" },
                ..row("bob weights")
            },
            Self::Roll { peak, kept } => {
                Row { orders: vec![Order::FIRST], values: vec![*peak, *kept], ..row("roll") }
            }
            Self::Cancels { orders, reason, pairs, proved, .. } => Row {
                orders: orders.clone(),
                reason: reason.name(),
                groups: pairs.iter().map(|pair| numbers(pair)).collect(),
                proved: *proved,
                ..row("cancels")
            },
            Self::Rest { mentioned, bounds } => {
                Row { orders: mentioned.clone(), values: bounds.to_vec(), ..row("rest") }
            }
            Self::InertiaTorque { order, peak } => {
                Row { orders: one(order), values: vec![*peak], ..row("inertia torque") }
            }
            Self::GasTorque { mean, largest } => Row {
                orders: largest.iter().map(|(order, _)| *order).collect(),
                values: [*mean].into_iter().chain(largest.iter().map(|(_, peak)| *peak)).collect(),
                ..row("gas torque")
            },
            Self::Fires { order, intervals_deg, even } => Row {
                values: intervals_deg.clone(),
                reason: evenness(even.is_some()),
                groups: vec![numbers(order)],
                ..row("firing")
            },
            Self::GasOrders { orders, firing, even } => Row {
                orders: orders.clone(),
                reason: evenness(even.is_some()),
                groups: vec![numbers(firing)],
                proved: true,
                ..row("gas orders")
            },
            Self::GivenLoad { largest, .. } => {
                let both: Vec<_> = largest.iter().flatten().flatten().collect();
                let orders = both.iter().map(|largest| largest.order).collect();
                Row {
                    orders,
                    values: both.iter().map(|largest| largest.peak).collect(),
                    ..row("load")
                }
            }
            Self::Articulated { rows } => {
                Row { groups: rows.iter().map(|row| numbers(row)).collect(), ..row("articulated") }
            }
        }
    }
}

fn evenness(even: bool) -> &'static str {
    if even { "evenly" } else { "unevenly" }
}

/// The largest order of what a load adds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestOrder {
    /// Order.
    pub order: Order,
    /// Its peak, N or N·m.
    pub peak: f64,
    /// Whether it is more than each of the engine's other loads adds at this order.
    pub dominates: bool,
}

impl Acting {
    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Counterweights => "counterweights",
            Self::Shafts => "balance shafts",
            Self::Both => "counterweights and balance shafts",
        }
    }
}

impl Weights {
    /// Name in words; empty for none.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::No => "",
            Self::OnMain => "counterweights",
            Self::OnCranks => "counterweights on other cranks",
        }
    }
}

impl Reason {
    /// In a word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Pairs => "pairs",
            Self::Mirrored => "mirrored",
            Self::Evenly => "evenly",
            Self::Each => "each",
            Self::Between => "between",
        }
    }
}
