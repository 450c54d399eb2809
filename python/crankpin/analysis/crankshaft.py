"""How a crankshaft is made up: which rods share a crankpin, which crankpins a throw."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from crankpin.analysis.geometry import assumed_bores, geometry

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from crankpin.model.engine import Engine

SAME_PIN = 1e-8
"""Crankpins closer than this part of the crank radius are one: angles of firing orders round."""


class Crankpin(NamedTuple):
    """A crankpin, and the cylinders whose rods are on it."""

    cylinders: tuple[int, ...]
    """Numbers of the cylinders, from the front to the flywheel."""
    z: float
    """Place along the crank, the mean of its cylinders', m."""
    at: complex
    """Place at θ = 0, x + iy seen from the flywheel, m."""


def throws(engine: Engine) -> list[list[Crankpin]]:
    """Return the crankpins from the front to the flywheel, those between two main bearings a list.

    Cylinders of different banks less than half a bore apart along the crank are on one throw: a
    bank's own are never so close. Their rods share a crankpin if it is at one place; a throw has
    several where pins are split, and in a boxer.
    """
    crankpin = geometry(engine).crankpin
    bores = assumed_bores(engine)
    banks = engine.core.bank

    def on_one_throw(k: int, other: int) -> bool:
        apart = abs(engine.z[k] - engine.z[other])
        return bool(banks[k] != banks[other] and apart < 0.5 * min(bores[k], bores[other]))

    def on_one_pin(k: int, other: int) -> bool:
        return bool(abs(crankpin[k] - crankpin[other]) <= SAME_PIN * abs(crankpin[k]))

    def pin(group: list[int]) -> Crankpin:
        z = float(np.mean(engine.z[group]))
        return Crankpin(tuple(k + 1 for k in group), z, complex(crankpin[group[0]]))

    front_to_back = np.argsort(engine.z, kind="stable").tolist()
    return [
        [pin(shared) for shared in _grouped(throw, on_one_pin)]
        for throw in _grouped(front_to_back, on_one_throw)
    ]


def directions(engine: Engine) -> list[Crankpin]:
    """Return the crankpins that are seen from the flywheel, those in line with one another as one.

    Each is at the place of the first of them, with the cylinders of all.
    """
    pins = [pin for throw in throws(engine) for pin in throw]

    def in_line(k: int, other: int) -> bool:
        return bool(abs(pins[k].at - pins[other].at) <= SAME_PIN * abs(pins[k].at))

    return [
        pins[group[0]]._replace(
            cylinders=tuple(sorted(n for k in group for n in pins[k].cylinders))
        )
        for group in _grouped(range(len(pins)), in_line)
    ]


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
