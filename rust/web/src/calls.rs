//! Calls by name.

use crankpin_core::{Error, Result};
use serde_json::{Map, Value, json};

use crate::answer::{self, Columns};
use crate::arguments::Arguments;
use crate::{balance, balancing, build, engine, figures, mounts, readings, typed, warnings, words};

type Call = fn(&mut Arguments, &mut Columns) -> Result<Value>;

/// Every call, for `site/core.mjs` and README.md.
const CALLS: [(&str, Call); 19] = [
    ("amplitudes", typed::amplitudes),
    ("balance", balance::balance),
    ("balance_shafts", balancing::balance_shafts),
    ("bank_angles", readings::bank_angles),
    ("bob_weights", words::bob_weights),
    ("build", build::build),
    ("counterweights", balancing::counterweights),
    ("explain", words::explain),
    ("figures", figures::figures),
    ("firing", readings::firing),
    ("harmonics", readings::piston_harmonics),
    ("mounts", mounts::mounts),
    ("quantity", typed::quantity),
    ("read", engine::read),
    ("sweep", readings::sweep),
    ("vanishing", engine::vanishing),
    ("warnings", warnings::warnings),
    ("waveform", readings::waveform),
    ("with_cycle", readings::with_cycle),
];

/// Text and doubles of the answer of a call.
pub fn answer(request: &[u8], given: Vec<f64>) -> (String, Vec<f64>) {
    let mut columns = Columns::default();
    let answer = match called(request, given, &mut columns) {
        Ok(result) => json!({ "result": result }),
        Err(error) => json!({ "error": answer::error(&error) }),
    };
    (answer.to_string(), columns.0)
}

fn called(request: &[u8], given: Vec<f64>, columns: &mut Columns) -> Result<Value> {
    let request: Map<String, Value> = serde_json::from_slice(request)
        .map_err(|error| Error::value("request", "a text", error.to_string()))?;
    let mut request = Arguments { by_name: request, numbers: given };
    let name: String = request.required("call")?;
    let Some((_, call)) = CALLS.iter().find(|(known, _)| *known == name) else {
        let names: Vec<&str> = CALLS.iter().map(|(name, _)| *name).collect();
        return Err(Error::value("call", name, format!("give {}", names.join(", "))));
    };
    let mut arguments = request.nested("with")?;
    let result = call(&mut arguments, columns)?;
    arguments.finished()?;
    Ok(result)
}
