//! Warnings of figures that no body and no mount has: impossible tensors, and other units.

use super::{MountFigures, Powertrain, RigidBody, Support};
use crate::numbers::error::Warning;
use crate::numbers::figure::significant;

/// Part of the largest principal moment that rounding lets the sum of the others lack.
const MOST_MISSING: f64 = 1e-9;
/// Distance of a centre of gravity or a mount from the crank, m, above which it is not in metres.
const FARTHEST_MOUNT: f64 = 20.0;
/// Radii of gyration, m, of bodies from a model engine to the block under a ship's; others are in other units.
const GYRATION: [f64; 2] = [1e-3, 20.0];
/// Stiffness of a mount, N/m, below and above which it is likely not in N/m: soil under a large block reaches 1e11.
const STIFFNESS: [f64; 2] = [1e3, 1e12];
/// Mass of a body over the product of its radii of gyration, kg/m³, that none of osmium reaches.
///
/// Of all bodies of one density a ball has the most: 16.7 times the density.
const DENSEST: f64 = 4e5;
/// Gap of a snubber, m, above which it is not in metres.
const LARGEST_GAP: f64 = 0.5;
/// Damping of a mount over its stiffness, s: less is a loss of 1 % at 160 Hz, below any spring's.
const LEAST_DAMPING: f64 = 1e-5;
/// Loss factor of a mount above which it is likely in per cent: rubber reaches about 1.
const LARGEST_LOSS: f64 = 3.0;

fn figure(value: f64) -> String {
    significant(value, 6)
}

/// Of a body on its mounts, and of a subframe below them; arguments are named as in a file.
#[must_use]
pub fn of_powertrain(powertrain: &Powertrain) -> Vec<Warning> {
    within("powertrain", powertrain)
}

fn within(place: &str, powertrain: &Powertrain) -> Vec<Warning> {
    let named = |of: String, found: Vec<Warning>| {
        let name =
            move |each: Warning| Warning { argument: format!("{of}.{}", each.argument), ..each };
        found.into_iter().map(name)
    };
    let mut found: Vec<Warning> = tensor(powertrain.body()).into_iter().collect();
    found.extend(body(powertrain.body()));
    let mut found: Vec<Warning> = named(format!("{place}.body"), found).collect();
    for (k, each) in powertrain.mounts().iter().enumerate() {
        found.extend(named(format!("{place}.mounts[{k}]"), mount(each.figures())));
    }
    if let Some(Support::Subframe(subframe)) = powertrain.support() {
        found.extend(within(&format!("{place}.subframe"), subframe));
    }
    found
}

/// Of a tensor of inertia that no body has.
#[must_use]
pub fn tensor(body: &RigidBody) -> Option<Warning> {
    let missing = body.missing_inertia();
    let fault = || {
        format!(
            "has principal moments of {} kg·m²: the largest is more than the sum of the others, which \
             lacks {} % of it",
            body.principal_moments().map(figure).join(", "),
            significant(100.0 * missing, 3)
        )
    };
    let hint = "no body has such a tensor. Is it about the centre of gravity, with the right sign of its \
                products?";
    (missing > MOST_MISSING).then(|| Warning::new("inertia", fault(), hint))
}

/// Of a body whose figures are in other units.
#[must_use]
pub fn body(body: &RigidBody) -> Vec<Warning> {
    let radii = body.principal_moments().map(|moment| (moment / body.mass()).sqrt());
    let [smallest, _, largest] = radii;
    let between = [smallest, largest].map(|radius| significant(radius, 3)).join(" to ");
    let units = if smallest < GYRATION[0] || largest > GYRATION[1] {
        let fault = format!("has radii of gyration from {between} m");
        Some(Warning::new("inertia", fault, "are mass and inertia in kg and kg·m²?"))
    } else if body.mass() > DENSEST * radii.iter().product::<f64>() {
        let mass = figure(body.mass());
        let fault =
            format!("= {mass} kg has radii of gyration from {between} m, so dense is no metal");
        Some(Warning::new("mass", fault, "was it given in grams?"))
    } else {
        None
    };
    units.into_iter().chain(place("cg", body.cg().into())).collect()
}

/// Of a mount whose figures are in other units.
#[must_use]
pub fn mount(figures: &MountFigures) -> Vec<Warning> {
    let MountFigures { name, loss_factor, damping, .. } = figures;
    let mut found = Vec::new();
    let mut report = |argument, value: f64, unit, hint| {
        let warning = Warning::new(argument, format!("= {}{unit}", figure(value)), hint);
        found.push(warning.about(format!("{argument} of mount '{name}'")));
    };
    if let Some(&loss) = loss_factor.iter().find(|&&loss| loss > LARGEST_LOSS) {
        report("loss_factor", loss, "", "was it given in per cent?");
    }
    let along = figures.stiffness.into_iter().filter(|&stiffness| stiffness != 0.0);
    let least = along.reduce(f64::min).map_or(0.0, |stiffness| LEAST_DAMPING * stiffness);
    let largest = damping.iter().copied().fold(0.0, f64::max);
    if 0.0 < largest && largest < least {
        report("damping", largest, " N·s/m", "was it given in N·s/mm?");
    }
    let gaps = figures.gap.as_flattened();
    if let Some(&gap) = gaps.iter().find(|&&gap| gap > LARGEST_GAP) {
        report("gap", gap, " m", "was it given in millimetres?");
    }
    found.extend(stiffness("stiffness", name, &figures.stiffness));
    let snubbers = figures.snubber_stiffness.as_flattened();
    found.extend(stiffness("snubber_stiffness", name, snubbers));
    found.extend(stiffness(
        "dynamic_stiffness",
        name,
        figures.dynamic_stiffness.as_slice().as_flattened(),
    ));
    let table = figures.table.iter().flat_map(|table| &table.stiffness);
    let largest = table.fold([0.0; 3], |most: [f64; 3], row| {
        [0, 1, 2].map(|axis| most[axis].max(row[axis].norm()))
    });
    found.extend(stiffness("table", name, &largest));
    let at = place("at", figures.at);
    found.extend(at.map(|warning| warning.about(format!("at of mount '{name}'"))));
    found
}

/// Of stiffness of a mount in other units, by the name of its argument, N/m; 0 is none.
#[must_use]
pub fn stiffness(argument: &str, mount: &str, values: &[f64]) -> Option<Warning> {
    let [least, most] = STIFFNESS;
    let wrong = values.iter().find(|&&value| value != 0.0 && !(least..=most).contains(&value))?;
    let fault = format!("= {} N/m", figure(*wrong));
    let warning = Warning::new(argument, fault, "was it given in N/mm?");
    Some(warning.about(format!("{argument} of mount '{mount}'")))
}

/// Of a place on a body that is in millimetres, m.
#[must_use]
pub fn place(argument: &str, at: [f64; 3]) -> Option<Warning> {
    let is_far = at.iter().any(|along| along.abs() > FARTHEST_MOUNT);
    let places = at.map(figure).join(", ");
    let fault = || format!("= ({places}) m");
    is_far.then(|| Warning::new(argument, fault(), "was it given in millimetres?"))
}
