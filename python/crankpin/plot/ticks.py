"""Ticks: as many as fit, at round values, in plain notation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axis import XAxis
from matplotlib.ticker import FixedLocator, Formatter, FuncFormatter, Locator, MaxNLocator

from crankpin._support import drawing
from crankpin._support.labels import NEGLIGIBLE
from crankpin.plot.layout import points_of
from crankpin.plot.words import in_degrees, number

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from numpy.typing import ArrayLike, NDArray

STEPS = [1, 2, 2.5, 5, 10]
"""Distances of ticks, times a power of ten."""
DEGREE_STEPS = (15, 30, 45, 60, 90, 180, 360, 720)


class RoundLocator(Locator):
    """Ticks at round numbers, as many as have room for their labels beside each other."""

    write = staticmethod(number)
    """Writes the label of a tick."""

    def __init__(self, most: int, *, whole: bool = False) -> None:
        self.most = most
        """Largest number of steps."""
        self.whole = whole
        """Whether ticks are at whole numbers only."""
        self._state: tuple[float, ...] = ()
        self._places: Sequence[float] = ()

    def __call__(self) -> Sequence[float]:
        """Return the places of the ticks."""
        assert self.axis is not None  # noqa: S101 - by Axis.set_major_locator
        limits = tuple(map(float, self.axis.get_view_interval()))
        # A layout asks a hundred times for one picture: measuring anew takes four times as long.
        axis: Any = self.axis
        state = (*limits, *axis.axes.bbox.size)
        if state != self._state:
            self._state, self._places = state, self.tick_values(*limits)
        return self._places

    def tick_values(self, vmin: float, vmax: float) -> Sequence[float]:
        """Return the places of the ticks between two values."""
        low, high = sorted((vmin, vmax))
        places: Sequence[float] = []
        for places in self._candidates(low, high):
            inside = [place for place in places if low <= place <= high]
            if self.axis is None or high == low or self._fit(inside, high - low):
                break
        return places

    def _candidates(self, low: float, high: float) -> Iterator[Sequence[float]]:
        """Yield places of ticks, ever fewer."""
        for count in range(self.most, 0, -1):
            ticks = MaxNLocator(count, steps=STEPS, integer=self.whole, min_n_ticks=1).tick_values(
                low, high
            )
            yield [tick for tick in ticks if not self.whole or tick == round(tick)]

    def _fit(self, places: Sequence[float], span: float) -> bool:
        """Return whether labels at these places do not touch."""
        if len(places) < 2:
            return True
        axis: Any = self.axis
        font = axis.get_major_ticks(1)[0].label1.get_fontproperties()
        size = font.get_size_in_points()
        if isinstance(axis, XAxis):
            room = axis.axes.bbox.width
            longest = max(map(self.write, places), key=len)
            needed = 0.8 * size + points_of(axis.axes, longest, font)
        else:
            room, needed = axis.axes.bbox.height, 1.5 * size
        per_point = axis.axes.get_figure(root=True).dpi / 72.0
        return bool(room * np.diff(places).min() >= per_point * needed * span)


class DegreeLocator(RoundLocator):
    """Ticks at parts of a turn, as many as have room for their labels beside each other."""

    write = staticmethod(in_degrees)

    def __init__(self) -> None:
        super().__init__(8)

    def _candidates(self, low: float, high: float) -> Iterator[Sequence[float]]:
        outermost: list[list[float]] = []
        for step in DEGREE_STEPS:
            if 2 * step <= high - low <= self.most * step:
                first, last = np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9)
                yield (step * np.arange(int(first), int(last) + 1)).tolist()
                outermost.append([float(step * int(first)), float(step * int(last))])
        yield from outermost[:1]
        for count in range(self.most, 0, -1):
            yield MaxNLocator(count, steps=[1, 2, 5, 10], min_n_ticks=1).tick_values(low, high)


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
    finite = np.asarray(values, dtype=np.float64)
    finite = finite[np.isfinite(finite)]
    if finite.size and finite.min() < finite.max():
        ax.set_xlim(float(finite.min()), float(finite.max()))


def from_zero(ax: Axes, largest: float, room: float = 1.08, *, name: str = "y") -> None:
    """Let an axis of magnitudes begin at zero and have room for the largest value.

    The limits remain automatic: on a logarithmic scale, which has no zero, they are those of the
    data.
    """
    axis: Any = getattr(ax, f"{name}axis")
    for artist in (*ax.lines, *ax.collections, *ax.patches):
        getattr(artist.sticky_edges, name).append(0.0)
    ax.update_datalim([(0.0, 0.0)], updatex=name == "x", updatey=name == "y")
    getattr(ax, f"set_{name}lim")(0.0, room * largest or 1.0, auto=True)
    if not largest:  # a scale of nothing would mislead
        axis.set_ticks([0.0])


def log_scale(ax: Axes, least: float, largest: float, *, name: str = "y") -> None:
    """Give an axis of magnitudes, of which the least and the largest are seen, a log scale."""
    getattr(ax, f"set_{name}scale")("log", nonpositive="clip")
    getattr(ax, f"set_{name}lim")(0.3 * least, 3.0 * largest)


def magnitude_scale(
    ax: Axes, values: NDArray[np.float64], *, logarithmic: bool, name: str = "y"
) -> None:
    """Let an axis of magnitudes begin at zero, or be logarithmic where any is above zero."""
    largest = float(values.max(initial=0.0))
    if logarithmic and largest:
        log_scale(ax, float(values[values > NEGLIGIBLE * largest].min()), largest, name=name)
        return
    numeric(getattr(ax, f"{name}axis"))
    from_zero(ax, largest, name=name)


# --- other units ----------------------------------------------------------------------------------


class ScaledLocator(Locator):
    """Ticks where numbers in another unit are round."""

    def __init__(self, locator: Locator, factor: float) -> None:
        self.own, self.factor = locator, factor

    def set_axis(self, axis: Any) -> None:  # noqa: ANN401 - of matplotlib
        """Set the axis, of the locator for the other unit too."""
        super().set_axis(axis)
        self.own.set_axis(axis)

    def __call__(self) -> Sequence[float]:
        """Return the places of the ticks."""
        assert self.axis is not None  # noqa: S101 - by Axis.set_major_locator
        return self.tick_values(*self.axis.get_view_interval())

    def tick_values(self, vmin: float, vmax: float) -> Sequence[float]:
        """Return the places of the ticks between two values."""
        ticks = self.own.tick_values(vmin * self.factor, vmax * self.factor)
        return [float(place) / self.factor for place in ticks]


class ScaledFormatter(Formatter):
    """Numbers of ticks in another unit."""

    def __init__(self, formatter: Formatter, factor: float) -> None:
        self.own, self.factor = formatter, factor

    def set_axis(self, axis: Any) -> None:  # noqa: ANN401 - of matplotlib
        """Set the axis, of the formatter for the other unit too."""
        super().set_axis(axis)
        self.own.set_axis(axis)

    def set_locs(self, locs: Any) -> None:  # noqa: ANN401 - of matplotlib
        """Set the places of all ticks."""
        super().set_locs(locs)
        self.own.set_locs([float(place) * self.factor for place in locs])

    def __call__(self, x: float, pos: int | None = None) -> str:
        """Return the text of a tick."""
        return self.own(float(f"{x * self.factor:.12g}"), pos)


def in_units(figure: Any) -> None:  # noqa: ANN401 - of matplotlib
    """Let the numbers along axes be those of the units that labels name."""
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            factor = getattr(axis, "crankpin_factor", 1.0)
            locator, formatter = axis.get_major_locator(), axis.get_major_formatter()
            if factor == 1.0 or isinstance(locator, ScaledLocator):
                continue
            if not isinstance(locator, FixedLocator):
                axis.set_major_locator(ScaledLocator(locator, factor))
            axis.set_major_formatter(ScaledFormatter(formatter, factor))


drawing.finishers.append(in_units)


# Functions of the module, so that figures pickle.


def _plain(value: float, _: object) -> str:
    return number(value)


def _degrees(value: float, _: object) -> str:
    return in_degrees(value)
