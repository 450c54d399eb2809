"""Engines ranked by objectives, each at its best bank angles, with ties."""

from __future__ import annotations

import contextlib
import dataclasses
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from crankpin._core import InputError
from crankpin._support import labels
from crankpin._support.frames import Tabled
from crankpin._support.record import Listed, changed
from crankpin._support.tables import Item, Table
from crankpin.analysis.ranking.objectives import ByObjectives, of_table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from crankpin.analysis.ranking.objectives import Objective
    from crankpin.analysis.sweeps.sweep import Sweep
    from crankpin.model.engine import Engine, Hold

MOST_ANGLES_SHOWN = 6
"""Bank angles shown in a cell."""


class Choice(Item):
    """An engine of a :class:`Ranking` at its best bank angles."""

    place: int
    """1 for the best; engines whose values are equal within the tolerance share a place."""
    name: str
    """Name of the engine."""
    engine: Engine = dataclasses.field(repr=False)
    """The engine at the first of these bank angles."""
    bank_angles_deg: tuple[float, ...]
    """All bank angles that tie for the smallest value, degrees, ascending; empty where no value is
    finite, or where the engine does not have two banks and was taken unchanged."""
    values: tuple[float, ...]
    """Value of each objective there, in the objective's unit; inf where none is finite."""

    @property
    def value(self) -> float:
        """Value of the first objective, in its unit."""
        return self.values[0]


class Ranking(ByObjectives, Listed[Choice], Tabled):
    """Engines sorted by objectives, each at its best bank angles.

    A sequence of :class:`Choice`, the best first. Made by :func:`crankpin.rank`.

    Examples
    --------
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> ranking = cp.rank(
    ...     v6, rpm=5000, by="total.moment.peak", bank_angle_deg=[60, 90, 120], hold="pins"
    ... )
    >>> ranking[0].bank_angles_deg
    (60.0,)
    >>> ranking.trade_off["[1].moment.backward"].round(1)
    array([[  0. , 459.4, 795.7]])
    """

    _items, _item, _maker = "choices", Choice, "crankpin.rank"

    sweep: Sweep
    """The sweep of the engines over the bank angles."""
    objectives: tuple[Objective, ...]
    """The objectives."""
    values_by: tuple[NDArray[np.float64], ...]
    """Values of each objective: (n_engines, n_angles), in its unit."""
    choices: tuple[Choice, ...]
    """The engines, the best first."""

    @property
    def engines(self) -> tuple[Engine, ...]:
        """The engines as they were given."""
        return self.sweep.engines

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the engines as given; engines with the same name, or none, are numbered."""
        return tuple(map(str, self.sweep.coords["engine"]))

    @property
    def hold(self) -> Hold | None:
        """Quantity that a change of bank angle does not change: "pins", "firing" or None."""
        return self.sweep.hold

    @cached_property
    def bank_angles_deg(self) -> NDArray[np.float64] | None:
        """The bank angles that were given, degrees: (n_angles,); None where none were."""
        return angles_of(self.sweep)

    @cached_property
    def own_angles_deg(self) -> NDArray[np.float64]:
        """Bank angles of the engines as given, degrees; NaN where there are not two banks.

        Of shape (n_engines,).
        """
        bank_angles = own_angles(self.engines)
        bank_angles.setflags(write=False)
        return bank_angles

    @property
    def values(self) -> NDArray[np.float64]:
        """Values of the first objective, in its unit: (n_engines, n_angles).

        Engines in the order given; one column where no bank angles were given.
        """
        return self.values_by[0]

    @cached_property
    def trade_off(self) -> Mapping[str, NDArray[np.float64]]:
        """The trade-off: objective → (n_engines, n_angles), in its unit; engines as given.

        The objectives of the ranking; then total moment and force, the backward part of the first
        order, the second order, total torque, and, of engines with up to 8 cylinders, the
        unevenness of firing.
        """
        columns = dict(zip(self.by, self.values_by, strict=True))
        for objective in of_table(self.sweep):
            if objective.label not in columns:
                columns[objective.label] = objective.values(self.sweep)
        return MappingProxyType(columns)

    # --- tables and pictures --------------------------------------------------------------------

    def _description(self, objectives: int | None = None) -> str:
        """Return the objectives, all or the first few, and the speed in words."""
        least = self._minimised(objectives, with_orders=self.sweep._request.orders is not None)
        return f"{least}, {labels.value_text('rpm', self.sweep.fixed['rpm'])}"

    @property
    def table(self) -> Table:
        """Table that is shown: the choices, best first."""
        parts = [
            f"Ranked by {self._description()}",
            *([labels.HELD[self.hold]] if self.hold else []),
        ]
        title = ", ".join(parts)
        heads = [(objective.head, objective.unit) for objective in self.objectives]
        rows = [
            (choice.place, choice.name, _several(choice.bank_angles_deg), *choice.values)
            for choice in self.choices
        ]
        return Table.from_rows(
            title, ["place", "engine", ("bank angle", "°"), *heads], rows, loads=self.loads_counted
        )

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words; of torque gas pressure does too."""
        loads = self.sweep.loads_counted
        all_count = self._of_torque or loads == labels.SPECTRUM_GIVEN
        return loads if all_count else labels.without_gas(loads)


def _several(angles: tuple[float, ...]) -> str:
    """Return a few angles as text."""
    text = ", ".join(f"{angle:.8g}" for angle in angles[:MOST_ANGLES_SHOWN])
    rest = len(angles) - MOST_ANGLES_SHOWN
    return f"{text} and {rest} more" if rest > 0 else text or "–"


# --- the best of a sweep --------------------------------------------------------------------------


def chosen(
    swept: Sweep,
    objectives: Sequence[Objective],
    values: Sequence[NDArray[np.float64]],
    rtol: float,
    *,
    refine: bool,
) -> tuple[Choice, ...]:
    """Return each engine at its best angles, the best engine first."""
    tolerances = np.array([rtol * _largest(row) for row in values])
    names, grid = list(swept.coords["engine"]), angles_of(swept)
    choices: list[Choice] = []
    for k, engine in enumerate(swept.engines):
        rows = np.stack([row[k] for row in values], axis=1)
        angles = grid
        if refine and grid is not None:

            def first(where: NDArray[np.float64], engine: Engine = engine) -> NDArray[np.float64]:
                of_part: NDArray[np.float64] = objectives[0].values(_part(swept, engine, where))[0]
                return of_part

            between = dips(first, grid, rows[:, 0], float(tolerances[0]))
            if between.size:
                part = _part(swept, engine, between)
                more = [objective.values(part)[0] for objective in objectives]
                rows, angles = np.vstack([rows, np.transpose(more)]), np.append(grid, between)
        least = _least(rows, tolerances)
        best = tuple(map(float, rows[least].min(axis=0))) if least.size else (np.inf,) * len(values)
        if angles is None:
            of_engine = own_angles([engine])
            where = tuple(of_engine.tolist()) if least.size and np.isfinite(of_engine[0]) else ()
        else:
            where = tuple(sorted(set(angles[least].tolist())))
            if where and swept.hold is not None:
                engine = engine.with_bank_angle(where[0], hold=swept.hold)  # noqa: PLW2901
        choices.append(Choice(0, str(names[k]), engine, where, best))
    rows = np.array([choice.values for choice in choices])
    ranked: list[Choice] = []
    for group in groups(rows, np.arange(len(choices)), tolerances):
        place = len(ranked) + 1
        ranked += [changed(choices[k], place=place) for k in group]
    return tuple(ranked)


def _least(rows: NDArray[np.float64], tolerances: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the rows lowest in the first column, of those the lowest in the second, and so on."""
    finite = np.flatnonzero(np.isfinite(rows).all(axis=1))
    for column, tolerance in zip(rows.T, tolerances, strict=True):
        if finite.size:
            finite = finite[column[finite] <= column[finite].min() + tolerance]
    return finite


def groups(
    rows: NDArray[np.float64], which: NDArray[np.intp], tolerances: NDArray[np.float64]
) -> Iterator[list[int]]:
    """Yield rows that tie, the lowest first."""
    rest = which
    while rest.size:
        tied = rest[_least(rows[rest], tolerances)]
        tied = tied if tied.size else rest  # nothing finite is left
        yield tied.tolist()
        rest = rest[~np.isin(rest, tied)]


def _largest(values: NDArray[np.float64]) -> float:
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))


def _part(swept: Sweep, engine: Engine, angles: NDArray[np.float64]) -> Sweep:
    """Return the sweep of one engine at other angles."""
    axes = {**swept.axes, "bank_angle_deg": angles}
    return changed(swept, engines=(engine,), names=("",), axes=axes, _request=swept._of_parts)


def angles_of(swept: Sweep) -> NDArray[np.float64] | None:
    """Return the bank angles of a sweep, if it has any."""
    angles = swept.coords.get("bank_angle_deg")
    return None if angles is None else np.asarray(angles)


def own_angles(engines: Sequence[Engine]) -> NDArray[np.float64]:
    """Return the engines' bank angles, NaN where there are not two banks."""
    angles = np.full(len(engines), np.nan)
    for k, engine in enumerate(engines):
        with contextlib.suppress(InputError):
            angles[k] = engine.bank_angle_deg
    return angles


# --- between bank angles --------------------------------------------------------------------------

Measured: TypeAlias = "Callable[[NDArray[np.float64]], NDArray[np.float64]]"
"""Computes the objective at bank angles in degrees."""

DIP_POINTS = 9
"""Angles at which a dip is sampled in each round, which leaves a quarter of it."""
NARROW_DIP = 1e-10
"""Degrees to which a pointed dip is narrowed."""
FLAT_DIP = 1e-14
"""Relative difference that rounding explains: the middle stands for a dip this flat."""
SAME_DIP = 1e-3
"""Degrees within which two dips count as one."""


def dips(
    measured: Measured, angles: NDArray[np.float64], values: NDArray[np.float64], tolerance: float
) -> NDArray[np.float64]:
    """Return bank angles between the given ones at which the objective is lower than at them."""

    def at(where: NDArray[np.float64]) -> NDArray[np.float64]:
        measurements = measured(where.ravel())
        return np.where(np.isnan(measurements), np.inf, measurements).reshape(where.shape)

    angles, first = np.unique(angles, return_index=True)
    values = np.where(np.isnan(values), np.inf, values)[first]
    lowest_given = np.array(sorted(set(_lowest(values, tolerance))), dtype=np.intp)
    if not lowest_given.size:
        return np.empty(0)
    low = angles[np.maximum(lowest_given - 1, 0)]
    high = angles[np.minimum(lowest_given + 1, angles.size - 1)]
    while (high - low).max() > NARROW_DIP:
        across = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, DIP_POINTS)
        heights = at(across)
        lowest, rows = heights.argmin(axis=1), np.arange(lowest_given.size)
        low = across[rows, np.maximum(lowest - 1, 0)]
        high = across[rows, np.minimum(lowest + 1, DIP_POINTS - 1)]
        highest = np.abs(heights).max(axis=1)
        flat = np.isfinite(highest) & (
            heights.max(axis=1) <= heights.min(axis=1) + FLAT_DIP * highest
        )
        low[flat] = high[flat] = across[flat, DIP_POINTS // 2]
    middle = 0.5 * (low + high)
    # The angle with the fewest digits that is as good: 30 for 30.00000000001.
    rounded = np.stack([middle.round(digits) for digits in range(8)] + [middle], axis=1)
    rounded = np.clip(rounded, angles[0], angles[-1])
    heights = at(rounded)
    as_good = heights <= heights[:, -1:] + FLAT_DIP * np.abs(values[lowest_given])[:, None]
    rows, chosen = np.arange(lowest_given.size), as_good.argmax(axis=1)
    minima, depths = rounded[rows, chosen], heights[rows, chosen]
    minima = np.sort(minima[depths < values[lowest_given] - tolerance])
    return minima[np.append(True, np.diff(minima) > SAME_DIP)] if minima.size else minima


def _lowest(values: NDArray[np.float64], tolerance: float) -> Iterator[int]:
    """Yield places about which a dip may lie: ends of runs of tied values below their neighbours.

    Values on both sides of a dip may tie: none of them is below the other then.
    """
    heights = values.tolist()
    start = 0
    for k, height in enumerate(heights):
        if k + 1 < len(heights) and abs(heights[k + 1] - height) <= tolerance:
            continue
        before = heights[start - 1] if start else np.inf
        after = heights[k + 1] if k + 1 < len(heights) else np.inf
        inside = start > 0 or k + 1 < len(heights)
        if inside and np.isfinite(height) and before > heights[start] and after > height:
            yield from (start, k)
        start = k + 1
