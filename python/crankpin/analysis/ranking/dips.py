"""Bank angles between the given ones at which an objective is lowest."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Measured: TypeAlias = "Callable[[NDArray[np.float64]], NDArray[np.float64]]"
"""Computes the objective at bank angles in degrees."""

POINTS = 9
"""Angles at which a dip is sampled in each round, which leaves a quarter of it."""
NARROW = 1e-10
"""Degrees to which a pointed dip is narrowed."""
FLAT = 1e-14
"""Relative difference that rounding explains: the middle stands for a dip this flat."""
SAME = 1e-3
"""Degrees within which two dips count as one."""


def dips(
    measured: Measured,
    angles: NDArray[np.float64],
    values: NDArray[np.float64],
    tolerance: float,
) -> NDArray[np.float64]:
    """Return bank angles between the given ones at which the objective is lower than at them."""

    def at(where: NDArray[np.float64]) -> NDArray[np.float64]:
        found = measured(where.ravel())
        return np.where(np.isnan(found), np.inf, found).reshape(where.shape)

    angles, first = np.unique(angles, return_index=True)
    values = np.where(np.isnan(values), np.inf, values)[first]
    lowest_given = np.array(sorted(set(_lowest(values, tolerance))), dtype=np.intp)
    if not lowest_given.size:
        return np.empty(0)
    low = angles[np.maximum(lowest_given - 1, 0)]
    high = angles[np.minimum(lowest_given + 1, angles.size - 1)]
    while (high - low).max() > NARROW:
        across = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, POINTS)
        heights = at(across)
        lowest, rows = heights.argmin(axis=1), np.arange(lowest_given.size)
        low = across[rows, np.maximum(lowest - 1, 0)]
        high = across[rows, np.minimum(lowest + 1, POINTS - 1)]
        highest = np.abs(heights).max(axis=1)
        flat = np.isfinite(highest) & (heights.max(axis=1) <= heights.min(axis=1) + FLAT * highest)
        low[flat] = high[flat] = across[flat, POINTS // 2]
    middle = 0.5 * (low + high)
    # The angle with the fewest digits that is as good: 30 for 30.00000000001.
    rounded = np.stack([middle.round(digits) for digits in range(8)] + [middle], axis=1)
    rounded = np.clip(rounded, angles[0], angles[-1])
    heights = at(rounded)
    as_good = heights <= heights[:, -1:] + FLAT * np.abs(values[lowest_given])[:, None]
    rows, chosen = np.arange(lowest_given.size), as_good.argmax(axis=1)
    found, depths = rounded[rows, chosen], heights[rows, chosen]
    found = np.sort(found[depths < values[lowest_given] - tolerance])
    return found[np.append(True, np.diff(found) > SAME)] if found.size else found


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
