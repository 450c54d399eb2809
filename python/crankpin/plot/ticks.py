"""Ticks: as many as there is room for, at round values, written plainly."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axis import XAxis
from matplotlib.ticker import FuncFormatter, Locator, MaxNLocator

from crankpin.plot.words import in_degrees, number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from numpy.typing import ArrayLike

STEPS = [1, 2, 2.5, 5, 10]
"""Distances of ticks, times a power of ten."""
DEGREE_STEPS = (15, 30, 45, 60, 90, 180, 360, 720)


class RoundLocator(Locator):
    """Ticks at round numbers, as many as fit beside each other."""

    def __init__(self, most: int, *, whole: bool = False) -> None:
        self.most = most
        """Largest number of steps."""
        self.whole = whole
        """Whether ticks are at whole numbers only."""

    def __call__(self) -> Sequence[float]:
        """Return the places of the ticks."""
        assert self.axis is not None  # noqa: S101 - by Axis.set_major_locator
        return self.tick_values(*self.axis.get_view_interval())

    def tick_values(self, vmin: float, vmax: float) -> Sequence[float]:
        """Return the places of the ticks between two values."""
        low, high = sorted((vmin, vmax))
        longest = max(len(number(float(f"{end:.2g}"))) for end in (low, high))
        steps = MaxNLocator(self._room(longest), steps=STEPS, integer=self.whole)
        return steps.tick_values(low, high)

    def _room(self, characters: int) -> int:
        """Return the number of labels that fit along the axis."""
        if self.axis is None:
            return self.most
        space = self.axis.get_tick_space()
        if isinstance(self.axis, XAxis):
            # Matplotlib counts labels of three sizes of type; a digit is 0.6 wide.
            space = int(3 * space / (0.6 * characters + 1.2))
        return max(1, min(self.most, space))


class DegreeLocator(RoundLocator):
    """Ticks at parts of a turn, as many as fit beside each other."""

    def __init__(self) -> None:
        super().__init__(8)

    def tick_values(self, vmin: float, vmax: float) -> Sequence[float]:
        """Return the places of the ticks between two angles."""
        low, high = sorted((vmin, vmax))
        room = self._room(4)
        step = next((s for s in DEGREE_STEPS if high - low <= s * room), DEGREE_STEPS[-1])
        if high - low < 2 * step:
            places_between: Sequence[float] = MaxNLocator(room, steps=[1, 2, 5, 10]).tick_values(
                low, high
            )
            return places_between
        first, last = np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9)
        places: list[int] = (step * np.arange(int(first), int(last) + 1)).tolist()
        return places


def degrees(axis: Axis) -> None:
    """Write degrees along an axis."""
    axis.set_major_locator(DegreeLocator())
    axis.set_major_formatter(FuncFormatter(_degrees))


def numeric(axis: Axis, *, whole: bool = False) -> None:
    """Write plain numbers along an axis."""
    axis.set_major_locator(RoundLocator(7 if isinstance(axis, XAxis) else 5, whole=whole))
    axis.set_major_formatter(FuncFormatter(_plain))


def span(ax: Axes, values: ArrayLike) -> None:
    """Limit the horizontal axis to values."""
    found = np.asarray(values, dtype=np.float64)
    found = found[np.isfinite(found)]
    if found.size and found.min() < found.max():
        ax.set_xlim(float(found.min()), float(found.max()))


def from_zero(ax: Axes, largest: float) -> None:
    """Let the vertical axis begin at zero and have room for the largest value."""
    ax.set_ylim(0.0, 1.08 * largest or 1.0)
    if not largest:  # a scale of nothing would mislead
        ax.set_yticks([0.0])


# Functions of the module, so that figures pickle.


def _plain(value: float, _: object) -> str:
    return number(value)


def _degrees(value: float, _: object) -> str:
    return in_degrees(value)
