"""Engines by name: ready-made layouts, and the source of each.

``presets.toml`` beside this file has them; an engine is built when it is looked up.
"""

from __future__ import annotations

import difflib
import functools
import math
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, tables
from crankpin._support.record import AbsentItemError
from crankpin.model.cycle import Cycle
from crankpin.model.cylinder import Cylinder
from crankpin.model.engine import Engine
from crankpin.model.links import LinkRods

if TYPE_CHECKING:
    from crankpin._core import InputError

MISTYPED = 0.9
"""Similarity (1 for equal names) above which a name counts as a misspelt preset."""
NUMBERS = {
    "two": "2", "three": "3", "four": "4", "five": "5", "six": "6", "seven": "7", "eight": "8",
    "nine": "9", "ten": "10", "twelve": "12",
}  # fmt: skip
"""Numbers of cylinders in words."""
OWN_PARTS = "-ebook"
"""End of the names of presets that belong to no family: their moving parts are not comparable."""
OWN_PARTS_TITLE = " (e-book)"
"""End of the titles of those presets, while they have these parts."""


class Presets(Mapping[str, Engine]):
    """The engines that :meth:`Engine.preset` knows, by name; each is built when it is taken.

    Made by :func:`crankpin.presets`.
    """

    __slots__ = ()

    def __getitem__(self, name: str) -> Engine:
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

    def __hash__(self) -> int:
        return hash(tuple(self))  # nothing in them changes

    __array_ufunc__ = None  # NumPy leaves comparison with arrays to the mapping

    def __repr__(self) -> str:
        return self.table(longest=60).text()

    def _repr_html_(self) -> str:
        return self.table(longest=1000).html()

    def table(self, column: str = "source", longest: int = 1000) -> tables.Table:
        """Return a table of all presets with one of their texts, cut."""
        column = inputs.one_of("column", column, ("source", "description"))
        length = inputs.whole("longest", longest, 1)
        rows = []
        for name, engine in self.items():
            text = labels.cut(_data()["engines"][name][column], length)
            angle = getattr(engine, "bank_angle_deg", None)
            banks = "–" if angle is None else f"{angle:.6g}"
            rows.append((name, len(engine), banks, engine.firing_order or "–", text))
        return tables.Table.from_rows(
            "Presets", ["name", "cylinders", ("bank angle", "°"), "firing order", column], rows
        )


def presets() -> Presets:
    """Return the engines that :meth:`Engine.preset` knows: a mapping from name to engine.

    Names that end in ``-ebook`` have the moving parts of the e-book (1 m crank radius, at 10 rpm),
    ``ijesc-v6-…`` those of the IJESC paper; all others have nominal ones of a half-litre cylinder.
    In a notebook the mapping is shown as a table.

    Returns
    -------
    mapping of str to Engine
        The engines by name, read-only.

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

    Another cylinder replaces what :class:`Cylinder` describes and no more: the crank is kept, and
    the rotating mass unless the cylinder has a rod, whose big end replaces it. A compressor has
    cycles of the cylinder's motion, and none without a bore. Where the layout offsets its bores
    (VR and W engines) each keeps its offset in metres, and the given pin offset is added to it.
    """
    if name not in Presets():
        if not isinstance(name, str):
            raise inputs.rejected("name", name, "give the name of a preset", AbsentItemError)
        raise unknown("name", name)
    if cylinder is not None and not isinstance(cylinder, Cylinder):
        raise inputs.rejected("cylinder", cylinder, "give a crankpin.Cylinder")
    base = layout(name)
    distance = base.spacing if spacing is None else inputs.number("spacing", spacing)
    if not math.isfinite(distance):
        raise inputs.rejected("spacing", distance, "give a finite distance in metres")
    return base.build(base.cylinder if cylinder is None else cylinder, distance)


class Layout(NamedTuple):
    """A builder of :class:`Engine` and its arguments, but for the cylinder and the spacing."""

    builder: str
    arguments: dict[str, Any]
    cylinder: Cylinder
    """Moving parts of the preset, a nominal half litre if its source has none."""
    spacing: float
    """Distance between neighbouring throws, m."""
    cycle: Mapping[str, Any]
    """Cycle of a compressor's two ends as in ``presets.toml``; empty of an engine."""

    def build(
        self,
        cylinder: Cylinder | list[Cylinder],
        spacing: Any,  # noqa: ANN401 - a float or several
        **changes: Any,  # noqa: ANN401
    ) -> Engine:
        """Return the engine with this cylinder and spacing, and other arguments of the builder."""
        arguments = dict(self.arguments)
        if cylinder != self.cylinder and "name" in arguments:
            arguments["name"] = arguments["name"].removesuffix(OWN_PARTS_TITLE)
        arguments |= changes
        one = cylinder if isinstance(cylinder, Cylinder) else cylinder[0]
        if one.rod is not None and "rotating_mass" not in changes:
            arguments.pop("rotating_mass", None)  # a rod brings its own
        if isinstance(upper := arguments.get("upper"), dict):
            arguments["upper"] = Cylinder(**upper) if cylinder == self.cylinder else cylinder
        if isinstance(rods := arguments.get("rods"), dict):
            arguments["rods"] = LinkRods(**rods)
        if "places" in arguments:  # in spacings, and a pin offset for each cylinder
            places = arguments.pop("places")
            offsets = arguments.pop("pin_offset", [0.0] * len(places))
            parts = [one] * len(places) if isinstance(cylinder, Cylinder) else cylinder
            if len(parts) != len(places):
                hint = f"give one, or {len(places)}"
                raise inputs.faulty("cylinder", f"has {len(parts)} entries", hint)
            if np.ndim(spacing):
                raise inputs.rejected("spacing", spacing, "give one number with this layout")
            cylinders = [
                part.replace(pin_offset=part.pin_offset + more)
                for part, more in zip(parts, offsets, strict=True)
            ]
            z = [_core.product(spacing, place) for place in places]
            return Engine.from_lists(cylinders, z=z, **arguments)
        if self.builder != "from_lists":
            arguments["spacing"] = spacing
        engine: Engine = getattr(Engine, self.builder)(cylinder, **arguments)
        return self._compressing(engine) if self.cycle else engine

    def _compressing(self, engine: Engine) -> Engine:
        """Return a compressor with its cycles, if its bores are known."""
        bores = [one.bore for one in engine.cylinders if one.bore is not None]
        if len(bores) < len(engine):
            return engine
        figures = dict(self.cycle)
        clearances, rod = figures.pop("clearance"), figures.pop("rod_diameter")

        def at(end: Literal["head", "crank"], clearance: float) -> list[Cycle]:
            return [
                Cycle.compressor(one, end=end, clearance=clearance, **figures)
                for one in engine.cylinders
            ]

        rods = [_core.product(rod, bore) for bore in bores]
        head, crank = at("head", clearances[0]), at("crank", clearances[1])
        return engine.with_cycle(head, crank_end=crank, rod_diameter=rods)


def layout(name: str = "single") -> Layout:
    """Return the layout of a preset."""
    entry = _data()["engines"][name]
    ((builder, arguments),) = (
        (key, value) for key, value in entry.items() if isinstance(value, dict) and key != "cycle"
    )
    common = {key: entry[key] for key in ("source", "firing_order", "strokes") if key in entry}
    parts = Cylinder(**{key: value for key, value in _parts(name).items() if key != "rpm"})
    arguments = {"name": entry["title"]} | common | arguments
    return Layout(builder, arguments, parts, entry.get("spacing", 0.1), entry.get("cycle", {}))


def usual_speed(name: str, rpm: float) -> float:
    """Return the speed of a preset that turns slowly, or else the one given, rpm."""
    return float(_parts(name).get("rpm", rpm))


def _parts(name: str) -> dict[str, Any]:
    """Return the moving parts of a preset, and its usual speed if it has one."""
    parts: dict[str, Any] = _data()["parts"][_data()["engines"][name].get("parts", "nominal")]
    return parts


def aliases() -> Mapping[str, str]:
    """Return usual names, such as "v6", and the presets that stand for them."""
    return MappingProxyType(_data()["aliases"])


def named(name: str) -> str:
    """Return the preset that a usual name stands for; other names as they are.

    Examples
    --------
    >>> named("v6"), named("Straight-six"), named("flat-twin")
    ('v6-60', 'i6', 'boxer-2')
    """
    if name.lower() in Presets():
        return name.lower()
    words = [NUMBERS.get(word, word) for word in name.lower().split("-")]
    plain = re.sub(r"^(straight|inline)-(?=\d)", "i", "-".join(words))
    return aliases().get(plain, plain)


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
    members = [preset for preset in Presets() if preset.startswith(f"{name}-")]
    return [preset for preset in members if not preset.endswith(OWN_PARTS)] or [name]


def unknown(argument: str, name: str, *, typed: bool = False, further: str = "") -> InputError:
    """Return the error of a name that is no preset's: the nearest ones, and what builds it.

    Parameters
    ----------
    argument
        What the name was given as.
    name
        What was given.
    typed
        True for words of the command line, False for those of Python.
    own
        What makes engines of one's own, where nothing is near; by default commands or functions.
    """
    plain = re.sub(r"[\s_]+", "-", name[:80].strip().lower())
    plain = plain if family(plain) != [plain] else named(plain)
    titles = {engine.name.lower(): preset for preset, engine in Presets().items()}
    words = {preset: preset for preset in Presets()} | titles | dict(aliases())
    meant = family(plain)
    if meant == [plain] and plain not in Presets():
        meant = [words[match] for match in difflib.get_close_matches(plain, words, 1, MISTYPED)]
    built, near = "", meant
    if not meant:
        near = [preset for preset in family(plain.rpartition("-")[0]) if preset in Presets()]
        near = near or [words[match] for match in difflib.get_close_matches(plain, words, 3, 0.7)]
        is_file = re.search(r"\.[a-z]+$", plain)  # with another ending than those of engine files
        built = "" if is_file else _recipe(plain, typed=typed)
    if not (near or built):
        more = "crankpin new makes" if typed else "Engine.inline, vee and the like make"
        built = f"{further or f'{more} engines of your own'}; "
    quoted = " or ".join(f'"{preset}"' for preset in dict.fromkeys(near))
    question = f"did you mean {quoted}? " if near else ""
    listing = (
        '"crankpin presets" lists all; engine files end in .toml or .json'
        if typed
        else "crankpin.presets() lists all"
    )
    title = labels.cut(labels.one_line(name), 80)
    hint = f"no such preset; {question}{built}{listing}"
    return inputs.faulty(argument, f'= "{title}"', hint, AbsentItemError)


RECIPES = (
    (r"square", "new square-four --distance …", "square_four(…)"),
    (r"opposed", "new opposed-pistons --throws … --distance …", "opposed_pistons(…)"),
    (r"u[- ]?\d", "new u --throws … --distance …", "u(…, throws_deg=[…])"),
    (r"h[- ]?\d", "new h --throws … --distance …", "h(…, throws_deg=[…])"),
    (
        r"v[- ]?\d*[13579](?!\d)",
        "new vee --bank-angle {0} --throws … --absent …",
        "vee(…, bank_angle_deg={0}, absent=[…])",
    ),
    (r"v[- ]?(?:twin|\d+)", "new vee --bank-angle {0} --throws …", "vee(…, bank_angle_deg={0}, …)"),
    (r"i\d|twin|parallel", "new inline --throws …", "inline(…, throws_deg=[…])"),
    (r"flat", "new flat --throws …", "flat(…, throws_deg=[…])"),
    (r"boxer", "new boxer --throws …", "boxer(…, throws_deg=[…])"),
    (r"radial", "new radial --cylinders {0}", "radial(…, {0})"),
    (r"(vr|w|x)[- ]?\d", "new lists --tdc … --banks … --z …", "from_lists(…)"),
)
"""Beginnings of names of layouts, and their builders."""


def _recipe(name: str, *, typed: bool) -> str:
    """Return which command or call builds an engine of such a name."""
    number = re.findall(r"(?<=-)\d+(?:\.\d+)?$", name) or ["…"]
    for pattern, command, call in RECIPES:
        if not re.match(pattern, name):
            continue
        base = name.rpartition("-")[0]
        if typed and command.startswith("new vee") and base in aliases():
            return f"build it by crankpin new {base} --bank-angle {number[0]}; "
        recipe = f"crankpin {command}" if typed else f"Engine.{call}"
        return f"build it by {recipe.format(*number)}; "
    return ""


@functools.cache
def _data() -> dict[str, dict[str, Any]]:
    """Return the contents of ``presets.toml``, read once: that takes 8 ms."""
    return tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
