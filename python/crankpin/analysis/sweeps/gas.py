"""Gas pressure of sweeps over speed and load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.record import Record
from crankpin.model import checks
from crankpin.model.cycle_map import CycleMap

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from crankpin import _core
    from crankpin.model.engine import Engine

Item = TypeVar("Item")


class GasMap(Record):
    """Cycles over speed and load of the cylinders of engines, and the crankcase pressure."""

    maps: tuple[CycleMap | None, ...]
    """A map for each cylinder, or one for all."""
    crankcase: float | None
    """Absolute pressure in the crankcase, Pa; None for that of each engine."""

    @classmethod
    def checked(cls, cycle: object, engines: Sequence[Engine], crankcase: object) -> GasMap:
        """Return maps that fit the engines, or raise an InputError that names the argument."""
        hint = "give a crankpin.CycleMap, or one or None for each cylinder"
        alone = isinstance(cycle, CycleMap)
        maps: list[Any] = [cycle] if alone else inputs.items("cycle", cycle, hint)
        for k, each in enumerate(maps):
            if not (each is None or isinstance(each, CycleMap)):
                raise inputs.rejected(f"cycle[{k}]", each, hint)
        present = [each for each in maps if each is not None]
        if not present:
            raise inputs.rejected("cycle", cycle, "has no map; leave it out")
        for axis in ("rpm", "load"):
            if any(
                not np.array_equal(getattr(m, axis), getattr(present[0], axis)) for m in present
            ):
                raise inputs.faulty(
                    "cycle", f"has maps that differ in {axis}", f"give the same {axis}"
                )
        for engine in engines:
            if not alone and len(maps) != len(engine):
                fault = f"has {len(maps)} entries, the engine has {len(engine)}"
                raise inputs.faulty("cycle", fault, "give one for each cylinder")
        below = inputs.optional_number("crankcase", crankcase)
        if below is not None:
            checks.crankcase(below)
        return cls(tuple(maps), below)

    @property
    def first(self) -> CycleMap:
        """One of the maps: all have its speeds and loads."""
        return next(each for each in self.maps if each is not None)

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words."""
        distinct = {each for each in self.maps if each is not None}
        names = ["cycle map" if each is not None else None for each in self.maps]
        return labels.gas_text(names, len(distinct))

    def fired(self, engines: Sequence[Engine]) -> list[_core.Engine]:
        """Return each engine with each cycle, load by load of one speed after the other."""
        shape = np.ndindex(len(self.first.rpm), len(self.first.load))
        of_cylinders = [
            [None if each is None else each.cycles[k][j]._core for each in self.maps]
            for k, j in shape
        ]
        return [
            core
            for engine in engines
            for core in engine._core.with_cycles(
                [self._of_each(cycles, engine) for cycles in of_cylinders],
                engine._below_pistons(self.crankcase),
            )
        ]

    def places(self, load: NDArray[np.float64] | None) -> tuple[Any, Any, Any]:
        """Return speeds and loads of the cycles, and the loads of the sweep."""
        if load is None:
            low, high = self.first.load[[0, -1]]
            raise inputs.rejected(
                "load", None, f"give loads from {low:g} to {high:g}, those of cycle"
            )
        return self.first.rpm, self.first.load, load

    def at(self, engine: Engine, rpm: float, load: float) -> Engine:
        """Return an engine with its cycles at a speed and a load."""
        cycles = [None if each is None else each.at(rpm=rpm, load=load) for each in self.maps]
        return engine.with_cycle(self._of_each(cycles, engine), crankcase=self.crankcase)

    def _of_each(self, cycles: list[Item], engine: Engine) -> list[Item]:
        """Return the cycle of each cylinder."""
        return cycles * len(engine) if len(self.maps) == 1 else cycles
