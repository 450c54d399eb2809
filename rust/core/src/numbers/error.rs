//! Errors of inputs: the argument, its value, and a hint.

use std::borrow::Cow;

use thiserror::Error;

/// The result of anything that takes a caller's figures.
pub type Result<T> = std::result::Result<T, Error>;

/// A figure that no engine has, or almost none: what is computed of it is right, and hardly what was meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Name of the figure, by its place in a file: `powertrain.mounts[2].at`.
    pub argument: String,
    /// What the sentence begins with: `at of mount 'rear'`.
    pub about: String,
    /// What it is: `= (0, 200, 0) m`.
    pub fault: String,
    /// The likely mistake, the same of all figures.
    pub hint: &'static str,
}

impl Warning {
    pub(crate) fn new(argument: &str, fault: String, hint: &'static str) -> Self {
        Self { argument: argument.to_owned(), about: argument.to_owned(), fault, hint }
    }

    /// The same under another beginning of its sentence.
    pub(crate) fn about(self, about: String) -> Self {
        Self { about, ..self }
    }

    /// The sentence.
    #[must_use]
    pub fn text(&self) -> String {
        format!("{} {}: {}", self.about, self.fault, self.hint)
    }
}

/// An input that makes no engine, or a request that cannot be met.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// A figure that is not finite, of the wrong sign, or out of range.
    #[error("{argument} = {value}: {hint}")]
    Value {
        /// Name of the argument as the caller typed it.
        argument: String,
        /// The value given.
        value: String,
        /// What would be right.
        hint: String,
    },
    /// An argument of which something other than its value is wrong.
    #[error("{argument} {fault}: {hint}")]
    Fault {
        /// Name of the argument as the caller typed it.
        argument: String,
        /// What it is or has: "has 3 points".
        fault: String,
        /// What would be right.
        hint: &'static str,
    },
    /// A quantity that this engine does not have.
    #[error("{argument} is undefined for this engine: {reason}")]
    Undefined {
        /// The quantity as the caller typed it.
        argument: &'static str,
        /// What is missing.
        reason: String,
    },
    /// Torque that was not computed.
    #[error("torque is not available: {0}")]
    NoTorque(&'static str),
    /// Lists that should be equally long.
    #[error("{argument} has {found} entries, {reference} has {expected}: give one for each {item}")]
    Length {
        /// The list of the wrong length.
        argument: String,
        /// How many entries it has.
        found: usize,
        /// The list that sets the length.
        reference: String,
        /// How many it should have.
        expected: usize,
        /// What the lists run over.
        item: &'static str,
    },
    /// A result that would not fit in memory.
    #[error(
        "{argument}: the result would take {bytes} bytes, more than the limit of {limit}; {hint}"
    )]
    TooLarge {
        /// What made it large.
        argument: String,
        /// Size of the result in bytes (saturating).
        bytes: u128,
        /// Largest size allowed.
        limit: u128,
        /// How to ask for it in parts.
        hint: &'static str,
    },
    /// Memory that the system does not give.
    #[error("out of memory: {bytes} bytes more are needed; ask for the result in parts")]
    OutOfMemory {
        /// Size of the allocation that failed.
        bytes: usize,
    },
    /// An engine file that cannot be read.
    #[error("engine file ({format}): {reason}")]
    File {
        /// `TOML` or `JSON`.
        format: &'static str,
        /// What the parser met, and where.
        reason: String,
    },
    /// The caller asked to stop.
    #[error("stopped on request")]
    Cancelled,
}

impl Error {
    /// A value that cannot be used, with the hint.
    pub fn value(
        argument: impl Into<String>,
        value: impl std::fmt::Display,
        hint: impl Into<String>,
    ) -> Self {
        Self::Value {
            argument: argument.into(),
            value: shorten(&value.to_string()),
            hint: hint.into(),
        }
    }

    /// What is wrong with an argument, "has 3 points", with the hint.
    #[must_use]
    pub fn fault(argument: &str, fault: String, hint: &'static str) -> Self {
        Self::Fault { argument: argument.to_owned(), fault, hint }
    }

    /// A figure that cannot be used, with the hint; very large and small ones as powers of ten.
    pub fn figure(argument: impl Into<String>, value: f64, hint: impl Into<String>) -> Self {
        Self::value(argument, format!("{value:?}"), hint)
    }

    /// The same error under the name by which the caller knows the argument.
    #[must_use]
    pub fn named(self, argument: &str) -> Self {
        self.renamed(|_| argument.to_owned())
    }

    /// The same error about an argument that is part of a larger one (`cylinders[3].z`).
    #[must_use]
    pub fn within(self, place: &str) -> Self {
        self.renamed(|argument| format!("{place}{argument}"))
    }

    /// Name of the argument, the value rejected where the message shows it, and the hint.
    #[must_use]
    pub fn fields(&self) -> Option<(&str, Option<&str>, Cow<'_, str>)> {
        let (argument, value, hint) = match self {
            Self::Value { argument, value, hint } => (argument.as_str(), Some(&**value), &**hint),
            Self::Undefined { argument, reason } => (*argument, None, &**reason),
            Self::NoTorque(reason) => ("torque", None, *reason),
            Self::Length { argument, item, .. } => {
                return Some((argument, None, format!("give one for each {item}").into()));
            }
            Self::Fault { argument, hint, .. } | Self::TooLarge { argument, hint, .. } => {
                (argument.as_str(), None, *hint)
            }
            Self::File { reason, .. } => ("engine file", None, &**reason),
            Self::OutOfMemory { .. } | Self::Cancelled => return None,
        };
        Some((argument, value, hint.into()))
    }

    fn renamed(self, name: impl FnOnce(&str) -> String) -> Self {
        match self {
            Self::Value { argument, value, hint } => {
                Self::Value { argument: name(&argument), value, hint }
            }
            other => other,
        }
    }
}

/// Long values (a whole file, a huge list) are cut, so that the message stays readable, and control
/// and invisible characters, which a terminal would obey, are escaped.
pub(crate) fn shorten(text: &str) -> String {
    const LONGEST: usize = 160;
    let rest = if text.chars().nth(LONGEST).is_some() { "…" } else { "" };
    let mut short = String::new();
    for character in text.chars().take(LONGEST).chain(rest.chars()) {
        // As strings are shown while debugging, but for quotes.
        match character {
            '"' | '\'' | '\\' => short.push(character),
            _ => short.extend(character.escape_debug()),
        }
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_begin_with_the_argument_and_end_with_the_hint() {
        let name = || "z".to_owned();
        let errors = [
            Error::figure("z", -1.0, "give 0 or more").within("placements[0]."),
            Error::fault("z", "has 3 points".into(), "give more"),
            Error::Undefined { argument: "z", reason: "it has none".into() },
            Error::NoTorque("leave it out"),
            Error::Length {
                argument: name(),
                found: 1,
                reference: name(),
                expected: 2,
                item: "cylinder",
            },
            Error::TooLarge { argument: name(), bytes: 9, limit: 8, hint: "give fewer" },
            Error::File { format: "TOML", reason: "line 1".into() },
        ];
        for error in errors {
            let (argument, value, hint) = error.fields().unwrap();
            let message = error.to_string();
            assert!(message.starts_with(argument) && message.ends_with(&*hint), "{message}");
            assert!(message.contains(value.unwrap_or("")));
        }
        assert_eq!(Error::Cancelled.fields(), None);
    }

    #[test]
    fn shown_values_are_short_and_have_no_control_characters() {
        assert_eq!(shorten("1–2 é"), "1–2 é");
        assert_eq!(shorten("\u{1b}[2J\u{9b}\u{2028}"), "\\u{1b}[2J\\u{9b}\\u{2028}");
        assert_eq!(shorten(&"é".repeat(160)), "é".repeat(160));
        assert_eq!(shorten(&"é".repeat(161)), "é".repeat(160) + "…");
    }
}
