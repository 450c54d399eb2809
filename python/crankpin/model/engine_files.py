"""Engine files: names, text and schema.

``engine.schema.json`` beside this file describes each entry; comments in written files and the
tables of the manual are generated from it.
"""

from __future__ import annotations

import functools
import json
import tomllib
from pathlib import Path
from typing import Any

from crankpin import _core
from crankpin._support import inputs

ENGINE_ENDINGS = (".toml", ".json")
MULTILINE = ('"""', "'''")
"""Quotes of texts of several lines, between which nothing may be added."""


def checked(path: object, name: str = "path") -> Path:
    """Return the path of an engine file, its ending checked."""
    return inputs.file_path(path, ENGINE_ENDINGS, "an engine file ends in .toml or .json", name)


def is_toml(file: Path) -> bool:
    """Return whether a file is TOML; else it is JSON."""
    return file.suffix.lower() == ".toml"


def read(file: Path) -> str:
    """Return the text of an engine file, or as much of it as the error of a longer one needs."""
    with file.open("rb") as opened:
        content = opened.read(_core.LONGEST_FILE + 1)
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise inputs.rejected("path", str(file), f"{error}; an engine file is UTF-8") from None


def check_keeps_mounts(file: Path) -> None:
    """Reject a file that has mounts, which an engine alone would replace."""
    if not file.is_file():
        return
    try:
        text = read(file)
        content = tomllib.loads(text) if is_toml(file) else json.loads(text)
    except ValueError:
        return
    if isinstance(content, dict) and "powertrain" in content:
        hint = "its [powertrain] would be lost: save a crankpin.Powertrain, or give another name"
        raise inputs.rejected("path", str(file), hint)


@functools.cache
def schema() -> dict[str, Any]:
    """Return the JSON schema of engine files."""
    text = Path(__file__).with_name("engine.schema.json").read_text(encoding="utf-8")
    values: dict[str, Any] = json.loads(text)
    return values


@functools.cache
def descriptions() -> dict[str, str]:
    """Return what each entry means by its place, such as "cylinder.bore" or "placements"."""
    texts: dict[str, str] = {}

    def collect(node: dict[str, Any], place: str) -> None:
        inner = schema()["$defs"][node["$ref"].rpartition("/")[2]] if "$ref" in node else node
        if "description" in node:
            texts[place] = node["description"]
        for name, entry in inner.get("properties", {}).items():
            collect(entry, f"{place}.{name}".strip("."))
        if "items" in inner:
            collect(inner["items"], place)

    collect({key: value for key, value in schema().items() if key != "description"}, "")
    return texts


def commented(text: str) -> str:
    """Return the TOML of an engine with a comment behind the first of each entry."""
    if any(quotes in text for quotes in MULTILINE):
        return text
    lines, about, table = list[str](), dict(descriptions()), ""
    for line in text.split("\n")[:-1]:
        if line.startswith("["):
            table = place = line.strip("[]")
        else:
            place = f"{table}.{line.partition(' = ')[0]}".strip(".")
        comment = about.pop(place, "")
        lines.append(f"{line}  # {comment}" if comment else line)
    return "\n".join(lines) + "\n"
