"""Write LICENSE-THIRD-PARTY: the licence texts of the crates that are linked into the wheels.

Reads the crates of Cargo.lock from Cargo's registry, of all platforms that wheels are built for.
`--check` writes nothing and fails if the file is out of date.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
OUTPUT = ROOT / "LICENSE-THIRD-PARTY"
PLATFORMS = (
    "x86_64-unknown-linux-gnu",
    "x86_64-unknown-linux-musl",
    "aarch64-unknown-linux-gnu",
    "aarch64-unknown-linux-musl",
    "x86_64-apple-darwin",
    "aarch64-apple-darwin",
    "x86_64-pc-windows-msvc",
)
# The only texts that a crate without a licence file may take: those of its own repository.
SISTERS = {"pulp-wasm-simd-flag": "pulp"}
HEAD = """\
The compiled module of crankpin's wheels contains the Rust standard library (MIT OR Apache-2.0,
Copyright (c) The Rust Project Contributors) and the crates below, under these licences. Where a
crate offers a choice that includes MIT, its MIT text is given.
"""
RULE = "=" * 100


def cargo(*arguments: str) -> str:
    """Return the output of a command of Cargo."""
    command = ["cargo", *arguments, "--locked"]
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout  # noqa: S603 - our own


def linked() -> list[tuple[str, str]]:
    """Return names and versions of the linked crates, without crankpin's own."""
    platforms = [part for platform in PLATFORMS for part in ("--target", platform)]
    lines = cargo(
        *("tree", "--package", "crankpin-py", "--edges", "normal,no-proc-macro"),
        *("--prefix", "none", "--format", "{p}", *platforms),
    )
    crates = {tuple(line.split()[:2]) for line in lines.splitlines() if line}
    found = sorted((name, version.removeprefix("v")) for name, version in crates)
    return [crate for crate in found if not crate[0].startswith("crankpin-")]


def text(folder: Path, licence: str) -> str:
    """Join the licence files in the folder of a crate: the MIT one alone where it is a choice."""
    files = sorted(
        file
        for file in folder.iterdir()
        if file.name.upper().startswith(("LICENSE", "LICENCE", "COPYING", "UNLICENSE"))
    )
    mit = [file for file in files if "MIT" in file.name.upper()]
    if "MIT" in licence and mit:
        files = mit
    texts = (file.read_text(encoding="utf-8") for file in files)
    return "\n\n".join("\n".join(map(str.rstrip, text.strip().splitlines())) for text in texts)


def document() -> str:
    """Compose the file, each text once, under the names of its crates."""
    packages = {
        (package["name"], package["version"]): package
        for package in json.loads(cargo("metadata", "--format-version", "1"))["packages"]
    }
    folders = {name: Path(p["manifest_path"]).parent for (name, _), p in packages.items()}
    owners: dict[str, list[str]] = {}
    for name, version in linked():
        package = packages[name, version]
        found = text(Path(package["manifest_path"]).parent, package["license"])
        found = found or text(folders[SISTERS[name]], package["license"])
        owners.setdefault(found, []).append(f"{name} {version} ({package['license']})")
    parts = ["\n".join([RULE, *crates, RULE, "", found, ""]) for found, crates in owners.items()]
    return "\n".join([HEAD, *parts])


def main() -> int:
    """Write the file, or compare it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="fail if the file is out of date")
    check = parser.parse_args().check
    wanted = document()
    if check:
        if not OUTPUT.is_file() or OUTPUT.read_text(encoding="utf-8") != wanted:
            print(f"{OUTPUT.name} is out of date: run packaging/licences.py", file=sys.stderr)
            return 1
        return 0
    OUTPUT.write_text(wanted, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
