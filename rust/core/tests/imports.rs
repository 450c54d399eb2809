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
