"""Crankpins, webs and main bearings derived from an engine's lists."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from crankpin.model.engine import Engine


class Crankpin(NamedTuple):
    """A crankpin and the cylinders whose rods share it."""

    cylinders: tuple[int, ...]
    """Numbers of the cylinders."""
    pin_deg: float
    """Direction from +x at θ = 0, degrees."""
    z: float
    """Place along the crank, midway between its cylinders', m."""
    crank: int = 0
    """Index of its crankshaft: 0 is the main one."""


class Bay(NamedTuple):
    """Part of a crankshaft between two main bearings, with one throw or several.

    Bearings of the main one are the engine's :attr:`~crankpin.Engine.mains`. Webs are midway
    between a throw and the bearing or throw beside it.
    """

    cylinders: tuple[int, ...]
    """Numbers of the cylinders."""
    throws: tuple[float, ...]
    """Places of the throws along the crank, each midway between its crankpins, m."""
    bearings: tuple[float, float]
    """Places of the main bearings in front and behind, m."""
    crank: int = 0
    """Index of its crankshaft: 0 is the main one."""

    @property
    def z(self) -> float:
        """Place midway between the first throw and the last, m."""
        return (self.throws[0] + self.throws[-1]) / 2.0

    @property
    def webs(self) -> tuple[float, ...]:
        """Places of the webs, m."""
        front, rear = self.bearings
        return tuple((one + other) / 2.0 for one, other in pairwise([front, *self.throws, rear]))

    def holds(self, z: float, crank: int = 0) -> bool:
        """Return whether a place is between the bearings; one at a bearing is behind it."""
        front, rear = self.bearings
        return crank == self.crank and front <= z < rear


def throws(engine: Engine) -> list[list[Crankpin]]:
    """Return the crankpins of an engine from front to flywheel, those of one throw a list.

    Cylinders of one crank and different banks whose places are less than a crank radius apart are
    on one throw. Those of them whose pins are at one place share a crankpin; a throw has several
    where pins are split, and in a boxer.
    """
    return [[Crankpin(**pin) for pin in throw] for throw in engine._core.throws()]


def crankpins(engine: Engine) -> tuple[Crankpin, ...]:
    """Return the crankpins from front to flywheel."""
    return tuple(Crankpin(**pin) for pin in engine._core.crankpins())


def bays(engine: Engine) -> tuple[Bay, ...]:
    """Return the bays of all cranks that have throws, crank by crank from front to flywheel.

    Throws at one place are one.
    """
    return tuple(Bay(**bay) for bay in engine._core.bays())
