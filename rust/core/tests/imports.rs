//! The guide at the head of the crate lists its modules in the order in which they import each other.

use std::fs::{read_dir, read_to_string};
use std::path::{Path, PathBuf};

/// Files of a module, without those of tests.
fn files(path: &Path) -> Vec<PathBuf> {
    if path.is_file() {
        return vec![path.to_owned()];
    }
    let entries = read_dir(path).into_iter().flatten().map(|entry| entry.unwrap().path());
    let kept = entries.filter(|path| !path.ends_with("tests") && !path.ends_with("tests.rs"));
    kept.flat_map(|path| files(&path)).collect()
}

#[test]
fn modules_import_those_above_them_alone() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let guide = read_to_string(source.join("lib.rs")).unwrap();
    let named = guide.lines().filter_map(|line| line.strip_prefix("//! - ")?.split('`').nth(1));
    let modules: Vec<&str> = named.collect();
    let declared = guide
        .lines()
        .filter_map(|line| line.trim_start_matches("pub ").strip_prefix("mod ")?.strip_suffix(';'));
    assert_eq!(declared.filter(|module| !modules.contains(module)).count(), 0);
    // What the crate exports under shorter paths, by module.
    let exports: Vec<(&str, Vec<&str>)> = guide
        .split("pub use ")
        .skip(1)
        .filter_map(|export| export.split(';').next()?.split_once("::"))
        .map(|(module, names)| {
            (module, names.split(|c: char| !c.is_alphanumeric() && c != '_').collect())
        })
        .collect();
    let home = |name: &str| {
        let of_export = || exports.iter().find(|(_, names)| names.contains(&name));
        let module = modules.iter().find(|&&module| module == name).copied();
        module.or_else(|| of_export().map(|&(module, _)| module))
    };
    for (place, module) in modules.iter().enumerate() {
        let [file, folder] = [source.join(format!("{module}.rs")), source.join(module)];
        for path in files(&folder).into_iter().chain(file.is_file().then_some(file)) {
            let text = read_to_string(&path).unwrap();
            let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
            let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
            for import in lines.flat_map(|line| line.split("crate::").skip(1)) {
                let name = import.split(|c: char| !c.is_alphanumeric() && c != '_').next();
                let Some(imported) = name.and_then(home) else { continue };
                let allowed = modules[..=place].contains(&imported);
                assert!(allowed, "{} imports {imported}", path.display());
            }
        }
    }
}

/// Folders whose subject are parts that move and the pressure on them.
const HOMES: [&str; 5] = ["engine", "load", "mechanism", "pressure", "source"];

/// Files and folders besides that name gas, pistons, rods or [`Origin`]s, and why.
///
/// [`Origin`]: crankpin_core::engine::Origin
const NAMING: [(&str, &str); 15] = [
    ("checking.rs", "its engines have gas, and its load is an origin"),
    ("firing/", "a word of errors and a module: pistons fire, gas is exchanged"),
    ("lib.rs", "exports"),
    ("readings/bearing_loads/", "rods, pistons and walls are what carries"),
    ("readings/choice.rs", "an error names the rod ratio whose harmonics have no end"),
    ("readings/drawing.rs", "draws them"),
    ("readings/exact/", "proofs have symbols for motions, and the star is of pressure"),
    ("readings/explain/", "words, and what is compared with one piston"),
    ("readings/figures.rs", "what a page turns, by part of the engine"),
    ("readings/quantity.rs", "names of parts that are always there"),
    ("readings/page.rs", "what a page turns: terms, and motions of pistons"),
    ("readings/rows.rs", "polynomials in the rod ratio"),
    ("readings/sweep/", "an axis is the rod ratio"),
    ("readings/terms.rs", "terms are of each origin"),
    ("readings/tolerances/", "the rod length is a figure that deviates, pressure none"),
];

/// Whether a word of code is one of those, in `snake_case` or `CamelCase`.
fn names_a_kind(word: &str) -> bool {
    let mut parts = vec![String::new()];
    for letter in word.chars() {
        let is_upper = letter.is_uppercase() && !word.chars().all(|c| c.is_uppercase() || c == '_');
        if letter == '_' || is_upper {
            parts.push(String::new());
        }
        if letter != '_' {
            parts.last_mut().unwrap().extend(letter.to_lowercase());
        }
    }
    let kinds = ["gas", "piston", "pistons", "rod", "rods"];
    word == "Origin" || parts.iter().any(|part| kinds.contains(&&**part))
}

/// Expressions that ask of which kind a part, a source or its torque is.
const ASKING: [&str; 6] = [
    "Origin::",
    ".gas()",
    "GasPressure",
    "TorquePart::Gas",
    "TorqueKey::Masses",
    "TorqueKey::Swing",
];

/// Code of all files outside the homes, without tests and comments, by name.
fn outside_homes() -> impl Iterator<Item = (String, String)> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    files(&source).into_iter().filter_map(move |path| {
        let name = path.strip_prefix(&source).unwrap().to_str().unwrap().replace('\\', "/");
        if HOMES.iter().any(|home| name.starts_with(home)) {
            return None;
        }
        let text = read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap_or_default().lines();
        let code: Vec<&str> = code.filter(|line| !line.trim_start().starts_with("//")).collect();
        Some((name, code.join("\n")))
    })
}

#[test]
fn kinds_are_asked_where_they_live() {
    let asks = |code: &str| ASKING.iter().find(|asking| code.contains(**asking)).copied();
    let asking: Vec<_> =
        outside_homes().filter_map(|(name, code)| Some((name, asks(&code)?))).collect();
    assert!(asking.is_empty(), "{asking:?}: let the part or the source answer");
}

#[test]
fn kinds_of_loads_are_named_where_they_live() {
    let word = |c: char| !c.is_alphanumeric() && c != '_';
    let names = |code: &str| code.split(word).any(names_a_kind);
    let naming: Vec<String> =
        outside_homes().filter_map(|(name, code)| names(&code).then_some(name)).collect();
    let of = |name: &str| NAMING.iter().position(|(listed, _)| name.starts_with(listed));
    let others: Vec<&String> = naming.iter().filter(|name| of(name).is_none()).collect();
    assert!(others.is_empty(), "{others:?} name kinds of loads; ask the source, or say why");
    let (listed, _): (Vec<&str>, Vec<&str>) = NAMING.into_iter().unzip();
    let idle: Vec<_> = listed
        .iter()
        .filter(|listed| !naming.iter().any(|name| name.starts_with(**listed)))
        .collect();
    assert!(idle.is_empty(), "{idle:?} name none any more: take them off the list");
}
