"""Arguments of balance shafts, one for all shafts or one for each, checked."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import Any, Literal, TypeAlias, cast

from crankpin._core import InputError
from crankpin._support import inputs

Remove: TypeAlias = Literal["both", "force", "moment"]
REMOVE: tuple[Remove, ...] = ("both", "force", "moment")

MOST_SHAFTS = 100
"""Largest number of shafts fitted at once."""


@dataclasses.dataclass(frozen=True)
class ShaftRequest:
    """A shaft to be fitted; None is free."""

    ratio: int
    """Speed over crank speed."""
    x: float | None
    """Axis to the right of the crank axis, m."""
    y: float | None
    """Axis above the crank axis, m."""
    planes: tuple[float, ...] | None
    """Places of its unbalances, m."""
    bearings: tuple[float, float] | None
    """Places of its two bearings, front first, m."""
    remove: Remove
    """What it has to remove."""


def shaft_requests(
    ratios: object, *, x: object, y: object, planes: object, bearings: object, remove: object
) -> list[ShaftRequest]:
    """Return the shafts to be fitted; :func:`crankpin.balance_shafts` documents the arguments."""
    listed = _ratios(ratios)
    count = len(listed)
    removals = _removals(remove, listed)
    found = list(
        map(
            ShaftRequest,
            listed,
            _coordinates("x", x, count),
            _coordinates("y", y, count),
            _places("planes", planes, count),
            _bearings(bearings, count),
            removals,
        )
    )
    for k, each in enumerate(found):
        if each.planes is not None and len(each.planes) < 2 and each.remove == "moment":
            message = "a couple takes two planes; give two, or remove the force"
            raise InputError(f"planes[{k}] = {list(each.planes)}: {message}")
    return found


def _ratios(given: object) -> list[int]:
    remedy = "give whole numbers other than 0, such as -1 or [2, -2]"
    listed = inputs.items("ratios", given, remedy) if isinstance(given, Iterable) else [given]
    found = [inputs.whole("ratios", each) for each in listed]
    if not 1 <= len(found) <= MOST_SHAFTS:
        raise InputError(f"ratios has {len(found)} shafts: give 1 to {MOST_SHAFTS}")
    for each in found:
        if each == 0 or abs(each) > inputs.HIGHEST_ORDER:
            raise InputError(f"ratios = {inputs.shorten(given)}: {remedy}")
    return found


def _removals(given: object, ratios: list[int]) -> list[Remove]:
    alike = isinstance(given, str) or not isinstance(given, Iterable)
    listed = [given] * len(ratios) if alike else _each("remove", given, len(ratios))
    found: dict[int, Remove] = {}
    for ratio, each in zip(ratios, listed, strict=True):
        word = cast("Remove", inputs.one_of("remove", each, REMOVE))
        if found.setdefault(ratio, word) != word:
            remedy = "shafts of one ratio share their task; give them the same"
            raise InputError(f"remove = {inputs.shorten(given)}: {remedy}")
    return [found[ratio] for ratio in ratios]


def _each(name: str, given: object, count: int) -> list[Any]:
    listed = inputs.items(name, given, f"give one for each of {count} shafts")
    if len(listed) != count:
        raise InputError(f"{name} has {len(listed)} entries: give one for each of {count} shafts")
    return listed


def _coordinates(name: str, given: object, count: int) -> list[float | None]:
    listed = _each(name, given, count) if isinstance(given, Iterable) else [given] * count
    return [None if each is None else inputs.finite(name, each) for each in listed]


def _places(name: str, given: object, count: int) -> list[tuple[float, ...] | None]:
    if given is None:
        return [None] * count
    remedy = "give places along the crank, m, such as [0.0, 0.3], or a list of these"
    listed = inputs.items(name, given, remedy)
    if any(each is None or isinstance(each, Iterable) for each in listed):
        each_has = _each(name, listed, count)
    else:
        each_has = [listed] * count
    found: list[tuple[float, ...] | None] = []
    for k, each in enumerate(each_has):
        if each is None:
            found.append(None)
            continue
        numbers = [
            inputs.finite(f"{name}[{k}]", z) for z in inputs.items(f"{name}[{k}]", each, remedy)
        ]
        places = tuple(sorted(numbers))
        if not places or len(set(places)) < len(places):
            raise InputError(f"{name}[{k}] = {inputs.shorten(each)}: give different places")
        found.append(places)
    return found


def _bearings(given: object, count: int) -> list[tuple[float, float] | None]:
    found: list[tuple[float, float] | None] = []
    for k, each in enumerate(_places("bearings", given, count)):
        if each is not None and len(each) != 2:
            raise InputError(f"bearings[{k}] = {list(each)}: give the places of two bearings")
        found.append(None if each is None else (each[0], each[1]))
    return found
