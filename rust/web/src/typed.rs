//! Numbers as they are typed.

use crankpin_core::Result;
use crankpin_core::engine::Amplitudes;
use crankpin_core::numbers::typed::{Field, Form};
use serde_json::{Value, json};

use crate::answer::Columns;
use crate::arguments::Arguments;

/// The numbers of a text, with units or in a plain one.
pub fn quantity(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let text: String = arguments.required("text")?;
    let unit: String = arguments.or("unit", String::new())?;
    let plain: String = arguments.or("plain", String::new())?;
    let name: String = arguments.or("name", "value".to_owned())?;
    let what: String = arguments.or("what", "a number".to_owned())?;
    let form = Form::named(&arguments.or("form", "number".to_owned())?)?;
    let field = Field { argument: &name, unit: &unit, plain: &plain, what: &what, infinite: false };
    let read = field.read(&text, form)?;
    Ok(json!({
        "values": read.values, "texts": read.texts, "unit": read.unit, "listed": read.is_listed,
        "point": read.point,
    }))
}

/// Amplitudes by order of a text: rows of an order, then real and imaginary parts.
pub fn amplitudes(arguments: &mut Arguments, _: &mut Columns) -> Result<Value> {
    let text: String = arguments.required("text")?;
    let unit: String = arguments.required("unit")?;
    let name: String = arguments.required("name")?;
    let what = "an amplitude";
    let field = Field { argument: &name, unit: &unit, plain: &unit, what, infinite: false };
    Ok(json!(Amplitudes::typed(&text, &field)?))
}
