"""Engine files: the paths and texts that the core reads and writes as TOML and JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs

if TYPE_CHECKING:
    from pathlib import Path


def from_toml(text: object) -> _core.Engine:
    """Return the engine that a TOML text describes."""
    return _checked(_core.Engine.from_toml(_text(text)))


def from_json(text: object) -> _core.Engine:
    """Return the engine that a JSON text describes."""
    return _checked(_core.Engine.from_json(_text(text)))


def load(path: object) -> _core.Engine:
    """Return the engine in a ``.toml`` or ``.json`` file."""
    file = _path(path)
    with file.open("rb") as opened:
        found = opened.read(_core.LONGEST_FILE + 1)  # of a longer one no more than its error needs
    try:
        text = found.decode("utf-8")
    except UnicodeDecodeError as error:
        hint = f"{error}; an engine file is UTF-8"
        raise InputError(f"path = {inputs.shorten(str(path))}: {hint}") from None
    return from_toml(text) if file.suffix.lower() == ".toml" else from_json(text)


def save(path: object, core: _core.Engine) -> None:
    """Write an engine to a ``.toml`` or ``.json`` file."""
    file = _path(path)
    text = core.to_toml() if file.suffix.lower() == ".toml" else core.to_json()
    file.write_text(text, encoding="utf-8")


def _checked(core: _core.Engine) -> _core.Engine:
    """Return the engine of a file, or reject a firing order that its crank does not allow."""
    if not core.firing_order:
        return core
    order = _core.Firing.named(core, core.firing_order, core.strokes)
    return core.firing_as(order.text, core.strokes)


def _text(text: object) -> str:
    return inputs.text("text", text, "give the text of an engine file")


def _path(path: object) -> Path:
    return inputs.file_path(path, (".toml", ".json"), "an engine file ends in .toml or .json")
