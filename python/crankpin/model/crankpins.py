"""Crankpins, and the webs and main bearings beside them, read off an engine's lists."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator

    from crankpin.model.engine import Engine

SAME_ANGLE = 1e-9
"""Degrees up to which two crankpins point the same way, as for firing intervals."""
SAME_PLACE = 1e-6
"""Distance along the crank, in crank radii, up to which two crankpins are at one place."""


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
    crankpins, those at the ends as far outside as the other one of the bay is inside. With
    crankpins at one place only they are a crank radius away. Webs are midway between crankpin and
    bearing.
    """

    cylinders: tuple[int, ...]
    """Numbers of the cylinders."""
    z: float
    """Place of the crankpins along the crank, m."""
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


def crankpins(engine: Engine) -> tuple[Crankpin, ...]:
    """Return the crankpins from front to flywheel.

    Cylinders share a pin if they are of different banks, their pins point the same way, and their
    places are less than a crank radius apart. Split pins are two.
    """
    banks, pins, places = engine.core.bank, engine.pin_deg.tolist(), engine.z.tolist()
    groups: list[list[int]] = []
    for k in sorted(range(len(engine)), key=lambda k: places[k]):
        reach = engine.cylinders[k].crank_radius
        for group in groups:
            turned = abs((pins[k] - pins[group[0]] + 180.0) % 360.0 - 180.0)
            if (
                turned <= SAME_ANGLE
                and places[k] - places[group[0]] < reach
                and all(banks[k] != banks[member] for member in group)
            ):
                group.append(k)
                break
        else:
            groups.append([k])
    return tuple(
        Crankpin(
            tuple(sorted(k + 1 for k in group)),
            pins[group[0]],
            (min(places[k] for k in group) + max(places[k] for k in group)) / 2.0,
        )
        for group in groups
    )


def bays(engine: Engine) -> tuple[Bay, ...]:
    """Return the bays from front to flywheel."""
    grouped = list(_at_one_place(engine))
    middles = [z for z, _ in grouped]
    between = [(one + other) / 2.0 for one, other in pairwise(middles)]
    if between:
        first, last = 2.0 * middles[0] - between[0], 2.0 * middles[-1] - between[-1]
    else:
        radius = max(cylinder.crank_radius for cylinder in engine.cylinders)
        first, last = middles[0] - radius, middles[0] + radius
    bearings = [first, *between, last]
    return tuple(
        Bay(numbers, z, (bearings[k], bearings[k + 1])) for k, (z, numbers) in enumerate(grouped)
    )


def _at_one_place(engine: Engine) -> Iterator[tuple[float, tuple[int, ...]]]:
    """Return places with crankpins and the cylinders there, from front to flywheel."""
    near = SAME_PLACE * max(cylinder.crank_radius for cylinder in engine.cylinders)
    place, numbers = 0.0, list[int]()
    for pin in sorted(crankpins(engine), key=lambda pin: pin.z):
        if numbers and pin.z - place > near:
            yield place, tuple(sorted(numbers))
            numbers = []
        place = place if numbers else pin.z
        numbers += pin.cylinders
    yield place, tuple(sorted(numbers))
