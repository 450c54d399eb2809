//! Values of answers as JSON, and columns of doubles beside it.

use crankpin_core::{Angle, Complex64, Error, Order};
use serde_json::{Value, json};

/// Doubles of an answer, one column after the other.
#[derive(Default)]
pub struct Columns(pub Vec<f64>);

impl Columns {
    /// Where a column is, for `site/core.mjs`, which has a `Float64Array` in its place.
    pub fn column(&mut self, values: impl IntoIterator<Item = f64>) -> Value {
        let start = self.0.len();
        if start == 0 {
            // A vector stays where it is.
            self.0 = values.into_iter().collect();
        } else {
            self.0.extend(values);
        }
        json!({ "column": [start, self.0.len() - start] })
    }
}

/// A complex number as a pair.
pub fn pair(value: Complex64) -> Value {
    json!([value.re, value.im])
}

/// Angles in degrees.
pub fn degrees(angles: impl IntoIterator<Item = Angle>) -> Vec<f64> {
    angles.into_iter().map(Angle::degrees).collect()
}

/// An order: whole where it is.
pub fn order(order: Order) -> Value {
    order.as_whole().map_or_else(|| json!(order.number()), |whole| json!(whole))
}

/// Orders.
pub fn orders(list: &[Order]) -> Vec<Value> {
    list.iter().map(|&n| order(n)).collect()
}

/// An error, its message and its parts.
pub fn error(error: &Error) -> Value {
    let fields = error.fields();
    let argument = fields.as_ref().map(|(argument, ..)| *argument);
    let value = fields.as_ref().and_then(|(_, value, _)| *value);
    let hint = fields.as_ref().map(|(.., hint)| hint.as_ref());
    json!({ "message": error.to_string(), "argument": argument, "value": value, "hint": hint })
}
