//! An engine's body on its mounts.

use crankpin_core::mounts::{LoadCase, at_rest, modes};
use crankpin_core::{Error, Result};
use serde_json::{Value, json};

use crate::answer::Columns;
use crate::arguments::Arguments;

/// Modes of a body on its mounts, and its state at rest.
pub fn mounts(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let (_, powertrain) = arguments.mounted()?;
    let hint = "give the file of an engine on mounts";
    let powertrain = powertrain.ok_or_else(|| Error::value("powertrain", "none", hint))?;
    let frequency = arguments.optional("frequency")?;
    let gravity = arguments.or("gravity", LoadCase::default().gravity)?;
    let torque: f64 = arguments.or("torque", 0.0)?;
    let [thrust, thrust_at] = arguments.or("thrust", [[0.0; 3]; 2])?;
    let found = modes(&powertrain, frequency)?;
    let columns = |matrix: &nalgebra::DMatrix<f64>| -> Vec<Vec<f64>> {
        matrix.column_iter().map(|column| column.iter().copied().collect()).collect()
    };
    // The call has the torque on the body.
    let case = LoadCase { gravity, torque: -torque, thrust, thrust_at, ..LoadCase::default() };
    let still = at_rest(&powertrain, &case)?;
    Ok(json!({
        "mounts": powertrain.all_names(),
        "modes": {
            "frequency": found.frequency, "damped_frequency": found.damped_frequency,
            "loss_factor": found.loss_factor, "purity": found.purity, "shapes": columns(&found.shapes),
            "energy": columns(&found.energy), "strain": found.strain,
        },
        "static": {
            "displacement": still.displacement, "force": still.force,
            "support_margin": still.support_margin, "support_corners": still.support_corners,
        },
    }))
}
