"""Measured pistons and rods, and what each does in each cylinder of an engine."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from crankpin._support.frozen import Frozen
from crankpin.analysis.balance import over_square
from crankpin.analysis.tolerances import matching
from crankpin.analysis.tolerances.matching import Kind
from crankpin.model.shafts import Unbalance

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin.model.engine import Engine


class Assignment(NamedTuple):
    """Parts of one engine."""

    pistons: tuple[int, ...]
    """Number, from 1, of the piston in each cylinder."""
    rods: tuple[int, ...] | None
    """Number, from 1, of the rod in each cylinder; None where no rods were given."""


class MeasuredParts(Frozen):
    """Measured pistons and rods, and the engine that they are for."""

    _fields: ClassVar[tuple[str, ...]] = ("engine", "pistons", "rods", "orders", "reference_z")

    engine: Engine
    """The engine with its own masses."""
    pistons: NDArray[np.float64]
    """Masses of the pistons, kg: (n_pistons,)."""
    rods: NDArray[np.float64] | None
    """Masses of the rods' small and big ends, kg: (n_rods, 2)."""
    orders: tuple[int, ...]
    """Orders of what remains."""
    reference_z: float | None
    """Plane about which moments are taken, m; None for the engine's own."""

    def __init__(
        self,
        engine: Engine,
        pistons: NDArray[np.float64],
        rods: NDArray[np.float64] | None,
        orders: tuple[int, ...],
        reference_z: float | None,
    ) -> None:
        kept = pistons.copy(), None if rods is None else rods.copy()
        for each in kept:
            if each is not None:
                each.setflags(write=False)
        self._set(
            engine=engine, pistons=kept[0], rods=kept[1], orders=orders, reference_z=reference_z
        )

    @cached_property
    def start(self) -> NDArray[np.float64]:
        """What remains of the engine with its own masses, over ω², as real numbers."""
        return self._vector(self.engine)

    @cached_property
    def kinds(self) -> tuple[Kind, ...]:
        """Deviations of the parts from their means, and what a unit of each does."""
        count = len(self.engine)
        reciprocating = np.stack([self._influence(k, rotating=False) for k in range(count)])
        found = [Kind((self.pistons - self.pistons.mean())[:, None], reciprocating[:, None])]
        if self.rods is not None:
            rotating = np.stack([self._influence(k, rotating=True) for k in range(count)])
            both = np.stack([reciprocating, rotating], axis=1)
            found.append(Kind(self.rods - self.rods.mean(axis=0), both))
        return tuple(found)

    def _influence(self, place: int, *, rotating: bool) -> NDArray[np.float64]:
        """Return what a kilogram more in one cylinder adds: what remains is linear in masses."""
        engine = self.engine
        if rotating:
            masses = engine.rotating_mass.copy()
            masses[place] += 1.0
            return self._vector(engine.replace(rotating_mass=masses)) - self.start
        cylinders = list(engine.cylinders)
        mass = cylinders[place].reciprocating_mass
        cylinders[place] = cylinders[place].replace(reciprocating_mass=mass + 1.0)
        return self._vector(engine.replace(cylinder=cylinders)) - self.start

    def _vector(self, engine: Engine) -> NDArray[np.float64]:
        plane = self.engine.reference_z if self.reference_z is None else self.reference_z
        found = over_square(engine, self.orders, plane)
        half = 0.5 * (self.engine.z.max() - self.engine.z.min())
        parts = [found.force.forward, found.force.backward]
        if half > 0.0:
            parts += [found.moment.forward / half, found.moment.backward / half]
        together = np.concatenate(parts)
        return np.concatenate([together.real, together.imag])

    def chosen(self, assignment: Assignment) -> tuple[NDArray[np.intp], ...]:
        """Return the places of the parts in the lists of this bin."""
        lists = [each for each in assignment if each is not None]
        return tuple(np.array(each, dtype=np.intp) - 1 for each in lists)

    def value(self, objective: str, assignment: Assignment) -> float:
        """Return the objective of one engine."""
        chosen = self.chosen(assignment)
        if objective == "balance":
            return matching.remains(self.start, self.kinds, chosen)
        sums = self.pistons[chosen[0]]
        if self.rods is not None:
            sums = sums + self.rods[chosen[1], 0]
        return float(np.ptp(sums))

    def engine_of(self, assignment: Assignment, name: str) -> Engine:
        """Return the engine with these parts."""
        chosen, engine = self.chosen(assignment), self.engine
        more = (self.pistons - self.pistons.mean())[chosen[0]]
        rotating = engine.rotating_mass
        if self.rods is not None:
            ends = (self.rods - self.rods.mean(axis=0))[chosen[1]]
            more, rotating = more + ends[:, 0], rotating + ends[:, 1]
        cylinders = [
            cylinder.replace(reciprocating_mass=cylinder.reciprocating_mass + float(mass))
            for cylinder, mass in zip(engine.cylinders, more, strict=True)
        ]
        # A throw that is balanced may be too light: that is an unbalance opposite its pin.
        opposite = [
            Unbalance(-mass * cylinders[k].crank_radius, float(engine.z[k]), 180, pin=k + 1)
            for k, mass in enumerate(rotating.tolist())
            if mass < 0.0
        ]
        return engine.replace(
            cylinder=cylinders,
            rotating_mass=np.maximum(rotating, 0.0),
            counterweights=[*engine.counterweights, *opposite],
            name=name,
        )


def assignment_of(*chosen: NDArray[np.intp]) -> Assignment:
    """Return the numbers of parts whose places in their lists are given."""
    numbers = [tuple((each + 1).tolist()) for each in chosen]
    return Assignment(numbers[0], numbers[1] if len(numbers) > 1 else None)
