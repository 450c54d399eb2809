"""Search of the crank arrangements whose two banks share their pins.

With pins held, Z = Σ s exp(i·pin) is that of both banks: first-order moment is all forward at 90°,
for every order of the throws, and at every bank angle where Z = 0. All orders are enumerated; those
that are mirror images of each other are listed once.
"""

from __future__ import annotations

import math
from collections import Counter
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from crankpin import _core
from crankpin.analysis.arrangements.cranks import TURN, Crank, Symmetries, exact, throw_orders
from crankpin.analysis.balance import balance
from crankpin.analysis.vanishing import vanishing_orders
from crankpin.model.cylinder import Cylinder
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

BALANCED = 90.0
"""The bank angle, degrees."""
UNIT = Cylinder(crank_radius=1.0, rod_length=4.0, reciprocating_mass=1.0)
"""Cylinder whose moments are taken; results are over its m·r."""
RPM = 30.0 / math.pi
"""Speed at which ω is 1."""


class SharedPins:
    """Counterpart of the core's search: the same pins in both banks."""

    def __init__(self, cylinders: int, phases: Sequence[str] | None) -> None:
        count = cylinders // 2
        if cylinders % 2 or count < 2:
            raise _core.InputError(f"cylinders = {cylinders}: give an even number, 4 or more")
        if phases is None:
            # An even number of throws has half as many phases, each twice.
            step = f"{TURN * (2 - count % 2)}/{count}"
            self._phases = tuple(exact(step) * k % TURN for k in range(count))
        else:
            self._phases = tuple(exact(phase) % TURN for phase in phases)
        if len(self._phases) != count:
            raise _core.InputError(f"phases_deg has {len(self._phases)} phases: give {count}")
        self.cranks = self._enumerated()
        """Orders that are no mirror images of each other → number of orders that are."""

    def _enumerated(self) -> dict[Crank, int]:
        counts = Counter(self._phases)
        turns = sum(
            Counter((each + turn) % TURN for each in self._phases) == counts
            for turn in {(each - self._phases[0]) % TURN for each in counts}
        )
        symmetries = Symmetries()
        different = {Crank.of(throws) for throws in throw_orders(self._phases)}
        found = Counter(symmetries.first(crank) for crank in sorted(different, key=_throws))
        return {crank: turns * number for crank, number in found.items()}

    @property
    def candidates(self) -> int:
        """Orders of the throws; each is a pair of a bank with itself."""
        return sum(self.cranks.values())

    @property
    def qualifying(self) -> int:
        """Orders that are balanced at some bank angle: all of them."""
        return self.candidates

    @cached_property
    def balanced(self) -> int:
        """Orders without any first-order moment, decided in integers."""
        return sum(
            number
            for crank, number in self.cranks.items()
            if vanishing_orders(self.engine(crank), [1]).moment.vanishing
        )

    @property
    def distinct(self) -> int:
        """Number of orders that are listed."""
        return len(self.cranks)

    def engine(self, crank: Crank) -> Engine:
        """Return an engine of unit spacing and unit m·r."""
        return Engine.vee(UNIT, bank_angle_deg=90, throws_deg=crank.throws, spacing=1.0)


class SharedPinAngles:
    """Counterpart of the core's bank angles: 90° for each of the cranks listed."""

    def __init__(self, search: SharedPins, window: tuple[float, float]) -> None:
        self._search = search
        self._cranks = list(search.cranks) if window[0] <= BALANCED <= window[1] else []

    def __len__(self) -> int:
        return len(self._cranks)

    def degrees(self) -> NDArray[np.float64]:
        """Return the bank angle of each crank listed, degrees."""
        return np.full(len(self), BALANCED)

    def solution(
        self, k: int
    ) -> tuple[float, list[float], list[float], float, tuple[float, float]]:
        """Return bank angle, pins of both banks, counterweight and second-order moments."""
        crank = self._cranks[k]
        found = balance(self._search.engine(crank), RPM, orders=[1, 2])
        (second,) = UNIT.harmonics([2])
        x, y = (found[2].moment.peak_xy / abs(second)).tolist()
        pins = [float(throw) for throw in crank.throws]
        return BALANCED, pins, pins, float(abs(found[1].moment.forward)), (x, y)


def _throws(crank: Crank) -> tuple[float, ...]:
    return tuple(map(float, crank.throws))
