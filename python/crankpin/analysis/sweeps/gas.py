"""Gas pressure of sweeps over speed and load."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.messages import Hint
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
    ends: tuple[CycleMap | None, ...]
    """The same of the crank ends that engines have; none at all where they have none."""
    crankcase: float | None
    """Absolute pressure in the crankcase, Pa; None for that of each engine."""

    @classmethod
    def checked(
        cls, cycle: object, crank_end: object, engines: Sequence[Engine], crankcase: object
    ) -> GasMap:
        """Return maps that fit the engines, or raise an InputError that names the argument."""
        maps = _maps("cycle", cycle, engines)
        ends = [] if crank_end is None else _maps("crank_end", crank_end, engines)
        first = next(cycle_map for cycle_map in maps if cycle_map is not None)
        for name, of in (("cycle", maps), ("crank_end", ends)):
            for axis in ("rpm", "load"):
                values = [getattr(one, axis) for one in of if one is not None]
                if not all(np.array_equal(one, getattr(first, axis)) for one in values):
                    fault = f"has maps that differ in {axis}"
                    raise inputs.faulty(name, fault, f"give the same {axis}")
        for engine in engines:
            if ends and engine.crank_ends is None:
                hint = "give an engine whose crank ends have cycles and rods, which maps replace"
                raise inputs.faulty("crank_end", "applies to double-acting pistons", hint)
            if engine.crank_ends is not None and not ends:
                hint = Hint.of("maps are of head ends alone: give `crank_end` those of the others")
                raise inputs.faulty("cycle", "replaces those of double-acting pistons", hint)
        below = inputs.optional_number("crankcase", crankcase)
        if below is not None:
            checks.absolute("crankcase", below)
        return cls(tuple(maps), tuple(ends), below)

    @property
    def first(self) -> CycleMap:
        """One of the maps: all have its speeds and loads."""
        return next(cycle_map for cycle_map in self.maps if cycle_map is not None)

    def loads_counted(self, engines: Sequence[Engine], titles: Sequence[str]) -> str:
        """Return the loads that results of engines with this gas pressure count, in words."""
        distinct = {cycle_map for cycle_map in self.maps if cycle_map is not None}
        names = ["cycle map" if cycle_map is not None else None for cycle_map in self.maps]
        further = labels.without_gas(labels.loads_of(engines, titles))
        ends = "crank ends: cycle map" if self.ends else ""
        words = filter(None, [labels.gas_text(names, len(distinct)), ends, further])
        return labels.Loads("; ".join(words), further)

    @cached_property
    def _distinct(self) -> list[CycleMap]:
        """Maps that differ."""
        distinct: list[CycleMap] = []
        for cycle_map in (*self.maps, *self.ends):
            if cycle_map is not None and cycle_map not in distinct:
                distinct.append(cycle_map)
        return distinct

    @cached_property
    def _cycles(self) -> list[list[_core.Cycle]]:
        """Cycle of each map that differs, load by load of one speed after the other."""
        return [list(cores) for cores in zip(*(m._cores for m in self._distinct), strict=True)]

    def fired(self, engines: Sequence[Engine]) -> list[_core.Engine]:
        """Return each engine with the cycles of the lowest speed and load."""
        places = self._distinct.index
        cycle_of, end_of = (
            [None if cycle_map is None else places(cycle_map) for cycle_map in maps]
            for maps in (self.maps, self.ends)
        )
        return [
            engine._core.with_cycles(
                self._cycles[0],
                _of_each(cycle_of, engine),
                engine._below_pistons(self.crankcase),
                [
                    None if place is None else (place, rod)
                    for place, rod in zip(
                        self._at_ends(end_of, engine), engine.rod_diameter, strict=False
                    )
                ],
            )
            for engine in engines
        ]

    def places(self, load: NDArray[np.float64] | None) -> tuple[Any, Any, Any, Any]:
        """Return speeds, loads and cycles of the maps, the loads of the sweep before these."""
        if load is None:
            low, high = self.first.load[[0, -1]]
            raise inputs.rejected(
                "load", None, f"give loads from {low:g} to {high:g}, those of cycle"
            )
        return self.first.rpm, self.first.load, load, self._cycles

    def at(self, engine: Engine, rpm: float, load: float) -> Engine:
        """Return an engine with its cycles at a speed and a load."""
        cycles, ends = (
            [
                None if cycle_map is None else cycle_map.cycle_at(rpm=rpm, load=load)
                for cycle_map in maps
            ]
            for maps in (self.maps, self.ends)
        )
        at_ends = self._at_ends(ends, engine)
        return engine.with_cycle(
            _of_each(cycles, engine),
            crankcase=self.crankcase,
            crank_end=at_ends or None,
            rod_diameter=engine.rod_diameter if any(at_ends) else None,
        )

    def _at_ends(self, ends: list[Item | None], engine: Engine) -> list[Item | None]:
        """Return the cycle of each crank end that the engine has; none at all without maps."""
        own = engine.crank_ends or ()
        each = zip(_of_each(ends, engine), own, strict=True) if ends else ()
        return [None if present is None else one for one, present in each]


def _maps(name: str, cycle: object, engines: Sequence[Engine]) -> list[Any]:
    """Return the maps of an argument: one, or one or None for each cylinder of every engine."""
    hint = "give a crankpin.CycleMap, or one or None for each cylinder"
    alone = isinstance(cycle, CycleMap)
    maps: list[Any] = [cycle] if alone else inputs.items(name, cycle, hint)
    for k, cycle_map in enumerate(maps):
        if not (cycle_map is None or isinstance(cycle_map, CycleMap)):
            raise inputs.rejected(f"{name}[{k}]", cycle_map, hint)
    if all(cycle_map is None for cycle_map in maps):
        raise inputs.rejected(name, cycle, "has no map; leave it out")
    for engine in engines:
        if not alone and len(maps) != len(engine):
            fault = f"has {len(maps)} entries, the engine has {len(engine)}"
            raise inputs.faulty(name, fault, "give one for each cylinder")
    return maps


def _of_each(cycles: list[Item], engine: Engine) -> list[Item]:
    """Return the cycle of each cylinder."""
    return cycles * len(engine) if len(cycles) == 1 else cycles
