//! Numbers as people type them: with a unit, a fraction, a decimal comma, in a list or a range.
//!
//! What can be read in two ways is an error that names both: `6,000` may be six thousand or six.

use crate::numbers::decimal::Exact;
use crate::numbers::error::{Error, Result};
use crate::numbers::units;

/// Digits behind a comma up to which two numbers are one: `88,9` is no list, `100,200` may be.
const MOST_COMMA_DIGITS: usize = 2;
/// Digits of a group of thousands.
const GROUP: usize = 3;
/// Most numbers in a range or list.
pub const MOST_LISTED: usize = 1_000_000;

/// A field in which numbers are typed.
#[derive(Debug, Clone, Copy)]
pub struct Field<'a> {
    /// Name in errors.
    pub argument: &'a str,
    /// Unit of the library: of masses, lengths, forces, pressures and their products, `°`, `rpm`, empty of
    /// ratios, `count`.
    pub unit: &'a str,
    /// Unit of a number that is typed without one; empty for that of the library.
    pub plain: &'a str,
    /// What to give, in an error.
    pub what: &'a str,
    /// Whether `inf` is a number.
    pub infinite: bool,
}

/// How many numbers a field takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// One.
    Number,
    /// Several with commas, semicolons or spaces between.
    List,
    /// A list, or `START:STOP:STEP` with the stop included.
    Range,
    /// One, in which a comma may be that of decimals, or a list.
    Several,
}

impl Form {
    /// The form of a name: number, list, range or several.
    pub fn named(name: &str) -> Result<Self> {
        let forms = [
            ("number", Self::Number),
            ("list", Self::List),
            ("range", Self::Range),
            ("several", Self::Several),
        ];
        let found = forms.into_iter().find(|(known, _)| *known == name);
        let hint = "give number, list, range or several";
        found.map(|(_, form)| form).ok_or_else(|| Error::value("form", name, hint))
    }
}

/// What was read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Reading {
    /// The numbers, in the unit of the library.
    pub values: Vec<f64>,
    /// The numbers as they were typed, without units, with a point for a comma; of a range its ends and step.
    pub texts: Vec<String>,
    /// The first unit that was typed.
    pub unit: Option<String>,
    /// Whether it is a list or a range, if only of one number.
    pub is_listed: bool,
    /// The text with a point where a comma was read as one.
    pub point: Option<String>,
}

impl Field<'_> {
    /// The numbers of a text.
    pub fn read(&self, text: &str, form: Form) -> Result<Reading> {
        let text = text.trim();
        match form {
            Form::Number => self.one(text),
            Form::Range if text.contains(':') => Self { what: "a number", ..*self }.range(text),
            Form::List | Form::Range => self.list(text),
            Form::Several => self.one(text).or_else(|error| match parts(text).len() {
                0 | 1 => Err(error),
                _ if grouped(text).is_some() => Err(error),
                _ => self.list(text),
            }),
        }
    }

    fn wrong(&self, text: &str, hint: impl Into<String>) -> Error {
        Error::value(self.argument, text, hint)
    }

    /// One number, with or without a unit.
    fn one(&self, text: &str) -> Result<Reading> {
        let pointed = self.pointed(text)?;
        let read = pointed.as_deref().unwrap_or(text);
        let typed = self.typed(read)?;
        let value = self.value(&typed, typed.word, read)?;
        let unit = (!typed.word.is_empty()).then(|| typed.word.to_owned());
        let texts = vec![typed.text.clone()];
        Ok(Reading { values: vec![value], texts, unit, is_listed: false, point: pointed })
    }

    /// A number with a point for its decimal comma, if it has one; an error where the comma may be another.
    fn pointed(&self, text: &str) -> Result<Option<String>> {
        if let Some(Grouped { joined, decimal, unit }) = grouped(text) {
            let two = decimal.map(|decimal| format!(" or {decimal}{unit}")).unwrap_or_default();
            let hint = format!("may be grouped in thousands: write {joined}{unit}{two}");
            return Err(self.wrong(text, hint));
        }
        let Some((whole, rest)) = text.split_once(',') else { return Ok(None) };
        let digits = rest.len() - rest.trim_start_matches(|sign: char| sign.is_ascii_digit()).len();
        let (decimals, behind) = rest.split_at(digits);
        let is_number =
            |text: &str| !text.is_empty() && text.bytes().all(|sign| sign.is_ascii_digit());
        let unsigned = whole.trim_start_matches(['+', '-', '−']);
        let goes_on = behind.contains(|sign: char| sign.is_ascii_digit() || ",:=".contains(sign));
        let is_exponent = behind.starts_with(['e', 'E']);
        if !is_number(unsigned) || decimals.is_empty() || goes_on && !is_exponent {
            return Ok(None);
        }
        let zeros = unsigned.trim_start_matches('0').is_empty();
        if decimals.len() > MOST_COMMA_DIGITS && !zeros && !decimals.starts_with('0') {
            let hint = format!(
                "is one number or two: write {whole}.{decimals}{behind}, or {whole}{behind} or {decimals}{behind}"
            );
            return Err(self.wrong(text, hint));
        }
        Ok(Some(format!("{whole}.{decimals}{behind}")))
    }

    /// Numbers with commas between; a unit behind the last alone is that of all.
    fn list(&self, text: &str) -> Result<Reading> {
        self.check_list(text)?;
        let listed = parts(text);
        if listed.len() > MOST_LISTED {
            return Err(self.wrong(text, format!("give {MOST_LISTED} numbers at most")));
        }
        if let [first, last] = listed.as_slice()
            && let Some(point) = self.one_of_two(text, first, last)?
        {
            return Ok(Reading {
                is_listed: true,
                point: Some(point.clone()),
                ..self.one(&point)?
            });
        }
        let mut reading = self.all(&listed, text)?;
        reading.is_listed = text.contains([',', ';']) || listed.len() > 1;
        Ok(reading)
    }

    /// The one number that two with one unit between them are, `88,9mm`; an error where they may be both.
    fn one_of_two(&self, text: &str, first: &str, last: &str) -> Result<Option<String>> {
        let is_whole = |text: &str| {
            let digits = text.trim_start_matches(['+', '-', '−']);
            !digits.is_empty() && digits.bytes().all(|sign| sign.is_ascii_digit())
        };
        let Ok(Typed { word, .. }) = self.typed(last) else { return Ok(None) };
        let decimals = last.trim_end_matches(word).trim_end();
        let is_zero = first.trim_start_matches(['+', '-', '−', '0']).is_empty();
        let joined = format!("{first},{last}");
        if word.is_empty()
            || !is_whole(first)
            || !decimals.bytes().all(|sign| sign.is_ascii_digit())
        {
            return Ok(None);
        }
        if is_zero || joined != text || !self.is_measure() {
            return Ok(None);
        }
        if decimals.len() > MOST_COMMA_DIGITS {
            let gap = &last[decimals.len()..];
            let hint =
                format!("write {first}.{last}, or the unit behind both: {first}{gap},{last}");
            return Err(self.wrong(text, hint));
        }
        Ok(Some(format!("{first}.{last}")))
    }

    /// Whether the unit is of masses, lengths, forces, pressures.
    fn is_measure(&self) -> bool {
        units::factor(self.unit).is_some()
    }

    /// Rejects a list that may be numbers grouped in thousands: `6,000`, and of speeds `1,500` too.
    fn check_list(&self, text: &str) -> Result<()> {
        let bare: Vec<&str> = text.split([',', '\'', '’']).collect();
        for pair in bare.windows(2) {
            let [first, second] = [pair[0], pair[1]];
            let digits =
                second.len() - second.trim_start_matches(|sign: char| sign.is_ascii_digit()).len();
            let lead = first.trim_start_matches(['+', '-', '−']);
            let is_group = digits == GROUP && !second[digits..].starts_with('.');
            let is_lead = (1..=GROUP).contains(&lead.len())
                && lead.bytes().all(|sign| sign.is_ascii_digit())
                && !lead.starts_with('0');
            let is_speed = self.unit == "rpm" && lead.len() < GROUP;
            if is_group && is_lead && (second.starts_with('0') || is_speed) {
                let which = if bare.len() == 2 { "" } else { &format!("{first},{second} ") };
                let both = format!("write {first}{second} or {first}.{second}");
                let mut hint = format!("{which}may be grouped in thousands: {both}");
                if !second.starts_with('0') {
                    hint = format!("{hint}, or two numbers as \"{first}, {second}\"");
                }
                return Err(self.wrong(text, hint));
            }
        }
        Ok(())
    }

    /// Several numbers of a text.
    fn all(&self, listed: &[&str], text: &str) -> Result<Reading> {
        let typed: Vec<Typed> =
            listed.iter().map(|part| self.typed(part)).collect::<Result<_>>()?;
        let unit = typed.iter().find(|typed| !typed.word.is_empty()).map(|typed| typed.word);
        // Behind all numbers there is a unit, behind the last alone, or behind none; zero needs none.
        // A ratio without one is no percentage.
        let bare = |typed: &Typed| typed.word.is_empty() && typed.number.number != 0;
        let last = typed.last().map_or("", |typed| typed.word);
        let others = &typed[..typed.len().saturating_sub(1)];
        let has_unit = |typed: &Typed| !typed.word.is_empty();
        let is_mixed = last.is_empty() || self.unit.is_empty() || others.iter().any(has_unit);
        if typed.iter().any(bare) && unit.is_some() && is_mixed {
            let alone = if self.unit.is_empty() { "" } else { ", or behind the last alone" };
            return Err(self.wrong(text, format!("give the unit behind every number{alone}")));
        }
        let values = typed.iter().zip(listed).map(|(typed, part)| {
            self.value(typed, if typed.word.is_empty() { last } else { typed.word }, part)
        });
        Ok(Reading {
            values: values.collect::<Result<_>>()?,
            texts: typed.iter().map(|typed| typed.text.clone()).collect(),
            unit: unit.map(str::to_owned),
            ..Reading::default()
        })
    }

    /// Numbers from START to STOP, as they would be typed: 0.2:0.4:0.1 has 0.3 and 0.4.
    fn range(&self, text: &str) -> Result<Reading> {
        let listed: Vec<&str> = text.split(':').map(str::trim).collect();
        let [start, stop, step] = listed[..] else {
            return Err(self.wrong(text, "give START:STOP:STEP, a,b,c or one number"));
        };
        for part in &listed {
            if self.pointed(part)?.is_some() {
                let hint = format!("give START:STOP:STEP with points for decimals, not {part}");
                return Err(self.wrong(text, hint));
            }
        }
        let ends = self.all(&listed, text)?;
        let word = ends.unit.as_deref().unwrap_or_default();
        let exact = |part: &str| {
            let typed = self.typed(part)?;
            let word = if typed.word.is_empty() { word } else { typed.word };
            self.scaled(&typed, word, part)
        };
        let (from, to, by) = (exact(start)?, exact(stop)?, exact(step)?);
        let [first, end, stride] = [ends.values[0], ends.values[1], ends.values[2]];
        if stride == 0.0 || (end - first) * stride < 0.0 || !(first + end + stride).is_finite() {
            return Err(self.wrong(text, format!("the step does not lead from {start} to {stop}")));
        }
        let steps = (end - first) / stride;
        if steps >= MOST_LISTED as f64 {
            let many = crate::numbers::figure::significant(steps, 3);
            return Err(self.wrong(text, format!("{many} steps; give {MOST_LISTED} at most")));
        }
        // Exactly, or as doubles where a number has too many digits.
        let point = |k: i128| {
            let strides = by.and_then(|by| by.times(Exact { number: k, power: 0, below: 1 }));
            from.zip(strides).and_then(|(from, strides)| from.plus(strides))
        };
        let is_within = |k: i128| {
            let rest = point(k).zip(to).and_then(|(point, to)| to.plus(point.negative()));
            rest.map_or(k as f64 <= steps, |rest| {
                rest.number == 0 || (rest.number > 0) == (stride > 0.0)
            })
        };
        let mut last = steps.round() as i128;
        if !is_within(last) {
            last -= 1;
        }
        let value = |k| point(k).map_or_else(|| first + k as f64 * stride, Exact::value);
        Ok(Reading { values: (0..=last).map(value).collect(), is_listed: true, ..ends })
    }

    /// A text as a number and the word behind it.
    fn typed<'t>(&self, text: &'t str) -> Result<Typed<'t>> {
        let text = text.trim();
        let infinite = ["inf", "+inf", "infinity"].contains(&text.to_ascii_lowercase().as_str());
        if infinite && self.infinite {
            return Ok(Typed { number: Exact::ONE, word: "", text: "inf".into(), is_proper: true });
        }
        if infinite || ["-inf", "nan", "snan"].contains(&text.to_ascii_lowercase().as_str()) {
            return Err(self.wrong(text, "give a finite number"));
        }
        // 3 7/16 is read off a rule; an angle or a ratio is 360/7.
        let fraction = fraction(text).filter(|typed| self.is_measure() || typed.is_proper);
        let typed = fraction.or_else(|| decimal(text));
        let typed = typed
            .filter(|typed| typed.word.is_empty() || units::typed(typed.word, self.unit).is_some());
        typed.ok_or_else(|| self.wrong(text, self.hint(text)))
    }

    /// A number in the unit of the library; None where it has too many digits for exact arithmetic.
    fn scaled(&self, typed: &Typed, word: &str, text: &str) -> Result<Option<Exact>> {
        let word = if word.is_empty() { self.plain } else { word };
        let factor = if word.is_empty() || word == self.unit {
            Some(Exact::ONE)
        } else {
            units::typed(word, self.unit)
        };
        let factor = factor.ok_or_else(|| self.wrong(text, self.hint(text)))?;
        Ok(typed.number.times(factor))
    }

    fn value(&self, typed: &Typed, word: &str, text: &str) -> Result<f64> {
        if typed.text == "inf" {
            return Ok(f64::INFINITY);
        }
        let value = match self.scaled(typed, word, text)? {
            Some(exact) => exact.value(),
            None => {
                typed.number.value()
                    * self
                        .scaled(&Typed { number: Exact::ONE, ..typed.clone() }, word, text)?
                        .map_or(f64::NAN, Exact::value)
            }
        };
        if value.is_finite() { Ok(value) } else { Err(self.wrong(text, "give a finite number")) }
    }

    /// What may be typed: a number, units, how a range is typed, the unit that was meant.
    fn hint(&self, text: &str) -> String {
        let what = self.what;
        if let Some(range) = as_range(text) {
            return format!("give {what}, such as {range}");
        }
        let word = fraction(text).or_else(|| decimal(text)).map_or("", |typed| typed.word);
        let meant = units::meant(word, self.unit).map(|unit| format!("; did you mean {unit}?"));
        let meant = meant.unwrap_or_default();
        match units::hint(self.unit) {
            Some(known) => format!("give {what}, such as 12 or with a unit ({known}){meant}"),
            None if word.is_empty() || self.unit == "°" => format!("give {what}{meant}"),
            None => format!("give {what} without a unit{meant}"),
        }
    }
}

/// A number and the word behind it.
#[derive(Debug, Clone)]
struct Typed<'t> {
    number: Exact,
    word: &'t str,
    /// The number alone.
    text: String,
    /// Whether it is a fraction, or a decimal, without a whole number before it.
    is_proper: bool,
}

/// A number whose digits are in groups of three.
struct Grouped<'t> {
    /// Its digits without signs between.
    joined: String,
    /// With a point for its comma, if it has one alone.
    decimal: Option<String>,
    /// What is behind it.
    unit: &'t str,
}

/// A number that may be grouped in thousands: 6,000, 1.234.567, 6 000, 1'234.5.
fn grouped(text: &str) -> Option<Grouped<'_>> {
    const SIGNS: [char; 8] = [',', '.', '\'', '’', ' ', '\u{a0}', '\u{202f}', '_'];
    let unsigned = text.trim_start_matches(['+', '-', '−']);
    let sign = &text[..text.len() - unsigned.len()];
    let mut groups = vec![String::new()];
    let mut signs = Vec::new();
    let mut end = unsigned.len();
    let mut letters = unsigned.char_indices().peekable();
    while let Some((at, letter)) = letters.next() {
        if letter.is_ascii_digit() {
            groups.last_mut()?.push(letter);
        } else if SIGNS.contains(&letter)
            && letters.peek().is_some_and(|(_, next)| next.is_ascii_digit())
        {
            signs.push(letter);
            groups.push(String::new());
        } else {
            end = at;
            break;
        }
    }
    let unit = &unsigned[end..];
    if unit.trim_start().starts_with(['/', '⁄', ':', ',', ';', '=']) {
        return None;
    }
    let (&first, &last) = (signs.first()?, signs.last()?);
    let has_decimals =
        last != first && [',', '.'].contains(&last) && !signs[..signs.len() - 1].contains(&last);
    let thousands = if has_decimals { signs.len() - 1 } else { signs.len() };
    let lead = &groups[0];
    let is_grouped = (1..=GROUP).contains(&lead.len())
        && !lead.starts_with('0')
        && groups[1..=thousands].iter().all(|group| group.len() == GROUP)
        && signs[..thousands].iter().all(|&sign| sign == first)
        && (signs.len() > 1 || first != '.');
    if !is_grouped {
        return None;
    }
    let mut joined = format!("{sign}{}", groups[..=thousands].concat());
    if has_decimals {
        joined = format!("{joined}.{}", groups.last()?);
    }
    let decimal = (signs == [',']).then(|| format!("{sign}{}.{}", groups[0], groups[1]));
    Some(Grouped { joined, decimal, unit })
}

/// Parts of a list: commas, semicolons, and spaces before a number that no fraction begins with.
fn parts(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    for part in text.split([',', ';']) {
        let part = part.trim();
        let mut start = 0;
        let mut gap = None;
        for (k, sign) in part.char_indices() {
            if sign.is_whitespace() {
                gap.get_or_insert(k);
                continue;
            }
            if let Some(gap) = gap.take()
                && "+-−.0123456789".contains(sign)
                && !is_within_fraction(&part[start..gap], &part[k..])
            {
                found.push(&part[start..gap]);
                start = k;
            }
        }
        found.push(&part[start..]);
    }
    found
}

/// Whether what follows a space belongs to the number before it: 3 7/16, 3 - 7/16.
fn is_within_fraction(before: &str, behind: &str) -> bool {
    let is_whole = |text: &str| {
        let digits = text.trim_start_matches(['+', '-', '−']);
        !digits.is_empty() && digits.bytes().all(|sign| sign.is_ascii_digit())
    };
    let dash = behind.trim_start_matches(['-', '−']).trim_start();
    let whole = before.trim_end_matches(['-', '−']).trim_end();
    let digits = dash.trim_start_matches(|sign: char| sign.is_ascii_digit());
    is_whole(whole) && digits.len() < dash.len() && digits.starts_with(['/', '⁄'])
        || behind.starts_with("1/min") // a unit
}

/// A decimal number and the word behind it.
fn decimal(text: &str) -> Option<Typed<'_>> {
    let unsigned = text.strip_prefix(['+', '-', '−']).unwrap_or(text);
    let is_negative = text.starts_with(['-', '−']);
    let count = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let whole = count(unsigned);
    let mut end = whole;
    if unsigned[whole..].starts_with('.') {
        end += 1 + count(&unsigned[whole + 1..]);
    }
    let digits = &unsigned[..end];
    if !digits.bytes().any(|sign| sign.is_ascii_digit()) {
        return None;
    }
    let mut exponent = "";
    if let Some(rest) = unsigned[end..].strip_prefix(['e', 'E']) {
        let signed = rest.strip_prefix(['+', '-']).unwrap_or(rest);
        let length = rest.len() - signed.len() + count(signed);
        if count(signed) > 0 {
            exponent = &rest[..length];
            end += 1 + length;
        }
    }
    let rest = unsigned[end..].trim_start();
    let is_per_minute = end < unsigned.len() && rest == "1/min";
    if rest.starts_with(|sign: char| sign.is_ascii_digit()) && !is_per_minute {
        return None;
    }
    let number = Exact::new(digits, exponent)?;
    let sign = if is_negative { "-" } else { "" };
    let text = format!("{sign}{}", unsigned[..end].trim());
    Some(Typed {
        number: if is_negative { number.negative() } else { number },
        word: rest,
        text,
        is_proper: true,
    })
}

/// A fraction, or a whole number and one, as rules in inches have them: 3 7/16in, 3-7/16", ½.
fn fraction(text: &str) -> Option<Typed<'_>> {
    let is_negative = text.starts_with(['-', '−']);
    let (first, behind) = digits_of(text.strip_prefix(['+', '-', '−']).unwrap_or(text));
    let vulgar = |text: &str| {
        let sign = text.chars().next()?;
        VULGAR
            .iter()
            .find(|(known, ..)| *known == sign)
            .map(|&(_, above, below)| (above, below, sign.len_utf8()))
    };
    let (whole, above, below, word): (i128, i128, i128, &str);
    let is_proper = behind.starts_with(['/', '⁄']);
    if let Some((over, under, length)) = vulgar(behind.trim_start()) {
        whole = if first.is_empty() { 0 } else { short(first)? };
        (above, below) = (over, under);
        word = &behind.trim_start()[length..];
    } else if let Some(denominator) = behind.strip_prefix(['/', '⁄']) {
        let (under, behind) = digits_of(denominator);
        (whole, above, below) = (0, short(first)?, short(under)?);
        word = behind;
    } else {
        let gap = behind.trim_start();
        let part = gap.strip_prefix(['-', '−']).map_or(gap, str::trim_start);
        if part.len() == behind.len() {
            return None;
        }
        let (over, slash) = digits_of(part);
        let (under, behind) = digits_of(slash.strip_prefix(['/', '⁄'])?);
        (whole, above, below) = (short(first)?, short(over)?, short(under)?);
        word = behind;
    }
    let word = word.trim_start();
    if below == 0 || word.starts_with(['/', '⁄', '.', ',']) {
        return None;
    }
    let number = whole.checked_mul(below)?.checked_add(above)?;
    let number = if is_negative { -number } else { number };
    Some(Typed {
        number: Exact { number, power: 0, below },
        word,
        text: format!("{number}/{below}"),
        is_proper,
    })
}

/// Digits that a text begins with, and what follows.
fn digits_of(text: &str) -> (&str, &str) {
    text.split_at(text.bytes().take_while(u8::is_ascii_digit).count())
}

/// A whole number of few enough digits for fractions.
fn short(digits: &str) -> Option<i128> {
    (1..=12).contains(&digits.len()).then(|| digits.parse().ok()).flatten()
}

/// Fractions with a sign of their own.
const VULGAR: [(char, i128, i128); 18] = [
    ('½', 1, 2),
    ('¼', 1, 4),
    ('¾', 3, 4),
    ('⅐', 1, 7),
    ('⅑', 1, 9),
    ('⅒', 1, 10),
    ('⅓', 1, 3),
    ('⅔', 2, 3),
    ('⅕', 1, 5),
    ('⅖', 2, 5),
    ('⅗', 3, 5),
    ('⅘', 4, 5),
    ('⅙', 1, 6),
    ('⅚', 5, 6),
    ('⅛', 1, 8),
    ('⅜', 3, 8),
    ('⅝', 5, 8),
    ('⅞', 7, 8),
];

/// The range that may be meant by 10-20, 10..20 or 10 to 20.
fn as_range(text: &str) -> Option<String> {
    let number = |text: &str| {
        let whole = digits_of(text).0.len();
        let point = text[whole..].strip_prefix('.').map_or(0, |rest| digits_of(rest).0.len());
        let length = if point > 0 { whole + 1 + point } else { whole };
        Some((text[..length].parse::<f64>().ok()?, length))
    };
    let (low, length) = number(text)?;
    let rest = text[length..].trim_start();
    let rest = ["-", "–", "..", "to"].iter().find_map(|sign| rest.strip_prefix(sign))?.trim_start();
    let (high, end) = number(rest)?;
    if !["", "°"].contains(&&rest[end..]) {
        return None;
    }
    let half = if high == low { 1.0 } else { (high - low).abs() / 2.0 };
    let step = 10.0_f64.powf(half.log10().floor());
    let shown = crate::numbers::figure::significant(step, 6);
    Some(format!("{}:{}:{shown}", &text[..length], &rest[..end]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn field<'a>(unit: &'a str, plain: &'a str) -> Field<'a> {
        Field { argument: "it", unit, plain, what: "a number", infinite: false }
    }

    fn values(text: &str, form: Form, unit: &str, plain: &str) -> Vec<f64> {
        field(unit, plain).read(text, form).unwrap_or_else(|error| panic!("{text}: {error}")).values
    }

    fn error(text: &str, form: Form, unit: &str, plain: &str) -> String {
        match field(unit, plain).read(text, form) {
            Err(error) => error.to_string(),
            Ok(read) => panic!("{text}: {:?}", read.values),
        }
    }

    #[test]
    fn one_number_is_read_as_it_is_typed() {
        for (text, unit, plain, value) in [
            ("86", "m", "mm", 0.086),
            ("3.5 in", "m", "", 0.0889),
            ("3 7/16in", "m", "", 3.4375 * 0.0254),
            ("3-7/16\"", "m", "", 3.4375 * 0.0254),
            ("½", "m", "", 0.5),
            ("−3½", "m", "", -3.5),
            ("12,5", "", "", 12.5),
            ("88,9mm", "m", "", 0.0889),
            ("0,125", "", "", 0.125),
            ("0,0045", "", "", 0.0045),
            ("1234,05", "rpm", "", 1234.05),
            ("3000 1/min", "rpm", "", 3000.0),
            ("50 %", "", "", 0.5),
            ("3", "count", "count", 3.0),
            ("1e-3", "", "", 1e-3),
            (".5kg", "kg", "g", 0.5),
            ("123456789012345678901234567890", "", "", 123_456_789_012_345_678_901_234_567_890.0),
        ] {
            assert_eq!(values(text, Form::Number, unit, plain), [value], "{text}");
        }
        assert_eq!(
            field("", "").read("12,5", Form::Number).unwrap().point.as_deref(),
            Some("12.5")
        );
    }

    /// Digits in groups of three may be thousands: an error says what to write, in both readings.
    #[test]
    fn a_comma_that_may_be_of_thousands_is_an_error_with_both_readings() {
        for (text, unit, hints) in [
            ("6,000", "rpm", "write 6000 or 6.000"),
            ("1,500", "rpm", "write 1500 or 1.500"),
            ("-1,500", "m", "write -1500 or -1.500"),
            ("1,000 g", "kg", "write 1000 g or 1.000 g"),
            ("12,345,678", "rpm", "write 12345678"),
            ("1,234.5", "rpm", "write 1234.5"),
            ("1.234,5", "rpm", "write 1234.5"),
            ("6 000", "rpm", "write 6000"),
            ("6'000", "rpm", "write 6000"),
            ("6_000", "rpm", "write 6000"),
            ("3000,5000", "rpm", "write 3000.5000, or 3000 or 5000"),
        ] {
            for form in [Form::Number, Form::Several] {
                if form == Form::Several && text == "3000,5000" {
                    continue; // two numbers
                }
                let said = error(text, form, unit, "");
                assert!(said.ends_with(hints), "{said}");
            }
        }
    }

    #[test]
    fn lists_are_read_by_commas_unless_these_may_be_of_thousands() {
        for (text, unit, plain, listed) in [
            ("0,120,240", "°", "", vec![0.0, 120.0, 240.0]),
            ("30,690", "°", "", vec![30.0, 690.0]),
            ("3000,5000", "rpm", "", vec![3000.0, 5000.0]),
            ("600, 800", "rpm", "", vec![600.0, 800.0]),
            ("1, 500", "rpm", "", vec![1.0, 500.0]),
            ("480,482", "kg", "g", vec![0.48, 0.482]),
            ("0 120 240°", "°", "", vec![0.0, 120.0, 240.0]),
            ("3 7/16 4 1/2in", "m", "", vec![3.4375 * 0.0254, 4.5 * 0.0254]),
            ("100, 200 mm", "m", "in", vec![0.1, 0.2]),
            ("0,100mm,200mm", "m", "", vec![0.0, 0.1, 0.2]),
            ("88,9mm", "m", "", vec![0.0889]),
            ("50%,52%", "", "", vec![0.5, 0.52]),
            ("5", "", "", vec![5.0]),
        ] {
            assert_eq!(values(text, Form::List, unit, plain), listed, "{text}");
        }
        for (text, unit, hint) in [
            ("6,000", "rpm", "write 6000 or 6.000"),
            ("1,500", "rpm", "write 1500 or 1.500, or two numbers as \"1, 500\""),
            ("1,000,2,000", "rpm", "write 1000 or 1.000"),
            ("1,050", "kg", "write 1050 or 1.050"),
            ("100,200mm", "m", "write 100.200mm, or the unit behind both: 100mm,200mm"),
            ("100mm,200,300mm", "m", "give the unit behind every number, or behind the last alone"),
            ("0.5,52%", "", "give the unit behind every number"),
        ] {
            let said = error(text, Form::List, unit, "");
            assert!(said.ends_with(hint), "{said}");
        }
    }

    #[test]
    fn ranges_have_the_numbers_that_would_be_typed() {
        for (text, unit, listed) in [
            ("0.2:0.4:0.1", "", vec![0.2, 0.3, 0.4]),
            ("10:0:-4", "", vec![10.0, 6.0, 2.0]),
            ("1:2:0.3", "", vec![1.0, 1.3, 1.6, 1.9]),
            ("100:300:100mm", "m", vec![0.1, 0.2, 0.3]),
            ("0:1:1/3", "", vec![0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]),
        ] {
            assert_eq!(values(text, Form::Range, unit, ""), listed, "{text}");
        }
        for (text, hint) in [
            ("1:2", "give START:STOP:STEP, a,b,c or one number"),
            ("1:2:-1", "the step does not lead from 1 to 2"),
            ("1,000:2,000:500", "write 1000 or 1.000"),
            ("0:1:1e-9", "1e+09 steps; give 1000000 at most"),
            ("10-20", "give a number, such as 10:20:1"),
        ] {
            let said = error(text, Form::Range, "rpm", "");
            assert!(said.ends_with(hint), "{said}");
        }
    }

    #[test]
    fn units_that_are_none_are_named() {
        for (text, unit, hint) in [
            ("12 kg", "m", "give a number, such as 12 or with a unit (mm, in)"),
            ("12 mn", "m", "(mm, in); did you mean mm?"),
            ("3000rmp", "rpm", "(rpm); did you mean rpm?"),
            ("12 g", "count", "give a number without a unit"),
            ("abc", "count", "give a number"),
            ("", "m", "(mm, in)"),
            ("nan", "", "give a finite number"),
            ("1e999", "m", "give a finite number"),
            ("inf", "m", "give a finite number"),
        ] {
            let said = error(text, Form::Number, unit, "");
            assert!(said.ends_with(hint), "{said}");
        }
    }
}
