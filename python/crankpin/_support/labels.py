"""Names and units of swept dimensions, and texts that tables and pictures share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, Self

import numpy as np

from crankpin import _core
from crankpin._support import units
from crankpin._support.messages import without_controls

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from crankpin._support.inputs import Order

UNIT_RPM = 1.0 / _core.angular_speed(1.0)
"""Crank speed at which ω is 1 rad/s."""

TURNING_WORDS = {"forward": "with the crank", "backward": "against the crank"}
"""Part of a plane vector → how it turns."""

XARRAY_UNITS = {
    "bank_angle_deg": "degree",
    "rod_ratio": "1",
    "pin_offset": "m",
    "rpm": "1/min",
    "theta_deg": "degree",
    "order": "1/rev",
}
"""Dimension → unit as xarray's users write it."""

SWEPT = {
    "bank_angle_deg": ("bank angle", "°"),
    "rod_ratio": ("rod ratio", ""),
    "pin_offset": ("pin offset", " m"),
    "rpm": ("", " rpm"),
    "load": ("load", ""),
}
"""Swept dimension → its name, and the text that follows its value."""

HELD = {
    "pins": "pins held as the bank angle changes",
    "firing": "top dead centres held as the bank angle changes",
}
"""Value of ``hold`` → description."""

TOLERANCES = {
    "reciprocating_mass": ("reciprocating mass", "kg"),
    "rotating_mass": ("rotating mass", "kg"),
    "crank_radius": ("crank radius", "m"),
    "pin_deg": ("crankpin angle", "°"),
    "z": ("position", "m"),
    "rod_length": ("rod length", "m"),
}
"""Figure that may spread → its name and unit."""


NEGLIGIBLE = 1e-6
"""Orders whose peaks are all below this part of a quantity's largest peak are not shown."""
MATTERS = 1e-3
"""The same of pictures, and of tables that would be longer than a screen."""
MOST_LISTED = 8
"""Most orders that are all listed in a note of those that are not shown."""


def coordinates(coords: Mapping[str, Any]) -> dict[str, Any]:
    """Return coordinates with their units, in the form that xarray takes."""
    units = {name: {"units": XARRAY_UNITS[name]} for name in coords if name in XARRAY_UNITS}
    return {
        name: (name, np.asarray(values), units.get(name, {})) for name, values in coords.items()
    }


def value_text(dimension: str, value: float) -> str:
    """Return a swept dimension with its value: ``bank angle 60°``, ``5000 rpm``."""
    name, unit = SWEPT[dimension]
    return f"{name} {value:.10g}{unit}".strip()


def at_speed(rpm: float) -> str:
    """Return a crank speed: ``at 5000 rpm``; at 1 rad/s, that forces in N are kg·m over ω²."""
    if rpm != UNIT_RPM:
        return f"at {rpm:g} rpm"
    force, unbalance = units.convert("N"), units.convert("kg·m")
    if force.factor == unbalance.factor == 1.0:
        return "over ω² (N stand for kg·m)"
    ratio = unbalance.factor / force.factor
    return f"over ω² (1 {force.unit} stands for {ratio:.6g} {unbalance.unit})"


class Titled(Protocol):
    """Engine named in tables and pictures."""

    @property
    def title(self) -> str:
        """Name, or its substitute."""

    @property
    def loads_counted(self) -> str:
        """Loads that results of it count, in words."""


def name_of(engine: Titled) -> str:
    """Return the title of an engine in one line, without control characters."""
    return one_line(engine.title)


def about_axis(cranks: Sequence[tuple[float, float, float]]) -> str:
    """Return about which axis a roll torque is, of cranks as x, y and ratio; none of one axis."""
    apart = any((x, y) != (0.0, 0.0) for x, y, _ in cranks)
    return " about the axis of the main crank" if apart else ""


def one_line(text: str) -> str:
    """Return a text in one line, control characters as spaces."""
    return " ".join(without_controls(text).split())


def orders_text(orders: Sequence[Order], most: int | None = None) -> str:
    """Return ``order 2`` or ``orders 2, 4``; of more than ``most`` the first three and the last."""
    word = "order" if len(orders) == 1 else "orders"
    texts = [f"{n:g}" for n in orders]
    if most is not None and len(texts) > most:
        texts[3:-1] = ["…"]
    return f"{word} {', '.join(texts) or 'none'}"


def not_shown(orders: Sequence[Order]) -> str:
    """Return the line under a table or picture that leaves these orders out; empty for none."""
    if not orders:
        return ""
    peak = "its peak is" if len(orders) == 1 else "their peaks are"
    return f"Not shown: {orders_text(orders)} ({peak} below {NEGLIGIBLE:g} of the largest)."


SPECTRUM_GIVEN = "spectrum given"
"""Loads of a result whose forces are those of a spectrum."""


class Loads(str):
    """Loads that results count, in words."""

    __slots__ = ("further",)
    further: str
    """The same without gas pressure, which does not act on forces; empty where nothing is left."""

    def __new__(cls, text: str, further: str = "") -> Self:
        """Return the words."""
        loads = super().__new__(cls, text)
        loads.further = further
        return loads

    def __reduce__(self) -> tuple[type[Loads], tuple[str, str]]:
        """Return what copies and pickles are made of."""
        return type(self), (str(self), self.further)


def without_gas(loads: str) -> str:
    """Return the further loads of the loads counted, in words; empty where there are none."""
    return loads.further if isinstance(loads, Loads) else ""


def gas_text(names: Sequence[str | None], count: int = 1) -> str:
    """Return which gas pressure counts: ``gas: petrol; cylinder 3 does not fire``.

    Parameters
    ----------
    names
        Name of the cycle of each cylinder, which may be empty; None where it has no cycle.
    count
        Number of different cycles.
    """
    named = [None if name is None else one_line(name) for name in names]
    return _core.gas_text(named, count)


def dead_text(cycles: Iterable[object]) -> str:
    """Return ``cylinder 3 does not fire``, or nothing if no cylinder's cycle is None."""
    return _core.dead_text([cycle is not None for cycle in cycles])


def loads_of(engines: Sequence[Titled], titles: Sequence[str]) -> str:
    """Return which gas pressure counts in results of several engines, once where it is the same."""
    loads = [engine.loads_counted for engine in engines]
    further = [without_gas(text) for text in loads]
    return Loads(_once(loads, titles), _once(further, titles))


def _once(texts: Sequence[str], titles: Sequence[str]) -> str:
    """Return texts of engines with their titles, each text once; without titles if there is one."""
    if len(set(texts)) == 1:
        return str(texts[0])
    names: dict[str, list[str]] = {}
    for title, text in zip(titles, texts, strict=True):
        if text:
            names.setdefault(text, []).append(one_line(title))
    return "; ".join(f"{text} ({cut(', '.join(engines), 40)})" for text, engines in names.items())


def in_words(loads: str) -> str:
    """Return the loads counted as a sentence."""
    return f"{loads[0].upper()}{loads[1:]}."


def attributes(loads: str) -> dict[str, str]:
    """Return the attributes of a data frame or dataset that say which loads it counts."""
    return {"loads": str(loads)} if loads else {}


def cut(text: str, longest: int = 60) -> str:
    """Return a text that fits a title; one with figures ends before the first that does not."""
    if len(text) <= longest:
        return text
    if not isinstance(text, units.Text):
        return f"{text[: longest - 1]}…"
    rest, parts = longest - 1, list[str | units.Figure]()
    for part in text.parts:
        length = len(units.Text(part))
        if length > rest and not isinstance(part, str):
            break
        parts.append(part[:rest] if isinstance(part, str) else part)
        rest = max(0, rest - length)
    return units.Text(*parts, "…")
