"""Engine files: TOML and JSON texts with a schema version.

The core reads and writes everything but the firing order, whose two keys are added and taken out
here.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs

Known: TypeAlias = tuple[str, int]
"""Firing order, empty if it is not known, and strokes."""

_MARK = "\ufeff"
"""Byte order mark, which some editors put before a text."""
_KEYS = re.compile(
    r"""^(firing_order|strokes)[ \t]*=[ \t]*("[^"\\\n]*"|'[^'\n]*'|\d+)[ \t]*(#[^\n]*)?$""", re.M
)


def from_toml(text: object) -> tuple[_core.Engine, Known]:
    """Return what a TOML text describes."""
    given = inputs.text("text", text, "give the text of an engine file").removeprefix(_MARK)
    if _KEYS.search(given) is None:
        return _core.Engine.from_toml(given), ("", 4)
    try:
        document = tomllib.loads(given)
    except (tomllib.TOMLDecodeError, RecursionError):
        return _core.Engine.from_toml(given), ("", 4)  # which raises, and says where
    for key in document.keys() & {"firing_order", "strokes"}:
        given = _without(given, key)
    return _core.Engine.from_toml(given), _known(document)


def from_json(text: object) -> tuple[_core.Engine, Known]:
    """Return what a JSON text describes."""
    given = inputs.text("text", text, "give the text of an engine file").removeprefix(_MARK)
    if '"firing_order"' not in given and '"strokes"' not in given:
        return _core.Engine.from_json(given), ("", 4)
    try:
        document = json.loads(given)
    except (ValueError, RecursionError):
        document = None
    if not isinstance(document, dict):
        return _core.Engine.from_json(given), ("", 4)  # which raises, and says where
    known = _known(document)
    return _core.Engine.from_json(json.dumps(document)), known


def to_toml(core: _core.Engine, known: Known) -> str:
    """Return an engine as TOML."""
    return _with_keys(core.to_toml(), "\n", known, "{} = {}\n")


def to_json(core: _core.Engine, known: Known) -> str:
    """Return an engine as JSON."""
    return _with_keys(core.to_json(), ",\n", known, '  "{}": {},\n')


def load(path: object) -> tuple[_core.Engine, Known]:
    """Return what a ``.toml`` or ``.json`` file describes."""
    file = _path(path)
    read = {".toml": from_toml, ".json": from_json}[file.suffix.lower()]
    try:
        return read(file.read_text(encoding="utf-8"))
    except UnicodeDecodeError as error:
        cure = f"{error}; an engine file is UTF-8"
        raise InputError(f"path = {inputs.shorten(str(path))}: {cure}") from None


def save(path: object, core: _core.Engine, known: Known) -> None:
    """Write an engine to a ``.toml`` or ``.json`` file."""
    file = _path(path)
    write: Callable[[_core.Engine, Known], str] = {".toml": to_toml, ".json": to_json}[
        file.suffix.lower()
    ]
    file.write_text(write(core, known), encoding="utf-8")


def _path(path: object) -> Path:
    cure = "an engine file ends in .toml or .json"
    try:
        file = Path(path)  # type: ignore[arg-type]
    except TypeError:
        raise InputError(f"path = {inputs.shorten(path)}: give a path; {cure}") from None
    if file.suffix.lower() not in (".toml", ".json"):
        raise InputError(f"path = {inputs.shorten(str(path))}: {cure}")
    return file


def _known(document: dict[str, Any]) -> Known:
    """Return firing order and strokes, and take them out of the document."""
    order, strokes = document.pop("firing_order", ""), document.pop("strokes", 4)
    cure = 'give text, such as "1-3-4-2"'
    return inputs.text("firing_order", order, cure), inputs.strokes(strokes)


def _without(text: str, key: str) -> str:
    """Return a TOML text with the line of a key blank."""
    others = tomllib.loads(text).keys() - {key}
    for line in _KEYS.finditer(text):
        # A line within a text of several lines may look the same.
        blank = text[: line.start()] + text[line.end() :]
        if line[1] == key and tomllib.loads(blank).keys() == others:
            return blank
    raise InputError(f'{key}: give it a line of its own, such as firing_order = "1-3-4-2"')


def _with_keys(text: str, end: str, known: Known, line: str) -> str:
    """Return an engine file with the firing order, if it is known, after the schema's line."""
    order, strokes = known
    if not order:
        return text
    schema, _, rest = text.partition(end)
    keys = {"firing_order": f'"{order}"'} | ({"strokes": "2"} if strokes == 2 else {})
    return schema + end + "".join(line.format(*item) for item in keys.items()) + rest
