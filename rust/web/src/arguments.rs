//! Arguments of a call, by name.

use crankpin_core::engine::{Hold, file};
use crankpin_core::mounts::Powertrain;
use crankpin_core::{Angle, Engine, Error, Order, Result, Spectrum};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// Those that are not read yet.
pub struct Arguments {
    pub by_name: Map<String, Value>,
    /// Doubles, to which columns point.
    pub numbers: Vec<f64>,
}

impl Arguments {
    /// An argument that may be left out, or null.
    pub fn optional<T: DeserializeOwned>(&mut self, name: &str) -> Result<Option<T>> {
        let Some(value) = self.by_name.remove(name).filter(|value| !value.is_null()) else {
            return Ok(None);
        };
        let read = T::deserialize(&value);
        read.map(Some).map_err(|error| Error::value(name, value, error.to_string()))
    }

    /// An argument with a default.
    pub fn or<T: DeserializeOwned>(&mut self, name: &str, default: T) -> Result<T> {
        Ok(self.optional(name)?.unwrap_or(default))
    }

    /// An argument that must be given.
    pub fn required<T: DeserializeOwned>(&mut self, name: &str) -> Result<T> {
        self.optional(name)?.ok_or_else(|| Error::value(name, "none", "is required"))
    }

    /// Whether an argument is given.
    pub fn has(&self, name: &str) -> bool {
        self.by_name.get(name).is_some_and(|value| !value.is_null())
    }

    /// Arguments that are an object of their own.
    pub fn nested(mut self, name: &str) -> Result<Self> {
        let by_name = self.required(name)?;
        Ok(Self { by_name, numbers: self.numbers })
    }

    /// Numbers, one or a list, if they are given.
    pub fn numbers(&mut self, name: &str) -> Result<Option<Vec<f64>>> {
        let Some(value) = self.optional::<Value>(name)? else { return Ok(None) };
        let numbers = match &value {
            Value::Number(_) => value.as_f64().map(|number| vec![number]),
            Value::Array(list) => list.iter().map(Value::as_f64).collect(),
            Value::Object(column) => self.column(column),
            _ => None,
        };
        let hint = "give numbers, or a Float64Array";
        numbers.map(Some).ok_or_else(|| Error::value(name, value, hint))
    }

    /// Doubles beside the text.
    fn column(&self, column: &Map<String, Value>) -> Option<Vec<f64>> {
        let [start, count] = column.get("column")?.as_array()?.as_slice() else { return None };
        let [start, count] = [start, count].map(|place| place.as_u64().unwrap_or(0) as usize);
        Some(self.numbers.get(start..start.checked_add(count)?)?.to_vec())
    }

    /// Rejects what the call did not read.
    pub fn finished(self) -> Result<()> {
        let Some(name) = self.by_name.keys().next() else { return Ok(()) };
        Err(Error::value("argument", name, "is not one of this call"))
    }

    /// One of a few words.
    pub fn word<T: Copy>(&mut self, name: &str, words: &[(&str, T)]) -> Result<T> {
        let word: String = self.or(name, words[0].0.to_owned())?;
        words.iter().find(|(known, _)| *known == word).map(|(_, value)| *value).ok_or_else(|| {
            let words: Vec<String> = words.iter().map(|(word, _)| format!("\"{word}\"")).collect();
            Error::value(name, format!("\"{word}\""), format!("give {}", words.join(" or ")))
        })
    }

    /// The engine of a file's text, and its body on mounts, if there is one.
    pub fn mounted(&mut self) -> Result<(Engine, Option<Powertrain>)> {
        let text: Value = self.required("engine")?;
        let text = text.as_str().map_or_else(|| text.to_string(), str::to_owned);
        let is_json = text.trim_start().starts_with('{');
        let read = if is_json { file::mounted_from_json } else { file::mounted_from_toml };
        let (engine, powertrain) = read(&text)?;
        let hint = "the page draws engines, and the file has none: a table of forces alone";
        Ok((engine.ok_or_else(|| Error::value("engine", "none", hint))?, powertrain))
    }

    /// The engine of a file's text, with a force given for every cylinder, if there is one.
    pub fn engine(&mut self) -> Result<Engine> {
        let engine = self.mounted()?.0;
        let Some(terms) = self.optional::<Vec<(u32, [f64; 2])>>("spectrum")? else {
            return Ok(engine);
        };
        let terms =
            terms.into_iter().map(|(n, [re, im])| (n, crankpin_core::Complex64::new(re, im)));
        Ok(engine.with_spectrum(Spectrum::new(terms)?))
    }

    /// Orders, if they are given.
    pub fn orders(&mut self) -> Result<Option<Vec<Order>>> {
        let numbers = self.numbers("orders")?;
        numbers.map(|list| list.into_iter().map(Order::from_number).collect()).transpose()
    }

    /// Degrees, a number or a text.
    pub fn angle(&mut self, name: &str) -> Result<Option<Angle>> {
        self.optional::<Value>(name)?.map(|value| angle(name, &value)).transpose()
    }

    /// A list of degrees, numbers or texts.
    pub fn angles(&mut self, name: &str) -> Result<Option<Vec<Angle>>> {
        let Some(values) = self.optional::<Vec<Value>>(name)? else { return Ok(None) };
        let angles =
            values.iter().enumerate().map(|(i, value)| angle(&format!("{name}[{i}]"), value));
        angles.collect::<Result<_>>().map(Some)
    }

    /// What a change of bank angle holds.
    pub fn hold(&mut self) -> Result<Hold> {
        self.word("hold", &[("pins", Hold::Pins), ("firing", Hold::Firing)])
    }
}

fn angle(name: &str, value: &Value) -> Result<Angle> {
    let angle = if let Value::String(text) = value {
        text.parse()
    } else {
        let hint = "give degrees, a number or a text such as \"360/7\"";
        let number = value.as_f64().ok_or_else(|| Error::value(name, value, hint))?;
        Angle::from_degrees(number)
    };
    angle.map_err(|error| error.named(name))
}
