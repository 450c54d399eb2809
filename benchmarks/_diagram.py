"""Work-precision diagrams: error on x, time on y, a curve for each method, its knob along it.

A run that gives no right digit, or nothing at all, stands as a cross in the grey band at the right.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

OURS = "crankpin"
LEAST_ERROR = 1e-17
"""Where an error of nothing is drawn."""
NO_DIGIT = 1.0
"""An error from which a run has failed."""
BAND = (NO_DIGIT, 30.0)
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#B0A000", "#56B4E9", "#7F7F7F", "#E69F00")
MARKERS = "os^vDP<>"


class Point(NamedTuple):
    """One run of a method."""

    method: str
    label: str
    """the knob's setting"""
    error: float
    """NaN where the method gives nothing"""
    seconds: float


def few(settings: tuple[Any, ...], count: int) -> tuple[Any, ...]:
    """Choose so many settings of a knob, from end to end; the first if one."""
    if count == 1 or len(settings) <= count:
        return settings[:count]
    chosen = np.linspace(0, len(settings) - 1, count).round().astype(int)
    return tuple(settings[k] for k in chosen)


def failed(error: float) -> bool:
    """Whether no digit is right, or nothing came."""
    return not error < NO_DIGIT


def outcome(error: float) -> str:
    """Say what became of a run, for the CSV."""
    if math.isnan(error):
        return "refuses"
    return "no digit" if failed(error) else "ok"


def draw(
    ax: Axes, points: Iterable[Point], names: Sequence[str], title: str, error: str, time: str
) -> None:
    """Draw a curve for each method, coloured by its place among the names; ours black, on top."""
    curves: dict[str, list[Point]] = {}
    for point in points:
        curves.setdefault(point.method, []).append(point)
    ax.axvspan(*BAND, color="0.92", zorder=0)
    middle = math.sqrt(BAND[0] * BAND[1])
    others = [name for name in names if name != OURS]
    for name, curve in curves.items():
        place = others.index(name) if name != OURS else -1
        color = "black" if name == OURS else COLORS[place % len(COLORS)]
        x = np.array(
            [middle if failed(point.error) else max(point.error, LEAST_ERROR) for point in curve]
        )
        y = np.array([point.seconds for point in curve])
        wrong = np.array([failed(point.error) for point in curve])
        marker, size = ("*", 11.0) if name == OURS else (MARKERS[place % len(MARKERS)], 4.5)
        layer = 4 if name == OURS else 3
        ax.plot(x, y, "-", color=color, lw=1.8 if name == OURS else 1.1, zorder=layer)
        ax.plot([], [], marker=marker, ms=size, color=color, lw=1.1, label=name)
        ax.plot(x[~wrong], y[~wrong], marker, ms=size, color=color, zorder=layer)
        ax.plot(x[wrong], y[wrong], "x", ms=6, mew=1.4, color=color, zorder=layer)
        # the ends of the knob; one in the band would hide the others there
        for k in dict.fromkeys((0, len(curve) - 1)):
            if curve[k].label and not wrong[k]:
                near: dict[str, Any] = {"xytext": (4, 4), "textcoords": "offset points"}
                near |= {"fontsize": 6.5, "color": color}
                ax.annotate(curve[k].label, (x[k], y[k]), **near)
    ax.set(xscale="log", yscale="log", xlim=(LEAST_ERROR / 3, BAND[1]))
    ax.set(title=title, xlabel=error, ylabel=time)
    low, high = np.log10(ax.get_ylim())
    ax.set_ylim(10 ** math.floor(low), 10 ** math.ceil(high))
    ax.set_xticks(10.0 ** np.arange(-17, 1, 2))
    ax.minorticks_off()
    ax.text(middle, 0.98, "fails", transform=ax.get_xaxis_transform(), **CENTRED)
    ax.grid(color="0.87", lw=0.6)
    ax.set_axisbelow(True)


CENTRED: dict[str, Any] = {"ha": "center", "va": "top", "fontsize": 7, "color": "0.35"}
