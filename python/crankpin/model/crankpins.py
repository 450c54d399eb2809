"""Crankpins, and the webs and main bearings beside them, read off an engine's lists."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

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
    """A place of the crankshaft between two main bearings, with one crankpin or split pins.

    Engines do not have main bearings and webs: bearings are taken midway between neighbouring
    throws, those at the ends as far outside as the other one of the bay is inside. With throws at
    one place only they are a crank radius away. Webs are midway between throw and bearing.
    """

    cylinders: tuple[int, ...]
    """Numbers of the cylinders."""
    z: float
    """Place of the throw along the crank, midway between its crankpins, m."""
    bearings: tuple[float, float]
    """Places of the main bearings in front and behind, m."""

    @property
    def webs(self) -> tuple[float, float]:
        """Places of the two webs, m."""
        front, rear = self.bearings
        return (self.z + front) / 2.0, (self.z + rear) / 2.0

    def holds(self, z: float) -> bool:
        """Return whether a place is between the bearings; one at a bearing is behind it."""
        front, rear = self.bearings
        return front <= z < rear


def throws(engine: Engine) -> list[list[Crankpin]]:
    """Return the crankpins from front to flywheel, those of one throw a list.

    Cylinders of different banks whose places are less than a crank radius apart are on one throw.
    Those of them whose pins are at one place share a crankpin; a throw has several where pins are
    split, and in a boxer.
    """
    core = engine.core
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

    front_to_back = sorted(range(len(engine)), key=places.__getitem__)
    return [
        [pin(shared) for shared in _grouped(throw, on_one_pin)]
        for throw in _grouped(front_to_back, on_one_throw)
    ]


def crankpins(engine: Engine) -> tuple[Crankpin, ...]:
    """Return the crankpins from front to flywheel."""
    pins = (pin for throw in throws(engine) for pin in throw)
    return tuple(sorted(pins, key=lambda pin: pin.z))


def bays(engine: Engine) -> tuple[Bay, ...]:
    """Return the bays from front to flywheel: throws, with those at one place in one bay."""
    radius = engine.core.largest_crank_radius
    at: dict[float, list[int]] = {}
    for throw in sorted(throws(engine), key=lambda throw: _middle(pin.z for pin in throw)):
        z = _middle(pin.z for pin in throw)
        place = next((each for each in at if z - each <= SAME_PLACE * radius), z)
        at.setdefault(place, []).extend(number for pin in throw for number in pin.cylinders)
    middles = list(at)
    between = [(one + other) / 2.0 for one, other in pairwise(middles)]
    if between:
        first, last = 2.0 * middles[0] - between[0], 2.0 * middles[-1] - between[-1]
    else:
        first, last = middles[0] - radius, middles[0] + radius
    bearings = pairwise([first, *between, last])
    return tuple(
        Bay(tuple(sorted(numbers)), z, sides)
        for (z, numbers), sides in zip(at.items(), bearings, strict=True)
    )


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
