//! Units that people type: symbols, products, and what they stand for in SI units.

use crate::numbers::decimal::Exact;

/// Kinds of units, by their places in a [`Dimension`].
pub const KINDS: usize = 4;
/// Exponents of mass, length, force, pressure, time and angle.
pub type Dimension = [i32; KINDS + 2];

/// A unit with a symbol of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UnitSymbol {
    /// What it is written as.
    pub name: &'static str,
    /// Place of its kind: 0 of mass, 1 of length, 2 of force, 3 of pressure.
    pub kind: usize,
    /// What it stands for in SI units.
    pub factor: Exact,
}

const fn symbol_of(
    name: &'static str,
    kind: usize,
    number: i128,
    power: i32,
    below: i128,
) -> UnitSymbol {
    UnitSymbol { name, kind, factor: Exact { number, power, below } }
}

/// Every symbol; of equal letters in another case the first is meant.
pub const SYMBOLS: [UnitSymbol; 24] = [
    symbol_of("kg", 0, 1, 0, 1),
    symbol_of("g", 0, 1, -3, 1),
    symbol_of("mg", 0, 1, -6, 1),
    symbol_of("lb", 0, 45_359_237, -8, 1),
    symbol_of("oz", 0, 28_349_523_125, -12, 1),
    symbol_of("m", 1, 1, 0, 1),
    symbol_of("cm", 1, 1, -2, 1),
    symbol_of("mm", 1, 1, -3, 1),
    symbol_of("µm", 1, 1, -6, 1),
    symbol_of("in", 1, 254, -4, 1),
    symbol_of("ft", 1, 3048, -4, 1),
    symbol_of("N", 2, 1, 0, 1),
    symbol_of("kN", 2, 1, 3, 1),
    symbol_of("MN", 2, 1, 6, 1),
    symbol_of("lbf", 2, 44_482_216_152_605, -13, 1),
    symbol_of("ozf", 2, 27_801_385_095_378_125, -17, 1),
    symbol_of("kgf", 2, 980_665, -5, 1),
    symbol_of("Pa", 3, 1, 0, 1),
    symbol_of("hPa", 3, 1, 2, 1),
    symbol_of("kPa", 3, 1, 3, 1),
    symbol_of("MPa", 3, 1, 6, 1),
    symbol_of("mbar", 3, 1, 2, 1),
    symbol_of("bar", 3, 1, 5, 1),
    symbol_of("psi", 3, 44_482_216_152_605, -5, 64_516),
];

/// What people write → the symbol.
pub const ALIASES: [(&str, &str); 36] = [
    ("gm", "g"),
    ("gms", "g"),
    ("gr", "g"),
    ("gram", "g"),
    ("grams", "g"),
    ("kgs", "kg"),
    ("kilo", "kg"),
    ("lbs", "lb"),
    ("lbm", "lb"),
    ("pound", "lb"),
    ("pounds", "lb"),
    ("ounce", "oz"),
    ("ounces", "oz"),
    ("ozs", "oz"),
    ("\"", "in"),
    ("”", "in"),
    ("″", "in"),
    ("''", "in"),
    ("inch", "in"),
    ("inches", "in"),
    ("'", "ft"),
    ("’", "ft"),
    ("′", "ft"),
    ("foot", "ft"),
    ("feet", "ft"),
    ("um", "µm"),
    ("μm", "µm"),
    ("lbsf", "lbf"),
    ("kp", "kgf"),
    ("newton", "N"),
    ("metre", "m"),
    ("metres", "m"),
    ("meter", "m"),
    ("meters", "m"),
    ("millimetre", "mm"),
    ("millimeter", "mm"),
];

/// Units that are no product of symbols: of angles, of speed, of frequencies, of ratios (empty) and of
/// counts. Those with capitals are read as they are written: MHz is not mHz.
const NAMED_UNITS: [(&str, &[(&str, Exact)]); 5] = [
    ("°", &[("°", Exact::ONE), ("deg", Exact::ONE), ("º", Exact::ONE), ("degrees", Exact::ONE)]),
    ("rpm", &[("rpm", Exact::ONE), ("/min", Exact::ONE), ("1/min", Exact::ONE)]),
    (
        "Hz",
        &[
            ("hz", Exact::ONE),
            ("khz", Exact { number: 1, power: 3, below: 1 }),
            ("MHz", Exact { number: 1, power: 6, below: 1 }),
        ],
    ),
    ("", &[("%", Exact { number: 1, power: -2, below: 1 })]),
    ("count", &[]),
];

/// Units that a hint names for one of the library's.
const HINTS: [(&str, &str); 10] = [
    ("kg", "g, lb, oz"),
    ("m", "mm, in"),
    ("kg·m", "g·mm, oz·in"),
    ("kg·m²", "kg·m², lb·ft²"),
    ("N", "kN, lbf"),
    ("N·m", "N·m, lbf·ft"),
    ("Pa", "bar, psi"),
    ("rpm", "rpm"),
    ("Hz", "kHz, MHz"),
    ("", "%"),
];

/// The symbol that a word stands for, whatever its case.
#[must_use]
pub fn symbol(word: &str) -> Option<&'static UnitSymbol> {
    let named = |name: &str| SYMBOLS.iter().find(|symbol| symbol.name == name);
    let alias = |word: &str| ALIASES.iter().find(|(alias, _)| *alias == word).map(|pair| pair.1);
    let lower = word.to_ascii_lowercase();
    named(word)
        .or_else(|| alias(word).or_else(|| alias(&lower)).and_then(named))
        .or_else(|| SYMBOLS.iter().find(|symbol| symbol.name.to_ascii_lowercase() == lower))
}

/// Symbols of a product or quotient with their exponents, "s" and "rad" among them; None if one is unknown.
#[must_use]
pub fn terms(unit: &str) -> Option<Vec<(&'static str, i32)>> {
    let mut found = Vec::new();
    for (k, quotient) in unit.split('/').enumerate() {
        for part in quotient.split(['·', '*']) {
            let (name, exponent) = power(part.trim());
            let known = match name {
                "s" => "s",
                "rad" => "rad",
                _ => symbol(name)?.name,
            };
            found.push((known, if k == 0 { exponent } else { -exponent }));
        }
    }
    Some(found)
}

/// A factor of a product without its exponent, and that.
fn power(part: &str) -> (&str, i32) {
    for (signs, exponent) in [(["^2", "2", "²"], 2), (["^3", "3", "³"], 3)] {
        for sign in signs {
            if let Some(name) = part.strip_suffix(sign) {
                return (name, exponent);
            }
        }
    }
    (part, 1)
}

/// Dimension of a unit, and what it stands for in SI units; None if it is unknown.
#[must_use]
pub fn factor(unit: &str) -> Option<(Dimension, Exact)> {
    let mut dimension = [0; KINDS + 2];
    let mut product = Exact::ONE;
    for (name, exponent) in terms(unit)? {
        let Some(symbol) = SYMBOLS.iter().find(|symbol| symbol.name == name) else {
            dimension[KINDS + usize::from(name == "rad")] += exponent;
            continue;
        };
        dimension[symbol.kind] += exponent;
        for _ in 0..exponent.unsigned_abs() {
            let factor = if exponent < 0 { symbol.factor.inverse()? } else { symbol.factor };
            product = product.times(factor)?;
        }
    }
    Some((dimension, product))
}

/// What a unit of a dimension stands for, its sign of multiplication left out or another: gmm, lb-ft.
#[must_use]
pub fn factor_of(unit: &str, dimension: Dimension) -> Option<Exact> {
    let of =
        |text: &str| factor(text).filter(|(own, _)| *own == dimension).map(|(_, factor)| factor);
    let signs = ["-", " ", "."].into_iter().filter(|sign| unit.contains(sign));
    let joined = || {
        unit.char_indices().skip(1).find_map(|(k, _)| {
            let (first, second) = unit.split_at(k);
            let is = |name: &str, is_length: bool| {
                SYMBOLS.iter().any(|symbol| symbol.name == name && (symbol.kind == 1) == is_length)
            };
            // A length comes last.
            (is(first, false) && is(power(second).0, true))
                .then(|| of(&format!("{first}·{second}")))
                .flatten()
        })
    };
    of(unit)
        .or_else(|| signs.map(|sign| unit.replace(sign, "·")).find_map(|text| of(&text)))
        .or_else(joined)
}

/// What a word behind a number stands for in a unit of the library, "°", "rpm", "" of ratios and "count"
/// among these; None if it is no unit of that kind.
#[must_use]
pub fn typed(word: &str, unit: &str) -> Option<Exact> {
    if let Some((_, words)) = NAMED_UNITS.iter().find(|(name, _)| *name == unit) {
        let lower = word.to_ascii_lowercase();
        let known = |name: &str| name == word || name == lower;
        return words.iter().find(|(name, _)| known(name)).map(|(_, factor)| *factor);
    }
    let (dimension, own) = factor(unit)?;
    factor_of(word, dimension)?.times(own.inverse()?)
}

/// Units that may be typed for one of the library, for a hint.
#[must_use]
pub fn hint(unit: &str) -> Option<&'static str> {
    HINTS.iter().find(|(name, _)| *name == unit).map(|(_, units)| *units)
}

/// The unit that was meant by a word that is none of its kind; None where nothing is near.
#[must_use]
pub fn meant(word: &str, unit: &str) -> Option<String> {
    if let Some((_, words)) = NAMED_UNITS.iter().find(|(name, _)| *name == unit) {
        let words = words.iter().map(|(name, _)| *name);
        return near(word, words).into_iter().next().map(str::to_owned);
    }
    let is_known = |part: &str| {
        let (name, _) = power(part.trim());
        SYMBOLS.iter().any(|symbol| symbol.name == name)
            || ALIASES.iter().any(|(alias, _)| *alias == name)
    };
    let parts = || word.split(['·', '*', '/']);
    if parts().all(is_known) {
        return None; // no slip: a unit of another kind
    }
    let names =
        || SYMBOLS.iter().map(|symbol| symbol.name).chain(ALIASES.iter().map(|(alias, _)| *alias));
    parts().filter(|part| !is_known(part)).find_map(|part| {
        let (name, _) = power(part.trim());
        let symbols = near(name, names()).into_iter().filter_map(symbol);
        let mut replaced = symbols.map(|other| word.replacen(name, other.name, 1));
        replaced.find(|other| typed(other, unit).is_some())
    })
}

/// Words within one slip of another, or two of a long one, the nearest first and of these those as long.
fn near<'a>(word: &str, words: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let typed: Vec<char> = word.to_ascii_lowercase().chars().take(MOST_LETTERS).collect();
    let most = match typed.len() {
        0 | 1 => 0,
        2..=4 => 1,
        _ => 2,
    };
    let ranked = |name: &&str| {
        let letters: Vec<char> = name.to_ascii_lowercase().chars().collect();
        (slips(&typed, &letters), letters.len() != typed.len())
    };
    let words: Vec<&str> = words.filter(|name| (1..=most).contains(&ranked(name).0)).collect();
    let of = |wanted| words.iter().copied().filter(move |name| ranked(name) == wanted);
    [(1, false), (1, true), (2, false), (2, true)].into_iter().flat_map(of).collect()
}

/// Letters of a word that are compared: every unit is shorter.
const MOST_LETTERS: usize = 24;

/// Letters to replace, insert, leave out or swap with the next, from one word to another.
fn slips(from: &[char], to: &[char]) -> usize {
    let mut rows = vec![vec![0; to.len() + 1]; from.len() + 1]; // bounded: by names of units
    for i in 0..=from.len() {
        for j in 0..=to.len() {
            rows[i][j] = if i == 0 || j == 0 {
                i + j
            } else {
                let replaced = rows[i - 1][j - 1] + usize::from(from[i - 1] != to[j - 1]);
                let is_swap =
                    i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1];
                let swapped = if is_swap { rows[i - 2][j - 2] + 1 } else { usize::MAX };
                replaced.min(swapped).min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1)
            };
        }
    }
    rows[from.len()][to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_a_kind_are_read_whatever_their_spelling() {
        for (word, unit, value) in [
            ("mm", "m", 1e-3),
            ("MM", "m", 1e-3),
            ("\"", "m", 0.0254),
            ("gmm", "kg·m", 1e-6),
            ("oz-in", "kg·m", 0.028_349_523_125 * 0.0254),
            ("kgm2", "kg·m²", 1.0),
            ("lb ft^2", "kg·m²", 0.453_592_37 * 0.3048 * 0.3048),
            ("psi", "Pa", 6_894.757_293_168_361),
            ("N/mm", "N/m", 1e3),
            ("Degrees", "°", 1.0),
            ("1/min", "rpm", 1.0),
            ("%", "", 0.01),
            ("Hz", "Hz", 1.0),
            ("kHz", "Hz", 1e3),
            ("KHZ", "Hz", 1e3),
            ("MHz", "Hz", 1e6),
        ] {
            let factor = typed(word, unit).unwrap().value();
            assert!((factor / value - 1.0).abs() < 1e-15, "{word}: {factor}");
        }
        for (word, unit) in [
            ("kg", "m"),
            ("m", "kg·m"),
            ("%", "rpm"),
            ("rpm", "°"),
            ("x", "count"),
            ("mHz", "Hz"),
            ("rpm", "Hz"),
        ] {
            assert_eq!(typed(word, unit), None, "{word}");
        }
    }

    #[test]
    fn slips_of_units_are_named() {
        for (word, unit, other) in [
            ("mn", "m", Some("mm")),
            ("rmp", "rpm", Some("rpm")),
            ("rpms", "rpm", Some("rpm")),
            ("kgg", "kg", Some("kg")),
            ("inchs", "m", Some("in")),
            ("g·mn", "kg·m", Some("g·mm")),
            ("deegrees", "°", Some("degrees")),
            ("baar", "Pa", Some("bar")),
            ("kg", "m", None),
            ("x", "m", None),
            ("constructor", "m", None),
        ] {
            assert_eq!(meant(word, unit).as_deref(), other, "{word}");
        }
    }
}
