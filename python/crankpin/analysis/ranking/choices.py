"""Engines at their best bank angles, sorted by objectives with ties."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from crankpin._core import InputError
from crankpin.analysis.ranking.dips import dips
from crankpin.analysis.ranking.objectives import again

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin.analysis.ranking.objectives import Objective
    from crankpin.analysis.sweeps.sweep import Sweep
    from crankpin.model.engine import Engine


@dataclasses.dataclass(frozen=True)
class Choice:
    """An engine of a :class:`Ranking` at its best bank angles."""

    place: int
    """1 for the best; engines whose values are equal within the tolerance share a place."""
    name: str
    """Name of the engine."""
    engine: Engine
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


def chosen(
    swept: Sweep,
    objectives: Sequence[Objective],
    values: Sequence[NDArray[np.float64]],
    rtol: float,
    *,
    refine: bool,
) -> tuple[Choice, ...]:
    """Return each engine at its best angles, the best engine first."""
    tolerances = np.array([rtol * _largest(each) for each in values])
    names, grid = list(swept.coords["engine"]), angles_of(swept)
    found: list[Choice] = []
    for k, engine in enumerate(swept.engines):
        rows = np.stack([each[k] for each in values], axis=1)
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
        kept = _least(rows, tolerances)
        best = tuple(map(float, rows[kept].min(axis=0))) if kept.size else (np.inf,) * len(values)
        if angles is None:
            own = own_angles([engine])
            where = tuple(own.tolist()) if kept.size and np.isfinite(own[0]) else ()
        else:
            where = tuple(sorted(set(angles[kept].tolist())))
            if where and swept.hold is not None:
                engine = engine.with_bank_angle(where[0], hold=swept.hold)  # noqa: PLW2901
        found.append(Choice(0, str(names[k]), engine, where, best))
    rows = np.array([each.values for each in found])
    ranked: list[Choice] = []
    for group in groups(rows, np.arange(len(found)), tolerances):
        place = len(ranked) + 1
        ranked += [dataclasses.replace(found[k], place=place) for k in group]
    return tuple(ranked)


def _least(rows: NDArray[np.float64], tolerances: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the rows lowest in the first column, of those the lowest in the second, and so on."""
    kept = np.flatnonzero(np.isfinite(rows).all(axis=1))
    for column, tolerance in zip(rows.T, tolerances, strict=True):
        if kept.size:
            kept = kept[column[kept] <= column[kept].min() + tolerance]
    return kept


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
    return again(swept, engines=[engine], bank_angle_deg=angles)


def angles_of(swept: Sweep) -> NDArray[np.float64] | None:
    """Return the bank angles of a sweep, if it has any."""
    angles = swept.coords.get("bank_angle_deg")
    return None if angles is None else np.asarray(angles)


def own_angles(engines: Sequence[Engine]) -> NDArray[np.float64]:
    """Return the engines' bank angles, NaN where there are not two banks."""
    found = np.full(len(engines), np.nan)
    for k, engine in enumerate(engines):
        with contextlib.suppress(InputError):
            found[k] = engine.bank_angle_deg
    return found
