//! Is memory of the length of an input asked for where its lack is an error?
//!
//! Vectors of a length that is not a constant are made by `memory`, which returns an error where the
//! system refuses, or their length is bounded, as listed here or said by `// bounded: …`.

use std::fs;
use std::path::Path;

/// Files, or folders, whose own vectors are bounded, and by what.
const BOUNDED: &[(&str, &str)] = &[
    ("numbers/memory.rs", "makes them"),
    ("numbers/rational.rs", "figures of one engine's loads"),
    ("numbers/ring", "periods that `checked_period` takes"),
    ("engine/", "1000 cylinders"),
    ("load", "1000 cylinders"),
    ("firing/", "1000 cylinders"),
    ("pressure/", "100 000 points of a cycle"),
    ("balancing/", "planes and shafts of one engine"),
    ("matching", "1000 cylinders of each set"),
    ("design", "free angles of one crank"),
    ("mounts/roll.rs", "modes of one powertrain"),
    ("mechanism/", "10 000 orders, and terms of a series that must converge"),
    ("readings/choice.rs", "10 000 orders"),
    ("readings/exact/", "loads of one engine, 10 000 orders"),
    ("readings/tolerances/", "128 samples of 4096 harmonics, one of 10 000 orders"),
    ("readings/measured_parts.rs", "1000 cylinders"),
    ("readings/sweep/block.rs", "32 rows of 10 000 orders"),
    ("readings/sweep/layout.rs", "10 000 orders"),
    ("search/", "512 ranges of keys, 360 parts of a turn"),
];

/// Lengths of vectors in a line of code: of `vec![x; n]` and of `with_capacity(n)`.
fn lengths(line: &str) -> Vec<&str> {
    let code = line.split("//").next().unwrap_or_default();
    let repeated = code.split("vec![").skip(1).filter_map(|rest| rest.split_once("; "));
    let repeated = repeated.map(|(_, length)| length.split(']').next().unwrap_or_default());
    let reserved = code.match_indices("with_capacity(");
    let reserved = reserved.filter(|(at, _)| !code[..*at].ends_with("memory::"));
    let reserved = reserved.map(|(at, name)| &code[at + name.len()..]);
    repeated.chain(reserved.map(|rest| rest.split(')').next().unwrap_or_default())).collect()
}

fn offending(folder: &Path, root: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            offending(&path, root, found);
            continue;
        }
        let name = path.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/");
        if name.ends_with("tests.rs") || BOUNDED.iter().any(|(file, _)| name.starts_with(file)) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        for (number, line) in code.lines().enumerate() {
            let constant = |length: &str| {
                length.chars().all(|c| c.is_ascii_digit() || c.is_ascii_uppercase() || c == '_')
            };
            if !line.contains("// bounded: ") && !lengths(line).into_iter().all(constant) {
                found.push(format!("{name}:{}: {}", number + 1, line.trim()));
            }
        }
    }
}

#[test]
fn vectors_of_the_length_of_an_input_are_made_by_memory() {
    assert_eq!(lengths("let a = vec![0.0; count]; // vec![0; other]"), ["count"]);
    assert_eq!(lengths("Vec::with_capacity(orders.len())"), ["orders.len("]);
    assert!(lengths("memory::with_capacity(orders.len())").is_empty());
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    offending(&root, &root, &mut found);
    assert!(found.is_empty(), "use crankpin_core::memory:\n{}", found.join("\n"));
    for (file, _) in BOUNDED {
        assert!(root.join(file).exists() || root.join(format!("{file}.rs")).exists(), "{file}");
    }
}
