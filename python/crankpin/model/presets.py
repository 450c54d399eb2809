"""Engines by name: ready-made layouts, and the source of each.

``presets.toml`` beside this file has them; an engine is built when it is asked for.
"""

from __future__ import annotations

import difflib
import functools
import math
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, labels, tables
from crankpin._support.absent import AbsentError
from crankpin.model.cylinder import Cylinder
from crankpin.model.engine import Engine

OWN_PARTS = "-ebook"
"""End of the names of presets that belong to no family: their moving parts are not comparable."""


class Presets(Mapping[str, Engine]):
    """The engines that :meth:`Engine.preset` knows, by name; each is built when it is taken.

    Made by :func:`crankpin.presets`.
    """

    def __getitem__(self, name: str) -> Engine:
        if name not in self:
            raise UnknownPresetError(_unknown(name))
        return preset(name)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name in _data()["engines"]

    def __iter__(self) -> Iterator[str]:
        return iter(_data()["engines"])

    def __len__(self) -> int:
        return len(_data()["engines"])

    @property
    def descriptions(self) -> Mapping[str, str]:
        """Description of each preset in a line, by name."""
        return MappingProxyType(
            {name: entry["description"] for name, entry in _data()["engines"].items()}
        )

    def __repr__(self) -> str:
        return self.table(longest=60).text()

    def _repr_html_(self) -> str:
        return self.table(longest=1000).html()

    def table(self, column: str = "source", longest: int = 1000) -> tables.Table:
        """Return a table of all presets with one of their texts, cut."""
        header = ["name", "cylinders", "bank angle °", "firing order", column]
        rows = []
        for name, engine in self.items():
            text = labels.cut(_data()["engines"][name][column], longest)
            order = labels.cut(engine.firing_order or "–", max(longest, 25))
            rows.append((name, len(engine), _bank_angle(engine), order, text))
        return tables.Table.from_rows("Presets", header, rows, np.empty((len(rows), 0)))


class UnknownPresetError(InputError, KeyError):
    """There is no preset of a name; an InputError and, as mappings raise it, a KeyError."""

    __str__ = InputError.__str__


def presets() -> Presets:
    """Return the engines that :meth:`Engine.preset` knows: a mapping from name to engine.

    Names that end in ``-ebook`` have the moving parts of the e-book (1 m crank radius, at 10 rpm),
    ``ijesc-v6-…`` those of the IJESC paper; all others have nominal ones of a half-litre cylinder.
    In a notebook the mapping is shown as a table.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.presets()["i4"].firing()
    <Firing 4-stroke 1-3-4-2, even, 180°>
    >>> cp.presets().descriptions["i4"]
    'throws 0-180-180-0, even firing 1-3-4-2'
    """
    return Presets()


def preset(name: str, *, cylinder: Cylinder | None = None, spacing: float | None = None) -> Engine:
    """Return the engine of this name; see :meth:`Engine.preset`.

    Another cylinder replaces what :class:`Cylinder` describes and no more: the crank and the
    rotating mass are kept. Where the layout offsets its bores (VR and W engines) each keeps its
    offset in metres, and the given pin offset is added to it.
    """
    if not isinstance(name, str):
        raise InputError(f"name = {inputs.shorten(name)}: give the name of a preset, as a string")
    if name not in Presets():
        raise UnknownPresetError(_unknown(name))
    if cylinder is not None and not isinstance(cylinder, Cylinder):
        raise InputError(f"cylinder = {inputs.shorten(cylinder)}: give a crankpin.Cylinder")
    entry = _data()["engines"][name]
    parts = Cylinder(**_data()["parts"][entry.get("parts", "nominal")])
    distance = entry.get("spacing", 0.1) if spacing is None else inputs.number("spacing", spacing)
    if not math.isfinite(distance):
        raise InputError(f"spacing = {distance}: give a finite distance in metres")
    ((builder, arguments),) = (item for item in entry.items() if isinstance(item[1], dict))
    common: dict[str, Any] = {"name": entry["title"], "source": entry["source"]}
    common |= {key: entry[key] for key in ("firing_order", "strokes") if key in entry}
    if builder == "from_lists":
        return _from_lists(parts if cylinder is None else cylinder, distance, arguments, common)
    build = getattr(Engine, builder)
    engine: Engine = build(
        parts if cylinder is None else cylinder, spacing=distance, **arguments, **common
    )
    return engine


def _from_lists(
    cylinder: Cylinder, spacing: float, arguments: dict[str, Any], common: dict[str, Any]
) -> Engine:
    """Return an engine of lists, with places in spacings and a pin offset for each cylinder."""
    places = arguments["places"]
    offsets = arguments.get("pin_offset", [0.0] * len(places))
    return Engine.from_lists(
        [cylinder.replace(pin_offset=cylinder.pin_offset + offset) for offset in offsets],
        tdc_deg=arguments["tdc_deg"],
        bank_deg=arguments["bank_deg"],
        z=[spacing * place for place in places],
        **common,
    )


def family(name: str) -> list[str]:
    """Return [name] if it is a preset, or all presets whose names continue it after a hyphen.

    Presets of the e-book are of no family. A name that is neither comes back alone, for
    :func:`preset` to reject.

    Examples
    --------
    >>> family("ijesc-v6")[0]
    'ijesc-v6-1-3-5-2-4-6'
    >>> family("v8-60")
    ['v8-60']
    """
    if name in Presets():
        return [name]
    members = [each for each in Presets() if each.startswith(f"{name}-")]
    return [each for each in members if not each.endswith(OWN_PARTS)] or [name]


def suggestion(name: str) -> str:
    """Return what to say of a name that is no preset's, with what may have been meant."""
    typed = name[:80].lower().replace("straight", "inline")
    near = family(typed)
    if near == [typed] and typed not in Presets():
        titles = {engine.name.lower(): each for each, engine in Presets().items()}
        words = {each: each for each in Presets()} | titles
        near = [words[each] for each in difflib.get_close_matches(typed, words, n=1, cutoff=0.7)]
    quoted = " or ".join(f'"{each}"' for each in near)
    meant = f"did you mean {quoted}? " if near else ""
    return f'"{labels.cut(labels.printable(name), 80)}": no such preset; {meant}'


def _unknown(name: object) -> str:
    """Return the message for what is not the name of a preset."""
    if not isinstance(name, str):
        return f"name = {inputs.shorten(name)}: give the name of a preset, as a string"
    return f"name = {suggestion(name)}crankpin.presets() lists all"


def _bank_angle(engine: Engine) -> str:
    try:
        return f"{engine.bank_angle_deg:.6g}"
    except AbsentError:
        return "–"


@functools.cache
def _data() -> dict[str, dict[str, dict[str, Any]]]:
    """Return the contents of ``presets.toml``, read once: that takes 8 ms."""
    return tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
