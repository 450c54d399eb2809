"""Crankpins, and the webs and main bearings beside them, read off an engine's lists."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from crankpin._core import InputError
from crankpin._support import inputs

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from crankpin import _core
    from crankpin.model.engine import Engine

SAME_ANGLE = 1e-9
"""Degrees up to which two crankpins point the same way, as for firing intervals."""
SAME_PLACE = 1e-6
"""Distance along the crank, in crank radii, up to which two throws are at one place."""


class Crankpin(NamedTuple):
    """A crankpin and the cylinders whose rods share it."""

    cylinders: tuple[int, ...]
    """Numbers of the cylinders."""
    pin_deg: float
    """Direction from +x at θ = 0, degrees."""
    z: float
    """Place along the crank, midway between its cylinders', m."""


class Bay(NamedTuple):
    """Part of the crankshaft between two main bearings, with one throw or several.

    Bearings are the engine's :attr:`~crankpin.Engine.mains`. Webs are midway between a throw and
    the bearing or throw beside it.
    """

    cylinders: tuple[int, ...]
    """Numbers of the cylinders."""
    throws: tuple[float, ...]
    """Places of the throws along the crank, each midway between its crankpins, m."""
    bearings: tuple[float, float]
    """Places of the main bearings in front and behind, m."""

    @property
    def z(self) -> float:
        """Place midway between the first throw and the last, m."""
        return _middle(self.throws)

    @property
    def webs(self) -> tuple[float, ...]:
        """Places of the webs, m."""
        front, rear = self.bearings
        return tuple((one + other) / 2.0 for one, other in pairwise([front, *self.throws, rear]))

    def holds(self, z: float) -> bool:
        """Return whether a place is between the bearings; one at a bearing is behind it."""
        front, rear = self.bearings
        return front <= z < rear


def throws(engine: Engine) -> list[list[Crankpin]]:
    """Return the crankpins of an engine from front to flywheel, those of one throw a list."""
    return _throws(engine.core)


def _throws(core: _core.Engine) -> list[list[Crankpin]]:
    """Return the crankpins from front to flywheel, those of one throw a list.

    Cylinders of different banks whose places are less than a crank radius apart are on one throw.
    Those of them whose pins are at one place share a crankpin; a throw has several where pins are
    split, and in a boxer.
    """
    banks, places, pins = core.bank, core.z.tolist(), core.pin_deg.tolist()
    radii = [parts[0] for parts in core.cylinders]

    def on_one_throw(k: int, other: int) -> bool:
        return banks[k] != banks[other] and abs(places[k] - places[other]) < radii[k]

    def on_one_pin(k: int, other: int) -> bool:
        turned = abs((pins[k] - pins[other] + 180.0) % 360.0 - 180.0)
        return radii[k] == radii[other] and turned <= SAME_ANGLE

    def pin(shared: list[int]) -> Crankpin:
        z = _middle(places[k] for k in shared)
        return Crankpin(tuple(sorted(k + 1 for k in shared)), pins[shared[0]], z)

    front_to_back = sorted(range(len(places)), key=places.__getitem__)
    return [
        [pin(shared) for shared in _grouped(throw, on_one_pin)]
        for throw in _grouped(front_to_back, on_one_throw)
    ]


def crankpins(engine: Engine) -> tuple[Crankpin, ...]:
    """Return the crankpins from front to flywheel."""
    pins = (pin for throw in throws(engine) for pin in throw)
    return tuple(sorted(pins, key=lambda pin: pin.z))


def bays(engine: Engine) -> tuple[Bay, ...]:
    """Return the bays with throws from front to flywheel; those at one place are one throw."""
    core = engine.core
    at = _places_of_throws(core)
    found = []
    for front, rear in pairwise(core.mains or default_mains(core)):
        between = {z: numbers for z, numbers in at.items() if front < z < rear}
        if between:
            cylinders = tuple(sorted(number for each in between.values() for number in each))
            found.append(Bay(cylinders, tuple(between), (front, rear)))
    return tuple(found)


def default_mains(core: _core.Engine) -> list[float]:
    """Return the places of main bearings where none are given; see :attr:`Engine.mains`."""
    middles = list(_places_of_throws(core))
    between = [(one + other) / 2.0 for one, other in pairwise(middles)]
    if not between:
        radius = core.largest_crank_radius
        return [middles[0] - radius, middles[0] + radius]
    return [2.0 * middles[0] - between[0], *between, 2.0 * middles[-1] - between[-1]]


def check_mains(core: _core.Engine) -> None:
    """Reject main bearings that leave a throw outside, or one at a bearing."""
    if not core.mains:
        return
    for z in _places_of_throws(core):
        if not core.mains[0] < z < core.mains[-1] or z in core.mains:
            hint = "give places in front of, between and behind the throws"
            raise InputError(f"mains = {inputs.shorten(core.mains)}: the throw at {z:g} m; {hint}")


def _places_of_throws(core: _core.Engine) -> dict[float, list[int]]:
    """Return places along the crank, ascending, and the numbers of the cylinders at each."""
    radius = core.largest_crank_radius
    at: dict[float, list[int]] = {}
    for throw in sorted(_throws(core), key=lambda throw: _middle(pin.z for pin in throw)):
        z = _middle(pin.z for pin in throw)
        place = next((each for each in at if z - each <= SAME_PLACE * radius), z)
        at.setdefault(place, []).extend(number for pin in throw for number in pin.cylinders)
    return at


def _grouped(cylinders: Iterable[int], alike: Callable[[int, int], bool]) -> list[list[int]]:
    """Put each cylinder into the first group to whose every member it is alike."""
    groups: list[list[int]] = []
    for k in cylinders:
        group = next((g for g in groups if all(alike(k, other) for other in g)), None)
        if group is None:
            groups.append([k])
        else:
            group.append(k)
    return groups


def _middle(places: Iterable[float]) -> float:
    """Return the place midway between the first and the last."""
    listed = list(places)
    return (min(listed) + max(listed)) / 2.0
