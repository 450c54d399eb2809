"""Planes for counterweights as people name them; parts of an engine that turn with a shaft."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import zip_longest
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin.analysis.request import engine_core
from crankpin.model import checks
from crankpin.model.crankpins import bays

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from crankpin.model.engine import Engine

Planes: TypeAlias = "ArrayLike | Mapping[str, float | tuple[float, int]]"
PLANES_HINT = 'give "ends", "webs", a list of places or a mapping name → place in metres'
MOST_PLANES = 200
"""Largest number of planes."""
MOST_ANGLES = 10_000
"""Largest number of angles of all planes together: a step of the fit takes 40 ms then."""


class Place(NamedTuple):
    """A plane in which a crank can have weights."""

    z: float
    """Place along the crank, m."""
    crank: int = 0
    """Index of the crank: 0 is the main one."""


def named(engine: Engine, planes: Planes) -> dict[str, Place]:
    """Return planes by name, from front to flywheel or as given.

    Those that have a name of their own are on every crank that turns as fast as the main one.
    """
    if isinstance(planes, str):
        word = inputs.one_of("planes", planes, ["ends", "webs"])
        ratios = [ratio for _, _, ratio in engine_core(engine).cranks[0]]
        return {
            name: place
            for crank, ratio in enumerate(ratios)
            if abs(ratio) == 1
            for name, place in (_ends if word == "ends" else _webs)(engine, crank)
        }
    if isinstance(planes, Mapping):
        places = {inputs.text("planes", name): _place(name, z) for name, z in planes.items()}
    else:
        entries = inputs.items("planes", planes, PLANES_HINT)
        places = {f"plane {k}": _place(k - 1, z) for k, z in enumerate(entries, start=1)}
    if not 1 <= len(places) <= MOST_PLANES:
        raise inputs.faulty("planes", f"has {len(places)} places", f"give 1 to {MOST_PLANES}")
    checks.place(engine_core(engine), "planes", *(place.z for place in places.values()))
    return places


def _ends(engine: Engine, crank: int) -> list[tuple[str, Place]]:
    """Return planes at the first and the last cylinder of a crank."""
    on = np.array(engine_core(engine).cranks[1]) == crank
    if not on.any():
        return []
    front, rear = float(engine.z[on].min()), float(engine.z[on].max())
    ends = [("front", front), ("rear", rear)] if front < rear else [("crankpin", front)]
    return [(_on_crank(name, crank), Place(z, crank)) for name, z in ends]


def _webs(engine: Engine, crank: int) -> list[tuple[str, Place]]:
    """Return planes at the webs of a crank."""
    of_crank = [bay for bay in bays(engine) if bay.crank == crank]
    names = [
        (f"throw {number} {side}" if len(bay.webs) == 2 else f"bay {number} web {k}", z)
        for number, bay in enumerate(of_crank, start=1)
        for k, (side, z) in enumerate(zip_longest(("front", "rear"), bay.webs), start=1)
    ]
    return [(_on_crank(name, crank), Place(z, crank)) for name, z in names]


def _on_crank(name: str, crank: int) -> str:
    return f"crank {crank} {name}" if crank else name


def _place(key: object, value: object) -> Place:
    name, crank = f"planes[{inputs.shorten(key)}]", 0
    if isinstance(value, tuple):
        if len(value) != 2:
            raise inputs.rejected(name, value, "give a place in m, or it and the number of a crank")
        value, on = value
        crank = inputs.whole(name, on)
        if crank < 0:
            raise inputs.rejected(name, crank, "give the number of a crank, 0 for the main one")
    place = inputs.number(name, value)
    if not abs(place) <= 1e30:
        raise inputs.rejected(name, place, "give a finite place in metres")
    return Place(place, crank)


def bounds(names: Sequence[str], limits: object) -> dict[str, float]:
    """Return the largest mass·radius in each plane, kg·m; infinite where there is no bound."""
    by_name = _by_name("bound", names, limits)
    amounts = {}
    for name in names:
        bound = by_name.get(name)
        amounts[name] = math.inf if bound is None else inputs.number("bound", bound)
        if not amounts[name] >= 0.0:
            raise inputs.rejected("bound", amounts[name], "give a mass·radius of 0 kg·m or more")
    return amounts


def angles(names: Sequence[str], angles_deg: object) -> dict[str, tuple[str, ...]] | None:
    """Return the angles allowed in each plane as text, or None where all are."""
    if angles_deg is None:
        return None
    by_name = _by_name("angles_deg", names, angles_deg)
    allowed = {}
    for name in names:
        if by_name.get(name) is None:
            raise inputs.faulty(
                "angles_deg", f'has none for "{name}"', "give angles for every plane"
            )
        angles = inputs.angles("angles_deg", by_name[name])
        if not 1 <= len(angles) <= 360:
            raise inputs.faulty("angles_deg", f"has {len(angles)} angles", "give 1 to 360")
        allowed[name] = tuple(dict.fromkeys(angles))
    count = sum(map(len, allowed.values()))
    if count > MOST_ANGLES:
        raise inputs.faulty(
            "angles_deg", f"has {count} angles in all", f"give at most {MOST_ANGLES}"
        )
    return allowed


def _by_name(what: str, names: Sequence[str], values: object) -> Mapping[str, Any]:
    """Return values by name: of a mapping, or one value for all."""
    if not isinstance(values, Mapping):
        return dict.fromkeys(names, values)
    for name in values:
        if name not in names:
            short = inputs.shorten(list(names))
            raise inputs.rejected(what, name, f"is not a plane; choose from: {short}")
    return values


# --- parts that turn with a shaft ----------------------------------------------------------------


class Turning(NamedTuple):
    """Force and moment that turn with a shaft, as vectors x + iy at θ = 0, over ω²."""

    force: complex
    """Force, kg·m."""
    moment: complex
    """Moment about the reference plane, kg·m²."""


def turning(engine: Engine, ratio: float) -> Turning:
    """Return the part of an engine's force and moment that turns with a shaft of this ratio."""
    return Turning(*_core.turning(engine_core(engine), ratio))


def ends(engine: Engine) -> tuple[float, ...]:
    """Return the places of the first and the last cylinder, m; one if they agree."""
    first, last = float(engine.z.min()), float(engine.z.max())
    return (first, last) if first < last else (first,)
