//! Amplitudes of loads by order, as files and people give them.

use serde::{Deserialize, Serialize};

use crate::Complex64;
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;
use crate::numbers::typed::{Field, Form};

/// Amplitudes of orders, halves of crank speed: of each one for every speed of a table; order 0 is the mean.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "Vec<Vec<f64>>", into = "Vec<Vec<f64>>")]
pub struct Amplitudes(pub Vec<(u32, Vec<Complex64>)>);

impl From<Amplitudes> for Vec<Vec<f64>> {
    /// Rows of an order, then real and imaginary parts.
    fn from(amplitudes: Amplitudes) -> Self {
        let row = |(halves, values): (u32, Vec<Complex64>)| {
            let parts = values.into_iter().flat_map(|value| [value.re, value.im]);
            std::iter::once(0.5 * f64::from(halves)).chain(parts).collect()
        };
        amplitudes.0.into_iter().map(row).collect()
    }
}

impl TryFrom<Vec<Vec<f64>>> for Amplitudes {
    type Error = Error;

    fn try_from(rows: Vec<Vec<f64>>) -> Result<Self> {
        let row = |row: Vec<f64>| match &row[..] {
            [order, parts @ ..] if !parts.is_empty() && parts.len() % 2 == 0 => {
                let values = parts.as_chunks::<2>().0;
                Ok((
                    halves(*order)?,
                    values.iter().map(|[re, im]| Complex64::new(*re, *im)).collect(),
                ))
            }
            _ => {
                let hint = "give an order, then real and imaginary part: [1.5, 8, 3]";
                Err(Error::value("loads", format!("{row:?}"), hint))
            }
        };
        rows.into_iter().map(row).collect::<Result<_>>().map(Self)
    }
}

/// Twice an order, 0 or more.
fn halves(order: f64) -> Result<u32> {
    let halves = 2.0 * order;
    if halves.fract() == 0.0 && (0.0..=2.0 * f64::from(limits::HIGHEST_ORDER)).contains(&halves) {
        return Ok(halves as u32);
    }
    let hint = format!(
        "give multiples of half the crank speed, 0 (the mean) to {}",
        limits::HIGHEST_ORDER
    );
    Err(Error::figure("orders", order, hint))
}

impl Amplitudes {
    /// Reads amplitudes as they are typed: `2:8, 4:1.5@-30, 6:4-1j`, order and size at a phase in degrees, or
    /// complex number; of a table one for each speed, `2:8/9/12`.
    pub fn typed(text: &str, field: &Field) -> Result<Self> {
        let form = "give ORDER:SIZE, ORDER:SIZE@DEGREES or ORDER:A+Bj, such as 2:8,4:1.5@-30";
        let wrong = || Error::value(field.argument, text.trim(), form);
        let number = |text: &str| -> Result<f64> {
            let read = field.read(text, Form::Number)?;
            read.values.first().copied().ok_or_else(wrong)
        };
        let amplitude = |text: &str| -> Result<Complex64> {
            if let Some((size, phase)) = text.split_once('@') {
                let phase: Angle =
                    phase.trim().trim_end_matches('°').parse().map_err(|_| wrong())?;
                return Ok(phase.cis(1) * number(size)?);
            }
            let Some((parts, unit)) = text.split_once('j') else {
                return Ok(number(text)?.into());
            };
            // The sign between the parts: one that begins a number or its exponent is none.
            let between = parts.char_indices().rev().find(|&(k, sign)| {
                k > 0 && matches!(sign, '+' | '-' | '−') && !parts[..k].ends_with(['e', 'E'])
            });
            let (re, im) = parts.split_at(between.map_or(0, |(k, _)| k));
            let part = |text: &str| number(&format!("{} {unit}", text.replace(' ', "")));
            Ok(Complex64::new(if re.trim().is_empty() { 0.0 } else { part(re)? }, part(im)?))
        };
        let entries = text.split([',', ';']).map(str::trim).filter(|entry| !entry.is_empty());
        let rows = entries.map(|entry| {
            let (order, values) = entry.split_once(':').ok_or_else(wrong)?;
            let order = halves(order.trim().parse().map_err(|_| wrong())?)?;
            Ok((order, values.split('/').map(amplitude).collect::<Result<_>>()?))
        });
        let rows: Vec<_> = rows.collect::<Result<_>>()?;
        if rows.is_empty() { Err(wrong()) } else { Ok(Self(rows)) }
    }

    /// Rejects orders that are given twice or too high, numbers that are none, and where that says why means; sorts
    /// them. Each order has `rows` numbers.
    pub(crate) fn check(&mut self, place: &str, rows: usize, no_mean: &str) -> Result<()> {
        self.0.sort_by_key(|(halves, _)| *halves);
        if let Some(pair) = self.0.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let order = 0.5 * f64::from(pair[0].0);
            return Err(Error::figure(place, order, "is given twice; give each order once"));
        }
        for (halves, values) in &self.0 {
            let order = 0.5 * f64::from(*halves);
            limits::same_length(
                &format!("{place}[{order}]"),
                values.len(),
                "the load",
                rows,
                "speed",
            )?;
            for value in values {
                limits::finite(place, value.re)?;
                limits::finite(place, value.im)?;
                if *halves == 0 && value.im != 0.0 {
                    return Err(Error::value(place, value, "a mean is a real number"));
                }
            }
            if *halves == 0 && !no_mean.is_empty() {
                return Err(Error::figure(place, order, no_mean));
            }
            if *halves > 2 * limits::HIGHEST_ORDER {
                self::halves(order)?;
            }
        }
        Ok(())
    }
}
